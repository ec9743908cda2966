//! Finding what alterations name: pieces, edges, points of edges, darts, sizes.

use super::Fault;
use super::sheet::{AlteredPiece, EdgeMark};
use crate::input::nearest;
use crate::pattern::{
    DartFile, GarmentFile, Located, Problem, SizeFile, Words, own_shape, parse_quantity, unknown_piece,
};

/// The index of a piece, which gets a shape of its own if it has it by `like`.
pub(super) fn piece(file: &mut GarmentFile, name: &Located<String>) -> Result<usize, Fault> {
    let wanted = name.value.trim();
    let found = file.pieces.iter().position(|p| p.name.value == wanted);
    let names = || file.pieces.iter().map(|p| p.name.value.as_str());
    let index = found.ok_or_else(|| (name.at, unknown_piece(wanted, names())))?;
    own_shape(file, index);
    Ok(index)
}

/// An edge of the file: the index of its piece, and its name. With `sided` a side is read over, as in a seam.
fn words(file: &mut GarmentFile, text: &Located<String>, sided: bool) -> Result<(usize, String), Fault> {
    let words = Words::parse(&text.value).map_err(|problem| (text.at, problem))?;
    let index = piece(file, &Located::new(words.piece, text.at))?;
    if text.value.contains('@') || (!sided && (words.side.is_some() || words.copy.is_some())) {
        return Err((text.at, Problem::AlterPart(text.value.clone())));
    }
    let edge = words.edge.ok_or_else(|| (text.at, Problem::BadReference(text.value.clone())))?;
    Ok((index, edge))
}

/// An edge, with the piece it is on: index of the piece, the piece, index of the edge.
pub(super) fn edge(
    file: &mut GarmentFile,
    text: &Located<String>,
    sided: bool,
) -> Result<(usize, AlteredPiece, usize), Fault> {
    let (index, name) = words(file, text, sided)?;
    let sheet = AlteredPiece::read(file, index)?;
    let edge = edge_of(&sheet, &name).map_err(|problem| (text.at, problem))?;
    Ok((index, sheet, edge))
}

fn edge_of(sheet: &AlteredPiece, name: &str) -> Result<usize, Problem> {
    sheet.names.iter().position(|n| n == name).ok_or_else(|| Problem::UnknownEdge {
        name: format!("{}.{name}", sheet.piece),
        nearest: nearest(name, sheet.names.iter().map(String::as_str)).map(str::to_owned),
        known: format!("{} has: {}", sheet.piece, sheet.names.join(", ")),
    })
}

/// A point of an outline, `piece.edge@50 %`.
pub(super) fn point(file: &mut GarmentFile, text: &Located<String>) -> Result<(usize, EdgeMark), Fault> {
    let bad = || (text.at, Problem::AlterPoint(text.value.clone()));
    let (of, at) = text.value.split_once('@').ok_or_else(bad)?;
    let at = parse_quantity(at).map_err(|_| bad())?;
    let (index, sheet, edge) = edge(file, &Located::new(of.trim().to_owned(), text.at), false)?;
    let at = sheet.place(edge, &Located::new(at, text.at))?;
    Ok((index, EdgeMark { edge, at }))
}

/// A dart on an edge, `piece.dart`: indices of piece and dart.
pub(super) fn dart(file: &mut GarmentFile, text: &Located<String>) -> Result<(usize, usize), Fault> {
    let (index, name) = words(file, text, false)?;
    let piece = &file.pieces[index];
    let names: Vec<String> = (0..piece.darts.len()).map(|i| dart_name(&piece.darts[i], i)).collect();
    let found = names.iter().position(|n| *n == name);
    let unknown = || Problem::UnknownDart {
        name: text.value.clone(),
        nearest: nearest(&name, names.iter().map(String::as_str)).map(str::to_owned),
        known: match names.len() {
            0 => format!("{} has no darts", piece.name.value),
            _ => format!("{} has: {}", piece.name.value, names.join(", ")),
        },
    };
    found.map(|dart| (index, dart)).ok_or_else(|| (text.at, unknown()))
}

/// The name of a dart, which is the `number`-th of its piece.
pub(super) fn dart_name(dart: &DartFile, number: usize) -> String {
    match &dart.name {
        Some(name) => name.value.clone(),
        None if number == 0 => "dart".to_owned(),
        None => format!("dart{}", number + 1),
    }
}

/// The error for a size that is not there.
pub(super) fn unknown_size(name: &str, sizes: &[SizeFile]) -> Problem {
    let names: Vec<&str> = sizes.iter().map(|s| s.name.value.as_str()).collect();
    Problem::UnknownSize {
        name: name.to_owned(),
        nearest: nearest(name, names.iter().copied()).map(str::to_owned),
        known: if names.is_empty() { "none ('sizes:' lists them)".to_owned() } else { names.join(", ") },
    }
}
