//! Acts: changes of the garment file by clicks and typed lengths. Every act is a change of the text in one place or
//! a few, with all comments kept, and the file that comes out can be read.

mod altering;
mod edges;
mod rename;
mod wearer;

use std::path::Path;

use serde::Deserialize;

use super::names::label;
use crate::digitize::suggestions;
use crate::fabric;
use crate::io::garment::{Edit, EditError, KeyPath, edited, examine_text, read_file_only, scalar, seam_line};
use crate::pattern::{GarmentFile, Located, PlaceWord, SeamFile, Spot, Value, fabrics, parse_quantity};
pub(super) use altering::told;
use edges::{drawn, freed, restricted, sewn_in, unfreed};

/// Longest name, and longest length as typed, characters.
const LONGEST_NAME: usize = 60;
const LONGEST_LENGTH: usize = 30;
/// Most edges of one side of a seam.
const MOST_EDGES: usize = 64;

/// An act that the page asks for.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Act {
    /// Sews two chains of edges. `mirror` alone is the other half of a pair.
    Sew { sew: Vec<String>, to: Vec<String> },
    /// Takes a seam that is offered, with all that is said of it.
    Accept { sew: Vec<String>, to: Vec<String> },
    /// Takes a seam away.
    Unpick { seam: String },
    /// Sets edges free.
    Free { edges: Vec<String> },
    /// Edges are free no more.
    Unfree { edges: Vec<String> },
    /// Gives an edge another name, wherever it is named.
    Name { edge: String, name: String },
    /// Puts a piece on the body by words. None lets it be worked out.
    Place { piece: String, words: Vec<String> },
    /// Chooses the cloth of a fabric.
    Fabric { name: String, cloth: String },
    /// Chooses the body.
    Body { name: String },
    /// A length that the file has.
    Length { path: KeyPath, value: String },
    /// A measure of the wearer. An empty value removes it.
    Measure { name: String, value: String },
    /// Adds alterations, as a garment file writes them or as JSON.
    Alter { alteration: String },
    /// Takes an alteration out, by its number from 0.
    Unalter { number: usize },
    /// Ease of a seam: the excess length of its second side. An empty value removes the statement.
    Ease { seam: String, value: String },
    /// Spacing of the mesh, mm. It is no part of the file.
    Spacing { mm: f64 },
    /// A size of the garment to make. None is the garment as drawn and altered. It is no part of the file.
    Size { name: Option<String> },
    /// Sews the garment from nothing, and not from where the one before hung.
    Anew,
    /// Undoes the last act.
    Undo,
    /// Does it again.
    Redo,
}

/// Why an act was not done. The file is as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum ActError {
    /// The page shows an older state of the file.
    #[error("the file has been changed meanwhile; look at it again")]
    Old,
    /// Nothing can be undone, or the file was changed elsewhere since.
    #[error("there is nothing to undo: the file has been changed elsewhere since the last act, or there was none")]
    NothingToUndo,
    /// The file cannot be read or written.
    #[error("{0}")]
    File(String),
    /// The place in the file cannot be changed.
    #[error(transparent)]
    Edit(#[from] EditError),
    /// The act makes no sense, and why.
    #[error("{0}")]
    Sense(String),
    /// A spacing that is not offered.
    #[error("this spacing is not offered")]
    Spacing,
    /// A size that the file does not have.
    #[error("the file has no size '{0}'")]
    Size(String),
}

/// A file after an act, and the act in words.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Done {
    pub(super) text: String,
    pub(super) label: String,
}

fn sense<T>(why: impl Into<String>) -> Result<T, ActError> {
    Err(ActError::Sense(why.into()))
}

/// A path of keys.
fn path(keys: &[&str]) -> KeyPath {
    keys.iter().map(|key| (*key).to_owned()).collect()
}

fn yaml(text: &str) -> Result<String, ActError> {
    Ok(scalar(text).ok_or(EditError::Text)?)
}

