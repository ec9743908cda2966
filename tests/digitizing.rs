//! Foreign drawings as garment files: lengths against the drawing's own numbers, and toile's patterns there and back.

use std::f64::consts::PI;

use toile::cutting::{CuttingOptions, Layout, Paper, SewKind, Sheet, papers};
use toile::digitize::{Digitized, Traced, garment_file};
use toile::geometry::{Path, Vec2};
use toile::io::dxf_read::read_dxf_text;
use toile::io::dxf_write::cutting_dxf;
use toile::io::garment::{Loaded, read_text, write};
use toile::io::svg_read::read_svg_text;
use toile::io::svg_write::{cutting_svg, pattern_svg};
use toile::mesh::build;
use toile::pattern::{CutKind, DartFile, DartShape, DrawnPiece, Located, NotchFile, PieceFile, drawings};

const INKSCAPE: &str = include_str!("data/inkscape.svg");
const FREESEWING: &str = include_str!("data/freesewing.svg");
/// A hundredth of a millimetre, metres.
const EXACT: f64 = 1e-5;

/// The garment that the made file is, read by the same door as any other.
fn loaded(made: &Digitized) -> Loaded {
    let yaml = write(&made.file).expect("YAML");
    read_text("drawing", "drawing.yaml", &yaml).unwrap_or_else(|e| panic!("{e}\n{yaml}"))
}

fn drawn(made: &Digitized) -> Vec<DrawnPiece> {
    let loaded = loaded(made);
    drawings(&loaded.file, &loaded.garment)
}

fn from_svg(text: &str) -> Digitized {
    garment_file("drawing", &read_svg_text(text).expect("pieces").pieces)
}

fn lengths(drawing: &DrawnPiece) -> Vec<(String, f64)> {
    drawing.rings[0].iter().map(|e| (e.name.clone(), e.path.length() * 1e3)).collect()
}

fn length(drawing: &DrawnPiece, edge: &str) -> f64 {
    lengths(drawing).iter().find(|e| e.0 == edge).unwrap_or_else(|| panic!("{edge} in {:?}", lengths(drawing))).1
}

/// Length of a cubic, by its own polynomial at many points: shares nothing with the library's.
fn cubic(p: [[f64; 2]; 4]) -> f64 {
    let at = |t: f64| -> [f64; 2] {
        let s = 1.0 - t;
        let w = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        [0, 1].map(|k| (0..4).map(|i| w[i] * p[i][k]).sum())
    };
    let n = 20_000;
    (0..n)
        .map(|i| (at(i as f64 / n as f64), at((i + 1) as f64 / n as f64)))
        .map(|(a, b)| (b[0] - a[0]).hypot(b[1] - a[1]))
        .sum()
}

#[test]
fn an_inkscape_drawing_has_its_units_transforms_and_labels() {
    let made = from_svg(INKSCAPE);
    let pieces = drawn(&made);
    let names: Vec<&str> = pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["front", "back"], "hidden and unused shapes are no pieces");
    // Half a millimetre per unit.
    let side = cubic([[420.0, 20.0], [460.0, 120.0], [460.0, 220.0], [420.0, 320.0]]) * 0.5;
    let front = &pieces[0];
    // Clockwise from the upper left; the left side is split at its notch.
    assert!((length(front, "a") - 200.0).abs() < 0.01, "{:?}", lengths(front));
    assert!((length(front, "b") - side).abs() < 0.01, "{} {side}", length(front, "b"));
    assert!((length(front, "d") + length(front, "e") - 150.0).abs() < 0.01);
    assert!((length(front, "d") - 75.0).abs() < 0.1 && front.notches.len() == 1);
    let [tail, head] = front.grain.expect("a grain");
    assert!((tail - head).norm() - 0.110 < 1e-6 && tail.y > head.y);
    assert_eq!(front.lines.iter().map(|l| l.name.as_str()).collect::<Vec<_>>(), ["pocket"]);
    // The straight sides are 10 mm from the cut line.
    let widths: Vec<Option<f64>> = front.rings[0].iter().map(|e| e.allowance.width).collect();
    assert!((widths[0].expect("measured") - 0.010).abs() < 1e-4, "{widths:?}");
    let back = &pieces[1];
    assert_eq!(lengths(back).iter().map(|l| l.1.round()).collect::<Vec<_>>(), [200.0, 150.0, 200.0, 150.0]);
}

#[test]
fn a_freesewing_drawing_gives_seam_fold_grain_and_notches() {
    let made = from_svg(FREESEWING);
    let pieces = drawn(&made);
    assert_eq!(pieces.len(), 1);
    let front = &pieces[0];
    assert_eq!(front.name, "front");
    let fold = front.fold.expect("a fold");
    assert!((front.rings[0][fold].path.length() - 0.250).abs() < EXACT);
    let neck = cubic([[0.0, 50.0], [40.0, 50.0], [60.0, 30.0], [80.0, 0.0]]);
    let armhole = cubic([[140.0, 20.0], [130.0, 60.0], [130.0, 100.0], [160.0, 130.0]]);
    for (wanted, what) in [
        (neck, "neck"),
        (60f64.hypot(20.0), "shoulder"),
        (armhole, "armhole"),
        (70.0, "side above the notch"),
        (100.0, "side below"),
        (160.0, "hem"),
    ] {
        assert!(lengths(front).iter().any(|l| (l.1 - wanted).abs() < 0.01), "{what} {wanted}: {:?}", lengths(front));
    }
    assert!(front.grain.is_some() && front.notches.len() == 1);
}

/// Of a piece without allowance at neck and armhole FreeSewing (Aaron) draws the rest of the cut line only.
#[test]
fn a_cut_line_in_parts_goes_on_along_the_sewing_line() {
    let sewn = "M 0,50 L 0,300 L 160,300 L 160,130 C 130,100 130,60 140,20 L 80,0 C 60,30 40,50 0,50 z";
    let parts =
        ["M 140,20 L 143.16,10.51 L 83.16,-9.49 L 80,0", "M 0,300 L 0,320 L 160,320 L 170,300 L 170,130 L 160,130"];
    let [shoulder, rest] = parts.map(|d| format!("<path class='fabric sa' d='{d}'/>"));
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='400mm' height='400mm' viewBox='0 -50 400 400'>\
         <g id='fs-stack-aaron.front'><path class='fabric' d='{sewn}'/>{shoulder}{rest}</g></svg>"
    );
    let pieces = drawn(&from_svg(&svg));
    let [front] = pieces.as_slice() else { panic!("{} pieces", pieces.len()) };
    let width = |long: f64| {
        let edge = front.rings[0].iter().find(|e| (e.path.length() * 1e3 - long).abs() < 0.01);
        edge.and_then(|e| e.allowance.width).expect("an allowance") * 1e3
    };
    let neck = cubic([[0.0, 50.0], [40.0, 50.0], [60.0, 30.0], [80.0, 0.0]]);
    for (long, wide) in [(neck, 0.0), (60f64.hypot(20.0), 10.0), (170.0, 10.0), (160.0, 20.0), (250.0, 0.0)] {
        assert!((width(long) - wide).abs() < 0.06, "{long}: {} mm", width(long));
    }
}

/// A drawing as FreeSewing makes it, of what stands in its parts.
fn freesewing(parts: &[(&str, &str)]) -> String {
    let group = |(name, inside): &(&str, &str)| format!("<g id='fs-stack-some.{name}'>{inside}</g>");
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' width='900mm' \
         height='900mm' viewBox='-100 -100 900 900'>{}</svg>",
        parts.iter().map(group).collect::<String>()
    )
}

/// FreeSewing (Breanna) draws the mouth of a dart where the seam allowance is, beyond the legs.
#[test]
fn lines_in_the_allowance_are_none_of_the_piece() {
    let back = "<path class='fabric' id='fs-1' d='M 0,0 V 300 H 90 L 100,200 L 110,300 H 200 V 0 z'/>\
                <path class='fabric dotted' id='fs-2' d='M 90,300 L 100,300.7 L 110,300'/>\
                <path class='sa' id='fs-3' d='M -10,-10 V 310 H 90 L 100,310.7 L 110,310 H 210 V -10 z'/>\
                <path class='fabric dotted' id='fs-4' d='M 20,100 H 60'/>";
    let read = read_svg_text(&freesewing(&[("back", back)])).expect("a piece");
    assert_eq!(read.left_out, ["left out: 1 line in the allowance of 'back', beyond its sewing line"]);
    let pieces = drawn(&garment_file("drawing", &read.pieces));
    let lines: Vec<(&str, f64)> = pieces[0].lines.iter().map(|l| (l.name.as_str(), l.path.length())).collect();
    let [(name, length)] = lines[..] else { panic!("{lines:?}") };
    assert!((length - 0.040).abs() < EXACT && !name.starts_with("fs"), "{lines:?}");
}

