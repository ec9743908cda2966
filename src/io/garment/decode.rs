//! From the YAML tree to a [`GarmentFile`].

use super::decode_alter::{alterations, sizes};
use super::decode_piece::piece;
use super::decode_seam::seam;
use super::decode_test::test;
use super::fields::{
    Fields, entries, exclusive, integer, integer_within, items, length, numbers, text, width, word, wrong,
};
use crate::input::LengthUnit;
use crate::pattern::{ClosureFile, Findings, GarmentFile, Located, Problem, Quantity, Unit, Value};

/// Statements about a file that are kept for people.
const ABOUT: [&str; 4] = ["source", "license", "note", "measurements"];

/// A mannequin by name, and the measures of `{like: woman_92, waist: 740}`.
type BodyWords = (Option<Located<String>>, Vec<(Located<String>, Located<Quantity>)>);

fn body(value: &Located<Value>, findings: &mut Findings) -> BodyWords {
    let Value::Map(entries) = &value.value else { return (text(value, "body", findings), Vec::new()) };
    let mut out: BodyWords = Default::default();
    for (name, value) in entries {
        if name.value == "like" {
            out.0 = text(value, "body.like", findings);
        } else if let Some(measure) = length(value, &format!("body.{}", name.value), findings) {
            out.1.push((name.clone(), measure));
        }
    }
    if out.0.is_none() {
        findings.error(value.at, Problem::Body("measures need a mannequin that has the rest: like: woman_92".into()));
    }
    out
}

/// Reads the whole file; reports everything that is not as it should be.
pub(super) fn garment(tree: &Located<Value>, findings: &mut Findings) -> Option<GarmentFile> {
    let mut fields = Fields::new(tree, "a garment file", findings)?;
    let version = fields.require("garment", findings, integer::<u32>);
    if let Some(v) = version.filter(|v| v.value != 1) {
        findings.error(v.at, Problem::Version(v.value));
    }
    let (body, body_measures) = fields.take("body").map_or_else(Default::default, |v| body(v, findings));
    let file = GarmentFile {
        version: version.unwrap_or(Located::new(1, fields.at())),
        name: fields.get("name", findings, text),
        about: about(&mut fields),
        units: fields.take("units").and_then(|v| units(v, findings)),
        body,
        body_measures,
        body_units: fields.get("body_units", findings, |v, _, f| {
            word(v, "body_units", "mm, cm, dm, m or in", f, LengthUnit::from_symbol)
        }),
        allowance: fields.get("allowance", findings, width),
        fabrics: fields.take("fabrics").map_or_else(Vec::new, |v| fabrics(v, findings)),
        pieces: fields.need("pieces", findings).map_or_else(Vec::new, |v| {
            entries(v, "pieces", findings).iter().filter_map(|(k, v)| piece(k, v, findings)).collect()
        }),
        seams: fields.take("seams").map_or_else(Vec::new, |v| {
            entries(v, "seams", findings).iter().filter_map(|(k, v)| seam(k, v, findings)).collect()
        }),
        closures: fields
            .take("closures")
            .map_or_else(Vec::new, |v| items(v).iter().filter_map(|c| closure(c, findings)).collect()),
        free: fields.take("free").map_or_else(Vec::new, |v| {
            items(v).iter().filter_map(|f| text(f, "an edge in 'free'", findings)).collect()
        }),
        tests: fields
            .take("tests")
            .map_or_else(Vec::new, |v| items(v).iter().filter_map(|t| test(t, findings)).collect()),
        alter: fields.take("alter").map_or_else(Vec::new, |v| alterations(v, findings)),
        sizes: fields.take("sizes").map_or_else(Vec::new, |v| sizes(v, findings)),
    };
    fields.finish(findings);
    Some(file)
}

fn about(fields: &mut Fields) -> Vec<(Located<String>, Located<Value>)> {
    let entry = |key: &'static str| fields.take(key).map(|v| (Located::new(key.to_owned(), v.at), v.clone()));
    ABOUT.into_iter().filter_map(entry).collect()
}

fn units(value: &Located<Value>, findings: &mut Findings) -> Option<Located<Unit>> {
    let written = text(value, "units", findings)?;
    let unit = Unit::from_symbol(&written.value).filter(|u| *u != Unit::Percent);
    if unit.is_none() {
        findings.error(value.at, Problem::UnknownUnit(written.value));
    }
    unit.map(|u| Located::new(u, value.at))
}

fn fabrics(value: &Located<Value>, findings: &mut Findings) -> Vec<(Located<String>, Located<Value>)> {
    let mut fabrics = Vec::new();
    for (name, value) in entries(value, "fabrics", findings) {
        match &value.value {
            Value::Text(t) if !t.is_empty() => fabrics.push((name.clone(), value.clone())),
            Value::Map(_) => fabrics.push((name.clone(), value.clone())),
            _ => wrong(value, "a fabric", "a fabric's name or a mapping of values", findings),
        }
    }
    fabrics
}

/// Keys that say what carries a closure, of which it has one.
const CARRIERS: [&str; 3] = ["piece", "edge", "on"];

fn closure(value: &Located<Value>, findings: &mut Findings) -> Option<ClosureFile> {
    let mut fields = Fields::new(value, "a closure", findings)?;
    let kind = fields.require("kind", findings, text);
    let carriers = CARRIERS.map(|key| fields.get(key, findings, text));
    exclusive(CARRIERS.into_iter().zip(carriers.iter().map(|c| c.as_ref().map(|c| c.at))), findings);
    let points = |v: Option<&Located<Value>>, findings: &mut Findings| v.map_or_else(Vec::new, |v| points(v, findings));
    let at = fields.take("at");
    let at = points(at, findings);
    let meets = fields.get("meets", findings, text);
    let meets_at = fields.take("meets_at");
    Some(ClosureFile {
        kind: kind?,
        on: carriers.into_iter().flatten().next(),
        at,
        meets,
        meets_at: points(meets_at, findings),
        pitch: fields.get("pitch", findings, length),
        count: fields.get("count", findings, count),
        hardware: fields.rest(),
    })
}

/// More buttons than this on one closure is a slip of the pen.
const MOST_BUTTONS: usize = 1000;

fn count(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<usize>> {
    integer_within(value, what, 1..=MOST_BUTTONS, "between 1 and 1000", findings)
}

/// One point or a list of points.
fn points(value: &Located<Value>, findings: &mut Findings) -> Vec<Located<[f64; 2]>> {
    match &value.value {
        Value::List(list) if list.iter().all(|i| matches!(i.value, Value::List(_))) => {
            list.iter().filter_map(|p| numbers(p, "a point", findings)).collect()
        }
        _ => numbers(value, "a point", findings).into_iter().collect(),
    }
}
