//! Notches along seams: where a walk meets them, and whether those of the two sides meet.

use super::diagnostic::{Findings, Spot};
use super::edge_name::edge_name;
use super::file::SeamFile;
use super::problem::Problem;
use super::rim::joints;
use super::{EdgeId, Garment, Notch, Piece, Seam, Span};

/// Distance by which notches may miss each other, after ease, metres. Nobody draws or sews less exactly on purpose.
const FAR: f64 = 0.010;
/// Distance within which a notch lies on the end of a span, metres.
const ON_END: f64 = 1e-9;

/// A notch met on a walk along a chain, or a joint of its edges that stands for one.
#[derive(Clone, Copy)]
pub(super) struct Met {
    edge: EdgeId,
    /// None at a joint.
    double: Option<bool>,
    /// Metres from where the walk began.
    pub(super) along: f64,
}

/// The notches that a walk along the chain meets, in order.
pub(super) fn met(pieces: &[Piece], chain: &[Span]) -> Vec<Met> {
    let mut walked = 0.0;
    let mut met = Vec::new();
    for span in chain {
        let (low, high) = span.sorted();
        let inside = |n: &&Notch| n.edge == span.edge && (low - ON_END..=high + ON_END).contains(&n.at);
        let on = pieces[span.edge.piece].notches.iter().filter(inside);
        let along = |notch: &Notch| walked + (notch.at - span.from).abs();
        met.extend(on.map(|n| Met { edge: n.edge, double: Some(n.double), along: along(n) }));
        walked += span.length();
    }
    met.sort_by(|a, b| a.along.total_cmp(&b.along));
    met
}

/// The notches of both sides of a seam that is sewn notch to notch. If one side has fewer, by as many as its edges have
/// joints, the joints count as notches: the notch at the crown of a sleeve meets the shoulder seam.
pub(super) fn matched(pieces: &[Piece], a: &[Span], b: &[Span]) -> [Vec<Met>; 2] {
    let mut both = [a, b].map(|chain| met(pieces, chain));
    let [on_a, on_b] = [both[0].len(), both[1].len()];
    let (few, chain) = if on_a < on_b { (0, a) } else { (1, b) };
    let joints = joints(chain);
    if joints.len() == on_a.abs_diff(on_b) {
        let at = |(along, span): (f64, &Span)| Met { edge: span.edge, double: None, along };
        both[few].extend(joints.into_iter().zip(chain).map(at));
        both[few].sort_by(|a, b| a.along.total_cmp(&b.along));
    }
    both
}

/// Finds notches that end up far from their partners.
///
/// With `match: notches` this is an error, because the cloth between would be stretched and crumpled. Otherwise single
/// notches are compared with single ones, double with double, and it is a warning. A notch without a partner of its
/// kind marks something else. `written` gives the file's seam for each seam. Seams that are there on both sides of the
/// garment are examined once.
pub(super) fn check(garment: &Garment, written: &[Option<usize>], files: &[SeamFile], findings: &mut Findings) {
    for (k, seam) in garment.seams.iter().enumerate() {
        let Some(file) = written[k].filter(|w| !written[..k].contains(&Some(*w))).map(|w| &files[w]) else { continue };
        if file.match_notches.as_ref().is_some_and(|m| m.value) {
            check_matched(garment, seam, file.name.at, findings);
        } else {
            [false, true].into_iter().for_each(|double| check_kind(garment, seam, double, file.name.at, findings));
        }
    }
}

/// For notches that are sewn to one another in order: the first pair that cannot be, and any double notch that meets a
/// single one, as where a sleeve's front is taken for its back.
fn check_matched(garment: &Garment, seam: &Seam, at: Spot, findings: &mut Findings) {
    let [on_a, on_b] = matched(&garment.pieces, &seam.a, &seam.b);
    let longer = seam.length_b() - seam.length_a();
    let mut pairs = on_a.iter().zip(&on_b);
    if let Some(problem) = pairs.find_map(|(one, other)| far_apart(garment, seam, [one, other], longer)) {
        findings.error(at, problem);
    }
    let unlike = |(a, b): &(&Met, &Met)| a.double.zip(b.double).is_some_and(|(a, b)| a != b);
    if let Some((one, other)) = on_a.iter().zip(&on_b).find(unlike) {
        let [one, other] = [one, other].map(|m| place(garment, m));
        findings.warn(at, Problem::NotchesUnlike { seam: seam.name.clone(), one, other });
    }
}

fn check_kind(garment: &Garment, seam: &Seam, double: bool, at: Spot, findings: &mut Findings) {
    let side = |chain: &[Span]| {
        let met = met(&garment.pieces, chain).into_iter().filter(|m| m.double == Some(double));
        (met.collect::<Vec<Met>>(), chain.iter().map(Span::length).sum::<f64>())
    };
    let (mut few, mut many) = (side(&seam.a), side(&seam.b));
    if many.0.len() < few.0.len() {
        std::mem::swap(&mut few, &mut many);
    }
    let longer = many.1 - few.1;
    for one in &few.0 {
        let apart = |other: &Met| missing(other.along - one.along, longer);
        let Some(other) = many.0.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))) else { return };
        if let Some(problem) = far_apart(garment, seam, [one, other], longer) {
            findings.warn(at, problem);
        }
    }
}

/// Problem of two notches that should meet. The second lies on the side that is `longer`.
fn far_apart(garment: &Garment, seam: &Seam, [one, other]: [&Met; 2], longer: f64) -> Option<Problem> {
    let apart = missing(other.along - one.along, longer);
    (apart > FAR).then(|| Problem::NotchesApart {
        seam: seam.name.clone(),
        one: place(garment, one),
        other: place(garment, other),
        apart: 1e3 * apart,
    })
}

fn place(garment: &Garment, met: &Met) -> String {
    format!("{:.0} mm on {}", 1e3 * met.along, edge_name(&garment.pieces, met.edge))
}

/// Distance by which two notches miss each other, where the second is `off` further along a side that is `longer`. Any
/// part of the ease, gather or stretch may lie before them.
fn missing(off: f64, longer: f64) -> f64 {
    (longer.min(0.0) - off).max(off - longer.max(0.0)).max(0.0)
}
