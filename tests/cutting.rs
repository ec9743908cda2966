//! Patterns for cutting: cut lines against the definition of an allowance, and every format read back by a reader that
//! shares nothing with its writer.

use proptest::prelude::*;
use toile::cutting::{CuttingOptions, Layout, Lettering, MarkKind, Paper, Room, SewKind, Sheet, papers};
use toile::geometry::{Path, Vec2};
use toile::io::dxf_write::cutting_dxf;
use toile::io::garment::read_text;
use toile::io::pdf_write::{Page, one_page, tiled};
use toile::io::svg_write::cutting_svg;
use toile::pattern::{DrawnPiece, drawings};

/// A hundredth of a millimetre, metres: how exact a pattern is.
const EXACT: f64 = 1e-5;

fn drawn(text: &str) -> Vec<DrawnPiece> {
    let loaded = read_text("garment", "garment.yaml", text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    drawings(&loaded.file, &loaded.garment)
}

/// A garment of one free piece with these lines in it.
fn one_piece(lines: &str) -> String {
    format!("garment: 1\nfree: ['*.*']\npieces:\n  front:\n    grain: [[0, 50], [0, 0]]\n{lines}")
}

fn paper_of(lines: &str) -> Paper {
    papers(&drawn(&one_piece(lines)), &CuttingOptions::default()).remove(0)
}

fn mm(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y) * 1e-3
}

fn has_point(contour: &[Vec2], p: Vec2) -> bool {
    contour.iter().any(|q| (q - p).norm() < EXACT)
}

fn area(contour: &[Vec2]) -> f64 {
    let next = contour.iter().cycle().skip(1);
    contour.iter().zip(next).map(|(a, b)| a.perp(b)).sum::<f64>() / 2.0
}

/// Whether two segments of a closed contour that are not neighbours meet.
fn crosses_itself(contour: &[Vec2]) -> Option<Vec2> {
    let n = contour.len();
    let segment = |i: usize| (contour[i], contour[(i + 1) % n]);
    for i in 0..n {
        for k in i + 2..n {
            if i == 0 && k == n - 1 {
                continue;
            }
            let ((a, b), (c, d)) = (segment(i), segment(k));
            let side = |p: Vec2, q: Vec2, r: Vec2| (q - p).perp(&(r - p));
            let apart = side(a, b, c) * side(a, b, d) > 0.0 || side(c, d, a) * side(c, d, b) > 0.0;
            if !apart && (b - a).perp(&(d - c)).abs() > 0.0 {
                return Some(a);
            }
        }
    }
    None
}

#[test]
fn a_mitre_goes_to_where_the_cut_lines_meet() {
    let square = "    outline: {start: 0 0, top: L 200 0, right: L 200 100, hem: L 0 100, left: L 0 0}\n";
    let paper = paper_of(&format!("    allowance: {{top: 10, right: 20, hem: 30, left: 5}}\n{square}"));
    assert_eq!(paper.cut.len(), 1);
    assert_eq!(paper.cut[0].len(), 4, "{:?}", paper.cut[0]);
    for corner in [mm(-5.0, -10.0), mm(220.0, -10.0), mm(220.0, 130.0), mm(-5.0, 130.0)] {
        assert!(has_point(&paper.cut[0], corner), "{corner}: {:?}", paper.cut[0]);
    }
}

#[test]
fn ends_are_mitred_squared_or_folded_as_the_file_says() {
    // A skirt's side flares by one in two: the hem's end tells the three apart.
    let flared = |kind: &str| {
        paper_of(&format!(
            "    allowance: {{hem: 40 {kind}, waist: 10 mitred, left: 10 mitred, right: 10 mitred}}\n    \
             outline: {{start: 0 0, waist: L 100 0, right: L 150 100, hem: L 0 100, left: L 0 0}}\n"
        ))
    };
    // Where the right cut line meets the hem's sewing line, and its slope.
    let meets = 150.0 + 10.0 * 1.25f64.sqrt();
    let mitred = flared("mitred");
    assert!(has_point(&mitred.cut[0], mm(meets + 20.0, 140.0)), "{:?}", mitred.cut);
    let squared = flared("squared");
    assert!(has_point(&squared.cut[0], mm(meets, 140.0)), "{:?}", squared.cut);
    let folded = flared("folded");
    assert!(has_point(&folded.cut[0], mm(meets - 20.0, 140.0)), "{:?}", folded.cut);
    assert!(has_point(&folded.cut[0], mm(meets, 100.0)), "{:?}", folded.cut);
}

/// A hem that is turned up lies on the piece, also where it is deeper than the edge beside it is long, and where that
/// edge is free and slanted.
#[test]
fn a_folded_hem_lies_on_the_piece_when_it_is_turned_up() {
    let bell = "    allowance: {hem: 40 folded, top: 10, side: 10, flare: 10, flare2: 10, side2: 10}\n    \
                outline: {start: 0 0, \
                top: L 240 0, side: L 240 90, flare: L 270 110, hem: L -30 110, flare2: L 0 90, side2: L 0 0}\n";
    let cuff = "    allowance: {hem: 30 folded, top: 10, front: 10, back: 10}\n    outline: {start: 0 0, \
                top: L 240 0, front: L 270 90, hem: L -30 90, back: L 0 0}\n";
    for (lines, hem, deep) in [(bell, 110.0, 40.0), (cuff, 90.0, 30.0)] {
        let paper = paper_of(lines);
        let contour = &paper.cut[0];
        let lowest = contour.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        assert!((lowest - (hem + deep) * 1e-3).abs() < EXACT, "{lowest}");
        let room = Room { contours: vec![contour.clone()], walls: Vec::new() };
        for p in contour.iter().filter(|p| p.y > hem * 1e-3 + EXACT) {
            let up = Vec2::new(p.x, 2.0 * hem * 1e-3 - p.y);
            let off = contour_off(contour, up);
            assert!(room.holds(up) || off < 2e-4, "{p} turned up is {} mm beside the piece", off * 1e3);
        }
    }
}

