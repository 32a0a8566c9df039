//! Modulus and work of adhesion from a force curve.

use asperity::force_curve::{ForceOptions, ForceRecord, fit_force_curve as fit};
use asperity::indentation::{Indenter, Interval};
use asperity_io::choice;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::Answer;
use crate::given::{Dict, List, choose, entries};
use crate::indentation::sample;
use crate::wait::detached;

/// Fits a force curve; `size` is the radius or the half angle of the indenter, uncertainties are standard ones over the value. Intervals are (value, low, high, determined).
#[pyfunction]
pub fn fit_force_curve<'py>(
    py: Python<'py>,
    loads: List<'_>,
    depths: List<'_>,
    indenter: &str,
    size: f64,
    thin: Option<(f64, f64, String)>,
    model: &str,
    branch: &str,
    control: Option<&str>,
    weights: &str,
    range: Option<f64>,
    spring_constant: Option<f64>,
    radius_uncertainty: f64,
    thickness_uncertainty: f64,
    load_uncertainty: f64,
    sensitivity_uncertainty: f64,
) -> Answer<Dict<'py>> {
    let [loads, depths] = [loads, depths].map(|column| column.as_array().to_vec());
    let options = ForceOptions {
        model: choose("model", model)?,
        branch: choose("branch", branch)?,
        control: control.map(|word| choose("control", word)).transpose()?,
        weights: choose("weights", weights)?,
        range,
        spring_constant,
        radius_uncertainty,
        layer: thin.map(sample).transpose()?,
        thickness_uncertainty,
        load_uncertainty,
        sensitivity_uncertainty,
    };
    let profile = choose::<Indenter>("indenter", indenter)?.profile(size)?;
    let record = ForceRecord { loads: &loads, depths: &depths };
    let fit = detached(py, || fit(profile, &record, &options))??;
    let interval = |x: Interval| (x.value, x.low, x.high, x.determined);
    let out = PyDict::new(py);
    out.set_item("model", choice::word(&fit.model))?;
    out.set_item("contact_modulus", interval(fit.contact_modulus))?;
    out.set_item("work", interval(fit.work))?;
    out.set_item("transition", fit.lambda.map(interval))?;
    out.set_item("range", fit.range.map(interval))?;
    out.set_item("touch", interval(fit.touch))?;
    out.set_item("baseline", interval(fit.baseline))?;
    out.set_item("tilt", interval(fit.tilt))?;
    out.set_item("predicted", fit.predicted.into_pyarray(py))?;
    entries!(out, fit; rows alpha pull_off_force smallest_load tabor contact_radius relative_rms durbin_watson notes);
    Ok(out)
}
