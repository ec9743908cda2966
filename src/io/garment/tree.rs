//! YAML text as a tree that knows the place of every value; the only user of saphyr.

use std::collections::HashMap;

use saphyr_parser::{Event, Marker, Parser, ScanError, Span};

use crate::pattern::{Findings, Located, Problem, Spot, Value};

/// Deeper nesting than any garment needs is refused, so that nothing downstream can run out of stack.
const DEEPEST: usize = 64;
/// Values after aliases are unfolded.
const MOST_VALUES: usize = 400_000;

/// Characters of a key. YAML takes 1024 on one line, escapes as they are written:
/// a longer one could not be written again.
const LONGEST_KEY: usize = 150;

/// A list or mapping that is still being read.
struct Open {
    at: Spot,
    anchor: usize,
    /// Values in it so far, itself included.
    size: usize,
    kind: Collection,
}

enum Collection {
    List(Vec<Located<Value>>),
    Map {
        entries: Vec<(Located<String>, Located<Value>)>,
        /// The one whose value comes next.
        key: Option<Located<String>>,
        /// Where each key stands.
        lines: HashMap<String, usize>,
    },
}

struct Builder<'f> {
    open: Vec<Open>,
    /// Finished anchored values and their sizes.
    anchors: HashMap<usize, (Located<Value>, usize)>,
    values: usize,
    root: Option<Located<Value>>,
    findings: &'f mut Findings,
}

/// Reads one YAML document, which is to be a garment file. `None` after an error that leaves no tree; duplicate keys
/// are reported and the first kept.
pub(super) fn parse(text: &str, findings: &mut Findings) -> Option<Located<Value>> {
    parse_or(text, Problem::Empty, findings)
}

/// As [`parse`], of another file. `empty` is its fault when it says nothing.
pub(super) fn parse_or(text: &str, empty: Problem, findings: &mut Findings) -> Option<Located<Value>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut builder = Builder { open: Vec::new(), anchors: HashMap::new(), values: 0, root: None, findings };
    for event in Parser::new_from_str(text) {
        let outcome = match event {
            Ok((event, span)) => builder.event(event, span),
            Err(e) => Err((fault(text, &e), Problem::Syntax(e.info().to_owned()))),
        };
        if let Err((at, problem)) = outcome {
            builder.findings.error(at, problem);
            return None;
        }
    }
    let says_nothing = |v: &Located<Value>| matches!(&v.value, Value::Text(t) if t.is_empty());
    let root = builder.root.filter(|r| !says_nothing(r));
    if root.is_none() {
        findings.error(Spot::default(), empty);
    }
    root
}

/// Where the error is: a tab ends the value before it, which is where the parser says it stands.
fn fault(text: &str, error: &ScanError) -> Spot {
    let said = spot(*error.marker(), 1);
    let tab = |(i, line): (usize, &str)| {
        let before = line.chars().position(|c| c == '\t')?;
        Some(Spot { line: i + 1, column: before + 1, width: 1 })
    };
    let told = error.info().contains("tab");
    let mut rest = text.lines().enumerate().skip(said.line.saturating_sub(1));
    told.then(|| rest.find_map(tab)).flatten().unwrap_or(said)
}

fn spot(marker: Marker, width: usize) -> Spot {
    Spot { line: marker.line(), column: marker.col() + 1, width }
}

fn spot_of(span: Span) -> Spot {
    let one_line = span.start.line() == span.end.line();
    spot(span.start, if one_line { span.end.col().saturating_sub(span.start.col()) } else { 1 })
}

type Outcome = Result<(), (Spot, Problem)>;

impl Builder<'_> {
    fn event(&mut self, event: Event, span: Span) -> Outcome {
        let at = spot_of(span);
        match event {
            Event::DocumentStart(_) if self.root.is_some() => Err((at, Problem::SecondDocument)),
            Event::Scalar(text, style, anchor, _) => {
                let null = style == saphyr_parser::ScalarStyle::Plain && matches!(&*text, "~" | "null");
                let text = if null { String::new() } else { text.into_owned() };
                self.add(Located::new(Value::Text(text), at), anchor, 1)
            }
            Event::SequenceStart(anchor, _) => self.start(at, anchor, Collection::List(Vec::new())),
            Event::MappingStart(anchor, _) => {
                self.start(at, anchor, Collection::Map { entries: Vec::new(), key: None, lines: HashMap::new() })
            }
            Event::SequenceEnd | Event::MappingEnd => self.end(),
            Event::Alias(anchor) => {
                let (value, size) = self.anchors.get(&anchor).cloned().ok_or((at, Problem::EndlessAlias))?;
                self.add(Located::new(value.value, at), 0, size)
            }
            Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentStart(_) | Event::DocumentEnd => {
                Ok(())
            }
        }
    }

    fn start(&mut self, at: Spot, anchor: usize, kind: Collection) -> Outcome {
        if self.open.len() >= DEEPEST {
            return Err((at, Problem::TooDeep(DEEPEST)));
        }
        if self.expects_key() {
            return Err((at, Problem::KeyNotText));
        }
        self.open.push(Open { at, anchor, size: 1, kind });
        Ok(())
    }

    fn expects_key(&self) -> bool {
        matches!(self.open.last(), Some(Open { kind: Collection::Map { key: None, .. }, .. }))
    }

    fn end(&mut self) -> Outcome {
        let Some(done) = self.open.pop() else { return Ok(()) };
        let value = match done.kind {
            Collection::List(items) => Value::List(items),
            Collection::Map { entries, .. } => Value::Map(entries),
        };
        self.add(Located::new(value, done.at), done.anchor, done.size)
    }

    fn add(&mut self, value: Located<Value>, anchor: usize, size: usize) -> Outcome {
        let at = value.at;
        // Counted before anything is copied: a few lines of nested aliases can stand for billions of values.
        self.values += if matches!(value.value, Value::Text(_)) { 1 } else { size };
        if self.values > MOST_VALUES {
            return Err((at, Problem::TooManyValues(MOST_VALUES)));
        }
        if anchor != 0 {
            self.anchors.insert(anchor, (value.clone(), size));
        }
        let Some(parent) = self.open.last_mut() else {
            self.root = Some(value);
            return Ok(());
        };
        parent.size += size;
        match &mut parent.kind {
            Collection::List(items) => items.push(value),
            Collection::Map { entries, key, lines } => match key.take() {
                None => {
                    let Value::Text(text) = value.value else { return Err((at, Problem::KeyNotText)) };
                    if text.chars().count() > LONGEST_KEY {
                        return Err((at, Problem::KeyTooLong(LONGEST_KEY)));
                    }
                    *key = Some(Located::new(text, at));
                }
                Some(name) => match lines.get(&name.value) {
                    Some(&first) => {
                        let problem = Problem::DuplicateKey { key: name.value, line: name.at.line, first };
                        self.findings.error(name.at, problem);
                    }
                    None => {
                        lines.insert(name.value.clone(), name.at.line);
                        entries.push((name, value));
                    }
                },
            },
        }
        Ok(())
    }
}
