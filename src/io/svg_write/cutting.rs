//! Patterns for cutting as SVG.
//!
//! A layer per material (and size, where these lie over one another), and in it a group per piece with its name as
//! id; classes `cut` (solid), `sew` (dashed; ids `piece.edge`), `fold`, `notch`, `grain`, `line`, `drill` and `text`;
//! the test squares in groups of class `scale`. A layer names its size in `data-size`. A piece's group names its
//! material in `data-material` and, where it is a fabric of the library, in `data-fabric`.
//! A notch runs from the cut line to the sewing line or, by way of a point there, beyond; `data-notch` says what
//! it belongs to, `data-edge` where it is; `data-corner` how the allowance of an edge ends, where the file says so.

use svg::node::element::{Circle, Group, Path, Text, Title};

use super::{
    centered, document, identifier, inch_square, number, polyline, printable, square, stroke, told_notch, with_kind,
};
use crate::cutting::{
    CLOTH_LETTERS, ClothLength, Lettering, MarkKind, NotchMark, Paper, PaperLayer, PaperSize, SQUARE_GAP, SewKind,
    Sheet, TEST_SQUARE, grain_arrow, layers,
};
use crate::geometry::{MM, Vec2};

/// Widths of lines, mm: what is cut, and everything else.
const CUT: f64 = 0.5;
const FINE: f64 = 0.25;
/// Dashes of the cut lines of sizes that are drawn over one another, mm.
const SIZES: [&str; 6] = ["", "3 1.5", "3 1.5 0.4 1.5", "1.5 1", "3 1 0.4 1 0.4 1", "0.4 1"];
/// Radius of a drill mark, mm.
const DRILL: f64 = 1.5;
/// Height of the test square's letters, mm.
const LETTERS: f64 = 6.0;

/// The sheet as SVG text; `title` is the garment's name.
pub fn cutting_svg(title: &str, sheet: &Sheet) -> String {
    let inkscape = "http://www.inkscape.org/namespaces/inkscape";
    let mut document = document(sheet.size * MM).set("xmlns:inkscape", inkscape).add(Title::new(printable(title)));
    for cloth in &sheet.cloth {
        document = document.add(stretch(cloth));
    }
    for layer in drawn_layers(&sheet.papers) {
        document = document.add(layer);
    }
    if let Some(corner) = sheet.square {
        document = document.add(square(corner * MM, LETTERS));
        let beside = corner + Vec2::new(TEST_SQUARE + SQUARE_GAP, 0.0);
        document = document.add(inch_square(beside * MM, LETTERS));
    }
    document.to_string()
}

/// Layers, as Inkscape has them, with the papers of each material and size.
fn drawn_layers(papers: &[Paper]) -> Vec<Group> {
    let drawn = |(k, own): (usize, &PaperLayer)| {
        let papers = papers.iter().filter(|paper| PaperLayer::of(paper) == *own);
        papers.fold(layer(k + 1, own), |group, paper| group.add(draw(paper)))
    };
    layers(papers).iter().enumerate().map(drawn).collect()
}

fn layer(number: usize, layer: &PaperLayer) -> Group {
    let mut group = Group::new().set("id", format!("layer{number}")).set("inkscape:groupmode", "layer");
    if let Some(size) = &layer.size {
        group = group.set("data-size", printable(size));
    }
    group.set("inkscape:label", format!("material {}", printable(&layer.words())))
}

/// A stretch of cloth: its edges, its fold, and what it is.
fn stretch(cloth: &ClothLength) -> Group {
    let (low, high) = (cloth.corner * MM, (cloth.corner + cloth.size) * MM);
    let corners = [low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y), low];
    let group = Group::new().set("class", "cloth").set("fill", "none").add(polyline(&corners, "selvedge", FINE));
    let [height, above] = CLOTH_LETTERS.map(|x| x * MM);
    let at = Vec2::new(low.x, low.y - above);
    let text = Text::new(printable(&cloth.text))
        .set("class", "text")
        .set("x", number(at.x))
        .set("y", number(at.y))
        .set("font-family", "sans-serif")
        .set("font-size", number(height))
        .set("fill", "black");
    let group = group.add(text);
    if !cloth.folded {
        return group;
    }
    let fold = polyline(&[low, Vec2::new(low.x, high.y)], "fold", 2.0 * CUT).set("stroke-dasharray", "24 6 4 6");
    group.add(fold)
}

