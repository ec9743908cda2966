//! Buttons, hooks and the like: the points of the cloth that are worn together.

use super::Closure;
use super::cut::{Instance, Pieces};
use super::diagnostic::{Findings, Located};
use super::draft::{Draft, shown};
use super::file::{ClosureFile, GarmentFile};
use super::inherit::unknown_piece;
use super::problem::Problem;
use super::reference::{Words, piece_of};
use super::region::Region;
use super::value::{CutKind, Side, Unit};
use crate::geometry::Vec2;

/// Reads all closures. A closure without `meets` is kept without tacks.
pub(super) fn closures(file: &GarmentFile, drafts: &[Draft], cut: &Pieces, findings: &mut Findings) -> Vec<Closure> {
    let wardrobe = Wardrobe { file, drafts, cut };
    file.closures.iter().map(|c| wardrobe.closure(c, findings)).collect()
}

/// Points of closures on a drawn piece: their kind, and the point in the drawing.
pub(super) fn drawn_points(file: &GarmentFile, drawn: &Draft) -> Vec<(String, Vec2)> {
    let unit = file.unit();
    let mut points: Vec<(String, Vec2)> = Vec::new();
    for closure in &file.closures {
        let across = if closure.meets_at.is_empty() { &closure.at } else { &closure.meets_at };
        for (carrier, at) in [(&closure.on, &closure.at), (&closure.meets, across)] {
            if carrier.as_ref().is_none_or(|c| piece_of(&c.value) != drawn.name) {
                continue;
            }
            for first in at {
                let first = Vec2::from(first.value) * unit.factor();
                for p in repeated(closure, first, drawn.warp, unit) {
                    let point = (closure.kind.value.clone(), p);
                    // Both of a pair may carry the same, a whole row after the other: the drawing has it once.
                    if !points.contains(&point) {
                        points.push(point);
                    }
                }
            }
        }
    }
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
    fn closure(&self, closure: &ClosureFile, findings: &mut Findings) -> Closure {
        let on = closure.on.as_ref().and_then(|name| self.piece(name, None, findings));
        let other_side = on.and_then(|i| i.side).map(Side::other);
        let meets = closure.meets.as_ref().and_then(|name| self.piece(name, other_side, findings));
        let own = on.map(|on| self.points(closure, on, &closure.at, findings));
        let tacks = match (on, meets, &own) {
            (Some(on), Some(meets), Some(own)) => self.tacks(closure, [on, meets], own, findings),
            _ => Vec::new(),
        };
        let unsaid = on.filter(|_| closure.meets.is_none());
        let name = |i: &Instance| self.cut.pieces[i.piece].name.clone();
        let count = closure.count.as_ref().map_or(1, |c| c.value);
        Closure {
            kind: closure.kind.value.clone(),
            on: on.map(name),
            meets: meets.map(name),
            tacks,
            // Several given points are a row, unless each begins one.
            row: if count > 1 { count } else { closure.at.len() },
            mirrored: unsaid.map(|on| self.mirrored(closure, on)).unwrap_or_default(),
        }
    }

    /// The closure's points on a piece cut as a pair, and the same points of the other half.
    fn mirrored(&self, closure: &ClosureFile, on: &Instance) -> Vec<[(usize, Vec2); 2]> {
        let draft = &self.drafts[on.draft];
        let other = on.side.map(Side::other).filter(|_| draft.cut == CutKind::Pair);
        let Some(twin) = self.cut.instances.iter().find(|i| i.draft == on.draft && other.is_some() && i.side == other)
        else {
            return Vec::new();
        };
        let unit = self.file.unit();
        let firsts = closure.at.iter().map(|p| Vec2::from(p.value) * unit.factor());
        let drawn = firsts.flat_map(|first| repeated(closure, first, draft.warp, unit));
        drawn.map(|p| [on, twin].map(|i| (i.piece, i.point(p)))).collect()
    }

    fn tacks(
        &self,
        closure: &ClosureFile,
        [on, meets]: [&Instance; 2],
        own: &[Vec2],
        findings: &mut Findings,
    ) -> Vec<[(usize, Vec2); 2]> {
        let across = if closure.meets_at.is_empty() { &closure.at } else { &closure.meets_at };
        if let Some(first) = across.first().filter(|_| across.len() != closure.at.len()) {
            let (kind, on, met) = (closure.kind.value.clone(), closure.at.len(), across.len());
            findings.error(first.at, Problem::PointsUnlike { kind, on, met });
        }
        let met = self.points(closure, meets, across, findings);
        own.iter().zip(met).map(|(&a, b)| [(on.piece, a), (meets.piece, b)]).collect()
    }

    /// The cut piece (or half) named by `front.L`, `front.L.center` or, for a piece cut once, `band`.
    fn piece(&self, name: &Located<String>, default: Option<Side>, findings: &mut Findings) -> Option<&Instance> {
        self.named(&name.value, default).map_err(|problem| findings.error(name.at, problem)).ok()
    }

    /// As above, or the fault of the name. Without a side the `default` is meant, of several copies the first.
    fn named(&self, name: &str, default: Option<Side>) -> Result<&Instance, Problem> {
        let words = Words::parse(name)?;
        let names = || self.drafts.iter().map(|d| d.name.as_str());
        let draft = names().position(|n| n == words.piece).ok_or_else(|| unknown_piece(&words.piece, names()))?;
        let drawn = &self.drafts[draft];
        if let Some(edge) = words.edge.filter(|edge| drawn.find(edge).is_none()) {
            return Err(drawn.unknown_edge(&edge));
        }
        let default = default.unwrap_or(drawn.drawn);
        let is_it = |i: &&Instance| {
            let sided = if words.side.is_some() { i.side == words.side } else { i.side.is_none_or(|s| s == default) };
            i.draft == draft && sided && (words.copy.is_none() || i.copy == words.copy)
        };
        self.cut.instances.iter().find(is_it).ok_or_else(|| self.cut.not_cut(name, draft, drawn))
    }

    /// Points given in the drawing, repeated along its grain. Reported where the piece has no cloth.
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
