//! A skirt built in code, draped, and its drape read: toile as a library, without a garment file.
//!
//! `cargo run --release --example embed`

use std::error::Error;
use std::sync::Arc;

use toile::contact::Collider;
use toile::drape::{DrapeOptions, drape};
use toile::dynamics::Cut;
use toile::fabric;
use toile::geometry::Vec3;
use toile::mannequin;
use toile::mesh::build;
use toile::pattern::{
    Findings, Garment, GarmentFile, Located, OutlineFile, PieceFile, PlaceFile, SeamFile, Spot, expand,
};
use toile::sew::{SewOptions, sew, start::start};

/// Spacing of the mesh, metres: coarse, so that the example runs in seconds.
const SPACING: f64 = 0.04;

fn main() -> Result<(), Box<dyn Error>> {
    let garment = skirt()?;
    let body = mannequin::load("woman_92")?;
    let collider = Collider::new(&body.mesh).ok_or("the body has no surface")?.on_floor(body.floor());
    let poplin = Arc::new(fabric::load("cotton_poplin")?);
    let fabrics = vec![poplin; garment.pieces.len()];

    let mesh = build(&garment, SPACING)?;
    let cut = Cut { garment: &garment, mesh: &mesh, fabrics: &fabrics };
    let at = start(&garment, &mesh, &body, &collider)?;
    let options = SewOptions { joined: true, ..SewOptions::default() };
    let sewn = sew(&cut, &collider, at, &options, &mut |_| {})?;
    sewn.closed(&mesh, options.tolerance)?;

    let draped = drape(&cut, &collider, &sewn.stitching, sewn.nodes, &DrapeOptions::default(), &mut |_| {})?;
    let at = sewn.stitching.spread(&draped.nodes);
    println!("{} particles, at rest: {} after {} steps", at.len(), draped.converged, draped.steps);
    for piece in &mesh.pieces {
        for edge in piece.edges.iter().filter(|edge| ["waist", "hem"].contains(&edge.name.as_str())) {
            let [low, high] = heights(&edge.particles, &at);
            println!("{}.{}: {:.0} to {:.0} mm above the floor", piece.name, edge.name, 1e3 * low, 1e3 * high);
        }
    }
    Ok(())
}

/// Lowest and highest of some particles, metres.
fn heights(particles: &[u32], at: &[Vec3]) -> [f64; 2] {
    let heights = particles.iter().map(|&p| at[p as usize].y);
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)])
}

/// A front and a back, sewn at both sides; checked as a file would be.
fn skirt() -> Result<Garment, Box<dyn Error>> {
    let front = PieceFile {
        grain: Some(here([[0.0, 50.0], [0.0, 250.0]])),
        place: Some(here(PlaceFile::Words("hip front".to_owned()))),
        outline: Some(OutlineFile {
            start: here([-200.0, 0.0]),
            edges: [
                ("waist", "L 200 0"),
                ("right", "C 230 80, 270 200, 290 500"),
                ("hem", "L -290 500"),
                ("left", "C -270 200, -230 80, -200 0"),
            ]
            .map(|(name, path)| (text(name), text(path)))
            .to_vec(),
        }),
        ..PieceFile::named(text("front"))
    };
    let back = PieceFile {
        place: Some(here(PlaceFile::Words("hip back".to_owned()))),
        ..PieceFile::like(text("back"), text("front"))
    };
    let file = GarmentFile {
        version: here(1),
        name: Some(text("A skirt built in code")),
        about: Vec::new(),
        units: None,
        body: Some(text("woman_92")),
        body_measures: Vec::new(),
        alter: Vec::new(),
        sizes: Vec::new(),
        body_units: None,
        allowance: None,
        fabrics: Vec::new(),
        pieces: vec![front, back],
        seams: vec![seam("left", "front.right", "back.left"), seam("right", "front.left", "back.right")],
        closures: Vec::new(),
        free: vec![text("*.waist"), text("*.hem")],
        tests: Vec::new(),
    };
    let mut findings = Findings::new("embed", "");
    let garment = expand("skirt", &file, &mut findings);
    let errors = findings.errors();
    let told: Vec<String> = findings.into_sorted().iter().map(ToString::to_string).collect();
    garment.filter(|_| errors == 0).ok_or_else(|| told.join("\n").into())
}

/// A seam that joins two edges of equal length.
fn seam(name: &str, sew: &str, to: &str) -> SeamFile {
    SeamFile::new(text(name), vec![text(sew)], vec![text(to)])
}

fn text(value: &str) -> Located<String> {
    here(value.to_owned())
}

/// A value that stands in no file.
fn here<T>(value: T) -> Located<T> {
    Located::new(value, Spot::default())
}
