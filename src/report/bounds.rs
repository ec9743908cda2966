//! A garment's own bounds against its report.

use serde::Serialize;

use super::closures::APART;
use super::fit::hems;
use super::fit_report::Girth;
use super::schema::{ClosureReport, Crossing, FaultKind, PieceReport, Quartet, Report, Worn};
use crate::geometry::MM;
use crate::pattern::{Bound, Garment, Test, belongs_to, is_girth, walk};

/// Bounds of a garment that states none: closed seams, no crossing. Metres.
const DEFAULTS: [Bound; 2] = [Bound::Gap(None, 1e-3), Bound::Crossings(0)];
/// Per cent in a fraction of 1.
const PERCENT: f64 = 1e2;

/// One bound and its measured value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Name of the bound: `gap all`, `drape front area`.
    pub bound: String,
    /// Largest value found. Of a bound `at least` the least.
    pub measured: f64,
    /// Largest value allowed. Of a bound `at least` the least.
    pub limit: f64,
    /// Of both: `mm`, `%`, `kPa` or nothing.
    pub unit: &'static str,
    /// The piece, seam or opening with the largest value.
    pub at: Option<String>,
    /// Whether the bound is kept.
    pub ok: bool,
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { bound, measured, limit, unit, .. } = self;
        let blank = if unit.is_empty() { "" } else { " " };
        let digits = if unit.is_empty() { 0 } else { 3 };
        write!(f, "{bound}: {measured:.digits$}{blank}{unit} (limit {limit}{blank}{unit})")?;
        self.at.as_ref().map_or(Ok(()), |at| write!(f, " at {at}"))
    }
}

/// Compares a report with the garment's `tests`, for an outfit with those of each garment. If no test holds for its
/// fabric, seams must be closed and nothing may cross.
///
/// - Closures that tie something must be closed, unless a test bounds them, and laps must keep their order.
/// - A garment that is not worn where it belongs, and a piece that lies on itself when flat, are out of bounds in any
///   case.
/// - Bounds on stages that did not run, and for other fabrics, are left out.
/// - Pieces that had to stretch are reported as such and not bounded.
pub fn verdicts(garment: &Garment, report: &Report) -> Vec<Verdict> {
    let mut out = Vec::new();
    if garment.worn.is_empty() {
        out.extend(verdicts_of(garment, report, None));
    }
    for label in &garment.worn {
        let own = verdicts_of(garment, &of_garment(report, label), Some(label));
        out.extend(own.into_iter().map(|verdict| named(label, verdict)));
    }
    out.extend(report.pieces.iter().filter_map(on_itself));
    out
}

/// Verdicts on the garment of an outfit that is called `of`, or on the only one.
fn verdicts_of(garment: &Garment, report: &Report, of: Option<&str>) -> Vec<Verdict> {
    let own = garment.tests.iter().filter(|test| test.of.as_deref() == of && holds(test, report));
    let bounds: Vec<&Bound> = own.map(|test| &test.bound).collect();
    let bounds = if bounds.is_empty() { DEFAULTS.iter().collect() } else { bounds };
    let mut out: Vec<Verdict> = bounds.iter().flat_map(|bound| verdict(garment, report, of, bound)).collect();
    if !bounds.iter().any(|bound| matches!(bound, Bound::Closure(..))) {
        // Of what is not tied a note is told.
        out.extend(closures(report.closures.iter().filter(|c| c.note.is_none()), None, APART));
    }
    if is_misworn(report) && !bounds.contains(&&Bound::Worn) {
        out.push(worn(report));
    }
    out.extend(report.closures.iter().filter_map(turned));
    out
}

/// That the layer of a lap that belongs inside lies outside. Nothing for a lap in order, nor for a band that laps over
/// itself, whose end beyond the last point may lie on either side: it is reported only.
fn turned(closure: &ClosureReport) -> Option<Verdict> {
    let turned = closure.turned.as_ref().filter(|_| closure.on != closure.meets)?;
    let bound = format!("lap of the {} in the wrong order", closure.title());
    Some(Verdict { bound, measured: turned.length, limit: 0.0, unit: "mm", at: Some(turned.at.clone()), ok: false })
}

