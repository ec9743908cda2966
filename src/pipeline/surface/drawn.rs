//! Cuts along lines that were drawn in space: they are laid onto the surface, and straight between their points.

use std::path::Path;

use super::super::error::PipelineError;
use super::cuts::straight;
use super::even::local;
use super::parts::SurfacePart;
use super::report::CutWhy;
use super::sheet::CutFaces;
use crate::contact::nearest_on_surface;
use crate::flatten::line::Web;
use crate::flatten::{Solid, shortest_path};
use crate::geometry::{Topology, Vec3, distance_to_segment, nearest_on_segment};
use crate::io::lines_read::read_lines;

/// Points of a drawn line that are nearer than this to the line without them, metres, do not count: half of what a
/// person draws straight.
const STRAIGHT: f64 = 2.5e-4;
/// A line that ends within this distance of the rim ends on it, metres.
const TO_RIM: f64 = 1e-3;

/// Cuts along the lines of a file, in the unit and the axes of the surface.
pub(super) fn cut_drawn(sheet: &mut CutFaces, file: &Path) -> Result<(), PipelineError> {
    for (k, line) in (1..).zip(read_lines(file)?) {
        let places: Vec<Vec3> = line.into_iter().map(|p| sheet.space.place(p)).collect();
        let refused = |why: String| PipelineError::Drawn { file: file.to_owned(), line: k, why };
        draw(sheet, &thinned(&places)).map_err(refused)?;
    }
    sheet.cut_planned(CutWhy::Asked);
    Ok(())
}

/// Plans the cut along one line.
fn draw(sheet: &mut CutFaces, places: &[Vec3]) -> Result<(), String> {
    let number = part_of(sheet, places)?;
    let name = sheet.parts()[number].name.clone();
    let mut chain: Vec<u32> = Vec::new();
    let mut before: Option<u32> = None;
    for (k, &place) in places.iter().enumerate() {
        let is_end = k == 0 || k + 1 == places.len();
        let vertex = vertex_at(sheet, number, place, is_end);
        if let Some(from) = before.filter(|from| *from != vertex) {
            let part = sheet.parts().swap_remove(number);
            let ends = local(&part, from).zip(local(&part, vertex));
            let way = ends.and_then(|(a, b)| shortest_path(&part.surface, &Solid::new(), a, b));
            let way = way.ok_or_else(|| format!("points {k} and {} do not lie in one part of the surface", k + 1))?;
            let stretch = sheet.split(&part, &straight(&part, &way));
            chain.extend(stretch.into_iter().skip(usize::from(!chain.is_empty())));
        }
        before = Some(vertex);
    }
    if chain.len() < 2 {
        return Err("it is a single point of the surface; draw it on, or nearer to, the surface".into());
    }
    sheet.plan(name, chain);
    Ok(())
}

/// The part that most points of a line are nearest to.
fn part_of(sheet: &CutFaces, places: &[Vec3]) -> Result<usize, String> {
    let parts = sheet.parts();
    let far = |part: &SurfacePart, p: Vec3| nearest_on_surface(&part.surface, p).2;
    let nearest_part = |p: Vec3| {
        let all: Vec<f64> = parts.iter().map(|part| far(part, p)).collect();
        (0..all.len()).min_by(|&a, &b| all[a].total_cmp(&all[b]))
    };
    let mut votes = vec![0usize; parts.len()];
    places.iter().filter_map(|&p| nearest_part(p)).for_each(|k| votes[k] += 1);
    let first = (0..votes.len()).max_by(|&a, &b| votes[a].cmp(&votes[b]).then(b.cmp(&a)));
    let number = first.ok_or("there is no surface")?;
    let mut others = (0..votes.len()).filter(|&k| k != number && votes[k] > 1);
    match others.next() {
        Some(other) => Err(format!(
            "it runs from '{}' to '{}'; draw a line for each of them",
            parts[number].name, parts[other].name
        )),
        None => Ok(number),
    }
}

/// The vertex at the point of a part nearest to `place`, a new one where there is none. The end of a line that is near
/// the rim lies on it.
fn vertex_at(sheet: &mut CutFaces, number: usize, place: Vec3, is_end: bool) -> u32 {
    let part = sheet.parts().swap_remove(number);
    let web = Web::new(&part.surface);
    let (triangle, weights, _) = nearest_on_surface(&part.surface, place);
    let mut spot = web.on_side(&part.surface, triangle as u32, weights);
    if is_end {
        let topology = Topology::new(&part.surface.triangles);
        let at = |v: u32| part.surface.vertices[v as usize];
        let p = spot.place(&part.surface);
        let sides = topology.rim_edges().map(|e| (e.ends, nearest_on_segment(p, e.ends.map(at))));
        let near = sides.min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        if let Some((ends, (share, _))) = near.filter(|near| near.1.1 < TO_RIM) {
            spot = web.on_edge(&part.surface, ends, share);
        }
    }
    sheet.split(&part, &[spot])[0]
}

/// The points of a line without those that lie on the straight line between others (Douglas & Peucker 1973).
fn thinned(line: &[Vec3]) -> Vec<Vec3> {
    let (Some(&first), Some(&last)) = (line.first(), line.last()) else { return Vec::new() };
    let inner = 1..line.len().saturating_sub(1);
    let far = |k: usize| distance_to_segment(line[k], [first, last]);
    match inner.max_by(|&a, &b| far(a).total_cmp(&far(b))).filter(|&k| far(k) > STRAIGHT) {
        Some(k) => {
            let mut out = thinned(&line[..=k]);
            out.pop();
            out.extend(thinned(&line[k..]));
            out
        }
        None => vec![first, last],
    }
}
