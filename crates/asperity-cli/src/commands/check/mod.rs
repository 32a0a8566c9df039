//! `asperity check`: what a case will do, without doing it.

mod cost;

use asperity::Axis;
use asperity::flash::Conductor;
use asperity::load::{Course, Stage};
use asperity::tangential::TangentialControl;
use asperity::traction::FINE_TRAP;
use asperity_io::case::{Case, Examination, Inputs, SurfaceInput, Travel, bare_numbers};
use asperity_io::converge::expected_cost;
use asperity_io::stress::StressDescription;
use serde_json::json;

use self::cost::Cost;
use crate::args::Check;
use crate::failure::Failure;
use crate::format::{bytes, counted, duration, quantity};
use crate::verb::{Threads, Verb};

impl Verb for Check {
    fn threads(&self) -> Threads {
        Threads::of(self.common.threads)
    }

    /// Validates the case, builds its gap, and says what will be solved.
    fn run(&self) -> Result<(), Failure> {
        let case = Case::read(&self.case, &self.common.set)?;
        // The files are read and the gap is built: what `run` would refuse is refused here.
        let examined = case.examine()?;
        note_bare_numbers(&case);
        let cost = cost::cost(&case, &examined.description);
        if self.json {
            let mut object = serde_json::to_value(&examined).unwrap_or_default();
            object["estimated_s"] = json!(
                cost.as_ref().map(|cost| cost.seconds + cost::seconds_after(&case, &examined.description))
            );
            object["estimated_rows"] = json!(cost.as_ref().map(|cost| cost.estimate.rows));
            object["estimated_convolutions"] = json!(cost.as_ref().map(|cost| cost.estimate.convolutions));
            crate::print(&format!("{object}\n"))?;
        } else {
            let read = |more: &[String]| Case::read(&self.case, &[&self.common.set, more].concat());
            let error_bars = expected_cost(&case, &read);
            crate::print(&summary(&case, &examined, cost.as_ref(), Some(error_bars)))?;
        }
        super::findings::strict(self.strict, &examined.findings)
    }
}

/// What is printed of a case; with `cost` also what a run takes, which takes a while to find.
pub fn text(case: &Case, examined: &Examination, cost: bool) -> String {
    let cost = if cost { cost::cost(case, &examined.description) } else { None };
    summary(case, examined, cost.as_ref(), None)
}

/// Lists the keys whose numbers have no unit.
fn note_bare_numbers(case: &Case) {
    const SHOWN: usize = 8;
    let keys = bare_numbers(&case.source);
    let more = if keys.len() > SHOWN { format!(" and {} more", keys.len() - SHOWN) } else { String::new() };
    if !keys.is_empty() {
        let shown = keys[..keys.len().min(SHOWN)].join(", ");
        crate::messages::message!("note: numbers without a unit are in SI (m, N, Pa, s, K): {shown}{more}");
    }
}

/// The retardation times, or how many and from where to where.
fn retardation(times: &[f64]) -> String {
    const SHOWN: usize = 6;
    let shown: Vec<String> = times.iter().map(|t| quantity(*t, "s")).collect();
    match shown.as_slice() {
        [first, .., last] if shown.len() > SHOWN => {
            format!("{} retardation times from {first} to {last}", shown.len())
        }
        _ => format!("retardation times {}", shown.join(", ")),
    }
}

/// "radius 10.00 mm", "Sq 1.000 µm, Sdq 0.1"; nothing for what its name says.
fn shape(surface: &SurfaceInput) -> Option<String> {
    let length = |value: f64| quantity(value, "m");
    let radius = surface.radius.map(|[x, y]| match x == y || y.is_infinite() {
        true => format!("radius {}", length(x)),
        false => format!("radii {} and {}", length(x), length(y)),
    });
    let slope = surface.slope.map(|slope| format!("slope {slope}"));
    let sq = surface.sq.map(|sq| format!("Sq {}", length(sq)));
    let sdq = surface.sdq.map(|sdq| format!("Sdq {sdq:.4}"));
    let parts: Vec<String> = [radius, slope, sq, sdq].into_iter().flatten().collect();
    (!parts.is_empty()).then(|| format!("{}: {}", surface.name, parts.join(", ")))
}

