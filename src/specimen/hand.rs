//! The measurements of Liu, Wang & Luo 2015 (L2) on their own specimen, 460 × 400 mm: pulled along its diagonal, pushed
//! into a fold on a plate, and let go.
//!
//! The paper's cloth is crumpled by hand, and its yarns set. This cloth is elastic, so that after it is let go only the
//! plate's friction keeps it from recovering.

use std::f64::consts::PI;

use super::rig::{ALONG_WARP, SpecimenSheet, block, held_with, lift, nothing, settle};
use super::{BenchFigure, Known, Outcome, Sample, SpecimenError, theory};
use crate::contact::Collider;
use crate::dynamics::{GRIP, World};
use crate::fabric::GRAVITY;
use crate::geometry::{Vec2, Vec3, try_bisect};

/// Width (weft) and length (warp) of the specimen, metres.
const SIZE: [f64; 2] = [0.40, 0.46];
/// Grid spacing of the specimen that is pulled, metres.
const SPACING: f64 = 0.01;
/// Grid spacing of the specimen that is folded, metres.
const FINE: f64 = 0.005;
/// Loads on the fourth corner, kg.
const LOADS: [f64; 2] = [0.4, 0.8];
/// Half the width of the clips at the corners, metres.
const CLIP: f64 = 0.011;
/// The most the diagonal is drawn out, as a share of its length.
const FURTHEST: f64 = 0.3;
/// Rounds of halving in which a load is met: to less than a millionth of the diagonal.
const HALVINGS: usize = 18;
/// By how much the far side is pushed in, metres.
const PUSH: f64 = 0.04;
/// Length of cloth in the middle that is raised before it is let down to its fold, metres: a flat sheet on a plate
/// stays flat whatever it is pushed.
const RAISED: f64 = 0.2;
/// Parts in which the raised length is summed up.
const PARTS: usize = 400;
/// A specimen is at rest when ten steps move it by less than this, metres.
const STILL: f64 = 1e-5;

/// All three measurements, beside the published values of this fabric.
pub(super) fn measurements(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let published =
        |k: usize| sample.published.map_or_else(String::new, |means| format!(" (published: {:.4})", means[k]));
    let figure = |what: String, unit: &'static str, measured: f64| BenchFigure {
        test: "hand tests",
        what,
        unit,
        measured,
        known: Known::Nothing,
    };
    let mut out = Vec::new();
    for load in LOADS {
        let what = format!("diagonal under {:.0} g over its length{}", 1e3 * load, published(1));
        out.push(figure(what, "", diagonal(sample, load)?));
    }
    let [height, left] = fold(sample)?;
    out.push(figure(format!("height of a fold pushed in by {:.0} mm", 1e3 * PUSH), "mm", 1e3 * height));
    out.push(figure(format!("area within its rim from above when let go, over the whole{}", published(0)), "", left));
    Ok(out.into())
}

/// Length of the diagonal over that without load when three corners are held and the fourth is drawn by `load` kg.
fn diagonal(sample: &Sample, load: f64) -> Result<f64, SpecimenError> {
    let bench = nothing()?;
    let sheet = SpecimenSheet::strip(&sample.fabric, SIZE, ALONG_WARP, SPACING)?;
    let corner = Vec2::from(SIZE);
    let clip = |p: &Vec2, c: Vec2| (p - c).amax() < CLIP;
    const DRAWN: usize = 3;
    let corners = [Vec2::zeros(), Vec2::new(SIZE[0], 0.0), Vec2::new(0.0, SIZE[1]), corner];
    let drawn = sheet.particles(|p| clip(p, corner));
    let way = corner.normalize();
    let pull = |stretch: f64| {
        let cloth = sheet.cloth(|p| corners.iter().any(|&c| clip(p, c)));
        let out = way * stretch * corner.norm();
        // What is not clipped starts somewhere between.
        let share = |p: &Vec2| match corners.iter().position(|&c| clip(p, c)) {
            Some(DRAWN) => 1.0,
            Some(_) => 0.0,
            None => (p.dot(&way) / corner.norm()).powi(4),
        };
        let place = |p: &Vec2| p + out * share(p);
        let mut world = sheet.hang(cloth, sheet.placed(|p| place(p).push(0.0)), &bench)?;
        world.gravity = 0.0;
        settle(&mut world, SPACING, STILL)?;
        Ok::<_, SpecimenError>(held_with(&world, &drawn).dot(&way.push(0.0)))
    };
    let missing = |stretch: f64| pull(stretch).map(|force| force - load * GRAVITY);
    if missing(FURTHEST)? < 0.0 {
        return Err(SpecimenError::Soft { strain: FURTHEST, load: load * GRAVITY });
    }
    Ok(1.0 + try_bisect([0.0, FURTHEST], HALVINGS, missing)?)
}

