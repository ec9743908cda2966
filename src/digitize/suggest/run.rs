//! Outlines in runs from corner to corner, which seams take. A run goes on over a dart, as it does once that is sewn.

use super::Outline;
use super::corner::{is_fold, turn_before};
use super::over_darts::{closed_course, follows, over_darts};
use crate::digitize::edges::CORNER;
use crate::geometry::{Path, Vec2};
use crate::pattern::words_of;

/// Shorter edges (metres) fit too many.
const SHORTEST: f64 = 0.02;
/// Notches so near to the end of what is sewn (metres) mark that end.
pub(super) const AT_END: f64 = 1e-3;
/// Places at which the course of a run is compared.
pub(super) const LOOKS: usize = 16;
/// An allowance of so many times that of most of the piece's length is a hem's.
const HEM_SHARE: f64 = 1.5;
/// And a hem is no narrower than this (metres).
const HEM_LEAST: f64 = 0.015;
/// Edges called so stay open, whatever is as long.
const HEM: &str = "hem";

/// A notch along a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RunNotch {
    /// Metres from the start.
    pub(super) at: f64,
    pub(super) double: bool,
}

/// Edges of a piece that follow each other without a corner, or some of them; also over darts, whose legs are none of
/// them.
#[derive(Clone, Debug)]
pub(super) struct EdgeRun {
    pub(super) piece: usize,
    /// Their numbers, clockwise.
    pub(super) edges: Vec<usize>,
    /// Their course, with the darts between them closed.
    pub(super) path: Path,
    /// Notches inside, from the start.
    pub(super) marks: Vec<RunNotch>,
    /// Notches at its start and its end where these are no corners, by whether they are double.
    pub(super) end_marks: [Option<bool>; 2],
    /// How far it lies beside its chord, as a share of that, positive into the piece.
    pub(super) profile: [f64; LOOKS],
}

impl EdgeRun {
    pub(super) fn new(outline: &Outline, piece: usize, edges: &[usize]) -> Option<Self> {
        let own = |k: usize| &outline.edges[k];
        let path = closed_course(outline, edges)?;
        let (mut marks, mut done, mut mouths) = (Vec::new(), 0.0, Vec::new());
        for (i, &k) in edges.iter().enumerate() {
            marks.extend(own(k).notches.iter().map(|n| RunNotch { at: done + n.at, double: n.double }));
            done += own(k).path.length();
            mouths.extend(edges.get(i + 1).filter(|next| !follows(outline, k, **next)).map(|_| done));
        }
        // Notches at a dart's mouth are the dart's.
        let is_mouth = |at: f64| mouths.iter().any(|mouth| (mouth - at).abs() <= AT_END);
        marks.retain(|mark| mark.at > AT_END && mark.at < path.length() - AT_END && !is_mouth(mark.at));
        let count = outline.edges.len();
        let before = (edges[0] + count - 1) % count;
        let end_marks = [before, edges[edges.len() - 1]].map(|k| {
            let last = own(k).notches.last().filter(|n| n.at > own(k).path.length() - AT_END);
            last.map(|n| n.double)
        });
        Some(Self { piece, edges: edges.to_vec(), profile: profile(&path), path, marks, end_marks })
    }

    pub(super) fn length(&self) -> f64 {
        self.path.length()
    }

    /// Mean of how far it lies beside its chord: positive for a neckline or an armhole, negative for a sleeve's cap.
    pub(super) fn hollow(&self) -> f64 {
        self.profile.iter().sum::<f64>() / LOOKS as f64
    }

    /// The most that it lies beside its chord.
    pub(super) fn bow(&self) -> f64 {
        self.profile.iter().fold(0.0, |most, x| x.abs().max(most))
    }

    /// Whether it shares an edge with another.
    pub(super) fn meets(&self, other: &Self) -> bool {
        self.piece == other.piece && self.edges.iter().any(|edge| other.edges.contains(edge))
    }

    /// Whether it has all edges of another.
    pub(super) fn holds(&self, other: &Self) -> bool {
        self.piece == other.piece && other.edges.iter().all(|edge| self.edges.contains(edge))
    }

