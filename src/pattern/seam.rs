//! Seams: their lengths against the file's ease, gather and stretch, their marks and openings.

use super::chain::{self, Directed};
use super::cut::Pieces;
use super::diagnostic::{Findings, Spot};
use super::draft::Draft;
use super::file::{OpenFile, SeamFile};
use super::notch::matched;
use super::problem::Problem;
use super::rim::{Rims, joints};
use super::select::{Candidate, Source};
use super::value::Unit;
use super::walk::difference;
use super::{Garment, Give, Seam, SeamKind, Span};

/// Largest difference of a seam's lengths without ease, gather or stretch, metres.
pub(crate) const DEFAULT_TOLERANCE: f64 = 2e-3;
/// Stage of seams for which the file gives none: all close together.
pub(super) const DEFAULT_STAGE: i32 = 1;
/// Names of a seam's ends in openings, beside the edges that meet there.
const ENDS: [&str; 2] = ["start", "end"];
/// Largest ease, as a share of the length. More puckers, and counts as gathering.
const LARGEST_EASE: f64 = 0.08;
/// Ease below which there is none, metres.
const NO_EASE: f64 = 0.05e-3;
/// Share of the length by which written gather and stretch ratios may be rounded, beside the tolerance.
const RATIO_ROUNDING: f64 = 0.01;

/// The seams of a garment, and which stretches an opening leaves unsewn.
#[derive(Default)]
pub(super) struct Seams {
    pub(super) seams: Vec<Seam>,
    /// The seam of the file each comes from. `None` for darts and pleats.
    pub(super) written: Vec<Option<usize>>,
    pub(super) open: Vec<Span>,
}

/// Reads all seams.
pub(super) fn seams(file: &super::GarmentFile, drafts: &[Draft], cut: &Pieces, findings: &mut Findings) -> Seams {
    let pieces = file.pieces.iter().map(|p| p.name.value.as_str()).collect();
    let source = Source { drafts, cut, unit: file.unit(), pieces };
    let mut candidates: Vec<Candidate> = Vec::new();
    for seam in &file.seams {
        check_ratios(seam, findings);
        if source.names_undrawn(seam) {
            source.check_references(seam, findings);
        } else {
            candidates.extend(source.candidates(seam, findings));
        }
    }
    let own = own_seams(drafts, cut);
    let mut out = Seams::default();
    let finish = Finish { cut, rims: Rims::new(&cut.pieces), unit: file.unit() };
    for directed in chain::direct(candidates, &own, &source, findings) {
        let written = file.seams.iter().position(|s| std::ptr::eq(s, directed.candidate.file));
        out.seams.push(finish.seam(&directed, &mut out.open, findings));
        out.written.push(written);
    }
    out.written.extend(own.iter().map(|_| None));
    out.seams.extend(own);
    out
}

/// The seams of darts and pleats, `front.dart.L`.
fn own_seams(drafts: &[Draft], cut: &Pieces) -> Vec<Seam> {
    let mut seams = Vec::new();
    for instance in &cut.instances {
        let draft = &drafts[instance.draft];
        for own in &draft.own_seams {
            let (Some(a), Some(b)) = (instance.span(draft, own.a), instance.span(draft, own.b)) else { continue };
            seams.push(Seam {
                name: format!("{}.{}{}", draft.name, own.name, instance.suffix()),
                marks: vec![(0.0, 0.0), (a.length(), b.length())],
                a: vec![a],
                b: vec![b],
                give: Give::Even,
                stage: DEFAULT_STAGE,
                kind: own.kind,
                closure: None,
            });
        }
    }
    seams
}

/// Allowed difference of a seam's lengths, metres.
pub(super) fn tolerance(file: &SeamFile, unit: Unit) -> f64 {
    file.tolerance.as_ref().map_or(DEFAULT_TOLERANCE, |t| t.value.value(unit))
}

fn length(chain: &[Span]) -> f64 {
    chain.iter().map(Span::length).sum()
}

/// Ends of two chains and those of their joints that nearly meet when the chains are laid together.
pub(super) fn marks_between(a: &[Span], b: &[Span], tolerance: f64) -> Vec<(f64, f64)> {
    let (la, lb) = (length(a), length(b));
    let mut marks = vec![(0.0, 0.0)];
    for on_a in joints(a) {
        let across = on_a * lb / la;
        let near = joints(b).into_iter().min_by(|x, y| (x - across).abs().total_cmp(&(y - across).abs()));
        if let Some(on_b) = near.filter(|on_b| (on_b - across).abs() <= tolerance) {
            add_mark(&mut marks, (on_a, on_b));
        }
    }
    add_mark(&mut marks, (la, lb));
    marks
}

