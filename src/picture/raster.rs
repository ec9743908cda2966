//! Triangles and thick lines with a depth buffer, one band of rows at a time.

use super::color::{PAPER, Rgb};

/// Samples per pixel along each side.
pub(super) const SAMPLES: usize = 2;

/// A projected corner: column and row in samples, nearness in metres, and its displayed colour.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScreenCorner {
    pub(super) at: [f32; 3],
    pub(super) color: Rgb,
}

/// Number that stands for no triangle of the cloth.
pub(super) const NO_CLOTH: u32 = u32::MAX;

/// A piece of a drawn line, in samples.
pub(super) struct LinePiece<'a> {
    pub(super) ends: [[f32; 3]; 2],
    pub(super) radius: f32,
    pub(super) color: Rgb,
    /// The triangles of the cloth it lies on, in order. These do not hide it unless they are nearer by `lift`, metres,
    /// other cloth does. A line on none is hidden by all alike.
    pub(super) around: &'a [u32],
    pub(super) lift: f32,
}

/// Some rows of a panel, in samples.
pub(super) struct PanelRows {
    width: usize,
    first_row: usize,
    rows: usize,
    nearness: Vec<f32>,
    cloth: Vec<u32>,
    color: Vec<[u8; 4]>,
}

impl PanelRows {
    /// An empty band: paper, infinitely far.
    pub(super) fn new(width: usize, first_row: usize, rows: usize) -> Self {
        let [r, g, b] = PAPER.map(byte);
        let size = width * rows;
        Self {
            width,
            first_row,
            rows,
            nearness: vec![f32::NEG_INFINITY; size],
            cloth: vec![NO_CLOTH; size],
            color: vec![[r, g, b, 0]; size],
        }
    }

    /// Columns and rows of this band whose sample centres lie in a box. `None` when there are none.
    fn window(&self, lo: [f32; 2], hi: [f32; 2]) -> Option<[usize; 4]> {
        let first = |x: f32, from: usize| ((x - 0.5).ceil().max(from as f32)) as usize;
        let last = |x: f32, to: usize| ((x - 0.5).floor().min(to as f32 - 1.0)) as isize;
        let (x0, x1) = (first(lo[0], 0), last(hi[0], self.width));
        let (y0, y1) = (first(lo[1], self.first_row), last(hi[1], self.first_row + self.rows));
        (x0 as isize <= x1 && y0 as isize <= y1).then_some([x0, x1 as usize, y0, y1 as usize])
    }

    /// Fills a triangle, number `cloth` of the cloth, where it is nearer than the present content.
    pub(super) fn triangle(&mut self, corners: &[ScreenCorner; 3], cloth: u32) {
        let [a, b, c] = corners.map(|c| c.at);
        let lo = [a[0].min(b[0]).min(c[0]), a[1].min(b[1]).min(c[1])];
        let hi = [a[0].max(b[0]).max(c[0]), a[1].max(b[1]).max(c[1])];
        let Some([x0, x1, y0, y1]) = self.window(lo, hi) else { return };
        let Some([wb, wc]) = weights(corners) else { return };
        let plane = |k: fn(&ScreenCorner) -> f32| plane([wb, wc], corners.map(|c| k(&c)));
        let depth = plane(|c| c.at[2]);
        let tint = [plane(|c| c.color[0]), plane(|c| c.color[1]), plane(|c| c.color[2])];
        for y in y0..=y1 {
            let dy = y as f32 + 0.5 - a[1];
            let row = (y - self.first_row) * self.width;
            for x in x0..=x1 {
                let dx = x as f32 + 0.5 - a[0];
                let (b_share, c_share) = (wb[0] * dx + wb[1] * dy, wc[0] * dx + wc[1] * dy);
                if b_share < 0.0 || c_share < 0.0 || b_share + c_share > 1.0 {
                    continue;
                }
                let near = depth[0] + depth[1] * dx + depth[2] * dy;
                if near > self.nearness[row + x] {
                    self.nearness[row + x] = near;
                    self.cloth[row + x] = cloth;
                    let [r, g, b] = tint.map(|t| byte(t[0] + t[1] * dx + t[2] * dy));
                    self.color[row + x] = [r, g, b, 0];
                }
            }
        }
    }

