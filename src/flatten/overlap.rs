//! Does a flat piece lie on itself? A check that knows nothing of how the piece was made.

use std::collections::HashMap;

use crate::geometry::{Vec2, distance_to_segment, sorted_pair};

/// The rim is as long as it should be when its edges are off by less than this share in the mean, for then no part of
/// it is off by more than this share of the whole: of a rim of two metres by a micrometre where only the rim counts, by
/// less than a hundredth of a millimetre otherwise, which nobody can cut.
pub(super) const RIM_EXACT: [f64; 2] = [5e-7, 4e-6];
/// Cloth lies on itself where it does so by more than this share of its rim. Rims are relaxed until their lengths are
/// that exact, and places in the plane are no better known: the two sides of a slit coincide in a flat piece, and by
/// rounding alone they cross in every other vertex.
const DEEP: f64 = RIM_EXACT[1];
/// Nor does it where it does so by less than this, metres: nobody can cut or see that. The sides of a cut across a ring
/// that is not quite flat lie on each other by so much.
const SEEN: f64 = 0.25e-3;

/// Number of pairs of rim edges, within a rim and between rims, that cross or touch where the piece lies on itself.
/// Edges that share a vertex do not count. A flat piece without flipped triangles lies on itself exactly where its rims
/// go round a place more than once, and such a place begins where rims meet. Rims run with their triangles.
pub fn rim_crossings(flat: &[Vec2], rims: &[Vec<u32>]) -> usize {
    crossings_beside(flat, rims, &Legs::new())
}

/// The edges (smaller vertex first) of the legs of darts, each with the number of its dart.
pub(super) type Legs = HashMap<[u32; 2], usize>;

/// [`rim_crossings`] without those of one leg of a dart with the other: nothing is cut out between them. They cross
/// beside the tip where cloth is drawn out round it.
pub(super) fn crossings_beside(flat: &[Vec2], rims: &[Vec<u32>], legs: &Legs) -> usize {
    let edges: Vec<[u32; 2]> =
        rims.iter().flat_map(|rim| (0..rim.len()).map(|k| [rim[k], rim[(k + 1) % rim.len()]])).collect();
    let sides: Vec<[Vec2; 2]> = edges.iter().map(|e| e.map(|v| flat[v as usize])).collect();
    let length = |[a, b]: &[Vec2; 2]| (b - a).norm();
    let depth = f64::max(SEEN, DEEP * sides.iter().map(length).sum::<f64>());
    let longest = sides.iter().map(length).fold(0.0, f64::max);
    let on_itself = |&(i, j): &(u32, u32)| {
        let [e, f] = [i, j].map(|k| edges[k as usize]);
        let [s, t] = [i, j].map(|k| sides[k as usize]);
        let dart = |e: [u32; 2]| legs.get(&sorted_pair(e));
        let is_sewn = dart(e).is_some() && dart(e) == dart(f);
        let is_apart = !f.contains(&e[0]) && !f.contains(&e[1]) && !is_sewn;
        let meet = is_apart.then(|| meeting(s, t, depth)).flatten();
        let inside = meet.and_then(|at| within_both(s, t, at, depth, longest));
        inside.is_some_and(|places| places.iter().all(|p| times_round(&sides, *p) > 1))
    };
    near(&sides, longest, depth).iter().filter(|pair| on_itself(pair)).count()
}

/// Pairs of sides that may be within `depth` of each other.
pub(super) fn near(sides: &[[Vec2; 2]], longest: f64, depth: f64) -> Vec<(u32, u32)> {
    // With cells of the longest side's size a side meets at most four of them, but for what `depth` adds.
    let size = if longest > 0.0 && longest.is_finite() { longest } else { 1.0 };
    let cell = |x: f64| (x / size).floor() as i64;
    let mut cells: HashMap<[i64; 2], Vec<u32>> = HashMap::new();
    let mut near = Vec::new();
    for (k, [a, b]) in sides.iter().enumerate() {
        for x in cell(a.x.min(b.x) - depth)..=cell(a.x.max(b.x) + depth) {
            for y in cell(a.y.min(b.y) - depth)..=cell(a.y.max(b.y) + depth) {
                let there = cells.entry([x, y]).or_default();
                near.extend(there.iter().map(|&other| (other, k as u32)));
                there.push(k as u32);
            }
        }
    }
    near.sort_unstable();
    near.dedup();
    near
}

/// Where two sides cross, each between its ends.
pub(super) fn crossing([a, b]: [Vec2; 2], [c, d]: [Vec2; 2]) -> Option<Vec2> {
    let side = |p: Vec2, q: Vec2, r: Vec2| (q - p).perp(&(r - p));
    let (at_a, at_b) = (side(c, d, a), side(c, d, b));
    (side(a, b, c) * side(a, b, d) < 0.0 && at_a * at_b < 0.0).then(|| a + (b - a) * (at_a / (at_a - at_b)))
}

/// Where two sides cross, or else an end of one within `depth` of the other.
fn meeting([a, b]: [Vec2; 2], [c, d]: [Vec2; 2], depth: f64) -> Option<Vec2> {
    let ends = [(a, [c, d]), (b, [c, d]), (c, [a, b]), (d, [a, b])];
    let near = |&(end, other): &(Vec2, [Vec2; 2])| distance_to_segment(end, other) <= depth;
    crossing([a, b], [c, d]).or_else(|| ends.into_iter().find(near).map(|(end, _)| end))
}

