//! From the nodes of the inflated surface to a start of all particles: what lies on other cloth is laid on it.

use super::clear::{Ply, clear};
use super::glue::{Beyond, Follow, Glued, ROUNDING};
use super::tails::into;
use crate::geometry::{Locator, TriMesh, Vec2, Vec3};
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::Garment;
use crate::sew::Stitching;
use crate::sew::place::fold::pressed;
use crate::sew::place::lay::{self, LAYER, Laid};

/// Laps and collars start so far out of what they lie on, metres: chords of 25 mm lie 2 mm within the circle of a
/// wrist, of either layer. Pleats and hems lie flatter.
pub(super) const PLY: f64 = 8e-3;

/// Either side of an open front is drawn back by this much from where the two were welded, metres. Cloth that starts on
/// the same spot as other cloth cannot get away from it: no motion is safe, and it is held there for good.
const UNZIPPED: f64 = 3e-3;

/// A seam's direction is read over so many stitches on either side.
const ALONG: usize = 2;

/// A piece that reaches over more seams than this lies on no cloth.
const SEAMS: usize = 3;

/// Where every particle starts when the nodes of the glued surface are at `nodes`.
pub(super) fn particles(garment: &Garment, mesh: &ClothMesh, glued: &Glued, nodes: &[Vec3]) -> Vec<Vec3> {
    let covered = glued.laps.iter().flat_map(|lap| &lap.covered).map(|(p, on)| (*p as usize, *on)).collect();
    let hidden = glued.follows.iter().enumerate().filter_map(|(p, on)| Some((p, (*on)?))).collect();
    let mut laying = ParticleLaying::new(mesh, glued, nodes);
    laying.unzip(mesh, glued);
    laying.follow(covered);
    laying.lift(mesh, glued);
    laying.cross(mesh, glued);
    laying.follow(hidden);
    let seams = SeamJoints::new(mesh);
    hang(garment, mesh, &seams, glued, &mut laying);
    let laid = laying.lay_flat(garment, mesh, glued);
    let has_no_place = |piece: &&usize| mesh.pieces[**piece].particles.clone().any(|p| laying.x[p].is_none());
    let mut left: Vec<usize> = glued.left_out.iter().filter(has_no_place).copied().collect();
    left.sort_by_key(|piece| (garment.pieces[*piece].layer.unsigned_abs(), *piece));
    // A piece may be sewn to others that are left out only: these come first.
    while let Some(k) = left.iter().position(|piece| lay(garment, mesh, &seams, &laid, *piece, &mut laying)) {
        left.remove(k);
    }
    let middle = nodes.iter().sum::<Vec3>() / nodes.len().max(1) as f64;
    let mut x: Vec<Vec3> = laying.x.into_iter().map(|p| p.unwrap_or(middle)).collect();
    clear(mesh, &laying.plies, &mut x);
    x
}

/// Particles on their way to a place.
struct ParticleLaying {
    /// Where they lie; `None` for those that have no place yet.
    x: Vec<Option<Vec3>>,
    /// How those that have one lie over the surface.
    plies: Vec<Ply>,
}

impl ParticleLaying {
    /// The particles of the surface at its nodes.
    fn new(mesh: &ClothMesh, glued: &Glued, nodes: &[Vec3]) -> Self {
        let surface = TriMesh { vertices: nodes.to_vec(), triangles: glued.triangles.clone() };
        let inward = surface.vertex_normals();
        let outward = |p: usize| glued.node_of[p].map_or_else(Vec3::zeros, |n| -inward[n as usize]);
        Self {
            x: glued.node_of.iter().map(|n| n.map(|n| nodes[n as usize])).collect(),
            plies: (0..mesh.flat.len()).map(|p| Ply { outward: outward(p), height: 0.0 }).collect(),
        }
    }