    /// Draws a straight stroke with round ends where nothing hides it. `cloth` are the triangles of the cloth.
    pub(super) fn stroke(&mut self, stroke: &LinePiece, cloth: &[([ScreenCorner; 3], u32)]) {
        let &LinePiece { ends: [a, b], radius, color, around, lift } = stroke;
        let lo = [a[0].min(b[0]) - radius, a[1].min(b[1]) - radius];
        let hi = [a[0].max(b[0]) + radius, a[1].max(b[1]) + radius];
        let Some([x0, x1, y0, y1]) = self.window(lo, hi) else { return };
        let [r, g, blue] = color.map(byte);
        let along = [b[0] - a[0], b[1] - a[1]];
        let length2 = (along[0] * along[0] + along[1] * along[1]).max(f32::MIN_POSITIVE);
        for y in y0..=y1 {
            let dy = y as f32 + 0.5 - a[1];
            let row = (y - self.first_row) * self.width;
            for x in x0..=x1 {
                let dx = x as f32 + 0.5 - a[0];
                let t = ((dx * along[0] + dy * along[1]) / length2).clamp(0.0, 1.0);
                let (ox, oy) = (dx - t * along[0], dy - t * along[1]);
                if ox * ox + oy * oy > radius * radius {
                    continue;
                }
                let (line, shown) = (a[2] + t * (b[2] - a[2]), self.cloth[row + x]);
                let own = around.is_empty() || shown == NO_CLOTH || around.binary_search(&shown).is_ok();
                let near = if own { line + lift } else { line };
                let foot = [x as f32 + 0.5 - ox, y as f32 + 0.5 - oy];
                if near > self.nearness[row + x] && (own || near > nearness_at(&cloth[shown as usize].0, foot)) {
                    self.nearness[row + x] = near;
                    self.color[row + x] = [r, g, blue, 0];
                }
            }
        }
    }

    /// The band in pixels, three bytes each, row by row.
    pub(super) fn pixels(&self) -> Vec<u8> {
        let (columns, rows) = (self.width / SAMPLES, self.rows / SAMPLES);
        let mut out = Vec::with_capacity(3 * columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                let mut sum = [0u32; 3];
                for y in 0..SAMPLES {
                    let start = (row * SAMPLES + y) * self.width + column * SAMPLES;
                    for sample in &self.color[start..start + SAMPLES] {
                        (0..3).for_each(|k| sum[k] += u32::from(sample[k]));
                    }
                }
                let count = (SAMPLES * SAMPLES) as u32;
                out.extend(sum.map(|s| ((s + count / 2) / count) as u8));
            }
        }
        out
    }
}

/// Growth of the shares of the second and the third corner along columns and rows, from the first corner, where both
/// are 0.
fn weights(corners: &[ScreenCorner; 3]) -> Option<[[f32; 2]; 2]> {
    let [a, b, c] = corners.map(|c| c.at);
    let double_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let slope = |p: [f32; 3], q: [f32; 3]| [(q[1] - p[1]) / double_area, (p[0] - q[0]) / double_area];
    (double_area != 0.0).then(|| [slope(a, c), slope(b, a)])
}

/// A value that is given at the corners: at the first, and how it grows along columns and rows.
fn plane([wb, wc]: [[f32; 2]; 2], [at_a, at_b, at_c]: [f32; 3]) -> [f32; 3] {
    let (db, dc) = (at_b - at_a, at_c - at_a);
    [at_a, db * wb[0] + dc * wc[0], db * wb[1] + dc * wc[1]]
}

/// Nearness of a triangle's plane at `p`, which is beside the sample that shows it. On cloth seen at a slant the two
/// differ by more than layers do. It is no nearer than the nearest corner, because the plane ends with the triangle.
fn nearness_at(corners: &[ScreenCorner; 3], p: [f32; 2]) -> f32 {
    let nearest = corners.iter().map(|c| c.at[2]).fold(f32::NEG_INFINITY, f32::max);
    let at = corners[0].at;
    let here = weights(corners).map(|w| plane(w, corners.map(|c| c.at[2])));
    here.map_or(nearest, |[base, dx, dy]| nearest.min(base + dx * (p[0] - at[0]) + dy * (p[1] - at[1])))
}

/// A displayed value as a byte. The conversion saturates.
pub(super) fn byte(x: f32) -> u8 {
    (x * 255.0 + 0.5) as u8
}
