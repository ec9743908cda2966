//! The strokes of a drawing, sorted into closed and open lines.

use std::collections::HashMap;

use super::chain::{bridged, chained, is_closed};
use super::contour::{Contour, NEAR};
use super::joined::{JoinedOutline, joined};
use super::partial::completed;
use super::spikes::without_spikes;
use super::{Role, Stroke};
use crate::geometry::{MM, Path, Vec2};

/// Length of the line that stands for a point (metres).
const POINT: f64 = 1e-6;
/// Share of a piece's area below which an area enclosed by open lines is drawn on the piece.
const MARK_SHARE: f64 = 0.5;

/// Strokes of one group and kind that are not closed by themselves.
struct OpenStrokes<'a> {
    group: Option<String>,
    role: Role,
    edges: Vec<(&'a Stroke, Path)>,
}

/// The strokes of a drawing, sorted into closed and open lines.
#[derive(Default)]
pub(super) struct Sorted {
    /// Closed lines, alone or of edges that meet.
    pub(super) contours: Vec<Contour>,
    /// Strokes that are none.
    pub(super) rest: Vec<Stroke>,
    /// Edges that meet no other.
    pub(super) alone: Vec<Stroke>,
    /// Notes on ends that were joined over a gap: a sentence for each outline.
    pub(super) notes: Vec<String>,
}

impl Sorted {
    pub(super) fn new(strokes: &[Stroke]) -> Self {
        let mut sorted = Self::default();
        let (mut unsaid, mut sewn) = (Vec::new(), Vec::new());
        let mut open: Vec<OpenStrokes> = Vec::new();
        let mut by_group: HashMap<(Option<String>, bool), usize> = HashMap::new();
        for stroke in strokes {
            let closed = is_closed(&[((), stroke.path.clone())]) && stroke.path.double_area().abs() > 0.0;
            match stroke.role {
                Role::Unknown | Role::Cut | Role::Sew | Role::Edge | Role::Fold if closed => sorted.close(stroke),
                Role::Edge | Role::Cut => {
                    let key = (stroke.group.clone(), stroke.role == Role::Cut);
                    let at = *by_group.entry(key).or_insert_with(|| {
                        open.push(OpenStrokes { group: stroke.group.clone(), role: stroke.role, edges: Vec::new() });
                        open.len() - 1
                    });
                    open[at].edges.push((stroke, stroke.path.clone()));
                }
                Role::Unknown if stroke.kind.is_none() => unsaid.push(stroke.clone()),
                Role::Sew if stroke.kind.is_none() => sewn.push(stroke.clone()),
                _ => sorted.rest.push(stroke.clone()),
            }
        }
        open.into_iter().for_each(|edges| sorted.join_edges(edges));
        sorted.join(&sewn, Role::Sew);
        sorted.join(&unsaid, Role::Unknown);
        sorted.close_at_folds();
        sorted
    }

    /// Adds a line that is closed by itself.
    fn close(&mut self, stroke: &Stroke) {
        let is_edge = matches!(stroke.role, Role::Edge | Role::Fold);
        let (edge, role) = if is_edge { (stroke.name.clone(), Role::Edge) } else { (None, stroke.role) };
        let name = stroke.group.clone().or_else(|| stroke.name.clone());
        let smooth = without_spikes(&stroke.path);
        if smooth.spikes > 0 {
            let of = name.as_ref().map_or_else(String::new, |name| format!(" of '{name}'"));
            self.notes.push(format!("spikes of no width in the outline{of} are taken out: {}", smooth.spikes));
        }
        let notch = |at: Vec2| Stroke {
            path: Path::line(at, at + Vec2::new(POINT, 0.0)),
            role: Role::Notch,
            name: None,
            kind: None,
            notch: None,
            ..stroke.clone()
        };
        self.rest.extend(smooth.slits.into_iter().map(notch));
        let contour = Contour::new(vec![(edge, smooth.path)], role, name);
        self.contours.extend(contour.map(|c| Contour { own: stroke.name.clone(), filled: stroke.filled, ..c }));
    }