/// With the name of its garment before it.
fn named(label: &str, verdict: Verdict) -> Verdict {
    Verdict { bound: format!("{label}: {}", verdict.bound), ..verdict }
}

/// That nobody can cut a piece out. Nothing for a piece that can be.
fn on_itself(piece: &PieceReport) -> Option<Verdict> {
    let overlaps = piece.overlaps.filter(|n| *n > 0)?;
    let bound = format!("'{}' lies on itself when flat; cut it in two; crossings of its rim", piece.name);
    let at = Some(piece.name.clone());
    Some(Verdict { bound, measured: overlaps as f64, limit: 0.0, unit: "", at, ok: false })
}

/// The verdicts of every one of the garment's `tests`, in their order. None of a test for another fabric or a stage
/// that did not run.
pub fn verdicts_by_test(garment: &Garment, report: &Report) -> Vec<Vec<Verdict>> {
    let of = |test: &Test| match &test.of {
        _ if !holds(test, report) => Vec::new(),
        None => verdict(garment, report, None, &test.bound),
        Some(label) => {
            let own = verdict(garment, &of_garment(report, label), Some(label), &test.bound);
            own.into_iter().map(|verdict| named(label, verdict)).collect()
        }
    };
    garment.tests.iter().map(of).collect()
}

/// The rows of a report that are about one garment of an outfit. Contact is the whole outfit's.
fn of_garment(report: &Report, label: &str) -> Report {
    let own = |name: &str| belongs_to(name, label);
    let mut rows = report.clone();
    rows.pieces.retain(|piece| own(&piece.name));
    rows.seams.retain(|seam| own(&seam.name));
    rows.closures.retain(|closure| closure.on.as_deref().is_some_and(own));
    rows.worn.retain(|worn| worn.edges.iter().any(|edge| own(edge)));
    rows
}

/// Whether the test is for the fabric the garment was made in.
fn holds(test: &Test, report: &Report) -> bool {
    // A fabric's name may hold the sign that joins several.
    let all = format!(" + {} + ", report.fabric);
    let used = |name: &str| all.contains(&format!(" + {name} + "));
    test.fabric.as_deref().is_none_or(used)
}

/// Of the garment of an outfit that is called `of`, or of the whole.
fn verdict(garment: &Garment, report: &Report, of: Option<&str>, bound: &Bound) -> Vec<Verdict> {
    match bound {
        Bound::SeamLength(seam, limit) => {
            let own = |name: &str| of.is_none_or(|label| belongs_to(name, label));
            let walked = walk(garment).into_iter().filter(|s| own(&s.name) && seam_matches(seam.as_deref(), &s.name));
            let values = walked.map(|s| (s.name, s.difference.abs() * MM)).collect();
            vec![worst(format!("seam {}", all(seam)), values, limit * MM, "mm")]
        }
        Bound::Gap(seam, limit) => {
            let seams = report.seams.iter().filter(|s| seam_matches(seam.as_deref(), &s.name));
            let values = seams.map(|s| (s.name.clone(), s.gap_max)).collect();
            vec![worst(format!("gap {}", all(seam)), values, limit * MM, "mm")]
        }
        Bound::Closure(kind, limit) => {
            let of_kind = report.closures.iter().filter(|c| kind.as_ref().is_none_or(|kind| c.kind == *kind));
            closures(of_kind, kind.as_deref(), *limit).into_iter().collect()
        }
        Bound::Flatten { piece, area, boundary } => {
            let pieces = BoundPieces::new(garment, report, "flatten", piece.as_deref(), |q| q.round_trip);
            pieces.verdicts(*area, boundary.map(RimBound::Absolute))
        }
        Bound::Drape { piece, area, boundary } => {
            let pieces = BoundPieces::new(garment, report, "drape", piece.as_deref(), |q| q.drape);
            pieces.verdicts(*area, boundary.map(RimBound::Share))
        }
        Bound::Crossings(most) => vec![crossings(report, *most)],
        Bound::Worn => vec![worn(report)],
        Bound::Ease { girth, from, to } => ease(report, girth, [*from, *to]),
        Bound::Pressure(girth, below) => pressure(report, girth, *below),
        Bound::HemLevel(within) => hem_level(report, *within).into_iter().collect(),
    }
}

