//! The three tests of Liu, Wang & Luo 2015 (L2–L4, L6): from readings to measures, normalised values and weights.
//!
//! A measure v is printed in their Table 2 as a ratio: projected area after crumpling over the flat area, pulled
//! diagonal over diagonal at rest, mean fold height over the highest. Equation (1) as printed would give 1 − v. Here
//! the ratios are computed, as in the table, so that a new fabric stands in one column with the fifteen.

use super::super::sheet::{LARGEST_MEAN, LiuMeasures};
use super::MeasureError;
use super::spline::published;

/// Readings of a test that its equations require.
pub const REPEATS: usize = 20;
/// Names of the tests, in the order of every triple.
pub const TESTS: [&str; 3] = ["recovery", "stretch", "bend"];
/// Relative error of a photograph: a crumpled specimen may seem larger than the flat one by this.
pub(super) const PHOTO_ERROR: f64 = 0.02;
/// Allowed range of the ratio of each test.
const RATIOS: [[f64; 2]; 3] = [[0.0, 1.0 + PHOTO_ERROR], [1.0, LARGEST_MEAN], [0.0, 1.0]];
/// Largest fold height, in medians. A higher one is a slip of the pen, and it would determine the measure.
const HIGHEST: f64 = 3.0;

/// The readings of one test.
#[derive(Clone, Debug, PartialEq)]
pub struct Readings {
    /// The specimen before the test, r⁰ or s⁰. Fold heights have none, and use the highest reading.
    pub initial: Option<f64>,
    /// The repeats, in the same unit.
    pub repeats: Vec<f64>,
    /// Lines of the file that the repeats stand in, if each has one of its own.
    pub rows: Vec<usize>,
}

/// Distance of a reading from the median, in distances of half of the other readings, from which it is doubted.
const FAR: f64 = 10.0;
/// Distance of a reading from the median, as a share of the median, below which it is not doubted.
const COUNTS: f64 = 0.05;

/// Result of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// Measure v of the mean of the readings.
    pub mean: f64,
    /// Standard deviation of the single readings' v.
    pub spread: f64,
    /// Smallest and largest v of a single reading.
    pub range: [f64; 2],
    /// Normalised value v' by (2): the position of the mean between the two extremes.
    pub normalised: f64,
}

impl Readings {
    /// The measure of test number `test` (0 recovery, 1 stretch, 2 bend).
    ///
    /// # Errors
    /// [`MeasureError`] naming the test and the reading that is wrong.
    pub fn measure(&self, test: usize) -> Result<Measure, MeasureError> {
        let name = TESTS[test];
        let fault = |why: String| MeasureError::Test { test: name, why };
        let count = self.repeats.len();
        if count < REPEATS {
            return Err(fault(format!(
                "{count} readings; the test has {REPEATS}, each with the specimen laid out anew"
            )));
        }
        if let Some(k) = self.repeats.iter().position(|r| !(r.is_finite() && *r > 0.0)) {
            return Err(fault(format!("{} is {}; a number above 0 is expected", self.place(k), self.repeats[k])));
        }
        let highest = self.repeats.iter().copied().fold(0.0, f64::max);
        let initial = if test == 2 { highest } else { self.initial.unwrap_or(f64::NAN) };
        if !(initial.is_finite() && initial > 0.0) {
            let what = if test == 0 { "the flat specimen's area" } else { "the diagonal's length before the pull" };
            return Err(fault(format!("give initial: {what}, in the unit of the readings")));
        }
        self.plausible(test, initial).map_err(fault)?;
        let v: Vec<f64> = self.repeats.iter().map(|r| r / initial).collect();
        let mean = v.iter().sum::<f64>() / count as f64;
        let spread = (v.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1) as f64).sqrt();
        let range = v.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
        if range[0] >= range[1] {
            return Err(fault("all readings are the same; equation (2) has nothing to divide by".to_owned()));
        }
        let normalised = (mean - range[0]) / (range[1] - range[0]);
        Ok(Measure { mean, spread, range, normalised })
    }

    /// Name of a reading in messages.
    fn place(&self, k: usize) -> String {
        let row = self.rows.get(k).map(|row| format!(" in row {row}"));
        format!("reading {}{}", k + 1, row.unwrap_or_default())
    }

    /// Readings that lie far from all others: v' follows from the two extremes (2), and with one digit left out a
    /// reading is one.
    pub(super) fn doubts(&self, test: usize) -> Vec<String> {
        let middle = median(&self.repeats);
        let off: Vec<f64> = self.repeats.iter().map(|r| (r - middle).abs()).collect();
        let limit = (FAR * median(&off)).max(COUNTS * middle);
        let far = (0..off.len()).filter(|k| off[*k] > limit);
        far.map(|k| {
            let (name, place, reading) = (TESTS[test], self.place(k), self.repeats[k]);
            format!(
                "{name}: {place} ({reading}) lies far from the others, whose median is {middle}; was it written right? \
                 v' follows from the smallest and the largest"
            )
        })
        .collect()
    }

    fn plausible(&self, test: usize, initial: f64) -> Result<(), String> {
        let [least, most] = RATIOS[test];
        let wrong = self.repeats.iter().position(|r| !(least..=most).contains(&(r / initial)));
        let at = |k: usize| format!("{} ({}) against {initial} before the test", self.place(k), self.repeats[k]);
        match test {
            0 => wrong.map_or(Ok(()), |k| {
                Err(format!("{}: crumpled cloth covers no more than flat cloth; are the units the same?", at(k)))
            }),
            1 => wrong.map_or(Ok(()), |k| {
                Err(format!("{}: a pulled diagonal is longer, and less than {most} times as long", at(k)))
            }),
            _ => {
                let median = median(&self.repeats);
                match self.repeats.iter().position(|r| *r > HIGHEST * median) {
                    Some(k) => Err(format!(
                        "{} ({}) is more than {HIGHEST} times the median, {median}; was it written right?",
                        self.place(k),
                        self.repeats[k]
                    )),
                    None => Ok(()),
                }
            }
        }
    }
}

