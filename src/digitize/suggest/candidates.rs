//! Two runs that may be sewn to each other, and how much speaks for each such seam.

use std::f64::consts::{FRAC_PI_4, PI};

use super::corner::turn_before;
use super::matches::{Match, dart, eased, matches, to_grain, ways};
use super::run::{EdgeRun, spans};
use super::seams_found::SeamsFound;
use super::{Outline, SHARE, Tolerance};

/// Points against a seam of the same side of two pieces that are each other's mirror image.
const TWINS: f64 = 3.0;
/// Points against a seam of the ends of two strips, of which one is cut more often, and how long these ends are, as a
/// share of the strips.
const STRIPS: f64 = 1.5;
const STRIP: f64 = 0.25;
/// The end of a strip is as long as the strip is wide, to this share.
const STRIP_END: f64 = 0.9;
/// Points against the mirror image of a piece that is its own.
const TURNED: f64 = 0.7;
/// Points against a seam that turns one of two upright pieces upside down.
const UPSIDE_DOWN: f64 = 1.0;
/// Points against a seam of two upper edges, or of two lower ones, that both go from side to side: waists and hems.
const SAME_LEVEL: f64 = 1.0;
/// Points for sides of a piece that a bulging edge lies between: a sleeve's.
const ROUND_CAP: f64 = 1.0;
/// An edge bulges that lies so far outside its chord, as a share of it.
const CAP: f64 = -0.05;

/// Every two runs, or parts of runs between notches, that fit each other, the best way to lay them along each other.
pub(super) fn candidates(outlines: &[Outline], runs: &[EdgeRun], tolerance: Tolerance) -> Vec<Match> {
    let sewn = SeamsFound::new(outlines);
    let mut spans: Vec<EdgeRun> = runs.iter().flat_map(|run| spans(&outlines[run.piece], run)).collect();
    spans.sort_by(|a, b| a.length().total_cmp(&b.length()));
    let mut found = Vec::new();
    for (i, a) in spans.iter().enumerate() {
        let most = a.length() + tolerance.of(a.length()) * (1.0 + SHARE);
        let near = spans[i + 1..].iter().take_while(|b| b.length() <= most);
        for b in near.filter(|b| !a.meets(b)) {
            // In the order of the drawing.
            let (a, b) = if (a.piece, &a.edges) <= (b.piece, &b.edges) { (a, b) } else { (b, a) };
            if !is_second_image(outlines, &sewn, [a, b]) {
                found.extend(best(outlines, runs, &sewn, a, b, tolerance).map(|own| unturned(outlines, &sewn, own)));
            }
        }
    }
    found.sort_by(|x, y| y.score.total_cmp(&x.score));
    found
}

/// Every two sides that no seam has, of which one is a little longer.
pub(super) fn eased_candidates(
    sewn: &SeamsFound,
    outlines: &[Outline],
    left: &[EdgeRun],
    tolerance: Tolerance,
) -> Vec<Match> {
    let of = |(k, a): (usize, &EdgeRun)| {
        let in_step = |found: &Match| sewn.is_in_step(found);
        let way = |b: &EdgeRun| {
            let both = ways(outlines, a, b).iter();
            let mut fits = both.filter_map(|way| eased(outlines, [a, b], tolerance, *way, in_step));
            fits.find(|found| !sewn.is_upside_down(found))
        };
        left[k + 1..].iter().filter_map(way).collect::<Vec<Match>>()
    };
    let mut found: Vec<Match> = left.iter().enumerate().flat_map(of).collect();
    found.sort_by(|x, y| y.score.total_cmp(&x.score));
    found
}

