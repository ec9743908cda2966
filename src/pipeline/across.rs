//! A seam that cannot close because two pieces are stuck in one another.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::run::Run;
use crate::contact::closest_on_triangle;
use crate::geometry::{MM, Vec3};
use crate::mesh::ClothMesh;
use crate::report::Crossing;
use crate::sew::SewError;

/// A particle this near to another piece lies on it, metres: less than any cloth is thick.
const ON: f64 = 0.05e-3;
/// Pieces are in one place when of one of them this share lies on the other; rims that touch are less.
const SHARE: f64 = 0.1;

/// A seam that stayed open, and two pieces that were placed so that they could not be led apart. (Cloth that starts
/// without a crossing comes to none while a seam is far open.)
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{}: seam '{seam}' is still open by {gap_mm:.1} mm: '{}' and '{}' {how} near ({:.0}, {:.0}, {:.0}) mm and could \
     not be led apart; place them neither across one another nor in one place",
    file.display(), pieces[0], pieces[1], near[0], near[1], near[2]
)]
pub struct Across {
    /// The garment file.
    pub file: PathBuf,
    /// The seam.
    pub seam: String,
    /// Its widest gap, mm.
    pub gap_mm: f64,
    /// What is stuck in one another.
    pub pieces: [String; 2],
    /// What they do.
    pub how: &'static str,
    /// Where, mm, as the body's file has it.
    pub near: [f64; 3],
}

impl Run<'_> {
    /// What is in the way of a seam that stayed far open, if two pieces that are stuck in one another are.
    pub(super) fn across(&self, error: &SewError) -> Option<Across> {
        let SewError::Open { seam, gap_mm, .. } = error else { return None };
        // Beside a seam that is all but closed the cloth is let pass through itself.
        if error.is_nearly_closed() {
            return None;
        }
        let crossing = self.report().crossings.into_iter().find_map(two_pieces);
        let crossing = crossing.map(|(pieces, near)| (pieces, "pass through one another", near));
        let (pieces, how, near) = crossing.or_else(|| {
            let ([a, b], at) = in_one_place(&self.job.mesh, self.placed.as_deref()?)?;
            let pieces = [a, b].map(|piece| self.job.mesh.pieces[piece].name.clone());
            Some((pieces, "started in one place", (self.job.body.frame.to_file(at) * MM).into()))
        })?;
        Some(Across { file: self.job.file.clone(), seam: seam.clone(), gap_mm: *gap_mm, pieces, how, near })
    }
}

/// The pieces of a crossing, if they are two, and where they cross.
fn two_pieces(Crossing { piece, through, near, .. }: Crossing) -> Option<([String; 2], [f64; 3])> {
    let other = through.filter(|other| *other != piece)?;
    Some(([piece, other], near))
}

/// Two pieces that lie in one another with the particles at `at`, and a particle that does.
fn in_one_place(mesh: &ClothMesh, at: &[Vec3]) -> Option<([usize; 2], Vec3)> {
    let piece: Vec<usize> = (0..at.len() as u32).map(|p| mesh.piece_of(p).unwrap_or_default()).collect();
    let mut lying: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for p in 0..at.len() {
        for other in others_under(mesh, at, &piece, p) {
            lying.entry([piece[p], other]).or_default().push(p);
        }
    }
    let share = |[a, _]: &[usize; 2], on: &[usize]| on.len() as f64 / mesh.pieces[*a].particles.len() as f64;
    let found = lying.into_iter().find(|(pair, on)| share(pair, on) >= SHARE);
    found.map(|(pair, on)| (pair, at[on[0]]))
}

/// The other pieces that particle `p` lies on, each once.
fn others_under(mesh: &ClothMesh, at: &[Vec3], piece: &[usize], p: usize) -> Vec<usize> {
    // No edge of a mesh is longer than two spacings.
    let is_far = |a: Vec3| (a - at[p]).norm_squared() > (2.0 * mesh.spacing).powi(2);
    let is_under = |[a, b, c]: [Vec3; 3]| {
        let share = || closest_on_triangle(at[p], a, b, c);
        !is_far(a) && (share().iter().zip([a, b, c]).map(|(w, q)| q * *w).sum::<Vec3>() - at[p]).norm() < ON
    };
    let others = mesh.triangles.iter().filter(|t| piece[t[0] as usize] != piece[p]);
    let mut under: Vec<usize> =
        others.filter(|t| is_under(t.map(|v| at[v as usize]))).map(|t| piece[t[0] as usize]).collect();
    under.sort_unstable();
    under.dedup();
    under
}
