//! DXF-AAMA (ASTM D6673) in: a piece per block, lines by the standard's layers (see [`layer`]).
//!
//! Text files of any release are read as pairs of a group code and a value; of what they hold, polylines, lines, points
//! and texts of blocks count. Blocks without a boundary are skipped, for programs add some of their own.

use std::path::Path as FilePath;

use super::dxf_notches;
use super::dxf_write::layer;
use crate::digitize::{Inner, Traced, chained};
use crate::geometry::{Path, Vec2};
use crate::input::{InputError, bytes, shown};
use crate::pattern::Cut;

/// Larger files are not patterns.
const MOST_BYTES: u64 = 30 << 20;
/// Coordinates beyond this (metres) are a wrong unit or no pattern.
const FARTHEST: f64 = 1e3;
/// More lines in a block than this cannot be looked at one against the other.
const MOST_LINES: usize = 5_000;
/// Letters of a text that messages show.
const SHOWN: usize = 40;

/// Why a DXF file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum DxfError {
    /// The system refused.
    #[error("{0}")]
    Input(#[from] InputError),
    /// A binary file, or no DXF at all.
    #[error("it is not a DXF text file: line {line} should be a group code and is '{found}'")]
    NotText {
        /// From 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A coordinate that is no number.
    #[error("line {line}: '{found}' is not a coordinate")]
    Number {
        /// From 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// Too many lines.
    #[error("block '{block}' has more than {most} lines; leave out what does not belong to the pattern")]
    TooMany {
        /// Its name.
        block: String,
        /// The limit.
        most: usize,
    },
    /// No block is a piece.
    #[error(
        "no block has a boundary on layer 1, so this is not a DXF-AAMA (ASTM D6673) pattern; \
         layers found: {0}; export it as AAMA or ASTM, or as SVG"
    )]
    NoPieces(String),
}

/// Reads the pieces of a DXF file; `unit` is metres per drawing unit where the file does not say.
///
/// # Errors
/// [`DxfError`].
pub fn read_dxf(path: &FilePath, unit: Option<f64>) -> Result<Vec<Traced>, DxfError> {
    read_dxf_text(&String::from_utf8_lossy(&bytes(path, MOST_BYTES)?), unit)
}

/// Reads the pieces of a DXF text.
///
/// # Errors
/// As [`read_dxf`].
pub fn read_dxf_text(text: &str, unit: Option<f64>) -> Result<Vec<Traced>, DxfError> {
    let entities = entities(text)?;
    let unit = unit.or_else(|| stated_unit(&entities)).unwrap_or(1e-3);
    let mut pieces = Vec::new();
    for block in blocks(&entities) {
        pieces.extend(Block::new(block, unit)?.piece());
    }
    if pieces.is_empty() {
        let mut layers: Vec<&str> = entities.iter().filter_map(|e| e.value(8)).collect();
        layers.sort_unstable();
        layers.dedup();
        return Err(DxfError::NoPieces(shown(&layers.join(", "), 4 * SHOWN)));
    }
    Ok(pieces)
}

/// A value and the line it stands on.
#[derive(Clone, Copy, Debug)]
struct Pair<'a> {
    code: i32,
    value: &'a str,
    line: usize,
}

/// An entity: its kind and its pairs.
#[derive(Debug)]
struct Entity<'a> {
    kind: &'a str,
    pairs: Vec<Pair<'a>>,
}

impl<'a> Entity<'a> {
    fn value(&self, code: i32) -> Option<&'a str> {
        self.pairs.iter().find(|p| p.code == code).map(|p| p.value)
    }

    fn layer(&self) -> Option<u32> {
        self.value(8)?.parse().ok()
    }

    /// The points at codes 10 and 20 (or 11 and 21), metres, y down.
    fn points(&self, first: i32, unit: f64) -> Result<Vec<Vec2>, DxfError> {
        let number = |p: &Pair| {
            let wrong = || DxfError::Number { line: p.line, found: shown(p.value, SHOWN) };
            let x: f64 = p.value.parse().map_err(|_| wrong())?;
            if (x * unit).abs() <= FARTHEST { Ok(x * unit) } else { Err(wrong()) }
        };
        let mut points: Vec<Vec2> = Vec::new();
        for pair in &self.pairs {
            if pair.code == first {
                points.push(Vec2::new(number(pair)?, 0.0));
            } else if pair.code == first + 10
                && let Some(last) = points.last_mut()
            {
                last.y = -number(pair)?;
            }
        }
        Ok(points)
    }
}

