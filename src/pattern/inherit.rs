//! `like:` — a piece takes every statement it does not make itself from another piece.

use std::collections::HashMap;

use super::diagnostic::Findings;
use super::file::{GarmentFile, PieceFile};
use super::problem::Problem;
use crate::input::nearest;

/// The pieces of `file` with every `like` followed, for those who look at a file that need not make a garment. Pieces
/// whose chain of `like` is broken are left out.
pub fn whole_pieces(file: &GarmentFile) -> Vec<PieceFile> {
    complete_pieces(file, &mut Findings::default())
}

/// The pieces of `file` with every `like` followed. Pieces whose chain of `like` is broken are left out, reported.
pub(super) fn complete_pieces(file: &GarmentFile, findings: &mut Findings) -> Vec<PieceFile> {
    let by_name: HashMap<&str, &PieceFile> = file.pieces.iter().map(|p| (p.name.value.as_str(), p)).collect();
    file.pieces.iter().filter_map(|piece| complete(piece, &by_name, findings)).collect()
}

fn complete(piece: &PieceFile, by_name: &HashMap<&str, &PieceFile>, findings: &mut Findings) -> Option<PieceFile> {
    let mut whole = piece.clone();
    let mut chain = vec![piece.name.value.as_str()];
    let mut next = piece.like.as_ref();
    while let Some(like) = next {
        let Some(base) = by_name.get(like.value.as_str()) else {
            findings.error(like.at, unknown_piece(&like.value, by_name.keys().copied()));
            return None;
        };
        chain.push(&like.value);
        if chain[..chain.len() - 1].contains(&like.value.as_str()) {
            findings.error(like.at, Problem::LikeCircle(chain.join(", ")));
            return None;
        }
        fill(&mut whole, base);
        next = base.like.as_ref();
    }
    Some(whole)
}

fn fill(piece: &mut PieceFile, base: &PieceFile) {
    fn or<T: Clone>(own: &mut Option<T>, base: &Option<T>) {
        if own.is_none() {
            own.clone_from(base);
        }
    }
    fn or_list<T: Clone>(own: &mut Vec<T>, base: &[T]) {
        if own.is_empty() {
            *own = base.to_vec();
        }
    }
    or(&mut piece.fabric, &base.fabric);
    or(&mut piece.cut, &base.cut);
    or(&mut piece.drawn, &base.drawn);
    or(&mut piece.layer, &base.layer);
    or(&mut piece.allowance, &base.allowance);
    or(&mut piece.grain, &base.grain);
    or(&mut piece.place, &base.place);
    or(&mut piece.outline, &base.outline);
    or_list(&mut piece.notches, &base.notches);
    or_list(&mut piece.darts, &base.darts);
    or_list(&mut piece.pleats, &base.pleats);
    or_list(&mut piece.holes, &base.holes);
    or_list(&mut piece.lines, &base.lines);
}

/// Writes into a piece without an outline of its own the shape that it has by `like`, so that it can be altered alone.
pub(crate) fn own_shape(file: &mut GarmentFile, index: usize) {
    if file.pieces[index].outline.is_some() {
        return;
    }
    let by_name = file.pieces.iter().map(|p| (p.name.value.as_str(), p)).collect();
    // A broken chain of `like` is reported when the pieces are completed.
    if let Some(whole) = complete(&file.pieces[index], &by_name, &mut Findings::default()) {
        let own = &mut file.pieces[index];
        own.outline = whole.outline;
        own.grain = whole.grain;
        own.notches = whole.notches;
        own.darts = whole.darts;
        own.pleats = whole.pleats;
        own.holes = whole.holes;
        own.lines = whole.lines;
    }
}

/// The error for a piece that is not there.
pub(crate) fn unknown_piece<'a>(name: &str, names: impl IntoIterator<Item = &'a str>) -> Problem {
    let mut names: Vec<&str> = names.into_iter().collect();
    names.sort_unstable();
    Problem::UnknownPiece {
        name: name.to_owned(),
        nearest: nearest(name, names.iter().copied()).map(str::to_owned),
        known: names.join(", "),
    }
}
