//! Which side is left, and where the front middle of an opening is.
//!
//! A garment that is turned about the body's axis by half a turn has its front at the back and its left at the right:
//! one tells the other. A rim at the top runs from the wearer's right over the front to the left.

use super::deal::Wearing;
use super::ends::Ends;
use super::marks;
use crate::geometry::range_of;
use crate::pattern::PlaceMeaning;

/// Left and right are told by pairs and by `place`, and else by depth: a neck is lower at the front, a waist is nearer
/// to the legs there. Said words outweigh what is drawn.
const SAID: f64 = 2.0;
const DEEPER: f64 = 0.5;
/// Two middles that differ by less, metres, in their distance from the hem tell nothing.
const LEVEL: f64 = 0.005;

/// Exchanges left and right of the openings `own` of a part where that fits better, and finds their front middles.
pub(super) fn settle(wearing: &Wearing, own: &[usize], ends: &mut [Ends], front: &mut [Option<u32>]) {
    let told = evidence(wearing, own, ends);
    if told < 0.0 {
        own.iter().for_each(|&i| ends[i] = ends[i].mirrored());
    }
    let Some(left_of) = left_field(wearing, own, ends) else { return };
    for &i in own {
        if ends[i].has(Ends::HEAD) || ends[i].has(Ends::LEGS) {
            let by_arm = only_arm(own, ends).filter(|_| ends[i].has(Ends::HEAD));
            let by_arm = by_arm.map(|arm| arm_field(wearing, i, arm, ends[arm]));
            let [fore, _] = middles(wearing, i, ends[i], by_arm.as_ref().unwrap_or(&left_of));
            front[i] = fore;
        }
    }
}

/// How much speaks for left and right as they are: above 0 for, below against.
fn evidence(wearing: &Wearing, own: &[usize], ends: &[Ends]) -> f64 {
    let (left, right) = (Ends::LEFT_ARM.with(Ends::LEFT_LEG), Ends::RIGHT_ARM.with(Ends::RIGHT_LEG));
    let mut sum = 0.0;
    for &i in own {
        let way = f64::from(ends[i].touches(left)) - f64::from(ends[i].touches(right));
        sum += SAID * way * marks::sidedness(&wearing.stretches[i]);
    }
    if let Some(arm) = only_arm(own, ends) {
        let way = if ends[arm] == Ends::LEFT_ARM { SAID } else { -SAID };
        return sum + way * marks::drawn_sidedness(wearing.garment, &wearing.stretches[arm]);
    }
    let Some(left_of) = left_field(wearing, own, ends) else { return sum };
    for &i in own.iter().filter(|&&i| ends[i].has(Ends::HEAD)) {
        let [fore, back] = middles(wearing, i, ends[i], &left_of);
        sum += SAID * (facing(wearing, fore) - facing(wearing, back));
        sum += deeper(wearing, own, ends, i, [fore, back]);
    }
    sum
}

/// The opening of one arm, of a garment over one shoulder.
fn only_arm(own: &[usize], ends: &[Ends]) -> Option<usize> {
    let with = |arm: Ends| own.iter().copied().find(|&i| ends[i] == arm);
    match [Ends::LEFT_ARM, Ends::RIGHT_ARM].map(with) {
        [Some(arm), None] | [None, Some(arm)] => Some(arm),
        _ => None,
    }
}

/// For every node how much nearer it is to the only arm's side, seen from the middle of opening `i`, metres; below 0 on
/// the right.
fn arm_field(wearing: &Wearing, i: usize, arm: usize, side: Ends) -> Vec<f64> {
    let far = &wearing.far[arm];
    let [low, high] = range_of(wearing.openings[i].rim.iter().map(|n| far[*n as usize]));
    let side = if side == Ends::LEFT_ARM { 1.0 } else { -1.0 };
    far.iter().map(|far| side * (0.5 * (low + high) - far)).collect()
}

/// Whether the front middle of opening `i` is nearer to the hem or the legs than its back middle.
fn deeper(wearing: &Wearing, own: &[usize], ends: &[Ends], i: usize, [fore, back]: [Option<u32>; 2]) -> f64 {
    let (Some(fore), Some(back)) = (fore, back) else { return 0.0 };
    let low = own.iter().filter(|&&j| j != i && ends[j].touches(Ends::LEGS));
    let far = |n: u32| low.clone().map(|&j| wearing.far[j][n as usize]).fold(f64::INFINITY, f64::min);
    let more = far(back) - far(fore);
    if more.is_finite() && more.abs() > LEVEL { DEEPER * more.signum() } else { 0.0 }
}

