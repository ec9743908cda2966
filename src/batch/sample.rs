//! Samples: jobs drawn from garments and their sizes, bodies, fabrics, measures and alterations.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::error::BatchError;
use super::job::BatchJob;
use crate::io::files::relative;
use crate::io::garment::{Drawn, Ranges};
use crate::mannequin::MannequinSpec;

/// Most samples of a list: a job with ranges takes a kilobyte or so, and all of them are held in memory.
const MOST_SAMPLES: usize = 1_000_000;

/// The garments, bodies, fabrics and ranges that jobs are drawn from.
#[derive(Clone, Debug)]
pub struct SampleChoice {
    /// Garment files, each with a size of it or as it is drawn.
    pub garments: Vec<(PathBuf, Option<String>)>,
    /// Names or files of bodies.
    pub bodies: Vec<String>,
    /// Names or files of fabrics.
    pub fabrics: Vec<String>,
    /// Ranges of measures and alterations.
    pub ranges: Ranges,
}

/// Draws `count` different jobs. The same choice, count and seed give the same jobs on every machine, and a greater
/// count begins with the jobs of a smaller one, apart from the width of their ids. With ranges there are as many as are
/// asked for: when all combinations have been drawn, they are drawn again in another order with other numbers.
///
/// # Errors
/// [`BatchError::Samples`] when there are not so many.
pub fn sample(choice: &SampleChoice, count: usize, seed: u64, options: &BatchJob) -> Result<Vec<BatchJob>, BatchError> {
    let SampleChoice { garments, bodies, fabrics, ranges } = choice;
    if count > MOST_SAMPLES {
        return Err(BatchError::TooManySamples { asked: count, most: MOST_SAMPLES });
    }
    let there = garments.len().saturating_mul(bodies.len()).saturating_mul(fabrics.len());
    if count > there && (ranges.is_empty() || there == 0) {
        let (garments, bodies, fabrics) = (garments.len(), bodies.len(), fabrics.len());
        return Err(BatchError::Samples { asked: count, there, garments, bodies, fabrics });
    }
    let width = count.to_string().len();
    let specs: Vec<Option<MannequinSpec>> = bodies.iter().map(|body| MannequinSpec::load(body).ok()).collect();
    let job = |(n, k): (usize, usize)| {
        let (garment, size) = &garments[k / (bodies.len() * fabrics.len())];
        let body = k / fabrics.len() % bodies.len();
        let mut random = SplitMix64::of(seed, n as u64);
        let Drawn { measures, alter } = ranges.draw(|name| specs[body].as_ref()?.measure(name), || random.share());
        BatchJob {
            id: format!("{n:0width$}"),
            garment: vec![garment.clone()],
            size: size.clone().or_else(|| options.size.clone()),
            body: Some(bodies[body].clone()),
            fabric: Some(fabrics[k % fabrics.len()].clone()),
            measures: (!measures.is_empty()).then_some(measures),
            alter,
            ..options.clone()
        }
    };
    Ok((1..).zip(rounds(there, count, seed)).map(job).collect())
}

/// `count` of the numbers below `all`: all of them in random order, again in another, and so on.
fn rounds(all: usize, count: usize, seed: u64) -> impl Iterator<Item = usize> {
    let round = move |k: usize| {
        let left = (count - k * all).min(all);
        // The first order is that of a list without ranges.
        let seed = if k == 0 { seed } else { SplitMix64::of(seed, u64::MAX - k as u64).next() };
        shuffled(all, left, seed)
    };
    (0..count.div_ceil(all.max(1))).flat_map(round)
}

/// The first `count` of the numbers below `all` in random order: Fisher and Yates's shuffle, of which only the numbers
/// that have moved are kept.
fn shuffled(all: usize, count: usize, seed: u64) -> Vec<usize> {
    let mut random = SplitMix64(seed);
    let mut moved: HashMap<usize, usize> = HashMap::new();
    let mut drawn = Vec::with_capacity(count);
    for k in 0..count {
        let other = k + random.below(all - k);
        let here = moved.get(&k).copied().unwrap_or(k);
        drawn.push(moved.insert(other, here).unwrap_or(other));
    }
    drawn
}

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers on every machine and in every version.
struct SplitMix64(u64);

impl SplitMix64 {
    /// A generator of its own for the `n`th job of a seed.
    fn of(seed: u64, n: u64) -> Self {
        Self(Self(seed).next() ^ Self(n).next())
    }

    /// A number from 0 to 1, in steps of 2⁻⁵³.
    fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `limit`, all alike but for a part in 2⁶⁴ ⁄ `limit`.
    fn below(&mut self, limit: usize) -> usize {
        ((u128::from(self.next()) * limit as u128) >> 64) as usize
    }
}

/// The jobs as a list in `folder`: one JSON object a line, files named from there.
pub fn list_text(jobs: &[BatchJob], folder: &Path) -> String {
    let from_there = |file: &Path| relative(file, folder).unwrap_or_else(|| file.to_owned());
    let named = |name: &String| {
        let file = Path::new(name);
        if file.is_file() { from_there(file).display().to_string() } else { name.clone() }
    };
    let line = |job: &BatchJob| {
        let garment = job.garment.iter().map(|file| from_there(file)).collect();
        let (body, fabric) = (job.body.as_ref().map(named), job.fabric.as_ref().map(named));
        let job = BatchJob { garment, body, fabric, ..job.clone() };
        serde_json::to_string(&job).unwrap_or_default() + "\n"
    };
    jobs.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn the_generator_is_the_published_one() {
        let mut random = SplitMix64(1_234_567);
        assert_eq!([random.next(), random.next()], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
    }

    #[test]
    fn draws_are_different_and_begin_alike() {
        let all = shuffled(50, 50, 3);
        assert_eq!(all.iter().collect::<HashSet<_>>().len(), 50);
        assert!(all.iter().all(|&k| k < 50));
        assert_eq!(shuffled(50, 10, 3), all[..10]);
        assert_ne!(shuffled(50, 10, 4), all[..10]);
    }

    #[test]
    fn rounds_have_every_number_as_often_and_begin_alike() {
        let drawn: Vec<usize> = rounds(5, 12, 3).collect();
        assert_eq!(drawn.len(), 12);
        assert!((0..5).all(|k| [2, 3].contains(&drawn.iter().filter(|d| **d == k).count())), "{drawn:?}");
        assert_eq!(rounds(5, 7, 3).collect::<Vec<_>>(), drawn[..7]);
        assert_eq!(drawn[..5], shuffled(5, 5, 3));
        assert_ne!(drawn[..5], drawn[5..10]);
    }

    #[test]
    fn shares_fill_the_range_and_differ_from_job_to_job() {
        let shares: Vec<f64> = (1..1000).map(|n| SplitMix64::of(7, n).share()).collect();
        let mean = shares.iter().sum::<f64>() / 999.0;
        assert!((mean - 0.5).abs() < 0.03 && shares.iter().all(|s| (0.0..1.0).contains(s)), "{mean}");
        assert_ne!(shares[..5], (1..6).map(|n| SplitMix64::of(8, n).share()).collect::<Vec<_>>());
    }

    #[test]
    fn every_number_is_drawn_first_about_as_often() {
        let mut counts = [0; 6];
        (0..6000).for_each(|seed| counts[shuffled(6, 1, seed)[0]] += 1);
        assert!(counts.iter().all(|n| (850..1150).contains(n)), "{counts:?}");
    }
}
