//! A garment file altered and written again, in its own words as far as they still hold.

use std::path::Path;

use super::append::alter_block;
use super::decode_alter::changes;
use super::refuse::{refuse, text_of};
use super::variant::carry_out_read;
use super::{Refused, Variant, examine_text, read_file_only, tree, write};
use crate::alter::{carry_out, edge_lengths};
use crate::pattern::{DartFile, DartShape, Findings, GarmentFile, Located, Problem, Quantity, Spot};

/// Lengths that differ by less are the same, metres.
const SAME: f64 = 1e-6;

/// An altered garment file.
#[derive(Clone, Debug)]
pub struct Changed {
    /// The text to write.
    pub text: String,
    /// Whether that is the old text but for what changed. Otherwise it is written anew, without its comments.
    pub in_place: bool,
    /// Edges that changed their lengths.
    pub edges: Vec<EdgeChange>,
    /// The faults of the new garment, such as seams that no longer match.
    pub refused: Option<Refused>,
}

/// An edge and its lengths as drawn, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeChange {
    /// `piece.edge`.
    pub edge: String,
    /// Length before.
    pub before: f64,
    /// Length after.
    pub after: f64,
}

/// Carries out the alterations of a garment file, and then those of a second file, on its outlines. `shown` is the new
/// file's name in messages.
///
/// # Errors
/// [`Refused`] when one of the files cannot be read or an alteration cannot be done.
pub fn change(garment: &Path, changes: &Path, shown: &str) -> Result<Changed, Refused> {
    changed(&text_of(garment)?, garment, shown, |new| alter_by(new, changes))
}

/// As [`change`], of the text of a garment file called `shown`, with alterations as [`Variant`] has them.
///
/// # Errors
/// As [`change`].
pub fn change_text(text: &str, shown: &str, alter: &[String]) -> Result<Changed, Refused> {
    changed(text, Path::new(shown), shown, |new| {
        *new = Variant { size: None, alter }.carried_out(new.clone())?;
        Ok(())
    })
}

fn changed(
    text: &str,
    garment: &Path,
    shown: &str,
    further: impl FnOnce(&mut GarmentFile) -> Result<(), Refused>,
) -> Result<Changed, Refused> {
    let old = read_file_only(&garment.display().to_string(), text)?;
    let mut new = old.clone();
    let own = std::mem::take(&mut new.alter);
    let mut findings = Findings::new(&garment.display().to_string(), text);
    carry_out(&mut new, &own, &mut findings);
    refuse(findings)?;
    further(&mut new)?;
    let patched = patched(text, &old, &new).filter(|p| read_file_only(shown, p).is_ok_and(|file| file == new));
    let in_place = patched.is_some();
    let text = match patched {
        Some(text) => text,
        None => write(&new)
            .map_err(|e| Refused::whole(&garment.display().to_string(), Problem::Unreadable(e.to_string())))?,
    };
    let refused = examine_text("altered", shown, &text).finish().err();
    Ok(Changed { text, in_place, edges: differences(&old, &new), refused })
}

fn alter_by(file: &mut GarmentFile, path: &Path) -> Result<(), Refused> {
    let text = text_of(path)?;
    let mut findings = Findings::new(&path.display().to_string(), &text);
    let empty = Problem::MissingKey { what: "a file of changes".to_owned(), key: "alter" };
    let tree = tree::parse_or(&text, empty, &mut findings);
    let list = tree.map_or_else(Vec::new, |tree| changes(&tree, &mut findings));
    carry_out_read(file, &list, findings)
}

fn differences(old: &GarmentFile, new: &GarmentFile) -> Vec<EdgeChange> {
    let before = edge_lengths(old);
    let length = |edge: &str| before.iter().find(|(name, _)| name == edge).map(|e| e.1);
    let change = |(edge, after): (String, f64)| {
        let before = length(&edge)?;
        ((after - before).abs() > SAME).then_some(EdgeChange { edge, before, after })
    };
    edge_lengths(new).into_iter().filter_map(change).collect()
}

/// A new text for what stands at a place of the old one.
type Patch = (Spot, String);

