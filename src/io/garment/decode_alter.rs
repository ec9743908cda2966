//! Alterations and sizes of a garment file.

use super::fields::{Fields, distance, entries, integer, items, length, numbers, share, text, word, wrong};
use crate::pattern::{
    AlterationFile, Findings, Located, Problem, Quantity, SizeFile, StationFile, Value, parse_quantity,
};

/// The kinds of alterations. Each entry is of one kind.
const KINDS: [&str; 10] =
    ["take_in", "let_out", "lengthen", "shorten", "pivot", "spread", "fullness", "cut", "join", "move"];
const KNOWN: &str = "take_in, let_out, lengthen, shorten, pivot, spread, fullness, cut, join or move";

/// Reads a list of alterations.
pub(super) fn alterations(value: &Located<Value>, findings: &mut Findings) -> Vec<Located<AlterationFile>> {
    items(value).iter().filter_map(|v| alteration(v, findings)).collect()
}

/// Reads a file of changes: `alter:` with a list of alterations.
pub(super) fn changes(tree: &Located<Value>, findings: &mut Findings) -> Vec<Located<AlterationFile>> {
    let Some(mut fields) = Fields::new(tree, "a file of changes", findings) else { return Vec::new() };
    let list = fields.need("alter", findings).map_or_else(Vec::new, |v| alterations(v, findings));
    fields.finish(findings);
    list
}

/// The fault of what is no alteration.
pub(super) fn no_alteration(found: &str) -> Problem {
    Problem::UnknownWord { what: "alteration", found: found.to_owned(), known: KNOWN }
}

/// Reads the sizes: by name, a list of alterations each.
pub(super) fn sizes(value: &Located<Value>, findings: &mut Findings) -> Vec<SizeFile> {
    let entries = entries(value, "sizes", findings);
    entries.iter().map(|(name, list)| SizeFile { name: name.clone(), alter: alterations(list, findings) }).collect()
}

fn alteration(value: &Located<Value>, findings: &mut Findings) -> Option<Located<AlterationFile>> {
    read(value, length, findings)
}

/// Reads an alteration whose lengths may be zero or negative, as those of a knob are at its end.
pub(super) fn alteration_of_any_sign(
    value: &Located<Value>,
    findings: &mut Findings,
) -> Option<Located<AlterationFile>> {
    read(value, distance, findings)
}

/// How a length is read.
type Length = fn(&Located<Value>, &str, &mut Findings) -> Option<Located<Quantity>>;

fn read(value: &Located<Value>, by: Length, findings: &mut Findings) -> Option<Located<AlterationFile>> {
    let mut fields = Fields::new(value, "an alteration", findings)?;
    let named = KINDS.into_iter().filter(|kind| fields.has(kind)).collect::<Vec<_>>();
    let read = match named[..] {
        [] => {
            let found = fields.rest().first().map_or_else(|| "nothing".to_owned(), |(key, _)| key.value.clone());
            findings.error(value.at, no_alteration(&found));
            return None;
        }
        [kind] => of_kind(kind, &mut fields, by, findings),
        [one, other, ..] => {
            findings.error(value.at, Problem::Exclusive { one, other });
            return None;
        }
    };
    fields.finish(findings);
    Some(Located::new(read?, value.at))
}

fn of_kind(kind: &'static str, fields: &mut Fields, by: Length, findings: &mut Findings) -> Option<AlterationFile> {
    match kind {
        "take_in" | "let_out" => take(kind, fields, findings),
        "lengthen" | "shorten" => lengthen(kind, fields, by, findings),
        "pivot" => {
            let (dart, to) = (fields.get(kind, findings, text), fields.require("to", findings, text));
            let (share, name) = (fields.get("share", findings, share), fields.get("name", findings, named));
            Some(AlterationFile::Pivot { dart: dart?, to: to?, share, name })
        }
        "spread" => {
            let (from, to) = (fields.get(kind, findings, text), fields.require("to", findings, text));
            let (by, to_by) = (fields.require("by", findings, by), fields.get("to_by", findings, by));
            Some(AlterationFile::Spread { from: from?, to: to?, by: by?, to_by })
        }
        "fullness" => {
            let (edge, to) = (fields.get(kind, findings, text), fields.require("to", findings, text));
            let (by, to_by) = (fields.require("by", findings, by), fields.get("to_by", findings, by));
            let slashes = fields.get("slashes", findings, integer);
            Some(AlterationFile::Fullness { edge: edge?, to: to?, by: by?, to_by, slashes })
        }
        "join" => Some(AlterationFile::Join { seam: fields.get(kind, findings, text)? }),
        "cut" => {
            let (from, to) = (fields.get(kind, findings, text), fields.require("to", findings, text));
            let via = fields
                .take("via")
                .map_or_else(Vec::new, |v| items(v).iter().filter_map(|p| numbers(p, "a point", findings)).collect());
            let (name, seam) = (fields.require("name", findings, named), fields.get("seam", findings, named));
            Some(AlterationFile::Cut { from: from?, to: to?, via, name: name?, seam })
        }
        _ => {
            let edge = fields.get(kind, findings, text);
            let at = fields.need("at", findings).map(|v| stations(v, findings, |v, f| numbers(v, "a shift", f)));
            Some(AlterationFile::Move { edge: edge?, at: at? })
        }
    }
}

fn named(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<String>> {
    text(value, what, findings).and_then(|t| super::fields::name(&t, findings))
}

fn take(kind: &'static str, fields: &mut Fields, findings: &mut Findings) -> Option<AlterationFile> {
    let seam = fields.get(kind, findings, text);
    let amount = |v: &Located<Value>, f: &mut Findings| distance(v, "an amount", f);
    let at = fields.need("at", findings).map(|v| stations(v, findings, amount));
    Some(AlterationFile::Take { seam: seam?, at: at?, out: kind == "let_out" })
}

fn lengthen(kind: &'static str, fields: &mut Fields, by: Length, findings: &mut Findings) -> Option<AlterationFile> {
    let pieces = fields
        .take(kind)
        .map_or_else(Vec::new, |v| items(v).iter().filter_map(|p| text(p, "a piece", findings)).collect());
    let (at, by) = (fields.require("at", findings, distance), fields.require("by", findings, by));
    let over = fields.get("over", findings, length);
    let across = fields.get("along", findings, |v, _, f| {
        word(v, "along", "y (longer, the usual) or x (wider)", f, |w| match w {
            "x" => Some(true),
            "y" => Some(false),
            _ => None,
        })
    });
    Some(AlterationFile::Lengthen { pieces, at: at?, by: by?, over, across, shorter: kind == "shorten" })
}

/// Positions along an edge with what happens there: `{50 %: 8, 120: 4 mm}`.
fn stations<T>(
    value: &Located<Value>,
    findings: &mut Findings,
    amount: impl Fn(&Located<Value>, &mut Findings) -> Option<Located<T>>,
) -> Vec<StationFile<T>> {
    let list = entries(value, "at", findings);
    if list.is_empty() && matches!(value.value, Value::Map(_) | Value::Text(_)) {
        wrong(value, "at", "positions and amounts, such as {50 %: 8}", findings);
    }
    let mut read = Vec::new();
    for (key, value) in list {
        match parse_quantity(&key.value) {
            Ok(at) => read.extend(amount(value, findings).map(|by| (Located::new(at, key.at), by))),
            Err(problem) => findings.error(key.at, problem),
        }
    }
    read
}
