//! Drawings as they come from programs and makers: what is a piece of them, what is not, and what is said of it. Areas
//! and lengths are those of the drawings' own numbers.

use toile::digitize::{Digitized, Drawing, garment_file};
use toile::io::dxf_read::{DxfOptions, read_dxf, read_dxf_text, read_dxf_text_as, read_graded_dxf_text};
use toile::io::garment::{read_text, write};
use toile::io::svg_read::{SvgOptions, read_svg_text, read_svg_text_as};
use toile::pattern::{AllowanceFile, CutKind, DartShape, PieceFile, drawings};

/// A drawing of so many millimetres.
fn svg(width: f64, height: f64, inside: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
         xmlns:xlink='http://www.w3.org/1999/xlink' width='{width}mm' height='{height}mm' \
         viewBox='0 0 {width} {height}'>{inside}</svg>"
    )
}

fn read(text: &str) -> Drawing {
    read_svg_text(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// What is made of a drawing; a check of the file finds nothing wrong.
fn made(drawing: &Drawing) -> Digitized {
    let made = garment_file("drawing", &drawing.pieces);
    let yaml = write(&made.file).expect("YAML");
    read_text("drawing", "drawing.yaml", &yaml).unwrap_or_else(|e| panic!("{e}\n{yaml}"));
    made
}

fn pieces(drawing: &Drawing) -> Vec<PieceFile> {
    made(drawing).file.pieces
}

/// Names of the pieces and the areas their sewing lines go round, square centimetres.
fn areas(drawing: &Drawing) -> Vec<(String, f64)> {
    let made = made(drawing);
    let yaml = write(&made.file).expect("YAML");
    let loaded = read_text("drawing", "drawing.yaml", &yaml).expect("a garment");
    let area = |ring: &[toile::pattern::DrawnEdge]| -> f64 { ring.iter().map(|e| e.path.double_area()).sum() };
    drawings(&loaded.file, &loaded.garment).iter().map(|d| (d.name.clone(), 5e3 * area(&d.rings[0]).abs())).collect()
}

fn assert_areas(drawing: &Drawing, wanted: &[(&str, f64)]) {
    let found = areas(drawing);
    let alike = found.len() == wanted.len()
        && found.iter().zip(wanted).all(|(f, w)| f.0 == w.0 && (f.1 / w.1 - 1.0).abs() < 5e-4);
    assert!(alike, "{found:?} is not {wanted:?}; {:?} {:?}", drawing.left_out, drawing.faults);
}

fn says(sentences: &[String], words: &[&str]) -> bool {
    sentences.iter().any(|s| words.iter().all(|w| s.contains(w)))
}

/// A closed line inside is the sewing line only if it follows the outline all round, however large it is or small.
#[test]
fn an_inner_line_replaces_no_outline_that_it_does_not_follow() {
    let panel = "<g id='back'><path class='fabric' d='M 20 20 H 240 L 260 400 H 20 Z'/>";
    let whole = 0.5 * (220.0 + 240.0) * 380.0 / 100.0;
    let dart = "<path class='fabric' d='M 120 120 L 130 210 L 120 300 L 110 210 Z'/></g>";
    let drawing = read(&svg(300.0, 420.0, &format!("{panel}{dart}")));
    assert_areas(&drawing, &[("back", whole)]);
    let piece = pieces(&drawing).remove(0);
    let [dart] = &piece.darts[..] else { panic!("{:?}", piece.darts) };
    let DartShape::FishEye { at, up, down } = &dart.shape else { panic!("{dart:?}") };
    let numbers = [at.value[0], at.value[1], up.value.number, down.value.number, dart.intake.value.number];
    assert_eq!(numbers, [100.0, 190.0, 90.0, 90.0, 20.0]);
    // A large pocket and a welt are marks, whichever way they are drawn.
    let marks = "<path class='fabric' d='M 60 150 H 200 V 330 H 60 Z'/><path d='M 80 60 h 120 v 12 h -120 Z'/></g>";
    let drawing = read(&svg(300.0, 420.0, &format!("{panel}{marks}")));
    assert_areas(&drawing, &[("back", whole)]);
    let piece = pieces(&drawing).remove(0);
    assert!(piece.lines.len() == 2 && piece.holes.is_empty() && piece.darts.is_empty(), "{piece:?}");
    // What the drawing calls a hole is one.
    let hole = "<path id='hole' d='M 100 150 h 60 v 60 h -60 Z'/></g>";
    assert_eq!(pieces(&read(&svg(300.0, 420.0, &format!("{panel}{hole}"))))[0].holes.len(), 1);
}

#[test]
fn a_narrow_band_keeps_its_cut_line() {
    let band = "<g id='cuff'><path d='M 10 10 H 252 V 46 H 10 Z'/><path d='M 22 22 H 240 V 34 H 22 Z'/></g>";
    let drawing = read(&svg(270.0, 60.0, band));
    assert_areas(&drawing, &[("cuff", 218.0 * 12.0 / 100.0)]);
    assert!(pieces(&drawing)[0].allowance.is_some() && pieces(&drawing)[0].holes.is_empty());
}

/// Cut lines beside curves are drawn a little off: what is meant is the width of the straight edges.
#[test]
fn an_allowance_is_what_was_meant() {
    let inside = "<g id='front'><path d='M 20 120 C 60 120 80 90 80 30 H 240 V 400 H 20 Z'/>\
                  <path d='M 10 110 C 55 110 70 85 70 20 H 250 V 430 H 10 Z'/></g>";
    let yaml = write(&made(&read(&svg(260.0, 440.0, inside))).file).expect("YAML");
    let line = yaml.lines().find(|line| line.contains("allowance")).expect("an allowance");
    assert!(line.matches(": 10").count() == 4 && line.contains(": 30"), "{line}");
}

/// A fish-eye may have bent legs, which is said; one that is askew is a mark.
#[test]
fn fish_eyes_that_a_file_cannot_hold_are_said() {
    let with = |line: &str| {
        read(&svg(260.0, 460.0, &format!("<g id='back'><path d='M 20 20 H 240 V 440 H 20 Z'/><path d='{line}'/></g>")))
    };
    let bent = with(
        "M 120 100 C 120 100 106 200 106 230 C 106 260 120 330 120 330 C 120 330 134 260 134 230 \
                     C 134 200 120 100 120 100 Z",
    );
    let file = made(&bent);
    assert!(file.file.pieces[0].darts.len() == 1 && says(&file.notes, &["'fisheye'", "bent"]), "{:?}", file.notes);
    let askew = with("M 90 100 L 134.162 175.992 L 160 260 L 115.838 184.008 Z");
    let file = made(&askew);
    assert!(file.file.pieces[0].darts.is_empty() && file.file.pieces[0].lines.len() == 1);
    assert!(says(&file.notes, &["askew"]), "{:?}", file.notes);
}

#[test]
fn what_belongs_to_the_sheet_is_no_piece() {
    let skirt = "<path id='skirt' d='M 60 60 H 240 L 260 360 H 40 Z'/>";
    let area = 0.5 * (180.0 + 220.0) * 300.0 / 100.0;
    let page = "<rect width='100%' height='100%' style='fill:#fff'/>";
    let drawing = read(&svg(400.0, 420.0, &format!("{page}{skirt}")));
    assert_areas(&drawing, &[("skirt", area)]);
    assert!(says(&drawing.left_out, &["the page", "1680.00 cm²"]), "{:?}", drawing.left_out);
    assert!(drawing.complaints().is_empty());
    // A frame on the sheet round two pieces, with a title block, a legend and a test square.
    let yoke = "<path id='yoke' d='M 280 60 H 370 V 140 H 280 Z'/>";
    let sheet = "<rect x='10' y='10' width='380' height='400' fill='none' stroke='black'/>\
                 <rect x='300' y='300' width='50.8' height='50.8'/><text x='302' y='320'>test: 2 in</text>\
                 <rect x='290' y='180' width='90' height='50'/><text x='300' y='200'>page 1 of 3</text>";
    let drawing = read(&svg(400.0, 420.0, &format!("{sheet}{skirt}{yoke}")));
    assert_areas(&drawing, &[("skirt", area), ("yoke", 72.0)]);
    for words in [["a frame", "1520.00 cm²"], ["a test square", "25.81 cm²"], ["a title block", "45.00 cm²"]] {
        assert!(says(&drawing.left_out, &words), "{words:?}: {:?}", drawing.left_out);
    }
    // A grid behind a piece, as FreeSewing has it, says nothing of it.
    let grid = "<rect class='grid' x='30' y='50' width='240' height='320'/>";
    let drawing = read(&svg(400.0, 420.0, &format!("{grid}{skirt}")));
    assert_areas(&drawing, &[("skirt", area)]);
    assert!(pieces(&drawing)[0].allowance.is_none());
    // A rectangle that fills its sheet with a pocket on it is a piece.
    let apron = "<path id='apron' d='M 0 0 H 400 V 420 H 0 Z'/><path d='M 150 100 h 100 v 110 h -100 Z'/>";
    assert_areas(&read(&svg(400.0, 420.0, apron)), &[("apron", 1680.0)]);
}

#[test]
fn an_outline_in_several_lines_is_joined_over_half_a_millimetre_and_no_more() {
    let front = |gap: f64| {
        let parts = format!(
            "<g id='front'><path class='fabric' d='M 20 20 H 220'/><path class='fabric' d='M {} 20 V 320'/>\
             <path class='fabric' d='M 220 320 H 20 V 20'/><path class='fabric' d='M 80 100 h 60 v 70 h -60 Z'/></g>\
             <path id='yoke' d='M 260 20 h 100 v 100 h -100 Z'/>",
            220.0 + gap
        );
        read(&svg(400.0, 340.0, &parts))
    };
    assert_areas(&front(0.0), &[("front", 600.0), ("yoke", 100.0)]);
    let joined = front(0.3);
    let found = areas(&joined);
    assert!(found.len() == 2 && (found[0].1 / 600.0 - 1.0).abs() < 2e-3, "{found:?}");
    assert!(says(&joined.notes, &["'front'", "0.30 mm", "joined"]) && joined.complaints().is_empty());
    let open = front(3.0);
    assert!(!areas(&open).iter().any(|(_, area)| *area > 100.5), "{:?}", areas(&open));
    assert!(says(&open.complaints(), &["'front'", "3.00 mm apart", "cm²"]), "{:?}", open.complaints());
}

#[test]
fn outlines_drawn_twice_and_letters_are_no_pieces_and_cut_nothing_out() {
    let outline = "d='M 20 20 H 240 V 300 H 20 Z'";
    let letters: String = (0..4)
        .map(|k| {
            let x = 60 + 20 * k;
            format!("<path d='M {x} 100 h 12 v 24 h -12 z M {} 104 v 16 h 4 v -16 z' fill='black'/>", x + 4)
        })
        .collect();
    let inside = format!(
        "<g id='side'><path {outline} fill='#ddd' stroke='none'/>\
         <path {outline} fill='none' stroke='#000'/>{letters}</g>"
    );
    let drawing = read(&svg(260.0, 320.0, &inside));
    assert_areas(&drawing, &[("side", 616.0)]);
    let piece = pieces(&drawing).remove(0);
    assert!(piece.holes.is_empty() && piece.notches.is_empty() && piece.lines.is_empty(), "{piece:?}");
    assert!(says(&drawing.left_out, &["drawn twice", "616.00 cm²"]), "{:?}", drawing.left_out);
    assert!(says(&drawing.left_out, &["8 small filled shapes"]), "{:?}", drawing.left_out);
}

#[test]
fn what_is_too_small_for_a_piece_is_said_and_what_is_lost_counts() {
    let loops = |count: usize| -> String {
        (0..count).map(|k| format!("<path id='loop{k}' d='M {} 20 h 12 v 60 h -12 Z'/>", 130 + 20 * k)).collect()
    };
    let pocket = "<path id='pocket' d='M 20 20 h 90 v 100 h -90 Z'/>";
    let one = read(&svg(400.0, 140.0, &format!("{pocket}{}", loops(1))));
    assert!(says(&one.left_out, &["'loop0'", "7.20 cm²"]) && one.complaints().is_empty(), "{:?}", one.left_out);
    let many = read(&svg(400.0, 140.0, &format!("{pocket}{}", loops(4))));
    assert!(says(&many.complaints(), &["24 %", "left out"]), "{:?}", many.complaints());
}

#[test]
fn sizes_in_one_another_are_sizes() {
    let nest = |label: fn(usize) -> String| -> String {
        (0..3)
            .map(|k| {
                let (x, y) = (60 - 20 * k, 50 - 12 * k);
                let d = format!("M {x} {y} H {} L {} {} H {} Z", 240 - x, 260 - x, 380 - y, x - 10);
                format!("<g{}><path d='{d}' fill='none' stroke='black'/></g>", label(k))
            })
            .collect()
    };
    let area = |k: f64| {
        let (x, y) = (60.0 - 20.0 * k, 50.0 - 12.0 * k);
        0.5 * ((240.0 - 2.0 * x) + (270.0 - 2.0 * x)) * (380.0 - 2.0 * y) / 100.0
    };
    let layers =
        svg(300.0, 420.0, &nest(|k| format!(" inkscape:groupmode='layer' inkscape:label='Size {}'", 10 + 2 * k)));
    let drawing = read(&layers);
    assert_areas(&drawing, &[("Size_10", area(0.0)), ("Size_12", area(1.0)), ("Size_14", area(2.0))]);
    assert!(pieces(&drawing).iter().all(|p| p.allowance.is_none() && p.holes.is_empty()));
    assert!(says(&drawing.notes, &["10, 12, 14", "--size"]) && drawing.sizes == ["10", "12", "14"]);
    let one = |size: &str| read_svg_text_as(&layers, &SvgOptions { unit: None, size: Some(size.to_owned()) });
    assert_areas(&one("12").expect("a size"), &[("Size_12", area(1.0))]);
    let refused = one("16").expect_err("no such size").to_string();
    assert!(refused.contains("'16'") && refused.contains("10, 12, 14"), "{refused}");
    // Of which nothing is said: they do not keep their distance, as a seam and its stitching do.
    let drawing = read(&svg(300.0, 420.0, &nest(|_| String::new())));
    let mut found: Vec<f64> = areas(&drawing).iter().map(|a| a.1).collect();
    found.sort_by(f64::total_cmp);
    let wanted = [0.0, 1.0, 2.0].map(area);
    assert!(found.iter().zip(wanted).all(|(f, w)| (f / w - 1.0).abs() < 5e-4) && found.len() == 3, "{found:?}");
}

/// Programs have meant different things by a number without a unit; what is assumed is said.
#[test]
fn a_drawing_without_a_unit_is_read_as_its_program_meant() {
    let drawing = |head: &str, root: &str, side: f64| {
        format!(
            "{head}<svg xmlns='http://www.w3.org/2000/svg' {root}><path id='p' d='M 10 10 H {0} V {0} H 10 Z'/></svg>",
            10.0 + side
        )
    };
    let adobe = "<!-- Generator: Adobe Illustrator 27.0, SVG Export Plug-In -->";
    let sheet = "width='900px' height='900px' viewBox='0 0 900 900'";
    let old = "xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' width='900' height='900' \
               inkscape:version='0.91 r13725'";
    let new = old.replace("0.91", "1.2");
    for (text, per_inch, said) in [
        (drawing(adobe, sheet, 720.0), 72.0, "72 units"),
        (drawing("", old, 720.0), 90.0, "90 units"),
        (drawing("", &new, 720.0), 96.0, "96 to the inch"),
        (drawing("", sheet, 720.0), 96.0, "96 to the inch"),
    ] {
        let read = read(&text);
        let side = 720.0 / per_inch * 2.54;
        assert_areas(&read, &[("p", side * side)]);
        assert!(says(&read.notes, &[said, "--units"]), "{:?}", read.notes);
        let points = SvgOptions { unit: Some(0.0254 / 72.0), size: None };
        let said = read_svg_text_as(&text, &points).expect("a piece");
        assert_areas(&said, &[("p", 25.4 * 25.4)]);
        assert!(said.notes.is_empty(), "{:?}", said.notes);
    }
    assert!(read(&drawing(adobe, "width='9in' height='9in' viewBox='0 0 900 900'", 720.0)).notes.is_empty());
}

#[test]
fn a_bare_ampersand_is_forgiven() {
    let text = svg(
        200.0,
        200.0,
        "\n<g id='tie'>\n<path data-text='black & white &amp; red' d='M 9 9 h 50 v 90 h -50 z'/></g>",
    );
    let drawing = read(&text);
    assert_areas(&drawing, &[("tie", 45.0)]);
    assert!(says(&drawing.notes, &["'&'", "line 3"]), "{:?}", drawing.notes);
    assert!(read_svg_text(&text.replace("</g>", "")).expect_err("no XML").to_string().contains("not an SVG file"));
}

#[test]
fn an_arrow_in_one_path_is_the_grain() {
    let arrow = "M 100 40 V 260 M 96 50 L 100 40 L 104 50 M 96 250 L 100 260 L 104 250";
    let inside = format!("<g id='panel'><path d='M 20 20 H 180 V 280 H 20 Z'/><path d='{arrow}'/></g>");
    let piece = pieces(&read(&svg(200.0, 300.0, &inside))).remove(0);
    let mut ends = piece.grain.expect("a grain").value;
    ends.sort_by(|a, b| a[1].total_cmp(&b[1]));
    assert_eq!(ends, [[80.0, 20.0], [80.0, 240.0]]);
    assert!(piece.lines.is_empty() && piece.holes.is_empty() && piece.notches.is_empty());
}

#[test]
fn a_pair_that_is_cut_several_times_is_several_pairs() {
    let piece =
        "<g id='tab'><path d='M 20 20 H 120 L 140 80 H 20 Z'/><text x='40' y='50'>Tab: cut 6 mirrored</text></g>";
    let file = made(&read(&svg(160.0, 100.0, piece)));
    let names: Vec<&str> = file.file.pieces.iter().map(|p| p.name.value.as_str()).collect();
    assert_eq!(names, ["tab", "tab_2", "tab_3"]);
    assert_eq!(file.file.pieces[0].cut.as_ref().map(|c| &c.value), Some(&CutKind::Pair));
    assert!(file.file.pieces[1..].iter().all(|p| p.like.as_ref().is_some_and(|l| l.value == "tab")));
    assert!(says(&file.notes, &["3 times", "3 left and 3 right"]), "{:?}", file.notes);
}

/// A notch on the fold does not end it; a neck opening within it makes the whole piece one with a hole.
#[test]
fn a_fold_is_whole_where_it_is_interrupted() {
    let fold = |outline: &str, more: &str| {
        let inside = format!(
            "<g id='front'><path class='fabric' d='{outline}'/><path class='fold' d='M 20 20 V 320'/>{more}</g>"
        );
        read(&svg(300.0, 340.0, &inside))
    };
    let notch = "<path class='notch' d='M 20 150 h 8'/><path class='notch' d='M 20 230 h 8'/>";
    let notched = fold("M 20 20 H 180 V 320 H 20 Z", notch);
    let piece = pieces(&notched).remove(0);
    let outline = piece.outline.expect("an outline");
    let Some(CutKind::Fold(edge)) = piece.cut.map(|c| c.value) else { panic!("no fold") };
    assert!(outline.edges.len() == 4 && outline.edges.iter().any(|e| e.0.value == edge), "{:?}", outline.edges);
    assert_areas(&notched, &[("front", 480.0)]);
    // The opening is 60 mm deep and 100 mm wide in the middle of the fold.
    let opened = fold("M 20 20 H 180 V 320 H 20 V 220 H 80 V 120 H 20 Z", "");
    assert_areas(&opened, &[("front", 960.0)]);
    let file = made(&opened);
    let piece = &file.file.pieces[0];
    assert!(piece.cut.is_none() && piece.holes.len() == 1 && says(&file.notes, &["interrupted", "hole"]), "{piece:?}");
}

/// FreeSewing's outlines may be open where the fold is.
#[test]
fn an_outline_may_be_open_at_its_fold() {
    let inside = "<g id='fs-stack-some.front'><path class='fabric' d='M 20 20 H 200 L 220 400 H 20'/>\
                  <path class='fabric' d='M 60 100 H 120'/>\
                  <path class='note' marker-start='url(#cutonfoldFrom)' d='M 20,40 L 35,40 L 35,380 L 20,380'/></g>";
    let drawing = read(&svg(240.0, 420.0, inside));
    assert_areas(&drawing, &[("front", 0.5 * (180.0 + 200.0) * 380.0 / 100.0)]);
    let piece = pieces(&drawing).remove(0);
    assert_eq!(piece.cut.map(|c| c.value), Some(CutKind::Fold("fold".to_owned())));
    assert_eq!(piece.lines.len(), 1);
}

#[test]
fn a_second_fold_is_said() {
    let inside = "<g id='flounce'>\
                  <path class='fabric' d='M 120 20 A 100 100 0 0 1 20 120 V 320 A 300 300 0 0 0 320 20 Z'/>\
                  <path class='fold' d='M 20 120 V 320'/><path class='fold' d='M 120 20 H 320'/></g>";
    let file = made(&read(&svg(340.0, 340.0, inside)));
    assert!(matches!(file.file.pieces[0].cut.as_ref().map(|c| &c.value), Some(CutKind::Fold(_))));
    assert!(says(&file.notes, &["'flounce'", "two folds"]), "{:?}", file.notes);
}

/// FreeSewing's symbols, which an import of ours once left out.
#[test]
fn buttons_and_buttonholes_are_closures() {
    let high = |id: &str, x: f64, high: f64, inside: &str| {
        format!("<g id='{id}'><path class='fabric' d='M {x} 20 h 120 v {high} h -120 Z'/>{inside}</g>")
    };
    let panel = |id: &str, x: f64, inside: &str| high(id, x, 300.0, inside);
    let symbols = |symbol: &str, x: f64, at: &[f64]| -> String {
        at.iter().map(|y| format!("<use xlink:href='#{symbol}' x='{x}' y='{y}'/>")).collect()
    };
    let closures = |inside: &str| {
        let made = made(&read(&svg(900.0, 340.0, inside)));
        let name = |name: &Option<toile::pattern::Located<String>>| name.as_ref().map_or("", |n| &n.value).to_owned();
        let at = |at: &[toile::pattern::Located<[f64; 2]>]| at.iter().map(|p| p.value).collect::<Vec<_>>();
        let one = |c: &toile::pattern::ClosureFile| {
            (c.kind.value.clone(), name(&c.on), at(&c.at), name(&c.meets), at(&c.meets_at))
        };
        (made.file.closures.iter().map(one).collect::<Vec<_>>(), made.notes)
    };
    let left = panel("left_front", 20.0, &symbols("button", 130.0, &[220.0, 60.0, 140.0]));
    let holes = symbols("buttonhole", 230.0, &[60.0, 140.0, 220.0]);
    let right = high("right_front", 220.0, 310.0, &holes);
    let band = panel("band", 420.0, &(symbols("snap-stud", 430.0, &[40.0]) + &symbols("snap-socket", 530.0, &[40.0])));
    let (found, notes) = closures(&(left.clone() + &right + &band));
    let down = |x: f64| vec![[x, 40.0], [x, 120.0], [x, 200.0]];
    let both = |on: &str, meets: &str| (on.to_owned(), meets.to_owned());
    let (front, snap) = (both("left_front", "right_front"), both("band", "band"));
    let buttoned = ("button".to_owned(), front.0, down(110.0), front.1, down(10.0));
    let snapped = ("snap".to_owned(), snap.0, vec![[10.0, 20.0]], snap.1, vec![[110.0, 20.0]]);
    assert_eq!(found, [buttoned, snapped], "{notes:?}");
    assert!(!says(&notes, &["close"]), "{notes:?}");
    // Each of a pair of cuffs meets itself; the halves of a front meet each other.
    let pair = |id: &str, inside: &str| panel(id, 20.0, &format!("<text x='50' y='150'>cut 1 pair</text>{inside}"));
    let ends = symbols("button", 30.0, &[40.0]) + &symbols("buttonhole", 130.0, &[40.0]);
    let meeting: Vec<_> = closures(&pair("cuff", &ends)).0.into_iter().map(|c| (c.1, c.3)).collect();
    assert_eq!(meeting, [both("cuff.L", "cuff.L"), both("cuff.R", "cuff.R")]);
    let over = symbols("button", 30.0, &[40.0, 90.0]) + &symbols("buttonhole", 30.0, &[90.0, 40.0]);
    let found = closures(&pair("front", &over)).0;
    assert!(
        found.len() == 1 && (&*found[0].1, &*found[0].3) == ("front", "front") && found[0].4.is_empty(),
        "{found:?}"
    );
    // So do those of a front that is drawn twice, left and right.
    let found = closures(&(left.clone() + &panel("right_front", 220.0, &holes))).0;
    assert!(found.len() == 1 && found[0].2 == down(110.0) && found[0].4.is_empty(), "{found:?}");
    assert_eq!((&*found[0].1, &*found[0].3), ("front", "front"));
    // Nothing tells what these close: they are marks, which is said.
    let (found, notes) = closures(&(left + &high("right_front", 220.0, 310.0, &symbols("buttonhole", 230.0, &[60.0]))));
    let kinds: Vec<_> = found.iter().map(|c| (&*c.0, &*c.1, &*c.3, c.2.len())).collect();
    assert_eq!(kinds, [("button", "left_front", "", 3), ("buttonhole", "right_front", "", 1)]);
    assert!(says(&notes, &["the buttons on 'left_front' close", "'meets'"]), "{notes:?}");
}

/// A scale beyond all numbers makes coordinates that are none: refused, with the place. The fuzz found it.
#[test]
fn a_drawing_of_infinite_size_is_refused() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='1e3080cm' height='.0cm' viewBox='0 0 1200 800'>\n\
                <path d='M 0 0 L 0 300 M -4 12 L 0 0 L 4 12'/></svg>";
    let error = read_svg_text(text).expect_err("no size").to_string();
    assert!(error.contains("line 2") && error.contains("a path of this size"), "{error}");
}

/// Valentina draws a button as a ring with a cross over it and a buttonhole as a line between bars, each in one path.
#[test]
fn symbols_of_buttons_and_buttonholes_are_closures() {
    let ring = |x: f64, y: f64| {
        let corner = |k: u32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 24.0).sin_cos();
            format!("{} {:.4} {:.4}", if k == 0 { "M" } else { "L" }, x + 4.25 * cos, y + 4.25 * sin)
        };
        let ring: Vec<String> = (0..=24).map(corner).collect();
        format!("M {x} {} V {} M {} {y} H {} {}", y - 5.0, y + 5.0, x - 5.0, x + 5.0, ring.join(" "))
    };
    let hole = |x: f64, y: f64| {
        let [left, right] = [x - 11.0, x + 11.0];
        format!("M {left} {y} H {right} M {left} {} V {} M {right} {} V {}", y - 3.0, y + 3.0, y - 3.0, y + 3.0)
    };
    let panel = |name: &str, left: f64, marks: &[String]| {
        let paths: Vec<String> = marks.iter().map(|d| format!("<path d='{d}' fill='none' stroke='black'/>")).collect();
        format!(
            "<g id='{name}'><path d='M {left} 20 h 160 v 300 h -160 z' fill='none' stroke='black'/>{}</g>",
            paths.concat()
        )
    };
    let right = panel("right_front", 20.0, &[60.0, 140.0, 220.0].map(|y| ring(40.0, y)));
    let left = panel("left_front", 220.0, &[60.0, 140.0, 220.0].map(|y| hole(360.0, y)));
    let drawing = read(&svg(420.0, 340.0, &(right + &left)));
    let made = made(&drawing);
    let [closure] = &made.file.closures[..] else { panic!("{:?} {:?}", made.file.closures, made.notes) };
    let points = |at: &[toile::pattern::Located<[f64; 2]>]| -> Vec<[f64; 2]> {
        at.iter().map(|p| p.value.map(f64::round)).collect()
    };
    let name = |at: &Option<toile::pattern::Located<String>>| at.as_ref().map(|name| name.value.clone());
    // Left and right are a pair, whose buttonholes lie over its buttons.
    assert_eq!([name(&closure.on), name(&closure.meets)], [Some("front".to_owned()), Some("front".to_owned())]);
    assert_eq!(points(&closure.at), [[20.0, 40.0], [20.0, 120.0], [20.0, 200.0]]);
    let pieces = pieces(&drawing);
    assert!(pieces.iter().all(|p| p.lines.is_empty() && p.holes.is_empty() && p.grain.is_none()), "{pieces:?}");
}

