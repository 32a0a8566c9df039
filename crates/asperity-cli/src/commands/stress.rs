//! `asperity stress`: the stress below the surface of a result.

use asperity::stress::StressQuantity;
use asperity_io::case::fragment::{self, Fault};
use asperity_io::case::quantity::range::NonNegative;
use asperity_io::case::quantity::{Number, Time};
use asperity_io::export::volume;
use asperity_io::finding;
use asperity_io::store::{At, Reader, Writer};
use asperity_io::stress::{
    Below, Instant, StressBody, StressError, StressPlan, below_at, bodies_of, evaluate, first_yield,
    of_result,
};
use asperity_report::figure::Form;
use asperity_report::result::stress_figure;
use serde_json::{Map, Value, json};

use crate::args::Stress;
use crate::failure::Failure;
use crate::words::{quantity, read};

/// Fields of a volume where none are named.
const USUAL: [StressQuantity; 3] = [StressQuantity::Mises, StressQuantity::Tresca, StressQuantity::Tension];

/// Computes and stores the stress, or shows the one that is stored; then draws and writes what is asked for.
pub fn run(args: &Stress) -> Result<(), Failure> {
    if let Some(path) = &args.plot {
        Form::of(path).map_err(told)?;
    }
    for path in args.plot.iter().chain(&args.output) {
        super::free(path, args.force)?;
    }
    let reader = Reader::open(&args.result).map_err(told)?;
    let plan = plan(args, &reader)?;
    let asked = keys(args).next().is_some() || args.poisson.is_some() || args.times.is_some();
    let stored = if asked { None } else { Below::of(&reader).map_err(told)? };
    let below = match stored {
        Some(below) => below,
        None if args.no_store => of_result(&reader, &plan, &crate::interrupt::flag()).map_err(ended)?,
        None => store(args, &plan)?,
    };
    let at = match &args.time {
        Some(text) => At::Time(read::<Time>("--time", text, "500 s")?.get()),
        None => below.worst().map_or(At::Last, |worst| At::Index(worst.index)),
    };
    let index = reader.index(at).map_err(told)?;
    let mut written = vec![];
    if let Some(path) = &args.plot {
        let one = Reader::open(&args.result).map_err(told)?;
        let shown = match below.instants.iter().any(|instant| instant.index == index) {
            true => below.clone(),
            false => below_at(&one, &plan, at).map_err(ended)?,
        };
        let figure = stress_figure(&one, &shown, index).map_err(told)?;
        figure.write(path, args.force).map_err(told)?;
        written.push(path.display().to_string());
    }
    if let Some(path) = &args.output {
        let quantities = if plan.quantities.is_empty() { USUAL.to_vec() } else { plan.quantities.clone() };
        let files = volume(&reader, &plan, at, &quantities, path, args.force).map_err(told)?;
        written.extend(files.iter().map(|path| path.display().to_string()));
    }
    let shown = below.instants.iter().find(|instant| instant.index == index).or(below.worst());
    if args.json {
        return crate::print(&format!("{}\n", object(&reader, &below, &written)));
    }
    super::findings::tell(&below.findings(&reader.header().grid));
    let mut text = text(&below, shown);
    written.iter().for_each(|path| text += &format!("{path}\n"));
    crate::print(&text)
}

fn told(error: impl std::fmt::Display) -> Failure {
    Failure::input(error.to_string())
}

fn ended(error: StressError) -> Failure {
    match error {
        StressError::Solve(asperity::Error::Interrupted) => {
            Failure::Interrupted("the stress is not stored".into())
        }
        error => told(error),
    }
}

/// Computes the stress and adds it to the result.
fn store(args: &Stress, plan: &StressPlan) -> Result<Below, Failure> {
    let mut writer = Writer::amend(&args.result).map_err(told)?;
    let tell = |done: usize, of: usize| {
        if of > 1 && !args.json && done < of {
            crate::talk::say!("stress below the surface: time {} of {of}", done + 1);
        }
    };
    let below = evaluate(&mut writer, plan, &crate::interrupt::flag(), tell).map_err(ended)?;
    let reader = Reader::open(&args.result).map_err(told)?;
    let new = below.findings(&reader.header().grid);
    let codes = [
        asperity::finding::STRESS_UNRESOLVED,
        asperity::finding::STRESS_AT_DEEPEST,
        asperity::finding::STRESS_TIMES_MISS_PEAK,
        asperity::finding::YIELD_EXCEEDED,
    ];
    let others = writer.findings().iter().filter(|finding| !codes.contains(&finding.code.as_ref())).cloned();
    let findings = others.chain(new).collect();
    writer.note(findings).map_err(told)?;
    Ok(below)
}

