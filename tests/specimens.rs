//! The test bench: what specimens do beside what is known.

use std::sync::{Arc, LazyLock};

use toile::fabric::{library, load, sheet};
use toile::specimen::{BenchFigure, Known, LAYS, Lay, Sample, Series, TESTS, cantilever_error, drape};

static POPLIN: LazyLock<Sample> = LazyLock::new(|| Sample {
    fabric: Arc::new(load("cotton_poplin").expect("shipped")),
    drape: sheet("cotton_poplin").expect("shipped").drape_band(),
    published: None,
});

fn figures_of(sample: &Sample, test: &str) -> Vec<BenchFigure> {
    let test = TESTS.iter().find(|t| t.name == test).expect(test);
    test.run(sample).expect(test.name).figures
}

fn figures(test: &str) -> Vec<BenchFigure> {
    figures_of(&POPLIN, test)
}

/// Every figure of a test is as near to what is known as it should be.
fn holds_of(sample: &Sample, test: &str) {
    let figures = figures_of(sample, test);
    assert!(figures.iter().any(|f| f.error().is_some()));
    for f in &figures {
        let name = &sample.fabric.name;
        assert!(f.holds() != Some(false), "{name}, {test}, {}: {} against {:?}", f.what, f.measured, f.known);
    }
}

fn holds(test: &str) {
    holds_of(&POPLIN, test);
}

fn sample(name: &str) -> Sample {
    Sample { fabric: Arc::new(load(name).expect("shipped")), drape: None, published: None }
}

#[test]
fn every_fabric_stretches_and_shears_as_its_file_says() {
    for name in library() {
        for test in ["roll", "pulled strip", "hanging strip", "picture frame", "bias extension"] {
            holds_of(&sample(name), test);
        }
    }
}

/// Wool gives so much in its own plane that a narrow strip on edge stands longer;
/// velvet is thicker than its strips' cells.
#[test]
fn soft_and_thick_strips_bend_as_they_should() {
    holds_of(&sample("wool_suiting"), "strip on edge");
    holds_of(&sample("velvet"), "cantilever");
}

#[test]
fn a_cantilever_follows_the_master_curve() {
    holds("cantilever");
}

#[test]
fn half_the_spacing_halves_the_error_of_a_cantilever() {
    for gamma in [2.0, 16.0, 64.0] {
        let [coarse, fine] =
            [20, 40].map(|segments| cantilever_error(&POPLIN, gamma, segments).expect("a strip").abs());
        // What is left of small errors is what the cloth stretches.
        assert!(fine <= 0.5 * coarse || fine < 5e-4, "Γ = {gamma}: {coarse} and {fine}");
    }
}

#[test]
fn the_bending_length_is_half_the_overhang() {
    holds("bending length");
}

#[test]
fn a_strip_stands_as_long_as_it_should() {
    holds("standing strip");
}

#[test]
fn a_strip_on_edge_gives_way_where_it_should() {
    holds("strip on edge");
}

#[test]
fn a_pulled_strip_gives_the_curve_back() {
    holds("pulled strip");
}

#[test]
fn a_hanging_strip_is_drawn_out_by_its_weight() {
    holds("hanging strip");
}

#[test]
fn a_picture_frame_shears_as_the_fabric_says() {
    holds("picture frame");
}

#[test]
fn a_strip_on_the_bias_turns_its_threads_as_the_membrane_of_least_energy() {
    holds("bias extension");
    // And by less than the trellis shares out among all of them, whatever it is drawn out by.
    let figures = figures("bias extension");
    for (figure, trellis) in figures.iter().zip([0.573, 5.883, 12.122, 26.104]) {
        assert!((0.7 * trellis..0.9 * trellis).contains(&figure.measured), "{figure:?}");
    }
}

#[test]
fn a_strip_between_two_hooks_hangs_in_a_catenary() {
    holds("catenary");
}

