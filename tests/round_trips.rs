//! Garments drawn as patterns for cutting and read back from them: what the formats have no lines for comes, too.

use toile::cutting::{CuttingOptions, Layout, Paper, Sheet, papers};
use toile::digitize::{Digitized, garment_file};
use toile::io::dxf_read::read_dxf_text;
use toile::io::dxf_write::cutting_dxf;
use toile::io::garment::{Loaded, read_text, write};
use toile::io::svg_read::read_svg_text;
use toile::io::svg_write::cutting_svg;
use toile::pattern::{CutKind, DrawnEdge, DrawnPiece, LineKind, Side, drawings};

/// A hundredth of a millimetre, metres.
const EXACT: f64 = 1e-5;

fn read(text: &str) -> Loaded {
    read_text("garment", "garment.yaml", text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn drawn(text: &str) -> Vec<DrawnPiece> {
    let loaded = read(text);
    drawings(&loaded.file, &loaded.garment)
}

fn on_paper(text: &str) -> Vec<Paper> {
    papers(&drawn(text), &CuttingOptions::default())
}

fn sheet(papers: &[Paper]) -> Sheet {
    Sheet::new(papers, &Layout { width: None, margin: 0.010, square: true })
}

/// The text exported and imported again, by way of SVG and of DXF.
fn both_ways(text: &str) -> [Digitized; 2] {
    let papers = on_paper(text);
    let svg = cutting_svg("Sample", &sheet(&papers));
    let from_svg = read_svg_text(&svg).unwrap_or_else(|e| panic!("{e}\n{svg}")).pieces;
    let from_dxf = read_dxf_text(&cutting_dxf("garment", &papers), None).expect("pieces").pieces;
    [from_svg, from_dxf].map(|pieces| garment_file("garment", &pieces))
}

/// What a made file draws.
fn again(made: &Digitized) -> Vec<DrawnPiece> {
    drawn(&write(&made.file).expect("YAML"))
}

/// A square with a hole, into which a patch is sewn or nothing.
fn window(sewn: bool, about_hole: &str) -> String {
    let (seams, free) = if sewn {
        ("seams: {w: {sew: body.win, to: patch.rim}}", "free: [body.a, body.b, body.c, body.d]")
    } else {
        ("", "free: ['*.*']")
    };
    format!(
        "garment: 1
allowance: 15
pieces:
  body:
    grain: [[0, 20], [0, 280]]
    outline: {{start: -150 0, a: L 150 0, b: L 150 300, c: L -150 300, d: L -150 0}}
    holes: {{win: M -50 100 L 50 100 L 50 200 L -50 200 Z}}
    {about_hole}
  patch:
    grain: [[0, 110], [0, 190]]
    outline: {{start: -50 100, rim: L 50 100 L 50 200 L -50 200 L -50 100}}
{seams}
{free}
"
    )
}

/// Length of the hole's rim and its allowance, metres.
fn hole(drawing: &DrawnPiece) -> (f64, Option<f64>) {
    assert_eq!(drawing.rings.len(), 2, "one hole");
    let [edge] = drawing.rings[1].as_slice() else { panic!("of one edge") };
    assert_eq!(edge.name, "win");
    (edge.path.length(), edge.allowance.width)
}

#[test]
fn holes_come_back_with_their_names_and_allowances() {
    let cases = [
        (window(true, ""), Some(0.015_f64)),
        (window(false, "allowance: {win: 5}"), Some(0.005)),
        // Cut and turned in on one line.
        (window(false, ""), None),
    ];
    for (text, allowance) in cases {
        for made in both_ways(&text) {
            let drawings = again(&made);
            let body = drawings.iter().find(|d| d.name == "body").expect("the body");
            let (length, width) = hole(body);
            assert!((length - 0.4).abs() < EXACT, "{length}");
            let tenths = |w: f64| (w * 1e4).round();
            assert_eq!(width.map(tenths), allowance.map(tenths));
            assert!(body.rings[0].iter().all(|e| e.allowance.width == Some(0.015)), "{:?}", body.rings[0]);
        }
    }
}

#[test]
fn pieces_without_allowance_come_back() {
    for rims in ["allowance: 0", "allowance: {a: 0, b: 0, c: 0, d: 10}", "allowance: {a: 12, b: 0, c: 0, d: 0}"] {
        let text = window(false, rims);
        for made in both_ways(&text) {
            let (drawings, before) = (again(&made), drawn(&text));
            assert_eq!(drawings.len(), before.len(), "{rims}");
            let body = drawings.iter().find(|d| d.name == "body").expect("the body");
            assert_eq!(hole(body).1, None);
            for edge in &before[0].rings[0] {
                let own = body.rings[0].iter().find(|e| e.name == edge.name).expect("the edge");
                assert!((own.path.length() - edge.path.length()).abs() < EXACT);
                assert_eq!(own.allowance.width, edge.allowance.width, "{rims}: {}", edge.name);
            }
        }
    }
}

const SHAPED: &str = "
garment: 1
allowance: 10
pieces:
  back:
    cut: pair
    drawn: R
    grain: [[-60, 250], [-60, 60]]
    outline: {start: -150 0, waist: C -100 10 -50 10 0 0, center: L 0 300, hem: L -160 300, side: L -150 0}
    notches: {side: [120]}
    darts: [{name: tuck, edge: waist, at: 70, intake: 20, length: 90}]
    lines:
      crease: {path: M -150 250 L 0 250, fold: -90}
      casing: {path: M -150 200 L 0 200, kind: elastic, ratio: 0.7}
      pocket: {path: M -120 150 L -60 150, kind: place}
  front:
    cut: fold center
    drawn: R
    grain: [[-60, 250], [-60, 60]]
    outline: {start: -200 0, waist: L 0 0, center: L 0 300, hem: L -200 300, side: L -200 0}
    pleats:
      - {edge: waist, at: [40, 90], depth: 8}
      - {edge: hem, at: [60], depth: 10, toward: center}
seams: {back: {sew: back.center, to: mirror}}
free: [back.waist, back.hem, back.side, front.waist, front.hem, front.side]
";

#[test]
fn darts_lines_pleats_and_sides_come_back() {
    let before = drawn(SHAPED);
    for (made, format) in both_ways(SHAPED).iter().zip(["SVG", "DXF"]) {
        let yaml = write(&made.file).expect("YAML");
        let after = again(made);
        let same = |old: &DrawnPiece| after.iter().find(|new| new.name == old.name).expect("the piece");
        for (old, new) in before.iter().map(|old| (old, same(old))) {
            // The edge on the fold is drawn as that, without its name.
            let on_fold = |d: &DrawnPiece, e: &DrawnEdge| d.fold.is_some_and(|f| d.rings[0][f].name == e.name);
            let cut = if old.fold.is_some() { &CutKind::Fold("fold".to_owned()) } else { &old.cut };
            assert_eq!((new.drawn, &new.cut), (Side::Right, cut), "{format}\n{yaml}");
            assert_eq!(new.rings[0].len(), old.rings[0].len(), "{format}\n{yaml}");
            for edge in old.rings[0].iter().filter(|e| !on_fold(old, e)) {
                let own = new.rings[0].iter().find(|e| e.name == edge.name);
                let own = own.unwrap_or_else(|| panic!("{format}: no {}\n{yaml}", edge.name));
                assert_eq!(own.allowance.width, edge.allowance.width, "{format}\n{yaml}");
                let (a, b) = (own.path.length(), edge.path.length());
                assert!((a - b).abs() < EXACT, "{format} {}: {a} {b}\n{yaml}", edge.name);
            }
            assert_eq!((new.darts.len(), new.notches.len()), (old.darts.len(), old.notches.len()), "{format}\n{yaml}");
            let folds = |d: &DrawnPiece| -> Vec<(String, i64, i64)> {
                let mm = |x: f64| (x * 1e5).round() as i64;
                let row = |f: &toile::pattern::DrawnFold| (d.edge(f.edge).name.clone(), mm(f.from), mm(f.to));
                let mut rows: Vec<_> = d.folds.iter().map(row).collect();
                rows.sort_unstable();
                rows
            };
            assert_eq!(folds(new), folds(old), "{format}\n{yaml}");
            let lines = |d: &DrawnPiece| -> Vec<(String, LineKind)> {
                d.lines.iter().map(|l| (l.name.clone(), l.kind.clone())).collect()
            };
            assert_eq!(lines(new), lines(old), "{format}\n{yaml}");
        }
        assert!(made.notes.is_empty(), "{format}: {:?}", made.notes);
    }
    let pair = before.iter().find(|d| d.cut == CutKind::Pair).expect("a pair");
    assert!(pair.folds.is_empty() && pair.darts.len() == 1 && before[1].folds.len() == 3);
}

/// Files of other programs tell nothing of the lines on layer 8: the import says so, once for a piece.
#[test]
fn lines_of_which_a_dxf_tells_nothing_are_said_to_be_marks() {
    let mut silent = cutting_dxf("garment", &on_paper(SHAPED));
    for key in ["Edge: ", "Line: ", "Pleat: "] {
        assert!(silent.contains(key));
        silent = silent.replace(key, "Remark: ");
    }
    let made = garment_file("garment", &read_dxf_text(&silent, None).expect("pieces").pieces);
    let said = |words: &str| made.notes.iter().filter(|n| n.contains(words)).count();
    // Two legs of a dart and three lines; of three pleats three lines each.
    assert_eq!((said("5 lines inside 'back' are taken as marks"), said("9 lines inside 'front'")), (1, 1));
    assert_eq!(made.notes.len(), 2, "{:?}", made.notes);
}

const BUTTONED: &str = "
garment: 1
name: Plain & simple
fabrics: {shell: jersey, band: rib, lining: {base: rib, weight: 90 g/m2}}
pieces:
  front: {cut: fold center, grain: [[20, 50], [20, 200]], outline: {start: 0 0, waist: L 150 0, side: L 150 300,
    hem: L 0 300, center: L 0 0}}
  strip: {fabric: band, grain: [[50, 5], [50, 50]], outline: {start: 0 0, a: L 150 0, b: L 150 60, c: L 0 60, d: L 0 0}}
  facing: {fabric: lining, grain: [[50, 5], [50, 50]], outline: {start: 0 0, a: L 99 0, b: L 99 60, c: L 0 60,
    d: L 0 0}}
closures: [{kind: button, piece: strip, at: [[15, 30], [0, 0]], meets: front, meets_at: [[60, 90], [60, 60]]}]
free: ['*.*']
";

#[test]
fn fabrics_titles_and_drill_marks_come_back() {
    let svg = cutting_svg("Plain & simple", &sheet(&on_paper(BUTTONED)));
    let dxf = cutting_dxf("Plain & simple", &on_paper(BUTTONED));
    let drawings = [read_svg_text(&svg).expect("pieces"), read_dxf_text(&dxf, None).expect("pieces")];
    assert_eq!(drawings.map(|d| d.title), [Some("Plain & simple".to_owned()), Some("Plain & simple".to_owned())]);
    for made in both_ways(BUTTONED) {
        let loaded = read(&write(&made.file).expect("YAML"));
        // Values of its own are not in a drawing.
        let fabrics: Vec<_> = loaded.garment.fabrics.iter().map(|f| (f.name.as_str(), f.cloth())).collect();
        let wanted = [("shell", Some("jersey")), ("band", Some("rib")), ("lining", Some("cotton_poplin"))];
        assert!(fabrics.len() == 3 && wanted.iter().all(|w| fabrics.contains(w)), "{fabrics:?}");
        assert!(made.notes.len() == 1 && made.notes[0].contains("which fabric 'lining' is"), "{:?}", made.notes);
        for drawing in again(&made) {
            let (fabric, drills) = match drawing.name.as_str() {
                "front" => ("shell", 2),
                "strip" => ("band", 2),
                _ => ("lining", 0),
            };
            assert_eq!((drawing.fabric.as_str(), drawing.lines.len()), (fabric, drills), "{}", drawing.name);
        }
        // The edge on the fold is as long as the side.
        let is_fold = |name: &str| name == "front.fold";
        assert!(
            !made.suggestions.iter().any(|s| s.sew.iter().chain(&s.to).any(|e| is_fold(e))),
            "{:?}",
            made.suggestions
        );
    }
}

/// What `check` takes as equal is offered as a seam, and what it refuses is not.
#[test]
fn edges_within_the_tolerance_of_a_seam_are_suggested() {
    for (more, offered) in [(1.9, true), (2.1, false)] {
        let text = format!(
            "garment: 1\npieces:\n  a: {{grain: [[9, 9], [9, 90]], outline: {{start: 0 0, p: L 60 0, q: L 60 200, \
             r: L 0 130, s: L 0 0}}}}\n  b: {{grain: [[9, 9], [9, 90]], outline: {{start: 0 0, t: L 75 0, u: L 75 100, \
             v: L 0 {0}, w: L 0 0}}}}\nfree: ['*.*']\n",
            200.0 + more
        );
        for made in both_ways(&text) {
            let found = made.suggestions.iter().any(|s| s.sew == ["a.q"] && s.to == ["b.w"]);
            assert_eq!(found, offered, "{:?}", made.suggestions);
        }
    }
}

#[test]
fn letters_beyond_ascii_come_back_from_a_dxf() {
    let text = "garment: 1\npieces:\n  rücken:\n    grain: [[5, 5], [5, 40]]\n    outline: {start: 0 0, größe: L 90 0, \
                b: L 90 90, c: L 0 90, d: L 0 0}\nfree: ['*.*']\n";
    for made in both_ways(text) {
        let drawings = again(&made);
        assert_eq!(drawings[0].name, "rücken");
        assert!(drawings[0].rings[0].iter().any(|e| e.name == "größe"), "{:?}", drawings[0].rings[0]);
    }
}

/// DXF has codes of four digits: what is beyond those, as emoji are, takes two.
#[test]
fn titles_beyond_four_digits_come_back_from_a_dxf() {
    let text = window(false, "");
    for title in ["Robe 👗 d'été", "服装 №1", "a \\U+ b \\U+D83D c", "👗👗 \\U+00", "x \\U+zzzzé y"] {
        let dxf = cutting_dxf(title, &on_paper(&text));
        assert!(dxf.is_ascii());
        assert_eq!(read_dxf_text(&dxf, None).expect("pieces").title.as_deref(), Some(title));
    }
    assert!(cutting_dxf("👗", &on_paper(&text)).contains("Style Name: \\U+D83D\\U+DC57\n"));
}

/// How allowances end is drawn in the cut line, where it cannot be read off for certain.
#[test]
fn ends_of_allowances_come_back() {
    let rims = ["allowance: {a: 40 folded, b: 15 squared, c: 15 mitred, d: 12}", "allowance: 15 squared"];
    for rims in rims {
        let text = window(false, rims);
        let before = &drawn(&text)[0];
        for made in both_ways(&text) {
            let after = again(&made);
            let body = after.iter().find(|d| d.name == "body").expect("the body");
            for edge in &before.rings[0] {
                let own = body.rings[0].iter().find(|e| e.name == edge.name).expect("the edge");
                assert_eq!(own.allowance, edge.allowance, "{rims}: {}", edge.name);
            }
        }
    }
}

/// What a piece and its edges are called says nothing of what their lines are; nor does a wide allowance.
#[test]
fn a_notched_collar_and_a_disc_with_a_wide_allowance_come_back() {
    let text = "
garment: 1
allowance: 30
pieces:
  notched_collar:
    grain: [[0, 0], [0, 100]]
    outline: {start: 0 0, grain_end: L 300 0, notch: L 330 250, h: L -30 250, t: L 0 0}
  disc:
    grain: [[40, 20], [40, 60]]
    outline: {start: 0 40, rim: A 40 40 0 0 1 80 40 A 40 40 0 0 1 0 40}
free: ['*.*']
";
    let edges = |drawings: &[DrawnPiece]| -> Vec<(String, String, i64, Option<i64>)> {
        let tenths = |x: f64| (x * 1e4).round() as i64;
        let of = |d: &DrawnPiece| {
            let edge = |e: &DrawnEdge| {
                (d.name.clone(), e.name.clone(), tenths(e.path.length()), e.allowance.width.map(tenths))
            };
            d.rings.iter().flatten().map(edge).collect::<Vec<_>>()
        };
        let mut all: Vec<_> = drawings.iter().flat_map(of).collect();
        all.sort();
        all
    };
    for made in both_ways(text) {
        assert_eq!(edges(&again(&made)), edges(&drawn(text)));
    }
}

/// Hems as long as each other are no seam; the halves of a pair meet at its center, which no other edge is as long as.
#[test]
fn hems_are_not_suggested_and_centers_to_their_mirror_images() {
    let text = "garment: 1\npieces:\n  front: {cut: pair, grain: [[9, 9], [9, 90]], outline: {start: 0 0, \
                waist: L 70 0, side: L 90 200, hem: L 0 210, center: L 0 0}}\n  back: {cut: pair, \
                grain: [[9, 9], [9, 90]], outline: {start: 0 0, waist: L 65 10, side: L 90 209.5, hem: L 0 220, \
                center_back: L 0 0}}\nfree: ['*.*']\n";
    for made in both_ways(text) {
        let found: Vec<(&str, &str)> = made.suggestions.iter().map(|s| (s.sew[0].as_str(), s.to[0].as_str())).collect();
        let seams = [("front.side", "back.side"), ("front.center", "mirror"), ("back.center_back", "mirror")];
        assert_eq!(found, seams);
    }
}
