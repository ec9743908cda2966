//! A block of a DXF file as a piece.

use std::cell::Cell;

use nalgebra::Matrix2;

use super::dxf_curves::{ellipse, spline};
use super::dxf_left_out::LeftOut;
use super::dxf_notches::{self, once};
use super::dxf_read::{DxfError, SHOWN};
use super::dxf_slits::{closes, without_slits};
use super::dxf_text::{Entity, after, letters, lines_of};
use super::dxf_told::{Told, is_on_slit, read_notch, told_of};
use super::dxf_write::layer;
use crate::digitize::{
    Drawing, Inner, Material, Notch, ToldNotch, Traced, bridged, chained, follows, gaping, holes, parts_within,
};
use crate::geometry::{MM, Path, Vec2, box_of, bulged, distance_to_segment, encloses, sides_of};
use crate::input::shown;
use crate::pattern::{Corner, Cut, Side};

/// More lines in a block than this cannot be looked at one against the other.
const MOST_LINES: usize = 5_000;
/// Texts that tell of notches that are read of a block, for each is looked for on every notch.
const MOST_TOLD: usize = 5_000;
/// Blocks within blocks are followed so deep.
const MOST_DEEP: usize = 4;
/// A line ends on the mirror line to this (metres).
const ON_MIRROR: f64 = 1e-3;
/// What is so near to the outline (metres) is on the piece.
const ON_RIM: f64 = 5e-4;
/// A line on layer 1 no longer than this (metres) that ends on the boundary is a notch.
const NOTCH: f64 = 0.016;
/// Chords that stand for curves where only inside and outside is asked.
const COARSE: f64 = 1e-4;
/// Square centimetres in a square metre.
const CM2: f64 = 1e4;

/// Where what is drawn in a block lies: turned, stretched and moved. Metres, y down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    linear: Matrix2<f64>,
    shift: Vec2,
}

impl Placed {
    /// As an INSERT says; its shift counts only within another block.
    fn new(insert: &Entity, unit: f64) -> Option<Self> {
        let number = |code: i32| insert.value(code).map_or(Some(None), |v| v.parse::<f64>().ok().map(Some));
        let scale = [number(41)?.unwrap_or(1.0), number(42)?.unwrap_or(1.0)];
        let turn = number(50)?.unwrap_or(0.0).to_radians();
        let usable = scale.iter().all(|s| s.is_finite() && *s != 0.0 && s.abs() <= 1e4) && turn.is_finite();
        let (sine, cosine) = turn.sin_cos();
        // With y down a turn goes the other way.
        let linear = Matrix2::new(cosine, sine, -sine, cosine) * Matrix2::new(scale[0], 0.0, 0.0, scale[1]);
        let shift = insert.points(10, unit).ok()?.first().copied().unwrap_or_else(Vec2::zeros);
        usable.then_some(Self { linear, shift })
    }

    fn point(&self, p: Vec2) -> Vec2 {
        self.linear * p + self.shift
    }
}

/// The blocks of a file by their names.
pub(super) struct Library<'e, 'a> {
    blocks: &'e [&'e [Entity<'a>]],
    unit: f64,
}

impl<'e, 'a> Library<'e, 'a> {
    pub(super) fn new(blocks: &'e [&'e [Entity<'a>]], unit: f64) -> Self {
        Self { blocks, unit }
    }

    fn named(&self, name: &str) -> Option<&'e [Entity<'a>]> {
        self.blocks.iter().find(|b| b.first().and_then(|e| e.value(2)) == Some(name)).copied()
    }

    /// How the file's own INSERT of a block turns and stretches it; where it puts it is nobody's business.
    pub(super) fn placed(&self, entities: &[Entity], block: &str) -> Option<Placed> {
        let mut inside = false;
        let own = entities.iter().find(|e| {
            inside = match e.kind {
                "BLOCK" => true,
                "ENDBLK" => false,
                _ => inside,
            };
            !inside && e.kind == "INSERT" && e.value(2) == Some(block)
        });
        own.and_then(|insert| Placed::new(insert, self.unit)).map(|p| Placed { shift: Vec2::zeros(), ..p })
    }

    /// What is drawn in a block.
    pub(super) fn block(&self, entities: &'e [Entity<'a>], left_out: &mut LeftOut<'a>) -> Result<Block<'a>, DxfError> {
        self.block_in(entities, left_out, 0)
    }

