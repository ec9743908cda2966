//! Findings about a garment file, with their places.

use std::fmt;

use super::problem::Problem;
use crate::input::shown;

/// A place in the text of a file. Lines and columns count from 1. Line 0 is the file as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Spot {
    /// Line.
    pub line: usize,
    /// Column, in characters.
    pub column: usize,
    /// Characters to underline.
    pub width: usize,
}

/// A value and where it was written. Comparison looks at the value alone: a garment read back from its own
/// rewritten file is the same garment.
#[derive(Clone, Copy, Debug, Default)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Its place.
    pub at: Spot,
}

impl<T> Located<T> {
    /// `value`, written at `at`.
    pub fn new(value: T, at: Spot) -> Self {
        Self { value, at }
    }
}

impl<T: PartialEq> PartialEq for Located<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

/// Severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The garment can be used. Something in it was read in a way its author may not have meant.
    Warning,
    /// The garment cannot be used.
    Error,
}

/// One finding, ready to be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Severity.
    pub severity: Severity,
    /// File name as given by the caller.
    pub file: String,
    /// Line, from 1. Line 0 is the file as a whole.
    pub line: usize,
    /// Column from 1.
    pub column: usize,
    /// The problem.
    pub problem: Problem,
    /// The problem in words.
    pub message: String,
    /// Advice.
    pub hint: Option<String>,
    /// The line of the file.
    excerpt: Option<Excerpt>,
}

/// A line of the file, or the part of a long one round the place.
#[derive(Clone, Debug, PartialEq)]
struct Excerpt {
    text: String,
    /// Characters before the place.
    before: usize,
    /// Characters to underline.
    width: usize,
}

impl Excerpt {
    fn new(line: &str, before: usize, width: usize) -> Self {
        let visible = |c: char| if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c };
        let first = if before < EXCERPT_WIDTH { 0 } else { before - EXCERPT_WIDTH / 2 };
        let mut text: String = line.chars().skip(first).take(EXCERPT_WIDTH).map(visible).collect();
        let room = text.chars().count().saturating_sub(before - first);
        if line.chars().nth(first + EXCERPT_WIDTH).is_some() {
            text.push('…');
        }
        let cut = usize::from(first > 0);
        if cut > 0 {
            text.insert(0, '…');
        }
        Self { text, before: before - first + cut, width: width.min(room).max(1) }
    }
}

impl Diagnostic {
    /// Its place in the file.
    fn spot(&self) -> Spot {
        let width = self.excerpt.as_ref().map_or(0, |e| e.width);
        Spot { line: self.line, column: self.column, width }
    }

    /// Sort key among findings of the file: by line, with the count of further findings last.
    pub(crate) fn order(&self) -> (bool, usize, usize) {
        (matches!(self.problem, Problem::More { .. }), self.line, self.column)
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        if self.line == 0 {
            write!(f, "{}: {severity}: {}", self.file, self.message)?;
        } else {
            write!(f, "{}:{}:{}: {severity}: {}", self.file, self.line, self.column, self.message)?;
        }
        if let Some(Excerpt { text, before, width }) = &self.excerpt {
            let number = self.line.to_string();
            // Tabs stay tabs in the padding, so that the carets stand under their characters.
            let pad: String = text.chars().take(*before).map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
            write!(f, "\n  {number} | {text}\n  {} | {pad}{}", " ".repeat(number.len()), "^".repeat(*width))?;
        }
        if let Some(hint) = &self.hint {
            write!(f, "\n  help: {hint}")?;
        }
        Ok(())
    }
}

/// Number of warnings, and of errors, that are kept. Further ones are only counted, so that a broken file of a million
/// lines does not fill the screen.
const KEPT: usize = 200;
/// Number of characters of a line that are shown: the whole line, or this many round the place.
const EXCERPT_WIDTH: usize = 160;
/// Largest number of characters of a message, and of a hint: enough for a list of all edges of a garment.
const MESSAGE: usize = 1200;

