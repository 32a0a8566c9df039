//! `asperity leak`: leakage of a result, or of a map of the gap.

use std::path::Path;

use asperity::{Boundary, Grid};
use asperity_io::case::quantity::range::{NonNegative, Positive};
use asperity_io::case::quantity::{Length, MolarMass, Pressure, Temperature, Viscosity};
use asperity_io::case::{LeakageKeys, leak as checked};
use asperity_io::choice;
use asperity_io::leakage::{Leak, LeakError, Leakage, of_result, settings};
use asperity_io::store::{LeakTable, Reader};
use asperity_report::figure::Form;
use serde_json::{Map, Value, json};

use crate::args::{self, FluidOptions, SurfaceFile};
use crate::failure::Failure;
use crate::words::{quantity, read};

/// Computes the leakage and prints it.
pub fn run(args: &args::Leak) -> Result<(), Failure> {
    match (&args.result, &args.gap) {
        (Some(result), _) => result_leak(args, result),
        (None, Some(gap)) => gap_leak(args, gap),
        (None, None) => Err(Failure::input("name a result, or a map of the gap with --gap FILE")),
    }
}

/// Pa m^3/s in mbar l/s.
const MBAR_LITRE: f64 = 10.0;

fn result_leak(args: &args::Leak, path: &Path) -> Result<(), Failure> {
    let told = |error: &dyn std::fmt::Display| Failure::input(error.to_string());
    let reader = Reader::open(path).map_err(|error| told(&error))?;
    let boundary = reader.header().setup.get("boundary").and_then(Value::as_str).and_then(choice::parse);
    let of_case = settings(&reader);
    let leak = match (of_case, given(&args.fluid)) {
        (Some(leak), false) => leak,
        (earlier, _) => Leak {
            // The temperature of the run stays.
            temperatures: earlier.map(|leak| leak.temperatures).unwrap_or_default(),
            ..asked(&args.fluid, boundary.unwrap_or(Boundary::Periodic))?
        },
    };
    drop(reader);
    let interrupt = crate::interrupt::flag();
    let terminal = std::io::IsTerminal::is_terminal(&std::io::stderr());
    let observe = |done: usize, of: usize| {
        if terminal {
            eprint!("\rleakage {done}/{of}{}", if done == of { "\n" } else { "" });
        }
    };
    let (table, findings) = of_result(path, &leak, &interrupt, observe).map_err(failure)?;
    super::findings::tell(&findings);
    let text = if args.json {
        let mut object = columns(&table);
        object.insert("findings".into(), asperity_io::finding::list(&findings));
        object.insert("result".into(), json!(path));
        format!("{}\n", Value::Object(object))
    } else {
        rows(&table)
    };
    crate::print(&text)
}

fn failure(error: LeakError) -> Failure {
    match error {
        LeakError::Interrupted => Failure::Interrupted("the result is as it was".into()),
        LeakError::Solve { source: asperity::Error::Invalid { .. }, .. } | LeakError::Store(_) => {
            Failure::input(error.to_string())
        }
        LeakError::Solve { .. } => Failure::Solve(error.to_string()),
    }
}

fn gap_leak(args: &args::Leak, path: &Path) -> Result<(), Failure> {
    if let Some(plot) = &args.plot {
        Form::of(plot).map_err(|error| Failure::input(error.to_string()))?;
        super::free(plot, false)?;
    }
    let file = |path: &Path, height_unit: Option<String>| SurfaceFile {
        file: path.to_owned(),
        size: args.size.clone(),
        height_unit,
        channel: None,
    };
    let gap = super::surface::open(&file(path, args.height_unit.clone()))?;
    let contact = match &args.contact {
        Some(path) => {
            let map = super::surface::open(&file(path, Some("m".into())))?;
            Some(map.heights.mapv(|contact| u8::from(contact > 0.0)))
        }
        None => None,
    };
    let leak = asked(&args.fluid, Boundary::Periodic)?;
    let told = |error: asperity::Error| Failure::input(format!("{}: {error}", path.display()));
    let (nx, ny) = gap.heights.dim();
    let grid = Grid::new([nx, ny], gap.size).map_err(told)?;
    let contact = contact.as_ref().map(|contact| contact.view());
    let state = leak.of_gap(&grid, gap.heights.view(), contact, 0.0).map_err(|error| match error {
        asperity::Error::Invalid { .. } => told(error),
        error => Failure::Solve(error.to_string()),
    })?;
    if let Some(plot) = &args.plot {
        let figure = asperity_report::leak::state(&state, gap.heights.view(), grid.size());
        figure.write(plot, false).map_err(|error| Failure::input(error.to_string()))?;
    }
    let text = if args.json { format!("{}\n", object(&state)) } else { words(&state) };
    crate::print(&text)
}

