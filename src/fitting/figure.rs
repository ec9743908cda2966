//! Figures of a report that can be wanted.

use crate::geometry::MM;
use crate::pattern::{Bound, Garment, WantFile, Wanted, is_girth};
use crate::report::{Report, WornLength};

/// Per cent in a fraction of 1.
const PERCENT: f64 = 1e2;
/// How far a measured length may be from the one that is wanted, mm. A garment that is draped twice, once going on and
/// once from nothing, differs by half a millimetre at a girth.
const LENGTH: f64 = 2.0;
/// The same of a pressure, kPa: a twentieth of the pressure at which cloth is tight.
const PRESSURE: f64 = 0.1;
/// The same of a thread's extension, per cent of its limit.
const STRAIN: f64 = 2.0;

/// A figure and what it should be, in the units of the report: mm, kPa, or per cent of the limit.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Figure {
    pub(super) want: WantFile,
    /// `ease at the bust`.
    pub(super) name: String,
    /// `mm`, `kPa` or `%`.
    pub(super) unit: &'static str,
    pub(super) wanted: Wanted,
    /// How far a figure may be from a single value that is wanted.
    pub(super) tolerance: f64,
}

impl Figure {
    /// The figure that a want is about.
    pub(super) fn new(want: &WantFile) -> Self {
        let (name, unit, range) = match want {
            WantFile::Ease(girth, range) => (format!("ease at the {girth}"), "mm", range),
            WantFile::Pressure(girth, range) => (format!("pressure at the {girth}"), "kPa", range),
            WantFile::HemLevel(range) => ("highest above lowest point of the hem".into(), "mm", range),
            WantFile::HemHeight(range) => ("hem above the floor".into(), "mm", range),
            WantFile::SleeveEnd(range) => ("sleeves beyond the wrists".into(), "mm", range),
            WantFile::LegEnd(range) => ("legs beyond the ankles".into(), "mm", range),
            WantFile::Strain(range) => ("extension of threads".into(), "%", range),
        };
        let (scale, tolerance) = match unit {
            "mm" => (MM, LENGTH),
            "kPa" => (1.0, PRESSURE),
            _ => (PERCENT, STRAIN),
        };
        // As it was written, not with the rounding of metres.
        let shown = |x: f64| (x * scale * 1e9).round() / 1e9;
        let wanted = Wanted { from: range.from.map(shown), to: range.to.map(shown) };
        Self { want: want.clone(), name, unit, wanted, tolerance }
    }

    /// The figure in a report. `None` where there is nothing to measure.
    pub(super) fn measured(&self, report: &Report) -> Option<f64> {
        let fit = report.fit.as_ref()?;
        let against = |end: &str| fit.lengths.iter().filter(|l| l.against.ends_with(end)).collect::<Vec<&WornLength>>();
        match &self.want {
            WantFile::Ease(girth, _) => mean(fit.girths.iter().filter(|g| is_girth(girth, &g.name)).map(|g| g.ease)),
            WantFile::Pressure(girth, _) => {
                let rows = fit.girths.iter().filter(|g| is_girth(girth, &g.name));
                rows.filter_map(|g| Some(g.pressure?.max)).reduce(f64::max)
            }
            WantFile::HemLevel(_) => against("floor").iter().filter_map(|l| l.level).reduce(f64::max),
            WantFile::HemHeight(_) => mean(against("floor").iter().map(|l| l.value)),
            WantFile::SleeveEnd(_) => mean(against("wrist").iter().map(|l| l.value)),
            WantFile::LegEnd(_) => mean(against("ankle").iter().map(|l| l.value)),
            WantFile::Strain(_) => fit.girths.iter().map(|g| PERCENT * g.cloth).reduce(f64::max),
        }
    }

    /// The message that there is nothing to measure.
    pub(super) fn missing(&self) -> String {
        let why = match &self.want {
            WantFile::Ease(girth, _) | WantFile::Pressure(girth, _) => {
                format!("no cloth goes round the body at the {girth}")
            }
            WantFile::HemLevel(_) | WantFile::HemHeight(_) => "it has no hem above a floor".into(),
            WantFile::SleeveEnd(_) => "nothing of it is round an arm".into(),
            WantFile::LegEnd(_) => "nothing of it is round one leg".into(),
            WantFile::Strain(_) => "it goes round no girth of the body".into(),
        };
        format!("{}: {why}", self.name)
    }

