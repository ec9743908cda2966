//! Messages from the process that makes the garment to the studio: a kind, a length and bytes each.

use std::io::{self, Read, Write};

use serde::{Deserialize, Serialize};

/// Bytes of a frame. A garment of a million particles has fewer.
const LARGEST: u32 = 1 << 28;

/// A message.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Frame {
    /// The body, as binary glTF.
    Body(Vec<u8>),
    /// Description of the next garment.
    About(About),
    /// The garment, as binary glTF.
    Garment(Vec<u8>),
    /// The garment as `garment.obj`, for the next one to go on from. The report follows.
    Surface(Vec<u8>),
    /// The text of `report.json`.
    Report(String),
    /// The stage under way, and the share of it that is done.
    Progress(String, f64),
    /// Why there is no garment.
    Failed(String),
}

/// Description of a garment that is shown.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct About {
    /// Name of the garment.
    pub(super) garment: String,
    /// Name of its body.
    pub(super) mannequin: String,
    /// Names of its fabrics.
    pub(super) fabric: String,
    /// Spacing of the mesh, mm.
    pub(super) spacing: f64,
    /// How far it has come, in words.
    pub(super) reached: String,
    /// Whether it is the one that was asked for, at rest, and not on its way.
    pub(super) done: bool,
}

impl Frame {
    /// # Errors
    /// A reader that is gone.
    pub(super) fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let (kind, bytes) = match self {
            Self::Body(bytes) => (b'b', bytes.clone()),
            Self::About(about) => (b'a', serde_json::to_vec(about)?),
            Self::Garment(bytes) => (b'g', bytes.clone()),
            Self::Surface(bytes) => (b's', bytes.clone()),
            Self::Report(text) => (b'r', text.clone().into_bytes()),
            Self::Progress(stage, share) => (b'p', serde_json::to_vec(&(stage, share))?),
            Self::Failed(text) => (b'f', text.clone().into_bytes()),
        };
        let length = u32::try_from(bytes.len()).ok().filter(|length| *length <= LARGEST);
        let length = length.ok_or_else(|| io::Error::other("a frame is too long"))?;
        out.write_all(&[kind])?;
        out.write_all(&length.to_le_bytes())?;
        out.write_all(&bytes)?;
        out.flush()
    }

    /// The next frame. `None` where the writer has ended, or writes something else.
    pub(super) fn read(from: &mut impl Read) -> Option<Self> {
        let mut head = [0; 5];
        from.read_exact(&mut head).ok()?;
        let length = u32::from_le_bytes([head[1], head[2], head[3], head[4]]);
        let mut bytes = Vec::new();
        from.take(u64::from(length.min(LARGEST))).read_to_end(&mut bytes).ok()?;
        if bytes.len() != length as usize {
            return None;
        }
        Some(match head[0] {
            b'b' => Self::Body(bytes),
            b'a' => Self::About(serde_json::from_slice(&bytes).ok()?),
            b'g' => Self::Garment(bytes),
            b's' => Self::Surface(bytes),
            b'r' => Self::Report(String::from_utf8(bytes).ok()?),
            b'p' => serde_json::from_slice(&bytes).ok().map(|(stage, share)| Self::Progress(stage, share))?,
            b'f' => Self::Failed(String::from_utf8(bytes).ok()?),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_as_they_went() {
        let about = About { garment: "é".into(), spacing: 25.0, ..About::default() };
        let frames = [
            Frame::Body(vec![1, 2, 3]),
            Frame::About(about),
            Frame::Garment(Vec::new()),
            Frame::Surface(vec![4]),
            Frame::Report("{}".into()),
            Frame::Progress("sew".into(), 0.25),
            Frame::Failed("no body".into()),
        ];
        let mut bytes = Vec::new();
        frames.iter().for_each(|frame| frame.write(&mut bytes).expect("written"));
        let mut from = bytes.as_slice();
        for frame in &frames {
            assert_eq!(Frame::read(&mut from).as_ref(), Some(frame));
        }
        assert_eq!(Frame::read(&mut from), None);
        assert_eq!(Frame::read(&mut &bytes[..6]), None, "cut off");
        assert_eq!(Frame::read(&mut [b'b', 255, 255, 255, 255, 0].as_slice()), None, "longer than it is");
    }
}