    /// What is drawn in no block, without what is inserted.
    pub(super) fn loose(&self, entities: &'e [Entity<'a>], left_out: &mut LeftOut<'a>) -> Result<Block<'a>, DxfError> {
        let mut block = Block::named("");
        let mut within = false;
        let mut rest = entities.iter();
        while let Some(entity) = rest.next() {
            match entity.kind {
                "BLOCK" => within = true,
                "ENDBLK" => within = false,
                _ if !within => block.read(entity, &mut rest, self.unit, left_out)?,
                _ => {}
            }
            if block.lines.len() > MOST_LINES {
                return Err(DxfError::TooMany { block: String::new(), most: MOST_LINES });
            }
        }
        Ok(block)
    }

    fn block_in(
        &self,
        entities: &'e [Entity<'a>],
        left_out: &mut LeftOut<'a>,
        depth: usize,
    ) -> Result<Block<'a>, DxfError> {
        let mut block = Block::named(entities.first().and_then(|e| e.value(2)).unwrap_or(""));
        if depth > MOST_DEEP {
            return Err(DxfError::TooDeep { block: shown(block.name, SHOWN), most: MOST_DEEP });
        }
        let mut rest = entities.iter().skip(1);
        while let Some(entity) = rest.next() {
            let inserted = entity.value(2).filter(|_| entity.kind == "INSERT");
            match inserted.and_then(|name| Some((self.named(name)?, Placed::new(entity, self.unit)?))) {
                Some((inner, placed)) => block.take(self.block_in(inner, left_out, depth + 1)?.mapped(Some(placed))),
                None => block.read(entity, &mut rest, self.unit, left_out)?,
            }
            if block.lines.len() > MOST_LINES {
                return Err(DxfError::TooMany { block: shown(block.name, SHOWN), most: MOST_LINES });
            }
        }
        Ok(block)
    }
}

/// What a block holds, by layer.
pub(super) struct Block<'a> {
    name: &'a str,
    lines: Vec<(u32, Path)>,
    points: Vec<Point>,
    /// Where slits ran into its lines or out of them.
    slits: Vec<Vec2>,
    texts: Vec<Text>,
}

/// Layers whose lines are outlines.
const OUTLINES: [u32; 3] = [layer::BOUNDARY, layer::CUTOUT, layer::SEW];

/// A place on a layer.
#[derive(Clone, Copy)]
struct Point {
    on: u32,
    at: Vec2,
    /// Direction and depth of the slit that begins there, if it is a notch's.
    into: Vec2,
}

/// Words and where they stand.
#[derive(Clone)]
struct Text {
    words: String,
    at: Option<Vec2>,
}

impl<'a> Block<'a> {
    fn named(name: &'a str) -> Self {
        let (lines, points, slits, texts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { name, lines, points, slits, texts }
    }

    /// What it is called in the file.
    pub(super) fn name(&self) -> &'a str {
        self.name
    }

    /// As it is inserted.
    pub(super) fn mapped(mut self, placed: Option<Placed>) -> Self {
        let Some(placed) = placed else { return self };
        self.lines.iter_mut().for_each(|(_, path)| *path = path.mapped(placed.linear, placed.shift));
        for point in &mut self.points {
            point.at = placed.point(point.at);
            point.into = placed.linear * point.into;
        }
        self.slits.iter_mut().for_each(|at| *at = placed.point(*at));
        self.texts.iter_mut().for_each(|text| text.at = text.at.map(|at| placed.point(at)));
        self
    }

    /// Takes over what another holds.
    fn take(&mut self, other: Self) {
        self.lines.extend(other.lines);
        self.points.extend(other.points);
        self.slits.extend(other.slits);
        self.texts.extend(other.texts);
    }

    /// Whether it has lines on the layer of boundaries.
    pub(super) fn has_boundary(&self) -> bool {
        self.lines.iter().any(|(on, _)| *on == layer::BOUNDARY)
    }

    /// The closed boundaries that it holds, in the order of the file.
    pub(super) fn boundaries(&self) -> Vec<Path> {
        let closed =
            bridged(chained(&self.on(layer::BOUNDARY))).runs.into_iter().filter_map(whole).map(|(_, path)| path);
        closed.filter(|p| (p.start() - p.end()).norm() < 1e-8 && p.double_area() != 0.0).collect()
    }

