//! Points inside a closed body.
//!
//! How often the body's surface winds round a point is the sum of the solid angles of its triangles, over 4π: one
//! inside, nothing outside, and still well defined where a scanned body has a hole or runs through itself. Far groups
//! of triangles are taken as one small patch each. Near ones are summed exactly.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::bvh::{Bvh, BvhContents};
use crate::geometry::{TriMesh, Vec3};

/// Points this near to the surface (metres) touch it: the resolution of the files written.
const TOUCH: f64 = 1e-9;

/// A group of triangles counts as far from this many of its radii on. At 2 the winding number is good to 0.02, and
/// only 0.5 decides.
const FAR: f64 = 2.0;

/// Points that are inside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inside {
    /// Their indices, rising.
    pub points: Vec<u32>,
    /// Depth of the deepest below the surface, metres. Zero when there is none.
    pub deepest: f64,
    /// The deepest.
    pub deepest_point: Option<u32>,
}

impl Inside {
    /// Number of points inside.
    pub fn count(&self) -> usize {
        self.points.len()
    }
}

/// The `points` that lie inside `body`, a closed mesh whose triangles run counter-clockwise seen from outside.
/// Points within a nanometre of the surface are not inside.
pub fn inside(points: &[Vec3], body: &TriMesh) -> Inside {
    let tree = Bvh::new(body);
    let patches = patches(body, &tree);
    let depth: Vec<f64> = points
        .par_iter()
        .map(|p| if winding(body, &tree, &patches, p) > 0.5 { tree.distance(body, p) } else { 0.0 })
        .collect();
    let mut out = Inside::default();
    for (k, &d) in depth.iter().enumerate().filter(|(_, d)| **d > TOUCH) {
        out.points.push(k as u32);
        if d > out.deepest {
            (out.deepest, out.deepest_point) = (d, Some(k as u32));
        }
    }
    out
}

/// Distance of every one of `points` from the surface of `body`, metres.
pub fn distances(points: &[Vec3], body: &TriMesh) -> Vec<f64> {
    let tree = Bvh::new(body);
    points.par_iter().map(|p| tree.distance(body, p)).collect()
}

/// All triangles below a node as one small patch.
#[derive(Clone, Copy)]
struct TriangleCluster {
    /// Sum of the area vectors.
    area: Vec3,
    /// Area-weighted centre.
    center: Vec3,
    /// Every triangle lies within this distance of the centre.
    radius: f64,
}

/// One patch per node of the tree.
fn patches(mesh: &TriMesh, tree: &Bvh) -> Vec<TriangleCluster> {
    let mut sums = vec![(Vec3::zeros(), Vec3::zeros(), 0.0); tree.nodes.len()];
    // Children come after their parent, so backwards every node finds its children done.
    for at in (0..tree.nodes.len()).rev() {
        sums[at] = match tree.nodes[at].held {
            BvhContents::Nodes { left, right } => add(sums[left as usize], sums[right as usize]),
            BvhContents::Triangles { start, end } => {
                tree.order[start as usize..end as usize].iter().fold((Vec3::zeros(), Vec3::zeros(), 0.0), |sum, &t| {
                    let area = mesh.double_normal(t as usize) / 2.0;
                    let [a, b, c] = mesh.corners(t as usize);
                    add(sum, (area, (a + b + c) / 3.0 * area.norm(), area.norm()))
                })
            }
        };
    }
    let patch = |(&(area, moment, size), node): (&(Vec3, Vec3, f64), &super::bvh::BvhNode)| {
        let center = if size > 0.0 { moment / size } else { (node.bounds.lo + node.bounds.hi) / 2.0 };
        TriangleCluster { area, center, radius: node.bounds.farthest(&center) }
    };
    sums.iter().zip(&tree.nodes).map(patch).collect()
}

fn add(a: (Vec3, Vec3, f64), b: (Vec3, Vec3, f64)) -> (Vec3, Vec3, f64) {
    (a.0 + b.0, a.1 + b.1, a.2 + b.2)
}

/// Winding number of the surface round `p`.
fn winding(mesh: &TriMesh, tree: &Bvh, patches: &[TriangleCluster], p: &Vec3) -> f64 {
    // Outside the box of a closed surface nothing winds round a point.
    if tree.nodes.first().is_none_or(|root| root.bounds.squared_distance(p) > 0.0) {
        return 0.0;
    }
    let mut angle = 0.0;
    let mut open = vec![0u32];
    while let Some(at) = open.pop() {
        let patch = &patches[at as usize];
        let to = patch.center - p;
        let distance = to.norm();
        if distance > FAR * patch.radius {
            angle += patch.area.dot(&to) / distance.powi(3);
            continue;
        }
        match tree.nodes[at as usize].held {
            BvhContents::Nodes { left, right } => open.extend([left, right]),
            BvhContents::Triangles { start, end } => {
                let near = tree.order[start as usize..end as usize].iter();
                angle += near.map(|&t| solid_angle(p, &mesh.corners(t as usize))).sum::<f64>();
            }
        }
    }
    angle / (4.0 * PI)
}

/// Signed solid angle of a triangle seen from `p` (van Oosterom and Strackee, 1983).
fn solid_angle(p: &Vec3, corners: &[Vec3; 3]) -> f64 {
    let [a, b, c] = corners.map(|q| q - p);
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let volume = a.dot(&b.cross(&c));
    let cosines = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * volume.atan2(cosines)
}
