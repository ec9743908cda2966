//! `export plan`: all pieces on their cloth, and how much of it is needed.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::console::Console;
use super::drawn::{DrawnGarment, narrowed};
use super::exit::{CliError, Exit};
use super::make::{borrowed, folder};
use super::paper_args::PlanArgs;
use crate::cutting::{CuttingOptions, Label, LaidPaper, Paper, Plan, PlanOptions, labelled, plan_sheet, plans};
use crate::geometry::{MM, box_of};
use crate::io::files::{check_writable, write_all};
use crate::io::pdf_write::one_page;
use crate::io::svg_write::cutting_svg;
use crate::pipeline::{Overrides, inputs};
use crate::report::aligned;

/// The result that is printed. Lengths are mm, areas mm².
#[derive(Serialize)]
struct PlanSummary {
    files: Vec<String>,
    plan: Whole,
}

/// All fabrics together.
#[derive(Serialize)]
struct Whole {
    /// Length of all fabrics.
    length: f64,
    /// Share of all cloth that becomes pieces.
    efficiency: f64,
    fabrics: Vec<OfFabric>,
}

/// A fabric.
#[derive(Serialize)]
struct OfFabric {
    fabric: String,
    cloth: Option<String>,
    width: f64,
    length: f64,
    /// Of that folded, and open after it.
    folded: f64,
    open: f64,
    area: f64,
    efficiency: f64,
    pieces: Vec<LaidRow>,
}

/// A paper on the cloth, and the corner of its box that is nearest to the beginning of the cloth and the fold.
#[derive(Serialize)]
struct LaidRow {
    piece: String,
    x: f64,
    y: f64,
    pieces: usize,
    folded: bool,
    turned: bool,
    flipped: bool,
}

/// `toile export plan`
pub(super) fn plan(args: &PlanArgs, console: &Console) -> Result<Exit, CliError> {
    let pieces = PaperPieces::read(args, console)?;
    let targets = targets(args, &pieces.name)?;
    check_writable(&targets, &borrowed(&pieces.inputs))?;
    let options = PlanOptions { width: args.width / MM, nap: args.nap, open: args.open };
    let found = plans(&pieces.drawn, &pieces.whole, &options).map_err(|e| CliError::Argument(e.to_string()))?;
    if !args.open {
        let open = plans(&pieces.drawn, &pieces.whole, &PlanOptions { open: true, ..options });
        open.iter().flatten().zip(&found).filter_map(|(open, own)| saving(own, open)).for_each(|s| console.note(&s));
    }
    let sheet = plan_sheet(&found);
    let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    for target in targets {
        if is(&target, "svg") {
            files.push((target, cutting_svg(&pieces.title, &sheet).into_bytes()));
            continue;
        }
        match one_page(&pieces.title, &sheet) {
            Ok(bytes) => files.push((target, bytes)),
            // The drawing is there, unless the PDF alone was asked for.
            Err(error) if args.output.is_none() => console.note(&format!("no {}: {error}", target.display())),
            Err(error) => return Err(CliError::Argument(error.to_string())),
        }
    }
    write_all(&files, &borrowed(&pieces.inputs))?;
    let written = PlanSummary { files: files.iter().map(|f| f.0.display().to_string()).collect(), plan: whole(&found) };
    console.results(&written, || text(&written))?;
    Ok(Exit::Done)
}

/// Share of its length that open cloth must save to be worth a word.
const WORTH: f64 = 0.05;

/// That a fabric would take less if it were not folded, if it would.
fn saving(folded: &Plan, open: &Plan) -> Option<String> {
    let (own, other) = (folded.length(), open.length());
    let fabric = &folded.fabric;
    (other < (1.0 - WORTH) * own).then(|| {
        format!("'{fabric}': {:.0} mm are enough on open cloth (--open), folded it takes {:.0} mm", mm(other), mm(own))
    })
}

/// The papers of all garments.
struct PaperPieces {
    drawn: Vec<Paper>,
    whole: Vec<Paper>,
    name: String,
    title: String,
    inputs: Vec<PathBuf>,
}

