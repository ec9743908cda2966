//! Values that the statements of a garment file are made of.

use super::diagnostic::Located;

/// A YAML value with the place of every part of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Any scalar, as written.
    Text(String),
    /// A sequence.
    List(Vec<Located<Value>>),
    /// A mapping, in the order of the file. Keys are unique.
    Map(Vec<(Located<String>, Located<Value>)>),
}

/// Unit of a written number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Millimetres.
    Millimetre,
    /// Centimetres.
    Centimetre,
    /// Inches of 25.4 mm.
    Inch,
    /// Hundredths.
    Percent,
}

impl Unit {
    /// Metres (or fraction) per unit.
    pub fn factor(self) -> f64 {
        match self {
            Self::Millimetre => 1e-3,
            Self::Centimetre | Self::Percent => 1e-2,
            Self::Inch => 0.0254,
        }
    }

    /// As written in files.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Inch => "in",
            Self::Percent => "%",
        }
    }

    /// The unit with this symbol.
    pub fn from_symbol(symbol: &str) -> Option<Self> {
        [Self::Millimetre, Self::Centimetre, Self::Inch, Self::Percent].into_iter().find(|u| u.symbol() == symbol)
    }
}

/// A number with the unit it was written with, if any: `12`, `1.2 cm`, `0.5 %`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// The number.
    pub number: f64,
    /// Its own unit. `None` = the file's `units`.
    pub unit: Option<Unit>,
}

impl Quantity {
    /// The value in metres (a fraction for percent), where a bare number counts in `default`.
    pub fn value(self, default: Unit) -> f64 {
        self.number * self.unit.unwrap_or(default).factor()
    }

    /// Whether it was written in percent.
    pub fn is_percent(self) -> bool {
        self.unit == Some(Unit::Percent)
    }
}

/// Left or right of the wearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The wearer's left.
    Left,
    /// The wearer's right.
    Right,
}

impl Side {
    /// `L` or `R`.
    pub fn letter(self) -> &'static str {
        match self {
            Self::Left => "L",
            Self::Right => "R",
        }
    }

    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// The end of the names of pieces, seams and edges on this side: `.L` or `.R`.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Left => ".L",
            Self::Right => ".R",
        }
    }

    /// A name without the suffix of a side, and that side.
    pub fn split(name: &str) -> (&str, Option<Self>) {
        let without = |side: Self| Some((name.strip_suffix(side.suffix())?, Some(side)));
        [Self::Left, Self::Right].into_iter().find_map(without).unwrap_or((name, None))
    }

    /// Whether a name is `base`, or that with the suffix of a side: whether it may be of a copy of what `base` names.
    pub fn is_copy(name: &str, base: &str) -> bool {
        name == base || Self::split(name).0 == base
    }

    /// The side with this letter.
    pub fn from_letter(letter: &str) -> Option<Self> {
        [Self::Left, Self::Right].into_iter().find(|s| s.letter() == letter)
    }
}

/// How a drawn piece is cut.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CutKind {
    /// Once, as drawn.
    One,
    /// As drawn and mirrored.
    Pair,
    /// On the fold: the drawn half and its mirror image across this edge make one piece.
    Fold(String),
    /// So many times as drawn.
    Count(usize),
}

/// Ending of an edge's allowance at its corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// Both cut lines go on until they meet.
    Mitred,
    /// Square to the edge, from where its sewing line leaves the neighbour's allowance: for the seam sewn first.
    Squared,
    /// As the neighbour's cut line mirrored in the edge, so that it lies on it when it is folded back: for hems.
    Folded,
}

impl Corner {
    /// As written in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Mitred => "mitred",
            Self::Squared => "squared",
            Self::Folded => "folded",
        }
    }

    /// The corner with this name.
    pub fn from_word(word: &str) -> Option<Self> {
        [Self::Mitred, Self::Squared, Self::Folded].into_iter().find(|c| c.word() == word)
    }
}
