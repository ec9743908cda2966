//! Where a garment starts: from its own topology.
//!
//! ```text
//! mesh ─▶ glue ─────────▶ openings ─────────▶ deal ──────────────▶ rings ─▶ harmonic ─▶ balloon
//!          one surface     its rims, with      which part of the    round    a soap      inflated round
//!          per part        length and girth    body passes through  the      film        axes that grow
//!                                              each                 axes     between     to the body
//! ```
//!
//! A sewn garment is a surface with openings, and a part of the body passes through each opening: that is all that a
//! start must get right.

mod axes;
mod balloon;
mod cloth;
mod cost;
mod cover;
mod crossed;
mod deal;
mod deal_error;
mod ends;
mod girths;
mod glue;
mod hand_over;
mod harmonic;
mod laps;
mod layers;
mod marks;
mod openings;
mod profile;
mod rings;
mod sections;
mod sides;
mod sketch;
mod surface;
mod winding;
mod words;
mod zip;

pub use cloth::Distances;
pub use deal::{CLEAR, Dealing, deal, guess};
pub use deal_error::{DealError, Doubt, edges};
pub use ends::{End, Ends};
pub use glue::{Follow, Glued, glue};
pub use laps::Lap;
pub use openings::{Opening, openings};
pub use sketch::{Sketch, SketchedOpening, sketch};
pub use words::Settling;

use crate::contact::Collider;
use crate::geometry::Vec3;
use crate::mannequin::Mannequin;
use crate::mesh::{self, ClothMesh, Transfer};
use crate::pattern::Garment;
use axes::Axes;
use balloon::{Balloon, Held, Length};
use harmonic::{Film, Limb, Ring, angles};
use profile::Profile;
use rings::{Worn, limb_of};
use sections::sections;

/// Garments start on a mesh of this spacing, metres, whatever is asked for: it costs a second or two, and a finer one
/// starts no better.
pub const SPACING: f64 = 0.025;

/// Where every particle of `to` starts on a body: glued along its seams, round the parts that its openings are for.
/// `collider` is the body's surface. `None` where it is not clear which part passes through which opening, or a part of
/// the garment has no opening that anything passes through.
pub fn start(garment: &Garment, to: &ClothMesh, body: &Mannequin, collider: &Collider) -> Option<Vec<Vec3>> {
    let mesh = mesh::build(garment, SPACING).ok()?;
    let stages = Dealt::stages(garment, &mesh, body);
    if stages.iter().any(|stage| stage.doubt.is_some()) {
        return None;
    }
    let dealt = stages.last()?;
    let axes = Axes::of(body);
    let nodes = dealt.on_film(&mesh, &axes, |film| {
        let of_ring = |ring: &Ring| Held { rim: ring.rim.clone(), middle: ring.center, along: None };
        // Sleeves keep to their arms without; where they are cut in one with the body no section is theirs alone.
        let legs = film.limbs.iter().filter(|limb| !limb.axis.kind.is_arm());
        let sections = legs.flat_map(|limb| sections(&film.rings[limb.ring], limb));
        let held = film.rings.iter().map(of_ring).chain(sections).collect();
        let bending = surface::bending(&dealt.glued, &mesh);
        let stretch = film.edges.to_vec();
        let balloon = Balloon { triangles: dealt.glued.triangles.clone(), stretch, bending, held };
        balloon.inflate(&film.nodes, &axes, collider)
    })?;
    let x = hand_over::particles(garment, &mesh, &dealt.glued, &nodes);
    Some(Transfer::new(&mesh, to).apply(&x))
}

/// A glued garment on the film between its openings.
struct OnFilm<'a> {
    edges: &'a [Length],
    rings: &'a [Ring],
    limbs: &'a [Limb<'a>],
    nodes: Vec<Vec3>,
}

/// A glued garment with the ends of the body dealt out to its openings.
struct Dealt {
    glued: Glued,
    openings: Vec<Opening>,
    dealing: Dealing,
    /// The other dealing that fits about as well, if there is one.
    doubt: Option<DealError>,
}

