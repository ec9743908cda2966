//! A recorded test of the KES instruments: a curve up, and perhaps down again, and the values read from it.

use std::ops::Range;

use super::MeasureError;
use crate::fabric::TensileCurve;
use crate::fabric::columns::{self, Columns};
use crate::fabric::units::GF_PER_CM;

/// Test of a curve, with the units of its two columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CurveKind {
    /// Strain %, load gf/cm (KES-FB1).
    Tensile,
    /// Shear angle in degrees, load gf/cm (KES-FB1).
    Shear,
    /// Curvature 1/cm, moment gf·cm/cm (KES-FB2).
    Bending,
}

impl CurveKind {
    fn units(self) -> [&'static str; 2] {
        match self {
            Self::Tensile => ["%", "gf/cm"],
            Self::Shear => ["deg", "gf/cm"],
            Self::Bending => ["1/cm", "gf.cm/cm"],
        }
    }
}

/// Share of the rise by which noise may bring a returning curve above the rising one.
const NOISE: f64 = 0.1;

/// Slope and hystereses of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CycleLoop {
    /// Slope of the middle line between both places.
    pub(super) slope: f64,
    /// Width of the loop at both places, if the curve comes down again.
    pub(super) widths: Option<[f64; 2]>,
}

/// A recorded curve.
#[derive(Clone, Debug)]
pub(super) struct Cycle {
    file: String,
    rows: Vec<(f64, f64)>,
    /// Lines of the file that the rows stand in.
    lines: Vec<usize>,
}

impl Cycle {
    /// Reads two columns. A first line with words is a header and must name the units of `kind`.
    pub(super) fn parse(text: &str, file: &str, kind: CurveKind) -> Result<Self, MeasureError> {
        let fault = |row: usize, why: String| MeasureError::File { file: file.to_owned(), row: Some(row), why };
        let [across, up] = kind.units();
        let (mut rows, mut lines) = (Vec::new(), Vec::new());
        let columns = Columns::new(columns::rows(text).next().map_or("", |r| r.1));
        for (count, (row, line)) in columns::rows(text).enumerate() {
            let mut fields = columns.cut(line).map_err(|why| fault(row, why))?;
            while fields.len() > 2 && fields.last().is_some_and(|f| f.is_empty()) {
                fields.pop();
            }
            let [x, y] = fields[..] else {
                let why = "columns, where two are expected";
                return Err(fault(row, format!("{} {why} ({across}, {up}); write decimal points", fields.len())));
            };
            match (x.parse::<f64>(), y.parse::<f64>()) {
                (Ok(x), Ok(y)) if x.is_finite() && y.is_finite() => {
                    rows.push((x, y));
                    lines.push(row);
                }
                _ if count == 0 && x.contains(across) && y.contains(up) => {}
                _ if count == 0 => return Err(fault(row, format!("a header must name the units, {across} and {up}"))),
                _ => return Err(fault(row, format!("'{}' is no pair of numbers", line.trim()))),
            }
        }
        if rows.len() < 3 {
            return Err(fault(1, format!("{} rows are no curve", rows.len())));
        }
        Ok(Self { file: file.to_owned(), rows, lines })
    }

    fn fault(&self, why: String) -> MeasureError {
        MeasureError::File { file: self.file.clone(), row: None, why }
    }

    /// The branch that rises to the largest x, and the one that comes down from there to 0 (may be one point only).
    fn branches(rows: &[(f64, f64)]) -> [Range<usize>; 2] {
        let top = (0..rows.len()).max_by(|a, b| rows[*a].0.total_cmp(&rows[*b].0).then(b.cmp(a))).unwrap_or(0);
        let down = rows[top..].iter().take_while(|r| r.0 >= 0.0).count();
        let up = rows[..=top].iter().rev().take_while(|r| r.0 >= 0.0).count();
        [top + 1 - up..top + 1, top..top + down]
    }

