//! `[stress]`: which body, at which depths and times.

use asperity::Grid;
use asperity::material::Body;
use asperity::stress::{check_depth, check_depths, spaced_depths};

use super::Checks;
use super::stored_times::stored_times;
use crate::case::plan::Output;
use crate::case::raw::{self, At};
use crate::case::words::number;
use crate::store::FieldKind;
use crate::stress::{Depths, StressBody, StressPlan};

/// More depths than this are a slip.
const MOST_DEPTHS: usize = 10_000;

/// The stress that a case asks for.
pub fn stress(
    checks: &mut Checks<'_, '_>,
    at: &At<raw::Stress>,
    grid: &Grid,
    bodies: &[Body],
    output: &Output,
    end: f64,
) -> Option<StressPlan> {
    let bodies: Vec<StressBody> = bodies.iter().map(StressBody::of).collect();
    let mut plan = plan(checks, at, grid, &bodies)?;
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
    let poisson = match body.poisson {
        Some(poisson) if (0.0..=0.5).contains(&poisson) => poisson,
        Some(poisson) => {
            let message = format!("Poisson's ratio of {} is {}", body.name, number(poisson));
            checks.fault(place, message, "a Poisson's ratio from 0 to 0.5", Some("choose the other body"));
            return None;
        }
        None => {
            let message = format!(
                "{} has a constant bulk modulus, so that its Poisson's ratio changes with time, and the stress does not \
                 follow from the pressure of the moment alone",
                body.name
            );
            let help = "give the body a constant `poisson`, or choose the other body";
            checks.fault(place, message, "a body of constant Poisson's ratio", Some(help));
            return None;
        }
    };
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
        rolling: raw.rolling,
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
