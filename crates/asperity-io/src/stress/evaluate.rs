//! The stress at the stored times, one after the other.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity::stress::{Rolling, StressQuantity, automatic_depths, contact_box, survey_with};
use asperity::{Boundary, Error};
use ndarray::ArrayView2;
use thiserror::Error as Failure;

use super::below::{Loads, missed, profiles, scalars};
use super::{Below, Depths, Instant, Pressures, StressPlan};
use crate::choice;
use crate::instants;
use crate::store::{At, FieldKind, Reader, StoreError, StressSet, StressWriter, Writer};

/// Why the stress was not computed.
#[derive(Debug, Failure)]
pub enum StressError {
    /// The result holds no pressures, or cannot be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The stress cannot be computed like this, or the user interrupted it.
    #[error(transparent)]
    Solve(#[from] Error),
    /// The result is not one whose stress can be computed.
    #[error("{}: {why}", .path.display())]
    Refused {
        /// The result.
        path: PathBuf,
        /// Why, as a sentence.
        why: &'static str,
    },
    /// Nothing touches.
    #[error("{}: nothing touches at {when}, so there is no stress to draw", .path.display())]
    NoContact {
        /// The result.
        path: PathBuf,
        /// The instant in words.
        when: String,
    },
}

/// Why there is no stress below layers.
pub const LAYERED: &str = "the stress below the surface is not computed for bodies of layers yet";

/// Why there is no range of a shear stress along y in plane strain.
pub const ROLLS_ALONG_LINE: &str = "a line contact rolls along x: nothing changes along y";

/// Computes the stress of a result that `writer` holds, and stores it there, in place of an earlier one. `observe` gets the
/// number of times done and of all times. If the computation ends early, no stress is stored.
///
/// # Errors
/// [`StressError::Store`] where there are no pressures or the system refuses; [`StressError::Solve`] for depths that the grid
/// does not allow, and [`Error::Interrupted`] where `interrupt` becomes true.
pub fn evaluate(
    writer: &mut Writer,
    plan: &StressPlan,
    interrupt: &AtomicBool,
    mut observe: impl FnMut(usize, usize),
) -> Result<Below, StressError> {
    let reader = Reader::open(writer.path())?;
    let set = set(&reader, plan)?;
    Pressures::new(&reader, &set.body, &set.poisson)?;
    writer.remove_stress()?;
    let mut store = StressWriter::new(writer, &set);
    let instants = compute(&reader, plan, &set, interrupt, &mut observe, Some(&mut store))?;
    writer.add_stress(store)?;
    below(&reader, set, instants)
}

/// The same for a result that is only read: nothing is stored.
///
/// # Errors
/// As [`evaluate`].
pub fn of_result(reader: &Reader, plan: &StressPlan, interrupt: &AtomicBool) -> Result<Below, StressError> {
    let set = set(reader, plan)?;
    let instants = compute(reader, plan, &set, interrupt, &mut |_, _| (), None)?;
    below(reader, set, instants)
}

fn below(reader: &Reader, set: StressSet, instants: Vec<Instant>) -> Result<Below, StressError> {
    let missed = missed(reader, instants.iter().map(|instant| instant.row))?;
    let (grid, axis) = (reader.header().grid, reader.header().axis());
    Ok(Below { grid, axis, set, instants, missed })
}

/// Refuses a result of bodies of layers.
///
/// # Errors
/// [`StressError::Refused`].
pub fn refuse_layers(reader: &Reader) -> Result<(), StressError> {
    match reader.header().setup.contains_key("layer_separable") {
        true => Err(StressError::Refused { path: reader.path().to_owned(), why: LAYERED }),
        false => Ok(()),
    }
}

/// The boundary of the domain that a result was computed on.
pub(crate) fn boundary(reader: &Reader) -> Boundary {
    let word = reader.header().setup.get("boundary").and_then(serde_json::Value::as_str);
    word.and_then(choice::parse).unwrap_or_default()
}

/// The depths of the plan for these stored instants \[m\]; automatic ones follow from the largest contact.
pub(crate) fn depths(
    reader: &Reader,
    plan: &StressPlan,
    instants: &[usize],
) -> Result<Vec<f64>, StressError> {
    let Depths::List(list) = &plan.depths else {
        let grid = &reader.header().grid;
        let mut largest = 0.0;
        for index in instants {
            let pressure = reader.field(FieldKind::Pressure, At::Index(*index))?;
            largest = f64::max(largest, contact_box(grid, pressure.as_slice().unwrap_or_default()));
        }
        return Ok(automatic_depths(grid, boundary(reader), largest));
    };
    Ok(list.clone())
}

/// What will be stored: the depths and the instants of the plan for this result.
fn set(reader: &Reader, plan: &StressPlan) -> Result<StressSet, StressError> {
    refuse_layers(reader)?;
    let line = reader.header().grid.is_line();
    if line && plan.rolling == Some(Rolling::Y) {
        return Err(StressError::Refused { path: reader.path().to_owned(), why: ROLLS_ALONG_LINE });
    }
    let needed = [FieldKind::Pressure, FieldKind::TractionX, FieldKind::TractionY];
    let mut needed = needed.into_iter().take(if reader.header().slips() { 3 } else { 1 });
    if let Some(kind) = needed.find(|kind| !reader.header().fields.contains(kind)) {
        return Err(reader.no_field(kind).into());
    }
    let instants = instants::stored(reader, plan.times.as_deref())?;
    let depths = depths(reader, plan, &instants)?;
    Ok(StressSet {
        body: plan.body.clone(),
        poisson: plan.poisson.clone(),
        line,
        depths,
        quantities: plan.quantities.clone(),
        threshold: plan.threshold,
        yield_stress: plan.yield_stress,
        rolling: plan.rolling,
        instants,
    })
}

fn compute(
    reader: &Reader,
    plan: &StressPlan,
    set: &StressSet,
    interrupt: &AtomicBool,
    observe: &mut dyn FnMut(usize, usize),
    mut store: Option<&mut StressWriter>,
) -> Result<Vec<Instant>, StressError> {
    let grid = reader.header().grid;
    let mut stress = set.poisson.transforms(grid, boundary(reader))?;
    let mut pressures = Pressures::new(reader, &set.body, &set.poisson)?;
    let loads = Loads::of(reader)?;
    let mut field = vec![0.0; if set.quantities.is_empty() { 0 } else { grid.len() }];
    let mut found = Vec::with_capacity(set.instants.len());
    for (done, index) in set.instants.iter().enumerate() {
        observe(done, set.instants.len());
        pressures.give(*index, &mut stress)?;
        let visit = |depth: usize, six: &[Vec<f64>; 6]| -> Result<(), StressError> {
            if interrupt.load(Ordering::Relaxed) {
                return Err(Error::Interrupted.into());
            }
            let Some(store) = store.as_deref_mut() else { return Ok(()) };
            for quantity in &set.quantities {
                StressQuantity::field_into(*quantity, six, &mut field);
                // The field has the cells of the grid.
                if let Ok(map) = ArrayView2::from_shape(grid.shape(), &field) {
                    store.field(*quantity, *index, depth, map)?;
                }
            }
            Ok(())
        };
        let survey = survey_with(&mut stress, &set.depths, &plan.survey(), visit)?;
        let instant = Instant {
            index: *index,
            time: reader.field_times()[*index],
            row: reader.field_steps()[*index],
            load: loads.at(reader, *index)?,
            scalars: scalars(&grid, &survey),
            profiles: profiles(&survey),
        };
        if let Some(store) = store.as_deref_mut() {
            store.instant(*index, &instant.scalars, &instant.profiles);
        }
        found.push(instant);
    }
    observe(set.instants.len(), set.instants.len());
    Ok(found)
}
