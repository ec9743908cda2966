//! Pairs that are kept apart at the end of a step: sweeps that push the nodes of each that would meet.
//!
//! Why a direction per pair is enough stands in [`super::bounds`].

use super::{Contact, Under};
use crate::geometry::Vec3;

/// Tolerance for rounding, metres.
const ROUNDING: f64 = 1e-9;
/// Share of its needed separation at which a pair is no longer pushed, to allow for rounding.
const SLACK: f64 = 1.0 - 1e-3;
/// Share of its needed separation at which a pair is left alone after the sweeps, which converge slowly.
pub(super) const HELD: f64 = 0.5;

/// A contact in a step.
#[derive(Clone, Copy)]
pub(super) struct Kept<'a> {
    pub(super) contact: &'a Contact<'a>,
    /// The separation that it must keep, metres.
    pub(super) need: f64,
}

impl Kept<'_> {
    fn is_on_plane(&self) -> bool {
        self.contact.under == Under::Plane
    }

    /// Whether a step to `to` leaves it apart, so that nothing needs to give way.
    pub(super) fn is_apart(&self, from: &[Vec3], to: &[Vec3]) -> bool {
        let Self { contact, need } = *self;
        if self.is_on_plane() {
            let gap = contact.gap(to);
            return need - gap <= ROUNDING && gap >= HELD * need;
        }
        separation(contact, to) >= need * SLACK || separation(&rolled(contact, from, to), to) >= need * SLACK
    }

    /// Pushes it apart where it is not. Returns whether it was pushed.
    fn push(&self, from: &[Vec3], to: &mut [Vec3]) -> bool {
        if self.is_on_plane() {
            lift(self.contact, to, self.need)
        } else {
            keep_apart(self.contact, from, to, self.need)
        }
    }

    /// Whether it would still meet, so that its nodes must stay where they are.
    fn is_lost(&self, from: &[Vec3], to: &[Vec3]) -> bool {
        let Self { contact, need } = *self;
        if self.is_on_plane() {
            return contact.gap(from) > 0.0 && contact.gap(to) < HELD * need;
        }
        let close = |c: &Contact| separation(c, to) < HELD * need;
        close(contact) && close(&rolled(contact, from, to))
    }
}

/// Contacts that push each other's nodes. One that was apart is looked at again only once a node of it has moved.
pub(super) struct Sweep<'a> {
    from: &'a [Vec3],
    to: &'a mut [Vec3],
    kept: Vec<Kept<'a>>,
    /// When each contact was last known to be apart.
    apart: Vec<Option<u32>>,
    /// When each node last moved.
    moved: Vec<u32>,
    /// Number of moves up to now.
    moves: u32,
}

impl<'a> Sweep<'a> {
    /// The contacts, each with whether it is apart.
    pub(super) fn new(from: &'a [Vec3], to: &'a mut [Vec3], judged: Vec<(Kept<'a>, bool)>) -> Self {
        let apart = judged.iter().map(|(_, apart)| apart.then_some(0)).collect();
        let kept = judged.into_iter().map(|(kept, _)| kept).collect();
        Self { moved: vec![0; to.len()], from, to, kept, apart, moves: 0 }
    }

    /// Whether contact number `k` is known to be apart.
    fn is_apart(&self, k: usize) -> bool {
        self.apart[k].is_some_and(|when| self.kept[k].contact.parts().all(|(n, _)| self.moved[n] <= when))
    }

    /// Pushes each pair apart that would meet. Returns whether there was none.
    pub(super) fn push(&mut self) -> bool {
        let mut clean = true;
        for k in 0..self.kept.len() {
            if self.is_apart(k) {
                continue;
            }
            let kept = self.kept[k];
            if kept.push(self.from, self.to) {
                (clean, self.apart[k]) = (false, None);
                self.moves += 1;
                kept.contact.parts().for_each(|(n, _)| self.moved[n] = self.moves);
            } else if kept.is_apart(self.from, self.to) {
                self.apart[k] = Some(self.moves);
            }
        }
        clean
    }

    /// Puts nodes back to where they were. Returns whether any had moved.
    pub(super) fn put_back(&mut self, nodes: impl Iterator<Item = usize>) -> bool {
        let mut any = false;
        for n in nodes {
            if self.to[n] != self.from[n] {
                self.to[n] = self.from[n];
                self.moves += 1;
                (self.moved[n], any) = (self.moves, true);
            }
        }
        any
    }

    /// Keeps nodes that would still meet another node or the body where they are, and then those that would run into
    /// them.
    pub(super) fn hold(&mut self) {
        loop {
            let mut clean = true;
            for k in 0..self.kept.len() {
                let kept = self.kept[k];
                if !self.is_apart(k) && kept.is_lost(self.from, self.to) {
                    clean &= !self.put_back(kept.contact.parts().map(|part| part.0));
                }
            }
            if clean {
                return;
            }
        }
    }
}

/// Separation of a pair, or the gap over a plane, metres.
pub(super) fn clearance(contact: &Contact, x: &[Vec3]) -> f64 {
    if contact.under == Under::Plane { contact.gap(x) } else { separation(contact, x) }
}

/// Positions of a pair's sides along its direction: the lowest node of the upper side, the highest of the lower.
fn sides(contact: &Contact, x: &[Vec3]) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for q in contact.under.points() {
        high = high.max(contact.normal.dot(q));
    }
    for (k, (node, _)) in contact.parts().enumerate() {
        let at = contact.normal.dot(&x[node]);
        if k < contact.above as usize {
            low = low.min(at);
        } else {
            high = high.max(at);
        }
    }
    (low, high)
}

