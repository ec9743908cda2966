//! A row as a ring on its body part.

use super::arms::Arms;
use super::ellipse::Ellipse;
use super::fold::FoldedPieces;
use super::lap::RowLap;
use super::levels::{LEVEL, Level, complete_shifts, nearest_level, smooth_shifts, smoothed, spread_out};
use super::rows::{Link, Member, Row};
use super::shoulders::Lean;
use super::stations::{BodyStation, Stations};
use crate::geometry::{Vec2, Vec3, range_of};
use crate::mannequin::PartKind;
use crate::mesh::ClothMesh;

/// How far the ring stays from the body, metres, before the cloth's own width makes it wider.
const CLEARANCE: f64 = 0.02;
/// A fold's under layer starts this much nearer the body, and an overlap's end this much further out, metres.
pub(in crate::sew) const LAYER: f64 = 0.004;
/// A piece that is sewn along more than this share of what it goes round is a band; along less, as a strap at its ends
/// or a bib, it starts as long as it is.
const BAND: f64 = 0.5;
/// An armhole ends so far under the shoulder, metres; as the shipped T-shirt's does.
const ARMHOLE: f64 = 0.2;

/// A row on its body part.
pub(super) struct Ring<'a> {
    pub(super) links: &'a [Link],
    pub(super) mesh: &'a ClothMesh,
    pub(super) sheet: &'a FoldedPieces,
    pub(super) row: &'a Row,
    pub(super) levels: Vec<Level>,
    pub(super) stations: Stations,
    /// Station of v = 0.
    pub(super) anchor: f64,
    /// How each member leans over the shoulders, if the row has any.
    pub(super) leans: Vec<Lean<'a>>,
    /// The arms that its rings keep between, being deeper instead of wide; none if it need not.
    pub(super) between: Option<&'a Arms>,
}

