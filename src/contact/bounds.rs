//! Bounds that keep a step from carrying cloth through anything: a direction per pair, and a travel budget (leash) per
//! node.
//!
//! Take two convex primitives whose nodes move in straight lines. If they are separated along one direction before and
//! after a step, they are separated along it all the way, because each difference of two nodes along the direction is
//! linear in time. So it is enough to keep every found pair separated at the *end* of the step. Cloth that moves
//! together is not held back, as it would be by planes fixed in space.
//!
//! Layers that roll on each other are separated at the end along another direction m. Along (1 − t) n + t m the
//! difference e(t) of two nodes is a quadratic with the Bézier coefficients n·e₀, ½ (n·e₁ + m·e₀) and m·e₁. If none of
//! these is negative for any two nodes, the pair is separated all the way.

use super::kept_apart::{Kept, Sweep, clearance};
use super::{Contact, Under};
use crate::geometry::Vec3;
use crate::parallel::{self, LIGHT, MEDIUM};

/// Sweeps over the pairs, each of which pushes apart those that would meet.
const SWEEPS: usize = 12;
/// Share of its gap that a pair must keep in a step, up to the margin of [`Bounds::new`].
const KEPT: f64 = 0.2;
/// Least gap that still may shrink, metres. Gaps that shrank without end would end in rounding. A contact must carry
/// its force at a larger gap than this, or the bounds hold the cloth out of balance.
const LEAST: f64 = 1e-8;
/// Share of its leash after which a node makes a new search due.
const DUE: f64 = 2.0 / 3.0;
/// Share of its next leash up to which a node keeps its contacts in a search.
const STAYS: f64 = 0.2;
/// Share of its leash below which the remaining room of a node is short before a long step.
const ROOM: f64 = 0.6;
/// Share of a reach that leashes use. The rest is room for rounding.
const USED: f64 = 0.99;

/// Travel budgets of nodes since their last search, and least separations of pairs.
#[derive(Clone, Debug)]
pub struct Bounds {
    origin: Vec<Vec3>,
    /// Leash of each node: its largest distance from its origin, metres.
    leash: Vec<f64>,
    margin: f64,
    /// Held nodes.
    held: Vec<u32>,
}

impl Bounds {
    /// Bounds for nodes at `x`, whose contacts were searched within `reach`. Every pair keeps `margin` metres, or the
    /// share `KEPT` of its gap if that is less.
    pub fn new(x: &[Vec3], reach: f64, margin: f64) -> Self {
        Self { origin: x.to_vec(), leash: vec![Self::allowance(reach); x.len()], margin, held: Vec::new() }
    }

    /// Sets the nodes that are held and give way to nothing.
    pub fn hold(&mut self, held: Vec<u32>) {
        self.held = held;
    }

    /// Origin of every node: its position when it was last searched.
    pub fn origin(&self) -> &[Vec3] {
        &self.origin
    }

    /// Starts a new leash of `leash` metres for a `node` that was searched at `at`.
    pub fn restart(&mut self, node: usize, at: Vec3, leash: f64) {
        (self.origin[node], self.leash[node]) = (at, leash);
    }

    /// Shortens the leash of `node` to at most `leash` metres from the same origin.
    pub fn shorten(&mut self, node: usize, leash: f64) {
        self.leash[node] = self.leash[node].min(leash);
    }

    /// The longest leash, metres.
    pub fn longest(&self) -> f64 {
        self.leash.iter().copied().fold(0.0, f64::max)
    }

    /// Nodes that a search at `x` must cover: those that have gone a sixth of their leash, or `most` metres. A sixth of
    /// a leash after a search of all nodes is a fifth of the later leash.
    pub fn stale(&self, x: &[Vec3], most: f64) -> Vec<bool> {
        // Positions that are not numbers count as stale.
        let stays = |way: f64, leash: f64| way <= most.min(STAYS / (1.0 + STAYS) * leash);
        parallel::map(x.len(), LIGHT, |i| !stays((x[i] - self.origin[i]).norm(), self.leash[i]))
    }

