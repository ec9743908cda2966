//! Light on a matte surface.

use super::camera::Camera;
use super::color::{Rgb, displayed};
use crate::geometry::Vec3;

/// Direction to the fill light, relative to the viewer: rightwards, upwards, towards the viewer (not unit length).
const FILL_FROM: [f64; 3] = [0.85, 0.10, 0.45];

/// Linear strength of the key light, by colour. A surface that faces it and sees the whole sky comes out just below
/// white.
const KEY: [f32; 3] = [0.70, 0.685, 0.655];
/// Linear strength of the fill light, by colour.
const FILL: [f32; 3] = [0.10, 0.105, 0.115];
/// Linear strength of the ambient light from above, by colour.
const SKY: [f32; 3] = [0.42, 0.43, 0.45];
/// Linear strength of the ambient light from below, by colour.
const FLOOR: [f32; 3] = [0.20, 0.19, 0.175];

/// Reach of the key light round the edge of lit surfaces, as of a large lamp.
const WRAP: f64 = 0.15;

/// Share of ambient light that reaches points that see nothing of the surroundings, reflected by near surfaces: the
/// inside of a collar is dark but not black.
const BOUNCED: f32 = 0.22;

/// Lights fixed to a view.
pub(super) struct Lights {
    key: Vec3,
    fill: Vec3,
}

impl Lights {
    pub(super) fn new(camera: &Camera) -> Self {
        let from = |[r, u, t]: [f64; 3]| (camera.right * r + camera.up * u + camera.toward * t).normalize();
        Self { key: from(camera.key_from), fill: from(FILL_FROM) }
    }

    /// Displayed light on a surface with this normal that sees `seen` of its surroundings.
    pub(super) fn on(&self, normal: &Vec3, seen: f32) -> Rgb {
        let seen = BOUNCED + (1.0 - BOUNCED) * seen;
        let key = ((normal.dot(&self.key) + WRAP) / (1.0 + WRAP)).max(0.0) as f32;
        let fill = normal.dot(&self.fill).max(0.0) as f32;
        let up = (0.5 + 0.5 * normal.y) as f32;
        // What sees little of its surroundings sees little of a large lamp, too.
        let lamp = 0.3 + 0.7 * seen;
        let channel = |k: usize| {
            let around = (SKY[k] * up + FLOOR[k] * (1.0 - up)) * seen;
            around + (KEY[k] * key + FILL[k] * fill) * lamp
        };
        [0, 1, 2].map(|k| displayed(channel(k)))
    }
}
