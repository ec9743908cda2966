//! Directions on the sphere that are moved until no triangle is turned over.
//!
//! The energy of a triangle grows steeply as its area falls to zero, and stays finite beyond, so that what is turned
//! over finds its way back (Garanzha, Kaporin, Kudryavtseva, Protais, Ray and Sokolov, Foldover-free maps in 50 lines
//! of code, 2021). How steeply is chosen anew in every round, from the triangle that is turned over most. Steps are
//! those of L-BFGS (Nocedal 1980) with the film's Laplacian as first guess of the second derivative.

use super::harmonic::Film;
use crate::geometry::{Vec2, Vec3};
use crate::linear::{Memory, dot};

/// Rounds at most.
const ROUNDS: usize = 40;
/// Steps of short rounds and of long ones. With 12 two drafted shirts never came unfolded; with 60 they do in five
/// rounds. Long rounds at once lead garments elsewhere that short ones unfold: a wrap dress took 79 s to sew for 28.
const SHORT: usize = 12;
const LONG: usize = 60;
/// After so many long rounds in which not fewer triangles are turned over than before, none will come back: of fourteen
/// garments, every one that came unfolded had fewer in each round.
const PATIENCE: usize = 3;
/// The energy is at least so steep: as where an area is this share of what it is to be.
const STEEPEST: f64 = 1e-4;
/// Share of the most turned over area that the energy is as steep as (equation 8 there, squared 0.04).
const BY_TURNED: f64 = 0.2;
/// Rounds without a fold go on until one lowers the energy by less than this share.
const SETTLED: f64 = 1e-3;
/// Pairs of steps and changes of the gradient that are remembered.
const MEMORY: usize = 8;
/// A step moves no direction by more than this, radians.
const LONGEST: f64 = 0.5;
/// Halvings before a line search gives up, and the share of the slope's promise that a step must keep (Armijo).
const HALVINGS: usize = 20;
const SUFFICIENT: f64 = 1e-4;
/// A triangle whose area is less than this share of the square of a side is left out: it has no shape to keep.
const NEEDLE: f64 = 1e-3;

/// How directions are unfolded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rounds {
    /// In rounds of a few steps.
    Short,
    /// In rounds of many steps, for what short ones do not unfold. Ends where no triangle comes back any more.
    Long,
}

impl Rounds {
    /// Steps in each.
    fn steps(self) -> usize {
        match self {
            Self::Short => SHORT,
            Self::Long => LONG,
        }
    }
}

/// A triangle as it is to lie on the unit sphere.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    /// Nodes, clockwise seen from outside.
    corners: [u32; 3],
    /// Columns of the inverse of the matrix of its first two sides, as they are to be.
    inverse: [Vec2; 2],
    /// Twice its area.
    area: f64,
    weight: f64,
}

impl Facet {
    /// A triangle that is to have the shape and size of these flat `corners`; `None` for a needle.
    pub(super) fn new(nodes: [u32; 3], corners: [Vec2; 3], weight: f64) -> Option<Self> {
        let [e, f] = [corners[1] - corners[0], corners[2] - corners[0]];
        let det = e.perp(&f);
        let is_needle = det.abs() <= NEEDLE * e.norm_squared().max(f.norm_squared());
        let inverse = [Vec2::new(f.y, -e.y) / det, Vec2::new(-f.x, e.x) / det];
        (!is_needle).then_some(Self { corners: nodes, inverse, area: det.abs(), weight })
    }

    /// Its area as a share of what it is to be; negative where it is turned over.
    fn share(&self, [a, b, c]: [Vec3; 3]) -> f64 {
        -a.dot(&b.cross(&c)) / self.area
    }
}

/// The energy of all facets: how they are stretched and how large they are, over a barrier.
struct Energy<'a> {
    facets: &'a [Facet],
    steepness: f64,
}

