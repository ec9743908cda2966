//! Every stretch of rim is sewn once, or said to be free.

use std::collections::HashSet;

use super::cut::{Instance, Pieces};
use super::diagnostic::{Findings, Located, Spot};
use super::draft::{Draft, DrawnStretch, NamedEdge, spot_of};
use super::edge_name::{edge_name, names_of, written_edge};
use super::file::{ClosureFile, GarmentFile, PieceFile};
use super::free::{SLIVER, edge_ids, gaps};
use super::problem::Problem;
use super::reference::{parse_range, piece_of};
use super::seam::Seams;
use super::spelling::glob;
use super::value::{CutKind, Unit};
use super::{EdgeId, Span};

/// A stretch of an edge and the seam that takes it.
struct TakenStretch {
    from: f64,
    to: f64,
    seam: usize,
}

/// Checks that no stretch is sewn twice or forgotten. Stretches of pieces and seams that could not be read are left
/// out, because these have been reported. `pieces` are those of the file with every `like` followed.
pub(super) fn check(
    file: &GarmentFile,
    pieces: &[PieceFile],
    drafts: &[Draft],
    cut: &Pieces,
    seams: &Seams,
    findings: &mut Findings,
) {
    let names = EdgeNames { drafts, cut, unit: file.unit() };
    let free = names.free(file, findings);
    let unread = names.of_unread(file, seams);
    let mut lists = Lists { free, names: &names, forgotten: Vec::new(), forgotten_parts: Vec::new() };
    for edge in edge_ids(&cut.pieces) {
        let taken = taken(edge, seams);
        sewn_twice(file, cut, seams, edge, &taken, findings);
        if !unread.contains(&edge) {
            lists.look_at(edge, &taken, cut, seams);
        }
    }
    let (parts, names_of_parts): (Vec<EdgeId>, Vec<String>) = lists.forgotten_parts.into_iter().unzip();
    if let Some(&first) = lists.forgotten.iter().chain(&parts).min() {
        let forgotten = [names_of(&cut.pieces, lists.forgotten), names_of_parts].concat();
        let at = drawn_at(first, cut, pieces).unwrap_or(file.version.at);
        findings.error(at, Problem::NeitherSewnNorFree(forgotten.join(", ")));
    }
}

/// Place in the file of a cut edge.
fn drawn_at(edge: EdgeId, cut: &Pieces, pieces: &[PieceFile]) -> Option<Spot> {
    let piece = &cut.pieces[edge.piece];
    let name = written_edge(&piece.loops[edge.ring][edge.index].name);
    pieces.iter().find(|p| p.name.value == piece.drawn_as).map(|p| spot_of(&name, p))
}

fn taken(edge: EdgeId, seams: &Seams) -> Vec<TakenStretch> {
    let mut taken = Vec::new();
    for (i, seam) in seams.seams.iter().enumerate() {
        let spans = seam.a.iter().chain(&seam.b).filter(|s| s.edge == edge);
        taken.extend(spans.map(Span::sorted).map(|(from, to)| TakenStretch { from, to, seam: i }));
    }
    taken
}

/// Two seams may share a stretch when layers are caught together: pleats, seams with `layers`, and seams to pieces of
/// another layer.
fn may_share(file: &GarmentFile, cut: &Pieces, seams: &Seams, i: usize) -> bool {
    seams.written[i].is_some_and(|w| file.seams[w].layers.is_some()) || seams.seams[i].is_lapped(&cut.pieces)
}

fn sewn_twice(
    file: &GarmentFile,
    cut: &Pieces,
    seams: &Seams,
    edge: EdgeId,
    taken: &[TakenStretch],
    findings: &mut Findings,
) {
    for (i, one) in taken.iter().enumerate() {
        for other in &taken[..i] {
            let (from, to) = (one.from.max(other.from), one.to.min(other.to));
            let (first, second) = (other.seam.min(one.seam), other.seam.max(one.seam));
            if to - from < SLIVER || [first, second].iter().any(|&s| may_share(file, cut, seams, s)) {
                continue;
            }
            let at = [second, first].iter().find_map(|&s| seams.written[s]).map(|w| file.seams[w].name.at);
            findings.error(
                at.unwrap_or(file.version.at),
                Problem::SewnTwice {
                    edge: edge_name(&cut.pieces, edge),
                    from: from * 1e3,
                    to: to * 1e3,
                    first: seams.seams[first].name.clone(),
                    second: seams.seams[second].name.clone(),
                },
            );
            return;
        }
    }
}

struct Lists<'a> {
    /// Edges that the file lists as free.
    free: Vec<Span>,
    names: &'a EdgeNames<'a>,
    /// Edges neither sewn nor free.
    forgotten: Vec<EdgeId>,
    /// Ranges of edges of which the rest is sewn.
    forgotten_parts: Vec<(EdgeId, String)>,
}

