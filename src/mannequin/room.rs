//! Limbs that almost touch give way, so that there is room for cloth between them.

use super::junction::{Junction, JunctionSide, LEVEL, LIMB, junctions};
use super::label::Labels;
use super::spread::LimbSpread;
use super::{Mannequin, PartKind};
use crate::geometry::{Topology, TriMesh, range_of};

/// Least distance between limbs that run beside one another, metres. The cloth of two trouser legs, with its thickness
/// and the distance that contact keeps, goes between.
pub const GAP: f64 = 0.004;
/// A limb that would have to go further than this, metres, lies in front of the other and not beside it.
const MOST: f64 = 0.02;
/// Below where two limbs join, their gap opens by this share of the way down until it is [`GAP`].
const FORK: f64 = 0.5;
/// A limb goes out over twice so many levels.
const SMOOTH: usize = 6;

/// Moves limbs of `body` sideways that are nearer than [`GAP`] to what they hang beside: two legs by half of the way
/// each, an arm by all of it. Lower sections go at least as far, so every limb keeps its girths. Returns the limbs
/// and how far they went at most, metres. A body with room stays as it is.
pub fn make_room(body: &mut Mannequin) -> Vec<(PartKind, f64)> {
    let edges = Topology::new(&body.mesh.triangles).edges;
    let top = body.mesh.vertices.iter().map(|p| p.y).fold(0.0, f64::max);
    let Ok(labels) = Labels::new(&body.mesh, &edges, top) else { return Vec::new() };
    let mut moved: Vec<(PartKind, f64)> = Vec::new();
    for junction in junctions(&body.mesh, &edges, LIMB) {
        let kinds = [JunctionSide::Limb, JunctionSide::Beside].map(|side| labels.most_of(&junction, side));
        let Some(limb) = kinds[0].filter(|kind| kind.is_arm() || kind.is_leg()) else { continue };
        let Some(by) = opening(&body.mesh, &junction, way_of(limb)) else { continue };
        // Of two legs both give way. What an arm hangs beside stays.
        let sides = match kinds[1].filter(|beside| limb.is_leg() && beside.is_leg()) {
            Some(beside) => vec![(JunctionSide::Limb, limb, 0.5), (JunctionSide::Beside, beside, 0.5)],
            None => vec![(JunctionSide::Limb, limb, 1.0)],
        };
        for (side, kind, share) in sides {
            let by = by.iter().map(|by| by * share * way_of(kind)).collect();
            let spread = LimbSpread::new(&junction, side, kind, by);
            spread.apply(&mut body.mesh, 1.0);
            spread.apply_to_part(&mut body.parts);
            moved.push((kind, spread.at(junction.bottom).abs()));
        }
    }
    moved.sort_by_key(|(kind, _)| *kind);
    moved
}

/// The sign of x on a limb's side.
fn way_of(kind: PartKind) -> f64 {
    if matches!(kind, PartKind::LeftArm | PartKind::LeftLeg) { 1.0 } else { -1.0 }
}

/// How far the two of a junction have to go apart at every level, metres. `None` if they have room.
fn opening(mesh: &TriMesh, junction: &Junction, way: f64) -> Option<Vec<f64>> {
    let cuts = cuts(mesh, junction, way);
    let mut most: f64 = 0.0;
    let wanted = |(k, [limb, beside]): (usize, &[Vec<Line>; 2])| {
        let missing = missing(limb, beside, GAP.min(FORK * k as f64 * LEVEL));
        most = most.max(missing.filter(|by| *by <= MOST).unwrap_or(0.0));
        most
    };
    let raw: Vec<f64> = cuts.iter().enumerate().map(wanted).collect();
    let last = *raw.last().filter(|last| **last > 0.0)?;
    // The mean over these levels is no less than the first of them, since no level wants less than that above it.
    let smooth = |k: usize| {
        let ahead = (k..=k + 2 * SMOOTH).map(|j| raw.get(j).copied().unwrap_or(last));
        (ahead.sum::<f64>() / (2 * SMOOTH + 1) as f64).min(FORK * k as f64 * LEVEL)
    };
    Some((0..raw.len()).map(smooth).collect())
}

/// A piece of a horizontal cut: how far to the side its ends are, and how far to the front, metres.
type Line = [[f64; 2]; 2];

/// The pieces of the limb's cut and of what it hangs beside at every level, sideways as the limb lies.
fn cuts(mesh: &TriMesh, junction: &Junction, way: f64) -> Vec<[Vec<Line>; 2]> {
    let levels = junction.levels();
    let mut out = vec![[Vec::new(), Vec::new()]; levels.len()];
    junction.cut(mesh, &levels, |level, of, ends| out[level][of].push(ends.map(|p| [way * p.x, p.z])));
    out
}

