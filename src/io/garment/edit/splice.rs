//! Changes of a YAML text at one place: which bytes go, and what is written there.

use std::ops::Range;

use super::nodes::{Node, NodeKind};

/// Bytes of a text, and what takes their place.
pub(super) type Splice = (Range<usize>, String);

/// Blanks before the entries of a mapping that is begun.
const INDENT: &str = "  ";

/// A value set at a path, which is made as far as it is not there. `None` where that cannot be done in place.
pub(super) fn set(text: &str, root: &Node, path: &[String], value: &str) -> Option<Splice> {
    let (last, parents) = path.split_last()?;
    if let Some(node) = root.at(path) {
        if !node.is_absent() {
            return matches!(
                node.kind,
                NodeKind::Scalar(_) | NodeKind::List { flow: true, .. } | NodeKind::Map { flow: true, .. }
            )
            .then(|| (node.start..node.end, value.to_owned()));
        }
        // After the colon of its key.
        let key = &root.at(parents)?.entry(last)?.0;
        let colon = key.end + text[key.end..].find(':')? + 1;
        return Some((colon..colon, format!(" {value}")));
    }
    let parent = root.at(parents).filter(|parent| !parent.is_absent());
    let Some(parent) = parent else {
        return begun(text, root, parents, &format!("{last}: {value}"), &format!("{{{last}: {value}}}"));
    };
    let NodeKind::Map { entries, flow } = &parent.kind else { return None };
    let entry = format!("{}: {value}", super::scalar(last)?);
    if *flow {
        return Some(in_brackets(parent, entries.last().map(|(key, value)| key.end.max(value.end)), &entry));
    }
    let (first, end) = (&entries.first()?.0, entries.last().map(|(key, value)| key.end.max(value.end))?);
    Some(line_after(text, end, &format!("{}{entry}", margin(text, first.start)?)))
}

/// A value at the end of the list at a path, which is made if it is not there.
pub(super) fn push(text: &str, root: &Node, path: &[String], value: &str) -> Option<Splice> {
    let Some(list) = root.at(path).filter(|list| !list.is_absent()) else {
        return begun(text, root, path, &format!("- {value}"), &format!("[{value}]"));
    };
    let NodeKind::List { items, flow } = &list.kind else { return None };
    let last = items.last().map(|item| item.end);
    if *flow {
        return Some(in_brackets(list, last, value));
    }
    let dash = text[..items.first()?.start].rfind('-')?;
    Some(line_after(text, last?, &format!("{}- {value}", margin(text, dash)?)))
}

/// The collection at a path begun with a first entry: as a block below its key at the top of the file, in brackets
/// elsewhere.
fn begun(text: &str, root: &Node, path: &[String], block: &str, flow: &str) -> Option<Splice> {
    let is_block = matches!(root.kind, NodeKind::Map { flow: false, .. });
    let [key] = path else { return set(text, root, path, flow) };
    if !is_block {
        return set(text, root, path, flow);
    }
    if let Some((key, _)) = root.entry(key) {
        return Some(line_after(text, key.end, &format!("{INDENT}{block}")));
    }
    let NodeKind::Map { entries, .. } = &root.kind else { return None };
    let end = entries.last().map(|(key, value)| key.end.max(value.end))?;
    let ending = newline(text);
    Some(line_after(text, end, &format!("{ending}{key}:{ending}{INDENT}{block}")))
}

/// Removes the value at a path with its key, and its collection if that would be empty.
pub(super) fn remove(text: &str, root: &Node, path: &[String]) -> Option<Splice> {
    let (last, parents) = path.split_last()?;
    let parent = root.at(parents)?;
    let (ranges, flow, dashed): (Vec<Range<usize>>, bool, bool) = match &parent.kind {
        NodeKind::Map { entries, flow } => {
            (entries.iter().map(|(key, value)| key.start..key.end.max(value.end)).collect(), *flow, false)
        }
        NodeKind::List { items, flow } => (items.iter().map(|item| item.start..item.end).collect(), *flow, true),
        _ => return None,
    };
    if ranges.len() == 1 && !parents.is_empty() {
        return remove(text, root, parents);
    }
    let own = match &parent.kind {
        NodeKind::Map { entries, .. } => {
            entries.iter().position(|(key, _)| matches!(&key.kind, NodeKind::Scalar(said) if said == last))?
        }
        _ => last.parse().ok()?,
    };
    let range = ranges.get(own)?.clone();
    if flow {
        let goes = match own.checked_sub(1) {
            Some(before) => ranges[before].end..range.end,
            None => range.start..ranges.get(1)?.start,
        };
        return Some((goes, String::new()));
    }
    let begin = if dashed { text[..range.start].rfind('-')? } else { range.start };
    let line = text[..begin].rfind('\n').map_or(0, |at| at + 1);
    text[line..begin].trim().is_empty().then(|| (line..line_end(text, range.end), String::new()))
}

/// A further value in brackets, after the last one.
fn in_brackets(collection: &Node, last: Option<usize>, value: &str) -> Splice {
    match last {
        Some(end) => (end..end, format!(", {value}")),
        None => (collection.start + 1..collection.end - 1, value.to_owned()),
    }
}

/// A line after the one that holds a byte.
fn line_after(text: &str, byte: usize, line: &str) -> Splice {
    let at = line_end(text, byte);
    let ending = newline(text);
    let missing = if text[..at].ends_with('\n') { "" } else { ending };
    (at..at, format!("{missing}{line}{ending}"))
}

/// End of the line of a byte, after its line end.
fn line_end(text: &str, byte: usize) -> usize {
    text[byte..].find('\n').map_or(text.len(), |at| byte + at + 1)
}

/// Blanks in front of what begins at a byte, to write the next one below it. `None` where a tab is in front.
fn margin(text: &str, byte: usize) -> Option<String> {
    let line = text[..byte].rfind('\n').map_or(0, |at| at + 1);
    let before = text[line..byte].trim_start_matches('\u{feff}');
    (!before.contains('\t')).then(|| " ".repeat(before.chars().count()))
}

/// The line end of a text.
fn newline(text: &str) -> &'static str {
    if text.contains("\r\n") { "\r\n" } else { "\n" }
}
