//! Notches that are drawn into an outline: the pen goes a few millimetres in or out and comes back the same way.

use crate::digitize::nearly_meet;
use crate::geometry::Vec2;

/// The flanks of a slit are no farther apart (metres).
const WIDTH: f64 = 1e-4;
/// A slit is at least as deep as this and at most as that (metres); what is deeper is a spike that nobody meant.
const DEPTH: (f64, f64) = (5e-4, 0.02);
/// No spike is longer (metres).
const SPIKE: f64 = 1.0;

/// Takes the last vertex away if it stands where the first does, as near as nobody draws: the line is closed then.
pub(super) fn closes(vertices: &mut Vec<(Vec2, f64)>) -> bool {
    let [Some(first), Some(last)] = [vertices.first(), vertices.last()] else { return false };
    let closed = vertices.len() > 3 && nearly_meet(first.0, last.0);
    if closed {
        vertices.pop();
    }
    closed
}

/// Takes slits and spikes out of a line, and gives the places where slits were.
pub(super) fn without_slits(vertices: &mut Vec<(Vec2, f64)>, closed: bool) -> Vec<Vec2> {
    let mut slits = Vec::new();
    let mut k = 0;
    while vertices.len() > 3 && k < vertices.len() {
        let count = vertices.len();
        let inside = closed || k > 0 && k + 1 < count;
        let [before, tip, next] = [(k + count - 1) % count, k, (k + 1) % count].map(|i| vertices[i]);
        let base = (before.0 + next.0) / 2.0;
        let depth = (tip.0 - base).norm();
        let narrow = (before.0 - next.0).norm() <= WIDTH && before.1 == 0.0 && tip.1 == 0.0;
        if !(inside && narrow && (DEPTH.0..=SPIKE).contains(&depth)) {
            k += 1;
            continue;
        }
        if depth <= DEPTH.1 {
            slits.push(base);
        }
        // The next one leads on from where both stood.
        vertices[(k + 1) % count].0 = base;
        let mut gone = [(k + count - 1) % count, k];
        gone.sort_unstable();
        vertices.remove(gone[1]);
        vertices.remove(gone[0]);
        k = k.saturating_sub(2);
    }
    slits
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertices(points: &[[f64; 2]]) -> Vec<(Vec2, f64)> {
        points.iter().map(|p| (Vec2::new(p[0], p[1]) * 1e-3, 0.0)).collect()
    }

    #[test]
    fn slits_are_taken_out_wherever_the_line_begins() {
        let mut ring = vertices(&[
            [0.0, 0.0],
            [220.0, 0.0],
            [220.0, 150.01],
            [214.0, 150.0],
            [220.0, 149.99],
            [220.0, 300.0],
            [0.0, 300.0],
        ]);
        for _ in 0..ring.len() {
            ring.rotate_left(1);
            let mut line = ring.clone();
            let slits = without_slits(&mut line, true);
            assert!(slits.len() == 1 && (slits[0] - Vec2::new(0.22, 0.15)).norm() < 1e-9, "{slits:?}");
            assert_eq!(line.len(), 5);
        }
        // A spike of 80 mm is no notch; a tooth of 2 mm and a castle stay.
        let mut spike = vertices(&[[0.0, 0.0], [100.0, 0.0], [180.0, 0.0], [100.0, 0.0], [100.0, 90.0]]);
        assert!(without_slits(&mut spike, true).is_empty());
        assert_eq!(spike.len(), 3);
        let mut tooth = vertices(&[[0.0, 0.0], [50.0, 0.0], [51.0, 6.0], [52.0, 0.0], [100.0, 0.0], [100.0, 90.0]]);
        assert!(without_slits(&mut tooth, true).is_empty());
        assert_eq!(tooth.len(), 6);
    }

    #[test]
    fn a_last_vertex_near_the_first_closes_the_line() {
        let mut ring = vertices(&[[0.0, 0.0], [160.0, 0.0], [160.0, 180.0], [0.0, 180.0], [0.0, -0.07]]);
        assert!(closes(&mut ring) && ring.len() == 4);
        let mut open = vertices(&[[0.0, 0.0], [160.0, 0.0], [160.0, 180.0], [0.0, 180.0], [0.0, 0.7]]);
        assert!(!closes(&mut open) && open.len() == 5);
    }
}
