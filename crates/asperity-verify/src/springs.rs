//! Arbitrary histories compared with the row of springs of the method of dimensionality reduction: unloading, opening and
//! reloading, for which there is no closed form.

use super::{Check, Checks, rows, shape_on, zener, zener_relaxation};
use asperity::error::Result;
use asperity::load::{Control, History, Loading};
use asperity::reference::{Mdr, MdrOptions, MdrProfile, MdrState};
use asperity::simulation::Simulation;
use asperity::step::Row;
use asperity::surface::Shape;
use asperity::time::TimeGrid;

/// Cells per side, and steps.
const CELLS: usize = 97;
const STEPS: usize = 180;

/// The rows of the run and the states of the springs at the same times.
fn both(
    shape: Shape,
    profile: MdrProfile,
    size: f64,
    loading: Loading,
    end: f64,
) -> Result<Vec<(Row, MdrState)>> {
    let times = TimeGrid::Uniform { end, steps: STEPS };
    let springs = Mdr::march(profile, &zener_relaxation(), &loading, &times.times(), MdrOptions::default())?;
    let rows =
        rows(Simulation { creep: zener(), loading: loading.into(), times, ..shape_on(CELLS, size, shape)? })?;
    Ok(rows.into_iter().zip(springs).collect())
}

/// Largest value of `f` over the history.
fn largest(pairs: &[(Row, MdrState)], f: impl Fn(&Row, &MdrState) -> f64) -> f64 {
    pairs.iter().map(|(row, state)| f(row, state)).fold(0.0, f64::max)
}

pub(super) fn sphere_under_load() -> Result<Vec<Check>> {
    let mut checks = Checks::new("springs-sphere", "Popov & Hess, method of dimensionality reduction, 2015");
    // Up, down to a tenth, up, a jump down, held, to zero (open), up again.
    let points =
        vec![(0.0, 0.0), (0.8, 0.6), (1.2, 0.1), (1.8, 1.0), (1.8, 0.4), (2.4, 0.4), (2.8, 0.0), (3.6, 0.8)];
    let loading = Loading { control: Control::Load, history: History::Table { points } };
    let size = 1.8;
    let pairs =
        both(Shape::Sphere { radius: 1.0 }, MdrProfile::Paraboloid { radius: 1.0 }, size, loading, 3.6)?;
    let scale = largest(&pairs, |row, _| row.approach);
    let error = largest(&pairs, |row, state| (row.approach - state.approach).abs()) / scale;
    // (dx/a)^2 at the radii that matter, above 0.3, and the steps' second order.
    let dx = size / CELLS as f64;
    checks.absolute("approach, largest difference over its peak", error, (dx / 0.3).powi(2));
    let radius = |row: &Row| (row.contact_area_corrected / std::f64::consts::PI).sqrt();
    let error = largest(&pairs, |row, state| (radius(row) - state.contact_radius).abs());
    // At last contact a step takes the radius from a fifth of its peak to zero: a cell and a half.
    checks.absolute("contact radius, largest difference in cells", error / dx, 1.5);
    Ok(checks.list)
}

pub(super) fn cone_under_approach() -> Result<Vec<Check>> {
    let mut checks = Checks::new("springs-cone", "Popov & Hess, method of dimensionality reduction, 2015");
    let points =
        vec![(0.0, 0.05), (0.8, 0.1), (1.2, 0.02), (1.5, 0.09), (2.5, 0.09), (3.0, -0.02), (3.4, 0.08)];
    let loading = Loading { control: Control::Approach, history: History::Table { points } };
    let size = 1.6;
    let pairs = both(Shape::Cone { slope: 0.1 }, MdrProfile::Cone { slope: 0.1 }, size, loading, 3.4)?;
    let scale = largest(&pairs, |row, _| row.load);
    let error = largest(&pairs, |row, state| (row.load - state.load).abs()) / scale;
    // The tip lies on a cell centre, and the cone on the grid is blunt by a fraction of dx slope: first order in dx/a.
    let dx = size / CELLS as f64;
    checks.absolute("load, largest difference over its peak", error, dx / 0.64);
    Ok(checks.list)
}
