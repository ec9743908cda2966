//! Bands drawn upright are laid level: what a maker draws with its grain running down goes round
//! the body like any other.
//!
//! ```text
//!   ┌─┐                 ┌──────────────────────┐  its sewn side towards
//!   │ │sewn to a waist  │                      │  what it is sewn to
//!   │ │                 └─────────sewn─────────┘
//!   │ │        ─▶       ╭──────────waist───────╮
//!   └─┘
//! ```

use super::fold::FoldedPieces;
use super::rows::extent;
use crate::geometry::Vec2;
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::Garment;

/// A band is at least so many times as tall as wide.
const TALL: f64 = 2.0;

/// Turns every upright band of the unrolled sheet by a quarter. One that is sewn to another band follows it.
pub(super) fn lay(garment: &Garment, mesh: &ClothMesh, sheet: &mut FoldedPieces) {
    let mut waiting: Vec<usize> = (0..mesh.pieces.len()).filter(|&i| !garment.pieces[i].has_position()).collect();
    while let Some(at) = waiting.iter().position(|&i| is_upright_band(mesh, sheet, i)) {
        turn(mesh, sheet, waiting.remove(at));
    }
}

/// The stitches of a piece, its own particle first.
fn stitches<'a>(mesh: &'a ClothMesh, piece: &'a PieceMesh) -> impl Iterator<Item = Vec<[usize; 2]>> + 'a {
    let own = |p: usize| piece.particles.contains(&p);
    mesh.seams.iter().flat_map(move |seam| {
        let pairs = seam.pairs.iter().map(|pair| pair.map(|p| p as usize));
        [[0, 1], [1, 0]].map(|[k, other]| {
            pairs.clone().map(|pair| [pair[k], pair[other]]).filter(|pair| own(pair[0])).collect::<Vec<_>>()
        })
    })
}

/// Whether a piece is tall, and its long side is sewn to a level one, or its ends to each other.
fn is_upright_band(mesh: &ClothMesh, sheet: &FoldedPieces, band: usize) -> bool {
    let piece = &mesh.pieces[band];
    let [low, high] = extent(mesh, sheet, band);
    if high.y - low.y < TALL * (high.x - low.x) {
        return false;
    }
    let own = |p: usize| piece.particles.contains(&p);
    let (mut drawn, mut partner) = (Vec2::zeros(), Vec2::zeros());
    for run in stitches(mesh, piece) {
        let ends_meet =
            |&[a, b]: &[usize; 2]| own(b) && (sheet.flat[a].y - sheet.flat[b].y).abs() > 0.5 * (high.y - low.y);
        if !run.is_empty() && run.iter().all(ends_meet) {
            return true;
        }
        for [[a0, b0], [a1, b1]] in
            run.windows(2).map(|w| [w[0], w[1]]).filter(|[one, next]| !own(one[1]) && !own(next[1]))
        {
            drawn += (sheet.straight[a1] - sheet.straight[a0]).abs();
            partner += (sheet.straight[b1] - sheet.straight[b0]).abs();
        }
    }
    drawn.y > drawn.x && partner.x > partner.y
}

/// Turns a band so that its sewn side comes to lie towards what it is sewn to: below what is sewn at its top.
fn turn(mesh: &ClothMesh, sheet: &mut FoldedPieces, band: usize) {
    let middle = |piece: usize| 0.5 * extent(mesh, sheet, piece).iter().sum::<Vec2>();
    let (own, mut away) = (middle(band), 0.0);
    for [a, b] in stitches(mesh, &mesh.pieces[band]).flatten() {
        if let Some(other) = mesh.piece_of(b as u32).filter(|&other| other != band) {
            // Right of its own middle and at the top of the other, or left and at the bottom: what is right goes down.
            away += (sheet.flat[a].x - own.x).signum() * (middle(other).y - sheet.flat[b].y).signum();
        }
    }
    let turned = |p: Vec2| if away >= 0.0 { Vec2::new(-p.y, p.x) } else { Vec2::new(p.y, -p.x) };
    for p in mesh.pieces[band].particles.clone() {
        sheet.flat[p] = turned(sheet.flat[p]);
        sheet.straight[p] = turned(sheet.straight[p]);
    }
}