/// Adds a mark if it rises in both.
fn add_mark(marks: &mut Vec<(f64, f64)>, mark: (f64, f64)) {
    if marks.last().is_none_or(|last| mark.0 > last.0 + 1e-6 && mark.1 > last.1 + 1e-6) {
        marks.push(mark);
    }
}

struct Finish<'a> {
    cut: &'a Pieces,
    rims: Rims,
    unit: Unit,
}

impl Finish<'_> {
    fn seam(&self, directed: &Directed, open: &mut Vec<Span>, findings: &mut Findings) -> Seam {
        let file = directed.candidate.file;
        let (a, b) = (&directed.a, &directed.b);
        let give = self.give(file, a, b, findings);
        let tolerance = tolerance(file, self.unit);
        check_lengths(&directed.candidate, (length(a), length(b)), give, tolerance, findings);
        let [start, end] = self.open_ends(directed, findings);
        let closure = file.closure.as_ref().or_else(|| file.open.iter().find_map(|o| o.closure.as_ref()));
        let (la, lb) = (length(a), length(b));
        let scaled = lb / la;
        let kept_a = clipped(a, start, la - end);
        let kept_b = clipped(b, start * scaled, lb - end * scaled);
        for (chain, total, scale) in [(a, la, 1.0), (b, lb, scaled)] {
            open.extend(clipped(chain, 0.0, start * scale));
            open.extend(clipped(chain, total - end * scale, total));
        }
        let by_notches = file.match_notches.as_ref().is_some_and(|m| m.value);
        let marks = if by_notches {
            self.notch_marks(directed, &kept_a, &kept_b, findings)
        } else {
            marks_between(&kept_a, &kept_b, tolerance)
        };
        let share = length(&kept_a) / la;
        Seam {
            name: directed.candidate.name.clone(),
            a: kept_a,
            b: kept_b,
            marks,
            give: if let Give::Ease(extra) = give { Give::Ease(extra * share) } else { give },
            stage: file.stage.as_ref().map_or(DEFAULT_STAGE, |s| s.value),
            kind: SeamKind::Written,
            closure: closure.map(|c| c.value.clone()),
        }
    }

    fn give(&self, file: &SeamFile, a: &[Span], b: &[Span], findings: &mut Findings) -> Give {
        let (la, lb) = (length(a), length(b));
        if let Some(ease) = &file.ease {
            let extra = ease.value.value(self.unit);
            if extra.abs() > LARGEST_EASE * la {
                let advice = fitting(la, lb);
                let (seam, percent) = (file.name.value.clone(), extra.abs() / la * 100.0);
                findings.error(
                    ease.at,
                    Problem::EaseTooLarge { seam, ease: extra * 1e3, percent, length: la * 1e3, advice },
                );
            }
            return Give::Ease(extra);
        }
        match (&file.gather, &file.stretch) {
            (Some(ratio), _) => Give::Gather(ratio.value),
            (None, Some(ratio)) => Give::Stretch(ratio.value),
            (None, None) => Give::Even,
        }
    }

    /// Lengths at the start and the end of the first chain that are worn open.
    fn open_ends(&self, directed: &Directed, findings: &mut Findings) -> [f64; 2] {
        let file = directed.candidate.file;
        let (mut ends, mut opened) = ([0.0; 2], [false; 2]);
        for open in &file.open {
            let Some(end) = self.end_at(directed, open, findings) else { continue };
            if std::mem::replace(&mut opened[end], true) {
                let (seam, end) = (file.name.value.clone(), ENDS[end]);
                findings.error(open.from.at, Problem::OpenTwice { seam, end });
                continue;
            }
            let long = open.length.value.value(self.unit);
            let whole = length(&directed.a);
            let closed = open.closure.is_some() || file.closure.is_some();
            if ends[1 - end] + long >= whole - 1e-6 && !(closed && long <= whole + 1e-6) {
                let (seam, length) = (file.name.value.clone(), whole * 1e3);
                findings
                    .error(open.length.at, Problem::OpenTooLong { seam, length, open: (ends[1 - end] + long) * 1e3 });
            } else if !closed {
                ends[end] = long;
            }
        }
        ends
    }

    /// 0 if the opening starts at the chain's start, 1 if at its end.
    fn end_at(&self, directed: &Directed, open: &OpenFile, findings: &mut Findings) -> Option<usize> {
        let mut known = Vec::new();
        for (i, word) in ENDS.into_iter().enumerate() {
            for chain in [&directed.a, &directed.b] {
                let Some(span) = (if i == 0 { chain.first() } else { chain.last() }) else { continue };
                let corner = self.rims.point(span.edge, if i == 0 { span.from } else { span.to });
                for edge in self.rims.edges_at(&self.cut.pieces, corner) {
                    // A seam's only edge is at both of its ends.
                    if matches!(&chain[..], [only] if only.edge == edge) {
                        continue;
                    }
                    let piece = &self.cut.pieces[edge.piece];
                    let name = base_name(&piece.loops[edge.ring][edge.index].name);
                    let full = format!("{}.{name}", piece.drawn_as);
                    if open.from.value == name || open.from.value == full || open.from.value == word {
                        return Some(i);
                    }
                    if !chain.iter().any(|s| s.edge == edge) && !known.contains(&name) {
                        known.push(name);
                    }
                }
            }
        }
        let (seam, from) = (directed.candidate.file.name.value.clone(), open.from.value.clone());
        findings.error(open.from.at, Problem::OpenFrom { seam, from, known: known.join(", ") });
        None
    }

    fn notch_marks(&self, directed: &Directed, a: &[Span], b: &[Span], findings: &mut Findings) -> Vec<(f64, f64)> {
        let [on_a, on_b] = matched(&self.cut.pieces, a, b);
        let candidate = &directed.candidate;
        let (few, many) = (on_a.len().min(on_b.len()), on_a.len().max(on_b.len()));
        if few < many {
            let text = |chain: &[super::select::ReferenceSpans]| {
                chain.iter().map(|r| r.text.as_str()).collect::<Vec<_>>().join(" + ")
            };
            let (mut edge, mut other) = (text(&candidate.a), text(&candidate.b));
            if on_a.len() < on_b.len() {
                std::mem::swap(&mut edge, &mut other);
            }
            findings.error(candidate.file.name.at, Problem::NotchAlone { notch: few + 1, edge, other });
        }
        let mut marks = vec![(0.0, 0.0)];
        on_a.iter().zip(&on_b).for_each(|(a, b)| add_mark(&mut marks, (a.along, b.along)));
        let ends = (length(a), length(b));
        marks.retain(|m| m.0 < ends.0 - 1e-6 && m.1 < ends.1 - 1e-6);
        marks.push(ends);
        marks
    }
}

