//! `export`: patterns for cutting.

use std::path::PathBuf;

use super::console::Console;
use super::drawn::{DrawnGarment, narrowed};
use super::exit::{CliError, Exit};
use super::make::{borrowed, folder};
use super::paper_args::{ExportArgs, ExportCommand, PageArg};
use super::plan::plan;
use crate::cutting::{CuttingOptions, Label, Layout, MarkKind, Paper, SewKind, Sheet, labelled, nested, sewing_order};
use crate::geometry::MM;
use crate::io::dxf_write::cutting_dxf;
use crate::io::files::write_all;
use crate::io::pdf_write::{Page, booklet, one_page, unprintable};
use crate::io::svg_write::cutting_svg;
use crate::pipeline::{Overrides, inputs};
use crate::report::aligned;

/// Empty rim of a sheet that is one page, metres.
const MARGIN: f64 = 0.010;
/// The word for all sizes, and the name of the garment as its file draws it among them.
const ALL_SIZES: &str = "all";
const AS_DRAWN: &str = "base";
/// Most letters that a message lists.
const MOST_LETTERS: usize = 60;

/// `toile export …`
pub(super) fn export(command: &ExportCommand, console: &Console) -> Result<Exit, CliError> {
    match command {
        ExportCommand::Svg { common, width } => {
            let job = ExportJob::new(common, console)?;
            let sheet = Sheet::new(&job.papers, &one_sheet(*width));
            job.write(cutting_svg(&job.title, &sheet).into_bytes(), "svg", console)
        }
        ExportCommand::Pdf { common, page, width } => {
            let job = ExportJob::new(common, console)?;
            job.note_letters(console);
            let pdf = match page {
                PageArg::A4 => booklet(&job.title, &job.papers, &job.steps, Page::A4),
                PageArg::Letter => booklet(&job.title, &job.papers, &job.steps, Page::LETTER),
                PageArg::One => one_page(&job.title, &Sheet::new(&job.papers, &one_sheet(*width))),
            };
            let pdf = pdf.map_err(|e| CliError::Argument(e.to_string()))?;
            job.write(pdf, "pdf", console)
        }
        ExportCommand::Plan(args) => plan(args, console),
        ExportCommand::Dxf { common } => {
            if common.size.as_deref() == Some(ALL_SIZES) {
                return Err(CliError::Argument("a DXF has one size: give --size its name".to_owned()));
            }
            let job = ExportJob::new(common, console)?;
            if job.papers.iter().any(is_told) {
                console.note(
                    "DXF-AAMA has no layers for darts, pleats, folds and elastic: they are inner lines (layer 8), and \
                     texts on them (layer 15) say what they are, which 'toile import dxf' reads and others show",
                );
            }
            job.write(cutting_dxf(&job.title, &job.papers).into_bytes(), "dxf", console)
        }
    }
}

fn one_sheet(width: Option<f64>) -> Layout {
    Layout { width: width.map(|w| w / MM), margin: MARGIN, square: true }
}

/// A garment's papers on their way into a file.
struct ExportJob<'a> {
    args: &'a ExportArgs,
    name: String,
    title: String,
    papers: Vec<Paper>,
    /// The order of sewing, a line per step.
    steps: Vec<String>,
    /// Files that may not be overwritten.
    inputs: Vec<PathBuf>,
}

impl<'a> ExportJob<'a> {
    fn new(args: &'a ExportArgs, console: &Console) -> Result<Self, CliError> {
        let all = args.size.as_deref() == Some(ALL_SIZES);
        let size = args.size.as_deref().filter(|_| !all);
        let drawn = DrawnGarment::read(&args.garment, size, args.allowance, "the file", console)?;
        let papers = if all { all_sizes(args, &drawn, console)? } else { labelled_papers(args, &drawn) };
        let loaded = drawn.loaded;
        papers.iter().flat_map(narrowed).for_each(|note| console.note(&note));
        let inputs = inputs(&args.garment, &loaded.garment, &Overrides::default());
        let steps = sewing_order(&loaded.garment).iter().map(|step| step.words()).collect();
        Ok(Self { args, name: loaded.garment.name, title: loaded.garment.title, papers, steps, inputs })
    }

    /// Says which letters a PDF cannot print.
    fn note_letters(&self, console: &Console) {
        let letters = unprintable(&self.papers, &[&self.steps[..], std::slice::from_ref(&self.title)].concat());
        if !letters.is_empty() {
            let some: String = letters.iter().take(MOST_LETTERS).collect();
            let more = if letters.len() > MOST_LETTERS { " …" } else { "" };
            console.note(&format!(
                "the fonts of the PDF have no glyphs for {some}{more}: they are printed as '?'; an SVG has them"
            ));
        }
    }

