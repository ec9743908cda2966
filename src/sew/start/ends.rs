//! The five ends of a body.

/// An end of the body. A garment's opening parts some of them from the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum End {
    /// Head.
    Head,
    /// Left arm.
    LeftArm,
    /// Right arm.
    RightArm,
    /// Left leg.
    LeftLeg,
    /// Right leg.
    RightLeg,
}

impl End {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Head, Self::LeftArm, Self::RightArm, Self::LeftLeg, Self::RightLeg];

    /// `head`, `left arm`, …
    pub fn name(self) -> &'static str {
        match self {
            Self::Head => "head",
            Self::LeftArm => "left arm",
            Self::RightArm => "right arm",
            Self::LeftLeg => "left leg",
            Self::RightLeg => "right leg",
        }
    }
}

/// A set of ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ends(u8);

impl Ends {
    /// None: of a slit or a keyhole.
    pub const NONE: Self = Self(0);
    /// The head.
    pub const HEAD: Self = Self(1);
    /// The left arm.
    pub const LEFT_ARM: Self = Self(2);
    /// The right arm.
    pub const RIGHT_ARM: Self = Self(4);
    /// The left leg.
    pub const LEFT_LEG: Self = Self(8);
    /// The right leg.
    pub const RIGHT_LEG: Self = Self(16);
    /// Both arms.
    pub const ARMS: Self = Self(6);
    /// Both legs.
    pub const LEGS: Self = Self(24);
    /// Head and arms: what is above the waist.
    pub const TOP: Self = Self(7);
    /// All five.
    pub const ALL: Self = Self(31);
    /// Number of sets there are.
    pub(super) const COUNT: usize = 32;

    /// The set of one end.
    pub fn of(end: End) -> Self {
        Self(1 << (end as u8))
    }

    /// Every set, by its index.
    pub(super) fn every() -> impl Iterator<Item = Self> {
        (0..Self::COUNT as u8).map(Self)
    }

    /// Its index among all sets.
    pub(super) fn index(self) -> usize {
        usize::from(self.0)
    }

    /// Those that are not in it.
    pub(super) fn others(self) -> Self {
        Self(Self::ALL.0 & !self.0)
    }

    /// Those of both.
    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether it has all of `other`.
    pub fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether it has any of `other`.
    pub fn touches(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether it has none.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Number of ends.
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Left and right exchanged.
    pub fn mirrored(self) -> Self {
        Self(self.0 & 1 | (self.0 & 0b01010) << 1 | (self.0 & 0b10100) >> 1)
    }
}

impl std::fmt::Display for Ends {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let names = End::ALL.into_iter().filter(|&end| self.has(Self::of(end))).map(End::name);
        let names: Vec<&str> = names.collect();
        f.write_str(&if names.is_empty() { "nothing".to_owned() } else { names.join(" + ") })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_and_right_are_exchanged() {
        assert_eq!(Ends::LEFT_ARM.mirrored(), Ends::RIGHT_ARM);
        assert_eq!(Ends::RIGHT_LEG.with(Ends::HEAD).mirrored(), Ends::LEFT_LEG.with(Ends::HEAD));
        assert!(Ends::every().all(|ends| ends.mirrored().mirrored() == ends));
    }
}
