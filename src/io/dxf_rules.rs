//! Grade rules of AAMA (`.rul`): how far the points of a pattern move from its sample size to every other size. They
//! lie in a file beside the DXF, whose texts `# 12` name the rule of the point where they stand.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::dxf_error::{DxfError, SHOWN};
use super::dxf_text::after;
use super::encoding::decoded;
use crate::geometry::Vec2;
use crate::input::{LengthUnit, bytes, shown};

/// Larger files are not rules.
const MOST_BYTES: u64 = 30 << 20;
/// Sizes that one table has: more are not a style.
const MOST_SIZES: usize = 200;
/// Metres that no rule moves a point.
const FARTHEST: f64 = 10.0;
/// Endings of the file's name that are looked for.
const ENDINGS: [&str; 3] = ["rul", "RUL", "Rul"];

/// A mistake in a table: its line, from 1, and what is expected there.
#[derive(Debug)]
pub(super) struct RuleMistake {
    pub(super) line: usize,
    pub(super) why: String,
}

/// A table of rules.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RuleTable {
    /// Names of the sizes, in their order.
    pub(super) sizes: Vec<String>,
    /// The size that is drawn.
    pub(super) sample: Option<String>,
    /// By number, the way of a point from the sample size to each size: along the grade reference line and to its left,
    /// metres.
    rules: BTreeMap<u32, Vec<Vec2>>,
}

/// The text of the rules that lie beside a DXF file: under its own name, or under the name of the table in it.
///
/// # Errors
/// A file that is there and cannot be read.
pub(super) fn rules_beside(dxf: &Path, table: Option<&str>) -> Result<Option<(PathBuf, String)>, DxfError> {
    let plain = |name: &&str| !name.is_empty() && !name.contains(['/', '\\']);
    let own = dxf.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let names = own.into_iter().chain(table.filter(plain).map(str::to_owned));
    let mut files = names.flat_map(|name| ENDINGS.map(|ending| dxf.with_file_name(format!("{name}.{ending}"))));
    let Some(file) = files.find(|file| file.is_file()) else { return Ok(None) };
    let text = decoded(&bytes(&file, MOST_BYTES)?).0.into_owned();
    Ok(Some((file, text)))
}

impl RuleTable {
    /// Reads a table. `unit` is metres per unit where the table does not say its own.
    ///
    /// # Errors
    /// [`RuleMistake`].
    pub(super) fn read(text: &str, unit: f64) -> Result<Self, RuleMistake> {
        let lines: Vec<&str> = text.lines().map(|line| line.trim_start_matches('\u{feff}').trim()).collect();
        let value = |key: &str| lines.iter().find_map(|line| after(line, key)).filter(|value| !value.is_empty());
        let unit = match value("units:").map(str::to_ascii_uppercase).as_deref() {
            Some("METRIC" | "MM") => LengthUnit::Millimetre.metres(),
            Some("ENGLISH" | "IMPERIAL" | "INCH" | "INCHES") => LengthUnit::Inch.metres(),
            _ => unit,
        };
        let sizes: Vec<String> = value("size list:").map(names).unwrap_or_default();
        if sizes.is_empty() || sizes.len() > MOST_SIZES {
            let why = format!("it has {} sizes in its SIZE LIST; 1 to {MOST_SIZES} are expected", sizes.len());
            return Err(RuleMistake { line: 1, why });
        }
        let sample = value("sample size:").or_else(|| value("base size:"));
        let sample = sample.and_then(|s| sizes.iter().find(|size| size.eq_ignore_ascii_case(s)).cloned());
        let rules = rules(&lines, sizes.len(), unit)?;
        Ok(Self { sizes, sample, rules })
    }

    /// How a rule moves its point from one size to another, by their numbers; `None` without such a rule.
    pub(super) fn way(&self, rule: u32, from: usize, to: usize) -> Option<Vec2> {
        let ways = self.rules.get(&rule)?;
        Some(ways[to] - ways[from])
    }

    /// The number of a size.
    pub(super) fn number(&self, size: &str) -> Option<usize> {
        self.sizes.iter().position(|own| own.eq_ignore_ascii_case(size))
    }
}

/// Names that commas or spaces part.
fn names(list: &str) -> Vec<String> {
    let parts: Vec<&str> = if list.contains(',') { list.split(',').collect() } else { list.split(' ').collect() };
    parts.into_iter().map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned).collect()
}

