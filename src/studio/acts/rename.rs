//! Another name for an edge, wherever the file names it.

use super::edges::drawn;
use super::{ActError, LONGEST_NAME, path, sense, yaml};
use crate::io::garment::{Edit, keys, scalars};
use crate::pattern::{GarmentFile, PieceFile, glob, whole_pieces};
use crate::studio::names::bare;

/// Parts of the file that name edges as `piece.edge`.
const NAMING: [&str; 6] = ["seams", "free", "closures", "tests", "alter", "sizes"];

/// The changes that give an edge another name.
///
/// # Errors
/// An edge that is not there, and a name that cannot be one or is taken.
pub(super) fn edits(said: &GarmentFile, text: &str, edge: &str, name: &str) -> Result<(Vec<Edit>, String), ActError> {
    let piece = drawn(said, edge)?;
    let bare = bare(edge);
    let old = bare.split_once('.').map_or("", |(_, old)| old);
    check(&piece, name)?;
    let owner = owner(said, &piece.name.value);
    let family: Vec<String> = said
        .pieces
        .iter()
        .map(|piece| piece.name.value.clone())
        .filter(|piece| self::owner(said, piece) == owner)
        .collect();
    let mut edits = vec![Edit::Rename(path(&["pieces", &owner, "outline", old]), name.to_owned())];
    for (at, value) in scalars(text) {
        let words: Vec<&str> = at.iter().map(String::as_str).collect();
        let new = match words[..] {
            // The end of an opening is named without its piece.
            ["seams", seam, "open", .., "from"] => {
                (begins(said, seam, &family) && value == old).then(|| name.to_owned())
            }
            [part, ..] if NAMING.contains(&part) => renamed(&value, &family, old, name),
            ["pieces", piece, "cut"] if family.iter().any(|own| own == piece) => {
                (value == format!("fold {old}")).then(|| format!("fold {name}"))
            }
            ["pieces", piece, "darts" | "pleats", _, "edge" | "toward"] if family.iter().any(|own| own == piece) => {
                (value == old).then(|| name.to_owned())
            }
            _ => None,
        };
        if let Some(new) = new {
            edits.push(Edit::Set(at, yaml(&new)?));
        }
    }
    for piece in &family {
        for part in ["notches", "allowance"] {
            let at = path(&["pieces", piece, part]);
            if keys(text, &at).iter().any(|key| key == old) {
                edits.push(Edit::Rename([at, vec![old.to_owned()]].concat(), name.to_owned()));
            }
        }
    }
    edits.extend(still_free(said, &family, old, name)?);
    Ok((edits, format!("name {bare}: {name}")))
}

/// Whether a seam begins with an edge of one of these pieces.
fn begins(said: &GarmentFile, seam: &str, family: &[String]) -> bool {
    let own = said.seams.iter().find(|own| own.name.value == seam).and_then(|own| own.sew.first());
    own.is_some_and(|edge| family.iter().any(|piece| edge.value.split('.').next() == Some(piece)))
}

/// Entries for edges that were free by a pattern such as `*.hem`, which their new name does not fit. A pattern that
/// then fits no edge at all goes.
fn still_free(said: &GarmentFile, family: &[String], old: &str, new: &str) -> Result<Vec<Edit>, ActError> {
    let is_free = |edge: &str| said.free.iter().any(|free| free.value.contains('*') && glob(&free.value, edge));
    let lost = family.iter().filter(|piece| is_free(&format!("{piece}.{old}")) && !is_free(&format!("{piece}.{new}")));
    let added: Result<Vec<Edit>, ActError> =
        lost.map(|piece| Ok(Edit::Push(path(&["free"]), yaml(&format!("{piece}.{new}"))?))).collect();
    let pieces = whole_pieces(said);
    let edges: Vec<String> = pieces
        .iter()
        .flat_map(|piece| piece.outline.iter().flat_map(|o| &o.edges).map(move |(edge, _)| (piece, &edge.value)))
        .map(|(piece, edge)| {
            let is_own = edge == old && family.contains(&piece.name.value);
            format!("{}.{}", piece.name.value, if is_own { new } else { edge })
        })
        .collect();
    let fits = |pattern: &str| edges.iter().any(|edge| glob(pattern, edge));
    let before = |pattern: &str| family.iter().any(|piece| glob(pattern, &format!("{piece}.{old}")));
    let gone = (0..said.free.len()).rev().filter(|&k| before(&said.free[k].value) && !fits(&said.free[k].value));
    let gone = gone.filter(|&k| said.free[k].value.contains('*'));
    let mut edits = added?;
    edits.extend(gone.map(|k| Edit::Remove(path(&["free", &k.to_string()]))));
    Ok(edits)
}

/// # Errors
/// A name that no edge can have, or that another one of the piece has.
fn check(piece: &PieceFile, name: &str) -> Result<(), ActError> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
    if !begins || !name.chars().all(is_word) || name.len() > LONGEST_NAME || ["L", "R", "start"].contains(&name) {
        return sense("a name has letters, digits, '_' and '-', begins with a letter, and is not L, R or start");
    }
    let taken = piece.outline.iter().any(|outline| outline.edges.iter().any(|(edge, _)| edge.value == name));
    let taken = taken || piece.darts.iter().any(|dart| dart.name.as_ref().is_some_and(|own| own.value == name));
    if taken { sense(format!("{} has '{name}' already", piece.name.value)) } else { Ok(()) }
}

/// The piece whose outline a piece has: its own, or that of the one it is like.
fn owner(said: &GarmentFile, piece: &str) -> String {
    let mut name = piece.to_owned();
    // A circle of pieces has no outline, and nobody asks for it.
    for _ in 0..said.pieces.len() {
        let own = said.pieces.iter().find(|own| own.name.value == name);
        let Some(like) = own.filter(|own| own.outline.is_none()).and_then(|own| own.like.as_ref()) else { break };
        name.clone_from(&like.value);
    }
    name
}

/// A reference such as `front.L.side@0..50` with its edge renamed, if it is one of this edge.
fn renamed(reference: &str, family: &[String], old: &str, new: &str) -> Option<String> {
    let (name, range) = reference.split_once('@').map_or((reference, None), |(name, range)| (name, Some(range)));
    let mut words: Vec<&str> = name.split('.').collect();
    if !family.iter().any(|piece| words.first() == Some(&piece.as_str())) {
        return None;
    }
    let place = words.iter().skip(1).position(|word| word.trim_end() == old)? + 1;
    words[place] = new;
    Some(range.map_or_else(|| words.join("."), |range| format!("{}@{range}", words.join("."))))
}
