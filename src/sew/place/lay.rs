//! Pieces that lie on others: facings, linings and tacked pockets start where they will be, over the cloth they are
//! sewn or tacked to, as many layers nearer to the body or further from it as the garment says.

use std::ops::Range;

use nalgebra::{Isometry2, Point2, Translation2, UnitComplex};

use super::folded::FoldedPieces;
use crate::geometry::{Locator, TriMesh, Vec2, Vec3};
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, patches};

/// Distance from one layer of cloth to the next at the start, metres.
pub(in crate::sew) const LAYER: f64 = 0.004;

/// Sides that do not match within this once the piece is turned and shifted, metres RMS, are gathered, or go round
/// another way: such a piece does not lie on the other.
const MISFIT: f64 = 0.02;

/// A piece that reaches further than this beyond the rims of the cloth it is sewn to, metres, does not lie on it: a
/// cape over the shoulders of a bodice goes round the arms.
const BEYOND: f64 = 0.05;

/// A point no further beyond a rim than this, metres, counts as within it.
const ROUNDING: f64 = 1e-9;

/// A piece that another one lies on.
#[derive(Clone, Debug)]
struct Host {
    piece: usize,
    /// Layers outward from there; negative towards the body.
    layers: i32,
    /// From the flat piece to the flat host.
    to_host: Isometry2<f64>,
}

/// How a piece lies on others.
#[derive(Clone, Debug)]
pub(in crate::sew) struct Laid {
    hosts: Vec<Host>,
    /// For every particle, in their order, which of the hosts it lies on, and where there.
    spots: Vec<(usize, HostSpot)>,
}

impl Laid {
    /// The host that particle number `k` of the piece lies on, and where on the flat host.
    pub(in crate::sew) fn under(&self, k: usize, flat: Vec2) -> (usize, Vec2) {
        let host = &self.hosts[self.spots[k].0];
        (host.piece, (host.to_host * Point2::from(flat)).coords)
    }

    /// A direction of the flat piece at its particle number `k`, on the flat host there.
    pub(in crate::sew) fn turned(&self, k: usize, way: Vec2) -> Vec2 {
        self.hosts[self.spots[k].0].to_host.rotation * way
    }
}

/// For every piece how it lies on others, if it is one of `pieces`: on those that are not, and on one another.
pub(in crate::sew) fn laid_on_rest(
    garment: &Garment,
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    pieces: &[usize],
) -> Vec<Option<Laid>> {
    let table = Table { garment, mesh, sheet, inward: inward(mesh, sheet), patches: patches(garment) };
    let mut out: Vec<Option<Laid>> = vec![None; mesh.pieces.len()];
    let mut rest = pieces.to_vec();
    loop {
        let before = rest.len();
        rest.retain(|&own| {
            let lies = |other: &usize| !pieces.contains(other) || out[*other].is_some();
            out[own] = table.on(own, lies).or_else(|| table.beside_laid(own, &out));
            out[own].is_none()
        });
        if rest.len() == before {
            return out;
        }
    }
}

/// How many layers a piece lies over another one, negative under it; of one layer the piece that is laid is over it.
pub(in crate::sew) fn layers_over(garment: &Garment, own: usize, host: usize) -> i32 {
    let layers = garment.pieces[own].layer.saturating_sub(garment.pieces[host].layer);
    if layers == 0 { 1 } else { layers }
}

/// Flat pieces on a table.
struct Table<'a> {
    garment: &'a Garment,
    mesh: &'a ClothMesh,
    sheet: &'a FoldedPieces,
    inward: Vec<Vec2>,
    /// Pieces that closures alone hold.
    patches: Vec<usize>,
}

