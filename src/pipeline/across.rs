//! A seam that cannot close because two pieces are stuck in one another.

use super::obstacle::Across;
use super::one_place::in_one_place;
use super::run::Run;
use crate::geometry::MM;
use crate::report::Crossing;
use crate::sew::SewError;

impl Run<'_> {
    /// The obstacle of a seam that stayed far open, if two pieces are stuck in one another.
    pub(super) fn across(&self, error: &SewError) -> Option<Across> {
        let SewError::Open { seam, gap_mm, .. } = error else { return None };
        // Beside a seam that is all but closed the cloth is let pass through itself.
        if error.is_nearly_closed() {
            return None;
        }
        let crossing = self.report().crossings.into_iter().find_map(two_pieces);
        let crossing = crossing.map(|(pieces, near)| (pieces, "pass through one another", near));
        let (pieces, how, near) = crossing.or_else(|| {
            let ([a, b], at) = in_one_place(&self.job.mesh, self.placed.as_deref()?).next()?;
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