    /// Whether a value is what is wanted.
    pub(super) fn is_met(&self, value: f64) -> bool {
        let Wanted { from, to } = self.wanted;
        let slack = if from == to { self.tolerance } else { 0.0 };
        from.is_none_or(|from| value >= from - slack) && to.is_none_or(|to| value <= to + slack)
    }

    /// The range to aim at: within the one that is wanted, so that a drape that differs a little keeps it as well.
    pub(super) fn aim(&self) -> [f64; 2] {
        let Wanted { from, to } = self.wanted;
        let inside = from.zip(to).map_or(self.tolerance, |(from, to)| self.tolerance.min((to - from) / 4.0));
        [from.map_or(f64::NEG_INFINITY, |x| x + inside), to.map_or(f64::INFINITY, |x| x - inside)]
    }

    /// How far a value is from the range to aim at, in tolerances: negative below it, zero within.
    pub(super) fn off(&self, value: f64) -> f64 {
        let [from, to] = self.aim();
        (value - value.clamp(from, to)) / self.tolerance
    }

    /// The wanted range, in words: `60 to 90 mm`.
    pub(super) fn words(&self) -> String {
        let unit = self.unit;
        match (self.wanted.from, self.wanted.to) {
            (Some(from), Some(to)) if from == to => format!("{from} {unit}"),
            (Some(from), Some(to)) => format!("{from} to {to} {unit}"),
            (Some(from), None) => format!("{from} {unit} or more"),
            (None, Some(to)) => format!("{to} {unit} or less"),
            (None, None) => "anything".into(),
        }
    }

    /// A value of it, in words.
    pub(super) fn shown(&self, value: f64) -> String {
        let digits = if self.unit == "kPa" { 2 } else { 1 };
        format!("{value:.digits$} {}", self.unit)
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let values: Vec<f64> = values.collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// The wants that a garment's own tests say, or else that no girth is tight.
pub(super) fn own_wants(garment: &Garment, report: &Report) -> Vec<WantFile> {
    let of = |bound: &Bound| match bound {
        Bound::Ease { girth, from, to } => Some(WantFile::Ease(girth.clone(), Wanted { from: *from, to: *to })),
        Bound::Pressure(girth, below) => {
            Some(WantFile::Pressure(girth.clone(), Wanted { from: None, to: Some(*below) }))
        }
        Bound::HemLevel(within) => Some(WantFile::HemLevel(Wanted { from: None, to: Some(*within) })),
        _ => None,
    };
    let tests = garment.tests.iter().filter(|test| test.fabric.is_none());
    let own: Vec<WantFile> = tests.filter_map(|test| of(&test.bound)).collect();
    if !own.is_empty() {
        return own;
    }
    let fit = report.fit.iter();
    let tight = |fit: &crate::report::Fit| Wanted { from: None, to: Some(fit.bands.tight) };
    let girths = fit.flat_map(|fit| fit.girths.iter().map(move |g| (g, tight(fit))));
    girths.filter(|(g, _)| g.pressure.is_some()).map(|(g, range)| WantFile::Pressure(g.name.clone(), range)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Fit, Girth};

    fn ease(from: f64, to: f64) -> Figure {
        Figure::new(&WantFile::Ease("biceps".into(), Wanted { from: Some(from), to: Some(to) }))
    }

    #[test]
    fn a_range_is_aimed_at_from_within_and_a_value_has_a_tolerance() {
        let range = ease(0.06, 0.09);
        assert_eq!((range.aim(), range.words()), ([62.0, 88.0], "60 to 90 mm".to_owned()));
        assert!(range.is_met(60.0) && !range.is_met(59.9));
        assert_eq!((range.off(58.0), range.off(90.0), range.off(70.0)), (-2.0, 1.0, 0.0));
        let value = ease(0.08, 0.08);
        assert_eq!(value.aim(), [80.0, 80.0]);
        assert!(value.is_met(81.9) && !value.is_met(82.1));
    }

    #[test]
    fn both_sides_count_alike() {
        let girth = |name: &str, ease: f64| Girth { name: name.into(), ease, ..Girth::default() };
        let girths = vec![girth("left biceps", 50.0), girth("right biceps", 54.0), girth("waist", 3.0)];
        let report = Report { fit: Some(Fit { girths, ..Fit::default() }), ..Report::default() };
        assert_eq!(ease(0.0, 0.1).measured(&report), Some(52.0));
        let none = Figure::new(&WantFile::Ease("hip".into(), Wanted { from: None, to: None }));
        assert_eq!((none.measured(&report), none.missing().contains("at the hip")), (None, true));
    }
}
