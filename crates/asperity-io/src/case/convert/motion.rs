//! `[motion]`.

use asperity::finding::{self, Finding};
use asperity::material::Creep;
use asperity::sliding::{Direction, Path};
use asperity::{Boundary, Grid, TimeGrid};

use super::Checks;
use super::body::Pair;
use super::load::{self, Kind};
use crate::case::plan::{Motion, Travel};
use crate::case::raw::{self, At, Heading, MotionKind, RangeSpacing, Speed, Velocities};
use crate::case::words::number;

/// Velocities of a sweep, at most.
const MOST: usize = 10_000;

/// What moves, and how; and whether each of the surfaces does.
pub fn motion(
    checks: &mut Checks<'_, '_>,
    raw: Option<&At<raw::Motion>>,
    surfaces: &[At<raw::Surface>],
) -> Option<Option<Motion>> {
    let Some(at) = raw else {
        if let Some(surface) = surfaces.iter().find(|surface| surface.value.moves().is_some()) {
            let message =
                "`moves` says which parts of the surface move, but the case has no [motion]".to_owned();
            checks.fault(
                &surface.span,
                message,
                "a section [motion]",
                Some("leave `moves` out, or add [motion]"),
            );
            return None;
        }
        return Some(None);
    };
    let motion = &at.value;
    let keys = [
        ("velocity", motion.velocity.is_some()),
        ("path", motion.path.is_some()),
        ("steady", motion.steady.is_some()),
    ];
    checks.exactly_one(&at.span, &keys)?;
    let direction = match motion.direction.as_ref().map(|at| at.value) {
        None | Some(Heading::X) => Direction::X,
        Some(Heading::Y) => Direction::Y,
        Some(Heading::Angle(angle)) => Direction::Angle(angle),
    };
    let moves: Vec<bool> = surfaces.iter().map(|surface| surface.value.moves().unwrap_or(true)).collect();
    let start = motion.start.as_ref().map_or(0.0, |at| at.value.get());
    let travel = match (&motion.steady, &motion.velocity, &motion.path) {
        (Some(steady), ..) => {
            let beside = [
                ("start", motion.start.as_ref().map(|at| &at.span)),
                ("cells_per_step", motion.cells_per_step.as_ref().map(|at| &at.span)),
            ];
            for (key, span) in beside {
                if let Some(span) = span {
                    let message =
                        format!("`{key}` belongs to a motion in time, but the case asks for steady states");
                    checks.fault(span, message, "one of the two", Some("leave it out"));
                    return None;
                }
            }
            if let Some(surface) = surfaces.iter().find(|surface| surface.value.moves() == Some(false)) {
                let message = "a steady state needs a gap that is fixed in the frame of the contact, but this part of the surface \
                               stays with the body"
                    .to_owned();
                let help = "give [motion] a velocity and the case a [time], or leave `moves` out";
                checks.fault(&surface.span, message, "moves = true", Some(help));
                return None;
            }
            Travel::Steady(velocities(checks, &steady.value.velocities)?)
        }
        (_, Some(speed), _) => {
            let history = match &speed.value {
                Speed::Constant(velocity) => asperity::History::Step { value: velocity.get() },
                Speed::History(history) => of_history(checks, Kind::Velocity, history, &speed.span)?,
            };
            Travel::Path(checks.core(&speed.span, Path::of_velocity(history, start))?)
        }
        (_, _, Some(path)) => {
            let history = of_history(checks, Kind::Position, &path.value, &path.span)?;
            Travel::Path(checks.core(&path.span, Path::of_position(history, start))?)
        }
        _ => return None,
    };
    Some(Some(Motion {
        travel,
        direction,
        moves,
        rolls: motion.kind == MotionKind::Roll,
        cells_per_step: motion.cells_per_step.as_ref().map_or(1.0, |at| at.value.get()),
        shear_stress: motion.shear_stress.map(|stress| stress.get()),
        span: at.span.clone(),
    }))
}