/// Two places beside each other that, from where two sides meet, lie within both, half of `depth` or more. One alone
/// may lie on other rims that end there, as where the ends of a ring meet. `None` where the sides run so much against
/// each other that this would be more than the `longest` side away: what lies there is for other sides to say.
fn within_both(s: [Vec2; 2], t: [Vec2; 2], meet: Vec2, depth: f64, longest: f64) -> Option<[Vec2; 2]> {
    let inward = |[a, b]: [Vec2; 2]| Vec2::new(a.y - b.y, b.x - a.x).normalize();
    let both = inward(s) + inward(t);
    let way = both * (2.0 * depth / both.norm_squared());
    let beside = Vec2::new(-way.y, way.x) * (0.5 * depth / way.norm());
    (way.norm() <= longest).then(|| [meet + way - beside, meet + way + beside])
}

/// How often rims go round a place, holes taken off: how many layers of a piece without flipped triangles lie there.
fn times_round(sides: &[[Vec2; 2]], p: Vec2) -> i32 {
    // By a ray from `p` to the right; an end at its height counts as above it.
    let crossed = |[a, b]: &[Vec2; 2]| match (a.y > p.y, b.y > p.y) {
        (false, true) => i32::from((b - a).perp(&(p - a)) > 0.0),
        (true, false) => -i32::from((b - a).perp(&(p - a)) < 0.0),
        _ => 0,
    };
    sides.iter().map(crossed).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A strip one wide round a circle of radius two, a vertex every 10° on both its sides.
    fn strip(degrees: u32, turned: f64) -> (Vec<Vec2>, Vec<Vec<u32>>) {
        let at = |k: u32, radius: f64| {
            let (sine, cosine) = (f64::from(10 * k) / 360.0 * TAU + turned).sin_cos();
            radius * Vec2::new(cosine, sine)
        };
        let count = degrees / 10;
        let flat: Vec<Vec2> = (0..=count).map(|k| at(k, 2.0)).chain((0..=count).rev().map(|k| at(k, 1.0))).collect();
        let rim = (0..flat.len() as u32).collect();
        (flat, vec![rim])
    }

    /// A square with a square hole, open along a slit between them.
    fn slit_square(turned: f64) -> (Vec<Vec2>, Vec<Vec<u32>>) {
        let (sine, cosine) = turned.sin_cos();
        let turn = |x: f64, y: f64| Vec2::new(0.1 + cosine * x - sine * y, 0.7 + sine * x + cosine * y);
        let slit = |k: u32| f64::from(k) / 7.0;
        let mut flat: Vec<Vec2> = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)].map(|(x, y)| turn(x, y)).into();
        flat.extend((0..=7).map(|k| turn(slit(k), slit(k))).skip(1));
        flat.extend([(1.0, 2.0), (2.0, 2.0), (2.0, 1.0)].map(|(x, y)| turn(x, y)));
        // The other side of the slit, with roundings of its own, now to this side of it and now to that.
        let rounding = |k: u32| if k.is_multiple_of(2) { 1e-15 } else { -1e-15 };
        flat.extend((0..=7).rev().map(|k| turn(slit(k) * (1.0 + rounding(k)), slit(k) * (1.0 - rounding(k)))));
        // Past the slit's first side the rim begins with its outer corner.
        let rim = [(1..4).collect::<Vec<u32>>(), vec![0], (4..flat.len() as u32).collect()].concat();
        (flat, vec![rim])
    }

    #[test]
    fn a_strip_lies_on_itself_once_it_is_longer_than_a_ring() {
        for turned in [0.0, 0.1, 0.7, 1.3, 2.9] {
            let overlaps = |degrees| {
                let (flat, rims) = strip(degrees, turned);
                rim_crossings(&flat, &rims)
            };
            assert_eq!((overlaps(180), overlaps(350)), (0, 0), "{turned}");
            // It closes, and no more.
            assert_eq!(overlaps(360), 0, "{turned}");
            // Its second layer has its vertices where the first has them.
            assert!(overlaps(370) > 0 && overlaps(450) > 0, "{turned}");
        }
        assert_eq!(rim_crossings(&[], &[]), 0);
    }

    #[test]
    fn legs_of_a_dart_that_cross_beside_its_tip_are_no_overlap() {
        // A square cut in from above by a dart, its legs a tenth beyond each other beside the tip.
        let corners =
            [(0.0, 0.0), (4.0, 0.0), (5.1, 8.0), (5.0, 9.0), (4.9, 8.0), (6.0, 0.0), (10.0, 0.0), (10.0, 12.0)];
        let mut flat: Vec<Vec2> = corners.map(|(x, y)| Vec2::new(x, y)).into();
        flat.push(Vec2::new(0.0, 12.0));
        let rims = [(0..9).collect::<Vec<u32>>()];
        let legs: Legs = [1, 2, 3, 4].map(|k| ([k, k + 1], 0)).into();
        assert!(rim_crossings(&flat, &rims) > 0);
        assert_eq!(crossings_beside(&flat, &rims, &legs), 0);
        // Of two darts they are.
        let legs: Legs = [(1, 0), (2, 0), (3, 1), (4, 1)].map(|(k, dart)| ([k, k + 1], dart)).into();
        assert!(crossings_beside(&flat, &rims, &legs) > 0);
    }

    #[test]
    fn two_arms_that_cross_do_so_four_times() {
        // A strip that goes to the right, up, and down through its beginning.
        let corners = [(0, 0), (6, 0), (6, 5), (2, 5), (2, -2), (3, -2), (3, 4), (5, 4), (5, 1), (0, 1)];
        let flat = corners.map(|(x, y)| Vec2::new(f64::from(x), f64::from(y)));
        assert_eq!(rim_crossings(&flat, &[(0..10).collect()]), 4);
    }

    #[test]
    fn the_sides_of_a_slit_do_not_lie_on_each_other() {
        for k in 0..24 {
            let (flat, rims) = slit_square(f64::from(k) * 0.27);
            assert_eq!(rim_crossings(&flat, &rims), 0, "{k}");
        }
    }
}
