//! Few smooth curves through many points.
//!
//! Cubic Bézier curves by least squares at chord-length parameters. The parameters are improved by Newton's method
//! (Schneider 1990, "An algorithm for automatically fitting digitized curves", Graphics Gems), then by distances from
//! the tangents at those parameters, which converges to the sampled curve instead of creeping there (Blake & Isard
//! 1998, Active Contours). Each curve is as long as the tolerance allows, and starts in the direction in which the one
//! before ends.

use std::cmp::Ordering;

use nalgebra::{DMatrix, DVector, Matrix2};

use super::{Vec2, shares_along};

/// A cubic Bézier curve: its ends and, between them, its two handles.
pub type Cubic = [Vec2; 4];

/// Rounds of improving the parameters: all of them, and how many of these use distances from points.
const ROUNDS: (usize, usize) = (8, 2);
/// Weight of the distance along the tangent in the other rounds. It only keeps the equations solvable.
const ALONG: f64 = 1e-3;
/// Longest handle as a share of the points' length: that of three quarters of a circle. (A straight curve at constant
/// speed has one third.) With longer handles a curve through few points runs back and forth.
const LONGEST_HANDLE: f64 = 2.0 / 3.0;
/// Number of points below which both end directions of a curve are prescribed. A free curve through few points hooks
/// aside at its ends.
const FREE: usize = 7;
/// A free end whose handle is further aside from the points than this cosine (60°) hooks. It gets the direction of
/// the points.
const ASIDE: f64 = 0.5;
/// Points on each side of a joint from which its direction is estimated.
const REACH: usize = 4;

/// Cubic curves end to end through `points` that none of them is further from than `tolerance`. The first begins at the
/// first point, the last ends at the last. Where two meet the direction is one and the same. None for fewer than two
/// points.
pub fn smooth_curves(points: &[Vec2], tolerance: f64) -> Vec<Cubic> {
    let mut curves: Vec<Cubic> = Vec::new();
    let last = points.len().saturating_sub(1);
    let mut from = 0;
    while from < last {
        let fitted = |to: usize| {
            let few = to - from + 1 < FREE;
            let ends = [direction(points, from), direction(points, to)];
            let with = |bound: [bool; 2]| {
                let [start, end] = [0, 1].map(|side| bound[side].then_some(ends[side]));
                fit(&points[from..=to], start, end)
            };
            let free = with([few || from > 0, few || to < last]).filter(|(curve, _)| !hooks(curve, ends));
            free.or_else(|| with([true; 2])).filter(|(_, off)| *off <= tolerance)
        };
        // The longest stretch that is near enough: more of the same length each time, then halving.
        // Two points always are.
        let (mut good, mut bad) = (from + 1, last + 1);
        let mut best = fitted(good);
        let mut stride = last - from;
        while stride > 0 {
            let to = good + stride;
            match (to < bad).then(|| fitted(to)).flatten() {
                Some(found) => (good, best) = (to, Some(found)),
                None => {
                    bad = bad.min(to);
                    stride /= 2;
                }
            }
        }
        let straight = || [points[from], points[from], points[good], points[good]];
        curves.push(best.map_or_else(straight, |(curve, _)| curve));
        from = good;
    }
    curves
}

/// Whether a curve leaves its first point or reaches its last far aside from these directions of the points.
fn hooks(curve: &Cubic, ends: [Vec2; 2]) -> bool {
    let handles = [curve[1] - curve[0], curve[3] - curve[2]];
    handles.iter().zip(ends).any(|(handle, end)| handle.dot(&end) < ASIDE * handle.norm())
}

/// Direction of the points at point `k`: that of the parabola through three of them.
fn direction(points: &[Vec2], k: usize) -> Vec2 {
    let last = points.len() - 1;
    let reach = REACH.min(k).min(last - k).max(1);
    // At an end, the three are the first or the last ones. Two points have a direction, too.
    let middle = k.max(reach).min(last.saturating_sub(reach));
    let (before, after) = (points[middle.saturating_sub(reach)], points[(middle + reach).min(last)]);
    let [back, on] = [points[middle] - before, after - points[middle]];
    let [b, c] = [back.norm(), on.norm()];
    let way = match k.cmp(&middle) {
        _ if b == 0.0 || c == 0.0 => after - before,
        Ordering::Less => back * ((2.0 * b + c) / b) - on * (b / c),
        Ordering::Equal => back * (c / b) + on * (b / c),
        Ordering::Greater => on * ((2.0 * c + b) / c) - back * (c / b),
    };
    way.try_normalize(0.0).unwrap_or_else(Vec2::zeros)
}

