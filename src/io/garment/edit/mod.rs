//! Changes of a garment file's text that leave every other byte as it is, comments among them.
//!
//! Each change is checked: the new text must read as the old one with exactly this change. A place that is written in a
//! way that this module cannot change (behind an alias, say) is refused, never written anew.

mod nodes;
mod splice;

use nodes::{NodeKind, nodes};

use super::tree;
use crate::pattern::{Findings, Located, Spot, Value};

/// A path of keys and numbers of list items: `seams`, `side`, `sew`, `0`.
pub type KeyPath = Vec<String>;

/// A change of a garment file's text.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// The value at a path, as YAML in one line. Missing mappings on the way are made.
    Set(KeyPath, String),
    /// A value, as YAML in one line, at the end of the list at a path.
    Push(KeyPath, String),
    /// Takes away what is at a path, and a collection that would be empty then.
    Remove(KeyPath),
    /// Gives the key at the end of a path another name.
    Rename(KeyPath, String),
}

/// Why a change was not made. The text is as it was.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// The text is no YAML.
    #[error("the file cannot be read as it is; mend it in an editor first")]
    Unreadable,
    /// The place is written in a way that cannot be changed without writing more anew.
    #[error("'{0}' is written in a way that can only be changed in an editor")]
    Place(String),
    /// There is nothing at the path.
    #[error("the file has no '{0}' any more")]
    Missing(String),
    /// A text that a YAML file cannot hold on one line.
    #[error("this text cannot be written into the file: it has a character that is not printed")]
    Text,
}

/// Makes changes one after the other.
///
/// # Errors
/// [`EditError`] of the first that cannot be made.
pub fn edited(text: &str, edits: &[Edit]) -> Result<String, EditError> {
    edits.iter().try_fold(text.to_owned(), |text, edit| one(&text, edit))
}

fn one(text: &str, edit: &Edit) -> Result<String, EditError> {
    let root = nodes(text).ok_or(EditError::Unreadable)?;
    let place = || EditError::Place(edit.path().join("."));
    let splice = match edit {
        Edit::Set(path, value) => splice::set(text, &root, path, value),
        Edit::Push(path, value) => splice::push(text, &root, path, value),
        Edit::Remove(path) => {
            root.at(path).ok_or_else(|| EditError::Missing(path.join(".")))?;
            splice::remove(text, &root, path)
        }
        Edit::Rename(path, name) => {
            let (last, parents) = path.split_last().ok_or_else(place)?;
            let entry = root.at(parents).and_then(|parent| parent.entry(last));
            let (key, _) = entry.ok_or_else(|| EditError::Missing(path.join(".")))?;
            Some((key.start..key.end, scalar(name).ok_or(EditError::Text)?))
        }
    };
    let (range, new) = splice.ok_or_else(place)?;
    let candidate = [&text[..range.start], &new, &text[range.end..]].concat();
    let mut expected = value(text).ok_or(EditError::Unreadable)?;
    let done = edit.apply(&mut expected);
    if done.is_none() || value(&candidate) != Some(expected) {
        return Err(place());
    }
    Ok(candidate)
}

impl Edit {
    fn path(&self) -> &[String] {
        match self {
            Self::Set(path, _) | Self::Push(path, _) | Self::Remove(path) | Self::Rename(path, _) => path,
        }
    }

    /// The same change of what the text says. `None` where it makes no sense.
    fn apply(&self, root: &mut Value) -> Option<()> {
        match self {
            Self::Set(path, new) => *made(root, path)? = value(new)?,
            Self::Push(path, new) => {
                let list = made(root, path)?;
                if is_empty(list) {
                    *list = Value::List(Vec::new());
                }
                let Value::List(items) = list else { return None };
                items.push(Located::new(value(new)?, Spot::default()));
            }
            Self::Remove(path) => {
                let mut path = path.as_slice();
                while let [parents @ .., _] = path
                    && !parents.is_empty()
                    && count(made(root, parents)?) == 1
                {
                    path = parents;
                }
                let (last, parents) = path.split_last()?;
                match made(root, parents)? {
                    Value::Map(entries) => entries.retain(|(key, _)| key.value != *last),
                    Value::List(items) => drop(items.remove(last.parse().ok()?)),
                    Value::Text(_) => return None,
                }
            }
            Self::Rename(path, name) => {
                let (last, parents) = path.split_last()?;
                let Value::Map(entries) = made(root, parents)? else { return None };
                let (key, _) = entries.iter_mut().find(|(key, _)| key.value == *last)?;
                key.value.clone_from(name);
            }
        }
        Some(())
    }
}

fn is_empty(value: &Value) -> bool {
    matches!(value, Value::Text(text) if text.is_empty())
}

