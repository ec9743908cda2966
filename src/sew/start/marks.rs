//! Evidence of where an opening goes: the pieces on its rim, their words, sides and mirror images.

use std::collections::{BTreeMap, BTreeSet};

use super::glue::Glued;
use super::openings::GluedOpening;
use crate::geometry::{Vec2, box_of};
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, Piece, Place, PlaceMeaning, PlaceWord, Side, TrunkLevel};

/// Two outlines are mirror images when every point of one is this near to a point of the other, in grid spacings.
const SAME_SHAPE: f64 = 1.0;
/// Two lengths or places are one when they differ by no more than this share of the larger, and this many spacings.
const SAME_LENGTH: f64 = 0.03;
const SAME_PLACE: f64 = 1.5;

/// The evidence of a band's drawing counts less by this share.
const BAND_SAYS: f64 = 0.3;
/// A piece narrower than this, metres, is a band.
const BAND: f64 = 0.12;
/// The rim of a slit has fewer sides than this on another piece: the edge that its end is sewn to.
const CORNER_OF_A_SLIT: usize = 4;
/// Particles that follow each other on the rim of a slit are this near to each other in the drawing, in grid spacings.
const SLIT_STEP: f64 = 2.5;

/// A point so near to its piece's fold is on neither side, metres.
const ON_FOLD: f64 = 1e-6;

/// A stretch of an opening's rim on one piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct RimStretch {
    pub(super) piece: usize,
    /// Number of particles.
    pub(super) count: usize,
    /// Their middle, from the middle of the piece's box, metres, y down.
    middle: Vec2,
    /// That height as a share: −1 at the top of the drawing, 1 at its bottom.
    height: f64,
    /// Whether the piece is a band, which may be drawn any way up.
    is_band: bool,
    /// Which side it is on: 1 left, −1 right, 0 both or unknown.
    side: f64,
}

/// Pieces that share this many nodes of the surface are sewn to each other; fewer may be a corner.
const SEWN: usize = 3;

/// The pieces of a garment and which of them mirror each other.
pub(super) struct Mirror {
    /// For every piece those that are its mirror image, perhaps itself.
    mates: Vec<Vec<usize>>,
    /// For every piece whether it is a half of a pair.
    is_of_pair: Vec<bool>,
    /// For every piece those that it is sewn to.
    sewn: Vec<Vec<usize>>,
    /// Number of particles of every piece, in proportion to its area.
    sizes: Vec<usize>,
}

impl Mirror {
    /// By shape; halves of a pair have one another. Words of `place` rule out pieces of one side, and a front and a
    /// back.
    pub(super) fn new(garment: &Garment, mesh: &ClothMesh, glued: &Glued) -> Self {
        let rims: Vec<Vec<Vec2>> = (0..mesh.pieces.len()).map(|piece| rim(mesh, piece)).collect();
        let mates = (0..rims.len()).map(|piece| {
            let own = &garment.pieces[piece];
            if let Some(twin) = (0..rims.len()).find(|&other| garment.pieces[other].is_twin(own)) {
                return vec![twin];
            }
            let may_be = |&other: &usize| {
                let facing = [piece, other].map(|p| facing(garment, p));
                side_of(garment, piece) * side_of(garment, other) <= 0.0 && facing[0] * facing[1] >= 0.0
            };
            let alike = |&other: &usize| is_mirrored(&rims[piece], &rims[other], SAME_SHAPE * mesh.spacing);
            (0..rims.len()).filter(may_be).filter(alike).collect()
        });
        let has_twin = |own: &Piece| garment.pieces.iter().any(|other| other.is_twin(own));
        Self {
            mates: mates.collect(),
            is_of_pair: garment.pieces.iter().map(has_twin).collect(),
            sewn: sewn_to(mesh, glued),
            sizes: mesh.pieces.iter().map(|piece| piece.particles.len()).collect(),
        }
    }

