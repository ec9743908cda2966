//! Rows bent into rings round their body part.

use super::PlaceError;
use super::fold::Sheet;
use super::rows::{Link, Member, ROOM, Row, Rows};
use super::stations::{Station, Stations};
use crate::geometry::Vec3;
use crate::mannequin::{Mannequin, PartKind};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// Height of a level, metres: outlines are read off, and rings made, this often.
const LEVEL: f64 = 0.005;
/// Levels on either side over which shifts and rings are smoothed.
const SMOOTHING: usize = 6;
/// How far the ring stays from the body, metres, before the cloth's own width makes it wider.
const CLEARANCE: f64 = 0.02;
/// A garment with shoulder seams starts so much higher than it will hang, metres: the seams close above the shoulders.
const LIFT: f64 = 0.04;
/// Above the armholes the trunk's ring gets deeper by this share of the height, to clear the arms.
const DEEPEN: f64 = 0.5;
/// A fold's under layer starts this much nearer the body, and an overlap's end this much further out, metres.
const LAYER: f64 = 0.004;
/// A layer's ring is so much wider than the one it is worn over, metres: room for the folds of that.
const LAYERS_APART: f64 = 5.0 * LAYER;
/// Points on the table that measures an ellipse's arc.
const ARC: usize = 240;

/// A row at one level.
#[derive(Clone, Debug, Default)]
struct Level {
    /// Per member: lowest and highest u, if it is there at all.
    spans: Vec<Option<[f64; 2]>>,
    /// Per member: arc position − u, from the front middle.
    shift: Vec<f64>,
    /// Per member: room between it and the next one that is there.
    gaps: Vec<f64>,
    /// Length of the ring that the cloth needs.
    length: f64,
    /// Whether every joint between neighbours is sewn here.
    closed: bool,
}

/// Start positions; pieces in no row stay at the origin (they have a place of their own).
pub(super) fn wrap(
    garment: &Garment,
    mesh: &ClothMesh,
    body: &Mannequin,
    sheet: &Sheet,
    rows: &Rows,
) -> Result<Vec<Vec3>, PlaceError> {
    let mut rings: Vec<(usize, Ring)> = Vec::with_capacity(rows.rows.len());
    for &(index, beside) in &rows.order {
        let row = &rows.rows[index];
        let stations = Stations::new(body, row.part).ok_or_else(|| PlaceError::NoPart {
            piece: garment.pieces[row.members[0].piece].name.clone(),
            part: part_name(row.part),
            mannequin: body.name.clone(),
        })?;
        let levels = levels(mesh, sheet, row, &rows.links);
        let anchored = beside.and_then(|other| rings.iter().find(|r| r.0 == other)).map(|r| r.1.anchor);
        let anchor = anchored.unwrap_or_else(|| anchor(body, &stations, row, &levels, &rows.links));
        rings.push((index, Ring { links: &rows.links, mesh, sheet, row, levels, stations, anchor }));
    }
    let axes = nested(&rings);
    let mut x = vec![Vec3::zeros(); mesh.flat.len()];
    let mut placed = vec![false; mesh.pieces.len()];
    for ((_, ring), axes) in rings.iter_mut().zip(axes) {
        let ellipses: Vec<Ellipse> = axes.into_iter().map(|[a, b]| Ellipse::new(a, b)).collect();
        for (level, ellipse) in ring.levels.iter_mut().zip(&ellipses) {
            spread_out(ring.row, level, ellipse.perimeter);
        }
        complete_shifts(&mut ring.levels);
        smooth_shifts(&mut ring.levels);
        ring.bend(&ellipses, &placed, &mut x);
        for m in &ring.row.members {
            placed[m.piece] = true;
        }
    }
    Ok(x)
}

