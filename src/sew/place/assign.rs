//! Which body part a piece goes round, and which way it faces.

use super::PlaceError;
use crate::mannequin::PartKind;
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::{Garment, Piece, Place, PlaceMeaning, PlaceWord, Side, words_of};

/// Where a piece goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Assigned {
    /// The part it is bent round; trousers go round the torso's ring, which widens to both legs.
    pub(super) part: PartKind,
    /// Whether it is said to be at the front or at the back.
    pub(super) facing: Option<Facing>,
}

/// Front or back of the wearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Facing {
    /// Chest side.
    Front,
    /// Spine side.
    Back,
}

/// Assigns every piece by its `place:` words, else by its name, else by the pieces it is sewn to.
///
/// # Errors
/// [`PlaceError::Words`] when `place:` names no part.
pub(super) fn assign(garment: &Garment, mesh: &ClothMesh) -> Result<Vec<Assigned>, PlaceError> {
    let mut out = Vec::with_capacity(garment.pieces.len());
    for piece in &garment.pieces {
        let name_words = PlaceWord::in_name(&piece.name);
        let side = piece.side.or_else(|| side_of(&name_words));
        let assigned = match &piece.place {
            Some(Place::Around { words }) => {
                // Each of a pair goes to its own side, whichever one was drawn and said.
                let part = part_of(words, piece.side.or_else(|| side_of(words)).or(side))
                    .or_else(|| facing_of(words).map(|_| PartKind::Torso))
                    .ok_or_else(|| PlaceError::Words { piece: piece.name.clone(), words: written(words) })?;
                Assigned { part, facing: facing_of(words).or_else(|| facing_of(&name_words)) }
            }
            _ => {
                Assigned { part: part_of(&name_words, side).unwrap_or(PartKind::Torso), facing: facing_of(&name_words) }
            }
        };
        out.push(assigned);
    }
    sort_out_sides(garment, mesh, &mut out);
    join_legs(mesh, &mut out);
    Ok(out)
}

/// Words in the names of pieces and seams for what goes between the legs: trousers are placed round the hip.
const BETWEEN_LEGS: [&str; 12] = [
    "trousers", "pants", "shorts", "briefs", "knickers", "leggings", "overalls", "bodysuit", "jumpsuit", "crotch",
    "inseam", "gusset",
];

/// Whether cloth of a garment comes to be between the legs, by where its pieces are placed and what they and its seams
/// are called.
pub(in crate::sew) fn goes_between_legs(garment: &Garment) -> bool {
    let leg = |piece: &Piece| match &piece.place {
        Some(Place::Around { words }) => says(words, PlaceMeaning::Leg),
        _ => says(&PlaceWord::in_name(&piece.name), PlaceMeaning::Leg),
    };
    let names = garment.pieces.iter().map(|p| &p.name).chain(garment.seams.iter().map(|s| &s.name));
    let between = |name: &String| words_of(name).iter().any(|word| BETWEEN_LEGS.contains(&word.as_str()));
    garment.pieces.iter().any(leg) || names.into_iter().any(between)
}

/// Whether a piece is said to be one of a skirt, by its place or its name.
pub(super) fn is_skirt(piece: &Piece) -> bool {
    let says = |words: &[PlaceWord]| words.contains(&PlaceWord::Skirt);
    says(&PlaceWord::in_name(&piece.name)) || matches!(&piece.place, Some(Place::Around { words }) if says(words))
}

/// Words for what is worn on the bust, and not from the waist down.
const AT_BUST: [PlaceWord; 3] = [PlaceWord::Bust, PlaceWord::Chest, PlaceWord::Bodice];

/// Whether a piece's place is said to be at the bust.
pub(super) fn is_at_bust(piece: &Piece) -> bool {
    let says = |words: &[PlaceWord]| words.iter().any(|word| AT_BUST.contains(word));
    matches!(&piece.place, Some(Place::Around { words }) if says(words))
}

fn says(words: &[PlaceWord], meaning: PlaceMeaning) -> bool {
    words.iter().any(|word| word.meaning() == meaning)
}

/// The words as a file has them.
fn written(words: &[PlaceWord]) -> String {
    words.iter().map(|word| word.name()).collect::<Vec<&str>>().join(" ")
}

fn part_of(words: &[PlaceWord], side: Option<Side>) -> Option<PartKind> {
    if says(words, PlaceMeaning::Arm) {
        return Some(if side == Some(Side::Right) { PartKind::RightArm } else { PartKind::LeftArm });
    }
    if says(words, PlaceMeaning::Neck) {
        return Some(PartKind::Neck);
    }
    if says(words, PlaceMeaning::Leg) {
        return Some(if side == Some(Side::Right) { PartKind::RightLeg } else { PartKind::LeftLeg });
    }
    says(words, PlaceMeaning::Trunk).then_some(PartKind::Torso)
}

