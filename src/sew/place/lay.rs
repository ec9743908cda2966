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

/// A piece that another one lies on.
#[derive(Clone, Debug)]
pub(super) struct Host {
    pub(super) piece: usize,
    /// Layers outward from there; negative towards the body.
    pub(super) layers: i32,
    /// From the flat piece to the flat host.
    to_host: Isometry2<f64>,
}

/// For every piece those it lies on; none for those that have a place in a row.
pub(super) fn hosts(garment: &Garment, mesh: &ClothMesh, sheet: &Sheet, links: &[Link]) -> Vec<Vec<Host>> {
    let inward = inward(mesh, sheet);
    let of = |own: usize| -> Vec<Host> {
        if matches!(garment.pieces[own].place, Some(Place::At { .. })) {
            return Vec::new();
        }
        let layer = garment.pieces[own].layer;
        let inner = |&other: &usize| garment.pieces[other].layer.abs() < layer.abs();
        (0..mesh.pieces.len())
            .filter(inner)
            .filter_map(|piece| {
                let to_host = lies(sheet, &stitches(links, own, piece), &inward)?;
                Some(Host { piece, layers: layer - garment.pieces[piece].layer, to_host })
            })
            .collect()
    };
    let all_folded = |host: &Host| open(mesh, sheet, host.piece).is_empty();
    (0..mesh.pieces.len()).map(|own| of(own).into_iter().filter(|host| !all_folded(host)).collect()).collect()
}

/// How many layers the deepest of the pieces that lie on one of `pieces` lies under it.
pub(super) fn beneath(hosts: &[Vec<Host>], pieces: &[usize]) -> i32 {
    let under = |own: usize| {
        let layers = hosts[own].iter().filter(|host| pieces.contains(&host.piece)).map(|host| -host.layers);
        // Every host is of a layer nearer to 0: this ends.
        layers.max().map(|layers| layers + beneath(hosts, &[own]))
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
    order.sort_by_key(|&piece| (garment.pieces[piece].layer.abs(), piece));
    for own in order {
        let open: Vec<Vec<[u32; 3]>> = hosts[own].iter().map(|host| open(mesh, sheet, host.piece)).collect();
        let grounds: Vec<Ground> =
            hosts[own].iter().zip(&open).map(|(host, open)| Ground::new(mesh, sheet, host, open, x)).collect();
        for p in mesh.pieces[own].particles.clone() {
            let places = grounds.iter().map(|ground| ground.over(sheet, p, x));
            // On the one right under it rather than beyond the rim of another.
            if let Some((_, at)) = places.min_by(|a, b| a.0.total_cmp(&b.0)) {
                x[p] = at;
            }
        }
    }
}

/// The triangles of a piece of which nothing is folded under.
fn open(mesh: &ClothMesh, sheet: &Sheet, piece: usize) -> Vec<[u32; 3]> {
    let open = |t: &&[u32; 3]| t.iter().all(|&n| sheet.under[n as usize] == 0.0);
    mesh.triangles[mesh.pieces[piece].triangles.clone()].iter().filter(open).copied().collect()
}

/// A host in its place.
struct Ground<'a> {
    host: &'a Host,
    locator: Locator<'a>,
    /// Directions out of its right side.
    normals: Vec<Vec3>,
}

impl<'a> Ground<'a> {
    fn new(mesh: &ClothMesh, sheet: &'a Sheet, host: &'a Host, open: &'a [[u32; 3]], x: &[Vec3]) -> Self {
        Self { host, locator: Locator::new(&sheet.drawn, open, mesh.spacing), normals: normals(open, x) }
    }

    /// How far particle `p` lies beyond the host's rim in the flat, metres, and where it comes to lie.
    fn over(&self, sheet: &Sheet, p: usize, x: &[Vec3]) -> (f64, Vec3) {
        let at = (self.host.to_host * Point2::from(sheet.drawn[p])).coords;
        let (corners, weights) = self.locator.place(at);
        let within = weights.map(|w| w.clamp(0.0, 1.0));
        let within = within.map(|w| w / within.iter().sum::<f64>());
        let nearest: Vec2 = corners.iter().zip(within).map(|(&n, w)| sheet.drawn[n as usize] * w).sum();
        // Beyond its rim the host goes straight on, and faces where it faces there.
        let ground: Vec3 = corners.iter().zip(weights).map(|(&n, w)| x[n as usize] * w).sum();
        let out: Vec3 = corners.iter().zip(within).map(|(&n, w)| self.normals[n as usize] * w).sum();
        let layers = f64::from(self.host.layers) - sheet.under[p];
        ((at - nearest).norm(), ground + out.try_normalize(0.0).unwrap_or_default() * (LAYER * layers))
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
