//! The report for people.

use super::bands::Band;
use super::fit_report::Fit;
use super::schema::{ClosureReport, ContactReport, Crossing, PieceReport, Quartet, Report, SeamReport, Stage, Worn};

/// Shown where there is no value.
const NONE: &str = "–";

/// The report as text for a terminal, sections separated by empty lines, each line ending with a line feed.
pub fn table(report: &Report) -> String {
    let head = format!(
        "{} on {}, {}, spacing {} mm\n",
        report.garment,
        report.mannequin,
        report.fabric,
        number(Some(report.spacing), 1)
    );
    let sections = [
        head,
        pieces(&report.pieces, &report.total),
        seams(&report.seams),
        closures(&report.closures),
        worn(&report.worn),
        report.fit.as_ref().map_or_else(String::new, fit),
        contact_lines(&report.contact, &report.crossings),
        stages(&report.stages),
    ];
    sections.iter().filter(|s| !s.is_empty()).map(String::as_str).collect::<Vec<_>>().join("\n")
}

fn pieces(pieces: &[PieceReport], total: &PieceReport) -> String {
    let head = ["piece", "cm²", "area: sew", "drape", "flatten", "trip", "rim: sew", "drape", "flatten", "trip"];
    let more = ["strain", "99 %", "max", "shear", ""];
    let mut rows = vec![head.into_iter().chain(more).map(String::from).collect()];
    rows.extend(pieces.iter().map(piece));
    if pieces.len() > 1 {
        rows.push(piece(total));
    }
    let mut text = aligned(&rows);
    text.push_str("  errors and strain in %, shear in degrees\n");
    text
}

fn piece(p: &PieceReport) -> Vec<String> {
    let mut row = vec![p.name.clone(), number(Some(p.sizes.area_flat / 100.0), 1)];
    row.extend(quartet(&p.area_error));
    row.extend(quartet(&p.boundary_error));
    row.extend([p.strain.mean, p.strain.p99, p.strain.max].map(|x| percent(Some(x))));
    row.push(number(Some(p.shear.mean), 1));
    let why = p.stretched.as_ref().map(|s| format!("stretched {} % by {}", number(Some(100.0 * s.by), 1), s.why));
    row.push(why.unwrap_or_default());
    row
}

fn quartet(q: &Quartet) -> [String; 4] {
    [q.sew, q.drape, q.flatten, q.round_trip].map(percent)
}

fn seams(seams: &[SeamReport]) -> String {
    if seams.is_empty() {
        return String::new();
    }
    let mut rows = vec![["seam", "mm", "to mm", "gap", "largest"].map(String::from).to_vec()];
    rows.extend(seams.iter().map(|s| {
        let numbers = [(s.length_a, 1), (s.length_b, 1), (s.gap_mean, 3), (s.gap_max, 3)];
        let mut row = vec![s.name.clone()];
        row.extend(numbers.map(|(x, digits)| number(Some(x), digits)));
        row
    }));
    aligned(&rows)
}

fn closures(closures: &[ClosureReport]) -> String {
    if closures.is_empty() {
        return String::new();
    }
    let mut rows = vec![["closure", "on", "meets", "points", "gap", "largest", "gape", ""].map(String::from).to_vec()];
    rows.extend(closures.iter().map(|c| {
        let name = |n: &Option<String>| n.clone().unwrap_or_else(|| NONE.into());
        let mut row = vec![c.kind.clone(), name(&c.on), name(&c.meets), c.points.to_string()];
        row.extend([c.gap_mean, c.gap_max, c.gape].map(|x| number(x, 1)));
        row.push(if c.closed { String::new() } else { c.note.clone().unwrap_or_else(|| "OPEN".into()) });
        row
    }));
    aligned(&rows)
}

fn worn(worn: &[Worn]) -> String {
    if worn.is_empty() {
        return String::new();
    }
    let mut rows = vec![["opening", "mm", "round", "mm past its end"].map(String::from).to_vec()];
    let limbs = worn.iter().any(|w| w.past_end.is_some());
    rows.extend(worn.iter().map(|w| {
        let part = w.body_part.clone().unwrap_or_else(|| "NOTHING".into());
        vec![w.opening.clone(), number(Some(w.length), 0), part, number(w.past_end, 0)]
    }));
    // A skirt has none of them.
    rows.iter_mut().for_each(|row| row.truncate(if limbs { 4 } else { 3 }));
    aligned(&rows)
}

