//! The garment at every girth of the body.

use super::places::{GirthPlace, places};
use super::{Girth, Pressure, State, mm, side};
use crate::geometry::{KPA, Vec2, Vec3};
use crate::mannequin::PartKind;
use crate::verify::{ClothRing, CutPoint, ring};

/// Rows of the girths that the garment goes round.
pub(super) fn girths(state: &State) -> Vec<Girth> {
    places(state.run.body).iter().filter_map(|place| girth(state, place)).collect()
}

/// How far below a girth of the trunk a garment is measured at most, metres, and in which steps: at the bust line the
/// cloth often belongs to the sleeves as well, and makers then measure just below the armholes.
const BELOW: f64 = 0.06;
const STEP: f64 = 0.005;

/// The ring that goes round the part alone, and the point that it goes round.
fn own_ring(state: &State, place: &GirthPlace) -> Option<(ClothRing, Vec3)> {
    let most = if place.kind == PartKind::Torso { (BELOW / STEP).round() as usize } else { 0 };
    for step in 0..=most {
        let center = place.center - place.axis * (step as f64 * STEP);
        let ring = ring(&state.welded.surface, center, place.axis)?;
        let others = place.others(state.run.body, center);
        if others.iter().all(|other| ring.turns(*other, place.axis) == 0) {
            return Some((ring, center));
        }
    }
    None
}

fn girth(state: &State, place: &GirthPlace) -> Option<Girth> {
    let (ring, center) = own_ring(state, place)?;
    let garment = ring.length();
    let pressed = state.pressure.as_deref().map(|pressure| RingPressure::new(&ring, pressure));
    let pressure = pressed.as_ref().map(|p| Pressure { mean: KPA * p.mean, max: KPA * p.max });
    Some(Girth {
        name: place.name.clone(),
        height: mm(center.y),
        body: mm(place.girth),
        garment: mm(garment),
        flat: mm(flat_length(state, &ring)),
        ease: mm(garment - place.girth),
        pressure,
        band: pressure.map(|p| state.run.bands.of(p.max)),
        side: pressed.filter(|p| p.max > 0.0).map(|p| side(center, p.hardest)),
        cloth: used(state, &ring),
    })
}

/// Pressure round a ring, Pa.
struct RingPressure {
    mean: f64,
    max: f64,
    /// The place of the largest.
    hardest: Vec3,
}

impl RingPressure {
    fn new(ring: &ClothRing, pressure: &[f64]) -> Self {
        let at = |point: &CutPoint| {
            let [a, b] = point.ends.map(|v| pressure[v as usize]);
            a + (b - a) * point.share
        };
        let mut out = Self { mean: 0.0, max: 0.0, hardest: Vec3::zeros() };
        let (mut sum, mut length) = (0.0, 0.0);
        for (p, q, through) in ring.steps() {
            if at(p) > out.max {
                (out.max, out.hardest) = (at(p), p.at);
            }
            if through.is_some() {
                let step = (q.at - p.at).norm();
                sum += 0.5 * (at(p) + at(q)) * step;
                length += step;
            }
        }
        out.mean = if length > 0.0 { sum / length } else { 0.0 };
        out
    }
}

/// Length of a ring's cloth as it was cut, metres. Gaps keep their width.
fn flat_length(state: &State, ring: &ClothRing) -> f64 {
    let flat = |point: &CutPoint, triangle: u32| -> Option<Vec2> {
        let corners = state.welded.corners[triangle as usize];
        let particle = |v: u32| corners.into_iter().find(|&p| state.welded.vertex_of[p as usize] == v);
        let [a, b] = point.ends.map(particle);
        let at = |p: u32| state.run.mesh.flat[p as usize];
        Some(at(a?).lerp(&at(b?), point.share))
    };
    let step = |(p, q, through): (&CutPoint, &CutPoint, Option<u32>)| {
        let ends = through.and_then(|triangle| flat(p, triangle).zip(flat(q, triangle)));
        ends.map_or_else(|| (q.at - p.at).norm(), |(p, q)| (q - p).norm())
    };
    ring.steps().map(step).sum()
}

/// Largest share of what the fabric gives that is used round a ring.
fn used(state: &State, ring: &ClothRing) -> f64 {
    let corners = ring.through.iter().flatten().flat_map(|&triangle| state.welded.corners[triangle as usize]);
    corners.map(|particle| state.used[particle as usize]).fold(0.0, f64::max)
}
