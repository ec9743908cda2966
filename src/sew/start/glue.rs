//! The pieces of a garment welded along their seams: one surface per connected part.

use std::collections::BTreeMap;

use super::crossing::{CrossedEnd, Exchange};
use super::laps::{Lap, laps};
use super::layers::{self, Sheets};
use super::openings::rims;
use crate::geometry::{DisjointSets, Locator, Vec2, sorted_pair};
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::{Garment, PleatLayer, SeamKind};
use crate::sew::place::fold::pressed;
use crate::sew::place::folded::FoldedPieces;

/// No node: of what is left out of the surface.
const NONE: u32 = u32::MAX;

/// Shares less than this far below zero are zero but for rounding.
pub(super) const ROUNDING: f64 = 1e-6;

/// A fold that is nearer to its seam than this share of the spacing leaves a strip that folds over by itself.
const STRIP: f64 = 0.5;

/// Where a collar rolls it is so many layers off its stand, as what falls over that.
const ROLL: f64 = 1.0;

/// The pieces of the base sheet welded along their seams.
#[derive(Clone, Debug, Default)]
pub struct Glued {
    /// The node of every particle; `None` for those of pieces left out, and of what is turned over at a pressed fold.
    pub node_of: Vec<Option<u32>>,
    /// Corners as nodes; they run as the pieces' triangles do, and the other way round in pieces that are turned over.
    pub triangles: Vec<[u32; 3]>,
    /// The particles of the same corners.
    pub corners: Vec<[u32; 3]>,
    /// Number of nodes.
    pub count: usize,
    /// Connected part of every node, numbered by its first node.
    pub part_of: Vec<u32>,
    /// Indices of the pieces left out, rising: what lies on other cloth, and patches that closures alone hold.
    pub left_out: Vec<usize>,
    /// Indices of the pieces that are turned over, rising: the surface has their wrong side where it has the right side
    /// of the others.
    pub turned: Vec<usize>,
    /// Where closures hold one piece over another: their rims are welded here, and lie over one another when worn.
    pub laps: Vec<Lap>,
    /// Pairs of particles of open fronts and slits, which are welded for the start alone.
    pub zips: Vec<[u32; 2]>,
    /// The ends of crossed straps, which are welded side by side for the start alone.
    pub crossed: Vec<CrossedEnd>,
    /// For every particle that lies on other cloth of its own piece (turned over at a pressed fold, or laid in a
    /// pleat) where it lies once the piece is flat.
    pub follows: Vec<Option<Follow>>,
    /// Particles that are turned over beyond a seam of their piece.
    pub beyond: Vec<Beyond>,
}

/// Where a particle lies that is turned over beyond a seam of its piece, on the other side of that seam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beyond {
    /// The particle.
    pub particle: u32,
    /// Where it lies on the flat piece, turned over, metres.
    pub at: Vec2,
    /// Layers out of the right side of the cloth there.
    pub layers: f64,
}

/// A place on the cloth of the same piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// Particles of the triangle that it lies on, or of the nearest.
    pub corners: [u32; 3],
    /// Their shares; beyond the rim the triangle's plane goes straight on.
    pub weights: [f64; 3],
    /// Layers out of the right side of the cloth; negative towards the wrong side.
    pub layers: f64,
    /// How far it has come to lie there from its own place on the surface, 0 to 1: less than 1 where a pleat opens.
    pub share: f64,
}

/// Welds the pieces of a garment. `zips` are pairs of particles welded besides. Straps that cross are welded uncrossed
/// if that rids the surface of its handles.
pub fn glue(garment: &Garment, mesh: &ClothMesh, zips: &[[u32; 2]]) -> Glued {
    glued(garment, mesh, zips).0
}

/// [`glue`], and the seams or closures that exchange their partners for it.
pub(super) fn glued(garment: &Garment, mesh: &ClothMesh, zips: &[[u32; 2]]) -> (Glued, Option<Exchange>) {
    let sheet = pressed(garment, mesh);
    let to_glue = ToGlue { garment, mesh, sheet: &sheet, zips };
    let (plain, is_whole) = to_glue.glued(None);
    if is_whole {
        return (plain, None);
    }
    let uncrossed = |exchange: Exchange| {
        let (mut glued, is_whole) = to_glue.glued(Some(&exchange));
        glued.crossed = exchange.ends(garment, mesh).to_vec();
        let shift = |glued: &Glued| glued.crossed.iter().map(|end| end.shift(glued, mesh)).fold(0.0, f64::max);
        is_whole.then(|| (shift(&glued), glued, exchange))
    };
    // An end that is led over less cloth is led sooner.
    let nearest = Exchange::all(garment).into_iter().filter_map(uncrossed).min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map_or((plain, None), |(_, glued, exchange)| (glued, Some(exchange)))
}

