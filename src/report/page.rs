//! `report.html`: the garment on its body, its pattern, maps and tables as one page that needs no network.

/// The page's own files, in the order in which they are joined. No bundler: each defines what the next ones use.
const MODULES: [&str; 8] = [
    include_str!("page/data.js"),
    include_str!("page/maps.js"),
    include_str!("page/camera.js"),
    include_str!("page/space.js"),
    include_str!("page/fill.js"),
    include_str!("page/flat.js"),
    include_str!("page/tables.js"),
    include_str!("page/views.js"),
];
/// Its beginning, which takes what the page holds.
const MAIN: &str = include_str!("page/main.js");
const FRAME: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
/// The two views, in markup.
const VIEWS: &str = include_str!("page/views.html");

/// The page's own parts, for another page that shows a garment.
pub struct PageParts {
    /// Scripts, to be joined with a beginning of its own that calls `load`.
    pub scripts: String,
    /// Styles.
    pub style: &'static str,
    /// Markup of the two views.
    pub views: &'static str,
}

/// The parts of the page.
pub fn page_parts() -> PageParts {
    PageParts { scripts: MODULES.join("\n"), style: STYLE, views: VIEWS }
}

/// The page called `title`. `report` is the text of `report.json`, `garment` the draped garment and `body` the surface
/// that it is on, both as binary glTF. Without a body the garment is shown alone.
///
/// Names and texts are data in the page, never markup.
pub fn page(title: &str, report: &str, garment: &[u8], body: Option<&[u8]>) -> String {
    let parts = [
        ("title", escaped(title)),
        ("style", STYLE.to_owned()),
        ("report", as_script(report)),
        ("garment", base64(garment)),
        ("body", body.map(base64).unwrap_or_default()),
        ("views", VIEWS.to_owned()),
        ("script", [MODULES.join("\n").as_str(), MAIN].join("\n")),
    ];
    let mut out = String::new();
    let mut rest = FRAME;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        out.push_str(before);
        out.push_str(parts.iter().find(|part| part.0 == name).map_or("", |part| &part.1));
        rest = after;
    }
    out.push_str(rest);
    out
}

/// Text for markup.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// JSON within a script element, which must not hold its end, nor the beginning of a comment.
fn as_script(json: &str) -> String {
    json.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

/// Bytes as base64 (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |k: usize| u32::from(chunk.get(k).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * k) & 63) as usize] as char;
            out.push(if k <= chunk.len() { digit } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Report;

    #[test]
    fn base64_is_that_of_the_rfc() {
        let coded = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.as_bytes()));
        assert_eq!(coded, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
        assert_eq!(base64(&[0xfb, 0xff]), "+/8=");
    }

    #[test]
    fn names_are_text_and_nothing_is_fetched() {
        let evil = "</script><script>alert(1)</script>{{body}}<!--";
        let report = Report { garment: evil.into(), mannequin: evil.into(), ..Report::default() };
        let page = page(evil, &serde_json::to_string(&report).expect("JSON"), b"garment", None);
        assert!(!page.contains("<script>alert") && !page.contains("<!--"), "a name is markup");
        // Two elements of data, one of text, and the script itself.
        assert_eq!(page.matches("<script").count(), 4);
        assert_eq!(page.matches("</script>").count(), 4);
        let data =
            page.split_once("id=\"report\">").and_then(|(_, rest)| rest.split_once("</script>")).expect("data").0;
        let read: Report = serde_json::from_str(data).expect("JSON");
        assert_eq!(read.garment, evil);
        for word in ["http://", "https://", "src=", "href=", "@import", "url(", "fetch(", "import "] {
            assert!(!page.contains(word), "{word}");
        }
    }
}