/// Whether any option of the fluid is given.
fn given(options: &FluidOptions) -> bool {
    let texts = [
        &options.pressure_drop,
        &options.viscosity,
        &options.molar_mass,
        &options.temperature,
        &options.inlet,
        &options.outlet,
        &options.smallest_gap,
    ];
    texts.into_iter().any(Option::is_some)
        || options.direction.is_some()
        || options.gas.is_some()
        || options.rarefaction.is_some()
        || options.sides.is_some()
        || options.field
}

/// What the options ask for.
fn asked(options: &FluidOptions, boundary: Boundary) -> Result<Leak, Failure> {
    let FluidOptions { direction, gas, rarefaction, sides, field, .. } = options;
    let pressure = |flag: &'static str, text: &Option<String>, example: &'static str| {
        text.as_deref().map(|text| read::<Pressure<Positive>>(flag, text, example)).transpose()
    };
    let outlet =
        options.outlet.as_deref().map(|text| read::<Pressure<NonNegative>>("--outlet", text, "1 bar"));
    let viscosity = options.viscosity.as_deref();
    let molar_mass = options.molar_mass.as_deref();
    let smallest = options.smallest_gap.as_deref();
    let keys = LeakageKeys {
        direction: *direction,
        pressure_drop: pressure("--pressure-drop", &options.pressure_drop, "2 bar")?,
        viscosity: viscosity
            .map(|text| read::<Viscosity<Positive>>("--viscosity", text, "1 mPa s"))
            .transpose()?,
        gas: *gas,
        molar_mass: molar_mass
            .map(|text| read::<MolarMass<Positive>>("--molar-mass", text, "44 g/mol"))
            .transpose()?,
        temperature: options
            .temperature
            .as_deref()
            .map(|text| read::<Temperature>("--temperature", text, "20 degC"))
            .transpose()?,
        inlet: pressure("--inlet", &options.inlet, "3 bar")?,
        outlet: outlet.transpose()?,
        rarefaction: *rarefaction,
        sides: *sides,
        smallest_gap: smallest
            .map(|text| read::<Length<NonNegative>>("--smallest-gap", text, "0.3 nm"))
            .transpose()?,
        field: Some(*field),
    };
    checked(&keys, boundary).map_err(Failure::input)
}

fn columns(table: &LeakTable) -> Map<String, Value> {
    let all = table.series().into_iter().map(|series| series.name).chain(["conductance"]);
    all.filter_map(|name| Some((name.to_owned(), numbers(name, table.get(name)?)))).collect()
}

/// A column as JSON: flags as true and false, NaN as null.
fn numbers(name: &str, values: &[f64]) -> Value {
    match name {
        "percolates" | "leak_resolved" => values.iter().map(|v| json!(*v > 0.0)).collect(),
        "leak_step" => values.iter().map(|v| json!(*v as u64)).collect(),
        _ => json!(values),
    }
}

