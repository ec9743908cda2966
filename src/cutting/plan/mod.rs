//! Cutting plans: all pieces of a garment laid on cloth of a given width, per fabric.
//!
//! The warp of every piece runs along the cloth. On cloth that is folded along its length, right sides together, pieces
//! that are cut on the fold lie at it as halves, and one paper of a pair gives both; what is cut once lies on a stretch
//! of open cloth after that. Pieces are laid one by one as far up as they go, in the best of many orders.

mod columns;
mod order;
mod strip;

use nalgebra::Matrix2;

use super::clean::double_area;
use super::{ClothLength, Paper, Sheet};
use crate::geometry::{MM, Vec2, box_of};
use columns::ShapeColumns;
use order::laid;
use strip::Item;

/// Width of the columns in which pieces are laid, metres: while orders are tried, and in the end.
const COLUMNS: [f64; 2] = [0.006, 0.002];
/// Sine of the angle between grain and fold up to which a piece can lie at the fold of the cloth.
const PARALLEL: f64 = 1e-3;
/// Rim of the sheet, metres.
const MARGIN: f64 = 0.010;
/// Room for a line of text above a stretch of cloth, metres.
const HEAD: f64 = 0.045;

/// How pieces may be laid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanOptions {
    /// Usable width of the cloth, metres.
    pub width: f64,
    /// Whether the cloth looks another way upside down: pile, or a pattern with an up. All pieces lie the same way up.
    pub nap: bool,
    /// Whether all pieces are cut from open cloth.
    pub open: bool,
}

/// Why pieces cannot be laid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// A piece wider than the cloth.
    #[error(
        "'{piece}' is {width:.0} mm wide across its grain, and the cloth {cloth:.0} mm; give a larger --width, or \
         divide the piece"
    )]
    TooWide {
        /// The piece.
        piece: String,
        /// Its width, mm.
        width: f64,
        /// Width of the cloth, mm.
        cloth: f64,
    },
}

/// The plan of one fabric.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The garment's name for it.
    pub fabric: String,
    /// The library's fabric that it is, if it is one.
    pub cloth: Option<String>,
    /// Width of the cloth, metres.
    pub width: f64,
    /// Length of folded cloth, metres.
    pub folded: f64,
    /// Length of open cloth after it, metres.
    pub open: f64,
    /// Area of all pieces as cut, m².
    pub area: f64,
    /// The pieces where they lie: metres from the fold, or the left selvedge, and from the beginning of the cloth.
    pub papers: Vec<LaidPaper>,
}

/// A piece on the cloth.
#[derive(Clone, Debug)]
pub struct LaidPaper {
    /// Where it lies.
    pub paper: Paper,
    /// Whether it is turned by half.
    pub turned: bool,
    /// Whether it lies with its other side up, which on folded cloth is the same.
    pub flipped: bool,
    /// Number of pieces that it gives.
    pub pieces: usize,
    /// Whether it lies on folded cloth.
    pub folded: bool,
}

impl Plan {
    /// Length of cloth, metres.
    pub fn length(&self) -> f64 {
        self.folded + self.open
    }

    /// Share of the cloth that becomes pieces.
    pub fn efficiency(&self) -> f64 {
        let cloth = self.width * self.length();
        if cloth > 0.0 { self.area / cloth } else { 0.0 }
    }
}

/// Lays the pieces of garments on their fabrics. `drawn` are the papers as they are drawn, `whole` those of the same
/// garments as they are cut.
///
/// # Errors
/// [`PlanError`]: a piece wider than its cloth.
pub fn plans(drawn: &[Paper], whole: &[Paper], options: &PlanOptions) -> Result<Vec<Plan>, PlanError> {
    let mut fabrics: Vec<(&str, Option<&str>)> = Vec::new();
    for paper in whole {
        let key = (paper.fabric.as_str(), paper.cloth.as_deref());
        if !fabrics.contains(&key) {
            fabrics.push(key);
        }
    }
    let of = |papers: &[Paper], key: (&str, Option<&str>)| -> Vec<Paper> {
        papers.iter().filter(|p| (p.fabric.as_str(), p.cloth.as_deref()) == key).cloned().collect()
    };
    fabrics.into_iter().map(|key| plan(&of(drawn, key), &of(whole, key), options)).collect()
}

fn plan(drawn: &[Paper], whole: &[Paper], options: &PlanOptions) -> Result<Plan, PlanError> {
    let half = 0.5 * options.width;
    let fits = |paper: &Paper| way_size(paper).x <= half;
    let doubled: Vec<Paper> = drawn.iter().filter(|p| !options.open && is_doubled(p) && fits(p)).cloned().collect();
    let is_left = |paper: &&Paper| doubled.iter().all(|d| d.name != stem(&paper.name));
    let single: Vec<Paper> = whole.iter().filter(is_left).cloned().collect();
    let (mut papers, folded) = lay(&doubled, half, true, options)?;
    let (rest, open) = lay(&single, options.width, false, options)?;
    papers.extend(rest.into_iter().map(|laid| LaidPaper { paper: moved(&laid.paper, Vec2::new(0.0, folded)), ..laid }));
    let first = &whole[0];
    Ok(Plan {
        fabric: first.fabric.clone(),
        cloth: first.cloth.clone(),
        width: options.width,
        folded,
        open,
        area: whole.iter().map(|p| 0.5 * double_area(&outline(p)).abs()).sum(),
        papers,
    })
}

