//! Load–extension curves (F4) and how they come from Kawabata numbers or a file.

use std::ops::RangeInclusive;

use super::columns::{self, Columns};
use super::error::FabricError;
use super::units::GF_PER_CM;

/// Load per width against strain of a woven direction, piecewise linear (F4).
#[derive(Clone, Debug, PartialEq)]
pub struct TensileCurve {
    /// (strain, N/m), rising, first (0, 0). The last slope goes on beyond the last point.
    pub points: Vec<(f64, f64)>,
}

/// Loads at which a Kawabata curve is sampled, gf/cm. Closer at the start, where the curve bends most.
const KNOTS: [f64; 6] = [5.0, 20.0, 50.0, 100.0, 200.0, 500.0];
/// The load at which EMT is read, gf/cm.
const FULL_LOAD: f64 = 500.0;
/// Load of the FAST extension test at which cloth can still be worked, gf/cm.
const WORKED_LOAD: f64 = 100.0;
/// Share of that load at which it counts as reached. A tester reverses a few gf/cm early or late.
const REACHED: f64 = 0.98;
/// Largest strain of a curve: that of the stretchiest cloth. Larger ones are slips of the pen or in wrong units.
const LONGEST: f64 = 10.0;
/// Range of the slope between two rows of a curve, N/m: from a web that a breath stretches to a steel sheet of some
/// millimetres.
const STIFFNESS: RangeInclusive<f64> = 1e-3..=1e9;

impl TensileCurve {
    /// The curve F = 500 gf/cm · (ε/EMT)^(2/LT − 1) of an extension `emt` (a fraction) at 500 gf/cm and a linearity
    /// `lt` between 0 and 2: LT = 1 is a straight line, less is slack at first and then stiff.
    pub fn kawabata(emt: f64, lt: f64) -> Self {
        let power = 2.0 / lt - 1.0;
        let knot = |load: f64| (emt * (load / FULL_LOAD).powf(1.0 / power), load * GF_PER_CM);
        Self { points: std::iter::once((0.0, 0.0)).chain(KNOTS.map(knot)).collect() }
    }

    /// The last load in gf/cm, if the test ended well before the 500 gf/cm of a Kawabata sheet.
    pub fn ends_early(&self) -> Option<f64> {
        let last = self.points.last().map_or(0.0, |p| p.1) / GF_PER_CM;
        (last < REACHED * FULL_LOAD).then_some(last)
    }

    /// Both ends of the segment that holds `strain`, or the last segment beyond the curve.
    fn segment(&self, strain: f64) -> [(f64, f64); 2] {
        let last = self.points.len() - 1;
        let i = self.points[1..last].partition_point(|p| p.0 <= strain);
        [self.points[i], self.points[i + 1]]
    }

    /// Load at a strain, N/m. Zero in compression, where cloth buckles instead.
    pub fn load(&self, strain: f64) -> f64 {
        if strain <= 0.0 {
            return 0.0;
        }
        let [a, b] = self.segment(strain);
        a.1 + (strain - a.0) * (b.1 - a.1) / (b.0 - a.0)
    }

    /// Strain under a load of zero or more, N/m.
    pub fn strain(&self, load: f64) -> f64 {
        let last = self.points.len() - 1;
        let i = self.points[1..last].partition_point(|p| p.1 <= load);
        let (a, b) = (self.points[i], self.points[i + 1]);
        a.0 + (load - a.1) * (b.0 - a.0) / (b.1 - a.1)
    }

    /// The extension at which cloth can still be worked, by FAST: under 100 gf/cm (E100), as a fraction.
    pub fn workable(&self) -> f64 {
        self.strain(WORKED_LOAD * GF_PER_CM)
    }

    /// The extension under a Kawabata tester's full load, 500 gf/cm: EMT, as a fraction.
    pub fn emt(&self) -> f64 {
        self.strain(FULL_LOAD * GF_PER_CM)
    }

    /// Slope of the load at a strain, N/m. At a corner that of the segment beyond, zero in compression.
    pub fn slope(&self, strain: f64) -> f64 {
        if strain < 0.0 {
            return 0.0;
        }
        let [a, b] = self.segment(strain);
        (b.1 - a.1) / (b.0 - a.0)
    }

