//! Test results as JUnit XML, which build servers read.

use std::fmt::Write as _;

use super::test_outcome::TestOutcome;

/// One suite per garment, one case per bound, one per stage that did not come to rest, and one for being made at all.
pub(super) fn xml(outcomes: &[TestOutcome]) -> String {
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n");
    for o in outcomes {
        let failures = o.bounds.iter().filter(|v| !v.ok).count() + o.restless.len();
        let errors = usize::from(o.error.is_some());
        let name = escaped(&o.file);
        let _ = writeln!(
            out,
            "  <testsuite name=\"{name}\" tests=\"{}\" failures=\"{failures}\" errors=\"{errors}\" time=\"{:.3}\">",
            o.bounds.len() + o.restless.len() + 1,
            o.seconds
        );
        let _ = match &o.error {
            None => writeln!(out, "    <testcase classname=\"{name}\" name=\"made\"/>"),
            Some(e) => writeln!(
                out,
                "    <testcase classname=\"{name}\" name=\"made\"><error message=\"{}\"/></testcase>",
                escaped(e)
            ),
        };
        for v in &o.bounds {
            let case = format!("    <testcase classname=\"{name}\" name=\"{}\"", escaped(&v.bound));
            let _ = if v.ok {
                writeln!(out, "{case}/>")
            } else {
                writeln!(out, "{case}><failure message=\"{}\"/></testcase>", escaped(&v.to_string()))
            };
        }
        for r in &o.restless {
            let case = format!("    <testcase classname=\"{name}\" name=\"{} at rest\"", escaped(&r.stage));
            let _ = writeln!(out, "{case}><failure message=\"{}\"/></testcase>", escaped(&r.to_string()));
        }
        out.push_str("  </testsuite>\n");
    }
    out.push_str("</testsuites>\n");
    out
}

/// Text as an attribute's value; XML forbids most control characters.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' => out.push_str("&#10;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