fn entities(text: &str) -> Result<Vec<Entity<'_>>, DxfError> {
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
            entities.push(Entity { kind: value, pairs: Vec::new() });
        } else if let Some(entity) = entities.last_mut() {
            entity.pairs.push(Pair { code, value, line: k + 1 });
        }
    }
    Ok(entities)
}

/// The entities between BLOCK (included) and ENDBLK.
fn blocks<'e, 'a>(entities: &'e [Entity<'a>]) -> Vec<&'e [Entity<'a>]> {
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
fn stated_unit(entities: &[Entity]) -> Option<f64> {
    let said = entities.iter().filter(|e| e.kind == "TEXT").filter_map(|e| after(e.value(1)?, "units:"));
    for words in said {
        match words.to_ascii_uppercase().as_str() {
            "METRIC" | "MM" => return Some(1e-3),
            "ENGLISH" | "IMPERIAL" | "INCH" | "INCHES" => return Some(0.0254),
            "CM" => return Some(1e-2),
            _ => {}
        }
    }
    // $INSUNITS stands among the pairs of the HEADER section.
    let header = entities.iter().flat_map(|e| e.pairs.windows(2));
    let code = header.filter(|w| w[0].value == "$INSUNITS").map(|w| w[1].value).next()?;
    match code.trim() {
        "1" => Some(0.0254),
        "4" => Some(1e-3),
        "5" => Some(1e-2),
        "6" => Some(1.0),
        _ => None,
    }
}

/// What follows a key at the start of a text, in any case: `Piece Name: FRONT`.
fn after<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let head = text.get(..key.len())?;
    head.eq_ignore_ascii_case(key).then(|| text[key.len()..].trim())
}

/// What a block holds, by layer.
struct Block<'a> {
    name: &'a str,
    lines: Vec<(u32, Path)>,
    points: Vec<(u32, Vec2)>,
    texts: Vec<&'a str>,
}

impl<'a> Block<'a> {
    fn new(entities: &[Entity<'a>], unit: f64) -> Result<Self, DxfError> {
        let mut block = Self {
            name: entities.first().and_then(|e| e.value(2)).unwrap_or(""),
            lines: Vec::new(),
            points: Vec::new(),
            texts: Vec::new(),
        };
        let mut rest = entities.iter().skip(1);
        while let Some(entity) = rest.next() {
            let on = entity.layer();
            match entity.kind {
                "POLYLINE" => {
                    let mut points = Vec::new();
                    for vertex in rest.by_ref().take_while(|e| e.kind != "SEQEND") {
                        points.extend(vertex.points(10, unit)?.first());
                    }
                    block.add_line(on, points, is_closed(entity));
                }
                "LWPOLYLINE" => block.add_line(on, entity.points(10, unit)?, is_closed(entity)),
                "LINE" => {
                    let ends = [entity.points(10, unit)?, entity.points(11, unit)?].concat();
                    block.add_line(on, ends, false);
                }
                // Drill holes come as either.
                "POINT" | "CIRCLE" => {
                    let at = entity.points(10, unit)?;
                    block.points.extend(on.zip(at.first().copied()));
                }
                "TEXT" | "MTEXT" => block.texts.extend(entity.value(1)),
                _ => {}
            }
            if block.lines.len() > MOST_LINES {
                return Err(DxfError::TooMany { block: shown(block.name, SHOWN), most: MOST_LINES });
            }
        }
        Ok(block)
    }

    fn add_line(&mut self, on: Option<u32>, mut points: Vec<Vec2>, closed: bool) {
        if closed {
            points.extend(points.first().copied());
        }
        points.dedup_by(|b, a| (*b - *a).norm() < 1e-8);
        if let Some(on) = on.filter(|_| points.len() > 1) {
            self.lines.push((on, Path::polyline(&points)));
        }
    }

    fn on(&self, layer: u32) -> Vec<((), Path)> {
        self.lines.iter().filter(|l| l.0 == layer).map(|l| ((), l.1.clone())).collect()
    }

    /// The lines of a layer, joined where they meet; the longest run first.
    fn runs(&self, layer: u32) -> Vec<Vec<((), Path)>> {
        let mut runs = chained(&self.on(layer));
        let length = |run: &Vec<((), Path)>| run.iter().map(|r| r.1.length()).sum::<f64>();
        runs.sort_by(|a, b| length(b).total_cmp(&length(a)));
        runs
    }

    fn text(&self, key: &str) -> Option<&'a str> {
        self.texts.iter().find_map(|t| after(t, key)).filter(|t| !t.is_empty())
    }

