//! The natural cubic spline (3), from a measure to its normalised value.

use super::super::library::{library, sheet};
use crate::fabric::FabricError;

/// A natural cubic spline through points that rise in x: twice differentiable, straight beyond both ends.
#[derive(Clone, Debug, PartialEq)]
pub struct NaturalSpline {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Second derivatives at the points. Zero at both ends.
    bend: Vec<f64>,
}

impl NaturalSpline {
    /// Through `points`, in any order. Those of one x count as one, with the mean of their y. `None` when fewer than
    /// two are left or a number is not finite.
    pub fn new(mut points: Vec<(f64, f64)>) -> Option<Self> {
        if points.iter().any(|p| !(p.0.is_finite() && p.1.is_finite())) {
            return None;
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mean = |g: &[(f64, f64)]| (g[0].0, g.iter().map(|p| p.1).sum::<f64>() / g.len() as f64);
        let (x, y): (Vec<f64>, Vec<f64>) = points.chunk_by(|a, b| a.0 == b.0).map(mean).unzip();
        (x.len() >= 2).then(|| Self { bend: second_derivatives(&x, &y), x, y })
    }

    /// The spline at `x`.
    pub fn at(&self, x: f64) -> f64 {
        let last = self.x.len() - 1;
        let i = self.x[1..last].partition_point(|k| *k <= x);
        let (width, rise) = (self.x[i + 1] - self.x[i], self.y[i + 1] - self.y[i]);
        let slope = |end: usize| {
            let (a, b) = (self.bend[i], self.bend[i + 1]);
            rise / width + width / 6.0 * if end == 0 { -2.0 * a - b } else { a + 2.0 * b }
        };
        if x < self.x[0] {
            return self.y[0] + slope(0) * (x - self.x[0]);
        }
        if x > self.x[last] {
            return self.y[last] + slope(1) * (x - self.x[last]);
        }
        let (b, a) = ((x - self.x[i]) / width, (self.x[i + 1] - x) / width);
        let cubic = (a.powi(3) - a) * self.bend[i] + (b.powi(3) - b) * self.bend[i + 1];
        a * self.y[i] + b * self.y[i + 1] + cubic * width * width / 6.0
    }

    /// First and last abscissa of the points.
    pub fn range(&self) -> [f64; 2] {
        [self.x[0], self.x[self.x.len() - 1]]
    }
}

/// The tridiagonal system of equal first derivatives (Thomas's algorithm).
fn second_derivatives(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let (mut upper, mut right) = (vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        let (before, after) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        let step = 6.0 * ((y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before);
        let pivot = 2.0 * (before + after) - before * upper[i - 1];
        upper[i] = after / pivot;
        right[i] = (step - before * right[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        right[i] -= upper[i] * right[i + 1];
    }
    right
}

/// The splines v → v' of recovery, stretch and bend through the fifteen published fabrics (3).
///
/// # Errors
/// As [`sheet`].
pub(super) fn published() -> Result<[NaturalSpline; 3], FabricError> {
    let mut points: [Vec<(f64, f64)>; 3] = Default::default();
    for name in library() {
        if let Some(liu) = sheet(name)?.liu {
            for (k, list) in points.iter_mut().enumerate() {
                list.push((liu.means[k], liu.normalised[k]));
            }
        }
    }
    let missing = || FabricError::Syntax { file: "the library".to_owned(), why: "no fabric has measures".to_owned() };
    let [r, s, b] = points.map(NaturalSpline::new);
    Ok([r.ok_or_else(missing)?, s.ok_or_else(missing)?, b.ok_or_else(missing)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn it_passes_the_points_and_is_smooth_and_straight_at_the_ends() {
        let points = vec![(3.0, 1.0), (0.0, 0.5), (1.0, 2.0), (1.5, -1.0), (4.0, 0.0)];
        let spline = NaturalSpline::new(points.clone()).expect("spline");
        for (x, y) in &points {
            assert_relative_eq!(spline.at(*x), *y, epsilon = 1e-12);
        }
        let h = 1e-4;
        let slope = |x: f64| (spline.at(x + h) - spline.at(x - h)) / (2.0 * h);
        let bend = |x: f64| (spline.at(x + h) - 2.0 * spline.at(x) + spline.at(x - h)) / (h * h);
        for x in [1.0, 1.5, 3.0] {
            assert_relative_eq!(slope(x - 2.0 * h), slope(x + 2.0 * h), epsilon = 2e-2);
            assert_relative_eq!(bend(x - 2.0 * h), bend(x + 2.0 * h), epsilon = 5e-2);
        }
        assert_relative_eq!(bend(0.0), 0.0, epsilon = 5e-3);
        assert_relative_eq!(slope(6.0), slope(4.0 + 2.0 * h), epsilon = 1e-6);
        assert_relative_eq!(slope(-1.0), slope(0.0 - 2.0 * h), epsilon = 1e-6);
    }

    #[test]
    fn a_straight_line_stays_one_and_equal_places_are_averaged() {
        let spline = NaturalSpline::new(vec![(0.0, 1.0), (2.0, 4.0), (2.0, 6.0), (4.0, 9.0)]).expect("spline");
        assert_relative_eq!(spline.at(1.3), 1.0 + 2.0 * 1.3, epsilon = 1e-12);
        assert_relative_eq!(spline.at(7.0), 15.0, epsilon = 1e-12);
        assert!(NaturalSpline::new(vec![(1.0, 1.0), (1.0, 2.0)]).is_none());
        assert!(NaturalSpline::new(vec![(1.0, 1.0), (f64::NAN, 2.0)]).is_none());
    }
}