fn draw(paper: &Paper) -> Group {
    // No two elements have one id.
    let of = match (&paper.size, paper.nest) {
        (Some(size), _) => format!("_{}", size.name),
        (None, Some(_)) => "_label".to_owned(),
        (None, None) => String::new(),
    };
    let name = identifier(&format!("{}{of}", paper.name));
    let mut group = Group::new().set("id", name.as_str()).set("class", "piece").set("fill", "none");
    group = group.set("data-material", printable(&paper.fabric));
    if let Some(cloth) = &paper.cloth {
        group = group.set("data-fabric", cloth.as_str());
    }
    if let Some(side) = paper.drawn {
        group = group.set("data-drawn", side.letter());
    }
    for (i, contour) in paper.cut.iter().enumerate() {
        let open = i == 0 && paper.fold.is_some();
        group = group.add(dashed(contour_path(contour, open), paper.size.as_ref()));
    }
    if let Some(fold) = paper.fold {
        let line = polyline(&fold.map(|p| p * MM), "fold", CUT);
        group = group.add(line.set("id", format!("{name}.fold")).set("stroke-dasharray", "12 3 2 3"));
    }
    for line in &paper.sew {
        let mut path = stroke(line.path.to_svg(MM, true), "sew", FINE).set("stroke-dasharray", "4 2");
        if let Some(corner) = line.corner {
            path = path.set("data-corner", corner.word());
        }
        // A dart's mouth is no edge of the piece, and there may be several.
        group = group.add(match line.of {
            SewKind::Mouth => path,
            _ => path.set("id", format!("{name}.{}", identifier(&line.name))),
        });
    }
    for notch in &paper.notches {
        group = group.add(slit(notch));
    }
    for mark in &paper.marks {
        let class = match mark.kind {
            MarkKind::Fold => "fold",
            MarkKind::PleatFold | MarkKind::PleatPlace | MarkKind::PleatArrow => "pleat",
            MarkKind::Line => "line",
        };
        let path = stroke(mark.path.to_svg(MM, true), class, FINE);
        group = group.add(match (&mark.line, mark.kind) {
            (Some(kind), _) => with_kind(path, kind).set("id", format!("{name}.{}", identifier(&mark.name))),
            (None, MarkKind::PleatFold) => path.set("data-pleat", "fold"),
            (None, MarkKind::PleatPlace) => path.set("data-pleat", "place"),
            (None, _) => path,
        });
    }
    for (kind, at) in &paper.drills {
        let cross = format!("drill {}", identifier(kind));
        let at = at * MM;
        let circle = Circle::new()
            .set("class", cross)
            .set("cx", number(at.x))
            .set("cy", number(at.y))
            .set("r", DRILL)
            .set("fill", "none")
            .set("stroke", "black")
            .set("stroke-width", FINE);
        group = group.add(circle);
    }
    // The label of a nest has none.
    if paper.nest.is_none() || paper.size.is_some() {
        group = group.add(polyline(&grain_arrow(paper.grain).map(|p| p * MM), "grain", FINE));
    }
    paper.texts.iter().fold(group, |group, t| group.add(letters(t)))
}

fn contour_path(contour: &[Vec2], open: bool) -> Path {
    let points: Vec<Vec2> = contour.iter().map(|p| p * MM).collect();
    let steps: Vec<String> = points.iter().map(|p| format!("{} {}", number(p.x), number(p.y))).collect();
    let end = if open { "" } else { " Z" };
    stroke(format!("M{}{end}", steps.join(" L")), "cut", CUT)
}

/// A cut line in the dashes of its size.
fn dashed(path: Path, size: Option<&PaperSize>) -> Path {
    let dashes = size.map_or("", |size| SIZES[size.number % SIZES.len()]);
    if dashes.is_empty() { path } else { path.set("stroke-dasharray", dashes) }
}

/// A notch's mark, with a point on the sewing line.
fn slit(notch: &NotchMark) -> Path {
    let mut points = vec![notch.at, notch.sewn, notch.inside];
    points.dedup();
    let points: Vec<Vec2> = points.into_iter().map(|p| p * MM).collect();
    told_notch(polyline(&points, "notch", FINE), notch.kind, &notch.edge)
}

fn letters(line: &Lettering) -> Text {
    centered(&line.text, line.at * MM, line.height * MM, line.upright)
}
