//! Alterations of a garment file, as they are written.

use super::diagnostic::Located;
use super::value::Quantity;

/// A position along an edge, and what happens there.
pub type StationFile<T> = (Located<Quantity>, Located<T>);

/// One entry of `alter`.
#[derive(Clone, Debug, PartialEq)]
pub enum AlterationFile {
    /// `{take_in: side, at: {50 %: 8}}`, or `let_out`: an edge moved square to itself, with the edge it is sewn to.
    Take {
        /// A seam, or an edge alone.
        seam: Located<String>,
        /// How far at which positions.
        at: Vec<StationFile<Quantity>>,
        /// `let_out`: outwards.
        out: bool,
    },
    /// `{lengthen: front, at: 300, by: 20}`, or `shorten`: cloth let in across pieces, or taken out.
    Lengthen {
        /// The pieces.
        pieces: Vec<Located<String>>,
        /// The line's height (or place across) in the drawing.
        at: Located<Quantity>,
        /// Length let in or taken out.
        by: Located<Quantity>,
        /// Width of the stretch that is made longer or shorter, from `at` onwards.
        over: Option<Located<Quantity>>,
        /// `along: x`: wider in place of longer.
        across: Option<Located<bool>>,
        /// `shorten`.
        shorter: bool,
    },
    /// `{pivot: front.bust, to: front.shoulder@50 %}`: a dart's intake turned to another place of the outline.
    Pivot {
        /// The dart, `piece.dart`.
        dart: Located<String>,
        /// The new dart's place.
        to: Located<String>,
        /// Part of the intake that is moved. All of it if not given.
        share: Option<Located<Quantity>>,
        /// Name of the new dart. The old one's if all is moved and no name is given.
        name: Option<Located<String>>,
    },
    /// `{spread: sleeve.hem@50 %, to: sleeve.cap@50 %, by: 30}`: slashed between two points and opened.
    Spread {
        /// Where it opens by `by`.
        from: Located<String>,
        /// The other end of the slash.
        to: Located<String>,
        /// Width of the opening at `from`.
        by: Located<Quantity>,
        /// Width of the opening at `to`. The two halves are hinged there if not given.
        to_by: Option<Located<Quantity>>,
    },
    /// `{fullness: skirt.hem, to: skirt.waist, by: 120}`: slashed several times from one edge to another, and opened.
    Fullness {
        /// The edge that becomes longer by `by`.
        edge: Located<String>,
        /// The edge across.
        to: Located<String>,
        /// How much longer.
        by: Located<Quantity>,
        /// How much longer the edge across becomes. The slashes are hinged there if not given.
        to_by: Option<Located<Quantity>>,
        /// Number of slashes.
        slashes: Option<Located<usize>>,
    },
    /// `{cut: front.side@30 %, to: front.armhole@50 %, name: side_front}`: cut in two along a style line.
    Cut {
        /// Where the style line begins.
        from: Located<String>,
        /// Where it ends.
        to: Located<String>,
        /// Points that it passes.
        via: Vec<Located<[f64; 2]>>,
        /// Name of the new piece: the one without the fold, or else without the middle of the grain.
        name: Located<String>,
        /// Name of the seam and of its two edges. The new piece's if not given.
        seam: Option<Located<String>>,
    },
    /// `{join: waist}`: the two pieces of a seam made one.
    Join {
        /// The seam.
        seam: Located<String>,
    },
    /// `{move: front.neck, at: {0 %: [0, 5]}}`: points of an edge moved.
    Move {
        /// The edge.
        edge: Located<String>,
        /// How far at which positions, in the drawing's axes.
        at: Vec<StationFile<[f64; 2]>>,
    },
}

/// The alterations that make a size of a garment.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeFile {
    /// Its name.
    pub name: Located<String>,
    /// In order, after those of `alter`.
    pub alter: Vec<Located<AlterationFile>>,
}
