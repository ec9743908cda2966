//! A GarmentCode specification as it stands in its JSON file, checked and in millimetres.
//!
//! Panels are drawn with y up; a panel's right side is the one from which its edges run counter-clockwise. Control
//! points are relative to their edge: `start + x·e + y·e⊥` with `e = end − start` and `e⊥ = (−e.y, e.x)`. A `circle` is
//! an SVG arc in the panel's own y-up frame. Space is `R·(x, y, 0) + translation` with `R = Rz·Ry·Rx`, or with `R`
//! given as a quaternion.

use std::collections::HashMap;

use nalgebra::{Quaternion, Rotation3, UnitQuaternion};
use serde::Deserialize;
use serde_json::{Map, Value};

use super::error::ImportError;
use super::outward::turn_outward;
use super::short::leave_out_short;
use crate::geometry::{Vec2, Vec3};

/// The statements of a specification.
#[derive(Debug)]
pub(super) struct Specification {
    /// In the order of the file, or of `panel_order`.
    pub(super) panels: Vec<Panel>,
    pub(super) stitches: Vec<PanelStitch>,
}

/// A flat piece of cloth, in its own y-up frame.
#[derive(Debug)]
pub(super) struct Panel {
    pub(super) name: String,
    /// Millimetres.
    pub(super) translation: Vec3,
    /// How the panel's plane is turned.
    pub(super) rotation: Rotation3<f64>,
    /// A closed loop, each edge beginning where the one before it ends.
    pub(super) edges: Vec<PanelEdge>,
    /// `body`, `arm` or `leg`.
    pub(super) label: Option<String>,
}

/// An edge, in the panel's frame, millimetres.
#[derive(Debug, Clone)]
pub(super) struct PanelEdge {
    pub(super) start: Vec2,
    pub(super) end: Vec2,
    pub(super) curve: Curve,
    pub(super) label: Option<String>,
}

/// How an edge gets from its start to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Curve {
    Line,
    /// One control point.
    Quadratic(Vec2),
    /// Two control points.
    Cubic(Vec2, Vec2),
    /// An SVG arc.
    Arc {
        radius: f64,
        large: bool,
        sweep: bool,
    },
}

/// Two edges sewn together.
#[derive(Clone, Copy, Debug)]
pub(super) struct PanelStitch {
    /// Panel and edge, each an index.
    pub(super) ends: [(usize, usize); 2],
    /// The edges run the same way: the right side of one lies on the wrong side of the other.
    pub(super) right_wrong: bool,
}

#[derive(Deserialize)]
struct SpecificationFile {
    pattern: Option<Pattern>,
    #[serde(default)]
    properties: Properties,
}

#[derive(Deserialize)]
struct Pattern {
    panels: Map<String, Value>,
    #[serde(default)]
    stitches: Vec<Vec<Value>>,
    #[serde(default)]
    panel_order: Vec<String>,
}

#[derive(Deserialize, Default)]
struct Properties {
    units_in_meter: Option<f64>,
    curvature_coords: Option<String>,
}

#[derive(Deserialize)]
struct PanelText {
    #[serde(default)]
    translation: [f64; 3],
    #[serde(default)]
    rotation: Vec<f64>,
    vertices: Vec<[f64; 2]>,
    edges: Vec<EdgeText>,
    label: Option<String>,
}

