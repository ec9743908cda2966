//! The kinds of mistake a garment file can hold, one by one and all at once, as `toile check` finds them: with the
//! place, and without moving any cloth. (What only sewing shows is in `cli.rs` and `sewing.rs`.)

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;
use toile::io::garment::read_text;
use toile::pattern::{Diagnostic, Severity, Span};
use toile::pipeline::check;

/// Two squares sewn at one side, with the tensile curve of a machine that stopped early and one that slipped.
const SQUARES: &str = "\
garment: 1
units: mm
body: woman_92
fabrics: {shell: denim}
pieces:
  front:
    place: {at: [-100, 1000, 300]}
    grain: [[0, 0], [0, 9]]
    outline:
      start: 0 0
      shoulder: L 100 0
      side: L 100 100
      hem: L 0 100
      center: L 0 0
  back:
    place: {at: [10, 1000, 300]}
    grain: [[0, 0], [0, 9]]
    outline:
      start: 0 0
      shoulder: L 100 0
      side: L 100 100
      hem: L 0 100
      center: L 0 0
seams:
  side: {sew: front.side, to: back.center}
free: [front.shoulder, front.hem, front.center, back.shoulder, back.hem, back.side]
";

struct Room {
    folder: TempDir,
}

impl Room {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let room = Self { folder };
        room.put("slipped.csv", "strain %, load gf/cm\n1, 40\n2, 100\n3, 92\n");
        room.put("stopped.csv", "strain %, load gf/cm\n1, 40\n2, 120\n");
        room
    }

    fn put(&self, name: &str, text: &str) -> PathBuf {
        let path = self.folder.path().join(name);
        fs::write(&path, text).expect("written");
        path
    }

    /// Everything `check` finds in the text, at a spacing in mm.
    fn finds(&self, text: &str, spacing: Option<f64>) -> Vec<Diagnostic> {
        match check(&self.put("wrong.yaml", text), spacing.map(|mm| 1e-3 * mm)) {
            Ok(checked) => checked.loaded.warnings,
            Err(refused) => refused.diagnostics,
        }
    }
}

/// What is changed in [`SQUARES`], and what is said of it: at which text of the changed file, in which words.
struct Mistake {
    number: u32,
    changes: &'static [(&'static str, &'static str)],
    severity: Severity,
    at: &'static str,
    says: &'static str,
}

const fn wrong(
    number: u32,
    changes: &'static [(&'static str, &'static str)],
    at: &'static str,
    says: &'static str,
) -> Mistake {
    Mistake { number, changes, severity: Severity::Error, at, says }
}

const fn doubtful(
    number: u32,
    changes: &'static [(&'static str, &'static str)],
    at: &'static str,
    says: &'static str,
) -> Mistake {
    Mistake { number, changes, severity: Severity::Warning, at, says }
}

const SIDE: &str = "{sew: front.side, to: back.center}";
const FRONT: &str = "  front:\n";

