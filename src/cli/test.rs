//! `test`: garments against their own bounds.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::console::Console;
use super::exit::{CliError, Exit};
use super::garment_args::TestArgs;
use super::junit;
use super::make::borrowed;
use super::test_outcome::TestOutcome;
use super::update::updated;
use crate::flatten::FlattenOptions;
use crate::input::stem;
use crate::io::files::{check_writable, write_all};
use crate::io::garment::Loaded;
use crate::pattern::{FabricUse, Garment, Piece};
use crate::pipeline::{AT_REST, Job, Overrides, PipelineError, Run, inputs, read, read_variant};
use crate::report::{Report, Restless, Verdict, aligned, restless, verdicts, verdicts_by_test};

/// `toile test`
pub(super) fn test(args: &TestArgs, console: &Console) -> Result<Exit, CliError> {
    let files = garment_files(&args.paths)?;
    let overrides = args.overrides.checked();
    let mut inputs = Vec::new();
    if let Some(junit) = &args.junit {
        inputs.extend(files.iter().flat_map(|file| read_by(file, &overrides)));
        check_writable(std::slice::from_ref(junit), &borrowed(&inputs))?;
    }
    let begin = Instant::now();
    let outcomes: Vec<TestOutcome> = files.par_iter().flat_map_iter(|file| outcomes(file, &overrides)).collect();
    // Garments are made side by side: the sum of their times is not what passed.
    let passed = begin.elapsed();
    let updated = if args.update { update(&outcomes)? } else { Vec::new() };
    if let Some(file) = &args.junit {
        write_all(&[(file.clone(), junit::xml(&outcomes).into_bytes())], &borrowed(&inputs))?;
    }
    console.results(&outcomes, || if args.table { table(&outcomes, passed) } else { lines(&outcomes, passed) })?;
    updated.iter().for_each(|file| console.note(&format!("{}: bounds updated", file.display())));
    let mut exit = Exit::Done;
    for outcome in &outcomes {
        let new = updated.contains(&outcome.path);
        // Lengths and shares have new limits, counts keep theirs.
        let out: Vec<&Verdict> = outcome.bounds.iter().filter(|v| !v.ok && (!new || v.unit.is_empty())).collect();
        complain(outcome, &out, console);
        if !new || !out.is_empty() {
            exit = exit.max(outcome.exit);
        }
    }
    Ok(exit)
}

/// Writes new bounds into the files of garments that were made and came to rest, and says which these are.
fn update(outcomes: &[TestOutcome]) -> Result<Vec<PathBuf>, CliError> {
    let mut written = Vec::new();
    for of_file in outcomes.chunk_by(|a, b| a.path == b.path) {
        let path = &of_file[0].path;
        if of_file.iter().any(|o| o.error.is_some() || !o.restless.is_empty()) {
            continue;
        }
        let text = fs::read_to_string(path);
        let text = text.map_err(|e| CliError::Argument(format!("cannot read {}: {e}", path.display())))?;
        let file = read(path)?.file;
        if file.tests.is_empty() {
            continue;
        }
        let new = updated(&text, &file, &worst(of_file));
        write_all(&[(path.clone(), new.into_bytes())], &[])?;
        written.push(path.clone());
    }
    Ok(written)
}

/// For every test the worst verdicts of a garment's runs.
fn worst(runs: &[TestOutcome]) -> Vec<Vec<Verdict>> {
    let mut worst: Vec<Vec<Verdict>> = runs[0].by_test.clone();
    for run in &runs[1..] {
        for (worst, other) in worst.iter_mut().zip(&run.by_test) {
            if worst.is_empty() {
                worst.clone_from(other);
            }
            for (worst, other) in worst.iter_mut().zip(other) {
                worst.measured = worst.measured.max(other.measured);
            }
        }
    }
    worst
}

/// The files as given, and every garment of the folders, sorted by name.
fn garment_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, CliError> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let unreadable = |e: std::io::Error| CliError::Argument(format!("cannot read {}: {e}", path.display()));
        let entries: Vec<fs::DirEntry> = fs::read_dir(path).and_then(Iterator::collect).map_err(unreadable)?;
        let mut found: Vec<PathBuf> = entries.iter().map(fs::DirEntry::path).filter(|p| is_yaml(p)).collect();
        if found.is_empty() {
            return Err(CliError::Argument(format!("{}: no garment (*.yaml) in this folder", path.display())));
        }
        found.sort();
        files.extend(found);
    }
    Ok(files)
}

