//! The pieces as drawn, for paper: what a maker lays on the cloth and cuts round. A pair is drawn once, a piece on the
//! fold as its half, darts are open and pleats spread.

use super::closure::drawn_points;
use super::cut::{Pieces, cut};
use super::diagnostic::Findings;
use super::draft::{Draft, DrawnStretch, draft};
use super::file::{AllowanceFile, AllowanceWidth, GarmentFile, PieceFile};
use super::inherit::complete_pieces;
use super::seam::{Seams, seams};
use super::value::{Corner, CutKind, Side};
use super::{EdgeId, FabricUse, Garment, Line, PleatLayer, SeamKind};
use crate::geometry::{Path, Vec2};

/// A piece as drawn. Lengths are metres, y down, the right side of the cloth facing the reader.
#[derive(Clone, Debug)]
pub struct DrawnPiece {
    /// As in the file.
    pub name: String,
    /// How often it is cut, and how.
    pub cut: CutKind,
    /// The edge of the outline that lies on the fold of the cloth.
    pub fold: Option<usize>,
    /// Which of a pair, or which half, it is.
    pub drawn: Side,
    /// Name of its fabric in the garment.
    pub fabric: String,
    /// The library's fabric that this is, if it is one.
    pub cloth: Option<String>,
    /// 0 = shell, positive further out, negative nearer the body.
    pub layer: i32,
    /// Warp direction, unit length.
    pub warp: Vec2,
    /// Tail and head of the grain arrow, if the file has one.
    pub grain: Option<[Vec2; 2]>,
    /// The outline, clockwise on screen, then the holes, the other way round.
    pub rings: Vec<Vec<DrawnEdge>>,
    /// Wedges taken out of the outline.
    pub darts: Vec<Dart>,
    /// Rings that are fish-eye darts: sewn shut, not cut.
    pub fish_eyes: Vec<usize>,
    /// Folds of the pleats.
    pub folds: Vec<DrawnFold>,
    /// Lines inside.
    pub lines: Vec<Line>,
    /// Marks on edges.
    pub notches: Vec<DrawnNotch>,
    /// Where buttons and the like go: what it is, and the point.
    pub points: Vec<(String, Vec2)>,
    /// The file's remark.
    pub note: Option<String>,
}

impl DrawnPiece {
    /// Whether an edge of the outline is a leg of a dart.
    pub fn is_leg(&self, edge: usize) -> bool {
        self.darts.iter().any(|d| d.legs.contains(&edge))
    }

    /// Whether an edge of the outline is cut along, beyond its allowance: neither on the fold nor in a dart.
    pub fn is_cut(&self, edge: usize) -> bool {
        self.fold != Some(edge) && !self.is_leg(edge)
    }
}

/// An edge of a drawing.
#[derive(Clone, Debug)]
pub struct DrawnEdge {
    /// As in [`super::Edge`].
    pub name: String,
    /// Its course: the sewing line.
    pub path: Path,
    /// Names of the seams of the file that take it, or a part of it.
    pub seams: Vec<String>,
    /// Its allowance as the file states it.
    pub allowance: Allowance,
}

impl DrawnEdge {
    /// Whether a seam of the file takes it, or a part of it.
    pub fn is_sewn(&self) -> bool {
        !self.seams.is_empty()
    }
}

/// An allowance as a file states it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Allowance {
    /// Metres.
    pub width: Option<f64>,
    /// How it ends at corners.
    pub corner: Option<Corner>,
}

/// The two legs of a dart, following each other in the outline from mouth to tip and back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dart {
    /// Indices in the outline.
    pub legs: [usize; 2],
}

/// One fold of a pleat on an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnFold {
    /// Ring and index of the edge.
    pub edge: (usize, usize),
    /// Where the cloth is folded, metres from the edge's start.
    pub from: f64,
    /// Where the fold comes to lie.
    pub to: f64,
}

/// A mark on an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnNotch {
    /// Ring and index of the edge.
    pub edge: (usize, usize),
    /// Metres from the edge's start.
    pub at: f64,
    /// Double notches mark the back.
    pub double: bool,
}

/// The drawings of a garment file that has passed its checks as `garment`.
///
/// An edge's allowance is what its piece says for it, or its seam, or its piece for all edges, or the file; a hole that
/// nothing is sewn into has the first alone.
pub fn drawings(file: &GarmentFile, garment: &Garment) -> Vec<DrawnPiece> {
    // Everything wrong has been said when the garment was read.
    let mut said = Findings::new("", "");
    let pieces = complete_pieces(file, &mut said);
    let read = |p: &PieceFile| draft(p, file.unit(), &mut said).map(|d| (p.clone(), d));
    let (pieces, drafts): (Vec<PieceFile>, Vec<Draft>) = pieces.iter().filter_map(read).unzip();
    let default_fabric = garment.fabrics.first().map_or("", |f| &f.name);
    let cut = cut(&drafts, default_fabric);
    let seams = seams(file, &drafts, &cut, &mut said);
    let book = Book { file, fabrics: &garment.fabrics, drafts: &drafts, cut: &cut, seams: &seams };
    pieces.iter().enumerate().map(|(i, piece)| book.drawing(piece, i)).collect()
}

struct Book<'a> {
    file: &'a GarmentFile,
    fabrics: &'a [FabricUse],
    drafts: &'a [Draft],
    cut: &'a Pieces,
    seams: &'a Seams,
}

