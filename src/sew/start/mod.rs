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
mod surface;
mod winding;
mod zip;

pub use cloth::Distances;
pub use deal::{CLEAR, Dealing, deal, guess};
pub use deal_error::{DealError, Doubt, edges};
pub use ends::{End, Ends};
pub use glue::{Follow, Glued, glue};
pub use laps::Lap;
pub use openings::{Opening, openings};

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
const SPACING: f64 = 0.025;

/// Where every particle of `to` starts on a body: glued along its seams, round the parts that its openings are for.
/// `collider` is the body's surface. `None` where it is not clear which part passes through which opening, or a part of
/// the garment has no opening that anything passes through.
pub fn start(garment: &Garment, to: &ClothMesh, body: &Mannequin, collider: &Collider) -> Option<Vec<Vec3>> {
    let mesh = mesh::build(garment, SPACING).ok()?;
    let dealt = Dealt::new(garment, &mesh, body)?;
    let axes = Axes::of(body);
    let edges = surface::edges(&dealt.glued, &mesh);
    let worn = dealt.worn(&mesh);
    let (rings, limbs) = rings_and_limbs(&worn, &dealt.glued, &edges, &axes)?;
    let nodes = Film::new(dealt.glued.count, &edges, &rings)?.start(&rings, &limbs);
    let of_ring = |ring: &Ring| Held { rim: ring.rim.clone(), middle: ring.center, along: None };
    // Sleeves keep to their arms without; where they are cut in one with the body no section is theirs alone.
    let legs = limbs.iter().filter(|limb| !limb.axis.kind.is_arm());
    let sections = legs.flat_map(|limb| sections(&rings[limb.ring], limb));
    let held = rings.iter().map(of_ring).chain(sections).collect();
    let bending = surface::bending(&dealt.glued, &mesh);
    let balloon = Balloon { triangles: dealt.glued.triangles.clone(), stretch: edges, bending, held };
    let nodes = balloon.inflate(&nodes, &axes, collider);
    let x = hand_over::particles(garment, &mesh, &dealt.glued, &nodes);
    Some(Transfer::new(&mesh, to).apply(&x))
}

/// A glued garment with the ends of the body dealt out to its openings.
struct Dealt {
    glued: Glued,
    openings: Vec<Opening>,
    dealing: Dealing,
}

impl Dealt {
    /// Glues a garment, closes its open fronts, and deals. `None` where the dealing is not clear.
    fn new(garment: &Garment, mesh: &ClothMesh, body: &Mannequin) -> Option<Self> {
        let first = Self::with(garment, mesh, body, &[])?;
        if first.dealing.zips.is_empty() { Some(first) } else { Self::with(garment, mesh, body, &first.dealing.zips) }
    }

    fn with(garment: &Garment, mesh: &ClothMesh, body: &Mannequin, zips: &[[u32; 2]]) -> Option<Self> {
        let glued = glue(garment, mesh, zips);
        let openings = openings(&glued, mesh);
        let dealing = deal(garment, mesh, &glued, &openings, body).ok()?;
        Some(Self { glued, openings, dealing })
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
