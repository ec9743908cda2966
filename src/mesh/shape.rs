//! Angles of flat triangles, and a score to compare meshes.

use crate::geometry::Vec2;

/// Smallest angle below which a triangle is poor, degrees. It is then worth adding or removing a particle.
pub(super) const POOR: f64 = 28.0;
/// Least factor by which a change must improve the score.
pub(super) const GAIN: f64 = 1.03;

/// Squared sine of a triangle's smallest angle, negative when it is turned over: zero at a sliver, 3/4 at best.
pub(super) fn quality(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let double_area = (b - a).perp(&(c - a));
    let (x, y, z) = ((b - a).norm_squared(), (c - b).norm_squared(), (a - c).norm_squared());
    // The smallest angle lies between the two longest sides.
    let product = if x <= y && x <= z {
        y * z
    } else if y <= z {
        x * z
    } else {
        x * y
    };
    double_area * double_area.abs() / product
}

/// The quality of a triangle whose smallest angle is this many degrees.
pub(super) fn quality_of_degrees(degrees: f64) -> f64 {
    degrees.to_radians().sin().powi(2)
}

/// Quality of a set of triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Score {
    /// Worst quality.
    pub(super) worst: f64,
    /// Sum of the missing quality of all poor triangles.
    pub(super) lack: f64,
}

impl Score {
    /// No triangle yet.
    pub(super) const PERFECT: Self = Self { worst: 1.0, lack: 0.0 };

    /// Counts one more triangle.
    pub(super) fn with(self, quality: f64) -> Self {
        let lack = (quality_of_degrees(POOR) - quality).max(0.0);
        Self { worst: self.worst.min(quality), lack: self.lack + lack }
    }

    /// Whether a change to this was worth it: a better worst triangle, or the same and clearly less poor ones.
    /// Both thresholds keep two states from changing into each other for ever.
    pub(super) fn improves(self, before: Self) -> bool {
        self.worst > GAIN * before.worst || (self.worst >= before.worst && GAIN * self.lack < before.lack)
    }
}

/// Smallest angle of all triangles, radians (π when there are none).
pub(super) fn smallest_angle(points: &[Vec2], triangles: &[[u32; 3]]) -> f64 {
    let angles = |t: &[u32; 3]| {
        let p = t.map(|v| points[v as usize]);
        let angle = |k: usize| (p[(k + 1) % 3] - p[k]).angle(&(p[(k + 2) % 3] - p[k]));
        angle(0).min(angle(1)).min(angle(2))
    };
    triangles.iter().map(angles).fold(std::f64::consts::PI, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quality_is_the_squared_sine_of_the_smallest_angle() {
        let at = |x: f64, y: f64| Vec2::new(x, y);
        let right = quality(at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0));
        assert!((right - quality_of_degrees(45.0)).abs() < 1e-12);
        assert!(quality(at(0.0, 0.0), at(0.0, 1.0), at(1.0, 0.0)) < 0.0);
    }
}
