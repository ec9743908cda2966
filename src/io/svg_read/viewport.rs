//! Where coordinates lie: the size of the drawing, and the places of drawings within it (SVG 1.1, chapter 7).

use nalgebra::Matrix2;
use roxmltree::Node;

use super::shapes::{PIXEL, length, length_in};
use crate::geometry::Vec2;

/// How a drawing is fitted into its box.
const ASPECT: &str = "preserveAspectRatio";

/// From an element's coordinates to metres on the sheet.
#[derive(Clone, Copy)]
pub(super) struct ElementFrame {
    pub(super) linear: Matrix2<f64>,
    pub(super) shift: Vec2,
}

impl ElementFrame {
    /// This after an element's own transform.
    pub(super) fn after(self, (linear, shift): (Matrix2<f64>, Vec2)) -> Self {
        Self { linear: self.linear * linear, shift: self.linear * shift + self.shift }
    }
}

/// Where a drawing lies.
pub(super) struct Viewport {
    pub(super) frame: ElementFrame,
    /// Its size in its own user units; nought where it does not say that.
    pub(super) size: Vec2,
    /// Its size in metres, if it says that or a viewBox does.
    pub(super) metres: Option<Vec2>,
    /// Whether it says in millimetres or the like how large its units are.
    pub(super) is_measured: bool,
}

/// The drawing's frame, by width and height over viewBox as preserveAspectRatio says, by the one side's scale where
/// only one is given; `pixel` is the length of a unit that has no name, and `unit` that of every user unit, if given.
pub(super) fn sheet(root: Node, pixel: f64, unit: Option<f64>) -> Viewport {
    let view = view_box(root);
    let text = |key: &str| root.attribute(key);
    let side = |key: &str| text(key).and_then(|t| length_in(t, pixel)).filter(|metres| *metres > 0.0);
    let is_named = |key: &str| {
        let named = |t: &str| t.trim().ends_with(|c: char| c.is_alphabetic()) && !t.trim().ends_with("px");
        side(key).is_some() && text(key).is_some_and(named)
    };
    let sides = [side("width"), side("height")];
    let [origin, size] = view.unwrap_or_else(|| {
        let units = sides.map(|side| side.map_or(0.0, |metres| metres / pixel));
        [Vec2::zeros(), Vec2::from(units)]
    });
    let scales = [0, 1].map(|k| view.and(sides[k]).map(|metres| metres / size[k]));
    let scale = match (unit, scales) {
        (Some(unit), _) => Vec2::repeat(unit),
        (None, [Some(x), Some(y)]) => fitted(root.attribute(ASPECT).unwrap_or(""), Vec2::new(x, y)).0,
        _ => Vec2::repeat(scales.into_iter().flatten().next().unwrap_or(pixel)),
    };
    let frame = ElementFrame { linear: Matrix2::from_diagonal(&scale), shift: -origin.component_mul(&scale) };
    // Without a viewBox the lines are in units that have no name, however large the sheet is.
    let is_measured = view.is_some() && (is_named("width") || is_named("height"));
    let metres = Some(size.component_mul(&scale)).filter(|metres| metres.min() > 0.0);
    Viewport { frame, size, metres, is_measured }
}

/// The place of a drawing within one of the size `outer`, as a transform: its viewBox is fitted into the box that x, y,
/// width and height say, as preserveAspectRatio says. And its size in its own user units.
pub(super) fn inner(node: Node, outer: Vec2) -> ((Matrix2<f64>, Vec2), Vec2) {
    let side = |key: &str, k: usize| node.attribute(key).and_then(|text| extent(text, outer[k]));
    let corner = Vec2::new(side("x", 0).unwrap_or(0.0), side("y", 1).unwrap_or(0.0));
    let size = Vec2::new(side("width", 0).unwrap_or(outer.x), side("height", 1).unwrap_or(outer.y));
    let Some([origin, units]) = view_box(node).filter(|_| size.min() > 0.0) else {
        return ((Matrix2::identity(), corner), size);
    };
    let (scale, align) = fitted(node.attribute(ASPECT).unwrap_or(""), size.component_div(&units));
    let room = size - units.component_mul(&scale);
    let shift = corner + room.component_mul(&align) - origin.component_mul(&scale);
    ((Matrix2::from_diagonal(&scale), shift), units)
}

/// Scales, and the share of the room left over that lies before the drawing: in the middle and seen whole if nothing
/// is said.
fn fitted(said: &str, scales: Vec2) -> (Vec2, Vec2) {
    if said.split_whitespace().any(|word| word == "none") {
        return (scales, Vec2::zeros());
    }
    let scale = if said.contains("slice") { scales.max() } else { scales.min() };
    let share = |least: &str, most: &str| match said {
        _ if said.contains(least) => 0.0,
        _ if said.contains(most) => 1.0,
        _ => 0.5,
    };
    (Vec2::repeat(scale), Vec2::new(share("xMin", "xMax"), share("YMin", "YMax")))
}

/// Upper left corner and size; `None` where it holds nothing.
fn view_box(node: Node) -> Option<[Vec2; 2]> {
    let text = node.attribute("viewBox")?;
    let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
    let numbers: Vec<f64> =
        words.map(|word| word.parse().ok().filter(|x: &f64| x.is_finite())).collect::<Option<_>>()?;
    let [x, y, width, height] = numbers[..] else { return None };
    (width > 0.0 && height > 0.0).then(|| [Vec2::new(x, y), Vec2::new(width, height)])
}

/// A length in user units, of which there are 96 to the inch; percentages are of the `whole`.
fn extent(text: &str, whole: f64) -> Option<f64> {
    let units = match text.trim().strip_suffix('%') {
        Some(share) => share.trim().parse::<f64>().ok()? / 100.0 * whole,
        None => length(text)? / PIXEL,
    };
    units.is_finite().then_some(units)
}