/// Half axes of every ring at each of its levels, those of outer layers clear of the inner ones.
fn nested(rings: &[(usize, Ring)]) -> Vec<Vec<[f64; 2]>> {
    let mut axes: Vec<Vec<[f64; 2]>> = rings.iter().map(|r| r.1.axes()).collect();
    let mut inside_out: Vec<usize> = (0..rings.len()).collect();
    inside_out.sort_by_key(|&k| rings[k].1.row.layer);
    for (nth, &k) in inside_out.iter().enumerate() {
        let ring = &rings[k].1;
        for &other in &inside_out[..nth] {
            let inner = &rings[other].1;
            if inner.row.part != ring.row.part || inner.row.layer == ring.row.layer {
                continue;
            }
            for level in 0..axes[k].len() {
                // The inner ring's levels a little above and below count too: the cloth runs straight between rings.
                let at = (ring.anchor + ring.row.v[0] - inner.anchor - inner.row.v[0]) / LEVEL + level as f64;
                let near = axes[other].iter().enumerate().filter(|(l, _)| (*l as f64 - at).abs() <= SMOOTHING as f64);
                let widest = near.fold([0.0f64; 2], |w, (_, ab)| [w[0].max(ab[0]), w[1].max(ab[1])]);
                for (own, inner) in axes[k][level].iter_mut().zip(widest) {
                    *own = own.max(inner + LAYERS_APART);
                }
            }
        }
    }
    axes
}

fn part_name(part: PartKind) -> &'static str {
    match part {
        PartKind::Torso => "torso",
        PartKind::Neck => "neck",
        PartKind::LeftArm => "left arm",
        PartKind::RightArm => "right arm",
        PartKind::LeftLeg => "left leg",
        PartKind::RightLeg => "right leg",
    }
}

/// Station (metres along the part) of v = 0 for a row that stands alone.
fn anchor(body: &Mannequin, stations: &Stations, row: &Row, levels: &[Level], links: &[Link]) -> f64 {
    match row.part {
        PartKind::Torso if has_shoulders(row, links) => {
            let neck = body.parts.iter().find(|p| p.kind == PartKind::Neck);
            let top = neck.and_then(|p| p.sections.first()).map_or_else(|| stations.low(), |s| -s.center.y);
            top - LIFT - row.v[0]
        }
        PartKind::Torso => {
            // As low below the waist as the body lets the row's top slip.
            let girth = levels.get(2).or(levels.first()).map_or(0.0, |l| l.length);
            let waist = stations.landmark(&["natural waist", "waist", "omphalion"]).unwrap_or_else(|| stations.low());
            let mut at = waist;
            while at < waist + 0.15 && stations.at(at).perimeter(0.003) < girth {
                at += 0.005;
            }
            at - row.v[0]
        }
        PartKind::Neck => stations.low() - 0.015 - row.v[1],
        _ => stations.low() + 0.015 - row.v[0],
    }
}

/// Whether level seams join pieces of the row near its top: shoulders.
fn has_shoulders(row: &Row, links: &[Link]) -> bool {
    let member = |p: usize| row.members.iter().any(|m| m.piece == p);
    links.iter().any(|l| !l.upright && l.pieces.iter().all(|&p| member(p)))
}

/// Reads the row's outline level by level and packs its members side by side.
fn levels(mesh: &ClothMesh, sheet: &Sheet, row: &Row, links: &[Link]) -> Vec<Level> {
    let count = ((row.v[1] - row.v[0]) / LEVEL).ceil() as usize + 1;
    let members = row.members.len();
    let mut out = vec![Level { spans: vec![None; members], shift: vec![0.0; members], ..Level::default() }; count];
    let level_of = |v: f64| (((v - row.v[0]) / LEVEL).round().max(0.0) as usize).min(count - 1);
    for (i, m) in row.members.iter().enumerate() {
        for tri in &mesh.triangles[mesh.pieces[m.piece].triangles.clone()] {
            let corners = tri.map(|p| sheet.flat[p as usize] + m.shift);
            let lo = corners.iter().map(|c| c.y).fold(f64::INFINITY, f64::min);
            let hi = corners.iter().map(|c| c.y).fold(f64::NEG_INFINITY, f64::max);
            let left = corners.iter().map(|c| c.x).fold(f64::INFINITY, f64::min);
            let right = corners.iter().map(|c| c.x).fold(f64::NEG_INFINITY, f64::max);
            for level in &mut out[level_of(lo)..=level_of(hi)] {
                let span = level.spans[i].get_or_insert([left, right]);
                *span = [span[0].min(left), span[1].max(right)];
            }
        }
    }
    widen(&mut out);
    let joints = joints(sheet, row, links, &level_of);
    for (k, level) in out.iter_mut().enumerate() {
        pack(row, level, k, &joints);
    }
    out
}

