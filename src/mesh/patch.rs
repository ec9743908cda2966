//! A planar triangulation that can be edited, tried out and taken back.

use super::shape::{Score, quality};
use crate::geometry::{Vec2, sorted_pair};

/// No triangle.
const NONE: u32 = u32::MAX;

/// A triangle. Side `k` runs from corner `k + 1` to corner `k + 2`, opposite corner `k`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tri {
    /// Corners, positively oriented.
    pub(super) v: [u32; 3],
    /// The triangle across each side.
    beside: [u32; 3],
    /// Sides that must stay (springs of internal lines).
    locked: [bool; 3],
}

/// A triangle that has been removed.
const DEAD: Tri = Tri { v: [NONE; 3], beside: [NONE; 3], locked: [false; 3] };

/// A triangulated piece under repair.
pub(super) struct Patch {
    /// Positions of the vertices.
    pub(super) points: Vec<Vec2>,
    /// Vertices below this number must stay where they are.
    pub(super) fixed: u32,
    triangles: Vec<Tri>,
    /// A triangle at every vertex.
    at: Vec<u32>,
    trial: Option<PatchState>,
}

/// State to restore if a change turns out for the worse.
struct PatchState {
    undo: Vec<Undo>,
    /// Triangles that have been saved before their first change.
    touched: Vec<u32>,
    /// Score before the change.
    before: Score,
    triangles: usize,
    points: usize,
}

enum Undo {
    Triangle(u32, Tri),
    Point(u32, Vec2),
    At(u32, u32),
}

impl Patch {
    /// Takes over a triangulation. `lines` are the springs that must stay.
    pub(super) fn new(points: Vec<Vec2>, fixed: usize, triangles: &[[u32; 3]], lines: &[[u32; 2]]) -> Self {
        let mut patch = Self {
            at: vec![NONE; points.len()],
            points,
            fixed: fixed as u32,
            triangles: triangles.iter().map(|&v| Tri { v, ..DEAD }).collect(),
            trial: None,
        };
        let mut locked: Vec<[u32; 2]> = lines.iter().copied().map(sorted_pair).collect();
        locked.sort_unstable();
        let mut sides: Vec<([u32; 2], u32, usize)> = Vec::with_capacity(3 * triangles.len());
        for (t, v) in triangles.iter().enumerate() {
            for k in 0..3 {
                patch.at[v[k] as usize] = t as u32;
                let ends = sorted_pair([v[(k + 1) % 3], v[(k + 2) % 3]]);
                sides.push((ends, t as u32, k));
                patch.triangles[t].locked[k] = locked.binary_search(&ends).is_ok();
            }
        }
        sides.sort_unstable();
        for pair in sides.windows(2).filter(|w| w[0].0 == w[1].0) {
            let ((_, t, k), (_, u, m)) = (pair[0], pair[1]);
            patch.triangles[t as usize].beside[k] = u;
            patch.triangles[u as usize].beside[m] = t;
        }
        patch
    }

