//! The arguments, as clap reads them: the commands and what is common to all.

use std::num::NonZeroUsize;

use clap::{Parser, Subcommand};

use super::arg_values::at_least_one;
use super::batch_args::{BatchArgs, SampleArgs};
use super::flatten_args::{DraftArgs, FlattenArgs};
use super::garment_args::{AlterArgs, CheckArgs, FitArgs, GarmentArgs, OnwardArgs, ReportArgs, StudioArgs, TestArgs};
use super::import_args::ImportCommand;
use super::library_args::{FabricCommand, MannequinCommand};
use super::paper_args::ExportCommand;

/// Sew flat patterns onto a mannequin, drape them in a measured fabric and lay them flat again.
#[derive(Debug, Parser)]
#[command(
    name = "toile",
    version,
    arg_required_else_help = true,
    after_help = "Exit codes: 0 done and within the garment's bounds; 1 done, out of bounds; 2 the input is wrong; \
                  3 it could not be computed."
)]
pub(super) struct Args {
    #[command(flatten)]
    pub(super) global: Global,
    #[command(subcommand)]
    pub(super) command: Command,
}

/// Options of every command.
#[derive(Debug, clap::Args)]
pub(super) struct Global {
    /// Say nothing but errors
    #[arg(short, long, global = true)]
    pub(super) quiet: bool,
    /// Print the results as JSON on standard output
    #[arg(long, global = true)]
    pub(super) json: bool,
    /// Number of threads (default: all processors), of which 256 at most are started; results do not depend on it
    #[arg(long, global = true, value_name = "N", value_parser = at_least_one, allow_negative_numbers = true)]
    pub(super) threads: Option<NonZeroUsize>,
    /// Serve a batch: end when standard input ends, and take no more than so many MiB of memory (0: no limit)
    #[arg(long, value_name = "MIB", hide = true)]
    pub(super) worker: Option<u64>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Sew, drape and flatten a garment, and write everything
    Make(OnwardArgs),
    /// Read and check a garment file and walk every seam; or look for crossings in a mesh
    Check(CheckArgs),
    /// Print the JSON Schema of garment files, for editors
    Schema,
    /// Sew a garment; writes sewn.obj, garment.png and report.json
    Sew(GarmentArgs),
    /// Sew and drape a garment; writes garment.obj as well
    Drape(OnwardArgs),
    /// Lay any OBJ surface flat, or a garment's draped pieces
    Flatten(FlattenArgs),
    /// Write the page report.html anew from what lies in a folder of results
    Report(ReportArgs),
    /// Show a garment file and its garment live in the browser, and change the file there by clicks
    #[command(
        after_help = "The address of the page is printed on standard output. It holds a token: whoever has it can \
                            change the garment file as long as the program runs. Only this machine can reach the page. \
                            Ctrl-C ends it. docs/studio.md has the rest."
    )]
    Studio(StudioArgs),
    /// Run garments against their own tests
    Test(TestArgs),
    /// Make many garments, each in a process of its own, into a store that can be killed and gone on with
    #[command(after_help = "A list has one JSON object a line, with the options of 'toile make': {\"garment\": \
                            \"skirt.yaml\", \"body\": \"woman_92\", \"fabric\": \"denim\", \"spacing\": 15, \"id\": \
                            \"skirt in denim\"}. Paths are relative to the list.\n\nExit codes: 0 all are done and \
                            within their bounds; 1 all are done, some out of bounds; 2 the list is wrong; 3 some \
                            failed, or the batch could not go on; 130 stopped by Ctrl-C. docs/batch.md has the rest.")]
    Batch(BatchArgs),
    /// Draw jobs for a batch from garments, bodies and fabrics
    Sample(SampleArgs),
    /// Draft a garment from style lines on a body
    #[command(after_help = "A file of lines has 'ease', 'lines' (each a 'girth', a 'height', 'round' or 'through' \
                            points) and 'panels' (a point in each). docs/drafting.md has the rest.\n\n\
                            Exit codes: 0 written; 2 the input is wrong, nothing is written.")]
    Draft(DraftArgs),
    /// Alter a garment's pattern and write it as a new garment file
    #[command(after_help = "Exit codes: 0 written; 1 written, but 'toile check' refuses it, which is said: a seam no \
                            longer matches; 2 the input is wrong or an alteration cannot be done, nothing is written.")]
    Alter(AlterArgs),
    /// Find the alterations that give a garment the fit that is wanted
    #[command(after_help = "A file of wants: 'ease: {bust: 60..90 mm}', 'pressure: {waist: below 2.3 kPa}', \
                            'hem: {above_floor: 560 mm, level: 10 mm}', 'sleeve: {ends_at: wrist}', \
                            'leg: {ends_at: ankle}', 'strain: below 60 % of limit', and 'knobs:' by name, each an \
                            alteration with a range, such as {take_in: side, at: {50 %: -10..30}}. docs/fitting.md \
                            has the rest. Without --spacing particles are 20 mm apart.\n\n\
                            Exit codes: 0 found, or nothing to change; 1 the wants cannot be had, \
                            which is said, and nothing is written; 2 the input is wrong; 3 it could not be computed.")]
    Fit(FitArgs),
    /// Write patterns for cutting: pieces with seam allowance, notches, grain and labels
    #[command(
        subcommand,
        long_about = "Write patterns for cutting: the pieces as the file draws them, with seam allowance, notches, \
                      grain and labels.\n\n\
                      A pair is drawn once, a piece on the fold as its half; --whole draws every piece that is cut. \
                      Allowances are the file's (`allowance:` of an edge, a seam, a piece or the garment). Free edges \
                      are hems, whose allowance ends so that it lies flat when turned up; say `30 mitred` or \
                      `30 squared` in the file for another corner."
    )]
    Export(ExportCommand),
    /// Read a pattern of another program and write it as a garment file
    #[command(
        subcommand,
        after_help = "Exit codes: 0 written, and 'toile check' accepts it as it is; 1 written, but 'toile check' \
                      refuses it as it is, and what is still to be done in it is said; 2 the input is wrong, nothing \
                      is written."
    )]
    Import(ImportCommand),
    /// The library of fabrics, and fabric files from readings
    #[command(subcommand)]
    Fabric(FabricCommand),
    /// The library of mannequins
    #[command(subcommand)]
    Mannequin(MannequinCommand),
}
