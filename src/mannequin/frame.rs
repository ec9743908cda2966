//! Where a body stands in its own file.

use crate::geometry::Vec3;

/// What was done to a body of one's own so that it stands on y = 0 and faces +z; nothing to a shipped one. Garments are
/// made on the body as it stands then, and written where its file has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    /// Height of its lowest point in the file, metres.
    pub low: f64,
    /// Whether it faces −z in the file.
    pub backward: bool,
}

impl Frame {
    /// Where the file has what is at `p`, metres, y up.
    pub fn to_file(&self, p: Vec3) -> Vec3 {
        self.turned(Vec3::new(p.x, p.y + self.low, p.z))
    }

    /// Where what the file has at `p`, metres, y up, is on the body.
    pub fn from_file(&self, p: Vec3) -> Vec3 {
        self.turned(Vec3::new(p.x, p.y - self.low, p.z))
    }

    /// Half a turn, there and back.
    fn turned(&self, p: Vec3) -> Vec3 {
        if self.backward { Vec3::new(-p.x, p.y, -p.z) } else { p }
    }
}
