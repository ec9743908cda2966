//! The junction of two allowances at a corner.
//!
//! A corner consists of two polylines: `x`, the cut line that comes to it, and `y`, the one that leaves it. Each is at
//! the width of its allowance from its sewing line. The end of a *folded* or *squared* allowance is defined from the
//! neighbour's side: the neighbour's cut line extends to the sewing line of that edge, and from there straight out, or
//! mirrored in that sewing line, to its cut line.

use std::f64::consts::FRAC_PI_2;

use super::run::SmoothRun;
use crate::geometry::{Vec2, mirrored};
use crate::pattern::Corner;

/// A mitre may be this many times as long as the wider allowance. Past it (corners of less than 39 degrees) its point
/// is cut off.
pub(super) const MITRE_LIMIT: f64 = 3.0;
/// Edges that turn less than this (radians) go on as one.
const STRAIGHT: f64 = 1e-4;
/// And folded or squared ends want a turn of at least this (radians, 20 degrees):
/// along a smooth course there is no end.
const LEAST_TURN: f64 = 0.35;
/// A free edge that is farther from square to its neighbour than this (radians, 40 degrees) is no hem unless the file
/// says so: its folded end would be a wing longer than the allowance is wide.
const OBLIQUE: f64 = 0.7;
/// Nearer than this (metres) is the same.
const SAME: f64 = 1e-9;

/// A place on a polyline: how many points from its start, with a fraction. Before and past its ends, too.
pub(super) type At = (f64, Vec2);

/// Transition of a contour from one run to the next.
#[derive(Clone, Debug)]
pub(super) struct Join {
    /// Place where it leaves the first run.
    pub(super) leave: At,
    pub(super) between: Vec<Vec2>,
    /// Place where it enters the second.
    pub(super) enter: At,
}

/// Wanted ending of an edge's allowance at a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CornerWish {
    pub(super) corner: Corner,
    /// Whether the file says so, rather than that being usual.
    pub(super) said: bool,
}

impl CornerWish {
    /// The default between sewn edges.
    pub(super) const MITRED: Self = Self { corner: Corner::Mitred, said: false };
}

/// Joins two runs as their edges wish. Of two wishes that differ the mitre gives way, then the narrower allowance. Of
/// two equal ones the one that is said counts, and else they make a mitre. `lines` are the cut lines away from the
/// corner, beyond the runs where these are short.
pub(super) fn join(a: &SmoothRun, b: &SmoothRun, wishes: [CornerWish; 2], lines: [&[Vec2]; 2]) -> Join {
    let is_oblique = (turn(a, b) - FRAC_PI_2).abs() > OBLIQUE;
    let by_itself = |wish: CornerWish| wish.corner == Corner::Folded && !wish.said && is_oblique;
    let wishes = wishes.map(|wish| if by_itself(wish) { CornerWish::MITRED } else { wish });
    let special = match wishes.map(|wish| wish.corner) {
        [Corner::Mitred, Corner::Mitred] => None,
        [one, other] if one == other => match wishes.map(|wish| wish.said) {
            [true, false] => Some((one, true)),
            [false, true] => Some((other, false)),
            _ => None,
        },
        [Corner::Mitred, other] => Some((other, false)),
        [one, Corner::Mitred] => Some((one, true)),
        [one, other] => Some(if a.width > b.width { (one, true) } else { (other, false) }),
    };
    special.and_then(|(kind, of_first)| ended(a, b, kind, of_first, lines)).unwrap_or_else(|| mitred(a, b))
}

/// Two smooth runs of one edge, or of edges that are no further looked at.
pub(super) fn join_plainly(a: &SmoothRun, b: &SmoothRun) -> Join {
    mitred(a, b)
}

/// A run as seen from its corner.
struct CornerArm {
    /// Its cut line, the corner's end first.
    line: Vec<Vec2>,
    /// Away from the corner along the sewing line.
    along: Vec2,
    /// Away from the cloth.
    out: Vec2,
    width: f64,
}

impl CornerArm {
    fn before(run: &SmoothRun) -> Self {
        let t = run.ends[1];
        let line = run.moved.iter().rev().copied().collect();
        Self { line, along: -t, out: Vec2::new(t.y, -t.x), width: run.width }
    }

