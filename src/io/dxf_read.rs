//! DXF-AAMA (ASTM D6673) in: a piece per block, lines by the standard's layers (see [`layer`]).
//!
//! Text files of any release are read as pairs of a group code and a value; of what they hold, polylines (with their
//! arcs), lines, arcs, points and texts of blocks count; what else is on a pattern's layers is said to be left out.
//! Blocks without a boundary are skipped, for programs add some of their own.

use std::path::Path as FilePath;

use super::dxf_left_out::LeftOut;
use super::dxf_notches;
use super::dxf_text::{Entity, after, assumed_unit, blocks, entities, letters, stated_unit};
use super::dxf_told::{Told, is_on_slit, read_notch, told_of};
use super::dxf_write::layer;
use crate::digitize::{Drawing, Inner, Material, Notch, ToldNotch, Traced, besides, chained, holes};
use crate::geometry::{Path, Vec2, bulged};
use crate::input::{InputError, bytes, shown};
use crate::pattern::{Corner, Cut, Side};

/// Larger files are not patterns.
const MOST_BYTES: u64 = 30 << 20;
/// More lines in a block than this cannot be looked at one against the other.
const MOST_LINES: usize = 5_000;
/// Texts that tell of notches that are read of a block, for each is looked for on every notch.
const MOST_TOLD: usize = 5_000;
/// Letters of a style's name that are read.
const TITLE: usize = 200;
/// Letters of a text that messages show.
pub(super) const SHOWN: usize = 40;

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
    /// A line without its end: what follows it would be lost.
    #[error("line {line}: the POLYLINE that begins here has no SEQEND after its VERTEXes; export the file again")]
    Unended {
        /// From 1.
        line: usize,
    },
    /// No block is a piece.
    #[error(
        "no block has a boundary on layer 1, so this is not a DXF-AAMA (ASTM D6673) pattern; \
         layers found: {layers}; export it as AAMA or ASTM, or as SVG{besides}"
    )]
    NoPieces {
        /// Those there are.
        layers: String,
        /// What was left out, which may be the reason.
        besides: String,
    },
}

/// Reads the pieces of a DXF file; `unit` is metres per drawing unit in place of what the file says; without it that
/// counts, else millimetres.
///
/// # Errors
/// [`DxfError`].
pub fn read_dxf(path: &FilePath, unit: Option<f64>) -> Result<Drawing, DxfError> {
    read_dxf_text(&String::from_utf8_lossy(&bytes(path, MOST_BYTES)?), unit)
}

/// Reads the pieces of a DXF text.
///
/// # Errors
/// As [`read_dxf`].
pub fn read_dxf_text(text: &str, unit: Option<f64>) -> Result<Drawing, DxfError> {
    let entities = entities(text)?;
    let stated = unit.or_else(|| stated_unit(&entities));
    let (unit, notes) = stated.map_or_else(|| assumed_unit(&entities), |unit| (unit, Vec::new()));
    let (mut pieces, mut unread) = (Vec::new(), LeftOut::default());
    for block in blocks(&entities) {
        pieces.extend(Block::new(block, unit, &mut unread)?.piece());
    }
    let left_out = unread.sentences();
    if pieces.is_empty() {
        let mut layers: Vec<&str> = entities.iter().filter_map(|e| e.value(8)).collect();
        layers.sort_unstable();
        layers.dedup();
        let layers = shown(&layers.join(", "), 4 * SHOWN);
        return Err(DxfError::NoPieces { layers, besides: besides(&left_out) });
    }
    Ok(Drawing { title: title(&entities), pieces, left_out, notes })
}

/// The style's name.
fn title(entities: &[Entity]) -> Option<String> {
    let mut texts = entities.iter().filter(|e| e.kind == "TEXT").filter_map(|e| e.value(1));
    let name = texts.find_map(|words| after(words, "style name:").filter(|name| !name.is_empty()))?;
    Some(shown(&letters(name), TITLE))
}

/// What a block holds, by layer.
struct Block<'a> {
    name: &'a str,
    lines: Vec<(u32, Path)>,
    points: Vec<Point>,
    texts: Vec<Text>,
}

/// A place on a layer.
#[derive(Clone, Copy)]
struct Point {
    on: u32,
    at: Vec2,
    /// Direction and depth of the slit that begins there, if it is a notch's.
    into: Vec2,
}

