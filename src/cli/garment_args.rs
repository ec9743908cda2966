//! Arguments of the commands that read a garment file.

use std::path::PathBuf;

use super::arg_values::{UnitArg, alteration, bands, in_millimetres, measures, spacing};
use super::picture_args::PictureArgs;
use crate::batch::BatchJob;
use crate::fitting::{DRAPES, LEAST_DRAPES};
use crate::mannequin::Measures;
use crate::pipeline::{Given, Overrides};
use crate::report::Bands;

/// A garment, and what is wanted other than its file says.
#[derive(Debug, clap::Args)]
pub(super) struct GarmentArgs {
    /// The garment file; several are worn over one another, the innermost first
    #[arg(value_name = "GARMENT.yaml", required = true)]
    pub(super) garments: Vec<PathBuf>,
    /// Folder for the results [default: out/NAME]
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,
    #[command(flatten)]
    pub(super) drawing: PictureArgs,
    /// Print every figure as tables, instead of the verdict in a few lines
    #[arg(long)]
    pub(super) table: bool,
    #[command(flatten)]
    pub(super) overrides: OverrideArgs,
}

/// Spacing, fabric and body.
#[derive(Debug, clap::Args)]
pub(super) struct OverrideArgs {
    /// Distance of neighbouring particles in millimetres [default: 10]
    #[arg(long, value_name = "MM", value_parser = spacing, allow_negative_numbers = true)]
    spacing: Option<f64>,
    /// Fabric in place of the garment's main one, which most of its cloth is cut from; its other fabrics stay
    #[arg(long, value_name = "NAME|FILE.yaml")]
    fabric: Option<String>,
    /// Body in place of the garment's own
    #[arg(long, value_name = "NAME|FILE.obj")]
    body: Option<String>,
    /// Unit of the body's OBJ file [default: what the garment file says, or guessed from its size, and said]
    #[arg(long, value_enum, value_name = "UNIT")]
    body_units: Option<UnitArg>,
    /// Pressures on the skin in kPa from which cloth is tight, and above which it is too tight [default: 2.3,4.7]
    #[arg(long, value_name = "TIGHT,TOO_TIGHT", value_parser = bands)]
    pressure_bands: Option<Bands>,
    /// A size of the garment, as its file names it under `sizes`; or, where a picture is written, its width and height
    /// in pixels, such as 2400x1500
    #[arg(long, value_name = "NAME")]
    pub(super) size: Option<String>,
    /// Measures of the wearer, put on the mannequin before those of the garment file: a file, or such as '{bust: 1040}'
    #[arg(long, value_name = "FILE|{NAME: MM,…}", value_parser = measures)]
    measures: Option<Measures>,
    /// An alteration that follows those of the garment file: a file with `alter:`, or such as '{lengthen: front, at:
    /// 200, by: 20}'; may be given several times
    #[arg(long, value_name = "FILE|{…}", value_parser = alteration)]
    alter: Vec<String>,
}

impl OverrideArgs {
    /// In metres.
    pub(super) fn checked(&self) -> Overrides {
        Overrides {
            spacing: self.spacing,
            fabric: self.fabric.clone(),
            body: self.body.clone(),
            body_unit: self.body_units.map(UnitArg::unit),
            bands: self.pressure_bands.clone(),
            size: self.size.clone(),
            alter: self.alter.clone(),
            measures: self.measures.clone().unwrap_or_default(),
            given: Given::default(),
        }
    }

    /// Options for jobs that say nothing else.
    pub(super) fn job_options(&self) -> BatchJob {
        BatchJob {
            body: self.body.clone(),
            body_units: self.body_units.map(|units| units.unit().symbol().to_owned()),
            fabric: self.fabric.clone(),
            spacing: self.spacing.map(in_millimetres),
            size: self.size.clone(),
            pressure_bands: self.pressure_bands.as_ref().map(|bands| [bands.tight, bands.too_tight]),
            measures: self.measures.as_ref().map(|m| m.named().map(|(name, mm)| (name.into(), mm.into())).collect()),
            alter: self.alter.iter().map(|text| text.as_str().into()).collect(),
            ..BatchJob::options()
        }
    }
}

/// A garment, and a result to begin with.
#[derive(Debug, clap::Args)]
pub(super) struct OnwardArgs {
    #[command(flatten)]
    pub(super) garment: GarmentArgs,
    /// Begin with an earlier result: a folder of `toile make`, `drape` or `sew`, of this garment or of what it was
    /// before its pieces, fabrics, body or spacing were changed; or the garment as sewn at the same spacing, a sewn.obj
    #[arg(long, value_name = "DIR|sewn.obj")]
    pub(super) from: Option<PathBuf>,
}

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
pub(super) struct CheckArgs {
    /// The garment file; several are worn over one another, the innermost first
    #[arg(value_name = "GARMENT.yaml", required_unless_present = "mesh")]
    pub(super) garments: Vec<PathBuf>,
    /// Distance of neighbouring particles in millimetres that the garment will be made with [default: 10]
    #[arg(long, value_name = "MM", value_parser = spacing, allow_negative_numbers = true, conflicts_with = "mesh")]
    pub(super) spacing: Option<f64>,
    /// A size of the garment, as its file names it under `sizes` [default: the garment as drawn, and every size]
    #[arg(long, value_name = "NAME", conflicts_with = "mesh")]
    pub(super) size: Option<String>,
    /// Draw how the garment starts: glued, round the body's axes, each opening's rim in a colour of its own
    #[arg(long, value_name = "FILE.png", conflicts_with = "mesh")]
    pub(super) picture: Option<PathBuf>,
    /// Look for crossings in this surface instead, whoever made it
    #[arg(long, value_name = "FILE.obj", conflicts_with = "garments")]
    pub(super) mesh: Option<PathBuf>,
    /// Body that the surface should lie on: a mannequin, or a closed OBJ in the same place
    #[arg(long, value_name = "NAME|FILE.obj", requires = "mesh")]
    pub(super) body: Option<String>,
    /// Unit of the OBJ files [default: guessed from their sizes, and said]
    #[arg(long, value_enum, requires = "mesh")]
    pub(super) units: Option<UnitArg>,
    /// Unit of the body's OBJ file, where it is another
    #[arg(long, value_enum, value_name = "UNIT", requires = "body")]
    pub(super) body_units: Option<UnitArg>,
}