    /// The share of the cloth that an opening is sewn to, directly or through other pieces, which is the same on both
    /// sides of the opening's own plane of symmetry: 1 for the neck of a symmetric T-shirt, little for a round cuff on
    /// a sleeve of which there is only one. Two pieces of mirrored shapes that are no pair do not count: they may be a
    /// front and a back that are alike.
    pub(super) fn symmetric_share(&self, opening: &[RimStretch]) -> f64 {
        let pieces = || opening.iter().map(|stretch| stretch.piece);
        let is_mate = |[one, other]: [usize; 2]| self.mates[one].contains(&other);
        let pairs = pieces().flat_map(|a| pieces().map(move |b| [a, b])).filter(|pair| is_mate(*pair)).collect();
        let mapped = self.reached(pairs, is_mate);
        let all = self.reached(pieces().map(|piece| [piece; 2]).collect(), |[one, other]| one == other);
        let size = |pieces: BTreeSet<usize>| pieces.into_iter().map(|piece| self.sizes[piece]).sum::<usize>() as f64;
        let is_sure = |piece: &usize| self.mates[*piece].contains(piece) || self.is_of_pair[*piece];
        size(mapped.into_iter().filter(is_sure).collect()) / size(all).max(1.0)
    }

    /// The first pieces of these pairs and of all that follow from them: what two partners are sewn to are partners
    /// where they belong together.
    fn reached(&self, mut open: Vec<[usize; 2]>, belong: impl Fn([usize; 2]) -> bool) -> BTreeSet<usize> {
        let mut seen: BTreeSet<[usize; 2]> = open.iter().copied().collect();
        while let Some([one, other]) = open.pop() {
            for (&a, &b) in self.sewn[one].iter().flat_map(|a| self.sewn[other].iter().map(move |b| (a, b))) {
                if belong([a, b]) && seen.insert([a, b]) {
                    open.push([a, b]);
                }
            }
        }
        seen.into_iter().map(|[one, _]| one).collect()
    }

    /// Whether the mirror image of one opening is like another.
    pub(super) fn maps(&self, one: &[RimStretch], other: &[RimStretch], spacing: f64) -> bool {
        let near = |a: &RimStretch, b: &RimStretch| {
            let most = a.count.max(b.count) as f64;
            let shift = Vec2::new(a.middle.x + b.middle.x, a.middle.y - b.middle.y);
            self.mates[a.piece].contains(&b.piece)
                && a.count.abs_diff(b.count) as f64 <= (SAME_LENGTH * most).max(2.0)
                && shift.norm() <= SAME_PLACE * spacing
        };
        one.len() == other.len() && one.iter().all(|a| other.iter().any(|b| near(a, b)))
    }
}

/// The pieces that every piece is sewn to.
fn sewn_to(mesh: &ClothMesh, glued: &Glued) -> Vec<Vec<usize>> {
    let mut at: Vec<Vec<usize>> = vec![Vec::new(); glued.count];
    for (piece, part) in mesh.pieces.iter().enumerate() {
        for node in part.particles.clone().filter_map(|p| glued.node_of[p]) {
            let there = &mut at[node as usize];
            if there.last() != Some(&piece) {
                there.push(piece);
            }
        }
    }
    let mut shared: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for pieces in &at {
        for (&a, &b) in pieces.iter().flat_map(|a| pieces.iter().map(move |b| (a, b))).filter(|(a, b)| a != b) {
            *shared.entry([a, b]).or_default() += 1;
        }
    }
    let mut out = vec![Vec::new(); mesh.pieces.len()];
    shared.into_iter().filter(|(_, count)| *count >= SEWN).for_each(|([a, b], _)| out[a].push(b));
    out
}

/// Points of a piece's outline from the middle of its box.
fn rim(mesh: &ClothMesh, piece: usize) -> Vec<Vec2> {
    let edges = &mesh.pieces[piece].edges;
    let points: Vec<Vec2> = edges.iter().flat_map(|e| &e.particles).map(|&p| mesh.flat[p as usize]).collect();
    let middle = middle_of(&points);
    points.into_iter().map(|p| p - middle).collect()
}

