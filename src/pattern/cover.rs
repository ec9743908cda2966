//! Every stretch of rim is sewn once, or said to be free.

use super::cut::Pieces;
use super::diagnostic::{Findings, Located};
use super::draft::Draft;
use super::file::{ClosureFile, Cut, GarmentFile};
use super::problem::Problem;
use super::reference::piece_of;
use super::rim::{SLIVER, edge_ids, gaps};
use super::seam::Seams;
use super::spelling::glob;
use super::walk::{edge_name, names_of};
use super::{EdgeId, SeamKind, Span};

/// A stretch of an edge and the seam that takes it.
struct Taken {
    from: f64,
    to: f64,
    seam: usize,
}

/// Checks that no stretch is sewn twice, and none forgotten.
pub(super) fn check(file: &GarmentFile, drafts: &[Draft], cut: &Pieces, seams: &Seams, findings: &mut Findings) {
    let names = EdgeNames { drafts, cut };
    let mut lists = Lists { free: names.free(file, findings), forgotten: Vec::new(), forgotten_parts: Vec::new() };
    for edge in edge_ids(&cut.pieces) {
        let taken = taken(edge, seams);
        sewn_twice(file, cut, seams, edge, &taken, findings);
        lists.look_at(edge, &taken, cut, seams);
    }
    let mut forgotten = names_of(&cut.pieces, lists.forgotten);
    forgotten.extend(lists.forgotten_parts);
    if !forgotten.is_empty() {
        let at = file.seams.first().map_or(file.version.at, |s| s.name.at);
        findings.error(at, Problem::NeitherSewnNorFree(forgotten.join(", ")));
    }
}

fn taken(edge: EdgeId, seams: &Seams) -> Vec<Taken> {
    let mut taken = Vec::new();
    for (i, seam) in seams.seams.iter().enumerate() {
        let spans = seam.a.iter().chain(&seam.b).filter(|s| s.edge == edge);
        taken.extend(spans.map(Span::sorted).map(|(from, to)| Taken { from, to, seam: i }));
    }
    taken
}

/// Two seams may share a stretch when layers are caught together: pleats, seams with `layers`, and seams to pieces of
/// another layer.
fn may_share(file: &GarmentFile, cut: &Pieces, seams: &Seams, i: usize) -> bool {
    let seam = &seams.seams[i];
    let layered = seams.written[i].is_some_and(|w| file.seams[w].layers.is_some());
    let mut layers = seam.a.iter().chain(&seam.b).map(|s| cut.pieces[s.edge.piece].layer);
    let first = layers.next();
    matches!(seam.kind, SeamKind::Pleat(_)) || layered || layers.any(|l| Some(l) != first)
}

fn sewn_twice(file: &GarmentFile, cut: &Pieces, seams: &Seams, edge: EdgeId, taken: &[Taken], findings: &mut Findings) {
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

struct Lists {
    /// Edges the file lists as free.
    free: Vec<EdgeId>,
    /// Edges neither sewn nor free.
    forgotten: Vec<EdgeId>,
    /// Ranges of edges of which the rest is sewn.
    forgotten_parts: Vec<String>,
}

impl Lists {
    fn look_at(&mut self, edge: EdgeId, taken: &[Taken], cut: &Pieces, seams: &Seams) {
        if self.free.contains(&edge) {
            return;
        }
        let opened = seams.open.iter().filter(|s| s.edge == edge).map(Span::sorted);
        let length = cut.pieces[edge.piece].loops[edge.ring][edge.index].path.length();
        let covered = taken.iter().map(|t| (t.from, t.to)).chain(opened).collect();
        for (from, to) in gaps(covered, length) {
            if to - from > length - SLIVER {
                self.forgotten.push(edge);
            } else {
                let name = edge_name(&cut.pieces, edge);
                self.forgotten_parts.push(format!("{name}@{:.0}..{:.0}", from * 1e3, to * 1e3));
            }
        }
    }
}

struct EdgeNames<'a> {
    drafts: &'a [Draft],
    cut: &'a Pieces,
}

impl EdgeNames<'_> {
    /// The edges that `free` lists.
    fn free(&self, file: &GarmentFile, findings: &mut Findings) -> Vec<EdgeId> {
        let mut free = Vec::new();
        for pattern in &file.free {
            let found = self.matching(&pattern.value);
            if found.is_empty() {
                findings.error(pattern.at, self.nothing(&pattern.value));
            }
            free.extend(found);
        }
        free
    }

    /// The cut edges whose name, with or without a side, matches.
    fn matching(&self, pattern: &str) -> Vec<EdgeId> {
        let mut found = Vec::new();
        for instance in &self.cut.instances {
            let draft = &self.drafts[instance.draft];
            let side = match (instance.side, instance.copy) {
                (Some(side), _) => side.letter().to_owned(),
                (None, Some(copy)) => copy.to_string(),
                (None, None) => String::new(),
            };
            for named in &draft.named {
                let plain = format!("{}.{}", draft.name, named.name);
                let sided = [format!("{}.{side}.{}", draft.name, named.name), format!("{plain}.{side}")];
                if glob(pattern, &plain) || (!side.is_empty() && sided.iter().any(|name| glob(pattern, name))) {
                    found.extend(named.parts.iter().filter_map(|p| instance.edge(p.edge)));
                }
            }
        }
        found
    }

    fn nothing(&self, pattern: &str) -> Problem {
        let folded = |draft: &&Draft| {
            let edge = draft.fold.map(|f| format!("{}.{}", draft.name, draft.rings[0][f].name));
            edge.filter(|edge| glob(pattern, edge))
        };
        if let Some(edge) = self.drafts.iter().find_map(|draft| folded(&draft)) {
            return Problem::FreeOnFold { pattern: pattern.to_owned(), edge };
        }
        let (piece, _, _) = piece_of(pattern);
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

/// Edges listed free by name, no glob, that a seam takes whole: the list says something else than the seams.
pub(super) fn check_free_but_sewn(
    file: &GarmentFile,
    drafts: &[Draft],
    cut: &Pieces,
    seams: &Seams,
    findings: &mut Findings,
) {
    let names = EdgeNames { drafts, cut };
    for pattern in file.free.iter().filter(|p| !p.value.contains('*')) {
        let edges = names.matching(&pattern.value);
        let whole = |edge: &EdgeId| {
            let covered = taken(*edge, seams).iter().map(|t| (t.from, t.to)).collect();
            gaps(covered, cut.pieces[edge.piece].loops[edge.ring][edge.index].path.length()).is_empty()
        };
        if !edges.is_empty()
            && edges.iter().all(whole)
            && let Some(first) = taken(edges[0], seams).first()
        {
            let seam = seams.seams[first.seam].name.clone();
            findings.warn(pattern.at, Problem::FreeButSewn { edge: pattern.value.clone(), seam });
        }
    }
}

/// Whether points of a closure hold the piece to another.
fn is_tacked(file: &GarmentFile, piece: &str) -> bool {
    let carries = |name: &Option<Located<String>>| name.as_ref().is_some_and(|n| piece_of(&n.value).0 == piece);
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
        if draft.cut == Cut::Pair {
            let at = file.pieces.iter().find(|p| p.name.value == draft.name).and_then(|p| p.cut.as_ref());
            findings.error(at.map_or(draft.at, |c| c.at), Problem::PairUnsewn(draft.name.clone()));
        } else {
            findings.warn(draft.at, Problem::PieceUnsewn(draft.name.clone()));
        }
    }
}