    /// Its direction from end to end, of length 1.
    pub(super) fn along(&self) -> Option<Vec2> {
        (self.path.end() - self.path.start()).try_normalize(1e-9)
    }
}

fn profile(path: &Path) -> [f64; LOOKS] {
    let (start, chord) = (path.start(), path.end() - path.start());
    let long = chord.norm().max(f64::MIN_POSITIVE);
    let step = path.length() / (LOOKS + 1) as f64;
    std::array::from_fn(|k| chord.perp(&(path.point(step * (k + 1) as f64) - start)) / (long * long))
}

/// The runs from corner to corner of all pieces that may be sewn: all but folds, hems and slips of the pen.
pub(super) fn runs(outlines: &[Outline]) -> Vec<EdgeRun> {
    let of = |(piece, outline): (usize, &Outline)| {
        let sewn = |edges: &Vec<usize>| !is_fold(outline, edges[0]) && !is_hem(outline, edges[0]);
        let parts = over_darts(outline, parts(outline)).into_iter().filter(sewn);
        let runs: Vec<EdgeRun> = parts.filter_map(|edges| EdgeRun::new(outline, piece, &edges)).collect();
        runs.into_iter().filter(|run| run.length() >= SHORTEST)
    };
    outlines.iter().enumerate().flat_map(of).collect()
}

/// Numbers of the edges of each part of an outline: those that go on into each other without a corner, none across the
/// end of a fold or of a hem.
pub(super) fn parts(outline: &Outline) -> Vec<Vec<usize>> {
    let count = outline.edges.len();
    let kind = |k: usize| (is_fold(outline, k), is_hem(outline, k));
    let begins = |k: usize| turn_before(outline, k).abs() > CORNER || kind(k) != kind((k + count - 1) % count);
    let first = (0..count).find(|&k| begins(k)).unwrap_or(0);
    let mut parts: Vec<Vec<usize>> = Vec::new();
    for k in (first..first + count).map(|k| k % count) {
        match parts.last_mut() {
            Some(part) if !begins(k) => part.push(k),
            _ => parts.push(vec![k]),
        }
    }
    parts
}

/// Whether an edge is turned up and not sewn: it is called so, or its allowance is that of a hem.
fn is_hem(outline: &Outline, edge: usize) -> bool {
    let usual = usual_allowance(outline);
    let wide = |width: f64| usual.is_some_and(|usual| width >= HEM_LEAST.max(HEM_SHARE * usual));
    says(&outline.edges[edge].name, &[HEM]) || outline.allowances[edge].is_some_and(wide)
}

/// The allowance that most of the outline's length has.
fn usual_allowance(outline: &Outline) -> Option<f64> {
    let widths: Vec<(f64, f64)> =
        outline.edges.iter().zip(&outline.allowances).filter_map(|(e, w)| Some(((*w)?, e.path.length()))).collect();
    let with = |width: f64| widths.iter().filter(|(w, _)| *w == width).map(|(_, length)| length).sum::<f64>();
    widths.iter().map(|(w, _)| *w).max_by(|a, b| with(*a).total_cmp(&with(*b)).then(b.total_cmp(a)))
}

/// Whether a name says one of these words: `center`, `center_back`, `cb-center`.
pub(super) fn says(name: &str, words: &[&str]) -> bool {
    words_of(name).iter().any(|word| words.contains(&word.as_str()))
}

/// In runs of more edges than this only the whole run and single edges may be sewn.
const MOST_PARTS: usize = 8;

/// The run and its parts between notches: what a seam may take of it.
pub(super) fn spans(outline: &Outline, run: &EdgeRun) -> Vec<EdgeRun> {
    let count = run.edges.len();
    let mut spans = vec![run.clone()];
    for from in 0..count {
        let most = if count > MOST_PARTS { from + 1 } else { count };
        for to in from + 1..=most {
            let part = EdgeRun::new(outline, run.piece, &run.edges[from..to]);
            spans.extend(part.filter(|part| to - from < count && part.length() >= SHORTEST));
        }
    }
    spans
}
