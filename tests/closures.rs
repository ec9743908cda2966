//! Closures: what they close, and how far they stand apart.

#![allow(clippy::unwrap_used, reason = "tests may")]

use std::path::Path;

use toile::geometry::Vec3;
use toile::io::garment::{Refused, read_text};
use toile::mannequin::Mannequin;
use toile::mesh::{ClothMesh, build};
use toile::pattern::{Garment, openings};
use toile::pipeline::{self, Job, Overrides, Run};
use toile::report::{Bands, Measured, Report, measure, table, verdicts};

/// A tube of a pair of halves, 100 mm wide each, open in front; `closures` and what else is drawn.
fn tube(closures: &str, more: &str) -> Garment {
    file(closures, more, "").unwrap_or_else(|e| panic!("{e}"))
}

/// The same with a test of its own.
fn bounded(test: &str) -> Garment {
    file(BUTTONS, "", test).unwrap_or_else(|e| panic!("{e}"))
}

/// `more` is nothing, [`PATCH`] or [`SLIT`].
fn file(closures: &str, more: &str, test: &str) -> Result<Garment, Refused> {
    let text = format!(
        "\
garment: 1
pieces:
  half:
    cut: pair
    drawn: R
    grain: [[0, 0], [0, 9]]
    outline:
      start: 0 0
      top: L 100 0
      back: L 100 200
      hem: L 0 200
      front: L 0 0
{more}seams:
  back: {{sew: half.back, to: mirror}}
closures: [{closures}]
free: [half.top, half.hem, half.front{}]
tests: [{test}]
",
        match more {
            PATCH => ", \"patch.*\"",
            SLIT => ", half.slit",
            _ => "",
        }
    );
    Ok(read_text("tube", "tube.yaml", &text)?.garment)
}

const BUTTONS: &str = "{kind: button, piece: half.L, at: [10, 20], meets: half.R, pitch: 50, count: 4}";
const PATCH: &str = "  patch:
    grain: [[0, 0], [0, 9]]
    outline: {start: 0 0, top: L 40 0, right: L 40 40, bottom: L 0 40, left: L 0 0}
";
const SLIT: &str = "    holes: {slit: M 40 60 L 42 60 L 42 140 L 40 140 Z}\n";

/// The tube bent round so that its fronts are `apart` (metres), further by `bulge` half-way between two buttons.
fn worn(garment: &Garment, apart: f64, bulge: f64) -> Report {
    let mesh = build(garment, 0.01).unwrap();
    let radius = (0.2 + apart) / std::f64::consts::TAU;
    let at: Vec<Vec3> = (0..mesh.flat.len()).map(|p| bent(&mesh, p, radius, apart, bulge)).collect();
    measured(garment, &mesh, &welded(&mesh), &at)
}

/// A label per particle, the same for those that seams join.
fn welded(mesh: &ClothMesh) -> Vec<u32> {
    let mut weld: Vec<u32> = (0..mesh.flat.len() as u32).collect();
    let pairs: Vec<[u32; 2]> = mesh.seams.iter().flat_map(|s| s.pairs.clone()).collect();
    // Where several seams meet, until no label sinks any more.
    while pairs.iter().any(|&[a, b]| weld[a as usize] != weld[b as usize]) {
        for &[a, b] in &pairs {
            let label = weld[a as usize].min(weld[b as usize]);
            (weld[a as usize], weld[b as usize]) = (label, label);
        }
    }
    weld
}

fn measured(garment: &Garment, mesh: &ClothMesh, weld: &[u32], at: &[Vec3]) -> Report {
    let body = Mannequin { name: "nobody".into(), mesh: Default::default(), parts: vec![], frame: Default::default() };
    measure(&Measured {
        garment,
        mesh,
        weld,
        uncrossed: None,
        body: &body,
        fabric: "muslin",
        gaps: None,
        placed: None,
        sewn: Some(at),
        draped: None,
        flattened: None,
        overlaps: None,
        pressed: None,
        gives: &[],
        bands: Bands::default(),
        stages: &[],
    })
}

