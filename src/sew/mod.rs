//! Sewing: pieces placed round the body, seams drawn shut, stitched (F2–F11, F14).

pub mod place;
