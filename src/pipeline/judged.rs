//! Anybody's surface before the independent eye.

use std::collections::HashMap;
use std::path::Path;

use super::error::PipelineError;
use crate::geometry::{Topology, TriMesh, Vec3, box_of, sorted_pair, triangles_of};
use crate::input::LengthUnit;
use crate::io::body::{BodyError, read_solid};
use crate::io::obj_read::read_obj_faces;
use crate::mannequin::{FilePlace, check_body, load};
use crate::report::{CrossingsSeen, look};

/// Ratio of the sizes of mesh and body above which the mesh is in another unit.
const LARGER: f64 = 5.0;

/// The findings.
#[derive(Clone, Debug)]
pub struct Judged {
    /// Number of triangles.
    pub triangles: usize,
    /// The figures and the crossings. Parts are the file's groups.
    pub seen: CrossingsSeen,
    /// Notes on input that its user may not have meant so, one text each.
    pub notes: Vec<String>,
}

/// Looks for crossings in the OBJ file `mesh`, with itself and with `body`: a mannequin's name, or a closed OBJ in the
/// same place. Units that are not given are guessed from the sizes of the files, a mesh's from its body's, and that is
/// noted.
///
/// # Errors
/// [`PipelineError::Obj`] and [`PipelineError::Body`]: files that cannot be read, or a body that is not closed.
pub fn judge(
    mesh: &Path,
    unit: Option<LengthUnit>,
    body: Option<(&str, Option<LengthUnit>)>,
) -> Result<Judged, PipelineError> {
    let faces = read_obj_faces(mesh)?;
    let mut notes = Vec::new();
    let is_obj = |name: &str| Path::new(name).extension().is_some_and(|e| e.eq_ignore_ascii_case("obj"));
    let file = body.filter(|(name, _)| is_obj(name));
    let of_body = match file {
        Some((_, Some(said))) => Some(said),
        Some((name, None)) if unit.is_none() => {
            let longest = longest(&read_obj_faces(Path::new(name))?.vertices);
            let taken = LengthUnit::guessed(longest, UNITS_BELOW);
            notes.push(assumed(taken, "the body", longest, "--units or --body-units"));
            Some(taken)
        }
        _ => unit,
    };
    // Who wrote the body without its unit wrote the mesh beside it in the same.
    let beside = of_body.filter(|_| file.is_some_and(|(_, said)| said.is_none()));
    let unit = unit.or(beside).unwrap_or_else(|| {
        let longest = longest(&faces.vertices);
        let taken = LengthUnit::guessed(longest, UNITS_BELOW);
        notes.push(assumed(taken, "the mesh", longest, "--units"));
        taken
    });
    let metres = unit.metres();
    let mut cloth = TriMesh { vertices: faces.vertices.iter().map(|p| p * metres).collect(), triangles: Vec::new() };
    let mut group_of = Vec::new();
    for (face, &group) in faces.faces.iter().zip(&faces.group_of_face) {
        let triangles = triangles_of(&faces.vertices, face);
        group_of.extend(triangles.iter().map(|_| group));
        cloth.triangles.extend(triangles);
    }
    let body = body.map(|(name, _)| solid(name, of_body.unwrap_or(unit))).transpose()?;
    notes.extend(body.as_ref().and_then(|body| misplaced(&cloth, body)));
    notes.extend(loose(&cloth));
    let name = |t: u32| match faces.groups[group_of[t as usize] as usize].as_str() {
        "" => "mesh",
        name => name,
    };
    Ok(Judged { triangles: cloth.triangles.len(), seen: look(&cloth, body.as_ref(), name, |p| p), notes })
}

/// Lengths of a mesh or body, in its own units, below which the unit is metres (first) or centimetres (second). Nobody
/// is 4 m tall, and nothing that is worn is shorter than 250 mm.
const UNITS_BELOW: [f64; 2] = [4.0, 250.0];

/// Longest side of the bounding box of points.
fn longest(points: &[Vec3]) -> f64 {
    let [low, high] = box_of(points.iter().copied());
    (high - low).max()
}

/// Note on a unit that a file's size suggests.
fn assumed(unit: LengthUnit, what: &str, longest: f64, option: &str) -> String {
    let name = unit.name();
    format!(
        "{name} assumed, since {what} is {longest:.2} units long; if that is wrong, say {option} mm, cm, dm, m or in"
    )
}

/// A mannequin's surface by name, or a closed OBJ as it stands.
fn solid(name: &str, unit: LengthUnit) -> Result<TriMesh, PipelineError> {
    let path = Path::new(name);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj")) {
        return Ok(read_solid(path, unit)?);
    }
    let mannequin = load(name).map_err(BodyError::from)?;
    check_body(&mannequin.mesh, FilePlace::millimetres)
        .map_err(|fault| BodyError::Fault { file: name.to_owned(), fault })?;
    Ok(mannequin.mesh)
}

/// Note for cloth and body that cannot belong together.
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

/// Note on rims of which more than two lie on one another. Only common vertices could tell which two of them are one
/// surface, and whether that surface passes through the other there.
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