    /// What lies in a boundary, which is one of its own.
    pub(super) fn part(&self, boundary: &Path) -> Self {
        let rim = Rim::new(boundary);
        let is_own = |(on, line): &&(u32, Path)| *on != layer::BOUNDARY && rim.holds(line.point(line.length() / 2.0));
        let mut lines = vec![(layer::BOUNDARY, boundary.clone())];
        lines.extend(self.lines.iter().filter(is_own).cloned());
        Self {
            name: "",
            lines,
            points: self.points.iter().filter(|p| rim.holds(p.at)).copied().collect(),
            slits: self.slits.iter().filter(|p| rim.holds(**p)).copied().collect(),
            texts: self.texts.iter().filter(|t| t.at.is_some_and(|at| rim.holds(at))).cloned().collect(),
        }
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
            // Drill holes come as either; on other layers a circle is a line.
            "CIRCLE" if !on.is_some_and(is_mark) => match entity.circle(unit)? {
                Some(vertices) => self.add_line(on, entity.as_seen(vertices), true),
                None => left_out.add(entity),
            },
            "ELLIPSE" | "SPLINE" => {
                let curve = if entity.kind == "SPLINE" { spline(entity, unit)? } else { ellipse(entity, unit)? };
                match curve {
                    Some(curve) => self.lines.extend(on.map(|on| (on, curve))),
                    None => left_out.add(entity),
                }
            }
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
                self.texts.extend(lines_of(entity).into_iter().map(|words| Text { words: letters(&words), at }));
            }
            _ => left_out.add(entity),
        }
        Ok(())
    }

    /// Adds a line by its vertices, each with the bulge of the arc to the next.
    fn add_line(&mut self, on: Option<u32>, mut vertices: Vec<(Vec2, f64)>, closed: bool) {
        if on.is_some_and(|on| OUTLINES.contains(&on)) {
            let closed = closed || closes(&mut vertices);
            self.slits.extend(without_slits(&mut vertices, closed));
            if closed {
                vertices.extend(vertices.first().copied());
            }
        } else if closed {
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

    pub(super) fn text(&self, key: &str) -> Option<&str> {
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

    /// The piece that it is, under the name of its text or the one that is given for its block's; what is wrong with it
    /// and what is left out of it is added to the drawing.
    pub(super) fn piece(&self, stem: Option<&str>, drawing: &mut Drawing) -> Option<Traced> {
        let name = self.text("piece name:").or(stem).or_else(|| self.plain_text()).unwrap_or(self.name).to_owned();
        let saying = Saying { name: &name, said: Cell::new(false) };
        let mirror = self.ends_on(layer::MIRROR);
        let boundary = saying.bridged(self.runs(layer::BOUNDARY), drawing);
        let mut boundary = longest_first(boundary).into_iter();
        let first = boundary.next()?;
        let on_mirror = |ends: [Vec2; 2]| mirror.is_some_and(|mirror| ends.iter().all(|p| is_on(*p, mirror)));
        if closing(&first).is_some_and(|ends| !on_mirror(ends))
            && let Some(outline) = gaping(self.runs(layer::BOUNDARY)).into_iter().next()
        {
            saying.gapes("outline", outline.widest, outline.area(), drawing);
            return None;
        }
        let cut = saying.closed(first, (), mirror, "outline", drawing)?;
        let cut = cut.into_iter().map(|e| e.1).reduce(|a, b| a.joined(&b))?;
        if cut.double_area() == 0.0 {
            return None;
        }
        let told = self.told();
        let mut sewn = self.sewn(&told).into_iter();
        let mut sew = sewn.next().unwrap_or_default();
        let mut inside = told.clone();
        if sew.is_empty()
            && let Some((run, lines)) = self.sewn_inside(&cut, mirror)
        {
            inside.retain(|(_, path, _)| !lines.contains(path));
            sew = run;
        }
        // Where edges have names, so has the one on the fold.
        let on_fold = sew.first().and_then(|(name, _)| name.as_ref().map(|_| "fold".to_owned()));
        let sew = saying.closed(sew, on_fold, mirror, "sewing line", drawing)?;
        let whole_line = |run: Vec<((), Path)>| whole(run).map(|(_, path)| path);
        let is_ring = |(_, line): &Named| (line.start() - line.end()).norm() < 1e-8 && line.double_area() != 0.0;
        let cut_out = self.runs(layer::CUTOUT).into_iter().filter_map(whole_line).filter(|h| h.double_area() != 0.0);
        let holes = holes(cut_out.collect(), sewn.filter_map(whole).filter(is_ring).collect());
        let sewing_line = sew.iter().map(|(_, path)| path.clone()).reduce(|a, b| a.joined(&b));
        let (more, unused) = slit_runs(boundary, &cut);
        saying.left_out(&unused, drawing);
        let mut notches = self.notches(&cut);
        notches.extend(self.slits.iter().chain(&more).map(|&at| Notch { at, told: None }));
        let rim = Rim::new(sewing_line.as_ref().unwrap_or(&cut));
        let lines = saying.clipped(inside.iter().filter_map(inner).collect(), &rim, drawing);
        let points = saying.on_piece(self.points_on(layer::DRILL).map(|p| p.at).collect(), &rim, drawing);
        Some(Traced {
            sew,
            holes,
            lines,
            points,
            grain: self.ends_on(layer::GRAIN),
            notches: once(notches, &cut, sewing_line.as_ref()),
            pleats: pleats(&told),
            mirror,
            cut: Some(cut),
            cut_how: self.text("quantity:").and_then(quantity),
            drawn: self.text("drawn:").and_then(Side::from_letter).filter(|side| *side == Side::Right),
            material: self.material(),
            corners: told.iter().filter_map(corner).collect(),
            name,
            ..Traced::default()
        })
    }

    /// A text that is no statement, as drawings without blocks name their pieces.
    fn plain_text(&self) -> Option<&str> {
        let words = self.texts.iter().map(|t| t.words.trim());
        words.filter(|_| self.name.is_empty()).find(|w| !w.is_empty() && !w.contains(':'))
    }

    /// The sewing line of AAMA, on the layer of inner lines, which follows the cut line all round; and its lines.
    fn sewn_inside(&self, cut: &Path, mirror: Option<[Vec2; 2]>) -> Option<(Vec<Named>, Vec<&Path>)> {
        let lines: Vec<(&Path, Path)> =
            self.lines.iter().filter(|l| l.0 == layer::INTERNAL).map(|l| (&l.1, l.1.clone())).collect();
        let runs = longest_first(bridged(chained(&lines)).runs);
        runs.into_iter().find_map(|run| {
            let lines: Vec<&Path> = run.iter().map(|(line, _)| *line).collect();
            let run: Vec<Named> = run.into_iter().map(|(_, path)| (None, path)).collect();
            let closing = closing(&run);
            let is_closed = closing.is_none_or(|ends| mirror.is_some_and(|m| ends.iter().all(|p| is_on(*p, m))));
            let path = whole(closed_by(run.clone(), None)).map(|(_, path)| path)?;
            (is_closed && follows(&path, cut)).then_some((run, lines))
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
        longest_first(bridged(chained(&edges)).runs)
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

/// Start and end of a run, if they are apart.
fn closing<T>(run: &[(T, Path)]) -> Option<[Vec2; 2]> {
    let ends = [run.last()?.1.end(), run.first()?.1.start()];
    ((ends[0] - ends[1]).norm() > 1e-8).then_some(ends)
}

/// Whether a point is on the line that the mirror line is a part of.
fn is_on(p: Vec2, [from, to]: [Vec2; 2]) -> bool {
    (to - from).try_normalize(0.0).is_some_and(|along| along.perp(&(p - from)).abs() <= ON_MIRROR)
}

/// Of the further runs on the layer of boundaries the notches that they are, and the others.
fn slit_runs(runs: impl Iterator<Item = Vec<((), Path)>>, cut: &Path) -> (Vec<Vec2>, Vec<Path>) {
    let (mut slits, mut rest) = (Vec::new(), Vec::new());
    for line in runs.filter_map(whole).map(|(_, path)| path) {
        let off = [line.start(), line.end()].map(|p| (p, cut.nearest(p).1));
        let near = if off[0].1 <= off[1].1 { off[0] } else { off[1] };
        if line.length() <= NOTCH && line.is_straight() && near.1 <= ON_RIM {
            slits.push(near.0);
        } else {
            rest.push(line);
        }
    }
    (slits, rest)
}

/// An outline of which is asked what lies in it.
struct Rim {
    points: Vec<Vec2>,
    bounds: [Vec2; 2],
}

impl Rim {
    fn new(outline: &Path) -> Self {
        let points = outline.sampled(COARSE);
        Self { bounds: box_of(points.iter().copied()), points }
    }

    /// How far a point is from what it goes round, metres; nought within.
    fn off(&self, p: Vec2) -> f64 {
        if encloses(sides_of(&self.points), p) {
            return 0.0;
        }
        sides_of(&self.points).map(|side| distance_to_segment(p, side)).fold(f64::INFINITY, f64::min)
    }

    /// Whether a point is in it or on it.
    fn holds(&self, p: Vec2) -> bool {
        let [low, high] = self.bounds;
        let beyond = (0..2).any(|k| p[k] < low[k] - ON_RIM || p[k] > high[k] + ON_RIM);
        !beyond && self.off(p) <= ON_RIM
    }
}

/// What there is to say of a piece while it is read.
struct Saying<'n> {
    name: &'n str,
    /// Whether it has been said that ends were joined.
    said: Cell<bool>,
}

impl Saying<'_> {
    /// The runs, joined where they nearly meet.
    fn bridged<T: Clone>(&self, runs: Vec<Vec<(T, Path)>>, drawing: &mut Drawing) -> Vec<Vec<(T, Path)>> {
        let bridged = bridged(runs);
        let widest = bridged.gaps.iter().map(|(_, gap)| *gap).fold(0.0, f64::max);
        if widest > 0.0 && !self.said.replace(true) {
            let name = self.name;
            let widest = MM * widest;
            drawing.notes.push(format!(
                "ends of the outline of '{name}' that do not quite meet, up to {widest:.2} mm apart, are joined"
            ));
        }
        bridged.runs
    }

    /// The run with its last side, which a half piece has on its mirror line; `None` of another that is not closed.
    fn closed<T>(
        &self,
        run: Vec<(T, Path)>,
        side: T,
        mirror: Option<[Vec2; 2]>,
        what: &str,
        drawing: &mut Drawing,
    ) -> Option<Vec<(T, Path)>> {
        let Some(ends) = closing(&run) else { return Some(run) };
        if mirror.is_some_and(|mirror| ends.iter().all(|p| is_on(*p, mirror))) {
            return Some(closed_by(run, side));
        }
        let gap = (ends[0] - ends[1]).norm();
        let area = closed_by(run, side).iter().map(|(_, path)| path.double_area()).sum::<f64>().abs() / 2.0;
        self.gapes(what, ((ends[0] + ends[1]) / 2.0, gap), area, drawing);
        None
    }

    /// Says that a line is not closed, so that the piece is left out.
    fn gapes(&self, what: &str, (at, gap): (Vec2, f64), area: f64, drawing: &mut Drawing) {
        drawing.lost += area;
        drawing.faults.push(format!(
            "the {what} of '{}' is not closed: two of its ends near ({:.1}, {:.1}) mm are {:.2} mm apart; the piece is \
             left out, {:.2} cm² if it were closed there; make its ends meet",
            self.name,
            MM * at.x,
            -MM * at.y,
            MM * gap,
            CM2 * area
        ));
    }

    /// Says that these lines on the layer of boundaries are left out.
    fn left_out(&self, lines: &[Path], drawing: &mut Drawing) {
        let is_ring = |line: &&Path| (line.start() - line.end()).norm() < 1e-8;
        let area: f64 = lines.iter().filter(is_ring).map(|line| line.double_area().abs() / 2.0).sum();
        drawing.lost += area;
        if !lines.is_empty() {
            let count = counted(lines.len(), "further line", "further lines");
            let area = CM2 * area;
            let name = self.name;
            drawing.left_out.push(format!(
                "left out: {count} on the layer of boundaries of '{name}', {area:.2} cm²; a piece has one"
            ));
        }
    }

    /// The parts of lines that are on the piece; those that are told lie where toile drew them.
    fn clipped(&self, lines: Vec<Inner>, rim: &Rim, drawing: &mut Drawing) -> Vec<Inner> {
        let (mut kept, mut shortened, mut gone) = (Vec::new(), 0, 0);
        for line in lines {
            if line.kind.is_some() {
                kept.push(line);
                continue;
            }
            let parts = parts_within(&line.path, |p| rim.off(p));
            match parts.as_slice() {
                [] => gone += 1,
                [whole] if *whole == line.path => {}
                _ => shortened += 1,
            }
            kept.extend(parts.into_iter().map(|path| Inner { path, ..line.clone() }));
        }
        let name = self.name;
        if shortened > 0 {
            let lines = counted(shortened, "line", "lines");
            drawing.left_out.push(format!("left out: the parts of {lines} of '{name}' that lie beyond its outline"));
        }
        if gone > 0 {
            let lines = counted(gone, "line", "lines");
            drawing.left_out.push(format!("left out: {lines} of '{name}' beyond its outline"));
        }
        kept
    }

    /// The drill holes that are on the piece.
    fn on_piece(&self, points: Vec<Vec2>, rim: &Rim, drawing: &mut Drawing) -> Vec<Vec2> {
        let count = points.len();
        let kept: Vec<Vec2> = points.into_iter().filter(|p| rim.holds(*p)).collect();
        if kept.len() < count {
            let holes = counted(count - kept.len(), "drill hole", "drill holes");
            drawing.left_out.push(format!("left out: {holes} of '{}' beyond its outline", self.name));
        }
        kept
    }
}

fn counted(count: usize, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}

/// The run with a straight last side.
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
