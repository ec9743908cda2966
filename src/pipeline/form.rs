//! The pattern that a changed form asks for.
//!
//! A draped garment was moved in another program, and laid flat as it is now. Its cloth is strained by its own weight
//! and by the body, as that of the garment before was; the difference of the two flat shapes is by how much the pattern
//! changes. The new pattern is sewn and draped, and corrected by the difference that is left.

use super::earlier::Earlier;
use super::error::PipelineError;
use super::job::Job;
use super::overrides::Overrides;
use super::run::{Progress, Run};
use crate::contact::closest_on_triangle;
use crate::flatten;
use crate::geometry::{Locator, MM, Vec2, Vec3};
use crate::io::garment::{EdgeChange, Loaded, Reformed, Refused, read_text, reform};
use crate::mesh::ClothMesh;
use crate::report::{Apart, FormReport, LengthChange};

/// Distance from the form up to which the skin is looked for, metres.
const SKIN: f64 = 0.2;
/// A piece that is strained this much more than the garment as it hangs is strained by the change.
const MORE: f64 = 1.05;

/// The request for a changed form.
#[derive(Clone, Copy, Debug)]
pub struct FormAsked<'a> {
    /// Text of the garment file.
    pub text: &'a str,
    /// Name of the new file in messages.
    pub shown: &'a str,
    /// The choices that the job was made with.
    pub overrides: &'a Overrides,
    /// Drapes of new patterns. With 0 nothing is draped, and the pattern has the strain of the form's own cloth.
    pub rounds: usize,
    /// How pieces are laid flat.
    pub options: flatten::FlattenOptions,
}

/// A new garment file.
#[derive(Clone, Debug)]
pub struct NewPattern {
    /// Its text.
    pub text: String,
    /// Whether that is the old text but for what changed.
    pub in_place: bool,
}

/// A mesh whose flat positions can be looked up.
struct Chart<'a> {
    locators: Vec<Locator<'a>>,
}

impl<'a> Chart<'a> {
    fn new(mesh: &'a ClothMesh) -> Self {
        let of =
            |p: &crate::mesh::PieceMesh| Locator::new(&mesh.flat, &mesh.triangles[p.triangles.clone()], mesh.spacing);
        Self { locators: mesh.pieces.iter().map(of).collect() }
    }

    /// The mean at a place of a piece of what its particles have.
    fn at(&self, piece: usize, p: Vec2, values: &[Vec2]) -> Vec2 {
        let (corners, weights) = self.locators[piece].place(p);
        corners.iter().zip(weights).map(|(&v, w)| values[v as usize] * w).sum()
    }
}

/// A changed form while its pattern is looked for.
struct FormSearch<'a> {
    job: &'a Job,
    asked: &'a FormAsked<'a>,
    chart: Chart<'a>,
    /// The form: positions of the particles.
    form: Vec<Vec3>,
    /// The form as a state to go on from: free folds stay where they are, as far as the new pattern lets them.
    hanging: Option<Earlier>,
    /// From drawn to flat positions of the form, and of the garment that was draped last.
    wanted: Vec<Vec2>,
    own: Vec<Vec2>,
    report: FormReport,
    best: Option<(f64, NewPattern)>,
}

impl Run<'_> {
    /// The pattern of the form that this run was begun with and has laid flat. The figures become part of the run's
    /// report. `None` where the form gives no pattern; the report says why.
    ///
    /// # Errors
    /// A garment that cannot be sewn, draped or laid flat.
    pub fn pattern_of_form(
        &mut self,
        asked: &FormAsked,
        progress: Progress,
    ) -> Result<Option<NewPattern>, PipelineError> {
        let job = self.job;
        let (Some(form), Some(flat)) = (self.draped.clone(), &self.flattened) else { return Ok(None) };
        let wanted = differences(flat, &job.mesh.flat);
        let own = vec![Vec2::zeros(); wanted.len()];
        let (chart, report) = (Chart::new(&job.mesh), FormReport::default());
        let hanging = Earlier::of(self);
        let mut search = FormSearch { job, asked, chart, form, hanging, wanted, own, report, best: None };
        let usual = search.hang(progress)?;
        search.report.strained = search.strained(&self.threads, &usual)?;
        for _ in 0..asked.rounds.max(1) {
            if !search.round(progress)? {
                break;
            }
        }
        self.form = Some(search.report);
        Ok(search.best.map(|(_, pattern)| pattern))
    }
}