impl Table<'_> {
    /// On pieces of which it may lie on, that its sides match and whose cloth goes the same way from there; a patch on
    /// what it is tacked to.
    fn on(&self, own: usize, may: impl Fn(&usize) -> bool) -> Option<Laid> {
        let is_patch = self.patches.contains(&own);
        let lies_on = |piece: usize| {
            let tacks = if is_patch { Tacks::between(self.garment, own, piece) } else { Tacks::default() };
            let to_host = tacks.to_host().or_else(|| self.matched(own, piece, SeamWay::Same))?;
            Some(Host { piece, layers: tacks.layers(self.garment, own, piece), to_host })
        };
        self.spread(own, (0..self.mesh.pieces.len()).filter(may).filter_map(lies_on).collect())
    }

    /// On what a piece of its own layer lies on, if its sides match that one's and its cloth goes on from there.
    fn beside_laid(&self, own: usize, laid: &[Option<Laid>]) -> Option<Laid> {
        let layer = self.garment.pieces[own].level();
        let of_layer = |other: &usize| *other != own && self.garment.pieces[*other].level() == layer;
        let beside = |other: usize| {
            let hosts = &laid[other].as_ref()?.hosts;
            let to_other = self.matched(own, other, SeamWay::On)?;
            Some(hosts.iter().map(move |host| Host { to_host: host.to_host * to_other, ..host.clone() }))
        };
        self.spread(own, (0..laid.len()).filter(of_layer).filter_map(beside).flatten().collect())
    }

    /// The turn and shift that lay a piece where its stitches with another one meet, if they match there and its cloth
    /// goes the `way` asked for. (Of a band and what hangs from it, it goes on.)
    fn matched(&self, own: usize, other: usize, way: SeamWay) -> Option<Isometry2<f64>> {
        let stitches = stitches(self.mesh, own, other);
        let ends: Vec<[Vec2; 2]> = stitches.iter().map(|pair| pair.map(|p| self.sheet.flat[p as usize])).collect();
        let to_other = fitting(&ends)?;
        let inward = stitches.iter().map(|pair| pair.map(|p| self.inward[p as usize]));
        let same_way = inward.map(|[a, b]| (to_other * a).dot(&b)).sum::<f64>() > 0.0;
        (same_way == (way == SeamWay::Same)).then_some(to_other)
    }

    /// Spread out over `hosts`, every particle on the one right under it rather than beyond the rim of another; not if
    /// there is none or it reaches far beyond them.
    fn spread(&self, own: usize, hosts: Vec<Host>) -> Option<Laid> {
        let opened = hosts.into_iter().map(|host| (open(self.mesh, self.sheet, host.piece), host));
        let (opened, hosts): (Vec<_>, Vec<_>) = opened.filter(|(open, _)| !open.is_empty()).unzip();
        let grounds: Vec<Ground> = hosts
            .iter()
            .zip(&opened)
            .map(|(host, open)| Ground {
                to_host: host.to_host,
                flat: &self.sheet.flat,
                locator: Locator::new(&self.sheet.flat, open, self.mesh.spacing),
            })
            .collect();
        let nearest = |p: usize| {
            let spots = grounds.iter().map(|ground| ground.under(p)).enumerate();
            spots.min_by(|a, b| a.1.beyond.total_cmp(&b.1.beyond)).filter(|(_, spot)| spot.beyond <= BEYOND)
        };
        let spots = self.mesh.pieces[own].particles.clone().map(nearest).collect::<Option<Vec<_>>>()?;
        Some(Laid { hosts, spots })
    }
}

/// The tacks between a piece and the one that it lies on.
#[derive(Default)]
struct Tacks {
    /// The points of every tack, flat: on the piece, and on the other one.
    points: Vec<[Vec2; 2]>,
    /// Whether the piece carries the closure: what that meets lies over it, as a buttonhole over its button.
    is_under: bool,
}

impl Tacks {
    fn between(garment: &Garment, own: usize, other: usize) -> Self {
        let mut out = Self::default();
        for [carries, meets] in garment.closures.iter().flat_map(|closure| &closure.tacks) {
            if [carries.0, meets.0] == [own, other] {
                out.points.push([carries.1, meets.1]);
                out.is_under = true;
            } else if [meets.0, carries.0] == [own, other] {
                out.points.push([meets.1, carries.1]);
            }
        }
        out
    }

