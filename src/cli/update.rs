//! `test --update`: what was measured, with a margin, in the place of the bounds a garment file states.

use crate::pattern::{GarmentFile, Located, Quantity, Spot, TestFile, Unit};
use crate::report::Verdict;

/// Bounds are so many times what was measured: room for the next machine, not for the next mistake.
const MARGIN: f64 = 1.25;
/// No bound is tighter than this, in mm or %: rounding alone would break it.
const TIGHTEST: f64 = 0.01;

/// `text` with new numbers in the tests of `file`, which was read from it. `measured` has one list per test that is
/// measured (all but `openings`), in the order of the file; a test without verdicts stays. Counts stay as well,
/// since nobody wants more crossings for an update, and so does the fit that the maker wants.
pub(super) fn updated(text: &str, file: &GarmentFile, measured: &[Vec<Verdict>]) -> String {
    let tests = file.tests.iter().map(|t| &t.value.test).filter(|t| !matches!(t, TestFile::Openings(_)));
    let mut changes: Vec<(Spot, String)> = tests
        .zip(measured)
        .flat_map(|(test, verdicts)| quantities(test).into_iter().zip(verdicts))
        .map(|(written, verdict)| (written.at, bound(written.value, verdict, file.unit())))
        .collect();
    changes.sort_by_key(|c| std::cmp::Reverse((c.0.line, c.0.column)));
    let mut lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
    for (at, new) in changes {
        let Some(line) = at.line.checked_sub(1).and_then(|i| lines.get_mut(i)) else { continue };
        let before: String = line.chars().take(at.column.saturating_sub(1)).collect();
        let after: String = line.chars().skip(at.column.saturating_sub(1) + at.width).collect();
        *line = before + &new + &after;
    }
    lines.concat()
}

/// The figures of a test, in the order of its verdicts.
fn quantities(test: &TestFile) -> Vec<&Located<Quantity>> {
    match test {
        TestFile::Seam(_, limit) | TestFile::Gap(_, limit) | TestFile::Closure(_, limit) => vec![limit],
        TestFile::Flatten(_, area, boundary) | TestFile::Drape(_, area, boundary) => {
            area.iter().chain(boundary).collect()
        }
        // Counts, and how the maker wants the garment to fit.
        TestFile::Crossings(_)
        | TestFile::Openings(_)
        | TestFile::Worn
        | TestFile::Ease(..)
        | TestFile::Pressure(..)
        | TestFile::HemLevel(_) => Vec::new(),
    }
}

/// The new bound, in the unit of the old one.
fn bound(old: Quantity, verdict: &Verdict, bare: Unit) -> String {
    let wanted = (MARGIN * verdict.measured).max(TIGHTEST);
    let unit = match (old.unit, verdict.unit) {
        // A bare share is a fraction.
        (None, "%") => 1.0 / Unit::Percent.factor(),
        (Some(Unit::Percent), _) => 1.0,
        (unit, _) => 1e3 * unit.unwrap_or(bare).factor(),
    };
    let number = rounded_up(wanted / unit);
    old.unit.map_or_else(|| number.clone(), |u| format!("{number} {}", u.symbol()))
}

/// Two significant digits, never less than the number.
fn rounded_up(x: f64) -> String {
    let decimals = (1 - x.log10().floor() as i32).max(0);
    let scale = 10f64.powi(decimals);
    // What is a round number but for the last bit stays one.
    let up = (x * scale * (1.0 - 1e-12)).ceil() / scale;
    format!("{up}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::garment::read_file_only;

    fn verdict(measured: f64, unit: &'static str) -> Verdict {
        Verdict { bound: String::new(), measured, limit: 0.0, unit, at: None, ok: true }
    }

    #[test]
    fn numbers_change_and_the_rest_of_the_file_stays() {
        let text = "garment: 1   # a remark\npieces: {}\ntests:\n  - {gap: all, below: 1 mm}  # tight\n  \
                    - {openings: 2}\n  \
                    - {drape: all, area: 0.005, boundary: 1 %}\n  - {flatten: all, boundary: 0.2 cm}\n  \
                    - {crossings: 0}\n";
        let file = read_file_only("test.yaml", text).expect("a file");
        let measured = [
            vec![verdict(0.4, "mm")],
            vec![verdict(0.08, "%"), verdict(2.0, "%")],
            vec![verdict(0.123, "mm")],
            vec![verdict(3.0, "")],
        ];
        let expected = text
            .replace("below: 1 mm", "below: 0.5 mm")
            .replace("area: 0.005, boundary: 1 %", "area: 0.001, boundary: 2.5 %")
            .replace("0.2 cm", "0.016 cm");
        assert_eq!(updated(text, &file, &measured), expected);
        assert_eq!(updated(text, &file, &[]), text);
    }

    #[test]
    fn bounds_are_rounded_up_to_two_digits_and_never_nothing() {
        assert_eq!(rounded_up(0.5), "0.5");
        assert_eq!(rounded_up(0.1234), "0.13");
        assert_eq!(rounded_up(123.4), "124");
        let none = Quantity { number: 1.0, unit: Some(Unit::Millimetre) };
        assert_eq!(bound(none, &verdict(0.0, "mm"), Unit::Millimetre), "0.01 mm");
    }
}
