//! **toile** sews flat pattern pieces onto a mannequin, drapes them in a measured fabric and lays them flat again,
//! and says at every step what it did to the cloth.
//!
//! ```text
//! pattern file ─▶ pattern ─▶ mesh ─▶ sew ─▶ drape ─▶ flatten ─▶ files out
//!  (YAML)         checked     regular   spring-   measured-   plane      OBJ · SVG · PNG · report
//!                 pieces,     grids     mass,     fabric
//!                 seams                 contact   energy
//!                    ▲          mannequin ┘  └ fabric
//! ```
//!
//! Every stage is a plain function from its input to its output and a report of what happened; nothing is global,
//! and the result is the same bytes for any number of threads. Lengths are metres, masses kilograms and forces
//! newtons; files speak millimetres.

pub mod cli;
pub mod contact;
pub mod cutting;
pub mod digitize;
pub mod drape;
pub mod dynamics;
pub mod fabric;
pub mod flatten;
pub mod geometry;
pub mod input;
pub mod io;
pub mod linear;
pub mod mannequin;
pub mod mesh;
pub mod pattern;
pub mod picture;
pub mod pipeline;
pub mod report;
pub mod sew;
pub mod specimen;
pub mod verify;
