//! `asperity material`: functions of materials, and fits of measured curves.

mod layers;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use asperity::material::{FitOptions, Modulus, Shift};
use asperity_io::case::quantity::{MolarEnergy, Number, Temperature, TemperatureDifference, Time, range};
use asperity_io::case::{MaterialReport, Specimen, specimens};
use asperity_io::curve::{
    Column, Columns, Curves, Fitted, Kind, Request, Role, Series, ShiftRequest, angular_frequency,
};
use asperity_report::material as pictures;
use serde_json::{Value, json};

use crate::args::{Fit, Material, Show};
use crate::failure::Failure;
use crate::words::{counted, quantity};

/// Shows a material or fits one.
pub fn run(command: &Material) -> Result<(), Failure> {
    match command {
        Material::Show(show) if show.layers => layers::show(show),
        Material::Show(show) => self::show(show),
        Material::Fit(fit) => self::fit(fit),
    }
}

/// Longest table: twice the decades of doubles.
const MOST_DECADES: f64 = 60.0;

fn show(args: &Show) -> Result<(), Failure> {
    let given = [("--from", &args.from), ("--to", &args.to)].map(|(name, text)| {
        text.as_deref()
            .map(|text| parsed::<Time<range::Positive>>(name, text).map(|time| time.get()))
            .transpose()
    });
    let [from, to] = given;
    let (from, to) = (from?, to?);
    let asked = match (from, to) {
        (Some(from), Some(to)) if from >= to => {
            return Err(Failure::input(format!("--from is {from} s, but must be less than --to, {to} s")));
        }
        (Some(from), Some(to)) => Some([from, to]),
        _ => None,
    };
    let specimens = specimens(&args.file, &args.set, asked)?;
    let known = window(&specimens);
    let window = [from.unwrap_or(known[0]), to.unwrap_or(known[1])];
    let decades = (window[1] / window[0]).log10();
    if !(decades > 0.0 && decades <= MOST_DECADES) {
        let [first, last] = window;
        return Err(Failure::input(format!(
            "the times run from {first:e} s to {last:e} s, but must rise and span {MOST_DECADES} decades at most; \
             give --from and --to"
        )));
    }
    for specimen in &specimens {
        specimen.warnings.iter().for_each(|warning| crate::talk::say!("warning: {warning}"));
    }
    if let Some(path) = &args.plot {
        let materials: Vec<_> = specimens.iter().map(|s| (s.name.as_str(), &s.material)).collect();
        let title = args.file.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
        let figure = pictures::functions(&title, &materials, window).map_err(told)?;
        figure.write(path, args.force).map_err(told)?;
    }
    let tables = specimens.iter().map(|specimen| Table::of(specimen, window, args.per_decade));
    let tables = tables.collect::<Result<Vec<Table>, Failure>>()?;
    if args.json {
        let list: Vec<Value> =
            specimens.iter().zip(&tables).map(|(specimen, table)| table.json(specimen)).collect();
        return crate::print(&format!("{}\n", json!(list)));
    }
    let texts: Vec<String> =
        specimens.iter().zip(&tables).map(|(specimen, table)| table.text(specimen)).collect();
    crate::print(&texts.join("\n"))
}

