//! The openings of a garment as circles on the sphere of directions from a point within it.

use std::f64::consts::TAU;

use super::ends::Ends;
use super::harmonic::OpeningRing;
use crate::geometry::Vec3;
use nalgebra::Rotation3;

/// Circles fill at most this share of the angle between their middles: the cloth between two of them needs room.
const FILLED: f64 = 0.8;
/// No circle is wider than this, radians from its middle: just below a half sphere.
const WIDEST: f64 = 1.3;
/// The direction out of an opening counts as much as this share of the mean direction to it. An opening round the
/// point itself has no other direction.
const OUTWARD: f64 = 0.2;
/// A ring is seen through so many points.
const POINTS: usize = 12;

/// An opening that the body leaves the garment by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mouth<'a> {
    /// Its rim, round the body.
    pub(super) ring: &'a OpeningRing,
    /// The ends of the body that leave by it.
    pub(super) ends: Ends,
}

/// A circle on the sphere of directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    /// Unit direction.
    pub(super) middle: Vec3,
    /// From its middle to its rim, radians.
    pub(super) width: f64,
    /// From the point to the ring, metres.
    pub(super) far: f64,
}

impl Mouth<'_> {
    /// The circle that its ring looks like from a point.
    fn seen_from(&self, point: Vec3) -> Circle {
        let ring = self.ring;
        let at = |k: usize| ring.center + ring.way(k as f64 * TAU / POINTS as f64) * ring.radius - point;
        let mean = |value: &dyn Fn(usize) -> f64| (0..POINTS).map(value).sum::<f64>() / POINTS as f64;
        let direction = |k: usize| at(k).try_normalize(0.0).unwrap_or_else(|| ring.out());
        let sum = (0..POINTS).map(direction).sum::<Vec3>() / POINTS as f64;
        let middle = (sum + ring.out() * OUTWARD).try_normalize(0.0).unwrap_or_else(|| ring.out());
        Circle { middle, width: mean(&|k| direction(k).angle(&middle)), far: mean(&|k| at(k).norm()) }
    }

    /// The nodes of the rim on a circle, and their directions.
    pub(super) fn on(&self, circle: Circle) -> impl Iterator<Item = (usize, Vec3)> {
        // Two opposite directions have no smallest rotation.
        let half_turn = || Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(self.ring.frame[0]), TAU / 2.0);
        let turn = Rotation3::rotation_between(&self.ring.out(), &circle.middle).unwrap_or_else(half_turn);
        let direction =
            move |angle: &f64| circle.middle * circle.width.cos() + turn * self.ring.way(*angle) * circle.width.sin();
        self.ring.rim.iter().map(|n| *n as usize).zip(self.ring.angles.iter().map(direction))
    }
}

/// The circles of the mouths as seen from a point, narrow enough to lie beside one another.
pub(super) fn circles(mouths: &[Mouth], point: Vec3) -> Vec<Circle> {
    let mut circles: Vec<Circle> = mouths.iter().map(|mouth| mouth.seen_from(point)).collect();
    let fits = |a: &Circle, b: &Circle| FILLED * a.middle.angle(&b.middle) / (a.width + b.width);
    let others = |i: usize| (0..circles.len()).filter(move |j| *j != i);
    let share = |i: usize| others(i).map(|j| fits(&circles[i], &circles[j])).fold(1.0, f64::min);
    let shares: Vec<f64> = (0..circles.len()).map(share).collect();
    for (circle, share) in circles.iter_mut().zip(shares) {
        circle.width = (circle.width * share).min(WIDEST);
    }
    circles
}

/// The least angle between two mouths as seen from a point, radians; negative where they overlap.
pub(super) fn room(mouths: &[Mouth], point: Vec3) -> f64 {
    let circles: Vec<Circle> = mouths.iter().map(|mouth| mouth.seen_from(point)).collect();
    let pairs = circles.iter().enumerate().flat_map(|(i, a)| circles[..i].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| a.middle.angle(&b.middle) - a.width - b.width).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(y: f64, out: f64, radius: f64) -> OpeningRing {
        OpeningRing {
            rim: (0..4).collect(),
            angles: (0..4).map(|k| f64::from(k) * TAU / 4.0).collect(),
            frame: [Vec3::z(), Vec3::x() * out],
            center: Vec3::new(0.0, y, 0.0),
            radius,
            along: None,
            saddle: 0.0,
        }
    }

    #[test]
    fn a_ring_straight_ahead_is_a_circle_of_its_angle() {
        let ring = ring(1.0, 1.0, 0.5);
        let circle = Mouth { ring: &ring, ends: Ends::HEAD }.seen_from(Vec3::zeros());
        assert!((circle.middle - Vec3::y()).norm() < 1e-12);
        assert!((circle.width - 0.5f64.atan()).abs() < 1e-12);
        assert!((circle.far - 1.25f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn rims_lie_on_their_circles() {
        let ring = ring(1.0, 1.0, 0.5);
        let mouth = Mouth { ring: &ring, ends: Ends::HEAD };
        for middle in [Vec3::y(), Vec3::x(), -Vec3::y()] {
            for (_, direction) in mouth.on(Circle { middle, width: 0.3, far: 1.0 }) {
                assert!((direction.angle(&middle) - 0.3).abs() < 1e-9, "{middle:?}");
            }
        }
    }

    #[test]
    fn circles_that_would_overlap_become_narrower() {
        let (up, down) = (ring(0.1, 1.0, 1.0), ring(-0.1, -1.0, 1.0));
        let mouths = [Mouth { ring: &up, ends: Ends::HEAD }, Mouth { ring: &down, ends: Ends::LEGS }];
        assert!(room(&mouths, Vec3::zeros()) < 0.5);
        let [a, b] = circles(&mouths, Vec3::zeros())[..] else { panic!("two circles") };
        assert!(a.width + b.width < FILLED * a.middle.angle(&b.middle) + 1e-12);
    }
}
