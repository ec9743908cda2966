//! Mean and quantiles.

use super::schema::Spread;

/// The spread of `values`. Zeros when there are none.
pub(super) fn spread(mut values: Vec<f64>) -> Spread {
    if values.is_empty() {
        return Spread::default();
    }
    // Whatever its sign, what is no number stands last, so that the largest value shows it.
    values.iter_mut().filter(|v| v.is_nan()).for_each(|v| *v = f64::NAN.copysign(1.0));
    values.sort_unstable_by(f64::total_cmp);
    Spread {
        mean: mean(&values),
        p95: quantile(&values, 0.95),
        p99: quantile(&values, 0.99),
        max: values[values.len() - 1],
    }
}

/// The mean. Zero where there are no values, whose sum would be −0.
pub(super) fn mean(values: &[f64]) -> f64 {
    if values.is_empty() { 0.0 } else { values.iter().sum::<f64>() / values.len() as f64 }
}

/// The largest value, none below zero. No number if one of them is none.
pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, &v| if v.is_nan() || v > most { v } else { most })
}

/// The value that a share of the sorted values lies below, interpolated between neighbours.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let (low, rest) = (at.floor() as usize, at.fract());
    let high = (low + 1).min(sorted.len() - 1);
    sorted[low] + rest * (sorted[high] - sorted[low])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_one_to_a_hundred() {
        let s = spread((1..=100).rev().map(f64::from).collect());
        approx::assert_relative_eq!(s.mean, 50.5);
        approx::assert_relative_eq!(s.p95, 95.05);
        approx::assert_relative_eq!(s.p99, 99.01);
        assert_eq!(s.max, 100.0);
        assert_eq!(spread(vec![]), Spread::default());
        assert!(mean(&[]).is_sign_positive(), "tables and files would show -0");
    }

    #[test]
    fn what_is_no_number_is_not_lost() {
        for nan in [f64::NAN, -f64::NAN] {
            assert!(spread(vec![1.0, nan, 2.0]).max.is_nan());
            assert!(largest(&[1.0, nan, 2.0]).is_nan());
        }
        assert_eq!(largest(&[1.0, 3.0, 2.0]), 3.0);
    }
}
