//! Alterations that acts add to the list `alter` of a file, or take out of it.

use super::{ActError, path, sense};
use crate::io::garment::{Edit, alteration_line, alterations_of, examine_text};
use crate::pattern::{AlterationFile, Diagnostic, GarmentFile, Located, Quantity, Severity, StationFile};

/// Longest text of alterations, characters, and most alterations of one act.
const LONGEST: usize = 2000;
const MOST: usize = 20;

/// Alterations, as a garment file writes them or as JSON, at the end of `alter`.
///
/// # Errors
/// [`ActError::Sense`]: a text that is no alteration.
pub(super) fn added(text: &str) -> Result<(Vec<Edit>, String), ActError> {
    if text.chars().count() > LONGEST {
        return sense(format!("an alteration has at most {LONGEST} characters"));
    }
    let list = alterations_of(text).map_err(|refused| ActError::Sense(in_words(&refused.diagnostics)))?;
    if list.is_empty() || list.len() > MOST {
        return sense(format!("give 1 to {MOST} alterations, such as {{take_in: side, at: {{50 %: 8}}}}"));
    }
    let line = |own: &AlterationFile| alteration_line(own).map_err(|e| ActError::Sense(e.to_string()));
    let edits = list.iter().map(|own| Ok(Edit::Push(path(&["alter"]), line(own)?)));
    let words: Vec<String> = list.iter().map(told).collect();
    Ok((edits.collect::<Result<_, ActError>>()?, words.join(", ")))
}

/// The alteration with this number, from 0, taken out.
///
/// # Errors
/// [`ActError::Sense`]: a number that the file has not.
pub(super) fn dropped(said: &GarmentFile, number: usize) -> Result<(Vec<Edit>, String), ActError> {
    let Some(own) = said.alter.get(number) else {
        return sense(format!("the file has no alteration {}", number + 1));
    };
    Ok((vec![Edit::Remove(path(&["alter", &number.to_string()]))], format!("do not {}", told(&own.value))))
}

/// # Errors
/// [`ActError::Sense`]: a mistake that `new` has and `old` has not, such as a seam that no longer matches.
pub(super) fn carried_out(old: &str, new: &str, shown: &str) -> Result<(), ActError> {
    let errors = |text: &str| {
        let found = examine_text("garment", shown, text).findings.into_sorted();
        found.into_iter().filter(|own| own.severity == Severity::Error).collect::<Vec<Diagnostic>>()
    };
    let before = errors(old);
    let is_new = |own: &Diagnostic| before.iter().all(|known| known.message != own.message);
    let added: Vec<Diagnostic> = errors(new).into_iter().filter(is_new).collect();
    if added.is_empty() { Ok(()) } else { sense(format!("this cannot be done: {}", in_words(&added))) }
}

/// The first of what was found, with its advice, and how many more there are.
fn in_words(found: &[Diagnostic]) -> String {
    let Some(first) = found.first() else { return String::new() };
    let hint = first.hint.as_ref().map(|hint| format!(" ({hint})")).unwrap_or_default();
    let more = if found.len() > 1 { format!("; and {} more like it", found.len() - 1) } else { String::new() };
    format!("{}{hint}{more}", first.message)
}

/// An alteration in words: `take in side, 8 at 50 %`.
pub(in crate::studio) fn told(own: &AlterationFile) -> String {
    match own {
        AlterationFile::Take { seam, at, out } => {
            let kind = if *out { "let out" } else { "take in" };
            format!("{kind} {}, {}", seam.value, stations(at, written))
        }
        AlterationFile::Lengthen { pieces, at, by, shorter, across, .. } => {
            let is_across = across.as_ref().is_some_and(|across| across.value);
            let kind = match (shorter, is_across) {
                (false, false) => "lengthen",
                (true, false) => "shorten",
                (false, true) => "widen",
                (true, true) => "narrow",
            };
            let names: Vec<&str> = pieces.iter().map(|piece| piece.value.as_str()).collect();
            let axis = if is_across { "x" } else { "y" };
            format!("{kind} {} by {}, at {axis} = {}", names.join(" and "), quantity(by), quantity(at))
        }
        AlterationFile::Pivot { dart, to, share, .. } => {
            let share = share.as_ref().map(|share| format!(", {} of it", quantity(share))).unwrap_or_default();
            format!("turn dart {} to {}{share}", dart.value, to.value)
        }
        AlterationFile::Spread { from, to, by, .. } => {
            format!("slash from {} to {} and open by {}", from.value, to.value, quantity(by))
        }
        AlterationFile::Fullness { edge, to, by, .. } => {
            format!("fullness of {} at {}, slashed to {}", quantity(by), edge.value, to.value)
        }
        AlterationFile::Cut { from, to, name, .. } => {
            format!("cut from {} to {}, new piece {}", from.value, to.value, name.value)
        }
        AlterationFile::Join { seam } => format!("join the pieces of seam {}", seam.value),
        AlterationFile::Move { edge, at } => {
            format!("move {}, {}", edge.value, stations(at, |[x, y]| format!("[{x}, {y}]")))
        }
    }
}

/// Changes at positions along an edge, in the words of the file.
fn stations<T: Copy>(at: &[StationFile<T>], words: impl Fn(T) -> String) -> String {
    let each = at.iter().map(|(position, by)| format!("{} at {}", words(by.value), quantity(position)));
    each.collect::<Vec<_>>().join(", ")
}

fn quantity(own: &Located<Quantity>) -> String {
    written(own.value)
}

/// A length as it is written: `1.2 cm`.
fn written(own: Quantity) -> String {
    own.unit.map_or_else(|| own.number.to_string(), |unit| format!("{} {}", own.number, unit.symbol()))
}
