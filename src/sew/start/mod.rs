//! Where a garment starts: from its own topology.
//!
//! ```text
//! mesh ─▶ glue ─────────▶ openings ─────────▶ deal ──────────────▶ rings ─▶ star ─────────▶ balloon
//!          one surface     its rims, with      which part of the    round    passes nowhere   inflated round
//!          per part        length and girth    body passes through  the      through itself,  axes that grow
//!                                              each                 axes     the axes within  to the body
//! ```
//!
//! A sewn garment is a surface with openings, and a part of the body passes through each opening: that is all that a
//! start must get right.

mod axes;
mod backing;
mod balloon;
mod circles;
mod clear;
mod cloth;
mod cost;
mod cover;
mod crossing;
mod deal;
mod deal_error;
mod ends;
mod facing;
mod girths;
mod glue;
mod hand_over;
mod harmonic;
mod laps;
mod layers;
mod lids;
mod marks;
mod openings;
mod outside;
mod profile;
mod reach;
mod ribbon;
mod rings;
mod sections;
mod sides;
mod sketch;
mod slit;
mod star;
mod surface;
mod tails;
mod unfold;
mod way_out;
mod winding;
mod words;
mod zip;

use std::collections::BTreeSet;
use std::f64::consts::PI;

pub use cloth::Distances;
pub use crossing::{CrossedEnd, uncrossed};
pub use deal::{CLEAR, Dealing, deal, guess};
pub use deal_error::{DealError, Doubt, edges};
pub use ends::{End, Ends};
pub use glue::{Follow, Glued, glue};
pub use laps::Lap;
pub use openings::{GluedOpening, openings};
pub use sketch::{Sketch, SketchedOpening, sketch};
pub use words::Settling;

use crate::contact::Collider;
use crate::geometry::{DisjointSets, MM, Vec3};
use crate::mannequin::{Mannequin, PartKind};
use crate::mesh::{self, ClothMesh, PieceMesh, Transfer};
use crate::pattern::{Garment, PlaceWord, TrunkLevel};
use crate::sew::place::PlaceError;
use axes::{Axes, Axis, RaisedArms};
use balloon::{Balloon, Held, Length, STRAP};
use circles::Mouth;
use harmonic::{Film, Limb, OpeningRing, angles};
use lids::{Lid, LidShares};
use profile::Profile;
use rings::{FIRST, WornOpenings, limb_of};
use sections::sections;
use star::GluedPart;

/// Garments start on a mesh of this spacing, metres, whatever is asked for: it costs a second or two, and a finer one
/// starts no better on the average.
pub const SPACING: f64 = 0.025;

/// A hood or a collar is on this share of the nodes of its rim. The tips of fronts may be on it besides.
const ALL_ROUND: f64 = 0.8;

/// Where every particle of `to` starts on a body: glued along its seams, round the parts that its openings are for.
/// `collider` is the body's surface. The better dealing counts where two are about as good.
///
/// # Errors
/// [`PlaceError`] when a part of the garment has no opening that a part of the body passes through.
pub fn start(
    garment: &Garment,
    to: &ClothMesh,
    body: &Mannequin,
    collider: &Collider,
) -> Result<Vec<Vec3>, PlaceError> {
    start_at(SPACING, garment, to, body, collider)
}

/// [`start`] on another mesh of the garment than that of [`SPACING`], metres; on `to` itself where it cannot be meshed
/// so.
pub(crate) fn start_at(
    spacing: f64,
    garment: &Garment,
    to: &ClothMesh,
    body: &Mannequin,
    collider: &Collider,
) -> Result<Vec<Vec3>, PlaceError> {
    match mesh::build(garment, spacing) {
        Ok(on) => start_on(&on, garment, to, body, collider),
        Err(_) => start_on(to, garment, to, body, collider),
    }
}

