//! `asperity fit-indentation`: the material of a body from a measured indentation.

use asperity::indentation::{
    Given, IndentationFit, IndentationOptions, IndentationRecord, Interval, SampleLayer, fit_indentation,
};
use asperity::layer::Interface;
use asperity::material::Modulus;
use asperity::reference::MdrProfile;
use asperity_io::curve::{Indentation, IndentationTest, MaterialOf, indentation_block};
use asperity_io::quantity::Quantity;
use asperity_io::quantity::dimension::{ForcePerLength, Length};
use asperity_report::material::indentation as picture;
use serde_json::{Value, json};

use super::force_curve::share;
use super::material::{columns, refused};
use crate::args::FitIndentation;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::format::quantity;
use crate::verb::Verb;

impl Verb for FitIndentation {
    fn files(&self) -> Files {
        self.to.files().reads([&self.record])
    }

    /// Fits a record.
    fn run(&self) -> Result<(), Failure> {
        if let Some(model) = self.model.0 {
            return super::force_curve::fit(self, model);
        }
        super::force_curve::not_given(self)?;
        let profile = match (self.radius, self.cone) {
            (_, Some(slope)) => MdrProfile::Cone { slope: slope.get() },
            (Some(radius), None) => MdrProfile::Sphere { radius: radius.get() },
            (None, None) => refuse!("--radius or --cone is needed"),
        };
        let (poisson, interface) = (self.poisson.get(), self.interface);
        let layer = self.thickness.map(|depth| SampleLayer { thickness: depth.get(), poisson, interface });
        let of = MaterialOf { modulus: self.modulus, poisson };
        let columns = columns(&self.column, &self.unit)?;
        let [radius, thickness] = [self.radius, self.thickness].map(|x| x.map(Quantity::get));
        let stiffness = &self.curve.spring_constant_uncertainty;
        let options = IndentationOptions {
            radius_uncertainty: share::<Length>(
                "--radius-uncertainty",
                &self.curve.radius_uncertainty,
                radius,
            )?,
            thickness_uncertainty: share::<Length>(
                "--thickness-uncertainty",
                &self.thickness_uncertainty,
                thickness,
            )?,
            load_uncertainty: share::<ForcePerLength>("--spring-constant-uncertainty", stiffness, None)?,
            given: self.given,
            terms: self.terms,
            long_time: self.long_time,
            fit_touch: self.fit_touch,
            layer,
            ..IndentationOptions::default()
        };
        let record = Indentation::read(&self.record, &columns).map_err(refused)?;
        let taken = IndentationRecord { times: &record.times, loads: &record.loads, depths: &record.depths };
        let fit =
            fit_indentation(profile, &taken, &options).map_err(Failure::about(self.record.display()))?;
        let block = indentation_block(&record, &IndentationTest { profile, layer }, &fit, of);
        let object = || {
            let mut object = json_of(&fit, of);
            object["notes"] = json!(record.notes.iter().chain(&fit.notes).collect::<Vec<_>>());
            object
        };
        let title = super::title(&self.record);
        self.to.deliver(
            &block,
            || Ok(picture(&title, &record, &fit)),
            object,
            || report(self, &record, &fit, of),
        )
    }
}

fn given(fit: &IndentationFit) -> (&'static str, &'static str, &'static str) {
    match fit.given {
        Given::Depth => ("depth", "load", "N"),
        Given::Load => ("load", "depth", "m"),
    }
}

fn report(args: &FitIndentation, record: &Indentation, fit: &IndentationFit, of: MaterialOf) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| text += &format!("{name:<12}{value}\n");
    let (taken, fitted, unit) = given(fit);
    line("record", args.record.display().to_string());
    let rows = record.times.len();
    let means = if fit.rows.len() < rows {
        format!(", averaged to {} points", fit.rows.len())
    } else {
        String::new()
    };
    line("rows", format!("{rows}{means}"));
    line("given", format!("{taken}; the {fitted} is fitted"));
    if let Some(thickness) = &args.thickness {
        let interface = if args.interface == Interface::Bonded { "bonded to" } else { "slipping on" };
        let thickness = quantity(thickness.get(), "m");
        line("sample", format!("{thickness} thick, {interface} a rigid base"));
    }
    let [step, length] = fit.window;
    line("times", format!("steps from {}, {} in all", quantity(step, "s"), quantity(length, "s")));
    let reason = match args.terms {
        Some(_) => "as asked for".to_owned(),
        None => format!(
            "more do not lower the Bayesian information criterion, or are not determined; probability {:.2}",
            fit.numbers[fit.terms.len()]
        ),
    };
    line("terms", format!("{} ({reason})", fit.terms.len()));
    line(
        "misfit",
        format!("{} rms, {:.3} % of the largest {fitted}", quantity(fit.rms, unit), 100.0 * fit.relative_rms),
    );
    let symbol = if of.modulus == Modulus::Young { "E" } else { "G" };
    let pascal = |x: Interval| interval_in_words(of.of(x), "Pa");
    line("", format!("{:<12}95 % interval", "value"));
    line(&format!("{symbol}(0)"), pascal(fit.instantaneous));
    line(&format!("{symbol}(inf)"), pascal(fit.equilibrium));
    for (k, [modulus, time]) in fit.terms.iter().enumerate() {
        line(&format!("{symbol}_{}", k + 1), pascal(*modulus));
        line(&format!("tau_{}", k + 1), interval_in_words(*time, "s"));
    }
    if args.fit_touch {
        line("touch", interval_in_words(fit.touch, "m"));
    }
    record.notes.iter().chain(&fit.notes).for_each(|note| line("note", note.clone()));
    text
}

pub(super) fn interval_in_words(x: Interval, unit: &str) -> String {
    let [value, low, high] = [x.value, x.low, x.high].map(|x| quantity(x, unit));
    match x.determined {
        true => format!("{value:<11} {low} to {high}"),
        false => format!("not determined by this record ({low} to {high})"),
    }
}

/// Value and ends; what is not determined has no value, and JSON no infinity: null.
pub(super) fn interval(x: Interval) -> Value {
    json!([x.determined.then_some(x.value), x.low, x.high])
}

fn json_of(fit: &IndentationFit, of: MaterialOf) -> Value {
    let modulus = |x: Interval| interval(of.of(x));
    let (taken, ..) = given(fit);
    json!({
        "given": taken,
        "rows": fit.rows.len(),
        "window": fit.window,
        "modulus": of.modulus,
        "poisson": of.poisson,
        "instantaneous": modulus(fit.instantaneous),
        "equilibrium": modulus(fit.equilibrium),
        "terms": fit.terms.iter().map(|[m, t]| json!({ "modulus": modulus(*m), "time": interval(*t) })).collect::<Vec<_>>(),
        "touch": interval(fit.touch),
        "confidence": 0.95,
        "numbers_of_terms": fit.numbers,
        "rms": fit.rms,
        "relative_rms": fit.relative_rms,
        "durbin_watson": fit.durbin_watson,
    })
}
