//! The glued garment as a soap film between its openings: one Laplace equation says where every node starts.
//!
//! With positive weights the film lies between its rims like a net of rubber bands, so it winds round the axes of the
//! body as its openings do. Left alone it shrinks to the axes between two distant rings; so the distance from the axis
//! is interpolated as a field of its own, and the film gives only the direction.

use std::sync::Arc;

use super::axes::Axis;
use super::balloon::Length;
use super::winding::Jumps;
use crate::geometry::Vec3;
use crate::linear::{Cholesky, Slot, SymmetricMatrix, SymmetricPattern};

/// Edges count as no shorter than this, metres, in the weights of the film.
const SHORTEST: f64 = 1e-3;
/// Added to the diagonal, for parts of the film that touch no ring.
const RIDGE: f64 = 1e-9;
/// Where the film is nearer to its axis than the first share of its radius its direction is not known; from the second
/// on it is taken as it is.
const VAGUE: f64 = 0.15;
const CLEAR: f64 = 0.5;
/// From its start to so far along it, metres, a limb takes over from the trunk.
const HANDOVER: f64 = 0.1;

/// An opening as a ring round an axis.
#[derive(Clone, Debug)]
pub(super) struct OpeningRing {
    /// The nodes of the rim.
    pub(super) rim: Vec<u32>,
    /// How far round the ring each is, radians: rising, by less than a full turn in all.
    pub(super) angles: Vec<f64>,
    /// Unit vectors from the middle to the angle 0 and to a quarter of a turn.
    pub(super) frame: [Vec3; 2],
    /// The middle of the ring.
    pub(super) center: Vec3,
    /// Metres.
    pub(super) radius: f64,
    /// Of a ring round an arm or a leg: how far along the limb's axis it is, metres.
    pub(super) along: Option<f64>,
    /// How far the ring lies before its plane at the angle 0 and opposite, and behind it in between, metres.
    pub(super) saddle: f64,
}

impl OpeningRing {
    /// The direction from the middle at this angle, radians.
    pub(super) fn way(&self, angle: f64) -> Vec3 {
        self.frame[0] * angle.cos() + self.frame[1] * angle.sin()
    }

    /// Unit direction of the way out of the ring.
    pub(super) fn out(&self) -> Vec3 {
        self.frame[0].cross(&self.frame[1])
    }

    /// The nodes of the rim and their places, metres.
    fn places(&self) -> impl Iterator<Item = (usize, Vec3)> {
        let place = move |angle: &f64| {
            self.center + self.way(*angle) * self.radius + self.out() * (self.saddle * (2.0 * angle).cos())
        };
        self.rim.iter().map(|n| *n as usize).zip(self.angles.iter().map(place))
    }
}

/// A limb that an opening is round.
pub(super) struct Limb<'a> {
    /// Number of the ring.
    pub(super) ring: usize,
    /// Its axis.
    pub(super) axis: &'a Axis,
    /// Distance on the cloth of every node from the ring, metres.
    pub(super) distance: &'a [f64],
    /// The same from the ring round the other limb of the pair, if there is one.
    pub(super) other: Option<&'a [f64]>,
    /// The angle of every node round the limb, radians, as on its ring.
    pub(super) angles: Vec<f64>,
}

/// Laplace's equation on a glued surface, with the nodes of its rings given.
pub(super) struct Film<'a> {
    edges: &'a [Length],
    /// Row of the free nodes.
    row: Vec<Option<u32>>,
    factor: Cholesky<f64>,
}

