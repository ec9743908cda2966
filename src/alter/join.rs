//! Two pieces joined along a seam, as if it had never been cut.

use super::sheet::{AlteredPiece, length_in, rounded};
use super::shift::{same_way, seam_face_same, sides};
use super::{Fault, laying, name};
use crate::geometry::{Path, Vec2};
use crate::pattern::{
    AllowanceFile, AllowanceWidth, CutKind, DartFile, DartShape, GarmentFile, Located, OutlineFile, PieceFile,
    PleatFile, Problem, Quantity, TestFile, Words, loop_crossing,
};

/// Largest distance of the two edges of the seam from each other when they lie on one another, metres.
const SAME_SHAPE: f64 = 5e-5;
/// Places along the seam at which that is measured.
const PLACES: usize = 32;
/// Turns smaller than this are none, radians.
const UPRIGHT: f64 = 1e-9;

/// An edge of one of the two pieces on the joined outline.
#[derive(Clone, Copy, Debug)]
struct SourceEdge {
    /// 0 for the piece that stays, 1 for the one that is joined to it.
    of: usize,
    edge: usize,
    /// Where it begins on the new edge, metres.
    from: f64,
}

/// An edge of the joined outline.
struct JoinedEdge {
    name: String,
    path: Path,
    sources: Vec<SourceEdge>,
}

/// The two pieces. The second lies at the first as `turn · p + shift`.
struct PieceJoin {
    sheets: [AlteredPiece; 2],
    index: [usize; 2],
    edge: [usize; 2],
    turn: nalgebra::Matrix2<f64>,
    shift: Vec2,
}

/// Joins the two pieces of a seam. The first one's name, grain and place stay.
pub(super) fn join(file: &mut GarmentFile, seam: &Located<String>) -> Result<(), Fault> {
    let join = PieceJoin::new(file, seam)?;
    let joints = join.joints(file);
    let paths: Vec<Path> = joints.iter().map(|j| j.path.clone()).collect();
    if let Some((near, [one, other])) = loop_crossing(&paths) {
        let scale = join.sheets[0].unit.factor();
        let near = format!("({:.1}, {:.1})", near.x / scale, near.y / scale);
        let edges = format!("'{}' and '{}'", joints[one].name, joints[other].name);
        return Err((seam.at, Problem::AlterCrosses { piece: join.sheets[0].piece.clone(), near, edges }));
    }
    let piece = join.piece(file, seam, &joints)?;
    file.pieces[join.index[0]] = piece;
    file.pieces.remove(join.index[1]);
    file.seams.retain(|s| s.name.value != seam.value);
    join.rename(file, &joints);
    join.drop_tests(file, seam);
    Ok(())
}

