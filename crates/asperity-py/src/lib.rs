//! `asperity._core`: what the Python package calls. Thin: it converts numbers, lets other threads of Python run, and
//! passes errors on with the same words. The interface that users see is in `python/asperity`.

mod command;
mod contact;
mod cycles;
mod error;
mod fit;
mod force_curve;
mod force_file;
mod given;
mod indentation;
mod kernel;
mod leakage;
mod march;
mod material;
mod registry;
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
    use super::{
        command::command,
        contact::{Elastic, spot_labels},
        cycles::cycles_of,
        error::{CaseError, ConvergenceError, FormatError},
        fit::{fit, fit_file, read_shift_table},
        force_curve::fit_force_curve,
        force_file::read_force_file,
        indentation::fit_indentation,
        leakage::{judge_leaks, leakage},
        march::March,
        material::{Body, layer_compliance, shift_factor, vertical_shift_factor},
        registry::{histogram_coordinates, registry, waitable},
        session::{case_text, check, converge, report, run},
        sliding::Persson,
        store::{Store, derive_again},
        stress::{Stress, stress_transverse},
        surface::{Heights, heights, read_surface},
        units::{readable_unit, unit_factor},
        wait::{set_threads, threads},
        writer::Writer,
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("LAYERED_STRESS", asperity_io::stress::LAYERED)?;
        module.add("POLYMERS", asperity::finding::TEMPERATURES)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
