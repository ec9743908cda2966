//! Pieces with a pressed fold start folded, and pleats start laid.

use std::collections::BTreeSet;

use super::{band, flare, pleat};
use crate::geometry::Vec2;
use crate::mesh::{ClothMesh, LineParticles, PieceMesh};
use crate::pattern::{Garment, LineKind};

/// A fold of at least this angle (radians) is folded over before the start; a smaller one is left to the drape.
const PRESSED: f64 = 2.0;
/// A particle no further over a fold than this, metres, lies on the fold.
const ON_FOLD: f64 = 1e-9;

/// The pieces laid out flat, pressed folds folded over.
pub(in crate::sew) struct Sheet {
    /// Flat position of every particle as drawn, but for what is folded over, y down.
    pub(in crate::sew) drawn: Vec<Vec2>,
    /// The same with sectors of circles unrolled, and upright bands laid level.
    pub(super) flat: Vec<Vec2>,
    /// That without what a sector widens towards its hem: its sides run straight down.
    pub(super) straight: Vec<Vec2>,
    /// Layers towards the wrong side: 0, 1 where the cloth is folded under, -1 where it is turned up;
    /// up to 4 in a pleat.
    pub(in crate::sew) under: Vec<f64>,
    /// Whether it lies on other cloth of its piece: turned over at a fold, or laid in a pleat.
    pub(in crate::sew) hidden: Vec<bool>,
    /// How far the pleat that it is laid in is shut: 1 at the pleated edge, 0 where the pleat has opened.
    /// 1 for what is laid in no pleat.
    pub(in crate::sew) shut: Vec<f64>,
    /// Off the ring that a piece is bent into, outward, metres: the waves of a circle skirt.
    pub(super) out: Vec<f64>,
}

/// Folds every piece along its pressed lines, but for creases that its seams hold open: the part with the shorter sewn
/// rim under the other, or over it where right sides meet. Lays its pleats, unrolls what is a sector of a circle, and
/// lays level what is an upright band.
pub(super) fn folded(garment: &Garment, mesh: &ClothMesh) -> Sheet {
    let mut sheet = pressed(garment, mesh);
    flare::lay(garment, mesh, &mut sheet);
    band::lay(garment, mesh, &mut sheet);
    sheet
}

/// The same with sectors and bands as they are drawn.
pub(in crate::sew) fn pressed(garment: &Garment, mesh: &ClothMesh) -> Sheet {
    let nowhere = || vec![0.0; mesh.flat.len()];
    let mut sheet = Sheet {
        drawn: Vec::new(),
        flat: mesh.flat.clone(),
        straight: Vec::new(),
        under: nowhere(),
        hidden: vec![false; mesh.flat.len()],
        shut: vec![1.0; mesh.flat.len()],
        out: nowhere(),
    };
    let mut sewn = vec![0u32; mesh.flat.len()];
    for p in mesh.seams.iter().flat_map(|s| s.pairs.iter().flatten()) {
        sewn[*p as usize] += 1;
    }
    for piece in &mesh.pieces {
        let mut flaps: Vec<Flap> = piece.lines.iter().filter_map(|l| flap(garment, mesh, piece, &sewn, l)).collect();
        // Of two folds one beyond the other the outer is pressed first, and its flap turned over with the inner's.
        flaps.sort_by_key(|flap| flap.particles.len());
        flaps.iter().for_each(|flap| flap.turn_over(&mut sheet));
    }
    pleat::lay(garment, mesh, &mut sheet);
    sheet.drawn = sheet.flat.clone();
    sheet.straight = sheet.flat.clone();
    sheet
}

/// The particles that are turned over at a pressed fold.
struct Flap {
    particles: Vec<usize>,
    /// A point of the fold, and the unit direction across it.
    at: Vec2,
    across: Vec2,
    /// To the wrong side (1) or the right side (-1).
    way: f64,
}

/// The flap of a `line` that is pressed: the side of it with fewer stitches. None of another line, nor of a crease that
/// is worn open.
fn flap(garment: &Garment, mesh: &ClothMesh, piece: &PieceMesh, sewn: &[u32], line: &LineParticles) -> Option<Flap> {
    let LineKind::Fold(angle) = line.kind else { return None };
    let [at, end] = [line.particles.first()?, line.particles.last()?].map(|p| mesh.flat[*p as usize]);
    let along = (end - at).try_normalize(0.0).filter(|_| angle.abs() >= PRESSED)?;
    let across = Vec2::new(-along.y, along.x);
    let side = |p: usize| across.dot(&(mesh.flat[p] - at));
    if opens(garment, mesh, piece, along, side) {
        return None;
    }
    let balance: f64 = piece.particles.clone().map(|p| side(p).signum() * f64::from(sewn[p])).sum();
    let keep = if balance >= 0.0 { 1.0 } else { -1.0 };
    let particles = piece.particles.clone().filter(|&p| side(p) * keep < -ON_FOLD).collect();
    Some(Flap { particles, at, across, way: angle.signum() })
}

impl Flap {
    /// Mirrors it in its fold as it lies by now, what was uppermost of its layers undermost.
    fn turn_over(&self, sheet: &mut Sheet) {
        let layers = self.particles.iter().map(|&p| self.way * sheet.under[p]);
        let highest = layers.fold(0.0, f64::max);
        for &p in &self.particles {
            let off = self.across.dot(&(sheet.flat[p] - self.at));
            sheet.flat[p] -= self.across * (2.0 * off);
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
        let nowhere = Vec::new;
        let flat: Vec<Vec2> = [0.01, 0.03, 0.05].map(|x| Vec2::new(x, 0.0)).to_vec();
        let (under, hidden) = (vec![0.0; 3], vec![false; 3]);
        let mut sheet =
            Sheet { drawn: nowhere(), flat, straight: nowhere(), under, hidden, shut: Vec::new(), out: Vec::new() };
        let flap = |particles: &[usize], x: f64, way: f64| Flap {
            particles: particles.to_vec(),
            at: Vec2::new(x, 0.0),
            across: Vec2::x(),
            way,
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
}
