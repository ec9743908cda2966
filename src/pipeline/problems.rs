//! Everything that is wrong with a result, in words.

use std::borrow::Cow;

use super::AT_REST;
use super::job::Job;
use super::tight::tight;
use crate::pattern::Bound;
use crate::report::{ClosureReport, FormReport, Report, restless, verdicts};

/// Something that a maker should know before any figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResultProblem {
    /// The problem in words, with its place and figures.
    pub text: String,
    /// Whether a bound of the garment is broken.
    pub out_of_bounds: bool,
}

/// The problems of a result: stages that did not come to rest, closures that stay open, bunched and tight cloth, then
/// the bounds that are broken.
pub fn problems(job: &Job, report: &Report) -> Vec<ResultProblem> {
    let mut texts: Vec<String> = restless(&report.stages, AT_REST).iter().map(ToString::to_string).collect();
    texts.extend(report.from.as_ref().filter(|from| from.anew).map(|from| {
        format!("the garment in {} could not be carried over: this one was made from nothing", from.folder)
    }));
    texts.extend(report.closures.iter().filter_map(ClosureReport::unclosed));
    texts.extend(report.bunched.iter().map(ToString::to_string));
    // A form that has been changed is no drape of the pattern as it is drawn.
    let form = report.form.as_ref().filter(|form| form.is_changed());
    texts.extend(form.is_none().then(|| tight(job, report)).flatten());
    let mut out: Vec<ResultProblem> =
        texts.into_iter().map(|text| ResultProblem { text, out_of_bounds: false }).collect();
    let mut garment = Cow::Borrowed(&job.garment);
    if form.is_some() {
        garment.to_mut().tests.retain(|test| !matches!(test.bound, Bound::Drape { .. } | Bound::Flatten { .. }));
    }
    out.extend(
        report.form.iter().flat_map(FormReport::problems).map(|text| ResultProblem { text, out_of_bounds: true }),
    );
    let broken = verdicts(&garment, report).into_iter().filter(|verdict| !verdict.ok);
    out.extend(broken.map(|verdict| ResultProblem { text: format!("out of bounds: {verdict}"), out_of_bounds: true }));
    out
}
