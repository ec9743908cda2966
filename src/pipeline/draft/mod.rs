//! Draping on the form: from style lines on a body to a garment file.

mod file;
mod panels;
mod place;
mod shell;
mod skin;
mod written;

use std::path::Path;

use super::draft_error::DraftError;
use super::error::PipelineError;
use super::surface::{Darts, Limit, SurfaceOptions, Weld, flatten_faces};
use crate::fabric;
use crate::geometry::Vec3;
use crate::input::{LengthUnit, bytes, yaml};
use crate::io::body::load_body;
use crate::io::obj_read::ObjFaces;
use crate::mannequin::{Mannequin, PartKind};
use file::{DartsFile, EaseFile, LinesFile};
use place::Form;
use shell::{ShellEase, shell, tape};
use skin::{LinedSkin, SkinLine};
pub use written::{DraftedEase, DraftedPiece};

/// The fabric of a draft that names none.
const FABRIC: &str = "cotton_poplin";
/// Girths of a body without `ease` by girth at which the ease is held.
const HELD: [&str; 3] = ["hip", "waist", "bust"];
/// Bytes of a file of lines: a few pages of text.
const LARGEST: u64 = 1 << 20;

/// A garment drafted on a body.
#[derive(Clone, Debug)]
pub struct Drafted {
    /// The garment file.
    pub text: String,
    /// A row for each piece.
    pub pieces: Vec<DraftedPiece>,
    /// A row for each girth whose ease was asked for.
    pub ease: Vec<DraftedEase>,
    /// Darts that were cut.
    pub darts: usize,
    /// One sentence each.
    pub notes: Vec<String>,
}

/// Drafts the garment that the style lines of a file make on a body (a library name, `.yaml` or `.obj`).
///
/// # Errors
/// [`DraftError`] as a [`PipelineError`], with the line or the panel; a panel that cannot be laid flat.
pub fn draft(body: &str, unit: Option<LengthUnit>, lines: &Path) -> Result<Drafted, PipelineError> {
    let shown = lines.display().to_string();
    let refused = |why: String| DraftError::File { file: shown.clone(), why };
    let bytes = bytes(lines, LARGEST).map_err(|e| refused(e.to_string()))?;
    let text = String::from_utf8(bytes).map_err(|e| refused(e.to_string()))?;
    let file: LinesFile = yaml(&text).map_err(refused)?;
    let read = load_body(body, unit).map_err(DraftError::from)?;
    let ease = ease_of(&file.ease, &read.mannequin).map_err(refused)?;
    let formed = shell(&read.mannequin, &ease);
    let (form, named) = drawn(&file, &shown, &read.mannequin, &formed)?;
    let wrong = |(panel, why): (String, String)| DraftError::Panel { file: shown.clone(), panel, why };
    let regions = panels::regions(&form.skin);
    let chosen = panels::chosen(&form.skin, &regions, &named).map_err(wrong)?;
    let fabric = file.fabric.as_deref().unwrap_or(FABRIC);
    let options = SurfaceOptions {
        unit: Some(LengthUnit::Metre),
        up: Some(Vec3::y()),
        texture_seams: false,
        weld: Weld::Within(0.0),
        darts: Some(darts_of(file.darts.as_ref()).map_err(refused)?),
        limit: Limit::of(&fabric::load(fabric).map_err(DraftError::from)?),
        ..SurfaceOptions::default()
    };
    let faces = grouped(&form.skin, &named, &regions, &chosen);
    let heights = || faces.faces.iter().flatten().map(|&v| faces.vertices[v as usize].y);
    let reach = [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
    let mut flat = flatten_faces(lines, faces, &options)?;
    if let Some(failed) = flat.report.failed.first() {
        return Err(wrong((failed.name.clone(), format!("cannot be laid flat: {}", failed.why))).into());
    }
    flat.name_edges(&|vertices| line_of(&form.skin.lines, vertices));
    let about = written::GarmentStatements {
        file: &file,
        body,
        given: &read.mannequin,
        ease: &ease,
        fabric,
        places: &named,
        reach,
    };
    let mut drafted = written::written(&flat, &about, &formed)?;
    drafted.notes = read.notes;
    Ok(drafted)
}

/// The lines on the form, and a point in every panel.
fn drawn<'a>(
    file: &LinesFile,
    shown: &str,
    body: &'a Mannequin,
    formed: &Mannequin,
) -> Result<(Form<'a>, Vec<(String, Vec3)>), DraftError> {
    let mut form = Form { body, skin: LinedSkin { mesh: formed.mesh.clone(), lines: Vec::new() } };
    for (name, line) in file.all_lines() {
        let wrong = |why| DraftError::Line { file: shown.to_owned(), line: name.clone(), why };
        form.draw(&name, &line).map_err(wrong)?;
    }
    if let Some((line, why)) = panels::loose_end(&form) {
        return Err(DraftError::Line { file: shown.to_owned(), line, why });
    }
    let mut named = Vec::new();
    for (panel, point) in file.all_panels() {
        let wrong = |why| DraftError::Panel { file: shown.to_owned(), panel: panel.clone(), why };
        named.push((panel.clone(), form.point(&point).map_err(wrong)?));
    }
    if named.is_empty() {
        let why = "no panel is named; say 'panels: {front: {at: {height: 1100, angle: 0}}}'".to_owned();
        return Err(DraftError::File { file: shown.to_owned(), why });
    }
    Ok((form, named))
}