/// Rows of a girth that a test names. None before draping.
fn girths<'a>(report: &'a Report, wanted: &str) -> Option<Vec<&'a Girth>> {
    let fit = report.fit.as_ref()?;
    Some(fit.girths.iter().filter(|girth| is_girth(wanted, &girth.name)).collect())
}

/// That there is nothing to measure at a girth.
fn not_round(bound: String, limit: f64, unit: &'static str) -> Verdict {
    let at = Some("no cloth goes round the body there".into());
    Verdict { bound, measured: f64::NAN, limit, unit, at, ok: false }
}

/// Verdicts on the least and the largest ease, metres.
fn ease(report: &Report, wanted: &str, [from, to]: [Option<f64>; 2]) -> Vec<Verdict> {
    let Some(rows) = girths(report, wanted) else { return Vec::new() };
    let most = to.map(|to| {
        let bound = format!("ease {wanted}, at most");
        let values = rows.iter().map(|girth| (girth.name.clone(), girth.ease)).collect::<Vec<_>>();
        if values.is_empty() { not_round(bound, to * MM, "mm") } else { worst(bound, values, to * MM, "mm") }
    });
    let least = from.map(|from| {
        let bound = format!("ease {wanted}, at least");
        let tightest = rows.iter().min_by(|a, b| a.ease.total_cmp(&b.ease));
        let Some(girth) = tightest else { return not_round(bound, from * MM, "mm") };
        let (measured, limit) = (girth.ease, (from * MM * 1e9).round() / 1e9);
        Verdict { bound, measured, limit, unit: "mm", at: Some(girth.name.clone()), ok: measured >= limit }
    });
    least.into_iter().chain(most).collect()
}

/// Verdict on the largest pressure, kPa. None where the forces are not known.
fn pressure(report: &Report, wanted: &str, below: f64) -> Vec<Verdict> {
    let Some(rows) = girths(report, wanted) else { return Vec::new() };
    let bound = format!("pressure {wanted}");
    if rows.is_empty() {
        return vec![not_round(bound, below, "kPa")];
    }
    let values: Vec<_> = rows.iter().filter_map(|g| Some((g.name.clone(), g.pressure?.max))).collect();
    if values.is_empty() { Vec::new() } else { vec![worst(bound, values, below, "kPa")] }
}

/// Verdict on how level the hems are, metres. None before draping.
fn hem_level(report: &Report, within: f64) -> Option<Verdict> {
    report.fit.as_ref()?;
    let values: Vec<_> = hems(&report.worn).into_iter().map(|k| &report.worn[k]).collect();
    let values: Vec<_> = values.iter().map(|w| (w.opening.clone(), w.level)).collect();
    let bound = "hem level".to_owned();
    Some(if values.is_empty() { not_round(bound, within * MM, "mm") } else { worst(bound, values, within * MM, "mm") })
}

fn all(name: &Option<String>) -> &str {
    name.as_deref().unwrap_or("all")
}

/// Verdict on the gaps at the points of closures of a kind. `None` before the garment is sewn. A closure without points
/// has no figure.
fn closures<'a>(of_kind: impl Iterator<Item = &'a ClosureReport>, kind: Option<&str>, limit: f64) -> Option<Verdict> {
    let values: Vec<(String, f64)> = of_kind.filter_map(|c| Some((c.title(), c.gap_max?))).collect();
    let bound = format!("closure {}", kind.unwrap_or("all"));
    (!values.is_empty()).then(|| worst(bound, values, limit * MM, "mm"))
}

