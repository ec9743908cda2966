//! sew
