//! Mean and quantiles.

use super::schema::Spread;

/// The spread of `values`; zeros when there are none.
pub(super) fn spread(mut values: Vec<f64>) -> Spread {
    if values.is_empty() {
        return Spread::default();
    }
    values.sort_unstable_by(f64::total_cmp);
    Spread {
        mean: values.iter().sum::<f64>() / values.len() as f64,
        p95: quantile(&values, 0.95),
        p99: quantile(&values, 0.99),
        max: values[values.len() - 1],
    }
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
    }
}