/// `side` means `side`, `side.L` and `side.R`.
fn seam_matches(wanted: Option<&str>, name: &str) -> bool {
    wanted.is_none_or(|w| name.strip_prefix(w).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')))
}

/// The verdict on the largest of `values`. Without any the bound is kept.
fn worst(bound: String, values: Vec<(String, f64)>, limit: f64, unit: &'static str) -> Verdict {
    // A value that is no number, whatever its sign, counts as larger than any.
    let rank = |value: f64| if value.is_nan() { f64::INFINITY } else { value };
    let largest = values.into_iter().max_by(|a, b| rank(a.1).total_cmp(&rank(b.1)).then(b.0.cmp(&a.0)));
    let (at, measured) = largest.map_or((None, 0.0), |(name, value)| (Some(name), value));
    // A limit as it was written, not with the rounding of metres to millimetres.
    let written = (limit * 1e9).round() / 1e9;
    Verdict { bound, measured, limit: written, unit, at, ok: measured <= limit }
}

/// A bound on a rim: the length by which it may change, or the share.
#[derive(Clone, Copy)]
enum RimBound {
    Absolute(f64),
    Share(f64),
}

/// The pieces a bound is about.
struct BoundPieces<'a> {
    bound: String,
    rows: Vec<&'a PieceReport>,
    way: fn(&Quartet) -> Option<f64>,
}

impl<'a> BoundPieces<'a> {
    fn new(
        garment: &Garment,
        report: &'a Report,
        stage: &str,
        wanted: Option<&str>,
        way: fn(&Quartet) -> Option<f64>,
    ) -> Self {
        let matches = |name: &str| {
            let drawn_as = garment.pieces.iter().find(|p| p.name == name).map(|p| p.drawn_as.as_str());
            wanted.is_none_or(|w| w == name || drawn_as == Some(w))
        };
        let rows = report.pieces.iter().filter(|p| p.stretched.is_none() && matches(&p.name));
        Self { bound: format!("{stage} {}", wanted.unwrap_or("all")), rows: rows.collect(), way }
    }

    fn verdicts(&self, area: Option<f64>, boundary: Option<RimBound>) -> Vec<Verdict> {
        let way = self.way;
        let area = area.and_then(|limit| {
            let values = self.values(|p| way(&p.area_error).map(|e| e * PERCENT))?;
            Some(worst(format!("{} area", self.bound), values, limit * PERCENT, "%"))
        });
        let boundary = boundary.and_then(|limit| {
            let name = format!("{} boundary", self.bound);
            Some(match limit {
                RimBound::Share(limit) => {
                    let values = self.values(|p| way(&p.boundary_error).map(|e| e * PERCENT))?;
                    worst(name, values, limit * PERCENT, "%")
                }
                RimBound::Absolute(limit) => {
                    let values = self.values(|p| way(&p.boundary_error).map(|e| e * p.sizes.boundary_flat))?;
                    worst(name, values, limit * MM, "mm")
                }
            })
        });
        area.into_iter().chain(boundary).collect()
    }

    /// Values by piece. `None` if the stage did not run.
    fn values(&self, of: impl Fn(&PieceReport) -> Option<f64>) -> Option<Vec<(String, f64)>> {
        self.rows.iter().map(|p| Some((p.name.clone(), of(p)?))).collect()
    }
}

