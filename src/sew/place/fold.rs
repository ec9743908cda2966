//! Pieces with a pressed fold start folded, and pleats start laid.

use std::collections::BTreeSet;

use super::{band, flare, pleat};
use crate::geometry::Vec2;
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::{Garment, LineKind};

/// A fold of at least this angle (radians) is folded over before the start; a smaller one is left to the drape.
const PRESSED: f64 = 2.0;
/// What lies no further over a fold than this, metres, lies on it.
const ON_FOLD: f64 = 1e-9;

/// The pieces laid out flat, pressed folds folded over.
pub(super) struct Sheet {
    /// Flat position of every particle as drawn, but for what is folded over, y down.
    pub(super) drawn: Vec<Vec2>,
    /// The same with sectors of circles unrolled, and upright bands laid level.
    pub(super) flat: Vec<Vec2>,
    /// That without what a sector widens towards its hem: its sides run straight down.
    pub(super) straight: Vec<Vec2>,
    /// Layers towards the wrong side: 0, 1 where the cloth is folded under, -1 where it is turned up;
    /// up to 4 in a pleat.
    pub(super) under: Vec<f64>,
    /// Off the ring that a piece is bent into, outward, metres: the waves of a circle skirt.
    pub(super) out: Vec<f64>,
}

/// Folds every piece along its pressed lines, but for creases that its seams hold open: the part with the shorter sewn
/// rim under the other, or over it where right sides meet. Lays its pleats, unrolls what is a sector of a circle, and
/// lays level what is an upright band.
pub(super) fn folded(garment: &Garment, mesh: &ClothMesh) -> Sheet {
    let nowhere = || vec![0.0; mesh.flat.len()];
    let mut sheet =
        Sheet { drawn: Vec::new(), flat: mesh.flat.clone(), straight: Vec::new(), under: nowhere(), out: nowhere() };
    let mut sewn = vec![0u32; mesh.flat.len()];
    for p in mesh.seams.iter().flat_map(|s| s.pairs.iter().flatten()) {
        sewn[*p as usize] += 1;
    }
    for piece in &mesh.pieces {
        for line in &piece.lines {
            let LineKind::Fold(angle) = line.kind else { continue };
            if angle.abs() < PRESSED || line.particles.len() < 2 {
                continue;
            }
            let a = mesh.flat[line.particles[0] as usize];
            let b = mesh.flat[line.particles[line.particles.len() - 1] as usize];
            let along = (b - a).normalize();
            let across = Vec2::new(-along.y, along.x);
            let side = |p: usize| across.dot(&(mesh.flat[p] - a));
            if opens(garment, mesh, piece, along, side) {
                continue;
            }
            // The side with fewer stitches is turned over.
            let balance: f64 = piece.particles.clone().map(|p| side(p).signum() * f64::from(sewn[p])).sum();
            let keep = if balance >= 0.0 { 1.0 } else { -1.0 };
            for p in piece.particles.clone() {
                let s = side(p) * keep;
                if s < -ON_FOLD {
                    sheet.flat[p] += across * (-2.0 * s * keep);
                    sheet.under[p] = angle.signum();
                }
            }
        }
    }
    pleat::lay(garment, mesh, &mut sheet);
    sheet.drawn = sheet.flat.clone();
    sheet.straight = sheet.flat.clone();
    flare::lay(garment, mesh, &mut sheet);
    band::lay(garment, mesh, &mut sheet);
    sheet
}

/// Whether seams along a fold lead from its two sides to different places, as from the crease of a trouser leg: the
/// piece is worn open. (Both sides of a waistband go to one edge, or one of them to the lining under it; side seams
/// that run on into a hem turned up do not run along its fold.)
fn opens(garment: &Garment, mesh: &ClothMesh, piece: &PieceMesh, along: Vec2, side: impl Fn(usize) -> f64) -> bool {
    let own = |p: usize| piece.particles.contains(&p);
    let layer = |p: usize| mesh.piece_of(p as u32).map_or(0, |other| garment.pieces[other].layer);
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
