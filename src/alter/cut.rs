//! A piece cut in two along a style line, with a seam where it was cut.

use super::open::{Bit, Half, chain, darts_whole};
use super::parts::{PartEdge, Parted, rename};
use super::sheet::{AlteredPiece, EdgeMark};
use super::{Fault, laying, name};
use crate::geometry::{Path, Vec2};
use crate::pattern::{CutKind, DartShape, GarmentFile, Located, OutlineFile, PieceFile, Problem, SeamFile};

/// Largest distance of the style line from the chords that stand for it where it is asked what lies beside it, metres.
const CHORD: f64 = 1e-5;

/// Where a piece is cut, and the names of what comes of it.
pub(super) struct StyleLine<'f> {
    /// Ends on the outline.
    pub(super) ends: [&'f Located<String>; 2],
    /// Points that the line passes, in the drawing.
    pub(super) via: &'f [Located<[f64; 2]>],
    /// The new piece.
    pub(super) name: &'f Located<String>,
    /// The seam, and the two edges that it sews. The new piece's name if not given.
    pub(super) seam: Option<&'f Located<String>>,
}

/// One of the two parts: its edges with the stretch of the old one that each is, and whether it is on the fold.
struct PieceHalf {
    piece: String,
    edges: Vec<PartEdge>,
    half: Half,
    has_fold: bool,
}

