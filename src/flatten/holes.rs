//! A start for a surface with holes: they are filled, and it is laid flat as a disk.

use std::f64::consts::PI;

use super::FlattenError;
use super::start::{self, Start, angle_sums};
use super::topology::Rims;
use crate::geometry::{Topology, TriMesh};

/// A first flat position of a surface with these rims, without flipped triangles; see [`start::start`]. The rim that
/// turns most becomes the outline; every other one is filled with triangles round its centre.
///
/// # Errors
/// As [`start::start`].
pub(super) fn start(surface: &TriMesh, topology: &Topology, rims: &Rims) -> Result<Start, FlattenError> {
    let outline = outline(surface, rims);
    if rims.len() == 1 {
        return start::start(surface, topology, &rims[outline]);
    }
    let mut filled = surface.clone();
    for (k, rim) in rims.iter().enumerate() {
        if k != outline {
            filled.fill(rim);
        }
    }
    let (mut flat, mut scale) = start::start(&filled, &Topology::new(&filled.triangles), &rims[outline])?;
    flat.truncate(surface.vertices.len());
    scale.truncate(surface.vertices.len());
    Ok((flat, scale))
}

/// The rim round all others: laid flat it turns by a whole turn with its triangles, the holes by one against them. The
/// longest of those that turn alike.
fn outline(surface: &TriMesh, rims: &Rims) -> usize {
    /// Turns that differ by less, radians, are alike: those of a tube's ends.
    const ALIKE: f64 = 0.1;
    let angles = angle_sums(surface);
    let turn = |rim: &[u32]| rim.iter().map(|&v| PI - angles[v as usize]).sum::<f64>();
    let most = rims.iter().map(|rim| turn(rim)).fold(f64::NEG_INFINITY, f64::max);
    let alike = (0..rims.len()).filter(|&k| turn(&rims[k]) > most - ALIKE);
    let longest = alike.max_by(|&a, &b| length(surface, &rims[a]).total_cmp(&length(surface, &rims[b])));
    longest.unwrap_or(0)
}

fn length(surface: &TriMesh, rim: &[u32]) -> f64 {
    let at = |k: usize| surface.vertices[rim[k % rim.len()] as usize];
    (0..rim.len()).map(|k| (at(k + 1) - at(k)).norm()).sum()
}
