//! What a page knows besides its maps.

use asperity::Coordinate;
use asperity::cycles::Cycle;
use asperity_io::answer::{self, Answer, Units, Validity};
use asperity_io::converge::ErrorBar;
use asperity_io::cycles;
use asperity_io::leakage::LeakHistory;
use asperity_io::store::{FieldKind, Reader, Row, StoreError};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Map, Value, json};

use super::facts::facts;
use super::maps::Maps;
use super::{material, stress};
use crate::figure::Colours;
use crate::leak::sentence;
use crate::result::ForceCurve;
use crate::result::panels::{self, CONTACT_PRESSURE, RowPanel};
use crate::result::{Options, Rows, colours, name_of_theory, persson, temperature_at_rows};

/// The result's title, or its file name.
pub(super) fn title(reader: &Reader) -> String {
    let title = &reader.header().title;
    if !title.is_empty() {
        return title.clone();
    }
    reader.path().file_stem().map_or_else(|| "result".into(), |name| name.to_string_lossy().into_owned())
}

pub(super) fn state(reader: &Reader, maps: &Maps) -> Result<Value, StoreError> {
    if reader.is_empty() {
        return Err(reader.no_rows());
    }
    let units = Units::of(reader, &Units::default());
    let answers = answer::of(reader, &units)?;
    let mut series = Map::new();
    let mut units_of = Map::new();
    for scalar in reader.scalars() {
        series.insert(scalar.name.into(), json!(panels::values(reader, scalar.name)?));
        units_of.insert(scalar.name.into(), json!(scalar.units));
    }
    // What the rows follow, of a sweep the velocities.
    series.insert("time".into(), json!(reader.series("time")?));
    series.insert(CONTACT_PRESSURE.into(), json!(panels::values(reader, CONTACT_PRESSURE)?));
    units_of.insert(CONTACT_PRESSURE.into(), json!("Pa"));
    if let Some(temperature) = temperature_at_rows(reader)? {
        series.insert("temperature".into(), json!(temperature));
        units_of.insert("temperature".into(), json!("°C"));
    }
    let rows = Rows::of(reader)?;
    let theory = persson(reader)?;
    let grid = &reader.header().grid;
    if let Some(theory) = &theory {
        let whole = grid.size()[0] * grid.size()[1];
        let friction: Vec<f64> = theory.iter().map(|at| at.friction_coefficient).collect();
        let area: Vec<f64> = theory.iter().map(|at| at.contact_fraction * whole).collect();
        series.insert(PERSSON_FRICTION.into(), json!(friction));
        series.insert(PERSSON_AREA.into(), json!(area));
    }
    let note = match maps.block {
        1 => String::new(),
        block if grid.is_line() => format!("Curves show means over {block} of {} cells.", grid.cells()[0]),
        block => format!(
            "Maps show means over {block} × {block} cells (of the contact state: the most frequent value) of {} × {}.",
            grid.cells()[0],
            grid.cells()[1]
        ),
    };
    let instants = maps
        .instants
        .iter()
        .map(|index| json!({"time": reader.field_times()[*index], "row": reader.field_steps()[*index]}));
    Ok(json!({
        "title": title(reader),
        "status": status(reader),
        "footer": format!("asperity {}; numbers in SI units with prefixes.", reader.header().version),
        "findings": asperity_io::finding::list(reader.findings()),
        "headline": headline(&answers, &units, &reader.error_bars(), reader.rows()?.last()),
        "answers": answers,
        "facts": facts(reader)?,
        "case": reader.header().case_text,
        "still": !reader.header().changes_shape() && !reader.header().moves_in_time(),
        "grid": {"cells": grid.cells(), "size": grid.size(), "line": grid.is_line()},
        "series": series,
        "units": units_of,
        "time_unit": units.shown("time").map(|shown| json!({"factor": shown.factor, "text": shown.text})),
        "rows": {"label": rows.of.name(), "unit": rows.of.unit(), "symbol": rows.of.symbol(), "log": rows.log},
        "last_cycle": last_cycle(reader)?,
        "force_curve": ForceCurve::of(reader, &reader.series("approach")?, &reader.series("load")?),
        "slips": reader.header().slips(),
        "cycles": each_cycle(reader)?,
        "evolution": evolution(reader, theory.is_some())?,
        "solver": panels::of_work(reader)?.iter().map(panel).collect::<Vec<_>>(),
        "fields": maps.fields.iter().map(|kind| field(*kind, reader)).collect::<Vec<_>>(),
        "instants": instants.collect::<Vec<_>>(),
        "note": note,
        "colours": {
            "sequential": lut(Colours::Sequential),
            "diverging": lut(Colours::Diverging),
            "pressure": lut(Colours::Pressure),
        },
        "surface": maps.surface,
        "material": material::curves(reader),
        "stress": stress::curves(reader)?,
        "leak": leak(reader, &units)?,
    }))
}

