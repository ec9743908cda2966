//! The direction of seams. By default the two chains of a seam run opposite ways round their outlines, which keeps the
//! right side of the sewn garment on one side. `face: same` turns one round. Which of the two ways a chain is walked
//! follows from continuity: each edge must end where the next begins, on one rim or through other seams. Two edges
//! round an opening meet at both ends. A sleeve's own seam then comes to the lower one.

use super::diagnostic::Findings;
use super::draft::shown;
use super::edge_name::names_of;
use super::problem::{ChainDoubt, Problem};
use super::rim::{Identities, Rims, joint_marks};
use super::seam::{marks_between, tolerance};
use super::select::{Candidate, ReferenceSpans, Source, is_mirror, turned};
use super::tube::{EndPlaces, ends, is_tube};
use super::value::Unit;
use super::{EdgeId, Give, Piece, Seam, SeamKind, Span};

/// A candidate with its direction.
pub(super) struct Directed<'a> {
    pub(super) candidate: Candidate<'a>,
    pub(super) a: Vec<Span>,
    pub(super) b: Vec<Span>,
}

/// Inputs of the search.
struct ChainSearch<'p> {
    pieces: &'p [Piece],
    unit: Unit,
    rims: Rims,
    one: Identities,
}

/// Finds the direction of every seam that has one. `source` is what the seams were chosen from, `own` are the seams of
/// darts and pleats.
pub(super) fn direct<'a>(
    candidates: Vec<Candidate<'a>>,
    own: &[Seam],
    source: &Source,
    findings: &mut Findings,
) -> Vec<Directed<'a>> {
    let pieces = &source.cut.pieces;
    let mut table = ChainSearch { pieces, unit: source.unit, rims: Rims::new(pieces), one: Identities::default() };
    for seam in own {
        table.one.add_seam(&table.rims, &seam.a, &seam.b, &joint_marks(seam));
    }
    let before = table.one.clone();
    let mut slots: Vec<Option<Directed>> = candidates.iter().map(|_| None).collect();
    // Seams found in one round may make the chains of the next continuous. Mirrored seams are found in the same round,
    // so both sides of a garment come out alike.
    loop {
        let open: Vec<usize> = (0..slots.len()).filter(|&i| slots[i].is_none()).collect();
        let found: Vec<(usize, Directed)> =
            open.iter().filter_map(|&i| Some((i, table.direction(&candidates[i])?))).collect();
        if found.is_empty() {
            open.iter().for_each(|&i| table.report(&candidates[i], findings));
            break;
        }
        for (i, directed) in found {
            table.add(&directed);
            slots[i] = Some(directed);
        }
    }
    let directed: Vec<Directed> = slots.into_iter().flatten().collect();
    directed.iter().for_each(|seam| table.doubt_tube(seam, findings));
    table.one = before;
    table.check_order(&directed, findings);
    directed
}

fn walked(chain: &[ReferenceSpans], with: bool) -> Vec<Vec<Span>> {
    chain.iter().map(|run| if with { run.spans.clone() } else { turned(&run.spans) }).collect()
}

