//! The arguments, as clap reads them.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::{Parser, Subcommand, ValueEnum};

use super::batch_args::{BatchArgs, SampleArgs};
use super::picture_args::PictureArgs;
use crate::batch::Job;
use crate::fitting::{DRAPES, LEAST_DRAPES};
use crate::flatten::Mode;
use crate::geometry::Vec3;
use crate::input::{LengthUnit, bytes};
use crate::io::garment::alterations_in;
use crate::mannequin::Measures;
use crate::pattern::{WIDEST_ALLOWANCE, parse_quantity};
use crate::pipeline::{Color, Darts, Ease, Given, Overrides};
use crate::report::Bands;

/// Bytes of a file of measures or alterations: a page of text. Larger ones are refused before they are read.
const LARGEST_TEXT: u64 = 1 << 20;

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
    #[arg(long, global = true, value_name = "N")]
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

/// Arguments of `draft`.
#[derive(Debug, clap::Args)]
pub(super) struct DraftArgs {
    /// A mannequin, or a .yaml or closed .obj file
    #[arg(value_name = "BODY")]
    pub(super) body: String,
    /// The file of style lines
    #[arg(value_name = "LINES.yaml")]
    pub(super) lines: PathBuf,
    /// The garment file to write
    #[arg(short, long, value_name = "GARMENT.yaml")]
    pub(super) output: PathBuf,
    /// Unit of an .obj body
    #[arg(long, value_name = "UNIT")]
    pub(super) body_units: Option<UnitArg>,
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
    pub(super) fn job_options(&self) -> Job {
        Job {
            body: self.body.clone(),
            body_units: self.body_units.map(|units| units.unit().symbol().to_owned()),
            fabric: self.fabric.clone(),
            spacing: self.spacing.map(in_millimetres),
            size: self.size.clone(),
            pressure_bands: self.pressure_bands.as_ref().map(|bands| [bands.tight, bands.too_tight]),
            measures: self.measures.as_ref().map(|m| m.named().map(|(name, mm)| (name.into(), mm.into())).collect()),
            alter: self.alter.iter().map(|text| text.as_str().into()).collect(),
            ..Job::options()
        }
    }
}

/// Metres as a job says them. Rounded to a nanometre, so that 0.1 m is 100 mm.
pub(super) fn in_millimetres(metres: f64) -> f64 {
    (1e9 * metres).round() / 1e6
}

/// A length as garment files write it, where a bare number is millimetres.
fn millimetres(text: &str) -> Option<f64> {
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
fn measures(text: &str) -> Result<Measures, String> {
    Measures::parse(&file_or_text(text)?, "measures").map_err(|e| e.to_string())
}

/// Alterations as a text.
fn alteration(text: &str) -> Result<String, String> {
    let text = file_or_text(text)?;
    alterations_in(&text).map(|_| text).map_err(|refused| refused.to_string())
}

/// Two rising pressures in kPa.
fn bands(text: &str) -> Result<Bands, String> {
    let limits: Vec<f64> = text.split(',').filter_map(|limit| limit.trim().parse().ok()).collect();
    let bands = match limits[..] {
        [tight, too_tight] if text.matches(',').count() == 1 => Bands::given(tight, too_tight),
        _ => None,
    };
    bands.ok_or_else(|| "two rising pressures in kPa are expected, such as 2.3,4.7".into())
}

fn weight(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=1000.0).contains(&value) => Ok(value),
        _ => Err("a number from 0 to 1000 is expected, such as 1".into()),
    }
}

fn percent(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("a positive number of per cent is expected, such as 10".into()),
    }
}

/// An axis, or a direction by its three numbers.
fn direction(text: &str) -> Result<Vec3, String> {
    let axis = match text {
        "x" => Some(Vec3::x()),
        "y" => Some(Vec3::y()),
        "z" => Some(Vec3::z()),
        _ => {
            let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
            numbers.ok().filter(|n| n.len() == 3).map(|n| Vec3::new(n[0], n[1], n[2]))
        }
    };
    axis.filter(|d| d.norm().is_normal())
        .map(|d| d.normalize())
        .ok_or_else(|| "x, y, z or a direction X,Y,Z is expected, such as 0,1,0.5".into())
}

