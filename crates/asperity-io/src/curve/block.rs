//! A fitted material as a block of a case file.

use std::fmt::Write;

use asperity::material::{Creep, Relaxation, Shift, VerticalShift};

use super::{Curves, Fitted, Series};
use crate::choice;

impl Fitted {
    /// `material = { ... }` in full precision, to stand under a `[[body]]` of a case file or in a file of its own,
    /// with remarks on where it comes from.
    pub fn to_toml(&self, curves: &Curves) -> String {
        let mut text = String::new();
        let name = curves.path.file_name().map_or("data".into(), |name| name.to_string_lossy().into_owned());
        let name: String = name.chars().map(|c| if c.is_control() { '?' } else { c }).collect();
        let [first, last] = self.window;
        let _ = writeln!(
            text,
            "# Fitted to {} points of {name} ({}): {} terms, misfit {:.2} % rms and {:.2} % at most;\n\
             # the data cover times from {first:.3e} s to {last:.3e} s. Behind each term: relative standard deviations.",
            self.data.x.len(),
            curves.kind.name(),
            self.terms(),
            100.0 * self.misfit.rms,
            100.0 * self.misfit.max,
        );
        let measure = choice::word(&self.material.measure());
        match &self.series {
            Series::Relaxation(relaxation) => prony(&mut text, measure, relaxation, &self.uncertainty),
            Series::Creep(function) => creep(&mut text, measure, function, &self.uncertainty),
        }
        if let Some(shift) = &self.shift {
            let vertical = self.vertical.as_ref().map_or(String::new(), vertical);
            let _ = write!(text, ", shift = {}{vertical} }}", law(shift));
        }
        text.push_str(" }\n");
        text
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

fn prony(text: &mut String, measure: &str, relaxation: &Relaxation, uncertainty: &[[f64; 2]]) {
    let _ = write!(
        text,
        "material = {{ model = \"prony\", modulus = \"{measure}\", equilibrium = \"{:e} Pa\", terms = [",
        relaxation.equilibrium
    );
    for (k, term) in relaxation.terms.iter().enumerate() {
        let _ = write!(
            text,
            "\n  {{ modulus = \"{:e} Pa\", time = \"{:e} s\" }},{}",
            term.modulus,
            term.relaxation_time,
            known(uncertainty.get(k))
        );
    }
    text.push_str("\n]");
}

fn creep(text: &mut String, measure: &str, creep: &Creep, uncertainty: &[[f64; 2]]) {
    let _ = write!(
        text,
        "material = {{ model = \"creep\", compliance = \"{measure}\", instantaneous = \"{:e} 1/Pa\", terms = [",
        creep.instantaneous
    );
    for (k, term) in creep.terms.iter().enumerate() {
        let _ = write!(
            text,
            "\n  {{ compliance = \"{:e} 1/Pa\", time = \"{:e} s\" }},{}",
            term.compliance,
            term.retardation_time,
            known(uncertainty.get(k))
        );
    }
    text.push_str("\n]");
    if creep.fluidity > 0.0 {
        let _ = write!(text, ", fluidity = \"{:e} 1/(Pa s)\"", creep.fluidity);
    }
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