fn is_yaml(path: &Path) -> bool {
    path.is_file() && path.extension().is_some_and(|e| e == "yaml" || e == "yml")
}

/// Files that a garment is made from, among them its own, whatever is wrong with it.
fn read_by(file: &Path, overrides: &Overrides) -> Vec<PathBuf> {
    read(file).map_or_else(|_| vec![file.to_owned()], |loaded| inputs(file, &loaded.garment, overrides))
}

/// Makes one garment as its file says, in every size, and once more in every fabric that it has bounds for.
fn outcomes(file: &Path, overrides: &Overrides) -> Vec<TestOutcome> {
    let begin = Instant::now();
    let size = overrides.size.as_deref();
    let loaded = match read_variant(file, overrides.variant()) {
        Ok(loaded) => loaded,
        Err(refused) => return vec![TestOutcome::new(file, size, None, begin, Err(refused))],
    };
    let sizes = loaded.file.sizes.iter().map(|s| s.name.value.clone());
    let of_size = |size| outcomes(file, &Overrides { size: Some(size), ..overrides.clone() });
    let of_sizes: Vec<TestOutcome> = sizes.flat_map(of_size).collect();
    let mut runs = vec![(None, overrides.clone())];
    if overrides.fabric.is_none() {
        let in_fabric =
            |f: &str| (Some(f.to_owned()), Overrides { fabric: Some(beside(file, f)), ..overrides.clone() });
        runs.extend(fabrics_with_bounds(&loaded.garment).into_iter().map(in_fabric));
    }
    let run = |(fabric, overrides): &(Option<String>, Overrides)| {
        let begin = Instant::now();
        TestOutcome::new(file, size, fabric.as_deref(), begin, made(file, loaded.clone(), overrides))
    };
    runs.iter().map(run).chain(of_sizes).collect()
}

/// Fabrics that a garment has bounds for, each once; not those that its pieces are cut from anyway.
fn fabrics_with_bounds(garment: &Garment) -> Vec<&str> {
    let is = |own: &FabricUse, fabric: &str| own.spec.values.is_empty() && own.spec.base.as_deref() == Some(fabric);
    let names = |own: &FabricUse, piece: &Piece| own.name == piece.fabric;
    let used = |fabric: &str| {
        let is_named = |piece: &Piece| garment.fabrics.iter().any(|own| names(own, piece) && is(own, fabric));
        garment.pieces.iter().any(|piece| piece.fabric == fabric || is_named(piece))
    };
    let fabrics = garment.tests.iter().filter_map(|t| t.fabric.as_deref());
    let mut fabrics: Vec<&str> = fabrics.filter(|f| !used(f)).collect();
    fabrics.sort_unstable();
    fabrics.dedup();
    fabrics
}

/// A fabric's file as seen from here, for a garment's file names it from its own folder; a name stays a name.
fn beside(garment: &Path, fabric: &str) -> String {
    match (Path::new(fabric).extension(), garment.parent()) {
        (Some(_), Some(folder)) => folder.join(fabric).display().to_string(),
        _ => fabric.to_owned(),
    }
}

/// The figures of a garment that was made.
struct MadeGarment {
    bounds: Vec<Verdict>,
    by_test: Vec<Vec<Verdict>>,
    restless: Vec<Restless>,
}

impl MadeGarment {
    fn new(garment: &Garment, report: &Report) -> Self {
        Self {
            bounds: verdicts(garment, report),
            by_test: verdicts_by_test(garment, report),
            restless: restless(&report.stages, AT_REST),
        }
    }

    /// Figures of a garment that still moves prove nothing, however good they are.
    fn ok(&self) -> bool {
        self.restless.is_empty() && self.bounds.iter().all(|v| v.ok)
    }
}

