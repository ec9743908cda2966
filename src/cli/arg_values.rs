//! Values of arguments that several commands take, from their texts.

use std::num::NonZeroUsize;
use std::path::Path;

use clap::ValueEnum;

use crate::input::{LengthUnit, bytes};
use crate::io::garment::alterations_in;
use crate::mannequin::Measures;
use crate::pattern::parse_quantity;
use crate::report::Bands;

/// Bytes of a file of measures or alterations: a page of text. Larger ones are refused before they are read.
const LARGEST_TEXT: u64 = 1 << 20;

/// Metres as a job says them. Rounded to a nanometre, so that 0.1 m is 100 mm.
pub(super) fn in_millimetres(metres: f64) -> f64 {
    (1e9 * metres).round() / 1e6
}

/// A length as garment files write it, where a bare number is millimetres.
pub(super) fn millimetres(text: &str) -> Option<f64> {
    let length = parse_quantity(text).ok().filter(|q| !q.is_percent())?;
    Some(length.unit.map_or(length.number, |unit| 1e3 * unit.factor() * length.number))
}

/// In metres.
pub(super) fn spacing(text: &str) -> Result<f64, String> {
    let positive = millimetres(text).filter(|mm| *mm > 0.0);
    positive
        .map(|mm| 1e-3 * mm)
        .ok_or_else(|| "a positive number of millimetres is expected, such as 10, or 1cm".into())
}

/// A number of threads, jobs or samples.
pub(super) fn at_least_one(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "a whole number from 1 on is expected".into())
}

pub(super) fn weight(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=1000.0).contains(&value) => Ok(value),
        _ => Err("a number from 0 to 1000 is expected, such as 1".into()),
    }
}

pub(super) fn percent(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("a positive number of per cent is expected, such as 10".into()),
    }
}

/// A file's text, or the text itself where it is no name of a file: what has braces, brackets or several lines. A
/// file's text always has more than one line, so that it is known again where a batch hands it on.
fn file_or_text(text: &str) -> Result<String, String> {
    let inline = text.trim_start().starts_with(['{', '[']) || text.contains('\n');
    if inline {
        return Ok(text.to_owned());
    }
    let read = bytes(Path::new(text), LARGEST_TEXT).map_err(|e| e.to_string())?;
    String::from_utf8(read).map(|read| read + "\n").map_err(|_| "it is no UTF-8 text".to_owned())
}

/// Measures of a person.
pub(super) fn measures(text: &str) -> Result<Measures, String> {
    Measures::parse(&file_or_text(text)?, "measures").map_err(|e| e.to_string())
}

/// Alterations as a text.
pub(super) fn alteration(text: &str) -> Result<String, String> {
    let text = file_or_text(text)?;
    alterations_in(&text).map(|_| text).map_err(|refused| refused.to_string())
}

/// Two rising pressures in kPa.
pub(super) fn bands(text: &str) -> Result<Bands, String> {
    let limits: Vec<f64> = text.split(',').filter_map(|limit| limit.trim().parse().ok()).collect();
    let bands = match limits[..] {
        [tight, too_tight] if text.matches(',').count() == 1 => Bands::given(tight, too_tight),
        _ => None,
    };
    bands.ok_or_else(|| "two rising pressures in kPa are expected, such as 2.3,4.7".into())
}

/// `--units`
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum UnitArg {
    /// Millimetres
    Mm,
    /// Centimetres
    Cm,
    /// Decimetres
    Dm,
    /// Metres
    M,
    /// Inches
    In,
}

impl UnitArg {
    /// The same for the library.
    pub(super) fn unit(self) -> LengthUnit {
        match self {
            Self::Mm => LengthUnit::Millimetre,
            Self::Cm => LengthUnit::Centimetre,
            Self::Dm => LengthUnit::Decimetre,
            Self::M => LengthUnit::Metre,
            Self::In => LengthUnit::Inch,
        }
    }

    /// Metres in the unit.
    pub(super) fn metres(self) -> f64 {
        self.unit().metres()
    }
}
