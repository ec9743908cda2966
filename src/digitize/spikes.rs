//! Spikes of no width in an outline: the pen goes somewhere and comes back the same way.

use crate::geometry::{Path, Vec2};

/// The sides of a spike are no farther apart (metres).
const WIDTH: f64 = 1e-4;
/// A spike no longer than this (metres) is a slit: a notch.
const SLIT: f64 = 0.02;
/// Shorter ones (metres) are nothing.
const SHORTEST: f64 = 5e-4;

/// A closed outline without its spikes.
pub(super) struct Smooth {
    pub(super) path: Path,
    /// Places of slits.
    pub(super) slits: Vec<Vec2>,
    /// Number of longer spikes.
    pub(super) spikes: usize,
}

/// Takes the spikes out of a closed outline that do not lie across its start.
pub(super) fn without_spikes(outline: &Path) -> Smooth {
    let mut smooth = Smooth { path: outline.clone(), slits: Vec::new(), spikes: 0 };
    while let Some((from, to)) = spike(&smooth.path) {
        let path = &smooth.path;
        if (to - from) / 2.0 <= SLIT {
            smooth.slits.push(path.point(from));
        } else {
            smooth.spikes += 1;
        }
        smooth.path = path.part(0.0, from).joined(&path.part(to, path.length()));
    }
    smooth
}

/// Start and end of the first spike, as lengths along the path.
fn spike(path: &Path) -> Option<(f64, f64)> {
    let joints = path.joints();
    let straight: Vec<Option<[Vec2; 2]>> =
        path.beziers().map(|(from, controls, to)| controls.is_none().then_some([from, to])).collect();
    // Both ends of the path stay: what is left is never empty.
    (1..straight.len().saturating_sub(2)).find_map(|k| {
        let ([from, tip], [back, to]) = (straight[k]?, straight[k + 1]?);
        let length = (tip - from).norm();
        let is_spike = (from - to).norm() <= WIDTH && (tip - back).norm() <= WIDTH && length >= SHORTEST;
        is_spike.then(|| (joints[k], joints[k + 2]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spikes_are_taken_out() {
        let ring = |text: &str| without_spikes(&Path::parse_absolute(text, 1e-3).expect("a path"));
        let smooth = ring("M 0 0 H 100 V 50 H 92 H 100 V 120 H 60 V 200 V 120 H 0 Z");
        assert_eq!((smooth.slits.as_slice(), smooth.spikes), (&[Vec2::new(0.1, 0.05)][..], 1));
        assert!((smooth.path.double_area() / 2.0 - 0.012).abs() < 1e-12 && smooth.path.length() < 0.4401);
        let none = ring("M 0 0 H 100 V 50 L 92 51 L 100 52 V 120 H 0 Z");
        assert!(none.slits.is_empty() && none.spikes == 0);
    }
}
