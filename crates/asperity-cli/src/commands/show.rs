//! `asperity show`: a result in the terminal.

use asperity::quantities::Quantity;
use asperity::sliding::Friction;
use asperity::step::Row;
use asperity::{Axis, Grid};
use asperity_io::answer::{self, Answer, Units};
use asperity_io::cycles;
use asperity_io::store::{At, Reader, StoreError};
use asperity_report::result::{contact, moment, temperatures, with_contact};
use serde_json::json;

use super::answers::line;
use super::instant;
use crate::args::ShowResult;
use crate::failure::Failure;
use crate::format::{bytes, duration, extent, mean_gap, pressures, quantity};
use crate::terminal::{shares, sparkline};
use crate::verb::Verb;

/// Letters of the map and of the curves.
const COLUMNS: usize = 56;
const SPARKS: usize = 40;

impl Verb for ShowResult {
    /// Prints the summary.
    fn run(&self) -> Result<(), Failure> {
        let reader = Reader::open(&self.result)?;
        let at = instant(&reader, self.time.as_deref())?;
        let units = super::answers::units_of(&self.unit, std::slice::from_ref(&reader))?;
        let answers = answer::of(&reader, &units)?;
        units.check(&answers).map_err(|error| Failure::input(error.to_string()))?;
        crate::print(&if self.json {
            object(&reader, &answers)?
        } else {
            text(&reader, at, &answers, &units)?
        })
    }
}

fn object(reader: &Reader, answers: &[Answer]) -> Result<String, StoreError> {
    let work = reader.work();
    let mut last = serde_json::Map::new();
    for scalar in reader.scalars() {
        last.insert(scalar.name.into(), json!(reader.series(scalar.name)?.last()));
    }
    let object = json!({
        "answers": answers,
        "error_bars": super::answers::bars(answers, &reader.error_bars()),
        "title": reader.header().title,
        "status": reader.status().as_str(),
        "lacks_leakage": reader.lacks_leakage(),
        "message": work.message,
        "rows": reader.len(),
        "rows_expected": reader.header().rows_expected,
        "fields": reader.header().fields.iter().map(|kind| kind.name()).collect::<Vec<_>>(),
        "field_times": reader.field_times(),
        "wall_s": work.wall_s,
        "convolutions": work.convolutions,
        "iterations": work.iterations,
        "last": last,
        "findings": asperity_io::finding::list(reader.findings()),
        "cycles": cycles::of_result(reader)?.iter().map(cycles_json).collect::<Vec<_>>(),
    });
    Ok(format!("{object}\n"))
}

/// The cycles of a stage, SI.
fn cycles_json(part: &cycles::Cyclic) -> serde_json::Value {
    let cycle = |cycle: &asperity::cycles::Cycle| {
        json!({
            "start": cycle.span[0],
            "end": cycle.span[1],
            "dissipated_energy": cycle.dissipated_energy,
            "stiffness": cycle.stiffness,
            "loss_angle": cycle.loss_angle,
            "drift_work": cycle.drift_work,
        })
    };
    let list: Vec<_> = part.cycles.iter().map(cycle).collect();
    json!({ "stage": part.stage, "frequency": part.frequency, "cycles": list })
}

/// "256 x 256 cells, 1 mm x 1 mm", or "a line of 256 cells, 1 mm".
fn domain(grid: &Grid) -> String {
    let ([nx, ny], [lx, ly]) = (grid.cells(), grid.size());
    match grid.is_line() {
        true => format!("a line of {nx} cells, {}", quantity(lx, "m")),
        false => format!("{nx} x {ny} cells, {} x {}", quantity(lx, "m"), quantity(ly, "m")),
    }
}

fn text(reader: &Reader, at: At, answers: &[Answer], units: &Units) -> Result<String, StoreError> {
    let rows = reader.rows()?;
    let mut text = state(reader);
    if rows.is_empty() {
        return Ok(text);
    }
    let lines = super::answers::lines(answers, &reader.error_bars(), units);
    text.extend(lines.iter().map(|[name, value]| line(name, value)));
    text.extend(
        super::answers::row(answers, units, &reader.header().grid, rows.last(), rows.len())
            .map(|row| line("of the row at", row)),
    );
    text.push('\n');
    text += &course(reader, &rows, units)?;
    text += &work(reader, &rows);
    text += &cycle_table(reader)?;
    let at = with_contact(reader, at)?;
    if let Some(states) = contact(reader, at)? {
        let time = reader.field_times()[reader.index(at)?];
        let size = reader.header().grid.size();
        text += &format!("\ncontact at {}\n", moment(reader, time));
        text += &shares(states.mapv(|state| state > 0).view(), COLUMNS, size[1] / size[0]);
    }
    Ok(text)
}

/// Title, status, findings and domain.
fn state(reader: &Reader) -> String {
    let header = reader.header();
    let mut text = String::new();
    if !header.title.is_empty() {
        text += &format!("{}\n\n", header.title);
    }
    let of = header.rows_expected.map_or(String::new(), |total| format!(" of {total}"));
    text += &line("status", format!("{}, {}{of} rows", reader.state(), reader.len()));
    if let Some(message) = &reader.work().message {
        text += &line("", message);
    }
    if let Some(kept) = reader.replaces() {
        text += &line("", format!("the complete result that it replaces is kept in {}", kept.display()));
    }
    for finding in reader.findings() {
        text += &line(finding.severity.as_str(), format!("{} [{}]", finding.text, finding.code));
    }
    let boundary = header.boundary().map_or(String::new(), |words| format!(", {words}"));
    text += &line("domain", domain(&header.grid) + &boundary);
    if let Some(temperatures) = temperatures(reader) {
        text += &line("temperature", temperatures);
    }
    text
}

