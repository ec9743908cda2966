//! Kinds of marks on the rim of a piece.

/// Distance of a double notch's two marks along their edge, metres.
pub const DOUBLE_MARKS: f64 = 0.006;

/// Meaning of a notch's mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotchKind {
    /// A notch by itself.
    Single,
    /// One of two that mark the back, half of [`DOUBLE_MARKS`] from the place that they mark.
    Double,
    /// One of two that mark the back, where the edge ends within half of [`DOUBLE_MARKS`]. It stands at the end.
    DoubleAtEnd,
    /// The mouth of a dart.
    Dart,
    /// A fold of a pleat or the place to which it is brought.
    Pleat,
}

impl NotchKind {
    /// All there are.
    const ALL: [Self; 5] = [Self::Single, Self::Double, Self::DoubleAtEnd, Self::Dart, Self::Pleat];

    /// The marks of a notch at a place of an edge of this length: the place and kind of each.
    pub fn marks(at: f64, double: bool, length: f64) -> impl Iterator<Item = (f64, Self)> {
        let places = if double { vec![at - DOUBLE_MARKS / 2.0, at + DOUBLE_MARKS / 2.0] } else { vec![at] };
        places.into_iter().map(move |place| {
            let fits = (0.0..=length).contains(&place);
            let kind = match (double, fits) {
                (false, _) => Self::Single,
                (true, true) => Self::Double,
                (true, false) => Self::DoubleAtEnd,
            };
            (place, kind)
        })
    }

    /// As drawings tell it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Double => "double",
            Self::DoubleAtEnd => "double-at-end",
            Self::Dart => "dart",
            Self::Pleat => "pleat",
        }
    }

    /// The one that a drawing tells.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.word() == word)
    }

    /// Whether the garment's file tells of it as a notch.
    pub fn is_notch(self) -> bool {
        !matches!(self, Self::Dart | Self::Pleat)
    }

    /// Whether it is one of the two marks of a double notch.
    pub fn is_double(self) -> bool {
        matches!(self, Self::Double | Self::DoubleAtEnd)
    }
}