/// The name without side and part number: `waist` for `waist.2.L`.
pub(super) fn base_name(name: &str) -> &str {
    name.split('.').next().unwrap_or(name)
}

/// The chain between two lengths along it.
fn clipped(chain: &[Span], from: f64, to: f64) -> Vec<Span> {
    let mut kept = Vec::new();
    let mut done = 0.0;
    for span in chain {
        let long = span.length();
        let (a, b) = ((from - done).clamp(0.0, long), (to - done).clamp(0.0, long));
        let position = |x: f64| span.from + (span.to - span.from) * (x / long);
        if b - a > 1e-9 {
            kept.push(Span { edge: span.edge, from: position(a), to: position(b) });
        }
        done += long;
    }
    kept
}

fn check_lengths(candidate: &Candidate, lengths: (f64, f64), give: Give, tolerance: f64, findings: &mut Findings) {
    let (la, lb) = lengths;
    let apart = difference(la, lb, give);
    let allowed = match give {
        Give::Gather(_) | Give::Stretch(_) => tolerance.max(RATIO_ROUNDING * lb),
        Give::Even | Give::Ease(_) => tolerance,
    };
    if apart.abs() <= allowed + 1e-9 {
        return;
    }
    let text =
        |chain: &[super::select::ReferenceSpans]| chain.iter().map(|r| r.text.as_str()).collect::<Vec<_>>().join(" + ");
    let file = candidate.file;
    findings.error(
        file.name.at,
        Problem::LengthsApart {
            seam: file.name.value.clone(),
            sides: format!(
                "{} {:.1} mm, {} {:.1} mm{}",
                text(&candidate.a),
                la * 1e3,
                text(&candidate.b),
                lb * 1e3,
                as_ratio(la, lb, give)
            ),
            apart: apart.abs() * 1e3,
            advice: advice(la, lb, give),
            tolerance: allowed * 1e3,
        },
    );
}

