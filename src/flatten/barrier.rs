//! Rims that push each other away before they meet, so that no piece lies on itself.
//!
//! A piece without flipped triangles lies on itself nowhere as long as no two sides of its rims cross (Smith & Schaefer
//! 2015, section 3.2). A vertex of a rim that comes within reach of another side is pushed off by
//! b(x) = −(1 − x)² ln x, where x is the distance as a share of the reach (Li et al. 2020, "Incremental potential
//! contact", equation 6): nothing at the end of the reach, and no end where they meet.

use super::overlap::{crossing, near};
use super::spring::{Elastic, LengthSpring};
use crate::geometry::{Vec2, nearest_on_segment};

/// Distance at which rims begin to push, metres: twice what a person can see or cut.
const REACH: f64 = 0.5e-3;
/// Places of one rim that are nearer along it than so many reaches do not push each other: at a corner they are near.
const BETWEEN: f64 = 8.0;

/// The rims of a piece, prepared.
#[derive(Clone, Debug)]
pub(super) struct Barrier {
    /// Of all rims.
    sides: Vec<[u32; 2]>,
    /// Which rim a side is of, how far along it begins, its length at the start, and the length of the whole rim.
    places: Vec<(usize, [f64; 3])>,
}

/// A vertex that is pushed by a side.
struct SidePush {
    /// As the line from the side's nearest point to the vertex; its stiffness is that of the push.
    line: LengthSpring,
    /// Its energy, m².
    energy: f64,
    /// The derivative of that by the distance, m.
    slope: f64,
}

impl Barrier {
    /// Of a piece at its start; `None` where its rims cross already.
    pub(super) fn new(rims: &[Vec<u32>], flat: &[Vec2]) -> Option<Self> {
        let (mut sides, mut places) = (Vec::new(), Vec::new());
        for (r, rim) in rims.iter().enumerate() {
            let ends = |k: usize| [rim[k], rim[(k + 1) % rim.len()]];
            let lengths: Vec<f64> = (0..rim.len()).map(|k| length(flat, ends(k))).collect();
            let whole: f64 = lengths.iter().sum();
            let mut at = 0.0;
            for (k, length) in lengths.into_iter().enumerate() {
                sides.push(ends(k));
                places.push((r, [at, length, whole]));
                at += length;
            }
        }
        let barrier = Self { sides, places };
        barrier.energy(flat).is_finite().then_some(barrier)
    }

    /// The energy of all pushes, m²; infinite where rims cross.
    pub(super) fn energy(&self, flat: &[Vec2]) -> f64 {
        let at = self.at(flat);
        let pairs = self.near(&at);
        if pairs.iter().any(|&[i, j]| crossing(at[i], at[j]).is_some()) {
            return f64::INFINITY;
        }
        self.pushes_of(&at, &pairs).iter().map(|push| push.energy).sum()
    }

    /// Adds the derivative of the energy by every position times a factor.
    pub(super) fn add_gradient(&self, flat: &[Vec2], factor: f64, out: &mut [Vec2]) {
        for push in self.pushes(flat) {
            let force = push.line.along(flat).try_normalize(0.0).unwrap_or_default() * (push.slope * factor);
            for (v, share) in push.line.nodes.into_iter().zip(push.line.shares) {
                out[v as usize] += force * share;
            }
        }
    }

    /// The lines along which there are pushes now, with their stiffness.
    pub(super) fn lines(&self, flat: &[Vec2]) -> Vec<LengthSpring> {
        self.pushes(flat).into_iter().map(|push| push.line).collect()
    }

    fn pushes(&self, flat: &[Vec2]) -> Vec<SidePush> {
        let at = self.at(flat);
        self.pushes_of(&at, &self.near(&at))
    }

    /// The ends of all sides.
    fn at(&self, flat: &[Vec2]) -> Vec<[Vec2; 2]> {
        self.sides.iter().map(|ends| ends.map(|v| flat[v as usize])).collect()
    }

    /// Pairs of sides without a common end that may be within reach of each other.
    fn near(&self, at: &[[Vec2; 2]]) -> Vec<[usize; 2]> {
        let longest = at.iter().map(|[a, b]| (b - a).norm()).fold(0.0, f64::max);
        let apart = |[i, j]: &[usize; 2]| self.sides[*i].iter().all(|v| !self.sides[*j].contains(v));
        near(at, longest, REACH).into_iter().map(|(i, j)| [i as usize, j as usize]).filter(apart).collect()
    }

    /// Every vertex begins one side.
    fn pushes_of(&self, at: &[[Vec2; 2]], pairs: &[[usize; 2]]) -> Vec<SidePush> {
        let both = pairs.iter().flat_map(|&[i, j]| [[i, j], [j, i]]);
        both.filter(|&[i, j]| !self.is_beside(i, j)).filter_map(|[i, j]| self.push(at, i, j)).collect()
    }

