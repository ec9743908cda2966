//! Plies that pass through one another are moved apart, each to its own side.
//!
//! Cloth that is laid on other cloth follows its particles. Where that is bent sharply between them, the edges of the
//! two pass through each other. Here it is known which of them lies over the other, so that they can be moved apart.

use crate::contact::{ClothDetector, Neighbourhood, Tangle};
use crate::geometry::Vec3;
use crate::mesh::ClothMesh;
use crate::sew::Stitching;

/// Rounds of moving plies apart.
const ROUNDS: usize = 100;
/// A round moves a particle by this at most, metres.
const STEP: f64 = 2e-3;
/// Plies that have passed through one another are moved this far apart, metres.
const APART: f64 = 1e-3;
/// Cloth whose heights differ by less than this, metres, is one ply.
const SAME: f64 = 1e-6;

/// How a particle lies over the surface that is worn.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ply {
    /// The unit direction out of the right side of the surface.
    pub(super) outward: Vec3,
    /// How far out of the surface it is laid, metres; negative towards the body.
    pub(super) height: f64,
}

impl Ply {
    /// The mean over these particles.
    fn mean(plies: &[Self], of: &[u32]) -> Self {
        let share = 1.0 / of.len() as f64;
        let own = || of.iter().map(|n| plies[*n as usize]);
        let height = own().map(|ply| ply.height * share).sum();
        Self { outward: own().map(|ply| ply.outward * share).sum(), height }
    }
}

/// Moves plies apart that pass through one another, the higher outwards and the lower inwards. If some still pass
/// through one another after [`ROUNDS`], they are left where that was the least.
pub(super) fn clear(mesh: &ClothMesh, plies: &[Ply], x: &mut [Vec3]) {
    move_clear(&mut detector(mesh), plies, x);
}

/// The same with what `detector` finds.
fn move_clear(detector: &mut ClothDetector, plies: &[Ply], x: &mut [Vec3]) {
    let mut now = x.to_vec();
    let mut least = usize::MAX;
    for _ in 0..=ROUNDS {
        let tangles = detector.tangles(&now);
        if tangles.len() < least {
            least = tangles.len();
            x.copy_from_slice(&now);
        }
        let pushes: Vec<Push> = tangles.iter().filter_map(|tangle| Push::of(tangle, plies, &now)).collect();
        if pushes.is_empty() {
            return;
        }
        move_apart(&pushes, &mut now);
    }
}

/// Finds what passes through what.
fn detector(mesh: &ClothMesh) -> ClothDetector {
    let flat: Vec<_> = mesh.triangles.iter().map(|t| t.map(|p| mesh.flat[p as usize])).collect();
    let piece: Vec<u32> = mesh.triangles.iter().map(|t| mesh.piece_of(t[0]).unwrap_or(0) as u32).collect();
    let hood = Neighbourhood { class: Stitching::new(mesh).class, passing: Vec::new() };
    ClothDetector::new(&mesh.triangles, &flat, &piece, hood)
}

/// How an edge and a triangle of two plies are moved apart.
struct Push {
    /// Ends of the edge that are on the wrong side of the triangle, and how far each is to move, metres.
    ends: Vec<(u32, Vec3)>,
    triangle: ([u32; 3], Vec3),
}

impl Push {
    /// `None` where neither lies over the other.
    fn of(tangle: &Tangle, plies: &[Ply], x: &[Vec3]) -> Option<Self> {
        let [edge, triangle] = [Ply::mean(plies, &tangle.edge), Ply::mean(plies, &tangle.triangle)];
        // Two plies of one wall lie in the order of their heights. Of two walls that face each other, those inside (of
        // a flattened cuff) move outwards and those outside inwards.
        let (way, order) = if edge.outward.dot(&triangle.outward) > 0.0 {
            (edge.outward + triangle.outward, edge.height - triangle.height)
        } else {
            (edge.outward - triangle.outward, -edge.height - triangle.height)
        };
        if order.abs() < SAME {
            return None;
        }
        let outward = way.try_normalize(0.0)? * order.signum();
        let [a, b, c] = tangle.triangle.map(|n| x[n as usize]);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        let normal = normal * normal.dot(&outward).signum();
        let depth = |n: u32| APART - (x[n as usize] - a).dot(&normal);
        let way = |n: u32| outward * (0.5 * depth(n).min(2.0 * STEP));
        let wrong = tangle.edge.into_iter().filter(|n| depth(*n) > 0.0);
        let ends: Vec<(u32, Vec3)> = wrong.map(|n| (n, way(n))).collect();
        let deepest = ends.iter().map(|end| end.1).max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
        Some(Self { ends, triangle: (tangle.triangle, -deepest) })
    }
}

/// Moves every particle by the mean of what pushes it.
fn move_apart(pushes: &[Push], x: &mut [Vec3]) {
    let mut sum = vec![(Vec3::zeros(), 0.0); x.len()];
    let mut push = |n: u32, way: Vec3| {
        sum[n as usize].0 += way;
        sum[n as usize].1 += 1.0;
    };
    for of in pushes {
        of.ends.iter().for_each(|(n, way)| push(*n, *way));
        of.triangle.0.iter().for_each(|n| push(*n, of.triangle.1));
    }
    for (x, (way, count)) in x.iter_mut().zip(sum) {
        *x += way / f64::max(count, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec2;

    /// Two triangles, each its own piece: one in the plane z = 0, and one over it of which a corner hangs through.
    fn crossing() -> (ClothDetector, Vec<Vec3>) {
        let corners = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]];
        let above = [[0.02, 0.02, -0.003], [0.12, 0.02, 0.004], [0.02, 0.12, 0.004]];
        let x: Vec<Vec3> = corners.into_iter().chain(above).map(Vec3::from).collect();
        let flat: Vec<[Vec2; 3]> = [0, 3].map(|first| [0, 1, 2].map(|k| x[first + k].xy())).to_vec();
        let hood = Neighbourhood { class: (0..6).collect(), passing: Vec::new() };
        (ClothDetector::new(&[[0, 1, 2], [3, 4, 5]], &flat, &[0, 1], hood), x)
    }

    fn plies(outward: [Vec3; 2], height: [f64; 2]) -> Vec<Ply> {
        (0..6).map(|n| Ply { outward: outward[n / 3], height: height[n / 3] }).collect()
    }

    #[test]
    fn the_higher_ply_comes_out_on_its_side() {
        for (height, sign) in [([0.0, 0.008], 1.0), ([0.0, -0.008], -1.0)] {
            let (mut detector, mut x) = crossing();
            move_clear(&mut detector, &plies([Vec3::z(); 2], height), &mut x);
            assert!(detector.tangles(&x).is_empty());
            assert!((x[3].z - x[0].z) * sign > 0.0, "{height:?}: {x:?}");
        }
    }

    #[test]
    fn inner_plies_of_two_walls_that_face_each_other_go_back_to_their_own_walls() {
        // The lower wall's outer side looks down, that of the upper one up.
        let (mut detector, mut x) = crossing();
        move_clear(&mut detector, &plies([-Vec3::z(), Vec3::z()], [-0.008; 2]), &mut x);
        assert!(detector.tangles(&x).is_empty());
        assert!(x[3].z > x[0].z, "{x:?}");
    }

    #[test]
    fn one_ply_stays_as_it_is() {
        let (mut detector, mut x) = crossing();
        let before = x.clone();
        move_clear(&mut detector, &plies([Vec3::z(); 2], [0.0; 2]), &mut x);
        assert_eq!(x, before);
    }
}
