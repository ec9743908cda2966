//! Springs by their direction in the cloth (F1).

use crate::geometry::Vec2;

/// Largest angle between a spring and a thread at which the spring pulls on that thread, radians (10°). The mesh needs
/// this play near curved rims. Other springs shear the cloth.
const ALONG_THREADS: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// The threads along which a spring pulls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpringClass {
    /// Along the warp.
    Warp,
    /// Along the weft.
    Weft,
    /// Neither: it shears the weave.
    Bias,
}

impl SpringClass {
    /// That of a spring with this flat course, in a piece with this warp.
    pub fn of(course: Vec2, warp: Vec2) -> Self {
        let (along, across) = (course.dot(&warp).abs(), course.perp(&warp).abs());
        let slope = ALONG_THREADS.tan();
        if across <= slope * along {
            Self::Warp
        } else if along <= slope * across {
            Self::Weft
        } else {
            Self::Bias
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn springs_are_classed_against_the_grain() {
        let degrees = |a: f64| Vec2::new(a.to_radians().cos(), a.to_radians().sin());
        for (grain, course, class) in [
            (90.0, 81.0, SpringClass::Warp),
            (90.0, 270.0, SpringClass::Warp),
            (90.0, 9.0, SpringClass::Weft),
            (90.0, 45.0, SpringClass::Bias),
            (90.0, 78.0, SpringClass::Bias),
            (45.0, 45.0, SpringClass::Warp),
            (45.0, 135.0, SpringClass::Weft),
            (45.0, 90.0, SpringClass::Bias),
        ] {
            assert_eq!(
                SpringClass::of(0.01 * degrees(course), degrees(grain)),
                class,
                "grain {grain}, course {course}"
            );
        }
    }
}
