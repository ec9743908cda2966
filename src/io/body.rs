//! A body of one's own: a closed OBJ becomes a [`Mannequin`]; and mannequins as OBJ text.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;

use super::obj_read::{ObjError, ObjSurface, read_obj};
use crate::geometry::{Topology, TriMesh, Vec3, box_of, range_of};
use crate::mannequin::{BodyCheck, BodyFault, Frame, HEIGHTS, Mannequin, MannequinError, check_body, find_parts, load};

/// Nobody needs to know that a body stands so little off y = 0, metres.
const OFF: f64 = 1e-4;
/// Vertices nearer than this are one, metres: far below a mesh's edges, far above the rounding of a file.
const WELD: f64 = 1e-6;
/// A body lower than this many file units is in metres, lower than the next in centimetres, else in millimetres.
const METRES_BELOW: f64 = 3.0;
const CENTIMETRES_BELOW: f64 = 300.0;
/// Heights of foot and ankle, as parts of the body's, that tell where the toes point.
const FOOT: f64 = 0.02;
const ANKLE: [f64; 2] = [0.05, 0.08];
/// Bodies with more crossing pairs than this share of their triangles are refused. Averaged bodies have a few tenths of
/// a percent, between the thighs; a limb pushed through the trunk has several percent.
const CROSSING: f64 = 0.01;

/// A body that was read, and what was guessed or done on the way.
#[derive(Clone, Debug)]
pub struct Body {
    /// In metres, y up, feet at y = 0, facing +z; an object without parts as its file has it.
    pub mannequin: Mannequin,
    /// One sentence each: the unit taken, the stance, disconnected parts, crossings.
    pub notes: Vec<String>,
}

/// Why a file is no body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// The file itself.
    #[error(transparent)]
    Obj(#[from] ObjError),
    /// The surface.
    #[error("{file}: {fault}")]
    Fault {
        /// Path.
        file: String,
        /// What is wrong, where, and the remedy.
        fault: BodyFault,
    },
    /// A surface that runs through itself in more than a few places.
    #[error(
        "{file}: the surface crosses itself ({pairs} pairs of {triangles} triangles, near ({:.0}, {:.0}, {:.0}) mm); \
         separate the limbs or remesh it (in Blender: Remesh modifier, Voxel)",
        1e3 * place.x, 1e3 * place.y, 1e3 * place.z
    )]
    Crossing {
        /// Path.
        file: String,
        /// Pairs of triangles that cross.
        pairs: usize,
        /// Triangles of the surface.
        triangles: usize,
        /// Where the first two cross, metres.
        place: Vec3,
    },
    /// A body that nobody dresses: its unit is not what it was taken for.
    #[error(
        "{file}: the body is {:.3e} units high, taken for {unit}, which makes {} m; a body is {} to {} m high: scale \
         the file to millimetres, centimetres or metres",
        units, metres_shown(*metres), HEIGHTS.start(), HEIGHTS.end()
    )]
    Size {
        /// Path.
        file: String,
        /// Height in the file's unit.
        units: f64,
        /// What that was taken for.
        unit: &'static str,
        /// Height in metres.
        metres: f64,
    },
    /// No height, or no parts.
    #[error("{file}: {why}")]
    Shape {
        /// Path.
        file: String,
        /// What is missing.
        why: String,
    },
    /// A mannequin by name or `.yaml`.
    #[error(transparent)]
    Mannequin(#[from] MannequinError),
}

fn metres_shown(metres: f64) -> String {
    if (1e-2..1e4).contains(&metres) { format!("{metres:.2}") } else { format!("{metres:.1e}") }
}

/// A mannequin by library name, `.yaml` or `.obj`: what `--body` takes.
///
/// # Errors
/// [`BodyError`].
pub fn load_body(name_or_path: &str) -> Result<Body, BodyError> {
    let path = Path::new(name_or_path);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj")) {
        return read_body(path);
    }
    Ok(Body { mannequin: load(name_or_path)?, notes: Vec::new() })
}

/// Reads a closed OBJ in millimetres, centimetres or metres (guessed from its height and said in the notes), y up or
/// z up. Vertices that coincide are merged where the surface is not closed otherwise. A body that stands elsewhere than
/// on y = 0, or faces −z, is moved and turned; its [`Frame`] leads back. A surface in which no torso, neck, arms and
/// legs can be found is an object without parts, as a ball or a table: it stays where the file has it.
///
/// # Errors
/// [`BodyError`] when the file cannot be read, or the surface is open, not manifold, inside out or runs through itself
/// in many places.
pub fn read_body(path: &Path) -> Result<Body, BodyError> {
    let file = path.display().to_string();
    let name = path.file_stem().map_or_else(|| file.clone(), |s| s.to_string_lossy().into_owned());
    body(read_obj(path)?, name, file)
}

