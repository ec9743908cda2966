//! Plane sections of a garment: the ring of cloth round a part of the body.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use crate::geometry::{TriMesh, Vec2, Vec3};

/// Distance over which the cloth of a ring may be interrupted, metres: the layers of a wrap or a button stand, and what
/// gapes between two buttons.
const BRIDGED: f64 = 0.03;

/// A point at which a plane cuts an edge of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutPoint {
    /// The vertices of the edge.
    pub ends: [u32; 2],
    /// Its place between them, 0 … 1.
    pub share: f64,
    /// The point.
    pub at: Vec3,
}

/// Cloth round an axis, in a plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClothRing {
    /// Points in order. The last is followed by the first.
    pub points: Vec<CutPoint>,
    /// The triangle through which a point is joined with the next one. `None` where no cloth is between them.
    pub through: Vec<Option<u32>>,
}

impl ClothRing {
    /// Its points, each with the next one and the triangle between them.
    pub fn steps(&self) -> impl Iterator<Item = (&CutPoint, &CutPoint, Option<u32>)> {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().zip(next).zip(&self.through).map(|((p, q), through)| (p, q, *through))
    }

    /// Length round it, metres.
    pub fn length(&self) -> f64 {
        self.steps().map(|(p, q, _)| (q.at - p.at).norm()).sum()
    }

    /// How often it runs round `center`, in the plane with the unit normal `axis`.
    pub fn turns(&self, center: Vec3, axis: Vec3) -> i64 {
        let plane = SectionPlane::new(center, axis);
        self.steps().map(|(p, q, _)| plane.crossed(plane.flat(p.at), plane.flat(q.at))).sum()
    }
}

/// The shortest ring of cloth that runs once round `center` in the plane through it with the unit normal `axis`. `None`
/// where the cloth does not go round it.
///
/// Of several layers this is the innermost. Folds count with all their cloth. Cloth that laps over itself counts once.
pub fn ring(surface: &TriMesh, center: Vec3, axis: Vec3) -> Option<ClothRing> {
    let plane = SectionPlane::new(center, axis);
    let section = PlaneSection::new(surface, &plane);
    section.shortest(&plane)
}

/// A plane with a direction of its own and a center.
struct SectionPlane {
    center: Vec3,
    axis: Vec3,
    u: Vec3,
    v: Vec3,
}

impl SectionPlane {
    fn new(center: Vec3, axis: Vec3) -> Self {
        let u = axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize();
        Self { center, axis, u, v: axis.cross(&u) }
    }

    fn flat(&self, p: Vec3) -> Vec2 {
        let d = p - self.center;
        Vec2::new(d.dot(&self.u), d.dot(&self.v))
    }

    /// 1 or −1 where the way from `p` to `q` crosses the ray from the center along the plane's first direction.
    fn crossed(&self, p: Vec2, q: Vec2) -> i64 {
        if (p.y < 0.0) == (q.y < 0.0) {
            return 0;
        }
        let x = p.x + (q.x - p.x) * p.y / (p.y - q.y);
        match x > 0.0 {
            true if q.y >= 0.0 => 1,
            true => -1,
            false => 0,
        }
    }
}

/// A way from one point of a section to another.
#[derive(Clone, Copy)]
struct SectionWay {
    to: usize,
    length: f64,
    through: Option<u32>,
    crossed: i64,
}

/// All points at which a plane cuts a surface, and the ways between them.
struct PlaneSection {
    points: Vec<CutPoint>,
    ways: Vec<Vec<SectionWay>>,
}

