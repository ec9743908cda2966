//! Makes a [`Fabric`] with every value from a fabric's description.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::Path;

use super::error::FabricError;
use super::library::{library, load_in, read};
use super::sheet::{FabricSheet, LiuMeasures, flatten};
use super::units::{BEND, LENGTH, QuantityKind, SHEAR, STRAIN, WEIGHT};
use super::{Fabric, FabricSpec, GRAVITY, TensileCurve};
use crate::input::yaml;

/// Assumed thickness, metres: the middle of the shipped wovens.
const THICKNESS: f64 = 0.3e-3;
/// Assumed shear stiffness, N/m per radian: the middle of the shipped wovens.
const SHEAR_STIFFNESS: f64 = 34.0;
/// Assumed friction coefficient: the middle of the shipped wovens.
const FRICTION: f64 = 0.4;
/// Range of friction coefficients. Rubber on rubber has 1 to 1.5. Larger numbers are percentages or another quantity.
const FRICTIONS: RangeInclusive<f64> = 0.0..=2.0;
/// Assumed extension at 500 gf/cm, as a fraction: the middle of the shipped wovens.
const EMT: f64 = 0.03;
/// Assumed mass per area, kg/m². It is used only for fabrics with nothing but the three published measures, whose shape
/// depends on the ratio of bending to weight and not on the weight.
const AREAL_DENSITY: f64 = 0.15;
/// Assumed linearity of the tensile curve (KES LT): the middle of the shipped wovens.
const LT: f64 = 0.7;

/// Fabrics of a garment that may be based on one another in a row: more is a file that no one wrote.
const LONGEST_CHAIN: usize = 100;

/// Keys a fabric may have.
const KEYS: [&str; 27] = [
    "weight",
    "thickness",
    "bend",
    "bend.warp",
    "bend.weft",
    "bend.two_HB",
    "shear",
    "shear.G",
    "shear.two_HG",
    "shear.two_HG5",
    "tensile",
    "tensile.EMT",
    "tensile.LT",
    "tensile.warp",
    "tensile.warp.EMT",
    "tensile.warp.LT",
    "tensile.warp.RT",
    "tensile.warp.curve",
    "tensile.weft",
    "tensile.weft.EMT",
    "tensile.weft.LT",
    "tensile.weft.RT",
    "tensile.weft.curve",
    "friction",
    "drape",
    "source",
    "name",
];

/// Source of a fabric's description.
#[derive(Clone, Copy, Debug)]
pub struct Context<'a> {
    /// The fabric's name in the garment.
    pub name: &'a str,
    /// Folder of the garment file: fabric and curve files are relative to it.
    pub folder: &'a Path,
    /// All fabrics of the garment, which may serve as a base.
    pub garment: &'a [(String, FabricSpec)],
    /// A fabric of the garment that need not be resolved, and its name there.
    pub given: Option<(&'a str, &'a Fabric)>,
}

/// The fabric of a garment file: its base, if any, with the inline values on top. A plain number multiplies the base's
/// value. For friction, which has no unit, it is the value itself.
///
/// Values that neither gives are assumed and listed in [`Fabric::defaults`]. Weight and bending have no default. As a
/// last resort, a fabric file with the three published measures and no bending has a bending length from its weights
/// ([`LiuMeasures::fallback_bending_length`]).
///
/// # Errors
/// [`FabricError`] for a base that does not exist, leads back to itself or too far, an unknown key, a bad unit, a
/// number out of range, a missing weight or bending value, a curve that does not rise.
pub fn resolve(spec: &FabricSpec, context: &Context) -> Result<Fabric, FabricError> {
    resolve_chain(spec, context, &mut vec![context.name.to_owned()])
}

fn resolve_chain(spec: &FabricSpec, context: &Context, seen: &mut Vec<String>) -> Result<Fabric, FabricError> {
    let base = match &spec.base {
        Some(name) => Some(base_fabric(name, context, seen)?),
        None => None,
    };
    match base {
        Some(fabric) if spec.values.is_empty() => Ok(fabric),
        base => Values::new(spec, context)?.fabric(base.as_ref()),
    }
}

fn base_fabric(name: &str, context: &Context, seen: &mut Vec<String>) -> Result<Fabric, FabricError> {
    if let Some((_, fabric)) = context.given.filter(|given| given.0 == name && name != context.name) {
        return Ok(fabric.clone());
    }
    let sibling = context.garment.iter().find(|g| g.0 == name && g.0 != context.name);
    let Some((name, spec)) = sibling else {
        // A fabric may bear the name of a shipped one and be based on that, but on no other of its own name.
        let own = name == context.name && context.garment.iter().any(|g| g.0 == name);
        if own && !library().contains(&name) && Path::new(name).extension().is_none() {
            return Err(FabricError::Cycle { fabric: name.to_owned() });
        }
        let others: Vec<&str> = context.garment.iter().map(|g| g.0.as_str()).collect();
        return load_in(name, context.folder, &others);
    };
    if seen.contains(name) {
        return Err(FabricError::Cycle { fabric: name.clone() });
    }
    if seen.len() >= LONGEST_CHAIN {
        return Err(FabricError::Deep { fabric: name.clone(), most: LONGEST_CHAIN });
    }
    seen.push(name.clone());
    resolve_chain(spec, &Context { name, ..*context }, seen)
}