    /// Draws the two sides of open fronts and slits apart, each into its own cloth and with all that is sewn to it.
    fn unzip(&mut self, mesh: &ClothMesh, glued: &Glued) {
        let class = Stitching::new(mesh).class;
        let class = |p: u32| class[p as usize] as usize;
        let mut is_zipped = vec![false; self.x.len()];
        let apart = glued.zips.iter().filter(|[a, b]| class(*a) != class(*b));
        apart.flatten().for_each(|p| is_zipped[class(*p)] = true);
        let mut inward = vec![Vec3::zeros(); self.x.len()];
        for corners in &mesh.triangles {
            let Some(x) = at_all(&self.x, *corners) else { continue };
            let middle = (x[0] + x[1] + x[2]) / 3.0;
            corners.iter().zip(x).for_each(|(p, x)| inward[class(*p)] += middle - x);
        }
        for (p, x) in self.x.iter_mut().enumerate() {
            let class = class(p as u32);
            if let Some(x) = x.as_mut().filter(|_| is_zipped[class]) {
                *x += inward[class].cap_magnitude(UNZIPPED);
            }
        }
    }

    /// Puts particles on the cloth that they lie on, which may lie on other cloth itself.
    fn follow(&mut self, mut left: Vec<(usize, Follow)>) {
        let own = self.x.clone();
        left.iter().for_each(|(p, _)| self.x[*p] = None);
        loop {
            let before = left.len();
            let from = self.x.clone();
            left.retain(|(p, follow)| {
                let Some(corners) = at_all(&from, follow.corners) else { return true };
                let at: Vec3 = corners.iter().zip(follow.weights).map(|(v, w)| v * w).sum();
                let ply = self.on(follow.corners, follow.weights, follow.share * follow.layers * LAYER);
                let on = at + ply.outward * (follow.layers * LAYER);
                self.x[*p] = Some(own[*p].map_or(on, |own| own.lerp(&on, follow.share)));
                self.plies[*p] = ply;
                false
            });
            if left.len() == before || left.is_empty() {
                return;
            }
        }
    }

    /// How cloth lies that is so far off a place on other cloth, metres.
    fn on(&self, corners: [u32; 3], weights: [f64; 3], off: f64) -> Ply {
        let plies = corners.map(|c| self.plies[c as usize]);
        let outward: Vec3 = plies.iter().zip(weights).map(|(ply, w)| ply.outward * w).sum();
        let height: f64 = plies.iter().zip(weights).map(|(ply, w)| ply.height * w).sum();
        Ply { outward: outward.try_normalize(0.0).unwrap_or_default(), height: height + off }
    }

    /// Lifts what laps over other cloth off it: the rim, and the cloth that covers, with all that is sewn to it. Cloth
    /// that is sewn to the cloth below as well stays.
    fn lift(&mut self, mesh: &ClothMesh, glued: &Glued) {
        let class = Stitching::new(mesh).class;
        let class = |p: u32| class[p as usize] as usize;
        let mut lifted = vec![0.0; self.x.len()];
        for lap in &glued.laps {
            let under = lap.covered.iter().filter(|(_, on)| on.layers == 0.0);
            let covering = under.flat_map(|(_, on)| on.corners);
            lap.pairs.iter().map(|pair| pair[0]).chain(covering).for_each(|p| lifted[class(p)] = lap.plies);
        }
        for lap in &glued.laps {
            let below = lap.covered.iter().map(|covered| covered.0);
            lap.pairs.iter().map(|pair| pair[1]).chain(below).for_each(|p| lifted[class(p)] = 0.0);
        }
        for (p, (x, ply)) in self.x.iter_mut().zip(&mut self.plies).enumerate() {
            let plies = lifted[class(p as u32)];
            if let Some(x) = x.as_mut().filter(|_| plies > 0.0) {
                *x += ply.outward * (PLY * plies);
                ply.height += PLY * plies;
            }
        }
    }

    /// Leads the ends of crossed straps to their places, one strap over the other.
    fn cross(&mut self, mesh: &ClothMesh, glued: &Glued) {
        let before = self.x.clone();
        for crossed in &glued.crossed {
            let Some(way) = crossed.way(&before) else { continue };
            for (p, left) in crossed.slanted(mesh, glued) {
                let share = left * left * (3.0 - 2.0 * left);
                let lifted = if crossed.is_over { 4.0 * left * (1.0 - left) * PLY } else { 0.0 };
                self.plies[p].height += lifted;
                let outward = self.plies[p].outward;
                self.x[p] = self.x[p].map(|x| x + way * share + outward * lifted);
            }
        }
    }