/// In the order in which patterns are written: units, names, outlines, seams, closing of the surface, shaping, cutting,
/// fabric, mesh, the file itself. 30 and 31, a piece that starts in the body and a seam that stays open, need cloth.
const MISTAKES: [Mistake; 31] = [
    wrong(1, &[("units: mm", "units: inch")], "inch", "unknown unit 'inch'; use mm, cm or in"),
    wrong(2, &[("front.side,", "frnt.side,")], "frnt.side", "piece 'frnt' not found; did you mean 'front'?"),
    wrong(
        3,
        &[("front.side,", "front.sied,")],
        "front.sied",
        "edge 'front.sied' not found; front has: shoulder, side, hem, center",
    ),
    wrong(
        4,
        &[("center: L 0 0\n  back", "center: L 0 3.2\n  back")],
        "L 0 3.2",
        "outline of 'front' does not close: last point (0, 3.2) is 3.2 mm from start (0, 0)",
    ),
    wrong(
        5,
        &[("hem: L 0 100\n      center: L 0 0\n  back", "hem: L 150 70\n      center: L 0 0\n  back")],
        "center: L 0 0\n  back",
        "outline of 'front' crosses itself near (100, 46.7), between side and center",
    ),
    doubtful(
        6,
        &[(
            "shoulder: L 100 0\n      side: L 100 100\n      hem: L 0 100\n      center: L 0 0\n  back",
            "center: L 0 100\n      hem: L 100 100\n      side: L 100 0\n      shoulder: L 0 0\n  back",
        )],
        "0 0\n      center",
        "outline of 'front' runs counter-clockwise; reversed it",
    ),
    wrong(
        7,
        &[(
            FRONT,
            "  front:\n    darts:\n      - {name: d, edge: hem, at: 20, intake: 5, length: 9}\n      \
             - {name: d, edge: hem, at: 70, intake: 5, length: 9}\n",
        )],
        "front:",
        "edge name 'd.a' used twice in 'front'",
    ),
    wrong(
        8,
        &[(SIDE, "{sew: front.side@0..92.3, to: back.center}")],
        "side: {",
        "front.side@0..92.3 92.3 mm, back.center 100.0 mm, 7.7 mm apart",
    ),
    wrong(
        9,
        &[(SIDE, "{sew: front.side@0..88, to: back.center, ease: 12}")],
        "12}",
        "seam 'side': ease 12 mm is 14 % of 88 mm; more than 8 % gathers, say gather: 1.14",
    ),
    wrong(
        10,
        &[("back.center}", "back.center, gather: 0.6}")],
        "0.6",
        "gather: 0.6 would stretch the cloth by 67 %; did you swap sew and to?",
    ),
    wrong(
        11,
        &[("free: [", "  pocket: {sew: front.side@0..50, to: back.side@0..50}\nfree: [")],
        "pocket",
        "front.side is sewn twice on 0..50 mm: in 'side' and in 'pocket'",
    ),
    wrong(12, &[(", back.hem", "")], "hem: L", "edges neither sewn nor free: back.hem"),
    wrong(
        13,
        &[("back.center}", "back.center@0..900}")],
        "back.center@",
        "seam 'side' uses back.center@0..900 but the edge is 100.0 mm long",
    ),
    wrong(14, &[("front.side,", "front.side@80%..20%,")], "front.side@", "range 80%..20% runs backwards"),
    wrong(
        15,
        &[(SIDE, "{sew: [front.side, front.center], to: [back.center, back.side]}")],
        "front.center], to",
        "chain in 'side' is not continuous: front.side ends at (100, 100), front.center starts at (0, 100)",
    ),
    wrong(
        16,
        &[(SIDE, "{sew: [front.side, front.hem], to: [back.center, back.shoulder]}")],
        "side: {",
        "seam 'side' is twisted: its ends meet",
    ),
    wrong(
        17,
        &[("free: [", "  ring: {sew: front.center, to: back.side, face: same}\nfree: [")],
        "ring",
        "sewing closes the surface into a non-orientable band at 'ring'",
    ),
    wrong(
        18,
        &[("free: [", "tests: [{openings: 4}]\nfree: [")],
        "{openings",
        "garment has 1 openings, expected 4: at front.shoulder",
    ),
    wrong(
        19,
        &[(FRONT, "  front:\n    darts: [{edge: hem, at: 50, intake: 10, tip: [60, 50]}]\n")],
        "10, tip",
        "dart at front.hem@50: legs differ 50.2 / 52.2 mm",
    ),
    wrong(
        20,
        &[(FRONT, "  front:\n    darts: [{edge: hem, at: 50, intake: 10, length: 120}]\n")],
        "50, intake",
        "dart tip (50, -20) lies outside piece 'front'",
    ),
    wrong(
        21,
        &[(FRONT, "  front:\n    cut: fold center\n"), ("center: L 0 0\n  back", "center: C 9 70, 9 30, 0 0\n  back")],
        "fold center",
        "fold edge 'center' is curved; only straight edges can be folded",
    ),
    wrong(
        22,
        &[("seams:", "  collar: {like: back, cut: pair}\nseams:"), ("free: [", "free: ['collar.*', ")],
        "pair}",
        "cut: pair piece 'collar' has no L/R seams; use cut: 2",
    ),
    wrong(
        23,
        &[(FRONT, "  front:\n    pleats: [{edge: hem, at: [10, 50], depth: 30}]\n")],
        "hem, at",
        "pleats on 'front.hem' take 120 mm but the edge has 100 mm",
    ),
    wrong(
        24,
        &[
            (FRONT, "  front:\n    notches: {side: [10, 20]}\n"),
            ("  back:\n", "  back:\n    notches: {center: [80]}\n"),
            ("back.center}", "back.center, match: notches}"),
        ],
        "side: {",
        "notch 2 of front.side has no partner on back.center",
    ),
    wrong(
        25,
        &[("denim}", "{weight: 70 g/m2}}")],
        "shell",
        "fabric 'shell' has no bend value; give bend in gf.cm2/cm, uN.m",
    ),
    wrong(
        26,
        &[("denim}", "{base: denim, tensile: slipped.csv}}")],
        "slipped.csv",
        "tensile curve slipped.csv, row 4: load falls from 100 to 92; curves must rise",
    ),
    doubtful(
        27,
        &[("denim}", "{base: denim, tensile: {weft: stopped.csv}}}")],
        "stopped.csv",
        "tensile curve ends at 120 gf/cm; KES runs to 500. Beyond the last point the last slope is kept",
    ),
    wrong(
        28,
        &[("grain: [[0, 0], [0, 9]]\n    outline", "grain: [[5, 5], [5, 5]]\n    outline")],
        "[[5, 5]",
        "grain of 'front' has zero length",
    ),
    doubtful(
        29,
        &[
            ("side: L 100 100\n      hem: L 0 100", "side: L 100 18\n      hem: L 0 18"),
            ("back.center}", "back.center@0..18}"),
            ("free: [", "free: [back.center, "),
        ],
        "front:",
        "'front' is 18 mm wide, narrower than the mesh size of 20 mm: it is meshed finer, with one row of cells \
         across and springs of 20 mm along",
    ),
    wrong(
        32,
        &[("hem: L 0 100\n", "side: L 0 100\n")],
        "side: L 0 100",
        "duplicate key 'side' at line 13 (first at line 12)",
    ),
    doubtful(
        33,
        &[
            ("front.hem, ", "band.shoulder, band.side, band.center, "),
            ("back.hem, ", ""),
            ("  side: {", "  cuff: {sew: [front.hem, back.hem], to: band.hem}\n  side: {"),
            (
                "seams:",
                "  band:\n    grain: [[0, 0], [0, 9]]\n    outline: {start: 0 0, shoulder: L 200 0, side: L 200 50, \
                 hem: L 0 50, center: L 0 0}\nseams:",
            ),
        ],
        "cuff",
        "seam order: 'cuff' is sewn before 'side' that makes it a ring; order kept, stage them to change",
    ),
];