/// Makes one garment, in memory.
fn made(file: &Path, loaded: Loaded, overrides: &Overrides) -> Result<MadeGarment, PipelineError> {
    let job = Job::new(file, loaded, overrides)?;
    let mut run = Run::new(&job);
    // Several garments are under way at once; a bar can show one.
    run.flatten(&FlattenOptions::default(), &mut |_, _| {})?;
    Ok(MadeGarment::new(&job.garment, &run.report()))
}

impl TestOutcome {
    /// How the garment of `file` did since `begin`, if need be in another fabric than its own.
    fn new(
        file: &Path,
        size: Option<&str>,
        fabric: Option<&str>,
        begin: Instant,
        made: Result<MadeGarment, PipelineError>,
    ) -> Self {
        let name = |text: String| {
            let sized = size.map_or_else(|| text.clone(), |size| format!("{text} (size {size})"));
            fabric.map_or_else(|| sized.clone(), |fabric| format!("{sized} in {fabric}"))
        };
        let (bounds, by_test, restless, error, exit) = match made {
            Ok(made) => {
                let exit = if made.ok() { Exit::Done } else { Exit::OutOfBounds };
                (made.bounds, made.by_test, made.restless, None, exit)
            }
            Err(e) => {
                let exit = if e.is_input() { Exit::Input } else { Exit::Failed };
                (Vec::new(), Vec::new(), Vec::new(), Some(e.to_string()), exit)
            }
        };
        Self {
            file: name(file.display().to_string()),
            garment: name(stem(file)),
            ok: exit == Exit::Done,
            seconds: begin.elapsed().as_secs_f64(),
            bounds,
            restless,
            error,
            exit,
            path: file.to_owned(),
            by_test,
        }
    }
}

/// A line per garment, and the time that `passed` on the clock.
fn lines(outcomes: &[TestOutcome], passed: Duration) -> String {
    let lines = outcomes.iter().map(|outcome| {
        let broken = outcome.bounds.iter().filter(|verdict| !verdict.ok).count();
        let kept = outcome.bounds.len() - broken;
        let text = match (&outcome.error, outcome.restless.is_empty()) {
            (Some(_), _) => "NOT MADE".to_owned(),
            (None, false) => format!("NOT AT REST; bounds: {kept} kept, {broken} broken"),
            (None, true) if broken > 0 => format!("OUT OF BOUNDS: {kept} kept, {broken} broken"),
            (None, true) => format!("ok, {kept} bounds kept"),
        };
        format!("  {}: {text}\n", outcome.garment)
    });
    lines.collect::<String>() + &tally(outcomes, passed)
}

fn tally(outcomes: &[TestOutcome], passed: Duration) -> String {
    let good = outcomes.iter().filter(|o| o.ok).count();
    let seconds = passed.as_secs_f64();
    format!("  {good} of {} garments within their bounds, {seconds:.1} s\n", outcomes.len())
}

/// The figures, garment by garment, and the time that `passed` on the clock.
fn table(outcomes: &[TestOutcome], passed: Duration) -> String {
    let head = ["garment", "bound", "measured", "limit", "", "at", ""];
    let mut rows = vec![head.map(String::from).to_vec()];
    for outcome in outcomes {
        rows.extend(outcome.bounds.iter().map(|v| row(outcome, v)));
        rows.extend(outcome.restless.iter().map(|r| failed(outcome, format!("{} at rest", r.stage))));
        rows.extend(outcome.error.iter().map(|_| failed(outcome, "made".into())));
    }
    format!("{}\n{}", aligned(&rows), tally(outcomes, passed))
}

fn row(outcome: &TestOutcome, v: &Verdict) -> Vec<String> {
    let digits = if v.unit.is_empty() { 0 } else { 3 };
    vec![
        outcome.garment.clone(),
        v.bound.clone(),
        format!("{:.digits$}", v.measured),
        format!("{}", v.limit),
        v.unit.into(),
        v.at.clone().unwrap_or_default(),
        if v.ok { "ok" } else { "OUT" }.into(),
    ]
}

/// The row of a garment without figures, since it could not be made.
fn failed(outcome: &TestOutcome, what: String) -> Vec<String> {
    let mut row = vec![outcome.garment.clone(), what];
    row.extend(["", "", "", "", "NO"].map(String::from));
    row
}