/// Reads a closed OBJ as it stands, `metres` to the unit.
///
/// # Errors
/// [`BodyError`] when the file cannot be read, or the surface is open, not manifold, inside out or runs through itself
/// in many places.
pub fn read_solid(path: &Path, metres: f64) -> Result<TriMesh, BodyError> {
    let surface = read_obj(path)?;
    let vertices = surface.vertices.iter().map(|p| p * metres).collect();
    checked(vertices, surface.triangles, &path.display().to_string(), &mut Vec::new())
}

/// As [`read_body`], from a surface already read; `file` names it in errors.
///
/// # Errors
/// As [`read_body`].
pub fn body(surface: ObjSurface, name: String, file: String) -> Result<Body, BodyError> {
    match person(&surface, &name, &file) {
        Err(BodyError::Shape { why, .. }) => object(surface, name, file, &why),
        Err(BodyError::Size { .. }) if lies(&surface.vertices) => object(surface, name, file, "it lies"),
        other => other,
    }
}

/// A surface as somebody to dress: upright, in metres, with the parts of a body.
fn person(surface: &ObjSurface, name: &str, file: &str) -> Result<Body, BodyError> {
    let mut notes = Vec::new();
    let shape = |why: &str| BodyError::Shape { file: file.to_owned(), why: why.to_owned() };
    let mut vertices = surface.vertices.clone();
    stand_up(&mut vertices, &mut notes);
    let (low, height) = extent(&vertices).ok_or_else(|| shape("the body has no height"))?;
    let (scale, unit) = unit(height);
    if !HEIGHTS.contains(&(scale * height)) {
        return Err(BodyError::Size { file: file.to_owned(), units: height, unit, metres: scale * height });
    }
    notes.push(format!("{unit} assumed, since the body is {height:.2} units high"));
    vertices.iter_mut().for_each(|p| *p *= scale);
    // Places of faults are those of the file.
    let mut mesh = checked(vertices, surface.triangles.clone(), file, &mut notes)?;
    let frame = Frame { low: low * scale, backward: faces_back(&mesh, low * scale, height * scale) };
    mesh.vertices.iter_mut().for_each(|p| *p = frame.from_file(*p));
    notes.extend(stands(&frame));
    let parts = find_parts(&mesh).map_err(|why| shape(&why))?;
    Ok(Body { mannequin: Mannequin { name: name.to_owned(), mesh, parts, frame }, notes })
}

/// What a user should know of a body that does not stand on y = 0 and face +z.
fn stands(frame: &Frame) -> Vec<String> {
    let mut notes = Vec::new();
    if frame.low.abs() > OFF {
        let low = 1e3 * frame.low;
        notes.push(format!("its feet are at y = {low:.1} mm: a garment file counts heights from there"));
    }
    if frame.backward {
        notes.push("the toes point to -z: that is its front".to_owned());
    }
    notes
}

/// A surface as a thing that cloth lies on or is wound round: where the file has it, without parts; `why` is what it
/// lacks to be somebody.
fn object(surface: ObjSurface, name: String, file: String, why: &str) -> Result<Body, BodyError> {
    let mut notes = vec![format!("an object without body parts ({why}): its coordinates are taken as they are")];
    let mut vertices = surface.vertices;
    let [low, high] = bounds(&vertices);
    let longest = (high - low).max();
    let (scale, unit) = unit(longest);
    notes.push(format!("{unit} assumed, since the object is {longest:.2} units long"));
    vertices.iter_mut().for_each(|p| *p *= scale);
    let mesh = checked(vertices, surface.triangles, &file, &mut notes)?;
    Ok(Body { mannequin: Mannequin { name, mesh, parts: Vec::new(), frame: Frame::default() }, notes })
}

/// The closed surface that cloth can touch, with what its user should know of it.
fn checked(
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    file: &str,
    notes: &mut Vec<String>,
) -> Result<TriMesh, BodyError> {
    let mesh = closed(vertices, triangles);
    let check = check_body(&mesh).map_err(|fault| BodyError::Fault { file: file.to_owned(), fault })?;
    refuse_crossings(&mesh, &check, file)?;
    notes.extend(findings(&check));
    Ok(mesh)
}

