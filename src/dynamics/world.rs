//! Cloth, body and contact together, advanced step by step.

use rayon::prelude::*;

use super::friction::Friction;
use super::model::Cloth;
use super::step::{ContactLaw, Forces, Pull, StepError, Stepper, cloth_forces};
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

/// A garment in motion.
pub struct World<'a> {
    /// The cloth.
    pub cloth: Cloth,
    /// Node positions.
    pub x: Vec<Vec3>,
    /// Node velocities (what inertia keeps).
    pub velocity: Vec<Vec3>,
    /// Friction against the body; none while sewing.
    pub friction: Option<Friction>,
    /// Share of gravity.
    pub gravity: f64,
    /// Contact law.
    pub law: ContactLaw,
    body: &'a Collider,
    detector: ClothDetector,
    stepper: Stepper,
    contacts: Vec<Contact>,
    bounds: Bounds,
    reach: Reach,
    /// Distance to the body when last measured, and where.
    body_distance: Vec<(f64, Vec3)>,
}

impl<'a> World<'a> {
    /// Prepares a garment at `x` (one position per node) with stitches between `pulls`.
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn new(
        cloth: Cloth,
        x: Vec<Vec3>,
        pulls: &[[u32; 2]],
        body: &'a Collider,
        hood: Neighbourhood,
        law: ContactLaw,
        reach: Reach,
    ) -> Result<Self, StepError> {
        let stepper = Stepper::new(&cloth, pulls, &x)?;
        let detector = ClothDetector::new(&cloth.triangles, &cloth.flat, &cloth.piece, hood);
        let bounds = Bounds::new(&x, &[], reach.cloth, law.body_clearance);
        let mut world = Self {
            velocity: vec![Vec3::zeros(); x.len()],
            friction: None,
            gravity: 0.0,
            law,
            body,
            detector,
            stepper,
            contacts: Vec::new(),
            bounds,
            reach,
            body_distance: vec![(f64::NEG_INFINITY, Vec3::zeros()); x.len()],
            cloth,
            x,
        };
        world.detect();
        Ok(world)
    }

    /// Looks for contacts anew.
    pub fn detect(&mut self) {
        let mut contacts = self.body_contacts();
        self.face_contacts(&mut contacts);
        contacts.extend(self.detector.detect(&self.x, self.reach.cloth));
        self.bounds = Bounds::new(&self.x, &contacts, self.reach.cloth, 0.25 * self.law.body_clearance);
        self.contacts = contacts;
    }

    fn body_contacts(&mut self) -> Vec<Contact> {
        let (x, body, reach) = (&self.x, self.body, self.reach.body);
        // A node whose last measured distance minus its way since cannot have come within reach is not asked for again.
        let found: Vec<Option<(f64, Contact)>> = self
            .body_distance
            .par_iter()
            .enumerate()
            .map(|(i, &(distance, at))| {
                if distance - (x[i] - at).norm() > reach {
                    return None;
                }
                let limit = 4.0 * reach;
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
                self.body_distance[i] = (distance, self.x[i]);
                if distance < reach && contact.count > 0 {
                    contacts.push(contact);
                }
            }
        }
        contacts
    }

    fn face_contacts(&self, contacts: &mut Vec<Contact>) {
        let near = |n: u32| {
            let (distance, at) = self.body_distance[n as usize];
            distance - (self.x[n as usize] - at).norm() < FACE_REACH
        };
        let faces: Vec<Contact> = self
            .cloth
            .triangles
            .par_iter()
            .with_min_len(256)
            .filter(|t| t.iter().all(|&n| near(n)))
            .flat_map_iter(|t| {
                let mut out = Vec::new();
                self.body.vertices_near_triangle(&self.x, *t, 0.5 * FACE_REACH, &mut out);
                out
            })
            .collect();
        let edges: Vec<Contact> = self
            .cloth
            .edges
            .par_iter()
            .with_min_len(256)
            .filter(|e| e.iter().all(|&n| near(n)))
            .flat_map_iter(|e| {
                let mut out = Vec::new();
                self.body.edges_near_edge(&self.x, *e, 0.5 * FACE_REACH, &mut out);
                out
            })
            .collect();
        contacts.extend(faces);
        contacts.extend(edges);
    }

    fn forces<'b>(&'b self, pulls: &'b [Pull]) -> Forces<'b> {
        Forces {
            gravity: self.gravity,
            contacts: &self.contacts,
            law: self.law,
            pulls,
            friction: self.friction.as_ref(),
        }
    }

