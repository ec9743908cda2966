//! The files of a run, in memory.

use super::error::PipelineError;
use super::run::Run;
use crate::geometry::Vec3;
use crate::io::obj_write::garment_obj;
use crate::io::pattern_svg::pattern_svg;
use crate::pattern::Notch;
use crate::picture::{Dressed, draw};
use crate::report::{Report, vertex_strain};

/// The draped garment.
pub const GARMENT_OBJ: &str = "garment.obj";
/// The sewn garment, before it was draped.
pub const SEWN_OBJ: &str = "sewn.obj";
/// The flattened pieces.
pub const PATTERN_SVG: &str = "pattern.svg";
/// The figures.
pub const REPORT_JSON: &str = "report.json";
/// The picture.
pub const GARMENT_PNG: &str = "garment.png";

/// A file's name and contents.
pub type ResultFile = (&'static str, Vec<u8>);

/// What the picture's colours say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Color {
    /// Which piece it is.
    #[default]
    Piece,
    /// How far warp and weft are stretched.
    Strain,
}

impl Run<'_> {
    /// Every file there is so far, with `report` as [`REPORT_JSON`].
    ///
    /// # Errors
    /// When one of them cannot be drawn.
    pub fn results(&self, report: &Report, color: Color) -> Result<Vec<ResultFile>, PipelineError> {
        let mut files = self.state(color)?;
        if let Some(draped) = &self.draped {
            files.push((GARMENT_OBJ, self.obj(draped)));
        }
        if let Some(flat) = &self.flattened {
            let notches: Vec<Notch> = self.job.garment.pieces.iter().flat_map(|p| p.notches.clone()).collect();
            files.push((PATTERN_SVG, pattern_svg(&self.job.mesh, flat, &notches)?.into_bytes()));
        }
        files.push((REPORT_JSON, json_text(report)?.into_bytes()));
        Ok(files)
    }

    /// The sewn garment and a picture of the latest state: what is left to look at when a later stage fails. Where
    /// sewing failed these are the pieces as they were placed, none joined. Empty before that.
    ///
    /// # Errors
    /// When the picture cannot be drawn.
    pub fn state(&self, color: Color) -> Result<Vec<ResultFile>, PipelineError> {
        if let (Some(placed), None) = (&self.placed, self.last()) {
            let apart: Vec<u32> = (0..placed.len() as u32).collect();
            let obj = garment_obj(&self.job.garment.name, &self.job.mesh, &apart, placed).into_bytes();
            return Ok(vec![(SEWN_OBJ, obj), (GARMENT_PNG, self.picture(&apart, placed, color)?)]);
        }
        let mut files = Vec::new();
        if let Some(sewn) = &self.sewn {
            files.push((SEWN_OBJ, self.obj(sewn)));
        }
        if let Some(last) = self.last() {
            files.push((GARMENT_PNG, self.picture(&self.stitching.class, last, color)?));
        }
        Ok(files)
    }

    fn obj(&self, at: &[Vec3]) -> Vec<u8> {
        garment_obj(&self.job.garment.name, &self.job.mesh, &self.stitching.class, at).into_bytes()
    }

    fn picture(&self, class: &[u32], at: &[Vec3], color: Color) -> Result<Vec<u8>, PipelineError> {
        let strain = (color == Color::Strain).then(|| vertex_strain(&self.job.mesh, at));
        let dressed = Dressed::new(&self.job.mesh, class, at, strain.as_deref());
        let subtitle = format!("{}, {}", self.job.body.name, self.job.fabric_names());
        Ok(draw(&dressed.scene(&self.job.body.mesh, &self.job.garment.title, &subtitle))?)
    }
}

/// A report as JSON text with a line feed at its end.
///
/// # Errors
/// When a value has no JSON.
pub fn json_text(report: &impl serde::Serialize) -> Result<String, PipelineError> {
    let mut text = serde_json::to_string_pretty(report)?;
    text.push('\n');
    Ok(text)
}
