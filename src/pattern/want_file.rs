//! How a garment is wanted to fit, and what may be altered for it, as written in a file of wants.

use super::alteration_file::AlterationFile;
use super::diagnostic::Located;

/// Values that are wanted: from the least to the largest. Both are the same where one value is named.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Least. `None` = no matter how little.
    pub from: Option<f64>,
    /// Largest. `None` = no matter how much.
    pub to: Option<f64>,
}

/// A want, of a figure of the report.
#[derive(Clone, Debug, PartialEq)]
pub enum WantFile {
    /// `ease: {bust: 60..90 mm}`: ease at one of [`GIRTHS`](super::GIRTHS), metres.
    Ease(String, Wanted),
    /// `pressure: {waist: below 2.3 kPa}`: largest pressure at a girth, kPa.
    Pressure(String, Wanted),
    /// `hem: {level: 10 mm}`: height of a hem's highest point above its lowest, metres.
    HemLevel(Wanted),
    /// `hem: {above_floor: 560 mm}`: mean height of the hems, metres.
    HemHeight(Wanted),
    /// `sleeve: {ends_at: wrist}`: how far the sleeves reach beyond the wrists, metres.
    SleeveEnd(Wanted),
    /// `leg: {ends_at: ankle}`: how far the legs reach beyond the ankles, metres.
    LegEnd(Wanted),
    /// `strain: below 60 % of limit`: largest share of what its fabric gives that a thread is drawn out by at a girth.
    Strain(Wanted),
}

/// A knob: an alteration, or several together, whose amounts are given as ranges.
#[derive(Clone, Debug, PartialEq)]
pub struct KnobFile {
    /// Its name.
    pub name: Located<String>,
    /// The alterations, each with the first ends of all ranges, and with the last ones. Lengths that are taken out may
    /// be negative, which is to let in.
    pub parts: Vec<[AlterationFile; 2]>,
    /// Both ends of its widest range, metres (of a share of a dart's intake a fraction).
    pub range: [f64; 2],
}

/// A file of wants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WantsFile {
    /// The wants, in order.
    pub wants: Vec<Located<WantFile>>,
    /// The knobs. None are given where the program should find them itself.
    pub knobs: Vec<KnobFile>,
}