    /// Whether the beginning of a side is near another one along their rim.
    fn is_beside(&self, vertex: usize, side: usize) -> bool {
        let ((rim, [at, _, whole]), (other, [from, length, _])) = (self.places[vertex], self.places[side]);
        let behind = (at - from).rem_euclid(whole);
        rim == other && (behind < length + BETWEEN * REACH || whole - behind < BETWEEN * REACH)
    }

    /// How the beginning of side `i` is pushed by side `j`.
    fn push(&self, at: &[[Vec2; 2]], i: usize, j: usize) -> Option<SidePush> {
        let (share, distance) = nearest_on_segment(at[i][0], at[j]);
        let x = distance / REACH;
        if x >= 1.0 {
            return None;
        }
        let (log, gap) = (x.ln(), 1.0 - x);
        let ([v, _], [a, b]) = (self.sides[i], self.sides[j]);
        let weight = self.places[i].1[1] * REACH;
        let bend = -2.0 * log + 4.0 * gap / x + (gap / x).powi(2);
        // A spring's stiffness is twice its weight over its target's square.
        let elastic = Elastic { target: REACH, weight: 0.5 * weight * bend, pull: 0.0 };
        Some(SidePush {
            line: LengthSpring { nodes: [v, a, b], shares: [1.0, share - 1.0, -share], elastic },
            energy: -weight * gap * gap * log,
            slope: weight / REACH * (2.0 * gap * log - gap * gap / x),
        })
    }
}

fn length(flat: &[Vec2], ends: [u32; 2]) -> f64 {
    let [a, b] = ends.map(|v| flat[v as usize]);
    (b - a).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-9;

    /// A square of 4 cm with a slot from above that is `wide` at its mouth and closed at its bottom.
    fn slotted(wide: f64) -> (Vec<Vec2>, Vec<Vec<u32>>) {
        let corners =
            [[0.0, 0.0], [0.04, 0.0], [0.04, 0.04], [0.02 + wide, 0.04], [0.022, 0.01], [0.02, 0.04], [0.0, 0.04]];
        (corners.map(|[x, y]| Vec2::new(x, y)).into(), vec![(0..7).collect()])
    }

    #[test]
    fn rims_push_before_they_meet_and_never_cross() {
        let (flat, rims) = slotted(4e-4);
        let barrier = Barrier::new(&rims, &flat).expect("it does not cross");
        let (far, _) = slotted(6e-4);
        let (crossing, _) = slotted(-1e-4);
        assert!(barrier.energy(&flat) > 0.0 && barrier.energy(&far) == 0.0);
        assert_eq!(barrier.energy(&crossing), f64::INFINITY);
        assert!(Barrier::new(&rims, &crossing).is_none());
        // The nearer, the more, without end.
        let energies: Vec<f64> = [4e-4, 1e-4, 1e-6, 1e-9].map(|wide| barrier.energy(&slotted(wide).0)).into();
        assert!(energies.is_sorted() && energies[3] > 10.0 * energies[0], "{energies:?}");
    }

    #[test]
    fn the_gradient_is_the_derivative_of_the_energy_and_the_lines_know_its_curvature() {
        let (flat, rims) = slotted(2e-4);
        let barrier = Barrier::new(&rims, &flat).expect("it does not cross");
        let gradient = |flat: &[Vec2]| {
            let mut out = vec![Vec2::zeros(); flat.len()];
            barrier.add_gradient(flat, 1.0, &mut out);
            out
        };
        let at = gradient(&flat);
        for (v, k) in (0..flat.len()).flat_map(|v| [(v, 0), (v, 1)]) {
            let moved = |by: f64| {
                let mut moved = flat.clone();
                moved[v][k] += by;
                moved
            };
            let numeric = (barrier.energy(&moved(STEP)) - barrier.energy(&moved(-STEP))) / (2.0 * STEP);
            assert!((numeric - at[v][k]).abs() < 1e-5 * at[3].norm(), "{v} {k}: {numeric} {}", at[v][k]);
        }
        // Across the slot, where both corners of its mouth are pushed by the sides beyond.
        let mut wider = flat.clone();
        wider[3].x += STEP;
        let numeric = (gradient(&wider)[3].x - at[3].x) / STEP;
        let lines = barrier.lines(&flat);
        let share = |s: &LengthSpring| {
            let k = s.nodes.iter().position(|&v| v == 3).unwrap_or(0);
            s.elastic.stiffness() * (s.along(&flat).normalize().x * s.shares[k]).powi(2)
        };
        let sum: f64 = lines.iter().map(share).sum();
        assert!(lines.len() == 3 && (numeric / sum - 1.0).abs() < 0.05, "{numeric} {sum}");
    }
}