/// The middle one of some numbers.
fn median(numbers: &[f64]) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Measures, spread and weights of a fabric whose three tests were made.
pub(super) fn from_tests(tests: [Measure; 3]) -> LiuMeasures {
    let normalised = tests.map(|t| t.normalised);
    LiuMeasures {
        sample: None,
        means: tests.map(|t| t.mean),
        spread: Some(tests.map(|t| t.spread)),
        normalised,
        weights: weights(normalised),
    }
}

/// Measures and weights of a fabric of which only the means are known, by the spline (3) through the fifteen. A spline
/// that leaves 0 … 1 is cut there. Also says which means lie beyond those of the fifteen.
pub(super) fn from_means(means: [f64; 3]) -> Result<(LiuMeasures, Vec<String>), MeasureError> {
    let splines = published()?;
    let mut notes = Vec::new();
    let mut normalised = [0.0; 3];
    for (k, spline) in splines.iter().enumerate() {
        let [low, high] = spline.range();
        let (test, v) = (TESTS[k], means[k]);
        let [least, most] = RATIOS[k];
        if !(v > 0.0 && (least..=most).contains(&v)) {
            let why = format!("the mean {v} is no ratio such as {low} or {high}; it lies between {least} and {most}");
            return Err(MeasureError::Test { test, why });
        }
        if v < low || v > high {
            notes.push(format!("{test}: {v} lies beyond the fifteen fabrics ({low} to {high}); v' is extrapolated"));
        }
        let at = spline.at(v);
        normalised[k] = at.clamp(0.0, 1.0);
        if at != normalised[k] {
            notes.push(format!("{test}: the spline gives v' = {at:.3} at {v}; it is cut to {}", normalised[k]));
        }
    }
    if normalised.iter().sum::<f64>() <= 0.0 {
        return Err(MeasureError::Test { test: "means", why: "v' is 0 for all three; (8) has no weights".to_owned() });
    }
    let liu = LiuMeasures { sample: None, means, spread: None, normalised, weights: weights(normalised) };
    Ok((liu, notes))
}

/// Equation (8), percent.
pub(crate) fn weights(normalised: [f64; 3]) -> [f64; 3] {
    let sum: f64 = normalised.iter().sum();
    normalised.map(|v| 100.0 * v / sum)
}