impl Energy<'_> {
    /// The value at directions of any length.
    fn value(&self, y: &[Vec3]) -> f64 {
        let p: Vec<Vec3> = y.iter().map(|y| y / y.norm()).collect();
        self.facets.iter().map(|facet| self.of(facet, facet.corners.map(|n| p[n as usize]), None)).sum()
    }

    /// The value, and its derivatives by the directions.
    fn gradient(&self, y: &[Vec3]) -> (f64, Vec<Vec3>) {
        let p: Vec<Vec3> = y.iter().map(|y| y / y.norm()).collect();
        let mut gradient = vec![Vec3::zeros(); y.len()];
        let mut value = 0.0;
        for facet in self.facets {
            let mut own = [Vec3::zeros(); 3];
            value += self.of(facet, facet.corners.map(|n| p[n as usize]), Some(&mut own));
            facet.corners.iter().zip(own).for_each(|(n, own)| gradient[*n as usize] += own);
        }
        for ((g, p), y) in gradient.iter_mut().zip(&p).zip(y) {
            *g = (*g - p * p.dot(g)) / y.norm();
        }
        (value, gradient)
    }

    /// The energy of a facet, and its derivatives by its corners.
    fn of(&self, facet: &Facet, [a, b, c]: [Vec3; 3], gradient: Option<&mut [Vec3; 3]>) -> f64 {
        let (e, f) = (b - a, c - a);
        let [m, n] = facet.inverse;
        let [u, v] = [e * m.x + f * m.y, e * n.x + f * n.y];
        let share = facet.share([a, b, c]);
        let root = (self.steepness * self.steepness + share * share).sqrt();
        let barrier = 0.5 * (share + root);
        let above = u.norm_squared() + v.norm_squared() + share * share + 1.0;
        if let Some(out) = gradient {
            let by_stretch = 2.0 * facet.weight / barrier;
            let slope = 0.5 * (1.0 + share / root);
            let by_share = facet.weight * (2.0 * share - above * slope / barrier) / barrier;
            let [by_e, by_f] = [(u * m.x + v * n.x) * by_stretch, (u * m.y + v * n.y) * by_stretch];
            let k = -by_share / facet.area;
            *out = [b.cross(&c) * k - by_e - by_f, c.cross(&a) * k + by_e, a.cross(&b) * k + by_f];
        }
        facet.weight * above / barrier
    }

    /// The shares of all facets, at unit directions.
    fn shares(&self, p: &[Vec3]) -> impl Iterator<Item = f64> {
        self.facets.iter().map(|facet| facet.share(facet.corners.map(|n| p[n as usize])))
    }

    /// The least of these shares.
    fn least(&self, p: &[Vec3]) -> f64 {
        self.shares(p).fold(f64::INFINITY, f64::min)
    }

    /// How many facets are turned over.
    fn turned(&self, p: &[Vec3]) -> usize {
        self.shares(p).filter(|share| *share <= 0.0).count()
    }
}

/// Moves unit directions that the film does not hold until no facet is turned over. Whether that was reached.
pub(super) fn unfold(directions: &mut Vec<Vec3>, facets: &[Facet], film: &Film, rounds: Rounds) -> bool {
    let mut energy = Energy { facets, steepness: 1.0 };
    let mut last = f64::INFINITY;
    let (mut fewest, mut in_vain) = (usize::MAX, 0);
    for _ in 0..ROUNDS {
        let least = energy.least(directions);
        energy.steepness = (BY_TURNED * least.min(0.0)).hypot(STEEPEST);
        let value = descend(&energy, directions, film, rounds.steps());
        directions.iter_mut().for_each(|d| *d = d.normalize());
        let turned = energy.turned(directions);
        in_vain = if turned < fewest { 0 } else { in_vain + 1 };
        fewest = fewest.min(turned);
        let is_settled = least > 0.0 && value > last * (1.0 - SETTLED);
        // The same value again: no step was found, and the next round would be the same.
        let is_stuck = value == last || rounds == Rounds::Long && in_vain >= PATIENCE;
        if is_settled || turned > 0 && is_stuck {
            break;
        }
        last = value;
    }
    energy.least(directions) > 0.0
}

/// A round of so many steps down, and the value at its end.
fn descend(energy: &Energy, y: &mut Vec<Vec3>, film: &Film, steps: usize) -> f64 {
    let (mut value, mut gradient) = energy.gradient(y);
    let mut memory = Memory::<3>::default();
    for _ in 0..steps {
        let way = memory.direction(&gradient, |way| guess(way, &memory, film));
        let slope = dot(&way, &gradient);
        let longest = way.iter().map(Vec3::norm).fold(f64::MIN_POSITIVE, f64::max);
        let whole = (LONGEST / longest).min(1.0);
        let lengths = (0..HALVINGS).map(|k| whole * 0.5f64.powi(k as i32));
        let at = |step: f64| -> Vec<Vec3> { y.iter().zip(&way).map(|(y, way)| y + way * step).collect() };
        let is_lower = |step: &f64| energy.value(&at(*step)) < value + SUFFICIENT * step * slope;
        let Some(step) = lengths.into_iter().find(|step| slope < 0.0 && is_lower(step)) else { break };
        let to = at(step);
        let (lower, next) = energy.gradient(&to);
        let less = |a: &[Vec3], b: &[Vec3]| -> Vec<Vec3> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
        memory.remember(less(&to, y), less(&next, &gradient));
        memory.keep(MEMORY);
        (*y, value, gradient) = (to, lower, next);
    }
    value
}

