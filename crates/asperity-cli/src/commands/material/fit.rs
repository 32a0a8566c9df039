//! `asperity material fit`: a material from measured data, and how well it describes them.

use asperity::material::{Misfit, Modulus, Shift, VerticalShift};
use asperity_io::curve::{Curves, Fitted, Kind, Request, Series, ShiftRequest};
use asperity_report::material as pictures;
use serde_json::{Map, Value, json};

use super::options::{self, refused};
use super::{celsius, law, symbols};
use crate::args::Fit;
use crate::failure::Failure;
use crate::files::Files;
use crate::format::quantity;
use crate::verb::Verb;

/// Room temperature \[K\]: shifts are estimated about the sweep nearest to it where no reference is given.
pub const ROOM: f64 = 293.15;

impl Verb for Fit {
    fn files(&self) -> Files {
        self.to.files().reads(self.shift_table.iter().chain([&self.data]))
    }

    /// Fits, reports, writes and draws.
    fn run(&self) -> Result<(), Failure> {
        let (shift, vertical, options) =
            (options::shift(self)?, options::vertical(self)?, options::options(self));
        let mut curves = options::curves(&self.data, &self.table)?;
        let window = self.window.as_deref().map(|text| options::ends(curves.kind, text)).transpose()?;
        let measure = self.modulus.or(curves.measure).unwrap_or_else(|| {
            let note = "the header does not say which moduli these are: they are taken as Young's moduli; for shear moduli give \
                        --modulus shear";
            curves.notes.push(note.to_owned());
            Modulus::Young
        });
        let shift = estimated_unless_known(shift, &mut curves);
        let fitted = Request { measure, shift, vertical, window, options }.fit(&curves).map_err(refused)?;
        let findings = fitted.findings(&self.data.display().to_string());
        let block = fitted.to_toml(&curves);
        let object = || {
            let mut object = json_of(&curves, &fitted);
            object["findings"] = asperity_io::finding::list(&findings);
            object
        };
        let report = || {
            crate::commands::findings::print(&findings);
            report(self, &curves, &fitted)
        };
        let title = crate::commands::title(&self.data);
        self.to.deliver(&block, || pictures::fit(&title, &curves, &fitted), object, report)
    }
}

/// Several temperatures without a shift: it is estimated, about the temperature nearest to that of a room.
pub fn estimated_unless_known(shift: ShiftRequest, curves: &mut Curves) -> ShiftRequest {
    let several = curves.sweeps.len() > 1 && !curves.is_over_temperature() && curves.held.shift().is_none();
    let temperatures = curves.sweeps.iter().filter_map(|sweep| sweep.temperature);
    let nearest = temperatures.min_by(|a, b| (a - ROOM).abs().total_cmp(&(b - ROOM).abs()));
    match (&shift, nearest) {
        (ShiftRequest::None, Some(kelvin)) if several => {
            curves.notes.push(format!(
                "no shift is given: it is estimated from the sweeps, about {:.1} °C; --estimate-shift, --shift-table, --wlf or \
                 --arrhenius say it",
                kelvin - 273.15
            ));
            ShiftRequest::Estimate(kelvin)
        }
        _ => shift,
    }
}

fn report(args: &Fit, curves: &Curves, fitted: &Fitted) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| text += &format!("{name:<12}{value}\n");
    let (modulus, ..) = symbols(fitted.material.measure());
    let sheet = curves.sheet.as_ref().map_or(String::new(), |name| format!(", sheet \"{name}\""));
    line("data", format!("{}{sheet} ({}, {modulus})", args.data.display(), curves.kind.name()));
    line("points", format!("{} fitted of {}", fitted.data.x.len(), curves.points()));
    if curves.is_over_temperature() {
        line("ramp", curves.temperatures());
    } else if !fitted.temperatures.is_empty() {
        let shown: Vec<String> = fitted.temperatures.iter().map(|t| format!("{:.1}", celsius(*t))).collect();
        line("sweeps", format!("{} °C", shown.join(", ")));
    }
    if let Some(shift) = &fitted.shift {
        let rms = fitted
            .shift_rms
            .map_or(String::new(), |rms| format!(", {rms:.3} decades (rms) from the factors"));
        line("shift", format!("{}{rms}", law(shift)));
    }
    for [kelvin, decades, uncertainty] in &fitted.factors {
        line("", format!("{:8.1} °C  log10 a_T = {decades:7.3} +- {uncertainty:.3}", celsius(*kelvin)));
    }
    if let Some(vertical) = &fitted.vertical {
        line("moduli", vertical_law(vertical));
    }
    for [kelvin, factor, uncertainty] in &fitted.vertical_factors {
        let known =
            if *uncertainty > 0.0 { format!(" +- {:.1} %", 100.0 * uncertainty) } else { String::new() };
        line("", format!("{:8.1} °C  b_T = {factor:.4}{known}", celsius(*kelvin)));
    }
    let [first, last] = fitted.window;
    line("times", format!("{first:.3e} s to {last:.3e} s"));
    if curves.kind == Kind::Dma {
        let hertz = [last, first].map(|time| 1.0 / (std::f64::consts::TAU * time));
        line("frequencies", format!("{:.3e} Hz to {:.3e} Hz", hertz[0], hertz[1]));
    }
    let reason = match args.misfit {
        Some(_) => "the fewest with the misfit asked for",
        None => "more do not lower the Bayesian information criterion",
    };
    line("terms", format!("{} ({reason})", fitted.terms()));
    let unit = if curves.kind == Kind::Dma { "rad/s" } else { "s" };
    let misfit = |of: &Misfit| {
        let [rms, max] = [of.rms, of.max].map(|share| 100.0 * share);
        format!("{rms:.3} % rms, {max:.3} % at most (at {:.3e} {unit})", of.worst)
    };
    line("misfit", misfit(&fitted.misfit));
    if fitted.columns.len() > 1 {
        for (name, of) in &fitted.columns {
            let left = fitted.other().is_some_and(|(other, _)| other == *name);
            line("", format!("{name}: {}{}", misfit(of), if left { ", not fitted" } else { "" }));
        }
    }
    line("scatter", format!("{:.3} % of the data", 100.0 * fitted.noise));
    line("beyond", beyond(fitted));
    fitted.notes.iter().for_each(|note| line("note", note.clone()));
    text
}

