//! `asperity fit-indentation --model jkr`: modulus and work of adhesion from a force curve.

use asperity::force_curve::{ForceFit, ForceModel, ForceOptions, ForceRecord, fit_force_curve};
use asperity::material::{LongTime, Modulus};
use asperity::reference::MdrProfile;
use asperity_io::choice;
use asperity_io::curve::{Cantilever, ForceTable, MaterialOf};
use asperity_io::quantity::dimension::{ForcePerLength, Length};
use asperity_io::quantity::{Dimension, Number, Quantity, range};
use asperity_report::material::force_curve as picture;
use serde_json::{Value, json};

use super::fit_indentation::{interval, interval_in_words};
use super::material::{columns, refused};
use crate::args::FitIndentation;
use crate::failure::{Failure, refuse};
use crate::format::quantity;

/// Refuses options of force curves where the relaxation is fitted.
pub fn not_given(args: &FitIndentation) -> Result<(), Failure> {
    let curve = &args.curve;
    for (option, given) in [
        ("--branch", curve.branch.is_some()),
        ("--control", curve.control.is_some()),
        ("--range", curve.range.is_some()),
        ("--weights", curve.weights.is_some()),
        ("--spring-constant", curve.spring_constant.is_some()),
    ] {
        if given {
            refuse!("{option} goes with a force curve: give --model hertz, dmt, jkr or maugis");
        }
    }
    Ok(())
}

/// Fits a force curve.
pub fn fit(args: &FitIndentation, model: ForceModel, profile: MdrProfile) -> Result<(), Failure> {
    let word = choice::word(&model);
    if args.thickness.is_some() && model != ForceModel::Hertz {
        refuse!(
            "--thickness does not go with --model {word}: its closed form is that of a half-space, and for adhesion on a thin sample there is \
             none; --model hertz fits an elastic thin sample without adhesion"
        );
    }
    for (option, given) in [
        ("--given", args.given.is_some()),
        ("--terms", args.terms.is_some()),
        ("--long-time", args.long_time != LongTime::Free),
        ("--fit-touch", args.fit_touch),
    ] {
        if given {
            refuse!(
                "{option} goes with --model viscoelastic, but the model is {word}, an elastic half-space: leave it out"
            );
        }
    }
    if model != ForceModel::Hertz && !args.indenter.is_round() {
        refuse!(
            "--indenter {} goes with --model hertz, but the model is {word}: the models of adhesion are those of a sphere",
            choice::word(&args.indenter)
        );
    }
    let curve = &args.curve;
    let spring = curve.spring_constant.map(Quantity::get);
    let cantilever = spring.map(|spring_constant| Cantilever {
        spring_constant,
        sensitivity: curve.sensitivity.map(Quantity::get),
    });
    let options = ForceOptions {
        model,
        branch: curve.branch.unwrap_or_default(),
        control: curve.control,
        weights: curve.weights.unwrap_or_default(),
        range: curve.range.map(Quantity::get),
        radius_uncertainty: share::<Length>(
            "--radius-uncertainty",
            &curve.radius_uncertainty,
            args.radius.map(Quantity::get),
        )?,
        spring_constant: spring,
        layer: super::fit_indentation::sample(args),
        thickness_uncertainty: share::<Length>(
            "--thickness-uncertainty",
            &args.thickness_uncertainty,
            args.thickness.map(Quantity::get),
        )?,
        load_uncertainty: share::<ForcePerLength>(
            "--spring-constant-uncertainty",
            &curve.spring_constant_uncertainty,
            spring,
        )?,
        sensitivity_uncertainty: curve.sensitivity_uncertainty.map_or(0.0, Quantity::get),
    };
    let said = columns(&args.column, &args.unit)?;
    let table = match super::force_file::table(args)? {
        Some(table) => table,
        None => ForceTable::read(&args.record, &said, cantilever).map_err(refused)?,
    };
    let record = ForceRecord { loads: &table.loads, depths: &table.depths };
    let fit = fit_force_curve(profile, &record, &options).map_err(Failure::about(args.record.display()))?;
    let of = MaterialOf { modulus: args.modulus, poisson: args.poisson.get() };
    let block = block(args, &fit, of);
    let object = || {
        let mut object = json_of(&fit, of);
        object["indenter"] = json!(args.indenter);
        object["notes"] = json!(table.notes.iter().chain(&fit.notes).collect::<Vec<_>>());
        object
    };
    let title = super::title(&args.record);
    args.to.deliver(&block, || Ok(picture(&title, &table, &fit)), object, || report(args, &table, &fit, of))
}

