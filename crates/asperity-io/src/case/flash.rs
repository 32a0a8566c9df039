//! `[flash]`: how warm friction makes the surfaces.

use asperity::flash::{Conductor, Feedback, Flash as Law, Partition};
use asperity::material::Shift;

use super::body::Part;
use super::keys::*;
use super::pair::Pair;
use super::plan::{Motion, Travel};
use crate::quantity::{Conductivity, Diffusivity};

/// How warm friction makes the surfaces of a contact in motion.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Flash {
    /// Thermal conductivity of both bodies, or a list of two: of the slider, which carries the surfaces that move, and of the track.
    #[schemars(example = "0.3 W/(m K)")]
    #[schemars(example = serde_json::json!(["50 W/(m K)", "0.3 W/(m K)"]))]
    conductivity: Form<Conductivity<Positive>, Vec<Conductivity<Positive>>>,
    /// Thermal diffusivity of both bodies, or a list of two, of slider and track.
    #[schemars(example = "1e-7 m2/s")]
    diffusivity: Form<Diffusivity<Positive>, Vec<Diffusivity<Positive>>>,
    /// Friction coefficient: heat per area = friction x pressure x velocity. This, `motion.shear_stress` or `hysteresis`.
    #[schemars(example = 0.3)]
    friction: Option<Number<Positive>>,
    /// Whether the power that the bodies lose counts as heat of the surfaces, spread over the contact as the pressure is; false if not given.
    #[serde(default)]
    #[schemars(example = true)]
    hysteresis: bool,
    /// How the heat divides: "mean" (both faces have the same mean temperature over the contact), "local" (in each cell), all into the
    /// "slider" or the "track"; "mean" if not given.
    #[serde(default)]
    partition: Partition,
    /// For how long the surfaces of a periodic domain have been heated; needed there, since its mean never stops warming.
    #[schemars(example = "20 ms")]
    heated_for: Option<Time<Positive>>,
    /// Whether the material of steady states is taken at its mean flash temperature ("mean") or at that of the run ("none"); "none" if not
    /// given.
    #[serde(default)]
    feedback: Choice,
}

/// Whether the material sees its own temperature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum Choice {
    /// It is as warm as the run.
    #[default]
    None,
    /// It is warmer by the mean flash temperature over the contact.
    Mean,
}

impl Word for Conductivity<Positive> {
    const FORMS: &'static str =
        "a thermal conductivity such as \"0.3 W/(m K)\", or a list of two, of slider and track";
    const IS_QUANTITY: bool = true;
}

impl Word for Diffusivity<Positive> {
    const FORMS: &'static str =
        "a thermal diffusivity such as \"1e-7 m2/s\", or a list of two, of slider and track";
    const IS_QUANTITY: bool = true;
}

