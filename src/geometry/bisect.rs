//! Where a function passes zero.

use std::convert::Infallible;

/// Where `f`, which rises, passes 0 between `low` and `high`, in so many halvings;
/// the end nearer to it where it does not.
pub(crate) fn bisect(range: [f64; 2], halvings: usize, f: impl Fn(f64) -> f64) -> f64 {
    let Ok(found) = try_bisect(range, halvings, |x| Ok::<_, Infallible>(f(x)));
    found
}

/// As [`bisect`], of a function that may fail.
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
