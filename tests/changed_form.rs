//! The pattern of a form that has been changed: the bust of a draped garment pushed out, and laid flat.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use toile::io::garment::{Loaded, read};
use toile::pattern::{Garment, SeamKind};

/// Distance of the particles, mm: coarse, for each garment is draped three times.
const SPACING: &str = "25";
/// By how much and how far round its foremost points the bust is pushed out, mm.
const OUT: f64 = 15.0;
const ROUND: f64 = 80.0;

fn pattern(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns").join(name)
}

/// A folder with the garment as `toile make` drapes it.
fn draped(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("changed_form").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    fs::copy(pattern(name), folder.join(name)).expect("copied");
    let (code, said) = toile(&folder, &["make", name, "--spacing", SPACING, "-o", "made", "-q"]);
    assert!(code == Some(0) || code == Some(1), "{said}");
    folder
}

fn toile(folder: &Path, args: &[&str]) -> (Option<i32>, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_toile")).args(args).current_dir(folder).output().expect("run");
    (status.code(), String::from_utf8_lossy(&[stdout, stderr].concat()).into_owned())
}

/// Distances from the middle between which a bust point lies, mm.
const BUST: [f64; 2] = [60.0, 120.0];

/// Pushes the bust points out, the foremost of each side above the waist, and smoothly what is round them.
fn pushed_out(obj: &str) -> String {
    let point = |line: &str| -> Option<[f64; 3]> {
        let numbers: Vec<f64> = line.strip_prefix("v ")?.split_whitespace().filter_map(|n| n.parse().ok()).collect();
        <[f64; 3]>::try_from(numbers).ok()
    };
    let points: Vec<[f64; 3]> = obj.lines().filter_map(point).collect();
    let top = points.iter().map(|p| p[1]).fold(f64::MIN, f64::max);
    let chest = points.iter().filter(|p| p[1] > top - 400.0);
    let foremost = |side: f64| {
        let of_side = chest.clone().filter(|p| (BUST[0]..BUST[1]).contains(&(p[0] * side)));
        *of_side.max_by(|a, b| a[2].total_cmp(&b[2])).expect("points")
    };
    let apexes = [-1.0, 1.0].map(foremost);
    let moved = |p: [f64; 3]| {
        let far = |a: &[f64; 3]| (0..3).map(|k| (a[k] - p[k]).powi(2)).sum::<f64>().sqrt();
        let share = apexes.iter().map(far).fold(f64::MAX, f64::min) / ROUND;
        let out = if share < 1.0 { OUT * (std::f64::consts::FRAC_PI_2 * share).cos().powi(2) } else { 0.0 };
        [p[0], p[1], p[2] + out]
    };
    let line = |line: &str| match point(line) {
        Some(p) => {
            let [x, y, z] = moved(p);
            format!("v {x:.6} {y:.6} {z:.6}\n")
        }
        None => format!("{line}\n"),
    };
    obj.lines().map(line).collect()
}

/// Differences of the two sides of every seam, mm.
fn gaps(garment: &Garment) -> Vec<f64> {
    garment.seams.iter().map(|s| 1e3 * (s.length_a() - s.length_b())).collect()
}

fn intake(loaded: &Loaded, dart: usize) -> f64 {
    loaded.file.pieces[0].darts[dart].intake.value.number
}

/// Lays a garment with its bust pushed out flat, and gives it before and after, and what was said.
fn changed(name: &str) -> (Loaded, Loaded, String) {
    let folder = draped(name);
    let obj = fs::read_to_string(folder.join("made/garment.obj")).expect("the draped garment");
    fs::write(folder.join("edited.obj"), pushed_out(&obj)).expect("written");
    let (code, said) = toile(&folder, &["flatten", name, "--from", "edited.obj", "--spacing", SPACING, "-o", "flat"]);
    assert_eq!(code, Some(if said.contains("out of bounds") { 1 } else { 0 }), "{said}");
    assert!(!said.contains("is tight:") && said.contains("mm from the form"), "{said}");
    let [old, new] = [folder.join(name), folder.join("flat/garment.yaml")].map(|f| read(&f).expect("a garment"));
    for (old, new) in gaps(&old.garment).iter().zip(gaps(&new.garment)) {
        assert!((old - new).abs() < 0.01, "sides differ by {old} before, by {new} after");
    }
    let darts = new.garment.seams.iter().filter(|s| s.kind == SeamKind::Dart);
    darts.for_each(|d| assert!((d.length_a() - d.length_b()).abs() < 1e-5, "{}", d.name));
    // Few curves stand for each edge.
    for piece in new.file.pieces.iter().filter_map(|p| p.outline.as_ref()) {
        for (edge, path) in &piece.edges {
            let curves = path.value.matches(['L', 'C', 'Q', 'A']).count();
            assert!(curves <= 24, "{curves} curves in {}: {}", edge.value, path.value);
        }
    }
    (old, new, said)
}

#[test]
fn the_bust_dart_of_a_sheath_dress_opens() {
    let (old, new, said) = changed("sheath_dress.yaml");
    let [before, after] = [&old, &new].map(|loaded| intake(loaded, 0));
    assert!(after - before > 8.0 && after - before < 25.0, "{before} to {after}\n{said}");
    assert!(said.contains("dart front.bust +"), "{said}");
    let text = fs::read_to_string(pattern("sheath_dress.yaml")).expect("text");
    assert!(text.contains("# neck, hem, two armholes") && new.text().contains("# neck, hem, two armholes"));
}

#[test]
fn a_t_shirt_without_darts_changes_its_edges() {
    let (_, new, said) = changed("tshirt.yaml");
    assert!(said.contains("front."), "{said}");
    assert_eq!(new.file.seams.len(), 6);
}

#[test]
fn an_unchanged_form_changes_nothing_and_another_mesh_is_refused() {
    let folder = draped("gore_skirt.yaml");
    let from = ["flatten", "gore_skirt.yaml", "--from", "made/garment.obj", "--spacing", SPACING];
    let (code, said) = toile(&folder, &[&from[..], &["-o", "same"]].concat());
    assert_eq!(code, Some(0), "{said}");
    let old = fs::read_to_string(pattern("gore_skirt.yaml")).expect("text");
    assert_eq!(fs::read_to_string(folder.join("same/garment.yaml")).expect("text"), old, "{said}");
    let other = ["flatten", "gore_skirt.yaml", "--from", "made/garment.obj", "--spacing", "40", "-o", "other"];
    let (code, said) = toile(&folder, &other);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.matches(" faces on ").count() == 1 && said.contains("but 'gore_skirt' has"), "{said}");
    assert!(!folder.join("other/garment.yaml").exists());
}