/// A garment to be glued.
struct ToGlue<'a> {
    garment: &'a Garment,
    mesh: &'a ClothMesh,
    sheet: &'a FoldedPieces,
    zips: &'a [[u32; 2]],
}

impl ToGlue<'_> {
    /// The glued garment, and whether it is a sphere with holes and all its laps are closed.
    fn glued(&self, exchange: Option<&Exchange>) -> (Glued, bool) {
        let (garment, mesh) = (self.garment, self.mesh);
        let mut is_out = turned_over(garment, mesh, self.sheet);
        let strips = strips(mesh, self.sheet);
        strips.iter().for_each(|p| is_out[*p as usize] = true);
        let mut zips = self.zips.to_vec();
        let laps = self.laps(exchange, &mut zips);
        let sewn: Vec<[u32; 2]> = stitches(garment, mesh, exchange).chain(zips.iter().copied()).collect();
        let Sheets { left_out, turned } = layers::sheets(garment, mesh, &is_out, &mut welded(mesh, &is_out, &sewn));
        left_out.iter().for_each(|&piece| is_out[mesh.pieces[piece].particles.clone()].fill(true));
        let (laps, pairs, is_whole) = self.flat_laps(&is_out, &turned, sewn, laps);
        cover(&mut is_out, &laps);
        let mut out = numbered(mesh, &is_out, &turned, &mut welded(mesh, &is_out, &pairs));
        (out.follows, out.beyond) = follows(mesh, self.sheet);
        let roll = |p: u32| Beyond { particle: p, at: self.sheet.flat[p as usize], layers: ROLL };
        out.beyond.extend(strips.into_iter().map(roll));
        (out.laps, out.left_out, out.turned, out.zips) = (laps, left_out, turned, zips);
        (out, is_whole)
    }

    /// The laps of the garment, but for those at rims that are zipped. Zips that carry a lap on are taken out.
    fn laps(&self, exchange: Option<&Exchange>, zips: &mut Vec<[u32; 2]>) -> Vec<Lap> {
        let (garment, mesh) = (self.garment, self.mesh);
        let mut found = match exchange {
            Some(exchange) => {
                let closures = exchange.closures(garment);
                laps(&Garment { closures, ..garment.clone() }, mesh, self.sheet, zips)
            }
            None => laps(garment, mesh, self.sheet, zips),
        };
        let is_zipped = |p: &u32| zips.iter().flatten().any(|z| z == p);
        found.retain(|lap| !lap.pairs.iter().flatten().any(is_zipped));
        found
    }

    /// The laps that leave the surface a sphere with holes, all pairs that are welded with them, and whether the
    /// surface is one with all laps. Laps that give it a handle are left out, and done up later.
    fn flat_laps(
        &self,
        is_out: &[bool],
        turned: &[usize],
        mut pairs: Vec<[u32; 2]>,
        mut rest: Vec<Lap>,
    ) -> (Vec<Lap>, Vec<[u32; 2]>, bool) {
        let (garment, mesh) = (self.garment, self.mesh);
        let mut kept: Vec<Lap> = Vec::new();
        let drawn = |lap: &Lap| [lap.over, lap.under].map(|p| &garment.pieces[p].drawn_as);
        let handles = |pairs: &[[u32; 2]], laps: &[Lap]| {
            let mut is_out = is_out.to_vec();
            cover(&mut is_out, laps);
            handles(&numbered(mesh, &is_out, turned, &mut welded(mesh, &is_out, pairs)))
        };
        let mut least = handles(&pairs, &[]);
        let mut is_whole = true;
        while let Some(first) = rest.first() {
            let first = drawn(first);
            // Those of a pair are kept or left together.
            let (group, others): (Vec<Lap>, Vec<Lap>) = rest.iter().cloned().partition(|lap| drawn(lap) == first);
            rest = others;
            let welds = group.iter().flat_map(|lap| lap.pairs.clone());
            let more: Vec<[u32; 2]> = pairs.iter().copied().chain(welds).collect();
            let with: Vec<Lap> = kept.iter().chain(&group).cloned().collect();
            let now = handles(&more, &with);
            if now <= least {
                (pairs, least, kept) = (more, now, with);
            } else {
                is_whole = false;
            }
        }
        (kept, pairs, is_whole && least == 0)
    }
}

