//! Few curves where a drawing has many points.

use crate::geometry::{Path, Vec2, smooth_curves};

/// A line of fewer vertices was drawn with these corners.
const FEWEST: usize = 12;
/// A line of more is a scan, and fitting curves to it takes too long.
const MOST: usize = 3_000;
/// How far a vertex may be from its curve, metres; the less of these that keeps the curve near its chords, too.
const OFF: [f64; 3] = [4e-6, 2e-6, 1e-6];
/// How far a curve may be from the chords it stands for, metres: with what those had left of the original, still within
/// a hundredth of a millimetre.
const BETWEEN: f64 = 6e-6;
/// Vertices that one curve must stand for on average: otherwise the points say more than curves would.
const WORTH: usize = 8;

/// A polyline as the smooth curves it was sampled from, as far as it looks like one; any other path as it is. What is
/// straight is one line.
pub(super) fn smoothed(path: &Path) -> Path {
    let Some(points) = vertices(path) else { return path.clone() };
    if points.len() > 2 && path.is_straight() {
        return Path::line(path.start(), path.end());
    }
    if !(FEWEST..=MOST).contains(&points.len()) {
        return path.clone();
    }
    let fitted = OFF.iter().map(|off| smooth_curves(&points, *off)).take_while(|c| c.len() * WORTH <= points.len());
    let near = |curve: &Path| curve.sampled(BETWEEN / 10.0).iter().all(|p| path.nearest(*p).1 <= BETWEEN);
    fitted.map(|curves| Path::cubics(&curves)).find(near).unwrap_or_else(|| path.clone())
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
        let straight: Vec<Vec2> = (0..40).map(|k| Vec2::new(0.01 * f64::from(k), 0.02 * f64::from(k))).collect();
        assert_eq!(smoothed(&Path::polyline(&straight)).joints().len(), 2);
    }
}
