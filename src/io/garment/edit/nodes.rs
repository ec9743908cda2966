//! A YAML text as a tree whose nodes know where they begin and end in the text.

use saphyr_parser::{Event, Marker, Parser};

/// A value and the bytes that it takes, comments and line ends left out.
pub(super) struct Node {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) kind: NodeKind,
}

pub(super) enum NodeKind {
    Scalar(String),
    List { items: Vec<Node>, flow: bool },
    Map { entries: Vec<(Node, Node)>, flow: bool },
    Alias,
}

impl Node {
    /// Whether nothing is written: the value of `seams:` alone.
    pub(super) fn is_absent(&self) -> bool {
        self.start == self.end && matches!(&self.kind, NodeKind::Scalar(text) if text.is_empty())
    }

    /// The entry of a mapping with this key.
    pub(super) fn entry(&self, key: &str) -> Option<&(Node, Node)> {
        let NodeKind::Map { entries, .. } = &self.kind else { return None };
        entries.iter().find(|(name, _)| matches!(&name.kind, NodeKind::Scalar(text) if text == key))
    }

    /// The value at a path of keys and numbers of list items.
    pub(super) fn at(&self, path: &[String]) -> Option<&Node> {
        let Some((first, rest)) = path.split_first() else { return Some(self) };
        let inner = match &self.kind {
            NodeKind::List { items, .. } => items.get(first.parse::<usize>().ok()?)?,
            _ => &self.entry(first)?.1,
        };
        inner.at(rest)
    }
}

/// A collection that is still being read: its start, whether it is in brackets, and its values so far, keys among them.
struct OpenNode {
    start: usize,
    flow: bool,
    map: bool,
    values: Vec<Node>,
}

/// Deepest nesting that is read: that of a garment file.
const DEEPEST: usize = 64;

/// Reads the first document of a text. `None` where it is no YAML, or nested too deeply.
pub(super) fn nodes(text: &str) -> Option<Node> {
    let lines = line_starts(text);
    let byte = |marker: Marker| {
        // A value that is not there may stand behind the last line.
        let start = marker.line().checked_sub(1).and_then(|line| lines.get(line)).copied().unwrap_or(text.len());
        let rest = &text[start..];
        start + rest.char_indices().nth(marker.col()).map_or(rest.len(), |(at, _)| at)
    };
    let mut open: Vec<OpenNode> = Vec::new();
    for event in Parser::new_from_str(text) {
        let (event, span) = event.ok()?;
        let start = byte(span.start);
        let done = match event {
            Event::SequenceStart(..) | Event::MappingStart(..) => {
                if open.len() >= DEEPEST {
                    return None;
                }
                let flow = text[start..].starts_with(['{', '[']);
                open.push(OpenNode { start, flow, map: matches!(event, Event::MappingStart(..)), values: Vec::new() });
                continue;
            }
            Event::Scalar(said, ..) => {
                let end = byte(span.end);
                Node {
                    start,
                    end: start + text[start..end.max(start)].trim_end().len(),
                    kind: NodeKind::Scalar(said.into()),
                }
            }
            Event::Alias(_) => Node { start, end: byte(span.end), kind: NodeKind::Alias },
            Event::SequenceEnd | Event::MappingEnd => closed(open.pop()?, byte(span.end)),
            _ => continue,
        };
        match open.last_mut() {
            Some(parent) => parent.values.push(done),
            None => return Some(done),
        }
    }
    None
}

/// A collection that has been read. Brackets end where the text says, blocks with their last value.
fn closed(open: OpenNode, end: usize) -> Node {
    let OpenNode { start, flow, map, values } = open;
    let last = values.iter().map(|value| value.end).max().unwrap_or(start);
    let start = if flow { start } else { values.first().map_or(start, |first| if map { first.start } else { start }) };
    let end = if flow { end } else { last };
    if !map {
        return Node { start, end, kind: NodeKind::List { items: values, flow } };
    }
    let mut entries = Vec::with_capacity(values.len() / 2);
    let mut values = values.into_iter();
    while let (Some(key), Some(value)) = (values.next(), values.next()) {
        entries.push((key, value));
    }
    Node { start, end, kind: NodeKind::Map { entries, flow } }
}

/// Bytes at which the lines of a text begin, as YAML counts lines.
fn line_starts(text: &str) -> Vec<usize> {
    // A byte order mark takes no column.
    let mut starts = vec![if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 }];
    let bytes = text.as_bytes();
    for (at, byte) in bytes.iter().enumerate() {
        let ends = *byte == b'\n' || (*byte == b'\r' && bytes.get(at + 1) != Some(&b'\n'));
        if ends {
            starts.push(at + 1);
        }
    }
    starts
}
