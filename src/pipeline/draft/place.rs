//! Where the words of a file of lines lie on a body, and the lines through them.

use super::file::{LengthOrGirth, PointFile, StyleLineFile};
use super::skin::{LinedSkin, SkinLine};
use crate::contact::nearest_on_surface;
use crate::geometry::{MM, Vec3, box_of, nearest_on_segment};
use crate::mannequin::{BodyPart, Mannequin};

/// A line that ends this near to another one ends on it, metres.
const SNAP: f64 = 0.003;
/// A point may lie this far from the surface, metres: further ones were meant for something else.
const OFF: f64 = 0.05;

/// The body as it was, whose heights count, and its form with ease, on which the lines lie.
pub(super) struct Form<'a> {
    pub(super) body: &'a Mannequin,
    pub(super) skin: LinedSkin,
}

impl Form<'_> {
    /// Draws a line.
    pub(super) fn draw(&mut self, name: &str, line: &StyleLineFile) -> Result<(), String> {
        let kinds = [line.girth.is_some(), line.height.is_some(), line.round.is_some(), line.through.is_some()];
        if kinds.iter().filter(|k| **k).count() != 1 {
            return Err("say one of 'girth', 'height', 'round' and 'through'".into());
        }
        let chain = match (&line.girth, &line.height, &line.round, &line.through) {
            (Some(girth), ..) => self.level(&LengthOrGirth::Text(girth.clone()), line.of.as_deref())?,
            (_, Some(height), ..) => self.level(height, line.of.as_deref())?,
            (_, _, Some(points), _) => self.round(points)?,
            (.., Some(points)) => self.through(name, points)?,
            _ => Vec::new(),
        };
        self.skin.lines.push(SkinLine { name: name.to_owned(), chain });
        Ok(())
    }

    /// The part that a word names, the torso without one; `None` on an object.
    fn part(&self, of: Option<&str>) -> Result<Option<&BodyPart>, String> {
        let parts = &self.body.parts;
        if parts.is_empty() && of.is_none() {
            return Ok(None);
        }
        let found = parts.iter().find(|p| p.kind.name() == of.unwrap_or("torso"));
        let known: Vec<&str> = parts.iter().map(|p| p.kind.name()).collect();
        let wrong = || format!("the body has no part '{}'; it has {}", of.unwrap_or("torso"), known.join(", "));
        found.map(Some).ok_or_else(wrong)
    }

    /// A height in metres.
    fn height(&self, height: &LengthOrGirth) -> Result<f64, String> {
        if let Some(y) = height.metres() {
            return Ok(y);
        }
        let LengthOrGirth::Text(word) = height else { return Err("the height is no number".into()) };
        let marks = || self.body.parts.iter().flat_map(|p| &p.landmarks);
        let found = marks().find(|l| l.0 == *word).map(|l| l.1.y);
        let known: Vec<&str> = marks().map(|l| l.0.as_str()).collect();
        found.ok_or_else(|| format!("there is no height '{word}'; give millimetres or one of {}", known.join(", ")))
    }

    /// The middle of a part at a height.
    fn middle(&self, y: f64, of: Option<&str>) -> Result<Vec3, String> {
        let Some(part) = self.part(of)? else {
            let [low, high] = box_of(self.skin.mesh.vertices.iter().copied());
            if !(low.y..=high.y).contains(&y) {
                return Err(leaves(y, low.y, high.y, "object"));
            }
            let middle = 0.5 * (low + high);
            return Ok(Vec3::new(middle.x, y, middle.z));
        };
        let heights = || part.sections.iter().map(|s| s.center.y);
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        if !(low..=high).contains(&y) {
            return Err(leaves(y, low, high, part.kind.name()));
        }
        Ok(axis(part, y))
    }

    /// Where a point lies.
    pub(super) fn point(&self, point: &PointFile) -> Result<Vec3, String> {
        if let Some(at) = point.at {
            let p = Vec3::from(at) / MM;
            let (t, w, far) = nearest_on_surface(&self.skin.mesh, p);
            let [a, b, c] = self.skin.mesh.corners(t);
            let on = a * w[0] + b * w[1] + c * w[2];
            return if far <= OFF {
                Ok(on)
            } else {
                Err(format!("point {at:?} leaves the body: it is {:.0} mm from it; move it onto the surface", far * MM))
            };
        }
        if let Some(mark) = &point.landmark {
            let part = self.part(point.of.as_deref())?.ok_or("an object has no landmarks; say 'at: [x, y, z]'")?;
            let known: Vec<&str> = part.landmarks.iter().map(|l| l.0.as_str()).collect();
            let found = part.landmarks.iter().find(|l| l.0 == *mark).map(|l| l.1);
            let wrong = || format!("the {} has no landmark '{mark}'; it has {}", part.kind.name(), known.join(", "));
            return found.ok_or_else(wrong);
        }
        if let Some(on) = &point.on {
            return self.on(on, point);
        }
        let Some(height) = &point.height else {
            return Err("a point has no height; say 'height' and 'angle', 'on' a line, 'landmark' or 'at'".into());
        };
        let y = self.height(height)?;
        let from = self.middle(y, point.of.as_deref())?;
        let found = self.skin.ray(from, towards(point.angle.unwrap_or(0.0)));
        found.ok_or_else(|| format!("leaves the body at a height of {:.0} mm; give another height", y * MM))
    }

    /// The point of a line at an angle or a height.
    fn on(&self, name: &str, point: &PointFile) -> Result<Vec3, String> {
        let line = self.skin.lines.iter().find(|l| l.name == name);
        let known: Vec<&str> = self.skin.lines.iter().map(|l| l.name.as_str()).collect();
        let wrong = || format!("no line '{name}' is drawn before it; there are {}", known.join(", "));
        let chain = &line.ok_or_else(wrong)?.chain;
        let places: Vec<Vec3> = chain.iter().map(|&v| self.skin.at(v)).collect();
        let crossed = |value: &dyn Fn(Vec3) -> f64| {
            let ends = places.windows(2).filter(|w| (value(w[0]) <= 0.0) != (value(w[1]) <= 0.0));
            let at = |w: &[Vec3]| w[0].lerp(&w[1], value(w[0]) / (value(w[0]) - value(w[1])));
            ends.map(at).collect::<Vec<Vec3>>()
        };
        let height = point.height.as_ref().map(|h| self.height(h)).transpose()?;
        let Some(angle) = point.angle else {
            let y = height.ok_or_else(|| format!("a point on '{name}' needs an 'angle' or a 'height'"))?;
            let found = crossed(&|p| p.y - y);
            return found.first().copied().ok_or_else(|| format!("line '{name}' has no height {:.0} mm", y * MM));
        };
        let way = towards(angle);
        let middle = self.middle_of(&places, point.of.as_deref())?;
        let found = crossed(&|p| (p - middle(p.y)).dot(&way.cross(&Vec3::y())));
        let ahead = found.into_iter().filter(|p| (p - middle(p.y)).dot(&way) > 0.0);
        let far = |p: &Vec3| height.map_or(p.y, |y| (p.y - y).abs());
        ahead.min_by(|a, b| far(a).total_cmp(&far(b))).ok_or_else(|| format!("line '{name}' has no point at {angle}°"))
    }

    /// The middles, by height, that angles of a line's points are seen from.
    fn middle_of(&self, places: &[Vec3], of: Option<&str>) -> Result<impl Fn(f64) -> Vec3 + '_, String> {
        let part = self.part(of)?;
        // Of the box: points of a section lie as densely as the mesh does.
        let [low, high] = box_of(places.iter().copied());
        let middle = 0.5 * (low + high);
        Ok(move |y: f64| part.map_or(Vec3::new(middle.x, y, middle.z), |part| axis(part, y)))
    }

    fn level(&mut self, height: &LengthOrGirth, of: Option<&str>) -> Result<Vec<u32>, String> {
        let y = self.height(height)?;
        let from = self.middle(y, of)?;
        let place = self.skin.ray(from, Vec3::z()).ok_or("leaves the body; give another height")?;
        let start = self.skin.vertex_at(place);
        let closed = self.skin.round(start, Vec3::y(), Vec3::x());
        closed.ok_or_else(|| "does not close round the body; give a height a little higher or lower".into())
    }

    /// The closed section through two or three points. Through two it runs level across the line between them.
    fn round(&mut self, points: &[PointFile]) -> Result<Vec<u32>, String> {
        let places: Vec<Vec3> = points.iter().map(|p| self.point(p)).collect::<Result<_, _>>()?;
        let normal = match places[..] {
            [p, q] => (q - p).cross(&(q - p).cross(&Vec3::y())),
            [p, q, r] => (q - p).cross(&(r - p)),
            _ => return Err("'round' takes two or three points".into()),
        };
        if normal.norm() < f64::EPSILON {
            return Err("its points lie in one line, through which there are many planes; move one of them".into());
        }
        let start = self.skin.vertex_at(places[0]);
        let toward = normal.cross(&(places[1] - places[0])).normalize();
        let closed = [toward, -toward].into_iter().find_map(|way| self.skin.round(start, normal.normalize(), way));
        closed.ok_or_else(|| "does not close round the body; move its points".into())
    }

    fn through(&mut self, name: &str, points: &[PointFile]) -> Result<Vec<u32>, String> {
        if points.len() < 2 {
            return Err("'through' takes two points or more".into());
        }
        let mut stops = Vec::with_capacity(points.len());
        for point in points {
            let place = self.snapped(self.point(point)?);
            stops.push(self.skin.vertex_at(place));
        }
        let mut chain: Vec<u32> = Vec::new();
        for leg in stops.windows(2) {
            if leg[0] == leg[1] {
                return Err(format!("'{name}' has the same point twice; leave one out"));
            }
            let way = self.skin.between(leg[0], leg[1]).ok_or("its points lie on two surfaces")?;
            chain.extend(way.into_iter().skip(usize::from(!chain.is_empty())));
        }
        Ok(chain)
    }

    /// A point on a line where one is near.
    fn snapped(&self, p: Vec3) -> Vec3 {
        self.nearest_line(p, "").filter(|near| near.1 < SNAP).map_or(p, |near| near.0)
    }

    /// The nearest point of a line but that of this name, its distance, and the line's name.
    pub(super) fn nearest_line(&self, p: Vec3, but: &str) -> Option<(Vec3, f64, &str)> {
        let others = self.skin.lines.iter().filter(|l| l.name != but);
        let sides = others.flat_map(|l| l.chain.windows(2).map(move |w| (l, w)));
        let near = sides.map(|(line, w)| {
            let (a, b) = (self.skin.at(w[0]), self.skin.at(w[1]));
            let (share, far) = nearest_on_segment(p, [a, b]);
            (a.lerp(&b, share), far, line.name.as_str())
        });
        near.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// The middle of a part at a height; beyond its ends that of the end.
fn axis(part: &BodyPart, y: f64) -> Vec3 {
    let mut all: Vec<Vec3> = part.sections.iter().map(|s| s.center).collect();
    all.sort_by(|a, b| a.y.total_cmp(&b.y));
    let at = all.partition_point(|c| c.y < y);
    let middle = match (at.checked_sub(1).and_then(|k| all.get(k)), all.get(at)) {
        (Some(a), Some(b)) => a.lerp(b, (y - a.y) / (b.y - a.y)),
        (Some(end), None) | (None, Some(end)) => *end,
        (None, None) => Vec3::zeros(),
    };
    Vec3::new(middle.x, y, middle.z)
}

/// The direction at an angle: 0° in front, 90° to the wearer's left.
fn towards(degrees: f64) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec3::new(sin, 0.0, cos)
}

fn leaves(y: f64, low: f64, high: f64, what: &str) -> String {
    let [y, low, high] = [y, low, high].map(|x| x * MM);
    format!("leaves the body: a height of {y:.0} mm is outside the {what}, which reaches from {low:.0} to {high:.0} mm")
}
