//! From a drawing to a piece on paper.

use nalgebra::Matrix2;

use super::clean::double_area;
use super::corner::CornerWish;
use super::label::{self, Label, PieceWords};
use super::marks;
use super::offset::{Border, EdgeTransition, around, around_unfolded, sewn_mouths, within};
use super::room::Room;
use super::whole;
use super::{CuttingOptions, Narrowed, Paper, SewKind, SewLine};
use crate::geometry::{Path, Vec2, range_of};
use crate::pattern::{Corner, CutKind, Dart, DrawnEdge, DrawnPiece, Side};

/// Less than this (square metres, a square of 3 mm) nobody cuts out of a hole.
const LEAST_CUT: f64 = 1e-5;
/// A free edge that turns by more than this from end to end (radians, 35 degrees) is no hem that is turned up as one.
const MOST_BENT_HEM: f64 = 0.61;
/// Places of an edge at which its direction is looked at.
const BEND_LOOKS: usize = 32;
/// An allowance that does not fit into its hole is halved so often at most. Then the hole is cut on its sewing line.
const HALVINGS: i32 = 6;

/// The papers of a garment, their warp upright: one per drawing, or one per piece as cut with
/// [`CuttingOptions::whole`].
pub fn papers(drawings: &[DrawnPiece], options: &CuttingOptions) -> Vec<Paper> {
    laid_out(drawings, options, None)
}

/// As [`papers`], each with a line of what it belongs to, and its edges with the seams that take them.
pub fn labelled(drawings: &[DrawnPiece], options: &CuttingOptions, label: &Label) -> Vec<Paper> {
    laid_out(drawings, options, Some(label))
}

fn laid_out(drawings: &[DrawnPiece], options: &CuttingOptions, label: Option<&Label>) -> Vec<Paper> {
    drawings
        .iter()
        .enumerate()
        .flat_map(|(number, drawing)| {
            let rule = AllowanceRule::new(drawing, options);
            let drawn = paper(&rule);
            let papers = if options.whole { whole::as_cut(&drawn, drawing) } else { vec![drawn] };
            papers
                .iter()
                .map(|paper| {
                    let mut paper = upright(paper);
                    let heading = label.map(|label| label.line(number + 1, drawings.len()));
                    paper.words = words(&paper, &rule, heading);
                    paper.lettered_clear_of(&[])
                })
                .collect::<Vec<_>>()
        })
        .collect()
}

/// Width and ends of an edge's allowance where the file does not say.
struct AllowanceRule<'a> {
    drawing: &'a DrawnPiece,
    options: &'a CuttingOptions,
    /// The share of its allowance that each ring has room for.
    shares: Vec<f64>,
}

impl<'a> AllowanceRule<'a> {
    fn new(drawing: &'a DrawnPiece, options: &'a CuttingOptions) -> Self {
        let mut rule = Self { drawing, options, shares: vec![1.0; drawing.rings.len()] };
        for ring in rule.holes() {
            rule.shares[ring] = rule.share(ring);
        }
        rule
    }

    /// The rings that are cut out.
    fn holes(&self) -> Vec<usize> {
        (1..self.drawing.rings.len()).filter(|r| !self.drawing.fish_eyes.contains(r)).collect()
    }

    /// Share of its allowance that fits into a hole.
    fn share(&self, ring: usize) -> f64 {
        let fits = |share: &f64| {
            let mut borders = self.borders(ring);
            borders.iter_mut().for_each(|b| b.width *= share);
            let left: f64 = within(&borders).iter().map(|c| 0.5 * double_area(c).abs()).sum();
            left >= LEAST_CUT
        };
        (0..=HALVINGS).map(|k| 0.5_f64.powi(k)).find(fits).unwrap_or(0.0)
    }

    fn width(&self, ring: usize, index: usize) -> f64 {
        self.shares[ring] * self.asked(ring, index)
    }

    fn asked(&self, ring: usize, index: usize) -> f64 {
        if ring == 0 && self.drawing.fold == Some(index) {
            return 0.0;
        }
        // A hole that nothing is sewn into is a slit or a welt that is turned in on its own lines, unless the file says
        // otherwise.
        let edge = &self.drawing.rings[ring][index];
        let usual = if ring == 0 || edge.is_sewn() { self.options.allowance } else { 0.0 };
        edge.allowance.width.unwrap_or(usual)
    }

