//! The verdict on a run in a few lines, for a maker.

use super::fit::{loosest, tightest};
use super::fit_report::Girth;
use super::form::FormReport;
use super::schema::{ClosureReport, PieceReport, Report, Stage, Worn};
use crate::pattern::written_edge;

/// Width of a line, characters: what a terminal shows without wrapping.
const WIDTH: usize = 100;
/// Width of the word that a line begins with, characters.
const LABEL: usize = 5;
/// Sign that names are left out.
const MORE: &str = "…";

/// The verdict on a run as text, at most eight lines. `broken` is the number of bounds that are broken, `look` says
/// where to look next.
///
/// Lines are no wider than 100 characters, except the last, which may name a long path.
pub fn summary(report: &Report, broken: usize, look: &str) -> String {
    let lines = [
        ("", heading(report, broken)),
        ("sewn", sewn(report)),
        ("worn", worn(&report.worn)),
        ("fit", fit(report)),
        ("rest", rest(report)),
        ("flat", flat(&report.pieces)),
    ];
    let mut out: String = lines.iter().filter_map(|(label, text)| Some(line(label, text.as_deref()?))).collect();
    let form = report.form.iter().flat_map(FormReport::lines);
    form.for_each(|(label, text)| out.push_str(&format!("{label:<LABEL$} {text}\n")));
    out.push_str(&format!("{:<LABEL$} {look}\n", "look"));
    out
}

/// A labelled line, shortened to the width where names are long.
fn line(label: &str, text: &str) -> String {
    let label = if label.is_empty() { String::new() } else { format!("{label:<LABEL$} ") };
    let room = WIDTH - label.chars().count();
    format!("{label}{}\n", shortened(text, room))
}

/// The text, cut after a word where it has more than `room` characters.
pub fn shortened(text: &str, room: usize) -> String {
    if text.chars().count() <= room {
        return text.to_owned();
    }
    let kept: String = text.chars().take(room.saturating_sub(2)).collect();
    let whole = kept.rsplit_once(' ').map_or(kept.as_str(), |(words, _)| words);
    format!("{} {MORE}", whole.trim_end_matches([',', ';', ' ']))
}

fn heading(report: &Report, broken: usize) -> Option<String> {
    let spacing = report.spacing;
    let verdict = match broken {
        0 => "within its bounds".to_owned(),
        1 => "OUT OF BOUNDS in one place".to_owned(),
        several => format!("OUT OF BOUNDS in {several} places"),
    };
    let verdict = format!(": {verdict} ({spacing} mm between particles)");
    let names = format!("{} on {}, {}", report.garment, report.mannequin, report.fabric);
    // However long the names are, the verdict is not cut.
    Some(shortened(&names, WIDTH - verdict.chars().count()) + &verdict)
}

/// Seams and closures, and the largest gap.
fn sewn(report: &Report) -> Option<String> {
    let widest = report.seams.iter().max_by(|a, b| a.gap_max.total_cmp(&b.gap_max));
    let seams = widest.map(|widest| {
        format!("{}, largest gap {:.2} mm at {}", count(report.seams.len(), "seam"), widest.gap_max, widest.name)
    });
    let open: Vec<String> = report.closures.iter().filter(|c| !c.closed).map(ClosureReport::title).collect();
    let closures = match (report.closures.len(), open.len()) {
        (0, _) => None,
        (all, 0) => Some(format!("{} done up", count(all, "closure"))),
        (all, _) => Some(format!("of {} these are open: {}", count(all, "closure"), open.join(", "))),
    };
    let text = seams.into_iter().chain(closures).collect::<Vec<_>>().join("; ");
    (!text.is_empty()).then_some(text)
}

fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// Each opening with the part of the body in it, equal ones on both sides together.
fn worn(openings: &[Worn]) -> Option<String> {
    let mut said: Vec<(String, String, usize)> = Vec::new();
    for opening in openings {
        let part = opening.body_part.clone().unwrap_or_else(|| "NOTHING".into());
        let name = written_edge(&opening.opening);
        let limb = part.strip_prefix("left ").or(part.strip_prefix("right ")).map(|limb| format!("one {limb}"));
        let place = limb.unwrap_or(part);
        match said.iter_mut().find(|(n, p, _)| *n == name && *p == place) {
            Some((_, _, times)) => *times += 1,
            None => said.push((name, place, 1)),
        }
    }
    let words = said.iter().map(|(name, place, times)| match (place.strip_prefix("one "), times) {
        (Some(limb), 2) => format!("{name} round both {limb}s"),
        (Some(_), _) => format!("{name} round {place}"),
        (None, _) if place == "NOTHING" => format!("{name} round NOTHING"),
        (None, _) => format!("{name} round the {place}"),
    });
    let text = words.collect::<Vec<_>>().join(", ");
    (!text.is_empty()).then_some(text)
}