/// [`start`] by way of `mesh`.
pub(crate) fn start_on(
    mesh: &ClothMesh,
    garment: &Garment,
    to: &ClothMesh,
    body: &Mannequin,
    collider: &Collider,
) -> Result<Vec<Vec3>, PlaceError> {
    let (_, dealt) = Dealt::stages(garment, mesh, body);
    let axes = Axes::of(body);
    let level = dealt.levels(garment, mesh);
    let nodes = dealt.on_film(garment, mesh, &axes, |film| dealt.inflated(mesh, film, &axes, collider));
    let mut nodes = nodes.ok_or_else(|| dealt.unworn(garment, mesh, body))?;
    outside::put_outside(&mut nodes, &dealt.glued.triangles, &level, &axes);
    let x = hand_over::particles(garment, mesh, &dealt.glued, &nodes);
    Ok(Transfer::new(mesh, to).apply(&x))
}

/// Whether some opening of a garment has one leg through it, as those of trousers, leotards and leg warmers.
pub(super) fn goes_between_legs(garment: &Garment, body: &Mannequin) -> bool {
    let Ok(mesh) = mesh::build(garment, SPACING) else { return false };
    let one_leg = |ends: &Ends| ends.has(Ends::LEFT_LEG) != ends.has(Ends::RIGHT_LEG);
    Dealt::stages(garment, &mesh, body).1.dealing.ends.iter().any(one_leg)
}

/// A glued garment on the film between its openings.
struct OnFilm<'a> {
    worn: &'a [WornOpenings<'a>],
    edges: &'a [Length],
    rings: &'a [PartRing],
    limbs: &'a [Limb<'a>],
    /// For each connected part the body that it is put on.
    posed: &'a [Posed],
    nodes: Vec<Vec3>,
}

/// A lid is wide where its rim is longer than so many times the body's largest girth. Narrower ones lift hardly
/// anything.
const WIDE: f64 = 2.0;

/// The lids of the openings of a connected part without sleeves that both legs leave by. Sleeves are held, and keep the
/// pressure from lifting what hangs from them: with the lid of its hem a man's shirt took 33 s of CPU time to sew, and
/// 18 s without.
///
/// Round thin axes what hangs from the shoulders carries all of the pressure on the lid, or its bodice is crushed. Else
/// the cloth carries what a wide lid is larger than the body. Not while the body grows where the garment hangs from
/// straps: when the arms come down that draws a strap off its shoulder.
fn hems(worn: &WornOpenings, part: &GluedPart, axes: &Axes) -> Vec<Lid> {
    let widest = axes.part(PartKind::Torso).map_or(0.0, Axis::widest);
    let has_straps = part.over_shoulder.iter().any(|width| *width < STRAP);
    let shares = |length: f64| {
        let wide = if length > WIDE * widest { 1.0 - (widest / length).powi(2) } else { 0.0 };
        LidShares { axes: if worn.hangs() { 1.0 } else { wide }, body: if has_straps { 0.0 } else { wide } }
    };
    let rims: Vec<&[u32]> = worn.openings.iter().map(|opening| opening.rim.as_slice()).collect();
    let is_hem = |ends: &Ends| ends.has(Ends::LEFT_LEG) && ends.has(Ends::RIGHT_LEG);
    let lids = Lid::all(&part.triangles, &rims, &worn.far).into_iter().zip(&worn.openings);
    let hems = lids.zip(&worn.ends).filter(|(_, ends)| is_hem(ends));
    hems.map(|((lid, opening), _)| lid.sharing(shares(opening.length))).collect()
}

/// The body that a part of a garment is put on.
struct Posed {
    axes: Axes,
    arms: RaisedArms,
    /// Whether an arm is in a sleeve.
    has_sleeves: bool,
}

/// A ring of a connected part.
#[derive(Clone, Debug)]
struct PartRing {
    ring: OpeningRing,
    /// Number of the part.
    part: u32,
    /// The ends of the body that leave by it.
    ends: Ends,
}

/// A glued garment with the ends of the body dealt out to its openings.
struct Dealt {
    glued: Glued,
    openings: Vec<GluedOpening>,
    dealing: Dealing,
    /// The other dealing that fits about as well, if there is one.
    doubt: Option<DealError>,
}