    /// Numbers of the living triangles.
    pub(super) fn alive(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.triangles.len() as u32).filter(|&t| self.is_alive(t))
    }

    /// Whether triangle `t` has not been removed.
    pub(super) fn is_alive(&self, t: u32) -> bool {
        self.triangles[t as usize].v[0] != NONE
    }

    /// Corners of triangle `t`.
    pub(super) fn corners(&self, t: u32) -> [u32; 3] {
        self.triangles[t as usize].v
    }

    /// Position of vertex `v`.
    pub(super) fn point(&self, v: u32) -> Vec2 {
        self.points[v as usize]
    }

    /// Quality of triangle `t`.
    pub(super) fn quality(&self, t: u32) -> f64 {
        let [a, b, c] = self.corners(t).map(|v| self.point(v));
        quality(a, b, c)
    }

    /// Whether vertex `v` may be moved or removed.
    pub(super) fn is_free(&self, v: u32) -> bool {
        v >= self.fixed
    }

    /// The triangle across side `k` of `t`, unless the side is a rim or must stay.
    pub(super) fn partner(&self, t: u32, k: usize) -> Option<u32> {
        let tri = &self.triangles[t as usize];
        (tri.beside[k] != NONE && !tri.locked[k]).then_some(tri.beside[k])
    }

    /// The corner of `t` that is neither `a` nor `b`.
    pub(super) fn third(&self, t: u32, a: u32, b: u32) -> u32 {
        let v = self.corners(t);
        v.into_iter().find(|&x| x != a && x != b).unwrap_or(v[0])
    }

    /// The two triangles beside the spring `a`–`b`, if it exists, is no rim and need not stay.
    pub(super) fn beside(&self, a: u32, b: u32) -> Option<[u32; 2]> {
        self.star(a).into_iter().find_map(|t| {
            let v = self.corners(t);
            let k = (0..3).find(|&k| v[(k + 1) % 3] == a && v[(k + 2) % 3] == b)?;
            Some([t, self.partner(t, k)?])
        })
    }

    /// Triangles round vertex `v`, turning positively from the rim if it is on one. Empty if `v` was removed.
    pub(super) fn star(&self, v: u32) -> Vec<u32> {
        let start = self.at[v as usize];
        let mut out = Vec::with_capacity(8);
        if start == NONE {
            return out;
        }
        // Back to the rim first, if there is one.
        let mut first = start;
        while let Some(t) = self.turn(first, v, 2) {
            first = t;
            if t == start {
                break;
            }
        }
        let mut t = first;
        loop {
            out.push(t);
            match self.turn(t, v, 1) {
                Some(next) if next != first => t = next,
                _ => return out,
            }
        }
    }

    /// The next triangle round `v`, across the side opposite the `way`-th corner after `v`.
    fn turn(&self, t: u32, v: u32, way: usize) -> Option<u32> {
        let tri = &self.triangles[t as usize];
        let k = tri.v.iter().position(|&x| x == v)?;
        let next = tri.beside[(k + way) % 3];
        (next != NONE).then_some(next)
    }

    /// Worst quality of the triangles round `v` if it lay at `p`.
    pub(super) fn quality_at(&self, star: &[u32], v: u32, p: Vec2) -> f64 {
        let place = |x: u32| if x == v { p } else { self.point(x) };
        star.iter().map(|&t| self.corners(t).map(place)).map(|[a, b, c]| quality(a, b, c)).fold(1.0, f64::min)
    }

    /// Moves a free vertex.
    pub(super) fn move_to(&mut self, v: u32, p: Vec2) {
        if self.trial.is_some() {
            for t in self.star(v) {
                self.touch(t);
            }
            let old = self.point(v);
            self.log(Undo::Point(v, old));
        }
        self.points[v as usize] = p;
    }

    /// Adds a vertex. [`Patch::replace`] must connect it.
    pub(super) fn add(&mut self, p: Vec2) -> u32 {
        self.points.push(p);
        self.at.push(NONE);
        self.points.len() as u32 - 1
    }

    /// Puts the triangles `new` in the place of `old`. Both cover the same polygon. Vertices of `old` that `new`
    /// does not use are gone.
    pub(super) fn replace(&mut self, old: &[u32], new: &[[u32; 3]]) {
        let sides: Vec<DirectedSide> = old.iter().flat_map(|&t| self.sides(t)).collect();
        let slots: Vec<u32> = (0..new.len())
            .map(|k| old.get(k).copied().unwrap_or((self.triangles.len() + k - old.len()) as u32))
            .collect();
        old.iter().for_each(|&t| self.touch(t));
        for side in &sides {
            self.set_at(side.ends[0], NONE);
        }
        for &t in old.iter().skip(new.len()) {
            self.set_triangle(t, DEAD);
        }
        for (k, &v) in new.iter().enumerate() {
            let mut tri = Tri { v, ..DEAD };
            for s in 0..3 {
                let ends = [v[(s + 1) % 3], v[(s + 2) % 3]];
                let back = [ends[1], ends[0]];
                tri.locked[s] = sides.iter().any(|x| x.locked && (x.ends == ends || x.ends == back));
                let inner = new.iter().position(|w| (0..3).any(|m| [w[(m + 1) % 3], w[(m + 2) % 3]] == back));
                tri.beside[s] = match inner {
                    Some(m) => slots[m],
                    None => sides.iter().find(|x| x.ends == ends).map_or(NONE, |x| x.beside),
                };
                if inner.is_none() && tri.beside[s] != NONE {
                    self.point_back(tri.beside[s], back, slots[k]);
                }
            }
            self.set_triangle(slots[k], tri);
            v.iter().for_each(|&x| self.set_at(x, slots[k]));
        }
    }

    /// Begins a change that may be taken back.
    pub(super) fn begin(&mut self) {
        self.trial = Some(PatchState {
            undo: Vec::new(),
            touched: Vec::new(),
            before: Score::PERFECT,
            triangles: self.triangles.len(),
            points: self.points.len(),
        });
    }

    /// Ends a change: keeps it if `accept(before, after)` of the triangles it touched, else restores everything.
    /// Returns whether it was kept.
    pub(super) fn end(&mut self, accept: impl FnOnce(Score, Score) -> bool) -> bool {
        let Some(trial) = self.trial.take() else { return true };
        let fresh = trial.triangles as u32..self.triangles.len() as u32;
        let changed = trial.touched.iter().copied().chain(fresh).filter(|&t| self.is_alive(t));
        let after = changed.map(|t| self.quality(t)).fold(Score::PERFECT, Score::with);
        if accept(trial.before, after) {
            return true;
        }
        for undo in trial.undo.into_iter().rev() {
            match undo {
                Undo::Triangle(t, tri) => self.triangles[t as usize] = tri,
                Undo::Point(v, p) => self.points[v as usize] = p,
                Undo::At(v, t) => self.at[v as usize] = t,
            }
        }
        self.triangles.truncate(trial.triangles);
        self.points.truncate(trial.points);
        self.at.truncate(trial.points);
        false
    }

    /// Positions and triangles without the dead, fixed vertices first and unchanged.
    pub(super) fn finish(self) -> (Vec<Vec2>, Vec<[u32; 3]>) {
        let mut number = vec![NONE; self.points.len()];
        let mut points = Vec::new();
        for (v, &p) in self.points.iter().enumerate() {
            if v < self.fixed as usize || self.at[v] != NONE {
                number[v] = points.len() as u32;
                points.push(p);
            }
        }
        let triangles = self.alive().map(|t| self.corners(t).map(|v| number[v as usize])).collect();
        (points, triangles)
    }

    fn sides(&self, t: u32) -> [DirectedSide; 3] {
        let tri = &self.triangles[t as usize];
        [0, 1, 2].map(|k| DirectedSide {
            ends: [tri.v[(k + 1) % 3], tri.v[(k + 2) % 3]],
            beside: tri.beside[k],
            locked: tri.locked[k],
        })
    }

    /// Tells triangle `t` that `to` now lies across its side `ends`.
    fn point_back(&mut self, t: u32, ends: [u32; 2], to: u32) {
        let mut tri = self.triangles[t as usize];
        for k in 0..3 {
            if [tri.v[(k + 1) % 3], tri.v[(k + 2) % 3]] == ends {
                tri.beside[k] = to;
            }
        }
        self.set_triangle(t, tri);
    }

    fn set_triangle(&mut self, t: u32, tri: Tri) {
        if t as usize == self.triangles.len() {
            self.triangles.push(tri);
            return;
        }
        let old = self.triangles[t as usize];
        self.log(Undo::Triangle(t, old));
        self.triangles[t as usize] = tri;
    }

    fn set_at(&mut self, v: u32, t: u32) {
        let old = self.at[v as usize];
        self.log(Undo::At(v, old));
        self.at[v as usize] = t;
    }

    fn log(&mut self, undo: Undo) {
        if let Some(trial) = &mut self.trial {
            trial.undo.push(undo);
        }
    }

    /// Notes the quality of a triangle before its first change.
    fn touch(&mut self, t: u32) {
        if self.trial.is_none() || !self.is_alive(t) {
            return;
        }
        let quality = self.quality(t);
        if let Some(trial) = &mut self.trial
            && (t as usize) < trial.triangles
            && !trial.touched.contains(&t)
        {
            trial.touched.push(t);
            trial.before = trial.before.with(quality);
        }
    }
}

