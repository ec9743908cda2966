//! Pieces cut along style lines, and fullness, against closed forms to 0.01 mm.

use approx::assert_abs_diff_eq as near;
use toile::io::garment::{Loaded, Refused, read_file_only, read_text, write};
use toile::pattern::{CutKind, Garment, Problem};

/// Largest difference that passes, metres.
const EXACT: f64 = 1e-5;

/// A rectangle of 200 by 400 mm with a dart and notches, and one that is sewn to it.
const BLOCK: &str = "\
garment: 1
pieces:
  front:
    cut: fold center
    grain: [[40, 100], [40, 200]]
    outline: {start: 0 0, top: L 200 0, side: L 200 400, hem: L 0 400, center: L 0 0}
    notches: {side: [100, 300 double]}
    allowance: {hem: 40, side: 15}
    darts: [{name: bust, edge: side, at: 150, intake: 20, length: 90}]
    lines: {pocket: {path: M 20 300 L 80 300, kind: place}}
  back:
    cut: fold center
    drawn: R
    grain: [[40, 100], [40, 300]]
    outline: {start: 0 0, top: L 180 0, side: L 180 380, hem: L 0 380, center: L 0 0}
    notches: {side: [100, 280 double]}
seams:
  side: {sew: front.side, to: back.side}
free: ['*.top', '*.hem']
";

fn with(alteration: &str) -> Result<Loaded, Refused> {
    read_text("test", "test.yaml", &format!("{BLOCK}alter: [{alteration}]\n"))
}

fn made(alteration: &str) -> Loaded {
    with(alteration).unwrap_or_else(|e| panic!("{alteration}\n{e}"))
}

fn length(garment: &Garment, piece: &str, name: &str) -> f64 {
    let piece = garment.pieces.iter().find(|p| p.name == piece).unwrap_or_else(|| panic!("{piece}"));
    let edge = piece.loops.iter().flatten().find(|e| e.name == name).unwrap_or_else(|| panic!("{name}"));
    edge.path.length()
}

fn area(garment: &Garment, piece: &str) -> f64 {
    let piece = garment.pieces.iter().find(|p| p.name == piece).expect("piece");
    piece.loops[0].iter().map(|e| e.path.double_area()).sum::<f64>().abs() / 2.0
}

/// The dart's part of a half of the front.
const DART: f64 = 0.020 * 0.090 / 2.0;

#[test]
fn a_line_across_the_fold_cuts_both_halves() {
    let loaded = made("{cut: front.side@60 %, to: front.center@40 %, name: skirt, seam: waist}");
    let garment = &loaded.garment;
    near!(area(garment, "front"), 2.0 * (0.2 * 0.24 - DART), epsilon = 1e-8);
    near!(area(garment, "skirt"), 2.0 * 0.2 * 0.16, epsilon = 1e-8);
    near!(length(garment, "skirt", "side.L"), 0.16, epsilon = EXACT);
    near!(length(garment, "front", "waist.L"), 0.2, epsilon = EXACT);
    // Both parts are sewn to the back, in the order of its edge, and to each other.
    let file = &loaded.file;
    let texts = |k: usize| file.seams[k].sew.iter().map(|t| t.value.clone()).collect::<Vec<_>>();
    assert_eq!((file.seams[0].name.value.as_str(), texts(0)), ("waist", vec!["front.waist".to_owned()]));
    assert_eq!(texts(1), ["front.side", "skirt.side"]);
    let [front, skirt] = [0, 1].map(|k| &file.pieces[k]);
    assert_eq!(front.notches[0].1[0].value.at.number, 100.0);
    near!(skirt.notches[0].1[0].value.at.number, 60.0, epsilon = 1e-9);
    assert!(skirt.notches[0].1[0].value.double && front.darts.len() == 1 && skirt.darts.is_empty());
    assert!(front.lines.is_empty() && skirt.lines[0].name.value == "pocket");
    assert!(matches!(skirt.cut.as_ref().map(|c| &c.value), Some(CutKind::Fold(edge)) if edge == "center"));
    // Written out and read again it is the same garment.
    let again = read_file_only("new.yaml", &write(file).expect("text")).expect("read");
    assert_eq!(again.pieces[1].outline.as_ref().map(|o| o.edges.len()), Some(4));
}