/// A line may be drawn on across the allowance to the cut line: what is sewn has it as far as the sewing line.
#[test]
fn lines_that_run_into_the_allowance_end_at_the_sewing_line() {
    let back = "<path class='fabric' d='M 0,0 V 300 H 200 V 0 z'/><path class='sa' d='M -10,-10 V 310 H 210 V -10 z'/>\
                <path class='fabric dotted' d='M -10,100 H 60'/><path class='fabric dotted' d='M -10,200 H 210'/>";
    let pieces = drawn(&from_svg(&freesewing(&[("back", back)])));
    let lengths: Vec<i64> = pieces[0].lines.iter().map(|l| (l.path.length() * 1e3).round() as i64).collect();
    assert_eq!(lengths, [60, 200]);
}

#[test]
fn a_fold_may_be_drawn_as_any_straight_line() {
    for fold in ["<path class='fold' d='M 0,0 V 120 L 0,300'/>", "<line class='fold' x1='0' y1='0' x2='0' y2='300'/>"] {
        let half = format!("<path class='fabric' d='M 0,0 V 300 H 200 V 0 z'/>{fold}");
        let pieces = drawn(&from_svg(&freesewing(&[("back", &half)])));
        assert!(pieces[0].fold.is_some(), "{fold}");
    }
}

/// On a sleeve cap FreeSewing's `bnotch` tells the back from the front, as a double notch does.
#[test]
fn a_back_notch_of_freesewing_is_a_double_one() {
    let sleeve = "<path class='fabric' d='M 0,0 C 50,-90 150,-90 200,0 L 200,300 L 0,300 z'/>\
                  <use x='38.6' y='-45.8' xlink:href='#bnotch'/><use x='200' y='100' xlink:href='#notch'/>\
                  <use x='0' y='200' xlink:href='#bnotch'/><use x='50' y='300' xlink:href='#bnotch'/>";
    let pieces = drawn(&from_svg(&freesewing(&[("sleeve", sleeve)])));
    // Clockwise from the right side.
    let doubles: Vec<bool> = pieces[0].notches.iter().map(|n| n.double).collect();
    assert_eq!(doubles, [false, true, true, true], "{:?}", pieces[0].notches);
    for long in [100.0, 150.0] {
        let edges = lengths(&pieces[0]);
        assert!(edges.iter().any(|l| (l.1 - long).abs() < EXACT * 1e3), "{long}: {edges:?}");
    }
}

/// An outline that open lines make stands where it is drawn, not behind those that are closed.
#[test]
fn pieces_come_in_the_order_of_the_drawing() {
    let [open, closed] = [["M 0,0 V 100 H 100", "M 100,100 V 0 H 0"], ["M 200,0 V 100 H 300 V 0 z", ""]];
    let inside = |paths: [&str; 2]| {
        let drawn = paths.into_iter().filter(|d| !d.is_empty());
        drawn.map(|d| format!("<path class='fabric sa' d='{d}'/>")).collect::<String>()
    };
    let [open, closed] = [open, closed].map(inside);
    let read = read_svg_text(&freesewing(&[("front", &open), ("back", &closed)])).expect("pieces");
    let names: Vec<&str> = read.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["front", "back"]);
}

/// Both lines of a double notch reach from the sewing line to the cut line: which end is nearer is due to rounding.
#[test]
fn double_notches_on_slanted_edges_are_read_as_such() {
    let text = SAMPLE.replace("{side: [100]}", "{side: [40 double, 100 double, 160, 220 double]}");
    let loaded = read_text("sample", "sample.yaml", &text).expect("a garment");
    let papers = papers(&drawings(&loaded.file, &loaded.garment), &CuttingOptions::default());
    let sheet = Sheet::new(&papers, &Layout { width: None, margin: 0.010, square: true });
    for piece in drawn(&from_svg(&cutting_svg("Sample", &sheet))) {
        let doubles: Vec<bool> = piece.notches.iter().map(|n| n.double).collect();
        assert_eq!(doubles, [true, true, false, true], "{}", piece.name);
    }
}

/// A fish-eye comes back as the dart it was, not as a hole that stays open, nor as lines and marks.
#[test]
fn fish_eye_darts_come_back() {
    let eyes = "    darts:\n      - {name: waist, at: [55, 150], intake: 12, up: 60, down: 40}\n      \
                - {name: hip, at: [30, 240], intake: 8, up: 30, down: 30}\n  back:\n";
    let text = SAMPLE.replacen("  back:\n", eyes, 1);
    let loaded = read_text("sample", "sample.yaml", &text).expect("a garment");
    for whole in [false, true] {
        let papers =
            papers(&drawings(&loaded.file, &loaded.garment), &CuttingOptions { whole, ..CuttingOptions::default() });
        let sheet = Sheet::new(&papers, &Layout { width: None, margin: 0.010, square: true });
        let svg = from_svg(&cutting_svg("Sample", &sheet));
        let dxf = garment_file("sample", &read_dxf_text(&cutting_dxf("Sample", &papers), None).expect("pieces").pieces);
        for made in [svg, dxf] {
            let front = made.file.pieces.iter().find(|p| p.name.value == "front").expect("the front");
            let says = |dart: &DartFile| match &dart.shape {
                DartShape::FishEye { at, up, down } => {
                    (at.value, [&dart.intake, up, down].map(|q| q.value.number.round()))
                }
                DartShape::Edge { .. } => panic!("{dart:?}"),
            };
            let (places, darts): (Vec<_>, Vec<[f64; 3]>) = front.darts.iter().map(says).unzip();
            assert_eq!(darts.len(), if whole { 4 } else { 2 }, "{darts:?}");
            assert!(darts.contains(&[12.0, 60.0, 40.0]) && darts.contains(&[8.0, 30.0, 30.0]), "{darts:?}");
            assert!(front.holes.is_empty() && front.lines.is_empty(), "{front:?}");
            let at = places[0];
            assert!(whole || (at[0] - 55.0).hypot(at[1] - 170.0) < 0.01, "{at:?}");
        }
    }
}

/// Two pieces that are sewn at the side, one of them on the fold, with everything that is drawn.
const SAMPLE: &str = "
garment: 1
name: Sample
pieces:
  front:
    cut: fold center
    grain: [[60, 250], [60, 60]]
    allowance: {hem: 40, neck: 6, shoulder: 12 , side: 12 mitred}
    outline: {start: 0 20, neck: C 40 20 60 0 80 -20, shoulder: L 130 0, side: C 100 100 90 200 140 300, hem: L 0 300,
      center: L 0 20}
    notches: {side: [100]}
  back:
    cut: pair
    grain: [[60, 250], [60, 60]]
    allowance: 10
    outline: {start: 0 40, neck: C 40 30 60 0 80 -20, shoulder: L 130 0, side: C 100 100 90 200 140 300, hem: L 20 300,
      center: L 0 40}
    notches: {side: [100]}
seams:
  back: {sew: back.center, to: mirror}
free: ['front.*', back.neck, back.shoulder, back.side, back.hem]
";

fn sample() -> (Vec<DrawnPiece>, Vec<Paper>) {
    let loaded = read_text("sample", "sample.yaml", SAMPLE).expect("a garment");
    let drawings = drawings(&loaded.file, &loaded.garment);
    let papers = papers(&drawings, &CuttingOptions::default());
    (drawings, papers)
}

/// The outline begun at its upper left corner and moved there, sampled.
fn outline(drawing: &DrawnPiece) -> (Vec<Vec2>, f64, Path) {
    let whole = drawing.rings[0].iter().map(|e| e.path.clone()).reduce(|a, b| a.joined(&b)).expect("edges");
    let points = whole.sampled(1e-7);
    let low = points.iter().fold(points[0], |low, p| low.inf(p));
    let moved = whole.mapped(nalgebra::Matrix2::identity(), -low);
    (points.iter().map(|p| p - low).collect(), whole.double_area() / 2.0, moved)
}

