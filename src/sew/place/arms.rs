//! The room that the arms leave the trunk's ring.

use crate::geometry::Vec3;
use crate::mannequin::{HAND_OR_FOOT, Mannequin, Section};

/// Arms are looked at this often along their axes, metres.
const STEP: f64 = 0.005;

/// Where the arms are: balls along their axes, hands included.
pub(super) struct Arms {
    balls: Vec<(Vec3, f64)>,
}

impl Arms {
    /// Those of a body; none if it has no arms.
    pub(super) fn of(body: &Mannequin) -> Self {
        let mut balls = Vec::new();
        for arm in body.parts.iter().filter(|part| part.kind.is_arm()) {
            let radius = |s: &Section| s.half_width.max(s.half_depth);
            for (a, b) in arm.sections.iter().zip(arm.sections.iter().skip(1)) {
                let ball = |t: f64| (a.center.lerp(&b.center, t), radius(a) + t * (radius(b) - radius(a)));
                let steps = ((b.center - a.center).norm() / STEP).ceil().max(1.0);
                balls.extend((0..steps as usize).map(|k| ball(k as f64 / steps)));
            }
            if let Some(wrist) = arm.sections.last() {
                let radius = radius(wrist);
                let along = (0..=(HAND_OR_FOOT / STEP) as usize).map(|k| wrist.center + wrist.axis * (STEP * k as f64));
                balls.extend(along.map(|center| (center, radius)));
            }
        }
        Self { balls }
    }

    /// How far to either side of `x` nothing of them is at height `y`, metres; infinite where they do not reach.
    pub(super) fn room(&self, x: f64, y: f64) -> f64 {
        let inner = |(center, radius): &(Vec3, f64)| {
            let chord = radius * radius - (center.y - y).powi(2);
            (chord > 0.0).then(|| (center.x - x).abs() - chord.sqrt())
        };
        self.balls.iter().filter_map(inner).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mannequin::load;

    #[test]
    fn the_room_is_what_is_left_between_the_arms() {
        let body = load("woman_92").expect("shipped");
        let arms = Arms::of(&body);
        // Over the shoulders and under the hands there is no arm.
        assert!(arms.room(0.0, 1.6).is_infinite() && arms.room(0.0, 0.2).is_infinite());
        let heights = [1.2, 1.1, 1.0, 0.9];
        let rooms = heights.map(|y| arms.room(0.0, y));
        assert!(rooms.is_sorted(), "arms stand off the trunk: {rooms:?}");
        for (y, room) in heights.into_iter().zip(rooms) {
            let inner = body.mesh.vertices.iter().filter(|p| (p.y - y).abs() < 0.01 && p.x > 0.5 * room);
            // The skin of an arm, seen from the trunk; the trunk's own is nearer.
            let skin = inner.map(|p| p.x).filter(|x| *x > room - 0.02).fold(f64::INFINITY, f64::min);
            assert!((skin - room).abs() < 0.02, "{room} at {y}, the skin at {skin}");
        }
    }
}
