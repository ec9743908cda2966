//! A mannequin with the measures of a person.

use super::measures::{Meaning, Measures, meaning};
use super::spec::{ArmRow, LegRow, MannequinSpec, TorsoRow, UNIT};
use super::{FilePlace, Mannequin, MannequinError, PartKind, build, check_body};
use crate::geometry::Vec3;

/// Measures are met within this on the finished surface, mm.
const WITHIN: f64 = 2.0;
/// Sections are corrected towards this, mm, as long as they come nearer, and not what is further off.
const AIM: f64 = 0.5;
const FAR: f64 = 60.0;
/// Legs whose skin touches are moved apart by so much each, mm, and arms that touch the trunk are raised by so much,
/// degrees, at most so often.
const FURTHER: f64 = 3.0;
const OUT: f64 = 4.0;
const APART: usize = 6;
/// The least and the largest ratio of a measure to the mannequin's own. Beyond it is another unit or another mannequin.
const RATIOS: std::ops::RangeInclusive<f64> = 0.6..=1.8;
/// Lengths that say the same may differ by this, mm.
const SLACK: f64 = 10.0;
/// Girths that are not measured follow the girth that they hang on by these powers of its ratio: bone and joint vary
/// less than flesh. (Set by hand. No population is behind them.)
const NECK: f64 = 0.5;
const SHOULDERS: f64 = 0.5;
const JOINT: f64 = 0.5;
const UPPER_ARM: f64 = 0.75;

/// Factors by which something is multiplied at heights or rows, linear between them and constant beyond.
type Factors = Vec<(f64, f64)>;

impl MannequinSpec {
    /// This mannequin's build with a person's measures.
    ///
    /// Heights that are not measured lie between the measured ones as they do here, and all of them follow `height`.
    /// Girths that are not measured change as the measured ones next to them. Neck and joints change by the square root
    /// of that, for bone varies less than flesh. Each section keeps the ratio of its width and depth.
    ///
    /// # Errors
    /// [`MannequinError::Measure`] with the name of a measure that this mannequin does not have, that is far from its
    /// own, or that contradicts another one.
    pub fn measured(&self, measures: &Measures) -> Result<Self, MannequinError> {
        let wrong = |why: String| MannequinError::Measure { like: self.name.clone(), why };
        for (name, meaning, mm) in measures.said() {
            let Some(own) = self.own(meaning) else {
                return Err(wrong(format!("'{name}' cannot be set: it has no such section")));
            };
            if !RATIOS.contains(&(mm / own)) {
                return Err(wrong(format!(
                    "'{name}' is {mm:.0} mm, its own is {own:.0}; lengths without a unit are millimetres"
                )));
            }
        }
        let heights = Heights::new(self, measures).map_err(wrong)?;
        let mut out = self.clone();
        out.name = format!("{}, measured", self.name);
        out.set_trunk(self, measures, &heights);
        out.set_legs(self, measures, &heights);
        out.set_arms(self, measures, &heights);
        out.height = self.height.map(|own| heights.at(own));
        out.check().map_err(|why| wrong(format!("these measures make no body: {why}")))?;
        Ok(out)
    }

    /// The measure of this name as the mannequin has it, mm. `None` of a name that is no measure of its sections.
    pub fn measure(&self, name: &str) -> Option<f64> {
        self.own(meaning(name)?)
    }

    /// The value of a measure of this mannequin, mm.
    fn own(&self, meaning: Meaning) -> Option<f64> {
        let row = |name: &str| self.torso_row(name);
        let height = |name: &str| row(name).map(|r| r.y).or_else(|| self.leg_row(name).map(|r| r.y));
        match meaning {
            Meaning::Trunk(name) => row(name).map(|r| r.girth),
            Meaning::Leg(name) => self.leg_row(name).map(|r| r.girth),
            Meaning::Arm(name) => self.arm_row(name).map(|r| r.girth),
            Meaning::Height => self.height,
            Meaning::Above(name) => row(name).map(|r| r.y),
            Meaning::BelowWaist(name) => Some(row("waist")?.y - height(name)?),
            Meaning::AboveWaist(name) => Some(row(name)?.y - row("waist")?.y),
            Meaning::Along(name) => self.arm_row(name).map(|r| r.at),
            Meaning::Across => Some(2.0 * self.arm.shoulder[0]),
            Meaning::Unused => None,
        }
    }

    fn leg_row(&self, name: &str) -> Option<&LegRow> {
        self.leg.rows.iter().find(|r| r.name == name)
    }

