//! Lengths, and shapes as paths.

use roxmltree::Node;

use crate::geometry::Vec2;

/// Metres per CSS pixel.
pub(super) const PIXEL: f64 = 0.0254 / 96.0;

/// Numbers of which a share is one of the height.
const UPRIGHT: [&str; 6] = ["y", "height", "cy", "ry", "y1", "y2"];

/// The lines of a double notch are so far from its middle, in user units: less than what a notch may be off the edge,
/// however the edge runs.
const BESIDE: f64 = 1.0;

/// A length in metres; percentages and units of type have none.
pub(super) fn length(text: &str) -> Option<f64> {
    length_in(text, PIXEL)
}

/// As [`length`], a number without a unit and a pixel being this long.
pub(super) fn length_in(text: &str, pixel: f64) -> Option<f64> {
    let text = text.trim();
    let split = text.find(|c: char| c.is_alphabetic() && !"eE".contains(c) || c == '%').unwrap_or(text.len());
    let number: f64 = text[..split].trim().parse().ok()?;
    let unit = match text[split..].trim().to_ascii_lowercase().as_str() {
        "" | "px" => pixel,
        "mm" => 1e-3,
        "q" => 2.5e-4,
        "cm" => 1e-2,
        "m" => 1.0,
        "in" => 0.0254,
        "pt" => 0.0254 / 72.0,
        "pc" => 0.0254 / 6.0,
        _ => return None,
    };
    Some(number * unit)
}

/// The element as path commands, in a drawing of this size in user units; `None` where it is no line or its numbers are
/// none.
pub(super) fn commands(node: Node, name: &str, viewport: Vec2) -> Option<String> {
    // In user units: of a length with a unit of its own there are 96 to the inch.
    let number = |key: &str| {
        let text = node.attribute(key)?;
        let units = match text.trim().strip_suffix('%') {
            Some(share) => share.trim().parse::<f64>().ok()? / 100.0 * viewport[usize::from(UPRIGHT.contains(&key))],
            None => length(text)? / PIXEL,
        };
        units.is_finite().then_some(units)
    };
    let zero = |key: &str| number(key).unwrap_or(0.0);
    match name {
        "path" => node.attribute("d").map(str::trim).filter(|d| !d.is_empty()).map(str::to_owned),
        "polygon" | "polyline" => {
            let points = node.attribute("points")?.trim();
            let end = if name == "polygon" { " Z" } else { "" };
            (!points.is_empty()).then(|| format!("M {points}{end}"))
        }
        "line" => Some(format!("M {} {} L {} {}", zero("x1"), zero("y1"), zero("x2"), zero("y2"))),
        "rect" => {
            let (w, h) = (number("width")?, number("height")?);
            let round = radii(number("rx"), number("ry")).unwrap_or([0.0; 2]);
            (w > 0.0 && h > 0.0).then(|| rectangle([zero("x"), zero("y")], [w, h], round))
        }
        "circle" | "ellipse" => {
            let own = if name == "circle" { number("r").map(|r| [r; 2]) } else { radii(number("rx"), number("ry")) };
            let [rx, ry] = own?;
            let (x, y) = (zero("cx") - rx, zero("cy"));
            let arc = |by: f64| format!("a {rx} {ry} 0 0 1 {by} 0");
            (rx > 0.0 && ry > 0.0).then(|| format!("M {x} {y} {} {} Z", arc(2.0 * rx), arc(-2.0 * rx)))
        }
        "use" => Some(notch([zero("x"), zero("y")], is_back_notch(node))),
        _ => None,
    }
}

/// A notch as a symbol put in a place; a double one as two that have it in their middle.
fn notch([x, y]: [f64; 2], double: bool) -> String {
    let at = |x: f64| format!("M {x} {y} L {x} {} ", y + 0.001);
    if double { at(x - BESIDE) + &at(x + BESIDE) } else { at(x) }
}

/// Whether it is the symbol with which FreeSewing marks the back, where a notch is double by custom.
fn is_back_notch(node: Node) -> bool {
    node.attributes().any(|a| a.name() == "href" && a.value() == "#bnotch")
}

/// Radii as SVG means them: one that is missing (`auto`, or negative) is as the other; `None` where both are.
fn radii(rx: Option<f64>, ry: Option<f64>) -> Option<[f64; 2]> {
    let [rx, ry] = [rx, ry].map(|r| r.filter(|r| *r >= 0.0));
    Some([rx.or(ry)?, ry.or(rx)?])
}

/// A rectangle from its corner on, with its corners rounded to half its sides at most.
fn rectangle([x, y]: [f64; 2], [w, h]: [f64; 2], round: [f64; 2]) -> String {
    let (rx, ry) = (round[0].min(0.5 * w), round[1].min(0.5 * h));
    if rx == 0.0 || ry == 0.0 {
        return format!("M {x} {y} h {w} v {h} h {} Z", -w);
    }
    // Where nothing is left of a side, its arcs meet.
    let side = |command: &str, length: f64| if length == 0.0 { String::new() } else { format!(" {command} {length}") };
    let arc = |dx: f64, dy: f64| format!(" a {rx} {ry} 0 0 1 {dx} {dy}");
    let (across, down) = (w - 2.0 * rx, h - 2.0 * ry);
    format!("M {} {y}", x + rx)
        + &side("h", across)
        + &arc(rx, ry)
        + &side("v", down)
        + &arc(-rx, ry)
        + &side("h", -across)
        + &arc(-rx, -ry)
        + &side("v", -down)
        + &arc(rx, -ry)
        + " Z"
}
