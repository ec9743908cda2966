//! Garment files, and files beside them, that cannot be used.

use std::fmt;
use std::path::Path;

use super::source;
use crate::pattern::{Diagnostic, Findings, Problem, Spot};

/// A garment file that cannot be used: everything found in it, errors and warnings, in the order of the file. Of very
/// many it holds the first of either, and last how many more there are.
#[derive(Clone, Debug, PartialEq)]
pub struct Refused {
    /// At least one of them is an error.
    pub diagnostics: Vec<Diagnostic>,
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.diagnostics.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{diagnostic}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Refused {}

impl Refused {
    /// A file refused as a whole; `shown` is its name in messages.
    pub(super) fn whole(shown: &str, problem: Problem) -> Self {
        let mut findings = Findings::new(shown, "");
        findings.error(Spot::default(), problem);
        Self { diagnostics: findings.into_sorted() }
    }
}

/// Refuses what has errors.
///
/// # Errors
/// [`Refused`] with all findings, if one of them is an error.
pub(crate) fn refuse(findings: Findings) -> Result<(), Refused> {
    if findings.errors() == 0 { Ok(()) } else { Err(Refused { diagnostics: findings.into_sorted() }) }
}

/// A value that was read without an error.
///
/// # Errors
/// [`Refused`] with all findings, if one of them is an error or nothing was read.
pub(super) fn accept<T>(read: Option<T>, findings: Findings) -> Result<T, Refused> {
    match read {
        Some(read) if findings.errors() == 0 => Ok(read),
        _ => Err(Refused { diagnostics: findings.into_sorted() }),
    }
}

/// The text of the file at `path`.
///
/// # Errors
/// As [`source::text`], with the file's name.
pub(super) fn text_of(path: &Path) -> Result<String, Refused> {
    source::text(path).map_err(|problem| Refused::whole(&path.display().to_string(), problem))
}
