//! A row level by level: where its members are, and how they stand side by side round a ring.

use super::fold::FoldedPieces;
use super::rows::{Link, Member, Middle, ROOM, Row, extent, stitched};
use crate::geometry::box_of;
use crate::mesh::ClothMesh;

/// Height of a level, metres: outlines are read off, and rings made, this often.
pub(super) const LEVEL: f64 = 0.005;
/// Levels on either side over which shifts and rings are smoothed.
pub(super) const SMOOTHING: usize = 6;
/// A front middle that is no further than this share of a member's width from its middle is on that member.
const WITHIN: f64 = 0.25;

/// A row at one level.
#[derive(Clone, Debug, Default)]
pub(super) struct Level {
    /// Per member: lowest and highest u, if it is there at all.
    pub(super) spans: Vec<Option<[f64; 2]>>,
    /// Per member: arc position − u, from the front middle.
    pub(super) shift: Vec<f64>,
    /// Per member: room between it and the next one that is there.
    pub(super) gaps: Vec<f64>,
    /// Length of the ring that the cloth needs.
    pub(super) length: f64,
    /// Whether every joint between neighbours is sewn here.
    pub(super) closed: bool,
}

impl Level {
    /// Members that reach this level.
    fn present(&self) -> Vec<usize> {
        (0..self.spans.len()).filter(|&i| self.spans[i].is_some()).collect()
    }
}

/// Reads the row's outline level by level and packs its members side by side.
pub(super) fn levels(mesh: &ClothMesh, sheet: &FoldedPieces, row: &Row, links: &[Link]) -> Vec<Level> {
    let count = ((row.v[1] - row.v[0]) / LEVEL).ceil() as usize + 1;
    let members = row.members.len();
    let mut out = vec![Level { spans: vec![None; members], shift: vec![0.0; members], ..Level::default() }; count];
    let level_of = |v: f64| nearest_level(row, count, v);
    for (i, m) in row.members.iter().enumerate() {
        for tri in &mesh.triangles[mesh.pieces[m.piece].triangles.clone()] {
            let corners = tri.map(|p| sheet.flat[p as usize] + m.shift);
            let [low, high] = box_of(corners);
            for level in &mut out[level_of(low.y)..=level_of(high.y)] {
                let span = level.spans[i].get_or_insert([low.x, high.x]);
                *span = [span[0].min(low.x), span[1].max(high.x)];
            }
        }
    }
    let joints = joints(mesh, sheet, row, links, &level_of);
    let sewn = joints.iter().enumerate().filter_map(|(i, joint)| Some((i, joint.sewn?)));
    let lapped = row.laps.iter().map(|lap| (lap.joint, lap.v.map(level_of)));
    for (i, range) in sewn.chain(lapped) {
        prolong(&mut out, [i, (i + 1) % members], range);
    }
    widen(&mut out);
    for (k, level) in out.iter_mut().enumerate() {
        pack(row, level, k, &joints);
    }
    out
}

/// The one of the `count` levels of a row that is nearest to v.
pub(super) fn nearest_level(row: &Row, count: usize, v: f64) -> usize {
    (((v - row.v[0]) / LEVEL).round().max(0.0) as usize).min(count - 1)
}

/// Widens every span so far that its mean over the levels that its shift will be averaged with still covers it: each of
/// these shifts keeps the widened spans apart, and so does their average. Where an outline runs straight, nothing has
/// to be added.
fn widen(levels: &mut [Level]) {
    let members = levels.first().map_or(0, |l| l.spans.len());
    for i in 0..members {
        let there: Vec<usize> = (0..levels.len()).filter(|&k| levels[k].spans[i].is_some()).collect();
        for side in 0..2 {
            let sign = if side == 0 { -1.0 } else { 1.0 };
            let reach: Vec<f64> = there.iter().map(|&k| levels[k].spans[i].map_or(0.0, |s| sign * s[side])).collect();
            let lacking: Vec<f64> =
                reach.iter().zip(smoothed(&reach)).map(|(own, mean)| (own - mean).max(0.0)).collect();
            for (at, &k) in there.iter().enumerate() {
                let near = at.saturating_sub(SMOOTHING)..(at + SMOOTHING + 1).min(there.len());
                let most = lacking[near].iter().copied().fold(0.0, f64::max);
                if let Some(span) = &mut levels[k].spans[i] {
                    span[side] += sign * most;
                }
            }
        }
    }
}