impl StyleLine<'_> {
    /// Cuts the piece.
    pub(super) fn apply(&self, file: &mut GarmentFile) -> Result<(), Fault> {
        let (index, from) = name::point(file, self.ends[0])?;
        let (other, to) = name::point(file, self.ends[1])?;
        if index != other {
            let [one, other] = [index, other].map(|i| file.pieces[i].name.value.clone());
            return Err((self.ends[1].at, Problem::AlterTwoPieces { what: "cut", one, other }));
        }
        let old = file.pieces[index].name.value.clone();
        // What is like the piece keeps the shape that it has.
        for k in 0..file.pieces.len() {
            if file.pieces[k].like.as_ref().is_some_and(|like| like.value == old) {
                let like = file.pieces[k].name.clone();
                name::piece(file, &like)?;
            }
        }
        let seam = self.seam.unwrap_or(self.name);
        self.check_names(file, &seam.value)?;
        let mut sheet = AlteredPiece::read(file, index)?;
        sheet.fold_by_like(file, index);
        let parts = self.parts(&sheet, [from, to], &file.pieces[index], &seam.value)?;
        let pieces = [0, 1].map(|k| self.written(file, index, &sheet, &parts[k]));
        let [kept, new] = pieces;
        let (kept, new) = (kept?, new?);
        let parted = Parted::new(&old, &sheet, parts.iter().map(|p| (p.piece.as_str(), p.edges.as_slice())));
        file.pieces[index] = kept;
        file.pieces.insert(index + 1, new);
        rename(file, &parted)?;
        let edge = |piece: &str| vec![Located::new(format!("{piece}.{}", seam.value), seam.at)];
        file.seams.insert(0, SeamFile::new(seam.clone(), edge(&old), edge(&self.name.value)));
        Ok(())
    }

    fn check_names(&self, file: &GarmentFile, seam: &str) -> Result<(), Fault> {
        let taken = |at, name: &str| Err((at, Problem::AlterTaken { name: name.to_owned() }));
        if file.pieces.iter().any(|p| p.name.value == self.name.value) {
            return taken(self.name.at, &self.name.value);
        }
        if file.seams.iter().any(|s| s.name.value == seam) {
            return taken(self.seam.unwrap_or(self.name).at, seam);
        }
        Ok(())
    }

    /// The line between two points of the outline.
    fn line(&self, sheet: &AlteredPiece, ends: [Vec2; 2]) -> Path {
        let scale = sheet.unit.factor();
        let mut points = vec![ends[0]];
        points.extend(self.via.iter().map(|p| Vec2::from(p.value) * scale));
        points.push(ends[1]);
        through(&points)
    }

    /// The two parts, that with the fold or the middle of the grain first.
    fn parts(
        &self,
        sheet: &AlteredPiece,
        marks: [EdgeMark; 2],
        piece: &PieceFile,
        seam: &str,
    ) -> Result<[PieceHalf; 2], Fault> {
        let refuse = |at, reason: String| Err((at, Problem::AlterShape { piece: sheet.piece.clone(), reason }));
        let ends = marks.map(|m| sheet.edges[m.edge].point(m.at));
        let line = self.line(sheet, ends);
        let points = line.sampled(CHORD);
        let back: Vec<Vec2> = points.iter().rev().copied().collect();
        let [first, second] = [chain(sheet, marks[0], marks[1]), chain(sheet, marks[1], marks[0])];
        if first.is_empty() || second.is_empty() {
            return refuse(self.ends[1].at, "its style line ends where it begins".to_owned());
        }
        let whole = Half::new(chain_all(sheet), &[]);
        let middle = |i: usize| line.point(line.length() * (i as f64 + 0.5) / INSIDE as f64);
        if (0..INSIDE).any(|i| !whole.contains(middle(i))) {
            return refuse(self.ends[0].at, "the style line leaves it; let it pass other points (via)".to_owned());
        }
        let halves = [Half::new(first, &back), Half::new(second, &points)];
        darts_whole(sheet, &sheet.wedges(piece), None, &marks, &halves[0])?;
        if sheet.names.iter().any(|n| n == seam) {
            return Err((self.seam.unwrap_or(self.name).at, Problem::AlterTaken { name: seam.to_owned() }));
        }
        let grain = (sheet.grain_points == 2).then(|| (sheet.points[0] + sheet.points[1]) / 2.0);
        let keeps = |half: &Half| match (sheet.fold, grain) {
            (Some(fold), Some(p)) => half.has(fold) && (half.contains(p) || !halves.iter().all(|h| h.has(fold))),
            (Some(fold), None) => half.has(fold),
            (None, Some(p)) => half.contains(p),
            (None, None) => half.length() >= halves[0].length().max(halves[1].length()),
        };
        let first_keeps = keeps(&halves[0]);
        let part = |half: Half, line: Path, piece: &str| {
            let has_fold = sheet.fold.is_some_and(|fold| half.has(fold));
            PieceHalf { piece: piece.to_owned(), edges: edges_of(sheet, &half, line, seam), half, has_fold }
        };
        let ([old, new], [one, other]) = ([sheet.piece.as_str(), self.name.value.as_str()], halves);
        let back = line.reversed();
        Ok(if first_keeps {
            [part(one, back, old), part(other, line, new)]
        } else {
            [part(other, line, old), part(one, back, new)]
        })
    }

    /// A part as a piece of the file.
    fn written(
        &self,
        file: &GarmentFile,
        index: usize,
        sheet: &AlteredPiece,
        part: &PieceHalf,
    ) -> Result<PieceFile, Fault> {
        let old = &file.pieces[index];
        let mut new = old.clone();
        new.name = Located::new(part.piece.clone(), if part.piece == sheet.piece { old.name.at } else { self.name.at });
        if sheet.fold.is_some() && !part.has_fold {
            new.cut = Some(Located::new(CutKind::Pair, self.name.at));
            new.drawn.get_or_insert_with(|| Located::new(laying::cut_of(file, index).1, self.name.at));
        }
        let scale = 1.0 / sheet.unit.factor();
        let start = part.edges[0].1.start() * scale;
        let here = self.name.at;
        let text = |(name, path, _): &PartEdge| {
            (Located::new(name.clone(), here), Located::new(path.to_svg(scale, false), here))
        };
        let outline = OutlineFile {
            start: Located::new([start.x, start.y].map(super::sheet::rounded), here),
            edges: part.edges.iter().map(text).collect(),
        };
        new.outline = Some(outline);
        super::parts::share_out(&mut new, sheet, &part.edges, &|p| part.half.contains(p))?;
        let unit = sheet.unit.factor();
        new.darts.retain(|dart| match &dart.shape {
            DartShape::Edge { edge, .. } => part.edges.iter().any(|e| e.0 == edge.value),
            DartShape::FishEye { at, .. } => part.half.contains(Vec2::from(at.value) * unit),
        });
        Ok(new)
    }
}

