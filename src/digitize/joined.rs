//! Outlines drawn as several open lines of which nothing says that they are edges.

use super::Stroke;
use super::chain::{bridged, chained, gaping, is_closed, nearly_meet};
use super::contour::Contour;
use crate::geometry::{MM, Path, Vec2};

/// The middle of a gap that was closed is as near to the line over it as this (metres).
const GAP_AT: f64 = 1e-6;
/// Most names of lines that a message lists.
const LISTED: usize = 4;

/// An outline, and the lines it was made of.
pub(super) struct JoinedOutline {
    pub(super) contour: Contour,
    pub(super) lines: Vec<Stroke>,
    /// The widest gap of ends that were joined, metres. Nought where all meet.
    pub(super) gap: f64,
}

/// An outline of which two ends are too far from each other to be joined.
pub(super) struct Unclosed {
    name: Option<String>,
    /// Middle and width of the gap, metres.
    gap: (Vec2, f64),
    /// Area inside if it were closed straight across, m².
    pub(super) area: f64,
}

/// The outlines that these lines nearly make: of each group the runs that would go round so much (square metres) if
/// they were closed; and the lines that are in none.
pub(super) fn nearly_closed(lines: &[Stroke], smallest: f64) -> (Vec<Unclosed>, Vec<Stroke>) {
    let (mut open, mut rest) = (Vec::new(), Vec::new());
    for (layer, own) in grouped(lines) {
        let numbered: Vec<(usize, Path)> = own.iter().enumerate().map(|(k, line)| (k, line.path.clone())).collect();
        let mut used = vec![false; own.len()];
        for outline in gaping(chained(&numbered)).into_iter().filter(|outline| outline.area() >= smallest) {
            outline.run.iter().for_each(|(k, _)| used[*k] = true);
            let named = |(k, _): &(usize, Path)| own[*k].group.clone().or_else(|| own[*k].name.clone());
            let name = layer.clone().or_else(|| outline.run.iter().find_map(named));
            open.push(Unclosed { name, gap: outline.widest, area: outline.area() });
        }
        rest.extend(own.iter().zip(&used).filter(|(_, used)| !**used).map(|(line, _)| (*line).clone()));
    }
    (open, rest)
}

impl Unclosed {
    /// Note on it.
    pub(super) fn sentence(&self) -> String {
        let of = self.name.as_ref().map_or_else(String::new, |name| format!(" of '{name}'"));
        let (at, gap) = self.gap;
        format!(
            "the outline{of} is not closed: two of its ends near ({:.1}, {:.1}) mm are {:.2} mm apart; it is left out, \
             {:.2} cm² if it were closed there; make its ends meet",
            MM * at.x,
            MM * at.y,
            MM * gap,
            1e4 * self.area
        )
    }
}

/// The outlines that lines of one group make where they meet end to end, and the lines that belong to none.
pub(super) fn joined(strokes: &[Stroke]) -> (Vec<JoinedOutline>, Vec<Stroke>) {
    let (mut outlines, mut rest) = (Vec::new(), Vec::new());
    for (group, lines) in grouped(strokes) {
        let (bound, loose) = by_loose_ends(lines);
        rest.extend(loose.into_iter().cloned());
        let bound: Vec<(&Stroke, Path)> = bound.into_iter().map(|line| (line, line.path.clone())).collect();
        let joined = bridged(chained(&bound));
        for run in joined.runs {
            let is_own = |at: Vec2| run.iter().any(|(_, path)| path.nearest(at).1 <= GAP_AT);
            let gap = joined.gaps.iter().filter(|(at, _)| is_own(*at)).map(|(_, gap)| *gap).fold(0.0, f64::max);
            let lines: Vec<Stroke> = run.iter().map(|(line, _)| (*line).clone()).collect();
            let edges = run.into_iter().map(|(line, path)| (line.name.clone(), path)).collect();
            let contour = Contour::of_edges(edges, group.clone());
            match contour.filter(|_| lines.len() > 1 || gap > 0.0) {
                Some(contour) => outlines.push(JoinedOutline { contour, lines, gap }),
                None => rest.extend(lines),
            }
        }
    }
    (outlines, rest)
}