/// Line and column (from 1) of the last occurrence of a text.
#[track_caller]
fn place(text: &str, part: &str) -> (usize, usize) {
    let at = text.rfind(part).unwrap_or_else(|| panic!("no {part:?} in\n{text}"));
    let before = &text[..at];
    let line = before.matches('\n').count() + 1;
    (line, at - before.rfind('\n').map_or(0, |n| n + 1) + 1)
}

fn changed(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(SQUARES.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "nothing to replace: {from:?}");
        text.replacen(from, to, 1)
    })
}

#[test]
fn the_squares_are_right() {
    assert_eq!(Room::new().finds(SQUARES, None), []);
}

#[test]
fn every_kind_of_mistake_is_found_with_its_place() {
    let room = Room::new();
    for Mistake { number, changes, severity, at, says } in &MISTAKES {
        let text = changed(changes);
        let spacing = (*number == 29).then_some(20.0);
        let found = room.finds(&text, spacing);
        let shown: Vec<String> = found.iter().map(ToString::to_string).collect();
        let hit = found.iter().find(|d| d.message.contains(says));
        let hit = hit.unwrap_or_else(|| panic!("{number}: no '{says}' among:\n{}", shown.join("\n")));
        assert_eq!((hit.severity, hit.line, hit.column), (*severity, place(&text, at).0, place(&text, at).1), "{hit}");
        assert!(hit.to_string().contains('^'), "{number}: the source is underlined:\n{hit}");
    }
}

