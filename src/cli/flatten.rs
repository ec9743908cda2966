//! `flatten`: any surface, or a garment's draped pieces.

use std::path::{Path, PathBuf};

use super::arg_values::UnitArg;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::flatten_args::FlattenArgs;
use super::make::{MakeGoal, MakePlan, carry_out, folder, write};
use crate::fabric;
use crate::flatten::{FlattenOptions, Mode};
use crate::geometry::MM;
use crate::input::stem;
use crate::io::files::check_writable;
use crate::pipeline::{
    AT_REST, Cuts, DartStop, Darts, FLAT_OBJ, FLAT_PNG, FORM_OBJ, GARMENT_YAML, Limit, OUTLINE_SVG, PATTERN_SVG,
    PartReport, PictureOptions, REPORT_JSON, SurfaceOptions, SurfaceReport, Weld, flatten_surface,
};
use crate::report::{aligned, restless, shortened};

/// Pieces that are shown one by one: with more, nobody would find what is said beside them.
const LISTED: usize = 40;
/// Width of a line of the verdict, characters.
const LINE: usize = 100;

/// Drapes of a new pattern when none are asked for: the one that shows how far it is from the form.
const ROUNDS: usize = 1;

/// `toile flatten`
pub(super) fn flatten(args: &FlattenArgs, console: &Console) -> Result<Exit, CliError> {
    foreign(args)?;
    let options = FlattenOptions { mode: args.mode.into(), corners: args.corners, ..FlattenOptions::default() };
    if is_garment(&args.input) {
        let plan = MakePlan {
            garments: std::slice::from_ref(&args.input),
            output: args.output.as_deref(),
            overrides: args.overrides.checked(),
            drawing: PictureOptions::default(),
            turntable: None,
            table: args.table,
            goal: MakeGoal::Flat {
                from: args.from.as_deref(),
                options,
                rounds: args.rounds.map_or(ROUNDS, usize::from),
            },
        };
        return carry_out(&plan, console);
    }
    surface(args, options, console)
}

fn is_garment(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("yaml") || e.eq_ignore_ascii_case("yml"))
}

/// Refuses options that have no meaning for this input.
fn foreign(args: &FlattenArgs) -> Result<(), CliError> {
    let overrides = args.overrides.checked();
    let wrong = if is_garment(&args.input) {
        let options = [
            ("--cut", !args.cut.is_empty()),
            ("--dart", args.dart.is_some()),
            ("--gores", args.gores.is_some()),
            ("--max-strain", args.max_strain.is_some()),
            ("--ease", args.ease.is_some()),
            ("--simplify", args.simplify.is_some()),
            ("--limit", args.limit.is_some()),
            ("--units", args.units.is_some()),
            ("--up", args.up.is_some()),
            ("--no-texture-seams", args.no_texture_seams),
            ("--together", args.together),
            ("--weld", args.weld.is_some()),
        ];
        options.into_iter().find(|o| o.1).map(|(name, _)| format!("{name} belongs to a surface, not to a garment file"))
    } else {
        let options = [
            ("--from", args.from.is_some()),
            ("--rounds", args.rounds.is_some()),
            ("--spacing", overrides.spacing.is_some()),
            ("--body", overrides.body.is_some()),
            ("--body-units", overrides.body_unit.is_some()),
            ("--measures", !overrides.measures.is_empty()),
            ("--alter", !overrides.alter.is_empty()),
        ];
        let found = options.into_iter().find(|o| o.1);
        found.map(|(name, _)| format!("{name} belongs to a garment file; a surface is flattened as it is"))
    };
    wrong.map_or(Ok(()), |why| Err(CliError::Argument(why)))
}

/// The strain asked for, or that of the fabric.
fn limit(args: &FlattenArgs) -> Result<Limit, CliError> {
    /// Per cent.
    const USUAL: f64 = 10.0;
    match args.overrides.checked().fabric {
        Some(name) => Ok(Limit::of(&fabric::load(&name)?)),
        None => Ok(Limit::Strain(args.max_strain.or(args.limit).unwrap_or(USUAL) / 100.0)),
    }
}

