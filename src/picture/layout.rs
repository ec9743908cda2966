//! Size of the picture, and its views.

use std::f64::consts::FRAC_PI_2;

/// A side from which the garment is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewSide {
    /// From before the wearer.
    Front,
    /// From the wearer's left.
    Side,
    /// The same, called left.
    Left,
    /// From behind.
    Back,
    /// From the wearer's right.
    Right,
}

impl ViewSide {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Front, Self::Side, Self::Left, Self::Back, Self::Right];

    /// `FRONT`, …, as written below it.
    pub fn label(self) -> &'static str {
        match self {
            Self::Front => "FRONT",
            Self::Side => "SIDE",
            Self::Left => "LEFT",
            Self::Back => "BACK",
            Self::Right => "RIGHT",
        }
    }

    /// Angle of the viewer about the vertical, from the front to the wearer's left, radians.
    pub(super) fn yaw(self) -> f64 {
        match self {
            Self::Front => 0.0,
            Self::Side | Self::Left => FRAC_PI_2,
            Self::Back => 2.0 * FRAC_PI_2,
            Self::Right => 3.0 * FRAC_PI_2,
        }
    }
}

/// Size of a picture and what it shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureLayout {
    /// Width and height, pixels. At least [`PictureLayout::SMALLEST`].
    pub size: [usize; 2],
    /// Its views from left to right. One or more.
    pub views: Vec<ViewSide>,
}

impl PictureLayout {
    /// The least width and height, pixels: title and names of the views need so much.
    pub const SMALLEST: [usize; 2] = [400, 400];
    /// The largest width and height, pixels.
    pub const LARGEST: [usize; 2] = [8000, 8000];
}

impl Default for PictureLayout {
    fn default() -> Self {
        Self { size: [super::WIDTH, super::HEIGHT], views: vec![ViewSide::Front, ViewSide::Side, ViewSide::Back] }
    }
}