/// The keys of `[stress]` that are given.
fn keys(args: &Stress) -> impl Iterator<Item = (&'static str, &str)> {
    let all = [
        ("depths", &args.depths),
        ("body", &args.body),
        ("components", &args.components),
        ("threshold", &args.threshold),
        ("yield_stress", &args.yield_stress),
        ("rolling", &args.rolling),
    ];
    all.into_iter().filter_map(|(key, text)| Some((key, text.as_deref()?)))
}

/// What is asked for; what is not said is as it is stored.
fn plan(args: &Stress, reader: &Reader) -> Result<StressPlan, Failure> {
    if reader.header().setup.contains_key("layer_separable") {
        let path = args.result.display();
        let message =
            format!("{path} is of bodies of layers: the stress below their surface is not computed yet");
        return Err(Failure::input(message));
    }
    let mut bodies = bodies_of(reader);
    if let Some(text) = &args.poisson {
        let ratio = read::<Number<NonNegative>>("--poisson", text, "0.3")?.get();
        if ratio > 0.5 {
            return Err(Failure::input(format!(
                "--poisson is {ratio}, but must be a Poisson's ratio from 0 to 0.5"
            )));
        }
        if bodies.is_empty() {
            bodies.push(StressBody { name: "body 1".into(), poisson: None });
        }
        bodies.iter_mut().for_each(|body| body.poisson = Some(ratio));
    }
    let stored = reader.stress().map(|set| StressPlan::of(set, reader));
    let known = bodies.iter().any(|body| body.poisson.is_some());
    if !known && !reader.header().setup.contains_key("poisson") {
        let path = args.result.display();
        return Err(Failure::input(format!(
            "{path} does not say the Poisson's ratio of its bodies; give --poisson NU"
        )));
    }
    let mut given: Vec<(&str, &str)> = keys(args).collect();
    if let (Some(stored), None) = (&stored, &args.body)
        && bodies.iter().any(|body| body.name == stored.body)
    {
        given.push(("body", &stored.body));
    }
    let mut plan = fragment::stress(&given, &reader.header().grid, &bodies).map_err(faults)?;
    if let Some(stored) = stored {
        let is_new = |key: &str| keys(args).any(|given| given.0 == key);
        if !is_new("depths") {
            plan.depths = stored.depths;
        }
        if !is_new("components") {
            plan.quantities = stored.quantities;
        }
        if args.poisson.is_none() && !is_new("body") {
            plan.poisson = stored.poisson;
        }
        plan.threshold = plan.threshold.or(stored.threshold);
        plan.yield_stress = plan.yield_stress.or(stored.yield_stress);
        plan.rolling = plan.rolling.or(stored.rolling);
        plan.times = stored.times;
    }
    if let Some(list) = &args.times {
        let time = |text: &str| Ok(read::<Time<NonNegative>>("--times", text, "1 s,10 s")?.get());
        plan.times = Some(list.split(',').map(time).collect::<Result<_, Failure>>()?);
    }
    Ok(plan)
}

fn faults(faults: Vec<Fault>) -> Failure {
    let sentence = |fault: &Fault| {
        let help = fault.help.as_ref().map(|help| format!("; {help}")).unwrap_or_default();
        let option =
            if fault.key.is_empty() { String::new() } else { format!("--{} ", fault.key.replace('_', "-")) };
        format!("{option}{}{help}", fault.message)
    };
    Failure::input(faults.iter().map(sentence).collect::<Vec<_>>().join("\n"))
}

fn object(reader: &Reader, below: &Below, written: &[String]) -> Value {
    let set = &below.set;
    let over = |number: &dyn Fn(&Instant) -> Value| below.instants.iter().map(number).collect::<Value>();
    let mut object = Map::new();
    object.insert("body".into(), json!(set.body));
    object.insert("poisson".into(), json!(set.poisson));
    object.insert("depths".into(), json!(set.depths));
    object.insert("times".into(), over(&|instant| json!(instant.time)));
    object.insert("loads".into(), over(&|instant| json!(instant.load)));
    for series in set.scalars() {
        object.insert(series.name.into(), over(&|instant| json!(below.number(instant, series.name))));
    }
    for series in set.profiles() {
        object.insert(series.name.into(), over(&|instant| json!(below.profile(instant, series.name))));
    }
    object.insert("threshold".into(), json!(set.threshold));
    object.insert("yield_stress".into(), json!(set.yield_stress));
    object.insert("first_yield".into(), first_yield(below).map_or(Value::Null, |first| first.to_json()));
    object.insert("findings".into(), finding::list(&below.findings(&reader.header().grid)));
    object.insert("written".into(), json!(written));
    Value::Object(object)
}

