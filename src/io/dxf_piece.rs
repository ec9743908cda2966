//! A block of a DXF file as a piece.

use std::cell::Cell;

use super::dxf_block::{Block, LayerPoint, Named, longest_first, whole};
use super::dxf_grade::rule_of;
use super::dxf_notches::{self, once};
use super::dxf_rim::{ON_RIM, Rim, Saying, closed_by, closing, is_on};
use super::dxf_told::{Told, is_on_slit, read_notch, told_of};
use super::dxf_write::layer;
use crate::digitize::{
    Drawing, ImportedNotch, InnerLine, Material, ToldNotch, Traced, bridged, chained, follows, gaping, holes,
};
use crate::geometry::{Path, Vec2};
use crate::pattern::{Corner, CutKind, Side};

/// Texts that tell of notches that are read of a block, for each is looked for on every notch.
const MOST_TOLD: usize = 5_000;
/// A line on layer 1 no longer than this (metres) that ends on the boundary is a notch.
const NOTCH: f64 = 0.016;

impl Block<'_> {
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
        notches.extend(self.slits.iter().chain(&more).map(|&at| ImportedNotch { at, told: None }));
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
            // With a second number of mirrored ones the first is of one hand.
            alike: self.text("quantity:").is_some_and(|text| text.contains([',', ';', '/'])),
            drawn: self.text("drawn:").and_then(Side::from_letter),
            material: self.material(),
            corners: told.iter().filter_map(corner).collect(),
            name,
            ..Traced::default()
        })
    }

    /// A text that is no statement, as drawings without blocks name their pieces.
    fn plain_text(&self) -> Option<&str> {
        let words = self.texts.iter().map(|t| t.words.trim());
        let plain = |w: &&str| !w.is_empty() && !w.contains(':') && rule_of(w).is_none();
        words.filter(|_| self.name.is_empty()).find(plain)
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

    /// The notches of all layers, as points and as lines.
    fn notches(&self, cut: &Path) -> Vec<ImportedNotch> {
        let texts = self.texts.iter().filter_map(|t| Some((read_notch(&t.words)?, t.at?)));
        let mut texts: Vec<(ToldNotch, Vec2)> = texts.take(MOST_TOLD).collect();
        let mut notches = Vec::new();
        for layer in dxf_notches::LAYERS {
            let points: Vec<Vec2> = self.points_on(layer).map(|p| p.at).collect();
            notches.extend(self.points_on(layer).map(|point| notch(point, &mut texts)));
            let shapes: Vec<Path> = self.runs(layer).into_iter().filter_map(whole).map(|(_, path)| path).collect();
            let drawn = dxf_notches::drawn(&points, &shapes, cut);
            notches.extend(drawn.into_iter().map(|at| ImportedNotch { at, told: None }));
        }
        notches
    }
}

/// The notch of a point: where it meets the sewing line, if one of these texts tells that. Each tells of one notch, and
/// they stand in the order of these.
fn notch(point: &LayerPoint, texts: &mut Vec<(ToldNotch, Vec2)>) -> ImportedNotch {
    match texts.iter().position(|(_, at)| is_on_slit(*at, point.at, point.into)) {
        Some(k) => {
            let (told, at) = texts.remove(k);
            ImportedNotch { at, told: Some(told) }
        }
        None => ImportedNotch { at: point.at, told: None },
    }
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

/// How the allowance of an edge ends, where that is told.
fn corner((.., told): &(u32, &Path, Option<Told>)) -> Option<(String, Corner)> {
    match told {
        Some(Told::Edge(name, Some(corner))) => Some((name.clone(), *corner)),
        _ => None,
    }
}

/// A line inside that is neither an edge nor a pleat's.
fn inner((on, path, told): &(u32, &Path, Option<Told>)) -> Option<InnerLine> {
    let (name, kind) = match told {
        None if *on == layer::INTERNAL => (None, None),
        Some(Told::Line(name, kind)) => (Some(name.clone()), Some(kind.clone())),
        _ => return None,
    };
    Some(InnerLine { name, path: (*path).clone(), kind })
}

/// Where pleats begin on the edge; the line of each fold is followed by that of its place.
fn pleats(told: &[(u32, &Path, Option<Told>)]) -> Vec<[Vec2; 2]> {
    let begins =
        |wanted: Told| told.iter().filter(move |t| t.2.as_ref() == Some(&wanted)).map(|(_, path, _)| path.start());
    begins(Told::PleatFold).zip(begins(Told::PleatPlace)).map(|(fold, place)| [fold, place]).collect()
}

/// `1,1` is one as drawn and one mirrored; `2,0` or `2` two as drawn.
fn quantity(text: &str) -> Option<CutKind> {
    let mut counts = text.split([',', ';', '/']).map(|w| w.trim().parse::<usize>());
    let plain = counts.next()?.ok()?;
    let mirrored = counts.next().and_then(Result::ok).unwrap_or(0);
    match (plain, mirrored) {
        (1, 1) => Some(CutKind::Pair),
        (n @ 2..=100, 0) => Some(CutKind::Count(n)),
        _ => None,
    }
}
