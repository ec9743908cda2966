//! Areas and lengths of pieces, exact on the curves.

use super::Piece;

impl Piece {
    /// Area without holes, m².
    pub fn area(&self) -> f64 {
        // Holes run the other way, so their areas subtract themselves.
        self.loops.iter().flatten().map(|e| e.path.double_area()).sum::<f64>() / 2.0
    }

    /// Length of the outline and of all holes, metres.
    pub fn boundary_length(&self) -> f64 {
        self.loops.iter().flatten().map(|e| e.path.length()).sum()
    }

    /// Length of the outline alone, metres.
    pub fn outline_length(&self) -> f64 {
        self.loops[0].iter().map(|e| e.path.length()).sum()
    }
}