#[derive(Deserialize)]
struct EdgeText {
    endpoints: [usize; 2],
    curvature: Option<CurvatureText>,
    label: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum CurvatureText {
    /// As older files write a quadratic.
    Point([f64; 2]),
    /// As relatives of the format write quadratics and cubics.
    Points(Vec<[f64; 2]>),
    Kind {
        #[serde(rename = "type")]
        kind: String,
        params: Vec<Value>,
    },
}

#[derive(Deserialize)]
struct EndText {
    panel: String,
    edge: usize,
}

/// Files in centimetres say nothing or 100.
const UNITS_IN_METRE: f64 = 100.0;
/// A quaternion shorter than this says nothing.
const LEAST_TURN: f64 = 1e-6;
/// Numbers beyond this, millimetres, are no garment.
const LARGEST: f64 = 1e5;

impl Specification {
    /// Reads and checks the JSON text.
    pub(super) fn parse(text: &str) -> Result<Self, ImportError> {
        let file: SpecificationFile = serde_json::from_str(text).map_err(|e| ImportError::Json(e.to_string()))?;
        let pattern = file.pattern.ok_or(ImportError::NoPattern)?;
        let per_metre = file.properties.units_in_meter.unwrap_or(UNITS_IN_METRE);
        if !(per_metre.is_finite() && per_metre > 0.0) {
            return Err(ImportError::Units(per_metre));
        }
        let absolute = match file.properties.curvature_coords.as_deref() {
            None | Some("relative") => false,
            Some("absolute") => true,
            Some(other) => return Err(ImportError::Coordinates(other.to_owned())),
        };
        let reader = SpecificationReader { scale: 1000.0 / per_metre, absolute };
        let mut panels = ordered(pattern.panels, &pattern.panel_order)
            .into_iter()
            .map(|(name, value)| reader.panel(name, value))
            .collect::<Result<Vec<Panel>, ImportError>>()?;
        if panels.is_empty() {
            return Err(ImportError::NoPattern);
        }
        let mut stitches = stitches(&pattern.stitches, &panels)?;
        leave_out_short(&mut panels, &mut stitches);
        turn_outward(&mut panels, &mut stitches);
        Ok(Self { panels, stitches })
    }
}

/// The panels in the order the file asks for; those it does not mention come last.
fn ordered(mut panels: Map<String, Value>, order: &[String]) -> Vec<(String, Value)> {
    let mut out: Vec<(String, Value)> = order.iter().filter_map(|n| Some((n.clone(), panels.remove(n)?))).collect();
    out.extend(panels);
    out
}

struct SpecificationReader {
    /// Millimetres per unit of the file.
    scale: f64,
    absolute: bool,
}

impl SpecificationReader {
    fn panel(&self, name: String, value: Value) -> Result<Panel, ImportError> {
        let wrong = |reason: String| ImportError::Panel { panel: name.clone(), reason };
        let text: PanelText = serde_json::from_value(value).map_err(|e| wrong(e.to_string()))?;
        let sensible = |x: &f64| (x * self.scale).abs() <= LARGEST;
        if !text.vertices.iter().flatten().chain(&text.translation).all(sensible) {
            return Err(wrong(format!("holds a number beyond {} m", LARGEST / 1000.0)));
        }
        if text.edges.len() < 2 {
            return Err(wrong("has fewer than two edges".to_owned()));
        }
        let mut edges = Vec::with_capacity(text.edges.len());
        for (i, edge) in text.edges.iter().enumerate() {
            let wrong = |reason: String| ImportError::Edge { panel: name.clone(), edge: i, reason };
            let next = &text.edges[(i + 1) % text.edges.len()];
            if edge.endpoints[1] != next.endpoints[0] {
                let (end, start) = (edge.endpoints[1], next.endpoints[0]);
                return Err(wrong(format!("ends at vertex {end}, but the next edge starts at vertex {start}")));
            }
            let [start, end] = edge.endpoints.map(|v| text.vertices.get(v).map(|p| self.scale * Vec2::from(*p)));
            let (Some(start), Some(end)) = (start, end) else {
                return Err(wrong(format!("names a vertex the panel has not; it has {}", text.vertices.len())));
            };
            let curve =
                edge.curvature.as_ref().map_or(Ok(Curve::Line), |c| self.curve(c, start, end)).map_err(wrong)?;
            edges.push(PanelEdge { start, end, curve, label: edge.label.clone().filter(|l| !l.is_empty()) });
        }
        let translation = self.scale * Vec3::from(text.translation);
        let label = text.label.filter(|l| !l.is_empty());
        let rotation = rotation(&text.rotation).map_err(wrong)?;
        Ok(Panel { name, translation, rotation, edges, label })
    }

