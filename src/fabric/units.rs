//! Numbers with units, as textile laboratories write them.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// N/m in one gf/cm.
pub(super) const GF_PER_CM: f64 = 0.980_665;
/// N·m in one gf·cm²/cm.
const GF_CM2_PER_CM: f64 = 98.0665e-6;
/// One ounce per square yard in kg/m².
const OZ_PER_YD2: f64 = 0.033_905_75;

/// A kind of quantity: its units, and the SI value of each.
pub(super) struct QuantityKind {
    units: &'static [(&'static str, f64)],
    /// Range of plausible values, SI: from a spider's web to a carpet. Values outside are slips of the pen or in wrong
    /// units.
    pub(super) range: RangeInclusive<f64>,
    /// Name of the SI unit.
    pub(super) si: &'static str,
}

/// Mass per area, kg/m².
pub(super) const WEIGHT: QuantityKind = QuantityKind {
    units: &[("g/m2", 1e-3), ("kg/m2", 1.0), ("mg/cm2", 1e-2), ("oz/yd2", OZ_PER_YD2)],
    range: 1e-3..=10.0,
    si: "kg/m2",
};
/// Length, m.
pub(super) const LENGTH: QuantityKind =
    QuantityKind { units: &[("mm", 1e-3), ("cm", 1e-2), ("um", 1e-6), ("m", 1.0)], range: 1e-6..=0.03, si: "m" };
/// Bending rigidity, N·m.
pub(super) const BEND: QuantityKind = QuantityKind {
    units: &[("gf.cm2/cm", GF_CM2_PER_CM), ("uN.m", 1e-6), ("mN.mm", 1e-6), ("N.m", 1.0)],
    range: 1e-9..=0.1,
    si: "N.m",
};
/// Shear stiffness, N/m per radian.
pub(super) const SHEAR: QuantityKind = QuantityKind {
    units: &[("gf/cm.deg", GF_PER_CM * 180.0 / PI), ("N/m.deg", 180.0 / PI), ("N/m.rad", 1.0), ("N/m", 1.0)],
    range: 1e-3..=1e5,
    si: "N/m",
};
/// A part of one.
pub(super) const STRAIN: QuantityKind = QuantityKind { units: &[("%", 0.01)], range: 1e-4..=10.0, si: "of the length" };

impl QuantityKind {
    /// `a number in g/m2, kg/m2 or oz/yd2`.
    pub(super) fn expected(&self) -> String {
        let names: Vec<&str> = self.units.iter().map(|u| u.0).collect();
        match names[..] {
            [ref first @ .., last] if !first.is_empty() => format!("a number in {} or {last}", first.join(", ")),
            _ => format!("a number in {}", names.join("")),
        }
    }

    /// The SI value of a number with one of the units. `None` when it is not that.
    pub(super) fn parse(&self, text: &str) -> Option<f64> {
        let text = plain(text);
        let (unit, factor) = self.units.iter().find(|(unit, _)| {
            // A unit ends the text and follows the number directly, so `mm` is not taken for `m`.
            text.strip_suffix(unit).is_some_and(|number| number.parse::<f64>().is_ok())
        })?;
        text.strip_suffix(unit)?.parse::<f64>().ok().map(|v| v * factor)
    }
}

/// One spelling of a unit: `gf·cm²/cm`, `gf*cm^2/cm` and `gf.cm2/cm` are the same,
/// as are `gf/(cm deg)` and `gf/cm.deg`.
pub(super) fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut chars = text.trim().chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '·' | '*' | '⋅' => out.push('.'),
            '²' => out.push('2'),
            'µ' | 'μ' => out.push('u'),
            '^' | '(' | ')' => {}
            // A space between two units multiplies them. One after the number means nothing. Between two numbers it
            // stays, and makes them none.
            c if c.is_whitespace() => match (out.chars().last(), chars.peek()) {
                (Some(a), Some(b)) if a.is_alphabetic() && b.is_alphabetic() => out.push('.'),
                (Some(a), Some(b)) if a.is_ascii_digit() && b.is_ascii_digit() => out.push(' '),
                _ => {}
            },
            '°' => out.push_str("deg"),
            c => out.push(c),
        }
    }
    out.replace("degrees", "deg").replace("degree", "deg")
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn two_numbers_are_none() {
        assert_eq!(WEIGHT.parse("1 50 g/m2"), None);
        assert_eq!(WEIGHT.parse("150  g / m²"), WEIGHT.parse("150g/m2"));
    }

    #[test]
    fn laboratory_units_become_si() {
        for (quantity, text, si) in [
            (&WEIGHT, "70 g/m2", 0.07),
            (&WEIGHT, "70 g/m²", 0.07),
            (&WEIGHT, "1 oz/yd2", 0.0339057),
            (&BEND, "0.03 gf.cm2/cm", 2.941995e-6),
            (&BEND, "0.03 gf·cm²/cm", 2.941995e-6),
            (&BEND, "13.8 µN·m", 13.8e-6),
            (&BEND, "2e-6 N.m", 2e-6),
            (&SHEAR, "0.4 gf/cm.deg", 22.475),
            (&SHEAR, "0.4 gf/(cm deg)", 22.475),
            (&SHEAR, "0.4 gf/cm·degree", 22.475),
            (&SHEAR, "0.4 gf/(cm·°)", 22.475),
            (&SHEAR, "30 N/m", 30.0),
            (&LENGTH, "0.25 mm", 0.25e-3),
            (&LENGTH, "250um", 0.25e-3),
            (&STRAIN, "5 %", 0.05),
        ] {
            assert_relative_eq!(quantity.parse(text).expect(text), si, max_relative = 2e-5);
        }
    }

    #[test]
    fn other_texts_are_refused() {
        assert_eq!(WEIGHT.parse("70"), None);
        assert_eq!(WEIGHT.parse("70 N/m"), None);
        assert_eq!(BEND.parse("stiff"), None);
        assert_eq!(LENGTH.parse("mm"), None);
        assert_eq!(WEIGHT.expected(), "a number in g/m2, kg/m2, mg/cm2 or oz/yd2");
        assert_eq!(STRAIN.expected(), "a number in %");
    }
}
