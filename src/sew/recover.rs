//! Pieces that start in the body, moved out of it.

use rayon::prelude::*;

use super::error::SewError;
use crate::contact::Collider;
use crate::dynamics::Cut;
use crate::geometry::Vec3;

/// Metres; a start less deep is pushed out by the contact.
const DEEP: f64 = 0.015;
/// A piece that lies deeper than this, metres, was meant for another place.
const DEEPEST: f64 = 0.05;
/// A piece whose cells are in the body by so much in their middle, metres, and by half as much more than at their
/// corners, is pierced: contact at its particles would push them along what pokes through, not off it.
const PIERCED: f64 = 4e-3;
/// A piece of which more than this share is deeper than [`DEEP`] is pushed out on both sides.
const SHARE: f64 = 0.25;
/// A piece is moved by so much at a time, at most so often, metres.
const STEP: f64 = 4e-3;
const STEPS: usize = 25;
/// Cloth that lies less deep, metres, may come out anywhere: sleeves touch the trunk under the arm, which is no hollow.
const SHALLOW: f64 = 4e-3;
/// A way out of the body ends in a hollow if it meets the body again within this, metres: a mouth is no wider.
const HOLLOW: f64 = 0.08;
/// The surface itself is not in its own way, metres.
const OFF_SKIN: f64 = 1e-4;
/// So many points of a piece stand for all when its way out is looked for.
const SAMPLES: usize = 200;
/// How far the body's surface is looked for, metres.
const LOOK: f64 = 0.5;

/// Moves every piece that lies in the body, up to 50 mm deep, that the body pokes through, or that would be pushed into
/// a hollow of it (a scanned head has a mouth), out of it as it is, the shortest straight way.
///
/// # Errors
/// [`SewError::InsideBody`] or [`SewError::UnderFloor`] for one that is still deep then, or was deeper: the penalty
/// would push its halves out on different sides.
pub(super) fn lead_out(cut: &Cut, body: &Collider, start: &mut [Vec3]) -> Result<(), SewError> {
    for piece in &cut.mesh.pieces {
        let deepest = depths(body, &start[piece.particles.clone()]).fold(0.0, f64::max);
        let triangles = &cut.mesh.triangles[piece.triangles.clone()];
        let pierced = is_pierced(body, start, triangles);
        let hidden = deepest > SHALLOW && start[piece.particles.clone()].iter().any(|&p| is_hidden(body, p));
        if deepest <= DEEP && !pierced && !hidden {
            continue;
        }
        let middles = triangles.iter().map(|t| middle(start, t));
        let points: Vec<Vec3> = start[piece.particles.clone()].iter().copied().chain(middles).collect();
        let x = &mut start[piece.particles.clone()];
        let sunk = body.floor().is_some_and(|floor| x.iter().any(|p| floor - p.y >= deepest));
        if deepest <= DEEPEST {
            let way = way_out(body, &points);
            x.iter_mut().for_each(|p| *p += way);
        }
        if is_deep(body, x) {
            let (piece, depth_mm) = (piece.name.clone(), 1e3 * deepest);
            return Err(if sunk {
                SewError::UnderFloor { piece, depth_mm }
            } else {
                SewError::InsideBody { piece, depth_mm }
            });
        }
    }
    Ok(())
}

/// How deep (metres) the deepest of a piece's particles lies in the body, if [`lead_out`] leaves it there.
pub(crate) fn left_inside(body: &Collider, x: &[Vec3]) -> Option<f64> {
    let deepest = depths(body, x).fold(0.0, f64::max);
    (deepest > DEEPEST && is_deep(body, x)).then_some(deepest)
}

/// Whether so much of a piece is deep in the body that it would be pushed out on both sides.
fn is_deep(body: &Collider, x: &[Vec3]) -> bool {
    let deep = depths(body, x).filter(|&d| d > DEEP).count();
    deep as f64 > SHARE * x.len() as f64
}

/// Whether the nearest way out of the body for a point well in it ends in a hollow: what is behind the skin there is
/// the body again. Its neighbours may well be nearest to the other side of a chin.
fn is_hidden(body: &Collider, p: Vec3) -> bool {
    let out = body.nearest(p, LOOK).filter(|out| out.distance < -SHALLOW);
    out.is_some_and(|out| body.is_in_the_way(out.point + out.normal * OFF_SKIN, out.point + out.normal * HOLLOW))
}

/// Whether the body pokes through a triangle between its corners.
fn is_pierced(body: &Collider, x: &[Vec3], triangles: &[[u32; 3]]) -> bool {
    let pokes = |t: &[u32; 3]| {
        let inside = depths(body, &[middle(x, t)]).next().unwrap_or(-LOOK);
        let corners = t.map(|n| x[n as usize]);
        inside > PIERCED && depths(body, &corners).fold(-LOOK, f64::max) < inside - 0.5 * PIERCED
    };
    triangles.par_iter().any(pokes)
}

fn middle(x: &[Vec3], t: &[u32; 3]) -> Vec3 {
    t.iter().map(|n| x[*n as usize]).sum::<Vec3>() / 3.0
}