fn middle_of(points: &[Vec2]) -> Vec2 {
    let [low, high] = box_of(points.iter().copied());
    0.5 * (low + high)
}

/// Whether points lie on others once left and right are exchanged.
fn is_mirrored(one: &[Vec2], other: &[Vec2], tolerance: f64) -> bool {
    let near = |p: &Vec2| {
        let image = Vec2::new(-p.x, p.y);
        other.iter().any(|q| (q - image).norm() <= tolerance)
    };
    let boxes = [one, other].map(|points| box_of(points.iter().copied())).map(|[low, high]| high - low);
    (boxes[0] - boxes[1]).norm() <= 2.0 * tolerance && one.iter().all(near)
}

/// The pieces on every opening's rim, longest first. A strap that crosses another is on both sides.
pub(super) fn stretches(
    garment: &Garment,
    mesh: &ClothMesh,
    glued: &Glued,
    openings: &[GluedOpening],
) -> Vec<Vec<RimStretch>> {
    let mut on_rim: Vec<Vec<usize>> = vec![Vec::new(); glued.count];
    for (i, opening) in openings.iter().enumerate() {
        opening.rim.iter().for_each(|&n| on_rim[n as usize].push(i));
    }
    let mut found: Vec<BTreeMap<usize, Vec<Vec2>>> = vec![BTreeMap::new(); openings.len()];
    for (piece, part) in mesh.pieces.iter().enumerate() {
        // Where a band is folded its rim is no edge of the piece.
        for p in part.particles.clone() {
            let Some(node) = glued.node_of[p] else { continue };
            for &i in &on_rim[node as usize] {
                found[i].entry(piece).or_default().push(mesh.flat[p]);
            }
        }
    }
    let ends = glued.crossed.iter().flat_map(|crossed| &crossed.end);
    let crossed: BTreeSet<usize> = ends.filter_map(|p| mesh.piece_of(*p)).collect();
    let side = |piece: usize, points: &[Vec2]| {
        let sides = points.iter().map(|p| side_at(garment, piece, *p));
        if crossed.contains(&piece) { 0.0 } else { sides.sum::<f64>() / points.len() as f64 }
    };
    let stretch = |piece: usize, points: &[Vec2]| stretch(mesh, piece, points, side(piece, points));
    let list = |pieces: BTreeMap<usize, Vec<Vec2>>| {
        // One particle is where another piece's rim ends.
        let long = pieces.into_iter().filter(|(_, points)| points.len() > 1);
        let mut list: Vec<RimStretch> = long.map(|(piece, points)| stretch(piece, &points)).collect();
        list.sort_by_key(|s| (std::cmp::Reverse(s.count), s.piece));
        list
    };
    found.into_iter().map(list).collect()
}

fn stretch(mesh: &ClothMesh, piece: usize, points: &[Vec2], side: f64) -> RimStretch {
    let [low, high] = box_of(mesh.pieces[piece].particles.clone().map(|p| mesh.flat[p]));
    let middle = points.iter().sum::<Vec2>() / points.len() as f64 - 0.5 * (low + high);
    let height = middle.y / (0.5 * (high.y - low.y)).max(1e-9);
    let is_band = (high - low).min() < BAND;
    RimStretch { piece, count: points.len(), middle, height, is_band, side }
}

/// Whether an opening is a hole or a slit within one piece: its rim closes there as it is drawn.
pub(super) fn is_cut_out(mesh: &ClothMesh, opening: &GluedOpening) -> bool {
    let Some(piece) = opening.sides.first().and_then(|side| mesh.piece_of(side[0])) else { return false };
    let own = &mesh.pieces[piece].particles;
    let (on, off): (Vec<[u32; 2]>, Vec<[u32; 2]>) =
        opening.sides.iter().copied().partition(|side| own.contains(&(side[0] as usize)));
    let near = |a: u32, b: u32| (mesh.flat[a as usize] - mesh.flat[b as usize]).norm() <= SLIT_STEP * mesh.spacing;
    off.len() < CORNER_OF_A_SLIT && (0..on.len()).all(|k| near(on[k][1], on[(k + 1) % on.len()][0]))
}