/// Ten mistakes that have nothing to do with each other, of every part of a file.
#[test]
fn ten_mistakes_are_found_in_one_run() {
    let text = "\
garment: 1
units: inch
body: woman_29
fabrics:
  shell: {weight: 70 g/m2}
  lining: {base: denim, tensile: slipped.csv}
pieces:
  a:
    grain: [[1, 1], [1, 1]]
    outline: {start: 0 0, top: L 100 0, right: L 100 100, bottom: L 0 100, left: L 0 0}
    notches: {tpo: [10]}
  b:
    colour: red
    outline: {start: 0 0, top: L 100 0, right: L 100 100, bottom: L 0 100, left: L 0 9}
  c:
    fabric: 7
    cut: twice
    outline: {start: 0 0, top: L 100 0, top: L 100 100, bottom: L 0 100, left: L 0 0}
  d:
    darts: [{edge: top, at: 50, intake: 10, length: 120}]
    outline: {start: 0 0, top: L 100 0, right: L 100 100, bottom: L 0 100, left: L 0 0}
seams:
  one: {sew: c.top, to: e.top}
  two: {sew: c.bottom, ease: 3}
  three: {sew: c.left@9..3, to: c.bottom}
  four: {sew: c.side, to: c.left}
tests:
  - {seam: all, length: long}
";
    let room = Room::new();
    let found = room.finds(text, None);
    let errors: Vec<&Diagnostic> = found.iter().filter(|d| d.severity == Severity::Error).collect();
    for line in [2, 3, 5, 6, 9, 11, 13, 14, 17, 18, 20, 23, 24, 25, 26, 28] {
        let here: Vec<String> = errors.iter().filter(|d| d.line == line).map(ToString::to_string).collect();
        assert!(!here.is_empty(), "line {line}: {found:#?}");
        let source = text.lines().nth(line - 1).unwrap_or_default();
        assert!(here.iter().all(|d| d.contains(source) && d.contains('^')), "{here:?}");
    }
    assert!(errors.iter().filter(|d| d.hint.is_some()).count() >= 5, "{found:#?}");
}

/// What is sewn twice, forgotten, or listed free without being there is found beside all else; what a seam that cannot
/// be read may have meant, and what is of a piece that cannot be drawn, is not called forgotten.
#[test]
fn edges_are_accounted_for_whatever_else_is_wrong() {
    let square = "{grain: [[0, 0], [0, 9]], outline: {start: 0 0, top: L 100 0, right: L 100 100, bottom: L 0 100, \
                  left: L 0 0}}";
    let text = format!(
        "garment: 1\nbody: woman_92\nfabrics: {{shell: denim}}\npieces:\n  a: {square}\n  b: {square}\n  c: {square}\n\
         \x20 d: {}\nseams:\n  apart: {{sew: a.right@0..90, to: b.left}}\n  typo: {{sew: b.rihgt, to: c.left}}\n  \
         gone: {{sew: d.left, to: c.right}}\n  again: {{sew: a.right@50..100, to: a.left@50..100}}\n\
         free: [a.top, a.bottom, b.top, c.top, c.bottm, d.top, \"d*.bottom\"]\n",
        square.replace("L 100 100", "M 100 100")
    );
    let found = Room::new().finds(&text, None);
    let says: Vec<&str> = found.iter().map(|d| d.message.as_str()).collect();
    let count = |words: &str| says.iter().filter(|m| m.contains(words)).count();
    assert_eq!((count("is sewn twice on 50..90 mm"), count("bottm"), count("rihgt")), (1, 1, 1), "{says:#?}");
    // Of `b` all may have been meant by the name that fits none.
    assert_eq!(count("neither sewn nor free: c.bottom, a.left@0..50"), 1, "{says:#?}");
    assert_eq!(count("d.top") + count("d*.bottom") + count("unknown piece"), 0, "{says:#?}");
}

