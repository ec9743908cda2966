//! Normal force of a contact (F6) and its energy.
//!
//! The force begins softly and grows without bound as the gap closes. So nothing closes a gap, be it a shoulder seam
//! that presses on one corner of the body or a layer wedged between two that are sewn to one another.

use super::model::Cloth;
use crate::contact::Contact;
use crate::geometry::Vec3;

/// Growth of the load as the gap closes, in units of stiffness × distance kept. r is distance kept over gap, both
/// measured from the core of thick cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hardening {
    /// Load r − 1. For sewing and falling: layers that jam while seams close, and cloth under limbs that go back, yield
    /// and can be pressed to almost no gap.
    Slow,
    /// (r − 1) r². For rest. The normal of a contact on a corner of the body turns once its node has moved sideways by
    /// the gap. With [`Hardening::Slow`] the gap under the armhole of a tight dress was a micrometre, and the dress
    /// swung from one side of the corner to the other for hundreds of very short steps.
    Fast,
}

impl Hardening {
    /// Gap at which the law ends, as a share of the distance kept. The force must stay finite where a node starts
    /// inside the body.
    ///
    /// The armhole of a tight garment presses on one corner of a scanned arm with a dozen newtons, cuffs that are
    /// stretched by an eighth with hundreds. At these ends a contact of garments (60 N/m, 0.25 mm) carries 75 N (slow)
    /// and 1,800 N (fast). With an end at 0.05, cuffs that went beyond it did not come to rest.
    fn thinnest(self) -> f64 {
        match self {
            Self::Slow => 2e-4,
            Self::Fast => 0.02,
        }
    }

    /// Core of cloth of this half thickness on the body, metres: the part that cannot be compressed.
    fn core(self, half_thickness: f64) -> f64 {
        match self {
            Self::Slow => 0.0,
            Self::Fast if half_thickness < THICK => 0.0,
            Self::Fast => half_thickness - SOFT,
        }
    }

    /// Load of a contact of stiffness `k` (N/m) and distance kept `kept` (metres) at a gap of `thin` metres, N.
    fn load(self, k: f64, kept: f64, thin: f64) -> f64 {
        match self {
            Self::Slow => k * (kept - thin) * kept / thin,
            Self::Fast => k * (kept - thin) * (kept / thin).powi(3),
        }
    }

    /// Decrease of the load per growth of the gap, in multiples of the stiffness.
    fn slope(self, r: f64) -> f64 {
        match self {
            Self::Slow => r.powi(2),
            Self::Fast => r.powi(3) * (3.0 * r - 2.0),
        }
    }

    /// Work done from the distance kept down to a gap of `thin` metres, J.
    fn energy(self, k: f64, kept: f64, thin: f64) -> f64 {
        match self {
            Self::Slow => k * kept * (kept * (kept / thin).ln() - (kept - thin)),
            Self::Fast => 0.5 * k * (kept * (kept / thin - 1.0)).powi(2),
        }
    }
}

/// Least half thickness of cloth that has a core, metres. Without a core a tight band of jersey came nearer to the body
/// than half its thickness. Thinner cloth keeps its half thickness without a core, and trousers of linen (0.35 mm) took
/// a fifth more steps with one.
const THICK: f64 = 0.25e-3;
/// Compressible part of the half thickness of thick cloth, metres. The rest is its core. A core of the whole half
/// thickness did not come to rest where an arm presses a sleeve on the trunk.
const SOFT: f64 = 0.125e-3;

/// Slope of the force beyond the end of the law, in multiples of the initial stiffness. It is finite, so that a node
/// inside the body is pushed out gently.
const INSIDE: f64 = 2500.0;

/// Penalty contact (F6).
#[derive(Clone, Copy, Debug)]
pub struct ContactLaw {
    /// Initial stiffness of a contact, N/m.
    pub stiffness: f64,
    /// Growth of the load from there.
    pub hardening: Hardening,
    /// Distance kept from the body beyond half the cloth's thickness, metres.
    pub body_clearance: f64,
    /// Distance kept between two layers of cloth, metres. `None` = the two half thicknesses.
    pub cloth_gap: Option<f64>,
}

/// Load of a contact at given positions, and its slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct Press {
    /// Normal force, N. For a contact that does not touch it is negative: the tangent at the distance kept, extended.
    pub(super) load: f64,
    /// N/m.
    pub(super) slope: f64,
}