impl Dealt {
    /// Glues a garment and deals; where it has open fronts once more with these closed. Returns it as it is put on, and
    /// before that as it is with its fronts open, if it has any.
    fn stages(garment: &Garment, mesh: &ClothMesh, body: &Mannequin) -> (Option<Self>, Self) {
        let first = Self::with(garment, mesh, body, &[]);
        if first.dealing.zips.is_empty() {
            return (None, first.without_sheets(mesh));
        }
        let closed = Self::with(garment, mesh, body, &first.dealing.zips);
        (Some(first), closed.without_sheets(mesh))
    }

    /// Takes the ends of the body out of the openings of flat sheets: nothing passes through what has no other opening
    /// than its rim, unless it is a bag as a cap is, whose rim is shorter than that of a disk of its area.
    fn without_sheets(mut self, mesh: &ClothMesh) -> Self {
        let mut area = vec![0.0; self.glued.parts() as usize];
        for (k, t) in self.glued.triangles.iter().enumerate() {
            area[self.glued.part_of[t[0] as usize] as usize] += star::flat_area(&self.glued.flat(mesh, k));
        }
        for part in 0..self.glued.parts() {
            let own: Vec<usize> = (0..self.openings.len()).filter(|&k| self.openings[k].part == part).collect();
            if let [only] = own[..]
                && self.openings[only].length.powi(2) >= 4.0 * PI * area[part as usize]
            {
                self.dealing.ends[only] = Ends::NONE;
            }
        }
        self
    }

    fn with(garment: &Garment, mesh: &ClothMesh, body: &Mannequin, zips: &[[u32; 2]]) -> Self {
        let glued = glue(garment, mesh, zips);
        let openings = openings(&glued, mesh);
        let dealing = guess(garment, mesh, &glued, &openings, body);
        let doubt = dealing.doubt(garment, mesh, &glued, &openings);
        Self { glued, openings, dealing, doubt }
    }

    /// The result of `then` for the garment on its film. `None` where a part of it has no opening that anything passes
    /// through.
    fn on_film<T>(
        &self,
        garment: &Garment,
        mesh: &ClothMesh,
        axes: &Axes,
        then: impl FnOnce(OnFilm) -> T,
    ) -> Option<T> {
        let edges = surface::edges(&self.glued, mesh);
        let worn = self.worn(garment, mesh);
        let pose = |part: &WornOpenings| {
            let has_sleeves = part.has_sleeves(&part.rings(axes));
            let arms = match has_sleeves {
                // Under a cape arms hang.
                false if part.find(Ends::ARMS.with(Ends::LEGS)).is_some() => RaisedArms::NONE,
                false => RaisedArms::SIDEWAYS,
                true if part.hangs() => RaisedArms::in_sleeves(axes),
                true => RaisedArms::NONE,
            };
            Posed { axes: arms.pose(axes, 1.0), arms, has_sleeves }
        };
        let posed: Vec<Posed> = worn.iter().map(pose).collect();
        let (rings, limbs) = rings_and_limbs(&worn, &posed, &self.glued, &edges)?;
        let plain: Vec<OpeningRing> = rings.iter().map(|of| of.ring.clone()).collect();
        let nodes = Film::new(self.glued.count, &edges, &plain)?.start(&plain, &limbs);
        Some(then(OnFilm { worn: &worn, edges: &edges, rings: &rings, limbs: &limbs, posed: &posed, nodes }))
    }

