//! Names of edges and lengths, as the page says them.

/// Keys of a seam whose values are lengths.
const OF_SEAM: [&str; 3] = ["ease", "tolerance", "allowance"];
/// Keys of an alteration whose values are lengths.
const OF_ALTERATION: [&str; 5] = ["by", "to_by", "at", "over", "share"];

/// `front.neck` of `front.L.neck@0..20`.
pub(super) fn bare(edge: &str) -> String {
    let name = edge.split('@').next().unwrap_or_default().trim();
    name.split('.').filter(|word| !["L", "R"].contains(word)).collect::<Vec<_>>().join(".")
}

/// The name of a length, if the value at a path is one.
pub(super) fn label(path: &[String]) -> Option<String> {
    let words: Vec<&str> = path.iter().map(String::as_str).collect();
    let number = |text: &str| text.parse::<usize>().ok().map(|n| n + 1);
    match words[..] {
        ["allowance"] => Some("seam allowance".to_owned()),
        ["body", measure] if measure != "like" => Some(format!("body, {}", measure.replace('_', " "))),
        ["seams", seam, key] if OF_SEAM.contains(&key) => Some(format!("seam {seam}, {key}")),
        ["pieces", piece, "allowance"] => Some(format!("piece {piece}, allowance")),
        ["pieces", piece, "allowance", edge] => Some(format!("piece {piece}, allowance of {edge}")),
        ["alter", item, key] if OF_ALTERATION.contains(&key) => Some(format!("alteration {}, {key}", number(item)?)),
        ["alter", item, "at", at] => Some(format!("alteration {}, at {at}", number(item)?)),
        _ => None,
    }
}
