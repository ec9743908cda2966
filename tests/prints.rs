//! What is printed beside the lines: labels off the joins of pages, squares to measure, layers, the order of sewing.

use toile::cutting::{CuttingOptions, Label, Layout, Paper, PaperLayer, Sheet, labelled, layers, nested, sewing_order};
use toile::geometry::Vec2;
use toile::io::garment::{Loaded, read_text};
use toile::io::pdf_write::{Page, booklet, one_page};
use toile::io::svg_write::cutting_svg;
use toile::pattern::drawings;

/// A bodice whose band is written before the shoulders that it needs, and whose dart is in its waist.
const BODICE: &str = "garment: 1
name: Bodice
fabrics: {shell: cotton_poplin, lining: silk_charmeuse}
pieces:
  front:
    fabric: shell
    cut: pair
    grain: [[100, 400], [100, 100]]
    outline:
      {start: 0 60, neck: L 80 0, shoulder: L 180 30, armhole: L 220 200, side: L 220 420, waist: L 140 420,
       leg_a: L 120 320, leg_b: L 100 420, waist_in: L 0 420, center: L 0 60}
  back:
    fabric: lining
    cut: pair
    grain: [[100, 400], [100, 100]]
    outline:
      {start: -80 0, neck: L 0 20, center: L 0 420, waist: L -220 420, side: L -220 200, armhole: L -180 30,
       shoulder: L -80 0}
  band:
    fabric: shell
    cut: pair
    grain: [[10, 40], [170, 40]]
    outline: {start: 0 0, top: L 182.46 0, front_end: L 182.46 50, neck: L 0 50, back_end: L 0 0}
seams:
  band: {sew: band.neck, to: [front.neck, back.neck]}
  shoulder: {sew: front.shoulder, to: back.shoulder}
  side: {sew: front.side, to: back.side}
  dart: {sew: front.leg_a, to: front.leg_b}
free: ['*.*']
";

fn loaded(text: &str) -> Loaded {
    read_text("bodice", "bodice.yaml", text).unwrap_or_else(|e| panic!("{e}"))
}

fn papers(loaded: &Loaded) -> Vec<Paper> {
    let label = Label { title: "Bodice".into(), wearer: Some("Ada".into()), date: None };
    labelled(&drawings(&loaded.file, &loaded.garment), &CuttingOptions::default(), &label)
}

#[test]
fn a_seam_along_several_edges_is_sewn_after_those_that_join_them() {
    let steps: Vec<String> = sewing_order(&loaded(BODICE).garment).iter().map(|step| step.words()).collect();
    let place = |name: &str| steps.iter().position(|s| s.starts_with(name)).unwrap_or_else(|| panic!("{steps:?}"));
    assert!(place("shoulder") < place("band"), "{steps:?}");
    assert_eq!(steps[place("shoulder")], "shoulder, left and right: front.shoulder to back.shoulder");
    assert_eq!(steps[place("band")], "band, left and right: band.neck to front.neck + back.neck");
    assert_eq!(steps.len(), 4);
}

/// Of pieces on the fold both halves are sewn alike: the step names neither.
#[test]
fn a_step_on_both_sides_names_no_side() {
    let text = BODICE
        .replace("  back:\n    fabric: lining\n    cut: pair", "  back:\n    fabric: lining\n    cut: fold center");
    let steps: Vec<String> = sewing_order(&loaded(&text).garment).iter().map(|step| step.words()).collect();
    assert!(steps.contains(&"side, left and right: front.side to back.side".to_owned()), "{steps:?}");
}

