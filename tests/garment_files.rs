//! The five garments against their drafters' own numbers, every mistake a file can hold, and files written back.

#![allow(clippy::unwrap_used, reason = "tests may")]

use std::collections::{BTreeSet, HashSet};
use std::path::PathBuf;

use toile::io::garment::{Loaded, Refused, read, read_file_only, read_text, write};
use toile::pattern::{
    Bound, Diagnostic, Findings, Garment, LineKind, PlaceWord, Problem, SeamKind, Severity, Side, belongs_to, expand,
    openings, outfit, walk,
};

const GARMENTS: [&str; 5] = ["child_dress", "tshirt", "gore_skirt", "trousers", "sheath_dress"];

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("patterns").join(format!("{name}.yaml"))
}

fn load(name: &str) -> Loaded {
    read(&path(name)).unwrap_or_else(|e| panic!("{e}"))
}

fn garment(text: &str) -> Garment {
    read_text("test", "test.yaml", text).unwrap_or_else(|e| panic!("{e}")).garment
}

fn mistakes(text: &str) -> Vec<Diagnostic> {
    match read_text("test", "test.yaml", text) {
        Ok(loaded) => loaded.warnings,
        Err(Refused { diagnostics }) => diagnostics,
    }
}

/// Checks that the text gives this message at this word (its last occurrence) of this line.
#[track_caller]
fn says(text: &str, line: usize, word: &str, message: &str) {
    let found = mistakes(text);
    let shown = found.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    let hit = found.iter().find(|d| d.message.contains(message));
    let hit = hit.unwrap_or_else(|| panic!("no '{message}' among:\n{shown}"));
    let written = text.lines().nth(line - 1).unwrap();
    assert_eq!((hit.line, Some(hit.column - 1)), (line, written.rfind(word)), "{word}\n{shown}");
}

/// Two 100 mm squares, sewn at one side; `{…}` marks of the callers replace lines.
const SQUARES: &str = "\
garment: 1
pieces:
  a:
    grain: [[0, 0], [0, 9]]
    outline:
      start: 0 0
      top: L 100 0
      right: L 100 100
      bottom: L 0 100
      left: L 0 0
  b:
    grain: [[0, 0], [0, 9]]
    outline:
      start: 0 0
      top: L 100 0
      right: L 100 100
      bottom: L 0 100
      left: L 0 0
seams:
  side: {sew: a.right, to: b.left}
free: [a.top, a.bottom, a.left, b.top, b.bottom, b.right]
";

/// [`SQUARES`] with one thing changed.
#[track_caller]
fn squares(from: &str, to: &str) -> String {
    assert!(SQUARES.contains(from), "nothing to replace: {from}");
    SQUARES.replacen(from, to, 1)
}

/// Areas (cm²) and outline lengths (mm) as drafted (CHECK.txt of the pattern set: 4000-point polylines).
const DRAFTED: [(&str, &str, f64, f64); 20] = [
    ("child_dress", "front.L", 1101.9, 1568.2),
    ("child_dress", "front.R", 1101.9, 1568.2),
    ("child_dress", "back.L", 1125.1, 1578.7),
    ("child_dress", "back.R", 1125.1, 1578.7),
    ("child_dress", "sleeve.L", 736.2, 1088.6),
    ("gore_skirt", "front.L", 1620.7, 1728.0),
    ("gore_skirt", "back.R", 1615.2, 1719.0),
    ("gore_skirt", "waistband", 556.5, 1730.1),
    ("sheath_dress", "front", 4662.0, 3576.7),
    ("sheath_dress", "back.R", 2279.8, 2470.1),
    ("sheath_dress", "back.L", 2279.6, 2470.1),
    ("trousers", "front.R", 2515.1, 2571.5),
    ("trousers", "front.L", 2515.1, 2571.5),
    ("trousers", "back.R", 3004.6, 2649.4),
    ("trousers", "waistband", 665.9, 1824.9),
    ("tshirt", "front", 2680.0, 2224.2),
    ("tshirt", "back", 2775.5, 2162.0),
    ("tshirt", "sleeve.R", 436.4, 886.4),
    ("tshirt", "sleeve.L", 436.4, 886.4),
    ("tshirt", "neckband", 185.7, 1008.4),
];

#[test]
fn pieces_have_the_drafted_areas_and_lengths() {
    for (name, piece, area, outline) in DRAFTED {
        let garment = load(name).garment;
        let p = garment.pieces.iter().find(|p| p.name == piece).unwrap();
        // The source counts the outline with the fish-eye darts in it, rounds to 0.1 and measures chords.
        let outlined = p.loops[0].iter().map(|e| e.path.double_area()).sum::<f64>() / 2.0 * 1e4;
        assert!((outlined - area).abs() < 0.3, "{name} {piece}: {outlined} cm², drafted {area}");
        let length = p.outline_length() * 1e3;
        assert!((length - outline).abs() < 0.11, "{name} {piece}: {length} mm, drafted {outline}");
    }
}

/// Lengths of both sides (mm) and residual as drafted (same source).
const WALKED: [(&str, &str, f64, f64, f64); 29] = [
    ("child_dress", "center_front", 553.17, 553.17, 0.0),
    ("child_dress", "center_back", 600.0, 600.0, 0.0),
    ("child_dress", "shoulder.L", 88.0, 88.0, 0.0),
    ("child_dress", "side.R", 445.18, 445.18, 0.0),
    ("child_dress", "sleeve_under.L", 288.71, 288.71, 0.0),
    ("child_dress", "armhole_front.L", 163.79, 168.79, 0.0),
    ("child_dress", "armhole_back.R", 157.38, 162.38, 0.001),
    ("gore_skirt", "center_front", 600.0, 600.0, 0.0),
    ("gore_skirt", "side.L", 608.01, 608.01, 0.0),
    ("gore_skirt", "waist", 765.05, 765.04, 0.0),
    ("sheath_dress", "shoulder.L", 124.0, 129.0, 0.0),
    ("sheath_dress", "front.bust.L", 131.23, 131.23, 0.0),
    ("sheath_dress", "side.L", 808.19, 808.19, 0.0),
    ("sheath_dress", "side.R", 808.19, 808.19, 0.0),
    ("sheath_dress", "front.waist.upper.L", 160.31, 160.31, 0.0),
    ("sheath_dress", "front.waist.lower.R", 100.5, 100.5, 0.0),
    ("sheath_dress", "back.waist.upper.L", 165.25, 165.25, 0.0),
    ("sheath_dress", "back.waist.lower.R", 140.29, 140.29, 0.0),
    ("sheath_dress", "center_back", 1008.53, 1008.53, 0.0),
    ("trousers", "outseam.L", 1042.73, 1042.65, -0.084),
    ("trousers", "inseam.R", 784.32, 784.04, -0.280),
    ("trousers", "crotch_front", 339.61, 339.61, 0.0),
    ("trousers", "crotch_back", 338.88, 338.88, 0.0),
    ("trousers", "waist", 797.43, 797.43, 0.0),
    ("tshirt", "shoulder.L", 98.18, 98.18, 0.0),
    ("tshirt", "side.R", 365.44, 365.44, 0.0),
    ("tshirt", "armhole.L", 461.81, 463.42, 1.615),
    ("tshirt", "neckband_ring", 40.0, 40.0, 0.0),
    ("tshirt", "neck", 546.09, 464.18, 0.014),
];

#[test]
fn seams_have_the_drafted_lengths_and_residuals() {
    for (name, seam, a, b, residual) in WALKED {
        let walks = walk(&load(name).garment);
        let w = walks.iter().find(|w| w.name == seam).unwrap_or_else(|| panic!("{name} has no {seam}"));
        let close = |x: f64, y: f64, by: f64| (x * 1e3 - y).abs() < by;
        assert!(close(w.length_a, a, 0.011) && close(w.length_b, b, 0.011), "{name} {w:?}");
        assert!(close(w.difference, residual, 0.012), "{name} {w:?}");
    }
}

#[test]
fn the_openings_have_the_drafted_lengths() {
    let drafted: [(&str, &[f64]); 5] = [
        ("child_dress", &[180.0, 180.0, 290.4, 921.9]),
        // The band's top and both ends down to the hook; 965.0 with what the hook and the button close.
        ("gore_skirt", &[879.0, 1296.8]),
        ("sheath_dress", &[386.0, 445.0, 445.0, 960.0]),
        ("trousers", &[490.0, 490.0, 928.4]),
        ("tshirt", &[325.4, 325.4, 464.2, 1062.0]),
    ];
    for (name, lengths) in drafted {
        let mut found: Vec<f64> = openings(&load(name).garment).iter().map(|o| o.length * 1e3).collect();
        found.sort_by(f64::total_cmp);
        assert_eq!(found.len(), lengths.len(), "{name}: {found:?}");
        assert!(found.iter().zip(lengths).all(|(x, y)| (x - y).abs() < 0.3), "{name}: {found:?}");
    }
}

