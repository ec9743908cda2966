//! From the scene to the canvas.

use std::ops::Range;

use rayon::prelude::*;

use super::camera::{Camera, FOOT, cameras};
use super::canvas::Canvas;
use super::color::{BODY, INK, PALE_INK, PAPER, RIM, Rgb, SEAM, piece};
use super::light::Lights;
use super::occlusion::Surroundings;
use super::on_cloth::{LineSegment, lines};
use super::paint::Paint;
use super::raster::{LinePiece, NO_CLOTH, PanelRows, SAMPLES, ScreenCorner};
use super::{PictureLayout, Scale, Scene, WIDTH};
use crate::geometry::{TriMesh, Vec3};

/// Rows of pixels drawn at a time: the samples of a band fit in the processor's cache.
const BAND: usize = 64;

/// Half the width of drawn seams, pixels.
const SEAM_RADIUS: f32 = 0.95;
/// Half the width of drawn rims, pixels.
const RIM_RADIUS: f32 = 0.7;

/// Lines are drawn as if this much nearer (metres) than the cloth they lie on, which would hide them. Less than the
/// distance from one side of a body to the other by far.
pub(super) const LINE_LIFT: f32 = 0.004;

/// Cells along each side of the floor.
const FLOOR_CELLS: u32 = 48;
/// Margin of the floor beyond the objects on it, metres.
const FLOOR_MARGIN: f64 = 0.35;
/// The floor is this far below the lowest point, metres: flat cloth on the very floor would be drawn half through it.
const FLOOR_GAP: f64 = 1e-3;

/// Draws the whole picture.
pub(super) fn render(scene: &Scene, layout: &PictureLayout) -> Canvas {
    let paint = Paint::new(scene);
    let lit = Lit::new(scene);
    let cameras = cameras(scene.body, scene.cloth, layout);
    let panels: Vec<PicturePanel> = cameras.par_iter().map(|c| PicturePanel::new(scene, &lit, &paint, c)).collect();
    let mut canvas = Canvas::new(layout.size[0], layout.size[1], PAPER);
    paste(&mut canvas, &panels);
    words(&mut canvas, scene, &cameras, &paint, layout.size[1]);
    canvas
}

/// Draws panels onto the canvas.
pub(super) fn paste(canvas: &mut Canvas, panels: &[PicturePanel]) {
    let bands: Vec<(&PicturePanel, usize)> =
        panels.iter().flat_map(|p| (0..p.triangle_bands.len()).map(move |b| (p, b))).collect();
    let pixels: Vec<Vec<u8>> = bands.par_iter().map(|(panel, b)| panel.band(*b)).collect();
    for ((panel, b), pixels) in bands.iter().zip(&pixels) {
        canvas.paste(panel.left, panel.top + b * BAND, panel.width, pixels);
    }
}

/// Normals, how much of its surroundings every vertex sees, and the lines. The same in all views.
pub(super) struct Lit {
    body_normals: Vec<Vec3>,
    body_seen: Vec<f32>,
    cloth_normals: Vec<Vec3>,
    /// Seen from the right side of the cloth, and from the wrong one.
    cloth_seen: [Vec<f32>; 2],
    floor: TriMesh,
    floor_seen: Vec<f32>,
    pub(super) lines: Vec<LineSegment>,
}

impl Lit {
    pub(super) fn new(scene: &Scene) -> Self {
        Self::over(scene, floor(scene))
    }

    /// Over a floor, which may be empty.
    pub(super) fn over(scene: &Scene, floor: TriMesh) -> Self {
        let around = Surroundings::new(&[scene.body, scene.cloth]);
        let (body_normals, cloth_normals) = (scene.body.vertex_normals(), scene.cloth.vertex_normals());
        let turned: Vec<Vec3> = cloth_normals.iter().map(|n| -n).collect();
        let up = vec![Vec3::y(); floor.vertices.len()];
        Self {
            body_seen: around.seen(&scene.body.vertices, &body_normals),
            cloth_seen: [&cloth_normals, &turned].map(|n| around.seen(&scene.cloth.vertices, n)),
            floor_seen: around.seen(&floor.vertices, &up),
            body_normals,
            cloth_normals,
            floor,
            lines: lines(scene, &[(scene.seams, SEAM_RADIUS, SEAM), (scene.rims, RIM_RADIUS, RIM)], LINE_LIFT),
        }
    }
}

