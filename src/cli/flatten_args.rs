//! Arguments of `flatten` and `draft`, which make patterns of surfaces.

use std::path::PathBuf;

use clap::ValueEnum;

use super::arg_values::{UnitArg, percent, weight};
use super::garment_args::OverrideArgs;
use crate::flatten::Mode;
use crate::geometry::Vec3;
use crate::pipeline::{Darts, Ease};

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
