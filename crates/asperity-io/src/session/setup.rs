//! What a result says of its run before the first row: the case in numbers.

use asperity::flash::Conductor;
use asperity::kernel::Kernel;
use asperity::load::Control;
use asperity::material::Creep;
use asperity::sliding::{ShearStress, SteadyMotion};
use asperity::traction::AdhesionScale;
use asperity::{Axis, Simulation, TimeGrid};
use serde_json::{Map, Value, json};

use crate::answer::Units;
use crate::case::Case;
use crate::store::Header;
use crate::stress::{self, Ratio, StressBody};

/// What the result says of the run before it starts.
pub(super) fn header(case: &Case, simulation: &Simulation, steady: Option<&SteadyMotion>) -> Header {
    let plan = || Some(simulation.plan()).filter(|plan| plan.exact).map(|plan| plan.instants.len());
    Header {
        title: case.title.clone().unwrap_or_default(),
        case_text: case.source.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        grid: simulation.grid,
        fields: case.output.fields.iter().copied().collect(),
        // Checked with the simulation.
        quantities: simulation.columns().unwrap_or_default(),
        rows_expected: steady.map_or_else(plan, |motion| Some(motion.velocities.len())),
        setup: setup(case, simulation),
    }
}

/// Points of a course for pictures, with its corners.
fn course(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const MOST: usize = 1000;
    let (times, values): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    match points.len() > MOST {
        true => crate::curve::thinned(&times, &values, MOST).0.into_iter().map(|n| points[n]).collect(),
        false => points.to_vec(),
    }
}

/// The case and its `simulation` in numbers, SI: the attribute `setup` of its result.
pub fn setup(case: &Case, simulation: &Simulation) -> Map<String, Value> {
    let Value::Object(mut setup) = json!(case.describe()) else { return Map::new() };
    let mut put = |key: &str, value: Value| drop(setup.insert(key.to_owned(), value));
    let Simulation { solver, times, plasticity, creep, thermal, layers, loading, .. } = &case.conditions;
    put("contact_creep_compliance", numbers(creep));
    if !thermal.is_empty() {
        let parts: Vec<Value> = thermal.iter().map(|body| numbers(&body.creep)).collect();
        put("contact_creep_compliance_over_reduced_time", json!(parts));
    }
    if let Some(points) = &case.temperatures {
        put("temperature_course", json!(course(points)));
    }
    if !case.files.is_empty() {
        let files: Map<String, Value> =
            case.files.iter().map(|(path, digest)| (path.clone(), json!(digest))).collect();
        put("md5_of_files", json!(files));
    }
    if let Some(own) = &case.layers {
        let misfit = layers.as_ref().map(|waves| waves.misfit());
        put("layer_separable", json!(misfit.is_none()));
        put("layer_misfit", json!(misfit.unwrap_or(0.0)));
        put("layer_rigid_base", json!(own.depth().is_some()));
    }
    if let Some(motion) = &case.motion {
        let steady = case.axis() == Axis::Velocity;
        let [x, y] = motion.direction.unit();
        let shear = match &motion.shear_stress {
            None => Value::Null,
            Some(ShearStress::Constant(stress)) => json!(stress),
            Some(ShearStress::Table { points }) => json!({ "points": points }),
            Some(ShearStress::Gaussian { peak, velocity, width }) => {
                json!({ "peak": peak, "velocity": velocity, "width": width })
            }
        };
        let rolls = motion.rolls;
        put(
            "motion",
            json!({ "steady": steady, "direction": [x, y], "rolls": rolls, "shear_stress": shear }),
        );
    }
    let contact = Some(creep).filter(|_| thermal.is_empty());
    let ratio = |body| StressBody::of(body, contact).poisson;
    let ratios: Vec<Option<Ratio>> = case.bodies.iter().map(ratio).collect();
    if ratios.iter().flatten().any(|ratio| ratio.constant().is_none()) {
        let changing = |ratio: &Option<Ratio>| match ratio {
            Some(Ratio::Changing(changing)) => json!(changing),
            _ => Value::Null,
        };
        put(stress::POISSON_CREEP, ratios.iter().map(changing).collect());
    }
    let controls: Vec<Control> = loading.stages.iter().map(|stage| stage.control).collect();
    put(Header::CONTROLS, json!(controls));
    if !case.output.units.is_empty() {
        put(Units::SETUP, json!(case.output.units));
    }
    put("solver_method", json!(solver.method));
    put("solver_tolerance", json!(solver.tolerance));
    put("plasticity", json!(plasticity));
    if let TimeGrid::Adaptive { tolerance, .. } = times {
        put("time_tolerance", json!(tolerance));
    }
    if let Some(plan) = &case.stress {
        put(stress::SETUP, json!(plan));
    }
    // Checked with the simulation.
    if let Ok(Some(scale)) = AdhesionScale::of(simulation) {
        put(Header::ADHESION, json!(scale));
    }
    if let Some(law) = &simulation.tangential {
        let limit = law.shear_limit.is_finite().then_some(law.shear_limit);
        let friction = json!({
            "coefficient": law.coefficients.is_none().then_some(law.coefficient), "shear_limit": limit, "control": law.control,
            "poisson": law.poisson, "beta": law.beta, "coupling": law.coupling, "period": law.period(),
        });
        put(Header::FRICTION, friction);
    }
    if let Some(law) = &simulation.wear {
        let wear = json!({
            "coefficients": law.coefficients, "threshold": law.threshold, "cycles": law.cycles,
            "cycles_tolerance": law.cycles_tolerance, "depth_limit": law.depth_limit,
        });
        put(Header::WEAR, wear);
    }
    if let Some(flash) = &simulation.flash {
        let body =
            |body: Conductor| json!({ "conductivity": body.conductivity, "diffusivity": body.diffusivity });
        let flash = json!({
            "bodies": flash.bodies.map(body), "partition": flash.partition, "friction": flash.friction, "hysteresis": flash.hysteresis,
            "heated_for": flash.heated_for, "feedback": flash.feedback.as_ref().map(|feedback| feedback.temperature),
        });
        put(Header::FLASH, flash);
    }
    if let Some(leak) = &case.leakage {
        put("leakage", json!(leak));
    }
    setup
}

/// A creep function in numbers, SI.
fn numbers(creep: &Creep) -> Value {
    let terms: Vec<_> = creep.terms.iter().map(|t| json!([t.compliance, t.retardation_time])).collect();
    json!({ "instantaneous": creep.instantaneous, "terms": terms, "fluidity": creep.fluidity })
}