/// Points of a style line at which it must lie inside its piece.
const INSIDE: usize = 64;

fn chain_all(sheet: &AlteredPiece) -> Vec<Bit> {
    let bit = |edge: usize| Bit { edge, was: Some([0.0, sheet.edges[edge].length()]), path: sheet.edges[edge].clone() };
    (0..sheet.edges.len()).map(bit).collect()
}

/// The edges of a part, from the first of the old ones on; the style line is the last or where it comes. A second
/// stretch of one edge is `hem_2`.
fn edges_of(sheet: &AlteredPiece, half: &Half, line: Path, seam: &str) -> Vec<PartEdge> {
    let mut edges: Vec<PartEdge> = Vec::new();
    for bit in &half.bits {
        let was = bit.was.unwrap_or_default();
        let second = half.bits.iter().any(|b| b.edge == bit.edge && b.was.unwrap_or_default()[0] < was[0]);
        let name = &sheet.names[bit.edge];
        let name = if second { free_name(sheet, name) } else { name.clone() };
        edges.push((name, bit.path.clone(), Some((bit.edge, was))));
    }
    edges.push((seam.to_owned(), line, None));
    let first = (0..edges.len()).filter(|&i| edges[i].2.is_some()).min_by_key(|&i| {
        let (edge, was) = edges[i].2.unwrap_or_default();
        (edge, was[0] > 0.0)
    });
    edges.rotate_left(first.unwrap_or(0));
    edges
}

/// `hem_2`, or the next number that no edge of the piece has.
fn free_name(sheet: &AlteredPiece, name: &str) -> String {
    let mut number = 2;
    while sheet.names.iter().any(|n| *n == format!("{name}_{number}")) {
        number += 1;
    }
    format!("{name}_{number}")
}

/// A smooth curve through points: cubics whose directions at inner points are those of the circle through three, and
/// straight through two.
fn through(points: &[Vec2]) -> Path {
    if let [from, to] = points {
        return Path::line(*from, *to);
    }
    let last = points.len() - 1;
    let inner = |k: usize| {
        let (before, after) = (points[k] - points[k - 1], points[k + 1] - points[k]);
        let (b, a) = (before.norm_squared().max(f64::MIN_POSITIVE), after.norm_squared().max(f64::MIN_POSITIVE));
        (before / b + after / a).try_normalize(0.0).unwrap_or_else(|| after.normalize())
    };
    // At an end the direction mirrors the inner one in the chord, as on a circle.
    let mirrored = |chord: Vec2, inner: Vec2| {
        let along = chord.try_normalize(0.0).unwrap_or_else(Vec2::x);
        along * (2.0 * along.dot(&inner)) - inner
    };
    let direction = |k: usize| match k {
        0 => mirrored(points[1] - points[0], inner(1)),
        k if k == last => mirrored(points[last] - points[last - 1], inner(last - 1)),
        k => inner(k),
    };
    let cubic = |k: usize| {
        let (a, b) = (points[k], points[k + 1]);
        let (u, v) = (direction(k), direction(k + 1));
        // The handles of a circular arc between these directions.
        let angle = u.perp(&v).atan2(u.dot(&v)).abs();
        let reach = (b - a).norm()
            * if angle < 1e-6 { 1.0 / 3.0 } else { (angle / 4.0).tan() * 2.0 / 3.0 / (angle / 2.0).sin() };
        [a, a + u * reach, b - v * reach, b]
    };
    Path::cubics(&(0..last).map(cubic).collect::<Vec<_>>())
}
