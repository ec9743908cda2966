//! The search for the amounts of knobs.

use rayon::prelude::*;

use super::draped::{FittedDrape, drape};
use super::figure::{Figure, own_wants};
use super::knob::{Knob, alterations};
use super::own::FirstDrape;
use super::refusal::reasons;
use super::solve::{FigureModel, cost};
use super::words::order;
use super::{Asked, Fitting, KnobRow, New, WantRow};
use crate::io::garment::{Loaded, alteration_line, appended, read_text};
use crate::pattern::WantFile;
use crate::pipeline::{Earlier, Job, PipelineError, Run};
use crate::report::Report;

/// The change by which a knob is tried, mm: well above what a second drape of the same garment differs by.
const TRIED: f64 = 8.0;
/// The change by which a knob of a long range is tried, as a share of it.
const PART: f64 = 0.05;
/// Longest step of a knob, mm, or as a share of a long range. Pressure does not change linearly.
const REACH: (f64, f64) = (30.0, 0.25);
/// Steps below this are none, mm.
const STILL: f64 = 0.3;
/// Amounts are rounded to this, mm.
const ROUNDED: f64 = 0.5;
/// How far figures may be off their aims before the garment is draped from nothing, in tolerances.
const NEAR: f64 = 0.4;
/// So many times a step that cannot be made is halved.
const HALVINGS: usize = 3;
/// A step is followed by another if the sum of squares has become less than this share of what it was.
const WORTH: f64 = 0.7;
/// Wants that the model misses by more than this, in tolerances, are refused without a drape from nothing.
const FAR: f64 = 5.0;
/// Wants that are met have knobs of their own only if there are no more than this.
const FEW: usize = 4;

/// A search under way.
pub(super) struct KnobSearch<'a> {
    asked: &'a Asked<'a>,
    figures: Vec<Figure>,
    knobs: Vec<Knob>,
    model: FigureModel,
    /// Figures of the garment as it was.
    before: Vec<f64>,
    first: Report,
    hanging: Option<Earlier>,
    drapes: usize,
    refused: Vec<String>,
}

/// Amounts of a garment that was draped, its figures and the drape.
type Tried = (Vec<f64>, Vec<f64>, FittedDrape);

/// A garment that meets all wants when it is draped from nothing.
struct Met {
    /// Amounts of the knobs, mm.
    at: Vec<f64>,
    /// Its figures.
    values: Vec<f64>,
    new: New,
    /// Its problems that the garment before did not have.
    worse: Vec<String>,
}

impl Met {
    /// This garment or the other, whichever has its figures nearer to their aims.
    fn or_nearer(self, other: Self, figures: &[Figure]) -> Self {
        if cost(figures, &self.values) < cost(figures, &other.values) { self } else { other }
    }
}

impl<'a> KnobSearch<'a> {
    /// Drapes the garment, and finds its figures and knobs.
    pub(super) fn begin(asked: &'a Asked<'a>, progress: &mut dyn FnMut(&str, f64)) -> Result<Self, PipelineError> {
        let job = Job::new(asked.file, asked.loaded.clone(), asked.overrides)?;
        let mut run = Run::new(&job);
        run.drape(&mut |_, share| progress("drape 1", share))?;
        let report = run.report();
        let wants: Vec<WantFile> = match asked.wants {
            Some(file) => file.wants.iter().map(|want| want.value.clone()).collect(),
            None => own_wants(&asked.loaded.garment, &report),
        };
        let figures: Vec<Figure> = wants.iter().map(Figure::new).collect();
        let seen = FirstDrape { loaded: asked.loaded, job: &job, at: run.last().unwrap_or_default(), report: &report };
        let knobs = knobs(asked, &figures, &seen);
        let missing = figures.iter().filter(|f| f.measured(&report).is_none());
        let refused: Vec<String> = missing.map(Figure::missing).collect();
        let values = figures.iter().map(|f| f.measured(&report).unwrap_or(f64::NAN)).collect::<Vec<f64>>();
        let slopes = vec![vec![0.0; knobs.len()]; figures.len()];
        let model = FigureModel { at: vec![0.0; knobs.len()], values: values.clone(), slopes };
        let hanging = Earlier::of(&run);
        Ok(Self { asked, figures, knobs, model, before: values, first: report, hanging, drapes: 1, refused })
    }