#[test]
fn letters_of_an_svg_are_those_of_its_encoding() {
    let room = Room::new();
    let drawing = |encoding: &str| {
        let inside = "<path id='R\u{fc}cken' d='M 20 20 h 120 v 300 h -120 Z'/>";
        format!("<?xml version='1.0' encoding='{encoding}'?>\n{}", svg(200.0, 340.0, inside))
    };
    let utf16 = drawing("UTF-16").encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    let latin: Vec<u8> = drawing("ISO-8859-1").chars().map(|c| c as u8).collect();
    for bytes in [[&[0xff, 0xfe], &utf16[..]].concat(), latin] {
        let path = room.0.path().join("drawing.svg");
        std::fs::write(&path, bytes).expect("a file");
        let drawing = toile::io::svg_read::read_svg(&path, &SvgOptions::default()).expect("a drawing");
        assert_areas(&drawing, &[("R\u{fc}cken", 360.0)]);
        assert!(drawing.notes.is_empty(), "{:?}", drawing.notes);
    }
    // Letters that are not those of the encoding that is said are read all the same, and this is said.
    let wrong: Vec<u8> = drawing("UTF-8").chars().map(|c| c as u8).collect();
    std::fs::write(room.0.path().join("wrong.svg"), wrong).expect("a file");
    let (code, said) = room.run(&["import", "svg", "wrong.svg", "-o", "wrong.yaml"]);
    assert!(
        code == Some(0) && said.contains("is not UTF-8") && room.text("wrong.yaml").contains("R\u{fc}cken:"),
        "{said}"
    );
}

