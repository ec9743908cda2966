//! Least squares over few knobs within their ranges, on figures that are taken to change linearly.

use super::figure::Figure;

/// Weight of a change against a figure that is off by its tolerance: as much as the whole range of a knob. Of changes
/// that fit alike the smallest is taken.
const CHANGE: f64 = 0.05;
/// Sweeps over the knobs. Knobs that act alike need many.
const SWEEPS: usize = 4000;
/// Changes below this end the search, mm.
const STILL: f64 = 1e-7;
/// Halvings of a knob's range in the search along it.
const HALVINGS: usize = 50;

/// Figures at a setting of the knobs, and how they change with each.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Model {
    /// Amounts of the knobs, mm.
    pub(super) at: Vec<f64>,
    /// The figures there.
    pub(super) values: Vec<f64>,
    /// For every figure its change with each knob, per mm.
    pub(super) slopes: Vec<Vec<f64>>,
}

impl Model {
    /// The figures at another setting.
    pub(super) fn predicted(&self, at: &[f64]) -> Vec<f64> {
        let change = |slopes: &Vec<f64>| -> f64 { slopes.iter().zip(at.iter().zip(&self.at)).map(by).sum() };
        self.values.iter().zip(&self.slopes).map(|(value, slopes)| value + change(slopes)).collect()
    }

    /// Takes in what was measured at another setting: slopes are corrected along the way there (Broyden 1965).
    pub(super) fn learn(&mut self, at: &[f64], values: &[f64]) {
        let way: Vec<f64> = at.iter().zip(&self.at).map(|(a, b)| a - b).collect();
        let square: f64 = way.iter().map(|w| w * w).sum();
        if square < STILL {
            return;
        }
        let predicted = self.predicted(at);
        for (slopes, (value, predicted)) in self.slopes.iter_mut().zip(values.iter().zip(predicted)) {
            slopes.iter_mut().zip(&way).for_each(|(slope, w)| *slope += (value - predicted) * w / square);
        }
    }

    /// Goes to a setting where these figures were measured.
    pub(super) fn go(&mut self, at: &[f64], values: &[f64]) {
        (self.at, self.values) = (at.to_vec(), values.to_vec());
    }

    /// The setting that suits the figures `of` best, of those within `ranges`.
    pub(super) fn best(&self, figures: &[Figure], of: &[usize], ranges: &[[f64; 2]]) -> Vec<f64> {
        let mut at: Vec<f64> = self.at.iter().zip(ranges).map(|(x, r)| x.clamp(r[0], r[1])).collect();
        let mut values = self.predicted(&at);
        for _ in 0..SWEEPS {
            let mut moved = 0.0f64;
            for (k, range) in ranges.iter().enumerate() {
                let to = self.best_along(figures, of, k, (&at, &values), *range);
                let by = to - at[k];
                values.iter_mut().zip(&self.slopes).for_each(|(value, slopes)| *value += slopes[k] * by);
                at[k] = to;
                moved = moved.max(by.abs());
            }
            if moved < STILL {
                break;
            }
        }
        at
    }

    /// The best amount of knob `k`, the others being as they are. What is to be least is convex along it, so that its
    /// slope rises.
    fn best_along(
        &self,
        figures: &[Figure],
        of: &[usize],
        k: usize,
        (at, values): (&[f64], &[f64]),
        [mut low, mut high]: [f64; 2],
    ) -> f64 {
        let wide = (high - low).max(STILL);
        let rises = |x: f64| {
            let figure = |&w: &usize| {
                let slope = self.slopes[w][k];
                figures[w].off(values[w] + slope * (x - at[k])) * slope / figures[w].tolerance
            };
            of.iter().map(figure).sum::<f64>() + (CHANGE / wide).powi(2) * x > 0.0
        };
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if rises(middle) { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }
}

fn by((slope, (a, b)): (&f64, (&f64, &f64))) -> f64 {
    slope * (a - b)
}

/// Sum of the squares of how far figures are off, in tolerances.
pub(super) fn cost(figures: &[Figure], values: &[f64]) -> f64 {
    figures.iter().zip(values).map(|(figure, value)| figure.off(*value).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::{WantFile, Wanted};

    fn ease(girth: &str, mm: [f64; 2]) -> Figure {
        Figure::new(&WantFile::Ease(girth.into(), Wanted { from: Some(1e-3 * mm[0]), to: Some(1e-3 * mm[1]) }))
    }

    fn model(slopes: &[[f64; 2]]) -> Model {
        Model { at: vec![0.0; 2], values: vec![0.0; slopes.len()], slopes: slopes.iter().map(|s| s.to_vec()).collect() }
    }

    #[test]
    fn what_can_be_had_is_found_exactly_also_where_knobs_act_alike() {
        let figures = [ease("waist", [20.0, 20.0]), ease("hip", [-10.0, -10.0])];
        for (slopes, found) in [([[4.0, 0.0], [0.0, 2.0]], [5.0, -5.0]), ([[4.0, 3.0], [3.0, 4.0]], [15.714, -14.286])]
        {
            let at = model(&slopes).best(&figures, &[0, 1], &[[-30.0, 30.0]; 2]);
            assert!(at.iter().zip(found).all(|(a, b)| (a - b).abs() < 0.05), "{at:?}");
        }
    }

    #[test]
    fn ranges_are_kept_and_of_many_ways_the_shortest_is_taken() {
        let figures = [ease("waist", [20.0, 20.0])];
        let at = model(&[[4.0, 4.0]]).best(&figures, &[0], &[[-30.0, 30.0]; 2]);
        assert!((at[0] - 2.5).abs() < 0.05 && (at[1] - 2.5).abs() < 0.05, "{at:?}");
        let at = model(&[[4.0, 0.0]]).best(&figures, &[0], &[[-3.0, 3.0]; 2]);
        assert!((at[0] - 3.0).abs() < 1e-6 && at[1].abs() < 1e-6, "{at:?}");
        // Nothing moves where all is within its range.
        let wide = [ease("waist", [-20.0, 20.0])];
        assert!(model(&[[4.0, 4.0]]).best(&wide, &[0], &[[-30.0, 30.0]; 2]).iter().all(|x| x.abs() < 1e-6));
    }

    #[test]
    fn a_step_that_came_out_otherwise_corrects_the_slopes() {
        let mut model = model(&[[4.0, 1.0]]);
        model.learn(&[10.0, 0.0], &[30.0]);
        assert_eq!(model.slopes, [vec![3.0, 1.0]]);
        model.go(&[10.0, 0.0], &[30.0]);
        assert_eq!(model.predicted(&[12.0, 1.0]), [37.0]);
    }
}