fn same_outlines(made: &Digitized, drawn_before: &[DrawnPiece]) {
    let after = drawn(made);
    assert_eq!(after.len(), drawn_before.len());
    for before in drawn_before {
        let again = after.iter().find(|p| p.name == before.name).expect("the piece");
        let ((points, area, path), (points_again, area_again, path_again)) = (outline(before), outline(again));
        // Chords leave a curve by two micrometres at most.
        assert!((area - area_again).abs() < 2e-6 * path.length(), "{}: {area} {area_again}", before.name);
        let off = |points: &[Vec2], path: &Path| points.iter().map(|p| path.nearest(*p).1).fold(0.0, f64::max);
        let worst = off(&points, &path_again).max(off(&points_again, &path));
        assert!(worst <= EXACT, "{} is {worst} m off", before.name);
        assert_eq!(before.fold.is_some(), again.fold.is_some(), "{}", before.name);
        assert_eq!(before.notches.len(), again.notches.len(), "{}", before.name);
        for edge in &again.rings[0] {
            let nearest = |e: &toile::pattern::DrawnEdge| {
                let middle = edge.path.point(edge.path.length() / 2.0);
                e.path.nearest(middle + path_shift(before, again)).1
            };
            let own = before.rings[0].iter().min_by(|a, b| nearest(a).total_cmp(&nearest(b))).expect("edges");
            if before.fold.is_none_or(|f| before.rings[0][f].name != own.name) {
                let (wanted, found) = (own.allowance.width.expect("given"), edge.allowance.width.expect("measured"));
                assert!((wanted - found).abs() < 1.5e-4, "{}.{}: {wanted} {found}", before.name, own.name);
            }
        }
    }
}

/// From the second's drawing to the first's.
fn path_shift(before: &DrawnPiece, again: &DrawnPiece) -> Vec2 {
    let low = |d: &DrawnPiece| {
        let points: Vec<Vec2> = d.rings[0].iter().flat_map(|e| e.path.sampled(1e-6)).collect();
        points.iter().fold(points[0], |low, p| low.inf(p))
    };
    low(before) - low(again)
}

#[test]
fn an_exported_svg_is_read_back() {
    let (drawings, papers) = sample();
    let sheet = Sheet::new(&papers, &Layout { width: None, margin: 0.010, square: true });
    let made = from_svg(&cutting_svg("Sample", &sheet));
    same_outlines(&made, &drawings);
    let again = drawn(&made);
    assert!(again.iter().all(|p| p.rings[0].iter().any(|e| e.name == "hem")), "edges keep their names");
    // What is written on the piece says so.
    assert_eq!(again.iter().find(|p| p.name == "back").map(|p| &p.cut), Some(&CutKind::Pair));
}

/// What `make` draws is read back with its edges, notches and lines, and without the drawn outlines dashed below.
#[test]
fn a_flattened_pattern_is_read_back() {
    // The first two lie as near each other as the marks of a double one of another program.
    let more = "notches: {side: [100, 109, 220 double]}\n    lines:\n      \
                tape: {path: M 10 200 L 90 200, kind: elastic, ratio: 0.7}\n      \
                crease: {path: M 10 250 L 90 250, fold: -90}\n  back:";
    let text = SAMPLE.replacen("notches: {side: [100]}\n  back:", more, 1);
    let garment = read_text("sample", "sample.yaml", &text).expect("a garment").garment;
    let mesh = build(&garment, 0.02).expect("a mesh");
    let flat: Vec<Vec2> = mesh.flat.iter().map(|p| p * 1.001).collect();
    let notches: Vec<_> = garment.pieces.iter().flat_map(|p| p.notches.clone()).collect();
    let made = from_svg(&pattern_svg(&mesh, &flat, &notches).expect("a drawing"));
    let again = loaded(&made).garment;
    assert_eq!(again.pieces.len(), mesh.pieces.len());
    for (piece, cut) in again.pieces.iter().zip(&mesh.pieces) {
        let mut names: Vec<&str> = piece.loops[0].iter().map(|e| e.name.as_str()).collect();
        let mut drawn: Vec<String> = cut.edges.iter().map(|e| e.name.replace('.', "_")).collect();
        names.sort_unstable();
        drawn.sort_unstable();
        assert_eq!(names, drawn, "{}", piece.name);
    }
    let front = &again.pieces[0];
    assert_eq!(front.notches.len(), 6, "three on either side");
    assert_eq!(front.notches.iter().filter(|n| n.double).count(), 2, "{:?}", front.notches);
    let kinds: Vec<String> = front.lines.iter().map(|l| format!("{} {:?}", l.name, l.kind)).collect();
    assert!(
        kinds.iter().any(|k| k.contains("Elastic(0.7)")) && kinds.iter().any(|k| k.contains("Fold(-1.57")),
        "{kinds:?}"
    );
    assert!(kinds.iter().all(|k| !k.contains("Mark")), "{kinds:?}");
}

/// Both of a pair on the paper are a pair again, by name and mirrored shape; two of a kind are not.
#[test]
fn pieces_drawn_left_and_right_are_a_pair() {
    let loaded = read_text("sample", "sample.yaml", SAMPLE).expect("a garment");
    let whole = CuttingOptions { whole: true, ..CuttingOptions::default() };
    let papers = papers(&drawings(&loaded.file, &loaded.garment), &whole);
    let names: Vec<&str> = papers.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["front", "back.L", "back.R"]);
    let sheet = Sheet::new(&papers, &Layout { width: None, margin: 0.010, square: true });
    let svg = from_svg(&cutting_svg("Sample", &sheet));
    let dxf = garment_file("sample", &read_dxf_text(&cutting_dxf("Sample", &papers), None).expect("pieces").pieces);
    for made in [svg, dxf] {
        let pieces = drawn(&made);
        let cuts: Vec<(&str, &CutKind)> = pieces.iter().map(|p| (p.name.as_str(), &p.cut)).collect();
        assert_eq!(cuts, [("front", &CutKind::One), ("back", &CutKind::Pair)]);
        // It lies where it begins, wherever on the sheet it was.
        let low = outline(&pieces[1]).2.start() - pieces[1].rings[0][0].path.start();
        assert!(low.norm() < EXACT, "{low}");
    }
    // Triangles without names, each other's mirror image; and two that are both the same and mirrored.
    let svg = |shapes: &str| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='900mm' height='900mm' viewBox='0 0 900 900'>{shapes}</svg>"
        );
        drawn(&from_svg(&text)).into_iter().map(|p| p.cut).collect::<Vec<CutKind>>()
    };
    assert_eq!(svg("<path d='M 0 0 L 100 0 L 0 200 Z'/><path d='M 300 0 L 200 0 L 300 200 Z'/>"), [CutKind::Pair]);
    assert_eq!(
        svg("<path d='M 0 0 L 100 0 L 0 200 Z'/><path d='M 200 0 L 300 0 L 200 200 Z'/>"),
        [CutKind::One, CutKind::One]
    );
    assert_eq!(
        svg("<rect width='100' height='200'/><rect x='200' width='100' height='200'/>"),
        [CutKind::One, CutKind::One]
    );
}

