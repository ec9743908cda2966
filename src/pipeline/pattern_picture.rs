//! A garment file as a picture: what was read of a drawing.

use super::error::PipelineError;
use crate::geometry::{Path, Vec2};
use crate::pattern::{GarmentFile, Located, PieceFile, SeamFile, Unit};
use crate::picture::{PatternEdge, PatternPiece, draw_pattern};

/// Draws the pieces of a file with their edges, notches and lines, and these seams in colours, each with the line that
/// tells it. The file need not make a garment.
///
/// # Errors
/// A file without an outline.
pub fn pattern_picture(file: &GarmentFile, seams: &[(SeamFile, String)]) -> Result<Vec<u8>, PipelineError> {
    let pieces: Vec<PatternPiece> = file.pieces.iter().filter_map(|piece| shown(piece, file.unit(), seams)).collect();
    let title = file.name.as_ref().map_or("", |name| &name.value);
    let said: Vec<String> = seams.iter().map(|(_, said)| said.clone()).collect();
    Ok(draw_pattern(title, &pieces, &said)?)
}

/// A piece as drawn; `None` of one without an outline that can be read.
fn shown(piece: &PieceFile, unit: Unit, seams: &[(SeamFile, String)]) -> Option<PatternPiece> {
    let outline = piece.outline.as_ref()?;
    let metres = unit.factor();
    let mut at = Vec2::from(outline.start.value);
    let mut edges = Vec::new();
    for (name, commands) in &outline.edges {
        let path = Path::parse(at, &commands.value, metres).ok()?;
        at = path.end() / metres;
        let own = piece.notches.iter().filter(|(edge, _)| edge.value == name.value).flat_map(|(_, list)| list);
        let notches = own.map(|n| (n.value.at.value(unit), n.value.double)).collect();
        let seam = seams.iter().position(|(seam, _)| takes(seam, &piece.name.value, &name.value));
        edges.push(PatternEdge { name: name.value.clone(), path, notches, seam });
    }
    let whole = |text: &Located<String>| Path::parse_absolute(&text.value, metres).ok();
    let holes = piece.holes.iter().filter_map(|(_, ring)| whole(ring));
    let lines = piece.lines.iter().filter_map(|line| whole(&line.path));
    let grain = piece.grain.as_ref().map(|g| g.value.map(|p| Vec2::from(p) * metres));
    Some(PatternPiece { name: piece.name.value.clone(), edges, lines: holes.chain(lines).collect(), grain })
}

/// Whether a seam has an edge of a piece, on whichever side.
fn takes(seam: &SeamFile, piece: &str, edge: &str) -> bool {
    let is = |written: &str| {
        let words: Vec<&str> = written.split('.').filter(|word| !["L", "R"].contains(word)).collect();
        words == [piece, edge]
    };
    seam.sew.iter().chain(&seam.to).any(|written| is(&written.value))
}