    fn curve(&self, text: &CurvatureText, start: Vec2, end: Vec2) -> Result<Curve, String> {
        let point = |p: [f64; 2]| {
            let along = end - start;
            let at = if self.absolute {
                self.scale * Vec2::from(p)
            } else {
                start + p[0] * along + p[1] * Vec2::new(-along.y, along.x)
            };
            if at.amax() <= LARGEST { Ok(at) } else { Err("has a control point out of all bounds".to_owned()) }
        };
        let (kind, params) = match text {
            CurvatureText::Point(p) => return Ok(Curve::Quadratic(point(*p)?)),
            CurvatureText::Points(points) => {
                return match points[..] {
                    [] => Ok(Curve::Line),
                    [one] => Ok(Curve::Quadratic(point(one)?)),
                    [one, two] => Ok(Curve::Cubic(point(one)?, point(two)?)),
                    _ => Err(format!("has {} control points; one or two are known", points.len())),
                };
            }
            CurvatureText::Kind { kind, params } => (kind.as_str(), params),
        };
        let read = |expected: &str| format!("its curvature '{kind}' needs {expected}");
        match kind {
            "quadratic" | "cubic" => {
                let points: Vec<[f64; 2]> = serde_json::from_value(Value::Array(params.clone()))
                    .map_err(|_| read("control points, two numbers each"))?;
                match (kind, &points[..]) {
                    ("quadratic", [one]) => Ok(Curve::Quadratic(point(*one)?)),
                    ("cubic", [one, two]) => Ok(Curve::Cubic(point(*one)?, point(*two)?)),
                    ("quadratic", _) => Err(read("one control point")),
                    _ => Err(read("two control points")),
                }
            }
            "circle" => {
                let [radius, large, sweep] = <[f64; 3]>::try_from(numbers(params))
                    .map_err(|_| read("three numbers: radius, large arc, direction"))?;
                let radius = self.scale * radius;
                let chord = (end - start).norm();
                if !(radius > 0.0 && radius <= LARGEST && chord > 0.0) {
                    return Err(read("a radius above zero and two ends"));
                }
                // SVG widens a radius that does not reach; rounding makes half circles such.
                Ok(Curve::Arc { radius: radius.max(0.5 * chord), large: large != 0.0, sweep: sweep != 0.0 })
            }
            other => Err(format!("has the unknown curvature '{other}'; known are quadratic, cubic and circle")),
        }
    }
}

/// Three angles in degrees about the fixed axes x, y, z, in this order, or a quaternion x, y, z, w.
fn rotation(numbers: &[f64]) -> Result<Rotation3<f64>, String> {
    match *numbers {
        [] => Ok(Rotation3::identity()),
        [x, y, z] if numbers.iter().all(|a| a.is_finite()) => {
            let [x, y, z] = [x, y, z].map(f64::to_radians);
            Ok(Rotation3::from_euler_angles(x, y, z))
        }
        [x, y, z, w] => {
            let turn = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), LEAST_TURN);
            turn.filter(|t| t.coords.iter().all(|c| c.is_finite()))
                .map(|turn| turn.to_rotation_matrix())
                .ok_or_else(|| "has a rotation of four numbers that are no quaternion".to_owned())
        }
        _ => Err(format!("has a rotation of {} numbers; three angles or a quaternion are known", numbers.len())),
    }
}

/// Numbers, and truth values as 1 and 0.
fn numbers(params: &[Value]) -> Vec<f64> {
    params.iter().filter_map(|v| v.as_f64().or_else(|| v.as_bool().map(|b| f64::from(u8::from(b))))).collect()
}

fn stitches(text: &[Vec<Value>], panels: &[Panel]) -> Result<Vec<PanelStitch>, ImportError> {
    let index: HashMap<&str, usize> = panels.iter().enumerate().map(|(i, p)| (p.name.as_str(), i)).collect();
    let mut sewn: HashMap<(usize, usize), usize> = HashMap::new();
    let mut out = Vec::with_capacity(text.len());
    for (number, parts) in text.iter().enumerate() {
        let wrong = |reason: String| ImportError::Stitch { number, reason };
        let (ends, right_wrong) = match &parts[..] {
            [a, b] => ([a, b], false),
            [a, b, Value::String(word)] if word == "right_wrong" => ([a, b], true),
            [_, _, other] => return Err(wrong(format!("says {other}; only \"right_wrong\" is known"))),
            _ => return Err(wrong("does not join two edges".to_owned())),
        };
        let mut joined = [(0, 0); 2];
        for (slot, end) in joined.iter_mut().zip(ends) {
            let end: EndText = serde_json::from_value(end.clone()).map_err(|e| wrong(e.to_string()))?;
            let panel = *index.get(end.panel.as_str()).ok_or_else(|| wrong(format!("no panel '{}'", end.panel)))?;
            let count = panels[panel].edges.len();
            if end.edge >= count {
                return Err(wrong(format!("panel '{}' has {count} edges, no edge {}", end.panel, end.edge)));
            }
            if let Some(first) = sewn.insert((panel, end.edge), number) {
                return Err(wrong(format!("edge {} of '{}' is sewn by stitch {first} already", end.edge, end.panel)));
            }
            *slot = (panel, end.edge);
        }
        out.push(PanelStitch { ends: joined, right_wrong });
    }
    Ok(out)
}