impl Act {
    /// The text of a garment file after this act. `file` is its name in messages.
    ///
    /// # Errors
    /// [`ActError`], with the text as it was.
    pub(super) fn done(&self, text: &str, file: &Path) -> Result<Done, ActError> {
        let shown = file.display().to_string();
        let said = read_file_only(&shown, text);
        let said = said.map_err(|_| ActError::Sense("the file cannot be read; mend it in an editor first".into()))?;
        let (edits, label) = self.edits(&said, text)?;
        let new = edited(text, &edits)?;
        if new == text {
            return sense("nothing would change");
        }
        let errors = |text: &str| examine_text("garment", &shown, text).findings.errors();
        if matches!(self, Self::Name { .. }) && errors(&new) > errors(text) {
            return sense("this edge is named in a place that only an editor can change");
        }
        if matches!(self, Self::Alter { .. }) {
            altering::carried_out(text, &new, &shown)?;
        }
        match read_file_only(&shown, &new) {
            Ok(_) => Ok(Done { text: new, label }),
            Err(refused) => sense(refused.diagnostics.first().map(|d| d.message.clone()).unwrap_or_default()),
        }
    }

    /// The changes of the text, and the act in words.
    fn edits(&self, said: &GarmentFile, text: &str) -> Result<(Vec<Edit>, String), ActError> {
        match self {
            Self::Sew { sew, to } => sewing(said, sew, to),
            Self::Accept { sew, to } => {
                let offers = suggestions(said);
                let offer = offers.iter().find(|offer| offer.sew == *sew && offer.to == *to);
                let Some(offer) = offer else { return sense("this seam is not offered any more") };
                seam(said, offer.seam())
            }
            Self::Unpick { seam } => {
                let edit = Edit::Remove(path(&["seams", seam]));
                Ok((vec![edit], format!("unpick seam {seam}")))
            }
            Self::Free { edges } => {
                for edge in edges {
                    drawn(said, edge)?;
                    if let Some(seam) = sewn_in(said, edge) {
                        return sense(format!("{edge} is sewn in the seam '{seam}'; unpick that first"));
                    }
                }
                Ok((freed(said, edges)?, format!("set {} free", edges.join(", "))))
            }
            Self::Unfree { edges } => {
                edges.iter().try_for_each(|edge| drawn(said, edge).map(drop))?;
                Ok((unfreed(said, edges)?, format!("{} no longer free", edges.join(", "))))
            }
            Self::Name { edge, name } => rename::edits(said, text, edge, name),
            Self::Place { piece, words } => placing(said, piece, words),
            Self::Fabric { name, cloth } => cloth_of(said, name, cloth),
            Self::Body { name } => wearer::dressed(said, name),
            Self::Measure { name, value } => wearer::measured(said, name, value),
            Self::Alter { alteration } => altering::added(alteration),
            Self::Unalter { number } => altering::dropped(said, *number),
            Self::Length { path, value } => length(path, value),
            Self::Ease { seam, value } => easing(said, seam, value),
            Self::Spacing { .. } | Self::Size { .. } | Self::Anew | Self::Undo | Self::Redo => {
                sense("this is no change of the file")
            }
        }
    }
}

/// A seam between chains that were clicked.
fn sewing(said: &GarmentFile, sew: &[String], to: &[String]) -> Result<(Vec<Edit>, String), ActError> {
    let mirrored = to == ["mirror"];
    let all: Vec<&String> = sew.iter().chain(to.iter().filter(|_| !mirrored)).collect();
    if sew.is_empty() || to.is_empty() || all.len() > 2 * MOST_EDGES {
        return sense("choose an edge, or a chain of edges, for both sides");
    }
    for (number, edge) in all.iter().enumerate() {
        restricted(drawn(said, edge)?, edge)?;
        if all[..number].contains(edge) {
            return sense(format!("{edge} is chosen twice"));
        }
        if let Some(seam) = sewn_in(said, edge) {
            return sense(format!("{edge} is sewn in the seam '{seam}' already; unpick that first"));
        }
    }
    let nowhere = |edge: &String| Located::new(edge.clone(), Spot::default());
    let mut stems: Vec<&str> = all.iter().map(|edge| edge.split('.').next().unwrap_or_default()).collect();
    stems.dedup();
    stems.truncate(3);
    let name = Located::new(stems.join("_"), Spot::default());
    seam(said, SeamFile::new(name, sew.iter().map(nowhere).collect(), to.iter().map(nowhere).collect()))
}

