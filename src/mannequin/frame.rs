//! Placement of a body in its own file.

use crate::geometry::{TriMesh, Vec3, range_of};

/// Height of the foot, as a share of the body's. The toes point backward if the middle of the foot lies behind that of
/// the ankle by more than the same share.
const FOOT: f64 = 0.02;
/// Range of heights of the ankle, as shares of the body's.
const ANKLE: [f64; 2] = [0.05, 0.08];
/// Cosine of the angle (10°) to the x axis within which the arms count as lying along x. The body then faces along z as
/// in its file, because a scan is not quite the same on both sides.
const ALONG: f64 = 0.985;

/// Transformation that puts a body of one's own on y = 0, facing +z. It is the identity for a shipped body. Garments
/// are made on the transformed body and written in the place of its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyFrame {
    /// Height of its lowest point in the file, metres.
    pub low: f64,
    /// Cosine and sine of the angle about y, from z to x, at which it faces in the file.
    pub front: [f64; 2],
}

impl Default for BodyFrame {
    fn default() -> Self {
        Self { low: 0.0, front: [1.0, 0.0] }
    }
}

impl BodyFrame {
    /// That of a body that faces along z, to the front or to the back.
    pub fn along_z(mesh: &TriMesh) -> Self {
        Self::facing(mesh, Self::default().front)
    }

    /// That of a body which is wider from arm to arm than from front to back.
    pub fn across_arms(mesh: &TriMesh) -> Self {
        let front = across(mesh);
        Self::facing(mesh, if front[0] > ALONG { Self::default().front } else { front })
    }

    /// That of a body that faces this way or the opposite one, as its toes point. Feet may have none.
    fn facing(mesh: &TriMesh, front: [f64; 2]) -> Self {
        let [low, high] = range_of(mesh.vertices.iter().map(|p| p.y));
        let frame = Self { low, front };
        let height = high - low;
        let middle = |from: f64, to: f64| {
            let stood = mesh.vertices.iter().map(|p| frame.from_file(*p));
            let [low, high] = range_of(stood.filter(|p| (from * height..to * height).contains(&p.y)).map(|p| p.z));
            0.5 * (low + high)
        };
        let toes = middle(0.0, FOOT) - middle(ANKLE[0], ANKLE[1]);
        if toes < -FOOT * height { Self { low, front: front.map(|x| -x) } } else { frame }
    }

    /// Position in the file of the point `p` on the body, metres, y up.
    pub fn to_file(&self, p: Vec3) -> Vec3 {
        let [cos, sin] = self.front;
        Vec3::new(p.x * cos + p.z * sin, p.y + self.low, p.z * cos - p.x * sin)
    }

    /// Position on the body of the point `p` of the file, metres, y up.
    pub fn from_file(&self, p: Vec3) -> Vec3 {
        let [cos, sin] = self.front;
        Vec3::new(p.x * cos - p.z * sin, p.y - self.low, p.z * cos + p.x * sin)
    }
}

/// Cosine and sine of the angle about y, from z to x, square to the wider horizontal axis of a surface. Between −90°
/// and 90°.
fn across(mesh: &TriMesh) -> [f64; 2] {
    let faces: Vec<(Vec3, f64)> = (0..mesh.triangles.len())
        .map(|t| {
            let [a, b, c] = mesh.corners(t);
            ((a + b + c) / 3.0, (b - a).cross(&(c - a)).norm())
        })
        .collect();
    let area: f64 = faces.iter().map(|f| f.1).sum();
    let middle = faces.iter().map(|(p, area)| p * *area).sum::<Vec3>() / area;
    let moment = |of: fn(Vec3) -> f64| faces.iter().map(|(p, area)| of(p - middle) * area).sum::<f64>();
    let (mixed, more) = (moment(|p| p.x * p.z), moment(|p| p.x * p.x - p.z * p.z));
    let (sin, cos) = (0.5 * (2.0 * mixed).atan2(more)).sin_cos();
    [cos, -sin]
}
