//! Darts. A dart on an edge is a wedge taken out of the drawn outline: the edge `waist` becomes `waist`, the legs
//! `dart.a` and `dart.b`, and `waist.2`. Both legs run to one tip, square over the middle of the mouth, so they are
//! equally long and the mouth closes point on point. A fish-eye dart is a lozenge-shaped hole with four edges.

use super::crossing::contains;
use super::diagnostic::{Findings, Spot};
use super::draft::{Draft, DrawnStretch, OwnSeam, SewnPart, position, shown, unknown_edge};
use super::file::{DartFile, DartShape, PieceFile};
use super::problem::Problem;
use super::value::{Quantity, Unit};
use super::{Edge, SeamKind};
use crate::geometry::{Path, Vec2};

/// Largest difference of a dart's legs, metres.
const LEG_TOLERANCE: f64 = 5e-4;

/// A wedge on a drawn edge.
struct Wedge {
    name: String,
    at: Spot,
    middle: f64,
    /// Start and end of the mouth on the edge.
    mouth: [f64; 2],
    tip: Vec2,
}

fn dart_name(dart: &DartFile, number: usize) -> String {
    match &dart.name {
        Some(name) => name.value.clone(),
        None if number == 0 => "dart".to_owned(),
        None => format!("dart{}", number + 1),
    }
}

/// Puts the outline's edges into ring 0, opened where darts stand on them.
pub(super) fn open_outline(
    drawn: &mut Draft,
    outline: &[Edge],
    piece: &PieceFile,
    unit: Unit,
    findings: &mut Findings,
) {
    for dart in &piece.darts {
        if let DartShape::Edge { edge, .. } = &dart.shape
            && !outline.iter().any(|e| e.name == edge.value)
        {
            let known: Vec<&str> = outline.iter().map(|e| e.name.as_str()).collect();
            findings.error(edge.at, unknown_edge(&drawn.name, &edge.value, &known));
        }
    }
    for edge in outline {
        let mut wedges = Vec::new();
        for (i, dart) in piece.darts.iter().enumerate() {
            if let Some(wedge) = wedge(drawn, edge, dart, i, unit, findings) {
                wedges.push(wedge);
            }
        }
        wedges.sort_by(|a, b| a.middle.total_cmp(&b.middle));
        for pair in wedges.windows(2) {
            if pair[0].mouth[1] >= pair[1].mouth[0] {
                findings.error(pair[1].at, Problem::DartsOverlap(format!("{}.{}", drawn.name, edge.name)));
                return;
            }
        }
        open_edge(drawn, edge, &wedges);
    }
    for (i, dart) in piece.darts.iter().enumerate() {
        check_tip(drawn, outline, dart, &dart_name(dart, i), findings);
    }
}

/// The middle of a dart's mouth on an edge, and its ends.
fn mouth(edge: &Path, dart: &DartFile, at: Quantity, unit: Unit) -> (f64, [f64; 2]) {
    let (middle, half) = (position(at, edge.length(), unit), 0.5 * dart.intake.value.value(unit));
    (middle, [middle - half, middle + half])
}

/// The point of a dart with its mouth between two points of an edge.
fn tip_of([one, other]: [Vec2; 2], dart: &DartFile, unit: Unit) -> Option<Vec2> {
    let DartShape::Edge { length, tip, .. } = &dart.shape else { return None };
    if let Some(tip) = tip {
        return Some(Vec2::from(tip.value) * unit.factor());
    }
    let across = (other - one).try_normalize(0.0)?;
    // The outline runs clockwise on screen: the cloth lies to the right of the walk.
    Some((one + other) / 2.0 + Vec2::new(-across.y, across.x) * length.as_ref()?.value.value(unit))
}

/// The corners of a fish-eye dart, from its upper tip round.
fn lozenge(at: [f64; 2], [up, down]: [Quantity; 2], intake: Quantity, unit: Unit) -> [Vec2; 4] {
    let middle = Vec2::from(at) * unit.factor();
    let half = Vec2::new(0.5 * intake.value(unit), 0.0);
    let top = middle - Vec2::new(0.0, up.value(unit));
    [top, middle - half, middle + Vec2::new(0.0, down.value(unit)), middle + half]
}

/// The legs of a dart as a line, of a piece with these edges by their names. `None` if its edge is not there.
pub(crate) fn dart_legs(dart: &DartFile, edges: &[(&str, &Path)], unit: Unit) -> Option<Path> {
    match &dart.shape {
        DartShape::Edge { edge, at, .. } => {
            let (_, path) = edges.iter().find(|(name, _)| *name == edge.value)?;
            let ends = mouth(path, dart, at.value, unit).1.map(|at| path.point(at));
            Some(Path::polyline(&[ends[0], tip_of(ends, dart, unit)?, ends[1]]))
        }
        DartShape::FishEye { at, up, down } => {
            let [a, b, c, d] = lozenge(at.value, [up.value, down.value], dart.intake.value, unit);
            Some(Path::polyline(&[a, b, c, d, a]))
        }
    }
}

