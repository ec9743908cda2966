//! Narrow phase: the contacts, among those found, that can matter in the next step.
//!
//! The search radius is large enough for many steps. So most contacts are too far apart to push, or to need keeping
//! apart, in any single step: nineteen out of twenty in a garment that hangs almost still. A gap shrinks by no more
//! than its nodes move. This cheap bound selects the contacts to evaluate.

use crate::contact::Contact;
use crate::geometry::Vec3;
use crate::parallel::{self, LIGHT, MEDIUM};

/// Expected motion of a node in a step, in multiples of its motion in the last step ([`LITTLE`] is added). Nodes that
/// go further make the selection be renewed.
const FORESIGHT: f64 = 1.5;
/// Constant part of the expected motion of a node, metres.
const LITTLE: f64 = 0.1e-3;

/// Data for the bound of a contact's gap.
struct Found {
    nodes: [u32; 4],
    count: u8,
    above: u8,
    /// Whether it must be kept apart. Cloth that was found inside the body must come out, and is not.
    outside: bool,
    /// Number of the step after which its closest points were last updated.
    turned: u32,
    /// For a contact with a feature of the body: the triangle or edge of the cloth, in the caller's numbering.
    element: Option<u32>,
    /// Gap when it was found, plus the distances of its nodes from their origins then, metres.
    gap: f64,
}

impl Found {
    /// Data of a `contact` found at `x`, where node i is `gone[i]` metres from its origin.
    fn new((contact, element): &Source, x: &[Vec3], gone: &[f64], turned: u32) -> Self {
        let gap = contact.gap(x);
        let Contact { nodes, count, above, .. } = *contact;
        let outside = !contact.is_on_body() || gap > 0.0;
        let mut out = Self { nodes, count, above, outside, turned, element: *element, gap };
        out.gap = out.least(gone);
        out
    }

    /// Lower bound of the gap while node i is within `moved[i]` metres of its origin, metres.
    fn least(&self, moved: &[f64]) -> f64 {
        let most = |nodes: &[u32]| nodes.iter().map(|&n| moved[n as usize]).fold(0.0, f64::max);
        let (above, below) = self.nodes[..self.count as usize].split_at(self.above as usize);
        self.gap - most(above) - most(below)
    }
}

/// A contact, and for a feature of the body the triangle or edge of the cloth that meets it.
pub(super) type Source<'a> = (Contact<'a>, Option<u32>);

/// Contacts that are set aside while their nodes are held.
pub(super) struct Aside<'a> {
    all: Vec<Contact<'a>>,
    found: Vec<Found>,
    /// Number of the step after which they were set aside.
    step: u32,
}

impl<'a> Aside<'a> {
    /// The contacts.
    pub(super) fn contacts(&self) -> &[Contact<'a>] {
        &self.all
    }
}

/// The contacts that matter in a step, and the motion per node up to which no other matters.
pub(super) struct Near<'a> {
    /// All contacts found. Their closest points are those of the last time they mattered.
    pub(super) all: Vec<Contact<'a>>,
    found: Vec<Found>,
    /// Contacts matter below this gap, metres.
    gap: f64,
    /// Steps made.
    step: u32,
    /// Allowed motion of each node, metres.
    may: Vec<f64>,
    /// The contacts that matter, with up-to-date closest points.
    pub(super) contacts: Vec<Contact<'a>>,
    /// Indices of these contacts in `all`.
    number: Vec<u32>,
}

impl<'a> Near<'a> {
    /// An empty selection for `nodes` nodes. Contacts matter below a gap of `gap` metres.
    pub(super) fn new(nodes: usize, gap: f64) -> Self {
        let (all, found, contacts, number) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { all, found, gap, step: 0, may: vec![LITTLE; nodes], contacts, number }
    }

    /// The triangles and edges of the cloth that are inside the body, according to their contacts with its features.
    pub(super) fn under<'b>(&'b self, x: &'b [Vec3]) -> impl Iterator<Item = u32> + 'b {
        let inside = self.contacts.iter().zip(&self.number).filter(|(contact, _)| contact.gap(x) <= 0.0);
        inside.filter_map(|(_, k)| self.found[*k as usize].element)
    }

