//! Going on from an earlier result of the same garment, or of one that has been changed since.

use std::path::{Path, PathBuf};

use super::error::PipelineError;
use super::job::Job;
use super::levels::{Closed, is_whole};
use crate::contact::Collider;
use crate::geometry::{MM, Vec2, Vec3};
use crate::input::bytes;
use crate::io::obj_read::{ObjFaces, parse_obj_faces, read_obj_faces};
use crate::io::result_names::{GARMENT_OBJ, REPORT_JSON, SEWN_OBJ};
use crate::mannequin::Mannequin;
use crate::mesh::{ClothMesh, EarlierMesh, EarlierPiece, Edges, PieceMesh, interpolated};
use crate::report::{ContinuedFrom, Report};
use crate::sew::{Stitching, join};

/// Larger reports are refused before they are read.
const LARGEST: u64 = 256 << 20;
/// Seams that lie no further open than this, metres, are stitched as they are. Others are drawn shut first.
const NEARLY_SHUT: f64 = 5e-3;
/// How deep in a body that has become larger the cloth is looked for, metres.
const DEEPEST: f64 = 0.06;
/// Cloth that comes out of the body takes along what lies within this distance of it, metres, so that layers stay in
/// their order.
const ALONG: f64 = 0.03;
/// Distance from the skin at which cloth comes out of the body, metres.
const OUTSIDE: f64 = 1e-3;

/// The result of an earlier run, to go on from.
#[derive(Clone, Debug)]
pub struct Earlier {
    pub(super) folder: PathBuf,
    pub(super) mesh: EarlierMesh,
    /// Positions of its particles, metres.
    pub(super) at: Vec<Vec3>,
}

/// A garment that goes on from an earlier one.
pub(super) enum Continued {
    /// All its pieces hang where that one's do, stitched.
    Hanging {
        stitching: Stitching,
        /// As [`Closed::gaps`].
        gaps: Vec<Vec<f64>>,
        /// Positions of the classes.
        nodes: Vec<Vec3>,
    },
    /// It was sewn anew, from where that one's pieces hang.
    Sewn(Box<Closed>),
}

/// The files of an earlier result, from memory.
#[derive(Clone, Copy, Debug)]
pub struct EarlierFiles<'a> {
    /// Its name in the report.
    pub name: &'a Path,
    /// `garment.obj`, or `sewn.obj` of a garment that was only sewn.
    pub surface: &'a [u8],
    /// `report.json`.
    pub report: &'a [u8],
}

impl Earlier {
    /// Reads what `toile make`, `drape` or `sew` has written into a folder.
    ///
    /// # Errors
    /// A file that is missing, cannot be read, or does not belong to the others.
    pub(super) fn read(folder: &Path, body: &Mannequin) -> Result<Self, PipelineError> {
        let draped = folder.join(GARMENT_OBJ);
        let file = if draped.exists() { draped } else { folder.join(SEWN_OBJ) };
        let report = read_report(&folder.join(REPORT_JSON))?;
        Self::told_by(folder, &file, &read_obj_faces(&file)?, &report, body)
    }

    /// As [`Self::read`], from memory.
    pub(super) fn parse(files: &EarlierFiles, body: &Mannequin) -> Result<Self, PipelineError> {
        let EarlierFiles { name, surface, report } = *files;
        let report = parsed_report(report, &name.join(REPORT_JSON))?;
        let file = name.join(GARMENT_OBJ);
        let surface = parse_obj_faces(&String::from_utf8_lossy(surface), &file.display().to_string())?;
        Self::told_by(name, &file, &surface, &report, body)
    }

    /// From the surface in `file` and the report beside it.
    fn told_by(
        folder: &Path,
        file: &Path,
        surface: &ObjFaces,
        report: &Report,
        body: &Mannequin,
    ) -> Result<Self, PipelineError> {
        let wrong = |why: String| PipelineError::Earlier { file: file.to_owned(), why };
        let mesh = earlier_mesh(surface, report).map_err(wrong)?;
        let mut at = vec![Vec3::zeros(); mesh.flat.len()];
        for (corners, points) in surface.faces.iter().zip(&surface.texture_of_face) {
            for (&vertex, &point) in corners.iter().zip(points) {
                at[point as usize] = body.frame.from_file(surface.vertices[vertex as usize] / MM);
            }
        }
        Ok(Self { folder: folder.to_owned(), mesh, at })
    }

