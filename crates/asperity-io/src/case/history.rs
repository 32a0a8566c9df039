//! A value over time: a load, a pressure, an approach, a velocity or a position.

use asperity::Control;

use super::history_file;
use super::keys::*;
use crate::quantity::Quantity;
use crate::quantity::range::Range;

/// A value over time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind")]
pub enum History {
    /// Applied suddenly and held.
    Step {
        /// Value held from t = 0 on.
        value: Prescribed,
    },
    /// Linear rise, then held.
    Ramp {
        /// Value reached and held.
        value: Prescribed,
        /// Value at which the ramp starts; "zero" if not given.
        #[serde(default)]
        from: From,
        /// Time to reach it.
        duration: Time<Positive>,
    },
    /// The value at the start of the stage, held; only in stages.
    Hold {},
    /// Linear rise and fall, then 0.
    Triangle {
        /// Largest value.
        peak: Prescribed,
        /// Duration of the rise.
        rise: Time<Positive>,
        /// Duration of the fall.
        fall: Time<Positive>,
    },
    /// Linear rise, hold, linear fall, then 0.
    Trapezoid {
        /// Largest value.
        peak: Prescribed,
        /// Duration of the rise.
        rise: Time<Positive>,
        /// Duration of the hold at the peak.
        #[schemars(example = "60 s")]
        hold: Time<NonNegative>,
        /// Duration of the fall.
        fall: Time<Positive>,
    },
    /// mean + amplitude sin(2 pi frequency t).
    Sine {
        /// Mean value.
        mean: Prescribed,
        /// Amplitude; not above the mean if a load or a pressure is prescribed.
        #[schemars(example = "0.2 N")]
        amplitude: Prescribed,
        /// Frequency.
        #[schemars(example = "2 Hz")]
        frequency: Frequency<Positive>,
    },
    /// Straight lines between points; two points at one time are a jump.
    Table {
        /// Pairs [time, value] in order of time, the first at 0; a time given twice is a jump.
        #[schemars(example = (("0 s", "0 N"), ("10 s", "0.5 N")))]
        #[schemars(length(min = 1))]
        points: Vec<Two<Time, Prescribed>>,
    },
    /// The points of a table from a file of two columns, time and value.
    File {
        /// The file, relative to the case file: one line per point, time and value separated by comma, semicolon
        /// or blanks, each with unit or in SI; `#` begins a comment, one header line may name the columns with
        /// units, as in "time [s], load [mN]".
        #[schemars(example = "history.csv")]
        path: String,
    },
}

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

/// A value that is constant, or has a history.
pub type Course<W> = Form<W, Never, Box<History>>;

impl<D: Dimension + Copy, R: Range + Copy> Course<Quantity<D, R>> {
    /// The history in SI; `help` says what to do where it has none.
    pub fn history(&self, at: &Place<'_>, kind: Kind, help: &str) -> Option<asperity::History> {
        match self {
            Form::Word(value) => Some(asperity::History::Step { value: value.get() }),
            Form::Table(history) => history.read(at, kind, help),
            Form::List(never) => match *never {},
        }
    }
}

impl History {
    /// The history in SI; a hold has none without an earlier value. `help` says what to do instead.
    pub fn read(&self, at: &Place<'_>, kind: Kind, help: &str) -> Option<asperity::History> {
        let value = |key: &str, value: &Prescribed| at.key(key).quantity(kind.resolve(value));
        Some(match self {
            History::Hold {} => return at.fault("there is no earlier value to hold", "another kind", help),
            History::Step { value: step } => asperity::History::Step { value: value("value", step)? },
            History::Ramp { value: top, duration, .. } => {
                asperity::History::Ramp { value: value("value", top)?, duration: duration.get() }
            }
            History::Triangle { peak, rise, fall } => {
                let [rise, fall] = [rise, fall].map(|time| time.get());
                asperity::History::Triangle { peak: value("peak", peak)?, rise, fall }
            }
            History::Trapezoid { peak, rise, hold, fall } => {
                let [rise, fall] = [rise, fall].map(|time| time.get());
                asperity::History::Trapezoid { peak: value("peak", peak)?, rise, hold: hold.get(), fall }
            }
            History::Sine { mean, amplitude, frequency } => {
                let (mean, amplitude) = (value("mean", mean), value("amplitude", amplitude));
                asperity::History::Sine { mean: mean?, amplitude: amplitude?, frequency: frequency.get() }
            }
            History::Table { points } => table(&at.key("points"), points, kind)?,
            History::File { path } => {
                let at = at.key("path");
                let points = history_file::of_key(&at, path, "value", |value| kind.resolve(value))?;
                asperity::History::Table { points }
            }
        })
    }
}

fn table(at: &Place<'_>, points: &[Two<Time, Prescribed>], kind: Kind) -> Option<asperity::History> {
    // All of them are looked at, also after one that is wrong.
    let point = |(n, Two(time, value)): (usize, &Two<Time, Prescribed>)| match kind.resolve(value) {
        Ok(value) => Some((time.get(), value)),
        wrong => at.item(n).item(1).quantity(wrong).map(|value| (time.get(), value)),
    };
    let points: Vec<_> = points.iter().enumerate().map(point).collect();
    let points = points.into_iter().collect::<Option<Vec<_>>>()?;
    history_file::in_order(at, &points, "value")?;
    Some(asperity::History::Table { points })
}

/// What a prescribed value is.
#[derive(Clone, Copy)]
pub struct Kind {
    /// Its unit in SI.
    pub unit: &'static str,
    /// Whether it may not be negative: bodies that do not adhere only press.
    pub presses: bool,
}

/// What the rest of the case says of the contact.
#[derive(Clone, Copy)]
pub struct Bodies {
    /// Whether it is a line contact, whose loads are per length.
    pub line: bool,
    /// Whether the bodies adhere: then a load may be negative, and the control is the approach where the case names none.
    pub adhere: bool,
}

impl Kind {
    pub const LENGTH: Kind = Kind { unit: "m", presses: false };
    pub const VELOCITY: Kind = Kind { unit: "m/s", presses: false };

    pub fn of(control: Control, bodies: Bodies) -> Self {
        let unit = match control {
            Control::Load if bodies.line => "N/m",
            Control::Load => "N",
            Control::Pressure => "Pa",
            Control::Approach => "m",
        };
        Kind { unit, presses: control != Control::Approach && !bodies.adhere }
    }

    /// The value in SI, in the dimension that it must have.
    pub fn resolve(self, value: &Prescribed) -> Result<f64, QuantityError> {
        let si = match self.presses {
            true => dimension::resolve::<NonNegative>(self.unit, value),
            false => dimension::resolve::<Finite>(self.unit, value),
        };
        si.map_err(|QuantityError { code, expected, help }| {
            let help = match (self.unit, help) {
                ("N/m", Some(help)) if help.contains("unit of a force;") => {
                    format!("{help}; the domain is a line of cells, so the load is per length along y")
                }
                ("N", Some(help)) if help.contains("unit of a force per length") => {
                    format!(
                        "{help}; loads per length are for a line contact, with cells = [N] and size = [\"L\"]"
                    )
                }
                (_, None) if self.presses => {
                    "there is no adhesion; to pull the bodies apart prescribe the approach".to_owned()
                }
                (_, help) => return QuantityError { code, expected, help },
            };
            QuantityError { code, expected, help: Some(help) }
        })
    }
}
