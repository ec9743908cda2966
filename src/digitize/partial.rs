//! Cut lines that are drawn only where they leave the sewing line, as FreeSewing draws them beside edges without
//! allowance.

use crate::geometry::Path;

/// Distance from the sewing line within which such a line must begin and end, metres: rounding of programs.
const ON_LINE: f64 = 5e-4;
/// Gaps and stretches no longer than this (metres) are none.
const NOTHING: f64 = 1e-7;

/// A drawn part of a cut line and the stretch of the sewing line that it runs along, as arc lengths: the second is
/// past the whole length where the stretch goes over the sewing line's start.
struct DrawnPart {
    from: f64,
    to: f64,
    line: Path,
}

impl DrawnPart {
    fn new(sewn: &Path, line: &Path) -> Option<Self> {
        let whole = sewn.length();
        let [start, middle, end] = [0.0, 0.5, 1.0].map(|share| sewn.nearest(line.point(line.length() * share)));
        if start.1 > ON_LINE || end.1 > ON_LINE {
            return None;
        }
        let ahead = |from: f64, to: f64| (to - from).rem_euclid(whole);
        let forward = ahead(start.0, middle.0) < ahead(start.0, end.0);
        let [from, to] = if forward { [start.0, end.0] } else { [end.0, start.0] };
        let line = if forward { line.clone() } else { line.reversed() };
        Some(Self { from, to: from + ahead(from, to), line })
    }
}

/// The whole cut line: the drawn parts, and the sewing line between them. `None` if a part does not begin and end on
/// the sewing line, or two lie beside the same stretch of it.
pub(super) fn completed(sewn: &Path, drawn: &[Path]) -> Option<Path> {
    let whole = sewn.length();
    let mut parts: Vec<DrawnPart> = drawn.iter().map(|line| DrawnPart::new(sewn, line)).collect::<Option<_>>()?;
    parts.sort_by(|a, b| a.from.total_cmp(&b.from));
    let first = parts.first()?.from;
    let next = |k: usize| parts.get(k + 1).map_or(first + whole, |part| part.from);
    if parts.iter().enumerate().any(|(k, part)| part.to > next(k) + ON_LINE) {
        return None;
    }
    let mut lines = Vec::new();
    for (k, part) in parts.iter().enumerate() {
        lines.push(part.line.clone());
        let stretches = [[part.to, next(k).min(whole)], [(part.to - whole).max(0.0), next(k) - whole]];
        let long = stretches.into_iter().filter(|[from, to]| to - from > NOTHING);
        lines.extend(long.map(|[from, to]| sewn.part(from, to)));
    }
    lines.into_iter().reduce(|line, more| {
        let gap = (more.start() - line.end()).norm() > NOTHING;
        let line = if gap { line.joined(&Path::line(line.end(), more.start())) } else { line };
        line.joined(&more)
    })
}
