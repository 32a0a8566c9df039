//! A fitted material as a block of a case file.

use std::fmt::Write;
use std::path::Path;

use asperity::material::{Shift, VerticalShift};

use super::{Curves, Fitted, Series};
use crate::choice;
use crate::readable::counted;

/// How a case file writes a model with terms: its name, the quantity of its terms, the key of its constant, and their unit.
pub(super) struct Model {
    name: &'static str,
    quantity: &'static str,
    constant: &'static str,
    unit: &'static str,
}

pub(super) const PRONY: Model =
    Model { name: "prony", quantity: "modulus", constant: "equilibrium", unit: "Pa" };
const CREEP: Model = Model { name: "creep", quantity: "compliance", constant: "instantaneous", unit: "1/Pa" };

impl Model {
    /// The keys of the model up to the end of its terms (value, time and a remark each); `remark` stands behind the constant.
    pub(super) fn written(
        &self,
        measure: &str,
        constant: f64,
        remark: &str,
        terms: impl Iterator<Item = ([f64; 2], String)>,
    ) -> String {
        let Model { name, quantity, constant: key, unit } = self;
        let mut text = format!(
            "material = {{ model = \"{name}\", {quantity} = \"{measure}\", {key} = \"{constant:e} {unit}\", terms = [{remark}"
        );
        for ([value, time], remark) in terms {
            let _ =
                write!(text, "\n  {{ {quantity} = \"{value:e} {unit}\", time = \"{time:e} s\" }},{remark}");
        }
        text + "\n]"
    }
}

/// The name of a file, as a remark may hold it.
pub(super) fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or("data".as_ref()).to_string_lossy();
    name.chars().map(|c| if c.is_control() { '?' } else { c }).collect()
}

impl Fitted {
    /// `material = { ... }` in full precision, to stand under a `[[body]]` of a case file or in a file of its own,
    /// with remarks on where it comes from.
    pub fn to_toml(&self, curves: &Curves) -> String {
        let [first, last] = self.window;
        let mut text = format!(
            "# Fitted to {} of {} ({}): {}, misfit {:.2} % rms and {:.2} % at most;\n\
             # the data cover times from {first:.3e} s to {last:.3e} s. Behind each term: relative standard deviations.\n",
            counted(self.data.x.len(), "point"),
            file_name(&curves.path),
            curves.kind.name(),
            counted(self.terms(), "term"),
            100.0 * self.misfit.rms,
            100.0 * self.misfit.max,
        );
        let (model, constant, terms, fluidity): (_, _, Vec<[f64; 2]>, _) = match &self.series {
            Series::Relaxation(function) => {
                let terms = function.terms.iter().map(|term| [term.modulus, term.relaxation_time]);
                (PRONY, function.equilibrium, terms.collect(), 0.0)
            }
            Series::Creep(function) => {
                let terms = function.terms.iter().map(|term| [term.compliance, term.retardation_time]);
                (CREEP, function.instantaneous, terms.collect(), function.fluidity)
            }
        };
        let remarks = (0..).map(|k| known(self.uncertainty.get(k)));
        let measure = choice::word(&self.material.measure());
        text += &model.written(measure, constant, "", terms.into_iter().zip(remarks));
        if fluidity > 0.0 {
            let _ = write!(text, ", fluidity = \"{fluidity:e} 1/(Pa s)\"");
        }
        let _ = write!(text, ", window = [\"{first:e} s\", \"{last:e} s\"]");
        if let Some(shift) = &self.shift {
            let vertical = self.vertical.as_ref().map_or(String::new(), vertical);
            let _ = write!(text, ", shift = {}{vertical} }}", law(shift));
        }
        text + " }\n"
    }
}

/// " # +- 3 %, +- 5 %" behind a term.
fn known(uncertainty: Option<&[f64; 2]>) -> String {
    let percent = |share: f64| match share.is_finite() {
        true => format!("{:.1} %", 100.0 * share),
        false => "unknown".to_owned(),
    };
    uncertainty
        .map_or(String::new(), |[weight, time]| format!("  # +- {}, +- {}", percent(*weight), percent(*time)))
}

/// A number with so many decimals at most, without the digits of a rounding error: "293.15", "-0.72".
fn trimmed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = text.trim_end_matches('0');
    if text.ends_with('.') { format!("{text}0") } else { text.to_owned() }
}

/// A shift, without the bracket that closes it.
fn law(shift: &Shift) -> String {
    match shift {
        Shift::Wlf { c1, c2, reference } => {
            format!(
                "{{ model = \"wlf\", c1 = {c1:?}, c2 = \"{c2:?} K\", reference = \"{} K\"",
                trimmed(*reference, 6)
            )
        }
        Shift::Arrhenius { activation_energy, reference } => format!(
            "{{ model = \"arrhenius\", energy = \"{activation_energy:?} J/mol\", reference = \"{} K\"",
            trimmed(*reference, 6)
        ),
        Shift::Table { points } => {
            let points: Vec<String> = points
                .iter()
                .map(|(kelvin, ln)| {
                    let decades = trimmed(ln / std::f64::consts::LN_10, 10);
                    format!("[\"{} K\", {decades}]", trimmed(*kelvin, 6))
                })
                .collect();
            format!("{{ model = \"table\", points = [{}]", points.join(", "))
        }
    }
}

/// The key of a shift.
fn vertical(vertical: &VerticalShift) -> String {
    match vertical {
        VerticalShift::Density { expansion: 0.0, .. } => ", vertical = \"density\"".to_owned(),
        VerticalShift::Density { expansion, .. } => {
            format!(", vertical = {{ expansion = \"{expansion:?} 1/K\" }}")
        }
        VerticalShift::Table { points } => {
            let point = |(kelvin, ln): &(f64, f64)| {
                format!("[\"{} K\", {}]", trimmed(*kelvin, 6), trimmed(ln.exp(), 10))
            };
            let points: Vec<String> = points.iter().map(point).collect();
            format!(", vertical = [{}]", points.join(", "))
        }
    }
}
