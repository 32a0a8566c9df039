//! `asperity show`: a result in the terminal.

use asperity::Grid;
use asperity::quantities::Quantity;
use asperity_io::cycles;
use asperity_io::leakage::LeakHistory;
use asperity_io::store::{At, Reader, Status, StoreError};
use asperity_io::stress::{Below, first_yield};
use asperity_report::result::{contact, moment};
use serde_json::json;

use super::instant;
use crate::args::ShowResult;
use crate::failure::Failure;
use crate::terminal::{shares, sparkline};
use crate::words::{bytes, duration, in_contact, quantity};

/// Letters of the map and of the curves.
const COLUMNS: usize = 56;
const SPARKS: usize = 40;

/// Prints the summary.
pub fn run(args: &ShowResult) -> Result<(), Failure> {
    let reader = Reader::open(&args.result).map_err(|error| Failure::input(error.to_string()))?;
    let at = instant(&reader, args.time.as_deref())?;
    let text = if args.json { object(&reader) } else { text(&reader, at) };
    crate::print(&text.map_err(|error| Failure::input(error.to_string()))?)
}

fn object(reader: &Reader) -> Result<String, StoreError> {
    let work = reader.work();
    let mut last = serde_json::Map::new();
    for scalar in reader.scalars() {
        last.insert(scalar.name.into(), json!(reader.series(scalar.name)?.last()));
    }
    let object = json!({
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

fn text(reader: &Reader, at: At) -> Result<String, StoreError> {
    let header = reader.header();
    let mut text = String::new();
    if !header.title.is_empty() {
        text += &format!("{}\n\n", header.title);
    }
    let mut line = |name: &str, value: String| text += &format!("{name:<13}{value}\n");
    let of = header.rows_expected.map_or(String::new(), |total| format!(" of {total}"));
    let state = match reader.status() {
        Status::Complete if reader.lacks_leakage() => format!("without its leakage{}", reader.continuation()),
        Status::Complete => "complete".to_owned(),
        Status::Running if reader.is_being_written() => "running now".to_owned(),
        Status::Running => format!("killed before its end{}", reader.continuation()),
        Status::Interrupted => format!("interrupted{}", reader.continuation()),
        Status::Failed => "failed".to_owned(),
    };
    line("status", format!("{state}, {}{of} rows", reader.len()));
    if let Some(message) = &reader.work().message {
        line("", message.clone());
    }
    if let Some(kept) = reader.replaces() {
        line("", format!("the complete result that it replaces is kept in {}", kept.display()));
    }
    for finding in reader.findings() {
        line(finding.severity.as_str(), format!("{} [{}]", finding.text, finding.code));
    }
    let grid = &header.grid;
    let boundary = header.boundary().map_or(String::new(), |words| format!(", {words}"));
    line("domain", domain(grid) + &boundary);
    let rows = reader.rows()?;
    let Some(last) = rows.last() else { return Ok(text) };
    // A curve over time or velocity, with its ends.
    let times: Vec<f64> = rows.iter().map(|row| row.time).collect();
    let bars = |values: &[f64]| sparkline(&times, values, header.is_sweep(), SPARKS);
    let curve = |value: fn(&asperity::march::Row) -> f64, words: &dyn Fn(f64) -> String| {
        let values: Vec<f64> = rows.iter().map(value).collect();
        let [low, high] =
            values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
        let (low, high) = (words(low), words(high));
        let ends = if low == high { "unchanged".to_owned() } else { format!("{low} to {high}") };
        format!("{}  {ends}", bars(&values))
    };
    let (force, area) = (grid.units("N"), grid.units("m2"));
    let percent = |share: f64| format!("{:.3} %", 100.0 * share);
    match header.is_sweep() {
        true => {
            let first = rows.first().map_or(last.time, |row| row.time);
            line("velocity", format!("{} to {}", quantity(first, "m/s"), quantity(last.time, "m/s")));
        }
        false => line("time", quantity(last.time, "s")),
    }
    if reader.scalars().iter().any(|series| series.name == Quantity::FrictionCoefficient.name()) {
        let mu = reader.series(Quantity::FrictionCoefficient.name())?;
        let [low, high] =
            mu.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
        let last = mu.last().copied().unwrap_or(f64::NAN);
        line("friction", format!("{last:<14.4}{}  {low:.4} to {high:.4}", bars(&mu)));
    }
    line(
        "load",
        format!("{:<14}{}", quantity(last.load, force), curve(|row| row.load, &|v| quantity(v, force))),
    );
    line(
        "approach",
        format!("{:<14}{}", quantity(last.approach, "m"), curve(|row| row.approach, &|v| quantity(v, "m"))),
    );
    line(
        "contact",
        format!("{:<14}{}", percent(last.contact_fraction), curve(|row| row.contact_fraction, &percent)),
    );
    line(
        "mean gap",
        format!("{:<14}{}", quantity(last.mean_gap, "m"), curve(|row| row.mean_gap, &|v| quantity(v, "m"))),
    );
    if grid.is_line() {
        line("length", quantity(last.contact_area, area));
    } else {
        line("area", quantity(last.contact_area, area));
        line("corrected", quantity(last.contact_area_corrected, area));
    }
    if last.capped_area > 0.0 {
        line("at hardness", quantity(last.capped_area, area));
    }
    let [nominal, touching, largest] =
        [last.mean_pressure, in_contact(last), last.max_pressure].map(|p| quantity(p, "Pa"));
    line("pressure", format!("nominal mean {nominal}, in the contact {touching}, largest {largest}"));
    let asked = reader.scalars().into_iter().filter(|s| {
        let coordinate = header.is_sweep() && s.name == Quantity::Velocity.name();
        Quantity::from_name(s.name).is_some() && !coordinate
    });
    for (n, series) in asked.enumerate() {
        let values = reader.series(series.name)?;
        let value = values.last().copied().unwrap_or(f64::NAN);
        let words = if series.units == "1" { quantity(value, "") } else { quantity(value, series.units) };
        line(if n == 0 { "quantities" } else { "" }, format!("{:<27}{words}", series.name));
    }
    if let Some(below) = Below::of(reader)?
        && let Some(worst) = below.worst()
    {
        let [mises, depth] = ["max_mises", "max_mises_depth"].map(|name| below.number(worst, name));
        let place =
            if depth.is_finite() { format!(" at depth {}", quantity(depth, "m")) } else { String::new() };
        let time = quantity(worst.time, "s");
        line(
            "stress",
            format!("largest von Mises {}{place} of {}, t = {time}", quantity(mises, "Pa"), below.set.body),
        );
        if let Some(first) = first_yield(&below) {
            line("yield", first.sentence(&below.set));
        }
    }
    if let Some(leaks) = LeakHistory::of(reader)? {
        line("leak", leaks.sentence());
    }
    let worst = rows.iter().map(|row| row.certificate).fold(0.0, f64::max);
    line("certificate", format!("{worst:.1e} at worst (relative error of the pressure)"));
    let work = reader.work();
    let memory = work.peak_memory_bytes.map_or(String::new(), |b| format!(", {}", bytes(b as f64)));
    line(
        "work",
        format!(
            "{} iterations, {} convolutions ({:.1} per row) in {}{memory}",
            work.iterations,
            work.convolutions,
            work.convolutions as f64 / rows.len().max(1) as f64,
            duration(work.wall_s)
        ),
    );
    let cyclic = cycles::of_result(reader)?;
    let kept: Vec<_> = header.fields.iter().map(|kind| kind.name()).collect();
    let instants = if header.is_sweep() { "velocities" } else { "times" };
    line("fields", format!("{} at {} {instants}", kept.join(", "), reader.field_times().len()));
    for part in cyclic.iter().filter(|part| !part.cycles.is_empty()) {
        let stage = if cyclic.len() > 1 { format!(" of stage {}", part.stage + 1) } else { String::new() };
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
    if let Some(states) = contact(reader, at)? {
        let time = reader.field_times()[reader.index(at)?];
        text += &format!("\ncontact at {}\n", moment(reader, time));
        text += &shares(states.mapv(|state| state > 0).view(), COLUMNS, grid.size()[1] / grid.size()[0]);
    }
    Ok(text)
}
