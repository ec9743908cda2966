//! The words of `place:`, and those of piece names that say the same.

use super::diagnostic::Findings;
use super::file::{GarmentFile, PieceFile, PlaceFile, Unit};
use super::problem::Problem;
use crate::input::nearest;

/// What a word says about where a piece goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceWord {
    /// Round an arm.
    Arm,
    /// Round the neck.
    Neck,
    /// Round the trunk or the legs below it.
    Trunk,
    /// Round one leg; for what is sewn to the other leg too (trousers), round the trunk.
    Leg,
    /// The wearer's left.
    Left,
    /// The wearer's right.
    Right,
    /// Chest side.
    Front,
    /// Spine side.
    Back,
}

/// Every word that means something. Those of one or two letters, and those run together, are how other programs name
/// their pieces.
const WORDS: [(PlaceWord, &[&str]); 8] = [
    (PlaceWord::Trunk, &["torso", "hip", "hips", "waist", "skirt", "bodice", "chest", "bust", "body", "trunk"]),
    (PlaceWord::Leg, &["leg", "thigh", "knee", "ankle"]),
    (PlaceWord::Arm, &["arm", "sleeve", "wrist", "cuff", "biceps", "elbow", "armband", "forearm"]),
    (PlaceWord::Neck, &["neck", "collar", "neckband", "hood", "stand", "necktie", "choker"]),
    (PlaceWord::Left, &["left", "l"]),
    (PlaceWord::Right, &["right", "r"]),
    (PlaceWord::Front, &["front", "f", "ftorso"]),
    (PlaceWord::Back, &["back", "b", "btorso"]),
];

/// How high on the trunk a word says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrunkLevel {
    /// Round the waist.
    Waist,
    /// From the waist or the hips down.
    Hip,
    /// Up to the chest or the shoulders.
    Chest,
}

/// Words of [`PlaceWord::Trunk`] that say how high.
const LEVELS: [(TrunkLevel, &[&str]); 3] = [
    (TrunkLevel::Waist, &["waist"]),
    (TrunkLevel::Hip, &["hip", "hips", "skirt"]),
    (TrunkLevel::Chest, &["torso", "bodice", "chest", "bust"]),
];

/// How high on the trunk a lower-case word says, if it does.
pub fn trunk_level(word: &str) -> Option<TrunkLevel> {
    LEVELS.iter().find(|(_, list)| list.contains(&word)).map(|(level, _)| *level)
}

/// What is said to those who look for a word.
const KNOWN: &str = "torso, hip, waist, skirt, bodice, chest, bust; leg, knee or ankle; arm, sleeve, elbow, wrist or \
                     cuff; neck, collar or hood; with left or right, front or back";

/// The words of a name in lower case: `sleeve_left.L` → sleeve, left, l.
pub fn words_of(name: &str) -> Vec<String> {
    name.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).map(str::to_lowercase).collect()
}

/// What a lower-case word says, also in the plural.
pub fn place_word(word: &str) -> Option<PlaceWord> {
    let means = |word: &str| WORDS.iter().find(|(_, list)| list.contains(&word)).map(|(meaning, _)| *meaning);
    means(word).or_else(|| word.strip_suffix('s').and_then(means))
}

/// A piece that starts farther from the feet than this, metres, is in another unit than thought.
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
    let mut said = Vec::new();
    for word in words.to_lowercase().split_whitespace() {
        match place_word(word) {
            Some(meaning) => said.push(meaning),
            None => {
                let all = WORDS.iter().flat_map(|(_, list)| list.iter().copied()).filter(|w| w.len() > 1);
                let nearest = nearest(word, all).map(str::to_owned);
                return Some(Problem::PlaceWord { piece: name, word: word.to_owned(), nearest, known: KNOWN });
            }
        }
    }
    let place = words.to_owned();
    let says = |word: PlaceWord| said.contains(&word);
    let both = [(PlaceWord::Left, PlaceWord::Right), (PlaceWord::Front, PlaceWord::Back)];
    if both.iter().any(|&(one, other)| says(one) && says(other)) {
        return Some(Problem::PlaceBoth { piece: name, place });
    }
    let placed = said.iter().any(|word| !matches!(word, PlaceWord::Left | PlaceWord::Right));
    (!placed).then_some(Problem::PlaceNowhere { piece: name, place, known: KNOWN })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_mean_parts_sides_and_facings_also_in_the_plural() {
        assert_eq!(place_word("hips"), Some(PlaceWord::Trunk));
        assert_eq!(place_word("sleeves"), Some(PlaceWord::Arm));
        assert_eq!(place_word("collar"), Some(PlaceWord::Neck));
        assert_eq!(place_word("hop"), None);
        assert_eq!(place_word("s"), None);
    }
}
