//! `[motion]`: a contact that slides or rolls.

use std::borrow::Cow;

use asperity::finding::{self, Finding};
use asperity::material::Creep;
use asperity::sliding::{Direction, Path};
use asperity::{Boundary, Grid, TimeGrid};
use ndarray::Array2;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};

use super::body::Body;
use super::history::{Course, History, Kind};
use super::keys::*;
use super::pair::Pair;
use super::plan::{Motion as Moving, Travel};
use super::shear::{self, Shear};
use super::surface::Surface;
use super::words::number;
use crate::Code;

/// Velocities of a sweep, at most.
const MOST: usize = 10_000;

/// How the contact moves over the bodies.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Velocity of the contact over the body: a constant, or a history as in `[load]`. This, `path` or `steady`.
    #[schemars(example = "10 mm/s")]
    velocity: Option<Course<Velocity>>,
    /// Position of the contact over time, as a history that begins with 0. This, `velocity` or `steady`.
    #[schemars(example = serde_json::json!({ "kind": "table", "points": [["0 s", "0 mm"], ["2 s", "1 mm"]] }))]
    path: Option<History>,
    /// One steady state for each of some velocities, without `[time]`. This, `velocity` or `path`.
    #[schemars(example = serde_json::json!({ "velocities": ["1 mm/s", "10 mm/s"] }))]
    pub steady: Option<Steady>,
    /// "slide" (the contact moves over the body `over`) or "roll" (over both bodies); "slide" if not given.
    #[serde(default)]
    pub kind: MotionKind,
    /// Name of the body that the contact slides over, and that the grid is fixed to; the first viscoelastic one if not given.
    #[schemars(example = &"rubber")]
    over: Option<String>,
    /// Direction of the velocity: "x", "y", or an angle from x towards y on periodic domains; "x" if not given.
    #[schemars(example = "30 deg")]
    direction: Option<Heading>,
    /// The motion begins at this time; 0 if not given.
    #[schemars(example = "1 s")]
    start: Option<Time<NonNegative>>,
    /// Cells that the contact moves in a time step, at most; 1 if not given.
    #[schemars(example = 1)]
    cells_per_step: Option<Number<Positive>>,
    /// Shear stress on the area in contact, or how it depends on velocity: its share is added in `friction_coefficient_total`.
    #[schemars(example = "0.2 MPa")]
    shear_stress: Option<Shear>,
}

/// What the contact moves over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MotionKind {
    /// One of the bodies.
    #[default]
    Slide,
    /// Both bodies.
    Roll,
}

/// Steady states.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Steady {
    /// The velocities: a list, or a range.
    #[schemars(example = serde_json::json!({ "from": "1 um/s", "to": "1 m/s", "count": 31, "spacing": "log" }))]
    velocities: Form<Never, Vec<Velocity<NonNegative>>, Range>,
}

/// A range of velocities.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// The first.
    #[schemars(example = "1 um/s")]
    from: Velocity<Positive>,
    /// The last.
    #[schemars(example = "1 m/s")]
    to: Velocity<Positive>,
    /// How many.
    #[schemars(example = 31)]
    count: Whole<1>,
    /// "log" or "linear"; "log" if not given.
    #[serde(default)]
    spacing: RangeSpacing,
}

/// How a range is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RangeSpacing {
    /// By equal ratios.
    #[default]
    Log,
    /// By equal differences.
    Linear,
}

impl Word for Velocity {
    const FORMS: &'static str =
        "a velocity such as \"10 mm/s\", or a history such as { kind = \"ramp\", ... }";
    const IS_QUANTITY: bool = true;
}

impl Word for Never {
    const FORMS: &'static str = "a list of velocities, or { from, to, count, spacing }";
}

/// "x", "y", or an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Heading(Direction);

impl Scalar for Heading {
    fn expected() -> String {
        "\"x\", \"y\", or an angle such as \"30 deg\"".to_owned()
    }

    fn from_text(word: &str) -> Result<Self, QuantityError> {
        match word {
            "x" => Ok(Heading(Direction::X)),
            "y" => Ok(Heading(Direction::Y)),
            _ => word.parse::<Angle>().map(|angle| Heading(Direction::Angle(angle.get()))).map_err(Self::of),
        }
    }

    fn from_number(number: f64) -> Result<Self, QuantityError> {
        Angle::from_number(number).map(|angle| Heading(Direction::Angle(angle.get()))).map_err(Self::of)
    }
}

impl Heading {
    /// What is wrong with an angle, among the directions.
    fn of(error: QuantityError) -> QuantityError {
        QuantityError { expected: Self::expected(), ..error }
    }
}

