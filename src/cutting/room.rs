//! Room on a piece: for letters clear of all lines, and for an arrow along the grain.

use super::walls::Walls;
use crate::geometry::{Vec2, box_or_origin, encloses, range_of, sides_of};

/// Places looked at along each side of the piece's box.
const PLACES: usize = 40;
/// Share of the room between lines that a block of text takes.
pub(super) const AIR: f64 = 0.85;
/// Share of the cloth along a thread that an arrow takes at most.
const ARROW: f64 = 0.8;
/// This share of its length is not worth going farther for.
const ALIKE: f64 = 0.01;
/// Distance within which a point is on the rim of the cloth, metres.
const ON_RIM: f64 = 1e-6;
/// Places of an arrow at which it must be on the cloth.
const LOOKS: usize = 16;

/// A piece's cloth, and the lines on it.
#[derive(Clone, Debug, Default)]
pub struct Room {
    /// Closed lines round the cloth and its holes.
    pub contours: Vec<Vec<Vec2>>,
    /// Lines that letters must keep clear of.
    pub walls: Vec<[Vec2; 2]>,
}

impl Room {
    /// Keeps letters clear of a line.
    pub fn add_wall(&mut self, points: &[Vec2]) {
        self.walls.extend(points.windows(2).map(|w| [w[0], w[1]]));
    }

    /// Least and greatest coordinates of the cloth.
    fn bounds(&self) -> [Vec2; 2] {
        box_or_origin(self.contours.iter().flatten().copied())
    }

    /// Whether `p` is on the cloth.
    pub fn holds(&self, p: Vec2) -> bool {
        encloses(self.contours.iter().flat_map(|contour| sides_of(contour)), p)
    }

    /// Place with most room for a block of text of this size (in heights of letters), and the largest height of its
    /// letters.
    pub fn roomiest(&self, block: Vec2) -> (Vec2, f64) {
        // In these units the block is a square of side 1 per letter height.
        let scaled = |p: Vec2| p.component_div(&block);
        let [low, high] = self.bounds();
        let walls: Vec<[Vec2; 2]> = self.walls.iter().map(|w| w.map(scaled)).collect();
        let walls = Walls::new(&walls, [low, high].map(scaled));
        let place =
            |[i, k]: [usize; 2]| low + (high - low).component_mul(&(Vec2::new(i as f64, k as f64) / PLACES as f64));
        let sides: Vec<[Vec2; 2]> = self.contours.iter().flat_map(|contour| sides_of(contour)).collect();
        // Of the sides of the cloth those tell that a level line through the place crosses.
        let crossed = |k: usize| {
            let y = place([0, k]).y;
            sides.iter().copied().filter(|[a, b]| (a.y > y) != (b.y > y)).collect::<Vec<[Vec2; 2]>>()
        };
        let crossed: Vec<Vec<[Vec2; 2]>> = (0..PLACES).map(crossed).collect();
        let mut best = ((low + high) / 2.0, 0.0);
        for i in 1..PLACES {
            for (k, crossed) in crossed.iter().enumerate().skip(1) {
                let p = place([i, k]);
                if encloses(crossed.iter().copied(), p) {
                    let enough = best.1 / (2.0 * AIR);
                    let clear = walls.clear(scaled(p), enough, |wall| distance(scaled(p), wall));
                    let room = 2.0 * AIR * clear;
                    if room > best.1 {
                        best = (p, room);
                    }
                }
            }
        }
        best
    }

    /// As [`Self::roomiest`], turned (and true) where letters as high as `wanted` have no room level, and turned they
    /// may be so many times `larger`: text is easier to read level.
    pub fn level_or_turned(&self, block: Vec2, wanted: f64, larger: f64) -> (Vec2, f64, bool) {
        let (level, turned) = (self.roomiest(block), self.roomiest(block.yx()));
        let upright = level.1 < wanted && turned.1 > larger * level.1;
        let (middle, height) = if upright { turned } else { level };
        (middle, height, upright)
    }

    /// Whether a box round `middle` is on the cloth and no line enters it.
    pub fn is_clear(&self, middle: Vec2, size: Vec2) -> bool {
        let scaled = |p: Vec2| p.component_div(&size);
        self.holds(middle) && self.walls.iter().all(|w| distance(scaled(middle), w.map(scaled)) >= 0.5)
    }

    /// An arrow as it is where it lies on the cloth, and else one of the same direction on the cloth: as long as there
    /// is room for, and as near as that allows.
    pub fn arrow(&self, [tail, head]: [Vec2; 2]) -> [Vec2; 2] {
        let look = |k: usize| tail + (head - tail) * (k as f64 / LOOKS as f64);
        let Some(along) = (head - tail).try_normalize(0.0).filter(|_| !(0..=LOOKS).all(|k| self.holds(look(k)))) else {
            return [tail, head];
        };
        let (across, middle) = (Vec2::new(-along.y, along.x), (tail + head) / 2.0);
        let reach = self.contours.iter().flatten().map(|p| across.dot(&(p - middle)));
        let [low, high] = range_of(reach);
        let mut best = (0.0, f64::INFINITY, [tail, head]);
        for k in 1..PLACES {
            let aside = low + (high - low) * (k as f64 / PLACES as f64);
            for [from, to] in self.stretches(middle + across * aside, along) {
                let half = (ARROW * (to - from)).min((head - tail).norm()) / 2.0;
                let at = 0f64.clamp(from + half / ARROW, (to - half / ARROW).max(from + half / ARROW));
                let far = aside.hypot(at);
                if half > (1.0 + ALIKE) * best.0 || half > (1.0 - ALIKE) * best.0 && far < best.1 {
                    let center = middle + across * aside + along * at;
                    best = (half, far, [center - along * half, center + along * half]);
                }
            }
        }
        best.2
    }