/// Particles by what welds them; `is_out` are not welded.
fn welded(mesh: &ClothMesh, is_out: &[bool], pairs: &[[u32; 2]]) -> DisjointSets {
    let mut sets = DisjointSets::new(mesh.flat.len());
    for &[a, b] in pairs.iter().filter(|pair| pair.iter().all(|&p| !is_out[p as usize])) {
        sets.join(a, b);
    }
    sets
}

/// Takes what laps cover off the surface.
fn cover(is_out: &mut [bool], laps: &[Lap]) {
    laps.iter().flat_map(|lap| &lap.covered).for_each(|(p, _)| is_out[*p as usize] = true);
}

impl Glued {
    /// The flat corners of a triangle, metres. They run as those of all others do: a piece that is turned over is seen
    /// from its wrong side.
    pub(super) fn flat(&self, mesh: &ClothMesh, triangle: usize) -> [Vec2; 3] {
        let corners = self.corners[triangle];
        let is_turned = mesh.piece_of(corners[0]).is_some_and(|piece| self.turned.contains(&piece));
        let side = if is_turned { -1.0 } else { 1.0 };
        corners.map(|p| Vec2::new(side * mesh.flat[p as usize].x, mesh.flat[p as usize].y))
    }

    /// Number of connected parts.
    pub(super) fn parts(&self) -> u32 {
        self.part_of.iter().max().map_or(0, |last| last + 1)
    }
}

/// Twice the number of handles of all parts of a surface.
fn handles(glued: &Glued) -> i64 {
    let mut sides: BTreeMap<[u32; 2], i64> = BTreeMap::new();
    for t in &glued.triangles {
        (0..3).for_each(|k| *sides.entry(sorted_pair([t[k], t[(k + 1) % 3]])).or_default() += 1);
    }
    let euler = glued.count as i64 - sides.len() as i64 + glued.triangles.len() as i64;
    2 * i64::from(glued.parts()) - euler - rims(glued).len() as i64
}

/// The pairs that seams join, once exchanged, but for the upper layer of a pleat: its other two are sewn to one another
/// there, and are a fin of the surface.
fn stitches<'a>(
    garment: &'a Garment,
    mesh: &'a ClothMesh,
    exchange: Option<&'a Exchange>,
) -> impl Iterator<Item = [u32; 2]> + 'a {
    let is_kept = |k: &usize| garment.seams[*k].kind != SeamKind::Pleat(PleatLayer::Top);
    let pairs =
        move |k: usize| exchange.map_or_else(|| mesh.seams[k].pairs.clone(), |exchange| exchange.pairs(mesh, k));
    (0..garment.seams.len()).filter(is_kept).flat_map(pairs)
}

/// The particles that are turned over at a pressed fold, and not part of a pleat.
fn turned_over(garment: &Garment, mesh: &ClothMesh, sheet: &FoldedPieces) -> Vec<bool> {
    let mut turned = sheet.hidden.clone();
    for seam in garment.seams.iter().filter(|seam| matches!(seam.kind, SeamKind::Pleat(_))) {
        for span in &seam.a {
            turned[mesh.pieces[span.edge.piece].particles.clone()].fill(false);
        }
    }
    turned
}

/// Which particles are in a seam.
fn sewn(mesh: &ClothMesh) -> Vec<bool> {
    let mut out = vec![false; mesh.flat.len()];
    mesh.seams.iter().flat_map(|seam| seam.pairs.iter().flatten()).for_each(|p| out[*p as usize] = true);
    out
}

