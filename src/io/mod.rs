//! The edge of the house: files in and out. No stage reads or writes a file itself.

pub mod body;
mod dxf_block;
mod dxf_curves;
mod dxf_flat;
mod dxf_left_out;
mod dxf_library;
mod dxf_notches;
mod dxf_piece;
pub mod dxf_read;
mod dxf_rim;
mod dxf_sizes;
mod dxf_slits;
mod dxf_text;
mod dxf_told;
pub mod dxf_write;
mod encoding;
pub mod files;
pub mod garment;
pub mod garmentcode;
pub mod glb_write;
pub mod lines_read;
pub mod obj_read;
pub mod obj_write;
pub mod pdf_write;
pub mod surface_read;
pub mod svg_read;
pub mod svg_write;
