//! Entities of a DXF file that lie on layers of a pattern and are of kinds nobody reads, counted to be said.

use super::dxf_notches;
use super::dxf_text::Entity;
use super::dxf_write::layer;
use crate::input::shown;

/// Letters of a kind that messages show.
const SHOWN: usize = 20;
/// Kinds that are told of one by one; what else a file may hold would fill the screen.
const MOST_KINDS: usize = 20;
/// Layers that hold lines and points of a piece, but for notches.
const DRAWN: [u32; 7] =
    [layer::BOUNDARY, layer::MIRROR, layer::GRAIN, layer::INTERNAL, layer::CUTOUT, layer::DRILL, layer::SEW];
/// Kinds that are curves, which polylines can stand for.
const CURVES: [&str; 4] = ["SPLINE", "ELLIPSE", "CIRCLE", "HELIX"];

/// Kinds, how many there are of each, and the line of the first; in the order of the file.
#[derive(Debug, Default)]
pub(super) struct LeftOutEntities<'a>(Vec<(&'a str, usize, usize)>);

impl<'a> LeftOutEntities<'a> {
    /// Counts an entity that is not read, if it lies where lines and points of a piece do.
    pub(super) fn add(&mut self, entity: &Entity<'a>) {
        if !entity.layer().is_some_and(|on| DRAWN.contains(&on) || dxf_notches::LAYERS.contains(&on)) {
            return;
        }
        match self.0.iter().position(|(kind, ..)| *kind == entity.kind) {
            Some(k) => self.0[k].1 += 1,
            None if self.0.len() < MOST_KINDS => self.0.push((entity.kind, 1, entity.line)),
            None => {}
        }
    }

    /// One for each kind there is.
    pub(super) fn sentences(&self) -> Vec<String> {
        let sentence = |&(kind, count, line): &(&str, usize, usize)| {
            let remedy =
                if CURVES.contains(&kind) { "export curves as polylines" } else { "explode it, or draw lines" };
            let first = if count == 1 { "in line" } else { "the first in line" };
            let kind = shown(kind, SHOWN);
            format!("left out: {count} {kind} on the layers of a pattern, {first} {line}; {remedy} to have it")
        };
        self.0.iter().map(sentence).collect()
    }
}
