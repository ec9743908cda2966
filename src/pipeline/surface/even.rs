//! Even darts of round parts: as many meridians, from the rim towards the pole, all of one length.

use rayon::prelude::*;

use super::Darts;
use super::darts::{DartStop, LaidPart, LayingInput};
use super::parts::SurfacePart;
use super::report::CutWhy;
use super::sheet::CutFaces;
use crate::flatten::line::{SurfacePoint, Web, begun, length};
use crate::flatten::round::Round;

/// A part is round when its rim is nowhere nearer to its axis than this share of its largest distance: an ellipse of
/// three to four is, a square is not.
const ROUND: f64 = 0.75;
/// How far from the pole darts may end, as shares of the way to the rim: that is chosen which leaves least strain. The
/// nearer they end the more the darts take away, and the more strain there is at their tips.
const TIPS: [f64; 8] = [0.08, 0.12, 0.16, 0.2, 0.25, 0.3, 0.4, 0.5];
/// Even darts that `auto` tries, the fewest first.
const AUTO: [usize; 3] = [4, 6, 8];
/// Even darts that are tried where there may be as many as are needed.
const ENOUGH: [usize; 9] = [3, 4, 6, 8, 10, 12, 16, 20, 24];
/// With fewer a dart is no even one.
const FEWEST: usize = 2;

/// Cuts even darts into the parts that are round and strained beyond the limit, each its own: so many, or the fewest
/// that bring it within the limit.
pub(super) fn even_darts(source: &LayingInput<'_>, sheet: &mut CutFaces, laid: &mut [LaidPart], darts: Darts) {
    let counts = match darts {
        Darts::Auto => AUTO.to_vec(),
        Darts::Enough => ENOUGH.to_vec(),
        Darts::Count(count) => vec![count],
    };
    for own in laid.iter_mut().filter(|own| source.options.limit.passed(&own.flat.report)) {
        let mut best: Option<(LaidPart, CutFaces)> = None;
        for &count in counts.iter().filter(|count| **count >= FEWEST) {
            let Some(darted) = with_even_darts(source, sheet, own, count) else { continue };
            let enough = !source.options.limit.passed(&darted.0.flat.report);
            best = Some(darted);
            if enough {
                break;
            }
        }
        if let Some((darted, cut)) = best {
            (*own, *sheet) = (darted, cut);
            // Another one would not be even.
            own.stop = source.options.limit.passed(&own.flat.report).then_some(DartStop::NoneLeft);
        }
    }
}

/// A round part with so many even darts, and the sheet with them: `None` where it is not round, or no such darts leave
/// less strain.
fn with_even_darts(
    source: &LayingInput<'_>,
    sheet: &CutFaces,
    own: &LaidPart,
    count: usize,
) -> Option<(LaidPart, CutFaces)> {
    let mut drawn = sheet.clone();
    let (round, pole) = with_pole(&mut drawn, own.number)?;
    let tried = TIPS.into_par_iter().map(|tip| {
        let mut cut = drawn.clone();
        draw_darts(&mut cut, own.number, &round, pole, [count as f64, tip])?;
        cut.cut_planned(CutWhy::Dart);
        let laid = source.lay_of(&cut, own.number).ok()?;
        cut.tell_strain(sheet.made.len(), [own, &laid].map(|laid| laid.flat.report.strain_p99));
        laid.lies_as_well_as(own).then_some((laid, cut))
    });
    let tried: Vec<(LaidPart, CutFaces)> = tried.collect::<Vec<_>>().into_iter().flatten().collect();
    let strain = |laid: &LaidPart| source.options.limit.share(&laid.flat.report);
    let best = tried.into_iter().min_by(|a, b| strain(&a.0).total_cmp(&strain(&b.0)))?;
    (strain(&best.0) < strain(own)).then(|| (LaidPart { darts: count, stop: None, ..best.0 }, best.1))
}

/// The axis of a round part, and the vertex at its pole, which is a new one where there was none.
fn with_pole(sheet: &mut CutFaces, number: usize) -> Option<(Round, u32)> {
    let part = sheet.parts().into_iter().nth(number)?;
    let round = Round::of(&part.surface, &Web::new(&part.surface))?;
    if round.evenness < ROUND {
        return None;
    }
    let pole = *sheet.split(&part, &round.poles[..1]).first()?;
    Some((round, pole))
}

/// Draws so many darts that end at a share of the way from the pole to the rim.
fn draw_darts(sheet: &mut CutFaces, number: usize, round: &Round, pole: u32, [count, tip]: [f64; 2]) -> Option<()> {
    for k in 0..count as usize {
        let part = sheet.parts().into_iter().nth(number)?;
        let web = Web::new(&part.surface);
        let pole = local(&part, pole)?;
        let line = round.meridian(&part.surface, &web, &[pole], k, count as usize)?;
        let line: Vec<SurfacePoint> = line.into_iter().rev().collect();
        let dart = begun(&part.surface, &web, &line, (1.0 - tip) * length(&part.surface, &line));
        sheet.draw(&part, &dart);
    }
    Some(())
}

/// The vertex of a part that is this one of the file.
pub(super) fn local(part: &SurfacePart, vertex: u32) -> Option<u32> {
    part.vertices.iter().position(|&v| v == vertex).map(|k| k as u32)
}
