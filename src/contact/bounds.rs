//! What keeps a step from carrying cloth through anything: a plane per pair and a leash per node.

use rayon::prelude::*;

use super::Contact;
use crate::geometry::Vec3;

/// How often a step is pushed back onto the planes it crosses before what is left is cut off.
const SWEEPS: usize = 3;

/// Half-spaces n·x ≥ c that a node must stay in until the next detection, and how far it may go at all.
#[derive(Clone, Debug)]
pub struct Bounds {
    origin: Vec<Vec3>,
    leash: f64,
    /// `starts[i]..starts[i + 1]` in `planes` are node i's.
    starts: Vec<u32>,
    planes: Vec<(Vec3, f64)>,
}

impl Bounds {
    /// Planes half-way between the sides of every cloth contact, and `margin` metres (or half the gap) off the body's
    /// surface for its single-node contacts. `reach` is the detection's: pairs that are further apart cannot meet while
    /// both sides stay within [`Bounds::allowance`].
    pub fn new(x: &[Vec3], contacts: &[Contact], reach: f64, margin: f64) -> Self {
        let mut list: Vec<(u32, Vec3, f64)> = Vec::with_capacity(4 * contacts.len());
        for contact in contacts {
            let n = contact.normal;
            if contact.body {
                let gap = contact.gap(x);
                if contact.count == 1 && gap > 0.0 {
                    list.push((contact.nodes[0], n, contact.offset + margin.min(0.5 * gap)));
                }
                continue;
            }
            let along = |k: usize| n.dot(&x[contact.nodes[k] as usize]);
            let count = contact.count as usize;
            let above = (0..count).filter(|&k| contact.weights[k] >= 0.0);
            let low = above.map(along).fold(f64::INFINITY, f64::min);
            let below = (0..count).filter(|&k| contact.weights[k] < 0.0);
            let high = below.map(along).fold(f64::NEG_INFINITY, f64::max);
            let middle = 0.5 * (low + high);
            for k in 0..count {
                let (direction, c) = if contact.weights[k] >= 0.0 { (n, middle) } else { (-n, -middle) };
                list.push((contact.nodes[k], direction, c));
            }
        }
        let mut starts = vec![0u32; x.len() + 1];
        for entry in &list {
            starts[entry.0 as usize + 1] += 1;
        }
        for i in 0..x.len() {
            starts[i + 1] += starts[i];
        }
        let mut fill = starts.clone();
        let mut planes = vec![(Vec3::zeros(), 0.0); list.len()];
        for (node, n, c) in list {
            planes[fill[node as usize] as usize] = (n, c);
            fill[node as usize] += 1;
        }
        Self { origin: x.to_vec(), leash: Self::allowance(reach), starts, planes }
    }

    /// How far a node may go between two detections: less than half the reach, so that a pair not found cannot meet.
    pub fn allowance(reach: f64) -> f64 {
        0.45 * reach
    }

    /// Largest distance any node has gone since the detection, metres.
    pub fn travelled(&self, x: &[Vec3]) -> f64 {
        x.iter().zip(&self.origin).map(|(a, b)| (a - b).norm_squared()).fold(0.0, f64::max).sqrt()
    }

    /// The share (≤ 1) of a step that keeps every node on its leash. Shortening the step as a whole keeps its shape;
    /// cutting it node by node crumples the cloth.
    pub fn share(&self, x: &[Vec3], step: &[Vec3]) -> f64 {
        let longest = step.iter().map(Vec3::norm_squared).fold(0.0, f64::max).sqrt();
        let left = self.leash - self.travelled(x);
        if longest > left { (left / longest).max(0.0) } else { 1.0 }
    }

    /// Moves every target in `to` so that the way from `from` keeps all bounds; sliding along a plane stays free.
    pub fn clamp(&self, from: &[Vec3], to: &mut [Vec3]) {
        to.par_iter_mut().enumerate().for_each(|(i, target)| {
            let planes = &self.planes[self.starts[i] as usize..self.starts[i + 1] as usize];
            *target = self.clamp_one(planes, self.origin[i], from[i], *target);
        });
    }

    fn clamp_one(&self, planes: &[(Vec3, f64)], origin: Vec3, from: Vec3, mut to: Vec3) -> Vec3 {
        for _ in 0..SWEEPS {
            let mut clean = true;
            for &(n, c) in planes {
                let depth = c - n.dot(&to);
                if depth > 0.0 {
                    to += n * depth;
                    clean = false;
                }
            }
            if clean {
                break;
            }
        }
        let mut share = 1.0f64;
        for &(n, c) in planes {
            let (before, after) = (n.dot(&from) - c, n.dot(&to) - c);
            if after < 0.0 && after < before {
                share = share.min((before / (before - after)).max(0.0));
            }
        }
        // The leash: |from + s d − origin| ≤ leash.
        let (d, o) = (to - from, from - origin);
        if (o + d * share).norm_squared() > self.leash * self.leash {
            let (a, b, c) = (d.norm_squared(), o.dot(&d), o.norm_squared() - self.leash * self.leash);
            let root = (b * b - a * c).max(0.0).sqrt();
            share = share.min(((root - b) / a).max(0.0));
        }
        from + d * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn pair() -> ([Vec3; 2], Contact) {
        let x = [Vec3::new(0.0, 0.01, 0.0), Vec3::zeros()];
        let contact = Contact {
            nodes: [0, 1, 0, 0],
            weights: [1.0, -1.0, 0.0, 0.0],
            count: 2,
            normal: Vec3::y(),
            offset: 0.0,
            body: false,
        };
        (x, contact)
    }

    #[test]
    fn two_points_that_rush_at_each_other_stop_half_way_and_may_slide() {
        let (x, contact) = pair();
        let bounds = Bounds::new(&x, &[contact], 0.1, 0.0);
        let mut to = [Vec3::new(0.02, -0.02, 0.0), Vec3::new(0.0, 0.03, 0.0)];
        bounds.clamp(&x, &mut to);
        assert_relative_eq!(to[0], Vec3::new(0.02, 0.005, 0.0), epsilon = 1e-12);
        assert_relative_eq!(to[1], Vec3::new(0.0, 0.005, 0.0), epsilon = 1e-12);
    }

    #[test]
    fn nothing_goes_further_than_its_leash() {
        let (x, contact) = pair();
        let bounds = Bounds::new(&x, &[contact], 0.1, 0.0);
        let mut to = [Vec3::new(1.0, 1.0, 0.0), x[1]];
        bounds.clamp(&x, &mut to);
        assert_relative_eq!((to[0] - x[0]).norm(), 0.045, epsilon = 1e-12);
    }
}
