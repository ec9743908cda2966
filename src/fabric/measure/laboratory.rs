//! Sheets of the KES and FAST instruments: one row per parameter, as a laboratory hands them out.

use super::super::columns::{Columns, above_zero, rows};
use super::super::sheet::Measurement;
use super::super::units::{WEIGHT, plain};
use super::MeasureError;

/// Loads of FAST-1, gf/cm.
const FAST_LOADS: [(&str, f64); 3] = [("E5", 5.0), ("E20", 20.0), ("E100", 100.0)];
/// FAST-1's shear rigidity: G (N/m) = this over the bias extension EB5 (%).
const FAST_SHEAR: f64 = 123.0;
/// FAST-2: B (µN·m) = this · mass (g/m²) · bending length³ (mm³).
const FAST_BENDING: f64 = 9.8e-6;
/// WT (gf·cm/cm²) = this · LT · EMT (%): half of 500 gf/cm, and percent.
const WORK: f64 = 2.5;
/// Relative difference of WT from LT and EMT that is allowed, because all three are rounded.
const ROUNDED: f64 = 0.1;
/// Largest resilience, per cent: all the work is given back.
const ALL: f64 = 100.0;

/// A sheet: parameters with their values along warp and weft.
#[derive(Clone, Debug)]
pub(super) struct DataSheet {
    file: String,
    rows: Vec<Parameter>,
}

#[derive(Clone, Debug)]
struct Parameter {
    line: usize,
    name: String,
    /// Warp and weft. A parameter without direction has the same twice.
    values: [Option<f64>; 2],
    unit: String,
    /// Whether a value of 0 was left out.
    has_zero: bool,
}

/// Parameters, their unit where the sheet gives none, and the fabric's key. `{}` is the direction.
const PARAMETERS: [(&str, &str, &str); 14] = [
    ("EMT", "%", "tensile.{}.EMT"),
    ("EM", "%", "tensile.{}.EMT"),
    ("LT", "", "tensile.{}.LT"),
    ("RT", "%", "tensile.{}.RT"),
    ("B", "gf.cm2/cm", "bend.{}"),
    ("2HB", "gf.cm/cm", "bend.two_HB"),
    ("G", "gf/cm.deg", "shear.G"),
    ("2HG", "gf/cm", "shear.two_HG"),
    ("2HG5", "gf/cm", "shear.two_HG5"),
    ("MIU", "", "friction"),
    ("T0", "mm", "thickness"),
    ("T", "mm", "thickness"),
    ("T2", "mm", "thickness"),
    ("W", "", "weight"),
];
/// Parameters from which other values follow, with their only unit and the key of the value.
const DERIVED: [(&str, &str, &str); 6] = [
    ("WT", "gf.cm/cm2", "tensile.{}.LT"),
    ("C", "mm", "bend.{}"),
    ("E5", "%", "tensile.{}.curve"),
    ("E20", "%", "tensile.{}.curve"),
    ("E100", "%", "tensile.{}.curve"),
    ("EB5", "%", "shear.G"),
];
/// Parameters of the instruments that toile has no use for.
const UNUSED: [&str; 14] = ["MMD", "SMD", "LC", "WC", "RC", "TM", "T100", "T2R", "T100R", "ST", "STR", "RS", "HE", "F"];
/// Parameters that are kept and not simulated: no one else looks at their unit.
const KEPT: [&str; 4] = ["RT", "2HB", "2HG", "2HG5"];
/// Columns of a sheet.
const COLUMNS: [&str; 4] = ["parameter", "warp", "weft", "unit"];
/// Grams per square metre in one kg/m².
const GRAMS: f64 = 1e3;

impl DataSheet {
    /// Whether a text's first row is that of a sheet.
    pub(super) fn is_one(text: &str) -> bool {
        rows(text).next().is_some_and(|(_, header)| Columns::new(header).names()[0] == COLUMNS[0])
    }