    /// Lays what is left out on the cloth that its flat sides match. Returns how every piece lies that does.
    fn lay_flat(&mut self, garment: &Garment, mesh: &ClothMesh, glued: &Glued) -> Vec<Option<Laid>> {
        let sheet = pressed(garment, mesh);
        let laid = lay::laid_on_rest(garment, mesh, &sheet, &glued.left_out);
        let mut placed: Vec<Vec3> = self.x.iter().map(|p| p.unwrap_or_default()).collect();
        lay::lay(garment, mesh, &sheet, &laid, &mut placed);
        let inward = TriMesh { vertices: placed.clone(), triangles: mesh.triangles.clone() }.vertex_normals();
        for (piece, _) in laid.iter().enumerate().filter(|(_, laid)| laid.is_some()) {
            let layer = f64::from(garment.pieces[piece].layer);
            for p in mesh.pieces[piece].particles.clone() {
                self.x[p] = Some(placed[p]);
                self.plies[p] = Ply { outward: -inward[p], height: LAYER * (layer - sheet.under[p]) };
            }
        }
        laid
    }
}

/// Positions of three particles that have one.
fn at_all(x: &[Option<Vec3>], corners: [u32; 3]) -> Option<[Vec3; 3]> {
    let [a, b, c] = corners.map(|c| x[c as usize]);
    Some([a?, b?, c?])
}

/// A stitch of a piece that is laid, with the directions along the seam and across it: flat, flat on the host and in
/// space. Across goes into the host's cloth.
struct Stitch {
    flat: Vec2,
    flat_along: Vec2,
    flat_across: Vec2,
    host: usize,
    host_flat: Vec2,
    host_along: Vec2,
    host_across: Vec2,
    place: Vec3,
    along: Vec3,
    across: Vec3,
    outward: Vec3,
    layers: f64,
}

/// A stitch seen from one of its pieces.
struct StitchSide {
    pieces: [usize; 2],
    at: u32,
    to: u32,
    /// Unit directions along the seam, flat.
    along: [Vec2; 2],
}

/// The stitches before and after stitch `i` of so many that its seam's direction is read from.
fn beside_stitch(i: usize, count: usize) -> [usize; 2] {
    [i.saturating_sub(ALONG), (i + ALONG).min(count - 1)]
}

/// All stitches, from either side.
fn joints(mesh: &ClothMesh) -> Vec<StitchSide> {
    let mut out = Vec::new();
    for seam in &mesh.seams {
        for (i, pair) in seam.pairs.iter().enumerate() {
            let run = beside_stitch(i, seam.pairs.len()).map(|k| seam.pairs[k]);
            let way = |k: usize| (mesh.flat[run[1][k] as usize] - mesh.flat[run[0][k] as usize]).try_normalize(0.0);
            let pieces = pair.map(|p| mesh.piece_of(p));
            if let ([Some(one), Some(other)], Some(a), Some(b)) = (pieces, way(0), way(1)) {
                out.push(StitchSide { pieces: [one, other], at: pair[0], to: pair[1], along: [a, b] });
                out.push(StitchSide { pieces: [other, one], at: pair[1], to: pair[0], along: [b, a] });
            }
        }
    }
    out
}

/// The cloth that pieces are laid on: it has a place already.
struct Hosts<'a> {
    garment: &'a Garment,
    mesh: &'a ClothMesh,
    /// The triangles of every piece of which all corners have a place.
    grounds: Vec<Option<Locator<'a>>>,
    seams: &'a SeamJoints,
    /// How pieces lie flat on others.
    laid: &'a [Option<Laid>],
}

/// The joints of all seams, whether their cloth has a place or not.
struct SeamJoints {
    classes: Classes,
    joints: Vec<StitchSide>,
}

impl SeamJoints {
    fn new(mesh: &ClothMesh) -> Self {
        Self { classes: Classes::new(mesh), joints: joints(mesh) }
    }
}

/// For every piece its triangles of which all corners have a place.
fn open(mesh: &ClothMesh, x: &[Option<Vec3>]) -> Vec<Vec<[u32; 3]>> {
    let has_place = |t: &&[u32; 3]| t.iter().all(|p| x[*p as usize].is_some());
    let of_piece = |piece: &PieceMesh| mesh.triangles[piece.triangles.clone()].iter().filter(has_place).copied();
    mesh.pieces.iter().map(|piece| of_piece(piece).collect()).collect()
}

