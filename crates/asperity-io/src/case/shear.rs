//! `motion.shear_stress`: a shear stress on the area in contact, the same at all velocities or not.

use asperity::sliding::ShearStress;

use super::keys::*;

/// A shear stress, or how it depends on velocity.
pub type Shear = Form<Pressure<NonNegative>, Never, ShearLaw>;

/// A shear stress over the velocity: `points`, or a Gaussian in the logarithm of the velocity.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShearLaw {
    /// Pairs [velocity, stress] in order of velocity: linear in the logarithm of the velocity, and held beyond the ends. This, or `peak`,
    /// `velocity` and `width`.
    #[schemars(example = (("1 mm/s", "0.2 MPa"), ("1 m/s", "0.5 MPa")))]
    points: Option<Vec<Two<Velocity<Positive>, Pressure<NonNegative>>>>,
    /// Largest stress: peak exp(-(log10(v/velocity)/width)^2).
    #[schemars(example = "5 MPa")]
    peak: Option<Pressure<NonNegative>>,
    /// The velocity at which it acts, at the reference temperature of the material's `shift`; with temperature it shifts as the material.
    #[schemars(example = "5 mm/s")]
    velocity: Option<Velocity<Positive>>,
    /// Decades of velocity over which it falls to 1/e.
    #[schemars(example = 1.2)]
    width: Option<Number<Positive>>,
}

impl Word for Pressure<NonNegative> {
    const FORMS: &'static str =
        "a shear stress such as \"0.2 MPa\", { points = [...] }, or { peak, velocity, width }";
    const IS_QUANTITY: bool = true;
}

/// The stress at the reference temperature.
pub fn law(at: &Place<'_>, given: &Shear) -> Option<ShearStress> {
    let law = match given {
        Form::Word(stress) => ShearStress::Constant(stress.get()),
        Form::List(never) => match *never {},
        Form::Table(ShearLaw { points: Some(points), .. }) => {
            let why = "belongs to a peak, but `points` are given";
            at.without(&["peak", "velocity", "width"], why, "one of the two", "leave it out")?;
            let points = points.iter().map(|Two(velocity, stress)| (velocity.get(), stress.get()));
            ShearStress::Table { points: points.collect() }
        }
        Form::Table(ShearLaw { peak, velocity, width, .. }) => {
            let why = ": a peak over the velocity needs it";
            let Some(peak) = peak else {
                return at.missing("peak", ": give it, or `points`, which say what the stress is");
            };
            let Some(velocity) = velocity else { return at.missing("velocity", why) };
            let Some(width) = width else { return at.missing("width", why) };
            ShearStress::Gaussian { peak: peak.get(), velocity: velocity.get(), width: width.get() }
        }
    };
    at.core(law.validate())?;
    Some(law)
}

/// The same at a temperature at which the material sees velocities `factor` times.
pub fn shifted(law: ShearStress, factor: f64) -> ShearStress {
    match law {
        ShearStress::Gaussian { peak, velocity, width } => {
            ShearStress::Gaussian { peak, velocity: velocity / factor, width }
        }
        other => other,
    }
}