impl ChainSearch<'_> {
    /// Index of the first run that does not go on into the next.
    fn first_break(&self, chain: &[ReferenceSpans], with: bool) -> Option<usize> {
        let runs = walked(chain, with);
        runs.windows(2).position(|pair| {
            let ends = pair[0].last().zip(pair[1].first());
            !ends.is_some_and(|(end, start)| {
                let (p, q) = (self.rims.point(end.edge, end.to), self.rims.point(start.edge, start.from));
                self.one.one(&self.rims, p, q)
            })
        })
    }

    fn direction<'a>(&self, candidate: &Candidate<'a>) -> Option<Directed<'a>> {
        let readings = self.readings(candidate);
        let upright = readings.iter().position(|seam| self.tube_ends(seam) == Some(EndPlaces::Below));
        // Only where the other one turns the tube over: what lies level may be walked either way.
        let turned = readings.iter().any(|seam| self.tube_ends(seam) == Some(EndPlaces::Above));
        readings.into_iter().nth(upright.filter(|_| turned).unwrap_or(0))
    }

    /// The ways a seam may be walked, the one its edges are drawn in first.
    fn readings<'a>(&self, candidate: &Candidate<'a>) -> Vec<Directed<'a>> {
        let same = candidate.file.is_face_same();
        let reading = |with: bool| {
            let with_b = with == same;
            let whole =
                self.first_break(&candidate.a, with).is_none() && self.first_break(&candidate.b, with_b).is_none();
            whole.then(|| Directed {
                candidate: candidate.clone(),
                a: walked(&candidate.a, with).concat(),
                b: walked(&candidate.b, with_b).concat(),
            })
        };
        [candidate.with, !candidate.with].into_iter().filter_map(reading).collect()
    }

    /// Ends of a tube's own seam on the opening that the tube is sewn into. `None` if there is no tube.
    fn tube_ends(&self, seam: &Directed) -> Option<EndPlaces> {
        let [a, b] = [&seam.a, &seam.b];
        match [a, b].map(|chain| is_tube(chain, &self.rims, &self.one)) {
            [true, false] => Some(ends(self.pieces, b)),
            [false, true] => Some(ends(self.pieces, a)),
            _ => None,
        }
    }

    /// Warns of a tube whose own seam comes to the top of its opening, though that has a foot.
    fn doubt_tube(&self, seam: &Directed, findings: &mut Findings) {
        let readings = self.readings(&seam.candidate);
        let is = |of: EndPlaces| readings.iter().find(|seam| self.tube_ends(seam) == Some(of));
        let (Some(over), None, [_, _]) = (is(EndPlaces::Above), is(EndPlaces::Below), &readings[..]) else { return };
        let a_is_tube = is_tube(&over.a, &self.rims, &self.one);
        let opening = |seam: &Directed| ends(self.pieces, if a_is_tube { &seam.b } else { &seam.a });
        if readings.iter().any(|seam| opening(seam) == EndPlaces::Below) {
            let tube = if a_is_tube { &over.a } else { &over.b };
            let tube = self.pieces[tube[0].edge.piece].drawn_as.clone();
            let seam = seam.candidate.file.name.value.clone();
            findings.warn(over.candidate.file.name.at, Problem::UpsideDown { seam, tube });
        }
    }

    fn add(&mut self, directed: &Directed) {
        let tolerance = tolerance(directed.candidate.file, self.unit);
        let marks = marks_between(&directed.a, &directed.b, tolerance);
        let seam = Seam {
            name: String::new(),
            a: directed.a.clone(),
            b: directed.b.clone(),
            marks,
            give: Give::Even,
            stage: 0,
            kind: SeamKind::Written,
            closure: None,
        };
        self.one.add_seam(&self.rims, &seam.a, &seam.b, &joint_marks(&seam));
    }

    fn report(&self, candidate: &Candidate, findings: &mut Findings) {
        let seam = candidate.file.name.value.clone();
        let chains = [(&candidate.a, &candidate.file.sew), (&candidate.b, &candidate.file.to)];
        for (chain, written) in chains {
            let breaks = [true, false].map(|with| self.first_break(chain, with));
            if let [Some(with), Some(against)] = breaks {
                // The direction that gets further is the one that was meant.
                let (i, meant) = if with >= against { (with, true) } else { (against, false) };
                let at = written.get(i + 1).map_or(candidate.file.name.at, |w| w.at);
                findings.error(at, self.broken(seam, chain, i, meant));
                return;
            }
        }
        let end = |chain: &[ReferenceSpans], last: bool| {
            let run = if last { chain.last() } else { chain.first() };
            run.and_then(|r| r.spans.first()).map_or_else(String::new, |s| names_of(self.pieces, [s.edge]).concat())
        };
        let ends = format!("{} and {}", end(&candidate.a, false), end(&candidate.b, true));
        let to = candidate.b.iter().rev().map(|run| run.text.as_str());
        let turned = (!is_mirror(&candidate.file.to)).then(|| to.collect::<Vec<_>>().join(", "));
        let same = candidate.file.is_face_same();
        findings.error(candidate.file.name.at, Problem::Twisted { seam, ends, turned, same });
    }

    fn broken(&self, seam: String, chain: &[ReferenceSpans], i: usize, with: bool) -> Problem {
        let runs = walked(chain, with);
        let point = |span: Option<&Span>, end: bool| {
            span.map_or_else(String::new, |s| {
                let path = &self.pieces[s.edge.piece].loops[s.edge.ring][s.edge.index].path;
                shown(path.point(if end { s.to } else { s.from }))
            })
        };
        Problem::ChainBroken {
            seam,
            end: format!("{} ends at {}", chain[i].text, point(runs[i].last(), true)),
            start: format!("{} starts at {}", chain[i + 1].text, point(runs[i + 1].first(), false)),
            doubt: runs[i]
                .last()
                .zip(runs[i + 1].first())
                .map_or(ChainDoubt::Order, |(a, b)| self.doubt(a.edge, b.edge)),
        }
    }

    /// Guess at the intention behind two edges that do not follow each other.
    fn doubt(&self, end: EdgeId, start: EdgeId) -> ChainDoubt {
        let side = |edge: EdgeId| {
            let piece = &self.pieces[edge.piece];
            let of_edge = piece.loops[edge.ring][edge.index].name.rsplit_once('.').map(|(_, side)| side);
            (piece.side.is_some(), of_edge.filter(|side| matches!(*side, "L" | "R")))
        };
        let [(one_is_half, one), (other_is_half, other)] = [side(end), side(start)];
        if end.piece != start.piece {
            let half = one_is_half || other_is_half || one.is_some() || other.is_some();
            // Taken for the half of the other side, its seams join it upside down.
            return if half { ChainDoubt::Drawn } else { ChainDoubt::Order };
        }
        if one.is_some() && other.is_some() && one != other { ChainDoubt::Fold } else { ChainDoubt::Order }
    }

    /// Warns of chains that hang together only through seams that are sewn later.
    fn check_order(&mut self, directed: &[Directed], findings: &mut Findings) {
        let stage = |d: &Directed| d.candidate.file.stage.as_ref().map_or(super::seam::DEFAULT_STAGE, |s| s.value);
        let mut order: Vec<usize> = (0..directed.len()).collect();
        order.sort_by_key(|&i| stage(&directed[i]));
        for (at, &i) in order.iter().enumerate() {
            let seam = &directed[i];
            let continuous = |t: &Self| t.direction(&seam.candidate).is_some();
            if !continuous(self) {
                let earlier = self.one.clone();
                let later = order[at..].iter().find(|&&j| {
                    self.add(&directed[j]);
                    j != i && continuous(self)
                });
                if let Some(&j) = later {
                    let (seam_name, later) =
                        (seam.candidate.file.name.value.clone(), directed[j].candidate.file.name.value.clone());
                    findings.warn(seam.candidate.file.name.at, Problem::SeamOrder { seam: seam_name, later });
                }
                self.one = earlier;
            }
            self.add(seam);
        }
    }
}
