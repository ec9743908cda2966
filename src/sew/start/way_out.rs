//! The ways of a body through a garment: from a point within along the axes to every opening, and out of it.

use super::axes::{Axes, Axis};
use super::circles::Mouth;
use super::ends::{End, Ends};
use super::rings::limb_of;
use crate::geometry::Vec3;
use crate::mannequin::PartKind;

/// Points are so far apart, metres.
const STEP: f64 = 0.01;
/// The head is so far above the base of the neck, metres.
const HEAD: f64 = 0.3;
/// A way goes straight on out of its opening for this, metres: no start lies further out.
const OUT: f64 = 0.4;

/// A way of the body, as points one [`STEP`] apart.
#[derive(Clone, Debug)]
pub(super) struct WayOut {
    /// From the point within to the middle of the opening.
    pub(super) within: Vec<Vec3>,
    /// From there straight out.
    pub(super) outside: Vec<Vec3>,
    /// The arm that leaves by it, if it is one.
    pub(super) arm: Option<PartKind>,
}

/// The ways from a point on an axis to all ends of the body.
pub(super) fn ways_out(mouths: &[Mouth], from: Vec3, axes: &Axes) -> Vec<WayOut> {
    End::ALL.into_iter().filter_map(|end| way_out(mouths, from, end, axes)).collect()
}

/// The axis of the arm or leg that a garment is round.
pub(super) fn axis_of<'a>(mouths: &[Mouth], axes: &'a Axes) -> Option<&'a Axis> {
    mouths.iter().find_map(|mouth| limb_of(mouth.ends.others())).and_then(|kind| axes.part(kind))
}

fn way_out(mouths: &[Mouth], from: Vec3, end: End, axes: &Axes) -> Option<WayOut> {
    let ring = mouths.iter().find(|mouth| mouth.ends.has(Ends::of(end)))?.ring;
    let mut within = along_axes(from, axis_of(mouths, axes), end, axes)?;
    let off = |p: &Vec3| (p - ring.center).norm();
    let last = (0..within.len()).min_by(|a, b| off(&within[*a]).total_cmp(&off(&within[*b])))?;
    within.truncate(last + 1);
    walk(&mut within, ring.center);
    // An opening that lies behind the point is passed there: the way goes out of it from the point on.
    let ahead = ring.center + ring.out() * (from - ring.center).dot(&ring.out()).max(0.0);
    let mut outside = vec![ahead];
    walk(&mut outside, ahead + ring.out() * OUT);
    let arm = limb_of(Ends::of(end)).filter(|kind| kind.is_arm());
    Some(WayOut { within, outside, arm })
}

/// From a point on the axis of a limb, if there is one `on` which the garment is, or of the trunk, to an end of the
/// body; of a limb's garment only as far as the trunk.
fn along_axes(from: Vec3, on: Option<&Axis>, end: End, axes: &Axes) -> Option<Vec<Vec3>> {
    if let Some(limb) = on {
        let at = limb.nearest(from);
        let is_outward = limb_of(Ends::of(end)) == Some(limb.kind);
        let (before, after): (Vec<f64>, Vec<f64>) = places(limb).partition(|s| *s < at);
        let rest = if is_outward { after } else { before.into_iter().rev().collect() };
        let mut out = vec![limb.station(at).center];
        rest.into_iter().for_each(|s| walk(&mut out, limb.station(s).center));
        return Some(out);
    }
    let torso = axes.part(PartKind::Torso)?;
    let limb = limb_of(Ends::of(end)).and_then(|kind| axes.part(kind));
    let to = match limb {
        None => torso.length() + HEAD,
        Some(limb) if limb.kind.is_arm() => torso.nearest(limb.station(0.0).center),
        Some(_) => 0.0,
    };
    let mut out = vec![torso.station(torso.nearest(from)).center];
    walk(&mut out, torso.station(to).center);
    if let Some(limb) = limb {
        places(limb).for_each(|s| walk(&mut out, limb.station(s).center));
    }
    Some(out)
}

/// Places along an axis from its beginning to its end, metres.
fn places(axis: &Axis) -> impl Iterator<Item = f64> {
    (0..=(axis.length() / STEP) as usize).map(|k| STEP * k as f64)
}

/// Goes straight on to a point.
fn walk(way: &mut Vec<Vec3>, to: Vec3) {
    let Some(&from) = way.last() else { return };
    let count = ((to - from).norm() / STEP).ceil() as usize;
    way.extend((1..=count).map(|k| from.lerp(&to, k as f64 / count as f64)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walk_ends_where_it_is_to_end() {
        let mut way = vec![Vec3::zeros()];
        walk(&mut way, Vec3::x() * 0.025);
        assert_eq!(way.len(), 4);
        assert!((way[3] - Vec3::x() * 0.025).norm() < 1e-12);
        walk(&mut way, Vec3::x() * 0.025);
        assert_eq!(way.len(), 4, "it is there already");
    }
}