    /// Reads `parameter, warp, weft, unit`, in any order. The column of the unit may be missing, and so may the weft of
    /// parameters without direction.
    pub(super) fn parse(text: &str, file: &str) -> Result<Self, MeasureError> {
        let fault = |line: usize, why: String| MeasureError::File { file: file.to_owned(), row: Some(line), why };
        let mut lines = rows(text);
        let (first, header) = lines.next().unwrap_or((1, ""));
        let columns = Columns::new(header);
        if let Some(other) = columns.names().iter().find(|n| !COLUMNS.contains(&n.as_str())) {
            let why = format!("column '{other}' is none of {}; leave it out or rename it", COLUMNS.join(", "));
            return Err(fault(first, why));
        }
        let mut places = [None; 4];
        for (place, name) in places.iter_mut().zip(COLUMNS) {
            *place = columns.find(name).map_err(|why| fault(first, why))?;
        }
        let mut rows: Vec<Parameter> = Vec::new();
        for (line, text) in lines {
            let row = Parameter::parse(line, &columns.cut(text).map_err(|why| fault(line, why))?, places);
            let row = row.map_err(|why| fault(line, why))?;
            if rows.iter().any(|r| r.name == row.name) {
                return Err(fault(line, format!("{} stands there twice", row.name)));
            }
            rows.push(row);
        }
        Ok(Self { file: file.to_owned(), rows })
    }

    /// The fabric's values, and the unused parameters of the sheet.
    pub(super) fn values(&self, source: &str) -> Result<(Vec<Measurement>, Vec<String>), MeasureError> {
        let mut out: Vec<Measurement> = Vec::new();
        let unused = self.rows.iter().filter(|r| UNUSED.contains(&r.name.as_str()));
        let mut notes: Vec<String> = unused.map(|r| format!("{}: {} is not used", self.file, r.name)).collect();
        let mut put = |name: &str, key: String, value: String| {
            if out.iter().any(|m| m.key == key) {
                notes.push(format!("{}: {name} is not used; the sheet has {key} already", self.file));
            } else {
                out.push(Measurement { key, value, source: Some(source.to_owned()), uncertainty: None });
            }
        };
        for row in &self.rows {
            let Some((_, default, key)) = PARAMETERS.iter().find(|p| p.0 == row.name) else { continue };
            let unit = if row.unit.is_empty() { default } else { row.unit.as_str() };
            if row.name == "W" && unit.is_empty() {
                return Err(self.fault(row, "W: give its unit, mg/cm2 (KES) or g/m2 (FAST)".to_owned()));
            }
            for (key, value) in row.keyed(key) {
                put(&row.name, key, format!("{} {unit}", short(value)).trim_end().to_owned());
            }
        }
        for (name, key, value) in self.derived()? {
            put(name, key, value);
        }
        notes.extend(self.doubts());
        Ok((out, notes))
    }

    /// Notes on parameters that contradict the others, or that are not used beside them.
    fn doubts(&self) -> Vec<String> {
        let mut out = Vec::new();
        let of = |name: &str, k: usize| self.row(name)?.values[k];
        for (k, direction) in DIRECTIONS.into_iter().enumerate() {
            let emt = of("EMT", k).or(of("EM", k));
            if let (Some(work), Some(lt), Some(emt)) = (of("WT", k), of("LT", k), emt) {
                let follows = WORK * lt * emt;
                if (work - follows).abs() > ROUNDED * follows {
                    out.push(format!(
                        "{}: WT along the {direction} is {}, and by LT and EMT {}; WT is not used",
                        self.file,
                        short(work),
                        short(follows)
                    ));
                }
            }
            let loads: Vec<&str> = FAST_LOADS.iter().map(|l| l.0).filter(|name| of(name, k).is_some()).collect();
            if let (Some(_), Some(last)) = (emt, loads.last()) {
                out.push(format!("{}: EMT along the {direction} is not used; {last} says how it stretches", self.file));
            }
        }
        let nothing = |r: &&Parameter| is_fast_load(&r.name) && r.values.contains(&None) && r.has_zero;
        out.extend(
            self.rows
                .iter()
                .filter(nothing)
                .map(|r| format!("{}: {} of 0 is not used; it is less than can be read", self.file, r.name)),
        );
        out
    }

    /// The line of the parameter that the value of a key is read from or follows from.
    pub(super) fn line_of(&self, key: &str) -> Option<usize> {
        let is_of = |name: &str| {
            let mut said = PARAMETERS.iter().chain(&DERIVED).filter(|p| p.0 == name);
            said.any(|p| p.2 == key || DIRECTIONS.iter().any(|d| p.2.replace("{}", d) == key))
        };
        self.rows.iter().find(|r| is_of(&r.name)).map(|r| r.line)
    }

