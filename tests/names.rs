//! Names that users choose decide nothing: a garment all of whose names are in another script, in another order of the
//! alphabet, is meshed and starts to the same bytes.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use toile::io::garment::{read, read_file_only, read_text, write};
use toile::mesh::ClothMesh;
use toile::pattern::{
    AllowanceFile, ClosureFile, CutKind, DartFile, DartShape, GarmentFile, Located, PieceFile, PleatFile, SeamFile,
    TestFile, Value,
};
use toile::pipeline::{Job, Overrides};
use toile::sew::start::start;

/// Garments are meshed at this spacing, metres, as they start.
const SPACING: f64 = 0.025;

/// Words of the format among the names.
const WORDS: [&str; 4] = ["L", "R", "mirror", "all"];

/// A name in letters of another script that are sorted the other way round. A part of the name stays that part, and
/// what the format gives a meaning stays as it is.
fn other(name: &str) -> String {
    let (name, range) = name.split_at(name.find('@').unwrap_or(name.len()));
    let letter = |c: char| match c {
        'a'..='z' => char::from_u32('ա' as u32 + ('z' as u32 - c as u32)).expect("Armenian"),
        'A'..='Z' => char::from_u32('Ա' as u32 + ('Z' as u32 - c as u32)).expect("Armenian"),
        other => other,
    };
    let word = |word: &str| if WORDS.contains(&word) { word.to_owned() } else { word.chars().map(letter).collect() };
    name.split('.').map(word).collect::<Vec<String>>().join(".") + range
}

fn rename(name: &mut Located<String>) {
    name.value = other(&name.value);
}

fn rename_all<'a>(names: impl IntoIterator<Item = &'a mut Located<String>>) {
    names.into_iter().for_each(rename);
}

/// What a fabric is a variant of, if that is another of the file's own.
fn rename_base(stated: &mut Value, fabrics: &BTreeSet<String>) {
    let Value::Map(entries) = stated else { return };
    for (_, base) in entries.iter_mut().filter(|(key, _)| key.value == "base") {
        if let Value::Text(name) = &mut base.value
            && fabrics.contains(name)
        {
            *name = other(name);
        }
    }
}

fn rename_piece(piece: &mut PieceFile, fabrics: &BTreeSet<String>) {
    rename(&mut piece.name);
    rename_all(&mut piece.like);
    rename_all(piece.fabric.as_mut().filter(|fabric| fabrics.contains(&fabric.value)));
    if let Some(Located { value: CutKind::Fold(edge), .. }) = &mut piece.cut {
        *edge = other(edge);
    }
    if let Some(AllowanceFile::Edges(edges)) = &mut piece.allowance {
        rename_all(edges.iter_mut().map(|(edge, _)| edge));
    }
    rename_all(piece.outline.iter_mut().flat_map(|outline| &mut outline.edges).map(|(edge, _)| edge));
    rename_all(piece.notches.iter_mut().map(|(edge, _)| edge));
    piece.darts.iter_mut().for_each(rename_dart);
    piece.pleats.iter_mut().for_each(rename_pleat);
    rename_all(piece.holes.iter_mut().map(|(hole, _)| hole));
    rename_all(piece.lines.iter_mut().map(|line| &mut line.name));
}

fn rename_dart(dart: &mut DartFile) {
    rename_all(&mut dart.name);
    if let DartShape::Edge { edge, .. } = &mut dart.shape {
        rename(edge);
    }
}

fn rename_pleat(pleat: &mut PleatFile) {
    rename(&mut pleat.edge);
    rename_all(&mut pleat.toward);
}

fn rename_seam(seam: &mut SeamFile) {
    rename(&mut seam.name);
    rename_all(seam.sew.iter_mut().chain(&mut seam.to));
    rename_all(seam.open.iter_mut().map(|open| &mut open.from));
}

fn rename_closure(closure: &mut ClosureFile) {
    rename_all(closure.on.iter_mut().chain(&mut closure.meets));
}