/// Height of the fold of a cloth on a plate whose far side was pushed in, and the area within its rim, seen from above,
/// over the whole when it has been let go.
fn fold(sample: &Sample) -> Result<[f64; 2], SpecimenError> {
    let plate = plate()?;
    let sheet = SpecimenSheet::strip(&sample.fabric, SIZE, ALONG_WARP, FINE)?;
    let lift = lift(&sample.fabric);
    let raised = raised();
    let place = |p: &Vec2| {
        let part = (p.y - 0.5 * (SIZE[1] - RAISED)) / RAISED;
        let [back, up] = raised[(part.clamp(0.0, 1.0) * PARTS as f64).round() as usize];
        Vec3::new(p.x, lift + up, back - p.y)
    };
    let clamped = |p: &Vec2| p.y < 0.5 * FINE || p.y > SIZE[1] - 0.5 * FINE;
    let mut world = sheet.hang(sheet.cloth(clamped), sheet.placed(place), &plate)?;
    world.grip(GRIP);
    settle(&mut world, FINE, STILL)?;
    let height = world.x().iter().map(|p| p.y - lift).fold(0.0, f64::max);
    let released = let_go(&sheet, world, &plate)?;
    Ok([height, covered(&released, &sheet.mesh.triangles) / (SIZE[0] * SIZE[1])])
}

/// Position and height of every part of the raised length. Its slope is one period of a sine, of the amplitude that
/// uses up the push.
fn raised() -> Vec<[f64; 2]> {
    let part = RAISED / PARTS as f64;
    let slope = |most: f64, k: usize| most * (2.0 * PI * (k as f64 + 0.5) / PARTS as f64).sin();
    let used = |most: f64| (0..PARTS).map(|k| part * (1.0 - slope(most, k).cos())).sum::<f64>();
    let most = theory::root(0.0, 0.5 * PI, |most| used(most) - PUSH);
    let mut out = vec![[0.0; 2]];
    for k in 0..PARTS {
        let [back, up] = out[k];
        out.push([back + part * (1.0 - slope(most, k).cos()), up + part * slope(most, k).sin()]);
    }
    out
}

/// Shape of the cloth at rest when only the plate supports it.
fn let_go(sheet: &SpecimenSheet, folded: World, plate: &Collider) -> Result<Vec<Vec3>, SpecimenError> {
    let mut world = sheet.hang(sheet.cloth(|_| false), folded.into_x(), plate)?;
    world.grip(GRIP);
    settle(&mut world, FINE, STILL)?;
    Ok(world.into_x())
}

/// Area within the rim of a cloth seen from above, m². Parts that are turned over count negatively.
fn covered(x: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|n| Vec2::new(x[n as usize].x, x[n as usize].z));
        0.5 * (b - a).perp(&(c - a))
    };
    triangles.iter().map(area).sum::<f64>().abs()
}

/// A plate whose top is at height 0, larger than the specimen by a hand all round.
fn plate() -> Result<Collider, SpecimenError> {
    let (hand, thick) = (0.1, 0.02);
    block([-hand, -thick, -SIZE[1] - hand], [SIZE[0] + hand, 0.0, hand])
}
