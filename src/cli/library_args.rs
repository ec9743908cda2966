//! Arguments of `fabric` and `mannequin`.

use std::path::PathBuf;

use clap::Subcommand;

/// `toile fabric …`
#[derive(Debug, Subcommand)]
pub(super) enum FabricCommand {
    /// List the fabrics
    List,
    /// Show a fabric's values and where they come from
    Show {
        /// Library name or file
        #[arg(value_name = "NAME|FILE.yaml")]
        name: String,
    },
    /// Hang, bend, pull, shear and drape virtual specimens of a fabric and compare them with known answers
    Test {
        /// Library name or file
        #[arg(value_name = "NAME|FILE.yaml")]
        name: String,
        /// Only this test; may be given several times
        #[arg(long = "only", value_name = "TEST", value_parser = crate::specimen::TESTS.map(|t| t.name))]
        only: Vec<String>,
        /// Where to draw the shadow of the draped disc
        #[arg(short, long, value_name = "SHADOW.png")]
        output: Option<PathBuf>,
    },
    /// Make a fabric file from readings of the three tests, photographs, or KES and FAST sheets
    Measure {
        /// Readings, or a sheet
        #[arg(value_name = "READINGS.yaml|.csv")]
        readings: PathBuf,
        /// The file to write
        #[arg(short, long, value_name = "FABRIC.yaml")]
        output: PathBuf,
    },
}

/// `toile mannequin …`
#[derive(Debug, Subcommand)]
pub(super) enum MannequinCommand {
    /// List the mannequins
    List,
    /// Show the girths a mannequin is built from, and at what heights
    Show {
        /// Library name or file
        #[arg(value_name = "NAME|FILE.yaml")]
        name: String,
    },
    /// Build a mannequin and write its surface: millimetres, y up, feet at y = 0
    Build {
        /// Library name or file
        #[arg(value_name = "NAME|FILE.yaml")]
        name: String,
        /// Measures of a person to put on it, YAML or JSON: our names, FreeSewing's, or a body file of GarmentCode
        #[arg(long, value_name = "FILE")]
        measures: Option<PathBuf>,
        /// The file to write
        #[arg(short, long, value_name = "FILE.obj")]
        output: PathBuf,
    },
}
