//! Surfaces: read, written, made, described.

use std::path::PathBuf;
use std::str::FromStr;

use asperity::Grid;
use asperity::surface::profile::{self, ProfileParameters};
use asperity::surface::statistics::{
    Autocorrelation, BearingCurve, Extent, PowerSpectrum, Rings, SelfAffineFit, Summary, height_distribution,
};
use asperity::surface::{Part, Surface, undeformed_gap};
use asperity_io::case::{fragment, given};
use asperity_io::preparation::{Step, prepare};
use asperity_io::topography::{Format, ReadOptions, Topography, read, read_profile, write};
use ndarray::Array2;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{self, Answer, Failure};
use crate::given::{Dict, Map, Numbers, Plane, entries, grid_of, table};
use crate::wait::detached;

/// Heights of the shape or the synthetic roughness that the keys `domain` and `surface` describe; minus infinity where a shape
/// cannot touch.
#[pyfunction]
pub fn heights<'py>(py: Python<'py>, keys: Dict<'_>) -> Answer<(Map<'py>, bool)> {
    let (grid, part, single) = given::surface(&table(&keys)?).map_err(error::alone)?;
    let made = detached(py, || match part {
        Part::SelfAffine(roughness) => roughness.heights(&grid),
        Part::Synthesis(roughness) => roughness.heights(&grid),
        Part::Heights { heights, .. } => Ok(heights),
        Part::Shape { shape, center } => {
            let [x0, y0] = grid.centre();
            let height = |(i, j)| -shape.gap(grid.x(i) - (x0 + center[0]), grid.y(j) - (y0 + center[1]));
            Ok(Array2::from_shape_fn(grid.shape(), height))
        }
    })?;
    Ok((made?.into_pyarray(py), single))
}

/// Reads a measured surface: heights, size, and what the file says.
#[pyfunction]
pub fn read_surface<'py>(
    py: Python<'py>,
    path: PathBuf,
    size: Option<Vec<f64>>,
    height_unit: Option<f64>,
    channel: Option<String>,
) -> Answer<Dict<'py>> {
    let of_map = size.as_ref().is_some_and(|size| size.len() == 2);
    let lengths = size.as_ref().and_then(|size| Some([*size.first()?, size.get(1).copied().unwrap_or(1.0)]));
    let options = ReadOptions { size: lengths, height_unit, channel, ..ReadOptions::default() };
    let out = PyDict::new(py);
    let profile = if of_map { None } else { detached(py, || read_profile(&path, &options))?? };
    if let Some(profile) = profile {
        out.set_item("format", "profile")?;
        out.set_item("size", profile.surface.grid().extents().to_vec())?;
        entries!(out, profile; history metadata);
        out.set_item("heights", profile.surface.into_heights().into_pyarray(py))?;
        return Ok(out);
    }
    if size.is_some() && !of_map {
        return Err(Failure::case(
            "size has one length, but the file holds no profile: it needs two, along x and y",
        ));
    }
    let topography = detached(py, || read(&path, &options))??;
    out.set_item("format", topography.format.name())?;
    out.set_item("history", topography.history().collect::<Vec<_>>())?;
    entries!(out, topography; size channel channels metadata);
    out.set_item("heights", topography.heights.into_pyarray(py))?;
    Ok(out)
}

/// Heights on their grid.
#[pyclass(frozen)]
pub struct Heights {
    /// As they were given: minus infinity where a shape cannot touch.
    heights: Array2<f64>,
    grid: Grid,
}

/// A curve: places and values.
type Curve<'py> = (Numbers<'py>, Numbers<'py>);

#[pymethods]
impl Heights {
    #[new]
    fn new(heights: Plane<'_>, size: Vec<f64>) -> Answer<Heights> {
        let heights = heights.as_array().as_standard_layout().into_owned();
        Ok(Heights { grid: grid_of(heights.dim(), &size)?, heights })
    }

