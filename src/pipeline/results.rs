//! The files of a run, in memory.

use super::error::PipelineError;
use super::job::Job;
use super::result_file::{ResultFile, json_text};
use super::run::Run;
use crate::dynamics::identity_nodes;
use crate::geometry::Vec3;
use crate::io::glb_write::{garment_glb, surface_glb};
use crate::io::obj_write::garment_obj;
use crate::io::result_names::{
    GARMENT_GLB, GARMENT_OBJ, GARMENT_PNG, PATTERN_SVG, PLACED_OBJ, REPORT_HTML, REPORT_JSON, SEWN_OBJ,
};
use crate::io::svg_write::pattern_svg;
use crate::pattern::Notch;
use crate::picture::{Dressed, PictureError, PictureLayout, Scale, Scene, Turning, draw, draw_turning};
use crate::report::{Report, page, vertex_strain};

/// Meaning of the picture's colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Color {
    /// The piece.
    #[default]
    Piece,
    /// The strain of warp and weft.
    Strain,
    /// The distance to the skin.
    Ease,
    /// The pressure on the skin. Pieces before the garment is draped.
    Pressure,
    /// The fabric.
    Fabric,
}

/// How the picture is drawn.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PictureOptions {
    /// Meaning of the colours.
    pub color: Color,
    /// Size and views.
    pub layout: PictureLayout,
}

impl Run<'_> {
    /// Every file there is so far, with `report` as [`REPORT_JSON`].
    ///
    /// # Errors
    /// When one of them cannot be drawn.
    pub fn results(&self, report: &Report, drawing: &PictureOptions) -> Result<Vec<ResultFile>, PipelineError> {
        let figures = json_text(report)?;
        let mut files = self.state(drawing)?;
        if let Some(draped) = &self.draped {
            files.push((GARMENT_OBJ, self.obj(draped, &self.class())));
            let glb = self.glb(draped);
            let body = &self.job.body;
            let body = surface_glb(&body.name, &body.mesh, |p| body.frame.to_file(p));
            files.push((REPORT_HTML, page(&report.garment, &figures, &glb, Some(&body)).into_bytes()));
            files.push((GARMENT_GLB, glb));
        }
        if let Some(flat) = &self.flattened {
            let notches: Vec<Notch> = self.job.garment.pieces.iter().flat_map(|p| p.notches.clone()).collect();
            files.push((PATTERN_SVG, pattern_svg(&self.job.mesh, flat, &notches)?.into_bytes()));
        }
        files.push((REPORT_JSON, figures.into_bytes()));
        Ok(files)
    }

    /// The files of the last state, for when a stage fails: the garment as sewn, or else its pieces as placed, and a
    /// picture of the latest state. Empty before the pieces have been placed.
    ///
    /// # Errors
    /// When the picture cannot be drawn.
    pub fn state(&self, drawing: &PictureOptions) -> Result<Vec<ResultFile>, PipelineError> {
        if let Some(last) = self.last() {
            let picture = (GARMENT_PNG, self.picture(last, &self.class(), drawing)?);
            let sewn = self.sewn.as_ref().map(|sewn| (SEWN_OBJ, self.obj(sewn, &self.class())));
            return Ok(sewn.into_iter().chain([picture]).collect());
        }
        let Some(placed) = &self.placed else { return Ok(Vec::new()) };
        // Every particle stands alone: partners are still apart.
        let alone = identity_nodes(&self.job.mesh);
        Ok(vec![(PLACED_OBJ, self.obj(placed, &alone)), (GARMENT_PNG, self.picture(placed, &alone, drawing)?)])
    }

    fn glb(&self, at: &[Vec3]) -> Vec<u8> {
        let Job { garment, mesh, fabrics, .. } = self.job;
        let gives: Vec<[f64; 2]> = fabrics.iter().map(|fabric| fabric.emt()).collect();
        garment_glb(garment, mesh, &self.stitching.class, &self.in_file(at), &self.maps(at), &gives)
    }

    pub(super) fn obj(&self, at: &[Vec3], class: &[u32]) -> Vec<u8> {
        garment_obj(&self.job.garment.name, &self.job.mesh, class, &self.in_file(at)).into_bytes()
    }

    /// Positions as they are written: where the body's own file has it.
    pub(super) fn in_file(&self, at: &[Vec3]) -> Vec<Vec3> {
        at.iter().map(|p| self.job.body.frame.to_file(*p)).collect()
    }

    fn picture(&self, at: &[Vec3], class: &[u32], drawing: &PictureOptions) -> Result<Vec<u8>, PipelineError> {
        let draw_it = |scene: &Scene| draw(scene, &drawing.layout);
        self.drawn(at, class, drawing.color, draw_it)
    }

    /// The garment as it is now, turning once round.
    ///
    /// # Errors
    /// When it cannot be drawn. A garment that has not been sewn has no surface.
    pub fn turning(&self, color: Color, format: Turning) -> Result<Vec<u8>, PipelineError> {
        self.drawn(self.last().unwrap_or_default(), &self.class(), color, |scene| draw_turning(scene, format))
    }

    /// The picture that `draw` makes of the scene.
    fn drawn(
        &self,
        at: &[Vec3],
        class: &[u32],
        color: Color,
        draw: impl Fn(&Scene) -> Result<Vec<u8>, PictureError>,
    ) -> Result<Vec<u8>, PipelineError> {
        let job = self.job;
        let values = self.values(at, color);
        let values = values.as_ref().map(|(values, scale)| (values.as_slice(), *scale));
        let mut dressed = Dressed::new(&job.mesh, class, at, values);
        if color == Color::Fabric {
            let mut names: Vec<String> = Vec::new();
            let group = job.fabrics.iter().map(|fabric| {
                names.iter().position(|name| *name == fabric.name).unwrap_or_else(|| {
                    names.push(fabric.name.clone());
                    names.len() - 1
                }) as u32
            });
            let group: Vec<u32> = group.collect();
            dressed = dressed.grouped(&group, names);
        }
        // What has not been sewn is round the body as that is sewn on.
        let apart = job.stance.as_ref().filter(|_| self.open || self.last().is_none());
        let body = apart.map_or(&job.body, |stance| &stance.body);
        Ok(draw(&dressed.scene(&body.mesh, &job.garment.title, &job.subtitle()))?)
    }

    /// The values that colour the cloth, one per particle. None where it has the colours of its pieces.
    fn values(&self, at: &[Vec3], color: Color) -> Option<(Vec<f64>, Scale)> {
        match color {
            Color::Piece | Color::Fabric => None,
            Color::Strain => Some((vertex_strain(&self.job.mesh, at), Scale::Strain)),
            Color::Ease => Some((self.ease(at), Scale::Ease)),
            Color::Pressure => self.pressure(at).map(|values| (values, Scale::Pressure)),
        }
    }
}
