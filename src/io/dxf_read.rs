//! DXF-AAMA (ASTM D6673) in: a piece per block, lines by the standard's layers.
//!
//! Text files of any release are read as pairs of a group code and a value; of what they hold, polylines (with their
//! arcs), lines, arcs, ellipses, splines, points, texts and blocks within blocks count; what else is on a pattern's
//! layers is said to be left out. Blocks without a boundary are skipped, for programs add some of their own. Of a file
//! that is graded, or has grade rules beside it, one size is read. Where no block is a piece, those are read that lie
//! side by side in the drawing itself.

use std::path::Path as FilePath;

use nalgebra::Matrix2;

use super::dxf_block::Block;
use super::dxf_error::SHOWN;
use super::dxf_flat::flat;
use super::dxf_grade::{InSize, MOST_GRADED};
use super::dxf_left_out::LeftOutEntities;
use super::dxf_library::Library;
use super::dxf_rules::{RuleMistake, RuleTable, rules_beside};
use super::dxf_sizes::{FileSizes, named_apart};
use super::dxf_text::{Entity, after, assumed_unit, blocks, entities, letters, stated_unit};
use super::encoding::decoded;
use crate::digitize::{Drawing, Traced, besides};
use crate::input::{bytes, shown};

pub use super::dxf_error::DxfError;

/// Larger files are not patterns.
const MOST_BYTES: u64 = 30 << 20;
/// Letters of a style's or a table's name that are read.
const TITLE: usize = 200;

/// Notes on a file besides its own statements.
#[derive(Clone, Debug, Default)]
pub struct DxfOptions {
    /// Metres per drawing unit; without it what the file says counts, else millimetres.
    pub unit: Option<f64>,
    /// The size to be read of a file that is graded, in place of its sample size.
    pub size: Option<String>,
}

/// Grade rules that go with a DXF file.
struct RulesFile {
    /// Its name, for messages.
    name: String,
    text: String,
}

/// Reads the pieces of a DXF file, in another size by the grade rules (`.rul`) that lie beside it.
///
/// # Errors
/// [`DxfError`].
pub fn read_dxf(path: &FilePath, options: &DxfOptions) -> Result<Drawing, DxfError> {
    let bytes = bytes(path, MOST_BYTES)?;
    let (text, note) = decoded(&bytes);
    let entities = entities(&text)?;
    let rules = rules_beside(path, told(&entities, "grade rule table:").as_deref())?;
    let rules = rules.map(|(file, text)| RulesFile { name: file.display().to_string(), text });
    let mut drawing = drawing(&entities, options, rules.as_ref())?;
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
    drawing(&entities(text)?, options, None)
}

/// Reads the pieces of a DXF text with the text of its grade rules.
///
/// # Errors
/// As [`read_dxf`].
pub fn read_graded_dxf_text(text: &str, rules: &str, options: &DxfOptions) -> Result<Drawing, DxfError> {
    let rules = RulesFile { name: "the grade rules".to_owned(), text: rules.to_owned() };
    drawing(&entities(text)?, options, Some(&rules))
}