    /// Searches, and says what came of it.
    pub(super) fn finish(mut self, progress: &mut dyn FnMut(&str, f64)) -> Result<Fitting, PipelineError> {
        let met = self.figures.iter().zip(&self.before).all(|(figure, value)| figure.is_met(*value));
        if !self.refused.is_empty() || met {
            return Ok(self.told(None, &[]));
        }
        self.try_knobs()?;
        while !self.is_near() && self.drapes + 2 < self.asked.drapes && self.step(progress)? {}
        // What a drape that goes on makes of a garment may differ a little from one that begins anew.
        let reasons = reasons(&self.model, &self.figures, &self.knobs);
        if !reasons.is_empty() && self.farthest(&self.best()) > FAR {
            self.refused = reasons;
            return Ok(self.told(None, &[]));
        }
        self.verify(progress)
    }

    /// Drapes new files from nothing, until one has the figures that are wanted, or none better is to be had.
    ///
    /// Drapes that go on from one another differ a little from one that begins anew. Figures that are met but not near
    /// their aims are therefore corrected once, with what the drape from nothing taught.
    fn verify(mut self, progress: &mut dyn FnMut(&str, f64)) -> Result<Fitting, PipelineError> {
        let mut at = self.rounded(&self.model.at);
        let mut met: Option<Met> = None;
        loop {
            let (new, draped) = self.verified(&at, progress)?;
            let Some(values) = self.values(&draped.report) else {
                let missing = self.figures.iter().filter(|f| f.measured(&draped.report).is_none());
                self.refused = missing.map(Figure::missing).collect();
                return Ok(self.ended(met));
            };
            self.model.learn(&at, &values);
            self.model.go(&at, &values);
            let is_correction = met.is_some();
            if self.figures.iter().zip(&values).all(|(f, v)| f.is_met(*v)) {
                let worse = self.worse(&draped.report);
                let this = Met { at: at.clone(), values, new, worse };
                met = Some(match met {
                    Some(other) => this.or_nearer(other, &self.figures),
                    None => this,
                });
            }
            let next = self.rounded(&self.best());
            let is_best = next == at || (met.is_some() && self.is_near());
            if is_correction || is_best || self.drapes >= self.asked.drapes {
                return Ok(self.ended(met));
            }
            at = next;
        }
    }

    /// The outcome with the garment that meets all wants, or with the reasons why none does.
    fn ended(mut self, met: Option<Met>) -> Fitting {
        if let Some(met) = met {
            self.refused = Vec::new();
            self.model.go(&met.at, &met.values);
            return self.told(Some(met.new), &met.worse);
        }
        if self.refused.is_empty() {
            let reasons = reasons(&self.model, &self.figures, &self.knobs);
            self.refused = if reasons.is_empty() { vec![self.not_reached()] } else { reasons };
        }
        self.told(None, &[])
    }

    fn is_near(&self) -> bool {
        self.figures.iter().zip(&self.model.values).all(|(f, v)| f.off(*v).abs() < NEAR)
    }

    /// The best amounts that the model knows.
    fn best(&self) -> Vec<f64> {
        let ranges: Vec<[f64; 2]> = self.knobs.iter().map(|knob| knob.range).collect();
        let all: Vec<usize> = (0..self.figures.len()).collect();
        self.model.best(&self.figures, &all, &ranges)
    }

    /// How far the worst figure is off at these amounts, in tolerances.
    fn farthest(&self, at: &[f64]) -> f64 {
        let values = self.model.predicted(at);
        self.figures.iter().zip(&values).map(|(f, v)| f.off(*v).abs()).fold(0.0, f64::max)
    }

    /// Amounts as they are written.
    fn rounded(&self, at: &[f64]) -> Vec<f64> {
        let round = |(x, knob): (&f64, &Knob)| ((x / ROUNDED).round() * ROUNDED).clamp(knob.range[0], knob.range[1]);
        at.iter().zip(&self.knobs).map(round).collect()
    }

    /// The figures of a report. `None` where one of them cannot be measured.
    fn values(&self, report: &Report) -> Option<Vec<f64>> {
        self.figures.iter().map(|figure| figure.measured(report)).collect()
    }

