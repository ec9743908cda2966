//! Arguments of `batch` and `sample`.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

use super::arg_values::{at_least_one, spacing};
use super::garment_args::OverrideArgs;

/// Arguments of `batch`.
#[derive(Debug, clap::Args)]
pub(super) struct BatchArgs {
    /// A list of jobs, or a folder whose garments are made
    #[arg(value_name = "JOBS.jsonl|FOLDER")]
    pub(super) jobs: PathBuf,
    /// Folder for the results, which may have some already
    #[arg(short, long, value_name = "STORE")]
    pub(super) output: PathBuf,
    /// Jobs that run side by side, each with the --threads given, or else one [default: all processors]
    #[arg(short = 'j', long = "jobs", value_name = "N", value_parser = at_least_one, allow_negative_numbers = true)]
    pub(super) side_by_side: Option<NonZeroUsize>,
    /// Longest time of a job, such as 90, 90s, 10m or 2h; 'none' sets no limit
    #[arg(long, value_name = "TIME", default_value = "1h", value_parser = time_limit, allow_negative_numbers = true)]
    pub(super) time: TimeLimit,
    /// Most memory of a job, such as 512M or 4G (not on Windows) [default: no limit]
    #[arg(long, value_name = "SIZE", value_parser = mebibytes)]
    pub(super) memory: Option<u64>,
    /// Make jobs anew that failed before
    #[arg(long)]
    pub(super) retry: bool,
    /// Make only every Nth job, beginning with the Kth, for arrays of a cluster; its index is index.K-of-N.jsonl
    #[arg(long, value_name = "K/N", value_parser = part)]
    pub(super) part: Option<BatchPart>,
    #[command(flatten)]
    pub(super) overrides: OverrideArgs,
}

/// `--time`
#[derive(Clone, Copy, Debug)]
pub(super) struct TimeLimit(pub(super) Option<Duration>);

/// `--part`
#[derive(Clone, Copy, Debug)]
pub(super) struct BatchPart {
    /// From 1.
    pub(super) number: usize,
    pub(super) of: usize,
}

fn time_limit(text: &str) -> Result<TimeLimit, String> {
    if text == "none" {
        return Ok(TimeLimit(None));
    }
    let units = [("s", 1.0), ("m", 60.0), ("h", 3600.0), ("", 1.0)];
    let parsed = units.iter().find_map(|(unit, seconds)| Some((text.strip_suffix(unit)?, seconds)));
    let number = parsed.and_then(|(number, seconds)| Some(number.parse::<f64>().ok()? * seconds));
    let limit = number.filter(|s| *s > 0.0).and_then(|s| Duration::try_from_secs_f64(s).ok());
    limit.map(|limit| TimeLimit(Some(limit))).ok_or_else(|| "a time is expected, such as 90s, 10m, 2h or none".into())
}

fn mebibytes(text: &str) -> Result<u64, String> {
    let units = [("M", 1), ("G", 1024)];
    let parsed = units.iter().find_map(|(unit, mebibytes)| Some((text.strip_suffix(unit)?, mebibytes)));
    let size = parsed.and_then(|(number, mebibytes)| number.parse::<u64>().ok()?.checked_mul(*mebibytes));
    // What is larger in bytes than a number holds is no limit.
    let some = size.filter(|mebibytes| (1..1 << 40).contains(mebibytes));
    some.ok_or_else(|| "a size is expected, such as 512M or 4G".into())
}

fn part(text: &str) -> Result<BatchPart, String> {
    let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    match numbers {
        Some((number, of)) if (1..=of).contains(&number) => Ok(BatchPart { number, of }),
        _ => Err("a part such as 3/100 is expected: the third of a hundred".into()),
    }
}

/// Arguments of `sample`.
#[derive(Debug, clap::Args)]
pub(super) struct SampleArgs {
    /// A garment file, or a folder of them
    #[arg(value_name = "GARMENT.yaml|FOLDER")]
    pub(super) garments: PathBuf,
    /// Number of jobs
    #[arg(short = 'n', long, value_name = "N", value_parser = at_least_one, allow_negative_numbers = true)]
    pub(super) count: NonZeroUsize,
    /// The same seed draws the same jobs
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(super) seed: u64,
    /// The list to write
    #[arg(short, long, value_name = "JOBS.jsonl")]
    pub(super) output: PathBuf,
    /// Bodies to draw from [default: all mannequins of the library]
    #[arg(long, value_name = "NAME|FILE,…", value_delimiter = ',')]
    pub(super) bodies: Vec<String>,
    /// Fabrics to draw from [default: all of the library]
    #[arg(long, value_name = "NAME|FILE,…", value_delimiter = ',')]
    pub(super) fabrics: Vec<String>,
    /// Sizes to draw from; 'none' is the garment as it is drawn [default: none and all that the garment file has]
    #[arg(long, value_name = "NAME|none,…", value_delimiter = ',')]
    pub(super) sizes: Vec<String>,
    /// A file with measures and alterations in which {from: A, to: B} stands for a number to be drawn
    #[arg(long, value_name = "RANGES.yaml")]
    pub(super) vary: Option<PathBuf>,
    /// Mesh spacing of every job in millimetres [default: what the batch takes]
    #[arg(long, value_name = "MM", value_parser = spacing, allow_negative_numbers = true)]
    pub(super) spacing: Option<f64>,
}
