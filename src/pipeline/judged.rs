//! Anybody's surface before the independent eye.

use std::collections::HashMap;
use std::path::Path;

use super::error::PipelineError;
use crate::geometry::{Topology, TriMesh, Vec3, box_of, sorted_pair, triangles_of};
use crate::input::LengthUnit;
use crate::io::body::{BodyError, read_solid};
use crate::io::obj_read::read_obj_faces;
use crate::mannequin::{Place, check_body, load};
use crate::report::{Seen, look};

/// A mesh this much longer than the body is in another unit.
const LARGER: f64 = 5.0;

/// What was seen.
#[derive(Clone, Debug)]
pub struct Judged {
    /// Triangles looked at.
    pub triangles: usize,
    /// The figures and the crossings; parts are the file's groups.
    pub seen: Seen,
    /// What its user may not have meant: one text each.
    pub notes: Vec<String>,
}

/// Looks for crossings in the OBJ file `mesh` in `unit`, with itself and with `body`: a mannequin's name, or a closed
/// OBJ in the same place and the unit beside it.
///
/// # Errors
/// [`PipelineError::Obj`] and [`PipelineError::Body`]: files that cannot be read, or a body that is not closed.
pub fn judge(mesh: &Path, unit: LengthUnit, body: Option<(&str, LengthUnit)>) -> Result<Judged, PipelineError> {
    let faces = read_obj_faces(mesh)?;
    let metres = unit.metres();
    let mut cloth = TriMesh { vertices: faces.vertices.iter().map(|p| p * metres).collect(), triangles: Vec::new() };
    let mut group_of = Vec::new();
    for (face, &group) in faces.faces.iter().zip(&faces.group_of_face) {
        let triangles = triangles_of(&faces.vertices, face);
        group_of.extend(triangles.iter().map(|_| group));
        cloth.triangles.extend(triangles);
    }
    let body = body.map(|(name, unit)| solid(name, unit)).transpose()?;
    let notes = body.as_ref().and_then(|body| misplaced(&cloth, body)).into_iter().chain(loose(&cloth)).collect();
    let name = |t: u32| match faces.groups[group_of[t as usize] as usize].as_str() {
        "" => "mesh",
        name => name,
    };
    Ok(Judged { triangles: cloth.triangles.len(), seen: look(&cloth, body.as_ref(), name, |p| p), notes })
}

/// A mannequin's surface by name, or a closed OBJ as it stands.
fn solid(name: &str, unit: LengthUnit) -> Result<TriMesh, PipelineError> {
    let path = Path::new(name);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj")) {
        return Ok(read_solid(path, unit)?);
    }
    let mannequin = load(name).map_err(BodyError::from)?;
    check_body(&mannequin.mesh, Place::millimetres)
        .map_err(|fault| BodyError::Fault { file: name.to_owned(), fault })?;
    Ok(mannequin.mesh)
}

/// What to say when cloth and body cannot belong together.
fn misplaced(cloth: &TriMesh, body: &TriMesh) -> Option<String> {
    let [[low, high], [l, h]] = [bounds(cloth), bounds(body)];
    let apart = (0..3).any(|k| low[k] > h[k] || l[k] > high[k]);
    let larger = (high - low).norm() > LARGER * (h - l).norm();
    let (cloth_mm, body_mm) = (1e3 * (high - low).norm(), 1e3 * (h - l).norm());
    (apart || larger).then(|| {
        format!(
            "the mesh ({cloth_mm:.0} mm across) and the body ({body_mm:.0} mm across) do not lie in the same place; \
             are they in the units that --units and --body-units say, and is the body where the mesh is worn?"
        )
    })
}

/// What to say of rims of which more than two lie on one another: which two of them are one surface, and whether that
/// passes through the other there, only common vertices could tell.
fn loose(cloth: &TriMesh) -> Option<String> {
    // Both zeros are one number.
    let place = |p: &Vec3| [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits());
    let mut first: HashMap<[u64; 3], u32> = HashMap::new();
    let one: Vec<u32> = (0..).zip(&cloth.vertices).map(|(v, p)| *first.entry(place(p)).or_insert(v)).collect();
    let mut rims: HashMap<[u32; 2], usize> = HashMap::new();
    for edge in Topology::new(&cloth.triangles).rim_edges() {
        *rims.entry(sorted_pair(edge.ends.map(|v| one[v as usize]))).or_default() += 1;
    }
    let count = rims.values().filter(|&&rims| rims > 2).count();
    (count > 0).then(|| {
        format!(
            "edges of triangles that lie on two or more others without common vertices: {count}; a surface that passes \
             through another exactly along them is not seen; merge vertices that lie in one place"
        )
    })
}

fn bounds(mesh: &TriMesh) -> [Vec3; 2] {
    box_of(mesh.triangles.iter().flatten().map(|&v| mesh.vertices[v as usize]))
}
