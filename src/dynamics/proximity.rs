//! What the cloth may touch next: the contacts found at the last detection, and how far nodes may go until the next.

use rayon::prelude::*;

use super::contact_law::ContactLaw;
use super::cost::{ContactTime, timed};
use super::model::Cloth;
use super::near::{Aside, Near, Source};
use crate::contact::{Bounds, ClothDetector, Collider, Contact, Neighbourhood, Tangle};
use crate::geometry::{Vec3, sorted_pair};

/// How contact is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// Cloth primitives nearer than this are pairs, metres. Between two looks nodes may go [`Bounds::allowance`] of it,
    /// after one that searched all of the cloth [`Bounds::allowances_after_all`].
    pub cloth: f64,
    /// The body is looked for this near to a node, metres.
    pub body: f64,
    /// Its edges and vertices are looked for this near to edges and triangles of the cloth, metres.
    pub features: f64,
}

impl Reach {
    /// The reach within the cloth given, metres.
    pub fn new(cloth: f64) -> Self {
        Self { cloth, body: (0.5 * cloth).max(BODY), features: (0.5 * cloth).min(FEATURES) }
    }

    /// The same with the body's features as near as a node goes between two looks, however far that is: for cloth that
    /// falls in large cells, of which few are near the body.
    pub fn with_features(self) -> Self {
        Self { features: 0.5 * self.cloth, ..self }
    }

    /// Whether what was found within `last` will do: nothing is to be looked for further off, nor cloth much less far.
    fn goes_on_from(&self, last: &Self) -> bool {
        self.cloth <= last.cloth && self.features <= last.features && self.cloth >= NARROWER * last.cloth
    }

    /// Whether nodes go no further between two looks than the body's features are looked for.
    fn is_short(&self) -> bool {
        Bounds::allowance(self.cloth) <= self.features
    }
}

/// The body is looked for at least this near, metres, and further than a node may go between two looks.
const BODY: f64 = 0.02;
/// Where a node has gone this share of the reach for features, they are looked for again however far it may go.
const MOVED: f64 = 0.15;
/// What a node that has gone further than this, metres, sees of the body is looked for at every look: a tenth of the
/// least distance kept from it. With what was seen a fifth of a millimetre ago cloth came to cross the body.
const SEEN: f64 = 0.02e-3;
/// All are searched again where less than this share of the reach would do.
const NARROWER: f64 = 0.6;

/// Edges and vertices of the body are contacts of edges and triangles of the cloth as near as a node goes between two
/// looks, at most this near, metres: while seams are closed nodes go far, over a body they are still far from.
const FEATURES: f64 = 4e-3;
/// A node's distance to the body is measured up to this many reaches, so that far nodes need not be asked every time.
const FAR: f64 = 4.0;
/// Farther than so many ways that a node may go, beyond the longest edge at it, nothing at it comes to the body before
/// it is searched at again.
const CORNERS: f64 = 4.0;
/// Pairs keep this share of the distance kept from the body.
const MARGIN: f64 = 0.25;
/// Room for rounding in distances, metres.
const ROUNDING: f64 = 1e-9;

/// The body's features near a triangle or an edge of the cloth, and whether others near it are hidden.
type FoundAt<'a> = (Vec<Contact<'a>>, bool);

/// At which nodes a look searches.
#[derive(Clone, Copy)]
struct Search<'a> {
    /// Those that have gone some way.
    stale: &'a [bool],
    /// Those that have moved at all: for the body, and for its features that others hide. All that are stale have.
    moved: &'a [bool],
}

