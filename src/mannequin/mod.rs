//! Mannequins: measured sections lofted into a closed mesh, or a user's own closed OBJ.

mod adapt;
mod build;
mod cell;
mod check;
mod crossing;
mod detect;
mod field;
mod frame;
mod junction;
mod label;
mod library;
mod loft;
mod measures;
mod parts;
mod relax;
mod room;
mod slice;
mod spec;
mod spread;
mod surface;

pub use adapt::build_measured;
pub use build::build;
pub use check::{BodyCheck, BodyFault, FilePlace, check_body};
pub use detect::find_parts;
pub use frame::BodyFrame;
pub(crate) use junction::{Junction, JunctionSide, LEVEL, LIMB, junctions};
pub use library::{library, load, load_measured};
pub use measures::{Measures, measure_names};
pub use room::{GAP, make_room};
pub use spec::{ArmRow, ArmSpec, LegRow, LegSpec, MannequinSpec, TorsoRow};
pub(crate) use spread::LimbSpread;

use crate::geometry::{TriMesh, Vec3};
use crate::input::did_you_mean;

/// Why there is no mannequin.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MannequinError {
    /// Neither a library name nor a file.
    #[error("mannequin '{name}' not found{}; there are {known}, or give the path of a .yaml or .obj file",
            did_you_mean(nearest.as_deref()))]
    Unknown {
        /// As asked for.
        name: String,
        /// The most alike, if any is.
        nearest: Option<String>,
        /// The library's names.
        known: String,
    },
    /// The file cannot be read.
    #[error("{file}: {why}")]
    Read {
        /// Path.
        file: String,
        /// The system's message.
        why: String,
    },
    /// The text is no mannequin.
    #[error("{file}: {why}")]
    Syntax {
        /// Path or library name.
        file: String,
        /// The reader's message, with line and column.
        why: String,
    },
    /// A number that no body has.
    #[error("{file}: {why}")]
    Value {
        /// Path or library name.
        file: String,
        /// The number, and its allowed range.
        why: String,
    },
    /// A measure that cannot be had.
    #[error("a body like '{like}': {why}")]
    Measure {
        /// The mannequin.
        like: String,
        /// The measure, and the reason.
        why: String,
    },
    /// The sections make no simple closed body.
    #[error("mannequin '{name}' cannot be built: {why}; check the heights and centres of its sections")]
    Surface {
        /// Its name.
        name: String,
        /// The fault and its place.
        why: String,
    },
}

/// A body to dress.
#[derive(Clone, Debug)]
pub struct Mannequin {
    /// `woman_92`, or the OBJ's stem.
    pub name: String,
    /// Closed, oriented, outward. Metres, y up, feet at y = 0, facing +z, left hand at +x.
    pub mesh: TriMesh,
    /// Torso, neck, arms, legs.
    pub parts: Vec<BodyPart>,
    /// Transformation to the body's own file.
    pub frame: BodyFrame,
}

/// Heights of bodies that can be dressed, metres, from a doll's to a shop window's. Other heights mean another unit.
pub const HEIGHTS: std::ops::RangeInclusive<f64> = 0.2..=3.0;

/// Height of the legs' top, as a share of the body's, above which a body stands on its legs. The stumps of a dress form
/// do not reach so far.
const STANDS: f64 = 0.3;

impl Mannequin {
    /// The part of this kind, if the body has it.
    pub fn part(&self, kind: PartKind) -> Option<&BodyPart> {
        self.parts.iter().find(|part| part.kind == kind)
    }

    /// The section whose skin a point is nearest to, taking sections as spheres of their mean radius, and its part.
    /// `None` on a body without parts.
    pub fn nearest_section(&self, at: Vec3) -> Option<(PartKind, &Section)> {
        let sections = self.parts.iter().flat_map(|part| part.sections.iter().map(move |section| (part.kind, section)));
        let off = |section: &Section| (at - section.center).norm() - 0.5 * (section.half_width + section.half_depth);
        sections.min_by(|a, b| off(a.1).total_cmp(&off(b.1)))
    }