impl PlaneSection {
    fn new(surface: &TriMesh, plane: &SectionPlane) -> Self {
        let side: Vec<f64> = surface.vertices.iter().map(|p| (p - plane.center).dot(&plane.axis)).collect();
        let mut index: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        let mut out = Self { points: Vec::new(), ways: Vec::new() };
        for (number, triangle) in (0..).zip(&surface.triangles) {
            let mut cut = Vec::new();
            for k in 0..3 {
                let (a, b) = (triangle[k].min(triangle[(k + 1) % 3]), triangle[k].max(triangle[(k + 1) % 3]));
                let (s, t) = (side[a as usize], side[b as usize]);
                if (s < 0.0) == (t < 0.0) {
                    continue;
                }
                let share = s / (s - t);
                cut.push(*index.entry([a, b]).or_insert_with(|| {
                    let at = surface.vertices[a as usize].lerp(&surface.vertices[b as usize], share);
                    out.points.push(CutPoint { ends: [a, b], share, at });
                    out.ways.push(Vec::new());
                    out.points.len() - 1
                }));
            }
            if let [p, q] = cut[..] {
                out.join(plane, [p, q], Some(number));
            }
        }
        out.bridge(plane);
        out
    }

    fn join(&mut self, plane: &SectionPlane, [p, q]: [usize; 2], through: Option<u32>) {
        let [from, to] = [p, q].map(|k| self.points[k].at);
        let (length, crossed) = ((to - from).norm(), plane.crossed(plane.flat(from), plane.flat(to)));
        self.ways[p].push(SectionWay { to: q, length, through, crossed });
        self.ways[q].push(SectionWay { to: p, length, through, crossed: -crossed });
    }

    /// Joins the ends of cloth with everything near them.
    fn bridge(&mut self, plane: &SectionPlane) {
        let ends: Vec<usize> = (0..self.points.len()).filter(|&k| self.ways[k].len() == 1).collect();
        for (n, &end) in ends.iter().enumerate() {
            let neighbour = self.ways[end][0].to;
            for other in 0..self.points.len() {
                // Two ends are joined once.
                let known = other == end || other == neighbour || ends[..n].contains(&other);
                if !known && (self.points[other].at - self.points[end].at).norm() < BRIDGED {
                    self.join(plane, [end, other], None);
                }
            }
        }
    }

    /// The shortest closed way that crosses the ray from the center once more in one direction than in the other.
    fn shortest(&self, plane: &SectionPlane) -> Option<ClothRing> {
        let mut best: Option<(f64, Vec<(usize, SectionWay)>)> = None;
        let starts = (0..self.points.len()).filter(|&k| self.ways[k].iter().any(|way| way.crossed > 0));
        for start in starts {
            let limit = best.as_ref().map_or(f64::INFINITY, |(length, _)| *length);
            if let Some(found) = self.round(start, limit) {
                best = Some(found);
            }
        }
        let (_, ways) = best?;
        let ring = ClothRing {
            points: ways.iter().map(|(from, _)| self.points[*from]).collect(),
            through: ways.iter().map(|(_, way)| way.through).collect(),
        };
        (ring.turns(plane.center, plane.axis).abs() == 1).then_some(ring)
    }