    /// Its file, as errors call it.
    pub(super) fn file(&self) -> &str {
        &self.file
    }

    /// Refuses a cloth that more load draws out less.
    fn rising(&self, k: usize) -> Result<(), MeasureError> {
        let rows: Vec<(&Parameter, f64)> =
            FAST_LOADS.iter().filter_map(|l| self.row(l.0)).filter_map(|r| Some((r, r.values[k]?))).collect();
        match rows.windows(2).find(|w| w[1].1 <= w[0].1) {
            Some([(before, less), (row, more)]) => Err(self.fault(
                row,
                format!(
                    "{} is {more}, {} {less} along the {}; more load draws cloth out further",
                    row.name, before.name, DIRECTIONS[k]
                ),
            )),
            _ => Ok(()),
        }
    }

    /// Parameters, keys and values of quantities that follow from others.
    fn derived(&self) -> Result<Vec<(&'static str, String, String)>, MeasureError> {
        let mut out = Vec::new();
        if let (Some(work), None) = (self.row("WT"), self.row("LT")) {
            let emt = self.row("EMT").or(self.row("EM"));
            let emt = emt.ok_or_else(|| self.fault(work, "WT without LT needs EMT".to_owned()))?;
            for ((direction, w), e) in DIRECTIONS.iter().zip(work.values).zip(emt.values) {
                if let (Some(w), Some(e)) = (w, e) {
                    out.push(("WT", format!("tensile.{direction}.LT"), short(w / (WORK * e))));
                }
            }
        }
        if let Some(length) = self.row("C") {
            let w = self.row("W").ok_or_else(|| self.fault(length, "C needs W, the mass per area".to_owned()))?;
            let mass = WEIGHT.parse(&format!("{} {}", w.mean(), w.unit)).map(|kg| GRAMS * kg);
            let mass = mass.ok_or_else(|| self.fault(w, format!("W: give it as {}", WEIGHT.expected())))?;
            let rigidity = |c: f64| format!("{} uN.m", short(FAST_BENDING * mass * c.powi(3)));
            out.extend(length.keyed("bend.{}").into_iter().map(|(key, c)| ("C", key, rigidity(c))));
        }
        if let Some(bias) = self.row("EB5") {
            let value = bias.mean();
            out.push(("EB5", "shear.G".to_owned(), format!("{} N/m", short(FAST_SHEAR / value))));
        }
        for (k, direction) in DIRECTIONS.into_iter().enumerate() {
            self.rising(k)?;
            let points = FAST_LOADS.iter().filter_map(|(name, load)| Some((self.row(name)?.values[k]?, *load)));
            let points: Vec<String> = points.map(|(strain, load)| format!("{}:{load}", short(strain))).collect();
            if !points.is_empty() {
                out.push(("E5 to E100", format!("tensile.{direction}.curve"), points.join(" ")));
            }
        }
        Ok(out)
    }

    fn row(&self, name: &str) -> Option<&Parameter> {
        self.rows.iter().find(|r| r.name == name)
    }

    fn fault(&self, row: &Parameter, why: String) -> MeasureError {
        MeasureError::File { file: self.file.clone(), row: Some(row.line), why }
    }
}

fn is_fast_load(name: &str) -> bool {
    FAST_LOADS.iter().any(|l| l.0 == name)
}

/// Names of both directions in keys.
pub(super) const DIRECTIONS: [&str; 2] = ["warp", "weft"];