/// Lets every span cover those of the levels that its shift will be averaged with: each of these shifts keeps the
/// members apart at this level too, and so does their average.
fn widen(levels: &mut [Level]) {
    let spans: Vec<_> = levels.iter().map(|l| l.spans.clone()).collect();
    for (k, level) in levels.iter_mut().enumerate() {
        for (i, span) in level.spans.iter_mut().enumerate() {
            let Some(own) = span else { continue };
            for near in &spans[k.saturating_sub(SMOOTHING)..(k + SMOOTHING + 1).min(spans.len())] {
                if let Some(other) = near[i] {
                    *own = [own[0].min(other[0]), own[1].max(other[1])];
                }
            }
        }
    }
}

/// The joint between member i and the next one round the ring.
struct Joint {
    /// Levels over which it is sewn.
    sewn: Option<[usize; 2]>,
    /// u of the next member − u of this one where they meet, in row positions.
    jump: f64,
}

fn joints(sheet: &Sheet, row: &Row, links: &[Link], level_of: &impl Fn(f64) -> usize) -> Vec<Joint> {
    let n = row.members.len();
    (0..n)
        .map(|i| {
            let (a, b) = (&row.members[i], &row.members[(i + 1) % n]);
            let mut sewn: Option<[usize; 2]> = None;
            let (mut jump, mut count) = (0.0, 0.0);
            for link in links.iter().filter(|l| l.upright && n > 1) {
                let Some(k) =
                    (0..2).find(|&k| link.pieces == if k == 0 { [a.piece, b.piece] } else { [b.piece, a.piece] })
                else {
                    continue;
                };
                // With two members the same two pieces meet twice: right of a with left of b is this joint.
                let mean = |m: &Member, k: usize| {
                    link.pairs.iter().map(|p| sheet.flat[p[k] as usize].x + m.shift.x).sum::<f64>()
                        / link.pairs.len() as f64
                };
                let (ua, ub) = (mean(a, k), mean(b, 1 - k));
                if n == 2 && (i == 0) != ((ub - ua).abs() < 0.5 * spread(row, sheet, link)) {
                    continue;
                }
                for p in &link.pairs {
                    let v = sheet.flat[p[k] as usize].y + a.shift.y;
                    let l = level_of(v);
                    let s = sewn.get_or_insert([l, l]);
                    *s = [s[0].min(l), s[1].max(l)];
                }
                jump += (ub - ua) * link.pairs.len() as f64;
                count += link.pairs.len() as f64;
            }
            Joint { sewn, jump: if count > 0.0 { jump / count } else { 0.0 } }
        })
        .collect()
}

/// A length to tell "meets here" from "meets round the ring": the two pieces' width at the link, at least 10 cm.
fn spread(row: &Row, sheet: &Sheet, link: &Link) -> f64 {
    let u = |k: usize| {
        let shift = row.members.iter().find(|m| m.piece == link.pieces[k]).map_or(0.0, |m| m.shift.x);
        link.pairs.iter().map(move |p| sheet.flat[p[k] as usize].x + shift)
    };
    let lo = u(0).chain(u(1)).fold(f64::INFINITY, f64::min);
    let hi = u(0).chain(u(1)).fold(f64::NEG_INFINITY, f64::max);
    (hi - lo).max(0.1)
}