// DXF

/// A block with its texts and entities.
fn block(name: &str, texts: &[&str], entities: &str) -> String {
    let texts: String = texts.iter().map(|t| format!("0\nTEXT\n8\n1\n10\n30\n20\n30\n1\n{t}\n")).collect();
    format!("0\nBLOCK\n8\n1\n2\n{name}\n70\n0\n{texts}{entities}0\nENDBLK\n8\n1\n")
}

/// A file of blocks and of what stands beside them.
fn dxf(blocks: &str, entities: &str) -> String {
    format!(
        "0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nTEXT\n8\n1\n10\n0\n20\n-50\n1\n\
         Units: METRIC\n{entities}0\nENDSEC\n0\nEOF\n"
    )
}

fn line(on: u32, closed: bool, points: &[[f64; 2]]) -> String {
    let vertices: String = points.iter().map(|p| format!("0\nVERTEX\n8\n{on}\n10\n{}\n20\n{}\n", p[0], p[1])).collect();
    format!("0\nPOLYLINE\n8\n{on}\n66\n1\n70\n{}\n{vertices}0\nSEQEND\n8\n{on}\n", u8::from(closed))
}

fn rectangle(on: u32, [x, y]: [f64; 2], [w, h]: [f64; 2]) -> String {
    line(on, true, &[[x, y], [x + w, y], [x + w, y + h], [x, y + h]])
}

