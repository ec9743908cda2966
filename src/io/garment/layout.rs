//! YAML as people write it: short lists and mappings on one line, the outline of the file block by block.

use serde_yaml::Value as Yaml;

use crate::input::quoted;

/// A garment file that YAML cannot hold, and why.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the garment cannot be written as YAML: {0}")]
pub struct EncodeError(String);

impl EncodeError {
    fn new(reason: &dyn std::fmt::Display) -> Self {
        Self(reason.to_string())
    }
}

/// Longest line that a list or mapping is put on.
const WIDTH: usize = 110;
/// Levels of the file that are blocks however short: its keys, and pieces with theirs.
const BLOCKS: [(&str, usize); 2] = [("pieces", 2), ("seams", 1)];

/// Key of the list that remarks stand before.
const FREE: &str = "free";

/// The document, with lines of remarks before what it lists as free.
///
/// # Errors
/// A scalar that YAML cannot hold.
pub(super) fn document(root: &Yaml, remarks: &[String]) -> Result<String, EncodeError> {
    let mut out = String::new();
    let Yaml::Mapping(map) = root else { return scalar(root) };
    for (key, value) in map {
        let name = scalar(key)?;
        let deep = BLOCKS.iter().find(|(block, _)| *block == name).map_or(0, |b| b.1);
        // A blank line before each of the long parts.
        if deep > 0 || name == FREE {
            out.push('\n');
        }
        if name == FREE && !remarks.is_empty() {
            remarks.iter().for_each(|remark| out.push_str(&format!("# {remark}\n")));
            out.push('\n');
        }
        entry(&mut out, &name, value, 0, deep)?;
    }
    Ok(out)
}

/// `key: value` at a depth; a mapping goes on in a block where it must (for `blocks` levels) or does not fit.
fn entry(out: &mut String, key: &str, value: &Yaml, depth: usize, blocks: usize) -> Result<(), EncodeError> {
    let indent = "  ".repeat(depth);
    let short = flow(value)?;
    let fits = indent.len() + key.len() + 2 + short.chars().count() <= WIDTH;
    match value {
        Yaml::Mapping(map) if !map.is_empty() && (blocks > 0 || key == "outline" || !fits) => {
            out.push_str(&format!("{indent}{key}:\n"));
            for (key, value) in map {
                entry(out, &scalar(key)?, value, depth + 1, blocks.saturating_sub(1))?;
            }
        }
        Yaml::Sequence(items) if !items.is_empty() && (!fits || (depth == 0 && items.iter().any(Yaml::is_mapping))) => {
            out.push_str(&format!("{indent}{key}:\n"));
            for item in items {
                out.push_str(&format!("{indent}  - {}\n", flow(item)?));
            }
        }
        // Alone after its key a text needs no quotes for commas and brackets within it.
        Yaml::String(_) => out.push_str(&format!("{indent}{key}: {}\n", scalar(value)?)),
        _ => out.push_str(&format!("{indent}{key}: {short}\n")),
    }
    Ok(())
}

/// A value on one line.
pub(super) fn flow(value: &Yaml) -> Result<String, EncodeError> {
    Ok(match value {
        Yaml::Sequence(items) => {
            format!("[{}]", items.iter().map(flow).collect::<Result<Vec<String>, _>>()?.join(", "))
        }
        Yaml::Mapping(map) => {
            let entry = |(k, v): (&Yaml, &Yaml)| Ok(format!("{}: {}", flow(k)?, flow(v)?));
            format!("{{{}}}", map.iter().map(entry).collect::<Result<Vec<String>, EncodeError>>()?.join(", "))
        }
        // A dash before the bracket that ends the list would be read as a list of its own.
        Yaml::String(text) if text.contains([',', '[', ']', '{', '}', '\n']) || text.ends_with(" -") => quoted(text),
        _ => scalar(value)?,
    })
}

/// A key or value that is no list or mapping, quoted where YAML needs it.
fn scalar(value: &Yaml) -> Result<String, EncodeError> {
    if let Yaml::String(text) = value
        && text.contains(|c: char| c.is_control())
    {
        return Ok(quoted(text));
    }
    let text = serde_yaml::to_string(value).map_err(|e| EncodeError::new(&e))?;
    Ok(text.trim_end_matches('\n').to_owned())
}