fn drawing(entities: &[Entity], options: &DxfOptions, rules: Option<&RulesFile>) -> Result<Drawing, DxfError> {
    let stated = options.unit.or_else(|| stated_unit(entities));
    let (unit, notes) = stated.map_or_else(|| assumed_unit(entities), |unit| (unit, Vec::new()));
    let mut drawing = Drawing { notes, title: told(entities, "style name:"), ..Drawing::default() };
    let mut unread = LeftOutEntities::default();
    let blocks = blocks(entities);
    let library = Library::new(&blocks, unit);
    let mut all: Vec<(Block, Matrix2<f64>)> = Vec::new();
    for block in &blocks {
        let block = library.block(block, &mut unread)?;
        let placed = library.placed(entities, block.name());
        all.push((block.mapped(placed), placed.map_or_else(Matrix2::identity, |placed| placed.linear)));
    }
    if !all.iter().any(|(block, _)| block.has_boundary()) {
        let loose = flat(library.loose(entities, &mut unread)?);
        all = loose.into_iter().map(|block| (block, Matrix2::identity())).collect();
    }
    let drawn: Vec<&Block> = all.iter().map(|(block, _)| block).collect();
    let mut sizes = FileSizes::new(&drawn, entities);
    let table = rules.filter(|_| drawn.iter().any(|block| block.rules() > 0)).map(|rules| table(rules, unit));
    let table = table.transpose()?.filter(|_| sizes.names().len() < 2);
    if let Some(table) = &table {
        sizes = FileSizes::ruled(table);
    }
    let chosen = sizes.chosen(options.size.as_deref())?;
    drawing.notes.extend(sizes.note(chosen, options.size.is_some()));
    let mut pieces: Vec<Traced> = Vec::new();
    for (block, linear) in all.into_iter().filter(|(block, _)| sizes.is_of(block, chosen)) {
        let block = match table.as_ref().zip(chosen) {
            Some((table, chosen)) if block.has_boundary() => graded(block, table, chosen, linear, &mut drawing),
            _ => block,
        };
        pieces.extend(block.piece(sizes.stem(&block), &mut drawing));
    }
    drawing.sizes = sizes.names().to_vec();
    drawing.pieces = named_apart(pieces);
    drawing.left_out.extend(unread.sentences());
    if drawing.pieces.is_empty() {
        return Err(no_pieces(entities, drawing));
    }
    Ok(drawing)
}

fn table(rules: &RulesFile, unit: f64) -> Result<RuleTable, DxfError> {
    let wrong = |RuleMistake { line, why }| DxfError::Rules { file: rules.name.clone(), line, why };
    RuleTable::read(&rules.text, unit).map_err(wrong)
}

/// A block in the chosen size. It is drawn in the size that it names, or in the table's sample.
fn graded<'a>(
    block: Block<'a>,
    table: &RuleTable,
    chosen: &str,
    linear: Matrix2<f64>,
    drawing: &mut Drawing,
) -> Block<'a> {
    let name = block.text("piece name:").unwrap_or(block.name()).to_owned();
    if block.rules() > MOST_GRADED {
        drawing.notes.push(format!("'{name}' has more than {MOST_GRADED} grade rules: it is the same in all sizes"));
        return block;
    }
    let own = block.text("size:").and_then(|size| table.number(size));
    let from = own.or_else(|| table.number(table.sample.as_deref()?));
    let Some((from, to)) = from.zip(table.number(chosen)) else {
        drawing.notes.push(format!("'{name}' does not say its size, nor do the rules: it is the same in all sizes"));
        return block;
    };
    let InSize { block, graded, missing } = block.in_size(table, [from, to], linear);
    if !graded {
        drawing.notes.push(format!("'{name}' has no points with grade rules: it is the same in all sizes"));
    }
    if !missing.is_empty() {
        let numbers: Vec<String> = missing.iter().map(ToString::to_string).collect();
        let numbers = shown(&numbers.join(", "), SHOWN);
        drawing.notes.push(format!(
            "'{name}' names rules that the table has not ({numbers}): its points there move with \
                                    their neighbours"
        ));
    }
    block
}

fn no_pieces(entities: &[Entity], drawing: Drawing) -> DxfError {
    let mut layers: Vec<&str> = entities.iter().filter_map(|e| e.value(8)).collect();
    layers.sort_unstable();
    layers.dedup();
    let layers = shown(&layers.join(", "), 4 * SHOWN);
    DxfError::NoPieces { layers, besides: besides(&[drawing.faults, drawing.left_out].concat()) }
}

/// The value of the first text that begins with a key, as the style's name.
fn told(entities: &[Entity], key: &str) -> Option<String> {
    let mut texts = entities.iter().filter(|e| e.kind == "TEXT").filter_map(|e| e.value(1));
    let value = texts.find_map(|words| after(words, key).filter(|value| !value.is_empty()))?;
    Some(shown(&letters(value), TITLE))
}
