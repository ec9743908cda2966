//! The marks on the edges of a piece that is cut in two, and the references to these edges.

use super::Fault;
use super::sheet::{AlteredPiece, length_in};
use crate::geometry::{Path, Vec2};
use crate::pattern::{
    AllowanceFile, DartShape, Findings, GarmentFile, Located, PieceFile, Problem, Quantity, Words, expand, glob,
};

/// Places along a line or hole at which it is asked on which side of the cut it lies.
const PLACES: usize = 64;
/// Places nearer to an end of a stretch are at it, metres.
const NEAR: f64 = 1e-7;

/// An edge of a part: its name, its course and, unless it is the cut, the old edge and its stretch.
pub(super) type PartEdge = (String, Path, Option<(usize, [f64; 2])>);

/// An edge of the piece that was cut, and the stretches that are left of it in order: piece and edge.
struct Stretches {
    edge: String,
    now: Vec<[String; 2]>,
}

/// A piece that was cut, with the edges that are no longer what they were.
pub(super) struct Parted {
    piece: String,
    changed: Vec<Stretches>,
}

impl Parted {
    pub(super) fn new<'p>(
        piece: &str,
        sheet: &AlteredPiece,
        parts: impl Iterator<Item = (&'p str, &'p [PartEdge])> + Clone,
    ) -> Self {
        let stretches = |edge: usize| {
            let of_part = |(own, edges): (&'p str, &'p [PartEdge])| {
                let of_edge = move |(name, _, was): &'p PartEdge| {
                    let (old, [from, _]) = (*was)?;
                    (old == edge).then(|| (from, [own.to_owned(), name.clone()]))
                };
                edges.iter().filter_map(of_edge).collect::<Vec<_>>()
            };
            let mut now: Vec<(f64, [String; 2])> = parts.clone().flat_map(of_part).collect();
            now.sort_by(|a, b| a.0.total_cmp(&b.0));
            Stretches { edge: sheet.names[edge].clone(), now: now.into_iter().map(|n| n.1).collect() }
        };
        let same = |s: &Stretches| matches!(&s.now[..], [[own, edge]] if own == piece && *edge == s.edge);
        let changed = (0..sheet.names.len()).map(stretches).filter(|s| !same(s)).collect();
        Self { piece: piece.to_owned(), changed }
    }

    /// The references that take the place of one. `None` where it stays as it was.
    fn now(&self, text: &Located<String>) -> Result<Option<Vec<Located<String>>>, Fault> {
        let (name, range) = text.value.split_once('@').map_or((text.value.as_str(), None), |(n, r)| (n, Some(r)));
        let Ok(words) = Words::parse(name) else { return Ok(None) };
        let edge = self.changed.iter().find(|s| words.edge.as_ref() == Some(&s.edge));
        let Some(stretches) = edge.filter(|_| words.piece == self.piece) else { return Ok(None) };
        if range.is_some() {
            return Err((text.at, Problem::AlterPart(text.value.clone())));
        }
        let copy = words.copy.map_or_else(String::new, |copy| format!(".{copy}"));
        let side = words.side.map_or("", crate::pattern::Side::suffix);
        let named = |[piece, edge]: &[String; 2]| Located::new(format!("{piece}{copy}.{edge}{side}"), text.at);
        Ok(Some(stretches.now.iter().map(named).collect()))
    }
}

/// Puts the stretches into the place of the edges in seams and in the list of free edges. A chain runs one way or the
/// other along an edge; the way that gives a garment with fewer faults is taken.
pub(super) fn rename(file: &mut GarmentFile, parted: &Parted) -> Result<(), Fault> {
    let mut several = Vec::new();
    for seam in 0..file.seams.len() {
        for second in [false, true] {
            let chain = chain_of(file, seam, second).clone();
            let mut new = Vec::new();
            for text in &chain {
                match parted.now(text)? {
                    None => new.push(text.clone()),
                    Some(now) => {
                        if now.len() > 1 {
                            several.push((seam, second, new.len(), now.len()));
                        }
                        new.extend(now);
                    }
                }
            }
            *chain_of(file, seam, second) = new;
        }
    }
    let mut free = Vec::new();
    for text in &file.free {
        free.extend(parted.now(text)?.unwrap_or_else(|| vec![text.clone()]));
    }
    for stretches in &parted.changed {
        let was = format!("{}.{}", parted.piece, stretches.edge);
        let globs: Vec<Located<String>> =
            file.free.iter().filter(|f| f.value.contains('*') && glob(&f.value, &was)).cloned().collect();
        for [piece, edge] in &stretches.now {
            let name = format!("{piece}.{edge}");
            if let Some(pattern) = globs.first().filter(|_| !globs.iter().any(|g| glob(&g.value, &name))) {
                free.push(Located::new(name, pattern.at));
            }
        }
    }
    file.free = free;
    for (seam, second, from, count) in several {
        let before = faults(file);
        let turn = |file: &mut GarmentFile| chain_of(file, seam, second)[from..from + count].reverse();
        turn(file);
        if before <= faults(file) {
            turn(file);
        }
    }
    Ok(())
}

