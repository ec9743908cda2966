//! Parts that darts cannot cure: those that lie on themselves are cut in two, and for `--max-strain` round ones are cut
//! into gores and all others in two, again and again.

use std::collections::HashSet;

use super::super::error::PipelineError;
use super::Darts;
use super::cuts::{halving, straight_inside};
use super::darts::{LaidPart, LaidSurface, LayingInput, with_darts};
use super::gores::draw_gores;
use super::parts::SurfacePart;
use super::report::CutWhy;
use super::sheet::CutFaces;

/// How often parts are cut in two: into eight at most.
const ROUNDS: usize = 3;
/// Gores that are tried for a strain that must be reached, the fewest first.
const GORES: [usize; 7] = [2, 3, 4, 6, 8, 12, 16];

/// Lays all parts flat with the darts that are asked for and, where these are not enough, what cures them:
/// a part that would lie on itself is cut in two, if its halves do so less; where darts leave more strain than
/// `--max-strain` allows, a part is cut into gores or in two. A cut that does not help is not made.
pub(super) fn laid_apart(source: &LayingInput<'_>, sheet: &mut CutFaces) -> Result<LaidSurface, PipelineError> {
    let mut before = sheet.clone();
    let mut out = with_darts(source, sheet)?;
    for _ in 0..ROUNDS {
        let mut cut = before.clone();
        let wrong = out.laid.iter().filter(|laid| faults(source, laid) > 0.0);
        let drawn = wrong.filter(|laid| draw_cure(source, &mut cut, laid)).count();
        if drawn == 0 {
            break;
        }
        cut.cut_planned(CutWhy::Apart);
        let mut darted = cut.clone();
        let Ok(other) = with_darts(source, &mut darted) else { break };
        let all = |out: &LaidSurface| out.laid.iter().map(|laid| faults(source, laid)).fold(0.0, f64::max);
        if other.failed.len() > out.failed.len() || all(&other) >= all(&out) {
            break;
        }
        (before, *sheet, out) = (cut, darted, other);
    }
    Ok(out)
}

/// How far a part is from what must be: its strain against the limit where that must be reached, and above all others
/// the number of places where it lies on itself; 0 where it is as it must be.
fn faults(source: &LayingInput<'_>, laid: &LaidPart) -> f64 {
    let limit = &source.options.limit;
    match laid.flat.report.overlaps {
        0 if source.options.darts == Some(Darts::Enough) && limit.passed(&laid.flat.report) => {
            limit.share(&laid.flat.report)
        }
        0 => 0.0,
        // A strain of a thousand limits is beyond what any part has.
        count => 1e3 + count as f64,
    }
}

/// Draws what cures a part on a sheet without its darts, which has the same parts.
fn draw_cure(source: &LayingInput<'_>, sheet: &mut CutFaces, laid: &LaidPart) -> bool {
    if laid.flat.report.overlaps == 0 && draw_fewest_gores(source, sheet, laid.number) {
        return true;
    }
    let part = sheet.parts().swap_remove(laid.number);
    draw_halves(sheet, &part)
}

/// Draws the way across a part along which it is best cut in two.
fn draw_halves(sheet: &mut CutFaces, part: &SurfacePart) -> bool {
    let line = straight_inside(part, &halving(part));
    if line.len() > 1 {
        sheet.draw(part, &line);
    }
    line.len() > 1
}

/// Draws the fewest gores that bring a part within the limit, if it has such a form.
fn draw_fewest_gores(source: &LayingInput<'_>, sheet: &mut CutFaces, number: usize) -> bool {
    let found = GORES.into_iter().find_map(|count| {
        let mut drawn = sheet.clone();
        draw_gores(&mut drawn, number, count)?;
        is_enough(source, &drawn, number).then_some(drawn)
    });
    let Some(drawn) = found else { return false };
    *sheet = drawn;
    true
}

/// Whether what is drawn on a sheet brings the part of this number within the limit.
fn is_enough(source: &LayingInput<'_>, drawn: &CutFaces, number: usize) -> bool {
    let whole: HashSet<u32> = drawn.parts().swap_remove(number).faces.into_iter().collect();
    let mut cut = drawn.clone();
    cut.cut_planned(CutWhy::Apart);
    let of_it = |part: &SurfacePart| part.faces.iter().all(|f| whole.contains(f));
    cut.parts().into_iter().filter(of_it).all(|part| {
        let laid = source.lay(0, part, Vec::new());
        laid.is_ok_and(|laid| laid.flat.report.overlaps == 0 && !source.options.limit.passed(&laid.flat.report))
    })
}
