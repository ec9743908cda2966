//! Arguments of `export`.

use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};

use super::arg_values::millimetres;
use crate::pattern::WIDEST_ALLOWANCE;

/// `toile export …`
#[derive(Debug, Subcommand)]
pub(super) enum ExportCommand {
    /// One drawing in millimetres, to plot, cut with a laser or edit
    Svg {
        #[command(flatten)]
        common: ExportArgs,
        /// Width of the paper in millimetres [default: about as wide as high]
        #[arg(long, value_name = "MM", value_parser = width)]
        width: Option<f64>,
    },
    /// To print at home on pages that are joined, or as one page for a plotter or projector
    Pdf {
        #[command(flatten)]
        common: ExportArgs,
        /// Paper
        #[arg(long, value_enum, ignore_case = true, default_value_t)]
        page: PageArg,
        /// Width of the paper in millimetres, with --page one [default: about as wide as high]
        #[arg(long, value_name = "MM", value_parser = width)]
        width: Option<f64>,
    },
    /// A cutting plan: all pieces on cloth of a given width, and how much of each fabric is needed; SVG and PDF
    Plan(PlanArgs),
    /// DXF-AAMA (ASTM D6673) for cutters and other pattern programs, a block per piece
    Dxf {
        #[command(flatten)]
        common: ExportArgs,
    },
}

/// Arguments of every export.
#[derive(Debug, clap::Args)]
pub(super) struct ExportArgs {
    /// The garment file
    #[arg(value_name = "GARMENT.yaml")]
    pub(super) garment: PathBuf,
    /// A size of the garment, as its file names it under `sizes`, or 'all': over one another, a layer each
    #[arg(long, value_name = "NAME|all")]
    pub(super) size: Option<String>,
    /// The file to write [default: out/NAME/cutting.svg, .pdf or .dxf]
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Seam allowance in millimetres of edges for which the file gives none [default: 10]
    #[arg(long, value_name = "MM", value_parser = allowance, allow_negative_numbers = true)]
    pub(super) allowance: Option<f64>,
    /// Draw every piece as it is cut: folds opened, left and right, every copy
    #[arg(long)]
    pub(super) whole: bool,
    /// For whom the garment is, written on every piece
    #[arg(long = "for", value_name = "NAME")]
    pub(super) wearer: Option<String>,
    /// The date, as it is to be written on every piece
    #[arg(long, value_name = "TEXT")]
    pub(super) date: Option<String>,
}

/// Arguments of `export plan`.
#[derive(Debug, clap::Args)]
pub(super) struct PlanArgs {
    /// The garment files, cut from the same cloth where they name the same
    #[arg(value_name = "GARMENT.yaml", required = true)]
    pub(super) garments: Vec<PathBuf>,
    /// A size of the garments, as their files name it under `sizes`
    #[arg(long, value_name = "NAME")]
    pub(super) size: Option<String>,
    /// The drawing to write, .svg or .pdf [default: both, as out/NAME/plan.svg and plan.pdf]
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Usable width of the cloth in millimetres
    #[arg(long, value_name = "MM", value_parser = width, default_value = "1400")]
    pub(super) width: f64,
    /// The cloth looks another way upside down (pile, a print with an up): all pieces lie the same way up
    #[arg(long)]
    pub(super) nap: bool,
    /// Cut everything from open cloth, not from cloth folded along its length
    #[arg(long)]
    pub(super) open: bool,
    /// Seam allowance in millimetres of edges for which the file gives none [default: 10]
    #[arg(long, value_name = "MM", value_parser = allowance, allow_negative_numbers = true)]
    pub(super) allowance: Option<f64>,
}

/// Narrowest and widest paper, mm: the test square must fit, and no plotter takes more.
const PAPER: (f64, f64) = (150.0, 5000.0);

fn allowance(text: &str) -> Result<f64, String> {
    let widest = 1e3 * WIDEST_ALLOWANCE;
    let some = millimetres(text).filter(|mm| (0.0..=widest).contains(mm));
    some.ok_or_else(|| format!("a number of millimetres from 0 to {widest} is expected, such as 10, or 1cm"))
}

fn width(text: &str) -> Result<f64, String> {
    let (narrowest, widest) = PAPER;
    let some = millimetres(text).filter(|mm| (narrowest..=widest).contains(mm));
    some.ok_or_else(|| format!("a number of millimetres from {narrowest} to {widest} is expected, such as 914"))
}

/// `--page`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum PageArg {
    /// 210 × 297 mm pages to be joined
    #[default]
    A4,
    /// 8.5 × 11 inch pages to be joined
    Letter,
    /// Everything on one page
    One,
}
