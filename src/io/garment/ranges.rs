//! Measures and alterations with ranges in place of numbers, from which variants of a garment are drawn.

use std::path::Path;

use serde_json::{Map, Value as Json};

use super::change::written;
use super::fields::{Fields, entries, items, quantity};
use super::refuse::{accept, text_of};
use super::{Refused, tree};
use crate::pattern::{Findings, Located, Problem, Unit, Value};

/// Drawn numbers have three decimals, so that lists are short and read the same everywhere.
const STEPS: f64 = 1e3;

/// A file of ranges: `measures`, names with a range each, and `alter`, alterations in which `{from: A, to: B}` may
/// stand wherever a number does.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ranges {
    measures: Vec<(String, NumberRange)>,
    alter: Vec<AlterationNode>,
}

/// From one number to another, in one unit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct NumberRange {
    from: f64,
    to: f64,
    unit: Option<Unit>,
}

/// A value of an alteration.
#[derive(Clone, Debug, PartialEq)]
enum AlterationNode {
    Text(String),
    Range(NumberRange),
    List(Vec<AlterationNode>),
    Map(Vec<(String, AlterationNode)>),
}

/// The values drawn for one variant, as lists of jobs have them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    /// Measures of the wearer, mm. Empty if the file has none.
    pub measures: Map<String, Json>,
    /// Alterations, a mapping each.
    pub alter: Vec<Json>,
}

impl Ranges {
    /// Reads a file of ranges.
    ///
    /// # Errors
    /// Every mistake of the file with its place.
    pub fn read(path: &Path) -> Result<Self, Refused> {
        Self::parse(&text_of(path)?, &path.display().to_string())
    }

    /// Reads a text; `shown` names it in errors.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(text: &str, shown: &str) -> Result<Self, Refused> {
        let mut findings = Findings::new(shown, text);
        let ranges = tree::parse_or(text, no_range(), &mut findings).and_then(|tree| file(&tree, &mut findings));
        accept(ranges, findings)
    }

    /// Whether there is no range, so that every variant is the same.
    pub fn is_empty(&self) -> bool {
        self.measures.is_empty() && !self.alter.iter().any(AlterationNode::has_range)
    }

    /// Whether measures are drawn.
    pub fn has_measures(&self) -> bool {
        !self.measures.is_empty()
    }

    /// Names of the measures of which a share is drawn, so that the wearer's own must be known.
    pub fn shares(&self) -> impl Iterator<Item = &str> {
        self.measures.iter().filter(|(_, range)| range.unit == Some(Unit::Percent)).map(|(name, _)| name.as_str())
    }

    /// Draws a variant. `random` gives numbers from 0 to 1, one for each range in the order of the file, measures
    /// first. `own` gives the wearer's own measure in mm, of which a range in per cent takes a share; a measure that it
    /// does not know is left out.
    pub fn draw(&self, own: impl Fn(&str) -> Option<f64>, mut random: impl FnMut() -> f64) -> Drawn {
        let mut drawn = Drawn::default();
        for (name, range) in &self.measures {
            let number = range.at(random());
            let mm = match range.unit {
                Some(Unit::Percent) => own(name).map(|own| rounded(0.01 * number * own)),
                unit => Some(number * unit.map_or(1.0, |unit| 1e3 * unit.factor())),
            };
            drawn.measures.extend(mm.map(|mm| (name.clone(), mm.into())));
        }
        drawn.alter = self.alter.iter().map(|node| node.drawn(&mut random)).collect();
        drawn
    }
}

fn rounded(number: f64) -> f64 {
    (STEPS * number).round() / STEPS
}

impl NumberRange {
    /// The number at `share` of the way, never outside.
    fn at(&self, share: f64) -> f64 {
        rounded(self.from + share * (self.to - self.from)).clamp(self.from, self.to)
    }

    fn read(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Self> {
        let mut fields = Fields::new(value, what, findings)?;
        let (from, to) = (fields.require("from", findings, quantity), fields.require("to", findings, quantity));
        fields.finish(findings);
        let (from, to) = (from?.value, to?.value);
        if to.unit != from.unit || from.number > to.number {
            let expected = "'from' and a 'to' that is no less, in the same unit, such as {from: 0, to: 60}";
            let found = format!("'{}' and '{}'", written(from), written(to));
            findings.error(value.at, Problem::OutOfRange { what: what.to_owned(), expected, found });
            return None;
        }
        Some(Self { from: from.number, to: to.number, unit: from.unit })
    }
}

impl AlterationNode {
    fn read(value: &Located<Value>, findings: &mut Findings) -> Option<Self> {
        match &value.value {
            Value::Text(text) => Some(Self::Text(text.clone())),
            Value::List(list) => list.iter().map(|v| Self::read(v, findings)).collect::<Option<_>>().map(Self::List),
            Value::Map(entries) if is_range(entries) => NumberRange::read(value, "a range", findings).map(Self::Range),
            Value::Map(entries) => {
                let read = |(key, value): &(Located<String>, Located<Value>)| {
                    Some((key.value.clone(), Self::read(value, findings)?))
                };
                entries.iter().map(read).collect::<Option<_>>().map(Self::Map)
            }
        }
    }

