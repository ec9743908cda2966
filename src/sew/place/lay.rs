//! Pieces that lie on others: facings and linings start where they will be, over the cloth they are sewn to, as many layers
//! nearer to the body or further from it as the garment says.

use nalgebra::{Isometry2, Point2, UnitComplex};

use super::fold::Sheet;
use super::ring::LAYER;
use super::rows::Link;
use crate::geometry::{Locator, Vec2, Vec3};
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, Place};

/// Sides that do not match within this once the piece is turned and shifted, metres RMS, are gathered, or go round another
/// way: such a piece has a place in a row of its own.
const MISFIT: f64 = 0.02;

/// What reaches further than this beyond the rims of what it is sewn to, metres, does not lie on it: a cape over the
/// shoulders of a bodice goes round the arms.
const BEYOND: f64 = 0.05;

/// A piece that another one lies on.
#[derive(Clone, Debug)]
pub(super) struct Host {
    pub(super) piece: usize,
    /// Layers outward from there; negative towards the body.
    pub(super) layers: i32,
    /// From the flat piece to the flat host.
    to_host: Isometry2<f64>,
    /// The host's triangles of which nothing is folded under.
    open: Vec<[u32; 3]>,
}

/// For every piece those it lies on; none for those that have a place in a row.
pub(super) fn hosts(garment: &Garment, mesh: &ClothMesh, sheet: &Sheet, links: &[Link]) -> Vec<Vec<Host>> {
    let inward = inward(mesh, sheet);
    let of = |own: usize| -> Vec<Host> {
        let layer = garment.pieces[own].layer;
        let inner = |&other: &usize| garment.pieces[other].layer.unsigned_abs() < layer.unsigned_abs();
        let lies_on = |piece: usize| {
            let to_host = lies(sheet, &stitches(links, own, piece), &inward)?;
            let open = open(mesh, sheet, piece);
            (!open.is_empty()).then_some(Host {
                piece,
                layers: layer.saturating_sub(garment.pieces[piece].layer),
                to_host,
                open,
            })
        };
        let hosts: Vec<Host> = (0..mesh.pieces.len()).filter(inner).filter_map(lies_on).collect();
        let grounds = grounds(mesh, sheet, &hosts);
        let beyond = |p: usize| grounds.iter().map(|ground| ground.under(p).beyond).fold(f64::INFINITY, f64::min);
        if mesh.pieces[own].particles.clone().any(|p| beyond(p) > BEYOND) { Vec::new() } else { hosts }
    };
    let is_at = |own: usize| matches!(garment.pieces[own].place, Some(Place::At { .. }));
    (0..mesh.pieces.len()).map(|own| if is_at(own) { Vec::new() } else { of(own) }).collect()
}

/// How many layers the deepest of the pieces that lie on one of `pieces` lies under it.
pub(super) fn beneath(hosts: &[Vec<Host>], pieces: &[usize]) -> i32 {
    let under = |own: usize| {
        let layers =
            hosts[own].iter().filter(|host| pieces.contains(&host.piece)).map(|host| host.layers.saturating_neg());
        // Every host is of a layer nearer to 0: this ends.
        layers.max().map(|layers| layers.saturating_add(beneath(hosts, &[own])))
    };
    (0..hosts.len()).filter_map(under).fold(0, i32::max)
}

/// Stitches between two pieces, the particle of `own` first.
fn stitches(links: &[Link], own: usize, other: usize) -> Vec<[u32; 2]> {
    let mut out = Vec::new();
    for link in links {
        if link.pieces == [own, other] {
            out.extend_from_slice(&link.pairs);
        } else if link.pieces == [other, own] {
            out.extend(link.pairs.iter().map(|[a, b]| [*b, *a]));
        }
    }
    out
}

/// The turn and shift that lay a piece on the one it is sewn to, if they match there and from the seam the cloth of both
/// goes the same way. (Of a band and what hangs from it, it does not.)
fn lies(sheet: &Sheet, stitches: &[[u32; 2]], inward: &[Vec2]) -> Option<Isometry2<f64>> {
    let ends: Vec<[Vec2; 2]> = stitches.iter().map(|pair| pair.map(|p| sheet.drawn[p as usize])).collect();
    let to_host = fit(&ends)?;
    let misfit: f64 = ends.iter().map(|[a, b]| ((to_host * Point2::from(*a)).coords - b).norm_squared()).sum();
    let same_way: f64 =
        stitches.iter().map(|pair| pair.map(|p| inward[p as usize])).map(|[a, b]| (to_host * a).dot(&b)).sum();
    (misfit <= MISFIT * MISFIT * ends.len() as f64 && same_way > 0.0).then_some(to_host)
}

