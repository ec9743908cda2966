//! `check`: is this garment file right, and what does it make?

use std::path::Path;

use serde::Serialize;

use super::check_mesh::check_mesh;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::garment_args::CheckArgs;
use super::make::borrowed;
use crate::geometry::MM;
use crate::io::files::{check_writable, write_all};
use crate::io::garment::{Refused, Variant};
use crate::pattern::{Diagnostic, Garment, Give, SeamWalk, Severity, openings, outfit, walk};
use crate::pipeline::{self, Checked, PipelineError, StartPicture, StartShown, start_picture};
use crate::report::aligned;

/// `toile check`
pub(super) fn check(args: &CheckArgs, console: &Console) -> Result<Exit, CliError> {
    match &args.mesh {
        Some(mesh) => check_mesh(mesh, args, console),
        None => check_garments(args, console),
    }
}

/// Each for itself, and then as what they are together.
fn check_garments(args: &CheckArgs, console: &Console) -> Result<Exit, CliError> {
    let inputs = borrowed(&args.garments);
    if let Some(picture) = &args.picture {
        check_picture(picture, &inputs)?;
    }
    let mut worn = Vec::new();
    for file in &args.garments {
        let checked = match check_sizes(file, args) {
            Err(refused) if console.json() => {
                let rows = refused.diagnostics.iter().map(DiagnosticRow::new).collect();
                let refusal = CheckFindings { file: file.display().to_string(), ok: false, diagnostics: rows };
                console.results(&refusal, String::new)?;
                return Ok(Exit::Input);
            }
            other => other.map_err(PipelineError::from)?,
        };
        checked.loaded.warnings.iter().for_each(|warning| console.note(&warning.to_string()));
        worn.push(checked);
    }
    let garment = outfit(worn.iter().map(|w| w.loaded.garment.clone()).collect());
    let warnings: Vec<Diagnostic> = worn.iter().flat_map(|w| w.loaded.warnings.clone()).collect();
    let mut summary = CheckSummary::new(&garment, &warnings);
    if let Some(picture) = &args.picture {
        let StartPicture { png, shown, .. } = start_picture(&worn)?;
        write_all(&[(picture.clone(), png)], &inputs)?;
        summary.start = Some(StartRow { picture: picture.display().to_string(), shown });
    }
    console.results(&summary, || summary.text())?;
    Ok(Exit::Done)
}

/// The garment as asked for. Where no size is, every size is checked as well.
fn check_sizes(file: &Path, args: &CheckArgs) -> Result<Checked, Refused> {
    let checked = pipeline::check_variant(file, Variant::of_size(args.size.as_deref()), args.spacing)?;
    for size in &checked.loaded.file.sizes {
        pipeline::check_variant(file, Variant::of_size(Some(&size.name.value)), args.spacing)?;
    }
    Ok(checked)
}

/// Whether the picture can be written, which is better known first.
fn check_picture(picture: &Path, inputs: &[&Path]) -> Result<(), CliError> {
    if !picture.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
        return Err(CliError::NotPng(picture.display().to_string()));
    }
    Ok(check_writable(&[picture.to_owned()], inputs)?)
}

/// The picture of the start, and what it shows.
#[derive(Serialize)]
struct StartRow {
    picture: String,
    #[serde(flatten)]
    shown: StartShown,
}

/// The faults of a garment file.
#[derive(Serialize)]
struct CheckFindings {
    file: String,
    ok: bool,
    diagnostics: Vec<DiagnosticRow>,
}

#[derive(Serialize)]
struct DiagnosticRow {
    severity: &'static str,
    line: usize,
    column: usize,
    message: String,
    hint: Option<String>,
}

impl DiagnosticRow {
    fn new(d: &Diagnostic) -> Self {
        let severity = match d.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        Self { severity, line: d.line, column: d.column, message: d.message.clone(), hint: d.hint.clone() }
    }
}

/// The pieces, seams and openings of a garment file without faults. Lengths are mm, areas mm².
#[derive(Serialize)]
struct CheckSummary {
    garment: String,
    title: String,
    ok: bool,
    pieces: Vec<PieceRow>,
    seams: Vec<SeamRow>,
    openings: Vec<OpeningRow>,
    /// With `--picture`.
    #[serde(skip_serializing_if = "Option::is_none")]
    start: Option<StartRow>,
    diagnostics: Vec<DiagnosticRow>,
}

