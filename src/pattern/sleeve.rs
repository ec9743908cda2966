//! Sleeves drawn for the other arm. Right side out, front to front and back to back, such a one goes into its armhole
//! upside down only: its cap under the arm.

use super::diagnostic::{Findings, Spot};
use super::draft::Draft;
use super::file::{Cut, Side};
use super::place_word::{PlaceWord, meanings};
use super::problem::Problem;
use super::{Garment, Piece, Place, Seam, SeamKind, Span};
use crate::geometry::{Vec2, box_of, range_of};

/// Places of a seam that are looked at.
const LOOKS: usize = 48;
/// A cap that is lower than this, metres, may be set in either way up,
const CAP: f64 = 0.015;
/// and so may what is sewn to a lower stretch than this.
const ARMHOLE: f64 = 0.05;
/// The top and the bottom of an armhole are this share of its height.
const END: f64 = 0.25;
/// Chords that stand for an outline.
const COARSE: f64 = 1e-3;

/// A place of a sleeve's seam.
struct Stitch {
    seam: usize,
    /// The piece that the sleeve is sewn to there.
    on: usize,
    /// The place on the sleeve and on that piece.
    at: [Vec2; 2],
}

/// Warns of sleeves that are set in upside down; `spots` are where the seams stand.
pub(super) fn check(garment: &Garment, drafts: &[Draft], spots: &[Spot], findings: &mut Findings) {
    let mut told: Vec<[&str; 2]> = Vec::new();
    for (number, piece) in garment.pieces.iter().enumerate().filter(|(_, piece)| is_sleeve(piece)) {
        let stitches: Vec<Stitch> = (0..spots.len()).flat_map(|seam| stitches(garment, seam, number)).collect();
        let Some(up) = up(piece, &stitches) else { continue };
        for on in 0..garment.pieces.len() {
            let own: Vec<&Stitch> = stitches.iter().filter(|stitch| stitch.on == on).collect();
            let pair = [piece, &garment.pieces[on]].map(|piece| piece.drawn_as.as_str());
            if is_upside_down(&own, up) && !told.contains(&pair) {
                told.push(pair);
                let [sleeve, on] = pair.map(str::to_owned);
                let drawn = drafts.iter().find(|d| d.name == sleeve && d.cut == Cut::Pair).map(|d| d.drawn);
                let (seam, other) = (garment.seams[own[0].seam].name.clone(), drawn.map(Side::other));
                findings.warn(spots[own[0].seam], Problem::UpsideDown { seam, sleeve, on, other });
            }
        }
    }
}

fn is_sleeve(piece: &Piece) -> bool {
    meanings(piece).contains(&PlaceWord::Arm)
}

/// Whether a piece hangs as it is drawn, upright, and is none of an arm.
fn is_of_trunk(piece: &Piece) -> bool {
    !is_sleeve(piece) && !matches!(piece.place, Some(Place::At { .. }))
}

/// Places of one of the garment's seams at which a sleeve is sewn to the trunk, one of them beside the other.
fn stitches(garment: &Garment, number: usize, sleeve: usize) -> Vec<Stitch> {
    let seam = &garment.seams[number];
    if seam.kind != SeamKind::Written || seam.is_lapped(&garment.pieces) {
        return Vec::new();
    }
    let look = |k: usize| {
        let sides = across(seam, (k as f64 + 0.5) / LOOKS as f64)?;
        let [a, b] = sides.map(|(span, at)| {
            let edge = span.edge;
            (edge.piece, garment.pieces[edge.piece].loops[edge.ring][edge.index].path.point(at))
        });
        let (own, other) = if a.0 == sleeve { (a, b) } else { (b, a) };
        let found = own.0 == sleeve && other.0 != sleeve && is_of_trunk(&garment.pieces[other.0]);
        found.then_some(Stitch { seam: number, on: other.0, at: [own.1, other.1] })
    };
    (0..LOOKS).filter_map(look).collect()
}

/// What lies on each other at this share of the first chain: spans and arc lengths on their edges.
fn across(seam: &Seam, share: f64) -> Option<[(&Span, f64); 2]> {
    let on_a = share * seam.length_a();
    let pair = seam.marks.windows(2).find(|w| on_a <= w[1].0)?;
    let [(a, b), (next_a, next_b)] = [pair[0], pair[1]];
    let on_b = b + (on_a - a) / (next_a - a) * (next_b - b);
    Some([at_length(&seam.a, on_a)?, at_length(&seam.b, on_b)?])
}

fn at_length(chain: &[Span], mut along: f64) -> Option<(&Span, f64)> {
    for span in chain {
        if along <= span.length() {
            return Some((span, span.from + along * (span.to - span.from).signum()));
        }
        along -= span.length();
    }
    None
}

/// The direction in the drawing of a sleeve from its middle to where it is sewn in.
fn up(sleeve: &Piece, stitches: &[Stitch]) -> Option<Vec2> {
    let [low, high] = box_of(sleeve.loops.first()?.iter().flat_map(|edge| edge.path.sampled(COARSE)));
    let sewn = stitches.iter().map(|stitch| stitch.at[0]).sum::<Vec2>() / stitches.len().max(1) as f64;
    (sewn - (low + high) / 2.0).try_normalize(COARSE)
}

/// Whether these stitches of a sleeve to one piece lead down the armhole where they lead up the cap, all the way.
fn is_upside_down(stitches: &[&Stitch], up: Vec2) -> bool {
    let cap = |stitch: &Stitch| up.dot(&stitch.at[0]);
    let armhole = |stitch: &Stitch| -stitch.at[1].y;
    let by_cap = |a: &&&Stitch, b: &&&Stitch| cap(a).total_cmp(&cap(b));
    let (Some(lowest), Some(highest)) = (stitches.iter().min_by(by_cap), stitches.iter().max_by(by_cap)) else {
        return false;
    };
    let [low, high] = range_of(stitches.iter().map(|stitch| armhole(stitch)));
    let end = END * (high - low);
    cap(highest) - cap(lowest) >= CAP
        && high - low >= ARMHOLE
        && armhole(highest) <= low + end
        && armhole(lowest) >= high - end
}
