//! Least squares over few knobs within their ranges, on figures that are taken to change linearly.

use nalgebra::{DMatrix, DVector};

use super::figure::Figure;

/// Weight of a change against a figure that is off by its tolerance: as much as the whole range of a knob. Of changes
/// that fit alike the smallest is taken.
const CHANGE: f64 = 0.05;
/// Newton steps at most. Each takes in or leaves out figures and knobs at their ends.
const STEPS: usize = 100;
/// Changes below this end the search, mm.
const STILL: f64 = 1e-7;
/// Steps shorter than this teach little of the slopes, mm: figures of two drapes differ by some tenths of a millimetre.
const SHORT: f64 = 3.0;
/// Halvings of a step that makes nothing better.
const HALVINGS: i32 = 40;

/// Figures at a setting of the knobs, and how they change with each.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FigureModel {
    /// Amounts of the knobs, mm.
    pub(super) at: Vec<f64>,
    /// The figures there.
    pub(super) values: Vec<f64>,
    /// For every figure its change with each knob, per mm.
    pub(super) slopes: Vec<Vec<f64>>,
}

impl FigureModel {
    /// The figures at another setting.
    pub(super) fn predicted(&self, at: &[f64]) -> Vec<f64> {
        let change = |slopes: &Vec<f64>| -> f64 { slopes.iter().zip(at.iter().zip(&self.at)).map(by).sum() };
        self.values.iter().zip(&self.slopes).map(|(value, slopes)| value + change(slopes)).collect()
    }

    /// Takes in what was measured at another setting: slopes are corrected along the way there (Broyden 1965).
    pub(super) fn learn(&mut self, at: &[f64], values: &[f64]) {
        let way: Vec<f64> = at.iter().zip(&self.at).map(|(a, b)| a - b).collect();
        let square: f64 = way.iter().map(|w| w * w).sum();
        let predicted = self.predicted(at);
        for (slopes, (value, predicted)) in self.slopes.iter_mut().zip(values.iter().zip(predicted)) {
            slopes
                .iter_mut()
                .zip(&way)
                .for_each(|(slope, w)| *slope += (value - predicted) * w / (square + SHORT * SHORT));
        }
    }

    /// Goes to a setting where these figures were measured.
    pub(super) fn go(&mut self, at: &[f64], values: &[f64]) {
        (self.at, self.values) = (at.to_vec(), values.to_vec());
    }

    /// The setting that suits the figures `of` best, of those within `ranges`. The sum to be minimized is convex,
    /// so that Newton steps with the knobs that are not held by their ends reach its minimum.
    pub(super) fn best(&self, figures: &[Figure], of: &[usize], ranges: &[[f64; 2]]) -> Vec<f64> {
        let within = |at: Vec<f64>| -> Vec<f64> { at.iter().zip(ranges).map(|(x, r)| x.clamp(r[0], r[1])).collect() };
        let mut at = within(self.at.clone());
        for _ in 0..STEPS {
            let (slope, bend) = self.slope(figures, of, ranges, &at);
            let is_held =
                |k: usize| (at[k] <= ranges[k][0] && slope[k] > 0.0) || (at[k] >= ranges[k][1] && slope[k] < 0.0);
            let free: Vec<usize> = (0..at.len()).filter(|&k| !is_held(k)).collect();
            let Some(way) = newton(&free, &slope, &bend) else { break };
            let before = self.weight(figures, of, ranges, &at);
            let along = |share: f64| within(at.iter().zip(&way).map(|(x, w)| x + share * w).collect());
            let better = |next: &Vec<f64>| self.weight(figures, of, ranges, next) < before;
            let Some(next) = (0..HALVINGS).map(|k| along(0.5f64.powi(k))).find(better) else { break };
            let moved = next.iter().zip(&at).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            at = next;
            if moved < STILL {
                break;
            }
        }
        at
    }

    /// The objective at a setting: squares of how far figures are off, and of the changes.
    fn weight(&self, figures: &[Figure], of: &[usize], ranges: &[[f64; 2]], at: &[f64]) -> f64 {
        let values = self.predicted(at);
        let off: f64 = of.iter().map(|&w| figures[w].off(values[w]).powi(2)).sum();
        off + at.iter().zip(ranges).map(|(x, range)| (change(range) * x).powi(2)).sum::<f64>()
    }

    /// Half the slope of [`Self::weight`] and of that slope.
    fn slope(&self, figures: &[Figure], of: &[usize], ranges: &[[f64; 2]], at: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let values = self.predicted(at);
        let squares = ranges.iter().map(|range| change(range).powi(2));
        let mut bend = DMatrix::from_diagonal(&DVector::from_iterator(at.len(), squares));
        let mut slope = &bend * DVector::from_column_slice(at);
        for &w in of {
            let off = figures[w].off(values[w]);
            if off != 0.0 {
                let row = DVector::from_column_slice(&self.slopes[w]) / figures[w].tolerance;
                slope += &row * off;
                bend += &row * row.transpose();
            }
        }
        (slope, bend)
    }
}

/// Weight of a millimetre of a knob.
fn change(range: &[f64; 2]) -> f64 {
    CHANGE / (range[1] - range[0]).max(STILL)
}

/// The Newton step of some knobs, the others staying.
fn newton(free: &[usize], slope: &DVector<f64>, bend: &DMatrix<f64>) -> Option<DVector<f64>> {
    let part = DMatrix::from_fn(free.len(), free.len(), |i, j| bend[(free[i], free[j])]);
    let down = DVector::from_fn(free.len(), |i, _| -slope[free[i]]);
    let step = if free.is_empty() { return None } else { part.cholesky()?.solve(&down) };
    let mut way = DVector::zeros(slope.len());
    free.iter().zip(step.iter()).for_each(|(&k, x)| way[k] = *x);
    Some(way)
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

    fn model(slopes: &[[f64; 2]]) -> FigureModel {
        FigureModel {
            at: vec![0.0; 2],
            values: vec![0.0; slopes.len()],
            slopes: slopes.iter().map(|s| s.to_vec()).collect(),
        }
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
        model.learn(&[100.0, 0.0], &[300.0]);
        assert!((model.slopes[0][0] - 3.0).abs() < 1e-3 && model.slopes[0][1] == 1.0, "{:?}", model.slopes);
        model.go(&[100.0, 0.0], &[300.0]);
        assert!((model.predicted(&[102.0, 1.0])[0] - 307.0).abs() < 0.01);
        // What two drapes of one garment differ by teaches nothing.
        model.learn(&[100.1, 0.0], &[301.0]);
        assert!((model.slopes[0][0] - 3.0).abs() < 0.02, "{:?}", model.slopes);
    }
}