fn rename_test(test: &mut TestFile) {
    match test {
        TestFile::Seam(name, _) | TestFile::Gap(name, _) | TestFile::Flatten(name, ..) | TestFile::Drape(name, ..) => {
            rename(name);
        }
        TestFile::Closure(..)
        | TestFile::Crossings(_)
        | TestFile::Openings(_)
        | TestFile::Worn
        | TestFile::Ease(..)
        | TestFile::Pressure(..)
        | TestFile::HemLevel(_) => {}
    }
}

/// A garment file without alterations, all of whose names are [`other`] names.
fn renamed(mut file: GarmentFile) -> GarmentFile {
    let fabrics: BTreeSet<String> = file.fabrics.iter().map(|(name, _)| name.value.clone()).collect();
    rename_all(&mut file.name);
    file.fabrics.iter_mut().for_each(|(name, stated)| {
        rename(name);
        rename_base(&mut stated.value, &fabrics);
    });
    file.pieces.iter_mut().for_each(|piece| rename_piece(piece, &fabrics));
    file.seams.iter_mut().for_each(rename_seam);
    file.closures.iter_mut().for_each(rename_closure);
    rename_all(&mut file.free);
    file.tests.iter_mut().for_each(|entry| rename_test(&mut entry.value.test));
    file
}

/// Everything about a mesh that is no name.
fn numbers(mesh: &ClothMesh) -> impl PartialEq + std::fmt::Debug {
    let bits: Vec<[u64; 2]> = mesh.flat.iter().map(|p| [p.x.to_bits(), p.y.to_bits()]).collect();
    let seams: Vec<_> = mesh.seams.iter().map(|seam| seam.pairs.clone()).collect();
    let pieces: Vec<_> = mesh.pieces.iter().map(|piece| piece.particles.clone()).collect();
    (bits, mesh.triangles.clone(), seams, pieces)
}

fn garments(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let files = std::fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("a file").path());
    let mut files: Vec<PathBuf> = files.filter(|file| file.extension().is_some_and(|ext| ext == "yaml")).collect();
    files.sort();
    files
}

/// The job of a garment as it is and with its names changed. `None` where the garment is refused either way, as some of
/// the data are to be, or has alterations, which are not renamed here.
fn twins(file: &Path) -> Option<[Job; 2]> {
    let shown = file.display().to_string();
    let text = std::fs::read_to_string(file).expect("text");
    let own = read(file);
    let Ok(said) = read_file_only(&shown, &text) else {
        assert!(own.is_err(), "{shown}");
        return None;
    };
    if !said.alter.is_empty() || !said.sizes.is_empty() {
        return None;
    }
    let changed = write(&renamed(said)).expect("YAML");
    let twin = read_text("другое", &shown, &changed);
    assert_eq!(own.is_ok(), twin.is_ok(), "{shown}: {:?}", twin.err());
    let overrides = Overrides { spacing: Some(SPACING), ..Overrides::default() };
    let job = |loaded| Job::new(file, loaded, &overrides);
    let jobs = [job(own.ok()?), job(twin.ok()?)];
    assert_eq!(jobs[0].is_ok(), jobs[1].is_ok(), "{shown}: {:?}", jobs[1].as_ref().err());
    let [Ok(own), Ok(twin)] = jobs else { return None };
    assert_ne!(own.garment.pieces[0].name, twin.garment.pieces[0].name, "{shown}");
    Some([own, twin])
}

/// Both start to the same bytes.
fn start_alike(file: &Path) -> bool {
    let Some(jobs) = twins(file) else { return false };
    let shown = file.display();
    assert!(numbers(&jobs[0].mesh) == numbers(&jobs[1].mesh), "{shown}: the meshes differ");
    let [own, twin] = jobs.each_ref().map(|job| start(&job.garment, &job.mesh, &job.body, &job.collider));
    assert!(own.as_ref().ok() == twin.as_ref().ok(), "{shown}: the starts differ");
    own.is_ok()
}

#[test]
fn garments_of_the_library_start_alike_under_any_name() {
    for file in garments("patterns") {
        assert!(start_alike(&file), "{}: no start", file.display());
    }
}

#[test]
fn garments_of_every_kind_start_alike_under_any_name() {
    let files = garments("tests/data");
    let started = files.iter().filter(|file| start_alike(file)).count();
    assert!(2 * started > files.len(), "{started} of {} start from their topology", files.len());
}
