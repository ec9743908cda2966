//! Arguments of the picture.

use std::path::PathBuf;

use clap::ValueEnum;

use crate::picture::{PictureLayout, Turning, ViewSide};
use crate::pipeline::{Color, PictureOptions};

/// The picture.
#[derive(Debug, clap::Args)]
pub(super) struct PictureArgs {
    /// Colours of the picture
    #[arg(long, value_enum, default_value_t)]
    color: ColorArg,
    /// Views of the picture from left to right [default: front,side,back]
    #[arg(long = "view", value_name = "LIST", value_delimiter = ',', value_parser = view)]
    views: Vec<ViewSide>,
    /// Write the garment turning once round as well, for web pages and messages
    #[arg(long, value_name = "FILE.gif|FILE.apng", value_parser = turntable)]
    pub(super) turntable: Option<(PathBuf, Turning)>,
}

impl PictureArgs {
    /// `size` is the picture's width and height, pixels.
    pub(super) fn drawing(&self, size: Option<[usize; 2]>) -> PictureOptions {
        let own = PictureLayout::default();
        let views = if self.views.is_empty() { own.views } else { self.views.clone() };
        PictureOptions { color: self.color.into(), layout: PictureLayout { size: size.unwrap_or(own.size), views } }
    }
}

/// A side from which the garment is seen.
fn view(text: &str) -> Result<ViewSide, String> {
    let names = ViewSide::ALL.map(|view| view.label().to_lowercase());
    let found = ViewSide::ALL.into_iter().zip(&names).find(|(_, name)| *name == text);
    found.map(|(view, _)| view).ok_or_else(|| format!("one of {} is expected", names.join(", ")))
}

/// Width and height of a picture in pixels: `1200x800`. `None` for other words, and where nothing could be drawn.
pub(super) fn pixels(text: &str) -> Option<[usize; 2]> {
    let (width, height) = text.split_once(['x', 'X'])?;
    let ([least_w, least_h], [most_w, most_h]) = (PictureLayout::SMALLEST, PictureLayout::LARGEST);
    let size = [width.trim().parse().ok()?, height.trim().parse().ok()?];
    ((least_w..=most_w).contains(&size[0]) && (least_h..=most_h).contains(&size[1])).then_some(size)
}

/// A file and its format, told by its ending.
fn turntable(text: &str) -> Result<(PathBuf, Turning), String> {
    let path = PathBuf::from(text);
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match ending.as_str() {
        "gif" => Ok((path, Turning::Gif)),
        "apng" | "png" => Ok((path, Turning::Apng)),
        _ => Err("a file that ends in .gif or .apng is expected".into()),
    }
}

/// `--color`
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub(super) enum ColorArg {
    /// Which piece it is
    #[default]
    Piece,
    /// How far warp and weft are stretched
    Strain,
    /// How far it is from the skin
    Ease,
    /// How hard it presses on the skin
    Pressure,
    /// Which fabric it is
    Fabric,
}

impl From<ColorArg> for Color {
    fn from(color: ColorArg) -> Self {
        match color {
            ColorArg::Piece => Self::Piece,
            ColorArg::Strain => Self::Strain,
            ColorArg::Ease => Self::Ease,
            ColorArg::Pressure => Self::Pressure,
            ColorArg::Fabric => Self::Fabric,
        }
    }
}
