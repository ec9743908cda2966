//! Broad phase: searches for contacts, and bounds how far nodes may go until the next search.

use super::contact_law::ContactLaw;
use super::cost::{ContactTime, timed};
use super::model::Cloth;
use super::near::{Aside, Near, Source};
use crate::contact::{Bounds, ClothDetector, Collider, Contact, Neighbourhood, Tangle};
use crate::geometry::{Vec3, sorted_pair};
use crate::parallel::{self, HEAVY, LIGHT};

/// Search radii.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// Search radius between cloth primitives, metres. Between two searches nodes may go [`Bounds::allowance`] of it,
    /// or [`Bounds::allowances_after_all`] after a search that covered all of the cloth.
    pub cloth: f64,
    /// Search radius from nodes to the body, metres.
    pub body: f64,
    /// Search radius from edges and triangles of the cloth to edges and vertices of the body, metres.
    pub features: f64,
}

impl Reach {
    /// Radii that follow from the one within the cloth, metres.
    pub fn new(cloth: f64) -> Self {
        Self { cloth, body: (0.5 * cloth).max(BODY), features: (0.5 * cloth).min(FEATURES) }
    }

    /// Extends the radius for features of the body to the motion of a node between two searches. It is for cloth that
    /// falls in large cells, few of which are near the body.
    pub fn with_features(self) -> Self {
        Self { features: 0.5 * self.cloth, ..self }
    }

    /// Whether contacts found within `last` suffice: no radius is larger, and that of the cloth is not much smaller.
    fn goes_on_from(&self, last: &Self) -> bool {
        self.cloth <= last.cloth && self.features <= last.features && self.cloth >= NARROWER * last.cloth
    }

    /// Whether nodes go no further between two searches than the radius for features of the body.
    fn is_short(&self) -> bool {
        Bounds::allowance(self.cloth) <= self.features
    }
}

/// Least search radius for the body, metres. The radius is also larger than the motion of a node between two searches.
const BODY: f64 = 0.02;
/// Motion of a node, as a share of the radius for features of the body, after which these are searched again.
const MOVED: f64 = 0.15;
/// Motion after which a node looks at the body again at every search, metres: a tenth of the least distance kept from
/// it. With data that were 0.2 mm old, cloth came to cross the body.
const SEEN: f64 = 0.02e-3;
/// Share of the last radius below which a new radius makes all nodes be searched again.
const NARROWER: f64 = 0.6;

/// Largest search radius for edges and vertices of the body, metres. Up to it, the radius is the motion of a node
/// between two searches. Nodes go further while seams are closed, but over a body that they are still far from.
const FEATURES: f64 = 4e-3;
/// Distance up to which a node's distance to the body is measured, in search radii. Far nodes then need no query in
/// every search.
const FAR: f64 = 4.0;
/// Distance from the body beyond which the radius for its features does not bound a node's budget, in allowed motions
/// of a node (the longest edge at the node is added). Nothing at such a node reaches the body before its next search.
const CORNERS: f64 = 4.0;
/// Gap that steps must leave, as a share of the distance kept from the body.
const MARGIN: f64 = 0.25;
/// Tolerance for rounding in distances, metres.
const ROUNDING: f64 = 1e-9;

/// Features of the body near a triangle or edge of the cloth, and whether others near it are hidden.
type FoundAt<'a> = (Vec<Contact<'a>>, bool);

/// The nodes that a search covers.
#[derive(Clone, Copy)]
struct Search<'a> {
    /// Nodes that have used up a share of their travel budget.
    stale: &'a [bool],
    /// Nodes that have moved at all, stale ones included: for the body, and for features of it that others hide.
    moved: &'a [bool],
}

/// Contacts between cloth and body and within the cloth.
///
/// A search covers only nodes that have used up a share of their travel budget since they were last searched: near rest
/// a garment moves in one fold and lies still elsewhere. The nearest point of the body, and features that others hide,
/// are updated wherever the cloth moves at all.
pub(super) struct Proximity<'a> {
    /// The contacts found, and those of them that matter.
    near: Near<'a>,
    /// Travel budgets of the nodes.
    pub(super) bounds: Bounds,
    /// The body.
    pub(super) body: &'a Collider,
    detector: ClothDetector,
    /// Radii of the next search that covers all of the cloth.
    pub(super) reach: Reach,
    /// Radii of the last such search.
    searched: Option<Reach>,
    /// Distance of every node to the body when last measured, and its position then.
    body_distance: Vec<(f64, Vec3)>,
    /// Whether features of the body near a triangle, or then an edge, of the cloth were left out as hidden.
    hidden: Vec<bool>,
    /// Position of every node when it last looked at the body.
    seen: Vec<Vec3>,
    /// Whether a node is held. Held nodes are not searched.
    is_held: Vec<bool>,
    /// Held nodes that would have been searched. They are searched once they are released.
    owed: Vec<bool>,
    /// Wall-clock time spent on contact.
    pub(super) time: ContactTime,
}

