//! Takes seams from the candidates, the best first. One is taken if no other that needs one of its edges comes near it.

use super::Outline;
use super::Tolerance;
use super::chains::{ChainBook, ChainMatch, RunChain};
use super::matches::Match;
use super::rings::ring_seams;
use super::run::EdgeRun;
use super::seams_found::{EdgeEnd, SeamsFound, run_end};

/// A seam with fewer points is not offered.
const LEAST: f64 = 2.0;
/// A chain with fewer points is not offered.
const LEAST_CHAIN: f64 = 2.75;
/// A seam is in doubt while another one for its edges is nearer to it than this, in points.
const MARGIN: f64 = 0.6;
/// Points for each end of a seam that is the last one in a point where other seams bring its sides together.
const LAST_IN_POINT: f64 = 0.75;
/// Points of what a chain brings with it: the sides of the ring that it is sewn into.
const CLOSES_RING: f64 = 2.0;

/// Takes the matches of which no rival is in reach, the best first.
pub(super) fn take_matches(candidates: &[Match], sewn: &mut SeamsFound, chained: &[ChainMatch], runs: &[EdgeRun]) {
    let in_chain = |run: &EdgeRun| runs.iter().enumerate().any(|(k, own)| is_chained(chained, k) && own.meets(run));
    let mut open: Vec<&Match> =
        candidates.iter().filter(|c| c.score >= LEAST && ![&c.a, &c.b].iter().any(|run| in_chain(run))).collect();
    loop {
        open.retain(|c| !sewn.has(&c.a) && !sewn.has(&c.b) && !sewn.makes_bag(c));
        // What closes the last gap in a point of the garment is likelier than what is merely as long.
        let scores: Vec<f64> = open.iter().map(|c| c.score + LAST_IN_POINT * sewn.closed_by(c) as f64).collect();
        let clear = open.iter().enumerate().find(|(k, own)| {
            let rival = |(i, other): (usize, &&Match)| {
                i != *k && own.meets(other) && scores[i] > scores[*k] - MARGIN && !own.holds(other)
            };
            !open.iter().enumerate().any(rival) && outweighs_excluded(own, scores[*k], &open, sewn)
        });
        let Some((k, clear)) = clear else { break };
        let mut seam = (*clear).clone();
        if scores[k] > seam.score {
            seam.score = scores[k];
            seam.reasons.push("it ends where seams bring both together".to_owned());
        }
        sewn.seams.push(seam);
    }
}

/// Whether a seam, with the best that goes with it, has more for it than the best two seams that it excludes because
/// they would make a bag with it. So the seams along both halves of a sleeve, and one over their caps, are told from
/// each other.
fn outweighs_excluded(own: &Match, score: f64, open: &[&Match], sewn: &SeamsFound) -> bool {
    let with = |seam: &Match| {
        let mut with = sewn.clone();
        with.seams.push(seam.clone());
        with
    };
    let pieces = |m: &Match| [m.a.piece.min(m.b.piece), m.a.piece.max(m.b.piece)];
    let excludes = |seam: &Match| {
        let with = with(seam);
        move |c: &Match| pieces(c) == pieces(own) && with.makes_bag(c)
    };
    let by_own = excludes(own);
    let mut excluded = open.iter().filter(|c| !own.meets(c) && by_own(c));
    let Some(first) = excluded.next() else { return true };
    let second = excluded.find(|c| !c.meets(first));
    let by_first = excludes(first);
    let beside = open.iter().find(|c| !own.meets(c) && !by_own(c) && by_first(c));
    let score = score + beside.map_or(0.0, |c| c.score);
    score > first.score + second.map_or(0.0, |second| second.score)
}

/// Takes the chains of which no rival is in reach, the best first, and the sides of the rings that they are sewn into.
pub(super) fn take_chains(
    outlines: &[Outline],
    runs: &[EdgeRun],
    tolerance: Tolerance,
    sewn: &mut SeamsFound,
    chained: &mut Vec<ChainMatch>,
) {
    let book = ChainBook { runs, outlines, free: free(runs, sewn, chained), sewn };
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
    rings.into_iter().for_each(|sides| close(runs, sides, sewn));
    take(runs, taken, sewn, chained);
}

/// Sews the ends of a band to each other, if nothing else is sewn to them.
fn close(runs: &[EdgeRun], sides: [EdgeEnd; 2], sewn: &mut SeamsFound) {
    let of = |side: EdgeEnd| runs.iter().find(|run| run.piece == side.piece && run.edges.contains(&side.edge));
    if let [Some(a), Some(b)] = sides.map(of)
        && !sewn.has(a)
        && !sewn.has(b)
    {
        let reasons = vec!["it closes the ring for the longer seam".to_owned()];
        let (a, b) = (a.clone(), b.clone());
        sewn.seams.push(Match { a, b, opposed: true, eased: false, score: CLOSES_RING, reasons });
    }
}

/// Takes chains, and what they join at their ends.
fn take(runs: &[EdgeRun], taken: Vec<ChainMatch>, sewn: &mut SeamsFound, chained: &mut Vec<ChainMatch>) {
    for chain in taken {
        let end = |runs_of: &RunChain, last: bool| {
            let at = if last { runs_of.runs.last() } else { runs_of.runs.first() };
            at.map(|&(run, forward)| run_end(&runs[run], forward == last))
        };
        for last in [false, true] {
            sewn.joined.extend(end(&chain.a, last).zip(end(&chain.b, last)).map(|(a, b)| [a, b]));
        }
        chained.push(chain);
    }
}

/// Takes the seams between rings that are clearest.
pub(super) fn take_rings(outlines: &[Outline], runs: &[EdgeRun], sewn: &mut SeamsFound, chained: &mut Vec<ChainMatch>) {
    let book = ChainBook { runs, outlines, free: free(runs, sewn, chained), sewn };
    let found = ring_seams(&book, chained, runs);
    for ring in found {
        take(runs, ring.parts, sewn, chained);
        ring.closing.into_iter().for_each(|sides| close(runs, sides, sewn));
    }
}

/// The runs that no seam has yet.
pub(super) fn left(runs: &[EdgeRun], sewn: &SeamsFound, chained: &[ChainMatch]) -> Vec<EdgeRun> {
    runs.iter().zip(free(runs, sewn, chained)).filter(|(_, free)| *free).map(|(run, _)| run.clone()).collect()
}

/// Which runs no seam has yet.
fn free(runs: &[EdgeRun], sewn: &SeamsFound, chained: &[ChainMatch]) -> Vec<bool> {
    runs.iter().enumerate().map(|(k, run)| !sewn.has(run) && !is_chained(chained, k)).collect()
}

/// The runs of a chain match, whichever way they are walked.
fn sorted(found: &ChainMatch) -> Vec<usize> {
    let mut runs: Vec<usize> = found.runs().collect();
    runs.sort_unstable();
    runs
}

/// Whether a chain has a run.
fn is_chained(chained: &[ChainMatch], run: usize) -> bool {
    chained.iter().any(|chain| chain.runs().any(|own| own == run))
}
