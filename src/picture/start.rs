//! A garment's start: the glued cloth round the axes of the body, each opening's rim in its own colour.

use super::camera::cameras;
use super::canvas::Canvas;
use super::color::{AXIS, INK, PALE_INK, PAPER, opening};
use super::on_cloth::lines;
use super::paint::Paint;
use super::raster::byte;
use super::view::{LINE_LIFT, Lit, PicturePanel, paste, words};
use super::{HEIGHT, PictureError, PictureLayout, Scene, WIDTH, can_be_framed, encode};
use crate::geometry::{TriMesh, Vec3};

/// Half the width of a rim, pixels.
const RIM_RADIUS: f32 = 3.5;
/// Half the width of an axis, pixels.
const AXIS_RADIUS: f32 = 4.5;
/// Half the width of the line as which an axis shows through the cloth, pixels.
const SHINE_RADIUS: f32 = 1.2;
/// Distance by which that line is drawn nearer, metres: more than the size of any garment.
const SHINE_LIFT: f32 = 100.0;

/// Height of a line of the legend, pixels.
const LINE: usize = 46;
/// Size of letters of the legend, pixels per cell of the font.
const CELL: f32 = 3.0;
/// Left margin of the legend, pixels.
const MARGIN: usize = 56;
/// Side of the square of colour before a line, pixels.
const SQUARE: usize = 26;

/// Content of the picture besides the garment. Lengths are metres, y up.
#[derive(Clone, Copy, Debug)]
pub struct StartMarks<'a> {
    /// The axes of the body's parts.
    pub axes: &'a [Vec<Vec3>],
    /// The rim of every opening, as polylines on the cloth, and its line in the legend.
    pub openings: &'a [(Vec<Vec<Vec3>>, String)],
    /// Lines of text below the legend.
    pub notes: &'a [String],
}

/// Draws a garment round the body's axes, with a legend of its openings below, and returns the bytes of a PNG file,
/// [`WIDTH`] pixels wide. The `scene` has no body of its own.
///
/// # Errors
/// When there is nothing to draw ([`PictureError`]).
pub fn draw_start(scene: &Scene, marks: &StartMarks) -> Result<Vec<u8>, PictureError> {
    if !can_be_framed(scene.cloth, scene.body) {
        return Err(PictureError::NothingToDraw);
    }
    // Without a floor: before it hangs a garment stands on nothing.
    let mut lit = Lit::over(scene, TriMesh::default());
    let kinds: Vec<(&[Vec<Vec3>], f32, _)> =
        marks.openings.iter().enumerate().map(|(k, o)| (o.0.as_slice(), RIM_RADIUS, opening(k))).collect();
    lit.lines.extend(lines(scene, &kinds, LINE_LIFT));
    lit.lines.extend(lines(scene, &[(marks.axes, AXIS_RADIUS, AXIS)], LINE_LIFT));
    lit.lines.extend(lines(scene, &[(marks.axes, SHINE_RADIUS, AXIS)], SHINE_LIFT));
    let paint = Paint::new(scene);
    let cameras = cameras(scene.body, scene.cloth, &PictureLayout::default());
    let panels: Vec<PicturePanel> = cameras.iter().map(|c| PicturePanel::new(scene, &lit, &paint, c)).collect();
    let rows = marks.openings.len() + marks.notes.len() + 1;
    let mut canvas = Canvas::new(WIDTH, HEIGHT + rows * LINE, PAPER);
    paste(&mut canvas, &panels);
    words(&mut canvas, scene, &cameras, &paint, HEIGHT);
    legend(&mut canvas, marks);
    Ok(encode(&canvas)?)
}

/// Draws the legend of the colours and the notes below the views.
fn legend(canvas: &mut Canvas, marks: &StartMarks) {
    let square = marks.openings.iter().enumerate().map(|(k, o)| (Some(opening(k)), o.1.as_str()));
    let axes = (!marks.axes.is_empty()).then_some((Some(AXIS), "axes of the body"));
    let notes = marks.notes.iter().map(|note| (None, note.as_str()));
    for (row, (color, text)) in square.chain(axes).chain(notes).enumerate() {
        let top = HEIGHT + row * LINE;
        let base = (top + SQUARE - 2) as f32;
        if let Some(color) = color {
            canvas.fill([MARGIN, top], [SQUARE, SQUARE], color);
        }
        let left = if color.is_some() { MARGIN + 2 * SQUARE } else { MARGIN };
        let room = (WIDTH - left - MARGIN) as f32;
        let cell = CELL.min(CELL * room / Canvas::text_width(text, CELL).max(1.0));
        canvas.text(text, [left as f32, base], cell, if color.is_some() { INK } else { PALE_INK });
    }
}

/// The colour of the rim of opening `k`, as bytes.
pub fn opening_color(k: usize) -> [u8; 3] {
    opening(k).map(byte)
}

/// The pixels of the picture of `scene` (column and row) that show a point, one in each view. The point may be hidden
/// there.
pub fn pixels_of(scene: &Scene, point: &Vec3) -> Vec<[usize; 2]> {
    let of = |camera: super::camera::Camera| {
        let [x, y, _] = camera.project(point);
        [camera.left + x as usize, camera.top + y as usize]
    };
    cameras(scene.body, scene.cloth, &PictureLayout::default()).into_iter().map(of).collect()
}
