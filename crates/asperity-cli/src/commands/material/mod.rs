//! `asperity material`: functions of materials, and fits of measured curves.

mod deliver;
mod export;
mod fit;
mod layers;
mod measured;
mod options;

use std::f64::consts::TAU;

use asperity::material::{Modulus, Relaxation, Shift};
use asperity_io::case::{MaterialReport, Specimen, specimens};
use asperity_io::quantity::Time;
use asperity_report::material as pictures;
use serde_json::{Value, json};

use crate::args::Show;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::format::{counted, quantity};
use crate::verb::Verb;
pub(super) use fit::{ROOM, estimated_unless_known};
pub(super) use options::{columns, refused};

impl Verb for Show {
    fn files(&self) -> Files {
        Files::default().reads([&self.file]).draws(&self.plot).force(self.force)
    }

    /// Prints what a material does, or what a file of measured data holds.
    fn run(&self) -> Result<(), Failure> {
        match self {
            show if show.layers => layers::show(show),
            show if measured::is_data(&show.file) => measured::show(show),
            show => self::show(show),
        }
    }
}

/// Longest table: twice the decades of doubles.
const MOST_DECADES: f64 = 60.0;

fn show(args: &Show) -> Result<(), Failure> {
    let [from, to] = [args.from, args.to].map(|time| time.map(Time::get));
    let asked = match (from, to) {
        (Some(from), Some(to)) if from >= to => {
            refuse!("--from is {from} s, but must be less than --to, {to} s");
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
        refuse!(
            "the times run from {first:e} s to {last:e} s, but must rise and span {MOST_DECADES} decades at most; \
             give --from and --to"
        );
    }
    for specimen in &specimens {
        specimen.warnings.iter().for_each(|warning| crate::messages::message!("warning: {warning}"));
    }
    if let Some(path) = &args.plot {
        let materials: Vec<_> = specimens.iter().map(|s| (s.name.as_str(), &s.material)).collect();
        let title = args.file.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
        let drawn = if from.is_none() && to.is_none() { covered(&specimens, window) } else { window };
        let figure = pictures::functions(&title, &materials, drawn)?;
        let shifts: Vec<pictures::Factors> = specimens.iter().filter_map(shift_of).collect();
        let figure =
            pictures::shift_factors(&shifts).into_iter().fold(figure, |figure, panel| figure.with(panel));
        let beyond = specimens.iter().filter_map(|specimen| extrapolated(specimen, drawn));
        let words: Vec<String> = specimens.iter().filter_map(temperature_of).chain(beyond).collect();
        crate::commands::picture::write(&figure.caption(words.join(" ")), path, args.force)?;
    }
    let tables = specimens.iter().map(|specimen| Table::of(specimen, window, args.per_decade));
    let tables = tables.collect::<Result<Vec<Table>, Failure>>()?;
    if args.json {
        return crate::print(&format!("{}\n", tables.iter().map(Table::json).collect::<Value>()));
    }
    crate::print(&tables.iter().map(Table::text).collect::<Vec<_>>().join("\n"))
}

/// The shift of a material with the temperatures of its measurement.
fn shift_of(specimen: &Specimen) -> Option<pictures::Factors<'_>> {
    let MaterialReport { law, temperatures, .. } = &specimen.report;
    Some(pictures::Factors { name: &specimen.name, law: law.as_ref()?, found: &[], temperatures })
}

