//! The body that acts choose, and the measures of the wearer.

use super::{ActError, path, sense, typed, yaml};
use crate::geometry::MM;
use crate::io::garment::Edit;
use crate::mannequin::{self, Measures};
use crate::pattern::{GarmentFile, parse_quantity};

/// The body chosen, its measures kept.
pub(super) fn dressed(said: &GarmentFile, name: &str) -> Result<(Vec<Edit>, String), ActError> {
    if !mannequin::library().contains(&name) {
        return sense(format!("there is no mannequin '{name}'"));
    }
    let at = if said.body_measures.is_empty() { path(&["body"]) } else { path(&["body", "like"]) };
    let mut edits = vec![Edit::Set(at, yaml(name)?)];
    // The unit was that of a body of one's own.
    edits.extend(said.body_units.iter().map(|_| Edit::Remove(path(&["body_units"]))));
    Ok((edits, format!("dress {name}")))
}

/// A measure of the wearer. An empty value removes it.
///
/// # Errors
/// A measure that no body has, or one that is missing.
pub(super) fn measured(said: &GarmentFile, name: &str, value: &str) -> Result<(Vec<Edit>, String), ActError> {
    let Some(body) = &said.body else { return sense("choose a body first; the measures change it") };
    let words = name.replace('_', " ");
    if value.trim().is_empty() {
        return without(said, name, &body.value).map(|edits| (edits, format!("no {words} of the wearer")));
    }
    let text = typed(value)?;
    let length = parse_quantity(value.trim()).map_err(|problem| ActError::Sense(problem.to_string()))?;
    // Two names of one measure are found beside those that the file has.
    let mut all = Measures::default();
    for (own, given) in said.body_measures.iter().filter(|(own, _)| own.value != name) {
        all.add(&own.value, given.value.value(said.unit()) * MM).map_err(ActError::Sense)?;
    }
    all.add(name, length.value(said.unit()) * MM).map_err(ActError::Sense)?;
    let label = format!("{words} of the wearer: {}", value.trim());
    if said.body_measures.is_empty() {
        let whole = format!("{{like: {}, {name}: {text}}}", yaml(&body.value)?);
        return Ok((vec![Edit::Set(path(&["body"]), whole)], label));
    }
    Ok((vec![Edit::Set(path(&["body", name]), text)], label))
}

/// The body without a measure; without its last one, its name alone.
fn without(said: &GarmentFile, name: &str, body: &str) -> Result<Vec<Edit>, ActError> {
    if !said.body_measures.iter().any(|(own, _)| own.value == name) {
        return sense(format!("the file has no measure '{name}'"));
    }
    if said.body_measures.len() == 1 {
        return Ok(vec![Edit::Set(path(&["body"]), yaml(body)?)]);
    }
    Ok(vec![Edit::Remove(path(&["body", name]))])
}