/// What the material does at times that the data do not cover.
fn beyond(fitted: &Fitted) -> String {
    match &fitted.series {
        Series::Relaxation(relaxation) => {
            let long = match relaxation.equilibrium > 0.0 {
                true => format!("a plateau of {} at longer ones", quantity(relaxation.equilibrium, "Pa")),
                false => "no modulus left at longer ones".to_owned(),
            };
            format!("a plateau of {} at shorter times, {long}", quantity(relaxation.instantaneous(), "Pa"))
        }
        Series::Creep(creep) => {
            let long = match creep.fluidity > 0.0 {
                true => format!("flow at longer ones, viscosity {}", quantity(1.0 / creep.fluidity, "Pa s")),
                false => format!("a plateau of {} at longer ones", quantity(creep.long_time(), "1/Pa")),
            };
            format!("a plateau of {} at shorter times, {long}", quantity(creep.instantaneous, "1/Pa"))
        }
    }
}

fn vertical_law(vertical: &VerticalShift) -> String {
    match vertical {
        VerticalShift::Density { reference, expansion } => {
            let volume = match *expansion > 0.0 {
                true => format!(" (1 + {expansion:.3e} 1/K (T - reference))"),
                false => String::new(),
            };
            format!("divided by b_T = {:.2} °C over T, in kelvin{volume}", reference - 273.15)
        }
        VerticalShift::Table { .. } => "divided by b_T, one factor for each sweep".to_owned(),
    }
}

fn json_of(curves: &Curves, fitted: &Fitted) -> Value {
    let function = match &fitted.series {
        Series::Relaxation(relaxation) => json!({
            "equilibrium": relaxation.equilibrium,
            "terms": relaxation.terms.iter().map(|t| json!([t.modulus, t.relaxation_time])).collect::<Vec<_>>(),
        }),
        Series::Creep(creep) => json!({
            "instantaneous": creep.instantaneous,
            "fluidity": creep.fluidity,
            "terms": creep.terms.iter().map(|t| json!([t.compliance, t.retardation_time])).collect::<Vec<_>>(),
        }),
    };
    let shift = fitted.shift.as_ref().map(|shift| match shift {
        Shift::Wlf { c1, c2, reference } => {
            json!({ "model": "wlf", "c1": c1, "c2": c2, "reference": reference })
        }
        Shift::Arrhenius { activation_energy, reference } => {
            json!({ "model": "arrhenius", "energy": activation_energy, "reference": reference })
        }
        Shift::Table { points } => json!({ "model": "table", "ln_factors": points }),
    });
    let mut columns = Map::new();
    for (name, misfit) in &fitted.columns {
        let fitted = fitted.other().is_none_or(|(other, _)| other != *name);
        let of = json!({ "misfit_rms": misfit.rms, "misfit_max": misfit.max, "worst": misfit.worst, "fitted": fitted });
        columns.insert((*name).to_owned(), of);
    }
    json!({
        "kind": curves.kind.name(),
        "modulus": fitted.material.measure(),
        "points": fitted.data.x.len(),
        "temperatures": fitted.temperatures,
        "shift": shift,
        "shift_rms_decades": fitted.shift_rms,
        "window": fitted.window,
        "terms": fitted.terms(),
        "function": function,
        "misfit": { "max": fitted.misfit.max, "rms": fitted.misfit.rms, "worst": fitted.misfit.worst },
        "columns": columns,
        "sheet": curves.sheet,
        "shift_factors": fitted.factors.iter().map(|[kelvin, decades, uncertainty]| {
            json!({ "temperature": kelvin, "log10_factor": decades, "uncertainty_decades": uncertainty })
        }).collect::<Vec<Value>>(),
        "vertical": fitted.vertical.as_ref().map(|vertical| match vertical {
            VerticalShift::Density { reference, expansion } => {
                json!({ "model": "density", "reference": reference, "expansion": expansion })
            }
            VerticalShift::Table { points } => json!({ "model": "table", "ln_factors": points }),
        }),
        "vertical_factors": fitted.vertical_factors.iter().map(|[kelvin, factor, uncertainty]| {
            json!({ "temperature": kelvin, "factor": factor, "uncertainty": uncertainty })
        }).collect::<Vec<Value>>(),
        "noise": fitted.noise,
        "uncertainty": fitted.uncertainty,
        "notes": fitted.notes,
    })
}
