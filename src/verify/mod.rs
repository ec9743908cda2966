//! Independent checks of the program's own results.
//!
//! Nothing here is shared with the solver's contact code: other trees, other predicates, other definitions. A mistake
//! there cannot hide itself here.
//!
//! - [`crossings`]: pairs of cloth triangles that cross
//! - [`crossings_between`]: cloth triangles that cross the body
//! - [`inside`]: points inside a closed body, and their depth
//! - [`distances`]: how far points are from a body
//! - [`ring`]: the ring of cloth round a part of the body, in a plane
//! - [`Layers`]: the layers of cloth on a line through it
//! - [`worn`]: the body part that passes through each rim of the garment
//! - [`Welded`]: the garment as one surface, with seam partners made one vertex

mod bvh;
mod crossing;
mod inside;
mod layers;
mod linking;
mod orient;
mod section;
mod welded;
mod worn;

pub use crossing::{Between, crossings, crossings_between};
pub use inside::{Inside, distances, inside};
pub use layers::{Layer, Layers};
pub use section::{ClothRing, CutPoint, ring};
pub use welded::Welded;
pub use worn::{Passage, Through, is_dealt, past_end, worn};
