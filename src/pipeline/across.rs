//! A seam that cannot close because two pieces are stuck in one another.

use std::collections::HashSet;
use std::path::PathBuf;

use super::run::Run;
use crate::contact::Skin;
use crate::geometry::{MM, Vec3, box_of};
use crate::mesh::{ClothMesh, PieceMesh};
use crate::report::Crossing;
use crate::sew::SewError;

/// Distance within which a particle lies on another piece, metres: less than the thickness of any cloth.
const ON: f64 = 0.05e-3;
/// Share of a piece that lies on another one from which both are in one place. Panels that widen towards their hem
/// start over one another with up to a fifth.
const SHARE: f64 = 0.5;

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
    /// The pieces that are stuck in one another.
    pub pieces: [String; 2],
    /// Their relation, in words.
    pub how: &'static str,
    /// Place in the frame of the body's file, mm.
    pub near: [f64; 3],
}

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

/// Pieces that lie in one another with the particles at `at`, two and two, and a particle that does.
pub(super) fn in_one_place<'a>(mesh: &'a ClothMesh, at: &'a [Vec3]) -> impl Iterator<Item = ([usize; 2], Vec3)> + 'a {
    let skin = |piece: &PieceMesh| {
        let triangles = mesh.triangles[piece.triangles.clone()].iter();
        let own = triangles.map(|t| t.map(|p| p - piece.particles.start as u32));
        Skin::new(&at[piece.particles.clone()], own.collect())
    };
    let skins: Vec<Option<Skin>> = mesh.pieces.iter().map(skin).collect();
    let boxes: Vec<[Vec3; 2]> = mesh.pieces.iter().map(|p| box_of(at[p.particles.clone()].iter().copied())).collect();
    // Where two pieces are sewn together they meet.
    let stitches = mesh.seams.iter().flat_map(|s| &s.pairs).flat_map(|&[p, q]| [[p, q], [q, p]]);
    let sewn: HashSet<(usize, usize)> = stitches.filter_map(|[p, q]| Some((p as usize, mesh.piece_of(q)?))).collect();
    let lying = move |a: usize, b: usize| {
        let (piece, skin) = (&mesh.pieces[a], skins[b].as_ref()?);
        let lies_on = |&p: &usize| !sewn.contains(&(p, b)) && skin.distance(at[p], ON).is_some();
        let on: Vec<usize> = piece.particles.clone().filter(lies_on).collect();
        let first = at[*on.first()?];
        (on.len() as f64 >= SHARE * piece.particles.len() as f64).then_some(([a, b], first))
    };
    let count = mesh.pieces.len();
    let pairs = (0..count).flat_map(move |a| (a + 1..count).map(move |b| [a, b]));
    // Most pieces are nowhere near each other.
    let near = move |&[a, b]: &[usize; 2]| {
        let ([low, high], [other_low, other_high]) = (boxes[a], boxes[b]);
        (0..3).all(|k| low[k] <= other_high[k] + ON && other_low[k] <= high[k] + ON)
    };
    pairs.filter(near).filter_map(move |[a, b]| lying(a, b).or_else(|| lying(b, a)))
}