/// Collects the findings of one file.
#[derive(Debug, Default)]
pub struct Findings {
    file: String,
    lines: Vec<String>,
    /// Up to [`KEPT`] of either severity.
    found: Vec<Diagnostic>,
    warnings: usize,
    errors: usize,
    /// Names of pieces, which may share statements.
    pieces: Vec<String>,
}

impl Findings {
    /// For the file called `file` with this `text` (empty if the garment was not read from text).
    pub fn new(file: &str, text: &str) -> Self {
        Self { file: file.to_owned(), lines: text.lines().map(str::to_owned).collect(), ..Self::default() }
    }

    /// Names the pieces, so that the same finding about several pieces at one place of the file is reported once.
    pub fn know_pieces(&mut self, names: impl IntoIterator<Item = String>) {
        self.pieces = names.into_iter().collect();
    }

    /// Adds an error.
    pub fn error(&mut self, at: Spot, problem: Problem) {
        self.errors += 1;
        if self.errors <= KEPT {
            self.push(Severity::Error, at, problem);
        }
    }

    /// Adds a warning.
    pub fn warn(&mut self, at: Spot, problem: Problem) {
        self.warnings += 1;
        if self.warnings <= KEPT {
            self.push(Severity::Warning, at, problem);
        }
    }

    fn push(&mut self, severity: Severity, at: Spot, problem: Problem) {
        let line = at.line.checked_sub(1).and_then(|i| self.lines.get(i)).filter(|_| at.column > 0);
        let excerpt = line.map(|line| Excerpt::new(line, at.column - 1, at.width));
        self.found.push(Diagnostic {
            severity,
            file: self.file.clone(),
            line: at.line,
            column: at.column,
            message: shown(&problem.to_string(), MESSAGE),
            hint: problem.hint().map(|hint| shown(&hint, MESSAGE)),
            problem,
            excerpt,
        });
    }

    /// Adds one finding in the place of the first warning of a kind, with their common meaning, if there are `count` of
    /// them.
    pub(super) fn tell_together(&mut self, count: usize, is_kind: impl Fn(&Problem) -> bool, problem: Problem) {
        let of_kind = |d: &Diagnostic| d.severity == Severity::Warning && is_kind(&d.problem);
        let mut spots = self.found.iter().filter(|d| of_kind(d)).map(Diagnostic::spot);
        let Some(first) = spots.next().filter(|_| spots.count() + 1 == count) else { return };
        self.found.retain(|d| !of_kind(d));
        self.warnings -= count;
        self.warn(first, problem);
    }

    /// Number of errors so far.
    pub fn errors(&self) -> usize {
        self.errors
    }

    /// Adds the number of findings that were counted and not kept.
    fn count_others(&mut self) {
        let whole = Spot::default();
        if let Some(count) = self.warnings.checked_sub(KEPT).filter(|&n| n > 0) {
            self.push(Severity::Warning, whole, Problem::More { count, what: "warning" });
        }
        if let Some(count) = self.errors.checked_sub(KEPT).filter(|&n| n > 0) {
            self.push(Severity::Error, whole, Problem::More { count, what: "error" });
        }
    }

    /// The findings in the order of the file, each once. Warnings and errors beyond the first two hundred of either are
    /// only counted at the end.
    pub fn into_sorted(mut self) -> Vec<Diagnostic> {
        self.count_others();
        self.found.sort_by_key(Diagnostic::order);
        // Both sides of a pair make the same mistake: it is said once. Only the words are compared: lengths of what is
        // mirrored differ in their last digits.
        let mut unique: Vec<Diagnostic> = Vec::new();
        let is_same =
            |a: &Diagnostic, b: &Diagnostic| (a.severity, a.spot()) == (b.severity, b.spot()) && a.message == b.message;
        for diagnostic in self.found {
            if !unique.iter().any(|known| is_same(known, &diagnostic)) {
                unique.push(diagnostic);
            }
        }
        told_once(unique, &self.pieces)
    }
}

