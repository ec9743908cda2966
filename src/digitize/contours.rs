//! Which strokes of a drawing make which piece, from what they are called and from what lies in what.

use std::collections::HashMap;

use super::chain::{chained, is_closed};
use super::fish_eyes::sides;
use super::holes::holes_of;
use super::joined::{Joined, beyond_seam, joined, unclosed};
use super::partial::completed;
use super::trimmed::trimmed;
use super::{Drawing, Inner, Notch, Remark, Role, Stroke, ToldNotch, Traced};
use crate::geometry::{Path, Vec2, box_of, distance_to_segment, encloses, sides_of};
use crate::pattern::Cut;

/// A closed line round less than this (square metres, a square of 3 cm) is no piece.
const SMALLEST_PIECE: f64 = 9e-4;
/// A contour within another is its sewing line if it takes at least this share of its area.
const SEWN_SHARE: f64 = 0.5;
/// An inner line no longer than this (metres) that ends at an outline is a notch.
const NOTCH: f64 = 0.016;
/// As near to an outline as this (metres) a notch must end.
const NEAR: f64 = 1.5e-3;
/// Places of a contour that are looked at.
const LOOKS: usize = 15;
/// A grain line of more points than this is no arrow.
const MOST_ARROW_POINTS: usize = 100;
/// Chords that stand for curves where only inside and outside is asked.
const COARSE: f64 = 1e-4;
/// Two contours are one line where their areas differ by less than a strip so wide (metres) along it.
const STRIP: f64 = 1e-5;

/// A closed line and the corners it goes through.
pub(super) struct Contour {
    pub(super) edges: Vec<(Option<String>, Path)>,
    pub(super) whole: Path,
    points: Vec<Vec2>,
    /// Least and greatest coordinates.
    bounds: [Vec2; 2],
    pub(super) role: Role,
    name: Option<String>,
}

impl Contour {
    pub(super) fn new(edges: Vec<(Option<String>, Path)>, role: Role, name: Option<String>) -> Option<Self> {
        let mut paths = edges.iter().map(|e| e.1.clone());
        let first = paths.next()?;
        let whole = paths.fold(first, |whole, next| whole.joined(&next));
        let points = whole.sampled(COARSE);
        let bounds = box_of(points.iter().copied());
        Some(Self { points, bounds, whole, edges, role, name })
    }

    /// The outline that edges make, if they close and go round something.
    pub(super) fn of_edges(edges: Vec<(Option<String>, Path)>, name: Option<String>) -> Option<Self> {
        let closed = is_closed(&edges);
        Self::new(edges, Role::Unknown, name).filter(|contour| closed && contour.area() > 0.0)
    }

    /// Whether most of it lies in another: outlines may share a side, on which no point tells. Where there is no
    /// allowance, the sewing line lies in the cut line that is drawn over it.
    pub(super) fn lies_in(&self, other: &Self) -> bool {
        let middle = (self.bounds[0] + self.bounds[1]) / 2.0;
        let beyond = (0..2).any(|k| middle[k] < other.bounds[0][k] || middle[k] > other.bounds[1][k]);
        let wider = other.area() - self.area();
        let alike = wider.abs() <= STRIP * other.whole.length();
        let over = self.role != Role::Cut && other.role == Role::Cut;
        if beyond || wider <= 0.0 && !alike || alike && !over {
            return false;
        }
        let place = |k: usize| self.whole.point(self.whole.length() * (k as f64 + 0.5) / LOOKS as f64);
        let telling: Vec<Vec2> = (0..LOOKS).map(place).filter(|&p| other.off(p) > COARSE).collect();
        if alike {
            telling.is_empty()
        } else {
            2 * telling.iter().filter(|&&p| other.holds(p)).count() >= telling.len()
        }
    }

    /// How far a point is from its line.
    fn off(&self, p: Vec2) -> f64 {
        sides_of(&self.points).map(|side| distance_to_segment(p, side)).fold(f64::INFINITY, f64::min)
    }

    /// Whether the middle of a line lies in it or on it.
    fn owns(&self, line: &Stroke) -> bool {
        let middle = half_way(line);
        self.holds(middle) || self.whole.nearest(middle).1 <= NEAR
    }

    /// Whether a point lies in it or, but for what programs round, on it.
    fn covers(&self, p: Vec2) -> bool {
        self.holds(p) || self.off(p) <= COARSE
    }