impl FormSearch<'_> {
    /// Drapes the garment as it is drawn, unless nothing is to be draped. Gives the strain of its threads.
    fn hang(&mut self, progress: Progress) -> Result<Vec<[f64; 2]>, PipelineError> {
        if self.asked.rounds == 0 {
            return Ok(Vec::new());
        }
        let mut run = Run::new(self.job);
        run.flatten(&self.asked.options, progress)?;
        let still = vec![Vec2::zeros(); self.form.len()];
        self.report.moved = Some(self.apart(&still, &run));
        self.own = differences(run.flattened.as_deref().unwrap_or_default(), &self.job.mesh.flat);
        Ok(run.threads)
    }

    /// The pieces that their fabric does not let lie flat, also where the angle between its threads is free.
    fn strained(&self, threads: &[[f64; 2]], usual: &[[f64; 2]]) -> Result<Vec<String>, PipelineError> {
        let job = self.job;
        let found = strained(job, threads, usual);
        if found.is_empty() {
            return Ok(found);
        }
        let options = flatten::FlattenOptions { mode: flatten::Mode::Woven, ..self.asked.options };
        let woven = flatten::flatten_garment(&job.mesh, &job.garment.seams, &self.form, &options)?;
        let least = |(own, woven): (&[f64; 2], &flatten::FlatPiece)| {
            let other = [woven.report.threads.warp_p99, woven.report.threads.weft_p99];
            if other.iter().sum::<f64>() < own.iter().sum() { other } else { *own }
        };
        let threads: Vec<[f64; 2]> = threads.iter().zip(&woven.pieces).map(least).collect();
        Ok(strained(job, &threads, usual))
    }

    /// Makes a pattern, and drapes it. Returns whether another one may come nearer to the form.
    fn round(&mut self, progress: Progress) -> Result<bool, PipelineError> {
        let shifts: Vec<Vec2> = self.wanted.iter().zip(&self.own).map(|(w, o)| w - o).collect();
        let (new, loaded) = match self.reformed(&shifts) {
            Ok(new) => new,
            Err(refused) => {
                if self.best.is_none() {
                    self.report.refused = refused.to_string();
                }
                return Ok(false);
            }
        };
        let pattern = NewPattern { text: new.text.clone(), in_place: new.in_place };
        if self.asked.rounds == 0 || (new.edges.is_empty() && new.darts.is_empty()) {
            self.keep(&new, 0.0, pattern);
            return Ok(false);
        }
        let overrides = Overrides { size: None, alter: Vec::new(), ..self.asked.overrides.clone() };
        let again = Job::new(&self.job.file, loaded, &overrides)?;
        let mut run = match &self.hanging {
            Some(hanging) => Run::going_on(&again, hanging.clone()),
            None => Run::new(&again),
        };
        run.flatten(&self.asked.options, progress)?;
        let found = self.apart(&shifts, &run);
        if self.best.as_ref().is_none_or(|(mean, _)| found.mean < *mean) {
            self.keep(&new, found.mean, pattern);
        }
        self.report.redraped.push(found);
        self.own = self.strain(&shifts, &run);
        Ok(true)
    }

    /// The garment file with its pieces shifted.
    fn reformed(&self, shifts: &[Vec2]) -> Result<(Reformed, Loaded), Refused> {
        let FormAsked { text, shown, overrides, .. } = *self.asked;
        let pieces = &self.job.garment.pieces;
        let given = |piece: &str, p: Vec2| {
            let index = pieces.iter().position(|own| own.name == piece);
            index.map_or_else(Vec2::zeros, |index| self.chart.at(index, p, shifts))
        };
        let new = reform(text, shown, overrides.variant(), &given)?;
        let loaded = read_text(&self.job.garment.name, shown, &new.text)?;
        Ok((new, loaded))
    }

    fn keep(&mut self, new: &Reformed, mean: f64, pattern: NewPattern) {
        let told = |changes: &[EdgeChange]| {
            let told =
                |c: &EdgeChange| LengthChange { name: c.edge.clone(), before: c.before * MM, after: c.after * MM };
            changes.iter().map(told).collect()
        };
        self.report.edges = told(&new.edges);
        self.report.darts = told(&new.darts);
        (self.report.uneven, self.report.seams) = (new.uneven * MM, new.seams * MM);
        self.best = Some((mean, pattern));
    }

    /// From drawn to flat positions of a garment whose pattern is shifted so, for the particles of the first mesh.
    fn strain(&self, shifts: &[Vec2], run: &Run) -> Vec<Vec2> {
        let mesh = &run.job.mesh;
        let (chart, strain) = (Chart::new(mesh), differences(run.flattened.as_deref().unwrap_or_default(), &mesh.flat));
        let mut out = vec![Vec2::zeros(); shifts.len()];
        for (index, piece) in self.job.mesh.pieces.iter().enumerate() {
            for n in piece.particles.clone() {
                out[n] = chart.at(index, self.job.mesh.flat[n] + shifts[n], &strain);
            }
        }
        out
    }

    /// How far the form is from a garment that hangs, whose pattern is shifted so.
    fn apart(&self, shifts: &[Vec2], run: &Run) -> Apart {
        let (job, mesh, at) = (self.job, &run.job.mesh, run.last().unwrap_or_default());
        let chart = Chart::new(mesh);
        let (mut sum, mut furthest) = (0.0, (0.0, 0, 0));
        for (index, piece) in job.mesh.pieces.iter().enumerate() {
            let triangles = Ball::of(&mesh.triangles[mesh.pieces[index].triangles.clone()], at);
            for n in piece.particles.clone() {
                let (corners, weights) = chart.locators[index].place(job.mesh.flat[n] + shifts[n]);
                let same: Vec3 = corners.iter().zip(weights).map(|(&v, w)| at[v as usize] * w).sum();
                let far = nearest(&triangles, self.form[n], (same - self.form[n]).norm());
                sum += far;
                if far > furthest.0 {
                    furthest = (far, index, n);
                }
            }
        }
        let (max, index, n) = furthest;
        let p = self.form[n];
        let skin = job.collider.nearest(p, SKIN).map(|near| near.distance * MM);
        let gaps = run.gaps.iter().flatten().flatten().copied();
        Apart {
            mean: MM * sum / self.form.len() as f64,
            max: MM * max,
            piece: job.garment.pieces[index].name.clone(),
            at: (job.body.frame.to_file(p) * MM).into(),
            skin,
            gap: MM * gaps.fold(0.0, f64::max),
        }
    }
}

