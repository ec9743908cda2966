//! Says which edges or lines of a piece the triangulation stumbled over.

use super::error::MeshError;
use super::frame::PieceFrame;
use super::grid::Core;
use super::layout::MeshLayout;
use super::strip::StripError;
use crate::geometry::Vec2;
use crate::pattern::written_edge;

impl MeshLayout<'_> {
    /// The error for piece `n` in the words of its pattern.
    pub(super) fn blame(&self, n: usize, frame: &PieceFrame, core: &Core, error: StripError) -> MeshError {
        let piece = self.garment.pieces[n].name.clone();
        let names = |v: u32| self.carriers(n, frame, v);
        match error {
            StripError::Crossing([a, b]) => {
                let at = 0.5 * (core.points[a as usize] + core.points[b as usize]);
                let own: Vec<String> = names(a).into_iter().filter(|name| names(b).contains(name)).collect();
                let other = self.nearest_other(n, frame, at, &own);
                self.crossing(n, at, own.into_iter().next(), other)
            }
            StripError::Double(v) => {
                let at = core.points[v as usize];
                let own = names(v);
                let other = self.nearest_other(n, frame, at, &own);
                self.crossing(n, at, own.into_iter().next(), other)
            }
            StripError::Outside(v) => {
                MeshError::LineOutside { piece, line: self.line_through(n, frame, v).unwrap_or_default() }
            }
            StripError::Refused(why) => MeshError::Triangulation { piece, why },
        }
    }

    fn crossing(&self, n: usize, at: Vec2, first: Option<String>, second: Option<String>) -> MeshError {
        MeshError::Crossing {
            piece: self.garment.pieces[n].name.clone(),
            first: first.unwrap_or_else(|| "the rim".to_owned()),
            second: second.unwrap_or_else(|| "itself".to_owned()),
            at,
            spacing: self.fineness[n].spacing,
        }
    }

    /// The edge or line nearest to `at` that is none of `own`, if it is within reach of a spring or two.
    fn nearest_other(&self, n: usize, frame: &PieceFrame, at: Vec2, own: &[String]) -> Option<String> {
        let distance = |v: u32| (frame.points[v as usize] - at).norm();
        let near = (0..frame.points.len() as u32).filter(|&v| distance(v) < 2.0 * self.fineness[n].spacing);
        let mut near: Vec<u32> = near.collect();
        near.sort_by(|&v, &w| distance(v).total_cmp(&distance(w)));
        near.into_iter().flat_map(|v| self.carriers(n, frame, v)).find(|name| !own.contains(name))
    }

    /// The edges and lines a frame particle lies on.
    fn carriers(&self, n: usize, frame: &PieceFrame, v: u32) -> Vec<String> {
        let edges = self.garment.pieces[n].loops.iter().flatten().zip(&frame.edges);
        let on = edges
            .filter(|(_, chain)| chain.contains(&v))
            .map(|(edge, _)| format!("edge '{}'", written_edge(&edge.name)));
        on.chain(self.line_through(n, frame, v).map(|name| format!("line '{name}'"))).collect()
    }

    /// Name of a line through a frame particle.
    fn line_through(&self, n: usize, frame: &PieceFrame, v: u32) -> Option<String> {
        let mut lines = self.plans[n].lines.iter().zip(&frame.lines);
        let (planned, _) = lines.find(|(_, chain)| chain.contains(&v))?;
        Some(self.garment.pieces[n].lines[planned.number].name.clone())
    }
}
