//! `[load]` and `[time]`: what is prescribed, and the instants of the solution.

use asperity::{Control, Scheme};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{At, Two};
use crate::case::quantity::range::{NonNegative, Positive};
use crate::case::quantity::{Frequency, Length, Number, Prescribed, Pressure, Time as Duration, Whole};

/// What presses the bodies together.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// The prescribed quantity; with `history`.
    pub control: Option<At<Control>>,
    /// Its value over time, 0 before t = 0; with `control`.
    #[schemars(example = serde_json::json!({ "kind": "step", "value": "0.5 N" }))]
    pub history: Option<At<History>>,
    /// The stages of the run, one after the other, in place of `control` and `history`. The run ends with the last of
    /// them or at `time.end`, whichever comes first.
    #[schemars(length(min = 1))]
    #[schemars(example = serde_json::json!([
        { "control": "load", "history": { "kind": "step", "value": "0.5 N" }, "duration": "10 s" },
        { "control": "approach", "history": { "kind": "hold" } },
    ]))]
    pub stages: Option<At<Vec<At<Stage>>>>,
}

/// A part of the run under one control.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// The prescribed quantity.
    pub control: Control,
    /// Its value; the time of the history starts with the stage.
    #[schemars(example = serde_json::json!({ "kind": "hold" }))]
    pub history: At<History>,
    /// Longest duration of the stage. Every stage but the last needs `duration` or `until`.
    #[schemars(example = "10 s")]
    pub duration: Option<At<Duration<Positive>>>,
    /// The stage ends when this happens: a value is crossed, from either side, or the contact is lost. Without
    /// `duration` it must happen before `time.end`.
    #[schemars(example = "contact-lost", example = serde_json::json!({ "approach": "2 um" }))]
    pub until: Option<At<Until>>,
    /// The event of `until` counts only after the jump with which the stage begins (as a load that relaxes after a step of
    /// the approach); false if not given.
    #[serde(default)]
    #[schemars(example = true)]
    pub after_jump: bool,
    /// Number of steps of the stage, instead of the times of `[time]`; with `duration`.
    #[schemars(example = 50)]
    pub steps: Option<At<Whole<1>>>,
    /// Spacing of these steps, or "adaptive" instead of `steps`; "uniform" if not given.
    pub spacing: Option<At<Spacing>>,
    /// First time of the stage after its start, if the spacing is "log" or "adaptive"; as in `[time]` if not
    /// given.
    #[schemars(example = "0.1 s")]
    pub first: Option<At<Duration<Positive>>>,
    /// If the spacing is "adaptive": as in `[time]`.
    #[schemars(example = 1e-3)]
    pub tolerance: Option<At<Number<Positive>>>,
    /// The times of the stage after its start, with the keys of `[time]` but `scheme`; instead of the four keys above, and without
    /// a need of `duration`.
    #[schemars(example = serde_json::json!({ "times": ["1 s", "10 s"] }))]
    pub time: Option<At<Time>>,
}

/// What ends a stage.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Until {
    /// The contact is lost.
    ContactLost,
    /// The approach crosses a value.
    #[schemars(example = "2 um")]
    Approach(Length),
    /// The load crosses a value.
    #[schemars(example = "0.1 N")]
    Load(At<Prescribed>),
    /// The mean pressure crosses a value.
    #[schemars(example = "1 MPa")]
    Pressure(Pressure<NonNegative>),
}

