//! Rings: what goes all round, a waist or a wrist, and the band that is sewn to it part by part, also where it is
//! shorter and the other is eased or gathered into it.

use super::chains::{ChainBook, ChainEnds, ChainMatch, RunChain};
use super::seams_found::EdgeEnd;
use crate::geometry::DisjointSets;

/// A ring is sewn to one that is longer by no more than this share. More is gathered by a pattern's own words.
const GATHERED: f64 = 0.5;
/// A band that is sewn to itself is shorter or longer by no more than this share.
const LOOSE: f64 = 0.25;
/// A band laps by so much (metres): for a button, a hook or a zip.
const LAP: std::ops::RangeInclusive<f64> = 0.012..=0.07;
const LAP_POINTS: f64 = 1.0;
/// Up to this share it is eased in.
const EASED: f64 = 0.08;
/// Two rings that both lie farther than this share of their chords within their pieces are not sewn to each other.
const HOLLOW: f64 = 0.03;
/// Up to this share they are as long as each other.
const EQUAL: f64 = 0.003;
/// Points for rings as long as each other, for eased ones at most, for an upper and a lower edge, for parts in the same
/// proportion, and for a band between two other pieces.
const EQUAL_POINTS: f64 = 2.0;
const EASED_POINTS: f64 = 1.5;
const LEVEL_POINTS: f64 = 1.5;
const PARTS_POINTS: f64 = 0.5;
const BAND_POINTS: f64 = 0.75;
/// A ring is an upper or a lower edge whose direction outwards is up or down to this (the cosine of 40 degrees), in the
/// mean.
const LEVEL: f64 = 0.77;
/// Parts are in the same proportion whose shares of their rings differ by no more than this factor (logarithm), and
/// are not each other's beyond the second.
const PROPORTION: [f64; 2] = [0.08, 0.35];
/// A band is no higher than this share of its width.
const BAND: f64 = 0.4;
/// A seam of rings with fewer points is not offered.
const LEAST: f64 = 2.0;
/// It is in doubt while another one for its edges is nearer to it than this, in points.
const MARGIN: f64 = 0.6;

/// Runs that follow one another round an opening, in a closed ring.
struct Ring {
    /// Every way to walk it round: from each of its runs, in both directions.
    walks: Vec<RunChain>,
    /// Whether it is half of it, from the middle of the wearer to the middle.
    half: bool,
    /// Whether there are two of it, left and right.
    twice: bool,
    /// Of all of it, metres.
    length: f64,
    /// 1 of an upper edge, -1 of a lower one, in the mean.
    facing: f64,
    /// Whether all that it is sewn to is as low as a band.
    band: bool,
    /// Whether it is a band that is sewn to nothing yet, not even to itself.
    loose: bool,
    /// Whether it goes over a seam down the center, which may be left open above.
    opens: bool,
    /// The number of the first piece of all that is sewn together with it.
    part: u32,
}

impl Ring {
    fn runs(&self) -> Vec<usize> {
        sorted(&self.walks[0])
    }
}

fn sorted(walk: &RunChain) -> Vec<usize> {
    let mut runs: Vec<usize> = walk.runs.iter().map(|(run, _)| *run).collect();
    runs.sort_unstable();
    runs
}

/// The seams of two rings, a seam for each part, and how much speaks for them.
pub(super) struct RingMatch {
    pub(super) parts: Vec<ChainMatch>,
    /// The ends of a band that are sewn to each other.
    pub(super) closing: Option<[EdgeEnd; 2]>,
    score: f64,
    runs: Vec<usize>,
    /// The parts of the garment that they join.
    between: [u32; 2],
}

/// The seams between rings that nothing else comes near.
pub(super) fn ring_seams(book: &ChainBook, chained: &[ChainMatch], runs: &[super::run::EdgeRun]) -> Vec<RingMatch> {
    let rings = rings(book, chained, runs);
    let mut found: Vec<RingMatch> = Vec::new();
    for (k, a) in rings.iter().enumerate() {
        found.extend(rings[k + 1..].iter().filter_map(|b| matched(book, a, b)));
    }
    found.sort_by(|x, y| y.score.total_cmp(&x.score));
    let meets = |x: &RingMatch, y: &RingMatch| x.between == y.between || x.runs.iter().any(|run| y.runs.contains(run));
    let clear = |k: usize| {
        let rival = |(i, other): (usize, &RingMatch)| {
            i != k && meets(&found[k], other) && other.score > found[k].score - MARGIN
        };
        !found.iter().enumerate().any(rival)
    };
    // One after the other: what it joins is told anew for the next.
    let first = (0..found.len()).find(|&k| clear(k));
    first.map(|k| found.swap_remove(k)).into_iter().collect()
}