/// Packs one level: sewn joints get a little room, others what the layout leaves, never an overlap.
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
        level.gaps[i] = if sewn || n == 1 { ROOM } else { left.max(ROOM) };
    }
    let cloth: f64 = level.spans.iter().flatten().map(|s| s[1] - s[0]).sum();
    level.length = cloth + level.gaps.iter().sum::<f64>();
}

/// Puts the members of a level on a ring of `perimeter` metres: what the ring is longer than the cloth goes into the
/// gaps between them.
fn spread_out(row: &Row, level: &mut Level, perimeter: f64) {
    let present = level.present();
    let slack = (perimeter - level.length).max(0.0) / present.len().max(1) as f64;
    let mut starts = vec![0.0; row.members.len()];
    let mut at = 0.0;
    for &i in &present {
        let Some(span) = level.spans[i] else { continue };
        starts[i] = at;
        at += span[1] - span[0] + level.gaps[i] + slack;
    }
    let zero = middle(row, level, &present, &starts);
    for &i in &present {
        if let Some(span) = level.spans[i] {
            level.shift[i] = starts[i] - zero - span[0];
        }
    }
}

/// Packed position of the front middle (or of the row's own middle when it has no front).
fn middle(row: &Row, level: &Level, present: &[usize], starts: &[f64]) -> f64 {
    let span = |i: usize| level.spans[i].unwrap_or([0.0, 0.0]);
    let Some(front) = row.front else { return 0.5 * level.length };
    let center = |i: usize| 0.5 * (span(i)[0] + span(i)[1]);
    let over = present.iter().find(|&&i| (center(i) - front).abs() < 0.25 * (span(i)[1] - span(i)[0]));
    if let Some(&i) = over {
        return starts[i] + front - span(i)[0];
    }
    let before = present.iter().filter(|&&i| center(i) < front).max_by(|&&a, &&b| center(a).total_cmp(&center(b)));
    let after = present.iter().filter(|&&i| center(i) >= front).min_by(|&&a, &&b| center(a).total_cmp(&center(b)));
    match (before, after) {
        (Some(&a), Some(&b)) => 0.5 * (starts[a] + span(a)[1] - span(a)[0] + starts[b]),
        (Some(&a), None) => starts[a] + front - span(a)[0],
        (None, Some(&b)) => starts[b] + front - span(b)[0],
        (None, None) => 0.0,
    }
}

/// Where not every member reaches (the points of a curved waist, the dip of a hem) the others would drift apart to fill
/// the ring: they stay as at the nearest level with all of them.
fn complete_shifts(levels: &mut [Level]) {
    let whole: Vec<usize> = (0..levels.len()).filter(|&k| levels[k].spans.iter().all(Option::is_some)).collect();
    for k in 0..levels.len() {
        let nearest = whole.iter().min_by_key(|&&w| w.abs_diff(k));
        if let Some(&w) = nearest.filter(|&&w| w != k) {
            levels[k].shift = levels[w].shift.clone();
        }
    }
}

