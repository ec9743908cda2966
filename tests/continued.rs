//! Garments that go on from the result of an earlier run, changed or not.

use std::fs;
use std::path::{Path, PathBuf};

use toile::geometry::Vec3;
use toile::io::garment::read_text;
use toile::mesh::{ClothMesh, EarlierMesh, EarlierPiece, Edges, PieceMesh, build};
use toile::pipeline::{AT_REST, Job, Overrides, PictureOptions, PipelineError, Run};
use toile::report::{Report, restless};

/// Metres.
const SPACING: f64 = 0.025;

fn skirt() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns/gore_skirt.yaml");
    fs::read_to_string(file).expect("shipped")
}

fn job(text: &str, overrides: Overrides) -> Job {
    let file = Path::new("skirt.yaml");
    let loaded = read_text("skirt", "skirt.yaml", text).unwrap_or_else(|e| panic!("{e}"));
    Job::new(file, loaded, &Overrides { spacing: overrides.spacing.or(Some(SPACING)), ..overrides }).expect("a job")
}

/// An empty folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("continued").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn write(run: &Run, folder: &Path) {
    for (name, bytes) in run.results(&run.report(), &PictureOptions::default()).expect("results") {
        fs::write(folder.join(name), bytes).expect("written");
    }
}

/// The skirt of `text` made from nothing, its files in a folder.
fn made(name: &str, text: &str) -> PathBuf {
    let job = job(text, Overrides::default());
    let mut run = Run::new(&job);
    run.drape(&mut |_, _| {}).expect("draped");
    let folder = folder(name);
    write(&run, &folder);
    folder
}

fn continued(job: &Job, folder: &Path) -> Report {
    let mut run = Run::continued(job, folder).expect("an earlier result");
    run.drape(&mut |_, _| {}).expect("draped");
    let report = run.report();
    assert!(restless(&report.stages, AT_REST).is_empty(), "{:?}", report.stages);
    assert_eq!(report.contact.cloth_body_intersections + report.contact.cloth_cloth_intersections, 0);
    assert!(report.seams.iter().all(|seam| seam.gap_max < 1.0), "{:?}", report.seams);
    report
}

fn steps(report: &Report) -> usize {
    report.stages.iter().map(|stage| stage.iterations).sum()
}

/// Longer by 15 mm at the side and the hem.
fn longer() -> String {
    let old = ["321.773 581.562", "217.178 599.867, 128.709 610, 0 610", "323.173 589.562"];
    let new = ["321.773 596.562", "217.178 614.867, 128.709 625, 0 625", "323.173 604.562"];
    let text = old.iter().zip(new).fold(skirt(), |text, (old, new)| text.replace(old, new));
    text.replace("218.123 607.946, 129.269 618, 0 618", "218.123 622.946, 129.269 633, 0 633")
}

#[test]
fn a_changed_garment_goes_on_from_the_earlier_one() {
    let folder = made("changed", &skirt());
    let cold: Report = serde_json::from_slice(&fs::read(folder.join("report.json")).expect("read")).expect("a report");
    let same = continued(&job(&skirt(), Overrides::default()), &folder);
    let from = same.from.as_ref().expect("told");
    assert!(!from.anew && from.new.is_empty() && from.moved_mean < 1.0, "{from:?}");
    assert!(same.stages.iter().all(|stage| stage.name != "sew"), "nothing is sewn");
    assert!(2 * steps(&same) < steps(&cold), "{} steps for {}", steps(&same), steps(&cold));
    // Longer, in another fabric, and of finer mesh.
    let overrides = Overrides { spacing: Some(0.022), fabric: Some("denim".into()), ..Overrides::default() };
    let report = continued(&job(&longer(), overrides), &folder);
    let from = report.from.expect("told");
    assert!(!from.anew && from.new.is_empty(), "{from:?}");
    assert!((0.1..40.0).contains(&from.moved_max), "{from:?}");
    assert_eq!(report.spacing, 22.0);
    let grown = report.pieces[0].sizes.area_flat / cold.pieces[0].sizes.area_flat;
    assert!((1.02..1.04).contains(&grown), "{grown}");
}

/// The T-shirt of `patterns`, and the same without its neckband.
fn shirts() -> [String; 2] {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns/tshirt.yaml");
    let full = fs::read_to_string(file).expect("shipped");
    let [piece, seams] = ["  neckband:\n    fabric", "seams:\n"].map(|mark| full.find(mark).expect("in the file"));
    let [ring, tests] = ["  neckband_ring", "tests:\n"].map(|mark| full.find(mark).expect("in the file"));
    let free = "free: ['*.hem', '*.neck']\n";
    let bare = format!("{}{}\n{free}{}", &full[..piece], &full[seams..ring], &full[tests..]);
    [full, bare]
}