#[test]
fn the_garments_load_without_a_warning_and_are_sound() {
    for name in GARMENTS {
        let Loaded { garment, warnings, .. } = load(name);
        assert!(warnings.is_empty(), "{}", warnings[0]);
        for piece in &garment.pieces {
            for ring in &piece.loops {
                for (i, edge) in ring.iter().enumerate() {
                    let next = &ring[(i + 1) % ring.len()];
                    assert!((edge.path.end() - next.path.start()).norm() < 1e-9, "{name} {} {}", piece.name, edge.name);
                }
            }
            assert!(piece.loops[0].iter().map(|e| e.path.double_area()).sum::<f64>() > 0.0);
            let mut names: Vec<&str> = piece.loops.iter().flatten().map(|e| e.name.as_str()).collect();
            names.sort_unstable();
            assert!(names.windows(2).all(|w| w[0] != w[1]), "{name} {}: {names:?}", piece.name);
        }
        for seam in &garment.seams {
            assert_eq!(seam.marks[0], (0.0, 0.0));
            let last = seam.marks[seam.marks.len() - 1];
            assert!(
                (last.0 - seam.length_a()).abs() < 1e-9 && (last.1 - seam.length_b()).abs() < 1e-9,
                "{name} {seam:?}"
            );
            assert!(seam.marks.windows(2).all(|w| w[0].0 < w[1].0 && w[0].1 < w[1].1), "{name} {seam:?}");
        }
        let bounds: Vec<&Bound> = garment.tests.iter().map(|t| &t.bound).collect();
        assert!(bounds.contains(&&Bound::Worn) && bounds.contains(&&Bound::Crossings(0)));
    }
}

#[test]
fn chains_run_opposite_ways_round_their_outlines() {
    for name in GARMENTS {
        for seam in load(name).garment.seams {
            let with = |s: &toile::pattern::Span| s.to > s.from;
            assert!(seam.a.iter().all(|s| with(s) == with(&seam.a[0])), "{name} {}", seam.name);
            assert!(seam.b.iter().all(|s| with(s) != with(&seam.a[0])), "{name} {}", seam.name);
        }
    }
}

#[test]
fn the_tacks_hold_the_underlap() {
    let garment = load("gore_skirt").garment;
    let [(piece, p), (_, q)] = garment.closures[0].tacks[0];
    assert_eq!(garment.pieces[piece].name, "waistband");
    assert!((p.x - 0.015).abs() < 1e-9 && (q.x - 0.780).abs() < 1e-9 && p.y == q.y);
    let band = garment.pieces.iter().find(|p| p.name == "waistband").unwrap();
    assert_eq!(band.lines[0].kind, LineKind::Fold(std::f64::consts::PI));
}

#[test]
fn limbs_of_a_pair_get_their_side() {
    let garment = load("child_dress").garment;
    let sleeve = garment.pieces.iter().find(|p| p.name == "sleeve.R").unwrap();
    assert_eq!(sleeve.side, Some(Side::Right));
    let words = vec![PlaceWord::Right, PlaceWord::Arm];
    assert_eq!(sleeve.place, Some(toile::pattern::Place::Around { words }));
}