deserialize!(Heading);

impl JsonSchema for Heading {
    fn schema_name() -> Cow<'static, str> {
        "Heading".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let angle = generator.subschema_for::<Angle>();
        json_schema!({ "anyOf": [{ "enum": ["x", "y"] }, angle] })
    }
}

/// Refuses `moves` of surfaces where nothing moves.
pub fn nothing_moves(list: &Place<'_>, surfaces: &[Surface]) {
    if let Some(n) = surfaces.iter().position(|surface| surface.moves.is_some()) {
        list.item(n).fault::<()>(
            "`moves` says which parts of the surface move, but the case has no [motion]",
            "a section [motion]",
            "leave `moves` out, or add [motion]",
        );
    }
}

impl Motion {
    /// What moves, and how; and whether each of the surfaces does.
    pub fn moving(&self, at: &Place<'_>, surfaces: &[Surface]) -> Option<Moving> {
        at.exactly_one(&["velocity", "path", "steady"])?;
        let start = self.start.map_or(0.0, Time::get);
        let travel = match (&self.velocity, &self.path) {
            (Some(velocity), _) => {
                let at = at.key("velocity");
                let history = velocity.history(&at, Kind::VELOCITY, "")?;
                Travel::Path(at.core(Path::of_velocity(history, start))?)
            }
            (None, Some(path)) => {
                let at = at.key("path");
                // There is no earlier value in the history.
                let history = path.read(&at, Kind::LENGTH, "")?;
                Travel::Path(at.core(Path::of_position(history, start))?)
            }
            (None, None) => {
                let why = "belongs to a motion in time, but the case asks for steady states";
                at.without(&["start", "cells_per_step"], why, "one of the two", "leave it out")?;
                if let Some(n) = surfaces.iter().position(|surface| surface.moves == Some(false)) {
                    return at.sibling("surface").item(n).fault(
                        "a steady state needs a gap that is fixed in the frame of the contact, but this part of the surface stays \
                         with the body",
                        "moves = true",
                        "give [motion] a velocity and the case a [time], or leave `moves` out",
                    );
                }
                let list = at.key("steady").key("velocities");
                Travel::Steady(self.steady.as_ref()?.velocities(&list)?)
            }
        };
        let cells_per_step = self.cells_per_step.map_or(1.0, Number::get);
        at.core(asperity::process::Motion::check_cells_per_step(cells_per_step))?;
        let shear_stress = match &self.shear_stress {
            Some(given) => Some(shear::law(&at.key("shear_stress"), given)?),
            None => None,
        };
        Some(Moving {
            travel,
            direction: self.direction.map_or(Direction::X, |heading| heading.0),
            moves: surfaces.iter().map(|surface| surface.moves.unwrap_or(true)).collect(),
            rolls: self.kind == MotionKind::Roll,
            cells_per_step,
            shear_stress,
        })
    }

