//! **toile** sews flat pattern pieces onto a mannequin, drapes them in a measured fabric and lays them flat again. Each
//! stage reports how it changed the cloth.
//!
//! ```text
//! pattern file ─▶ pattern ─▶ mesh ─▶ sew ─▶ drape ─▶ flatten ─▶ files out
//!  (YAML)         checked     regular   spring-   measured-   plane      OBJ · SVG · PNG · report
//!                 pieces,     grids     mass,     fabric
//!                 seams                 contact   energy
//!                    ▲          mannequin ┘  └ fabric
//! ```
//!
//! Every stage is a plain function from its input to its output and a report. Nothing is global, and the result is the
//! same bytes for any number of threads. Lengths are metres, masses kilograms and forces newtons. Files use
//! millimetres.
//!
//! # Use as a library
//! [`guide`] has a page per stage, each with an example that runs. [`pipeline::Job`] and [`pipeline::Run`] take a
//! garment file through all stages. `examples/embed.rs` builds a garment in code and calls the stages one by one.
//!
//! # The papers
//! Two papers are implemented here, and their parts are named by letter and number throughout.
//!
//! **F**: J. Fan, C. Zhou, Q. Wang and M. Yuen, *2D/3D isometric transformation using a spring-mass system* (1999).
//!
//! | | |
//! |---|---|
//! | F1 | a piece as a regular grid of particles and springs |
//! | F2, F3 | motion, equation (1); springs, (2) and (3) |
//! | F4 | stiffness by the measured load-extension curve, piece by piece |
//! | F5–F7 | forces of sewing (4), contact (5) and gravity (6) |
//! | F8, F9 | explicit steps, (7) to (14); as long as stability allows |
//! | F10, F11 | where pieces start; when sewing ends |
//! | F12, F13 | flattening: a start, and springs in the plane |
//! | F14, F15 | test of a moving particle against a triangle, (15); Table 1 |
//!
//! **L**: Q. Liu, R. Wang and X. Luo, *Realistic cloth simulation based on geometrical measurement and deformation*
//! (2015).
//!
//! | | |
//! |---|---|
//! | L1, L2 | fifteen fabrics; three measurements of each |
//! | L3–L6 | measures (1), normalised (2), regression (3), weights (8) |
//! | L7–L10 | energies of recovery (4), stretch (5) and bending (6), and their sum (7) |
//! | L11 | solver: linearised least squares with one factor |
//! | L12–L17 | Figures 4 to 10 and Table 3 |

pub mod alter;
pub mod batch;
pub mod cli;
pub mod contact;
pub mod cutting;
pub mod digitize;
pub mod drape;
pub mod dynamics;
pub mod fabric;
pub mod fitting;
pub mod flatten;
pub mod geometry;
pub mod guide {
    //! One page per stage: its input, its output, and an example that runs.

    #[doc = include_str!("../docs/stages/pattern.md")]
    pub mod pattern {}
    #[doc = include_str!("../docs/stages/mesh.md")]
    pub mod mesh {}
    #[doc = include_str!("../docs/stages/sew.md")]
    pub mod sew {}
    #[doc = include_str!("../docs/stages/drape.md")]
    pub mod drape {}
    #[doc = include_str!("../docs/stages/flatten.md")]
    pub mod flatten {}
    #[doc = include_str!("../docs/stages/measure.md")]
    pub mod measure {}
}
pub mod input;
pub mod io;
pub mod linear;
pub mod mannequin;
pub mod mesh;
pub mod parallel;
pub mod pattern;
pub mod picture;
pub mod pipeline;
pub mod report;
pub mod sew;
pub mod specimen;
pub mod studio;
pub mod verify;
