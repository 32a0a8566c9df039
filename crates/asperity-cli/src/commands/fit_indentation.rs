//! `asperity fit-indentation`: the material of a body from a measured indentation.

use std::fmt::Write as _;

use asperity::indentation::{
    Given, IndentationFit, IndentationOptions, IndentationRecord, Interval, fit_indentation,
};
use asperity::material::Modulus;
use asperity::reference::MdrProfile;
use asperity_io::case::quantity::{Length, Number, range};
use asperity_io::curve::{Indentation, MaterialOf, indentation_block};
use asperity_report::material::indentation as picture;
use serde_json::{Value, json};

use super::material::{columns, parsed, told, write};
use crate::args::FitIndentation;
use crate::failure::Failure;
use crate::words::quantity;

/// Fits a record.
pub fn run(args: &FitIndentation) -> Result<(), Failure> {
    let profile = match (&args.radius, &args.cone) {
        (_, Some(slope)) => {
            MdrProfile::Cone { slope: parsed::<Number<range::Positive>>("--cone", slope)?.get() }
        }
        (Some(radius), None) => {
            MdrProfile::Sphere { radius: parsed::<Length<range::Positive>>("--radius", radius)?.get() }
        }
        (None, None) => return Err(Failure::input("--radius or --cone is needed".to_owned())),
    };
    let poisson = parsed::<Number>("--poisson", &args.poisson)?.get();
    if !(poisson > -1.0 && poisson <= 0.5) {
        let message = format!("--poisson is {poisson}, but must be greater than -1 and not greater than 0.5");
        return Err(Failure::input(message));
    }
    let of = MaterialOf { modulus: args.modulus, poisson };
    let columns = columns(&args.column, &args.unit)?;
    let options = IndentationOptions {
        given: args.given,
        terms: args.terms,
        long_time: args.long_time,
        fit_touch: args.fit_touch,
        ..IndentationOptions::default()
    };
    // What cannot be written is said before the work.
    for path in args.output.iter().chain(&args.plot) {
        super::free(path, args.force)?;
    }
    let record = Indentation::read(&args.record, &columns).map_err(told)?;
    let taken = IndentationRecord { times: &record.times, loads: &record.loads, depths: &record.depths };
    let fit = fit_indentation(profile, &taken, &options)
        .map_err(|error| Failure::input(format!("{}: {error}", args.record.display())))?;
    let block = indentation_block(&record, &fit, of);
    if let Some(path) = &args.output {
        write(path, &block, args.force)?;
    }
    if let Some(path) = &args.plot {
        let title = args.record.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        picture(&title, &record, &fit).write(path, args.force).map_err(told)?;
    }
    if args.json {
        let mut object = json_of(&fit, of);
        object["notes"] = json!(record.notes);
        object["output"] = json!(args.output);
        object["material"] = json!(block);
        return crate::print(&format!("{object}\n"));
    }
    let mut text = report(args, &record, &fit, of);
    match &args.output {
        Some(path) => {
            let _ = writeln!(text, "written     {}", path.display());
        }
        None => text = format!("{text}\n{block}"),
    }
    crate::print(&text)
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
    let every = if fit.rows.len() < rows { format!(" of {rows}") } else { String::new() };
    line("rows", format!("{}{every}", fit.rows.len()));
    line("given", format!("{taken}; the {fitted} is fitted"));
    let [step, length] = fit.window;
    line("times", format!("steps from {}, {} in all", quantity(step, "s"), quantity(length, "s")));
    line(
        "misfit",
        format!("{} rms, {:.3} % of the largest {fitted}", quantity(fit.rms, unit), 100.0 * fit.relative_rms),
    );
    let symbol = if of.modulus == Modulus::Young { "E" } else { "G" };
    let pascal = |x: Interval| {
        let x = of.of(x);
        let [value, low, high] = [x.value, x.low, x.high].map(|p| quantity(p, "Pa"));
        format!("{value:<12}{low} to {high}")
    };
    line("", format!("{:<12}95 % confidence", "value"));
    line(&format!("{symbol}(0)"), pascal(fit.instantaneous));
    if fit.equilibrium.value > 0.0 {
        line(&format!("{symbol}(inf)"), pascal(fit.equilibrium));
    } else {
        line(&format!("{symbol}(inf)"), "0 (a fluid over the record)".to_owned());
    }
    for (k, [modulus, time]) in fit.terms.iter().enumerate() {
        line(&format!("{symbol}_{}", k + 1), pascal(*modulus));
        let [value, low, high] = [time.value, time.low, time.high].map(|t| quantity(t, "s"));
        line(&format!("tau_{}", k + 1), format!("{value:<12}{low} to {high}"));
    }
    if args.fit_touch {
        let [value, low, high] = [fit.touch.value, fit.touch.low, fit.touch.high].map(|d| quantity(d, "m"));
        line("touch", format!("{value:<12}{low} to {high}"));
    }
    record.notes.iter().for_each(|note| line("note", note.clone()));
    if fit.durbin_watson < 1.5 {
        line(
            "note",
            format!(
                "the residuals follow each other (Durbin-Watson {:.2}, 2 where they are independent): the intervals are \
                 too narrow",
                fit.durbin_watson
            ),
        );
    }
    for (k, [_, time]) in fit.terms.iter().enumerate() {
        if time.value < step || time.value > length {
            line("note", format!("tau_{} lies outside of the times of the record", k + 1));
        }
    }
    text
}

fn json_of(fit: &IndentationFit, of: MaterialOf) -> Value {
    let interval = |x: Interval| json!([x.value, x.low, x.high]);
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
        "rms": fit.rms,
        "relative_rms": fit.relative_rms,
        "durbin_watson": fit.durbin_watson,
    })
}