impl Dealt {
    /// Glues a garment and deals; where it has open fronts once more with these closed. The last is as it is put on.
    fn stages(garment: &Garment, mesh: &ClothMesh, body: &Mannequin) -> Vec<Self> {
        let first = Self::with(garment, mesh, body, &[]);
        let zips = first.dealing.zips.clone();
        let closed = (!zips.is_empty()).then(|| Self::with(garment, mesh, body, &zips));
        std::iter::once(first).chain(closed).collect()
    }

    fn with(garment: &Garment, mesh: &ClothMesh, body: &Mannequin, zips: &[[u32; 2]]) -> Self {
        let glued = glue(garment, mesh, zips);
        let openings = openings(&glued, mesh);
        let dealing = guess(garment, mesh, &glued, &openings, body);
        let doubt = dealing.doubt(garment, mesh, &glued, &openings);
        Self { glued, openings, dealing, doubt }
    }

    /// What `then` makes of the garment on its film. `None` where a part of it has no opening that anything passes
    /// through.
    fn on_film<T>(&self, mesh: &ClothMesh, axes: &Axes, then: impl FnOnce(OnFilm) -> T) -> Option<T> {
        let edges = surface::edges(&self.glued, mesh);
        let worn = self.worn(mesh);
        let (rings, limbs) = rings_and_limbs(&worn, &self.glued, &edges, axes)?;
        let nodes = Film::new(self.glued.count, &edges, &rings)?.start(&rings, &limbs);
        Some(then(OnFilm { edges: &edges, rings: &rings, limbs: &limbs, nodes }))
    }

    /// The openings of every connected part.
    fn worn<'a>(&'a self, mesh: &'a ClothMesh) -> Vec<Worn<'a>> {
        let cloth = Distances::new(&self.glued, mesh);
        let parts = self.glued.part_of.iter().max().map_or(0, |last| last + 1);
        let of_part = |part: u32| {
            let own: Vec<usize> = (0..self.openings.len()).filter(|&k| self.openings[k].part == part).collect();
            let far: Vec<Vec<f64>> = own.iter().map(|&k| cloth.from(&self.openings[k].rim)).collect();
            let profile =
                |(&k, far): (&usize, &Vec<f64>)| Profile::new(&self.glued, &cloth, self.openings[k].length, far);
            Worn {
                flat: &mesh.flat,
                openings: own.iter().map(|&k| &self.openings[k]).collect(),
                ends: own.iter().map(|&k| self.dealing.ends[k]).collect(),
                front: own.iter().map(|&k| self.dealing.front[k]).collect(),
                profiles: own.iter().zip(&far).map(profile).collect(),
                far,
            }
        };
        (0..parts).map(of_part).collect()
    }
}

/// The rings of all parts, and the limbs that some of them are round. `None` if a part has none.
fn rings_and_limbs<'a>(
    worn: &'a [Worn],
    glued: &Glued,
    edges: &[Length],
    axes: &'a Axes,
) -> Option<(Vec<Ring>, Vec<Limb<'a>>)> {
    let (mut rings, mut limbs) = (Vec::new(), Vec::new());
    for part in worn {
        let before = rings.len();
        for (k, ring) in part.rings(axes).into_iter().enumerate() {
            let Some(ring) = ring else { continue };
            let limb = limb_of(part.ends[k]).and_then(|kind| axes.part(kind));
            let angles = || angles(glued.count, edges, &ring, &part.jumps(k, &glued.triangles)?);
            if let Some((axis, angles)) = limb.and_then(|axis| Some((axis, angles()?))) {
                let other = part.find(part.ends[k].mirrored()).map(|o| part.far[o].as_slice());
                limbs.push(Limb { ring: rings.len(), axis, distance: &part.far[k], other, angles });
            }
            rings.push(ring);
        }
        if rings.len() == before {
            return None;
        }
    }
    Some((rings, limbs))
}