    /// Removes contacts that do not `stay`. Returns those of them at the `wanted` triangles and edges, sorted by these,
    /// with their closest points at `x`.
    pub(super) fn retain(
        &mut self,
        x: &[Vec3],
        stay: impl Fn(&Contact, Option<u32>) -> bool + Sync,
        wanted: impl Fn(u32) -> bool,
    ) -> Vec<(u32, Contact<'a>)> {
        let stays = parallel::map(self.all.len(), LIGHT, |k| stay(&self.all[k], self.found[k].element));
        let mut left = Vec::new();
        for k in (0..stays.len()).filter(|&k| !stays[k]) {
            let found = &self.found[k];
            if let Some(element) = found.element.filter(|&k| wanted(k)) {
                let mut contact = self.all[k];
                turn(&mut contact, found, found.turned == self.step, x);
                left.push((element, contact));
            }
        }
        retain_unordered(&mut self.all, &stays);
        retain_unordered(&mut self.found, &stays);
        left.sort_by_key(|l| l.0);
        left
    }

    /// Sets contacts aside whose nodes are all held.
    pub(super) fn set_aside(&mut self, x: &[Vec3], origin: &[Vec3], is_held: &[bool]) -> Aside<'a> {
        let rests: Vec<bool> = self.all.iter().map(|c| c.parts().all(|(i, _)| is_held[i])).collect();
        let (all, found) = (extract(&mut self.all, &rests), extract(&mut self.found, &rests));
        self.choose(x, origin);
        Aside { all, found, step: self.step }
    }

    /// Takes back contacts that were set aside.
    pub(super) fn take_back(&mut self, x: &[Vec3], origin: &[Vec3], aside: Aside<'a>) {
        let Aside { all, found, step } = aside;
        self.all.extend(all);
        let now = self.step;
        self.found
            .extend(found.into_iter().map(|f| Found { turned: if f.turned == step { now } else { f.turned }, ..f }));
        self.choose(x, origin);
    }

    /// Adds the contacts found at `x`. The motion of every node is measured from its `origin`.
    pub(super) fn add(&mut self, sources: &[Source<'a>], x: &[Vec3], origin: &[Vec3]) {
        let gone = parallel::map(x.len(), LIGHT, |i| (x[i] - origin[i]).norm());
        // In the step that now begins.
        let turned = self.step + 1;
        self.all.extend(sources.iter().map(|s| s.0));
        self.found.extend(parallel::map(sources.len(), MEDIUM, |k| Found::new(&sources[k], x, &gone, turned)));
    }

    /// Sets the expected motion of nodes that went from `last` to `x`.
    pub(super) fn foresee(&mut self, last: &[Vec3], x: &[Vec3]) {
        for (may, (a, b)) in self.may.iter_mut().zip(last.iter().zip(x)) {
            *may = FORESIGHT * (b - a).norm() + LITTLE;
        }
    }

    /// Updates the selection after a step to `x`. Motions are measured from `origin`.
    pub(super) fn follow(&mut self, x: &[Vec3], origin: &[Vec3]) {
        self.step += 1;
        self.choose(x, origin);
    }

    /// Adds the contacts that matter on the way from `x` to `to`. Motions are measured from `origin`. Returns whether
    /// all of them were there already.
    pub(super) fn covers(&mut self, x: &[Vec3], to: &[Vec3], origin: &[Vec3]) -> bool {
        let mut covered = true;
        for (may, (a, b)) in self.may.iter_mut().zip(x.iter().zip(to)) {
            // A motion that is not a number counts as infinite.
            let way = (b - a).norm().min(f64::INFINITY);
            if way > *may {
                (*may, covered) = (FORESIGHT * way + LITTLE, false);
            }
        }
        if !covered {
            self.choose(x, origin);
        }
        covered
    }

    /// The contacts that matter, with their closest points at `to` and the shares that they have now.
    ///
    /// A contact's force is the gradient of its energy while its share stays. A line search that judged a step by new
    /// shares found no step that lowers the energy of an edge pressed between two others: its force stayed unbalanced.
    pub(super) fn after(&self, to: &[Vec3]) -> Vec<Contact<'a>> {
        let turned = |contact: &Contact<'a>| {
            let mut turned = *contact;
            turned.refresh(to);
            turned.share = contact.share;
            turned
        };
        parallel::map(self.contacts.len(), MEDIUM, |k| turned(&self.contacts[k]))
    }

    /// The contacts that must be kept apart.
    pub(super) fn apart(&self) -> Vec<&Contact<'a>> {
        let outside = |k: &u32| self.found[*k as usize].outside;
        self.contacts.iter().zip(&self.number).filter(|(_, k)| outside(k)).map(|(c, _)| c).collect()
    }

    fn choose(&mut self, x: &[Vec3], origin: &[Vec3]) {
        let (step, gap) = (self.step, self.gap);
        let moved = parallel::map(x.len(), LIGHT, |i| (x[i] - origin[i]).norm() + self.may[i]);
        let matters = |found: &mut Found, contact: &mut Contact| {
            let least = found.least(&moved);
            let matters = least < gap || least.is_nan();
            if matters && found.turned != step {
                turn(contact, found, found.turned + 1 == step, x);
                found.turned = step;
            }
            matters
        };
        self.number = parallel::select(&mut self.found, &mut self.all, LIGHT, matters);
        self.contacts = parallel::map(self.number.len(), LIGHT, |k| self.all[self.number[k] as usize]);
    }
}