#[test]
fn every_garment_is_written_back_without_loss() {
    for name in GARMENTS {
        let file = load(name).file;
        let text = write(&file).unwrap();
        let again = read_file_only("again.yaml", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert_eq!(file, again, "{name}\n{text}");
    }
}

/// Every feature of the format, as a catalogue: not a garment, most pieces are not drawn.
const CATALOGUE: &str = include_str!("data/catalogue.yaml");

#[test]
fn every_feature_is_written_back_without_loss() {
    let file = read_file_only("catalogue.yaml", CATALOGUE).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(file.pieces.len(), 3);
    let again = read_file_only("again.yaml", &write(&file).unwrap()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(file, again);
}

#[test]
fn what_a_value_says_is_named_with_its_place() {
    says(&squares("garment: 1", "garment: 1\nunits: inch"), 2, "inch", "unknown unit 'inch'; use mm, cm or in");
    says(&squares("sew: a.right", "sew: c.right"), 20, "c.right", "piece 'c' not found; did you mean 'a'?");
    let known = "edge 'a.rigth' not found; a has: top, right, bottom, left";
    says(&squares("sew: a.right", "sew: a.rigth"), 20, "a.rigth", known);
    says(&squares("garment: 1", "garment: 2"), 1, "2", "version 2 is not known");
    says(&squares("to: b.left", "to: b.left, eas: 3"), 20, "eas", "unknown key 'eas' in seam 'side'");
    says(&squares("  b:\n", "  b:\n    fabric: velvt\n"), 12, "velvt", "fabric 'velvt' not found");
    says(&squares("  b:\n", "  b:\n    cut: fold top left\n"), 12, "fold", "unknown cut 'fold top left'");
    says(&squares("  b:\n", "  b:\n    like: c\n"), 12, "c", "piece 'c' not found");
    says(&squares("  b:\n", "  b:\n    like: b\n"), 12, "b", "'like' goes round in a circle: b, b");
    says(&squares("  b:\n", "  mirror:\n"), 11, "mirror", "the name 'mirror' cannot be used");
    says(&squares("free: [a.top", "free: [a.tpo"), 21, "a.tpo", "edge 'a.tpo' not found");
    says(&squares("free: [", "free: [\"*.hem\", "), 21, "\"*.hem", "'*.hem' matches no edge");
    let test = |test: &str| squares("free: [", &format!("tests: [{test}]\nfree: ["));
    let wanted = "the body has no girth 'wiast'; did you mean 'waist'?";
    says(&test("{ease: wiast, from: 10 mm}"), 21, "wiast", wanted);
    says(&test("{pressure: left waist, below: 2.3 kPa}"), 21, "left waist", "the body has no girth 'left waist'");
    says(&test("{pressure: waist, below: 2 mm}"), 21, "2 mm", "a pressure above zero such as 2.3 kPa");
    says(&test("{hem: even}"), 21, "even", "such as level within 10 mm");
    says(
        &squares("free: [", "tests: [{seam: sied, length: 1 mm}]\nfree: ["),
        21,
        "sied",
        "seam 'sied' not found; did you mean 'side'?",
    );
    says(&squares("free: [", "free: [a.top@50%..10, "), 21, "a.top@50", "range a.top@50%..10 runs backwards");
    says(&squares("  b:\n", "  b:\n    layer: 2147483647\n"), 12, "2147", "between -100 and 100");
    says(&squares("free: [", "tests: [{openings: 2}]\nfree: ["), 21, "{openings", "garment has 1 openings, expected 2");
    says(&squares("free: [", "tests: [{sem: x}]\nfree: ["), 21, "{sem", "unknown test 'sem'");
}

#[test]
fn what_is_wrong_with_an_outline_is_named_with_its_place() {
    let gap = "outline of 'a' does not close: last point (0, 3.2) is 3.2 mm from start (0, 0)";
    says(&squares("left: L 0 0", "left: L 0 3.2"), 10, "L", gap);
    let crossing = "outline of 'a' crosses itself near (100, 46.7), between right and left";
    says(&squares("bottom: L 0 100", "bottom: L 150 70"), 10, "left", crossing);
    says(&squares("bottom: L 0 100", "top: L 0 100"), 9, "top", "duplicate key 'top' at line 9 (first at line 7)");
    says(&squares("[[0, 0], [0, 9]]", "[[5, 5], [5, 5]]"), 4, "[[5", "grain of 'a' has zero length");
    says(&squares("top: L 100 0", "top: L 100"), 7, "L 100", "cannot read 'L 100'");
    says(&squares("top: L 100 0", "top: L 1e999 0"), 7, "L 1e", "edge 'a.top': ");
    says(&squares("top: L 100 0", "top: L 1e9 0"), 7, "L 1e9", "at most 200 m are read");
    // Found by tests/fuzz.rs: measured to the nanometre, this takes seconds.
    says(&squares("top: L 100 0", "top: C 0 0, 1e300 1, 100 0"), 7, "C 0 0", "at most 200 m are read");
    says(&squares("top: L 100 0", "top: C 60 0, 120 -1e308, 100 0"), 7, "C 60 0", "at most 200 m are read");
    says(&squares("top: L 100 0", "top: L 0 0"), 7, "L 0 0", "has no length");
    says(&squares("    grain: [[0, 0], [0, 9]]\n", ""), 3, "a", "piece 'a' has no grain");
    let flat = squares("right: L 100 100\n      bottom: L 0 100", "right: L 50 0\n      bottom: L 20 0");
    says(&flat, 6, "0 0", "outline of 'a' encloses no area");
    let hole = "  b:\n    holes: {h: M 200 0 L 210 0 L 210 9 Z}\n";
    says(&squares("  b:\n", hole), 12, "M 200", "hole 'h' lies outside piece 'b'");
    let curved = squares("top: L 100 0", "top: C 30 9, 60 9, 100 0").replacen("  a:\n", "  a:\n    cut: fold top\n", 1);
    says(&curved, 4, "fold top", "fold edge 'top' is curved; only straight edges can be folded");
    let folded = squares("  a:\n", "  a:\n    cut: fold topp\n");
    says(&folded, 4, "fold topp", "edge 'a.topp' not found");
    says(&squares("  a:\n", "  a:\n    notches: {top: [120]}\n"), 4, "120", "notch at 120.0 mm lies off a.top");
}

#[test]
fn what_is_wrong_with_darts_and_pleats_is_named_with_its_place() {
    let with = |what: &str| squares("  a:\n", &format!("  a:\n    {what}\n"));
    let long = with("darts: [{edge: bottom, at: 50, intake: 10, length: 120}]");
    says(&long, 4, "50", "dart tip (50, -20) lies outside piece 'a'");
    let legs = with("darts: [{edge: bottom, at: 50, intake: 10, tip: [60, 50]}]");
    says(&legs, 4, "10", "dart at a.bottom@50: legs differ 50.2 / 52.2 mm");
    let mouth = with("darts: [{edge: bottom, at: 3, intake: 10, length: 20}]");
    says(&mouth, 4, "3", "dart at a.bottom@3: its mouth reaches from -2.0 to 8.0 mm");
    let eye = with("darts: [{at: [50, 20], intake: 10, up: 30, down: 30}]");
    says(&eye, 4, "[50", "dart tip (50, -10) lies outside piece 'a'");
    let two = with("darts: [{edge: top, at: 50, intake: 10, length: 20}, {edge: top, at: 55, intake: 10, length: 20}]");
    says(&two, 4, "55", "darts overlap on a.top");
    let pleats = with("pleats: [{edge: top, at: [10, 50], depth: 30}]");
    says(&pleats, 4, "top", "pleats on 'a.top' take 120 mm but the edge has 100 mm");
    let twice =
        "{name: d, edge: top, at: 20, intake: 5, length: 9}, {name: d, edge: top, at: 70, intake: 5, length: 9}";
    says(&with(&format!("darts: [{twice}]")), 3, "a", "edge name 'd.a' used twice in 'a'");
    // One to the end of the edge spans 20 to 50, to its start 30 to 60; a box of 10 six depths.
    for (pleats, at, over) in [
        ("at: [30, 50], depth: 10", "50", "pleat at 50 mm on 'a.top' reaches 10.0 mm over that at 30 mm"),
        ("at: [5], depth: 10", "5", "pleat at 5 mm on 'a.top' reaches 5.0 mm over the start of the edge"),
        ("at: [85], depth: 10", "85", "reaches 5.0 mm over the end of the edge, which is 100.0 mm long"),
        ("at: [45], depth: 10, kind: box", "45", "pleat at 45 mm on 'a.top' reaches 5.0 mm over the end of the edge"),
        ("at: [30, 55], depth: 10, toward: left", "55", "reaches 5.0 mm over that at 30 mm"),
    ] {
        says(&with(&format!("pleats: [{{edge: top, {pleats}}}]")), 4, at, over);
    }
    let toward = with("pleats: [{edge: top, at: [50], depth: 10, toward: bottom}]");
    says(&toward, 4, "top", "'toward: bottom' is not next to 'top', whose neighbours are left and right");
    says(
        &with("pleats: [{edge: top, at:, depth: 10}]"),
        4,
        ":, depth",
        "at must be a length, or a list of lengths, not nothing",
    );
    says(&with("pleats: [{edge: top, at: [], depth: 10}]"), 4, "[]", "at must be a length, or a list of lengths");
    says(&with("pleats: [{edge: top, at: [50], depth: 10, sewn: 30}]"), 4, "30", "'sewn' is kept, not simulated");
}

#[test]
fn a_counter_clockwise_outline_is_turned_with_a_warning() {
    let text = squares(
        "top: L 100 0\n      right: L 100 100\n      bottom: L 0 100\n      left: L 0 0",
        "left: L 0 100\n      bottom: L 100 100\n      right: L 100 0\n      top: L 0 0",
    );
    let found = mistakes(&text);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].severity, found[0].line, found[0].column), (Severity::Warning, 6, 14));
    assert_eq!(found[0].message, "outline of 'a' runs counter-clockwise; reversed it");
    assert!(garment(&text).pieces[0].area() > 0.0);
}

#[test]
fn a_facing_without_a_layer_of_its_own_is_warned_of() {
    let shell = SQUARES.replace("  b:", "  back:").replace("b.", "back.").replace("  a:", "  front:");
    let shell = shell.replace("  front:\n", "  front:\n    place: torso front\n");
    let shell = shell.replace("a.", "front.").replace("front.top, ", "facing.right, facing.bottom, facing.left, ");
    let faced = |piece: &str| {
        let text = shell.replace("seams:\n", &format!("  facing: {{like: front, {piece}}}\nseams:\n"));
        mistakes(&text.replace("free:", "  neck: {sew: front.top, to: facing.top, face: same}\nfree:"))
    };
    let outside = faced("place: torso front");
    let message = "lies on 'front' (face: same), but both are on layer 0";
    assert!(matches!(&outside[..], [d] if d.line == 23 && d.message.contains(message)), "{outside:?}");
    let remedy = "give 'facing' layer: -1 if it is worn inside, as a facing, or layer: 1 if outside";
    assert_eq!((outside[0].severity, outside[0].hint.as_deref()), (Severity::Warning, Some(remedy)));
    // With its layer, and as a collar that is turned down.
    for right in ["place: torso front, layer: -1", "place: torso front, layer: 1", "place: collar front"] {
        assert_eq!(faced(right), [], "{right}");
    }
}

#[test]
fn a_file_drawn_upwards_is_asked_about_once() {
    let upwards = SQUARES.replace("100 100", "100 -100").replace("L 0 100", "L 0 -100").replace("[0, 9]", "[0, -9]");
    let warnings = read_text("test", "test.yaml", &upwards).unwrap().warnings;
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert_eq!((warnings[0].line, &warnings[0].problem), (6, &Problem::DrawnUpwards));
    // One of two outlines may be a slip.
    let one = upwards.replacen("100 -100", "100 100", 1).replacen("L 0 -100", "L 0 100", 1);
    let warnings = read_text("test", "test.yaml", &one).unwrap().warnings;
    assert!(matches!(warnings[..], [ref w] if w.problem == Problem::CounterClockwise("b".into())), "{warnings:?}");
}

