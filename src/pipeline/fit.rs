//! Whether a garment suits its body before cloth moves: its size, and where its pieces start.

use super::one_place::in_one_place;
use super::settling::{WordShown, settling};
use crate::contact::Collider;
use crate::geometry::{Vec2, Vec3, box_of, range_of};
use crate::io::garment::Loaded;
use crate::mannequin::Mannequin;
use crate::mesh::{self, ClothMesh};
use crate::pattern::{Findings, Piece, PieceFile, Place, Problem, Spot, written_edge};
use crate::sew::place::{PlaceError, positioned, same_sides};
use crate::sew::start::{SPACING, Sketch, sketch};
use crate::sew::{Stance, left_inside, sewn_on};

/// Length of a garment's longest piece, as a share of the body's height, below which it is drawn in another unit. A
/// wristband has a tenth, trousers ten times too small have less than a twelfth.
const SMALL: f64 = 0.09;
/// Size of a piece, as the side of a square of its area in body heights, above which it is drawn in another unit. A
/// sari has 1.5, the front of a skirt ten times too large 3.
const LARGE: f64 = 2.0;

/// Warns of a garment that is much too small or too large for the body. An object may be covered by anything.
pub(super) fn doubt_size(loaded: &Loaded, body: &Mannequin, findings: &mut Findings) {
    if body.parts.is_empty() {
        return;
    }
    let [low, high] = range_of(body.mesh.vertices.iter().map(|v| v.y));
    let height = high - low;
    let longest = loaded.garment.pieces.iter().rev().map(|p| (p, diagonal(p))).max_by(|a, b| a.1.total_cmp(&b.1));
    let largest = loaded.garment.pieces.iter().map(|p| p.area().max(0.0).sqrt()).fold(0.0, f64::max);
    let Some((piece, length)) = longest else { return };
    let small = length < SMALL * height;
    if small || largest > LARGE * height {
        let unit = loaded.file.unit().symbol();
        let spot = loaded.file.units.as_ref().map_or_else(|| spot_of(loaded, piece), |u| u.at);
        let piece = piece.drawn_as.clone();
        findings.warn(spot, Problem::Size { piece, piece_mm: 1e3 * length, body_m: height, unit, small });
    }
}

/// Tells of the drawn pieces that are narrower than the spacing of the mesh, in which the garment's pieces stand from
/// number `first`, and were meshed finer.
pub(super) fn tell_narrow(loaded: &Loaded, mesh: &ClothMesh, first: usize, findings: &mut Findings) {
    let mut told: Vec<&str> = Vec::new();
    for (piece, meshed) in loaded.garment.pieces.iter().zip(&mesh.pieces[first..]) {
        let Some(narrow) = meshed.narrow.filter(|_| !told.contains(&piece.drawn_as.as_str())) else { continue };
        told.push(&piece.drawn_as);
        let [width, spacing, along] = [narrow.width, mesh.spacing, narrow.along].map(|x| 1e3 * x);
        let problem = Problem::Narrow { piece: piece.drawn_as.clone(), width, spacing, along };
        findings.warn(name_of(loaded, piece), problem);
    }
}

/// From corner to corner of the box round a piece, metres.
fn diagonal(piece: &Piece) -> f64 {
    let points: Vec<Vec2> = piece.loops.first().into_iter().flatten().flat_map(|e| e.path.sampled(1e-4)).collect();
    let [low, high] = box_of(points);
    (high - low).norm()
}

/// Finds pieces that have no start on the body as it is sewn on, in its `stance` if it has one for that, or are put
/// into it. Warns of garments that may be worn in two ways, and of fronts and backs that are sewn by the same side.
pub(super) fn check_places(
    loaded: &Loaded,
    mesh: &ClothMesh,
    body: &Mannequin,
    stance: Option<&Stance>,
    findings: &mut Findings,
) {
    let Some(collider) = Collider::new(&body.mesh).map(|c| c.on_floor(body.floor())) else { return };
    let (body, collider) = sewn_on(stance, body, &collider);
    let Some(start) = positioned(&loaded.garment, mesh) else {
        return check_start(loaded, mesh, body, findings);
    };
    doubt_places(loaded, mesh, &start, |_, _| true, findings);
    for (piece, cut) in loaded.garment.pieces.iter().zip(&mesh.pieces) {
        let Some(Place::At { .. }) = piece.place else { continue };
        if let Some(deepest) = left_inside(collider, &start[cut.particles.clone()]) {
            let problem = Problem::StartsInside { piece: piece.name.clone(), depth_mm: 1e3 * deepest };
            findings.error(spot_of(loaded, piece), problem);
        }
    }
}

