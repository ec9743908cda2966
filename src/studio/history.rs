//! Acts that can be undone: the bytes of the file before and after each.

/// Acts that are kept, and bytes that they may take together.
const MOST: usize = 300;
const BYTES: usize = 64 << 20;

/// An act.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    label: String,
    before: String,
    after: String,
}

/// Acts that were done, and those that were undone.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    done: Vec<Entry>,
    undone: Vec<Entry>,
}

impl History {
    /// Keeps an act. Those that were undone before are forgotten, and the oldest ones when there are too many.
    pub(super) fn keep(&mut self, label: &str, before: &str, after: &str) {
        self.undone.clear();
        self.done.push(Entry { label: label.to_owned(), before: before.to_owned(), after: after.to_owned() });
        while self.done.len() > MOST || (self.done.len() > 1 && self.bytes() > BYTES) {
            self.done.remove(0);
        }
    }

    fn bytes(&self) -> usize {
        self.done.iter().map(|entry| entry.before.len() + entry.after.len()).sum()
    }

    /// The last act, if the file is as it left it.
    pub(super) fn undoable(&self, text: &str) -> Option<&str> {
        self.done.last().filter(|entry| entry.after == text).map(|entry| entry.label.as_str())
    }

    /// The last act that was undone, if the file is as that left it.
    pub(super) fn redoable(&self, text: &str) -> Option<&str> {
        self.undone.last().filter(|entry| entry.before == text).map(|entry| entry.label.as_str())
    }

    /// The file without its last act, if it is as that left it.
    pub(super) fn before(&self, text: &str) -> Option<String> {
        self.undoable(text)?;
        self.done.last().map(|entry| entry.before.clone())
    }

    /// The file with the act that was undone last, if it is as it was before it.
    pub(super) fn after(&self, text: &str) -> Option<String> {
        self.redoable(text)?;
        self.undone.last().map(|entry| entry.after.clone())
    }

    /// The last act has been undone.
    pub(super) fn went_back(&mut self) {
        self.undone.extend(self.done.pop());
    }

    /// The act that was undone last has been done again.
    pub(super) fn went_on(&mut self) {
        self.done.extend(self.undone.pop());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn acts_are_undone_and_done_again() {
        let mut history = History::default();
        history.keep("one", "a", "b");
        history.keep("two", "b", "c");
        assert_eq!(history.undoable("c"), Some("two"));
        assert_eq!(history.before("c"), Some("b".into()));
        history.went_back();
        assert_eq!((history.undoable("b"), history.redoable("b")), (Some("one"), Some("two")));
        assert_eq!(history.after("b"), Some("c".into()));
        history.went_on();
        assert_eq!(history.redoable("c"), None);
    }

    #[test]
    fn a_file_changed_elsewhere_is_left_alone() {
        let mut history = History::default();
        history.keep("one", "a", "b");
        assert_eq!((history.before("b, and a line of mine"), history.undoable("x")), (None, None));
        history.went_back();
        assert_eq!(history.after("a, changed"), None);
        history.keep("two", "a, changed", "d");
        assert_eq!(history.redoable("d"), None);
    }

    #[test]
    fn the_oldest_acts_are_forgotten() {
        let mut history = History::default();
        let large = "x".repeat(BYTES / 3);
        (0..5).for_each(|_| history.keep("large", &large, "y"));
        assert_eq!(history.done.len(), 2);
        (0..2 * MOST).for_each(|_| history.keep("small", "a", "b"));
        assert!(history.done.len() <= MOST);
    }
}
