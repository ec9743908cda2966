//! Panels as they are drawn in a garment file: right side facing the reader, y down, clockwise, upright.

use super::spec::{Curve, Panel, PanelEdge};
use crate::geometry::{Path, Vec2, Vec3};

/// A panel as drawn. Millimetres.
#[derive(Debug)]
pub(super) struct PanelDrawing {
    /// Clockwise on screen. Edge `k` is the panel's edge `count − 1 − k`, walked the other way.
    pub(super) edges: Vec<PanelEdge>,
    /// The rigid start: where the drawing's origin is, and the turn (x, y, z, fixed axes, this order) that takes
    /// (x, −y, 0) of the drawing there.
    pub(super) at: Vec3,
    pub(super) turn: Vec3,
    /// Where the right side looks.
    pub(super) normal: Vec3,
    /// Area, mm².
    pub(super) area: f64,
    rotation: nalgebra::Rotation3<f64>,
}

/// Space directions whose vertical part is below this have no up and down.
const LEVEL: f64 = 0.2;

impl PanelDrawing {
    /// Draws a panel; one round an arm with the arm's axis running down, all others upright as they hang.
    ///
    /// `None` when the outline encloses no area or cannot be measured.
    /// `along` are the lines (space, millimetres) that run along its arm, as far as they are known.
    pub(super) fn new(panel: &Panel, round_arm: bool, along: &[Vec3]) -> Option<Self> {
        let rotation = panel.rotation;
        let double_area = double_area(&panel.edges).filter(|area| *area != 0.0 && area.is_finite())?;
        // Counter-clockwise where y is up: the right side faces the reader.
        let sign = double_area.signum();
        let middle = panel.space(middle(&panel.edges));
        let down = down(&rotation, round_arm.then_some((middle.x, along)));
        let right = sign * Vec2::new(-down.y, down.x);
        let turned = |p: Vec2| Vec2::new(right.dot(&p), down.dot(&p));
        let mirrors = right.perp(&down) < 0.0;
        let mut edges: Vec<PanelEdge> = panel.edges.iter().rev().map(|e| redrawn(e, &turned, mirrors)).collect();
        // The highest point is at y = 0; x stays the panel's own, which pairs share.
        let top = edges.iter().map(|e| e.start.y).fold(f64::INFINITY, f64::min);
        edges.iter_mut().for_each(|e| e.shift(Vec2::new(0.0, -top)));
        let flat = |p: Vec2| rotation * Vec3::new(p.x, p.y, 0.0);
        let (x, y) = (flat(right), flat(-down));
        let normal = x.cross(&y);
        let frame = nalgebra::Rotation3::from_matrix_unchecked(nalgebra::Matrix3::from_columns(&[x, y, normal]));
        let (roll, pitch, yaw) = frame.euler_angles();
        let turn = Vec3::new(roll, pitch, yaw).map(f64::to_degrees);
        let area = 0.5 * double_area.abs();
        Some(Self { edges, at: panel.translation + flat(down * top), turn, normal, area, rotation: frame })
    }

    /// A point of the drawing in space.
    pub(super) fn space(&self, p: Vec2) -> Vec3 {
        self.at + self.rotation * Vec3::new(p.x, -p.y, 0.0)
    }

    /// Middle of the drawing's corners.
    pub(super) fn middle(&self) -> Vec2 {
        middle(&self.edges)
    }

    /// Whether `other` is this drawing's mirror image, in which case edge `k` of one is edge `count − 1 − k + by` of
    /// the other (modulo count).
    pub(super) fn mirror_shift(&self, other: &Self) -> Option<usize> {
        let n = self.edges.len();
        if n != other.edges.len() {
            return None;
        }
        let (here, there) = (mirrored(self.middle()), other.middle());
        let image: Vec<PanelEdge> = self
            .edges
            .iter()
            .rev()
            .map(|e| {
                let mut image = redrawn(e, &|p| mirrored(p), true);
                image.shift(there - here);
                image
            })
            .collect();
        (0..n).find(|&by| (0..n).all(|k| image[k].is_near(&other.edges[(k + by) % n])))
    }
}

/// Drawings that agree to this many millimetres are mirror images of each other.
const SAME: f64 = 0.05;

impl PanelEdge {
    fn shift(&mut self, by: Vec2) {
        self.start += by;
        self.end += by;
        self.curve = match self.curve {
            Curve::Quadratic(c) => Curve::Quadratic(c + by),
            Curve::Cubic(c, d) => Curve::Cubic(c + by, d + by),
            other => other,
        };
    }

