//! Pieces that had to stretch.

use std::collections::HashMap;

use super::rim::{RimEdge, UNEVEN};
use super::schema::Stretched;
use super::tight::Tight;
use crate::geometry::{Vec3, sorted_pair};
use crate::mesh::{ClothMesh, Stitches};

/// The shorter side of an uneven seam counts as drawn out from this strain on: the rest may have been eased away.
const DRAWN_OUT: f64 = 0.03;

/// A piece counts as stretched when this share of its rim is drawn out: a neckband is, a front with a neckline is not.
const SHARE_OF_RIM: f64 = 0.10;

/// Share of a piece's rim that is its opening, above which the piece is a band: it is less than half as wide as it is
/// long. A wider piece may stretch at a small opening, as at an armhole, without stretching elsewhere.
const SHARE_OF_BAND: f64 = 1.0 / 3.0;

/// Mean extension of warp or weft from which any other piece is smaller than the body under it.
const OVER_BODY: f64 = 0.05;

/// Why the piece with this rim had to stretch, if it had to. `extension` is its mean strain along warp and weft.
pub(super) fn stretched(
    mesh: &ClothMesh,
    rim: &[RimEdge],
    extension: [f64; 2],
    tight: &Tight,
    at: &[Vec3],
) -> Option<Stretched> {
    by_seam(mesh, rim, at).or_else(|| by_body(rim, extension, tight, at))
}

fn by_seam(mesh: &ClothMesh, rim: &[RimEdge], at: &[Vec3]) -> Option<Stretched> {
    let drawn_out: Vec<&RimEdge> = rim.iter().filter(|e| is_drawn_out(e, at)).collect();
    let by = lengthened(rim, &drawn_out, SHARE_OF_RIM, at)?;
    Some(Stretched { by, why: format!("seam {}", longest_seam(mesh, &drawn_out)?.name) })
}

fn by_body(rim: &[RimEdge], extension: [f64; 2], tight: &Tight, at: &[Vec3]) -> Option<Stretched> {
    let given: Vec<&RimEdge> = rim.iter().filter(|e| tight.holds(e)).collect();
    let over = extension[0].max(extension[1]);
    let by = lengthened(rim, &given, SHARE_OF_BAND, at).or((over > OVER_BODY).then_some(over))?;
    Some(Stretched { by, why: "body".into() })
}

/// By how much a part of a rim is longer than drawn, if it is more than this share of it.
fn lengthened(rim: &[RimEdge], part: &[&RimEdge], share: f64, at: &[Vec3]) -> Option<f64> {
    let length: f64 = rim.iter().map(|e| e.length(at)).sum();
    let stretched: f64 = part.iter().map(|e| e.length(at)).sum();
    let flat: f64 = part.iter().map(|e| e.flat).sum();
    (stretched > share * length).then(|| stretched / flat - 1.0)
}

/// Whether the edge is the shorter partner of an uneven seam and gave way.
fn is_drawn_out(edge: &RimEdge, at: &[Vec3]) -> bool {
    let shortest = edge.flat <= edge.drawn[0] * (1.0 + UNEVEN / 10.0);
    edge.uneven() && shortest && edge.length(at) > (1.0 + DRAWN_OUT) * edge.flat
}

/// The seam that has most of these edges, by flat length.
fn longest_seam<'a>(mesh: &'a ClothMesh, edges: &[&RimEdge]) -> Option<&'a Stitches> {
    let flat_length: HashMap<[u32; 2], f64> = edges.iter().map(|e| (e.ends, e.flat)).collect();
    let on_seam = |seam: &Stitches| -> f64 {
        let steps = seam.pairs.windows(2).flat_map(|w| [[w[0][0], w[1][0]], [w[0][1], w[1][1]]]);
        steps.filter_map(|ends| flat_length.get(&sorted_pair(ends))).sum()
    };
    mesh.seams.iter().max_by(|x, y| on_seam(x).total_cmp(&on_seam(y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_gives_at_its_opening_is_a_band_or_else_wider() {
        // A piece 1 m long and so wide, its rim rolled out. One of its long sides has become 30 mm longer.
        let given = |wide: f64, share: f64| {
            let flat = [1.0, wide, 1.0, wide];
            let mut at = vec![Vec3::zeros()];
            for length in [1.03, wide, 1.0, wide] {
                at.push(at[at.len() - 1] + Vec3::x() * length);
            }
            let edge = |k: u32| {
                let flat = flat[k as usize];
                RimEdge { ends: [k, k + 1], triangle: 0, flat, drawn: [flat; 2] }
            };
            let rim: Vec<RimEdge> = (0..4).map(edge).collect();
            lengthened(&rim, &[&rim[0]], share, &at)
        };
        assert!(given(0.1, SHARE_OF_BAND).is_some_and(|by| (by - 0.03).abs() < 1e-12));
        assert_eq!(given(0.6, SHARE_OF_BAND), None);
        assert!(given(0.6, SHARE_OF_RIM).is_some());
    }
}
