//! Panels as pieces of a garment: which two are a pair, what each is called and where it starts.

use super::drawing::PanelDrawing;
use super::role::{PanelFacing, PanelRole, piece_name, side, unique};
use super::spec::Specification;
use crate::geometry::Vec3;
use crate::pattern::Side;

/// A panel with what follows from it alone.
pub(super) struct PanelFacts {
    pub(super) drawing: PanelDrawing,
    pub(super) role: PanelRole,
    pub(super) facing: Option<PanelFacing>,
    pub(super) side: Option<Side>,
}

/// A piece of the garment file.
pub(super) struct FilePiece {
    pub(super) name: String,
    /// The panel that is drawn.
    pub(super) panel: usize,
    /// For a pair: the other panel, and the shift between their edges, see [`PanelDrawing::mirror_shift`].
    pub(super) twin: Option<(usize, usize)>,
    /// Over what it is sewn to, right side on wrong side.
    pub(super) layer: i32,
}

impl FilePiece {
    /// The piece's edge that edge `k` of `panel` (numbered as in the specification) is, if the panel is one of its two.
    pub(super) fn edge(&self, panel: usize, k: usize, count: usize) -> Option<usize> {
        if panel == self.panel {
            return Some(count - 1 - k);
        }
        let (_, by) = self.twin.filter(|(twin, _)| *twin == panel)?;
        // The twin's own drawing has it at count − 1 − k, which is count − 1 − e + by of the drawn one's e.
        Some((k + by) % count)
    }
}

/// Pieces in the order of their panels; a pair stands where its first panel does.
pub(super) fn pieces(spec: &Specification, parts: &[PanelFacts]) -> Vec<FilePiece> {
    let mut out: Vec<FilePiece> = Vec::new();
    let mut names: Vec<String> = Vec::new();
    for panel in 0..parts.len() {
        if out.iter().any(|p| p.twin.is_some_and(|t| t.0 == panel)) {
            continue;
        }
        let twin = (panel + 1..parts.len()).find_map(|other| {
            let free = !out.iter().any(|p| p.twin.is_some_and(|t| t.0 == other));
            let by = twins(&parts[panel], &parts[other]).filter(|_| free)?;
            Some((other, by))
        });
        let plain = piece_name(&spec.panels[panel]);
        let sided = parts[panel].side.filter(|_| twin.is_none() && names_side(&spec.panels[panel].name));
        let wanted = match sided {
            Some(Side::Left) => format!("{plain}_left"),
            Some(Side::Right) => format!("{plain}_right"),
            None => plain,
        };
        let name = unique(&wanted, &names);
        names.push(name.clone());
        out.push(FilePiece { name, panel, twin, layer: layer(spec, parts, panel) });
    }
    out
}

/// Whether a panel's name says on which side it is.
fn names_side(name: &str) -> bool {
    name.to_lowercase().split(|c: char| !c.is_alphanumeric()).any(|w| ["left", "right", "l", "r"].contains(&w))
}

/// Whether two panels are each other's mirror image, drawing and place.
fn twins(one: &PanelFacts, other: &PanelFacts) -> Option<usize> {
    let opposite = one.side.is_some() && other.side.is_some() && one.side != other.side;
    if !opposite || one.role != other.role || one.facing != other.facing {
        return None;
    }
    one.drawing.mirror_shift(&other.drawing).filter(|_| {
        let [a, b] = [one, other].map(|p| p.drawing.space(p.drawing.middle()));
        (a.x + b.x).abs() < PLACED && (a.y - b.y).abs() < PLACED && (a.z - b.z).abs() < PLACED
    })
}

/// Twins stand opposite each other to this many millimetres.
const PLACED: f64 = 5.0;

/// A panel whose right side lies on the wrong side of a larger one, or the other way round, is worn over it.
fn layer(spec: &Specification, parts: &[PanelFacts], panel: usize) -> i32 {
    let size = |p: usize| parts[p].drawing.area;
    let over = spec.stitches.iter().filter(|s| s.right_wrong).any(|s| {
        let [a, b] = s.ends.map(|e| e.0);
        (a == panel && size(a) < size(b)) || (b == panel && size(b) < size(a))
    });
    i32::from(over)
}

/// The part a panel is.
pub(super) fn part(spec: &Specification, panel: usize) -> Option<PanelFacts> {
    let role = PanelRole::of(spec, panel);
    let along = if role.round_arm() { seams_along(spec, panel, role) } else { Vec::new() };
    let drawing = PanelDrawing::new(&spec.panels[panel], role.round_arm(), &along)?;
    let (facing, side) = (PanelFacing::of(&drawing), side(&drawing, role));
    Some(PanelFacts { drawing, role, facing, side })
}

/// The edges of a panel, as lines in space, that are sewn to others of its role: round an arm those run along it.
fn seams_along(spec: &Specification, panel: usize, role: PanelRole) -> Vec<Vec3> {
    let own = &spec.panels[panel];
    let ends = spec.stitches.iter().flat_map(|s| [(s.ends[0], s.ends[1]), (s.ends[1], s.ends[0])]);
    let along = ends.filter(|(here, there)| here.0 == panel && PanelRole::of(spec, there.0) == role);
    along.map(|(here, _)| &own.edges[here.1]).map(|e| own.space(e.end) - own.space(e.start)).collect()
}
