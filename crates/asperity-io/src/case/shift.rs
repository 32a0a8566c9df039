//! `shift` of a material: how its times and its moduli depend on temperature.

use asperity::material::{self, VerticalShift};

use super::keys::*;
use super::material::Dependence;
use crate::curve::{self, ShiftRequest, VerticalRequest, VerticalWord};

/// How all times of a material scale with temperature: by the shift factor a_T, 1 at the reference.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shift {
    /// How the moduli depend on temperature; they do not if not given. "free" only with "estimated".
    #[schemars(example = &"density")]
    vertical: Option<Vertical>,
    #[schemars(flatten)]
    model: Model,
}

/// The law of a shift.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "model")]
enum Model {
    /// Williams, Landel, Ferry: log10 a_T = -c1 (T - reference)/(c2 + T - reference).
    Wlf {
        /// c1, in decades (log10).
        #[schemars(example = 8.86)]
        c1: Number<Positive>,
        /// c2, a difference of temperatures.
        #[schemars(example = "101.6 K")]
        c2: TemperatureDifference<Positive>,
        /// Reference temperature, to which the given values of the material belong.
        reference: Temperature,
    },
    /// ln a_T = (energy/R) (1/T - 1/reference).
    Arrhenius {
        /// Activation energy.
        energy: MolarEnergy<Positive>,
        /// Reference temperature, to which the given values of the material belong.
        reference: Temperature,
    },
    /// A table of shift factors, with log10 a_T linear in between.
    Table {
        /// Pairs [temperature, log10 a_T] in order of temperature; 0 at the reference temperature. This or `path`.
        #[schemars(example = (("0 °C", 2.5), ("20 °C", 0.0), ("60 °C", -3.0)))]
        points: Option<Vec<Two<Temperature, Number>>>,
        /// A file of them, relative to the case file: a table with columns T and log_aT (or ln_aT, aT), with units in the
        /// header. This or `points`.
        #[schemars(example = "shift.csv")]
        path: Option<String>,
    },
    /// Estimated from the overlap of the sweeps of a file with several temperatures.
    Estimated {
        /// Reference temperature, among those of the file.
        reference: Temperature,
    },
}

/// How the moduli of a material depend on temperature, in addition to its times: at T they are those at the reference temperature of
/// the shift over b_T. "density" (b_T = reference/T, as for a rubber), "free" (one factor for each sweep of a file), a table, or
/// pairs [temperature, b_T] in order of temperature: 1 at the reference, ln b_T is linear in between.
type Vertical = Form<VerticalWord, Vec<Two<Temperature, Number<Positive>>>, VerticalDensity>;

impl Word for VerticalWord {
    const FORMS: &'static str = "\"density\" (b_T = reference/T, as for a rubber), \"free\" (one factor for each sweep of a file), \
                                 { expansion = \"6e-4 1/K\" }, or pairs [temperature, b_T]";
}

/// Moduli grow as density times absolute temperature: b_T = (reference/T) (1 + expansion (T - reference)).
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VerticalDensity {
    /// Relative growth of the volume per kelvin.
    expansion: Expansion<NonNegative>,
}

impl Shift {
    fn request(&self, at: &Place<'_>) -> Option<ShiftRequest> {
        let shift = match &self.model {
            Model::Wlf { c1, c2, reference } => {
                material::Shift::Wlf { c1: c1.get(), c2: c2.get(), reference: reference.get() }
            }
            Model::Arrhenius { energy, reference } => {
                material::Shift::Arrhenius { activation_energy: energy.get(), reference: reference.get() }
            }
            Model::Table { points, path } => {
                at.exactly_one(&["points", "path"])?;
                let point = |Two(temperature, decades): &Two<Temperature, Number>| {
                    (temperature.get(), decades.get() * std::f64::consts::LN_10)
                };
                match path {
                    None => material::Shift::Table { points: points.iter().flatten().map(point).collect() },
                    Some(path) => {
                        let at = at.key("path");
                        let full = at.file(path)?;
                        at.note_read(path, &full);
                        let read = curve::read_shift_table(&full);
                        at.data(read, "a table of temperatures and shift factors")?
                    }
                }
            }
            Model::Estimated { reference } => return Some(ShiftRequest::Estimate(reference.get())),
        };
        at.core(shift.validate())?;
        Some(ShiftRequest::Given(shift))
    }
}

/// How a material at `at` depends on temperature: by its `shift`, and by the `vertical` of that or of its fit.
pub fn dependence(at: &Place<'_>, shift: Option<&Shift>, of_fit: Option<VerticalWord>) -> Option<Dependence> {
    let request = match shift {
        Some(shift) => shift.request(&at.key("shift"))?,
        None => ShiftRequest::None,
    };
    let vertical = match (shift.and_then(|shift| shift.vertical.as_ref()), of_fit) {
        (Some(_), Some(_)) => {
            let message = "`vertical` is given here and in `shift`";
            return at.key("fit").fault(message, "one `vertical`", "leave one of them out");
        }
        (None, None) => VerticalRequest::None,
        (Some(Form::Word(VerticalWord::Density)), _) | (_, Some(VerticalWord::Density)) => {
            VerticalRequest::Density { expansion: 0.0 }
        }
        (Some(Form::Word(VerticalWord::Free)), _) | (_, Some(VerticalWord::Free)) => VerticalRequest::Free,
        (Some(Form::Table(density)), _) => VerticalRequest::Density { expansion: density.expansion.get() },
        (Some(Form::List(points)), _) => {
            let point =
                |Two(kelvin, factor): &Two<Temperature, Number<_>>| (kelvin.get(), libm::log(factor.get()));
            VerticalRequest::Given(VerticalShift::Table { points: points.iter().map(point).collect() })
        }
    };
    Some(Dependence { shift: request, vertical })
}