    /// Whether a node has gone two thirds of its leash, so that a search is due.
    pub fn is_due(&self, x: &[Vec3]) -> bool {
        let mut gone = x.iter().zip(&self.origin).zip(&self.leash);
        gone.any(|((x, o), leash)| (x - o).norm_squared() > (DUE * leash).powi(2))
    }

    /// Whether a node has little room left for the `step`.
    pub fn is_short_of_room(&self, x: &[Vec3], step: &[Vec3]) -> bool {
        let short = |i: usize, leash: f64| {
            let left = leash - (x[i] - self.origin[i]).norm();
            left < ROOM * leash && left < step[i].norm()
        };
        self.leash.iter().enumerate().any(|(i, leash)| short(i, *leash))
    }

    /// Leash between two searches within `reach`, if the first did not cover all nodes, metres.
    ///
    /// When two primitives were last searched for one another, each of their nodes was at its origin, or within the
    /// share `STAYS` of its leash. Since then it has gone at most 1 + `STAYS` leashes, so that a pair that was not
    /// found cannot meet.
    pub fn allowance(reach: f64) -> f64 {
        0.5 * Self::allowance_beside_body(reach)
    }

    /// Leash beside the body, metres: as [`Bounds::allowance`], where one of the two primitives never moves.
    pub fn allowance_beside_body(reach: f64) -> f64 {
        USED * reach / (1.0 + STAYS)
    }

    /// Both leashes after a search of all nodes, metres. Each node was then at its origin.
    pub fn allowances_after_all(reach: f64, beside_body: f64) -> [f64; 2] {
        [0.5 * USED * reach, USED * beside_body]
    }

    /// The share (≤ 1) of a step that keeps every node on its leash. Shortening the step as a whole keeps its shape.
    /// Shortening it node by node would crumple the cloth.
    pub fn share(&self, x: &[Vec3], step: &[Vec3]) -> f64 {
        let mut share = 1.0f64;
        for ((d, leash), (x, o)) in step.iter().zip(&self.leash).zip(x.iter().zip(&self.origin)) {
            let (left, way) = (leash - (x - o).norm(), d.norm());
            if way > left {
                share = share.min((left / way).max(0.0));
            }
        }
        share
    }

    /// Moves the targets in `to` so that none of `contacts` meets on the way from `from`, where they were last updated.
    /// Held nodes, and nodes of pairs that the sweeps cannot separate, stay where they are. A broken leash shortens the
    /// whole step.
    pub fn clamp(&self, contacts: &[&Contact], from: &[Vec3], to: &mut [Vec3]) {
        let (planes, pairs): (Vec<&Contact>, Vec<&Contact>) = contacts.iter().partition(|c| c.under == Under::Plane);
        let contacts = [planes, pairs].concat();
        let judged = parallel::map(contacts.len(), MEDIUM, |k| {
            let kept = Kept { contact: contacts[k], need: self.need(clearance(contacts[k], from)) };
            (kept, kept.is_apart(from, to))
        });
        if !judged.iter().all(|j| j.1) {
            let mut sweep = Sweep::new(from, to, judged);
            for _ in 0..SWEEPS {
                let clean = sweep.push();
                sweep.put_back(self.held.iter().map(|&n| n as usize));
                if clean {
                    break;
                }
            }
            sweep.hold();
        }
        self.held.iter().for_each(|&n| to[n as usize] = from[n as usize]);
        let share = self.leash_share(from, to);
        if share < 1.0 {
            for (a, b) in from.iter().zip(to) {
                *b = a + (*b - a) * share;
            }
        }
    }

    /// The separation that a pair (or a node and the body) must keep when it has `now`.
    fn need(&self, now: f64) -> f64 {
        self.margin.min((KEPT * now).max(LEAST)).min(now).max(0.0)
    }

