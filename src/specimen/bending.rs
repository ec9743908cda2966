//! Bending: strips that bend under their own weight, stand, or give way sideways, and sheets rolled up.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::sync::Arc;

use super::rig::{ALONG_WARP, SpecimenSheet, WAYS, nothing, settle};
use super::{BenchFigure, Known, Outcome, Sample, SpecimenError, theory};
use crate::fabric::Fabric;
use crate::geometry::{Vec2, Vec3};

/// Segments along a strip.
const SEGMENTS: usize = 50;
/// Segments across it.
const ACROSS: usize = 4;
/// Cells across the strips on edge. In four cells a knit, whose shear stiffness is that of its threads, gives so much
/// in its own plane that no series takes it off.
const ON_EDGE: [usize; 3] = [8, 12, 16];
/// A specimen is at rest when ten steps move it by less than this share of its length.
const STILL: f64 = 1e-6;
/// Γ of the cantilevers.
const GAMMAS: [f64; 8] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 100.0];

/// Thickness of a strip at most, in grid spacings: its own cells must not count as layers that touch.
const THIN: f64 = 0.1;

/// Bending length along a strip, metres.
fn length_of(fabric: &Fabric, angle: f64) -> f64 {
    if angle == ALONG_WARP { fabric.bending_length_warp() } else { fabric.bending_length_weft() }
}

/// A strip in a clamp, Γ = σ g L³/B.
struct ClampedStrip {
    sheet: SpecimenSheet,
    spacing: f64,
    /// From the jaws to the free end.
    length: f64,
    width: f64,
}

impl ClampedStrip {
    /// The first three rows are held. The cloth that bends begins half-way between the second and the third row, so the
    /// jaws are there.
    fn new(
        fabric: &Arc<Fabric>,
        angle: f64,
        gamma: f64,
        [segments, across]: [usize; 2],
    ) -> Result<Self, SpecimenError> {
        let length = length_of(fabric, angle) * gamma.cbrt();
        let spacing = length / (segments as f64 - 0.5);
        let size = [across as f64 * spacing, (segments + 1) as f64 * spacing];
        // A strip touches nothing, and its grid may be finer than the cloth is thick.
        let thin = Arc::new(Fabric { thickness: fabric.thickness.min(THIN * spacing), ..fabric.as_ref().clone() });
        Ok(Self { sheet: SpecimenSheet::strip(&thin, size, angle, spacing)?, spacing, length, width: size[0] })
    }

    /// Lets it go from the plane that `along` (its length) and `across` span. Returns the middle of its free end, seen
    /// from the jaws.
    fn end(&self, along: Vec3, across: Vec3) -> Result<Vec3, SpecimenError> {
        let bench = nothing()?;
        let middle = 0.5 * self.width;
        let jaws = 1.5 * self.spacing;
        let cloth = self.sheet.cloth(|p| p.y < 2.5 * self.spacing);
        let x = self.sheet.placed(|p| along * (p.y - jaws) + across * (p.x - middle));
        let mut world = self.sheet.hang(cloth, x, &bench)?;
        settle(&mut world, self.spacing, STILL * self.length)?;
        let end = self.sheet.particles(|p| p.y > self.length + self.spacing);
        Ok(end.iter().map(|&n| world.x()[n as usize]).sum::<Vec3>() / end.len() as f64)
    }
}

/// Share of its length that a cantilever's end is down over that it is out.
fn fall_over_reach(fabric: &Arc<Fabric>, angle: f64, gamma: f64, segments: usize) -> Result<f64, SpecimenError> {
    let end = ClampedStrip::new(fabric, angle, gamma, [segments, ACROSS])?.end(Vec3::x(), Vec3::z())?;
    Ok(-end.y / end.x)
}

/// By which share a cantilever of `gamma` = σ g L³/B in so many segments, cut along the warp, is off the master curve.
///
/// # Errors
/// [`SpecimenError`] when it does not come to rest.
pub fn cantilever_error(sample: &Sample, gamma: f64, segments: usize) -> Result<f64, SpecimenError> {
    let [reach, fall] = theory::cantilever(gamma);
    Ok(fall_over_reach(&sample.fabric, ALONG_WARP, gamma, segments)? * reach / fall - 1.0)
}