/// How many darts.
fn darts(text: &str) -> Result<Darts, String> {
    match text.parse() {
        _ if text == "auto" => Ok(Darts::Auto),
        Ok(count) if count > 0 => Ok(Darts::Count(count)),
        _ => Err("'auto' or a number of darts is expected, such as 4".into()),
    }
}

/// Ease along the grain and across it, in per cent.
fn ease(text: &str) -> Result<Ease, String> {
    /// Per cent: cloth gives no more than to two and a half times its length.
    const RANGE: std::ops::RangeInclusive<f64> = -60.0..=100.0;
    let number =
        |part: &str| part.trim().trim_end_matches('%').trim().parse::<f64>().ok().filter(|x| RANGE.contains(x));
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    match numbers.as_deref() {
        Some([warp, weft]) => Ok(Ease { warp: warp / 100.0, weft: weft / 100.0 }),
        _ => Err("two percentages from -60 to 100 are expected, along the grain and across it, such as -12,-20".into()),
    }
}

/// How many gores.
fn gores(text: &str) -> Result<usize, String> {
    /// More would be narrower than their allowances.
    const MOST: usize = 200;
    text.parse().ok().filter(|n| (2..=MOST).contains(n)).ok_or_else(|| format!("a number from 2 to {MOST} is expected"))
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

/// Arguments of `flatten`.
#[derive(Debug, clap::Args)]
pub(super) struct FlattenArgs {
    /// A surface, every group or connected part of which is one piece; or a garment file
    #[arg(value_name = "SURFACE.obj|GARMENT.yaml")]
    pub(super) input: PathBuf,
    /// Folder for the results [default: out/NAME]
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,
    /// Property to keep where not all can be kept
    #[arg(long, value_enum, default_value_t)]
    pub(super) mode: ModeArg,
    /// Unit of the OBJ file [default: guessed from its size, and said]
    #[arg(long, value_enum)]
    pub(super) units: Option<UnitArg>,
    /// Direction of the surface that lies along the grain, up on the flat piece: an axis, or X,Y,Z [default: y, or z
    /// where the surface runs along z, which is said]
    #[arg(long, value_name = "x|y|z|X,Y,Z", value_parser = direction, allow_negative_numbers = true)]
    pub(super) up: Option<Vec3>,
    /// Cut along straight lines through these vertices, numbered from 1 as in the file, along the lines drawn in a file
    /// (an OBJ with l elements, or three numbers a line, in the surface's unit), along all sharp edges of a block, or
    /// wherever it is needed; may be given several times, auto then cutting what the others leave (surfaces only)
    #[arg(long, value_name = "auto|sharp|V,V,…|FILE")]
    pub(super) cut: Vec<String>,
    /// Cut darts where the strain passes the limit: N even ones that point at its pole into every round piece, N at
    /// most into all others together, the next always where it is needed most; auto cuts as few as are enough, eight at
    /// most (surfaces only)
    #[arg(long, value_name = "auto|N", value_parser = darts)]
    pub(super) dart: Option<Darts>,
    /// Cut domes and balls into N gores, tubes into N panels (surfaces only)
    #[arg(long, value_name = "N", value_parser = gores)]
    pub(super) gores: Option<usize>,
    /// Cut as many darts as are needed for all but a hundredth of every piece to be strained by no more per cent; says
    /// of each cut how much it brought (surfaces only)
    #[arg(long, value_name = "PERCENT", value_parser = percent, conflicts_with_all = ["dart", "limit", "fabric"])]
    pub(super) max_strain: Option<f64>,
    /// Leave vertices of a fine mesh out, as of a scan, as long as none is further from the rest than so many
    /// millimetres; the largest distance is said (surfaces only)
    #[arg(long, value_name = "MM", value_parser = weight)]
    pub(super) simplify: Option<f64>,
    /// Cut the pieces so many per cent larger than they lie flat along the grain and across it; negative for smaller,
    /// as for swimwear: -12,-20 (surfaces only)
    #[arg(long, value_name = "WARP,WEFT", value_parser = ease, allow_hyphen_values = true)]
    pub(super) ease: Option<Ease>,
    /// Strain in per cent that all but a hundredth of a piece should stay below (surfaces only) [default: 10, or with
    /// --fabric what its threads give]
    #[arg(long, value_name = "PERCENT", value_parser = percent, conflicts_with = "fabric")]
    pub(super) limit: Option<f64>,
    /// How much corners and curves of the rim resist being turned: 1 is usual, 10 turns the worst corner less,
    /// 0 not at all
    #[arg(long, value_name = "WEIGHT", default_value_t = 1.0, value_parser = weight, allow_negative_numbers = true)]
    pub(super) corners: f64,
    /// Leave seams of the texture closed; otherwise the surface is cut along them (surfaces only)
    #[arg(long)]
    pub(super) no_texture_seams: bool,
    /// Lay groups and materials flat together, as one piece wherever they are connected (surfaces only)
    #[arg(long)]
    pub(super) together: bool,
    /// Join all vertices within so many millimetres of each other, none with 0; a dart that is sewn up would be closed
    /// [default: those of different parts, within 0.01; --weld alone: all within 0.01] (surfaces only)
    #[arg(long, value_name = "MM", num_args = 0..=1, default_missing_value = "0.01", value_parser = weight)]
    pub(super) weld: Option<f64>,
    /// Begin with the garment as `toile make` has draped it, at the same spacing, or with that mesh changed in another
    /// program; garment.yaml is the pattern of this form (garment files only)
    #[arg(long, value_name = "garment.obj")]
    pub(super) from: Option<PathBuf>,
    /// With --from: how often the new pattern is sewn and draped, and then corrected. 0 drapes nothing, and the pattern
    /// is the form laid flat, with the strain of its cloth [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=5), requires = "from")]
    pub(super) rounds: Option<u8>,
    /// Print every figure as tables, instead of the verdict in a few lines
    #[arg(long)]
    pub(super) table: bool,
    #[command(flatten)]
    pub(super) overrides: OverrideArgs,
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
    /// A size of the garment, as its file names it under `sizes`
    #[arg(long, value_name = "NAME")]
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

/// `--color`
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub(super) enum ColorArg {
    /// Which piece it is
    #[default]
    Piece,
    /// How far warp and weft are stretched
    Strain,
    /// How far it is from the skin
    Ease,
    /// How hard it presses on the skin
    Pressure,
    /// Which fabric it is
    Fabric,
}

impl From<ColorArg> for Color {
    fn from(color: ColorArg) -> Self {
        match color {
            ColorArg::Piece => Self::Piece,
            ColorArg::Strain => Self::Strain,
            ColorArg::Ease => Self::Ease,
            ColorArg::Pressure => Self::Pressure,
            ColorArg::Fabric => Self::Fabric,
        }
    }
}

/// `--mode`
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub(super) enum ModeArg {
    /// Rim lengths first, then areas; shear gives
    #[default]
    Balanced,
    /// Distances, evenly in the whole piece
    Isometric,
    /// Rim lengths first, then distances
    Boundary,
    /// Rim and threads keep their lengths; the angle between threads gives
    Woven,
    /// The lengths of all mesh edges, as published in 1999
    Spring,
}

impl From<ModeArg> for Mode {
    fn from(mode: ModeArg) -> Self {
        match mode {
            ModeArg::Balanced => Self::Balanced,
            ModeArg::Isometric => Self::Isometric,
            ModeArg::Boundary => Self::Boundary,
            ModeArg::Woven => Self::Woven,
            ModeArg::Spring => Self::Spring,
        }
    }
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