/// One decade beyond all times of the materials; six decades about 1 s where they have none.
fn window(specimens: &[Specimen]) -> [f64; 2] {
    let times = specimens.iter().flat_map(|specimen| {
        let terms = specimen.material.creep().terms.iter().map(|term| term.retardation_time);
        let relaxation = specimen.material.relaxation().ok();
        let relaxing = relaxation.into_iter().flat_map(|r| r.terms).map(|term| term.relaxation_time);
        terms.chain(relaxing).collect::<Vec<f64>>()
    });
    let (mut first, mut last) = times.fold((f64::INFINITY, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
    if last == 0.0 {
        (first, last) = (1e-2, 1e2);
    }
    [10f64.powf((0.1 * first).log10().floor()), 10f64.powf((10.0 * last).log10().ceil())]
}

/// The functions of a material at times and frequencies.
struct Table {
    times: Vec<f64>,
    relaxation: Vec<f64>,
    creep: Vec<f64>,
    frequencies: Vec<f64>,
    storage: Vec<f64>,
    loss: Vec<f64>,
}

impl Table {
    fn of(specimen: &Specimen, [first, last]: [f64; 2], per_decade: u16) -> Result<Table, Failure> {
        let relaxation = specimen.material.relaxation().map_err(told)?;
        let steps = ((last / first).log10() * f64::from(per_decade) - 1e-9).ceil().max(1.0) as usize;
        let decade = |k: usize| k as f64 / f64::from(per_decade);
        let times: Vec<f64> =
            (0..=steps).map(|k| (first * 10f64.powf(decade(k))).min(last * (1.0 + 1e-12))).collect();
        let frequencies: Vec<f64> = times.iter().rev().map(|t| 1.0 / t).collect();
        let complex: Vec<(f64, f64)> = frequencies.iter().map(|w| relaxation.complex(*w)).collect();
        Ok(Table {
            relaxation: times.iter().map(|t| relaxation.value(*t)).collect(),
            creep: times.iter().map(|t| specimen.material.creep().value(*t)).collect(),
            storage: complex.iter().map(|c| c.0).collect(),
            loss: complex.iter().map(|c| c.1).collect(),
            times,
            frequencies,
        })
    }

    fn text(&self, specimen: &Specimen) -> String {
        let (name, modulus, compliance) = symbols(specimen.material.measure());
        let mut text = format!("{}: {}, {name}\n", specimen.name, specimen.report.model);
        source(&specimen.report).iter().for_each(|line| text += &format!("  {line}\n"));
        let _ = writeln!(
            text,
            "\n  {:>12} {:>14} {:>14}",
            "t [s]",
            format!("{modulus}(t) [Pa]"),
            format!("{compliance}(t) [1/Pa]")
        );
        let covered = specimen.report.window.unwrap_or([0.0, f64::INFINITY]);
        let mark = |t: f64| if t < covered[0] * 0.999 || t > covered[1] * 1.001 { " *" } else { "" };
        for ((t, relaxation), creep) in self.times.iter().zip(&self.relaxation).zip(&self.creep) {
            let _ = writeln!(text, "  {t:>12.4e} {relaxation:>14.6e} {creep:>14.6e}{}", mark(*t));
        }
        let _ = writeln!(
            text,
            "\n  {:>12} {:>14} {:>14} {:>12}",
            "ω [rad/s]",
            format!("{modulus}' [Pa]"),
            format!("{modulus}'' [Pa]"),
            "tan delta"
        );
        for ((w, storage), loss) in self.frequencies.iter().zip(&self.storage).zip(&self.loss) {
            let tan_delta = loss / storage;
            let _ = writeln!(
                text,
                "  {w:>12.4e} {storage:>14.6e} {loss:>14.6e} {tan_delta:>12.4e}{}",
                mark(1.0 / w)
            );
        }
        if self.times.iter().any(|t| !mark(*t).is_empty()) {
            let [first, last] = covered.map(|t| quantity(t, "s"));
            let _ = writeln!(
                text,
                "\n  * extrapolated: the terms stand for the material from {first} to {last} only"
            );
        }
        text
    }

    fn json(&self, specimen: &Specimen) -> Value {
        let material = &specimen.material;
        let creep = material.creep();
        let tan_delta: Vec<f64> =
            self.loss.iter().zip(&self.storage).map(|(loss, storage)| loss / storage).collect();
        json!({
            "name": specimen.name,
            "modulus": material.measure(),
            "report": specimen.report,
            "warnings": specimen.warnings,
            "creep_terms": creep.terms.iter().map(|t| json!([t.compliance, t.retardation_time])).collect::<Vec<_>>(),
            "instantaneous_compliance": creep.instantaneous,
            "fluidity": creep.fluidity,
            "time": self.times,
            "relaxation_modulus": self.relaxation,
            "creep_compliance": self.creep,
            "angular_frequency": self.frequencies,
            "storage_modulus": self.storage,
            "loss_modulus": self.loss,
            "tan_delta": tan_delta,
        })
    }
}

fn symbols(measure: Modulus) -> (&'static str, &'static str, &'static str) {
    match measure {
        Modulus::Young => ("Young's modulus", "E", "D"),
        Modulus::Shear => ("shear modulus", "G", "J"),
    }
}

/// Where a material comes from and how well it is known, in lines.
pub fn source(report: &MaterialReport) -> Vec<String> {
    let mut lines = Vec::new();
    let times = |[first, last]: [f64; 2]| format!("{} to {}", quantity(first, "s"), quantity(last, "s"));
    if let (Some(error), Some(window)) = (report.error, report.window) {
        lines.push(format!(
            "Prony sum of {}, relative error {error:.1e} at most from {}; an extrapolation at other times, t = 0+ among them",
            counted(report.terms, "term"),
            times(window)
        ));
    }
    if let (Some(max), Some(rms), Some(window)) = (report.max_misfit, report.rms_misfit, report.window) {
        let file = report.file.as_deref().unwrap_or_default();
        lines.push(format!(
            "fit of {file}: {}, {}, misfit {:.2} % rms and {:.2} % at most, data from {}",
            counted(report.points.unwrap_or(0), "point"),
            counted(report.terms, "term"),
            100.0 * rms,
            100.0 * max,
            times(window)
        ));
    }
    if report.temperatures.len() > 1 {
        let of =
            |fold: fn(f64, f64) -> f64, start: f64| report.temperatures.iter().copied().fold(start, fold);
        lines.push(format!(
            "master curve of {} temperatures from {:.1} °C to {:.1} °C",
            report.temperatures.len(),
            of(f64::min, f64::INFINITY) - 273.15,
            of(f64::max, 0.0) - 273.15
        ));
    }
    lines.extend(report.shift.as_ref().map(|law| format!("shift: {law}")));
    lines.extend(
        report
            .shift_factor
            .map(|factor| format!("shift factor a_T = {factor:.4e}: all times are multiplied by it")),
    );
    lines.extend(report.notes.iter().map(|note| format!("note: {note}")));
    lines
}

fn fit(args: &Fit) -> Result<(), Failure> {
    let kind = match args.kind {
        Some(kind) => kind,
        None => Curves::kind_of(&args.data).map_err(told)?.ok_or_else(|| {
            let path = args.data.display();
            Failure::input(format!(
                "{path}: the header does not state what was measured; give --kind relaxation, creep or dma"
            ))
        })?,
    };
    let columns = columns(&args.column, &args.unit)?;
    let mut request = Request {
        shift: shift(args)?,
        window: args.window.as_deref().map(|text| ends(kind, text)).transpose()?,
        options: options(args),
        ..Request::default()
    };
    // What cannot be written is said before the work.
    for path in args.output.iter().chain(&args.plot) {
        super::free(path, args.force)?;
    }
    let mut curves = Curves::read(&args.data, kind, &columns).map_err(told)?;
    request.measure = args.modulus.or(curves.measure).unwrap_or_else(|| {
        let note = "the header does not say which: taken as Young's moduli; --modulus shear takes them as shear moduli";
        curves.notes.push(note.to_owned());
        Modulus::Young
    });
    let fitted = request.fit(&curves).map_err(told)?;
    let (name, of) = (args.data.display().to_string(), fitted.misfit);
    let findings = Vec::from_iter(asperity::finding::misfit(&name, of.rms, of.max, fitted.noise));
    let block = fitted.to_toml(&curves);
    if let Some(path) = &args.output {
        write(path, &block, args.force)?;
    }
    if let Some(path) = &args.plot {
        let title = args.data.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        let figure = pictures::fit(&title, &curves, &fitted).map_err(told)?;
        figure.write(path, args.force).map_err(told)?;
    }
    if args.json {
        let mut object = json_of(&curves, &fitted);
        object["output"] = json!(args.output);
        object["material"] = json!(block);
        object["findings"] = asperity_io::finding::list(&findings);
        return crate::print(&format!("{object}\n"));
    }
    super::findings::tell(&findings);
    let mut text = report(args, &curves, &fitted);
    match &args.output {
        Some(path) => {
            let _ = writeln!(text, "written     {}", path.display());
        }
        None => text = format!("{text}\n{block}"),
    }
    crate::print(&text)
}

fn options(args: &Fit) -> FitOptions {
    let default = FitOptions::default();
    FitOptions {
        per_decade: args.per_decade.unwrap_or(default.per_decade),
        margin: args.margin.unwrap_or(default.margin),
        limit: args.max_misfit.unwrap_or(default.limit),
        max_terms: args.max_terms.unwrap_or(default.max_terms),
        long_time: args.long_time,
    }
}

/// The columns and units that are told.
pub(super) fn columns(columns: &[String], units: &[String]) -> Result<Columns, Failure> {
    let column = |text: String| text.parse().map_or_else(|_| Column::Name(text), Column::Number);
    let columns = pairs("--column", columns)?.into_iter().map(|(role, text)| (role, column(text))).collect();
    Ok(Columns { columns, units: pairs("--unit", units)? })
}

/// "frequency=1", "storage=E' [MPa]".
fn pairs(option: &str, texts: &[String]) -> Result<BTreeMap<Role, String>, Failure> {
    let pair = |text: &String| {
        let (role, value) = text.split_once('=').ok_or_else(|| {
            Failure::input(format!("{option} is \"{text}\", but must be QUANTITY=..., e.g. {option} time=1"))
        })?;
        let role =
            role.trim().parse::<Role>().map_err(|error| Failure::input(format!("{option}: {error}")))?;
        Ok((role, value.trim().to_owned()))
    };
    texts.iter().map(pair).collect()
}

fn shift(args: &Fit) -> Result<ShiftRequest, Failure> {
    if let Some(text) = &args.wlf {
        let [c1, c2, reference] =
            split(text, "--wlf", "c1, c2 and the reference, e.g. --wlf '8.86, 101.6 K, 20 °C'")?;
        let shift = Shift::Wlf {
            c1: parsed::<Number<range::Positive>>("c1 of --wlf", c1)?.get(),
            c2: parsed::<TemperatureDifference<range::Positive>>("c2 of --wlf", c2)?.get(),
            reference: parsed::<Temperature>("reference of --wlf", reference)?.get(),
        };
        return Ok(ShiftRequest::Given(shift));
    }
    if let Some(text) = &args.arrhenius {
        let wanted = "the energy and the reference, e.g. --arrhenius '120 kJ/mol, 20 °C'";
        let [energy, reference] = split(text, "--arrhenius", wanted)?;
        let shift = Shift::Arrhenius {
            activation_energy: parsed::<MolarEnergy<range::Positive>>("energy of --arrhenius", energy)?.get(),
            reference: parsed::<Temperature>("reference of --arrhenius", reference)?.get(),
        };
        return Ok(ShiftRequest::Given(shift));
    }
    match &args.estimate_shift {
        Some(text) => Ok(ShiftRequest::Estimate(parsed::<Temperature>("--estimate-shift", text)?.get())),
        None => Ok(ShiftRequest::None),
    }
}

/// "0.1 s, 100 s" or "0.1 Hz, 100 Hz" in s or rad/s.
fn ends(kind: Kind, text: &str) -> Result<[f64; 2], Failure> {
    let wanted = "two times or, of a dma, two frequencies, e.g. --window '0.1 s, 100 s'";
    let ends = split::<2>(text, "--window", wanted)?.map(|end| match kind {
        Kind::Dma => angular_frequency(end).map_err(|error| told(format!("--window: {end} must be {error}"))),
        _ => parsed::<Time<range::Positive>>("--window", end).map(|time| time.get()),
    });
    let [first, last] = ends;
    let (first, last) = (first?, last?);
    match first < last {
        true => Ok([first, last]),
        false => Err(Failure::input(format!(
            "--window is \"{text}\": the second end must be greater than the first"
        ))),
    }
}

fn split<'t, const N: usize>(text: &'t str, option: &str, wanted: &str) -> Result<[&'t str; N], Failure> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    <[&str; N]>::try_from(parts)
        .map_err(|_| Failure::input(format!("{option} is \"{text}\", but must be {wanted}")))
}

pub(super) fn parsed<T: std::str::FromStr>(what: &str, text: &str) -> Result<T, Failure>
where
    T::Err: std::fmt::Display,
{
    text.parse().map_err(|error| Failure::input(format!("{what} is \"{text}\", but must be {error}")))
}

pub(super) fn told(error: impl std::fmt::Display) -> Failure {
    Failure::input(error.to_string())
}

pub(super) fn write(path: &Path, text: &str, force: bool) -> Result<(), Failure> {
    let mut options = std::fs::OpenOptions::new();
    match force {
        true => options.write(true).create(true).truncate(true),
        false => options.write(true).create_new(true),
    };
    let written = options.open(path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| Failure::input(format!("cannot write {}: {error}", path.display())))
}

fn report(args: &Fit, curves: &Curves, fitted: &Fitted) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| text += &format!("{name:<12}{value}\n");
    let (modulus, ..) = symbols(fitted.material.measure());
    line("data", format!("{} ({}, {modulus})", args.data.display(), curves.kind.name()));
    line("points", format!("{} fitted of {}", fitted.data.x.len(), curves.points()));
    if !fitted.temperatures.is_empty() {
        let shown: Vec<String> = fitted.temperatures.iter().map(|t| format!("{:.1}", t - 273.15)).collect();
        line("sweeps", format!("{} °C", shown.join(", ")));
    }
    if let Some(shift) = &fitted.shift {
        let rms =
            fitted.shift_rms.map_or(String::new(), |rms| format!(", {rms:.3} decades from the overlaps"));
        let law = match shift {
            Shift::Wlf { c1, c2, reference } => {
                format!("WLF c1 = {c1:.4}, c2 = {c2:.4} K about {:.2} °C", reference - 273.15)
            }
            Shift::Arrhenius { activation_energy, reference } => {
                format!("Arrhenius {:.3} kJ/mol about {:.2} °C", 1e-3 * activation_energy, reference - 273.15)
            }
            Shift::Table { points } => format!("{} shift factors", points.len()),
        };
        line("shift", format!("{law}{rms}"));
    }
    let [first, last] = fitted.window;
    line("times", format!("{first:.3e} s to {last:.3e} s"));
    line("terms", fitted.terms().to_string());
    line(
        "misfit",
        format!(
            "{:.3} % rms, {:.3} % at most (at {:.3e} {})",
            100.0 * fitted.misfit.rms,
            100.0 * fitted.misfit.max,
            fitted.misfit.worst,
            if curves.kind == Kind::Dma { "rad/s" } else { "s" }
        ),
    );
    line("scatter", format!("{:.3} % of the data", 100.0 * fitted.noise));
    fitted.notes.iter().for_each(|note| line("note", note.clone()));
    text
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
        "noise": fitted.noise,
        "uncertainty": fitted.uncertainty,
        "notes": fitted.notes,
    })
}