#[test]
fn what_is_wrong_with_a_seam_is_named_with_its_place() {
    let side = |how: &str| squares("{sew: a.right, to: b.left}", how);
    let swap =
        "seam 'side': a.right@0..92.3 92.3 mm, b.left 100.0 mm, 7.7 mm apart; swap sew and to and add gather: 1.08";
    says(&side("{sew: a.right@0..92.3, to: b.left}"), 20, "side", swap);
    let ease = "5.0 mm apart; add ease: 5.0 mm or fix the outline (tolerance 2)";
    says(&side("{sew: a.right@0..95, to: b.left}"), 20, "side", ease);
    let large = "ease 12 mm is 14 % of 88 mm; more than 8 % gathers, say gather: 1.14";
    says(&side("{sew: a.right@0..88, to: b.left, ease: 12}"), 20, "12", large);
    let shorter = mistakes(&side("{sew: a.right, to: b.left@0..78, ease: 12}"));
    let gathered = |d: &Diagnostic| d.message.contains("say gather: 1.28") && !d.message.contains("swapped");
    assert_eq!(shorter.iter().filter(|d| gathered(d)).count(), 2, "{shorter:?}");
    let even = "ease 12 mm is 12 % of 100 mm; more than 8 % gathers, say no ease";
    says(&side("{sew: a.right, to: b.left, ease: 12}"), 20, "12", even);
    let ratio = "100.0 / 80.0 is 1.250, and gather: 1.2 asks for 100.0 mm on 83.3 mm, 3.3 mm apart; say gather: 1.250";
    says(&side("{sew: a.right, to: b.left@0..80, gather: 1.2}"), 20, "side", ratio);
    let below = "gather: 0.6 would stretch the cloth by 67 %; did you swap sew and to?";
    says(&side("{sew: a.right, to: b.left, gather: 0.6}"), 20, "0.6", below);
    says(&side("{sew: a.right, to: b.left, stretch: 0.6}"), 20, "0.6", "stretch: 0.6 would gather the cloth");
    let beyond = "seam 'side' uses b.left@0..900 but the edge is 100.0 mm long";
    says(&side("{sew: a.right, to: b.left@0..900}"), 20, "b.left", beyond);
    says(&side("{sew: a.right@80%..20%, to: b.left}"), 20, "a.right", "range 80%..20% runs backwards");
    let broken = "chain in 'side' is not continuous: a.right ends at (100, 100), a.left starts at (0, 100)";
    says(&side("{sew: [a.right, a.left], to: [b.left, b.right]}"), 20, "a.left", broken);
    says(&side("{sew: [a.right, a.bottom], to: [b.left, b.top]}"), 20, "side", "seam 'side' is twisted: its ends meet");
    says(&side("{sew: a.right, to: mirror}"), 20, "a.right", "piece 'a' has no mirror");
    let end = "seam 'side' has no end at 'hem'; its ends are at ";
    says(&side("{sew: a.right, to: b.left, open: {from: hem, length: 20}}"), 20, "hem", end);
    says(&side("{sew: a.right, to: b.left, open: {from: top, length: 200}}"), 20, "200", "opens 200.0 mm");
    let two = "'ease' and 'gather' exclude each other";
    says(&side("{sew: a.right, to: b.left, ease: 1, gather: 2}"), 20, "2", two);
    let twice = side("{sew: a.right, to: b.left}\n  pocket: {sew: a.right@0..50, to: b.right@0..50}");
    says(&twice, 21, "pocket", "a.right is sewn twice on 0..50 mm: in 'side' and in 'pocket'");
    says(&squares("a.bottom, ", ""), 9, "bottom", "edges neither sewn nor free: a.bottom");
    says(&side("{sew: a.right, to: b.left@0..50, gather: 2}"), 18, "left", "neither sewn nor free: b.left@50..100");
    let band = side("{sew: a.right, to: b.left}\n  ring: {sew: a.left, to: b.right, face: same}");
    says(&band, 21, "ring", "sewing closes the surface into a non-orientable band at 'ring'");
    let notched = side("{sew: a.right, to: b.left, match: notches}").replacen(
        "  a:\n",
        "  a:\n    notches: {right: [10, 20]}\n",
        1,
    );
    let notched = notched.replacen("  b:\n", "  b:\n    notches: {left: [80]}\n", 1);
    says(&notched, 22, "side", "notch 2 of a.right has no partner on b.left");
    let pair = squares("  b:\n", "  b:\n    cut: pair\n");
    let sides = "seam 'side': b.left is on both sides of the garment; write b.L.left or b.R.left, or cut 'a' as a pair";
    says(&pair, 21, "b.left", sides);
    let copies = squares("  b:\n", "  b:\n    cut: 3\n");
    says(&copies, 21, "b.left", "b.left is cut 3 times; say which, b.1 to b.3");
    let two = mistakes(&squares("  b:\n", "  b:\n    cut: 2\n"));
    assert_eq!(two[0].hint.as_deref(), Some("a left and a right one are 'cut: pair'"));
    let unsewn = squares("seams:", "  c: {like: a, cut: pair}\nseams:").replacen("free: [", "free: [\"c.*\", ", 1);
    says(&unsewn, 19, "pair", "cut: pair piece 'c' has no L/R seams; use cut: 2");
    let fold = squares("  b:\n", "  b:\n    cut: fold left\n").replacen("sew: a.right", "sew: b.L.top", 1);
    let fold = fold.replacen("to: b.left", "to: b.L.left", 1);
    says(&fold, 21, "b.L.left", "b.L.left lies on the fold");
}

#[test]
fn notches_that_miss_each_other_are_warned_of() {
    let notched = |a: &str, b: &str| {
        let on = |piece: &str, list: &str| (format!("  {piece}:\n"), format!("  {piece}:\n    notches: {list}\n"));
        let (on_a, on_b) = (on("a", a), on("b", b));
        squares(&on_a.0, &on_a.1).replacen(&on_b.0, &on_b.1, 1)
    };
    // One edge runs down, the other up.
    let apart = "seam 'side': the notches at 90 mm on a.right and 10 mm on b.left, both from where the seam begins, \
                 are 80 mm apart";
    says(&notched("{right: [90]}", "{left: [90]}"), 22, "side", apart);
    says(&notched("{right: [90 double, 20]}", "{left: [90 double, 10, 80]}"), 22, "side", apart);
    // Those that meet, to a stroke of the pen; of another kind; and one that no other is there for.
    for (a, b) in
        [("{right: [90]}", "{left: [12]}"), ("{right: [90]}", "{left: [90 double]}"), ("{right: [90]}", "{top: [9]}")]
    {
        assert_eq!(mistakes(&notched(a, b)), [], "{a} {b}");
    }
    // What is gathered may all be before the notch, or behind it. Notches that are to meet are held to the same.
    let gathered = |at: u32, how: &str| {
        let seam = format!("a.right, to: b.left@0..80, gather: 1.25{how}");
        let text = notched("{right: [50]}", &format!("{{left: [{at}]}}")).replacen("a.right, to: b.left", &seam, 1);
        let mistakes = mistakes(&text.replacen("free: [", "free: [b.left@80..100, ", 1));
        mistakes.iter().map(|d| d.severity).collect::<Vec<_>>()
    };
    for (how, severity) in [("", Severity::Warning), (", match: notches", Severity::Error)] {
        let found = [15, 32, 48, 65].map(|at| gathered(at, how));
        assert_eq!(found, [vec![severity], vec![], vec![], vec![severity]], "{how}");
    }
}

/// The notch at the crown of a cap meets the joint of the two edges it is sewn to; a double one no single one.
#[test]
fn a_notch_may_meet_a_joint_and_only_its_kind() {
    let sewn = |a: &str, b: &str| {
        let seam = "{sew: [a.right, a.bottom], to: b.left, gather: 2, match: notches}";
        let two = squares("{sew: a.right, to: b.left}", seam).replacen("a.top, a.bottom, ", "a.top, ", 1);
        let notched = |text: String, piece: &str, list: &str| {
            text.replacen(&format!("  {piece}:\n"), &format!("  {piece}:\n    notches: {list}\n"), 1)
        };
        let text = notched(notched(two, "a", a), "b", b);
        mistakes(&text).into_iter().map(|d| (d.severity, d.message)).collect::<Vec<_>>()
    };
    // b.left is walked upward: half way up it meets the corner of a.
    assert_eq!(sewn("{}", "{left: [50]}"), []);
    assert_eq!(sewn("{right: [50], bottom: [50]}", "{left: [75, 50, 25]}"), []);
    let alone = sewn("{right: [50]}", "{left: [80, 50, 25, 10]}");
    assert!(alone.iter().any(|(s, m)| *s == Severity::Error && m.contains("has no partner")), "{alone:?}");
    let unlike = sewn("{right: [50 double]}", "{left: [75, 50]}");
    assert!(
        matches!(&unlike[..], [(Severity::Warning, m)] if m.contains("one is single and one double")),
        "{unlike:?}"
    );
}

