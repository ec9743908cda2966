//! drape
