//! The case and the work of a result, in words.

use asperity::Axis;
use asperity_io::cycles;
use asperity_io::readable::{counted, quantity};
use asperity_io::store::{Reader, StoreError};
use serde_json::{Map, Value};

/// The case and the work, in words.
pub(super) fn facts(reader: &Reader) -> Result<Vec<[String; 2]>, StoreError> {
    let header = reader.header();
    let setup = &header.setup;
    let [nx, ny] = header.grid.cells();
    let [lx, ly] = header.grid.size();
    let mut lines = vec![[
        "Domain".to_owned(),
        match header.grid.is_line() {
            true => format!("a line of {nx} cells, {}, plane strain", quantity(lx, "m")),
            false => format!("{nx} × {ny} cells, {} × {}", quantity(lx, "m"), quantity(ly, "m")),
        },
    ]];
    let mut line =
        |name: &str, value: Option<String>| lines.extend(value.map(|value| [name.to_owned(), value]));
    let text = |key: &str| setup.get(key).and_then(Value::as_str);
    let list = |key: &str| setup.get(key).and_then(Value::as_array).map(|list| list.iter());
    let names = |key: &str| {
        list(key)
            .map(|list| list.filter_map(Value::as_str).collect::<Vec<_>>().join(", "))
            .filter(|s| !s.is_empty())
    };
    let number = |key: &str, unit: &str| setup.get(key).and_then(Value::as_f64).map(|v| quantity(v, unit));
    line("Boundary", header.boundary());
    let layers = setup.get("layer_separable").and_then(Value::as_bool).map(|separable| match separable {
        true => "all waves creep alike".to_owned(),
        false => format!(
            "waves of different lengths creep differently, described to {:.1e}",
            setup.get("layer_misfit").and_then(Value::as_f64).unwrap_or_default()
        ),
    });
    line("Layers", layers);
    line("Surfaces", names("surfaces"));
    line("Deformable bodies", names("bodies"));
    line("Instantaneous contact modulus, 1/C(0)", number("instantaneous_modulus", "Pa"));
    line("Relaxed contact modulus, 1/C(∞)", number("relaxed_modulus", "Pa"));
    let times = list("retardation_times").map(|list| {
        let times: Vec<f64> = list.filter_map(Value::as_f64).collect();
        match times[..] {
            [] => "none (elastic)".to_owned(),
            [first, .., last] if times.len() > 4 => {
                format!("{} from {} to {}", times.len(), quantity(first, "s"), quantity(last, "s"))
            }
            _ => times.iter().map(|t| quantity(*t, "s")).collect::<Vec<_>>().join(", "),
        }
    });
    line("Retardation times", times);
    for [name, words] in materials(setup) {
        line(&name, Some(words));
    }
    line("Temperature", crate::result::temperatures(reader));
    line("Motion", motion(setup));
    line("Hardness", number("hardness", "Pa"));
    line("Friction", friction(setup));
    line("Wear", wear(setup));
    line("Flash temperature", flash(setup));
    match header.axis() {
        Axis::Velocity => {
            let rows = reader.series("time")?;
            let ends = rows.first().zip(rows.last());
            let words =
                |(from, to): (&f64, &f64)| format!("{} to {}", quantity(*from, "m/s"), quantity(*to, "m/s"));
            line("Velocities", ends.map(words));
        }
        Axis::Time | Axis::None => {
            let end = setup.get("end").and_then(Value::as_f64);
            line("Time", end.map(|end| format!("0 to {}", quantity(end, "s"))));
        }
    }
    for [name, words] in last_cycles(reader)? {
        line(&name, Some(words));
    }
    line("Scheme", text("scheme").map(str::to_owned));
    line(
        "Tolerance of the solver",
        setup.get("solver_tolerance").and_then(Value::as_f64).map(|v| format!("{v:e}")),
    );
    let work = reader.work();
    let per_row = work.convolutions as f64 / reader.len().max(1) as f64;
    let threads = work.threads.map_or(String::new(), |n| format!(" on {}", counted(n, "thread")));
    line(
        "Work",
        Some(format!(
            "{} convolutions, {per_row:.1} per row; {} iterations; {}{threads}",
            work.convolutions,
            work.iterations,
            quantity(work.wall_s, "s"),
        )),
    );
    line("Peak memory", work.peak_memory_bytes.map(|bytes| format!("{:.1} MiB", bytes as f64 / 1048576.0)));
    let worst = reader.series("certificate")?.into_iter().fold(0.0, f64::max);
    line("Largest certified error of the pressure", Some(format!("{worst:.1e} (relative, energy norm)")));
    Ok(lines)
}

/// What each body is made of: model, number of terms, file and misfit.
fn materials(setup: &Map<String, Value>) -> Vec<[String; 2]> {
    let list = setup.get("materials").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    let words = |material: &Value| {
        let text = |key: &str| material.get(key).and_then(Value::as_str);
        let number = |key: &str| material.get(key).and_then(Value::as_f64);
        let terms = number("terms").filter(|terms| *terms > 0.0);
        let parts = [
            text("model").map(str::to_owned),
            terms.map(|terms| format!("{terms} {}", if terms == 1.0 { "term" } else { "terms" })),
            text("file").map(|file| format!("from {file}")),
            number("rms_misfit").map(|misfit| format!("fitted to {:.2} % rms", 100.0 * misfit)),
        ];
        let name = format!("Material of {}", text("body").unwrap_or("a body"));
        [name, parts.into_iter().flatten().collect::<Vec<_>>().join(", ")]
    };
    list.iter().map(words).collect()
}