    /// Length of a tape round the body in the plane through `at` square to the unit `axis`, metres. It goes round those
    /// closed curves of the section whose middles satisfy `is_in`. `None` if there are none.
    pub fn tape(&self, at: Vec3, axis: Vec3, is_in: impl Fn(Vec3) -> bool) -> Option<f64> {
        let points = self.section_points(at, axis, is_in);
        let across = axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize();
        (!points.is_empty()).then(|| slice::tape(&points, across, axis.cross(&across)))
    }

    /// The points round which [`Self::tape`] goes, in no order, metres.
    pub fn section_points(&self, at: Vec3, axis: Vec3, is_in: impl Fn(Vec3) -> bool) -> Vec<Vec3> {
        let loops = slice::slice(&self.mesh, at, axis);
        loops.into_iter().filter(|l| is_in(l.center())).flat_map(|l| l.points).collect()
    }

    /// Height of the floor it stands on, metres. A form without legs hangs or stands on a pole, over no floor that its
    /// clothes could reach.
    pub fn floor(&self) -> Option<f64> {
        let top = self.mesh.vertices.iter().map(|v| v.y).fold(0.0, f64::max);
        let legs = self.parts.iter().filter(|p| p.kind.is_leg());
        let crotch = |leg: &BodyPart| leg.sections.iter().map(|s| s.center.y).fold(0.0, f64::max);
        (legs.filter(|leg| crotch(leg) > STANDS * top).count() == 2).then_some(0.0)
    }
}

/// A part of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PartKind {
    /// Crotch to shoulders.
    Torso,
    /// Neck base to top.
    Neck,
    /// Shoulder to wrist.
    LeftArm,
    /// Shoulder to wrist.
    RightArm,
    /// Crotch to ankle.
    LeftLeg,
    /// Crotch to ankle.
    RightLeg,
}

impl PartKind {
    /// `torso`, `neck`, `left arm`, `right arm`, `left leg`, `right leg`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Torso => "torso",
            Self::Neck => "neck",
            Self::LeftArm => "left arm",
            Self::RightArm => "right arm",
            Self::LeftLeg => "left leg",
            Self::RightLeg => "right leg",
        }
    }

    /// Whether it is an arm.
    pub fn is_arm(self) -> bool {
        matches!(self, Self::LeftArm | Self::RightArm)
    }

    /// Whether it is a leg.
    pub fn is_leg(self) -> bool {
        matches!(self, Self::LeftLeg | Self::RightLeg)
    }
}

/// A limb or the trunk as a bent cylinder.
#[derive(Clone, Debug)]
pub struct BodyPart {
    /// Its kind.
    pub kind: PartKind,
    /// Sections from the end next to the trunk outward (the torso from the crotch up).
    pub sections: Vec<Section>,
    /// Named points: centres of the sections called `crotch`, `hip`, `waist`, `bust`, `shoulder`, `neck base` (torso
    /// and neck), `shoulder`, `biceps`, `elbow`, `wrist` (arms; a shipped mannequin's `shoulder` is the acromion on the
    /// skin), `crotch`, `thigh`, `knee`, `ankle` (legs). Shipped mannequins have more, named as in their files.
    pub landmarks: Vec<(String, Vec3)>,
}

/// Extent of a hand or a foot beyond the last section of its limb, metres.
pub(crate) const HAND_OR_FOOT: f64 = 0.2;

/// One cross-section of a body part.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// Centre.
    pub center: Vec3,
    /// Unit axis direction, outward along the part.
    pub axis: Vec3,
    /// Half extent sideways: along the body's x for torso, neck and legs,
    /// for arms across the axis in the frontal plane.
    pub half_width: f64,
    /// Half extent front to back.
    pub half_depth: f64,
    /// Girth as a tape reads it (from the armscye to the shoulder that of the trunk alone, without the arms).
    pub girth: f64,
}