/// The joint between member i and the next one round the ring.
struct Joint {
    /// Levels over which it is sewn.
    sewn: Option<[usize; 2]>,
    /// The u of the next member less that of this one where they meet, in row positions.
    jump: f64,
}

/// The joints after every member, the last one's being that with the first.
fn joints(
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    row: &Row,
    links: &[Link],
    level_of: &impl Fn(f64) -> usize,
) -> Vec<Joint> {
    let n = row.members.len();
    let middle = |m: &Member| {
        let [low, high] = extent(mesh, sheet, m.piece);
        0.5 * (low.x + high.x)
    };
    (0..n)
        .map(|i| {
            let (a, b) = (&row.members[i], &row.members[(i + 1) % n]);
            let middles = [middle(a), middle(b)];
            let mut sewn: Option<[usize; 2]> = None;
            let (mut jump, mut count) = (0.0, 0.0);
            for link in links.iter().filter(|l| l.upright && !l.through && n > 1) {
                let Some(k) =
                    (0..2).find(|&k| link.pieces == if k == 0 { [a.piece, b.piece] } else { [b.piece, a.piece] })
                else {
                    continue;
                };
                // The same two pieces may meet round the ring or between the legs as well: this joint is where the
                // right of one meets the left of the other.
                let (ua, ub) = (stitched(link, sheet, k).x, stitched(link, sheet, 1 - k).x);
                if ua < middles[0] || ub > middles[1] {
                    continue;
                }
                for p in &link.pairs {
                    let v = sheet.flat[p[k] as usize].y + a.shift.y;
                    let l = level_of(v);
                    let s = sewn.get_or_insert([l, l]);
                    *s = [s[0].min(l), s[1].max(l)];
                }
                jump += (ub + b.shift.x - ua - a.shift.x) * link.pairs.len() as f64;
                count += link.pairs.len() as f64;
            }
            Joint { sewn, jump: if count > 0.0 { jump / count } else { 0.0 } }
        })
        .collect()
}

/// Beyond the ends of a joint that is sewn or buttoned at these levels (over a curved waist, under the crotch, beside
/// the neck) its two sides go on as they end: what lies side by side stays so where one of the outlines turns away.
fn prolong(levels: &mut [Level], members: [usize; 2], [first, last]: [usize; 2]) {
    for (member, side) in members.into_iter().zip([1, 0]) {
        let ends = [first, last].map(|k| levels[k].spans[member].map(|s| s[side]));
        for k in (0..first).chain(last + 1..levels.len()) {
            let end = ends[usize::from(k > last)];
            if let (Some(end), Some(span)) = (end, &mut levels[k].spans[member]) {
                span[side] = if side == 0 { span[side].min(end) } else { span[side].max(end) };
            }
        }
    }
}

/// Packs one level: sewn joints get a little room, others what the layout leaves, and only what is buttoned overlaps.
fn pack(row: &Row, level: &mut Level, k: usize, joints: &[Joint]) {
    let n = row.members.len();
    let present = level.present();
    level.gaps = vec![0.0; n];
    level.closed = present.len() == n;
    for (j, &i) in present.iter().enumerate() {
        let next = present[(j + 1) % present.len()];
        let joint = &joints[i];
        let sewn = next == (i + 1) % n && joint.sewn.is_some_and(|s| (s[0]..=s[1]).contains(&k));
        level.closed &= sewn || n == 1;
        let left = match (level.spans[i], level.spans[next]) {
            (Some(own), Some(other)) if joint.sewn.is_some() => other[0] - own[1] - joint.jump,
            (Some(own), Some(other)) if j + 1 < present.len() => other[0] - own[1],
            _ => 0.0,
        };
        let lap = row.laps.iter().find(|lap| lap.joint == i && next == (i + 1) % n && !sewn);
        level.gaps[i] = match (lap, level.spans[i], level.spans[next]) {
            (Some(lap), Some(own), Some(next)) => lap.gap([own, next]).min(ROOM),
            _ if sewn || n == 1 => ROOM,
            _ => left.max(ROOM),
        };
    }
    let cloth: f64 = level.spans.iter().flatten().map(|s| s[1] - s[0]).sum();
    level.length = cloth + level.gaps.iter().sum::<f64>();
}