/// A triangle, and a ball round it.
struct Ball {
    corners: [Vec3; 3],
    middle: Vec3,
    radius: f64,
}

impl Ball {
    fn of(triangles: &[[u32; 3]], at: &[Vec3]) -> Vec<Self> {
        let ball = |t: &[u32; 3]| {
            let corners = t.map(|v| at[v as usize]);
            let middle = corners.iter().sum::<Vec3>() / 3.0;
            let radius = corners.iter().map(|c| (c - middle).norm()).fold(0.0, f64::max);
            Self { corners, middle, radius }
        };
        triangles.iter().map(ball).collect()
    }
}

/// Distance of a point from the nearest triangle, which is no further than `bound`.
fn nearest(triangles: &[Ball], p: Vec3, bound: f64) -> f64 {
    let mut best = bound;
    for Ball { corners: [a, b, c], middle, radius } in triangles {
        let reach = best + radius;
        if (p - middle).norm_squared() < reach * reach {
            let [k, l, m] = closest_on_triangle(p, *a, *b, *c);
            best = best.min((a * k + b * l + c * m - p).norm());
        }
    }
    best
}

fn differences(to: &[Vec2], from: &[Vec2]) -> Vec<Vec2> {
    to.iter().zip(from).map(|(to, from)| to - from).collect()
}

/// The pieces whose threads would be drawn out further than their fabric is under a tester's full load, and further
/// than those of the garment as it hangs.
fn strained(job: &Job, threads: &[[f64; 2]], usual: &[[f64; 2]]) -> Vec<String> {
    let mut out = Vec::new();
    for (k, piece) in job.garment.pieces.iter().enumerate() {
        let (found, gives) = (threads[k], job.fabrics[k].emt());
        let before = usual.get(k).copied().unwrap_or_default();
        let over = |i: &usize| found[*i] > gives[*i] && found[*i] > MORE * before[*i];
        if let Some(i) = (0..2).find(over) {
            let [by, most] = [found[i], gives[i]].map(|x| 100.0 * x);
            out.push(format!("'{}' (by {by:.1} %, {} gives {most:.1} %)", piece.name, job.fabrics[k].name));
        }
    }
    out
}
