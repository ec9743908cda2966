//! The compiled part of the Python package `toile`.
//!
//! `garment`, `result` and `fit` are the classes of a garment and of what was made of it, `library` bodies and fabrics,
//! `arguments` and `options` what Python hands over,
//! `surface` flattening, `batch` lists of jobs, `work` how anything long runs, `errors` how it fails.

#![allow(missing_docs, reason = "the documentation of Python's names is in their own doc comments")]

mod arguments;
mod batch;
mod errors;
mod fit;
mod garment;
mod library;
mod options;
mod result;
mod surface;
mod work;

use pyo3::prelude::*;

#[pymodule]
fn _toile(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("__build__", toile::batch::BUILD)?;
    module.add_class::<garment::Garment>()?;
    module.add_class::<result::Result>()?;
    module.add_class::<fit::Fit>()?;
    module.add_class::<library::Body>()?;
    module.add_class::<library::Fabric>()?;
    module.add_class::<surface::Flat>()?;
    module.add_function(wrap_pyfunction!(surface::flatten, module)?)?;
    module.add_function(wrap_pyfunction!(batch::run_batch, module)?)?;
    module.add_function(wrap_pyfunction!(batch::run_job, module)?)?;
    module.add_class::<batch::Hold>()?;
    module.add_function(wrap_pyfunction!(batch::read_list, module)?)?;
    module.add_function(wrap_pyfunction!(batch::check_list, module)?)?;
    module.add_function(wrap_pyfunction!(batch::cli, module)?)
}