    /// The shortest way from `start` back to it that goes round once and is shorter than `limit` (Dijkstra's algorithm
    /// over points and turns).
    fn round(&self, start: usize, limit: f64) -> Option<(f64, Vec<(usize, SectionWay)>)> {
        /// Turns that a way may be ahead or behind.
        const TURNS: i64 = 1;
        let levels = 2 * TURNS + 1;
        let state = |point: usize, turns: i64| point * levels as usize + (turns + TURNS) as usize;
        let count = self.points.len() * levels as usize;
        let mut length = vec![f64::INFINITY; count];
        let mut before: Vec<Option<(usize, usize)>> = vec![None; count];
        let (from, to) = (state(start, 0), state(start, 1));
        // Lengths are not negative: as bits they have the order of the numbers.
        let mut open = BinaryHeap::from([Reverse((0u64, from))]);
        length[from] = 0.0;
        while let Some(Reverse((bits, here))) = open.pop() {
            let so_far = f64::from_bits(bits);
            if here == to || so_far >= limit {
                break;
            }
            if so_far > length[here] {
                continue;
            }
            let (point, turns) = (here / levels as usize, here as i64 % levels - TURNS);
            for (number, way) in self.ways[point].iter().enumerate() {
                let after = turns + way.crossed;
                if after.abs() > TURNS {
                    continue;
                }
                let (next, reached) = (state(way.to, after), so_far + way.length);
                if reached < length[next] {
                    (length[next], before[next]) = (reached, Some((here, number)));
                    open.push(Reverse((reached.to_bits(), next)));
                }
            }
        }
        if length[to] >= limit {
            return None;
        }
        let mut ways = Vec::new();
        let mut here = to;
        while here != from {
            let (last, number) = before[here]?;
            let point = last / levels as usize;
            ways.push((point, self.ways[point][number]));
            here = last;
        }
        ways.reverse();
        Some((length[to], ways))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tube whose section is `at(share)`, from share 0 to `end`, standing on z = 0, with `n` columns.
    fn tube(n: u32, end: f64, closed: bool, at: impl Fn(f64) -> Vec2) -> TriMesh {
        let mut mesh = TriMesh::default();
        let columns = if closed { n } else { n + 1 };
        for k in 0..columns {
            let p = at(end * f64::from(k) / f64::from(n));
            mesh.vertices.extend([Vec3::new(p.x, p.y, -0.01), Vec3::new(p.x, p.y, 0.013)]);
        }
        for k in 0..n {
            let (a, b) = (2 * k, 2 * ((k + 1) % columns));
            mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
        mesh
    }

    fn circle(radius: f64) -> impl Fn(f64) -> Vec2 {
        move |share| {
            let angle = share * std::f64::consts::TAU;
            Vec2::new(radius * angle.cos(), radius * angle.sin())
        }
    }

    fn length(mesh: &TriMesh) -> Option<f64> {
        ring(mesh, Vec3::new(0.01, -0.02, 0.0), Vec3::z()).map(|ring| ring.length())
    }

    #[test]
    fn girths_of_tubes_are_those_of_a_tape() {
        let round = length(&tube(200, 1.0, true, circle(0.15))).expect("closed");
        assert!((round - 0.3 * std::f64::consts::PI).abs() < 1e-3, "{round}");
        // Eight folds, with all their cloth: the length of the curve, summed over finer steps.
        let wavy = |share: f64| circle(0.15 + 0.02 * (8.0 * share * std::f64::consts::TAU).cos())(share);
        let fine: f64 = (0..100_000).map(|k| (wavy(f64::from(k + 1) / 1e5) - wavy(f64::from(k) / 1e5)).norm()).sum();
        let folded = length(&tube(600, 1.0, true, wavy)).expect("closed");
        assert!((folded - fine).abs() < 1e-3, "{folded}, {fine}");
    }

    #[test]
    fn of_two_layers_the_inner_one_counts() {
        let (mut mesh, inner) = (tube(100, 1.0, true, circle(0.16)), tube(100, 1.0, true, circle(0.15)));
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(&inner.vertices);
        mesh.triangles.extend(inner.triangles.iter().map(|t| t.map(|v| v + first)));
        let girth = length(&mesh).expect("closed");
        assert!((girth - 0.3 * std::f64::consts::PI).abs() < 1e-3, "{girth}");
    }

    #[test]
    fn cloth_that_laps_over_itself_counts_once() {
        // The upper layer is a millimetre further out after a full turn.
        let wrap = |share: f64| circle(0.15 + 0.001 * share)(share);
        let girth = length(&tube(240, 1.2, false, wrap)).expect("it laps");
        assert!((girth - 0.3 * std::f64::consts::PI).abs() < 5e-3, "{girth}");
        assert_eq!(length(&tube(200, 0.9, false, circle(0.15))), None, "94 mm are missing");
        let gaping = length(&tube(200, 0.98, false, circle(0.15))).expect("19 mm gape");
        assert!((gaping - 0.3 * std::f64::consts::PI).abs() < 1e-3, "{gaping}");
    }

    #[test]
    fn a_ring_beside_the_axis_is_not_round_it() {
        let mut mesh = tube(100, 1.0, true, circle(0.15));
        mesh.vertices.iter_mut().for_each(|p| p.x += 0.2);
        assert_eq!(length(&mesh), None);
    }
}
