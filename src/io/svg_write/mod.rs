//! SVG out: patterns for cutting, and the flat pieces that `make` and `flatten` leave.
//!
//! One user unit is one millimetre and width, height and viewBox say so. Coordinates are absolute (no transforms but
//! for turned text) and every element carries its own styling, so that any program sees the same drawing.

mod cutting;
mod flat;

use svg::Document;
use svg::node::element::{Group, Path, Rectangle, Text};

pub use cutting::cutting_svg;
pub use flat::{PatternSvgError, outline_svg, pattern_svg};

use crate::cutting::{INCH_SQUARE, TEST_SQUARE};
use crate::geometry::{Cubic, MM, Vec2};
use crate::pattern::{LineKind, NotchKind};

/// An empty sheet, mm.
fn document(size: Vec2) -> Document {
    Document::new()
        .set("width", format!("{}mm", number(size.x)))
        .set("height", format!("{}mm", number(size.y)))
        .set("viewBox", format!("0 0 {} {}", number(size.x), number(size.y)))
}

/// The test square with its upper left corner at `corner`, mm.
fn square(corner: Vec2, letters: f64) -> Group {
    let side = TEST_SQUARE * MM;
    measured(corner, side, &format!("{side} mm"), letters)
}

/// The test square for those who measure in inches.
fn inch_square(corner: Vec2, letters: f64) -> Group {
    measured(corner, INCH_SQUARE * MM, "2 inches", letters)
}

/// A square of a side that is to be measured, mm.
fn measured(corner: Vec2, side: f64, words: &str, letters: f64) -> Group {
    let square = Rectangle::new()
        .set("x", number(corner.x))
        .set("y", number(corner.y))
        .set("width", number(side))
        .set("height", number(side))
        .set("fill", "none")
        .set("stroke", "black")
        .set("stroke-width", 0.3);
    let label = text(words, corner + Vec2::new(letters, side / 2.0), letters);
    Group::new().set("class", "scale").add(square).add(label)
}

fn text(content: &str, at: Vec2, height: f64) -> Text {
    Text::new(printable(content))
        .set("class", "text")
        .set("x", number(at.x))
        .set("y", number(at.y))
        .set("font-family", "sans-serif")
        .set("font-size", number(height))
        .set("fill", "black")
        .set("stroke", "none")
}

/// Words centred on the middle of their foot, mm, turned to be read from the right if `upright`.
fn centered(content: &str, at: Vec2, height: f64, upright: bool) -> Text {
    let text = text(content, at, height).set("text-anchor", "middle");
    if upright { text.set("transform", format!("rotate(90 {} {})", number(at.x), number(at.y))) } else { text }
}

/// The effect of a line, for programs: `data-fold` in degrees, `data-elastic` as a share of its length.
fn with_kind(path: Path, kind: &LineKind) -> Path {
    match kind {
        LineKind::Fold(angle) => path.set("data-fold", number(angle.to_degrees())),
        LineKind::Elastic(ratio) => path.set("data-elastic", number(*ratio)),
        LineKind::Mark(kind) => path.set("data-kind", identifier(kind)),
    }
}

/// The owner of a notch's mark and the edge it is on, for programs.
fn told_notch(mark: Path, kind: NotchKind, edge: &str) -> Path {
    mark.set("data-notch", kind.word()).set("data-edge", identifier(edge))
}

/// A line through points, mm.
fn polyline(points: &[Vec2], class: &str, width: f64) -> Path {
    let steps: Vec<String> = points.iter().map(|p| format!("{} {}", number(p.x), number(p.y))).collect();
    stroke(if steps.is_empty() { String::new() } else { format!("M{}", steps.join(" L")) }, class, width)
}

/// Curves end to end, mm.
fn curved(curves: &[Cubic], class: &str, width: f64) -> Path {
    let at = |p: &Vec2| format!("{} {}", number(p.x), number(p.y));
    let start = curves.first().map_or_else(String::new, |c| format!("M{}", at(&c[0])));
    let steps = curves.iter().map(|[_, a, b, to]| format!(" C{} {} {}", at(a), at(b), at(to)));
    stroke(start + &steps.collect::<String>(), class, width)
}

fn stroke(commands: String, class: &str, width: f64) -> Path {
    Path::new()
        .set("class", class)
        .set("d", commands)
        .set("fill", "none")
        .set("stroke", "black")
        .set("stroke-width", width)
        .set("stroke-linejoin", "round")
        .set("stroke-linecap", "round")
}

/// A tenth of a micrometre: sums over an edge's hundred particles stay exact to a hundredth of a millimetre.
fn number(x: f64) -> String {
    format!("{x:.4}")
}

/// A name as an attribute's value: XML forbids some characters, quotes would end the value and an id has no spaces.
fn identifier(name: &str) -> String {
    name.chars().map(|c| if is_forbidden(c) || c.is_whitespace() || c == '"' { '_' } else { c }).collect()
}

/// Whether XML forbids it: control characters, and two that are no characters.
fn is_forbidden(c: char) -> bool {
    c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}')
}

/// Text without the characters that XML forbids.
fn printable(text: &str) -> String {
    text.chars().map(|c| if is_forbidden(c) { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_xml_forbids_is_not_written() {
        assert_eq!(printable("a\u{7}b\u{fffe}c\u{ffff}é👗"), "a b c é👗");
        assert_eq!(identifier("a \"b\u{fffe}"), "a__b_");
    }
}
