//! Position of the viewer, and projection onto the paper.

use super::layout::PictureLayout;
use crate::geometry::{TriMesh, Vec3};

/// The viewer looks down by this angle (radians): hems become flat ellipses, and the floor is seen.
const LOOK_DOWN: f64 = 0.07;

/// Pixels kept free above the views, for the title.
pub(super) const HEAD: usize = 110;
/// Pixels kept free below the views, for their names.
pub(super) const FOOT: usize = 84;

/// Width of paper between two views, pixels, so that a view that is cut off is seen to be.
const GUTTER: usize = 36;

/// Margin round the framed objects, as a share of their height.
const AIR: f64 = 0.06;

/// Least height of a framed object, metres: a single point has no scale.
pub(super) const SMALLEST: f64 = 1e-3;

/// A view is at least this wide, as a share of the greatest width or height in any view.
const NARROWEST: f64 = 0.3;

/// A garment that covers this share of the body's height is shown with the whole body.
const WHOLE_BODY: f64 = 0.5;

/// One of the views.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    /// Written below it.
    pub(super) name: &'static str,
    /// Unit vectors: rightwards and upwards on the paper, and towards the viewer.
    pub(super) right: Vec3,
    pub(super) up: Vec3,
    pub(super) toward: Vec3,
    /// First column and row of its panel on the canvas, pixels.
    pub(super) left: usize,
    pub(super) top: usize,
    /// Size of the panel, pixels.
    pub(super) width: usize,
    pub(super) height: usize,
    /// Centre of the panel, metres along `right` and `up`.
    center: [f64; 2],
    /// Pixels per metre, the same in all views.
    pub(super) scale: f64,
    /// Direction to the key light: rightwards, upwards, towards the viewer (not unit length).
    pub(super) key_from: [f64; 3],
}

impl Camera {
    /// A camera without a panel. It is turned by `yaw` about the vertical and looks down by `dip`, radians.
    fn looking_from(name: &'static str, yaw: f64, dip: f64) -> Self {
        let (sin, cos) = yaw.sin_cos();
        let (dip_sin, dip_cos) = dip.sin_cos();
        let right = Vec3::new(cos, 0.0, -sin);
        let toward = Vec3::new(sin * dip_cos, dip_sin, cos * dip_cos);
        let up = toward.cross(&right);
        let (center, scale, key_from) = ([0.0; 2], 1.0, KEY_FROM);
        Self { name, right, up, toward, left: 0, top: 0, width: 0, height: 0, center, scale, key_from }
    }

    /// Column and row in the panel (pixels), and nearness to the viewer (metres).
    pub(super) fn project(&self, p: &Vec3) -> [f32; 3] {
        let x = (self.right.dot(p) - self.center[0]) * self.scale + 0.5 * self.width as f64;
        let y = (self.center[1] - self.up.dot(p)) * self.scale + 0.5 * self.height as f64;
        [x as f32, y as f32, self.toward.dot(p) as f32]
    }

    /// Extent of the points along `right` and `up`: lows and highs.
    fn extent(&self, points: &[Vec3]) -> [[f64; 2]; 2] {
        points.iter().fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[lo, hi], p| {
            let at = [self.right.dot(p), self.up.dot(p)];
            [[lo[0].min(at[0]), lo[1].min(at[1])], [hi[0].max(at[0]), hi[1].max(at[1])]]
        })
    }
}

/// The key light of a dressed mannequin.
const KEY_FROM: [f64; 3] = [-0.55, 0.62, 0.70];
/// The key light of a sheet of specimens: low from the left. Light along the view shows no folds in cloth that lies.
const KEY_FROM_ASIDE: [f64; 3] = [-0.95, 0.30, 0.20];

/// Angle by which the viewer of a sheet of specimens stands to the right, radians.
const ASIDE: f64 = 0.45;
/// Angle by which the viewer of a sheet of specimens looks down, radians: folds and heights are both visible.
const FROM_ABOVE: f64 = 0.62;