/// The fabric of a file's sheet.
pub(super) fn from_sheet(sheet: &FabricSheet, context: &Context) -> Result<Fabric, FabricError> {
    let values = sheet.measurements.iter().map(|m| (m.key.clone(), m.value.clone())).collect();
    let mut fabric = Values { map: values, context, liu: sheet.liu.as_ref() }.known()?.fabric(None)?;
    let mut sources: Vec<&str> = sheet.measurements.iter().filter_map(|m| m.source.as_deref()).collect();
    sources.sort_unstable();
    sources.dedup();
    if !sources.is_empty() {
        fabric.source = sources.join("; ");
    }
    Ok(fabric)
}

/// Flat keys and texts of one fabric.
struct Values<'a> {
    map: BTreeMap<String, String>,
    context: &'a Context<'a>,
    /// Source of bending where it is not measured.
    liu: Option<&'a LiuMeasures>,
}

impl<'a> Values<'a> {
    fn new(spec: &FabricSpec, context: &'a Context<'a>) -> Result<Self, FabricError> {
        let fault = |why: String| FabricError::Syntax { file: format!("fabric '{}'", context.name), why };
        let mut flat = Vec::new();
        for (key, text) in &spec.values {
            let value = if text.trim_start().starts_with('{') {
                yaml(text).map_err(|why| fault(format!("{key}: {why}")))?
            } else {
                serde_yaml::Value::String(text.clone())
            };
            flatten(key, &value, &mut flat).map_err(fault)?;
        }
        Self { map: flat.into_iter().map(|m| (m.key, m.value)).collect(), context, liu: None }.known()
    }

    /// Refuses keys that mean nothing.
    fn known(self) -> Result<Self, FabricError> {
        match self.map.keys().find(|k| !KEYS.contains(&k.as_str())) {
            None => Ok(self),
            Some(key) => {
                Err(FabricError::Key { fabric: self.context.name.to_owned(), key: key.clone(), known: KEYS.join(", ") })
            }
        }
    }