/// A value over time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(tag = "kind")]
pub enum History {
    /// Applied suddenly and held.
    Step(Step),
    /// Linear rise, then held.
    Ramp(Ramp),
    /// The value at the start of the stage, held; only in stages.
    Hold(Hold),
    /// Linear rise and fall, then 0.
    Triangle(Triangle),
    /// Linear rise, hold, linear fall, then 0.
    Trapezoid(Trapezoid),
    /// mean + amplitude sin(2 pi frequency t).
    Sine(Sine),
    /// Straight lines between points; two points at one time are a jump.
    Table(Table),
    /// The points of a table from a file of two columns, time and value.
    File(File),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// Value held from t = 0 on.
    #[schemars(example = "0.5 N")]
    pub value: At<Prescribed>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hold {}

/// Value at which a ramp starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum From {
    /// At 0.
    #[default]
    Zero,
    /// At the value at the start of the stage.
    Current,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// Value reached and held.
    #[schemars(example = "0.5 N")]
    pub value: At<Prescribed>,
    /// Value at which the ramp starts; "zero" if not given.
    #[serde(default)]
    pub from: From,
    /// Time to reach it.
    #[schemars(example = "10 s")]
    pub duration: Duration<Positive>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Triangle {
    /// Largest value.
    #[schemars(example = "0.5 N")]
    pub peak: At<Prescribed>,
    /// Duration of the rise.
    #[schemars(example = "10 s")]
    pub rise: Duration<Positive>,
    /// Duration of the fall.
    #[schemars(example = "10 s")]
    pub fall: Duration<Positive>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trapezoid {
    /// Largest value.
    #[schemars(example = "0.5 N")]
    pub peak: At<Prescribed>,
    /// Duration of the rise.
    #[schemars(example = "10 s")]
    pub rise: Duration<Positive>,
    /// Duration of the hold at the peak.
    #[schemars(example = "60 s")]
    pub hold: Duration<NonNegative>,
    /// Duration of the fall.
    #[schemars(example = "10 s")]
    pub fall: Duration<Positive>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sine {
    /// Mean value.
    #[schemars(example = "0.5 N")]
    pub mean: At<Prescribed>,
    /// Amplitude; not above the mean if a load or a pressure is prescribed.
    #[schemars(example = "0.2 N")]
    pub amplitude: At<Prescribed>,
    /// Frequency.
    #[schemars(example = "2 Hz")]
    pub frequency: Frequency<Positive>,
}

/// Time and value.
pub type Point = Two<Duration, At<Prescribed>>;

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Pairs [time, value] in order of time, the first at 0; a time given twice is a jump.
    #[schemars(example = (("0 s", "0 N"), ("10 s", "0.5 N")))]
    #[schemars(length(min = 1))]
    pub points: At<Vec<At<Point>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct File {
    /// The file, relative to the case file: one line per point, time and value separated by comma, semicolon
    /// or blanks, each with unit or in SI; `#` begins a comment, one header line may name the columns with
    /// units, as in "time [s], load [mN]".
    #[schemars(example = "history.csv")]
    pub path: At<String>,
}

/// The times of the solution.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Instants")]
pub struct Time {
    /// End of the run; with `steps`, spacing = "adaptive", or stages that have steps of their own.
    #[schemars(example = "500 s")]
    pub end: Option<At<Duration<Positive>>>,
    /// Number of steps from 0 to `end`; breaks and jumps of the history are additional steps.
    #[schemars(example = 100)]
    pub steps: Option<At<Whole<1>>>,
    /// Spacing of the steps; "uniform" if not given.
    pub spacing: Option<At<Spacing>>,
    /// First time after 0 if the spacing is "log"; if not given, a tenth of the shortest retardation time (of fractional
    /// models and fitted curves: 1e-4 of the end), but not later than a uniform step or a twentieth of the first ramp of the
    /// history. If the spacing is "adaptive", the
    /// largest first step after 0 and after each break or jump; if not given, a thousandth of the end.
    #[schemars(example = "0.1 s")]
    pub first: Option<At<Duration<Positive>>>,
    /// If the spacing is "adaptive": the largest error that the steps may leave, relative to the stress; 1e-3 if not
    /// given.
    #[schemars(example = 1e-3)]
    pub tolerance: Option<At<Number<Positive>>>,
    /// List of the times after 0, instead of `end` and `steps`.
    #[schemars(example = ("1 s", "10 s", "100 s"))]
    pub times: Option<At<Vec<At<Duration<Positive>>>>>,
    /// How the pressure varies over a step; "linear" if not given.
    pub scheme: Option<Scheme>,
}

/// Spacing of the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// Equal steps.
    Uniform,
    /// Steps that grow by a constant factor.
    Log,
    /// The length of each step follows its error.
    Adaptive,
}