/// Puts the members of a level on a ring of `perimeter` metres: what the ring is longer than the cloth goes into the
/// gaps between them, but for those that closures hold; what it is shorter comes first out of those that are not sewn.
pub(super) fn spread_out(row: &Row, level: &mut Level, perimeter: f64) {
    let present = level.present();
    let missing = (level.length - perimeter).max(0.0);
    let spare = |gap: f64| (gap - ROOM).max(0.0);
    let all: f64 = present.iter().map(|&i| spare(level.gaps[i])).sum();
    let taken = missing.min(all);
    for &i in &present {
        level.gaps[i] -= spare(level.gaps[i]) * taken / all.max(f64::MIN_POSITIVE);
    }
    // Still less than nothing where a ring was smoothed to less than its cloth: neighbouring levels make up for it.
    let lapped = |i: usize| row.laps.iter().any(|lap| lap.joint == i);
    let mut loose: Vec<usize> = present.iter().copied().filter(|&i| !lapped(i)).collect();
    if loose.is_empty() {
        loose.clone_from(&present);
    }
    let slack = (perimeter - level.length + taken) / loose.len().max(1) as f64;
    loose.iter().for_each(|&i| level.gaps[i] += slack);
    let mut starts = vec![0.0; row.members.len()];
    let mut at = 0.0;
    for &i in &present {
        let Some(span) = level.spans[i] else { continue };
        starts[i] = at;
        at += span[1] - span[0] + level.gaps[i];
    }
    let zero = middle(row, level, &present, &starts, perimeter);
    for &i in &present {
        if let Some(span) = level.spans[i] {
            level.shift[i] = starts[i] - zero - span[0];
        }
    }
}

/// Packed position of the front middle (or of the row's own middle when it has no front) on a ring of that `perimeter`.
fn middle(row: &Row, level: &Level, present: &[usize], starts: &[f64], perimeter: f64) -> f64 {
    let Some(front) = row.front else { return 0.5 * level.length };
    match front {
        Middle::On(u) => packed(level, present, starts, u),
        Middle::Opposite(u) => packed(level, present, starts, u) - 0.5 * perimeter,
        Middle::LeftOf(piece) => {
            let at = present.iter().position(|&i| row.members[i].piece == piece).unwrap_or(0);
            let before = present[..at].last().or(present.last()).map_or(0.0, |&i| level.gaps[i]);
            present.get(at).map_or(0.0, |&i| starts[i] - 0.5 * before)
        }
    }
}

/// Packed position of `u`, on a piece or between two.
fn packed(level: &Level, present: &[usize], starts: &[f64], u: f64) -> f64 {
    let span = |i: usize| level.spans[i].unwrap_or([0.0, 0.0]);
    let center = |i: usize| 0.5 * (span(i)[0] + span(i)[1]);
    let over = present.iter().find(|&&i| (center(i) - u).abs() < WITHIN * (span(i)[1] - span(i)[0]));
    if let Some(&i) = over {
        return starts[i] + u - span(i)[0];
    }
    let before = present.iter().filter(|&&i| center(i) < u).max_by(|&&a, &&b| center(a).total_cmp(&center(b)));
    let after = present.iter().filter(|&&i| center(i) >= u).min_by(|&&a, &&b| center(a).total_cmp(&center(b)));
    match (before, after) {
        (Some(&a), Some(&b)) => 0.5 * (starts[a] + span(a)[1] - span(a)[0] + starts[b]),
        (Some(&a), None) => starts[a] + u - span(a)[0],
        (None, Some(&b)) => starts[b] + u - span(b)[0],
        (None, None) => 0.0,
    }
}

/// Where not every member reaches (the points of a curved waist, the dip of a hem) the others would drift apart to fill
/// the ring: they stay as at the nearest level with all of them.
pub(super) fn complete_shifts(levels: &mut [Level]) {
    let whole: Vec<usize> = (0..levels.len()).filter(|&k| levels[k].spans.iter().all(Option::is_some)).collect();
    for k in 0..levels.len() {
        let nearest = whole.iter().min_by_key(|&&w| w.abs_diff(k));
        if let Some(&w) = nearest.filter(|&&w| w != k) {
            levels[k].shift = levels[w].shift.clone();
        }
    }
}