/// A potholder and a cushion: corners rounded by one radius, by two, to a circle; lengths with units of their own.
#[test]
fn rounded_rectangles_keep_their_corners() {
    let svg = |shape: &str| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='900mm' height='900mm' viewBox='0 0 900 900'>{shape}</svg>"
        );
        let (_, area, path) = outline(&drawn(&from_svg(&text))[0]);
        (area * 1e6, path.length() * 1e3)
    };
    let close = |(area, length): (f64, f64), wanted: [f64; 2]| {
        assert!((area / wanted[0] - 1.0).abs() < 1e-3, "{area} mm2, not {}", wanted[0]);
        assert!((length / wanted[1] - 1.0).abs() < 1e-3, "{length} mm, not {}", wanted[1]);
    };
    // One radius is both: 200 × 300 less (4 − π) r², 2 (200 + 300) less (8 − 2π) r.
    let rounded = |r: f64| [60_000.0 - (4.0 - PI) * r * r, 1000.0 - (8.0 - 2.0 * PI) * r];
    close(svg("<rect width='200' height='300' rx='40'/>"), rounded(40.0));
    close(svg("<rect x='-7' y='9' width='200' height='300' ry='25'/>"), rounded(25.0));
    // As far as half a side: a circle of 200 mm across.
    close(svg("<rect width='200' height='200' rx='500' ry='500'/>"), [1e4 * PI, 200.0 * PI]);
    // Two radii: the corners make an ellipse of 60 and 30 mm.
    let (area, _) = svg("<rect width='200' height='300' rx='60' ry='30'/>");
    assert!((area - (60_000.0 - (4.0 - PI) * 1800.0)).abs() < 60.0, "{area}");
    // A radius that SVG does not take, `auto` or negative, is as the other.
    close(svg("<rect width='200' height='300' rx='auto' ry='25'/>"), rounded(25.0));
    close(svg("<rect width='200' height='300' rx='40' ry='-1'/>"), rounded(40.0));
    // Sharp without a radius, and with one that is nought.
    close(svg("<rect width='200' height='300' rx='0' ry='30'/>"), [60_000.0, 1000.0]);
    // In a drawing whose unit is a millimetre, 96 units to the inch are 200 and 300 mm.
    close(svg("<rect width='52.916667mm' height='79.375mm'/>"), [60_000.0, 1000.0]);
}

/// The file's numbers are rounded: the one edge of this circle ends 4 millionths of a millimetre from where it starts.
#[test]
fn circles_and_ellipses_are_pieces_of_one_edge() {
    let made = from_svg(
        "<svg xmlns='http://www.w3.org/2000/svg' width='900mm' height='900mm' viewBox='0 0 900 900'>\
         <circle id='disc' cx='300.123' cy='300.777' r='200.3337'/><ellipse id='oval' cx='700' cy='200' rx='120.5' \
         ry='80.25'/><ellipse id='round' cx='700' cy='500' rx='50'/><circle id='none' cx='700' cy='700' r='0'/></svg>",
    );
    // Circumference by chords: shares nothing with the library's.
    let around = |[rx, ry]: [f64; 2]| {
        let at = |i: usize| (2.0 * PI * i as f64 / 20_000.0).sin_cos();
        (0..20_000).map(|i| (at(i), at(i + 1))).map(|(a, b)| ((b.0 - a.0) * ry).hypot((b.1 - a.1) * rx)).sum::<f64>()
    };
    let pieces = drawn(&made);
    assert_eq!(pieces.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["disc", "oval", "round"]);
    for (piece, radii) in pieces.iter().zip([[200.3337; 2], [120.5, 80.25], [50.0; 2]]) {
        let [(_, length)] = lengths(piece)[..] else { panic!("one edge: {:?}", lengths(piece)) };
        assert!((length - around(radii)).abs() < 0.01, "{}: {length}", piece.name);
        let area = piece.rings[0][0].path.double_area() * 0.5e6;
        assert!((area - PI * radii[0] * radii[1]).abs() < 0.1, "{}: {area}", piece.name);
    }
}

/// The cut line passes a dart's mouth: its legs have no allowance, however far the line is from them.
#[test]
fn legs_of_a_dart_have_no_allowance() {
    let text = SAMPLE
        .replace("  back:\n", "  back:\n    darts: [{name: bust, edge: side, at: 200, intake: 20, length: 70}]\n");
    let loaded = read_text("sample", "sample.yaml", &text).expect("a garment");
    let papers =
        papers(&drawings(&loaded.file, &loaded.garment), &CuttingOptions { whole: true, ..CuttingOptions::default() });
    let sheet = Sheet::new(&papers, &Layout { width: None, margin: 0.010, square: true });
    let made = from_svg(&cutting_svg("Sample", &sheet));
    let back = drawn(&made).into_iter().find(|p| p.name == "back").expect("the back");
    let width = |edge: &str| back.rings[0].iter().find(|e| e.name == edge).expect("an edge").allowance.width;
    assert_eq!(width("shoulder"), Some(0.010));
    assert!(
        back.rings[0].iter().filter_map(|e| e.allowance.width).all(|w| w < 0.011),
        "{:?}",
        made.file.pieces[1].allowance
    );
}

/// In Inkscape a layer is a sheet, and what is drawn on it has a label of its own.
#[test]
fn labels_of_paths_on_a_layer_are_names_of_pieces() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
                width='400mm' height='400mm' viewBox='0 0 400 400'>\
                <g inkscape:groupmode='layer' inkscape:label='Layer 1'>\
                <path inkscape:label='left front' d='M 0 0 L 100 0 L 0 200 Z'/>\
                <path inkscape:label='right front' d='M 300 0 L 200 0 L 300 200 Z'/>\
                <path inkscape:label='yoke' d='M 0 220 H 100 V 300 H 0 Z'/></g></svg>";
    let cuts: Vec<(String, CutKind)> = drawn(&from_svg(text)).into_iter().map(|p| (p.name, p.cut)).collect();
    assert_eq!(cuts, [("front".to_owned(), CutKind::Pair), ("yoke".to_owned(), CutKind::One)]);
}

#[test]
fn css_hides_and_moves_what_it_means() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='1200Q' height='30cm' viewBox='0 0 300 300'>\
        <style>/* .b { */ .a, rect.twice { fill: none; display: none } .a { fill: red } #shown { display: inline }\
        .twice{transform:scale(2)}</style>\
        <rect class='a' width='90' height='90'/><rect id='shown' class='a' x='100' width='40' height='50'/>\
        <g style='transform: translate(10px, 20px) rotate(90deg)'><rect class='b' width='60' height='70'/></g>\
        <path class='twice' d='M 50 100 h 40 v 40 h -40 Z'/></svg>";
    let drawing = read_svg_text(text).expect("pieces");
    let area = |p: &Traced| p.sew.iter().map(|e| e.1.double_area()).sum::<f64>().abs() * 0.5e6;
    let areas: Vec<f64> = drawing.pieces.iter().map(|p| area(p).round()).collect();
    assert_eq!(areas, [2000.0, 4200.0, 6400.0]);
    let corner = drawing.pieces[1].sew[0].1.point(0.060);
    assert!((corner - Vec2::new(0.010, 0.080)).norm() < EXACT, "turned about the origin, then moved: {corner}");
}

/// Of nothing but lines on a layer, as they are drawn one by one.
fn layer_of_lines(lines: &[(&str, &str)]) -> String {
    let paths: String =
        lines.iter().map(|(name, d)| format!("<path id='path1' inkscape:label='{name}' d='{d}'/>")).collect();
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
         width='900mm' height='900mm' viewBox='0 0 900 900'><g inkscape:groupmode='layer' inkscape:label='back'>\
         <rect x='500' width='100' height='200'/></g><g inkscape:groupmode='layer' inkscape:label='front'>{paths}</g>\
         </svg>"
    )
}

#[test]
fn open_lines_of_a_layer_that_meet_end_to_end_are_an_outline_of_named_edges() {
    // Two of them run against the others; a line from a corner is none of the edges, nor are lines within.
    let four = [
        ("waist", "M 100 100 H 200"),
        ("tuck", "M 200 100 L 180 160"),
        ("hem", "M 200 400 H 50"),
        ("side", "M 200 400 V 100"),
        ("center", "M 50 400 L 100 100"),
    ];
    let within = [("slit", "M 120 150 H 140"), ("slit", "M 140 150 L 130 160"), ("slit", "M 130 160 L 120 150")];
    let pieces = drawn(&from_svg(&layer_of_lines(&[&four[..], &within[..]].concat())));
    let front = pieces.iter().find(|p| p.name == "front").expect("the front");
    let edges: Vec<(String, f64)> = lengths(front).into_iter().map(|(name, mm)| (name, mm.round())).collect();
    let wanted = [("waist", 100.0), ("side", 300.0), ("hem", 150.0), ("center", 304.0)];
    assert_eq!(edges, wanted.map(|(name, mm)| (name.to_owned(), mm)));
    assert!(pieces.len() == 2 && front.lines.len() == 4 && front.rings.len() == 1, "{:?}", front.lines);
}

#[test]
fn an_edge_without_length_to_speak_of_is_none() {
    let lines = [
        ("waist", "M 100 100 H 200"),
        ("slip", "M 200 100 V 100.015"),
        ("side", "M 200 100.015 V 400"),
        ("hem", "M 200 400 L 100 100"),
    ];
    let made = from_svg(&layer_of_lines(&lines));
    let pieces = drawn(&made);
    let front = pieces.iter().find(|p| p.name == "front").expect("the front");
    let names: Vec<String> = lengths(front).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["waist", "side", "hem"]);
    build(&loaded(&made).garment, 0.020).expect("every edge is long enough");
}

