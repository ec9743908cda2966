//! Garments drafted on a form: closed forms and refusals.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use toile::input::LengthUnit;
use toile::io::garment::read_text;
use toile::pattern::Garment;
use toile::pipeline::{Drafted, draft};

/// Sides of the round bodies: a polygon of so many differs from its circle by less than a hundredth of a millimetre.
const SIDES: usize = 256;
/// Radius, mm.
const RADIUS: f64 = 100.0;
/// Ease, mm.
const EASE: f64 = 40.0;
/// Largest difference that passes, mm.
const EXACT: f64 = 0.02;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("drafting").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// A closed round body, 400 mm high, with rings every 20 mm.
fn round(radius: impl Fn(f64) -> f64) -> String {
    let mut obj = String::new();
    for ring in 0..=20 {
        let y = 20.0 * f64::from(ring);
        for k in 0..SIDES {
            let (sin, cos) = (TAU * k as f64 / SIDES as f64).sin_cos();
            let _ = writeln!(obj, "v {} {y} {}", radius(y) * sin, radius(y) * cos);
        }
    }
    let _ = writeln!(obj, "v 0 0 0\nv 0 400 0");
    let (low, high) = (21 * SIDES + 1, 21 * SIDES + 2);
    for k in 0..SIDES {
        let next = (k + 1) % SIDES;
        for ring in 0..20 {
            let at = |ring: usize, k: usize| ring * SIDES + k + 1;
            let (a, b, c, d) = (at(ring, k), at(ring, next), at(ring + 1, next), at(ring + 1, k));
            let _ = writeln!(obj, "f {a} {b} {c}\nf {a} {c} {d}");
        }
        let top = 20 * SIDES + 1;
        let _ = writeln!(obj, "f {low} {} {}\nf {high} {} {}", next + 1, k + 1, top + k, top + next);
    }
    obj
}

const TWO_PANELS: &str = "\
ease: 40 mm
lines:
  top: {height: 350}
  bottom: {height: 50}
  left: {through: [{on: bottom, angle: 90}, {on: top, angle: 90}]}
  right: {through: [{on: bottom, angle: -90}, {on: top, angle: -90}]}
panels:
  front: {at: {height: 200, angle: 0}}
  back: {at: {height: 200, angle: 180}}
";

/// Drafts on a cylinder.
fn on_cylinder(name: &str, lines: &str) -> Result<Drafted, String> {
    on_round(name, lines, |_| RADIUS)
}

fn on_round(name: &str, lines: &str, radius: impl Fn(f64) -> f64) -> Result<Drafted, String> {
    let folder = folder(name);
    let (body, file) = (folder.join("body.obj"), folder.join("lines.yaml"));
    fs::write(&body, round(radius)).expect("written");
    fs::write(&file, lines).expect("written");
    draft(&body.display().to_string(), Some(LengthUnit::Millimetre), &file).map_err(|e| e.to_string())
}

fn garment(drafted: &Drafted) -> Garment {
    read_text("draft", "draft.yaml", &drafted.text).unwrap_or_else(|e| panic!("{e}\n{}", drafted.text)).garment
}

/// Length of an edge, mm.
fn length(garment: &Garment, piece: &str, edge: &str) -> f64 {
    let piece = garment.pieces.iter().find(|p| p.name == piece).unwrap_or_else(|| panic!("{piece}"));
    let found = piece.loops.iter().flatten().find(|e| e.name == edge).unwrap_or_else(|| panic!("{edge}"));
    1e3 * found.path.length()
}

/// Circumference of the bodies' polygon, mm.
fn circumference(radius: f64) -> f64 {
    2.0 * SIDES as f64 * radius * (TAU / 2.0 / SIDES as f64).sin()
}

