//! Laps: two free edges that closures hold one over the other. Finds places where the layer that belongs inside lies
//! outside.

use std::collections::{HashMap, HashSet};
use std::f64::consts::FRAC_PI_4;

use super::openings::corner;
use super::ring::FlatCloth;
use super::schema::Turned;
use crate::geometry::{MM, Vec3, rim_loops};
use crate::mesh::ClothMesh;
use crate::pattern::{EdgeId, Fastening, Garment};
use crate::verify::{Layer, Layers, Welded};

/// Layers further apart than this, metres, do not lie on one another.
const NEAR: f64 = 0.012;

/// Of layers nearer than this, metres, it cannot be told which is outside: they lie in one place.
const APART: f64 = 2e-4;

/// The other layer is looked for this far beyond an edge, metres, or half as far as the two overlap: two edges that lie
/// side by side, as the tops of a band's two ends, are no lap.
const BEYOND: f64 = 0.015;

/// Cloth that is nearer than this along the cloth, metres, is no other layer.
const NEIGHBOURS: f64 = 0.06;

/// A lap's edge goes on over seams until it has turned by so much, radians: down the front, and not round the hem.
const STRAIGHT: f64 = FRAC_PI_4;

/// Layers of the same side out are within this cosine of one another.
const ALIKE: f64 = 0.5;

/// A shorter stretch in the wrong order, metres, is a corner that curls.
const SHORTEST: f64 = 0.03;

/// Edges that overlap by less than this, metres, meet edge to edge, as those of a slit without a placket: either may
/// come to lie outside. The narrowest placket laps by twice as much.
const NARROWEST: f64 = 0.01;

/// Two edges that closures hold on one another.
struct HeldLap<'a> {
    /// The edge that belongs inside, and the one outside.
    edges: [EdgeId; 2],
    fastenings: Vec<&'a Fastening>,
}

/// For every closure of the garment, where the order of a lap that it closes first is wrong. `closed` are the
/// fastenings that hold.
pub(super) fn turned_laps(
    garment: &Garment,
    mesh: &ClothMesh,
    welded: &Welded,
    closed: &[Fastening],
) -> HashMap<usize, Turned> {
    let mut found = HashMap::new();
    if closed.is_empty() {
        return found;
    }
    let cloth = PlacedRims::new(mesh, welded);
    for lap in laps(garment, closed) {
        if let Some(turned) = cloth.turned(&lap) {
            found.entry(lap.fastenings[0].tack[0]).or_insert(turned);
        }
    }
    found
}

/// The laps that have an order: of pieces on different layers the outer one lies outside, of others the one that most
/// of the closures' points meet, as a buttonhole lies over its button.
fn laps<'a>(garment: &Garment, closed: &'a [Fastening]) -> Vec<HeldLap<'a>> {
    let mut laps: Vec<HeldLap> = Vec::new();
    for fastening in closed {
        let edges = fastening.ends.map(|end| end.edge);
        let same = |lap: &&mut HeldLap| lap.edges == edges || lap.edges == [edges[1], edges[0]];
        match laps.iter_mut().find(same) {
            Some(lap) => lap.fastenings.push(fastening),
            None if edges[0] != edges[1] => laps.push(HeldLap { edges, fastenings: vec![fastening] }),
            None => {}
        }
    }
    laps.retain(|lap| lap.fastenings.iter().any(|f| f.reach >= NARROWEST));
    for lap in &mut laps {
        let as_first = lap.fastenings.iter().filter(|f| f.ends[0].edge == lap.edges[0]).count();
        let layers = lap.edges.map(|edge| garment.pieces.get(edge.piece).map_or(0, |piece| piece.layer));
        let swapped = if layers[0] == layers[1] { 2 * as_first < lap.fastenings.len() } else { layers[0] > layers[1] };
        if swapped {
            lap.edges.reverse();
        }
    }
    laps
}

/// The garment and its rims.
struct PlacedRims<'a> {
    mesh: &'a ClothMesh,
    welded: &'a Welded,
    flat: FlatCloth,
    loops: Vec<Vec<u32>>,
    layers: Layers<'a>,
    /// The triangles round every vertex.
    round: Vec<Vec<u32>>,
}

/// A vertex of a lap's edge with another layer before or behind it.
struct LapPlace {
    /// Its place in the chain.
    at: usize,
    layer: Layer,
}