fn bent(mesh: &ClothMesh, p: usize, radius: f64, apart: f64, bulge: f64) -> Vec3 {
    let piece = mesh.pieces.iter().find(|piece| piece.particles.contains(&p)).unwrap();
    let flat = mesh.flat[p];
    // Distance of the particle from the front edge; the left half is the mirror image.
    let low = mesh.flat[piece.particles.clone()].iter().map(|q| q.x.abs()).fold(f64::INFINITY, f64::min);
    let across = flat.x.abs() - low;
    let side = if piece.name.ends_with('R') { -1.0 } else { 1.0 };
    let wave = (std::f64::consts::TAU * (flat.y - 0.02) / 0.05).cos();
    let out = if across < 0.025 { side * bulge * (1.0 - wave) / 2.0 } else { 0.0 };
    let angle = side * (apart / 2.0 + across) / radius;
    Vec3::new(radius * angle.sin(), -flat.y, radius * angle.cos() + out)
}

/// A closure on something that is not cut would go silently.
#[test]
fn a_closure_names_a_piece_that_is_cut() {
    let refused = |carrier: &str, cut: &str| {
        let more = PATCH.replace("patch:\n", &format!("patch:\n{cut}"));
        let closure = format!("{{kind: hook, on: {carrier}, at: [20, 20], meets: half.L, meets_at: [20, 20]}}");
        file(&closure, &more, "").expect_err(carrier).to_string()
    };
    let copies = "'patch.7' is not cut; there is patch.1, patch.2, patch.3";
    assert!(refused("patch.7", "    cut: 3\n").contains(copies));
    for (carrier, said) in [
        ("patch.L", "'patch.L' is not cut; there is patch"),
        ("half.2", "'half.2' is not cut; there is half.R, half.L"),
        ("half.L.front.R", "'half.L.front.R' says more than one side"),
        ("half..L", "'half..L' names no edge"),
    ] {
        let text = refused(carrier, "");
        assert!(text.contains(said), "{carrier}: {text}");
    }
}

/// The second of them would be forgotten.
#[test]
fn a_closure_has_one_carrier() {
    for (one, other) in [("piece", "edge"), ("piece", "on"), ("edge", "on")] {
        let closure = format!("{{kind: hook, {one}: half.L, {other}: half.R, at: [20, 20], meets: half.R}}");
        let text = file(&closure, "", "").expect_err("two carriers").to_string();
        assert!(text.contains(&format!("'{one}' and '{other}' exclude each other")), "{text}");
    }
}

#[test]
fn a_buttoned_front_leaves_a_neck_and_a_hem() {
    assert_eq!(openings(&tube("", "")).len(), 1);
    let buttoned = openings(&tube(BUTTONS, ""));
    let lengths: Vec<f64> = buttoned.iter().map(|o| (o.length * 1e3).round()).collect();
    // Both tops and 20 mm of either front; both hems and 30 mm.
    assert_eq!(lengths, [240.0, 260.0]);
}

#[test]
fn what_is_tacked_on_is_no_opening() {
    let corners = "{kind: tack, piece: patch, at: [[2, 2], [38, 2]], meets: half.R, meets_at: [[40, 60], [76, 60]]}";
    assert_eq!(openings(&tube("", PATCH)).len(), 2);
    assert_eq!(openings(&tube(corners, PATCH)).len(), 1);
}

#[test]
fn a_closed_front_is_no_opening_of_the_report() {
    let garment = tube(BUTTONS, "");
    let closed = worn(&garment, -0.02, 0.0);
    let names: Vec<&str> = closed.worn.iter().map(|w| w.opening.as_str()).collect();
    assert_eq!(names, ["front + top", "front + hem"]);
    let row = &closed.closures[0];
    assert_eq!((row.on.as_deref(), row.meets.as_deref(), row.points), (Some("half.L"), Some("half.R"), 4));
    assert!(row.closed && row.note.is_none() && row.gap_max.unwrap() < 3.0, "{row:?}");
    // Buttons that did not come together close nothing.
    let open = worn(&garment, 0.03, 0.0);
    assert_eq!(open.worn.len(), 1);
    assert!(!open.closures[0].closed && table(&open).contains("OPEN"), "{}", table(&open));
    // A garment that is tested for nothing of the kind is out of bounds all the same.
    let fails = |report: &Report| verdicts(&garment, report).into_iter().any(|v| !v.ok && v.bound == "closure all");
    assert!(fails(&open) && !fails(&closed));
}

