//! Alterations against closed forms, to 0.01 mm, and what is said of those that cannot be done.

use approx::assert_abs_diff_eq as near;
use toile::geometry::Vec2;
use toile::io::garment::{Loaded, Refused, read_file_only, read_text, write};
use toile::pattern::{DartFile, Edge, Garment, Problem};

/// Largest difference that passes, metres.
const EXACT: f64 = 1e-5;

/// A rectangle of 200 by 400 mm with a dart, and one that is sewn to it.
const BLOCK: &str = "\
garment: 1
pieces:
  front:
    cut: fold center
    grain: [[40, 100], [40, 300]]
    outline: {start: 0 0, top: L 200 0, side: L 200 400, hem: L 0 400, center: L 0 0}
    notches: {side: [100, 300 double]}
    darts: [{name: bust, edge: side, at: 150, intake: 20, length: 90}]
  back:
    cut: fold center
    drawn: R
    grain: [[40, 100], [40, 300]]
    outline: {start: 0 0, top: L 180 0, side: L 180 380, hem: L 0 380, center: L 0 0}
seams:
  side: {sew: front.side, to: back.side}
free: ['*.top', '*.hem']
";

/// A sleeve with a curved cap, cut once.
const SLEEVE: &str = "\
garment: 1
pieces:
  sleeve:
    grain: [[0, 150], [0, 300]]
    outline: {start: -150 100, cap: C -80 60 -80 0 0 0 C 80 0 80 60 150 100, front: L 120 500, hem: L -120 500,
      back: L -150 100}
    notches: {cap: [100], hem: [60, 200]}
seams: {under: {sew: sleeve.front, to: sleeve.back}}
free: [sleeve.cap, sleeve.hem]
";

fn with(block: &str, alterations: &str) -> Result<Loaded, Refused> {
    read_text("test", "test.yaml", &format!("{block}alter:\n{alterations}"))
}

fn made(block: &str, alterations: &str) -> Loaded {
    with(block, alterations).unwrap_or_else(|e| panic!("{e}"))
}

fn plain(block: &str) -> Garment {
    read_text("test", "test.yaml", block).unwrap_or_else(|e| panic!("{e}")).garment
}

fn problem(block: &str, alterations: &str) -> Problem {
    let Err(refused) = with(block, alterations) else { panic!("made: {alterations}") };
    refused.diagnostics[0].problem.clone()
}

fn edge<'g>(garment: &'g Garment, piece: &str, name: &str) -> &'g Edge {
    let piece = garment.pieces.iter().find(|p| p.name == piece).expect("piece");
    piece.loops.iter().flatten().find(|e| e.name == name).unwrap_or_else(|| panic!("{name}"))
}

fn length(garment: &Garment, piece: &str, name: &str) -> f64 {
    edge(garment, piece, name).path.length()
}

fn area(garment: &Garment, piece: &str) -> f64 {
    let piece = garment.pieces.iter().find(|p| p.name == piece).expect("piece");
    piece.loops[0].iter().map(|e| e.path.double_area()).sum::<f64>().abs() / 2.0
}

#[test]
fn a_seam_is_taken_in_by_what_is_said_on_both_sides() {
    let taken = made(BLOCK, "  - {take_in: side, at: {0: 8, 50 %: 5}}\n").garment;
    let front = edge(&taken, "front", "top.L").path.clone();
    near!(front.length(), 0.192, epsilon = EXACT);
    // The middle of the front's side as drawn is 180 mm of seam away from its start, for the dart takes 20 mm.
    let back = edge(&taken, "back", "side.L").path.clone();
    let at_half = back.nearest(Vec2::new(0.175, 0.18)).1.min(back.nearest(Vec2::new(-0.175, 0.18)).1);
    near!(at_half, 0.0, epsilon = EXACT);
    near!(length(&taken, "back", "top.L"), 0.172, epsilon = EXACT);
    near!(length(&taken, "back", "hem.L"), 0.180, epsilon = EXACT);
    near!(length(&taken, "front", "hem.L"), 0.200, epsilon = EXACT);
    let out = made(BLOCK, "  - {let_out: side, at: {0: 8, 100 %: 8}}\n").garment;
    near!(length(&out, "front", "hem.L"), 0.208, epsilon = EXACT);
    near!(length(&out, "back", "side.L"), 0.380, epsilon = EXACT);
}