/// How far a point is from a closed contour.
fn contour_off(contour: &[Vec2], p: Vec2) -> f64 {
    let next = contour.iter().cycle().skip(1);
    let off = |(a, b): (&Vec2, &Vec2)| {
        let along = b - a;
        let share = ((p - a).dot(&along) / along.norm_squared().max(1e-18)).clamp(0.0, 1.0);
        (a + along * share - p).norm()
    };
    contour.iter().zip(next).map(off).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_sharp_point_is_cut_off_and_a_bay_is_not_overlapped() {
    let paper = paper_of("    allowance: 10\n    outline: {start: 0 0, upper: L 300 30, lower: L 0 60, left: L 0 0}\n");
    let far = paper.cut[0].iter().map(|p| p.x).fold(0.0, f64::max);
    assert!(far > 0.310 && far < 0.3301, "three widths at most past the point: {far}");
    // A slot narrower than two allowances: both cut lines would cross in it.
    let slot = paper_of(
        "    allowance: 10 mitred\n    outline: {start: 0 0, a: L 100 0, b: L 100 80, c: L 112 80, d: L 112 0, \
         e: L 200 0, f: L 200 150, g: L 0 150, h: L 0 0}\n",
    );
    assert_eq!(slot.cut.len(), 1);
    assert!(crosses_itself(&slot.cut[0]).is_none());
    // The slot closes: 220 × 170.
    assert!((area(&slot.cut[0]) - 0.220 * 0.170).abs() < 1e-9, "{}", area(&slot.cut[0]));
}

#[test]
fn the_cap_of_a_dart_lies_on_the_allowance_when_the_dart_is_pressed() {
    let paper = paper_of(
        "    allowance: 15 mitred\n    outline: {start: -100 0, waist: L 100 0, right: L 100 200, hem: L -100 200, \
         left: L -100 0}
    darts: [{edge: waist, at: 50, intake: 20, length: 90}]\n",
    );
    // Pressed to the middle, onto the part of the waist after the dart: the cap over the right half of the intake is
    // the waist's cut line mirrored in the right leg.
    let (tip, mouth) = (mm(-50.0, 90.0), mm(-40.0, 0.0));
    let leg = (mouth - tip).normalize();
    let mirror = |p: Vec2| mouth + 2.0 * leg * leg.dot(&(p - mouth)) - (p - mouth);
    let over: Vec<Vec2> =
        paper.cut[0].iter().copied().filter(|p| p.y < -0.0151 && p.x > -0.0501 && p.x < -0.0380).collect();
    assert!(!over.is_empty(), "{:?}", paper.cut[0]);
    for p in over {
        assert!((mirror(p).y + 0.015).abs() < EXACT, "{p} is folded onto {}", mirror(p));
    }
    // And both halves are alike about the dart's axis.
    let peak = paper.cut[0].iter().min_by(|a, b| a.y.total_cmp(&b.y)).expect("points");
    assert!((peak.x + 0.050).abs() < EXACT, "{peak}");
}

#[test]
fn a_piece_on_the_fold_ends_on_it_and_opens_to_a_whole() {
    let text = one_piece(
        "    cut: fold center\n    allowance: {hem: 30}\n    outline: {start: 0 20, neck: C 40 20 60 0 80 -20, \
         side: L 120 300, hem: L 0 300, center: L 0 20}\n",
    );
    let half = papers(&drawn(&text), &CuttingOptions::default()).remove(0);
    let [from, to] = half.fold.expect("a fold");
    assert!(from.x.abs() < 1e-9 && to.x.abs() < 1e-9);
    assert!((from.y - 0.330).abs() < EXACT && (to.y - 0.010).abs() < EXACT, "{from} {to}");
    let whole = papers(&drawn(&text), &CuttingOptions { whole: true, ..CuttingOptions::default() }).remove(0);
    assert!(whole.fold.is_none());
    assert!((area(&whole.cut[0]) - 2.0 * area(&half.cut[0])).abs() < 1e-9);
    assert!(crosses_itself(&whole.cut[0]).is_none());
}

/// Places of an edge that are looked at.
const PLACES: usize = 200;

/// Where an edge has less than its allowance beside it, though no join of a corner may reach there: a mitre takes at
/// most the wider width of the edge's cut line, and other ends stay within a mitre's limit.
fn short_of_allowance(drawing: &DrawnPiece, paper: &Paper) -> Option<(String, Vec2)> {
    let room = Room { contours: paper.cut.clone(), walls: Vec::new() };
    let edges = &drawing.rings[0];
    let width = |i: usize| edges[i % edges.len()].allowance.width.expect("given");
    let kind = |i: usize| edges[i % edges.len()].allowance.corner;
    let taken = |i: usize| width(i).max(width(i + 1)) * if kind(i) == kind(i + 1) { 1.0 } else { 3.0 };
    edges.iter().enumerate().find_map(|(i, edge)| {
        let beside = |k: usize, d: f64| {
            let s = edge.path.length() * k as f64 / PLACES as f64;
            let t = edge.path.tangent(s);
            edge.path.point(s) + d * Vec2::new(t.y, -t.x)
        };
        let line: Vec<Vec2> = (0..=PLACES).map(|k| beside(k, width(i))).collect();
        let length = |part: &[Vec2]| part.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>();
        let free = |&k: &usize| {
            length(&line[..=k]) > taken(i + edges.len() - 1) + EXACT && length(&line[k..]) > taken(i) + EXACT
        };
        let short = |&k: &usize| width(i) > EXACT && !room.holds(beside(k, width(i) - EXACT));
        (1..PLACES).filter(free).find(short).map(|k| (edge.name.clone(), line[k]))
    })
}

#[test]
fn a_narrow_allowance_takes_nothing_from_a_wide_one_beside_it() {
    // A corner that bends in a little, at 40 beside 8: the narrow cut line prolonged would cut across all of the cap.
    let inwards = "    allowance: {cap: 40 folded, waist: 8 mitred, rest: 8 mitred}
    outline: {start: -191.5868 -100.5895, cap: 'C -143 -115.8, -90.4477 -170.11, -32 -157.7', waist: L 158.8229 -153.9,
      rest: L 217 242 L -191.5868 242 L -191.5868 -100.5895}\n";
    // Corners that bend out by 25 degrees, at 40 beside nothing: too flat for a mitre and no sharp point either.
    let outwards = "    allowance: {side: 0 mitred, hem: 40 mitred, other: 0 mitred, top: 10 mitred}
    outline: {start: 200 0, side: L 180 100, hem: Q 0 180 -180 100, other: L -200 0, top: L 200 0}\n";
    let flat = "    allowance: {left: 0 KIND, hem: 40 mitred, right: 8 KIND, top: 10 mitred}
    outline: {start: 300 0, right: L 100 100, hem: L -100 100, left: L -300 0, top: L 300 0}\n";
    let kinds = ["mitred", "squared", "folded"].map(|kind| flat.replace("KIND", kind));
    for lines in [inwards, outwards].into_iter().chain(kinds.iter().map(String::as_str)) {
        let drawing = drawn(&one_piece(lines)).remove(0);
        let paper = papers(std::slice::from_ref(&drawing), &CuttingOptions::default()).remove(0);
        assert_eq!(short_of_allowance(&drawing, &paper), None, "{lines}");
        assert!(crosses_itself(&paper.cut[0]).is_none(), "{lines}");
    }
}

#[test]
fn a_step_of_the_allowance_is_square_to_the_wide_edge() {
    // The hem turns by 27 degrees into either side.
    let paper = paper_of(
        "    allowance: {right: 0 folded, hem: 40 mitred, left: 0 squared, top: 10 mitred}
    outline: {start: 300 0, right: L 100 100, hem: L -100 100, left: L -300 0, top: L 300 0}\n",
    );
    for p in [mm(100.0, 100.0), mm(100.0, 140.0), mm(-100.0, 140.0), mm(-100.0, 100.0)] {
        assert!(has_point(&paper.cut[0], p), "{p}: {:?}", paper.cut[0]);
    }
}

/// Farthest that a point of one closed line is from another, both ways.
fn lines_apart(one: &[Vec2], other: &[Vec2]) -> f64 {
    let way = |a: &[Vec2], b: &[Vec2]| {
        let line = Path::polyline(&b.iter().chain(&b[..1]).copied().collect::<Vec<_>>());
        a.iter().map(|p| line.nearest(*p).1).fold(0.0, f64::max)
    };
    way(one, other).max(way(other, one))
}

/// The cut lines of a half on the fold when it is opened, and those of the same piece drawn whole. Edges of the half,
/// from the fold and back to it: control point and end, millimetres; allowance.
fn on_fold_and_whole(start: f64, edges: &[([Vec2; 2], String)]) -> Option<[Paper; 2]> {
    let (mut half, mut other, mut allowances) = (String::new(), String::new(), [String::new(), String::new()]);
    let mut from = Vec2::new(0.0, start);
    for (i, ([control, to], allowance)) in edges.iter().enumerate() {
        half.push_str(&format!("      e{i}: Q {} {}, {} {}\n", control.x, control.y, to.x, to.y));
        let back = format!("      f{i}: Q {} {}, {} {}\n", -control.x, control.y, -from.x, from.y);
        other.insert_str(0, &back);
        allowances[0].push_str(&format!("      e{i}: {allowance}\n"));
        allowances[1].push_str(&format!("      f{i}: {allowance}\n"));
        from = *to;
    }
    let piece = |cut: &str, outline: &str, allowances: &str| {
        one_piece(&format!("{cut}    allowance:\n{allowances}    outline:\n      start: 0 {start}\n{outline}"))
    };
    let folded = piece("    cut: fold center\n", &format!("{half}      center: L 0 {start}\n"), &allowances[0]);
    let whole = piece("", &format!("{half}{other}"), &allowances.concat());
    // Some bend across the fold or each other: they are no pieces.
    let read = |text: &str| read_text("garment", "garment.yaml", text).ok();
    let options = CuttingOptions { whole: true, ..CuttingOptions::default() };
    let cut = |text: &str| Some(papers(&read(text).map(|l| drawings(&l.file, &l.garment))?, &options).remove(0));
    Some([cut(&folded)?, cut(&whole)?])
}

#[test]
fn a_point_on_the_fold_is_cut_as_if_the_piece_were_drawn_whole() {
    // A flat V, the neck line of a shirt, one whose two allowances close it half-way, and a point instead of a V.
    for (depth, shape) in [(40.0, "a flat V"), (150.0, "a V"), (-60.0, "a point")] {
        for kind in ["mitred", "squared", "folded"] {
            let line = |a: Vec2, b: Vec2| [(a + b) / 2.0, b];
            let corners = [(0.0, depth), (80.0, 0.0), (200.0, 40.0), (200.0, 400.0), (0.0, 420.0)];
            let at = corners.map(|(x, y)| Vec2::new(x, y));
            let edge = |k: usize| (line(at[k], at[k + 1]), format!("10 {kind}"));
            let edges: Vec<_> = (0..4).map(edge).collect();
            let [folded, whole] = on_fold_and_whole(depth, &edges).expect("a piece");
            assert_eq!(folded.cut.len(), whole.cut.len());
            assert!(lines_apart(&folded.cut[0], &whole.cut[0]) < EXACT, "{shape}, {kind}: {:?}", folded.cut[0]);
        }
    }
    // The V's point is where both cut lines meet.
    let neck = mm(80.0, -150.0).normalize();
    let folded = paper_of(
        "    cut: fold center\n    outline: {start: 0 150, neck: L 80 0, shoulder: L 200 40, side: L 200 400, \
         hem: L 0 400, center: L 0 150}\n",
    );
    let meet = Vec2::new(0.0, 0.150 - 0.010 / neck.x);
    assert!((folded.fold.expect("a fold")[1] - meet).norm() < EXACT, "{:?}", folded.fold);
    assert!(folded.cut[0].iter().all(|p| p.x > -EXACT), "{:?}", folded.cut[0]);
}

#[test]
fn a_bay_across_the_fold_opens_to_one_contour() {
    // A keyhole below a slit that the allowances close.
    let text = |outline: &str| one_piece(&format!("    allowance: 8 mitred\n    outline: {outline}\n"));
    let half = "{start: 0 120, a: L 40 80, b: L 4 40, c: L 4 0, d: L 200 0, e: L 200 300, f: L 0 300";
    let folded = text(&format!("{half}, center: L 0 120}}")).replace("    allow", "    cut: fold center\n    allow");
    let whole = text(&format!("{half}, g: L -200 300, h: L -200 0, i: L -4 0, j: L -4 40, k: L -40 80, l: L 0 120}}"));
    let options = CuttingOptions { whole: true, ..CuttingOptions::default() };
    let [folded, whole] = [folded, whole].map(|text| papers(&drawn(&text), &options).remove(0));
    assert_eq!((folded.cut.len(), whole.cut.len()), (2, 2), "{:?}", folded.cut);
    for (one, other) in folded.cut.iter().zip(&whole.cut) {
        assert!(lines_apart(one, other) < EXACT, "{one:?}\n{other:?}");
        assert!((area(one).abs() - area(other).abs()).abs() < 1e-8);
    }
}

/// Random pieces: corners round a middle, straight or bent edges, allowances and ends of every kind.
fn any_piece() -> impl Strategy<Value = String> {
    let edge = (60.0..220.0f64, -0.25..0.25f64, any::<bool>(), 0usize..5, 0usize..3);
    proptest::collection::vec(edge, 3..8).prop_map(|edges| {
        let n = edges.len();
        let corner = |i: usize| {
            let angle = std::f64::consts::TAU * (i % n) as f64 / n as f64;
            Vec2::new(angle.cos(), angle.sin()) * edges[i % n].0
        };
        let (mut outline, mut allowance) = (String::new(), String::new());
        for (i, (_, bend, straight, width, kind)) in edges.iter().enumerate() {
            let (a, b) = (corner(i), corner(i + 1));
            let way = b - a;
            let control = (a + b) / 2.0 + Vec2::new(-way.y, way.x) * *bend;
            let path = if *straight {
                format!("L {} {}", b.x, b.y)
            } else {
                format!("Q {} {}, {} {}", control.x, control.y, b.x, b.y)
            };
            outline.push_str(&format!("      e{i}: {path}\n"));
            let (width, kind) = ([0, 5, 10, 15, 40][*width], ["mitred", "squared", "folded"][*kind]);
            allowance.push_str(&format!("      e{i}: {width} {kind}\n"));
        }
        let start = corner(0);
        one_piece(&format!("    allowance:\n{allowance}    outline:\n      start: {} {}\n{outline}", start.x, start.y))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_cut_line_is_at_the_allowance_from_the_sewing_line(text in any_piece()) {
        // Edges that bend into each other make no piece.
        let Ok(loaded) = read_text("garment", "garment.yaml", &text) else { return Ok(()) };
        let drawing = drawings(&loaded.file, &loaded.garment).remove(0);
        let paper = papers(std::slice::from_ref(&drawing), &CuttingOptions::default()).remove(0);
        let edges = &drawing.rings[0];
        let width = |i: usize| edges[i % edges.len()].allowance.width.expect("given");
        for contour in &paper.cut {
            prop_assert!(crosses_itself(contour).is_none(), "crosses near {:?}\n{text}", crosses_itself(contour));
        }
        let short = short_of_allowance(&drawing, &paper);
        prop_assert!(short.is_none(), "{short:?}\n{text}");
        let sewn = edges.iter().map(|e| e.path.double_area()).sum::<f64>() / 2.0;
        // Without any allowance, chords leave the sewing line.
        let chords = EXACT * edges.iter().map(|e| e.path.length()).sum::<f64>();
        prop_assert!(area(&paper.cut[0]) > sewn - chords);
        for p in paper.cut.iter().flatten() {
            // Three times the wider allowance is how far a mitre may go.
            let at_corner = (0..edges.len()).any(|i| {
                let reach = 3.0 * width(i).max(width(i + edges.len() - 1));
                (edges[i].path.start() - p).norm() <= reach + EXACT
            });
            let off: Vec<(f64, f64)> =
                (0..edges.len()).map(|i| (edges[i].path.nearest(*p).1, width(i))).collect();
            let exact = off.iter().any(|(distance, width)| (distance - width).abs() <= EXACT);
            let nearest = off.iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("edges");
            let clear = nearest.0 >= nearest.1 - EXACT;
            prop_assert!(at_corner || exact && clear, "{p}: distances and widths {off:?}\n{text}");
        }
    }
}

/// Random halves: corners from the fold round to it again. Not folded beside squared: of two such ends as wide as each
/// other the second along the outline is heeded, so that these pieces are not symmetric when they are drawn whole.
fn any_half() -> impl Strategy<Value = Vec<([Vec2; 2], String)>> {
    let edge = (60.0..220.0f64, -0.2..0.2f64, 0usize..4, any::<bool>());
    (proptest::collection::vec(edge, 2..6), any::<bool>()).prop_map(|(edges, folded)| {
        let special = if folded { "folded" } else { "squared" };
        let n = edges.len();
        let corner = |i: usize| match i {
            0 => Vec2::new(0.0, HALF_START),
            i if i == n => Vec2::new(0.0, edges[n - 1].0),
            i => {
                let angle = std::f64::consts::PI * i as f64 / n as f64;
                Vec2::new(angle.sin(), -angle.cos()) * edges[i - 1].0
            }
        };
        let drawn = |(i, (_, bend, width, mitred)): (usize, &(f64, f64, usize, bool))| {
            let (a, b) = (corner(i), corner(i + 1));
            let control = (a + b) / 2.0 + Vec2::new(a.y - b.y, b.x - a.x) * *bend;
            let allowance = format!("{} {}", [0, 5, 12, 30][*width], if *mitred { "mitred" } else { special });
            ([control, b], allowance)
        };
        edges.iter().enumerate().map(drawn).collect()
    })
}

/// Where random halves begin on the fold, millimetres: most of the corners beside it are higher, some are lower.
const HALF_START: f64 = -80.0;

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_half_on_the_fold_is_cut_as_if_the_piece_were_drawn_whole(edges in any_half()) {
        let Some([folded, whole]) = on_fold_and_whole(HALF_START, &edges) else { return Ok(()) };
        prop_assert_eq!(folded.cut.len(), whole.cut.len());
        prop_assert!(crosses_itself(&folded.cut[0]).is_none(), "near {:?}", crosses_itself(&folded.cut[0]));
        let apart = lines_apart(&folded.cut[0], &whole.cut[0]);
        prop_assert!(apart < EXACT, "{apart}: {:?}\n{:?}", folded.cut[0], whole.cut[0]);
    }
}

/// A garment with everything that is drawn.
const SAMPLE: &str = "
garment: 1
name: Sample
allowance: 12
pieces:
  front:
    cut: fold center
    grain: [[60, 250], [60, 60]]
    allowance: {hem: 40, neck: 6}
    outline: {start: 0 20, neck: C 40 20 60 0 80 -20, side: C 100 100 90 200 140 300, hem: L 0 300, center: L 0 20}
    notches: {side: [100, 200 double]}
    darts: [{edge: hem, at: 60, intake: 12, length: 80}]
  back: {like: front, cut: pair, notches: {}, note: 'cut with the nap'}
  patch:
    cut: 2
    grain: [[10, 10], [60, 10]]
    outline: {start: 0 0, top: L 90 0, right: L 90 50, bottom: L 0 50, left: L 0 0}
    holes: {slit: M 20 20 L 20 30 L 60 30 L 60 20 Z}
    lines: {fold: {path: M 0 25 L 90 25, fold: 90}}
seams:
  back: {sew: back.center, to: mirror}
free: ['front.*', 'patch.*', back.neck, back.side, back.hem]
";

fn sample() -> Vec<Paper> {
    papers(&drawn(SAMPLE), &CuttingOptions::default())
}

/// Over the mouth of a dart the cut line is raised, so that it lies flush where the dart is pressed.
#[test]
fn every_notch_reaches_the_cut_line() {
    let papers = sample();
    assert!(papers.iter().map(|p| p.notches.len()).sum::<usize>() > 7, "also those at the mouths of darts");
    for paper in &papers {
        let closed = |c: &Vec<Vec2>| Path::polyline(&c.iter().chain(&c[..1]).copied().collect::<Vec<_>>());
        let lines: Vec<Path> = paper.cut.iter().map(closed).collect();
        for notch in &paper.notches {
            let off = lines.iter().map(|line| line.nearest(notch.at).1).fold(f64::INFINITY, f64::min);
            assert!(off <= 1e-8, "{}: {} is {off} m off", paper.name, notch.at);
        }
    }
}

/// Longest distance of a point of one polyline from the other, both ways, as the points say.
fn apart(one: &[Vec2], other: &[Vec2]) -> f64 {
    let to = |p: &Vec2, line: &[Vec2]| line.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
    let way = |a: &[Vec2], b: &[Vec2]| a.iter().map(|p| to(p, b)).fold(0.0, f64::max);
    way(one, other).max(way(other, one))
}

#[test]
fn dxf_read_back_has_the_same_lines_on_the_standards_layers() {
    let papers = sample();
    let text = cutting_dxf("Sample", &papers);
    let pairs: Vec<(i32, &str)> = text
        .lines()
        .collect::<Vec<_>>()
        .chunks(2)
        .map(|c| (c[0].trim().parse().expect("a group code"), c[1]))
        .collect();
    assert_eq!(pairs.last(), Some(&(0, "EOF")));
    let blocks: Vec<&[(i32, &str)]> = pairs.split(|p| *p == (0, "BLOCK")).skip(1).collect();
    assert_eq!(blocks.len(), papers.len());
    for (block, paper) in blocks.iter().zip(&papers) {
        assert!(block.contains(&(2, paper.name.as_str())));
        let entities: Vec<&[(i32, &str)]> = block.split(|p| p.0 == 0).collect();
        let kinds: Vec<&str> = block.iter().filter(|p| p.0 == 0).map(|p| p.1).collect();
        let value = |e: &[(i32, &str)], code: i32| e.iter().find(|p| p.0 == code).map(|p| p.1.to_owned());
        let number = |e: &[(i32, &str)], code: i32| value(e, code).map(|v| v.parse::<f64>().expect("a number"));
        let at = |e: &[(i32, &str)]| Vec2::new(number(e, 10).unwrap_or(0.0), -number(e, 20).unwrap_or(0.0)) * 1e-3;
        let on = |kind: &str, layer: &str| -> Vec<Vec2> {
            let fits = |(k, e): (&&str, &&[(i32, &str)])| **k == *kind && value(e, 8).as_deref() == Some(layer);
            kinds.iter().zip(&entities[1..]).filter(|(k, e)| fits((k, e))).map(|(_, e)| at(e)).collect()
        };
        assert!(apart(&on("VERTEX", "1"), &paper.cut[0]) <= EXACT, "{}", paper.name);
        let notches: Vec<Vec2> = paper.notches.iter().map(|n| n.at).collect();
        assert_eq!(on("POINT", "4").len(), notches.len());
        if !notches.is_empty() {
            assert!(apart(&on("POINT", "4"), &notches) <= EXACT);
        }
        assert_eq!(on("LINE", "6").len(), usize::from(paper.fold.is_some()));
        assert_eq!(on("LINE", "7").len(), 1);
        assert_eq!(on("POINT", "13").len(), paper.drills.len());
        // Edges, the legs of darts among them, inner lines and notches have a text each that tells what they are.
        let told = paper.sew.iter().filter(|l| l.of != SewKind::Mouth).count()
            + paper.marks.iter().filter(|m| m.kind != MarkKind::Fold).count()
            + paper.notches.len();
        assert_eq!(on("TEXT", "15").len(), paper.texts.len() + told);
        let vertices = on("VERTEX", "1").len() + on("VERTEX", "14").len();
        let told = on("POINT", "2").len() + on("POINT", "3").len();
        assert!(
            told >= vertices && !on("POINT", "2").is_empty() && !on("POINT", "3").is_empty() || paper.name == "patch"
        );
        // The sewing line of every edge, straight or bent.
        for line in paper.sew.iter().filter(|l| l.name == "side") {
            for p in on("VERTEX", "14") {
                let near = paper.sew.iter().map(|l| l.path.nearest(p).1).fold(f64::INFINITY, f64::min);
                assert!(near <= EXACT, "{p} is {near} m off");
            }
            assert!((line.path.start() - on("VERTEX", "14").first().copied().unwrap_or_default()).norm() < 1.0);
        }
    }
    let inserts = pairs.iter().filter(|p| **p == (0, "INSERT")).count();
    assert_eq!(inserts, papers.len());
    assert!(pairs.contains(&(1, "Units: METRIC")) && pairs.contains(&(1, "Quantity: 1,1")));
}

/// Value of an attribute of an element's text.
fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let from = element.find(&format!(" {name}=\""))? + name.len() + 3;
    element[from..].split('"').next()
}

#[test]
fn svg_read_back_is_full_size_and_has_the_same_cut_lines() {
    let papers = sample();
    let sheet = Sheet::new(&papers, &Layout { width: None, margin: 0.010, square: true });
    let svg = cutting_svg("Sample", &sheet);
    let head = svg.split('>').next().expect("a head");
    let size: Vec<f64> = ["width", "height"]
        .iter()
        .map(|a| attribute(head, a).and_then(|v| v.strip_suffix("mm")).expect("mm").parse().expect("a number"))
        .collect();
    let view: Vec<f64> = attribute(head, "viewBox").expect("one").split(' ').map(|v| v.parse().expect("one")).collect();
    assert_eq!(view, [0.0, 0.0, size[0], size[1]], "one unit is a millimetre");
    let square = svg.split('<').find(|e| e.starts_with("rect ")).expect("a test square");
    let side = |name: &str| attribute(square, name).expect("one").parse::<f64>().expect("a number");
    assert_eq!([side("width"), side("height")], [100.0; 2]);
    let cut: Vec<Vec<Vec2>> = svg
        .split('<')
        .filter(|e| attribute(e, "class") == Some("cut"))
        .map(|e| {
            let numbers: Vec<f64> = attribute(e, "d")
                .expect("commands")
                .split(|c: char| c.is_ascii_alphabetic() || c == ' ')
                .filter(|w| !w.is_empty())
                .map(|w| w.parse().expect("a number"))
                .collect();
            numbers.chunks(2).map(|p| mm(p[0], p[1])).collect()
        })
        .collect();
    let drawn: Vec<&Vec<Vec2>> = sheet.papers.iter().flat_map(|p| &p.cut).collect();
    assert_eq!(cut.len(), drawn.len());
    for (read, drawn) in cut.iter().zip(drawn) {
        assert!(apart(read, drawn) <= EXACT);
    }
    for id in ["front", "front.side", "back.hem", "patch.slit"] {
        assert_eq!(svg.matches(&format!("id=\"{id}\"")).count(), 1, "{id}");
    }
    for words in ["cut 1 on the fold", "cut 2 (left and right)", "cut with the nap", "hem 40"] {
        assert!(svg.contains(words), "{words}");
    }
}

/// The numbers before every operator of the page streams of an uncompressed PDF.
fn operations(pdf: &[u8]) -> Vec<(String, Vec<f64>)> {
    let text: String = pdf.iter().map(|&b| char::from(b)).collect();
    let mut found = Vec::new();
    for stream in text.split("stream\n").skip(1).step_by(2) {
        let mut numbers = Vec::new();
        for word in stream.split("endstream").next().unwrap_or("").split_whitespace() {
            match word.parse::<f64>() {
                Ok(number) => numbers.push(number),
                Err(_) => found.push((word.to_owned(), std::mem::take(&mut numbers))),
            }
        }
    }
    found
}

/// Side lengths of the squares in a PDF, millimetres.
fn squares(pdf: &[u8]) -> Vec<f64> {
    let operations = operations(pdf);
    let names: Vec<&str> = operations.iter().map(|o| o.0.as_str()).collect();
    let mut sides = Vec::new();
    for (k, five) in names.windows(5).enumerate() {
        if five == ["m", "l", "l", "l", "s"] {
            let corner = |i: usize| Vec2::new(operations[k + i].1[0], operations[k + i].1[1]);
            let side = |i: usize| (corner((i + 1) % 4) - corner(i)).norm() / 72.0 * 25.4;
            if (side(0) - side(1)).abs() < 1e-3 {
                sides.extend((0..4).map(side));
            }
        }
    }
    sides
}

#[test]
fn pdf_pages_have_the_paper_s_size_and_a_square_of_100_mm() {
    let papers = sample();
    let a4 = tiled("Sample", &papers, Page::A4).expect("pages");
    let letter = tiled("Sample", &papers, Page::LETTER).expect("pages");
    let sheet = Sheet::new(&papers, &Layout { width: Some(0.914), margin: 0.010, square: true });
    let one = one_page("Sample", &sheet).expect("a page");
    let boxes = |pdf: &[u8]| -> Vec<Vec<f64>> {
        let text = String::from_utf8_lossy(pdf).into_owned();
        let numbers =
            |t: &str| t.split(']').next().unwrap_or("").split_whitespace().filter_map(|w| w.parse().ok()).collect();
        text.split("/MediaBox [").skip(1).map(numbers).collect()
    };
    for (pdf, width, height) in
        [(&a4, 210.0, 297.0), (&letter, 215.9, 279.4), (&one, sheet.size.x * 1e3, sheet.size.y * 1e3)]
    {
        for page in boxes(pdf) {
            assert!((page[2] / 72.0 * 25.4 - width).abs() < 1e-3 && (page[3] / 72.0 * 25.4 - height).abs() < 1e-3);
        }
        let sides = squares(pdf);
        assert!(sides.iter().filter(|s| (**s - 100.0).abs() < 1e-3).count() >= 4, "{sides:?}");
    }
    assert!(boxes(&a4).len() > 2 && boxes(&one).len() == 1);
}

#[test]
fn a_row_that_both_of_a_pair_carry_is_drilled_once() {
    let lines = "    cut: pair
    outline: {start: 0 0, top: L 100 0, side: L 100 200, hem: L 0 200, edge: L 0 0}
closures:
- {kind: button, piece: front.L, at: [10, 180], meets: front.R, pitch: 50, count: 3}
";
    let drills = paper_of(lines).drills;
    assert_eq!(drills.len(), 3, "{drills:?}");
}

#[test]
fn elastic_is_labelled_beside_its_line() {
    let paper = paper_of(
        "    outline: {start: 0 0, top: L 300 0, right: L 300 200, hem: L 0 200, left: L 0 0}\n\
         \x20   lines: {casing: {path: M 0 20 L 300 20, kind: elastic, ratio: 0.7}}\n",
    );
    let label = paper.texts.iter().find(|t| t.text == "elastic, 70 %").expect("a label");
    let [low, high] = [label.at.y - label.height, label.at.y];
    let line = paper.marks[0].path.start().y;
    assert!(low > line || high < line, "{low} {line} {high}");
    assert!((high - line).abs() < 0.015);
}

/// Left, right, head and foot of a text, with the letters that reach below its line, as wide as a sans-serif type is.
fn text_box(text: &Lettering) -> [f64; 4] {
    let half = text.text.chars().count() as f64 * 0.72 * text.height / 2.0;
    let (p, up, down) = (text.at, text.height, 0.25 * text.height);
    if text.upright {
        [p.x - down, p.x + up, p.y - half, p.y + half]
    } else {
        [p.x - half, p.x + half, p.y - up, p.y + down]
    }
}

/// Every label is clear of every line that is cut or sewn, and legible.
fn assert_clear_labels(paper: &Paper) {
    let sewn = paper.sew.iter().map(|line| line.path.sampled(1e-5));
    let lines: Vec<Vec<Vec2>> = paper.cut.iter().cloned().chain(sewn).collect();
    for text in paper.texts.iter().filter(|t| !t.text.starts_with("elastic")) {
        let [left, right, head, foot] = text_box(text);
        assert!(text.height >= 2.5e-3 - 1e-9, "'{}' on '{}' is {} m high", text.text, paper.name, text.height);
        for [a, b] in lines.iter().flat_map(|line| line.windows(2).map(|w| [w[0], w[1]])) {
            // Looked at more often than the box is high.
            let looks = ((b - a).norm() / 5e-4).ceil();
            let inside = |p: Vec2| left < p.x && p.x < right && head < p.y && p.y < foot;
            let hit = (0..=looks as usize).map(|k| a + (b - a) * (k as f64 / looks.max(1.0))).find(|&p| inside(p));
            assert_eq!(hit, None, "'{}' on '{}'", text.text, paper.name);
        }
    }
}

#[test]
fn labels_cross_no_line_that_is_cut_or_sewn() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/patterns");
    for entry in std::fs::read_dir(folder).expect("patterns") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "yaml") {
            let drawings = drawn(&std::fs::read_to_string(&path).expect("text"));
            papers(&drawings, &CuttingOptions::default()).iter().for_each(assert_clear_labels);
        }
    }
    for outline in [
        "{start: 0 0, top: L 600 0, right: L 600 30, hem: L 0 30, left: L 0 0}",
        "{start: 0 0, top: L 30 0, right: L 30 600, hem: L 0 600, left: L 0 0}",
        "{start: 0 0, top: L 600 0, right: L 600 8, hem: L 0 8, left: L 0 0}",
        "{start: 0 0, a: L 40 0, neck: C 40 90 160 90 160 0, b: L 200 0, rim: C 200 140 0 140 0 0}",
    ] {
        let paper = paper_of(&format!("    outline: {outline}\n"));
        assert_clear_labels(&paper);
        assert!(paper.texts.iter().any(|t| t.text.contains("cut 1")), "{:?}", paper.texts);
    }
}

