//! Zeros of functions by bisection.

use std::convert::Infallible;

/// Zero of the rising function `f` in `range`, after `halvings` halvings. Without a sign change it is the end nearer to
/// the zero.
pub(crate) fn bisect(range: [f64; 2], halvings: usize, f: impl Fn(f64) -> f64) -> f64 {
    let Ok(found) = try_bisect(range, halvings, |x| Ok::<_, Infallible>(f(x)));
    found
}

/// As [`bisect`], for a function that may fail.
pub(crate) fn try_bisect<E>(
    [mut low, mut high]: [f64; 2],
    halvings: usize,
    f: impl Fn(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if f(middle)? < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(0.5 * (low + high))
}