/// The last value of each quantity, with its curve over time or velocity.
fn course(reader: &Reader, rows: &[Row], units: &Units) -> Result<String, StoreError> {
    let Some(last) = rows.last() else { return Ok(String::new()) };
    let header = reader.header();
    let grid = &header.grid;
    let force = grid.units("N");
    let times: Vec<f64> = rows.iter().map(|row| row.coordinate.value()).collect();
    let bars = |values: &[f64]| sparkline(header.axis(), &times, values, SPARKS);
    let curve = |name: &str, value: fn(&Row) -> f64, words: &dyn Fn(f64) -> String| {
        let values: Vec<f64> = rows.iter().map(value).collect();
        let [low, high] = extent(values.iter().copied()).map(words);
        match low == high {
            true => line(name, format!("{low}, constant")),
            false => line(name, format!("{:<14}{}  {low} to {high}", words(value(last)), bars(&values))),
        }
    };
    let axis = header.axis();
    let [first, end] = [&rows[0], last].map(|row| units.number(row.coordinate.value(), axis.unit()));
    let mut text = match axis {
        Axis::Velocity => line(axis.name(), format!("{first} to {end}")),
        Axis::Time | Axis::None => line(axis.name(), end),
    };
    let mu: Vec<f64> = reader.frictions()?.iter().map(Friction::of_all).collect();
    if !mu.is_empty() {
        let [low, high] = extent(mu.iter().copied());
        let last = mu.last().copied().unwrap_or(f64::NAN);
        text += &line("friction", format!("{last:<14.4}{}  {low:.4} to {high:.4}", bars(&mu)));
    }
    let percent = |share: f64| format!("{:.3} %", 100.0 * share);
    text += &curve("load", |row| row.load, &|v| quantity(v, force));
    text += &curve("approach", |row| row.approach, &|v| quantity(v, "m"));
    text += &curve("contact", |row| row.contact_fraction, &percent);
    text += &curve("mean gap", mean_gap, &|v| quantity(v, "m"));
    let in_contact = reader.contact_pressures()?.last().copied().unwrap_or(f64::NAN);
    text += &line("pressure", pressures(last, in_contact));
    let asked = reader.scalars().into_iter().filter(|s| {
        let coordinate = axis == Axis::Velocity && s.name == Quantity::Velocity.name();
        Quantity::from_name(s.name).is_some() && !coordinate
    });
    for series in asked {
        let values = reader.series(series.name)?;
        let value = values.last().copied().unwrap_or(f64::NAN);
        let words = match series.units {
            "1" if series.name == Quantity::FrictionUncertainty.name() => percent(value),
            "1" => quantity(value, ""),
            units => quantity(value, units),
        };
        text += &line(series.name, words);
    }
    Ok(text)
}

/// What the numbers cost, how well they hold, and which fields are stored.
fn work(reader: &Reader, rows: &[Row]) -> String {
    let header = reader.header();
    let worst = rows.iter().map(|row| row.certificate).fold(0.0, f64::max);
    let work = reader.work();
    let memory = work.peak_memory_bytes.map_or(String::new(), |b| format!(", {}", bytes(b as f64)));
    let per_row = work.convolutions as f64 / rows.len().max(1) as f64;
    let kept: Vec<_> = header.fields.iter().map(|kind| kind.name()).collect();
    let instants = header.axis().plural();
    [
        line("certificate", format!("{worst:.1e} at worst (relative error of the pressure)")),
        line(
            "work",
            format!(
                "{} iterations, {} convolutions ({per_row:.1} per row) in {}{memory}",
                work.iterations,
                work.convolutions,
                duration(work.wall_s)
            ),
        ),
        line("fields", format!("{} at {} {instants}", kept.join(", "), reader.field_times().len())),
    ]
    .concat()
}

/// The cycles of each stage with a sine.
fn cycle_table(reader: &Reader) -> Result<String, StoreError> {
    let grid = &reader.header().grid;
    let stages = cycles::of_result(reader)?;
    let mut text = String::new();
    for part in stages.iter().filter(|part| !part.cycles.is_empty()) {
        let stage = if stages.len() > 1 { format!(" of stage {}", part.stage + 1) } else { String::new() };
        text += &format!("\ncycles{stage} at {:.4} Hz\n", part.frequency);
        text += "      end          work         by drift     stiffness    loss angle   tan\n";
        for cycle in &part.cycles {
            text += &format!(
                "      {:<13}{:<13}{:<13}{:<13}{:<13}{:.4}\n",
                quantity(cycle.span[1], "s"),
                quantity(cycle.dissipated_energy, grid.units("J")),
                quantity(cycle.drift_work, grid.units("J")),
                quantity(cycle.stiffness, grid.units("N/m")),
                format!("{:.3}°", cycle.loss_angle.to_degrees()),
                cycle.loss_angle.tan()
            );
        }
    }
    Ok(text)
}