/// Checks the start that the topology of a garment gives; `mesh` takes the place of the mesh that it starts on where
/// there is none.
fn check_start(loaded: &Loaded, mesh: &ClothMesh, body: &Mannequin, findings: &mut Findings) {
    let garment = &loaded.garment;
    for same in same_sides(garment, mesh) {
        let [piece, to] = same.pieces.map(|piece| garment.pieces[piece].name.clone());
        let seam = garment.seams[same.seam].name.clone();
        let written = loaded.file.seams.iter().find(|s| s.name.value == written_edge(&seam));
        let spot = written.map_or_else(Spot::default, |s| s.name.at);
        findings.warn(spot, Problem::SameSide { seam, piece, to, side: same.side });
    }
    let own = mesh::build(garment, SPACING).ok();
    let mesh = own.as_ref().unwrap_or(mesh);
    let Sketch { at, doubt, words, .. } = sketch(garment, mesh, body);
    match at {
        // Before it is inflated cloth of all layers is in one place.
        Ok(at) => doubt_places(loaded, mesh, &at, |one, other| one.level() == other.level(), findings),
        // A pattern may be looked at before it is whole.
        Err(error) => findings.warn(culprit(loaded, &error), Problem::Place(error.to_string())),
    }
    if let Some(doubt) = doubt {
        let words: Vec<WordShown> = words.iter().map(WordShown::new).collect();
        let settling = settling(&words).join("; ");
        findings.warn(loaded.file.version.at, Problem::WornInTwoWays { openings: doubt.to_string(), settling });
    }
}

/// Warns of pairs of pieces that count and start in the same place with nothing that leads them apart.
fn doubt_places(
    loaded: &Loaded,
    mesh: &ClothMesh,
    start: &[Vec3],
    counts: impl Fn(&Piece, &Piece) -> bool,
    findings: &mut Findings,
) {
    let mut told: Vec<[&str; 2]> = Vec::new();
    for (pair, _) in in_one_place(mesh, start) {
        let [one, other] = pair.map(|number| &loaded.garment.pieces[number]);
        if !counts(one, other) {
            continue;
        }
        let names = [one.drawn_as.as_str(), other.drawn_as.as_str()];
        if !told.contains(&names) {
            told.push(names);
            let copies = names[0] == names[1];
            let problem = Problem::OnePlace { one: one.name.clone(), other: other.name.clone(), copies };
            findings.warn(spot_of(loaded, other), problem);
        }
    }
}

/// Place in the file of the piece that has no start.
fn culprit(loaded: &Loaded, error: &PlaceError) -> Spot {
    let (PlaceError::Unworn { piece: name, .. } | PlaceError::NoParts { piece: name, .. }) = error;
    let piece = loaded.garment.pieces.iter().find(|p| p.name == *name);
    piece.map_or_else(Spot::default, |p| spot_of(loaded, p))
}

/// The piece of the file that a piece is drawn as.
fn written<'a>(loaded: &'a Loaded, piece: &Piece) -> Option<&'a PieceFile> {
    loaded.file.pieces.iter().find(|p| p.name.value == piece.drawn_as)
}

/// Place in the file of a piece's name.
fn name_of(loaded: &Loaded, piece: &Piece) -> Spot {
    written(loaded, piece).map_or_else(Spot::default, |p| p.name.at)
}

/// Place in the file of a piece's place, or of its name if it has none.
fn spot_of(loaded: &Loaded, piece: &Piece) -> Spot {
    written(loaded, piece).map_or_else(Spot::default, |p| p.place.as_ref().map_or(p.name.at, |place| place.at))
}