fn rings(book: &ChainBook, chained: &[ChainMatch], runs: &[super::run::EdgeRun]) -> Vec<Ring> {
    let mut together = DisjointSets::new(book.outlines.len());
    for seam in &book.sewn.seams {
        together.join(seam.a.piece as u32, seam.b.piece as u32);
    }
    for chain in chained {
        let pieces: Vec<usize> = chain.runs().map(|run| runs[run].piece).collect();
        for pair in pieces.windows(2) {
            together.join(pair[0] as u32, pair[1] as u32);
        }
    }
    let mut rings: Vec<Ring> = Vec::new();
    let is_loose = |walk: &RunChain| match walk.runs[..] {
        [(run, _)] if walk.ends == ChainEnds::Open => {
            let piece = runs[run].piece;
            book.is_loose(piece) && book.sewn.is_low(piece, BAND) && book.closing(walk).is_some()
        }
        _ => false,
    };
    for walk in book.chains().into_iter().filter(|walk| walk.ends != ChainEnds::Open || is_loose(walk)) {
        if let Some(ring) = rings.iter_mut().find(|ring| ring.runs() == sorted(&walk)) {
            ring.opens |= ring.half && book.opens_first(&walk);
            ring.walks.push(walk);
            continue;
        }
        let pieces: Vec<usize> = walk.runs.iter().map(|(run, _)| runs[*run].piece).collect();
        let half = walk.ends == ChainEnds::Folds;
        let mirrored = pieces.iter().filter(|&&piece| book.outlines[piece].mirrored).count();
        if mirrored != 0 && mirrored != pieces.len() || half && mirrored == 0 {
            continue;
        }
        let part = together.root(pieces[0] as u32);
        let all = (0..book.outlines.len()).filter(|&piece| together.root(piece as u32) == part);
        let band = all.into_iter().all(|piece| book.sewn.is_low(piece, BAND));
        let facing = walk.runs.iter().map(|(run, _)| book.sewn.facing(&runs[*run]) * runs[*run].length()).sum::<f64>();
        rings.push(Ring {
            half,
            twice: mirrored > 0 && !half,
            length: walk.length * if half { 2.0 } else { 1.0 },
            facing: facing / walk.length,
            band,
            part,
            loose: is_loose(&walk),
            opens: half && book.opens_first(&walk),
            walks: vec![walk],
        });
    }
    rings
}

/// How the lengths of two rings fit.
#[derive(Clone, Copy, PartialEq, Eq)]
enum RingFit {
    Equal,
    Eased,
    Gathered,
    /// The band goes on beyond the other, and laps.
    Lapped,
}

impl RingFit {
    fn of(a: &Ring, b: &Ring) -> Option<Self> {
        let ratio = b.length / a.length;
        let apart = ratio.max(1.0 / ratio) - 1.0;
        let (band, other) = if a.loose { (a, b) } else { (b, a) };
        let lap = band.length - other.length;
        match () {
            () if a.loose && b.loose => None,
            () if apart <= EQUAL => Some(Self::Equal),
            () if band.loose && other.opens && LAP.contains(&lap) => Some(Self::Lapped),
            // A closed band must give where it is put on over the head or the hand.
            () if band.loose => (!other.opens && apart <= LOOSE).then_some(Self::Gathered),
            () if apart <= EASED => Some(Self::Eased),
            () => (apart <= GATHERED).then_some(Self::Gathered),
        }
    }

    fn points(self, a: &Ring, b: &Ring) -> f64 {
        let ratio = b.length / a.length;
        match self {
            Self::Equal => EQUAL_POINTS,
            Self::Eased => EASED_POINTS * (1.0 - 0.5 * (ratio.max(1.0 / ratio) - 1.0) / EASED),
            Self::Lapped => LAP_POINTS,
            Self::Gathered => 0.0,
        }
    }