/// On a narrow band the barbs of the grain's arrow take most of the room.
#[test]
fn labels_are_clear_of_the_grain_s_arrow_and_its_barbs() {
    let mut crossed = Vec::new();
    for (width, grain) in [(20.0, 60.0), (25.0, 60.0), (30.0, 60.0), (40.0, 60.0), (60.0, 60.0), (25.0, 110.0)] {
        let outline = format!("    outline: {{start: 0 0, a: L {width} 0, b: L {width} 120, c: L 0 120, d: L 0 0}}\n");
        let arrow = format!("[[2, {}], [2, {}]]", 60.0 + grain / 2.0, 60.0 - grain / 2.0);
        let text = one_piece(&outline).replace("[[0, 50], [0, 0]]", &arrow);
        let paper = papers(&drawn(&text), &CuttingOptions::default()).remove(0);
        // Barbs 6 mm long and as wide, at both ends.
        let [tail, head] = paper.grain;
        let [left, right, up] = [mm(-3.0, 0.0), mm(3.0, 0.0), mm(0.0, -6.0)];
        let arrow = [tail + up + left, tail, tail + up + right, tail, head, head - up + left, head, head - up + right];
        for text in &paper.texts {
            // As wide as a sans-serif type is on average.
            let half = text.text.chars().count() as f64 * 0.6 * text.height / 2.0;
            let [left, right, head, foot] = match (text.upright, text.at, text.height) {
                (true, p, h) => [p.x, p.x + h, p.y - half, p.y + half],
                (false, p, h) => [p.x - half, p.x + half, p.y - h, p.y],
            };
            let inside = |p: Vec2| left < p.x && p.x < right && head < p.y && p.y < foot;
            let places = |w: &[Vec2]| (0..=200).map(|k| w[0] + (w[1] - w[0]) * (f64::from(k) / 200.0)).any(inside);
            crossed.extend(arrow.windows(2).any(places).then(|| format!("'{}', {width} mm", text.text)));
        }
    }
    assert_eq!(crossed, Vec::<String>::new());
}

