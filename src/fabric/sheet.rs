//! A fabric file as written: every value with its source.

use serde_yaml::Value;

use super::error::FabricError;
use super::measure::weights;
use crate::input::{shown, yaml};

/// Characters of a message that are shown: it may quote the whole file.
const MESSAGE: usize = 300;

/// Contents of a fabric file.
#[derive(Clone, Debug, PartialEq)]
pub struct FabricSheet {
    /// Name.
    pub name: String,
    /// One line.
    pub description: String,
    /// Its values in the file's order.
    pub measurements: Vec<Measurement>,
    /// Liu's geometric measures: of the fifteen fabrics they were published for, and of those measured the same way.
    pub liu: Option<LiuMeasures>,
    /// Note for readers of the numbers, such as a conflict of weights and physics.
    pub note: Option<String>,
}

/// One value of a fabric.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measurement {
    /// `weight`, `tensile.weft.EMT` …
    pub key: String,
    /// As written, with its unit.
    pub value: String,
    /// Its source.
    pub source: Option<String>,
    /// One standard deviation, as written.
    pub uncertainty: Option<String>,
}

/// A row of table 2 of Liu, Wang & Luo 2015, or of a fabric measured likewise. Each triple is recovery, stretch, bend.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LiuMeasures {
    /// Number in the table, 0–14. None for a fabric that is not in it.
    #[serde(default)]
    pub sample: Option<u8>,
    /// Means v of the readings, as ratios.
    pub means: [f64; 3],
    /// Standard deviation of a single reading's v. Not published for the fifteen.
    #[serde(default)]
    pub spread: Option<[f64; 3]>,
    /// Normalised values v'. They do not follow from the means, because the extremes of the readings are not published.
    pub normalised: [f64; 3],
    /// ω, percent: as published, or by (8).
    pub weights: [f64; 3],
}

/// No cloth's diagonal grows beyond this many times its length at 8 N. The other two measures are at most 1.
pub(super) const LARGEST_MEAN: f64 = 3.0;
/// The bending length of a fabric with ω_B = ω_R under gravity, metres: the one constant of
/// [`LiuMeasures::fallback_bending_length`]. A trial of disc drapes put it at 20 to 22 mm, where silk, poplin,
/// denim and canvas come in their known order.
const EVEN_BENDING_LENGTH: f64 = 0.022;

impl LiuMeasures {
    /// The last resort for a fabric without physical values: a bending length from the weights alone, metres,
    /// c = c₀ (ω_B/ω_R)^⅓. The formula is not the paper's, whose recovery term is no weight. It knows nothing of the
    /// cloth's weight or thickness. For the fifteen fabrics it gives 0.5 mm (fine cotton, ω_B = 0.001 %) to 453 mm
    /// (linen, ω_R = 0.01 %), where the measured values give 16 to 29 mm.
    pub fn fallback_bending_length(&self) -> f64 {
        let [recovery, _, bend] = self.weights;
        EVEN_BENDING_LENGTH * (bend / recovery).cbrt()
    }

    /// Refuses values that no readings give.
    fn check(&self) -> Result<(), String> {
        let within = |name: &str, values: &[f64; 3], low: f64, high: f64| {
            let wrong = values.iter().any(|v| !(low..=high).contains(v));
            if wrong { Err(format!("liu.{name} is {values:?}; each lies between {low} and {high}")) } else { Ok(()) }
        };
        within("means", &self.means, 0.0, LARGEST_MEAN)?;
        within("spread", &self.spread.unwrap_or_default(), 0.0, LARGEST_MEAN)?;
        within("normalised", &self.normalised, 0.0, 1.0)?;
        within("weights", &self.weights, 0.0, 100.0)?;
        let sums = [("normalised", &self.normalised), ("weights", &self.weights)];
        match sums.into_iter().find(|(_, values)| values.iter().all(|v| *v == 0.0)) {
            Some((name, _)) => Err(format!("liu.{name}: all three are 0")),
            None => Ok(()),
        }
    }

    /// Equation (8): ω = v'/Σv', percent. Agrees with the published weights within 0.02 except for samples 10 (0.15),
    /// 11 (0.58) and 12 (0.055).
    pub fn recomputed_weights(&self) -> [f64; 3] {
        weights(self.normalised)
    }
}

impl FabricSheet {
    /// Curve files that its values name, relative to its own folder.
    pub fn curve_files(&self) -> impl Iterator<Item = &str> {
        self.measurements.iter().filter(|m| names_curve(m)).map(|m| m.value.trim())
    }

    /// The drape coefficients that were measured of such cloths, per cent, from `drape: 60-83 %`.
    pub fn drape_band(&self) -> Option<[f64; 2]> {
        let text = &self.measurements.iter().find(|m| m.key == "drape")?.value;
        let number = |n: &str| n.trim().trim_end_matches('%').trim().parse::<f64>().ok();
        let numbers: Option<Vec<f64>> = text.split(['-', '–']).map(number).collect();
        match numbers?[..] {
            [one] => Some([one, one]),
            [low, high] => Some([low, high]),
            _ => None,
        }
        .filter(|[low, high]| 1.0 <= *low && low <= high && *high <= 100.0)
    }

    /// Refuses values that are given twice, as `bend.warp: …` beside `bend: {warp: …}`, and impossible drape
    /// coefficients.
    fn check(&self) -> Result<(), String> {
        once(&self.measurements)?;
        match self.measurements.iter().find(|m| m.key == "drape") {
            Some(m) if self.drape_band().is_none() => {
                Err(format!("drape is '{}'; a coefficient in per cent is expected, such as 60-83 %", m.value))
            }
            _ => Ok(()),
        }
    }