    /// Free edges are hems: turned up, their ends must lie on the piece. Necklines and armholes bend too much to be
    /// turned up, and folded ends would stick out as wings.
    fn corner(edge: &DrawnEdge) -> Corner {
        let usual = if edge.is_sewn() || bend(&edge.path) > MOST_BENT_HEM { Corner::Mitred } else { Corner::Folded };
        edge.allowance.corner.unwrap_or(usual)
    }

    fn border(&self, ring: usize, index: usize) -> Border<'_> {
        let edge = &self.drawing.rings[ring][index];
        let wish = CornerWish { corner: Self::corner(edge), said: edge.allowance.corner.is_some() };
        Border { path: &edge.path, width: self.width(ring, index), wish }
    }

    fn borders(&self, ring: usize) -> Vec<Border<'_>> {
        (0..self.drawing.rings[ring].len()).map(|i| self.border(ring, i)).collect()
    }

    /// Rings and indices of their edges.
    fn hole_edges(&self) -> impl Iterator<Item = (usize, usize)> {
        self.holes().into_iter().flat_map(|r| (0..self.drawing.rings[r].len()).map(move |i| (r, i)))
    }

    /// The edges of holes whose allowances had to be made narrower.
    fn narrowed(&self) -> Vec<Narrowed> {
        let row = |(r, i): (usize, usize)| Narrowed {
            edge: self.drawing.rings[r][i].name.clone(),
            asked: self.asked(r, i),
            drawn: self.width(r, i),
        };
        self.hole_edges().map(row).filter(|n| n.drawn < n.asked).collect()
    }
}

/// By how much an edge turns on its way, to the left and to the right together, radians.
fn bend(path: &Path) -> f64 {
    let tangent = |k: usize| path.tangent(path.length() * k as f64 / BEND_LOOKS as f64);
    (0..BEND_LOOKS).map(|k| (tangent(k), tangent(k + 1))).map(|(a, b)| a.perp(&b).atan2(a.dot(&b)).abs()).sum()
}

/// The paper turned so that its warp is upright, by the smaller angle.
fn upright(paper: &Paper) -> Paper {
    let warp = (paper.grain[1] - paper.grain[0]).try_normalize(0.0).unwrap_or_else(Vec2::y);
    let up = if warp.y > 0.0 { -warp } else { warp };
    // The rotation that takes `up` to (0, −1).
    paper.mapped(Matrix2::new(-up.y, up.x, -up.x, -up.y), Vec2::zeros())
}

fn paper(rule: &AllowanceRule) -> Paper {
    let drawing = rule.drawing;
    let (borders, between) = outline_borders(rule);
    let (mut cut, fold) = outline_cut(drawing, &borders, &between);
    for ring in rule.holes() {
        cut.extend(within(&rule.borders(ring)));
    }
    let (quantity, mirrored) = match drawing.cut {
        CutKind::One | CutKind::Fold(_) => (1, false),
        CutKind::Pair => (2, true),
        CutKind::Count(n) => (n, false),
    };
    let mouths = sewn_mouths(&borders, &between);
    let room = Room { contours: cut.clone(), walls: Vec::new() };
    let grain = marks::grain(drawing, &room);
    let notches = marks::notches(drawing, &room, |ring, index| rule.width(ring, index));
    Paper {
        name: drawing.name.clone(),
        count: label::count(&drawing.cut),
        quantity,
        mirrored,
        drawn: matches!(drawing.cut, CutKind::Pair | CutKind::Fold(_)).then_some(drawing.drawn),
        fabric: drawing.fabric.clone(),
        cloth: drawing.cloth.clone(),
        cut,
        fold,
        sew: sew_lines(drawing, &mouths),
        notches,
        grain,
        marks: marks::marks(drawing, fold),
        drills: marks::drills(drawing),
        words: PieceWords::default(),
        texts: Vec::new(),
        narrowed: rule.narrowed(),
        nest: None,
        size: None,
        others: Vec::new(),
    }
}

/// The outline's cut lines. Of a piece on the fold their half, and the stretch of the fold that the cloth lies on.
fn outline_cut(
    drawing: &DrawnPiece,
    borders: &[Border],
    between: &[EdgeTransition],
) -> (Vec<Vec<Vec2>>, Option<[Vec2; 2]>) {
    let Some(fold) = drawing.fold else { return (around(borders, between), None) };
    let place = (0..fold).filter(|&i| !drawing.is_leg(i)).count();
    let path = borders[place].path;
    let ends = [path.start(), path.end()];
    let whole = around_unfolded(borders, between, place);
    let cut: Vec<Vec<Vec2>> = whole.iter().filter_map(|contour| whole::halved(contour, ends)).collect();
    // The outline runs from the end of the fold to its start.
    let on_fold = cut.first().and_then(|outline| Some([*outline.last()?, *outline.first()?]));
    (cut, Some(on_fold.unwrap_or(ends)))
}

