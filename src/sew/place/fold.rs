//! Pieces with a pressed fold start folded, and pleats start laid.

use std::collections::BTreeSet;

use super::folded::FoldedPieces;
use super::pleat;
use crate::geometry::Vec2;
use crate::mesh::{ClothMesh, LineParticles, PieceMesh};
use crate::pattern::{Garment, LineKind};

/// A fold of at least this angle (radians) is folded over before the start; a smaller one is left to the drape.
const PRESSED: f64 = 2.0;
/// A fold whose points lie no further than this beside the line between its ends, metres, is straight: nobody draws a
/// curve so flat, and where it begins and ends on an outline it may be off by a third of that. A particle no further
/// over a fold lies on it.
const STRAIGHT: f64 = 0.1e-3;

/// Folds every piece along its pressed lines, but for creases that its seams hold open: the part with the shorter sewn
/// rim under the other, or over it where right sides meet. Lays its pleats.
pub(in crate::sew) fn pressed(garment: &Garment, mesh: &ClothMesh) -> FoldedPieces {
    let mut sheet = FoldedPieces {
        flat: mesh.flat.clone(),
        under: vec![0.0; mesh.flat.len()],
        hidden: vec![false; mesh.flat.len()],
        shut: vec![1.0; mesh.flat.len()],
    };
    let mut sewn = vec![0u32; mesh.flat.len()];
    for p in mesh.seams.iter().flat_map(|s| s.pairs.iter().flatten()) {
        sewn[*p as usize] += 1;
    }
    for piece in &mesh.pieces {
        let mut flaps: Vec<FoldedFlap> =
            piece.lines.iter().filter_map(|l| flap(garment, mesh, piece, &sewn, l)).collect();
        // Of two folds one beyond the other the outer is pressed first, and its flap turned over with the inner's.
        flaps.sort_by_key(|flap| flap.particles.len());
        flaps.iter().for_each(|flap| flap.turn_over(&mut sheet));
    }
    pleat::lay(garment, mesh, &mut sheet);
    sheet
}

/// A fold as it is drawn, which goes straight on beyond both ends: the points of a curve, or the two ends of a straight
/// line.
struct PressedFold(Vec<Vec2>);

/// The straight line nearest to a particle along a fold: a point, and the unit direction across it.
#[derive(Clone, Copy, Debug)]
struct Tangent {
    at: Vec2,
    across: Vec2,
}

impl Tangent {
    /// How far over it a point lies, metres.
    fn off(&self, p: Vec2) -> f64 {
        self.across.dot(&(p - self.at))
    }
}

impl PressedFold {
    fn new(mesh: &ClothMesh, line: &LineParticles) -> Self {
        Self::through(line.particles.iter().map(|p| mesh.flat[*p as usize]).collect())
    }

    fn through(mut points: Vec<Vec2>) -> Self {
        points.dedup();
        let ends = Self(points.first().into_iter().chain(points.last()).copied().collect());
        let is_on = |p: &Vec2| ends.tangent(*p).is_some_and(|tangent| tangent.off(*p).abs() < STRAIGHT);
        if points.iter().all(is_on) { ends } else { Self(points) }
    }

    /// The unit direction from its first point to its last. `None` where these are one.
    fn along(&self) -> Option<Vec2> {
        (self.0.last()? - self.0.first()?).try_normalize(0.0)
    }

    /// The line of the segment nearest to a point. A crease of one point has none.
    fn tangent(&self, p: Vec2) -> Option<Tangent> {
        let last = self.0.len().checked_sub(2)?;
        let segment = |k: usize| {
            let (at, way) = (self.0[k], self.0[k + 1] - self.0[k]);
            let from = if k == 0 { f64::NEG_INFINITY } else { 0.0 };
            let to = if k == last { f64::INFINITY } else { 1.0 };
            let share = ((p - at).dot(&way) / way.norm_squared()).clamp(from, to);
            let along = way.normalize();
            ((p - at - way * share).norm_squared(), Tangent { at, across: Vec2::new(-along.y, along.x) })
        };
        (0..=last).map(segment).min_by(|a, b| a.0.total_cmp(&b.0)).map(|nearest| nearest.1)
    }
}

/// The particles that are turned over at a pressed fold, each with the line it is mirrored in.
struct FoldedFlap {
    particles: Vec<(usize, Tangent)>,
    /// To the wrong side (1) or the right side (-1).
    way: f64,
}

/// The flap of a `line` that is pressed: the side of it with fewer stitches. None of another line, nor of a crease that
/// is worn open.
fn flap(
    garment: &Garment,
    mesh: &ClothMesh,
    piece: &PieceMesh,
    sewn: &[u32],
    line: &LineParticles,
) -> Option<FoldedFlap> {
    let LineKind::Fold(angle) = line.kind else { return None };
    let crease = PressedFold::new(mesh, line);
    let along = crease.along().filter(|_| angle.abs() >= PRESSED)?;
    let tangents = piece.particles.clone().map(|p| Some((p, crease.tangent(mesh.flat[p])?)));
    let tangents: Vec<(usize, Tangent)> = tangents.collect::<Option<_>>()?;
    let off = |p: usize| tangents[p - piece.particles.start].1.off(mesh.flat[p]);
    if opens(garment, mesh, piece, along, off) {
        return None;
    }
    let balance: f64 = piece.particles.clone().map(|p| off(p).signum() * f64::from(sewn[p])).sum();
    let keep = if balance >= 0.0 { 1.0 } else { -1.0 };
    let is_over = |(p, _): &&(usize, Tangent)| off(*p) * keep < -STRAIGHT;
    Some(FoldedFlap { particles: tangents.iter().filter(is_over).copied().collect(), way: angle.signum() })
}