    fn piece(&self) -> Option<Traced> {
        let mirror = self.ends_on(layer::MIRROR);
        let boundary = self.runs(layer::BOUNDARY).into_iter().next()?;
        let cut = closed_by(boundary).into_iter().map(|e| e.1).reduce(|a, b| a.joined(&b))?;
        if cut.double_area() == 0.0 {
            return None;
        }
        let sew = self.runs(layer::SEW).into_iter().next().unwrap_or_default();
        let sew = closed_by(sew);
        let whole_line = |run: Vec<((), Path)>| run.into_iter().map(|e| e.1).reduce(|a, b| a.joined(&b));
        let holes: Vec<Path> = self.runs(layer::CUTOUT).into_iter().filter_map(whole_line).collect();
        let at = |layer: u32| self.points.iter().filter(|p| p.0 == layer).map(|p| p.1).collect::<Vec<Vec2>>();
        let notches = |layer: u32| {
            let shapes: Vec<Path> = self.runs(layer).into_iter().filter_map(whole_line).collect();
            dxf_notches::notches(at(layer), &shapes, &cut)
        };
        let notches = dxf_notches::LAYERS.into_iter().flat_map(notches).collect();
        Some(Traced {
            name: self.text("piece name:").unwrap_or(self.name).to_owned(),
            sew: sew.into_iter().map(|e| (None, e.1)).collect(),
            holes: holes.into_iter().filter(|h| h.double_area().abs() > 0.0).collect(),
            lines: self.on(layer::INTERNAL).into_iter().map(|l| Inner { name: None, path: l.1, kind: None }).collect(),
            points: at(layer::DRILL),
            grain: self.ends_on(layer::GRAIN),
            notches,
            mirror,
            cut: Some(cut),
            cut_how: self.text("quantity:").and_then(quantity),
            said_by: None,
            drawn: None,
            fabric: self.text("material:").map(str::to_owned),
        })
    }

    /// The ends of the longest line of a layer.
    fn ends_on(&self, layer: u32) -> Option<[Vec2; 2]> {
        let longest = |a: &((), Path), b: &((), Path)| a.1.length().total_cmp(&b.1.length());
        self.on(layer).into_iter().max_by(longest).map(|l| [l.1.start(), l.1.end()])
    }
}

fn is_closed(entity: &Entity) -> bool {
    entity.value(70).and_then(|v| v.parse::<u32>().ok()).is_some_and(|flags| flags & 1 == 1)
}

/// The run with its last side, which a half piece has on its mirror line.
fn closed_by(mut run: Vec<((), Path)>) -> Vec<((), Path)> {
    let (Some(start), Some(end)) = (run.first().map(|r| r.1.start()), run.last().map(|r| r.1.end())) else {
        return run;
    };
    if (start - end).norm() > 1e-8 {
        run.push(((), Path::line(end, start)));
    }
    run
}

/// `1,1` is one as drawn and one mirrored; `2,0` or `2` two as drawn.
fn quantity(text: &str) -> Option<Cut> {
    let mut counts = text.split([',', ';', '/']).map(|w| w.trim().parse::<usize>());
    let plain = counts.next()?.ok()?;
    let mirrored = counts.next().and_then(Result::ok).unwrap_or(0);
    match (plain, mirrored) {
        (1, 1) => Some(Cut::Pair),
        (n @ 2..=100, 0) => Some(Cut::Count(n)),
        _ => None,
    }
}
