//! The text of a DXF file as entities: each a kind and its pairs of a group code and a value.

use std::f64::consts::TAU;

use super::dxf_error::{DxfError, SHOWN};
use crate::geometry::Vec2;
use crate::input::shown;

/// Group code of the bulge of a vertex, and the entities in which it is one.
const BULGE: i32 = 42;
const BULGED: [&str; 2] = ["LWPOLYLINE", "VERTEX"];
/// Group code of the height of the direction from which an entity is seen.
const UPWARDS: i32 = 230;
/// A degree in radians.
const DEGREE: f64 = TAU / 360.0;
/// Coordinates beyond this (metres) are a wrong unit or no pattern, and bulges beyond it (a circle but for a hair).
const FARTHEST: f64 = 1e3;

/// A value and the line it stands on.
#[derive(Clone, Copy, Debug)]
pub(super) struct DxfValue<'a> {
    pub(super) code: i32,
    pub(super) value: &'a str,
    pub(super) line: usize,
}

impl DxfValue<'_> {
    /// The value times `unit`, of which no more than [`FARTHEST`] is anything of a pattern.
    fn number(&self, unit: f64) -> Result<f64, DxfError> {
        let wrong = || DxfError::Number { line: self.line, found: shown(self.value, SHOWN) };
        let x: f64 = self.value.parse().map_err(|_| wrong())?;
        if (x * unit).abs() <= FARTHEST { Ok(x * unit) } else { Err(wrong()) }
    }
}

/// An entity: its kind and its pairs.
#[derive(Debug)]
pub(super) struct Entity<'a> {
    pub(super) kind: &'a str,
    /// The line its kind stands on.
    pub(super) line: usize,
    pub(super) pairs: Vec<DxfValue<'a>>,
}

