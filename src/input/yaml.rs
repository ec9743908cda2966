//! YAML texts of people and programs.

use serde::de::DeserializeOwned;

use super::shown;

/// Most brackets that are open at one place of a text: the parser's time grows with the square of how deep values are
/// nested, and nobody nests them deep.
const DEEPEST: usize = 100;
/// Characters of a message that are shown: it may quote the whole text.
const MESSAGE: usize = 300;

/// Parses a text. A text that is deeply nested, or seems to be by brackets in its words, is refused before it is
/// parsed.
///
/// # Errors
/// The parser's message, with line and column.
pub fn yaml<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    if depth(text) > DEEPEST {
        return Err(format!("values are nested deeper than {DEEPEST} brackets"));
    }
    serde_yaml::from_str(text).map_err(|e| shown(&e.to_string(), MESSAGE))
}

/// Every text of a YAML text, but for the keys, in the order of the file.
///
/// # Errors
/// As [`yaml`].
pub fn texts(text: &str) -> Result<Vec<String>, String> {
    let mut found = Vec::new();
    collect(yaml(text)?, &mut found);
    Ok(found)
}

fn collect(value: serde_yaml::Value, found: &mut Vec<String>) {
    use serde_yaml::Value;
    match value {
        Value::String(text) => found.push(text),
        Value::Sequence(items) => items.into_iter().for_each(|item| collect(item, found)),
        Value::Mapping(entries) => entries.into_iter().for_each(|(_, value)| collect(value, found)),
        Value::Tagged(tagged) => collect(tagged.value, found),
        Value::Null | Value::Bool(_) | Value::Number(_) => {}
    }
}

/// A YAML string in double quotes, with JSON's escapes, which are YAML's too.
pub fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// At least as many brackets as are open at one place of a text.
fn depth(text: &str) -> usize {
    let mut readings = Brackets { values: Some(0), ..Brackets::default() };
    let mut before = '\n';
    let mut most = 0;
    for c in text.chars() {
        readings.go_on(before, c);
        most = most.max(readings.values.unwrap_or(0));
        before = c;
    }
    most
}

/// Most brackets that may be open at a place of a text, if it lies among values, in a comment, or in a quoted text.
/// Brackets in the last two mean nothing, closing ones least of all: they would hide how deep the values are. Whether a
/// mark begins a comment or a quoted text cannot always be told without parsing, and then both is followed.
#[derive(Default)]
struct Brackets {
    values: Option<usize>,
    comment: Option<usize>,
    /// In single and in double quotation marks.
    quoted: [Option<usize>; 2],
}

impl Brackets {
    fn go_on(&mut self, before: char, c: char) {
        // Behind a letter or a digit an apostrophe or a hash is one more letter of a word.
        let begins = !before.is_alphanumeric();
        match c {
            '[' | '{' => self.values = self.values.map(|open| open + 1),
            ']' | '}' => self.values = self.values.map(|open| open.saturating_sub(1)),
            '#' if matches!(before, ' ' | '\t' | '\n' | '\r') => self.comment = self.comment.max(self.values.take()),
            '#' if begins => self.comment = self.comment.max(self.values),
            // All that ends a line in YAML 1.1.
            '\n' | '\r' | '\u{85}' | '\u{2028}' | '\u{2029}' => self.values = self.values.max(self.comment.take()),
            '\'' | '"' => self.quote(usize::from(c == '"'), begins, before == '\\'),
            _ => {}
        }
    }

    fn quote(&mut self, mark: usize, begins: bool, escaped: bool) {
        let ended = self.quoted[mark];
        let begun = self.values.filter(|_| begins);
        self.quoted[mark] = if escaped { ended.max(begun) } else { begun };
        self.values = self.values.max(ended);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_found_at_any_depth() {
        let found = texts("1: [a.csv, {b: 'c d.yaml', e: 3}]\nf: ~\n");
        assert_eq!(found, Ok(vec!["a.csv".to_owned(), "c d.yaml".to_owned()]));
    }

    #[test]
    fn values_nested_without_end_are_refused_at_once() {
        let deep = "[".repeat(200_000);
        assert!(yaml::<Vec<u8>>(&deep).expect_err("deep").contains("nested deeper"));
        assert_eq!(yaml::<Vec<u8>>("[1, 2]"), Ok(vec![1, 2]));
        assert_eq!(yaml::<String>("it's [\n"), Ok("it's [".to_owned()));
        assert!(yaml::<Vec<u8>>("[1,").expect_err("open").chars().count() <= MESSAGE);
    }

    #[test]
    fn brackets_that_close_nothing_hide_no_depth() {
        let deep = "[".repeat(200);
        let closed = "]".repeat(1000);
        for text in [
            format!("{closed}\n{deep}"),
            format!("# {closed}\n{deep}"),
            format!("#{closed}\r{deep}"),
            format!("text: |\n  it's {closed}\n  'so {closed} # so\nvalues: {deep}"),
            "[#]\n".repeat(200),
            "['it''s ]', ".repeat(200),
            r#"["\" ]", "#.repeat(200),
            r#"{"a]": "#.repeat(200),
            "[a, \"b\n]\n\", ".repeat(200),
        ] {
            assert!(depth(&text) >= 200, "{text}");
        }
    }

    #[test]
    fn comments_may_hold_brackets_and_quoted_texts_closed_ones() {
        let deep = "[".repeat(200);
        assert_eq!(yaml::<Vec<u8>>(&format!("# don't {deep}\n[1, 2] # {deep}\n")), Ok(vec![1, 2]));
        let rows = "- ['[a]', \"it's\", '%']\n".repeat(1000);
        assert_eq!(yaml::<Vec<[String; 3]>>(&rows).map(|read| read.len()), Ok(1000));
    }
}
