//! A file of wants: how a garment is to fit, and what may be altered for it.

use super::decode_alter::alteration_of_any_sign;
use super::fields::{Fields, entries, items, text, wrong};
use crate::pattern::{
    AlterationFile, Findings, KnobFile, Located, Problem, Quantity, Unit, Value, WantFile, Wanted, WantsFile,
    known_girth, parse_quantity,
};

/// Keys of an alteration that hold names and no amounts.
const NAMES: [&str; 10] =
    ["take_in", "let_out", "lengthen", "shorten", "pivot", "spread", "move", "to", "name", "along"];
const LENGTH: &str = "a length or a range such as 80 mm, 60..90 mm, below 90 mm or above 60 mm";
const PRESSURE: &str = "a pressure or a range such as below 2.3 kPa or 1..2 kPa";
const STRAIN: &str = "a share of the limit such as 'below 60 % of limit'";
const RANGE: &str = "an alteration with a range of amount, such as {take_in: side, at: {50 %: -10..30}}";

/// Reads the tree of a file of wants, in which bare lengths count in `unit`.
pub(super) fn wants(tree: &Located<Value>, unit: Unit, findings: &mut Findings) -> WantsFile {
    let Some(mut fields) = Fields::new(tree, "a file of wants", findings) else { return WantsFile::default() };
    let mut out = WantsFile::default();
    for (key, list) in fields.take("ease").map_or(&[][..], |v| entries(v, "ease", findings)) {
        let range = length_range(list, "ease", unit, findings);
        let girth = known_girth(key, findings);
        out.wants.extend(girth.zip(range).map(|(girth, range)| Located::new(WantFile::Ease(girth, range), key.at)));
    }
    for (key, list) in fields.take("pressure").map_or(&[][..], |v| entries(v, "pressure", findings)) {
        let range = pressure_range(list, findings);
        let girth = known_girth(key, findings);
        out.wants.extend(girth.zip(range).map(|(girth, range)| Located::new(WantFile::Pressure(girth, range), key.at)));
    }
    if let Some(value) = fields.take("hem") {
        hem(value, unit, &mut out, findings);
    }
    for (key, end, want) in
        [("sleeve", "wrist", WantFile::SleeveEnd as fn(Wanted) -> WantFile), ("leg", "ankle", WantFile::LegEnd)]
    {
        let range = fields.take(key).and_then(|value| ends_at(value, key, end, unit, findings));
        out.wants.extend(range.map(|range| Located::new(want(range.value), range.at)));
    }
    if let Some(value) = fields.take("strain") {
        out.wants.extend(strain(value, findings).map(|range| Located::new(WantFile::Strain(range), value.at)));
    }
    if let Some(value) = fields.take("balance") {
        let why = "no figure of the report says how upright seams hang".to_owned();
        findings.error(value.at, Problem::NoSuchWant { want: "balance".to_owned(), why });
    }
    for (name, value) in fields.take("knobs").map_or(&[][..], |v| entries(v, "knobs", findings)) {
        out.knobs.extend(knob(name, value, unit, findings));
    }
    fields.finish(findings);
    out
}

fn hem(value: &Located<Value>, unit: Unit, out: &mut WantsFile, findings: &mut Findings) {
    let Some(mut fields) = Fields::new(value, "hem", findings) else { return };
    if let Some(value) = fields.take("level") {
        let range = length_range(value, "level", unit, findings);
        // `10 mm` is within 10 mm.
        let within = range.map(|range| Wanted { from: range.from.filter(|_| range.from != range.to), ..range });
        out.wants.extend(within.map(|range| Located::new(WantFile::HemLevel(range), value.at)));
    }
    if let Some(value) = fields.take("above_floor") {
        let range = length_range(value, "above_floor", unit, findings);
        out.wants.extend(range.map(|range| Located::new(WantFile::HemHeight(range), value.at)));
    }
    fields.finish(findings);
}

/// `{ends_at: wrist}`, and by how much beyond it.
fn ends_at(
    value: &Located<Value>,
    key: &'static str,
    end: &'static str,
    unit: Unit,
    findings: &mut Findings,
) -> Option<Located<Wanted>> {
    let mut fields = Fields::new(value, key, findings)?;
    let at = fields.require("ends_at", findings, text)?;
    let beyond = fields.take("beyond");
    fields.finish(findings);
    if at.value != end {
        let why = format!("the report measures a {key} against the {end} only; 'beyond' says how far past it");
        findings.error(at.at, Problem::NoSuchWant { want: format!("{key} that ends at '{}'", at.value), why });
        return None;
    }
    let there = Some(Wanted { from: Some(0.0), to: Some(0.0) });
    let range = beyond.map_or(there, |value| length_range(value, "beyond", unit, findings));
    range.map(|range| Located::new(range, value.at))
}

fn length_range(value: &Located<Value>, what: &str, unit: Unit, findings: &mut Findings) -> Option<Wanted> {
    let length = |text: &str| parse_quantity(text).ok().filter(|q| !q.is_percent());
    let read = scalar(value).and_then(|text| range(text, length)).and_then(|ends| in_order(ends, |q| q.value(unit)));
    if read.is_none() {
        wrong(value, what, LENGTH, findings);
    }
    read
}

