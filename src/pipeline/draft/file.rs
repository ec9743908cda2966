//! A file of style lines, as it is written.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};

use crate::pattern::{Unit, parse_quantity};

/// The whole file.
#[derive(Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LinesFile {
    /// Name of the garment.
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) ease: EaseFile,
    /// A fabric of the library or a file.
    pub(super) fabric: Option<String>,
    pub(super) darts: Option<DartsFile>,
    pub(super) lines: Entries<StyleLineFile>,
    pub(super) panels: Entries<PanelFile>,
}

/// One ease everywhere, or by girth.
#[derive(Debug, serde::Deserialize)]
#[serde(untagged)]
pub(super) enum EaseFile {
    All(LengthOrGirth),
    Girths(Entries<LengthOrGirth>),
}

impl Default for EaseFile {
    fn default() -> Self {
        Self::All(LengthOrGirth::Number(0.0))
    }
}

/// A length or, where one may be, a girth's name.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(untagged)]
pub(super) enum LengthOrGirth {
    Number(f64),
    Text(String),
}

impl LengthOrGirth {
    /// Metres. `None` for a word.
    pub(super) fn metres(&self) -> Option<f64> {
        let found = match self {
            Self::Number(mm) => mm * 1e-3,
            Self::Text(text) => parse_quantity(text).ok().filter(|q| !q.is_percent())?.value(Unit::Millimetre),
        };
        found.is_finite().then_some(found)
    }
}

/// `auto`, or a number.
#[derive(Debug, serde::Deserialize)]
#[serde(untagged)]
pub(super) enum DartsFile {
    Count(usize),
    Word(String),
}

/// A line: one of `girth`, `height`, `round` and `through`.
#[derive(Clone, Debug, Default, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct StyleLineFile {
    pub(super) girth: Option<String>,
    pub(super) height: Option<LengthOrGirth>,
    pub(super) of: Option<String>,
    pub(super) round: Option<Vec<PointFile>>,
    pub(super) through: Option<Vec<PointFile>>,
    /// Whether it is there on both sides of the body.
    pub(super) both: bool,
}

/// A panel: a point in it.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PanelFile {
    pub(super) at: PointFile,
    #[serde(default)]
    pub(super) both: bool,
}

/// A point: `at`, `landmark`, `height` and `angle`, or `on` a line at an `angle` or a `height`.
#[derive(Clone, Debug, Default, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct PointFile {
    pub(super) at: Option<[f64; 3]>,
    pub(super) landmark: Option<String>,
    pub(super) height: Option<LengthOrGirth>,
    pub(super) angle: Option<f64>,
    pub(super) of: Option<String>,
    pub(super) on: Option<String>,
}

/// A name on the other side of the body: `left` and `right` change places.
fn other_side(name: &str) -> String {
    match (name.strip_prefix("left "), name.strip_prefix("right ")) {
        (Some(rest), _) => format!("right {rest}"),
        (_, Some(rest)) => format!("left {rest}"),
        _ => name.to_owned(),
    }
}

impl PointFile {
    /// The point on the other side. Lines that are there on both sides are named by `doubled`.
    fn mirrored(&self, doubled: &[String]) -> Self {
        let on = self.on.as_ref().map(|on| on_side(on, "right", doubled));
        Self {
            at: self.at.map(|[x, y, z]| [-x, y, z]),
            angle: self.angle.map(|a| -a),
            of: self.of.as_deref().map(other_side),
            on,
            ..self.clone()
        }
    }

    fn of_left(&self, doubled: &[String]) -> Self {
        Self { on: self.on.as_ref().map(|on| on_side(on, "left", doubled)), ..self.clone() }
    }
}

fn on_side(line: &str, side: &str, doubled: &[String]) -> String {
    if doubled.iter().any(|d| d == line) { format!("{side} {line}") } else { other(line, side) }
}

fn other(line: &str, side: &str) -> String {
    if side == "right" { other_side(line) } else { line.to_owned() }
}

impl LinesFile {
    /// All lines; one that is there on `both` sides is two, `left NAME` and `right NAME`.
    pub(super) fn all_lines(&self) -> Vec<(String, StyleLineFile)> {
        let doubled: Vec<String> = self.lines.0.iter().filter(|l| l.1.both).map(|l| l.0.clone()).collect();
        let mut all = Vec::new();
        for (name, line) in &self.lines.0 {
            if !line.both {
                all.push((name.clone(), line.clone()));
                continue;
            }
            let points = |points: &Option<Vec<PointFile>>, of: &dyn Fn(&PointFile) -> PointFile| {
                points.as_ref().map(|all| all.iter().map(of).collect())
            };
            let side = |of: &dyn Fn(&PointFile) -> PointFile| StyleLineFile {
                round: points(&line.round, of),
                through: points(&line.through, of),
                ..line.clone()
            };
            all.push((format!("left {name}"), side(&|p| p.of_left(&doubled))));
            let right = StyleLineFile { of: line.of.as_deref().map(other_side), ..side(&|p| p.mirrored(&doubled)) };
            all.push((format!("right {name}"), right));
        }
        all
    }

    /// All panels, each with a point in it.
    pub(super) fn all_panels(&self) -> Vec<(String, PointFile)> {
        let mut all = Vec::new();
        for (name, panel) in &self.panels.0 {
            if panel.both {
                all.push((format!("left {name}"), panel.at.clone()));
                all.push((format!("right {name}"), panel.at.mirrored(&[])));
            } else {
                all.push((name.clone(), panel.at.clone()));
            }
        }
        all
    }
}

/// The entries of a mapping, in the order of the file.
#[derive(Debug)]
pub(super) struct Entries<T>(pub(super) Vec<(String, T)>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Entries<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct DraftReader<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for DraftReader<T> {
            type Value = Entries<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("names, each with what it stands for")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries<T>, A::Error> {
                let mut all: Vec<(String, T)> = Vec::new();
                while let Some((name, value)) = map.next_entry::<String, T>()? {
                    if all.iter().any(|(other, _)| *other == name) {
                        return Err(serde::de::Error::custom(format!("'{name}' is there twice")));
                    }
                    all.push((name, value));
                }
                Ok(Entries(all))
            }
        }
        from.deserialize_map(DraftReader(PhantomData))
    }
}
