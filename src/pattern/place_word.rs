//! The words of `place:`, in one table, and those of piece names that say the same.

use super::diagnostic::Findings;
use super::file::{GarmentFile, PieceFile, PlaceFile};
use super::outfit::own_name;
use super::problem::Problem;
use super::value::Unit;
use crate::input::nearest;

/// A word of `place:`. Other spellings of it are read as the same word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceWord {
    /// Round the trunk, up to the shoulders.
    Torso,
    /// Round the hips and below.
    Hip,
    /// Round the waist.
    Waist,
    /// From the waist or the hips down, both legs inside.
    Skirt,
    /// Round the trunk above the waist.
    Bodice,
    /// Round the chest.
    Chest,
    /// Round the bust.
    Bust,
    /// Round the trunk, at any height.
    Trunk,
    /// Round a leg.
    Leg,
    /// Round a thigh.
    Thigh,
    /// Round a knee.
    Knee,
    /// Round an ankle.
    Ankle,
    /// Round an arm.
    Arm,
    /// Round an arm, as a sleeve.
    Sleeve,
    /// Round an elbow.
    Elbow,
    /// Round a wrist.
    Wrist,
    /// Round a wrist, as a cuff.
    Cuff,
    /// Round the neck.
    Neck,
    /// Round the neck, as a collar.
    Collar,
    /// Round the neck and over the head.
    Hood,
    /// On the wearer's left.
    Left,
    /// On the wearer's right.
    Right,
    /// In front.
    Front,
    /// Behind.
    Back,
}

/// Meaning of a word of `place`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceMeaning {
    /// Round the trunk or the legs below it.
    Trunk,
    /// Round one leg. If it is sewn to a piece for the other leg (trousers), round the trunk.
    Leg,
    /// Round an arm.
    Arm,
    /// Round the neck.
    Neck,
    /// The wearer's left.
    Left,
    /// The wearer's right.
    Right,
    /// Chest side.
    Front,
    /// Spine side.
    Back,
}

/// Height on the trunk that a word names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrunkLevel {
    /// Round the waist.
    Waist,
    /// From the waist or the hips down.
    Hip,
    /// Up to the chest or the shoulders.
    Chest,
}

/// A word with its name in files and messages, its meaning, its height on the trunk, and its other spellings.
type Row = (PlaceWord, &'static str, PlaceMeaning, Option<TrunkLevel>, &'static [&'static str]);

/// Every word. Spellings of one or two letters, and compounds, are the names that other programs give their pieces.
const WORDS: [Row; 24] = {
    use PlaceMeaning as Means;
    use PlaceWord as Word;
    use TrunkLevel as Level;
    [
        (Word::Torso, "torso", Means::Trunk, Some(Level::Chest), &[]),
        (Word::Hip, "hip", Means::Trunk, Some(Level::Hip), &[]),
        (Word::Waist, "waist", Means::Trunk, Some(Level::Waist), &[]),
        (Word::Skirt, "skirt", Means::Trunk, Some(Level::Hip), &[]),
        (Word::Bodice, "bodice", Means::Trunk, Some(Level::Chest), &[]),
        (Word::Chest, "chest", Means::Trunk, Some(Level::Chest), &[]),
        (Word::Bust, "bust", Means::Trunk, Some(Level::Chest), &[]),
        (Word::Trunk, "trunk", Means::Trunk, None, &["body"]),
        (Word::Leg, "leg", Means::Leg, None, &[]),
        (Word::Thigh, "thigh", Means::Leg, None, &[]),
        (Word::Knee, "knee", Means::Leg, None, &[]),
        (Word::Ankle, "ankle", Means::Leg, None, &[]),
        (Word::Arm, "arm", Means::Arm, None, &["biceps", "armband", "forearm"]),
        (Word::Sleeve, "sleeve", Means::Arm, None, &[]),
        (Word::Elbow, "elbow", Means::Arm, None, &[]),
        (Word::Wrist, "wrist", Means::Arm, None, &[]),
        (Word::Cuff, "cuff", Means::Arm, None, &[]),
        (Word::Neck, "neck", Means::Neck, None, &["neckband", "necktie", "choker"]),
        (Word::Collar, "collar", Means::Neck, None, &["stand"]),
        (Word::Hood, "hood", Means::Neck, None, &[]),
        (Word::Left, "left", Means::Left, None, &["l"]),
        (Word::Right, "right", Means::Right, None, &["r"]),
        (Word::Front, "front", Means::Front, None, &["f", "ftorso"]),
        (Word::Back, "back", Means::Back, None, &["b", "btorso"]),
    ]
};

impl PlaceWord {
    /// The word that is spelled so, in lower case, also in the plural.
    pub fn parse(text: &str) -> Option<Self> {
        let is = |text: &str| WORDS.iter().find(|row| row.1 == text || row.4.contains(&text)).map(|row| row.0);
        is(text).or_else(|| text.strip_suffix('s').and_then(is))
    }

    /// The words among those of a name, in its order: `sleeve_left.L` → sleeve, left, left.
    pub fn in_name(name: &str) -> Vec<Self> {
        words_of(name).iter().filter_map(|word| Self::parse(word)).collect()
    }

    /// All words, in the order of messages.
    pub fn all() -> impl Iterator<Item = Self> {
        WORDS.iter().map(|row| row.0)
    }

    /// As files and messages have it.
    pub fn name(self) -> &'static str {
        self.row().1
    }

    /// Its meaning.
    pub fn meaning(self) -> PlaceMeaning {
        self.row().2
    }

    /// Its height on the trunk, if it names one.
    pub fn level(self) -> Option<TrunkLevel> {
        self.row().3
    }

    fn row(self) -> &'static Row {
        // The table has the words in the order of the type. A test says so.
        &WORDS[self as usize]
    }
}