impl Parameter {
    /// Reads the `fields` of a line. Parameter, warp, weft and unit are at `places`.
    fn parse(line: usize, fields: &[&str], places: [Option<usize>; 4]) -> Result<Self, String> {
        let [name, warp, weft, unit] = places.map(|k| k.and_then(|k| fields.get(k)).copied().unwrap_or_default());
        let unit = if matches!(unit, "-" | "–") { "" } else { unit };
        // At 5 gf/cm most cloths give less than the instrument shows.
        let is_zero = |text: &str| is_fast_load(name) && text.parse() == Ok(0.0);
        let has_zero = is_zero(warp) || is_zero(weft);
        let number = |text: &str| match text {
            "" | "-" | "–" => Ok(None),
            // Those without use may be what they like: cloth that grows in water has a shrinkage below 0.
            text if is_zero(text) || UNUSED.contains(&name) => Ok(None),
            text => above_zero(text).map(Some).map_err(|why| format!("{name}: {why}")),
        };
        let values = [number(warp)?, number(weft)?];
        let known = PARAMETERS.iter().map(|p| p.0).chain(DERIVED.iter().map(|d| d.0)).chain(UNUSED);
        if !known.clone().any(|k| k == name) {
            return Err(format!("unknown parameter '{name}'; known are {}", known.collect::<Vec<_>>().join(", ")));
        }
        if values == [None; 2] && !has_zero && !UNUSED.contains(&name) {
            return Err(format!("{name} has no value"));
        }
        let kept = PARAMETERS.iter().filter(|p| KEPT.contains(&p.0));
        let only = DERIVED.iter().chain(kept).find(|d| d.0 == name).map(|d| d.1);
        if let Some(only) = only.filter(|only| !unit.is_empty() && plain(unit) != *only) {
            return Err(format!("{name} is read in {only}, not in {unit}"));
        }
        if let Some(more) = values.into_iter().flatten().find(|v| name == "RT" && *v > ALL) {
            return Err(format!("RT is {more} %; no more work comes back than was done"));
        }
        Ok(Self { line, name: name.to_owned(), values, unit: unit.to_owned(), has_zero })
    }

    /// Keys and values: one per direction where the key has one, else the mean.
    fn keyed(&self, key: &str) -> Vec<(String, f64)> {
        if !key.contains("{}") {
            return vec![(key.to_owned(), self.mean())];
        }
        let given = DIRECTIONS.iter().zip(self.values);
        given.filter_map(|(d, v)| Some((key.replace("{}", d), v?))).collect()
    }

    fn mean(&self) -> f64 {
        let given: Vec<f64> = self.values.iter().flatten().copied().collect();
        given.iter().sum::<f64>() / given.len() as f64
    }
}

