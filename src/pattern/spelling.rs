//! Globs.

/// Whether `text` matches `pattern`, where `*` stands for any characters.
pub(crate) fn glob(pattern: &str, text: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = parts.next().and_then(|first| text.strip_prefix(first)) else { return false };
    let parts: Vec<&str> = parts.collect();
    let Some((last, middle)) = parts.split_last() else { return rest.is_empty() };
    for part in middle {
        match rest.find(part) {
            Some(i) => rest = &rest[i + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn globs_match_anything_at_a_star() {
        assert!(glob("*.hem", "front.hem") && glob("*.hem*", "front.hem.L") && glob("front.*", "front.side"));
        assert!(!glob("*.hem", "front.neck") && !glob("front.hem", "front.hems") && !glob("a*a", "a"));
    }
}