    /// Adds the outlines of edges that meet. A run that stays open is closed by its fold, or by the sewing line on
    /// which it begins and ends.
    fn join_edges(&mut self, OpenStrokes { group, role, edges }: OpenStrokes) {
        let role = if role == Role::Edge { Role::Sew } else { role };
        let of_edges = role == Role::Sew;
        let joined = bridged(chained(&edges));
        self.notes.extend(joined_note(group.as_deref(), joined.gaps.iter().map(|(_, gap)| *gap)));
        let mut runs = joined.runs;
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
            let contour = Contour::new(edges, role, group.clone());
            self.contours.extend(contour.map(|c| Contour { of_edges, ..c }));
        }
    }

    /// The cut line of the piece of a group of which only the runs that are open are drawn.
    fn partly_cut<T>(&self, group: Option<&str>, runs: &[Vec<(T, Path)>]) -> Option<Path> {
        let whole = |run: &Vec<(T, Path)>| run.iter().map(|(_, path)| path.clone()).reduce(|a, b| a.joined(&b));
        let open: Vec<Path> = runs.iter().filter(|run| !is_closed(run)).filter_map(whole).collect();
        let own = |c: &&Contour| c.role == Role::Sew && group.is_some() && c.name.as_deref() == group;
        self.contours.iter().filter(own).find_map(|sewn| completed(&sewn.whole, &open))
    }

    /// Adds outlines of open lines that are not marked as edges. An enclosed area on a piece that is too small to be
    /// its sewing line is drawn on it.
    fn join(&mut self, open: &[Stroke], role: Role) {
        let (outlines, rest) = joined(open);
        self.rest.extend(rest);
        let is_small = |one: &Contour, other: &Contour| {
            one.area() < MARK_SHARE * other.area() && one.lies_in(other) && !std::ptr::eq(one, other)
        };
        let is_mark = |own: &JoinedOutline| {
            let others = self.contours.iter().chain(outlines.iter().map(|o| &o.contour));
            others.into_iter().any(|other| is_small(&own.contour, other))
        };
        let marks: Vec<bool> = outlines.iter().map(is_mark).collect();
        for (JoinedOutline { contour, lines, gap }, is_mark) in outlines.into_iter().zip(marks) {
            if is_mark {
                self.rest.extend(lines);
                continue;
            }
            self.notes.extend(joined_note(contour.name.as_deref(), std::iter::once(gap)));
            self.contours.push(Contour { role, ..contour });
        }
    }

    /// Adds the outlines that are open at the fold: lines of a group that has no closed one, from the fold round to it.
    fn close_at_folds(&mut self) {
        let folds: Vec<Stroke> = self.rest.iter().filter(|s| s.role == Role::Fold).cloned().collect();
        for fold in folds {
            let own = |s: &Stroke| s.group.is_some() && s.group == fold.group;
            if fold.group.is_none() || self.contours.iter().any(|c| c.name == fold.group) {
                continue;
            }
            let is_open = |s: &&Stroke| matches!(s.role, Role::Sew | Role::Unknown) && s.kind.is_none() && own(s);
            let lines: Vec<Stroke> = self.rest.iter().filter(is_open).cloned().collect();
            let numbered: Vec<(usize, Path)> = lines.iter().enumerate().map(|(k, l)| (k, l.path.clone())).collect();
            let runs = bridged(chained(&numbered)).runs;
            let Some((run, closing)) = runs.into_iter().find_map(|run| closed_at(run, &fold.path)) else { continue };
            let used: Vec<&Stroke> = run.iter().map(|(k, _)| &lines[*k]).collect();
            let role = if used.iter().any(|s| s.role == Role::Sew) { Role::Sew } else { Role::Unknown };
            let mut edges: Vec<_> = run.iter().map(|(k, path)| (lines[*k].name.clone(), path.clone())).collect();
            edges.push((Some("fold".to_owned()), closing));
            self.rest.retain(|s| !used.iter().any(|u| u.path == s.path && u.role == s.role));
            self.contours.extend(Contour::new(edges, role, fold.group.clone()));
        }
    }
}

/// A run both of whose ends are on the line of a fold, with the stretch of the fold between them.
fn closed_at<T>(run: Vec<(T, Path)>, fold: &Path) -> Option<(Vec<(T, Path)>, Path)> {
    let along = (fold.end() - fold.start()).try_normalize(0.0)?;
    let ends = [run.last()?.1.end(), run.first()?.1.start()];
    let on_fold = ends.iter().all(|p| along.perp(&(p - fold.start())).abs() <= NEAR);
    let area: f64 = run.iter().map(|(_, path)| path.double_area()).sum();
    let goes_round = run
        .iter()
        .any(|(_, path)| path.joints().iter().any(|&s| along.perp(&(path.point(s) - fold.start())).abs() > NEAR));
    let apart = (ends[0] - ends[1]).norm() > NEAR;
    (on_fold && goes_round && apart && area != 0.0).then(|| (run, Path::line(ends[0], ends[1])))
}

/// Note on ends that were joined, if there were any.
fn joined_note(name: Option<&str>, gaps: impl Iterator<Item = f64>) -> Option<String> {
    let widest = gaps.fold(0.0, f64::max);
    let of = name.map_or_else(String::new, |name| format!(" of '{name}'"));
    (widest > 0.0).then(|| {
        format!("ends of the outline{of} that do not quite meet, up to {:.2} mm apart, are joined", widest * MM)
    })
}