/// At which temperature a material is shown, for captions; `None` where it does not depend on it.
fn temperature_of(specimen: &Specimen) -> Option<String> {
    let reference = specimen.report.law.as_ref()?.reference()?;
    let (name, celsius) = (&specimen.name, format!("{:.1} °C", reference - 273.15));
    Some(match specimen.report.shift_factor {
        Some(factor) if factor != 1.0 => {
            let factor = crate::format::quantity(factor, "");
            format!("{name}: at its own temperature, a_T = {factor} of the reference {celsius}.")
        }
        _ => format!("{name}: at the reference temperature, {celsius}."),
    })
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

/// The times of a window for which some material stands; all of it where one stands for any time.
fn covered(specimens: &[Specimen], window: [f64; 2]) -> [f64; 2] {
    let stands = specimens.iter().map(|specimen| specimen.report.window.unwrap_or([0.0, f64::INFINITY]));
    let [first, last] = stands.fold([f64::INFINITY, 0.0_f64], |[a, b], [from, to]| [a.min(from), b.max(to)]);
    let inside = [window[0].max(first), window[1].min(last)];
    if inside[0] < inside[1] { inside } else { window }
}

/// Says that the drawn times go beyond those for which a material stands.
fn extrapolated(specimen: &Specimen, drawn: [f64; 2]) -> Option<String> {
    let stands = specimen.report.window?;
    let is_beyond = drawn[0] < stands[0] * 0.999 || drawn[1] > stands[1] * 1.001;
    let [first, last] = stands.map(|t| quantity(t, "s"));
    is_beyond.then(|| {
        format!(
            "{}: extrapolated before {first} and after {last}, and at the frequencies beyond one over these.",
            specimen.name
        )
    })
}

/// The functions of a material at times, and at frequencies of one over these times.
struct Table<'a> {
    specimen: &'a Specimen,
    relaxation: Relaxation,
    times: Vec<f64>,
}