#[test]
fn a_cylinder_in_two_panels_gives_rectangles_of_half_its_girth_with_ease() {
    let made = garment(&on_cylinder("cylinder", TWO_PANELS).expect("drafted"));
    let half = 0.5 * (circumference(RADIUS) + EASE);
    for piece in ["front", "back"] {
        for (edge, wanted) in [("top", half), ("bottom", half), ("left", 300.0), ("right", 300.0)] {
            let found = length(&made, piece, edge);
            assert!((found - wanted).abs() < EXACT, "{piece}.{edge}: {found}, not {wanted}");
        }
        let own = made.pieces.iter().find(|p| p.name == piece).expect(piece);
        let area = 5e5 * own.loops[0].iter().map(|e| e.path.double_area()).sum::<f64>().abs();
        assert!((area - 300.0 * half).abs() < EXACT * (300.0 + half), "{piece}: {area}");
    }
    assert_eq!(made.seams.len(), 2);
}

#[test]
fn a_cone_in_two_panels_gives_equal_sectors_with_equal_seams() {
    let radius = |y: f64| 150.0 - 0.2 * y;
    let lines = TWO_PANELS.replace("ease: 40 mm", "ease: 0");
    let made = garment(&on_round("cone", &lines, radius).expect("drafted"));
    let slant = 300.0 * (1.0f64 + 0.2 * 0.2).sqrt();
    for piece in ["front", "back"] {
        let arcs = [("top", 0.5 * circumference(radius(350.0))), ("bottom", 0.5 * circumference(radius(50.0)))];
        for (edge, wanted) in arcs.into_iter().chain([("left", slant), ("right", slant)]) {
            let found = length(&made, piece, edge);
            // The section of a triangulated cone between two of its rings is a little within its circle.
            assert!((found - wanted).abs() < 10.0 * EXACT, "{piece}.{edge}: {found}, not {wanted}");
        }
    }
    for edge in ["left", "right"] {
        assert!((length(&made, "front", edge) - length(&made, "back", edge)).abs() < EXACT, "{edge}");
    }
}

#[test]
fn wrong_lines_are_refused_by_name() {
    let refused = |name: &str, from: &str, to: &str| {
        assert!(TWO_PANELS.contains(from), "{from}");
        on_cylinder(name, &TWO_PANELS.replace(from, to)).expect_err(name)
    };
    let leaves = refused("leaves", "top: {height: 350}", "top: {height: 900}");
    assert!(leaves.contains("line 'top'") && leaves.contains("leaves the body"), "{leaves}");
    let open = refused("open", "{on: top, angle: 90}", "{height: 300, angle: 90}");
    assert!(open.contains("line 'left'") && open.contains("is open") && open.contains("nearest line"), "{open}");
    let overlaps = refused("overlaps", "angle: 180", "angle: 10");
    assert!(overlaps.contains("panel 'back'") && overlaps.contains("overlaps panel 'front'"), "{overlaps}");
    let height = refused("height", "{on: top, angle: 90}", "{angle: 90}");
    assert!(height.contains("line 'left'") && height.contains("no height"), "{height}");
    let tube = refused("tube", "  right: {through: [{on: bottom, angle: -90}, {on: top, angle: -90}]}\n", "");
    assert!(tube.contains("panel 'front'") && tube.contains("2 rims"), "{tube}");
    let unknown = refused("unknown", "top: {height: 350}", "top: {level: 350}");
    assert!(unknown.contains("unknown field"), "{unknown}");
}

#[test]
fn nothing_is_written_when_a_line_is_wrong() {
    let folder = folder("unwritten");
    fs::write(folder.join("lines.yaml"), TWO_PANELS.replace("top: {height: 350}", "top: {height: 9000}")).expect("ok");
    let args = ["draft", "woman_92", "lines.yaml", "-o", "new.yaml"];
    let done = Command::new(env!("CARGO_BIN_EXE_toile")).args(args).current_dir(&folder).output().expect("run");
    assert_eq!(done.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&done.stderr).contains("line 'top'"));
    assert!(!folder.join("new.yaml").exists());
}