/// A square of floor below everything.
fn floor(scene: &Scene) -> TriMesh {
    let points = || scene.body.vertices.iter().chain(&scene.cloth.vertices);
    let low = points().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let reach = points().map(|p| p.x.abs().max(p.z.abs())).fold(0.0, f64::max) + FLOOR_MARGIN;
    let n = FLOOR_CELLS + 1;
    let at = |k: u32| reach * (2.0 * f64::from(k) / f64::from(FLOOR_CELLS) - 1.0);
    let mut floor = TriMesh::default();
    floor.vertices.extend((0..n * n).map(|k| Vec3::new(at(k % n), low - FLOOR_GAP, at(k / n))));
    for k in (0..n * FLOOR_CELLS).filter(|k| k % n < FLOOR_CELLS) {
        floor.triangles.extend([[k, k + n, k + 1], [k + 1, k + n, k + n + 1]]);
    }
    floor
}

/// Everything one view shows, projected, and sorted into bands.
pub(super) struct PicturePanel<'a> {
    /// First column and row on the canvas, and size, pixels.
    left: usize,
    top: usize,
    width: usize,
    height: usize,
    /// With the triangle of the cloth each one is. Those are the last.
    triangles: Vec<([ScreenCorner; 3], u32)>,
    first_cloth: usize,
    strokes: Vec<LinePiece<'a>>,
    triangle_bands: Vec<Vec<u32>>,
    stroke_bands: Vec<Vec<u32>>,
}

impl<'a> PicturePanel<'a> {
    pub(super) fn new(scene: &Scene, lit: &'a Lit, paint: &Paint, camera: &Camera) -> Self {
        let around = floor_triangles(lit, camera).into_iter().chain(body_triangles(scene, lit, camera));
        let mut triangles: Vec<_> = around.map(|corners| (corners, NO_CLOTH)).collect();
        let first_cloth = triangles.len();
        triangles.extend(cloth_triangles(scene, lit, paint, camera).into_iter().zip(0..));
        let strokes: Vec<LinePiece> = lit.lines.iter().map(|line| stroke(line, camera)).collect();
        let rows = |at: &[[f32; 3]], radius: f32| {
            let y = at.iter().map(|p| p[1]);
            (y.clone().fold(f32::INFINITY, f32::min) - radius, y.fold(f32::NEG_INFINITY, f32::max) + radius)
        };
        let &Camera { left, top, width, height, .. } = camera;
        let triangle_bands = sorted(height, triangles.iter().map(|(t, _)| rows(&t.map(|c| c.at), 0.0)));
        let stroke_bands = sorted(height, strokes.iter().map(|s| rows(&s.ends, s.radius)));
        Self { left, top, width, height, triangles, first_cloth, strokes, triangle_bands, stroke_bands }
    }

    /// Pixels of a band.
    fn band(&self, index: usize) -> Vec<u8> {
        let rows = band_rows(self.height, index);
        let mut band = PanelRows::new(self.width * SAMPLES, rows.start * SAMPLES, rows.len() * SAMPLES);
        for &t in &self.triangle_bands[index] {
            let (corners, cloth) = &self.triangles[t as usize];
            band.triangle(corners, *cloth);
        }
        for &s in &self.stroke_bands[index] {
            band.stroke(&self.strokes[s as usize], &self.triangles[self.first_cloth..]);
        }
        band.pixels()
    }
}

/// Pixel rows of a band of a panel of this height.
fn band_rows(height: usize, index: usize) -> Range<usize> {
    index * BAND..((index + 1) * BAND).min(height)
}

/// For every band of a panel of this height (pixels) the indices of the things that reach into it. `rows` are the
/// lowest and the highest row of each, in samples.
fn sorted(height: usize, rows: impl Iterator<Item = (f32, f32)>) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); height.div_ceil(BAND)];
    let band_height = (BAND * SAMPLES) as f32;
    for (k, (top, bottom)) in rows.enumerate() {
        if bottom < 0.0 {
            continue;
        }
        let first = (top / band_height).max(0.0) as usize;
        let last = ((bottom / band_height) as usize).min(bands.len() - 1);
        for band in bands.iter_mut().take(last + 1).skip(first) {
            band.push(k as u32);
        }
    }
    bands
}

