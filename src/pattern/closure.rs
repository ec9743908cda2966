//! Buttons, hooks and the like: the points of the cloth that are worn together.

use super::Closure;
use super::cut::{Instance, Pieces};
use super::diagnostic::{Findings, Located};
use super::draft::{Draft, shown};
use super::file::{ClosureFile, GarmentFile, Side, Unit};
use super::inherit::unknown_piece;
use super::problem::Problem;
use super::reference::piece_of;
use super::region::Region;
use crate::geometry::Vec2;

/// Reads all closures. One that does not say what it meets is kept without tacks.
pub(super) fn closures(file: &GarmentFile, drafts: &[Draft], cut: &Pieces, findings: &mut Findings) -> Vec<Closure> {
    let wardrobe = Wardrobe { file, drafts, cut };
    file.closures
        .iter()
        .map(|c| Closure { kind: c.kind.value.clone(), tacks: wardrobe.tacks(c, findings).unwrap_or_default() })
        .collect()
}

/// Where closures go on a drawn piece: their kind, and the point in the drawing.
pub(super) fn drawn_points(file: &GarmentFile, drawn: &Draft) -> Vec<(String, Vec2)> {
    let unit = file.unit();
    let mut points = Vec::new();
    for closure in &file.closures {
        let across = if closure.meets_at.is_empty() { &closure.at } else { &closure.meets_at };
        for (carrier, at) in [(&closure.on, &closure.at), (&closure.meets, across)] {
            if carrier.as_ref().is_none_or(|c| piece_of(&c.value).0 != drawn.name) {
                continue;
            }
            for first in at {
                let first = Vec2::from(first.value) * unit.factor();
                points.extend(repeated(closure, first, drawn.warp, unit).map(|p| (closure.kind.value.clone(), p)));
            }
        }
    }
    // Both of a pair may carry the same: the drawing has it once.
    points.dedup();
    points
}

/// A closure's point, repeated along the grain as it says.
fn repeated(closure: &ClosureFile, first: Vec2, grain: Vec2, unit: Unit) -> impl Iterator<Item = Vec2> + Clone + use<> {
    let pitch = closure.pitch.as_ref().map_or(0.0, |p| p.value.value(unit));
    let count = closure.count.as_ref().map_or(1, |c| c.value);
    (0..count).map(move |i| first + grain * (pitch * i as f64))
}

struct Wardrobe<'a> {
    file: &'a GarmentFile,
    drafts: &'a [Draft],
    cut: &'a Pieces,
}

impl Wardrobe<'_> {
    fn tacks(&self, closure: &ClosureFile, findings: &mut Findings) -> Option<Vec<[(usize, Vec2); 2]>> {
        let on = self.piece(closure.on.as_ref()?, None, findings);
        if let (Some(on), None) = (on, &closure.meets) {
            self.points(closure, on, &closure.at, findings);
        }
        let other_side = on.and_then(|i| i.side).map(Side::other);
        let meets = self.piece(closure.meets.as_ref()?, other_side, findings);
        let (on, meets) = (on?, meets?);
        let own = self.points(closure, on, &closure.at, findings);
        let across = if closure.meets_at.is_empty() { &closure.at } else { &closure.meets_at };
        if let Some(first) = across.first().filter(|_| across.len() != closure.at.len()) {
            let (kind, on, met) = (closure.kind.value.clone(), closure.at.len(), across.len());
            findings.error(first.at, Problem::PointsUnlike { kind, on, met });
        }
        let met = self.points(closure, meets, across, findings);
        Some(own.into_iter().zip(met).map(|(a, b)| [(on.piece, a), (meets.piece, b)]).collect())
    }

    /// The cut piece (or half) named by `front.L`, `front.L.center` or, for a piece cut once, `band`.
    fn piece(&self, name: &Located<String>, default: Option<Side>, findings: &mut Findings) -> Option<&Instance> {
        let (piece, side, copy) = piece_of(&name.value);
        let Some(draft) = self.drafts.iter().position(|d| d.name == piece) else {
            findings.error(name.at, unknown_piece(piece, self.drafts.iter().map(|d| d.name.as_str())));
            return None;
        };
        self.check_edge(name, &self.drafts[draft], findings);
        let of_it = || self.cut.instances.iter().filter(move |i| i.draft == draft);
        let side = side.or(default).unwrap_or(self.drafts[draft].drawn);
        of_it().find(|i| i.side == Some(side)).or_else(|| of_it().find(|i| copy.is_none() || i.copy == copy))
    }

    /// The edge that a name may hold beside the piece and its side.
    fn check_edge(&self, name: &Located<String>, draft: &Draft, findings: &mut Findings) {
        let said = |word: &&str| Side::from_letter(word).is_none() && word.parse::<usize>().is_err();
        let edge = name.value.split('.').skip(1).filter(said).collect::<Vec<_>>().join(".");
        if !edge.is_empty() && draft.find(&edge).is_none() {
            findings.error(name.at, draft.unknown_edge(&edge));
        }
    }

    /// Points given in the drawing, repeated along its grain; reported where the piece has no cloth.
    fn points(
        &self,
        closure: &ClosureFile,
        on: &Instance,
        at: &[Located<[f64; 2]>],
        findings: &mut Findings,
    ) -> Vec<Vec2> {
        let unit = self.file.unit();
        let grain = self.drafts[on.draft].warp;
        let piece = &self.cut.pieces[on.piece];
        let cloth = Region::new(&piece.loops);
        let mut points = Vec::new();
        for p in at {
            let first = Vec2::from(p.value) * unit.factor();
            let drawn = repeated(closure, first, grain, unit);
            if let Some(off) = drawn.clone().find(|&p| !cloth.holds(on.point(p))) {
                let (kind, piece) = (closure.kind.value.clone(), piece.name.clone());
                findings.error(p.at, Problem::PointOff { kind, piece, at: shown(off) });
            }
            points.extend(drawn.map(|p| on.point(p)));
        }
        points
    }
}