/// The rules: `RULE: DELTA 12`, and a pair of numbers for each size on the lines below.
fn rules(lines: &[&str], sizes: usize, unit: f64) -> Result<BTreeMap<u32, Vec<Vec2>>, RuleMistake> {
    let mut all = BTreeMap::new();
    let mut open: Option<(usize, u32, Vec<f64>)> = None;
    for (k, line) in lines.iter().enumerate().chain([(lines.len(), &"END")]) {
        let head = after(line, "rule:");
        let ends = head.is_some() || line.eq_ignore_ascii_case("end");
        if let Some((begin, number, values)) = open.take_if(|_| ends) {
            all.insert(number, pairs(begin, number, &values, sizes)?);
        }
        if let Some(words) = head {
            let number = words.rsplit(' ').next().and_then(|word| word.parse().ok());
            let why = || format!("'{}' has no number; 'RULE: DELTA 1' is expected", shown(line, SHOWN));
            open = Some((k + 1, number.ok_or_else(|| RuleMistake { line: k + 1, why: why() })?, Vec::new()));
        } else if let Some((_, _, values)) = &mut open {
            for word in line.split([',', ' ', '\t']).filter(|word| !word.is_empty()) {
                let number = word.parse::<f64>().ok().map(|x| x * unit).filter(|x| x.abs() <= FARTHEST);
                let why = || format!("'{}' is no way of a point in the table's units", shown(word, SHOWN));
                values.push(number.ok_or_else(|| RuleMistake { line: k + 1, why: why() })?);
            }
        }
    }
    Ok(all)
}

fn pairs(line: usize, number: u32, values: &[f64], sizes: usize) -> Result<Vec<Vec2>, RuleMistake> {
    if values.len() != 2 * sizes {
        let why = format!("rule {number} has {} numbers; two for each of the {sizes} sizes are expected", values.len());
        return Err(RuleMistake { line, why });
    }
    Ok(values.chunks(2).map(|pair| Vec2::new(pair[0], pair[1])).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "ANSI/AAMA VERSION: 1.0.0\nUNITS: ENGLISH\nGRADE RULE TABLE: T\nNUMBER OF SIZES: 3\n\
                         SIZE LIST: S M L \nSAMPLE SIZE: M\nRULE: DELTA 1\n -0.5, 0.25  0,0\n 1.0,-0.5\n\
                         RULE: DELTA  7\n0,0,0,0,0,0\nEND\n";

    #[test]
    fn rules_are_ways_from_the_sample_size() {
        let table = RuleTable::read(TABLE, 1.0).expect("a table");
        assert_eq!((table.sizes.join(" "), table.sample.as_deref()), ("S M L".to_owned(), Some("M")));
        let way = table.way(1, 1, 2).expect("a rule");
        assert!((way - Vec2::new(0.0254, -0.0127)).norm() < 1e-12, "{way}");
        let way = table.way(1, 0, 2).expect("a rule");
        assert!((way - Vec2::new(0.0381, -0.01905)).norm() < 1e-12, "{way}");
        assert_eq!((table.way(7, 0, 2), table.way(2, 0, 2)), (Some(Vec2::zeros()), None));
        assert_eq!(table.number("l"), Some(2));
        // The last rule of a table that was cut off counts, too, if it is whole.
        assert_eq!(RuleTable::read(TABLE.trim_end_matches("END\n"), 1.0).expect("a table"), table);
    }

    #[test]
    fn mistakes_have_a_line_and_what_is_expected() {
        let said = |text: &str| RuleTable::read(text, 1e-3).expect_err("a mistake");
        let few = said(&TABLE.replace("0,0\n 1.0,-0.5", "0,0"));
        assert!(few.line == 7 && few.why.contains("rule 1 has 4 numbers"), "{few:?}");
        let word = said(&TABLE.replace("-0.5\n", "wide\n"));
        assert!(word.line == 9 && word.why.contains("'wide'"), "{word:?}");
        assert!(said(&TABLE.replace("DELTA 1\n", "DELTA\n")).why.contains("has no number"));
        assert!(said(&TABLE.replace("S M L", "")).why.contains("0 sizes"));
    }
}