/// Checks that a gathered or stretched chain gives a ratio above 1, whatever is wrong with the lengths.
fn check_ratios(file: &SeamFile, findings: &mut Findings) {
    if let Some(ratio) = file.gather.as_ref().filter(|ratio| ratio.value < 1.0) {
        let percent = (1.0 / ratio.value - 1.0) * 100.0;
        findings.error(ratio.at, Problem::GatherBelowOne { ratio: ratio.value, percent });
    }
    if let Some(ratio) = file.stretch.as_ref().filter(|ratio| ratio.value < 1.0) {
        findings.error(ratio.at, Problem::StretchBelowOne { ratio: ratio.value });
    }
}

/// The ratio of the lengths beside the given one, and the length of the second chain that it would mean.
fn as_ratio(la: f64, lb: f64, give: Give) -> String {
    let (word, ratio) = match give {
        Give::Gather(ratio) => ("gather", ratio),
        Give::Stretch(ratio) => ("stretch", ratio),
        Give::Even | Give::Ease(_) => return String::new(),
    };
    let (one, other, asked) = (la * 1e3, lb * 1e3, la / ratio * 1e3);
    format!("; {one:.1} / {other:.1} is {:.3}, and {word}: {ratio} asks for {one:.1} mm on {asked:.1} mm", la / lb)
}

/// A statement that would fit a seam of these lengths: ease if possible, else gathers of the longer side.
fn fitting(la: f64, lb: f64) -> String {
    if (lb - la).abs() < NO_EASE {
        "no ease".to_owned()
    } else if (lb - la).abs() <= LARGEST_EASE * la {
        format!("ease: {:.1} mm", (lb - la) * 1e3)
    } else if la > lb {
        format!("gather: {:.2}", la / lb)
    } else {
        format!("gather: {:.2} with 'sew' and 'to' swapped", lb / la)
    }
}

fn advice(la: f64, lb: f64, give: Give) -> String {
    match give {
        Give::Ease(_) => format!("say {} or fix the outline", fitting(la, lb)),
        // What is sewn is the longer one.
        Give::Gather(_) if la < lb => format!("swap sew and to and say gather: {:.3}, or fix the outline", lb / la),
        Give::Stretch(_) if la < lb => format!("swap sew and to and say stretch: {:.3}, or fix the outline", lb / la),
        Give::Gather(_) => format!("say gather: {:.3} or fix the outline", la / lb),
        Give::Stretch(_) => format!("say stretch: {:.3} or fix the outline", la / lb),
        Give::Even if (lb - la).abs() <= LARGEST_EASE * la => format!("add {} or fix the outline", fitting(la, lb)),
        Give::Even if la > lb => format!("add gather: {:.2} or stretch: {:.2}", la / lb, la / lb),
        Give::Even => format!("swap sew and to and add gather: {:.2}", lb / la),
    }
}

/// Every seam keeps or turns the right side. Round a closed band the turns must cancel.
pub(super) fn check_orientable(garment: &Garment, turns: &[bool], at: &[Spot], findings: &mut Findings) {
    // Piece → (representative, whether it is turned against it).
    let mut parent: Vec<(usize, bool)> = (0..garment.pieces.len()).map(|i| (i, false)).collect();
    fn root(parent: &[(usize, bool)], mut i: usize) -> (usize, bool) {
        let mut turned = false;
        while parent[i].0 != i {
            turned ^= parent[i].1;
            i = parent[i].0;
        }
        (i, turned)
    }
    for ((seam, &turn), &spot) in garment.seams.iter().zip(turns).zip(at) {
        for (a, b) in seam.a.iter().flat_map(|a| seam.b.iter().map(move |b| (a, b))) {
            let ((ra, ta), (rb, tb)) = (root(&parent, a.edge.piece), root(&parent, b.edge.piece));
            if ra != rb {
                parent[ra] = (rb, ta ^ tb ^ turn);
            } else if ta ^ tb != turn {
                findings.error(spot, Problem::NonOrientable(seam.name.clone()));
                return;
            }
        }
    }
}