/// 1 where what a node is on is said to be at the front, −1 at the back.
fn facing(wearing: &Wearing, node: Option<u32>) -> f64 {
    let Some(node) = node else { return 0.0 };
    let pieces = wearing.mesh.pieces.iter().enumerate().filter(|(_, piece)| {
        let at_node = |p: usize| wearing.glued.node_of[p] == Some(node);
        piece.edges.iter().flat_map(|e| &e.particles).any(|&p| at_node(p as usize))
    });
    let says = |piece: usize, meaning| f64::from(marks::says(wearing.garment, piece, meaning));
    let sum: f64 = pieces.map(|(i, _)| says(i, PlaceMeaning::Front) - says(i, PlaceMeaning::Back)).sum();
    sum.clamp(-1.0, 1.0)
}

/// For every node how much nearer it is to what is on the left than to what is on the right, metres; none where nothing
/// is.
pub(super) fn left_field(wearing: &Wearing, own: &[usize], ends: &[Ends]) -> Option<Vec<f64>> {
    let pairs = [[Ends::LEFT_ARM, Ends::RIGHT_ARM], [Ends::LEFT_LEG, Ends::RIGHT_LEG]];
    let with = |one: Ends| own.iter().copied().find(|&i| ends[i] == one);
    let found = pairs.into_iter().find_map(|[left, right]| Some([with(left)?, with(right)?]));
    if let Some([left, right]) = found {
        return Some(wearing.far[right].iter().zip(&wearing.far[left]).map(|(r, l)| r - l).collect());
    }
    drawn_field(wearing)
}

/// The same by the sides of pieces and, on pieces said to be at the front or back, by how they are drawn.
fn drawn_field(wearing: &Wearing) -> Option<Vec<f64>> {
    let (garment, mesh) = (wearing.garment, wearing.mesh);
    let mut field = vec![0.0; wearing.glued.count];
    for (i, piece) in mesh.pieces.iter().enumerate() {
        let side = |p: usize| marks::side_at(garment, i, mesh.flat[p]);
        let faces = f64::from(marks::says(garment, i, PlaceMeaning::Front))
            - f64::from(marks::says(garment, i, PlaceMeaning::Back));
        let range = piece.particles.clone();
        let x = range.clone().map(|p| mesh.flat[p].x);
        let middle = 0.5 * (x.clone().fold(f64::INFINITY, f64::min) + x.fold(f64::NEG_INFINITY, f64::max));
        for p in range {
            let Some(node) = wearing.glued.node_of[p] else { continue };
            // Seen from outside the wearer's left is to the right on a front, to the left on a back.
            let told = side(p);
            field[node as usize] += if told != 0.0 { told } else { faces * (mesh.flat[p].x - middle) };
        }
    }
    let told = |left: bool| -> Vec<u32> {
        (0..field.len() as u32)
            .filter(|&n| if left { field[n as usize] > 0.0 } else { field[n as usize] < 0.0 })
            .collect()
    };
    let [left, right] = [true, false].map(told);
    if left.is_empty() || right.is_empty() {
        return None;
    }
    // Pieces that say nothing are on the side of what they are nearest to.
    let [to_left, to_right] = [left, right].map(|nodes| wearing.cloth.from(&nodes));
    Some(to_right.iter().zip(to_left).map(|(r, l)| if r.is_finite() && l.is_finite() { r - l } else { 0.0 }).collect())
}

/// The front middle and the back middle of a rim. At the top it runs from right to left at the front, at the bottom
/// from left to right.
pub(super) fn middles(wearing: &Wearing, i: usize, ends: Ends, left_of: &[f64]) -> [Option<u32>; 2] {
    let rim = &wearing.openings[i].rim;
    let at_top = ends.has(Ends::HEAD);
    let at = |k: usize| left_of[rim[k % rim.len()] as usize];
    let crossing = |rising: bool| {
        let found = (0..rim.len())
            .filter(|&k| if rising { at(k) < 0.0 && at(k + 1) >= 0.0 } else { at(k) >= 0.0 && at(k + 1) < 0.0 });
        // Of several the one between the longest stretches.
        let reach = |k: usize| {
            let same = |step: &usize| (at(k + step + 1) >= 0.0) == rising;
            let other = |step: &usize| (at(k + rim.len() - step) >= 0.0) != rising;
            (0..rim.len()).take_while(same).count().min((0..rim.len()).take_while(other).count())
        };
        found.max_by_key(|&k| (reach(k), std::cmp::Reverse(k))).map(|k| rim[(k + 1) % rim.len()])
    };
    let (rising, falling) = (crossing(true), crossing(false));
    if at_top { [rising, falling] } else { [falling, rising] }
}
