//! How many particles go on every interval of the rim, and where.

use super::breaks::{Breaks, Run};
use super::error::{MeshError, SeamFault};
use super::links::{EdgeTable, Link};
use crate::geometry::DisjointSets;

/// Springs of a rim are at most this many spacings long. Both sides of a gathered seam get the count of their mean
/// length; past this the longer side decides.
const LONGEST_SPRING: f64 = 1.3;

/// Sampled edges: the same number of particles on both sides of every link.
pub(super) struct Sampling {
    /// Springs of every interval of every edge.
    counts: Vec<Vec<usize>>,
    /// Arc lengths of every edge's particles, both ends included.
    pub(super) at: Vec<Vec<f64>>,
}

impl Sampling {
    /// Chooses counts per group of linked intervals, so that edge e has `least[e]` springs, and spreads particles
    /// evenly between breakpoints.
    pub(super) fn new(
        edges: &EdgeTable,
        links: &[Link],
        breaks: &Breaks,
        least: &[usize],
        spacing: f64,
    ) -> Result<Self, MeshError> {
        let mut groups = Groups::new(edges.ids.len(), breaks);
        for link in links {
            let runs = [breaks.runs(link, 0), breaks.runs(link, 1)];
            if runs[0].len() != runs[1].len() {
                let fault = SeamFault::Unmatched { a: runs[0].len(), b: runs[1].len() };
                return Err(MeshError::Seam { seam: link.name.clone(), fault });
            }
            for (a, b) in runs[0].iter().zip(&runs[1]) {
                groups.join(a, b);
            }
        }
        let counts = groups.counts(breaks, least, spacing);
        let at = counts.iter().enumerate().map(|(e, n)| spread(breaks.of(e), n)).collect();
        Ok(Self { counts, at })
    }

    /// Number of springs along an interval.
    pub(super) fn springs(&self, edge: usize, interval: usize) -> usize {
        self.counts[edge][interval]
    }

    /// Position in the edge's particles of breakpoint `index`.
    pub(super) fn particle_of_break(&self, edge: usize, index: usize) -> usize {
        self.counts[edge][..index].iter().sum()
    }

    /// Positions in the edge's particles of a run, in the run's direction, both ends included.
    pub(super) fn particles_of_run(&self, run: &Run) -> Vec<usize> {
        let first = self.particle_of_break(run.edge, run.index);
        let all = first..=first + self.counts[run.edge][run.index];
        if run.forward { all.collect() } else { all.rev().collect() }
    }
}

/// Number of springs for an interval of this length.
pub(super) fn springs_for(length: f64, spacing: f64) -> usize {
    ((length / spacing).round() as usize).max(1)
}

/// Even arc lengths between breakpoints.
fn spread(breaks: &[f64], counts: &[usize]) -> Vec<f64> {
    let mut at = vec![breaks[0]];
    for (k, &n) in counts.iter().enumerate() {
        let (low, high) = (breaks[k], breaks[k + 1]);
        at.extend((1..n).map(|j| low + (high - low) * j as f64 / n as f64));
        at.push(high);
    }
    at
}

/// Disjoint sets of intervals.
struct Groups {
    /// Number of the first interval of every edge, and the total.
    first: Vec<usize>,
    sets: DisjointSets,
}

impl Groups {
    fn new(edges: usize, breaks: &Breaks) -> Self {
        let mut first = vec![0];
        for e in 0..edges {
            first.push(first[e] + breaks.of(e).len() - 1);
        }
        Self { sets: DisjointSets::new(first[edges]), first }
    }

    fn root(&mut self, edge: usize, interval: usize) -> usize {
        self.sets.root((self.first[edge] + interval) as u32) as usize
    }

    fn join(&mut self, a: &Run, b: &Run) {
        let [a, b] = [a, b].map(|run| (self.first[run.edge] + run.index) as u32);
        self.sets.join(a, b);
    }

    fn counts(&mut self, breaks: &Breaks, least: &[usize], spacing: f64) -> Vec<Vec<usize>> {
        let edges = self.first.len() - 1;
        // Shortest and longest interval of every group, and the springs that one of them needs, kept at its root.
        let mut groups = vec![(f64::INFINITY, 0.0_f64, 1); self.sets.len()];
        for (e, least) in least.iter().enumerate() {
            let intervals = breaks.of(e).len() - 1;
            for (k, w) in breaks.of(e).windows(2).enumerate() {
                let (short, long, needed) = &mut groups[self.root(e, k)];
                *short = short.min(w[1] - w[0]);
                *long = long.max(w[1] - w[0]);
                *needed = least.div_ceil(intervals).max(*needed);
            }
        }
        let count = |(short, long, needed): (f64, f64, usize)| {
            let least = (long / (LONGEST_SPRING * spacing)).ceil() as usize;
            springs_for(0.5 * (short + long), spacing).max(least).max(needed)
        };
        (0..edges).map(|e| (0..breaks.of(e).len() - 1).map(|k| count(groups[self.root(e, k)])).collect()).collect()
    }
}
