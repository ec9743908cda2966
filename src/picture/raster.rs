//! Triangles and thick lines with a depth buffer, one band of rows at a time.

use super::color::{PAPER, Rgb};

/// Samples per pixel along each side.
pub(super) const SAMPLES: usize = 2;

/// A projected corner: column and row in samples, nearness in metres, and its displayed colour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: [f32; 3],
    pub(super) color: Rgb,
}

/// What a triangle or a sample belongs to: a piece of cloth, or this, anything else.
pub(super) const NO_PIECE: u32 = u32::MAX;

/// A piece of a drawn line, in samples.
pub(super) struct Stroke {
    pub(super) ends: [[f32; 3]; 2],
    pub(super) radius: f32,
    pub(super) color: Rgb,
    /// The pieces it lies on; these do not hide it unless they are nearer by `lift`, metres, others do. `NO_PIECE`
    /// fills up; a line on no piece is hidden by all alike.
    pub(super) pieces: [u32; 4],
    pub(super) lift: f32,
}

/// Some rows of a panel, in samples.
pub(super) struct Band {
    width: usize,
    first_row: usize,
    rows: usize,
    nearness: Vec<f32>,
    piece: Vec<u32>,
    color: Vec<[u8; 4]>,
}

impl Band {
    /// An empty band: paper, infinitely far.
    pub(super) fn new(width: usize, first_row: usize, rows: usize) -> Self {
        let [r, g, b] = PAPER.map(byte);
        let size = width * rows;
        Self {
            width,
            first_row,
            rows,
            nearness: vec![f32::NEG_INFINITY; size],
            piece: vec![NO_PIECE; size],
            color: vec![[r, g, b, 0]; size],
        }
    }

    /// Columns and rows of this band whose sample centres lie in a box; `None` when there are none.
    fn window(&self, lo: [f32; 2], hi: [f32; 2]) -> Option<[usize; 4]> {
        let first = |x: f32, from: usize| ((x - 0.5).ceil().max(from as f32)) as usize;
        let last = |x: f32, to: usize| ((x - 0.5).floor().min(to as f32 - 1.0)) as isize;
        let (x0, x1) = (first(lo[0], 0), last(hi[0], self.width));
        let (y0, y1) = (first(lo[1], self.first_row), last(hi[1], self.first_row + self.rows));
        (x0 as isize <= x1 && y0 as isize <= y1).then_some([x0, x1 as usize, y0, y1 as usize])
    }

    /// Fills a triangle of `piece` where it is nearer than what is there.
    pub(super) fn triangle(&mut self, corners: &[Corner; 3], piece: u32) {
        let [a, b, c] = corners.map(|c| c.at);
        let lo = [a[0].min(b[0]).min(c[0]), a[1].min(b[1]).min(c[1])];
        let hi = [a[0].max(b[0]).max(c[0]), a[1].max(b[1]).max(c[1])];
        let Some([x0, x1, y0, y1]) = self.window(lo, hi) else { return };
        let double_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if double_area == 0.0 {
            return;
        }
        // Weights of b and c: linear in column and row, zero at a.
        let slope = |p: [f32; 3], q: [f32; 3]| [(q[1] - p[1]) / double_area, (p[0] - q[0]) / double_area];
        let (wb, wc) = (slope(a, c), slope(b, a));
        let plane = |k: fn(&Corner) -> f32| {
            let (at_a, along_b, along_c) = (k(&corners[0]), k(&corners[1]), k(&corners[2]));
            let (db, dc) = (along_b - at_a, along_c - at_a);
            [at_a, db * wb[0] + dc * wc[0], db * wb[1] + dc * wc[1]]
        };
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
                    self.piece[row + x] = piece;
                    let [r, g, b] = tint.map(|t| byte(t[0] + t[1] * dx + t[2] * dy));
                    self.color[row + x] = [r, g, b, 0];
                }
            }
        }
    }

    /// Draws a straight stroke with round ends where nothing hides it.
    pub(super) fn stroke(&mut self, stroke: &Stroke) {
        let &Stroke { ends: [a, b], radius, color, pieces, lift } = stroke;
        let anywhere = pieces[0] == NO_PIECE;
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
                let on = self.piece[row + x];
                let over = if anywhere || on == NO_PIECE || pieces.contains(&on) { lift } else { 0.0 };
                let near = a[2] + t * (b[2] - a[2]) + over;
                if ox * ox + oy * oy <= radius * radius && near > self.nearness[row + x] {
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

/// A displayed value as a byte; the conversion saturates.
pub(super) fn byte(x: f32) -> u8 {
    (x * 255.0 + 0.5) as u8
}