fn in_samples(camera: &Camera, p: &Vec3) -> [f32; 3] {
    let [x, y, near] = camera.project(p);
    [x * SAMPLES as f32, y * SAMPLES as f32, near]
}

/// The floor: paper, darker where little sky is seen, fading into the paper towards its edge.
fn floor_triangles(lit: &Lit, camera: &Camera) -> Vec<[ScreenCorner; 3]> {
    let reach = lit.floor.vertices.iter().map(|p| p.x).fold(f64::MIN_POSITIVE, f64::max);
    let corners: Vec<ScreenCorner> = lit
        .floor
        .vertices
        .iter()
        .zip(&lit.floor_seen)
        .map(|(p, seen)| {
            let fade = (1.0 - (p.x.hypot(p.z) / reach).powi(2)).max(0.0) as f32;
            let shade = 1.0 - 0.42 * fade * (1.0 - seen);
            ScreenCorner { at: in_samples(camera, p), color: PAPER.map(|x| x * shade) }
        })
        .collect();
    lit.floor.triangles.iter().map(|t| t.map(|v| corners[v as usize])).collect()
}

fn body_triangles(scene: &Scene, lit: &Lit, camera: &Camera) -> Vec<[ScreenCorner; 3]> {
    let lights = Lights::new(camera);
    let corner = |v: usize| ScreenCorner {
        at: in_samples(camera, &scene.body.vertices[v]),
        color: times(BODY, lights.on(&lit.body_normals[v], lit.body_seen[v])),
    };
    let corners: Vec<ScreenCorner> = (0..scene.body.vertices.len()).map(corner).collect();
    let toward = (0..scene.body.triangles.len()).filter(|&t| scene.body.double_normal(t).dot(&camera.toward) > 0.0);
    toward.map(|t| scene.body.triangles[t].map(|v| corners[v as usize])).collect()
}

fn cloth_triangles(scene: &Scene, lit: &Lit, paint: &Paint, camera: &Camera) -> Vec<[ScreenCorner; 3]> {
    let lights = Lights::new(camera);
    let count = scene.cloth.vertices.len();
    let at: Vec<[f32; 3]> = scene.cloth.vertices.iter().map(|p| in_samples(camera, p)).collect();
    let right: Vec<Rgb> = (0..count).map(|v| lights.on(&lit.cloth_normals[v], lit.cloth_seen[0][v])).collect();
    let wrong: Vec<Rgb> = (0..count).map(|v| lights.on(&-lit.cloth_normals[v], lit.cloth_seen[1][v])).collect();
    let triangle = |t: usize| {
        let right_side = scene.cloth.double_normal(t).dot(&camera.toward) > 0.0;
        let light = if right_side { &right } else { &wrong };
        let paint = paint.corners(scene, t, right_side);
        let vertices = scene.cloth.triangles[t].map(|v| v as usize);
        [0, 1, 2].map(|k| ScreenCorner { at: at[vertices[k]], color: times(paint[k], light[vertices[k]]) })
    };
    (0..scene.cloth.triangles.len()).map(triangle).collect()
}

fn times(a: Rgb, b: Rgb) -> Rgb {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

fn stroke<'a>(line: &'a LineSegment, camera: &Camera) -> LinePiece<'a> {
    let ends = line.ends.map(|p| in_samples(camera, &p));
    LinePiece { ends, radius: line.radius * SAMPLES as f32, color: line.color, around: &line.around, lift: line.lift }
}

/// Title, names of the views, scale, legend.
/// `height` is that of the views with what stands above and below, pixels.
pub(super) fn words(canvas: &mut Canvas, scene: &Scene, cameras: &[Camera], paint: &Paint, height: usize) {
    const LEFT: f32 = 56.0;
    let letters = lettering(canvas);
    let end = canvas.text(scene.title, [LEFT, 72.0], 5.0 * letters, INK);
    let room = canvas.width as f32 - LEFT - (end + 34.0);
    let size = (3.0 * room / Canvas::text_width(scene.subtitle, 3.0)).clamp(1.5, 3.0) * letters;
    canvas.text(scene.subtitle, [end + 34.0, 72.0], size, PALE_INK);
    let foot = (height - FOOT / 2 + 12) as f32;
    for camera in cameras {
        let middle = camera.left as f32 + 0.5 * camera.width as f32;
        let size = 3.4 * letters;
        canvas.text(camera.name, [middle - 0.5 * Canvas::text_width(camera.name, size), foot], size, INK);
    }
    if let Some(camera) = cameras.first() {
        scale_bar(canvas, camera.scale, foot);
    }
    if let Paint::Values(_, scale, limit) = paint {
        legend(canvas, *scale, *limit, scale.title());
    }
    groups(canvas, scene.groups);
}

