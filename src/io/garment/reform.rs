//! A garment file whose pieces have been given another shape, in its own words as far as they still hold.

use super::change::{EdgeChange, patched};
use super::refuse::refuse;
use super::{Refused, Variant, read_file_only, write};
use crate::alter::{Given, altered, reshape, sewn_lengths};
use crate::pattern::{Findings, Problem};

/// Lengths that differ by less are the same, metres: nobody cuts more exactly.
const SAME: f64 = 5e-5;

/// A garment file with other pieces.
#[derive(Clone, Debug)]
pub struct Reformed {
    /// The text to write.
    pub text: String,
    /// Whether that is the old text but for what changed. Otherwise it is written anew, without its comments.
    pub in_place: bool,
    /// Edges of which another length is sewn, darts left out.
    pub edges: Vec<EdgeChange>,
    /// Darts with another intake.
    pub darts: Vec<EdgeChange>,
    /// Largest difference of the shifts of the pieces that are cut from one drawing, metres.
    pub uneven: f64,
    /// Largest change of the difference of a seam's two sides, metres.
    pub seams: f64,
}

/// Gives the pieces of a garment file another shape, as [`reshape`] does. The variant's alterations are carried out
/// first; the new text has neither alterations nor, of a size, other sizes. `shown` is the new file's name in messages.
///
/// # Errors
/// [`Refused`] when the text is no garment file, or a piece cannot be given its shape.
pub fn reform(text: &str, shown: &str, variant: Variant, given: Given) -> Result<Reformed, Refused> {
    let old = read_file_only(shown, text)?;
    let mut findings = Findings::new(shown, text);
    let base = altered(&old, variant.size, &mut findings);
    refuse(findings)?;
    let base = variant.carried_out(base)?;
    let mut findings = Findings::new(shown, text);
    let done = reshape(&base, given, &mut findings);
    refuse(findings)?;
    let unreadable = |why: String| Refused::whole(shown, Problem::Unreadable(why));
    let done = done.ok_or_else(|| unreadable("its pieces cannot be given another shape".to_owned()))?;
    let kept = patched(text, &old, &done.file).filter(|p| read_file_only(shown, p).is_ok_and(|file| file == done.file));
    let in_place = kept.is_some();
    let text = match kept {
        Some(text) => text,
        None => write(&done.file).map_err(|e| unreadable(e.to_string()))?,
    };
    let [[edges, darts], [new_edges, new_darts]] = [&base, &done.file].map(sewn_lengths);
    let (edges, darts) = (differences(&edges, &new_edges), differences(&darts, &new_darts));
    Ok(Reformed { text, in_place, edges, darts, uneven: done.uneven, seams: done.seams })
}

fn differences(before: &[(String, f64)], after: &[(String, f64)]) -> Vec<EdgeChange> {
    let change = |(edge, after): &(String, f64)| {
        let before = before.iter().find(|(name, _)| name == edge)?.1;
        ((after - before).abs() > SAME).then(|| EdgeChange { edge: edge.clone(), before, after: *after })
    };
    after.iter().filter_map(change).collect()
}
