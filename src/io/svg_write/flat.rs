//! `pattern.svg`: the flat pieces at full size, to print, plot or cut.

use svg::node::element::{Group, Path, Text};
use svg::{Document, Node};

use super::{centered, curved, document, identifier, polyline, square, told_notch, with_kind};
use crate::cutting::{LETTER_WIDTH, Room, TEST_SQUARE, arrow, foot, shelves};
use crate::geometry::{MM, Vec2, box_or_origin, smooth_curves};
use crate::mesh::{ClothMesh, EdgeParticles, PieceMesh};
use crate::pattern::{Notch, NotchKind};

/// Empty rim of the sheet, mm: what home printers leave white.
const MARGIN: f64 = 10.0;
/// Space between pieces, mm: room for two seam allowances.
const GAP: f64 = 30.0;
/// Share of the piece's height that its grain line takes, and its longest, mm.
const GRAIN: (f64, f64) = (0.4, 250.0);
/// Barbs of the grain arrow, mm.
const BARB: f64 = 6.0;
/// Height of letters, and the least that home printers draw clearly, mm.
const LETTERS: f64 = 8.0;
const LEAST_LETTERS: f64 = 2.5;
/// Depth of a notch, mm.
const NOTCH: f64 = 6.0;

/// How far a particle may be from the smooth outline, mm: less than a pencil line is wide.
const SMOOTH: f64 = 0.1;

/// Why a pattern could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PatternSvgError {
    /// Positions of another mesh.
    #[error("{found} flat positions for {expected} particles")]
    Positions {
        /// Particles of the mesh.
        expected: usize,
        /// Positions given.
        found: usize,
    },
    /// A position that is infinite or not a number.
    #[error("particle {0} has no finite flat position")]
    NotFinite(usize),
}

/// Draws the pieces of a cloth at their flat positions (metres, one per particle; `cloth.flat` draws the pattern as it
/// was). Pieces lie side by side without touching, their warp upright, the right side of the cloth up. `notches` are
/// the garment's; a notch on an edge that the mesh does not have is left out.
///
/// Group ids are piece names, path ids `piece.edge`; classes are `piece`, `edge`, `line`, `grain`, `notch`, `text` and
/// `scale`. Where `flat` is not the pattern as it was, that lies below, dashed, in a group `drawn` of its own: each
/// piece as the flat one has been laid onto it.
///
/// # Errors
/// Positions that do not belong to the mesh or are not finite.
pub fn pattern_svg(cloth: &ClothMesh, flat: &[Vec2], notches: &[Notch]) -> Result<String, PatternSvgError> {
    let Begun { sheets, square, mut document } = begin(cloth, flat)?;
    if flat != cloth.flat {
        let drawn = Group::new().set("id", "drawn").set("class", "layer").set("fill", "none");
        document = document.add(sheets.iter().flat_map(SheetPiece::outline).fold(drawn, Group::add));
    }
    for sheet in &sheets {
        document = document.add(sheet.draw(&cloth.flat, notches));
    }
    Ok(document.add(square).to_string())
}

/// Draws the outlines as [`pattern_svg`] lays them out, every edge as few smooth curves that its particles are no
/// further from than 0.1 mm: to edit, where hundreds of points are in the way. The path ids are the same.
///
/// # Errors
/// As [`pattern_svg`].
pub fn outline_svg(cloth: &ClothMesh, flat: &[Vec2]) -> Result<String, PatternSvgError> {
    let Begun { sheets, square, document } = begin(cloth, flat)?;
    Ok(sheets.iter().map(SheetPiece::curves).fold(document, Document::add).add(square).to_string())
}

/// A drawing before its pieces are drawn.
struct Begun<'a> {
    /// The pieces where they lie.
    sheets: Vec<SheetPiece<'a>>,
    /// The square to measure after printing.
    square: Group,
    /// Of the right size, and empty.
    document: Document,
}

