//! `garment.png`: the garment on the mannequin from the front, the side and the back, large enough to judge the fit.
//!
//! [`draw`] is a small renderer of its own: orthographic views (so that all parts are to one scale), a depth buffer
//! with four samples per pixel, soft light from above and from the viewer's left, darker where little sky is seen.
//! [`Dressed`] gathers a [`Scene`] from a garment's mesh. The same scene gives the same bytes,
//! on any number of threads.

mod camera;
mod canvas;
mod clear;
mod color;
mod dressed;
mod flat;
mod font;
mod ink;
mod layout;
mod light;
mod occlusion;
mod on_cloth;
mod paint;
mod pattern;
mod places;
mod raster;
mod shadow;
mod sheet;
mod start;
mod turntable;
mod view;

pub use dressed::{Dressed, rim_lines};
pub use flat::draw_flat;
pub use layout::{PictureLayout, ViewSide};
pub use pattern::{PatternEdge, PatternPiece, draw_pattern, seam_color};
pub use shadow::draw_shadow;
pub use sheet::{Specimen, draw_sheet};
pub use start::{StartMarks, draw_start, opening_color, pixels_of};
pub use turntable::{Turning, draw_turning};

use crate::geometry::{TriMesh, Vec3};

/// Width of the picture, pixels.
pub const WIDTH: usize = 2400;
/// Height of the picture, pixels.
pub const HEIGHT: usize = 1500;

/// Content of a picture. Lengths are metres, y up.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The mannequin, counter-clockwise seen from outside. May be empty.
    pub body: &'a TriMesh,
    /// The garment with seams joined, counter-clockwise seen from the cloth's right side.
    pub cloth: &'a TriMesh,
    /// The piece of every triangle of the cloth. Missing ones count as piece 0.
    pub piece_of_triangle: &'a [u32],
    /// Seams, as polylines on the cloth.
    pub seams: &'a [Vec<Vec3>],
    /// Rims, as polylines on the cloth.
    pub rims: &'a [Vec<Vec3>],
    /// Large text above, the garment's name.
    pub title: &'a str,
    /// Small text beside it, mannequin and fabric.
    pub subtitle: &'a str,
    /// A value of every vertex of the cloth: colours the cloth by it instead of by piece, with a legend.
    pub values: Option<(&'a [f64], Scale)>,
    /// Names of what takes the place of pieces in `piece_of_triangle`: a legend of their colours. Empty for pieces.
    pub groups: &'a [String],
}

/// The quantity that colours a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Strain of warp and weft, a fraction. Shrinking is negative.
    Strain,
    /// Distance to the skin, mm.
    Ease,
    /// Pressure on the skin, kPa.
    Pressure,
}

impl Scene<'_> {
    /// The piece of a triangle of the cloth.
    fn piece_of(&self, triangle: usize) -> u32 {
        self.piece_of_triangle.get(triangle).copied().unwrap_or(0)
    }
}

/// Why a picture could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// There is nothing to frame.
    #[error("cannot draw the garment: it has no triangles, or positions that are not finite")]
    NothingToDraw,
    /// `Scene::values` has another length than the cloth has vertices.
    #[error("cannot colour by value: {values} values for {vertices} vertices or triangles")]
    ValuesLength {
        /// Values given.
        values: usize,
        /// Vertices of the cloth, triangles of flat pieces.
        vertices: usize,
    },
    /// The PNG encoder failed.
    #[error("cannot encode the picture: {0}")]
    Encode(#[from] png::EncodingError),
    /// The GIF encoder failed.
    #[error("cannot encode the picture: {0}")]
    Gif(#[from] gif::EncodingError),
}

/// Draws the scene and returns the bytes of a PNG file.
///
/// # Errors
/// When there is nothing to draw, or values are missing ([`PictureError`]).
pub fn draw(scene: &Scene, layout: &PictureLayout) -> Result<Vec<u8>, PictureError> {
    check(scene)?;
    Ok(encode(&view::render(scene, layout))?)
}

/// Whether a scene can be drawn.
fn check(scene: &Scene) -> Result<(), PictureError> {
    if !can_be_framed(scene.cloth, scene.body) {
        return Err(PictureError::NothingToDraw);
    }
    let vertices = scene.cloth.vertices.len();
    match scene.values {
        Some((values, _)) if values.len() != vertices => {
            Err(PictureError::ValuesLength { values: values.len(), vertices })
        }
        _ => Ok(()),
    }
}

/// Whether there is cloth, and all of it and of the body has finite positions.
fn can_be_framed(cloth: &TriMesh, body: &TriMesh) -> bool {
    let finite = |mesh: &TriMesh| mesh.vertices.iter().all(|p| p.iter().all(|x| x.is_finite()));
    !cloth.triangles.is_empty() && finite(cloth) && finite(body)
}

/// PNG bytes of a canvas. Fast compression: the file is a third larger and done in a tenth of the time.
fn encode(canvas: &canvas::Canvas) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, canvas.width as u32, canvas.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&canvas.rgb)?;
    writer.finish()?;
    Ok(bytes)
}