    /// Changes the pair to what the contact meets: a body whose material stands still in the frame of the contact is relaxed for
    /// ever in a steady state, and takes no part in a motion in time.
    pub fn met(
        &self,
        at: &Place<'_>,
        moving: &Moving,
        bodies: &[Body],
        pair: &mut Pair,
        end: f64,
    ) -> Option<()> {
        if self.start.is_some_and(|start| start.get() >= end) {
            let message = "the motion starts after the end of the run";
            at.key("start").fault::<()>(message, "a time before the end", "");
        }
        let named = self.named(&at.key("over"), bodies)?;
        if moving.rolls {
            let why = "belongs to a contact that slides: this one rolls over both bodies";
            return at.without(&["over"], why, "kind = \"slide\"", "leave `over` out");
        }
        // One body, or two of which one is refused already.
        if bodies.len() < 2 || pair.creeps.len() < 2 && pair.layers.is_none() {
            return Some(());
        }
        if pair.layers.is_some() {
            let message =
                "a contact of two bodies that slide over each other, one of them of layers, is not solved";
            return at.fault(message, "kind = \"roll\", or one body", "");
        }
        let remembers: Vec<bool> = pair.creeps.iter().map(|(creep, _)| creep.remembers()).collect();
        let over = named.unwrap_or_else(|| first_to_remember(pair));
        let other = 1 - over;
        if matches!(moving.travel, Travel::Path(_)) && bodies[other].hardness_file.is_some() {
            let help = "give the file to the body that the contact slides over (`over`), or one hardness to this one";
            let body = at.sibling("body").item(other).key("hardness_file");
            return body.fault(
                "the hardness of each cell of a body that slides would move with it",
                "`hardness`",
                help,
            );
        }
        if !remembers[other] {
            return Some(());
        }
        let name =
            |n: usize, otherwise: &'static str| bodies[n].name.as_deref().unwrap_or(otherwise).to_owned();
        match &moving.travel {
            // Its material stands still in the frame of the contact, and has relaxed.
            Travel::Steady(_) => {
                let relaxed = pair.creeps[other].0.long_time();
                if !relaxed.is_finite() {
                    let message = format!(
                        "`{}` flows, and its material stands still in the frame of the contact: the other body sinks into it for \
                         ever, so there is no steady state",
                        name(other, "one body")
                    );
                    let body = at.sibling("body").item(other);
                    return body.fault(message, "a solid", "give it a relaxed modulus");
                }
                pair.creeps[other] = (Creep::elastic(relaxed), None);
                pair.sum();
                Some(())
            }
            Travel::Path(_) if !remembers[over] => at.fault(
                "the contact slides over an elastic body, and the memory of the other stands still in its frame: nothing that \
                 remembers moves, and friction is zero",
                "a viscoelastic body that is slid over",
                "name the viscoelastic body in `over`, or leave [motion] out",
            ),
            Travel::Path(_) => at.fault(
                format!(
                    "both bodies are viscoelastic, and the contact slides over `{}`: the memory of `{}` moves over the grid, which \
                     is not computed in time",
                    name(over, "the first"),
                    name(other, "the second"),
                ),
                "one viscoelastic body",
                "make the body that slides elastic, take kind = \"roll\", or steady states ([motion.steady])",
            ),
        }
    }

    /// Whether dents that stay are those of the body that slides, because it is the softer one; `map` is the hardness of each cell of the
    /// other one, where that is not the same everywhere.
    pub fn dents_move(
        &self,
        at: &Place<'_>,
        bodies: &[Body],
        pair: &Pair,
        map: Option<&Array2<f64>>,
    ) -> Option<bool> {
        if self.kind == MotionKind::Roll || bodies.len() < 2 {
            return Some(false);
        }
        let over = self.named(&at.key("over"), bodies)?.unwrap_or_else(|| first_to_remember(pair));
        let [track, slider] =
            [over, 1 - over].map(|n| bodies[n].hardness.map_or(f64::INFINITY, Pressure::get));
        let of_cells =
            map.filter(|_| bodies[over].hardness_file.is_some() || bodies[over].hardness_array.is_some());
        let [least, most] = of_cells.map_or([track; 2], |map| {
            map.iter().fold([f64::INFINITY, 0.0], |[least, most], h| {
                [track.min(h.min(least)), track.min(h.max(most))]
            })
        });
        match slider {
            slider if slider < least => Some(true),
            slider if slider >= most => Some(false),
            _ => at.sibling("solver").key("plasticity").fault(
                "of the two bodies that slide over each other one is softer in some cells and the other one in the rest, so dents that \
                 stay would move in part",
                "bodies of which one is the softer one everywhere",
                "change `hardness`, or take plasticity = \"cap\"",
            ),
        }
    }

    /// The number of the body `over`; the inner `None` where it is not named.
    fn named(&self, at: &Place<'_>, bodies: &[Body]) -> Option<Option<usize>> {
        let Some(over) = &self.over else { return Some(None) };
        let is_named = |body: &Body| body.name.as_ref() == Some(over);
        if bodies.iter().filter(|body| is_named(body)).count() > 1 {
            let expected = "different names, or the number of a body, 1 or 2";
            return at.fault(format!("two bodies have the name \"{over}\""), expected, "");
        }
        let of_number =
            || over.parse::<usize>().ok().filter(|n| (1..=bodies.len()).contains(n)).map(|n| n - 1);
        if let Some(found) = bodies.iter().position(is_named).or_else(of_number) {
            return Some(Some(found));
        }
        let names: Vec<&str> = bodies.iter().filter_map(|body| body.name.as_deref()).collect();
        let expected = match names.is_empty() {
            true => format!("the number of a body, 1 to {}", bodies.len()),
            false => format!("the name of a body: {}", names.join(", ")),
        };
        at.wrong(expected, "")
    }
}

/// The first body that remembers, else the first one.
fn first_to_remember(pair: &Pair) -> usize {
    pair.creeps.iter().position(|(creep, _)| creep.remembers()).unwrap_or(0)
}