impl<'a> Hosts<'a> {
    fn new(
        garment: &'a Garment,
        mesh: &'a ClothMesh,
        seams: &'a SeamJoints,
        laid: &'a [Option<Laid>],
        open: &'a [Vec<[u32; 3]>],
    ) -> Self {
        let ground = |open: &'a Vec<[u32; 3]>| (!open.is_empty()).then(|| Locator::new(&mesh.flat, open, mesh.spacing));
        Self { garment, mesh, grounds: open.iter().map(ground).collect(), seams, laid }
    }

    /// Lays a particle so far along a seam from a stitch and across it into the host's cloth, metres, and so many
    /// layers out of that.
    fn place(&self, p: usize, near: &Stitch, [along, across]: [f64; 2], layers: f64, laying: &mut ParticleLaying) {
        let straight_on = || near.place + near.along * along + near.across * across;
        let at = near.host_flat + near.host_along * along + near.host_across * across;
        let (host, at) = self.across_seams(near.host, at, &laying.x);
        let spot = self.grounds[host].as_ref().map(|ground| ground.place(at));
        let on_host = spot.and_then(|(corners, weights)| {
            let [a, b, c] = at_all(&laying.x, corners)?;
            let outward = (c - a).cross(&(b - a)).try_normalize(0.0)?;
            let height = laying.on(corners, weights, 0.0).height;
            Some((a * weights[0] + b * weights[1] + c * weights[2], Ply { outward, height }))
        });
        let beside = || (straight_on(), Ply { outward: near.outward, height: 0.0 });
        let (at, ply) = on_host.unwrap_or_else(beside);
        laying.x[p] = Some(at + ply.outward * (layers * PLY));
        laying.plies[p] = Ply { height: ply.height + layers * PLY, ..ply };
    }

    /// Where a flat place beyond the sewn rim of a piece lies on the cloth that goes on from there.
    fn across_seams(&self, mut host: usize, mut at: Vec2, x: &[Option<Vec3>]) -> (usize, Vec2) {
        let mesh = self.mesh;
        for _ in 0..SEAMS {
            let is_inside = |ground: &Locator| ground.place(at).1.iter().all(|weight| *weight >= -ROUNDING);
            if self.grounds[host].as_ref().is_none_or(is_inside) {
                break;
            }
            let far = |joint: &&StitchSide| (mesh.flat[joint.at as usize] - at).norm();
            let own =
                self.seams.joints.iter().filter(|joint| joint.pieces[0] == host && x[joint.to as usize].is_some());
            let Some(joint) = own.min_by(|a, b| far(a).total_cmp(&far(b))) else { break };
            let off = at - mesh.flat[joint.at as usize];
            let [along, out] = [off.dot(&joint.along[0]), -off.dot(&into(mesh, host, joint.at, joint.along[0]))];
            if out <= 0.0 || along.abs() > mesh.spacing {
                break;
            }
            let inward = into(mesh, joint.pieces[1], joint.to, joint.along[1]);
            (host, at) = (joint.pieces[1], mesh.flat[joint.to as usize] + joint.along[1] * along + inward * out);
        }
        (host, at)
    }

    /// The stitches of a piece with cloth that has a place: with what it is sewn to, or with the cloth on its own side
    /// of the seam.
    fn stitches(&self, piece: usize, on: On, x: &[Option<Vec3>]) -> Vec<Stitch> {
        let own = |p: u32| self.mesh.pieces[piece].particles.contains(&(p as usize));
        let mut out = Vec::new();
        for seam in &self.mesh.seams {
            let side = |k: usize| seam.pairs.iter().all(|pair| own(pair[k]) && !own(pair[1 - k]));
            let Some(k) = (0..2).find(|&k| side(k)) else { continue };
            let pairs: Vec<[u32; 2]> = seam.pairs.iter().map(|pair| [pair[k], pair[1 - k]]).collect();
            out.extend((0..pairs.len()).filter_map(|i| self.stitch(piece, &pairs, i, on, x)));
        }
        out
    }

