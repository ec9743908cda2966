//! Assigns the strokes of a drawing to pieces, by their names and by nesting.

use super::contour::{COARSE, Contour, NEAR, half_way};
use super::fish_eyes::sides;
use super::follow::follows;
use super::frames::{DrawingFrame, SheetLine};
use super::holes::holes_of;
use super::joined::{beyond_seam, nearly_closed, unclosed};
use super::said::{Said, said, says_alike};
use super::sizes::{are_sizes, sizes};
use super::sorted::Sorted;
use super::titles::titles;
use super::trimmed::{parts_within, trimmed};
use super::{Drawing, Fastener, ImportedNotch, InnerLine, Remark, Role, Stroke, ToldNotch, Traced};
use crate::geometry::{Path, Vec2};

/// A closed line round less than this (square metres, a square of 3 cm) is no piece.
const SMALLEST_PIECE: f64 = 9e-4;
/// A ring round less than this (square metres, a circle of 3.4 mm) is a point.
const POINT: f64 = SMALLEST_PIECE / 100.0;
/// A contour within another of which an edge is drawn is its sewing line if it takes at least this share of its area.
const SEWN_SHARE: f64 = 0.5;
/// Longest inner line that ends at an outline and is a notch, metres.
const NOTCH: f64 = 0.016;
/// Largest cosine of the angle between a notch and the outline (45°).
const ALONG: f64 = 0.71;
/// A grain line of more points than this is no arrow.
const MOST_ARROW_POINTS: usize = 100;
/// Square centimetres in a square metre.
const CM2: f64 = 1e4;

/// The pieces that strokes make, in the order of the drawing. Text on a piece may say how it is cut. Lines that belong
/// to no piece are left out, and so are lines in a piece's allowance, and parts of the `sheet`, whose size is given if
/// it is known. Sizes that are drawn over one another become a piece each.
pub fn pieces(strokes: &[Stroke], remarks: &[Remark], sheet: Option<Vec2>) -> Drawing {
    let sizes = sizes(strokes);
    if sizes.is_empty() {
        return one_size(strokes, remarks, sheet);
    }
    let mut all = Drawing { sizes: sizes.clone(), ..Drawing::default() };
    for (k, size) in sizes.iter().enumerate() {
        // What is of no size stands with the first.
        let own = |s: &&Stroke| s.size.as_ref().map_or(k == 0, |own| own == size);
        let own: Vec<Stroke> = strokes.iter().filter(own).cloned().collect();
        let mut drawing = one_size(&own, remarks, sheet);
        for piece in &mut drawing.pieces {
            (piece.size, piece.size_name) = (Some(k), Some(size.clone()));
            if !piece.name.contains(size.as_str()) {
                piece.name = format!("{}_{size}", piece.name);
            }
        }
        all.add(drawing);
    }
    all
}

impl Drawing {
    /// Adds the content of `other`.
    fn add(&mut self, other: Self) {
        self.pieces.extend(other.pieces);
        let new = |own: &[String], added: Vec<String>| -> Vec<String> {
            added.into_iter().filter(|sentence| !own.contains(sentence)).collect()
        };
        let (left_out, notes) = (new(&self.left_out, other.left_out), new(&self.notes, other.notes));
        self.left_out.extend(left_out);
        self.notes.extend(notes);
        self.faults.extend(other.faults);
        self.lost += other.lost;
    }
}

