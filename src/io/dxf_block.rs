//! The contents of a block of a DXF file, by layer.

use super::dxf_curves::{ellipse, spline};
use super::dxf_error::DxfError;
use super::dxf_left_out::LeftOutEntities;
use super::dxf_library::Placed;
use super::dxf_notches;
use super::dxf_rim::Rim;
use super::dxf_slits::{closes, without_slits};
use super::dxf_text::{Entity, after, letters, lines_of};
use super::dxf_write::layer;
use crate::digitize::{bridged, chained};
use crate::geometry::{Path, Vec2, bulged};

/// The contents of a block, by layer.
pub(super) struct Block<'a> {
    pub(super) name: &'a str,
    pub(super) lines: Vec<(u32, Path)>,
    pub(super) points: Vec<LayerPoint>,
    /// Where slits ran into its lines or out of them.
    pub(super) slits: Vec<Vec2>,
    pub(super) texts: Vec<Text>,
}

/// Layers whose lines are outlines.
const OUTLINES: [u32; 3] = [layer::BOUNDARY, layer::CUTOUT, layer::SEW];

/// A place on a layer.
#[derive(Clone, Copy)]
pub(super) struct LayerPoint {
    pub(super) on: u32,
    pub(super) at: Vec2,
    /// Direction and depth of the slit that begins there, if it is a notch's.
    pub(super) into: Vec2,
}

/// Words and where they stand.
#[derive(Clone)]
pub(super) struct Text {
    pub(super) words: String,
    pub(super) at: Option<Vec2>,
}

impl<'a> Block<'a> {
    pub(super) fn named(name: &'a str) -> Self {
        let (lines, points, slits, texts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { name, lines, points, slits, texts }
    }

    /// Its name in the file.
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
    pub(super) fn take(&mut self, other: Self) {
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

    /// The marks in a boundary that is a block of its own.
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
    pub(super) fn read<'e>(
        &mut self,
        entity: &Entity<'a>,
        rest: &mut impl Iterator<Item = &'e Entity<'a>>,
        unit: f64,
        left_out: &mut LeftOutEntities<'a>,
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
                self.points.extend(on.zip(at).map(|(on, at)| LayerPoint { on, at, into }));
            }
            "CIRCLE" => {
                let at = entity.as_seen(entity.vertices(10, unit)?);
                let point = |(on, at): (u32, &(Vec2, f64))| LayerPoint { on, at: at.0, into: Vec2::zeros() };
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

    pub(super) fn on(&self, layer: u32) -> Vec<((), Path)> {
        self.lines.iter().filter(|l| l.0 == layer).map(|l| ((), l.1.clone())).collect()
    }

    /// The lines of a layer, joined where they meet; the longest run first.
    pub(super) fn runs(&self, layer: u32) -> Vec<Vec<((), Path)>> {
        longest_first(chained(&self.on(layer)))
    }

    pub(super) fn text(&self, key: &str) -> Option<&str> {
        self.texts.iter().find_map(|t| after(&t.words, key)).filter(|t| !t.is_empty())
    }

    pub(super) fn points_on(&self, layer: u32) -> impl Iterator<Item = &LayerPoint> {
        self.points.iter().filter(move |p| p.on == layer)
    }

    /// The ends of the longest line of a layer.
    pub(super) fn ends_on(&self, layer: u32) -> Option<[Vec2; 2]> {
        let longest = |a: &((), Path), b: &((), Path)| a.1.length().total_cmp(&b.1.length());
        self.on(layer).into_iter().max_by(longest).map(|l| [l.1.start(), l.1.end()])
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
pub(super) type Named = (Option<String>, Path);

pub(super) fn longest_first<T>(mut runs: Vec<Vec<(T, Path)>>) -> Vec<Vec<(T, Path)>> {
    let length = |run: &Vec<(T, Path)>| run.iter().map(|r| r.1.length()).sum::<f64>();
    runs.sort_by(|a, b| length(b).total_cmp(&length(a)));
    runs
}

/// A run as one line, under the name of its first.
pub(super) fn whole<T>(run: Vec<(T, Path)>) -> Option<(T, Path)> {
    run.into_iter().reduce(|(name, path), (_, next)| (name, path.joined(&next)))
}