/// An edge that is sewn in part: what the message calls neither sewn nor free can be listed as it is called.
#[test]
fn a_part_of_an_edge_can_be_listed_free() {
    let seam = |sewn: &str| squares("{sew: a.right, to: b.left}", &format!("{{sew: a.right, to: {sewn}, gather: 2}}"));
    let free = |text: &str, listed: &str| text.replacen("free: [", &format!("free: [{listed}, "), 1);
    let half = seam("b.left@0..50");
    says(&half, 18, "left", "neither sewn nor free: b.left@50..100");
    assert!(mistakes(&free(&half, "b.left@50..100")).is_empty());
    assert!(mistakes(&free(&half, "b.left@50%..100%")).is_empty());
    says(&free(&half, "b.left@60..100"), 18, "left", "neither sewn nor free: b.left@50..60");
    says(&free(&half, "b.left@0..50"), 21, "b.left@0..50", "b.left@0..50 is listed free but sewn in 'side'");
    let beyond = "'free' uses b.left@50..900 but the edge is 100.0 mm long";
    says(&free(&half, "b.left@50..900"), 21, "b.left@50..900", beyond);
    says(&free(&half, "b.lft@50..100"), 21, "b.lft@50..100", "edge 'b.lft' not found");
    says(&free(&half, "b.left@50-100"), 21, "b.left@50-100", "names no edge");
    // Ranges are those of the drawing, which the mirrored half of a piece on the fold is walked against.
    let fold = seam("b.right.R@0..50").replacen("  b:\n", "  b:\n    cut: fold left\n", 1);
    let fold = fold.replacen("b.right]", "b.right.L]", 1);
    says(&fold, 17, "right", "neither sewn nor free: b.right.R@50..100");
    assert!(mistakes(&free(&fold, "b.right.R@50..100")).is_empty());
    // In the file's unit.
    let cm =
        half.replacen("garment: 1\n", "garment: 1\nunits: cm\n", 1).replace("100", "10").replacen("0..50", "0..5", 1);
    says(&cm, 19, "left", "neither sewn nor free: b.left@5.00..10.00");
    assert!(mistakes(&free(&cm, "b.left@5.00..10.00")).is_empty());
}

#[test]
fn a_seam_before_the_one_it_hangs_by_is_warned_of() {
    let text = squares(
        "  side: {sew: a.right, to: b.left}\n",
        "  cuff: {sew: [a.top, b.top], to: c.long}\n  side: {sew: a.right, to: b.left}\n",
    );
    let c = "  c:\n    grain: [[0, 0], [0, 9]]\n    outline: \n      start: 0 0\n      up: L 200 0\n      \
             e: L 200 9\n      long: L 0 9\n      w: L 0 0\nseams:";
    let text = text.replacen("seams:", c, 1).replacen("a.top, ", "c.up, c.e, c.w, ", 2).replacen(
        "[c.up, c.e, c.w, b.top]",
        "[a.top, b.top]",
        1,
    );
    let text = text.replacen("b.top, b.bottom", "b.bottom", 1);
    says(&text, 28, "cuff", "seam order: 'cuff' is sewn before 'side' that makes it a ring");
}

#[test]
fn a_message_shows_the_line_and_what_to_do() {
    let text = squares("sew: a.right", "sew: a.rigth");
    let shown = read_text("test", "t.yaml", &text).unwrap_err().to_string();
    let expected = "\
t.yaml:20:15: error: edge 'a.rigth' not found; a has: top, right, bottom, left
  20 |   side: {sew: a.rigth, to: b.left}
     |               ^^^^^^^
  help: did you mean 'right'?";
    assert_eq!(shown, expected);
}

#[test]
fn files_that_are_none_are_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let problem = |path: &std::path::Path| read(path).unwrap_err().diagnostics.remove(0).problem;
    assert!(matches!(problem(&folder.path().join("none.yaml")), Problem::Unreadable(_)));
    assert_eq!(problem(folder.path()), Problem::Directory);
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        problem(&path)
    };
    assert_eq!(file("empty.yaml", b""), Problem::Empty);
    assert_eq!(file("comment.yaml", b"# nothing\n"), Problem::Empty);
    assert_eq!(file("latin.yaml", b"garment: 1\nname: caf\xe9\n"), Problem::NotText(20));
    assert!(matches!(file("list.yaml", b"- 1\n- 2\n"), Problem::WrongType { .. }));
    assert!(matches!(file("word.yaml", b"garment"), Problem::WrongType { .. }));
    assert!(matches!(file("torn.yaml", b"garment: [1\nname: }"), Problem::Syntax(_)));
    // "Unprintable" is no tab.
    let hint = |text: &[u8]| file("hint.yaml", text).hint().unwrap_or_default();
    assert!(hint(b"garment: 1\n\tname: a").contains("tab") && !hint(b"garment: \x01").contains("tab"));
    assert_eq!(file("two.yaml", b"a: 1\n---\nb: 2\n"), Problem::SecondDocument);
    assert!(matches!(file("bare.yaml", b"garment: 1\n"), Problem::MissingKey { key: "pieces", .. }));
    let deep = "[".repeat(100);
    assert!(matches!(file("deep.yaml", deep.as_bytes()), Problem::TooDeep(_) | Problem::Syntax(_)));
    let huge = folder.path().join("huge.yaml");
    std::fs::File::create(&huge).unwrap().set_len(1 << 30).unwrap();
    assert!(matches!(problem(&huge), Problem::TooLarge { bytes: 0x4000_0000, .. }));
}

#[test]
fn slips_in_yaml_say_what_it_wants() {
    let star = squares("a.top", "*.top");
    says(&star, 21, "*.top", "not YAML: while parsing node, found unknown anchor");
    assert!(mistakes(&star)[0].hint.as_deref().is_some_and(|h| h.ends_with("in quotation marks: \"*.hem\"")));
    // After a word, after a list, and after a key.
    for (from, to, line) in [
        ("      top: L 100 0\n      right", "      top: L 100 0\n\tright", 8),
        ("    outline", "\toutline", 5),
        ("      start: 0 0", "\tstart: 0 0", 6),
    ] {
        let text = squares(from, to);
        says(&text, line, "\t", "tab");
        let found = mistakes(&text);
        assert!(found[0].hint.as_deref().is_some_and(|h| h.starts_with("YAML indents with spaces")), "{found:?}");
    }
}

#[test]
fn aliases_are_followed_but_not_into_a_bomb() {
    let shared =
        squares("  b:\n    grain: [[0, 0], [0, 9]]", "  b:\n    grain: *up").replacen("grain: [[", "grain: &up [[", 1);
    assert_eq!(garment(&shared).pieces.len(), 2);
    let mut bomb = String::from("a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n");
    for i in 1..12 {
        let aliases = vec![format!("*a{}", i - 1); 10].join(", ");
        bomb.push_str(&format!("a{i}: &a{i} [{aliases}]\n"));
    }
    let found = mistakes(&bomb);
    assert!(matches!(found[0].problem, Problem::TooManyValues(_)), "{found:?}");
    assert!(matches!(mistakes("a: &a [*a]")[0].problem, Problem::EndlessAlias | Problem::Syntax(_)));
}

#[test]
fn a_dart_opens_its_edge_and_closes_on_itself() {
    let text = squares("  a:\n", "  a:\n    darts: [{edge: right, at: 40, intake: 10, length: 30}]\n");
    let g = garment(&text.replacen("to: b.left", "to: b.left@0..90", 1).replacen("b.bottom", "b.left, b.bottom", 1));
    let names: Vec<&str> = g.pieces[0].loops[0].iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["top", "right", "dart.a", "dart.b", "right.2", "bottom", "left"]);
    let dart = g.seams.iter().find(|s| s.kind == SeamKind::Dart).unwrap();
    assert_eq!(dart.name, "a.dart");
    assert!((dart.length_a() - dart.length_b()).abs() < 1e-12);
    assert!((dart.length_a() - f64::hypot(0.005, 0.03)).abs() < 1e-9);
    assert_eq!(g.seams[0].a.len(), 2);
    assert!((g.seams[0].length_a() - 0.09).abs() < 1e-9);
    assert!((g.pieces[0].area() - (0.01 - 0.5 * 0.01 * 0.03)).abs() < 1e-9);
}

#[test]
fn pleats_are_held_by_all_their_layers() {
    for (kind, take, seams) in [("knife", 0.02, 2), ("box", 0.04, 4), ("inverted", 0.04, 4)] {
        let pleat = format!("  a:\n    pleats: [{{edge: right, at: [30], depth: 10, kind: {kind}}}]\n");
        let to = format!("to: b.left@0..{}", 100.0 - take * 1e3);
        let g = garment(&squares("  a:\n", &pleat).replacen("to: b.left", &to, 1).replacen(
            "b.bottom",
            "b.left, b.bottom",
            1,
        ));
        assert!((g.seams[0].length_a() - (0.1 - take)).abs() < 1e-9, "{kind}");
        let layers: Vec<_> = g.seams.iter().filter(|s| matches!(s.kind, SeamKind::Pleat(_))).collect();
        assert_eq!(layers.len(), seams, "{kind}");
        assert!(layers.iter().all(|s| (s.length_a() - 0.01).abs() < 1e-12 && (s.length_b() - 0.01).abs() < 1e-12));
        assert_eq!(openings(&g).len(), 1, "{kind}");
    }
}