impl PieceJoin {
    fn new(file: &mut GarmentFile, seam: &Located<String>) -> Result<Self, Fault> {
        let refuse =
            |piece: &str, reason: String| Err((seam.at, Problem::AlterShape { piece: piece.to_owned(), reason }));
        let (sew, to) = sides(file, seam)?;
        let Some(to) = to else {
            return refuse(&sew.value, format!("seam '{}' sews it to its mirror image; write cut: fold", seam.value));
        };
        for k in 0..file.pieces.len() {
            let like = file.pieces[k].name.clone();
            name::piece(file, &like)?;
        }
        let (i, mut one, a) = name::edge(file, &sew, true)?;
        let (j, mut other, b) = name::edge(file, &to, true)?;
        one.fold_by_like(file, i);
        other.fold_by_like(file, j);
        let [kept, joined] = [i, j].map(|k| &file.pieces[k]);
        let [(cut, drawn), (other_cut, other_drawn)] = [i, j].map(|k| laying::cut_of(file, k));
        let alike = match (&cut, &other_cut) {
            (CutKind::Fold(_) | CutKind::Pair, CutKind::Fold(_) | CutKind::Pair) => drawn == other_drawn,
            (one, other) => one == other,
        };
        let along = same_way(kept, &sew, joined, &to, seam_face_same(file, seam));
        if i == j || !alike || along || kept.fabric != joined.fabric || kept.layer != joined.layer {
            let reason = "only pieces of one fabric and layer that are cut and drawn alike can be joined".to_owned();
            return refuse(&joined.name.value, reason);
        }
        let (path, partner) = (&one.edges[a], other.edges[b].reversed());
        let [from, to] = [path, &partner].map(|p| p.end() - p.start());
        let angle = to.perp(&from).atan2(to.dot(&from));
        let turn = *nalgebra::Rotation2::new(if angle.abs() < UPRIGHT { 0.0 } else { angle }).matrix();
        let shift = path.point(path.length() / 2.0) - turn * partner.point(partner.length() / 2.0);
        let apart = |k: usize| {
            let share = k as f64 / PLACES as f64;
            (path.point(share * path.length()) - turn * partner.point(share * partner.length()) - shift).norm()
        };
        let most = (0..=PLACES).map(apart).fold(0.0, f64::max);
        if most > SAME_SHAPE {
            let reason = format!(
                "its edge of seam '{}' has another shape than the other one: laid on it, it is off by {:.1} mm",
                seam.value,
                most * 1e3
            );
            return refuse(&joined.name.value, reason);
        }
        let wedges = [one.wedges(kept).iter().any(|w| w.edge == a), other.wedges(joined).iter().any(|w| w.edge == b)];
        if wedges.contains(&true) {
            return refuse(&joined.name.value, format!("a dart opens on seam '{}'", seam.value));
        }
        Ok(Self { sheets: [one, other], index: [i, j], edge: [a, b], turn, shift })
    }

    /// A point of one of the pieces, in the drawing of the first.
    fn point(&self, of: usize, p: Vec2) -> Vec2 {
        if of == 0 { p } else { self.turn * p + self.shift }
    }

    fn path(&self, of: usize, path: &Path) -> Path {
        if of == 0 { path.clone() } else { path.mapped(self.turn, self.shift) }
    }

    /// The edges of the joined outline, from the one after the seam on.
    fn joints(&self, file: &GarmentFile) -> Vec<JoinedEdge> {
        let after = |of: usize| {
            let (count, edge) = (self.sheets[of].edges.len(), self.edge[of]);
            (1..count).map(move |k| (of, (edge + k) % count))
        };
        let mut ring: Vec<(usize, usize)> = after(0).chain(after(1)).collect();
        let name = |(of, edge): (usize, usize)| self.sheets[of].names[edge].as_str();
        let goes_on =
            |a: (usize, usize), b: (usize, usize)| a.0 != b.0 && name(a) == name(b) && self.go_together(file, name(a));
        if goes_on(ring[ring.len() - 1], ring[0]) {
            ring.rotate_left(1);
        }
        let mut joints: Vec<JoinedEdge> = Vec::new();
        for (k, &(of, edge)) in ring.iter().enumerate() {
            let path = self.path(of, &self.sheets[of].edges[edge]);
            if let Some(last) = joints.last_mut().filter(|_| goes_on(ring[k - 1], (of, edge))) {
                last.sources.push(SourceEdge { of, edge, from: last.path.length() });
                let straight = last.path.joined(&path);
                last.path =
                    if in_line(&last.path, &path) { Path::line(last.path.start(), path.end()) } else { straight };
                continue;
            }
            joints.push(JoinedEdge { name: String::new(), path, sources: vec![SourceEdge { of, edge, from: 0.0 }] });
        }
        for first in [0, 1] {
            for k in 0..joints.len() {
                let source = joints[k].sources[0];
                let own = joints[k].sources.iter().any(|s| s.of == 0);
                if own == (first == 0) {
                    let wanted = self.sheets[source.of].names[source.edge].clone();
                    joints[k].name = free(&wanted, |name| joints.iter().any(|j| j.name == name));
                }
            }
        }
        joints
    }

