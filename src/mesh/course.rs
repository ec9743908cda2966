//! The course of a line over edges, cloth, and the open mouth of a dart or a hole.

use super::crossings::{Chords, REACHES};
use crate::geometry::Path;
use crate::pattern::{Along, Piece, Region, along};

/// Least length of a part of a line, metres. Each end of a shorter part may be off by the reach of a line's end.
const NEAR: f64 = 2.0 * REACHES;

/// A part of a line that the mesh can follow.
pub(super) enum Course {
    /// Across the cloth, from arc length `at` of the line.
    Across {
        /// Arc length of the line where it begins, metres.
        at: f64,
        /// Its way.
        path: Path,
    },
    /// Along edges, each going on where the one before it ends.
    Rim(Vec<Along>),
}

/// The ground that the lines of a piece run over.
pub(super) struct PieceGround<'a> {
    piece: &'a Piece,
    cloth: Region<'a>,
    /// Chords of all its edges.
    rim: Vec<Chords<'a>>,
}

impl Course {
    /// Arc lengths of the line where it begins and ends.
    fn ends(&self) -> [f64; 2] {
        match self {
            Self::Across { at, path } => [*at, at + path.length()],
            Self::Rim(chain) => [chain[0].line[0], chain[chain.len() - 1].line[1]],
        }
    }
}

impl<'a> PieceGround<'a> {
    pub(super) fn new(piece: &'a Piece) -> Self {
        let rim = piece.loops.iter().flatten().map(|edge| Chords::new(&edge.path)).collect();
        Self { piece, cloth: Region::new(&piece.loops), rim }
    }

    /// The parts of a line that lie on cloth, in the order of the line. A line runs through darts, which seams close,
    /// and over holes. A line that begins or ends off the cloth is kept whole, so that it is reported.
    pub(super) fn courses(&self, line: &Path) -> Vec<Course> {
        let mut out = Vec::new();
        let mut reached = 0.0;
        for stretch in along(line, &self.piece.loops) {
            out.extend(self.across(line, [reached, stretch.line[0]]));
            reached = stretch.line[1].max(reached);
            match out.last_mut() {
                Some(Course::Rim(chain)) if chain.last().is_some_and(|last| goes_on(self.piece, last, &stretch)) => {
                    chain.push(stretch);
                }
                _ => out.push(Course::Rim(vec![stretch])),
            }
        }
        out.extend(self.across(line, [reached, line.length()]));
        let begins = out.first().map_or(f64::INFINITY, |course| course.ends()[0]);
        let ends = out.last().map_or(0.0, |course| course.ends()[1]);
        if begins > NEAR || ends < line.length() - NEAR {
            return vec![Course::Across { at: 0.0, path: line.clone() }];
        }
        out
    }

    /// The parts of a line between two of its arc lengths that lie on cloth: it is cut where it crosses the rim.
    fn across(&self, line: &Path, [from, to]: [f64; 2]) -> Vec<Course> {
        if to - from <= NEAR {
            return Vec::new();
        }
        let whole = from <= 0.0 && to >= line.length();
        let part = if whole { line.clone() } else { line.part(from, to) };
        let length = part.length();
        let chords = Chords::new(&part);
        let met = self.rim.iter().flat_map(|edge| chords.crossings(edge)).map(|(s, _)| s);
        let inner = met.filter(|s| (REACHES..=length - REACHES).contains(s));
        let mut cuts: Vec<f64> = [0.0, length].into_iter().chain(inner).collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|b, a| *b - *a < REACHES);
        let kept = cuts.windows(2).filter(|w| self.cloth.holds(part.point((w[0] + w[1]) / 2.0)));
        let path = |w: &[f64]| if cuts.len() == 2 { part.clone() } else { part.part(w[0], w[1]) };
        kept.map(|w| Course::Across { at: from + w[0], path: path(w) }).collect()
    }
}

/// Whether a stretch begins in the point where the last one ends.
fn goes_on(piece: &Piece, last: &Along, next: &Along) -> bool {
    let point = |stretch: &Along, s: f64| piece.loops[stretch.edge.0][stretch.edge.1].path.point(s);
    (point(last, last.to) - point(next, next.from)).norm() <= REACHES
}
