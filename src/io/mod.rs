//! Reading and writing formats.

pub mod body;
pub mod obj_read;