/// Merges findings that a piece shares with pieces that take from it by `like`.
fn told_once(found: Vec<Diagnostic>, pieces: &[String]) -> Vec<Diagnostic> {
    let mut kept: Vec<(Diagnostic, Vec<&str>)> = Vec::new();
    for diagnostic in found {
        let at_one_place = |k: &Diagnostic| {
            diagnostic.line > 0
                && (k.line, k.column, k.severity) == (diagnostic.line, diagnostic.column, diagnostic.severity)
        };
        let others = kept.iter_mut().filter(|(k, _)| at_one_place(k));
        let same = others.map(|(k, also)| (other_piece(&k.message, &diagnostic.message, pieces), also));
        match same.filter_map(|(piece, also)| Some((piece?, also))).next() {
            Some((piece, also)) => also.push(piece),
            None => kept.push((diagnostic, Vec::new())),
        }
    }
    let told = |(mut diagnostic, also): (Diagnostic, Vec<&str>)| {
        if !also.is_empty() {
            let names: Vec<String> = also.iter().map(|name| format!("'{name}'")).collect();
            diagnostic.message.push_str(&format!(" (the same in {})", names.join(", ")));
        }
        diagnostic
    };
    kept.into_iter().map(told).collect()
}

/// The piece of `message`, if the message says of it what `first` says of another piece.
fn other_piece<'p>(first: &str, message: &str, pieces: &'p [String]) -> Option<&'p str> {
    let named = pieces.iter().filter(|piece| renamed(first, piece, "") != first);
    let pairs = named.flat_map(|one| pieces.iter().map(move |other| (one, other)));
    pairs
        .into_iter()
        .find(|(one, other)| one != other && renamed(first, one, other) == message)
        .map(|(_, o)| o.as_str())
}

/// A text with another name wherever it has this one as a word of its own.
fn renamed(text: &str, from: &str, to: &str) -> String {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    let mut out = String::new();
    let mut rest = text;
    while let Some(k) = rest.find(from).filter(|_| !from.is_empty()) {
        let (before, after) = (&rest[..k], &rest[k + from.len()..]);
        let alone = !after.starts_with(is_part) && !before.ends_with(is_part);
        out.push_str(before);
        out.push_str(if alone { to } else { from });
        rest = after;
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(line: usize) -> Spot {
        Spot { line, column: 1, width: 1 }
    }

    #[test]
    fn many_warnings_hide_no_error() {
        let mut findings = Findings::new("test.yaml", "");
        (0..300).for_each(|i| findings.warn(at(i + 1), Problem::NoGrain(i.to_string())));
        findings.error(at(400), Problem::Empty);
        let found = findings.into_sorted();
        assert_eq!(found.len(), KEPT + 2);
        assert_eq!((found[KEPT].severity, found[KEPT].line), (Severity::Error, 400));
        assert!(found[KEPT + 1].to_string().starts_with("test.yaml: warning: … and 100 more warnings\n"));
    }

    #[test]
    fn of_many_errors_it_is_said_how_many_there_are() {
        let mut findings = Findings::new("test.yaml", "");
        (0..KEPT).for_each(|i| findings.error(at(i + 1), Problem::NoGrain(i.to_string())));
        let before = findings.errors();
        findings.error(at(KEPT + 1), Problem::Empty);
        assert_eq!((before, findings.errors()), (KEPT, KEPT + 1));
        let found = findings.into_sorted();
        assert_eq!(found.len(), KEPT + 1);
        assert!(found[KEPT].to_string().starts_with("test.yaml: error: … and 1 more error\n  help: "));
        // As many as are kept are all that there are.
        let mut findings = Findings::new("test.yaml", "");
        (0..KEPT).for_each(|i| findings.warn(at(i + 1), Problem::NoGrain(i.to_string())));
        assert_eq!(findings.into_sorted().len(), KEPT);
    }
}
