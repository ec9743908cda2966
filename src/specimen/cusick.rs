//! The drape test (Cusick 1968, BS 5058, ISO 9073-9): a disc of cloth over a smaller pedestal, and its shadow.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;

use super::rig::{SpecimenSheet, lift, settle};
use super::{BenchFigure, Known, Outcome, Sample, SpecimenError};
use crate::contact::Collider;
use crate::dynamics::{GRIP, World};
use crate::geometry::{TriMesh, Vec2, Vec3, rim_loops};

/// Radius of the disc of cloth, metres.
const DISC: f64 = 0.15;
/// Radius of the pedestal, metres.
const PEDESTAL: f64 = 0.09;
/// Height of the pedestal, metres: more than cloth hangs down.
const HEIGHT: f64 = 0.2;
/// Corners of the pedestal's rim: its chords leave the circle by 0.03 mm.
const ROUND: u32 = 128;
/// Grid spacing, metres. In half of it the means of all fabrics are within 2.4 points (`docs/bench.md`); but that is a
/// disc of 11,000 particles.
const SPACING: f64 = 0.005;
/// Size of the shadow's pixels, metres.
const PIXEL: f64 = 0.5e-3;
/// Height of the dents the cloth has before it falls, metres: something must say where the first fold goes.
const DENT: f64 = 0.3e-3;
/// Steps of falling.
const FALLING: usize = 150;
/// A draped disc is at rest when ten steps move it by less than this, metres.
const STILL: f64 = 1e-4;
/// A fold stands out from the hollows beside it by more than this share of the overhang.
const FOLD: f64 = 0.05;

/// A shadow seen from above.
#[derive(Clone, Debug)]
pub struct Shadow {
    /// Pixels along a side. The disc's middle is in the middle.
    pub width: usize,
    /// Row by row: whether cloth or pedestal stands in the light.
    pub dark: Vec<bool>,
}

/// Lay of a disc on its pedestal. No cloth is even, and its unevenness decides where the first fold forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lay {
    /// Angle from the threads to the unevenness, radians: another one is a disc cut elsewhere from the cloth.
    pub turn: f64,
    /// Whether the disc lies on its face, so that bulges become hollows.
    pub over: bool,
}

/// Angle from disc to disc, radians: no multiple of the golden one brings threads or waves back on themselves.
const GOLDEN: f64 = 2.399_963_229_728_653;

/// The lays of a test as BS 5058 has them: three discs, each with either face up.
pub const LAYS: [Lay; 6] = [
    Lay { turn: 0.0, over: false },
    Lay { turn: 0.0, over: true },
    Lay { turn: GOLDEN, over: false },
    Lay { turn: GOLDEN, over: true },
    Lay { turn: 2.0 * GOLDEN, over: false },
    Lay { turn: 2.0 * GOLDEN, over: true },
];

/// A draped disc.
#[derive(Clone, Debug)]
pub struct DrapedDisc {
    /// Its shadow.
    pub shadow: Shadow,
    /// Drape coefficient: share of the overhang that is in the shadow.
    pub coefficient: f64,
    /// Number of folds.
    pub folds: usize,
    /// The hanging cloth, y up, the pedestal's top at 0.
    pub cloth: TriMesh,
}

/// Discs of one fabric, laid down as in [`LAYS`].
#[derive(Clone, Debug)]
pub struct Series {
    /// One of each lay.
    pub draped: Vec<DrapedDisc>,
}

impl Series {
    /// Drapes the discs, in grids of `spacing` metres.
    ///
    /// # Errors
    /// As [`drape`], of the first lay that fails.
    pub fn drape(sample: &Sample, spacing: f64) -> Result<Self, SpecimenError> {
        let draped: Vec<_> = LAYS.par_iter().map(|lay| drape(sample, spacing, lay)).collect();
        Ok(Self { draped: draped.into_iter().collect::<Result<_, _>>()? })
    }

    /// Mean drape coefficient.
    pub fn mean(&self) -> f64 {
        self.draped.iter().map(|d| d.coefficient).sum::<f64>() / self.draped.len() as f64
    }

    /// Standard deviation of a single lay's coefficient, from those there are.
    pub fn deviation(&self) -> f64 {
        let mean = self.mean();
        let sum: f64 = self.draped.iter().map(|d| (d.coefficient - mean).powi(2)).sum();
        (sum / (self.draped.len() as f64 - 1.0)).sqrt()
    }