/// Contacts between cloth and body and within the cloth.
///
/// A look searches only at the nodes that have gone some way since they were last searched at: near its rest a garment
/// moves in one fold, and lies still everywhere else. The nearest point of the body, and features that others hide, are
/// looked for wherever it moves at all.
pub(super) struct Proximity<'a> {
    /// What was found, and which of it matters.
    near: Near<'a>,
    /// How far nodes may go.
    pub(super) bounds: Bounds,
    /// What the cloth is on.
    pub(super) body: &'a Collider,
    detector: ClothDetector,
    /// How near contacts are looked for at the next look that searches all of the cloth.
    pub(super) reach: Reach,
    /// How near they were looked for at the last one.
    searched: Option<Reach>,
    /// Distance to the body when last measured, and where.
    body_distance: Vec<(f64, Vec3)>,
    /// Of which triangles and then edges of the cloth features near them were left out.
    hidden: Vec<bool>,
    /// Where every node last looked at the body.
    seen: Vec<Vec3>,
    /// Which nodes are held: nothing is searched at them,
    is_held: Vec<bool>,
    /// but at those that should have been, once they are no longer.
    owed: Vec<bool>,
    /// What all of it has cost.
    pub(super) time: ContactTime,
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

    /// Looks for contacts anew.
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

    /// The same as they are after a step to `to`.
    pub(super) fn near_after(&self, to: &[Vec3]) -> Vec<Contact<'a>> {
        self.near.after(to)
    }

    /// How many contacts with body and cloth are known, whether they matter or not.
    pub(super) fn found(&self) -> usize {
        self.near.all.len()
    }

    /// Takes in the contacts that matter when the nodes go from `x` to `to`.
    /// Returns whether those that did already are all.
    pub(super) fn covers(&mut self, x: &[Vec3], to: &[Vec3]) -> bool {
        timed(&mut self.time.follow, || self.near.covers(x, to, self.bounds.origin()))
    }

    /// [`Bounds::clamp`] with the contacts that matter.
    pub(super) fn clamp(&self, from: &[Vec3], to: &mut [Vec3]) {
        self.bounds.clamp(&self.near.apart(), from, to);
    }

    /// Follows the nodes from `last` to `x`: a look when one has gone far, otherwise the contacts that matter
    /// are turned to where their closest points are now. Returns whether there was a look.
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

    /// Searches no longer at the nodes of `cloth` that are held, nor follows what is near between them.
    pub(super) fn hold(&mut self, cloth: &Cloth, x: &[Vec3]) -> Aside<'a> {
        self.set_held(cloth);
        self.near.set_aside(x, self.bounds.origin(), &self.is_held)
    }

    /// Searches again at the nodes of `cloth` that are held no longer, and follows what was set aside.
    pub(super) fn release(&mut self, cloth: &Cloth, x: &[Vec3], aside: Aside<'a>) {
        self.set_held(cloth);
        self.near.take_back(x, self.bounds.origin(), aside);
    }

    fn set_held(&mut self, cloth: &Cloth) {
        self.bounds.hold(cloth.held.clone());
        self.is_held = cloth.is_held();
    }

    /// Lets the next look search all of the cloth: nodes may go further after it.
    pub(super) fn forget(&mut self) {
        self.searched = None;
    }

    /// Pairs of nodes (smaller first, sorted) that contacts of the cloth with itself couple, for gaps below `gap`.
    pub(super) fn touching(&self, x: &[Vec3], gap: f64) -> Vec<[u32; 2]> {
        let mut out = Vec::new();
        for contact in self.near.all.iter().filter(|c| !c.is_on_body() && c.gap(x) < gap) {
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
        self.forget();
    }

    /// Whether the next look searches all of the cloth.
    fn is_all(&self) -> bool {
        self.searched.is_none_or(|last| !self.reach.goes_on_from(&last))
    }

    /// From now on the ways of nodes that were searched at are measured from `x`. Those near the body may go no further
    /// than its features were looked for at all that they are corners of. Cloth of which all was searched may go
    /// further, as it does when it falls.
    fn restart(&mut self, cloth: &Cloth, x: &[Vec3], reach: &Reach, stale: &[bool], all: bool) {
        let [free, beside_body] = if all {
            Bounds::allowances_after_all(reach.cloth, reach.features)
        } else {
            [Bounds::allowance(reach.cloth), Bounds::allowance_beside_body(reach.features)]
        };
        let beside_body = if reach.is_short() { free.min(beside_body) } else { free };
        let mut longest = vec![0.0f64; x.len()];
        for [a, b] in cloth.edges.iter().map(|e| e.map(|n| n as usize)) {
            let length = (x[a] - x[b]).norm();
            longest[a] = longest[a].max(length);
            longest[b] = longest[b].max(length);
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

    /// A distance from the body that node `i` is not nearer than, metres.
    fn distance(&self, i: usize, x: &[Vec3]) -> f64 {
        let (distance, at) = self.body_distance[i];
        distance - (x[i] - at).norm()
    }

    /// Which nodes look at the body again: those that have moved since they last did, and those that are searched at.
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
        // A node whose last measured distance minus its way since cannot have come within reach is not asked for again;
        // that distance plus its way is as far as the surface can be now.
        let found: Vec<Option<(f64, Vec<Contact<'a>>)>> = self
            .body_distance
            .par_iter()
            .with_min_len(128)
            .enumerate()
            .map(|(i, &(distance, at))| {
                if !moved[i] {
                    return None;
                }
                let way = (x[i] - at).norm();
                if distance - way > reach.body {
                    return None;
                }
                let far = FAR * reach.body;
                let limit = if distance.is_finite() { far.min(distance.abs() + way + ROUNDING) } else { far };
                let Some(near) = body.nearest(x[i], limit) else { return Some((limit, Vec::new())) };
                let mut contacts = Vec::new();
                if near.distance < reach.body {
                    contacts.push(Contact::on_body(i as u32, near.normal, near.point));
                }
                if (0.0..reach.features).contains(&near.distance) {
                    body.faces_of_hollow(x, i as u32, &near, reach.features, &mut contacts);
                }
                Some((near.distance, contacts))
            })
            .collect();
        let mut sources = Vec::new();
        for (i, entry) in found.into_iter().enumerate() {
            if let Some((distance, found)) = entry {
                self.body_distance[i] = (distance, x[i]);
                sources.extend(found.into_iter().map(|c| (c, None)));
            }
        }
        sources
    }

    /// Adds the contacts of the body's features with triangles and edges of the cloth that are searched, and lets go
    /// of what was found before at all that is.
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

    /// Which triangles, and then edges, of the cloth are searched for features of the body: those at stale nodes; those
    /// of which a feature was hidden, at nodes that have moved, for the least turn may bring it out; and cloth that is
    /// under a feature, of which a new search tells by the body whether it is: what is known only goes on as it was.
    fn is_searched(&self, cloth: &Cloth, x: &[Vec3], at: Search) -> Vec<bool> {
        let triangles = cloth.triangles.iter().map(<[u32; 3]>::as_slice);
        let elements = triangles.chain(cloth.edges.iter().map(<[u32; 2]>::as_slice));
        let again = |(nodes, hidden): (&[u32], &bool)| {
            let any = |which: &[bool]| nodes.iter().any(|&n| which[n as usize]);
            any(if *hidden { at.moved } else { at.stale })
        };
        let mut out: Vec<bool> = elements.zip(&self.hidden).map(again).collect();
        self.near.under(x).for_each(|k| out[k as usize] = true);
        out
    }

    /// Contacts of the body's edges and vertices within `reach` of each triangle and edge that is searched, and whether
    /// some near them were left out.
    fn search(&self, cloth: &Cloth, x: &[Vec3], reach: f64, is_searched: &[bool]) -> Vec<Option<FoundAt<'a>>> {
        // No point of an edge or triangle is further from the nearest of its nodes than this share of its longest side.
        let near = |nodes: &[u32]| {
            let side = |a: u32, b: u32| (x[a as usize] - x[b as usize]).norm();
            let longest = nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| side(a, b))).fold(0.0, f64::max);
            let nearest = nodes.iter().map(|&n| self.distance(n as usize, x)).fold(f64::INFINITY, f64::min);
            nearest < reach + 3f64.sqrt().recip() * longest
        };
        let (of_faces, of_edges) = is_searched.split_at(cloth.triangles.len());
        let faces = cloth.triangles.par_iter().zip(of_faces).with_min_len(512).map(|(t, again)| {
            again.then(|| {
                let mut out = Vec::new();
                let hidden = near(t) && self.body.vertices_near_triangle(x, *t, reach, &mut out);
                (out, hidden)
            })
        });
        let edges = cloth.edges.par_iter().zip(of_edges).with_min_len(512).map(|(e, again)| {
            again.then(|| {
                let mut out = Vec::new();
                let hidden = near(e) && self.body.edges_near_edge(x, *e, reach, &mut out);
                (out, hidden)
            })
        });
        faces.chain(edges).collect()
    }
}

/// Of what was `known` at the triangle or edge `element`, what was not `found` again and is still apart, nearer than
/// `reach`. Which of two features hides the other may depend on the last micrometre: one that was left out as soon as
/// it had pushed the cloth a little off, and found again without it, never let it rest.
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
