//! SVG in: drawings of Inkscape, FreeSewing, Seamly2D and toile itself; the only user of roxmltree.
//!
//! Lengths follow width, height and viewBox (a drawing without units has 96 to the inch, as CSS says). The role of a
//! line follows from its class (`cut`, `sew`, `edge`, `grain`, `notch`, `fold`; FreeSewing's `fabric`, `sa` and
//! markers) where it has one, and else from what lies in what.

mod arrow;
mod left_out;
mod program;
mod role;
mod shapes;
mod style;
mod viewport;
mod xml;

use std::path::Path as FilePath;

use roxmltree::{Document, Node};

use self::arrow::shaft;
use self::left_out::{LeftOutElements, What};
use self::program::unit_of;
use self::role::{SKIPPED, role};
use self::shapes::commands;
use self::style::Styles;
use self::viewport::{ElementFrame, Viewport, inner, sheet};
use self::xml::parsed;
use super::encoding::decoded_xml;
use crate::digitize::{Drawing, Material, Remark, Role, Stroke, ToldNotch, Traced, besides, pieces, size_of, sizes};
use crate::geometry::{Path, Vec2, parse_transform};
use crate::input::{InputError, bytes, shown};
use crate::pattern::{Corner, LineKind, NotchKind, Side};

/// Larger files are not patterns.
const MOST_BYTES: u64 = 30 << 20;
/// Coordinates beyond this (metres) are a wrong unit or no pattern.
const FARTHEST: f64 = 1e3;
/// More lines than this cannot be looked at one against the other.
const MOST_STROKES: usize = 5_000;
/// Letters of a text that are read.
const REMARK: usize = 200;
/// Letters of a path that messages show.
const SHOWN: usize = 60;

/// Elements that hold others.
const CONTAINERS: [&str; 4] = ["g", "svg", "a", "switch"];
/// Shapes that are sizes and places.
const SHAPES: [&str; 3] = ["rect", "circle", "ellipse"];
/// Shapes that are points.
const LINES: [&str; 4] = ["path", "polygon", "polyline", "line"];
/// Elements that are not drawn where they stand.
const NOT_DRAWN: [&str; 9] =
    ["defs", "symbol", "marker", "clipPath", "mask", "pattern", "metadata", "style", "namedview"];
/// Why an SVG file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum SvgError {
    /// The system refused.
    #[error("{0}")]
    Input(#[from] InputError),
    /// Not XML.
    #[error("it is not an SVG file: {0}")]
    Xml(String),
    /// XML of another kind.
    #[error("it is not an SVG file: its first element is '{0}'")]
    NotSvg(String),
    /// Something that cannot be read.
    #[error("line {line}: cannot read {what} '{text}'")]
    Value {
        /// From 1.
        line: u32,
        /// `a path`.
        what: &'static str,
        /// As it stands there, shortened.
        text: String,
    },
    /// Too many lines.
    #[error("it has more than {most} lines; hide or remove those that do not belong to the pattern")]
    TooMany {
        /// The limit.
        most: usize,
    },
    /// A size that it has not.
    #[error("it has no size '{wanted}'; its sizes are {known}")]
    NoSize {
        /// The size that was asked for.
        wanted: String,
        /// Those there are.
        known: String,
    },
    /// No outline.
    #[error(
        "no closed line of the size of a piece was found; outlines must be closed paths, or paths that meet end to end \
         in one group or layer per piece{besides}"
    )]
    NoPieces {
        /// The elements that were left out, which may be the reason.
        besides: String,
    },
}

/// Notes on a drawing besides its own statements.
#[derive(Clone, Debug, Default)]
pub struct SvgOptions {
    /// Metres per user unit, in place of what the drawing says.
    pub unit: Option<f64>,
    /// The size to be read of one that is drawn in several.
    pub size: Option<String>,
}

/// Reads the pieces of an SVG file.
///
/// # Errors
/// [`SvgError`].
pub fn read_svg(path: &FilePath, options: &SvgOptions) -> Result<Drawing, SvgError> {
    let bytes = bytes(path, MOST_BYTES)?;
    let (text, note) = decoded_xml(&bytes);
    let mut drawing = read_svg_text_as(&text, options)?;
    drawing.notes.extend(note);
    Ok(drawing)
}

