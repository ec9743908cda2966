//! A body of one's own: a closed OBJ becomes a [`Mannequin`]; and mannequins as OBJ text.

use std::collections::HashMap;
use std::path::Path;

use super::obj_read::{ObjError, ObjSurface, read_obj};
use super::obj_text::{DECIMALS, ObjText};
use crate::geometry::{DisjointSets, MM, Topology, TriMesh, Vec3, box_of, range_of};
use crate::input::LengthUnit;
use crate::mannequin::{
    BodyCheck, BodyFault, BodyFrame, FilePlace, GAP, HEIGHTS, Mannequin, MannequinError, Measures, PartKind,
    check_body, find_parts, load_measured, make_room,
};

/// Nobody needs to know that a body stands so little off y = 0, metres.
const OFF: f64 = 1e-4;
/// Vertices nearer than this along every axis are one, metres: far below a mesh's edges, far above the rounding of a
/// file.
const WELD: f64 = 1e-6;
/// A thing smaller than this many file units is in metres, smaller than the next in centimetres, else in millimetres.
const UNITS_BELOW: [f64; 2] = [3.0, 300.0];
/// A body lower than this many file units is not in centimetres, in which no body is so low, but in decimetres.
const DECIMETRES_BELOW: f64 = 20.0;
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
        /// The fault, its place and the remedy.
        fault: BodyFault,
    },
    /// A surface that runs through itself in more than a few places.
    #[error(
        "{file}: the surface crosses itself ({pairs} pairs of {triangles} triangles, near {place}); separate the limbs \
         or remesh it (in Blender: Remesh modifier, Voxel)"
    )]
    Crossing {
        /// Path.
        file: String,
        /// Pairs of triangles that cross.
        pairs: usize,
        /// Triangles of the surface.
        triangles: usize,
        /// Where the first two cross.
        place: FilePlace,
    },
    /// A body that nobody dresses: its unit is not what it was taken for.
    #[error(
        "{file}: the body is {:.3e} units high, taken for {}, which makes {} m; a body is {} to {} m high: scale the \
         file to millimetres, centimetres or metres, or say its unit with --body-units or 'body_units'",
        units, unit.name(), metres_shown(*metres), HEIGHTS.start(), HEIGHTS.end()
    )]
    Size {
        /// Path.
        file: String,
        /// Height in the file's unit.
        units: f64,
        /// The unit that was taken.
        unit: LengthUnit,
        /// Height in metres.
        metres: f64,
    },
    /// No height, or no parts.
    #[error("{file}: {why}")]
    Shape {
        /// Path.
        file: String,
        /// The height or the parts that are missing.
        why: String,
    },
    /// A unit for what has one.
    #[error("{0}: a unit was given, but only .obj files come without one; leave out --body-units or 'body_units'")]
    NoUnit(String),
    /// A mannequin by name or `.yaml`.
    #[error(transparent)]
    Mannequin(#[from] MannequinError),
}

fn metres_shown(metres: f64) -> String {
    if (1e-2..1e4).contains(&metres) { format!("{metres:.2}") } else { format!("{metres:.1e}") }
}

/// A mannequin by library name, `.yaml` or `.obj`: what `--body` takes; `unit` is that of an `.obj`, guessed from its
/// size if none is given.
///
/// # Errors
/// [`BodyError`].
pub fn load_body(name_or_path: &str, unit: Option<LengthUnit>) -> Result<Body, BodyError> {
    load_body_of(name_or_path, unit, &Measures::default())
}

/// As [`load_body`], with the measures of a person. An `.obj` is a body as it is, and takes none.
///
/// # Errors
/// [`BodyError`].
pub fn load_body_of(name_or_path: &str, unit: Option<LengthUnit>, measures: &Measures) -> Result<Body, BodyError> {
    let path = Path::new(name_or_path);
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj")) {
        if !measures.is_empty() {
            let why = "measures are put on a mannequin of sections, and an OBJ is a body as it is".to_owned();
            return Err(MannequinError::Measure { like: name_or_path.to_owned(), why }.into());
        }
        return read_body(path, unit);
    }
    if unit.is_some() {
        return Err(BodyError::NoUnit(name_or_path.to_owned()));
    }
    let unused = measures.unused();
    let notes = (!unused.is_empty()).then(|| format!("no section has these measures, left out: {}", unused.join(", ")));
    Ok(Body { mannequin: load_measured(name_or_path, measures)?, notes: notes.into_iter().collect() })
}

