//! `[stress]`: which body, at which depths and times.

use asperity::Grid;
use asperity::stress::{Rolling, check_depth, check_depths, spaced_depths};

use super::Checks;
use super::body::Pair;
use super::stored_times::stored_times;
use crate::case::plan::{Output, Rows};
use crate::case::raw::{self, At};
use crate::case::words::number;
use crate::store::FieldKind;
use crate::stress::{Depths, ROLLS_ALONG_LINE, Ratio, StressBody, StressPlan};

/// More depths than this are a slip.
const MOST_DEPTHS: usize = 10_000;

/// The bodies of a case, as the stress sees them.
pub fn bodies(pair: &Pair) -> Vec<StressBody> {
    pair.bodies
        .iter()
        .zip(&pair.creeps)
        .map(|(body, (_, clock))| StressBody::of(body, clock.is_some()))
        .collect()
}

/// The stress that a case asks for; whether the contact `moves`.
pub fn stress(
    checks: &mut Checks<'_, '_>,
    at: &At<raw::Stress>,
    grid: &Grid,
    bodies: &[StressBody],
    moves: bool,
    output: &Output,
    end: f64,
) -> Option<StressPlan> {
    let mut plan = plan(checks, at, grid, bodies)?;
    if let Ratio::Changing(_) = plan.poisson {
        let place = at.value.body.as_ref().map_or(&at.span, |body| &body.span);
        let name = &plan.body;
        if moves {
            let message = format!(
                "{name} has a constant bulk modulus, so that its Poisson's ratio changes with time; the stress of a contact that \
                 moves over such a body is not computed"
            );
            let help = "give the body a constant `poisson`, or choose the other body";
            checks.fault(place, message, "a body of constant Poisson's ratio", Some(help));
            return None;
        }
        if output.rows != Rows::Every(1) {
            let message = format!(
                "{name} has a constant bulk modulus, so that its Poisson's ratio changes with time and the stress needs the \
                 pressures of all rows, but not all are stored"
            );
            checks.fault(place, message, "stored pressures of all rows", Some("set output.every = 1"));
            return None;
        }
    }
    if !output.fields.contains(&FieldKind::Pressure) {
        let message =
            "the stress below the surface is computed from stored pressures, but none are stored".to_owned();
        checks.fault(&at.span, message, "stored pressures", Some("add \"pressure\" to output.fields"));
        return None;
    }
    plan.times = stored_times(checks, at.value.times.as_ref(), output, end)?;
    Some(plan)
}

/// What the section says by itself, for these bodies; times are left to the caller.
pub fn plan(
    checks: &mut Checks<'_, '_>,
    at: &At<raw::Stress>,
    grid: &Grid,
    bodies: &[StressBody],
) -> Option<StressPlan> {
    let raw = &at.value;
    let (body, place) = match &raw.body {
        None => (bodies.first()?, &at.span),
        Some(which) => {
            let found = match &which.value {
                raw::Which::Name(name) => bodies.iter().find(|body| body.name == *name),
                raw::Which::Number(n) => usize::try_from(*n).ok().and_then(|n| bodies.get(n)),
            };
            let Some(body) = found else {
                let names: Vec<String> =
                    bodies.iter().enumerate().map(|(n, body)| format!("\"{}\" ({n})", body.name)).collect();
                checks.wrong(&which.span, &format!("a body of the case: {}", names.join(" or ")), None);
                return None;
            };
            (body, &which.span)
        }
    };
    let poisson = match &body.poisson {
        Some(Ratio::Constant(poisson)) if !(0.0..=0.5).contains(poisson) => {
            let message = format!("Poisson's ratio of {} is {}", body.name, number(*poisson));
            checks.fault(place, message, "a Poisson's ratio from 0 to 0.5", Some("choose the other body"));
            return None;
        }
        None => {
            let message = format!(
                "the Poisson's ratio of {} is not known, or changes with time and temperature (constant bulk modulus)",
                body.name
            );
            let help = "give the body a constant `poisson` (a stored result: --poisson NU), or choose the other body";
            checks.fault(
                place,
                message,
                "a body of constant Poisson's ratio or constant temperature",
                Some(help),
            );
            return None;
        }
        Some(poisson) => poisson.clone(),
    };
    if let (Some(at), true) = (&raw.rolling, grid.is_line())
        && at.value == Rolling::Y
    {
        checks.fault(&at.span, ROLLS_ALONG_LINE.to_owned(), "\"x\"", None);
        return None;
    }
    let mut quantities: Vec<_> = raw.components.iter().flatten().map(|at| at.value).collect();
    quantities.sort();
    quantities.dedup();
    Some(StressPlan {
        body: body.name.clone(),
        poisson,
        depths: depths(checks, raw.depths.as_ref(), grid)?,
        quantities,
        threshold: raw.threshold.map(|threshold| threshold.get()),
        yield_stress: raw.yield_stress.map(|stress| stress.get()),
        rolling: raw.rolling.as_ref().map(|at| at.value),
        times: None,
    })
}

fn depths(checks: &mut Checks<'_, '_>, raw: Option<&At<raw::Depths>>, grid: &Grid) -> Option<Depths> {
    let Some(at) = raw else { return Some(Depths::Auto) };
    let list = match &at.value {
        raw::Depths::Auto => return Some(Depths::Auto),
        raw::Depths::List(list) => {
            for depth in list {
                checks.core(&depth.span, check_depth(grid, depth.value.get()))?;
            }
            list.iter().map(|depth| depth.value.get()).collect()
        }
        raw::Depths::Row(row) => {
            let (from, to, count) = (row.from.value.get(), row.to.value.get(), row.count.value.count());
            if count > MOST_DEPTHS {
                checks.wrong(&row.count.span, &format!("a number from 2 to {MOST_DEPTHS}"), None);
                return None;
            }
            checks.core(&row.from.span, check_depth(grid, from))?;
            if to <= from {
                checks.wrong(&row.to.span, &format!("a depth below `from`, {} m", number(from)), None);
                return None;
            }
            spaced_depths([from, to], count, row.spacing != Some(raw::Progression::Uniform), true)
        }
    };
    checks.core(&at.span, check_depths(grid, &list))?;
    Some(Depths::List(list))
}