/// The film's inverse, as large as the last step says that the inverse curvature is.
fn guess(way: &mut [Vec3], memory: &Memory<3>, film: &Film) {
    let scale = memory
        .last()
        .map_or(1.0, |(change, weight)| 1.0 / (weight * dot(change, &film.inverse(change)).max(f64::MIN_POSITIVE)));
    let inverse = film.inverse(way);
    way.iter_mut().zip(inverse).for_each(|(way, inverse)| *way = inverse * scale);
}

#[cfg(test)]
mod tests {
    use super::super::balloon::Length;
    use super::super::harmonic::OpeningRing;
    use super::*;

    /// An octahedron, each of whose faces is to cover an eighth of the sphere.
    fn octahedron() -> (Vec<Vec3>, Vec<Facet>, Vec<Length>) {
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        let directions: Vec<Vec3> = axes.iter().flat_map(|a| [*a, -a]).collect();
        let flat = [Vec2::zeros(), Vec2::new(1.4, 0.0), Vec2::new(0.7, 1.2)];
        let facet = |k: u32| {
            let [a, b, c] = [k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2 & 1)];
            let [p, q, r] = [a, b, c].map(|n| directions[n as usize]);
            let clockwise = p.dot(&q.cross(&r)) < 0.0;
            Facet::new(if clockwise { [a, b, c] } else { [b, a, c] }, flat, 1.0).expect("no needle")
        };
        let facets = (0..8).map(facet).collect();
        let edge = |a: u32, b: u32| (a / 2 != b / 2).then_some(Length { ends: [a, b], rest: 1.0 });
        let edges = (0..6).flat_map(|a| (a + 1..6).filter_map(move |b| edge(a, b))).collect();
        (directions, facets, edges)
    }

    fn held(node: u32) -> OpeningRing {
        let (angles, frame) = (vec![0.0], [Vec3::x(), Vec3::y()]);
        OpeningRing { rim: vec![node], angles, frame, center: Vec3::zeros(), radius: 0.0, along: None, saddle: 0.0 }
    }

    #[test]
    fn the_gradient_is_that_of_the_energy() {
        let (mut y, facets, _) = octahedron();
        y.iter_mut().enumerate().for_each(|(k, y)| *y += Vec3::new(0.1, -0.07, 0.13) * f64::from(k as u32 % 4));
        // One turned over, too.
        y[0] = Vec3::new(-0.6, 0.9, 0.2);
        let energy = Energy { facets: &facets, steepness: 0.3 };
        let (_, gradient) = energy.gradient(&y);
        for (n, c) in (0..6).flat_map(|n| (0..3).map(move |c| (n, c))) {
            let at = |h: f64| {
                let mut y = y.clone();
                y[n][c] += h;
                energy.value(&y)
            };
            let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!((slope - gradient[n][c]).abs() < 1e-6 * (1.0 + slope.abs()), "{n} {c}: {slope} {}", gradient[n][c]);
        }
    }

    #[test]
    fn a_corner_that_lies_on_the_other_side_comes_back() {
        let (mut directions, facets, edges) = octahedron();
        let film = Film::new(6, &edges, &[held(1), held(3)]).expect("a film");
        directions[4] = Vec3::new(0.3, 0.2, -0.8).normalize();
        let energy = Energy { facets: &facets, steepness: 1.0 };
        assert!(energy.least(&directions) < 0.0, "it is folded over at first");
        assert!(unfold(&mut directions, &facets, &film, Rounds::Short));
        assert!(energy.least(&directions) > 0.3);
        assert_eq!(directions[1], -Vec3::x(), "what is held stays");
    }

    #[test]
    fn a_needle_is_no_facet() {
        let flat = [Vec2::zeros(), Vec2::new(1.0, 0.0), Vec2::new(0.5, 1e-6)];
        assert!(Facet::new([0, 1, 2], flat, 1.0).is_none());
    }
}