/// Reads a closed OBJ in `unit` (or, without one, in millimetres, centimetres or metres as its height says, which the
/// notes tell), y up or z up. Vertices that coincide are merged where the surface is not closed otherwise. A body that
/// stands elsewhere than on y = 0, or faces elsewhere than +z, is moved and turned; its [`BodyFrame`] leads back. Limbs
/// that leave less than [`GAP`] between them are moved apart, which the notes tell. A surface in which no torso, neck,
/// arms and legs can be found is an object without parts, as a ball or a table: it stays where the file has it.
///
/// # Errors
/// [`BodyError`] when the file cannot be read, or the surface is open, not manifold, inside out or runs through itself
/// in many places.
pub fn read_body(path: &Path, unit: Option<LengthUnit>) -> Result<Body, BodyError> {
    let file = path.display().to_string();
    let name = path.file_stem().map_or_else(|| file.clone(), |s| s.to_string_lossy().into_owned());
    body(read_obj(path)?, name, file, unit)
}

/// Height of the floor that a body stands on in its own file, metres: the lowest of an `.obj`, y up or z up; nought of
/// a mannequin, and of what is no body that stands.
///
/// # Errors
/// [`BodyError`] when the file cannot be read.
pub fn floor_of(name_or_path: &str, unit: Option<LengthUnit>) -> Result<f64, BodyError> {
    let path = Path::new(name_or_path);
    if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("obj")) {
        return Ok(0.0);
    }
    let mut vertices = read_obj(path)?.vertices;
    stand_up(&mut vertices, &mut Vec::new());
    let [low, high] = bounds(&vertices);
    let metres = unit.unwrap_or_else(|| unit_of_body(high.y - low.y)).metres();
    let stands = HEIGHTS.contains(&(metres * (high.y - low.y)));
    Ok(if stands { metres * low.y } else { 0.0 })
}

/// Reads a closed OBJ in `unit` as it stands.
///
/// # Errors
/// [`BodyError`] when the file cannot be read, or the surface is open, not manifold, inside out or runs through itself
/// in many places.
pub fn read_solid(path: &Path, unit: LengthUnit) -> Result<TriMesh, BodyError> {
    let surface = read_obj(path)?;
    let origin = SurfaceOrigin { file: &path.display().to_string(), unit, turned: false };
    checked(surface.vertices, surface.triangles, &origin, &mut Vec::new())
}

/// As [`read_body`], from a surface already read; `file` names it in errors.
///
/// # Errors
/// As [`read_body`].
pub fn body(surface: ObjSurface, name: String, file: String, unit: Option<LengthUnit>) -> Result<Body, BodyError> {
    match person(&surface, &name, &file, unit) {
        Err(BodyError::Shape { why, .. }) => object(surface, name, &file, unit, &why),
        Err(BodyError::Size { .. }) if lies(&surface.vertices) => object(surface, name, &file, unit, "it lies"),
        // With a unit that is said there is no doubt of the size.
        Err(BodyError::Size { metres, .. }) if unit.is_some() => {
            let why = format!("it is {} m high", metres_shown(metres));
            object(surface, name, &file, unit, &why)
        }
        other => other,
    }
}

/// Where a surface comes from: what leads from metres, y up, back to its file.
struct SurfaceOrigin<'a> {
    file: &'a str,
    unit: LengthUnit,
    /// Whether it was turned from z up to y up.
    turned: bool,
}

impl SurfaceOrigin<'_> {
    /// A point (metres) as the file has it.
    fn place(&self, p: Vec3) -> FilePlace {
        let p = if self.turned { Vec3::new(p.x, -p.z, p.y) } else { p };
        FilePlace { at: p / self.unit.metres(), unit: self.unit }
    }
}