fn fit(fit: &Fit) -> String {
    let mut out = String::new();
    if !fit.girths.is_empty() {
        let head = ["girth", "body mm", "garment", "as cut", "ease", "kPa mean", "largest", "band", "cloth %"];
        let mut rows = vec![head.map(String::from).to_vec()];
        rows.extend(fit.girths.iter().map(|g| {
            let mut row = vec![g.name.clone()];
            row.extend([g.body, g.garment, g.flat, g.ease].map(|mm| number(Some(mm), 0)));
            row.extend([g.pressure.map(|p| p.mean), g.pressure.map(|p| p.max)].map(|p| number(p, 2)));
            row.push(g.band.map_or(NONE, Band::name).into());
            row.push(number(Some(100.0 * g.cloth), 0));
            row
        }));
        out.push_str(&aligned(&rows));
    }
    if !fit.lengths.is_empty() {
        let mut rows = vec![["length", "mm", "against", "uneven by"].map(String::from).to_vec()];
        rows.extend(
            fit.lengths
                .iter()
                .map(|l| vec![l.name.clone(), number(Some(l.value), 0), l.against.clone(), number(l.level, 0)]),
        );
        out.push('\n');
        out.push_str(&aligned(&rows));
    }
    fit.remarks.iter().for_each(|remark| out.push_str(&format!("  {remark}\n")));
    out
}

/// A line with the figures of contact, and one for every two pieces that cross.
pub fn contact_lines(c: &ContactReport, crossings: &[Crossing]) -> String {
    let mut out = format!(
        "  inside the body {} (deepest {} mm) · cloth through body {} · cloth through cloth {}\n",
        c.inside_body,
        number(Some(c.deepest), 2),
        c.cloth_body_intersections,
        c.cloth_cloth_intersections
    );
    for Crossing { piece, through, pairs, near: [x, y, z] } in crossings {
        let through = through.as_deref().unwrap_or("the body");
        out.push_str(&format!("    {piece} through {through}: {pairs}, near ({x:.0}, {y:.0}, {z:.0}) mm\n"));
    }
    out
}

fn stages(stages: &[Stage]) -> String {
    if stages.is_empty() {
        return String::new();
    }
    let head = ["stage", "s", "steps", "at rest", "drift mm"];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(stages.iter().map(|s| {
        vec![
            s.name.clone(),
            number(Some(s.seconds), 2),
            s.iterations.to_string(),
            if s.converged { "yes" } else { "NO" }.into(),
            number(s.drift.map(|d| d.rms), 3),
        ]
    }));
    aligned(&rows)
}

fn percent(x: Option<f64>) -> String {
    number(x.map(|x| 100.0 * x), 2)
}

fn number(x: Option<f64>, digits: usize) -> String {
    x.map_or_else(|| NONE.into(), |x| format!("{x:.digits$}"))
}

/// A table as text: columns two blanks apart, those that hold words flush left, the others flush right. The first row
/// is the head, with a rule under it.
pub fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let cell = |row: &[String], k: usize| row.get(k).cloned().unwrap_or_default();
    let width: Vec<usize> =
        (0..columns).map(|k| rows.iter().map(|r| cell(r, k).chars().count()).max().unwrap_or(0)).collect();
    let is_number = |text: &str| text.is_empty() || text == NONE || text.parse::<f64>().is_ok();
    let right: Vec<bool> = (0..columns).map(|k| rows.iter().skip(1).all(|r| is_number(&cell(r, k)))).collect();
    let line = |row: &Vec<String>| {
        let pad = |k: usize| {
            let (text, width) = (cell(row, k), width[k]);
            if right[k] { format!("{text:>width$}") } else { format!("{text:<width$}") }
        };
        let text = (0..columns).map(pad).collect::<Vec<_>>().join("  ");
        format!("  {}\n", text.trim_end())
    };
    let Some((head, body)) = rows.split_first() else { return String::new() };
    let rule = "─".repeat(width.iter().sum::<usize>() + 2 * columns.saturating_sub(1));
    let mut out = line(head);
    out.push_str(&format!("  {rule}\n"));
    body.iter().for_each(|r| out.push_str(&line(r)));
    out
}
