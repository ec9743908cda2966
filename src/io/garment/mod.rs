//! Garment files (YAML) in and out.
//!
//! [`read`] gives the checked [`Garment`] and the [`GarmentFile`], which holds everything the file says with the
//! place where it says it; [`write()`] turns a [`GarmentFile`] back into YAML that reads as the same.

mod append;
mod change;
mod decode;
mod decode_alter;
mod decode_piece;
mod decode_seam;
mod decode_test;
mod decode_wants;
mod edit;
mod encode;
mod fields;
mod layout;
mod ranges;
mod reform;
mod refuse;
mod source;
mod tree;
mod variant;

use std::path::Path;

use crate::alter::{altered, carry_out};
use crate::pattern::{
    self, AlterationFile, Diagnostic, Findings, Garment, GarmentFile, Located, Problem, Severity, Spot, Unit, WantsFile,
};

pub use append::{Appended, appended};
pub use change::{Changed, EdgeChange, change, change_text};
pub use edit::{Edit, EditError, KeyPath, edited, keys, scalar, scalars};
pub use encode::{alteration_line, seam_line, write, write_with_offers};
pub use layout::EncodeError;
pub use ranges::{Drawn, Ranges};
pub use reform::{Reformed, reform};
pub use refuse::Refused;
pub(crate) use refuse::refuse;
use refuse::{accept, text_of};
pub use source::LARGEST_FILE;
pub use variant::{Variant, alterations_in, alterations_of};

/// JSON Schema (2020-12) of the format, for editors that complete and check as one types.
pub const SCHEMA: &str = include_str!("schema.json");

/// A garment that passed its checks.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The pieces and seams.
    pub garment: Garment,
    /// The statements of the file.
    pub file: GarmentFile,
    /// Warnings: statements that its author may not have meant as they were read.
    pub warnings: Vec<Diagnostic>,
    source: FileText,
}

/// A file's name and text, to show where in it a mistake is that is found later.
#[derive(Clone, Debug)]
struct FileText {
    shown: String,
    text: String,
}

impl Loaded {
    /// For what is found in the file later on.
    pub fn findings(&self) -> Findings {
        Findings::new(&self.source.shown, &self.source.text)
    }

    /// The garment with further alterations carried out.
    ///
    /// # Errors
    /// [`Refused`]: an alteration that cannot be done, or whose pattern is no garment any more.
    pub fn altered(&self, list: &[AlterationFile]) -> Result<Self, Refused> {
        let mut findings = self.findings();
        let mut file = self.file.clone();
        let list: Vec<_> = list.iter().map(|a| Located::new(a.clone(), Spot::default())).collect();
        carry_out(&mut file, &list, &mut findings);
        let garment = pattern::expand(&self.garment.name, &file, &mut findings);
        Examined { file: Some(file), findings, beside: Vec::new(), garment, source: self.source.clone() }.finish()
    }

    /// The text of the file.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// The garment refused after all, for something that stands at this place of its file.
    pub fn refusal(&self, at: Spot, problem: Problem) -> Refused {
        let mut findings = self.findings();
        findings.error(at, problem);
        Refused { diagnostics: findings.into_sorted() }
    }
}

/// A garment file read as far as it goes, with what was found on the way, so that others can look further before it is
/// decided whether it can be used.
#[derive(Debug)]
pub struct Examined {
    /// The statements of the file, if that much can be read.
    pub file: Option<GarmentFile>,
    /// The findings so far.
    pub findings: Findings,
    /// Mistakes of alterations that are no part of the file.
    beside: Vec<Diagnostic>,
    garment: Option<Garment>,
    source: FileText,
}

impl Examined {
    /// The garment, if no error was found.
    ///
    /// # Errors
    /// [`Refused`] with all that was found.
    pub fn finish(self) -> Result<Loaded, Refused> {
        let refused = self.findings.errors() > 0 || !self.beside.is_empty();
        let mut diagnostics = self.beside;
        diagnostics.extend(self.findings.into_sorted());
        match (self.file, self.garment) {
            (Some(file), Some(garment)) if !refused => {
                let warnings = diagnostics.into_iter().filter(|d| d.severity == Severity::Warning).collect();
                Ok(Loaded { garment, file, warnings, source: self.source })
            }
            _ => Err(Refused { diagnostics }),
        }
    }
}

/// Reads and checks a garment file.
///
/// # Errors
/// [`Refused`] with every mistake of the file, not only the first.
pub fn read(path: &Path) -> Result<Loaded, Refused> {
    examine(path).finish()
}