impl Ring<'_> {
    /// Puts the row's particles on rings with these half axes; `placed` says which pieces have their place,
    /// none if empty.
    pub(super) fn bend(&mut self, axes: Vec<[f64; 2]>, placed: &[bool], x: &mut [Vec3]) {
        let ellipses: Vec<Ellipse> = axes.into_iter().map(|[a, b]| Ellipse::new(a, b)).collect();
        for (level, ellipse) in self.levels.iter_mut().zip(&ellipses) {
            spread_out(self.row, level, ellipse.perimeter);
        }
        complete_shifts(&mut self.levels);
        smooth_shifts(&mut self.levels);
        let turn = if self.row.front.is_some() && self.row.part == PartKind::Torso {
            0.0
        } else {
            self.turn(placed, x, &ellipses)
        };
        // A band whose ends overlap winds outward like a spiral, by as many layers as it has.
        let folded = |m: &Member| self.mesh.pieces[m.piece].particles.clone().any(|p| self.sheet.under[p] != 0.0);
        let layers = match (self.overlaps(), self.row.members.iter().any(folded)) {
            (false, _) => 0.0,
            (true, false) => LAYER,
            (true, true) => 2.0 * LAYER,
        };
        let sewn = self.sewn_length();
        let on_ring = |i: usize, at: Vec2, off: f64, under: f64| {
            let arc = at.x + self.shift(i, at.y);
            let station = self.stations.at(self.anchor + at.y);
            let on = |ellipse: &Ellipse| {
                // An overlapping band goes once round by what is sewn of it, however wide the ring.
                let share = arc / if layers > 0.0 { sewn } else { ellipse.perimeter };
                let outward = off + layers * (2.0 * share).clamp(0.0, 1.0) - LAYER * under;
                station.point(ellipse, share + turn, outward)
            };
            let ([k, next], f) = self.between(at.y);
            on(&ellipses[k]).lerp(&on(&ellipses[next]), f)
        };
        let inserts = self.row.inserts.iter().map(|insert| (insert.host, &insert.own, Some(insert)));
        for (i, m, insert) in self.row.members.iter().enumerate().map(|(i, m)| (i, m, None)).chain(inserts) {
            for p in self.mesh.pieces[m.piece].particles.clone() {
                let (at, under) = (self.sheet.flat[p] + m.shift, self.sheet.under[p]);
                let lifted = if insert.is_none() { self.lifted(i, at) } else { 0.0 };
                let upright = match insert {
                    None => on_ring(i, at, self.sheet.out[p] + lifted, under),
                    Some(insert) => insert.start(at, |at, off| on_ring(i, at, off, under)),
                };
                x[p] = self.leans.get(i).map_or(upright, |lean| lean.over(upright, at.y, lifted));
            }
        }
    }

    /// How far off the ring member `i` is at a row position, over one that it is buttoned to.
    fn lifted(&self, i: usize, at: Vec2) -> f64 {
        let level = &self.levels[nearest_level(self.row, self.levels.len(), at.y)];
        let off = |lap: &RowLap| {
            let next = (lap.joint + 1) % self.row.members.len();
            let [Some(own), Some(next)] = [lap.joint, next].map(|k| level.spans[k]) else { return 0.0 };
            lap.off(i, at.x, [own, next])
        };
        self.row.laps.iter().map(off).fold(0.0, f64::max)
    }

    /// Whether part of it is folded over its right side, and comes to lie outside what it is sewn to.
    pub(super) fn turns_down(&self) -> bool {
        let mut particles = self.row.members.iter().flat_map(|m| self.mesh.pieces[m.piece].particles.clone());
        particles.any(|p| self.sheet.under[p] < 0.0)
    }

    /// Whether the row is one piece that is sewn to others along most of its way round, and its ends not to each other.
    fn overlaps(&self) -> bool {
        let middle = self.anchor + 0.5 * (self.row.v[0] + self.row.v[1]);
        let round = self.stations.at(middle).perimeter(2.0 * LAYER);
        self.row.members.len() == 1 && self.sewn_length() > BAND * round && !self.closed_on_itself()
    }

    /// Whether a row of one piece is a closed ring: its own two upright sides are sewn to each other.
    fn closed_on_itself(&self) -> bool {
        let range = self.mesh.pieces[self.row.members[0].piece].particles.clone();
        self.mesh.seams.iter().flat_map(|s| &s.pairs).any(|[a, b]| {
            range.contains(&(*a as usize))
                && range.contains(&(*b as usize))
                && (self.sheet.flat[*a as usize].x - self.sheet.flat[*b as usize].x).abs() > 0.5 * self.levels[0].length
        })
    }

    /// How much of the row's way round is sewn to other rows, metres: what is sewn at its top and at its foot, or to
    /// several layers, counts once.
    fn sewn_length(&self) -> f64 {
        let own = |p: usize| self.row.members.iter().find(|m| m.piece == p);
        let mut stretches: Vec<[f64; 2]> = Vec::new();
        for link in self.links.iter().filter(|l| !l.through) {
            let member = |k: usize| own(link.pieces[k]).filter(|_| own(link.pieces[1 - k]).is_none());
            let Some((k, member)) = (0..2).find_map(|k| Some((k, member(k)?))) else { continue };
            let at = |pair: &[u32; 2]| self.sheet.flat[pair[k] as usize].x + member.shift.x;
            stretches.extend(link.pairs.windows(2).map(|pairs| range_of([at(&pairs[0]), at(&pairs[1])])));
        }
        covered(stretches)
    }

    /// The first level at which the row goes all the way round: under the armholes. A garment that hangs from the
    /// shoulders and is open at its sides goes round from where armholes would be.
    pub(super) fn first_closed(&self) -> usize {
        let open = || {
            let arms = if self.row.hangs { ARMHOLE } else { 0.0 };
            ((arms / LEVEL) as usize).min(self.levels.len() - 1)
        };
        self.levels.iter().position(|l| l.closed).unwrap_or_else(open)
    }

    /// The levels above and below v, and how far it is from the one to the other.
    fn between(&self, v: f64) -> ([usize; 2], f64) {
        let last = self.levels.len() - 1;
        let t = ((v - self.row.v[0]) / LEVEL).clamp(0.0, last as f64);
        let k = t as usize;
        ([k, (k + 1).min(last)], t - k as f64)
    }

    /// Shift of member `i`, linear between levels.
    fn shift(&self, i: usize, v: f64) -> f64 {
        let ([k, next], f) = self.between(v);
        self.levels[k].shift[i] * (1.0 - f) + self.levels[next].shift[i] * f
    }

    /// Half width and half depth at every level: room for the body and for the cloth.
    pub(super) fn axes(&self) -> Vec<[f64; 2]> {
        let (overlapping, sewn) = (self.overlaps(), self.sewn_length());
        let first_closed = self.first_closed();
        let last_closed = self.levels.iter().rposition(|l| l.closed).unwrap_or(self.levels.len() - 1);
        let mut axes: Vec<[f64; 2]> = Vec::with_capacity(self.levels.len());
        for k in 0..self.levels.len() {
            let station = self.stations.at(self.anchor + self.row.v[0] + k.max(first_closed) as f64 * LEVEL);
            // Beyond the levels where the ring is whole (armholes above, a curved hem below) it stays as wide as there.
            let whole = self.levels[k.clamp(first_closed, last_closed)].length;
            let need = if overlapping { sewn } else { whole };
            let clearance = if overlapping { 2.0 * LAYER } else { CLEARANCE };
            let extra = ((need - station.perimeter(clearance)) / std::f64::consts::TAU).max(0.0);
            let mut ab = [station.half_width, station.half_depth].map(|half| half + clearance + extra);
            // An ellipse is a little shorter than a curve so far outside another one.
            let short = (need / Ellipse::new(ab[0], ab[1]).perimeter).max(1.0);
            ab = ab.map(|half| half * short);
            axes.push(self.between.map_or(ab, |arms| between(arms, &station, ab)));
        }
        let a = smoothed(&axes.iter().map(|x| x[0]).collect::<Vec<_>>());
        let b = smoothed(&axes.iter().map(|x| x[1]).collect::<Vec<_>>());
        a.into_iter().zip(b).map(|(a, b)| [a, b]).collect()
    }

    /// Share of a turn that brings the row's stitches nearest to their placed partners.
    fn turn(&self, placed: &[bool], x: &[Vec3], ellipses: &[Ellipse]) -> f64 {
        let (mut c, mut s) = (0.0, 0.0);
        let once_round = self.overlaps().then(|| self.sewn_length());
        let perimeter = |v: f64| ellipses[nearest_level(self.row, self.levels.len(), v)].perimeter;
        for link in self.links {
            for k in 0..2 {
                let Some(i) = self.row.members.iter().position(|m| m.piece == link.pieces[k]) else { continue };
                if !placed.get(link.pieces[1 - k]).copied().unwrap_or(false) {
                    continue;
                }
                for pair in &link.pairs {
                    let at = self.sheet.flat[pair[k] as usize] + self.row.members[i].shift;
                    let round = once_round.unwrap_or_else(|| perimeter(at.y));
                    let own = (at.x + self.shift(i, at.y)) / round;
                    let station = self.stations.at(self.anchor + at.y);
                    let angle = station.angle(x[pair[1 - k] as usize]) - own * std::f64::consts::TAU;
                    c += angle.cos();
                    s += angle.sin();
                }
            }
        }
        if c != 0.0 || s != 0.0 {
            return s.atan2(c) / std::f64::consts::TAU;
        }
        // Nothing to turn to: the front of a limb is a quarter of a turn from its outer side.
        match self.row.part {
            PartKind::LeftArm | PartKind::LeftLeg if self.row.front.is_some() => -0.25,
            PartKind::RightArm | PartKind::RightLeg if self.row.front.is_some() => 0.25,
            _ => 0.0,
        }
    }
}