fn pressure_range(value: &Located<Value>, findings: &mut Findings) -> Option<Wanted> {
    let bare = |text: &str| text.trim().trim_end_matches("kPa").trim().parse().ok().filter(|p: &f64| *p >= 0.0);
    let kilopascals = |text: &str| bare(text).map(|number| Quantity { number, unit: None });
    let read = scalar(value).and_then(|text| range(text, kilopascals)).and_then(|ends| in_order(ends, |q| q.number));
    if read.is_none() {
        wrong(value, "pressure", PRESSURE, findings);
    }
    read
}

fn strain(value: &Located<Value>, findings: &mut Findings) -> Option<Wanted> {
    let share = |text: &str| parse_quantity(text).ok().filter(|q| q.is_percent() && q.number >= 0.0);
    let bare = scalar(value).and_then(|text| text.trim().strip_suffix("of limit"));
    let read = bare.and_then(|text| range(text, share)).and_then(|ends| in_order(ends, |q| q.value(Unit::Percent)));
    if read.is_none() {
        wrong(value, "strain", STRAIN, findings);
    }
    read
}

fn scalar(value: &Located<Value>) -> Option<&str> {
    match &value.value {
        Value::Text(text) => Some(text.trim()),
        _ => None,
    }
}

/// Both ends of `60..90 mm`, `below 90 mm`, `above 60 mm` or `80 mm`.
fn range(text: &str, read: impl Fn(&str) -> Option<Quantity>) -> Option<[Option<Quantity>; 2]> {
    let text = text.trim();
    if let Some(most) = text.strip_prefix("below ") {
        return Some([None, Some(read(most)?)]);
    }
    if let Some(least) = text.strip_prefix("above ") {
        return Some([Some(read(least)?), None]);
    }
    match text.split_once("..") {
        Some((from, to)) => both(read(from)?, read(to)?).map(|ends| ends.map(Some)),
        None => read(text).map(|q| [Some(q), Some(q)]),
    }
}

/// The first end takes the unit of the last where it has none. Two units are none.
fn both(from: Quantity, to: Quantity) -> Option<[Quantity; 2]> {
    let from = Quantity { unit: from.unit.or(to.unit), ..from };
    (from.unit == to.unit).then_some([from, to])
}

fn in_order([from, to]: [Option<Quantity>; 2], value: impl Fn(Quantity) -> f64) -> Option<Wanted> {
    let out = Wanted { from: from.map(&value), to: to.map(&value) };
    out.from.zip(out.to).is_none_or(|(from, to)| from <= to).then_some(out)
}

fn knob(name: &Located<String>, value: &Located<Value>, unit: Unit, findings: &mut Findings) -> Option<KnobFile> {
    let mut ranges = Vec::new();
    let ends = [0, 1].map(|end| with_end(value, end, unit, &mut ranges));
    let widest = ranges.iter().copied().max_by(|a: &[f64; 2], b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let Some(range) = widest.filter(|r| r[0] < r[1]) else {
        wrong(value, &format!("knob '{}'", name.value), RANGE, findings);
        return None;
    };
    // Where one amount is zero, all are: the garment is as it is drawn.
    let zero = -range[0] / (range[1] - range[0]);
    let off = ranges.iter().find(|r| (r[0] + zero * (r[1] - r[0])).abs() > 1e-6);
    if off.is_some() {
        findings.error(value.at, Problem::KnobRanges(name.value.clone()));
        return None;
    }
    let [first, last] = ends.map(|end| {
        let read = items(&end).iter().map(|a| alteration_of_any_sign(a, findings)).collect::<Option<Vec<_>>>();
        read.unwrap_or_default()
    });
    let parts: Vec<[AlterationFile; 2]> = first.into_iter().zip(last).map(|(a, b)| [a.value, b.value]).collect();
    (!parts.is_empty()).then(|| KnobFile { name: name.clone(), parts, range })
}

/// A knob's alterations with one end of each of its ranges, which are added to `ranges`.
fn with_end(value: &Located<Value>, end: usize, unit: Unit, ranges: &mut Vec<[f64; 2]>) -> Located<Value> {
    let new = match &value.value {
        Value::Text(text) => match amounts(text) {
            Some(ends) => {
                ranges.push(ends.map(|q| q.value(unit)));
                let unit = ends[end].unit.map_or_else(String::new, |u| format!(" {}", u.symbol()));
                Value::Text(format!("{}{unit}", ends[end].number))
            }
            None => Value::Text(text.clone()),
        },
        Value::List(items) => Value::List(items.iter().map(|item| with_end(item, end, unit, ranges)).collect()),
        Value::Map(entries) => {
            let entry = |(key, value): &(Located<String>, Located<Value>)| {
                let is_name = NAMES.contains(&key.value.as_str());
                (key.clone(), if is_name { value.clone() } else { with_end(value, end, unit, ranges) })
            };
            Value::Map(entries.iter().map(entry).collect())
        }
    };
    Located::new(new, value.at)
}

fn amounts(text: &str) -> Option<[Quantity; 2]> {
    let (from, to) = text.split_once("..")?;
    both(parse_quantity(from).ok()?, parse_quantity(to).ok()?)
}