impl Steady {
    fn velocities(&self, at: &Place<'_>) -> Option<Vec<f64>> {
        let mut list: Vec<f64> = match &self.velocities {
            Form::Word(never) => match *never {},
            Form::List(list) => list.iter().map(|velocity| velocity.get()).collect(),
            Form::Table(range) if range.count.count() > MOST => {
                return at.key("count").wrong(format!("a count up to {MOST}"), "");
            }
            Form::Table(range) => range.velocities(),
        };
        if list.is_empty() || list.len() > MOST {
            return at.wrong(format!("between 1 and {MOST} velocities"), "");
        }
        if let Some(velocity) = list.iter().find(|velocity| !velocity.is_finite()) {
            let message = format!("the range reaches a velocity of {velocity} m/s");
            let help = "bring its ends closer together";
            return at.refuse(Code::OutOfRange, message, "finite velocities", help);
        }
        list.sort_by(f64::total_cmp);
        if let Some(pair) = list.windows(2).find(|pair| pair[0] == pair[1]) {
            let message = format!("the list has the velocity {} m/s twice", number(pair[0]));
            return at.fault(message, "each velocity once", "");
        }
        Some(list)
    }
}

impl Range {
    fn velocities(&self) -> Vec<f64> {
        let (from, to, count) = (self.from.get(), self.to.get(), self.count.count());
        let share = |k: usize| k as f64 / count.saturating_sub(1).max(1) as f64;
        let velocity = |k: usize| match (k, self.spacing) {
            (0, _) => from,
            (k, _) if k + 1 == count => to,
            (k, RangeSpacing::Log) => from * libm::pow(to / from, share(k)),
            (k, RangeSpacing::Linear) => from + (to - from) * share(k),
        };
        (0..count).map(velocity).collect()
    }
}

impl Moving {
    /// The number of velocities of steady states.
    pub(super) fn swept(&self) -> Option<usize> {
        match &self.travel {
            Travel::Steady(velocities) => Some(velocities.len()),
            Travel::Path(_) => None,
        }
    }

    /// The times that count for the material in steady states: between that of a cell and that of the domain. `None` of a motion
    /// in time.
    pub(super) fn times(&self, at: &Place<'_>, grid: &Grid) -> Option<TimeGrid> {
        let Travel::Steady(velocities) = &self.travel else { return None };
        let moving = velocities.iter().filter(|v| **v > 0.0);
        let (slowest, fastest) = moving.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
        if fastest == 0.0 {
            return Some(TimeGrid::List(vec![1.0]));
        }
        let cell = grid.cell_sides().fold(f64::INFINITY, f64::min);
        let around = std::f64::consts::TAU;
        let [first, last] = [2.0 * cell / fastest / around, grid.longest_side() / slowest / around];
        if !(first > 0.0 && last.is_finite()) {
            let message = format!(
                "the contact crosses a cell in {first:e} s at the largest velocity, and the domain in {last:e} s at the smallest one \
                 above 0"
            );
            let help = "leave out velocities that no contact has";
            let at = at.key("steady").key("velocities");
            return at.refuse(Code::OutOfRange, message, "finite times above 0", help);
        }
        Some(TimeGrid::List(vec![first.min(0.5 * last), last]))
    }

    /// Times at which a motion in time has moved by whole steps \[s\].
    pub(super) fn stops(&self, at: &Place<'_>, grid: &Grid, end: f64) -> Option<Vec<f64>> {
        let Travel::Path(path) = &self.travel else { return None };
        at.core(path.crossings(self.cells_per_step * self.direction.cell(grid), end))
    }

    /// What is found about a motion before the run; `rubs` tells whether the surfaces have friction of their own.
    pub(super) fn findings(
        &self,
        surfaces: &[Surface],
        grid: &Grid,
        boundary: Boundary,
        pair: &Pair,
        rubs: bool,
    ) -> Option<Finding> {
        let creeps = || std::iter::once(&pair.creep).chain(pair.thermal.iter().map(|body| &body.creep));
        if pair.waves.is_none() && !creeps().any(Creep::remembers) {
            return (self.shear_stress.is_none() && !rubs).then(finding::friction_zero);
        }
        // Only what travels round meets its own track.
        let Travel::Steady(velocities) = &self.travel else { return None };
        if boundary == Boundary::Free || !surfaces.iter().any(Surface::is_single) {
            return None;
        }
        let terms = creeps().flat_map(|creep| &creep.terms);
        let branches: Vec<(f64, f64)> = terms.map(|term| (term.compliance, term.retardation_time)).collect();
        finding::own_track(grid, self.direction, velocities, &branches, pair.instantaneous())
    }
}