    /// Which of the drawing's strokes, given by their middles, is the first that runs along it.
    fn first_drawn(&self, middles: &[Vec2]) -> Option<usize> {
        let is_beside = |p: &Vec2| (0..2).all(|k| p[k] >= self.bounds[0][k] - NEAR && p[k] <= self.bounds[1][k] + NEAR);
        middles.iter().position(|p| is_beside(p) && self.off(*p) <= NEAR)
    }

    fn area(&self) -> f64 {
        self.whole.double_area().abs() / 2.0
    }

    fn holds(&self, p: Vec2) -> bool {
        encloses(sides_of(&self.points), p)
    }
}

/// The pieces that strokes make, in the order of the drawing; what is written on one may say how it is cut. Open lines
/// that belong to none are left out, and so are lines in a piece's allowance.
pub fn pieces(strokes: &[Stroke], remarks: &[Remark]) -> Drawing {
    let Sorted { contours, rest, alone } = Sorted::new(strokes);
    let mut outer: Vec<usize> = (0..contours.len()).filter(|&i| contours[i].area() >= SMALLEST_PIECE).collect();
    let within = |i: usize, k: usize| i != k && contours[i].lies_in(&contours[k]);
    outer.retain(|&i| !(0..contours.len()).any(|k| within(i, k)));
    // Outlines of open lines were put together last, wherever they are drawn.
    let middles: Vec<Vec2> = strokes.iter().map(half_way).collect();
    outer.sort_by_cached_key(|&o| contours[o].first_drawn(&middles).unwrap_or(strokes.len()));
    let mut left_out = Vec::new();
    let piece = |&o: &usize| {
        let inner: Vec<&Contour> = (0..contours.len()).filter(|&i| within(i, o)).map(|i| &contours[i]).collect();
        let mut own = remarks.iter().enumerate().filter(|(_, r)| contours[o].holds(r.at));
        let (said_by, said) = own.find_map(|(i, r)| Some((i, said(&r.text)?))).unzip();
        let (cut_how, on_fold) = match said {
            Some(Said::Cut(how)) => (Some(how), None),
            Some(Said::OnFold(count)) => (None, Some(count)),
            None => (None, None),
        };
        let (traced, beyond) = piece(&contours[o], &inner, &rest);
        left_out.extend(beyond_seam(&traced.name, &beyond));
        Traced { cut_how, on_fold, said_by, ..traced }
    };
    let pieces = outer.iter().map(piece).collect();
    let is_on_one = |line: &Stroke| outer.iter().any(|&o| contours[o].owns(line));
    let open = rest.iter().filter(|line| line.role == Role::Unknown).chain(&alone);
    let open: Vec<Stroke> = open.filter(|line| !is_on_one(line)).cloned().collect();
    left_out.extend(unclosed(&open));
    Drawing { pieces, left_out, ..Drawing::default() }
}

/// What is written on a piece of how it is cut.
enum Said {
    /// So.
    Cut(Cut),
    /// So often on the fold of the cloth; where that is, is not in the words.
    OnFold(usize),
}

/// `cut 2 (left and right)`, `Cut 1 pair`, `cut 4`, `CUT 1 ON FOLD`: how a piece is cut, as makers write it on.
fn said(text: &str) -> Option<Said> {
    let text = text.to_lowercase();
    let (_, after) = text.split_once("cut")?;
    let count: usize = after.split(|c: char| !c.is_alphanumeric()).find(|w| !w.is_empty())?.parse().ok()?;
    let says = |words: &[&str]| words.iter().any(|words| after.contains(words));
    let mirrored = says(&["left and right", "l and r", "mirror", "pair"]);
    match count {
        1..=100 if says(&["on fold", "on the fold"]) => Some(Said::OnFold(count)),
        1 | 2 if mirrored => Some(Said::Cut(Cut::Pair)),
        2..=100 => Some(Said::Cut(Cut::Count(count))),
        _ => None,
    }
}

/// Strokes of one group and kind that are not closed by themselves.
struct Open<'a> {
    group: Option<String>,
    role: Role,
    edges: Vec<(&'a Stroke, Path)>,
}

/// The strokes of a drawing by what they make.
#[derive(Default)]
struct Sorted {
    /// Closed lines, alone or of edges that meet.
    contours: Vec<Contour>,
    /// Strokes that are none.
    rest: Vec<Stroke>,
    /// Edges that meet no other.
    alone: Vec<Stroke>,
}