/// Least height of the upper side over the lower one along the direction of a pair, metres.
pub(super) fn separation(contact: &Contact, x: &[Vec3]) -> f64 {
    let (low, high) = sides(contact, x);
    low - high
}

/// Lifts a contact to `need` metres from the body. Returns whether it was nearer.
fn lift(contact: &Contact, x: &mut [Vec3], need: f64) -> bool {
    let depth = need - contact.gap(x);
    if depth <= ROUNDING {
        return false;
    }
    let squares: f64 = contact.parts().map(|p| p.1 * p.1).sum();
    for (node, weight) in contact.parts() {
        x[node] += contact.normal * (depth * weight / squares);
    }
    true
}

/// The pair with the direction by which the end of a step is judged: the direction at the end if the pair is separated
/// all the way while it turns, otherwise the present one.
fn rolled<'b>(contact: &Contact<'b>, from: &[Vec3], to: &[Vec3]) -> Contact<'b> {
    let mut turned = *contact;
    turned.refresh(to);
    let (n, m) = (contact.normal, turned.normal);
    let (above, below) = contact.nodes[..contact.count as usize].split_at(contact.above as usize);
    let apart = |before: Vec3, after: Vec3| {
        n.dot(&before) >= 0.0 && n.dot(&after) + m.dot(&before) >= 0.0 && m.dot(&after) >= 0.0
    };
    let from_all = |p: usize| {
        let cloth = below.iter().map(|&q| q as usize).all(|q| apart(from[p] - from[q], to[p] - to[q]));
        cloth && contact.under.points().iter().all(|q| apart(from[p] - q, to[p] - q))
    };
    if above.iter().all(|&p| from_all(p as usize)) { turned } else { *contact }
}

/// Keeps a pair apart by `need` metres at the end of a step. Returns whether it had to be pushed.
fn keep_apart(contact: &Contact, from: &[Vec3], to: &mut [Vec3], need: f64) -> bool {
    separation(contact, to) < need * SLACK && push_apart(&rolled(contact, from, to), to, need)
}

/// Pushes both sides off the plane half-way between them. Returns whether that was needed.
fn push_apart(contact: &Contact, x: &mut [Vec3], need: f64) -> bool {
    let (low, high) = sides(contact, x);
    if low - high >= need * SLACK {
        return false;
    }
    // Only cloth can give way.
    let (floor, ceiling) = match contact.under {
        Under::Cloth => (0.5 * (low + high + need), 0.5 * (low + high - need)),
        _ => (high + need, high),
    };
    for (k, (node, _)) in contact.parts().enumerate() {
        let at = contact.normal.dot(&x[node]);
        if k < contact.above as usize {
            x[node] += contact.normal * (floor - at).max(0.0);
        } else {
            x[node] += contact.normal * (ceiling - at).min(0.0);
        }
    }
    true
}
