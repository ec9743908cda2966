//! Pieces that start in the body, moved out of it.

use rayon::prelude::*;

use super::error::SewError;
use crate::contact::Collider;
use crate::dynamics::Cut;
use crate::geometry::Vec3;

/// Metres; a start less deep is pushed out by the contact.
const DEEP: f64 = 0.015;
/// What lies deeper than this, metres, was meant for another place.
const DEEPEST: f64 = 0.05;
/// A piece of which more than this share is deeper than [`DEEP`] is pushed out on both sides.
const SHARE: f64 = 0.25;
/// A piece is moved by so much at a time, at most so often, metres.
const STEP: f64 = 4e-3;
const STEPS: usize = 25;
/// So many particles of a piece stand for all when its way out is looked for.
const SAMPLES: usize = 200;
/// How far the body's surface is looked for, metres.
const LOOK: f64 = 0.5;

/// Moves every piece that lies in the body, up to 50 mm deep, out of it as it is, the shortest straight way.
///
/// # Errors
/// [`SewError::InsideBody`] for one that is still deep then, or was deeper: the penalty would push its halves out on
/// different sides.
pub(super) fn lead_out(cut: &Cut, body: &Collider, start: &mut [Vec3]) -> Result<(), SewError> {
    for piece in &cut.mesh.pieces {
        let x = &mut start[piece.particles.clone()];
        let deepest = depths(body, x).fold(0.0, f64::max);
        if deepest <= DEEP {
            continue;
        }
        if deepest <= DEEPEST {
            let way = way_out(body, x);
            x.iter_mut().for_each(|p| *p += way);
        }
        let deep = depths(body, x).filter(|&d| d > DEEP).count();
        if deep as f64 > SHARE * x.len() as f64 {
            return Err(SewError::InsideBody { piece: piece.name.clone(), depth_mm: 1e3 * deepest });
        }
    }
    Ok(())
}

/// How deep each of some particles lies in the body, metres; negative outside.
fn depths(body: &Collider, x: &[Vec3]) -> impl Iterator<Item = f64> {
    x.iter().map(|&p| body.nearest(p, LOOK).map_or(-LOOK, |n| -n.distance))
}

/// The shortest straight way after which no particle lies in the body, or the fewest do so.
fn way_out(body: &Collider, x: &[Vec3]) -> Vec3 {
    let sample: Vec<Vec3> = x.iter().step_by(x.len().div_ceil(SAMPLES)).copied().collect();
    let depth_after = |way: Vec3| {
        let moved: Vec<Vec3> = sample.iter().map(|p| p + way).collect();
        depths(body, &moved).map(|d| d.max(0.0)).sum::<f64>()
    };
    // The least depth along each direction, and where.
    let best = |direction: &Vec3| {
        let mut best = (f64::INFINITY, 0, Vec3::zeros());
        for k in 0..=STEPS {
            let way = direction * (STEP * k as f64);
            let depth = depth_after(way);
            if depth < best.0 {
                best = (depth, k, way);
            }
            if depth == 0.0 {
                break;
            }
        }
        best
    };
    let ways: Vec<(f64, usize, Vec3)> = directions().par_iter().map(best).collect();
    ways.into_iter().min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map_or_else(Vec3::zeros, |best| best.2)
}

/// Unit vectors to the faces, edges and corners of a cube.
fn directions() -> Vec<Vec3> {
    let signs = || [-1.0, 0.0, 1.0].into_iter();
    let all = signs().flat_map(|x| signs().flat_map(move |y| signs().map(move |z| Vec3::new(x, y, z))));
    all.filter_map(|d| d.try_normalize(0.0)).collect()
}