#[test]
fn partners_stay_equal_where_both_edges_are_alike() {
    let alike = BLOCK.replace("    darts: [{name: bust, edge: side, at: 150, intake: 20, length: 90}]\n", "");
    let alike = alike.replace("180 380", "180 400").replace("L 0 380", "L 0 400");
    let taken = made(&alike, "  - {take_in: side, at: {30 %: 12, 60 %: 4}}\n").garment;
    let (front, back) = (length(&taken, "front", "side.L"), length(&taken, "back", "side.L"));
    near!(front, back, epsilon = 1e-7);
    assert!(front > 0.4004, "a bent seam is longer: {front}");
}

#[test]
fn pieces_grow_and_shrink_by_what_is_said() {
    let longer = made(BLOCK, "  - {lengthen: [front, back], at: 200, by: 20}\n").garment;
    near!(length(&longer, "front", "side.L") + length(&longer, "front", "side.2.L"), 0.4, epsilon = EXACT);
    near!(length(&longer, "back", "side.L"), 0.4, epsilon = EXACT);
    near!(area(&longer, "back"), 2.0 * 0.180 * 0.4, epsilon = 1e-8);
    let file =
        made(BLOCK, "  - {lengthen: front, at: 200, by: 20, over: 100}\n  - {lengthen: back, at: 0, by: 20}\n").file;
    // The notch at 300 lies beyond the stretch and goes down by 20, that at 100 stays.
    let notches: Vec<f64> = file.pieces[0].notches[0].1.iter().map(|n| n.value.at.number).collect();
    assert_eq!(notches, [100.0, 320.0]);
    let shorter = made(SLEEVE, "  - {shorten: sleeve, at: 300, by: 15}\n").garment;
    near!(length(&shorter, "sleeve", "hem"), 0.240, epsilon = EXACT);
    let wider = made(BLOCK, "  - {lengthen: back, along: x, at: 90, by: 10}\n").garment;
    near!(length(&wider, "back", "hem.L"), 0.190, epsilon = EXACT);
}

#[test]
fn a_dart_that_is_turned_keeps_lengths_area_and_legs() {
    let before = plain(BLOCK);
    let turned = made(BLOCK, "  - {pivot: front.bust, to: front.top@50 %}\n").garment;
    let sides = |g: &Garment| length(g, "front", "side.L") + length(g, "front", "side.2.L");
    near!(length(&turned, "front", "side.L"), sides(&before), epsilon = EXACT);
    near!(length(&turned, "front", "top.L") + length(&turned, "front", "top.2.L"), 0.2, epsilon = EXACT);
    near!(area(&turned, "front"), area(&before, "front"), epsilon = 1e-8);
    let [a, b] = ["bust.a.L", "bust.b.L"].map(|leg| length(&turned, "front", leg));
    near!(a, b, epsilon = EXACT);
    // From the tip (110, 150) to the middle of the top (100, 0).
    near!(a, (0.01f64.powi(2) + 0.15f64.powi(2)).sqrt(), epsilon = EXACT);
}

#[test]
fn a_part_of_a_dart_is_split_off() {
    let made = made(BLOCK, "  - {pivot: front.bust, to: front.hem@50 %, share: 50 %, name: waist}\n");
    let split = made.garment;
    let mouth = |name: &str| {
        let is = |d: &&DartFile| d.name.as_ref().is_some_and(|n| n.value == name);
        made.file.pieces[0].darts.iter().find(is).expect("dart").intake.value.number / 1e3
    };
    let angle = 2.0 * (10.0f64 / 90.0).atan();
    let leg = (0.09f64.powi(2) + 0.01f64.powi(2)).sqrt();
    near!(mouth("bust"), 2.0 * leg * (angle / 4.0).sin(), epsilon = EXACT);
    // From the tip (110, 150) to the middle of the hem (100, 400).
    near!(mouth("waist"), 2.0 * 0.01f64.hypot(0.25) * (angle / 4.0).sin(), epsilon = EXACT);
    near!(length(&split, "front", "side.L") + length(&split, "front", "side.2.L"), 0.38, epsilon = EXACT);
}

