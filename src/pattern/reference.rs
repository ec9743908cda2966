//! Edge references: `front.side`, `front.L.side`, `front.side.L`, `tab.2.end`, `sleeve.cap@20%..80%`.

use super::diagnostic::{Located, Spot};
use super::file::{Quantity, Side, Unit};
use super::problem::Problem;

/// A parsed edge reference.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reference {
    /// As written.
    pub(super) text: String,
    pub(super) at: Spot,
    pub(super) piece: String,
    pub(super) edge: String,
    pub(super) side: Option<Side>,
    /// Number of the copy of a piece that is cut several times, from 1.
    pub(super) copy: Option<usize>,
    pub(super) range: Option<[Quantity; 2]>,
}

/// Larger numbers mean nothing in any unit, and would fill a message with digits.
const LARGEST: f64 = 1e9;

/// Reads a quantity: a number and perhaps a unit.
///
/// # Errors
/// [`Problem::UnknownUnit`], or [`Problem::OutOfRange`] when there is no finite number.
pub fn parse_quantity(text: &str) -> Result<Quantity, Problem> {
    let text = text.trim();
    let split = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c))).unwrap_or(text.len());
    let (number, unit) = (text[..split].trim(), text[split..].trim());
    let number: f64 = number.parse().ok().filter(|n: &f64| n.abs() <= LARGEST).ok_or_else(|| Problem::OutOfRange {
        what: "a length".to_owned(),
        expected: "a number, perhaps with a unit (12, 1.2 cm, 5 %)",
        found: format!("'{text}'"),
    })?;
    let unit = match unit {
        "" => None,
        symbol => Some(Unit::from_symbol(symbol).ok_or_else(|| Problem::UnknownUnit(symbol.to_owned()))?),
    };
    Ok(Quantity { number, unit })
}

/// The piece named first in `text`, and the side if one is said: `front.L` or `front.L.center`.
pub(super) fn piece_of(text: &str) -> (&str, Option<Side>, Option<usize>) {
    let mut words = text.split('.');
    let piece = words.next().unwrap_or_default();
    let (mut side, mut copy) = (None, None);
    for word in words {
        side = side.or_else(|| Side::from_letter(word));
        copy = copy.or_else(|| word.parse().ok());
    }
    (piece, side, copy)
}

impl Reference {
    /// Reads the text of a reference. Whether it names anything is not looked at.
    ///
    /// # Errors
    /// [`Problem::BadReference`] and the errors of a range.
    pub(super) fn parse(written: &Located<String>) -> Result<Self, Problem> {
        let text = written.value.trim();
        let bad = || Problem::BadReference(text.to_owned());
        let (name, range) = match text.split_once('@') {
            Some((name, range)) => (name, Some(parse_range(range, bad)?)),
            None => (text, None),
        };
        let mut words: Vec<&str> = name.split('.').collect();
        if words.len() < 2 || words.iter().any(|w| w.is_empty()) {
            return Err(bad());
        }
        let piece = words.remove(0).to_owned();
        let copy = words[0].parse().ok();
        if copy.is_some() {
            words.remove(0);
        }
        let side = words.iter().find_map(|w| Side::from_letter(w));
        words.retain(|w| Side::from_letter(w).is_none());
        if words.is_empty() {
            return Err(bad());
        }
        Ok(Self { text: text.to_owned(), at: written.at, piece, edge: words.join("."), side, copy, range })
    }
}

/// Reads what stands behind the `@` of a reference.
///
/// # Errors
/// What `bad` says where there are no two ends, and [`Problem::BackwardsRange`].
pub(super) fn parse_range(range: &str, bad: impl Fn() -> Problem) -> Result<[Quantity; 2], Problem> {
    let (from, to) = range.split_once("..").ok_or_else(&bad)?;
    let ends = [parse_quantity(from)?, parse_quantity(to)?];
    let comparable = ends[0].unit == ends[1].unit;
    if comparable && ends[0].number >= ends[1].number {
        return Err(Problem::BackwardsRange(range.to_owned()));
    }
    Ok(ends)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Reference, Problem> {
        Reference::parse(&Located::new(text.to_owned(), Spot::default()))
    }

    #[test]
    fn sides_copies_and_ranges_are_read() {
        let r = parse("front.L.side.2@20%..80 %").expect("reference");
        assert_eq!((r.piece.as_str(), r.edge.as_str(), r.side), ("front", "side.2", Some(Side::Left)));
        assert_eq!(r.range.expect("range")[1], Quantity { number: 80.0, unit: Some(Unit::Percent) });
        let r = parse("tab.2.end").expect("reference");
        assert_eq!((r.copy, r.edge.as_str()), (Some(2), "end"));
    }

    #[test]
    fn nonsense_is_refused() {
        assert!(matches!(parse("front"), Err(Problem::BadReference(_))));
        assert!(matches!(parse("front..side"), Err(Problem::BadReference(_))));
        assert!(matches!(parse("a.b@80%..20%"), Err(Problem::BackwardsRange(_))));
        assert!(matches!(parse("a.b@1 inch..2 inch"), Err(Problem::UnknownUnit(_))));
        assert!(matches!(parse("a.b@nan..2"), Err(Problem::OutOfRange { .. })));
    }
}
