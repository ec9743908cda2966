//! A start as it is drawn: round the body's axes, before it is inflated, also where the dealing is in doubt.

use super::axes::Axes;
use super::deal_error::{DealError, edges};
use super::ends::Ends;
use super::words::{Settling, settling};
use super::{Dealt, GluedOpening, hand_over};
use crate::geometry::Vec3;
use crate::mannequin::Mannequin;
use crate::mesh::ClothMesh;
use crate::pattern::Garment;
use crate::sew::place::PlaceError;

/// The start of a garment before it is inflated.
#[derive(Clone, Debug)]
pub struct Sketch {
    /// Where every particle is, metres: on the film between the openings, which are rings round the body's axes; or the
    /// piece that nothing passes through.
    pub at: Result<Vec<Vec3>, PlaceError>,
    /// The openings of the glued garment, its open fronts closed.
    pub openings: Vec<SketchedOpening>,
    /// By how much the next dealing costs more. Infinite where there is none.
    pub margin: f64,
    /// The dealing that fits about as well, if there is one.
    pub doubt: Option<DealError>,
    /// The words of `place` that would settle it.
    pub words: Vec<Settling>,
}

/// An opening in a sketch.
#[derive(Clone, Debug)]
pub struct SketchedOpening {
    /// The edges that it runs along, as `piece.edge`, those with most of it first.
    pub edges: Vec<String>,
    /// The particles of every side of its rim.
    pub sides: Vec<[u32; 2]>,
    /// Length of its rim, metres.
    pub length: f64,
    /// The ends of the body that pass through it.
    pub ends: Ends,
}

/// The start of a garment, meshed as `mesh`, before it is inflated.
pub fn sketch(garment: &Garment, mesh: &ClothMesh, body: &Mannequin) -> Sketch {
    let (open, dealt) = Dealt::stages(garment, mesh, body);
    let stages = || open.iter().chain([&dealt]);
    let in_doubt = stages().find(|stage| stage.doubt.is_some());
    let words = in_doubt.map_or_else(Vec::new, |stage| settling(garment, mesh, stage, body));
    let margin = stages().map(|stage| stage.dealing.margin).fold(f64::INFINITY, f64::min);
    let doubt = in_doubt.and_then(|stage| stage.doubt.clone());
    let nodes = dealt.on_film(garment, mesh, &Axes::of(body), |film| film.nodes);
    let at = nodes.map(|nodes| hand_over::particles(garment, mesh, &dealt.glued, &nodes));
    let at = at.ok_or_else(|| dealt.unworn(garment, mesh, body));
    Sketch { at, openings: openings(garment, mesh, &dealt), margin, doubt, words }
}

fn openings(garment: &Garment, mesh: &ClothMesh, dealt: &Dealt) -> Vec<SketchedOpening> {
    let one = |(opening, ends): (&GluedOpening, &Ends)| SketchedOpening {
        edges: edges(garment, mesh, &dealt.glued, opening),
        sides: opening.sides.clone(),
        length: opening.length,
        ends: *ends,
    };
    dealt.openings.iter().zip(&dealt.dealing.ends).map(one).collect()
}
