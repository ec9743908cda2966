//! Whole passes over many items, handed out to threads in chunks.
//!
//! An item's result depends on nothing but the item, and sums are taken over chunks whose length is fixed, then over
//! the chunks in their order. So a pass gives the same bytes for any number of threads. A pass of one chunk stays in
//! the calling thread.
//!
//! Each thread counts the time that it spends in passes that are handed out. At one thread its share of the whole time
//! bounds what more threads can save ([`in_passes`]).

use std::cell::Cell;
use std::iter::Sum;
use std::time::{Duration, Instant};

use rayon::prelude::*;

/// Items in a chunk, where an item costs about ten nanoseconds: a few operations on numbers in a row.
pub const LIGHT: usize = 2048;
/// Items in a chunk, where an item costs about a hundred nanoseconds: a spring, a triangle, a contact.
pub const MEDIUM: usize = 256;
/// Items in a chunk, where an item costs a microsecond or more: a search in a tree or a grid.
pub const HEAVY: usize = 32;

thread_local! {
    static INSIDE: Cell<bool> = const { Cell::new(false) };
    static SPENT: Cell<Duration> = const { Cell::new(Duration::ZERO) };
}

/// Wall-clock time that the calling thread has spent in passes that were handed out. Only differences mean anything.
pub fn in_passes() -> Duration {
    SPENT.get()
}

/// Runs `pass`, which hands out its work itself, and counts its time.
pub fn pass<T>(pass: impl FnOnce() -> T) -> T {
    if INSIDE.replace(true) {
        return pass();
    }
    let begin = Instant::now();
    let out = pass();
    SPENT.set(SPENT.get() + begin.elapsed());
    INSIDE.set(false);
    out
}

/// `item(0)`, `item(1)` … up to `count`, in chunks of `chunk` items.
pub fn map<T: Send>(count: usize, chunk: usize, item: impl Fn(usize) -> T + Sync) -> Vec<T> {
    if count <= chunk {
        return (0..count).map(item).collect();
    }
    pass(|| (0..count).into_par_iter().with_min_len(chunk).map(&item).collect())
}

/// Changes every item, given its number, in chunks of `chunk` items.
pub fn for_each<T: Send>(items: &mut [T], chunk: usize, change: impl Fn(usize, &mut T) + Sync) {
    if items.len() <= chunk {
        return items.iter_mut().enumerate().for_each(|(i, item)| change(i, item));
    }
    pass(|| items.par_iter_mut().enumerate().with_min_len(chunk).for_each(|(i, item)| change(i, item)));
}

/// Changes every item, given its number, and sums what that returns, over chunks of `chunk` items and then over the
/// chunks.
pub fn for_each_sum<T: Send, S: Send + Sum<S>>(
    items: &mut [T],
    chunk: usize,
    change: impl Fn(usize, &mut T) -> S + Sync,
) -> S {
    let part =
        |(k, items): (usize, &mut [T])| items.iter_mut().zip(k * chunk..).map(|(item, i)| change(i, item)).sum::<S>();
    if items.len() <= chunk {
        return part((0, items));
    }
    let parts: Vec<S> = pass(|| items.par_chunks_mut(chunk).enumerate().map(&part).collect());
    parts.into_iter().sum()
}

/// Changes every row of items: row i is `starts[i]..starts[i + 1]`. Hands out `chunk` rows at a time.
pub fn for_each_row<T: Send>(items: &mut [T], starts: &[u32], chunk: usize, change: impl Fn(usize, &mut [T]) + Sync) {
    let rows = starts.len().saturating_sub(1);
    let all = |first: usize, last: usize, mut items: &mut [T]| {
        for row in first..last {
            let (own, rest) = items.split_at_mut((starts[row + 1] - starts[row]) as usize);
            change(row, own);
            items = rest;
        }
    };
    if rows <= chunk {
        return all(0, rows, items);
    }
    let mut parts = Vec::with_capacity(rows.div_ceil(chunk));
    let mut rest = items;
    for first in (0..rows).step_by(chunk) {
        let last = (first + chunk).min(rows);
        let (own, after) = rest.split_at_mut((starts[last] - starts[first]) as usize);
        parts.push((first, last, own));
        rest = after;
    }
    pass(|| parts.into_par_iter().for_each(|(first, last, items)| all(first, last, items)));
}

