//! Open fronts are closed with themselves for the start.

use super::deal::Wearing;
use super::ends::Ends;
use super::marks;
use super::sides::{left_field, middles};
use crate::geometry::{Vec2, range_of};
use crate::mesh::PieceMesh;

/// A neck or waist that is left of an open front is about this many times as wide as what goes through it.
const WIDE: f64 = 1.2;
/// And no wider than this.
const WIDEST: f64 = 2.2;
/// The fronts have at least this share of what is between the middles of the neck and of the hem. A bolero's fronts are
/// so far apart that its rim is no longer than a neck and a trunk together.
const LEAST: f64 = 0.1;
/// A rim of less than this share of a neck and a trunk together is no neckline with a hem: a pocket's.
const SHORT: f64 = 0.5;
/// A place in the drawing of its piece is above another one if it is higher up by this share of a piece's height.
const UPRIGHT: f64 = 0.5;
/// A corner of a rim turns by at least this much (cosine; 40°).
const CORNER: f64 = 0.77;

/// The pairs of particles that close every opening which head and legs pass through: its two fronts.
pub(super) fn zips(wearing: &Wearing, ends: &[Ends]) -> Vec<[u32; 2]> {
    let open = (0..ends.len()).filter(|&i| ends[i].has(Ends::HEAD.with(Ends::LEGS)));
    open.filter_map(|i| zip(wearing, ends, i)).flatten().collect()
}

fn zip(wearing: &Wearing, ends: &[Ends], i: usize) -> Option<Vec<[u32; 2]>> {
    let part = wearing.openings[i].part;
    let own: Vec<usize> = (0..ends.len()).filter(|&j| wearing.openings[j].part == part).collect();
    let left_of = left_field(wearing, &own, ends)?;
    let [one, other] = middles(wearing, i, ends[i], &left_of);
    let (one, other) = (one?, other?);
    let arms = || own.iter().filter(|&&j| j != i && !ends[j].is_empty() && Ends::ARMS.has(ends[j]));
    let far = |n: u32| arms().map(|&j| wearing.far[j][n as usize]).sum::<f64>();
    // Pieces are drawn upright. In one drawn on its side the back of the neck is nearer to the arms than that of the
    // hem; of a bolero, which is short, it is not.
    let below = drawn_height(wearing, one) - drawn_height(wearing, other);
    let is_drawn_upright = below.abs() > UPRIGHT || arms().next().is_none();
    let is_above = if is_drawn_upright { below <= 0.0 } else { far(one) <= far(other) };
    let (top, bottom) = if is_above { (one, other) } else { (other, one) };
    let rim = &wearing.openings[i].rim;
    let place = |n: u32| rim.iter().position(|&m| m == n);
    let (top, bottom) = (place(top)?, place(bottom)?);
    let n = rim.len();
    let sides = &wearing.openings[i].sides;
    if sides.len() != n {
        return None;
    }
    let down: Vec<[u32; 2]> = (0..(bottom + n - top) % n).map(|k| sides[(top + k) % n]).collect();
    let up: Vec<[u32; 2]> =
        (1..=(top + n - bottom) % n).map(|k| sides[(top + n - k) % n]).map(|[a, b]| [b, a]).collect();
    let at_neck = arms().next().is_some() || wearing.stretches[i].iter().any(|s| is_high(wearing, s.piece));
    let through = if at_neck { wearing.sizes.neck } else { wearing.sizes.waist };
    let halves = [down, up].map(|half| stretch(wearing, &half, 0.5 * through, 0.5 * wearing.sizes.trunk));
    Some(super::laps::matched(&halves[0], &halves[1]))
}

/// How far down in the drawing of its piece a node is, as a share.
fn drawn_height(wearing: &Wearing, node: u32) -> f64 {
    let mesh = wearing.mesh;
    let at_node = |piece: &&PieceMesh| {
        piece.particles.clone().find(|&p| wearing.glued.node_of[p] == Some(node)).map(|p| (p, piece.particles.clone()))
    };
    let Some((p, all)) = mesh.pieces.iter().find_map(|piece| at_node(&piece)) else { return 0.0 };
    let [low, high] = range_of(all.map(|p| mesh.flat[p].y));
    (mesh.flat[p].y - low) / (high - low).max(1e-9)
}

/// Whether a piece is said to go round the neck, or to hang from the shoulders.
fn is_high(wearing: &Wearing, piece: usize) -> bool {
    marks::words(wearing.garment, piece).any(marks::is_high)
}

/// The front of a rim that goes from the middle of the top to that of the bottom: from the corner at the top to the one
/// at the bottom, or where the neck and the hem would end. `half` are the sides of the rim between them.
fn stretch(wearing: &Wearing, half: &[[u32; 2]], top: f64, bottom: f64) -> Vec<u32> {
    let mut whole = 0.0;
    let mut at = Vec::with_capacity(half.len());
    for &side in half {
        at.push(whole);
        whole += course(wearing, side).norm();
    }
    let scale = f64::min(1.0, (1.0 - LEAST) * whole / (WIDE * (top + bottom)));
    if scale < SHORT {
        return Vec::new();
    }
    let (top, bottom) = (scale * top, scale * bottom);
    let is_corner = |&k: &usize| {
        half[k - 1][1] == half[k][0] && {
            let (before, after) = (course(wearing, half[k - 1]).normalize(), course(wearing, half[k]).normalize());
            before.dot(&after) < CORNER
        }
    };
    let corners: Vec<usize> = (1..half.len()).filter(is_corner).collect();
    let near = |wanted: f64, k: &usize| (at[*k] - wanted).abs();
    let first = corners.iter().copied().filter(|&k| at[k] >= 0.9 * top && at[k] <= WIDEST * top);
    let first = first.min_by(|a, b| near(WIDE * top, a).total_cmp(&near(WIDE * top, b)));
    let last = corners.iter().copied().rfind(|&k| whole - at[k] >= 0.9 * bottom);
    let from = first.map_or(WIDE * top, |k| at[k]);
    let to = last.map_or(whole - WIDE * bottom, |k| at[k]);
    half.iter().zip(&at).filter(|(_, at)| **at >= from && **at <= to).map(|(side, _)| side[0]).collect()
}

/// The way along a side of the rim, as drawn.
fn course(wearing: &Wearing, [a, b]: [u32; 2]) -> Vec2 {
    wearing.mesh.flat[b as usize] - wearing.mesh.flat[a as usize]
}
