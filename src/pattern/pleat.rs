//! Pleats. A knife pleat that begins at `p` with under-layers of depth `d` takes up the stretch `p..p + 2d` of its
//! edge. Pointing towards the edge's end it is folded at `p`, so that `p - d..p` lies on top of two under-layers.
//! Pointing towards the start it is folded at `p + 2d`. A box pleat is a knife to the start, a panel of `2d` and a
//! knife to the end. An inverted pleat a knife to the end and, next to it, one to the start.
//!
//! The seam of the edge walks what is visible, and two seams per fold hold the under-layers to it and to each other.

use super::diagnostic::{Findings, Spot};
use super::draft::{Draft, DrawnStretch, OwnSeam, SewnPart, position};
use super::file::{PieceFile, PleatFile, PleatKind};
use super::problem::Problem;
use super::value::Unit;
use super::{PleatLayer, SeamKind};

/// One fold: begins at `at`, points to the edge's end or start.
#[derive(Clone, Copy)]
struct PleatFold {
    at: f64,
    /// Start of its pleat in the file.
    pleat: f64,
    depth: f64,
    to_end: bool,
    spot: Spot,
}

impl PleatFold {
    /// The top layer and the under-layers in walking order.
    fn occupied(self) -> [f64; 2] {
        let d = self.depth;
        if self.to_end { [self.at - d, self.at + 2.0 * d] } else { [self.at, self.at + 3.0 * d] }
    }

    /// Top on middle layer, middle on bottom layer: pairs of walked stretches.
    fn layers(self) -> [[(f64, f64); 2]; 2] {
        let (p, d) = (self.at, self.depth);
        if self.to_end {
            [[(p - d, p), (p + d, p)], [(p + d, p), (p + d, p + 2.0 * d)]]
        } else {
            let q = p + 2.0 * d;
            [[(q, q + d), (q, q - d)], [(q, q - d), (p, q - d)]]
        }
    }
}

/// Lays the pleats of a piece.
pub(super) fn lay(drawn: &mut Draft, piece: &PieceFile, unit: Unit, findings: &mut Findings) {
    let mut edges: Vec<&str> = Vec::new();
    for pleat in &piece.pleats {
        if drawn.find(&pleat.edge.value).is_none() {
            findings.error(pleat.edge.at, drawn.unknown_edge(&pleat.edge.value));
        } else if !edges.contains(&pleat.edge.value.as_str()) {
            edges.push(&pleat.edge.value);
        }
        if let Some(sewn) = &pleat.sewn {
            findings.warn(sewn.at, Problem::PleatSewn(format!("{}.{}", drawn.name, pleat.edge.value)));
        }
    }
    for edge in edges {
        let pleats: Vec<&PleatFile> = piece.pleats.iter().filter(|p| p.edge.value == edge).collect();
        lay_edge(drawn, edge, &pleats, unit, findings);
    }
}

fn lay_edge(drawn: &mut Draft, edge: &str, pleats: &[&PleatFile], unit: Unit, findings: &mut Findings) {
    let Some(named) = drawn.find(edge) else { return };
    let (length, parts, whole) = (named.length, named.parts.len(), named.parts[0].edge);
    let full_name = format!("{}.{edge}", drawn.name);
    if parts > 1 {
        findings.error(pleats[0].edge.at, Problem::DartsAndPleats(full_name));
        return;
    }
    let mut folds = Vec::new();
    for pleat in pleats {
        match points_to_end(drawn, whole, pleat) {
            Ok(to_end) => folds.extend(folds_of(pleat, to_end, length, unit)),
            Err(problem) => findings.error(pleat.edge.at, problem),
        }
    }
    folds.sort_by(|a, b| a.at.total_cmp(&b.at));
    let take: f64 = folds.iter().map(|f| 2.0 * f.depth).sum();
    if take >= length {
        let problem = Problem::PleatsTooLong { edge: full_name, take: take * 1e3, length: length * 1e3 };
        findings.error(pleats[0].edge.at, problem);
        return;
    }
    if let Some((fold, by, over)) = overlap(&folds, length) {
        let (at, by) = (fold.pleat * 1e3, by * 1e3);
        findings.error(fold.spot, Problem::PleatsOverlap { edge: full_name, at, by, over });
        return;
    }
    apply(drawn, edge, whole, length, &folds);
}