/// A seam added under a name that no other has. Its edges are free no more.
fn seam(said: &GarmentFile, mut own: SeamFile) -> Result<(Vec<Edit>, String), ActError> {
    let stem = own.name.value.clone();
    let is_taken = |name: &str| said.seams.iter().any(|seam| seam.name.value == name);
    let mut again = 2;
    while is_taken(&own.name.value) {
        own.name.value = format!("{stem}_{again}");
        again += 1;
    }
    let line = seam_line(&own).map_err(|e| ActError::Sense(e.to_string()))?;
    let (name, body) = line.split_once(": ").ok_or_else(|| ActError::Sense("a seam without a name".into()))?;
    let edges: Vec<String> =
        own.sew.iter().chain(&own.to).map(|edge| edge.value.clone()).filter(|edge| edge != "mirror").collect();
    let mut edits = vec![Edit::Set(path(&["seams", name]), body.to_owned())];
    edits.extend(unfreed(said, &edges)?);
    let side = |list: &[Located<String>]| list.iter().map(|e| e.value.as_str()).collect::<Vec<_>>().join(" + ");
    Ok((edits, format!("sew {} to {}", side(&own.sew), side(&own.to))))
}

fn placing(said: &GarmentFile, piece: &str, words: &[String]) -> Result<(Vec<Edit>, String), ActError> {
    let Some(own) = said.pieces.iter().find(|own| own.name.value == piece) else {
        return sense(format!("there is no piece '{piece}'"));
    };
    let at = path(&["pieces", piece, "place"]);
    if words.is_empty() {
        let edits = own.place.iter().map(|_| Edit::Remove(at.clone())).collect();
        return Ok((edits, format!("let the place of {piece} be worked out")));
    }
    if let Some(wrong) = words.iter().find(|word| PlaceWord::parse(word).is_none()) {
        return sense(format!("'{wrong}' is no place on a body"));
    }
    let words = words.join(" ");
    Ok((vec![Edit::Set(at, yaml(&words)?)], format!("place {piece}: {words}")))
}

fn cloth_of(said: &GarmentFile, name: &str, cloth: &str) -> Result<(Vec<Edit>, String), ActError> {
    if !fabric::library().contains(&cloth) {
        return sense(format!("there is no fabric '{cloth}' in the library"));
    }
    if !fabrics(said).iter().any(|fabric| fabric.name == name) {
        return sense(format!("the file has no fabric '{name}'"));
    }
    if said.fabrics.iter().any(|(own, value)| own.value == name && !matches!(value.value, Value::Text(_))) {
        return sense(format!(
            "the fabric '{name}' has values of its own, which would be lost; change it in an editor"
        ));
    }
    Ok((vec![Edit::Set(path(&["fabrics", name]), yaml(cloth)?)], format!("cut {name} from {cloth}")))
}

/// A length as typed, as the file has it.
fn typed(value: &str) -> Result<String, ActError> {
    let value = value.trim();
    if value.chars().count() > LONGEST_LENGTH {
        return sense("this is no length: a number, perhaps with a unit (12, 1.2 cm, 5 %)");
    }
    parse_quantity(value).map_err(|problem| ActError::Sense(problem.to_string()))?;
    yaml(value)
}

fn length(path: &KeyPath, value: &str) -> Result<(Vec<Edit>, String), ActError> {
    let Some(label) = label(path) else { return sense("this is no length of the file") };
    let value = typed(value)?;
    Ok((vec![Edit::Set(path.clone(), value.clone())], format!("{label}: {value}")))
}

fn easing(said: &GarmentFile, seam: &str, value: &str) -> Result<(Vec<Edit>, String), ActError> {
    let Some(own) = said.seams.iter().find(|own| own.name.value == seam) else {
        return sense(format!("there is no seam '{seam}'"));
    };
    let at = path(&["seams", seam, "ease"]);
    if value.trim().is_empty() {
        let edits = own.ease.iter().map(|_| Edit::Remove(at.clone())).collect();
        return Ok((edits, format!("no ease in seam {seam}")));
    }
    let value = typed(value)?;
    Ok((vec![Edit::Set(at, value.clone())], format!("ease {value} in seam {seam}")))
}

#[cfg(test)]
mod tests;