    /// Folds of each lay: `4, 5, 6`.
    pub fn folds(&self) -> String {
        self.draped.iter().map(|d| d.folds.to_string()).collect::<Vec<_>>().join(", ")
    }

    /// The lay whose coefficient is nearest to the mean.
    pub fn typical(&self) -> Option<&DrapedDisc> {
        let off = |d: &&DrapedDisc| (d.coefficient - self.mean()).abs();
        self.draped.iter().min_by(|a, b| off(a).total_cmp(&off(b)))
    }
}

/// Drape coefficient and folds.
pub(super) fn cusick(sample: &Sample) -> Result<Outcome, SpecimenError> {
    let series = Series::drape(sample, SPACING)?;
    let figure = |what: &str, unit: &'static str, measured: f64, known: Known| BenchFigure {
        test: "drape",
        what: format!("30 cm disc in {:.0} mm, {} lays: {what}", 1e3 * SPACING, LAYS.len()),
        unit,
        measured,
        known,
    };
    let folds = series.draped.iter().map(|d| d.folds as f64).sum::<f64>() / series.draped.len() as f64;
    let figures = vec![
        figure("coefficient", "%", 100.0 * series.mean(), sample.drape.map_or(Known::Nothing, Known::Band)),
        figure("standard deviation of a lay", "%", 100.0 * series.deviation(), Known::Nothing),
        figure(&format!("folds ({})", series.folds()), "", folds, Known::Nothing),
    ];
    Ok(Outcome { figures, draped: series.typical().cloned() })
}

/// Drapes a disc of 30 cm in a grid of `spacing` metres over a pedestal of 18 cm. Laid down otherwise it may come to
/// rest in another number of folds, as real cloth does, and with another coefficient.
///
/// # Errors
/// [`SpecimenError`] when it cannot be meshed or does not come to rest.
pub fn drape(sample: &Sample, spacing: f64, lay: &Lay) -> Result<DrapedDisc, SpecimenError> {
    let body = pedestal()?;
    let sheet = SpecimenSheet::disc(&sample.fabric, DISC, spacing)?;
    // The upper disc holds the cloth down up to the pedestal's edge. What bends at the last particle that is held is
    // the cloth from half a spacing before it on, and that particle is on average half a spacing
    // from where holding ends.
    let cloth = sheet.cloth(|p| p.norm() < PEDESTAL + spacing);
    let lift = lift(&sample.fabric);
    let x = sheet.placed(|p| Vec3::new(p.x, lift + lay.dent(p), p.y));
    let mut world = sheet.hang(cloth, x, &body)?;
    world.grip(GRIP);
    fall(&mut world)?;
    settle(&mut world, spacing, STILL)?;
    let shadow = Shadow::of(world.x(), &sheet.mesh.triangles);
    let area = |r: f64| PI * r * r;
    let coefficient = (shadow.area() - area(PEDESTAL)) / (area(DISC) - area(PEDESTAL));
    let folds = folds(world.x(), &sheet.mesh.triangles);
    Ok(DrapedDisc {
        shadow,
        coefficient,
        folds,
        cloth: TriMesh { vertices: world.into_x(), triangles: sheet.mesh.triangles },
    })
}

fn fall(world: &mut World) -> Result<(), SpecimenError> {
    let mut last = world.x().to_vec();
    for _ in 0..FALLING {
        let now = world.x().to_vec();
        world.fall(&last)?;
        last = now;
    }
    Ok(())
}

impl Lay {
    /// Dents outside the pedestal, the same for every mesh, with no order that a fold could follow: waves whose numbers
    /// have no common divisor.
    fn dent(&self, p: &Vec2) -> f64 {
        let (r, angle) = (p.norm(), p.y.atan2(p.x) + self.turn);
        let waves = [(2.0, 0.3), (3.0, 1.1), (5.0, 2.0), (7.0, 0.7), (11.0, 2.9)];
        let sum: f64 = waves.iter().map(|(n, phase)| f64::cos(n * angle + phase)).sum();
        let height = if self.over { -DENT } else { DENT };
        height * ((r - PEDESTAL) / (DISC - PEDESTAL)).max(0.0) * sum / waves.len() as f64
    }
}