    /// Slope between the places `from` and `to`, and the loop's width at `at`: the mean of both halves of a cycle that
    /// goes to both sides.
    pub(super) fn read(&self, [from, to]: [f64; 2], at: [f64; 2]) -> Result<CycleLoop, MeasureError> {
        let mirrored: Vec<(f64, f64)> = self.rows.iter().map(|r| (-r.0, -r.1)).collect();
        let halves = [&self.rows, &mirrored].map(|rows| half(rows, [from, to], at));
        let found: Vec<CycleLoop> = halves.into_iter().flatten().collect();
        let [first, ..] = found[..] else {
            return Err(self.fault(format!("the curve must rise past {to} from {from} or less")));
        };
        let second = found.last().copied().unwrap_or(first);
        let widths = match (first.widths, second.widths) {
            (Some(a), Some(b)) => Some([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]),
            (a, b) => a.or(b),
        };
        let slope = 0.5 * (first.slope + second.slope);
        if slope <= 0.0 {
            return Err(self.fault(format!("it does not rise: a slope of {slope:.4}")));
        }
        let over = widths.iter().flatten().zip(at).find(|(width, x)| **width < -NOISE * slope * x);
        match over {
            Some((width, _)) => Err(self.fault(format!(
                "it comes down above where it went up, by {:.4}; are the rows in the order of the test?",
                -width
            ))),
            None => Ok(CycleLoop { slope, widths: widths.map(|widths| widths.map(|w| w.max(0.0))) }),
        }
    }

    /// The rising branch as a load–extension curve, and the resilience RT (work given back over work done) if the curve
    /// comes down again.
    pub(super) fn tensile(&self) -> Result<(TensileCurve, Option<f64>), MeasureError> {
        let branches = Self::branches(&self.rows);
        let lines = &self.lines[branches[0].clone()];
        let [up, down] = branches.map(|branch| &self.rows[branch]);
        let rows: Vec<_> = lines.iter().zip(up).map(|(line, (x, y))| (*line, *x, *y)).collect();
        let curve = TensileCurve::rising(&rows, (0.01, GF_PER_CM), &self.file)?;
        let work =
            |b: &[(f64, f64)]| b.windows(2).map(|w| 0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0).abs()).sum::<f64>();
        let resilience = (down.len() > 2).then(|| work(down) / work(up));
        match resilience {
            Some(share) if share > 1.0 => Err(self.fault(format!(
                "it gives back {:.0} % of the work, more than was done; are the rows in the order of the test?",
                100.0 * share
            ))),
            _ => Ok((curve, resilience)),
        }
    }
}

fn half(rows: &[(f64, f64)], [from, to]: [f64; 2], at: [f64; 2]) -> Option<CycleLoop> {
    let [up, down] = Cycle::branches(rows).map(|branch| &rows[branch]);
    let rising = |x: f64| value_at(up, x);
    let falling = |x: f64| value_at(down, x);
    let middle = |x: f64| Some(falling(x).map_or(rising(x)?, |f| 0.5 * (rising(x).unwrap_or(f) + f)));
    let whole = down.len() > 2 && falling(from).is_some() && falling(to).is_some();
    let line = |x: f64| if whole { middle(x) } else { rising(x) };
    let slope = (line(to)? - line(from)?) / (to - from);
    let width = |x: f64| Some(rising(x)? - falling(x)?);
    let widths = if whole { Some([width(at[0])?, width(at[1])?]) } else { None };
    Some(CycleLoop { slope, widths })
}