fn wedge(drawn: &Draft, edge: &Edge, dart: &DartFile, i: usize, unit: Unit, findings: &mut Findings) -> Option<Wedge> {
    let DartShape::Edge { edge: on, at, .. } = &dart.shape else { return None };
    if on.value != edge.name {
        return None;
    }
    let whole = edge.path.length();
    let name = format!("{}.{}", drawn.name, edge.name);
    let (middle, mouth) = mouth(&edge.path, dart, at.value, unit);
    if mouth[0] <= 0.0 || mouth[1] >= whole {
        let (at_mm, [from, to], length) = (middle * 1e3, mouth.map(|m| m * 1e3), whole * 1e3);
        findings.error(at.at, Problem::DartMouth { edge: name, at: at_mm, from, to, length });
        return None;
    }
    let [one, other] = mouth.map(|m| edge.path.point(m));
    let tip = tip_of([one, other], dart, unit)?;
    let legs = [(tip - one).norm(), (tip - other).norm()];
    if (legs[0] - legs[1]).abs() > LEG_TOLERANCE {
        let [one, other] = legs.map(|l| l * 1e3);
        findings.error(dart.intake.at, Problem::DartLegs { edge: name, at: middle * 1e3, one, other });
    }
    Some(Wedge { name: dart_name(dart, i), at: at.at, middle, mouth, tip })
}

fn check_tip(drawn: &Draft, outline: &[Edge], dart: &DartFile, name: &str, findings: &mut Findings) {
    let DartShape::Edge { at, tip, .. } = &dart.shape else { return };
    let Some(leg) = drawn.rings[0].iter().find(|e| e.name == format!("{name}.a")) else { return };
    let end = leg.path.end();
    if !contains(outline, end) {
        let spot = tip.as_ref().map_or(at.at, |t| t.at);
        findings.error(spot, Problem::DartTip { piece: drawn.name.clone(), tip: shown(end) });
    }
}

/// Adds `edge` with its wedges to the outline.
fn open_edge(drawn: &mut Draft, edge: &Edge, wedges: &[Wedge]) {
    let whole = edge.path.length();
    if wedges.is_empty() {
        drawn.add_outline_edge(edge.name.clone(), edge.path.clone());
        return;
    }
    let mut parts = Vec::new();
    let mut from = 0.0;
    for i in 0..=wedges.len() {
        let to = wedges.get(i).map_or(whole, |w| w.mouth[0]);
        let name = if i == 0 { edge.name.clone() } else { format!("{}.{}", edge.name, i + 1) };
        let at = drawn.add_outline_edge(name, edge.path.part(from, to));
        parts.push(SewnPart { edge: at, from, to, offset: from });
        if let Some(wedge) = wedges.get(i) {
            add_legs(drawn, edge, wedge);
            from = wedge.mouth[1];
        }
    }
    // The name of the drawn edge stands for all that is left of it, not only for its first part.
    if let Some(named) = drawn.named.iter_mut().find(|n| n.name == edge.name) {
        named.length = whole;
        named.parts = parts;
    }
}

fn add_legs(drawn: &mut Draft, edge: &Edge, wedge: &Wedge) {
    let [one, other] = wedge.mouth.map(|m| edge.path.point(m));
    let a = drawn.add_outline_edge(format!("{}.a", wedge.name), Path::line(one, wedge.tip));
    let b = drawn.add_outline_edge(format!("{}.b", wedge.name), Path::line(wedge.tip, other));
    drawn.own_seams.push(dart_seam(drawn, wedge.name.clone(), a, b));
}

/// The seam of two edges of which the second runs back to where the first begins.
fn dart_seam(drawn: &Draft, name: String, a: (usize, usize), b: (usize, usize)) -> OwnSeam {
    OwnSeam {
        name,
        a: DrawnStretch { edge: a, from: 0.0, to: drawn.length(a) },
        b: DrawnStretch { edge: b, from: drawn.length(b), to: 0.0 },
        kind: SeamKind::Dart,
    }
}

/// Endings of the names of a fish-eye's edges, from its upper tip round.
pub(crate) const FISH_EYE_EDGES: [&str; 4] = ["upper_a", "lower_a", "lower_b", "upper_b"];

/// Cuts the fish-eye darts as holes with the edges `NAME.upper_a` and so on.
pub(super) fn cut_fish_eyes(drawn: &mut Draft, piece: &PieceFile, unit: Unit, findings: &mut Findings) {
    for (i, dart) in piece.darts.iter().enumerate() {
        let DartShape::FishEye { at, up, down } = &dart.shape else { continue };
        let corners = lozenge(at.value, [up.value, down.value], dart.intake.value, unit);
        if let Some(tip) = [corners[0], corners[2]].into_iter().find(|&t| !contains(&drawn.rings[0], t)) {
            findings.error(at.at, Problem::DartTip { piece: drawn.name.clone(), tip: shown(tip) });
            continue;
        }
        let name = dart_name(dart, i);
        let edge = |k: usize| Edge {
            name: format!("{name}.{}", FISH_EYE_EDGES[k]),
            path: Path::line(corners[k], corners[(k + 1) % 4]),
            against: false,
        };
        let ring = drawn.rings.len();
        drawn.add_ring([0, 1, 2, 3].map(edge).to_vec());
        let upper = dart_seam(drawn, format!("{name}.upper"), (ring, 0), (ring, 3));
        let lower = dart_seam(drawn, format!("{name}.lower"), (ring, 1), (ring, 2));
        drawn.own_seams.extend([upper, lower]);
    }
}
