//! Points of an edge moved: a seam taken in or let out, a neckline lowered.

use super::sheet::AlteredPiece;
use super::{Fault, name};
use crate::geometry::{Path, Shift, Vec2};
use crate::pattern::{CutKind, GarmentFile, Located, PieceFile, Problem, Quantity, SeamFile, Side, StationFile, Words};

/// Positions nearer to each other than this are one, metres.
const SAME: f64 = 1e-7;

/// Takes a seam in, or lets it out: both its edges are moved square to their chords.
pub(super) fn take(
    file: &mut GarmentFile,
    seam: &Located<String>,
    at: &[StationFile<Quantity>],
    out: bool,
) -> Result<(), Fault> {
    let (sew, to) = if seam.value.contains('.') { (seam.clone(), None) } else { sides(file, seam)? };
    let whole_edge = to.is_some();
    if let Some(to) = &to {
        // A piece that is like the first one keeps the shape that both have now.
        name::edge(file, to, true)?;
    }
    let (index, mut sheet, edge) = name::edge(file, &sew, whole_edge)?;
    let mut stations = Vec::new();
    for (place, amount) in at {
        let by = amount.value.value(sheet.unit);
        let most = sheet.edges[edge].length();
        if by.abs() >= most {
            let (what, expected) = (format!("amount at {}", sheet.shown(edge)), "less than the edge's length".into());
            return Err((amount.at, Problem::AlterAmount { what, expected, found: by * 1e3 }));
        }
        stations.push((sheet.place(edge, place)?, if out { -by } else { by }));
    }
    let sewn = SewnEdge::new(&sheet, &file.pieces[index], edge);
    let shares: Vec<(f64, f64)> = stations.iter().map(|&(s, by)| (sewn.share(s), by)).collect();
    inwards(&mut sheet, edge, &stations)?;
    sheet.write(file, index)?;
    let Some(to) = to else { return Ok(()) };
    let (other, mut sheet, edge) = name::edge(file, &to, true)?;
    let against = !same_way(&file.pieces[index], &sew, &file.pieces[other], &to, seam_face_same(file, seam));
    let sewn = SewnEdge::new(&sheet, &file.pieces[other], edge);
    let place = |&(share, by): &(f64, f64)| (sewn.place(if against { 1.0 - share } else { share }), by);
    let stations: Vec<(f64, f64)> = shares.iter().map(place).collect();
    inwards(&mut sheet, edge, &stations)?;
    sheet.write(file, other)
}

/// Moves points of an edge by what is said in the drawing's axes.
pub(super) fn move_points(
    file: &mut GarmentFile,
    text: &Located<String>,
    at: &[StationFile<[f64; 2]>],
) -> Result<(), Fault> {
    let (index, mut sheet, edge) = name::edge(file, text, false)?;
    let scale = sheet.unit.factor();
    let knot = |(place, by): &StationFile<[f64; 2]>| Ok((sheet.place(edge, place)?, Vec2::from(by.value) * scale));
    let knots: Vec<(f64, Vec2)> = at.iter().map(knot).collect::<Result<_, Fault>>()?;
    shift_edge(&mut sheet, edge, knots)?;
    sheet.write(file, index)
}

/// The two edges that a seam sews. `None` for the second if it is the first one's mirror image.
pub(super) fn sides(
    file: &GarmentFile,
    seam: &Located<String>,
) -> Result<(Located<String>, Option<Located<String>>), Fault> {
    let Some(found) = file.seams.iter().find(|s| s.name.value == seam.value) else {
        let names: Vec<&str> = file.seams.iter().map(|s| s.name.value.as_str()).collect();
        let nearest = crate::input::nearest(&seam.value, names.iter().copied()).map(str::to_owned);
        let (name, known) = (seam.value.clone(), names.join(", "));
        return Err((seam.at, Problem::UnknownSeam { name, nearest, known }));
    };
    let ([sew], [to]) = (found.sew.as_slice(), found.to.as_slice()) else {
        return Err((seam.at, Problem::AlterSeam { seam: seam.value.clone() }));
    };
    let part = [sew, to].into_iter().find(|edge| edge.value.contains('@'));
    if let Some(part) = part {
        return Err((seam.at, Problem::AlterPart(part.value.clone())));
    }
    let plain = |text: &str| Words::parse(text).ok().map(|w| (w.piece, w.edge));
    let mirror = to.value == "mirror" || plain(&to.value) == plain(&sew.value);
    let here = |edge: &Located<String>| Located::new(edge.value.clone(), seam.at);
    Ok((here(sew), (!mirror).then(|| here(to))))
}