#[derive(Serialize)]
struct PieceRow {
    name: String,
    fabric: String,
    area: f64,
    edges: usize,
}

#[derive(Serialize)]
struct SeamRow {
    name: String,
    a: String,
    b: String,
    length_a: f64,
    length_b: f64,
    /// The difference that is left once ease, gather or stretch has had its share.
    difference: f64,
    give: String,
    /// Notches from the start of each side.
    notches_a: Vec<f64>,
    notches_b: Vec<f64>,
}

#[derive(Serialize)]
struct OpeningRow {
    edges: Vec<String>,
    length: f64,
}

impl CheckSummary {
    fn new(garment: &Garment, warnings: &[Diagnostic]) -> Self {
        let piece = |p: &crate::pattern::Piece| PieceRow {
            name: p.name.clone(),
            fabric: p.fabric.clone(),
            area: p.area() * MM * MM,
            edges: p.loops.iter().map(Vec::len).sum(),
        };
        Self {
            garment: garment.name.clone(),
            title: garment.title.clone(),
            ok: true,
            pieces: garment.pieces.iter().map(piece).collect(),
            seams: walk(garment).into_iter().map(seam).collect(),
            openings: openings(garment).iter().map(|o| opening(garment, o)).collect(),
            start: None,
            diagnostics: warnings.iter().map(DiagnosticRow::new).collect(),
        }
    }

    fn text(&self) -> String {
        let tables = [self.piece_table(), self.seam_table(), self.opening_table()].join("\n");
        let start = self.start.as_ref();
        let start = start.map_or_else(String::new, |s| format!("\nthe start, in {}\n{}", s.picture, s.shown.text()));
        format!("{}\n\n{tables}{start}", self.title)
    }

    fn piece_table(&self) -> String {
        let mut rows = vec![["piece", "fabric", "cm²", "edges"].map(String::from).to_vec()];
        rows.extend(
            self.pieces
                .iter()
                .map(|p| vec![p.name.clone(), p.fabric.clone(), format!("{:.1}", p.area / 100.0), p.edges.to_string()]),
        );
        aligned(&rows)
    }

    fn seam_table(&self) -> String {
        let head = ["seam", "mm", "to mm", "difference", "", "notches", "edges"];
        let mut rows = vec![head.map(String::from).to_vec()];
        rows.extend(self.seams.iter().map(|s| {
            let number = |x: f64| format!("{x:.1}");
            let edges = format!("{} – {}", s.a, s.b);
            let numbers = [s.length_a, s.length_b, s.difference].map(number);
            [vec![s.name.clone()], numbers.to_vec(), vec![s.give.clone(), s.notches(), edges]].concat()
        }));
        aligned(&rows)
    }

    fn opening_table(&self) -> String {
        let mut rows = vec![["opening", "mm"].map(String::from).to_vec()];
        rows.extend(self.openings.iter().map(|o| vec![o.edges.join(" + "), format!("{:.0}", o.length)]));
        aligned(&rows)
    }
}

impl SeamRow {
    /// `60, 120 – 61, 120`, or nothing.
    fn notches(&self) -> String {
        let side = |at: &[f64]| match at {
            [] => "none".to_owned(),
            at => at.iter().map(|x| format!("{x:.1}")).collect::<Vec<String>>().join(", "),
        };
        if self.notches_a.is_empty() && self.notches_b.is_empty() {
            return String::new();
        }
        format!("{} – {}", side(&self.notches_a), side(&self.notches_b))
    }
}

fn seam(walked: SeamWalk) -> SeamRow {
    SeamRow {
        give: match walked.give {
            Give::Even => String::new(),
            Give::Ease(extra) => format!("ease {:.1} mm", extra * MM),
            Give::Gather(ratio) => format!("gather {ratio}"),
            Give::Stretch(ratio) => format!("stretch {ratio}"),
        },
        notches_a: walked.notches_a.iter().map(|x| x * MM).collect(),
        notches_b: walked.notches_b.iter().map(|x| x * MM).collect(),
        name: walked.name,
        a: walked.a,
        b: walked.b,
        length_a: walked.length_a * MM,
        length_b: walked.length_b * MM,
        difference: walked.difference * MM,
    }
}

fn opening(garment: &Garment, opening: &crate::pattern::Opening) -> OpeningRow {
    OpeningRow { edges: garment.opening_edges(opening), length: opening.length * MM }
}