/// "12.00 µm", or "12.00 µm right after the load, 15.00 µm at the end"; over velocities at the highest and the lowest; of a load that
/// falls again at its largest value.
fn range(case: &Case, [first, last]: [f64; 2], words: impl Fn(f64) -> String) -> String {
    let [first, last] = [first, last].map(words);
    match (case.axis(), largest_before_the_end(case)) {
        _ if first == last => first,
        (Axis::Velocity, _) => format!("{first} at high velocities, {last} at low ones"),
        (_, Some(time)) => {
            format!("{first} to {last} under the largest load, at t = {}", quantity(time, "s"))
        }
        _ => format!("{first} right after the load, {last} at the end"),
    }
}

/// When the prescribed history is largest, if it is smaller at the end; `None` also for a load in several stages.
fn largest_before_the_end(case: &Case) -> Option<f64> {
    let ([Stage { course: Course::Given(history), .. }], end) =
        (&case.conditions.loading.stages[..], case.conditions.times.end())
    else {
        return None;
    };
    let time = history.time_of_largest(end);
    let largest = history.before(time).max(history.after(time));
    (history.before(end) < 0.99 * largest).then_some(time)
}

/// What is prescribed at most, and the contact to be expected: lines of a name and a value.
fn prospects(case: &Case, inputs: &Inputs) -> Vec<[String; 2]> {
    let grid = &case.conditions.grid;
    let mut lines = vec![];
    let mut line = |name: &str, value: String| lines.push([name.to_owned(), value]);
    if let (Some(load), Some(pressure)) = (inputs.largest_load, inputs.largest_mean_pressure) {
        let (load, pressure) = (quantity(load, grid.units("N")), quantity(pressure, "Pa"));
        line("load", format!("{load} at most, {pressure} over the domain"));
    }
    if let Some(approach) = inputs.largest_approach {
        line("approach", format!("{} at most", quantity(approach, "m")));
    }
    let strain = inputs.expected_pressure_over_modulus.map_or(String::new(), |p| format!(", p/E* {p:.2e}"));
    let acts = case.leakage.as_ref().is_some_and(|leak| leak.coupling.is_some());
    let without = match (inputs.adhesion.is_some(), acts) {
        (true, _) => " without adhesion",
        (_, true) => " without the pressure of the fluid",
        _ => "",
    };
    if let (Some(radii), Some(cells)) = (inputs.expected_contact_radius, inputs.expected_cells_across) {
        let radius = range(case, radii, |radius| quantity(radius, "m"));
        let of = if grid.is_line() { "half-width of the contact" } else { "contact radius" };
        line("expected", format!("{of}{without} {radius}, {cells:.0} cells across{strain}"));
    } else if let Some(shares) = inputs.expected_contact_share {
        let share = range(case, shares, |share| format!("{:.2} %", 100.0 * share));
        line("expected", format!("share of the domain in contact{without}: {share}{strain}"));
    }
    if let Some(law) = &case.describe().friction {
        let unit = if law.control == TangentialControl::Force { grid.units("N") } else { "m" };
        let [x, y] = law.largest.map(|largest| quantity(largest, unit));
        let [low, high] = law.coefficient.map(|mu| quantity(mu, ""));
        let mu = if low == high { low } else { format!("{low} to {high}") };
        let held = law.slides_at.map_or(String::new(), |time| {
            format!(
                "; at t = {} this is more than friction holds, and the run ends there",
                quantity(time, "s")
            )
        });
        let control = match law.control {
            TangentialControl::Force => "force",
            TangentialControl::Displacement => "displacement",
        };
        line("friction", format!("coefficient {mu}; {control} of at most {x} along x, {y} along y{held}"));
    }
    if let Some(law) = &case.conditions.wear {
        let [body, counterbody] = law.coefficients;
        let of = |k: f64, name: &str| (k > 0.0).then(|| format!("{k:e} m²/N of the {name}"));
        let bodies = [of(body, "body with the moving surfaces"), of(counterbody, "counterbody")];
        let bodies = bodies.into_iter().flatten().collect::<Vec<_>>().join(", ");
        let path = law.path.as_ref().map(|path| path.travel(0.0, case.conditions.times.end()));
        let way = path.map_or(String::new(), |way| format!(", sliding {}", quantity(way, "m")));
        let most = if law.cycles_tolerance.is_some() { "up to " } else { "" };
        let cycles = if law.cycles == 1.0 {
            String::new()
        } else {
            format!("; each cycle stands for {most}{}", law.cycles)
        };
        line("wear", format!("{bodies}{way}{cycles}"));
    }
    if let Some(flash) = &case.conditions.flash {
        let of = |body: &Conductor| {
            format!("{} W/(m K) and {} m²/s", quantity(body.conductivity, ""), quantity(body.diffusivity, ""))
        };
        let [slider, track] = flash.bodies.each_ref().map(of);
        line("flash", format!("slider, which carries the surfaces that move: {slider}; track: {track}"));
        let sheared = case.motion.as_ref().is_some_and(|motion| motion.shear_stress.is_some());
        let sources = [
            (flash.friction > 0.0).then(|| format!("friction {}", quantity(flash.friction, ""))),
            sheared.then(|| "the shear stress on the contact".to_owned()),
            flash.hysteresis.then(|| "the loss in the bodies".to_owned()),
        ];
        let sources: Vec<String> = sources.into_iter().flatten().collect();
        let time =
            flash.heated_for.map_or(String::new(), |time| format!(", heated for {}", quantity(time, "s")));
        let feedback = flash.feedback.as_ref().map_or(String::new(), |feedback| {
            format!("; the material is warmed by it from {:.1} °C", feedback.temperature - 273.15)
        });
        let heat = sources.join(" and ");
        line("", format!("heat of {heat}, partition \"{}\"{time}{feedback}", flash.partition.name()));
    }
    if let Some(adhesion) = &inputs.adhesion {
        let (work, range) = (quantity(adhesion.work, "J/m2"), quantity(adhesion.range, "m"));
        let strength = quantity(adhesion.strength, "Pa");
        let tabor = adhesion.tabor.map_or(String::new(), |tabor| format!("; Tabor's number {tabor:.2}"));
        line("adhesion", format!("{work} over {range}, {strength} at most{tabor}"));
        let [nx, ny] = adhesion.cells_needed;
        let fine = if adhesion.trap <= FINE_TRAP {
            "fine enough".to_owned()
        } else {
            format!("{nx} x {ny} cells are needed")
        };
        line("trap number", format!("{:.3} of {FINE_TRAP}: {fine}", adhesion.trap));
        if let Some(force) = adhesion.expected_pull_off {
            line(
                "pull-off",
                format!("{} expected of a relaxed sphere; a fast one takes more", quantity(-force, "N")),
            );
        }
    }
    lines
}

