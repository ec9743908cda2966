//! What the cloth may touch next: the contacts found at the last detection, and how far nodes may go until the next.

use rayon::prelude::*;

use super::force::ContactLaw;
use super::model::Cloth;
use crate::contact::{Bounds, ClothDetector, Collider, Contact, Neighbourhood, Tangle};
use crate::geometry::Vec3;

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
/// A new detection is due when any node has gone this share of the reach.
const RENEW: f64 = 0.3;

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
    /// Those found at the last detection, turned to where their closest points have gone since.
    pub(super) contacts: Vec<Contact>,
    /// What keeps them apart.
    pub(super) bounds: Bounds,
    body: &'a Collider,
    detector: ClothDetector,
    /// How near contacts are looked for at the next detection.
    pub(super) reach: Reach,
    /// Separation that pairs keep, metres.
    margin: f64,
    /// Distance to the body when last measured, and where.
    body_distance: Vec<(f64, Vec3)>,
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
            bounds: Bounds::new(x, &[], reach.cloth, margin),
            body,
            detector: ClothDetector::new(&cloth.triangles, &cloth.flat, &cloth.piece, hood, law.thickest(cloth)),
            reach,
            margin,
            body_distance: vec![(f64::NEG_INFINITY, Vec3::zeros()); x.len()],
        };
        out.detect(cloth, x);
        out
    }

    /// Looks for contacts anew.
    pub(super) fn detect(&mut self, cloth: &Cloth, x: &[Vec3]) {
        let mut contacts = self.body_contacts(x);
        self.face_contacts(cloth, x, &mut contacts);
        contacts.extend(self.detector.detect(x, self.reach.cloth));
        self.bounds = Bounds::new(x, &contacts, self.reach.cloth, self.margin);
        self.contacts = contacts;
    }

    /// Whether a node has gone so far that contacts have to be looked for anew.
    pub(super) fn is_due(&self, x: &[Vec3]) -> bool {
        self.bounds.travelled(x) > RENEW * self.reach.cloth
    }

    /// Follows the nodes to `x`: a new detection when one has gone far, otherwise the pairs of cloth are turned to
    /// where their closest points are now. Returns whether the contacts are others.
    pub(super) fn follow(&mut self, cloth: &Cloth, x: &[Vec3]) -> bool {
        if self.is_due(x) {
            self.detect(cloth, x);
            return true;
        }
        self.contacts.par_iter_mut().with_min_len(super::ONE_THREAD).for_each(|c| {
            c.refresh(x);
        });
        self.bounds.refresh(&self.contacts);
        false
    }

    /// Pairs of nodes (smaller first, sorted) that contacts of the cloth with itself couple, for gaps below `gap`.
    pub(super) fn touching(&self, x: &[Vec3], gap: f64) -> Vec<[u32; 2]> {
        let mut out = Vec::new();
        for contact in self.contacts.iter().filter(|c| !c.is_on_body() && c.gap(x) < gap) {
            let nodes = || contact.parts().filter(|p| p.1 != 0.0).map(|p| p.0 as u32);
            for (a, i) in nodes().enumerate() {
                out.extend(nodes().skip(a + 1).map(|j| [i.min(j), i.max(j)]));
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

    /// Changes which nodes are being led out of a tangle, for the next detection.
    pub(super) fn set_tangled(&mut self, tangled: Vec<bool>) {
        self.detector.set_tangled(tangled);
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
                if near.distance < features {
                    body.faces_of_hollow(i as u32, x[i], &near, features, &mut contacts);
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

    fn face_contacts(&self, cloth: &Cloth, x: &[Vec3], contacts: &mut Vec<Contact>) {
        let far = |n: u32| {
            let (distance, at) = self.body_distance[n as usize];
            distance - (x[n as usize] - at).norm()
        };
        // No point of an edge or triangle is further from the nearest of its nodes than this share of its longest side.
        let near = |nodes: &[u32]| {
            let side = |a: u32, b: u32| (x[a as usize] - x[b as usize]).norm();
            let longest = nodes.iter().flat_map(|&a| nodes.iter().map(move |&b| side(a, b))).fold(0.0, f64::max);
            nodes.iter().map(|&n| far(n)).fold(f64::INFINITY, f64::min)
                < self.reach.features + 3f64.sqrt().recip() * longest
        };
        let faces: Vec<Contact> = cloth
            .triangles
            .par_iter()
            .with_min_len(512)
            .filter(|t| near(*t))
            .flat_map_iter(|t| {
                let mut out = Vec::new();
                self.body.vertices_near_triangle(x, *t, self.reach.features, &mut out);
                out
            })
            .collect();
        let edges: Vec<Contact> = cloth
            .edges
            .par_iter()
            .with_min_len(512)
            .filter(|e| near(*e))
            .flat_map_iter(|e| {
                let mut out = Vec::new();
                self.body.edges_near_edge(x, *e, self.reach.features, &mut out);
                out
            })
            .collect();
        contacts.extend(faces);
        contacts.extend(edges);
    }
}