/// Whether a seam sews a wrong side on a right side.
pub(super) fn seam_face_same(file: &GarmentFile, seam: &Located<String>) -> bool {
    let found: Option<&SeamFile> = file.seams.iter().find(|s| s.name.value == seam.value);
    found.and_then(|s| s.face_same.as_ref()).is_some_and(|f| f.value)
}

/// Whether two edges that are sewn together start at the same end of the seam, as drawn. Right sides out, they do where
/// one of the two pieces is the mirror image of its drawing.
pub(super) fn same_way(
    one: &PieceFile,
    of_one: &Located<String>,
    other: &PieceFile,
    of_other: &Located<String>,
    face_same: bool,
) -> bool {
    let side = |text: &Located<String>| Words::parse(&text.value).ok().and_then(|w| w.side);
    let sides = [side(of_one), side(of_other)];
    // Where only one says its side, the other is on it as well.
    let common = sides[0].or(sides[1]).unwrap_or(Side::Left);
    let mirrored = |piece: &PieceFile, side: Option<Side>| {
        let halves = matches!(piece.cut.as_ref().map(|c| &c.value), Some(CutKind::Pair | CutKind::Fold(_)));
        halves && side.unwrap_or(common) != piece.drawn.as_ref().map_or(Side::Left, |d| d.value)
    };
    (mirrored(one, sides[0]) != mirrored(other, sides[1])) != face_same
}

/// An edge without the mouths of its darts.
struct SewnEdge {
    length: f64,
    mouths: Vec<[f64; 2]>,
}

impl SewnEdge {
    fn new(sheet: &AlteredPiece, piece: &PieceFile, edge: usize) -> Self {
        let of_edge = sheet.wedges(piece).into_iter().filter(|w| w.edge == edge);
        let mut mouths: Vec<[f64; 2]> = of_edge.map(|w| w.mouth).collect();
        mouths.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Self { length: sheet.edges[edge].length(), mouths }
    }

    /// Length that is sewn, up to a position of the drawing.
    fn up_to(&self, s: f64) -> f64 {
        s - self.mouths.iter().map(|m| (s.min(m[1]) - m[0]).max(0.0)).sum::<f64>()
    }

    fn share(&self, s: f64) -> f64 {
        self.up_to(s) / self.up_to(self.length)
    }

    /// The position of the drawing at a share of the sewn length.
    fn place(&self, share: f64) -> f64 {
        let mut s = share * self.up_to(self.length);
        for mouth in self.mouths.iter().filter(|_| share > 0.0) {
            if s > mouth[0] {
                s += mouth[1] - mouth[0];
            }
        }
        s.clamp(0.0, self.length)
    }
}

/// Moves an edge square to its chord, towards the cloth where the amount is positive.
fn inwards(sheet: &mut AlteredPiece, edge: usize, stations: &[(f64, f64)]) -> Result<(), Fault> {
    let chord = sheet.edges[edge].end() - sheet.edges[edge].start();
    let Some(along) = chord.try_normalize(SAME) else {
        let reason = format!("edge '{}' is closed and has no chord to be moved square to", sheet.names[edge]);
        return Err((sheet.at, Problem::AlterShape { piece: sheet.piece.clone(), reason }));
    };
    // The outline runs clockwise on screen: the cloth lies to the right of the walk.
    let inward = Vec2::new(-along.y, along.x);
    shift_edge(sheet, edge, stations.iter().map(|&(s, by)| (s, inward * by)).collect())
}