#[test]
fn a_slash_opens_by_what_is_said_and_keeps_every_other_length() {
    let before = plain(SLEEVE);
    let hinged = made(SLEEVE, "  - {spread: sleeve.hem@50 %, to: sleeve.cap@50 %, by: 60}\n");
    near!(length(&hinged.garment, "sleeve", "hem"), 0.300, epsilon = EXACT);
    for name in ["cap", "front", "back"] {
        near!(length(&hinged.garment, "sleeve", name), length(&before, "sleeve", name), epsilon = EXACT);
    }
    // A triangle 60 mm wide and as high as the slash, less what the turned halves leave of it.
    let high = (0.5f64.powi(2) - 0.03f64.powi(2)).sqrt();
    near!(area(&hinged.garment, "sleeve") - area(&before, "sleeve"), 0.5 * 0.06 * high, epsilon = 1e-7);
    let notches: Vec<f64> = hinged.file.pieces[0].notches[1].1.iter().map(|n| n.value.at.number).collect();
    near!(notches[0], 60.0, epsilon = 0.01);
    near!(notches[1], 260.0, epsilon = 0.01);
    let wide = made(SLEEVE, "  - {spread: sleeve.hem@50 %, to: sleeve.cap@50 %, by: 40, to_by: 40}\n").garment;
    near!(length(&wide, "sleeve", "hem"), 0.280, epsilon = EXACT);
    near!(length(&wide, "sleeve", "cap"), length(&before, "sleeve", "cap") + 0.04, epsilon = EXACT);
    near!(area(&wide, "sleeve") - area(&before, "sleeve"), 0.04 * 0.5, epsilon = 1e-7);
}

#[test]
fn points_of_an_edge_move_as_they_are_told() {
    let lower = made(BLOCK, "  - {move: front.top, at: {0: [0, 12]}}\n").garment;
    near!(area(&lower, "front"), 2.0 * (0.2 * 0.4 - 0.2 * 0.012 / 2.0) - 2.0 * 0.5 * 0.02 * 0.09, epsilon = 1e-7);
    let bowed = made(BLOCK, "  - {move: front.hem, at: {50 %: [0, 10]}}\n").garment;
    let hem = &edge(&bowed, "front", "hem.L").path;
    let lowest = hem.nearest(Vec2::new(0.1, 0.41)).1.min(hem.nearest(Vec2::new(-0.1, 0.41)).1);
    near!(lowest, 0.0, epsilon = EXACT);
    near!(length(&bowed, "front", "side.2.L"), 0.24, epsilon = EXACT);
}

