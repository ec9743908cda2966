//! Which edges may be sewn together: runs from corner to corner that fit each other, then chains of what is left, then
//! the halves of a pair.
//!
//! Each possible seam is given points for what speaks for it: lengths, notches, courses, the grain. The best is taken
//! as long as no other that would need one of its edges comes near it; what is in doubt is not offered.

mod chains;
mod guess;
mod matches;
mod notched;
mod of_file;
mod run;
mod sewn;
mod written;

use std::f64::consts::FRAC_PI_4;

use super::edges::FileEdge;
use crate::geometry::Vec2;
use crate::pattern::{DEFAULT_TOLERANCE, PlaceMeaning, PlaceWord};
use chains::{ChainBook, ChainMatch, RunChain};
pub(in crate::digitize) use guess::Guess;
use guess::guesses;
use matches::{Match, dart, matches, to_grain};
pub use of_file::suggestions;
use run::{EdgeRun, runs, says, spans, turn_before};
use sewn::{EdgeEnd, SeamsFound};
use written::written;
pub use written::{Suggestion, sewn};

/// Edges of a seam differ by no more than this share of their length.
const SHARE: f64 = 0.004;
/// Among more edges than this every length fits by chance.
const MOST_EDGES: usize = 2000;
/// A seam with fewer points is not offered.
const LEAST: f64 = 2.0;
/// A chain with fewer points is not offered.
const LEAST_CHAIN: f64 = 2.75;
/// A seam is in doubt while another one for its edges is nearer to it than this, in points.
const MARGIN: f64 = 0.6;
/// Points against a seam that turns one of two upright pieces upside down.
const UPSIDE_DOWN: f64 = 1.0;
/// Points for sides of a piece that a bulging edge lies between: a sleeve's.
const ROUND_CAP: f64 = 1.0;
/// An edge bulges that lies so far outside its chord, as a share of it.
const CAP: f64 = -0.05;
/// Points of what a chain brings with it: the sides of the ring that it is sewn into.
const CLOSES_RING: f64 = 2.0;
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
/// So many matches beside darts tell how exact a drawing is.
const SURE: usize = 2;

/// The note on a seam along a crotch.
const CROTCH_SAID: &str = "a crotch";
/// The halves of a pair may be sewn to each other at edges called so.
const CENTER: [&str; 2] = ["center", "centre"];
/// A piece called so opens at no center of its own.
const BACK: &str = "back";

/// A piece's edges.
pub(super) struct Outline {
    pub(super) piece: String,
    pub(super) edges: Vec<FileEdge>,
    /// The allowance of each edge, metres, where one was drawn.
    pub(super) allowances: Vec<Option<f64>>,
    /// The edge that lies on the fold of the cloth: no seam is there.
    pub(super) fold: Option<String>,
    /// Whether it is cut as drawn and mirrored.
    pub(super) pair: bool,
    /// Whether a mirror image of it is cut, too: as the other of a pair, or as the other half.
    pub(super) mirrored: bool,
    /// Direction of the warp, of length 1.
    pub(super) warp: Option<Vec2>,
    /// The material it is cut from, if that is told.
    pub(super) material: Option<String>,
    /// Number of its size, where sizes are drawn over one another.
    pub(super) size: Option<usize>,
}

/// The tolerance of lengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// Metres.
    least: f64,
    /// Share of the length.
    share: f64,
}

impl Tolerance {
    pub(super) fn of(self, length: f64) -> f64 {
        self.least.max(self.share * length)
    }
}

/// Of the seams of a drawing that is exact the lengths differ by no more than this (metres), which leaves what programs
/// round.
const EXACT: f64 = 3e-4;
/// Largest difference of two lengths that may be sewn, from how far those of the seams differ that are sure.
const SLACK: f64 = 3.0;

