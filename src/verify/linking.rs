//! Linking number of a line and a loop.

use std::f64::consts::PI;

use crate::geometry::Vec3;

/// Gauss's linking integral of a closed polygon with an open polyline: the share of a full turn by which the line
/// passes through the loop. For a line whose two ends are far away compared with the loop it is an integer, nearly.
///
/// It has no special cases: nothing is intersected, so nothing can be hit edge on.
pub(super) fn linking(ring: &[Vec3], line: &[Vec3]) -> f64 {
    let sides = (0..ring.len()).map(|k| (&ring[k], &ring[(k + 1) % ring.len()]));
    let pairs = sides.flat_map(|(a, b)| line.windows(2).map(move |l| segment_share(a, b, &l[0], &l[1])));
    pairs.sum::<f64>() / (4.0 * PI)
}

/// Signed area, on the sphere of directions, that a point of `a b` seen from a point of `c d` sweeps: a quadrilateral
/// of four great arcs. Zero where the segments lie in one plane.
fn segment_share(a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3) -> f64 {
    let corners = [c - a, d - a, d - b, c - b];
    let turn = (b - a).cross(&(d - c)).dot(&corners[0]);
    if turn == 0.0 {
        return 0.0;
    }
    // Each arc's plane. The exterior angles between successive planes give the area.
    let planes = [0, 1, 2, 3].map(|k: usize| corners[k].cross(&corners[(k + 1) % 4]).normalize());
    if planes.iter().any(|n| !n.x.is_finite()) {
        return 0.0;
    }
    let area: f64 = (0..4).map(|k| planes[k].dot(&planes[(k + 1) % 4]).clamp(-1.0, 1.0).asin()).sum();
    area.abs() * turn.signum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle() -> Vec<Vec3> {
        (0..40).map(|k| (f64::from(k) * PI / 20.0).sin_cos()).map(|(s, c)| Vec3::new(s, 0.0, c)).collect()
    }

    #[test]
    fn a_line_through_beside_and_back() {
        let far = 1e4;
        let through = [Vec3::new(0.0, -far, 0.0), Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.0, far, 0.0)];
        let up = linking(&circle(), &through);
        approx::assert_relative_eq!(up.abs(), 1.0, epsilon = 1e-6);
        let down: Vec<Vec3> = through.iter().rev().copied().collect();
        approx::assert_relative_eq!(linking(&circle(), &down), -up, epsilon = 1e-9);
        let beside = through.map(|p| p + Vec3::new(2.0, 0.0, 0.0));
        approx::assert_relative_eq!(linking(&circle(), &beside), 0.0, epsilon = 1e-6);
        let back = [through[0], through[2], through[2] + Vec3::new(5.0, 0.0, 0.0), Vec3::new(5.0, -far, 0.0)];
        approx::assert_relative_eq!(linking(&circle(), &back), up, epsilon = 1e-3);
    }
}