    /// Where the earlier cloth has the particles of `mesh`: [`EarlierMesh::carry`].
    fn carried(&self, mesh: &ClothMesh, edges: Edges) -> Vec<Option<Vec3>> {
        self.mesh.carry(&self.at, mesh, edges)
    }

    /// The pieces of `mesh` that are new, and how far its particles, which have come to lie at `at`, have moved.
    pub(super) fn told(&self, mesh: &ClothMesh, at: &[Vec3], anew: bool) -> ContinuedFrom {
        let carried = self.carried(mesh, Edges::Loose);
        let is_new = |piece: &&PieceMesh| carried[piece.particles.clone()].iter().all(Option::is_none);
        let moved: Vec<f64> = at.iter().zip(&carried).filter_map(|(p, q)| q.map(|q| (p - q).norm() * MM)).collect();
        ContinuedFrom {
            folder: self.folder.display().to_string(),
            anew,
            new: mesh.pieces.iter().filter(is_new).map(|piece| piece.name.clone()).collect(),
            moved_mean: moved.iter().sum::<f64>() / moved.len().max(1) as f64,
            moved_max: moved.iter().copied().fold(0.0, f64::max),
        }
    }
}

fn read_report(file: &Path) -> Result<Report, PipelineError> {
    let wrong = |why: String| PipelineError::Earlier { file: file.to_owned(), why };
    let text = bytes(file, LARGEST).map_err(|e| wrong(e.to_string()))?;
    parsed_report(&text, file)
}

fn parsed_report(text: &[u8], file: &Path) -> Result<Report, PipelineError> {
    let wrong = |why: String| PipelineError::Earlier { file: file.to_owned(), why };
    serde_json::from_slice(text).map_err(|e| wrong(format!("no report of a garment: {e}")))
}

/// The mesh that a surface with flat positions and the report beside it tell of.
fn earlier_mesh(surface: &ObjFaces, report: &Report) -> Result<EarlierMesh, String> {
    let flat: Vec<Vec2> = surface.texture.iter().map(|[u, v]| Vec2::new(*u, -v) / MM).collect();
    let mut out = EarlierMesh { flat, spacing: report.spacing / MM, ..EarlierMesh::default() };
    for piece in &report.pieces {
        let Some(group) = surface.groups.iter().position(|name| *name == piece.name) else {
            return Err(format!("no group '{}', but the report beside it has a piece of that name", piece.name));
        };
        let first = out.triangles.len();
        let faces = surface.group_of_face.iter().zip(&surface.texture_of_face);
        for (_, points) in faces.filter(|(of, _)| **of as usize == group) {
            let corners = <[u32; 3]>::try_from(&points[..]);
            out.triangles.push(corners.map_err(|_| "a face is no triangle with flat positions (vt)".to_owned())?);
        }
        let mut edges = Vec::new();
        for edge in &piece.edges {
            let is_there = |p: &usize| (1..=out.flat.len()).contains(p);
            if edge.points.len() < 2 || !edge.points.iter().all(is_there) {
                return Err(format!("edge '{}.{}' of the report is not in it", piece.name, edge.name));
            }
            edges.push((edge.name.clone(), edge.points.iter().map(|p| *p as u32 - 1).collect()));
        }
        out.pieces.push(EarlierPiece { name: piece.name.clone(), triangles: first..out.triangles.len(), edges });
    }
    let is_whole = out.spacing > 0.0 && out.pieces.iter().all(|p| !p.triangles.is_empty() && !p.edges.is_empty());
    if is_whole { Ok(out) } else { Err("the report beside it does not tell its edges or its spacing".into()) }
}

