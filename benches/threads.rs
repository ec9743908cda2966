//! Five garments sewn and draped by 1, 2, 4 … threads, up to the machine's: wall seconds, and the share of one thread's
//! time in passes that are handed out. That share bounds what any number of cores can save, and does not depend on what
//! else the machine does. `cargo bench --bench threads -- NAME` takes garments whose file name holds NAME, and
//! `cargo bench --bench threads -- share` measures one thread only.
//!
//! One run each; compare medians of several, on a quiet machine.

#[allow(dead_code, reason = "nothing here is sampled")]
mod common;

use std::error::Error;
use std::time::Instant;

use toile::geometry::Vec3;
use toile::parallel;
use toile::pipeline::{Job, Run};

/// Files below `patterns`.
const GARMENTS: [&str; 5] =
    ["tshirt.yaml", "trousers.yaml", "child_dress.yaml", "gore_skirt.yaml", "sheath_dress.yaml"];
/// Metres.
const SPACING: f64 = 0.015;

/// One run of sewing and draping.
struct Timed {
    /// Wall-clock time of sewing and of draping, s.
    seconds: [f64; 2],
    /// Of these in passes that were handed out.
    in_passes: [f64; 2],
    /// Where every particle came to rest.
    draped: Vec<Vec3>,
}

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo adds `--bench` to what is asked for.
    let asked: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let (only_share, names): (Vec<String>, Vec<String>) = asked.into_iter().partition(|a| a == "share");
    let most = if only_share.is_empty() { std::thread::available_parallelism()?.get() } else { 1 };
    let threads: Vec<usize> = std::iter::successors(Some(1), |t| Some(2 * t)).take_while(|t| *t <= most).collect();
    let heads: String = threads.iter().map(|t| format!("{t:>9}")).collect();
    println!("{:<20}{:>10}   sew %  drape %  both %   s on threads:{heads}", "garment", "particles");
    for name in GARMENTS {
        if names.is_empty() || names.iter().any(|n| name.contains(n.as_str())) {
            println!("{}", line(name, &threads)?);
        }
    }
    Ok(())
}

/// One garment on each number of threads.
fn line(name: &str, threads: &[usize]) -> Result<String, Box<dyn Error>> {
    let job = common::job(&format!("patterns/{name}"), SPACING)?;
    let mut runs = Vec::new();
    for &threads in threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        runs.push(pool.install(|| timed(&job))?);
    }
    if runs.iter().any(|run| run.draped != runs[0].draped) {
        return Err(format!("{name}: another number of threads gives another garment").into());
    }
    let seconds: String = runs.iter().map(|run| format!("{:>9.2}", run.seconds.iter().sum::<f64>())).collect();
    let Timed { seconds: whole, in_passes, draped } = &runs[0];
    let share = |of: f64, part: f64| format!("{:>8.1}", 100.0 * part / of);
    let (sew, drape) = (share(whole[0], in_passes[0]), share(whole[1], in_passes[1]));
    let both = share(whole.iter().sum(), in_passes.iter().sum());
    Ok(format!("{name:<20}{:>10}{sew}{drape}{both}                {seconds}", draped.len()))
}

fn timed(job: &Job) -> Result<Timed, String> {
    let mut run = Run::new(job);
    let begin = Instant::now();
    let now = || [begin.elapsed(), parallel::in_passes()].map(|time| time.as_secs_f64());
    let from = now();
    run.sew(&mut |_, _| {}).map_err(|error| error.to_string())?;
    let sewn = now();
    run.drape(&mut |_, _| {}).map_err(|error| error.to_string())?;
    let [[seconds_sew, passes_sew], [seconds_drape, passes_drape]] =
        [(from, sewn), (sewn, now())].map(|(a, b)| [b[0] - a[0], b[1] - a[1]]);
    let draped = run.last().unwrap_or_default().to_vec();
    Ok(Timed { seconds: [seconds_sew, seconds_drape], in_passes: [passes_sew, passes_drape], draped })
}