/// A T-shirt's armhole seen from one side: front and back meet at shoulder and side seam, a sleeve has its under seam.
fn armhole(sleeve: &str, cap: &str) -> String {
    format!(
        "garment: 1\nbody: woman_92\nfabrics: {{shell: denim}}\npieces:\n  \
         front: {{cut: pair, grain: [[50, 100], [50, 300]], outline: {{start: 0 0, shoulder: L 100 20, \
         armhole: L 150 220, side: L 150 500, hem: L 0 500, center: L 0 0}}}}\n  \
         back: {{like: front, drawn: R}}\n  \
         sleeve: {{cut: pair, {sleeve}grain: [[0, 0], [0, 200]], outline: {{start: -150 150, {cap}, \
         under_front: L 120 400, hem: L -120 400, under_back: L -150 150}}}}\n\
         seams:\n  center: {{sew: front.center, to: mirror}}\n  back: {{sew: back.center, to: mirror}}\n  \
         shoulder: {{sew: front.shoulder, to: back.shoulder}}\n  side: {{sew: front.side, to: back.side}}\n  \
         under: {{sew: sleeve.under_front, to: sleeve.under_back}}\n  armhole: {{sew: [front.armhole, back.armhole], \
         to: TO, tolerance: 20}}\nfree: ['*.hem']\n"
    )
}

/// A sleeve's own seam belongs to the foot of the armhole: it comes there where its cap is one edge, in whichever order
/// the armhole is written, and it is said where it cannot.
#[test]
fn sleeves_are_not_set_in_upside_down() {
    let room = Room::new();
    let halves = "cap_back: L 0 10, cap_front: L 150 150";
    let upside = |text: &str| room.finds(text, None).iter().filter(|d| d.message.contains("upside down")).count();
    let two = |sleeve: &str| armhole(sleeve, halves).replace("TO", "[sleeve.cap_front, sleeve.cap_back]");
    assert_eq!([upside(&two("drawn: R, ")), upside(&two(""))], [0, 1]);
    for (sleeve, to) in [("drawn: R, ", "sleeve.cap"), ("", "sleeve.cap")] {
        let one = armhole(sleeve, "cap: L 0 10 L 150 150").replace("TO", to);
        let other = one.replace("[front.armhole, back.armhole]", "[back.armhole, front.armhole]");
        for text in [one, other] {
            let garment = read_text("top", "top.yaml", &text).unwrap_or_else(|e| panic!("{e}")).garment;
            let seam = garment.seams.iter().find(|s| s.name == "armhole.L").expect("an armhole");
            let (span, path) = (seam.a[0], |s: &Span| &garment.pieces[s.edge.piece].loops[0][s.edge.index].path);
            let [start, end] = [span.from, span.to].map(|at| path(&span).point(at).y);
            assert!(start > end + 0.1, "it begins at the side seam, {start} m down, and not at the shoulder");
            assert_eq!(upside(&text), 0);
        }
    }
}

/// An opening begins at an edge that the seam meets; its own edge is at both of its ends.
#[test]
fn an_opening_from_the_seam_s_own_edge_is_refused() {
    let text = armhole("drawn: R, ", "cap: L 0 10 L 150 150").replace("TO", "sleeve.cap");
    let open = |from: &str| {
        let to = format!("sew: back.center, to: mirror, open: {{from: {from}, length: 50}}");
        Room::new().finds(&text.replace("sew: back.center, to: mirror", &to), None)
    };
    assert_eq!(open("hem"), []);
    let found = open("center");
    assert!(found.iter().any(|d| d.message.contains("no end at 'center'; its ends are at")), "{found:?}");
}

/// The curve is told of where it is named, and nowhere else.
/// What is gathered is the longer side: with the two the wrong way round a ratio under 1 would be refused in turn.
#[test]
fn a_gathered_seam_the_wrong_way_round_is_told_to_swap_its_sides() {
    let text = changed(&[(SIDE, "{sew: front.side@0..60, to: back.center, gather: 1.5}")]);
    let found = Room::new().finds(&text, None);
    let told = |advice: &str| found.iter().any(|d| d.to_string().contains(advice));
    assert!(told("swap sew and to and say gather: 1.667"), "{found:?}");
}