impl Job {
    /// The garment where an earlier one hangs. `None` where it does not come out whole.
    pub(super) fn continued(&self, earlier: &Earlier, progress: &mut dyn FnMut(f64)) -> Option<Continued> {
        let stitching = Stitching::new(&self.mesh);
        // Seams mostly have been changed alike on both sides.
        for edges in [Edges::Loose, Edges::Shares] {
            let carried = earlier.carried(&self.mesh, edges);
            let Some(mut at) = carried.into_iter().collect::<Option<Vec<Vec3>>>() else { break };
            come_out(&self.collider, &mut at);
            let gaps = gaps(&self.mesh, &at);
            if gaps.iter().flatten().all(|gap| *gap <= NEARLY_SHUT) {
                let nodes = join(&self.cut(), &self.collider, &stitching, &at).ok().flatten();
                return nodes.map(|nodes| Continued::Hanging { stitching, gaps, nodes });
            }
        }
        self.sewn_in(earlier, progress).map(|closed| Continued::Sewn(Box::new(closed)))
    }

    /// The garment sewn where an earlier one hangs: pieces that this had lie there, and new ones beside them, as they
    /// do at the start of a garment made from nothing.
    fn sewn_in(&self, earlier: &Earlier, progress: &mut dyn FnMut(f64)) -> Option<Closed> {
        let mesh = &self.mesh;
        let carried = earlier.carried(mesh, Edges::Shares);
        let whole: Option<Vec<Vec3>> = carried.iter().copied().collect();
        let mut at = match whole {
            Some(at) => at,
            None => bring_along(mesh, &carried, self.started(mesh)?),
        };
        come_out(&self.collider, &mut at);
        self.sew_from(mesh, at, progress).ok().filter(|closed| is_whole(mesh, &closed.sewn))
    }
}

/// Moves the particles at `at` to where those that are `carried` lie. Pieces that are sewn to them come along, each as
/// its sewn edges do, and then what is sewn to these.
fn bring_along(mesh: &ClothMesh, carried: &[Option<Vec3>], mut at: Vec<Vec3>) -> Vec<Vec3> {
    let mut ways: Vec<Option<Vec3>> = carried.iter().zip(&at).map(|(to, from)| to.map(|to| to - from)).collect();
    loop {
        let mut moved = Vec::new();
        for piece in mesh.pieces.iter().filter(|piece| ways[piece.particles.clone()].iter().any(Option::is_none)) {
            let is_own = |n: u32| piece.particles.contains(&(n as usize));
            let pairs = mesh.seams.iter().flat_map(|seam| &seam.pairs).flat_map(|&[a, b]| [[a, b], [b, a]]);
            let sewn = pairs.filter(|&[own, other]| is_own(own) && !is_own(other));
            let rim: Vec<(Vec2, Vec3)> =
                sewn.filter_map(|[own, other]| Some((mesh.flat[own as usize], ways[other as usize]?))).collect();
            if !rim.is_empty() {
                moved.extend(piece.particles.clone().map(|n| (n, interpolated(&rim, mesh.flat[n]))));
            }
        }
        if moved.is_empty() {
            break;
        }
        moved.into_iter().for_each(|(n, way)| ways[n] = Some(way));
    }
    at.iter_mut().zip(ways).for_each(|(p, way)| *p += way.unwrap_or_default());
    at
}

/// For every seam the gaps of its pairs, metres.
fn gaps(mesh: &ClothMesh, at: &[Vec3]) -> Vec<Vec<f64>> {
    let gap = |[a, b]: &[u32; 2]| (at[*a as usize] - at[*b as usize]).norm();
    mesh.seams.iter().map(|seam| seam.pairs.iter().map(gap).collect()).collect()
}

/// Moves cloth that lies in the body out of it, the nearest way, and what lies beside it along with it.
fn come_out(body: &Collider, at: &mut [Vec3]) {
    let out = |p: &Vec3| {
        let near = body.nearest(*p, DEEPEST)?;
        (near.distance < 0.0).then(|| (*p, near.normal * (OUTSIDE - near.distance)))
    };
    let moved: Vec<(Vec3, Vec3)> = at.iter().filter_map(out).collect();
    if moved.is_empty() {
        return;
    }
    let way = |p: &Vec3| {
        let (far, by) = moved.iter().map(|(from, by)| ((from - p).norm(), by)).min_by(|a, b| a.0.total_cmp(&b.0))?;
        (far < ALONG).then(|| by * (1.0 - far / ALONG))
    };
    let ways: Vec<Option<Vec3>> = at.iter().map(way).collect();
    at.iter_mut().zip(ways).for_each(|(p, way)| *p += way.unwrap_or_default());
}