impl<'a> Proximity<'a> {
    /// The first search, of `cloth` at positions `x`. Contacts follow `law`.
    pub(super) fn new(
        cloth: &Cloth,
        x: &[Vec3],
        body: &'a Collider,
        hood: Neighbourhood,
        reach: Reach,
        law: &ContactLaw,
    ) -> Self {
        let mut out = Self {
            near: Near::new(x.len(), law.widest(cloth)),
            bounds: Bounds::new(x, reach.cloth, MARGIN * law.body_clearance),
            body,
            detector: ClothDetector::new(&cloth.triangles, &cloth.flat, &cloth.piece, hood),
            reach,
            searched: None,
            body_distance: vec![(f64::NEG_INFINITY, Vec3::zeros()); x.len()],
            hidden: vec![false; cloth.triangles.len() + cloth.edges.len()],
            seen: x.to_vec(),
            is_held: vec![false; x.len()],
            owed: vec![false; x.len()],
            time: ContactTime::default(),
        };
        out.detect(cloth, x);
        out
    }

    /// Searches for contacts.
    pub(super) fn detect(&mut self, cloth: &Cloth, x: &[Vec3]) {
        let mut time = self.time;
        let all = self.is_all();
        let reach = if all { self.reach } else { self.searched.unwrap_or(self.reach) };
        let mut stale = self.bounds.stale(x, MOVED * reach.features);
        stale.iter_mut().zip(&self.owed).for_each(|(stale, owed)| *stale |= all || *owed);
        timed(&mut time.cloth, || self.detector.look(x, reach.cloth, &mut stale));
        for ((stale, owed), held) in stale.iter_mut().zip(&mut self.owed).zip(&self.is_held) {
            (*stale, *owed) = (*stale && !held, *stale && *held);
        }
        let moved = self.moved(x, &stale);
        let mut sources = timed(&mut time.body, || self.body_contacts(x, &reach, &moved));
        timed(&mut time.features, || {
            self.face_contacts(cloth, x, &reach, Search { stale: &stale, moved: &moved }, &mut sources);
        });
        let found = timed(&mut time.cloth, || self.detector.detect_at(x, reach.cloth, &stale));
        timed(&mut time.follow, || {
            sources.extend(found.into_iter().map(|c| (c, None)));
            self.restart(cloth, x, &reach, &stale, all);
            self.near.add(&sources, x, self.bounds.origin());
            self.near.follow(x, self.bounds.origin());
        });
        self.time = time;
        self.searched = Some(reach);
    }

    /// The contacts that matter in the next step.
    pub(super) fn near(&self) -> &[Contact<'a>] {
        &self.near.contacts
    }