/// Where there is no room on a piece its label stands under it, and the sheet is so much larger.
#[test]
fn a_label_beside_its_piece_is_on_the_sheet() {
    let paper = paper_of("    outline: {start: 0 0, top: L 40 0, right: L 40 8, hem: L 0 8, left: L 0 0}\n");
    let sheet = Sheet::new(&[paper.clone(), paper], &Layout::default());
    let boxes: Vec<Vec<[f64; 4]>> = sheet.papers.iter().map(|p| p.texts.iter().map(text_box).collect()).collect();
    for [left, right, head, foot] in boxes.concat() {
        assert!(left >= 0.0 && right <= sheet.size.x && head >= 0.0 && foot <= sheet.size.y);
    }
    let [low, high] = sheet.papers[0].bounds();
    assert!(boxes[0].iter().all(|b| b[2] > high.y && b[0] >= low.x), "{boxes:?}");
}

/// A piece with a hole of this path, into which another is sewn or nothing.
fn holed(hole: &str, sewn: bool) -> Paper {
    let seams = if sewn { "seams: {w: {sew: body.win, to: patch.rim}}\n" } else { "" };
    let text = format!(
        "garment: 1\nallowance: 15\npieces:\n  body:\n    grain: [[10, 20], [10, 280]]\n    outline: {{start: 0 0, a: \
         L 300 0, b: L 300 300, c: L 0 300, d: L 0 0}}\n    holes: {{win: {hole} Z}}\n  patch:\n    grain: [[10, 20], \
         [10, 30]]\n    outline: {{start: {}, rim: {}}}\n{seams}free: ['*.*']\n",
        hole.trim_start_matches("M ").split(" L ").next().expect("a start"),
        hole.split_once(" L ").map(|(start, rest)| format!("L {rest} L {}", &start[2..])).expect("a path"),
    );
    papers(&drawn(&text), &CuttingOptions::default()).remove(0)
}