/// The turn and shift that bring points nearest to their partners (least squares).
fn fit(pairs: &[[Vec2; 2]]) -> Option<Isometry2<f64>> {
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

/// Where the cloth lies from every particle: on average over its triangles, metres; about nothing inside a piece.
fn inward(mesh: &ClothMesh, sheet: &Sheet) -> Vec<Vec2> {
    let mut sums = vec![(Vec2::zeros(), 0.0); mesh.flat.len()];
    for t in &mesh.triangles {
        let middle = t.iter().map(|&n| sheet.drawn[n as usize]).sum::<Vec2>() / 3.0;
        for &n in t {
            sums[n as usize].0 += middle - sheet.drawn[n as usize];
            sums[n as usize].1 += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect()
}

/// Puts the pieces that lie on others on them, those first whose hosts have their place in `x` from the first.
pub(super) fn lay(garment: &Garment, mesh: &ClothMesh, sheet: &Sheet, hosts: &[Vec<Host>], x: &mut [Vec3]) {
    let mut order: Vec<usize> = (0..hosts.len()).filter(|&piece| !hosts[piece].is_empty()).collect();
    order.sort_by_key(|&piece| (garment.pieces[piece].layer.unsigned_abs(), piece));
    for own in order {
        let grounds = grounds(mesh, sheet, &hosts[own]);
        let normals: Vec<Vec<Vec3>> = hosts[own].iter().map(|host| normals(&host.open, x)).collect();
        for p in mesh.pieces[own].particles.clone() {
            let spots = grounds.iter().map(|ground| ground.under(p)).zip(&hosts[own]).zip(&normals);
            // On the one right under it rather than beyond the rim of another.
            if let Some(((spot, host), normals)) = spots.min_by(|a, b| a.0.0.beyond.total_cmp(&b.0.0.beyond)) {
                x[p] = spot.raised(x, normals, LAYER * (off(mesh, sheet, host, own) - sheet.under[p]));
            }
        }
    }
}

/// How many layers out of its host a piece lies: beyond what the host has folded there (hems, pleats), and with its own
/// folds between the two.
fn off(mesh: &ClothMesh, sheet: &Sheet, host: &Host, own: usize) -> f64 {
    let side = f64::from(host.layers.signum());
    let deepest =
        |piece: usize, way: f64| mesh.pieces[piece].particles.clone().map(|p| way * sheet.under[p]).fold(0.0, f64::max);
    f64::from(host.layers) + side * (deepest(host.piece, -side) + deepest(own, side))
}

/// The triangles of a piece of which nothing is folded under.
fn open(mesh: &ClothMesh, sheet: &Sheet, piece: usize) -> Vec<[u32; 3]> {
    let open = |t: &&[u32; 3]| t.iter().all(|&n| sheet.under[n as usize] == 0.0);
    mesh.triangles[mesh.pieces[piece].triangles.clone()].iter().filter(open).copied().collect()
}

/// A host, flat.
struct Ground<'a> {
    to_host: Isometry2<f64>,
    drawn: &'a [Vec2],
    locator: Locator<'a>,
}

fn grounds<'a>(mesh: &ClothMesh, sheet: &'a Sheet, hosts: &'a [Host]) -> Vec<Ground<'a>> {
    let locator = |host: &'a Host| Locator::new(&sheet.drawn, &host.open, mesh.spacing);
    hosts.iter().map(|host| Ground { to_host: host.to_host, drawn: &sheet.drawn, locator: locator(host) }).collect()
}

impl Ground<'_> {
    /// The spot of the host on which particle `p` lies.
    fn under(&self, p: usize) -> Spot {
        let at = (self.to_host * Point2::from(self.drawn[p])).coords;
        let (corners, weights) = self.locator.place(at);
        let within = weights.map(|w| w.clamp(0.0, 1.0));
        let within = within.map(|w| w / within.iter().sum::<f64>());
        let nearest: Vec2 = corners.iter().zip(within).map(|(&n, w)| self.drawn[n as usize] * w).sum();
        Spot { beyond: (at - nearest).norm(), corners, weights, within }
    }
}

/// A spot on a host or beyond its rim.
struct Spot {
    /// How far beyond the rim in the flat, metres.
    beyond: f64,
    /// The triangle there, or the nearest.
    corners: [u32; 3],
    /// Their shares in it; beyond the rim the host goes straight on.
    weights: [f64; 3],
    /// Their shares in a point of the triangle near to it.
    within: [f64; 3],
}

impl Spot {
    /// Its place in space, `off` metres out of the host's right side.
    fn raised(&self, x: &[Vec3], normals: &[Vec3], off: f64) -> Vec3 {
        let sum = |of: &[Vec3], weights: [f64; 3]| -> Vec3 {
            self.corners.iter().zip(weights).map(|(&n, w)| of[n as usize] * w).sum()
        };
        sum(x, self.weights) + sum(normals, self.within).try_normalize(0.0).unwrap_or_default() * off
    }
}

/// Directions out of the cloth's right side at the corners of these triangles, weighted by area.
fn normals(triangles: &[[u32; 3]], x: &[Vec3]) -> Vec<Vec3> {
    let mut out = vec![Vec3::zeros(); x.len()];
    for t in triangles {
        let [a, b, c] = t.map(|n| x[n as usize]);
        let normal = (c - a).cross(&(b - a));
        t.iter().for_each(|&n| out[n as usize] += normal);
    }
    out.iter().map(|n| n.try_normalize(0.0).unwrap_or_default()).collect()
}
