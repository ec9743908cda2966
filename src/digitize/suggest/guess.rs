//! Guesses a person would make of a piece from what it is sewn to: what it goes round, and which side of the wearer is
//! drawn.

use super::Outline;
use super::chains::ChainMatch;
use super::corner::is_fold;
use super::matches::Match;
use super::run::EdgeRun;
use crate::geometry::{Vec2, box_or_origin};
use crate::pattern::{PlaceMeaning, PlaceWord, Side};

/// A sleeve's cap bulges by more than this share of its chord.
const CAP: f64 = -0.05;

/// Guesses about a piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::digitize) struct Guess {
    /// Words of `place`.
    pub(in crate::digitize) place: Option<String>,
    /// Which of a pair, or which half, is drawn.
    pub(in crate::digitize) drawn: Option<Side>,
}

/// Which side of the wearer a piece is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GuessedSide {
    Front,
    Back,
}

/// A guess for each piece, from the armholes that caps are sewn to and the crotches.
pub(super) fn guesses(
    outlines: &[Outline],
    runs: &[EdgeRun],
    chained: &[ChainMatch],
    mirrored: &[(EdgeRun, f64, String)],
    matches: &[Match],
    up: Vec2,
) -> Vec<Guess> {
    let mut guesses = vec![Guess::default(); outlines.len()];
    let mut facing: Vec<Option<GuessedSide>> = outlines.iter().map(|outline| by_name(&outline.piece)).collect();
    let caps: Vec<&ChainMatch> = chained.iter().filter(|chain| is_cap(outlines, runs, chain)).collect();
    let right = right(runs, &caps, up);
    for chain in &caps {
        // A double notch marks the back.
        for &(run, _) in &chain.a.runs {
            let own = &runs[run];
            let doubles = own.marks.iter().filter(|mark| mark.double).count();
            if facing[own.piece].is_none() && !own.marks.is_empty() {
                facing[own.piece] = Some(if doubles > 0 { GuessedSide::Back } else { GuessedSide::Front });
            }
        }
        for &(run, _) in &chain.a.runs {
            place(&mut guesses, runs[run].piece, "torso", &facing);
        }
        if let [(cap, forward)] = chain.b.runs[..] {
            let sleeve = &runs[cap];
            guesses[sleeve.piece].place = Some(PlaceWord::Arm.name().to_owned());
            let back_first =
                chain.a.runs.first().map(|&(run, _)| facing[runs[run].piece]) == Some(Some(GuessedSide::Back));
            let both =
                chain.a.runs.iter().map(|&(run, _)| facing[runs[run].piece]).collect::<Option<Vec<GuessedSide>>>();
            if both.is_some_and(|both| both.contains(&GuessedSide::Back) && both.contains(&GuessedSide::Front)) {
                // Seen from outside the back of the right arm lies left of its front.
                let [start, end] = [sleeve.path.start(), sleeve.path.end()].map(|p| p.dot(&right));
                let back_is_left = (back_first == forward) == (start < end);
                guesses[sleeve.piece].drawn = Some(if back_is_left { Side::Right } else { Side::Left });
            }
        }
    }
    for (run, _, reason) in mirrored.iter().filter(|(run, ..)| outlines[run.piece].pair) {
        if reason == super::middles::CROTCH_SAID {
            place(&mut guesses, run.piece, "leg", &facing);
        }
    }
    for (piece, guess) in guesses.iter_mut().enumerate().filter(|(_, guess)| guess.drawn.is_none()) {
        let middle = middle(&outlines[piece], mirrored.iter().map(|(run, ..)| run).filter(|run| run.piece == piece));
        if let (Some(facing), Some(middle)) = (facing[piece], middle) {
            let [low, high] = box_or_origin(outlines[piece].edges.iter().flat_map(|e| e.path.sampled(1e-3)));
            // Seen from outside the wearer's left is right of the middle in front, and left of it behind.
            let lies_right = (middle - (low + high) / 2.0).dot(&right) < 0.0;
            guess.drawn = Some(if lies_right == (facing == GuessedSide::Front) { Side::Left } else { Side::Right });
        }
    }
    spread(outlines, runs, chained, matches, &mut guesses);
    guesses
}

