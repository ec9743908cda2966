//! What a line is by its classes, markers and name.

use roxmltree::Node;

use super::shapes::commands;
use crate::digitize::{FastenerKind, Role};
use crate::geometry::{Path, Vec2};

/// Classes of what is no line of the pattern.
pub(super) const SKIPPED: [&str; 11] =
    ["drawn", "grid", "help", "note", "mark", "text", "hidden", "scale", "pleat", "scalebox", "miniscale"];

/// FreeSewing's symbols of buttons and what they go through. One that is called as another begins comes before that.
const FASTENERS: [(&str, FastenerKind); 4] = [
    ("#buttonhole", FastenerKind::Buttonhole),
    ("#button", FastenerKind::Button),
    ("#snap-stud", FastenerKind::Stud),
    ("#snap-socket", FastenerKind::Socket),
];

/// The kind of a line by its classes, markers and name. `None` if it is no line of the pattern.
pub(super) fn role(node: Node, classes: &str) -> Option<Role> {
    let has = |word: &str| classes.split_whitespace().any(|c| c == word);
    let refers = |name: &str| {
        let marker = ["marker-start", "marker-end", "style", "href"];
        node.attributes().any(|a| marker.contains(&a.name()) && a.value().contains(name))
    };
    // A name tells what a line is only where its class does not: an edge of a collar may be called a notch.
    let is_said = ["cut", "sa", "edge", "sew", "fabric", "seam"].into_iter().any(has);
    let called = |word: &str| {
        if is_said {
            return false;
        }
        let named = node.attributes().filter(|a| a.name() == "id" || a.name() == "label");
        named.map(|a| a.value().to_lowercase()).any(|v| v.contains(word))
    };
    if has("grain") || has("grainline") || refers("grainline") || called("grain") {
        return Some(Role::Grain);
    }
    if refers("cutonfold") || has("cutonfold") || has("fold") && is_line(node) {
        return Some(Role::Fold);
    }
    match node.attribute("data-pleat") {
        Some("fold") => return Some(Role::PleatFold),
        Some("place") => return Some(Role::PleatPlace),
        _ => {}
    }
    if has("notch") || refers("notch") || called("notch") {
        return Some(Role::Notch);
    }
    if has("drill") {
        return Some(Role::Drill);
    }
    if node.tag_name().name() == "use"
        && let Some((_, kind)) = FASTENERS.iter().find(|(symbol, _)| refers(symbol))
    {
        return Some(Role::Fastener(*kind));
    }
    // Other symbols are logos.
    if has("fold") || SKIPPED.iter().any(|w| has(w)) || ["text", "use"].contains(&node.tag_name().name()) {
        return None;
    }
    Some(if has("cut") || has("sa") {
        Role::Cut
    } else if has("edge") || has("sew") {
        Role::Edge
    } else if has("fabric") || has("seam") {
        Role::Sew
    } else {
        Role::Unknown
    })
}

/// Whether it is one straight line: the fold itself, not its arrow.
fn is_line(node: Node) -> bool {
    let lines = commands(node, node.tag_name().name(), Vec2::zeros()).and_then(|text| Path::parse_many(&text).ok());
    matches!(lines.as_deref(), Some([line]) if line.is_straight())
}
