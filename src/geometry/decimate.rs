//! Fewer triangles for a surface, with a bound of the error.
//!
//! Vertices are moved onto a neighbour one after the other, those first that lie nearest to the planes of the triangles
//! round them (quadric error: Garland & Heckbert 1997). Every vertex that is gone belongs to the nearest of the
//! triangles that took its place, and none may get further from them than the tolerance.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};

use nalgebra::Matrix4;

use super::{Vec3, sorted_pair};

/// A triangle may turn by no more than this when one of its corners moves (cosine, 60°).
const TURN: f64 = 0.5;
/// Least double area of a new triangle, as a share of its longest side squared, unless the old ones were worse: its
/// smallest angle is about 6°.
const SLENDER: f64 = 0.1;

/// A surface with fewer triangles.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Decimated {
    /// Corners, which are vertices of the original, and the group of every triangle.
    pub(crate) triangles: Vec<([u32; 3], u32)>,
    /// No vertex of the original is further from these than this, in the unit of the vertices.
    pub(crate) error: f64,
}

/// Leaves out vertices as long as none of them is further from the surface that is left than `tolerance`. Rims, and
/// lines between triangles of different groups, keep their corners and stay within the tolerance of what they were.
pub(crate) fn decimated(vertices: &[Vec3], triangles: &[([u32; 3], u32)], tolerance: f64) -> Decimated {
    let mut mesh = Mesh::new(vertices, triangles, tolerance);
    let mut heap: BinaryHeap<Move> = BinaryHeap::new();
    for v in 0..vertices.len() as u32 {
        mesh.offer(v, &mut heap);
    }
    while let Some(next) = heap.pop() {
        if next.stamp != mesh.stamps[next.from as usize] || mesh.round[next.from as usize].is_empty() {
            continue;
        }
        if let Some(fan) = mesh.fan_without(next.from, next.to) {
            for v in mesh.collapse(next.from, next.to, fan) {
                mesh.offer(v, &mut heap);
            }
        }
    }
    mesh.finished()
}

/// A vertex that may move onto a neighbour.
struct Move {
    cost: f64,
    from: u32,
    to: u32,
    /// Of `from` when this was offered: what is older does not count.
    stamp: u32,
}

impl PartialEq for Move {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Move {}

impl PartialOrd for Move {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Move {
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |m: &Self| (m.from, m.to);
        other.cost.total_cmp(&self.cost).then_with(|| key(other).cmp(&key(self)))
    }
}

/// A triangle and the vertices that are gone and belong to it.
#[derive(Clone)]
struct Face {
    corners: [u32; 3],
    group: u32,
    gone: Vec<u32>,
}

/// The triangles that take the place of those round a vertex.
struct Fan {
    faces: Vec<Face>,
    /// Vertices that are gone along the new border edge.
    along: Vec<u32>,
}

struct Mesh<'a> {
    vertices: &'a [Vec3],
    tolerance: f64,
    faces: Vec<Option<Face>>,
    /// The triangles at every vertex.
    round: Vec<Vec<u32>>,
    quadrics: Vec<Matrix4<f64>>,
    stamps: Vec<u32>,
    /// Edges of rims and between groups, and the vertices that are gone along them.
    borders: HashMap<[u32; 2], Vec<u32>>,
    /// The ends of the border edges at every vertex that has some.
    on_border: HashMap<u32, Vec<u32>>,
    /// By how much the vertices that are gone lie off, at most.
    error: f64,
}

impl<'a> Mesh<'a> {
    fn new(vertices: &'a [Vec3], triangles: &[([u32; 3], u32)], tolerance: f64) -> Self {
        let mut round = vec![Vec::new(); vertices.len()];
        let mut quadrics = vec![Matrix4::zeros(); vertices.len()];
        let mut sides: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
        for (t, (corners, _)) in (0..).zip(triangles) {
            let [a, b, c] = corners.map(|v| vertices[v as usize]);
            let double = (b - a).cross(&(c - a));
            let normal = double.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
            let plane = normal.push(-normal.dot(&a));
            let quadric = plane * plane.transpose() * double.norm();
            for (k, &v) in corners.iter().enumerate() {
                round[v as usize].push(t);
                quadrics[v as usize] += quadric;
                sides.entry(sorted_pair([v, corners[(k + 1) % 3]])).or_default().push(t);
            }
        }
        let group = |t: &u32| triangles[*t as usize].1;
        let is_border = |at: &Vec<u32>| at.len() != 2 || group(&at[0]) != group(&at[1]);
        let borders: HashMap<[u32; 2], Vec<u32>> =
            sides.iter().filter(|(_, at)| is_border(at)).map(|(ends, _)| (*ends, Vec::new())).collect();
        let mut on_border: HashMap<u32, Vec<u32>> = HashMap::new();
        for &[a, b] in borders.keys() {
            on_border.entry(a).or_default().push(b);
            on_border.entry(b).or_default().push(a);
        }
        let face = |&(corners, group): &([u32; 3], u32)| Some(Face { corners, group, gone: Vec::new() });
        Self {
            vertices,
            tolerance,
            faces: triangles.iter().map(face).collect(),
            round,
            quadrics,
            stamps: vec![0; vertices.len()],
            borders,
            on_border,
            error: 0.0,
        }
    }