impl Sorted {
    fn new(strokes: &[Stroke]) -> Self {
        let mut sorted = Self::default();
        let mut unsaid = Vec::new();
        let mut open: Vec<Open> = Vec::new();
        let mut by_group: HashMap<(Option<String>, bool), usize> = HashMap::new();
        for stroke in strokes {
            let closed = is_closed(&[((), stroke.path.clone())]) && stroke.path.double_area().abs() > 0.0;
            match stroke.role {
                Role::Unknown | Role::Cut | Role::Sew | Role::Edge | Role::Fold if closed => sorted.close(stroke),
                Role::Edge | Role::Cut => {
                    let key = (stroke.group.clone(), stroke.role == Role::Cut);
                    let at = *by_group.entry(key).or_insert_with(|| {
                        open.push(Open { group: stroke.group.clone(), role: stroke.role, edges: Vec::new() });
                        open.len() - 1
                    });
                    open[at].edges.push((stroke, stroke.path.clone()));
                }
                Role::Unknown if stroke.kind.is_none() => unsaid.push(stroke.clone()),
                _ => sorted.rest.push(stroke.clone()),
            }
        }
        open.into_iter().for_each(|edges| sorted.join_edges(edges));
        sorted.join(&unsaid);
        sorted
    }

    /// Adds a line that is closed by itself.
    fn close(&mut self, stroke: &Stroke) {
        let is_edge = matches!(stroke.role, Role::Edge | Role::Fold);
        let (edge, role) = if is_edge { (stroke.name.clone(), Role::Edge) } else { (None, stroke.role) };
        let name = stroke.group.clone().or_else(|| stroke.name.clone());
        self.contours.extend(Contour::new(vec![(edge, stroke.path.clone())], role, name));
    }

    /// Adds what edges make where they meet; a run that stays open is closed by its fold, or by the sewing line on
    /// which it begins and ends.
    fn join_edges(&mut self, Open { group, role, edges }: Open) {
        let role = if role == Role::Edge { Role::Sew } else { role };
        let mut runs = chained(&edges);
        if role == Role::Cut
            && let Some(cut) = self.partly_cut(group.as_deref(), &runs)
        {
            self.contours.extend(Contour::new(vec![(None, cut)], role, group.clone()));
            runs.retain(|run| is_closed(run));
        }
        for run in runs {
            let (Some(first), Some(last)) = (run.first(), run.last()) else { continue };
            let fold = (!is_closed(&run)).then(|| Path::line(last.1.end(), first.1.start()));
            if run.len() < 2 && role == Role::Sew && fold.is_some() {
                self.alone.push(first.0.clone());
                continue;
            }
            let mut edges: Vec<_> = run.into_iter().map(|(stroke, path)| (stroke.name.clone(), path)).collect();
            edges.extend(fold.map(|fold| (Some("fold".to_owned()), fold)));
            self.contours.extend(Contour::new(edges, role, group.clone()));
        }
    }

    /// The cut line of the piece of a group of which only the runs that are open are drawn.
    fn partly_cut<T>(&self, group: Option<&str>, runs: &[Vec<(T, Path)>]) -> Option<Path> {
        let whole = |run: &Vec<(T, Path)>| run.iter().map(|(_, path)| path.clone()).reduce(|a, b| a.joined(&b));
        let open: Vec<Path> = runs.iter().filter(|run| !is_closed(run)).filter_map(whole).collect();
        let own = |c: &&Contour| c.role == Role::Sew && group.is_some() && c.name.as_deref() == group;
        self.contours.iter().filter(own).find_map(|sewn| completed(&sewn.whole, &open))
    }

    /// Adds the outlines that open lines make of which nothing is said. What they enclose on a piece that is too small
    /// to be its sewing line are lines on it.
    fn join(&mut self, unsaid: &[Stroke]) {
        let (outlines, rest) = joined(unsaid);
        self.rest.extend(rest);
        let is_small = |one: &Contour, other: &Contour| {
            one.area() < SEWN_SHARE * other.area() && one.lies_in(other) && !std::ptr::eq(one, other)
        };
        let is_mark = |own: &Joined| {
            let others = self.contours.iter().chain(outlines.iter().map(|o| &o.contour));
            others.into_iter().any(|other| is_small(&own.contour, other))
        };
        let marks: Vec<bool> = outlines.iter().map(is_mark).collect();
        for (Joined { contour, lines }, is_mark) in outlines.into_iter().zip(marks) {
            if is_mark {
                self.rest.extend(lines);
            } else {
                self.contours.push(contour);
            }
        }
    }
}

