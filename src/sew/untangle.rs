//! Cloth that passes through itself is led out.

use crate::contact::Tangle;
use crate::dynamics::{StepError, World};
use crate::geometry::{MeshEdge, Topology, Vec3};

/// Rounds of leading the cloth out of itself.
const ROUNDS: usize = 200;
/// How far a round moves what crosses apart, metres: little at first, for most crossings are shallow and further would
/// overshoot; as much more again every so many rounds, for what crosses deep.
const PULL: f64 = 0.3e-3;
const MORE: f64 = 20.0;
/// An edge that leaves a triangle's plane at less than this (sine) lies in it but for rounding: coordinates of metres
/// are right to 1e-16, edges a millimetre long.
const IN_PLANE: f64 = 1e-9;

/// Leads the cloth out of itself where it crosses: edges and the triangles they pass through are moved so that the line
/// along which they cross gets shorter, until nothing is left of it (Volino and Magnenat-Thalmann 2006). No spring
/// pulls meanwhile: it would pull the cloth further through where it presses on itself. Returns the rounds that took.
///
/// # Errors
/// As [`World::displace`].
pub(super) fn untangle(world: &mut World) -> Result<usize, StepError> {
    if world.tangles().is_empty() {
        return Ok(0);
    }
    let edges = Topology::new(&world.cloth.triangles).edges;
    let look = |world: &mut World, x: &[Vec3]| {
        let tangles = world.tangles_at(x);
        (tangles.len(), tangles)
    };
    let shift = |world: &World, x: &mut [Vec3], tangles: Vec<Tangle>, pull: f64| {
        shorten(&world.cloth.triangles, x, &edges, &tangles, pull);
    };
    let (rounds, x) = lead(world, ROUNDS, look, shift);
    world.displace(x)?;
    Ok(rounds)
}

/// Moves cloth by a little in every round, at most so many, until a `look` counts nothing that is wrong. If something
/// still is, the cloth belongs where that was the least. Returns the rounds that took, and the positions.
pub(super) fn lead<T>(
    world: &mut World,
    most: usize,
    look: impl Fn(&mut World, &[Vec3]) -> (usize, T),
    shift: impl Fn(&World, &mut [Vec3], T, f64),
) -> (usize, Vec<Vec3>) {
    let mut x = world.x().to_vec();
    let (mut count, mut wrong) = look(world, &x);
    let (mut rounds, mut best) = (0, (count, x.clone()));
    while count > 0 && rounds < most {
        shift(world, &mut x, wrong, PULL * (1.0 + rounds as f64 / MORE));
        rounds += 1;
        (count, wrong) = look(world, &x);
        if count < best.0 {
            best = (count, x.clone());
        }
    }
    (rounds, best.1)
}

/// Moves the two of every crossing by up to `pull` metres.
fn shorten(triangles: &[[u32; 3]], x: &mut [Vec3], edges: &[MeshEdge], tangles: &[Tangle], pull: f64) {
    let mut sum = vec![(Vec3::zeros(), 0.0); x.len()];
    for tangle in tangles {
        let Some(way) = way_out(triangles, x, edges, tangle) else { continue };
        let both = tangle.edge.iter().map(|n| (n, way)).chain(tangle.triangle.iter().map(|n| (n, -way)));
        for (n, way) in both {
            sum[*n as usize].0 += way * (0.5 * pull);
            sum[*n as usize].1 += 1.0;
        }
    }
    for (x, (way, count)) in x.iter_mut().zip(sum) {
        *x += way / f64::max(count, 1.0);
    }
}

/// Where to move the edge against the triangle, at most 1: the slope of the length of the lines along which the faces
/// beside the edge cross the triangle. `None` for what has no area, and for an edge in the triangle's plane, which says
/// of no way whether it shortens that line.
fn way_out(triangles: &[[u32; 3]], x: &[Vec3], edges: &[MeshEdge], tangle: &Tangle) -> Option<Vec3> {
    let at = |n: u32| x[n as usize];
    let [p, q] = tangle.edge.map(at);
    let [a, b, c] = tangle.triangle.map(at);
    let along = (q - p).try_normalize(0.0)?;
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    let through = along.dot(&normal);
    if through.abs() < IN_PLANE {
        return None;
    }
    let edge = &edges[edges.binary_search_by(|e| e.ends.cmp(&tangle.edge)).ok()?];
    let mut slope = Vec3::zeros();
    for &face in edge.triangles.iter().flatten() {
        let third = triangles[face as usize].into_iter().find(|n| !tangle.edge.contains(n))?;
        let into = at(third) - p;
        // From where the edge passes through the triangle, into the face.
        let line = (q - p).cross(&into).cross(&normal).try_normalize(0.0)?;
        let line = line * (into - along * along.dot(&into)).dot(&line).signum();
        slope += line - normal * (2.0 * along.dot(&line) / through);
    }
    Some(slope / (slope.norm_squared() + 1.0).sqrt())
}
