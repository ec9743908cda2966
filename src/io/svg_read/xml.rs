//! XML as programs write it, which is not always XML.

use roxmltree::{Document, ParsingOptions};

use super::SvgError;

/// More elements than this are a picture, not a pattern.
const MOST_NODES: u32 = 500_000;
/// Entities that every reader knows.
const KNOWN: [&str; 5] = ["amp", "lt", "gt", "quot", "apos"];
/// No entity's name is longer.
const LONGEST_ENTITY: usize = 40;

/// The text as a document, with what had to be forgiven; `mended` holds a text that had to be written anew.
pub(super) fn parsed<'a>(
    text: &'a str,
    mended: &'a mut Option<String>,
) -> Result<(Document<'a>, Vec<String>), SvgError> {
    let options = || ParsingOptions { nodes_limit: MOST_NODES, allow_dtd: true, ..ParsingOptions::default() };
    let refused = match Document::parse_with_options(text, options()) {
        Ok(document) => return Ok((document, Vec::new())),
        Err(refused) => SvgError::Xml(refused.to_string()),
    };
    let Some((whole, line)) = escaped(text) else { return Err(refused) };
    let whole: &'a str = mended.insert(whole);
    match Document::parse_with_options(whole, options()) {
        Ok(document) => {
            let note = format!("it is not quite XML: a bare '&' in line {line} is read as it stands");
            Ok((document, vec![note]))
        }
        Err(_) => Err(refused),
    }
}

/// The text with every `&` that begins no entity written as one, and the line of the first.
fn escaped(text: &str) -> Option<(String, usize)> {
    let mut out = String::with_capacity(text.len());
    let mut first = None;
    let mut rest = text;
    while let Some(at) = rest.find('&') {
        let (before, after) = (&rest[..at], &rest[at + 1..]);
        out.push_str(before);
        out.push('&');
        if !is_entity(after, text) {
            out.push_str("amp;");
            first.get_or_insert_with(|| 1 + text[..text.len() - rest.len() + at].matches('\n').count());
        }
        rest = after;
    }
    out.push_str(rest);
    first.map(|line| (out, line))
}

/// Whether what follows an `&` makes it an entity that is known.
fn is_entity(after: &str, text: &str) -> bool {
    let Some(end) = after.bytes().take(LONGEST_ENTITY).position(|b| b == b';') else { return false };
    let name = &after[..end];
    match name.strip_prefix('#') {
        Some(number) => {
            let (digits, radix) = number.strip_prefix('x').map_or((number, 10), |hex| (hex, 16));
            u32::from_str_radix(digits, radix).is_ok_and(|code| char::from_u32(code).is_some())
        }
        None => KNOWN.contains(&name) || !name.is_empty() && text.contains(&format!("<!ENTITY {name} ")),
    }
}
