//! The material of a half-space, or of a thin sample, from a measured indentation.

use asperity::indentation::{
    IndentationOptions, IndentationRecord, Indenter, Interval, SampleLayer, fit_indentation as fit,
    fit_power_law,
};
use asperity_io::choice;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::Answer;
use crate::given::{Dict, List, choose, entries};
use crate::wait::detached;

/// A thin sample of its thickness, Poisson's ratio and interface.
pub fn sample((thickness, poisson, interface): (f64, f64, String)) -> Answer<SampleLayer> {
    Ok(SampleLayer { thickness, poisson, interface: choose("interface", &interface)? })
}

/// Fits the contact relaxation modulus to a record, as a Prony series or as a power law; `size` is the radius or the half angle of the indenter. `thin` is
/// thickness, Poisson's ratio and interface of a sample on a rigid base; `uncertainties` are those of the size of the profile, the thickness,
/// the load and the sensitivity, over their values. Intervals are (value, low, high, determined).
#[pyfunction]
pub fn fit_indentation<'py>(
    py: Python<'py>,
    times: List<'_>,
    loads: List<'_>,
    depths: List<'_>,
    power_law: bool,
    indenter: &str,
    size: f64,
    given: Option<&str>,
    terms: Option<usize>,
    long_time: &str,
    fit_touch: bool,
    thin: Option<(f64, f64, String)>,
    springs: usize,
    limit: f64,
    uncertainties: [f64; 4],
    spring_constant: Option<f64>,
) -> Answer<Dict<'py>> {
    let [times, loads, depths] = [times, loads, depths].map(|column| column.as_array().to_vec());
    let profile = choose::<Indenter>("indenter", indenter)?.profile(size)?;
    let [radius_uncertainty, thickness_uncertainty, load_uncertainty, sensitivity_uncertainty] =
        uncertainties;
    let options = IndentationOptions {
        radius_uncertainty,
        thickness_uncertainty,
        load_uncertainty,
        spring_constant,
        sensitivity_uncertainty,
        given: given.map(|word| choose("given", word)).transpose()?,
        terms,
        long_time: choose("long_time", long_time)?,
        fit_touch,
        layer: thin.map(sample).transpose()?,
        springs,
        limit,
    };
    let record = IndentationRecord { times: &times, loads: &loads, depths: &depths };
    let interval = |x: Interval| (x.value, x.low, x.high, x.determined);
    let out = PyDict::new(py);
    if power_law {
        let fit = detached(py, || fit_power_law(profile, &record, &options))??;
        out.set_item("modulus", interval(fit.modulus))?;
        out.set_item("exponent", interval(fit.exponent))?;
        for (name, value) in [("touch", fit.touch), ("baseline", fit.baseline), ("tilt", fit.tilt)] {
            out.set_item(name, interval(value))?;
        }
        out.set_item("given", choice::word(&fit.given))?;
        out.set_item("predicted", fit.predicted.into_pyarray(py))?;
        entries!(out, fit; rows rms relative_rms durbin_watson notes);
        out.set_item("window", (fit.window[0], fit.window[1]))?;
        return Ok(out);
    }
    let fit = detached(py, || fit(profile, &record, &options))??;
    out.set_item("equilibrium", interval(fit.equilibrium))?;
    out.set_item("instantaneous", interval(fit.instantaneous))?;
    let terms: Vec<_> =
        fit.terms.iter().map(|[modulus, time]| (interval(*modulus), interval(*time))).collect();
    out.set_item("terms", terms)?;
    for (name, value) in [("touch", fit.touch), ("baseline", fit.baseline), ("tilt", fit.tilt)] {
        out.set_item(name, interval(value))?;
    }
    out.set_item("given", choice::word(&fit.given))?;
    out.set_item("predicted", fit.predicted.into_pyarray(py))?;
    out.set_item("numbers_of_terms", &fit.numbers)?;
    entries!(out, fit; rows rms relative_rms durbin_watson notes);
    out.set_item("window", (fit.window[0], fit.window[1]))?;
    Ok(out)
}