impl<'a> Table<'a> {
    fn of(specimen: &'a Specimen, [first, last]: [f64; 2], per_decade: u16) -> Result<Table<'a>, Failure> {
        let steps = ((last / first).log10() * f64::from(per_decade) - 1e-9).ceil().max(1.0) as usize;
        let decade = |k: usize| k as f64 / f64::from(per_decade);
        let times = (0..=steps).map(|k| (first * 10f64.powf(decade(k))).min(last * (1.0 + 1e-12)));
        Ok(Table { specimen, relaxation: specimen.material.relaxation()?, times: times.collect() })
    }

    /// Frequency, storage and loss modulus.
    fn dynamic(&self) -> impl Iterator<Item = [f64; 3]> {
        let frequencies = self.times.iter().rev().map(|time| 1.0 / time);
        frequencies.map(|frequency| {
            let (storage, loss) = self.relaxation.complex(frequency);
            [frequency, storage, loss]
        })
    }

    fn text(&self) -> String {
        let specimen = self.specimen;
        let (name, modulus, compliance) = symbols(specimen.material.measure());
        let mut text = format!("{}: {}, {name}\n", specimen.name, specimen.report.model);
        source(&specimen.report).iter().for_each(|line| text += &format!("  {line}\n"));
        text += &format!(
            "\n  {:>12} {:>14} {:>14}\n",
            "t [s]",
            format!("{modulus}(t) [Pa]"),
            format!("{compliance}(t) [1/Pa]")
        );
        let covered = specimen.report.window.unwrap_or([0.0, f64::INFINITY]);
        let mark = |t: f64| if t < covered[0] * 0.999 || t > covered[1] * 1.001 { " *" } else { "" };
        for t in &self.times {
            let (relaxation, creep) = (self.relaxation.value(*t), specimen.material.creep().value(*t));
            text += &format!("  {t:>12.4e} {relaxation:>14.6e} {creep:>14.6e}{}\n", mark(*t));
        }
        text += &format!(
            "\n  {:>12} {:>12} {:>14} {:>14} {:>12}\n",
            "ω [rad/s]",
            "f [Hz]",
            format!("{modulus}' [Pa]"),
            format!("{modulus}'' [Pa]"),
            "tan delta"
        );
        for [w, storage, loss] in self.dynamic() {
            let (hertz, tan_delta) = (w / TAU, loss / storage);
            text += &format!(
                "  {w:>12.4e} {hertz:>12.4e} {storage:>14.6e} {loss:>14.6e} {tan_delta:>12.4e}{}\n",
                mark(1.0 / w)
            );
        }
        if self.times.iter().any(|t| !mark(*t).is_empty()) {
            let [first, last] = covered.map(|t| quantity(t, "s"));
            text += &format!(
                "\n  * extrapolated: the terms stand for the material from {first} to {last} only\n"
            );
        }
        text
    }

    fn json(&self) -> Value {
        let specimen = self.specimen;
        let (material, creep) = (&specimen.material, specimen.material.creep());
        let over_time =
            |of: &dyn Fn(f64) -> f64| self.times.iter().map(|time| of(*time)).collect::<Vec<f64>>();
        let column = |of: fn([f64; 3]) -> f64| self.dynamic().map(of).collect::<Vec<f64>>();
        json!({
            "name": specimen.name,
            "modulus": material.measure(),
            "report": specimen.report,
            "warnings": specimen.warnings,
            "creep_terms": creep.terms.iter().map(|t| json!([t.compliance, t.retardation_time])).collect::<Vec<_>>(),
            "instantaneous_compliance": creep.instantaneous,
            "fluidity": creep.fluidity,
            "time": self.times,
            "relaxation_modulus": over_time(&|time| self.relaxation.value(time)),
            "creep_compliance": over_time(&|time| creep.value(time)),
            "angular_frequency": column(|[frequency, ..]| frequency),
            "storage_modulus": column(|[_, storage, _]| storage),
            "loss_modulus": column(|[.., loss]| loss),
            "tan_delta": column(|[_, storage, loss]| loss / storage),
        })
    }
}

fn symbols(measure: Modulus) -> (&'static str, &'static str, &'static str) {
    match measure {
        Modulus::Young => ("Young's modulus", "E", "D"),
        Modulus::Shear => ("shear modulus", "G", "J"),
    }
}

/// "; storage 1.4 % rms, 4.8 % at most; loss ..." where a fit has several columns.
fn columns_of(report: &MaterialReport) -> String {
    let one = |(name, [rms, max]): &(String, [f64; 2])| {
        format!("; {name} {:.2} % rms, {:.2} % at most", 100.0 * rms, 100.0 * max)
    };
    match report.columns.len() {
        0 | 1 => String::new(),
        _ => report.columns.iter().map(one).collect(),
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
            "fit of {file}: {}, {}, misfit {:.2} % rms and {:.2} % at most, data from {}{}",
            counted(report.points.unwrap_or(0), "point"),
            counted(report.terms, "term"),
            100.0 * rms,
            100.0 * max,
            times(window),
            columns_of(report)
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
    lines.extend(report.vertical.as_ref().map(|law| {
        let at = report
            .vertical_factor
            .map_or(String::new(), |b| format!("; b_T = {b:.4}: all moduli are divided by it"));
        format!("vertical shift: {law}{at}")
    }));
    lines.extend(report.notes.iter().map(|note| format!("note: {note}")));
    lines
}

/// The law in words.
fn law(shift: &Shift) -> String {
    match shift {
        Shift::Wlf { c1, c2, reference } => {
            format!("WLF c1 = {c1:.4}, c2 = {c2:.4} K about {:.2} °C", reference - 273.15)
        }
        Shift::Arrhenius { activation_energy, reference } => {
            format!("Arrhenius {:.3} kJ/mol about {:.2} °C", 1e-3 * activation_energy, reference - 273.15)
        }
        Shift::Table { points } => {
            let celsius = |point: Option<&(f64, f64)>| point.map_or(0.0, |point| point.0 - 273.15);
            let [first, last] = [points.first(), points.last()].map(celsius);
            format!("{} shift factors from {first:.1} °C to {last:.1} °C", points.len())
        }
    }
}

/// A temperature of a sweep \[°C\] to a tenth, and no -0.
fn celsius(kelvin: f64) -> f64 {
    (10.0 * (kelvin - 273.15)).round() / 10.0 + 0.0
}
