//! DXF-AAMA (ASTM D6673) in: a piece per block, lines by the standard's layers.
//!
//! Text files of any release are read as pairs of a group code and a value; of what they hold, polylines (with their
//! arcs), lines, arcs, ellipses, splines, points, texts and blocks within blocks count; what else is on a pattern's
//! layers is said to be left out. Blocks without a boundary are skipped, for programs add some of their own. Of a file
//! that is graded one size is read. Where no block is a piece, those are read that lie side by side in the drawing
//! itself.

use std::path::Path as FilePath;

use super::dxf_block::Block;
use super::dxf_error::SHOWN;
use super::dxf_flat::flat;
use super::dxf_left_out::LeftOutEntities;
use super::dxf_library::Library;
use super::dxf_sizes::{FileSizes, named_apart};
use super::dxf_text::{Entity, after, assumed_unit, blocks, entities, letters, stated_unit};
use super::encoding::decoded;
use crate::digitize::{Drawing, Traced, besides};
use crate::input::{bytes, shown};

pub use super::dxf_error::DxfError;

/// Larger files are not patterns.
const MOST_BYTES: u64 = 30 << 20;
/// Letters of a style's name that are read.
const TITLE: usize = 200;

/// Notes on a file besides its own statements.
#[derive(Clone, Debug, Default)]
pub struct DxfOptions {
    /// Metres per drawing unit; without it what the file says counts, else millimetres.
    pub unit: Option<f64>,
    /// The size to be read of a file that is graded, in place of its sample size.
    pub size: Option<String>,
}

/// Reads the pieces of a DXF file.
///
/// # Errors
/// [`DxfError`].
pub fn read_dxf(path: &FilePath, options: &DxfOptions) -> Result<Drawing, DxfError> {
    let bytes = bytes(path, MOST_BYTES)?;
    let (text, note) = decoded(&bytes);
    let mut drawing = read_dxf_text_as(&text, options)?;
    drawing.notes.extend(note);
    Ok(drawing)
}

/// Reads the pieces of a DXF text; `unit` is metres per drawing unit in place of what the file says.
///
/// # Errors
/// As [`read_dxf`].
pub fn read_dxf_text(text: &str, unit: Option<f64>) -> Result<Drawing, DxfError> {
    read_dxf_text_as(text, &DxfOptions { unit, size: None })
}

/// Reads the pieces of a DXF text as is said besides.
///
/// # Errors
/// As [`read_dxf`].
pub fn read_dxf_text_as(text: &str, options: &DxfOptions) -> Result<Drawing, DxfError> {
    let entities = entities(text)?;
    let stated = options.unit.or_else(|| stated_unit(&entities));
    let (unit, notes) = stated.map_or_else(|| assumed_unit(&entities), |unit| (unit, Vec::new()));
    let mut drawing = Drawing { notes, title: title(&entities), ..Drawing::default() };
    let mut unread = LeftOutEntities::default();
    let blocks = blocks(&entities);
    let library = Library::new(&blocks, unit);
    let mut all: Vec<Block> = Vec::new();
    for block in &blocks {
        let block = library.block(block, &mut unread)?;
        let placed = library.placed(&entities, block.name());
        all.push(block.mapped(placed));
    }
    if !all.iter().any(Block::has_boundary) {
        all = flat(library.loose(&entities, &mut unread)?);
    }
    let sizes = FileSizes::new(&all, &entities);
    let chosen = sizes.chosen(options.size.as_deref())?;
    drawing.notes.extend(sizes.note(chosen, options.size.is_some()));
    let mut pieces: Vec<Traced> = Vec::new();
    for block in all.iter().filter(|block| sizes.is_of(block, chosen)) {
        pieces.extend(block.piece(sizes.stem(block), &mut drawing));
    }
    drawing.sizes = sizes.names().to_vec();
    drawing.pieces = named_apart(pieces);
    drawing.left_out.extend(unread.sentences());
    if drawing.pieces.is_empty() {
        let mut layers: Vec<&str> = entities.iter().filter_map(|e| e.value(8)).collect();
        layers.sort_unstable();
        layers.dedup();
        let layers = shown(&layers.join(", "), 4 * SHOWN);
        let besides = besides(&[drawing.faults, drawing.left_out].concat());
        return Err(DxfError::NoPieces { layers, besides });
    }
    Ok(drawing)
}

/// The style's name.
fn title(entities: &[Entity]) -> Option<String> {
    let mut texts = entities.iter().filter(|e| e.kind == "TEXT").filter_map(|e| e.value(1));
    let name = texts.find_map(|words| after(words, "style name:").filter(|name| !name.is_empty()))?;
    Some(shown(&letters(name), TITLE))
}