/// Moving averages over neighbouring levels: no shear where an outline turns.
pub(super) fn smooth_shifts(levels: &mut [Level]) {
    let members = levels.first().map_or(0, |l| l.shift.len());
    for m in 0..members {
        let there: Vec<usize> = (0..levels.len()).filter(|&k| levels[k].spans[m].is_some()).collect();
        let values: Vec<f64> = there.iter().map(|&k| levels[k].shift[m]).collect();
        for (value, &k) in smoothed(&values).into_iter().zip(&there) {
            levels[k].shift[m] = value;
        }
        // A particle right at the end of a piece may fall into the next level.
        if let (Some(&first), Some(&last)) = (there.first(), there.last()) {
            for k in 0..levels.len() {
                if k < first || k > last {
                    levels[k].shift[m] = levels[if k < first { first } else { last }].shift[m];
                }
            }
        }
    }
}

/// Moving averages over [`SMOOTHING`] values on either side.
pub(super) fn smoothed(values: &[f64]) -> Vec<f64> {
    (0..values.len())
        .map(|k| {
            let from = k.saturating_sub(SMOOTHING);
            let to = (k + SMOOTHING + 1).min(values.len());
            // Symmetric windows only, so that a straight slope stays straight up to the ends.
            let half = (k - from).min(to - 1 - k);
            let window = &values[k - half..=k + half];
            window.iter().sum::<f64>() / window.len() as f64
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec2;
    use crate::mannequin::PartKind;

    #[test]
    fn smoothing_keeps_straight_slopes_and_evens_the_rest() {
        let slope: Vec<f64> = (0..40).map(|k| 3.0 - 0.25 * f64::from(k)).collect();
        assert!(smoothed(&slope).iter().zip(&slope).all(|(a, b)| (a - b).abs() < 1e-12));
        let step: Vec<f64> = (0..40).map(|k| if k < 20 { 0.0 } else { 1.0 }).collect();
        let even = smoothed(&step);
        assert!(even.windows(2).all(|w| w[1] >= w[0] && w[1] - w[0] < 1.5 / (2 * SMOOTHING + 1) as f64), "{even:?}");
        assert_eq!([even[0], even[39]], [0.0, 1.0]);
        assert_eq!(smoothed(&[]), Vec::<f64>::new());
    }

    /// Three members side by side on one level, u in metres, with the room after each.
    fn level() -> (Row, Level) {
        let members = (0..3).map(|piece| Member { piece, shift: Vec2::zeros() }).collect();
        let row = Row {
            part: PartKind::Torso,
            members,
            inserts: Vec::new(),
            laps: Vec::new(),
            front: Some(Middle::On(0.05)),
            v: [0.0, 0.0],
            hangs: false,
            layer: 0,
        };
        let spans = vec![Some([0.0, 0.1]), Some([0.1, 0.3]), Some([0.3, 0.45])];
        let gaps = vec![ROOM, 2.0 * ROOM, ROOM];
        let length = 0.45 + 4.0 * ROOM;
        (row, Level { spans, gaps, length, shift: vec![0.0; 3], closed: true })
    }

    #[test]
    fn what_the_ring_is_longer_than_the_cloth_goes_into_the_gaps() {
        let perimeter = 0.6;
        let (row, mut level) = level();
        let gaps = level.gaps.clone();
        spread_out(&row, &mut level, perimeter);
        let slack = (perimeter - level.length) / 3.0;
        let at = |i: usize| level.spans[i].map(|s| s.map(|u| u + level.shift[i])).expect("there");
        // The front middle, u = 0.05 on the first, is where the ring begins.
        assert!((at(0)[0] + 0.05).abs() < 1e-12);
        let after = |i: usize| if i < 2 { at(i + 1)[0] } else { at(0)[0] + perimeter };
        for (i, gap) in gaps.into_iter().enumerate() {
            let room = after(i) - at(i)[1];
            assert!((room - gap - slack).abs() < 1e-12, "{room} after {i}");
        }
    }

    #[test]
    fn where_a_member_ends_the_others_stay_as_at_the_nearest_whole_level() {
        let (_, whole) = level();
        let mut levels = vec![whole.clone(), whole.clone(), whole];
        for (k, level) in levels.iter_mut().enumerate() {
            level.shift = vec![k as f64; 3];
        }
        levels[2].spans[1] = None;
        complete_shifts(&mut levels);
        let shifts: Vec<f64> = levels.iter().map(|l| l.shift[0]).collect();
        assert_eq!(shifts, [0.0, 1.0, 1.0]);
    }
}
