//! Surfaces: read, written, made, described.

use std::path::PathBuf;
use std::str::FromStr;

use asperity::surface::profile::{self, ProfileParameters};
use asperity::surface::statistics::{
    Autocorrelation, BearingCurve, Extent, RadialSpectrum, Rings, SelfAffineFit, Summary,
};
use asperity::surface::{self, Part, Roughness, SelfAffine, Shape, Surface, undeformed_gap};
use asperity_io::case::fragment;
use asperity_io::preparation::{Step, prepare};
use asperity_io::topography::{Format, ReadOptions, Topography, read, read_profile, write};
use ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, file, raised, topography as topography_error};
use crate::march::grid_of;
use crate::wait::detached;

type Heights<'py> = Bound<'py, PyArray2<f64>>;

/// Heights of a self-affine surface.
#[pyfunction]
#[pyo3(signature = (cells, size, hurst, rms_gradient, rms_height, longest, shortest, roll_off, seed))]
#[allow(clippy::too_many_arguments)]
pub fn self_affine<'py>(
    py: Python<'py>,
    cells: (usize, usize),
    size: Vec<f64>,
    hurst: f64,
    rms_gradient: Option<f64>,
    rms_height: Option<f64>,
    longest: f64,
    shortest: f64,
    roll_off: Option<f64>,
    seed: u64,
) -> PyResult<Heights<'py>> {
    let roughness = match (rms_gradient, rms_height) {
        (Some(gradient), None) => Roughness::RmsGradient(gradient),
        (None, Some(height)) => Roughness::RmsHeight(height),
        _ => return Err(CaseError::new_err("give rms_gradient or rms_height, exactly one of them")),
    };
    let roll_off = roll_off.unwrap_or(longest);
    let grid = grid_of(py, cells, &size)?;
    let made =
        detached(py, || SelfAffine { hurst, roughness, longest, shortest, roll_off, seed }.heights(&grid))?;
    Ok(made.map_err(|error| raised(py, error))?.into_pyarray(py))
}

/// Heights of a smooth shape in the middle of the domain; minus infinity where it cannot touch.
#[pyfunction]
pub fn shape<'py>(
    py: Python<'py>,
    kind: &str,
    numbers: Vec<f64>,
    center: [f64; 2],
    cells: (usize, usize),
    size: Vec<f64>,
) -> PyResult<Heights<'py>> {
    let shape = match (kind, numbers.as_slice()) {
        ("sphere", [radius]) => Shape::Sphere { radius: *radius },
        ("ellipsoid", [x, y]) => Shape::Ellipsoid { radius_x: *x, radius_y: *y },
        ("cylinder", [radius]) => Shape::Cylinder { radius: *radius },
        ("wedge", [slope]) => Shape::Wedge { slope: *slope },
        ("cone", [slope]) => Shape::Cone { slope: *slope },
        ("flat-punch", [radius]) => Shape::FlatPunch(surface::Punch::Circle { radius: *radius }),
        ("flat-punch", [a, b]) => Shape::FlatPunch(surface::Punch::Rectangle { size: [*a, *b] }),
        ("wave", [amplitude, x, y]) => Shape::Wave { amplitude: *amplitude, wavelength: [*x, *y] },
        _ => {
            return Err(CaseError::new_err(format!(
                "there is no shape '{kind}' of {} numbers",
                numbers.len()
            )));
        }
    };
    shape.validate().map_err(|error| raised(py, error))?;
    let grid = grid_of(py, cells, &size)?;
    let [x0, y0] = grid.centre();
    let at = |i: usize, j: usize| (grid.x(i) - (x0 + center[0]), grid.y(j) - (y0 + center[1]));
    let heights = Array2::from_shape_fn(grid.shape(), |(i, j)| {
        let (x, y) = at(i, j);
        -shape.gap(x, y)
    });
    Ok(heights.into_pyarray(py))
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
    if heights.iter().all(|z| z.is_finite()) {
        let part = Part::Heights { name: "surface".into(), heights };
        let gap = detached(py, || undeformed_gap(&grid, &[part]))?.map_err(|error| raised(py, error))?;
        return Ok(gap.into_pyarray(py));
    }
    if let Some(value) = heights.iter().find(|z| z.is_nan() || **z == f64::INFINITY) {
        let words = "finite, or minus infinity where nothing can touch; fill undefined points first";
        return Err(CaseError::new_err(format!("a height is {value}, but must be {words}")));
    }
    let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if highest == f64::NEG_INFINITY {
        return Err(CaseError::new_err("no height is finite: nothing can touch"));
    }
    Ok(heights.mapv(|z| highest - z).into_pyarray(py))
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

/// Synthetic roughness from the keys of a case (`cells`, `size`, `hurst`, `lay.angle`, ...): heights and size.
#[pyfunction]
pub fn roughness<'py>(py: Python<'py>, keys: Vec<(String, String)>) -> PyResult<(Heights<'py>, Vec<f64>)> {
    let keys: Vec<(&str, &str)> = keys.iter().map(|(key, text)| (key.as_str(), text.as_str())).collect();
    let (grid, part) = fragment::roughness(&keys).map_err(|faults| {
        let told = |fault: &fragment::Fault| {
            let help = fault.help.as_ref().map_or(String::new(), |help| format!("; {help}"));
            format!("{}: {}{help}", fault.key, fault.message)
        };
        CaseError::new_err(faults.iter().map(told).collect::<Vec<_>>().join("\n"))
    })?;
    let heights = detached(py, || match part {
        Part::SelfAffine(roughness) => roughness.heights(&grid),
        Part::Synthesis(roughness) => roughness.heights(&grid),
        Part::Heights { heights, .. } => Ok(heights),
        Part::Shape { shape, .. } => Err(asperity::Error::invalid("kind", shape.name(), "self-affine")),
    })?;
    Ok((heights.map_err(|error| raised(py, error))?.into_pyarray(py), grid.extents().to_vec()))
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
    let z = &summary.heights;
    for (name, value) in [
        ("sa", z.sa),
        ("sq", z.sq),
        ("ssk", z.ssk),
        ("sku", z.sku),
        ("sp", z.sp),
        ("sv", z.sv),
        ("sz", z.sz),
        ("min", z.min),
        ("max", z.max),
        ("mean", z.mean),
    ] {
        out.set_item(name, value)?;
    }
    out.set_item("undefined", map.undefined())?;
    if let Some(slopes) = &summary.slopes {
        out.set_item("sdq", slopes.sdq)?;
        out.set_item("sdr", slopes.sdr)?;
    }
    if let Some(waves) = &summary.waves {
        out.set_item("m0", waves.moments.m0)?;
        out.set_item("m2", waves.moments.m2)?;
        out.set_item("m4", waves.moments.m4)?;
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
            out.set_item("hurst", fit.hurst)?;
            out.set_item("hurst_error", fit.error)?;
            out.set_item("roll_off", fit.roll_off)?;
            out.set_item("plateau", fit.plateau)?;
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
    let numbers = [
        ("ra", found.ra),
        ("rq", found.rq),
        ("rz", found.rz),
        ("rt", found.rt),
        ("rsk", found.rsk),
        ("rku", found.rku),
    ];
    for (name, value) in numbers {
        out.set_item(name, value)?;
    }
    out.set_item("rsm", found.rsm)?;
    out.set_item("rdq", found.rdq)?;
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