/// How the contact moves, and how far the memory of the material reaches then.
fn motion_lines(case: &Case) -> Vec<[String; 2]> {
    let Some(motion) = &case.motion else { return vec![] };
    let [x, y] = motion.direction.unit();
    let direction = match (x, y) {
        (1.0, 0.0) => "x".to_owned(),
        (0.0, 1.0) => "y".to_owned(),
        (x, y) => format!("{:.4}° from x", y.atan2(x).to_degrees()),
    };
    let way = if motion.rolls { "rolls along" } else { "slides along" };
    let speed = |v: f64| quantity(v, "m/s");
    let (words, fastest) = match &motion.travel {
        Travel::Steady(list) => {
            let ends = [list.first(), list.last()].map(|v| speed(v.copied().unwrap_or_default()));
            let fastest = list.last().copied().unwrap_or_default();
            (
                format!("{way} {direction} at {} velocities from {} to {}", list.len(), ends[0], ends[1]),
                fastest,
            )
        }
        Travel::Path(path) => {
            let end = case.conditions.times.end();
            let times = (0..=1000).map(|k| end * f64::from(k) / 1000.0);
            let fastest = times.clone().map(|t| path.velocity(t).abs()).fold(0.0, f64::max);
            let far = times.map(|t| path.position(t).abs()).fold(0.0, f64::max);
            let cells = far / motion.direction.cell(&case.conditions.grid);
            let far = quantity(far, "m");
            (
                format!("{way} {direction}, up to {far} ({cells:.0} cells) at {} at most", speed(fastest)),
                fastest,
            )
        }
    };
    let mut lines = vec![["motion".to_owned(), words]];
    let parts =
        std::iter::once(&case.conditions.creep).chain(case.conditions.thermal.iter().map(|body| &body.creep));
    let all: Vec<_> = parts.flat_map(|creep| creep.terms.iter()).collect();
    let total: f64 = all.iter().map(|term| term.compliance).sum();
    // The branch that carries most.
    let largest = all.into_iter().max_by(|a, b| a.compliance.total_cmp(&b.compliance));
    if let Some(term) = largest.filter(|_| fastest > 0.0) {
        let reach = fastest * term.retardation_time;
        lines.push([
            String::new(),
            format!(
                "memory of the largest branch ({}, {:.0} % of the retarded compliance) reaches {} at {}: {} cells",
                quantity(term.retardation_time, "s"),
                100.0 * term.compliance / total,
                quantity(reach, "m"),
                speed(fastest),
                quantity(reach / motion.direction.cell(&case.conditions.grid), "")
            ),
        ]);
    }
    lines
}

