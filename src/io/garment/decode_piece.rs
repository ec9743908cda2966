//! Pieces of a garment file.

use super::fields::name;
use super::fields::{
    Fields, entries, integer_within, items, length, number, numbers, quantity, share, text, width, word, wrong,
};
use crate::pattern::{
    AllowanceFile, AllowanceWidth, Corner, CutKind, DartFile, DartShape, Findings, LineFile, Located, NotchFile,
    OutlineFile, PieceFile, PlaceFile, PleatFile, PleatKind, Problem, Side, Value, parse_quantity,
};

/// A piece may be cut so often at most: more is a slip of the pen, and every copy costs.
const MOST_COPIES: usize = 100;

/// Layers lie this far inside or outside the first at most: more is a slip of the pen.
const MOST_LAYERS: i32 = 100;

fn layer(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<i32>> {
    integer_within(value, what, -MOST_LAYERS..=MOST_LAYERS, "between -100 and 100", findings)
}

/// Reads one piece.
pub(super) fn piece(key: &Located<String>, value: &Located<Value>, findings: &mut Findings) -> Option<PieceFile> {
    let key = name(key, findings)?;
    let mut fields = Fields::new(value, &format!("piece '{}'", key.value), findings)?;
    let piece = PieceFile {
        like: fields.get("like", findings, text),
        fabric: fields.get("fabric", findings, text),
        cut: fields.get("cut", findings, cut),
        drawn: fields.get("drawn", findings, |v, _, f| word(v, "drawn", "L or R", f, Side::from_letter)),
        layer: fields.get("layer", findings, layer),
        allowance: fields.take("allowance").and_then(|v| allowance(v, findings)),
        grain: fields.get("grain", findings, grain),
        place: fields.get("place", findings, place),
        outline: fields.take("outline").and_then(|v| outline(v, findings)),
        notches: fields.take("notches").map_or_else(Vec::new, |v| notches(v, findings)),
        darts: fields.take("darts").map(items).unwrap_or_default().iter().filter_map(|v| dart(v, findings)).collect(),
        pleats: fields
            .take("pleats")
            .map(items)
            .unwrap_or_default()
            .iter()
            .filter_map(|v| pleat(v, findings))
            .collect(),
        holes: fields.take("holes").map_or_else(Vec::new, |v| named_paths(v, "holes", findings)),
        lines: fields.take("lines").map_or_else(Vec::new, |v| {
            entries(v, "lines", findings).iter().filter_map(|(k, v)| line(k, v, findings)).collect()
        }),
        note: fields.get("note", findings, text),
        name: key,
    };
    fields.finish(findings);
    Some(piece)
}

fn cut(value: &Located<Value>, _: &str, findings: &mut Findings) -> Option<Located<CutKind>> {
    word(value, "cut", "one, pair, fold EDGE or a number up to 100", findings, |w| {
        let mut words = w.split_whitespace();
        let cut = match (words.next()?, words.next()) {
            ("one" | "1", None) => CutKind::One,
            ("pair", None) => CutKind::Pair,
            ("fold", Some(edge)) => CutKind::Fold(edge.to_owned()),
            (n, None) => CutKind::Count(n.parse().ok().filter(|n| (1..=MOST_COPIES).contains(n))?),
            _ => return None,
        };
        words.next().is_none().then_some(cut)
    })
}

fn allowance(value: &Located<Value>, findings: &mut Findings) -> Option<AllowanceFile> {
    if let Value::Map(entries) = &value.value {
        let edge = |(k, v): &(Located<String>, Located<Value>)| Some((k.clone(), allowance_width(v, findings)?));
        return Some(AllowanceFile::Edges(entries.iter().filter_map(edge).collect()));
    }
    allowance_width(value, findings).map(AllowanceFile::All)
}

/// A width and perhaps how it ends: `30 folded`.
fn allowance_width(value: &Located<Value>, findings: &mut Findings) -> Option<Located<AllowanceWidth>> {
    let written = match &value.value {
        Value::Text(text) => text.trim_end(),
        _ => "",
    };
    if let Some((first, width)) = written.trim_start().split_once(' ')
        && Corner::from_word(first).is_some()
    {
        let turned = format!("{} {first}", width.trim_start());
        findings.error(value.at, Problem::ShapeFirst(written.to_owned(), turned));
        return None;
    }
    let (number, last) = written.rsplit_once(' ').unwrap_or((written, ""));
    let corner = Corner::from_word(last);
    let number = if corner.is_some() { Located::new(Value::Text(number.to_owned()), value.at) } else { value.clone() };
    let width = width(&number, "allowance", findings)?;
    Some(Located::new(AllowanceWidth { width: width.value, corner }, value.at))
}

/// Stands for a grain that was reported, so that it is not said to be missing as well.
const UNREAD_GRAIN: [[f64; 2]; 2] = [[0.0, 0.0], [0.0, 1.0]];

fn grain(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<[[f64; 2]; 2]>> {
    match &value.value {
        Value::List(ends) if ends.len() == 2 => {
            let [tail, head] = [&ends[0], &ends[1]].map(|e| numbers(e, "an end of the grain", findings));
            let read = tail.zip(head).map(|(tail, head)| [tail.value, head.value]);
            Some(Located::new(read.unwrap_or(UNREAD_GRAIN), value.at))
        }
        _ => {
            wrong(value, what, "two points: [[x, y], [x, y]]", findings);
            Some(Located::new(UNREAD_GRAIN, value.at))
        }
    }
}

fn place(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<PlaceFile>> {
    if let Value::List(_) = value.value {
        wrong(value, what, "words such as 'torso front', or a position as {at: [x, y, z]}", findings);
        return None;
    }
    if !matches!(value.value, Value::Map(_)) {
        return text(value, what, findings).map(|t| Located::new(PlaceFile::Words(t.value), t.at));
    }
    let mut fields = Fields::new(value, "place", findings)?;
    let at = fields.require("at", findings, numbers::<3>);
    let turn = fields.get("turn", findings, numbers::<3>).map(|t| t.value);
    fields.finish(findings);
    at.map(|at| Located::new(PlaceFile::At { at: at.value, turn }, value.at))
}

fn outline(value: &Located<Value>, findings: &mut Findings) -> Option<OutlineFile> {
    let mut start = None;
    let mut edges = Vec::new();
    for (key, value) in entries(value, "outline", findings) {
        if key.value == "start" {
            start = numbers(value, "start", findings);
            continue;
        }
        if let (Some(key), Some(path)) = (name(key, findings), text(value, "an edge", findings)) {
            edges.push((key, path));
        }
    }
    if start.is_none() && !matches!(&value.value, Value::Map(e) if e.iter().any(|(k, _)| k.value == "start")) {
        findings.error(value.at, Problem::MissingKey { what: "an outline".to_owned(), key: "start" });
    }
    start.map(|start| OutlineFile { start, edges })
}

fn notches(value: &Located<Value>, findings: &mut Findings) -> Vec<(Located<String>, Vec<Located<NotchFile>>)> {
    let mut all = Vec::new();
    for (edge, list) in entries(value, "notches", findings) {
        all.push((edge.clone(), items(list).iter().filter_map(|n| notch(n, findings)).collect()));
    }
    all
}

fn notch(value: &Located<Value>, findings: &mut Findings) -> Option<Located<NotchFile>> {
    let written = text(value, "a notch", findings)?;
    let (at, double) = match written.value.strip_suffix("double") {
        Some(rest) => (rest, true),
        None => (written.value.as_str(), false),
    };
    match parse_quantity(at) {
        Ok(at) => Some(Located::new(NotchFile { at, double }, value.at)),
        Err(problem) => {
            findings.error(value.at, problem);
            None
        }
    }
}

fn named_paths(value: &Located<Value>, what: &str, findings: &mut Findings) -> Vec<(Located<String>, Located<String>)> {
    let mut all = Vec::new();
    for (key, value) in entries(value, what, findings) {
        if let (Some(key), Some(path)) = (name(key, findings), text(value, "a path", findings)) {
            all.push((key, path));
        }
    }
    all
}

fn dart(value: &Located<Value>, findings: &mut Findings) -> Option<DartFile> {
    let mut fields = Fields::new(value, "a dart", findings)?;
    let own_name = fields.get("name", findings, |v, w, f| text(v, w, f).and_then(|t| name(&t, f)));
    let intake = fields.require("intake", findings, length);
    let edge = fields.get("edge", findings, text);
    let shape = match edge {
        Some(edge) => {
            let at = fields.require("at", findings, quantity);
            let long = fields.get("length", findings, length);
            let tip = fields.get("tip", findings, numbers::<2>);
            match (&long, &tip) {
                (Some(_), Some(tip)) => {
                    findings.error(tip.at, Problem::Exclusive { one: "length", other: "tip" });
                }
                (None, None) => {
                    findings.error(fields.at(), Problem::DartWithoutLength);
                }
                _ => {}
            }
            at.filter(|_| long.is_some() || tip.is_some()).map(|at| DartShape::Edge { edge, at, length: long, tip })
        }
        None => {
            let at = fields.require("at", findings, numbers::<2>);
            let (up, down) = (fields.require("up", findings, length), fields.require("down", findings, length));
            at.zip(up).zip(down).map(|((at, up), down)| DartShape::FishEye { at, up, down })
        }
    };
    fields.finish(findings);
    Some(DartFile { name: own_name, intake: intake?, shape: shape? })
}

fn pleat(value: &Located<Value>, findings: &mut Findings) -> Option<PleatFile> {
    let mut fields = Fields::new(value, "a pleat", findings)?;
    let edge = fields.require("edge", findings, text);
    let where_from = fields.need("at", findings);
    let at = where_from.map(items).unwrap_or_default();
    // Without a place a pleat would be lost when the file is written again.
    if let Some(value) = where_from.filter(|_| at.is_empty()) {
        wrong(value, "at", "a length, or a list of lengths", findings);
    }
    let pleat = |depth, fields: &mut Fields, findings: &mut Findings| PleatFile {
        edge: edge.clone().unwrap_or_default(),
        at: at.iter().filter_map(|v| quantity(v, "at", findings)).collect(),
        depth,
        kind: fields.get("kind", findings, |v, _, f| word(v, "kind", "knife, box or inverted", f, pleat_kind)),
        toward: fields.get("toward", findings, text),
        sewn: fields.get("sewn", findings, length),
    };
    let depth = fields.require("depth", findings, length)?;
    let read = pleat(depth, &mut fields, findings);
    fields.finish(findings);
    edge.is_some().then_some(read)
}

fn pleat_kind(word: &str) -> Option<PleatKind> {
    match word {
        "knife" => Some(PleatKind::Knife),
        "box" => Some(PleatKind::Box),
        "inverted" => Some(PleatKind::Inverted),
        _ => None,
    }
}

/// The share of a line's length that is left when it is drawn in.
fn drawn_in(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<f64>> {
    let share = share(value, what, findings)?;
    let ratio = if share.value.is_percent() { share.value.number / 100.0 } else { share.value.number };
    Some(Located::new(ratio, share.at))
}

fn line(key: &Located<String>, value: &Located<Value>, findings: &mut Findings) -> Option<LineFile> {
    let key = name(key, findings)?;
    let mut fields = Fields::new(value, &format!("line '{}'", key.value), findings)?;
    let line = LineFile {
        name: key,
        path: fields.require("path", findings, text)?,
        fold: fields.get("fold", findings, number),
        kind: fields.get("kind", findings, text),
        ratio: fields.get("ratio", findings, drawn_in),
    };
    fields.finish(findings);
    Some(line)
}
