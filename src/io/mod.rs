//! Formats, in and out; no stage reads or writes one itself.

pub mod garment;
