//! Regression bounds of a garment file.

use super::fields::{Fields, distance, integer, share, text, width, word, wrong};
use crate::pattern::{Findings, Located, Problem, Quantity, TestEntry, TestFile, Value};

/// The quantities that can be bounded. A test names one of them.
const KINDS: [&str; 11] =
    ["seam", "gap", "closure", "flatten", "drape", "crossings", "openings", "worn", "ease", "pressure", "hem"];
const KNOWN: &str = "seam, gap, closure, flatten, drape, crossings, openings, worn, ease, pressure or hem";
/// The first words of a test of a hem.
pub(super) const LEVEL: &str = "level within";

/// Reads one entry of `tests`.
pub(super) fn test(value: &Located<Value>, findings: &mut Findings) -> Option<Located<TestEntry>> {
    let mut fields = Fields::new(value, "a test", findings)?;
    let fabric = fields.get("fabric", findings, text);
    let named = KINDS.into_iter().filter(|kind| fields.has(kind)).collect::<Vec<_>>();
    let test = match named[..] {
        [] => {
            let found = fields.rest().first().map_or_else(|| "nothing".to_owned(), |(k, _)| k.value.clone());
            findings.error(value.at, Problem::UnknownWord { what: "test", found, known: KNOWN });
            return None;
        }
        [kind] => bound(kind, &mut fields, findings),
        [one, other, ..] => {
            findings.error(value.at, Problem::Exclusive { one, other });
            return None;
        }
    };
    fields.finish(findings);
    Some(Located::new(TestEntry { test: test?, fabric }, value.at))
}

fn bound(kind: &'static str, fields: &mut Fields, findings: &mut Findings) -> Option<TestFile> {
    Some(match kind {
        "seam" => {
            let (seam, limit) = (fields.get(kind, findings, text), fields.require("length", findings, width));
            TestFile::Seam(seam?, limit?)
        }
        "gap" => {
            let (seam, limit) = (fields.get(kind, findings, text), fields.require("below", findings, width));
            TestFile::Gap(seam?, limit?)
        }
        "closure" => {
            let (kind, limit) = (fields.get(kind, findings, text), fields.require("below", findings, width));
            TestFile::Closure(kind?, limit?)
        }
        "flatten" => {
            let piece = fields.get(kind, findings, text);
            let (area, boundary) = figures(fields, findings, width)?;
            TestFile::Flatten(piece?, area, boundary)
        }
        "drape" => {
            let piece = fields.get(kind, findings, text);
            let (area, boundary) = figures(fields, findings, share)?;
            TestFile::Drape(piece?, area, boundary)
        }
        "crossings" => TestFile::Crossings(fields.get(kind, findings, integer::<usize>)?.value),
        "openings" => TestFile::Openings(fields.get(kind, findings, integer::<usize>)?.value),
        "ease" => {
            let girth = fields.get(kind, findings, text);
            if !fields.has("from") && !fields.has("to") {
                fields.require("from", findings, distance)?;
            }
            let (from, to) = (fields.get("from", findings, distance), fields.get("to", findings, distance));
            TestFile::Ease(girth?, from, to)
        }
        "pressure" => {
            let (girth, below) = (fields.get(kind, findings, text), fields.require("below", findings, kilopascals));
            TestFile::Pressure(girth?, below?)
        }
        "hem" => TestFile::HemLevel(fields.get(kind, findings, level)?),
        _ => {
            // What is not asked for is not written: there is no bound to be broken by a garment that is worn.
            fields.get(kind, findings, |v, _, f| word(v, "worn", "true, or leave the test out", f, is_true))?;
            TestFile::Worn
        }
    })
}

/// A pressure above zero: `2.3 kPa`, or the bare number.
fn kilopascals(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<f64>> {
    let written = text(value, what, findings)?;
    let number = written.value.trim().trim_end_matches("kPa").trim_end().parse::<f64>().ok();
    let pressure = number.filter(|p| *p > 0.0 && p.is_finite());
    if pressure.is_none() {
        wrong(value, what, "a pressure above zero such as 2.3 kPa", findings);
    }
    pressure.map(|p| Located::new(p, value.at))
}

/// `level within 10 mm`.
fn level(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<Quantity>> {
    let written = text(value, what, findings)?;
    let Some(length) = written.value.trim().strip_prefix(LEVEL) else {
        wrong(value, what, "'level within' and a length, such as level within 10 mm", findings);
        return None;
    };
    width(&Located::new(Value::Text(length.trim().to_owned()), value.at), what, findings)
}

fn is_true(word: &str) -> Option<()> {
    matches!(word, "true" | "True" | "TRUE" | "yes").then_some(())
}

/// A figure that a file may state.
type Figure = Option<Located<Quantity>>;

/// `area` and `boundary`, of which at least one must be there.
fn figures(
    fields: &mut Fields,
    findings: &mut Findings,
    boundary: impl Fn(&Located<Value>, &str, &mut Findings) -> Figure,
) -> Option<(Figure, Figure)> {
    if !fields.has("area") && !fields.has("boundary") {
        findings.error(fields.at(), Problem::NoFigure);
        return None;
    }
    Some((fields.get("area", findings, share), fields.get("boundary", findings, boundary)))
}