    /// The contacts by which a step to `to` is judged ([`Near::after`]).
    pub(super) fn near_after(&self, to: &[Vec3]) -> Vec<Contact<'a>> {
        self.near.after(to)
    }

    /// Number of known contacts with body and cloth, whether they matter or not.
    pub(super) fn found(&self) -> usize {
        self.near.all.len()
    }

    /// Adds the contacts that matter on the way from `x` to `to`. Returns whether all were there already.
    pub(super) fn covers(&mut self, x: &[Vec3], to: &[Vec3]) -> bool {
        timed(&mut self.time.follow, || self.near.covers(x, to, self.bounds.origin()))
    }

    /// [`Bounds::clamp`] with the contacts that matter.
    pub(super) fn clamp(&self, from: &[Vec3], to: &mut [Vec3]) {
        self.bounds.clamp(&self.near.apart(), from, to);
    }

    /// Follows a step from `last` to `x`: searches again if a node has used up its budget, otherwise updates the
    /// closest points of the contacts that matter. Returns whether there was a search.
    pub(super) fn follow(&mut self, cloth: &Cloth, last: &[Vec3], x: &[Vec3]) -> bool {
        let due = self.bounds.is_due(x);
        self.near.foresee(last, x);
        if due {
            self.detect(cloth, x);
        } else {
            timed(&mut self.time.follow, || self.near.follow(x, self.bounds.origin()));
        }
        due
    }

    /// Excludes the held nodes of `cloth` from searches, and sets the contacts between them aside.
    pub(super) fn hold(&mut self, cloth: &Cloth, x: &[Vec3]) -> Aside<'a> {
        self.set_held(cloth);
        self.near.set_aside(x, self.bounds.origin(), &self.is_held)
    }

    /// Includes nodes of `cloth` that are no longer held, and takes back the contacts that were set aside.
    pub(super) fn release(&mut self, cloth: &Cloth, x: &[Vec3], aside: Aside<'a>) {
        self.set_held(cloth);
        self.near.take_back(x, self.bounds.origin(), aside);
    }

    fn set_held(&mut self, cloth: &Cloth) {
        self.bounds.hold(cloth.held.clone());
        self.is_held = cloth.is_held();
    }

    /// Makes the next search cover all of the cloth, after which nodes may go further.
    pub(super) fn forget(&mut self) {
        self.searched = None;
    }

    /// Pairs of nodes (smaller first, sorted) that contacts of the cloth with itself couple, for gaps below `gap`.
    pub(super) fn touching(&self, x: &[Vec3], gap: f64) -> Vec<[u32; 2]> {
        let all = &self.near.all;
        let near = parallel::map(all.len(), LIGHT, |k| !all[k].is_on_body() && all[k].gap(x) < gap);
        let mut out = Vec::new();
        for (contact, _) in all.iter().zip(near).filter(|(_, near)| *near) {
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

    /// Sets which nodes may pass through one another, from the next search on.
    pub(super) fn set_passing(&mut self, passing: Vec<bool>) {
        self.detector.set_passing(passing);
        self.forget();
    }

    /// Whether the next search covers all of the cloth.
    fn is_all(&self) -> bool {
        self.searched.is_none_or(|last| !self.reach.goes_on_from(&last))
    }

    /// Renews the travel budgets of searched nodes, measured from `x`. Near the body a budget is bounded by the radius
    /// for its features. After a search of all of the cloth, budgets are larger, as falling cloth needs them.
    fn restart(&mut self, cloth: &Cloth, x: &[Vec3], reach: &Reach, stale: &[bool], all: bool) {
        let [free, beside_body] = if all {
            Bounds::allowances_after_all(reach.cloth, reach.features)
        } else {
            [Bounds::allowance(reach.cloth), Bounds::allowance_beside_body(reach.features)]
        };
        let beside_body = if reach.is_short() { free.min(beside_body) } else { free };
        let lengths = parallel::map(cloth.edges.len(), LIGHT, |k| {
            let [a, b] = cloth.edges[k].map(|n| x[n as usize]);
            (a - b).norm()
        });
        let mut longest = vec![0.0f64; x.len()];
        for (edge, length) in cloth.edges.iter().zip(lengths) {
            edge.iter().for_each(|&n| longest[n as usize] = longest[n as usize].max(length));
        }
        for (i, stale) in stale.iter().enumerate() {
            let is_far = self.distance(i, x) > longest[i] + CORNERS * free;
            let leash = if is_far { free } else { beside_body };
            if *stale {
                self.bounds.restart(i, x[i], leash);
            } else {
                self.bounds.shorten(i, leash);
            }
        }
    }

    /// Lower bound of the distance of node `i` from the body, metres.
    fn distance(&self, i: usize, x: &[Vec3]) -> f64 {
        let (distance, at) = self.body_distance[i];
        distance - (x[i] - at).norm()
    }

    /// The nodes that look at the body again: those that have moved since they last did, and stale ones.
    fn moved(&mut self, x: &[Vec3], stale: &[bool]) -> Vec<bool> {
        let looks = |(((x, seen), stale), held): (((&Vec3, &mut Vec3), &bool), &bool)| {
            let looks = *stale || !held && (x - *seen).norm_squared() > SEEN * SEEN;
            if looks {
                *seen = *x;
            }
            looks
        };
        x.iter().zip(&mut self.seen).zip(stale).zip(&self.is_held).map(looks).collect()
    }

    /// Contacts with the nearest points of the body, of nodes that have `moved`.
    fn body_contacts(&mut self, x: &[Vec3], reach: &Reach, moved: &[bool]) -> Vec<Source<'a>> {
        let body = self.body;
        // The last measured distance minus the motion since is a lower bound, by which far nodes are skipped. That
        // distance plus the motion is an upper bound, within which the surface is searched.
        let found = parallel::map(x.len(), HEAVY, |i| {
            if !moved[i] {
                return None;
            }
            let (distance, at) = self.body_distance[i];
            let way = (x[i] - at).norm();
            if distance - way > reach.body {
                return None;
            }
            let far = FAR * reach.body;
            let limit = if distance.is_finite() { far.min(distance.abs() + way + ROUNDING) } else { far };
            let Some(near) = body.nearest(x[i], limit) else { return Some((limit, None, Vec::new())) };
            let plane = (near.distance < reach.body).then(|| Contact::on_body(i as u32, near.normal, near.point));
            let mut beside = Vec::new();
            if (0.0..reach.features).contains(&near.distance) {
                body.faces_of_hollow(x, i as u32, &near, reach.features, &mut beside);
            }
            Some((near.distance, plane, beside))
        });
        let mut sources = Vec::new();
        for (i, entry) in found.into_iter().enumerate() {
            if let Some((distance, plane, beside)) = entry {
                self.body_distance[i] = (distance, x[i]);
                sources.extend(plane.into_iter().chain(beside).map(|c| (c, None)));
            }
        }
        sources
    }

    /// Adds the contacts of features of the body with the searched triangles and edges of the cloth, and removes
    /// earlier contacts of these.
    fn face_contacts(&mut self, cloth: &Cloth, x: &[Vec3], reach: &Reach, at: Search, sources: &mut Vec<Source<'a>>) {
        let is_searched = self.is_searched(cloth, x, at);
        let found = self.search(cloth, x, reach.features, &is_searched);
        let hides = |k: u32| matches!(found[k as usize], Some((_, true)));
        let stay = |contact: &Contact, element: Option<u32>| match element {
            Some(k) => !is_searched[k as usize],
            None if contact.is_on_body() => !at.moved[contact.nodes[0] as usize],
            None => contact.nodes.iter().all(|&n| !at.stale[n as usize]),
        };
        let known = self.near.retain(x, stay, hides);
        for (k, found) in found.into_iter().enumerate() {
            let Some((found, hidden)) = found else { continue };
            let element = Some(k as u32);
            let kept = if hidden { kept(&known, k as u32, &found, x, reach.features) } else { Vec::new() };
            sources.extend(found.into_iter().chain(kept).map(|c| (c, element)));
            self.hidden[k] = hidden;
        }
    }

    /// Whether each triangle, and then each edge, of the cloth is searched for features of the body. Searched are:
    /// - those at stale nodes;
    /// - those at moved nodes that have a hidden feature, because a slight turn may bring it out;
    /// - those that lie under a feature: only a new search asks the body whether they are inside.
    fn is_searched(&self, cloth: &Cloth, x: &[Vec3], at: Search) -> Vec<bool> {
        let mut out = parallel::map(self.hidden.len(), LIGHT, |k| {
            let which = if self.hidden[k] { at.moved } else { at.stale };
            element(cloth, k).iter().any(|&n| which[n as usize])
        });
        self.near.under(x).for_each(|k| out[k as usize] = true);
        out
    }

    /// Contacts of each searched triangle and edge with edges and vertices of the body within `reach`, and whether some
    /// were left out as hidden.
    fn search(&self, cloth: &Cloth, x: &[Vec3], reach: f64, is_searched: &[bool]) -> Vec<Option<FoundAt<'a>>> {
        // Each point of an edge or triangle is within this share of the longest side from its nearest node.
        let near = |nodes: &[u32]| {
            let side = |a: u32, b: u32| (x[a as usize] - x[b as usize]).norm();
            let longest = nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| side(a, b))).fold(0.0, f64::max);
            let nearest = nodes.iter().map(|&n| self.distance(n as usize, x)).fold(f64::INFINITY, f64::min);
            nearest < reach + 3f64.sqrt().recip() * longest
        };
        parallel::map(is_searched.len(), HEAVY, |k| {
            is_searched[k].then(|| {
                let mut out = Vec::new();
                let hidden = near(element(cloth, k))
                    && match cloth.triangles.get(k) {
                        Some(triangle) => self.body.vertices_near_triangle(x, *triangle, reach, &mut out),
                        None => {
                            let edge = cloth.edges[k - cloth.triangles.len()];
                            self.body.edges_near_edge(x, edge, reach, &mut out)
                        }
                    };
                (out, hidden)
            })
        })
    }
}

