//! Surfaces: read, written, made, described.

use std::path::PathBuf;
use std::str::FromStr;

use asperity::Grid;
use asperity::surface::statistics::{
    HeightStatistics, RadialSpectrum, Rings, SlopeStatistics, SpectralMoments,
};
use asperity::surface::{self, Level, Part, Roughness, SelfAffine, Shape, Surface, undeformed_gap};
use asperity_io::topography::{Format, ReadOptions, Topography, read, write};
use ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, file, raised};
use crate::march::choose;

type Heights<'py> = Bound<'py, PyArray2<f64>>;

fn grid(py: Python<'_>, cells: (usize, usize), size: [f64; 2]) -> PyResult<Grid> {
    Grid::new([cells.0, cells.1], size).map_err(|error| raised(py, error))
}

/// Heights of a self-affine surface.
#[pyfunction]
#[pyo3(signature = (cells, size, hurst, rms_gradient, rms_height, longest, shortest, roll_off, seed))]
#[allow(clippy::too_many_arguments)]
pub fn self_affine<'py>(
    py: Python<'py>,
    cells: (usize, usize),
    size: [f64; 2],
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
        _ => return Err(CaseError::new_err("give rms_gradient or rms_height, one of them")),
    };
    let roll_off = roll_off.unwrap_or(longest);
    let grid = grid(py, cells, size)?;
    let made =
        py.detach(|| SelfAffine { hurst, roughness, longest, shortest, roll_off, seed }.heights(&grid));
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
    size: [f64; 2],
) -> PyResult<Heights<'py>> {
    let shape = match (kind, numbers.as_slice()) {
        ("sphere", [radius]) => Shape::Sphere { radius: *radius },
        ("ellipsoid", [x, y]) => Shape::Ellipsoid { radius_x: *x, radius_y: *y },
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
    let grid = grid(py, cells, size)?;
    let [lx, ly] = size;
    let at = |i: usize, j: usize| (grid.x(i) - (0.5 * lx + center[0]), grid.y(j) - (0.5 * ly + center[1]));
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
    size: [f64; 2],
) -> PyResult<Heights<'py>> {
    let heights = heights.as_array().as_standard_layout().into_owned();
    let grid = grid(py, heights.dim(), size)?;
    if heights.iter().all(|z| z.is_finite()) {
        let part = Part::Heights { name: "surface".into(), heights };
        let gap = undeformed_gap(&grid, &[part]).map_err(|error| raised(py, error))?;
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
    size: Option<[f64; 2]>,
    height_unit: Option<f64>,
    channel: Option<String>,
) -> PyResult<Bound<'py, PyDict>> {
    let options = ReadOptions { size, height_unit, channel, ..ReadOptions::default() };
    let topography = py.detach(|| read(&path, &options)).map_err(file)?;
    let out = PyDict::new(py);
    out.set_item("format", topography.format.name())?;
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
) -> PyResult<()> {
    let format = Format::from_str(format).map_err(|error| CaseError::new_err(error.to_string()))?;
    let heights = heights.as_array().as_standard_layout().into_owned();
    let topography = Topography { format, heights, size, channel: None, channels: vec![], metadata: vec![] };
    py.detach(|| write(&path, &topography, format)).map_err(file)
}

/// Parameters of ISO 25178 and spectral moments.
#[pyfunction]
pub fn statistics<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    size: [f64; 2],
) -> PyResult<Bound<'py, PyDict>> {
    let map = map(py, heights, size)?;
    let out = PyDict::new(py);
    let z = HeightStatistics::of(&map).map_err(|error| raised(py, error))?;
    for (name, value) in [
        ("sa", z.sa),
        ("sq", z.sq),
        ("ssk", z.ssk),
        ("sku", z.sku),
        ("sz", z.sz),
        ("min", z.min),
        ("max", z.max),
        ("mean", z.mean),
    ] {
        out.set_item(name, value)?;
    }
    out.set_item("undefined", map.undefined())?;
    if let Ok(slopes) = SlopeStatistics::of(&map) {
        out.set_item("sdq", slopes.sdq)?;
        out.set_item("sdr", slopes.sdr)?;
    }
    if let Ok(moments) = SpectralMoments::of(&map) {
        out.set_item("m0", moments.m0)?;
        out.set_item("m2", moments.m2)?;
        out.set_item("m4", moments.m4)?;
    }
    Ok(out)
}

/// Wavenumbers and radially averaged power spectrum.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn power_spectrum<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'_, f64>,
    size: [f64; 2],
    per_decade: u32,
) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>)> {
    let map = map(py, heights, size)?;
    let rings = if per_decade == 0 { Rings::Linear } else { Rings::PerDecade(per_decade) };
    let spectrum = RadialSpectrum::of(&map, rings).map_err(|error| raised(py, error))?;
    Ok((spectrum.wave_number.into_pyarray(py), spectrum.power.into_pyarray(py)))
}

/// Heights without their mean, plane or paraboloid.
#[pyfunction]
pub fn level<'py>(py: Python<'py>, heights: PyReadonlyArray2<'_, f64>, form: &str) -> PyResult<Heights<'py>> {
    let forms = [
        ("none", Level::None),
        ("mean", Level::Mean),
        ("plane", Level::Plane),
        ("quadratic", Level::Quadratic),
    ];
    let form = choose("level", form, &forms)?;
    let level = surface::level(heights.as_array(), form).map_err(|error| raised(py, error))?;
    Ok(level.into_pyarray(py))
}

fn map(py: Python<'_>, heights: PyReadonlyArray2<'_, f64>, size: [f64; 2]) -> PyResult<Surface> {
    let heights = heights.as_array().to_owned();
    let grid = grid(py, heights.dim(), size)?;
    Surface::new(grid, heights).map_err(|error| raised(py, error))
}
