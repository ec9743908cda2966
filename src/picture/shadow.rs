//! The shadow of a draped disc, as the drape test photographs it.

use super::canvas::Canvas;
use super::color::{INK, PALE_INK, PAPER};
use super::{PictureError, encode};

/// Pixels above the shadow, for words.
const HEAD: usize = 110;

/// Draws a square of `dark.len()` places, row by row, `width` in each: dark ones in ink,
/// and below the title one line of words.
///
/// # Errors
/// When there is nothing to draw ([`PictureError`]).
pub fn draw_shadow(dark: &[bool], width: usize, title: &str, words: &str) -> Result<Vec<u8>, PictureError> {
    if width == 0 || dark.len() < width {
        return Err(PictureError::NothingToDraw);
    }
    let rows = dark.len() / width;
    let mut canvas = Canvas::new(width, HEAD + rows, PAPER);
    for (k, _) in dark.iter().enumerate().filter(|(_, d)| **d) {
        canvas.fill([k % width, HEAD + k / width], [1, 1], PALE_INK);
    }
    canvas.text(title, [24.0, 48.0], 4.0, INK);
    canvas.text(words, [24.0, 88.0], 2.4, PALE_INK);
    Ok(encode(&canvas)?)
}
