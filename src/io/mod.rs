//! io

pub mod pattern_svg;