/// A number with six significant digits and no idle zeros.
pub(super) fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let digits = (5 - x.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value<'a>(values: &'a [Measurement], key: &str) -> &'a str {
        &values.iter().find(|m| m.key == key).unwrap_or_else(|| panic!("{key} in {values:?}")).value
    }

    #[test]
    fn a_kes_sheet_becomes_values() {
        let text = "parameter, warp, weft, unit\nEMT, 4.7, 10\nWT, 6.4625, 13.75\nB, .067, .05\nG, .6, .55\n\
                    2HB, .03, .036\nMIU, .18, .2\nT0, .4\nW, 18, , mg/cm2\nSMD, 3, 4\n";
        let (values, notes) = DataSheet::parse(text, "kes.csv").expect("sheet").values("ours").expect("values");
        for (key, expected) in [
            ("tensile.weft.EMT", "10 %"),
            ("tensile.warp.LT", "0.55"),
            ("tensile.weft.LT", "0.55"),
            ("bend.weft", "0.05 gf.cm2/cm"),
            ("bend.two_HB", "0.033 gf.cm/cm"),
            ("shear.G", "0.575 gf/cm.deg"),
            ("friction", "0.19"),
            ("thickness", "0.4 mm"),
            ("weight", "18 mg/cm2"),
        ] {
            assert_eq!(value(&values, key), expected);
        }
        assert_eq!(notes, ["kes.csv: SMD is not used"]);
    }

    #[test]
    fn a_fast_sheet_becomes_values() {
        let text = "parameter,warp,weft,unit\nC,20,18,mm\nE5,.5,.8\nE20,1.1,1.7\nE100,2,3.5\nEB5,3,,%\nW,150,,g/m2\n";
        let (values, _) = DataSheet::parse(text, "fast.csv").expect("sheet").values("ours").expect("values");
        // 9.8e-6 · 150 · 8000 = 11.76 µN·m. 123/3 = 41 N/m.
        assert_eq!(value(&values, "bend.warp"), "11.76 uN.m");
        assert_eq!(value(&values, "shear.G"), "41 N/m");
        assert_eq!(value(&values, "tensile.weft.curve"), "0.8:5 1.7:20 3.5:100");
    }

    #[test]
    fn the_mass_that_bending_follows_from_may_have_any_unit_of_mass() {
        for mass in ["W,150,,g/m2", "W,0.15,,kg/m2", "W,15,,mg/cm²", "W,140,160,g/m2"] {
            let text = format!("parameter,warp,weft,unit\nC,20,18,mm\n{mass}\n");
            let (values, _) = DataSheet::parse(&text, "fast.csv").expect("sheet").values("ours").expect("values");
            assert_eq!(value(&values, "bend.warp"), "11.76 uN.m", "{mass}");
        }
    }

    #[test]
    fn columns_may_come_in_any_order_and_a_second_value_is_told() {
        let text = "# FAST-2\nparameter; weft; warp; unit\nB; 0.067; 0.15;\nC; 20; 18; mm\nW; 150; ; g/m2\n";
        let (values, notes) = DataSheet::parse(text, "a.csv").expect("sheet").values("ours").expect("values");
        assert_eq!(value(&values, "bend.warp"), "0.15 gf.cm2/cm");
        assert_eq!(value(&values, "bend.weft"), "0.067 gf.cm2/cm");
        assert_eq!(notes[0], "a.csv: C is not used; the sheet has bend.warp already");
        let comma =
            DataSheet::parse("parameter;warp;weft;unit\nT0;1,25;;mm\n", "a.csv").expect_err("a comma").to_string();
        assert_eq!(comma, "a.csv, row 2: T0: '1,25' is no number; write a decimal point");
    }

    #[test]
    fn a_whole_fast_sheet_is_read() {
        let text = "parameter,warp,weft,unit\nRS,-0.5,1,%\nF,0.4,0.6,mm2\nSTR,.1,,mm\nE5,0.0,.8,%\nE20,1.1,1.7\n\
                    E100,2,3.5\nEMT,9,9\nC,20,18\nW,150,,g/m2\nMIU,.2,.2,-\n";
        let (values, notes) = DataSheet::parse(text, "fast.csv").expect("sheet").values("ours").expect("values");
        assert_eq!(value(&values, "tensile.warp.curve"), "1.1:20 2:100");
        assert_eq!(value(&values, "friction"), "0.2");
        for told in ["RS is not used", "F is not used", "E5 of 0 is not used", "EMT along the warp is not used; E100"] {
            assert!(notes.iter().any(|n| n.contains(told)), "{told} in {notes:?}");
        }
    }

    #[test]
    fn work_that_does_not_agree_with_linearity_is_told() {
        let notes = |work: &str| {
            let text = format!("parameter,warp,weft\nEMT,4.7,10\nLT,.6,.6\nWT,{work},15\n");
            DataSheet::parse(&text, "kes.csv").expect("sheet").values("ours").expect("values").1
        };
        assert!(notes("7.05").is_empty());
        assert_eq!(notes("40"), ["kes.csv: WT along the warp is 40, and by LT and EMT 7.05; WT is not used"]);
    }

    #[test]
    fn wrong_rows_are_named() {
        let said = |rows: &str| {
            let sheet = DataSheet::parse(&format!("parameter,warp,weft,unit\n{rows}"), "kes.csv");
            sheet.and_then(|s| s.values("")).expect_err(rows).to_string()
        };
        assert!(said("EMMT,1,2").starts_with("kes.csv, row 2: unknown parameter 'EMMT'"));
        assert!(said("B,-1,2").contains("B: '-1' is no number above 0"));
        assert!(said("B,,").contains("B has no value"));
        assert!(said("W,18").contains("mg/cm2 (KES) or g/m2 (FAST)"));
        assert!(said("C,20,18").contains("C needs W"));
        assert!(said("EB5,3,3,mm").contains("EB5 is read in %, not in mm"));
        assert!(said("B,1,1\nB,1,1").contains("row 3: B stands there twice"));
        assert!(said("E5,3,1\nE20,2,2").contains("row 3: E20 is 2, E5 3 along the warp"));
        assert!(said("RT,120,60").contains("row 2: RT is 120 %"));
        assert!(said("2HB,5,5,furlong").contains("2HB is read in gf.cm/cm, not in furlong"));
        assert!(said("C,20,18\nW,150,,stone").contains("W: give it as a number in g/m2"));
    }
}