fn count(value: &Value) -> usize {
    match value {
        Value::Map(entries) => entries.len(),
        Value::List(items) => items.len(),
        Value::Text(_) => 0,
    }
}

/// The value at a path. Keys that are missing are added to mappings.
fn made<'a>(root: &'a mut Value, path: &[String]) -> Option<&'a mut Value> {
    let Some((first, rest)) = path.split_first() else { return Some(root) };
    if is_empty(root) {
        *root = Value::Map(Vec::new());
    }
    match root {
        Value::List(items) => made(&mut items.get_mut(first.parse::<usize>().ok()?)?.value, rest),
        Value::Map(entries) => {
            let found = entries.iter().position(|(key, _)| key.value == *first);
            let index = found.unwrap_or_else(|| {
                let nowhere = Spot::default();
                let absent = Located::new(Value::Text(String::new()), nowhere);
                entries.push((Located::new(first.clone(), nowhere), absent));
                entries.len() - 1
            });
            made(&mut entries[index].1.value, rest)
        }
        Value::Text(_) => None,
    }
}

/// The value of a text.
fn value(text: &str) -> Option<Value> {
    let mut findings = Findings::new("", text);
    let root = tree::parse(text, &mut findings).filter(|_| findings.errors() == 0);
    root.map(|root| root.value)
}

/// Every scalar of a text that is no key: its path and what it says.
pub fn scalars(text: &str) -> Vec<(KeyPath, String)> {
    let mut out = Vec::new();
    if let Some(root) = value(text) {
        collect(&root, &mut Vec::new(), &mut out);
    }
    out
}

fn collect(value: &Value, path: &mut KeyPath, out: &mut Vec<(KeyPath, String)>) {
    let mut inner = |key: String, value: &Value| {
        path.push(key);
        collect(value, path, out);
        path.pop();
    };
    match value {
        Value::List(items) => items.iter().enumerate().for_each(|(k, item)| inner(k.to_string(), &item.value)),
        Value::Map(entries) => entries.iter().for_each(|(key, value)| inner(key.value.clone(), &value.value)),
        Value::Text(text) => out.push((path.clone(), text.clone())),
    }
}

/// Names of the entries of the mapping at a path, in its order.
pub fn keys(text: &str, path: &[String]) -> Vec<String> {
    let named = |(key, _): &(nodes::Node, nodes::Node)| match &key.kind {
        NodeKind::Scalar(name) => Some(name.clone()),
        _ => None,
    };
    let root = nodes(text);
    match root.as_ref().and_then(|root| root.at(path)).map(|node| &node.kind) {
        Some(NodeKind::Map { entries, .. }) => entries.iter().filter_map(named).collect(),
        _ => Vec::new(),
    }
}

/// Words that mean something else than themselves to some readers of YAML.
const MEANING: [&str; 9] = ["null", "true", "false", "yes", "no", "on", "off", "y", "n"];