    fn said(self) -> &'static str {
        match self {
            Self::Equal => "both go all round and are as long",
            Self::Eased => "both go all round, and the longer one is eased in",
            Self::Gathered => "both go all round, and the longer one is gathered, or the shorter one stretched",
            Self::Lapped => "both go all round, and the band laps beyond",
        }
    }
}

/// The seams between two rings of different parts of the garment, as far as they fit.
fn matched(book: &ChainBook, a: &Ring, b: &Ring) -> Option<RingMatch> {
    if a.part == b.part || a.twice != b.twice {
        return None;
    }
    let fit = RingFit::of(a, b)?;
    let level = match a.facing.abs().min(b.facing.abs()) >= LEVEL {
        true if a.facing * b.facing < 0.0 => LEVEL_POINTS,
        true => -LEVEL_POINTS,
        false => 0.0,
    };
    // Linings have the armholes and necklines of what they line.
    let hollow = |ring: &Ring| ring.walks[0].hollow > HOLLOW;
    if level <= 0.0 && hollow(a) && hollow(b) {
        return None;
    }
    let (off, mut parts) = aligned(book, a, b)?;
    let proportion = if off <= PROPORTION[0] { PARTS_POINTS } else { -PARTS_POINTS };
    let band = if a.band != b.band { BAND_POINTS } else { 0.0 };
    let score = fit.points(a, b) + level + proportion + band;
    if score < LEAST || off > PROPORTION[1] {
        return None;
    }
    let mut reasons = vec![fit.said().to_owned()];
    reasons.extend((level > 0.0).then(|| "an upper and a lower edge".to_owned()));
    for part in &mut parts {
        part.lapped = (fit == RingFit::Lapped).then(|| a.length.min(b.length));
        (part.score, part.reasons) = (score, reasons.clone());
    }
    let (loose, other) = if a.loose { (a, b) } else { (b, a) };
    let closes = loose.loose && fit != RingFit::Lapped && !other.opens;
    let closing = closes.then(|| book.closing(&loose.walks[0])).flatten();
    Some(RingMatch { parts, closing, score, runs: [a.runs(), b.runs()].concat(), between: [a.part, b.part] })
}

/// The best way to lay two rings along each other, part by part, and by how much the shares of these differ
/// (logarithm).
fn aligned(book: &ChainBook, a: &Ring, b: &Ring) -> Option<(f64, Vec<ChainMatch>)> {
    // Of halves and whole pieces, front and back each go over the middle.
    let doubled = a.half != b.half;
    let (half, whole) = if b.half && doubled || a.loose { (b, a) } else { (a, b) };
    if whole.loose {
        return around(book, half, whole);
    }
    let first = &half.walks[0];
    if doubled && first.runs.len() != 2 {
        return None;
    }
    let mut best: Option<(f64, Vec<ChainMatch>)> = None;
    for walk in whole.walks.iter().filter(|walk| walk.runs.len() == first.runs.len()) {
        let parts: Vec<ChainMatch> = first
            .runs
            .iter()
            .zip(&walk.runs)
            .map(|(&one, &other)| book.part(one, other, doubled))
            .collect::<Option<_>>()
            .unwrap_or_default();
        if parts.is_empty() {
            continue;
        }
        let share = |part: &ChainMatch| (part.a.length / first.length) / (part.b.length / walk.length);
        let off = parts.iter().map(|part| share(part).ln().abs()).fold(0.0, f64::max);
        if best.as_ref().is_none_or(|(least, _)| off < least - 1e-9) {
            best = Some((off, parts));
        }
    }
    best
}

/// A band that goes round a ring in one.
fn around(book: &ChainBook, ring: &Ring, band: &Ring) -> Option<(f64, Vec<ChainMatch>)> {
    // What may be left open is where the band begins.
    let begins = |walk: &&RunChain| !ring.half || !ring.opens || book.opens_first(walk);
    let walk = ring.walks.iter().find(begins)?;
    let opposed = |own: &&RunChain| own.runs[0].1 != walk.runs[0].1;
    let own = band.walks.iter().find(opposed).unwrap_or(&band.walks[0]);
    let part = ChainMatch {
        a: walk.clone(),
        b: own.clone(),
        doubled: ring.half,
        lapped: None,
        eased: true,
        score: 0.0,
        reasons: Vec::new(),
    };
    Some((0.0, vec![part]))
}
