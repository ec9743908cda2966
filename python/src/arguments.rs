//! What Python hands over, as far as its own conversions do not do: whole numbers of any size, and objects that stand
//! for a name or a file.

use std::path::{Path, PathBuf};

use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use toile::input::{is_file_name, whole};

use crate::errors;

/// A whole number. One that is too large for a machine is the largest that it has: it is as wrong, or as much as all.
#[derive(Clone, Copy)]
pub(crate) struct Count(pub(crate) i64);

impl<'a, 'py> FromPyObject<'a, 'py> for Count {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        match value.extract::<i64>() {
            Err(error) if error.is_instance_of::<PyOverflowError>(value.py()) => {
                Ok(Self(if value.lt(0)? { i64::MIN } else { i64::MAX }))
            }
            number => number.map(Self),
        }
    }
}

/// A library name or a file.
pub(crate) struct Named(String);

impl Named {
    /// The name or path, as `--body` and `--fabric` take it. A file is named from the root on: the program may go to
    /// another folder.
    pub(crate) fn name(self, shipped: &[&str]) -> String {
        if is_file_name(&self.0, shipped) { whole(Path::new(&self.0)).display().to_string() } else { self.0 }
    }

    /// As it was given.
    pub(crate) fn text(self) -> String {
        self.0
    }

    /// A text or a path; `None` of anything else.
    pub(crate) fn of(value: &Bound<'_, PyAny>) -> Option<Self> {
        let text = value.extract::<String>();
        text.ok().or_else(|| Some(value.extract::<PathBuf>().ok()?.display().to_string())).map(Self)
    }
}

impl<'a, 'py> FromPyObject<'a, 'py> for Named {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        Self::of(&value).ok_or_else(|| wrong_kind(&value, "a name of the library or a file"))
    }
}

/// A class of ours, or a name or file that stands for an object of it.
pub(crate) enum Given<T> {
    Object(Py<T>),
    Named(Named),
}

impl<T: pyo3::PyClass> Given<T> {
    /// `what` says what is expected.
    pub(crate) fn of(value: &Bound<'_, PyAny>, what: &str) -> PyResult<Self> {
        if let Ok(object) = value.cast::<T>() {
            return Ok(Self::Object(object.clone().unbind()));
        }
        Named::of(value).map(Self::Named).ok_or_else(|| wrong_kind(value, what))
    }
}

/// `toile.InputError`: a value of another kind than is expected.
pub(crate) fn wrong_kind(value: &Bound<'_, PyAny>, expected: &str) -> PyErr {
    let kind = value.get_type().name().map_or_else(|_| "something else".to_owned(), |name| name.to_string());
    errors::input(value.py(), format!("{expected} is expected, not {kind}"))
}