impl Lists<'_> {
    fn look_at(&mut self, edge: EdgeId, taken: &[TakenStretch], cut: &Pieces, seams: &Seams) {
        let said = seams.open.iter().chain(&self.free).filter(|s| s.edge == edge).map(Span::sorted);
        let length = length(cut, edge);
        let covered = taken.iter().map(|t| (t.from, t.to)).chain(said).collect();
        for (from, to) in gaps(covered, length) {
            if to - from > length - SLIVER {
                self.forgotten.push(edge);
            } else {
                let ranges = self.names.ranges(Span { edge, from, to });
                self.forgotten_parts.extend(ranges.into_iter().map(|range| (edge, range)));
            }
        }
    }
}

fn length(cut: &Pieces, edge: EdgeId) -> f64 {
    cut.pieces[edge.piece].loops[edge.ring][edge.index].path.length()
}

struct EdgeNames<'a> {
    drafts: &'a [Draft],
    cut: &'a Pieces,
    unit: Unit,
}

impl EdgeNames<'_> {
    /// The stretches of cut edges that `free` lists.
    fn free(&self, file: &GarmentFile, findings: &mut Findings) -> Vec<Span> {
        let mut free = Vec::new();
        for pattern in &file.free {
            match self.listed(&pattern.value) {
                Ok(spans) => free.extend(spans),
                // It may be of a piece that could not be drawn.
                Err(_) if self.names_undrawn(file, &pattern.value) => {}
                Err(problem) => findings.error(pattern.at, problem),
            }
        }
        free
    }

    /// Whether a name, or one that a glob may stand for, is of a piece that could not be drawn.
    fn names_undrawn(&self, file: &GarmentFile, pattern: &str) -> bool {
        let is_drawn = |piece: &str| self.drafts.iter().any(|d| d.name == piece);
        let mut undrawn = file.pieces.iter().map(|p| p.name.value.as_str()).filter(|piece| !is_drawn(piece));
        undrawn.any(|piece| glob(piece_of(pattern), piece))
    }

    /// The edges that seams name which could not be read: those that are meant, or, where a name fits none, all of the
    /// piece.
    fn of_unread(&self, file: &GarmentFile, seams: &Seams) -> HashSet<EdgeId> {
        let unread = file.seams.iter().enumerate().filter(|(i, _)| !seams.written.contains(&Some(*i)));
        let mut edges = HashSet::new();
        for named in unread.flat_map(|(_, seam)| seam.sew.iter().chain(&seam.to)) {
            let name = named.value.split('@').next().unwrap_or_default().trim_end();
            let mut found = self.matching(name);
            if found.is_empty() {
                found = self.matching(&format!("{}.*", piece_of(name)));
            }
            let of = |(instance, named): (&Instance, &NamedEdge)| -> Vec<EdgeId> {
                named.parts.iter().filter_map(|p| instance.edge(p.edge)).collect()
            };
            edges.extend(found.into_iter().flat_map(of));
        }
        edges
    }

    /// Spans listed by `front.hem`, `*.hem` or `front.hem@0..50`. The list is never empty.
    fn listed(&self, pattern: &str) -> Result<Vec<Span>, Problem> {
        let (name, range) = match pattern.split_once('@') {
            Some((name, range)) => {
                (name.trim_end(), Some(parse_range(range, || Problem::BadReference(pattern.into()))?))
            }
            None => (pattern, None),
        };
        let mut spans = Vec::new();
        for (instance, named) in self.matching(name) {
            let Some(range) = range else {
                let whole = |edge: EdgeId| Span { edge, from: 0.0, to: length(self.cut, edge) };
                spans.extend(named.parts.iter().filter_map(|p| instance.edge(p.edge)).map(whole));
                continue;
            };
            let [from, to] = named.range(range, self.unit, pattern, || "'free'".to_owned())?;
            let stretches = named.stretches(from, to);
            if stretches.is_empty() {
                return Err(Problem::RangeEmpty(pattern.to_owned()));
            }
            let draft = &self.drafts[instance.draft];
            spans.extend(stretches.into_iter().filter_map(|s| instance.span(draft, s)));
        }
        if spans.is_empty() { Err(self.nothing(name)) } else { Ok(spans) }
    }

    /// The edges as cut whose name, with or without a side, matches.
    fn matching(&self, pattern: &str) -> Vec<(&Instance, &NamedEdge)> {
        let mut found = Vec::new();
        for instance in &self.cut.instances {
            let draft = &self.drafts[instance.draft];
            let suffix = instance.suffix();
            for named in &draft.named {
                let plain = format!("{}.{}", draft.name, named.name);
                let sided = [format!("{}{suffix}.{}", draft.name, named.name), format!("{plain}{suffix}")];
                if glob(pattern, &plain) || sided.iter().any(|name| glob(pattern, name)) {
                    found.push((instance, named));
                }
            }
        }
        found
    }

    /// A stretch of a cut edge as `free` may list it, in the file's unit: `back.waist.R@50..100`, for each part that it
    /// is drawn in.
    fn ranges(&self, span: Span) -> Vec<String> {
        let mut names = Vec::new();
        for instance in self.cut.instances.iter().filter(|i| i.piece == span.edge.piece) {
            let draft = &self.drafts[instance.draft];
            let side = match (&draft.cut, instance.side) {
                (CutKind::Fold(_), Some(side)) => side.suffix(),
                _ => "",
            };
            for named in &draft.named {
                for part in named.parts.iter().filter(|p| instance.edge(p.edge) == Some(span.edge)) {
                    let ends = DrawnStretch { edge: part.edge, from: span.from, to: span.to };
                    let Some(drawn) = instance.span(draft, ends) else { continue };
                    let (from, to) = drawn.sorted();
                    let (from, to) = ((from + part.offset).max(part.from), (to + part.offset).min(part.to));
                    if to - from > SLIVER {
                        let [from, to] = [from, to].map(|at| self.written(at));
                        let piece = &self.cut.pieces[instance.piece].name;
                        names.push(format!("{piece}.{}{side}@{from}..{to}", named.name));
                    }
                }
            }
        }
        names
    }

    /// A position, to a millimetre, in the file's unit.
    fn written(&self, at: f64) -> String {
        let digits = if self.unit == Unit::Millimetre { 0 } else { 2 };
        format!("{:.digits$}", at / self.unit.factor())
    }

    fn nothing(&self, pattern: &str) -> Problem {
        let folded = |draft: &&Draft| {
            let edge = draft.fold.map(|f| format!("{}.{}", draft.name, draft.rings[0][f].name));
            edge.filter(|edge| glob(pattern, edge))
        };
        if let Some(edge) = self.drafts.iter().find_map(|draft| folded(&draft)) {
            return Problem::FreeOnFold { pattern: pattern.to_owned(), edge };
        }
        let piece = piece_of(pattern);
        let draft = self.drafts.iter().find(|d| d.name == piece);
        match (draft, pattern.split_once('.')) {
            (Some(draft), Some((_, edge))) if !pattern.contains('*') => draft.unknown_edge(edge),
            (None, Some(_)) if !pattern.contains('*') => {
                super::inherit::unknown_piece(piece, self.drafts.iter().map(|d| d.name.as_str()))
            }
            _ => Problem::MatchesNothing(pattern.to_owned()),
        }
    }
}

