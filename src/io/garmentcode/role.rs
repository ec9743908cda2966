//! The role of a panel, from its name and how it hangs.

use super::drawing::PanelDrawing;
use super::spec::{Panel, Specification};
use crate::geometry::range_of;
use crate::pattern::{PlaceWord, Side};

/// The part of a garment a panel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PanelRole {
    Bodice,
    Sleeve,
    Cuff,
    TrouserCuff,
    Collar,
    Hood,
    Skirt,
    Trousers,
    Waistband,
}

/// Parts of panel names, in the order in which they count.
const WORDS: [(&str, PanelRole); 14] = [
    ("cuff", PanelRole::Cuff),
    ("sleeve", PanelRole::Sleeve),
    ("hood", PanelRole::Hood),
    ("collar", PanelRole::Collar),
    ("lapel", PanelRole::Collar),
    ("turtle", PanelRole::Collar),
    ("wb", PanelRole::Waistband),
    ("waistband", PanelRole::Waistband),
    ("belt", PanelRole::Waistband),
    ("pant", PanelRole::Trousers),
    ("skirt", PanelRole::Skirt),
    ("torso", PanelRole::Bodice),
    ("bodice", PanelRole::Bodice),
    ("shirt", PanelRole::Bodice),
];

impl PanelRole {
    pub(super) fn of(spec: &Specification, panel: usize) -> Self {
        let own = &spec.panels[panel];
        let name = own.name.to_lowercase();
        let named = WORDS.iter().find(|(word, _)| name.contains(word)).map(|(_, role)| *role);
        match (named, own.label.as_deref()) {
            (Some(Self::Cuff), Some("leg")) => Self::TrouserCuff,
            (Some(role), _) => role,
            (None, Some("arm")) => Self::Sleeve,
            (None, _) if goes_between_legs(spec, panel) => Self::Trousers,
            (None, Some("leg")) => Self::Skirt,
            (None, _) => Self::Bodice,
        }
    }

    /// Whether it goes round an arm.
    pub(super) fn round_arm(self) -> bool {
        matches!(self, Self::Sleeve | Self::Cuff)
    }

    /// Whether it goes round the trunk.
    pub(super) fn round_trunk(self) -> bool {
        matches!(self, Self::Bodice | Self::Waistband | Self::Skirt | Self::Trousers)
    }

    /// The word of `place:` for the part of the body it goes round; `None` for one that stands free.
    pub(super) fn body_part(self) -> Option<PlaceWord> {
        match self {
            Self::Bodice => Some(PlaceWord::Torso),
            Self::Sleeve => Some(PlaceWord::Arm),
            Self::Cuff => Some(PlaceWord::Wrist),
            Self::Waistband => Some(PlaceWord::Waist),
            Self::Skirt => Some(PlaceWord::Skirt),
            Self::Trousers => Some(PlaceWord::Hip),
            Self::TrouserCuff => Some(PlaceWord::Leg),
            Self::Collar | Self::Hood => None,
        }
    }
}

/// Whether a panel is sewn as trousers are: the seam to the other side's panel that faces the same way goes straight on
/// into one to its own side's other panel, at the crotch. (Under the centre seam of a bodice is its hem.)
fn goes_between_legs(spec: &Specification, panel: usize) -> bool {
    let middle = |k: usize| spec.panels[k].middle();
    let own = middle(panel);
    let partner = |edge: usize| {
        let ends = spec.stitches.iter().flat_map(|s| [s.ends, [s.ends[1], s.ends[0]]]);
        ends.filter(|[here, _]| *here == (panel, edge)).map(|[_, there]| there.0).find(|k| *k != panel)
    };
    let side = |x: f64| if x.abs() > MIDDLE { x.signum() } else { 0.0 };
    let is_across = |k: usize| side(middle(k).x) * side(own.x) < 0.0 && middle(k).z * own.z > 0.0;
    let is_beside = |k: usize| side(middle(k).x) * side(own.x) > 0.0 && middle(k).z * own.z < 0.0;
    let edges = &spec.panels[panel].edges;
    let count = edges.len();
    let height = |k: usize| 0.5 * (spec.panels[panel].space(edges[k].start) + spec.panels[panel].space(edges[k].end)).y;
    let steps = (0..count).flat_map(|k| [(k, (k + 1) % count), (k, (k + count - 1) % count)]);
    steps.into_iter().any(|(k, next)| {
        partner(k).is_some_and(is_across) && partner(next).is_some_and(is_beside) && height(next) < height(k)
    })
}

/// Front or back of the wearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PanelFacing {
    Front,
    Back,
}

impl PanelFacing {
    /// A right side that looks this far forward or back (cosine) says where its panel is.
    const CLEAR: f64 = 0.5;

    pub(super) fn of(drawing: &PanelDrawing) -> Option<Self> {
        if drawing.normal.z > Self::CLEAR {
            return Some(Self::Front);
        }
        (drawing.normal.z < -Self::CLEAR).then_some(Self::Back)
    }

    pub(super) fn word(self) -> PlaceWord {
        match self {
            Self::Front => PlaceWord::Front,
            Self::Back => PlaceWord::Back,
        }
    }
}

/// Nearer the middle of the body than this, mm, a panel is on neither side.
const MIDDLE: f64 = 10.0;

/// Which side of the body a panel is on: all of it, or, for what goes round one limb however wide, its middle.
pub(super) fn side(drawing: &PanelDrawing, role: PanelRole) -> Option<Side> {
    if role.round_arm() || matches!(role, PanelRole::Trousers | PanelRole::TrouserCuff) {
        let x = drawing.space(drawing.middle()).x;
        return (x.abs() > MIDDLE).then_some(if x > 0.0 { Side::Left } else { Side::Right });
    }
    let [low, high] = range_of(drawing.edges.iter().map(|e| drawing.space(e.start).x));
    if low > -MIDDLE && high > MIDDLE {
        return Some(Side::Left);
    }
    (high < MIDDLE && low < -MIDDLE).then_some(Side::Right)
}

/// A name a maker would give the panel: without its side, in whole words, `front` or `back` last.
pub(super) fn piece_name(panel: &Panel) -> String {
    let lower = panel.name.to_lowercase();
    let (mut words, mut facing) = (Vec::new(), None);
    for word in lower.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()) {
        match word {
            "left" | "right" | "l" | "r" | "sl" => {}
            "front" | "f" | "ftorso" | "lfront" | "rfront" => facing = Some("front"),
            "back" | "b" | "btorso" | "lback" | "rback" => facing = Some("back"),
            "wb" => words.push("waistband"),
            "pant" | "pants" => words.push("trousers"),
            other => words.push(other),
        }
    }
    words.extend(facing);
    if words.is_empty() { "piece".to_owned() } else { words.join("_") }
}

/// `name`, or with a number behind it if it is taken; a word that is no name gets one before it.
pub(super) fn unique(name: &str, taken: &[String]) -> String {
    let reserved = name.parse::<f64>().is_ok() || ["L", "R", "mirror", "all"].contains(&name);
    let name = if reserved { format!("piece_{name}") } else { name.to_owned() };
    if !taken.contains(&name) {
        return name;
    }
    let mut number = 2;
    while taken.contains(&format!("{name}_{number}")) {
        number += 1;
    }
    format!("{name}_{number}")
}