/// A stated uncertainty, of this dimension or in %, over the value of its quantity; 0 where none is stated.
pub(super) fn share<D: Dimension>(
    option: &str,
    text: &Option<String>,
    value: Option<f64>,
) -> Result<f64, Failure> {
    let Some(text) = text else { return Ok(0.0) };
    let wrong = |why: String| Failure::input(format!("{option} is \"{text}\", but {why}"));
    if text.trim_end().ends_with('%') {
        let share = text.parse::<Number<range::NonNegative>>();
        return share.map(Number::get).map_err(|error| wrong(format!("must be {}", error.expected)));
    }
    let value = value.ok_or_else(|| wrong("its quantity is not given: state it in %".to_owned()))?;
    let stated = text.parse::<Quantity<D, range::NonNegative>>();
    stated
        .map(|stated| stated.get() / value)
        .map_err(|error| wrong(error.help.unwrap_or(format!("must be {}", error.expected))))
}

fn report(args: &FitIndentation, table: &ForceTable, fit: &ForceFit, of: MaterialOf) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| text += &format!("{name:<12}{value}\n");
    line("record", args.record.display().to_string());
    let [contact, free] = fit.used;
    line("rows", format!("{}: {contact} fitted in contact, {free} of the free sphere", table.loads.len()));
    line("indenter", super::fit_indentation::indenter(args));
    if let Some(sample) = super::fit_indentation::sample_in_words(args) {
        line("sample", sample);
    }
    line("model", choice::word(&fit.model).to_owned());
    line("misfit", format!("{:.3} % of the range (rms)", 100.0 * fit.relative_rms));
    line("", format!("{:<12}95 % interval", "value"));
    let symbol = if of.modulus == Modulus::Young { "E" } else { "G" };
    line(symbol, interval_in_words(of.of(fit.contact_modulus), "Pa"));
    if fit.model != ForceModel::Hertz {
        line("work", interval_in_words(fit.work, "J/m2"));
    }
    if let (Some(lambda), Some(range)) = (fit.lambda, fit.range) {
        line("lambda", interval_in_words(lambda, ""));
        line("range", interval_in_words(range, "m"));
    }
    line("touch", interval_in_words(fit.touch, "m"));
    line("baseline", interval_in_words(fit.baseline, "N"));
    line("tilt", interval_in_words(fit.tilt, "N/m"));
    if fit.model != ForceModel::Hertz {
        let [model, measured] = [fit.pull_off_force, fit.smallest_load].map(|x| quantity(x, "N"));
        line(
            "tension",
            format!("{measured} at most in the record; the model comes off at {model} under this control"),
        );
        let range = match (fit.lambda, args.curve.range) {
            (Some(lambda), _) if !lambda.determined => ", not determined by this record",
            (None, None) => ", with a range of 0.3 nm, usual between solids (--range)",
            _ => "",
        };
        line("Tabor", format!("{}{range}", quantity(fit.tabor, "")));
    }
    table.notes.iter().chain(&fit.notes).for_each(|note| line("note", note.clone()));
    text
}

/// The material under a `[[body]]`, and what else was found in remarks.
fn block(args: &FitIndentation, fit: &ForceFit, of: MaterialOf) -> String {
    let modulus = of.of(fit.contact_modulus);
    let measure = choice::word(&of.modulus);
    let name = args.record.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let mut text =
        format!("# From the force curve {name}, model {}; 95 % intervals.\n", choice::word(&fit.model));
    if fit.model != ForceModel::Hertz {
        text += &format!(
            "# Work of adhesion {:e} J/m2 ({:.3e} to {:.3e}).\n",
            fit.work.value, fit.work.low, fit.work.high
        );
    }
    text += &format!(
        "poisson = {:?}\nmaterial = {{ model = \"elastic\", {measure} = \"{:e} Pa\" }}  # {:.3e} to {:.3e} Pa\n",
        of.poisson, modulus.value, modulus.low, modulus.high
    );
    text
}

fn json_of(fit: &ForceFit, of: MaterialOf) -> Value {
    json!({
        "model": choice::word(&fit.model),
        "modulus": of.modulus,
        "poisson": of.poisson,
        choice::word(&of.modulus): interval(of.of(fit.contact_modulus)),
        "work": interval(fit.work),
        "transition": fit.lambda.map(interval),
        "range": fit.range.map(interval),
        "alpha": fit.alpha,
        "touch": interval(fit.touch),
        "baseline": interval(fit.baseline),
        "tilt": interval(fit.tilt),
        "confidence": 0.95,
        "pull_off_force": fit.pull_off_force,
        "smallest_load": fit.smallest_load,
        "tabor": fit.tabor,
        "contact_radius": fit.contact_radius,
        "rows": fit.rows.len(),
        "relative_rms": fit.relative_rms,
        "durbin_watson": fit.durbin_watson,
    })
}
