//! YAML texts of people and programs.

use serde::de::DeserializeOwned;

use super::shown;

/// Most brackets that are open at one place of a text: the parser's time grows with the square of how deep values are
/// nested, and nobody nests them deep.
const DEEPEST: i64 = 100;
/// Characters of a message that are shown: it may quote the whole text.
const MESSAGE: usize = 300;

/// What a text holds, or what is wrong with it. One that is nested deep, or seems to be by brackets in its words, is
/// refused before it is parsed.
///
/// # Errors
/// The parser's message, with line and column.
pub fn yaml<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    let depth = text.chars().scan(0i64, |open, c| {
        *open += i64::from(matches!(c, '[' | '{')) - i64::from(matches!(c, ']' | '}'));
        Some(*open)
    });
    if depth.max().unwrap_or(0) > DEEPEST {
        return Err(format!("values are nested deeper than {DEEPEST} brackets"));
    }
    serde_yaml::from_str(text).map_err(|e| shown(&e.to_string(), MESSAGE))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_nested_without_end_are_refused_at_once() {
        let deep = "[".repeat(200_000);
        assert!(yaml::<Vec<u8>>(&deep).expect_err("deep").contains("nested deeper"));
        assert_eq!(yaml::<Vec<u8>>("[1, 2]"), Ok(vec![1, 2]));
        assert!(yaml::<Vec<u8>>("[1,").expect_err("open").chars().count() <= MESSAGE);
    }
}
