//! io

pub mod files;
pub mod obj_write;
