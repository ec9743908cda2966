//! The ground floor: vectors, curves, rows of points, triangle meshes, disjoint sets, exact predicates.

mod arc;
mod bend;
mod bisect;
mod curve;
mod decimate;
mod extent;
mod fit;
mod letters;
mod locator;
mod path_text;
mod polygon;
mod polyline;
mod predicate;
mod segment;
mod sets;
mod trimesh;

pub(crate) use arc::bulged;
pub use bend::Shift;
pub(crate) use bisect::{bisect, try_bisect};
pub use curve::{Path, Station};
pub(crate) use decimate::decimated;
pub(crate) use extent::{box_of, box_or_origin, range_of};
pub use fit::{Cubic, smooth_curves};
pub(crate) use letters::{CAPITAL_CELLS, LetterStrokes, from_left, letter_strokes};
pub(crate) use locator::Locator;
pub use path_text::{PathError, parse_transform};
pub(crate) use polygon::{diagonals_of, triangles_of};
pub(crate) use polyline::{encloses, half_hull, mirrored, shares_along, sides_of};
pub(crate) use predicate::pierces;
pub(crate) use segment::{distance_to_segment, nearest_on_segment};
pub(crate) use sets::DisjointSets;
pub(crate) use trimesh::sorted_pair;
pub use trimesh::{MeshEdge, Topology, TriMesh, rim_loops};

/// Millimetres in a metre: lengths are metres inside and millimetres in files.
pub(crate) const MM: f64 = 1e3;

/// Kilopascals in a pascal: pressures are pascals inside and kilopascals in files.
pub(crate) const KPA: f64 = 1e-3;

/// A point or direction in a flat piece, metres, y **down**, the right side of the cloth facing the reader.
pub type Vec2 = nalgebra::Vector2<f64>;
/// A point or direction in space, metres, y **up**. The mannequin faces +z and its left hand is at +x.
pub type Vec3 = nalgebra::Vector3<f64>;
/// A 3×3 matrix.
pub type Mat3 = nalgebra::Matrix3<f64>;