    fn after(run: &SmoothRun) -> Self {
        let t = run.ends[0];
        Self { line: run.moved.clone(), along: t, out: Vec2::new(t.y, -t.x), width: run.width }
    }

    /// Its cut line, begun earlier by `reach`.
    fn extended(&self, reach: f64) -> Vec<Vec2> {
        [&[self.line[0] - self.along * reach], self.line.as_slice()].concat()
    }
}

fn corner_of(a: &SmoothRun) -> Vec2 {
    a.base[a.base.len() - 1]
}

fn turn(a: &SmoothRun, b: &SmoothRun) -> f64 {
    let (t, u) = (a.ends[1], b.ends[0]);
    t.perp(&u).atan2(t.dot(&u))
}

/// From the two arms' places back to those of the runs. Places on an arm count from the corner, its extension first.
fn joined(a: &SmoothRun, on_a: At, between: Vec<Vec2>, on_b: At) -> Join {
    let last = (a.moved.len() - 1) as f64;
    Join { leave: (last - (on_a.0 - 1.0), on_a.1), between, enter: (on_b.0 - 1.0, on_b.1) }
}

/// Straight from the end of one run to the start of the next, over `between`.
fn plain(a: &SmoothRun, b: &SmoothRun, between: Vec<Vec2>) -> Join {
    let last = a.moved.len() - 1;
    Join { leave: (last as f64, a.moved[last]), between, enter: (0.0, b.moved[0]) }
}

fn mitred(a: &SmoothRun, b: &SmoothRun) -> Join {
    let (end, start) = (a.moved[a.moved.len() - 1], b.moved[0]);
    if (end - start).norm() < SAME {
        return plain(a, b, Vec::new());
    }
    let turn = turn(a, b);
    if turn < 0.0 {
        // By way of the corner: there an allowance ends straight that the other does not take up.
        return bent_in(a, b, turn).unwrap_or_else(|| plain(a, b, vec![corner_of(a)]));
    }
    if let Some(join) = pointed(a, b, turn) {
        return join;
    }
    if turn < FRAC_PI_2 {
        // No long point, but a step: from one width to a much smaller one.
        return plain(a, b, Vec::new());
    }
    let wide = a.width.max(b.width);
    // The point of a long mitre is cut off.
    let past = |width: f64| ((MITRE_LIMIT * wide).powi(2) - width.powi(2)).sqrt();
    plain(a, b, vec![end + a.ends[1] * past(a.width), start - b.ends[0] * past(b.width)])
}

/// Crossing of the cut lines at a corner that bends out, if it is near enough.
fn pointed(a: &SmoothRun, b: &SmoothRun, turn: f64) -> Option<Join> {
    if turn < STRAIGHT {
        return None;
    }
    let wide = a.width.max(b.width);
    let [x, y] = [CornerArm::before(a), CornerArm::after(b)].map(|arm| arm.extended(MITRE_LIMIT * wide));
    let (on_a, on_b) = meeting(&x, &y, corner_of(a), Sense::Closing)?;
    // A step of the width along a nearly straight course is not spread over more than the width.
    let short = (on_a.1 - corner_of(a)).norm() <= MITRE_LIMIT * wide;
    let spread = cut_away(&x, on_a).max(cut_away(&y, on_b));
    (short && spread <= wide).then(|| joined(a, on_a, Vec::new(), on_b))
}

/// Crossing of the cut lines at a corner that bends in. There two allowances overlap, and the part that each line gives
/// up is inside the other. A line that stands clear of the other's allowance at the corner continues until it meets
/// that. The other one begins inside the allowance and is not prolonged, because that would cut into the wider
/// allowance.
fn bent_in(a: &SmoothRun, b: &SmoothRun, turn: f64) -> Option<Join> {
    if turn > -STRAIGHT {
        return None;
    }
    let reach = MITRE_LIMIT * a.width.max(b.width);
    let clear = |one: &SmoothRun, other: &SmoothRun| one.width * turn.cos() > other.width;
    let [first_clear, second_clear] = [clear(a, b), clear(b, a)];
    let x = CornerArm::before(a).extended(if first_clear { reach } else { 0.0 });
    let y = CornerArm::after(b).extended(if second_clear { reach } else { 0.0 });
    let (on_a, on_b) = meeting(&x, &y, corner_of(a), Sense::Parting)?;
    let prolonged = first_clear || second_clear;
    let near = !prolonged || (on_a.1 - corner_of(a)).norm() <= reach;
    near.then(|| joined(a, on_a, Vec::new(), on_b))
}