    /// Whether the edges of this name of the two pieces are sewn one after the other wherever one of them is.
    fn go_together(&self, file: &GarmentFile, edge: &str) -> bool {
        let of = |text: &str| {
            let words = Words::parse(text).ok()?;
            let of = (0..2).find(|&k| self.sheets[k].piece == words.piece)?;
            (words.edge.as_deref() == Some(edge)).then_some(of)
        };
        file.seams.iter().flat_map(|s| [&s.sew, &s.to]).all(|chain| {
            let found: Vec<Option<usize>> = chain.iter().map(|text| of(&text.value)).collect();
            let count = |k: usize| found.iter().filter(|f| **f == Some(k)).count();
            let beside =
                |k: usize| found.windows(2).filter(|w| w.contains(&Some(0)) && w.contains(&Some(1))).count() >= k;
            count(0) == count(1) && beside(count(0))
        })
    }

    /// The edge, and the place on it, of a place on an edge of one of the pieces. `None` on the seam.
    fn place(&self, joints: &[JoinedEdge], of: usize, edge: &str, at: Quantity) -> Option<(String, Quantity)> {
        let sheet = &self.sheets[of];
        let old = sheet.names.iter().position(|n| n == edge)?;
        let s = if at.is_percent() { at.value(sheet.unit) * sheet.edges[old].length() } else { at.value(sheet.unit) };
        let joint = joints.iter().find(|j| j.sources.iter().any(|s| s.of == of && s.edge == old))?;
        let from = joint.sources.iter().find(|s| s.of == of && s.edge == old)?.from;
        let alone = joint.sources.len() == 1;
        Some((joint.name.clone(), if alone { at } else { length_in(from + s, at.unit, sheet.unit) }))
    }

    fn piece(&self, file: &GarmentFile, seam: &Located<String>, joints: &[JoinedEdge]) -> Result<PieceFile, Fault> {
        let scale = 1.0 / self.sheets[0].unit.factor();
        let pieces = self.index.map(|k| &file.pieces[k]);
        let mut new = pieces[0].clone();
        let start = joints[0].path.start() * scale;
        let here = |text: String| Located::new(text, seam.at);
        new.outline = Some(OutlineFile {
            start: Located::new([rounded(start.x), rounded(start.y)], seam.at),
            edges: joints.iter().map(|j| (here(j.name.clone()), here(j.path.to_svg(scale, false)))).collect(),
        });
        (new.cut, new.drawn) = self.cut(file, seam, joints)?;
        (new.notches, new.darts, new.pleats) = (Vec::new(), Vec::new(), Vec::new());
        for (of, old) in pieces.iter().enumerate() {
            for (edge, list) in &old.notches {
                for notch in list {
                    let Some((name, at)) = self.place(joints, of, &edge.value, notch.value.at) else { continue };
                    let mut notch = *notch;
                    notch.value.at = at;
                    match new.notches.iter_mut().find(|n| n.0.value == name) {
                        Some(own) => own.1.push(notch),
                        None => new.notches.push((Located::new(name, edge.at), vec![notch])),
                    }
                }
            }
            for dart in &old.darts {
                new.darts.push(self.dart(joints, of, dart)?);
            }
            for pleat in &old.pleats {
                new.pleats.extend(self.pleat(joints, of, pleat));
            }
        }
        for (k, run) in self.sheets[1].runs.iter().enumerate() {
            let text = self.path(1, run).to_svg(scale, true);
            let holes = pieces[1].holes.len();
            if k < holes {
                let mut hole = pieces[1].holes[k].clone();
                hole.1.value = format!("{text} Z");
                hole.0.value = free(&hole.0.value, |n| new.holes.iter().any(|h| h.0.value == n));
                new.holes.push(hole);
            } else {
                let mut line = pieces[1].lines[k - holes].clone();
                line.path.value = text;
                line.name.value = free(&line.name.value, |n| new.lines.iter().any(|l| l.name.value == n));
                new.lines.push(line);
            }
        }
        new.allowance = self.allowance(pieces, joints);
        Ok(new)
    }