    /// One step of `dt` seconds in which the share `keep` of the velocity lives on. Returns the largest motion, metres.
    ///
    /// # Errors
    /// As [`Stepper::solve`].
    pub fn advance(&mut self, dt: f64, keep: f64, pulls: &[Pull]) -> Result<f64, StepError> {
        let inertia: Vec<Vec3> = self.velocity.iter().map(|v| v * keep).collect();
        let forces = Forces {
            gravity: self.gravity,
            contacts: &self.contacts,
            law: self.law,
            pulls,
            friction: self.friction.as_ref(),
        };
        let d = self.stepper.solve(&self.cloth, &self.x, &inertia, dt, &forces)?;
        let share = self.bounds.share(&self.x, &d);
        let target: Vec<Vec3> = self.x.iter().zip(&d).map(|(x, d)| x + d * share).collect();
        Ok(self.move_to(target, dt))
    }

    /// A step without inertia from an extrapolated position: x + `momentum` × the last motion (at most `most` metres).
    /// It goes to rest much faster than real time.
    ///
    /// # Errors
    /// As [`Stepper::solve`].
    pub fn relax(
        &mut self,
        dt: f64,
        momentum: f64,
        most: f64,
        last: &[Vec3],
        pulls: &[Pull],
    ) -> Result<f64, StepError> {
        let forces = Forces {
            gravity: self.gravity,
            contacts: &self.contacts,
            law: self.law,
            pulls,
            friction: self.friction.as_ref(),
        };
        // Looking ahead pays only while the forces still point the way of the last motion (O'Donoghue and Candès 2015).
        let uphill = || {
            let f = cloth_forces(&self.cloth, &self.x, &forces);
            f.iter().zip(self.x.iter().zip(last)).map(|(f, (x, l))| f.dot(&(x - l))).sum::<f64>() < 0.0
        };
        let momentum = if momentum > 0.0 && uphill() { 0.0 } else { momentum };
        let mut ahead: Vec<Vec3> = self
            .x
            .iter()
            .zip(last)
            .map(|(x, l)| {
                let d = (x - l) * momentum;
                let length = d.norm();
                x + if length > most { d * (most / length) } else { d }
            })
            .collect();
        self.bounds.clamp(&self.x, &mut ahead);
        let still = vec![Vec3::zeros(); ahead.len()];
        let d = self.stepper.solve(&self.cloth, &ahead, &still, dt, &forces)?;
        let target: Vec<Vec3> = ahead.iter().zip(&d).map(|(x, d)| x + d).collect();
        Ok(self.move_to(target, dt))
    }

    fn move_to(&mut self, mut target: Vec<Vec3>, dt: f64) -> f64 {
        self.bounds.clamp(&self.x, &mut target);
        let mut largest = 0.0f64;
        for ((x, t), v) in self.x.iter_mut().zip(&target).zip(&mut self.velocity) {
            let d = t - *x;
            *v = d / dt;
            largest = largest.max(d.norm_squared());
            *x = *t;
        }
        if let Some(friction) = &mut self.friction {
            let (cloth, law, x) = (&self.cloth, self.law, &self.x);
            friction.update(x, &self.contacts, &cloth.friction, |c| super::step::contact_load(cloth, x, c, &law));
        }
        if self.bounds.travelled(&self.x) > self.reach.renew * self.reach.cloth {
            self.detect();
        }
        largest.sqrt()
    }

    /// Elastic energy, penetration energy of the contacts and weight × height, J.
    pub fn energy(&self) -> f64 {
        let weight: f64 =
            self.cloth.mass.iter().zip(&self.x).map(|(m, x)| m * super::GRAVITY * self.gravity * x.y).sum();
        let pressed: f64 = self
            .contacts
            .iter()
            .map(|c| super::step::contact_load(&self.cloth, &self.x, c, &self.law).powi(2) / (2.0 * self.law.stiffness))
            .sum();
        self.cloth.elastic_energy(&self.x) + pressed + weight
    }

    /// Force on every node that is not balanced, N.
    pub fn residual(&self, pulls: &[Pull]) -> Vec<Vec3> {
        cloth_forces(&self.cloth, &self.x, &self.forces(pulls))
    }

    /// Root mean square of the unbalanced force over the particle's weight.
    pub fn residual_in_weights(&self) -> f64 {
        let r = self.residual(&[]);
        let mean_mass = self.cloth.mass.iter().sum::<f64>() / self.cloth.mass.len().max(1) as f64;
        let rms = (r.iter().map(Vec3::norm_squared).sum::<f64>() / r.len().max(1) as f64).sqrt();
        rms / (mean_mass * super::GRAVITY)
    }

    /// Places where the cloth passes through itself.
    pub fn tangles(&mut self) -> Vec<Tangle> {
        self.detector.tangles(&self.x)
    }

    /// The detector, to change which pairs are left out.
    pub fn detector_mut(&mut self) -> &mut ClothDetector {
        &mut self.detector
    }

    /// Contacts of the last detection.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }
}