    /// Reads a fabric file's text. `from` names it in errors.
    ///
    /// # Errors
    /// [`FabricError::Syntax`] when it is no YAML map of values.
    pub fn parse(text: &str, from: &str) -> Result<Self, FabricError> {
        let fault = |why: String| FabricError::Syntax { file: from.to_owned(), why: shown(&why, MESSAGE) };
        let value: Value = yaml(text).map_err(fault)?;
        let Value::Mapping(map) = value else {
            return Err(fault("a fabric is a map of values, such as weight: 115 g/m2".to_owned()));
        };
        let stem = std::path::Path::new(from).file_stem().map_or(from.into(), |s| s.to_string_lossy());
        let mut out = Self {
            name: stem.into_owned(),
            description: String::new(),
            measurements: Vec::new(),
            liu: None,
            note: None,
        };
        for (key, value) in map {
            let key = key.as_str().ok_or_else(|| fault("every key must be a word".to_owned()))?.to_owned();
            match key.as_str() {
                "name" => {
                    let name = scalar(&value).filter(|name| !name.trim().is_empty());
                    out.name = name.ok_or_else(|| fault("name: a word or two are expected".to_owned()))?;
                }
                "description" => out.description = scalar(&value).unwrap_or_default(),
                "note" => out.note = scalar(&value),
                "liu" => {
                    let liu: LiuMeasures = serde_yaml::from_value(value).map_err(|e| fault(format!("liu: {e}")))?;
                    liu.check().map_err(fault)?;
                    out.liu = Some(liu);
                }
                _ => flatten(&key, &value, &mut out.measurements).map_err(&fault)?,
            }
        }
        out.check().map_err(fault)?;
        Ok(out)
    }
}

/// Whether a value is the name of a curve's file.
pub(super) fn names_curve(m: &Measurement) -> bool {
    m.key.starts_with("tensile") && m.value.trim().ends_with(".csv")
}

/// Refuses two values of one key.
pub(super) fn once(measurements: &[Measurement]) -> Result<(), String> {
    let twice = |(k, m): &(usize, &Measurement)| measurements[..*k].iter().any(|before| before.key == m.key);
    match measurements.iter().enumerate().find(twice) {
        Some((_, m)) => Err(format!("{} stands there twice; leave one out", m.key)),
        None => Ok(()),
    }
}

/// The measurements of a nested value: `bend: {warp: 1 uN.m}` is `bend.warp`. A map with a `value` is one measurement.
pub(super) fn flatten(key: &str, value: &Value, out: &mut Vec<Measurement>) -> Result<(), String> {
    let Value::Mapping(map) = value else {
        let text = scalar(value).ok_or_else(|| format!("{key}: a value with its unit is expected"))?;
        out.push(Measurement { key: key.to_owned(), value: text, source: None, uncertainty: None });
        return Ok(());
    };
    if let Some(value) = map.get("value") {
        let text = |k: &str| map.get(k).and_then(scalar);
        let value = scalar(value).ok_or_else(|| format!("{key}: the value must be a number with its unit"))?;
        let known = ["value", "source", "uncertainty"];
        if let Some(other) = map.keys().find(|k| !k.as_str().is_some_and(|k| known.contains(&k))) {
            return Err(format!("{key}: '{}' is none of {}", scalar(other).unwrap_or_default(), known.join(", ")));
        }
        let (source, uncertainty) = (text("source"), text("uncertainty"));
        out.push(Measurement { key: key.to_owned(), value, source, uncertainty });
        return Ok(());
    }
    for (inner, value) in map {
        let inner = inner.as_str().ok_or_else(|| format!("{key}: every key must be a word"))?;
        flatten(&format!("{key}.{inner}"), value, out)?;
    }
    Ok(())
}

/// A single value as text.
fn scalar(value: &Value) -> Option<String> {
    match value {
        Value::String(s) => Some(s.clone()),
        Value::Number(n) => Some(n.to_string()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_that_no_readings_give_are_refused() {
        let said = |liu: &str| FabricSheet::parse(&format!("liu: {{{liu}}}"), "a.yaml").expect_err(liu).to_string();
        let rest = "normalised: [0.5, 0.5, 0.5]";
        assert!(said(&format!("means: [.nan, 1, 1], {rest}, weights: [30, 30, 40]")).contains("liu.means is [NaN"));
        assert!(
            said(&format!("means: [1, 1, 1], {rest}, weights: [0, 0, 0]")).contains("liu.weights: all three are 0")
        );
        assert!(said(&format!("means: [1, 1, 1], {rest}, weights: [-10, 60, 50]")).contains("liu.weights is [-10"));
        assert!(said("means: [1, 1, 1], normalised: [2, 0, 0], weights: [30, 30, 40]").contains("liu.normalised"));
    }

    #[test]
    fn what_is_said_twice_is_refused() {
        let said = |text: &str| FabricSheet::parse(text, "a.yaml").expect_err(text).to_string();
        let twice = said("bend.warp: 1 uN.m\nbend: {warp: 2 uN.m}");
        assert_eq!(twice, "a.yaml: bend.warp stands there twice; leave one out");
        for none in ["lots", "0.45", "80-60 %", "30-140 %"] {
            assert!(said(&format!("drape: {none}")).contains("a coefficient in per cent"), "{none}");
        }
    }

    #[test]
    fn a_band_may_be_written_with_either_dash() {
        for text in ["60-83 %", "60–83 %", "60 % - 83 %"] {
            let sheet = FabricSheet::parse(&format!("drape: {text}"), "a.yaml").expect("a sheet");
            assert_eq!(sheet.drape_band(), Some([60.0, 83.0]));
        }
    }
}