/// A directed side of a triangle that is being replaced.
struct DirectedSide {
    ends: [u32; 2],
    beside: u32,
    locked: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of fixed corners 0 to 3 round the free vertex 4.
    fn square() -> Patch {
        let at = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.4)];
        let points = at.map(|(x, y)| Vec2::new(x, y)).to_vec();
        Patch::new(points, 4, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], &[])
    }

    #[test]
    fn stars_are_whole_inside_and_open_on_the_rim() {
        let patch = square();
        assert_eq!(patch.star(4).len(), 4);
        assert_eq!(patch.star(0).iter().map(|&t| patch.corners(t)).collect::<Vec<_>>(), [[0, 1, 4], [3, 0, 4]]);
        assert_eq!(patch.beside(4, 1).map(|pair| pair.map(|t| patch.corners(t))), Some([[1, 2, 4], [0, 1, 4]]));
        assert_eq!(patch.beside(0, 1), None);
    }

    #[test]
    fn a_refused_change_leaves_no_trace() {
        let mut patch = square();
        let before = format!("{:?} {:?} {:?}", patch.points, patch.triangles, patch.at);
        patch.begin();
        let v = patch.add(Vec2::new(0.5, 0.2));
        patch.replace(&[0], &[[0, 1, v], [1, 4, v], [4, 0, v]]);
        patch.move_to(4, Vec2::new(0.5, 0.6));
        assert!(!patch.end(|_, _| false));
        assert_eq!(before, format!("{:?} {:?} {:?}", patch.points, patch.triangles, patch.at));
    }

    #[test]
    fn a_vertex_that_is_replaced_is_gone() {
        let mut patch = square();
        let star = patch.star(4);
        patch.replace(&star, &[[0, 1, 2], [0, 2, 3]]);
        assert!(patch.star(4).is_empty());
        let (points, triangles) = patch.finish();
        assert_eq!((points.len(), triangles.len()), (4, 2));
    }
}