    /// Every connected part inflated: from a star, or from its film where it is none.
    fn inflated(&self, mesh: &ClothMesh, film: OnFilm, axes: &Axes, body: &Collider) -> Vec<Vec3> {
        let bending = surface::bending(&self.glued, mesh);
        let piece = |corners: &[u32; 3]| mesh.piece_of(corners[0]).unwrap_or(0) as u32;
        let of_ring = |of: &PartRing| film.worn[of.part as usize].held(of.ends, &of.ring);
        // A strap lies where the cloth round the arm lets it, which is not known: only sleeves are held.
        let is_held = |of: &&PartRing| !limb_of(of.ends).is_some_and(PartKind::is_arm) || of.ring.along > Some(FIRST);
        let sections = film.limbs.iter().flat_map(|limb| sections(&film.rings[limb.ring].ring, limb));
        let held: Vec<Held> = film.rings.iter().filter(is_held).map(of_ring).chain(sections).collect();
        let rims = openings::rims(&self.glued);
        let mut nodes = film.nodes.clone();
        for number in 0..film.worn.len() as u32 {
            let is_own = |n: u32| self.glued.part_of[n as usize] == number;
            let part = self.part(mesh, &film, &rims, number);
            let (worn, posed) = (&film.worn[number as usize], &film.posed[number as usize]);
            let star = part.star(&posed.axes);
            let own = self.glued.triangles.iter().zip(&self.glued.corners).filter(|(t, _)| is_own(t[0]));
            let balloon = Balloon {
                part: &part,
                piece: own.map(|(_, corners)| piece(corners)).collect(),
                bending: bending.iter().filter(|l| is_own(l.ends[0])).copied().collect(),
                held: held.iter().filter(|held| held.rim.first().is_some_and(|n| is_own(*n))).cloned().collect(),
                lids: if posed.has_sleeves { Vec::new() } else { hems(worn, &part, axes) },
                ways: star.as_ref().map_or(&[], |star| &star.ways),
                arms: posed.arms,
                hangs: worn.hangs(),
                neckline: worn.neckline(),
            };
            let x = balloon.inflate(star.as_ref().map_or(&film.nodes, |star| &star.nodes), axes, body);
            (0..x.len()).filter(|n| is_own(*n as u32)).for_each(|n| nodes[n] = x[n]);
        }
        nodes
    }

    /// A connected part; `rims` are all of the garment.
    fn part<'a>(&self, mesh: &ClothMesh, film: &'a OnFilm, rims: &'a [Vec<u32>], number: u32) -> GluedPart<'a> {
        let is_own = |n: u32| self.glued.part_of[n as usize] == number;
        let rings = film.rings.iter().filter(|of| of.part == number);
        let mouths: Vec<Mouth> = rings.map(|of| Mouth { ring: &of.ring, ends: of.ends }).collect();
        let is_hole = |rim: &&Vec<u32>| is_own(rim[0]) && mouths.iter().all(|mouth| mouth.ring.rim != **rim);
        let holes = rims.iter().filter(is_hole).map(Vec::as_slice).collect();
        let worn = &film.worn[number as usize];
        let left = || worn.ends.iter().zip(&worn.far).filter(|(ends, _)| !ends.is_empty());
        let nearest = |n: usize, is_wanted: &dyn Fn(Ends) -> bool| {
            left().filter(|(ends, _)| is_wanted(**ends)).map(|(_, far)| far[n]).fold(f64::INFINITY, f64::min)
        };
        let is_arm = |ends: Ends| limb_of(ends).is_some_and(PartKind::is_arm);
        let far = (0..self.glued.count).map(|n| nearest(n, &|_| true)).collect();
        let over_shoulder = |n: usize| nearest(n, &is_arm) + nearest(n, &|ends| ends.has(Ends::HEAD) && !is_arm(ends));
        let over_shoulder = (0..self.glued.count).map(over_shoulder).collect();
        let own = self.glued.triangles.iter().enumerate().filter(|(_, t)| is_own(t[0]));
        let (triangles, flat) = own.map(|(k, t)| (*t, self.glued.flat(mesh, k))).unzip();
        let edges = film.edges.iter().filter(|l| is_own(l.ends[0])).copied().collect();
        GluedPart { holes, triangles, flat, edges, far, over_shoulder, mouths }
    }

