//! Edges that acts name, and the list of those that are free.

use super::{ActError, EditError, sense, yaml};
use crate::io::garment::Edit;
use crate::pattern::{CutKind, GarmentFile, PieceFile, glob, whole_pieces};
use crate::studio::names::bare;

/// The piece with an edge called `piece.edge`, perhaps with a side.
///
/// # Errors
/// An edge that is not drawn.
pub(super) fn drawn(said: &GarmentFile, edge: &str) -> Result<PieceFile, ActError> {
    let bare = bare(edge);
    let (piece, name) = bare.split_once('.').ok_or_else(|| ActError::Sense(format!("'{edge}' is no edge")))?;
    let own = whole_pieces(said).into_iter().find(|own| own.name.value == piece);
    let has = |own: &PieceFile| own.outline.iter().any(|o| o.edges.iter().any(|(edge, _)| edge.value == name));
    own.filter(has).ok_or_else(|| ActError::Sense(format!("there is no edge '{edge}'")))
}

/// # Errors
/// An edge on the fold of the cloth, which nothing is sewn to.
pub(super) fn restricted(piece: PieceFile, edge: &str) -> Result<(), ActError> {
    match piece.cut.map(|cut| cut.value) {
        Some(CutKind::Fold(fold)) if bare(edge) == format!("{}.{fold}", piece.name.value) => {
            sense(format!("{edge} lies on the fold of the cloth"))
        }
        _ => Ok(()),
    }
}

/// The seam that takes an edge, or a part of it.
pub(super) fn sewn_in(said: &GarmentFile, edge: &str) -> Option<String> {
    let own = bare(edge);
    let takes = |seam: &&crate::pattern::SeamFile| seam.sew.iter().chain(&seam.to).any(|e| bare(&e.value) == own);
    said.seams.iter().find(takes).map(|seam| seam.name.value.clone())
}

/// `free` with these edges added that are not in it.
///
/// # Errors
/// An edge whose name cannot be written.
pub(super) fn freed(said: &GarmentFile, edges: &[String]) -> Result<Vec<Edit>, ActError> {
    let new = edges.iter().filter(|edge| !said.free.iter().any(|free| glob(&free.value, edge)));
    new.map(|edge| Ok(Edit::Push(vec!["free".into()], yaml(edge)?))).collect()
}

/// `free` without these edges. Where it has all edges of a piece (`front.*`), or of all pieces (`*.*`, as an imported
/// file), it then names those that are left.
///
/// # Errors
/// [`EditError`]: an edge whose name cannot be written.
pub(super) fn unfreed(said: &GarmentFile, edges: &[String]) -> Result<Vec<Edit>, ActError> {
    let gone: Vec<String> = edges.iter().map(|edge| bare(edge)).collect();
    let mut added = Vec::new();
    let mut removed = Vec::new();
    for (index, free) in said.free.iter().enumerate() {
        let of_piece = free.value.strip_suffix(".*").filter(|piece| !piece.contains(['*', '@', '.']));
        if ["*", "*.*"].contains(&free.value.as_str()) && !gone.is_empty() {
            removed.push(index);
            added.extend(said.pieces.iter().flat_map(|piece| left_or_all(said, &piece.name.value, &gone)));
        } else if let Some(piece) = of_piece {
            if gone.iter().any(|edge| glob(&free.value, edge)) {
                removed.push(index);
                added.extend(left(said, piece, &gone));
            }
        } else if !free.value.contains(['*', '@']) && gone.contains(&bare(&free.value)) {
            removed.push(index);
        }
    }
    let at = |index: usize| vec!["free".to_owned(), index.to_string()];
    let mut edits: Vec<Edit> = Vec::new();
    // Added first: a list that would be empty in between would be lost with its comments.
    for edge in added {
        edits.push(Edit::Push(vec!["free".into()], crate::io::garment::scalar(&edge).ok_or(EditError::Text)?));
    }
    edits.extend(removed.into_iter().rev().map(|index| Edit::Remove(at(index))));
    Ok(edits)
}

/// Edges of a piece that are left, as one entry if that is all of them.
fn left_or_all(said: &GarmentFile, piece: &str, gone: &[String]) -> Vec<String> {
    let touches = |edge: &String| edge.split('.').next() == Some(piece);
    let sewn = |seam: &crate::pattern::SeamFile| seam.sew.iter().chain(&seam.to).any(|edge| touches(&edge.value));
    if gone.iter().any(touches) || said.seams.iter().any(sewn) {
        left(said, piece, gone)
    } else {
        vec![format!("{piece}.*")]
    }
}

/// Edges of a piece that neither a seam nor the fold takes, nor are among those that go.
fn left(said: &GarmentFile, piece: &str, gone: &[String]) -> Vec<String> {
    let Some(own) = whole_pieces(said).into_iter().find(|own| own.name.value == piece) else { return Vec::new() };
    let Some(outline) = own.outline.clone() else { return Vec::new() };
    let names = outline.edges.iter().map(|(edge, _)| format!("{piece}.{}", edge.value));
    let is_free = |edge: &String| {
        let listed = said.free.iter().any(|free| free.value == *edge);
        !gone.contains(edge) && !listed && sewn_in(said, edge).is_none() && restricted(own.clone(), edge).is_ok()
    };
    names.filter(is_free).collect()
}
