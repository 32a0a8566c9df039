//! `asperity fit-indentation`: the material of a body from a measured indentation.

use asperity::indentation::{
    Given, IndentationFit, IndentationOptions, IndentationRecord, Interval, PowerLawFit, SampleLayer,
    fit_indentation, fit_power_law,
};
use asperity::layer::Interface;
use asperity::material::{LongTime, Modulus};
use asperity::reference::MdrProfile;
use asperity_io::choice;
use asperity_io::curve::{Indentation, IndentationTest, MaterialOf, indentation_block, power_law_block};
use asperity_io::quantity::Quantity;
use asperity_io::quantity::dimension::{ForcePerLength, Length};
use asperity_report::material as picture;
use serde_json::{Value, json};

use super::force_curve::share;
use super::material::{columns, refused};
use crate::args::{FitIndentation, FitModel};
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
        let profile = profile(self)?;
        let power_law = match self.model {
            FitModel::Curve(model) => return super::force_curve::fit(self, model, profile),
            FitModel::PowerLaw => true,
            FitModel::Viscoelastic => false,
        };
        super::force_curve::not_given(self)?;
        let mut options = options(self)?;
        let of = MaterialOf { modulus: self.modulus, poisson: self.poisson.get() };
        let columns = columns(&self.column, &self.unit)?;
        let record = match super::force_file::record(self)? {
            Some(record) => {
                options.fit_touch = true;
                record
            }
            None => Indentation::read(&self.record, &columns).map_err(refused)?,
        };
        let taken = IndentationRecord { times: &record.times, loads: &record.loads, depths: &record.depths };
        let deepest = record.depths.iter().copied().fold(0.0, f64::max);
        let test = IndentationTest { profile, layer: options.layer, deepest };
        let title = super::title(&self.record);
        let about = Failure::about(self.record.display());
        let told = |mut object: Value, notes: &[String]| {
            object["indenter"] = json!(self.indenter);
            object["notes"] = json!(record.notes.iter().chain(notes).collect::<Vec<_>>());
            object
        };
        if power_law {
            let fit = fit_power_law(profile, &taken, &options).map_err(about)?;
            return self.to.deliver(
                &power_law_block(&record, &test, &fit, of),
                || Ok(picture::power_law(&title, &record, &fit)),
                || told(json_of_power_law(&fit, of), &fit.notes),
                || report_power_law(self, &record, &fit, of),
            );
        }
        let fit = fit_indentation(profile, &taken, &options).map_err(about)?;
        self.to.deliver(
            &indentation_block(&record, &test, &fit, of),
            || Ok(picture::indentation(&title, &record, &fit)),
            || told(json_of(&fit, of), &fit.notes),
            || report(self, &record, &fit, of),
        )
    }
}

/// The indenter of the options.
fn profile(args: &FitIndentation) -> Result<MdrProfile, Failure> {
    let word = choice::word(&args.indenter);
    let (wanted, size, other, unwanted) = match args.indenter.is_round() {
        true => ("--radius", args.radius.map(Quantity::get), "--angle", args.angle.is_some()),
        false => ("--angle", args.angle.map(|angle| angle.get()), "--radius", args.radius.is_some()),
    };
    if unwanted {
        refuse!(
            "{other} is given, but --indenter {word} has none; {}",
            if args.indenter.is_round() { "say --indenter cone or pyramid" } else { "leave it out" }
        );
    }
    let size = size.ok_or_else(|| Failure::input(format!("{wanted} is needed for --indenter {word}")))?;
    args.indenter.profile(size).map_err(|error| Failure::input(format!("--angle: {error}")))
}

/// The thin sample of the options.
pub(super) fn sample(args: &FitIndentation) -> Option<SampleLayer> {
    let (poisson, interface) = (args.poisson.get(), args.interface);
    args.thickness.map(|depth| SampleLayer { thickness: depth.get(), poisson, interface })
}

/// The thin sample in words.
pub(super) fn sample_in_words(args: &FitIndentation) -> Option<String> {
    let interface = if args.interface == Interface::Bonded { "bonded to" } else { "slipping on" };
    args.thickness.map(|depth| format!("{} thick, {interface} a rigid base", quantity(depth.get(), "m")))
}

fn options(args: &FitIndentation) -> Result<IndentationOptions, Failure> {
    let layer = sample(args);
    let [radius, thickness] = [args.radius, args.thickness].map(|x| x.map(Quantity::get));
    let stiffness = &args.curve.spring_constant_uncertainty;
    if matches!(args.model, FitModel::PowerLaw) {
        for (option, given) in
            [("--terms", args.terms.is_some()), ("--long-time", args.long_time != LongTime::Free)]
        {
            if given {
                refuse!(
                    "{option} goes with --model viscoelastic: a power law has no terms and no end; leave it out"
                );
            }
        }
    }
    Ok(IndentationOptions {
        radius_uncertainty: share::<Length>("--radius-uncertainty", &args.curve.radius_uncertainty, radius)?,
        thickness_uncertainty: share::<Length>(
            "--thickness-uncertainty",
            &args.thickness_uncertainty,
            thickness,
        )?,
        load_uncertainty: share::<ForcePerLength>("--spring-constant-uncertainty", stiffness, None)?,
        given: args.given,
        terms: args.terms,
        long_time: args.long_time,
        fit_touch: args.fit_touch,
        layer,
        ..IndentationOptions::default()
    })
}

fn given(given: Given) -> (&'static str, &'static str, &'static str) {
    match given {
        Given::Depth => ("depth", "load", "N"),
        Given::Load => ("load", "depth", "m"),
    }
}