/// The seams that pieces may have, those that most speaks for first, and a guess for each piece. Each size is sewn by
/// itself.
pub(super) fn suggest(outlines: Vec<Outline>) -> (Vec<Suggestion>, Vec<Guess>) {
    let mut sizes: Vec<Option<usize>> = outlines.iter().map(|outline| outline.size).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let (mut suggestions, mut guesses) = (Vec::new(), vec![Guess::default(); outlines.len()]);
    let mut outlines: Vec<(usize, Outline)> = outlines.into_iter().enumerate().collect();
    for size in sizes {
        let (own, rest): (Vec<_>, Vec<_>) = outlines.into_iter().partition(|(_, outline)| outline.size == size);
        outlines = rest;
        let (numbers, own): (Vec<usize>, Vec<Outline>) = own.into_iter().unzip();
        let (seams, guessed) = of_one_size(&own);
        suggestions.extend(seams);
        numbers.into_iter().zip(guessed).for_each(|(k, guess)| guesses[k] = guess);
    }
    suggestions.sort_by(|a: &Suggestion, b| b.score.total_cmp(&a.score));
    (suggestions, guesses)
}

fn of_one_size(outlines: &[Outline]) -> (Vec<Suggestion>, Vec<Guess>) {
    if outlines.iter().map(|outline| outline.edges.len()).sum::<usize>() > MOST_EDGES {
        return (Vec::new(), vec![Guess::default(); outlines.len()]);
    }
    let runs = runs(outlines);
    let roughly = found(outlines, &runs, Tolerance { least: DEFAULT_TOLERANCE, share: SHARE });
    // Lengths are compared as exactly as the drawing is: what differs by more fits by chance.
    let apart = |seam: &Match| (seam.a.length() - seam.b.length()).abs();
    let sure = roughly.seams.iter().filter(|seam| seam.score < matches::DART_SCORE && !seam.reasons.is_empty());
    let apart: Vec<f64> = sure.map(apart).collect();
    let least = (SLACK * apart.iter().copied().fold(0.0, f64::max)).clamp(EXACT, DEFAULT_TOLERANCE);
    let share = SHARE * least / DEFAULT_TOLERANCE;
    let found = if least < DEFAULT_TOLERANCE && apart.len() >= SURE {
        found(outlines, &runs, Tolerance { least, share })
    } else {
        roughly
    };
    let suggestions = written(outlines, &found.sides, &found.seams, &found.chained, &found.mirrored);
    (suggestions, guesses(outlines, &found.sides, &found.chained, &found.mirrored))
}

/// All that may be sewn.
struct Sewable {
    /// Runs that are no center of a pair.
    sides: Vec<EdgeRun>,
    seams: Vec<Match>,
    chained: Vec<ChainMatch>,
    mirrored: Vec<(EdgeRun, f64, String)>,
}

/// The seams that are possible within a tolerance of lengths.
fn found(outlines: &[Outline], runs: &[EdgeRun], tolerance: Tolerance) -> Sewable {
    let (middle, sides): (Vec<EdgeRun>, Vec<EdgeRun>) =
        runs.iter().cloned().partition(|run| is_center(outlines, runs, run));
    let mut sewn = SeamsFound::new(outlines);
    let sure = middle.iter().filter(|run| is_sure_center(outlines, run));
    sewn.centers = sure.flat_map(|run| run.edges.iter().map(|&edge| (run.piece, edge))).collect();
    let mut chained: Vec<ChainMatch> = Vec::new();
    let candidates = candidates(outlines, &sides, tolerance);
    let is_whole = |own: &EdgeRun| sides.iter().any(|run| run.piece == own.piece && run.edges == own.edges);
    let (whole, parts): (Vec<Match>, Vec<Match>) =
        candidates.into_iter().partition(|found| is_whole(&found.a) && is_whole(&found.b));
    // Parts of edges between notches come last: they are parts of chains, too.
    for candidates in [whole, parts] {
        loop {
            let before = (sewn.seams.len(), chained.len());
            take_matches(&candidates, &mut sewn, &chained, &sides);
            take_chains(outlines, &sides, tolerance, &mut sewn, &mut chained);
            if before == (sewn.seams.len(), chained.len()) {
                break;
            }
        }
    }
    let left = sides.iter().enumerate().filter(|(k, run)| !sewn.has(run) && !is_chained(&chained, *k));
    let mut mirrored: Vec<(EdgeRun, f64, String)> = middle.iter().map(|run| center(outlines, run)).collect();
    mirrored.extend(left.filter_map(|(_, run)| crotch(outlines, &sewn, run)));
    let seams = sewn.seams;
    Sewable { sides, seams, chained, mirrored }
}