/// Reads the pieces of an SVG text.
///
/// # Errors
/// As [`read_svg`].
pub fn read_svg_text(text: &str) -> Result<Drawing, SvgError> {
    read_svg_text_as(text, &SvgOptions::default())
}

/// Reads the pieces of an SVG text as is said besides.
///
/// # Errors
/// As [`read_svg`].
pub fn read_svg_text_as(text: &str, options: &SvgOptions) -> Result<Drawing, SvgError> {
    let mut forgiven = None;
    let (document, mut notes) = parsed(text, &mut forgiven)?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(SvgError::NotSvg(shown(root.tag_name().name(), SHOWN)));
    }
    let unit = unit_of(&document);
    let sheet = sheet(root, unit.metres, options.unit);
    notes.extend(unit.note(sheet.is_measured || options.unit.is_some()));
    let left_out = LeftOutElements::default();
    let (strokes, remarks, texts) = (Vec::new(), Vec::new(), Vec::new());
    let (sides, materials, corners) = (Vec::new(), Vec::new(), Vec::new());
    let mut reader = SvgReader { document: &document, strokes, remarks, texts, sides, materials, corners, left_out };
    reader.walk(root, &sheet)?;
    reader.take_size(options.size.as_deref())?;
    let mut drawing = pieces(&reader.strokes, &reader.remarks, sheet.metres);
    for piece in &mut drawing.pieces {
        piece.drawn = reader.sides.iter().find(|(name, _)| *name == piece.name).map(|(_, side)| *side);
        piece.corners = reader.corners.iter().filter(|(name, _)| *name == piece.name).map(|(_, c)| c.clone()).collect();
        piece.material = reader.materials.iter().find(|(name, _)| *name == piece.name).map(|(_, m)| m.clone());
    }
    reader.leave_out_unread(&drawing.pieces);
    drawing.left_out.extend(reader.left_out.sentences());
    if drawing.pieces.is_empty() {
        return Err(SvgError::NoPieces { besides: besides(&[drawing.faults, drawing.left_out].concat()) });
    }
    notes.append(&mut drawing.notes);
    if !drawing.sizes.is_empty() {
        let sizes = drawing.sizes.join(", ");
        notes.push(format!("the sizes {sizes} are drawn over one another: all are read; --size takes one"));
    }
    Ok(Drawing { title: title(root), notes, ..drawing })
}

/// The properties that an element inherits.
#[derive(Clone)]
struct Scope {
    frame: ElementFrame,
    /// Size of the drawing it stands in, its user units.
    viewport: Vec2,
    group: Option<String>,
    /// As [`group`](Self::group), or the layer that holds several pieces.
    layer: Option<String>,
    /// The size of the pattern that a layer round it says.
    size: Option<String>,
    classes: String,
}

struct SvgReader<'a, 'i> {
    document: &'a Document<'i>,
    strokes: Vec<Stroke>,
    remarks: Vec<Remark>,
    /// Remarks that are left out unless a piece is cut as they say, and the lines they stand in.
    texts: Vec<(usize, u32)>,
    /// Groups with which of a pair, or which half, their pieces are, as toile itself writes it.
    sides: Vec<(String, Side)>,
    /// The material of groups, as toile itself writes it.
    materials: Vec<(String, Material)>,
    /// How the allowances of groups' edges end at corners, as toile itself writes it.
    corners: Vec<(String, (String, Corner))>,
    left_out: LeftOutElements,
}

impl SvgReader<'_, '_> {
    /// Leaves the strokes of one size, where there are several.
    fn take_size(&mut self, wanted: Option<&str>) -> Result<(), SvgError> {
        let Some(wanted) = wanted else { return Ok(()) };
        let known = sizes(&self.strokes);
        let Some(size) = known.iter().find(|size| size.eq_ignore_ascii_case(wanted)) else {
            let known = if known.is_empty() { "not told".to_owned() } else { known.join(", ") };
            return Err(SvgError::NoSize { wanted: shown(wanted, SHOWN), known });
        };
        self.strokes.retain(|stroke| stroke.size.as_ref().is_none_or(|own| own == size));
        Ok(())
    }

