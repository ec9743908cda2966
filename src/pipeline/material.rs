//! Fabrics and body of a garment, and the line of its file that is to blame when one cannot be had, or no mesh made.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::cloth::Fabrics;
use super::error::PipelineError;
use super::fit;
use super::overrides::{Overrides, SPACING};
use crate::fabric::{Fabric, FabricError};
use crate::geometry::MM;
use crate::io::body::{Body, BodyError, load_body_of};
use crate::io::garment::{self, Loaded, Refused, Variant};
use crate::mannequin::{self, Mannequin, MannequinError, Measures};
use crate::mesh::{self, MeshError};
use crate::pattern::{self, Diagnostic, Findings, GarmentFile, Located, Problem, Spot, Unit, Value};
use crate::sew::Stance;

/// A garment file without mistakes.
pub struct Checked {
    /// The file.
    pub file: PathBuf,
    /// The garment, and its warnings.
    pub loaded: Loaded,
    /// The body that the file names.
    pub body: Option<Mannequin>,
    /// That body as the garment is sewn on, where its limbs nearly touch.
    pub stance: Option<Stance>,
}

/// Reads a garment file and finds everything that is wrong before cloth moves: in its text, pieces and seams, its
/// fabrics and its body, and, if nothing is, in its mesh of this spacing (metres).
///
/// # Errors
/// Every mistake of the file.
pub fn check(file: &Path, spacing: Option<f64>) -> Result<Checked, Refused> {
    check_variant(file, Variant::default(), spacing)
}

/// As [`check`], of a variant of the garment.
///
/// # Errors
/// As [`check`].
pub fn check_variant(file: &Path, variant: Variant, spacing: Option<f64>) -> Result<Checked, Refused> {
    check_examined(file, garment::examine_variant(file, variant), spacing)
}

/// As [`check_variant`], from the text of a file that need not exist: its name is the garment's,
/// and other files are looked for in its folder.
///
/// # Errors
/// As [`check`].
pub fn check_text(file: &Path, text: &str, variant: Variant, spacing: Option<f64>) -> Result<Checked, Refused> {
    let shown = file.display().to_string();
    check_examined(file, garment::examine_text_variant(&short_name(file), &shown, text, variant), spacing)
}

/// As [`super::read_variant`], from the text of a file that need not exist.
///
/// # Errors
/// Every mistake of the text.
pub fn read_text(file: &Path, text: &str, variant: Variant) -> Result<Loaded, PipelineError> {
    let shown = file.display().to_string();
    Ok(garment::examine_text_variant(&short_name(file), &shown, text, variant).finish()?)
}

fn short_name(file: &Path) -> String {
    file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy().into_owned()
}

fn check_examined(file: &Path, mut examined: garment::Examined, spacing: Option<f64>) -> Result<Checked, Refused> {
    let body = examined.file.as_ref().and_then(|said| look(file, said, &mut examined.findings));
    let mut loaded = examined.finish()?;
    if let Some(body) = &body {
        doubt_size(&mut loaded, body);
    }
    let mesh = mesh::build(&loaded.garment, spacing.unwrap_or(SPACING)).map_err(|error| {
        let at = mesh_spot(&loaded.file, error.culprit()).unwrap_or_default();
        let mut refused = loaded.refusal(at, Problem::Mesh(error.to_string()));
        refused.diagnostics.extend(loaded.warnings.iter().cloned());
        refused.diagnostics.sort_by_key(Diagnostic::order);
        refused
    })?;
    let mut findings = loaded.findings();
    fit::tell_narrow(&loaded, &mesh, 0, &mut findings);
    let body = body.map(|body| body.mannequin);
    let stance = body.as_ref().and_then(|body| Stance::of(body, &loaded.garment));
    if let Some(body) = &body {
        fit::check_places(&loaded, &mesh, body, stance.as_ref(), &mut findings);
    }
    Ok(Checked { file: file.to_owned(), loaded: with_findings(loaded, findings)?, body, stance })
}

/// Doubts the size before meshing: pieces drawn in another unit may be too small for the spacing, and this gives the
/// reason.
fn doubt_size(loaded: &mut Loaded, body: &Body) {
    let mut findings = loaded.findings();
    fit::doubt_size(loaded, &body.mannequin, &mut findings);
    loaded.warnings.extend(findings.into_sorted());
}

/// The garment with further findings added to its warnings. It is refused if any of them is an error.
fn with_findings(mut loaded: Loaded, findings: Findings) -> Result<Loaded, Refused> {
    let refused = findings.errors() > 0;
    let mut diagnostics = loaded.warnings.clone();
    diagnostics.extend(findings.into_sorted());
    diagnostics.sort_by_key(Diagnostic::order);
    if refused {
        return Err(Refused { diagnostics });
    }
    loaded.warnings = diagnostics;
    Ok(loaded)
}