/// A history of velocities or positions.
fn of_history(
    checks: &mut Checks<'_, '_>,
    kind: Kind,
    history: &raw::History,
    span: &std::ops::Range<usize>,
) -> Option<asperity::History> {
    if matches!(history, raw::History::Hold(_)) {
        checks.fault(span, "there is no earlier value to hold".to_owned(), "another kind", None);
        return None;
    }
    let mut file = None;
    let (history, _) = load::history(checks, kind, history, &mut file)?;
    Some(history)
}

fn velocities(checks: &mut Checks<'_, '_>, at: &At<Velocities>) -> Option<Vec<f64>> {
    let mut list: Vec<f64> = match &at.value {
        Velocities::List(list) => list.iter().map(|at| at.value.get()).collect(),
        Velocities::Range(range) => {
            let (from, to, count) = (range.from.get(), range.to.get(), range.count.value.count());
            if count > MOST {
                checks.wrong(&range.count.span, &format!("a count up to {MOST}"), None);
                return None;
            }
            let last = count.saturating_sub(1).max(1) as f64;
            let share = |k: usize| k as f64 / last;
            (0..count)
                .map(|k| match (k, range.spacing) {
                    (0, _) => from,
                    (k, _) if k + 1 == count => to,
                    (k, RangeSpacing::Log) => from * (to / from).powf(share(k)),
                    (k, RangeSpacing::Linear) => from + (to - from) * share(k),
                })
                .collect()
        }
    };
    if list.is_empty() || list.len() > MOST {
        checks.wrong(&at.span, &format!("between 1 and {MOST} velocities"), None);
        return None;
    }
    list.sort_by(f64::total_cmp);
    if let Some(pair) = list.windows(2).find(|pair| pair[0] == pair[1]) {
        let message = format!("the velocity {} m/s stands twice", number(pair[0]));
        checks.fault(&at.span, message, "each velocity once", None);
        return None;
    }
    Some(list)
}

/// The times that count for the material in steady states: between that of a cell and that of the domain.
pub fn times(motion: &Motion, grid: &Grid) -> Option<TimeGrid> {
    let Travel::Steady(velocities) = &motion.travel else { return None };
    let moving = velocities.iter().filter(|v| **v > 0.0);
    let (slowest, fastest) = moving.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
    if fastest == 0.0 {
        return Some(TimeGrid::List(vec![1.0]));
    }
    let cell = grid.cell_sides().fold(f64::INFINITY, f64::min);
    let around = std::f64::consts::TAU;
    let [first, last] = [2.0 * cell / fastest / around, grid.longest_side() / slowest / around];
    Some(TimeGrid::List(vec![first.min(0.5 * last), last]))
}

/// The pair as the contact meets it: a body whose material stands still in the frame of the contact is relaxed for ever in a
/// steady state, and takes no part in a motion in time.
pub fn of_pair(
    checks: &mut Checks<'_, '_>,
    raw: &At<raw::Motion>,
    motion: &Motion,
    bodies: &[At<raw::Body>],
    pair: &mut Pair,
) -> Option<()> {
    if motion.rolls || bodies.len() < 2 {
        if let Some(over) = &raw.value.over
            && motion.rolls
        {
            let message = "the contact rolls over both bodies, so there is no `over`".to_owned();
            checks.fault(&over.span, message, "kind = \"slide\"", Some("leave `over` out"));
            return None;
        }
        return named(checks, raw, bodies).map(drop).or(Some(()));
    }
    if pair.layers.is_some() {
        let message =
            "a contact of two bodies that slide over each other, one of them of layers, is not solved"
                .to_owned();
        checks.fault(&raw.span, message, "kind = \"roll\", or one body", None);
        return None;
    }
    let remembers: Vec<bool> = pair.creeps.iter().map(|(creep, _)| creep.remembers()).collect();
    let over = match named(checks, raw, bodies)? {
        Some(over) => over,
        None => remembers.iter().position(|remembers| *remembers).unwrap_or(0),
    };
    let other = 1 - over;
    if !remembers[other] {
        return Some(());
    }
    match &motion.travel {
        // Its material stands still in the frame of the contact, and has relaxed.
        Travel::Steady(_) => {
            let relaxed = pair.creeps[other].0.long_time();
            if !relaxed.is_finite() {
                let name = bodies[other].value.name.as_deref().unwrap_or("one body");
                let message = format!(
                    "`{name}` flows, and its material stands still in the frame of the contact: the other body sinks into it for \
                     ever, so there is no steady state"
                );
                let help = "give it a relaxed modulus";
                checks.fault(&bodies[other].span, message, "a solid", Some(help));
                return None;
            }
            pair.creeps[other] = (Creep::elastic(relaxed), None);
            pair.sum();
            Some(())
        }
        Travel::Path(_) if !remembers[over] => {
            let message = "the contact slides over an elastic body, and the memory of the other stands still in its frame: \
                           nothing that remembers moves, and friction is zero"
                .to_owned();
            let help = "name the viscoelastic body in `over`, or leave [motion] out";
            checks.fault(&raw.span, message, "a viscoelastic body that is slid over", Some(help));
            None
        }
        Travel::Path(_) => {
            let message = format!(
                "both bodies are viscoelastic, and the contact slides over `{}`: the memory of `{}` moves over the grid, which is not \
                 computed in time",
                bodies[over].value.name.as_deref().unwrap_or("the first"),
                bodies[other].value.name.as_deref().unwrap_or("the second"),
            );
            let help =
                "make the body that slides elastic, take kind = \"roll\", or steady states ([motion.steady])";
            checks.fault(&raw.span, message, "one viscoelastic body", Some(help));
            None
        }
    }
}

