//! A file of a result, in memory.

use super::error::PipelineError;

/// A file's name and contents.
pub type ResultFile = (&'static str, Vec<u8>);

/// A report as JSON text with a line feed at its end.
///
/// # Errors
/// When a value has no JSON.
pub fn json_text(report: &impl serde::Serialize) -> Result<String, PipelineError> {
    let mut text = serde_json::to_string_pretty(report)?;
    text.push('\n');
    Ok(text)
}