impl Flash {
    /// The heat of this motion over bodies of these materials, in a run as warm as (time \[s\], temperature \[K\]) say.
    pub fn law(
        &self,
        at: &Place<'_>,
        motion: &Motion,
        parts: &[Part<'_>],
        pair: &Pair,
        temperatures: Option<&[(f64, f64)]>,
    ) -> Option<Law> {
        let remembering = parts.iter().zip(&pair.creeps).filter(|(_, (creep, _))| creep.remembers());
        let remembering: Vec<&Part<'_>> = remembering.map(|(part, _)| part).collect();
        if motion.rolls {
            let help = "delete the section, or take motion.kind = \"slide\"";
            return at.fault("surfaces that roll do not rub", "kind = \"slide\"", help);
        }
        match (self.friction, &motion.shear_stress) {
            (Some(_), Some(_)) => {
                let help = "delete one of them: both are the friction of the surfaces";
                let message =
                    "the heat is that of motion.shear_stress, but a friction coefficient is given too";
                return at.key("friction").fault(message, "one of the two", help);
            }
            (None, None) if !self.hysteresis => {
                return at.fault(
                    "nothing makes heat",
                    "`friction`, `motion.shear_stress` or `hysteresis`",
                    "give friction = 0.3, a shear_stress in [motion], or hysteresis = true",
                );
            }
            (None, None) if remembering.is_empty() => {
                let message = "the bodies are elastic and lose nothing, so hysteresis makes no heat";
                let help = "give friction = 0.3, or a shear_stress in [motion]";
                return at.key("hysteresis").fault(message, "`friction` or `motion.shear_stress`", help);
            }
            _ => {}
        }
        let bodies = "slider and track";
        let conductivity = self.conductivity.one_or_two(&at.key("conductivity"), bodies)?;
        let diffusivity = self.diffusivity.one_or_two(&at.key("diffusivity"), bodies)?;
        let slider = Conductor { conductivity: conductivity.0.get(), diffusivity: diffusivity.0.get() };
        let track = Conductor {
            conductivity: conductivity.1.map_or(slider.conductivity, Conductivity::get),
            diffusivity: diffusivity.1.map_or(slider.diffusivity, Diffusivity::get),
        };
        let feedback = match self.feedback {
            Choice::None => None,
            Choice::Mean => Some(feedback(&at.key("feedback"), motion, &remembering, temperatures)?),
        };
        Some(Law {
            bodies: [slider, track],
            partition: self.partition,
            friction: self.friction.map_or(0.0, Number::get),
            hysteresis: self.hysteresis,
            on_track: !motion.moves.contains(&true),
            heated_for: self.heated_for.map(Time::get),
            feedback,
        })
    }
}

/// The material that sees its own temperature: that of the bodies whose memory streams by.
fn feedback(
    at: &Place<'_>,
    motion: &Motion,
    remembering: &[&Part<'_>],
    temperatures: Option<&[(f64, f64)]>,
) -> Option<Feedback> {
    if matches!(motion.travel, Travel::Path(_)) {
        let message = "the feedback of the flash temperature is found for steady states only";
        let help =
            "give velocities in [motion.steady] in place of a course over time, or take feedback = \"none\"";
        return at.fault(message, "steady states of motion", help);
    }
    let mut found: Option<Feedback> = None;
    for part in remembering {
        let place = part.at.key("material");
        let sample = part.sample.as_ref()?;
        let Some(shift) = &sample.shift else {
            let message = format!(
                "the material of {} has no `shift`, so what its flash temperature does to it is not known",
                part.name
            );
            let help = "add shift = { model = \"wlf\", ... }, or take flash.feedback = \"none\"";
            return place.fault(message, "a material with a shift", help);
        };
        if sample.vertical.is_some() {
            let message = "feedback shifts the times of a material, not its moduli: `vertical` is not taken into account";
            let help = "leave `vertical` out, or take flash.feedback = \"none\"";
            return place.fault(message, "a shift without `vertical`", help);
        }
        let temperature = temperature_of(shift, sample.temperature, temperatures);
        let Some(temperature) = temperature else {
            let help = "add a section [temperature]";
            return place.fault("the temperature of the run is not known", "a temperature", help);
        };
        let own = Feedback { shift: shift.clone(), temperature };
        if found.as_ref().is_some_and(|other| *other != own) {
            let message = "two materials with different shifts or temperatures see the flash temperature";
            return place.fault(message, "one of them, or the same shift", "take flash.feedback = \"none\"");
        }
        found = Some(own);
    }
    let message = "no material that remembers moves through the contact, so its temperature changes nothing";
    found.or_else(|| at.fault(message, "a viscoelastic track", "take feedback = \"none\""))
}

/// The temperature \[K\] of a material with this shift: its own, that of the run at its start, or the reference.
fn temperature_of(shift: &Shift, own: Option<f64>, run: Option<&[(f64, f64)]>) -> Option<f64> {
    own.or(run.and_then(|points| Some(points.first()?.1))).or(shift.reference())
}

/// How much slower than at the reference the first material with a shift sees velocities at the temperature of the run: a_T; 1 without one.
/// `None` where the temperature changes.
pub fn shift_factor(at: &Place<'_>, parts: &[Part<'_>], temperatures: Option<&[(f64, f64)]>) -> Option<f64> {
    let shifted = parts.iter().filter_map(|part| part.sample.as_ref());
    let Some((sample, shift)) = shifted.filter_map(|sample| Some((sample, sample.shift.as_ref()?))).next()
    else {
        return Some(1.0);
    };
    let changes = temperatures.is_some_and(|points| points.iter().any(|point| point.1 != points[0].1));
    if changes && sample.temperature.is_none() {
        let message = "a shear stress with a peak shifts with the temperature, which changes in this run";
        let help = "take a constant or a table, or hold the temperature";
        return at.fault(message, "a constant temperature", help);
    }
    match temperature_of(shift, sample.temperature, temperatures) {
        Some(kelvin) => at.core(shift.factor(kelvin)),
        None => Some(1.0),
    }
}