impl<'a> PlacedRims<'a> {
    fn new(mesh: &'a ClothMesh, welded: &'a Welded) -> Self {
        let mut round = vec![Vec::new(); welded.surface.vertices.len()];
        for (t, corners) in (0..).zip(&welded.surface.triangles) {
            corners.iter().for_each(|&v| round[v as usize].push(t));
        }
        let loops = rim_loops(&welded.surface.triangles);
        let layers = Layers::new(&welded.surface);
        Self { mesh, welded, flat: FlatCloth::new(mesh, welded), loops, layers, round }
    }

    /// The longest stretch of either edge of a lap that lies on the wrong side of the other layer.
    fn turned(&self, lap: &HeldLap) -> Option<Turned> {
        let sides = (0..2).filter_map(|side| self.turned_edge(lap, side));
        sides.max_by(|a, b| a.length.total_cmp(&b.length))
    }

    /// The same of the inner edge (side 0) or the outer one.
    fn turned_edge(&self, lap: &HeldLap, side: usize) -> Option<Turned> {
        let corners = self.corners(lap, side);
        let (rim, chain) = self.along(&corners)?;
        let (other_rim, other) = self.along(&self.corners(lap, 1 - side))?;
        let other = self.pieces(&self.loops[other_rim], &other);
        let reach = lap.fastenings.iter().map(|f| f.reach).fold(0.0, f64::max);
        let places = self.places(&self.loops[rim], &chain, &other, BEYOND.min(0.5 * reach));
        let run = self.longest(&self.loops[rim], &chain, &places, |layer| (layer.at > 0.0) == (side == 1))?;
        // Points of the closure, by their places in the chain.
        let points = corners.iter().zip(&lap.fastenings).filter_map(|(corner, fastening)| {
            let [r, k] = (*corner)?;
            (r == rim).then_some((chain.iter().position(|&i| i == k)?, fastening.tack[1] + 1))
        });
        let points: Vec<(usize, usize)> = points.collect();
        let own = self.name(self.round[self.vertex(rim, chain[run.middle.at]) as usize][0]);
        let (other, place) = (self.name(run.middle.layer.triangle), between(&points, run.middle.at));
        let [over, under] = if side == 0 { [own, other] } else { [other, own] };
        Some(Turned { length: run.length * MM, at: format!("{place}, '{over}' lies over '{under}'") })
    }

    /// The rim and its corner at which each closure's point holds an edge of a lap.
    fn corners(&self, lap: &HeldLap, side: usize) -> Vec<Option<[usize; 2]>> {
        let spots = lap.fastenings.iter().map(|f| f.ends.iter().find(|end| end.edge == lap.edges[side]));
        spots.map(|spot| corner(self.mesh, self.welded, &self.loops, spot?)).collect()
    }

    /// A rim through the first of the corners, and its part that goes straight on there, as indices into it.
    fn along(&self, corners: &[Option<[usize; 2]>]) -> Option<(usize, Vec<usize>)> {
        let [rim, start] = corners.iter().flatten().copied().next()?;
        Some((rim, self.chain(&self.loops[rim], start)))
    }

    /// The pieces along a part of a rim.
    fn pieces(&self, ring: &[u32], chain: &[usize]) -> HashSet<usize> {
        let triangles = chain.iter().flat_map(|&k| &self.round[ring[k] as usize]);
        triangles.filter_map(|&t| self.piece(t)).collect()
    }

    /// The piece that a triangle is of.
    fn piece(&self, triangle: u32) -> Option<usize> {
        self.mesh.piece_of(self.mesh.triangles[triangle as usize][0])
    }

    fn vertex(&self, rim: usize, k: usize) -> u32 {
        self.loops[rim][k]
    }

    /// The name of a triangle's piece.
    fn name(&self, triangle: u32) -> &str {
        self.piece(triangle).map_or("", |piece| &self.mesh.pieces[piece].name)
    }

    /// The part of a rim through its corner `start` that goes straight on, as indices into the rim.
    fn chain(&self, ring: &[u32], start: usize) -> Vec<usize> {
        let n = ring.len();
        let walk = |step: usize| {
            let (mut turned, mut at, mut out) = (0.0f64, start, Vec::new());
            loop {
                at = (at + step) % n;
                turned += self.flat.turn(ring, at);
                if at == start || turned.abs() > STRAIGHT {
                    return out;
                }
                out.push(at);
            }
        };
        let (back, forth) = (walk(n - 1), walk(1));
        if forth.len() + 1 == n {
            return std::iter::once(start).chain(forth).collect();
        }
        back.into_iter().rev().chain([start]).chain(forth).collect()
    }

