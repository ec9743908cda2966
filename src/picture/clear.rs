//! Places for words that are clear of lines and of other words.

use crate::geometry::{Vec2, encloses};

/// Places that are tried across the wider side of a shape. More are hardly ever needed: the first of a simple piece is
/// free.
const TRIED: f64 = 40.0;
/// Lines that are looked at for each place; with more of them only the middle is taken.
const MOST_LINES: usize = 20_000;

/// Lines and boxes of words, in pixels.
#[derive(Default)]
pub(super) struct Taken {
    lines: Vec<[Vec2; 2]>,
    boxes: Vec<[Vec2; 2]>,
}

impl Taken {
    pub(super) fn line(&mut self, ends: [Vec2; 2]) {
        self.lines.push(ends);
    }

    /// Adds a box around its middle.
    pub(super) fn words(&mut self, middle: Vec2, size: Vec2) {
        self.boxes.push([middle - size / 2.0, middle + size / 2.0]);
    }

    /// Whether nothing that is taken is in a box around its middle.
    pub(super) fn is_clear(&self, middle: Vec2, size: Vec2) -> bool {
        let own = [middle - size / 2.0, middle + size / 2.0];
        let apart = |other: &[Vec2; 2]| (0..2).any(|k| other[1][k] <= own[0][k] || other[0][k] >= own[1][k]);
        self.boxes.iter().all(apart) && !self.lines.iter().any(|line| passes(line, own))
    }

    /// The middle of a clear box of this size within a shape given by its sides, as near as may be to where it is
    /// wanted. `None` if there is none.
    pub(super) fn place(&self, sides: &[[Vec2; 2]], size: Vec2, wanted: Vec2) -> Option<Vec2> {
        let fits = |at: Vec2| encloses(sides.iter().copied(), at) && self.is_clear(at, size);
        if fits(wanted) {
            return Some(wanted);
        }
        let low = sides.iter().flatten().fold(wanted, |low, p| low.inf(p));
        let high = sides.iter().flatten().fold(wanted, |high, p| high.sup(p));
        let step = (high - low).max() / TRIED;
        if self.lines.len() > MOST_LINES || step <= 0.0 {
            return None;
        }
        let count = |k: usize| ((high - low)[k] / step) as usize;
        let at = |x: usize, y: usize| low + step * Vec2::new(x as f64, y as f64);
        let mut all: Vec<Vec2> = (0..=count(1)).flat_map(|y| (0..=count(0)).map(move |x| at(x, y))).collect();
        all.sort_by(|a, b| (a - wanted).norm_squared().total_cmp(&(b - wanted).norm_squared()));
        all.into_iter().find(|at| fits(*at))
    }
}

/// Whether a line passes through a box, by the part of it that is left when each side of the box cuts it off.
fn passes([a, b]: &[Vec2; 2], [low, high]: [Vec2; 2]) -> bool {
    let along = b - a;
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for k in 0..2 {
        if along[k] == 0.0 {
            if a[k] <= low[k] || a[k] >= high[k] {
                return false;
            }
            continue;
        }
        let at = [(low[k] - a[k]) / along[k], (high[k] - a[k]) / along[k]];
        from = from.max(at[0].min(at[1]));
        to = to.min(at[0].max(at[1]));
    }
    from < to
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_keep_clear_of_lines_and_of_each_other() {
        let corners = [[0.0, 0.0], [100.0, 0.0], [100.0, 60.0], [0.0, 60.0]].map(|[x, y]| Vec2::new(x, y));
        let sides: Vec<[Vec2; 2]> = (0..4).map(|k| [corners[k], corners[(k + 1) % 4]]).collect();
        let (size, middle) = (Vec2::new(30.0, 10.0), Vec2::new(50.0, 30.0));
        let mut taken = Taken::default();
        sides.iter().for_each(|side| taken.line(*side));
        assert_eq!(taken.place(&sides, size, middle), Some(middle));
        taken.line([Vec2::new(50.0, 10.0), Vec2::new(50.0, 50.0)]);
        let beside = taken.place(&sides, size, middle).expect("there is room beside the line");
        assert!((beside.x - 50.0).abs() >= 15.0 && (15.0..=85.0).contains(&beside.x), "{beside}");
        taken.words(beside, size);
        let other = taken.place(&sides, size, middle).expect("there is room on the other side");
        assert!((other - beside).abs().iter().zip(size.iter()).any(|(off, wide)| off >= wide), "{other}");
        assert_eq!(taken.place(&sides, Vec2::new(200.0, 10.0), middle), None);
    }
}
