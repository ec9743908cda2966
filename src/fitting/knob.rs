//! Knobs: alterations whose amounts are chosen.

use crate::geometry::MM;
use crate::pattern::{AlterationFile, KnobFile, Located, Quantity, Spot, StationFile, Unit};

/// Amounts below this are none, mm.
pub(super) const NONE: f64 = 0.05;
/// Digits of amounts that are written, as a power of ten: micrometres.
const DIGITS: f64 = 1e3;

/// A knob. Its amount 0 is the garment as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Knob {
    pub(super) name: String,
    /// Alterations that are carried out together, each with the amounts of both ends of the range.
    pub(super) parts: Vec<[AlterationFile; 2]>,
    /// Least and largest amount, mm.
    pub(super) range: [f64; 2],
    pub(super) origin: Origin,
}

/// Where a knob comes from.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Origin {
    /// The file of wants.
    Given,
    /// Seams that pass a girth. At other girths the same seams have knobs of their own.
    Seams {
        seams: Vec<String>,
        /// `waist`.
        girth: String,
    },
    /// Pieces that end at an opening.
    Length {
        pieces: Vec<String>,
        /// `hem`, `sleeve`.
        end: &'static str,
    },
}

impl Knob {
    /// A knob of a file of wants.
    pub(super) fn given(knob: &KnobFile) -> Self {
        Self {
            name: knob.name.value.clone(),
            parts: knob.parts.clone(),
            range: knob.range.map(|x| x * MM),
            origin: Origin::Given,
        }
    }

    /// The amount at which fitting begins: none, or the range's end next to it.
    pub(super) fn start(&self) -> f64 {
        0.0f64.clamp(self.range[0], self.range[1])
    }

    /// Its alterations at an amount.
    fn at(&self, amount: f64) -> Vec<AlterationFile> {
        let [from, to] = self.range;
        let share = if to > from { (amount - from) / (to - from) } else { 0.0 };
        self.parts.iter().map(|ends| between(ends, share)).collect()
    }

    /// Whether the same seams may have further stations.
    fn joins(&self) -> bool {
        matches!(self.origin, Origin::Seams { .. })
    }
}

/// The alterations of knobs that are set to these amounts, mm. Stations of one seam are one alteration, in which those
/// that stay are named as well: they hold the seam between the others.
pub(super) fn alterations(knobs: &[Knob], amounts: &[f64]) -> Vec<AlterationFile> {
    let mut out: Vec<AlterationFile> = Vec::new();
    for (knob, &amount) in knobs.iter().zip(amounts) {
        for part in knob.at(amount) {
            let same = out.iter_mut().filter(|_| knob.joins()).find_map(|other| match (other, &part) {
                (AlterationFile::Take { seam, at, out }, AlterationFile::Take { seam: own, .. })
                    if seam == own && !*out =>
                {
                    Some(at)
                }
                _ => None,
            });
            match (same, part) {
                (Some(stations), AlterationFile::Take { at, .. }) => stations.extend(at),
                (_, part) if knob.joins() || amount.abs() >= NONE => out.push(part),
                _ => {}
            }
        }
    }
    out.into_iter().filter_map(written).collect()
}

/// An alteration as it is written: without one that changes nothing, and with amounts above zero where all are below.
fn written(alteration: AlterationFile) -> Option<AlterationFile> {
    match alteration {
        AlterationFile::Take { seam, mut at, out } => {
            at.sort_by(|a, b| a.0.value.number.total_cmp(&b.0.value.number));
            let largest = at.iter().map(|s| s.1.value.number).fold(f64::MIN, f64::max);
            let least = at.iter().map(|s| s.1.value.number).fold(f64::MAX, f64::min);
            if largest == 0.0 && least == 0.0 {
                return None;
            }
            let turned = largest <= 0.0;
            if turned {
                at.iter_mut().for_each(|s| s.1.value.number = positive(-s.1.value.number));
            }
            Some(AlterationFile::Take { seam, at, out: out != turned })
        }
        AlterationFile::Lengthen { by, .. } if by.value.number == 0.0 => None,
        AlterationFile::Lengthen { pieces, at, mut by, over, across, shorter } => {
            let turned = by.value.number < 0.0;
            by.value.number = by.value.number.abs();
            Some(AlterationFile::Lengthen { pieces, at, by, over, across, shorter: shorter != turned })
        }
        AlterationFile::Spread { by, .. } | AlterationFile::Fullness { by, .. } if by.value.number == 0.0 => None,
        other => Some(other),
    }
}