/// The sizes of a garment lie over one another, each with its name and in a layer of its own; one label for all.
#[test]
fn sizes_are_nested_in_layers() {
    let sized = |by: f64| {
        let text = BODICE
            .replace("L 220 420", &format!("L {} 420", 220.0 + by))
            .replace("L 220 200", &format!("L {} 200", 220.0 + by));
        let text = text
            .replace("-220 420", &format!("{} 420", -220.0 - by))
            .replace("-220 200", &format!("{} 200", -220.0 - by));
        papers(&loaded(&text))
    };
    let names = ["38", "40", "42"].map(str::to_owned);
    let nest = nested(names.iter().cloned().zip([0.0, 8.0, 16.0].map(sized)).collect());
    assert_eq!(nest.len(), 3 * 4);
    let of =
        |material: &str, size: Option<&str>| PaperLayer { material: material.into(), size: size.map(str::to_owned) };
    let sizes = [None, Some("38"), Some("40"), Some("42")];
    let wanted: Vec<PaperLayer> = ["shell", "lining"].iter().flat_map(|m| sizes.map(|size| of(m, size))).collect();
    assert_eq!(layers(&nest), wanted);
    let sheet = Sheet::new(&nest, &Layout::default());
    let front: Vec<&Paper> = sheet.papers.iter().filter(|paper| paper.name == "front").collect();
    let label: Vec<&str> = front[0].texts.iter().map(|t| t.text.as_str()).collect();
    assert!(label[0] == "front" && front[0].cut.is_empty(), "{label:?}");
    for (paper, name) in front[1..].iter().zip(&names) {
        assert_eq!(paper.texts.iter().map(|t| &t.text).collect::<Vec<_>>(), [name]);
    }
    // They are not laid beside each other: the neck is where it is in every size.
    let neck = |paper: &Paper| paper.sew.iter().find(|line| line.name == "neck").map(|line| line.path.start());
    let necks: Vec<Option<Vec2>> = front[1..].iter().map(|paper| neck(paper)).collect();
    assert!(necks.iter().all(|place| place.is_some() && *place == necks[0]), "{necks:?}");
    let svg = cutting_svg("Bodice", &sheet);
    assert!(svg.contains("inkscape:label=\"material shell, size 40\"") && svg.contains("data-size=\"40\""));
    let pdf = booklet("Bodice", &nest, &[], Page::A4).expect("pages");
    assert!(String::from_utf8_lossy(&pdf).contains("(lining, size 42)"));
}

#[test]
fn later_stages_are_sewn_later() {
    let text = BODICE.replace("to: back.side}", "to: back.side, stage: 2}");
    let steps: Vec<String> = sewing_order(&loaded(&text).garment).into_iter().map(|step| step.name).collect();
    assert_eq!(steps.last().map(String::as_str), Some("side"), "{steps:?}");
}

/// What lines between pages cut a text: each by where it is.
fn cut_by(paper: &Paper, joins: &[[Vec2; 2]]) -> Vec<[Vec2; 2]> {
    let meets =
        |[low, high]: [Vec2; 2], [a, b]: [Vec2; 2]| (0..2).all(|k| a[k].max(b[k]) > low[k] && a[k].min(b[k]) < high[k]);
    joins.iter().copied().filter(|join| paper.lettered().any(|text| meets(text, *join))).collect()
}

#[test]
fn labels_keep_clear_of_the_joins_of_pages() {
    let papers = papers(&loaded(BODICE));
    for paper in &papers[..2] {
        let [low, high] = paper.extent();
        let mut cut = 0;
        for share in [0.3, 0.4, 0.5, 0.6, 0.7] {
            let at = low + (high - low) * share;
            let joins =
                [[Vec2::new(at.x, low.y), Vec2::new(at.x, high.y)], [Vec2::new(low.x, at.y), Vec2::new(high.x, at.y)]];
            cut += cut_by(paper, &joins).len();
            let moved = paper.lettered_clear_of(&joins);
            assert!(cut_by(&moved, &joins).is_empty(), "'{}' at {share}", paper.name);
            let has = |start: &str| moved.texts.iter().any(|t| t.text.starts_with(start));
            assert!(has(&paper.name) && has("cut 2"), "{:?}", moved.texts);
        }
        assert!(cut > 0, "no join cut a label of '{}' before", paper.name);
    }
}

/// Height and place of every text of the pages of a PDF: the page's number, then millimetres from its left and foot.
fn texts(pdf: &[u8]) -> Vec<(usize, String, [f64; 2])> {
    let text: String = pdf.iter().map(|&b| char::from(b)).collect();
    let pages = text.split("stream\n").skip(1).step_by(2).map(|s| s.split("endstream").next().unwrap_or("").to_owned());
    let mut found = Vec::new();
    for (page, stream) in pages.enumerate() {
        for block in stream.split("BT\n").skip(1) {
            let Some((matrix, rest)) = block.split_once(" Tm") else { continue };
            let numbers: Vec<f64> =
                matrix.split_whitespace().rev().take(2).filter_map(|w| w.parse::<f64>().ok()).collect();
            let words = rest.split_once('(').and_then(|(_, r)| r.split_once(") Tj")).map_or("", |(w, _)| w);
            found.push((page, words.to_owned(), [numbers[1], numbers[0]].map(|n| n / 72.0 * 25.4)));
        }
    }
    found
}