    /// The turn and shift that lay the piece where they are; of one tack the shift alone, for pieces are drawn as they
    /// hang. `None` if there are none, or if they do not match.
    fn to_host(&self) -> Option<Isometry2<f64>> {
        if let [[from, to]] = self.points[..] {
            return Some(Translation2::from(to - from).into());
        }
        fitting(&self.points)
    }

    /// How many layers the piece lies over the other one, negative under it.
    fn layers(&self, garment: &Garment, own: usize, other: usize) -> i32 {
        let layers = layers_over(garment, own, other);
        let is_of_one_layer = garment.pieces[own].layer == garment.pieces[other].layer;
        if is_of_one_layer && self.is_under { -layers } else { layers }
    }
}

/// Where the cloth of a piece goes from a seam: over the other piece, or on from it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SeamWay {
    Same,
    On,
}

/// Stitches between two pieces, the particle of `own` first.
fn stitches(mesh: &ClothMesh, own: usize, other: usize) -> Vec<[u32; 2]> {
    let [own, other] = [own, other].map(|piece| &mesh.pieces[piece].particles);
    let is_in = |piece: &Range<usize>, p: u32| piece.contains(&(p as usize));
    let pairs = mesh.seams.iter().flat_map(|seam| &seam.pairs).flat_map(|&[a, b]| [[a, b], [b, a]]);
    pairs.filter(|&[a, b]| is_in(own, a) && is_in(other, b)).collect()
}

/// The turn and shift that bring points nearest to their partners (least squares).
pub(in crate::sew) fn fit(pairs: &[[Vec2; 2]]) -> Option<Isometry2<f64>> {
    if pairs.len() < 2 {
        return None;
    }
    let [from, to] = [0, 1].map(|k| pairs.iter().map(|pair| pair[k]).sum::<Vec2>() / pairs.len() as f64);
    let (mut cosine, mut sine) = (0.0, 0.0);
    for [a, b] in pairs.iter().map(|[a, b]| [a - from, b - to]) {
        cosine += a.dot(&b);
        sine += a.perp(&b);
    }
    let turn = UnitComplex::new(f64::atan2(sine, cosine));
    Some(Isometry2::from_parts((to - turn * from).into(), turn))
}

/// [`fit`], if it brings the points as near as [`MISFIT`].
fn fitting(pairs: &[[Vec2; 2]]) -> Option<Isometry2<f64>> {
    let map = fit(pairs)?;
    let misfit: f64 = pairs.iter().map(|[a, b]| ((map * Point2::from(*a)).coords - b).norm_squared()).sum();
    (misfit <= MISFIT * MISFIT * pairs.len() as f64).then_some(map)
}

