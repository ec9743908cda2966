//! Straps turn their right side away from the body: nothing else untwists cloth that is not inflated.

use super::axes::Axes;
use crate::geometry::Vec3;

/// A strap turns by this share of the angle between its right side and the way out in one step. Motion lives on for
/// ten steps, so that twice as much turns it too far.
const TURN: f64 = 0.05;

/// Ways of the nodes that turn every one of the `triangles`, which are clockwise seen from outside, towards the way out
/// of the `axes`, by its `share`, 0 to 1.
pub(super) fn turned(x: &[Vec3], triangles: &[[u32; 3]], share: &[f64], axes: &Axes) -> Vec<Vec3> {
    let mut sums = vec![(Vec3::zeros(), 0.0); x.len()];
    for (t, share) in triangles.iter().zip(share).filter(|(_, share)| **share > 0.0) {
        let [a, b, c] = t.map(|n| x[n as usize]);
        let middle = (a + b + c) / 3.0;
        let Some(turn) = axes.middle(middle).and_then(|from| turn((c - a).cross(&(b - a)), middle - from)) else {
            continue;
        };
        for n in t {
            let (sum, count) = &mut sums[*n as usize];
            *sum += turn.cross(&(x[*n as usize] - middle)) * (TURN * share);
            *count += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect()
}

/// The smallest rotation from one direction to another, as a vector along its axis, radians.
fn turn(from: Vec3, to: Vec3) -> Option<Vec3> {
    let axis = from.cross(&to);
    Some(axis.try_normalize(1e-12)? * axis.norm().atan2(from.dot(&to)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_turns_until_it_faces_outward() {
        // Faces sideways at first, and stays where it is.
        let mut x = [[0.2, 0.5, 0.0], [0.2, 0.52, 0.0], [0.22, 0.5, 0.0]].map(Vec3::from).to_vec();
        let normal = |x: &[Vec3]| (x[2] - x[0]).cross(&(x[1] - x[0])).normalize();
        assert!(normal(&x).x.abs() < 1e-12);
        for _ in 0..200 {
            let way = turned(&x, &[[0, 1, 2]], &[1.0], &Axes::of_cylinder([0.1, 0.1]));
            assert!(way.iter().sum::<Vec3>().norm() < 1e-12);
            x.iter_mut().zip(way).for_each(|(x, way)| *x += way);
        }
        assert!(normal(&x).x > 0.99, "{:?}", normal(&x));
    }

    #[test]
    fn what_is_inflated_is_not_turned() {
        let x = [[0.2, 0.5, 0.0], [0.2, 0.52, 0.0], [0.22, 0.5, 0.0]].map(Vec3::from);
        assert!(
            turned(&x, &[[0, 1, 2]], &[0.0], &Axes::of_cylinder([0.1, 0.1])).iter().all(|way| *way == Vec3::zeros())
        );
    }
}