    /// The undeformed gap, least value 0; a height of minus infinity cannot touch.
    fn gap<'py>(&self, py: Python<'py>) -> Answer<Map<'py>> {
        let part = Part::Heights { name: "surface".into(), heights: self.heights.clone() };
        let gap = detached(py, || undeformed_gap(&self.grid, &[part]))??;
        Ok(gap.into_pyarray(py))
    }

    /// Writes the heights in the format of the path's ending, or of that name.
    fn write(&self, py: Python<'_>, path: PathBuf, format: &str, history: Vec<String>) -> Answer<()> {
        let format = Format::from_str(format)?;
        let (heights, size) = (self.heights.clone(), self.grid.size());
        let mut topography =
            Topography { format, heights, size, channel: None, channels: vec![], metadata: vec![] };
        topography.record(history);
        detached(py, || write(&path, &topography, format))?.map_err(Failure::file)
    }

    /// Steps of a preparation, each in words as `asperity surface process --op` takes them: heights, size, and one
    /// sentence per step.
    fn process<'py>(&self, py: Python<'py>, steps: Vec<String>) -> Answer<(Map<'py>, Vec<f64>, Vec<String>)> {
        let steps = steps.iter().map(|words| fragment::step(words));
        let steps = steps.collect::<Result<Vec<Step>, String>>()?;
        let surface = self.surface()?;
        let prepared = detached(py, || prepare(surface, &steps, None))?.map_err(|error| {
            // There is no domain here.
            let reason = error.to_string();
            Failure::case(
                reason.replace("as `cells` of the step or as `domain.cells` of the case", "cells=(nx, ny)"),
            )
        })?;
        let size = prepared.surface.grid().extents().to_vec();
        Ok((prepared.surface.into_heights().into_pyarray(py), size, prepared.history))
    }

    /// Statistics as `asperity surface info` prints them; `band` limits the fit of the Hurst exponent.
    fn describe<'py>(&self, py: Python<'py>, periodic: bool, band: Option<[f64; 2]>) -> Answer<Dict<'py>> {
        let (summary, undefined) =
            self.found(py, |surface| Ok((Summary::of(&surface, extent(periodic))?, surface.undefined())))?;
        let out = PyDict::new(py);
        entries!(out, summary.heights; sa sq ssk sku sp sv sz min max mean);
        out.set_item("undefined", undefined)?;
        if let Some(slopes) = &summary.slopes {
            entries!(out, slopes; sdq sdr);
        }
        if let Some(waves) = &summary.waves {
            entries!(out, waves.moments; m0 m2 m4);
            out.set_item("bandwidth", waves.moments.bandwidth())?;
            out.set_item("lay", waves.lay.is_clear())?;
            out.set_item("lay_ratio", waves.lay.ratio)?;
            out.set_item("lay_angle", waves.lay.angle)?;
            let banded =
                band.map(|[longest, shortest]| SelfAffineFit::of(&waves.spectrum, longest, shortest));
            if let Some(fit) = banded.transpose()?.or(waves.fit) {
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
    fn profile_parameters<'py>(&self, py: Python<'py>, cutoff: Option<f64>) -> Answer<Dict<'py>> {
        let spacing = self.grid.spacing()[0];
        let found = self.found(py, |surface| {
            let heights: Vec<f64> = surface.into_heights().into_iter().collect();
            let roughness = cutoff.map(|cutoff| profile::roughness(&heights, spacing, cutoff)).transpose()?;
            ProfileParameters::of(&roughness.unwrap_or(heights), spacing)
        })?;
        let out = PyDict::new(py);
        entries!(out, found; ra rq rz rt rsk rku rsm rdq);
        Ok(out)
    }

    /// Heights and the share of points at or above each.
    fn bearing_curve<'py>(&self, py: Python<'py>, levels: usize) -> Answer<Curve<'py>> {
        let curve = self.found(py, |surface| BearingCurve::of(&surface, levels))?;
        Ok((curve.heights.into_pyarray(py), curve.share.into_pyarray(py)))
    }

    /// Middles of bins of height and the density of points in them.
    fn height_distribution<'py>(&self, py: Python<'py>, bins: usize) -> Answer<Curve<'py>> {
        let (at, density) = self.found(py, |surface| height_distribution(&surface, bins))?;
        Ok((at.into_pyarray(py), density.into_pyarray(py)))
    }

    /// Wavenumbers and radially averaged power spectrum.
    fn power_spectrum<'py>(&self, py: Python<'py>, per_decade: u32, periodic: bool) -> Answer<Curve<'py>> {
        let rings = if per_decade == 0 { Rings::Linear } else { Rings::PerDecade(per_decade) };
        let spectrum =
            self.found(py, |surface| PowerSpectrum::within(&surface, extent(periodic))?.radial(rings))?;
        Ok((spectrum.wave_number.into_pyarray(py), spectrum.power.into_pyarray(py)))
    }

    /// The autocorrelation map, and Sal and Str where they exist.
    fn autocorrelation<'py>(
        &self,
        py: Python<'py>,
        periodic: bool,
    ) -> Answer<(Map<'py>, Option<f64>, Option<f64>)> {
        let (values, length, aspect) = self.found(py, |surface| {
            let found = Autocorrelation::of(&surface, extent(periodic))?;
            let (length, aspect) = (found.length(), found.texture_aspect_ratio());
            Ok((found.values, length, aspect))
        })?;
        Ok((values.into_pyarray(py), length, aspect))
    }
}

impl Heights {
    fn surface(&self) -> Answer<Surface> {
        Ok(Surface::new(self.grid, self.heights.clone())?)
    }

    /// What `find` finds of the surface while other threads of Python run.
    fn found<T: Send>(
        &self,
        py: Python<'_>,
        find: impl FnOnce(Surface) -> asperity::Result<T> + Send,
    ) -> Answer<T> {
        let surface = self.surface()?;
        Ok(detached(py, || find(surface))??)
    }
}

fn extent(periodic: bool) -> Extent {
    if periodic { Extent::Periodic } else { Extent::Finite }
}