/// Reports faults of the fabrics and the body that a file names. Returns the body, if it can be loaded.
fn look(file: &Path, said: &GarmentFile, findings: &mut Findings) -> Option<Body> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let named = pattern::fabrics(said);
    let fabrics = Fabrics::named(&named, folder);
    for (entry, fabric) in said.fabrics.iter().zip(&fabrics.all()) {
        blame_fabric(said, entry, fabric, findings);
    }
    bounded_fabrics(said, &fabrics, findings);
    // A file without a body is told so by whatever needs one.
    let name = said.body.as_ref()?;
    let wanted = body_name(file, Some(&name.value), None).ok()?;
    let unit = said.body_units.as_ref().map(|u| u.value);
    let measures = match measures(said) {
        Ok(measures) => measures,
        Err((at, why)) => {
            findings.error(at, Problem::Body(why));
            return None;
        }
    };
    match load_body_of(&wanted, unit, &measures) {
        Ok(body) => {
            let note = |note: &String| Problem::Body(format!("{wanted}: {note}"));
            body.notes.iter().for_each(|told| findings.warn(name.at, note(told)));
            Some(body)
        }
        Err(error) => {
            findings.error(name.at, Problem::Body(error.to_string()));
            None
        }
    }
}

/// The measures of the wearer that a file gives beside its mannequin, or the place of a wrong one and the reason.
fn measures(said: &GarmentFile) -> Result<Measures, (Spot, String)> {
    let default = said.units.as_ref().map_or(Unit::Millimetre, |unit| unit.value);
    let mut out = Measures::default();
    for (name, length) in &said.body_measures {
        let mm = MM * length.value.value(default);
        out.add(&name.value, mm).map_err(|why| (name.at, why))?;
    }
    Ok(out)
}

/// Reports faults of a fabric, and notes on it, at its place in the file.
fn blame_fabric(said: &GarmentFile, entry: &Entry, fabric: &Result<Fabric, FabricError>, findings: &mut Findings) {
    match fabric {
        Err(error) => findings.error(fabric_spot(said, entry, error), Problem::Fabric(error.to_string())),
        Ok(fabric) => {
            let notes = fabric.notes();
            if let Some(at) = curve_spot(&entry.1) {
                notes.into_iter().for_each(|note| findings.warn(at, Problem::Fabric(note)));
            }
        }
    }
}

/// Names in reports of the fabrics that the file's `tests` are for, by the words of the file. A fabric that cannot be
/// loaded is reported at the test, unless it is one of the garment's own, which is reported at its definition.
fn bounded_fabrics(said: &GarmentFile, fabrics: &Fabrics, findings: &mut Findings) -> HashMap<String, String> {
    let mut names = HashMap::new();
    for word in said.tests.iter().filter_map(|test| test.value.fabric.as_ref()) {
        let own = said.fabrics.iter().any(|f| f.0.value == word.value);
        match fabrics.name_of(&word.value) {
            Ok(name) => drop(names.insert(word.value.clone(), name)),
            Err(error) if !own => findings.error(word.at, Problem::Fabric(error.to_string())),
            Err(_) => {}
        }
    }
    names
}

/// Has every test of the garment name its fabric as reports do.
///
/// # Errors
/// A fabric that cannot be had.
pub(super) fn name_bounded_fabrics(file: &Path, loaded: &mut Loaded) -> Result<(), Refused> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let mut findings = loaded.findings();
    let fabrics = Fabrics::named(&loaded.garment.fabrics, folder);
    let names = bounded_fabrics(&loaded.file, &fabrics, &mut findings);
    for fabric in loaded.garment.tests.iter_mut().filter_map(|test| test.fabric.as_mut()) {
        if let Some(name) = names.get(fabric) {
            fabric.clone_from(name);
        }
    }
    garment::refuse(findings)
}

/// Fabrics by piece, and notes on them.
pub(super) fn fabrics(
    file: &Path,
    loaded: &Loaded,
    wanted: &Overrides,
) -> Result<(Vec<Arc<Fabric>>, Vec<String>), PipelineError> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let other = |source| PipelineError::Fabric(Box::new(source));
    let (instead, given) = (wanted.fabric.as_deref(), wanted.given.fabric.as_ref());
    let fabrics = Fabrics::of(&loaded.garment, folder, instead, given).map_err(other)?;
    let mut findings = loaded.findings();
    let mut notes = Vec::new();
    let mut resolved = Vec::new();
    for (k, fabric) in fabrics.all().into_iter().enumerate() {
        match loaded.file.fabrics.get(k).filter(|_| fabrics.replaced != Some(k)) {
            Some(entry) => blame_fabric(&loaded.file, entry, &fabric, &mut findings),
            None => notes.extend(fabric.as_ref().map(Fabric::notes).unwrap_or_default()),
        }
        resolved.push(fabric);
    }
    let refused = findings.errors() > 0;
    let diagnostics = findings.into_sorted();
    if refused {
        return Err(Refused { diagnostics }.into());
    }
    notes.extend(diagnostics.iter().map(ToString::to_string));
    let resolved = resolved.into_iter().collect::<Result<Vec<Fabric>, FabricError>>().map_err(other)?;
    Ok((fabrics.by_piece(&loaded.garment, resolved).map_err(other)?, notes))
}