impl Press {
    /// Linearised load after the gap has grown by `opening` metres, N. Below 0 the contact does not touch.
    pub(super) fn after(&self, opening: f64) -> f64 {
        self.load - self.slope * opening
    }
}

impl ContactLaw {
    /// Distance at which a contact begins to push, metres.
    fn kept(&self, cloth: &Cloth, contact: &Contact) -> f64 {
        let first = cloth.half_thickness[contact.nodes[0] as usize];
        if contact.is_on_body() {
            return first + self.body_clearance;
        }
        self.cloth_gap
            .unwrap_or_else(|| first + cloth.half_thickness[contact.nodes[contact.count as usize - 1] as usize])
    }

    /// Distance kept and gap at `x`, metres, both measured from the core, where the load is unbounded.
    fn room(&self, cloth: &Cloth, x: &[Vec3], contact: &Contact) -> (f64, f64) {
        let kept = self.kept(cloth, contact);
        let core = if contact.is_on_body() { self.hardening.core(kept - self.body_clearance) } else { 0.0 };
        (kept - core, contact.gap(x) - core)
    }

    /// The largest distance at which a contact of `cloth` begins to push, metres.
    pub(super) fn widest(&self, cloth: &Cloth) -> f64 {
        let thickest = cloth.thickest();
        (0.5 * thickest + self.body_clearance).max(self.cloth_gap.unwrap_or(thickest))
    }

    /// Load and slope at `x`.
    pub(super) fn press(&self, cloth: &Cloth, x: &[Vec3], contact: &Contact) -> Press {
        let k = self.stiffness * contact.share;
        if contact.share == 0.0 {
            return Press { load: f64::NEG_INFINITY, slope: self.stiffness };
        }
        let (kept, gap) = self.room(cloth, x, contact);
        if gap >= kept {
            return Press { load: k * (kept - gap), slope: k };
        }
        let thin = gap.max(self.hardening.thinnest() * kept);
        let slope = if gap < thin { k * INSIDE } else { k * self.hardening.slope(kept / thin) };
        Press { load: self.hardening.load(k, kept, thin) + (thin - gap) * k * INSIDE, slope }
    }

    /// Normal force at `x`, N (0 when it does not touch).
    pub(super) fn load(&self, cloth: &Cloth, x: &[Vec3], contact: &Contact) -> f64 {
        self.press(cloth, x, contact).load.max(0.0)
    }

    /// Energy of a contact at `x`, J.
    pub(super) fn energy(&self, cloth: &Cloth, x: &[Vec3], contact: &Contact) -> f64 {
        let (kept, gap) = self.room(cloth, x, contact);
        let k = self.stiffness * contact.share;
        if gap >= kept {
            return 0.0;
        }
        let thin = gap.max(self.hardening.thinnest() * kept);
        let below = thin - gap;
        let pressed = self.hardening.load(k, kept, thin) + 0.5 * k * INSIDE * below;
        self.hardening.energy(k, kept, thin) + below * pressed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_load_is_the_slope_of_the_energy_and_its_slope_is_that_of_the_load() {
        for law in [Hardening::Slow, Hardening::Fast] {
            let (k, kept) = (60.0, 0.4e-3);
            for part in 1..=60 {
                // From where the law ends to where it begins.
                let gap = kept * law.thinnest().powf(f64::from(part) / 61.0);
                let step = 1e-5 * gap;
                let slope = |f: &dyn Fn(f64) -> f64| (f(gap - step) - f(gap + step)) / (2.0 * step);
                let (load, fall) = (law.load(k, kept, gap), k * law.slope(kept / gap));
                assert!((slope(&|gap| law.energy(k, kept, gap)) - load).abs() < 1e-6 * load, "{law:?} at {gap}");
                assert!((slope(&|gap| law.load(k, kept, gap)) - fall).abs() < 1e-6 * fall, "{law:?} at {gap}");
            }
            assert_eq!([law.load(k, kept, kept), law.energy(k, kept, kept), law.slope(1.0)], [0.0, 0.0, 1.0]);
        }
    }

    #[test]
    fn thick_cloth_has_a_core_at_rest_that_nothing_presses() {
        assert!((Hardening::Fast.core(0.3e-3) - 0.175e-3).abs() < 1e-12);
        assert_eq!([Hardening::Fast.core(0.2e-3), Hardening::Slow.core(0.3e-3)], [0.0, 0.0]);
    }
}
