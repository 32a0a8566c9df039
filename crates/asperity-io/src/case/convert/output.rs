//! Solver options, and what is stored.

use std::path::PathBuf;

use asperity::quantities::{Quantities, Quantity};
use asperity::{Plasticity, Programme, Scheme, SolverOptions, TimeGrid};

use super::Checks;
use super::time;
use crate::case::plan::{Output, Rows};
use crate::case::raw;
use crate::case::words::number;
use crate::store::FieldKind;

/// Most bins of a histogram.
const MOST_BINS: usize = 10_000;

pub fn solver(solver: &raw::Solver) -> SolverOptions {
    let default = SolverOptions::default();
    SolverOptions {
        method: solver.method.unwrap_or_default(),
        tolerance: solver.tolerance.map_or(default.tolerance, |tolerance| tolerance.get()),
        max_iterations: solver.max_iterations.map_or(default.max_iterations, |most| most.count()),
    }
}

pub fn plasticity(solver: &raw::Solver) -> Plasticity {
    solver.plasticity.as_ref().map(|at| at.value).unwrap_or_default()
}

/// Quantities that a free line contact does not have: its displacements are known up to a constant.
pub fn up_to_a_constant(checks: &mut Checks<'_, '_>, output: &raw::Output) {
    for at in output.quantities.iter().flatten() {
        let raw::Quantities::One(quantity) = at.value else { continue };
        if quantity.is_of_time() {
            let message = format!(
                "\"{}\" depends on displacements, which a line contact on a free domain knows up to a constant only",
                quantity.name()
            );
            let help = "leave it out, or take a periodic domain: domain.boundary = \"periodic\"";
            checks.fault(&at.span, message, "another quantity", Some(help));
        }
    }
}

/// What solver and output ask for, where the case does not allow it.
pub fn possible(
    checks: &mut Checks<'_, '_>,
    solver: &raw::Solver,
    output: &raw::Output,
    scheme: Scheme,
    capped: bool,
) {
    let lasting = plasticity(solver) == Plasticity::Accumulate;
    if let Some(at) = solver.plasticity.as_ref().filter(|_| lasting && !capped) {
        let message = "plasticity = \"accumulate\" needs a hardness, but no body has one".to_owned();
        checks.fault(
            &at.span,
            message,
            "\"cap\", or a hardness of a body",
            Some("give a body its `hardness`"),
        );
    }
    let flattening = output.fields.iter().flatten().find(|at| at.value == FieldKind::Flattening);
    if let Some(at) = flattening.filter(|_| !lasting) {
        let message = "there is no permanent flattening with plasticity = \"cap\"".to_owned();
        checks.fault(&at.span, message, "another field", Some("set solver.plasticity = \"accumulate\""));
    }
    let top = output.histogram.as_ref().is_some_and(|histogram| histogram.value.pressure.is_some());
    for at in output.quantities.iter().flatten() {
        let raw::Quantities::One(quantity) = at.value else { continue };
        if quantity == Quantity::PressureHistogram && !capped && !top {
            let message = "the histogram of the pressure has no upper end: no body has a hardness".to_owned();
            let help = "add histogram = { pressure = \"...\" }";
            checks.fault(&at.span, message, "an upper end of the pressure", Some(help));
        }
        if quantity.is_energy() && scheme == Scheme::Direct {
            let message = format!(
                "{quantity} needs the springs and dashpots of the material, which scheme = \"direct\" does not use"
            );
            checks.fault(
                &at.span,
                message,
                "another quantity",
                Some("set time.scheme to \"linear\" or \"constant\""),
            );
        }
    }
}

/// Fields that dents and quantities take besides, in units of 16 bytes per cell: the dented gap and its copy in a
/// checkpoint; the vectors of the contact stiffness; the forest of contact spots.
pub fn extra_fields(solver: &raw::Solver, output: &raw::Output) -> usize {
    use Quantity::{ContactSpots, ContactStiffness, LargestSpot, MeanSpot, SpotHistogram};
    let wants = |list: &[Quantity]| {
        output.quantities.iter().flatten().any(|at| match at.value {
            raw::Quantities::All => true,
            raw::Quantities::One(quantity) => list.contains(&quantity),
        })
    };
    let stiffness = wants(&[ContactStiffness]);
    let spots = wants(&[ContactSpots, LargestSpot, MeanSpot, SpotHistogram]);
    let dents = plasticity(solver) == Plasticity::Accumulate;
    usize::from(dents) + 3 * usize::from(stiffness) + usize::from(spots)
}

/// The quantities that are named, each once, and their bins.
fn quantities(checks: &mut Checks<'_, '_>, output: &raw::Output) -> Option<Quantities> {
    let mut list: Vec<Quantity> = vec![];
    for at in output.quantities.iter().flatten() {
        match at.value {
            raw::Quantities::One(quantity) if !list.contains(&quantity) => list.push(quantity),
            _ => {}
        }
    }
    let mut quantities = Quantities::of(list);
    if let Some(histogram) = &output.histogram {
        let raw = &histogram.value;
        if let Some(bins) = &raw.bins {
            quantities.bins = bins.value.count();
            if quantities.bins > MOST_BINS {
                checks.wrong(&bins.span, &format!("a number of bins up to {MOST_BINS}"), None);
                return None;
            }
        }
        quantities.largest_pressure = raw.pressure.map(|pressure| pressure.get());
        quantities.largest_gap = raw.gap.map(|gap| gap.get());
    }
    Some(quantities)
}

pub fn output(
    checks: &mut Checks<'_, '_>,
    output: &raw::Output,
    times: Option<&TimeGrid>,
    programme: Option<&Programme>,
    default_path: PathBuf,
) -> Option<Output> {
    let path = match &output.path {
        Some(path) if path.value.trim().is_empty() => {
            checks.wrong(&path.span, "the path of a directory for the run to create", None);
            return None;
        }
        Some(path) => PathBuf::from(&path.value),
        None => default_path,
    };
    let fields = match &output.fields {
        Some(fields) => fields.iter().map(|at| at.value).collect(),
        None => [FieldKind::Pressure, FieldKind::Gap].into_iter().collect(),
    };
    let rows = match (&output.every, &output.times) {
        (Some(_), Some(times)) => {
            let message = "`times` and `every` exclude each other".to_owned();
            checks.fault(&times.span, message, "one of the two", Some("leave one of them out"));
            return None;
        }
        (Some(every), None) => Rows::Every(every.value.count()),
        (None, None) => {
            let own = programme
                .iter()
                .flat_map(|programme| &programme.stages)
                .filter_map(|stage| stage.times.as_ref());
            let own: usize = own.map(time::steps).sum();
            let own_only = matches!(times?, TimeGrid::List(end) if end.len() == 1);
            let steps = if own > 0 && own_only { own } else { time::steps(times?) + own };
            Rows::Every(steps.div_ceil(10))
        }
        (None, Some(list)) => {
            let instants = time::increasing(checks, &list.value, |time| time.get())?;
            let end = times?.end();
            if let Some(late) = list.value.iter().find(|at| at.value.get() > end) {
                checks.wrong(
                    &late.span,
                    &format!("a time up to the end of the run, {} s", number(end)),
                    None,
                );
                return None;
            }
            Rows::At(instants)
        }
    };
    Some(Output {
        path,
        fields,
        rows,
        quantities: quantities(checks, output)?,
        all_quantities: output.quantities.iter().flatten().any(|at| at.value == raw::Quantities::All),
        checkpoint: output.checkpoint.unwrap_or(true),
    })
}
