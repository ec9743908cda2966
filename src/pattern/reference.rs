//! Edge references: `front.side`, `front.L.side`, `front.side.L`, `tab.2.end`, `sleeve.cap@20%..80%`.

use super::diagnostic::{Located, Spot};
use super::problem::Problem;
use super::value::{Quantity, Side, Unit};

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

/// Largest number in a garment file. Larger ones mean nothing in any unit, and would fill a message with digits.
pub(crate) const LARGEST: f64 = 1e9;

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

/// The piece named first in `text`, whether the rest of it names anything or not.
pub(super) fn piece_of(text: &str) -> &str {
    text.split('.').next().unwrap_or_default()
}

/// The words of a reference: `front.L.side`, `tab.2.end`, or a piece alone, `band`, `front.L`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Words {
    pub(crate) piece: String,
    pub(crate) edge: Option<String>,
    pub(crate) side: Option<Side>,
    /// Number of the copy of a piece that is cut several times, from 1.
    pub(crate) copy: Option<usize>,
}

impl Words {
    /// Reads the words of `text`, without checking that they name anything.
    ///
    /// # Errors
    /// [`Problem::BadReference`] where a word is empty, and [`Problem::TwoSides`].
    pub(crate) fn parse(text: &str) -> Result<Self, Problem> {
        let mut words: Vec<&str> = text.trim().split('.').collect();
        if words.iter().any(|w| w.is_empty()) {
            return Err(Problem::BadReference(text.to_owned()));
        }
        let piece = words.remove(0).to_owned();
        // A number further on is a part of an edge: `side.2`.
        let copy = words.first().and_then(|w| w.parse().ok());
        if copy.is_some() {
            words.remove(0);
        }
        let (sides, edge): (Vec<&str>, Vec<&str>) = words.into_iter().partition(|w| Side::from_letter(w).is_some());
        if sides.len() > 1 {
            return Err(Problem::TwoSides(text.to_owned()));
        }
        let side = sides.first().and_then(|w| Side::from_letter(w));
        Ok(Self { piece, edge: (!edge.is_empty()).then(|| edge.join(".")), side, copy })
    }
}

impl Reference {
    /// Reads the text of a reference, without checking that it names anything.
    ///
    /// # Errors
    /// [`Problem::BadReference`], [`Problem::TwoSides`] and the errors of a range.
    pub(super) fn parse(written: &Located<String>) -> Result<Self, Problem> {
        let text = written.value.trim();
        let bad = || Problem::BadReference(text.to_owned());
        let (name, range) = match text.split_once('@') {
            Some((name, range)) => (name, Some(parse_range(range, bad)?)),
            None => (text, None),
        };
        let Words { piece, edge, side, copy } = Words::parse(name)?;
        let edge = edge.ok_or_else(bad)?;
        Ok(Self { text: text.to_owned(), at: written.at, piece, edge, side, copy, range })
    }
}

/// Reads the part of a reference behind its `@`.
///
/// # Errors
/// The problem of `bad` without two ends, and [`Problem::BackwardsRange`].
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
    fn a_piece_may_be_named_alone_and_numbers_after_an_edge_are_parts_of_it() {
        let words = |text| Words::parse(text).expect("words");
        let read = words("front.L");
        assert_eq!((read.piece.as_str(), read.edge, read.side), ("front", None, Some(Side::Left)));
        let read = words("band.top.2");
        assert_eq!((read.copy, read.edge.as_deref()), (None, Some("top.2")));
        assert_eq!(piece_of("front..side"), "front");
    }

    #[test]
    fn a_reference_has_one_side() {
        assert_eq!(parse("p.L.left").expect("reference").side, Some(Side::Left));
        for text in ["p.L.left.R", "p.L.left.L", "p.R.L.left@0..50"] {
            assert!(matches!(parse(text), Err(Problem::TwoSides(_))), "{text}");
        }
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