    fn arm_row(&self, name: &str) -> Option<&ArmRow> {
        self.arm.rows.iter().find(|r| r.name == name)
    }

    /// The ratio of a measure to the mannequin's own, if it is given.
    fn ratio(&self, measures: &Measures, meaning: Meaning) -> Option<f64> {
        Some(measures.of(meaning)? / self.own(meaning)?)
    }

    fn set_trunk(&mut self, own: &Self, measures: &Measures, heights: &Heights) {
        let axilla = own.torso_row("axilla").map_or(f64::MAX, |r| r.y);
        let given = |row: &TorsoRow| Some((row.y, own.ratio(measures, Meaning::Trunk(&row.name))?));
        let trunk: Factors = own.torso.iter().filter(|row| row.y <= axilla).filter_map(given).collect();
        let shoulders = own.shoulders(measures, &trunk);
        let neck = own.ratio(measures, Meaning::Trunk("neck base")).unwrap_or_else(|| at(&trunk, axilla).powf(NECK));
        let y = |name: &str| own.torso_row(name).map_or(axilla, |r| r.y);
        let above: Factors = vec![(axilla, at(&trunk, axilla)), (y("shoulder"), shoulders), (y("neck base"), neck)];
        for (row, old) in self.torso.iter_mut().zip(&own.torso) {
            let factor = at(if old.y <= axilla { &trunk } else { &above }, old.y);
            (row.girth, row.width, row.depth) = (old.girth * factor, old.width * factor, old.depth * factor);
            row.y = heights.at(old.y);
            row.z = old.z * heights.factor;
        }
    }

    /// The ratio of the breadth of the shoulders.
    fn shoulders(&self, measures: &Measures, trunk: &Factors) -> f64 {
        let axilla = self.torso_row("axilla").map_or(0.0, |r| r.y);
        self.ratio(measures, Meaning::Across).unwrap_or_else(|| at(trunk, axilla).powf(SHOULDERS))
    }

    /// The ratio of the girth of a row of the trunk to that of another mannequin.
    fn girth_over(&self, other: &Self, row: &str) -> f64 {
        other.torso_row(row).zip(self.torso_row(row)).map_or(1.0, |(old, new)| new.girth / old.girth)
    }

    fn set_legs(&mut self, own: &Self, measures: &Measures, heights: &Heights) {
        let (hip, crotch) = (self.girth_over(own, "hip"), self.girth_over(own, "crotch"));
        // By itself the thigh changes as the hip, and what is below it as a joint.
        let plain = |k: usize| match k {
            0 => hip,
            1 => hip.powf(0.5 * (1.0 + JOINT)),
            _ => hip.powf(JOINT),
        };
        let girth =
            |(k, row): (usize, &LegRow)| Some((k as f64, own.ratio(measures, Meaning::Leg(&row.name))? / plain(k)));
        let girths: Factors = own.leg.rows.iter().enumerate().filter_map(girth).collect();
        self.leg.crotch_x = own.leg.crotch_x * crotch;
        for (k, (row, old)) in self.leg.rows.iter_mut().zip(&own.leg.rows).enumerate() {
            row.girth = old.girth * plain(k) * at(&girths, k as f64);
            row.x = old.x * plain(k);
            row.y = heights.at(old.y);
            row.z = old.z * heights.factor;
        }
    }

    fn set_arms(&mut self, own: &Self, measures: &Measures, heights: &Heights) {
        let (bust, shoulders) = (self.girth_over(own, "axilla"), self.girth_over(own, "shoulder"));
        let plain = |k: usize| bust.powf(if k == 0 { UPPER_ARM } else { JOINT });
        let girth =
            |(k, row): (usize, &ArmRow)| Some((k as f64, own.ratio(measures, Meaning::Arm(&row.name))? / plain(k)));
        let along = |(k, row): (usize, &ArmRow)| {
            Some((k as f64, own.ratio(measures, Meaning::Along(&row.name))? / heights.factor))
        };
        let girths: Factors = own.arm.rows.iter().enumerate().filter_map(girth).collect();
        let lengths: Factors = own.arm.rows.iter().enumerate().filter_map(along).collect();
        for (k, (row, old)) in self.arm.rows.iter_mut().zip(&own.arm.rows).enumerate() {
            row.girth = old.girth * plain(k) * at(&girths, k as f64);
            row.at = old.at * heights.factor * at(&lengths, k as f64);
        }
        // The axis keeps its depth under the skin, in proportion to the arm.
        let [shoulder, joint] = [own.arm.shoulder, own.arm.joint];
        let y = heights.at(shoulder[1]);
        let across = shoulder[0] * shoulders;
        let thick = self.arm.rows[0].girth / own.arm.rows[0].girth;
        self.arm.shoulder = [across, y, shoulder[2] * heights.factor];
        self.arm.joint = [
            across + (joint[0] - shoulder[0]) * thick,
            y + (joint[1] - shoulder[1]) * thick,
            joint[2] * heights.factor,
        ];
    }
}