#[test]
fn open_lines_that_make_no_outline_are_said() {
    let lines = [("waist", "M 100 100 H 200"), ("side", "M 240 300 L 200 400"), ("hem", "M 200 400 L 100 100")];
    let drawing = read_svg_text(&layer_of_lines(&lines)).expect("the back");
    let [said] = &drawing.left_out[..] else { panic!("{:?}", drawing.left_out) };
    for words in ["3 open lines of 'front'", "'waist', 'side', 'hem'", "203.96 mm apart", "meet end to end"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert_eq!(drawing.pieces.len(), 1);
}

#[test]
fn what_is_written_on_a_piece_says_how_it_is_cut() {
    let cut = |words: &str| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='900mm' height='900mm' viewBox='0 0 900 900'>\
             <rect x='100' width='100' height='200'/><g transform='translate(100, 0)'>\
             <text><tspan x='50' y='90'>{words}</tspan></text></g><text x='300' y='90'>cut 7</text></svg>"
        );
        drawn(&from_svg(&text)).remove(0).cut
    };
    for pair in ["Cut 1 pair", "Sleeve – cut 2 (left and right), shell", "CUT 2 MIRRORED"] {
        assert_eq!(cut(pair), CutKind::Pair, "{pair}");
    }
    assert_eq!(cut("cut: 4, lining"), CutKind::Count(4));
    for once in ["cut 1", "cut here", "undercut", "cut 1 on the fold", "cut 99999999999999999999"] {
        assert_eq!(cut(once), CutKind::One, "{once}");
    }
}

/// That a piece is cut on the fold may be written on it alone.
#[test]
fn what_is_written_on_a_piece_says_that_it_lies_on_the_fold() {
    let made = |words: &str, more: &str| {
        from_svg(&format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='900mm' height='900mm' viewBox='0 0 900 900'>\
             <path id='front' d='M 100 0 H 200 L 250 300 H 100 Z'/><text x='150' y='90'>{words}</text>{more}</svg>"
        ))
    };
    let grain = "<path class='grain' d='M 150 50 V 250'/>";
    for words in ["cut 1 on fold", "Front – CUT 1 ON THE FOLD", "cut 2 on fold"] {
        let drawing = made(words, grain);
        assert_eq!(drawn(&drawing)[0].cut, CutKind::Fold("d".to_owned()), "{words}");
        let [said] = &drawing.notes[..] else { panic!("{:?}", drawing.notes) };
        assert!(said.contains("edge 'd' is taken for that"), "{said}");
        assert_eq!(said.contains("cut 2 times"), words.contains('2'), "{said}");
        assert!(drawing.suggestions.iter().all(|s| s.sew.iter().chain(&s.to).all(|e| e != "front.d")));
    }
    // Without the grain the corners tell: the whole piece has none at the fold.
    assert_eq!(drawn(&made("cut 1 on fold", ""))[0].cut, CutKind::Fold("d".to_owned()));
    // Four straight edges, and nothing that tells one from the other.
    let unknown = from_svg(
        "<svg xmlns='http://www.w3.org/2000/svg' width='400mm' height='400mm' viewBox='0 0 400 400'>\
         <path id='front' d='M 100 0 H 200 V 300 H 100 Z'/><text x='150' y='90'>cut 1 on fold</text></svg>",
    );
    assert_eq!(drawn(&unknown)[0].cut, CutKind::One);
    assert!(unknown.notes[0].contains("say at which edge, 'cut: fold EDGE'"), "{:?}", unknown.notes);
    // A line that is drawn says it better.
    let drawn_line = made("cut 1 on fold", "<path class='fold' d='M 100 0 L 100 300'/>");
    assert!(drawn_line.notes.is_empty() && drawn(&drawn_line)[0].fold.is_some(), "{:?}", drawn_line.notes);
}

#[test]
fn what_a_drawing_shows_besides_is_said() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='400mm' height='400mm' viewBox='0 0 400 400'>\n\
                <rect id='yoke' width='100' height='100'/>\n<image href='photo.png'/>\n<use href='#yoke' x='150'/>\n\
                <g><text x='9' y='9'>front</text>\n<use href='#yoke' x='250'/></g>\n\
                <rect width='auto' height='10%'/>\n<g style='display: none'><path d='M 0 0 L 9 9'/></g>\n\
                <a><rect id='linked' y='200' width='100' height='100'/></a></svg>";
    let drawing = read_svg_text(text).expect("pieces");
    let names: Vec<&str> = drawing.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["yoke", "linked"], "what is in a link is drawn");
    let said = drawing.left_out.join("\n");
    for words in [
        "1 image in line 3",
        "2 clones",
        "first in line 4",
        "1 text in line 5",
        "1 shape without a size in line 7",
        "1 hidden",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let (_, papers) = sample();
    let own = cutting_svg("Sample", &Sheet::new(&papers, &Layout { width: None, margin: 0.010, square: true }));
    assert_eq!(read_svg_text(&own).expect("pieces").left_out, Vec::<String>::new());
    let nothing = text.replace("<rect", "<use");
    assert!(read_svg_text(&nothing).expect_err("no piece").to_string().contains("clones"));
}

#[test]
fn of_a_switch_one_alternative_is_read() {
    let read = |inner: &str| {
        let open = "<svg xmlns='http://www.w3.org/2000/svg' width='400mm' height='400mm' viewBox='0 0 400 400'>";
        let drawing = read_svg_text(&format!("{open}<switch>{inner}</switch></svg>")).expect("pieces");
        (drawing.pieces.into_iter().map(|p| p.name).collect::<Vec<_>>(), drawing.left_out)
    };
    let nothing = Vec::<String>::new();
    let piece = |name: &str, more: &str| format!("<g {more}><rect id='{name}' width='100' height='100'/></g>");
    let (german, other) = (piece("passe", "systemLanguage='de'"), piece("yoke", ""));
    assert_eq!(read(&format!("<title>a</title>{german}{other}")), (vec!["yoke".to_owned()], nothing.clone()));
    assert_eq!(read(&german), (vec!["passe".to_owned()], nothing.clone()));
    // As Illustrator writes it.
    let foreign = "<foreignObject requiredExtensions='http://ns.adobe.com/AdobeIllustrator/10.0/'/>";
    assert_eq!(read(&format!("{foreign}{other}")), (vec!["yoke".to_owned()], nothing));
}

/// A drawing within a drawing: the grain of a piece in the outer one, placed by the inner one's own box and units.
#[test]
fn drawings_within_a_drawing_lie_where_they_are_put() {
    let arrow = |place: &str| -> [[f64; 2]; 2] {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='400mm' height='400mm' viewBox='0 0 400 400'>\
             <g id='yoke'><rect width='400' height='400'/>\
             <svg {place}><path class='grain' d='M 10 10 L 10 60'/></svg></g></svg>"
        );
        let grain = read_svg_text(&text).expect("a piece").pieces[0].grain.expect("a grain");
        grain.map(|p| [p.x, p.y].map(|x| (x * 1e5).round() / 1e2))
    };
    assert_eq!(arrow(""), [[10.0, 10.0], [10.0, 60.0]]);
    assert_eq!(arrow("x='100' y='50'"), [[110.0, 60.0], [110.0, 110.0]]);
    assert_eq!(arrow("x='25%' y='50%'"), [[110.0, 210.0], [110.0, 260.0]]);
    let doubled = "x='100' y='50' width='200' height='200' viewBox='0 0 100 100'";
    assert_eq!(arrow(doubled), [[120.0, 70.0], [120.0, 170.0]]);
    // Without a size it is as large as what it stands in; its own corner need not be 0.
    assert_eq!(arrow("viewBox='5 5 200 200'"), [[10.0, 10.0], [10.0, 110.0]]);
    // In the middle of a box that is wider than it, at its right, stretched to it, filling it.
    let wide =
        |said: &str| arrow(&format!("width='300' height='100' viewBox='0 0 100 100' preserveAspectRatio='{said}'"));
    assert_eq!(arrow("width='300' height='100' viewBox='0 0 100 100'"), [[110.0, 10.0], [110.0, 60.0]]);
    assert_eq!(wide("xMidYMid meet"), [[110.0, 10.0], [110.0, 60.0]]);
    assert_eq!(wide("xMaxYMin"), [[210.0, 10.0], [210.0, 60.0]]);
    assert_eq!(wide("none"), [[30.0, 10.0], [30.0, 60.0]]);
    assert_eq!(wide("xMinYMin slice"), [[30.0, 30.0], [30.0, 180.0]]);
    // One in another.
    let twice = "x='100'><svg x='50' viewBox='0 0 200 200' width='400' height='400'>\
                 <path class='grain' d='M 10 10 L 10 60'/></svg></svg><svg class='note'";
    assert_eq!(arrow(twice), [[170.0, 20.0], [170.0, 120.0]]);
}