    /// The first of `keys` that is written, with its text.
    fn first<'k>(&self, keys: &[&'k str]) -> Option<(&'k str, &str)> {
        keys.iter().find_map(|k| Some((*k, self.map.get(*k)?.as_str())))
    }

    fn unit_error(&self, key: &str, text: &str, expected: String) -> FabricError {
        let (fabric, key, text) = (self.context.name.to_owned(), key.to_owned(), text.to_owned());
        FabricError::Unit { fabric, key, text, expected }
    }

    /// `value` if it lies within `range`.
    fn checked(
        &self,
        key: &str,
        text: &str,
        value: f64,
        range: &RangeInclusive<f64>,
        unit: &str,
    ) -> Result<f64, FabricError> {
        if range.contains(&value) {
            return Ok(value);
        }
        let plain = |x: f64| if (1e-3..1e5).contains(&x) || x == 0.0 { format!("{x}") } else { format!("{x:e}") };
        let why = format!("it must lie between {} and {} {unit}", plain(*range.start()), plain(*range.end()));
        let why = why.trim_end().to_owned();
        let (fabric, key, text) = (self.context.name.to_owned(), key.to_owned(), text.to_owned());
        Err(FabricError::Range { fabric, key, text, why })
    }

    /// A value with its unit, or a factor on `base`. `None` when none of `keys` is written.
    fn quantity(&self, keys: &[&str], kind: &QuantityKind, base: Option<f64>) -> Result<Option<f64>, FabricError> {
        let Some((key, text)) = self.first(keys) else { return Ok(base) };
        let value = match (kind.parse(text), text.trim().parse::<f64>(), base) {
            (Some(value), _, _) => value,
            (None, Ok(factor), Some(base)) => factor * base,
            _ => return Err(self.unit_error(key, text, self.expected(kind.expected(), base.is_some()))),
        };
        self.checked(key, text, value, &kind.range, kind.si).map(Some)
    }

    fn expected(&self, units: String, has_base: bool) -> String {
        if has_base { format!("{units}, or a factor on the base") } else { units }
    }

    /// A number without unit.
    fn number(&self, keys: &[&str], range: RangeInclusive<f64>) -> Result<Option<f64>, FabricError> {
        let Some((key, text)) = self.first(keys) else { return Ok(None) };
        let value = text.trim().parse::<f64>().map_err(|_| self.unit_error(key, text, "a plain number".to_owned()))?;
        self.checked(key, text, value, &range, "").map(Some)
    }

    fn missing(&self, key: &str, kind: &QuantityKind) -> FabricError {
        let expected = kind.expected().replace("a number in ", "");
        FabricError::Missing { fabric: self.context.name.to_owned(), key: key.to_owned(), expected }
    }

    fn fabric(&self, base: Option<&Fabric>) -> Result<Fabric, FabricError> {
        let mut defaults = Defaults::new(base);
        let weight = self.quantity(&["weight"], &WEIGHT, base.map(|b| b.areal_density))?;
        let thickness = self.quantity(&["thickness"], &LENGTH, base.map(|b| b.thickness))?;
        let shear = self.quantity(&["shear.G", "shear"], &SHEAR, base.map(|b| b.shear))?;
        let friction = self.number(&["friction"], FRICTIONS)?.or(base.map(|b| b.friction));
        let weight = match (weight, self.liu) {
            (None, Some(_)) => Some(defaults.note("weight", AREAL_DENSITY)),
            (weight, _) => weight,
        };
        if self.has("weight") {
            defaults.clear("weight");
        }
        let [bend_warp, bend_weft] = self.bending(base, weight, &mut defaults)?;
        let [warp, weft] = self.tensile(base, &mut defaults)?;
        Ok(Fabric {
            name: self.context.name.to_owned(),
            areal_density: weight.ok_or_else(|| self.missing("weight", &WEIGHT))?,
            thickness: defaults.or("thickness", self.has("thickness"), thickness, THICKNESS),
            bend_warp,
            bend_weft,
            warp,
            weft,
            shear: defaults.or("shear", self.has("shear") || self.has("shear.G"), shear, SHEAR_STIFFNESS),
            friction: defaults.or("friction", self.has("friction"), friction, FRICTION),
            source: self.source(base),
            defaults: defaults.0,
        })
    }

    fn has(&self, key: &str) -> bool {
        self.map.contains_key(key)
    }

    fn source(&self, base: Option<&Fabric>) -> String {
        match (self.map.get("source"), base) {
            (Some(text), _) => text.clone(),
            (None, Some(base)) => format!("{}, changed in the garment file ({})", base.name, base.source),
            (None, None) => "written in the garment file".to_owned(),
        }
    }

    /// Both rigidities. If only one is written it stands for both. If none is, the last resort are the weights of the
    /// published energy with the mass per area.
    fn bending(
        &self,
        base: Option<&Fabric>,
        weight: Option<f64>,
        defaults: &mut Defaults,
    ) -> Result<[f64; 2], FabricError> {
        defaults.written("bend", self.has("bend"), ["warp", "weft"].map(|way| self.has(&format!("bend.{way}"))));
        let warp = self.quantity(&["bend.warp", "bend"], &BEND, base.map(|b| b.bend_warp))?;
        let weft = self.quantity(&["bend.weft", "bend"], &BEND, base.map(|b| b.bend_weft))?;
        match (warp, weft) {
            (Some(warp), Some(weft)) => Ok([warp, weft]),
            (Some(warp), None) => Ok([warp, defaults.note("bend.weft", warp)]),
            (None, Some(weft)) => Ok([defaults.note("bend.warp", weft), weft]),
            (None, None) => match (self.liu, weight) {
                (Some(liu), Some(weight)) => {
                    let rigidity = liu.fallback_bending_length().powi(3) * weight * GRAVITY;
                    if !(rigidity.is_finite() && rigidity > 0.0) {
                        let why = "recovery and bend must both weigh something, or no bending follows; give bend";
                        let (fabric, key, why) =
                            (self.context.name.to_owned(), "liu.weights".to_owned(), why.to_owned());
                        return Err(FabricError::Range { fabric, key, text: format!("{:?}", liu.weights), why });
                    }
                    let within = rigidity.clamp(*BEND.range.start(), *BEND.range.end());
                    Ok([defaults.note("bend", within); 2])
                }
                _ => Err(self.missing("bend", &BEND)),
            },
        }
    }

    /// Both curves. One stands for the other where only one is written.
    fn tensile(&self, base: Option<&Fabric>, defaults: &mut Defaults) -> Result<[TensileCurve; 2], FabricError> {
        let both = ["tensile", "tensile.EMT", "tensile.LT"].iter().any(|key| self.has(key));
        let of = |way: &str| self.map.keys().any(|key| key.starts_with(&format!("tensile.{way}")));
        defaults.written("tensile", both, ["warp", "weft"].map(of));
        let warp =
            self.curve(["tensile.warp", "tensile.warp.EMT", "tensile.warp.LT"], base.map(|b| &b.warp), defaults)?;
        let weft =
            self.curve(["tensile.weft", "tensile.weft.EMT", "tensile.weft.LT"], base.map(|b| &b.weft), defaults)?;
        Ok(match (warp, weft) {
            (Some(warp), Some(weft)) => [warp, weft],
            (Some(warp), None) => [warp.clone(), defaults.note("tensile.weft", warp)],
            (None, Some(weft)) => [defaults.note("tensile.warp", weft.clone()), weft],
            (None, None) => {
                let curve = defaults.note("tensile", TensileCurve::kawabata(EMT, LT));
                [curve.clone(), curve]
            }
        })
    }

    /// Curve of one direction. Its keys are `[file or factor, EMT, LT]`. These keys without direction serve both.
    fn curve(
        &self,
        [whole, emt, lt]: [&str; 3],
        base: Option<&TensileCurve>,
        defaults: &mut Defaults,
    ) -> Result<Option<TensileCurve>, FabricError> {
        let extension = self.quantity(&[emt, "tensile.EMT"], &STRAIN, None)?;
        let linearity = self.number(&[lt, "tensile.LT"], 0.1..=1.5)?;
        let points = format!("{whole}.curve");
        if let Some(text) = self.map.get(&points) {
            if let Some((key, said)) = self.first(&[emt, lt]) {
                let (fabric, key, text) = (self.context.name.to_owned(), key.to_owned(), said.to_owned());
                let why = format!("{points} says how the cloth stretches; leave one of both out");
                return Err(FabricError::Twice { fabric, key, text, why });
            }
            let rows = text.replace(':', ",").split_whitespace().collect::<Vec<_>>().join("\n");
            return TensileCurve::parse(&rows, &format!("{}, {points}", self.context.name)).map(Some);
        }
        match (extension, self.first(&[whole, "tensile"]), linearity) {
            (Some(extension), _, linearity) => {
                let linearity = linearity.unwrap_or_else(|| defaults.note(lt, LT));
                Ok(Some(TensileCurve::kawabata(extension, linearity)))
            }
            (None, Some((key, text)), _) => self.curve_or_factor(key, text, base).map(Some),
            (None, None, Some(_)) => Err(self.missing(emt, &STRAIN)),
            (None, None, None) => Ok(base.cloned()),
        }
    }

    fn curve_or_factor(&self, key: &str, text: &str, base: Option<&TensileCurve>) -> Result<TensileCurve, FabricError> {
        if let (Ok(factor), Some(base)) = (text.trim().parse::<f64>(), base) {
            return Ok(base.scaled(self.checked(key, text, factor, &(1e-6..=1e6), "")?));
        }
        if !text.trim().ends_with(".csv") {
            let expected = "{EMT: 5 %, LT: 0.7} or a .csv file of strain and load".to_owned();
            return Err(self.unit_error(key, text, self.expected(expected, base.is_some())));
        }
        TensileCurve::parse(&read(&self.context.folder.join(text.trim()))?, text.trim())
    }
}

