//! From the file to the checked garment.

use super::cut::cut;
use super::diagnostic::{Findings, Located, Spot};
use super::draft::{Draft, draft};
use super::file::{GarmentFile, PieceFile, SeamFile};
use super::inherit::complete_pieces;
use super::problem::Problem;
use super::seam::{Seams, check_orientable, seams};
use super::value::Value;
use super::{FabricUse, Garment, allowance, bound, closure, cover, layers, notch, place_word};
use crate::fabric::FabricSpec;
use crate::input::nearest;
use crate::input::shown;

/// Name of the fabric of pieces that name none, in a file that names none.
const DEFAULT_FABRIC: &str = "shell";
/// Library name of the default fabric.
pub const DEFAULT_CLOTH: &str = "cotton_poplin";
/// Number of characters of a title that are shown.
const TITLE: usize = 200;

/// Cuts the pieces, opens darts, lays pleats, writes mirrored seams out and checks everything that can be checked
/// without sewing. `name` is the garment's short name.
///
/// Faults go to `findings`. With errors among them the result is not to be used. `None` if nothing usable came out.
pub fn expand(name: &str, file: &GarmentFile, findings: &mut Findings) -> Option<Garment> {
    if file.pieces.is_empty() {
        findings.error(file.version.at, Problem::NoPieces);
        return None;
    }
    findings.know_pieces(file.pieces.iter().map(|p| p.name.value.clone()));
    place_word::check(file, findings);
    allowance::check(file, findings);
    let pieces = complete_pieces(file, findings);
    let drafts: Vec<Draft> = pieces.iter().filter_map(|p| draft(p, file.unit(), findings)).collect();
    if pieces.len() > 1 {
        findings.tell_together(pieces.len(), |p| matches!(p, Problem::CounterClockwise(_)), Problem::DrawnUpwards);
    }
    let fabrics = fabrics(file);
    check_fabrics(&pieces, &fabrics, findings);
    let sound = drafts.len() == file.pieces.len();
    let default_fabric = fabrics.first().map_or(DEFAULT_FABRIC, |f| &f.name);
    let cut = cut(&drafts, default_fabric);
    let before = findings.errors();
    let seams = seams(file, &drafts, &cut, findings);
    let whole = sound && findings.errors() == before;
    cover::check(file, &pieces, &drafts, &cut, &seams, findings);
    if whole {
        cover::check_free_but_sewn(file, &drafts, &cut, &seams, findings);
        cover::check_joined(file, &drafts, &cut, &seams, findings);
    }
    let closures = if sound { closure::closures(file, &drafts, &cut, findings) } else { Vec::new() };
    let Seams { seams, written, .. } = seams;
    let mut garment = Garment {
        name: name.to_owned(),
        title: file.name.as_ref().map_or_else(|| name.to_owned(), |n| shown(n.value.trim(), TITLE)),
        body: file.body.as_ref().map(|b| b.value.clone()),
        pieces: cut.pieces,
        seams,
        fabrics,
        closures,
        worn: Vec::new(),
        tests: Vec::new(),
    };
    let seam_file = |w: &Option<usize>| w.map(|i| &file.seams[i]);
    let turns: Vec<bool> = written.iter().map(|w| seam_file(w).is_some_and(SeamFile::is_face_same)).collect();
    let spots: Vec<Spot> = written.iter().map(|w| seam_file(w).map_or(file.version.at, |s| s.name.at)).collect();
    check_orientable(&garment, &turns, &spots, findings);
    layers::check(&garment, &turns, &spots, findings);
    notch::check(&garment, &written, &file.seams, findings);
    let sewable = sound && findings.errors() == before;
    garment.tests = bound::bounds(file, &garment, sewable, findings);
    Some(garment)
}

/// The fabrics a file names, in its order. The usual one if it names none.
pub fn fabrics(file: &GarmentFile) -> Vec<FabricUse> {
    if file.fabrics.is_empty() {
        let spec = FabricSpec { base: Some(DEFAULT_CLOTH.to_owned()), values: Vec::new() };
        return vec![FabricUse { name: DEFAULT_FABRIC.to_owned(), spec }];
    }
    let fabric = |(name, value): &(Located<String>, Located<Value>)| {
        let mut spec = FabricSpec::default();
        flatten(&value.value, "", &mut spec);
        FabricUse { name: name.value.clone(), spec }
    };
    file.fabrics.iter().map(fabric).collect()
}

/// Nested keys become `tensile.weft.EMT`, list entries are joined by blanks.
fn flatten(value: &Value, key: &str, spec: &mut FabricSpec) {
    match value {
        Value::Text(text) if key.is_empty() || key == "base" => spec.base = Some(text.clone()),
        Value::Text(text) => spec.values.push((key.to_owned(), text.clone())),
        Value::Map(entries) => {
            for (name, value) in entries {
                let key = if key.is_empty() { name.value.clone() } else { format!("{key}.{}", name.value) };
                flatten(&value.value, &key, spec);
            }
        }
        Value::List(items) => {
            let words: Vec<String> = items.iter().map(|i| text(&i.value)).collect();
            spec.values.push((key.to_owned(), words.join(" ")));
        }
    }
}

fn text(value: &Value) -> String {
    match value {
        Value::Text(text) => text.clone(),
        Value::List(items) => items.iter().map(|i| text(&i.value)).collect::<Vec<_>>().join(" "),
        Value::Map(entries) => {
            entries.iter().map(|(k, v)| format!("{} {}", k.value, text(&v.value))).collect::<Vec<_>>().join(" ")
        }
    }
}

fn check_fabrics(pieces: &[PieceFile], fabrics: &[FabricUse], findings: &mut Findings) {
    for fabric in pieces.iter().filter_map(|p| p.fabric.as_ref()) {
        let names = || fabrics.iter().map(|f| f.name.as_str());
        if !names().any(|n| n == fabric.value) {
            let near = nearest(&fabric.value, names()).map(str::to_owned);
            let known = names().collect::<Vec<_>>().join(", ");
            findings.error(fabric.at, Problem::UnknownFabric { name: fabric.value.clone(), nearest: near, known });
        }
    }
}
