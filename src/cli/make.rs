//! `make`, `sew` and `drape`: a garment through the stages, or some of them.

use std::path::{Path, PathBuf};

use super::alter::note_written_anew;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::garment_args::{GarmentArgs, OnwardArgs};
use super::picture_args::pixels;
use crate::flatten;
use crate::io::files::{Preview, check_writable, write_all};
use crate::picture::Turning;
use crate::pipeline::{
    FormAsked, GARMENT_GLB, GARMENT_OBJ, GARMENT_PNG, GARMENT_YAML, Glimpse, Job, NewPattern, Overrides, PATTERN_SVG,
    PLACED_OBJ, PictureOptions, PipelineError, REPORT_HTML, REPORT_JSON, ResultFile, ResultProblem, Run, SEWN_OBJ,
    inputs, problems, read_variant,
};
use crate::report::{summary, table};

/// How far a garment is taken, and from where.
pub(super) struct MakePlan<'a> {
    /// Garment files, the innermost first.
    pub(super) garments: &'a [PathBuf],
    pub(super) output: Option<&'a Path>,
    pub(super) overrides: Overrides,
    pub(super) drawing: PictureOptions,
    /// A file for the garment turning round.
    pub(super) turntable: Option<(&'a Path, Turning)>,
    /// Print every figure.
    pub(super) table: bool,
    pub(super) goal: MakeGoal<'a>,
}

/// The last stage, and what to begin with.
#[derive(Clone, Copy)]
pub(super) enum MakeGoal<'a> {
    Sewn,
    Draped {
        from: Option<&'a Path>,
    },
    Made {
        from: Option<&'a Path>,
    },
    Flat {
        from: Option<&'a Path>,
        options: flatten::FlattenOptions,
        /// Drapes of the new pattern.
        rounds: usize,
    },
}

/// The state that a run begins with.
enum StartState<'a> {
    Nothing,
    /// A folder of results, of the garment as it may have been before a change.
    Folder(&'a Path),
    Sewn(&'a Path),
    Draped(&'a Path),
}

impl<'a> MakeGoal<'a> {
    fn start(self) -> StartState<'a> {
        match self {
            MakeGoal::Draped { from: Some(from) } | MakeGoal::Made { from: Some(from) } if from.is_dir() => {
                StartState::Folder(from)
            }
            MakeGoal::Draped { from: Some(from) } | MakeGoal::Made { from: Some(from) } => StartState::Sewn(from),
            MakeGoal::Flat { from: Some(from), .. } => StartState::Draped(from),
            _ => StartState::Nothing,
        }
    }

    /// Names of the files the stages write. Files of an earlier run are not written again.
    fn files(self) -> Vec<&'static str> {
        let mut names = vec![GARMENT_PNG, REPORT_JSON];
        if matches!(self.start(), StartState::Nothing | StartState::Folder(_)) {
            names.push(SEWN_OBJ);
        }
        if !matches!(self, MakeGoal::Sewn) && !matches!(self.start(), StartState::Draped(_)) {
            names.extend([GARMENT_OBJ, GARMENT_GLB, REPORT_HTML]);
        }
        if matches!(self, MakeGoal::Flat { .. } | MakeGoal::Made { .. }) {
            names.push(PATTERN_SVG);
        }
        if matches!(self.start(), StartState::Draped(_)) {
            names.push(GARMENT_YAML);
        }
        names
    }

    /// A run that has nothing yet, or what the earlier one has made.
    fn begin(self, job: &Job) -> Result<Run<'_>, PipelineError> {
        match self.start() {
            StartState::Nothing => Ok(Run::new(job)),
            StartState::Folder(folder) => Run::continued(job, folder),
            StartState::Sewn(file) => Run::from_sewn(job, file),
            StartState::Draped(file) => Run::from_draped(job, file),
        }
    }

    fn reach(self, run: &mut Run, console: &Console) -> Result<(), PipelineError> {
        let bars = console.progress();
        let mut tell = |stage: &str, share: f64| bars.show(stage, share);
        match self {
            MakeGoal::Sewn => run.sew(&mut tell),
            MakeGoal::Draped { .. } => run.drape(&mut tell),
            MakeGoal::Made { .. } => run.flatten(&flatten::FlattenOptions::default(), &mut tell),
            MakeGoal::Flat { options, .. } => run.flatten(&options, &mut tell),
        }
    }
}

