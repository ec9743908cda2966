//! Pieces with a pressed fold start folded, and pleats start laid.

use super::{band, flare, pleat};
use crate::geometry::Vec2;
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, LineKind};

/// A fold of at least this angle (radians) is folded over before the start; a smaller one is left to the drape.
const PRESSED: f64 = 2.0;

/// The pieces laid out flat, pressed folds folded over.
pub(super) struct Sheet {
    /// Flat position of every particle as drawn, but for what is folded over, y down.
    pub(super) drawn: Vec<Vec2>,
    /// The same with sectors of circles unrolled, and upright bands laid level.
    pub(super) flat: Vec<Vec2>,
    /// That without what a sector widens towards its hem: its sides run straight down.
    pub(super) straight: Vec<Vec2>,
    /// Layers towards the wrong side: 0, 1 where the cloth is folded under, -1 where it is turned up; up to 4 in a pleat.
    pub(super) under: Vec<f64>,
}

/// Folds every piece along its pressed lines, the part with the shorter sewn rim under the other, or over it where right sides
/// meet, lays its pleats, unrolls what is a sector of a circle, and lays level what is an upright band.
pub(super) fn folded(garment: &Garment, mesh: &ClothMesh) -> Sheet {
    let (flat, under) = (mesh.flat.clone(), vec![0.0; mesh.flat.len()]);
    let mut sheet = Sheet { drawn: Vec::new(), flat, straight: Vec::new(), under };
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
            // The side with fewer stitches is turned over.
            let balance: f64 = piece.particles.clone().map(|p| side(p).signum() * f64::from(sewn[p])).sum();
            let keep = if balance >= 0.0 { 1.0 } else { -1.0 };
            for p in piece.particles.clone() {
                let s = side(p) * keep;
                if s < -1e-9 {
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
