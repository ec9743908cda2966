//! Of the contacts that were found, those that matter in the next step.
//!
//! Contacts are looked for far enough around that many steps can do without looking again; so most of what is found
//! lies too far apart to push, or to be kept apart, in any one of them (nineteen out of twenty, in a garment that hangs
//! almost still). A gap shrinks by no more than its nodes move: that bound, which is cheap, says which to evaluate.

use rayon::prelude::*;

use super::ONE_THREAD;
use crate::contact::Contact;
use crate::geometry::Vec3;

/// A node is expected to go no further in a step than so many times what it went in the last, and a little, metres.
const FORESIGHT: f64 = 1.5;
const LITTLE: f64 = 0.1e-3;

/// What the bound of a contact is made of.
struct Found {
    nodes: [u32; 4],
    count: u8,
    above: u8,
    /// Whether it has to be kept apart: what was found in the body must come out.
    outside: bool,
    /// The step after which it was last turned to where its closest points are.
    turned: u32,
    /// Gap where it was found, metres.
    gap: f64,
}

impl Found {
    fn new(contact: &Contact, x: &[Vec3]) -> Self {
        let gap = contact.gap(x);
        let Contact { nodes, count, above, .. } = *contact;
        Self { nodes, count, above, outside: !contact.is_on_body() || gap > 0.0, turned: 0, gap }
    }

    /// A gap that it cannot be below where node i is within `moved[i]` of where it was when the
    /// contact was found, metres.
    fn least(&self, moved: &[f64]) -> f64 {
        let most = |nodes: &[u32]| nodes.iter().map(|&n| moved[n as usize]).fold(0.0, f64::max);
        let (above, below) = self.nodes[..self.count as usize].split_at(self.above as usize);
        self.gap - most(above) - most(below)
    }
}

/// The contacts of a step, and how far each node may go in it for no other to matter.
pub(super) struct Near {
    found: Vec<Found>,
    /// Where nodes were when contacts were looked for.
    origin: Vec<Vec3>,
    /// Contacts matter below this gap, metres.
    gap: f64,
    /// Steps since contacts were looked for.
    step: u32,
    /// How far each node may go, metres.
    may: Vec<f64>,
    /// The contacts that matter, turned to where their closest points are.
    pub(super) contacts: Vec<Contact>,
    /// Their numbers among those that were found.
    number: Vec<u32>,
}

impl Near {
    /// For `nodes` nodes, whose contacts matter below `gap` metres.
    pub(super) fn new(nodes: usize, gap: f64) -> Self {
        let (found, origin, contacts, number) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { found, origin, gap, step: 0, may: vec![LITTLE; nodes], contacts, number }
    }

    /// Starts anew with the contacts found at `x`.
    pub(super) fn begin(&mut self, all: &mut [Contact], x: &[Vec3]) {
        self.found = all.par_iter().with_min_len(ONE_THREAD).map(|c| Found::new(c, x)).collect();
        self.origin = x.to_vec();
        self.step = 0;
        self.choose(all, x);
    }

    /// Expects the nodes, which went from `last` to `x`, to go on like that.
    pub(super) fn foresee(&mut self, last: &[Vec3], x: &[Vec3]) {
        for (may, (a, b)) in self.may.iter_mut().zip(last.iter().zip(x)) {
            *may = FORESIGHT * (b - a).norm() + LITTLE;
        }
    }

    /// Follows the nodes, which made a step to `x`.
    pub(super) fn follow(&mut self, all: &mut [Contact], x: &[Vec3]) {
        self.step += 1;
        self.choose(all, x);
    }

    /// Takes in what matters when the nodes go from `x` to `to`. Returns whether all of that was there already.
    pub(super) fn covers(&mut self, all: &mut [Contact], x: &[Vec3], to: &[Vec3]) -> bool {
        let mut covered = true;
        for (may, (a, b)) in self.may.iter_mut().zip(x.iter().zip(to)) {
            let way = (b - a).norm();
            if way > *may || way.is_nan() {
                (*may, covered) = (FORESIGHT * way + LITTLE, false);
            }
        }
        if !covered {
            self.choose(all, x);
        }
        covered
    }

    /// Those that have to be kept apart.
    pub(super) fn apart(&self) -> Vec<&Contact> {
        let outside = |k: &u32| self.found[*k as usize].outside;
        self.contacts.iter().zip(&self.number).filter(|(_, k)| outside(k)).map(|(c, _)| c).collect()
    }

