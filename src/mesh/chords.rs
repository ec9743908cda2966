//! Chords: inner springs from rim to rim. They make corners stiff, and one between particles that are stitched
//! together would vanish when the seam closes.

use super::improve::Improver;
use super::shape::quality_of_degrees;

/// Least angle after a chord is turned or split, degrees.
const FINE: f64 = 22.0;

/// The particles of both sides of a seam within one piece, sorted.
pub(super) struct SelfSeam(pub(super) [Vec<u32>; 2]);

impl SelfSeam {
    fn joins(&self, a: u32, b: u32) -> bool {
        let on = |side: usize, v: u32| self.0[side].binary_search(&v).is_ok();
        (on(0, a) && on(1, b)) || (on(0, b) && on(1, a))
    }
}

impl Improver<'_> {
    /// Removes chords where that leaves good triangles, and in any case those between two sides of one seam.
    pub(super) fn part_chords(&mut self, self_seams: &[SelfSeam]) {
        for (a, b) in self.chords() {
            let must = self_seams.iter().any(|s| s.joins(a, b));
            if !self.turn_chord(a, b, must) {
                self.split_chord(a, b, must);
            }
        }
    }

    /// Ends of all chords.
    fn chords(&self) -> Vec<(u32, u32)> {
        let mut out = Vec::new();
        for t in self.patch.alive() {
            let v = self.patch.corners(t);
            for k in 0..3 {
                let (a, b) = (v[(k + 1) % 3], v[(k + 2) % 3]);
                if a < b && b < self.rim && self.patch.partner(t, k).is_some() {
                    out.push((a, b));
                }
            }
        }
        out
    }

    fn turn_chord(&mut self, a: u32, b: u32, must: bool) -> bool {
        let Some((t, k)) = self.side(a, b) else { return true };
        let least = if must { 0.0 } else { quality_of_degrees(FINE) };
        let Some(turn) = self.turned(t, k).filter(|turn| turn.after > least) else { return false };
        self.patch.replace(&[t, turn.other], &turn.new);
        true
    }

    fn split_chord(&mut self, a: u32, b: u32, must: bool) {
        let Some((t, k)) = self.side(a, b) else { return };
        let Some(other) = self.patch.partner(t, k) else { return };
        self.patch.begin();
        let m = self.split(t, other, k);
        self.settle(m);
        let fine = quality_of_degrees(FINE);
        self.patch
            .end(|before, after| after.worst > fine || after.worst >= before.worst || (must && after.worst > 0.0));
    }

    /// The triangle that has `a`–`b` as its turnable side `k`.
    fn side(&self, a: u32, b: u32) -> Option<(u32, usize)> {
        let [t, _] = self.patch.beside(a, b)?;
        let v = self.patch.corners(t);
        let k = v.iter().position(|&x| x != a && x != b)?;
        Some((t, k))
    }
}