    /// Distance from `p`, on the cloth or on its rim, to the end of the cloth along `along`. `None` if there is none.
    pub fn way_off(&self, p: Vec2, along: Vec2) -> Option<f64> {
        self.stretches(p, along).into_iter().flatten().find(|way| *way >= -ON_RIM).map(|way| way.max(0.0))
    }

    /// Stretches of the line through `p` along `along` that run over cloth: from and to, measured from `p`.
    fn stretches(&self, p: Vec2, along: Vec2) -> Vec<[f64; 2]> {
        let mut at = Vec::new();
        for contour in &self.contours {
            let next = contour.iter().cycle().skip(1);
            for (a, b) in contour.iter().zip(next) {
                let [left, right] = [a, b].map(|q| along.perp(&(q - p)));
                if (left > 0.0) != (right > 0.0) {
                    let crossing = a + (b - a) * (left / (left - right));
                    at.push(along.dot(&(crossing - p)));
                }
            }
        }
        at.sort_by(f64::total_cmp);
        at.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
    }
}

/// From the middle of a line of letters to the middle of its foot. Turned, that is to the left.
pub fn foot(height: f64, upright: bool) -> Vec2 {
    if upright { Vec2::new(-height / 2.0, 0.0) } else { Vec2::new(0.0, height / 2.0) }
}

/// Half the side of the largest square round `p` that a segment does not enter.
fn distance(p: Vec2, [a, b]: [Vec2; 2]) -> f64 {
    let (from, along) = (a - p, b - a);
    // Along the segment |x| and |y| are straight between their zeros, and the greater of them between where they are
    // equal.
    let turning = [(1.0, 0.0), (0.0, 1.0), (1.0, -1.0), (1.0, 1.0)].map(|(x, y)| {
        let slope = x * along.x + y * along.y;
        if slope == 0.0 { 0.0 } else { (-(x * from.x + y * from.y) / slope).clamp(0.0, 1.0) }
    });
    turning.into_iter().chain([0.0, 1.0]).map(|share| (from + along * share).amax()).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_grows_to_the_segment() {
        let from_origin = |a: [f64; 2], b: [f64; 2]| distance(Vec2::zeros(), [a, b].map(|p| Vec2::new(p[0], p[1])));
        assert_eq!(from_origin([-5.0, 2.0], [5.0, 2.0]), 2.0);
        assert_eq!(from_origin([3.0, -9.0], [3.0, 9.0]), 3.0);
        // A diagonal meets the square's corner first. A short one its own end.
        assert_eq!(from_origin([4.0, 0.0], [0.0, 4.0]), 2.0);
        assert_eq!(from_origin([4.0, 1.0], [3.5, 1.5]), 3.5);
        assert_eq!(from_origin([-1.0, -1.0], [1.0, 1.0]), 0.0);
        let dense = |a: Vec2, b: Vec2| {
            (0..=10_000).map(|k| (a + (b - a) * (f64::from(k) / 1e4)).amax()).fold(f64::INFINITY, f64::min)
        };
        for k in 0..50 {
            let at = |seed: i32| f64::from(seed * 7919 % 41 - 20) / 4.0;
            let (a, b) = (Vec2::new(at(k), at(3 * k + 1)), Vec2::new(at(5 * k + 2), at(7 * k + 3)));
            assert!((distance(Vec2::zeros(), [a, b]) - dense(a, b)).abs() < 2e-3, "{a} {b}");
        }
    }

    #[test]
    fn an_arrow_off_the_cloth_comes_onto_it() {
        let at = |x: f64, y: f64| Vec2::new(x, y);
        // A horseshoe, open below: its middle is no cloth.
        let outline = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [7.0, 9.0], [7.0, 2.0], [2.0, 2.0], [2.0, 9.0], [0.0, 9.0]];
        let room = Room { contours: vec![outline.map(|[x, y]| at(x, y)).to_vec()], walls: Vec::new() };
        let [tail, head] = room.arrow([at(4.0, 8.0), at(4.0, 2.5)]);
        assert!(tail.x == head.x && tail.x < 2.0 && tail.y > head.y, "{tail} {head}");
        assert!((tail.y - head.y - 5.5).abs() < 1e-9);
        let [tail, head] = room.arrow([at(1.0, 19.0), at(1.0, 7.0)]);
        assert!(room.holds(tail) && room.holds(head) && (tail.y - head.y - 7.2).abs() < 1e-9, "{tail} {head}");
        // One that is on the cloth stays.
        let good = [at(8.0, 8.0), at(8.0, 1.0)];
        assert_eq!(room.arrow(good), good);
    }

    #[test]
    fn letters_keep_clear_of_lines() {
        let at = |x: f64, y: f64| Vec2::new(x, y);
        let square = vec![at(0.0, 0.0), at(9.0, 0.0), at(9.0, 9.0), at(0.0, 9.0)];
        let mut room = Room { contours: vec![square], walls: Vec::new() };
        room.add_wall(&[at(3.0, 0.0), at(3.0, 9.0)]);
        assert!(room.is_clear(at(6.0, 4.0), at(5.0, 1.0)) && !room.is_clear(at(5.0, 4.0), at(5.0, 1.0)));
        assert!(!room.is_clear(at(20.0, 4.0), at(5.0, 1.0)));
    }
}
