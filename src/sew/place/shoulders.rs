//! Fronts and backs lean towards each other over the shoulders, so that shoulder seams start nearly closed.
//!
//! ```text
//!   seen from the side:   │     │            ╲ ╱
//!                         │     │     ─▶     ╱ ╲
//!        armholes end ────│─────│───        │   │
//! ```

use super::arms::Arms;
use super::levels::LEVEL;
use super::ring::{LAYER, Ring};
use super::rows::{Member, extent};
use crate::contact::Collider;
use crate::geometry::Vec3;
use crate::mannequin::{Mannequin, PartKind};

/// A garment with shoulder seams starts so much higher than it will hang, metres: the seams close above the shoulders.
const LIFT: f64 = 0.04;
/// Step by which a garment is lowered until its sides are out of the arms, metres.
const STEP: f64 = 0.005;
/// Largest number of those steps.
const STEPS: usize = 12;
/// Distance below the end of the armholes within which its sides are checked against the arms, metres.
const UNDERARM: f64 = 0.06;
/// Pieces bend over this length above the armholes, metres, and are straight beyond.
const BEND: f64 = 0.06;
/// They lean until this share of their distance from the middle of the body is left.
const LEFT: f64 = 0.15;
/// That angle is found in so many halvings, far below a degree.
const HALVINGS: usize = 12;
/// They lean by no more than this from upright, radians: what is short above the armholes does not reach the middle.
const STEEPEST: f64 = 1.2;
/// Clearance of cloth from the body, metres. Every layer under it adds one layer.
const CLEAR: f64 = 0.008;
/// Depth within which the body is looked for, metres.
const DEEPEST: f64 = 0.5;
/// Number of angles tried between leaning and upright.
const TRIES: usize = 40;
/// Share of its height by which a piece stands off that would be in the body (an arm) even upright.
const OFF: f64 = 0.5;
/// Largest distance by which a piece with open sides stands off, metres: a tabard beside the arms.
const FURTHEST: f64 = 0.15;
/// Step in which that distance is tried, metres.
const AWAY: f64 = 0.005;

/// How a piece leans over the shoulders.
#[derive(Clone)]
pub(super) struct Lean<'a> {
    body: &'a Collider,
    /// Above this v it leans.
    from: f64,
    /// By this angle from upright, radians.
    angle: f64,
    /// The ring's half depth there, metres.
    depth: f64,
    /// The z of the middle of the body at the shoulders.
    middle: f64,
    /// How far it keeps from the body, metres.
    clear: f64,
    /// How far beyond it may stand off to do so, metres.
    furthest: f64,
}

impl Lean<'_> {
    /// The angle at which a piece that goes on for `height` metres comes as far in as it should.
    fn reaching(mut self, height: f64) -> Self {
        // How far in it comes rises with the angle.
        let (mut low, mut high) = (0.0, STEEPEST);
        for _ in 0..HALVINGS {
            self.angle = 0.5 * (low + high);
            let short = self.course(height)[1] < (1.0 - LEFT) * self.depth;
            if short { low = self.angle } else { high = self.angle }
        }
        self
    }

    /// How far up and how far in the piece has come `height` metres above where it begins to lean.
    fn course(&self, height: f64) -> [f64; 2] {
        let bent = height.min(BEND);
        let turned = self.angle * bent / BEND;
        // An arc; without an angle a straight line.
        let arc = if turned > 1e-9 { [turned.sin() / turned, (1.0 - turned.cos()) / turned] } else { [1.0, 0.0] };
        let straight = height - bent;
        [bent * arc[0] + straight * self.angle.cos(), bent * arc[1] + straight * self.angle.sin()]
    }

    /// How much lower than upright the piece ends, metres.
    fn fall(&self, height: f64) -> f64 {
        height - self.course(height)[0]
    }

    /// Where the point of height v goes that was at `p` on the upright ring, `off` metres off it: in towards the
    /// middle, but as much further off the body.
    pub(super) fn over(&self, p: Vec3, v: f64, off: f64) -> Vec3 {
        let height = (self.from - v).max(0.0);
        if height == 0.0 && self.furthest == 0.0 {
            return p;
        }
        let [up, inward] = self.course(height);
        let y = p.y - height + up;
        let (leaning, upright) = ((1.0 - inward / self.depth).max(0.0), 1.0 + OFF * height / self.depth);
        let tries = (0..=TRIES).map(|k| leaning + (upright - leaning) * k as f64 / TRIES as f64);
        let depth = p.z - self.middle;
        let leaning = tries.map(|share| share * depth);
        let away = (1..=(self.furthest / AWAY) as usize).map(|k| upright * depth + depth.signum() * AWAY * k as f64);
        let mut places = leaning.chain(away).map(|depth| Vec3::new(p.x, y, self.middle + depth));
        let clear = |at: &Vec3| self.body.nearest(*at, DEEPEST).is_none_or(|n| n.distance >= self.clear + off);
        places.find(clear).unwrap_or(Vec3::new(p.x, y, p.z))
    }
}

