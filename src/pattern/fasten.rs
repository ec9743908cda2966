//! Rims that closures close: open after sewing, but not as the garment is worn.

use super::free::free_spans;
use super::{Closure, EdgeId, Garment, Span};
use crate::geometry::{DisjointSets, Vec2};

/// Distance to the nearest free edge beyond which a point fastens no edge, metres. Such a point ties a patch or a flap.
/// Double-breasted fronts have their buttons up to 120 mm from the edge.
const REACH: f64 = 0.15;

/// Length of rim, in overlaps, within which it leads from one fastened edge to the other at the end of a lap: one
/// overlap for the end of the underlap, and another where corners are rounded or the points lie slanting.
const TURN: f64 = 2.0;

/// Addition to [`TURN`] overlaps, metres, for edges that only meet.
const TURN_SLACK: f64 = 5e-3;

/// Length of a fastened edge beyond its last fastening that never belongs to an opening, metres: half the width of a
/// band.
const BEYOND: f64 = 0.05;

/// Length of a rim between fastened edges alone up to which it is a slit, metres. Buttons are at most 100 mm apart, and
/// no head passes between two of them. The neck of a newborn's vest is 300 mm.
const SLIT: f64 = 0.25;

/// A point of a rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RimSpot {
    /// The edge.
    pub edge: EdgeId,
    /// Metres from its start.
    pub at: f64,
}

/// A point of a closure that holds two rims together.
#[derive(Clone, Debug, PartialEq)]
pub struct Fastening {
    /// The rims' points nearest to it.
    pub ends: [RimSpot; 2],
    /// Overlap of the two edges there, metres.
    pub reach: f64,
    /// Points of one closure that follow each other along the same two edges have the same row.
    pub row: usize,
    /// The closure and which of its tacks this is.
    pub tack: [usize; 2],
}

/// Every point of the garment's closures that fastens a free edge to another.
pub fn fastenings(garment: &Garment) -> Vec<Fastening> {
    if garment.closures.iter().all(|c| c.tacks.is_empty()) {
        return Vec::new();
    }
    let free = free_spans(garment, &[]);
    let patches = patches(garment);
    let mut found = Vec::new();
    let mut rows = 0;
    for (index, closure) in garment.closures.iter().enumerate() {
        for (r, row) in closure.tacks.chunks(closure.row.max(1)).enumerate() {
            // A patch is fastened to cloth, not to an edge.
            if row.iter().any(|tack| tack.iter().any(|end| patches.contains(&end.0))) {
                continue;
            }
            let [own, met] = [0, 1].map(|side| spots(garment, &free, row, side));
            for (k, ends) in own.into_iter().zip(met).enumerate() {
                let (Some((a, to_a)), Some((b, to_b))) = ends else { continue };
                let tack = [index, r * closure.row.max(1) + k];
                // Points listed at both sides of a poncho are not one row.
                let goes_on = k > 0
                    && found.last().is_some_and(|f: &Fastening| {
                        f.tack == [index, tack[1] - 1] && f.ends.map(|e| e.edge) == [a.edge, b.edge]
                    });
                rows += usize::from(!goes_on);
                found.push(Fastening { ends: [a, b], reach: to_a + to_b, row: rows, tack });
            }
        }
    }
    found
}

/// Place and distance on the rim of every point of one side of a row. A row follows one edge, although beside a
/// neckline its first point may be nearer to another.
fn spots(garment: &Garment, free: &[Span], row: &[[(usize, Vec2); 2]], side: usize) -> Vec<Option<(RimSpot, f64)>> {
    let near = |span: &Span, (piece, p): (usize, Vec2)| {
        (span.edge.piece == piece).then(|| {
            let path = &garment.pieces[piece].loops[span.edge.ring][span.edge.index].path;
            let at = path.nearest(p).0.clamp(span.from, span.to);
            (RimSpot { edge: span.edge, at }, (path.point(at) - p).norm())
        })
    };
    let furthest = |span: &Span| -> f64 {
        row.iter().map(|t| near(span, t[side]).map_or(f64::INFINITY, |n| n.1)).fold(0.0, f64::max)
    };
    let of_row = free.iter().map(|s| (s, furthest(s))).min_by(|a, b| a.1.total_cmp(&b.1));
    let of_row = of_row.filter(|found| found.1 <= REACH).map(|found| found.0);
    let nearest = |end| free.iter().filter_map(|s| near(s, end)).min_by(|a, b| a.1.total_cmp(&b.1));
    row.iter()
        .map(|tack| of_row.map_or_else(|| nearest(tack[side]), |s| near(s, tack[side])).filter(|n| n.1 <= REACH))
        .collect()
}