impl Book<'_> {
    fn drawing(&self, piece: &PieceFile, index: usize) -> DrawnPiece {
        let drawn = &self.drafts[index];
        let is_named = |f: &&FabricUse| drawn.fabric.as_ref().is_none_or(|own| own.value == f.name);
        let fabric = self.fabrics.iter().find(is_named);
        let unit = self.file.unit();
        let edge = |at: (usize, usize)| {
            let edge = &drawn.rings[at.0][at.1];
            let (seams, by_seam) = self.sewn(index, at);
            let cut_out = at.0 > 0 && seams.is_empty();
            let allowance = self.allowance(piece, drawn, at, by_seam, cut_out);
            DrawnEdge { name: edge.name.clone(), path: edge.path.clone(), seams, allowance }
        };
        let ring = |r: usize| (0..drawn.rings[r].len()).map(|i| edge((r, i))).collect();
        DrawnPiece {
            name: drawn.name.clone(),
            cut: drawn.cut.clone(),
            fold: drawn.fold,
            drawn: drawn.drawn,
            fabric: fabric.map_or_else(String::new, |f| f.name.clone()),
            cloth: fabric.and_then(FabricUse::cloth).map(str::to_owned),
            layer: drawn.layer,
            warp: drawn.warp,
            grain: piece.grain.as_ref().map(|g| g.value.map(|p| Vec2::from(p) * unit.factor())),
            rings: (0..drawn.rings.len()).map(ring).collect(),
            darts: darts(drawn),
            fish_eyes: fish_eyes(drawn),
            folds: folds(drawn),
            lines: drawn.lines.clone(),
            notches: drawn.notches.iter().map(|&(edge, at, double)| DrawnNotch { edge, at, double }).collect(),
            points: drawn_points(self.file, drawn),
            note: piece.note.as_ref().map(|n| n.value.clone()),
        }
    }

    /// The seams of the file that take the edge, and the widest allowance such a seam asks for.
    fn sewn(&self, draft: usize, at: (usize, usize)) -> (Vec<String>, Option<f64>) {
        let own: Vec<EdgeId> =
            self.cut.instances.iter().filter(|i| i.draft == draft).filter_map(|i| i.edge(at)).collect();
        let (mut sewn, mut width) = (Vec::new(), None);
        for (seam, written) in self.seams.seams.iter().zip(&self.seams.written) {
            let Some(written) = *written else { continue };
            if seam.a.iter().chain(&seam.b).any(|s| own.contains(&s.edge)) {
                let name = &self.file.seams[written].name.value;
                if !sewn.contains(name) {
                    sewn.push(name.clone());
                }
                let asked = self.file.seams[written].allowance.as_ref().map(|q| q.value.value(self.file.unit()));
                width = [width, asked].into_iter().flatten().reduce(f64::max);
            }
        }
        (sewn, width)
    }

    /// The file's statement of an edge's allowance. An edge that is merely `cut_out` has the one that names it, if any.
    fn allowance(
        &self,
        piece: &PieceFile,
        drawn: &Draft,
        at: (usize, usize),
        by_seam: Option<f64>,
        cut_out: bool,
    ) -> Allowance {
        let unit = self.file.unit();
        let said = |w: &AllowanceWidth| Allowance { width: Some(w.width.value(unit)), corner: w.corner };
        let (mut of_edge, mut of_piece) = (None, None);
        match &piece.allowance {
            Some(AllowanceFile::All(all)) => of_piece = Some(said(&all.value)),
            Some(AllowanceFile::Edges(edges)) => {
                let on_edge = |name: &str| drawn.find(name).is_some_and(|n| n.parts.iter().any(|p| p.edge == at));
                of_edge = edges.iter().find(|(name, _)| on_edge(&name.value)).map(|(_, w)| said(&w.value));
            }
            None => {}
        }
        let plain = |width: f64| Allowance { width: Some(width), corner: None };
        let of_file = self.file.allowance.as_ref().map(|q| plain(q.value.value(unit)));
        let of_all = of_piece.or(of_file).filter(|_| !cut_out);
        of_edge.or(by_seam.map(plain)).or(of_all).unwrap_or_default()
    }
}

fn darts(drawn: &Draft) -> Vec<Dart> {
    let wedge = |s: &&super::draft::OwnSeam| s.kind == SeamKind::Dart && s.a.edge.0 == 0;
    drawn.own_seams.iter().filter(wedge).map(|s| Dart { legs: [s.a.edge.1, s.b.edge.1] }).collect()
}

fn fish_eyes(drawn: &Draft) -> Vec<usize> {
    let mut rings: Vec<usize> =
        drawn.own_seams.iter().filter(|s| s.kind == SeamKind::Dart && s.a.edge.0 > 0).map(|s| s.a.edge.0).collect();
    rings.dedup();
    rings
}

/// A fold's under-layers are sewn on each other: what lies under it begins where it is folded and ends where the fold
/// comes to lie.
fn folds(drawn: &Draft) -> Vec<DrawnFold> {
    let fold = |pair: &[super::draft::OwnSeam]| {
        let [top, under] = pair else { return None };
        let same = top.kind == SeamKind::Pleat(PleatLayer::Top) && under.kind == SeamKind::Pleat(PleatLayer::Under);
        // The first stretch ends (or begins) at the fold line; the second lies between the hidden fold and the far end.
        let DrawnStretch { edge, from, to } = top.a;
        let at = if (to - top.b.to).abs() < 1e-9 { to } else { from };
        let ends = [under.a.from, under.a.to, under.b.from, under.b.to];
        let far = ends.into_iter().max_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs()))?;
        same.then_some(DrawnFold { edge, from: at, to: far })
    };
    drawn.own_seams.windows(2).filter_map(fold).collect()
}

impl DrawnPiece {
    /// The edge at (ring, index).
    pub fn edge(&self, (ring, index): (usize, usize)) -> &DrawnEdge {
        &self.rings[ring][index]
    }
}