/// The pieces of one size.
fn one_size(strokes: &[Stroke], remarks: &[Remark], sheet: Option<Vec2>) -> Drawing {
    let Sorted { contours, rest, alone, notes } = Sorted::new(strokes);
    let mut drawing = Drawing { notes, ..Drawing::default() };
    let contours = Patterns::new(contours, remarks, sheet, &mut drawing.left_out);
    let outer = contours.outer(strokes);
    for &o in &outer {
        let contour = &contours.all[o];
        let inner = contours.inner(o);
        let mut own = remarks.iter().enumerate().filter(|(_, r)| contour.holds(r.at));
        let (said_by, said) = own.find_map(|(i, r)| Some((i, said(&r.text)?))).unzip();
        let (cut_how, copies, on_fold) = match said {
            Some(Said::Cut(how, copies)) => (Some(how), copies, None),
            Some(Said::OnFold(count)) => (None, 1, Some(count)),
            None => (None, 1, None),
        };
        let (mut traced, beyond) = piece(contour, &inner, &rest);
        traced.alike = said_by.is_some_and(|i| says_alike(&remarks[i].text));
        let titles = titles(remarks, |at| contour.holds(at));
        // Groups and layers that are named tell more than words do.
        let title = titles.title.filter(|_| traced.name.is_empty());
        let said_by = [said_by, title.as_ref().map(|(i, _)| *i), titles.number.as_ref().map(|(i, _)| *i)];
        traced.said_by = said_by.into_iter().flatten().collect();
        traced.number = titles.number.map(|(_, number)| number);
        traced.name = title.map_or(traced.name, |(_, title)| title);
        drawing.left_out.extend(beyond_seam(&traced.name, &beyond));
        let size = contours.size(o);
        // Of sizes without a name the smallest is 1.
        let size_name = size.map(|smaller| (smaller + 1).to_string());
        drawing.pieces.push(Traced { cut_how, copies, on_fold, size, size_name, ..traced });
    }
    drawing.left_out.extend(contours.too_small(&outer, &mut drawing.lost));
    let is_on_one = |line: &Stroke| outer.iter().any(|&o| contours.all[o].owns(line));
    let open = rest.iter().filter(|line| matches!(line.role, Role::Unknown | Role::Sew)).chain(&alone);
    let open: Vec<Stroke> = open.filter(|line| !is_on_one(line)).cloned().collect();
    let (open, rest) = nearly_closed(&open, SMALLEST_PIECE);
    drawing.lost += open.iter().map(|o| o.area).sum::<f64>();
    drawing.faults.extend(open.iter().map(|o| o.sentence()));
    drawing.left_out.extend(unclosed(&rest));
    drawing
}

/// The closed lines of a drawing that are of its pieces.
struct Patterns {
    all: Vec<Contour>,
    /// Whether three in one another are sizes, so that each is a piece.
    sized: Vec<bool>,
}

impl Patterns {
    /// Contours without duplicates, parts of the sheet and lettering, which are listed in `left_out`.
    fn new(contours: Vec<Contour>, remarks: &[Remark], sheet: Option<Vec2>, left_out: &mut Vec<String>) -> Self {
        let contours = without_doubles(contours, left_out);
        let surroundings = DrawingFrame { contours: &contours, remarks, sheet, smallest: SMALLEST_PIECE };
        let of_sheet: Vec<Option<SheetLine>> = (0..contours.len()).map(|k| surroundings.of_sheet(k)).collect();
        for (contour, what) in contours.iter().zip(&of_sheet) {
            left_out.extend(what.map(|what| {
                let name = contour.name.as_ref().map_or_else(String::new, |name| format!(" ('{name}')"));
                format!("left out: {}{name}, {:.2} cm²", what.words(), CM2 * contour.area())
            }));
        }
        let mut of_sheet = of_sheet.into_iter();
        let all: Vec<Contour> = contours.into_iter().filter(|_| of_sheet.next() == Some(None)).collect();
        let letter = |c: &Contour| c.filled && c.area() < SMALLEST_PIECE;
        let (letters, all): (Vec<Contour>, Vec<Contour>) = all.into_iter().partition(letter);
        if !letters.is_empty() {
            let area: f64 = letters.iter().map(Contour::area).sum();
            let count = letters.len();
            let shapes = if count == 1 { "1 small filled shape" } else { "small filled shapes" };
            let many = if count == 1 { String::new() } else { format!("{count} ") };
            left_out.push(format!(
                "left out: {many}{shapes}, {:.2} cm²: letters, arrowheads or the like, no lines of a pattern",
                CM2 * area
            ));
        }
        let sized = nested_sizes(&all);
        Self { all, sized }
    }

    fn within(&self, i: usize, k: usize) -> bool {
        let (one, other) = (&self.all[i], &self.all[k]);
        i != k && !(self.sized[i] && self.sized[k]) && (one.lies_in(other) || one.is_drawn_on(other))
    }

    /// Number of a contour among the sizes that are drawn over one another, the smallest 0.
    fn size(&self, i: usize) -> Option<usize> {
        let smaller = |k: &usize| self.sized[*k] && *k != i && self.all[*k].lies_in(&self.all[i]);
        self.sized[i].then(|| (0..self.all.len()).filter(smaller).count())
    }