type Entry = (Located<String>, Located<Value>);

/// Place of the wrong value, or of the fabric's base, or of its name.
fn fabric_spot(file: &GarmentFile, entry: &Entry, error: &FabricError) -> Spot {
    let (fabric, key) = error.culprit();
    let (name, value) = file.fabrics.iter().find(|f| fabric == Some(f.0.value.as_str())).unwrap_or(entry);
    if let Some(at) = error.file().and_then(|file| at_file(value, Path::new(file))) {
        return at;
    }
    match &value.value {
        Value::Text(_) => value.at,
        _ => key.map_or_else(|| at_key(value, "base"), |key| at_key(value, key)).unwrap_or(name.at),
    }
}

/// Place in the file of a stretch curve, or of the fabric file with the curve. `None` if it multiplies the curve of
/// another fabric of the garment, where the note belongs.
fn curve_spot(value: &Located<Value>) -> Option<Spot> {
    let is_file = |value: &&Located<Value>| match &value.value {
        Value::Text(text) => text.parse::<f64>().is_err() && Path::new(text.trim()).extension().is_some(),
        _ => false,
    };
    let entries = match &value.value {
        Value::Text(_) => return Some(value).filter(is_file).map(|v| v.at),
        Value::List(_) => return None,
        Value::Map(entries) => entries,
    };
    let get = |key: &str| entries.iter().find(|e| e.0.value == key).map(|e| &e.1);
    let curve = get("tensile").and_then(|tensile| match &tensile.value {
        Value::Map(ways) => {
            let has_points = |way: &Located<Value>| {
                matches!(&way.value, Value::Map(entries) if entries.iter().any(|e| e.0.value == "curve"))
            };
            ways.iter().map(|(_, way)| way).find(|way| is_file(way) || has_points(way))
        }
        _ => Some(tensile).filter(is_file),
    });
    curve.or_else(|| get("base").filter(is_file)).map(|v| v.at)
}

/// The place of `tensile.warp.EMT` in nested mappings, or of as much of it as is written.
fn at_key(value: &Located<Value>, key: &str) -> Option<Spot> {
    let Value::Map(entries) = &value.value else { return Some(value.at) };
    let inner = |(name, value): &Entry| {
        let rest = key.strip_prefix(name.value.as_str())?;
        if rest.is_empty() { Some(value.at) } else { at_key(value, rest.strip_prefix('.')?).or(Some(name.at)) }
    };
    entries.iter().find_map(inner)
}

/// The place where a file is named.
fn at_file(value: &Located<Value>, file: &Path) -> Option<Spot> {
    match &value.value {
        Value::Text(text) => (!text.is_empty() && file.ends_with(text.trim())).then_some(value.at),
        Value::List(items) => items.iter().find_map(|item| at_file(item, file)),
        Value::Map(entries) => entries.iter().find_map(|(_, value)| at_file(value, file)),
    }
}

/// The body with the name it is asked for. The unit of its file is the user's, or else the garment file's, which is
/// that of the file's own body.
pub(super) fn body(file: &Path, loaded: &Loaded, wanted: &Overrides) -> Result<(String, Body), PipelineError> {
    let instead = wanted.body.as_deref();
    if let Some(body) = &wanted.given.body {
        return Ok((instead.unwrap_or(&body.mannequin.name).to_owned(), Body::clone(body)));
    }
    let name = body_name(file, loaded.garment.body.as_deref(), instead)?;
    let said = loaded.file.body.as_ref().filter(|_| instead.is_none());
    let own_unit = said.and(loaded.file.body_units.as_ref()).map(|u| u.value);
    let own = match said {
        Some(_) => measures(&loaded.file)
            .map_err(|(at, why)| PipelineError::Garment(loaded.refusal(at, Problem::Body(why))))?,
        None => Measures::default(),
    };
    let measures = wanted.measures.clone().over(&own);
    let body = load_body_of(&name, wanted.body_unit.or(own_unit), &measures).map_err(|error| match said {
        Some(said) if cannot_be_had(&error) && wanted.measures.is_empty() => {
            PipelineError::Garment(loaded.refusal(said.at, Problem::Body(error.to_string())))
        }
        _ => PipelineError::Body(error),
    })?;
    Ok((name, body))
}