/// Rows of the last cycle; null where there is none.
fn last_cycle(reader: &Reader) -> Result<Value, StoreError> {
    let rows = crate::result::last_cycle(reader, &Options::default())?;
    Ok(rows.map_or(Value::Null, |rows| json!([rows.start(), rows.end()])))
}

/// Loss angle \[°\], lost energy and stiffness of each full cycle, for each stage with a sine.
fn each_cycle(reader: &Reader) -> Result<Value, StoreError> {
    let of_stage = |part: &cycles::Cyclic| {
        let column = |value: fn(&Cycle) -> f64| part.cycles.iter().map(value).collect::<Vec<f64>>();
        json!({
            "frequency": part.frequency,
            "loss_angle": column(|cycle| cycle.loss_angle.to_degrees()),
            "dissipated_energy": column(|cycle| cycle.dissipated_energy),
            "stiffness": column(|cycle| cycle.stiffness),
        })
    };
    Ok(cycles::of_result(reader)?.iter().map(of_stage).collect())
}

/// The leaks over time, what was asked for and what was found in words; null where there are none.
fn leak(reader: &Reader, units: &Units) -> Result<Value, StoreError> {
    let Some(history) = LeakHistory::of(reader)? else { return Ok(Value::Null) };
    let mut columns = Map::new();
    for series in history.table.series() {
        let values = history.table.get(series.name);
        columns.insert(series.name.into(), json!({"units": series.units, "values": values}));
    }
    let gas = history.table.get("leak_rate_standard").is_some();
    let shown = units.shown_leak(gas);
    columns.insert("shown".into(), json!({"factor": shown.factor, "text": shown.text}));
    columns.insert("acts".into(), json!(history.leak.coupling.is_some()));
    columns.insert("asked".into(), json!(history.leak.words()));
    columns.insert("found".into(), json!(history.sentence(units)));
    let holds: Vec<bool> = history.of_each_time().iter().map(Validity::is_valid).collect();
    let last = history.validity("leak_rate");
    columns.insert("taken".into(), json!((!last.is_valid()).then(|| sentence(&last.mark(String::new())))));
    columns.insert("holds".into(), json!(holds));
    Ok(Value::Object(columns))
}

/// The series of Persson's theory beside the computed friction coefficient and area.
const PERSSON_FRICTION: &str = "persson_friction_coefficient";
const PERSSON_AREA: &str = "persson_contact_area";

