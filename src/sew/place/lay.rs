//! Pieces that lie on others: facings and linings start where they will be, over the cloth they are sewn to, as many
//! layers nearer to the body or further from it as the garment says.

use nalgebra::{Isometry2, Point2, UnitComplex};

use super::assign::Assigned;
use super::fold::FoldedPieces;
use super::ring::LAYER;
use super::rows::{Link, links};
use crate::geometry::{Locator, TriMesh, Vec2, Vec3};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// Sides that do not match within this once the piece is turned and shifted, metres RMS, are gathered, or go round
/// another way: such a piece has a place in a row of its own.
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

/// For every piece how it lies on others; `None` for those that have a place in a row.
pub(super) fn laid(
    garment: &Garment,
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    assigned: &[Assigned],
    links: &[Link],
) -> Vec<Option<Laid>> {
    let table = Table { garment, mesh, sheet, links, inward: inward(mesh, sheet) };
    let movable = |own: &usize| !garment.pieces[*own].has_position() && garment.pieces[*own].layer != 0;
    let pieces: Vec<usize> = (0..mesh.pieces.len()).filter(movable).collect();
    let mut out: Vec<Option<Laid>> = vec![None; mesh.pieces.len()];
    for &own in &pieces {
        out[own] = table.on_what_it_is_sewn_to(own);
    }
    // A lining goes on from its facing, over the cloth that lies under both: all of it round one body part, or none.
    let rest = pieces.into_iter().filter(|&own| out[own].is_none()).collect();
    for group in table.groups(rest, |piece| assigned[piece].part) {
        let found: Option<Vec<Laid>> = group.iter().map(|&own| table.beside_laid(own, &out)).collect();
        for (own, laid) in group.into_iter().zip(found.into_iter().flatten()) {
            out[own] = Some(laid);
        }
    }
    out
}

/// For every piece how it lies on others, if it is one of `pieces`: on those that are not, and on one another.
pub(in crate::sew) fn laid_on_rest(
    garment: &Garment,
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    pieces: &[usize],
) -> Vec<Option<Laid>> {
    let links = links(mesh, sheet);
    let table = Table { garment, mesh, sheet, links: &links, inward: inward(mesh, sheet) };
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
    links: &'a [Link],
    inward: Vec<Vec2>,
}