fn point(on: u32, [x, y]: [f64; 2]) -> String {
    format!("0\nPOINT\n8\n{on}\n10\n{x}\n20\n{y}\n")
}

fn from_dxf(text: &str) -> Drawing {
    read_dxf_text(text, None).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Where the notches of the only piece are, x to the right and y down from its upper left corner, and which are double.
fn notches(drawing: &Drawing) -> Vec<([f64; 2], bool)> {
    let yaml = write(&made(drawing).file).expect("YAML");
    let loaded = read_text("drawing", "drawing.yaml", &yaml).expect("a garment");
    let piece = &drawings(&loaded.file, &loaded.garment)[0];
    let place = |n: &toile::pattern::DrawnNotch| {
        let p = piece.rings[n.edge.0][n.edge.1].path.point(n.at);
        ([(p.x * 1e3).round(), (p.y * 1e3).round()], n.double)
    };
    piece.notches.iter().map(place).collect()
}

#[test]
fn of_a_graded_file_the_sample_size_is_read_or_the_one_that_is_asked_for() {
    let graded = |text: bool| -> String {
        ["38", "40", "42"]
            .iter()
            .enumerate()
            .map(|(k, size)| {
                let wide = 200.0 + 10.0 * k as f64;
                let told = format!("Size: {size}");
                let part = |name: &str, wide: f64| {
                    let piece = format!("Piece Name: {name}");
                    let texts = if text { vec![piece.as_str(), told.as_str()] } else { Vec::new() };
                    block(&format!("{name}_{size}"), &texts, &rectangle(1, [0.0, 0.0], [wide, 300.0]))
                };
                part("FRONT", wide) + &part("BACK", wide + 6.0)
            })
            .collect()
    };
    let sample = "0\nTEXT\n8\n1\n10\n0\n20\n-60\n1\nSample Size: 42\n";
    let sized =
        |text: &str, size: &str| read_dxf_text_as(text, &DxfOptions { unit: None, size: Some(size.to_owned()) });
    for by_text in [true, false] {
        let file = dxf(&graded(by_text), sample);
        let drawing = from_dxf(&file);
        assert_areas(&drawing, &[("FRONT", 660.0), ("BACK", 678.0)]);
        assert!(says(&drawing.notes, &["38, 40, 42", "42 is read", "sample"]), "{:?}", drawing.notes);
        assert_areas(&sized(&file, "38").expect("a size"), &[("FRONT", 600.0), ("BACK", 618.0)]);
        let refused = sized(&file, "44").expect_err("no such size").to_string();
        assert!(refused.contains("'44'") && refused.contains("38, 40, 42"), "{refused}");
        // Without a sample the middle one.
        let drawing = from_dxf(&dxf(&graded(by_text), ""));
        assert_areas(&drawing, &[("FRONT", 630.0), ("BACK", 648.0)]);
        assert!(says(&drawing.notes, &["40 is read", "middle"]), "{:?}", drawing.notes);
    }
    // Two pockets are no sizes of one, and pieces of one name and several materials no sizes either.
    let pocket = |k: usize| block(&format!("POCKET-{k}"), &[], &rectangle(1, [0.0, 0.0], [90.0, 100.0 + k as f64]));
    assert_eq!(from_dxf(&dxf(&(pocket(1) + &pocket(2)), "")).pieces.len(), 2);
    let of = |material: &str| {
        let material = format!("Material: {material}");
        block("F", &["Piece Name: FRONT", &material], &rectangle(1, [0.0, 0.0], [200.0, 300.0]))
    };
    assert_areas(&from_dxf(&dxf(&(of("Self") + &of("Fuse")), "")), &[("FRONT", 600.0), ("FRONT_Fuse", 600.0)]);
}

/// The text of a grade rule at the point that it moves.
fn rule(number: u32, [x, y]: [f64; 2]) -> String {
    format!("0\nTEXT\n8\n1\n10\n{x}\n20\n{y}\n1\n# {number}\n")
}

/// A front whose right side has a corner without a rule, with the size that it is drawn in.
fn ruled(size: &str) -> String {
    let corners = [[0.0, 0.0], [200.0, 0.0], [210.0, 150.0], [200.0, 300.0], [0.0, 300.0]];
    let rules: String =
        [(1, 0), (2, 1), (3, 3), (4, 4)].map(|(number, k): (u32, usize)| rule(number, corners[k])).concat();
    let notch = point(4, [205.0, 75.0]) + &rule(5, [205.0, 75.0]);
    let told = format!("Size: {size}");
    block("FRONT-M", &["Piece Name: FRONT", &told], &(line(1, true, &corners) + &rules + &notch))
}

const RULES: &str = "ANSI/AAMA VERSION: 1.0.0\r\nUNITS: METRIC\r\nGRADE RULE TABLE: SHIRT\r\nNUMBER OF SIZES: 3\r\n\
                     SIZE LIST: S M L \r\nSAMPLE SIZE: M\r\nRULE: DELTA 1\r\n0,0 0,0 0,0\r\nRULE: DELTA 2\r\n\
                     -10.0, 0.0  0.0, 0.0\r\n 10.0, 0.0\r\nRULE: DELTA 3\r\n-10,-5 0,0 10,6\r\nRULE: DELTA 4\r\n\
                     0,-5 0,0 0,6\r\nRULE: DELTA 5\r\n-10,-2 0,0 10,1\r\nEND\r\n";

#[test]
fn grade_rules_make_every_size_of_one() {
    let file = dxf(&ruled("M"), "");
    let sized = |file: &str, rules: &str, size: &str| {
        let options = DxfOptions { unit: None, size: Some(size.to_owned()) };
        read_graded_dxf_text(file, rules, &options).unwrap_or_else(|e| panic!("{e}"))
    };
    // A corner between two rules moves by what lies between them.
    let area = |wide: f64, high: f64| (wide * high + 0.5 * 10.0 * high) / 100.0;
    let all = [("S", area(190.0, 295.0)), ("M", area(200.0, 300.0)), ("L", area(210.0, 306.0))];
    for (size, area) in all {
        assert_areas(&sized(&file, RULES, size), &[("FRONT", area)]);
        // Drawn in another size than the sample, its ways are counted from there.
        let from_small = RULES.replace("SAMPLE SIZE: M", "SAMPLE SIZE: S");
        assert_areas(&sized(&file, &from_small, size), &[("FRONT", area)]);
    }
    let large = sized(&file, RULES, "L");
    assert_eq!((notches(&large), large.sizes.join(" ")), (vec![([215.0, 230.0], false)], "S M L".to_owned()));
    assert!(says(&large.notes, &["the rules beside the file have the sizes S, M, L: L is read"]), "{:?}", large.notes);
    // The sample size without being asked, and nothing else changes.
    let sample = read_graded_dxf_text(&file, RULES, &DxfOptions::default()).expect("a piece");
    assert_areas(&sample, &[("FRONT", area(200.0, 300.0))]);
    // Turned and mirrored as it is inserted, also by a grade reference line; in inches; with a sewing line.
    let insert = "0\nINSERT\n8\n1\n2\nFRONT-M\n10\n0\n20\n0\n41\n-1\n50\n90\n";
    assert_areas(&sized(&dxf(&ruled("M"), insert), RULES, "L"), &[("FRONT", area(210.0, 306.0))]);
    let upright = ruled("M").replace("0\nENDBLK", &(line(5, false, &[[50.0, 50.0], [50.0, 250.0]]) + "0\nENDBLK"));
    let wide = RULES.replace("RULE: DELTA 3\r\n-10,-5 0,0 10,6", "RULE: DELTA 3\r\n0,0 0,0 6,-10");
    let wide =
        wide.replace("-10.0, 0.0  0.0, 0.0\r\n 10.0, 0.0", "0,0 0,0 0,-10").replace("0,-5 0,0 0,6", "0,0 0,0 6,0");
    assert_areas(&sized(&dxf(&upright, ""), &wide, "L"), &[("FRONT", area(210.0, 306.0))]);
    let inches = RULES.replace("METRIC", "ENGLISH").replace("10,6", "0.39370079,0.23622047");
    let inches = inches.replace("\r\n 10.0, 0.0", "\r\n0.39370079, 0.0").replace("0,0 0,6", "0,0 0,0.23622047");
    assert_areas(&sized(&file, &inches, "L"), &[("FRONT", area(210.0, 306.0))]);
    let inner = [[10.0, 10.0], [190.0, 10.0], [200.0, 150.0], [190.0, 290.0], [10.0, 290.0]];
    let sewn = ruled("M").replace("0\nENDBLK", &(line(14, true, &inner) + "0\nENDBLK"));
    let inside = |size: &str| areas(&sized(&dxf(&sewn, ""), RULES, size))[0].1;
    let allowance = [("L", area(210.0, 306.0)), ("M", area(200.0, 300.0))].map(|(size, area)| area - inside(size));
    assert!((allowance[0] / allowance[1] - 1.0).abs() < 0.05 && allowance[1] > 50.0, "{allowance:?}");
    // Its distance from the cut line is that of the drawn size, edge by edge.
    let widths = |size: &str| {
        let piece = made(&sized(&dxf(&sewn, ""), RULES, size)).file.pieces.remove(0);
        let Some(AllowanceFile::Edges(edges)) = piece.allowance else { panic!("{:?}", piece.allowance) };
        edges.iter().map(|(_, width)| width.value.width.number).collect::<Vec<f64>>()
    };
    let (large, sample) = (widths("L"), widths("M"));
    let alike = large.len() == sample.len() && large.iter().zip(&sample).all(|(a, b)| (a - b).abs() <= 0.1);
    assert!(alike, "{large:?} {sample:?}");
}

#[test]
fn grade_rules_lie_beside_their_file() {
    let room = Room::new();
    room.put("shirt.dxf", &dxf(&(ruled("M") + &block("TIE", &[], &rectangle(1, [0.0, 0.0], [80.0, 900.0]))), ""));
    let import =
        |more: &[&str]| room.run(&[&["import", "dxf", "shirt.dxf", "-o", "out.yaml", "--force"], more].concat());
    let (code, said) = import(&["--size", "L"]);
    assert!(code == Some(2) && said.contains("no size 'L'"), "{said}");
    room.put("shirt.RUL", RULES);
    let (code, said) = import(&["--size", "all"]);
    assert!(code == Some(0) && said.contains("'TIE' does not say") | said.contains("'TIE' has no points"), "{said}");
    assert!(room.text("out_S.yaml").contains("L 190 295") && room.text("out_L.yaml").contains("L 210 306"));
    let (code, said) = import(&["--size", "XXL"]);
    assert!(code == Some(2) && said.contains("its sizes are S, M, L"), "{said}");
    // A table of another name is found by what the file calls it.
    std::fs::remove_file(room.0.path().join("shirt.RUL")).expect("removed");
    let named = "0\nTEXT\n8\n1\n10\n0\n20\n-60\n1\nGrade Rule Table: SHIRT_2\n";
    room.put("shirt.dxf", &dxf(&ruled("M"), named));
    room.put("SHIRT_2.rul", &RULES.replace("10,6", "10"));
    let (code, said) = import(&["--size", "L"]);
    let wrong = "SHIRT_2.rul: line 12: rule 3 has 5 numbers; two for each of the 3 sizes are expected";
    assert!(code == Some(2) && said.contains(wrong), "{said}");
    // A rule that the table has not is said.
    room.put("SHIRT_2.rul", &RULES.replace("RULE: DELTA 5", "RULE: DELTA 6"));
    let (code, said) = import(&["--size", "L"]);
    assert!(code == Some(0) && said.contains("'FRONT' names rules that the table has not (5)"), "{said}");
    assert!(room.text("out.yaml").contains("L 210 306"));
}

#[test]
fn lines_are_clipped_to_the_piece() {
    let inside = line(8, false, &[[20.0, 50.0], [150.0, 50.0]]);
    let across = line(8, false, &[[60.0, 150.0], [60.0, 240.0]]);
    let beyond = line(8, false, &[[220.0, 10.0], [260.0, 90.0]]);
    let all = rectangle(1, [0.0, 0.0], [200.0, 200.0]) + &inside + &across + &beyond + &point(13, [300.0, 10.0]);
    let drawing = from_dxf(&dxf(&block("P", &[], &all), ""));
    let lines: Vec<f64> = drawing.pieces[0].lines.iter().map(|l| l.path.length() * 1e3).collect();
    assert!(lines.len() == 2 && (lines[0] - 130.0).abs() < 1e-3 && (lines[1] - 50.0).abs() < 1e-3, "{lines:?}");
    for words in ["the parts of 1 line", "1 line of 'P' beyond", "1 drill hole"] {
        assert!(says(&drawing.left_out, &[words]), "{words}: {:?}", drawing.left_out);
    }
    made(&drawing);
}

#[test]
fn slits_in_an_outline_are_notches() {
    for tip in [194.0, 206.0] {
        for width in [0.0, 0.02, -0.02] {
            let [low, high] = [120.0 - width / 2.0, 120.0 + width / 2.0];
            let outline =
                [[0.0, 0.0], [200.0, 0.0], [200.0, low], [tip, 120.0], [200.0, high], [200.0, 300.0], [0.0, 300.0]];
            let drawing = from_dxf(&dxf(&block("SIDE", &[], &line(1, true, &outline)), ""));
            assert_areas(&drawing, &[("SIDE", 600.0)]);
            assert_eq!(notches(&drawing), [([200.0, 180.0], false)], "{tip} {width}");
        }
    }
}

#[test]
fn a_last_vertex_near_the_first_closes_the_outline() {
    for end in [[0.0, -0.2], [0.0, 0.2], [0.1, 0.0]] {
        let outline = line(1, false, &[[0.0, 0.0], [160.0, 0.0], [160.0, 180.0], [0.0, 180.0], end]);
        let drawing = from_dxf(&dxf(&block("POCKET", &[], &outline), ""));
        assert_areas(&drawing, &[("POCKET", 288.0)]);
        assert_eq!(pieces(&drawing)[0].outline.as_ref().expect("an outline").edges.len(), 4);
    }
}

/// A piece is never closed straight across: that may be half of it.
#[test]
fn an_outline_with_a_gap_is_joined_and_said_or_named_and_left_out() {
    let front = |gap: f64| {
        let one = line(1, false, &[[0.0, 0.0], [200.0, 0.0], [200.0, 300.0 - gap]]);
        let other = line(1, false, &[[200.0, 300.0], [0.0, 300.0], [0.0, gap]]);
        let whole = block("YOKE", &[], &rectangle(1, [0.0, 0.0], [200.0, 100.0]));
        from_dxf(&dxf(&(block("FRONT", &[], &(one + &other)) + &whole), ""))
    };
    let joined = front(0.4);
    let found = areas(&joined);
    assert!(found.len() == 2 && (found[0].1 / 600.0 - 1.0).abs() < 2e-3, "{found:?}");
    assert!(says(&joined.notes, &["'FRONT'", "0.40 mm", "joined"]), "{:?}", joined.notes);
    let open = front(2.0);
    assert_areas(&open, &[("YOKE", 200.0)]);
    assert!(says(&open.complaints(), &["'FRONT'", "2.00 mm apart", "left out"]), "{:?}", open.complaints());
    let alone = line(1, false, &[[0.0, 0.0], [200.0, 0.0], [200.0, 300.0], [90.0, 300.0]]);
    let refused = read_dxf_text(&dxf(&block("FRONT", &[], &alone), ""), None).expect_err("no piece").to_string();
    assert!(refused.contains("'FRONT'") && refused.contains("313.21 mm apart"), "{refused}");
}

/// AAMA has no layer for sewing lines: they are inner lines that follow the cut line all round.
#[test]
fn the_sewing_line_of_aama_is_on_the_layer_of_inner_lines() {
    let cut = rectangle(1, [-12.0, -12.0], [224.0, 324.0]);
    let pocket = rectangle(8, [60.0, 100.0], [80.0, 90.0]);
    let all = cut + &pocket + &rectangle(8, [0.0, 0.0], [200.0, 300.0]);
    let drawing = from_dxf(&dxf(&block("PANEL", &[], &all), ""));
    assert_areas(&drawing, &[("PANEL", 600.0)]);
    let piece = pieces(&drawing).remove(0);
    assert!(piece.allowance.is_some() && piece.lines.len() == 1 && piece.holes.is_empty(), "{piece:?}");
}

#[test]
fn a_notch_on_both_lines_is_one() {
    let all = rectangle(1, [-10.0, -10.0], [220.0, 320.0])
        + &rectangle(14, [0.0, 0.0], [200.0, 300.0])
        + &[[210.0, 80.0], [200.0, 80.0], [210.0, 190.0], [200.0, 190.0], [210.0, 198.0], [200.0, 198.0]]
            .map(|at| point(4, at))
            .concat();
    let drawing = from_dxf(&dxf(&block("PANEL", &[], &all), ""));
    assert_eq!(notches(&drawing), [([200.0, 106.0], true), ([200.0, 220.0], false)]);
}

#[test]
fn names_in_the_letters_of_a_code_page_are_read() {
    let text = dxf(&block("P1", &["Piece Name: XX", "Material: YY"], &rectangle(1, [0.0, 0.0], [200.0, 300.0])), "");
    let head = "0\nSECTION\n2\nHEADER\n9\n$DWGCODEPAGE\n3\nANSI_1250\n0\nENDSEC\n";
    let bytes: Vec<u8> = (head.to_owned() + &text).into_bytes();
    let replaced = |bytes: Vec<u8>, from: &[u8], to: &[u8]| {
        let at = bytes.windows(from.len()).position(|w| w == from).expect("a place");
        [&bytes[..at], to, &bytes[at + from.len()..]].concat()
    };
    // "žába" and "kůže" in Windows 1250.
    let bytes = replaced(bytes, b"XX", &[0x9e, 0xe1, b'b', b'a']);
    let bytes = replaced(bytes, b"YY", &[b'k', 0xf9, 0x9e, b'e']);
    let room = tempfile::tempdir().expect("a folder");
    let path = room.path().join("letters.dxf");
    std::fs::write(&path, bytes).expect("a file");
    let drawing = read_dxf(&path, &DxfOptions::default()).expect("a piece");
    assert_areas(&drawing, &[("žába", 600.0)]);
    assert_eq!(drawing.pieces[0].material.as_ref().map(|m| m.name.as_str()), Some("kůže"));
    assert!(drawing.notes.is_empty(), "{:?}", drawing.notes);
}

#[test]
fn a_block_is_as_large_and_turned_as_it_is_inserted() {
    let back = block(
        "BACK",
        &[],
        &(line(1, true, &[[0.0, 0.0], [8.0, 0.0], [9.0, 12.0], [0.0, 12.0]])
            + &line(7, false, &[[4.0, 2.0], [4.0, 10.0]])),
    );
    let insert = |scale: [f64; 2], turn: f64| {
        let text =
            format!("0\nINSERT\n8\n1\n2\nBACK\n10\n700\n20\n0\n41\n{}\n42\n{}\n50\n{turn}\n", scale[0], scale[1]);
        from_dxf(&dxf(&back, &text))
    };
    let area = 0.5 * 17.0 * 12.0 * 2.54 * 2.54;
    assert_areas(&insert([25.4, 25.4], 0.0), &[("BACK", area)]);
    let turned = insert([25.4, -25.4], 90.0);
    assert_areas(&turned, &[("BACK", area)]);
    let grain = turned.pieces[0].grain.expect("a grain");
    assert!((grain[1] - grain[0]).y.abs() < 1e-9, "the grain turns with it: {grain:?}");
    // A block within a block.
    let nested = block("FRONT", &[], "0\nINSERT\n8\n1\n2\nBACK\n10\n5\n20\n5\n41\n20\n42\n20\n")
        + &block("LOOP", &[], "0\nINSERT\n8\n1\n2\nLOOP\n10\n0\n20\n0\n");
    let refused = read_dxf_text(&dxf(&(back.clone() + &nested), ""), None).expect_err("no end").to_string();
    assert!(refused.contains("'LOOP'"), "{refused}");
    let nested = block("FRONT", &[], "0\nINSERT\n8\n1\n2\nBACK\n10\n5\n20\n5\n41\n20\n42\n20\n");
    let pieces = from_dxf(&dxf(&(nested + &back), "")).pieces;
    let cut = pieces[0].cut.as_ref().expect("a cut line");
    assert!((5e3 * cut.double_area().abs() - 0.5 * 17.0 * 12.0 * 4.0).abs() < 1e-6);
}

/// A side that is a cubic with the control points of a bulge of 45 mm, and one that is half an ellipse.
#[test]
fn splines_and_ellipses_are_curves() {
    let numbers = |code: i32, all: &[f64]| all.iter().map(|x| format!("{code}\n{x}\n")).collect::<String>();
    let points: String = [[200.0, 0.0], [260.0, 100.0], [260.0, 200.0], [200.0, 300.0]]
        .map(|[x, y]| format!("10\n{x}\n20\n{y}\n"))
        .concat();
    let knots = numbers(40, &[0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
    let side = format!("0\nSPLINE\n8\n1\n70\n8\n71\n3\n72\n8\n73\n4\n{knots}{points}");
    let rest = line(1, false, &[[200.0, 300.0], [0.0, 300.0], [0.0, 0.0], [200.0, 0.0]]);
    let drawing = from_dxf(&dxf(&block("FRONT", &[], &(side + &rest)), ""));
    // Beyond its chord x is 180 t (1 - t) and y 300 t: 60 · 3/6 · 300 mm² = 90 cm².
    assert_areas(&drawing, &[("FRONT", 690.0)]);
    // Half an ellipse of half axes 150 and 50 mm; with weights, a quarter of a circle of 100 mm.
    let ellipse = "0\nELLIPSE\n8\n1\n10\n200\n20\n150\n11\n0\n21\n150\n40\n0.333333333333\n\
                   41\n3.14159265359\n42\n6.28318530718\n";
    let drawing = from_dxf(&dxf(&block("FRONT", &[], &(ellipse.to_owned() + &rest)), ""));
    assert_areas(&drawing, &[("FRONT", 600.0 + std::f64::consts::PI * 15.0 * 5.0 / 2.0)]);
    let knots = numbers(40, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    let weights = numbers(41, &[1.0, 0.5_f64.sqrt(), 1.0]);
    let points: String =
        [[100.0, 0.0], [100.0, 100.0], [0.0, 100.0]].map(|[x, y]| format!("10\n{x}\n20\n{y}\n")).concat();
    let arc = format!("0\nSPLINE\n8\n1\n70\n12\n71\n2\n72\n6\n73\n3\n{knots}{weights}{points}");
    let rest = line(1, false, &[[0.0, 100.0], [0.0, 0.0], [100.0, 0.0]]);
    let drawing = from_dxf(&dxf(&block("YOKE", &[], &(arc + &rest)), ""));
    assert_areas(&drawing, &[("YOKE", std::f64::consts::PI * 100.0 / 4.0)]);
}

#[test]
fn a_drawing_without_blocks_is_read_piece_by_piece() {
    let piece = |x: f64, wide: f64, name: &str| {
        rectangle(1, [x, 0.0], [wide + 20.0, 320.0])
            + &rectangle(14, [x + 10.0, 10.0], [wide, 300.0])
            + &line(7, false, &[[x + 50.0, 40.0], [x + 50.0, 200.0]])
            + &format!("0\nTEXT\n8\n1\n10\n{}\n20\n100\n1\n{name}\n", x + 30.0)
    };
    let text = dxf("", &(piece(0.0, 180.0, "Piece Name: FRONT") + &piece(260.0, 200.0, "BACK")));
    let drawing = from_dxf(&text);
    assert_areas(&drawing, &[("FRONT", 540.0), ("BACK", 600.0)]);
    assert!(pieces(&drawing).iter().all(|p| p.allowance.is_some() && p.grain.is_some()));
}

#[test]
fn texts_of_several_lines_are_read_without_their_looks() {
    let text = "0\nMTEXT\n8\n1\n10\n30\n20\n30\n3\n{\\fArial|b0;Piece Name: CO\n1\nLLAR\\PQuantity: 1,1}\n";
    let all = text.to_owned() + &line(1, true, &[[0.0, 0.0], [200.0, 0.0], [230.0, 60.0], [10.0, 60.0]]);
    let drawing = from_dxf(&dxf(&block("B1", &[], &all), ""));
    assert_eq!((drawing.pieces[0].name.as_str(), &drawing.pieces[0].cut_how), ("COLLAR", &Some(CutKind::Pair)));
}

// The program

struct Room(tempfile::TempDir);

impl Room {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn put(&self, name: &str, text: &str) {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, text).expect("a file");
    }

    fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.0.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// The exit code and all that was said.
    fn run(&self, args: &[&str]) -> (Option<i32>, String) {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_toile"));
        let output = command.args(args).current_dir(self.0.path()).output().expect("started");
        let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8")).concat();
        (output.status.code(), said)
    }
}

#[test]
fn sizes_are_imported_one_by_one_or_all() {
    let room = Room::new();
    let part = |size: &str, wide: f64| {
        let told = format!("Size: {size}");
        block(&format!("F{size}"), &["Piece Name: FRONT", &told], &rectangle(1, [0.0, 0.0], [wide, 300.0]))
    };
    room.put("graded.dxf", &dxf(&(part("S", 200.0) + &part("M", 220.0)), ""));
    let import = |more: &[&str]| room.run(&[&["import", "dxf", "graded.dxf", "-o", "out.yaml"], more].concat());
    let (code, said) = import(&["--size", "XXL"]);
    assert!(code == Some(2) && said.contains("S, M"), "{said}");
    assert_eq!(import(&["--size", "all"]).0, Some(0));
    assert!(room.text("out_S.yaml").contains("200") && room.text("out_M.yaml").contains("220"));
    assert_eq!(import(&["--size", "M"]).0, Some(0));
    assert!(room.text("out.yaml").contains("220 300"));
}

#[test]
fn an_import_that_misses_a_piece_ends_with_1() {
    let room = Room::new();
    let open = "<g id='front'><path class='fabric' d='M 20 20 H 220 V 320 H 20 V 24'/></g>\
                <path id='yoke' d='M 260 20 h 100 v 100 h -100 Z'/>";
    room.put("open.svg", &svg(400.0, 340.0, open));
    let (code, said) = room.run(&["import", "svg", "open.svg", "-o", "open.yaml"]);
    assert!(code == Some(1) && said.contains("'front' is not closed") && said.contains("4.00 mm apart"), "{said}");
    let (code, said) = room.run(&["import", "svg", "open.svg", "-o", "open.yaml", "--force", "--json"]);
    assert!(code == Some(1) && said.contains("\"ok\": false"), "{said}");
}

#[test]
fn an_svg_has_the_unit_that_is_said() {
    let room = Room::new();
    room.put(
        "points.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 720 720'>\
         <path id='p' d='M 72 72 h 360 v 360 h -360 z'/></svg>",
    );
    let import =
        |more: &[&str]| room.run(&[&["import", "svg", "points.svg", "-o", "p.yaml", "--force"], more].concat());
    assert!(import(&[]).1.contains("--units") && room.text("p.yaml").contains("L 95.25 0"));
    assert!(!import(&["--units", "pt"]).1.contains("--units") && room.text("p.yaml").contains("L 127 0"));
    import(&["--units", "mm"]);
    assert!(room.text("p.yaml").contains("L 360 0"));
}

/// A garment file and the body that it names may be moved together.
#[test]
fn a_body_is_named_by_the_way_from_the_file() {
    let room = Room::new();
    let panel = r#"{"vertices": [[0, 0], [40, 0], [40, 50], [0, 50]], "translation": [0, 60, 20],
        "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]}, {"endpoints": [3, 0]}]}"#;
    room.put("spec.json", &format!(r#"{{"pattern": {{"panels": {{"front": {panel}}}}}}}"#));
    room.put("bodies/block.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    room.put("made/deep/keep", "");
    for (target, named) in [
        ("out.yaml", "body: bodies/block.obj"),
        ("made/out.yaml", "body: ../bodies/block.obj"),
        ("made/deep/out.yaml", "body: ../../bodies/block.obj"),
        ("bodies/out.yaml", "body: block.obj"),
    ] {
        room.run(&["import", "garmentcode", "spec.json", "--body", "bodies/block.obj", "-o", target]);
        let text = room.text(target);
        assert!(text.lines().any(|line| line == named), "{target}: {text}");
    }
}

/// A mesh is in the unit of its body, or as large as what people wear.
#[test]
fn units_of_meshes_are_guessed_and_said() {
    let room = Room::new();
    // A tetrahedron of a metre and more, and a sheet through it.
    let put = |unit: f64| {
        let points = |all: &[[f64; 3]]| -> String {
            all.iter().map(|p| format!("v {} {} {}\n", p[0] * unit, p[1] * unit, p[2] * unit)).collect()
        };
        let tent = points(&[[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.5], [0.0, 1.7, 0.2]]);
        room.put("tent.obj", &(tent + "f 1 2 3\nf 2 1 4\nf 3 2 4\nf 1 3 4\n"));
        room.put("cuff.obj", &(points(&[[0.0, 0.3, -0.1], [0.1, 0.3, 0.15], [-0.1, 0.31, 0.15]]) + "f 1 2 3\n"));
    };
    for (unit, name) in [(1.0, "metres"), (100.0, "centimetres"), (1000.0, "millimetres")] {
        put(unit);
        let (code, said) = room.run(&["check", "--mesh", "cuff.obj", "--body", "tent.obj"]);
        assert!(code == Some(1) && said.contains(&format!("{name} assumed")), "{unit}: {said}");
        assert!(said.contains("3"), "{said}");
    }
    let (code, said) = room.run(&["check", "--mesh", "cuff.obj", "--body", "tent.obj", "--units", "mm"]);
    assert!(code == Some(1) && !said.contains("assumed"), "{said}");
}

/// Letters of every script of the Basic Multilingual Plane are printed, and can be searched; what is not is said.
#[test]
fn letters_of_other_scripts_are_printed() {
    let room = Room::new();
    let garment = "garment: 1\nname: 半袖\npieces:\n  жилет:\n    \
                   outline: {start: 0 0, a: L 200 0, b: L 200 300, c: L 0 0}\nfree: ['*.*']\n";
    room.put("vest.yaml", garment);
    let (code, said) = room.run(&["export", "pdf", "vest.yaml", "-o", "vest.pdf"]);
    assert!(code == Some(0) && !said.contains("glyphs"), "{said}");
    let pdf = std::fs::read(room.0.path().join("vest.pdf")).expect("a PDF");
    let pdf = String::from_utf8_lossy(&pdf);
    // A font for each 256 letters, with the letters of its codes.
    assert!(pdf.contains("/Subtype /Type3") && pdf.contains("/uni0436") && pdf.contains("/uni534A"));
    assert!(pdf.contains("<36> <0436>"), "no map to Unicode");
    room.put("vest.yaml", &garment.replace("半袖", "vest \u{1f600}"));
    let (code, said) = room.run(&["export", "pdf", "vest.yaml", "-o", "vest.pdf"]);
    assert!(code == Some(0) && said.contains("no glyphs for \u{1f600}"), "{said}");
}

/// The ending of a file says its format; where it does not, the formats are named.
#[test]
fn the_format_of_an_import_may_be_left_out() {
    let room = Room::new();
    room.put("skirt.svg", &svg(300.0, 400.0, "<path id='front' d='M 10 10 H 210 V 310 H 10 Z'/>"));
    let (code, said) = room.run(&["import", "skirt.svg", "-o", "skirt2.yaml"]);
    assert!(code == Some(0) && said.contains("1 piece"), "{said}");
    let (code, said) = room.run(&["import", "-o", "skirt3.yaml", "skirt.svg"]);
    assert!(code == Some(0) && said.contains("1 piece"), "{said}");
    let (code, said) = room.run(&["import", "skirt.plt", "-o", "skirt4.yaml"]);
    assert!(code == Some(2) && said.contains("toile import dxf FILE") && !said.contains("unrecognized"), "{said}");
}

/// Titles in the largest letters name pieces that no group names, and numbers are kept.
#[test]
fn titles_name_pieces() {
    let text =
        |x: f64, y: f64, size: f64, words: &str| format!("<text x='{x}' y='{y}' font-size='{size}'>{words}</text>");
    let inside = ["<path d='M 10 10 H 210 V 310 H 10 Z'/>", "<path d='M 300 10 H 500 V 310 H 300 Z'/>"].concat()
        + &text(100.0, 100.0, 12.0, "Front")
        + &text(100.0, 120.0, 6.0, "Blouse of May")
        + &text(100.0, 140.0, 30.0, "2")
        + &text(100.0, 160.0, 6.0, "cut 2")
        + &text(400.0, 100.0, 12.0, "Back yoke")
        + &text(400.0, 120.0, 6.0, "Size: 38");
    let drawing = read(&svg(600.0, 400.0, &inside));
    let pieces = pieces(&drawing);
    let names: Vec<&str> = pieces.iter().map(|piece| piece.name.value.as_str()).collect();
    assert_eq!(names, ["Front", "Back_yoke"]);
    let note = |k: usize| pieces[k].note.as_ref().map(|note| note.value.as_str());
    assert_eq!([note(0), note(1)], [Some("no. 2 of the drawing"), None]);
    assert!(says(&drawing.left_out, &["2 texts"]), "{:?}", drawing.left_out);
}

/// Of sizes that lie over one another each is sewn by itself.
#[test]
fn sizes_are_not_sewn_to_each_other() {
    let piece = |id: &str, x: f64, grow: f64| {
        format!("<path id='{id}' d='M {x} 10 h {} l 20 {} h {} Z'/>", 150.0 + grow, 300.0 + grow, -170.0 - grow)
    };
    let size = |name: &str, grow: f64| {
        let pieces = piece(&format!("front{name}"), 10.0, grow) + &piece(&format!("back{name}"), 310.0, grow);
        format!("<g inkscape:groupmode='layer' inkscape:label='size {name}'>{pieces}</g>")
    };
    let drawing = read(&svg(600.0, 400.0, &(size("36", 0.0) + &size("38", 4.0) + &size("40", 8.0))));
    assert_eq!(drawing.pieces.len(), 6);
    let made = made(&drawing);
    assert!(!made.suggestions.is_empty());
    for own in &made.suggestions {
        let edges = own.sew.iter().chain(&own.to).filter(|edge| *edge != "mirror");
        let mut sizes: Vec<Option<&str>> =
            edges.map(|edge| ["36", "38", "40"].into_iter().find(|size| edge.contains(size))).collect();
        sizes.dedup();
        assert_eq!(sizes.len(), 1, "{own:?}");
    }
}