/// A surface as somebody to dress: upright, in metres, with the parts of a body.
fn person(surface: &ObjSurface, name: &str, file: &str, unit: Option<LengthUnit>) -> Result<Body, BodyError> {
    let mut notes = Vec::new();
    let shape = |why: &str| BodyError::Shape { file: file.to_owned(), why: why.to_owned() };
    let mut vertices = surface.vertices.clone();
    let turned = stand_up(&mut vertices, &mut notes);
    let height = height(&vertices).ok_or_else(|| shape("the body has no height"))?;
    let taken = unit.unwrap_or_else(|| unit_of_body(height));
    let scale = taken.metres();
    if !HEIGHTS.contains(&(scale * height)) {
        return Err(BodyError::Size { file: file.to_owned(), units: height, unit: taken, metres: scale * height });
    }
    if unit.is_none() {
        notes.push(assumed(taken, &format!("the body is {height:.2} units high")));
    }
    // Places of faults are those of the file.
    let origin = SurfaceOrigin { file, unit: taken, turned };
    let mesh = checked(vertices, surface.triangles.clone(), &origin, &mut notes)?;
    let across = stood(&mesh, name, BodyFrame::across_arms(&mesh));
    // Arms held out to the front are what it is widest along.
    let mut mannequin = across.or_else(|_| stood(&mesh, name, BodyFrame::along_z(&mesh))).map_err(|why| shape(&why))?;
    notes.extend(stands(&mannequin.frame));
    notes.extend(gave_way(&make_room(&mut mannequin)));
    Ok(Body { mannequin, notes })
}

/// A surface as it stands in `frame`, with its parts.
fn stood(mesh: &TriMesh, name: &str, frame: BodyFrame) -> Result<Mannequin, String> {
    let mut mesh = mesh.clone();
    mesh.vertices.iter_mut().for_each(|p| *p = frame.from_file(*p));
    Ok(Mannequin { name: name.to_owned(), parts: find_parts(&mesh)?, mesh, frame })
}

/// The unit of a file in which a body is so high.
fn unit_of_body(height: f64) -> LengthUnit {
    match LengthUnit::guessed(height, UNITS_BELOW) {
        LengthUnit::Centimetre if height < DECIMETRES_BELOW => LengthUnit::Decimetre,
        unit => unit,
    }
}

/// The note on a unit that the file's size suggests.
fn assumed(unit: LengthUnit, since: &str) -> String {
    format!(
        "{} assumed, since {since}; if that is wrong, say --body-units mm, cm, dm, m or in ('body_units' in the file)",
        unit.name()
    )
}

/// The note on a body that does not stand on y = 0 and face +z.
fn stands(frame: &BodyFrame) -> Vec<String> {
    let mut notes = Vec::new();
    if frame.low.abs() > OFF {
        let low = 1e3 * frame.low;
        notes.push(format!("its feet are at y = {low:.1} mm: a garment file counts heights from there"));
    }
    match frame.front {
        [1.0, _] => {}
        [-1.0, _] => notes.push("the toes point to -z: that is its front".to_owned()),
        [z, x] => notes.push(format!(
            "it faces ({x:.2}, 0, {z:.2}), square to its arms: it is turned to +z, and what is made on it turned back"
        )),
    }
    notes
}

/// The note on limbs that were moved to make room for cloth.
fn gave_way(moved: &[(PartKind, f64)]) -> Option<String> {
    let limbs: Vec<&str> = moved.iter().map(|(kind, _)| kind.name()).collect();
    let most = 1e3 * moved.iter().map(|(_, by)| *by).reduce(f64::max)?;
    Some(format!(
        "no room for cloth beside the {} (less than {} mm): moved aside by up to {most:.1} mm",
        limbs.join(", "),
        1e3 * GAP
    ))
}

/// A surface as a thing that cloth lies on or is wound round: where the file has it, without parts; `why` is what it
/// lacks to be somebody.
fn object(
    surface: ObjSurface,
    name: String,
    file: &str,
    unit: Option<LengthUnit>,
    why: &str,
) -> Result<Body, BodyError> {
    let mut notes = vec![format!("an object without body parts ({why}): its coordinates are taken as they are")];
    let [low, high] = bounds(&surface.vertices);
    let longest = (high - low).max();
    let taken = unit.unwrap_or_else(|| LengthUnit::guessed(longest, UNITS_BELOW));
    if unit.is_none() {
        notes.push(assumed(taken, &format!("the object is {longest:.2} units long")));
    }
    let origin = SurfaceOrigin { file, unit: taken, turned: false };
    let mesh = checked(surface.vertices, surface.triangles, &origin, &mut notes)?;
    Ok(Body { mannequin: Mannequin { name, mesh, parts: Vec::new(), frame: BodyFrame::default() }, notes })
}

