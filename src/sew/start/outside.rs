//! Outer garments start outside inner ones: every layer has been inflated by itself.

use super::axes::Axes;
use super::hand_over::PLY;
use crate::geometry::{Vec3, pierces};

/// Cloth further out than this from where an outer layer has been inflated, metres, is not under it but beside it: a
/// sleeve beside the trunk.
const BESIDE: f64 = 0.1;

/// Moves the nodes of every level out of the body's axes until they lie over all that is of lower levels.
pub(super) fn put_outside(nodes: &mut [Vec3], triangles: &[[u32; 3]], level: &[i32], axes: &Axes) {
    let mut levels = level.to_vec();
    levels.sort_unstable();
    levels.dedup();
    for outer in levels.into_iter().skip(1) {
        let inner = triangles.iter().filter(|t| level[t[0] as usize] < outer);
        let inner: Vec<[Vec3; 3]> = inner.map(|t| t.map(|n| nodes[n as usize])).collect();
        for n in (0..nodes.len()).filter(|n| level[*n] == outer) {
            let Some(middle) = axes.middle(nodes[n]) else { continue };
            let way = nodes[n] - middle;
            let Some(out) = way.try_normalize(0.0) else { continue };
            let end = middle + out * (way.norm() + BESIDE);
            let furthest = inner.iter().filter_map(|t| crossed(middle, end, *t)).fold(0.0, f64::max);
            if furthest > 0.0 {
                nodes[n] = middle + out * way.norm().max(furthest + PLY);
            }
        }
    }
}

/// How far along a segment it passes through a triangle, metres, if it does.
fn crossed(from: Vec3, to: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f64> {
    let normal = (b - a).cross(&(c - a));
    let share = || normal.dot(&(a - from)) / normal.dot(&(to - from));
    pierces(from, to, [a, b, c]).then(|| share() * (to - from).norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outer_layer_is_put_over_an_inner_one() {
        let axes = Axes::of_cylinder([0.1, 0.1]);
        let wall = |z: f64| [[-1.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.5, z]].map(Vec3::from);
        let mut nodes: Vec<Vec3> =
            wall(0.3).into_iter().chain([[0.0, 0.5, 0.25], [0.0, 0.5, -0.25]].map(Vec3::from)).collect();
        put_outside(&mut nodes, &[[0, 1, 2]], &[0, 0, 0, 1, 1], &axes);
        assert!((nodes[3] - Vec3::new(0.0, 0.5, 0.3 + PLY)).norm() < 1e-9, "{:?}", nodes[3]);
        assert!((nodes[4] - Vec3::new(0.0, 0.5, -0.25)).norm() < 1e-9, "nothing lies there");
    }
}