/// Where heights of a mannequin come to be.
struct Heights {
    /// Its heights and the new ones, from the floor up.
    anchors: Vec<(f64, f64)>,
    /// Ratio of the whole.
    factor: f64,
}

impl Heights {
    fn new(own: &MannequinSpec, measures: &Measures) -> Result<Self, String> {
        let y = |name: &str| own.torso_row(name).map(|r| r.y).or_else(|| own.leg_row(name).map(|r| r.y));
        let waist = y("waist");
        let above = |name: &'static str| measures.of(Meaning::Above(name));
        let ratios = [
            own.ratio(measures, Meaning::Height),
            own.ratio(measures, Meaning::Above("waist")),
            own.ratio(measures, Meaning::Above("crotch")),
        ];
        let factor = ratios.into_iter().flatten().next().unwrap_or(1.0);
        let depth = measures.of(Meaning::BelowWaist("crotch"));
        let sum = above("crotch").zip(depth).map(|(inseam, depth)| inseam + depth);
        if let Some((waist, sum)) = above("waist").zip(sum)
            && (waist - sum).abs() > SLACK
        {
            return Err(format!(
                "'waist_to_floor' is {waist:.0} mm, but 'inseam' and 'crotch_depth' are {sum:.0} together"
            ));
        }
        let own_stature = own.height.unwrap_or_else(|| own.torso.last().map_or(1.0, |r| r.y));
        let plain = |y: f64| y * factor;
        let new_waist = above("waist").or(sum).or_else(|| {
            // Without the crotch's own height the trunk follows the whole.
            let (own, inseam) = (y("crotch")?, above("crotch")?);
            Some(between((own, inseam), (own_stature, plain(own_stature)), waist?))
        });
        let mut anchors = vec![(0.0, 0.0, "the floor"), (own_stature, plain(own_stature), "height")];
        anchors.extend(waist.zip(new_waist).map(|(own, new)| (own, new, "waist_to_floor")));
        let from = new_waist.or(waist.map(plain));
        for (name, meaning, mm) in measures.said() {
            let anchor = match meaning {
                Meaning::Above(row) if row != "waist" => y(row).map(|own| (own, mm)),
                Meaning::BelowWaist(row) => y(row).zip(from).map(|(own, from)| (own, from - mm)),
                Meaning::AboveWaist(row) => y(row).zip(from).map(|(own, from)| (own, from + mm)),
                _ => None,
            };
            let is_new = |own: f64| anchors.iter().all(|(there, _, _)| *there != own);
            anchors.extend(anchor.filter(|(own, _)| is_new(*own)).map(|(own, new)| (own, new, name)));
        }
        anchors.sort_by(|a, b| a.0.total_cmp(&b.0));
        match anchors.windows(2).find(|pair| pair[1].1 - pair[0].1 < 0.25 * (pair[1].0 - pair[0].0)) {
            Some(pair) => Err(format!(
                "'{}' and '{}' contradict one another: they lead to heights of {:.0} and {:.0} mm",
                pair[0].2, pair[1].2, pair[0].1, pair[1].1
            )),
            None => Ok(Self { anchors: anchors.into_iter().map(|(own, new, _)| (own, new)).collect(), factor }),
        }
    }

    /// The new height of what is at `y`.
    fn at(&self, y: f64) -> f64 {
        let last = self.anchors.len() - 1;
        let k = self.anchors.partition_point(|anchor| anchor.0 <= y).clamp(1, last);
        between(self.anchors[k - 1], self.anchors[k], y)
    }
}

/// The value at `x` on the line through two points.
fn between(a: (f64, f64), b: (f64, f64), x: f64) -> f64 {
    a.1 + (x - a.0) * (b.1 - a.1) / (b.0 - a.0)
}

/// The factor at `x`. 1 without any.
fn at(factors: &Factors, x: f64) -> f64 {
    let Some(last) = factors.len().checked_sub(1) else { return 1.0 };
    let k = factors.partition_point(|factor| factor.0 <= x);
    match k {
        0 => factors[0].1,
        k if k > last => factors[last].1,
        k => between(factors[k - 1], factors[k], x),
    }
}