#[test]
fn what_is_read_or_draws_nothing_is_not_left_out() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='400mm' height='400mm' viewBox='0 0 400 400'>\n\
                <defs style='display:none'><path d='M 0 0 L 9 9'/></defs><g display='none'><title>a</title></g>\n\
                <rect id='yoke' width='100' height='100'/><text x='40' y='60'>cut 2</text>{}</svg>";
    let left_out = |more: &str| read_svg_text(&text.replace("{}", more)).expect("pieces").left_out;
    assert_eq!(left_out(""), Vec::<String>::new());
    // Beside the piece, or where another has said it.
    let said = left_out("\n<text x='200' y='60'>cut 2</text><text x='40' y='80'>cut 4</text>");
    assert!(said.len() == 1 && said[0].contains("2 texts, the first in line 4"), "{said:?}");
}

#[test]
fn an_exported_dxf_is_read_back() {
    let (drawings, papers) = sample();
    let made = garment_file("sample", &read_dxf_text(&cutting_dxf("Sample", &papers), None).expect("pieces").pieces);
    same_outlines(&made, &drawings);
    let pair = drawn(&made).into_iter().find(|p| p.name == "back").expect("the back");
    assert_eq!(pair.cut, CutKind::Pair);
    // Curves are curves again, not the hundreds of points that the format makes of them.
    let segments: usize = drawn(&made).iter().flat_map(|p| &p.rings[0]).map(|e| e.path.joints().len() - 1).sum();
    assert!(segments < 40, "{segments}");
}

/// A piece with a bay, or else an acute corner, narrow darts and pleats and a curve, `wide` allowances and notches.
fn notched(waist: &str, wide: f64, more: &str) -> String {
    format!(
        "garment: 1\nallowance: {wide}\npieces:\n  p:\n    grain: [[100, 150], [100, 250]]\n    \
         outline: {{start: 0 0, waist: {waist}, side: C 160 100 240 200 200 300, hem: L 0 300, center: L 0 0}}\n    \
         {more}\nfree: ['*.*']\n"
    )
}