/// `toile make`
pub(super) fn make(args: &OnwardArgs, console: &Console) -> Result<Exit, CliError> {
    carry_out(&plan(&args.garment, MakeGoal::Made { from: args.from.as_deref() }), console)
}

/// `toile sew`
pub(super) fn sew(args: &GarmentArgs, console: &Console) -> Result<Exit, CliError> {
    carry_out(&plan(args, MakeGoal::Sewn), console)
}

/// `toile drape`
pub(super) fn drape(args: &OnwardArgs, console: &Console) -> Result<Exit, CliError> {
    carry_out(&plan(&args.garment, MakeGoal::Draped { from: args.from.as_deref() }), console)
}

fn plan<'a>(args: &'a GarmentArgs, goal: MakeGoal<'a>) -> MakePlan<'a> {
    let mut overrides = args.overrides.checked();
    // `--size 1200x800` is the picture's, other words are sizes of the garment.
    let picture = overrides.size.as_deref().and_then(pixels);
    overrides.size = overrides.size.filter(|_| picture.is_none());
    MakePlan {
        garments: &args.garments,
        output: args.output.as_deref(),
        overrides,
        drawing: args.drawing.drawing(picture),
        turntable: args.drawing.turntable.as_ref().map(|(file, format)| (file.as_path(), *format)),
        table: args.table,
        goal,
    }
}

/// Takes a garment to its goal, writes the files and says how it went.
pub(super) fn carry_out(plan: &MakePlan, console: &Console) -> Result<Exit, CliError> {
    let mut worn = Vec::new();
    for file in plan.garments {
        worn.push((file.clone(), read_variant(file, plan.overrides.variant())?));
    }
    let names: Vec<&str> = worn.iter().map(|(_, loaded)| loaded.garment.name.as_str()).collect();
    let folder = folder(plan.output, &names.join("+"));
    let mut inputs: Vec<PathBuf> =
        worn.iter().flat_map(|(file, loaded)| inputs(file, &loaded.garment, &plan.overrides)).collect();
    inputs.extend(match plan.goal.start() {
        // A result may take the place of the one it went on from.
        StartState::Nothing | StartState::Folder(_) => None,
        StartState::Sewn(file) | StartState::Draped(file) => Some(file.to_owned()),
    });
    let mut targets: Vec<PathBuf> = plan.goal.files().iter().map(|name| folder.join(name)).collect();
    targets.extend(plan.turntable.map(|(file, _)| file.to_owned()));
    // Better now than after minutes of sewing.
    check_writable(&targets, &borrowed(&inputs))?;
    let worn_text = worn[0].1.text().to_owned();
    let job = Job::dressed(worn, &plan.overrides)?;
    job.notes.iter().for_each(|note| console.note(note));
    let picture = Preview::new(folder.join(GARMENT_PNG));
    let early = |glimpse: &Glimpse| show_early(&job, glimpse, plan, &picture, &borrowed(&inputs));
    let mut run = plan.goal.begin(&job)?;
    if console.watched() {
        run = run.watched_by(&early);
    }
    if let Err(error) = plan.goal.reach(&mut run, console) {
        if !error.is_input() {
            leave_state(&run, plan, &folder, &inputs, console);
        }
        return Err(error.into());
    }
    let new = new_pattern(plan, &worn_text, &folder, &mut run, console)?;
    let report = run.report();
    let wanted = plan.goal.files();
    let files = run.results(&report, &plan.drawing)?.into_iter().filter(|f| wanted.contains(&f.0)).collect();
    let mut files: Vec<(PathBuf, Vec<u8>)> = in_folder(files, &folder);
    files.extend(new.map(|new| (folder.join(GARMENT_YAML), new.text.into_bytes())));
    if let Some((file, format)) = plan.turntable {
        files.push((file.to_owned(), run.turning(plan.drawing.color, format)?));
    }
    write_all(&files, &borrowed(&inputs))?;
    let problems = problems(&job, &report);
    // A garment that is only sewn has no page.
    let first = folder.join(if wanted.contains(&REPORT_HTML) { REPORT_HTML } else { GARMENT_PNG });
    console.results(&report, || {
        if plan.table {
            return format!("{}\n  written to {}\n", table(&report), folder.display());
        }
        let broken = problems.iter().filter(|problem| problem.out_of_bounds).count();
        summary(&report, broken, &format!("at {} first; --table prints every figure", first.display()))
    })?;
    Ok(judge(&problems, console))
}