/// `auto`, `sharp`, vertices from 1 with commas between them, or a file.
fn cuts(args: &[String]) -> Result<Cuts, CliError> {
    let mut cuts = Cuts::default();
    for text in args {
        match text.as_str() {
            "auto" => cuts.auto = true,
            "sharp" => cuts.sharp = true,
            _ => {}
        }
        if ["auto", "sharp"].contains(&text.as_str()) {
            continue;
        }
        let file = Path::new(text);
        if file.is_file() {
            cuts.files.push(file.to_owned());
            continue;
        }
        let path: Result<Vec<u32>, _> = text.split(',').map(|v| v.trim().parse::<u32>()).collect();
        let why = || {
            CliError::Argument(format!(
                "--cut {text}: 'auto', 'sharp', vertex numbers such as 12,340 or a file of lines is expected"
            ))
        };
        cuts.paths.push(path.map_err(|_| why())?);
    }
    Ok(cuts)
}

fn surface(args: &FlattenArgs, flatten: FlattenOptions, console: &Console) -> Result<Exit, CliError> {
    let options = SurfaceOptions {
        unit: args.units.map(UnitArg::unit),
        up: args.up,
        texture_seams: !args.no_texture_seams,
        groups: !args.together,
        weld: args.weld.map_or(Weld::BetweenParts, |mm| Weld::Within(mm / MM)),
        simplify: args.simplify.map(|mm| mm / MM),
        cuts: cuts(&args.cut)?,
        gores: args.gores,
        darts: args.dart.or(args.max_strain.map(|_| Darts::Enough)),
        ease: args.ease.unwrap_or_default(),
        limit: limit(args)?,
        flatten,
        first_number: 1,
    };
    let stem = stem(&args.input);
    let folder = folder(args.output.as_deref(), &stem);
    let inputs = [args.input.as_path()];
    let targets: Vec<PathBuf> = [FLAT_OBJ, FLAT_PNG, FORM_OBJ, GARMENT_YAML, OUTLINE_SVG, PATTERN_SVG, REPORT_JSON]
        .map(|name| folder.join(name))
        .into();
    check_writable(&targets, &inputs)?;
    let flat = flatten_surface(&args.input, &options)?;
    let flatten_mode = options.flatten.mode;
    flat.notes.iter().for_each(|note| console.note(note));
    write(flat.results()?, &folder, &inputs)?;
    let report = &flat.report;
    console.results(report, || told(report, &folder, args.table))?;
    for stage in restless(&report.stages, AT_REST) {
        console.note(&stage.to_string());
    }
    report.pieces.iter().filter_map(rim_missed).take(LISTED).for_each(|text| console.note(&text));
    if flatten_mode == Mode::Woven {
        report.pieces.iter().filter_map(sheared).take(LISTED).for_each(|text| console.note(&text));
    }
    let strained = |layable: bool| {
        let pieces = report.pieces.iter().filter(move |piece| piece.layable == layable);
        pieces.filter_map(|piece| strained(piece, &options)).take(LISTED).collect::<Vec<_>>()
    };
    strained(true).iter().for_each(|text| console.note(text));
    let mut exit = Exit::Done;
    if args.max_strain.is_some() {
        for piece in report.pieces.iter().filter(|piece| piece.darts_stopped.is_some()) {
            let percent = 100.0 * piece.strain.p99;
            console.complain(&format!("out of bounds: '{}' is strained by {percent:.1} % with its darts", piece.name));
            exit = Exit::OutOfBounds;
        }
    }
    for text in strained(false) {
        console.complain(&format!("out of bounds: {text}"));
        exit = Exit::OutOfBounds;
    }
    for failed in &report.failed {
        console.complain(&format!("'{}' is not laid flat: {}", failed.name, failed.why));
        exit = Exit::OutOfBounds;
    }
    for piece in report.pieces.iter().filter(|p| p.overlaps > 0) {
        let where_to = in_two(piece);
        console.complain(&format!("out of bounds: '{}' lies on itself when flat; {where_to}", piece.name));
        exit = Exit::OutOfBounds;
    }
    Ok(exit)
}

