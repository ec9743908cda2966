//! Internal lines: which of them become chains of springs, where they meet the rim and each other.

use super::course::{Course, PieceGround};
use super::crossings::{Chords, REACHES};
use super::links::EdgeTable;
use super::sampling::springs_for;
use crate::geometry::{Path, Vec2};
use crate::pattern::{Along, EdgeId, Garment, LineKind, Piece};

/// The lines of a piece, ready to be sampled.
pub(super) struct LinePlan {
    /// Parts of lines that bend or gather the cloth and run across it, in the piece's order.
    pub(super) lines: Vec<PlannedLine>,
    /// Parts of such lines that run along edges.
    pub(super) rim: Vec<RimLine>,
    /// Places where lines meet.
    pub(super) knots: Vec<Vec2>,
}

/// A part of a line along edges, whose particles it shares.
pub(super) struct RimLine {
    /// The line's number in [`Piece::lines`].
    pub(super) number: usize,
    /// Arc length of the line where the part begins.
    pub(super) at: f64,
    /// Edge number, and arc lengths from where to where.
    pub(super) stretches: Vec<(usize, [f64; 2])>,
}

/// A part of a line across the cloth and the places where it must have a particle.
pub(super) struct PlannedLine {
    /// The line's number in [`Piece::lines`].
    pub(super) number: usize,
    /// Arc length of the line where the part begins.
    pub(super) at: f64,
    /// Its course.
    pub(super) path: Path,
    /// Sorted along the line. The ends are the first and the last.
    pub(super) stops: Vec<Stop>,
    /// Springs between neighbouring stops.
    pub(super) springs: Vec<usize>,
}

/// A place on a line that must have a particle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    /// Arc length along the line.
    pub(super) at: f64,
    /// Edge number and arc length, where the line joins the rim.
    pub(super) rim: Option<(usize, f64)>,
    /// Number in [`LinePlan::knots`], where it joins another line.
    pub(super) knot: Option<usize>,
}

impl LinePlan {
    /// Plans the lines of piece `number`.
    pub(super) fn new(garment: &Garment, number: usize, edges: &EdgeTable, spacing: f64) -> Self {
        let piece = &garment.pieces[number];
        let mut plan = Self { lines: Vec::new(), rim: Vec::new(), knots: Vec::new() };
        let ground = PieceGround::new(piece);
        for (n, line) in piece.lines.iter().enumerate().filter(|(_, l)| !matches!(l.kind, LineKind::Mark(_))) {
            for course in ground.courses(&line.path) {
                match course {
                    Course::Across { at, path } => plan.lines.push(PlannedLine {
                        number: n,
                        at,
                        stops: [0.0, path.length()]
                            .map(|at| Stop { at, rim: rim_at(piece, number, edges, path.point(at)), knot: None })
                            .to_vec(),
                        path,
                        springs: Vec::new(),
                    }),
                    Course::Rim(chain) => plan.rim.extend(RimLine::new(n, number, edges, &chain)),
                }
            }
        }
        plan.meet();
        for line in &mut plan.lines {
            line.springs = line.stops.windows(2).map(|w| springs_for(w[1].at - w[0].at, spacing)).collect();
        }
        plan
    }

    /// Rim places the lines ask for.
    pub(super) fn rim_seeds(&self) -> impl Iterator<Item = (usize, f64)> {
        let ends = self.lines.iter().flat_map(|l| l.stops.iter().filter_map(|s| s.rim));
        ends.chain(self.rim.iter().flat_map(|l| &l.stretches).flat_map(|&(edge, ends)| ends.map(|s| (edge, s))))
    }

    /// Finds where lines end on each other or cross.
    fn meet(&mut self) {
        let paths: Vec<Path> = self.lines.iter().map(|l| l.path.clone()).collect();
        let chords: Vec<Chords> = paths.iter().map(Chords::new).collect();
        for i in 0..self.lines.len() {
            for j in 0..self.lines.len() {
                if i != j {
                    self.ends_on(i, j);
                }
                if i < j {
                    for (s, t) in chords[i].crossings(&chords[j]) {
                        self.tie(i, s, j, t);
                    }
                }
            }
        }
    }

    /// Ties the free ends of line `i` to line `j` where they reach it.
    fn ends_on(&mut self, i: usize, j: usize) {
        for at in [0.0, self.lines[i].path.length()] {
            let (t, distance) = self.lines[j].path.nearest(self.lines[i].path.point(at));
            if distance <= REACHES {
                self.tie(i, at, j, t);
            }
        }
    }

    /// Makes line `i` at `s` and line `j` at `t` share a particle, unless the rim already gives them one there.
    fn tie(&mut self, i: usize, s: f64, j: usize, t: f64) {
        let (a, b) = (self.lines[i].stop_near(s), self.lines[j].stop_near(t));
        let on_rim = |l: &PlannedLine, k: Option<usize>| k.is_some_and(|k| l.stops[k].rim.is_some());
        if on_rim(&self.lines[i], a) || on_rim(&self.lines[j], b) {
            return;
        }
        let known = |l: &PlannedLine, k: Option<usize>| k.and_then(|k| l.stops[k].knot);
        let knot = known(&self.lines[i], a).or_else(|| known(&self.lines[j], b)).unwrap_or_else(|| {
            self.knots.push(self.lines[j].path.point(t));
            self.knots.len() - 1
        });
        self.lines[i].set_knot(s, a, knot);
        self.lines[j].set_knot(t, b, knot);
    }
}

impl RimLine {
    /// Along these edges of piece `piece`.
    fn new(number: usize, piece: usize, edges: &EdgeTable, chain: &[Along]) -> Option<Self> {
        let stretch = |along: &Along| {
            let (ring, index) = along.edge;
            Some((edges.number(EdgeId { piece, ring, index })?, [along.from, along.to]))
        };
        let stretches = chain.iter().map(stretch).collect::<Option<_>>()?;
        Some(Self { number, at: chain.first()?.line[0], stretches })
    }
}

impl PlannedLine {
    fn stop_near(&self, s: f64) -> Option<usize> {
        self.stops.iter().position(|stop| (stop.at - s).abs() <= REACHES)
    }

    fn set_knot(&mut self, s: f64, stop: Option<usize>, knot: usize) {
        match stop {
            Some(k) => self.stops[k].knot = Some(knot),
            None => {
                let k = self.stops.partition_point(|stop| stop.at < s);
                self.stops.insert(k, Stop { at: s, rim: None, knot: Some(knot) });
            }
        }
    }
}

/// Place where point `p` meets the rim, if it is within reach. A corner within reach is preferred, to avoid tiny
/// springs.
fn rim_at(piece: &Piece, number: usize, edges: &EdgeTable, p: Vec2) -> Option<(usize, f64)> {
    let mut best: Option<(f64, usize, f64)> = None;
    for (ring, loop_edges) in piece.loops.iter().enumerate() {
        for (index, edge) in loop_edges.iter().enumerate() {
            let (mut s, distance) = edge.path.nearest(p);
            if distance > REACHES || best.is_some_and(|b| b.0 <= distance) {
                continue;
            }
            let length = edge.path.length();
            if s < REACHES {
                s = 0.0;
            } else if s > length - REACHES {
                s = length;
            }
            best = edges.number(EdgeId { piece: number, ring, index }).map(|e| (distance, e, s)).or(best);
        }
    }
    best.map(|(_, edge, s)| (edge, s))
}