/// Numbers of the pairs of items, which are changed, that `is_chosen`, in chunks of `chunk` pairs.
pub fn select<A: Send, B: Send>(
    first: &mut [A],
    second: &mut [B],
    chunk: usize,
    is_chosen: impl Fn(&mut A, &mut B) -> bool + Sync,
) -> Vec<u32> {
    let part = |(k, (a, b)): (usize, (&mut [A], &mut [B]))| {
        let pairs = a.iter_mut().zip(b).zip((k * chunk) as u32..);
        pairs.filter_map(|((a, b), number)| is_chosen(a, b).then_some(number)).collect::<Vec<u32>>()
    };
    if first.len() <= chunk {
        return part((0, (first, second)));
    }
    let parts = || first.par_chunks_mut(chunk).zip(second.par_chunks_mut(chunk)).enumerate().map(&part).collect();
    let parts: Vec<Vec<u32>> = pass(parts);
    parts.concat()
}

/// The sum of `item(0)`, `item(1)` … up to `count`, over chunks of `chunk` items and then over the chunks.
pub fn sum(count: usize, chunk: usize, item: impl Fn(usize) -> f64 + Sync) -> f64 {
    let part = |k: usize| (k * chunk..((k + 1) * chunk).min(count)).map(&item).sum::<f64>();
    chunks(count, chunk, part).into_iter().sum()
}

/// The largest of `item(0)`, `item(1)` … up to `count`, and of 0, in chunks of `chunk` items. An item that is no number
/// counts as 0.
pub fn largest(count: usize, chunk: usize, item: impl Fn(usize) -> f64 + Sync) -> f64 {
    let part = |k: usize| (k * chunk..((k + 1) * chunk).min(count)).map(&item).fold(0.0, f64::max);
    chunks(count, chunk, part).into_iter().fold(0.0, f64::max)
}

/// `part` of every chunk, by its number.
fn chunks(count: usize, chunk: usize, part: impl Fn(usize) -> f64 + Sync) -> Vec<f64> {
    let chunks = count.div_ceil(chunk);
    if chunks <= 1 {
        return (0..chunks).map(part).collect();
    }
    pass(|| (0..chunks).into_par_iter().map(&part).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(work)
    }

    #[test]
    fn passes_give_the_same_bytes_for_any_number_of_threads() {
        let item = |i: usize| (i as f64 * 0.37).sin() / 3.0;
        let all = || {
            let mut items = map(5000, 64, item);
            for_each(&mut items, 64, |i, x| *x += item(i + 1));
            (items, sum(5000, 64, item), largest(5000, 64, item))
        };
        let one = with_threads(1, all);
        assert_eq!(one.0, (0..5000).map(|i| item(i) + item(i + 1)).collect::<Vec<_>>());
        assert!((one.1 - (0..5000).map(item).sum::<f64>()).abs() < 1e-9);
        assert_eq!(one.2, (0..5000).map(item).fold(0.0, f64::max));
        for threads in [2, 3, 8] {
            assert_eq!(with_threads(threads, all), one, "{threads} threads");
        }
    }

    #[test]
    fn nothing_sums_to_nothing() {
        assert_eq!((sum(0, 8, |_| 1.0), largest(0, 8, |_| 1.0), map(0, 8, |i| i).len()), (0.0, 0.0, 0));
    }

    #[test]
    fn the_time_of_passes_counts_once_however_deep_they_lie() {
        with_threads(1, || {
            let sleep = || std::thread::sleep(Duration::from_millis(5));
            let (from, begin) = (in_passes(), Instant::now());
            sleep();
            pass(|| pass(sleep));
            let (inside, whole) = (in_passes() - from, begin.elapsed());
            assert!(inside >= Duration::from_millis(5) && inside + Duration::from_millis(5) <= whole);
            map(4, 4, |_| sleep());
            assert!(in_passes() - from == inside, "a pass of one chunk is not handed out");
        });
    }
}