/// Particles between a seam and a pressed fold beside it, as of a collar that rolls just above its stand: too narrow a
/// strip to stand up by itself.
fn strips(mesh: &ClothMesh, sheet: &FoldedPieces) -> Vec<u32> {
    let is_sewn = sewn(mesh);
    let of_piece = |piece: &PieceMesh| -> Vec<u32> {
        let (sewn, free): (Vec<usize>, Vec<usize>) =
            piece.particles.clone().filter(|p| !sheet.hidden[*p]).partition(|p| is_sewn[*p]);
        let is_near = |p: &usize| sewn.iter().any(|q| (mesh.flat[*p] - mesh.flat[*q]).norm() < STRIP * mesh.spacing);
        let is_folded = piece.particles.clone().any(|p| sheet.hidden[p]);
        if is_folded && free.iter().all(is_near) { free.into_iter().map(|p| p as u32).collect() } else { Vec::new() }
    };
    mesh.pieces.iter().flat_map(of_piece).collect()
}

/// Numbers the nodes and the connected parts. The triangles of pieces that are `turned` over run the other way round.
fn numbered(mesh: &ClothMesh, is_out: &[bool], turned: &[usize], sets: &mut DisjointSets) -> Glued {
    let particle = |t: usize| mesh.triangles[t].map(|p| p as usize);
    let kept = |t: &usize| particle(*t).iter().all(|&p| !is_out[p]);
    let mut number = vec![NONE; mesh.flat.len()];
    let mut count = 0;
    let is_turned = |t: usize| turned.iter().any(|piece| mesh.pieces[*piece].triangles.contains(&t));
    let (mut triangles, mut corners) = (Vec::new(), Vec::new());
    for t in (0..mesh.triangles.len()).filter(kept) {
        let mut own = mesh.triangles[t];
        if is_turned(t) {
            own.swap(1, 2);
        }
        let nodes = own.map(|p| {
            let root = sets.root(p) as usize;
            if number[root] == NONE {
                number[root] = count;
                count += 1;
            }
            number[root]
        });
        if nodes[0] != nodes[1] && nodes[1] != nodes[2] && nodes[2] != nodes[0] {
            triangles.push(nodes);
            corners.push(own);
        }
    }
    let node = |p: u32| Some(number[sets.root(p) as usize]).filter(|&n| n != NONE && !is_out[p as usize]);
    let node_of = (0..mesh.flat.len() as u32).map(node).collect();
    let part_of = parts(&triangles, count as usize);
    Glued { node_of, triangles, corners, count: count as usize, part_of, ..Glued::default() }
}

/// The connected part of every node.
fn parts(triangles: &[[u32; 3]], count: usize) -> Vec<u32> {
    let mut sets = DisjointSets::new(count);
    for &[a, b, c] in triangles {
        sets.join(a, b);
        sets.join(a, c);
    }
    let mut number = vec![NONE; count];
    let mut parts = 0;
    let of = |node: u32| {
        let root = sets.root(node) as usize;
        if number[root] == NONE {
            number[root] = parts;
            parts += 1;
        }
        number[root]
    };
    (0..count as u32).map(of).collect()
}

/// Where particles lie that other cloth of their piece lies under, and those that reach beyond a seam of it.
fn follows(mesh: &ClothMesh, sheet: &FoldedPieces) -> (Vec<Option<Follow>>, Vec<Beyond>) {
    let mut out = vec![None; mesh.flat.len()];
    let mut beyond = Vec::new();
    let is_sewn = sewn(mesh);
    for piece in &mesh.pieces {
        let hidden = |p: &u32| sheet.hidden[*p as usize];
        let open: Vec<[u32; 3]> =
            mesh.triangles[piece.triangles.clone()].iter().filter(|t| !t.iter().any(hidden)).copied().collect();
        if open.is_empty() || !piece.particles.clone().any(|p| sheet.hidden[p]) {
            continue;
        }
        let ground = Locator::new(&sheet.flat, &open, mesh.spacing);
        for p in piece.particles.clone().filter(|&p| sheet.hidden[p]) {
            let (corners, weights) = ground.place(sheet.flat[p]);
            let layers = -sheet.under[p];
            let is_outside = weights.iter().any(|w| *w < -ROUNDING);
            if is_outside && layers > 0.0 && corners.iter().any(|n| is_sewn[*n as usize]) {
                beyond.push(Beyond { particle: p as u32, at: sheet.flat[p], layers });
            } else {
                out[p] = Some(Follow { corners, weights, layers, share: sheet.shut[p] });
            }
        }
    }
    (out, beyond)
}