    /// The largest share of the step that breaks no leash.
    fn leash_share(&self, from: &[Vec3], to: &[Vec3]) -> f64 {
        let mut share = 1.0f64;
        for ((a, b), (o, length)) in from.iter().zip(to).zip(self.origin.iter().zip(&self.leash)) {
            let (d, r) = (b - a, a - o);
            // Rounding may leave a node just beyond the end of its leash.
            let (q, p, c) = (d.norm_squared(), r.dot(&d), (r.norm_squared() - length * length).min(0.0));
            if q > 0.0 && q + 2.0 * p + c > 0.0 {
                share = share.min(((p * p - q * c).max(0.0).sqrt() - p) / q);
            }
        }
        share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::kept_apart::{HELD, separation};
    use approx::assert_relative_eq;

    fn pair() -> ([Vec3; 4], Contact<'static>) {
        let x = [
            Vec3::new(0.0, 0.01, 0.0),
            Vec3::new(-1.0, 0.0, -1.0),
            Vec3::new(1.0, 0.0, -1.0),
            Vec3::new(0.0, 0.0, 1.0),
        ];
        let contact = Contact {
            nodes: [0, 1, 2, 3],
            weights: [1.0, -0.25, -0.25, -0.5],
            count: 4,
            normal: Vec3::y(),
            offset: 0.0,
            under: Under::Cloth,
            above: 1,
            share: 1.0,
        };
        (x, contact)
    }

    #[test]
    fn a_pair_that_rushes_together_is_kept_apart_and_may_slide() {
        let (x, contact) = pair();
        let bounds = Bounds::new(&x, 0.1, 1e-3);
        let mut to = x;
        to[0] += Vec3::new(0.02, -0.02, 0.0);
        bounds.clamp(&[&contact], &x, &mut to);
        assert!(separation(&contact, &to) >= 1e-3 - 1e-8);
        assert_relative_eq!(to[0].x, 0.02, epsilon = 1e-12);
    }

    #[test]
    fn what_is_held_gives_way_to_nothing() {
        let (x, contact) = pair();
        let mut bounds = Bounds::new(&x, 0.1, 1e-3);
        bounds.hold(vec![1, 2, 3]);
        let mut to = x;
        to[0] += Vec3::new(0.02, -0.02, 0.0);
        bounds.clamp(&[&contact], &x, &mut to);
        assert_eq!(to[1..], x[1..]);
        assert!(separation(&contact, &to) > HELD * 1e-3);
        assert_relative_eq!(to[0].x, 0.02, epsilon = 1e-12);
    }

    #[test]
    fn a_pair_that_moves_together_is_not_held_back() {
        let (x, contact) = pair();
        let bounds = Bounds::new(&x, 0.1, 1e-3);
        let mut to = x.map(|p| p + Vec3::new(0.0, -0.03, 0.0));
        let wish = to;
        bounds.clamp(&[&contact], &x, &mut to);
        assert_eq!(to, wish);
    }

    #[test]
    fn a_gap_pressed_again_and_again_never_closes() {
        let (mut x, contact) = pair();
        for _ in 0..200 {
            let bounds = Bounds::new(&x, 0.1, 1e-3);
            let mut to = x;
            to[0].y -= 0.02;
            bounds.clamp(&[&contact], &x, &mut to);
            x = to;
        }
        assert!(separation(&contact, &x) >= 0.99 * LEAST, "{:e}", separation(&contact, &x));
    }

    #[test]
    fn a_pair_that_two_others_squeeze_stays_where_it_is() {
        // A node between two sheets that both want to be on the node's other side.
        let (mut x, contact) = (vec![Vec3::zeros(); 7], pair().1);
        x[..4].copy_from_slice(&pair().0);
        for k in 0..3 {
            x[4 + k] = x[1 + k] + Vec3::y() * 0.02;
        }
        let above = Contact { nodes: [0, 4, 5, 6], weights: [1.0, -0.25, -0.25, -0.5], normal: -Vec3::y(), ..contact };
        let bounds = Bounds::new(&x, 0.2, 1e-3);
        let mut to = x.clone();
        for k in 0..3 {
            to[1 + k].y += 0.04;
            to[4 + k].y -= 0.04;
        }
        bounds.clamp(&[&contact, &above], &x, &mut to);
        for pair in [contact, above] {
            assert!(separation(&pair, &to) > 0.0, "{:?} {:e}", pair.nodes, separation(&pair, &to));
        }
    }

    #[test]
    fn a_layer_does_not_press_a_node_into_the_body() {
        let (x, contact) = pair();
        // The body's surface lies 5 mm under the node's sheet, and the node comes down on the sheet.
        let planes = (1..4).map(|n| Contact::on_body(n, Vec3::y(), Vec3::y() * -0.005));
        let contacts: Vec<Contact> = std::iter::once(contact).chain(planes).collect();
        let bounds = Bounds::new(&x, 0.2, 1e-3);
        let mut to = x.map(|p| p + Vec3::new(0.0, -0.08, 0.0));
        bounds.clamp(&contacts.iter().collect::<Vec<_>>(), &x, &mut to);
        assert!(contacts[1..].iter().all(|c| c.gap(&to) > 0.0));
        assert!(separation(&contact, &to) > 0.0);
    }

    #[test]
    fn a_triangle_may_roll_on_an_edge_it_lies_on() {
        // The node is a corner of a triangle that turns by 3° about it: along the old direction the far corners of the
        // lower triangle pass the node's height, but the gap does not change.
        let (mut x, contact) = pair();
        x[0].y = 1e-4;
        let bounds = Bounds::new(&x, 1.0, 1e-3);
        let mut to = x;
        for p in &mut to[1..] {
            p.y += 0.05 * p.x;
        }
        let wish = to;
        bounds.clamp(&[&contact], &x, &mut to);
        assert_eq!(to, wish);
        // A node that goes through is held, however the triangle turns meanwhile.
        to[0].y = -0.01;
        bounds.clamp(&[&contact], &x, &mut to);
        let above = (to[2] - to[1]).cross(&(to[3] - to[1])).dot(&(to[0] - to[1]));
        assert!(above * (x[2] - x[1]).cross(&(x[3] - x[1])).dot(&(x[0] - x[1])) > 0.0);
    }

    #[test]
    fn a_node_at_the_end_of_its_leash_holds_back_no_step_that_leaves_it_where_it_is() {
        let (x, _) = pair();
        let bounds = Bounds::new(&x, 0.1, 1e-3);
        let leash = Bounds::allowance(0.1);
        let mut gone = x;
        gone[0].x += 0.9 * leash;
        let step = |node: usize, way: f64| {
            let mut step = [Vec3::zeros(); 4];
            step[node].x = way;
            step
        };
        assert_eq!(bounds.share(&gone, &step(1, leash)), 1.0);
        assert_relative_eq!(bounds.share(&gone, &step(0, leash)), 0.1, epsilon = 1e-12);
        assert!(bounds.is_short_of_room(&gone, &step(0, leash)));
        assert!(!bounds.is_short_of_room(&gone, &step(1, leash)));
    }

    #[test]
    fn only_nodes_that_have_gone_some_way_are_stale() {
        let (x, _) = pair();
        let mut bounds = Bounds::new(&x, 0.1, 1e-3);
        let leash = Bounds::allowance(0.1);
        let mut gone = x;
        gone[1].y += 0.17 * leash;
        gone[2].y += 0.16 * leash;
        gone[3].y = f64::NAN;
        assert_eq!(bounds.stale(&gone, 1.0), [false, true, false, true]);
        assert_eq!(bounds.stale(&gone, 0.1 * leash), [false, true, true, true]);
        assert!(!bounds.is_due(&gone[..3]));
        bounds.shorten(2, 0.2 * leash);
        assert!(bounds.is_due(&gone[..3]), "four fifths of a shorter leash");
    }

    #[test]
    fn nothing_goes_further_than_its_leash() {
        let (x, contact) = pair();
        let bounds = Bounds::new(&x, 0.1, 1e-3);
        let mut to = x.map(|p| p + Vec3::new(0.0, 1.0, 0.0));
        bounds.clamp(&[&contact], &x, &mut to);
        assert_relative_eq!((to[0] - x[0]).norm(), Bounds::allowance(0.1), epsilon = 1e-12);
    }
}
