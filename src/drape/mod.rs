//! Draping: the sewn garment falls to rest in its fabric (L7–L11). An example is in [`crate::guide::drape`].

pub mod geometric;
mod rest;

pub use rest::{DRIFT, DrapeError, DrapeOptions, Draped, RESIDUAL, Until, check_fall, drape};
