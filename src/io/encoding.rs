//! Letters of text files that are not UTF-8; the only user of encoding_rs.

use std::borrow::Cow;

use encoding_rs::{Encoding, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// The name of a DXF file's encoding.
const CODE_PAGE: &[u8] = b"$DWGCODEPAGE";
/// The name follows within so many bytes.
const NEAR: usize = 64;

/// The text of a DXF file, by its `$DWGCODEPAGE` where it is not UTF-8; and what had to be assumed.
pub(super) fn decoded(bytes: &[u8]) -> (Cow<'_, str>, Option<String>) {
    if let Some((encoding, _)) = Encoding::for_bom(bytes).filter(|(e, _)| [UTF_16LE, UTF_16BE].contains(e)) {
        return (encoding.decode(bytes).0, None);
    }
    if let Ok(text) = std::str::from_utf8(bytes) {
        return (Cow::Borrowed(text), None);
    }
    let name = code_page(bytes);
    let known = name.as_deref().and_then(|name| Encoding::for_label(label(name).as_bytes()));
    let note = known.is_none().then(|| {
        let said =
            name.map_or_else(|| "does not say its code page".to_owned(), |n| format!("names the code page '{n}'"));
        format!("the file {said}, and is not UTF-8: its letters are read as those of Western Europe (Windows 1252)")
    });
    (known.unwrap_or(WINDOWS_1252).decode_without_bom_handling(bytes).0, note)
}

/// The value of `$DWGCODEPAGE`.
fn code_page(bytes: &[u8]) -> Option<String> {
    let at = bytes.windows(CODE_PAGE.len()).position(|w| w == CODE_PAGE)? + CODE_PAGE.len();
    let rest = String::from_utf8_lossy(&bytes[at..bytes.len().min(at + NEAR)]).into_owned();
    let mut lines = rest.lines().map(str::trim).filter(|line| !line.is_empty());
    // The group code, then the name.
    lines.next()?;
    lines.next().map(str::to_owned)
}

/// As the web calls what AutoCAD calls `ANSI_1251`.
fn label(name: &str) -> String {
    let number = name.rsplit(['_', '-']).next().unwrap_or(name);
    match number {
        "874" => "windows-874".to_owned(),
        "932" => "shift_jis".to_owned(),
        "936" => "gbk".to_owned(),
        "949" => "euc-kr".to_owned(),
        "950" => "big5".to_owned(),
        "866" | "dos866" => "ibm866".to_owned(),
        n if n.len() == 4 && n.starts_with("125") => format!("windows-{n}"),
        _ => name.to_ascii_lowercase().replace('_', "-"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_read_by_the_code_page_that_the_file_names() {
        let file = |page: &str, letters: &[u8]| {
            [b"9\n$DWGCODEPAGE\n3\n", page.as_bytes(), b"\n0\nTEXT\n1\n", letters, b"\n"].concat()
        };
        let cyrillic = file("ANSI_1251", &[0xcf, 0xc5, 0xd0, 0xc5, 0xc4]);
        assert!(decoded(&cyrillic).0.contains("ПЕРЕД") && decoded(&cyrillic).1.is_none());
        let japanese = file("ANSI_932", &[0x83, 0x7b]);
        assert!(decoded(&japanese).0.contains('ボ'));
        let unknown = file("KLINGON", &[0xfc]);
        assert!(decoded(&unknown).0.contains('ü') && decoded(&unknown).1.is_some_and(|n| n.contains("KLINGON")));
        assert!(decoded("naïve".as_bytes()).1.is_none());
    }
}
