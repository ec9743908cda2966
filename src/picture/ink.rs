//! How much of every pixel a shape covers.

/// Rows of samples of a pixel. Along a row the share that is covered is exact.
const ROWS: usize = 5;

/// Shares of pixels that a shape covers.
pub(super) struct Ink {
    /// Column and row of the first pixel.
    pub(super) from: [usize; 2],
    /// Pixels in a row.
    pub(super) width: usize,
    /// Shares 0 … 1, row by row.
    pub(super) shares: Vec<f32>,
}

impl Ink {
    /// Of closed contours in pixels, holes running the other way round, on paper of this `size`. Everything is made
    /// wider by `bolder` on both sides, pixels. `None` outside of the paper.
    pub(super) fn of(contours: &[Vec<[f32; 2]>], bolder: f32, size: [usize; 2]) -> Option<Self> {
        let bound = |axis: usize, more: f32| {
            let all = || contours.iter().flatten().map(|p| p[axis]);
            let low = (all().fold(f32::INFINITY, f32::min) - more).floor().max(0.0) as usize;
            let high = (all().fold(f32::NEG_INFINITY, f32::max) + more).ceil().max(0.0) as usize;
            low..high.min(size[axis])
        };
        let (columns, rows) = (bound(0, bolder), bound(1, 0.0));
        if columns.is_empty() || rows.is_empty() {
            return None;
        }
        let (width, from) = (columns.len(), [columns.start, rows.start]);
        let mut ink = Self { from, width, shares: vec![0.0; width * rows.len()] };
        for row in 0..rows.len() {
            for sample in 0..ROWS {
                let y = (rows.start + row) as f32 + (sample as f32 + 0.5) / ROWS as f32;
                for [left, right] in spans(contours, y, bolder) {
                    ink.add(row, left - columns.start as f32, right - columns.start as f32);
                }
            }
        }
        Some(ink)
    }

    /// Adds what a row of samples covers from `left` to `right`, columns of this ink.
    fn add(&mut self, row: usize, left: f32, right: f32) {
        let (first, last) = (left.max(0.0) as usize, (right.max(0.0).ceil() as usize).min(self.width));
        for column in first..last {
            let x = column as f32;
            let share = (right.min(x + 1.0) - left.max(x)).max(0.0) / ROWS as f32;
            self.shares[row * self.width + column] += share;
        }
    }
}

/// The stretches within contours at a height (nonzero winding), each wider by `bolder` on both sides. None overlap.
fn spans(contours: &[Vec<[f32; 2]>], y: f32, bolder: f32) -> Vec<[f32; 2]> {
    let mut met: Vec<(f32, i32)> = Vec::new();
    for contour in contours {
        for (k, p) in contour.iter().enumerate() {
            let q = contour[(k + 1) % contour.len()];
            if (p[1] <= y) != (q[1] <= y) {
                let x = p[0] + (q[0] - p[0]) * (y - p[1]) / (q[1] - p[1]);
                met.push((x, if p[1] <= y { 1 } else { -1 }));
            }
        }
    }
    met.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut out: Vec<[f32; 2]> = Vec::new();
    let (mut winding, mut start) = (0, 0.0);
    for (x, turn) in met {
        if winding == 0 {
            start = x - bolder;
        }
        winding += turn;
        if winding == 0 {
            match out.last_mut() {
                Some(last) if last[1] >= start => last[1] = x + bolder,
                _ => out.push([start, x + bolder]),
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f32, high: f32) -> Vec<[f32; 2]> {
        vec![[low, low], [high, low], [high, high], [low, high]]
    }

    #[test]
    fn a_shape_covers_its_area_less_its_holes() {
        let mut hole = square(4.25, 5.75);
        hole.reverse();
        let ink = Ink::of(&[square(2.0, 8.0), hole], 0.0, [20, 20]).expect("on the paper");
        assert!((ink.shares.iter().sum::<f32>() - (36.0 - 2.25)).abs() < 0.2);
        assert!(ink.shares.iter().all(|s| (0.0..=1.0 + 1e-6).contains(s)));
        assert_eq!((ink.from, ink.width), ([2, 2], 6));
        // Half a pixel bolder on both sides, and what is off the paper is left out.
        let bold = Ink::of(&[square(2.0, 8.0)], 0.5, [5, 20]).expect("on the paper");
        assert!((bold.shares.iter().sum::<f32>() - 3.5 * 6.0).abs() < 1e-3);
        assert!(Ink::of(&[square(30.0, 40.0)], 0.0, [20, 20]).is_none());
        assert!(Ink::of(&[], 0.0, [20, 20]).is_none());
    }
}
