//! Names for edges, from what they are sewn to and where they hang.

use super::drawing::PanelDrawing;
use super::role::{PanelFacing, PanelRole};
use super::spec::PanelEdge;
use crate::geometry::Vec3;

/// The partner of an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Partner {
    pub(super) role: PanelRole,
    pub(super) facing: Option<PanelFacing>,
    /// The panel itself: a dart.
    pub(super) own: bool,
    /// Whether it is on the other side of the body.
    pub(super) across: bool,
}

/// A piece whose edges get names.
pub(super) struct Subject<'a> {
    pub(super) drawing: &'a PanelDrawing,
    pub(super) role: PanelRole,
    pub(super) facing: Option<PanelFacing>,
    /// Whether its mirror image is cut as well.
    pub(super) pair: bool,
    /// Per edge of the drawing.
    pub(super) partners: &'a [Option<Partner>],
}

impl Subject<'_> {
    /// One name per edge of the drawing, none twice.
    pub(super) fn names(&self) -> Vec<String> {
        let base: Vec<&str> = (0..self.drawing.edges.len()).map(|k| self.base(k)).collect();
        let mut names = Vec::with_capacity(base.len());
        for (k, name) in base.iter().enumerate() {
            let same: Vec<usize> = (0..base.len()).filter(|&j| base[j] == *name).collect();
            let x = |j: usize| self.middle(j).x;
            names.push(match same[..] {
                [_] => (*name).to_owned(),
                [a, b] if !self.pair && x(a) * x(b) < 0.0 => {
                    format!("{name}_{}", if x(k) > 0.0 { "left" } else { "right" })
                }
                _ => format!("{name}_{}", 1 + same.iter().position(|&j| j == k).unwrap_or(0)),
            });
        }
        names
    }

    fn edge(&self, k: usize) -> &PanelEdge {
        &self.drawing.edges[k]
    }

    fn middle(&self, k: usize) -> Vec3 {
        let edge = self.edge(k);
        self.drawing.space(edge.path().map_or(edge.start, |p| p.point(0.5 * p.length())))
    }

    /// Whether it runs up and down rather than across.
    fn upright(&self, k: usize) -> bool {
        let d = self.edge(k).end - self.edge(k).start;
        d.y.abs() > d.x.abs()
    }

    /// Whether the edge lies above the middle of its drawing.
    fn high(&self, k: usize) -> bool {
        0.5 * (self.edge(k).start.y + self.edge(k).end.y) < self.drawing.middle().y
    }

    fn labelled(&self, k: usize, word: &str) -> bool {
        self.edge(k).label.as_deref().is_some_and(|l| l.contains(word))
    }

    fn base(&self, k: usize) -> &'static str {
        match self.partners[k] {
            None => self.free(k),
            Some(partner) if partner.own => "dart",
            Some(partner) => self.sewn(k, partner),
        }
    }

    fn free(&self, k: usize) -> &'static str {
        if self.labelled(k, "armhole") {
            return "armhole";
        }
        if self.labelled(k, "collar") {
            return "neck";
        }
        let beside: Vec<&str> = self.neighbours(k).into_iter().flatten().collect();
        if self.role == PanelRole::Bodice && ["shoulder", "side"].iter().all(|name| beside.contains(name)) {
            return "armhole";
        }
        match (self.role, self.upright(k), self.high(k)) {
            (PanelRole::Hood, true, _) => "face",
            (PanelRole::Collar, ..) => "outer",
            (PanelRole::Bodice, _, true) => "neck",
            (PanelRole::Trousers, false, true) => "waist",
            (_, true, _) => "opening",
            (_, false, true) => "top",
            (_, false, false) => "hem",
        }
    }

    /// The seams of the edges before and after.
    fn neighbours(&self, k: usize) -> [Option<&'static str>; 2] {
        let n = self.partners.len();
        [(k + n - 1) % n, (k + 1) % n].map(|j| Some(self.sewn(j, self.partners[j].filter(|p| !p.own)?)))
    }

    fn sewn(&self, k: usize, partner: Partner) -> &'static str {
        let same_facing = self.facing.is_some() && self.facing == partner.facing;
        match (self.role, partner.role) {
            (PanelRole::Sleeve, PanelRole::Sleeve) | (PanelRole::Cuff, PanelRole::Cuff) => {
                if self.middle(k).y > self.drawing.space(self.drawing.middle()).y { "over" } else { "under" }
            }
            (PanelRole::Trousers | PanelRole::TrouserCuff, PanelRole::Trousers | PanelRole::TrouserCuff) => {
                self.leg(k, partner)
            }
            (own, other) if own == other && same_facing => "center",
            (PanelRole::Collar | PanelRole::Hood, PanelRole::Collar | PanelRole::Hood) => self.collar(k),
            (own, other) if own == other => {
                if own == PanelRole::Bodice && !self.upright(k) {
                    "shoulder"
                } else {
                    "side"
                }
            }
            (PanelRole::Bodice, PanelRole::Sleeve) => "armhole",
            (PanelRole::Sleeve, PanelRole::Bodice) => "cap",
            (PanelRole::Sleeve, PanelRole::Cuff) => "wrist",
            (PanelRole::Cuff, PanelRole::Sleeve) => "top",
            (PanelRole::Collar | PanelRole::Hood, _) | (_, PanelRole::Collar | PanelRole::Hood) => "neck",
            (PanelRole::Waistband, _) if self.high(k) => "top",
            (PanelRole::Waistband, _) => "bottom",
            (_, PanelRole::Waistband) => "waist",
            _ if self.upright(k) => "join",
            _ if self.high(k) => "top",
            _ => "bottom",
        }
    }

    /// Trousers: the outer seam, the inner one, and the one between the legs.
    fn leg(&self, k: usize, partner: Partner) -> &'static str {
        if self.role != partner.role {
            return if self.high(k) { "top" } else { "ankle" };
        }
        if partner.facing == self.facing && partner.across {
            return "center";
        }
        let outward = self.middle(k).x.abs() > self.drawing.space(self.drawing.middle()).x.abs();
        if outward { "outseam" } else { "inseam" }
    }

    fn collar(&self, k: usize) -> &'static str {
        match (self.role, self.upright(k)) {
            (PanelRole::Hood, true) => "back",
            (PanelRole::Hood, false) => "crown",
            _ => "end",
        }
    }
}
