//! Light on a matte surface.

use super::camera::Camera;
use super::color::{Rgb, displayed};
use crate::geometry::Vec3;

/// Where the fill light comes from, relative to the viewer: rightwards, upwards, towards the viewer (not unit length).
const FILL_FROM: [f64; 3] = [0.85, 0.10, 0.45];

/// Linear strengths. A surface that faces the key light and sees the whole sky comes out just below white.
const KEY: [f32; 3] = [0.70, 0.685, 0.655];
const FILL: [f32; 3] = [0.10, 0.105, 0.115];
const SKY: [f32; 3] = [0.42, 0.43, 0.45];
const FLOOR: [f32; 3] = [0.20, 0.19, 0.175];

/// The key light reaches this far round the edge of what it faces, as a large lamp's does.
const WRAP: f64 = 0.15;

/// Share of the surroundings' light that reaches even what sees nothing of them, thrown back by what is near: the
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