    /// The garment with the knobs set to these amounts.
    fn altered(&self, at: &[f64]) -> Result<Loaded, PipelineError> {
        Ok(self.asked.loaded.altered(&alterations(&self.knobs, at))?)
    }

    /// Moves each knob alone, away from its nearer end, or the other way if the garment cannot be made so.
    fn try_knobs(&mut self) -> Result<(), PipelineError> {
        let start: Vec<f64> = self.knobs.iter().map(Knob::start).collect();
        if start.iter().any(|x| *x != 0.0) {
            let draped = drape(self.asked, &self.altered(&start)?, self.hanging.as_ref(), &mut |_| {})?;
            self.drapes += 1;
            let Some(values) = self.values(&draped.report) else { return Ok(()) };
            self.model.go(&start, &values);
            self.hanging = draped.hanging;
        }
        let this = &*self;
        let tried: Vec<Result<(f64, Vec<f64>), PipelineError>> =
            (0..self.knobs.len()).into_par_iter().map(|k| this.tried(&start, k)).collect();
        for (k, tried) in tried.into_iter().enumerate() {
            self.drapes += 1;
            let (by, values) = tried?;
            for (w, value) in values.iter().enumerate() {
                self.model.slopes[w][k] = (value - self.model.values[w]) / by;
            }
        }
        Ok(())
    }

    /// The change of one knob and the figures with it.
    fn tried(&self, start: &[f64], k: usize) -> Result<(f64, Vec<f64>), PipelineError> {
        let [low, high] = self.knobs[k].range;
        let by = TRIED.max(PART * (high - low)).min(0.5 * (high - low));
        // Letting out is safe where cloth is tight, and shorter where a hem lies on the floor.
        let first = if start[k] - low >= by { -by } else { by };
        let mut failed = None;
        for by in [first, -first] {
            let mut at = start.to_vec();
            at[k] += by;
            if !(low..=high).contains(&at[k]) {
                continue;
            }
            let made = self.altered(&at).and_then(|new| drape(self.asked, &new, self.hanging.as_ref(), &mut |_| {}));
            match made.map(|draped| self.values(&draped.report)) {
                Ok(Some(values)) => return Ok((by, values)),
                Ok(None) => {}
                Err(error) => failed = Some(error),
            }
        }
        // What cannot be moved does nothing.
        failed.map_or_else(|| Ok((by, self.model.values.clone())), Err)
    }

