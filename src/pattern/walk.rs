//! Walks the seams: both lengths of each, and their difference beyond ease, gather or stretch.

use super::edge_name::names_of;
use super::notch::met;
use super::{Garment, Give, Opening, SeamKind, Span};

/// Length of an edge that may be missing from a whole edge by rounding, metres.
const WHOLE: f64 = 1e-6;

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
    /// Excess of the second length over the first length with the seam's ease, gather or stretch.
    pub difference: f64,
    /// How unequal lengths are meant.
    pub give: Give,
    /// Origin of the seam.
    pub kind: SeamKind,
    /// Notches of the first chain, metres from its start.
    pub notches_a: Vec<f64>,
    /// Notches of the second chain.
    pub notches_b: Vec<f64>,
}

/// Walks every seam of a garment.
pub fn walk(garment: &Garment) -> Vec<SeamWalk> {
    let notches = |chain: &[Span]| met(&garment.pieces, chain).iter().map(|m| m.along).collect();
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
                notches_a: notches(&seam.a),
                notches_b: notches(&seam.b),
            }
        })
        .collect()
}

/// Difference of two lengths that remains after `give`.
pub(super) fn difference(length_a: f64, length_b: f64, give: Give) -> f64 {
    match give {
        Give::Even => length_b - length_a,
        Give::Ease(extra) => length_b - length_a - extra,
        Give::Gather(ratio) | Give::Stretch(ratio) => length_b - length_a / ratio,
    }
}

/// The edges of a chain with their names in the file. Parts have their stretch in millimetres: `bib.top@30..230`.
fn chain_name(garment: &Garment, chain: &[Span]) -> String {
    let edge = |span: &Span| &garment.pieces[span.edge.piece].loops[span.edge.ring][span.edge.index];
    let is_whole = |span: &Span| span.length() > edge(span).path.length() - WHOLE;
    let name = |spans: &[Span]| match spans {
        [part] if !is_whole(part) => {
            let (piece, edge) = (&garment.pieces[part.edge.piece].name, edge(part));
            let as_drawn = |at: f64| if edge.against { edge.path.length() - at } else { at };
            let [from, to] = [part.from, part.to].map(|at| (as_drawn(at) * 1e4).round() / 10.0);
            format!("{piece}.{}@{}..{}", edge.name, from.min(to), from.max(to))
        }
        whole => names_of(&garment.pieces, whole.iter().map(|s| s.edge)).join(" + "),
    };
    chain.chunk_by(|a, b| is_whole(a) && is_whole(b)).map(name).collect::<Vec<_>>().join(" + ")
}

impl Garment {
    /// The edges round an opening, as the file names them, each once: `front.L.neck`.
    pub fn opening_edges(&self, opening: &Opening) -> Vec<String> {
        names_of(&self.pieces, opening.spans.iter().map(|s| s.edge))
    }
}