fn complain(outcome: &TestOutcome, out: &[&Verdict], console: &Console) {
    for verdict in out {
        console.complain(&format!("{}: out of bounds: {verdict}", outcome.file));
    }
    for stage in &outcome.restless {
        console.complain(&format!("{}: {stage}", outcome.file));
    }
    if let Some(error) = &outcome.error {
        console.complain(&format!("{}: not made: {error}", outcome.file));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Drift, Stage};

    /// How a garment did that keeps its bounds, and whose drape came to rest or did not.
    fn outcome(converged: bool) -> TestOutcome {
        let text = include_str!("../../tests/data/skirt.yaml");
        let loaded = crate::io::garment::read_text("skirt", "skirt.yaml", text).map_err(|e| e.to_string());
        let stage = |name: &str, converged| Stage { name: name.into(), converged, ..Stage::default() };
        let (drift, residual) = (Some(Drift { rms: 2.0, max: 9.0 }), Some(18.2));
        let drape = Stage { iterations: 600, drift, residual, ..stage("drape", converged) };
        let report = Report { stages: vec![stage("sew", true), drape, stage("flatten", true)], ..Report::default() };
        let mut made = MadeGarment::new(&loaded.expect("a garment").garment, &report);
        // Nobody wears a report without openings.
        made.bounds.retain(|v| v.bound != "openings not worn");
        TestOutcome::new(Path::new("skirt.yaml"), None, None, Instant::now(), Ok(made))
    }

    #[test]
    fn bounds_in_the_fabric_that_a_garment_is_cut_from_are_no_reason_to_make_it_again() {
        let text = include_str!("../../tests/data/skirt.yaml");
        let text = format!("{text}  - {{drape: all, fabric: denim, area: 1 %}}\n");
        let made_in = |fabrics: &str| {
            let text = text.replace("fabrics: {shell: cotton_poplin}", fabrics);
            let loaded = crate::io::garment::read_text("skirt", "skirt.yaml", &text).expect("a garment");
            fabrics_with_bounds(&loaded.garment).len()
        };
        assert_eq!(made_in("fabrics: {shell: cotton_poplin}"), 1);
        assert_eq!(made_in("fabrics: {shell: denim}"), 0);
        assert_eq!(made_in("fabrics: {shell: {base: denim, weight: 70 g/m2}}"), 1);
    }

    #[test]
    fn a_stage_that_did_not_come_to_rest_fails_the_garment() {
        let still = outcome(true);
        assert!(still.ok && still.exit == Exit::Done && still.bounds.iter().all(|v| v.ok), "{:?}", still.bounds);
        assert!(!table(&[still], Duration::ZERO).contains("at rest"));
        let moving = outcome(false);
        assert!(moving.bounds.iter().all(|v| v.ok) && !moving.ok && moving.exit == Exit::OutOfBounds);
        let xml = junit::xml(std::slice::from_ref(&moving));
        assert!(xml.contains("tests=\"4\" failures=\"1\" errors=\"0\""), "{xml}");
        assert!(
            xml.contains("name=\"drape at rest\"><failure message=\"drape did not come to rest in 600 steps"),
            "{xml}"
        );
        assert!(
            xml.contains("it still drifts by 2.000 mm, at rest by 0.3 or less; it is out of balance by 18.2"),
            "{xml}"
        );
        let all = table(std::slice::from_ref(&moving), Duration::ZERO);
        assert!(all.contains("drape at rest") && all.contains("0 of 1 garments"), "{all}");
        let few = lines(&[moving], Duration::ZERO);
        assert!(few.starts_with("  skirt: NOT AT REST") && few.contains("0 of 1 garments"), "{few}");
    }

    /// Two garments that were made side by side in three seconds each took three seconds.
    #[test]
    fn the_table_ends_with_the_time_on_the_clock() {
        let both = [(); 2].map(|()| TestOutcome { seconds: 3.0, ..outcome(true) });
        let table = table(&both, Duration::from_secs(3));
        assert!(table.ends_with("2 of 2 garments within their bounds, 3.0 s\n"), "{table}");
    }
}
