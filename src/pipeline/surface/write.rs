//! The files of a flattened surface.

use super::super::error::PipelineError;
use super::super::result_file::{ResultFile, json_text};
use super::FlatSurface;
use super::darts::LaidPart;
use super::edges::PartRimEdge;
use super::form::form_obj;
use super::parts::SurfacePart;
use crate::flatten::triangle_strain;
use crate::geometry::{MM, Vec2};
use crate::io::obj_text::{ObjCorner, ObjText};
use crate::io::result_names::{FLAT_OBJ, FLAT_PNG, FORM_OBJ, GARMENT_YAML, OUTLINE_SVG, PATTERN_SVG, REPORT_JSON};
use crate::io::svg_write::{outline_svg, pattern_svg};
use crate::mesh::{ClothMesh, EdgeParticles, PieceMesh};
use crate::pattern::{EdgeId, Notch};
use crate::picture::draw_flat;

/// A face laid flat.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatCorners {
    /// Its piece, as the report counts them.
    pub piece: usize,
    /// The flat position of every corner.
    pub at: Vec<[f64; 2]>,
}

/// A face of the file in its part.
struct FaceInPart<'a> {
    /// Its number in the file.
    face: usize,
    /// The part's number.
    part: usize,
    /// Its corners as vertices of the part.
    locals: &'a [u32],
}

impl FlatSurface {
    /// `flat.obj`, `flat.png`, `pattern.svg`, `outline.svg`, `garment.yaml`, `report.json` and, of a surface with an
    /// inside, `form.obj`.
    ///
    /// # Errors
    /// When one of them cannot be drawn.
    pub fn results(&self) -> Result<Vec<ResultFile>, PipelineError> {
        let sheet = self.sheet();
        let form = self.form();
        let mut files = vec![
            (FLAT_OBJ, self.obj().into_bytes()),
            (FLAT_PNG, self.picture(&sheet)?),
            (PATTERN_SVG, pattern_svg(&sheet, &sheet.flat, &self.notches())?.into_bytes()),
            (OUTLINE_SVG, outline_svg(&sheet, &sheet.flat)?.into_bytes()),
            (GARMENT_YAML, self.garment(form.as_ref())?.into_bytes()),
            (REPORT_JSON, json_text(&self.report)?.into_bytes()),
        ];
        files.extend(form.map(|form| (FORM_OBJ, form_obj(&form.mesh).into_bytes())));
        Ok(files)
    }

    /// The file's vertices and faces as they were, with flat texture coordinates in mm. Numbers are written so that
    /// they read back as the same.
    fn obj(&self) -> String {
        let (version, surface) = (env!("CARGO_PKG_VERSION"), &self.report.surface);
        let mut obj = ObjText::exact();
        obj.comment(format_args!("toile {version}: {surface}; vt = flat position (x, -y), millimetres"));
        self.sheet.faces.vertices.iter().for_each(|p| obj.vertex(p));
        let mut first = Vec::with_capacity(self.laid.len());
        let mut written = 0;
        for flat in self.laid.iter().map(|l| &l.flat.positions) {
            first.push(written);
            written += flat.len();
            flat.iter().for_each(|p| obj.texture(&(self.ease.cut(*p) * MM)));
        }
        let mut group = None;
        for FaceInPart { face, part, locals } in self.faces_in_parts() {
            if group != Some(part) {
                obj.group(&self.part(part).name);
                group = Some(part);
            }
            // Parts that could not be laid flat have no flat positions.
            let texture = |local: u32| first.get(part).map(|first| first + local as usize);
            let corners = self.sheet.faces.faces[face].iter().zip(locals);
            obj.face(corners.map(|(&v, &local)| ObjCorner { texture: texture(local), ..v.into() }));
        }
        obj.into_text()
    }

    /// A part: those that are laid flat, then those that cannot be.
    fn part(&self, k: usize) -> &SurfacePart {
        self.laid.get(k).map_or_else(|| &self.failed[k - self.laid.len()].part, |laid| &laid.part)
    }