/// The drawn piece of a piece as cut, `front` of `front.L`.
fn stem(name: &str) -> &str {
    // The names of garments of an outfit stand before a slash, and names of pieces have no points.
    name.split('.').next().unwrap_or_default()
}

/// Whether a paper gives its pieces from two layers of cloth that lie with their right sides together.
fn is_doubled(paper: &Paper) -> bool {
    let Some([from, to]) = paper.fold else { return paper.mirrored };
    (to - from).try_normalize(0.0).is_some_and(|along| along.x.abs() < PARALLEL)
}

/// The outline that is cut, closed.
fn outline(paper: &Paper) -> Vec<Vec2> {
    let mut points = paper.cut.first().cloned().unwrap_or_default();
    // A half runs from the end of its fold to its start: the fold closes it.
    points.extend(paper.fold.iter().flatten().take(1));
    points
}

fn way_size(paper: &Paper) -> Vec2 {
    let [low, high] = box_of(outline(paper));
    high - low
}

fn moved(paper: &Paper, by: Vec2) -> Paper {
    paper.mapped(Matrix2::identity(), by)
}

/// The ways in which a paper may lie, each with whether it is turned and flipped.
fn ways(paper: &Paper, folded: bool, nap: bool) -> Vec<(Paper, bool, bool)> {
    let way = |turned: bool, flipped: bool| {
        let (x, y) = (if turned != flipped { -1.0 } else { 1.0 }, if turned { -1.0 } else { 1.0 });
        (paper.mapped(Matrix2::new(x, 0.0, 0.0, y), Vec2::zeros()), turned, flipped)
    };
    let turns: &[bool] = if nap { &[false] } else { &[false, true] };
    let flips: &[bool] = if folded { &[false, true] } else { &[false] };
    let all = turns.iter().flat_map(|&turned| flips.iter().map(move |&flipped| (turned, flipped)));
    // At the fold the cloth lies to the right of it.
    let suits = |(paper, _, _): &(Paper, bool, bool)| {
        let Some([from, _]) = paper.fold else { return true };
        let [low, high] = box_of(outline(paper));
        from.x - low.x < high.x - from.x
    };
    all.map(|(turned, flipped)| way(turned, flipped)).filter(suits).collect()
}

/// Lays papers on cloth of a width, and says how much of it they take.
fn lay(papers: &[Paper], width: f64, folded: bool, options: &PlanOptions) -> Result<(Vec<LaidPaper>, f64), PlanError> {
    if papers.is_empty() {
        return Ok((Vec::new(), 0.0));
    }
    if let Some(wide) = papers.iter().find(|p| way_size(p).x > width) {
        let (piece, width, cloth) = (wide.name.clone(), way_size(wide).x * MM, width * MM);
        return Err(PlanError::TooWide { piece, width, cloth });
    }
    let all: Vec<Vec<(Paper, bool, bool)>> = papers.iter().map(|p| ways(p, folded, options.nap)).collect();
    let [coarse, fine] = COLUMNS.map(|column| {
        let item = |ways: &Vec<(Paper, bool, bool)>| Item {
            ways: ways.iter().map(|(paper, _, _)| ShapeColumns::new(&outline(paper), column)).collect(),
            at_fold: folded && ways[0].0.fold.is_some(),
        };
        all.iter().map(item).collect::<Vec<Item>>()
    });
    let Some(found) = laid(&coarse, &fine, width, COLUMNS) else { return Ok((Vec::new(), 0.0)) };
    let put = |(ways, spot): (&Vec<(Paper, bool, bool)>, &strip::StripSpot)| {
        let (paper, turned, flipped) = &ways[spot.way];
        let [low, _] = box_of(outline(paper));
        let pieces = if folded && paper.fold.is_none() { 2 } else { 1 };
        LaidPaper { paper: moved(paper, spot.corner - low), turned: *turned, flipped: *flipped, pieces, folded }
    };
    Ok((all.iter().zip(&found.spots).map(put).collect(), found.length))
}

/// The plans of all fabrics below each other, as one drawing.
pub fn plan_sheet(plans: &[Plan]) -> Sheet {
    let (mut papers, mut cloth) = (Vec::new(), Vec::new());
    let (mut y, mut wide) = (MARGIN, 0.0f64);
    for plan in plans {
        let stretches = [(true, 0.0, plan.folded), (false, plan.folded, plan.open)];
        for (folded, from, length) in stretches.into_iter().filter(|s| s.2 > 0.0) {
            let corner = Vec2::new(MARGIN, y + HEAD);
            let width = if folded { 0.5 * plan.width } else { plan.width };
            let own = plan.papers.iter().filter(|laid| laid.folded == folded);
            papers.extend(own.map(|laid| moved(&laid.paper, corner - Vec2::new(0.0, from))));
            cloth.push(ClothLength {
                corner,
                size: Vec2::new(width, length),
                folded,
                text: said(plan, folded, length),
            });
            wide = wide.max(width);
            y += HEAD + length;
        }
    }
    Sheet { size: Vec2::new(wide + 2.0 * MARGIN, y + MARGIN), papers, square: None, cloth }
}

fn said(plan: &Plan, folded: bool, length: f64) -> String {
    let name = plan.cloth.as_ref().map_or_else(|| plan.fabric.clone(), |cloth| format!("{} ({cloth})", plan.fabric));
    let how = if folded { "folded, the fold on the left" } else { "open" };
    format!("{name}, {:.0} mm wide, {how}: {:.0} mm", plan.width * MM, length * MM)
}
