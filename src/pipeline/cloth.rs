//! Which fabric every piece is cut from.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::fabric::{Context, Fabric, FabricError, FabricSpec, resolve};
use crate::pattern::{Garment, Piece};

/// The fabric of every piece, the same `Arc` for pieces of the same fabric; `instead` takes the place of the main one.
///
/// Every fabric of the file is read, also one that no piece uses: its mistakes are the user's to know. An error comes
/// with the number of the garment's fabric that cannot be had, `None` if that is the one asked for instead.
pub(super) fn fabrics(
    garment: &Garment,
    folder: &Path,
    instead: Option<&str>,
) -> Result<Vec<Arc<Fabric>>, (Option<usize>, FabricError)> {
    let mut specs: Vec<(String, FabricSpec)> =
        garment.fabrics.iter().map(|f| (f.name.clone(), f.spec.clone())).collect();
    let replaced = instead.and_then(|_| main_fabric(garment));
    if let (Some(name), Some(main)) = (instead, replaced) {
        // Replaced where it is defined, so that an interfacing "based on the shell" follows.
        specs[main].1 = FabricSpec { base: Some(absolute(name)), values: Vec::new() };
        // First of all: what is based on it would be blamed for it.
        resolve(&specs[main].1, &Context { name: &specs[main].0, folder, garment: &specs }).map_err(|e| (None, e))?;
    }
    let mut resolved: Vec<Arc<Fabric>> = Vec::with_capacity(specs.len());
    for (k, (name, spec)) in specs.iter().enumerate() {
        let fabric = resolve(spec, &Context { name, folder, garment: &specs }).map_err(|e| (Some(k), e))?;
        resolved.push(Arc::new(fabric));
    }
    let of_piece = |piece: &Piece| {
        let k = specs.iter().position(|s| s.0 == piece.fabric);
        let known = || specs.iter().map(|s| s.0.as_str()).collect::<Vec<_>>().join(", ");
        let unknown = || FabricError::Unknown { name: piece.fabric.clone(), nearest: None, known: known() };
        k.map(|k| Arc::clone(&resolved[k])).ok_or_else(|| (None, unknown()))
    };
    garment.pieces.iter().map(of_piece).collect()
}

/// The fabric that most of the cloth is cut from; of equals the one named first.
fn main_fabric(garment: &Garment) -> Option<usize> {
    let used = |name: &str| garment.pieces.iter().filter(|p| p.fabric == name).map(piece_area).sum::<f64>();
    let areas = garment.fabrics.iter().map(|f| used(&f.name));
    let larger = |best: Option<(usize, f64)>, (k, area): (usize, f64)| match best {
        Some((_, most)) if area <= most => best,
        _ => Some((k, area)),
    };
    areas.enumerate().fold(None, larger).map(|(k, _)| k)
}

/// Area of a piece without its holes, m².
pub fn piece_area(piece: &Piece) -> f64 {
    piece.loops.iter().flatten().map(|e| e.path.double_area()).sum::<f64>() / 2.0
}

/// A file the user names lies where the user is, not beside the garment; a name stays a name.
fn absolute(name: &str) -> String {
    let path: PathBuf = Path::new(name).into();
    if path.extension().is_none() {
        return name.to_owned();
    }
    std::path::absolute(&path).unwrap_or(path).display().to_string()
}

/// Names of the fabrics in use, in the order of the pieces, joined with ` + `.
pub(super) fn names(fabrics: &[Arc<Fabric>]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for fabric in fabrics {
        if !names.contains(&fabric.name.as_str()) {
            names.push(&fabric.name);
        }
    }
    names.join(" + ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn garment() -> Garment {
        let text = "garment: 1\nbody: woman_92\nfabrics: {band: rib, cloth: denim, fuse: {base: cloth, bend: 2}}\npieces:\n  \
             small: {fabric: band, grain: [[0, 0], [0, 1]], outline: {start: 0 0, a: L 50 0, b: L 50 50, c: L 0 50, d: L 0 0}}\n  \
             large: {fabric: cloth, grain: [[0, 0], [0, 1]], outline: {start: 0 0, a: L 90 0, b: L 90 90, c: L 0 90, d: L 0 0}}\n  \
             stiff: {fabric: fuse, grain: [[0, 0], [0, 1]], outline: {start: 0 0, a: L 50 0, b: L 50 50, c: L 0 50, d: L 0 0}}\n\
             seams: {s: {sew: small.a, to: stiff.a}}\nfree: [small.b, small.c, small.d, 'large.*', stiff.b, stiff.c, stiff.d]\n";
        crate::io::garment::read_text("test", "test.yaml", text).map_err(|e| e.to_string()).expect("a garment").garment
    }

    #[test]
    fn the_main_fabric_is_replaced_and_what_is_based_on_it_follows() {
        let garment = garment();
        let of = |instead| fabrics(&garment, Path::new(""), instead).expect("fabrics");
        assert_eq!(names(&of(None)[..2]), "rib + denim");
        let changed = of(Some("canvas"));
        assert_eq!(names(&changed[..2]), "rib + canvas");
        assert_eq!(changed[2].bend_warp, 2.0 * changed[1].bend_warp);
        assert!(matches!(fabrics(&garment, Path::new(""), Some("denin")), Err((None, FabricError::Unknown { .. }))));
    }
}