/// The verdict, or every figure.
fn told(report: &SurfaceReport, folder: &Path, every: bool) -> String {
    if every {
        return format!("{}\n  written to {}\n", figures(report), folder.display());
    }
    let largest = |of: fn(&PartReport) -> f64| report.pieces.iter().max_by(|a, b| of(a).total_cmp(&of(b)));
    let pieces = match report.pieces.len() {
        1 => "1 piece".to_owned(),
        several => format!("{several} pieces"),
    };
    let mut lines = vec![format!("{}: {pieces} laid flat", report.surface)];
    if let Some(worst) = largest(|piece| piece.strain.p99) {
        let percent = 100.0 * worst.strain.p99;
        lines.push(format!("strain  at most {percent:.1} % in all but a hundredth of '{}'", worst.name));
    }
    if let Some(worst) = largest(|piece| piece.area_change.abs()) {
        lines.push(format!("area    changed by {} % at most, in '{}'", signed(worst.area_change), worst.name));
    }
    if let Some(worst) = largest(rim_change) {
        lines.push(format!("rim     changed by {} % at most, round '{}'", signed(rim_signed(worst)), worst.name));
    }
    if let Some(ease) = report.ease {
        let [warp, weft, along, across] =
            [ease.warp, ease.weft, ease.stretch_warp, ease.stretch_weft].map(|x| format!("{:+.1} %", 100.0 * x));
        lines.push(format!(
            "ease    cut {warp} along the grain and {weft} across: worn, stretched {along} and {across}"
        ));
    }
    let mut text: String = lines.iter().map(|line| shortened(line, LINE) + "\n").collect();
    let first = folder.join(FLAT_PNG);
    text.push_str(&format!("look    at {} first; figures: {REPORT_JSON} beside it, or --table\n", first.display()));
    text
}

/// Change of the rim's length, a fraction with its sign.
fn rim_signed(piece: &PartReport) -> f64 {
    piece.boundary_flattened / piece.boundary_draped - 1.0
}

fn rim_change(piece: &PartReport) -> f64 {
    rim_signed(piece).abs()
}

/// A share in per cent with its sign. Zero has none.
fn signed(share: f64) -> String {
    match format!("{:+.3}", 100.0 * share) {
        zero if zero.ends_with("0.000") => "0.000".to_owned(),
        figure => figure,
    }
}

/// That a piece has not the rim it should have, and what gives it that.
fn rim_missed(piece: &PartReport) -> Option<String> {
    /// A hundredth of a millimetre of a metre: nobody can cut what is less.
    const CUT: f64 = 1e-5;
    let missed = 100.0 * piece.rim_missed.filter(|missed| *missed > CUT)?;
    let said = format!("the rim of '{}' could not be kept: it is off by {missed:.3} % in the mean", piece.name);
    Some(said + "; with a dart (--dart auto) or a cut (--cut) the cloth inside has room")
}

/// Where a weave would have to be sheared beyond what any gives.
fn sheared(piece: &PartReport) -> Option<String> {
    /// Degrees. Threads lock at 30; a triangle of the mesh shears by half a degree more or less than its neighbours.
    const LOCKED: f64 = 30.5;
    let (name, threads) = (&piece.name, &piece.threads);
    (threads.shear_max > LOCKED).then(|| {
        let (most, vertex) = (threads.shear_max, threads.shear_at);
        format!("'{name}' shears past 30° ({most:.0}° at vertex {vertex}): cut it there, with --dart or --cut")
    })
}

/// The part that is beyond the limit, the reason, and the remedy.
fn strained(piece: &PartReport, options: &SurfaceOptions) -> Option<String> {
    if piece.layable && piece.dart.is_none() && piece.darts_stopped.is_none() {
        return None;
    }
    let (name, strain) = (&piece.name, strain(piece, &options.limit));
    let what = if piece.layable {
        format!("'{name}' is strained by {strain}")
    } else {
        let another = if piece.darts > 0 { "another" } else { "a" };
        let cloth = cloth(&options.limit);
        format!("'{name}' cannot be laid flat in {cloth} without {another} cut or dart: it is strained by {strain}")
    };
    let mut text = format!("{what}{}: {}", area_said(piece), remedy(piece, options));
    if piece.area_error_bound > 0.0 {
        let bound = 100.0 * piece.area_error_bound;
        text += &format!("; no flat piece with this length of rim has more than {:.1} % of its area", 100.0 - bound);
    }
    Some(text)
}