#[test]
fn an_opening_without_a_closure_stays_open() {
    let open = |closure: &str| {
        garment(&squares("to: b.left}", &format!("to: b.left, open: {{from: bottom, length: 30}}{closure}}}")))
    };
    let slit = open("");
    assert!((slit.seams[0].length_a() - 0.07).abs() < 1e-9 && slit.seams[0].closure.is_none());
    assert_eq!((slit.seams[0].a[0].from, slit.seams[0].b[0].to.max(slit.seams[0].b[0].from)), (0.0, 0.1));
    let zip = open(", closure: zip");
    assert!((zip.seams[0].length_a() - 0.1).abs() < 1e-9);
    assert_eq!(zip.seams[0].closure.as_deref(), Some("zip"));
}

#[test]
fn an_edge_across_the_fold_joins_a_piece_that_is_there_once() {
    // b is folded at its left edge: its top is 200 mm wide, over both halves.
    let text = squares("  b:\n", "  b:\n    cut: fold left\n")
        .replacen(
            "top: L 100 0\n      right: L 100 100\n      bottom: L 0 100",
            "top: L 200 0\n      right: L 200 100\n      bottom: L 0 100",
            1,
        )
        .replacen("side: {sew: a.right, to: b.left}", "side: {sew: a.top, to: b.top}", 1)
        .replacen(
            "[a.top, a.bottom, a.left, b.top, b.bottom, b.right]",
            "[a.right, a.bottom, a.left, b.bottom, b.right]",
            1,
        );
    let g = garment(&text);
    assert_eq!(g.seams[0].b.len(), 2);
    assert!((g.seams[0].length_b() - 0.2).abs() < 1e-9);
    let names: Vec<&str> = g.pieces[1].loops[0].iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["top.L", "right.L", "bottom.L", "bottom.R", "right.R", "top.R"]);
}

#[test]
fn the_halves_of_a_folded_piece_and_copies_are_sewn_one_by_one() {
    // b is a tube: folded at its left edge, its right edge sewn to its own mirror image.
    let tube = squares("  b:\n", "  b:\n    cut: fold left\n")
        .replacen("{sew: a.right, to: b.left}", "{sew: b.right, to: mirror}", 1)
        .replacen("free: [", "free: [a.right, ", 1)
        .replacen(", b.right]", "]", 1);
    let g = garment(&tube);
    assert_eq!(g.seams.len(), 1);
    assert_eq!(
        walk(&g).into_iter().map(|w| (w.a, w.b)).collect::<Vec<_>>(),
        [("b.L.right".to_owned(), "b.R.right".to_owned())]
    );
    assert_eq!(openings(&g).len(), 3);
    // Openings go by the names in the file, whatever halves and darts make of them.
    let names: Vec<Vec<String>> = openings(&g).iter().map(|o| g.opening_edges(o)).collect();
    assert!(names.contains(&vec!["b.top".to_owned()]) && names.contains(&vec!["b.bottom".to_owned()]), "{names:?}");
    let strips = SQUARES.replace("    grain: [[0, 0], [0, 9]]\n", "    grain: [[0, 0], [0, 9]]\n    cut: 2\n");
    let g = garment(&strips);
    assert_eq!(g.pieces.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["a.1", "a.2", "b.1", "b.2"]);
    assert_eq!(g.seams.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), ["side.1", "side.2"]);
    // A straight piece between them by number.
    let one = strips.replacen("{sew: a.right, to: b.left}", "{sew: a.1.right, to: b.2.left}", 1);
    let one = one.replacen("free: [", "free: [a.2.right, b.1.left, ", 1);
    assert_eq!(garment(&one).seams.len(), 1);
}

#[test]
fn facings_share_an_edge_and_ratios_pass() {
    let facing = squares("seams:", "  c: {like: b, layer: -1}\nseams:")
        .replacen(
            "side: {sew: a.right, to: b.left}",
            "side: {sew: a.right, to: b.left}\n  face: {sew: c.left, to: a.right, layers: [-1, 0]}",
            1,
        )
        .replacen("free: [", "free: [c.top, c.right, c.bottom, ", 1);
    assert_eq!(garment(&facing).seams.len(), 2);
    let gathered = squares("to: b.left}", "to: b.left@0..50, gather: 2}").replacen("free: [", "free: [b.left, ", 1);
    let w = &walk(&garment(&gathered))[0];
    assert!(w.difference.abs() < 1e-12 && (w.length_b - 0.05).abs() < 1e-12);
}

/// Joints that lie apart by less than the tolerance are sewn together, and a chain goes on across them.
#[test]
fn a_seam_s_own_tolerance_holds_for_the_chains_of_others() {
    let piece = |name: &str, width: u32, height: u32| {
        let grain = "grain: [[0, 0], [0, 9]]";
        let rim = format!("top: L {width} 0, right: L {width} {height}, bottom: L 0 {height}, left: L 0 0");
        format!("  {name}: {{{grain}, outline: {{start: 0 0, {rim}}}}}\n")
    };
    let pieces = [("a", 100, 100), ("b", 100, 100), ("c", 104, 100), ("d", 96, 100), ("f", 20, 200)];
    let pieces: String = pieces.into_iter().map(|(name, width, height)| piece(name, width, height)).collect();
    let text = format!(
        "\
garment: 1
pieces:
{}seams:
  upper: {{sew: a.right, to: b.left}}
  lower: {{sew: c.right, to: d.left}}
  waist: {{sew: [a.bottom, b.bottom], to: [c.top, d.top], tolerance: 5}}
  trim: {{sew: [a.right, c.right], to: f.left, layers: [0, 1]}}
free: [a.top, a.left, b.top, b.right, c.left, c.bottom, d.right, d.bottom, f.top, f.right, f.bottom]
",
        pieces.replace("  f: {", "  f: {layer: 1, ")
    );
    assert_eq!(garment(&text).seams.len(), 4);
    says(&text.replace(", tolerance: 5", ""), 12, "c.right", "chain in 'trim' is not continuous");
}

/// A pair with curved edges, a hole and a dart, at random.
fn odd_pair(x: f64, y: f64, bend: f64) -> Garment {
    let text = format!(
        "garment: 1
pieces:
  p:
    cut: pair
    drawn: R
    grain: [[0, 0], [3, 9]]
    outline:
      start: 5 3
      top: C 35 {bend}, 60 {bend}, 100 0
      side: L {x} {y}
      low: Q 20 {y}, 0 80
      center: L 5 3
    holes: {{slot: M 40 45 L 50 45 L 50 48 Z}}
    darts: [{{edge: side, at: 20, intake: 6, length: 15}}]
seams:
  mid: {{sew: p.center, to: mirror}}
free: [p.top, p.side, p.low, p.slot]
"
    );
    garment(&text)
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig {
        cases: 256,
        failure_persistence: None,
        ..Default::default()
    })]
    #[test]
    fn mirrored_pieces_are_the_same_size(x in 90.0..140.0, y in 90.0..150.0, bend in -30.0..20.0) {
        let g = odd_pair(x, y, bend);
        let (drawn, other) = (&g.pieces[0], &g.pieces[1]);
        assert!((drawn.area() - other.area()).abs() < 1e-12);
        assert!((drawn.boundary_length() - other.boundary_length()).abs() < 1e-9);
        assert!(other.loops[0].iter().map(|e| e.path.double_area()).sum::<f64>() > 0.0);
        assert_eq!(other.warp.x, -drawn.warp.x);
        for edge in drawn.loops.iter().flatten() {
            let twin = other.loops.iter().flatten().find(|e| e.name == edge.name).unwrap();
            assert!((edge.path.length() - twin.path.length()).abs() < 1e-9);
            let (p, q) = (edge.path.start(), twin.path.end());
            assert!((p.x + q.x).abs() < 1e-12 && (p.y - q.y).abs() < 1e-12);
        }
    }

    #[test]
    fn no_damaged_file_makes_it_panic(
        which in 0_usize..6,
        at in 0.0..1.0,
        cut in 0_usize..12,
        put in "[-0-9.LCQA@{}, :&*a-z\\n\\[\\]%]{0,6}",
    ) {
        let text_of = |name: &&str| std::fs::read_to_string(path(name)).unwrap();
        let whole = GARMENTS.get(which).map_or_else(|| CATALOGUE.to_owned(), text_of);
        let chars: Vec<char> = whole.chars().collect();
        let at = (at * chars.len() as f64) as usize;
        let end = (at + cut).min(chars.len());
        let damaged: String = chars[..at].iter().copied().chain(put.chars()).chain(chars[end..].to_vec()).collect();
        if let Ok(loaded) = read_text("damaged", "damaged.yaml", &damaged) {
            let again = read_file_only("again.yaml", &write(&loaded.file).unwrap()).unwrap();
            proptest::prop_assert_eq!(&again, &loaded.file);
        }
    }
}

