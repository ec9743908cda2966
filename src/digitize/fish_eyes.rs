//! Fish-eye darts that toile itself has drawn: four lines that are named as a garment names the edges of such a hole.

use super::chain::MEET;
use super::contour::Contour;
use super::lozenge::{FishEye, Lozenge};
use super::{InnerLine, Traced};
use crate::geometry::{Path, Vec2};
use crate::pattern::{FISH_EYE_EDGES, LineKind};

/// As far as this (metres) numbers may be rounded that put it upright.
const ROUNDED: f64 = 2e-5;

impl FishEye {
    /// The one that four lines make, given from its upper tip round, if it stands upright.
    fn new(name: String, lines: [&Path; 4]) -> Option<Self> {
        if !lines.iter().all(|line| line.is_straight()) {
            return None;
        }
        let [upper_a, lower_a, lower_b, upper_b] = lines;
        let pairs = [[upper_b, upper_a], [upper_a, lower_a], [lower_a, lower_b], [lower_b, upper_b]];
        let [Some(top), Some(a), Some(bottom), Some(b)] = pairs.map(|[one, other]| shared_end(one, other)) else {
            return None;
        };
        let at = (a + b) / 2.0;
        let askew = [a.y - b.y, top.x - at.x, bottom.x - at.x];
        let upright = askew.iter().all(|off| off.abs() <= ROUNDED) && top.y < at.y && at.y < bottom.y;
        let intake = (b.x - a.x).abs();
        upright.then_some(Self { name, at, intake, up: at.y - top.y, down: bottom.y - at.y })
    }

    /// Its tips and the ends of its widest line, which are marked through all layers.
    fn corners(&self) -> [Vec2; 4] {
        let half = Vec2::new(self.intake / 2.0, 0.0);
        let (up, down) = (Vec2::new(0.0, self.up), Vec2::new(0.0, self.down));
        [self.at - up, self.at - half, self.at + down, self.at + half]
    }
}

/// The point at which two lines meet.
fn shared_end(one: &Path, other: &Path) -> Option<Vec2> {
    let ends = |line: &Path| [line.start(), line.end()];
    ends(one).into_iter().find(|p| ends(other).iter().any(|q| (p - q).norm() <= MEET))
}

/// The name of the fish-eye and the number of its edge that a name says: `waist.upper_a`, of a half `waist.upper_a.L`.
fn edge(name: &str) -> Option<(String, usize)> {
    let mut words = name.split('.');
    let (dart, edge, side) = (words.next()?, words.next()?, words.next());
    let number = FISH_EYE_EDGES.iter().position(|known| *known == edge)?;
    let name = side.map_or_else(|| dart.to_owned(), |side| format!("{dart}_{side}"));
    words.next().is_none().then_some((name, number))
}

/// The sides of a closed line as lines inside the piece, if they are named as those of a fish-eye.
pub(super) fn sides(contour: &Contour) -> Option<Vec<InnerLine>> {
    let side = |(name, path): &(Option<String>, Path)| {
        let name = name.clone().filter(|name| edge(name).is_some())?;
        Some(InnerLine { name: Some(name), path: path.clone(), kind: Some(LineKind::Mark("dart".to_owned())) })
    };
    (contour.edges.len() == FISH_EYE_EDGES.len()).then(|| contour.edges.iter().map(side).collect()).flatten()
}

/// The fish-eyes of a piece, and the piece without their lines and the marks at their corners. Fish-eyes are those
/// named by toile, and closed lines of that shape. Details that cannot be kept are noted.
pub(super) fn taken(piece: &Traced, near: f64, notes: &mut Vec<String>) -> (Vec<FishEye>, Traced) {
    let (drawn, lines) = lozenges(piece, notes);
    let piece = &Traced { lines, ..piece.clone() };
    let known: Vec<Option<(String, usize)>> = piece.lines.iter().map(|l| edge(l.name.as_deref()?)).collect();
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in known.iter().flatten() {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let whole = |name: &&String| {
        let line = |k: usize| {
            let own = |of: &Option<(String, usize)>| of.as_ref().is_some_and(|(n, e)| n == *name && *e == k);
            known.iter().position(own).map(|i| &piece.lines[i].path)
        };
        FishEye::new((*name).clone(), [line(0)?, line(1)?, line(2)?, line(3)?])
    };
    let mut found: Vec<FishEye> = names.iter().filter_map(whole).collect();
    let is_taken = |of: &Option<(String, usize)>| of.as_ref().is_some_and(|(n, _)| found.iter().any(|f| f.name == *n));
    let lines = piece.lines.iter().zip(&known).filter(|(_, of)| !is_taken(of)).map(|(line, _)| line.clone()).collect();
    found.extend(drawn);
    let corners: Vec<Vec2> = found.iter().flat_map(FishEye::corners).collect();
    let points = piece.points.iter().filter(|p| corners.iter().all(|c| (*p - c).norm() > near)).copied().collect();
    (found, Traced { lines, points, ..piece.clone() })
}

/// The closed lines of which nothing is said that are fish-eye darts, and the other lines.
fn lozenges(piece: &Traced, notes: &mut Vec<String>) -> (Vec<FishEye>, Vec<InnerLine>) {
    let (mut found, mut rest): (Vec<FishEye>, Vec<InnerLine>) = (Vec::new(), Vec::new());
    for line in &piece.lines {
        let Some(lozenge) = Lozenge::of(&line.path).filter(|_| line.kind.is_none()) else {
            rest.push(line.clone());
            continue;
        };
        let Some(dart) = lozenge.dart else {
            notes.push(format!(
                "a line in '{}' is drawn as a fish-eye dart that is askew: it is kept as a mark, for a garment file \
                 has upright ones alone",
                piece.name
            ));
            rest.push(line.clone());
            continue;
        };
        let number = found.len() + 1;
        let made_up = if number == 1 { "fisheye".to_owned() } else { format!("fisheye{number}") };
        let name = line.name.clone().filter(|name| found.iter().all(|f| f.name != *name)).unwrap_or(made_up);
        if lozenge.is_bent {
            notes.push(format!("the legs of the fish-eye dart '{name}' in '{}' are bent: made straight", piece.name));
        }
        found.push(FishEye { name, ..dart });
    }
    (found, rest)
}