/// The best curve between the first and the last point, and the largest distance of a point from it. `start` and `end`
/// are prescribed directions.
fn fit(points: &[Vec2], start: Option<Vec2>, end: Option<Vec2>) -> Option<(Cubic, f64)> {
    let (first, last) = (points[0], points[points.len() - 1]);
    let mut at = shares_along(points.iter().copied())?;
    let mut best: Option<(Cubic, f64)> = None;
    let mut before: Option<Cubic> = None;
    for round in 0..ROUNDS.0 {
        let near = before.filter(|_| round >= ROUNDS.1);
        let weight = |t: f64| near.map_or_else(Matrix2::identity, |curve| across(&curve, t));
        let curve = least_squares(points, &at, &weight, [first, last], [start, end])?;
        before = Some(curve);
        for (p, t) in points.iter().zip(&mut at) {
            *t = nearer(&curve, *p, *t);
        }
        let off = points.iter().zip(&at).map(|(p, &t)| (point(&curve, t) - p).norm()).fold(0.0, f64::max);
        if best.is_none_or(|(_, least)| off < least) {
            best = Some((curve, off));
        }
    }
    best
}

/// Length along the points.
fn walked(points: &[Vec2]) -> f64 {
    points.windows(2).map(|step| (step[1] - step[0]).norm()).sum()
}