    /// Stitch `i` of a seam, of which the first of every pair is the piece's own.
    fn stitch(&self, piece: usize, pairs: &[[u32; 2]], i: usize, on: On, x: &[Option<Vec3>]) -> Option<Stitch> {
        let (garment, mesh) = (self.garment, self.mesh);
        let run = beside_stitch(i, pairs.len());
        let [p, q] = pairs[i];
        let way = |[a, b]: [u32; 2]| (mesh.flat[b as usize] - mesh.flat[a as usize]).try_normalize(0.0);
        let flat_along = way(run.map(|i| pairs[i][0]))?;
        let flat_across = into(mesh, piece, p, flat_along);
        let own_side = flat_along.perp(&flat_across);
        let sewn_to = (mesh.piece_of(q)?, [run[0], i, run[1]].map(|i| pairs[i][1]));
        let beyond = self.beyond(piece, own_side, pairs, [run[0], i, run[1]], x).filter(|_| on == On::OwnSide);
        let (host, [low, q, high]) = beyond.unwrap_or(sewn_to);
        let host_along = way([low, high])?;
        let host_across = into(mesh, host, q, host_along);
        // Without cloth on its own side it goes straight on from what it is sewn to.
        let over = if on == On::OwnSide && host_along.perp(&host_across) * own_side < 0.0 { -1.0 } else { 1.0 };
        let along = (x[high as usize]? - x[low as usize]?).try_normalize(0.0)?;
        let (across, outward) = beside(mesh, host, q, along, x)?;
        let below = (beyond.is_none() && over < 0.0).then(|| self.below(host, q, [host_along, -host_across])).flatten();
        let on_own = || (host, mesh.flat[q as usize], [host_along, host_across * over]);
        let (host, host_flat, [host_along, host_across]) = below.unwrap_or_else(on_own);
        Some(Stitch {
            flat: mesh.flat[p as usize],
            flat_along,
            flat_across,
            host,
            host_flat,
            host_along,
            host_across,
            place: x[q as usize]?,
            along,
            across: across * over,
            outward,
            layers: f64::from(lay::layers_over(garment, piece, host)),
        })
    }

    /// The cloth that a piece lies flat on at its particle `q`: its piece, the place of the particle on it, and two
    /// directions of the piece there. A lining goes on from its facing over the cloth that lies under both.
    fn below(&self, piece: usize, q: u32, ways: [Vec2; 2]) -> Option<(usize, Vec2, [Vec2; 2])> {
        let laid = self.laid.get(piece)?.as_ref()?;
        let k = q as usize - self.mesh.pieces[piece].particles.start;
        let (host, at) = laid.under(k, self.mesh.flat[q as usize]);
        Some((host, at, ways.map(|way| laid.turned(k, way))))
    }

    /// The cloth of another piece that has a place and goes from a seam to the same side as the piece's own, and its
    /// particles in these three stitches.
    fn beyond(
        &self,
        piece: usize,
        own_side: f64,
        pairs: &[[u32; 2]],
        at: [usize; 3],
        x: &[Option<Vec3>],
    ) -> Option<(usize, [u32; 3])> {
        let sewn = |i: usize| self.seams.classes.of(pairs[i][1]).iter().filter(|p| x[**p as usize].is_some());
        sewn(at[1]).find_map(|&q| {
            let host = self.mesh.piece_of(q).filter(|host| *host != piece)?;
            let particles = &self.mesh.pieces[host].particles;
            let near = |i: usize| {
                let of_host = sewn(i).filter(|p| particles.contains(&(**p as usize)));
                of_host.copied().min_by(|a, b| self.apart(*a, q).total_cmp(&self.apart(*b, q)))
            };
            let (low, high) = (near(at[0])?, near(at[2])?);
            let along = (self.mesh.flat[high as usize] - self.mesh.flat[low as usize]).try_normalize(0.0)?;
            let side = along.perp(&into(self.mesh, host, q, along));
            (side * own_side > 0.0).then_some((host, [low, q, high]))
        })
    }