    /// The openings of every connected part.
    fn worn<'a>(&'a self, garment: &Garment, mesh: &'a ClothMesh) -> Vec<WornOpenings<'a>> {
        let cloth = Distances::new(&self.glued, mesh);
        let of_part = |part: u32| {
            let own: Vec<usize> = (0..self.openings.len()).filter(|&k| self.openings[k].part == part).collect();
            let far: Vec<Vec<f64>> = own.iter().map(|&k| cloth.from(&self.openings[k].rim)).collect();
            let profile =
                |(&k, far): (&usize, &Vec<f64>)| Profile::new(&self.glued, &cloth, self.openings[k].length, far);
            WornOpenings {
                flat: &mesh.flat,
                words: self.words(garment, mesh, part),
                above: own.iter().map(|&k| self.above(mesh, &cloth, k)).collect(),
                levels: own.iter().map(|&k| self.levels_on_rim(garment, mesh, k)).collect(),
                openings: own.iter().map(|&k| &self.openings[k]).collect(),
                ends: own.iter().map(|&k| self.dealing.ends[k]).collect(),
                front: own.iter().map(|&k| self.dealing.front[k]).collect(),
                profiles: own.iter().zip(&far).map(profile).collect(),
                far,
            }
        };
        (0..self.glued.parts()).map(of_part).collect()
    }

    /// Why a garment has no start: of the parts that nothing passes through, the first piece.
    fn unworn(&self, garment: &Garment, mesh: &ClothMesh, body: &Mannequin) -> PlaceError {
        let is_worn = |part: u32| {
            let ends = self.openings.iter().zip(&self.dealing.ends);
            ends.into_iter().any(|(opening, ends)| opening.part == part && !ends.is_empty())
        };
        let part = |piece: &PieceMesh| piece.particles.clone().find_map(|p| self.glued.node_of[p]);
        let part = |piece: &PieceMesh| part(piece).map(|n| self.glued.part_of[n as usize]);
        let unworn = mesh.pieces.iter().position(|piece| part(piece).is_some_and(|part| !is_worn(part)));
        let unworn = unworn.unwrap_or(0);
        let (piece, mannequin) = (garment.pieces[unworn].name.clone(), body.name.clone());
        if body.parts.is_empty() {
            return PlaceError::NoParts { piece, mannequin };
        }
        let own = self.openings.iter().filter(|opening| Some(opening.part) == part(&mesh.pieces[unworn]));
        let lengths: Vec<String> = own.map(|opening| format!("{:.0} mm", MM * opening.length)).collect();
        let openings = if lengths.is_empty() { "there is none".to_owned() } else { lengths.join(", ") };
        PlaceError::Unworn { piece, mannequin, openings }
    }

    /// The level of every node: the lowest of the pieces that its connected part is of.
    fn levels(&self, garment: &Garment, mesh: &ClothMesh) -> Vec<i32> {
        let mut level = vec![i32::MAX; self.glued.parts() as usize];
        for (piece, own) in garment.pieces.iter().zip(&mesh.pieces) {
            for n in own.particles.clone().filter_map(|p| self.glued.node_of[p]) {
                let of_part = &mut level[self.glued.part_of[n as usize] as usize];
                *of_part = (*of_part).min(piece.level());
            }
        }
        self.glued.part_of.iter().map(|part| level[*part as usize]).collect()
    }