#[test]
fn a_piece_that_is_new_is_sewn_in() {
    let [full, bare] = shirts();
    let folder = made("bare", &bare);
    let report = continued(&job(&full, Overrides::default()), &folder);
    let from = report.from.expect("told");
    assert_eq!((from.anew, from.new), (false, vec!["neckband".to_owned()]));
    assert_eq!(report.stages[1].name, "sew");
}

#[test]
fn a_folder_that_holds_no_result_is_refused_by_file() {
    let skirt_job = job(&skirt(), Overrides::default());
    let refused = |folder: &Path, file: &str, why: &str| {
        let error = Run::continued(&skirt_job, folder).err().expect("refused");
        assert!(error.is_input());
        let text = error.to_string();
        assert!(text.contains(file) && text.contains(why), "{text}");
        error
    };
    let empty = folder("empty");
    refused(&empty, "report.json", "--from takes a folder");
    fs::write(empty.join("report.json"), "{}").expect("written");
    refused(&empty, "report.json", "no report of a garment");
    let folder = made("broken", &skirt());
    let report = fs::read_to_string(folder.join("report.json")).expect("read");
    fs::write(folder.join("report.json"), report.replace("\"front.L\"", "\"frint.L\"")).expect("written");
    let error = refused(&folder, "garment.obj", "no group 'frint.L'");
    assert!(matches!(error, PipelineError::Earlier { .. }));
}

/// A square of 200 mm whose right edge is at `right` mm, meshed.
fn square(name: &str, right: f64) -> ClothMesh {
    let text = format!(
        "garment: 1\nname: Square\nfabrics: {{cloth: cotton_poplin}}\npieces:\n  {name}:\n    \
         grain: [[50, 20], [50, 100]]\n    \
         outline: {{start: 0 0, top: L {right} 0, right: L {right} 200, bottom: L 0 200, left: L 0 0}}\n\
         free: ['*.*']\n"
    );
    let garment = read_text("square", "square.yaml", &text);
    build(&garment.unwrap_or_else(|e| panic!("{e}")).garment, 0.02).expect("meshed")
}

/// What the results of a mesh tell of it.
fn told(mesh: &ClothMesh) -> EarlierMesh {
    let piece = |p: &PieceMesh| EarlierPiece {
        name: p.name.clone(),
        triangles: p.triangles.clone(),
        edges: p.edges.iter().map(|e| (e.name.clone(), e.particles.clone())).collect(),
    };
    EarlierMesh {
        flat: mesh.flat.clone(),
        triangles: mesh.triangles.clone(),
        pieces: mesh.pieces.iter().map(piece).collect(),
        spacing: mesh.spacing,
    }
}

fn lifted(mesh: &ClothMesh) -> Vec<Vec3> {
    mesh.flat.iter().map(|p| Vec3::new(p.x, p.y, 1.0)).collect()
}

#[test]
fn an_edge_that_has_moved_lies_where_it_lay() {
    let (earlier, wider) = (square("a", 200.0), square("a", 220.0));
    let at = told(&earlier).carry(&lifted(&earlier), &wider, Edges::Shares);
    for (flat, at) in wider.flat.iter().zip(at) {
        let at = at.expect("carried");
        // The wider square lies on the earlier one, nowhere beyond it, and in order.
        assert!((at.z - 1.0).abs() < 1e-12 && (-1e-9..0.2 + 1e-9).contains(&at.x), "{flat:?} {at:?}");
        assert!((at.x - flat.x / 1.1).abs() < 6e-3 && (at.y - flat.y).abs() < 6e-3, "{flat:?} {at:?}");
        if flat.x == 0.22 {
            assert!((at.x - 0.2).abs() < 1e-12);
        }
    }
}

#[test]
fn a_free_edge_that_has_moved_a_little_hangs_on_straight() {
    let earlier = square("a", 200.0);
    for right in [190.0, 210.0] {
        let changed = square("a", right);
        let at = told(&earlier).carry(&lifted(&earlier), &changed, Edges::Loose);
        assert!(
            changed.flat.iter().zip(at).all(|(p, at)| (at.expect("carried") - Vec3::new(p.x, p.y, 1.0)).norm() < 1e-9)
        );
    }
    // Further out it lies on the earlier edge.
    let wider = square("a", 260.0);
    let at = told(&earlier).carry(&lifted(&earlier), &wider, Edges::Loose);
    assert!(at.iter().all(|at| at.expect("carried").x < 0.2 + 1e-9));
}

#[test]
fn a_piece_is_known_by_its_name_or_its_place_in_the_drawing() {
    let (earlier, renamed, other) = (square("a", 200.0), square("b", 205.0), square("b", 260.0));
    let known = |mesh: &ClothMesh| told(&earlier).carry(&lifted(&earlier), mesh, Edges::Shares);
    assert!(known(&renamed).iter().all(Option::is_some));
    assert!(known(&other).iter().all(Option::is_none));
}
