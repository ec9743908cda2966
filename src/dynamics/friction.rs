//! Coulomb friction with memory, between cloth and body and between cloth layers.

use std::collections::HashMap;

use foldhash::fast::FixedState;

use crate::contact::Contact;
use crate::geometry::{Mat3, Vec3};
use crate::parallel::{self, MEDIUM};

/// Tangential displacement stored per contact. A contact holds like a spring, up to μ times its load. Beyond that it
/// slides, and the stored displacement stays at the limit. Because it is stored from step to step, a garment can come
/// to rest.
///
/// A new contact with the body takes over the memory of its nodes' other contacts, because sliding cloth passes from
/// one edge or vertex of the body to the next. A new contact between layers begins without memory: a node that slides
/// to the next triangle of another layer is held again within half a millimetre.
#[derive(Clone, Debug)]
pub struct Friction {
    /// Tangential stiffness of a contact of little load, N/m.
    stiffness: f64,
    /// In the contacts' order.
    memory: Vec<ContactMemory>,
    /// Memory of touching contacts by key, to be found again after the next search.
    touching: HashMap<Key, ContactMemory, FixedState>,
    /// Mean stored displacement of each node's contacts with the body, weighted by load, metres.
    on_body: Vec<Vec3>,
    /// Positions at the last update.
    at: Vec<Vec3>,
}

/// Least tangential stiffness of a contact, N/m. A node of 1 mN weight slips after 0.03 mm. In one step a sliding
/// garment moves by its unbalanced force over this stiffness, so that a stiffer grip would never let it arrive.
pub const GRIP: f64 = 10.0;
/// Largest tangential displacement of a contact before it slides, metres. Under high load the spring is stiffer than
/// [`GRIP`]. Otherwise cloth that is pulled tight over an edge would slide for millimetres before friction holds it.
const GIVE: f64 = 5e-4;

/// Memory of a contact since it was last dragged. An open contact has none.
#[derive(Clone, Copy, Debug, Default)]
struct ContactMemory {
    /// Stored displacement, metres.
    drawn: Vec3,
    /// Whether it slid when it was last dragged. The flag is kept because a new search may change the load, so that the
    /// spring alone cannot tell.
    slid: bool,
    /// Whether it touched.
    touched: bool,
}

/// Identity of a contact across searches: its nodes, the number above, and the number of the body's feature.
type Key = ([u32; 4], u8, Option<u32>);

fn key(contact: &Contact) -> Key {
    (contact.nodes, contact.above, contact.under.number())
}

/// Friction of one contact in the linear model of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grip {
    /// Force on a node of weight one before the step, N.
    pub(super) force: Vec3,
    /// Whether it slides.
    pub(super) slides: bool,
    /// Stiffness, N/m: tangential while the contact sticks, and none along its sliding direction.
    pub(super) stiffness: Mat3,
}

/// The spring of a contact that pushes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hold {
    /// Stored displacement, metres.
    drawn: Vec3,
    /// N/m.
    stiffness: f64,
    /// Friction limit, μ times the load, N.
    most: f64,
    /// Projects onto the plane across the contact's normal.
    across: Mat3,
    /// Whether the contact has slid up to here.
    slid: bool,
}

impl Hold {
    fn slides(&self, slip: Vec3) -> bool {
        self.stiffness * slip.norm() > self.most
    }

    /// Stored displacement after the contact went `way`, metres, bounded by the friction limit.
    fn kept(&self, way: Vec3) -> Vec3 {
        let slip = self.drawn + self.across * way;
        if self.slides(slip) { slip * (self.most / (self.stiffness * slip.norm())) } else { slip }
    }

    /// Force after the contact went `way`, N.
    pub(super) fn force(&self, way: Vec3) -> Vec3 {
        self.kept(way) * -self.stiffness
    }

    /// Energy after the contact went `way`, J: a quadratic while it sticks, a constant force beyond.
    pub(super) fn energy(&self, way: Vec3) -> f64 {
        let slip = (self.drawn + self.across * way).norm();
        let stuck = slip.min(self.most / self.stiffness);
        self.stiffness * stuck * (slip - 0.5 * stuck)
    }

    /// Friction now. A contact that slid slides on.
    pub(super) fn grip(&self) -> Grip {
        self.linear(Vec3::zeros(), self.slid || self.slides(self.drawn))
    }

    /// Linearisation after the contact went `way`, extrapolated back to the present position.
    pub(super) fn grip_after(&self, way: Vec3) -> Grip {
        let way = self.across * way;
        self.linear(way, self.slides(self.drawn + way))
    }

    fn linear(&self, way: Vec3, slides: bool) -> Grip {
        if !slides {
            return Grip { force: self.drawn * -self.stiffness, slides, stiffness: self.across * self.stiffness };
        }
        // The force is μ · load against the sliding direction. Its transverse stiffness is that of any pull of this
        // size.
        let slip = self.drawn + way;
        let held = self.stiffness.min(self.most / slip.norm());
        let along = slip.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let stiffness = (self.across - along * along.transpose()) * held;
        Grip { force: stiffness * way - slip * held, slides, stiffness }
    }
}