    fn has_range(&self) -> bool {
        match self {
            Self::Text(_) => false,
            Self::Range(_) => true,
            Self::List(list) => list.iter().any(Self::has_range),
            Self::Map(entries) => entries.iter().any(|(_, node)| node.has_range()),
        }
    }

    fn drawn(&self, random: &mut impl FnMut() -> f64) -> Json {
        match self {
            Self::Text(text) => as_number(text).map_or_else(|| text.as_str().into(), Json::from),
            Self::Range(range) => match range.unit {
                Some(unit) => format!("{} {}", range.at(random()), unit.symbol()).into(),
                None => range.at(random()).into(),
            },
            Self::List(list) => list.iter().map(|node| node.drawn(random)).collect(),
            Self::Map(entries) => entries.iter().map(|(key, node)| (key.clone(), node.drawn(random))).collect(),
        }
    }
}

/// A text that JSON writes as a number.
fn as_number(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// Whether a mapping has `from` and nothing that an alteration has: no other mapping in one has this key.
fn is_range(entries: &[(Located<String>, Located<Value>)]) -> bool {
    entries.iter().any(|(key, _)| key.value == "from")
}

fn file(tree: &Located<Value>, findings: &mut Findings) -> Option<Ranges> {
    let mut fields = Fields::new(tree, "a file of ranges", findings)?;
    let mut out = Ranges::default();
    if let Some(measures) = fields.take("measures") {
        for (name, value) in entries(measures, "measures", findings) {
            let range = NumberRange::read(value, &name.value, findings)?;
            out.measures.push((name.value.clone(), range));
        }
    }
    if let Some(alter) = fields.take("alter") {
        for value in items(alter) {
            out.alter.push(AlterationNode::read(value, findings)?);
        }
    }
    fields.finish(findings);
    if out.is_empty() && findings.errors() == 0 {
        findings.error(tree.at, no_range());
    }
    Some(out)
}

/// The fault of a file in which there is nothing to draw.
fn no_range() -> Problem {
    Problem::MissingKey { what: "a file of ranges".to_owned(), key: "from" }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "measures: {bust: {from: 95 %, to: 105 %}, height: {from: 160 cm, to: 180 cm}}\nalter:\n  \
                        - {lengthen: [front, back], at: 200, by: {from: 5, to: 60}}\n  \
                        - {take_in: left, at: {50 %: {from: 0 mm, to: 8 mm}}}\n";

    fn drawn(text: &str, share: f64) -> Drawn {
        let ranges = Ranges::parse(text, "r.yaml").map_err(|e| e.to_string()).expect("ranges");
        ranges.draw(|name| (name == "bust").then_some(900.0), || share)
    }

    #[test]
    fn numbers_come_from_their_ranges_and_the_rest_stays() {
        let low = drawn(TEXT, 0.0);
        assert_eq!(Json::Object(low.measures).to_string(), r#"{"bust":855.0,"height":1600.0}"#);
        assert_eq!(low.alter[0].to_string(), r#"{"lengthen":["front","back"],"at":200.0,"by":5.0}"#);
        let high = drawn(TEXT, 1.0);
        assert_eq!(high.alter[1].to_string(), r#"{"take_in":"left","at":{"50 %":"8 mm"}}"#);
        assert_eq!(drawn(TEXT, 0.5).measures["bust"], 900.0);
    }

    #[test]
    fn mistakes_have_a_place() {
        let wrong = |text: &str| Ranges::parse(text, "r.yaml").expect_err("wrong").to_string();
        assert!(wrong("measures: {bust: {from: 2, to: 1}}").contains("r.yaml:1:18: error: "));
        assert!(wrong("measures: {bust: {from: 2 mm, to: 3 cm}}").contains("the same unit"));
        assert!(wrong("measures: {bust: {from: 2}}").contains("to"));
        assert!(wrong("# nothing yet\n").contains("a file of ranges"));
        assert!(wrong("measure: {}").contains("did you mean 'measures'"));
        assert!(wrong("alter: [{lengthen: front, at: 200, by: 20}]").contains("from"));
    }
}