    /// The faces that are left of the file, in its order, those that one was split into in its place.
    fn faces_in_parts(&self) -> Vec<FaceInPart<'_>> {
        let count = self.laid.len() + self.failed.len();
        let mut part_of_face = vec![0; self.sheet.faces.faces.len()];
        for k in 0..count {
            self.part(k).faces.iter().for_each(|&f| part_of_face[f as usize] = k);
        }
        let mut seen = vec![0; count];
        let of_face = |f: u32| {
            let part = part_of_face[f as usize];
            seen[part] += 1;
            FaceInPart { face: f as usize, part, locals: &self.part(part).corners[seen[part] - 1] }
        };
        self.sheet.order().into_iter().map(of_face).collect()
    }

    /// The flat position (x, −y) of every corner of every face that was given, mm, as in [`FLAT_OBJ`]. A face that was
    /// left out, could not be laid flat, or lies on several sides of a cut has none.
    pub fn corners(&self) -> Vec<Option<FlatCorners>> {
        let given = self.given();
        let mut corners: Vec<Option<FlatCorners>> = vec![None; given];
        let mut spoilt = vec![false; given];
        for FaceInPart { face, part, locals } in self.faces_in_parts() {
            let of = self.sheet.origin[face] as usize;
            let laid = self.laid.get(part);
            let flat = |&local: &u32| laid.map(|l| self.ease.cut(l.flat.positions[local as usize]));
            let at = |local: &u32| flat(local).map(|p| [p.x * MM, -p.y * MM]);
            let Some(at) = locals.iter().map(at).collect::<Option<Vec<_>>>() else { continue };
            spoilt[of] |= of != face;
            corners[of] = (!spoilt[of]).then_some(FlatCorners { piece: part, at });
        }
        corners
    }

    /// How many faces the file has.
    fn given(&self) -> usize {
        self.sheet.origin.iter().enumerate().filter(|(f, of)| *f == **of as usize).count()
    }

    /// The pieces coloured by strain.
    fn picture(&self, sheet: &ClothMesh) -> Result<Vec<u8>, PipelineError> {
        let strain: Vec<f64> =
            self.laid.iter().flat_map(|l| triangle_strain(&l.part.surface, &l.flat.positions)).collect();
        Ok(draw_flat(sheet, &strain, &self.report.surface)?)
    }

    /// A notch in the middle of every edge that is sewn to another, at the same vertex on both sides. An edge without a
    /// vertex between its ends has none: it is matched by these.
    fn notches(&self) -> Vec<Notch> {
        let mut notches = Vec::new();
        for (piece, edges) in self.edges.iter().enumerate() {
            for (index, edge) in edges.iter().enumerate().filter(|(_, e)| e.partner.is_some()) {
                let at = |v: u32| self.ease.cut(self.laid[piece].flat.positions[v as usize]);
                let lengths: Vec<f64> = edge.vertices.windows(2).map(|w| (at(w[1]) - at(w[0])).norm()).collect();
                if lengths.len() > 1 {
                    let middle = edge.middle([piece, index]);
                    let edge = EdgeId { piece, ring: edge.ring, index };
                    notches.push(Notch { edge, at: lengths[..middle].iter().sum(), double: false });
                }
            }
        }
        notches
    }

    /// The flat parts as the pieces of a cloth, each with its rims as edges.
    fn sheet(&self) -> ClothMesh {
        let mut cloth = ClothMesh::default();
        for (k, LaidPart { part, flat, .. }) in self.laid.iter().enumerate() {
            let (particle, triangle) = (cloth.flat.len(), cloth.triangles.len());
            cloth.flat.extend(flat.positions.iter().map(|p| self.ease.cut(*p)));
            cloth.triangles.extend(part.surface.triangles.iter().map(|t| t.map(|v| v + particle as u32)));
            cloth.pieces.push(PieceMesh {
                name: part.name.clone(),
                particles: particle..cloth.flat.len(),
                triangles: triangle..cloth.triangles.len(),
                edges: self.edges[k].iter().enumerate().map(|(n, e)| particles(k, n, e, particle as u32)).collect(),
                lines: Vec::new(),
                smallest_angle: 0.0,
                warp: -Vec2::y(),
                narrow: None,
            });
        }
        cloth
    }
}

/// An edge as particles of the sheet.
fn particles(piece: usize, index: usize, edge: &PartRimEdge, first: u32) -> EdgeParticles {
    EdgeParticles {
        edge: EdgeId { piece, ring: edge.ring, index },
        name: edge.name.clone(),
        particles: edge.vertices.iter().map(|v| v + first).collect(),
    }
}
