//! Numbers out of bytes.

/// Bytes that are read one number after the other.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    /// Whether the first byte of a number is its largest.
    big: bool,
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberKind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl NumberKind {
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8], big: bool) -> Self {
        Self { bytes, big }
    }

    /// The next number; `None` where the bytes end.
    pub(super) fn number(&mut self, kind: NumberKind) -> Option<f64> {
        Some(match kind {
            NumberKind::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            NumberKind::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            NumberKind::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            NumberKind::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            NumberKind::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            NumberKind::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            NumberKind::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            NumberKind::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    /// The next bytes of a number, the smallest first.
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.bytes.split_first_chunk::<N>()?;
        self.bytes = rest;
        let mut out = *first;
        if self.big {
            out.reverse();
        }
        Some(out)
    }
}