/// What will be computed of the stress below the surface, and what it takes.
fn stress_lines(stress: &StressDescription, seconds: Option<f64>) -> Vec<[String; 2]> {
    let range = match stress.depth_range {
        Some([first, last]) if stress.depth_count > 1 => {
            format!("{} depths from {} to {}", stress.depth_count, quantity(first, "m"), quantity(last, "m"))
        }
        Some([only, _]) => format!("depth {}", quantity(only, "m")),
        None => format!("{} depths down to the width of the contact", stress.depth_count),
    };
    let times = stress.times.map_or("the stored times".to_owned(), |n| crate::format::counted(n, "time"));
    let mut lines = vec![[
        "stress".to_owned(),
        format!("of {} (Poisson's ratio {}), {range}, at {times}", stress.body, stress.poisson),
    ]];
    let seconds =
        seconds.map_or(String::new(), |seconds| format!(", roughly {} after the run", roughly(seconds)));
    lines.push([String::new(), format!("{} of memory{seconds}", bytes(stress.memory_bytes as f64))]);
    if !stress.fields.is_empty() {
        let size =
            stress.result_bytes.map_or(String::new(), |size| format!(", up to {}", bytes(size as f64)));
        lines.push([String::new(), format!("stored at each depth: {}{size}", stress.fields.join(", "))]);
    }
    lines
}

/// A duration with two digits.
fn roughly(seconds: f64) -> String {
    if seconds <= 0.0 {
        return duration(0.0);
    }
    let unit = 10f64.powf(seconds.log10().floor() - 1.0);
    duration((seconds / unit).round() * unit)
}

/// "3 MPa", or "3 MPa instantaneous, 1 MPa relaxed".
fn moduli(instantaneous: Option<f64>, relaxed: f64) -> String {
    let relaxed = quantity(relaxed, "Pa");
    match instantaneous.map(|modulus| quantity(modulus, "Pa")) {
        Some(instantaneous) if instantaneous == relaxed => relaxed,
        Some(instantaneous) => format!("{instantaneous} instantaneous, {relaxed} relaxed"),
        None => format!("{relaxed} relaxed, instantaneously rigid"),
    }
}

/// "1 mm x 2 mm".
fn lengths(sides: &[f64]) -> String {
    let sides: Vec<String> = sides.iter().map(|side| quantity(*side, "m")).collect();
    sides.join(" x ")
}

