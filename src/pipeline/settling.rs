//! Words of `place` that settle a dealing in doubt, as they are shown.

use serde::Serialize;

use crate::sew::start::Settling;

/// A word of `place` that makes one of the two best dealings clear.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WordShown {
    /// The piece that it is for.
    pub piece: String,
    /// The word.
    pub word: String,
    /// `first` or `second`.
    pub dealing: &'static str,
}

/// Names of the two best dealings.
const DEALINGS: [&str; 2] = ["first", "second"];

impl WordShown {
    pub(super) fn new(said: &Settling) -> Self {
        Self { piece: said.piece.clone(), word: said.word.name().into(), dealing: DEALINGS[said.way] }
    }
}

/// Sentences that say which words settle a dealing in doubt.
pub(super) fn settling(words: &[WordShown]) -> Vec<String> {
    let of_dealing = |dealing: &&str| {
        let own = words.iter().filter(|w| w.dealing == *dealing);
        let own: Vec<String> = own.map(|w| format!("'place: {}' for {}", w.word, w.piece)).collect();
        (!own.is_empty()).then(|| format!("the {dealing} is settled by {}", own.join(", or ")))
    };
    if words.is_empty() {
        return vec!["no single word of 'place' settles it: give several pieces a place".into()];
    }
    DEALINGS.iter().filter_map(of_dealing).collect()
}