/// The special edge, the second or (`of_first`) the first, ends squared or folded. `None` where it cannot.
fn ended(a: &SmoothRun, b: &SmoothRun, kind: Corner, of_first: bool, lines: [&[Vec2]; 2]) -> Option<Join> {
    if turn(a, b) < LEAST_TURN {
        return None;
    }
    let (mut before, mut after) = (CornerArm::before(a), CornerArm::after(b));
    // Turned up, a deep hem lies beside more of the neighbours than the next edge.
    let other = if of_first { &mut after } else { &mut before };
    other.line = lines[usize::from(of_first)].to_vec();
    let (x, y) = if of_first { (&after, &before) } else { (&before, &after) };
    let corner = corner_of(a);
    let reach = MITRE_LIMIT * x.width.max(y.width);
    let own = x.extended(reach);
    let (on_x, _) = first_crossing(&own, &[corner + y.along * SAME, corner - y.along * reach])?;
    // The contour leaves the neighbour on its own run.
    let run = if of_first { b } else { a };
    if on_x.0 > run.moved.len() as f64 {
        return None;
    }
    // The end of a narrow allowance is no reason to take much from a wide one: the flatter the corner, the more.
    if cut_away(&own, on_x) > MITRE_LIMIT * y.width {
        return None;
    }
    let ray = match kind {
        Corner::Squared => vec![on_x.1, on_x.1 + y.out * (2.0 * y.width)],
        Corner::Folded => {
            let back = std::iter::once(on_x.1).chain(rest(&own, on_x.0));
            back.map(|p| mirrored(p, corner, y.along)).collect()
        }
        Corner::Mitred => return None,
    };
    let far = y.extended(reach);
    let (on_ray, on_y) = first_crossing(&ray, &far)?;
    let mut between = vec![on_x.1];
    between.extend(ray.iter().enumerate().filter(|&(k, _)| k > 0 && (k as f64) < on_ray.0).map(|(_, p)| *p));
    // As far from the corner as a mitre may go, and no farther.
    if between.iter().chain([&on_y.1]).any(|p| (p - corner).norm() > MITRE_LIMIT * x.width.max(y.width)) {
        return None;
    }
    Some(if of_first {
        between.reverse();
        joined(a, on_y, between, on_x)
    } else {
        joined(a, on_x, between, on_y)
    })
}

/// Over the mouth of a dart between `a` and `b`, so that the allowance meets when the dart is sewn and pressed onto
/// one of them: over the half of the intake next to that edge its cut line mirrored in the leg, over the other half
/// the same mirrored in the dart's axis. Straight across where that gives nothing.
pub(super) fn cap(a: &SmoothRun, b: &SmoothRun, tip: Vec2, onto_first: bool) -> Join {
    let (before, after) = (CornerArm::before(a), CornerArm::after(b));
    let (first, second) = if onto_first { (&before, &after) } else { (&after, &before) };
    let mouths = [corner_of(a), b.base[0]];
    let (near, far) = if onto_first { (mouths[0], mouths[1]) } else { (mouths[1], mouths[0]) };
    let reach = MITRE_LIMIT * a.width.max(b.width) + (far - near).norm();
    let Some((on_first, on_second, between)) = folded_cap(first, second, [near, far], tip, reach) else {
        return plain(a, b, Vec::new());
    };
    if onto_first {
        joined(a, on_first, between, on_second)
    } else {
        joined(a, on_second, between.into_iter().rev().collect(), on_first)
    }
}