    fn is_near(&self, other: &Self) -> bool {
        let near = |a: Vec2, b: Vec2| (a - b).norm() < SAME;
        near(self.start, other.start)
            && near(self.end, other.end)
            && match (self.curve, other.curve) {
                (Curve::Line, Curve::Line) => true,
                (Curve::Quadratic(a), Curve::Quadratic(b)) => near(a, b),
                (Curve::Cubic(a, b), Curve::Cubic(c, d)) => near(a, c) && near(b, d),
                (
                    Curve::Arc { radius: a, large, sweep },
                    Curve::Arc { radius: b, large: other_large, sweep: other_sweep },
                ) => (a - b).abs() < SAME && large == other_large && sweep == other_sweep,
                _ => false,
            }
    }

    /// Its path commands, numbers to so many decimals.
    pub(super) fn commands(&self, decimals: usize) -> String {
        let p = |v: Vec2| format!("{} {}", number(v.x, decimals), number(v.y, decimals));
        match self.curve {
            Curve::Line => format!("L {}", p(self.end)),
            Curve::Quadratic(c) => format!("Q {}, {}", p(c), p(self.end)),
            Curve::Cubic(c, d) => format!("C {}, {}, {}", p(c), p(d), p(self.end)),
            Curve::Arc { radius, large, sweep } => {
                let r = number(radius, decimals);
                format!("A {r} {r} 0 {} {} {}", u8::from(large), u8::from(sweep), p(self.end))
            }
        }
    }

    /// Exact course, file units.
    pub(super) fn path(&self) -> Option<Path> {
        Path::parse(self.start, &self.commands(EXACT), 1.0).ok()
    }

    /// Exact length, millimetres.
    pub(super) fn length(&self) -> f64 {
        self.path().map_or(0.0, |p| p.length())
    }
}

/// Decimals of a millimetre at which nothing is lost.
const EXACT: usize = 9;

/// A number without trailing zeros.
pub(super) fn number(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn mirrored(p: Vec2) -> Vec2 {
    Vec2::new(-p.x, p.y)
}

fn middle(edges: &[PanelEdge]) -> Vec2 {
    edges.iter().fold(Vec2::zeros(), |sum, e| sum + e.start) / edges.len() as f64
}

/// Twice the area that the edges enclose, positive where they run counter-clockwise with y up; `None` when they cannot
/// be measured.
pub(super) fn double_area(edges: &[PanelEdge]) -> Option<f64> {
    let start = edges.first()?.start;
    let commands: Vec<String> = edges.iter().map(|e| e.commands(EXACT)).collect();
    let whole = format!("M {} {} {} Z", start.x, start.y, commands.join(" "));
    Some(Path::parse_absolute(&whole, 1.0).ok()?.double_area())
}

/// Two axes of a panel point down an arm alike whose cosines differ by less: the arm is held out to the side.
const ALIKE: f64 = 0.15;

/// The axis of the panel's frame that hangs down, or, of one round an arm on this side (x) along which these lines run,
/// leads along it.
fn down(rotation: &nalgebra::Rotation3<f64>, arm: Option<(f64, &[Vec3])>) -> Vec2 {
    let target = arm.map_or(-Vec3::y(), |(x, _)| Vec3::new(x.signum(), -1.0, 0.0).normalize());
    let flat = |d: Vec2| rotation * Vec3::new(d.x, d.y, 0.0);
    let axes = [-Vec2::y(), Vec2::x(), -Vec2::x(), Vec2::y()].map(|d| (flat(d).dot(&target), d));
    let best = axes.into_iter().reduce(|a, b| if b.0 > a.0 + 1e-6 { b } else { a });
    let Some(best) = best.filter(|b| b.0 > LEVEL) else { return -Vec2::y() };
    // Of two that are as good the one that the seams along the arm take.
    let seams = |d: Vec2| arm.map_or(0.0, |(_, lines)| lines.iter().map(|l| l.dot(&flat(d)).abs()).sum::<f64>());
    let rival = axes.into_iter().filter(|a| best.0 - a.0 < ALIKE && seams(a.1) > seams(best.1) + 1e-6);
    rival.reduce(|a, b| if seams(b.1) > seams(a.1) { b } else { a }).unwrap_or(best).1
}

/// The edge in another frame, walked the other way.
fn redrawn(edge: &PanelEdge, map: &dyn Fn(Vec2) -> Vec2, mirrors: bool) -> PanelEdge {
    let curve = match edge.curve {
        Curve::Line => Curve::Line,
        Curve::Quadratic(c) => Curve::Quadratic(map(c)),
        Curve::Cubic(c, d) => Curve::Cubic(map(d), map(c)),
        // Walking back turns the other way, and so does a mirror.
        Curve::Arc { radius, large, sweep } => Curve::Arc { radius, large, sweep: sweep == mirrors },
    };
    PanelEdge { start: map(edge.end), end: map(edge.start), curve, label: edge.label.clone() }
}