/// Shifts points of an edge. Between them the shift goes over smoothly, and at ends that are not named it is zero.
/// The neighbours follow an end that moves: straight edges stay straight, curves are eased over their length.
fn shift_edge(sheet: &mut AlteredPiece, edge: usize, mut knots: Vec<(f64, Vec2)>) -> Result<(), Fault> {
    let fold_kept = |sheet: &AlteredPiece, reason: &str| {
        let (piece, edge) = (sheet.piece.clone(), sheet.fold.map_or_else(String::new, |f| sheet.names[f].clone()));
        (sheet.at, Problem::AlterFold { piece, edge, reason: reason.to_owned() })
    };
    if sheet.fold == Some(edge) {
        return Err(fold_kept(sheet, "it must stay straight"));
    }
    knots.sort_by(|a, b| a.0.total_cmp(&b.0));
    let length = sheet.edges[edge].length();
    if knots.first().is_none_or(|k| k.0 > SAME) {
        knots.insert(0, (0.0, Vec2::zeros()));
    }
    if knots.last().is_none_or(|k| k.0 < length - SAME) {
        knots.push((length, Vec2::zeros()));
    }
    let (first, last) = (knots[0].1, knots[knots.len() - 1].1);
    let count = sheet.edges.len();
    let (before, after) = ((edge + count - 1) % count, (edge + 1) % count);
    for (neighbour, by) in [(before, first), (after, last)].into_iter().filter(|(_, by)| by.norm() > 0.0) {
        let path = &sheet.edges[neighbour];
        let along = (path.end() - path.start()).try_normalize(0.0).unwrap_or_else(Vec2::zeros);
        if sheet.fold == Some(neighbour) && along.perp(&by).abs() > SAME {
            return Err(fold_kept(sheet, "its ends move along it only"));
        }
        if neighbour == edge {
            let reason = "its only edge is closed; move points between its ends".to_owned();
            return Err((sheet.at, Problem::AlterShape { piece: sheet.piece.clone(), reason }));
        }
    }
    apply(sheet, edge, &EdgeShift::new(&sheet.edges[edge], knots));
    if first.norm() > 0.0 {
        let path = &sheet.edges[before];
        let field = EdgeShift::new(path, vec![(0.0, Vec2::zeros()), (path.length(), first)]);
        apply(sheet, before, &field);
    }
    if last.norm() > 0.0 {
        let path = &sheet.edges[after];
        let field = EdgeShift::new(path, vec![(0.0, last), (path.length(), Vec2::zeros())]);
        apply(sheet, after, &field);
    }
    Ok(())
}

fn apply(sheet: &mut AlteredPiece, edge: usize, field: &EdgeShift) {
    let marks = sheet.marks_on(edge);
    let knots: Vec<f64> = field.knots.iter().map(|k| k.0).collect();
    let (path, moved) = sheet.edges[edge].shifted(&knots, &marks, |s| field.at(s));
    for mark in sheet.marks.iter_mut().flatten().filter(|m| m.edge == edge) {
        if let Some(i) = marks.iter().position(|m| *m == mark.at) {
            mark.at = moved[i];
        }
    }
    let line = field.linear && path.is_straight();
    sheet.edges[edge] = if line { Path::line(path.start(), path.end()) } else { path };
}

/// A shift along an edge: cubics between knots.
#[derive(Clone, Debug)]
pub(super) struct EdgeShift {
    /// Places along the edge, the first and the last at its ends, and the shifts there.
    pub(super) knots: Vec<(f64, Vec2)>,
    /// By knot, the change of the shift by length.
    pub(super) slopes: Vec<Vec2>,
    /// A straight edge between two knots stays straight.
    pub(super) linear: bool,
}

impl EdgeShift {
    /// Cubics through their knots that do not overshoot.
    fn new(path: &Path, knots: Vec<(f64, Vec2)>) -> Self {
        let linear = knots.len() == 2 && path.is_straight();
        let rise = |i: usize| (knots[i + 1].1 - knots[i].1) / (knots[i + 1].0 - knots[i].0).max(SAME);
        let last = knots.len() - 1;
        let slope = |i: usize| match i {
            _ if linear => rise(0),
            0 => Vec2::zeros(),
            i if i == last => Vec2::zeros(),
            i => rise(i - 1).zip_map(&rise(i), harmonic),
        };
        let slopes = (0..knots.len()).map(slope).collect();
        Self { knots, slopes, linear }
    }

    /// The shift at a place along the edge.
    pub(super) fn at(&self, s: f64) -> Shift {
        let last = self.knots.len() - 2;
        let i = self.knots[1..=last].partition_point(|k| k.0 <= s);
        let ((from, a), (to, b)) = (self.knots[i], self.knots[i + 1]);
        let (long, m, n) = ((to - from).max(SAME), self.slopes[i], self.slopes[i + 1]);
        let t = ((s - from) / long).clamp(0.0, 1.0);
        let (u, m, n) = (1.0 - t, m * long, n * long);
        let by = a * (u * u * (1.0 + 2.0 * t)) + b * (t * t * (3.0 - 2.0 * t)) + m * (t * u * u) - n * (t * t * u);
        let slope = ((b - a) * (6.0 * t * u) + m * (u * (1.0 - 3.0 * t)) + n * (t * (3.0 * t - 2.0))) / long;
        Shift { by, slope }
    }
}

/// The slope between two rises that keeps the cubics from overshooting (Fritsch and Butland).
fn harmonic(one: f64, other: f64) -> f64 {
    if one * other <= 0.0 { 0.0 } else { 2.0 * one * other / (one + other) }
}