#[test]
fn words_of_a_place_that_mean_nothing_are_named_with_their_place() {
    let with = |place: &str| squares("  a:\n", &format!("  a:\n    place: {place}\n"));
    says(&with("hop front"), 4, "hop front", "place of 'a': 'hop' means nothing; did you mean 'hip'?");
    says(&with("left"), 4, "left", "place of 'a': 'left' names no body part");
    says(&with("hip front back"), 4, "hip", "'hip front back' says two sides");
    for place in ["hip front", "front", "left arm", "Waist", "sleeves", "right leg back", "{at: [0, 9, 9]}"] {
        assert!(mistakes(&with(place)).is_empty(), "{place}");
    }
}

#[test]
fn what_lies_off_its_piece_is_named_with_its_place() {
    let line = |path: &str| squares("  a:\n", &format!("  a:\n    lines: {{roll: {{path: {path}, fold: 90}}}}\n"));
    says(&line("M 0 50 L 150 50"), 4, "M 0 50", "line 'roll' leaves piece 'a' near (");
    says(&line("M 200 50 L 300 50"), 4, "M 200", "line 'roll' leaves piece 'a' near (200, 50)");
    assert!(mistakes(&line("M 0 50 L 100 50")).is_empty());
    // The line goes from tip to tip of a notch that is cut out of the piece.
    let cut_out = line("M 0 1 L 100 1").replacen("top: L 100 0", "top: L 50 40 L 100 0", 1);
    says(&cut_out, 4, "M 0 1", "line 'roll' leaves piece 'a' near (");
    // On a folded piece a line may lie on either half.
    let folded = SQUARES.replacen("  b:\n", "  b:\n    cut: fold right\n    lines: {x: {path: M 50 50 L 150 50}}\n", 1);
    let folded = folded
        .replace("b.bottom, b.right", "b.bottom")
        .replace("sew: a.right, to: b.left", "sew: a.right, to: b.left.L");
    let folded = folded.replace("b.top, b.bottom", "b.top, b.bottom, b.left.R");
    assert!(mistakes(&folded).iter().all(|d| !d.message.contains("leaves piece")), "{:?}", mistakes(&folded));
    let closure = |what: &str| squares("free: [", &format!("closures: [{{kind: button, {what}}}]\nfree: ["));
    let both = closure("piece: a, at: [[5, 5], [500, 5]], meets: b, meets_at: [[5, 5], [5, -9]]");
    says(&both, 21, "[500, 5]", "point (500, 5) of the button lies off piece 'a'");
    says(&both, 21, "[5, -9]", "point (5, -9) of the button lies off piece 'b'");
    says(&closure("piece: a, at: [5, 500]"), 21, "[5, 500]", "point (5, 500) of the button lies off piece 'a'");
    let row = closure("piece: a, at: [5, 5], pitch: 30, count: 5, meets: b");
    says(&row, 21, "[5, 5]", "point (5, 125) of the button lies off piece 'a'");
    let unlike = closure("piece: a, at: [[5, 5], [5, 9]], meets: b, meets_at: [7, 9]");
    says(&unlike, 21, "[7, 9]", "the button has 2 points that are to meet 1");
    says(&closure("edge: a.tpo, at: [5, 0]"), 21, "a.tpo", "edge 'a.tpo' not found");
    assert!(mistakes(&closure("edge: a.top, at: [[5, 0], [100, 100]], meets: b")).is_empty());
}

#[test]
fn a_piece_sewn_to_nothing_is_named() {
    let pocket = "  pocket:\n    grain: [[0, 0], [0, 9]]\n    \
                  outline: {start: 0 0, top: L 50 0, side: L 50 50, hem: L 0 50, in: L 0 0}\nseams:";
    let text = squares("seams:", pocket).replacen("free: [", "free: ['pocket.*', ", 1);
    says(&text, 19, "pocket", "piece 'pocket' is sewn to nothing");
}

#[test]
fn bounds_and_allowances_that_nothing_can_have_are_named_with_their_place() {
    let test = |test: &str| squares("free: [", &format!("tests: [{{{test}}}]\nfree: ["));
    says(&test("gap: all, below: -1 mm"), 21, "-1", "below must be zero or more, not -1");
    says(&test("seam: all, length: -1"), 21, "-1", "length must be zero or more");
    says(&test("drape: all, area: -1 %"), 21, "-1", "area must be zero or more");
    says(&test("drape: all, area: 5 mm"), 21, "5 mm", "area must be a part of the whole");
    says(&test("flatten: a, boundary: 5 %"), 21, "5 %", "boundary must be a length");
    says(&test("drape: all"), 21, "{drape", "it needs 'area', 'boundary' or both");
    says(&test("worn: false"), 21, "false", "unknown worn 'false'; use true, or leave the test out");
    says(&test("gap: all, below: 1 mm, worn: true"), 21, "{gap", "'gap' and 'worn' exclude each other");
    says(&test("crossings: 0, fabric: denin"), 21, "denin", "fabric 'denin' not found; did you mean 'denim'?");
    assert!(mistakes(&test("drape: all, area: 0.5 %, fabric: denim")).is_empty());
    says(&squares("pieces:", "allowance: -3\npieces:"), 2, "-3", "allowance must be zero or more");
    says(&squares("  a:\n", "  a:\n    allowance: -1 cm\n"), 4, "-1", "allowance must be zero or more");
    says(&squares("  a:\n", "  a:\n    allowance: {top: -1}\n"), 4, "-1", "allowance must be zero or more");
    says(&squares("  a:\n", "  a:\n    allowance: {tpo: 1}\n"), 4, "tpo", "edge 'a.tpo' not found");
    let wide = |mm| format!("an allowance of {mm} mm is wider than 200 mm");
    says(&squares("pieces:", "allowance: 201\npieces:"), 2, "201", &wide(201));
    says(&squares("  a:\n", "  a:\n    allowance: 50 cm\n"), 4, "50 cm", &wide(500));
    says(&squares("  a:\n", "  a:\n    allowance: {top: 800}\n"), 4, "800", &wide(800));
    says(&squares("to: b.left", "to: b.left, allowance: 300"), 20, "300", &wide(300));
    assert!(mistakes(&squares("pieces:", "units: cm\nallowance: 20\npieces:").replace("100", "10")).is_empty());
    let first = "'folded 30' names the shape first; an allowance begins with its width: '30 folded'";
    says(&squares("  a:\n", "  a:\n    allowance: {top: folded 30}\n"), 4, "folded", first);
    says(&squares("to: b.left", "to: b.left, allowance: 2 %"), 20, "2 %", "allowance must be a length");
}

#[test]
fn lines_and_places_that_cloth_cannot_have_are_named_with_their_place() {
    let line = |what: &str| squares("  a:\n", &format!("  a:\n    lines: {{x: {{path: M 0 50 L 90 50, {what}}}}}\n"));
    says(&line("fold: 1e8"), 4, "1e8", "fold must be between -180 and 180 degrees, not 100000000");
    // Nor can a file have it that a program made.
    let mut made = read_file_only("test.yaml", &line("fold: 90")).unwrap();
    made.pieces[0].lines[0].fold.as_mut().unwrap().value = 1e8;
    let mut findings = Findings::new("test.yaml", "");
    expand("test", &made, &mut findings);
    assert_eq!(findings.errors(), 1);
    says(&line("ratio: 0.001"), 4, "0.001", "ratio must be between 0.05 and 1");
    says(&line("ratio: 1.2"), 4, "1.2", "ratio must be between 0.05 and 1");
    says(&line("kind: elastic"), 4, "x:", "line 'x' of 'a' is elastic and does not say to what share it draws in");
    says(&line("kind: fold"), 4, "x:", "does not say its angle; add 'fold: 180'");
    says(&line("kind: elastc"), 4, "x:", "is of kind 'elastc'; did you mean 'elastic'?");
    says(&line("kind: elastc, ratio: 0.8"), 4, "x:", "only 'kind: elastic' has one");
    says(&line("fold: 90, ratio: 0.8"), 4, "x:", "has both a fold angle and a ratio");
    assert!(mistakes(&line("kind: stitch")).is_empty());
    let short = "  a:\n    lines: {x: {path: M 0 50 L 0 50.001, fold: 90}}\n";
    says(&squares("  a:\n", short), 4, "M 0 50", "line 'x' of 'a' is only 0.001 mm long");
    let far = squares("  a:\n", "  a:\n    place: {at: [0, 1e6, 0]}\n");
    says(&far, 4, "{at", "place of 'a': [0, 1000000, 0] is more than 10 m from the body's feet");
}

