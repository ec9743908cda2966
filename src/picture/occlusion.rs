//! Ambient occlusion: the share of the surroundings that a point of the surface sees.
//!
//! The scene is rendered as depth maps from directions all round. A point sees a direction if nothing in that
//! direction's map lies in front of it. Coarse maps suffice for the soft dark under arms and hems.

use rayon::prelude::*;

use super::camera::SMALLEST;
use crate::geometry::{TriMesh, Vec3, box_of};

/// Directions, spread evenly over the sphere.
const DIRECTIONS: usize = 28;
/// Side of a depth map, cells: about a centimetre each for a person.
const CELLS: usize = 176;
/// Distance by which points are lifted off their surface, as a share of the scene's radius (about 10 mm for a person).
/// Surfaces in front by less do not hide them. It is larger than the error of the maps.
const LIFT: f64 = 0.011;

/// Depth maps from all directions.
pub(super) struct Surroundings {
    maps: Vec<DepthMap>,
    lift: f64,
}

/// The scene seen from far away.
struct DepthMap {
    toward: Vec3,
    right: Vec3,
    up: Vec3,
    center: Vec3,
    /// Cells per metre.
    scale: f64,
    nearness: Vec<f32>,
}

impl Surroundings {
    pub(super) fn new(meshes: &[&TriMesh]) -> Self {
        let points = || meshes.iter().flat_map(|m| &m.vertices);
        let [lo, hi] = box_of(points().copied());
        let center = (lo + hi) / 2.0;
        let radius = points().map(|p| (p - center).norm()).fold(SMALLEST, f64::max);
        let map = |k: usize| {
            let mut map = DepthMap::new(direction(k), center, 0.5 * (CELLS as f64 - 2.0) / radius);
            meshes.iter().for_each(|m| map.add(m));
            map
        };
        Self { maps: (0..DIRECTIONS).into_par_iter().map(map).collect(), lift: LIFT * radius }
    }

    /// Share of the half-space above the surface that is seen from each point, weighted as a matte surface weighs it.
    pub(super) fn seen(&self, points: &[Vec3], normals: &[Vec3]) -> Vec<f32> {
        points.par_iter().zip(normals).map(|(p, n)| self.seen_from(p, n)).collect()
    }

    fn seen_from(&self, point: &Vec3, normal: &Vec3) -> f32 {
        let lifted = point + normal * self.lift;
        let (mut seen, mut all) = (0.0, 0.0);
        for map in &self.maps {
            let weight = normal.dot(&map.toward).max(0.0) as f32;
            if weight > 0.0 {
                all += weight;
                seen += weight * map.open(&lifted, self.lift as f32);
            }
        }
        if all > 0.0 { seen / all } else { 1.0 }
    }
}

/// The `k`-th of evenly spread directions (a spiral of golden angles).
fn direction(k: usize) -> Vec3 {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let height = 1.0 - (2.0 * k as f64 + 1.0) / DIRECTIONS as f64;
    let (sin, cos) = (golden * k as f64).sin_cos();
    let across = (1.0 - height * height).sqrt();
    Vec3::new(across * cos, height, across * sin)
}

impl DepthMap {
    fn new(toward: Vec3, center: Vec3, scale: f64) -> Self {
        let aside = if toward.y.abs() < 0.9 { Vec3::y() } else { Vec3::x() };
        let right = aside.cross(&toward).normalize();
        let up = toward.cross(&right);
        Self { toward, right, up, center, scale, nearness: vec![f32::NEG_INFINITY; CELLS * CELLS] }
    }

    /// Column, row and nearness.
    fn project(&self, p: &Vec3) -> [f32; 3] {
        let at = p - self.center;
        let cell = |axis: &Vec3| (axis.dot(&at) * self.scale + 0.5 * CELLS as f64) as f32;
        [cell(&self.right), cell(&self.up), self.toward.dot(&at) as f32]
    }

    fn add(&mut self, mesh: &TriMesh) {
        let at: Vec<[f32; 3]> = mesh.vertices.iter().map(|p| self.project(p)).collect();
        for t in &mesh.triangles {
            self.triangle(t.map(|v| at[v as usize]));
        }
    }

    /// Marks the cells whose centre a triangle covers, and the cell of its own centre, so that none is too small.
    fn triangle(&mut self, [a, b, c]: [[f32; 3]; 3]) {
        let middle = [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0);
        self.mark(middle[0] as usize, middle[1] as usize, middle[2]);
        let first = |k: usize| (a[k].min(b[k]).min(c[k]) - 0.5).ceil() as usize;
        let last = |k: usize| ((a[k].max(b[k]).max(c[k]) - 0.5).floor() as usize).min(CELLS - 1);
        let double_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        for y in first(1)..=last(1) {
            for x in first(0)..=last(0) {
                let (dx, dy) = (x as f32 + 0.5 - a[0], y as f32 + 0.5 - a[1]);
                let wb = (dx * (c[1] - a[1]) - dy * (c[0] - a[0])) / double_area;
                let wc = (dy * (b[0] - a[0]) - dx * (b[1] - a[1])) / double_area;
                if wb >= 0.0 && wc >= 0.0 && wb + wc <= 1.0 {
                    self.mark(x, y, a[2] + wb * (b[2] - a[2]) + wc * (c[2] - a[2]));
                }
            }
        }
    }

    fn mark(&mut self, x: usize, y: usize, near: f32) {
        let held = &mut self.nearness[y.min(CELLS - 1) * CELLS + x.min(CELLS - 1)];
        *held = held.max(near);
    }

    /// Share of the four nearest cells, by distance from their centres, in which nothing lies in front of the point.
    fn open(&self, p: &Vec3, slack: f32) -> f32 {
        let [x, y, near] = self.project(p);
        let (fx, fy) = (x - 0.5, y - 0.5);
        let (tx, ty) = (fx - fx.floor(), fy - fy.floor());
        let is_open = |dx: f32, dy: f32| {
            let (cx, cy) = (fx.floor() + dx, fy.floor() + dy);
            let outside = cx < 0.0 || cy < 0.0 || cx >= CELLS as f32 || cy >= CELLS as f32;
            let open = outside || self.nearness[cy as usize * CELLS + cx as usize] <= near + slack;
            if open { 1.0 } else { 0.0 }
        };
        let row = |dy: f32| (1.0 - tx) * is_open(0.0, dy) + tx * is_open(1.0, dy);
        (1.0 - ty) * row(0.0) + ty * row(1.0)
    }
}