/// Builds a mannequin with a person's measures. Every given girth is met within 2 mm by a tape round the surface. Where
/// its thighs touch, the legs stand further apart, and where the arms touch the trunk, they are held further out.
///
/// # Errors
/// As [`MannequinSpec::measured`] and [`build`](super::build()), and [`MannequinError::Measure`] for a girth that the
/// surface cannot have.
pub fn build_measured(spec: &MannequinSpec, measures: &Measures) -> Result<Mannequin, MannequinError> {
    let mut adapted = spec.measured(measures)?;
    for _ in 0..APART {
        let mannequin = met(&mut adapted, measures)?;
        let missed = missed(&mannequin, measures).map(|(_, meaning, _)| !matches!(meaning, Meaning::Leg(_)));
        // A fault of the skin itself is told by what puts cloth on it.
        let check = check_body(&mannequin.mesh, FilePlace::millimetres).ok().and_then(|check| check.crossings);
        let crotch = adapted.torso[0].y * UNIT;
        let Some(is_arm) = missed.or(check.map(|(_, at)| at.y > crotch)) else { return Ok(mannequin) };
        if is_arm {
            adapted.arm.abduction += OUT;
        } else {
            adapted.leg.crotch_x += FURTHER;
            adapted.leg.rows.iter_mut().for_each(|row| row.x += FURTHER);
        }
    }
    let mannequin = met(&mut adapted, measures)?;
    missed(&mannequin, measures).map_or(Ok(mannequin), |(name, _, off)| {
        let why = format!("'{name}' cannot be met beside the other measures: it comes out {off:+.0} mm");
        Err(MannequinError::Measure { like: spec.name.clone(), why })
    })
}

/// Builds the mannequin, and corrects its sections until the measures are met or come no nearer.
fn met(adapted: &mut MannequinSpec, measures: &Measures) -> Result<Mannequin, MannequinError> {
    let mut best = f64::INFINITY;
    loop {
        let mannequin = build(adapted)?;
        let errors = errors(&mannequin, measures);
        let worst = errors.iter().map(|error| error.2.abs()).fold(0.0, f64::max);
        // A girth so far off has another part under the same tape. No section makes up for that.
        if worst <= AIM || worst > FAR || worst > 0.9 * best {
            return Ok(mannequin);
        }
        best = worst;
        errors.iter().for_each(|(_, meaning, off)| adapted.correct(*meaning, -off));
    }
}

/// The first measure that is not met.
fn missed<'a>(mannequin: &Mannequin, measures: &'a Measures) -> Option<(&'a str, Meaning<'static>, f64)> {
    errors(mannequin, measures).into_iter().find(|error| error.2.abs() > WITHIN)
}

/// Girths of a mannequin less those that are wanted, mm.
fn errors<'a>(mannequin: &Mannequin, measures: &'a Measures) -> Vec<(&'a str, Meaning<'static>, f64)> {
    let girth = |(name, meaning, wanted)| {
        let (kinds, row): (&[PartKind], &str) = match meaning {
            Meaning::Trunk(row) => (&[PartKind::Torso, PartKind::Neck], row),
            Meaning::Leg(row) => (&[PartKind::LeftLeg], row),
            Meaning::Arm(row) => (&[PartKind::LeftArm], row),
            _ => return None,
        };
        let part = kinds.iter().filter_map(|kind| mannequin.part(*kind)).find_map(|part| {
            let mark = part.landmarks.iter().find(|mark| mark.0 == row)?;
            Some((part, mark.1))
        });
        let (part, mark) = part?;
        let section = part
            .sections
            .iter()
            .min_by(|a, b| (a.center - mark).norm_squared().total_cmp(&(b.center - mark).norm_squared()))?;
        let axis = if part.kind.is_leg() { Vec3::y() } else { section.axis };
        let girth = mannequin.tape(mark, axis, |center| (center - mark).norm() < section.half_depth)?;
        Some((name, meaning, girth / UNIT - wanted))
    };
    measures.said().filter_map(girth).collect()
}

impl MannequinSpec {
    /// Changes the girth of a row by so much, mm.
    fn correct(&mut self, meaning: Meaning, by: f64) {
        match meaning {
            Meaning::Trunk(name) => self.torso.iter_mut().filter(|r| r.name == name).for_each(|r| r.girth += by),
            Meaning::Leg(name) => self.leg.rows.iter_mut().filter(|r| r.name == name).for_each(|r| r.girth += by),
            Meaning::Arm(name) => self.arm.rows.iter_mut().filter(|r| r.name == name).for_each(|r| r.girth += by),
            _ => {}
        }
    }
}