impl<'a> Ring<'a> {
    /// Lets the members lean over the shoulders, with so many layers `beneath` them; a row that hangs from no other is
    /// `free` to begin above them.
    pub(super) fn hang_from_shoulders(&mut self, body: &Mannequin, collider: &'a Collider, free: bool, beneath: i32) {
        let neck = body.part(PartKind::Neck).and_then(|p| p.sections.first());
        let shoulders = neck.map_or_else(|| self.stations.low(), |s| -s.center.y);
        let middle = self.stations.at(shoulders).center.z;
        let first = self.first_closed();
        let from = self.row.v[0] + first as f64 * LEVEL;
        let tops: Vec<f64> = self.row.members.iter().map(|m| self.top(m.piece) + m.shift.y).collect();
        let furthest = if self.levels.iter().any(|l| l.closed) { 0.0 } else { FURTHEST };
        let leans = |ring: &Self| -> Vec<Lean<'a>> {
            let depth = ring.axes()[first][1];
            let clear = CLEAR + LAYER * f64::from(beneath);
            let lean = Lean { body: collider, from, angle: 0.0, depth, middle, clear, furthest };
            tops.iter().map(|top| lean.clone().reaching((from - top).max(0.0))).collect()
        };
        self.leans = leans(self);
        if free {
            let falls = tops.iter().zip(&self.leans).map(|(top, lean)| top + lean.fall((from - top).max(0.0)));
            self.anchor = shoulders - LIFT - falls.fold(f64::INFINITY, f64::min);
            self.leave_arms(collider, from);
            // Where it begins the ring may be of another depth.
            self.leans = leans(self);
        }
    }

    /// Lowers the row to where least of its sides, under the armholes, is in the arms.
    fn leave_arms(&mut self, body: &Collider, from: f64) {
        let mut best = (usize::MAX, self.anchor);
        for _ in 0..STEPS {
            let inside = self.inside(body, [from, from + UNDERARM]);
            if inside < best.0 {
                best = (inside, self.anchor);
            }
            if inside == 0 {
                break;
            }
            self.anchor += STEP;
        }
        self.anchor = best.1;
    }

    /// Makes the rings deep instead of wide where less of the row then starts in the body, arms included.
    pub(super) fn keep_between(&mut self, arms: &'a Arms, body: &Collider) {
        let from = self.row.v[0] + self.first_closed() as f64 * LEVEL;
        let within = [from, self.row.v[1]];
        let wide = self.inside(body, within);
        if wide > 0 {
            self.between = Some(arms);
            self.between = self.between.filter(|_| self.inside(body, within) < wide);
        }
    }

    /// How many particles between two values of v are in the body or touch it.
    fn inside(&self, body: &Collider, [low, high]: [f64; 2]) -> usize {
        let mut trial =
            Self { leans: Vec::new(), levels: self.levels.clone(), stations: self.stations.clone(), ..*self };
        let mut x = vec![Vec3::zeros(); self.mesh.flat.len()];
        trial.bend(self.axes(), &[], &mut x);
        let there = |m: &Member| {
            let range = self.mesh.pieces[m.piece].particles.clone();
            let shift = m.shift.y;
            range.filter(move |&p| (low..high).contains(&(self.sheet.flat[p].y + shift)))
        };
        let touches = |p: &usize| body.nearest(x[*p], DEEPEST).is_some_and(|n| n.distance < CLEAR);
        self.row.members.iter().flat_map(there).filter(touches).count()
    }

    /// Lowest v of a piece as it is drawn: its highest place.
    fn top(&self, piece: usize) -> f64 {
        extent(self.mesh, self.sheet, piece)[0].y
    }
}