fn begin<'a>(cloth: &'a ClothMesh, flat: &[Vec2]) -> Result<Begun<'a>, PatternSvgError> {
    if flat.len() != cloth.flat.len() {
        return Err(PatternSvgError::Positions { expected: cloth.flat.len(), found: flat.len() });
    }
    if let Some(v) = flat.iter().position(|p| !(p.x.is_finite() && p.y.is_finite())) {
        return Err(PatternSvgError::NotFinite(v));
    }
    let mut sheets: Vec<SheetPiece<'_>> =
        cloth.pieces.iter().map(|piece| SheetPiece::new(piece, flat, &cloth.flat)).collect();
    let side = Vec2::repeat(TEST_SQUARE * MM);
    let sizes: Vec<Vec2> = sheets.iter().map(SheetPiece::size).chain([side]).collect();
    let (corners, size) = shelves(&sizes, None, GAP);
    let margin = Vec2::repeat(MARGIN);
    for (sheet, corner) in sheets.iter_mut().zip(&corners) {
        sheet.put(corner + margin);
    }
    let square = square(corners[sheets.len()] + margin, LETTERS);
    Ok(Begun { sheets, square, document: document(size + 2.0 * margin) })
}

/// A piece in millimetres on the sheet.
struct SheetPiece<'a> {
    piece: &'a PieceMesh,
    /// Of its particles.
    points: Vec<Vec2>,
    /// The same as drawn, where they lie on the sheet.
    drawn: Vec<Vec2>,
    /// Warp on the sheet: up or down.
    warp: Vec2,
    /// Upper left and lower right corner of its box.
    corners: [Vec2; 2],
}

impl<'a> SheetPiece<'a> {
    /// Turns the piece so that its warp is upright, by the smaller angle.
    fn new(piece: &'a PieceMesh, flat: &[Vec2], drawn: &[Vec2]) -> Self {
        let up = if piece.warp.y > 0.0 { -piece.warp } else { piece.warp };
        // The rotation that takes `up` to (0, −1).
        let turn = |p: Vec2| Vec2::new(-up.y * p.x + up.x * p.y, -up.x * p.x - up.y * p.y);
        let placed = |at: &[Vec2]| at[piece.particles.clone()].iter().map(|&p| turn(p) * MM).collect();
        let (points, drawn) = (placed(flat), placed(drawn));
        let mut sheet = Self { piece, points, drawn, warp: turn(piece.warp), corners: [Vec2::zeros(); 2] };
        sheet.corners = sheet.bounds();
        sheet
    }

    fn bounds(&self) -> [Vec2; 2] {
        box_or_origin(self.points.iter().copied())
    }

    fn size(&self) -> Vec2 {
        self.corners[1] - self.corners[0]
    }

    /// Moves the upper left corner of the box.
    fn put(&mut self, corner: Vec2) {
        let shift = corner - self.corners[0];
        for p in self.points.iter_mut().chain(&mut self.drawn) {
            *p += shift;
        }
        self.corners = self.corners.map(|c| c + shift);
    }

    fn at(&self, particle: u32) -> Option<Vec2> {
        self.points.get((particle as usize).checked_sub(self.piece.particles.start)?).copied()
    }

    fn polyline(&self, particles: &[u32]) -> Vec<Vec2> {
        particles.iter().filter_map(|&v| self.at(v)).collect()
    }

    fn draw(&self, drawn: &[Vec2], notches: &[Notch]) -> Group {
        let name = identifier(&self.piece.name);
        let mut group = Group::new().set("id", name.as_str()).set("class", "piece").set("fill", "none");
        for edge in &self.piece.edges {
            let id = format!("{name}.{}", identifier(&edge.name));
            group = group.add(polyline(&self.polyline(&edge.particles), "edge", 0.5).set("id", id));
        }
        for line in &self.piece.lines {
            let id = format!("{name}.{}", identifier(&line.name));
            let path = polyline(&self.polyline(&line.particles), "line", 0.3);
            group = group.add(with_kind(path, &line.kind).set("id", id).set("stroke-dasharray", "4 2"));
        }
        let own = |n: &Notch| self.piece.edges.iter().find(|e| e.edge == n.edge).map(|edge| self.notch(edge, drawn, n));
        let mut lines = Vec::new();
        for (line, kind, edge) in notches.iter().filter_map(own).flatten() {
            group = group.add(told_notch(polyline(&line, "notch", 0.3), kind, edge));
            lines.push(line);
        }
        let [grain, label] = self.grain_and_label(&lines);
        group.add(grain).add(label)
    }

    /// The edges as smooth curves.
    fn curves(&self) -> Group {
        let name = identifier(&self.piece.name);
        let mut group = Group::new().set("id", name.as_str()).set("class", "piece").set("fill", "none");
        for edge in &self.piece.edges {
            let id = format!("{name}.{}", identifier(&edge.name));
            let curves = smooth_curves(&self.polyline(&edge.particles), SMOOTH);
            group = group.add(curved(&curves, "edge", 0.5).set("id", id));
        }
        let [grain, label] = self.grain_and_label(&[]);
        group.add(grain).add(label)
    }

