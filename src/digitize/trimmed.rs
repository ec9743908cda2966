//! Lines on a piece that are drawn on into its allowance: of these its cloth has the part within the sewing line.

use crate::geometry::{Path, Vec2, bisect};

/// A line is looked at this often, metres, and no oftener than so many times.
const STEP: f64 = 5e-3;
const MOST_LOOKS: f64 = 400.0;
/// The place where it leaves the cloth is found in so many halvings, far below a micrometre.
const HALVINGS: usize = 24;

/// A line, whose middle is on the cloth, which `holds` tells, without the ends that are not. Over darts and holes it
/// goes on.
pub(super) fn trimmed(line: &Path, holds: impl Fn(Vec2) -> bool) -> Path {
    let length = line.length();
    let looks = (0.5 * length / STEP).clamp(2.0, MOST_LOOKS).ceil();
    // How far from its middle it comes to an end in one direction.
    let reach = |sign: f64| {
        let at = |way: f64| line.point(0.5 * length + sign * way);
        let way = |k: usize| 0.5 * length * k as f64 / looks;
        let last = (1..=looks as usize).rev().find(|&k| holds(at(way(k)))).unwrap_or(0);
        let ends = last < looks as usize;
        ends.then(|| bisect([way(last), way(last + 1)], HALVINGS, |way| if holds(at(way)) { -1.0 } else { 1.0 }))
    };
    match [reach(-1.0), reach(1.0)] {
        [None, None] => line.clone(),
        [back, on] => line.part(0.5 * length - back.unwrap_or(0.5 * length), 0.5 * length + on.unwrap_or(0.5 * length)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_where_the_cloth_does() {
        let line = Path::line(Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0));
        assert_eq!(trimmed(&line, |_| true).length(), line.length());
        let part = trimmed(&line, |p| (0.123..=0.8).contains(&p.x));
        assert!((part.start().x - 0.123).abs() < 1e-6 && (part.end().x - 0.8).abs() < 1e-6, "{part:?}");
        let part = trimmed(&line, |p| p.x <= 0.9 && !(0.2..0.3).contains(&p.x));
        assert!(part.start().x == 0.0 && (part.end().x - 0.9).abs() < 1e-6, "{part:?}");
    }
}