/// The pattern that a form asks for, if the run was begun with one.
fn new_pattern(
    plan: &MakePlan,
    text: &str,
    folder: &Path,
    run: &mut Run,
    console: &Console,
) -> Result<Option<NewPattern>, CliError> {
    let MakeGoal::Flat { from: Some(_), options, rounds } = plan.goal else { return Ok(None) };
    let new = folder.join(GARMENT_YAML);
    let asked = FormAsked { text, shown: &new.display().to_string(), overrides: &plan.overrides, rounds, options };
    let bars = console.progress();
    let found = run.pattern_of_form(&asked, &mut |stage, share| bars.show(stage, share))?;
    drop(bars);
    if found.as_ref().is_some_and(|found| !found.in_place) {
        note_written_anew(&new, &plan.garments[0], console);
    }
    Ok(found)
}

/// Shows the picture of a coarser level, which the picture of the garment replaces when that is done. It is written
/// with all other files again: that it cannot be written is told then.
fn show_early(job: &Job, glimpse: &Glimpse, plan: &MakePlan, picture: &Preview, inputs: &[&Path]) {
    if let Ok(png) = job.draw_glimpse(glimpse, &plan.drawing.layout) {
        let _ = picture.show(&png, inputs);
    }
}

/// The folder asked for, or `out/NAME`; a name of dots would lead out of `out`.
pub(super) fn folder(asked: Option<&Path>, name: &str) -> PathBuf {
    let name = if name.chars().all(|c| c == '.') { "garment" } else { name };
    asked.map_or_else(|| Path::new("out").join(name), Path::to_owned)
}

/// Writes files into a folder, all or none.
pub(super) fn write(files: Vec<ResultFile>, folder: &Path, inputs: &[&Path]) -> Result<(), CliError> {
    Ok(write_all(&in_folder(files, folder), inputs)?)
}

fn in_folder(files: Vec<ResultFile>, folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    files.into_iter().map(|(name, bytes)| (folder.join(name), bytes)).collect()
}

pub(super) fn borrowed(paths: &[PathBuf]) -> Vec<&Path> {
    paths.iter().map(PathBuf::as_path).collect()
}

/// Writes what there is of a garment that could not be finished. That it could not is the error to report; if this
/// fails as well, it is only mentioned.
fn leave_state(run: &Run, plan: &MakePlan, folder: &Path, inputs: &[PathBuf], console: &Console) {
    let Ok(files) = run.state(&plan.drawing) else { return };
    let wanted = [plan.goal.files(), vec![PLACED_OBJ]].concat();
    let files: Vec<ResultFile> = files.into_iter().filter(|f| wanted.contains(&f.0)).collect();
    if files.is_empty() {
        return;
    }
    // By name: the folder may hold the files of an earlier run.
    let names: Vec<String> = files.iter().map(|f| folder.join(f.0).display().to_string()).collect();
    match write(files, folder, &borrowed(inputs)) {
        Ok(()) => console.note(&format!("the last state is in {}", names.join(" and "))),
        Err(error) => console.note(&format!("the last state is lost: {error}")),
    }
}

/// Says what is wrong: broken bounds in any case, the rest unless all should be quiet.
fn judge(problems: &[ResultProblem], console: &Console) -> Exit {
    let mut exit = Exit::Done;
    for ResultProblem { text, out_of_bounds } in problems {
        if *out_of_bounds {
            console.complain(text);
            exit = Exit::OutOfBounds;
        } else {
            console.note(text);
        }
    }
    exit
}