    /// The edges and inner lines as they were drawn.
    fn outline(&self) -> Vec<Path> {
        let first = self.piece.particles.start;
        let at = |&v: &u32| self.drawn.get((v as usize).checked_sub(first)?).copied();
        let line = |particles: &Vec<u32>| {
            let points: Vec<Vec2> = particles.iter().filter_map(at).collect();
            polyline(&points, "drawn", 0.3).set("stroke", "gray").set("stroke-dasharray", "2 2")
        };
        let edges = self.piece.edges.iter().map(|e| &e.particles);
        edges.chain(self.piece.lines.iter().map(|l| &l.particles)).map(line).collect()
    }

    /// The cloth, for finding room on it, and its lines.
    fn room(&self) -> Room {
        let mut room = Room::default();
        let mut ring = None;
        for edge in &self.piece.edges {
            let points = self.polyline(&edge.particles);
            room.add_wall(&points);
            if ring.replace(edge.edge.ring) != Some(edge.edge.ring) {
                room.contours.push(Vec::new());
            }
            room.contours.iter_mut().last().into_iter().for_each(|contour| contour.extend(&points));
        }
        for line in &self.piece.lines {
            room.add_wall(&self.polyline(&line.particles));
        }
        room
    }

    /// The grain's arrow on the cloth, and the piece's name clear of every line.
    fn grain_and_label(&self, marks: &[[Vec2; 2]]) -> [Box<dyn Node>; 2] {
        let mut room = self.room();
        let grain = arrow(room.arrow(self.grain()), BARB);
        room.add_wall(&grain);
        marks.iter().for_each(|line| room.add_wall(line));
        [Box::new(polyline(&grain, "grain", 0.3)), Box::new(self.label(&room))]
    }

    /// Middle of the particles: on any piece that is not much bent.
    fn middle(&self) -> Vec2 {
        self.points.iter().sum::<Vec2>() / self.points.len().max(1) as f64
    }

    /// Tail and head of an arrow along the warp.
    fn grain(&self) -> [Vec2; 2] {
        let half = self.warp * (GRAIN.0 * self.size().y).min(GRAIN.1) / 2.0;
        [self.middle() - half, self.middle() + half]
    }

    fn label(&self, room: &Room) -> Text {
        let block = Vec2::new(self.piece.name.chars().count().max(1) as f64 * LETTER_WIDTH, 1.0);
        let (middle, height, upright) = room.level_or_turned(block, LETTERS, 1.0);
        let height = height.clamp(LEAST_LETTERS, LETTERS);
        centered(&self.piece.name, middle + foot(height, upright), height, upright)
    }

    /// The marks of a notch from the edge into the piece, each with what it is and the edge's name.
    fn notch<'e>(
        &self,
        edge: &'e EdgeParticles,
        drawn: &[Vec2],
        notch: &Notch,
    ) -> Vec<([Vec2; 2], NotchKind, &'e str)> {
        let at = |v: u32| drawn.get(v as usize).copied().unwrap_or_default();
        let length = edge.particles.windows(2).map(|step| (at(step[1]) - at(step[0])).norm()).sum();
        let mark = |(place, kind): (f64, NotchKind)| {
            let (on_rim, inward) = self.along(edge, drawn, place * MM)?;
            Some(([on_rim, on_rim + inward * NOTCH], kind, edge.name.as_str()))
        };
        NotchKind::marks(notch.at, notch.double, length).filter_map(mark).collect()
    }

    /// Where the drawn distance `wanted` (mm) along an edge has come to lie, and the direction into the piece.
    fn along(&self, edge: &EdgeParticles, drawn: &[Vec2], wanted: f64) -> Option<(Vec2, Vec2)> {
        let mut walked = 0.0;
        let mut found = None;
        for step in edge.particles.windows(2) {
            let length = (drawn.get(step[1] as usize)? - drawn.get(step[0] as usize)?).norm() * MM;
            let (a, b) = (self.at(step[0])?, self.at(step[1])?);
            let share = if length > 0.0 { ((wanted - walked) / length).clamp(0.0, 1.0) } else { 0.0 };
            // The outline runs clockwise on the screen, holes the other way: the piece is to the right.
            let direction = (b - a).try_normalize(0.0)?;
            found = Some((a + (b - a) * share, Vec2::new(-direction.y, direction.x)));
            walked += length;
            if walked >= wanted {
                break;
            }
        }
        found
    }
}
