//! Errors between a checked garment and its mesh.

use crate::geometry::Vec2;

/// Why a garment could not be meshed. Lengths are stored in metres and shown in millimetres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// The spacing is zero, negative, infinite or not a number.
    #[error("mesh size must be a positive length, not {} mm", mm(*.0))]
    Spacing(f64),
    /// Every piece is too small for springs of this length.
    #[error(
        "mesh size {} mm is too large: even '{piece}' is only {} mm wide and {} mm long; use {} mm or less ({} mm for \
         three springs across), or check the file's units",
        mm(*.spacing), mm(*.width), mm(*.length), mm(*.largest), mm(*.good)
    )]
    TooCoarse {
        /// The widest piece.
        piece: String,
        /// Its width.
        width: f64,
        /// Its length.
        length: f64,
        /// The spacing asked for.
        spacing: f64,
        /// The largest spacing that is accepted, to a hundredth of a millimetre.
        largest: f64,
        /// A spacing that puts three springs across.
        good: f64,
    },
    /// The mesh would not fit in memory or in anyone's patience.
    #[error(
        "mesh size {} mm is too small: it makes {} particles (limit {limit}); use >= {} mm",
        mm(*.spacing), count(*.particles), mm(*.usable)
    )]
    TooMany {
        /// Expected number.
        particles: usize,
        /// Largest number that is meshed.
        limit: usize,
        /// The spacing asked for.
        spacing: f64,
        /// A spacing that stays within the limit.
        usable: f64,
    },
    /// A piece has no outline, or a ring has no edge.
    #[error("piece '{piece}' has no outline")]
    NoOutline {
        /// The piece.
        piece: String,
    },
    /// The warp direction of a piece is no unit vector.
    #[error("grain of '{piece}' has length {length}; it must be a direction of length 1")]
    Grain {
        /// The piece.
        piece: String,
        /// Length of its warp direction.
        length: f64,
    },
    /// The edges of a piece enclose no positive area.
    #[error(
        "outline of '{piece}' encloses {} mm2; it must run clockwise on screen, with its holes inside",
        (area * 1e6).round()
    )]
    InsideOut {
        /// The piece.
        piece: String,
        /// Signed area, square metres.
        area: f64,
    },
    /// An edge does not start where the one before it ends.
    #[error(
        "outline of '{piece}' does not close: edge '{edge}' starts {} mm from the end of the edge before it",
        mm(*.gap)
    )]
    Open {
        /// The piece.
        piece: String,
        /// The edge after the gap.
        edge: String,
        /// Width of the gap.
        gap: f64,
    },
    /// An edge has (almost) no length.
    #[error("edge '{piece}.{edge}' is only {} mm long; join it to its neighbour", mm(*.length))]
    ShortEdge {
        /// The piece.
        piece: String,
        /// The edge.
        edge: String,
        /// Its length.
        length: f64,
    },
    /// A seam refers to something that does not exist.
    #[error("seam '{seam}': {fault}")]
    Seam {
        /// The seam.
        seam: String,
        /// The fault.
        fault: SeamFault,
    },
    /// Matching seam to seam never comes to an end on an edge.
    #[error(
        "matching the seams puts more than {count} points on '{piece}.{edge}': it is sewn, through other seams, to a \
         shifted stretch of itself; check the ranges of its seams"
    )]
    Endless {
        /// The piece.
        piece: String,
        /// The edge.
        edge: String,
        /// Points when the search was given up.
        count: usize,
    },
    /// Two rims or lines cross once they are sampled.
    #[error(
        "in '{piece}', {first} and {second} cross or touch near ({}, {}) at mesh size {} mm; {} or use a smaller mesh \
         size",
        mm(.at.x), mm(.at.y), mm(*.spacing), parted(first, second)
    )]
    Crossing {
        /// The piece.
        piece: String,
        /// An edge or line.
        first: String,
        /// Another.
        second: String,
        /// Place in the flat piece, metres.
        at: Vec2,
        /// The spacing asked for.
        spacing: f64,
    },
    /// A line that bends or gathers the cloth lies outside it.
    #[error("line '{line}' lies outside piece '{piece}'")]
    LineOutside {
        /// The piece.
        piece: String,
        /// The line.
        line: String,
    },
    /// The triangulator refused a coordinate.
    #[error("cannot triangulate '{piece}': {why}")]
    Triangulation {
        /// The piece.
        piece: String,
        /// The triangulator's reason.
        why: String,
    },
}