/// Memory of contacts that are set aside, and of their nodes.
#[derive(Debug)]
pub(super) struct Remembered {
    touching: Vec<(Key, ContactMemory)>,
    on_body: Vec<Vec3>,
}

impl Friction {
    /// No stored displacement.
    pub(super) fn new(x: &[Vec3], contacts: &[Contact], stiffness: f64) -> Self {
        let on_body = vec![Vec3::zeros(); x.len()];
        let mut out = Self { stiffness, memory: Vec::new(), touching: HashMap::default(), on_body, at: x.to_vec() };
        out.detected(contacts);
        out
    }

    /// Accepts positions `x` that were set from outside: nothing was dragged on the way.
    pub(super) fn displaced(&mut self, x: &[Vec3]) {
        self.at = x.to_vec();
    }

    /// Transfers the memory from the contacts of the last search to those of a new one.
    pub(super) fn detected(&mut self, contacts: &[Contact]) {
        let of = |k: usize| self.touching.get(&key(&contacts[k])).copied().unwrap_or_default();
        self.memory = parallel::map(contacts.len(), MEDIUM, of);
    }

    /// The memory of `contacts`.
    pub(super) fn remembered(&self, contacts: &[Contact]) -> Remembered {
        let touching = contacts.iter().filter_map(|c| Some((key(c), *self.touching.get(&key(c))?))).collect();
        Remembered { touching, on_body: self.on_body.clone() }
    }

    /// Takes back the memory of contacts and of nodes that were held since.
    pub(super) fn remember(&mut self, remembered: Remembered, was_held: &[bool]) {
        self.touching.extend(remembered.touching);
        let nodes = self.on_body.iter_mut().zip(remembered.on_body).zip(was_held);
        nodes.filter(|(_, held)| **held).for_each(|((drawn, was), _)| *drawn = was);
    }

    /// Displacement of the spring of contact `k` at `x`.
    fn slip(&self, k: usize, contact: &Contact, x: &[Vec3]) -> Vec3 {
        let since: Vec3 = contact.parts().map(|(i, w)| (x[i] - self.at[i]) * w).sum();
        let drawn = match self.memory[k] {
            ContactMemory { touched: true, drawn, .. } => drawn,
            _ if contact.is_on_body() => contact.parts().map(|(i, w)| self.on_body[i] * w).sum(),
            _ => Vec3::zeros(),
        };
        across(contact) * (drawn + since)
    }

    /// The spring of contact number `k` for the normal force `load` and the nodes' coefficients `mu`. `None` while the
    /// contact is open or without friction.
    pub(super) fn hold(&self, k: usize, contact: &Contact, x: &[Vec3], load: f64, mu: &[f64]) -> Option<Hold> {
        let most = coefficient(contact, mu) * load.max(0.0);
        // Without load or friction coefficient the contact neither sticks nor slides.
        if most <= 0.0 {
            return None;
        }
        let stiffness = self.stiffness.max(most / GIVE);
        let drawn = self.slip(k, contact, x);
        let slid = self.memory[k].slid && contact.parts().all(|(i, _)| x[i] == self.at[i]);
        Some(Hold { drawn, stiffness, most, across: across(contact), slid })
    }

    /// Updates the memory after a step to `x`: sticking contacts add their displacement, sliding ones stay at their
    /// limit, open ones forget. `load(contact)` is the normal force.
    pub(super) fn update(
        &mut self,
        x: &[Vec3],
        contacts: &[Contact],
        mu: &[f64],
        load: impl Fn(&Contact) -> f64 + Sync,
    ) {
        let holds = parallel::map(contacts.len(), MEDIUM, |k| {
            let normal_force = load(&contacts[k]);
            (normal_force, self.hold(k, &contacts[k], x, normal_force, mu))
        });
        let mut on_body = vec![(Vec3::zeros(), 0.0); x.len()];
        self.touching.clear();
        for (k, (contact, (normal_force, hold))) in contacts.iter().zip(holds).enumerate() {
            self.memory[k] = hold.map_or_else(ContactMemory::default, |hold| ContactMemory {
                drawn: hold.kept(Vec3::zeros()),
                slid: hold.slid || hold.slides(hold.drawn),
                touched: true,
            });
            if self.memory[k].touched {
                self.touching.insert(key(contact), self.memory[k]);
            }
            if contact.is_on_body() && normal_force > 0.0 {
                for (i, w) in contact.parts() {
                    let share = w * normal_force;
                    on_body[i] = (on_body[i].0 + self.memory[k].drawn * share, on_body[i].1 + share);
                }
            }
        }
        self.on_body =
            on_body.iter().map(|(drawn, load)| if *load > 0.0 { drawn / *load } else { Vec3::zeros() }).collect();
        self.at.copy_from_slice(x);
    }
}