fn chain_of(file: &mut GarmentFile, seam: usize, second: bool) -> &mut Vec<Located<String>> {
    let seam = &mut file.seams[seam];
    if second { &mut seam.to } else { &mut seam.sew }
}

/// Number of faults of a garment.
fn faults(file: &GarmentFile) -> usize {
    let mut findings = Findings::default();
    let _ = expand("", file, &mut findings);
    findings.errors()
}

/// Leaves to a part of a piece what lies on its edges and inside it.
pub(super) fn share_out(
    piece: &mut PieceFile,
    sheet: &AlteredPiece,
    edges: &[PartEdge],
    inside: &dyn Fn(Vec2) -> bool,
) -> Result<(), Fault> {
    let share = |edge: &str, at: Quantity| place(sheet, edges, edge, at);
    let notches = std::mem::take(&mut piece.notches);
    for (edge, list) in notches {
        for notch in list {
            if let Some((name, at)) = share(&edge.value, notch.value.at) {
                let mut notch = notch;
                notch.value.at = at;
                match piece.notches.iter_mut().find(|n| n.0.value == name) {
                    Some(own) => own.1.push(notch),
                    None => piece.notches.push((Located::new(name, edge.at), vec![notch])),
                }
            }
        }
    }
    let mut darts = Vec::new();
    for mut dart in std::mem::take(&mut piece.darts) {
        if let DartShape::Edge { edge, at, .. } = &mut dart.shape {
            let Some((name, place)) = share(&edge.value, at.value) else { continue };
            (edge.value, at.value) = (name, place);
        }
        darts.push(dart);
    }
    piece.darts = darts;
    let mut pleats = Vec::new();
    for pleat in std::mem::take(&mut piece.pleats) {
        for at in &pleat.at {
            let Some((name, place)) = share(&pleat.edge.value, at.value) else { continue };
            let mut own = pleat.clone();
            (own.edge.value, own.at) = (name, vec![Located::new(place, at.at)]);
            own.toward = own.toward.filter(|toward| edges.iter().any(|e| e.0 == toward.value));
            pleats.push(own);
        }
    }
    piece.pleats = pleats;
    if let Some(AllowanceFile::Edges(widths)) = &mut piece.allowance {
        let old = std::mem::take(widths);
        for (name, width) in old {
            let edge = sheet.names.iter().position(|n| *n == name.value);
            let own = edges.iter().filter(|e| e.2.is_some_and(|(was, _)| Some(was) == edge));
            widths.extend(own.map(|e| (Located::new(e.0.clone(), name.at), width)));
        }
        if widths.is_empty() {
            piece.allowance = None;
        }
    }
    runs(piece, sheet, inside)
}

/// The edge of a part, and the place on it, of a place on an old edge. `None` where that is on the other part.
fn place(sheet: &AlteredPiece, edges: &[PartEdge], edge: &str, at: Quantity) -> Option<(String, Quantity)> {
    let old = sheet.names.iter().position(|n| n == edge)?;
    let length = sheet.edges[old].length();
    let s = if at.is_percent() { at.value(sheet.unit) * length } else { at.value(sheet.unit) };
    let holds = |e: &&PartEdge| {
        e.2.is_some_and(|(was, [from, to])| was == old && (s > from + NEAR || from == 0.0) && s <= to + NEAR)
    };
    let (name, _, was) = edges.iter().find(holds)?;
    let (_, [from, to]) = (*was)?;
    let whole = from == 0.0 && to >= length;
    Some((name.clone(), if whole { at } else { length_in(s - from, at.unit, sheet.unit) }))
}

/// Leaves to a part the holes and lines that lie in it.
fn runs(piece: &mut PieceFile, sheet: &AlteredPiece, inside: &dyn Fn(Vec2) -> bool) -> Result<(), Fault> {
    let holes = piece.holes.len();
    let mut own = Vec::new();
    for (i, run) in sheet.runs.iter().enumerate() {
        // Its ends may lie on the rim.
        let at = |k: usize| run.point(run.length() * (k as f64 + 0.5) / PLACES as f64);
        let within = (0..PLACES).filter(|&k| inside(at(k))).count();
        let (name, at) = match i < holes {
            true => (&piece.holes[i].0.value, piece.holes[i].1.at),
            false => (&piece.lines[i - holes].name.value, piece.lines[i - holes].path.at),
        };
        if within != 0 && within != PLACES {
            let reason = format!("the style line crosses '{name}'; cut elsewhere, or leave that out first");
            return Err((at, Problem::AlterShape { piece: sheet.piece.clone(), reason }));
        }
        own.push(within > 0);
    }
    let mut kept = own.iter();
    piece.holes.retain(|_| *kept.next().unwrap_or(&true));
    piece.lines.retain(|_| *kept.next().unwrap_or(&true));
    Ok(())
}
