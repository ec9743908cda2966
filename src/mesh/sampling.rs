//! Number and places of particles on every interval of the rim.

use super::breaks::{BreakInterval, Breaks};
use super::error::{MeshError, SeamFault};
use super::links::{EdgeTable, LinkedChains};
use crate::geometry::DisjointSets;

/// Largest length of a rim spring, in spacings. Both sides of a gathered seam get the count of their mean length,
/// unless springs of the longer side would exceed this.
const LONGEST_SPRING: f64 = 1.3;

/// Wanted sampling of an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wish {
    /// Springs it has at least.
    pub(super) least: usize,
    /// Length of its springs, metres.
    pub(super) spacing: f64,
}

/// Sampled edges: the same number of particles on both sides of every link.
pub(super) struct Sampling {
    /// Springs of every interval of every edge.
    counts: Vec<Vec<usize>>,
    /// Arc lengths of every edge's particles, both ends included.
    pub(super) at: Vec<Vec<f64>>,
}

impl Sampling {
    /// Chooses counts per group of linked intervals from the wishes of their edges, and spreads particles evenly
    /// between breakpoints. The finest wish of a group decides.
    pub(super) fn new(
        edges: &EdgeTable,
        links: &[LinkedChains],
        breaks: &Breaks,
        wishes: &[Wish],
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
        let counts = groups.counts(breaks, wishes);
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
    pub(super) fn particles_of_run(&self, run: &BreakInterval) -> Vec<usize> {
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

    fn join(&mut self, a: &BreakInterval, b: &BreakInterval) {
        let [a, b] = [a, b].map(|run| (self.first[run.edge] + run.index) as u32);
        self.sets.join(a, b);
    }

    fn counts(&mut self, breaks: &Breaks, wishes: &[Wish]) -> Vec<Vec<usize>> {
        let edges = self.first.len() - 1;
        let mut groups = vec![Group::default(); self.sets.len()];
        for (e, wish) in wishes.iter().enumerate() {
            let intervals = breaks.of(e).len() - 1;
            for (k, w) in breaks.of(e).windows(2).enumerate() {
                let group = &mut groups[self.root(e, k)];
                group.short = group.short.min(w[1] - w[0]);
                group.long = group.long.max(w[1] - w[0]);
                group.least = wish.least.div_ceil(intervals).max(group.least);
                group.spacing = group.spacing.min(wish.spacing);
            }
        }
        let mut count = |e: usize, k: usize| groups[self.root(e, k)].springs();
        (0..edges).map(|e| (0..breaks.of(e).len() - 1).map(|k| count(e, k)).collect()).collect()
    }
}

/// Intervals that get the same number of springs.
#[derive(Clone, Copy)]
struct Group {
    /// Length of the shortest interval.
    short: f64,
    /// Length of the longest.
    long: f64,
    /// Springs that one of them needs.
    least: usize,
    /// Finest spacing among them, metres.
    spacing: f64,
}

impl Default for Group {
    fn default() -> Self {
        Self { short: f64::INFINITY, long: 0.0, least: 1, spacing: f64::INFINITY }
    }
}

impl Group {
    fn springs(&self) -> usize {
        let least = (self.long / (LONGEST_SPRING * self.spacing)).ceil() as usize;
        springs_for(0.5 * (self.short + self.long), self.spacing).max(least).max(self.least)
    }
}
