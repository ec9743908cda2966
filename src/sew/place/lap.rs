//! Members that closures hold one over the other, as the fronts of a shirt: they start lapped, the one with the
//! buttonholes outside.

use super::fold::FoldedPieces;
use super::ring::LAYER;
use super::rows::{Member, extent};
use crate::geometry::{Vec2, range_of};
use crate::mesh::ClothMesh;
use crate::pattern::Closure;

/// Two members lap by no more than this share of the narrower one.
const WIDEST: f64 = 0.8;
/// Length over which the upper layer comes down to the ring again, metres.
const RAMP: f64 = 0.03;

/// Two neighbours of a row, one over the other.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RowLap {
    /// Number of the first of the two in its row; the other one is next, or the row's first after its last.
    pub(super) joint: usize,
    /// Number of the one outside.
    over: usize,
    /// The u of the two where they are held together, in row positions.
    at: [f64; 2],
    /// From the highest to the lowest place where they are, v of the row.
    pub(super) v: [f64; 2],
}

/// The laps of a row of these members, one for a joint: what a closure is on lies under what it meets, as a button
/// under its hole.
pub(super) fn laps(closures: &[Closure], mesh: &ClothMesh, sheet: &FoldedPieces, members: &[Member]) -> Vec<RowLap> {
    let n = members.len();
    let mut all: Vec<(usize, usize, Vec<[Vec2; 2]>)> = Vec::new();
    for tack in closures.iter().flat_map(|c| &c.tacks) {
        let [Some(on), Some(meets)] = tack.map(|end| held(mesh, sheet, members, end)) else { continue };
        for (a, b) in [(on, meets), (meets, on)] {
            if n > 1 && b.member == (a.member + 1) % n && meet(a, b) {
                match all.iter_mut().find(|lap| (lap.0, lap.1) == (a.member, meets.member)) {
                    Some(lap) => lap.2.push([a.at, b.at]),
                    None => all.push((a.member, meets.member, vec![[a.at, b.at]])),
                }
            }
        }
    }
    // An inner button may hold the other way: most points say which one is outside, and of as many the first.
    all.sort_by_key(|lap| (lap.0, std::cmp::Reverse(lap.2.len())));
    all.dedup_by_key(|lap| lap.0);
    let lap = |(joint, over, ends): (usize, usize, Vec<[Vec2; 2]>)| {
        let mean = |k: usize| ends.iter().map(|end| end[k].x).sum::<f64>() / ends.len() as f64;
        RowLap { joint, over, at: [mean(0), mean(1)], v: range_of(ends.iter().flatten().map(|end| end.y)) }
    };
    all.into_iter().map(lap).collect()
}

/// An end of a tack on a member.
#[derive(Clone, Copy)]
struct TackEnd {
    member: usize,
    /// In row positions.
    at: Vec2,
    /// Lowest and highest u of the member.
    ends: [f64; 2],
}

/// Whether a tack holds the left end of one member over the right end of the other: it is nearer to these than to their
/// other ends, and they lap by less than either is wide.
fn meet(a: TackEnd, b: TackEnd) -> bool {
    let lap = |a: TackEnd, b: TackEnd| (a.ends[1] - a.at.x) + (b.at.x - b.ends[0]);
    let width = |held: TackEnd| held.ends[1] - held.ends[0];
    lap(a, b) < lap(b, a) && lap(a, b) < WIDEST * width(a).min(width(b))
}

fn held(mesh: &ClothMesh, sheet: &FoldedPieces, members: &[Member], (piece, at): (usize, Vec2)) -> Option<TackEnd> {
    let member = members.iter().position(|m| m.piece == piece)?;
    let at = sheet.flat[mesh.nearest(piece, at)?];
    let shift = members[member].shift;
    Some(TackEnd { member, at: at + shift, ends: extent(mesh, sheet, piece).map(|corner| corner.x + shift.x) })
}

impl RowLap {
    /// Room between the two where they span these u: less than nothing, for they lap.
    pub(super) fn gap(&self, [own, next]: [[f64; 2]; 2]) -> f64 {
        (self.at[0] - own[1]) + (next[0] - self.at[1])
    }

    /// How far off the ring member `i` is at u, where the two span these u.
    pub(super) fn off(&self, i: usize, u: f64, spans: [[f64; 2]; 2]) -> f64 {
        if i != self.over {
            return 0.0;
        }
        let from_end = if i == self.joint { spans[0][1] - u } else { u - spans[1][0] };
        LAYER * ((RAMP - self.gap(spans) - from_end) / RAMP).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn what_laps_lies_over_what_is_under_it_and_comes_down_beyond() {
        // Held together 20 mm from the end of either: they lap by 40 mm.
        let lap = RowLap { joint: 3, over: 0, at: [0.98, 0.02], v: [0.1, 0.5] };
        let spans = [[0.6, 1.0], [0.0, 0.4]];
        assert_relative_eq!(lap.gap(spans), -0.04, epsilon = 1e-12);
        let off = |u: f64| lap.off(0, u, spans);
        assert_relative_eq!(off(0.0), LAYER);
        assert_relative_eq!(off(0.04), LAYER, epsilon = 1e-12);
        assert_relative_eq!(off(0.055), 0.5 * LAYER, epsilon = 1e-12);
        assert_relative_eq!(off(0.07), 0.0, epsilon = 1e-12);
        assert_relative_eq!(lap.off(3, 1.0, spans), 0.0);
    }
    #[test]
    fn a_tie_holds_the_ends_that_it_laps_by_less() {
        let held = |member: usize, u: f64, ends: [f64; 2]| TackEnd { member, at: Vec2::new(u, 0.0), ends };
        // A wrap: either end is tied near the other's middle.
        let (right, left) = ([0.0, 0.45], [0.45, 0.9]);
        for (a, b) in [(0.2, 0.46), (0.44, 0.7)] {
            let [a, b] = [held(0, a, right), held(1, b, left)];
            assert!(meet(a, b) && !meet(b, a));
        }
        // A button at the end of either.
        assert!(meet(held(0, 0.43, right), held(1, 0.47, left)));
        // Tied all the way across, neither laps.
        assert!(!meet(held(0, 0.02, right), held(1, 0.8, left)));
    }
}
