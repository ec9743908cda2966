//! The edge of the house: files in and out. No stage reads or writes a file itself.

pub mod body;
pub mod files;
pub mod garment;
pub mod obj_read;
pub mod obj_write;
pub mod pattern_svg;