/// A round pedestal whose top is at height 0.
fn pedestal() -> Result<Collider, SpecimenError> {
    let ring = |y: f64| {
        (0..ROUND).map(move |k| {
            let a = TAU * f64::from(k) / f64::from(ROUND);
            Vec3::new(PEDESTAL * a.cos(), y, PEDESTAL * a.sin())
        })
    };
    let mut vertices: Vec<Vec3> = ring(0.0).chain(ring(-HEIGHT)).collect();
    let [top, bottom] = [2 * ROUND, 2 * ROUND + 1];
    vertices.extend([Vec3::zeros(), Vec3::y() * -HEIGHT]);
    let triangles = (0..ROUND).flat_map(|a| {
        let b = (a + 1) % ROUND;
        [[a, b + ROUND, a + ROUND], [a, b, b + ROUND], [top, b, a], [bottom, a + ROUND, b + ROUND]]
    });
    Collider::new(&TriMesh { triangles: triangles.collect(), vertices }).ok_or(SpecimenError::Bench)
}

impl Shadow {
    /// The shadow of triangles and of the pedestal under light from straight above.
    fn of(x: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let width = (2.2 * DISC / PIXEL).ceil() as usize;
        let middle = |k: usize| (k as f64 + 0.5 - 0.5 * width as f64) * PIXEL;
        let pixel = |at: f64| ((at / PIXEL + 0.5 * width as f64).floor().max(0.0) as usize).min(width - 1);
        let mut dark: Vec<bool> =
            (0..width * width).map(|k| middle(k % width).hypot(middle(k / width)) < PEDESTAL).collect();
        for t in triangles {
            let [a, b, c] = t.map(|n| Vec2::new(x[n as usize].x, x[n as usize].z));
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            for row in pixel(low.y)..=pixel(high.y) {
                for column in pixel(low.x)..=pixel(high.x) {
                    let p = Vec2::new(middle(column), middle(row));
                    let side = |u: Vec2, v: Vec2| (v - u).perp(&(p - u));
                    let sides = [side(a, b), side(b, c), side(c, a)];
                    if sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0) {
                        dark[row * width + column] = true;
                    }
                }
            }
        }
        Self { width, dark }
    }

    /// Its area, m².
    fn area(&self) -> f64 {
        self.dark.iter().filter(|d| **d).count() as f64 * PIXEL * PIXEL
    }
}

/// Folds of a draped disc: how often its rim, walked once round, comes out of a hollow by [`FOLD`] of the overhang and
/// goes back in.
fn folds(x: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let Some(rim) = rim_loops(triangles).into_iter().max_by_key(Vec::len) else { return 0 };
    let radius: Vec<f64> = rim.iter().map(|&n| x[n as usize].x.hypot(x[n as usize].z)).collect();
    swings(&radius, FOLD * (DISC - PEDESTAL))
}

/// Number of swings of values round a ring: rises by more than `least` from the last minimum, followed by an equal
/// fall.
fn swings(ring: &[f64], least: f64) -> usize {
    let Some(lowest) = (0..ring.len()).min_by(|&a, &b| ring[a].total_cmp(&ring[b])) else { return 0 };
    let (mut count, mut rising, mut extreme) = (0, true, ring[lowest]);
    // From the lowest round to it again, so that none is cut in two.
    for k in 1..=ring.len() {
        let value = ring[(lowest + k) % ring.len()];
        if rising {
            // The lowest so far, until it has risen far enough.
            extreme = value.min(extreme);
            rising = value - extreme <= least;
            extreme = if rising { extreme } else { value };
        } else {
            extreme = value.max(extreme);
            if extreme - value > least {
                (count, rising, extreme) = (count + 1, true, value);
            }
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folds_are_counted_whatever_their_hollows_depth() {
        let ring = |wave: &dyn Fn(f64) -> f64| (0..200).map(|k| wave(TAU * f64::from(k) / 200.0)).collect::<Vec<_>>();
        assert_eq!(swings(&ring(&|a| 0.01 * (7.0 * a).cos()), 0.003), 7);
        // Folds on a slope, and ripples too small to count.
        assert_eq!(
            swings(&ring(&|a| 0.01 * (8.0 * a + 0.3).cos() + 0.02 * a.sin() + 0.0005 * (40.0 * a).cos()), 0.003),
            8
        );
        assert_eq!(swings(&ring(&|_| 0.1), 0.003), 0);
        assert_eq!(swings(&[], 0.003), 0);
    }
}