/// Moving averages over neighbouring levels: no shear where an outline turns.
fn smooth_shifts(levels: &mut [Level]) {
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

fn smoothed(values: &[f64]) -> Vec<f64> {
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

/// A row on its body part.
struct Ring<'a> {
    links: &'a [Link],
    mesh: &'a ClothMesh,
    sheet: &'a Sheet,
    row: &'a Row,
    levels: Vec<Level>,
    stations: Stations,
    anchor: f64,
}

impl Ring<'_> {
    fn bend(&self, ellipses: &[Ellipse], placed: &[bool], x: &mut [Vec3]) {
        let turn = if self.row.front.is_some() && self.row.part == PartKind::Torso {
            0.0
        } else {
            self.turn(placed, x, ellipses)
        };
        // A band whose ends overlap winds outward like a spiral, by as many layers as it has.
        let folded = |m: &Member| self.mesh.pieces[m.piece].particles.clone().any(|p| self.sheet.under[p] > 0.0);
        let layers = match (self.overlaps(), self.row.members.iter().any(folded)) {
            (false, _) => 0.0,
            (true, false) => LAYER,
            (true, true) => 2.0 * LAYER,
        };
        for (i, m) in self.row.members.iter().enumerate() {
            for p in self.mesh.pieces[m.piece].particles.clone() {
                let at = self.sheet.flat[p] + m.shift;
                let k = self.level(at.y);
                let (ellipse, station) = (&ellipses[k], self.anchor + at.y);
                let arc = at.x + self.shift(i, at.y);
                // An overlapping band goes once round by what is sewn of it, however wide the ring.
                let share = arc / if layers > 0.0 { self.sewn_length() } else { ellipse.perimeter };
                let outward = layers * (2.0 * share).clamp(0.0, 1.0) - LAYER * self.sheet.under[p];
                x[p] = self.stations.at(station).point(ellipse, share + turn, outward);
            }
        }
    }

    /// Whether the row is one piece whose ends are not sewn to each other.
    fn overlaps(&self) -> bool {
        self.row.members.len() == 1 && !self.levels[0].closed_on_itself(self, self.mesh)
    }

    /// Length of the row's seams with other rows.
    fn sewn_length(&self) -> f64 {
        let own = |p: usize| self.row.members.iter().any(|m| m.piece == p);
        self.links.iter().filter(|l| own(l.pieces[0]) != own(l.pieces[1])).map(|l| l.length).sum()
    }

    fn level(&self, v: f64) -> usize {
        (((v - self.row.v[0]) / LEVEL).round().max(0.0) as usize).min(self.levels.len() - 1)
    }

    /// Shift of member `i`, linear between levels.
    fn shift(&self, i: usize, v: f64) -> f64 {
        let t = ((v - self.row.v[0]) / LEVEL).clamp(0.0, (self.levels.len() - 1) as f64);
        let k = (t as usize).min(self.levels.len().saturating_sub(2));
        let f = t - k as f64;
        let at = |k: usize| self.levels[k.min(self.levels.len() - 1)].shift[i];
        at(k) * (1.0 - f) + at(k + 1) * f
    }

    /// Half width and half depth at every level: room for the body and for the cloth.
    fn axes(&self) -> Vec<[f64; 2]> {
        let overlapping = self.overlaps();
        let shoulders = self.row.part == PartKind::Torso && has_shoulders(self.row, self.links);
        let first_closed = self.levels.iter().position(|l| l.closed).unwrap_or(0);
        let last_closed = self.levels.iter().rposition(|l| l.closed).unwrap_or(self.levels.len() - 1);
        let mut axes: Vec<[f64; 2]> = Vec::with_capacity(self.levels.len());
        for k in 0..self.levels.len() {
            let station = self.stations.at(self.anchor + self.row.v[0] + k.max(first_closed) as f64 * LEVEL);
            // Beyond the levels where the ring is whole (armholes above, a curved hem below) it stays as wide as there.
            let whole = self.levels[k.clamp(first_closed, last_closed)].length;
            let need = if overlapping { self.sewn_length() } else { whole };
            let clearance = if overlapping { 2.0 * LAYER } else { CLEARANCE };
            let grow = (need / station.perimeter(clearance)).max(1.0);
            let mut ab = [(station.half_width + clearance) * grow, (station.half_depth + clearance) * grow];
            if shoulders && k < first_closed {
                ab[1] += DEEPEN * (first_closed - k) as f64 * LEVEL;
            }
            axes.push(ab);
        }
        let a = smoothed(&axes.iter().map(|x| x[0]).collect::<Vec<_>>());
        let b = smoothed(&axes.iter().map(|x| x[1]).collect::<Vec<_>>());
        a.into_iter().zip(b).map(|(a, b)| [a, b]).collect()
    }

    /// Share of a turn that brings the row's stitches nearest to their placed partners.
    fn turn(&self, placed: &[bool], x: &[Vec3], ellipses: &[Ellipse]) -> f64 {
        let (mut c, mut s) = (0.0, 0.0);
        for link in self.links {
            for k in 0..2 {
                let Some(i) = self.row.members.iter().position(|m| m.piece == link.pieces[k]) else { continue };
                if !placed[link.pieces[1 - k]] {
                    continue;
                }
                for pair in &link.pairs {
                    let at = self.sheet.flat[pair[k] as usize] + self.row.members[i].shift;
                    let round = if self.overlaps() { self.sewn_length() } else { ellipses[self.level(at.y)].perimeter };
                    let own = (at.x + self.shift(i, at.y)) / round;
                    let station = self.stations.at(self.anchor + at.y);
                    let angle = station.angle(x[pair[1 - k] as usize]) - own * std::f64::consts::TAU;
                    c += angle.cos();
                    s += angle.sin();
                }
            }
        }
        if c == 0.0 && s == 0.0 { 0.0 } else { s.atan2(c) / std::f64::consts::TAU }
    }
}