/// Mean of a value that depends on the height in the drawing (−1 at its top, 1 at its bottom) over an opening's rim.
pub(super) fn by_height(stretches: &[RimStretch], value: impl Fn(f64) -> f64) -> f64 {
    shared(stretches, |s| if s.is_band { BAND_SAYS } else { 1.0 } * value(s.height))
}

/// Mean of a value over an opening's rim.
fn shared(stretches: &[RimStretch], value: impl Fn(&RimStretch) -> f64) -> f64 {
    let count: usize = stretches.iter().map(|s| s.count).sum();
    stretches.iter().map(|s| value(s) * s.count as f64).sum::<f64>() / count.max(1) as f64
}

/// The words of a piece's place; none if it has none.
pub(super) fn words(garment: &Garment, piece: usize) -> impl Iterator<Item = PlaceWord> {
    let words: &[PlaceWord] = match &garment.pieces[piece].place {
        Some(Place::Around { words }) => words,
        _ => &[],
    };
    words.iter().copied()
}

/// Whether a word is for what is worn from the waist down.
pub(super) fn is_low(word: PlaceWord) -> bool {
    matches!(word.level(), Some(TrunkLevel::Waist | TrunkLevel::Hip))
}

/// Whether a word is for what goes round the neck or hangs from the shoulders.
pub(super) fn is_high(word: PlaceWord) -> bool {
    match word.meaning() {
        PlaceMeaning::Neck | PlaceMeaning::Arm => true,
        PlaceMeaning::Trunk => !is_low(word),
        _ => false,
    }
}

/// Whether a piece's place says this.
pub(super) fn says(garment: &Garment, piece: usize, meaning: PlaceMeaning) -> bool {
    words(garment, piece).any(|word| word.meaning() == meaning)
}

/// Which side a piece is on: 1 left, −1 right, 0 unknown.
pub(super) fn side_of(garment: &Garment, piece: usize) -> f64 {
    match garment.pieces[piece].side {
        Some(Side::Left) => 1.0,
        Some(Side::Right) => -1.0,
        None => {
            let says = |meaning| f64::from(says(garment, piece, meaning));
            says(PlaceMeaning::Left) - says(PlaceMeaning::Right)
        }
    }
}

/// Which side a point of a flat piece is on: 1 left, −1 right, 0 unknown.
pub(super) fn side_at(garment: &Garment, piece: usize, at: Vec2) -> f64 {
    let side = side_of(garment, piece);
    match garment.pieces[piece].fold {
        Some(fold) if side == 0.0 => {
            let left = fold.left_of(at);
            if left.abs() < ON_FOLD { 0.0 } else { left.signum() }
        }
        _ => side,
    }
}

/// Which way a piece faces: 1 front, −1 back, 0 unknown.
fn facing(garment: &Garment, piece: usize) -> f64 {
    let says = |meaning| f64::from(says(garment, piece, meaning));
    says(PlaceMeaning::Front) - says(PlaceMeaning::Back)
}

/// How much of an opening is on the left rather than on the right: from 1 to −1.
pub(super) fn sidedness(stretches: &[RimStretch]) -> f64 {
    shared(stretches, |s| s.side)
}

/// How much of an opening is on the left rather than on the right as its pieces are drawn, from 1 to −1: on those that
/// are said to be at the front or the back. Seen from outside the wearer's left is to the right on a front.
pub(super) fn drawn_sidedness(garment: &Garment, stretches: &[RimStretch]) -> f64 {
    shared(stretches, |s| facing(garment, s.piece) * s.middle.x.signum())
}

/// The share of an opening on pieces that fail a test.
pub(super) fn share(stretches: &[RimStretch], fails: impl Fn(usize) -> bool) -> f64 {
    shared(stretches, |s| f64::from(fails(s.piece)))
}
