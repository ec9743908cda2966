//! Seams of a garment file.

use super::fields::name;
use super::fields::{Fields, distance, exclusive, integer, items, length, positive, text, width, word, wrong};
use crate::pattern::{Findings, Located, OpenFile, SeamFile, Value};

/// Reads one seam.
pub(super) fn seam(key: &Located<String>, value: &Located<Value>, findings: &mut Findings) -> Option<SeamFile> {
    let key = name(key, findings)?;
    let mut fields = Fields::new(value, &format!("seam '{}'", key.value), findings)?;
    let [sew, to] = ["sew", "to"].map(|k| fields.need(k, findings).map(|v| chain(v, k, findings)));
    let seam = SeamFile {
        name: key,
        sew: sew.unwrap_or_default(),
        to: to.unwrap_or_default(),
        ease: fields.get("ease", findings, distance),
        gather: fields.get("gather", findings, positive),
        stretch: fields.get("stretch", findings, positive),
        tolerance: fields.get("tolerance", findings, length),
        open: fields
            .take("open")
            .map_or_else(Vec::new, |v| items(v).iter().filter_map(|o| open(o, findings)).collect()),
        closure: fields.get("closure", findings, text),
        face_same: fields
            .get("face", findings, |v, _, f| word(v, "face", "same or opposite", f, |w| either(w, "same", "opposite"))),
        match_notches: fields.get("match", findings, |v, _, f| {
            word(v, "match", "notches or length", f, |w| either(w, "notches", "length"))
        }),
        stage: fields.get("stage", findings, integer),
        layers: fields.get("layers", findings, layers),
        allowance: fields.get("allowance", findings, width),
        note: fields.get("note", findings, text),
    };
    one_give(&seam, findings);
    fields.finish(findings);
    (!seam.sew.is_empty() && !seam.to.is_empty()).then_some(seam)
}

fn either(word: &str, yes: &str, no: &str) -> Option<bool> {
    (word == yes || word == no).then_some(word == yes)
}

fn chain(value: &Located<Value>, what: &str, findings: &mut Findings) -> Vec<Located<String>> {
    let chain: Vec<_> = items(value).iter().filter_map(|e| text(e, "an edge of a seam", findings)).collect();
    if items(value).is_empty() {
        wrong(value, what, "an edge or a list of edges", findings);
    }
    chain
}

fn open(value: &Located<Value>, findings: &mut Findings) -> Option<OpenFile> {
    let mut fields = Fields::new(value, "an opening", findings)?;
    let from = fields.require("from", findings, text);
    let long = fields.require("length", findings, length);
    let closure = fields.get("closure", findings, text);
    fields.finish(findings);
    Some(OpenFile { from: from?, length: long?, closure })
}

fn layers(value: &Located<Value>, what: &str, findings: &mut Findings) -> Option<Located<[i32; 2]>> {
    let read: Vec<i32> = items(value).iter().filter_map(|v| integer(v, what, findings)).map(|l| l.value).collect();
    match <[i32; 2]>::try_from(read) {
        Ok(layers) => Some(Located::new(layers, value.at)),
        Err(_) => {
            wrong(value, what, "two layers: [0, -1]", findings);
            None
        }
    }
}

/// A seam is eased, gathered or stretched, not two of these.
fn one_give(seam: &SeamFile, findings: &mut Findings) {
    let said = [
        ("ease", seam.ease.as_ref().map(|e| e.at)),
        ("gather", seam.gather.as_ref().map(|g| g.at)),
        ("stretch", seam.stretch.as_ref().map(|s| s.at)),
    ];
    exclusive(said, findings);
}