fn folded_cap(
    x: &CornerArm,
    y: &CornerArm,
    [near, far]: [Vec2; 2],
    tip: Vec2,
    reach: f64,
) -> Option<(At, At, Vec<Vec2>)> {
    let middle = (near + far) / 2.0;
    let axis = (middle - tip).try_normalize(SAME)?;
    let [one, other] = [near, far].map(|mouth| (mouth - tip).try_normalize(SAME));
    let (one, other) = (one?, other?);
    let (own, far_line) = (x.extended(reach), y.extended(reach));
    // Without allowance the line ends on the leg already.
    let on_leg = |line: &[Vec2], arm: &CornerArm, mouth: Vec2, leg: Vec2| {
        if arm.width < SAME {
            return Some((1.0, arm.line[0]));
        }
        first_crossing(line, &[mouth - leg * arm.width, mouth + leg * reach]).map(|c| c.0)
    };
    let on_x = on_leg(&own, x, near, one)?;
    let on_y = on_leg(&far_line, y, far, other)?;
    let folded: Vec<Vec2> = std::iter::once(on_x.1).chain(rest(&own, on_x.0)).map(|p| mirrored(p, near, one)).collect();
    let (at_axis, _) = first_crossing(&folded, &[middle - axis * reach, middle + axis * reach])?;
    let mut half = vec![on_x.1];
    half.extend(folded.iter().enumerate().filter(|&(k, _)| k > 0 && (k as f64) < at_axis.0).map(|(_, p)| *p));
    let back: Vec<Vec2> = half.iter().rev().map(|&p| mirrored(p, middle, axis)).collect();
    half.push(at_axis.1);
    half.extend(back);
    Some((on_x, on_y, half))
}

/// The points of a polyline after a place on it.
fn rest(line: &[Vec2], at: f64) -> impl Iterator<Item = Vec2> + '_ {
    line.iter().enumerate().filter(move |&(k, _)| k as f64 > at).map(|(_, p)| *p)
}

/// Sense in which two lines, walked away from a corner, cross.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sense {
    /// As the prolongations of two lines before a corner that bends out, which end there.
    Closing,
    /// As two lines that begin within each other's allowance and leave it.
    Parting,
}

/// The crossing of two lines that is nearest to their corner: lines that bend may cross again farther off. A crossing
/// of the wrong sense means that the lines have bent back, and is no join.
fn meeting(x: &[Vec2], y: &[Vec2], corner: Vec2, sense: Sense) -> Option<(At, At)> {
    let off = |c: &(At, At)| (c.0.1 - corner).norm();
    let nearest = crossings(x, y).min_by(|one, other| off(one).total_cmp(&off(other)))?;
    let turn = direction(x, nearest.0.0).perp(&direction(y, nearest.1.0));
    let found = if turn > 0.0 { Sense::Parting } else { Sense::Closing };
    (found == sense).then_some(nearest)
}

/// All places at which two polylines cross.
fn crossings<'a>(p: &'a [Vec2], q: &'a [Vec2]) -> impl Iterator<Item = (At, At)> + 'a {
    p.windows(2).enumerate().flat_map(move |(i, u)| {
        q.windows(2).enumerate().filter_map(move |(k, v)| {
            let (s, t) = crossing([u[0], u[1]], [v[0], v[1]])?;
            let point = u[0] + (u[1] - u[0]) * s;
            Some(((i as f64 + s, point), (k as f64 + t, point)))
        })
    })
}

/// Direction of a polyline at a place on it.
fn direction(line: &[Vec2], at: f64) -> Vec2 {
    let k = (at as usize).min(line.len() - 2);
    line[k + 1] - line[k]
}

/// Length that a line, extended at its start, loses by beginning at a place.
fn cut_away(extended: &[Vec2], at: At) -> f64 {
    length(&extended[1..], at.0 - 1.0)
}

/// Length of a polyline up to a place on it.
fn length(line: &[Vec2], at: f64) -> f64 {
    line.windows(2).enumerate().map(|(k, w)| (w[1] - w[0]).norm() * (at - k as f64).clamp(0.0, 1.0)).sum()
}

/// First place where `p` meets `q`, as places on both.
fn first_crossing(p: &[Vec2], q: &[Vec2]) -> Option<(At, At)> {
    crossings(p, q).min_by(|(one, _), (other, _)| one.0.total_cmp(&other.0))
}

/// Shares of two segments at which they cross, touching included.
fn crossing(a: [Vec2; 2], b: [Vec2; 2]) -> Option<(f64, f64)> {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let det = u.perp(&v);
    if det.abs() <= 1e-12 * u.norm() * v.norm() {
        return None;
    }
    let (s, t) = (w.perp(&v) / det, w.perp(&u) / det);
    let slack = |length: f64| SAME / length.max(SAME);
    let on = |x: f64, length: f64| (-slack(length)..=1.0 + slack(length)).contains(&x);
    (on(s, u.norm()) && on(t, v.norm())).then(|| (s.clamp(0.0, 1.0), t.clamp(0.0, 1.0)))
}