    /// Turns a contact that was found at or before the last step to `x`, wherever its nodes went meanwhile.
    pub(super) fn turn(&self, k: usize, contact: &mut Contact, x: &[Vec3]) {
        let found = &self.found[k];
        turn(contact, found, found.turned == self.step, x);
    }

    fn choose(&mut self, all: &mut [Contact], x: &[Vec3]) {
        let (step, gap) = (self.step, self.gap);
        let moved: Vec<f64> =
            x.iter().zip(&self.origin).zip(&self.may).map(|((x, o), may)| (x - o).norm() + may).collect();
        let matters = |found: &mut Found, contact: &mut Contact| {
            let least = found.least(&moved);
            let matters = least < gap || least.is_nan();
            if matters && found.turned != step {
                turn(contact, found, found.turned + 1 == step, x);
                found.turned = step;
            }
            matters
        };
        let chosen: Vec<bool> = self
            .found
            .par_iter_mut()
            .zip(all.par_iter_mut())
            .with_min_len(ONE_THREAD)
            .map(|(found, contact)| matters(found, contact))
            .collect();
        self.number = (0..all.len() as u32).filter(|&k| chosen[k as usize]).collect();
        self.contacts = self.number.iter().map(|&k| all[k as usize]).collect();
    }
}

/// Turns a contact to where its closest points are now. The share of one that mattered in the last step follows half
/// the way: a large load that changed with it at once would throw its nodes to and fro for ever. One that did not has
/// stayed on its side.
fn turn(contact: &mut Contact, found: &Found, mattered: bool, x: &[Vec3]) {
    let share = contact.share;
    contact.refresh(x);
    if mattered {
        contact.share = 0.5 * (contact.share + share);
    } else if found.outside && contact.gap(x) < 0.0 {
        contact.turn_over();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Under;

    /// Metres.
    const GAP: f64 = 1e-3;

    fn over_floor(height: f64) -> (Vec<Vec3>, Vec<Contact>) {
        (vec![Vec3::y() * height], vec![Contact::on_body(0, Vec3::y(), Vec3::zeros())])
    }

    #[test]
    fn what_is_far_matters_once_a_node_may_go_there() {
        let (x, mut all) = over_floor(0.01);
        let mut near = Near::new(1, GAP);
        near.begin(&mut all, &x);
        assert!(near.contacts.is_empty());
        assert!(near.covers(&mut all, &x, &x));
        let to = [Vec3::y() * 0.0005];
        assert!(!near.covers(&mut all, &x, &to), "it comes within a millimetre");
        assert_eq!(near.contacts.len(), 1);
        assert!(near.covers(&mut all, &x, &to));
    }

    #[test]
    fn what_matters_follows_from_how_far_nodes_have_gone_in_all() {
        let (mut x, mut all) = over_floor(0.01);
        let mut near = Near::new(1, GAP);
        near.begin(&mut all, &x);
        let mut seen = false;
        while x[0].y > 1.1 * GAP {
            let last = x.clone();
            x[0].y -= 0.5e-3;
            near.foresee(&last, &x);
            near.follow(&mut all, &x);
            seen = !near.contacts.is_empty();
            assert!(seen || x[0].y > 1.9 * GAP);
        }
        assert!(seen);
    }

    #[test]
    fn cloth_that_went_round_an_edge_is_on_its_outside_still() {
        let under = Under::Edge { number: 0, ends: [Vec3::z() * -0.1, Vec3::z() * 0.1] };
        let along = [Vec3::z() * -0.1, Vec3::z() * 0.1];
        let mut x: Vec<Vec3> = along.iter().map(|p| p + Vec3::new(0.0, 0.005, 0.0)).collect();
        // Not parallel to it, or there would be no closest points.
        x[1].x += 0.001;
        let mut all = vec![Contact::on_feature([0, 1, 0, 0], 2, under, Vec3::y(), &x).expect("apart")];
        let mut near = Near::new(2, GAP);
        near.begin(&mut all, &x);
        near.follow(&mut all, &x);
        assert!(near.contacts.is_empty());
        let last = x.clone();
        x.iter_mut().for_each(|p| *p += Vec3::new(0.004, -0.008, 0.0));
        near.foresee(&last, &x);
        near.follow(&mut all, &x);
        assert!(near.contacts[0].gap(&x) > 0.0, "{:?}", near.contacts[0]);
        assert_eq!(near.apart().len(), 1);
    }

    #[test]
    fn what_is_in_the_body_need_not_be_kept_apart() {
        let (x, mut all) = over_floor(-0.002);
        let mut near = Near::new(1, GAP);
        near.begin(&mut all, &x);
        assert_eq!((near.contacts.len(), near.apart().len()), (1, 0));
    }
}
