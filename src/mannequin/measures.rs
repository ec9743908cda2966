//! Measures of a person: their names, and files of them.

use serde_json::Value;

use super::MannequinError;
use crate::input::{LengthUnit, did_you_mean, nearest, yaml};

/// The part of a mannequin's sections that a measure gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning<'a> {
    /// Girth of a row of trunk and neck.
    Trunk(&'a str),
    /// Girth of a row of the leg.
    Leg(&'a str),
    /// Girth of a row of the arm.
    Arm(&'a str),
    /// From the floor to the top of the head.
    Height,
    /// From the floor up to a row of the trunk.
    Above(&'a str),
    /// From the waist down to a row of trunk or leg.
    BelowWaist(&'a str),
    /// From the waist up to a row of the trunk.
    AboveWaist(&'a str),
    /// From the acromion along the arm to a row.
    Along(&'a str),
    /// From one acromion straight to the other.
    Across,
    /// None: a mannequin of sections does not have it.
    Unused,
}

/// A measure by its name and other names, and what it says.
type Known = (&'static str, &'static [&'static str], Meaning<'static>);

use Meaning::{Above, AboveWaist, Across, Along, Arm, BelowWaist, Height, Leg, Trunk, Unused};

/// All measures. Names are FreeSewing's in snake case, where that has one.
const KNOWN: [Known; 43] = [
    ("neck", &[], Trunk("neck base")),
    ("high_bust", &[], Trunk("axilla")),
    ("chest", &["bust"], Trunk("bust")),
    ("underbust", &[], Trunk("underbust")),
    ("waist", &[], Trunk("waist")),
    ("hips", &["high_hip"], Trunk("high hip")),
    ("seat", &["hip"], Trunk("hip")),
    ("upper_leg", &["thigh"], Leg("thigh")),
    ("knee", &[], Leg("knee")),
    ("calf", &[], Leg("calf")),
    ("ankle", &[], Leg("ankle")),
    ("biceps", &["bicep"], Arm("biceps")),
    ("elbow", &[], Arm("elbow")),
    ("wrist", &[], Arm("wrist")),
    ("height", &["stature"], Height),
    ("inseam", &[], Above("crotch")),
    ("waist_to_floor", &[], Above("waist")),
    ("crotch_depth", &[], BelowWaist("crotch")),
    ("waist_to_hips", &[], BelowWaist("high hip")),
    ("waist_to_seat", &[], BelowWaist("hip")),
    ("waist_to_upper_leg", &[], BelowWaist("thigh")),
    ("waist_to_knee", &[], BelowWaist("knee")),
    ("waist_to_underbust", &[], AboveWaist("underbust")),
    ("waist_to_armpit", &[], AboveWaist("axilla")),
    ("shoulder_to_elbow", &[], Along("elbow")),
    ("shoulder_to_wrist", &["arm_length"], Along("wrist")),
    ("shoulder_to_shoulder", &[], Across),
    ("bust_front", &["chest_front"], Unused),
    ("bust_point_to_underbust", &[], Unused),
    ("bust_span", &[], Unused),
    ("cross_seam", &[], Unused),
    ("cross_seam_front", &[], Unused),
    ("head", &[], Unused),
    ("heel", &[], Unused),
    ("high_bust_front", &[], Unused),
    ("hps_to_bust", &[], Unused),
    ("hps_to_waist_back", &[], Unused),
    ("hps_to_waist_front", &[], Unused),
    ("seat_back", &[], Unused),
    ("shoulder_slope", &[], Unused),
    ("waist_back", &[], Unused),
    ("waist_to_bust", &[], Unused),
    ("weight", &[], Unused),
];

/// Names of GarmentCode's body files, whose lengths are centimetres, and ours.
const GARMENTCODE: [(&str, &str); 9] = [
    ("height", "height"),
    ("bust", "chest"),
    ("underbust", "underbust"),
    ("waist", "waist"),
    ("hips", "seat"),
    ("leg_circ", "upper_leg"),
    ("wrist", "wrist"),
    ("arm_length", "shoulder_to_wrist"),
    ("hips_line", "waist_to_seat"),
];
/// Keys of files in which the measures stand a level deeper: GarmentCode's and FreeSewing's.
const WRAPPERS: [&str; 3] = ["body", "measurements", "measies"];
/// The least and the largest measure, mm. Others are in another unit.
const RANGE: std::ops::RangeInclusive<f64> = 20.0..=2600.0;

/// A measure that was given.
#[derive(Clone, Debug, PartialEq)]
struct GivenMeasure {
    name: &'static str,
    /// The name that was used.
    written: String,
    meaning: Meaning<'static>,
    mm: f64,
}

/// Measures of a person, mm, each by its own name in snake case, and the mannequin that has what is not measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measures {
    /// Name of a mannequin or a file. `None` where nobody has said.
    pub like: Option<String>,
    given: Vec<GivenMeasure>,
    /// Those that no section has.
    unused: Vec<&'static str>,
}

/// Names of the measures that change a mannequin, each by the first of its names.
pub fn measure_names() -> impl Iterator<Item = &'static str> {
    KNOWN.iter().filter(|(_, _, meaning)| *meaning != Unused).map(|(name, _, _)| *name)
}

impl Measures {
    /// Adds a measure, mm.
    ///
    /// # Errors
    /// A name that is none, a measure that is there already, or a length that no body has.
    pub fn add(&mut self, name: &str, mm: f64) -> Result<(), String> {
        let Some((own, _, meaning)) = known(name) else {
            let names = KNOWN.iter().flat_map(|(own, others, _)| std::iter::once(own).chain(*others)).copied();
            return Err(format!("'{name}' is no measure{}", did_you_mean(nearest(name, names))));
        };
        if *meaning == Unused {
            self.unused.push(own);
            return Ok(());
        }
        if self.given(own).is_some() {
            return Err(format!("'{name}' is given twice"));
        }
        if !RANGE.contains(&mm) {
            let (low, high) = (RANGE.start(), RANGE.end());
            return Err(format!("'{name}' is {mm} mm; it must be {low} to {high} mm, bare numbers being millimetres"));
        }
        self.given.push(GivenMeasure { name: own, written: name.to_owned(), meaning: *meaning, mm });
        Ok(())
    }

    /// Reads a file of measures, YAML or JSON: a mapping of names to lengths, and `like`. Names may be written as
    /// FreeSewing does (`waistToFloor`). A body file of GarmentCode, whose `body` holds centimetres, is read as well.
    ///
    /// # Errors
    /// [`MannequinError`] with the file's name.
    pub fn parse(text: &str, from: &str) -> Result<Self, MannequinError> {
        let value: Value = yaml(text).map_err(|why| MannequinError::Syntax { file: from.to_owned(), why })?;
        Self::from_value(&value).map_err(|why| MannequinError::Value { file: from.to_owned(), why })
    }

    fn from_value(value: &Value) -> Result<Self, String> {
        let top = value.as_object().ok_or("measures are written as 'waist: 740', each on its line")?;
        let inner = WRAPPERS.iter().find_map(|key| Some((*key, top.get(*key)?.as_object()?)));
        let mut out = Self { like: top.get("like").and_then(Value::as_str).map(str::to_owned), ..Self::default() };
        let is_garmentcode = matches!(inner, Some(("body", _)));
        for (name, value) in inner.map_or(top, |(_, inner)| inner).iter().filter(|(name, _)| *name != "like") {
            if is_garmentcode {
                let own = GARMENTCODE.iter().find(|(theirs, _)| theirs == name);
                if let Some((_, own)) = own {
                    out.add(own, 10.0 * number(name, value)?)?;
                }
            } else {
                out.add(&snake_case(name), number(name, value)?)?;
            }
        }
        Ok(out)
    }

    /// These measures, and those of `other` that are not among them.
    pub fn over(mut self, other: &Self) -> Self {
        let more = other.given.iter().filter(|given| self.given(given.name).is_none()).cloned();
        let more: Vec<GivenMeasure> = more.collect();
        self.given.extend(more);
        self.like = self.like.or_else(|| other.like.clone());
        self
    }

    /// The measure of this name, mm.
    pub fn given(&self, name: &str) -> Option<f64> {
        self.given.iter().find(|given| given.name == name).map(|given| given.mm)
    }

    /// Names of the measures and their values, mm.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, f64)> {
        self.given.iter().map(|given| (given.name, given.mm))
    }

    /// Whether nothing is measured.
    pub fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    /// Names of measures that say nothing of a mannequin's sections, and are left out.
    pub fn unused(&self) -> &[&'static str] {
        &self.unused
    }

    /// Every measure as it was called, what it says, and its value.
    pub(super) fn said(&self) -> impl Iterator<Item = (&str, Meaning<'static>, f64)> {
        self.given.iter().map(|given| (given.written.as_str(), given.meaning, given.mm))
    }

    /// The measure of this meaning, if it is given, mm.
    pub(super) fn of(&self, wanted: Meaning) -> Option<f64> {
        self.said().find(|(_, meaning, _)| *meaning == wanted).map(|(_, _, mm)| mm)
    }
}

fn known(name: &str) -> Option<&'static Known> {
    KNOWN.iter().find(|(own, others, _)| *own == name || others.contains(&name))
}

/// The meaning of a measure of this name.
pub(super) fn meaning(name: &str) -> Option<Meaning<'static>> {
    known(name).map(|known| known.2)
}

/// A length in mm: a number, or a text with a unit.
fn number(name: &str, value: &Value) -> Result<f64, String> {
    let wrong = || format!("'{name}' is {value}; a length is expected, such as 740 or 74 cm");
    let Some(text) = value.as_str() else { return value.as_f64().ok_or_else(wrong) };
    let split = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c))).unwrap_or(text.len());
    let (number, unit) = (text[..split].trim().parse::<f64>().map_err(|_| wrong())?, text[split..].trim());
    match unit {
        "" => Ok(number),
        symbol => LengthUnit::from_symbol(symbol).map(|unit| 1e3 * unit.metres() * number).ok_or_else(wrong),
    }
}