impl<'a> Film<'a> {
    /// Prepares the equation for `count` nodes joined by `edges` of which those of the `rings` are given. `None` when
    /// nothing is free, or the system cannot be factored.
    pub(super) fn new(count: usize, edges: &'a [Length], rings: &[OpeningRing]) -> Option<Self> {
        let mut row: Vec<Option<u32>> = vec![Some(0); count];
        rings.iter().flat_map(|ring| &ring.rim).for_each(|n| row[*n as usize] = None);
        let mut free = 0;
        for slot in row.iter_mut().flatten() {
            *slot = free;
            free += 1;
        }
        let rows = |l: &Length| l.ends.map(|n| row[n as usize]);
        let pairs = edges.iter().filter_map(|l| match rows(l) {
            [Some(a), Some(b)] => Some((a as usize, b as usize)),
            _ => None,
        });
        let pattern = Arc::new(SymmetricPattern::scalar(free as usize, pairs).ok()?);
        let slot = |a: u32, b: u32| pattern.slot(a as usize, b as usize);
        let diagonal: Vec<Slot> = (0..free).map(|n| slot(n, n)).collect::<Option<_>>()?;
        let mut matrix = SymmetricMatrix::<f64>::zeros(pattern.clone());
        diagonal.iter().for_each(|d| matrix.add(*d, RIDGE));
        for length in edges {
            let ends = rows(length);
            ends.iter().flatten().for_each(|n| matrix.add(diagonal[*n as usize], weight(length)));
            if let [Some(a), Some(b)] = ends {
                matrix.add(slot(a, b)?, -weight(length));
            }
        }
        let mut factor = Cholesky::new(pattern.clone()).ok()?;
        factor.factor(&matrix).ok()?;
        Some(Self { edges, row, factor })
    }

    /// The field that takes these values at the nodes that are given.
    pub(super) fn spread(&self, given: &[f64]) -> Vec<f64> {
        self.spread_with(given, &Jumps::new())
    }

    /// The same for a field that jumps across some edges.
    fn spread_with(&self, given: &[f64], jumps: &Jumps) -> Vec<f64> {
        let mut right = vec![0.0; self.row.iter().flatten().count()];
        for length in self.edges {
            let [a, b] = length.ends.map(|n| n as usize);
            if let Some(jump) = jumps.get(&length.ends) {
                self.row[a].iter().for_each(|row| right[*row as usize] -= weight(length) * jump);
                self.row[b].iter().for_each(|row| right[*row as usize] += weight(length) * jump);
            }
            match [self.row[a], self.row[b]] {
                [Some(row), None] => right[row as usize] += weight(length) * given[b],
                [None, Some(row)] => right[row as usize] += weight(length) * given[a],
                _ => {}
            }
        }
        self.factor.solve_f64(&mut right);
        self.row.iter().zip(given).map(|(row, given)| row.map_or(*given, |row| right[row as usize])).collect()
    }

    /// The inverse of the equation's matrix times vectors at the free nodes; zero at those that are given.
    pub(super) fn inverse(&self, of: &[Vec3]) -> Vec<Vec3> {
        let mut out = vec![Vec3::zeros(); of.len()];
        let count = self.row.iter().flatten().count();
        for c in 0..3 {
            let mut right = vec![0.0; count];
            self.row.iter().zip(of).for_each(|(row, v)| row.iter().for_each(|r| right[*r as usize] = v[c]));
            self.factor.solve_f64(&mut right);
            self.row.iter().zip(&mut out).for_each(|(row, v)| row.iter().for_each(|r| v[c] = right[*r as usize]));
        }
        out
    }

    /// The same for points in space.
    pub(super) fn spread_points(&self, given: &[Vec3]) -> Vec<Vec3> {
        let [x, y, z] = [0, 1, 2].map(|c| self.spread(&given.iter().map(|p| p[c]).collect::<Vec<_>>()));
        (0..given.len()).map(|n| Vec3::new(x[n], y[n], z[n])).collect()
    }

    /// Where every node starts between the `rings`, along the `limbs` at the distance on the cloth from their rings.
    pub(super) fn start(&self, rings: &[OpeningRing], limbs: &[Limb]) -> Vec<Vec3> {
        let count = self.row.len();
        let mut places = vec![Vec3::zeros(); count];
        let mut centers = places.clone();
        let mut radii = vec![0.0; count];
        for ring in rings {
            for (n, place) in ring.places() {
                places[n] = place;
                centers[n] = ring.center;
                radii[n] = ring.radius;
            }
        }
        let radii = self.spread(&radii);
        let mut x = rounded(&self.spread_points(&places), &self.spread_points(&centers), &radii);
        for limb in limbs {
            self.wind(&mut x, &rings[limb.ring], limb, &radii);
        }
        for (n, place) in rings.iter().flat_map(OpeningRing::places) {
            x[n] = place;
        }
        x
    }