/// The first fold that reaches over something, how far, and over what it reaches. Tops may meet, pleats edge to edge.
fn overlap(folds: &[PleatFold], length: f64) -> Option<(&PleatFold, f64, String)> {
    let (mut end, mut before) = (0.0, "the start of the edge".to_owned());
    for fold in folds {
        let [from, to] = fold.occupied();
        if from < end - 1e-6 {
            return Some((fold, end - from, before));
        }
        if to > length + 1e-6 {
            return Some((fold, to - length, format!("the end of the edge, which is {:.1} mm long", length * 1e3)));
        }
        (end, before) = (to, format!("that at {:.0} mm", fold.pleat * 1e3));
    }
    None
}

/// Whether `toward` lies at the end of the edge.
fn points_to_end(drawn: &Draft, (_, index): (usize, usize), pleat: &PleatFile) -> Result<bool, Problem> {
    let ring = &drawn.rings[0];
    let next = &ring[(index + 1) % ring.len()].name;
    let previous = &ring[(index + ring.len() - 1) % ring.len()].name;
    match &pleat.toward {
        None => Ok(true),
        Some(t) if t.value == *next => Ok(true),
        Some(t) if t.value == *previous => Ok(false),
        Some(t) => Err(Problem::Toward {
            toward: t.value.clone(),
            edge: pleat.edge.value.clone(),
            known: format!("{previous} and {next}"),
        }),
    }
}

fn folds_of(pleat: &PleatFile, to_end: bool, length: f64, unit: Unit) -> Vec<PleatFold> {
    let depth = pleat.depth.value.value(unit);
    let kind = pleat.kind.as_ref().map_or(PleatKind::Knife, |k| k.value);
    let folds = |pleat: f64, spot| {
        let one = |after: f64, to_end| PleatFold { at: pleat + after, pleat, depth, to_end, spot };
        match kind {
            PleatKind::Knife => vec![one(0.0, to_end)],
            PleatKind::Box => vec![one(0.0, false), one(4.0 * depth, true)],
            PleatKind::Inverted => vec![one(0.0, true), one(2.0 * depth, false)],
        }
    };
    pleat.at.iter().flat_map(|at| folds(position(at.value, length, unit), at.at)).collect()
}

fn apply(drawn: &mut Draft, edge: &str, whole: (usize, usize), length: f64, folds: &[PleatFold]) {
    let mut parts = Vec::new();
    let mut from = 0.0;
    for fold in folds {
        parts.push((from, fold.at));
        from = fold.at + 2.0 * fold.depth;
    }
    parts.push((from, length));
    let visible = parts.into_iter().filter(|(a, b)| b - a > 1e-9);
    if let Some(named) = drawn.named.iter_mut().find(|n| n.name == edge) {
        named.parts = visible.map(|(from, to)| SewnPart { edge: whole, from, to, offset: 0.0 }).collect();
    }
    for (i, fold) in folds.iter().enumerate() {
        for ([a, b], layer) in fold.layers().into_iter().zip([PleatLayer::Top, PleatLayer::Under]) {
            let stretch = |(from, to)| DrawnStretch { edge: whole, from, to };
            drawn.own_seams.push(OwnSeam {
                name: format!("{edge}.pleat{}.{}", i + 1, if layer == PleatLayer::Top { "top" } else { "under" }),
                a: stretch(a),
                b: stretch(b),
                kind: SeamKind::Pleat(layer),
            });
        }
    }
}