    /// Those that lie in no other, in the order of the drawing.
    fn outer(&self, strokes: &[Stroke]) -> Vec<usize> {
        let count = self.all.len();
        let mut outer: Vec<usize> = (0..count).filter(|&i| self.all[i].area() >= SMALLEST_PIECE).collect();
        outer.retain(|&i| !(0..count).any(|k| self.within(i, k)));
        // Outlines of open lines were put together last, wherever they are drawn.
        let middles: Vec<Vec2> = strokes.iter().map(half_way).collect();
        outer.sort_by_cached_key(|&o| self.all[o].first_drawn(&middles).unwrap_or(strokes.len()));
        outer
    }

    fn inner(&self, o: usize) -> Vec<&Contour> {
        (0..self.all.len()).filter(|&i| self.within(i, o)).map(|i| &self.all[i]).collect()
    }

    /// Note on contours that lie in no other and are too small to be pieces.
    fn too_small(&self, outer: &[usize], lost: &mut f64) -> Option<String> {
        let count = self.all.len();
        let alone = |i: &usize| !outer.contains(i) && !(0..count).any(|k| self.within(*i, k));
        let small: Vec<&Contour> = (0..count).filter(alone).map(|i| &self.all[i]).collect();
        let area: f64 = small.iter().map(|c| c.area()).sum();
        *lost += area;
        let what = match small.len() {
            0 => return None,
            1 => "1 closed line that is".to_owned(),
            count => format!("{count} closed lines that are"),
        };
        let names: Vec<String> = small.iter().filter_map(|c| Some(format!("'{}'", c.name.as_ref()?))).take(4).collect();
        let names = if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
        Some(format!("left out: {what} too small for a piece{names}, {:.2} cm²", CM2 * area))
    }
}

/// The contours, of those that are drawn again only one: the one that a pen draws.
fn without_doubles(contours: Vec<Contour>, left_out: &mut Vec<String>) -> Vec<Contour> {
    let mut again = vec![false; contours.len()];
    for i in 0..contours.len() {
        for k in i + 1..contours.len() {
            let [one, other] = [&contours[i], &contours[k]];
            let alike = one.role == other.role || [one.role, other.role].contains(&Role::Unknown);
            if again[i] || again[k] || !alike || !one.is_again(other) {
                continue;
            }
            let worse = |c: &Contour| (c.filled, c.role == Role::Unknown, c.name.is_none());
            again[if worse(one) > worse(other) { i } else { k }] = true;
        }
    }
    let doubles: Vec<&Contour> = contours.iter().zip(&again).filter(|(_, again)| **again).map(|(c, _)| c).collect();
    if !doubles.is_empty() {
        let area: f64 = doubles.iter().map(|c| c.area()).sum();
        let lines =
            if doubles.len() == 1 { "1 closed line".to_owned() } else { format!("{} closed lines", doubles.len()) };
        left_out.push(format!("left out: {lines} drawn twice, {:.2} cm²", CM2 * area));
    }
    let mut again = again.into_iter();
    contours.into_iter().filter(|_| again.next() == Some(false)).collect()
}

/// Marks contours that are sizes of one outline, each in the next.
fn nested_sizes(contours: &[Contour]) -> Vec<bool> {
    let mut sized = vec![false; contours.len()];
    let large = |i: &usize| contours[*i].area() >= SMALLEST_PIECE && contours[*i].role == Role::Unknown;
    let all: Vec<usize> = (0..contours.len()).filter(large).collect();
    let holders = |i: usize| {
        let mut own: Vec<usize> =
            all.iter().copied().filter(|&k| k != i && contours[i].lies_in(&contours[k])).collect();
        own.sort_by(|a, b| contours[*a].area().total_cmp(&contours[*b].area()));
        own
    };
    for &i in &all {
        if let [middle, outer, ..] = holders(i)[..]
            && are_sizes(&contours[i], &contours[middle], &contours[outer])
        {
            [i, middle, outer].iter().for_each(|&k| sized[k] = true);
        }
    }
    sized
}

