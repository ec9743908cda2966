//! How long a unit is that a drawing does not name: programs have meant different things by it.

use roxmltree::{Document, NodeType};

use super::shapes::PIXEL;

/// The unit of a drawing that does not name one.
pub(super) struct UnitOf {
    pub(super) metres: f64,
    /// The program that is known to mean that by it, and how many it has to the inch.
    program: Option<(&'static str, u32)>,
}

impl UnitOf {
    /// The note on it, if that is not `said`.
    pub(super) fn note(&self, said: bool) -> Option<String> {
        let assumed = match self.program {
            Some((program, per_inch)) => {
                format!("it was written by {program}, which has {per_inch} units to the inch: read so")
            }
            None => "taken as 96 to the inch, as CSS says".to_owned(),
        };
        (!said).then(|| {
            format!(
                "the drawing does not say its unit: {assumed}; --units says another, as 'pt' (72 to the inch) or 'mm'"
            )
        })
    }
}

/// Programs and how many units of theirs are an inch.
const INCH: f64 = 0.0254;

/// By the words at the head of a drawing.
pub(super) fn unit_of(document: &Document) -> UnitOf {
    let program = illustrator(document).or_else(|| old_inkscape(document));
    UnitOf { metres: program.map_or(PIXEL, |(_, per_inch)| INCH / f64::from(per_inch)), program }
}

/// Adobe's programs count in points.
fn illustrator(document: &Document) -> Option<(&'static str, u32)> {
    let comments = document.root().children().filter(|n| n.node_type() == NodeType::Comment);
    let mut texts = comments.filter_map(|n| n.text());
    let by_adobe = texts.any(|t| t.contains("Adobe Illustrator") || t.contains("Adobe InDesign"));
    by_adobe.then_some(("a program of Adobe's", 72))
}

/// Inkscape had 90 pixels to the inch until its version 0.92.
fn old_inkscape(document: &Document) -> Option<(&'static str, u32)> {
    let root = document.root_element();
    let is_program = |space: Option<&str>| space.is_some_and(|s| s.contains("inkscape") || s.contains("sodipodi"));
    let version = root.attributes().find(|a| a.name() == "version" && is_program(a.namespace()))?.value();
    let mut numbers = version.split(|c: char| !c.is_ascii_digit()).map(|n| n.parse::<u32>().unwrap_or(0));
    let (major, minor) = (numbers.next()?, numbers.next().unwrap_or(0));
    (major == 0 && minor < 92).then_some(("Inkscape before 0.92", 90))
}
