//! A seam that cannot close because an arm or a leg is between its edges.

use std::collections::HashSet;

use super::job::Job;
use super::obstacle::Caught;
use crate::geometry::{Vec3, pierces};
use crate::mannequin::{BodyPart, HAND_OR_FOOT};
use crate::mesh::Stitches;
use crate::report::opening_names;
use crate::sew::SewError;

impl Job {
    /// The obstacle of a seam that stayed open with the particles at `at`, if a limb is between its edges.
    pub(super) fn caught(&self, error: &SewError, at: &[Vec3]) -> Option<Caught> {
        let SewError::Open { seam, gap_mm, piece_a, piece_b, .. } = error else { return None };
        let stitches = self.mesh.seams.iter().find(|s| s.name == *seam)?;
        // Where limbs were held apart they still are.
        let body = self.stance.as_ref().map_or(&self.body, |stance| &stance.body);
        let limbs = body.parts.iter().filter(|part| part.kind.is_arm() || part.kind.is_leg());
        let (limb, line) = limbs.map(|part| (part, line(part))).find(|(_, line)| is_between(stitches, at, line))?;
        let tip = *line.last()?;
        Some(Caught {
            file: self.file.clone(),
            seam: seam.clone(),
            gap_mm: *gap_mm,
            limb: limb.kind,
            opening: self.opening_near(stitches, at, tip),
            pieces: [piece_a.clone(), piece_b.clone()],
        })
    }

    /// The name of the opening at the end of a seam that is nearer to `tip`, if there is one.
    fn opening_near(&self, seam: &Stitches, at: &[Vec3], tip: Vec3) -> Option<String> {
        let far =
            |pair: &[u32; 2]| pair.map(|p| (at[p as usize] - tip).norm()).into_iter().fold(f64::INFINITY, f64::min);
        let ends = [seam.pairs.first()?, seam.pairs.last()?];
        let end = ends.into_iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
        let sewn: HashSet<u32> = self.mesh.seams.iter().flat_map(|s| s.pairs.iter().flatten()).copied().collect();
        let free = self.mesh.pieces.iter().flat_map(|piece| piece.edges.iter().map(|edge| (&piece.name, edge)));
        let names = free.filter_map(|(piece, edge)| {
            let [first, inner @ .., last] = edge.particles.as_slice() else { return None };
            let is_free = !inner.is_empty() && inner.iter().all(|p| !sewn.contains(p));
            (is_free && (end.contains(first) || end.contains(last))).then(|| (piece.clone(), edge.name.clone()))
        });
        let names: Vec<(String, String)> = names.collect();
        (!names.is_empty()).then(|| opening_names(&[names]).remove(0))
    }
}

/// The axis of a limb, on to the tips of its fingers or toes.
fn line(limb: &BodyPart) -> Vec<Vec3> {
    let mut line: Vec<Vec3> = limb.sections.iter().map(|s| s.center).collect();
    line.extend(limb.sections.last().map(|s| s.center + s.axis * HAND_OR_FOOT));
    line
}

/// Whether a line passes between the two edges of a seam.
fn is_between(seam: &Stitches, at: &[Vec3], line: &[Vec3]) -> bool {
    seam.pairs.windows(2).any(|w| {
        let [[a, b], [c, d]] = [w[0], w[1]].map(|pair| pair.map(|p| at[p as usize]));
        let parts = [[a, b, c], [b, d, c]];
        line.windows(2).any(|l| parts.iter().any(|part| pierces(l[0], l[1], *part)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_between_the_edges_of_a_seam_or_beside_them() {
        // Two edges 1 m high and 200 mm apart.
        let at: Vec<Vec3> = (0..11).flat_map(|k| [-0.1, 0.1].map(|x| Vec3::new(x, 0.1 * f64::from(k), 0.0))).collect();
        let pairs = (0..11).map(|k| [2 * k, 2 * k + 1]).collect();
        let seam = Stitches { name: "side".into(), stage: 0, pairs };
        let through = |x: f64, y: f64| is_between(&seam, &at, &[Vec3::new(x, y, -1.0), Vec3::new(x, y, 1.0)]);
        assert!(through(0.03, 0.56) && through(-0.09, 0.11));
        assert!(!through(0.11, 0.56) && !through(0.03, 1.02));
    }
}
