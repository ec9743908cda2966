//! A garment as its file draws it, for the commands that write papers.

use std::path::Path;

use super::console::Console;
use super::exit::CliError;
use crate::cutting::{DEFAULT_ALLOWANCE, Narrowed, Paper};
use crate::geometry::MM;
use crate::io::garment::{Loaded, Variant};
use crate::pattern::{DrawnPiece, drawings};
use crate::pipeline::read_variant;

/// A garment as it is drawn, to be cut.
pub(super) struct DrawnGarment {
    pub(super) loaded: Loaded,
    pub(super) drawings: Vec<DrawnPiece>,
    /// Seam allowance of edges for which the file gives none, metres.
    pub(super) allowance: f64,
}

impl DrawnGarment {
    /// Reads a size of a garment file, which messages call `shown`. `allowance` is the one asked for, mm.
    pub(super) fn read(
        file: &Path,
        size: Option<&str>,
        allowance: Option<f64>,
        shown: &str,
        console: &Console,
    ) -> Result<Self, CliError> {
        let loaded = read_variant(file, Variant::of_size(size))?;
        loaded.warnings.iter().for_each(|warning| console.note(&warning.to_string()));
        let drawings = drawings(&loaded.file, &loaded.garment);
        if allowance.is_none() && drawings.iter().any(lacks_allowance) {
            let usual = DEFAULT_ALLOWANCE * MM;
            console.note(&format!(
                "{shown} does not give every edge an allowance; these get {usual} mm (--allowance MM for another)"
            ));
        }
        Ok(Self { loaded, drawings, allowance: allowance.map_or(DEFAULT_ALLOWANCE, |mm| mm / MM) })
    }
}

/// Whether an edge that will be cut has no allowance of its own.
fn lacks_allowance(drawing: &DrawnPiece) -> bool {
    let outline = drawing.rings[0].iter().enumerate().filter(|(i, _)| drawing.is_cut(*i)).map(|(_, edge)| edge);
    let sewn_holes = drawing.rings[1..].iter().flatten().filter(|edge| edge.is_sewn());
    outline.chain(sewn_holes).any(|edge| edge.allowance.width.is_none())
}

/// Of holes that are too small for their allowances.
pub(super) fn narrowed(paper: &Paper) -> Vec<String> {
    let mm = |width: f64| (width * MM * 100.0).round() / 100.0;
    let note = |n: &Narrowed| {
        format!(
            "hole '{}' of '{}' has no room for an allowance of {} mm: {} mm are drawn; say a narrower one, or slash \
             into its corners",
            n.edge,
            paper.name,
            mm(n.asked),
            mm(n.drawn)
        )
    };
    paper.narrowed.iter().map(note).collect()
}