/// The panels over the rows, those of the quantities last; where the page has `theory`, it stands beside what was computed.
fn evolution(reader: &Reader, theory: bool) -> Result<Vec<Value>, StoreError> {
    let mut panels = panels::of_evolution(reader)?;
    if temperature_at_rows(reader)?.is_some() {
        let lines = vec![("", "temperature")];
        panels.push(RowPanel { title: "Temperature", label: "temperature", lines, states: &[] });
    }
    let of_quantities = panels::of_quantities(reader)?;
    if reader.header().slips() {
        // Beside the loop, what stays the same says nothing.
        let constant =
            panels.iter().map(|panel| panels::is_constant(reader, panel)).collect::<Result<Vec<_>, _>>()?;
        let mut changes = constant.into_iter().map(|is_constant| !is_constant);
        panels.retain(|_| changes.next().unwrap_or(true));
    }
    panels.extend(of_quantities);
    // The answer of a contact in motion comes first.
    panels.sort_by_key(|panel| match panel.title {
        "Friction coefficient" => 0,
        "Friction" => 1,
        _ => 2,
    });
    let beside = [("friction_coefficient", PERSSON_FRICTION), ("contact_area", PERSSON_AREA)];
    for (computed, expected) in beside.into_iter().filter(|_| theory) {
        if let Some(panel) = panels.iter_mut().find(|p| p.lines.iter().any(|(_, name)| *name == computed)) {
            panel.lines.push((name_of_theory(reader)?, expected));
        }
    }
    Ok(panels.iter().map(panel).collect())
}

/// Title, label, name and series of each line, and the names of states.
fn panel(panel: &RowPanel) -> Value {
    let lines: Vec<_> = panel.lines.iter().map(|(name, series)| json!([name, series])).collect();
    json!([panel.title, panel.label, lines, panel.states])
}

fn field(kind: FieldKind, reader: &Reader) -> Value {
    let (label, colours) = (kind.short_name(), colours(kind));
    let is_tension = kind == FieldKind::Pressure && reader.header().adhesion().is_some();
    let colours = match colours {
        _ if is_tension => "diverging",
        Some(Colours::Pressure) => "pressure",
        Some(Colours::Diverging) => "diverging",
        // The page itself leaves the gap of cells in contact light.
        Some(_) => "sequential",
        None => "states",
    };
    json!({
        "name": kind.name(), "title": sentence(label), "label": label, "unit": kind.units(), "colours": colours,
    })
}

/// 256 colours, three bytes each.
fn lut(colours: Colours) -> String {
    let bytes: Vec<u8> = (0..256).flat_map(|k| colours.at(f64::from(k) / 255.0)).collect();
    STANDARD.encode(bytes)
}

fn status(reader: &Reader) -> String {
    let (rows, state) = (reader.len(), reader.state());
    if state == "complete" {
        return format!("complete, {rows} rows");
    }
    let of = reader.header().rows_expected.map_or(String::new(), |total| format!(" of {total}"));
    let why = reader.work().message.as_ref().map_or(String::new(), |message| format!(": {message}"));
    format!("{rows}{of} rows; {state}{why}")
}

/// The answers of the result, and the row that they belong to.
fn headline(answers: &[Answer], units: &Units, bars: &[ErrorBar], last: Option<&Row>) -> Vec<[String; 2]> {
    let words = |answer: &Answer| {
        let bar = bars.iter().find(|bar| bar.name == answer.name);
        bar.map_or_else(|| answer.words(units), |bar| units.plus_minus(bar))
    };
    let note = |answer: &Answer| match answer.note.as_str() {
        // The reason why it does not hold stands in its place.
        _ if !answer.validity.is_valid() => String::new(),
        "" => String::new(),
        note => format!(" ({note})"),
    };
    let line = |answer: &Answer| {
        let [value, known] = answer.validity.card(words(answer));
        [answer.label() + &known + &note(answer), value]
    };
    let mut lines: Vec<[String; 2]> = units.without_second_rate(answers).map(line).collect();
    let mut at: Vec<(Coordinate, String)> = vec![];
    for answer in answers {
        if let Some(own) = answer.at.filter(|own| at.iter().all(|(known, _)| known != own)) {
            at.push((own, answer.label()));
        }
    }
    if at.is_empty() {
        at.extend(last.map(|row| (row.coordinate, String::new())));
    }
    let many = at.len() > 1;
    lines.extend(at.iter().map(|(at, label)| {
        let of = if many { format!(" of the {label}") } else { String::new() };
        [at.axis().name().to_owned() + &of, units.number(at.value(), at.axis().unit())]
    }));
    lines
}
