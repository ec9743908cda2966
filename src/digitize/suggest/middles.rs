//! The middle of the wearer: seams between the halves of a pair.

use super::Outline;
use super::chains::{ChainEnds, ChainMatch};
use super::matches::{Match, to_grain};
use super::run::{EdgeRun, says};
use super::seams_found::{EdgeEnd, SeamsFound, run_end};
use crate::geometry::Vec2;
use crate::pattern::{PlaceMeaning, PlaceWord};

/// Points of a seam between the halves of a pair where the name of the edge or of its piece tells, and where its course
/// does.
const BY_NAME: f64 = 2.5;
const BY_COURSE: f64 = 2.0;
/// Shortest seam down the middle (metres) that its course tells, and how far it bends aside: a crotch.
const LONG: f64 = 0.15;
const CROTCH: f64 = 0.03;
/// Such a seam runs along the grain, to this (radians, 35 degrees); a straight one to this (a fifth of a degree), as it
/// was drafted.
const DOWN: f64 = 0.61;
const STRAIGHT_DOWN: f64 = 0.0035;
/// Edges that are as long as each other to this (metres).
const AS_LONG: f64 = 1e-3;
/// The center of a piece lies across from its side: the cosine of the angle between their directions outwards is no
/// more than minus this.
const ACROSS: f64 = 0.8;

/// The notes on a seam down the center that may be left open, and on one along a crotch.
const CENTER_SAID: &str = "along the grain, if it is not left open";
const HOOD_SAID: &str = "the crown of a hood";
/// A collar is no higher than this share of its width; a hood is higher.
const LOW: f64 = 0.5;
/// The crown of a hood bulges by more than this share of its chord.
const CROWN: f64 = -0.05;
pub(super) const CROTCH_SAID: &str = "a crotch";
/// The halves of a pair may be sewn to each other at edges called so.
const CENTER: [&str; 2] = ["center", "centre"];
/// A piece called so opens at no center of its own.
const BACK: &str = "back";

/// Whether a run is the center of a pair, called so or the only straight one that lies exactly along the grain: nothing
/// but its mirror image is sewn to it.
pub(super) fn is_center(outlines: &[Outline], runs: &[EdgeRun], run: &EdgeRun) -> bool {
    let outline = &outlines[run.piece];
    let called = || run.edges.iter().all(|&k| says(&outline.edges[k].name, &CENTER));
    let is_down = |run: &EdgeRun| {
        let down = to_grain(outlines, run).is_some_and(|angle| angle <= STRAIGHT_DOWN);
        down && run.path.is_straight() && run.length() >= LONG
    };
    let only = || runs.iter().filter(|other| other.piece == run.piece && is_down(other)).count() == 1;
    // Halves of sleeves and collars, cuffs and pockets have such edges, too.
    let meanings: Vec<PlaceMeaning> = PlaceWord::in_name(&outline.piece).into_iter().map(PlaceWord::meaning).collect();
    let says = |wanted: &[PlaceMeaning]| meanings.iter().any(|meaning| wanted.contains(meaning));
    let of_trunk = says(&[PlaceMeaning::Front, PlaceMeaning::Back]) && !says(&[PlaceMeaning::Arm, PlaceMeaning::Neck]);
    // As long as the side of a piece that has no center there, it is a side.
    let is_side = || {
        let whole = |other: &&EdgeRun| !outlines[other.piece].pair && is_down(other);
        runs.iter().filter(whole).any(|other| (other.length() - run.length()).abs() <= AS_LONG)
    };
    outline.pair && (called() || (of_trunk && is_down(run) && only() && !is_side()))
}

/// Whether the center of a pair is surely sewn: it is called so, or it is that of a back.
pub(super) fn is_sure_center(outlines: &[Outline], run: &EdgeRun) -> bool {
    let outline = &outlines[run.piece];
    run.edges.iter().all(|&k| says(&outline.edges[k].name, &CENTER)) || says(&outline.piece, &[BACK])
}

/// A seam between the halves of a pair down its center, and what speaks for it.
pub(super) fn center(outlines: &[Outline], run: &EdgeRun) -> (EdgeRun, f64, String) {
    let (points, reason) =
        if is_sure_center(outlines, run) { (BY_NAME, "center of a pair") } else { (BY_COURSE, CENTER_SAID) };
    (run.clone(), points, reason.to_owned())
}

/// The seams down the middle that other seams tell: of each piece that is sewn to others along its sides.
pub(super) fn told_by_seams(outlines: &[Outline], sewn: &SeamsFound, left: &[EdgeRun]) -> Vec<(EdgeRun, f64, String)> {
    let of = |(piece, outline): (usize, &Outline)| {
        let own: Vec<&EdgeRun> = left.iter().filter(|run| run.piece == piece).collect();
        let down: Vec<(usize, &EdgeRun)> = sides(outlines, sewn, piece);
        let crotch = if outline.pair { crotch(outlines, sewn, &own, &down) } else { Vec::new() };
        let center = (outline.pair && crotch.is_empty()).then(|| opposite(outlines, sewn, &own, &down)).flatten();
        let crotch = crotch.into_iter().map(|run| (run.clone(), BY_COURSE, CROTCH_SAID.to_owned()));
        crotch.chain(center.map(|run| (run.clone(), BY_COURSE, CENTER_SAID.to_owned()))).collect::<Vec<_>>()
    };
    outlines.iter().enumerate().flat_map(of).collect()
}