/// Keys whose values are assumed.
struct Defaults(Vec<String>);

impl Defaults {
    fn new(base: Option<&Fabric>) -> Self {
        Self(base.map(|b| b.defaults.clone()).unwrap_or_default())
    }

    /// `value`, noted as assumed.
    fn note<T>(&mut self, key: &str, value: T) -> T {
        if !self.0.iter().any(|k| k == key) {
            self.0.push(key.to_owned());
        }
        value
    }

    /// Forgets that `key` or anything under it was assumed.
    fn clear(&mut self, key: &str) {
        self.0.retain(|k| k != key && !k.starts_with(&format!("{key}.")));
    }

    /// Forgets that `key` was assumed where it is written, for `both` directions or along the warp or the weft: then
    /// the other still is.
    fn written(&mut self, key: &str, both: bool, directions: [bool; 2]) {
        if both {
            return self.clear(key);
        }
        let keys = ["warp", "weft"].map(|way| format!("{key}.{way}"));
        if directions.contains(&true) && self.0.iter().any(|k| k == key) {
            self.clear(key);
            keys.iter().for_each(|key| self.note(key, ()));
        }
        keys.iter().zip(directions).filter(|(_, written)| *written).for_each(|(key, _)| self.clear(key));
    }

    /// `value` or, noted, `fallback`. A value that is written is no longer assumed.
    fn or(&mut self, key: &str, is_written: bool, value: Option<f64>, fallback: f64) -> f64 {
        if is_written {
            self.clear(key);
        }
        value.unwrap_or_else(|| self.note(key, fallback))
    }
}