#[test]
fn a_curved_line_beside_the_fold_leaves_a_pair() {
    let loaded = made("{cut: front.top@50 %, to: front.hem@50 %, via: [[85, 150], [90, 250]], name: side_front}");
    let garment = &loaded.garment;
    let names: Vec<&str> = garment.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["front", "side_front.L", "side_front.R", "back"]);
    let whole = area(garment, "front") + area(garment, "side_front.L") + area(garment, "side_front.R");
    near!(whole, 2.0 * (0.2 * 0.4 - DART), epsilon = 1e-8);
    let [one, other] = [("front", "side_front.L"), ("side_front.L", "side_front")].map(|(p, e)| length(garment, p, e));
    near!(one, other, epsilon = 1e-7);
    assert!(one > 0.401, "straight: {one}");
    let seam = garment.seams.iter().find(|s| s.name == "side_front.L").expect("the new seam");
    near!(seam.length_a(), seam.length_b(), epsilon = 1e-7);
    assert_eq!(loaded.file.pieces[1].darts.len(), 1, "the dart is of the part that has its edge");
    assert_eq!(loaded.file.seams[1].sew[0].value, "side_front.side");
}

#[test]
fn a_piece_can_be_cut_twice_and_within_one_edge() {
    let one = "{cut: back.side@25 %, to: back.side@75 %, via: [[100, 190]], name: gusset}";
    let loaded = made(one);
    near!(length(&loaded.garment, "gusset.R", "side"), 0.19, epsilon = EXACT);
    near!(length(&loaded.garment, "back", "side_2.L"), 0.095, epsilon = EXACT);
    let to: Vec<&str> = loaded.file.seams[1].to.iter().map(|t| t.value.as_str()).collect();
    assert_eq!(to, ["back.side", "gusset.side", "back.side_2"]);
    let twice = "{cut: front.side@60 %, to: front.center@40 %, name: skirt}, \
                 {cut: skirt.side@50 %, to: skirt.center@50 %, name: flounce}";
    near!(area(&made(twice).garment, "flounce"), 2.0 * 0.2 * 0.08, epsilon = 1e-8);
}

#[test]
fn fullness_opens_each_slash_alike() {
    let hinged = made("{fullness: back.hem, to: back.top, by: 60, slashes: 3}").garment;
    near!(length(&hinged, "back", "hem.L"), 0.24, epsilon = EXACT);
    near!(length(&hinged, "back", "top.L"), 0.18, epsilon = EXACT);
    near!(length(&hinged, "back", "side.L"), 0.38, epsilon = EXACT);
    let wedge = 0.01 * (0.38f64.powi(2) - 0.01f64.powi(2)).sqrt();
    near!(area(&hinged, "back"), 2.0 * (0.18 * 0.38 + 3.0 * wedge), epsilon = 1e-7);
    let even = made("{fullness: back.hem, to: back.top, by: 60, to_by: 60, slashes: 4}").garment;
    near!(area(&even, "back"), 2.0 * 0.24 * 0.38, epsilon = 1e-7);
    for edge in ["hem.L", "top.L"] {
        near!(length(&even, "back", edge), 0.24, epsilon = EXACT);
    }
    // Without their number the slashes are 50 mm apart or so.
    near!(length(&made("{fullness: back.hem, to: back.top, by: 2 cm}").garment, "back", "hem.L"), 0.2, epsilon = EXACT);
}