fn is_down(outlines: &[Outline], run: &EdgeRun) -> bool {
    to_grain(outlines, run).is_some_and(|angle| angle <= DOWN)
}

/// The seams of a piece that run down the grain of both sides, each with the piece that it is sewn to.
fn sides<'s>(outlines: &[Outline], sewn: &'s SeamsFound, piece: usize) -> Vec<(usize, &'s EdgeRun)> {
    let across = |seam: &'s Match| match [seam.a.piece, seam.b.piece] {
        [a, b] if a == b || !is_down(outlines, &seam.a) || !is_down(outlines, &seam.b) => None,
        [a, b] if a == piece => Some((b, &seam.a)),
        [a, b] if b == piece => Some((a, &seam.b)),
        _ => None,
    };
    sewn.seams.iter().filter_map(across).collect()
}

/// The crotch of a piece that is sewn to another one on both sides of a leg: what runs down the grain beside one of
/// these seams, and bends.
fn crotch<'r>(
    outlines: &[Outline],
    sewn: &SeamsFound,
    own: &[&'r EdgeRun],
    sides: &[(usize, &EdgeRun)],
) -> Vec<&'r EdgeRun> {
    let is_leg = |(other, _): &&(usize, &EdgeRun)| sides.iter().filter(|(piece, _)| piece == other).count() > 1;
    let mut best: Vec<&EdgeRun> = Vec::new();
    for (seam, at_end) in sides.iter().filter(is_leg).flat_map(|(_, seam)| [(*seam, false), (*seam, true)]) {
        let mut beside = sewn.beside(seam, at_end);
        let mut found: Vec<&EdgeRun> = Vec::new();
        // Its next run, as long as that goes down the grain.
        while let Some(run) = own.iter().find(|run| run_end(run, beside.at_end) == beside)
            && is_down(outlines, run)
            && !found.iter().any(|before| before.meets(run))
        {
            found.push(run);
            beside = sewn.beside(run, !beside.at_end);
        }
        let bends = found.iter().any(|run| run.hollow() >= CROTCH);
        let length = |runs: &[&EdgeRun]| runs.iter().map(|run| run.length()).sum::<f64>();
        if bends && length(&found) >= LONG.max(length(&best)) {
            best = found;
        }
    }
    best
}

/// The only straight run along the grain that lies across from the side of a piece.
fn opposite<'r>(
    outlines: &[Outline],
    sewn: &SeamsFound,
    own: &[&'r EdgeRun],
    sides: &[(usize, &EdgeRun)],
) -> Option<&'r EdgeRun> {
    let outward = |run: &EdgeRun| run.along().map(|along| Vec2::new(along.y, -along.x));
    let across = |run: &EdgeRun| {
        let away = |(other, side): &(usize, &EdgeRun)| {
            let turned = outward(run).zip(outward(side)).is_some_and(|(a, b)| a.dot(&b) < -ACROSS);
            turned && outlines[*other].mirrored
        };
        sides.iter().any(away)
    };
    let center = |run: &&&EdgeRun| {
        let down = to_grain(outlines, run).is_some_and(|angle| angle <= STRAIGHT_DOWN);
        down && run.path.is_straight() && run.length() >= LONG && across(run)
    };
    let mut found = own.iter().filter(center);
    let one = found.next().copied();
    one.filter(|run| found.next().is_none() && !sewn.centers.contains(&(run.piece, run.edges[0])))
}

/// The centers of hoods, which are drawn as halves: the edge that bulges beside the seam round the neck, and what
/// follows it up to the face, which does not bulge.
pub(super) fn told_by_chains(
    sewn: &SeamsFound,
    outlines: &[Outline],
    chained: &[ChainMatch],
    runs: &[EdgeRun],
) -> Vec<(EdgeRun, f64, String)> {
    let mut found = Vec::new();
    for chain in chained.iter().filter(|chain| chain.a.ends == ChainEnds::Folds && !chain.doubled) {
        let [(run, _)] = chain.b.runs[..] else { continue };
        let neck = &runs[run];
        if !outlines[neck.piece].pair || sewn.is_low(neck.piece, LOW) {
            continue;
        }
        let at = |end: EdgeEnd| runs.iter().find(|next| run_end(next, end.at_end) == end);
        let beside = [false, true].map(|at_end| at(sewn.beside(neck, at_end)));
        let bulges = beside.map(|run| run.is_some_and(|run| run.hollow() < CROWN));
        let (Some(one), Some(other)) = (beside[0], beside[1]) else { continue };
        let (mut next, face, at_end) = match bulges {
            [true, false] => (Some(one), other, false),
            [false, true] => (Some(other), one, true),
            _ => continue,
        };
        while let Some(own) = next.filter(|own| !own.meets(face) && !own.meets(neck) && !sewn.has(own)) {
            found.push((own.clone(), BY_COURSE, HOOD_SAID.to_owned()));
            next = at(sewn.beside(own, at_end));
        }
    }
    found
}
