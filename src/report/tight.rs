//! Openings that are drawn smaller than the body they are round.

use std::collections::{HashMap, HashSet};

use super::openings::SewnRim;
use super::rim::RimEdge;
use crate::geometry::{Vec3, sorted_pair};
use crate::mannequin::Mannequin;
use crate::verify::Welded;

/// A rim that has to give no more than this share is held to its drawn length like any other: its piece, which gives
/// less, can keep its area to half a percent all the same.
const GIVES: f64 = 0.01;

/// The rims that had to give way to the body.
pub(super) struct Tight<'a> {
    welded: &'a Welded,
    /// Their edges, by the vertices of the welded surface.
    edges: HashSet<[u32; 2]>,
}

impl<'a> Tight<'a> {
    /// Of all the `openings` of a garment, with the `rims` of its pieces, on `body`.
    pub(super) fn new(welded: &'a Welded, openings: &[SewnRim], rims: &[Vec<RimEdge>], body: &Mannequin) -> Self {
        let key = |e: &RimEdge| sorted_pair(e.ends.map(|p| welded.vertex_of[p as usize]));
        let drawn: HashMap<[u32; 2], f64> = rims.iter().flatten().map(|e| (key(e), e.flat)).collect();
        let mut edges = HashSet::new();
        for opening in openings {
            let at = opening.positions(welded);
            let steps = (0..at.len()).map(|k| {
                let next = (k + 1) % at.len();
                let ends = sorted_pair([opening.ring[k], opening.ring[next]]);
                // What a closure bridges is drawn by nobody.
                (ends, drawn.get(&ends).copied().unwrap_or_else(|| (at[next] - at[k]).norm()))
            });
            if is_tight(&at, steps.clone().map(|(_, drawn)| drawn).sum(), body) {
                edges.extend(steps.map(|(ends, _)| ends));
            }
        }
        Self { welded, edges }
    }

    /// Whether an edge is on one of them.
    pub(super) fn holds(&self, edge: &RimEdge) -> bool {
        self.edges.contains(&sorted_pair(edge.ends.map(|p| self.welded.vertex_of[p as usize])))
    }
}

/// Whether a ring that was drawn so long, metres, is longer because the body would not fit into it otherwise: a tape
/// round that in the ring's plane is longer than it was drawn, and no longer than it has become. (A ring shorter than
/// the tape does not lie in that plane: a neckline goes over the shoulders.)
fn is_tight(ring: &[Vec3], drawn: f64, body: &Mannequin) -> bool {
    let least = drawn * (1.0 + GIVES);
    let length: f64 = ring.iter().zip(ring.iter().cycle().skip(1)).map(|(p, q)| (q - p).norm()).sum();
    let fits = |tape: f64| least < tape && tape <= length * (1.0 + GIVES);
    length > least && tape(ring, body).is_some_and(fits)
}

/// Length of a tape round the body part inside a ring, in the ring's plane, metres.
fn tape(ring: &[Vec3], body: &Mannequin) -> Option<f64> {
    let middle = ring.iter().sum::<Vec3>() / ring.len() as f64;
    let sides = || ring.iter().zip(ring.iter().cycle().skip(1)).map(|(p, q)| [p - middle, q - middle]);
    let axis = sides().map(|[p, q]| p.cross(&q)).sum::<Vec3>().try_normalize(0.0)?;
    // How often the ring turns round a point in its plane.
    let turn = |at: Vec3| {
        let off = at - middle;
        let angle = |[p, q]: [Vec3; 2]| {
            let [p, q] = [p - off, q - off].map(|d| d - axis * d.dot(&axis));
            p.cross(&q).dot(&axis).atan2(p.dot(&q))
        };
        sides().map(angle).sum::<f64>()
    };
    body.tape(middle, axis, |p| turn(p) > std::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::TriMesh;

    /// Corners of a regular polygon.
    const CORNERS: u32 = 60;

    fn circle(middle: Vec3, radius: f64) -> impl Iterator<Item = Vec3> {
        let angle = |k: u32| TAU * f64::from(k) / f64::from(CORNERS);
        (0..CORNERS).map(move |k| middle + Vec3::new(radius * angle(k).cos(), 0.0, -radius * angle(k).sin()))
    }

    /// Upright tubes 1 m high and 100 mm wide: a trunk, and an arm 150 mm beside it.
    fn body() -> Mannequin {
        let mut mesh = TriMesh::default();
        for x in [0.0, 0.15] {
            let first = mesh.vertices.len() as u32;
            for y in [0.0, 1.0] {
                mesh.vertices.extend(circle(Vec3::new(x, y, 0.0), 0.05));
            }
            for k in 0..CORNERS {
                let [a, b] = [first + k, first + (k + 1) % CORNERS];
                mesh.triangles.extend([[a, b, b + CORNERS], [a, b + CORNERS, a + CORNERS]]);
            }
        }
        Mannequin { name: "tubes".into(), mesh, parts: Vec::new(), frame: Default::default() }
    }

    #[test]
    fn a_ring_is_tight_if_the_body_in_it_is_larger_than_it_was_drawn() {
        let (body, girth) = (body(), TAU * 0.05);
        let ring = |radius: f64| circle(Vec3::new(0.0, 0.5, 0.0), radius).collect::<Vec<_>>();
        assert!(is_tight(&ring(0.0505), 0.96 * girth, &body));
        assert!(!is_tight(&ring(0.0505), 0.995 * girth, &body), "it need give no more than half a percent");
        // Pulled longer than drawn by something else than the body.
        assert!(!is_tight(&ring(0.06), 1.1 * girth, &body));
        // Round nothing; and the arm beside it is no part of what is in it.
        assert!(!is_tight(&circle(Vec3::new(0.5, 0.5, 0.0), 0.05).collect::<Vec<_>>(), 0.9 * girth, &body));
        let hull = tape(&ring(0.0505), &body).expect("a trunk");
        assert!((hull - girth).abs() < 1e-3 * girth, "{hull}");
    }

    #[test]
    fn a_ring_over_a_shoulder_is_not_measured_where_it_is_not() {
        // Half as long as a tape in its plane: only a cord through the body would be.
        let cord: Vec<Vec3> = circle(Vec3::new(0.0, 0.5, 0.0), 0.025).collect();
        assert!(!is_tight(&cord, 0.4 * TAU * 0.05, &body()));
    }
}
