//! What the cloth may touch next: the contacts found at the last detection, and how far nodes may go until the next.

use rayon::prelude::*;

use super::model::Cloth;
use crate::contact::{Bounds, ClothDetector, Collider, Contact, Neighbourhood, Tangle};
use crate::geometry::Vec3;

/// How contact is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// Cloth primitives nearer than this are pairs, metres. Nodes may go 0.45 of it between two detections.
    pub cloth: f64,
    /// The body is looked for this near, metres.
    pub body: f64,
    /// A new detection is due when any node has gone this share of `cloth`.
    pub renew: f64,
}

/// Body vertices and edges are tested against cloth triangles whose nodes are nearer to the body than this many
/// metres (and the contacts found are within half of it).
const FACE_REACH: f64 = 0.012;
/// A node's distance to the body is measured up to this many reaches, so that far nodes need not be asked every time.
const FAR: f64 = 4.0;

/// Contacts between cloth and body and within the cloth.
pub(super) struct Proximity<'a> {
    /// Those found at the last detection, turned to where their closest points have gone since.
    pub(super) contacts: Vec<Contact>,
    /// What keeps them apart.
    pub(super) bounds: Bounds,
    body: &'a Collider,
    detector: ClothDetector,
    reach: Reach,
    /// Separation that pairs keep, metres.
    margin: f64,
    /// Distance to the body when last measured, and where.
    body_distance: Vec<(f64, Vec3)>,
}

impl<'a> Proximity<'a> {
    /// Looks at `cloth` in position `x` for the first time.
    pub(super) fn new(
        cloth: &Cloth,
        x: &[Vec3],
        body: &'a Collider,
        hood: Neighbourhood,
        reach: Reach,
        margin: f64,
    ) -> Self {
        let mut out = Self {
            contacts: Vec::new(),
            bounds: Bounds::new(x, &[], reach.cloth, margin),
            body,
            detector: ClothDetector::new(&cloth.triangles, &cloth.flat, &cloth.piece, hood),
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

    /// Follows the nodes to `x`: a new detection when one has gone far, otherwise the pairs of cloth are turned to
    /// where their closest points are now. Returns whether the contacts are others.
    pub(super) fn follow(&mut self, cloth: &Cloth, x: &[Vec3]) -> bool {
        if self.bounds.travelled(x) > self.reach.renew * self.reach.cloth {
            self.detect(cloth, x);
            return true;
        }
        self.contacts.par_iter_mut().with_min_len(512).for_each(|c| c.refresh(x));
        self.bounds.refresh(&self.contacts);
        false
    }

    /// Pairs of nodes (smaller first, sorted) that contacts of the cloth with itself couple, for gaps below `gap`.
    pub(super) fn touching(&self, x: &[Vec3], gap: f64) -> Vec<[u32; 2]> {
        let mut out = Vec::new();
        for contact in self.contacts.iter().filter(|c| !c.body && c.gap(x) < gap) {
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

    /// Changes which nodes are being led out of a tangle, and looks again.
    pub(super) fn set_tangled(&mut self, cloth: &Cloth, x: &[Vec3], tangled: Vec<bool>) {
        self.detector.set_tangled(tangled);
        self.detect(cloth, x);
    }

    fn body_contacts(&mut self, x: &[Vec3]) -> Vec<Contact> {
        let (body, reach) = (self.body, self.reach.body);
        // A node whose last measured distance minus its way since cannot have come within reach is not asked for again.
        let found: Vec<Option<(f64, Contact)>> = self
            .body_distance
            .par_iter()
            .enumerate()
            .map(|(i, &(distance, at))| {
                if distance - (x[i] - at).norm() > reach {
                    return None;
                }
                let limit = FAR * reach;
                let Some(near) = body.nearest(x[i], limit) else { return Some((limit, Contact::none())) };
                let contact = Contact {
                    nodes: [i as u32, 0, 0, 0],
                    weights: [1.0, 0.0, 0.0, 0.0],
                    count: 1,
                    normal: near.normal,
                    offset: near.normal.dot(&near.point),
                    body: true,
                    above: 1,
                };
                Some((near.distance, contact))
            })
            .collect();
        let mut contacts = Vec::new();
        for (i, entry) in found.into_iter().enumerate() {
            if let Some((distance, contact)) = entry {
                self.body_distance[i] = (distance, x[i]);
                if distance < reach && contact.count > 0 {
                    contacts.push(contact);
                }
            }
        }
        contacts
    }

    fn face_contacts(&self, cloth: &Cloth, x: &[Vec3], contacts: &mut Vec<Contact>) {
        let near = |n: u32| {
            let (distance, at) = self.body_distance[n as usize];
            distance - (x[n as usize] - at).norm() < FACE_REACH
        };
        let faces: Vec<Contact> = cloth
            .triangles
            .par_iter()
            .with_min_len(256)
            .filter(|t| t.iter().all(|&n| near(n)))
            .flat_map_iter(|t| {
                let mut out = Vec::new();
                self.body.vertices_near_triangle(x, *t, 0.5 * FACE_REACH, &mut out);
                out
            })
            .collect();
        let edges: Vec<Contact> = cloth
            .edges
            .par_iter()
            .with_min_len(256)
            .filter(|e| e.iter().all(|&n| near(n)))
            .flat_map_iter(|e| {
                let mut out = Vec::new();
                self.body.edges_near_edge(x, *e, 0.5 * FACE_REACH, &mut out);
                out
            })
            .collect();
        contacts.extend(faces);
        contacts.extend(edges);
    }
}
