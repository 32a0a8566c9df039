//! `[stress]`: the stress below the surface: of which body, at which depths and times.

use asperity::Grid;
use asperity::stress::{Rolling, StressQuantity, check_depth, check_depths, spaced_depths};

use super::keys::*;
use super::pair::Pair;
use super::plan::{Output, Rows};
use super::stored_times::{StoredTimes, stored_times};
use super::words::number;
use crate::store::FieldKind;
use crate::stress::{Depths, LAYERED, ROLLS_ALONG_LINE, Ratio, StressBody, StressPlan};

/// More depths than this are a slip.
const MOST_DEPTHS: usize = 10_000;

/// The stress below the surface, from the stored pressures.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stress {
    /// Depths below the surface, each 0 or at least a quarter of a cell; "auto" if not given.
    #[schemars(example = &"auto", example = ("0 um", "5 um", "10 um"))]
    #[schemars(example = serde_json::json!({ "from": "1 um", "to": "200 um", "count": 24, "spacing": "log" }))]
    depths: Option<Form<Auto, Vec<Length<NonNegative>>, Row>>,
    /// The body whose stress is computed: its name, or its number counted from 0; the first if not given.
    #[schemars(example = &"PMMA")]
    body: Option<Label>,
    /// Stress fields that are stored at each depth; none if not given (the largest values and the profile over depth are
    /// always stored).
    #[schemars(example = ("mises",))]
    components: Option<Vec<StressQuantity>>,
    /// The volume in which the von Mises stress is above this threshold is measured.
    #[schemars(example = "100 MPa")]
    threshold: Option<Pressure<Positive>>,
    /// Yield stress of the body, in tension: first yield is reported where the von Mises stress reaches it. (The hardness
    /// limits the pressure, and is about 2.8 times the yield stress of a metal.)
    #[schemars(example = "110 MPa")]
    yield_stress: Option<Pressure<Positive>>,
    /// Direction in which the contact rolls: the range of the orthogonal shear stress along it is found.
    rolling: Option<Rolling>,
    /// Times at which the stress is computed: "fields", as the fields are stored; "all", which needs output.every = 1; or a
    /// list of times that are stored. "fields" if not given.
    #[schemars(example = &"fields", example = ("1 s", "10 s"))]
    times: Option<StoredTimes>,
}

/// Depths that the domain gives.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum Auto {
    /// 0, and 24 depths from half a cell to the width of the contact (periodic: to half the shorter side).
    Auto,
}

impl Word for Auto {
    const FORMS: &'static str = "\"auto\", a list of lengths, or a table { from, to, count, spacing }";
}

/// A row of depths; the surface itself is added.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "RowOfDepths")]
struct Row {
    /// First depth below the surface.
    #[schemars(example = "1 um")]
    from: Length<Positive>,
    /// Last depth.
    #[schemars(example = "200 um")]
    to: Length<Positive>,
    /// Number of depths.
    #[schemars(example = 24)]
    count: Whole<2>,
    /// "log" for a constant ratio of neighbouring depths, "uniform" for a constant distance; "log" if not given.
    spacing: Option<Progression>,
}

/// How depths follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum Progression {
    /// Constant ratio.
    Log,
    /// Constant distance.
    Uniform,
}

impl Stress {
    /// The stress that a case asks for; whether the contact `moves`, whether it `slips` under a tangential load. The output then stores what
    /// the stress is computed from.
    pub fn of_case(
        &self,
        at: &Place<'_>,
        grid: &Grid,
        pair: &Pair,
        [moves, slips]: [bool; 2],
        output: &mut Output,
        end: f64,
    ) -> Option<StressPlan> {
        if pair.layers.is_some() {
            return at.fault(LAYERED, "bodies without layers", "delete the section");
        }
        let warms = pair.creeps.iter().any(|(_, clock)| clock.is_some());
        let contact = pair.creeps.iter().map(|(creep, _)| creep.clone()).reduce(|sum, creep| sum.sum(&creep));
        let contact = contact.filter(|_| !warms);
        let bodies: Vec<StressBody> =
            pair.bodies.iter().map(|body| StressBody::of(body, contact.as_ref())).collect();
        let plan = self.plan(at, grid, &bodies)?;
        let times = stored_times(&at.key("times"), self.times.as_ref(), output, end)?;
        if let Ratio::Changing(_) = plan.poisson {
            if moves {
                let place = if self.body.is_some() { at.key("body") } else { at.clone() };
                let message = format!(
                    "{} has a constant bulk modulus, so that its Poisson's ratio changes with time; the stress of a contact that \
                     moves over such a body is not computed",
                    plan.body
                );
                let help = "give the body a constant `poisson`, or choose the other body";
                return place.fault(message, "a body of constant Poisson's ratio", help);
            }
            output.rows = Rows::Every(1);
        }
        output.fields.insert(FieldKind::Pressure);
        if slips {
            output.fields.extend([FieldKind::TractionX, FieldKind::TractionY]);
        }
        Some(StressPlan { times, ..plan })
    }