#[test]
fn a_closure_that_does_not_close_is_said_and_can_be_bounded() {
    let garment = bounded("{closure: button, below: 5 mm}");
    let closed = worn(&garment, -0.02, 0.0);
    assert_eq!(closed.closures[0].unclosed(), None);
    let kept = verdicts(&garment, &closed);
    assert!(kept.len() == 1 && kept[0].ok && kept[0].bound == "closure button", "{kept:?}");
    // The buttons are 10 mm from either front.
    let open = worn(&garment, 0.03, 0.0);
    let said = open.closures[0].unclosed().unwrap();
    let words = ["button on half.L", "half.R", "closed: 20 mm", "'meets_at'"];
    assert!(words.iter().all(|w| said.contains(w)), "{said}");
    let broken = verdicts(&garment, &open);
    assert!(!broken[0].ok && broken[0].measured > 45.0 && broken[0].at.as_deref() == Some("button on half.L"));
    // Of closures that are only listed nothing can be measured.
    let refused = |closures: &str, test: &str| file(closures, "", test).unwrap_err().to_string();
    assert!(refused(BUTTONS, "{closure: buton, below: 5}").contains("did you mean 'button'"));
    assert!(
        refused("{kind: zip}", "{closure: all, below: 5}").contains("'piece' (or 'edge' or 'on'), 'at' and 'meets'")
    );
}

#[test]
fn a_buttoned_slit_is_no_opening() {
    let tube = |closures: &str| file(closures, SLIT, "").unwrap();
    let lengths = |g: &Garment| openings(g).iter().map(|o| (o.length * 1e3).round()).collect::<Vec<f64>>();
    assert_eq!(lengths(&tube("")), [800.0, 164.0, 164.0]);
    let button = |half: &str, x: [f64; 2]| {
        format!(
            "{{kind: button, piece: half.{half}, at: [{}, 100], meets: half.{half}, meets_at: [{}, 100]}}",
            x[0], x[1]
        )
    };
    let closed = tube(&format!("{}, {}", button("L", [38.0, 44.0]), button("R", [38.0, 44.0])));
    assert_eq!(lengths(&closed), [800.0]);
}