/// A branch at x, between its points only.
fn value_at(branch: &[(f64, f64)], x: f64) -> Option<f64> {
    branch.windows(2).find_map(|w| {
        let (a, b) = if w[0].0 <= w[1].0 { (w[0], w[1]) } else { (w[1], w[0]) };
        let inside = (a.0..=b.0).contains(&x) && b.0 > a.0;
        inside.then(|| a.1 + (x - a.0) * (b.1 - a.1) / (b.0 - a.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Curvatures at which a bending cycle is written.
    const PLACES: [f64; 6] = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5];

    #[test]
    fn rigidity_and_hysteresis_of_a_bending_cycle() {
        // B = 0.118, 2HB = 0.124: up at +HB, down at −HB, then the same to the other side.
        let (b, hb) = (0.118, 0.062);
        let mut text = "curvature 1/cm, moment gf.cm/cm\n".to_owned();
        let mut row = |k: f64, m: f64| text.push_str(&format!("{k},{m}\n"));
        for k in PLACES {
            row(k, b * k + hb);
        }
        for k in PLACES.into_iter().rev() {
            row(k, b * k - hb);
        }
        for k in PLACES {
            row(-k, -b * k - hb);
        }
        for k in PLACES.into_iter().rev() {
            row(-k, -b * k + hb);
        }
        let found =
            Cycle::parse(&text, "b.csv", CurveKind::Bending).expect("curve").read([0.5, 1.5], [1.0; 2]).expect("loop");
        assert_relative_eq!(found.slope, b, epsilon = 1e-12);
        assert_relative_eq!(found.widths.expect("it comes down")[0], 2.0 * hb, epsilon = 1e-12);
    }

    #[test]
    fn a_curve_that_only_rises_has_no_hysteresis() {
        let found =
            Cycle::parse("0,0\n4,2\n8,4", "s.csv", CurveKind::Shear).expect("curve").read([0.5, 5.0], [0.5, 5.0]);
        assert_eq!(found, Ok(CycleLoop { slope: 0.5, widths: None }));
    }

    #[test]
    fn a_tensile_cycle_gives_its_curve_and_resilience() {
        let text = "strain %, load gf/cm\n0,0\n1,100\n2,300\n1.5,100\n1,0\n";
        let (curve, rt) = Cycle::parse(text, "t.csv", CurveKind::Tensile).expect("curve").tensile().expect("curve");
        assert_relative_eq!(curve.load(0.015), 196.133, max_relative = 1e-9);
        assert_relative_eq!(rt.expect("it comes down"), (100.0 + 25.0) / (50.0 + 200.0), epsilon = 1e-12);
    }

    #[test]
    fn a_loop_that_runs_the_wrong_way_is_refused() {
        let bent = Cycle::parse("0,0\n1,1\n2,2\n1,1.5\n0,1", "b.csv", CurveKind::Bending).expect("curve");
        let said = bent.read([0.5, 1.5], [1.0; 2]).expect_err("over itself").to_string();
        assert!(said.contains("comes down above where it went up, by 0.5"), "{said}");
        let pulled = Cycle::parse("0,0\n1,10\n2,50\n1,45\n0,1", "t.csv", CurveKind::Tensile).expect("curve");
        let said = pulled.tensile().expect_err("more work").to_string();
        assert!(said.contains("gives back 201 % of the work"), "{said}");
    }

    #[test]
    fn wrong_rows_are_named() {
        let said = |text: &str| Cycle::parse(text, "b.csv", CurveKind::Bending).expect_err(text).to_string();
        assert_eq!(said("0,0\n1,x\n2,3"), "b.csv, row 2: '1,x' is no pair of numbers");
        assert!(said("curvature, moment\n0,0").contains("must name the units, 1/cm and gf.cm/cm"));
        assert!(said("0,0,0").contains("3 columns"));
        assert!(said("0;0\n0,5;1\n1;2").contains("row 2: '0,5;1' is no pair of numbers"));
        assert!(Cycle::parse("0,0,\n1,1,\n2,2,", "b.csv", CurveKind::Bending).is_ok());
        assert!(said("0,0\n1,1").contains("2 rows are no curve"));
        let short =
            Cycle::parse("0,0\n.5,1\n1,2", "b.csv", CurveKind::Bending).expect("curve").read([0.5, 1.5], [1.0; 2]);
        assert!(short.expect_err("short").to_string().contains("must rise past 1.5"));
    }
}