/// The nodes of a triangle of the cloth or, numbered after these, of an edge.
fn element(cloth: &Cloth, k: usize) -> &[u32] {
    match cloth.triangles.get(k) {
        Some(triangle) => triangle,
        None => &cloth.edges[k - cloth.triangles.len()],
    }
}

/// The contacts `known` at the triangle or edge `element` that were not `found` again but are still apart and within
/// `reach`.
///
/// A turn of a micrometre may decide which of two features hides the other. A feature that was dropped as soon as it
/// had pushed the cloth a little, and then found again, never let the cloth rest.
fn kept<'a>(known: &[(u32, Contact<'a>)], element: u32, found: &[Contact], x: &[Vec3], reach: f64) -> Vec<Contact<'a>> {
    let again = |c: &Contact| found.iter().any(|f| f.under.number() == c.under.number());
    let apart = |c: &Contact| (0.0..reach).contains(&c.gap(x));
    let first = known.partition_point(|k| k.0 < element);
    let of_element = known[first..].iter().take_while(|k| k.0 == element).map(|k| k.1);
    of_element.filter(|c| apart(c) && !again(c)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_for_features_further_off_is_another_one() {
        let wide = Reach::new(0.03);
        assert!(Reach::new(0.028).goes_on_from(&wide));
        assert!(!Reach::new(0.028).with_features().goes_on_from(&wide), "14 mm, and not 4");
        assert!(!Reach::new(0.031).goes_on_from(&wide) && !Reach::new(0.015).goes_on_from(&wide));
    }
}
