//! Surfaces: read, written, made, described.

use std::path::PathBuf;
use std::str::FromStr;

use asperity::surface::profile::{self, ProfileParameters};
use asperity::surface::statistics::{
    Autocorrelation, BearingCurve, Extent, RadialSpectrum, Rings, SelfAffineFit, Summary,
};
use asperity::surface::{self, Part, Surface, undeformed_gap};
use asperity_io::case::{fragment, given};
use asperity_io::preparation::{Step, prepare};
use asperity_io::topography::{Format, ReadOptions, Topography, read, read_profile, write};
use ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{self, CaseError, file, raised, topography as topography_error};
use crate::given::{entries, grid_of, table};
use crate::wait::detached;

type Heights<'py> = Bound<'py, PyArray2<f64>>;

/// Heights of the shape or the synthetic roughness that the keys `domain` and `surface` describe; minus infinity where a shape
/// cannot touch.
#[pyfunction]
pub fn heights<'py>(py: Python<'py>, keys: Bound<'_, PyDict>) -> PyResult<Heights<'py>> {
    let (grid, part) = given::surface(&table(&keys)?).map_err(error::of_surface)?;
    let made = detached(py, || match part {
        Part::SelfAffine(roughness) => roughness.heights(&grid),
        Part::Synthesis(roughness) => roughness.heights(&grid),
        Part::Heights { heights, .. } => Ok(heights),
        Part::Shape { shape, center } => {
            let [x0, y0] = grid.centre();
            let at = |i: usize, j: usize| (grid.x(i) - (x0 + center[0]), grid.y(j) - (y0 + center[1]));
            Ok(Array2::from_shape_fn(grid.shape(), |(i, j)| {
                let (x, y) = at(i, j);
                -shape.gap(x, y)
            }))
        }
    })?;
    Ok(made.map_err(|error| raised(py, error))?.into_pyarray(py))
}

/// The undeformed gap of heights, least value 0; a height of minus infinity cannot touch.
#[pyfunction]
pub fn gap<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
) -> PyResult<Heights<'py>> {
    let heights = heights.as_array().as_standard_layout().into_owned();
    let grid = grid_of(py, heights.dim(), &size)?;
    let part = Part::Heights { name: "surface".into(), heights };
    let gap = detached(py, || undeformed_gap(&grid, &[part]))?.map_err(|error| raised(py, error))?;
    Ok(gap.into_pyarray(py))
}

/// Reads a measured surface: heights, size, and what the file says.
#[pyfunction]
#[pyo3(signature = (path, size, height_unit, channel))]
pub fn read_surface<'py>(
    py: Python<'py>,
    path: PathBuf,
    size: Option<Vec<f64>>,
    height_unit: Option<f64>,
    channel: Option<String>,
) -> PyResult<Bound<'py, PyDict>> {
    let of_map = size.as_ref().is_some_and(|size| size.len() == 2);
    let lengths = size.as_ref().and_then(|size| Some([*size.first()?, size.get(1).copied().unwrap_or(1.0)]));
    let options = ReadOptions { size: lengths, height_unit, channel, ..ReadOptions::default() };
    if !of_map
        && let Some(profile) = detached(py, || read_profile(&path, &options))?.map_err(topography_error)?
    {
        let out = PyDict::new(py);
        out.set_item("format", "profile")?;
        out.set_item("history", profile.history)?;
        out.set_item("size", profile.surface.grid().extents().to_vec())?;
        out.set_item("metadata", profile.metadata)?;
        out.set_item("heights", profile.surface.into_heights().into_pyarray(py))?;
        return Ok(out);
    }
    if size.is_some() && !of_map {
        return Err(CaseError::new_err(
            "size has one length, but the file holds no profile: it needs two, along x and y",
        ));
    }
    let topography = detached(py, || read(&path, &options))?.map_err(topography_error)?;
    let out = PyDict::new(py);
    out.set_item("format", topography.format.name())?;
    out.set_item("history", topography.history().collect::<Vec<_>>())?;
    out.set_item("size", topography.size)?;
    out.set_item("channel", topography.channel)?;
    out.set_item("channels", topography.channels)?;
    out.set_item("metadata", topography.metadata)?;
    out.set_item("heights", topography.heights.into_pyarray(py))?;
    Ok(out)
}

/// Writes heights in the format of the path's ending, or of that name.
#[pyfunction]
pub fn write_surface(
    py: Python<'_>,
    path: PathBuf,
    heights: PyReadonlyArray2<'_, f64>,
    size: [f64; 2],
    format: &str,
    history: Vec<String>,
) -> PyResult<()> {
    let format = Format::from_str(format).map_err(|error| CaseError::new_err(error.to_string()))?;
    let heights = heights.as_array().as_standard_layout().into_owned();
    let mut topography =
        Topography { format, heights, size, channel: None, channels: vec![], metadata: vec![] };
    topography.record(history);
    detached(py, || write(&path, &topography, format))?.map_err(file)
}