/// The measures of a garment's wearer by name, metres.
fn sizes(loaded: &Loaded) -> Vec<(&str, f64)> {
    let default = loaded.file.units.as_ref().map_or(Unit::Millimetre, |unit| unit.value);
    loaded.file.body_measures.iter().map(|(name, q)| (name.value.as_str(), q.value.value(default))).collect()
}

/// The body of garments worn together, by the name it is asked for.
pub(super) fn body_of_all(worn: &[(PathBuf, Loaded)], wanted: &Overrides) -> Result<(String, Body), PipelineError> {
    let (inner, loaded) = &worn[0];
    if wanted.given.body.is_some() {
        return body(inner, loaded, wanted);
    }
    let own = |file: &Path, loaded: &Loaded| body_name(file, loaded.garment.body.as_deref(), wanted.body.as_deref());
    let other_body = own(inner, loaded)?;
    for (file, loaded) in &worn[1..] {
        let body = own(file, loaded)?;
        if body != other_body || wanted.body.is_none() && sizes(loaded) != sizes(&worn[0].1) {
            return Err(PipelineError::Bodies { file: file.clone(), body, other: inner.clone(), other_body });
        }
    }
    body(inner, loaded, wanted)
}

/// Whether there is no such body, rather than something wrong in its own file.
fn cannot_be_had(error: &BodyError) -> bool {
    use crate::io::obj_read::ObjError;
    matches!(
        error,
        BodyError::Obj(ObjError::Read { .. } | ObjError::TooLarge { .. })
            | BodyError::Mannequin(
                MannequinError::Unknown { .. } | MannequinError::Read { .. } | MannequinError::Measure { .. }
            )
    )
}

/// The body to load: the user's, or else the file's, whose path is relative to the file.
pub(super) fn body_name(file: &Path, said: Option<&str>, instead: Option<&str>) -> Result<String, PipelineError> {
    if let Some(name) = instead {
        return Ok(name.to_owned());
    }
    let name = said.ok_or_else(|| PipelineError::NoBody(file.to_owned()))?;
    if mannequin::library().contains(&name) || Path::new(name).extension().is_none() {
        return Ok(name.to_owned());
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    Ok(folder.join(name).display().to_string())
}

/// Garments that cannot be meshed: the statement that is to blame, or the spacing. In an outfit names tell the garment.
pub(super) fn mesh_error(worn: &[(PathBuf, Loaded)], source: MeshError) -> PipelineError {
    let (file, loaded) = &worn[0];
    match mesh_spot(&loaded.file, source.culprit()).filter(|_| worn.len() == 1) {
        Some(at) => PipelineError::Garment(loaded.refusal(at, Problem::Mesh(source.to_string()))),
        None => PipelineError::Mesh { file: file.to_owned(), source: Box::new(source) },
    }
}

/// Place in the file of the edge, line or seam, or else of its piece. Names of cut pieces are those of drawn ones with
/// a side or a number after them.
fn mesh_spot(file: &GarmentFile, (piece, part): (Option<&str>, Option<&str>)) -> Option<Spot> {
    let stem = |name: &str| name.split('.').next().unwrap_or_default().to_owned();
    let named = |written: &Located<String>, wanted: &str| written.value == stem(wanted);
    let Some(piece) = piece else {
        let seam = part?;
        // Seams of darts and pleats bear the names of their pieces.
        let written = file.seams.iter().map(|s| &s.name).chain(file.pieces.iter().map(|p| &p.name));
        return written.into_iter().find(|name| named(name, seam)).map(|name| name.at);
    };
    let piece = file.pieces.iter().find(|p| named(&p.name, piece))?;
    let part = part.and_then(|part| {
        let edges = piece.outline.iter().flat_map(|o| o.edges.iter().map(|e| &e.0));
        let mut names = edges.chain(piece.holes.iter().map(|h| &h.0)).chain(piece.lines.iter().map(|l| &l.name));
        names.find(|name| named(name, part)).map(|name| name.at)
    });
    Some(part.unwrap_or(piece.name.at))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_of_the_file_lie_beside_it_and_those_of_the_user_do_not() {
        let file = Path::new("a/dress.yaml");
        let named = |said, instead| body_name(file, said, instead).map_err(|e| e.to_string());
        assert_eq!(named(Some("woman_92"), None).as_deref(), Ok("woman_92"));
        assert_eq!(named(Some("anna.obj"), None).as_deref(), Ok("a/anna.obj"));
        assert_eq!(named(Some("woman_92"), Some("bert.obj")).as_deref(), Ok("bert.obj"));
        assert!(named(None, None).is_err_and(|e| e.contains("--body")));
    }
}