    fn at(&self, v: u32) -> Vec3 {
        self.vertices[v as usize]
    }

    fn face(&self, t: u32) -> &Face {
        self.faces[t as usize].as_ref().unwrap_or_else(|| unreachable!("a vertex lists the triangles that are left"))
    }

    /// The neighbours of a vertex, in order.
    fn neighbours(&self, v: u32) -> Vec<u32> {
        let all = self.round[v as usize].iter().flat_map(|&t| self.face(t).corners);
        let mut all: Vec<u32> = all.filter(|&w| w != v).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Where a vertex may go, the cheapest.
    fn offer(&mut self, v: u32, heap: &mut BinaryHeap<Move>) {
        self.stamps[v as usize] += 1;
        let ends = match self.on_border.get(&v) {
            // A corner of several borders, or where one ends, stays.
            Some(ends) if ends.len() != 2 => return,
            Some(ends) => ends.clone(),
            None => self.neighbours(v),
        };
        let quadric = self.quadrics[v as usize];
        for to in ends {
            let p = self.at(to).push(1.0);
            let cost = (p.transpose() * quadric * p)[0] + f64::EPSILON * (self.at(to) - self.at(v)).norm_squared();
            heap.push(Move { cost, from: v, to, stamp: self.stamps[v as usize] });
        }
    }

    /// The triangles round a vertex after it has moved onto a neighbour; `None` where it must not.
    fn fan_without(&self, from: u32, to: u32) -> Option<Fan> {
        let (own, other) = (self.neighbours(from), self.neighbours(to));
        let common: Vec<u32> = own.iter().copied().filter(|v| other.binary_search(v).is_ok()).collect();
        let shared: Vec<u32> =
            self.round[from as usize].iter().copied().filter(|&t| self.face(t).corners.contains(&to)).collect();
        // Else two sheets would be joined in an edge.
        if common.len() != shared.len() || !(1..=2).contains(&shared.len()) {
            return None;
        }
        let mut faces = Vec::new();
        let mut gone = vec![from];
        for &t in &self.round[from as usize] {
            let face = self.face(t);
            gone.extend(&face.gone);
            if !shared.contains(&t) {
                let corners = face.corners.map(|v| if v == from { to } else { v });
                if !self.is_sound(face.corners, corners) {
                    return None;
                }
                faces.push(Face { corners, group: face.group, gone: Vec::new() });
            }
        }
        for v in gone {
            let far = |face: &Face| distance(self.at(v), face.corners.map(|w| self.at(w)));
            let nearest = (0..faces.len()).map(|k| (k, far(&faces[k]))).min_by(|a, b| a.1.total_cmp(&b.1));
            let (k, _) = nearest.filter(|nearest| nearest.1 <= self.tolerance)?;
            faces[k].gone.push(v);
        }
        Some(Fan { faces, along: self.along(from, to)? })
    }

    /// The vertices that are gone along the border edge that a vertex leaves; none inside. `None` where one would be
    /// too far from it.
    fn along(&self, from: u32, to: u32) -> Option<Vec<u32>> {
        let Some(ends) = self.on_border.get(&from) else { return Some(Vec::new()) };
        let before = ends.iter().copied().find(|&v| v != to)?;
        let mut gone = vec![from];
        for end in ends {
            gone.extend(&self.borders[&sorted_pair([from, *end])]);
        }
        let ends = [self.at(before), self.at(to)];
        let near = |v: &u32| super::distance_to_segment(self.at(*v), ends) <= self.tolerance;
        gone.iter().all(near).then_some(gone)
    }

    /// Whether a triangle may take the place of another.
    fn is_sound(&self, old: [u32; 3], new: [u32; 3]) -> bool {
        let shape = |corners: [u32; 3]| {
            let [a, b, c] = corners.map(|v| self.at(v));
            let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
            let double = (b - a).cross(&(c - a));
            (double, double.norm() / longest)
        };
        let ((before, shape_before), (after, shape_after)) = (shape(old), shape(new));
        before.dot(&after) > TURN * before.norm() * after.norm() && shape_after > SLENDER.min(shape_before)
    }

    /// Moves a vertex onto a neighbour; the vertices round it, which may go elsewhere now.
    fn collapse(&mut self, from: u32, to: u32, fan: Fan) -> Vec<u32> {
        let old = std::mem::take(&mut self.round[from as usize]);
        for &t in &old {
            for v in self.face(t).corners {
                self.round[v as usize].retain(|&own| own != t);
            }
        }
        let mut places = old.into_iter();
        for face in fan.faces {
            // There are fewer than before.
            let Some(t) = places.next() else { break };
            face.corners.iter().for_each(|&v| self.round[v as usize].push(t));
            self.faces[t as usize] = Some(face);
        }
        places.for_each(|t| self.faces[t as usize] = None);
        let quadric = self.quadrics[from as usize];
        self.quadrics[to as usize] += quadric;
        if let Some(ends) = self.on_border.remove(&from) {
            let before = ends.iter().copied().find(|&v| v != to).unwrap_or(to);
            for end in ends {
                self.borders.remove(&sorted_pair([from, end]));
            }
            self.borders.insert(sorted_pair([before, to]), fan.along);
            for (v, new) in [(before, to), (to, before)] {
                let own = self.on_border.entry(v).or_default();
                own.iter_mut().filter(|end| **end == from).for_each(|end| *end = new);
            }
        }
        let mut round = self.neighbours(to);
        round.push(to);
        round
    }

    fn finished(mut self) -> Decimated {
        for face in self.faces.iter().flatten() {
            let corners = face.corners.map(|v| self.vertices[v as usize]);
            let far = face.gone.iter().map(|&v| distance(self.vertices[v as usize], corners));
            self.error = far.fold(self.error, f64::max);
        }
        for ([a, b], gone) in &self.borders {
            let ends = [self.vertices[*a as usize], self.vertices[*b as usize]];
            let far = gone.iter().map(|&v| super::distance_to_segment(self.vertices[v as usize], ends));
            self.error = far.fold(self.error, f64::max);
        }
        let triangles = self.faces.into_iter().flatten().map(|face| (face.corners, face.group)).collect();
        Decimated { triangles, error: self.error }
    }
}

/// Distance of a point from a triangle.
fn distance(p: Vec3, [a, b, c]: [Vec3; 3]) -> f64 {
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    let inside = |u: Vec3, v: Vec3| (v - u).cross(&(p - u)).dot(&normal) >= 0.0;
    if square > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return (p - a).dot(&normal).abs() / square.sqrt();
    }
    [[a, b], [b, c], [c, a]].map(|ends| super::distance_to_segment(p, ends)).into_iter().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of n × n quads over a unit square, lifted.
    fn sheet(n: u32, lift: impl Fn(f64, f64) -> f64) -> (Vec<Vec3>, Vec<([u32; 3], u32)>) {
        let at = |i: u32, j: u32| (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
        let all = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j)));
        let vertices = all.map(|(i, j)| at(i, j)).map(|(x, y)| Vec3::new(x, y, lift(x, y))).collect();
        let quads = (0..n).flat_map(|j| (0..n).map(move |i| j * (n + 1) + i));
        let triangles = quads.flat_map(|a| [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        (vertices, triangles.map(|t| (t, 0)).collect())
    }

    #[test]
    fn a_flat_sheet_keeps_its_corners_alone() {
        let (vertices, triangles) = sheet(20, |_, _| 0.0);
        let fewer = decimated(&vertices, &triangles, 1e-6);
        let area = |t: &([u32; 3], u32)| {
            let [a, b, c] = t.0.map(|v| vertices[v as usize]);
            (b - a).cross(&(c - a)).z / 2.0
        };
        assert!(fewer.triangles.len() < 40, "{}", fewer.triangles.len());
        assert!((fewer.triangles.iter().map(area).sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(fewer.triangles.iter().all(|t| area(t) > 0.0) && fewer.error < 1e-12);
    }

    #[test]
    fn no_vertex_is_further_off_than_is_said() {
        let (vertices, triangles) = sheet(40, |x, y| 0.2 * (3.0 * x).sin() * (2.0 * y).cos());
        let fewer = decimated(&vertices, &triangles, 2e-3);
        assert!(fewer.triangles.len() < triangles.len() / 4, "{}", fewer.triangles.len());
        let far = |p: &Vec3| {
            let from = |t: &([u32; 3], u32)| distance(*p, t.0.map(|v| vertices[v as usize]));
            fewer.triangles.iter().map(from).fold(f64::INFINITY, f64::min)
        };
        let farthest = vertices.iter().map(far).fold(0.0, f64::max);
        assert!(farthest <= fewer.error && fewer.error <= 2e-3, "{farthest} {}", fewer.error);
    }

    #[test]
    fn the_line_between_two_groups_stays() {
        let (vertices, mut triangles) = sheet(20, |x, _| if x < 0.5 { 0.0 } else { 2.0 * (x - 0.5) });
        triangles.iter_mut().for_each(|t| t.1 = u32::from(t.0.iter().all(|v| v % 21 >= 10)));
        let fewer = decimated(&vertices, &triangles, 1e-6);
        let share = |group: u32| {
            let own = fewer.triangles.iter().filter(|t| t.1 == group);
            own.map(|t| {
                let [a, b, c] = t.0.map(|v| vertices[v as usize]);
                (b - a).cross(&(c - a)).z / 2.0
            })
            .sum::<f64>()
        };
        assert!((share(0) - 0.5).abs() < 1e-12 && (share(1) - 0.5).abs() < 1e-12);
    }
}