/// The first piece of a garment as it is read back from its SVG and its DXF.
fn read_back(text: &str) -> [PieceFile; 2] {
    let loaded = read_text("sample", "sample.yaml", text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let papers = papers(&drawings(&loaded.file, &loaded.garment), &CuttingOptions::default());
    let sheet = Sheet::new(&papers, &Layout { width: None, margin: 0.010, square: true });
    let svg = from_svg(&cutting_svg("Sample", &sheet));
    let dxf = garment_file("sample", &read_dxf_text(&cutting_dxf("Sample", &papers), None).expect("pieces").pieces);
    [svg, dxf].map(|made| {
        // What is made of it is a garment again.
        drawn(&made);
        made.file.pieces[0].clone()
    })
}

/// Edge, place (mm) and whether it is double of each notch of a file.
fn notches_of(piece: &PieceFile) -> Vec<(String, f64, bool)> {
    let edge = |(name, list): &(Located<String>, Vec<Located<NotchFile>>)| {
        let name = name.value.clone();
        list.iter().map(|n| (name.clone(), n.value.at.number, n.value.double)).collect::<Vec<_>>()
    };
    let mut notches: Vec<_> = piece.notches.iter().flat_map(edge).collect();
    notches.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    notches
}

/// Notches side by side, at corners, in a bay and on a curve are those they were, however wide the allowance.
#[test]
fn notches_of_an_export_come_back_where_they_were() {
    let (straight, bay) = ("L 200 0", "L 100 60 L 200 0");
    for (waist, wide, notches) in [
        (straight, 10.0, "{waist: [60 double, 72 double]}"),
        (straight, 10.0, "{waist: [60, 70], center: [0, 299]}"),
        (straight, 30.0, "{waist: [2], center: [297]}"),
        (straight, 40.0, "{side: [40 double, 154.12, 165, 300]}"),
        (straight, 60.0, "{side: [100], hem: [50 double]}"),
        (bay, 15.0, "{waist: [100, 114.5, 117 double, 130]}"),
        // One mark of each of these stands at the end of its edge; without allowance it lies beyond the next edge.
        (bay, 0.0, "{waist: [1 double, 230 double], side: [0.92 double], hem: [0, 3 double]}"),
        (bay, 5.0, "{waist: [4.5 double], hem: [198.5 double], center: [300]}"),
    ] {
        let text = notched(waist, wide, &format!("notches: {notches}"));
        let wanted = notches_of(&read_text("sample", "sample.yaml", &text).expect("a garment").file.pieces[0]);
        for piece in read_back(&text) {
            let found = notches_of(&piece);
            let is_same = |(a, b): (&(String, f64, bool), &(String, f64, bool))| {
                a.0 == b.0 && (a.1 - b.1).abs() < EXACT * 1e3 && a.2 == b.2
            };
            assert!(found.len() == wanted.len() && found.iter().zip(&wanted).all(is_same), "{wanted:?}: {found:?}");
        }
    }
}

/// The mouth of a dart or a pleat is no double notch, and no notch at all beside those that are.
#[test]
fn narrow_darts_and_pleats_of_an_export_come_back() {
    for intake in [3.0, 10.0, 14.0] {
        let beside = 100.0 + intake / 2.0 + 3.0;
        let dart = format!("darts: [{{edge: waist, at: 100, intake: {intake}, length: 90}}]");
        for piece in read_back(&notched("L 200 0", 10.0, &format!("{dart}\n    notches: {{waist: [{beside}]}}"))) {
            assert_eq!(piece.darts.len(), 1, "{intake}");
            assert!((piece.darts[0].intake.value.number - intake).abs() < EXACT * 1e3, "{:?}", piece.darts[0]);
            let notches = notches_of(&piece);
            assert!(notches.len() == 1 && (notches[0].1 - beside).abs() < EXACT * 1e3 && !notches[0].2, "{notches:?}");
        }
    }
    for piece in read_back(&notched("L 200 0", 10.0, "pleats: [{edge: waist, at: [60], depth: 5}]")) {
        assert_eq!((piece.pleats.len(), piece.notches.len()), (1, 0));
        assert!((piece.pleats[0].depth.value.number - 5.0).abs() < EXACT * 1e3, "{:?}", piece.pleats[0]);
    }
}

/// A double notch beside the fold has a mark on it: in a piece that is drawn whole it is two, as far from the fold.
#[test]
fn double_notches_beside_the_fold_of_a_whole_piece_stay_where_they_are() {
    let text = notched("L 200 0", 10.0, "cut: fold center\n    notches: {waist: [3 double]}");
    let loaded = read_text("sample", "sample.yaml", &text).expect("a garment");
    let papers =
        papers(&drawings(&loaded.file, &loaded.garment), &CuttingOptions { whole: true, ..CuttingOptions::default() });
    let sheet = Sheet::new(&papers, &Layout { width: None, margin: 0.010, square: true });
    let svg = from_svg(&cutting_svg("Sample", &sheet));
    let dxf = garment_file("sample", &read_dxf_text(&cutting_dxf("Sample", &papers), None).expect("pieces").pieces);
    for made in [svg, dxf] {
        let mut found = notches_of(&made.file.pieces[0]);
        found.sort_by(|a, b| a.1.total_cmp(&b.1));
        let off = |k: usize, wanted: f64| (found[k].1 - wanted).abs() < EXACT * 1e3 && found[k].2;
        assert!(found.len() == 2 && off(0, 3.0) && off(1, 197.0), "{found:?}");
    }
}

/// An entity of a DXF on a layer.
fn entity(kind: &str, on: u32, pairs: &[(i32, f64)]) -> String {
    let pairs: String = pairs.iter().map(|(code, value)| format!("{code}\n{value}\n")).collect();
    format!("0\n{kind}\n8\n{on}\n{pairs}")
}

/// A point, or a line of several.
fn line(on: u32, points: &[[f64; 2]]) -> String {
    let pairs: Vec<_> = points.iter().flat_map(|p| [(10, p[0]), (20, p[1])]).collect();
    entity(if points.len() == 1 { "POINT" } else { "LWPOLYLINE" }, on, &pairs)
}

/// A line that ends where it begins.
fn ring(on: u32, points: &[[f64; 2]]) -> String {
    line(on, points) + "70\n1\n"
}

/// The notches, from left to right, and the drill holes of a piece of 300 × 400 mm, which its block has besides.
fn marks_of(entities: &[String]) -> [Vec<[f64; 2]>; 2] {
    let boundary = ring(1, &[[0.0, 0.0], [300.0, 0.0], [300.0, 400.0], [0.0, 400.0]]);
    let text = block(&[boundary, entities.concat()]);
    let pieces = read_dxf_text(&text, Some(1e-3)).expect("a piece").pieces;
    let notches: Vec<Vec2> = pieces[0].notches.iter().map(|notch| notch.at).collect();
    [&notches, &pieces[0].points].map(|points| {
        let mut shown: Vec<_> = points.iter().map(|p| [p.x * 1e3, -p.y * 1e3].map(f64::round)).collect();
        shown.sort_by(|a, b| a[0].total_cmp(&b[0]));
        shown
    })
}

/// Programs draw notches as points, as slits or with both flanks, and drill holes as points or circles.
#[test]
fn notches_and_drill_holes_of_a_dxf_may_be_drawn() {
    let [notches, holes] = marks_of(&[
        line(4, &[[150.0, 0.0]]),
        entity("LINE", 4, &[(10, 295.0), (20, 200.0), (11, 300.0), (21, 200.0)]),
        line(4, &[[0.0, 98.0], [6.0, 100.0], [0.0, 102.0]]),
        entity("CIRCLE", 13, &[(10, 150.0), (20, 250.0), (40, 3.0)]),
    ]);
    assert_eq!(notches, [[0.0, 100.0], [150.0, 0.0], [300.0, 200.0]]);
    assert_eq!(holes, [[150.0, 250.0]]);
}

/// A curve fitted to a polyline stands in the file beside what controls it, and what was mirrored in its plane is
/// written as seen from below.
#[test]
fn fitted_and_mirrored_polylines_of_a_dxf_are_read_as_they_are_drawn() {
    let vertex = |x: f64, y: f64, flags: f64| entity("VERTEX", 1, &[(10, x), (20, y), (70, flags)]);
    let fitted = entity("POLYLINE", 1, &[(66, 1.0), (70, 5.0)])
        + &vertex(0.0, 0.0, 8.0)
        + &vertex(500.0, 900.0, 16.0)
        + &vertex(300.0, 0.0, 8.0)
        + &vertex(300.0, 400.0, 8.0)
        + &vertex(0.0, 400.0, 8.0)
        + "0\nSEQEND\n";
    let area = |boundary: String, more: &str| {
        let pieces = read_dxf_text(&block(&[boundary, more.to_owned()]), Some(1e-3)).expect("a piece").pieces;
        let outline = pieces[0].cut.as_ref().expect("an outline");
        ((outline.double_area().abs() * 0.5e6).round(), pieces[0].points.clone())
    };
    assert_eq!(area(fitted, "").0, 120_000.0);
    // A half circle on the left of a square, and a hole in it, all mirrored to the right.
    let bulged = |code: i32, value: f64| {
        let pairs =
            [(70, 1.0), (230, -1.0), (10, 0.0), (20, 0.0), (10, -200.0), (20, 0.0), (code, value), (10, -200.0)];
        entity("LWPOLYLINE", 1, &[&pairs[..], &[(20, 200.0), (10, 0.0), (20, 200.0)]].concat())
    };
    let hole = entity("CIRCLE", 13, &[(10, -150.0), (20, 50.0), (40, 3.0), (230, -1.0)]);
    let (outside, points) = area(bulged(42, -1.0), &hole);
    let half = 0.5 * PI * 1e4;
    assert_eq!(outside, (4e4 + half).round());
    assert!((points[0] - Vec2::new(0.15, -0.05)).norm() < 1e-9, "{}", points[0]);
}

/// Where a patch is tacked down its holes are on its edges and at its corners: each is a mark there, on the cloth.
#[test]
fn a_drill_hole_on_the_rim_of_a_piece_is_a_mark_on_it() {
    let wedge = ring(1, &[[0.0, 0.0], [300.0, 0.0], [0.0, 30.0]]);
    let at = [[150.0, 0.0], [0.0, 15.0], [150.0, 15.0], [0.0, 0.0], [300.0, 0.0], [0.0, 30.0], [150.0, -0.3]];
    let text = block(&[wedge, at.map(|p| line(13, &[p])).concat()]);
    let made = garment_file("patch", &read_dxf_text(&text, Some(1e-3)).expect("a piece").pieces);
    let marks = loaded(&made).garment.pieces[0].lines.clone();
    let middles = marks.iter().map(|m| m.path.point(m.path.length() / 2.0)).collect::<Vec<Vec2>>();
    for (found, [x, y]) in middles.iter().zip(at) {
        let off = (found - middles[3] - Vec2::new(x, -y) * 1e-3).norm();
        assert!(off < EXACT, "{found} is not ({x}, {y})");
    }
    assert_eq!(middles.len(), at.len());
}

/// A shape is one notch, of however many lines it is, where it meets the cut line, or as near to it as it comes.
#[test]
fn a_drawn_notch_of_a_dxf_is_no_double_one() {
    let notches = |entities: &[String]| marks_of(entities)[0].clone();
    // A T whose bar is 6 mm within; on the sewing line 10 mm within, as allowances are; two as a double one.
    let t = |x: f64, off: f64| {
        [line(80, &[[x, off], [x, off + 6.0]]), line(80, &[[x - 3.0, off + 6.0], [x + 3.0, off + 6.0]])]
    };
    assert_eq!(notches(&t(80.0, 0.0)), [[80.0, 0.0]]);
    assert_eq!(notches(&t(80.0, 10.0)), [[80.0, 10.0]]);
    assert_eq!(notches(&[t(80.0, 0.0), t(88.0, 0.0)].concat()), [[80.0, 0.0], [88.0, 0.0]]);
    // A closed one, wherever it begins, and a U.
    let mut wedge = [[80.0, 6.0], [82.0, 0.0], [78.0, 0.0]];
    for _ in 0..wedge.len() {
        wedge.rotate_left(1);
        assert_eq!(notches(&[ring(4, &wedge)]), [[80.0, 0.0]], "{wedge:?}");
    }
    assert_eq!(notches(&[line(83, &[[78.0, 0.0], [78.0, 6.0], [82.0, 6.0], [82.0, 0.0]])]), [[80.0, 0.0]]);
    // Its point says more exactly where it is; another layer's is another notch.
    let slit = line(4, &[[80.0, 0.0], [80.0, 6.0]]);
    assert_eq!(notches(&[slit.clone(), line(4, &[[81.0, 0.0]])]), [[81.0, 0.0]]);
    assert_eq!(notches(&[slit, line(80, &[[81.0, 0.0]])]), [[80.0, 0.0], [81.0, 0.0]]);
}

#[test]
fn a_drawing_that_is_stretched_is_read_stretched() {
    let sides = |said: &str| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='1000mm' height='1000mm' viewBox='0 0 1000 500' {said}>\
             <rect id='yoke' width='300' height='300'/></svg>"
        );
        let piece = read_svg_text(&text).expect("a piece").pieces.remove(0);
        let points = piece.cut.iter().chain(piece.sew.iter().map(|s| &s.1)).flat_map(|path| path.sampled(1e-4));
        points.fold([0.0, 0.0], |[x, y], p| [p.x.max(x), p.y.max(y)]).map(|m| (m * 1e3).round())
    };
    assert_eq!(sides(""), [300.0, 300.0]);
    assert_eq!(sides("preserveAspectRatio='none'"), [300.0, 600.0]);
    assert_eq!(sides("preserveAspectRatio='xMinYMin slice'"), [600.0, 600.0]);
}