    /// Winds what belongs to a limb round its axis, as far from the ring along it as on the cloth.
    fn wind(&self, x: &mut [Vec3], ring: &OpeningRing, limb: &Limb, radii: &[f64]) {
        let Some(along) = ring.along else { return };
        for (n, x) in x.iter_mut().enumerate() {
            let s = along - limb.distance[n];
            let is_own = limb.other.is_none_or(|other| limb.distance[n] < other[n]);
            if s <= 0.0 || !is_own {
                continue;
            }
            let station = limb.axis.station(s);
            let way = ring.way(limb.angles[n]);
            let off = way - station.axis * way.dot(&station.axis);
            let Some(way) = off.try_normalize(1e-12) else { continue };
            let on_limb = station.center + way * (0.5 * (ring.radius + radii[n]));
            *x += (on_limb - *x) * smooth(s / HANDOVER);
        }
    }
}

/// The angle of every node round the axis of a ring: given on its rim, free everywhere else. `None` where the system
/// cannot be factored.
pub(super) fn angles(count: usize, edges: &[Length], ring: &OpeningRing, jumps: &Jumps) -> Option<Vec<f64>> {
    let mut given = vec![0.0; count];
    ring.rim.iter().zip(&ring.angles).for_each(|(n, angle)| given[*n as usize] = *angle);
    Some(Film::new(count, edges, std::slice::from_ref(ring))?.spread_with(&given, jumps))
}

/// Every point of the film at its radius from the middle of its section, in the direction that the film gives.
fn rounded(film: &[Vec3], centers: &[Vec3], radii: &[f64]) -> Vec<Vec3> {
    let out = |((x, center), radius): ((&Vec3, &Vec3), &f64)| {
        let off = x - center;
        let far = off.norm();
        let clear = smooth((far / radius.max(1e-9) - VAGUE) / (CLEAR - VAGUE));
        x + (off * (radius / far.max(1e-9)) - off) * clear
    };
    film.iter().zip(centers).zip(radii).map(out).collect()
}

/// 0 up to 0, 1 from 1 on, smooth between them.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The weight of an edge in the film, 1/m.
fn weight(length: &Length) -> f64 {
    1.0 / length.rest.max(SHORTEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tube of rings of `around` nodes, 50 mm apart.
    fn tube(rings: u32, around: u32) -> Vec<Length> {
        let node = |r: u32, k: u32| r * around + k % around;
        let mut out = Vec::new();
        for r in 0..rings {
            for k in 0..around {
                out.push(Length { ends: [node(r, k), node(r, k + 1)], rest: 0.05 });
                if r + 1 < rings {
                    out.push(Length { ends: [node(r, k), node(r + 1, k)], rest: 0.05 });
                }
            }
        }
        out
    }

    fn ring(first: u32, around: u32, y: f64) -> OpeningRing {
        let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(around);
        OpeningRing {
            rim: (first..first + around).collect(),
            angles: (0..around).map(angle).collect(),
            frame: [Vec3::x(), Vec3::z()],
            center: Vec3::new(0.0, y, 0.0),
            radius: 0.1,
            along: None,
            saddle: 0.0,
        }
    }

    #[test]
    fn a_tube_between_two_equal_rings_is_nearly_a_cylinder() {
        let (around, rows) = (12, 7);
        let edges = tube(rows, around);
        let rings = [ring(0, around, 0.3), ring((rows - 1) * around, around, 0.0)];
        let film = Film::new((rows * around) as usize, &edges, &rings).expect("a film");
        for (n, x) in film.start(&rings, &[]).iter().enumerate() {
            let height = 0.3 - 0.05 * f64::from(n as u32 / around);
            assert!((x.y - height).abs() < 1e-6, "{n}: {x:?}");
            // The film alone has a waist of 42 mm: 100 mm over the hyperbolic cosine of three rows.
            let radius = x.x.hypot(x.z);
            assert!((0.09..0.1001).contains(&radius), "{n}: {radius}");
        }
    }
}
