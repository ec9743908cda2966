//! The fabrics that a drawing names.

use super::file::{is_usable, word};
use super::{Material, Traced};
use crate::fabric::library;
use crate::pattern::DEFAULT_CLOTH;

/// A fabric of the garment file to come.
pub(super) struct Declared {
    pub(super) name: String,
    /// The library's fabric that stands for it.
    pub(super) cloth: String,
}

/// Every material of the pieces once, in the order of the drawing. Materials that are not described are noted, because
/// the garment could not be made without one.
pub(super) fn declared(pieces: &[Traced], notes: &mut Vec<String>) -> Vec<Declared> {
    let mut declared: Vec<Declared> = Vec::new();
    for material in pieces.iter().filter_map(|p| p.material.as_ref()) {
        let name = name_of(material);
        if declared.iter().any(|d| d.name == name) {
            continue;
        }
        let cloth = shipped(material).unwrap_or_else(|| {
            notes.push(format!(
                "the drawing does not say which fabric '{name}' is: it is declared as {DEFAULT_CLOTH}; write the right \
                 one of 'toile fabric list', or a file, under 'fabrics'"
            ));
            DEFAULT_CLOTH
        });
        declared.push(Declared { name, cloth: cloth.to_owned() });
    }
    declared
}

/// As a garment file names it.
pub(super) fn name_of(material: &Material) -> String {
    let word = word(&material.name);
    if is_usable(&word) { word } else { format!("fabric{word}") }
}

/// The fabric of the library that a drawing says a material is, or that is called as the material is.
fn shipped(material: &Material) -> Option<&'static str> {
    let called = word(&material.name).to_lowercase();
    let find = |name: &str| library().into_iter().find(|shipped| *shipped == name);
    material.cloth.as_deref().and_then(find).or_else(|| find(&called))
}
