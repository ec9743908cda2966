//! The sizes of a graded file: told by texts, by the names of blocks alone, or by a table of grade rules beside it.

use super::dxf_block::Block;
use super::dxf_error::{DxfError, SHOWN};
use super::dxf_rules::RuleTable;
use super::dxf_text::{Entity, after, letters};
use crate::digitize::{Traced, size_of};
use crate::input::shown;

/// Texts that tell the size a file was drafted in.
const SAMPLE: [&str; 4] = ["sample size:", "base size:", "sample:", "basesize:"];
/// Numbers at the ends of blocks' names from this on are sizes also of one piece alone; smaller ones may count pieces.
const SURELY_A_SIZE: u32 = 26;

/// The sizes of a file.
pub(super) struct FileSizes {
    names: Vec<String>,
    sample: Option<String>,
    told_by: ToldBy,
}

/// The statements that tell the sizes.
#[derive(PartialEq)]
enum ToldBy {
    /// The texts of blocks.
    Texts,
    /// The names of blocks.
    Names,
    /// Grade rules, which make every size of the blocks.
    Rules,
}

impl FileSizes {
    pub(super) fn new(blocks: &[&Block], entities: &[Entity]) -> Self {
        let pieces: Vec<&Block> = blocks.iter().copied().filter(|b| b.has_boundary()).collect();
        let told = distinct(pieces.iter().filter_map(|b| b.text("size:")));
        let (names, told_by) = if told.len() > 1 { (told, ToldBy::Texts) } else { (by_names(&pieces), ToldBy::Names) };
        let texts = entities.iter().filter(|e| ["TEXT", "MTEXT"].contains(&e.kind)).filter_map(|e| e.value(1));
        let sample = texts.filter_map(|t| SAMPLE.iter().find_map(|key| after(t, key))).find(|s| !s.is_empty());
        let sample = sample.map(letters).and_then(|s| names.iter().find(|n| n.eq_ignore_ascii_case(&s)).cloned());
        Self { names, sample, told_by }
    }

    /// The sizes of a table of rules.
    pub(super) fn ruled(table: &RuleTable) -> Self {
        Self { names: table.sizes.clone(), sample: table.sample.clone(), told_by: ToldBy::Rules }
    }

    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// The size to be read: the one that is wanted, the file's sample, or the middle one. `None` where there is but
    /// one.
    pub(super) fn chosen(&self, wanted: Option<&str>) -> Result<Option<&str>, DxfError> {
        if let Some(wanted) = wanted {
            let found = self.names.iter().find(|name| name.eq_ignore_ascii_case(wanted));
            return found.map(|name| Some(name.as_str())).ok_or_else(|| DxfError::NoSize {
                wanted: shown(wanted, SHOWN),
                known: if self.names.is_empty() { "not told".to_owned() } else { self.names.join(", ") },
            });
        }
        let middle = || self.names.get(self.names.len().saturating_sub(1) / 2);
        Ok(self.sample.as_ref().or_else(middle).map(String::as_str))
    }

    /// The note on the size that is read.
    pub(super) fn note(&self, chosen: Option<&str>, wanted: bool) -> Option<String> {
        let chosen = chosen?;
        let why = match &self.sample {
            _ if wanted => "",
            Some(_) => ", its sample size",
            None => ", the middle one, for it does not say its sample size",
        };
        let names = self.names.join(", ");
        let has = if self.told_by == ToldBy::Rules { "the rules beside the file have" } else { "the file has" };
        Some(format!("{has} the sizes {names}: {chosen} is read{why}; --size takes another, or all"))
    }

    /// Whether a block is of a size, or of none.
    pub(super) fn is_of(&self, block: &Block, chosen: Option<&str>) -> bool {
        let own = match self.told_by {
            ToldBy::Names => split(block.name()).map(|(_, size)| size),
            ToldBy::Texts => block.text("size:"),
            ToldBy::Rules => None,
        };
        let own = own.filter(|size| self.names.iter().any(|name| name == size));
        chosen.is_none_or(|chosen| own.is_none_or(|own| own == chosen))
    }

    /// The name of a block without its size, where that is told by it.
    pub(super) fn stem<'b>(&self, block: &'b Block) -> Option<&'b str> {
        let is_size = |size: &str| self.names.iter().any(|name| name == size);
        split(block.name()).filter(|(_, size)| self.names.len() > 1 && is_size(size)).map(|(stem, _)| stem)
    }
}

fn distinct<'t>(texts: impl Iterator<Item = &'t str>) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for text in texts {
        if !all.iter().any(|own| own == text) {
            all.push(text.to_owned());
        }
    }
    all
}

/// `FRONT-M` as its stem and its size.
fn split(name: &str) -> Option<(&str, &str)> {
    let at = name.rfind(['-', '_', ' ', '.'])?;
    let (stem, size) = (&name[..at], &name[at + 1..]);
    (!stem.is_empty() && size_of(size).as_deref() == Some(size)).then_some((stem, size))
}

/// The sizes that names of blocks tell: every piece there is in every one of them.
fn by_names(pieces: &[&Block]) -> Vec<String> {
    let Some(split) = pieces.iter().map(|b| split(b.name())).collect::<Option<Vec<_>>>() else { return Vec::new() };
    let (stems, sizes) = (distinct(split.iter().map(|s| s.0)), distinct(split.iter().map(|s| s.1)));
    let complete = split.len() == stems.len() * sizes.len();
    let sure = stems.len() > 1 || sizes.iter().all(|s| s.parse::<u32>().map_or(true, |n| n >= SURELY_A_SIZE));
    if sizes.len() > 1 && complete && sure { sizes } else { Vec::new() }
}

/// The pieces, those of one name that are cut from several materials named after these as well.
pub(super) fn named_apart(mut pieces: Vec<Traced>) -> Vec<Traced> {
    let known: Vec<(String, Option<String>)> =
        pieces.iter().map(|p| (p.name.clone(), p.material.as_ref().map(|m| m.name.clone()))).collect();
    for (k, piece) in pieces.iter_mut().enumerate() {
        let (name, material) = &known[k];
        let first = known.iter().position(|(other, _)| other == name).is_none_or(|first| first == k);
        let differs = known.iter().any(|(other, its)| other == name && its != material);
        if let Some(material) = material.as_ref().filter(|_| differs && !first) {
            piece.name = format!("{name}_{material}");
        }
    }
    pieces
}
