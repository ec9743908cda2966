//! A garment file as a picture: what was read of a drawing.

use super::error::PipelineError;
use crate::geometry::{Path, Vec2};
use crate::pattern::{CutKind, GarmentFile, Located, PieceFile, SeamFile, dart_legs};
use crate::picture::{PatternEdge, PatternPiece, draw_pattern};

/// Draws the pieces of a file with their edges, notches and lines, and these seams in colours, each with the line that
/// tells it. The file need not make a garment.
///
/// # Errors
/// A file without an outline.
pub fn pattern_picture(file: &GarmentFile, seams: &[(SeamFile, String)]) -> Result<Vec<u8>, PipelineError> {
    let pieces: Vec<PatternPiece> = file.pieces.iter().filter_map(|piece| shown(piece, file, seams)).collect();
    let title = file.name.as_ref().map_or("", |name| &name.value);
    let said: Vec<String> = seams.iter().map(|(_, said)| said.clone()).collect();
    Ok(draw_pattern(title, &pieces, &said)?)
}

/// A piece as drawn; `None` of one without an outline that can be read.
fn shown(piece: &PieceFile, file: &GarmentFile, seams: &[(SeamFile, String)]) -> Option<PatternPiece> {
    let outline = piece.outline.as_ref()?;
    let unit = file.unit();
    let metres = unit.factor();
    let on_fold = piece.cut.as_ref().and_then(|cut| if let CutKind::Fold(on) = &cut.value { Some(on) } else { None });
    let mut at = Vec2::from(outline.start.value);
    let mut edges = Vec::new();
    for (name, commands) in &outline.edges {
        let path = Path::parse(at, &commands.value, metres).ok()?;
        at = path.end() / metres;
        let own = piece.notches.iter().filter(|(edge, _)| edge.value == name.value).flat_map(|(_, list)| list);
        let notches = own.map(|n| (n.value.at.value(unit), n.value.double)).collect();
        let seam = seams.iter().position(|(seam, _)| takes(seam, &piece.name.value, &name.value));
        let fold = on_fold == Some(&name.value);
        edges.push(PatternEdge { name: name.value.clone(), path, notches, seam, fold });
    }
    let whole = |text: &Located<String>| Path::parse_absolute(&text.value, metres).ok();
    let holes = piece.holes.iter().filter_map(|(_, ring)| whole(ring));
    let lines = piece.lines.iter().filter_map(|line| whole(&line.path));
    let named: Vec<(&str, &Path)> = edges.iter().map(|edge| (edge.name.as_str(), &edge.path)).collect();
    let darts = piece.darts.iter().filter_map(|dart| dart_legs(dart, &named, unit));
    let lines = holes.chain(lines).chain(darts).collect();
    let grain = piece.grain.as_ref().map(|g| g.value.map(|p| Vec2::from(p) * metres));
    let points = fasteners(file, &piece.name.value).map(|p| p * metres).collect();
    Some(PatternPiece { name: piece.name.value.clone(), edges, lines, points, grain })
}

/// Points of a piece, or of one of a pair, where something is buttoned, in the file's unit.
fn fasteners<'f>(file: &'f GarmentFile, piece: &'f str) -> impl Iterator<Item = Vec2> + 'f {
    let is_own = move |name: &Option<Located<String>>| {
        name.as_ref().is_some_and(|name| name.value.split('.').next() == Some(piece))
    };
    let points = |at: &'f [Located<[f64; 2]>]| at.iter().map(|p| Vec2::from(p.value));
    file.closures.iter().flat_map(move |closure| {
        let on = points(if is_own(&closure.on) { &closure.at } else { &[] });
        on.chain(points(if is_own(&closure.meets) { &closure.meets_at } else { &[] }))
    })
}

/// Whether a seam has an edge of a piece, on whichever side.
fn takes(seam: &SeamFile, piece: &str, edge: &str) -> bool {
    let is = |written: &str| {
        let words: Vec<&str> = written.split('.').filter(|word| !["L", "R"].contains(word)).collect();
        words == [piece, edge]
    };
    seam.sew.iter().chain(&seam.to).any(|written| is(&written.value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::garment::read_file_only;

    #[test]
    fn darts_folds_and_buttons_are_shown() {
        let text = "garment: 1\npieces:\n  front:\n    cut: fold d\n    \
                    outline: {start: 0 0, a: L 200 0, b: L 200 300, c: L 0 300, d: L 0 0}\n    darts:\n      \
                    - {edge: c, at: 100, intake: 20, length: 120}\n      \
                    - {at: [120, 80], intake: 16, up: 40, down: 60}\n\
                    closures: [{kind: button, on: front, at: [[10, 20], [10, 90]]}]\nfree: ['*.*']\n";
        let file = read_file_only("front.yaml", text).expect("a garment file");
        let front = shown(&file.pieces[0], &file, &[]).expect("a piece");
        let is_on_fold: Vec<bool> = front.edges.iter().map(|edge| edge.fold).collect();
        assert_eq!(is_on_fold, [false, false, false, true]);
        let millimetres = |p: Vec2| [p.x, p.y].map(|x| (x * 1e3).round());
        assert_eq!(front.points.iter().map(|p| millimetres(*p)).collect::<Vec<_>>(), [[10.0, 20.0], [10.0, 90.0]]);
        let corners = |line: &Path| line.sampled(1e-4).into_iter().map(millimetres).collect::<Vec<_>>();
        assert_eq!(corners(&front.lines[0]), [[110.0, 300.0], [100.0, 180.0], [90.0, 300.0]]);
        assert_eq!(corners(&front.lines[1])[..3], [[120.0, 40.0], [112.0, 80.0], [120.0, 140.0]]);
    }
}
