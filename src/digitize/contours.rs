//! Which strokes of a drawing make which piece, from what they are called and from what lies in what.

use std::collections::HashMap;

use super::chain::{chained, is_closed};
use super::holes::holes_of;
use super::{Inner, Remark, Role, Stroke, Traced};
use crate::geometry::{Path, Vec2, distance_to_segment, encloses, sides_of};
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
        let bounds = points.iter().fold([whole.start(); 2], |[low, high], p| [low.inf(p), high.sup(p)]);
        Some(Self { points, bounds, whole, edges, role, name })
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

    fn area(&self) -> f64 {
        self.whole.double_area().abs() / 2.0
    }

    fn holds(&self, p: Vec2) -> bool {
        encloses(sides_of(&self.points), p)
    }
}

/// The pieces that strokes make, in the order of the drawing; what is written on one may say how it is cut.
pub fn pieces(strokes: &[Stroke], remarks: &[Remark]) -> Vec<Traced> {
    let (contours, rest) = contours(strokes);
    let mut outer: Vec<usize> = (0..contours.len()).filter(|&i| contours[i].area() >= SMALLEST_PIECE).collect();
    let within = |i: usize, k: usize| i != k && contours[i].lies_in(&contours[k]);
    outer.retain(|&i| !(0..contours.len()).any(|k| within(i, k)));
    outer
        .iter()
        .map(|&o| {
            let inner: Vec<&Contour> = (0..contours.len()).filter(|&i| within(i, o)).map(|i| &contours[i]).collect();
            let mut own = remarks.iter().enumerate().filter(|(_, r)| contours[o].holds(r.at));
            let (said_by, cut_how) = own.find_map(|(i, r)| Some((i, cut_how(&r.text)?))).unzip();
            Traced { cut_how, said_by, ..piece(&contours[o], &inner, &rest) }
        })
        .collect()
}

/// `cut 2 (left and right)`, `Cut 1 pair`, `cut 4`: how a piece is cut, as makers write it on.
fn cut_how(text: &str) -> Option<Cut> {
    let text = text.to_lowercase();
    let (_, after) = text.split_once("cut")?;
    let count: usize = after.split(|c: char| !c.is_alphanumeric()).find(|w| !w.is_empty())?.parse().ok()?;
    let mirrored = ["left and right", "l and r", "mirror", "pair"].iter().any(|words| after.contains(words));
    match count {
        1 | 2 if mirrored => Some(Cut::Pair),
        2..=100 => Some(Cut::Count(count)),
        _ => None,
    }
}

/// Strokes of one group and kind that are not closed by themselves.
struct Open {
    group: Option<String>,
    role: Role,
    edges: Vec<(Option<String>, Path)>,
}

/// Closed lines, alone or of edges that meet, and the strokes that are none.
fn contours(strokes: &[Stroke]) -> (Vec<Contour>, Vec<Stroke>) {
    let (mut contours, mut rest) = (Vec::new(), Vec::new());
    let mut open: Vec<Open> = Vec::new();
    let mut by_group: HashMap<(Option<String>, bool), usize> = HashMap::new();
    for stroke in strokes {
        let closed = is_closed(&[((), stroke.path.clone())]) && stroke.path.double_area().abs() > 0.0;
        let name = stroke.group.clone().or_else(|| stroke.name.clone());
        match stroke.role {
            Role::Unknown | Role::Cut | Role::Sew if closed => {
                contours.extend(Contour::new(vec![(None, stroke.path.clone())], stroke.role, name));
            }
            Role::Edge | Role::Fold if closed => {
                contours.extend(Contour::new(vec![(stroke.name.clone(), stroke.path.clone())], Role::Unknown, name));
            }
            Role::Edge | Role::Cut => {
                let key = (stroke.group.clone(), stroke.role == Role::Cut);
                let at = *by_group.entry(key).or_insert_with(|| {
                    open.push(Open { group: stroke.group.clone(), role: stroke.role, edges: Vec::new() });
                    open.len() - 1
                });
                open[at].edges.push((stroke.name.clone(), stroke.path.clone()));
            }
            _ => rest.push(stroke.clone()),
        }
    }
    for Open { group, role, edges } in open {
        let role = if role == Role::Edge { Role::Sew } else { role };
        for mut run in chained(&edges) {
            if !is_closed(&run) {
                // A half piece is open at its fold.
                let (Some(first), Some(last)) = (run.first(), run.last()) else { continue };
                let fold = Path::line(last.1.end(), first.1.start());
                if run.len() < 2 && role == Role::Sew || fold.length() <= 0.0 {
                    continue;
                }
                run.push((Some("fold".to_owned()), fold));
            }
            contours.extend(Contour::new(run, role, group.clone()));
        }
    }
    (contours, rest)
}

fn piece(outer: &Contour, inner: &[&Contour], rest: &[Stroke]) -> Traced {
    let sewn = inner
        .iter()
        .filter(|c| c.role != Role::Cut && (c.role == Role::Sew || c.area() >= SEWN_SHARE * outer.area()))
        .max_by(|a, b| a.area().total_cmp(&b.area()));
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
    let is_sewn = |c: &Contour| sewn.is_some_and(|s| std::ptr::eq(*s, c));
    let surface = sewn.map_or(outer, |s| s);
    // A lozenge within is a dart, a ring of a few millimetres a mark; what is left was cut out.
    let is_hole = |c: &&&Contour| c.area() >= SMALLEST_PIECE / 100.0 && c.lies_in(surface);
    let others = inner.iter().copied().filter(|c| !is_sewn(c));
    let (cut_out, marks): (Vec<&Contour>, Vec<&Contour>) = others.partition(|c| is_hole(&c));
    traced.holes = holes_of(&cut_out);
    traced.points.extend(marks.iter().map(|m| m.points.iter().sum::<Vec2>() / m.points.len() as f64));
    let mut folds = Vec::new();
    for stroke in rest {
        let middle = stroke.path.point(stroke.path.length() / 2.0);
        let ends = [stroke.path.start(), stroke.path.end()];
        let near = |p: Vec2| outlines.iter().any(|o| o.nearest(p).1 <= NEAR);
        let own = outer.holds(middle) || (stroke.role == Role::Fold || stroke.role == Role::Notch) && near(middle);
        if !own {
            continue;
        }
        let short = stroke.path.length() <= NOTCH && stroke.path.is_straight();
        match stroke.role {
            Role::Grain => traced.grain = traced.grain.or(Some(grain_ends(&stroke.path))),
            Role::PleatFold => folds.push(stroke.path.start()),
            Role::PleatPlace => traced.pleats.extend(folds.pop().map(|fold| [fold, stroke.path.start()])),
            Role::Fold => traced.mirror = traced.mirror.or(Some(ends)),
            Role::Notch => traced.notches.push(nearest_end(ends, &outlines)),
            Role::Unknown if short && ends.iter().any(|&p| near(p)) => {
                traced.notches.push(nearest_end(ends, &outlines));
            }
            _ => traced.lines.push(Inner {
                name: stroke.name.clone(),
                path: stroke.path.clone(),
                kind: stroke.kind.clone(),
            }),
        }
    }
    traced
}

fn nearest_end(ends: [Vec2; 2], outlines: &[&Path]) -> Vec2 {
    let off = |p: Vec2| outlines.iter().map(|o| o.nearest(p).1).fold(f64::INFINITY, f64::min);
    if off(ends[0]) <= off(ends[1]) { ends[0] } else { ends[1] }
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
