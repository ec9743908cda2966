//! Few curves where a drawing has many points.

use crate::geometry::{Path, Vec2, smooth_curves};

/// A line of fewer vertices was drawn with these corners.
const FEWEST: usize = 12;
/// A line of more is a scan, and fitting curves to it takes too long.
const MOST: usize = 3_000;
/// Largest distances of a vertex from its curve that are tried, metres. The smallest one that also keeps the curve near
/// its chords counts.
const OFF: [f64; 3] = [4e-6, 2e-6, 1e-6];
/// Largest distance of a curve from its chords, metres. With the error of the chords themselves it stays within a
/// hundredth of a millimetre of the original.
const BETWEEN: f64 = 6e-6;
/// Least number of vertices per curve on average. With fewer the points stay.
const WORTH: usize = 8;

/// Turn of the line at a vertex above which a curve ends there, radians (2°).
const CORNER: f64 = 0.035;
/// Turn of the line at such a vertex, in turns at its neighbours.
const SHARPER: f64 = 3.0;
/// Ratio of the lengths of neighbouring chords above which a straight part begins.
const LONGER: f64 = 8.0;
/// Length of a chord at an inflection, in mean chords of its stretch.
const INFLECTION: f64 = 3.0;
/// Largest number of such chords in one stretch.
const SPLITS: usize = 4;

/// A polyline as the smooth curves and the straight lines it was sampled from, as far as it looks like them. Any other
/// path as it is.
pub(super) fn smoothed(path: &Path) -> Path {
    let Some(points) = vertices(path) else { return path.clone() };
    let chord = Path::line(path.start(), path.end());
    if points.len() > 2 && points.iter().all(|p| chord.nearest(*p).1 <= OFF[0]) {
        return chord;
    }
    if !(FEWEST..=MOST).contains(&points.len()) {
        return path.clone();
    }
    let mut breaks = vec![0];
    breaks.extend((1..points.len() - 1).filter(|&k| is_break(&points, k)));
    breaks.push(points.len() - 1);
    let stretches = breaks.windows(2).map(|ends| curved(&points[ends[0]..=ends[1]], SPLITS));
    stretches.reduce(|before, next| before.joined(&next)).unwrap_or_else(|| path.clone())
}

/// Points of a polyline between two of its corners, as few curves or unchanged. Where an inflection leaves a long chord
/// among short ones, its direction is uncertain. This chord stays, and both sides of it are fitted by themselves,
/// `splits` times at most.
fn curved(points: &[Vec2], splits: usize) -> Path {
    let path = Path::polyline(points);
    if points.len() < FEWEST {
        return path;
    }
    let fitted = OFF.iter().map(|off| smooth_curves(points, *off)).take_while(|c| c.len() * WORTH <= points.len());
    let near = |curve: &Path| curve.sampled(BETWEEN / 10.0).iter().all(|p| path.nearest(*p).1 <= BETWEEN);
    if let Some(curve) = fitted.map(|curves| Path::cubics(&curves)).find(near) {
        return curve;
    }
    let chord = |k: &usize| (points[k + 1] - points[*k]).norm();
    let longest = (0..points.len() - 1).max_by(|a, b| chord(a).total_cmp(&chord(b)));
    match longest.filter(|k| splits > 0 && chord(k) * (points.len() - 1) as f64 > INFLECTION * path.length()) {
        None => path,
        Some(k) => {
            let side = |points: &[Vec2]| (points.len() > 1).then(|| curved(points, splits - 1));
            let [before, after] = [side(&points[..=k]), side(&points[k + 1..])];
            let parts = [before, Some(Path::line(points[k], points[k + 1])), after];
            parts.into_iter().flatten().reduce(|before, next| before.joined(&next)).unwrap_or(path)
        }
    }
}

/// Whether the line that a polyline was sampled from has a corner at vertex `k`, or a straight part that ends there.
fn is_break(points: &[Vec2], k: usize) -> bool {
    let turn = |k: usize| match points.get(k.wrapping_sub(1)..=k + 1) {
        Some([before, at, after]) => (at - before).angle(&(after - at)),
        _ => 0.0,
    };
    let [one, other] = [points[k] - points[k - 1], points[k + 1] - points[k]].map(|chord| chord.norm());
    one.max(other) > LONGER * one.min(other) || turn(k) > CORNER.max(SHARPER * turn(k - 1).max(turn(k + 1)))
}

/// The vertices of a path of straight lines only.
fn vertices(path: &Path) -> Option<Vec<Vec2>> {
    let ends = path.beziers().map(|(_, handles, to)| handles.is_none().then_some(to));
    std::iter::once(Some(path.start())).chain(ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sampled_curve_becomes_few_curves_and_a_polygon_stays() {
        let curve = Path::parse_absolute("M 0 0 C 60 0 60 80 160 100 C 210 110 220 160 300 170", 1e-3).expect("a path");
        let points = curve.sampled(2e-6);
        let again = smoothed(&Path::polyline(&points));
        assert!(points.len() > 100 && again.joints().len() <= 8, "{} {}", points.len(), again.joints().len());
        let off = points.iter().map(|p| again.nearest(*p).1).fold(0.0, f64::max);
        assert!(off <= BETWEEN, "{off}");
        assert!((again.length() - curve.length()).abs() < 1e-5);
        let zigzag: Vec<Vec2> = (0..40).map(|k| Vec2::new(0.01 * f64::from(k), 0.01 * f64::from(k % 2))).collect();
        assert_eq!(smoothed(&Path::polyline(&zigzag)).joints().len(), 40);
        // An S sampled as it bends, with a chord of 24 mm where it does not.
        let bends = Path::parse_absolute("M 10 600 C 5 520 0 460 0 400 C 0 340 0 300 5 240 C 10 180 45 100 50 0", 1e-3);
        let wave = bends.expect("a path").sampled(2e-6);
        let again = smoothed(&Path::polyline(&wave));
        assert!(again.joints().len() * 4 < wave.len(), "{} of {}", again.joints().len(), wave.len());
        // A straight side goes on from the curve, with a corner of four degrees. So do two curves.
        let end = curve.end();
        let side = Path::polyline(&[end, end + Vec2::new(0.2, 0.04)]);
        let turned = curve.sampled(2e-6).into_iter().rev().map(|p| end + (end - p).yx());
        for next in [side, Path::polyline(&turned.collect::<Vec<Vec2>>())] {
            let both = Path::polyline(&points).joined(&next);
            let again = smoothed(&both);
            assert!(again.joints().len() <= 16, "{}", again.joints().len());
            let off = both.joints().iter().map(|at| again.nearest(both.point(*at)).1).fold(0.0, f64::max);
            assert!(off <= BETWEEN, "{off}");
        }
        // A corner of a tenth of a millimetre on a side of 300 mm, which is not longer for it.
        let bent = [Vec2::zeros(), Vec2::new(0.15, 1e-4), Vec2::new(0.3, 0.0)];
        assert_eq!(smoothed(&Path::polyline(&bent)).joints().len(), 3);
        let straight: Vec<Vec2> = (0..40).map(|k| Vec2::new(0.01 * f64::from(k), 0.02 * f64::from(k))).collect();
        assert_eq!(smoothed(&Path::polyline(&straight)).joints().len(), 2);
    }
}
