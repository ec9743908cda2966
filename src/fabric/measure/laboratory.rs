//! Sheets of the KES and FAST instruments: one row per parameter, as a laboratory hands them out.

use super::super::sheet::Measurement;
use super::MeasureError;

/// Loads of FAST-1, gf/cm.
const FAST_LOADS: [(&str, f64); 3] = [("E5", 5.0), ("E20", 20.0), ("E100", 100.0)];
/// FAST-1's shear rigidity: G (N/m) = this over the bias extension EB5 (%).
const FAST_SHEAR: f64 = 123.0;
/// FAST-2: B (µN·m) = this · mass (g/m²) · bending length³ (mm³).
const FAST_BENDING: f64 = 9.8e-6;
/// WT (gf·cm/cm²) = this · LT · EMT (%): half of 500 gf/cm, and percent.
const WORK: f64 = 2.5;

/// A sheet: parameters with their values along warp and weft.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    file: String,
    rows: Vec<Row>,
}

#[derive(Clone, Debug)]
struct Row {
    line: usize,
    name: String,
    /// Warp and weft; a parameter without direction has the same twice.
    values: [Option<f64>; 2],
    unit: String,
}

/// Parameters, their unit where the sheet gives none, and the fabric's key; `{}` is the direction.
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
/// Parameters that other values follow from, with their only unit.
const DERIVED: [(&str, &str); 6] =
    [("WT", "gf.cm/cm2"), ("C", "mm"), ("E5", "%"), ("E20", "%"), ("E100", "%"), ("EB5", "%")];
/// Parameters of the instruments that toile has no use for.
const UNUSED: [&str; 8] = ["MMD", "SMD", "LC", "WC", "RC", "TM", "RS", "HE"];

impl Sheet {
    /// Whether a text's first line is that of a sheet.
    pub(super) fn is_one(text: &str) -> bool {
        text.lines().next().is_some_and(|l| fields(l)[0].eq_ignore_ascii_case("parameter"))
    }

    /// Reads `parameter, warp, weft, unit`; the last column may be missing, as may the weft of what has no direction.
    pub(super) fn parse(text: &str, file: &str) -> Result<Self, MeasureError> {
        let mut rows: Vec<Row> = Vec::new();
        for (line, text) in text.lines().enumerate().skip(1) {
            if text.trim().is_empty() || text.trim_start().starts_with('#') {
                continue;
            }
            let fault = |why: String| MeasureError::File { file: file.to_owned(), row: Some(line + 1), why };
            let fields = fields(text);
            let number = |k: usize| match fields.get(k).copied().unwrap_or_default() {
                "" | "-" | "–" => Ok(None),
                text => match text.parse::<f64>() {
                    Ok(v) if v.is_finite() && v > 0.0 => Ok(Some(v)),
                    _ => Err(fault(format!("{}: '{text}' is no number above 0", fields[0]))),
                },
            };
            let values = [number(1)?, number(2)?];
            let name = fields[0].to_owned();
            let known = PARAMETERS.iter().map(|p| p.0).chain(DERIVED.iter().map(|d| d.0)).chain(UNUSED);
            if !known.clone().any(|k| k == name) {
                let known: Vec<&str> = known.collect();
                return Err(fault(format!("unknown parameter '{name}'; known are {}", known.join(", "))));
            }
            if values == [None; 2] {
                return Err(fault(format!("{name} has no value")));
            }
            if rows.iter().any(|r| r.name == name) {
                return Err(fault(format!("{name} stands there twice")));
            }
            let unit = fields.get(3).copied().unwrap_or_default().to_owned();
            let only = DERIVED.iter().find(|d| d.0 == name).map(|d| d.1);
            if let Some(only) = only.filter(|only| !unit.is_empty() && unit != *only) {
                return Err(fault(format!("{name} is read in {only}, not in {unit}")));
            }
            rows.push(Row { line: line + 1, name, values, unit });
        }
        Ok(Self { file: file.to_owned(), rows })
    }

