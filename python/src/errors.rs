//! Errors as Python's exceptions. Their classes are in `toile/_errors.py`.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use toile::batch::{BatchError, Mistake};
use toile::io::files::WriteError;
use toile::io::garment::Refused;
use toile::pattern::{Diagnostic, Severity};
use toile::pipeline::{PipelineError, ResultFile};

/// Mistakes of a list that are shown.
const SHOWN: usize = 10;

/// An exception of `toile._errors`.
fn exception(py: Python<'_>, class: &str, message: String) -> PyResult<PyErr> {
    let made = py.import("toile._errors")?.getattr(class)?.call1((message,))?;
    Ok(PyErr::from_value(made))
}

fn or_else(made: PyResult<PyErr>) -> PyErr {
    made.unwrap_or_else(|error| error)
}

/// Advice with options of the command line, and what it is in Python. Nothing stands for what Python does not have.
const ADVICE: [(&str, &str); 8] = [
    ("; choose another folder with -o", "; choose another"),
    ("--up y", "up=(0, 1, 0)"),
    ("--cut auto", "cut=True"),
    ("; --cut A,B,… cuts along a way of your own", ""),
    ("--weld joins", "weld=0.01 joins"),
    ("--weld 0", "weld=0"),
    (", and --color strain shows where", ""),
    ("--units says another, as 'pt' (72 to the inch) or 'mm'", "units says another, as 25.4 / 72 for points"),
];

/// Options of the command line that messages name, and what Python calls them. A name that begins with another one
/// comes before that.
const OPTIONS: [(&str, &str); 16] = [
    ("--body-units", "body_units"),
    ("--body", "body"),
    ("--fabric", "fabric"),
    ("--spacing", "spacing"),
    ("--pressure-bands", "pressure_bands"),
    ("--from", "start"),
    ("--size", "size"),
    ("--drapes", "drapes"),
    ("--units", "units"),
    ("--cut", "cut"),
    ("--dart", "darts"),
    ("--mode", "mode"),
    ("--threads", "threads"),
    ("--memory", "memory"),
    ("--time", "time"),
    ("--jobs", "side_by_side"),
];

/// A message of the library in Python's words.
pub(crate) fn in_python(message: &str) -> String {
    ADVICE.iter().chain(&OPTIONS).fold(message.to_owned(), |text, (option, name)| text.replace(option, name))
}

/// Messages of the library in Python's words.
pub(crate) fn all_in_python(messages: &[String]) -> Vec<String> {
    messages.iter().map(|message| in_python(message)).collect()
}

/// `toile.InputError`
pub(crate) fn input(py: Python<'_>, message: impl ToString) -> PyErr {
    or_else(exception(py, "InputError", in_python(&message.to_string())))
}

/// `toile.WriteError`, or `toile.InputError` where a result would replace an input.
pub(crate) fn write(py: Python<'_>, error: &WriteError) -> PyErr {
    let class = if matches!(error, WriteError::IsInput(_)) { "InputError" } else { "WriteError" };
    or_else(exception(py, class, in_python(&error.to_string())))
}

/// `toile.ComputationError` with the files of the state that was reached.
fn computation(py: Python<'_>, message: String, files: &[ResultFile]) -> PyResult<PyErr> {
    let error = exception(py, "ComputationError", in_python(&message))?;
    let state = PyDict::new(py);
    for (name, bytes) in files {
        state.set_item(name, pyo3::types::PyBytes::new(py, bytes))?;
    }
    error.value(py).setattr("files", state)?;
    Ok(error)
}

/// `toile.GarmentError` with its diagnostics.
pub(crate) fn refused(py: Python<'_>, refused: &Refused) -> PyErr {
    let made = || {
        let error = exception(py, "GarmentError", in_python(&refused.to_string()))?;
        error.value(py).setattr("diagnostics", diagnostics(py, &refused.diagnostics)?)?;
        Ok(error)
    };
    or_else(made())
}

/// A list of `toile.Diagnostic`.
pub(crate) fn diagnostics<'py>(py: Python<'py>, all: &[Diagnostic]) -> PyResult<Bound<'py, PyList>> {
    let class = py.import("toile._errors")?.getattr("Diagnostic")?;
    let list = PyList::empty(py);
    for d in all {
        let severity = match d.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let (message, hint, text) =
            (in_python(&d.message), d.hint.as_deref().map(in_python), in_python(&d.to_string()));
        list.append(class.call1((severity, &d.file, d.line, d.column, message, hint, text))?)?;
    }
    Ok(list)
}

/// The exception of a stage's error; `files` are those of the state that was reached.
pub(crate) fn pipeline(py: Python<'_>, error: &PipelineError, files: &[ResultFile]) -> PyErr {
    match error {
        PipelineError::Garment(all) => refused(py, all),
        error if error.is_input() => input(py, error),
        error => or_else(computation(py, error.to_string(), files)),
    }
}

/// Jobs of a list from Python that are none.
pub(crate) fn jobs(py: Python<'_>, mistakes: &[Mistake]) -> PyErr {
    let line = |m: &Mistake| format!("job {}: {}", m.line, m.why);
    let more = mistakes.len().saturating_sub(SHOWN);
    let mut lines: Vec<String> = mistakes.iter().take(SHOWN).map(line).collect();
    lines.extend((more > 0).then(|| format!("and {more} more")));
    input(py, lines.join("\n"))
}

/// The exception of a batch's error.
pub(crate) fn batch(py: Python<'_>, error: &BatchError) -> PyErr {
    match error {
        // The signal's own exception is raised where it was found.
        error if error.is_input() => input(py, error),
        error => or_else(computation(py, error.to_string(), &[])),
    }
}