/// Removes the items that go, and returns them.
fn extract<T>(items: &mut Vec<T>, goes: &[bool]) -> Vec<T> {
    let mut at = goes.iter();
    items.extract_if(.., |_| at.next().is_some_and(|goes| *goes)).collect()
}

/// Keeps the items that stay. The last ones fill the gaps: most stay, so that few are moved.
fn retain_unordered<T>(items: &mut Vec<T>, stays: &[bool]) {
    for k in (0..items.len()).rev().filter(|&k| !stays[k]) {
        items.swap_remove(k);
    }
}

/// Updates the closest points of a contact. A contact that did not matter in the last step has stayed on its side.
fn turn(contact: &mut Contact, found: &Found, mattered: bool, x: &[Vec3]) {
    if mattered {
        turn_on(contact, x);
        return;
    }
    contact.refresh(x);
    if found.outside && contact.gap(x) < 0.0 {
        contact.turn_over();
    }
}

/// Updates the closest points of a contact that mattered in the last step. Its share follows half of the way only: a
/// large load that changed at once would throw its nodes to and fro for ever.
fn turn_on(contact: &mut Contact, x: &[Vec3]) {
    let share = contact.share;
    contact.refresh(x);
    contact.share = 0.5 * (contact.share + share);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Feature, Under};

    /// Metres.
    const GAP: f64 = 1e-3;

    fn over_floor(height: f64) -> (Vec<Vec3>, Near<'static>) {
        let x = vec![Vec3::y() * height];
        let near = found(vec![Contact::on_body(0, Vec3::y(), Vec3::zeros())], &x);
        (x, near)
    }

    /// The selection after `contacts` were found at `x`.
    fn found<'a>(contacts: Vec<Contact<'a>>, x: &[Vec3]) -> Near<'a> {
        let mut near = Near::new(x.len(), GAP);
        near.add(&contacts.into_iter().map(|c| (c, None)).collect::<Vec<_>>(), x, x);
        near.follow(x, x);
        near
    }

    #[test]
    fn what_is_far_matters_once_a_node_may_go_there() {
        let (x, mut near) = over_floor(0.01);
        assert!(near.contacts.is_empty());
        assert!(near.covers(&x, &x, &x));
        let to = [Vec3::y() * 0.0005];
        assert!(!near.covers(&x, &to, &x), "it comes within a millimetre");
        assert_eq!(near.contacts.len(), 1);
        assert!(near.covers(&x, &to, &x));
    }

    #[test]
    fn what_matters_follows_from_how_far_nodes_have_gone_in_all() {
        let (mut x, mut near) = over_floor(0.01);
        let origin = x.clone();
        let mut seen = false;
        while x[0].y > 1.1 * GAP {
            let last = x.clone();
            x[0].y -= 0.5e-3;
            near.foresee(&last, &x);
            near.follow(&x, &origin);
            seen = !near.contacts.is_empty();
            assert!(seen || x[0].y > 1.9 * GAP);
        }
        assert!(seen);
    }

    #[test]
    fn a_contact_found_on_the_way_is_bound_by_the_way_back_too() {
        // Found 3 mm over the floor by a node that had come down by 2 mm from where its way is measured from: there its
        // way is nothing, and it may be anywhere up to 2 mm nearer than where the contact was found.
        let (x, origin) = ([Vec3::y() * 3e-3], [Vec3::y() * 5e-3]);
        let mut near = Near::new(1, GAP);
        near.add(&[(Contact::on_body(0, Vec3::y(), Vec3::zeros()), None)], &x, &origin);
        let low = [Vec3::y() * 3.2e-3];
        near.follow(&low, &origin);
        assert_eq!(near.contacts.len(), 1, "no bound from 1.8 mm of way says that it has not come down");
    }

    #[test]
    fn what_does_not_stay_is_handed_back_with_its_element() {
        let x = [Vec3::y() * 0.5e-3, Vec3::y() * 2e-3];
        let of = |node| Contact::on_body(node, Vec3::y(), Vec3::zeros());
        let mut near = Near::new(2, GAP);
        near.add(&[(of(0), Some(7)), (of(1), Some(3)), (of(0), None)], &x, &x);
        near.follow(&x, &x);
        assert_eq!(near.contacts.len(), 2);
        near.add(&[(of(0), Some(9))], &x, &x);
        let left = near.retain(&x, |contact, _| contact.nodes[0] == 1, |element| element < 9);
        assert_eq!(left.iter().map(|l| l.0).collect::<Vec<_>>(), [7]);
        assert_eq!(near.all.len(), 1);
        near.follow(&x, &x);
        assert!(near.contacts.is_empty());
    }

    #[test]
    fn cloth_that_went_round_an_edge_is_on_its_outside_still() {
        let along = [Vec3::z() * -0.1, Vec3::z() * 0.1];
        let edge = Feature { number: 0, corners: along };
        let mut x: Vec<Vec3> = along.iter().map(|p| p + Vec3::new(0.0, 0.005, 0.0)).collect();
        // Not parallel to it, or there would be no closest points.
        x[1].x += 0.001;
        let origin = x.clone();
        let mut near = found(
            vec![Contact::on_feature([0, 1, 0, 0], 2, Under::Edge(&edge), Vec3::y(), &x, 0.01).expect("apart")],
            &x,
        );
        near.follow(&x, &origin);
        assert!(near.contacts.is_empty());
        let last = x.clone();
        x.iter_mut().for_each(|p| *p += Vec3::new(0.004, -0.008, 0.0));
        near.foresee(&last, &x);
        near.follow(&x, &origin);
        assert!(near.contacts[0].gap(&x) > 0.0, "{:?}", near.contacts[0]);
        assert_eq!(near.apart().len(), 1);
    }

    #[test]
    fn a_step_is_judged_by_the_planes_that_follow_it_and_by_the_shares_before_it() {
        // An edge of the cloth over one of the body, askew to it and almost past it.
        let edge = Feature { number: 0, corners: [Vec3::z() * -0.1, Vec3::z() * 0.1] };
        let mut x = vec![Vec3::new(-1e-3, 0.5e-3, 0.0), Vec3::new(0.02e-3, 0.4e-3, 2e-3)];
        let origin = x.clone();
        let contact = Contact::on_feature([0, 1, 0, 0], 2, Under::Edge(&edge), Vec3::y(), &x, 0.01).expect("apart");
        let mut near = found(vec![contact], &x);
        let to = vec![x[0] + Vec3::new(0.2e-3, 0.3e-3, 0.1e-3), x[1] + Vec3::new(0.1e-3, -0.2e-3, 0.0)];
        let (fixed, after) = (near.contacts[0], near.after(&to)[0]);
        near.foresee(&x, &to);
        x.clone_from(&to);
        near.follow(&x, &origin);
        assert_eq!(after.share, fixed.share);
        assert_ne!(after.share, near.contacts[0].share, "a step changes it");
        let [after, now] = [after, near.contacts[0]].map(|c| (c.weights, c.normal, c.gap(&to)));
        assert_eq!(after, now);
        assert!((after.2 - fixed.gap(&to)).abs() > 1e-6, "its plane has turned");
    }

    #[test]
    fn what_is_in_the_body_need_not_be_kept_apart() {
        let (_, near) = over_floor(-0.002);
        assert_eq!((near.contacts.len(), near.apart().len()), (1, 0));
    }

    #[test]
    fn a_way_that_is_no_number_is_covered_when_everything_is() {
        let (x, mut near) = over_floor(0.1);
        let to = [Vec3::repeat(f64::NAN)];
        assert!(!near.covers(&x, &to, &x) && near.contacts.len() == 1);
        assert!(near.covers(&x, &to, &x));
    }
}