impl<'a> Entity<'a> {
    pub(super) fn value(&self, code: i32) -> Option<&'a str> {
        self.pairs.iter().find(|p| p.code == code).map(|p| p.value)
    }

    pub(super) fn layer(&self) -> Option<u32> {
        self.value(8)?.parse().ok()
    }

    /// The meaning of code 70 for its kind.
    pub(super) fn flags(&self) -> u32 {
        self.value(70).and_then(|v| v.parse().ok()).unwrap_or(0)
    }

    /// `vertices` with their bulges as they are seen from above: of an entity that was mirrored in its plane they are
    /// written as seen from below. (Lines and points are written as they lie.)
    pub(super) fn as_seen(&self, vertices: Vec<(Vec2, f64)>) -> Vec<(Vec2, f64)> {
        if !self.is_seen_from_below() {
            return vertices;
        }
        vertices.into_iter().map(|(p, bulge)| (Vec2::new(-p.x, p.y), -bulge)).collect()
    }

    /// Whether it was mirrored in its plane.
    pub(super) fn is_seen_from_below(&self) -> bool {
        self.value(UPWARDS).and_then(|v| v.parse::<f64>().ok()).is_some_and(|z| z < 0.0)
    }

    /// The points at codes 10 and 20 (or 11 and 21), metres, y down.
    pub(super) fn points(&self, first: i32, unit: f64) -> Result<Vec<Vec2>, DxfError> {
        Ok(self.vertices(first, unit)?.into_iter().map(|v| v.0).collect())
    }

    /// The points at codes 10 and 20 (or 11 and 21), metres, y down, each with the bulge (code 42) of the arc to the
    /// next, which is counterclockwise on the sheet where that is positive.
    pub(super) fn vertices(&self, first: i32, unit: f64) -> Result<Vec<(Vec2, f64)>, DxfError> {
        let mut vertices: Vec<(Vec2, f64)> = Vec::new();
        for pair in &self.pairs {
            if pair.code == first {
                vertices.push((Vec2::new(pair.number(unit)?, 0.0), 0.0));
            } else if let Some(last) = vertices.last_mut() {
                match pair.code {
                    code if code == first + 10 => last.0.y = -pair.number(unit)?,
                    BULGE if BULGED.contains(&self.kind) => last.1 = pair.number(1.0)?,
                    _ => {}
                }
            }
        }
        Ok(vertices)
    }

    /// The slit of a notch that begins at a point: its direction (code 50, degrees) and depth (code 30) as metres, y
    /// down; nought where one of them is missing or no number.
    pub(super) fn slit(&self, unit: f64) -> Vec2 {
        let number = |code: i32, unit: f64| self.pairs.iter().find(|p| p.code == code)?.number(unit).ok();
        let (Some(depth), Some(angle)) = (number(30, unit), number(50, DEGREE)) else { return Vec2::zeros() };
        let (sine, cosine) = angle.sin_cos();
        depth * Vec2::new(cosine, -sine)
    }

    /// A CIRCLE as two halves with their bulges, metres, y down; nothing where a number is missing.
    pub(super) fn circle(&self, unit: f64) -> Result<Option<Vec<(Vec2, f64)>>, DxfError> {
        let Some((centre, radius)) = self.points(10, unit)?.first().copied().zip(self.number(40, unit)?) else {
            return Ok(None);
        };
        let right = Vec2::new(radius, 0.0);
        Ok((radius > 0.0).then(|| vec![(centre - right, 1.0), (centre + right, 1.0)]))
    }

    /// The number of this code times `unit`, if there is one.
    pub(super) fn number(&self, code: i32, unit: f64) -> Result<Option<f64>, DxfError> {
        self.pairs.iter().find(|p| p.code == code).map(|p| p.number(unit)).transpose()
    }

    /// All numbers of this code.
    pub(super) fn numbers(&self, code: i32) -> Result<Vec<f64>, DxfError> {
        self.pairs.iter().filter(|p| p.code == code).map(|p| p.number(1.0)).collect()
    }

    /// An ARC as two halves with their bulges, metres, y down; nothing where a number is missing. One that ends where
    /// it begins is a whole circle.
    pub(super) fn arc(&self, unit: f64) -> Result<Vec<(Vec2, f64)>, DxfError> {
        let number = |code: i32, unit: f64| self.number(code, unit);
        let centre = self.points(10, unit)?.first().copied();
        let angles = [number(50, DEGREE)?, number(51, DEGREE)?];
        let (Some(centre), Some(radius), [Some(start), Some(end)]) = (centre, number(40, unit)?, angles) else {
            return Ok(Vec::new());
        };
        let turn = (end - start).rem_euclid(TAU);
        let turn = if turn == 0.0 { TAU } else { turn };
        let at = |share: f64| {
            let (sine, cosine) = (start + share * turn).sin_cos();
            centre + radius * Vec2::new(cosine, -sine)
        };
        let bulge = (0.125 * turn).tan();
        Ok(vec![(at(0.0), bulge), (at(0.5), bulge), (at(1.0), 0.0)])
    }
}

pub(super) fn entities(text: &str) -> Result<Vec<Entity<'_>>, DxfError> {
    let mut entities: Vec<Entity> = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((k, code)) = lines.next() {
        let code = code.trim_start_matches('\u{feff}').trim();
        if code.is_empty() && entities.last().is_none_or(|e| e.kind == "EOF") {
            continue;
        }
        let code: i32 = code.parse().map_err(|_| DxfError::NotText { line: k + 1, found: shown(code, SHOWN) })?;
        let Some((k, value)) = lines.next() else { break };
        let value = value.trim();
        if code == 0 {
            entities.push(Entity { kind: value, line: k + 1, pairs: Vec::new() });
        } else if let Some(entity) = entities.last_mut() {
            entity.pairs.push(DxfValue { code, value, line: k + 1 });
        }
    }
    Ok(entities)
}

/// The entities between BLOCK (included) and ENDBLK.
pub(super) fn blocks<'e, 'a>(entities: &'e [Entity<'a>]) -> Vec<&'e [Entity<'a>]> {
    let mut blocks = Vec::new();
    let mut begin = None;
    for (k, entity) in entities.iter().enumerate() {
        match entity.kind {
            "BLOCK" => begin = Some(k),
            "ENDBLK" => blocks.extend(begin.take().map(|b| &entities[b..k])),
            _ => {}
        }
    }
    blocks
}