/// Lines of columns, each as wide as its widest word.
fn table(lines: &[Vec<String>]) -> String {
    let columns = lines.first().map_or(0, Vec::len);
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |line: &Vec<String>| {
        let words: Vec<String> =
            line.iter().zip(&widths).map(|(word, width)| format!("{word:<width$}")).collect();
        format!("  {}\n", words.join("  ").trim_end())
    };
    lines.iter().map(line).collect()
}

/// A number with its unit; a dash where there is none.
fn number(value: f64, unit: &str) -> String {
    if value.is_finite() { quantity(value, unit) } else { "-".into() }
}

fn text(below: &Below, shown: Option<&Instant>) -> String {
    let set = &below.set;
    let ends =
        [set.depths.first(), set.depths.last()].map(|depth| number(depth.copied().unwrap_or(f64::NAN), "m"));
    let mut text = format!(
        "Stress below the surface of {} (Poisson's ratio {}), {} from {} to {}\n\n",
        set.body,
        set.poisson,
        crate::words::counted(set.depths.len(), "depth"),
        ends[0],
        ends[1]
    );
    for (name, key) in
        [("von Mises", "max_mises"), ("shear (s1 - s3)/2", "max_tresca"), ("principal", "max_tension")]
    {
        let head =
            ["time", "load", &format!("largest {name}"), "depth", "x", "y"].map(str::to_owned).to_vec();
        let line = |instant: &Instant| {
            let place =
                ["depth", "x", "y"].map(|part| number(below.number(instant, &format!("{key}_{part}")), "m"));
            let [depth, x, y] = place;
            let value = number(below.number(instant, key), "Pa");
            vec![number(instant.time, "s"), number(instant.load, "N"), value, depth, x, y]
        };
        let lines: Vec<_> = std::iter::once(head).chain(below.instants.iter().map(line)).collect();
        text += &table(&lines);
        text.push('\n');
    }
    let extra = set.scalars().into_iter().skip(12).collect::<Vec<_>>();
    if !extra.is_empty() {
        let head = std::iter::once("time").chain(extra.iter().map(|series| series.name));
        let head: Vec<String> = head.map(|name| name.replace('_', " ")).collect();
        let line = |instant: &Instant| {
            let numbers = extra.iter().map(|series| number(below.number(instant, series.name), series.units));
            std::iter::once(number(instant.time, "s")).chain(numbers).collect()
        };
        let lines: Vec<_> = std::iter::once(head).chain(below.instants.iter().map(line)).collect();
        text += &table(&lines);
        text.push('\n');
    }
    if let Some(threshold) = set.threshold {
        text +=
            &format!("stressed volume: where the von Mises stress exceeds {}\n\n", quantity(threshold, "Pa"));
    }
    if let Some(instant) = shown {
        text += &format!("largest stress by depth at t = {}\n", number(instant.time, "s"));
        let profiles = set.profiles();
        let head = profiles.iter().map(|series| {
            series.name.trim_end_matches("_by_depth").replace('_', " ").replace("tresca", "shear (s1 - s3)/2")
        });
        let mut lines = vec![std::iter::once("depth".to_owned()).chain(head).collect::<Vec<_>>()];
        for (n, depth) in set.depths.iter().enumerate() {
            let numbers = profiles.iter().map(|series| number(below.profile(instant, series.name)[n], "Pa"));
            lines.push(std::iter::once(number(*depth, "m")).chain(numbers).collect());
        }
        text += &table(&lines);
        text.push('\n');
    }
    if let (Some(limit), Some(first)) = (set.yield_stress, first_yield(below)) {
        text += &format!("yield stress {}: {}\n", quantity(limit, "Pa"), first.sentence());
        text += "(the hardness, which limits the pressure, is another number: about 2.8 times the yield stress of a metal)\n";
    }
    text
}
