//! Where a body stands in its own file, and which way it faces there.

use crate::geometry::{TriMesh, Vec3, range_of};

/// Heights of foot and ankle, as parts of the body's, that tell where the toes point.
const FOOT: f64 = 0.02;
const ANKLE: [f64; 2] = [0.05, 0.08];
/// Cosine of 10°: a body whose arms lie along x within this angle is taken to face along z as its file has it, for a
/// scan is not quite the same on both sides.
const ALONG: f64 = 0.985;

/// What was done to a body of one's own so that it stands on y = 0 and faces +z; nothing to a shipped one. Garments are
/// made on the body as it stands then, and written where its file has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Height of its lowest point in the file, metres.
    pub low: f64,
    /// Cosine and sine of the angle about y, from z to x, at which it faces in the file.
    pub front: [f64; 2],
}

impl Default for Frame {
    fn default() -> Self {
        Self { low: 0.0, front: [1.0, 0.0] }
    }
}

impl Frame {
    /// That of a body that faces along z, to the front or to the back.
    pub fn along_z(mesh: &TriMesh) -> Self {
        Self::facing(mesh, Self::default().front)
    }

    /// That of a body which is wider from arm to arm than from front to back.
    pub fn across_arms(mesh: &TriMesh) -> Self {
        let front = across(mesh);
        Self::facing(mesh, if front[0] > ALONG { Self::default().front } else { front })
    }

    /// That of a body that faces this way or the opposite one, as its toes point; feet may have none.
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

    /// Where the file has what is at `p`, metres, y up.
    pub fn to_file(&self, p: Vec3) -> Vec3 {
        let [cos, sin] = self.front;
        Vec3::new(p.x * cos + p.z * sin, p.y + self.low, p.z * cos - p.x * sin)
    }

    /// Where what the file has at `p`, metres, y up, is on the body.
    pub fn from_file(&self, p: Vec3) -> Vec3 {
        let [cos, sin] = self.front;
        Vec3::new(p.x * cos - p.z * sin, p.y - self.low, p.z * cos + p.x * sin)
    }
}

/// Cosine and sine of the angle about y, from z to x, square to the wider horizontal axis of a surface; between −90°
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
