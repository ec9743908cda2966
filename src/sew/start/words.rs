//! The words of `place` that settle a dealing that is in doubt.

use std::collections::BTreeSet;

use super::Dealt;
use super::deal::{CLEAR, Dealing, guess};
use super::ends::Ends;
use super::marks;
use crate::mannequin::Mannequin;
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, Place, PlaceMeaning, PlaceWord};

/// A word of `place` that makes a dealing clear.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settling {
    /// The piece that it is for.
    pub piece: String,
    /// The word.
    pub word: PlaceWord,
    /// The dealing that it makes clear: 0 for the better one, 1 for the next.
    pub way: usize,
}

/// The words that make one of the two best dealings clear, each tried on the pieces of the openings that differ; for
/// each dealing and word the piece that has most of those rims.
pub(super) fn settling(garment: &Garment, mesh: &ClothMesh, dealt: &Dealt, body: &Mannequin) -> Vec<Settling> {
    let Dealing { ends: best, runner_up: Some(next), .. } = &dealt.dealing else { return Vec::new() };
    let ways = [best, next];
    let mut out: Vec<Settling> = Vec::new();
    for piece in pieces(garment, mesh, dealt, ways) {
        for word in words() {
            let mut said = garment.clone();
            said.pieces[piece].place = Some(Place::Around { words: vec![word] });
            let found = guess(&said, mesh, &dealt.glued, &dealt.openings, body);
            let way = ways.iter().position(|way| is_same(way, &found.ends)).filter(|_| found.margin >= CLEAR);
            let Some(way) = way else { continue };
            if !out.iter().any(|s| s.word == word && s.way == way) {
                out.push(Settling { piece: garment.pieces[piece].drawn_as.clone(), word, way });
            }
        }
    }
    out
}

/// The pieces at the openings that the two ways differ in, those with most of their rims first; of the copies of a
/// drawn piece the first.
fn pieces(garment: &Garment, mesh: &ClothMesh, dealt: &Dealt, [best, next]: [&Vec<Ends>; 2]) -> Vec<usize> {
    let stretches = marks::stretches(garment, mesh, &dealt.glued, &dealt.openings);
    let differ = (0..best.len()).filter(|&i| best[i] != next[i]);
    let mut out: Vec<usize> = Vec::new();
    for stretch in differ.flat_map(|i| &stretches[i]) {
        if !out.contains(&stretch.piece) {
            out.push(stretch.piece);
        }
    }
    out
}

/// One word for everything that a word can say of the part of the body.
fn words() -> Vec<PlaceWord> {
    let mut told = BTreeSet::new();
    let of_part = |word: &PlaceWord| {
        use PlaceMeaning::{Arm, Leg, Neck, Trunk};
        matches!(word.meaning(), Trunk | Leg | Arm | Neck)
    };
    let says = |word: &PlaceWord| (word.meaning() as u8, marks::is_low(*word));
    PlaceWord::all().filter(of_part).filter(|word| told.insert(says(word))).collect()
}

/// Whether two dealings are one, or one another's mirror images.
fn is_same(one: &[Ends], other: &[Ends]) -> bool {
    one == other || one.iter().zip(other).all(|(a, b)| a.mirrored() == *b)
}
