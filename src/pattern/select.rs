//! Selects the edges of cut pieces that a seam joins.
//!
//! A reference without a side to a piece that has two sides means both: if every reference of a seam is of that kind,
//! the seam is there twice, `side.L` and `side.R`. Joined with a piece that is there once, an edge of a folded piece
//! that ends on the fold means the whole edge across both halves. Any other must name its side.

use super::Span;
use super::cut::{Instance, Pieces, suffix};
use super::diagnostic::Findings;
use super::draft::Draft;
use super::file::SeamFile;
use super::inherit::unknown_piece;
use super::problem::Problem;
use super::reference::Reference;
use super::value::{CutKind, Side, Unit};

/// The spans of one reference, in the direction of the outline.
#[derive(Clone, Debug)]
pub(super) struct ReferenceSpans {
    /// `front.side`, as written.
    pub(super) text: String,
    pub(super) spans: Vec<Span>,
}

/// A seam before its direction is known.
#[derive(Clone, Debug)]
pub(super) struct Candidate<'a> {
    pub(super) file: &'a SeamFile,
    /// With the side: `side.L`.
    pub(super) name: String,
    pub(super) a: Vec<ReferenceSpans>,
    pub(super) b: Vec<ReferenceSpans>,
    /// Whether the first chain should rather be walked with the outline: as the first edge was drawn.
    pub(super) with: bool,
}

/// A reference whose edge was found.
struct FoundEdge {
    reference: Reference,
    draft: usize,
    from: f64,
    to: f64,
}

/// The pieces that a reference may mean.
#[derive(Clone, Copy, PartialEq)]
enum Freedom {
    Fixed,
    Sides,
    Copies(usize),
}

#[derive(Clone, Copy)]
enum Choice {
    Fixed,
    Side(Side),
    Copy(usize),
}

/// The pieces from which seams choose their edges.
pub(super) struct Source<'a> {
    pub(super) drafts: &'a [Draft],
    pub(super) cut: &'a Pieces,
    pub(super) unit: Unit,
    /// The names of all pieces of the file, also of those that could not be drawn.
    pub(super) pieces: Vec<&'a str>,
}