/// Found by tests/fuzz.rs.
#[test]
fn a_dash_before_a_bracket_is_written_as_text() {
    let file = read_file_only("dash.yaml", &squares("pieces:", "fabrics: {shell: denim - - }\npieces:")).unwrap();
    let text = write(&file).unwrap();
    assert!(text.contains("{shell: \"denim - -\"}"), "{text}");
    assert_eq!(read_file_only("again.yaml", &text).unwrap(), file);
}

/// Found by tests/fuzz.rs: YAML itself would not take it where it stands on a line of its own.
#[test]
fn a_key_that_could_not_be_written_again_is_refused() {
    let long = "x.".repeat(600);
    let text = squares("pieces:", &format!("fabrics: {{{long}: denim}}\npieces:"));
    says(&text, 2, &format!("{long}: denim"), "a key has more than 150 characters");
}

#[test]
fn numbers_of_no_size_are_not_spelt_out() {
    says(&squares("to: b.left", "to: b.left, ease: 1e300"), 20, "1e300", "not '1e300'");
    says(&squares("[[0, 0], [0, 9]]", "[[0, nan], [0, 9]]"), 4, "[0, nan", "two finite numbers: x y, not [0, nan]");
    assert_eq!(mistakes(&squares("[[0, 0], [0, 9]]", "[[0, nan], [0, 9]]")).len(), 1);
    says(&squares("top: L 100 0", "top: L 1e30 0"), 7, "L 1e30", "is 1.0e27 m long");
}

#[test]
fn a_hole_that_crosses_the_outline_is_named_where_it_stands() {
    let hole = squares("  a:\n", "  a:\n    holes: {h: M 50 50 L 150 50 L 150 60 Z}\n");
    says(&hole, 4, "h:", "outline of 'a' crosses itself near (100, 55), between right and h");
}

#[test]
fn holes_that_are_none_are_named_with_their_place() {
    let holes = |holes: &str| squares("  a:\n", &format!("  a:\n    holes: {{{holes}}}\n"));
    says(&holes("h: M 20 50 L 80 50 L 20 50 Z"), 4, "M 20 50", "hole 'h' of 'a' encloses less than 1 mm2");
    says(&holes("h: M 20 50 L 20.1 50 L 20 50.1 Z"), 4, "M 20 50", "hole 'h' of 'a' encloses less than 1 mm2");
    let (large, small) = ("M 20 20 L 80 20 L 80 80 L 20 80 Z", "M 40 40 L 60 40 L 60 60 L 40 60 Z");
    let message = "holes 'k' and 'h' of 'a' lie one in the other";
    says(&holes(&format!("h: {large}, k: {small}")), 4, small, message);
    says(&holes(&format!("h: {small}, k: {large}")), 4, large, message);
}

#[test]
fn a_title_moves_no_cursor() {
    let text = squares("garment: 1\n", "garment: 1\nname: \"A\\e[2J skirt\\n\"\n");
    assert_eq!(garment(&text).title, "A\u{fffd}[2J skirt");
}

#[test]
fn long_lines_and_values_are_shortened() {
    let word = "abc ".repeat(300_000);
    for text in [word.clone(), format!("garment: 1\nname: {{{word}: 3}}\npieces: {word}\n"), squares("a.right", &word)]
    {
        let refused = read_text("test", "t.yaml", &text).unwrap_err().to_string();
        assert!(refused.lines().all(|l| l.chars().count() < 1500), "{}", refused.len());
        assert!(refused.contains('…'), "{refused}");
    }
    // The place is in the middle of what is shown.
    let far = squares("free: [", &format!("free: [{} a.tpo, {}", "a.top, ".repeat(90), "a.top, ".repeat(90)));
    let refused = read_text("test", "t.yaml", &far).unwrap_err().to_string();
    let lines: Vec<&str> = refused.lines().collect();
    let column = lines[2].chars().position(|c| c == '^').unwrap();
    assert_eq!(lines[1].chars().skip(column).take(5).collect::<String>(), "a.tpo", "{refused}");
    let escape = squares("a.right", "\"a.\\e[2J\"");
    assert!(!read_text("test", "t.yaml", &escape).unwrap_err().to_string().contains('\u{1b}'));
}

/// On the half that is not drawn a stretch is counted from the mirror image of where the drawn edge starts.
#[test]
fn stretches_of_both_halves_are_counted_from_the_drawn_start() {
    let text = "garment: 1\npieces:\n  a:\n    cut: fold center\n    grain: [[9, 9], [9, 90]]\n    outline: {start: \
                0 0, top: L 100 0, side: L 100 200, hem: L 0 200, center: L 0 0}\n  b:\n    grain: [[9, 9], [9, \
                90]]\n    outline: {start: 0 0, p: L 60 0, q: L 60 30, r: L 0 30, s: L 0 0}\nseams:\n  left: {sew: \
                a.L.side@10..40, to: b.q}\n  right: {sew: a.side.R@10..40, to: b.s}\nfree: ['*.*']\n";
    let garment = read_text("a", "a.yaml", text).unwrap_or_else(|e| panic!("{e}")).garment;
    let named: Vec<String> = walk(&garment).into_iter().map(|seam| seam.a).collect();
    assert_eq!(named, ["a.side.L@10..40", "a.side.R@10..40"]);
    let end = |seam: usize| {
        let span = garment.seams[seam].a[0];
        let path = &garment.pieces[span.edge.piece].loops[span.edge.ring][span.edge.index].path;
        [span.from, span.to].map(|at| (path.point(at).y * 1e3).round()).into_iter().fold(f64::INFINITY, f64::min)
    };
    // Both ten below the top, where the drawn edge starts.
    assert_eq!([end(0), end(1)], [10.0, 10.0]);
}

#[test]
fn garments_of_an_outfit_keep_their_names_layers_and_tests_apart() {
    let single = load("tshirt").garment;
    let skirt = load("gore_skirt").garment;
    let both = outfit(vec![single.clone(), skirt.clone(), single.clone()]);
    assert_eq!(both.worn, ["tshirt", "gore_skirt", "tshirt.2"]);
    let names: HashSet<&str> = both.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names.len(), 2 * single.pieces.len() + skirt.pieces.len());
    assert!(names.contains("tshirt.2/front") && both.seams.iter().any(|s| s.name.starts_with("gore_skirt/")));
    for garments in both.worn.windows(2) {
        let levels = |label: &str| {
            let own = both.pieces.iter().filter(|p| belongs_to(&p.name, label)).map(|p| p.level());
            own.collect::<BTreeSet<i32>>()
        };
        let [inner, outer] = [&garments[0], &garments[1]].map(|label| levels(label));
        assert!(inner.last() < outer.first(), "{inner:?} {outer:?}");
    }
    // Every seam joins pieces of its own garment, and is as long as it was.
    for seam in &both.seams {
        let label = both.worn.iter().find(|label| belongs_to(&seam.name, label)).unwrap();
        assert!(
            seam.a.iter().chain(&seam.b).all(|s| belongs_to(&both.pieces[s.edge.piece].name, label)),
            "{}",
            seam.name
        );
    }
    let lengths = |garment: &Garment| walk(garment).iter().map(|s| s.length_a).collect::<Vec<f64>>();
    assert_eq!(lengths(&both), [lengths(&single), lengths(&skirt), lengths(&single)].concat());
    assert!(both.tests.iter().all(|test| test.of.is_some()));
    assert_eq!(both.tests.len(), 2 * single.tests.len() + skirt.tests.len());
    let alone = outfit(vec![single.clone()]);
    assert!(alone.worn.is_empty() && alone.pieces[0].name == single.pieces[0].name);
}