/// The closed surface (metres) that cloth can touch, with what its user should know of it; `vertices` are in the file's
/// unit, y up.
fn checked(
    mut vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    origin: &SurfaceOrigin,
    notes: &mut Vec<String>,
) -> Result<TriMesh, BodyError> {
    let scale = origin.unit.metres();
    vertices.iter_mut().for_each(|p| *p *= scale);
    let mesh = closed(vertices, triangles);
    let file = || origin.file.to_owned();
    let check = check_body(&mesh, |p| origin.place(p)).map_err(|fault| BodyError::Fault { file: file(), fault })?;
    refuse_crossings(&mesh, &check, origin)?;
    notes.extend(findings(&check, origin));
    Ok(mesh)
}

/// Refuses a surface that runs through itself in more than a few places: there is no telling its inside.
fn refuse_crossings(mesh: &TriMesh, check: &BodyCheck, origin: &SurfaceOrigin) -> Result<(), BodyError> {
    let triangles = mesh.triangles.len();
    match check.crossings {
        Some((pairs, place)) if pairs as f64 > CROSSING * triangles as f64 => {
            Err(BodyError::Crossing { file: origin.file.to_owned(), pairs, triangles, place: origin.place(place) })
        }
        _ => Ok(()),
    }
}

/// The notes of a body's check.
fn findings(check: &BodyCheck, origin: &SurfaceOrigin) -> Vec<String> {
    let mut notes = Vec::new();
    if check.parts > 1 {
        notes.push(format!("the body consists of {} parts that do not touch; all are kept", check.parts));
    }
    if let Some((pairs, p)) = check.crossings {
        notes.push(format!(
            "the surface crosses itself ({pairs} pairs of triangles, near {}); where cloth goes there, separate the \
             limbs or remesh",
            origin.place(p)
        ));
    }
    notes
}

/// Turns a body that lies along z upright, and says whether it did.
fn stand_up(vertices: &mut [Vec3], notes: &mut Vec<String>) -> bool {
    let [low, high] = bounds(vertices);
    if high.z - low.z <= high.y - low.y {
        return false;
    }
    for p in vertices {
        *p = Vec3::new(p.x, p.z, -p.y);
    }
    notes.push("z is the tall axis: turned so that y is up, as in what is written".to_owned());
    true
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

/// The height, if there is any.
fn height(vertices: &[Vec3]) -> Option<f64> {
    let [low, high] = range_of(vertices.iter().map(|p| p.y));
    (high > low).then_some(high - low)
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
    let mut same = coinciding(vertices);
    let mut seen: HashMap<u32, u32> = HashMap::new();
    let mut mesh = TriMesh::default();
    for tri in triangles {
        let tri = tri.map(|v| {
            *seen.entry(same.root(v)).or_insert_with(|| {
                mesh.vertices.push(vertices[v as usize]);
                mesh.vertices.len() as u32 - 1
            })
        });
        if tri[0] != tri[1] && tri[1] != tri[2] && tri[2] != tri[0] {
            mesh.triangles.push(tri);
        }
    }
    mesh
}

/// Which vertices are one: those that share a cell of one of eight grids. The cells are twice [`WELD`] wide and the
/// grids shifted by half a cell along some of the axes, so that no two vertices nearer than that have a border between
/// them in all of the grids; and however many there are in a cell, each is looked at eight times.
fn coinciding(vertices: &[Vec3]) -> DisjointSets {
    let mut sets = DisjointSets::new(vertices.len());
    for grid in 0..8u8 {
        let shift = [0, 1, 2].map(|axis| 0.5 * f64::from(grid >> axis & 1));
        let mut first: HashMap<[i64; 3], u32> = HashMap::new();
        for (v, p) in (0..).zip(vertices) {
            let cell = [0, 1, 2].map(|axis| (p[axis] / (2.0 * WELD) + shift[axis]).floor() as i64);
            sets.join(*first.entry(cell).or_insert(v), v);
        }
    }
    sets
}

/// A mannequin as OBJ text: millimetres, y up, feet at y = 0.
pub fn mannequin_obj(mannequin: &Mannequin) -> String {
    let mut obj = ObjText::rounded(DECIMALS, 0);
    obj.comment(format_args!("{}: millimetres, y up, facing +z", mannequin.name));
    obj.object(&mannequin.name);
    mannequin.mesh.vertices.iter().for_each(|p| obj.vertex(&(p * MM)));
    mannequin.mesh.triangles.iter().for_each(|t| obj.face(*t));
    obj.into_text()
}
