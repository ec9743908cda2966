//! Formats at the edge of the program.

pub mod pattern_svg;