#[test]
fn a_hole_has_an_allowance_where_something_is_sewn_into_it() {
    let square = "M 100 100 L 200 100 L 200 200 L 100 200";
    let cut_out = |paper: &Paper| (area(&paper.cut[1]).abs() * 1e6).round();
    let free = holed(square, false);
    assert_eq!((cut_out(&free), free.narrowed.len()), (10_000.0, 0));
    let sewn = holed(square, true);
    assert_eq!((cut_out(&sewn), sewn.narrowed.len()), (4_900.0, 0));
    assert!(has_point(&sewn.cut[1], mm(115.0, 115.0)));
    assert!(sewn.texts.iter().any(|t| t.text == "allowance 15 mm"), "{:?}", sewn.texts);
    // Ten millimetres wide: 15 and 7.5 leave nothing to cut out.
    let welt = holed("M 100 100 L 200 100 L 200 110 L 100 110", true);
    let [narrowed] = welt.narrowed.as_slice() else { panic!("{:?}", welt.narrowed) };
    assert_eq!((narrowed.edge.as_str(), narrowed.asked, narrowed.drawn), ("win", 0.015, 0.00375));
    assert_eq!(cut_out(&welt), (92.5_f64 * 2.5).round());
    assert!(welt.texts.iter().any(|t| t.text == "allowance 15 mm; win 3.75"), "{:?}", welt.texts);
}

#[test]
fn the_grain_is_on_the_piece_wherever_it_was_drawn() {
    let beside = "garment: 1\nfree: ['*.*']\npieces:\n  front:\n    grain: [[500, 90], [500, 10]]\n    \
                  outline: {start: 0 0, top: L 100 0, right: L 100 200, hem: L 0 200, left: L 0 0}\n";
    let paper = papers(&drawn(beside), &CuttingOptions::default()).remove(0);
    let [tail, head] = paper.grain;
    let [low, high] = paper.bounds();
    assert!(tail.x > low.x && tail.x < high.x && (tail.y - head.y - 0.080).abs() < 1e-9, "{tail} {head}");
}

#[test]
fn a_sheet_no_reader_shows_is_refused() {
    let papers = sample();
    let sheet = Sheet { size: Vec2::new(1.0, 6.0), ..Sheet::new(&papers, &Layout::default()) };
    let error = one_page("Sample", &sheet).expect_err("too long").to_string();
    assert!(error.contains("6000 mm") && error.contains("--width"), "{error}");
}
