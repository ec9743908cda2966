//! The figures of Liu, Wang & Luo 2015 (L11–L15): every bar that the examples print is met.

#[path = "../examples/common/mod.rs"]
mod common;

use common::figure::Figure;
use common::{fig4, fig5, fig6, fig7, fig9};

/// Fails with the bars that are missed.
fn holds(figure: &Figure) {
    assert!(!figure.bars.is_empty());
    figure.bars.iter().for_each(|bar| println!("{bar}"));
    let missed: Vec<String> = figure.bars.iter().filter(|b| !b.is_met()).map(ToString::to_string).collect();
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn fig4_adds_the_terms_one_after_the_other() {
    holds(&fig4::figure().expect("solved"));
}

#[test]
fn fig5_tells_fifteen_fabrics_apart() {
    holds(&fig5::figure().expect("solved"));
}

#[test]
fn fig6_hardly_depends_on_the_mesh() {
    holds(&fig6::figure().expect("solved"));
}

#[test]
fn fig7_lays_cloth_over_a_ball() {
    holds(&fig7::balls().expect("solved"));
}

#[test]
fn fig7_draws_the_diagonal() {
    holds(&fig7::pulls().expect("solved"));
}

#[test]
fn fig7_wrinkles() {
    holds(&fig7::wrinkled().expect("solved"));
}

#[test]
fn fig9_drapes_a_skirt() {
    holds(&fig9::figure().expect("solved"));
}
