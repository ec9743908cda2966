//! Openings as they are in one state of the garment.

use super::openings::SewnRim;
use super::schema::WornBefore;
use crate::geometry::{MM, Vec3, range_of};
use crate::mannequin::Mannequin;
use crate::verify::{Passage, Through, Welded, past_end, worn};

/// An opening in one state of the garment, metres.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    pub(super) passage: Passage,
    /// Distance past the end of the arm or leg that it is round.
    pub(super) past_end: Option<f64>,
    pub(super) length: f64,
    /// Mean height of its rim.
    pub(super) height: f64,
    /// Height of the highest point of its rim.
    pub(super) top: f64,
    /// Height of the highest point of its rim above the lowest.
    pub(super) level: f64,
}

impl Seen {
    pub(super) fn new(openings: &[&SewnRim], welded: &Welded, body: &Mannequin) -> Vec<Self> {
        let rims: Vec<Vec<Vec3>> = openings.iter().map(|o| o.positions(welded)).collect();
        let seen = |(rim, passage): (&Vec<Vec3>, Passage)| Self {
            top: rim.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max),
            past_end: passage.through.and_then(|part| past_end(rim, part, body)),
            passage,
            length: (0..rim.len()).map(|k| (rim[(k + 1) % rim.len()] - rim[k]).norm()).sum(),
            height: rim.iter().map(|p| p.y).sum::<f64>() / rim.len() as f64,
            level: {
                let [low, high] = range_of(rim.iter().map(|p| p.y));
                high - low
            },
        };
        rims.iter().zip(worn(&rims, body)).map(seen).collect()
    }

    /// Position on its body part: along an arm or a leg, otherwise its height.
    pub(super) fn along(&self) -> f64 {
        self.past_end.map_or(self.height, |past| -past)
    }

    pub(super) fn part(&self) -> Option<String> {
        self.passage.through.map(|part: Through| part.name().into())
    }

    pub(super) fn before(&self) -> WornBefore {
        WornBefore { body_part: self.part(), past_end: self.past_end.map(|past| past * MM), height: self.height * MM }
    }
}
