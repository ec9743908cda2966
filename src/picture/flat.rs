//! `flat.png`: flat pieces coloured by strain, with a legend.

use super::canvas::Canvas;
use super::color::{INK, PALE_INK, PAPER, RIM, strain};
use super::paint::limit;
use super::places::places;
use super::raster::{NO_CLOTH, PanelRows, SAMPLES, ScreenCorner};
use super::view::legend;
use super::{HEIGHT, PictureError, Scale, WIDTH, encode};
use crate::geometry::{Vec2, box_or_origin};
use crate::mesh::{ClothMesh, PieceMesh};

/// Pixels above the pieces, for words and the legend.
const HEAD: usize = 130;
/// Rows of pixels drawn at a time.
const BAND: usize = 64;
/// Half the width of the outlines, pixels.
const OUTLINE: f32 = 1.4;

/// Draws the pieces of `cloth` at its flat positions, side by side to one scale. `values` are strains, one per
/// triangle: red is longer, blue shorter.
///
/// # Errors
/// When there is nothing to draw or values are missing ([`PictureError`]).
pub fn draw_flat(cloth: &ClothMesh, values: &[f64], title: &str) -> Result<Vec<u8>, PictureError> {
    if cloth.triangles.is_empty() || !cloth.flat.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
        return Err(PictureError::NothingToDraw);
    }
    if values.len() != cloth.triangles.len() {
        return Err(PictureError::ValuesLength { values: values.len(), vertices: cloth.triangles.len() });
    }
    let limit = limit(values);
    let boxes: Vec<[Vec2; 2]> = cloth.pieces.iter().map(|piece| bounds(cloth, piece)).collect();
    let (places, scale) = places(&boxes, HEAD, HEIGHT);
    let at = |piece: usize, v: u32| {
        let p = (cloth.flat[v as usize] - places[piece].from) * scale + places[piece].to;
        [p.x as f32, p.y as f32]
    };
    let mut shapes = Vec::with_capacity(cloth.triangles.len());
    for (k, piece) in cloth.pieces.iter().enumerate() {
        for t in piece.triangles.clone() {
            let color = strain((values[t] / limit) as f32);
            let corner = |v: u32| {
                let [x, y] = at(k, v);
                ScreenCorner { at: [x * SAMPLES as f32, y * SAMPLES as f32, 0.0], color }
            };
            shapes.push(cloth.triangles[t].map(corner));
        }
    }
    let mut canvas = Canvas::new(WIDTH, HEIGHT, PAPER);
    for top in (HEAD..HEIGHT).step_by(BAND) {
        let rows = BAND.min(HEIGHT - top);
        let mut band = PanelRows::new(WIDTH * SAMPLES, top * SAMPLES, rows * SAMPLES);
        let (first, last) = ((top * SAMPLES) as f32, ((top + rows) * SAMPLES) as f32);
        let meets = |s: &&[ScreenCorner; 3]| s.iter().any(|c| c.at[1] <= last) && s.iter().any(|c| c.at[1] >= first);
        shapes.iter().filter(meets).for_each(|shape| band.triangle(shape, NO_CLOTH));
        canvas.paste(0, top, WIDTH, &band.pixels());
    }
    for (k, piece) in cloth.pieces.iter().enumerate() {
        for step in piece.edges.iter().flat_map(|e| e.particles.windows(2)) {
            canvas.line(at(k, step[0]), at(k, step[1]), OUTLINE, RIM);
        }
        let [x, y] = [places[k].to.x as f32, places[k].to.y as f32];
        canvas.text(&piece.name, [x, y - 8.0], 2.0, PALE_INK);
    }
    canvas.text(title, [56.0, 72.0], 5.0, INK);
    legend(&mut canvas, Scale::Strain, limit, "strain of the cloth");
    Ok(encode(&canvas)?)
}

fn bounds(cloth: &ClothMesh, piece: &PieceMesh) -> [Vec2; 2] {
    box_or_origin(cloth.flat[piece.particles.clone()].iter().copied())
}