impl Source<'_> {
    /// Whether the file has a piece of this name which could not be drawn.
    fn is_undrawn(&self, piece: &str) -> bool {
        self.pieces.contains(&piece) && !self.drafts.iter().any(|d| d.name == piece)
    }

    /// Whether a seam names a piece that could not be drawn.
    pub(super) fn names_undrawn(&self, seam: &SeamFile) -> bool {
        seam.sew.iter().chain(&seam.to).any(|r| self.is_undrawn(super::reference::piece_of(&r.value)))
    }

    /// Checks the references of a seam that names a piece that could not be drawn. Of that piece only the name is
    /// known.
    pub(super) fn check_references(&self, seam: &SeamFile, findings: &mut Findings) {
        let sides = [&seam.sew, &seam.to].into_iter().filter(|side| !is_mirror(side));
        for written in sides.flatten() {
            let known = |r: Reference| if self.is_undrawn(&r.piece) { Ok(()) } else { self.find(seam, r).map(|_| ()) };
            if let Err(problem) = Reference::parse(written).and_then(known) {
                findings.error(written.at, problem);
            }
        }
    }

    /// The seams a seam of the file stands for: none (on the fold, or wrong), one, or one per side or copy.
    pub(super) fn candidates<'f>(&self, seam: &'f SeamFile, findings: &mut Findings) -> Vec<Candidate<'f>> {
        let mirror = is_mirror(&seam.to);
        let before = findings.errors();
        let a = self.find_all(seam, &seam.sew, findings);
        let b = if mirror { Vec::new() } else { self.find_all(seam, &seam.to, findings) };
        if findings.errors() > before {
            return Vec::new();
        }
        let built = if mirror { self.mirrored(seam, &a) } else { self.matched(seam, &a, &b) };
        built.unwrap_or_else(|(at, problem)| {
            findings.error(at, problem);
            Vec::new()
        })
    }

    fn find_all(&self, seam: &SeamFile, chain: &[super::Located<String>], findings: &mut Findings) -> Vec<FoundEdge> {
        let mut found = Vec::new();
        for written in chain {
            match Reference::parse(written).and_then(|r| self.find(seam, r)) {
                Ok(f) => found.push(f),
                Err(problem) => findings.error(written.at, problem),
            }
        }
        found
    }

    fn find(&self, seam: &SeamFile, reference: Reference) -> Result<FoundEdge, Problem> {
        let draft = self.drafts.iter().position(|d| d.name == reference.piece);
        let draft = draft.ok_or_else(|| unknown_piece(&reference.piece, self.pieces.iter().copied()))?;
        let drawn = &self.drafts[draft];
        let edge = drawn.find(&reference.edge).ok_or_else(|| drawn.unknown_edge(&reference.edge))?;
        let (mut from, mut to) = (0.0, edge.length);
        if let Some(range) = reference.range {
            let user = || format!("seam '{}'", seam.name.value);
            [from, to] = edge.range(range, self.unit, &reference.text, user)?;
        }
        if edge.stretches(from, to).is_empty() {
            return Err(Problem::RangeEmpty(reference.text));
        }
        Ok(FoundEdge { reference, draft, from, to })
    }

    fn freedom(&self, found: &FoundEdge) -> Freedom {
        match self.drafts[found.draft].cut {
            CutKind::Pair | CutKind::Fold(_) if found.reference.side.is_none() => Freedom::Sides,
            CutKind::Count(n) if found.reference.copy.is_none() => Freedom::Copies(n),
            _ => Freedom::Fixed,
        }
    }

    fn matched<'f>(&self, seam: &'f SeamFile, a: &[FoundEdge], b: &[FoundEdge]) -> Built<'f> {
        let freedoms: Vec<Freedom> = a.iter().chain(b).map(|f| self.freedom(f)).collect();
        let alike = freedoms.windows(2).all(|w| w[0] == w[1]);
        let choices = match freedoms.first() {
            Some(Freedom::Sides) if alike => vec![Choice::Side(Side::Left), Choice::Side(Side::Right)],
            Some(&Freedom::Copies(n)) if alike => (1..=n).map(Choice::Copy).collect(),
            _ => vec![Choice::Fixed],
        };
        let mut built = Vec::new();
        for choice in choices {
            let suffix = match choice {
                Choice::Fixed => String::new(),
                Choice::Side(side) => suffix(Some(side), None),
                Choice::Copy(copy) => suffix(None, Some(copy)),
            };
            let (with, runs_a) = self.runs(seam, a, choice).map_err(|e| self.or_a_pair(e, b))?;
            let (_, runs_b) = self.runs(seam, b, choice).map_err(|e| self.or_a_pair(e, a))?;
            let name = format!("{}{suffix}", seam.name.value);
            built.push(Candidate { file: seam, name, a: runs_a, b: runs_b, with });
        }
        Ok(built)
    }

    /// Adds the doubt that the partner of an edge on both sides should be a pair.
    fn or_a_pair(&self, (at, mut problem): Located, other: &[FoundEdge]) -> Located {
        if let Problem::WhichSide { choice, .. } = &mut problem
            && let [FoundEdge { draft, .. }] = other
            && self.drafts[*draft].cut == CutKind::One
        {
            choice.push_str(&format!(", or cut '{}' as a pair (cut: pair)", self.drafts[*draft].name));
        }
        (at, problem)
    }

    /// The runs of a chain, and whether its first edge runs as drawn.
    fn runs(
        &self,
        seam: &SeamFile,
        chain: &[FoundEdge],
        choice: Choice,
    ) -> Result<(bool, Vec<ReferenceSpans>), Located> {
        let mut runs = Vec::new();
        let mut with = true;
        for (i, found) in chain.iter().enumerate() {
            let instances = self.instances(seam, found, choice).map_err(|p| (found.reference.at, p))?;
            if i == 0 {
                with = !instances[0].mirrored;
            }
            let mut spans = Vec::new();
            for instance in instances {
                spans.extend(self.spans(seam, found, instance).map_err(|p| (found.reference.at, p))?);
            }
            runs.push(ReferenceSpans { text: found.reference.text.clone(), spans });
        }
        Ok((with, runs))
    }

    /// The pieces or halves a reference means, in the order of the outline.
    fn instances(&self, seam: &SeamFile, found: &FoundEdge, choice: Choice) -> Result<Vec<&Instance>, Problem> {
        let reference = &found.reference;
        let drawn = &self.drafts[found.draft];
        let (side, copy) = match (self.freedom(found), choice) {
            (Freedom::Fixed, _) => (reference.side, reference.copy),
            (_, Choice::Side(side)) => (Some(side), None),
            (_, Choice::Copy(copy)) => (None, Some(copy)),
            (Freedom::Sides, Choice::Fixed) => return self.across_fold(seam, found),
            (Freedom::Copies(count), Choice::Fixed) => {
                let (reference, choice) = (reference.text.clone(), format!("{0}.1 to {0}.{count}", drawn.name));
                return Err(Problem::WhichCopy { seam: seam.name.value.clone(), reference, choice, count });
            }
        };
        let is_it = |i: &&Instance| i.draft == found.draft && i.side == side && i.copy == copy;
        let instance = self.cut.instances.iter().find(is_it);
        instance.map(|i| vec![i]).ok_or_else(|| self.cut.not_cut(&reference.text, found.draft, drawn))
    }

    /// Both halves of an edge that ends on the fold.
    fn across_fold(&self, seam: &SeamFile, found: &FoundEdge) -> Result<Vec<&Instance>, Problem> {
        let (drawn, reference) = (&self.drafts[found.draft], &found.reference);
        let halves: Vec<&Instance> = self.cut.instances.iter().filter(|i| i.draft == found.draft).collect();
        let count = drawn.rings[0].len();
        let parts = drawn.find(&reference.edge).map_or(&[][..], |n| &n.parts);
        if let (Some(fold), Some(first), Some(last), None) = (drawn.fold, parts.first(), parts.last(), reference.range)
            && first.edge.0 == 0
        {
            if (last.edge.1 + 1) % count == fold {
                return Ok(halves);
            }
            if (fold + 1) % count == first.edge.1 {
                return Ok(halves.into_iter().rev().collect());
            }
        }
        let named = |side: Side| format!("{}{}.{}", drawn.name, side.suffix(), reference.edge);
        Err(Problem::WhichSide {
            seam: seam.name.value.clone(),
            reference: reference.text.clone(),
            choice: format!("{} or {}", named(Side::Left), named(Side::Right)),
        })
    }

    fn spans(&self, seam: &SeamFile, found: &FoundEdge, on: &Instance) -> Result<Vec<Span>, Problem> {
        let drawn = &self.drafts[found.draft];
        let stretches = drawn.find(&found.reference.edge).map(|n| n.stretches(found.from, found.to));
        let spans: Option<Vec<Span>> = stretches.unwrap_or_default().into_iter().map(|s| on.span(drawn, s)).collect();
        let spans = spans.ok_or_else(|| Problem::OnFold {
            seam: seam.name.value.clone(),
            reference: found.reference.text.clone(),
        })?;
        Ok(if on.mirrored { turned(&spans) } else { spans })
    }

    fn mirrored<'f>(&self, seam: &'f SeamFile, chain: &[FoundEdge]) -> Built<'f> {
        for found in chain {
            let drawn = &self.drafts[found.draft];
            if !matches!(drawn.cut, CutKind::Pair | CutKind::Fold(_)) {
                let (seam, piece) = (seam.name.value.clone(), drawn.name.clone());
                return Err((found.reference.at, Problem::NoMirror { seam, piece }));
            }
        }
        // On the fold the cloth goes on: its edge is joined to its mirror image already.
        let on_fold = |f: &FoundEdge| {
            let drawn = &self.drafts[f.draft];
            drawn.fold.is_some_and(|fold| drawn.find(&f.reference.edge).is_some_and(|n| n.parts[0].edge == (0, fold)))
        };
        let Some(first) = chain.first().filter(|_| !chain.iter().all(on_fold)) else { return Ok(Vec::new()) };
        let side = first.reference.side.unwrap_or(self.drafts[first.draft].drawn);
        let (with, a) = self.runs(seam, chain, Choice::Side(side))?;
        let other: Vec<FoundEdge> = chain
            .iter()
            .map(|f| FoundEdge { reference: Reference { side: None, ..f.reference.clone() }, ..*f })
            .collect();
        let (_, b) = self.runs(seam, &other, Choice::Side(side.other()))?;
        Ok(vec![Candidate { file: seam, name: seam.name.value.clone(), a, b, with }])
    }
}

/// Whether a seam's second chain is the other half of the first.
pub(super) fn is_mirror(chain: &[super::Located<String>]) -> bool {
    matches!(chain, [to] if to.value == "mirror")
}

type Located = (super::Spot, Problem);
type Built<'f> = Result<Vec<Candidate<'f>>, Located>;

/// Spans walked the other way.
pub(super) fn turned(spans: &[Span]) -> Vec<Span> {
    spans.iter().rev().map(|s| Span { edge: s.edge, from: s.to, to: s.from }).collect()
}