/// Words and where they stand.
struct Text {
    words: String,
    at: Option<Vec2>,
}

impl<'a> Block<'a> {
    fn new(entities: &[Entity<'a>], unit: f64, left_out: &mut LeftOut<'a>) -> Result<Self, DxfError> {
        let mut block = Self {
            name: entities.first().and_then(|e| e.value(2)).unwrap_or(""),
            lines: Vec::new(),
            points: Vec::new(),
            texts: Vec::new(),
        };
        let mut rest = entities.iter().skip(1);
        while let Some(entity) = rest.next() {
            block.read(entity, &mut rest, unit, left_out)?;
            if block.lines.len() > MOST_LINES {
                return Err(DxfError::TooMany { block: shown(block.name, SHOWN), most: MOST_LINES });
            }
        }
        Ok(block)
    }

    /// Takes up an entity, with those of `rest` that belong to it.
    fn read<'e>(
        &mut self,
        entity: &Entity<'a>,
        rest: &mut impl Iterator<Item = &'e Entity<'a>>,
        unit: f64,
        left_out: &mut LeftOut<'a>,
    ) -> Result<(), DxfError>
    where
        'a: 'e,
    {
        let on = entity.layer();
        match entity.kind {
            "POLYLINE" => self.add_line(on, entity.as_seen(polyline(entity, rest, unit)?), is_closed(entity)),
            "LWPOLYLINE" => self.add_line(on, entity.as_seen(entity.vertices(10, unit)?), is_closed(entity)),
            "ARC" => self.add_line(on, entity.as_seen(entity.arc(unit)?), false),
            "LINE" => {
                let ends = [entity.points(10, unit)?, entity.points(11, unit)?].concat();
                self.add_line(on, ends.into_iter().map(|p| (p, 0.0)).collect(), false);
            }
            // Drill holes come as either. A circle that is a line is not read.
            "CIRCLE" if !on.is_some_and(is_mark) => left_out.add(entity),
            "POINT" => {
                let into = entity.slit(unit);
                let at = entity.points(10, unit)?.first().copied();
                self.points.extend(on.zip(at).map(|(on, at)| Point { on, at, into }));
            }
            "CIRCLE" => {
                let at = entity.as_seen(entity.vertices(10, unit)?);
                let point = |(on, at): (u32, &(Vec2, f64))| Point { on, at: at.0, into: Vec2::zeros() };
                self.points.extend(on.zip(at.first()).map(point));
            }
            "TEXT" | "MTEXT" => {
                // Where a text stands matters for our own alone.
                let at = entity.points(10, unit).ok().and_then(|at| at.first().copied());
                self.texts.extend(entity.value(1).map(|words| Text { words: letters(words), at }));
            }
            _ => left_out.add(entity),
        }
        Ok(())
    }

    /// Adds a line by its vertices, each with the bulge of the arc to the next.
    fn add_line(&mut self, on: Option<u32>, mut vertices: Vec<(Vec2, f64)>, closed: bool) {
        if closed {
            vertices.extend(vertices.first().copied());
        }
        // Of vertices in one place the first stays, with the arc that leads on from the last.
        vertices.dedup_by(|b, a| {
            let one = (b.0 - a.0).norm() < 1e-8;
            if one {
                a.1 = b.1;
            }
            one
        });
        if let Some(on) = on.filter(|_| vertices.len() > 1) {
            self.lines.push((on, bulged(&vertices)));
        }
    }

    fn on(&self, layer: u32) -> Vec<((), Path)> {
        self.lines.iter().filter(|l| l.0 == layer).map(|l| ((), l.1.clone())).collect()
    }

    /// The lines of a layer, joined where they meet; the longest run first.
    fn runs(&self, layer: u32) -> Vec<Vec<((), Path)>> {
        longest_first(chained(&self.on(layer)))
    }

    fn text(&self, key: &str) -> Option<&str> {
        self.texts.iter().find_map(|t| after(&t.words, key)).filter(|t| !t.is_empty())
    }

    fn material(&self) -> Option<Material> {
        let cloth = self.text("fabric:").map(str::to_owned);
        self.text("material:").map(|name| Material { name: name.to_owned(), cloth })
    }