/// The piece within a contour, and the lines in its allowance: those are none of the sewn piece.
fn piece<'a>(outer: &Contour, inner: &[&Contour], rest: &'a [Stroke]) -> (Traced, Vec<&'a Stroke>) {
    // Within a cut line an edge is sewn, however wide the allowance; within another line it may be that of a hole.
    let is_sewn = |c: &Contour| match c.role {
        Role::Sew => true,
        Role::Edge if outer.role == Role::Cut => true,
        Role::Cut => false,
        _ => c.area() >= SEWN_SHARE * outer.area(),
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
    // A lozenge within is a dart, a ring of a few millimetres a mark; what is left was cut out.
    let is_hole = |c: &&&Contour| c.area() >= SMALLEST_PIECE / 100.0 && c.lies_in(surface);
    let mut others = Vec::new();
    for contour in inner.iter().copied().filter(|c| !is_outline(c)) {
        match sides(contour) {
            Some(lines) => traced.lines.extend(lines),
            None => others.push(contour),
        }
    }
    let (cut_out, marks): (Vec<&Contour>, Vec<&Contour>) = others.into_iter().partition(|c| is_hole(&c));
    traced.holes = holes_of(&cut_out);
    traced.points.extend(marks.iter().map(|m| m.points.iter().sum::<Vec2>() / m.points.len() as f64));
    let (mut folds, mut beyond) = (Vec::new(), Vec::new());
    for stroke in rest {
        let middle = middle(stroke);
        let ends = [stroke.path.start(), stroke.path.end()];
        let near = |p: Vec2| outlines.iter().any(|o| o.nearest(p).1 <= NEAR);
        let on_rim = matches!(stroke.role, Role::Fold | Role::Notch | Role::Drill);
        // At a sharp corner the mark of a notch that is told may lie beyond both edges but for one point.
        let told = || stroke.notch.is_some() && points_of(&stroke.path).into_iter().any(near);
        let own = outer.holds(middle) || on_rim && near(middle) || told();
        if !own {
            continue;
        }
        let short = stroke.path.length() <= NOTCH && stroke.path.is_straight();
        match stroke.role {
            Role::Grain => traced.grain = traced.grain.or(Some(grain_ends(&stroke.path))),
            Role::PleatFold => folds.push(stroke.path.start()),
            Role::PleatPlace => traced.pleats.extend(folds.pop().map(|fold| [fold, stroke.path.start()])),
            Role::Fold => traced.mirror = traced.mirror.or(Some(ends)),
            Role::Drill => traced.points.push(middle),
            Role::Notch => traced.notches.push(notch(stroke, &surface.edges, &outlines)),
            Role::Unknown if short && ends.iter().any(|&p| near(p)) => {
                traced.notches.push(notch(stroke, &surface.edges, &outlines));
            }
            // FreeSewing draws the mouths of darts so.
            _ if !surface.covers(middle) => beyond.push(stroke),
            _ => traced.lines.push(Inner {
                name: stroke.name.clone(),
                path: trimmed(&stroke.path, |p| surface.covers(p)),
                kind: stroke.kind.clone(),
            }),
        }
    }
    (traced, beyond)
}

/// The point half way along a stroke.
fn half_way(stroke: &Stroke) -> Vec2 {
    stroke.path.point(stroke.path.length() / 2.0)
}

/// Where a stroke is: half way along it, or in the middle of the ring round a drill hole.
fn middle(stroke: &Stroke) -> Vec2 {
    let half = half_way(stroke);
    if stroke.role == Role::Drill { (stroke.path.start() + half) / 2.0 } else { half }
}

/// A notch and what is told of it; then one of its points is on the sewing line of its edge.
fn notch(stroke: &Stroke, edges: &[(Option<String>, Path)], outlines: &[&Path]) -> Notch {
    let Stroke { path, notch, .. } = stroke;
    let at = match notch {
        Some(told) => sewn_point(path, told, edges),
        None => nearest_end([path.start(), path.end()], outlines),
    };
    Notch { at, told: notch.clone() }
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

/// Where a notch is: its end on the sewing line, which comes first, if one is there. The other may be on the cut line,
/// and two of a double one must stand side by side.
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