    /// A step of least squares. False where there is none left to make, or it gained little.
    fn step(&mut self, progress: &mut dyn FnMut(&str, f64)) -> Result<bool, PipelineError> {
        let ranges: Vec<[f64; 2]> =
            self.knobs.iter().zip(&self.model.at).map(|(k, x)| within_reach(k.range, *x)).collect();
        let all: Vec<usize> = (0..self.figures.len()).collect();
        let best = self.model.best(&self.figures, &all, &ranges);
        let way: Vec<f64> = best.iter().zip(&self.model.at).map(|(a, b)| a - b).collect();
        if way.iter().all(|w| w.abs() < STILL) {
            return Ok(false);
        }
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            let at: Vec<f64> = self.model.at.iter().zip(&way).map(|(x, w)| x + share * w).collect();
            if self.drapes + 2 >= self.asked.drapes {
                return Ok(false);
            }
            if let Some(tried) = self.made(at, progress) {
                return Ok(self.taken(tried));
            }
            share *= 0.5;
        }
        Ok(false)
    }

    /// The garment with these amounts, draped. `None` where it cannot be made or measured.
    fn made(&mut self, at: Vec<f64>, progress: &mut dyn FnMut(&str, f64)) -> Option<Tried> {
        let new = self.altered(&at).ok()?;
        self.drapes += 1;
        let name = format!("drape {}", self.drapes);
        let draped = drape(self.asked, &new, self.hanging.as_ref(), &mut |share| progress(&name, share)).ok()?;
        self.values(&draped.report).map(|values| (at, values, draped))
    }

    /// Learns from a step, and goes there if it is better. False where it is hardly so.
    fn taken(&mut self, (at, values, draped): Tried) -> bool {
        let (before, after) = (cost(&self.figures, &self.model.values), cost(&self.figures, &values));
        self.model.learn(&at, &values);
        if after < before {
            self.model.go(&at, &values);
            self.hanging = draped.hanging;
        }
        after < WORTH * before
    }

    /// The new file with these amounts, draped from nothing.
    fn verified(
        &mut self,
        at: &[f64],
        progress: &mut dyn FnMut(&str, f64),
    ) -> Result<(New, FittedDrape), PipelineError> {
        let list = alterations(&self.knobs, at);
        let new = appended(self.asked.new, self.asked.loaded.text(), &list)?;
        let loaded = read_text(&self.asked.loaded.garment.name, self.asked.new, &new.text)?;
        self.drapes += 1;
        let name = format!("drape {}", self.drapes);
        let draped = drape(self.asked, &loaded, None, &mut |share| progress(&name, share))?;
        Ok((New { alterations: list, text: new.text, in_place: new.in_place }, draped))
    }

    /// Problems of a garment that the one before did not have.
    fn worse(&self, report: &Report) -> Vec<String> {
        // Figures differ in any case: texts are compared up to their first number.
        let kind = |text: &str| text.split(|c: char| c.is_ascii_digit()).next().unwrap_or_default().to_owned();
        let known: Vec<String> = self.first.problems.iter().map(|text| kind(text)).collect();
        report.problems.iter().filter(|text| !known.contains(&kind(text))).cloned().collect()
    }

    fn not_reached(&self) -> String {
        let missed = self.figures.iter().zip(&self.model.values).filter(|(f, v)| !f.is_met(**v));
        let said: Vec<String> =
            missed.map(|(f, v)| format!("{} is {} (wanted: {})", f.name, f.shown(*v), f.words())).collect();
        format!("not reached in {} drapes: {}; --drapes allows more", self.drapes, said.join(", "))
    }

    /// The outcome.
    fn told(self, new: Option<New>, worse: &[String]) -> Fitting {
        let row = |(k, figure): (usize, &Figure)| WantRow {
            want: figure.name.clone(),
            unit: figure.unit,
            from: figure.wanted.from,
            to: figure.wanted.to,
            before: self.before[k],
            after: self.model.values[k],
            ok: figure.is_met(self.model.values[k]),
        };
        let knob = |(k, knob): (usize, &Knob)| KnobRow {
            knob: knob.name.clone(),
            amount: self.model.at[k],
            from: knob.range[0],
            to: knob.range[1],
            at_end: knob.range.contains(&self.model.at[k]),
            effects: self.model.slopes.iter().map(|slopes| 10.0 * slopes[k]).collect(),
        };
        let orders = self.knobs.iter().zip(&self.model.at).filter_map(|(knob, x)| order(knob, *x));
        Fitting {
            garment: self.first.garment.clone(),
            mannequin: self.first.mannequin.clone(),
            fabric: self.first.fabric.clone(),
            spacing: self.first.spacing,
            drapes: self.drapes,
            wants: self.figures.iter().enumerate().map(row).collect(),
            knobs: self.knobs.iter().enumerate().map(knob).collect(),
            changes: if new.is_some() { orders.collect() } else { Vec::new() },
            alter: new.iter().flat_map(|new| new.alterations.iter().filter_map(|a| alteration_line(a).ok())).collect(),
            refused: self.refused.clone(),
            problems: worse.to_vec(),
            new,
        }
    }
}

/// The knobs of the file of wants, or those that are found for figures: for all if these are few, else for those that
/// are not what they should be.
fn knobs(asked: &Asked, figures: &[Figure], seen: &FirstDrape) -> Vec<Knob> {
    let given = asked.wants.map_or(&[][..], |file| &file.knobs[..]);
    if !given.is_empty() {
        return given.iter().map(Knob::given).collect();
    }
    let is_off = |figure: &&Figure| figure.measured(seen.report).is_none_or(|value| !figure.is_met(value));
    let off: Vec<&Figure> = figures.iter().filter(is_off).collect();
    let all: Vec<&Figure> = off.iter().copied().chain(figures.iter().filter(|f| !is_off(f))).collect();
    seen.knobs(if figures.len() <= FEW { &all } else { &off })
}

/// The part of a knob's range that one step reaches.
fn within_reach([low, high]: [f64; 2], x: f64) -> [f64; 2] {
    let reach = REACH.0.max(REACH.1 * (high - low));
    [low.max(x - reach), high.min(x + reach)]
}
