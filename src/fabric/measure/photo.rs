//! Photographs of the recovery test: how much of the picture the cloth covers (L2).

use std::io::Cursor;
use std::path::Path;

use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;

use super::MeasureError;
use crate::input::bytes;

/// Largest file of a photograph, bytes.
const LARGEST_FILE: u64 = 64 << 20;
/// Longest side of a photograph, pixels. The largest cameras have half of it.
const LONGEST_SIDE: usize = 1 << 15;
/// Least distance of cloth and table from the threshold, in grey values.
pub(super) const CLEAR: u8 = 16;
/// Largest number of pixels of a photograph.
const MOST_PIXELS: usize = 1 << 28;

/// A photograph as grey values, 0 black … 255 white.
#[derive(Clone, Debug)]
pub struct Photo {
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
    grey: Vec<u8>,
}

impl Photo {
    /// Reads a PNG or JPEG file. Colours become their luma (Rec. 601), transparent pixels white.
    ///
    /// # Errors
    /// [`MeasureError::Photo`] when the file cannot be read or is neither.
    pub fn read(path: &Path) -> Result<Self, MeasureError> {
        let fault = |why: String| MeasureError::Photo { file: path.display().to_string(), why };
        let bytes = bytes(path, LARGEST_FILE).map_err(|e| fault(e.to_string()))?;
        if bytes.starts_with(b"\x89PNG") {
            png(&bytes).map_err(fault)
        } else if bytes.starts_with(&[0xff, 0xd8]) {
            jpeg(&bytes).map_err(fault)
        } else {
            Err(fault("it is neither PNG nor JPEG".to_owned()))
        }
    }

    /// Share of the pixels that are darker than `threshold`, or not darker if the cloth is the `light` part.
    pub fn share(&self, threshold: u8, light: bool) -> f64 {
        let dark = self.grey.iter().filter(|g| **g < threshold).count();
        let count = if light { self.grey.len() - dark } else { dark };
        count as f64 / self.grey.len() as f64
    }

    /// Relative growth of the cloth's area when the threshold is moved by `CLEAR` from one side to the other. For
    /// evenly lit cloth and table it is a few pixels of the rim.
    pub(super) fn doubt(&self, threshold: u8) -> f64 {
        let [low, high] = [threshold.saturating_sub(CLEAR), threshold.saturating_add(CLEAR)];
        let between = self.share(high, false) - self.share(low, false);
        between / self.share(threshold, false).min(self.share(threshold, true))
    }
}

fn sized(width: usize, height: usize) -> Result<(), String> {
    let fits = width.max(height) <= LONGEST_SIDE && width * height <= MOST_PIXELS;
    if fits { Ok(()) } else { Err(format!("{width} × {height} pixels are too many")) }
}

fn png(bytes: &[u8]) -> Result<Photo, String> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|e| e.to_string())?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    sized(width, height)?;
    let size = reader.output_buffer_size().ok_or("its size overflows")?;
    let mut pixels = vec![0; size];
    let info = reader.next_frame(&mut pixels).map_err(|e| e.to_string())?;
    let samples = info.color_type.samples();
    let grey = pixels[..info.buffer_size()].chunks_exact(samples).map(|p| match *p {
        [g] => g,
        [g, a] => over_white(g, a),
        [r, g, b] => luma(r, g, b),
        [r, g, b, a] => over_white(luma(r, g, b), a),
        _ => 255,
    });
    Ok(Photo { width, height, grey: grey.collect() })
}

/// Whether a JPEG continues to its end marker. A decoder paints missing parts grey.
fn is_whole(bytes: &[u8]) -> bool {
    let is_marker = |pair: &[u8]| pair[0] == 0xff && !matches!(pair[1], 0 | 0xff | 0xd0..=0xd7);
    let mut at = 2;
    while let Some(step) = bytes.get(at..).and_then(|rest| rest.windows(2).position(is_marker)) {
        at += step + 2;
        match (bytes[at - 1], bytes.get(at..at + 2)) {
            (0xd9, _) => return true,
            (0x01 | 0xd8, _) => {}
            // Pictures within a segment, as a preview, have ends of their own.
            (_, Some(length)) => at += usize::from(u16::from_be_bytes([length[0], length[1]])),
            (_, None) => return false,
        }
    }
    false
}

fn jpeg(bytes: &[u8]) -> Result<Photo, String> {
    if !is_whole(bytes) {
        return Err("it is cut short; copy it again".to_owned());
    }
    let options = DecoderOptions::default().set_max_width(LONGEST_SIDE).set_max_height(LONGEST_SIDE);
    let mut decoder =
        JpegDecoder::new_with_options(ZCursor::new(bytes), options.jpeg_set_out_colorspace(ColorSpace::RGB));
    decoder.decode_headers().map_err(|e| e.to_string())?;
    let info = decoder.info().ok_or("it has no header")?;
    let (width, height) = (usize::from(info.width), usize::from(info.height));
    sized(width, height)?;
    let pixels = decoder.decode().map_err(|e| e.to_string())?;
    let grey: Vec<u8> = pixels.chunks_exact(3).map(|p| luma(p[0], p[1], p[2])).collect();
    if grey.len() == width * height { Ok(Photo { width, height, grey }) } else { Err("it is cut short".to_owned()) }
}

fn luma(r: u8, g: u8, b: u8) -> u8 {
    ((299 * u32::from(r) + 587 * u32::from(g) + 114 * u32::from(b) + 500) / 1000) as u8
}

fn over_white(grey: u8, alpha: u8) -> u8 {
    let (grey, alpha) = (u32::from(grey), u32::from(alpha));
    ((grey * alpha + 255 * (255 - alpha) + 127) / 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_picture_that_ends_too_soon_is_told_from_a_whole_one() {
        // Start, a segment that holds a picture of its own, a scan with a stuffed byte and a restart, the end.
        let whole = [
            0xff, 0xd8, 0xff, 0xe1, 0, 6, 0xff, 0xd8, 0xff, 0xd9, 0xff, 0xda, 0, 3, 1, 9, 0xff, 0, 9, 0xff, 0xd0, 9,
            0xff, 0xd9, 7, 7,
        ];
        assert!(is_whole(&whole));
        (0..whole.len() - 2).for_each(|end| assert!(!is_whole(&whole[..end]), "{end}"));
        assert!(jpeg(&whole[..12]).expect_err("cut").contains("cut short"));
    }

    #[test]
    fn a_threshold_amid_the_greys_is_in_doubt() {
        let photo = |grey: Vec<u8>| Photo { width: grey.len(), height: 1, grey };
        assert_eq!(photo(vec![60, 60, 60, 220, 220]).doubt(128), 0.0);
        assert_relative_eq!(photo(vec![60, 120, 135, 220, 220, 220]).doubt(128), 1.0, epsilon = 1e-12);
        assert_relative_eq!(photo(vec![200, 250, 255]).doubt(253), 1.0, epsilon = 1e-12);
    }
}
