//! Variants of a garment file: a size of it, and alterations that are given beside it.

use super::decode_alter::{alterations, changes, no_alteration};
use super::refuse::refuse;
use super::{Refused, tree};
use crate::alter::carry_out;
use crate::pattern::{AlterationFile, Findings, GarmentFile, Located, Value};

/// The name, in messages, of alterations that stand in no file.
const SHOWN: &str = "alteration";

/// A garment other than its file draws it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variant<'a> {
    /// A size of the garment, as its file names it.
    pub size: Option<&'a str>,
    /// Further alterations, carried out in order after those of the file and the size. Each text has one, a list, or
    /// what a file of changes has: YAML or JSON.
    pub alter: &'a [String],
}

impl<'a> Variant<'a> {
    /// A size of the garment without further alterations. `None` is the garment as it is drawn and altered.
    pub fn of_size(size: Option<&'a str>) -> Self {
        Self { size, ..Self::default() }
    }

    /// Carries out the further alterations.
    ///
    /// # Errors
    /// A text without alterations, or one that cannot be carried out.
    pub(super) fn carried_out(&self, mut file: GarmentFile) -> Result<GarmentFile, Refused> {
        for text in self.alter {
            let mut findings = Findings::new(SHOWN, text);
            let list = parsed(text, &mut findings);
            carry_out_read(&mut file, &list, findings)?;
        }
        Ok(file)
    }
}

/// Carries out alterations that have just been read, unless that found an error.
///
/// # Errors
/// The findings, if one of them is an error.
pub(super) fn carry_out_read(
    file: &mut GarmentFile,
    list: &[Located<AlterationFile>],
    mut findings: Findings,
) -> Result<(), Refused> {
    if findings.errors() == 0 {
        carry_out(file, list, &mut findings);
    }
    refuse(findings)
}

/// Checks a text of alterations without carrying them out, and counts them.
///
/// # Errors
/// Every mistake of the text.
pub fn alterations_in(text: &str) -> Result<usize, Refused> {
    alterations_of(text).map(|list| list.len())
}

/// Reads a text of alterations without carrying them out: one, a list, or what a file of changes has.
///
/// # Errors
/// Every mistake of the text.
pub fn alterations_of(text: &str) -> Result<Vec<AlterationFile>, Refused> {
    let mut findings = Findings::new(SHOWN, text);
    let list = parsed(text, &mut findings);
    refuse(findings).map(|()| list.into_iter().map(|own| own.value).collect())
}

fn parsed(text: &str, findings: &mut Findings) -> Vec<Located<AlterationFile>> {
    if text.trim().is_empty() {
        return Vec::new();
    }
    let Some(tree) = tree::parse_or(text, no_alteration("nothing"), findings) else { return Vec::new() };
    match &tree.value {
        Value::Map(entries) if entries.iter().any(|(key, _)| key.value == "alter") => changes(&tree, findings),
        _ => alterations(&tree, findings),
    }
}