/// Projects onto the plane across a contact's normal.
fn across(contact: &Contact) -> Mat3 {
    Mat3::identity() - contact.normal * contact.normal.transpose()
}

/// Friction coefficient of a contact: the mean of its nodes' by their weights, and of two layers the mean of both.
fn coefficient(contact: &Contact, mu: &[f64]) -> f64 {
    let (sum, whole) = contact.parts().fold((0.0, 0.0), |(s, n), (i, w)| (s + w.abs() * mu[i], n + w.abs()));
    sum / whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Under;
    use approx::assert_relative_eq;

    #[test]
    fn what_slid_slides_on_until_it_moves_however_often_it_is_dragged() {
        let floor = Contact::on_body(0, Vec3::y(), Vec3::zeros());
        let mut friction = Friction::new(&[Vec3::zeros()], &[floor], 100.0);
        let x = [Vec3::x() * 0.1];
        for _ in 0..3 {
            friction.update(&x, &[floor], &[0.5], |_| 2.0);
            let grip = friction.hold(0, &floor, &x, 2.0, &[0.5]).map(|hold| hold.grip()).expect("it touches");
            assert!(grip.slides);
            assert_relative_eq!(grip.force.x, -1.0, epsilon = 1e-12);
        }
        let back = [Vec3::x() * 0.0999];
        assert!(friction.hold(0, &floor, &back, 2.0, &[0.5]).is_some_and(|hold| !hold.grip().slides));
        assert!(friction.hold(0, &floor, &x, 2.0, &[0.0]).is_none(), "without friction nothing holds");
    }

    #[test]
    fn what_other_hands_moved_was_not_dragged() {
        let floor = Contact::on_body(0, Vec3::y(), Vec3::zeros());
        let mut friction = Friction::new(&[Vec3::zeros()], &[floor], 100.0);
        let force = |friction: &Friction, x: Vec3| {
            friction.hold(0, &floor, &[x], 2.0, &[0.5]).map_or(f64::NAN, |hold| hold.grip().force.x)
        };
        let dragged = Vec3::x() * 1e-4;
        friction.update(&[dragged], &[floor], &[0.5], |_| 2.0);
        assert_relative_eq!(force(&friction, dragged), -0.2, epsilon = 1e-12);
        let put = Vec3::x() * 0.1;
        assert_relative_eq!(force(&friction, put), -1.0, epsilon = 1e-12);
        friction.displaced(&[put]);
        assert_relative_eq!(force(&friction, put), -0.2, epsilon = 1e-12);
    }

    #[test]
    fn a_contact_sticks_then_slides_and_remembers_across_detections() {
        // A node on a floor and one on an edge of another layer, both under 2 N with μ = 0.5: 1 N at most, after half a
        // millimetre.
        let floor = Contact::on_body(0, Vec3::y(), Vec3::zeros());
        let edge = Contact {
            nodes: [1, 2, 3, 0],
            weights: [1.0, -0.5, -0.5, 0.0],
            count: 3,
            above: 1,
            under: Under::Cloth,
            ..Contact::on_body(1, Vec3::y(), Vec3::zeros())
        };
        let mu = [0.5; 4];
        let mut x = vec![Vec3::zeros(), Vec3::zeros(), Vec3::z(), -Vec3::z()];
        let mut friction = Friction::new(&x, &[floor, edge], 100.0);
        let force = |friction: &Friction, k: usize, c: &Contact, x: &[Vec3]| {
            friction.hold(k, c, x, 2.0, &mu).map_or(f64::NAN, |h| h.grip().force.x)
        };
        for (to, expected) in [(0.004, -0.4), (0.009, -0.9), (0.013, -1.0), (0.010, -0.7), (-0.02, 1.0)] {
            x[0].x = 0.05 * to;
            x[1].x = 0.05 * to;
            assert_relative_eq!(force(&friction, 0, &floor, &x), expected, epsilon = 1e-12);
            assert_relative_eq!(force(&friction, 1, &edge, &x), expected, epsilon = 1e-12);
            friction.update(&x, &[floor, edge], &mu, |_| 2.0);
        }
        // Found again in another order. Then the other layer is carried along with the node: nothing changes.
        friction.detected(&[edge, floor]);
        x.iter_mut().for_each(|p| p.x += 0.5);
        assert_relative_eq!(force(&friction, 0, &edge, &x), 1.0, epsilon = 1e-12);
        assert_relative_eq!(force(&friction, 1, &floor, &x), -1.0, epsilon = 1e-12);
        // What is open forgets.
        friction.update(&x, &[edge, floor], &mu, |_| 0.0);
        assert_relative_eq!(force(&friction, 0, &edge, &x), 0.0);
    }
}