/// A text as YAML on one line, in quotes if it needs them. `None` where it has characters that are not printed.
pub fn scalar(text: &str) -> Option<String> {
    if text.chars().any(|c| c.is_control() || matches!(c, '\u{feff}' | '\u{2028}' | '\u{2029}' | '\u{85}')) {
        return None;
    }
    let starts = text.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_' || c == '/');
    let plain = |c: char| c.is_alphanumeric() || "_.@% /+-*".contains(c);
    let is_plain = starts
        && text.chars().all(plain)
        && !text.ends_with(' ')
        && !MEANING.contains(&text.to_ascii_lowercase().as_str());
    Some(if is_plain { text.to_owned() } else { format!("'{}'", text.replace('\'', "''")) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(text: &str) -> KeyPath {
        text.split('/').map(str::to_owned).collect()
    }

    fn set(at: &str, value: &str) -> Edit {
        Edit::Set(path(at), value.to_owned())
    }

    #[track_caller]
    fn becomes(before: &str, edit: Edit, after: &str) {
        let new = one(before, &edit).expect("edited");
        assert_eq!(new, after);
    }

    #[test]
    fn a_value_is_set_where_it_stands_and_its_comment_stays() {
        becomes("a: 1   # one\nb: 2\n", set("a", "3"), "a: 3   # one\nb: 2\n");
        becomes("é: {a: 'x', b: [1, 2]} # ü\n", set("é/b/1", "7"), "é: {a: 'x', b: [1, 7]} # ü\n");
        becomes("a:  # none yet\nb: 2\n", set("a", "3"), "a: 3  # none yet\nb: 2\n");
        becomes("\u{feff}a: 1\r\nb: 2\r\n", set("a", "3"), "\u{feff}a: 3\r\nb: 2\r\n");
    }

    #[test]
    fn a_missing_entry_is_added_below_the_last_one() {
        let text = "p:\n  f:\n    a: 1  # here\n    # after\nq: 2";
        becomes(text, set("p/f/b", "x"), "p:\n  f:\n    a: 1  # here\n    b: x\n    # after\nq: 2");
        becomes(text, set("r", "3"), "p:\n  f:\n    a: 1  # here\n    # after\nq: 2\nr: 3\n");
        becomes("p: {f: {a: 1}}\n", set("p/f/b", "2"), "p: {f: {a: 1, b: 2}}\n");
        becomes("p: {}\n", set("p/b", "2"), "p: {b: 2}\n");
        becomes("p: {a: [1,\n  2]}   # x\n", set("p/b", "2"), "p: {a: [1,\n  2], b: 2}   # x\n");
        becomes("a: 1\n", set("seams/side", "{sew: f.a}"), "a: 1\n\nseams:\n  side: {sew: f.a}\n");
        becomes("seams:   # none\n# x\nb: 1\n", set("seams/s", "{a: 1}"), "seams:   # none\n  s: {a: 1}\n# x\nb: 1\n");
        becomes("{a: 1}\n", set("seams/s", "{a: 1}"), "{a: 1, seams: {s: {a: 1}}}\n");
        becomes("t:\n- a: 1\n  b: 2\n", set("t/0/c", "3"), "t:\n- a: 1\n  b: 2\n  c: 3\n");
    }

    #[test]
    fn a_list_grows_at_its_end() {
        let push = |at: &str, value: &str| Edit::Push(path(at), value.to_owned());
        becomes("f: [a, b]  # x\n", push("f", "c"), "f: [a, b, c]  # x\n");
        becomes("f: []\n", push("f", "c"), "f: [c]\n");
        becomes("f:\n- a\n- b # x\n# y\ng: 1\n", push("f", "c"), "f:\n- a\n- b # x\n- c\n# y\ng: 1\n");
        becomes("g: 1\n", push("f", "'*.c'"), "g: 1\n\nf:\n  - '*.c'\n");
    }

    #[test]
    fn what_is_taken_away_leaves_its_neighbours() {
        let remove = |at: &str| Edit::Remove(path(at));
        becomes("s:\n  # first\n  a: {x: 1} # one\n  b: 2\n", remove("s/a"), "s:\n  # first\n  b: 2\n");
        becomes("f: [a, b, c]\n", remove("f/0"), "f: [b, c]\n");
        becomes("f: [a, b, c]\n", remove("f/2"), "f: [a, b]\n");
        becomes("f:\n  - a\n  - b\ng: 1\n", remove("f/1"), "f:\n  - a\ng: 1\n");
        // The last one goes with its list.
        becomes("f: [a]\ng: 1\n", remove("f/0"), "g: 1\n");
        becomes("s:\n  a:\n    x: 1\ng: 1\n", remove("s/a"), "g: 1\n");
    }

    #[test]
    fn a_key_gets_another_name() {
        let text = "o: {start: 0 0, 'a': L 1 1}\n";
        becomes(text, Edit::Rename(path("o/a"), "waist".into()), "o: {start: 0 0, waist: L 1 1}\n");
        becomes("a: 1\n", Edit::Rename(path("a"), "no".into()), "'no': 1\n");
    }

    #[test]
    fn what_cannot_be_changed_in_place_is_refused() {
        let aliased = "a: &x {b: 1}\nc: *x\n";
        assert_eq!(one(aliased, &set("a/b", "2")), Err(EditError::Place("a.b".into())));
        assert_eq!(one(aliased, &set("c/b", "2")), Err(EditError::Place("c.b".into())));
        assert_eq!(one("a: [", &set("a", "2")), Err(EditError::Unreadable));
        assert!(matches!(one("a: 1\n", &Edit::Remove(path("b"))), Err(EditError::Missing(_))));
        // Values that would say more than one thing.
        assert!(one("a: 1\n", &set("a", "2\nb: 3")).is_err());
        assert!(one("{a: 1}\n", &set("a", "2, b: 3")).is_err());
    }

    #[test]
    fn texts_are_quoted_when_they_must_be() {
        for text in
            ["*.hem", "it's", "a: b", "#x", "", "no", "- a", "{a}", "front.L.side", "12 mm", "ä b", "a #b", " a"]
        {
            let written = scalar(text).expect("one line");
            assert_eq!(value(&format!("k: {written}")), value(&format!("k: '{}'", text.replace('\'', "''"))), "{text}");
            assert_eq!(value(&format!("[{written}]")), value(&format!("['{}']", text.replace('\'', "''"))), "{text}");
        }
        assert_eq!(scalar("a\nb"), None);
    }
}