/// Steps of a preparation, each in words as `asperity surface process --op` takes them: heights, size, and one
/// sentence per step.
#[pyfunction]
pub fn process<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
    steps: Vec<String>,
) -> PyResult<(Heights<'py>, Vec<f64>, Vec<String>)> {
    let steps = steps.iter().map(|words| fragment::step(words).map_err(CaseError::new_err));
    let steps = steps.collect::<PyResult<Vec<Step>>>()?;
    let map = map(py, heights, size)?;
    let prepared = detached(py, || prepare(map, &steps, None))?.map_err(|error| {
        // There is no domain here.
        let reason = error.to_string();
        CaseError::new_err(
            reason.replace("as `cells` of the step or as `domain.cells` of the case", "cells=(nx, ny)"),
        )
    })?;
    let size = prepared.surface.grid().extents().to_vec();
    Ok((prepared.surface.into_heights().into_pyarray(py), size, prepared.history))
}

fn extent(periodic: bool) -> Extent {
    if periodic { Extent::Periodic } else { Extent::Finite }
}

/// Statistics of a surface, as `asperity surface info` tells them; `band` limits the fit of the Hurst exponent.
#[pyfunction]
#[pyo3(signature = (heights, size, periodic, band))]
pub fn describe<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
    periodic: bool,
    band: Option<[f64; 2]>,
) -> PyResult<Bound<'py, PyDict>> {
    let map = map(py, heights, size)?;
    let summary = detached(py, || Summary::of(&map, extent(periodic)))?.map_err(|error| raised(py, error))?;
    let out = PyDict::new(py);
    entries!(out, summary.heights; sa sq ssk sku sp sv sz min max mean);
    out.set_item("undefined", map.undefined())?;
    if let Some(slopes) = &summary.slopes {
        entries!(out, slopes; sdq sdr);
    }
    if let Some(waves) = &summary.waves {
        entries!(out, waves.moments; m0 m2 m4);
        out.set_item("bandwidth", waves.moments.bandwidth())?;
        out.set_item("lay", waves.lay.is_clear())?;
        out.set_item("lay_ratio", waves.lay.ratio)?;
        out.set_item("lay_angle", waves.lay.angle)?;
        let fit = match band {
            Some([longest, shortest]) => Some(
                SelfAffineFit::of(&waves.spectrum, longest, shortest).map_err(|error| raised(py, error))?,
            ),
            None => waves.fit,
        };
        if let Some(fit) = fit {
            entries!(out, fit; hurst roll_off plateau);
            out.set_item("hurst_error", fit.error)?;
            out.set_item("spectrum_misfit", fit.misfit)?;
            let found = Vec::from_iter(asperity::finding::hurst(&fit));
            out.set_item("findings", asperity_io::finding::list(&found).to_string())?;
        }
    }
    Ok(out)
}

/// Parameters of a profile, less its Gaussian mean line where a cut-off is given.
#[pyfunction]
#[pyo3(signature = (heights, spacing, cutoff))]
pub fn profile_parameters<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray1<'_, f64>,
    spacing: f64,
    cutoff: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let heights = heights.as_array().to_vec();
    let found = detached(py, || {
        let heights = match cutoff {
            Some(cutoff) => profile::roughness(&heights, spacing, cutoff)?,
            None => heights,
        };
        ProfileParameters::of(&heights, spacing)
    })?;
    let found = found.map_err(|error| raised(py, error))?;
    let out = PyDict::new(py);
    entries!(out, found; ra rq rz rt rsk rku rsm rdq);
    Ok(out)
}

/// Heights and the share of points at or above each.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn bearing_curve<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
    levels: usize,
) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
    let map = map(py, heights, size)?;
    let curve = detached(py, || BearingCurve::of(&map, levels))?.map_err(|error| raised(py, error))?;
    Ok((curve.heights.into_pyarray(py), curve.share.into_pyarray(py)))
}

/// Middles of bins of height and the density of points in them.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn height_distribution<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
    bins: usize,
) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
    let map = map(py, heights, size)?;
    let (at, density) = detached(py, || surface::statistics::height_distribution(&map, bins))?
        .map_err(|error| raised(py, error))?;
    Ok((at.into_pyarray(py), density.into_pyarray(py)))
}

/// The autocorrelation map, and Sal and Str where they exist.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn autocorrelation<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
    periodic: bool,
) -> PyResult<(Heights<'py>, Option<f64>, Option<f64>)> {
    let map = map(py, heights, size)?;
    let made = detached(py, || {
        let correlation = Autocorrelation::of(&map, extent(periodic))?;
        let numbers = (correlation.length(), correlation.texture_aspect_ratio());
        Ok((correlation, numbers))
    })?;
    let (correlation, (length, aspect)) = made.map_err(|error: asperity::Error| raised(py, error))?;
    Ok((correlation.values.into_pyarray(py), length, aspect))
}

/// Wavenumbers and radially averaged power spectrum.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn power_spectrum<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    size: Vec<f64>,
    per_decade: u32,
) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
    let map = map(py, heights, size)?;
    let rings = if per_decade == 0 { Rings::Linear } else { Rings::PerDecade(per_decade) };
    let spectrum = detached(py, || RadialSpectrum::of(&map, rings))?.map_err(|error| raised(py, error))?;
    Ok((spectrum.wave_number.into_pyarray(py), spectrum.power.into_pyarray(py)))
}

fn map(py: Python<'_>, heights: PyReadonlyArray2<'_, f64>, size: Vec<f64>) -> PyResult<Surface> {
    let heights = heights.as_array().to_owned();
    let grid = grid_of(py, heights.dim(), &size)?;
    Surface::new(grid, heights).map_err(|error| raised(py, error))
}