/// Tells which of a left and a right is drawn from the pieces that a piece is sewn to. Where both are walked against
/// each other the drawn ones belong to each other, else one of them and the mirror image of the other. Of pieces of
/// which nothing is told the first is a left one.
fn spread(outlines: &[Outline], runs: &[EdgeRun], chained: &[ChainMatch], matches: &[Match], guesses: &mut [Guess]) {
    let mut same: Vec<([usize; 2], bool)> = matches.iter().map(|m| ([m.a.piece, m.b.piece], m.opposed)).collect();
    for chain in chained {
        let pair = |a: &(usize, bool), b: &(usize, bool)| ([runs[a.0].piece, runs[b.0].piece], a.1 != b.1);
        same.extend(chain.a.runs.iter().flat_map(|a| chain.b.runs.iter().map(move |b| pair(a, b))));
    }
    same.retain(|([a, b], _)| a != b && outlines[*a].mirrored && outlines[*b].mirrored);
    let seeds: Vec<usize> = (0..guesses.len()).filter(|&k| guesses[k].drawn.is_some()).collect();
    for seed in seeds.into_iter().chain((0..outlines.len()).filter(|&k| outlines[k].mirrored)) {
        let mut open = vec![(seed, guesses[seed].drawn.unwrap_or(Side::Left))];
        while let Some((piece, side)) = open.pop() {
            guesses[piece].drawn = Some(side);
            for ([a, b], alike) in &same {
                let next = if *a == piece { *b } else { *a };
                if (*a == piece || *b == piece) && guesses[next].drawn.is_none() {
                    let side = if *alike { side } else { side.other() };
                    guesses[next].drawn = Some(side);
                    open.push((next, side));
                }
            }
        }
    }
}

/// To the right in the drawing, as its pieces stand upright: the cap of a sleeve is its upper end.
fn right(runs: &[EdgeRun], caps: &[&ChainMatch], up: Vec2) -> Vec2 {
    let bulge = |cap: &&ChainMatch| {
        let path = &runs[cap.b.runs.first()?.0].path;
        Some((path.point(path.length() / 2.0) - (path.start() + path.end()) / 2.0).dot(&up))
    };
    let up = if caps.first().and_then(bulge).is_some_and(|bulge| bulge < 0.0) { -up } else { up };
    Vec2::new(-up.y, up.x)
}

/// The meaning of a piece's name.
fn by_name(name: &str) -> Option<GuessedSide> {
    let said: Vec<PlaceMeaning> = PlaceWord::in_name(name).into_iter().map(PlaceWord::meaning).collect();
    match (said.contains(&PlaceMeaning::Front), said.contains(&PlaceMeaning::Back)) {
        (true, false) => Some(GuessedSide::Front),
        (false, true) => Some(GuessedSide::Back),
        _ => None,
    }
}

fn place(guesses: &mut [Guess], piece: usize, part: &str, facing: &[Option<GuessedSide>]) {
    let side = facing[piece].map(|facing| match facing {
        GuessedSide::Front => PlaceWord::Front.name(),
        GuessedSide::Back => PlaceWord::Back.name(),
    });
    guesses[piece].place = Some(side.map_or_else(|| part.to_owned(), |side| format!("{part} {side}")));
}

/// Whether a chain is an armhole with the cap of a sleeve that is cut as a pair.
fn is_cap(outlines: &[Outline], runs: &[EdgeRun], chain: &ChainMatch) -> bool {
    matches!(chain.b.runs[..], [(run, _)] if runs[run].hollow() < CAP && outlines[runs[run].piece].pair)
        && chain.a.runs.iter().all(|(run, _)| runs[*run].hollow() > 0.0)
}

/// A point of a half's middle: of its fold, or of the seam between the halves.
fn middle<'a>(outline: &Outline, centers: impl Iterator<Item = &'a EdgeRun>) -> Option<Vec2> {
    let folded = (0..outline.edges.len()).find(|&k| is_fold(outline, k)).map(|k| &outline.edges[k].path);
    let half = |path: &crate::geometry::Path| path.point(path.length() / 2.0);
    folded.map(half).or_else(|| centers.map(|run| half(&run.path)).next())
}
