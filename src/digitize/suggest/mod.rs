//! Which edges may be sewn together: runs from corner to corner that fit each other, then chains of what is left, then
//! the halves of a pair.
//!
//! Each possible seam is given points for what speaks for it: lengths, notches, courses, the grain. The best is taken
//! as long as no other that would need one of its edges comes near it; what is in doubt is not offered.

mod candidates;
mod chains;
mod corner;
mod guess;
mod matches;
mod middles;
mod notched;
mod of_file;
mod over_darts;
mod rings;
mod run;
mod seams_found;
mod taking;
mod written;

use super::edges::FileEdge;
use crate::geometry::Vec2;
use crate::pattern::DEFAULT_TOLERANCE;
use candidates::{candidates, eased_candidates};
use chains::ChainMatch;
pub(in crate::digitize) use guess::Guess;
use guess::guesses;
use matches::Match;
use middles::{center, is_center, told_by_chains, told_by_seams};
pub use of_file::suggestions;
use run::{EdgeRun, runs};
use seams_found::SeamsFound;
use taking::{left, take_chains, take_matches, take_rings};
use written::{Sides, written};
pub use written::{Suggestion, sewn};

/// Edges of a seam differ by no more than this share of their length.
const SHARE: f64 = 0.004;
/// Among more edges than this every length fits by chance.
const MOST_EDGES: usize = 2000;
/// So many matches beside darts tell how exact a drawing is.
const SURE: usize = 2;

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
    /// Whether it is cut once as drawn, and is no half.
    pub(super) single: bool,
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
    let sewn = SeamsFound::new(outlines);
    let guesses = guesses(outlines, &found.sides, &found.chained, &found.mirrored, &found.seams, sewn.up);
    let sides = Sides::new(outlines, |piece| sewn.edge_images(piece), &guesses);
    let suggestions = written(outlines, &sides, &found.sides, &found.seams, &found.chained, &found.mirrored);
    (suggestions, guesses)
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
    sewn.add_centers(&middle);
    let mut chained: Vec<ChainMatch> = Vec::new();
    let mut mirrored: Vec<(EdgeRun, f64, String)> = middle.iter().map(|run| center(outlines, run)).collect();
    let is_whole = |own: &EdgeRun| sides.iter().any(|run| run.piece == own.piece && run.edges == own.edges);
    let candidates = candidates(outlines, &sides, tolerance);
    let (whole, parts): (Vec<Match>, Vec<Match>) =
        candidates.into_iter().partition(|found| is_whole(&found.a) && is_whole(&found.b));
    // Waists may have a band between them.
    let (whole, level): (Vec<Match>, Vec<Match>) = whole.into_iter().partition(|found| !sewn.is_level(found));
    // What is surer first; after each that brought something what may follow from it.
    let mut step = 0;
    while step < 7 {
        let before = (sewn.seams.len(), chained.len(), mirrored.len());
        match step {
            0 => take_matches(&whole, &mut sewn, &chained, &sides),
            1 => take_chains(outlines, &sides, tolerance, &mut sewn, &mut chained),
            2 => {
                let mut told = told_by_seams(outlines, &sewn, &left(&sides, &sewn, &chained));
                told.extend(told_by_chains(&sewn, outlines, &chained, &sides));
                told.iter().for_each(|(run, ..)| sewn.add_centers(std::slice::from_ref(run)));
                mirrored.extend(told);
            }
            3 => {
                let eased = eased_candidates(&sewn, outlines, &left(&sides, &sewn, &chained), tolerance);
                take_matches(&eased, &mut sewn, &chained, &sides);
            }
            4 => take_rings(outlines, &sides, &mut sewn, &mut chained),
            5 => take_matches(&level, &mut sewn, &chained, &sides),
            // Parts of edges between notches come last: they are parts of chains, too.
            _ => take_matches(&parts, &mut sewn, &chained, &sides),
        }
        step = if before == (sewn.seams.len(), chained.len(), mirrored.len()) { step + 1 } else { 0 };
    }
    let seams = sewn.seams;
    Sewable { sides, seams, chained, mirrored }
}