/// Pieces that only closures hold to the others, such as a pocket tacked at its corners: their rims are no openings.
pub fn patches(garment: &Garment) -> Vec<usize> {
    let sewn = |piece: usize| garment.seams.iter().any(|s| s.a.iter().chain(&s.b).any(|span| span.edge.piece == piece));
    let mut found: Vec<usize> = Vec::new();
    for tack in garment.closures.iter().flat_map(|c: &Closure| &c.tacks) {
        let [a, b] = [tack[0].0, tack[1].0];
        match [sewn(a), sewn(b)] {
            [true, false] => found.push(b),
            [false, true] => found.push(a),
            _ => {}
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// A stretch of a rim.
#[derive(Clone, Copy, Debug)]
pub struct Step<K> {
    /// The edge it belongs to.
    pub along: K,
    /// Metres.
    pub length: f64,
}

/// A fastening as corners of rims: corner `k` of a rim is where its step `k` begins.
#[derive(Clone, Copy, Debug)]
pub struct Bridge<K> {
    /// (rim, corner) twice.
    pub corners: [[usize; 2]; 2],
    /// The edges it fastens.
    pub along: [K; 2],
    /// Overlap, metres.
    pub reach: f64,
    /// As in [`Fastening::row`].
    pub row: usize,
}

/// The openings that remain of `rims` when `bridges` hold their points together: the steps of each, in order.
///
/// A bridge is a narrow band of cloth. A walk along the rim that comes to it crosses it, and goes on along the other
/// side. The stretch between two neighbours of a row, and beyond its end as far as the overlap goes, is closed. So is a
/// slit between fastened edges alone. If rims would be closed altogether, the longest part stays open, unless it is a
/// slit: two tops that are buttoned on either shoulder leave the neck between them.
pub fn worn_rims<K: PartialEq + Clone>(rims: &[Vec<Step<K>>], bridges: &[Bridge<K>]) -> Vec<Vec<[usize; 2]>> {
    let mut joined = DisjointSets::new(rims.len());
    let mut next: Vec<Vec<[usize; 2]>> =
        rims.iter().enumerate().map(|(r, rim)| (0..rim.len()).map(|k| [r, (k + 1) % rim.len()]).collect()).collect();
    // The bridge that is crossed after a step.
    let mut crossed: Vec<Vec<Option<usize>>> = rims.iter().map(|rim| vec![None; rim.len()]).collect();
    for (i, bridge) in bridges.iter().enumerate() {
        let [a, b] = bridge.corners.map(|[r, k]| [r, (k + rims[r].len() - 1) % rims[r].len()]);
        // Points nearer to each other than the rim has corners count once.
        if a == b || [a, b].iter().any(|&[r, k]| crossed[r][k].is_some()) {
            continue;
        }
        // Two ties of a wrap, each from one front's end to the other's middle: in the plane they would cross. One of
        // them tells the waist from the hem. With both, the walk would go from the one to the other.
        if joined.same(a[0] as u32, b[0] as u32) && !on_one_ring(&next, a, b) {
            continue;
        }
        let after = [a, b].map(|[r, k]| next[r][k]);
        (next[a[0]][a[1]], next[b[0]][b[1]]) = (after[1], after[0]);
        [a, b].iter().for_each(|&[r, k]| crossed[r][k] = Some(i));
        joined.join(a[0] as u32, b[0] as u32);
    }
    let parts: Vec<BridgedRing> =
        walked(&next).into_iter().map(|steps| BridgedRing::new(steps, rims, bridges, &crossed)).collect();
    let mut open: Vec<bool> = parts.iter().map(|p| !p.closed).collect();
    for (i, part) in parts.iter().enumerate() {
        let together = |other: &BridgedRing| joined.same(part.steps[0][0] as u32, other.steps[0][0] as u32);
        let rest = || parts.iter().enumerate().filter(|(_, p)| together(p));
        if !part.slit && !rest().any(|(j, p)| open[j] || p.length > part.length) {
            open[i] = true;
        }
    }
    parts.into_iter().zip(open).filter(|(_, open)| *open).map(|(p, _)| p.steps).collect()
}

/// Whether the ring from step `from` comes to step `to`.
fn on_one_ring(next: &[Vec<[usize; 2]>], from: [usize; 2], to: [usize; 2]) -> bool {
    let mut at = from;
    loop {
        at = next[at[0]][at[1]];
        if at == to || at == from {
            return at == to;
        }
    }
}

/// The rings that `next` makes of all steps.
fn walked(next: &[Vec<[usize; 2]>]) -> Vec<Vec<[usize; 2]>> {
    let mut seen: Vec<Vec<bool>> = next.iter().map(|rim| vec![false; rim.len()]).collect();
    let mut rings = Vec::new();
    for (r, rim) in next.iter().enumerate() {
        for k in 0..rim.len() {
            let mut ring = Vec::new();
            let mut at = [r, k];
            while !std::mem::replace(&mut seen[at[0]][at[1]], true) {
                ring.push(at);
                at = next[at[0]][at[1]];
            }
            if !ring.is_empty() {
                rings.push(ring);
            }
        }
    }
    rings
}

/// A ring between bridges.
struct BridgedRing {
    steps: Vec<[usize; 2]>,
    length: f64,
    closed: bool,
    /// Whether it is closed and no more than a gap between fastened edges.
    slit: bool,
}

impl BridgedRing {
    fn new<K: PartialEq>(
        steps: Vec<[usize; 2]>,
        rims: &[Vec<Step<K>>],
        bridges: &[Bridge<K>],
        crossed: &[Vec<Option<usize>>],
    ) -> Self {
        let at: Vec<&Bridge<K>> = steps.iter().filter_map(|&[r, k]| Some(&bridges[crossed[r][k]?])).collect();
        let fastened = |edge: &K| at.iter().any(|b| b.along.contains(edge));
        let step = |[r, k]: [usize; 2]| &rims[r][k];
        let sum = |own: bool| -> f64 {
            steps.iter().map(|&s| step(s)).filter(|s| fastened(&s.along) == own).map(|s| s.length).sum()
        };
        // A wrapped front overlaps by more than half a back neck: what goes round that is told by its long way along
        // the fastened edges, of which there are two at each bridge.
        let beside = sum(false);
        let along = (sum(true) - 2.0 * BEYOND * at.len() as f64).max(0.0);
        let length = steps.iter().map(|&s| step(s).length).sum();
        // A band that is buttoned to itself is fastened all round: its long rim is no slit.
        let turn = if beside > 0.0 || length > SLIT { beside + along } else { 0.0 };
        let reach = at.iter().map(|b| b.reach).fold(0.0, f64::max);
        let between = at.len() == 2 && at[0].row == at[1].row && !std::ptr::eq(at[0], at[1]);
        let closed = !at.is_empty() && (between || turn <= TURN * reach + TURN_SLACK);
        Self { length, closed, slit: closed && length <= SLIT && sum(true) >= beside, steps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rim of steps of a centimetre, edge by edge.
    fn rim(edges: &[(char, usize)]) -> Vec<Step<char>> {
        edges.iter().flat_map(|&(along, n)| vec![Step { along, length: 0.01 }; n]).collect()
    }

    fn lengths(rims: &[Vec<Step<char>>], bridges: &[Bridge<char>]) -> Vec<usize> {
        worn_rims(rims, bridges).iter().map(Vec::len).collect()
    }

    fn button(corners: [[usize; 2]; 2], along: [char; 2], row: usize) -> Bridge<char> {
        Bridge { corners, along, reach: 0.03, row }
    }

    #[test]
    fn a_buttoned_front_leaves_neck_and_hem() {
        // Down the left front, round the hem, up the right one, round the neck.
        let rims = [rim(&[('l', 60), ('h', 100), ('r', 60), ('n', 40)])];
        let row = |n: usize| -> Vec<Bridge<char>> {
            (0..n).map(|i| button([[0, 5 + 10 * i], [0, 215 - 10 * i]], ['l', 'r'], 0)).collect()
        };
        assert_eq!(lengths(&rims, &[]), [260]);
        // Five steps of either front go with the neck, those below the last button with the hem.
        assert_eq!(lengths(&rims, &row(1)), [50, 210]);
        assert_eq!(lengths(&rims, &row(6)), [50, 110]);
    }

    #[test]
    fn a_wrap_top_with_one_tie_keeps_its_neck() {
        // The fronts overlap further than the back neck is wide.
        let rims = [rim(&[('l', 40), ('n', 15), ('r', 40), ('h', 100)])];
        let tie = Bridge { reach: 0.2, ..button([[0, 20], [0, 75]], ['l', 'r'], 0) };
        assert_eq!(lengths(&rims, &[tie]), [140, 55]);
    }

    #[test]
    fn two_ties_of_a_wrap_leave_waist_and_hem() {
        // The back's waist, the right front's waist, its edge, the hem, the left front's edge and its waist.
        let rims = [rim(&[('w', 40), ('r', 30), ('e', 60), ('h', 120), ('f', 60), ('l', 30)])];
        // Either front's corner is tied to the other front's waist.
        let tie = |right: usize, left: usize, row: usize| button([[0, right], [0, left]], ['r', 'l'], row);
        assert_eq!(lengths(&rims, &[tie(45, 312, 0)]), [73, 267]);
        assert_eq!(lengths(&rims, &[tie(45, 312, 0), tie(68, 335, 1)]), [73, 267]);
    }

    #[test]
    fn one_hook_closes_the_end_of_a_band() {
        // In the middle of a band 80 mm wide that overlaps by 30 mm.
        let rims = [rim(&[('t', 80), ('r', 8), ('b', 3), ('l', 8)])];
        assert_eq!(lengths(&rims, &[button([[0, 84], [0, 95]], ['r', 'l'], 0)]), [88]);
    }

    #[test]
    fn a_hooked_band_leaves_one_opening() {
        // The underlap's lower edge is as long as the band overlaps.
        let rims = [rim(&[('t', 80), ('r', 8), ('b', 3), ('l', 8)])];
        let hooks = [button([[0, 85], [0, 94]], ['r', 'l'], 0), button([[0, 87], [0, 92]], ['r', 'l'], 1)];
        assert_eq!(lengths(&rims, &hooks), [90]);
        // The same point twice is one.
        assert_eq!(lengths(&rims, &[hooks[0], hooks[0]]), [90]);
    }

    #[test]
    fn a_band_that_is_buttoned_to_itself_leaves_its_long_rim_open() {
        // A neck band's point is nearer to its long edge than to its end.
        let rims = [rim(&[('t', 40), ('r', 2), ('b', 100), ('l', 2)])];
        assert_eq!(lengths(&rims, &[button([[0, 1], [0, 39]], ['t', 't'], 0)]), [106, 38]);
    }

    #[test]
    fn panels_that_are_buttoned_at_both_sides_make_a_waist_and_a_hem() {
        // Two panels, each its own rim.
        let panel = |w, r, h, l| rim(&[(w, 40), (r, 50), (h, 60), (l, 50)]);
        let rims = [panel('w', 'r', 'h', 'l'), panel('W', 'R', 'H', 'L')];
        let pair = |k: usize, row: usize| {
            let (right, left) = ([row, 40 + k], [1 - row, 200 - k]);
            button([right, left], if row == 0 { ['r', 'L'] } else { ['R', 'l'] }, row)
        };
        let bridges: Vec<Bridge<char>> = [0, 1].into_iter().flat_map(|r| [5, 25, 45].map(|k| pair(k, r))).collect();
        assert_eq!(lengths(&rims, &bridges), [100, 140]);
    }

    #[test]
    fn a_buttoned_slit_is_no_opening() {
        let rims = [rim(&[('u', 15), ('o', 15)])];
        assert_eq!(lengths(&rims, &[]), [30]);
        assert!(lengths(&rims, &[button([[0, 5], [0, 25]], ['u', 'o'], 0)]).is_empty());
        // Its ends may have an edge of their own.
        let rims = [rim(&[('u', 12), ('e', 1), ('o', 12), ('f', 1)])];
        assert!(lengths(&rims, &[button([[0, 6], [0, 19]], ['u', 'o'], 0)]).is_empty());
    }

    #[test]
    fn tops_that_are_buttoned_on_the_shoulders_leave_a_neck() {
        let rims = [rim(&[('f', 40), ('b', 40)])];
        let row = [[10, 70], [30, 50]].map(|[f, b]| button([[0, f], [0, b]], ['f', 'b'], 0));
        assert_eq!(lengths(&rims, &row), [40]);
    }
}