    /// How the joined piece is cut.
    #[allow(clippy::type_complexity, reason = "the two statements of a piece")]
    fn cut(
        &self,
        file: &GarmentFile,
        seam: &Located<String>,
        joints: &[JoinedEdge],
    ) -> Result<(Option<Located<CutKind>>, Option<Located<crate::pattern::Side>>), Fault> {
        let folds = [0, 1].map(|of| self.sheets[of].fold.map(|edge| (of, edge)));
        let own = &file.pieces[self.index[0]];
        let Some((of, edge)) = folds[0].or(folds[1]) else { return Ok((own.cut.clone(), own.drawn)) };
        let holds =
            |j: &&JoinedEdge, (of, edge): (usize, usize)| j.sources.iter().any(|s| s.of == of && s.edge == edge);
        let Some(joint) = joints.iter().find(|j| holds(j, (of, edge))) else {
            let reason = "the seam is its fold".to_owned();
            return Err((seam.at, Problem::AlterShape { piece: self.sheets[of].piece.clone(), reason }));
        };
        let both = folds.iter().flatten().all(|fold| holds(&joint, *fold));
        if !both || !joint.path.is_straight() || joint.sources.len() != folds.iter().flatten().count() {
            let (piece, edge) = (self.sheets[of].piece.clone(), self.sheets[of].names[edge].clone());
            let reason = "joined, the folds of the two pieces are no straight line".to_owned();
            return Err((seam.at, Problem::AlterFold { piece, edge, reason }));
        }
        let drawn = laying::cut_of(file, self.index[of]).1;
        let cut = CutKind::Fold(joint.name.clone());
        Ok((Some(Located::new(cut, seam.at)), Some(Located::new(drawn, seam.at))))
    }

    fn dart(&self, joints: &[JoinedEdge], of: usize, dart: &DartFile) -> Result<DartFile, Fault> {
        let mut new = dart.clone();
        let scale = self.sheets[of].unit.factor();
        let moved = |p: [f64; 2]| {
            let p = self.point(of, Vec2::from(p) * scale) / scale;
            [rounded(p.x), rounded(p.y)]
        };
        match &mut new.shape {
            DartShape::Edge { edge, at, tip, .. } => {
                if let Some((name, place)) = self.place(joints, of, &edge.value, at.value) {
                    (edge.value, at.value) = (name, place);
                }
                if let Some(tip) = tip.as_mut().filter(|_| of == 1) {
                    tip.value = moved(tip.value);
                }
            }
            DartShape::FishEye { at, .. } if of == 1 => {
                if self.turn != nalgebra::Matrix2::identity() {
                    let reason = "its fish-eye dart would no longer be upright".to_owned();
                    return Err((at.at, Problem::AlterShape { piece: self.sheets[of].piece.clone(), reason }));
                }
                at.value = moved(at.value);
            }
            DartShape::FishEye { .. } => {}
        }
        Ok(new)
    }

    fn pleat(&self, joints: &[JoinedEdge], of: usize, pleat: &PleatFile) -> Option<PleatFile> {
        let mut new = pleat.clone();
        for at in &mut new.at {
            let (name, place) = self.place(joints, of, &pleat.edge.value, at.value)?;
            (new.edge.value, at.value) = (name, place);
        }
        new.toward = new.toward.filter(|toward| joints.iter().any(|j| j.name == toward.value));
        Some(new)
    }

