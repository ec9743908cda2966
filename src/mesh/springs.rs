//! Springs by their direction in the cloth (F1).

use super::{ClothMesh, PieceMesh};
use crate::geometry::{Topology, Vec2};

/// A spring within this angle (radians; 10°) of a thread direction pulls on those threads; others shear the cloth.
const ALONG_THREADS: f64 = 0.1745;

/// Which threads a spring pulls on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpringClass {
    /// Along the warp.
    Warp,
    /// Along the weft.
    Weft,
    /// Neither: it shears the weave.
    Bias,
}

/// A mesh edge as a spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spring {
    /// Its particles, the smaller number first.
    pub ends: [u32; 2],
    /// Its direction in the flat piece.
    pub class: SpringClass,
}

impl ClothMesh {
    /// Every mesh edge once, sorted by its ends, with the class of its direction in the flat piece: within 10° of
    /// warp or weft, else bias.
    pub fn edge_classes(&self) -> Vec<Spring> {
        let piece_springs = |piece: &PieceMesh| {
            let edges = Topology::new(&self.triangles[piece.triangles.clone()]).edges;
            let warp = piece.warp;
            edges.into_iter().map(move |edge| {
                let [a, b] = edge.ends.map(|v| self.flat[v as usize]);
                Spring { ends: edge.ends, class: class_of(b - a, warp) }
            })
        };
        self.pieces.iter().flat_map(piece_springs).collect()
    }
}

/// Class of a spring with this flat course.
fn class_of(course: Vec2, warp: Vec2) -> SpringClass {
    let (along, across) = (course.dot(&warp).abs(), course.perp(&warp).abs());
    let slope = ALONG_THREADS.tan();
    if across <= slope * along {
        SpringClass::Warp
    } else if along <= slope * across {
        SpringClass::Weft
    } else {
        SpringClass::Bias
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
            assert_eq!(class_of(0.01 * degrees(course), degrees(grain)), class, "grain {grain}, course {course}");
        }
    }
}