    /// What the section says by itself, for these bodies; times are left to the caller.
    pub fn plan(&self, at: &Place<'_>, grid: &Grid, bodies: &[StressBody]) -> Option<StressPlan> {
        let place = if self.body.is_some() { at.key("body") } else { at.clone() };
        let found = match self.body.as_ref().map(Label::get) {
            None => bodies.first(),
            Some(which) => {
                let numbered = || which.parse().ok().and_then(|n: usize| bodies.get(n));
                bodies.iter().find(|body| body.name == which).or_else(numbered)
            }
        };
        let Some(body) = found else {
            let names: Vec<String> =
                bodies.iter().enumerate().map(|(n, body)| format!("\"{}\" ({n})", body.name)).collect();
            return place.wrong(format!("a body of the case: {}", names.join(" or ")), "");
        };
        let poisson = match &body.poisson {
            Some(Ratio::Constant(poisson)) if !(0.0..=0.5).contains(poisson) => {
                let message = format!("Poisson's ratio of {} is {}", body.name, number(*poisson));
                return place.fault(message, "a Poisson's ratio from 0 to 0.5", "choose the other body");
            }
            None => {
                let message = format!(
                    "the Poisson's ratio of {} is not known, or changes with time and temperature (constant bulk modulus)",
                    body.name
                );
                let help = "give the body a constant `poisson` (a stored result: --poisson NU), or choose the other body";
                let expected = "a body of constant Poisson's ratio or constant temperature";
                return place.fault(message, expected, help);
            }
            Some(poisson) => poisson.clone(),
        };
        if grid.is_line() && self.rolling == Some(Rolling::Y) {
            return at.key("rolling").fault(ROLLS_ALONG_LINE, "\"x\"", "");
        }
        let mut quantities = self.components.clone().unwrap_or_default();
        quantities.sort();
        quantities.dedup();
        Some(StressPlan {
            body: body.name.clone(),
            poisson,
            depths: self.depths(&at.key("depths"), grid)?,
            quantities,
            threshold: self.threshold.map(Pressure::get),
            yield_stress: self.yield_stress.map(Pressure::get),
            rolling: self.rolling,
            times: None,
        })
    }

    fn depths(&self, at: &Place<'_>, grid: &Grid) -> Option<Depths> {
        let list: Vec<f64> = match &self.depths {
            None | Some(Form::Word(Auto::Auto)) => return Some(Depths::Auto),
            Some(Form::List(list)) => {
                for (n, depth) in list.iter().enumerate() {
                    at.item(n).core(check_depth(grid, depth.get()))?;
                }
                list.iter().map(|depth| depth.get()).collect()
            }
            Some(Form::Table(row)) => {
                let (from, to, count) = (row.from.get(), row.to.get(), row.count.count());
                if count > MOST_DEPTHS {
                    return at.key("count").wrong(format!("a number from 2 to {MOST_DEPTHS}"), "");
                }
                at.key("from").core(check_depth(grid, from))?;
                if to <= from {
                    return at.key("to").wrong(format!("a depth below `from`, {} m", number(from)), "");
                }
                spaced_depths([from, to], count, row.spacing != Some(Progression::Uniform), true)
            }
        };
        at.core(check_depths(grid, &list))?;
        Some(Depths::List(list))
    }
}