/// The alteration between two that differ in their amounts only.
fn between([from, to]: &[AlterationFile; 2], share: f64) -> AlterationFile {
    use AlterationFile::{Fullness, Lengthen, Move, Pivot, Spread, Take};
    let mut out = from.clone();
    match (&mut out, to) {
        (Take { at, .. }, Take { at: to, .. }) => {
            at.iter_mut().zip(to).for_each(|(a, b)| mix(&mut a.1.value, b.1.value, share));
        }
        (Lengthen { at, by, over, .. }, Lengthen { at: at2, by: by2, over: over2, .. }) => {
            mix(&mut at.value, at2.value, share);
            mix(&mut by.value, by2.value, share);
            if let (Some(a), Some(b)) = (over, over2) {
                mix(&mut a.value, b.value, share);
            }
        }
        (Pivot { share: Some(a), .. }, Pivot { share: Some(b), .. }) => mix(&mut a.value, b.value, share),
        (Spread { by, to_by, .. }, Spread { by: by2, to_by: to_by2, .. })
        | (Fullness { by, to_by, .. }, Fullness { by: by2, to_by: to_by2, .. }) => {
            mix(&mut by.value, by2.value, share);
            if let (Some(a), Some(b)) = (to_by, to_by2) {
                mix(&mut a.value, b.value, share);
            }
        }
        (Move { at, .. }, Move { at: to, .. }) => {
            for (a, b) in at.iter_mut().zip(to) {
                a.1.value = [0, 1].map(|k| rounded(a.1.value[k] + share * (b.1.value[k] - a.1.value[k])));
            }
        }
        _ => {}
    }
    out
}

/// Both amounts have one unit, for a range is written with one.
fn mix(from: &mut Quantity, to: Quantity, share: f64) {
    from.number = rounded(from.number + share * (to.number - from.number));
}

/// To a micrometre.
pub(super) fn rounded(x: f64) -> f64 {
    positive((x * DIGITS).round() / DIGITS)
}

/// Both zeros are one number.
fn positive(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x }
}

/// Millimetres as a quantity of a file in `unit`.
pub(super) fn length(mm: f64, unit: Unit) -> Located<Quantity> {
    let own = (unit != Unit::Millimetre).then_some(Unit::Millimetre);
    here(Quantity { number: mm, unit: own })
}

pub(super) fn here<T>(value: T) -> Located<T> {
    Located::new(value, Spot::default())
}

/// A seam taken in by `mm` at a share of its length.
pub(super) fn taken(seam: &str, share: f64, mm: f64, unit: Unit) -> AlterationFile {
    let percent = (1e3 * share).round() / 10.0;
    let station: StationFile<Quantity> =
        (here(Quantity { number: percent, unit: Some(Unit::Percent) }), length(mm, unit));
    AlterationFile::Take { seam: here(seam.to_owned()), at: vec![station], out: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(girth: &str, share: f64) -> Knob {
        let parts = vec![[-30.0, 30.0].map(|mm| taken("side", share, mm, Unit::Millimetre))];
        let origin = Origin::Seams { seams: vec!["side".into()], girth: girth.into() };
        Knob { name: girth.into(), parts, range: [-30.0, 30.0], origin }
    }

    fn amounts(of: &AlterationFile) -> (bool, Vec<[f64; 2]>) {
        let AlterationFile::Take { at, out, .. } = of else { panic!("{of:?}") };
        (*out, at.iter().map(|s| [s.0.value.number, s.1.value.number]).collect())
    }

    #[test]
    fn stations_of_one_seam_are_one_alteration() {
        let knobs = [side("hip", 0.6), side("waist", 0.2)];
        let both = alterations(&knobs, &[8.0, -3.0]);
        assert_eq!(both.len(), 1);
        assert_eq!(amounts(&both[0]), (false, vec![[20.0, -3.0], [60.0, 8.0]]));
        // The one that stays holds the seam.
        let out = alterations(&knobs, &[-8.0, 0.0]);
        assert_eq!(amounts(&out[0]), (true, vec![[20.0, 0.0], [60.0, 8.0]]));
        assert_eq!(alterations(&knobs, &[0.0, 0.0]), []);
    }

    #[test]
    fn lengths_turn_into_shorter_ones() {
        let ends = [-40.0, 80.0].map(|mm| AlterationFile::Lengthen {
            pieces: vec![here("front".into())],
            at: length(300.0, Unit::Inch),
            by: length(mm, Unit::Inch),
            over: None,
            across: None,
            shorter: false,
        });
        let knob = Knob { name: "hem".into(), parts: vec![ends], range: [-40.0, 80.0], origin: Origin::Given };
        let knobs = [knob];
        assert_eq!(alterations(&knobs, &[0.01]), []);
        for (amount, turned) in [(-20.0, true), (20.0, false)] {
            let [AlterationFile::Lengthen { by, shorter, .. }] = &alterations(&knobs, &[amount])[..] else { panic!() };
            assert_eq!((by.value.number, by.value.unit, *shorter), (20.0, Some(Unit::Millimetre), turned));
        }
    }
}
