//! Rows bent into rings round their body part.

use super::PlaceError;
use super::ellipse::Ellipse;
use super::fold::Sheet;
use super::levels::{LEVEL, Level, SMOOTHING, complete_shifts, levels, smooth_shifts, smoothed, spread_out};
use super::rows::{Link, Member, Row, Rows};
use super::stations::Stations;
use crate::geometry::Vec3;
use crate::mannequin::{Mannequin, PartKind};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// How far the ring stays from the body, metres, before the cloth's own width makes it wider.
const CLEARANCE: f64 = 0.02;
/// A garment with shoulder seams starts so much higher than it will hang, metres: the seams close above the shoulders.
const LIFT: f64 = 0.04;
/// A row that would begin under the floor is lifted until it is so far off it, metres,
const OFF_FLOOR: f64 = 0.005;
/// but no further than so much above the waist; the rest of a train has to be pushed up.
const HIGHEST: f64 = 0.05;
/// Above the armholes the trunk's ring gets deeper by this share of the height, to clear the arms.
const DEEPEN: f64 = 0.5;
/// A fold's under layer starts this much nearer the body, and an overlap's end this much further out, metres.
const LAYER: f64 = 0.004;
/// A layer's ring is so much wider than the one it is worn over, metres: room for the folds of that.
const LAYERS_APART: f64 = 5.0 * LAYER;

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
            above_floor(body, at - row.v[0], row).max(waist - HIGHEST - row.v[0])
        }
        PartKind::Neck => stations.low() - 0.015 - row.v[1],
        _ => stations.low() + 0.015 - row.v[0],
    }
}

/// `anchor`, or as much nearer the head as keeps the row off the floor: cloth that is pushed up from under it crumples,
/// and crumpled rims do not find each other.
fn above_floor(body: &Mannequin, anchor: f64, row: &Row) -> f64 {
    body.floor().map_or(anchor, |floor| anchor.min(-(floor + OFF_FLOOR) - row.v[1]))
}

/// Whether level seams join pieces of the row near its top: shoulders.
fn has_shoulders(row: &Row, links: &[Link]) -> bool {
    let member = |p: usize| row.members.iter().any(|m| m.piece == p);
    links.iter().any(|l| !l.upright && l.pieces.iter().all(|&p| member(p)))
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
        self.row.members.len() == 1 && !self.closed_on_itself()
    }

    /// Whether a row of one piece is a closed ring: its own two upright sides are sewn to each other.
    fn closed_on_itself(&self) -> bool {
        let range = self.mesh.pieces[self.row.members[0].piece].particles.clone();
        self.mesh.seams.iter().flat_map(|s| &s.pairs).any(|[a, b]| {
            range.contains(&(*a as usize))
                && range.contains(&(*b as usize))
                && (self.mesh.flat[*a as usize].x - self.mesh.flat[*b as usize].x).abs() > 0.5 * self.levels[0].length
        })
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