/// A table of the times.
fn rows(table: &LeakTable) -> String {
    let column = |name: &str| table.get(name).unwrap_or_default();
    let gas = table.get("leak_rate_standard").is_some();
    let mut text = format!("{:>12}", "time");
    let fluid = table.get("leak_rate").is_some();
    if fluid {
        text += &format!("{:>22}", if gas { "leak [mbar l/s]" } else { "leak" });
    }
    text += &format!("{:>15}{:>15}{:>10}\n", "hydraulic gap", "critical gap", "trapped");
    for n in 0..table.len() {
        text += &format!("{:>12}", quantity(column("leak_time")[n], "s"));
        let tight = column("percolates")[n] == 0.0;
        let mark = if column("leak_resolved")[n] == 0.0 { " ?" } else { "  " };
        if fluid {
            let words = match gas {
                _ if tight => "tight".to_owned(),
                true => format!("{:.3e}", MBAR_LITRE * column("leak_rate_standard")[n]),
                false => volume_rate(column("leak_rate")[n]),
            };
            text += &format!("{:>22}", words + mark);
        }
        let gap = |name: &str| if tight { "-".to_owned() } else { quantity(column(name)[n], "m") };
        text += &format!("{:>15}{:>15}", gap("hydraulic_gap"), gap("critical_gap"));
        text += &format!("{:>10}\n", quantity(column("trapped_area")[n], "m2"));
    }
    if column("leak_resolved").contains(&0.0) {
        text += "? see the findings\n";
    }
    if let Some(sealed) = sealed(table) {
        text += &format!("tight from t = {} on\n", quantity(sealed, "s"));
    }
    text
}

/// The first time from which on the seal is tight, where it leaks before.
fn sealed(table: &LeakTable) -> Option<f64> {
    let open = table.get("percolates")?;
    let last = open.iter().rposition(|open| *open > 0.0)?;
    table.get("leak_time")?.get(last + 1).copied()
}

/// m^3/s in words.
fn volume_rate(rate: f64) -> String {
    format!("{rate:.3e} m3/s")
}

fn object(state: &Leakage) -> Value {
    let place = |value: f64| if value.is_finite() { json!(value) } else { Value::Null };
    json!({
        "percolates": state.percolates,
        "hydraulic_gap": state.hydraulic_gap,
        "critical_gap": place(state.critical_gap),
        "critical_x": place(state.critical[0]),
        "critical_y": place(state.critical[1]),
        "critical_width": state.critical_width,
        "medium_gap": state.medium_gap,
        "open_fraction": state.open_fraction,
        "trapped_area": state.trapped_area,
        "trapped_volume": state.trapped_volume,
        "conductance": state.conductance,
        "leak_rate": state.leak_rate,
        "leak_rate_standard": state.leak_rate_standard,
        "leak_estimate_junction": state.leak_estimate_junction,
        "leak_estimate_medium": state.leak_estimate_medium,
        "knudsen_number": state.knudsen.map(place),
    })
}

fn words(state: &Leakage) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| text += &format!("{name:<22}{value}\n");
    if state.percolates {
        line("hydraulic gap", quantity(state.hydraulic_gap, "m"));
        let width = state.critical_width.map_or(String::new(), |cells| format!(", {cells} cells wide"));
        let place =
            format!("at ({}, {})", quantity(state.critical[0], "m"), quantity(state.critical[1], "m"));
        line("critical gap", format!("{} {place}{width}", quantity(state.critical_gap, "m")));
    } else {
        line("seal", "tight: inlet and outlet are not connected".into());
    }
    line("effective medium", quantity(state.medium_gap, "m"));
    line("open", format!("{:.3} % of the cells", 100.0 * state.open_fraction));
    line(
        "pockets",
        format!("{}, {}", quantity(state.trapped_area, "m2"), quantity(state.trapped_volume, "m3")),
    );
    if let Some([[xx, xy], [yx, yy]]) = state.conductance {
        line("conductance [m3]", format!("xx {xx:.6e}, xy {xy:.6e}, yx {yx:.6e}, yy {yy:.6e}"));
    }
    if let Some(rate) = state.leak_rate {
        let one = |rate: f64| match state.leak_rate_standard {
            Some(_) => format!("{rate:.4e} kg/s"),
            None => volume_rate(rate),
        };
        line("leak", one(rate));
        if let Some(standard) = state.leak_rate_standard {
            line("", format!("{standard:.4e} Pa m3/s at 0 degC, {:.4e} mbar l/s", MBAR_LITRE * standard));
        }
        line("  by one junction", one(state.leak_estimate_junction.unwrap_or(f64::NAN)));
        line("  by the medium", one(state.leak_estimate_medium.unwrap_or(f64::NAN)));
    }
    if let Some(knudsen) = state.knudsen.filter(|knudsen| knudsen.is_finite()) {
        line("Knudsen number", format!("{knudsen:.3} at the constriction"));
    }
    text
}
