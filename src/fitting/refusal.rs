//! Why wants cannot be had.

use super::figure::Figure;
use super::knob::Knob;
use super::solve::FigureModel;
use super::words::amount_of;

/// How far a figure may be off its aim and yet be had, in tolerances.
const HAD: f64 = 0.75;
/// Share of its range within which a knob is at its end.
const AT_END: f64 = 1e-3;
/// A knob that moves a figure by less than this over its whole range, in tolerances, does not move it.
const UNMOVED: f64 = 0.5;

/// The reasons, the first of them the plainest. Empty where the model has all figures.
pub(super) fn reasons(model: &FigureModel, figures: &[Figure], knobs: &[Knob]) -> Vec<String> {
    let ranges: Vec<[f64; 2]> = knobs.iter().map(|k| k.range).collect();
    let look = Look { model, figures, knobs, ranges };
    let lone: Vec<usize> = (0..figures.len()).filter(|&w| look.off(&[w]) > HAD).collect();
    if !lone.is_empty() {
        return lone.into_iter().map(|w| look.alone(w)).collect();
    }
    let pairs = (0..figures.len()).flat_map(|a| (a + 1..figures.len()).map(move |b| [a, b]));
    let off = pairs.map(|pair| (look.off(&pair), pair)).filter(|(off, _)| *off > HAD);
    if let Some((_, pair)) = off.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1))) {
        return vec![look.fight(pair)];
    }
    let all: Vec<usize> = (0..figures.len()).collect();
    if look.off(&all) <= HAD { Vec::new() } else { vec![look.together(&all)] }
}

struct Look<'a> {
    model: &'a FigureModel,
    figures: &'a [Figure],
    knobs: &'a [Knob],
    ranges: Vec<[f64; 2]>,
}

impl Look<'_> {
    fn best(&self, of: &[usize]) -> (Vec<f64>, Vec<f64>) {
        let at = self.model.best(self.figures, of, &self.ranges);
        let values = self.model.predicted(&at);
        (at, values)
    }

    /// How far the worst of some figures is off at best, in tolerances, no matter the others.
    fn off(&self, of: &[usize]) -> f64 {
        let (_, values) = self.best(of);
        of.iter().map(|&w| self.figures[w].off(values[w]).abs()).fold(0.0, f64::max)
    }

    /// The best value of one figure, in words.
    fn best_of(&self, figure: &Figure, value: f64) -> String {
        format!("{} (wanted: {})", figure.shown(value), figure.words())
    }

    fn alone(&self, w: usize) -> String {
        let figure = &self.figures[w];
        let reach = |k: usize| (self.model.slopes[w][k] * (self.ranges[k][1] - self.ranges[k][0])).abs();
        let moving: Vec<usize> = (0..self.knobs.len()).filter(|&k| reach(k) > UNMOVED * figure.tolerance).collect();
        let (at, values) = self.best(&[w]);
        if moving.is_empty() {
            let now = figure.shown(self.model.values[w]);
            return format!(
                "{}: no knob moves it from {now} (wanted: {}); give one under 'knobs'",
                figure.name,
                figure.words()
            );
        }
        let ends = self.at_ends(&at, |k| moving.contains(&k));
        let why = if ends.is_empty() { "the knobs do not reach it".to_owned() } else { ends.join("; ") };
        format!("{}: at best {}: {why}", figure.name, self.best_of(figure, values[w]))
    }

    /// The knobs that are at their ends.
    fn at_ends(&self, at: &[f64], of: impl Fn(usize) -> bool) -> Vec<String> {
        let is_at_end = |k: &usize| {
            let [low, high] = self.ranges[*k];
            let near = AT_END * (high - low);
            of(*k) && (at[*k] - low <= near || high - at[*k] <= near)
        };
        let said = |k: usize| format!("'{}' is at its end, {}", self.knobs[k].name, amount_of(&self.knobs[k], at[k]));
        (0..self.knobs.len()).filter(is_at_end).map(said).collect()
    }

    fn fight(&self, [a, b]: [usize; 2]) -> String {
        let [one, other] = [a, b].map(|w| &self.figures[w]);
        let values = [[a], [b]].map(|of| self.best(&of).1);
        format!(
            "{} and {} fight: with {} the {} is {} (wanted: {}), and with {} the {} is {} (wanted: {})",
            one.name,
            other.name,
            one.words(),
            other.name,
            other.shown(values[0][b]),
            other.words(),
            other.words(),
            one.name,
            one.shown(values[1][a]),
            one.words()
        )
    }

    fn together(&self, all: &[usize]) -> String {
        let (at, values) = self.best(all);
        let ends = self.at_ends(&at, |_| true);
        let missed = all.iter().filter(|&&w| self.figures[w].off(values[w]).abs() > HAD);
        let said: Vec<String> = missed
            .map(|&w| format!("{} {}", self.figures[w].name, self.best_of(&self.figures[w], values[w])))
            .collect();
        let ends = if ends.is_empty() { String::new() } else { format!("; {}", ends.join("; ")) };
        format!("any two can be had, but not all together; at best: {}{ends}", said.join(", "))
    }
}