fn summary(case: &Case, examined: &Examination, cost: Option<&Cost>, error_bars: Option<f64>) -> String {
    let (d, inputs) = (&examined.description, &examined.inputs);
    let title = d.title.as_deref().unwrap_or(&case.name);
    let mut text = format!("{title}\n");
    let mut line = |name: &str, value: String| text += &format!("  {name:<12}{value}\n");
    line(
        "domain",
        match (d.cells.as_slice(), lengths(&d.spacing), lengths(&d.size)) {
            ([n], cell, size) => {
                format!("a line of {n} cells of {cell}, {size}, {}, plane strain", d.boundary)
            }
            (cells, cell, size) => {
                let cells: Vec<String> = cells.iter().map(usize::to_string).collect();
                format!("{} cells of {cell}, {size}, {}", cells.join(" x "), d.boundary)
            }
        },
    );
    line("gap", d.surfaces.join(" + "));
    for surface in inputs.surfaces.iter().filter_map(shape) {
        line("", surface);
    }
    for prepared in &d.preparation {
        line("prepared", prepared.surface.clone());
        for step in &prepared.steps {
            line("", format!("- {step}"));
        }
    }
    let modulus = moduli(d.instantaneous_modulus, d.relaxed_modulus);
    line("bodies", format!("{}; contact modulus {modulus}", d.bodies.join(", ")));
    for modulus in &inputs.moduli {
        let name = if modulus.modulus == "shear" { "shear modulus" } else { "Young's modulus" };
        let value = moduli(modulus.instantaneous, modulus.relaxed);
        line("", format!("{}: {name} {value}", modulus.body));
    }
    if let Some(layers) = &d.layers {
        for body in &layers.bodies {
            line("layers", body.clone());
        }
        if let (Some(nodes), Some(misfit)) = (layers.nodes, layers.misfit) {
            let text = format!(
                "waves of different lengths creep differently: {nodes} retardation times, largest error {misfit:.1e}"
            );
            line("", text);
        }
        line("", "equivalent half-space:".into());
        for (name, wave) in ["longest", "shortest"].iter().zip(&layers.waves) {
            let modulus = moduli(wave.instantaneous_modulus, wave.relaxed_modulus);
            let length = quantity(wave.length, "m");
            // Of a free domain the contact decides, not its waves: strain and compliance of a contact of radius a are those of q = 1/a.
            let radius = quantity(wave.length / std::f64::consts::TAU, "m");
            let place = match d.boundary {
                "free" => format!("contact of radius {radius}"),
                _ => format!("{name} wave, {length}"),
            };
            line("", format!("- {place}: {modulus}"));
        }
    }
    if !d.retardation_times.is_empty() {
        line("creep", retardation(&d.retardation_times));
    }
    for report in &d.materials {
        for text in super::material::source(report) {
            line("material", format!("{}: {text}", report.body));
        }
    }
    if let Some([low, high]) = d.temperature {
        let celsius = |kelvin: f64| format!("{:.2} °C", kelvin - 273.15);
        line(
            "temperature",
            if low == high { celsius(low) } else { format!("{} to {}", celsius(low), celsius(high)) },
        );
    }
    if let Some(hardness) = d.hardness {
        line("hardness", quantity(hardness, "Pa"));
    }
    if let Some([least, most]) = d.hardness_of_cells {
        line("hardness", format!("{} to {}, by cell", quantity(least, "Pa"), quantity(most, "Pa")));
    }
    for [name, value] in prospects(case, inputs) {
        line(&name, value);
    }
    let end = quantity(d.end, "s");
    for [name, value] in motion_lines(case) {
        line(&name, value);
    }
    line(
        "time",
        match d.rows {
            Some(rows) if case.axis() == Axis::Velocity => {
                format!("{} of motion, one for each velocity", counted(rows, "steady state"))
            }
            Some(rows) => format!("{rows} rows to {end}, {} scheme", d.scheme),
            None => {
                format!("number of rows found by the run, end at {end} at the latest, {} scheme", d.scheme)
            }
        },
    );
    if d.stages > 1 {
        line("stages", d.stages.to_string());
    }
    line(
        "output",
        format!(
            "{} at {}, in {}",
            if d.fields.is_empty() { "no fields".to_owned() } else { d.fields.join(", ") },
            match (d.stored_rows, d.result_bytes) {
                (Some(rows), Some(size)) => format!("{rows} rows, up to {}", bytes(size as f64)),
                _ => "some rows".to_owned(),
            },
            case.output.path.display()
        ),
    );
    if let Some(stress) = &d.stress {
        let lines = stress_lines(stress, cost::stress_seconds(case, stress));
        lines.into_iter().for_each(|[name, value]| line(&name, value));
    }
    if let Some(leak) = &case.leakage {
        let memory = bytes(leak.bytes(case.conditions.grid.len()));
        let times = match &leak.times {
            Some(times) => crate::format::counted(times.len(), "time"),
            None => "the stored times".to_owned(),
        };
        let seconds = cost::leak_seconds(case, d);
        let seconds = seconds.map_or(String::new(), |s| format!(", roughly {} after the run", roughly(s)));
        line("leakage", format!("{}, at {times}, up to {memory} of memory{seconds}", leak.words()));
    }
    if let Some(seal) = &case.seal {
        let [least, most] = seal.runs();
        let seeds = counted(seal.seeds, "seed");
        line(
            "whole seal",
            format!(
                "asperity seal runs this patch {least} times at least and {most} at most, {seeds} included"
            ),
        );
    }
    line("memory", format!("about {}", bytes(d.memory_bytes as f64)));
    if let Some(cost) = cost {
        let threads = counted(rayon::current_num_threads(), "thread");
        let found = cost.estimate;
        let after = cost::seconds_after(case, d);
        let whole = match after > 0.1 * cost.seconds {
            true => format!("; {} with what comes after it", roughly(cost.seconds + after)),
            false => String::new(),
        };
        line(
            "run time",
            format!(
                "roughly {} on {threads}: about {} and {} (estimated on a coarse grid){whole}",
                roughly(cost.seconds),
                counted(found.rows, "row"),
                counted(found.convolutions, "convolution")
            ),
        );
    }
    if let Some(times) = error_bars {
        line("error bars", format!("--error-bars takes about {times:.1} times the run more"));
    }
    for finding in &examined.findings {
        line(finding.severity.as_str(), format!("{} [{}]", finding.text, finding.code));
    }
    text
}
