//! Taking a mapping apart key by key, so that what nobody asked for is reported.

use std::ops::RangeInclusive;

use crate::input::{nearest, shown};
use crate::pattern::{Findings, LARGEST, Located, Problem, Quantity, Spot, Value, parse_quantity};

/// The entries of a mapping that have not been asked for yet.
pub(super) struct Fields<'v> {
    what: String,
    at: Spot,
    entries: Vec<Option<&'v (Located<String>, Located<Value>)>>,
    asked: Vec<&'static str>,
}

/// Characters of a value that a message shows.
const VALUE: usize = 120;

/// A short list of numbers or words as it is written, another one by its kind.
fn list(items: &[Located<Value>]) -> String {
    let word = |item: &Located<Value>| if let Value::Text(t) = &item.value { Some(shown(t, 20)) } else { None };
    match items.iter().map(word).collect::<Option<Vec<String>>>() {
        Some(words) if words.len() <= 4 => format!("[{}]", words.join(", ")),
        _ => "a list".to_owned(),
    }
}

/// The kind of a value, for messages.
fn kind(value: &Value) -> String {
    match value {
        Value::Text(t) if t.is_empty() => "nothing".to_owned(),
        Value::Text(t) => format!("'{}'", shown(t, VALUE)),
        Value::List(items) => list(items),
        Value::Map(_) => "a mapping".to_owned(),
    }
}

/// Reports a value of the wrong kind.
pub(super) fn wrong(value: &Located<Value>, what: &str, expected: &'static str, findings: &mut Findings) {
    findings.error(value.at, Problem::WrongType { what: what.to_owned(), expected, found: kind(&value.value) });
}

impl<'v> Fields<'v> {
    /// The entries of `value`, called `what` in messages; reported and `None` if it is no mapping.
    pub(super) fn new(value: &'v Located<Value>, what: &str, findings: &mut Findings) -> Option<Self> {
        let Value::Map(entries) = &value.value else {
            wrong(value, what, "a mapping (key: value)", findings);
            return None;
        };
        Some(Self {
            what: what.to_owned(),
            at: value.at,
            entries: entries.iter().map(Some).collect(),
            asked: Vec::new(),
        })
    }

    /// Where the mapping stands.
    pub(super) fn at(&self) -> Spot {
        self.at
    }

    /// Whether `key` is written.
    pub(super) fn has(&self, key: &str) -> bool {
        self.entries.iter().flatten().any(|(k, _)| k.value == key)
    }