/// The heavy cantilever against the master curve (Peirce 1930, ASTM D1388).
pub(super) fn cantilever(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let fabric = &sample.fabric;
    let mut out = Vec::new();
    for (angle, way) in WAYS {
        for gamma in GAMMAS {
            let [reach, fall] = theory::cantilever(gamma);
            out.push(BenchFigure {
                test: "cantilever",
                what: format!("{way}, Γ = {gamma}: fall over reach"),
                unit: "",
                measured: fall_over_reach(fabric, angle, gamma, SEGMENTS)?,
                known: Known::Value { value: fall / reach, tolerance: 0.01 },
            });
        }
    }
    Ok(out.into())
}

/// The overhang at which the line from the jaws to the strip's end falls by 41.5°: twice the bending length.
pub(super) fn bending_length(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let fabric = &sample.fabric;
    let chord = 41.5f64.to_radians();
    let lengths = theory::gamma_of_chord(chord).cbrt();
    let measure = |(angle, way): (f64, &str)| {
        let angle_at = |gamma: f64| Ok::<_, SpecimenError>(fall_over_reach(fabric, angle, gamma, SEGMENTS)?.atan());
        // The angle is nearly straight in the logarithm of Γ between two lengths on either side.
        let (low, high) = (7f64, 9f64);
        let (below, above) = (angle_at(low)?, angle_at(high)?);
        let gamma = (low.ln() + (high / low).ln() * (chord - below) / (above - below)).exp();
        let c = length_of(fabric, angle);
        Ok(BenchFigure {
            test: "bending length",
            what: format!("{way}, from the overhang at 41.5°"),
            unit: "mm",
            measured: 1e3 * c * gamma.cbrt() / lengths,
            known: Known::Value { value: 1e3 * c, tolerance: 0.01 },
        })
    };
    Ok(WAYS.into_iter().map(measure).collect::<Result<Vec<_>, SpecimenError>>()?.into())
}

/// Initial lean or turn of the strips of the next two tests, radians: so small that they are still nearly straight at
/// ten times this angle.
const LEAN: f64 = 0.004;

/// The Γ at which a load grows without end, from the sideways deflection of strips that lean a little, at two Γ below
/// it (Southwell 1932: Γ over deflection is a straight line in Γ to the power `power`, which falls to 0).
fn southwell(
    gammas: [f64; 2],
    power: f64,
    deflection: impl Fn(f64) -> Result<f64, SpecimenError>,
) -> Result<f64, SpecimenError> {
    let [a, b] = gammas;
    let (stiff, soft) = (a / deflection(a)?, b / deflection(b)?);
    let (x, y) = (a.powf(power), b.powf(power));
    // A strip without stiffness leans as much at any length. The line then ends below 0.
    Ok((x + (y - x) * stiff / (stiff - soft)).max(0.0).powf(1.0 / power))
}

/// The length at which a strip can no longer stand on its clamp (Greenhill 1881).
pub(super) fn standing(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let fabric = &sample.fabric;
    let critical = theory::standing();
    let measure = |(angle, way): (f64, &str)| {
        let (up, side) = (Vec3::new(LEAN.sin(), LEAN.cos(), 0.0), Vec3::new(LEAN.cos(), -LEAN.sin(), 0.0));
        let deflection = |gamma: f64| {
            let strip = ClampedStrip::new(fabric, angle, gamma, [SEGMENTS, ACROSS])?;
            Ok(strip.end(up, Vec3::z())?.dot(&side) / strip.length)
        };
        let gamma = southwell([5.0, 6.5], 1.0, deflection)?;
        let c = 1e3 * length_of(fabric, angle);
        Ok(BenchFigure {
            test: "standing strip",
            what: format!("{way}, longest that stands"),
            unit: "mm",
            measured: c * gamma.cbrt(),
            known: Known::Value { value: c * critical.cbrt(), tolerance: 0.02 },
        })
    };
    Ok(WAYS.into_iter().map(measure).collect::<Result<Vec<_>, SpecimenError>>()?.into())
}