/// The piece within a contour, and the lines in its allowance: those are none of the sewn piece.
fn piece(outer: &Contour, inner: &[&Contour], rest: &[Stroke]) -> (Traced, Vec<Option<String>>) {
    // Within a cut line an edge is sewn, however wide the allowance. Any other line is only if it follows the outline
    // all round.
    let is_sewn = |c: &Contour| match c.role {
        Role::Cut => false,
        _ if c.of_edges && outer.role == Role::Cut => true,
        _ if c.of_edges => c.area() >= SEWN_SHARE * outer.area(),
        _ => follows(&c.whole, &outer.whole),
    };
    let sewn = inner.iter().filter(|c| is_sewn(c)).max_by(|a, b| a.area().total_cmp(&b.area()));
    let mut traced = Traced { name: name_of(outer, inner), ..Traced::default() };
    let outlines: Vec<&Path> = match sewn {
        Some(sewn) => {
            traced.sew = sewn.edges.clone();
            traced.cut = Some(outer.whole.clone());
            vec![&sewn.whole, &outer.whole]
        }
        None if outer.role == Role::Cut => {
            traced.cut = Some(outer.whole.clone());
            vec![&outer.whole]
        }
        None => {
            traced.sew = outer.edges.clone();
            vec![&outer.whole]
        }
    };
    let is_outline = |c: &Contour| sewn.is_some_and(|s| std::ptr::eq(*s, c));
    let surface = sewn.map_or(outer, |s| s);
    // A hole is what the drawing cuts out, or draws as the edge of one. A ring of a few millimetres is a point.
    let is_hole = |c: &Contour| c.role == Role::Cut || c.of_edges || c.own.as_deref().is_some_and(says_hole);
    let (mut holes, mut beyond) = (Vec::new(), Vec::new());
    for contour in inner.iter().copied().filter(|c| !is_outline(c)) {
        if let Some(lines) = sides(contour) {
            traced.lines.extend(lines);
        } else if contour.area() < POINT {
            let points = &contour.points;
            traced.points.push(points.iter().sum::<Vec2>() / points.len() as f64);
        } else if is_hole(contour) && contour.lies_in(surface) {
            holes.push(contour);
        } else {
            let parts = parts_within(&contour.whole, |p| if surface.holds(p) { 0.0 } else { surface.off(p) });
            if parts.is_empty() {
                beyond.push(contour.name.clone());
            }
            let name = contour.own.clone();
            traced.lines.extend(parts.into_iter().map(|path| InnerLine { name: name.clone(), path, kind: None }));
        }
    }
    traced.holes = holes_of(&holes);
    let (mut folds, mut arrow) = (Vec::new(), None);
    for stroke in rest {
        let middle = middle(stroke);
        let ends = [stroke.path.start(), stroke.path.end()];
        let near = |p: Vec2| outlines.iter().any(|o| o.nearest(p).1 <= NEAR);
        let on_rim = matches!(stroke.role, Role::Fold | Role::Notch | Role::Drill | Role::Fastener(_));
        // At a sharp corner the mark of a notch that is told may lie beyond both edges but for one point.
        let told = || stroke.notch.is_some() && points_of(&stroke.path).into_iter().any(near);
        // A neck opening may interrupt a fold in its middle.
        let fold = || stroke.role == Role::Fold && ends.iter().all(|&p| near(p));
        let own = outer.holds(middle) || on_rim && near(middle) || told() || fold();
        if !own {
            continue;
        }
        let short = stroke.path.length() <= NOTCH && stroke.path.is_straight();
        match stroke.role {
            Role::Arrow => arrow = arrow.or(Some(ends)),
            Role::Grain => traced.grain = traced.grain.or(Some(grain_ends(&stroke.path))),
            Role::PleatFold => folds.push(stroke.path.start()),
            Role::PleatPlace => traced.pleats.extend(folds.pop().map(|fold| [fold, stroke.path.start()])),
            Role::Fold if traced.mirror.is_some() => traced.more_folds.push(ends),
            Role::Fold => traced.mirror = Some(ends),
            Role::Drill => traced.points.push(middle),
            Role::Fastener(kind) => traced.fasteners.push(Fastener { at: stroke.path.start(), kind }),
            Role::Notch => traced.notches.push(notch(stroke, &surface.edges, &outlines)),
            Role::Unknown if short && ends.iter().any(|&p| near(p)) && crosses(&stroke.path, &outlines) => {
                traced.notches.push(notch(stroke, &surface.edges, &outlines));
            }
            // FreeSewing draws the mouths of darts so.
            _ if !surface.covers(middle) => beyond.push(stroke.name.clone()),
            _ => traced.lines.push(InnerLine {
                name: stroke.name.clone(),
                path: trimmed(&stroke.path, |p| surface.covers(p)),
                kind: stroke.kind.clone(),
            }),
        }
    }
    traced.grain = traced.grain.or(arrow);
    (traced, beyond)
}