impl PaperPieces {
    fn read(args: &PlanArgs, console: &Console) -> Result<Self, CliError> {
        let mut out = Self { drawn: vec![], whole: vec![], name: String::new(), title: String::new(), inputs: vec![] };
        let (mut names, mut titles) = (Vec::new(), Vec::new());
        for file in &args.garments {
            let shown = file.display().to_string();
            let DrawnGarment { loaded, drawings, allowance } =
                DrawnGarment::read(file, args.size.as_deref(), args.allowance, &shown, console)?;
            let label = Label { title: loaded.garment.title.clone(), wearer: None, date: None };
            // Pieces of several garments may have one name.
            let named = |paper: Paper| match args.garments.len() {
                1 => paper,
                _ => Paper { name: format!("{}/{}", loaded.garment.name, paper.name), ..paper },
            };
            for (whole, papers) in [(false, &mut out.drawn), (true, &mut out.whole)] {
                papers.extend(labelled(&drawings, &CuttingOptions { allowance, whole }, &label).into_iter().map(named));
            }
            out.inputs.extend(inputs(file, &loaded.garment, &Overrides::default()));
            names.push(loaded.garment.name.clone());
            titles.push(loaded.garment.title.clone());
        }
        out.drawn.iter().flat_map(narrowed).for_each(|note| console.note(&note));
        (out.name, out.title) = (names.join("+"), titles.join(", "));
        Ok(out)
    }
}

fn is(file: &Path, kind: &str) -> bool {
    file.extension().is_some_and(|e| e.eq_ignore_ascii_case(kind))
}

fn targets(args: &PlanArgs, name: &str) -> Result<Vec<PathBuf>, CliError> {
    let Some(file) = &args.output else {
        return Ok(["svg", "pdf"].map(|kind| folder(None, name).join(format!("plan.{kind}"))).to_vec());
    };
    if is(file, "svg") || is(file, "pdf") {
        return Ok(vec![file.clone()]);
    }
    let shown = file.display();
    Err(CliError::Argument(format!("-o {shown}: a plan is an SVG or a PDF; end the name with .svg or .pdf")))
}

/// Millimetres to a hundredth.
fn mm(metres: f64) -> f64 {
    (metres * MM * 100.0).round() / 100.0
}

fn whole(plans: &[Plan]) -> Whole {
    let (area, cloth) = plans.iter().fold((0.0, 0.0), |(a, c), p| (a + p.area, c + p.width * p.length()));
    Whole {
        length: mm(plans.iter().map(Plan::length).sum()),
        efficiency: if cloth > 0.0 { area / cloth } else { 0.0 },
        fabrics: plans.iter().map(of_fabric).collect(),
    }
}

fn of_fabric(plan: &Plan) -> OfFabric {
    OfFabric {
        fabric: plan.fabric.clone(),
        cloth: plan.cloth.clone(),
        width: mm(plan.width),
        length: mm(plan.length()),
        folded: mm(plan.folded),
        open: mm(plan.open),
        area: (plan.area * MM * MM).round(),
        efficiency: plan.efficiency(),
        pieces: plan.papers.iter().map(row).collect(),
    }
}

fn row(laid: &LaidPaper) -> LaidRow {
    let [low, _] = box_of(laid.paper.cut.iter().flatten().copied());
    LaidRow {
        piece: laid.paper.name.clone(),
        x: mm(low.x),
        y: mm(low.y),
        pieces: laid.pieces,
        folded: laid.folded,
        turned: laid.turned,
        flipped: laid.flipped,
    }
}

fn text(written: &PlanSummary) -> String {
    let mut rows = vec![["fabric", "width mm", "length mm", "of that folded", "used"].map(String::from).to_vec()];
    rows.extend(written.plan.fabrics.iter().map(|f| {
        let name = f.cloth.as_ref().map_or_else(|| f.fabric.clone(), |cloth| format!("{} ({cloth})", f.fabric));
        let used = format!("{:.1} %", 100.0 * f.efficiency);
        vec![name, format!("{:.0}", f.width), format!("{:.0}", f.length), format!("{:.0}", f.folded), used]
    }));
    let files: String = written.files.iter().map(|file| format!("  written to {file}\n")).collect();
    format!("{}\n{files}", aligned(&rows))
}