/// A rim in a point of which three layers meet; beside it, a tube that is buttoned.
#[test]
fn a_rim_without_an_order_leaves_the_others_closed() {
    let text = "\
garment: 1
pieces:
  half:
    cut: pair
    drawn: R
    grain: [[0, 0], [0, 9]]
    outline: {start: 0 0, top: L 100 0, back: L 100 200, hem: L 0 200, front: L 0 0}
  shell:
    grain: [[0, 0], [0, 9]]
    outline: {start: 0 0, top: L 100 0, right: L 100 90, bottom: L 0 90, left: L 0 0}
  band: {like: shell}
  lining: {like: shell, layer: -1}
seams:
  back: {sew: half.back, to: mirror}
  waist: {sew: shell.top, to: band.bottom}
  facing: {sew: shell.top, to: lining.top, face: same, layers: [0, -1]}
closures: [{kind: button, piece: half.L, at: [10, 20], meets: half.R, pitch: 50, count: 4}]
free: [\"half.*\", \"shell.*\", \"band.*\", \"lining.*\"]
";
    let garment = read_text("rims", "rims.yaml", text).unwrap_or_else(|e| panic!("{e}")).garment;
    let rims = openings(&garment);
    let lengths: Vec<f64> = rims.iter().map(|o| (o.length * 1e3).round()).collect();
    assert_eq!(lengths[..2], [240.0, 260.0], "{lengths:?}");
    assert!(rims[2..].iter().all(|o| garment.opening_edges(o).iter().all(|e| !e.starts_with("half"))));
}

/// How many openings the report finds in a vest whose fronts lie over each other with the buttons `inset` (metres) from
/// their edges.
fn rims_of_surface(garment: &Garment, inset: f64) -> usize {
    let mesh = build(garment, 0.01).unwrap();
    let weld = welded(&mesh);
    let at = |p: usize| {
        let (piece, flat) = (mesh.pieces.iter().find(|piece| piece.particles.contains(&p)).unwrap(), mesh.flat[p]);
        let (shift, z) = match (piece.name.starts_with("front"), piece.name.ends_with('L')) {
            (true, true) => (-inset, 0.1),
            (true, false) => (inset, 0.102),
            _ => (0.0, -0.1),
        };
        Vec3::new(flat.x + shift, -flat.y, z)
    };
    let at: Vec<Vec3> = (0..mesh.flat.len()).map(at).collect();
    measured(garment, &mesh, &weld, &at).worn.len()
}

/// A vest of pairs, its lining sewn on all round: neck and fronts, armholes, hem; buttoned, so far from the edge.
fn lined(inset: f64, closures: bool) -> Garment {
    let at = format!("[[{inset}, 110], [{inset}, 190]]");
    let buttons = format!("[{{kind: button, piece: front.R, at: {at}, meets: front.L, meets_at: {at}}}]");
    let text = format!(
        "\
garment: 1
pieces:
  front:
    cut: pair
    grain: [[50, 50], [50, 150]]
    outline: {{start: 0 80, neck: L 60 0, shoulder: L 110 10, armhole: L 120 90, side: L 120 200, hem: L 0 200,
      edge: L 0 80}}
  back:
    cut: fold center
    drawn: R
    grain: [[50, 50], [50, 150]]
    outline: {{start: 0 20, neck: L 60 0, shoulder: L 110 10, armhole: L 120 90, side: L 120 200, hem: L 0 200,
      center: L 0 20}}
  front_lining: {{like: front, layer: -1}}
  back_lining: {{like: back, layer: -1}}
seams:
  shoulder: {{sew: front.shoulder, to: back.shoulder}}
  side: {{sew: front.side, to: back.side}}
  shoulder_lining: {{sew: front_lining.shoulder, to: back_lining.shoulder}}
  side_lining: {{sew: front_lining.side, to: back_lining.side}}
  fronts: {{sew: [front.neck, front.edge, front.hem], to: [front_lining.neck, front_lining.edge, front_lining.hem],
    face: same}}
  neck: {{sew: back.neck, to: back_lining.neck, face: same}}
  hem: {{sew: back_lining.hem, to: back.hem, face: same}}
  arm_front: {{sew: front.armhole, to: front_lining.armhole, face: same}}
  arm_back: {{sew: back.armhole, to: back_lining.armhole, face: same}}
closures: {}
",
        if closures { &buttons } else { "[]" }
    );
    read_text("vest", "vest.yaml", &text).unwrap_or_else(|e| panic!("{e}\n{text}")).garment
}

/// Where two layers end together, each is a rim of cloth; `check`, which knows seams alone, and the report, which knows
/// the surface, say the same of it.
#[test]
fn a_lining_sewn_on_all_round_leaves_the_openings_of_its_shell() {
    for (inset, closures, count) in [(20.0, false, 3), (20.0, true, 4), (4.0, true, 4)] {
        let garment = lined(inset, closures);
        let rims = openings(&garment);
        let names: Vec<Vec<String>> = rims.iter().map(|o| garment.opening_edges(o)).collect();
        assert_eq!(rims.len(), count, "{inset} {closures} {names:?}");
        let has = |all: &[&str], none: &[&str]| {
            let part = |names: &Vec<String>, word: &str| names.iter().any(|n| n.contains(word));
            names.iter().any(|n| all.iter().all(|w| part(n, w)) && none.iter().all(|w| !part(n, w)))
        };
        assert!(has(&["neck"], &["hem", "armhole"]) == closures && has(&["armhole"], &["neck", "hem"]), "{names:?}");
        assert_eq!(rims_of_surface(&garment, 1e-3 * inset), count, "{inset} {closures}");
    }
}

#[test]
fn sides_that_bulge_between_the_buttons_gape() {
    let garment = tube(BUTTONS, "");
    let row = worn(&garment, -0.02, 0.006).closures[0].clone();
    // 6 mm to either side.
    assert!(row.closed && (row.gape.unwrap() - 12.0).abs() < 1.5, "{row:?}");
    assert!(worn(&garment, -0.02, 0.0).closures[0].gape.unwrap() < 3.0);
}

/// The half that carries the buttons lies on the wrong side of the other, 3 mm away; between two heights (metres below
/// the top) on its right side. The tube has its wrong side out.
#[test]
fn a_lap_keeps_its_order_from_button_to_button() {
    let garment = tube(BUTTONS, "");
    let mesh = build(&garment, 0.01).unwrap();
    let lapped = |turned: std::ops::Range<f64>| {
        let at = |p: usize| {
            let at = bent(&mesh, p, 0.18 / std::f64::consts::TAU, -0.02, 0.0);
            let under = mesh.pieces[0].particles.contains(&p) == (mesh.pieces[0].name == "half.L");
            let out = if under != turned.contains(&mesh.flat[p].y) { 0.0015 } else { -0.0015 };
            at + Vec3::new(at.x, 0.0, at.z).normalize() * out
        };
        let at: Vec<Vec3> = (0..mesh.flat.len()).map(at).collect();
        measured(&garment, &mesh, &welded(&mesh), &at)
    };
    let fails =
        |report: &Report| verdicts(&garment, report).into_iter().any(|v| !v.ok && v.bound.starts_with("lap of"));
    let kept = lapped(9.0..9.0);
    assert!(kept.closures[0].turned.is_none() && !fails(&kept), "{:?}", kept.closures);
    let report = lapped(0.072..0.118);
    let turned = report.closures[0].turned.as_ref().expect("a part in the wrong order");
    assert!((turned.length - 40.0).abs() < 15.0, "{turned:?}");
    assert_eq!(turned.at, "between points 2 and 3, 'half.L' lies over 'half.R'");
    assert!(fails(&report));
}

#[test]
fn a_closure_without_a_partner_says_so() {
    let alone = worn(&tube("{kind: button, piece: half.L, at: [5, 15]}", ""), -0.02, 0.0);
    let row = &alone.closures[0];
    assert_eq!(row.meets.as_deref(), Some("half.R"));
    assert!(!row.closed && row.gap_max.is_some() && row.note.as_ref().unwrap().contains("not tied"), "{row:?}");
    assert_eq!(alone.worn.len(), 1);
    let patch = worn(&tube("{kind: button, piece: patch, at: [5, 15]}", PATCH), -0.02, 0.0);
    assert!(patch.closures[0].note.as_ref().unwrap().contains("not clear"), "{:?}", patch.closures[0]);
    let zip = worn(&tube("{kind: zip, edge: half.L.front, meets: half.R.front}", ""), -0.02, 0.0);
    assert!(zip.closures[0].note.as_ref().unwrap().contains("no points"), "{:?}", zip.closures[0]);
}

/// The ends of a band that laps start where the ring puts them, here 200 mm from where their buttons hold them. A skirt
/// that was open when it began to fall slid to the hips, and no button brought it up again. (In cells of 14 mm: in
/// larger ones the particles that are tied lie up to half a cell from their buttons.)
#[test]
fn a_wrap_skirt_is_buttoned_before_it_falls() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/wrap_skirt.yaml");
    let overrides = Overrides { spacing: Some(0.014), ..Overrides::default() };
    let job = Job::new(&file, pipeline::read(&file).unwrap(), &overrides).unwrap();
    let mut run = Run::new(&job);
    run.sew(&mut |_, _| {}).unwrap();
    let report = run.report();
    assert!(report.closures[0].gap_max.unwrap() < 8.0, "{:?}", report.closures);
    assert!(report.seams.iter().all(|s| s.gap_max < 1.0));
}