/// How much of its area it loses or gains, in plain words where it is much.
fn area_said(piece: &PartReport) -> String {
    /// Changes below this share are in the table only.
    const MUCH: f64 = 0.05;
    /// Shares that have a name, and how near one must be.
    const NAMED: [(f64, &str); 5] = [
        (0.25, "a quarter"),
        (1.0 / 3.0, "a third"),
        (0.5, "half"),
        (2.0 / 3.0, "two thirds"),
        (0.75, "three quarters"),
    ];
    const NEAR: f64 = 0.02;
    let share = piece.area_change.abs();
    if share < MUCH {
        return String::new();
    }
    let verb = if piece.area_change < 0.0 { "loses" } else { "gains" };
    let percent = 100.0 * piece.area_change;
    match NAMED.into_iter().find(|(named, _)| (named - share).abs() < NEAR) {
        Some((_, named)) => format!(", and it {verb} {named} of its area ({percent:+.1} %)"),
        None => format!(", and it {verb} {:.1} % of its area", percent.abs()),
    }
}

fn cloth(limit: &Limit) -> &str {
    match limit {
        Limit::Strain(_) => "any woven cloth",
        Limit::Fabric { name, .. } => name,
    }
}

/// How much it is strained, beside the limit.
fn strain(piece: &PartReport, limit: &Limit) -> String {
    let percent = |x: f64| format!("{:.1} %", 100.0 * x);
    match limit {
        Limit::Strain(most) => {
            format!("up to {} in all but a hundredth of it (limit {})", percent(piece.strain.p99), percent(*most))
        }
        Limit::Fabric { name, warp, weft, most } => {
            let full = if piece.layable {
                String::new()
            } else {
                format!(", at full load {} and {}", percent(most[0]), percent(most[1]))
            };
            format!(
                "up to {} along the warp and {} along the weft ({name} gives {} and {}{full})",
                percent(piece.threads.warp_p99),
                percent(piece.threads.weft_p99),
                percent(*warp),
                percent(*weft)
            )
        }
    }
}

/// Where a dart would help, and why it is not there.
fn remedy(piece: &PartReport, options: &SurfaceOptions) -> String {
    let place = piece.dart.map(|dart| {
        let (rim, tip, length) = (dart.rim, dart.tip, dart.length);
        format!("a dart from vertex {rim} on the rim to vertex {tip} ({length:.0} mm) would relieve it most")
    });
    let stopped = match (piece.darts_stopped, place) {
        (None, Some(place)) => return place + "; --dart auto cuts it",
        (Some(DartStop::NoneLeft), Some(place)) => format!(
            "{place}, but --dart allows {}; allow more, or {}",
            options.darts.map_or(0, Darts::most),
            in_two(piece)
        ),
        (Some(DartStop::Overlap), Some(place)) => format!("{place}, but make it lie on itself; {}", in_two(piece)),
        _ => format!("no place for a dart can be told; {}", in_two(piece)),
    };
    match piece.darts {
        0 => stopped,
        1 => format!("it has a dart; {stopped}"),
        several => format!("it has {several} darts; {stopped}"),
    }
}

/// To cut a piece in two, and where.
fn in_two(piece: &PartReport) -> String {
    match piece.halving {
        Some(way) => format!(
            "cut it in two with --cut {},{} ({:.0} mm), or into gores with --gores",
            way.from, way.to, way.length
        ),
        None => "cut it in two with --cut".to_owned(),
    }
}

fn figures(report: &SurfaceReport) -> String {
    let head = ["piece", "cm²", "area %", "rim %", "strain 99 %", "corner °", "overlaps"];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(report.pieces.iter().take(LISTED).map(|p| {
        vec![
            p.name.clone(),
            format!("{:.1}", p.area_draped / 100.0),
            signed(p.area_change),
            signed(rim_signed(p)),
            format!("{:.3}", 100.0 * p.strain.p99),
            format!("{:.1}", p.corner_change),
            p.overlaps.to_string(),
        ]
    }));
    match report.pieces.len().saturating_sub(LISTED) {
        0 => aligned(&rows),
        more => format!("{}\n  and {more} more, which {REPORT_JSON} has\n", aligned(&rows)),
    }
}