#[test]
fn a_rolled_sheet_shows_no_direction_of_the_grid() {
    holds("roll");
    let rigidity: Vec<f64> = figures("roll").iter().map(|f| f.measured).collect();
    let (least, most) = rigidity.iter().fold((f64::MAX, 0.0f64), |(a, b), &r| (a.min(r), b.max(r)));
    assert!(most / least < 1.01, "{rigidity:?}");
}

#[test]
fn a_disc_laid_down_half_a_turn_on_drapes_the_same() {
    // Cloth and grid look the same from both sides; only where the first folds come is elsewhere.
    let linen = sample("linen");
    let [a, b] =
        [0.0, std::f64::consts::PI].map(|turn| drape(&linen, 0.005, &Lay { turn, over: false }).expect("at rest"));
    assert_eq!(a.folds, b.folds);
    assert!((a.coefficient - b.coefficient).abs() < 2e-3, "{} {}", a.coefficient, b.coefficient);
}

#[test]
fn a_disc_drapes_in_folds_and_knows_its_band() {
    let found = figures("drape");
    let [coefficient, deviation, folds] = &found[..] else { panic!("{found:?}") };
    assert_eq!(coefficient.known, Known::Band([60.0, 83.0]));
    assert!((20.0..100.0).contains(&coefficient.measured), "{coefficient:?}");
    assert!((0.0..3.0).contains(&deviation.measured), "{deviation:?}");
    assert!((3.0..=12.0).contains(&folds.measured), "{folds:?}");
}

/// Each is a cloth laid down otherwise, and the mean is theirs.
#[test]
fn the_drape_coefficient_is_the_mean_of_lays_that_differ() {
    let poplin = sample("cotton_poplin");
    let series = Series::drape(&poplin, 0.01).expect("at rest");
    let lays: Vec<f64> = series.draped.iter().map(|d| d.coefficient).collect();
    assert_eq!(lays.len(), LAYS.len());
    let hangs = |k: usize| &series.draped[k].cloth.vertices;
    for (k, lay) in LAYS.iter().enumerate() {
        assert!((0..k).all(|other| hangs(k) != hangs(other)), "two lays come to rest in the same place");
        let alone = drape(&poplin, 0.01, lay).expect("at rest");
        assert_eq!(hangs(k), &alone.cloth.vertices, "beside others a lay hangs as it does alone");
    }
    let (least, most) = lays.iter().fold((f64::MAX, 0.0f64), |(low, high), &c| (low.min(c), high.max(c)));
    assert!(least < series.mean() && series.mean() < most, "{lays:?}");
    // The standard deviation lies between half the range over √(n − 1) and the whole.
    let range = most - least;
    assert!(range / (2.0 * (lays.len() as f64 - 1.0).sqrt()) < series.deviation() && series.deviation() < range);
    let typical = series.typical().expect("a lay").coefficient;
    assert!(lays.iter().all(|c| (c - series.mean()).abs() >= (typical - series.mean()).abs()), "{lays:?}");
}

/// By hand, as in the paper: soft silk gives more on the bias than canvas and folds lower;
/// what is pushed together on a plate stays.
#[test]
fn specimens_drawn_out_and_folded_by_hand_tell_fabrics_apart() {
    let [silk, canvas] = ["silk_charmeuse", "canvas"].map(|name| figures_of(&sample(name), "hand tests"));
    for figures in [&silk, &canvas] {
        let [light, heavy, height, left] = &figures[..] else { panic!("{figures:?}") };
        assert!(1.0 < light.measured && light.measured < heavy.measured && heavy.measured < 1.1, "{figures:?}");
        assert!((25.0..50.0).contains(&height.measured), "{figures:?}");
        // The plate holds both: what was pushed in by 40 of 460 mm stays so.
        assert!((left.measured - 420.0 / 460.0).abs() < 0.002, "{figures:?}");
    }
    assert!(silk[1].measured - 1.0 > 1.5 * (canvas[1].measured - 1.0), "{silk:?}, {canvas:?}");
    assert!(silk[2].measured < canvas[2].measured, "{silk:?}, {canvas:?}");
}