#[test]
fn what_was_cut_can_be_joined_again() {
    let cuts = [
        "{cut: front.side@60 %, to: front.center@40 %, via: [[100, 220]], name: other, seam: line}",
        "{cut: front.top@50 %, to: front.hem@50 %, via: [[85, 150], [90, 250]], name: other, seam: line}",
        "{cut: front.side@20 %, to: front.side@80 %, via: [[50, 200]], name: other, seam: line}",
    ];
    for cut in cuts {
        let loaded = made(&format!("{cut}, {{join: line}}"));
        assert_eq!(loaded.file.pieces.len(), 2, "{cut}");
        near!(area(&loaded.garment, "front"), 2.0 * (0.2 * 0.4 - DART), epsilon = 1e-8);
        let front = &loaded.file.pieces[0];
        assert!(matches!(front.cut.as_ref().map(|c| &c.value), Some(CutKind::Fold(edge)) if edge == "center"), "{cut}");
        assert!(front.darts.len() == 1 && front.lines.len() == 1, "{cut}");
        let notches: Vec<f64> = front.notches.iter().flat_map(|n| &n.1).map(|n| n.value.at.number).collect();
        assert_eq!(notches.len(), 2, "{cut}");
        assert_eq!(loaded.file.seams.len(), 1);
    }
    // In one edge again, with its notches where they were.
    let loaded = made(&format!("{}, {{join: line}}", cuts[0]));
    near!(length(&loaded.garment, "front", "hem.L"), 0.2, epsilon = EXACT);
    assert_eq!(loaded.file.seams[0].sew.len(), 1);
    near!(loaded.file.pieces[0].notches[0].1[1].value.at.number, 300.0, epsilon = 1e-4);
}

#[test]
fn what_cannot_be_cut_is_said() {
    let is = |alteration: &str, expected: fn(&Problem) -> bool| {
        let Err(refused) = with(alteration) else { panic!("made: {alteration}") };
        assert!(expected(&refused.diagnostics[0].problem), "{alteration}: {:?}", refused.diagnostics[0].problem);
    };
    is("{cut: front.side@60 %, to: back.side@60 %, name: a}", |p| matches!(p, Problem::AlterTwoPieces { .. }));
    is("{cut: front.side@60 %, to: front.center@40 %, name: back}", |p| matches!(p, Problem::AlterTaken { .. }));
    is("{cut: front.side@60 %, to: front.center@40 %, name: a, seam: side}", |p| {
        matches!(p, Problem::AlterTaken { .. })
    });
    is("{cut: front.side@60 %, to: front.center@40 %, name: a, seam: hem}", |p| {
        matches!(p, Problem::AlterTaken { .. })
    });
    is(
        "{cut: front.side@60 %, to: front.hem@40 %, via: [[300, 300]], name: a}",
        |p| matches!(p, Problem::AlterShape { reason, .. } if reason.contains("leaves it")),
    );
    is(
        "{cut: front.side@37.5 %, to: front.center@60 %, name: a}",
        |p| matches!(p, Problem::AlterShape { reason, .. } if reason.contains("dart")),
    );
    is(
        "{cut: front.top@25 %, to: front.hem@75 %, name: a}",
        |p| matches!(p, Problem::AlterShape { reason, .. } if reason.contains("'pocket'")),
    );
    is("{fullness: back.hem, to: front.top, by: 60}", |p| matches!(p, Problem::AlterTwoPieces { .. }));
    is("{fullness: back.hem, to: back.hem, by: 60}", |p| matches!(p, Problem::AlterShape { .. }));
    is("{fullness: back.hem, to: back.top, by: 60, slashes: 0}", |p| matches!(p, Problem::OutOfRange { .. }));
    is("{join: side}", |p| matches!(p, Problem::AlterShape { .. }));
    is("{join: sid}", |p| matches!(p, Problem::UnknownSeam { nearest: Some(n), .. } if n == "side"));
    is("{cut: front.side, to: front.center@40 %, name: a}", |p| matches!(p, Problem::AlterPoint(_)));
}