    /// How far two particles of a piece are apart in the drawing, metres.
    fn apart(&self, a: u32, b: u32) -> f64 {
        (self.mesh.flat[a as usize] - self.mesh.flat[b as usize]).norm()
    }
}

/// The cloth that a piece is laid on along a seam.
#[derive(Clone, Copy, Debug, PartialEq)]
enum On {
    /// The cloth it is sewn to.
    SewnTo,
    /// The cloth on its own side of the seam; without any it goes straight on.
    OwnSide,
}

/// The particles that are sewn together.
struct Classes {
    class: Vec<u32>,
    members: Vec<Vec<u32>>,
}

impl Classes {
    fn new(mesh: &ClothMesh) -> Self {
        let Stitching { class, classes, .. } = Stitching::new(mesh);
        let mut members = vec![Vec::new(); classes];
        class.iter().enumerate().for_each(|(p, c)| members[*c as usize].push(p as u32));
        Self { class, members }
    }

    /// Those that a particle is sewn to, itself among them.
    fn of(&self, p: u32) -> &[u32] {
        &self.members[self.class[p as usize] as usize]
    }
}

/// The stitch nearest to a flat point.
fn nearest(stitches: &[Stitch], at: Vec2) -> Option<&Stitch> {
    let far = |s: &Stitch| (s.flat - at).norm_squared();
    stitches.iter().min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// Lays a piece from its seams over the cloth that it is sewn to. Returns whether it is sewn to any that has a place.
fn lay(
    garment: &Garment,
    mesh: &ClothMesh,
    seams: &SeamJoints,
    laid: &[Option<Laid>],
    piece: usize,
    laying: &mut ParticleLaying,
) -> bool {
    let open = open(mesh, &laying.x);
    let hosts = Hosts::new(garment, mesh, seams, laid, &open);
    let stitches = hosts.stitches(piece, On::OwnSide, &laying.x);
    if stitches.is_empty() {
        return false;
    }
    let own = &mesh.pieces[piece];
    for p in own.particles.clone() {
        let flat = mesh.flat[p];
        let Some(near) = nearest(&stitches, flat) else { continue };
        let off = flat - near.flat;
        hosts.place(p, near, [off.dot(&near.flat_along), off.dot(&near.flat_across)], near.layers, laying);
    }
    true
}

/// Puts what is turned over beyond the seam of its piece on the cloth beyond that seam, as a collar falls over its
/// stand.
fn hang(garment: &Garment, mesh: &ClothMesh, seams: &SeamJoints, glued: &Glued, laying: &mut ParticleLaying) {
    for (i, piece) in mesh.pieces.iter().enumerate() {
        let is_own = |beyond: &&Beyond| piece.particles.contains(&(beyond.particle as usize));
        let own: Vec<&Beyond> = glued.beyond.iter().filter(is_own).collect();
        if own.is_empty() {
            continue;
        }
        let open = open(mesh, &laying.x);
        let hosts = Hosts::new(garment, mesh, seams, &[], &open);
        let stitches = hosts.stitches(i, On::SewnTo, &laying.x);
        for beyond in own {
            let Some(near) = nearest(&stitches, beyond.at) else { continue };
            let off = beyond.at - near.flat;
            let [along, across] = [off.dot(&near.flat_along), -off.dot(&near.flat_across)];
            hosts.place(beyond.particle as usize, near, [along, across], beyond.layers, laying);
        }
    }
}

/// The directions across a seam into the host's cloth, and out of its right side, at one of its particles.
fn beside(mesh: &ClothMesh, host: usize, q: u32, along: Vec3, x: &[Option<Vec3>]) -> Option<(Vec3, Vec3)> {
    let (mut inward, mut outward) = (Vec3::zeros(), Vec3::zeros());
    for t in mesh.triangles[mesh.pieces[host].triangles.clone()].iter().filter(|t| t.contains(&q)) {
        let [a, b, c] = at_all(x, *t)?;
        outward += (c - a).cross(&(b - a));
        inward += (a + b + c) / 3.0 - x[q as usize]?;
    }
    let across = (inward - along * inward.dot(&along)).try_normalize(1e-12)?;
    let outward = (outward - along * outward.dot(&along) - across * outward.dot(&across)).try_normalize(0.0)?;
    Some((across, outward))
}