    /// Places where a layer of the `other` edge's pieces lies before or behind the cloth, searched `beyond` the rim:
    /// cloth that only crosses the lap, as the other one of two crossed straps, has no order in it.
    fn places(&self, ring: &[u32], chain: &[usize], other: &HashSet<usize>, beyond: f64) -> Vec<LapPlace> {
        let n = ring.len();
        let is_other = |l: &Layer| self.piece(l.triangle).is_some_and(|piece| other.contains(&piece));
        let point = |k: usize| self.welded.surface.vertices[ring[k % n] as usize];
        let place = |(at, &k): (usize, &usize)| {
            let normal = self.normal(ring[k])?;
            let along = point(k + 1) - point(k + n - 1);
            // A rim runs with its triangles: the cloth is to its left.
            let out = along.cross(&normal).try_normalize(0.0)?;
            let own = self.neighbours(ring[k]);
            let alike = |from: Vec3| {
                let layers = self.layers.near(from, normal, NEAR, |t| own.contains(&t)).into_iter();
                layers.filter(|l| l.facing > ALIKE && is_other(l)).min_by(|a, b| a.at.abs().total_cmp(&b.at.abs()))
            };
            // On which side is asked at the rim: beyond it the body bends away by more than layers are apart.
            alike(point(k) + out * beyond)?;
            let layer = alike(point(k)).filter(|layer| layer.at.abs() > APART)?;
            Some(LapPlace { at, layer })
        };
        chain.iter().enumerate().filter_map(place).collect()
    }

    /// Unit normal of the cloth at a vertex, out of its right side.
    fn normal(&self, vertex: u32) -> Option<Vec3> {
        let normal = |&t: &u32| {
            let [a, b, c] = self.welded.surface.corners(t as usize);
            (b - a).cross(&(c - a))
        };
        self.round[vertex as usize].iter().map(normal).sum::<Vec3>().try_normalize(0.0)
    }

    /// The triangles within [`NEIGHBOURS`] of a vertex, along the cloth.
    fn neighbours(&self, vertex: u32) -> HashSet<u32> {
        let mut far: HashMap<u32, f64> = HashMap::from([(vertex, 0.0)]);
        let (mut open, mut found) = (vec![vertex], HashSet::new());
        while let Some(v) = open.pop() {
            let so_far = far[&v];
            for &t in &self.round[v as usize] {
                found.insert(t);
                for &w in &self.welded.surface.triangles[t as usize] {
                    let there = so_far + self.flat.length(v, w);
                    if there <= NEIGHBOURS && far.get(&w).is_none_or(|&known| there < known) {
                        far.insert(w, there);
                        open.push(w);
                    }
                }
            }
        }
        found
    }

    /// The longest run of places at which `is_wrong` holds, unless it is shorter than [`SHORTEST`].
    fn longest<'p>(
        &self,
        ring: &[u32],
        chain: &[usize],
        places: &'p [LapPlace],
        is_wrong: impl Fn(&Layer) -> bool,
    ) -> Option<LapStretch<'p>> {
        let step = |k: usize| self.flat.length(ring[k], ring[(k + 1) % ring.len()]);
        let runs =
            places.chunk_by(|a, b| is_wrong(&a.layer) == is_wrong(&b.layer)).filter(|run| is_wrong(&run[0].layer));
        let measured = runs.map(|run| LapStretch {
            length: run.iter().map(|place| step(chain[place.at])).sum(),
            middle: &run[run.len() / 2],
        });
        measured.filter(|run| run.length >= SHORTEST).max_by(|a, b| a.length.total_cmp(&b.length))
    }
}

/// A stretch of an edge.
struct LapStretch<'p> {
    /// Metres.
    length: f64,
    middle: &'p LapPlace,
}

/// Between which of the numbered points along a chain its place `at` is.
fn between(points: &[(usize, usize)], at: usize) -> String {
    let before = points.iter().filter(|p| p.0 <= at).max_by_key(|p| p.0).map(|p| p.1);
    let after = points.iter().filter(|p| p.0 > at).min_by_key(|p| p.0).map(|p| p.1);
    match (before, after) {
        (Some(a), Some(b)) => format!("between points {} and {}", a.min(b), a.max(b)),
        (Some(a), None) | (None, Some(a)) => format!("beyond point {a}"),
        (None, None) => "along its edge".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_between_the_points_on_both_sides_of_it() {
        let points = [(40, 1), (20, 2), (4, 3)];
        assert_eq!(between(&points, 25), "between points 1 and 2");
        assert_eq!(between(&points, 2), "beyond point 3");
        assert_eq!(between(&points, 50), "beyond point 1");
    }
}