/// Whether a run is the center of a pair, called so or the only straight one that lies exactly along the grain: nothing
/// but its mirror image is sewn to it.
fn is_center(outlines: &[Outline], runs: &[EdgeRun], run: &EdgeRun) -> bool {
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
    outline.pair && (called() || (of_trunk && is_down(run) && only()))
}

fn is_chained(chained: &[ChainMatch], run: usize) -> bool {
    chained.iter().any(|chain| chain.runs().any(|own| own == run))
}

/// Every two runs, or parts of runs between notches, that fit each other, the best way to lay them along each other.
fn candidates(outlines: &[Outline], runs: &[EdgeRun], tolerance: Tolerance) -> Vec<Match> {
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
            found.extend(best(outlines, runs, &sewn, a, b, tolerance));
        }
    }
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
        found
    });
    // Courses and notches tell which ends meet; else what lies beside the ends.
    let cost = |found: &Match| 0.4 * sewn.unlikeness(found) - found.score;
    ways.min_by(|x, y| cost(x).total_cmp(&cost(y)))
}

/// The angle inside the piece at the corner that two runs follow each other round.
fn tip(outlines: &[Outline], a: &EdgeRun, b: &EdgeRun) -> Option<f64> {
    let outline = &outlines[a.piece];
    let follows = |one: &EdgeRun, next: &EdgeRun| {
        (one.piece == next.piece && (one.edges[one.edges.len() - 1] + 1) % outline.edges.len() == next.edges[0])
            .then(|| std::f64::consts::PI - turn_before(outline, next.edges[0]))
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

/// Takes the matches of which no rival is in reach, the best first.
fn take_matches(candidates: &[Match], sewn: &mut SeamsFound, chained: &[ChainMatch], runs: &[EdgeRun]) {
    let in_chain = |run: &EdgeRun| runs.iter().enumerate().any(|(k, own)| is_chained(chained, k) && own.meets(run));
    let mut open: Vec<&Match> =
        candidates.iter().filter(|c| c.score >= LEAST && ![&c.a, &c.b].iter().any(|run| in_chain(run))).collect();
    loop {
        open.retain(|c| !sewn.has(&c.a) && !sewn.has(&c.b) && !sewn.makes_bag(c));
        let clear = open.iter().enumerate().find(|(k, own)| {
            let rival = |(i, other): (usize, &&Match)| {
                i != *k && own.meets(other) && other.score > own.score - MARGIN && !own.holds(other)
            };
            !open.iter().enumerate().any(rival) && own.score > worth_of_excluded(own, &open, sewn)
        });
        let Some((_, clear)) = clear else { break };
        sewn.seams.push((*clear).clone());
    }
}

/// How much speaks for the seams that a seam excludes because they would make a bag with it: the points of the best two
/// that go together. Seams along the halves of a sleeve are excluded so by one over their caps.
fn worth_of_excluded(own: &Match, open: &[&Match], sewn: &SeamsFound) -> f64 {
    let mut with = sewn.clone();
    with.seams.push(own.clone());
    let pieces = |m: &Match| [m.a.piece.min(m.b.piece), m.a.piece.max(m.b.piece)];
    let excluded = open.iter().filter(|c| pieces(c) == pieces(own) && !own.meets(c) && with.makes_bag(c));
    let excluded: Vec<&&Match> = excluded.collect();
    let Some(first) = excluded.first() else { return 0.0 };
    let second = excluded.iter().find(|c| !c.meets(first));
    first.score + second.map_or(0.0, |second| second.score)
}

/// Takes the chains of which no rival is in reach, the best first, and the sides of the rings that they are sewn into.
fn take_chains(
    outlines: &[Outline],
    runs: &[EdgeRun],
    tolerance: Tolerance,
    sewn: &mut SeamsFound,
    chained: &mut Vec<ChainMatch>,
) {
    let free: Vec<bool> = runs.iter().enumerate().map(|(k, run)| !sewn.has(run) && !is_chained(chained, k)).collect();
    let book = ChainBook { runs, outlines, sewn, free };
    let chains = book.chains();
    let target = |chain: &RunChain| match chain.runs[..] {
        [(_, forward)] => forward,
        [first, .., last] => first < last,
        [] => false,
    };
    let mut found: Vec<ChainMatch> = Vec::new();
    for b in chains.iter().filter(|chain| target(chain)) {
        let fits = |a: &&RunChain| a.runs.len() >= b.runs.len();
        found.extend(chains.iter().filter(fits).filter_map(|a| {
            let fit = book.fit(a, b, tolerance)?;
            (fit.score >= LEAST_CHAIN && (fit.doubled || fit.eased || a.runs.len() > 1)).then_some(fit)
        }));
    }
    found.sort_by(|x, y| y.score.total_cmp(&x.score));
    let mut rings: Vec<[EdgeEnd; 2]> = Vec::new();
    let mut taken: Vec<ChainMatch> = Vec::new();
    let same = |x: &ChainMatch, y: &ChainMatch| sorted(x) == sorted(y);
    for (k, fit) in found.iter().enumerate() {
        let meets = |other: &ChainMatch| fit.runs().any(|run| other.runs().any(|own| own == run));
        let rival = |(i, other): (usize, &ChainMatch)| {
            i != k && meets(other) && other.score > fit.score - MARGIN && !same(fit, other)
        };
        if taken.iter().any(meets) || found.iter().enumerate().any(rival) {
            continue;
        }
        rings.extend(fit.reasons.iter().any(|r| r.starts_with("it closes")).then(|| book.closing(&fit.b)).flatten());
        taken.push(fit.clone());
    }
    for sides in rings {
        let [a, b] =
            sides.map(|side| runs.iter().find(|run| run.piece == side.piece && run.edges.contains(&side.edge)));
        if let (Some(a), Some(b)) = (a, b)
            && !sewn.has(a)
            && !sewn.has(b)
        {
            let reasons = vec!["it closes the ring for the longer seam".to_owned()];
            sewn.seams.push(Match { a: a.clone(), b: b.clone(), opposed: true, score: CLOSES_RING, reasons });
        }
    }
    chained.extend(taken);
}

/// The runs of a chain match, whichever way they are walked.
fn sorted(found: &ChainMatch) -> Vec<usize> {
    let mut runs: Vec<usize> = found.runs().collect();
    runs.sort_unstable();
    runs
}

/// Whether the center of a pair is surely sewn: it is called so, or it is that of a back.
fn is_sure_center(outlines: &[Outline], run: &EdgeRun) -> bool {
    let outline = &outlines[run.piece];
    run.edges.iter().all(|&k| says(&outline.edges[k].name, &CENTER)) || says(&outline.piece, &[BACK])
}

/// A seam between the halves of a pair down its center, and what speaks for it.
fn center(outlines: &[Outline], run: &EdgeRun) -> (EdgeRun, f64, String) {
    let (points, reason) = if is_sure_center(outlines, run) {
        (BY_NAME, "center of a pair")
    } else {
        (BY_COURSE, "along the grain, if it is not left open")
    };
    (run.clone(), points, reason.to_owned())
}

/// A seam between the halves of a pair along a crotch, and what speaks for it: its piece is sewn to another on both
/// sides of a leg.
fn crotch(outlines: &[Outline], sewn: &SeamsFound, run: &EdgeRun) -> Option<(EdgeRun, f64, String)> {
    let down = |run: &EdgeRun| to_grain(outlines, run).is_some_and(|angle| angle <= DOWN);
    let bends = run.length() >= LONG && down(run) && run.hollow() >= CROTCH;
    let across = |seam: &Match| match [seam.a.piece, seam.b.piece] {
        [a, b] if a == b || !down(&seam.a) || !down(&seam.b) => None,
        [a, b] if a == run.piece => Some(b),
        [a, b] if b == run.piece => Some(a),
        _ => None,
    };
    let others: Vec<usize> = sewn.seams.iter().filter_map(across).collect();
    let is_leg = others.iter().any(|piece| others.iter().filter(|other| *other == piece).count() > 1);
    (outlines[run.piece].pair && bends && is_leg).then(|| (run.clone(), BY_COURSE, CROTCH_SAID.to_owned()))
}