/// Where the cloth lies from every particle: on average over its triangles, metres; about nothing inside a piece.
fn inward(mesh: &ClothMesh, sheet: &FoldedPieces) -> Vec<Vec2> {
    let mut sums = vec![(Vec2::zeros(), 0.0); mesh.flat.len()];
    for t in &mesh.triangles {
        let middle = t.iter().map(|&n| sheet.flat[n as usize]).sum::<Vec2>() / 3.0;
        for &n in t {
            sums[n as usize].0 += middle - sheet.flat[n as usize];
            sums[n as usize].1 += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect()
}

/// Puts the pieces that lie on others on them, each after its hosts. Pieces that lie on none have their place in `x`.
pub(in crate::sew) fn lay(
    garment: &Garment,
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    laid: &[Option<Laid>],
    x: &mut [Vec3],
) {
    let mut order: Vec<(usize, &Laid)> =
        laid.iter().enumerate().filter_map(|(own, laid)| Some((own, laid.as_ref()?))).collect();
    order.sort_by_key(|&(own, _)| (garment.pieces[own].layer.unsigned_abs(), own));
    let mut has_place: Vec<bool> = laid.iter().map(Option::is_none).collect();
    let can_lie = |laid: &Laid, has_place: &[bool]| laid.hosts.iter().all(|host| has_place[host.piece]);
    while let Some(next) = order.iter().position(|(_, laid)| can_lie(laid, &has_place)) {
        let (own, laid) = order.remove(next);
        has_place[own] = true;
        let skin = |host: &Host| (normals(open(mesh, sheet, host.piece), x), off(mesh, sheet, host, own));
        let skins: Vec<(Vec<Vec3>, f64)> = laid.hosts.iter().map(skin).collect();
        for (p, (host, spot)) in mesh.pieces[own].particles.clone().zip(&laid.spots) {
            let (normals, off) = &skins[*host];
            x[p] = spot.raised(x, normals, LAYER * (off - sheet.under[p]));
        }
    }
}

/// How many layers out of its host a piece lies: beyond what the host has folded there (hems, pleats), and with its own
/// folds between the two.
fn off(mesh: &ClothMesh, sheet: &FoldedPieces, host: &Host, own: usize) -> f64 {
    let side = f64::from(host.layers.signum());
    let deepest =
        |piece: usize, way: f64| mesh.pieces[piece].particles.clone().map(|p| way * sheet.under[p]).fold(0.0, f64::max);
    f64::from(host.layers) + side * (deepest(host.piece, -side) + deepest(own, side))
}

/// The triangles of a piece of which nothing is folded under.
fn open(mesh: &ClothMesh, sheet: &FoldedPieces, piece: usize) -> Vec<[u32; 3]> {
    let open = |t: &&[u32; 3]| t.iter().all(|&n| sheet.under[n as usize] == 0.0);
    mesh.triangles[mesh.pieces[piece].triangles.clone()].iter().filter(open).copied().collect()
}

/// A host, flat.
struct Ground<'a> {
    to_host: Isometry2<f64>,
    flat: &'a [Vec2],
    locator: Locator<'a>,
}

impl Ground<'_> {
    /// The spot of the host on which particle `p` lies.
    fn under(&self, p: usize) -> HostSpot {
        let at = (self.to_host * Point2::from(self.flat[p])).coords;
        let (corners, weights) = self.locator.place(at);
        let within = weights.map(|w| w.clamp(0.0, 1.0));
        let within = within.map(|w| w / within.iter().sum::<f64>());
        let nearest: Vec2 = corners.iter().zip(within).map(|(&n, w)| self.flat[n as usize] * w).sum();
        // Within the rim nothing but rounding tells hosts apart: the first one has it.
        let beyond = Some((at - nearest).norm()).filter(|d| *d > ROUNDING).unwrap_or(0.0);
        HostSpot { beyond, corners, weights, within }
    }
}

/// A spot on a host or beyond its rim.
#[derive(Clone, Debug)]
struct HostSpot {
    /// How far beyond the rim in the flat, metres.
    beyond: f64,
    /// The triangle there, or the nearest.
    corners: [u32; 3],
    /// Their shares in it; beyond the rim the host goes straight on.
    weights: [f64; 3],
    /// Their shares in a point of the triangle near to it.
    within: [f64; 3],
}

impl HostSpot {
    /// Its place in space, `off` metres out of the host's right side.
    fn raised(&self, x: &[Vec3], normals: &[Vec3], off: f64) -> Vec3 {
        let sum = |of: &[Vec3], weights: [f64; 3]| -> Vec3 {
            self.corners.iter().zip(weights).map(|(&n, w)| of[n as usize] * w).sum()
        };
        sum(x, self.weights) + sum(normals, self.within).try_normalize(0.0).unwrap_or_default() * off
    }
}

/// Directions out of the cloth's right side at the corners of these triangles, weighted by area. (Seen from there their
/// corners go round clockwise.)
fn normals(triangles: Vec<[u32; 3]>, x: &[Vec3]) -> Vec<Vec3> {
    TriMesh { vertices: x.to_vec(), triangles }.vertex_normals().iter().map(|n| -n).collect()
}