    /// For the opening of the head alone, the distance of every node of its rim from the seam below the pieces on it
    /// that no other opening touches, a hood or a collar. `None` where there are none, or several seams join them.
    fn above(&self, mesh: &ClothMesh, cloth: &Distances, k: usize) -> Option<Vec<f64>> {
        if self.dealing.ends[k] != Ends::HEAD {
            return None;
        }
        let mut openings_of: Vec<Vec<usize>> = vec![Vec::new(); self.glued.count];
        for (j, opening) in self.openings.iter().enumerate().filter(|(j, _)| !self.dealing.ends[*j].is_empty()) {
            opening.rim.iter().for_each(|n| openings_of[*n as usize].push(j));
        }
        let nodes =
            |piece: &PieceMesh| piece.particles.clone().filter_map(|p| self.glued.node_of[p]).collect::<Vec<u32>>();
        let touches =
            |nodes: &[u32], own: bool| nodes.iter().flat_map(|n| &openings_of[*n as usize]).any(|j| (*j == k) == own);
        let (mut is_above, mut is_rest) = (vec![false; self.glued.count], vec![false; self.glued.count]);
        for nodes in mesh.pieces.iter().map(nodes) {
            let side = if touches(&nodes, true) && !touches(&nodes, false) { &mut is_above } else { &mut is_rest };
            nodes.iter().for_each(|n| side[*n as usize] = true);
        }
        let seam: Vec<u32> =
            (0..self.glued.count as u32).filter(|n| is_above[*n as usize] && is_rest[*n as usize]).collect();
        // A bodice is joined to its sleeves and its skirt by several seams, a hood by one. All of the rim is a hood's.
        let rim = &self.openings[k].rim;
        let on_rim = rim.iter().filter(|n| is_above[**n as usize]).count();
        if !self.is_connected(&seam) || (on_rim as f64) < ALL_ROUND * rim.len() as f64 {
            return None;
        }
        let far = cloth.from(&seam);
        Some(rim.iter().map(|n| far[*n as usize]).collect())
    }

    /// Whether these nodes hang together along the edges between them. None do not.
    fn is_connected(&self, nodes: &[u32]) -> bool {
        let Some(&first) = nodes.first() else { return false };
        let mut sets = DisjointSets::new(self.glued.count);
        for t in &self.glued.triangles {
            for [a, b] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]] {
                if nodes.binary_search(&a).is_ok() && nodes.binary_search(&b).is_ok() {
                    sets.join(a, b);
                }
            }
        }
        nodes.iter().all(|n| sets.same(first, *n))
    }

    /// The heights on the trunk that `place` gives the pieces on the rim of an opening.
    fn levels_on_rim(&self, garment: &Garment, mesh: &ClothMesh, k: usize) -> Vec<TrunkLevel> {
        let pieces = self.openings[k].sides.iter().filter_map(|side| mesh.piece_of(side[0]));
        let distinct: BTreeSet<usize> = pieces.collect();
        distinct.into_iter().flat_map(|piece| marks::words(garment, piece)).filter_map(PlaceWord::level).collect()
    }

    /// The words of `place` of the pieces of a connected part.
    fn words(&self, garment: &Garment, mesh: &ClothMesh, part: u32) -> Vec<&'static str> {
        let is_of = |p: usize| self.glued.node_of[p].is_some_and(|n| self.glued.part_of[n as usize] == part);
        let pieces = mesh.pieces.iter().enumerate().filter(|(_, piece)| piece.particles.clone().any(is_of));
        pieces.flat_map(|(piece, _)| marks::words(garment, piece)).map(PlaceWord::name).collect()
    }
}

/// The rings of all parts, and the limbs that some of them are round. `None` if a part has none.
fn rings_and_limbs<'a>(
    worn: &'a [WornOpenings],
    posed: &'a [Posed],
    glued: &Glued,
    edges: &[Length],
) -> Option<(Vec<PartRing>, Vec<Limb<'a>>)> {
    let (mut rings, mut limbs) = (Vec::new(), Vec::new());
    for (number, (part, Posed { axes, .. })) in worn.iter().zip(posed).enumerate() {
        let before = rings.len();
        for (k, ring) in part.rings(axes).into_iter().enumerate() {
            let Some(ring) = ring else { continue };
            let limb = limb_of(part.ends[k]).and_then(|kind| axes.part(kind));
            let angles = || angles(glued.count, edges, &ring, &part.jumps(k, &glued.triangles)?);
            if let Some((axis, angles)) = limb.and_then(|axis| Some((axis, angles()?))) {
                let other = part.find(part.ends[k].mirrored()).map(|o| part.far[o].as_slice());
                limbs.push(Limb { ring: rings.len(), axis, distance: &part.far[k], other, angles });
            }
            rings.push(PartRing { ring, part: number as u32, ends: part.ends[k] });
        }
        if rings.len() == before {
            return None;
        }
    }
    Some((rings, limbs))
}