    /// The value of `key`.
    pub(super) fn take(&mut self, key: &'static str) -> Option<&'v Located<Value>> {
        self.asked.push(key);
        let slot = self.entries.iter_mut().find(|e| e.is_some_and(|(k, _)| k.value == key))?;
        slot.take().map(|(_, v)| v)
    }

    /// The value of a key that must be there.
    pub(super) fn need(&mut self, key: &'static str, findings: &mut Findings) -> Option<&'v Located<Value>> {
        let value = self.take(key);
        if value.is_none() {
            findings.error(self.at, Problem::MissingKey { what: self.what.clone(), key });
        }
        value
    }

    /// `parse` applied to the value of `key`, if it is there.
    pub(super) fn get<T>(
        &mut self,
        key: &'static str,
        findings: &mut Findings,
        parse: impl Fn(&Located<Value>, &str, &mut Findings) -> Option<Located<T>>,
    ) -> Option<Located<T>> {
        let value = self.take(key)?;
        parse(value, key, findings)
    }

    /// The same for a key that must be there.
    pub(super) fn require<T>(
        &mut self,
        key: &'static str,
        findings: &mut Findings,
        parse: impl Fn(&Located<Value>, &str, &mut Findings) -> Option<Located<T>>,
    ) -> Option<Located<T>> {
        let value = self.need(key, findings)?;
        parse(value, key, findings)
    }

    /// The other fields, kept as they are.
    pub(super) fn rest(self) -> Vec<(Located<String>, Located<Value>)> {
        self.entries.into_iter().flatten().cloned().collect()
    }

    /// Reports what is left.
    pub(super) fn finish(self, findings: &mut Findings) {
        for (key, _) in self.entries.iter().flatten() {
            let near = nearest(&key.value, self.asked.iter().copied()).map(str::to_owned);
            let known = self.asked.join(", ");
            let (key_name, what) = (key.value.clone(), self.what.clone());
            findings.error(key.at, Problem::UnknownKey { key: key_name, what, nearest: near, known });
        }
    }
}

/// Reports keys that exclude each other, if more than one of them is written.
pub(super) fn exclusive(keys: impl IntoIterator<Item = (&'static str, Option<Spot>)>, findings: &mut Findings) {
    let said: Vec<_> = keys.into_iter().filter_map(|(key, at)| Some((key, at?))).collect();
    if let [(one, _), (other, at), ..] = said[..] {
        findings.error(at, Problem::Exclusive { one, other });
    }
}

/// A scalar.
pub(super) fn text(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<String>> {
    match &value.value {
        Value::Text(t) if !t.is_empty() => Some(Located::new(t.clone(), value.at)),
        _ => {
            wrong(value, what, "a word or a text", findings);
            None
        }
    }
}

/// A finite number.
pub(super) fn number(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<f64>> {
    let parsed = match &value.value {
        Value::Text(t) => sensible(t),
        _ => None,
    };
    if parsed.is_none() {
        wrong(value, what, "a number", findings);
    }
    parsed.map(|n| Located::new(n, value.at))
}

/// A number above zero.
pub(super) fn positive(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<f64>> {
    let n = number(value, what, findings)?;
    if n.value <= 0.0 {
        out_of_range(value.at, what, "above zero", n.value, findings);
        return None;
    }
    Some(n)
}

fn out_of_range(at: Spot, what: &str, expected: &'static str, found: f64, findings: &mut Findings) {
    findings.error(at, Problem::OutOfRange { what: what.to_owned(), expected, found: found.to_string() });
}

/// A whole number.
pub(super) fn integer<T: std::str::FromStr>(
    value: &Located<Value>,
    what: &str,
    findings: &mut Findings,
) -> Option<Located<T>> {
    let parsed = match &value.value {
        Value::Text(t) => t.trim().parse().ok(),
        _ => None,
    };
    if parsed.is_none() {
        wrong(value, what, "a whole number", findings);
    }
    parsed.map(|n| Located::new(n, value.at))
}

/// A whole number of the `range`, which is as `expected` in words.
pub(super) fn integer_within<T: std::str::FromStr + PartialOrd + std::fmt::Display>(
    value: &Located<Value>,
    what: &str,
    range: RangeInclusive<T>,
    expected: &'static str,
    findings: &mut Findings,
) -> Option<Located<T>> {
    let number = integer::<T>(value, what, findings)?;
    if range.contains(&number.value) {
        return Some(number);
    }
    let (what, found) = (what.to_owned(), number.value.to_string());
    findings.error(value.at, Problem::OutOfRange { what, expected, found });
    None
}

/// A number with or without a unit.
pub(super) fn quantity(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<Quantity>> {
    let Value::Text(t) = &value.value else {
        wrong(value, what, "a length such as 12 or 1.2 cm", findings);
        return None;
    };
    match parse_quantity(t) {
        Ok(q) => Some(Located::new(q, value.at)),
        Err(Problem::OutOfRange { .. }) => {
            wrong(value, what, "a length such as 12 or 1.2 cm", findings);
            None
        }
        Err(problem) => {
            findings.error(value.at, problem);
            None
        }
    }
}

/// A finite number of no more than [`LARGEST`].
fn sensible(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|n: &f64| n.abs() <= LARGEST)
}

/// A length, no part of a whole.
pub(super) fn distance(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<Quantity>> {
    let q = quantity(value, what, findings)?;
    if q.value.is_percent() {
        wrong(value, what, "a length such as 12 or 1.2 cm", findings);
        return None;
    }
    Some(q)
}

/// A length of zero or more.
pub(super) fn width(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<Quantity>> {
    not_negative(distance(value, what, findings)?, what, findings)
}

/// A part of a whole, zero or more: `0.5 %` or 0.005.
pub(super) fn share(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<Quantity>> {
    let q = quantity(value, what, findings)?;
    if q.value.unit.is_some() && !q.value.is_percent() {
        wrong(value, what, "a part of the whole such as 0.5 % or 0.005", findings);
        return None;
    }
    not_negative(q, what, findings)
}

fn not_negative(q: Located<Quantity>, what: &str, findings: &mut Findings) -> Option<Located<Quantity>> {
    if q.value.number < 0.0 {
        out_of_range(q.at, what, "zero or more", q.value.number, findings);
        return None;
    }
    Some(q)
}

/// A length above zero.
pub(super) fn length(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<Quantity>> {
    let q = distance(value, what, findings)?;
    if q.value.number <= 0.0 {
        out_of_range(value.at, what, "above zero", q.value.number, findings);
        return None;
    }
    Some(q)
}

/// `[x, y]`, or `x y` as text.
pub(super) fn numbers<const N: usize>(
    value: &Located<Value>,
    what: &str,
    findings: &mut Findings,
) -> Option<Located<[f64; N]>> {
    let words: Vec<&str> = match &value.value {
        Value::Text(t) => t.split([' ', ',']).filter(|w| !w.is_empty()).collect(),
        Value::List(items) => items.iter().map(|i| if let Value::Text(t) = &i.value { t.trim() } else { "" }).collect(),
        Value::Map(_) => Vec::new(),
    };
    let parsed: Vec<f64> = words.iter().filter_map(|w| sensible(w)).collect();
    match <[f64; N]>::try_from(parsed) {
        Ok(array) if words.len() == N => Some(Located::new(array, value.at)),
        _ => {
            wrong(
                value,
                what,
                if N == 2 { "two finite numbers: x y" } else { "three finite numbers: x y z" },
                findings,
            );
            None
        }
    }
}

/// The entries of a mapping, or none reported.
pub(super) fn entries<'v>(
    value: &'v Located<Value>,
    what: &str,
    findings: &mut Findings,
) -> &'v [(Located<String>, Located<Value>)] {
    match &value.value {
        Value::Map(entries) => entries,
        Value::Text(t) if t.is_empty() => &[],
        _ => {
            wrong(value, what, "a mapping (key: value)", findings);
            &[]
        }
    }
}

/// The items of a list; a single value is a list of one.
pub(super) fn items(value: &Located<Value>) -> &[Located<Value>] {
    match &value.value {
        Value::List(items) => items,
        Value::Text(t) if t.is_empty() => &[],
        _ => std::slice::from_ref(value),
    }
}

/// One of a few words.
pub(super) fn word<T>(
    value: &Located<Value>,
    what: &'static str,
    known: &'static str,
    findings: &mut Findings,
    choose: impl Fn(&str) -> Option<T>,
) -> Option<Located<T>> {
    let written = text(value, what, findings)?;
    let chosen = choose(&written.value);
    if chosen.is_none() {
        findings.error(value.at, Problem::UnknownWord { what, found: written.value, known });
    }
    chosen.map(|c| Located::new(c, value.at))
}

/// A name that a piece, an edge, a dart or a line may have.
pub(super) fn name(written: &Located<String>, findings: &mut Findings) -> Option<Located<String>> {
    let name = &written.value;
    let letters = name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    let taken = ["L", "R", "mirror", "all"].contains(&name.as_str()) || name.parse::<f64>().is_ok();
    if name.is_empty() || !letters || taken {
        findings.error(written.at, Problem::BadName(name.clone()));
        return None;
    }
    Some(written.clone())
}
