//! Chains of runs that seams bring together: an armhole of front, yoke and back, the waists of a skirt.

use super::matches::to_grain;
use super::notched::{Compared, compared, reversed};
use super::run::{EdgeRun, RunNotch};
use super::seams_found::{EdgeEnd, SeamsFound};
use super::{Outline, Tolerance};

/// Longest chain, in runs.
const MOST_RUNS: usize = 4;
/// Among more chains than this every length fits by chance.
const MOST_CHAINS: usize = 2000;
/// A sleeve's cap is longer than its armhole by no more than this share: that much is eased in.
const EASE: f64 = 0.08;
/// Runs that lie so far beside their chords, as a share of these, are hollow, and bulge out on the other side.
const HOLLOW: f64 = 0.03;
/// The edge of a hood that goes round the neck may be hollow up to this.
const HOOD: f64 = 0.08;
/// A band may bend by so much to the shape of the body, as a share of its length.
const BENT: f64 = 0.08;
/// Edges that lie no farther from the grain than this (radians, 20 degrees) run along it.
const ALONG_GRAIN: f64 = 0.35;
/// Points for a cap and an armhole that are highest in the same place.
const AT_TOP: f64 = 0.5;
/// A chain is an upper or a lower edge whose direction outwards is up or down to this: the cosine of 15 degrees.
const LEVEL: f64 = 0.966;
/// Joints of a chain that lie so near to a joint or a notch of the other side (metres) lie opposite it.
const OPPOSITE: f64 = 0.012;

/// How a chain ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ChainEnds {
    /// It goes all round.
    Closed,
    /// From the middle of the wearer to the middle: from fold to fold, or to a center seam.
    Folds,
    Open,
}

/// Runs that go on into each other.
#[derive(Clone, Debug)]
pub(super) struct RunChain {
    /// Their numbers, each walked as it is drawn or the other way.
    pub(super) runs: Vec<(usize, bool)>,
    pub(super) length: f64,
    marks: Vec<RunNotch>,
    joints: Vec<f64>,
    pub(super) ends: ChainEnds,
    /// Whether its start and its end are in the middle of the wearer.
    pub(super) middles: [bool; 2],
    /// Mean of how far its runs lie within their pieces beside their chords.
    pub(super) hollow: f64,
}

/// Two chains that may be sewn together.
#[derive(Clone, Debug)]
pub(super) struct ChainMatch {
    pub(super) a: RunChain,
    pub(super) b: RunChain,
    /// Whether the first is a half, and the second is as long as both.
    pub(super) doubled: bool,
    /// Where the second goes on beyond the first and laps: the length of it that is sewn, metres.
    pub(super) lapped: Option<f64>,
    /// Whether one is longer, and eased or gathered in.
    pub(super) eased: bool,
    pub(super) score: f64,
    pub(super) reasons: Vec<String>,
}

impl ChainMatch {
    pub(super) fn runs(&self) -> impl Iterator<Item = usize> + '_ {
        self.a.runs.iter().chain(&self.b.runs).map(|(run, _)| *run)
    }
}

/// The runs, outlines and seams that chains are made of.
pub(super) struct ChainBook<'a> {
    pub(super) runs: &'a [EdgeRun],
    pub(super) outlines: &'a [Outline],
    pub(super) sewn: &'a SeamsFound<'a>,
    pub(super) free: Vec<bool>,
}