/// One camera from above at an angle for each list of points, all at one scale, each as large as a panel of this
/// `width` and `height` (pixels) allows the largest.
pub(super) fn cameras_above(shapes: &[&[Vec3]], [width, height]: [usize; 2]) -> Vec<Camera> {
    let camera = Camera { width, height, key_from: KEY_FROM_ASIDE, ..Camera::looking_from("", ASIDE, FROM_ABOVE) };
    let extents: Vec<[[f64; 2]; 2]> = shapes.iter().map(|points| camera.extent(points)).collect();
    let largest = |axis: usize| extents.iter().map(|[lo, hi]| hi[axis] - lo[axis]).fold(SMALLEST, f64::max);
    let room = |pixels: usize, axis: usize| pixels as f64 / ((1.0 + 2.0 * AIR) * largest(axis));
    let scale = room(width, 0).min(room(height, 1));
    let center = |[lo, hi]: [[f64; 2]; 2]| [0, 1].map(|axis| (lo[axis] + hi[axis]) / 2.0);
    extents.into_iter().map(|extent| Camera { scale, center: center(extent), ..camera }).collect()
}

/// The views of a layout, at one scale and as large as the paper allows.
pub(super) fn cameras(body: &TriMesh, cloth: &TriMesh, layout: &PictureLayout) -> Vec<Camera> {
    let camera = |view: &super::ViewSide| Camera::looking_from(view.label(), view.yaw(), LOOK_DOWN);
    let mut cameras: Vec<Camera> = layout.views.iter().map(camera).collect();
    let count = cameras.len();
    let framed = framed(body, cloth);
    let extents: Vec<[[f64; 2]; 2]> = cameras.iter().map(|c| c.extent(&framed)).collect();
    let size = |k: usize, axis: usize| extents[k][1][axis] - extents[k][0][axis];
    let height = (0..count).map(|k| size(k, 1)).fold(SMALLEST, f64::max);
    let air = 2.0 * AIR * height;
    let largest = (0..count).map(|k| size(k, 0)).fold(height, f64::max);
    let width = |k: usize| size(k, 0).max(NARROWEST * largest) + air;
    let widths: f64 = (0..count).map(width).sum();
    let [paper, panel] = [layout.size[0], layout.size[1] - HEAD - FOOT];
    let scale = (paper as f64 / widths).min(panel as f64 / (height + air));
    let spare = (paper as f64 - widths * scale) / count as f64;
    let mut left = 0.0;
    for (k, camera) in cameras.iter_mut().enumerate() {
        let right = left + width(k) * scale + spare;
        camera.scale = scale;
        camera.center = [0, 1].map(|axis| (extents[k][0][axis] + extents[k][1][axis]) / 2.0);
        (camera.top, camera.height) = (HEAD, panel);
        camera.left = left.round() as usize + GUTTER / 2;
        camera.width = (right.round() as usize).min(paper) - GUTTER / 2 - camera.left;
        left = right;
    }
    cameras
}

/// A view of all of it from every side: cameras turned round the vertical in `count` steps, at one scale, each with a
/// panel of this size, pixels.
pub(super) fn cameras_round(body: &TriMesh, cloth: &TriMesh, count: usize, [width, height]: [usize; 2]) -> Vec<Camera> {
    let framed = framed(body, cloth);
    let yaw = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
    let mut cameras: Vec<Camera> = (0..count).map(|k| Camera::looking_from("", yaw(k), LOOK_DOWN)).collect();
    let extents: Vec<[[f64; 2]; 2]> = cameras.iter().map(|c| c.extent(&framed)).collect();
    let largest = |axis: usize| extents.iter().map(|[lo, hi]| hi[axis] - lo[axis]).fold(SMALLEST, f64::max);
    let room = |pixels: usize, axis: usize| pixels as f64 / ((1.0 + 2.0 * AIR) * largest(axis));
    let scale = room(width, 0).min(room(height, 1));
    for (camera, [lo, hi]) in cameras.iter_mut().zip(&extents) {
        (camera.width, camera.height, camera.scale) = (width, height, scale);
        // The axis of the turn stays in the middle.
        camera.center = [0.0, (lo[1] + hi[1]) / 2.0];
    }
    cameras
}

/// The points that must be seen: the garment, or all of the body too. Arms that reach out beside a shirt are cut off
/// rather than making the shirt small.
fn framed(body: &TriMesh, cloth: &TriMesh) -> Vec<Vec3> {
    let height = |points: &[Vec3]| {
        let y = points.iter().map(|p| p.y);
        y.clone().fold(f64::NEG_INFINITY, f64::max) - y.fold(f64::INFINITY, f64::min)
    };
    let whole = height(&cloth.vertices) > WHOLE_BODY * height(&body.vertices);
    let body = if whole { body.vertices.as_slice() } else { &[] };
    cloth.vertices.iter().chain(body).copied().collect()
}
