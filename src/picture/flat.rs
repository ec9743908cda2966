//! `flat.png`: flat pieces coloured by strain, with a legend.

use super::canvas::Canvas;
use super::color::{INK, PALE_INK, PAPER, RIM, strain};
use super::paint::limit;
use super::raster::{Band, Corner, NO_CLOTH, SAMPLES};
use super::view::legend;
use super::{HEIGHT, PictureError, WIDTH, encode};
use crate::geometry::{Vec2, box_or_origin};
use crate::mesh::{ClothMesh, PieceMesh};

/// Height above the pieces, for words and the legend, pixels.
const HEAD: usize = 130;
/// Margin round the pieces, pixels.
const MARGIN: f64 = 50.0;
/// Space between pieces, as a share of the largest piece's size.
const GAP: f64 = 0.08;
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
        return Err(PictureError::StrainLength { values: values.len(), vertices: cloth.triangles.len() });
    }
    let limit = limit(values);
    let (places, scale) = places(cloth);
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
                Corner { at: [x * SAMPLES as f32, y * SAMPLES as f32, 0.0], color }
            };
            shapes.push(cloth.triangles[t].map(corner));
        }
    }
    let mut canvas = Canvas::new(WIDTH, HEIGHT, PAPER);
    for top in (HEAD..HEIGHT).step_by(BAND) {
        let rows = BAND.min(HEIGHT - top);
        let mut band = Band::new(WIDTH * SAMPLES, top * SAMPLES, rows * SAMPLES);
        let (first, last) = ((top * SAMPLES) as f32, ((top + rows) * SAMPLES) as f32);
        let meets = |s: &&[Corner; 3]| s.iter().any(|c| c.at[1] <= last) && s.iter().any(|c| c.at[1] >= first);
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
    legend(&mut canvas, limit, "strain of the cloth");
    Ok(encode(&canvas)?)
}

/// Upper left corner of a piece's box, and of its place in the drawing.
struct Place {
    from: Vec2,
    to: Vec2,
}

/// Pieces in rows, as large as they fit. Pixels per metre.
fn places(cloth: &ClothMesh) -> (Vec<Place>, f64) {
    let boxes: Vec<[Vec2; 2]> = cloth.pieces.iter().map(|piece| bounds(cloth, piece)).collect();
    let sizes: Vec<Vec2> = boxes.iter().map(|[low, high]| high - low).collect();
    let gap = GAP * sizes.iter().map(|s| s.max()).fold(f64::MIN_POSITIVE, f64::max);
    let room = Vec2::new(WIDTH as f64, (HEIGHT - HEAD) as f64) - Vec2::repeat(2.0 * MARGIN);
    // Of the numbers of pieces in a row the one that leaves most scale.
    let fitted = |row: usize| {
        let rows = sizes.chunks(row);
        let width = |r: &[Vec2]| r.iter().map(|s| s.x + gap).sum::<f64>() - gap;
        let height = |r: &[Vec2]| r.iter().map(|s| s.y).fold(0.0, f64::max) + gap;
        let widest = rows.clone().map(width).fold(f64::MIN_POSITIVE, f64::max);
        (room.x / widest).min(room.y / rows.map(height).sum::<f64>())
    };
    let best = (1..=sizes.len()).max_by(|&a, &b| fitted(a).total_cmp(&fitted(b)).then(b.cmp(&a))).unwrap_or(1);
    let scale = fitted(best);
    let mut places = Vec::with_capacity(sizes.len());
    let mut at = Vec2::new(MARGIN, HEAD as f64 + MARGIN);
    for row in (0..sizes.len()).collect::<Vec<_>>().chunks(best) {
        for &k in row {
            places.push(Place { from: boxes[k][0], to: at });
            at.x += (sizes[k].x + gap) * scale;
        }
        at.x = MARGIN;
        at.y += (row.iter().map(|&k| sizes[k].y).fold(0.0, f64::max) + gap) * scale;
    }
    (places, scale)
}

fn bounds(cloth: &ClothMesh, piece: &PieceMesh) -> [Vec2; 2] {
    box_or_origin(cloth.flat[piece.particles.clone()].iter().copied())
}
