//! Values that a file of readings gives itself, and which of a sheet and of curves they replace.

use std::path::{Path, PathBuf};

use serde_yaml::Mapping;

use super::MeasureError;
use super::laboratory::{DIRECTIONS, short};
use crate::fabric::TensileCurve;
use crate::fabric::library::read;
use crate::fabric::sheet::{Measurement, flatten, names_curve, once};
use crate::fabric::units::GF_PER_CM;

/// Ending of keys of curves.
const CURVE: &str = ".curve";

/// The values given in a file of readings, as they are to be written. A curve that one of them names lies beside that
/// file. It is written point by point, because the fabric's file may lie elsewhere.
pub(super) fn given(
    values: &Mapping,
    folder: &Path,
    inputs: &mut Vec<PathBuf>,
    fault: impl Fn(String) -> MeasureError,
) -> Result<Vec<Measurement>, MeasureError> {
    let mut flat = Vec::new();
    for (key, value) in values {
        let key = key.as_str().ok_or_else(|| fault("values: every key must be a word".to_owned()))?;
        if ["name", "description", "source", "note", "liu"].contains(&key) {
            return Err(fault(format!("values: {key} is none; it stands beside values, or nowhere")));
        }
        flatten(key, value, &mut flat).map_err(&fault)?;
    }
    once(&flat).map_err(|why| fault(format!("values: {why}")))?;
    for whole in flat.iter().filter(|m| m.key.ends_with(CURVE)) {
        let way = whole.key.trim_end_matches(CURVE);
        let same = |m: &&Measurement| m.key.strip_prefix(way).is_some_and(|what| [".EMT", ".LT"].contains(&what));
        if let Some(part) = flat.iter().find(same) {
            return Err(fault(format!("values: {} and {} say the same; leave one out", part.key, whole.key)));
        }
    }
    let mut out = Vec::new();
    for m in flat {
        let file = folder.join(m.value.trim());
        let keys: Vec<String> = match m.key.as_str() {
            "tensile" => DIRECTIONS.iter().map(|d| format!("tensile.{d}.curve")).collect(),
            "tensile.warp" | "tensile.weft" => vec![format!("{}.curve", m.key)],
            _ => Vec::new(),
        };
        if keys.is_empty() || !names_curve(&m) {
            out.push(m);
            continue;
        }
        let curve = TensileCurve::parse(&read(&file)?, m.value.trim())?;
        inputs.push(file);
        let point = |(strain, load): &(f64, f64)| format!("{}:{}", short(100.0 * strain), short(load / GF_PER_CM));
        let value = curve.points[1..].iter().map(point).collect::<Vec<_>>().join(" ");
        out.extend(keys.into_iter().map(|key| Measurement { key, value: value.clone(), ..m.clone() }));
    }
    Ok(out)
}

/// Adds a value in place of earlier ones of the same.
pub(super) fn put(values: &mut Vec<Measurement>, m: Measurement) {
    values.retain(|v| !replaces(&m.key, &v.key));
    values.push(m);
}

/// Whether a value of the key `new` leaves nothing to one of the key `old`, which says the same in other words.
fn replaces(new: &str, old: &str) -> bool {
    // Direction, if any, and what of the curve.
    fn tensile(key: &str) -> Option<(&str, &str)> {
        let rest = key.strip_prefix("tensile")?.trim_start_matches('.');
        let direction = DIRECTIONS.into_iter().find(|d| rest.starts_with(d)).unwrap_or("");
        Some((direction, rest[direction.len()..].trim_start_matches('.')))
    }
    let says_the_same = match (new, old) {
        ("bend", "bend.warp" | "bend.weft") | ("shear", "shear.G") | ("shear.G", "shear") => true,
        _ => match (tensile(new), tensile(old)) {
            (Some((to, new)), Some((of, old))) if to.is_empty() || to == of => match new {
                "EMT" | "LT" => matches!(old, "" | "curve") || old == new,
                "" | "curve" => old != "RT",
                _ => old == new,
            },
            _ => false,
        },
    };
    new == old || says_the_same
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_replaces_what_says_the_same_in_other_words() {
        for (new, old) in [
            ("weight", "weight"),
            ("bend", "bend.weft"),
            ("shear", "shear.G"),
            ("tensile.EMT", "tensile.warp.curve"),
            ("tensile.warp.LT", "tensile.warp"),
            ("tensile.weft.curve", "tensile.weft.EMT"),
            ("tensile", "tensile.weft.LT"),
        ] {
            assert!(replaces(new, old), "{new} {old}");
        }
        for (new, old) in [
            ("bend.warp", "bend.weft"),
            ("bend", "bend.two_HB"),
            ("shear", "shear.two_HG"),
            ("tensile.warp.EMT", "tensile.warp.LT"),
            ("tensile.warp.curve", "tensile.weft.curve"),
            ("tensile.warp.curve", "tensile.warp.RT"),
        ] {
            assert!(!replaces(new, old), "{new} {old}");
        }
    }
}