    fn walk(&mut self, root: Node, sheet: &Viewport) -> Result<(), SvgError> {
        let styles = Styles::of(self.document);
        let (frame, viewport) = (sheet.frame, sheet.size);
        let scope = Scope { frame, viewport, group: None, layer: None, size: None, classes: String::new() };
        // Elements with what they inherit, the next one last: files may nest deeper than a stack of calls.
        let mut open = vec![(root, scope)];
        while let Some((node, scope)) = open.pop() {
            let mut within = scope.clone();
            let transform = styles.property(node, "transform").filter(|text| node != root && *text != "none");
            if let Some(text) = transform {
                let own = parse_transform(&unitless(text)).ok_or_else(|| self.value(node, "a transform", text))?;
                within.frame = scope.frame.after(own);
            }
            let name = node.tag_name().name();
            if name == "svg" && node != root {
                let (place, viewport) = inner(node, scope.viewport);
                (within.frame, within.viewport) = (within.frame.after(place), viewport);
            }
            if let Some(own) = node.attribute("class") {
                within.classes = if name == "g" { own.to_owned() } else { format!("{own} {}", scope.classes) };
            }
            if CONTAINERS.contains(&name) {
                let own = group_name(node);
                let told = || node.attribute("data-size").map(|size| shown(size, SHOWN));
                within.size = told().or_else(|| size_of(&own.as_ref()?.name)).or(scope.size);
                within.layer = own.as_ref().map(|own| own.name.clone()).or(scope.layer);
                within.group = own.filter(|own| own.is_piece).map(|own| own.name).or(scope.group);
                let side = node.attribute("data-drawn").and_then(Side::from_letter);
                self.sides.extend(within.group.clone().zip(side));
                self.materials.extend(within.group.clone().zip(material(node)));
                let chosen = (name == "switch").then(|| alternative(node));
                let elements = || {
                    let all = node.children().filter(Node::is_element);
                    all.filter(|c| chosen.is_none_or(|chosen| chosen == Some(*c)))
                };
                elements().filter(|c| styles.hides(*c) && draws(*c)).for_each(|c| self.leave_out(c, What::Hidden));
                let children = elements().filter(|c| !styles.hides(*c) && !NOT_DRAWN.contains(&c.tag_name().name()));
                open.extend(children.map(|c| (c, within.clone())).collect::<Vec<_>>().into_iter().rev());
            } else {
                let letters = if name == "text" { styles.letters(node) } else { 0.0 };
                self.element(node, name, &within, (styles.only_fills(node), letters))?;
            }
        }
        Ok(())
    }

    /// An element that is drawn: whether it is filled without a pen, and how high its letters are.
    fn element(
        &mut self,
        node: Node,
        name: &str,
        scope: &Scope,
        (filled, letters): (bool, f64),
    ) -> Result<(), SvgError> {
        let read = name == "text" && self.remarks.len() < MOST_STROKES;
        let remark = if read { remark(node, scope.frame, letters) } else { None };
        let role = role(node, &scope.classes);
        let known = scope.classes.split_whitespace().any(|c| SKIPPED.contains(&c));
        if let Some(what) = What::of(name, role.is_some()).filter(|_| !known) {
            if remark.is_some() {
                self.texts.push((self.remarks.len(), self.line(node)));
            } else {
                self.leave_out(node, what);
            }
        }
        self.remarks.extend(remark);
        self.corners.extend(scope.group.clone().zip(told_corner(node, scope.group.as_deref())));
        let Some(role) = role else { return Ok(()) };
        let Some(commands) = commands(node, name, scope.viewport) else {
            // An empty path draws nothing; a shape that has no numbers may have been meant to.
            if SHAPES.contains(&name) {
                self.leave_out(node, What::Unsized);
            }
            return Ok(());
        };
        let paths = Path::parse_many(&commands).map_err(|_| self.value(node, "a path", &commands))?;
        let paths: Vec<Path> =
            paths.into_iter().map(|path| path.mapped(scope.frame.linear, scope.frame.shift)).collect();
        if !paths.iter().all(is_sized) {
            return Err(self.value(node, "a path of this size", &commands));
        }
        let arrow = if role == Role::Unknown { shaft(&paths) } else { None };
        let role = if arrow.is_some() { Role::Arrow } else { role };
        for path in arrow.map_or(paths, |shaft| vec![shaft]) {
            // A transform may have made a point of it.
            if path.length() > 1e-8 {
                let (group, layer) = (scope.group.clone(), scope.layer.clone());
                let (name, kind, notch) = (own_name(node, group.as_deref()), line_kind(node), told_notch(node));
                let size = scope.size.clone().or_else(|| name.as_deref().and_then(size_of));
                self.strokes.push(Stroke { path, role, name, group, layer, kind, notch, size, filled });
            }
        }
        if self.strokes.len() > MOST_STROKES { Err(SvgError::TooMany { most: MOST_STROKES }) } else { Ok(()) }
    }