/// The outline without the legs of its darts.
fn outline_borders<'a>(rule: &'a AllowanceRule) -> (Vec<Border<'a>>, Vec<EdgeTransition>) {
    let drawing = rule.drawing;
    let count = drawing.rings[0].len();
    let (mut borders, mut between) = (Vec::new(), Vec::new());
    for i in (0..count).filter(|&i| !drawing.is_leg(i)) {
        borders.push(rule.border(0, i));
        let dart = drawing.darts.iter().find(|d| d.legs.contains(&((i + 1) % count)));
        between.push(dart.map_or(EdgeTransition::Corner, |dart| pressed(drawing, *dart)));
    }
    (borders, between)
}

/// Upright darts are pressed towards the middle of the body, lying ones down.
fn pressed(drawing: &DrawnPiece, dart: Dart) -> EdgeTransition {
    let [one, other] = dart.legs.map(|leg| &drawing.rings[0][leg].path);
    let tip = one.end();
    let (near, far) = (one.start(), other.end());
    let middle = (near + far) / 2.0;
    let upright = (middle - tip).y.abs() >= (middle - tip).x.abs();
    let onto_first = if upright {
        let centre = centre(drawing);
        (near.x - centre).abs() <= (far.x - centre).abs()
    } else {
        near.y >= far.y
    };
    EdgeTransition::Dart { tip, onto_first }
}

/// The x coordinate of the body's middle: the fold, the line in which a pair is mirrored, or the middle of the piece.
fn centre(drawing: &DrawnPiece) -> f64 {
    match (drawing.fold, &drawing.cut) {
        (Some(fold), _) => drawing.rings[0][fold].path.start().x,
        (None, CutKind::Pair) => 0.0,
        _ => {
            let [low, high] = range_of(drawing.rings[0].iter().map(|e| e.path.start().x));
            (low + high) / 2.0
        }
    }
}

fn sew_lines(drawing: &DrawnPiece, mouths: &[Vec<Vec2>]) -> Vec<SewLine> {
    let mut lines = Vec::new();
    for (r, ring) in drawing.rings.iter().enumerate() {
        for (i, edge) in ring.iter().enumerate() {
            let of = match r {
                0 if drawing.is_leg(i) => SewKind::Dart,
                0 => SewKind::Outline,
                _ if drawing.fish_eyes.contains(&r) => SewKind::FishEye,
                _ => SewKind::Hole,
            };
            if !(r == 0 && drawing.fold == Some(i)) {
                let corner = edge.allowance.corner.filter(|_| matches!(of, SewKind::Outline | SewKind::Hole));
                lines.push(SewLine { name: edge.name.clone(), path: edge.path.clone(), of, corner });
            }
        }
    }
    let mouth = |points: &Vec<Vec2>| SewLine {
        name: "mouth".to_owned(),
        path: Path::polyline(points),
        of: SewKind::Mouth,
        corner: None,
    };
    lines.extend(mouths.iter().map(mouth));
    lines
}

/// The words on a paper: with a `heading`, also the seams of its edges.
fn words(paper: &Paper, rule: &AllowanceRule, heading: Option<String>) -> PieceWords {
    let drawing = rule.drawing;
    let width = |(r, i): (usize, usize)| {
        let edge = &drawing.rings[r][i];
        label::EdgeWidth { name: &edge.name, width: rule.width(r, i), length: edge.path.length() }
    };
    let outline = (0..drawing.rings[0].len()).filter(|&i| drawing.is_cut(i)).map(|i| (0, i));
    let holes = rule.hole_edges().map(width).filter(|w| w.width > 0.0);
    let widths: Vec<label::EdgeWidth> = outline.map(width).chain(holes).collect();
    let seams = |name: &str| {
        let named = drawing.rings.iter().flatten().find(|edge| Side::is_copy(name, &edge.name));
        named.map(|edge| edge.seams.join(", ")).filter(|seams| !seams.is_empty())
    };
    let with_seams = heading.is_some();
    let mut words = PieceWords::new(paper, heading, &widths, drawing.note.as_deref());
    let sewn = paper.sew.iter().enumerate().filter(|_| with_seams);
    words.seams = sewn.filter_map(|(k, line)| Some((k, seams(&line.name)?))).collect();
    words
}