    /// The lines that may be told of, each with what is told of it.
    fn told(&self) -> Vec<(u32, &Path, Option<Told>)> {
        let texts: Vec<(Told, Vec2)> = self.texts.iter().filter_map(|t| Some((Told::read(&t.words)?, t.at?))).collect();
        let lines = self.lines.iter().filter(|(on, _)| [layer::SEW, layer::INTERNAL].contains(on));
        lines.map(|(on, path)| (*on, path, told_of(path, &texts).cloned())).collect()
    }

    fn piece(&self) -> Option<Traced> {
        let mirror = self.ends_on(layer::MIRROR);
        let boundary = self.runs(layer::BOUNDARY).into_iter().next()?;
        let cut = closed_by(boundary, ()).into_iter().map(|e| e.1).reduce(|a, b| a.joined(&b))?;
        if cut.double_area() == 0.0 {
            return None;
        }
        let told = self.told();
        let mut sewn = self.sewn(&told).into_iter();
        let sew = sewn.next().unwrap_or_default();
        // Where edges have names, so has the one on the fold.
        let on_fold = sew.first().and_then(|(name, _)| name.as_ref().map(|_| "fold".to_owned()));
        let sew = closed_by(sew, on_fold);
        let whole_line = |run: Vec<((), Path)>| whole(run).map(|(_, path)| path);
        let is_ring = |(_, line): &Named| (line.start() - line.end()).norm() < 1e-8 && line.double_area() != 0.0;
        let cut_out = self.runs(layer::CUTOUT).into_iter().filter_map(whole_line).filter(|h| h.double_area() != 0.0);
        let holes = holes(cut_out.collect(), sewn.filter_map(whole).filter(is_ring).collect());
        let notches = self.notches(&cut);
        Some(Traced {
            name: self.text("piece name:").unwrap_or(self.name).to_owned(),
            sew,
            holes,
            lines: told.iter().filter_map(inner).collect(),
            points: self.points_on(layer::DRILL).map(|p| p.at).collect(),
            grain: self.ends_on(layer::GRAIN),
            notches,
            pleats: pleats(&told),
            mirror,
            cut: Some(cut),
            cut_how: self.text("quantity:").and_then(quantity),
            on_fold: None,
            said_by: None,
            drawn: self.text("drawn:").and_then(Side::from_letter).filter(|side| *side == Side::Right),
            material: self.material(),
            corners: told.iter().filter_map(corner).collect(),
        })
    }

    /// The sewing lines, joined where they meet: the outline, then those of holes. Where edges are told, they are these
    /// alone: what else is on the layer are seams over the mouths of darts.
    fn sewn(&self, told: &[(u32, &Path, Option<Told>)]) -> Vec<Vec<Named>> {
        let edge = |(_, path, told): &(u32, &Path, Option<Told>)| match told {
            Some(Told::Edge(name, _)) => Some((Some(name.clone()), (*path).clone())),
            _ => None,
        };
        let mut edges: Vec<Named> = told.iter().filter_map(edge).collect();
        if edges.is_empty() {
            edges = self.on(layer::SEW).into_iter().map(|(_, path)| (None, path)).collect();
        }
        longest_first(chained(&edges))
    }

    fn points_on(&self, layer: u32) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(move |p| p.on == layer)
    }

    /// The notches of all layers, as points and as lines.
    fn notches(&self, cut: &Path) -> Vec<Notch> {
        let texts = self.texts.iter().filter_map(|t| Some((read_notch(&t.words)?, t.at?)));
        let mut texts: Vec<(ToldNotch, Vec2)> = texts.take(MOST_TOLD).collect();
        let mut notches = Vec::new();
        for layer in dxf_notches::LAYERS {
            let points: Vec<Vec2> = self.points_on(layer).map(|p| p.at).collect();
            notches.extend(self.points_on(layer).map(|point| notch(point, &mut texts)));
            let shapes: Vec<Path> = self.runs(layer).into_iter().filter_map(whole).map(|(_, path)| path).collect();
            let drawn = dxf_notches::drawn(&points, &shapes, cut);
            notches.extend(drawn.into_iter().map(|at| Notch { at, told: None }));
        }
        notches
    }

    /// The ends of the longest line of a layer.
    fn ends_on(&self, layer: u32) -> Option<[Vec2; 2]> {
        let longest = |a: &((), Path), b: &((), Path)| a.1.length().total_cmp(&b.1.length());
        self.on(layer).into_iter().max_by(longest).map(|l| [l.1.start(), l.1.end()])
    }
}

