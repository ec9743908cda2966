//! Names of edges, as cut and as the file has them.

use super::{EdgeId, Piece, Side};

/// `waist`, as the file has it, for `waist.2.R`: the second part of an edge that a dart cuts in two, on the right half
/// of a folded piece. Names in files have no points, but `dart.a` is the first leg of a dart.
pub fn written_edge(name: &str) -> String {
    let made = |word: &str| half(word).is_some() || word.parse::<usize>().is_ok();
    let words = name.split('.').enumerate().filter(|(k, word)| *k == 0 || !made(word));
    words.map(|(_, word)| word).collect::<Vec<_>>().join(".")
}

/// The side at the end of the name of an edge of one half of a folded piece.
fn half(name: &str) -> Option<Side> {
    name.rsplit('.').next().and_then(Side::from_letter)
}

/// Edges by their pieces and names, as the file has them, each once: `front.waist` for its parts and for both halves of
/// a folded piece, `front.R.pocket` where only one half is meant.
pub fn written_names<'a>(edges: impl IntoIterator<Item = (&'a str, &'a str)>) -> Vec<String> {
    let mut found: Vec<(&str, String, Vec<Option<Side>>)> = Vec::new();
    for (piece, edge) in edges {
        let base = written_edge(edge);
        match found.iter_mut().find(|f| f.0 == piece && f.1 == base) {
            Some(f) => f.2.push(half(edge)),
            None => found.push((piece, base, vec![half(edge)])),
        }
    }
    let name = |(piece, base, halves): (&str, String, Vec<Option<Side>>)| match halves[0]
        .filter(|side| halves.iter().all(|half| *half == Some(*side)))
    {
        Some(side) => format!("{piece}{}.{base}", side.suffix()),
        None => format!("{piece}.{base}"),
    };
    found.into_iter().map(name).collect()
}

/// [`written_names`] of edges of these pieces.
pub(super) fn names_of(pieces: &[Piece], edges: impl IntoIterator<Item = EdgeId>) -> Vec<String> {
    let names = |edge: EdgeId| {
        let piece = &pieces[edge.piece];
        (piece.name.as_str(), piece.loops[edge.ring][edge.index].name.as_str())
    };
    written_names(edges.into_iter().map(names))
}

/// `front.L.side`, and `front.waist.2.R` for a part of an edge: a range is measured along the part.
pub(crate) fn edge_name(pieces: &[Piece], edge: EdgeId) -> String {
    let piece = &pieces[edge.piece];
    format!("{}.{}", piece.name, piece.loops[edge.ring][edge.index].name)
}
