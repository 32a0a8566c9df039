//! `asperity._core`: what the Python package calls. Thin: it converts numbers, lets other threads of Python run, and
//! passes errors on with the same words. The interface that users see is in `python/asperity`.

mod contact;
mod error;
mod march;
mod material;
mod session;
mod store;
mod surface;
mod wait;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    use super::*;

    #[pymodule_export]
    use super::contact::elastic;
    #[pymodule_export]
    use super::error::{CaseError, ConvergenceError};
    #[pymodule_export]
    use super::march::March;
    #[pymodule_export]
    use super::material::Body;
    #[pymodule_export]
    use super::session::{check, report, run};
    #[pymodule_export]
    use super::store::Store;
    #[pymodule_export]
    use super::surface::{
        gap, level, power_spectrum, read_surface, self_affine, shape, statistics, write_surface,
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
