//! What a page knows besides its maps.

use asperity::Coordinate;
use asperity::cycles::Cycle;
use asperity_io::cycles;
use asperity_io::leakage::LeakHistory;
use asperity_io::readable::quantity;
use asperity_io::store::{FieldKind, Reader, StoreError};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Map, Value, json};

use super::facts::{facts, time};
use super::maps::Maps;
use super::{material, stress};
use crate::figure::Colours;
use crate::leak::sentence;
use crate::result::panels::{self, CONTACT_PRESSURE, RowPanel};
use crate::result::{Options, Rows, look, name_of_theory, persson, temperature_at_rows};

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
    let mut series = Map::new();
    let mut units = Map::new();
    for scalar in reader.scalars() {
        series.insert(scalar.name.into(), json!(reader.series(scalar.name)?));
        units.insert(scalar.name.into(), json!(scalar.units));
    }
    // What the rows follow, of a sweep the velocities.
    series.insert("time".into(), json!(reader.series("time")?));
    series.insert(CONTACT_PRESSURE.into(), json!(panels::values(reader, CONTACT_PRESSURE)?));
    units.insert(CONTACT_PRESSURE.into(), json!("Pa"));
    if let Some(temperature) = temperature_at_rows(reader)? {
        series.insert("temperature".into(), json!(temperature));
        units.insert("temperature".into(), json!("°C"));
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
        "headline": headline(reader)?,
        "facts": facts(reader)?,
        "case": reader.header().case_text,
        "grid": {"cells": grid.cells(), "size": grid.size(), "line": grid.is_line()},
        "series": series,
        "units": units,
        "rows": {"label": rows.of.name(), "unit": rows.of.unit(), "symbol": rows.of.symbol(), "log": rows.log},
        "last_cycle": last_cycle(reader)?,
        "cycles": each_cycle(reader)?,
        "evolution": evolution(reader, theory.is_some())?,
        "solver": panels::of_work(reader)?.iter().map(panel).collect::<Vec<_>>(),
        "fields": maps.fields.iter().map(field).collect::<Vec<_>>(),
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
        "leak": leak(reader)?,
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
fn leak(reader: &Reader) -> Result<Value, StoreError> {
    let Some(history) = LeakHistory::of(reader)? else { return Ok(Value::Null) };
    let mut columns = Map::new();
    for series in history.table.series() {
        let values = history.table.get(series.name);
        columns.insert(series.name.into(), json!({"units": series.units, "values": values}));
    }
    columns.insert("asked".into(), json!(history.leak.words()));
    columns.insert("found".into(), json!(history.sentence()));
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
    panels.extend(panels::of_quantities(reader)?);
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

fn field(kind: &FieldKind) -> Value {
    let (label, colours) = look(*kind);
    let colours = match colours {
        Some(Colours::Pressure) => "pressure",
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

/// The state at the end.
fn headline(reader: &Reader) -> Result<Vec<[String; 2]>, StoreError> {
    let rows = reader.rows()?;
    let Some(last) = rows.last() else { return Ok(vec![]) };
    let grid = &reader.header().grid;
    let (force, area) = (grid.units("N"), grid.units("m2"));
    let contact = match grid.is_line() {
        true => "contact length".to_owned(),
        false => format!("contact area, {} corrected", quantity(last.contact_area_corrected, area)),
    };
    let nominal = quantity(last.mean_pressure, "Pa");
    let pressures = match last.contact_area > 0.0 {
        true => {
            let mean = quantity(last.load / last.contact_area, "Pa");
            format!("largest pressure; mean over the contact {mean}, nominal {nominal}")
        }
        false => "largest pressure; nothing touches".to_owned(),
    };
    let mut lines = vec![
        [
            format!("{} (last of {} rows)", last.coordinate.axis().name(), rows.len()),
            match last.coordinate {
                Coordinate::Velocity(velocity) => quantity(velocity, "m/s"),
                at => time(at.value()),
            },
        ],
        ["load".into(), quantity(last.load, force)],
        ["approach".into(), quantity(last.approach, "m")],
        [contact, quantity(last.contact_area, area)],
        [
            if grid.is_line() { "of the domain" } else { "of the nominal area" }.into(),
            format!("{:.2} %", 100.0 * last.contact_fraction),
        ],
        ["mean gap".into(), quantity(last.mean_gap, "m")],
        [pressures, quantity(last.max_pressure, "Pa")],
    ];
    if last.capped_area > 0.0 {
        lines.push(["at the hardness".into(), quantity(last.capped_area, area)]);
    }
    Ok(lines)
}