#[test]
fn the_altered_file_is_a_garment_file_that_reads_as_the_same() {
    let all = "  - {take_in: side, at: {30 %: 6}}\n  - {pivot: front.bust, to: front.top@50 %}\n  \
               - {lengthen: [front, back], at: 250, by: 20}\n  - {move: back.top, at: {50 %: [0, 5]}}\n";
    let loaded = made(BLOCK, all);
    let text = write(&loaded.file).expect("YAML");
    assert!(!text.contains("alter:"), "{text}");
    let again = read_text("test", "again.yaml", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(again.file, loaded.file);
    for (a, b) in loaded.garment.pieces.iter().zip(&again.garment.pieces) {
        for (a, b) in a.loops.iter().flatten().zip(b.loops.iter().flatten()) {
            near!(a.path.length(), b.path.length(), epsilon = 1e-8);
        }
    }
    // What is said and not yet carried out is written as it was.
    let said = format!("{BLOCK}alter:\n{all}sizes:\n  40: [{{let_out: side, at: {{0: 5}}}}]\n");
    let file = read_file_only("said.yaml", &said).expect("file");
    assert_eq!(read_file_only("said.yaml", &write(&file).expect("YAML")).expect("file"), file);
}

#[test]
fn a_piece_that_is_like_another_can_be_altered_alone() {
    let block = BLOCK.replace(
        "    outline: {start: 0 0, top: L 180 0, side: L 180 380, hem: L 0 380, center: L 0 0}\n",
        "    like: front\n",
    );
    let garment = made(&block, "  - {lengthen: back, along: x, at: 0, by: 10, over: 50}\n").garment;
    near!(length(&garment, "back", "hem.L"), 0.21, epsilon = EXACT);
    near!(length(&garment, "front", "hem.L"), 0.2, epsilon = EXACT);
}

#[test]
fn pieces_that_are_like_one_another_are_altered_once_each() {
    let block = "\
garment: 1
pieces:
  front:
    grain: [[40, 100], [40, 300]]
    outline: {start: 0 0, top: L 200 0, right: L 200 400, hem: L 0 400, left: L 0 0}
  back: {like: front}
seams:
  one: {sew: front.right, to: back.left}
  other: {sew: front.left, to: back.right}
free: ['*.top', '*.hem']
";
    let longer = made(block, "  - {lengthen: [front, back], at: 200, by: 20}\n").garment;
    near!(length(&longer, "front", "right"), 0.42, epsilon = EXACT);
    near!(length(&longer, "back", "right"), 0.42, epsilon = EXACT);
    // One edge of each piece, not both of the one that is like the other.
    let taken = made(block, "  - {take_in: one, at: {0: 15, 100 %: 15}}\n").garment;
    for piece in ["front", "back"] {
        near!(length(&taken, piece, "hem"), 0.185, epsilon = EXACT);
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let is = |alteration: &str, expected: fn(&Problem) -> bool| {
        let found = problem(BLOCK, alteration);
        assert!(expected(&found), "{alteration}: {found:?}");
    };
    is(
        "  - {take_in: sid, at: {0: 8}}\n",
        |p| matches!(p, Problem::UnknownSeam { nearest: Some(n), .. } if n == "side"),
    );
    is("  - {lengthen: frnt, at: 10, by: 8}\n", |p| matches!(p, Problem::UnknownPiece { nearest: Some(_), .. }));
    is("  - {move: front.hm, at: {0: [0, 1]}}\n", |p| matches!(p, Problem::UnknownEdge { nearest: Some(_), .. }));
    is("  - {pivot: front.bst, to: front.top@50 %}\n", |p| matches!(p, Problem::UnknownDart { nearest: Some(_), .. }));
    is("  - {pivot: front.bust, to: front.top}\n", |p| matches!(p, Problem::AlterPoint(_)));
    is("  - {pivot: front.bust, to: front.center@50 %}\n", |p| matches!(p, Problem::AlterFold { .. }));
    is("  - {pivot: front.bust, to: back.top@50 %}\n", |p| matches!(p, Problem::AlterTwoPieces { .. }));
    is("  - {move: front.top, at: {300: [0, 1]}}\n", |p| matches!(p, Problem::AlterOff { .. }));
    is("  - {move: front.top, at: {0: [5, 1]}}\n", |p| matches!(p, Problem::AlterFold { .. }));
    is("  - {move: front.hem, at: {50 %: [0, -500]}}\n", |p| matches!(p, Problem::AlterCrosses { .. }));
    is("  - {take_in: side, at: {50 %: 900}}\n", |p| matches!(p, Problem::AlterAmount { .. }));
    is("  - {lengthen: front, at: 500, by: 10}\n", |p| matches!(p, Problem::AlterAmount { .. }));
    is("  - {shorten: front, at: 100, by: 60, over: 50}\n", |p| matches!(p, Problem::AlterAmount { .. }));
    is("  - {spread: back.hem@50 %, to: back.top@50 %, by: 600}\n", |p| matches!(p, Problem::AlterAmount { .. }));
    // Through the dart.
    is("  - {spread: front.top@75 %, to: front.hem@25 %, by: 20}\n", |p| matches!(p, Problem::AlterShape { .. }));
    // The seam no longer matches, and by how much is said.
    is(
        "  - {lengthen: back, at: 100, by: 20}\n",
        |p| matches!(p, Problem::LengthsApart { apart, .. } if (apart - 20.0).abs() < 0.01),
    );
}