/// What is found about a motion before the run.
pub fn findings(
    motion: &Motion,
    surfaces: &[At<raw::Surface>],
    grid: &Grid,
    boundary: Boundary,
    pair: &Pair,
) -> Vec<Finding> {
    let parts = std::iter::once(&pair.creep).chain(pair.thermal.iter().map(|body| &body.creep));
    let branches: Vec<(f64, f64)> = parts
        .flat_map(|creep| creep.terms.iter().map(|term| (term.compliance, term.retardation_time)))
        .collect();
    let flows = pair.creep.fluidity > 0.0 || pair.thermal.iter().any(|body| body.creep.fluidity > 0.0);
    if branches.is_empty() && !flows {
        return vec![finding::friction_zero()];
    }
    let single = surfaces.iter().any(|surface| {
        use raw::Surface::{Cone, Cylinder, Ellipsoid, Sphere, Wedge};
        matches!(surface.value, Sphere(_) | Ellipsoid(_) | Cylinder(_) | Cone(_) | Wedge(_))
    });
    let velocities = match &motion.travel {
        Travel::Steady(velocities) => velocities.clone(),
        // Only what travels round meets its own track.
        Travel::Path(_) => vec![],
    };
    let found = (single && boundary == Boundary::Periodic)
        .then(|| finding::own_track(grid, &velocities, &branches, pair.instantaneous()));
    found.flatten().into_iter().collect()
}

/// The number of the body `over`, where it is named.
fn named(
    checks: &mut Checks<'_, '_>,
    raw: &At<raw::Motion>,
    bodies: &[At<raw::Body>],
) -> Option<Option<usize>> {
    let Some(over) = &raw.value.over else { return Some(None) };
    let is_named = |body: &At<raw::Body>| body.value.name.as_deref() == Some(over.value.as_str());
    if bodies.iter().filter(|body| is_named(body)).count() > 1 {
        let message = format!("two bodies have the name \"{}\"", over.value);
        checks.fault(&over.span, message, "different names, or the number of a body, 1 or 2", None);
        return None;
    }
    let of_name = bodies.iter().position(is_named);
    let of_number =
        over.value.parse::<usize>().ok().filter(|n| (1..=bodies.len()).contains(n)).map(|n| n - 1);
    match of_name.or(of_number) {
        Some(found) => Some(Some(found)),
        None => {
            let names: Vec<&str> = bodies.iter().filter_map(|body| body.value.name.as_deref()).collect();
            let expected = match names.is_empty() {
                true => format!("the number of a body, 1 to {}", bodies.len()),
                false => format!("the name of a body: {}", names.join(", ")),
            };
            checks.wrong(&over.span, &expected, None);
            None
        }
    }
}
