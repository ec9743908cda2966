//! Walking the seams: both lengths of each, and what they differ by beyond what was said.

use super::{EdgeId, Garment, Give, Opening, SeamKind, Span};

/// The lengths of one seam, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct SeamWalk {
    /// `side.L`.
    pub name: String,
    /// The first chain: `front.L.side`, several joined by ` + `.
    pub a: String,
    /// The second chain.
    pub b: String,
    /// Length of the first chain.
    pub length_a: f64,
    /// Length of the second chain.
    pub length_b: f64,
    /// How much longer the second is than the first and the seam's ease, gather or stretch make it.
    pub difference: f64,
    /// What is said about the lengths.
    pub give: Give,
    /// Where the seam comes from.
    pub kind: SeamKind,
    /// Notches of the first chain, metres from its start.
    pub notches_a: Vec<f64>,
    /// Notches of the second chain.
    pub notches_b: Vec<f64>,
}

/// Walks every seam of a garment.
pub fn walk(garment: &Garment) -> Vec<SeamWalk> {
    garment
        .seams
        .iter()
        .map(|seam| {
            let (length_a, length_b) = (seam.length_a(), seam.length_b());
            SeamWalk {
                name: seam.name.clone(),
                a: chain_name(garment, &seam.a),
                b: chain_name(garment, &seam.b),
                length_a,
                length_b,
                difference: difference(length_a, length_b, seam.give),
                give: seam.give,
                kind: seam.kind,
                notches_a: notches(garment, &seam.a),
                notches_b: notches(garment, &seam.b),
            }
        })
        .collect()
}

/// What is left of the difference of two lengths once `give` has had its share.
pub(super) fn difference(length_a: f64, length_b: f64, give: Give) -> f64 {
    match give {
        Give::Even => length_b - length_a,
        Give::Ease(extra) => length_b - length_a - extra,
        Give::Gather(ratio) | Give::Stretch(ratio) => length_b - length_a / ratio,
    }
}

/// Where a walk along the chain meets notches, in order.
fn notches(garment: &Garment, chain: &[Span]) -> Vec<f64> {
    let mut walked = 0.0;
    let mut met = Vec::new();
    for span in chain {
        let (low, high) = span.sorted();
        let on = garment.pieces[span.edge.piece].notches.iter().filter(|n| n.edge == span.edge);
        met.extend(on.filter(|n| (low..=high).contains(&n.at)).map(|n| walked + (n.at - span.from).abs()));
        walked += span.length();
    }
    met.sort_by(f64::total_cmp);
    met
}

fn chain_name(garment: &Garment, chain: &[Span]) -> String {
    let mut names: Vec<String> = chain.iter().map(|s| garment.edge_name(s.edge)).collect();
    names.dedup();
    names.join(" + ")
}

/// `waist`, as the file has it, for `waist.2.R`: the second part of an edge that a dart cuts in two, on the right half
/// of a folded piece. Names in files have no points.
pub fn written_edge(name: &str) -> &str {
    name.split('.').next().unwrap_or(name)
}

impl Garment {
    /// `front.L.side`.
    pub fn edge_name(&self, edge: EdgeId) -> String {
        edge_name(&self.pieces, edge)
    }

    /// The edges round an opening, as the file names them, each once: `front.L.neck`.
    pub fn opening_edges(&self, opening: &Opening) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for EdgeId { piece, ring, index } in opening.spans.iter().map(|s| s.edge) {
            let piece = &self.pieces[piece];
            let name = format!("{}.{}", piece.name, written_edge(&piece.loops[ring][index].name));
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }
}

/// `front.L.side`.
pub(super) fn edge_name(pieces: &[super::Piece], edge: EdgeId) -> String {
    let piece = &pieces[edge.piece];
    format!("{}.{}", piece.name, piece.loops[edge.ring][edge.index].name)
}
