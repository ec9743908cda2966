//! Where flat pieces are drawn: in rows, to one scale.

use super::WIDTH;
use crate::geometry::Vec2;

/// Pixels round all pieces.
const MARGIN: f64 = 50.0;
/// Space between pieces, as a share of the largest piece's size.
const GAP: f64 = 0.08;

/// Where the upper left corner of a piece's box is, and where it is drawn.
pub(super) struct BoxPlace {
    pub(super) from: Vec2,
    pub(super) to: Vec2,
}

/// Pieces given by their boxes in rows, as large as they fit between two rows of pixels; pixels per metre.
pub(super) fn places(boxes: &[[Vec2; 2]], top: usize, bottom: usize) -> (Vec<BoxPlace>, f64) {
    let sizes: Vec<Vec2> = boxes.iter().map(|[low, high]| high - low).collect();
    let gap = GAP * sizes.iter().map(|s| s.max()).fold(f64::MIN_POSITIVE, f64::max);
    let room = Vec2::new(WIDTH as f64, (bottom - top) as f64) - Vec2::repeat(2.0 * MARGIN);
    // Of the numbers of pieces in a row the one that leaves most scale.
    let fitted = |row: usize| {
        let rows = sizes.chunks(row);
        let width = |r: &[Vec2]| r.iter().map(|s| s.x + gap).sum::<f64>() - gap;
        let height = |r: &[Vec2]| r.iter().map(|s| s.y).fold(0.0, f64::max) + gap;
        let widest = rows.clone().map(width).fold(f64::MIN_POSITIVE, f64::max);
        (room.x / widest).min(room.y / rows.map(height).sum::<f64>())
    };
    let best = (1..=sizes.len()).max_by(|&a, &b| fitted(a).total_cmp(&fitted(b)).then(b.cmp(&a))).unwrap_or(1);
    let scale = fitted(best);
    let mut places = Vec::with_capacity(sizes.len());
    let mut at = Vec2::new(MARGIN, top as f64 + MARGIN);
    for row in (0..sizes.len()).collect::<Vec<_>>().chunks(best) {
        for &k in row {
            places.push(BoxPlace { from: boxes[k][0], to: at });
            at.x += (sizes[k].x + gap) * scale;
        }
        at.x = MARGIN;
        at.y += (row.iter().map(|&k| sizes[k].y).fold(0.0, f64::max) + gap) * scale;
    }
    (places, scale)
}