/// Arguments of `alter`.
#[derive(Debug, clap::Args)]
pub(super) struct AlterArgs {
    /// The garment file; its own alterations are carried out first
    #[arg(value_name = "GARMENT.yaml")]
    pub(super) garment: PathBuf,
    /// A file with `alter:` and a list of alterations
    #[arg(value_name = "CHANGES.yaml")]
    pub(super) changes: PathBuf,
    /// The garment file to write
    #[arg(short, long, value_name = "NEW.yaml")]
    pub(super) output: PathBuf,
}

/// Arguments of `fit`.
#[derive(Debug, clap::Args)]
pub(super) struct FitArgs {
    /// The garment file
    #[arg(value_name = "GARMENT.yaml")]
    pub(super) garment: PathBuf,
    /// Wants, and alterations that may be made [default: the garment's own tests of ease, pressure and hem,
    /// or else that no girth is tight; alterations are found]
    #[arg(long, value_name = "WANTS.yaml")]
    pub(super) want: Option<PathBuf>,
    /// The garment file to write: the old one with alterations added
    #[arg(short, long, value_name = "NEW.yaml")]
    pub(super) output: Option<PathBuf>,
    /// Most drapes
    #[arg(long, value_name = "N", default_value_t = DRAPES, value_parser = drapes)]
    pub(super) drapes: usize,
    #[command(flatten)]
    pub(super) overrides: OverrideArgs,
}

fn drapes(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if count >= LEAST_DRAPES => Ok(count),
        _ => Err(format!("a number of at least {LEAST_DRAPES} is expected")),
    }
}

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
pub(super) struct ReportArgs {
    /// A folder that `toile make` or `toile drape` has written
    #[arg(value_name = "DIR")]
    pub(super) folder: PathBuf,
    /// The body that the garment is on [default: the mannequin that the report names]
    #[arg(long, value_name = "NAME|FILE.obj")]
    pub(super) body: Option<String>,
    /// Unit of the body's OBJ file [default: guessed from its size]
    #[arg(long, value_enum, value_name = "UNIT", requires = "body")]
    pub(super) body_units: Option<UnitArg>,
}

/// Arguments of `test`.
#[derive(Debug, clap::Args)]
pub(super) struct TestArgs {
    /// Garment files, or folders of them
    #[arg(required = true, value_name = "PATH")]
    pub(super) paths: Vec<PathBuf>,
    /// Write the results as JUnit XML, too
    #[arg(long, value_name = "FILE.xml")]
    pub(super) junit: Option<PathBuf>,
    /// Write what was measured, with a margin, into the garment files as their new bounds
    #[arg(long)]
    pub(super) update: bool,
    /// Print every bound with what was measured, instead of a line per garment
    #[arg(long)]
    pub(super) table: bool,
    #[command(flatten)]
    pub(super) overrides: OverrideArgs,
}

/// Arguments of `studio`.
#[derive(Debug, clap::Args)]
pub(super) struct StudioArgs {
    /// The garment file
    #[arg(value_name = "GARMENT.yaml")]
    pub(super) garment: PathBuf,
    /// Port on 127.0.0.1 [default: one that is free]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(super) port: u16,
    /// Do not open a browser
    #[arg(long)]
    pub(super) no_open: bool,
    /// Spacing of the mesh at the beginning, mm: 8, 10, 12, 15, 20 or 25
    #[arg(long, value_name = "MM", default_value_t = 10.0, value_parser = studio_spacing)]
    pub(super) spacing: f64,
    /// Size of the garment at the beginning, as its file names it
    #[arg(long, value_name = "SIZE")]
    pub(super) size: Option<String>,
    /// Make the garment once and write it for a studio on standard output
    #[arg(long, hide = true)]
    pub(super) frames: bool,
    /// A file of the studio with a garment to go on from
    #[arg(long, hide = true, value_name = "FILE")]
    pub(super) earlier: Option<PathBuf>,
}

/// One of the spacings that the page offers.
fn studio_spacing(text: &str) -> Result<f64, String> {
    let known = crate::studio::SPACINGS;
    let found = text.parse().ok().filter(|mm| known.contains(mm));
    found.ok_or_else(|| format!("the studio has {}", known.map(|mm| mm.to_string()).join(", ")))
}