    /// Energy per area at a strain, J/m²: the load's integral from 0.
    pub fn energy(&self, strain: f64) -> f64 {
        if strain <= 0.0 {
            return 0.0;
        }
        let mut sum = 0.0;
        let last = self.points.len() - 2;
        for (i, pair) in self.points.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]];
            if strain <= a.0 {
                break;
            }
            let end = if i == last { strain } else { strain.min(b.0) };
            sum += 0.5 * (end - a.0) * (a.1 + self.load(end));
        }
        sum
    }

    /// This curve with every load multiplied by `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { points: self.points.iter().map(|p| (p.0, factor * p.1)).collect() }
    }

    /// Reads a table of two columns, strain and load. A first line with words is a header and may say the units
    /// (`strain %` or `strain fraction`, `load gf/cm` or `load N/m`). Without one they are % and gf/cm. Lines that are
    /// empty or begin with `#` are skipped. A first point (0, 0) is added where it is missing.
    ///
    /// # Errors
    /// [`FabricError::Curve`] with the row where a number cannot be read, the curve does not rise, or it is that of no
    /// cloth.
    pub fn parse(text: &str, file: &str) -> Result<Self, FabricError> {
        let fault = |row: usize, why: String| FabricError::Curve { file: file.to_owned(), row, why };
        let mut scale = (0.01, GF_PER_CM);
        let mut lines = columns::rows(text).peekable();
        let Some(&(row, first)) = lines.peek() else { return Self::rising(&[], scale, file) };
        let columns = Columns::new(first);
        let fields = |row: usize, line| pair(&columns, line).map_err(|why| fault(row, why));
        let [strain, load] = fields(row, first)?;
        if strain.contains(|c: char| c.is_alphabetic() || c == '%') && strain.parse::<f64>().is_err() {
            scale = units(strain, load).map_err(|why| fault(row, why))?;
            lines.next();
        }
        let mut rows = Vec::new();
        for (row, line) in lines {
            let number = |text| columns::finite(text).map_err(|why| fault(row, why));
            let [strain, load] = fields(row, line)?;
            rows.push((row, number(strain)?, number(load)?));
        }
        Self::rising(&rows, scale, file)
    }

    /// Of rows (line of the `file`, strain, load), as [`TensileCurve::parse`]. `scale` makes their numbers a fraction
    /// and N/m.
    pub(super) fn rising(rows: &[(usize, f64, f64)], scale: (f64, f64), file: &str) -> Result<Self, FabricError> {
        let fault = |row: usize, why: String| FabricError::Curve { file: file.to_owned(), row, why };
        let mut points = vec![(0.0, 0.0)];
        for &(row, strain, load) in rows {
            if (strain, load) == (0.0, 0.0) && points.len() == 1 {
                continue;
            }
            let (before, next) = (points[points.len() - 1], (strain * scale.0, load * scale.1));
            if next.0 <= before.0 {
                let why = match short(before.0 / scale.0) {
                    from if strain == 0.0 && points.len() == 1 => {
                        format!("a load of {load} at {from}; take it off all")
                    }
                    from => format!("strain goes from {from} to {strain}; it must rise"),
                };
                return Err(fault(row, why));
            }
            if next.1 <= before.1 {
                let from = short(before.1 / scale.1);
                return Err(fault(row, format!("load falls from {from} to {load}; curves must rise")));
            }
            let stiffness = (next.1 - before.1) / (next.0 - before.0);
            if next.0 > LONGEST || !STIFFNESS.contains(&stiffness) {
                let [low, high] = [STIFFNESS.start(), STIFFNESS.end()];
                return Err(fault(
                    row,
                    format!(
                        "a strain of {:e} and {stiffness:e} N/m from the row before; cloth has up to {LONGEST}, and \
                         from {low:e} to {high:e} N/m: are the units % and gf/cm, or does a header say others?",
                        next.0
                    ),
                ));
            }
            points.push(next);
        }
        if points.len() < 2 {
            return Err(fault(1, "no rows of strain and load".to_owned()));
        }
        Ok(Self { points })
    }
}

/// A number of the file again, without the dust of the conversion to SI and back.
fn short(x: f64) -> f64 {
    (x * 1e6).round() / 1e6
}

/// The two fields of a row.
fn pair<'a>(columns: &Columns, line: &'a str) -> Result<[&'a str; 2], String> {
    let fields = columns.cut(line)?;
    let said = fields.iter().rposition(|field| !field.is_empty()).map_or(0, |last| last + 1);
    match fields[..said] {
        [strain, load] => Ok([strain, load]),
        _ => Err(format!("{said} columns, where strain and load are expected")),
    }
}

