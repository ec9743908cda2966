//! Breakpoints: places on edges where a particle must be, carried through seams until nothing new appears.

use super::error::{MeshError, SeamFault};
use super::links::{EdgeTable, LinkedChains, SAME_PLACE};
use crate::pattern::Garment;

/// Growth of the number of breakpoints at which the search is given up. A breakpoint appears once per edge it is sewn
/// to, and garments sew an edge through a few others at most. Only a stretch that is sewn to a shifted copy of itself
/// goes on without end.
const ENDLESS: usize = 60;

/// Sorted breakpoints of every edge (arc lengths). First and last are the edge's ends.
pub(super) struct Breaks(Vec<Vec<f64>>);

/// A directed interval between two neighbouring breakpoints of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BreakInterval {
    /// Edge number.
    pub(super) edge: usize,
    /// Interval: from breakpoint `index` to `index + 1`.
    pub(super) index: usize,
    /// Whether the chain walks it in the edge's direction.
    pub(super) forward: bool,
}

impl Breaks {
    /// Closes `seeds`, the edges' ends and the links' own places under all links.
    pub(super) fn close(
        edges: &EdgeTable,
        links: &[LinkedChains],
        seeds: &[(usize, f64)],
        garment: &Garment,
    ) -> Result<Self, MeshError> {
        let mut breaks = Self(edges.lengths.iter().map(|&l| vec![0.0, l]).collect());
        let mut queue: Vec<(usize, f64)> =
            edges.lengths.iter().enumerate().flat_map(|(e, &l)| [(e, 0.0), (e, l)]).collect();
        for (edge, s) in seeds.iter().copied().chain(links.iter().flat_map(LinkedChains::seeds)) {
            if breaks.insert(edge, s) {
                queue.push((edge, s));
            }
        }
        let limit = ENDLESS * queue.len();
        let users = users(edges.ids.len(), links);
        let mut next = 0;
        while next < queue.len() {
            let (edge, s) = queue[next];
            next += 1;
            for &(link, side, stretch) in &users[edge] {
                let link = &links[link];
                let Some(u) = link.chains[side][stretch].station(s) else { continue };
                for place in link.places(1 - side, link.across(side, u)) {
                    if breaks.insert(place.0, place.1) {
                        queue.push(place);
                    }
                }
            }
            if queue.len() > limit {
                return Err(breaks.endless(edges, garment));
            }
        }
        breaks.reconcile(links)?;
        Ok(breaks)
    }

    /// Breakpoints of an edge.
    pub(super) fn of(&self, edge: usize) -> &[f64] {
        &self.0[edge]
    }

    /// Number of the breakpoint nearest to `s`.
    pub(super) fn nearest(&self, edge: usize, s: f64) -> usize {
        let at = &self.0[edge];
        let above = at.partition_point(|&x| x < s).min(at.len() - 1);
        if above > 0 && s - at[above - 1] < at[above] - s { above - 1 } else { above }
    }

    /// The intervals a chain walks, in order.
    pub(super) fn runs(&self, link: &LinkedChains, side: usize) -> Vec<BreakInterval> {
        let mut runs = Vec::new();
        for stretch in &link.chains[side] {
            let (a, b) = (self.nearest(stretch.edge, stretch.from), self.nearest(stretch.edge, stretch.to));
            let run = |index, forward| BreakInterval { edge: stretch.edge, index, forward };
            if a <= b {
                runs.extend((a..b).map(|k| run(k, true)));
            } else {
                runs.extend((b..a).rev().map(|k| run(k, false)));
            }
        }
        runs
    }

    /// Adds a breakpoint unless there is one at the same place.
    fn insert(&mut self, edge: usize, s: f64) -> bool {
        let at = &mut self.0[edge];
        let k = at.partition_point(|&x| x < s);
        let near = |x: Option<&f64>| x.is_some_and(|x| (x - s).abs() <= SAME_PLACE);
        if k == 0 || k == at.len() || near(at.get(k)) || near(at.get(k - 1)) {
            return false;
        }
        at.insert(k, s);
        true
    }

    /// Two breakpoints just far enough apart to be two may meet on the shorter side of a gathered seam, where they
    /// count as one. Removes such doubles until both sides of every link have as many intervals.
    fn reconcile(&mut self, links: &[LinkedChains]) -> Result<(), MeshError> {
        let mut changed = true;
        while changed {
            changed = false;
            for link in links {
                let runs = [self.runs(link, 0), self.runs(link, 1)];
                if runs[0].len() == runs[1].len() {
                    continue;
                }
                let longer = usize::from(runs[1].len() > runs[0].len());
                if !self.remove_closest(&runs[longer]) {
                    let fault = SeamFault::Unmatched { a: runs[0].len(), b: runs[1].len() };
                    return Err(MeshError::Seam { seam: link.name.clone(), fault });
                }
                changed = true;
            }
        }
        Ok(())
    }

    /// Removes the breakpoint of the chain, not an edge's end, that ends the shortest interval.
    fn remove_closest(&mut self, runs: &[BreakInterval]) -> bool {
        let gap = |r: &BreakInterval| self.0[r.edge][r.index + 1] - self.0[r.edge][r.index];
        let mut order: Vec<&BreakInterval> = runs.iter().collect();
        order.sort_by(|x, y| gap(x).total_cmp(&gap(y)));
        for run in order {
            let last = self.0[run.edge].len() - 1;
            if let Some(k) = [run.index, run.index + 1].into_iter().find(|&k| k > 0 && k < last) {
                self.0[run.edge].remove(k);
                return true;
            }
        }
        false
    }

    fn endless(&self, edges: &EdgeTable, garment: &Garment) -> MeshError {
        let edge = (0..self.0.len()).max_by_key(|&e| self.0[e].len()).unwrap_or(0);
        let id = edges.ids[edge];
        let piece = &garment.pieces[id.piece];
        MeshError::Endless {
            piece: piece.name.clone(),
            edge: piece.loops[id.ring][id.index].name.clone(),
            count: self.0[edge].len(),
        }
    }
}

/// For every edge the (link, side, stretch) that use it.
fn users(edges: usize, links: &[LinkedChains]) -> Vec<Vec<(usize, usize, usize)>> {
    let mut users = vec![Vec::new(); edges];
    for (l, link) in links.iter().enumerate() {
        for (side, chain) in link.chains.iter().enumerate() {
            for (k, stretch) in chain.iter().enumerate() {
                users[stretch.edge].push((l, side, k));
            }
        }
    }
    users
}
