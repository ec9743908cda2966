//! Units of length of files that do not say theirs.

/// The unit of a file's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnit {
    /// Millimetres.
    Millimetre,
    /// Centimetres.
    Centimetre,
    /// Decimetres.
    Decimetre,
    /// Metres.
    Metre,
    /// Inches.
    Inch,
}

impl LengthUnit {
    /// All there are.
    pub const ALL: [Self; 5] = [Self::Millimetre, Self::Centimetre, Self::Decimetre, Self::Metre, Self::Inch];

    /// Metres in it.
    pub fn metres(self) -> f64 {
        match self {
            Self::Millimetre => 1e-3,
            Self::Centimetre => 1e-2,
            Self::Decimetre => 1e-1,
            Self::Metre => 1.0,
            Self::Inch => 0.0254,
        }
    }

    /// `mm`, `cm`, `dm`, `m` or `in`.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Decimetre => "dm",
            Self::Metre => "m",
            Self::Inch => "in",
        }
    }

    /// `millimetres`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Millimetre => "millimetres",
            Self::Centimetre => "centimetres",
            Self::Decimetre => "decimetres",
            Self::Metre => "metres",
            Self::Inch => "inches",
        }
    }

    /// The unit of this symbol.
    pub fn from_symbol(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.symbol() == symbol)
    }

    /// The unit of a file in which something is of this `size`, if that is told in metres and in centimetres as less
    /// than these two numbers.
    pub fn guessed(size: f64, [metres_below, centimetres_below]: [f64; 2]) -> Self {
        if size < metres_below {
            Self::Metre
        } else if size < centimetres_below {
            Self::Centimetre
        } else {
            Self::Millimetre
        }
    }

    /// Digits after the point that tell a millimetre.
    pub fn decimals(self) -> usize {
        match self {
            Self::Millimetre => 0,
            Self::Centimetre => 1,
            Self::Decimetre => 2,
            Self::Metre => 3,
            Self::Inch => 2,
        }
    }
}
