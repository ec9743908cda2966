//! Parts of edges that no seam takes.

use super::{EdgeId, Garment, Piece, Seam, Span};

/// Length of a free stretch below which it is rounding and no opening, metres.
pub(super) const SLIVER: f64 = 1e-3;

/// Parts of edges that no seam takes, divided where something is `fastened`: edges, and metres from their starts. Two
/// layers that are sewn on each other the same way round and to nothing else, as a lining all round its shell, end
/// there, and the outer one's edge is a rim.
pub(super) fn free_spans(garment: &Garment, fastened: &[(EdgeId, f64)]) -> Vec<Span> {
    let ending: Vec<&Span> = garment.seams.iter().filter_map(|s| ending(garment, s)).flatten().collect();
    let is_taken = |span: &&Span| !ending.iter().any(|e| std::ptr::eq(*e, *span));
    let mut free: Vec<Span> = Vec::new();
    for edge in edge_ids(&garment.pieces) {
        let all = garment.seams.iter().flat_map(|s| s.a.iter().chain(&s.b));
        let spans = all.filter(|s| s.edge == edge).filter(is_taken);
        let taken = spans.map(Span::sorted).collect();
        let gaps = gaps(taken, garment.pieces[edge.piece].loops[edge.ring][edge.index].path.length());
        let mut cuts: Vec<f64> = fastened.iter().filter(|(on, _)| *on == edge).map(|(_, at)| *at).collect();
        cuts.sort_by(f64::total_cmp);
        for (mut from, to) in gaps {
            for &at in &cuts {
                if at - from > SLIVER && to - at > SLIVER {
                    free.push(Span { edge, from, to: at });
                    from = at;
                }
            }
            free.push(Span { edge, from, to });
        }
    }
    free
}

/// The outer chain of a seam along which both layers end.
fn ending<'g>(garment: &'g Garment, seam: &'g Seam) -> Option<&'g [Span]> {
    let with = |chain: &[Span]| chain.first().map(|s| s.to > s.from);
    let overlap = |s: &Span, t: &Span| {
        let ((a, b), (c, d)) = (s.sorted(), t.sorted());
        s.edge == t.edge && b.min(d) - a.max(c) > SLIVER
    };
    let others = || garment.seams.iter().filter(|other| !std::ptr::eq(*other, seam));
    let is_shared = |s: &Span| others().any(|other| other.a.iter().chain(&other.b).any(|t| overlap(s, t)));
    if with(&seam.a) != with(&seam.b) || seam.a.iter().chain(&seam.b).any(is_shared) {
        return None;
    }
    let layer = |chain: &[Span]| chain.first().map(|s| garment.pieces[s.edge.piece].layer);
    Some(if layer(&seam.b) > layer(&seam.a) { &seam.b } else { &seam.a })
}

/// The parts of `0..length` that the intervals leave.
pub(super) fn gaps(mut taken: Vec<(f64, f64)>, length: f64) -> Vec<(f64, f64)> {
    taken.sort_by(|a, b| a.0.total_cmp(&b.0));
    taken.push((length, length));
    let mut left = Vec::new();
    let mut at = 0.0;
    for (from, to) in taken {
        if from - at > SLIVER {
            left.push((at, from));
        }
        at = to.max(at);
    }
    left
}

/// Every edge of every piece.
pub(super) fn edge_ids(pieces: &[Piece]) -> Vec<EdgeId> {
    let mut all = Vec::new();
    for (piece, p) in pieces.iter().enumerate() {
        for (ring, edges) in p.loops.iter().enumerate() {
            all.extend((0..edges.len()).map(|index| EdgeId { piece, ring, index }));
        }
    }
    all
}
