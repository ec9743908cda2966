//! The garment turning once round, as an animation.

use super::camera::cameras_round;
use super::canvas::Canvas;
use super::color::PAPER;
use super::paint::Paint;
use super::view::{Lit, PicturePanel, paste};
use super::{PictureError, Scene, check};

/// Frames of a turn.
const FRAMES: usize = 36;
/// Time of a frame, hundredths of a second: a turn takes three seconds.
const DELAY: u16 = 8;
/// Width and height of a frame, pixels.
const SIZE: [usize; 2] = [600, 800];
/// Effort of the search for the 256 colours of a GIF's frame, 1 (best) to 30 (fastest).
const COLORS: i32 = 10;

/// Format of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turning {
    /// GIF, 256 colours a frame.
    Gif,
    /// PNG with frames, all colours.
    Apng,
}

/// Draws the scene from every side and returns the bytes of an animation that repeats.
///
/// # Errors
/// When there is nothing to draw, or values are missing ([`PictureError`]).
pub fn draw_turning(scene: &Scene, format: Turning) -> Result<Vec<u8>, PictureError> {
    check(scene)?;
    let (paint, lit) = (Paint::new(scene), Lit::new(scene));
    let frame = |camera| {
        let mut canvas = Canvas::new(SIZE[0], SIZE[1], PAPER);
        paste(&mut canvas, &[PicturePanel::new(scene, &lit, &paint, &camera)]);
        canvas.rgb
    };
    let frames: Vec<Vec<u8>> = cameras_round(scene.body, scene.cloth, FRAMES, SIZE).into_iter().map(frame).collect();
    match format {
        Turning::Gif => gif(&frames),
        Turning::Apng => apng(&frames),
    }
}

fn gif(frames: &[Vec<u8>]) -> Result<Vec<u8>, PictureError> {
    let mut bytes = Vec::new();
    let [width, height] = SIZE.map(|pixels| pixels as u16);
    let mut encoder = gif::Encoder::new(&mut bytes, width, height, &[])?;
    encoder.set_repeat(gif::Repeat::Infinite)?;
    for rgb in frames {
        let mut frame = gif::Frame::from_rgb_speed(width, height, rgb, COLORS);
        frame.delay = DELAY;
        encoder.write_frame(&frame)?;
    }
    drop(encoder);
    Ok(bytes)
}

fn apng(frames: &[Vec<u8>]) -> Result<Vec<u8>, PictureError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIZE[0] as u32, SIZE[1] as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_animated(frames.len() as u32, 0)?;
    encoder.set_frame_delay(DELAY, 100)?;
    let mut writer = encoder.write_header()?;
    for frame in frames {
        writer.write_image_data(frame)?;
    }
    writer.finish()?;
    Ok(bytes)
}
