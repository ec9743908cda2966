//! Darts on edges: legs out of an outline and into a garment file.

use super::edges::{FileEdge, nearest_edge};
use super::smooth::smoothed;
use crate::geometry::{Path, Vec2};

/// Legs may differ by this much (metres), a little less than a garment file takes: rounding comes on top.
const LEGS_APART: f64 = 4e-4;

/// An edge of an outline, which may have a name.
type Named = (Option<String>, Path);

/// A dart whose legs were taken out of an outline.
#[derive(Clone, Debug)]
pub(super) struct ClosedDart {
    pub(super) name: String,
    /// Start and end of its mouth.
    mouth: [Vec2; 2],
    pub(super) tip: Vec2,
}

impl ClosedDart {
    /// The edge that it opens, the middle of its mouth from there and its intake, metres.
    pub(super) fn on<'e>(&self, edges: &'e [FileEdge]) -> Option<(&'e FileEdge, f64, f64)> {
        let edge = &edges[nearest_edge(edges, self.mouth)?];
        let [a, b] = self.mouth.map(|p| edge.path.nearest(p).0);
        Some((edge, (a + b) / 2.0, (b - a).abs()))
    }
}

/// An outline with its darts closed: of `waist`, `dart.a`, `dart.b`, `waist.2`, as garments name them, one edge `waist`
/// is made that runs straight over the mouth.
pub(super) fn closed(outline: &[Named]) -> (Vec<Named>, Vec<ClosedDart>) {
    let count = outline.len();
    let is_leg = |i: usize| leg(&outline[i % count]).is_some();
    // Begun between two edges, so that no dart lies across the end.
    let begin = (0..count).find(|&i| !is_leg(i) && !is_leg(i + count - 1)).unwrap_or(0);
    let ring: Vec<&Named> = (0..count).map(|k| &outline[(begin + k) % count]).collect();
    let (mut edges, mut wedges) = (Vec::new(), Vec::new());
    let mut k = 0;
    while k < count {
        let (mut name, mut path) = ring[k].clone();
        while let Some([one, other, beyond]) = ring.get(k + 1..k + 4)
            && let Some(wedge) = wedge(one, other)
            && is_one_edge(&ring[k].0, &beyond.0)
        {
            // Part by part: over a mouth there is no smooth curve.
            let mouth = Path::line(wedge.mouth[0], wedge.mouth[1]);
            path = smoothed(&path).joined(&mouth).joined(&smoothed(&beyond.1));
            name = name.map(|n| whole_name(&n));
            wedges.push(wedge);
            k += 3;
        }
        edges.push((name, path));
        k += 1;
    }
    (edges, wedges)
}

/// The dart, the leg and the side of the garment that `dart.a.L` says.
fn leg((name, path): &Named) -> Option<(&str, char, Option<&str>)> {
    let mut words = name.as_deref()?.split('.');
    let (dart, letter, side) = (words.next()?, words.next()?, words.next());
    let letter = ['a', 'b'].into_iter().find(|l| letter == l.to_string())?;
    (words.next().is_none() && path.is_straight()).then_some((dart, letter, side))
}

/// The dart that two edges are the legs of.
fn wedge(one: &Named, other: &Named) -> Option<ClosedDart> {
    let ((dart, first, side), (same, second, other_side)) = (leg(one)?, leg(other)?);
    let alike = (one.1.length() - other.1.length()).abs() <= LEGS_APART;
    let name = side.map_or_else(|| dart.to_owned(), |side| format!("{dart}_{side}"));
    let mouth = [one.1.start(), other.1.end()];
    (dart == same && side == other_side && first != second && alike).then(|| ClosedDart {
        name,
        mouth,
        tip: one.1.end(),
    })
}

/// Whether two names are those of parts of one edge: `waist.L` and `waist.2.L`.
fn is_one_edge(one: &Option<String>, other: &Option<String>) -> bool {
    one.as_deref().zip(other.as_deref()).is_some_and(|(a, b)| whole_name(a) == whole_name(b))
}

/// The name of an edge without the number of its part.
pub(super) fn whole_name(name: &str) -> String {
    let is_number = |word: &&str| word.parse::<usize>().is_ok();
    name.split('.').filter(|word| !is_number(word)).collect::<Vec<_>>().join(".")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn darts_are_closed_whichever_way_round_and_wherever_the_outline_begins() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.1, 1.0), (1.2, 0.0), (2.0, 0.0), (2.0, 3.0), (0.0, 3.0)];
        let names = ["waist", "bust.a", "bust.b", "waist.2", "side", "hem", "fold"];
        let point = |k: usize| Vec2::new(corners[k % 7].0, corners[k % 7].1);
        let edge = |k: usize| (Some(names[k].to_owned()), Path::line(point(k), point(k + 1)));
        let outline: Vec<Named> = (0..7).map(edge).collect();
        let turned: Vec<Named> = outline.iter().rev().map(|(n, p)| (n.clone(), p.reversed())).collect();
        for outline in [outline, turned] {
            for begin in 0..7 {
                let mut outline = outline.clone();
                outline.rotate_left(begin);
                let (edges, wedges) = closed(&outline);
                let mut found: Vec<&str> = edges.iter().filter_map(|e| e.0.as_deref()).collect();
                found.sort_unstable();
                assert_eq!(found, ["fold", "hem", "side", "waist"]);
                assert!(wedges.len() == 1 && wedges[0].name == "bust" && wedges[0].tip == point(2), "{wedges:?}");
                let waist = edges.iter().find(|e| e.0.as_deref() == Some("waist")).expect("the waist");
                assert!((waist.1.length() - 2.0).abs() < 1e-12);
            }
        }
    }
}