/// "sliding; a positive velocity is along +x".
fn motion(setup: &Map<String, Value>) -> Option<String> {
    let motion = setup.get("motion")?.as_object()?;
    let is = |key: &str| motion.get(key).and_then(Value::as_bool) == Some(true);
    let kind = if is("rolls") { "rolling" } else { "sliding" };
    let steady = if is("steady") { ", steady states" } else { "" };
    let along = crate::result::along(motion.get("direction")?, 1.0)?;
    Some(format!("{kind}{steady}; a positive velocity is {along}"))
}

/// "coefficient 0.3, under a tangential force".
fn friction(setup: &Map<String, Value>) -> Option<String> {
    let friction = setup.get("friction")?.as_object()?;
    let number = |key: &str| friction.get(key).and_then(Value::as_f64);
    let coefficient = match number("coefficient") {
        Some(coefficient) => format!("coefficient {coefficient}"),
        None => "a coefficient for each cell".to_owned(),
    };
    let limit =
        number("shear_limit").map_or(String::new(), |limit| format!(", at most {}", quantity(limit, "Pa")));
    let control = friction.get("control").and_then(Value::as_str).unwrap_or_default();
    Some(format!("{coefficient}{limit}, under a tangential {control}"))
}

/// "slider 2 W/(m K) and 1e-6 m²/s, track 0.3 W/(m K) and 1e-7 m²/s, partition mean".
fn flash(setup: &Map<String, Value>) -> Option<String> {
    let flash = setup.get("flash")?.as_object()?;
    let number = |key: &str| flash.get(key).and_then(Value::as_f64);
    let body = |n: usize| {
        let body = flash.get("bodies")?.get(n)?.as_object()?;
        let of = |key: &str| Some(quantity(body.get(key)?.as_f64()?, ""));
        Some(format!("{} W/(m K) and {} m²/s", of("conductivity")?, of("diffusivity")?))
    };
    let friction = number("friction").filter(|mu| *mu > 0.0);
    let friction = friction.map_or(String::new(), |mu| format!(", friction {}", quantity(mu, "")));
    let time = number("heated_for").map_or(String::new(), |t| format!(", heated for {}", quantity(t, "s")));
    let feedback = if number("feedback").is_some() { ", with feedback on the material" } else { "" };
    let partition = flash.get("partition").and_then(Value::as_str).unwrap_or_default();
    Some(format!("slider {}, track {}, partition {partition}{friction}{time}{feedback}", body(0)?, body(1)?))
}

/// "Archard's law with 1e-15 m²/N, each computed cycle stands for 400".
fn wear(setup: &Map<String, Value>) -> Option<String> {
    let wear = setup.get("wear")?.as_object()?;
    let number = |key: &str| wear.get(key).and_then(Value::as_f64);
    let list = wear.get("coefficients").and_then(Value::as_array)?;
    let [body, counterbody] = [0, 1].map(|n| list.get(n).and_then(Value::as_f64).unwrap_or(0.0));
    let of = if counterbody > 0.0 {
        format!(" of the body and {counterbody:e} m²/N of the counterbody")
    } else {
        String::new()
    };
    let above = number("threshold").filter(|p| *p > 0.0);
    let above = above.map_or(String::new(), |p| format!(" above {}", quantity(p, "Pa")));
    let cycles = number("cycles").filter(|n| *n != 1.0);
    let most = if number("cycles_tolerance").is_some() { "up to " } else { "" };
    let cycles = cycles.map_or(String::new(), |n| format!("; each computed cycle stands for {most}{n}"));
    Some(format!("Archard's law with {body:e} m²/N{of}{above}{cycles}"))
}

/// The last full cycle of each stage with a sine.
fn last_cycles(reader: &Reader) -> Result<Vec<[String; 2]>, StoreError> {
    let grid = &reader.header().grid;
    let of_stage = |part: &cycles::Cyclic| {
        let cycle = part.cycles.last()?;
        let energy = |value: f64| quantity(value, grid.units("J"));
        let work = match cycle.drift_work.abs() > 0.01 * cycle.dissipated_energy.abs() {
            true => format!(
                "work {} ({} of it by drift)",
                energy(cycle.dissipated_energy),
                energy(cycle.drift_work)
            ),
            false => format!("{} lost", energy(cycle.dissipated_energy)),
        };
        let words = format!(
            "loss angle {:.2}°, {work}, dynamic stiffness {}",
            cycle.loss_angle.to_degrees(),
            quantity(cycle.stiffness, grid.units("N/m"))
        );
        Some([format!("Last of {} cycles at {}", part.cycles.len(), quantity(part.frequency, "Hz")), words])
    };
    Ok(cycles::of_result(reader)?.iter().filter_map(of_stage).collect())
}