/// Bernstein's polynomials of the third degree.
fn shares(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

fn point(curve: &Cubic, t: f64) -> Vec2 {
    curve.iter().zip(shares(t)).map(|(p, share)| p * share).sum()
}

/// Weights of a distance from a curve: all of its transverse part, little of its tangential part.
fn across(curve: &Cubic, t: f64) -> Matrix2<f64> {
    let s = 1.0 - t;
    let [a, b, c] = [curve[1] - curve[0], curve[2] - curve[1], curve[3] - curve[2]];
    let slope = a * (s * s) + b * (2.0 * s * t) + c * (t * t);
    let tangent = slope.try_normalize(0.0).unwrap_or_else(Vec2::zeros);
    Matrix2::identity() - tangent * tangent.transpose() * (1.0 - ALONG)
}

/// One Newton step from `t` towards the parameter of the curve's point nearest to `p`.
fn nearer(curve: &Cubic, p: Vec2, t: f64) -> f64 {
    let s = 1.0 - t;
    let [a, b, c] = [curve[1] - curve[0], curve[2] - curve[1], curve[3] - curve[2]];
    let slope = (a * (s * s) + b * (2.0 * s * t) + c * (t * t)) * 3.0;
    let bend = ((b - a) * s + (c - b) * t) * 6.0;
    let off = point(curve, t) - p;
    let curvature = slope.norm_squared() + off.dot(&bend);
    if curvature > 0.0 { (t - off.dot(&slope) / curvature).clamp(0.0, 1.0) } else { t }
}

/// Handles that bring the curve nearest to the points at their parameters, distances weighted: anywhere,
/// or along a given direction.
fn least_squares(
    points: &[Vec2],
    at: &[f64],
    weight: &dyn Fn(f64) -> Matrix2<f64>,
    ends: [Vec2; 2],
    directions: [Option<Vec2>; 2],
) -> Option<Cubic> {
    // Motion of its end's handle per unit of each unknown.
    let mut moves: Vec<(usize, Vec2)> = Vec::new();
    for (side, direction) in directions.into_iter().enumerate() {
        match direction {
            Some(d) if side == 0 => moves.push((0, d)),
            Some(d) => moves.push((1, -d)),
            None => moves.extend([(side, Vec2::x()), (side, Vec2::y())]),
        }
    }
    let mut normal = DMatrix::<f64>::zeros(moves.len(), moves.len());
    let mut right = DVector::<f64>::zeros(moves.len());
    for (p, &t) in points.iter().zip(at) {
        let (share, weight) = (shares(t), weight(t));
        let off = weight * (p - ends[0] * (share[0] + share[1]) - ends[1] * (share[2] + share[3]));
        for (i, (side, d)) in moves.iter().enumerate() {
            right[i] += share[1 + side] * d.dot(&off);
            for (j, (other, e)) in moves.iter().enumerate() {
                normal[(i, j)] += share[1 + side] * share[1 + other] * d.dot(&(weight * e));
            }
        }
    }
    // With few points there are many best curves: of these the one with the shortest handles.
    let little = 1e-9 * normal.trace();
    (0..moves.len()).for_each(|i| normal[(i, i)] += little);
    let solution = normal.cholesky()?.solve(&right);
    let mut handles = [Vec2::zeros(); 2];
    for ((side, d), length) in moves.iter().zip(solution.iter()) {
        // A handle that points backwards would make a loop.
        let forward = if directions[*side].is_some() { length.max(0.0) } else { *length };
        handles[*side] += d * forward;
    }
    let longest = LONGEST_HANDLE * walked(points);
    let [out, back] = handles.map(|handle| handle.cap_magnitude(longest));
    Some([ends[0], ends[0] + out, ends[1] + back, ends[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn farthest(points: &[Vec2], curves: &[Cubic]) -> f64 {
        let dense: Vec<Vec2> =
            curves.iter().flat_map(|c| (0..=20_000).map(|k| point(c, f64::from(k) / 20_000.0))).collect();
        let off = |p: &Vec2| dense.iter().map(|q| (p - q).norm()).fold(f64::INFINITY, f64::min);
        points.iter().map(off).fold(0.0, f64::max)
    }

    #[test]
    fn a_circle_is_a_few_curves_and_a_line_is_one() {
        let circle: Vec<Vec2> = (0..=300)
            .map(|k| f64::from(k) * std::f64::consts::TAU / 300.0)
            .map(|a| Vec2::new(a.cos(), a.sin()))
            .collect();
        let curves = smooth_curves(&circle, 1e-3);
        assert!(curves.len() <= 5, "{}", curves.len());
        assert!(farthest(&circle, &curves) < 1.1e-3);
        for pair in curves.windows(2) {
            assert_eq!(pair[0][3], pair[1][0]);
            let (a, b) = ((pair[0][3] - pair[0][2]).normalize(), (pair[1][1] - pair[1][0]).normalize());
            assert!(a.dot(&b) > 1.0 - 1e-9, "{a} {b}");
        }
        let line: Vec<Vec2> = (0..50).map(|k| Vec2::new(f64::from(k), 2.0 * f64::from(k))).collect();
        assert_eq!(smooth_curves(&line, 1e-6).len(), 1);
    }

    /// The top of a bodice beside a dart: noise of a tenth of a millimetre at its first points drew the handle back
    /// over the dart.
    #[test]
    fn a_curve_never_leaves_its_first_point_backwards() {
        let height = |k: i32| if k % 2 == 0 { 0.1 } else { -0.1 } * f64::from(3 - k.min(3));
        let points: Vec<Vec2> = (0..30).map(|k| Vec2::new(0.6 * f64::from(k * k) / 4.0, height(k))).collect();
        for tolerance in [0.05, 0.1, 0.2, 0.4] {
            for curve in smooth_curves(&points, tolerance) {
                assert!(curve[1].x >= curve[0].x && curve[2].x <= curve[3].x, "{tolerance}: {curve:?}");
            }
        }
    }

    #[test]
    fn noise_within_the_tolerance_costs_no_curve_and_what_has_no_length_none() {
        let wave = |k: u32| {
            let x = f64::from(k) / 100.0;
            Vec2::new(x, 0.2 * x * x + 1e-4 * f64::from(k * 7919 % 101) / 101.0)
        };
        let points: Vec<Vec2> = (0..=100).map(wave).collect();
        let curves = smooth_curves(&points, 2e-4);
        assert_eq!(curves.len(), 1);
        assert!(farthest(&points, &curves) < 2.1e-4);
        assert!(smooth_curves(&[], 1.0).is_empty() && smooth_curves(&[Vec2::zeros()], 1.0).is_empty());
        assert_eq!(smooth_curves(&[Vec2::zeros(); 3], 1.0).len(), 2);
    }

    /// Hems of a coarse mesh: a few points nearly in a line, and directions that other points give.
    #[test]
    fn no_curve_runs_back_and_forth_through_few_points() {
        let long = |points: &[Vec2]| points.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>();
        for seed in 0..60_u32 {
            let noise = |k: u32, salt: u32| f64::from((k + 1) * (seed * 2 + salt) * 7919 % 1013) / 1013.0 - 0.5;
            let point_of = |k: u32| Vec2::new(25.0 * f64::from(k) + 6.0 * noise(k, 3), 0.8 * noise(k, 5));
            let points: Vec<Vec2> = (0..22).map(point_of).collect();
            let curves = smooth_curves(&points, 0.1);
            let dense: Vec<Vec2> =
                curves.iter().flat_map(|c| (0..=50).map(|k| point(c, f64::from(k) / 50.0))).collect();
            assert!(long(&dense) < 1.01 * long(&points), "seed {seed}: {} {curves:?}", long(&dense));
        }
    }

    /// Shoulder, half a neckline and an armhole of a dress in cells of 25 mm: no edge may reach over its neighbours.
    #[test]
    fn a_curve_through_few_points_begins_and_ends_as_they_do() {
        let shoulder = [[843.48, 22.24], [872.21, 21.07], [897.99, 10.0]];
        let neck = [[897.99, 10.0], [918.16, 18.8], [938.42, 27.36], [958.57, 36.2], [979.01, 44.3]];
        let armhole =
            [[979.01, 44.3], [970.89, 69.19], [969.19, 95.33], [968.88, 121.54], [975.1, 146.88], [991.02, 167.37]];
        for edge in [&shoulder[..], &neck, &armhole, &shoulder[..2]] {
            let points: Vec<Vec2> = edge.iter().map(|&p| Vec2::from(p)).collect();
            let curves = smooth_curves(&points, 0.1);
            let ends = [
                (curves[0], points[1] - points[0]),
                (curves[curves.len() - 1], points[points.len() - 1] - points[points.len() - 2]),
            ];
            for (k, (curve, step)) in ends.into_iter().enumerate() {
                let handle = curve[2 * k + 1] - curve[2 * k];
                // A straight one has none.
                let aside = if handle.norm() > 0.0 { handle.angle(&step) } else { 0.0 };
                assert!(aside < 0.5, "{aside} {curves:?}");
            }
        }
    }
}