#[test]
fn a_curve_that_ends_early_is_told_of_once() {
    let room = Room::new();
    let sheet = "weight: 100 g/m2\nbend: 5 uN.m\ntensile: {warp: stopped.csv, weft: stopped.csv}\n";
    room.put("mine.yaml", sheet);
    let places = |fabrics: &str| -> Vec<(usize, usize)> {
        let text = SQUARES.replace("fabrics: {shell: denim}", fabrics);
        let found = room.finds(&text, None);
        found
            .iter()
            .inspect(|d| assert!(d.message.contains("ends at 120 gf/cm"), "{d}"))
            .map(|d| (d.line, d.column))
            .collect()
    };
    assert_eq!(places("fabrics: {shell: mine.yaml}"), [(4, 18)]);
    assert_eq!(places("fabrics: {shell: {base: mine.yaml, bend: 2}}"), [(4, 25)]);
    // The interfacing stretches as its base does, of which it is said there.
    assert_eq!(places("fabrics: {shell: mine.yaml, fuse: {base: shell, bend: 2}, same: shell}"), [(4, 18)]);
    // Half as stiff is no shorter a test.
    assert_eq!(places("fabrics: {shell: {base: denim, tensile: 0.5}}"), []);
    assert_eq!(places("fabrics: {shell: {base: denim, tensile: {EMT: 5 %, LT: 0.7}}}"), []);
    assert!(Path::new(&room.folder.path().join("mine.yaml")).exists());
}

/// An outline that misses its start by millimetres does not keep the rest of its piece from being looked at.
#[test]
fn an_open_outline_hides_nothing_else() {
    let wrong = SQUARES
        .replacen("center: L 0 0", "center: L 0 4", 1)
        .replacen("grain: [[0, 0], [0, 9]]", "grain: [[0, 9], [0, 9]]\n    fabric: lining", 1)
        .replacen(
            "    outline:",
            "    notches: {sid: [10]}\n    lines: {tape: {path: M 0 50 L 9 50, kind: elastc}}\n    outline:",
            1,
        );
    let found = Room::new().finds(&wrong, None);
    let texts: Vec<String> = found.iter().map(|d| d.message.clone()).collect();
    for words in ["does not close", "zero length", "'lining'", "sid", "elastc"] {
        assert!(texts.iter().any(|text| text.contains(words)), "{words}: {texts:?}");
    }
}

#[test]
fn a_fold_on_an_edge_is_told_from_one_on_the_fold_of_a_piece() {
    let fold = |path: &str| format!("    lines: {{crease: {{path: {path}, fold: 90}}}}\n    outline:");
    let found = |text: &str| Room::new().finds(text, Some(10.0));
    let on_edge = found(&SQUARES.replacen("    outline:", &fold("M 0 100 L 100 100"), 1));
    let [one] = on_edge.as_slice() else { panic!("{on_edge:?}") };
    assert!(one.message.contains("'crease'") && one.message.contains("edge 'hem'"), "{one:?}");
    let within = found(&SQUARES.replacen("    outline:", &fold("M 0 50 L 100 50"), 1));
    assert!(within.iter().all(|d| d.severity != Severity::Error), "{within:?}");
    // The same line, on the edge a piece ends at and on the one it is unfolded at.
    let upright = SQUARES.replacen("    outline:", &fold("M 0 0 L 0 100"), 1);
    let on_center = found(&upright);
    assert!(on_center.iter().any(|d| d.message.contains("edge 'center'")), "{on_center:?}");
    let folded = upright
        .replacen("  front:", "  front:\n    cut: fold center", 1)
        .replacen("{sew: front.side, to: back.center}", "{sew: front.side.L, to: back.center}", 1)
        .replacen("front.center,", "front.side.R,", 1);
    let on_fold = found(&folded);
    assert!(on_fold.iter().all(|d| d.severity != Severity::Error), "{on_fold:?}");
}

/// A seam of a piece that cannot be drawn is still read, and so are tests: one run tells it all.
#[test]
fn a_wrong_piece_hides_nothing_of_its_seams_and_of_the_tests() {
    let wrong = SQUARES
        .replacen("center: L 0 0", "center: L 0 4", 1)
        .replace(
            SIDE,
            "{sew: front.side, to: bakc.center}\n  hem: {sew: front.hem@80..20, to: back.shouldr, gather: 0.5}\n  \
             neck: {sew: front.shoulder, to: mirror}",
        )
        .replace(
            "free: [",
            "tests: [{gap: sied, below: 1}, {gap: side.L, below: 1}, {drape: fornt, area: 1 %}, {drape: front.L, area: \
             1 %}, {openings: 9}]\nfree: [",
        );
    let found = Room::new().finds(&wrong, None);
    let errors: Vec<&Diagnostic> = found.iter().filter(|d| d.severity == Severity::Error).collect();
    for words in [
        "does not close",
        "piece 'bakc' not found; did you mean 'back'?",
        "80..20 runs backwards",
        "edge 'back.shouldr' not found",
        "gather: 0.5 would stretch",
        "'sied'",
        "piece 'fornt' not found; did you mean 'front'?",
    ] {
        says_once(&found, words);
    }
    assert_eq!(errors.len(), 7, "{errors:#?}");
}