/// The tightest and the loosest girth. Before draping, or where no cloth goes round the body, the piece that is drawn
/// out most.
fn fit(report: &Report) -> Option<String> {
    let girths = report.fit.as_ref().map_or(&[][..], |fit| &fit.girths);
    let Some(tight) = tightest(girths) else { return drawn_out(&report.pieces) };
    let ease = |girth: &Girth| format!("{}: ease {:.0} mm", girth.name, girth.ease);
    let pressure = tight.pressure.zip(tight.band).map(|(p, band)| format!(", {:.1} kPa ({})", p.max, band.name()));
    let loose = loosest(girths).filter(|loose| loose.name != tight.name);
    let loose = loose.map(|loose| format!("; loosest at the {}", ease(loose)));
    Some(format!("tightest at the {}{}{}", ease(tight), pressure.unwrap_or_default(), loose.unwrap_or_default()))
}

/// The piece that is drawn out most.
fn drawn_out(pieces: &[PieceReport]) -> Option<String> {
    let most = pieces.iter().max_by(|a, b| a.drawn_out.total_cmp(&b.drawn_out))?;
    let percent = 100.0 * most.drawn_out;
    Some(format!("stretched most in {}: 99 % of its threads by less than {percent:.1} %", most.name))
}

/// Whether cloth is still, and whether it passes through anything.
fn rest(report: &Report) -> Option<String> {
    let contact = &report.contact;
    let crossings = contact.inside_body + contact.cloth_body_intersections + contact.cloth_cloth_intersections;
    let through = match crossings {
        0 => "nothing passes through body or cloth".to_owned(),
        some => format!("cloth passes through body or cloth in {}", count(some, "place")),
    };
    let motion = match report.stages.iter().rev().find(|stage| stage.name == "drape") {
        None => "sewn, not draped yet".to_owned(),
        Some(stage) => at_rest(stage),
    };
    Some(format!("{motion}; {through}"))
}

fn at_rest(stage: &Stage) -> String {
    let drift = stage.drift.map_or_else(String::new, |drift| format!(" (drift {:.2} mm)", drift.rms));
    if stage.converged { format!("at rest{drift}") } else { format!("NOT AT REST{drift}") }
}

/// How well the pieces laid flat again agree with the drawn ones. Pieces that had to stretch are left out.
fn flat(pieces: &[PieceReport]) -> Option<String> {
    let area = |piece: &PieceReport| piece.area_error.round_trip;
    let kept = pieces.iter().filter(|piece| piece.stretched.is_none());
    let rows = kept.filter_map(|piece| Some((area(piece)?, piece)));
    let (error, worst) = rows.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let percent = 100.0 * error;
    Some(format!("laid flat again, pieces have their drawn areas to {percent:.2} % (worst: {})", worst.name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::SeamReport;

    fn opening(name: &str, part: Option<&str>) -> Worn {
        Worn { opening: name.into(), body_part: part.map(Into::into), ..Worn::default() }
    }

    #[test]
    fn both_sleeves_are_said_once() {
        let openings = [
            opening("neck", Some("neck")),
            opening("sleeve.L.hem", Some("left arm")),
            opening("sleeve.R.hem", Some("right arm")),
            opening("hem", Some("legs")),
            opening("cuff", None),
            opening("garter", Some("left leg")),
        ];
        let said = "neck round the neck, sleeve.hem round both arms, hem round the legs, cuff round NOTHING, \
                    garter round one leg";
        assert_eq!(worn(&openings).as_deref(), Some(said));
    }

    #[test]
    fn long_names_do_not_widen_the_lines_nor_add_any() {
        let long = "an edge whose name goes on and on ".repeat(5);
        let seam = SeamReport { name: long.clone(), gap_max: 0.25, ..SeamReport::default() };
        let report = Report {
            garment: long.clone(),
            seams: vec![seam.clone(), seam],
            worn: vec![opening(&long, Some("torso")), opening(&long, None)],
            pieces: vec![PieceReport { name: long, ..PieceReport::default() }],
            ..Report::default()
        };
        let text = summary(&report, 0, "at out/garment.png first");
        assert!(text.lines().count() <= 8, "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
        assert_eq!(text.matches(MORE).count(), 4, "{text}");
    }

    #[test]
    fn bounds_that_are_broken_and_cloth_that_moves_are_in_the_verdict() {
        let stage = Stage { name: "drape".into(), converged: false, ..Stage::default() };
        let report = Report { garment: "skirt".into(), stages: vec![stage], ..Report::default() };
        let text = summary(&report, 2, "");
        assert!(text.contains("OUT OF BOUNDS in 2 places") && text.contains("NOT AT REST"), "{text}");
    }
}