/// The size of the indenter in words.
pub(super) fn indenter(args: &FitIndentation) -> String {
    let word = choice::word(&args.indenter);
    match (args.radius, args.angle) {
        (Some(radius), _) => format!("{word}, radius {}", quantity(radius.get(), "m")),
        (None, Some(angle)) => {
            format!("{word}, half angle {} deg", (1e4 * angle.get().to_degrees()).round() / 1e4)
        }
        (None, None) => word.to_owned(),
    }
}

/// The lines about the record.
fn head(
    args: &FitIndentation,
    record: &Indentation,
    used: usize,
    of: Given,
    [step, length]: [f64; 2],
) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| text += &format!("{name:<12}{value}\n");
    let (taken, fitted, _) = given(of);
    line("record", args.record.display().to_string());
    let rows = record.times.len();
    let means = if used < rows { format!(", averaged to {used} points") } else { String::new() };
    line("rows", format!("{rows}{means}"));
    line("indenter", indenter(args));
    line("given", format!("{taken}; the {fitted} is fitted"));
    if let Some(sample) = sample_in_words(args) {
        line("sample", sample);
    }
    line("times", format!("steps from {}, {} in all", quantity(step, "s"), quantity(length, "s")));
    text
}

fn misfit(rms: f64, relative: f64, of: Given) -> String {
    let (_, fitted, unit) = given(of);
    format!("{} rms, {:.3} % of the largest {fitted}", quantity(rms, unit), 100.0 * relative)
}

fn report_power_law(
    args: &FitIndentation,
    record: &Indentation,
    fit: &PowerLawFit,
    of: MaterialOf,
) -> String {
    let mut text = head(args, record, fit.rows.len(), fit.given, fit.window);
    let mut line = |name: &str, value: String| text += &format!("{name:<12}{value}\n");
    let symbol = if of.modulus == Modulus::Young { "E" } else { "G" };
    line("model", format!("power law, {symbol}(t) = {symbol}_1 (t/1 s)^-alpha"));
    line("misfit", misfit(fit.rms, fit.relative_rms, fit.given));
    line("", format!("{:<12}95 % interval", "value"));
    line(&format!("{symbol}_1"), interval_in_words(of.of(fit.modulus), "Pa"));
    line("alpha", interval_in_words(fit.exponent, ""));
    for (name, found, unit) in
        [("touch", fit.touch, "m"), ("baseline", fit.baseline, "N"), ("tilt", fit.tilt, "N/m")]
    {
        if found.low < found.high {
            line(name, interval_in_words(found, unit));
        }
    }
    record.notes.iter().chain(&fit.notes).for_each(|note| line("note", note.clone()));
    text
}

fn json_of_power_law(fit: &PowerLawFit, of: MaterialOf) -> Value {
    json!({
        "model": "power-law",
        "given": given(fit.given).0,
        "rows": fit.rows.len(),
        "window": fit.window,
        "modulus": of.modulus,
        "poisson": of.poisson,
        "modulus_at_1_s": interval(of.of(fit.modulus)),
        "exponent": interval(fit.exponent),
        "touch": interval(fit.touch),
        "baseline": interval(fit.baseline),
        "tilt": interval(fit.tilt),
        "confidence": 0.95,
        "rms": fit.rms,
        "relative_rms": fit.relative_rms,
        "durbin_watson": fit.durbin_watson,
    })
}

fn report(args: &FitIndentation, record: &Indentation, fit: &IndentationFit, of: MaterialOf) -> String {
    let mut text = head(args, record, fit.rows.len(), fit.given, fit.window);
    let mut line = |name: &str, value: String| text += &format!("{name:<12}{value}\n");
    let reason = match args.terms {
        Some(_) => "as asked for".to_owned(),
        None => format!(
            "others do not lower the Bayesian information criterion, are not determined or practically excluded; probability {:.2}",
            fit.numbers[fit.terms.len()]
        ),
    };
    line("terms", format!("{} ({reason})", fit.terms.len()));
    line("misfit", misfit(fit.rms, fit.relative_rms, fit.given));
    let symbol = if of.modulus == Modulus::Young { "E" } else { "G" };
    let pascal = |x: Interval| interval_in_words(of.of(x), "Pa");
    line("", format!("{:<12}95 % interval", "value"));
    line(&format!("{symbol}(0)"), pascal(fit.instantaneous));
    line(&format!("{symbol}(inf)"), pascal(fit.equilibrium));
    for (k, [modulus, time]) in fit.terms.iter().enumerate() {
        line(&format!("{symbol}_{}", k + 1), pascal(*modulus));
        line(&format!("tau_{}", k + 1), interval_in_words(*time, "s"));
    }
    for (name, found, unit) in
        [("touch", fit.touch, "m"), ("baseline", fit.baseline, "N"), ("tilt", fit.tilt, "N/m")]
    {
        if found.low < found.high {
            line(name, interval_in_words(found, unit));
        }
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
    json!({
        "model": "viscoelastic",
        "given": given(fit.given).0,
        "rows": fit.rows.len(),
        "window": fit.window,
        "modulus": of.modulus,
        "poisson": of.poisson,
        "instantaneous": modulus(fit.instantaneous),
        "equilibrium": modulus(fit.equilibrium),
        "terms": fit.terms.iter().map(|[m, t]| json!({ "modulus": modulus(*m), "time": interval(*t) })).collect::<Vec<_>>(),
        "touch": interval(fit.touch),
        "baseline": interval(fit.baseline),
        "tilt": interval(fit.tilt),
        "confidence": 0.95,
        "numbers_of_terms": fit.numbers,
        "rms": fit.rms,
        "relative_rms": fit.relative_rms,
        "durbin_watson": fit.durbin_watson,
    })
}