/// Points inside the body count as well: cloth that has wholly gone in crosses nothing.
fn crossings(report: &Report, most: usize) -> Verdict {
    let c = &report.contact;
    let counts = [
        ("points in the body", c.inside_body),
        ("cloth through body", c.cloth_body_intersections),
        ("cloth through cloth", c.cloth_cloth_intersections),
    ];
    let sum: usize = counts.iter().map(|c| c.1).sum();
    let found = counts.iter().filter(|c| c.1 > 0).map(|c| format!("{} {}", c.1, c.0)).collect::<Vec<_>>().join(", ");
    let who = |c: &Crossing| format!("{} through {}", c.piece, c.through.as_deref().unwrap_or("the body"));
    let at = report.crossings.first().map_or(found.clone(), |first| format!("{found}: {}", who(first)));
    Verdict {
        bound: "crossings".into(),
        measured: sum as f64,
        limit: most as f64,
        unit: "",
        at: (!at.is_empty()).then_some(at),
        ok: sum <= most,
    }
}

/// Openings at which the garment is not worn where it belongs. A garment without any opening is worn by nobody.
fn worn(report: &Report) -> Verdict {
    let faults: Vec<String> = report.worn.iter().filter_map(fault).collect();
    Verdict {
        bound: "openings not worn".into(),
        measured: faults.len() as f64,
        limit: 0.0,
        unit: "",
        ok: faults.is_empty() && !report.worn.is_empty(),
        at: (!faults.is_empty()).then(|| faults.join("; ")),
    }
}

/// Fault of an opening, in words.
fn fault(worn: &Worn) -> Option<String> {
    worn.fault.as_ref().map(|fault| format!("'{}' {}", worn.opening, fault.text))
}

/// Whether it can be told of a garment that it is not worn where it belongs.
fn is_misworn(report: &Report) -> bool {
    report.worn.iter().any(|w| w.fault.as_ref().is_some_and(|fault| fault.kind != FaultKind::Unknown))
}

#[cfg(test)]
mod tests {
    use super::super::schema::Fault;
    use super::*;

    #[test]
    fn a_garment_that_says_nothing_is_held_to_be_worn_where_that_can_be_told() {
        let garment = |tests: Vec<Test>| Garment {
            name: "bare".into(),
            title: "Bare".into(),
            body: None,
            pieces: vec![],
            seams: vec![],
            fabrics: vec![],
            closures: vec![],
            worn: Vec::new(),
            tests,
        };
        let judged = |kind: FaultKind, bounds: &[Bound]| {
            let fault = Fault { kind, text: "nothing passes through it".into() };
            let worn = vec![Worn { opening: "hem".into(), fault: Some(fault), ..Worn::default() }];
            let tests = bounds.iter().map(|bound| Test { bound: bound.clone(), fabric: None, of: None }).collect();
            let verdicts = verdicts(&garment(tests), &Report { worn, ..Report::default() });
            let told: Vec<String> = verdicts.iter().filter(|v| !v.ok).map(ToString::to_string).collect();
            told
        };
        let told = ["openings not worn: 1 (limit 0) at 'hem' nothing passes through it"];
        assert_eq!(judged(FaultKind::Empty, &[]), told);
        // Once, whether it is asked for or not.
        assert_eq!(judged(FaultKind::Empty, &[Bound::Crossings(0)]), told);
        assert_eq!(judged(FaultKind::Empty, &[Bound::Worn]), told);
        assert_eq!(judged(FaultKind::Unknown, &[]), [""; 0]);
        assert_eq!(judged(FaultKind::Unknown, &[Bound::Worn]), told);
        assert!(!worn(&Report::default()).ok, "no opening");
    }

    #[test]
    fn what_is_no_number_breaks_a_bound() {
        for nan in [f64::NAN, -f64::NAN] {
            let values = vec![("a".to_owned(), 1.0), ("b".to_owned(), nan), ("c".to_owned(), 2.0)];
            let verdict = worst("gap all".into(), values, 3.0, "mm");
            assert!(!verdict.ok && verdict.measured.is_nan() && verdict.at.as_deref() == Some("b"), "{verdict}");
        }
        assert!(worst("gap all".into(), vec![("a".to_owned(), 1.0)], 3.0, "mm").ok);
    }
}