impl Table<'_> {
    /// These pieces in groups that are sewn together within their layer, round one body part.
    fn groups<P: PartialEq>(&self, mut rest: Vec<usize>, part: impl Fn(usize) -> P) -> Vec<Vec<usize>> {
        let place = |piece: usize| (self.garment.pieces[piece].level(), part(piece));
        let joined = |a: usize, b: usize| {
            place(a) == place(b) && self.links.iter().any(|l| l.pieces == [a, b] || l.pieces == [b, a])
        };
        let mut out = Vec::new();
        while let Some(first) = rest.pop() {
            let mut group = vec![first];
            let mut next = 0;
            while next < group.len() {
                let (near, far): (Vec<usize>, _) = rest.iter().partition(|&&other| joined(group[next], other));
                group.extend(near);
                (rest, next) = (far, next + 1);
            }
            out.push(group);
        }
        out
    }

    /// On pieces nearer to the shell that its sides match and whose cloth goes the same way from there.
    fn on_what_it_is_sewn_to(&self, own: usize) -> Option<Laid> {
        let layer = self.garment.pieces[own].layer.unsigned_abs();
        self.on(own, |other| self.garment.pieces[*other].layer.unsigned_abs() < layer)
    }

    /// On pieces of which it may lie on, that its sides match and whose cloth goes the same way from there.
    fn on(&self, own: usize, may: impl Fn(&usize) -> bool) -> Option<Laid> {
        let lies_on = |piece: usize| {
            let to_host = self.matched(own, piece, SeamWay::Same)?;
            Some(Host { piece, layers: layers_over(self.garment, own, piece), to_host })
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
        let stitches = stitches(self.links, own, other);
        let ends: Vec<[Vec2; 2]> = stitches.iter().map(|pair| pair.map(|p| self.sheet.drawn[p as usize])).collect();
        let to_other = fit(&ends)?;
        let misfit: f64 = ends.iter().map(|[a, b]| ((to_other * Point2::from(*a)).coords - b).norm_squared()).sum();
        let inward = stitches.iter().map(|pair| pair.map(|p| self.inward[p as usize]));
        let same_way = inward.map(|[a, b]| (to_other * a).dot(&b)).sum::<f64>() > 0.0;
        (misfit <= MISFIT * MISFIT * ends.len() as f64 && same_way == (way == SeamWay::Same)).then_some(to_other)
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
                drawn: &self.sheet.drawn,
                locator: Locator::new(&self.sheet.drawn, open, self.mesh.spacing),
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

/// Where the cloth of a piece goes from a seam: over the other piece, or on from it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SeamWay {
    Same,
    On,
}

/// The same links, but from what lies on a host to the nearest of that host's particles:
/// rows know nothing of what is laid.
pub(super) fn through(links: Vec<Link>, mesh: &ClothMesh, laid: &[Option<Laid>]) -> Vec<Link> {
    let mut out = Vec::new();
    for link in links {
        let Some(k) = (0..2).find(|&k| laid[link.pieces[k]].is_some() && laid[link.pieces[1 - k]].is_none()) else {
            out.push(link);
            continue;
        };
        let below = |p: u32| under(mesh, laid, link.pieces[k], p);
        let ends: Vec<(usize, [u32; 2])> = link
            .pairs
            .iter()
            .map(|pair| {
                let (piece, p) = below(pair[k]);
                (piece, if k == 0 { [p, pair[1]] } else { [pair[0], p] })
            })
            .collect();
        for run in ends.chunk_by(|a, b| a.0 == b.0).filter(|run| run[0].0 != link.pieces[1 - k]) {
            let mut pieces = link.pieces;
            pieces[k] = run[0].0;
            let share = run.len() as f64 / ends.len() as f64;
            let pairs = run.iter().map(|(_, pair)| *pair).collect();
            out.push(Link { pieces, pairs, length: link.length * share, through: true, ..link });
        }
    }
    out
}

/// The piece in a row, and its particle, that particle `p` of `piece` lies over.
fn under(mesh: &ClothMesh, laid: &[Option<Laid>], mut piece: usize, mut p: u32) -> (usize, u32) {
    // Every host is of a layer nearer to 0: this ends.
    while let Some(on) = &laid[piece] {
        let (host, spot) = &on.spots[p as usize - mesh.pieces[piece].particles.start];
        let largest = (0..3).max_by(|&a, &b| spot.within[a].total_cmp(&spot.within[b])).unwrap_or(0);
        (piece, p) = (on.hosts[*host].piece, spot.corners[largest]);
    }
    (piece, p)
}

/// How many layers the deepest of the pieces that lie on one of `pieces` lies under it.
pub(super) fn beneath(laid: &[Option<Laid>], pieces: &[usize]) -> i32 {
    let under = |own: usize| {
        let hosts = &laid[own].as_ref()?.hosts;
        let layers = hosts.iter().filter(|host| pieces.contains(&host.piece)).map(|host| host.layers.saturating_neg());
        // Every host is of a layer nearer to 0: this ends.
        layers.max().map(|layers| layers.saturating_add(beneath(laid, &[own])))
    };
    (0..laid.len()).filter_map(under).fold(0, i32::max)
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

/// Where the cloth lies from every particle: on average over its triangles, metres; about nothing inside a piece.
fn inward(mesh: &ClothMesh, sheet: &FoldedPieces) -> Vec<Vec2> {
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
    for (own, laid) in order {
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
    drawn: &'a [Vec2],
    locator: Locator<'a>,
}

impl Ground<'_> {
    /// The spot of the host on which particle `p` lies.
    fn under(&self, p: usize) -> HostSpot {
        let at = (self.to_host * Point2::from(self.drawn[p])).coords;
        let (corners, weights) = self.locator.place(at);
        let within = weights.map(|w| w.clamp(0.0, 1.0));
        let within = within.map(|w| w / within.iter().sum::<f64>());
        let nearest: Vec2 = corners.iter().zip(within).map(|(&n, w)| self.drawn[n as usize] * w).sum();
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