/// Metres per unit by the style's text or the header.
pub(super) fn stated_unit(entities: &[Entity]) -> Option<f64> {
    let said = entities.iter().filter(|e| e.kind == "TEXT").filter_map(|e| after(e.value(1)?, "units:"));
    for words in said {
        match words.to_ascii_uppercase().as_str() {
            "METRIC" | "MM" => return Some(1e-3),
            "ENGLISH" | "IMPERIAL" | "INCH" | "INCHES" => return Some(0.0254),
            "CM" => return Some(1e-2),
            _ => {}
        }
    }
    match header(entities, "$INSUNITS")? {
        "1" => Some(0.0254),
        "4" => Some(1e-3),
        "5" => Some(1e-2),
        "6" => Some(1.0),
        _ => None,
    }
}

/// A variable of the header, which stands among the pairs of the HEADER section.
fn header<'a>(entities: &[Entity<'a>], variable: &str) -> Option<&'a str> {
    let mut pairs = entities.iter().flat_map(|e| e.pairs.windows(2));
    pairs.find(|w| w[0].value == variable).map(|w| w[1].value.trim())
}

/// The unit that a drawing may be meant in which does not say it, and what is to be said of that. `$MEASUREMENT` tells
/// the system its author works in, and no more.
pub(super) fn assumed_unit(entities: &[Entity]) -> (f64, Vec<String>) {
    let (unit, name, why) = match header(entities, "$MEASUREMENT") {
        Some("0") => (0.0254, "inches", ", by its $MEASUREMENT"),
        _ => (1e-3, "millimetres", ""),
    };
    (unit, vec![format!("the drawing does not say its unit: taken as {name}{why}; --units says another")])
}

/// The value after a key at the start of a text, in any case: `Piece Name: FRONT`.
pub(super) fn after<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let head = text.get(..key.len())?;
    head.eq_ignore_ascii_case(key).then(|| text[key.len()..].trim())
}

/// The lines of a text; a MTEXT's without what says how they look.
pub(super) fn lines_of(entity: &Entity) -> Vec<String> {
    if entity.kind != "MTEXT" {
        return entity.value(1).map(str::to_owned).into_iter().collect();
    }
    // A long text comes in parts, the last of which has another code.
    let parts = entity.pairs.iter().filter(|p| p.code == 3 || p.code == 1).map(|p| p.value);
    plain(&parts.collect::<String>()).split('\n').map(|line| line.trim().to_owned()).filter(|l| !l.is_empty()).collect()
}

/// A MTEXT's words: `\P` begins a line, `\f…;`, `\H…;` and the like say how letters look, braces hold them together.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '{' | '}' => {}
            '\\' => match rest.next() {
                Some('P' | 'X') => out.push('\n'),
                Some('~') => out.push(' '),
                Some(c @ ('\\' | '{' | '}')) => out.push(c),
                // A code of a letter, which is read later.
                Some('U') if rest.peek() == Some(&'+') => out.push_str("\\U"),
                Some('L' | 'l' | 'O' | 'o' | 'K' | 'k') => {}
                Some('A' | 'C' | 'c' | 'F' | 'f' | 'H' | 'p' | 'Q' | 'S' | 'T' | 'W') => {
                    rest.by_ref().find(|c| *c == ';');
                }
                Some(c) => out.push(c),
                None => {}
            },
            c => out.push(c),
        }
    }
    out
}

/// DXF R12 writes letters beyond ASCII as their codes of UTF-16: `\U+00FC` is ü, and `\U+D83D\U+DC57` a dress. A text
/// that is no code of a letter stays as it is.
pub(super) fn letters(text: &str) -> String {
    let code = |part: &str| part.get(..4).and_then(|hex| u16::from_str_radix(hex, 16).ok());
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("\\U+") {
        out.push_str(before);
        let second = || code(after.get(4..)?.strip_prefix("\\U+")?);
        let codes = code(after).into_iter().flat_map(|first| std::iter::once(first).chain(second()));
        rest = match char::decode_utf16(codes).next() {
            Some(Ok(c)) => {
                out.push(c);
                &after[if c.len_utf16() == 2 { 11 } else { 4 }..]
            }
            _ => {
                out.push_str("\\U+");
                after
            }
        };
    }
    out.push_str(rest);
    out
}
