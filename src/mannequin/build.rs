//! From a mannequin's numbers to its closed mesh.

use super::field::BodyField;
use super::parts::parts;
use super::relax::{mirrored, relax};
use super::spec::MannequinSpec;
use super::surface::surface_nets;
use super::{BodyFrame, Mannequin, MannequinError};
use crate::geometry::{Topology, TriMesh, Vec3};

/// Side of the cells in which the skin is found, metres. Edges become about as long. With 10 mm the girths of a grown
/// body are within 2 mm, and its skin has about 40,000 triangles.
const CELL: f64 = 0.010;
/// Height of the top of the neck, metres, below which cells are smaller in proportion, because the body has smaller
/// curves.
const GROWN: f64 = 1.45;
/// Least size of the cells of a small body, as a share of [`CELL`].
const SMALLEST: f64 = 0.7;
/// Grid sizes tried in turn, as shares of the cell. Where a narrow fold falls badly on the grid the surface net may
/// touch itself, and another grid mends it.
const TRIES: [f64; 4] = [1.0, 0.97, 0.91, 0.83];

/// Builds a mannequin: closed, manifold, outward, exactly symmetric, metres, feet at y = 0. The same spec gives the
/// same bytes.
///
/// Girths of the mesh are those of the spec within 2 mm wherever a section stands alone: the torso from the crotch
/// (both legs under one tape) to the axilla, neck, legs, and arms from the biceps down. From the armscye to the
/// shoulder a cut runs through the arms as well, and the trunk's girth there cannot be taken from the mesh.
///
/// # Errors
/// [`MannequinError::Surface`] when the sections make no simple closed body (for example an arm through the hip).
pub fn build(spec: &MannequinSpec) -> Result<Mannequin, MannequinError> {
    let body = BodyField::new(spec);
    let mut fault = String::new();
    let cell = CELL * (body.top() / GROWN).clamp(SMALLEST, 1.0);
    for size in TRIES {
        let mut half = surface_nets(|p| body.distance(p), body.inside(), size * cell);
        relax(&mut half, &body);
        let mesh = mirrored(&half);
        match skin_fault(&mesh, &body) {
            None => {
                return Ok(Mannequin {
                    name: spec.name.clone(),
                    mesh,
                    parts: parts(spec, &body),
                    frame: BodyFrame::default(),
                });
            }
            Some(why) => fault = why,
        }
    }
    Err(MannequinError::Surface { name: spec.name.clone(), why: fault })
}

fn skin_fault(mesh: &TriMesh, body: &BodyField) -> Option<String> {
    let topology = Topology::new(&mesh.triangles);
    let place = |v: u32| millimetres(mesh.vertices[v as usize]);
    if let Some(edge) = topology.rim_edges().next() {
        return Some(format!("its skin is open near {}", place(edge.ends[0])));
    }
    if let Some(edge) = topology.non_manifold.first() {
        return Some(format!("its skin touches itself near {}", place(edge[0])));
    }
    let stray = mesh.vertices.iter().find(|p| p.y > body.top() + CELL || !p.y.is_finite())?;
    Some(format!("its skin leaves the sections near {}", millimetres(*stray)))
}

fn millimetres(p: Vec3) -> String {
    format!("({:.0}, {:.0}, {:.0}) mm", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z)
}