    /// The allowances of the edges, as each had them.
    fn allowance(&self, pieces: [&PieceFile; 2], joints: &[JoinedEdge]) -> Option<AllowanceFile> {
        if pieces[0].allowance == pieces[1].allowance && !matches!(pieces[0].allowance, Some(AllowanceFile::Edges(_))) {
            return pieces[0].allowance.clone();
        }
        let width = |s: &SourceEdge| -> Option<Located<AllowanceWidth>> {
            match pieces[s.of].allowance.as_ref()? {
                AllowanceFile::All(width) => Some(*width),
                AllowanceFile::Edges(widths) => {
                    widths.iter().find(|w| w.0.value == self.sheets[s.of].names[s.edge]).map(|w| w.1)
                }
            }
        };
        let of_edge = |j: &JoinedEdge| {
            let width = width(&j.sources[0])?;
            Some((Located::new(j.name.clone(), width.at), width))
        };
        let widths: Vec<_> = joints.iter().filter_map(of_edge).collect();
        (!widths.is_empty()).then_some(AllowanceFile::Edges(widths))
    }

    /// Lets seams, free edges and closures name the edges as they are called now.
    fn rename(&self, file: &mut GarmentFile, joints: &[JoinedEdge]) {
        let now = |text: &str| -> Option<String> {
            let (name, range) = text.split_once('@').map_or((text, String::new()), |(n, r)| (n, format!("@{r}")));
            let words = Words::parse(name).ok()?;
            let of = (0..2).find(|&k| self.sheets[k].piece == words.piece)?;
            let edge = words.edge?;
            let old = self.sheets[of].names.iter().position(|n| *n == edge)?;
            let joint = joints.iter().find(|j| j.sources.iter().any(|s| s.of == of && s.edge == old))?;
            let side = words.side.map_or("", crate::pattern::Side::suffix);
            let copy = words.copy.map_or_else(String::new, |copy| format!(".{copy}"));
            Some(format!("{}{copy}.{}{side}{range}", self.sheets[0].piece, joint.name))
        };
        let renamed = |list: &mut Vec<Located<String>>| {
            for text in list.iter_mut() {
                if let Some(new) = now(&text.value) {
                    text.value = new;
                }
            }
            list.dedup_by(|b, a| a.value == b.value);
        };
        for seam in &mut file.seams {
            renamed(&mut seam.sew);
            renamed(&mut seam.to);
        }
        renamed(&mut file.free);
        let scale = self.sheets[0].unit.factor();
        for closure in &mut file.closures {
            for (of, points) in [(&mut closure.on, &mut closure.at), (&mut closure.meets, &mut closure.meets_at)] {
                let Some(of) = of.as_mut() else { continue };
                let Some(rest) = of.value.strip_prefix(self.sheets[1].piece.as_str()) else { continue };
                if rest.is_empty() || rest.starts_with('.') {
                    of.value = format!("{}{rest}", self.sheets[0].piece);
                    for p in points {
                        let moved = self.point(1, Vec2::from(p.value) * scale) / scale;
                        p.value = [rounded(moved.x), rounded(moved.y)];
                    }
                }
            }
        }
    }

    /// Leaves out the tests of the piece and of the seam that are no more.
    fn drop_tests(&self, file: &mut GarmentFile, seam: &Located<String>) {
        let gone = &self.sheets[1].piece;
        file.tests.retain(|test| match &test.value.test {
            TestFile::Seam(name, _) | TestFile::Gap(name, _) => name.value != seam.value,
            TestFile::Flatten(name, ..) | TestFile::Drape(name, ..) => name.value != *gone,
            _ => true,
        });
    }
}

/// Whether two straight edges are one.
fn in_line(one: &Path, other: &Path) -> bool {
    /// Largest angle between them, radians.
    const BEND: f64 = 1e-6;
    let along = |p: &Path| (p.end() - p.start()).try_normalize(0.0).unwrap_or_else(Vec2::zeros);
    let (a, b) = (along(one), along(other));
    one.is_straight() && other.is_straight() && a.dot(&b) > 0.0 && a.perp(&b).abs() < BEND
}

/// The name, or with the next number that is not taken: `hem_2`.
fn free(name: &str, taken: impl Fn(&str) -> bool) -> String {
    let numbered = |n: usize| if n == 1 { name.to_owned() } else { format!("{name}_{n}") };
    let mut number = 1;
    while taken(&numbered(number)) {
        number += 1;
    }
    numbered(number)
}