/// Edges and ranges listed free by name, no glob, that seams take whole: the list says something else than the seams.
pub(super) fn check_free_but_sewn(
    file: &GarmentFile,
    drafts: &[Draft],
    cut: &Pieces,
    seams: &Seams,
    findings: &mut Findings,
) {
    let names = EdgeNames { drafts, cut, unit: file.unit() };
    for pattern in file.free.iter().filter(|p| !p.value.contains('*')) {
        let Ok(spans) = names.listed(&pattern.value) else { continue };
        let sewn = |span: &Span| {
            let (from, to) = span.sorted();
            let covered = taken(span.edge, seams).iter().map(|t| (t.from, t.to)).collect();
            gaps(covered, length(cut, span.edge)).iter().all(|gap| gap.1.min(to) - gap.0.max(from) <= SLIVER)
        };
        if spans.iter().all(sewn)
            && let Some(first) = taken(spans[0].edge, seams).first()
        {
            let seam = seams.seams[first.seam].name.clone();
            findings.warn(pattern.at, Problem::FreeButSewn { edge: pattern.value.clone(), seam });
        }
    }
}

/// Whether points of a closure hold the piece to another.
fn is_tacked(file: &GarmentFile, piece: &str) -> bool {
    let carries = |name: &Option<Located<String>>| name.as_ref().is_some_and(|n| piece_of(&n.value) == piece);
    let ties = |c: &&ClosureFile| c.on.is_some() && c.meets.is_some() && !c.at.is_empty();
    file.closures.iter().filter(ties).any(|c| carries(&c.on) || carries(&c.meets))
}

/// A pair that no seam joins is two copies of one piece, and another piece that none joins falls, unless closures hold
/// it or all seams are still to be written.
pub(super) fn check_joined(file: &GarmentFile, drafts: &[Draft], cut: &Pieces, seams: &Seams, findings: &mut Findings) {
    if file.seams.is_empty() {
        return;
    }
    for (i, draft) in drafts.iter().enumerate() {
        let pieces: Vec<usize> = cut.instances.iter().filter(|n| n.draft == i).map(|n| n.piece).collect();
        let mut spans = seams
            .seams
            .iter()
            .zip(&seams.written)
            .filter(|(_, w)| w.is_some())
            .flat_map(|(s, _)| s.a.iter().chain(&s.b));
        if spans.any(|s| pieces.contains(&s.edge.piece)) || is_tacked(file, &draft.name) {
            continue;
        }
        if draft.cut == CutKind::Pair {
            let at = file.pieces.iter().find(|p| p.name.value == draft.name).and_then(|p| p.cut.as_ref());
            findings.error(at.map_or(draft.at, |c| c.at), Problem::PairUnsewn(draft.name.clone()));
        } else {
            findings.warn(draft.at, Problem::PieceUnsewn(draft.name.clone()));
        }
    }
}