/// By how much a limb has to go to its side for a distance of `gap` to something, metres. `None` if they are not side
/// by side.
fn missing(limb: &[Line], beside: &[Line], gap: f64) -> Option<f64> {
    let back = |[a, b]: Line| [[-a[0], a[1]], [-b[0], b[1]]];
    let mut most: Option<f64> = None;
    let mut ask = |reach: Option<f64>, from: f64| {
        if let Some(reach) = reach {
            most = Some(most.map_or(reach - from, |most| most.max(reach - from)));
        }
    };
    for line in limb {
        let [low, high] = range_of(line.iter().map(|p| p[1]));
        for other in beside {
            let [low, high] = [low - gap, high + gap];
            if other.iter().all(|p| p[1] < low) || other.iter().all(|p| p[1] > high) {
                continue;
            }
            line.iter().for_each(|p| ask(reach(*other, p[1], gap), p[0]));
            other.iter().for_each(|q| ask(reach(back(*line), q[1], gap), -q[0]));
        }
    }
    most
}

/// How far to the side the points go that are within `gap` of a line and `front` so far to the front.
fn reach(line: Line, front: f64, gap: f64) -> Option<f64> {
    let disc = |p: [f64; 2]| {
        let off = front - p[1];
        (off.abs() <= gap).then(|| p[0] + (gap * gap - off * off).sqrt())
    };
    let [a, b] = line;
    let along = [b[0] - a[0], b[1] - a[1]];
    let long = along[0].hypot(along[1]);
    let flank = || {
        // The parallel to the line on the side that it is pushed from.
        let out = gap * along[1].signum() / long;
        let [from, to] = [a, b].map(|p| [p[0] + out * along[1], p[1] - out * along[0]]);
        let share = (front - from[1]) / (to[1] - from[1]);
        (0.0..=1.0).contains(&share).then(|| from[0] + (to[0] - from[0]) * share)
    };
    [disc(a), disc(b), flank()].into_iter().flatten().reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec3;

    /// Two square tubes, 100 mm wide and 1 m high, with this gap, the second so far to the front, joined at 1.1 m.
    fn tubes(gap: f64, front: f64) -> TriMesh {
        let mut mesh = TriMesh::default();
        for [left, back] in [[0.0, 0.0], [0.1 + gap, front]] {
            let first = mesh.vertices.len() as u32;
            for y in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0] {
                let at = |x: f64, z: f64| Vec3::new(left + x, y, back + z);
                mesh.vertices.extend([at(0.0, 0.0), at(0.1, 0.0), at(0.1, 0.1), at(0.0, 0.1)]);
            }
            for (row, i) in (0..5).flat_map(|row| (0..4).map(move |i| (row, i))) {
                let [a, b] = [0, 1].map(|k| first + 4 * row + (i + k) % 4);
                mesh.triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
            }
        }
        let joint = mesh.vertices.len() as u32;
        mesh.vertices.extend([Vec3::new(0.1, 1.1, 0.0), Vec3::new(0.1, 1.1, 0.1)]);
        mesh.triangles.extend([[21, joint, joint + 1], [44, joint + 1, joint]]);
        mesh
    }

    fn opening_of(gap: f64, front: f64) -> Option<Vec<f64>> {
        let mesh = tubes(gap, front);
        let found = junctions(&mesh, &Topology::new(&mesh.triangles).edges, LIMB);
        let right = found[0].side[24] == JunctionSide::Limb;
        opening(&mesh, &found[0], if right { 1.0 } else { -1.0 })
    }

    #[test]
    fn limbs_with_room_stay_and_others_open_from_their_fork() {
        assert!(opening_of(0.0041, 0.0).is_none() && opening_of(0.05, 0.0).is_none());
        // What lies in front has room without.
        assert!(opening_of(-0.05, 0.105).is_none());
        for gap in [0.001, -0.002] {
            let by = opening_of(gap, 0.0).expect("no room");
            assert!(by[0] == 0.0 && by.windows(2).all(|w| w[0] <= w[1]), "{by:?}");
            assert!(by[40..].iter().all(|by| (by - (GAP - gap)).abs() < 1e-12), "{by:?}");
        }
    }

    #[test]
    fn what_is_within_a_gap_of_a_line_is_a_disc_at_its_ends_and_a_band_between() {
        let upright = [[0.1, 0.0], [0.1, 0.2]];
        let near = |front: f64| reach(upright, front, 0.005).map(|x| (1e6 * x).round());
        assert_eq!((near(0.1), near(-0.003), near(0.204)), (Some(105_000.0), Some(104_000.0), Some(103_000.0)));
        assert_eq!((near(-0.006), near(0.206)), (None, None));
        // Of a slanting line the band is wider across.
        let slanting = [[0.2, 0.2], [0.0, 0.0]];
        let x = reach(slanting, 0.1, 0.005).expect("within");
        assert!((x - 0.1 - 0.005 * 2f64.sqrt()).abs() < 1e-12, "{x}");
    }

    #[test]
    fn the_missing_room_is_that_of_the_nearest_points_and_none_in_front() {
        let limb = [[[0.1, 0.0], [0.1, 0.1]]];
        let beside = |side: f64, front: f64| [[[side, front], [side, front + 0.1]]];
        let of = |side: f64, front: f64| missing(&limb, &beside(side, front), 0.004).map(|m| (1e6 * m).round());
        assert_eq!(of(0.099, 0.05), Some(3000.0));
        assert_eq!(of(0.09, 0.05), Some(-6000.0));
        // What reaches over the other's side parts from it as well.
        assert_eq!(of(0.103, 0.05), Some(7000.0));
        assert_eq!(of(0.099, 0.105), None);
    }
}