impl MeshError {
    /// The piece, and the edge, line or seam that is wrong, as far as the error is about a statement of the garment.
    pub fn culprit(&self) -> (Option<&str>, Option<&str>) {
        match self {
            Self::Open { piece, edge, .. }
            | Self::ShortEdge { piece, edge, .. }
            | Self::Endless { piece, edge, .. } => (Some(piece), Some(edge)),
            Self::LineOutside { piece, line } => (Some(piece), Some(line)),
            Self::NoOutline { piece }
            | Self::Grain { piece, .. }
            | Self::InsideOut { piece, .. }
            | Self::Crossing { piece, .. }
            | Self::TooCoarse { piece, .. }
            | Self::Triangulation { piece, .. } => (Some(piece), None),
            Self::Seam { seam, .. } => (None, Some(seam)),
            Self::Spacing(_) | Self::TooMany { .. } => (None, None),
        }
    }
}

/// Faults of a seam.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SeamFault {
    /// A span's edge is not in the garment.
    #[error("a span names edge {index} of ring {ring} of piece {piece}, which does not exist")]
    NoSuchEdge {
        /// Piece index.
        piece: usize,
        /// Ring index.
        ring: usize,
        /// Edge index.
        index: usize,
    },
    /// A span reaches past its edge.
    #[error(
        "range {}..{} mm of edge '{edge}' reaches past its ends (it is {} mm long)",
        mm(*.from), mm(*.to), mm(*.length)
    )]
    PastTheEnd {
        /// The edge.
        edge: String,
        /// Start of the span.
        from: f64,
        /// End of the span.
        to: f64,
        /// Length of the edge.
        length: f64,
    },
    /// One side has no length.
    #[error("one side has no length; give it an edge or a range that can be sewn")]
    NoLength,
    /// The marks do not rise from (0, 0) to the two lengths.
    #[error("its marks must rise on both sides from (0, 0) to ({}, {}) mm", mm(*.0), mm(*.1))]
    Marks(f64, f64),
    /// The two sides could not be cut into the same number of stretches.
    #[error(
        "cannot match {a} stretches of one side with {b} of the other; marks or edge ends lie within 0.01 mm of each \
         other"
    )]
    Unmatched {
        /// Stretches of the first chain.
        a: usize,
        /// Stretches of the second chain.
        b: usize,
    },
}

/// Millimetres with at most two decimals, no trailing zeros. Very large and very small ones as powers of ten.
fn mm(metres: f64) -> String {
    let mm = metres * 1e3;
    match mm.abs() {
        size if size >= 1e7 || (size > 0.0 && size < 5e-3) => format!("{mm:.1e}"),
        _ => format!("{}", (mm * 100.0).round() / 100.0),
    }
}

/// A number of particles as a person reads it.
fn count(particles: usize) -> String {
    match particles {
        usize::MAX => "more than 1e19".to_owned(),
        10_000_000.. => format!("{:.1e}", particles as f64),
        _ => particles.to_string(),
    }
}

/// Advice to separate two edges or lines, as [`MeshError::Crossing`] names them.
fn parted(first: &str, second: &str) -> &'static str {
    match [first, second].map(|name| name.starts_with("line ")) {
        [true, true] => "make them one line, draw them further apart",
        [false, false] => "mend the outline",
        _ => "draw the line on the edge, to a millimetre, or further from it,",
    }
}