impl FoldedFlap {
    /// Mirrors it in its fold as it lies by now, what was uppermost of its layers undermost.
    fn turn_over(&self, sheet: &mut FoldedPieces) {
        let layers = self.particles.iter().map(|&(p, _)| self.way * sheet.under[p]);
        let highest = layers.fold(0.0, f64::max);
        for &(p, tangent) in &self.particles {
            let off = tangent.off(sheet.flat[p]);
            sheet.flat[p] -= tangent.across * (2.0 * off);
            sheet.under[p] = self.way * (1.0 + highest) - sheet.under[p];
            sheet.hidden[p] = true;
        }
    }
}

/// Whether seams along a fold lead from its two sides to different places, as from the crease of a trouser leg: the
/// piece is worn open. (Both sides of a waistband go to one edge, or one of them to the lining under it; side seams
/// that run on into a hem turned up do not run along its fold.)
fn opens(garment: &Garment, mesh: &ClothMesh, piece: &PieceMesh, along: Vec2, side: impl Fn(usize) -> f64) -> bool {
    let own = |p: usize| piece.particles.contains(&p);
    let layer = |p: usize| mesh.piece_of(p as u32).map_or(0, |other| garment.pieces[other].level());
    let mut partners: [Vec<usize>; 2] = [Vec::new(), Vec::new()];
    for steps in mesh.seams.iter().flat_map(|seam| seam.pairs.windows(2)) {
        for k in 0..2 {
            let [from, to] = [0, 1].map(|n| steps[n][k] as usize);
            let other = [0, 1].map(|n| steps[n][1 - k] as usize);
            let step = mesh.flat[to] - mesh.flat[from];
            if own(from)
                && own(to)
                && !other.iter().any(|&p| own(p))
                && step.dot(&along).abs() > step.perp(&along).abs()
            {
                partners[usize::from(side(from) + side(to) > 0.0)].extend(other);
            }
        }
    }
    let [under, over] = &partners;
    let layers = |these: &[usize]| these.iter().map(|&p| layer(p)).collect::<BTreeSet<i32>>();
    !under.is_empty() && !over.is_empty() && layers(under) == layers(over) && !under.iter().any(|p| over.contains(p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Where a strip lies that is folded at 20 and at 40 mm, mm, and its layers towards the wrong side: at 10, 30 and
    /// 50 mm.
    fn layers(inner: f64, outer: f64) -> [(f64, f64); 3] {
        let flat: Vec<Vec2> = [0.01, 0.03, 0.05].map(|x| Vec2::new(x, 0.0)).to_vec();
        let (under, hidden) = (vec![0.0; 3], vec![false; 3]);
        let mut sheet = FoldedPieces { flat, under, hidden, shut: Vec::new() };
        let flap = |particles: &[usize], x: f64, way: f64| {
            let tangent = Tangent { at: Vec2::new(x, 0.0), across: Vec2::x() };
            FoldedFlap { particles: particles.iter().map(|p| (*p, tangent)).collect(), way }
        };
        flap(&[2], 0.04, outer).turn_over(&mut sheet);
        flap(&[1, 2], 0.02, inner).turn_over(&mut sheet);
        [0, 1, 2].map(|p| (1e3 * sheet.flat[p].x, sheet.under[p]))
    }

    #[test]
    fn a_fold_beyond_another_is_turned_over_with_it() {
        // Turned twice the same way, as a hem is, the end lies between; to and fro, as a fan, on top.
        for way in [1.0, -1.0] {
            for (other, end, middle) in [(way, 1.0, 2.0), (-way, 2.0, 1.0)] {
                let [kept, turned, last] = layers(way, other);
                assert_relative_eq!(kept.0, 10.0, epsilon = 1e-9);
                assert_relative_eq!(turned.0, 10.0, epsilon = 1e-9);
                assert_relative_eq!(last.0, 10.0, epsilon = 1e-9);
                assert_eq!((kept.1, turned.1, last.1), (0.0, way * middle, way * end));
            }
        }
    }

    #[test]
    fn a_curved_fold_is_followed_by_the_line_nearest_to_a_point() {
        let arc = |turn: f64| Vec2::new(turn.sin(), turn.cos());
        let crease = PressedFold::through((0..=100).map(|k| arc(0.02 * f64::from(k) - 1.0)).collect());
        for turn in [-0.9, -0.31, 0.0, 0.57, 0.9] {
            for radius in [0.9, 1.1] {
                let p = arc(turn) * radius;
                let tangent = crease.tangent(p).expect("segments");
                let mirrored = p - tangent.across * (2.0 * tangent.off(p));
                assert_relative_eq!(mirrored.norm(), 2.0 - radius, epsilon = 2e-3);
                assert!((tangent.off(p) > 0.0) == (radius > 1.0), "{turn} {radius}");
            }
        }
        // Beyond its ends it goes straight on, and all of a straight one is one line.
        let straight = PressedFold::through([0.0, 0.3, 1.0].map(|x| Vec2::new(x, 0.0)).to_vec());
        assert_eq!(straight.0.len(), 2);
        let off = |x: f64| straight.tangent(Vec2::new(x, 0.2)).expect("segments").off(Vec2::new(x, 0.2));
        assert_relative_eq!(off(-2.0), off(5.0));
        assert_relative_eq!(off(0.3), 0.2);
    }
}