/// Units in a header of both columns, as factors to a fraction and to N/m.
fn units(strain: &str, load: &str) -> Result<(f64, f64), String> {
    let strain = match strain {
        s if s.contains('%') => 0.01,
        s if s.contains("fraction") => 1.0,
        s => return Err(format!("unknown unit in '{}'; use strain % or strain fraction", s.trim())),
    };
    let load = match load {
        l if l.contains("gf/cm") => GF_PER_CM,
        l if l.contains("N/m") => 1.0,
        l => return Err(format!("unknown unit in '{}'; use load gf/cm or load N/m", l.trim())),
    };
    Ok((strain, load))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_kawabata_curve_matches_the_worsted_table() {
        let curve = TensileCurve::kawabata(0.047, 0.55);
        // Strain in percent at 5, 20, 50, 100, 200, 500 gf/cm of a worsted warp.
        for ((strain, load), (percent, gf)) in curve.points[1..].iter().zip([
            (0.819, 5.0),
            (1.386, 20.0),
            (1.962, 50.0),
            (2.553, 100.0),
            (3.320, 200.0),
            (4.70, 500.0),
        ]) {
            assert_relative_eq!(strain * 100.0, percent, epsilon = 6e-4);
            assert_relative_eq!(*load, gf * GF_PER_CM, max_relative = 1e-12);
        }
    }

    #[test]
    fn load_is_the_slope_of_energy_and_slope_the_slope_of_load() {
        let curve = TensileCurve::kawabata(0.05, 0.6);
        let h = 1e-7;
        for strain in [-0.01, 0.001, 0.013, 0.03, 0.049, 0.08, 0.3] {
            let difference = (curve.energy(strain + h) - curve.energy(strain - h)) / (2.0 * h);
            assert_relative_eq!(difference, curve.load(strain), max_relative = 1e-5, epsilon = 1e-5);
            let difference = (curve.load(strain + h) - curve.load(strain - h)) / (2.0 * h);
            assert_relative_eq!(difference, curve.slope(strain), max_relative = 1e-5);
        }
    }

    #[test]
    fn the_last_slope_goes_on() {
        let curve = TensileCurve { points: vec![(0.0, 0.0), (0.1, 10.0), (0.2, 40.0)] };
        assert_relative_eq!(curve.load(0.3), 70.0);
        assert_relative_eq!(curve.energy(0.3), 0.5 + 2.5 + 5.5);
        assert_relative_eq!(curve.slope(0.1), 300.0);
    }

    #[test]
    fn a_file_is_read_in_its_units() {
        let curve = TensileCurve::parse("strain %, load N/m\n0, 0\n1, 20\n2, 60\n", "a.csv").expect("curve");
        assert_eq!(curve.points, [(0.0, 0.0), (0.01, 20.0), (0.02, 60.0)]);
        let plain = TensileCurve::parse("1,100\n2,200", "a.csv").expect("curve");
        assert_relative_eq!(plain.points[2].1, 196.133, max_relative = 1e-9);
        // As spreadsheets write it.
        let sheet = "\"strain %\";\"load N/m\";\n1;20;\n2;60;\n;;\n";
        assert_eq!(TensileCurve::parse(sheet, "a.csv").expect("curve"), curve);
    }

    #[test]
    fn a_falling_curve_is_refused_with_its_row() {
        let said = |text: &str| TensileCurve::parse(text, "kes/warp.csv").expect_err(text).to_string();
        assert_eq!(
            said("strain %, load gf/cm\n1, 100\n2, 92"),
            "tensile curve kes/warp.csv, row 3: load falls from 100 to 92; curves must rise"
        );
        assert!(said("1, 100\n1, 120").contains("strain"));
        assert!(said("1, nan").contains("row 1: 'nan' is no finite number"));
        assert!(said("1").contains("columns"));
        assert!(said("0,5;100\n1;200").contains("'0,5' is no number; write a decimal point"));
        assert!(said("").contains("no rows"));
        assert!(said("strain, load\n1, 2").contains("unknown unit"));
        assert!(said("0, 2\n1, 3").contains("row 1: a load of 2 at 0; take it off all"));
    }

    #[test]
    fn a_curve_of_no_cloth_is_refused() {
        for text in [
            "strain fraction, load N/m\n1e-300,1e300\n2e-300,1.7e308",
            "strain %, load N/m\n1e-9,1",
            "strain %, load gf/cm\n1e6,1e-9",
        ] {
            let said = TensileCurve::parse(text, "a.csv").expect_err(text).to_string();
            assert!(said.contains("row 2: a strain of") && said.contains("are the units"), "{said}");
        }
    }
}