/// The notch of a point: where it meets the sewing line, if one of these texts tells that. Each tells of one notch, and
/// they stand in the order of these.
fn notch(point: &Point, texts: &mut Vec<(ToldNotch, Vec2)>) -> Notch {
    match texts.iter().position(|(_, at)| is_on_slit(*at, point.at, point.into)) {
        Some(k) => {
            let (told, at) = texts.remove(k);
            Notch { at, told: Some(told) }
        }
        None => Notch { at: point.at, told: None },
    }
}

/// Flags of a polyline that ends where it begins, and of a vertex that only controls a spline.
const CLOSED: u32 = 1;
const SPLINE_CONTROL: u32 = 16;

/// The vertices that follow a POLYLINE, each with its bulge.
fn polyline<'e, 'a: 'e>(
    entity: &Entity<'a>,
    rest: &mut impl Iterator<Item = &'e Entity<'a>>,
    unit: f64,
) -> Result<Vec<(Vec2, f64)>, DxfError> {
    let mut vertices = Vec::new();
    loop {
        match rest.next() {
            // A curve fitted to others leaves these, which it does not run through, beside its own.
            Some(vertex) if vertex.kind == "VERTEX" && vertex.flags() & SPLINE_CONTROL != 0 => {}
            Some(vertex) if vertex.kind == "VERTEX" => vertices.extend(vertex.vertices(10, unit)?.first()),
            Some(end) if end.kind == "SEQEND" => return Ok(vertices),
            _ => return Err(DxfError::Unended { line: entity.line }),
        }
    }
}

/// Whether what is on a layer are places rather than lines.
fn is_mark(on: u32) -> bool {
    on == layer::DRILL || dxf_notches::LAYERS.contains(&on)
}

fn is_closed(entity: &Entity) -> bool {
    entity.flags() & CLOSED != 0
}

/// An edge that may have a name.
type Named = (Option<String>, Path);

fn longest_first<T>(mut runs: Vec<Vec<(T, Path)>>) -> Vec<Vec<(T, Path)>> {
    let length = |run: &Vec<(T, Path)>| run.iter().map(|r| r.1.length()).sum::<f64>();
    runs.sort_by(|a, b| length(b).total_cmp(&length(a)));
    runs
}

/// A run as one line, under the name of its first.
fn whole<T>(run: Vec<(T, Path)>) -> Option<(T, Path)> {
    run.into_iter().reduce(|(name, path), (_, next)| (name, path.joined(&next)))
}

/// The run with its last side, which a half piece has on its mirror line.
fn closed_by<T>(mut run: Vec<(T, Path)>, side: T) -> Vec<(T, Path)> {
    let (Some(start), Some(end)) = (run.first().map(|r| r.1.start()), run.last().map(|r| r.1.end())) else {
        return run;
    };
    if (start - end).norm() > 1e-8 {
        run.push((side, Path::line(end, start)));
    }
    run
}

/// How the allowance of an edge ends, where that is told.
fn corner((.., told): &(u32, &Path, Option<Told>)) -> Option<(String, Corner)> {
    match told {
        Some(Told::Edge(name, Some(corner))) => Some((name.clone(), *corner)),
        _ => None,
    }
}

/// A line inside that is neither an edge nor a pleat's.
fn inner((on, path, told): &(u32, &Path, Option<Told>)) -> Option<Inner> {
    let (name, kind) = match told {
        None if *on == layer::INTERNAL => (None, None),
        Some(Told::Line(name, kind)) => (Some(name.clone()), Some(kind.clone())),
        _ => return None,
    };
    Some(Inner { name, path: (*path).clone(), kind })
}

/// Where pleats begin on the edge; the line of each fold is followed by that of its place.
fn pleats(told: &[(u32, &Path, Option<Told>)]) -> Vec<[Vec2; 2]> {
    let begins =
        |wanted: Told| told.iter().filter(move |t| t.2.as_ref() == Some(&wanted)).map(|(_, path, _)| path.start());
    begins(Told::PleatFold).zip(begins(Told::PleatPlace)).map(|(fold, place)| [fold, place]).collect()
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