    fn write(&self, bytes: Vec<u8>, kind: &str, console: &Console) -> Result<Exit, CliError> {
        let usual = || folder(None, &self.name).join(format!("cutting.{kind}"));
        let target: PathBuf = self.args.output.clone().unwrap_or_else(usual);
        write_all(&[(target.clone(), bytes)], &borrowed(&self.inputs))?;
        let is_piece = |paper: &&Paper| !paper.cut.is_empty();
        let rows: Vec<PaperRow> = self.papers.iter().filter(is_piece).map(PaperRow::new).collect();
        let written = ExportSummary { file: target.display().to_string(), pieces: rows, sewing: self.steps.clone() };
        console.results(&written, || written.text())?;
        Ok(Exit::Done)
    }
}

/// The papers of a garment with their labels.
fn labelled_papers(args: &ExportArgs, drawn: &DrawnGarment) -> Vec<Paper> {
    let title = drawn.loaded.garment.title.clone();
    let label = Label { title, wearer: args.wearer.clone(), date: args.date.clone() };
    labelled(&drawn.drawings, &CuttingOptions { allowance: drawn.allowance, whole: args.whole }, &label)
}

/// The papers of all sizes of a garment over one another. The garment as it is drawn is one of them, unless a size says
/// so.
fn all_sizes(args: &ExportArgs, drawn: &DrawnGarment, console: &Console) -> Result<Vec<Paper>, CliError> {
    let sizes = &drawn.loaded.file.sizes;
    if sizes.is_empty() {
        return Err(CliError::Argument("the garment has no sizes: 'sizes' in its file says them".to_owned()));
    }
    let mut all = Vec::new();
    if sizes.iter().all(|size| !size.alter.is_empty()) {
        all.push((AS_DRAWN.to_owned(), labelled_papers(args, drawn)));
    }
    for size in sizes {
        let name = &size.name.value;
        let one = DrawnGarment::read(&args.garment, Some(name), args.allowance, "the file", console)?;
        all.push((name.clone(), labelled_papers(args, &one)));
    }
    Ok(nested(all))
}

/// Whether a paper has lines that DXF has no layer for.
fn is_told(paper: &Paper) -> bool {
    let is_dart = |kind: SewKind| matches!(kind, SewKind::Dart | SewKind::FishEye);
    paper.marks.iter().any(|m| m.kind != MarkKind::Fold) || paper.sew.iter().any(|line| is_dart(line.of))
}

/// The file that was written, and its pieces. Lengths are mm.
#[derive(serde::Serialize)]
struct ExportSummary {
    file: String,
    pieces: Vec<PaperRow>,
    /// The order of sewing.
    sewing: Vec<String>,
}

#[derive(serde::Serialize)]
struct PaperRow {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    size: Option<String>,
    cut: usize,
    mirrored: bool,
    on_fold: bool,
    fabric: String,
    width: f64,
    height: f64,
}

impl PaperRow {
    fn new(paper: &Paper) -> Self {
        let [low, high] = paper.bounds();
        Self {
            name: paper.name.clone(),
            size: paper.size.as_ref().map(|size| size.name.clone()),
            cut: paper.quantity,
            mirrored: paper.mirrored,
            on_fold: paper.fold.is_some(),
            fabric: paper.fabric.clone(),
            width: (high.x - low.x) * MM,
            height: (high.y - low.y) * MM,
        }
    }
}

impl ExportSummary {
    fn text(&self) -> String {
        let mut rows = vec![["piece", "cut", "mm wide", "mm high", "", "fabric"].map(String::from).to_vec()];
        rows.extend(self.pieces.iter().map(|p| {
            let how = match (p.on_fold, p.mirrored) {
                (true, _) => "on the fold",
                (_, true) => "left and right",
                _ => "",
            };
            let number = |x: f64| format!("{x:.0}");
            let size = p.size.as_ref().map_or_else(String::new, |size| format!(", size {size}"));
            vec![
                format!("{}{size}", p.name),
                p.cut.to_string(),
                number(p.width),
                number(p.height),
                how.into(),
                p.fabric.clone(),
            ]
        }));
        format!("{}\n  written to {}\n", aligned(&rows), self.file)
    }
}
