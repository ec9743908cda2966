//! Cloth on objects: garment files under `tests/scenes`, run as any garment is, at a size that is quick.

use std::path::Path;

use toile::pipeline::{Job, Overrides, Run, read};
use toile::report::{Contact, Report};

/// The scene draped at `spacing` mm.
fn draped(name: &str, spacing: f64) -> Report {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes").join(name);
    let overrides = Overrides { spacing: Some(1e-3 * spacing), ..Overrides::default() };
    let job = Job::new(&file, read(&file).expect(name), &overrides).expect(name);
    let mut run = Run::new(&job);
    run.drape(&mut |_, _| {}).expect(name);
    run.report()
}

/// Nothing crosses anything, everything rests, and the threads keep their length.
fn lies_well(name: &str, spacing: f64) {
    let report = draped(name, spacing);
    assert_eq!(report.contact, Contact::default(), "{name}: {:?}", report.crossings);
    let drape = report.stages.iter().find(|s| s.name == "drape").expect("draped");
    assert!(drape.converged, "{name}: still drifts by {:?} mm after {} steps", drape.drift, drape.iterations);
    for piece in &report.pieces {
        assert!(piece.strain.p99 < 5e-3, "{name}: {} is stretched by {}", piece.name, piece.strain.p99);
    }
}

#[test]
fn a_sheet_drapes_over_a_ball() {
    lies_well("sheet_on_sphere.yaml", 25.0);
}

#[test]
fn a_sheet_hangs_over_a_thin_bar() {
    lies_well("sheet_on_bar.yaml", 40.0);
}

#[test]
fn a_sheet_hangs_over_the_edge_of_a_block() {
    // At 40 mm the hundredth part that is stretched most would be the few cells that lie across a corner of the block.
    lies_well("sheet_on_edge.yaml", 25.0);
}

#[test]
fn a_sheet_dropped_on_the_floor_lies_in_a_heap() {
    lies_well("heap.yaml", 40.0);
}
