//! Alterations added to the text of a garment file, which keeps its words and comments.

use std::ops::Range;

use super::encode::alteration_line;
use super::{Refused, read_file_only, write};
use crate::pattern::{AlterationFile, GarmentFile, Located, Problem, Spot};

/// A garment file with alterations added.
#[derive(Clone, Debug, PartialEq)]
pub struct Appended {
    /// The text to write.
    pub text: String,
    /// Whether that is the old text and the new lines. Otherwise it is written anew, without its comments.
    pub in_place: bool,
}

/// Adds alterations to the end of the list `alter` of a garment file, or gives it one. `shown` is the file's name in
/// messages.
///
/// # Errors
/// [`Refused`] when the text is no garment file, or an alteration cannot be written.
pub fn appended(shown: &str, text: &str, list: &[AlterationFile]) -> Result<Appended, Refused> {
    let old = read_file_only(shown, text)?;
    let added = list.iter().map(|a| Located::new(a.clone(), Spot::default()));
    let new = GarmentFile { alter: old.alter.iter().cloned().chain(added).collect(), ..old };
    let unwritable = |why: String| Refused::whole(shown, Problem::Unreadable(why));
    let lines: Vec<String> =
        list.iter().map(alteration_line).collect::<Result<_, _>>().map_err(|e| unwritable(e.to_string()))?;
    let candidate = with_lines(text, &lines);
    if read_file_only(shown, &candidate).is_ok_and(|file| file == new) {
        return Ok(Appended { text: candidate, in_place: true });
    }
    let text = write(&new).map_err(|e| unwritable(e.to_string()))?;
    Ok(Appended { text, in_place: false })
}

/// The text with these items at the end of its list `alter`, as far as that is a list of the usual form.
fn with_lines(text: &str, items: &[String]) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let Some(block) = alter_block(&lines) else {
        lines.extend([String::new(), "alter:".to_owned()]);
        lines.extend(items.iter().map(|item| format!("  - {item}")));
        return lines.join("\n") + "\n";
    };
    let first = block.start;
    let last = block.clone().rev().find(|k| is_said(&lines[*k])).unwrap_or(first);
    let item = lines[first + 1..=last].iter().find(|line| line.trim_start().starts_with("- "));
    match item {
        Some(item) => {
            let indent = item.len() - item.trim_start().len();
            let new = items.iter().map(|item| format!("{}- {item}", " ".repeat(indent)));
            lines.splice(last + 1..last + 1, new.collect::<Vec<_>>());
        }
        None => {
            if let Some(at) = lines[last].rfind(']') {
                let empty = lines[last][..at].trim_end().ends_with('[');
                let comma = if empty { "" } else { ", " };
                lines[last].insert_str(at, &format!("{comma}{}", items.join(", ")));
            }
        }
    }
    lines.join("\n") + "\n"
}

/// The lines of the list `alter` with its key, as far as it is written in the usual form. `None` where there is none.
pub(super) fn alter_block(lines: &[String]) -> Option<Range<usize>> {
    let first = lines.iter().position(|line| line.starts_with("alter:"))?;
    let inner = |line: &&String| line.starts_with([' ', '-', '\t']) || line.trim().is_empty();
    Some(first..first + 1 + lines[first + 1..].iter().take_while(inner).count())
}

/// Whether a line holds more than a remark.
fn is_said(line: &str) -> bool {
    let bare = line.trim_start();
    !bare.is_empty() && !bare.starts_with('#')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::Quantity;

    const GARMENT: &str = "\
garment: 1
# A band.
pieces:
  band:
    grain: [[0, 0], [0, 1]]
    outline: {start: 0 0, top: L 90 0, right: L 90 8, bottom: L 0 8, left: L 0 0}
seams: {back: {sew: band.right, to: band.left}}
free: ['*.top', '*.bottom']
";

    fn longer(by: f64) -> AlterationFile {
        let here = |number: f64| Located::new(Quantity { number, unit: None }, Spot::default());
        AlterationFile::Lengthen {
            pieces: vec![Located::new("band".to_owned(), Spot::default())],
            at: here(4.0),
            by: here(by),
            over: None,
            across: None,
            shorter: false,
        }
    }

    #[test]
    fn the_old_words_stay_whatever_the_list_looks_like() {
        let lists = [
            "",
            "alter: []\n",
            "alter: [{lengthen: band, at: 3, by: 2}]   # once\n",
            "alter:\n  - {lengthen: band, at: 3, by: 2}\n  # twice\n\nsizes: {S: []}\n",
            "alter:\n- lengthen: band\n  at: 3\n  by: 2\nsizes: {S: []}\n",
        ];
        for list in lists {
            let text = format!("{GARMENT}{list}");
            let new = appended("band.yaml", &text, &[longer(5.0), longer(1.5)]).expect("a garment");
            assert!(new.in_place, "{list}: {}", new.text);
            assert!(new.text.contains("# A band."));
            let read = read_file_only("band.yaml", &new.text).expect("read");
            let before = usize::from(list.contains("by: 2"));
            assert_eq!(read.alter.len(), before + 2, "{}", new.text);
        }
        // A list that only YAML understands is written anew.
        let odd = format!("{GARMENT}? alter\n: - {{lengthen: band, at: 3, by: 2}}\n");
        let new = appended("band.yaml", &odd, &[longer(5.0)]).expect("a garment");
        assert!(!new.in_place && read_file_only("band.yaml", &new.text).expect("read").alter.len() == 2);
    }
}
