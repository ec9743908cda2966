//! What the cloth may touch next: the contacts found at the last detection, and how far nodes may go until the next.

use rayon::prelude::*;

use super::cost::{ContactTime, timed};
use super::force::ContactLaw;
use super::model::Cloth;
use super::near::Near;
use crate::contact::{Bounds, ClothDetector, Collider, Contact, Neighbourhood, Tangle};
use crate::geometry::{Vec3, sorted_pair};

/// How contact is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// Cloth primitives nearer than this are pairs, metres. Nodes may go 0.45 of it between two detections.
    pub cloth: f64,
    /// The body is looked for this near to a node, metres.
    pub body: f64,
    /// Its edges and vertices are looked for this near to edges and triangles of the cloth, metres.
    pub features: f64,
}

impl Reach {
    /// The reach within the cloth given, metres.
    pub fn new(cloth: f64) -> Self {
        let farthest = Bounds::allowance(cloth);
        Self { cloth, body: (0.5 * cloth).max(BODY), features: farthest.min(FEATURES) }
    }
}

/// The body is looked for at least this near, metres, and further than a node may go between two looks.
const BODY: f64 = 0.02;
/// What was found at triangles and edges of the cloth holds until a node of theirs has gone this share of the reach.
const MOVED: f64 = 0.15;
/// All are searched again where less than this share of the reach would do.
const NARROWER: f64 = 0.6;

/// Edges and vertices of the body are contacts of edges and triangles of the cloth as near as a node goes between two
/// detections, at most this near, metres: while seams are closed nodes go far, over a body they are still far from.
const FEATURES: f64 = 4e-3;
/// A node's distance to the body is measured up to this many reaches, so that far nodes need not be asked every time.
const FAR: f64 = 4.0;
/// Pairs keep this share of the distance kept from the body.
const MARGIN: f64 = 0.25;
/// Room for rounding in distances, metres.
const ROUNDING: f64 = 1e-9;

/// Contacts between cloth and body and within the cloth.
pub(super) struct Proximity<'a> {
    /// Those found at the last detection.
    contacts: Vec<Contact>,
    /// Those of them that matter, turned to where their closest points have gone since.
    near: Near,
    /// How far nodes may go.
    pub(super) bounds: Bounds,
    body: &'a Collider,
    detector: ClothDetector,
    /// How near contacts are looked for at the next detection.
    pub(super) reach: Reach,
    /// Separation that pairs keep, metres.
    margin: f64,
    /// Distance to the body when last measured, and where.
    body_distance: Vec<(f64, Vec3)>,
    searched: Searched,
    /// What all of it has cost.
    pub(super) time: ContactTime,
}

/// The contacts with edges and vertices of the body, triangle by triangle and edge by edge of the cloth: what has
/// hardly moved is not searched again.
struct Searched {
    /// Where every node was when all triangles and edges at it were last searched.
    at: Vec<Vec3>,
    /// How near, metres.
    reach: f64,
    /// By what share of that nodes may have been off from there at the last search: 0 if it was one of all.
    moved: f64,
    /// Where the contacts of each triangle, then of each edge, begin in [`Proximity::contacts`],
    /// and where the last end.
    begin: Vec<u32>,
    /// Of which triangles and edges features near them were left out.
    hidden: Vec<bool>,
}

impl<'a> Proximity<'a> {
    /// Looks at `cloth` in position `x` for the first time; its contacts follow `law`.
    pub(super) fn new(
        cloth: &Cloth,
        x: &[Vec3],
        body: &'a Collider,
        hood: Neighbourhood,
        reach: Reach,
        law: &ContactLaw,
    ) -> Self {
        let margin = MARGIN * law.body_clearance;
        let mut out = Self {
            contacts: Vec::new(),
            near: Near::new(x.len(), law.widest(cloth)),
            bounds: Bounds::new(x, reach.cloth, margin),
            body,
            detector: ClothDetector::new(&cloth.triangles, &cloth.flat, &cloth.piece, hood),
            reach,
            margin,
            body_distance: vec![(f64::NEG_INFINITY, Vec3::zeros()); x.len()],
            searched: Searched { at: x.to_vec(), reach: 0.0, moved: 0.0, begin: Vec::new(), hidden: Vec::new() },
            time: ContactTime::default(),
        };
        out.detect(cloth, x);
        out
    }

