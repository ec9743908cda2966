//! Letters of text files that are not UTF-8; the only user of encoding_rs.

use std::borrow::Cow;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// The name of a DXF file's encoding.
const CODE_PAGE: &[u8] = b"$DWGCODEPAGE";
/// The name follows within so many bytes.
const NEAR: usize = 64;
/// An XML declaration ends within so many bytes.
const DECLARATION: usize = 200;

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

/// The text of an SVG file, by the marks at its beginning or the encoding that its XML declares where it is not UTF-8;
/// and what had to be assumed.
pub(super) fn decoded_xml(bytes: &[u8]) -> (Cow<'_, str>, Option<String>) {
    let marked = Encoding::for_bom(bytes).map(|(encoding, _)| encoding).or_else(|| sixteen_bits(bytes));
    if let Some(encoding) = marked.filter(|e| [UTF_16LE, UTF_16BE].contains(e)) {
        return (encoding.decode(bytes).0, None);
    }
    if let Ok(text) = std::str::from_utf8(bytes) {
        return (Cow::Borrowed(text), None);
    }
    let name = declared(bytes);
    // A file that declares UTF-8 and is none has letters of another one.
    let named = name.as_deref().and_then(|name| Encoding::for_label(name.as_bytes()));
    let known = named.filter(|encoding| ![UTF_8, UTF_16LE, UTF_16BE].contains(encoding));
    let note = known.is_none().then(|| {
        let said = name.map_or_else(|| "does not say its encoding".to_owned(), |n| format!("calls its encoding '{n}'"));
        format!("the file {said}, and is not UTF-8: its letters are read as those of Western Europe (Windows 1252)")
    });
    (known.unwrap_or(WINDOWS_1252).decode_without_bom_handling(bytes).0, note)
}

/// UTF-16 without a mark: XML begins with `<`, which takes two bytes of it.
fn sixteen_bits(bytes: &[u8]) -> Option<&'static Encoding> {
    match bytes {
        [b'<', 0, ..] => Some(UTF_16LE),
        [0, b'<', ..] => Some(UTF_16BE),
        _ => None,
    }
}

/// The encoding that an XML declaration names: `<?xml version="1.0" encoding="ISO-8859-1"?>`.
fn declared(bytes: &[u8]) -> Option<String> {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(DECLARATION)]).into_owned();
    let head = head.trim_start().strip_prefix("<?xml")?.split("?>").next()?;
    let value = head.split_once("encoding")?.1.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| ['"', '\''].contains(c))?;
    Some(value[1..].split(quote).next()?.to_owned())
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
    fn letters_of_xml_are_read_as_they_are_declared() {
        let text = |encoding: &str| format!("<?xml version='1.0' encoding=\"{encoding}\"?><svg id='R\u{fc}cken'/>");
        let in_bytes = |text: &str| text.chars().map(|c| c as u8).collect::<Vec<u8>>();
        let utf16 = |text: &str, head: &[u16]| head.iter().copied().chain(text.encode_utf16()).collect::<Vec<u16>>();
        let little = |units: Vec<u16>| units.into_iter().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
        let big = |units: Vec<u16>| units.into_iter().flat_map(u16::to_be_bytes).collect::<Vec<u8>>();
        let [latin, wide] = ["ISO-8859-1", "UTF-16"].map(text);
        let files = [in_bytes(&latin), little(utf16(&wide, &[0xfeff])), big(utf16(&wide, &[0xfeff]))];
        let unmarked = [little(utf16(&wide, &[])), big(utf16(&wide, &[])), text("UTF-8").into_bytes()];
        for file in files.into_iter().chain(unmarked) {
            let (read, note) = decoded_xml(&file);
            assert!(read.contains("id='R\u{fc}cken'") && note.is_none(), "{read}: {note:?}");
        }
        let (polish, note) = decoded_xml(b"<?xml version='1.0' encoding = 'windows-1250' ?><svg id='przod\xb3'/>");
        assert!(polish.contains("przod\u{142}") && note.is_none());
        for (wrong, said) in
            [(text("UTF-8"), "calls its encoding 'UTF-8'"), ("<svg id='R\u{fc}'/>".into(), "does not say")]
        {
            let file = in_bytes(&wrong);
            let (read, note) = decoded_xml(&file);
            assert!(read.contains("R\u{fc}") && note.is_some_and(|note| note.contains(said)));
        }
    }

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