fn side_of(words: &[PlaceWord]) -> Option<Side> {
    if says(words, PlaceMeaning::Left) {
        return Some(Side::Left);
    }
    says(words, PlaceMeaning::Right).then_some(Side::Right)
}

fn facing_of(words: &[PlaceWord]) -> Option<Facing> {
    if says(words, PlaceMeaning::Front) {
        return Some(Facing::Front);
    }
    says(words, PlaceMeaning::Back).then_some(Facing::Back)
}

/// A piece for an arm or a leg whose side nothing says goes where the pieces it is sewn to are.
fn sort_out_sides(garment: &Garment, mesh: &ClothMesh, out: &mut [Assigned]) {
    let middles = middles(mesh);
    // Whether the left one has its piece already, of the arms and of the legs.
    let mut has_left = [false; 2];
    for (i, piece) in garment.pieces.iter().enumerate() {
        let limbs = match out[i].part {
            PartKind::LeftArm | PartKind::RightArm => [PartKind::LeftArm, PartKind::RightArm],
            PartKind::LeftLeg | PartKind::RightLeg => [PartKind::LeftLeg, PartKind::RightLeg],
            _ => continue,
        };
        let said = piece.side.is_some()
            || side_of(&PlaceWord::in_name(&piece.name)).is_some()
            || matches!(&piece.place, Some(Place::Around { words }) if side_of(words).is_some());
        if said {
            continue;
        }
        // The trunk is drawn as seen from outside: on a front the wearer's left is at larger x.
        let lean = lean(mesh, &middles, out, i);
        let has_left = &mut has_left[usize::from(out[i].part.is_leg())];
        let left = if lean == 0.0 { !*has_left } else { lean > 0.0 };
        *has_left |= left;
        out[i].part = limbs[usize::from(!left)];
    }
}

/// Pieces for a leg that are sewn to one another across both legs are trousers: they go round the trunk.
fn join_legs(mesh: &ClothMesh, out: &mut [Assigned]) {
    let is_leg = |a: &Assigned| a.part.is_leg();
    if !out.iter().any(is_leg) {
        return;
    }
    let mut joined: Vec<[usize; 2]> = mesh
        .seams
        .iter()
        .flat_map(|s| &s.pairs)
        .filter_map(|[a, b]| Some([mesh.piece_of(*a)?, mesh.piece_of(*b)?]))
        .filter(|&[i, j]| i != j && is_leg(&out[i]) && is_leg(&out[j]))
        .collect();
    joined.dedup();
    let mut trunk = vec![false; out.len()];
    for [i, j] in &joined {
        if out[*i].part != out[*j].part {
            (trunk[*i], trunk[*j]) = (true, true);
        }
    }
    // Once round for every piece: as far as seams can lead.
    for _ in 0..out.len() {
        for [i, j] in &joined {
            let either = trunk[*i] || trunk[*j];
            (trunk[*i], trunk[*j]) = (either, either);
        }
    }
    out.iter_mut().zip(trunk).filter(|(_, t)| *t).for_each(|(a, _)| a.part = PartKind::Torso);
}

/// Mean x of every piece as drawn, metres.
fn middles(mesh: &ClothMesh) -> Vec<f64> {
    let middle = |piece: &PieceMesh| {
        let count = piece.particles.len().max(1) as f64;
        piece.particles.clone().map(|p| mesh.flat[p].x).sum::<f64>() / count
    };
    mesh.pieces.iter().map(middle).collect()
}

/// Positive when piece `i` is sewn to the wearer's left of trunk pieces, whose middles are at `middles`.
fn lean(mesh: &ClothMesh, middles: &[f64], assigned: &[Assigned], i: usize) -> f64 {
    let mut sum = 0.0;
    for [a, b] in mesh.seams.iter().flat_map(|s| &s.pairs) {
        for (p, q) in [(*a, *b), (*b, *a)] {
            if mesh.piece_of(p) != Some(i) {
                continue;
            }
            let of_trunk = |&other: &usize| other != i && assigned[other].part == PartKind::Torso;
            let Some(other) = mesh.piece_of(q).filter(of_trunk) else { continue };
            let x = mesh.flat[q as usize].x - middles[other];
            sum += if assigned[other].facing == Some(Facing::Back) { -x } else { x };
        }
    }
    sum
}