    /// Looks for contacts anew.
    pub(super) fn detect(&mut self, cloth: &Cloth, x: &[Vec3]) {
        let mut time = self.time;
        let mut contacts = timed(&mut time.body, || self.body_contacts(x));
        timed(&mut time.features, || self.face_contacts(cloth, x, &mut contacts));
        timed(&mut time.cloth, || contacts.extend(self.detector.detect(x, self.reach.cloth)));
        self.time = time;
        self.bounds = Bounds::new(x, self.reach.cloth, self.margin);
        if self.reach.features >= Bounds::allowance(self.reach.cloth) {
            self.bounds.tether(&self.searched.at, (1.0 - self.searched.moved) * self.searched.reach);
        }
        self.contacts = contacts;
        timed(&mut self.time.follow, || self.near.begin(&mut self.contacts, x));
    }

    /// The contacts that matter in the next step.
    pub(super) fn near(&self) -> &[Contact] {
        &self.near.contacts
    }

    /// Takes in the contacts that matter when the nodes go from `x` to `to`.
    /// Returns whether those that did already are all.
    pub(super) fn covers(&mut self, x: &[Vec3], to: &[Vec3]) -> bool {
        timed(&mut self.time.follow, || self.near.covers(&mut self.contacts, x, to))
    }

    /// [`Bounds::clamp`] with the contacts that matter.
    pub(super) fn clamp(&self, from: &[Vec3], to: &mut [Vec3]) {
        self.bounds.clamp(&self.near.apart(), from, to);
    }

    /// Follows the nodes from `last` to `x`: a new detection when one has gone far, otherwise the contacts that matter
    /// are turned to where their closest points are now. Returns whether there was a detection.
    pub(super) fn follow(&mut self, cloth: &Cloth, last: &[Vec3], x: &[Vec3]) -> bool {
        let due = self.bounds.is_due(x);
        self.near.foresee(last, x);
        if due {
            self.detect(cloth, x);
        } else {
            timed(&mut self.time.follow, || self.near.follow(&mut self.contacts, x));
        }
        due
    }

    /// Lets the next detection search all of the cloth: nodes may go further after it.
    pub(super) fn forget(&mut self) {
        self.searched.begin.clear();
    }

    /// Pairs of nodes (smaller first, sorted) that contacts of the cloth with itself couple, for gaps below `gap`.
    pub(super) fn touching(&self, x: &[Vec3], gap: f64) -> Vec<[u32; 2]> {
        let mut out = Vec::new();
        for contact in self.contacts.iter().filter(|c| !c.is_on_body() && c.gap(x) < gap) {
            let nodes = || contact.parts().filter(|p| p.1 != 0.0).map(|p| p.0 as u32);
            for (a, i) in nodes().enumerate() {
                out.extend(nodes().skip(a + 1).map(|j| sorted_pair([i, j])));
            }
        }
        out.sort_unstable();
        out.dedup();
        out
    }

    /// Places where the cloth passes through itself.
    pub(super) fn tangles(&mut self, x: &[Vec3]) -> Vec<Tangle> {
        self.detector.tangles(x)
    }

    /// Changes which nodes may pass through one another, for the next detection.
    pub(super) fn set_passing(&mut self, passing: Vec<bool>) {
        self.detector.set_passing(passing);
    }

    fn body_contacts(&mut self, x: &[Vec3]) -> Vec<Contact> {
        let (body, reach) = (self.body, self.reach.body);
        // A node whose last measured distance minus its way since cannot have come within reach is not asked for again;
        // that distance plus its way is as far as the surface can be now.
        let features = self.reach.features;
        let found: Vec<Option<(f64, Vec<Contact>)>> = self
            .body_distance
            .par_iter()
            .with_min_len(128)
            .enumerate()
            .map(|(i, &(distance, at))| {
                let way = (x[i] - at).norm();
                if distance - way > reach {
                    return None;
                }
                let far = FAR * reach;
                let limit = if distance.is_finite() { far.min(distance.abs() + way + ROUNDING) } else { far };
                let Some(near) = body.nearest(x[i], limit) else { return Some((limit, Vec::new())) };
                let mut contacts = Vec::new();
                if near.distance < reach {
                    contacts.push(Contact::on_body(i as u32, near.normal, near.point));
                }
                if (0.0..features).contains(&near.distance) {
                    body.faces_of_hollow(x, i as u32, &near, features, &mut contacts);
                }
                Some((near.distance, contacts))
            })
            .collect();
        let mut contacts = Vec::new();
        for (i, entry) in found.into_iter().enumerate() {
            if let Some((distance, found)) = entry {
                self.body_distance[i] = (distance, x[i]);
                contacts.extend(found);
            }
        }
        contacts
    }

