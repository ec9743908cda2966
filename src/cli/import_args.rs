//! Arguments of `import`.

use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};

use super::arg_values::UnitArg;
use crate::input::LengthUnit;

/// `toile import …`
#[derive(Debug, Subcommand)]
pub(super) enum ImportCommand {
    /// GarmentCode's pattern specification (JSON)
    Garmentcode(GarmentcodeArgs),
    /// A drawing, as Inkscape, FreeSewing and Seamly2D write them: pieces with named edges; seams are suggested
    #[command(after_help = "What a drawing may say, and how (names, edges, grain, notches, darts, the fold, 'cut 2', \
                            units): docs/importing.md.")]
    Svg {
        #[command(flatten)]
        common: DrawingArgs,
        /// Length of the drawing's unit in place of what it says [default: what it says, else 96 to the inch, or 72 or
        /// 90 where the program that wrote it is known to mean that]
        #[arg(long, value_enum)]
        units: Option<SvgUnitArg>,
    },
    /// DXF-AAMA (ASTM D6673), as pattern programs and cutters exchange it; seams are suggested
    Dxf {
        #[command(flatten)]
        common: DrawingArgs,
        /// Unit of the drawing in place of what the file says [default: what it says, else in or mm by $MEASUREMENT]
        #[arg(long, value_enum)]
        units: Option<UnitArg>,
    },
}

/// Arguments of the imports of drawings.
#[derive(Debug, clap::Args)]
pub(super) struct DrawingArgs {
    /// The drawing
    #[arg(value_name = "DRAWING")]
    pub(super) drawing: PathBuf,
    #[command(flatten)]
    pub(super) target: TargetArgs,
    /// The size to read of a drawing in several, or 'all': a file each, named after it [default: a graded file's sample
    /// size]
    #[arg(long, value_name = "SIZE|all")]
    pub(super) size: Option<String>,
    /// Write the seams that are offered as seams, instead of as remarks
    #[arg(long)]
    pub(super) seams: bool,
}

/// Where an import is written.
#[derive(Debug, clap::Args)]
pub(super) struct TargetArgs {
    /// The garment file to write
    #[arg(short, long, value_name = "GARMENT.yaml")]
    pub(super) output: PathBuf,
    /// Write over a garment file that is there already
    #[arg(long)]
    pub(super) force: bool,
}

/// Arguments of `import garmentcode`.
#[derive(Debug, clap::Args)]
pub(super) struct GarmentcodeArgs {
    /// The specification
    #[arg(value_name = "SPEC.json")]
    pub(super) spec: PathBuf,
    #[command(flatten)]
    pub(super) target: TargetArgs,
    /// The body it is made for, named in the garment file
    #[arg(long, value_name = "NAME|FILE.obj")]
    pub(super) body: Option<String>,
}

/// Units of an SVG drawing.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum SvgUnitArg {
    /// Millimetres
    Mm,
    /// Centimetres
    Cm,
    /// Inches
    In,
    /// Points, 72 to the inch
    Pt,
    /// Pixels, 96 to the inch
    Px,
}

impl SvgUnitArg {
    /// Metres in the unit.
    pub(super) fn metres(self) -> f64 {
        let inch = LengthUnit::Inch.metres();
        match self {
            Self::Mm => LengthUnit::Millimetre.metres(),
            Self::Cm => LengthUnit::Centimetre.metres(),
            Self::In => inch,
            Self::Pt => inch / 72.0,
            Self::Px => inch / 96.0,
        }
    }
}
