//! Suggests edges that may be sewn together.

use super::edges::Edge;
use crate::pattern::{DEFAULT_TOLERANCE, words_of};

/// Edges of a seam differ by no more than a garment file takes without a word (metres), or by this share of their
/// length.
const ALIKE: (f64, f64) = (DEFAULT_TOLERANCE, 0.004);
/// Shorter edges (metres) fit too many.
const SHORTEST: f64 = 0.02;

/// Among more edges than this every length fits by chance.
const MOST_EDGES: usize = 2000;

/// Name of edges that stay open, even if another one has the same length.
const HEM: &str = "hem";
/// Names of edges at which the halves of a pair may be sewn to each other.
const CENTER: [&str; 2] = ["center", "centre"];

/// Two edges that may be sewn together.
#[derive(Clone, Debug, PartialEq)]
pub struct Suggestion {
    /// `front.a`.
    pub sew: String,
    /// `back.c`, or `mirror`.
    pub to: String,
    /// Their lengths, metres.
    pub lengths: [f64; 2],
    /// Whether both have a notch: parts of an outline split at notches end there.
    pub notched: bool,
}

struct End<'a> {
    piece: usize,
    name: String,
    edge: &'a Edge,
}

/// A piece's edges.
pub(super) struct Outline {
    pub(super) piece: String,
    pub(super) edges: Vec<Edge>,
    /// The edge that lies on the fold of the cloth: no seam is there.
    pub(super) fold: Option<String>,
    /// Whether it is cut as drawn and mirrored.
    pub(super) pair: bool,
}

/// Whether a name says one of these words: `center`, `center_back`, `cb-center`.
fn says(name: &str, words: &[&str]) -> bool {
    words_of(name).iter().any(|word| words.contains(&word.as_str()))
}

/// Edges of which each fits the other best: pieces first, then edges of one piece (darts, sleeves). Then the centers of
/// pairs, to their mirror images.
pub(super) fn suggest(outlines: &[Outline]) -> Vec<Suggestion> {
    let mut ends = Vec::new();
    for (piece, own) in outlines.iter().enumerate() {
        let sewn = own.edges.iter().filter(|e| own.fold.as_ref() != Some(&e.name) && !says(&e.name, &[HEM]));
        let long = sewn.filter(|e| e.path.length() >= SHORTEST);
        ends.extend(long.map(|edge| End { piece, name: format!("{}.{}", own.piece, edge.name), edge }));
    }
    if ends.len() > MOST_EDGES {
        return Vec::new();
    }
    let best: Vec<Option<usize>> = (0..ends.len()).map(|i| best(&ends, i)).collect();
    let mut found = Vec::new();
    for (i, partner) in best.iter().enumerate() {
        if let Some(k) = partner.filter(|&k| k > i && best[k] == Some(i)) {
            let lengths = [ends[i].edge.path.length(), ends[k].edge.path.length()];
            let notched = ends[i].edge.notch().is_some() && ends[k].edge.notch().is_some();
            found.push(Suggestion { sew: ends[i].name.clone(), to: ends[k].name.clone(), lengths, notched });
        }
    }
    for (end, _) in ends.iter().zip(&best).filter(|(_, partner)| partner.is_none()) {
        if outlines[end.piece].pair && says(&end.edge.name, &CENTER) {
            let (lengths, notched) = ([end.edge.path.length(); 2], end.edge.notch().is_some());
            found.push(Suggestion { sew: end.name.clone(), to: "mirror".to_owned(), lengths, notched });
        }
    }
    found
}

/// The edge most like this one.
fn best(ends: &[End], i: usize) -> Option<usize> {
    let length = |k: usize| ends[k].edge.path.length();
    let apart = |k: usize| (length(k) - length(i)).abs();
    let alike = |k: &usize| *k != i && apart(*k) <= ALIKE.0.max(ALIKE.1 * length(i).max(length(*k)));
    // Notched alike, in another piece, then by length. The earlier of two that are equal.
    let worse = |k: usize| {
        let notches = ends[k].edge.notch() != ends[i].edge.notch();
        (notches, ends[k].piece == ends[i].piece)
    };
    (0..ends.len()).filter(alike).min_by(|&a, &b| worse(a).cmp(&worse(b)).then(apart(a).total_cmp(&apart(b))))
}
