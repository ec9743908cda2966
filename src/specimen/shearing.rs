//! Shearing: the picture frame and the bias extension.

use super::membrane::{BiasStrip, ORDERS};
use super::rig::{ALONG_WARP, SpecimenSheet, drawn_out, nothing, settle};
use super::{BenchFigure, Known, Outcome, Sample, SpecimenError};
use crate::geometry::{Vec2, Vec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, SQRT_2};

/// Grid spacing, metres.
const SPACING: f64 = 0.01;
/// A specimen is at rest when ten steps move it by less than this, metres.
const STILL: f64 = 1e-9;
/// Side of the picture frame, metres.
const FRAME: f64 = 0.1;
/// By how much the frame's diagonal is drawn out, in sides.
const DRAWN: [f64; 3] = [0.05, 0.1, 0.2];
/// Width and length of the bias strip, metres.
const BIAS: [f64; 2] = [0.1, 0.3];
/// Extensions, in multiples of length minus width. The first is so small that strains are small.
const EXTENDED: [f64; 4] = [0.005, 0.05, 0.1, 0.2];
/// Half the diagonal of the square in its middle where the shear is read, in widths.
const MIDDLE: f64 = 0.4;

/// A square in a frame of four hinged bars that a diagonal pull turns into a rhomb: the shear angle is the frame's, and
/// the load is the fabric's shear stiffness times it.
pub(super) fn picture_frame(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let (fabric, bench) = (&sample.fabric, nothing()?);
    let sheet = SpecimenSheet::strip(fabric, [FRAME, FRAME], ALONG_WARP, SPACING)?;
    let near = |a: f64| !(0.5 * SPACING..=FRAME - 0.5 * SPACING).contains(&a);
    let mut out = Vec::new();
    for drawn in DRAWN {
        let shear = FRAC_PI_2 - 2.0 * (1.0 / SQRT_2 + 0.5 * drawn).acos();
        let cloth = sheet.cloth(|p| near(p.x) || near(p.y));
        let rim = cloth.held.clone();
        let half = 0.5 * (FRAC_PI_2 - shear);
        let place = |p: &Vec2| Vec3::new((p.x - p.y) * half.sin(), (p.x + p.y) * half.cos(), 0.0);
        let mut world = sheet.hang(cloth, sheet.placed(place), &bench)?;
        world.gravity = 0.0;
        settle(&mut world, SPACING, STILL)?;
        // What turning the bars by a little more does in work, per angle and area.
        let turn = |p: &Vec2| Vec3::new(-(p.x - p.y) * half.cos(), (p.x + p.y) * half.sin(), 0.0) * 0.5;
        let forces = world.unbalanced();
        let work: f64 = rim.iter().map(|&n| -forces[n as usize].dot(&turn(&sheet.mesh.flat[n as usize]))).sum();
        out.push(BenchFigure {
            test: "picture frame",
            what: format!("shear load at {:.2}°", shear.to_degrees()),
            unit: "N/m",
            measured: work / (FRAME * FRAME),
            known: Known::Value { value: fabric.shear * shear, tolerance: 0.02 },
        });
    }
    Ok(out.into())
}

/// A strip cut on the bias and drawn out: by little, against the membrane of least energy. By more, beside the trellis,
/// which no cloth of constant shear stiffness can follow in the middle ([`membrane`](super::membrane)).
pub(super) fn bias_extension(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let (fabric, bench) = (&sample.fabric, nothing()?);
    let [width, length] = BIAS;
    let sheet = SpecimenSheet::strip(fabric, BIAS, FRAC_PI_4, SPACING)?;
    let stiffness = [fabric.warp.slope(0.0), fabric.weft.slope(0.0), fabric.shear];
    let strip = BiasStrip { size: BIAS, stiffness, orders: ORDERS };
    let per_metre = strip.shear_in_the_middle(MIDDLE * width).ok_or(SpecimenError::Extreme)?;
    let mut out = Vec::new();
    for extended in EXTENDED {
        let way = extended * (length - width);
        let drawn = drawn_out(&sheet, length, way / length, &bench, STILL)?;
        let trellis = FRAC_PI_2 - 2.0 * ((1.0 + extended) / SQRT_2).acos();
        let known = Known::Value { value: (per_metre * way).to_degrees(), tolerance: 0.05 };
        out.push(BenchFigure {
            test: "bias extension",
            what: format!("shear in the middle at {} % (trellis {:.2}°)", 100.0 * extended, trellis.to_degrees()),
            unit: "°",
            measured: shear_in_the_middle(&sheet, drawn.x()).to_degrees(),
            known: if extended == EXTENDED[0] { known } else { Known::Nothing },
        });
    }
    Ok(out.into())
}

/// Mean angle (radians) by which the threads of the triangles in the middle of a bias strip are off a right one.
fn shear_in_the_middle(sheet: &SpecimenSheet, x: &[Vec3]) -> f64 {
    let [width, length] = BIAS;
    let middle = Vec2::new(0.5 * width, 0.5 * length);
    let (mut sum, mut count) = (0.0, 0.0);
    for t in &sheet.mesh.triangles {
        let flat = t.map(|n| sheet.mesh.flat[n as usize]);
        if flat.iter().any(|p| (p - middle).abs().sum() > MIDDLE * width) {
            continue;
        }
        let [a, b, c] = t.map(|n| x[n as usize]);
        let edges = nalgebra::Matrix2::from_columns(&[flat[1] - flat[0], flat[2] - flat[0]]);
        let Some(inverse) = edges.try_inverse() else { continue };
        let stretched = nalgebra::Matrix3x2::from_columns(&[b - a, c - a]) * inverse;
        let (one, other) = (stretched * Vec2::new(1.0, 1.0), stretched * Vec2::new(-1.0, 1.0));
        sum += FRAC_PI_2 - one.angle(&other);
        count += 1.0;
    }
    sum / count
}