    /// The fabric's values, and what of the sheet was left out.
    pub(super) fn values(&self, source: &str) -> Result<(Vec<Measurement>, Vec<String>), MeasureError> {
        let mut out = Vec::new();
        let mut put = |key: String, value: String| {
            out.push(Measurement { key, value, source: Some(source.to_owned()), uncertainty: None });
        };
        for row in &self.rows {
            let Some((_, default, key)) = PARAMETERS.iter().find(|p| p.0 == row.name) else { continue };
            let unit = if row.unit.is_empty() { default } else { row.unit.as_str() };
            if row.name == "W" && unit.is_empty() {
                return Err(self.fault(row, "W: give its unit, mg/cm2 (KES) or g/m2 (FAST)".to_owned()));
            }
            for (key, value) in row.keyed(key) {
                put(key, format!("{} {unit}", short(value)).trim_end().to_owned());
            }
        }
        for (key, value) in self.derived()? {
            put(key, value);
        }
        let unused = self.rows.iter().filter(|r| UNUSED.contains(&r.name.as_str()));
        let notes = unused.map(|r| format!("{}: {} is not used", self.file, r.name)).collect();
        Ok((out, notes))
    }

    fn derived(&self) -> Result<Vec<(String, String)>, MeasureError> {
        let mut out = Vec::new();
        if let (Some(work), None) = (self.row("WT"), self.row("LT")) {
            let emt = self.row("EMT").or(self.row("EM"));
            let emt = emt.ok_or_else(|| self.fault(work, "WT without LT needs EMT".to_owned()))?;
            for ((direction, w), e) in DIRECTIONS.iter().zip(work.values).zip(emt.values) {
                if let (Some(w), Some(e)) = (w, e) {
                    out.push((format!("tensile.{direction}.LT"), short(w / (WORK * e))));
                }
            }
        }
        if let Some(length) = self.row("C") {
            let mass = self.row("W").and_then(|w| Some((w, w.values[0].or(w.values[1])?)));
            let (w, mass) = mass.ok_or_else(|| self.fault(length, "C needs W, the mass per area".to_owned()))?;
            let mass = if w.unit == "mg/cm2" { 10.0 * mass } else { mass };
            out.extend(
                length
                    .keyed("bend.{}")
                    .into_iter()
                    .map(|(key, c)| (key, format!("{} uN.m", short(FAST_BENDING * mass * c.powi(3))))),
            );
        }
        if let Some(bias) = self.row("EB5") {
            let value = bias.mean();
            out.push(("shear.G".to_owned(), format!("{} N/m", short(FAST_SHEAR / value))));
        }
        for (k, direction) in DIRECTIONS.into_iter().enumerate() {
            let points = FAST_LOADS.iter().filter_map(|(name, load)| Some((self.row(name)?.values[k]?, *load)));
            let points: Vec<String> = points.map(|(strain, load)| format!("{}:{load}", short(strain))).collect();
            if !points.is_empty() {
                out.push((format!("tensile.{direction}.curve"), points.join(" ")));
            }
        }
        Ok(out)
    }

    fn row(&self, name: &str) -> Option<&Row> {
        self.rows.iter().find(|r| r.name == name)
    }

    fn fault(&self, row: &Row, why: String) -> MeasureError {
        MeasureError::File { file: self.file.clone(), row: Some(row.line), why }
    }
}

/// Names of both directions in keys.
pub(super) const DIRECTIONS: [&str; 2] = ["warp", "weft"];

impl Row {
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

fn fields(line: &str) -> Vec<&str> {
    line.split([',', ';', '\t']).map(str::trim).collect()
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
        let (values, notes) = Sheet::parse(text, "kes.csv").expect("sheet").values("ours").expect("values");
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
        let (values, _) = Sheet::parse(text, "fast.csv").expect("sheet").values("ours").expect("values");
        // 9.8e-6 · 150 · 8000 = 11.76 µN·m; 123/3 = 41 N/m.
        assert_eq!(value(&values, "bend.warp"), "11.76 uN.m");
        assert_eq!(value(&values, "shear.G"), "41 N/m");
        assert_eq!(value(&values, "tensile.weft.curve"), "0.8:5 1.7:20 3.5:100");
    }

    #[test]
    fn wrong_rows_are_named() {
        let said = |rows: &str| {
            let sheet = Sheet::parse(&format!("parameter,warp,weft,unit\n{rows}"), "kes.csv");
            sheet.and_then(|s| s.values("")).expect_err(rows).to_string()
        };
        assert!(said("EMMT,1,2").starts_with("kes.csv, row 2: unknown parameter 'EMMT'"));
        assert!(said("B,-1,2").contains("B: '-1' is no number above 0"));
        assert!(said("B,,").contains("B has no value"));
        assert!(said("W,18").contains("mg/cm2 (KES) or g/m2 (FAST)"));
        assert!(said("C,20,18").contains("C needs W"));
        assert!(said("EB5,3,3,mm").contains("EB5 is read in %, not in mm"));
        assert!(said("B,1,1\nB,1,1").contains("row 3: B stands there twice"));
    }
}
