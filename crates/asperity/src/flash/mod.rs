//! Flash temperature: how warm sliding makes the surfaces.
//!
//! Friction turns the power q = μ p v, or τ v on the area in contact, into heat where the surfaces meet. Both bodies carry it away as
//! half-spaces. Over the *track* the source moves with v, in the *slider*, which carries the surfaces that move, it stands still; where no
//! surface moves, the rough surface is that of the track, and the source stands still in the track and moves over the slider. In a steady
//! state a wave of the heat flux warms the surface by
//!
//! T^ = q^ / (k √(|q|² - i q.v/χ)),      k conductivity, χ diffusivity      (J. C. Jaeger, Proc. R. Soc. NSW 76 (1942) 203)
//!
//! so the hottest place lies behind the middle of the source.
//!
//! - `kernel`: that source on a free surface, over a cell; `conduction`: T of a field of heat, on both kinds of domain;
//! - `partition`: how the heat divides between the bodies; `solver`: the temperatures of a row;
//! - `feedback`: the temperature at which a material sees its own friction.
//!
//! docs/flash.md has the formulas, limits and checks.

mod conduction;
mod feedback;
mod kernel;
mod partition;
mod solver;
#[cfg(test)]
mod tests;

pub(crate) use feedback::{another, settle};
pub(crate) use solver::bytes;
pub use solver::{FlashRow, FlashSolver, Rise, Rubbing};

use crate::error::{Of, Result, positive, require};
use crate::grid::Boundary;
use crate::material::Shift;
use crate::simulation::Simulation;

/// How a body conducts heat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    /// Thermal conductivity k \[W/(m K)\].
    pub conductivity: f64,
    /// Thermal diffusivity χ \[m²/s\].
    pub diffusivity: f64,
}

/// How the heat divides between slider and track.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Partition {
    /// By one share, the same in all cells, with which the mean temperatures of both faces over the contact are equal.
    #[default]
    Mean,
    /// In each cell so that both faces are equally warm there.
    Local,
    /// All into the slider.
    Slider,
    /// All into the track.
    Track,
}

/// The friction of a material at the temperature that the friction makes.
#[derive(Clone, Debug, PartialEq)]
pub struct Feedback {
    /// How the times of the material depend on temperature.
    pub shift: Shift,
    /// Temperature of the run \[K\].
    pub temperature: f64,
}

impl Feedback {
    /// The velocity that a material at the run's temperature would have to see for what this one sees, `rise` warmer, over the own.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the shift is not known at that temperature.
    pub(crate) fn slowing(&self, rise: f64) -> Result<f64> {
        let [now, before] = [self.temperature + rise, self.temperature].map(|t| self.shift.ln_factor(t));
        Ok(libm::exp(now? - before?))
    }
}

/// Heat of friction, and the bodies that it warms.
#[derive(Clone, Debug, PartialEq)]
pub struct Flash {
    /// The slider and the track.
    pub bodies: [Conductor; 2],
    /// How the heat divides between them.
    pub partition: Partition,
    /// Friction coefficient μ of the surfaces: heat μ p v. The shear stress of a motion adds τ v.
    pub friction: f64,
    /// Whether the power that is lost in the bodies counts as heat of the surfaces, spread over the contact as the pressure is.
    pub hysteresis: bool,
    /// Of a periodic domain: for how long the surfaces have been heated \[s\]; its mean, and streaks along the motion, never stop warming.
    /// `None` on a free domain.
    pub heated_for: Option<f64>,
    /// Whether the material of a steady state sees its own temperature.
    pub feedback: Option<Feedback>,
    /// Whether no surface moves: the source then stands still in the track and moves over the slider.
    pub on_track: bool,
}

impl Flash {
    /// Checks the numbers, and what they need of the contact.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) naming the key of the table `flash`.
    pub fn validate(&self, simulation: &Simulation) -> Result<()> {
        for Conductor { conductivity, diffusivity } in self.bodies {
            positive("thermal conductivity", conductivity, "W/(m K)").of("conductivity")?;
            positive("thermal diffusivity", diffusivity, "m2/s").of("diffusivity")?;
        }
        let sound = self.friction >= 0.0 && self.friction.is_finite();
        require(sound, "friction coefficient", self.friction, "finite and not negative").of("friction")?;
        if let Some(time) = self.heated_for {
            positive("time of heating", time, "s").of("heated_for")?;
            require(
                simulation.boundary == Boundary::Periodic,
                "`heated_for` on a free domain",
                format!("{time} s"),
                "left out: around a contact on a free domain the temperature becomes steady",
            )
            .of("heated_for")?;
        }
        let is_open = simulation.boundary == Boundary::Free;
        let still = self.still();
        let [body, other] = if still == 0 { ["slider", "track"] } else { ["track", "slider"] };
        require(
            !(is_open && simulation.grid.is_line() && self.heats()[still]),
            "partition of the heat on a line of cells with a free domain",
            format!("\"{}\"", self.partition.name()),
            format!("\"{other}\": a {body} with a source that is endless across the motion and stands still has no steady temperature"),
        )
        .of("partition")?;
        require(
            is_open || self.heated_for.is_some(),
            "`heated_for` on a periodic domain",
            "not given",
            "the time for which the surfaces have been heated, such as heated_for = \"10 ms\": the mean of a periodic surface, and its streaks along \
             the motion, never stop warming",
        )
        .of("heated_for")?;
        require(
            self.feedback.is_none() || simulation.motion.is_none(),
            "feedback of the flash temperature in time",
            "\"mean\"",
            "\"none\". Take steady states ([motion.steady]), which have it, or give the warmer material its own `temperature`",
        )
        .of("feedback")
    }

    /// Whether slider and track are heated.
    fn heats(&self) -> [bool; 2] {
        [self.partition != Partition::Track, self.partition != Partition::Slider]
    }

    /// The body in which the source stands still: 0, the slider, or 1, the track.
    pub(crate) fn still(&self) -> usize {
        usize::from(self.on_track)
    }
}

impl Partition {
    /// Its name in case files.
    pub fn name(self) -> &'static str {
        match self {
            Partition::Mean => "mean",
            Partition::Local => "local",
            Partition::Slider => "slider",
            Partition::Track => "track",
        }
    }
}
