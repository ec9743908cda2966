//! The fabric of every piece.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::fabric::{Context, Fabric, FabricError, FabricSpec, resolve};
use crate::pattern::{FabricUse, Garment, Piece};

/// The fabrics of a garment by name, as they are to be had.
pub(super) struct Fabrics<'a> {
    specs: Vec<(String, FabricSpec)>,
    folder: &'a Path,
    /// Index of the fabric that is replaced by the user's.
    pub(super) replaced: Option<usize>,
    /// The user's fabric itself, if it is not to be loaded.
    given: Option<Arc<Fabric>>,
}

impl<'a> Fabrics<'a> {
    /// Those that a file in `folder` names.
    pub(super) fn named(fabrics: &[FabricUse], folder: &'a Path) -> Self {
        let specs = fabrics.iter().map(|f| (f.name.clone(), f.spec.clone())).collect();
        Self { specs, folder, replaced: None, given: None }
    }

    /// Those of a garment. `instead` takes the place of the main one where that is defined, so that an interfacing
    /// "based on the shell" follows. The main one itself is left as it is. A fabric that is `given` is not loaded.
    ///
    /// # Errors
    /// `instead` cannot be had.
    pub(super) fn of(
        garment: &Garment,
        folder: &'a Path,
        instead: Option<&str>,
        given: Option<&Arc<Fabric>>,
    ) -> Result<Self, FabricError> {
        let mut fabrics = Self::named(&garment.fabrics, folder);
        if let Some(given) = given {
            fabrics.replaced = main_fabric(garment);
            fabrics.given = Some(Arc::clone(given));
            return Ok(fabrics);
        }
        let Some((name, main)) = instead.zip(main_fabric(garment)) else { return Ok(fabrics) };
        if fabrics.specs[main].0 != name {
            fabrics.specs[main].1 = FabricSpec { base: Some(absolute(name)), values: Vec::new() };
            // First of all: what is based on it would be blamed for it.
            fabrics.resolve(main)?;
            fabrics.replaced = Some(main);
        }
        Ok(fabrics)
    }

    /// The name in reports of the fabric that the garment's file calls `word`: one of its own, a shipped one or a file.
    ///
    /// # Errors
    /// It cannot be had.
    pub(super) fn name_of(&self, word: &str) -> Result<String, FabricError> {
        if let Some(own) = self.specs.iter().position(|s| s.0 == word) {
            return Ok(self.resolve(own)?.name);
        }
        let spec = FabricSpec { base: Some(word.to_owned()), values: Vec::new() };
        Ok(resolve(&spec, &self.context(word))?.name)
    }

    /// All of them in the file's order, also one that no piece uses: its mistakes are the user's to know.
    pub(super) fn all(&self) -> Vec<Result<Fabric, FabricError>> {
        (0..self.specs.len()).map(|k| self.resolve(k)).collect()
    }

    fn resolve(&self, k: usize) -> Result<Fabric, FabricError> {
        let (name, spec) = &self.specs[k];
        match self.given.as_ref().filter(|_| self.replaced == Some(k)) {
            Some(given) => Ok(Fabric::clone(given)),
            None => resolve(spec, &self.context(name)),
        }
    }

    fn context<'b>(&'b self, name: &'b str) -> Context<'b> {
        let given = self.replaced.zip(self.given.as_deref());
        let given = given.map(|(k, fabric)| (self.specs[k].0.as_str(), fabric));
        Context { name, folder: self.folder, garment: &self.specs, given }
    }

    /// The fabric of every piece among the `resolved`, the same `Arc` for pieces of the same fabric.
    ///
    /// # Errors
    /// A piece of a fabric that the garment does not name.
    pub(super) fn by_piece(&self, garment: &Garment, resolved: Vec<Fabric>) -> Result<Vec<Arc<Fabric>>, FabricError> {
        let resolved: Vec<Arc<Fabric>> = resolved.into_iter().map(Arc::new).collect();
        let of_piece = |piece: &Piece| {
            let k = self.specs.iter().position(|s| s.0 == piece.fabric);
            let known = || self.specs.iter().map(|s| s.0.as_str()).collect::<Vec<_>>().join(", ");
            let unknown = || FabricError::Unknown { name: piece.fabric.clone(), nearest: None, known: known() };
            k.map(|k| Arc::clone(&resolved[k])).ok_or_else(unknown)
        };
        garment.pieces.iter().map(of_piece).collect()
    }
}

/// The fabric that most of the cloth is cut from. Of equals the one named first.
fn main_fabric(garment: &Garment) -> Option<usize> {
    let used = |name: &str| garment.pieces.iter().filter(|p| p.fabric == name).map(Piece::area).sum::<f64>();
    let areas = garment.fabrics.iter().map(|f| used(&f.name));
    let larger = |best: Option<(usize, f64)>, (k, area): (usize, f64)| match best {
        Some((_, most)) if area <= most => best,
        _ => Some((k, area)),
    };
    areas.enumerate().fold(None, larger).map(|(k, _)| k)
}

/// A file the user names lies where the user is, not beside the garment. A name stays a name.
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
        let text = "garment: 1\nbody: woman_92\nfabrics: {band: rib, cloth: denim, fuse: {base: cloth, bend: 2}}\n\
             pieces:\n  \
             small: {fabric: band, grain: [[0, 0], [0, 1]], outline: {start: 0 0, a: L 50 0, b: L 50 50, c: L 0 50, \
             d: L 0 0}}\n  \
             large: {fabric: cloth, grain: [[0, 0], [0, 1]], outline: {start: 0 0, a: L 90 0, b: L 90 90, c: L 0 90, \
             d: L 0 0}}\n  \
             stiff: {fabric: fuse, grain: [[0, 0], [0, 1]], outline: {start: 0 0, a: L 50 0, b: L 50 50, c: L 0 50, \
             d: L 0 0}}\n\
             seams: {s: {sew: small.a, to: stiff.a}}\nfree: [small.b, small.c, small.d, 'large.*', stiff.b, stiff.c, \
             stiff.d]\n";
        crate::io::garment::read_text("test", "test.yaml", text).map_err(|e| e.to_string()).expect("a garment").garment
    }

    #[test]
    fn the_main_fabric_is_replaced_and_what_is_based_on_it_follows() {
        let garment = garment();
        let of = |instead| {
            let fabrics = Fabrics::of(&garment, Path::new(""), instead, None).expect("fabrics");
            let resolved = fabrics.all().into_iter().collect::<Result<Vec<_>, _>>().expect("resolved");
            fabrics.by_piece(&garment, resolved).expect("every piece")
        };
        assert_eq!(names(&of(None)[..2]), "rib + denim");
        let changed = of(Some("canvas"));
        assert_eq!(names(&changed[..2]), "rib + canvas");
        assert_eq!(changed[2].bend_warp, 2.0 * changed[1].bend_warp);
        let denin = Fabrics::of(&garment, Path::new(""), Some("denin"), None);
        assert!(matches!(denin.map(|_| ()), Err(FabricError::Unknown { .. })));
        let canvas = Arc::new(crate::fabric::load("canvas").expect("shipped"));
        let given = Fabrics::of(&garment, Path::new(""), None, Some(&canvas)).expect("fabrics");
        let resolved = given.all().into_iter().collect::<Result<Vec<_>, _>>().expect("resolved");
        assert_eq!(given.by_piece(&garment, resolved).expect("every piece"), changed);
    }
}