fn ease_of(file: &EaseFile, body: &Mannequin) -> Result<ShellEase, String> {
    let height = |girth: &str| body.parts.iter().flat_map(|p| &p.landmarks).find(|l| l.0 == girth).map(|l| l.1.y);
    let length = |name: &str, length: &file::LengthOrGirth| {
        let found = length.metres().filter(|x| *x >= 0.0);
        found.ok_or_else(|| format!("ease {name}: give a length from nought on, such as 40 or '4 cm'"))
    };
    let mut stations = Vec::new();
    match file {
        EaseFile::All(all) => {
            let ease = length("", all)?;
            stations.extend(HELD.iter().filter_map(|g| Some(((*g).to_owned(), height(g)?, ease))));
            if stations.is_empty() {
                stations.push((String::new(), 0.0, ease));
            }
        }
        EaseFile::Girths(all) => {
            for (girth, own) in &all.0 {
                let known = || body.parts.iter().flat_map(|p| &p.landmarks).map(|l| l.0.as_str()).collect::<Vec<_>>();
                let wrong = || format!("ease: the body has no height for '{girth}'; it has {}", known().join(", "));
                stations.push((girth.clone(), height(girth).ok_or_else(wrong)?, length(girth, own)?));
            }
        }
    }
    stations.sort_by(|a, b| a.1.total_cmp(&b.1));
    Ok(ShellEase { stations })
}

fn darts_of(file: Option<&DartsFile>) -> Result<Darts, String> {
    match file {
        None => Ok(Darts::Auto),
        Some(DartsFile::Count(count)) => Ok(Darts::Count(*count)),
        Some(DartsFile::Word(word)) if word == "auto" => Ok(Darts::Auto),
        Some(DartsFile::Word(word)) => Err(format!("darts: '{word}' is neither 'auto' nor a number")),
    }
}

/// The panels as groups of faces, each of the region `chosen` for it.
fn grouped(skin: &LinedSkin, named: &[(String, Vec3)], regions: &[u32], chosen: &[u32]) -> ObjFaces {
    let mut faces = ObjFaces {
        vertices: skin.mesh.vertices.clone(),
        groups: named.iter().map(|(name, _)| name.clone()).collect(),
        ..ObjFaces::default()
    };
    for (t, triangle) in skin.mesh.triangles.iter().enumerate() {
        if let Some(group) = chosen.iter().position(|c| *c == regions[t]) {
            faces.faces.push(triangle.to_vec());
            faces.group_of_face.push(group as u32);
        }
    }
    faces
}

/// The line on which most of these vertices lie, and more than one.
fn line_of(lines: &[SkinLine], vertices: &[u32]) -> Option<String> {
    let on = |line: &SkinLine| vertices.iter().filter(|v| line.chain.contains(v)).count();
    let best = lines.iter().map(|line| (on(line), line)).reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    (best.0 > 1).then(|| best.1.name.clone())
}

/// Whether a body part is of the trunk.
fn is_trunk(kind: PartKind) -> bool {
    matches!(kind, PartKind::Torso | PartKind::Neck)
}

/// By how much the form is longer round a girth than the body, as a tape reads both, metres.
fn grown(body: &Mannequin, formed: &Mannequin, girth: &str) -> Option<f64> {
    Some(tape(formed, girth)? - tape(body, girth)?)
}
