//! Holes of a piece: drawn as a cut line, as a sewing line, or as both, one in the other.

use super::Role;
use super::contour::Contour;
use crate::geometry::Path;

/// Number of points along a hole where its allowance is measured. The cut line is farther past corners, and nowhere
/// nearer.
const LOOKS: usize = 24;

/// A hole of a piece.
#[derive(Clone, Debug)]
pub struct Hole {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Sewing or turning line. It is the cut line if there is no other.
    pub sew: Path,
    /// Cut line, if it is drawn besides.
    pub cut: Option<Path>,
}

impl Hole {
    /// Distance of the cut line inside the sewing line, metres.
    pub(super) fn allowance(&self) -> f64 {
        let Some(cut) = &self.cut else { return 0.0 };
        let place = |k: usize| self.sew.point(self.sew.length() * k as f64 / LOOKS as f64);
        (0..LOOKS).map(|k| cut.nearest(place(k)).1).fold(f64::INFINITY, f64::min)
    }

    /// With its paths where `to` leads.
    pub(super) fn moved(&self, to: impl Fn(&Path) -> Path) -> Self {
        Self { name: self.name.clone(), sew: to(&self.sew), cut: self.cut.as_ref().map(to) }
    }
}

/// Holes along `cut`. Each line belongs to the line of `sewn` in which it lies, if there is one.
pub fn holes(cut: Vec<Path>, sewn: Vec<(Option<String>, Path)>) -> Vec<Hole> {
    let contour = |role: Role| move |(name, path)| Contour::new(vec![(name, path)], role, None);
    let cut: Vec<Contour> = cut.into_iter().map(|path| (None, path)).filter_map(contour(Role::Cut)).collect();
    let sewn: Vec<Contour> = sewn.into_iter().filter_map(contour(Role::Sew)).collect();
    paired(&cut.iter().collect::<Vec<_>>(), &sewn.iter().collect::<Vec<_>>()).0
}

/// The holes that closed lines within a piece make: cut lines, and sewing lines with or without one.
pub(super) fn holes_of(contours: &[&Contour]) -> Vec<Hole> {
    let (cut, sewn): (Vec<&Contour>, Vec<&Contour>) = contours.iter().partition(|c| c.role == Role::Cut);
    let (mut holes, alone) = paired(&cut, &sewn);
    holes.extend(alone.iter().map(|s| Hole { name: name(s), sew: s.whole.clone(), cut: None }));
    holes
}

/// A hole for every cut line, or for several that lie in one sewing line; and the sewing lines without one.
fn paired<'a>(cut: &[&Contour], sewn: &[&'a Contour]) -> (Vec<Hole>, Vec<&'a Contour>) {
    let mut left: Vec<Option<&Contour>> = sewn.iter().copied().map(Some).collect();
    let mut holes = Vec::new();
    for line in cut {
        match sewn.iter().position(|s| line.lies_in(s) || s.lies_in(line)) {
            Some(k) => {
                let cut = Some(line.whole.clone());
                holes.extend(left[k].take().map(|s| Hole { name: name(s), sew: s.whole.clone(), cut }));
            }
            None => holes.push(Hole { name: None, sew: line.whole.clone(), cut: None }),
        }
    }
    (holes, left.into_iter().flatten().collect())
}

/// Of a line that is one edge.
fn name(contour: &Contour) -> Option<String> {
    if let [(name, _)] = contour.edges.as_slice() { name.clone() } else { None }
}