/// The catalogue of features is no garment: a seam of two folded pieces is wrong on both sides, which is one mistake.
#[test]
fn what_is_wrong_on_both_sides_is_said_once() {
    let found = Room::new().finds(include_str!("data/catalogue.yaml"), None);
    says_once(&found, "seam 'yoke_skirt': yoke.lower 196.5 mm, skirt.top 206.0 mm");
}

/// Half a metre wide, in millimetres.
const CUBE: &str = "\
v 0 0 0\nv 500 0 0\nv 500 500 0\nv 0 500 0\nv 0 0 500\nv 500 0 500\nv 500 500 500\nv 0 500 500
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6
";

/// A skirt of two like pieces, in a unit and with more in its front.
fn skirt(unit: &str, scale: f64, more: &str) -> String {
    let n = |x: f64| (x * scale).to_string();
    format!(
        "garment: 1
{unit}body: woman_92
pieces:
  front:
    grain: [[0, {}], [0, {}]]
{more}    outline: {{start: {} 0, waist: L {} 0, right: L {} {}, hem: L {} {}, left: L {} 0}}
  back: {{like: front}}
seams:
  left: {{sew: front.right, to: back.left}}
  right: {{sew: front.left, to: back.right}}
free: ['*.waist', '*.hem']
",
        n(50.0),
        n(250.0),
        n(-200.0),
        n(200.0),
        n(290.0),
        n(300.0),
        n(-290.0),
        n(300.0),
        n(-200.0)
    )
}

#[track_caller]
fn says_once(found: &[Diagnostic], words: &str) {
    let count = found.iter().filter(|d| d.to_string().contains(words)).count();
    assert_eq!(count, 1, "{words:?} in {found:#?}");
}

#[test]
fn a_garment_in_another_unit_than_thought_is_doubted() {
    let room = Room::new();
    assert_eq!(room.finds(&skirt("", 1.0, ""), None), []);
    assert_eq!(room.finds(&skirt("units: cm\n", 0.1, ""), None), []);
    let small = room.finds(&skirt("", 0.1, ""), Some(3.0));
    says_once(&small, "the largest piece, 'front', is 65 mm long");
    says_once(&small, "write 'units: cm'");
    // And where it is too small to be meshed, which that explains.
    let tiny = room.finds(&skirt("", 0.01, ""), None);
    says_once(&tiny, "springs across)");
    says_once(&tiny, "write 'units: cm'");
    let large = room.finds(&skirt("units: cm\n", 1.0, ""), Some(100.0));
    says_once(&large, "is the drawing in another unit than cm?");
    assert!(small.iter().chain(&large).all(|d| d.severity == Severity::Warning), "{small:#?} {large:#?}");
    says_once(&small, "passes through an opening of it and of what it is sewn to");
    assert_eq!(place(&skirt("units: cm\n", 1.0, ""), "cm"), (large[0].line, large[0].column));
}

#[test]
fn what_like_pieces_have_wrong_is_said_once() {
    let found = Room::new().finds(&skirt("", 1.0, "    notches: {hem: [900]}\n"), None);
    says_once(&found, "notch at 900.0 mm lies off front.hem, which is 580.0 mm long (the same in 'back')");
    assert_eq!(found.len(), 1, "{found:#?}");
    // What two pieces say for themselves is said of each.
    let own = "    notches: {hem: [900]}\n";
    let text = skirt("", 1.0, own).replace("{like: front}", "{like: front, notches: {hem: [901]}}");
    assert_eq!(Room::new().finds(&text, None).len(), 2);
}