/// Size of the letters of a picture, as a share of those of one that is [`WIDTH`] pixels wide.
fn lettering(canvas: &Canvas) -> f32 {
    /// Letters of this share are still read.
    const SMALLEST: f32 = 0.6;
    (canvas.width as f32 / WIDTH as f32).clamp(SMALLEST, 1.0)
}

/// A bar of a round length, at the right below.
pub(super) fn scale_bar(canvas: &mut Canvas, pixels_per_metre: f64, foot: f32) {
    let millimetres = if pixels_per_metre > 1500.0 { 50.0 } else { 100.0 };
    let length = (millimetres / 1000.0 * pixels_per_metre) as f32;
    let right = canvas.width as f32 - 56.0;
    let (left, y) = (right - length, foot - 6.0);
    canvas.line([left, y], [right, y], 1.2, PALE_INK);
    [left, right].iter().for_each(|&x| canvas.line([x, y - 8.0], [x, y + 8.0], 1.2, PALE_INK));
    let text = format!("{millimetres:.0} mm");
    let size = 2.6 * lettering(canvas);
    canvas.text(&text, [left - 18.0 - Canvas::text_width(&text, size), foot], size, PALE_INK);
}

impl Scale {
    fn title(self) -> &'static str {
        match self {
            Self::Strain => "warp and weft strain",
            Self::Ease => "distance to the skin",
            Self::Pressure => "pressure on the skin",
        }
    }

    /// Labels at the left end, the middle and the right end.
    fn labels(self, limit: f64) -> [String; 3] {
        match self {
            Self::Strain => [format!("-{} %", 100.0 * limit), "0".into(), format!("+{} %", 100.0 * limit)],
            Self::Ease => ["0".into(), String::new(), format!("{limit} mm")],
            Self::Pressure => ["0".into(), String::new(), format!("{limit} kPa")],
        }
    }
}

/// Colours and names of groups of pieces, at the right above, from right to left.
fn groups(canvas: &mut Canvas, names: &[String]) {
    const SQUARE: usize = 24;
    let mut right = canvas.width as f32 - 56.0;
    for (k, name) in names.iter().enumerate().rev() {
        let left = right - Canvas::text_width(name, 2.6);
        canvas.text(name, [left, 56.0], 2.6, PALE_INK);
        let square = left - SQUARE as f32 - 12.0;
        if square < 0.0 {
            break;
        }
        canvas.fill([square as usize, 34], [SQUARE, SQUARE], piece(k as u32));
        right = square - 30.0;
    }
}

/// The scale of values, at the right above.
pub(super) fn legend(canvas: &mut Canvas, scale: Scale, limit: f64, title: &str) {
    const SIZE: [usize; 2] = [420, 22];
    const TOP: usize = 34;
    let left = canvas.width.saturating_sub(76 + SIZE[0]);
    for x in 0..SIZE[0] {
        let along = (x as f32 + 0.5) / SIZE[0] as f32;
        let share = if scale == Scale::Strain { 2.0 * along - 1.0 } else { along };
        canvas.fill([left + x, TOP], [1, SIZE[1]], scale.color(share));
    }
    for (share, label) in [-1.0, 0.0, 1.0].into_iter().zip(scale.labels(limit)) {
        let x = left as f32 + 0.5 * (share + 1.0) * SIZE[0] as f32;
        canvas.line([x, (TOP + SIZE[1]) as f32], [x, (TOP + SIZE[1] + 6) as f32], 0.9, PALE_INK);
        let middle = 0.5 * Canvas::text_width(&label, 2.4);
        canvas.text(&label, [x - middle, (TOP + SIZE[1] + 32) as f32], 2.4, PALE_INK);
    }
    canvas.text(title, [left as f32 - 44.0 - Canvas::text_width(title, 2.6), 56.0], 2.6, PALE_INK);
}