/// The better of the two ways to sew two runs.
fn best(
    outlines: &[Outline],
    runs: &[EdgeRun],
    sewn: &SeamsFound,
    a: &EdgeRun,
    b: &EdgeRun,
    tolerance: Tolerance,
) -> Option<Match> {
    if let Some(dart) = tip(outlines, a, b).and_then(|angle| dart(a, b, angle)) {
        return Some(dart);
    }
    let whole = runs.iter().filter(|run| run.piece == a.piece || run.piece == b.piece);
    let parts = [a, b]
        .iter()
        .filter(|span| !whole.clone().any(|run| run.edges == span.edges && run.piece == span.piece))
        .count();
    // Whatever else has two sides alike is sewn to others along them.
    let is_cap = |run: &EdgeRun| run.hollow() < CAP && lies_between(outlines, run, a, b);
    let goes_down = |run: &EdgeRun| to_grain(outlines, run).is_none_or(|angle| angle <= FRAC_PI_4);
    let down = goes_down(a) && goes_down(b);
    let round_cap = a.piece == b.piece && parts == 0 && down && runs.iter().any(is_cap);
    if a.piece == b.piece && !round_cap {
        return None;
    }
    let ways = matches(outlines, a, b, tolerance).into_iter().map(|mut found| {
        if round_cap {
            found.score += ROUND_CAP;
            found.reasons.push("sides of a sleeve".to_owned());
        }
        found.score -= 0.5 * parts as f64;
        found.score -= if sewn.is_upside_down(&found) { UPSIDE_DOWN } else { 0.0 };
        found.score -= if sewn.is_same_level(&found) { SAME_LEVEL } else { 0.0 };
        found.score -= if sewn.is_of_twins(&found) && !a.path.is_straight() { TWINS } else { 0.0 };
        found.score -= if strips_apart(outlines, sewn, a, b) { STRIPS } else { 0.0 };
        let turned = !found.opposed && sewn.is_symmetric(a.piece) && sewn.is_symmetric(b.piece);
        found.score -= if turned { TURNED } else { 0.0 };
        found
    });
    // Courses and notches tell which ends meet; else what lies beside the ends.
    let cost = |found: &Match| 0.4 * sewn.unlikeness(found) - found.score;
    ways.min_by(|x, y| cost(x).total_cmp(&cost(y)))
}

/// The edges of the mirror image of a run of a whole piece that is its own, where the other run is of a piece of which
/// there is a left and a right.
fn image(outlines: &[Outline], sewn: &SeamsFound, run: &EdgeRun, other: &EdgeRun) -> Option<Vec<usize>> {
    if !outlines[other.piece].mirrored || outlines[run.piece].mirrored {
        return None;
    }
    let images = sewn.edge_images(run.piece);
    let of = |edge: &usize| images.iter().find(|(own, _)| own == edge).map(|(_, image)| *image);
    run.edges.iter().rev().map(of).collect()
}

/// Whether a seam is the mirror image of another one: of two sides of a whole piece the first stands for both.
fn is_second_image(outlines: &[Outline], sewn: &SeamsFound, [a, b]: [&EdgeRun; 2]) -> bool {
    let second =
        |run: &EdgeRun, other: &EdgeRun| image(outlines, sewn, run, other).is_some_and(|image| image < run.edges);
    second(a, b) || second(b, a)
}

/// A seam that is walked the same way round on a whole piece and on one half of a pair, as its mirror image, in which
/// the right sides lie together.
fn unturned(outlines: &[Outline], sewn: &SeamsFound, own: Match) -> Match {
    if own.opposed {
        return own;
    }
    let turned = |run: &EdgeRun, other: &EdgeRun| {
        EdgeRun::new(&outlines[run.piece], run.piece, &image(outlines, sewn, run, other)?)
    };
    match (turned(&own.a, &own.b), turned(&own.b, &own.a)) {
        (Some(a), _) => Match { a, opposed: true, ..own },
        (_, Some(b)) => Match { b, opposed: true, ..own },
        _ => own,
    }
}

/// Whether two runs are the short ends of strips of which one is cut more often: bindings of a neck and of arms are as
/// wide as each other.
fn strips_apart(outlines: &[Outline], sewn: &SeamsFound, a: &EdgeRun, b: &EdgeRun) -> bool {
    let is_end = |run: &EdgeRun| {
        let [narrow, wide] = sewn.sizes(run.piece);
        run.length() <= STRIP * wide && narrow <= run.length() / STRIP_END
    };
    let more = |one: &EdgeRun, other: &EdgeRun| outlines[one.piece].pair && outlines[other.piece].single;
    a.piece != b.piece && (more(a, b) || more(b, a)) && is_end(a) && is_end(b)
}

/// The angle inside the piece at the corner that two runs follow each other round.
fn tip(outlines: &[Outline], a: &EdgeRun, b: &EdgeRun) -> Option<f64> {
    let outline = &outlines[a.piece];
    let follows = |one: &EdgeRun, next: &EdgeRun| {
        (one.piece == next.piece && (one.edges[one.edges.len() - 1] + 1) % outline.edges.len() == next.edges[0])
            .then(|| PI - turn_before(outline, next.edges[0]))
    };
    follows(a, b).or_else(|| follows(b, a))
}

/// Whether a run is all that lies between two others on one side.
fn lies_between(outlines: &[Outline], run: &EdgeRun, a: &EdgeRun, b: &EdgeRun) -> bool {
    let count = outlines[a.piece].edges.len();
    let next = |run: &EdgeRun| (run.edges[run.edges.len() - 1] + 1) % count;
    let goes = |from: &EdgeRun, to: &EdgeRun| next(from) == run.edges[0] && next(run) == to.edges[0];
    run.piece == a.piece && (goes(a, b) || goes(b, a))
}