/// Reads and checks a variant of a garment file.
///
/// # Errors
/// As [`read`], where there is no such size, and where an alteration cannot be carried out.
pub fn read_variant(path: &Path, variant: Variant) -> Result<Loaded, Refused> {
    examine_variant(path, variant).finish()
}

/// Reads and checks a garment from text; `name` is its short name, `shown` the file's name in messages.
///
/// # Errors
/// As [`read`].
pub fn read_text(name: &str, shown: &str, text: &str) -> Result<Loaded, Refused> {
    examine_text(name, shown, text).finish()
}

/// Reads and checks a garment file, and leaves it open whether it can be used.
pub fn examine(path: &Path) -> Examined {
    examine_variant(path, Variant::default())
}

/// As [`examine`], of a variant of the garment. The name ends with the size.
pub fn examine_variant(path: &Path, variant: Variant) -> Examined {
    let shown = path.display().to_string();
    let name = path.file_stem().map_or_else(|| shown.clone(), |s| s.to_string_lossy().into_owned());
    match source::text(path) {
        Ok(text) => examine_text_variant(&name, &shown, &text, variant),
        Err(problem) => {
            let (_, shown) = of_size(&name, &shown, variant.size);
            let mut findings = Findings::new(&shown, "");
            findings.error(Spot::default(), problem);
            let source = FileText { shown, text: String::new() };
            Examined { file: None, findings, beside: Vec::new(), garment: None, source }
        }
    }
}

/// As [`examine`], from text; `name` is the garment's short name, `shown` the file's name in messages.
pub fn examine_text(name: &str, shown: &str, text: &str) -> Examined {
    examined(name, shown, text, Variant::default())
}

/// As [`examine_text`], of a variant of the garment. The name ends with the size.
pub fn examine_text_variant(name: &str, shown: &str, text: &str, variant: Variant) -> Examined {
    let (name, shown) = of_size(name, shown, variant.size);
    examined(&name, &shown, text, variant)
}

/// The names of a garment and its file with that of its size.
fn of_size(name: &str, shown: &str, size: Option<&str>) -> (String, String) {
    match size {
        Some(size) => (format!("{name}-{size}"), format!("{shown} (size {size})")),
        None => (name.to_owned(), shown.to_owned()),
    }
}

fn examined(name: &str, shown: &str, text: &str, variant: Variant) -> Examined {
    let mut findings = Findings::new(shown, text);
    let file = tree::parse(text, &mut findings).and_then(|tree| decode::garment(&tree, &mut findings));
    let file = file.map(|file| altered(&file, variant.size, &mut findings));
    let (file, beside) = match file.map(|file| variant.carried_out(file)) {
        Some(Ok(file)) => (Some(file), Vec::new()),
        Some(Err(refused)) => (None, refused.diagnostics),
        None => (None, Vec::new()),
    };
    let garment = file.as_ref().and_then(|file| pattern::expand(name, file, &mut findings));
    let source = FileText { shown: shown.to_owned(), text: text.to_owned() };
    Examined { file, findings, beside, garment, source }
}

/// Reads a file of wants. Bare lengths in it count in `unit`, the garment's.
///
/// # Errors
/// [`Refused`] with every mistake of the file.
pub fn read_wants(path: &Path, unit: Unit) -> Result<WantsFile, Refused> {
    wants_of(&path.display().to_string(), &text_of(path)?, unit)
}

/// As [`read_wants`], from text; `shown` is the file's name in messages.
///
/// # Errors
/// As [`read_wants`].
pub fn wants_of(shown: &str, text: &str, unit: Unit) -> Result<WantsFile, Refused> {
    let mut findings = Findings::new(shown, text);
    let read = tree::parse_or(text, Problem::NoWants, &mut findings)
        .map(|tree| decode_wants::wants(&tree, unit, &mut findings));
    let read = read.unwrap_or_default();
    if findings.errors() == 0 && read.wants.is_empty() {
        findings.error(Spot::default(), Problem::NoWants);
    }
    refuse(findings).map(|()| read)
}

/// Reads what a garment file says without checking that it makes a garment.
///
/// # Errors
/// [`Refused`] when the text is no garment file.
pub fn read_file_only(shown: &str, text: &str) -> Result<GarmentFile, Refused> {
    let mut findings = Findings::new(shown, text);
    let file = tree::parse(text, &mut findings).and_then(|tree| decode::garment(&tree, &mut findings));
    accept(file, findings)
}