/// The length at which a strip clamped on edge gives way sideways.
pub(super) fn on_edge(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let fabric = &sample.fabric;
    let critical = theory::on_edge();
    let measure = |(angle, way): (f64, &str)| {
        let (across, side) = (Vec3::new(0.0, LEAN.cos(), LEAN.sin()), Vec3::new(0.0, -LEAN.sin(), LEAN.cos()));
        let critical_of = |segments: usize| {
            let deflection = |gamma: f64| {
                let strip = ClampedStrip::new(fabric, angle, gamma, [SEGMENTS, segments])?;
                Ok(strip.end(Vec3::x(), across)?.dot(&side).abs() / strip.length)
            };
            Ok::<_, SpecimenError>(southwell([15.5, 17.0], 2.0, deflection)?.cbrt())
        };
        let measured = [critical_of(ON_EDGE[0])?, critical_of(ON_EDGE[1])?, critical_of(ON_EDGE[2])?];
        let lengths = narrow_and_rigid(measured).ok_or(SpecimenError::Extreme)?;
        // Bent along its length and twisted by the mean of warp and weft.
        let ratio = (fabric.bend_warp / fabric.bend_weft).powf(if angle == ALONG_WARP { -0.25 } else { 0.25 });
        let c = 1e3 * length_of(fabric, angle);
        Ok(BenchFigure {
            test: "strip on edge",
            what: format!("{way}, longest that stays upright"),
            unit: "mm",
            measured: c * lengths,
            known: Known::Value { value: c * (critical * ratio).cbrt(), tolerance: 0.02 },
        })
    };
    Ok(WAYS.into_iter().map(measure).collect::<Result<Vec<_>, SpecimenError>>()?.into())
}

/// Limit of the results of strips on edge of the widths [`ON_EDGE`], for a strip that is narrow and rigid in its own
/// plane. The clamp hinders twisting over a share of the width, and in-plane bending contributes one over the square of
/// the width.
fn narrow_and_rigid(measured: [f64; 3]) -> Option<f64> {
    let rows = ON_EDGE.map(|w| nalgebra::RowVector3::new(1.0, w as f64, (w as f64).powi(-2)));
    let solved: Vec3 = nalgebra::Matrix3::from_rows(&rows).lu().solve(&measured.into())?;
    Some(solved.x)
}

/// Rigidity of a sheet of 100 mm rolled to a cylinder of 50 mm radius, by the energy it holds: ½ B/R² per area.
pub(super) fn roll(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let fabric = &sample.fabric;
    const SIDE: f64 = 0.1;
    const RADIUS: f64 = 0.05;
    let sheet = SpecimenSheet::strip(fabric, [SIDE, SIDE], ALONG_WARP, SIDE / SEGMENTS as f64)?;
    let cloth = sheet.cloth(|_| false);
    let (root_warp, root_weft) = (fabric.bend_warp.sqrt(), fabric.bend_weft.sqrt());
    let measure = |(angle, way): (f64, &str)| {
        let (round, along) = (Vec2::new(angle.sin(), angle.cos()), Vec2::new(angle.cos(), -angle.sin()));
        let x = sheet.placed(|p| {
            let turn = p.dot(&round) / RADIUS;
            Vec3::new(RADIUS * turn.sin(), RADIUS * turn.cos(), p.dot(&along))
        });
        let rigidity = 2.0 * cloth.elastic.bending.energy(&x) * (RADIUS / SIDE).powi(2);
        let known = (root_warp * angle.cos().powi(2) + root_weft * angle.sin().powi(2)).powi(2);
        BenchFigure {
            test: "roll",
            what: format!("{way}, rigidity"),
            unit: "µN·m",
            measured: 1e6 * rigidity,
            known: Known::Value { value: 1e6 * known, tolerance: 0.01 },
        }
    };
    Ok([(0.0, "warp"), (FRAC_PI_2, "weft"), (FRAC_PI_4, "45°"), (0.75 * PI, "135°")].map(measure).to_vec().into())
}