    fn leave_out(&mut self, node: Node, what: What) {
        self.left_out.add(what, self.line(node));
    }

    /// Counts the texts that say nothing that is read of any of these pieces.
    fn leave_out_unread(&mut self, pieces: &[Traced]) {
        let mut used = vec![false; self.remarks.len()];
        pieces.iter().flat_map(|p| &p.said_by).for_each(|&i| used[i] = true);
        for &(_, line) in self.texts.iter().filter(|(i, _)| !used[*i]) {
            self.left_out.add(What::Text, line);
        }
    }

    fn line(&self, node: Node) -> u32 {
        self.document.text_pos_at(node.range().start).row
    }

    fn value(&self, node: Node, what: &'static str, text: &str) -> SvgError {
        SvgError::Value { line: self.line(node), what, text: shown(text, SHOWN) }
    }
}

/// Whether a path is no larger, and no farther off, than a pattern may be.
fn is_sized(path: &Path) -> bool {
    [path.start().amax(), path.end().amax(), path.length()].iter().all(|reach| *reach <= FARTHEST)
}

/// The title of the drawing.
fn title(root: Node) -> Option<String> {
    let own = root.children().find(|c| c.tag_name().name() == "title")?;
    own.text().map(|words| shown(words.trim(), REMARK)).filter(|words| !words.is_empty())
}

/// The material that a group names for its piece.
fn material(node: Node) -> Option<Material> {
    let name = shown(node.attribute("data-material")?, SHOWN);
    Some(Material { name, cloth: node.attribute("data-fabric").map(str::to_owned) })
}

/// A text's words and its beginning, which may stand at its first line.
fn remark(node: Node, frame: ElementFrame, letters: f64) -> Option<Remark> {
    let number = |key: &str| {
        let own = node.descendants().find_map(|n| n.attribute(key))?;
        own.split([' ', ',']).next()?.parse::<f64>().ok().filter(|x| x.is_finite())
    };
    let words: Vec<&str> = node.descendants().filter(Node::is_text).filter_map(|n| n.text()).collect();
    let at = Vec2::new(number("x").unwrap_or(0.0), number("y").unwrap_or(0.0));
    let height = letters * frame.linear.determinant().abs().sqrt();
    let text = shown(&words.join(" "), REMARK);
    (!words.is_empty()).then(|| Remark { at: frame.linear * at + frame.shift, text, height })
}

/// The one child of a `switch` that is shown: the first that asks for nothing. Contents in another program's words
/// (Illustrator wraps its drawings so) could not be read, and there is no language to choose by.
fn alternative<'a, 'i>(switch: Node<'a, 'i>) -> Option<Node<'a, 'i>> {
    let asks = |node: &Node| ["requiredExtensions", "systemLanguage"].iter().any(|key| node.has_attribute(*key));
    let is_seen = |name: &str| CONTAINERS.contains(&name) || is_drawing(name);
    let shown = || switch.children().filter(|c| is_seen(c.tag_name().name()));
    let plain = shown().find(|c| !asks(c) && c.tag_name().name() != "foreignObject");
    plain.or_else(|| shown().next())
}

/// Whether elements of this name show something of their own.
fn is_drawing(name: &str) -> bool {
    LINES.contains(&name) || SHAPES.contains(&name) || What::of(name, false).is_some()
}

/// Whether anything would be seen of an element that is shown.
fn draws(node: Node) -> bool {
    let mut open = vec![node];
    while let Some(node) = open.pop() {
        let name = node.tag_name().name();
        if CONTAINERS.contains(&name) {
            open.extend(node.children().filter(Node::is_element));
        } else if is_drawing(name) {
            return true;
        }
    }
    false
}