/// Refuses a surface that runs through itself in more than a few places: there is no telling its inside.
fn refuse_crossings(mesh: &TriMesh, check: &BodyCheck, file: &str) -> Result<(), BodyError> {
    let triangles = mesh.triangles.len();
    match check.crossings {
        Some((pairs, place)) if pairs as f64 > CROSSING * triangles as f64 => {
            Err(BodyError::Crossing { file: file.to_owned(), pairs, triangles, place })
        }
        _ => Ok(()),
    }
}

/// What a body's check found that its user should know.
fn findings(check: &BodyCheck) -> Vec<String> {
    let mut notes = Vec::new();
    if check.parts > 1 {
        notes.push(format!("the body consists of {} parts that do not touch; all are kept", check.parts));
    }
    if let Some((pairs, p)) = check.crossings {
        let p = 1e3 * p;
        notes.push(format!(
            "the surface crosses itself ({pairs} pairs of triangles, near ({:.0}, {:.0}, {:.0}) mm); where cloth goes \
             there, separate the limbs or remesh",
            p.x, p.y, p.z
        ));
    }
    notes
}

/// Turns a body that lies along z upright.
fn stand_up(vertices: &mut [Vec3], notes: &mut Vec<String>) {
    let [low, high] = bounds(vertices);
    if high.z - low.z <= high.y - low.y {
        return;
    }
    for p in vertices {
        *p = Vec3::new(p.x, p.z, -p.y);
    }
    notes.push("z is the tall axis: turned so that y is up, as in what is written".to_owned());
}

/// The corners of the box round the vertices.
fn bounds(vertices: &[Vec3]) -> [Vec3; 2] {
    box_of(vertices.iter().copied())
}

/// Whether this is longer than it is high, as nobody is who stands with the arms stretched out.
fn lies(vertices: &[Vec3]) -> bool {
    let [low, high] = bounds(vertices);
    let size = high - low;
    size.max() > 2.0 * size.y
}

/// Lowest point and height, if there is any.
fn extent(vertices: &[Vec3]) -> Option<(f64, f64)> {
    let low = vertices.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let high = vertices.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
    (high > low).then_some((low, high - low))
}

/// Metres per unit of a file whose body is that high, and the unit's name.
fn unit(height: f64) -> (f64, &'static str) {
    if height < METRES_BELOW {
        (1.0, "metres")
    } else if height < CENTIMETRES_BELOW {
        (1e-2, "centimetres")
    } else {
        (1e-3, "millimetres")
    }
}

/// The surface as it is if that is closed, otherwise with coinciding vertices merged: seams of texture and normals then
/// close, while lips that merely touch stay apart.
fn closed(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> TriMesh {
    if Topology::new(&triangles).rim_edges().next().is_none() {
        return TriMesh { vertices, triangles };
    }
    weld(&vertices, &triangles)
}

/// Merges coinciding vertices and drops triangles that become edges and vertices that no triangle uses.
fn weld(vertices: &[Vec3], triangles: &[[u32; 3]]) -> TriMesh {
    let mut seen: HashMap<[i64; 3], u32> = HashMap::new();
    let mut mesh = TriMesh::default();
    for tri in triangles {
        let tri = tri.map(|v| {
            let p = vertices[v as usize];
            *seen.entry([p.x, p.y, p.z].map(|c| (c / WELD).round() as i64)).or_insert_with(|| {
                mesh.vertices.push(p);
                mesh.vertices.len() as u32 - 1
            })
        });
        if tri[0] != tri[1] && tri[1] != tri[2] && tri[2] != tri[0] {
            mesh.triangles.push(tri);
        }
    }
    mesh
}

/// Whether the toes of a body, so high from `low` on (metres), point to −z. Feet may have none.
fn faces_back(mesh: &TriMesh, low: f64, height: f64) -> bool {
    let middle = |from: f64, to: f64| {
        let z = mesh.vertices.iter().filter(|p| (from * height..to * height).contains(&(p.y - low))).map(|p| p.z);
        let [low, high] = range_of(z);
        0.5 * (low + high)
    };
    let toes = middle(0.0, FOOT) - middle(ANKLE[0], ANKLE[1]);
    toes < -FOOT * height
}

/// A mannequin as OBJ text: millimetres, y up, feet at y = 0.
pub fn mannequin_obj(mannequin: &Mannequin) -> String {
    let mut out = format!("# {}: millimetres, y up, facing +z\no {}\n", mannequin.name, mannequin.name);
    for p in &mannequin.mesh.vertices {
        let _ = writeln!(out, "v {:.6} {:.6} {:.6}", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z);
    }
    for t in &mannequin.mesh.triangles {
        let _ = writeln!(out, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    out
}