/// The lines of every group or layer, in the order of the drawing.
fn grouped(strokes: &[Stroke]) -> Vec<(Option<String>, Vec<&Stroke>)> {
    let mut groups: Vec<(Option<String>, Vec<&Stroke>)> = Vec::new();
    for stroke in strokes {
        match groups.iter_mut().find(|(layer, _)| *layer == stroke.layer) {
            Some((_, lines)) => lines.push(stroke),
            None => groups.push((stroke.layer.clone(), vec![stroke])),
        }
    }
    groups
}

/// The lines that meet others at both ends, and those that do not: a line that ends at a corner of an outline is no
/// part of it, and must not be taken for the next edge.
fn by_loose_ends(mut lines: Vec<&Stroke>) -> (Vec<&Stroke>, Vec<&Stroke>) {
    let mut places: Vec<Vec2> = Vec::new();
    let mut place_of = |p: Vec2| {
        places.iter().position(|q| nearly_meet(p, *q)).unwrap_or_else(|| {
            places.push(p);
            places.len() - 1
        })
    };
    let mut ends: Vec<[usize; 2]> = lines.iter().map(|l| [l.path.start(), l.path.end()].map(&mut place_of)).collect();
    let mut loose = Vec::new();
    loop {
        let mut met = vec![0; places.len()];
        ends.iter().flatten().for_each(|&place| met[place] += 1);
        // What is taken away may leave the line before it loose.
        let Some(k) = ends.iter().position(|own| own.iter().any(|&place| met[place] < 2)) else { break };
        loose.push(lines.remove(k));
        ends.remove(k);
    }
    (lines, loose)
}

/// Notes on lines that make no outline and lie on no piece: a sentence for each group.
pub(super) fn unclosed(lines: &[Stroke]) -> Vec<String> {
    grouped(lines).iter().map(|(layer, lines)| sentence(layer.as_deref(), lines)).collect()
}

fn sentence(layer: Option<&str>, lines: &[&Stroke]) -> String {
    let names: Vec<Option<String>> = lines.iter().map(|line| line.name.clone()).collect();
    let count = lines.len();
    let what = if count == 1 { "1 open line".to_owned() } else { format!("{count} open lines") };
    let of = layer.map_or_else(String::new, |layer| format!(" of '{layer}'"));
    let gap = gap(lines).map_or_else(String::new, |metres| {
        format!(": their nearest ends that do not meet are {:.2} mm apart", 1e3 * metres)
    });
    format!(
        "left out: {what}{of}{} on no piece, which close to no outline{gap}; make them meet end to end in one group, \
         or one closed path, to have a piece",
        listed(&names)
    )
}

/// Note on lines between the sewing line and the cut line of a piece, if there are any.
pub(super) fn beyond_seam(piece: &str, lines: &[Option<String>]) -> Option<String> {
    let what = match lines.len() {
        0 => return None,
        1 => "1 line".to_owned(),
        count => format!("{count} lines"),
    };
    Some(format!("left out: {what}{} in the allowance of '{piece}', beyond its sewing line", listed(lines)))
}

/// ` ('waist', 'side')`, as far as they have names.
fn listed(lines: &[Option<String>]) -> String {
    let names: Vec<String> = lines.iter().filter_map(|name| Some(format!("'{}'", name.as_ref()?))).collect();
    match names.len() {
        0 => String::new(),
        few if few <= LISTED => format!(" ({})", names.join(", ")),
        _ => format!(" ({}, …)", names[..LISTED].join(", ")),
    }
}

/// The least distance of two ends of the runs that lines make, metres.
fn gap(lines: &[&Stroke]) -> Option<f64> {
    let paths: Vec<((), Path)> = lines.iter().map(|line| ((), line.path.clone())).collect();
    let open: Vec<_> = chained(&paths).into_iter().filter(|run| !is_closed(run)).collect();
    let ends: Vec<Vec2> = open.iter().flat_map(|run| [run[0].1.start(), run[run.len() - 1].1.end()]).collect();
    let pairs = ends.iter().enumerate().flat_map(|(k, p)| ends[k + 1..].iter().map(move |q| (p - q).norm()));
    pairs.min_by(f64::total_cmp)
}
