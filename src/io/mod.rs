//! io

pub mod obj_write;
