//! Seams that the pieces of a garment file may still have.

use std::collections::BTreeSet;

use super::{Outline, Suggestion, suggest};
use crate::digitize::edges::FileEdge;
use crate::digitize::notches::EdgeNotch;
use crate::digitize::sizes::noted_size;
use crate::geometry::{Path, Vec2};
use crate::pattern::{AllowanceFile, CutKind, GarmentFile, PieceFile, Unit, whole_pieces};

/// The seams that may be meant between edges of a garment file that no seam has yet, those that most speaks for first.
/// Pieces whose outline cannot be read have none.
pub fn suggestions(file: &GarmentFile) -> Vec<Suggestion> {
    let pieces = whole_pieces(file);
    // Sizes beside each other, as an import writes them.
    let sizes: Vec<Option<&str>> = pieces.iter().map(|piece| noted_size(&piece.note.as_ref()?.value)).collect();
    let distinct: BTreeSet<&str> = sizes.iter().flatten().copied().collect();
    let size = |said: Option<&str>| distinct.iter().position(|own| Some(*own) == said).filter(|_| distinct.len() > 1);
    let outlines: Vec<Outline> = pieces
        .iter()
        .zip(&sizes)
        .filter_map(|(piece, said)| Some(Outline { size: size(*said), ..outline(piece, file.unit())? }))
        .collect();
    let (mut found, _) = suggest(outlines);
    let sewn: Vec<String> =
        file.seams.iter().flat_map(|seam| seam.sew.iter().chain(&seam.to)).map(|edge| bare(&edge.value)).collect();
    let names: Vec<&str> = file.seams.iter().map(|seam| seam.name.value.as_str()).collect();
    found.retain(|own| !own.sew.iter().chain(&own.to).any(|edge| sewn.contains(&bare(edge))));
    for own in &mut found {
        own.name = free_name(&own.name, &names);
    }
    found
}

/// `stem`, or `stem_2`, `stem_3` … where that is taken.
fn free_name(stem: &str, taken: &[&str]) -> String {
    let numbered = (2..).map(|number| format!("{stem}_{number}"));
    std::iter::once(stem.to_owned()).chain(numbered).find(|name| !taken.contains(&name.as_str())).unwrap_or_default()
}

/// `front.neck` of `front.L.neck@20%..80%`.
fn bare(edge: &str) -> String {
    let name = edge.split('@').next().unwrap_or_default().trim();
    name.split('.').filter(|word| !["L", "R"].contains(word)).collect::<Vec<_>>().join(".")
}

/// A piece with its edges, all in metres.
fn outline(piece: &PieceFile, unit: Unit) -> Option<Outline> {
    let drawn = piece.outline.as_ref()?;
    let metres = unit.factor();
    let mut at = Vec2::from(drawn.start.value);
    let mut edges = Vec::new();
    for (name, commands) in &drawn.edges {
        let path = Path::parse(at, &commands.value, metres).ok()?;
        at = path.end() / metres;
        let own = piece.notches.iter().filter(|(edge, _)| edge.value == name.value).flat_map(|(_, list)| list);
        let notch = |notch: &crate::pattern::NotchFile| EdgeNotch {
            at: notch.at.value(unit),
            double: notch.double,
            may_be_mouth: false,
        };
        let notches = own.map(|told| notch(&told.value)).collect();
        edges.push(FileEdge { name: name.value.clone(), path, notches });
    }
    let fold = match piece.cut.as_ref().map(|cut| &cut.value) {
        Some(CutKind::Fold(edge)) => Some(edge.clone()),
        _ => None,
    };
    let pair = piece.cut.as_ref().is_some_and(|cut| cut.value == CutKind::Pair);
    let arrow = piece.grain.as_ref().map(|grain| grain.value.map(Vec2::from));
    Some(Outline {
        piece: piece.name.value.clone(),
        allowances: edges.iter().map(|edge| allowance(piece, &edge.name, unit)).collect(),
        edges,
        mirrored: pair || fold.is_some(),
        single: piece.cut.as_ref().is_none_or(|cut| cut.value == CutKind::One),
        fold,
        pair,
        warp: arrow.map_or(Some(Vec2::y()), |[tail, head]| (head - tail).try_normalize(0.0)),
        material: piece.fabric.as_ref().map(|fabric| fabric.value.clone()),
        size: None,
    })
}

/// The allowance of an edge, metres, where the piece has one.
fn allowance(piece: &PieceFile, edge: &str, unit: Unit) -> Option<f64> {
    let width = match piece.allowance.as_ref()? {
        AllowanceFile::All(all) => all.value,
        AllowanceFile::Edges(edges) => edges.iter().find(|(name, _)| name.value == edge)?.1.value,
    };
    Some(width.width.value(unit))
}