/// How long the stretches are together, where they lie over one another counted once.
fn covered(mut stretches: Vec<[f64; 2]>) -> f64 {
    stretches.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let (mut sum, mut end) = (0.0, f64::NEG_INFINITY);
    for [from, to] in stretches {
        sum += (to - from.max(end)).max(0.0);
        end = end.max(to);
    }
    sum
}

/// Half width and half depth of a ring as long as that of `axes` which is out of the arms, if the body leaves room.
fn between(arms: &Arms, station: &BodyStation, axes: [f64; 2]) -> [f64; 2] {
    let room = arms.room(station.center.x, station.center.y) - CLEARANCE;
    let narrow = room.max(station.half_width + 0.5 * CLEARANCE);
    if axes[0] <= narrow {
        return axes;
    }
    let deep = Ellipse::deep(narrow, Ellipse::new(axes[0], axes[1]).perimeter);
    [deep.half_width, deep.half_depth]
}

#[cfg(test)]
mod tests {
    use super::covered;
    use approx::assert_relative_eq;

    #[test]
    fn what_is_sewn_at_both_rims_counts_once() {
        let foot = [[0.0, 0.1], [0.1, 0.3], [0.3, 0.47]];
        assert_relative_eq!(covered(foot.to_vec()), 0.47, epsilon = 1e-15);
        // The top between 0.01 and 0.46, and a strap beyond the foot.
        let top = [[0.01, 0.2], [0.2, 0.46], [0.5, 0.52]];
        assert_relative_eq!(covered([top, foot].concat()), 0.49, epsilon = 1e-15);
        assert_relative_eq!(covered(Vec::new()), 0.0);
    }
}