#[test]
fn seams_are_suggested_without_names_of_edges() {
    let (_, papers) = sample();
    assert!(papers.iter().all(|p| p.sew.iter().any(|s| s.of == SewKind::Outline)));
    // As other programs write it, without the names of edges.
    let dxf = cutting_dxf("Sample", &papers).replace("Edge: ", "Remark: ");
    let made = garment_file("sample", &read_dxf_text(&dxf, None).expect("pieces").pieces);
    // The sides have notches, which match. With the shoulders as well the corner between them would be no opening.
    let [found] = &made.suggestions[..] else { panic!("{:?}", made.suggestions) };
    let sides = papers.iter().flat_map(|paper| &paper.sew).filter(|line| line.name == "side");
    let length = sides.map(|line| line.path.length()).next().expect("a side");
    assert!(found.lengths.iter().all(|own| (own - length).abs() < 1e-4), "{found:?}, {length}");
    assert!(found.reasons.iter().any(|reason| reason == "notches match"), "{found:?}");
}

#[test]
fn inches_are_told_by_the_style_and_millimetres_are_meant_otherwise() {
    let (_, papers) = sample();
    let metric = cutting_dxf("Sample", &papers);
    let area = |text: &str, unit: Option<f64>| {
        let pieces = read_dxf_text(text, unit).expect("pieces").pieces;
        pieces[0].cut.as_ref().expect("a cut line").double_area().abs()
    };
    let inches = metric.replace("Units: METRIC", "Units: ENGLISH");
    assert!((area(&inches, None) / area(&metric, None) - 25.4 * 25.4).abs() < 1e-6);
    assert!((area(&inches, Some(1e-3)) / area(&metric, None) - 1.0).abs() < 1e-9, "what is said aloud counts");
    let notes = |text: &str, unit: Option<f64>| read_dxf_text(text, unit).expect("pieces").notes;
    assert!(notes(&metric, None).is_empty());
    let unsaid = metric.replace("Units: METRIC", "Units:");
    let header = |variable: &str| format!("0\nSECTION\n2\nHEADER\n9\n{variable}\n0\nENDSEC\n{unsaid}");
    let english = header("$MEASUREMENT\n70\n0");
    for (text, ratio, said) in [(&unsaid, 1.0, "millimetres;"), (&english, 25.4 * 25.4, "inches, by its $MEASUREMENT;")]
    {
        assert!((area(text, None) / area(&metric, None) - ratio).abs() < 1e-6);
        let [note] = &notes(text, None)[..] else { panic!("one note") };
        assert!(note.contains(said) && note.contains("--units"), "{note}");
        assert!(notes(text, Some(1e-3)).is_empty());
    }
    let both = header("$INSUNITS\n70\n5\n9\n$MEASUREMENT\n70\n0");
    assert!((area(&both, None) / area(&metric, None) - 100.0).abs() < 1e-6 && notes(&both, None).is_empty());
}

/// A block of these entities as a DXF file in millimetres.
fn block(entities: &[String]) -> String {
    format!("0\nBLOCK\n2\nFRONT\n{}0\nENDBLK\n", entities.concat())
}

/// A square of 100 mm whose right side bulges out or in as a half circle, as polylines of both kinds and as lines and
/// an arc.
#[test]
fn arcs_of_a_dxf_are_read_as_arcs() {
    let corners = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]];
    let bulging =
        |k: usize, bulge: f64| [(10, corners[k][0]), (20, corners[k][1]), (42, if k == 1 { bulge } else { 0.0 })];
    let light = |bulge: f64| {
        let pairs: Vec<_> = (0..4).flat_map(|k| bulging(k, bulge)).collect();
        vec![entity("LWPOLYLINE", 1, &pairs) + "70\n1\n"]
    };
    let heavy = |bulge: f64| {
        let mut all = vec![entity("POLYLINE", 1, &[]) + "70\n1\n"];
        all.extend((0..4).map(|k| entity("VERTEX", 1, &bulging(k, bulge))));
        all.push(entity("SEQEND", 1, &[]));
        all
    };
    let lines = |[from, to]: [f64; 2]| {
        let arc = entity("ARC", 1, &[(10, 100.0), (20, 50.0), (40, 50.0), (50, from), (51, to)]);
        vec![line(1, &[corners[2], corners[3], corners[0], corners[1]]), arc]
    };
    let half_circle = 0.5 * PI * 0.05 * 0.05;
    for (entities, more) in [
        (light(1.0), half_circle),
        (light(-1.0), -half_circle),
        (heavy(1.0), half_circle),
        (lines([270.0, 90.0]), half_circle),
        (lines([90.0, 270.0]), -half_circle),
    ] {
        let drawing = read_dxf_text(&block(&entities), Some(1e-3)).expect("a piece");
        let area = 0.5 * drawing.pieces[0].cut.as_ref().expect("a cut line").double_area().abs();
        assert!((area - (0.01 + more)).abs() < 1e-9, "{area} of {entities:?}");
        assert!(drawing.left_out.is_empty(), "{:?}", drawing.left_out);
    }
}

#[test]
fn entities_of_a_dxf_that_nobody_reads_are_said_to_be_left_out() {
    let spline = entity("SPLINE", 8, &[(10, 10.0), (20, 10.0)]);
    let boundary = ring(1, &[[0.0, 0.0], [300.0, 0.0], [300.0, 400.0], [0.0, 400.0]]);
    let circle = |on: u32| entity("CIRCLE", on, &[(10, 90.0), (20, 90.0), (40, 9.0)]);
    let others = [entity("INSERT", 1, &[]), entity("ELLIPSE", 99, &[]), circle(11), circle(13)];
    let all = [boundary, spline.clone(), spline, others.concat()];
    let left_out = read_dxf_text(&block(&all), Some(1e-3)).expect("a piece").left_out;
    assert_eq!(left_out.len(), 2, "{left_out:?}");
    assert!(left_out[0].contains("2 SPLINE") && left_out[0].contains("line 28; export"), "{left_out:?}");
    assert!(left_out[1].contains("1 INSERT"), "{left_out:?}");
    let refused = read_dxf_text(&block(&[entity("ELLIPSE", 1, &[])]), None).expect_err("no outline").to_string();
    assert!(refused.contains("1 ELLIPSE on the layers of a pattern, in line 6"), "{refused}");
}

/// What follows it would be taken for its vertices, and be lost.
#[test]
fn a_polyline_of_a_dxf_without_its_end_is_refused() {
    let vertex = |x: f64, y: f64| entity("VERTEX", 1, &[(10, x), (20, y)]);
    let begun = [entity("POLYLINE", 1, &[]), vertex(0.0, 0.0), vertex(300.0, 0.0)].concat();
    for rest in ["", "0\nPOINT\n8\n13\n10\n1\n20\n1\n"] {
        let refused = read_dxf_text(&block(&[begun.clone(), rest.to_owned()]), None).expect_err("an error").to_string();
        assert!(refused.starts_with("line 6: ") && refused.contains("SEQEND"), "{refused}");
    }
}

#[test]
fn what_is_no_pattern_is_refused_with_a_reason() {
    let svg = |text: &str| read_svg_text(text).expect_err("no pattern").to_string();
    assert!(svg("hello").contains("not an SVG"));
    assert!(svg("<html/>").contains("'html'"));
    assert!(svg("<svg xmlns='http://www.w3.org/2000/svg'><path d='M 0 0 L 10 10'/></svg>").contains("no closed line"));
    let wrong = "<svg xmlns='http://www.w3.org/2000/svg'>\n<path d='M 0 0 L 10 ten'/></svg>";
    assert!(svg(wrong).contains("line 2: cannot read a path 'M 0 0 L 10 ten'"), "{}", svg(wrong));
    let dxf = |text: &str| read_dxf_text(text, None).expect_err("no pattern").to_string();
    assert!(dxf("AutoCAD Binary DXF").contains("line 1"));
    assert!(dxf("0\nSECTION\n0\nLINE\n8\nwalls\n0\nEOF\n").contains("walls"));
    assert!(dxf("0\nBLOCK\n2\nA\n0\nLINE\n8\n1\n10\nnan\n0\nENDBLK\n").contains("'nan' is not a coordinate"));
}