/// The old text with new numbers. `None` where more than numbers changed.
pub(super) fn patched(text: &str, old: &GarmentFile, new: &GarmentFile) -> Option<String> {
    let mut patches = Vec::new();
    if old.pieces.len() != new.pieces.len() {
        return None;
    }
    for (old, new) in old.pieces.iter().zip(&new.pieces) {
        if let (Some(old), Some(new)) = (&old.outline, &new.outline) {
            if old.start != new.start {
                let [x, y] = new.start.value;
                patches.push((old.start.at, format!("{x} {y}")));
            }
            old.edges.iter().zip(&new.edges).for_each(|(a, b)| words(&a.1, &b.1, &mut patches));
        }
        for (old, new) in old.notches.iter().zip(&new.notches) {
            for (old, new) in old.1.iter().zip(&new.1).filter(|(a, b)| a != b) {
                let double = if new.value.double { " double" } else { "" };
                patches.push((old.at, written(new.value.at) + double));
            }
        }
        old.darts.iter().zip(&new.darts).for_each(|(a, b)| dart(a, b, &mut patches));
        for (old, new) in old.pleats.iter().zip(&new.pleats) {
            old.at.iter().zip(&new.at).for_each(|(a, b)| quantity(a, b, &mut patches));
        }
        old.holes.iter().zip(&new.holes).for_each(|(a, b)| words(&a.1, &b.1, &mut patches));
        old.lines.iter().zip(&new.lines).for_each(|(a, b)| words(&a.path, &b.path, &mut patches));
    }
    patches.sort_by_key(|p| std::cmp::Reverse((p.0.line, p.0.column)));
    let mut lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
    patches.iter().for_each(|patch| replace(&mut lines, patch));
    Some(without_alter(lines).concat())
}

fn words(old: &Located<String>, new: &Located<String>, patches: &mut Vec<Patch>) {
    if old != new {
        patches.push((old.at, new.value.clone()));
    }
}

/// A quantity as it is written: `1.2 cm`.
pub(super) fn written(q: Quantity) -> String {
    q.unit.map_or_else(|| q.number.to_string(), |u| format!("{} {}", q.number, u.symbol()))
}

fn quantity(old: &Located<Quantity>, new: &Located<Quantity>, patches: &mut Vec<Patch>) {
    if old != new {
        patches.push((old.at, written(new.value)));
    }
}

fn point(old: &Located<[f64; 2]>, new: &Located<[f64; 2]>, patches: &mut Vec<Patch>) {
    if old != new {
        let [x, y] = new.value;
        patches.push((old.at, format!("[{x}, {y}]")));
    }
}

fn dart(old: &DartFile, new: &DartFile, patches: &mut Vec<Patch>) {
    quantity(&old.intake, &new.intake, patches);
    match (&old.shape, &new.shape) {
        (
            DartShape::Edge { edge, at, length, tip },
            DartShape::Edge { edge: to, at: now, length: long, tip: there },
        ) => {
            words(edge, to, patches);
            quantity(at, now, patches);
            if let (Some(old), Some(new)) = (length, long) {
                quantity(old, new, patches);
            }
            if let (Some(old), Some(new)) = (tip, there) {
                point(old, new, patches);
            }
        }
        (DartShape::FishEye { at, up, down }, DartShape::FishEye { at: now, up: higher, down: lower }) => {
            point(at, now, patches);
            quantity(up, higher, patches);
            quantity(down, lower, patches);
        }
        _ => {}
    }
}

/// Puts a new text in the place of an old one: of a scalar on one line, or of a block of lines.
fn replace(lines: &mut Vec<String>, (at, new): &Patch) {
    let Some(index) = at.line.checked_sub(1).filter(|i| *i < lines.len()) else { return };
    if let Some(sign) = block_sign(lines, index) {
        let indent = |line: &str| line.len() - line.trim_start().len();
        let own = indent(&lines[index]);
        let count = lines[index..].iter().take_while(|l| !l.trim().is_empty() && indent(l) >= own).count();
        lines.drain(index..index + count);
        lines[index - 1] = format!("{}{new}\n", &lines[index - 1][..sign]);
        return;
    }
    let line = lines[index].clone();
    let before: String = line.chars().take(at.column.saturating_sub(1)).collect();
    let rest: String = line.chars().skip(at.column.saturating_sub(1)).collect();
    if let Some(end) = rest.find(']').filter(|_| rest.starts_with('[')) {
        lines[index] = format!("{before}{new}{}", &rest[end + 1..]);
        return;
    }
    let quoted = if before.contains(['{', '[']) && new.contains(',') { format!("'{new}'") } else { new.clone() };
    if rest.starts_with(['>', '|']) {
        let indent = |line: &str| line.len() - line.trim_start().len();
        let own = indent(&line);
        let more = lines[index + 1..].iter().take_while(|l| l.trim().is_empty() || indent(l) > own).count();
        lines.drain(index + 1..=index + more);
        lines[index] = format!("{before}{quoted}\n");
        return;
    }
    let after: String = rest.chars().skip(at.width).collect();
    lines[index] = before + &quoted + &after;
}

/// Where the sign of a block of lines (`>-`) stands in the line before its first one.
fn block_sign(lines: &[String], first: usize) -> Option<usize> {
    let head = lines.get(first.checked_sub(1)?)?.trim_end();
    let sign = head.rfind(['>', '|'])?;
    (["", "-", "+"].contains(&&head[sign + 1..]) && head[..sign].ends_with(": ")).then_some(sign)
}

/// The lines without the list of alterations, which are carried out.
fn without_alter(mut lines: Vec<String>) -> Vec<String> {
    if let Some(block) = alter_block(&lines) {
        lines.drain(block);
    }
    lines
}