#[test]
fn elastic_may_be_given_in_percent() {
    let line = |ratio: &str| format!("    lines: {{c: {{path: M -200 20 L 200 20, kind: elastic, ratio: {ratio}}}}}\n");
    assert_eq!(Room::new().finds(&skirt("", 1.0, &line("70 %")), None), []);
    let found = Room::new().finds(&skirt("", 1.0, &line("170 %")), None);
    assert!(found.iter().any(|d| d.message.contains("ratio must be between 0.05 and 1")), "{found:#?}");
}

#[test]
fn units_within_a_path_are_called_so() {
    let room = Room::new();
    for (from, to, unit) in
        [("L 200 0", "L 20cm 0", "cm"), ("L 200 0", "L 200 mm 0", "mm"), ("L 200 0", "L 8in 0", "in")]
    {
        let text = skirt("", 1.0, "").replace(from, to);
        says_once(
            &room.finds(&text, None),
            &format!("has the unit {unit}; in a path all numbers are in the file's units"),
        );
    }
    let line = skirt("", 1.0, "    lines: {c: {path: M 0cm 20 L 100 20}}\n");
    says_once(&room.finds(&line, None), "has the unit cm");
}

#[test]
fn places_are_looked_at_on_the_body() {
    let room = Room::new();
    let placed = |place: &str| skirt("", 1.0, &format!("    place: {place}\n"));
    says_once(&room.finds(&placed("[0, 900, 300]"), None), "or a position as {at: [x, y, z]}");
    let inside = placed("{at: [0, 900, 20]}").replace("{like: front}", "{like: front, place: {at: [0, 900, -300]}}");
    let found = room.finds(&inside, None);
    says_once(&found, "piece 'front' starts inside the body");
    assert_eq!((found[0].severity, found[0].line), (Severity::Error, place(&inside, "{at: [0, 900, 20]}").0));
    let before = placed("{at: [0, 900, 300]}").replace("{like: front}", "{like: front, place: {at: [0, 900, -300]}}");
    assert_eq!(room.finds(&before, None), []);
    // A cube has no hips.
    room.put("cube.obj", CUBE);
    let hips = placed("hip front").replace("body: woman_92", "body: cube.obj\nbody_units: mm");
    says_once(&room.finds(&hips, None), "mannequin 'cube' has no trunk or limbs");
}

#[test]
fn a_fold_is_neither_sewn_nor_free() {
    let text = "garment: 1\npieces:\n  front:\n    cut: fold hem\n    grain: [[0, 50], [0, 250]]\n    outline: {start: \
                -200 0, waist: L 200 0, right: L 200 300, hem: L -200 300, left: L -200 0}\nfree: ['*.hem', \
                front.waist, front.right, front.left]\n";
    says_once(&Room::new().finds(text, None), "'*.hem' matches only front.hem, which lies on the fold");
}

#[test]
fn a_piece_that_closures_hold_is_not_sewn_to_nothing() {
    let patch = |closures: &str| {
        skirt("", 1.0, "").replace(
            "seams:",
            &format!(
                "  patch:\n    grain: [[10, 10], [10, 90]]\n    outline: {{start: 0 0, rim: L 90 0 L 90 90 L 0 90 L 0 \
                 0}}\n{closures}seams:"
            ),
        )
        .replace("free: [", "free: [patch.rim, ")
    };
    says_once(&Room::new().finds(&patch(""), None), "piece 'patch' is sewn to nothing");
    let tacks = "closures:\n  - {kind: tack, piece: patch, at: [[5, 5], [85, 5]], meets: front, meets_at: [[5, 105], \
                 [85, 105]]}\n";
    assert_eq!(Room::new().finds(&patch("").replace("seams:", &format!("{tacks}seams:")), None), []);
}

#[test]
fn a_difference_is_shown_with_the_digits_that_tell() {
    let text = changed(&[(SIDE, "{sew: front.side@0..89.99, to: back.center, tolerance: 10}")]);
    says_once(&Room::new().finds(&text, None), "10.01 mm apart; ");
    says_once(&Room::new().finds(&text, None), "(tolerance 10)");
}

#[test]
fn friction_is_no_percentage() {
    let text = SQUARES.replace("{shell: denim}", "{shell: {base: denim, friction: 4}}");
    says_once(&Room::new().finds(&text, None), "friction");
}
