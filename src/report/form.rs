//! The figures of a draped form that has been changed, and of the pattern that it asks for.

use serde::{Deserialize, Serialize};

/// Largest mean distance of the garment that is made from the new pattern from the form, mm.
const MEAN: f64 = 2.0;
/// Largest distance at any point, mm.
const MOST: f64 = 5.0;
/// Cloth further from the skin than this hangs free, mm.
const FREE: f64 = 8.0;
/// The form is that of the garment as it hangs if no point of it is further from it, mm.
const SAME: f64 = 0.1;
/// Both sides of a seam may differ by this more than they were drawn, mm.
const SEAM: f64 = 0.01;

/// A form, and the pattern that it asks for. Lengths are mm.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FormReport {
    /// How far the form is from the garment as it hangs. `null` where that was not draped.
    pub moved: Option<Apart>,
    /// Edges of which another length is sewn.
    pub edges: Vec<LengthChange>,
    /// Darts with another intake.
    pub darts: Vec<LengthChange>,
    /// For each drape of a new pattern, the distance of the form from it. The pattern of the nearest is written.
    pub redraped: Vec<Apart>,
    /// Largest difference of the changes on the left and the right. The pattern has their mean.
    pub uneven: f64,
    /// Largest change of the difference of a seam's two sides.
    pub seams: f64,
    /// Pieces that their fabric does not let lie flat: `'front' (by 9.4 %, cotton_poplin gives 6.1 %)`.
    pub strained: Vec<String>,
    /// Why there is no new pattern. Empty if there is one.
    pub refused: String,
}

/// Distances between two surfaces, mm.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Apart {
    /// The mean.
    pub mean: f64,
    /// The largest.
    pub max: f64,
    /// The piece where they are furthest apart.
    pub piece: String,
    /// Where that is on the form: x, y, z in the file.
    pub at: [f64; 3],
    /// Distance of the form from the skin there.
    pub skin: Option<f64>,
    /// Largest gap of a seam before it was stitched.
    pub gap: f64,
}

/// A length before and after.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LengthChange {
    /// `front.side`, `front.bust`.
    pub name: String,
    /// Before.
    pub before: f64,
    /// After.
    pub after: f64,
}

impl FormReport {
    /// Whether it is another form than that of the garment as it hangs.
    pub fn is_changed(&self) -> bool {
        self.moved.as_ref().is_none_or(|moved| moved.max > SAME)
    }

    /// The drape that came nearest to the form.
    pub fn nearest(&self) -> Option<&Apart> {
        self.redraped.iter().min_by(|a, b| a.mean.total_cmp(&b.mean))
    }

    /// The faults of the new pattern, in words.
    pub fn problems(&self) -> Vec<String> {
        let mut out = Vec::new();
        if !self.refused.is_empty() {
            out.push(format!("the form gives no pattern, and no garment file is written: {}", self.refused));
        }
        if !self.strained.is_empty() {
            let pieces = self.strained.join(", ");
            out.push(format!(
                "the form cannot be laid flat in this fabric: {pieces}; change it less there, or add a dart or a seam"
            ));
        }
        if self.seams > SEAM {
            out.push(format!("the new pattern has a seam of which one side is {:.2} mm too long", self.seams));
        }
        out.extend(self.nearest().and_then(Apart::problem));
        out
    }

    /// The lines of the verdict, each with its label.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut out = Vec::new();
        if let Some(Apart { mean, max, piece, .. }) = &self.moved {
            let told = format!("{mean:.1} mm from the garment as it hangs, {max:.1} mm at most, in '{piece}'");
            out.push(("form", told));
        }
        let mut changes: Vec<String> = self.darts.iter().map(|c| c.told("dart ")).collect();
        changes.extend(self.edges.iter().map(|c| c.told("")));
        if changes.is_empty() && self.refused.is_empty() {
            changes.push("no edge and no dart changes its length".to_owned());
        }
        out.extend(changes.into_iter().enumerate().map(|(k, told)| (if k == 0 { "new" } else { "" }, told)));
        for (k, Apart { mean, max, piece, .. }) in self.redraped.iter().enumerate() {
            let what = if k == 0 { "draped from there" } else { "corrected and draped" };
            let far = format!("{mean:.1} mm from the form, {max:.1} mm at most, in '{piece}'");
            out.push(("again", format!("{what}: {far}")));
        }
        out
    }
}

impl Apart {
    fn problem(&self) -> Option<String> {
        if self.mean <= MEAN && self.max <= MOST {
            return None;
        }
        let Apart { mean, max, piece, at: [x, y, z], .. } = self;
        let why = match self.skin {
            Some(skin) if skin > FREE => {
                format!("nothing holds the cloth there, {skin:.0} mm from the skin, so that it hangs otherwise")
            }
            _ => "the cloth slides or folds otherwise there".to_owned(),
        };
        Some(format!(
            "out of bounds: the new pattern comes within {mean:.1} mm of the form in the mean and {max:.1} mm at most \
             (allowed: {MEAN} and {MOST}), furthest in '{piece}' at ({x:.0}, {y:.0}, {z:.0}): {why}"
        ))
    }
}

impl LengthChange {
    fn told(&self, kind: &str) -> String {
        let Self { name, before, after } = self;
        format!("{kind}{name} {:+.1} mm ({before:.1} to {after:.1})", after - before)
    }
}