/// Whether a short line leaves the nearest outline rather than running along it, as letters and dashes may.
fn crosses(line: &Path, outlines: &[&Path]) -> bool {
    let along = (line.end() - line.start()).try_normalize(0.0).unwrap_or_else(Vec2::zeros);
    let at = nearest_end([line.start(), line.end()], outlines);
    let nearest = outlines.iter().map(|o| (o, o.nearest(at))).min_by(|a, b| a.1.1.total_cmp(&b.1.1));
    nearest.is_none_or(|(outline, (s, _))| outline.tangent(s).dot(&along).abs() <= ALONG)
}

/// Whether a drawing calls a line so that it is cut out.
fn says_hole(name: &str) -> bool {
    let name = name.to_lowercase();
    ["hole", "cutout", "cut_out", "cut-out"].iter().any(|word| name.contains(word))
}

/// Place of a stroke: its middle, or the centre of the ring round a drill hole.
fn middle(stroke: &Stroke) -> Vec2 {
    let half = half_way(stroke);
    if stroke.role == Role::Drill { (stroke.path.start() + half) / 2.0 } else { half }
}

/// A notch with its meaning if the file tells it. Then one of its points is on the sewing line of its edge.
fn notch(stroke: &Stroke, edges: &[(Option<String>, Path)], outlines: &[&Path]) -> ImportedNotch {
    let Stroke { path, notch, .. } = stroke;
    let at = match notch {
        Some(told) => sewn_point(path, told, edges),
        None => nearest_end([path.start(), path.end()], outlines),
    };
    ImportedNotch { at, told: notch.clone() }
}

/// Of the points of a notch's mark the one on its edge, or on any where that is not drawn.
fn sewn_point(mark: &Path, told: &ToldNotch, edges: &[(Option<String>, Path)]) -> Vec2 {
    let is_own = |edge: &&(Option<String>, Path)| edge.0.as_ref() == Some(&told.edge);
    let own: Vec<_> = edges.iter().filter(is_own).collect();
    let lines = if own.is_empty() { edges.iter().collect() } else { own };
    let off = |p: &Vec2| lines.iter().map(|(_, line)| line.nearest(*p).1).fold(f64::INFINITY, f64::min);
    points_of(mark).into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or_else(|| mark.start())
}

/// The points that a line is drawn through.
fn points_of(path: &Path) -> Vec<Vec2> {
    path.joints().iter().map(|&s| path.point(s)).collect()
}

/// Place of a notch: its end on the sewing line, which comes first, if there is one. The other end may be on the cut
/// line, and the two notches of a double one must stand side by side.
fn nearest_end(ends: [Vec2; 2], outlines: &[&Path]) -> Vec2 {
    let off = |p: Vec2, lines: &[&Path]| lines.iter().map(|line| line.nearest(p).1).fold(f64::INFINITY, f64::min);
    let sewing = outlines.get(..1).unwrap_or_default();
    let lines = if ends.iter().any(|&p| off(p, sewing) <= NEAR) { sewing } else { outlines };
    if off(ends[0], lines) <= off(ends[1], lines) { ends[0] } else { ends[1] }
}

/// An arrow may have barbs: its two points farthest from each other, in the order drawn.
fn grain_ends(path: &Path) -> [Vec2; 2] {
    let mut points = path.sampled(COARSE);
    points.truncate(MOST_ARROW_POINTS);
    let mut best = [path.start(), path.end()];
    let far = |e: [Vec2; 2]| (e[1] - e[0]).norm();
    for (i, &a) in points.iter().enumerate() {
        for &b in &points[i + 1..] {
            // Corners of the barbs are a little farther from the other end than its tip: only clearly farther counts.
            if far([a, b]) > far(best) + COARSE {
                best = [a, b];
            }
        }
    }
    best
}

fn name_of(outer: &Contour, inner: &[&Contour]) -> String {
    let named = std::iter::once(outer).chain(inner.iter().copied());
    named.filter_map(|c| c.name.clone()).next().unwrap_or_default()
}
