//! The test bench: what specimens do beside what is known.

use std::sync::{Arc, LazyLock};

use toile::fabric::{load, sheet};
use toile::specimen::{Figure, Known, Sample, TESTS};

static POPLIN: LazyLock<Sample> = LazyLock::new(|| Sample {
    fabric: Arc::new(load("cotton_poplin").expect("shipped")),
    drape: sheet("cotton_poplin").expect("shipped").drape_band(),
});

fn figures(test: &str) -> Vec<Figure> {
    let test = TESTS.iter().find(|t| t.name == test).expect(test);
    test.run(&POPLIN).expect(test.name).figures
}

/// Every figure of a test is as near to what is known as it should be.
fn holds(test: &str) {
    let figures = figures(test);
    assert!(figures.iter().any(|f| f.error().is_some()));
    for f in &figures {
        assert!(f.holds() != Some(false), "{test}, {}: {} against {:?}", f.what, f.measured, f.known);
    }
}

#[test]
fn a_strip_between_two_hooks_hangs_in_a_catenary() {
    holds("catenary");
}

#[test]
fn a_rolled_sheet_shows_no_direction_of_the_grid() {
    let rigidity: Vec<f64> = figures("roll").iter().map(|f| f.measured).collect();
    let (least, most) = rigidity.iter().fold((f64::MAX, 0.0f64), |(a, b), &r| (a.min(r), b.max(r)));
    assert!(most / least < 1.01, "{rigidity:?}");
}

#[test]
fn a_disc_drapes_in_folds_and_knows_its_band() {
    let found = figures("drape");
    assert!(found.iter().any(|f| f.known == Known::Band([60.0, 83.0])));
    for f in found {
        match f.unit {
            "%" => assert!((20.0..100.0).contains(&f.measured), "{} %", f.measured),
            _ => assert!((3.0..=12.0).contains(&f.measured), "{} folds", f.measured),
        }
    }
}
