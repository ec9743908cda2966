//! Stretching: a strip in a tensile tester, one that hangs, and one between two hooks.

use super::rig::{ALONG_WARP, SpecimenSheet, WAYS, drawn_out, held_with, nothing, settle};
use super::{BenchFigure, Known, Outcome, Sample, SpecimenError, theory};
use crate::fabric::{Fabric, GRAVITY, TensileCurve};
use crate::geometry::Vec3;

/// Grid spacing, metres: ten cells across every strip.
const SPACING: f64 = 0.005;
/// A specimen is at rest when ten steps move it by less than this, metres.
const STILL: f64 = 1e-8;
/// Length and width of a strip in the tester, metres: as for the Kawabata instruments' strip test, half as wide.
const TESTER: [f64; 2] = [0.2, 0.05];
/// Length and width of a strip that hangs, metres.
const HANGING: [f64; 2] = [1.0, 0.05];
/// Lengths of the strip between two hooks over their distance.
const SLACK: [f64; 3] = [1.05, 1.2, 1.5];

fn curve_of(fabric: &Fabric, angle: f64) -> &TensileCurve {
    if angle == ALONG_WARP { &fabric.warp } else { &fabric.weft }
}

/// Strain between two gauge marks a quarter of the strip from its jaws,
/// which keep the cloth beside them from contracting.
fn strain_in_the_middle(sheet: &SpecimenSheet, x: &[Vec3]) -> f64 {
    let length = TESTER[0];
    let [low, high] = [0.25, 0.75].map(|share| {
        let mark = sheet.particles(|p| (p.y - share * length).abs() < 0.5 * SPACING);
        let mean =
            |height: &dyn Fn(usize) -> f64| mark.iter().map(|&n| height(n as usize)).sum::<f64>() / mark.len() as f64;
        [mean(&|n| sheet.mesh.flat[n].y), mean(&|n| x[n].y)]
    });
    (high[1] - low[1]) / (high[0] - low[0]) - 1.0
}

/// A strip drawn out by a tester against the fabric's own curve, to every knot of it.
pub(super) fn pulled(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let (fabric, bench) = (&sample.fabric, nothing()?);
    let [length, width] = TESTER;
    let mut out = Vec::new();
    for (angle, way) in WAYS {
        let sheet = SpecimenSheet::strip(fabric, [width, length], angle, SPACING)?;
        for &(strain, _) in curve_of(fabric, angle).points.iter().filter(|p| p.1 > 0.0) {
            let world = drawn_out(&sheet, length, strain, &bench, STILL)?;
            let jaw = sheet.particles(|p| p.y > length - 0.5 * SPACING);
            let strain = strain_in_the_middle(&sheet, world.x());
            out.push(BenchFigure {
                test: "pulled strip",
                what: format!("{way}, load at {:.2} %", 100.0 * strain),
                unit: "N/m",
                measured: held_with(&world, &jaw).y / width,
                known: Known::Value { value: curve_of(fabric, angle).load(strain), tolerance: 0.01 },
            });
        }
    }
    Ok(out.into())
}

/// By how much a strip that hangs is drawn out by its own weight: the strain under the weight below, summed up.
pub(super) fn hanging(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let (fabric, bench) = (&sample.fabric, nothing()?);
    let [length, width] = HANGING;
    let measure = |(angle, way): (f64, &str)| {
        let sheet = SpecimenSheet::strip(fabric, [width, length], angle, SPACING)?;
        let cloth = sheet.cloth(|p| p.y < 0.5 * SPACING);
        let mut world = sheet.hang(cloth, sheet.placed(|p| Vec3::new(p.x, -p.y, 0.0)), &bench)?;
        settle(&mut world, SPACING, STILL)?;
        let end = sheet.particles(|p| p.y > length - 0.5 * SPACING);
        let fall = -end.iter().map(|&n| world.x()[n as usize].y).sum::<f64>() / end.len() as f64;
        // As many parts as the strip has rows would be enough for a straight curve.
        let parts = 1000;
        let weight = fabric.areal_density * GRAVITY * length;
        let strain = |k: usize| curve_of(fabric, angle).strain(weight * (k as f64 + 0.5) / parts as f64);
        Ok(BenchFigure {
            test: "hanging strip",
            what: format!("{way}, drawn out by its weight"),
            unit: "mm",
            measured: 1e3 * (fall - length),
            known: Known::Value {
                value: 1e3 * length * (0..parts).map(strain).sum::<f64>() / parts as f64,
                tolerance: 0.01,
            },
        })
    };
    Ok(WAYS.into_iter().map(measure).collect::<Result<Vec<_>, SpecimenError>>()?.into())
}

/// A long strip between two hooks against the catenary of a chain that stretches as the fabric does.
pub(super) fn between_hooks(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let (fabric, bench) = (&sample.fabric, nothing()?);
    let [length, width] = HANGING;
    let sheet = SpecimenSheet::strip(fabric, [width, length], ALONG_WARP, SPACING)?;
    let weight = fabric.areal_density * GRAVITY * length;
    let mut out = Vec::new();
    for slack in SLACK {
        let span = 1.0 / slack;
        let cloth = sheet.cloth(|p| p.y < 0.5 * SPACING || p.y > length - 0.5 * SPACING);
        // From two straight halves.
        let steep = (1.0 - span * span).sqrt();
        let x = sheet.placed(|p| Vec3::new(p.y * span, -p.y.min(length - p.y) * steep, p.x));
        let mut world = sheet.hang(cloth, x, &bench)?;
        settle(&mut world, SPACING, 1e-6)?;
        let lowest = world.x().iter().map(|p| -p.y).fold(0.0, f64::max);
        let jaw = sheet.particles(|p| p.y > length - 0.5 * SPACING);
        let pull = held_with(&world, &jaw).x / (weight * width);
        let [sag, level] = theory::catenary(span, |tension| fabric.warp.strain(tension * weight));
        let figure = |what: &str, measured: f64, value: f64| BenchFigure {
            test: "catenary",
            what: format!("length {slack} of the span: {what}"),
            unit: "",
            measured,
            known: Known::Value { value, tolerance: 0.02 },
        };
        out.push(figure("sag over span", lowest / (length * span), sag / span));
        out.push(figure("level pull over weight", pull, level));
    }
    Ok(out.into())
}