#[test]
fn the_order_of_sewing_stands_behind_the_first_page() {
    let loaded = loaded(BODICE);
    let steps: Vec<String> = sewing_order(&loaded.garment).iter().map(|step| step.words()).collect();
    let pdf = booklet("Bodice", &papers(&loaded), &steps, Page::A4).expect("pages");
    let texts = texts(&pdf);
    assert!(texts.iter().any(|(page, words, _)| *page == 1 && words == "Order of sewing"), "{texts:?}");
    let numbered = texts.iter().filter(|(page, words, _)| *page == 1 && words.contains(" to ")).count();
    assert_eq!(numbered, steps.len());
    // A pattern without seams has no such page.
    let plain = booklet("Bodice", &papers(&loaded), &[], Page::A4).expect("pages");
    assert!(!self::texts(&plain).iter().any(|(_, words, _)| words == "Order of sewing"));
}

#[test]
fn many_steps_take_several_pages() {
    let steps: Vec<String> = (0..120).map(|k| format!("seam{k}: one.edge to other.edge")).collect();
    let pdf = booklet("Bodice", &papers(&loaded(BODICE)), &steps, Page::LETTER).expect("pages");
    for k in 0..120 {
        let own = format!("seam{k}: one");
        let at: Vec<[f64; 2]> = texts(&pdf).iter().filter(|t| t.1.contains(&own)).map(|t| t.2).collect();
        assert!(matches!(at.as_slice(), [[x, y]] if *x >= 14.0 && *y >= 10.0), "{own}: {at:?}");
    }
}

#[test]
fn a_square_of_two_inches_is_beside_that_of_100_mm() {
    let papers = papers(&loaded(BODICE));
    let sheet = Sheet::new(&papers, &Layout { width: Some(0.9), margin: 0.010, square: true });
    let svg = cutting_svg("Bodice", &sheet);
    let document = roxmltree::Document::parse(&svg).expect("SVG");
    let sides: Vec<f64> = document
        .descendants()
        .filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "rect")))
        .filter_map(|n| n.attribute("width").and_then(|w| w.parse().ok()))
        .collect();
    assert!(sides.len() == 2 && (sides[0] - 100.0).abs() < 1e-3 && (sides[1] - 50.8).abs() < 1e-3, "{sides:?}");
    let pdf = one_page("Bodice", &sheet).expect("a page");
    assert!(texts(&pdf).iter().any(|t| t.1 == "2 inches"));
}

#[test]
fn every_material_is_a_layer() {
    let papers = papers(&loaded(BODICE));
    let sheet = Sheet::new(&papers, &Layout::default());
    let svg = cutting_svg("Bodice", &sheet);
    let document = roxmltree::Document::parse(&svg).expect("SVG");
    let inkscape = "http://www.inkscape.org/namespaces/inkscape";
    let layers: Vec<(String, Vec<String>)> = document
        .descendants()
        .filter(|n| n.attribute((inkscape, "groupmode")) == Some("layer"))
        .map(|n| {
            let pieces = n.children().filter_map(|c| c.attribute("id").map(str::to_owned)).collect();
            (n.attribute((inkscape, "label")).unwrap_or("").to_owned(), pieces)
        })
        .collect();
    let wanted = [("material shell", vec!["front", "band"]), ("material lining", vec!["back"])];
    let wanted = wanted.map(|(name, ids)| (name.to_owned(), ids.iter().map(|s| (*s).to_owned()).collect::<Vec<_>>()));
    assert_eq!(layers, wanted);
    let pdf = one_page("Bodice", &sheet).expect("a page");
    let text: String = pdf.iter().map(|&b| char::from(b)).collect();
    assert!(text.contains("/OCProperties") && text.matches("/Type /OCG").count() == 2);
    assert_eq!((text.matches("/OC /M0 BDC").count(), text.matches("/OC /M1 BDC").count()), (2, 1), "papers per layer");
    assert_eq!(text.matches("BDC").count(), text.matches("EMC").count());
}
