//! Many cloths on one sheet, each seen from above at an angle.

use super::camera::cameras_above;
use super::canvas::Canvas;
use super::color::{INK, PALE_INK, PAPER};
use super::paint::Paint;
use super::view::{Lit, PicturePanel, paste, scale_bar};
use super::{PictureError, Scene, WIDTH, can_be_framed, encode, rim_lines};
use crate::geometry::{TriMesh, Vec3};

/// Height above the panels, for the title, pixels.
const HEAD: usize = 110;
/// Height below each panel, for its name, pixels.
const NAME: usize = 54;
/// Pixels between panels.
const GUTTER: usize = 12;
/// Height of a panel as a share of its width.
const ASPECT: f64 = 0.72;
/// The sheet has about this many columns for each row.
const COLUMNS_PER_ROW: f64 = 1.7;
/// Margin left and right of the title, pixels.
const MARGIN: f32 = 56.0;

/// One cloth of a sheet. Lengths are metres, y up.
#[derive(Clone, Copy, Debug)]
pub struct Specimen<'a> {
    /// Written below it.
    pub name: &'a str,
    /// The cloth.
    pub cloth: &'a TriMesh,
    /// Lines drawn on the cloth, from vertex to vertex.
    pub lines: &'a [Vec<Vec3>],
    /// A thing that the cloth lies on, counter-clockwise seen from outside. May be empty.
    pub body: &'a TriMesh,
}

/// Draws cloths side by side at one scale and returns the bytes of a PNG file, [`WIDTH`] pixels wide.
///
/// # Errors
/// When there is no specimen, or one that cannot be drawn ([`PictureError`]).
pub fn draw_sheet(title: &str, subtitle: &str, specimens: &[Specimen]) -> Result<Vec<u8>, PictureError> {
    if specimens.is_empty() || !specimens.iter().all(|s| can_be_framed(s.cloth, s.body)) {
        return Err(PictureError::NothingToDraw);
    }
    let rows = (specimens.len() as f64 / COLUMNS_PER_ROW).sqrt().round().max(1.0) as usize;
    let columns = specimens.len().div_ceil(rows);
    let cell = WIDTH / columns;
    let size = [cell - GUTTER, (ASPECT * cell as f64) as usize];
    let mut cameras = cameras_above(&specimens.iter().map(|s| s.cloth.vertices.as_slice()).collect::<Vec<_>>(), size);
    for (k, camera) in cameras.iter_mut().enumerate() {
        camera.left = k % columns * cell + GUTTER / 2;
        camera.top = HEAD + k / columns * (size[1] + NAME);
    }
    let rims: Vec<_> = specimens.iter().map(|s| rim_lines(s.cloth)).collect();
    let scenes: Vec<Scene> = specimens.iter().zip(&rims).map(|(s, rims)| scene(s, rims)).collect();
    let lit: Vec<Lit> = scenes.iter().map(Lit::new).collect();
    let panels: Vec<PicturePanel> = (0..scenes.len())
        .map(|k| PicturePanel::new(&scenes[k], &lit[k], &Paint::new(&scenes[k]), &cameras[k]))
        .collect();
    let mut canvas = Canvas::new(WIDTH, HEAD + rows * (size[1] + NAME), PAPER);
    paste(&mut canvas, &panels);
    for (specimen, camera) in specimens.iter().zip(&cameras) {
        let middle = (camera.left + camera.width / 2) as f32 - 0.5 * Canvas::text_width(specimen.name, 2.6);
        canvas.text(specimen.name, [middle, (camera.top + camera.height + NAME / 2) as f32], 2.6, INK);
    }
    let end = canvas.text(title, [MARGIN, 72.0], 5.0, INK);
    canvas.text(subtitle, [end + 34.0, 72.0], 2.6, PALE_INK);
    scale_bar(&mut canvas, cameras[0].scale, 72.0);
    Ok(encode(&canvas)?)
}

fn scene<'a>(specimen: &Specimen<'a>, rims: &'a [Vec<Vec3>]) -> Scene<'a> {
    let &Specimen { cloth, lines, body, .. } = specimen;
    Scene {
        body,
        cloth,
        piece_of_triangle: &[],
        seams: lines,
        rims,
        title: "",
        subtitle: "",
        values: None,
        groups: &[],
    }
}