impl Level {
    /// Members that reach this level.
    fn present(&self) -> Vec<usize> {
        (0..self.spans.len()).filter(|&i| self.spans[i].is_some()).collect()
    }

    /// Whether a row of one piece is a closed ring: its own two upright sides are sewn to each other.
    fn closed_on_itself(&self, ring: &Ring, mesh: &ClothMesh) -> bool {
        let range = mesh.pieces[ring.row.members[0].piece].particles.clone();
        mesh.seams.iter().flat_map(|s| &s.pairs).any(|[a, b]| {
            range.contains(&(*a as usize))
                && range.contains(&(*b as usize))
                && (mesh.flat[*a as usize].x - mesh.flat[*b as usize].x).abs() > 0.5 * self.length
        })
    }
}

/// An ellipse measured by its arc from the front (b axis) towards the wearer's left (a axis).
pub(super) struct Ellipse {
    half_width: f64,
    half_depth: f64,
    /// Arc length up to each of [`ARC`] equal steps of the parameter.
    table: Vec<f64>,
    pub(super) perimeter: f64,
}

impl Ellipse {
    pub(super) fn new(half_width: f64, half_depth: f64) -> Self {
        let at = |k: usize| {
            let t = std::f64::consts::TAU * k as f64 / ARC as f64;
            (half_width * t.sin(), half_depth * t.cos())
        };
        let mut table = vec![0.0];
        for k in 0..ARC {
            let (p, q) = (at(k), at(k + 1));
            table.push(table[k] + (q.0 - p.0).hypot(q.1 - p.1));
        }
        let perimeter = table[ARC];
        Self { half_width, half_depth, table, perimeter }
    }

    /// (sideways, forward) at a share of the perimeter, and the unit outward normal.
    pub(super) fn at(&self, share: f64) -> ([f64; 2], [f64; 2]) {
        let arc = share.rem_euclid(1.0) * self.perimeter;
        let k = self.table.partition_point(|&t| t <= arc).clamp(1, ARC) - 1;
        let f = (arc - self.table[k]) / (self.table[k + 1] - self.table[k]).max(1e-12);
        let t = std::f64::consts::TAU * (k as f64 + f) / ARC as f64;
        let n = [t.sin() / self.half_width, t.cos() / self.half_depth];
        let length = n[0].hypot(n[1]);
        ([self.half_width * t.sin(), self.half_depth * t.cos()], [n[0] / length, n[1] / length])
    }
}

impl Station {
    fn perimeter(&self, clearance: f64) -> f64 {
        Ellipse::new(self.half_width + clearance, self.half_depth + clearance).perimeter
    }

    /// The point at a share of the ring, `outward` metres off it.
    fn point(&self, ellipse: &Ellipse, share: f64, outward: f64) -> Vec3 {
        let (p, n) = ellipse.at(share);
        self.center + self.right * (p[0] + outward * n[0]) + self.front * (p[1] + outward * n[1])
    }

    /// Angle of a point round the axis, radians from the front towards the right-hand side seen from outside.
    fn angle(&self, p: Vec3) -> f64 {
        let d = p - self.center;
        d.dot(&self.right).atan2(d.dot(&self.front))
    }
}
