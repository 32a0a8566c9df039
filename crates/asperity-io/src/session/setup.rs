//! What a result says of its run before the first row: the case in numbers.

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

/// Points of a course for pictures: all of them, or of many every second one, every third one and so on, and the last.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const MOST: usize = 1000;
    let every = points.len().div_ceil(MOST).max(1);
    let is_kept = |n: usize| n.is_multiple_of(every) || n + 1 == points.len();
    points.iter().enumerate().filter(|(n, _)| is_kept(*n)).map(|(_, point)| *point).collect()
}

/// The case and its `simulation` in numbers, SI: the attribute `setup` of its result.
pub fn setup(case: &Case, simulation: &Simulation) -> Map<String, Value> {
    let description = serde_json::to_value(case.describe()).unwrap_or_default();
    let mut setup = match description {
        Value::Object(map) => map,
        _ => Map::new(),
    };
    setup.insert("contact_creep_compliance".into(), creep(&case.conditions.creep));
    if !case.conditions.thermal.is_empty() {
        let parts: Vec<Value> = case.conditions.thermal.iter().map(|body| creep(&body.creep)).collect();
        setup.insert("contact_creep_compliance_over_reduced_time".into(), json!(parts));
    }
    if let Some(points) = &case.temperatures {
        setup.insert("temperature_course".into(), json!(thinned(points)));
    }
    if !case.files.is_empty() {
        let files: Map<String, Value> =
            case.files.iter().map(|(path, digest)| (path.clone(), json!(digest))).collect();
        setup.insert("md5_of_files".into(), json!(files));
    }
    if let Some(layers) = &case.layers {
        let misfit = case.conditions.layers.as_ref().map(|waves| waves.misfit());
        setup.insert("layer_separable".into(), json!(misfit.is_none()));
        setup.insert("layer_misfit".into(), json!(misfit.unwrap_or(0.0)));
        setup.insert("layer_rigid_base".into(), json!(layers.depth().is_some()));
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
        setup.insert(
            "motion".into(),
            json!({ "steady": steady, "direction": [x, y], "rolls": motion.rolls, "shear_stress": shear }),
        );
    }
    let contact = Some(&case.conditions.creep).filter(|_| case.conditions.thermal.is_empty());
    let ratio = |body| StressBody::of(body, contact).poisson;
    let ratios: Vec<Option<Ratio>> = case.bodies.iter().map(ratio).collect();
    if ratios.iter().flatten().any(|ratio| ratio.constant().is_none()) {
        let creep = |ratio: &Option<Ratio>| match ratio {
            Some(Ratio::Changing(changing)) => json!(changing),
            _ => Value::Null,
        };
        setup.insert(stress::POISSON_CREEP.into(), ratios.iter().map(creep).collect());
    }
    let controls: Vec<Control> = case.conditions.loading.stages.iter().map(|stage| stage.control).collect();
    setup.insert(Header::CONTROLS.into(), json!(controls));
    if !case.output.units.is_empty() {
        setup.insert(Units::SETUP.into(), json!(case.output.units));
    }
    let Simulation { solver, times, plasticity, .. } = &case.conditions;
    setup.insert("solver_method".into(), json!(solver.method));
    setup.insert("solver_tolerance".into(), json!(solver.tolerance));
    setup.insert("plasticity".into(), json!(plasticity));
    if let TimeGrid::Adaptive { tolerance, .. } = times {
        setup.insert("time_tolerance".into(), json!(tolerance));
    }
    if let Some(plan) = &case.stress {
        setup.insert(stress::SETUP.into(), serde_json::to_value(plan).unwrap_or_default());
    }
    // Checked with the simulation.
    if let Ok(Some(scale)) = AdhesionScale::of(simulation) {
        setup.insert(Header::ADHESION.into(), json!(scale));
    }
    if let Some(law) = &simulation.tangential {
        let limit = law.shear_limit.is_finite().then_some(law.shear_limit);
        setup.insert(
            Header::FRICTION.into(),
            json!({
                "coefficient": law.coefficients.is_none().then_some(law.coefficient), "shear_limit": limit, "control": law.control,
                "poisson": law.poisson, "beta": law.beta, "coupling": law.coupling, "period": law.period(),
            }),
        );
    }
    if let Some(law) = &simulation.wear {
        setup.insert(
            Header::WEAR.into(),
            json!({
                "coefficients": law.coefficients, "threshold": law.threshold, "cycles": law.cycles, "cycles_tolerance": law.cycles_tolerance, "depth_limit": law.depth_limit,
            }),
        );
    }
    if let Some(flash) = &simulation.flash {
        let bodies = flash
            .bodies
            .map(|body| json!({ "conductivity": body.conductivity, "diffusivity": body.diffusivity }));
        setup.insert(
            Header::FLASH.into(),
            json!({
                "bodies": bodies, "partition": flash.partition, "friction": flash.friction, "hysteresis": flash.hysteresis,
                "heated_for": flash.heated_for, "feedback": flash.feedback.as_ref().map(|feedback| feedback.temperature),
            }),
        );
    }
    if let Some(leak) = &case.leakage {
        setup.insert("leakage".into(), serde_json::to_value(leak).unwrap_or_default());
    }
    setup
}

/// A creep function in numbers, SI.
fn creep(creep: &Creep) -> Value {
    let terms: Vec<_> = creep.terms.iter().map(|t| json!([t.compliance, t.retardation_time])).collect();
    json!({ "instantaneous": creep.instantaneous, "terms": terms, "fluidity": creep.fluidity })
}
