//! How far off the nodes of a star are: the body's ways through it lie within, those outside do not touch it.
//!
//! Distances along fixed directions leave a star a star, so that it passes nowhere through itself.

use super::way_out::WayOut;
use crate::geometry::Vec3;

/// The cloth starts so far beyond the ways within it, metres: an edge of the start mesh.
const CLEAR: f64 = 0.025;
/// A way outside draws the cloth in to this share of its distance at most in one round.
const DRAWN_IN: f64 = 0.25;
/// The first points of a way outside lie in the opening itself, with its rim beside them. So many are left out.
const AT_RIM: usize = 3;
/// How often distances are corrected: a triangle that moves takes its neighbours along.
const ROUNDS: usize = 8;

/// Moves the nodes `x`, as seen from the middle of the star, along their directions until `ways` from that middle lie
/// within the cloth up to their openings, and outside it from there.
pub(super) fn clear(x: &mut [Vec3], triangles: &[[u32; 3]], ways: &[WayOut], middle: Vec3) {
    let off = |p: &Vec3| p - middle;
    let within: Vec<Vec3> = ways.iter().flat_map(|way| way.within.iter().map(off)).collect();
    let outside: Vec<Vec3> = ways.iter().flat_map(|way| way.outside.iter().skip(AT_RIM).map(off)).collect();
    // Nodes keep their directions, so that each point sees the same triangles all the time.
    let [outside, within] = [outside, within].map(|points| in_sight(&points, x, triangles));
    for _ in 0..ROUNDS {
        let drawn = outside.iter().filter(|sight| put(x, sight, false)).count();
        let moved = within.iter().filter(|sight| put(x, sight, true)).count();
        if drawn + moved == 0 {
            break;
        }
    }
}

/// A point, and the triangles that are seen in its direction.
struct InSight {
    point: Vec3,
    triangles: Vec<[u32; 3]>,
}

fn in_sight(points: &[Vec3], x: &[Vec3], triangles: &[[u32; 3]]) -> Vec<InSight> {
    let one = |point: &Vec3| {
        let is_seen = |t: &&[u32; 3]| seen(t.map(|n| x[n as usize]), *point).is_some();
        InSight { point: *point, triangles: triangles.iter().filter(is_seen).copied().collect() }
    };
    points.iter().map(one).collect()
}

/// Moves the triangles that are seen in the direction of a point beyond it, or to this side of it. Whether any moved.
fn put(x: &mut [Vec3], sight: &InSight, beyond: bool) -> bool {
    let far = sight.point.norm();
    let mut moved = false;
    for t in &sight.triangles {
        let Some(share) = seen(t.map(|n| x[n as usize]), sight.point) else { continue };
        let at = share * far;
        let to = if beyond { at.max(far + CLEAR) } else { at.min((far - CLEAR).max(DRAWN_IN * at)) };
        if to != at {
            t.iter().for_each(|n| x[*n as usize] *= to / at);
            moved = true;
        }
    }
    moved
}

/// How far off a triangle is in a direction, in lengths of `way`, if it is seen there.
fn seen([a, b, c]: [Vec3; 3], way: Vec3) -> Option<f64> {
    let shares = [b.cross(&c).dot(&way), c.cross(&a).dot(&way), a.cross(&b).dot(&way)];
    let sum: f64 = shares.iter().sum();
    // All of one sign, and on this side of the middle.
    let det = a.dot(&b.cross(&c));
    let is_seen = det != 0.0 && shares.iter().all(|s| s * det >= 0.0) && sum != 0.0;
    is_seen.then(|| det / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn octahedron(size: f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        let x = axes.iter().flat_map(|a| [a * size, a * -size]).collect();
        let t = (0..8u32).map(|k| [k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2 & 1)]).collect();
        (x, t)
    }

    #[test]
    fn a_triangle_is_seen_where_it_is_and_not_behind() {
        let t = [Vec3::x(), Vec3::y(), Vec3::z()];
        let way = Vec3::repeat(1.0).normalize();
        assert!((seen(t, way).expect("ahead") - 1.0 / 3f64.sqrt()).abs() < 1e-12);
        assert!(seen(t, -way).is_none());
        assert!(seen(t, Vec3::new(1.0, -0.1, 0.0)).is_none());
    }

    #[test]
    fn what_is_within_comes_to_lie_within_and_what_is_outside_to_lie_outside() {
        let (mut x, t) = octahedron(0.2);
        let up = |y: f64| Vec3::new(0.01, y, 0.01);
        let ways = WayOut {
            within: vec![up(0.1), up(0.5)],
            outside: (0..5).map(|k| Vec3::new(0.1 + 0.01 * f64::from(k), -0.001, 0.001)).collect(),
            arm: None,
        };
        clear(&mut x, &t, &[ways], Vec3::zeros());
        let far =
            |way: Vec3| t.iter().filter_map(|t| seen(t.map(|n| x[n as usize]), way.normalize())).fold(0.0, f64::max);
        assert!(far(up(0.5)) > 0.5);
        assert!(far(Vec3::new(0.14, -0.001, 0.001)) < 0.14);
    }
}