/// An SVG transform as CSS writes it: with units, of which SVG means these.
fn unitless(transform: &str) -> String {
    transform.replace("px", "").replace("deg", "")
}

/// The name of a group.
struct GroupName {
    name: String,
    /// Whether it is a piece; else it holds pieces.
    is_piece: bool,
}

/// A group's label, or its id where that was not made up by a program.
fn group_name(node: Node) -> Option<GroupName> {
    if node.attribute("class").is_some_and(|c| c.split_whitespace().any(|w| SKIPPED.contains(&w))) {
        return None;
    }
    let label = node.attributes().find(|a| a.name() == "label").map(|a| a.value());
    let id = node.attribute("id").filter(|id| !is_made_up(id));
    let name = label.or(id)?;
    // FreeSewing: fs-stack-DESIGN.PART.
    if let Some(part) = name.strip_prefix("fs-stack-").or(name.strip_prefix("fs-part-")) {
        return Some(GroupName { name: part.rsplit('.').next().unwrap_or(part).to_owned(), is_piece: true });
    }
    // Layers that hold groups or closed lines with names hold pieces; they are none.
    let layer = node.attributes().any(|a| a.name() == "groupmode" && a.value() == "layer");
    let is_piece = |c: Node| c.attributes().any(|a| a.name() == "label") && is_closed_shape(c);
    let holds = name.starts_with("fs-")
        || layer && node.children().any(|c| c.tag_name().name() == "g" || c.is_element() && is_piece(c));
    Some(GroupName { name: name.to_owned(), is_piece: !holds })
}

/// Whether an element is a closed line by itself.
fn is_closed_shape(node: Node) -> bool {
    let ends_closed = || node.attribute("d").is_some_and(|d| d.trim_end().ends_with(['z', 'Z']));
    let name = node.tag_name().name();
    SHAPES.contains(&name) || name == "polygon" || name == "path" && ends_closed()
}

/// Names that programs give, without their numbers: `g123`, `path45-6`, `layer1`, FreeSewing's `fs-7`.
const MADE_UP: [&str; 13] =
    ["g", "path", "rect", "layer", "svg", "polygon", "polyline", "circle", "use", "group", "Group", "fs", ""];

/// Whether a program gave this name.
fn is_made_up(id: &str) -> bool {
    let stem = id.trim_end_matches(|c: char| c.is_ascii_digit() || c == '-' || c == '_');
    MADE_UP.contains(&stem)
}

/// The element's own name; of `piece.edge` in the group `piece` it is the edge.
fn own_name(node: Node, group: Option<&str>) -> Option<String> {
    let label = node.attributes().find(|a| a.name() == "label").map(|a| a.value());
    let name = label.or(node.attribute("id").filter(|id| !is_made_up(id)))?;
    let edge = group.and_then(|g| name.strip_prefix(g)).and_then(|rest| rest.strip_prefix('.'));
    Some(edge.unwrap_or(name).to_owned())
}

/// The effect of a line inside a piece, as toile itself writes it.
fn line_kind(node: Node) -> Option<LineKind> {
    let number = |key: &str| node.attribute(key)?.trim().parse::<f64>().ok();
    let fold = number("data-fold").and_then(LineKind::fold);
    let elastic = || number("data-elastic").and_then(LineKind::elastic);
    let mark = || node.attribute("data-kind").map(|kind| LineKind::Mark(shown(kind, SHOWN)));
    fold.or_else(elastic).or_else(mark)
}

/// An edge's name and how its allowance ends at corners, as toile itself writes it.
fn told_corner(node: Node, group: Option<&str>) -> Option<(String, Corner)> {
    let corner = Corner::from_word(node.attribute("data-corner")?)?;
    Some((own_name(node, group)?, corner))
}

/// The statement on a notch, as toile itself writes it.
fn told_notch(node: Node) -> Option<ToldNotch> {
    let kind = NotchKind::from_word(node.attribute("data-notch")?)?;
    Some(ToldNotch { kind, edge: node.attribute("data-edge").unwrap_or_default().to_owned() })
}