    fn face_contacts(&mut self, cloth: &Cloth, x: &[Vec3], contacts: &mut Vec<Contact>) {
        let stale = self.stale(x);
        let found = self.search(cloth, x, &stale);
        let mut begin = Vec::with_capacity(found.len() + 1);
        self.searched.hidden.resize(found.len(), false);
        for (k, found) in found.into_iter().enumerate() {
            begin.push(contacts.len() as u32);
            match found {
                Some((found, hidden)) => {
                    let kept = if hidden { self.kept(k, &found, x) } else { Vec::new() };
                    contacts.extend(found.into_iter().chain(kept));
                    self.searched.hidden[k] = hidden;
                }
                None => contacts.extend(self.turned(k, x)),
            }
        }
        begin.push(contacts.len() as u32);
        self.searched.begin = begin;
    }

    /// What was found at triangle `k`, or at the edge that comes so long after the last of them.
    fn found_at(&self, k: usize) -> &[Contact] {
        &self.contacts[self.searched.begin[k] as usize..self.searched.begin[k + 1] as usize]
    }

    /// The same, turned to where their closest points are at `x`.
    fn turned(&self, k: usize, x: &[Vec3]) -> impl Iterator<Item = Contact> {
        let first = self.searched.begin[k] as usize;
        self.found_at(k).iter().enumerate().map(move |(i, contact)| {
            let mut contact = *contact;
            self.near.turn(first + i, &mut contact, x);
            contact
        })
    }

    /// Contacts that were found before at triangle or edge `k`, as [`Self::found_at`] counts, and not now, and are
    /// still apart. Which of two features hides the other may depend on the last micrometre: one that was left out as
    /// soon as it had pushed the cloth a little off, and found again without it, never let it rest.
    fn kept(&self, k: usize, found: &[Contact], x: &[Vec3]) -> Vec<Contact> {
        if self.searched.begin.is_empty() {
            return Vec::new();
        }
        let again = |c: &Contact| found.iter().any(|f| f.under.number() == c.under.number());
        let apart = |c: &Contact| (0.0..self.searched.reach).contains(&c.gap(x));
        self.turned(k, x).filter(|c| apart(c) && !again(c)).collect()
    }

    /// Which nodes have gone too far for what was found at them to hold;
    /// they are taken to be searched at `x` from now on.
    fn stale(&mut self, x: &[Vec3]) -> Vec<bool> {
        let Searched { at, reach, moved, begin, .. } = &mut self.searched;
        let wanted = self.reach.features;
        let all = begin.is_empty() || wanted > *reach || wanted < NARROWER * *reach;
        if all {
            *reach = wanted;
        }
        *moved = if all { 0.0 } else { MOVED };
        let far = MOVED * *reach;
        at.iter_mut()
            .zip(x)
            .map(|(at, x)| {
                let stale = all || (x - *at).norm_squared() > far * far;
                if stale {
                    *at = *x;
                }
                stale
            })
            .collect()
    }

    /// Contacts of the body's edges and vertices with each triangle and edge at a node that is `stale`, and whether
    /// some near them were left out.
    fn search(&self, cloth: &Cloth, x: &[Vec3], stale: &[bool]) -> Vec<Option<(Vec<Contact>, bool)>> {
        let reach = self.searched.reach;
        let far = |n: u32| {
            let (distance, at) = self.body_distance[n as usize];
            distance - (x[n as usize] - at).norm()
        };
        // No point of an edge or triangle is further from the nearest of its nodes than this share of its longest side.
        let near = |nodes: &[u32]| {
            let side = |a: u32, b: u32| (x[a as usize] - x[b as usize]).norm();
            let longest = nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| side(a, b))).fold(0.0, f64::max);
            nodes.iter().map(|&n| far(n)).fold(f64::INFINITY, f64::min) < reach + 3f64.sqrt().recip() * longest
        };
        // A new search tells by the body whether cloth is under one of its features;
        // what is known only goes on as it was.
        let under = |k: usize| self.found_at(k).iter().any(|c| c.gap(x) <= 0.0);
        let again =
            |k: usize, nodes: &[u32]| nodes.iter().any(|&n| stale[n as usize]) || self.searched.hidden[k] || under(k);
        let faces = cloth.triangles.par_iter().with_min_len(512).enumerate().map(|(k, t)| {
            again(k, t).then(|| {
                let mut out = Vec::new();
                let hidden = near(t) && self.body.vertices_near_triangle(x, *t, reach, &mut out);
                (out, hidden)
            })
        });
        let edges = cloth.edges.par_iter().with_min_len(512).enumerate().map(|(k, e)| {
            again(cloth.triangles.len() + k, e).then(|| {
                let mut out = Vec::new();
                let hidden = near(e) && self.body.edges_near_edge(x, *e, reach, &mut out);
                (out, hidden)
            })
        });
        faces.chain(edges).collect()
    }
}
