//! `asperity._core`: what the Python package calls. Thin: it converts numbers, lets other threads of Python run, and
//! passes errors on with the same words. The interface that users see is in `python/asperity`.

mod command;
mod contact;
mod cycles;
mod error;
mod fit;
mod given;
mod indentation;
mod kernel;
mod leakage;
mod march;
mod material;
mod session;
mod sliding;
mod store;
mod stress;
mod surface;
mod trace;
mod units;
mod wait;
mod writer;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    use super::*;

    #[pymodule_export]
    use super::command::command;
    #[pymodule_export]
    use super::contact::{Elastic, spot_labels};
    #[pymodule_export]
    use super::cycles::cycles_of;
    #[pymodule_export]
    use super::error::{CaseError, ConvergenceError, FormatError};
    #[pymodule_export]
    use super::fit::{fit, fit_file, read_shift_table};
    #[pymodule_export]
    use super::indentation::fit_indentation;
    #[pymodule_export]
    use super::leakage::{judge_leaks, leakage};
    #[pymodule_export]
    use super::march::{March, fields, quantities, rows};
    #[pymodule_export]
    use super::material::{Body, layer_compliance, shift_factor, vertical_shift_factor};
    #[pymodule_export]
    use super::session::{case_text, check, report, run};
    #[pymodule_export]
    use super::sliding::Persson;
    #[pymodule_export]
    use super::store::{Store, derive_again};
    #[pymodule_export]
    use super::stress::{stress_check, stress_depths, stress_field, stress_survey, stress_transverse};
    #[pymodule_export]
    use super::surface::{
        autocorrelation, bearing_curve, describe, gap, height_distribution, heights, power_spectrum, process,
        profile_parameters, read_surface, write_surface,
    };
    #[pymodule_export]
    use super::units::unit_factor;
    #[pymodule_export]
    use super::wait::{set_threads, threads};
    #[pymodule_export]
    use super::writer::Writer;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("LAYERED_STRESS", asperity_io::stress::LAYERED)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