/// `waistToFloor` as `waist_to_floor`.
fn snake_case(name: &str) -> String {
    let mut out = String::with_capacity(name.len() + 4);
    for c in name.chars() {
        if c.is_ascii_uppercase() {
            out.push('_');
        }
        out.push(if c == ' ' || c == '-' { '_' } else { c.to_ascii_lowercase() });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_others_are_read() {
        let freesewing = Measures::parse("{\"measurements\": {\"waistToFloor\": 1010, \"bustSpan\": 170}}", "f.json");
        let freesewing = freesewing.expect("read");
        assert_eq!(freesewing.given("waist_to_floor"), Some(1010.0));
        assert_eq!(freesewing.unused(), ["bust_span"]);
        let garmentcode =
            Measures::parse("body:\n  bust: 99.5\n  hips: 103.25\n  head_l: 26\n", "f.yaml").expect("read");
        assert_eq!((garmentcode.given("chest"), garmentcode.given("seat")), (Some(995.0), Some(1032.5)));
        let own = Measures::parse("like: man_100\nhip: 1 m\nbust: 40 in\n", "own.yaml").expect("read");
        assert_eq!(
            (own.like.as_deref(), own.given("seat"), own.given("chest")),
            (Some("man_100"), Some(1000.0), Some(1016.0))
        );
    }

    #[test]
    fn mistakes_are_named() {
        let wrong = |text: &str| Measures::parse(text, "own.yaml").expect_err("wrong").to_string();
        assert!(wrong("wais: 740").contains("'wais' is no measure; did you mean 'waist'?"));
        assert!(wrong("waist: 7.4").contains("7.4 mm; it must be 20 to 2600 mm"), "{}", wrong("waist: 7.4"));
        assert!(wrong("bust: 900\nchest: 910").contains("given twice"));
        assert!(wrong("waist: [1]").contains("a length is expected"));
        assert!(wrong("- waist").contains("each on its line"));
    }
}
