//! Gores of round parts and panels of long ones: cut from pole to rim, from pole to pole, or from rim to rim.

use super::super::error::PipelineError;
use super::cuts::{cut_sharp, straight};
use super::darts::LayingInput;
use super::even::local;
use super::parts::SurfacePart;
use super::report::CutWhy;
use super::sheet::CutFaces;
use crate::flatten::line::Web;
use crate::flatten::round::Round;
use crate::flatten::{Solid, shortest_path};
use crate::geometry::{Vec3, nearest_on_segment, rim_loops};

/// A part whose strain is less lies flat as it is, and gores would win nothing.
const FLAT: f64 = 1e-3;

/// Cuts every part into so many gores or panels, but for those that lie flat as they are, holes and all; notes on these
/// and on those that have no such form.
pub(super) fn cut_gores(
    source: &LayingInput<'_>,
    sheet: &mut CutFaces,
    count: usize,
) -> Result<Vec<String>, PipelineError> {
    set_brims_off(source, sheet);
    let mut notes = Vec::new();
    let mut without = None;
    let mut done = 0;
    for (number, part) in sheet.parts().into_iter().enumerate() {
        let name = part.name.clone();
        if lies_flat(source, part) {
            notes.push(format!("'{name}' lies flat as it is, and is not cut into gores"));
            continue;
        }
        let mut cut = sheet.clone();
        if draw_gores(&mut cut, number, count).is_some() {
            *sheet = cut;
            done += 1;
        } else {
            let why = "it is neither a dome, nor a ball, nor a tube; --cut cuts along a line";
            notes.push(format!("'{name}' is not cut into gores: {why}"));
            without = without.or_else(|| notes.last().cloned());
        }
    }
    match without.filter(|_| done == 0) {
        Some(why) => Err(PipelineError::Gores { file: source.file.to_owned(), why }),
        None => {
            sheet.cut_planned(CutWhy::Gore);
            Ok(notes)
        }
    }
}

/// Cuts along sharp edges where that parts what lies flat as it is, such as a hat's brim, from what does not.
fn set_brims_off(source: &LayingInput<'_>, sheet: &mut CutFaces) {
    let mut cut = sheet.clone();
    cut_sharp(&mut cut);
    let parts = cut.parts();
    if parts.len() > sheet.parts().len() {
        let flat = parts.into_iter().map(|part| lies_flat(source, part)).collect::<Vec<_>>();
        if flat.contains(&true) && flat.contains(&false) {
            *sheet = cut;
        }
    }
}

/// Whether a part lies flat with all its rims and hardly a strain.
fn lies_flat(source: &LayingInput<'_>, part: SurfacePart) -> bool {
    source.lay(0, part, Vec::new()).is_ok_and(|laid| laid.flat.report.strain_p99 < FLAT)
}

/// Draws the lines between the gores of a part, whatever its form is; `None` where it has none.
pub(super) fn draw_gores(sheet: &mut CutFaces, number: usize, count: usize) -> Option<()> {
    let part = sheet.parts().into_iter().nth(number)?;
    part.turned.as_ref()?;
    match rim_loops(&part.surface.triangles).len() {
        0 | 1 => meridians(sheet, &part, number, count),
        2 => panels(sheet, number, count),
        _ => None,
    }
}

/// Lines from the pole of a part to its rim, or to the opposite pole.
fn meridians(sheet: &mut CutFaces, part: &SurfacePart, number: usize, count: usize) -> Option<()> {
    let round = Round::of(&part.surface, &Web::new(&part.surface))?;
    let poles: Vec<u32> = sheet.split(part, &round.poles);
    for k in 0..count {
        let part = sheet.parts().into_iter().nth(number)?;
        let web = Web::new(&part.surface);
        let poles: Vec<u32> = poles.iter().map(|&v| local(&part, v)).collect::<Option<_>>()?;
        let line = round.meridian(&part.surface, &web, &poles, k, count)?;
        sheet.draw(&part, &line.into_iter().rev().collect::<Vec<_>>());
    }
    Some(())
}

/// Straight lines between even points of two rims.
fn panels(sheet: &mut CutFaces, number: usize, count: usize) -> Option<()> {
    let part = sheet.parts().into_iter().nth(number)?;
    let rims = rim_loops(&part.surface.triangles);
    let places = |rim: &[u32]| -> Vec<Vec3> { rim.iter().map(|&v| part.surface.vertices[v as usize]).collect() };
    let (first, second) = (places(&rims[0]), places(&rims[1]));
    let middle = |rim: &[Vec3]| rim.iter().sum::<Vec3>() / rim.len() as f64;
    // From the back: there a seam is looked for.
    let back = (0..first.len()).min_by(|&a, &b| first[a].z.total_cmp(&first[b].z))?;
    let off = first[back] - middle(&first);
    let far = |k: usize| (second[k] - middle(&second) - off).norm();
    let facing = (0..second.len()).min_by(|&a, &b| far(a).total_cmp(&far(b)))?;
    let (from, to) = (even_places(&first, back, count), even_places(&second, facing, count));
    let from: Vec<u32> = from.into_iter().map(|p| rim_vertex(sheet, number, p)).collect::<Option<_>>()?;
    let to: Vec<u32> = to.into_iter().map(|p| rim_vertex(sheet, number, p)).collect::<Option<_>>()?;
    for k in 0..count {
        let part = sheet.parts().into_iter().nth(number)?;
        // The rims run round against each other.
        let ends = [local(&part, from[k])?, local(&part, to[(count - k) % count])?];
        let chain = shortest_path(&part.surface, &Solid::new(), ends[0], ends[1])?;
        sheet.draw(&part, &straight(&part, &chain));
    }
    Some(())
}

/// So many places along a closed chain, evenly from one of its corners on.
fn even_places(rim: &[Vec3], first: usize, count: usize) -> Vec<Vec3> {
    let at = |k: usize| rim[(first + k) % rim.len()];
    let total: f64 = (0..rim.len()).map(|k| (at(k + 1) - at(k)).norm()).sum();
    let (mut places, mut passed) = (Vec::with_capacity(count), 0.0);
    for k in 0..rim.len() {
        let side = (at(k + 1) - at(k)).norm();
        while places.len() < count && total * places.len() as f64 / count as f64 <= passed + side {
            let left = total * places.len() as f64 / count as f64 - passed;
            places.push(at(k).lerp(&at(k + 1), if side > 0.0 { left / side } else { 0.0 }));
        }
        passed += side;
    }
    places
}

/// The vertex of the rim of a part at a place, a new one where there is none.
fn rim_vertex(sheet: &mut CutFaces, number: usize, place: Vec3) -> Option<u32> {
    let part = sheet.parts().into_iter().nth(number)?;
    let web = Web::new(&part.surface);
    let at = |v: u32| part.surface.vertices[v as usize];
    let rims = rim_loops(&part.surface.triangles);
    let sides = rims.iter().flat_map(|rim| (0..rim.len()).map(move |k| [rim[k], rim[(k + 1) % rim.len()]]));
    let near = sides.map(|ends| (ends, nearest_on_segment(place, ends.map(at))));
    let (ends, (share, _)) = near.min_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
    let spot = web.on_edge(&part.surface, ends, share);
    sheet.split(&part, &[spot]).first().copied()
}