impl ChainBook<'_> {
    fn chain(&self, runs: &[(usize, bool)]) -> RunChain {
        let (mut marks, mut joints, mut done, mut hollow) = (Vec::new(), Vec::new(), 0.0, 0.0);
        for &(run, forward) in runs {
            let own = &self.runs[run];
            let walked = if forward { own.marks.clone() } else { reversed(&own.marks, own.length()) };
            marks.extend(walked.iter().map(|mark| RunNotch { at: done + mark.at, ..*mark }));
            hollow += own.hollow() / runs.len() as f64;
            done += own.length();
            joints.push(done);
        }
        joints.pop();
        let (ends, middles) = match (runs.first(), runs.last()) {
            (Some(&first), Some(&last)) => self.ends(first, last),
            _ => (ChainEnds::Open, [false; 2]),
        };
        RunChain { runs: runs.to_vec(), length: done, marks, joints, ends, middles, hollow }
    }

    fn ends(&self, (first, forward): (usize, bool), (last, on): (usize, bool)) -> (ChainEnds, [bool; 2]) {
        let (entry, exit) = (self.outer(first, !forward), self.outer(last, on));
        let is_middle = |run: usize, at_end: bool| self.sewn.is_middle(self.sewn.beside(&self.runs[run], at_end));
        let middles = [is_middle(first, !forward), is_middle(last, on)];
        let ends = if self.sewn.partners(exit).contains(&entry) {
            ChainEnds::Closed
        } else if middles == [true; 2] {
            ChainEnds::Folds
        } else {
            ChainEnds::Open
        };
        (ends, middles)
    }

    /// The end of a run's own edge at its start or its end.
    fn outer(&self, run: usize, at_end: bool) -> EdgeEnd {
        let own = &self.runs[run];
        let edge = if at_end { own.edges[own.edges.len() - 1] } else { own.edges[0] };
        EdgeEnd { piece: own.piece, edge, at_end }
    }

    /// All chains of runs that no seam has, each in every direction, and of those all round from every joint.
    pub(super) fn chains(&self) -> Vec<RunChain> {
        let mut walks: Vec<Vec<(usize, bool)>> = Vec::new();
        let mut open: Vec<Vec<(usize, bool)>> = (0..self.runs.len())
            .filter(|&run| self.free[run])
            .flat_map(|run| [vec![(run, true)], vec![(run, false)]])
            .collect();
        while let Some(walk) = open.pop() {
            if walks.len() > MOST_CHAINS {
                return Vec::new();
            }
            if walk.len() < MOST_RUNS
                && let Some(&(last, on)) = walk.last()
            {
                for next in self.after(last, on) {
                    if !walk.iter().any(|(run, _)| *run == next.0) {
                        open.push(walk.iter().copied().chain([next]).collect());
                    }
                }
            }
            walks.push(walk);
        }
        walks.sort();
        walks.iter().map(|walk| self.chain(walk)).collect()
    }

    /// The runs that a run goes on into where it ends.
    fn after(&self, run: usize, on: bool) -> Vec<(usize, bool)> {
        let begins = |end: EdgeEnd| {
            let at = |&(next, forward): &(usize, bool)| self.free[next] && self.outer(next, !forward) == end;
            (0..self.runs.len()).flat_map(|next| [(next, true), (next, false)]).find(at)
        };
        self.sewn.partners(self.outer(run, on)).into_iter().filter_map(begins).collect()
    }

    /// How well two chains fit; `None` if they do not.
    pub(super) fn fit(&self, a: &RunChain, b: &RunChain, tolerance: Tolerance) -> Option<ChainMatch> {
        let pieces =
            |chain: &RunChain| -> Vec<usize> { chain.runs.iter().map(|(run, _)| self.runs[*run].piece).collect() };
        let (own, other) = (pieces(a), pieces(b));
        // A hood's edge may be hollow to the front.
        let hollow = if a.ends == ChainEnds::Folds && self.is_loose_half(b) { HOOD } else { HOLLOW };
        if own.iter().any(|piece| other.contains(piece)) || (a.hollow > HOLLOW && b.hollow > hollow) {
            return None;
        }
        let doubled = a.middles != [false; 2] && self.is_whole(b) && (b.length / a.length - 2.0).abs() < 0.1;
        let long = if doubled { 2.0 * a.length } else { a.length };
        let mut found = ChainMatch {
            a: a.clone(),
            b: b.clone(),
            doubled,
            lapped: None,
            eased: false,
            score: 0.0,
            reasons: Vec::new(),
        };
        self.by_length(&mut found, long, tolerance)?;
        if !doubled {
            self.by_marks(&mut found)?;
        }
        self.by_ends(&mut found);
        self.by_level(&mut found);
        self.by_grain(&mut found);
        if (a.hollow > HOLLOW && b.hollow < -HOLLOW) || (b.hollow > HOLLOW && a.hollow < -HOLLOW) {
            found.add(1.0, "one is hollow and the other bulges");
        }
        let count = a.runs.len() + b.runs.len();
        found.score -= 0.25 * (count as f64 - 3.0);
        Some(found)
    }

    /// Whether the chain is one run of a piece that is not a half.
    fn is_whole(&self, chain: &RunChain) -> bool {
        matches!(chain.runs[..], [(run, _)] if self.outlines[self.runs[run].piece].fold.is_none())
            && chain.hollow.abs() < BENT
    }

    /// Whether the chain is one run of a pair that is sewn to nothing yet: of a hood, or of a collar.
    fn is_loose_half(&self, chain: &RunChain) -> bool {
        let [(run, _)] = chain.runs[..] else { return false };
        let piece = self.runs[run].piece;
        self.outlines[piece].pair && self.is_loose(piece)
    }

    /// Whether no seam has an edge of a piece.
    pub(super) fn is_loose(&self, piece: usize) -> bool {
        self.runs.iter().zip(&self.free).all(|(run, free)| run.piece != piece || *free)
    }

    /// Whether a chain begins at a seam down the center, which may be left open above.
    pub(super) fn opens_first(&self, chain: &RunChain) -> bool {
        let beside = chain.runs.first().map(|&(run, forward)| self.sewn.beside(&self.runs[run], !forward));
        beside.is_some_and(|end| self.sewn.is_middle(end) && !self.sewn.lies_on_fold(end))
    }

    /// A part of a seam between rings: two runs, of which the first may be a half of what the second is sewn to.
    /// `None` where the right sides would not come together, or where a half does not begin in the middle.
    pub(super) fn part(&self, one: (usize, bool), other: (usize, bool), doubled: bool) -> Option<ChainMatch> {
        let mirrored = |(run, _): (usize, bool)| self.outlines[self.runs[run].piece].mirrored;
        let (a, b) = (self.chain(&[one]), self.chain(&[other]));
        let is_half = a.middles[0] != a.middles[1];
        if one.1 == other.1 && !mirrored(one) && !mirrored(other) || doubled && (!is_half || mirrored(other)) {
            return None;
        }
        Some(ChainMatch { a, b, doubled, lapped: None, eased: true, score: 0.0, reasons: Vec::new() })
    }

    fn by_length(&self, found: &mut ChainMatch, long: f64, tolerance: Tolerance) -> Option<()> {
        let (more, most) = (found.b.length - long, tolerance.of(long));
        if more.abs() <= most {
            found.add(0.5 + 1.5 * (1.0 - more.abs() / most), "lengths are equal");
        } else if !found.doubled && more > 0.0 && more <= EASE * long && found.b.hollow < -HOLLOW {
            found.eased = true;
            found.add(1.0 - 0.5 * more / (EASE * long), "the longer one is eased in");
        } else {
            return None;
        }
        Some(())
    }

    fn by_marks(&self, found: &mut ChainMatch) -> Option<()> {
        let (a, b) = (&found.a, &found.b);
        let Compared { matched, alone, conflict } = compared((&a.marks, a.length), (&b.marks, b.length));
        if conflict {
            return None;
        }
        let scale = b.length / a.length;
        let near = |at: f64, places: &[f64]| places.iter().any(|place| (place - at).abs() <= OPPOSITE);
        let places = |chain: &RunChain| -> Vec<f64> {
            chain.joints.iter().copied().chain(chain.marks.iter().map(|mark| mark.at)).collect()
        };
        let opposite = a.joints.iter().filter(|&&at| near(at * scale, &places(b))).count();
        let across = b.joints.iter().filter(|&&at| near(at / scale, &places(a))).count();
        let top = self.by_top(a, b);
        let apex = apex(self, b).map_or(0.0, |apex| {
            let off = |at: &f64| (at * scale - apex).abs() / b.length;
            a.joints.iter().map(off).fold(0.5, f64::min)
        });
        found.score += top;
        if matched > 0 {
            found.add(1.5 + 0.75 * (matched - 1).min(2) as f64, "notches match");
        }
        if opposite + across > 0 {
            found.add(0.75 * (opposite + across).min(2) as f64, "joints meet joints or notches");
        }
        found.score -= 0.3 * alone.saturating_sub(opposite + across).min(3) as f64 + apex;
        Some(())
    }

    /// Points for a cap that is highest where the chain that it is sewn to is, at the shoulder, or against it.
    fn by_top(&self, a: &RunChain, b: &RunChain) -> f64 {
        let ([first, .., last], [_], Some(top)) = (&a.runs[..], &b.runs[..], apex(self, b)) else { return 0.0 };
        let rise = |&(run, forward): &(usize, bool)| {
            let path = &self.runs[run].path;
            let up = (path.end() - path.start()).dot(&self.sewn.up);
            if forward { up } else { -up }
        };
        let (run, forward) = b.runs[0];
        let path = &self.runs[run].path;
        let at = if forward { top } else { path.length() - top };
        let cap = (path.point(at) - (path.start() + path.end()) / 2.0).dot(&self.sewn.up);
        if a.ends != ChainEnds::Closed || rise(first) * rise(last) >= 0.0 {
            return 0.0;
        }
        if (rise(first) > 0.0) == (cap > 0.0) { AT_TOP } else { -AT_TOP }
    }

    fn by_ends(&self, found: &mut ChainMatch) {
        match (found.a.ends, found.b.ends) {
            (ChainEnds::Closed, ChainEnds::Closed) => found.add(1.5, "both go all round"),
            (ChainEnds::Closed, ChainEnds::Open) if self.closing(&found.b).is_some() => {
                found.add(1.25, "it closes the ring that the other is sewn into");
            }
            (ChainEnds::Folds, ChainEnds::Folds) => found.add(1.0, "both go from middle to middle"),
            (ChainEnds::Folds | ChainEnds::Open, _) if found.doubled => found.add(0.5, "it goes round both halves"),
            (ChainEnds::Folds, ChainEnds::Open) if self.is_loose_half(&found.b) => {
                found.add(1.0, "its halves go round both sides");
            }
            (ChainEnds::Closed | ChainEnds::Folds, _) | (_, ChainEnds::Closed | ChainEnds::Folds) => found.score -= 1.0,
            _ => match [found.a.middles, found.b.middles] {
                [[false, false], _] | [_, [false, false]] => {}
                [a, b] if a == b => found.add(1.0, "both begin in the middle"),
                _ => found.score -= 1.0,
            },
        }
    }

    /// Waists and bands: an upper edge is sewn to a lower one.
    fn by_level(&self, found: &mut ChainMatch) {
        let facing = |chain: &RunChain| -> f64 {
            let own = |&(run, _): &(usize, bool)| self.sewn.facing(&self.runs[run]) * self.runs[run].length();
            chain.runs.iter().map(own).sum::<f64>() / chain.length
        };
        let [a, b] = [facing(&found.a), facing(&found.b)];
        if a.abs().min(b.abs()) < LEVEL {
            return;
        }
        if a * b < 0.0 {
            found.add(0.75, "an upper and a lower edge");
        } else {
            found.score -= 0.75;
        }
    }

    /// Courses along the grain of either side, and a side that is one edge but for a dart in it.
    fn by_grain(&self, found: &mut ChainMatch) {
        let angles = |chain: &RunChain| -> Option<Vec<f64>> {
            chain.runs.iter().map(|(run, _)| to_grain(self.outlines, &self.runs[*run])).collect()
        };
        let most = |all: &[f64]| all.iter().copied().fold(0.0, f64::max);
        if let (Some(a), Some(b)) = (angles(&found.a), angles(&found.b))
            && most(&a).max(most(&b)) <= ALONG_GRAIN
        {
            found.add(0.75, "both along the grain");
        }
        let piece = |(run, _): (usize, bool)| self.runs[run].piece;
        if found.a.runs.windows(2).any(|pair| piece(pair[0]) == piece(pair[1])) {
            found.add(0.75, "it goes on over a dart");
        }
    }

    /// The sides of a single run's piece beside it, where they are as long as each other: sewn together they make it
    /// go all round.
    pub(super) fn closing(&self, chain: &RunChain) -> Option<[EdgeEnd; 2]> {
        let [(run, _)] = chain.runs[..] else { return None };
        let sides = [false, true].map(|at_end| self.sewn.beside(&self.runs[run], at_end));
        let [one, other] = sides.map(|end| self.outlines[end.piece].edges[end.edge].path.length());
        let free = sides.iter().all(|side| !self.sewn.lies_on_fold(*side)) && sides[0].edge != sides[1].edge;
        (free && (one - other).abs() <= crate::pattern::DEFAULT_TOLERANCE).then_some(sides)
    }
}

impl ChainMatch {
    fn add(&mut self, points: f64, reason: &str) {
        self.score += points;
        self.reasons.push(reason.to_owned());
    }
}

/// Where a chain of one run that bulges lies farthest beside its chord.
fn apex(book: &ChainBook, chain: &RunChain) -> Option<f64> {
    let [(run, forward)] = chain.runs[..] else { return None };
    let own = &book.runs[run];
    if own.hollow() > -HOLLOW {
        return None;
    }
    let count = own.profile.len();
    let top = (0..count).min_by(|&i, &k| own.profile[i].total_cmp(&own.profile[k]))?;
    let at = (top + 1) as f64 / (count + 1) as f64 * own.length();
    Some(if forward { at } else { own.length() - at })
}