/// How deep each of some points lies in the body, metres; negative outside.
fn depths<'a>(body: &'a Collider, x: &'a [Vec3]) -> impl Iterator<Item = f64> + 'a {
    x.iter().map(|&p| body.nearest(p, LOOK).map_or(-LOOK, |n| -n.distance))
}

/// The shortest straight way after which no point lies in the body, or all together lie the least deep.
fn way_out(body: &Collider, x: &[Vec3]) -> Vec3 {
    let sample: Vec<Vec3> = x.iter().step_by(x.len().div_ceil(SAMPLES)).copied().collect();
    let depth_after = |way: Vec3| {
        let moved: Vec<Vec3> = sample.iter().map(|p| p + way).collect();
        depths(body, &moved).map(|d| d.max(0.0)).sum::<f64>()
    };
    // The least depth along each direction, and where.
    let best = |direction: &Vec3| {
        let mut best = (f64::INFINITY, 0, Vec3::zeros());
        for k in 0..=STEPS {
            let way = direction * (STEP * k as f64);
            let depth = depth_after(way);
            if depth < best.0 {
                best = (depth, k, way);
            }
            if depth == 0.0 {
                break;
            }
        }
        best
    };
    let ways: Vec<(f64, usize, Vec3)> = directions().par_iter().map(best).collect();
    ways.into_iter().min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map_or_else(Vec3::zeros, |best| best.2)
}

/// Unit vectors to the faces, edges and corners of a cube.
fn directions() -> Vec<Vec3> {
    let signs = || [-1.0, 0.0, 1.0].into_iter();
    let all = signs().flat_map(|x| signs().flat_map(move |y| signs().map(move |z| Vec3::new(x, y, z))));
    all.filter_map(|d| d.try_normalize(0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::spike;
    use crate::geometry::TriMesh;

    /// A triangle round the spike, at this height.
    fn collar(z: f64) -> [Vec3; 3] {
        [Vec3::new(-0.03, -0.02, z), Vec3::new(0.03, -0.02, z), Vec3::new(0.0, 0.04, z)]
    }

    #[test]
    fn cloth_that_a_spike_pokes_through_between_its_particles_is_pierced_and_comes_off() {
        let body = spike();
        let x = collar(0.015);
        assert!(depths(&body, &x).all(|d| d < 0.0), "its particles are outside");
        assert!(is_pierced(&body, &x, &[[0, 1, 2]]));
        let points = [x[0], x[1], x[2], middle(&x, &[0, 1, 2])];
        let way = way_out(&body, &points);
        let moved = x.map(|p| p + way);
        assert!(!is_pierced(&body, &moved, &[[0, 1, 2]]), "{way:?}");
        assert!(way.norm() < 0.03, "{way:?}");
    }

    #[test]
    fn cloth_over_the_tip_or_as_deep_at_its_corners_is_not_pierced() {
        let body = spike();
        assert!(!is_pierced(&body, &collar(0.045), &[[0, 1, 2]]));
        let inside = collar(0.01).map(|p| Vec3::new(0.05 * p.x, 0.05 * p.y, p.z));
        assert!(depths(&body, &inside).all(|d| d > PIERCED));
        assert!(!is_pierced(&body, &inside, &[[0, 1, 2]]));
    }
    /// A box with a cavity: a mouth, open towards +z. Outer walls 100 mm, the cavity 60 mm wide and high and 80 mm
    /// deep.
    fn head() -> Collider {
        let corner = |half: f64, z: f64| {
            [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[x, y]| Vec3::new(x, y, z))
        };
        let rings = [corner(0.05, 0.0), corner(0.05, 0.1), corner(0.03, 0.1), corner(0.03, 0.02)];
        let mut triangles = vec![[0, 2, 1], [0, 3, 2], [12, 13, 14], [12, 14, 15]];
        for ring in 0..3 {
            for k in 0..4 {
                let [a, b] = [4 * ring + k, 4 * ring + (k + 1) % 4];
                triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
            }
        }
        Collider::new(&TriMesh { vertices: rings.concat(), triangles }).expect("collider")
    }

    #[test]
    fn what_would_be_pushed_into_the_mouth_is_led_out() {
        let body = head();
        // In the cheek, 20 mm thick: nearest to the mouth, and nearest to the outside.
        let cheek = |x: f64| Vec3::new(x, 0.0, 0.06);
        assert!(is_hidden(&body, cheek(0.035)) && !is_hidden(&body, cheek(0.045)));
        // The mouth itself and what is outside are not in the body.
        assert!(!is_hidden(&body, cheek(0.0)) && !is_hidden(&body, cheek(0.06)));
        let x: Vec<Vec3> = [0.035, 0.055, 0.075].into_iter().map(cheek).collect();
        let moved: Vec<Vec3> = {
            let way = way_out(&body, &x);
            x.iter().map(|p| p + way).collect()
        };
        assert!(depths(&body, &moved).all(|d| d <= 0.0));
        assert!(moved.iter().all(|p| p.x > 0.05), "outside, not in the mouth: {moved:?}");
    }
}