/// All words for people, `torso, hip, …; leg, …; with left or right, front or back`, each written as `show` has it.
pub fn place_words(show: impl Fn(&str) -> String) -> String {
    let of = |meaning: PlaceMeaning| {
        let words = PlaceWord::all().filter(move |word| word.meaning() == meaning);
        words.map(|word| show(word.name())).collect::<Vec<String>>().join(", ")
    };
    let parts = [PlaceMeaning::Trunk, PlaceMeaning::Leg, PlaceMeaning::Arm, PlaceMeaning::Neck].map(of);
    let [left, right, front, back] =
        [PlaceMeaning::Left, PlaceMeaning::Right, PlaceMeaning::Front, PlaceMeaning::Back].map(of);
    format!("{}; with {left} or {right}, {front} or {back}", parts.join("; "))
}

/// The words of a name in lower case: `sleeve_left.L` → sleeve, left, l. For a piece of an outfit, the words of its own
/// name.
pub fn words_of(name: &str) -> Vec<String> {
    own_name(name).split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).map(str::to_lowercase).collect()
}

/// Largest distance of a piece's start from the feet, metres. A larger one is in another unit.
const FARTHEST: f64 = 10.0;

/// Checks the words and positions of every `place:` of the file.
pub(super) fn check(file: &GarmentFile, findings: &mut Findings) {
    for piece in &file.pieces {
        if let Some(problem) = problem(piece, file.unit()) {
            findings.error(piece.place.as_ref().map_or(piece.name.at, |p| p.at), problem);
        }
    }
}

fn problem(piece: &PieceFile, unit: Unit) -> Option<Problem> {
    match &piece.place.as_ref()?.value {
        PlaceFile::Words(words) => wrong_words(piece, words),
        PlaceFile::At { at, .. } => {
            let far = at.iter().any(|x| (x * unit.factor()).abs() > FARTHEST);
            let at = format!("[{}]", at.map(|x| x.to_string()).join(", "));
            far.then(|| Problem::PlaceFar { piece: piece.name.value.clone(), at, most: FARTHEST })
        }
    }
}

fn wrong_words(piece: &PieceFile, words: &str) -> Option<Problem> {
    let name = piece.name.value.clone();
    let known = || place_words(str::to_owned);
    let mut said = Vec::new();
    for word in words.to_lowercase().split_whitespace() {
        match PlaceWord::parse(word) {
            Some(word) => said.push(word.meaning()),
            None => {
                let all = WORDS.iter().flat_map(|row| row.4.iter().copied().chain([row.1])).filter(|w| w.len() > 1);
                let nearest = nearest(word, all).map(str::to_owned);
                return Some(Problem::PlaceWord { piece: name, word: word.to_owned(), nearest, known: known().into() });
            }
        }
    }
    let place = words.to_owned();
    let says = |meaning: PlaceMeaning| said.contains(&meaning);
    let both = [(PlaceMeaning::Left, PlaceMeaning::Right), (PlaceMeaning::Front, PlaceMeaning::Back)];
    if both.iter().any(|&(one, other)| says(one) && says(other)) {
        return Some(Problem::PlaceBoth { piece: name, place });
    }
    let placed = said.iter().any(|meaning| !matches!(meaning, PlaceMeaning::Left | PlaceMeaning::Right));
    (!placed).then(|| Problem::PlaceNowhere { piece: name, place, known: known().into() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_in_every_spelling_and_in_the_plural() {
        assert_eq!(PlaceWord::parse("hips"), Some(PlaceWord::Hip));
        assert_eq!(PlaceWord::parse("sleeves"), Some(PlaceWord::Sleeve));
        assert_eq!(PlaceWord::parse("body"), Some(PlaceWord::Trunk));
        assert_eq!(PlaceWord::parse("forearm"), Some(PlaceWord::Arm));
        assert_eq!(PlaceWord::parse("hop"), None);
        assert_eq!(PlaceWord::parse("s"), None);
        assert_eq!(PlaceWord::in_name("upper_Sleeve.L"), [PlaceWord::Sleeve, PlaceWord::Left]);
    }

    #[test]
    fn the_table_has_every_word_once_under_its_own_name() {
        for (k, row) in WORDS.iter().enumerate() {
            assert_eq!(row.0 as usize, k, "{}", row.1);
            for spelling in row.4.iter().chain([&row.1]) {
                assert_eq!(PlaceWord::parse(spelling), Some(row.0), "{spelling}");
            }
        }
    }
}
