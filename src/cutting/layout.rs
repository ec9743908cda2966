//! Papers side by side on a sheet.

use nalgebra::Matrix2;

use super::Paper;
use crate::geometry::{Vec2, box_of};

/// Side of the square to measure after printing, metres.
pub const TEST_SQUARE: f64 = 0.100;
/// Side of the square beside it, for those who measure in inches: two of them, in metres.
pub const INCH_SQUARE: f64 = 0.0508;
/// Space between the two squares, metres.
pub const SQUARE_GAP: f64 = 0.010;
/// Space between papers, metres: room for scissors.
const GAP: f64 = 0.010;
/// A sheet of free width is about this much wider than a square of the papers' boxes, which leaves it roughly as high
/// as wide.
const SLACK: f64 = 1.2;

/// Layout of papers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Layout {
    /// Width of the sheet, metres. Wider only where a single piece is. `None`: about as wide as high.
    pub width: Option<f64>,
    /// Empty rim, metres.
    pub margin: f64,
    /// Whether a corner is kept for the test squares.
    pub square: bool,
}

/// Papers laid out, metres from the upper left corner of the sheet.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Nothing on it is outside of this.
    pub size: Vec2,
    /// The papers.
    pub papers: Vec<Paper>,
    /// Upper left corner of the test square, if there is one; that in inches is to its right.
    pub square: Option<Vec2>,
    /// Stretches of cloth on which the papers lie, in a cutting plan.
    pub cloth: Vec<ClothLength>,
}

/// A stretch of cloth.
#[derive(Clone, Debug, PartialEq)]
pub struct ClothLength {
    /// Its upper left corner.
    pub corner: Vec2,
    /// Width across, and length down.
    pub size: Vec2,
    /// Whether it is folded, with the fold on the left.
    pub folded: bool,
    /// Its title, for a line above it.
    pub text: String,
}

/// Height of the letters above a stretch of cloth, and how far they stand above it, metres.
pub const CLOTH_LETTERS: [f64; 2] = [0.020, 0.010];

impl Sheet {
    /// Lays papers out, the highest first.
    pub fn new(papers: &[Paper], layout: &Layout) -> Self {
        let groups = groups(papers);
        let boxes: Vec<[Vec2; 2]> = groups.iter().map(|group| box_of(group.iter().flat_map(|p| p.extent()))).collect();
        let mut sizes: Vec<Vec2> = boxes.iter().map(|[low, high]| high - low).collect();
        if layout.square {
            sizes.push(Vec2::new(TEST_SQUARE + SQUARE_GAP + INCH_SQUARE, TEST_SQUARE));
        }
        let width = layout.width.map(|w| w - 2.0 * layout.margin);
        let (corners, size) = shelves(&sizes, width, GAP);
        let margin = Vec2::repeat(layout.margin);
        let shifts = boxes.iter().zip(&corners).map(|([low, _], corner)| corner + margin - low);
        let put = |(group, shift): (&&[Paper], Vec2)| {
            group.iter().map(|paper| paper.mapped(Matrix2::identity(), shift)).collect::<Vec<Paper>>()
        };
        Self {
            papers: groups.iter().zip(shifts).flat_map(put).collect(),
            square: layout.square.then(|| corners[groups.len()] + margin),
            size: size + 2.0 * margin,
            cloth: Vec::new(),
        }
    }
}

/// The papers, those of a nest together.
fn groups(papers: &[Paper]) -> Vec<&[Paper]> {
    papers.chunk_by(|one, next| one.nest.is_some() && one.nest == next.nest).collect()
}

/// Puts boxes of these sizes on shelves, the highest first: their upper left corners and the size of it all. `width`
/// is exceeded only by a box that is wider.
pub fn shelves(sizes: &[Vec2], width: Option<f64>, gap: f64) -> (Vec<Vec2>, Vec2) {
    let boxes: f64 = sizes.iter().map(|s| (s.x + gap) * (s.y + gap)).sum();
    let width = width.unwrap_or(SLACK * boxes.sqrt());
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|&a, &b| sizes[b].y.total_cmp(&sizes[a].y).then(a.cmp(&b)));
    let mut corners = vec![Vec2::zeros(); sizes.len()];
    let (mut at, mut shelf, mut right) = (Vec2::zeros(), 0.0, 0.0);
    for k in order {
        if at.x > 0.0 && at.x + sizes[k].x > width {
            at = Vec2::new(0.0, at.y + shelf + gap);
            shelf = 0.0;
        }
        corners[k] = at;
        shelf = f64::max(shelf, sizes[k].y);
        right = f64::max(right, at.x + sizes[k].x);
        at.x += sizes[k].x + gap;
    }
    (corners, Vec2::new(right, at.y + shelf))
}
