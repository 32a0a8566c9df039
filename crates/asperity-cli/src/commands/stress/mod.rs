//! `asperity stress`: the stress below the surface of a result.

pub(super) mod summary;

use std::time::{Duration, Instant};

use asperity::finding::OF_STRESS;
use asperity::stress::StressQuantity;
use asperity_io::case::{CaseError, fragment};
use asperity_io::export::volume;
use asperity_io::quantity::Number;
use asperity_io::store::{At, Reader, Writer};
use asperity_io::stress::{
    Below, StressBody, StressError, StressPlan, below_at, bodies_of, evaluate, of_result, refuse_layers,
};
use asperity_report::result::stress_figure;

use crate::args::Stress;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::input::{note_unit, option};
use crate::messages::message;
use crate::verb::{Threads, Verb};

/// Fields of a volume where none are named.
const USUAL: [StressQuantity; 3] = [StressQuantity::Mises, StressQuantity::Tresca, StressQuantity::Tension];

impl Verb for Stress {
    fn files(&self) -> Files {
        Files::default().reads([&self.result]).draws(&self.plot).writes(&self.output).force(self.force)
    }

    fn threads(&self) -> Threads {
        Threads::of(self.threads)
    }

    /// Computes and stores the stress, or shows the one that is stored; then draws and writes what is asked for.
    fn run(&self) -> Result<(), Failure> {
        let reader = Reader::open(&self.result)?;
        let plan = plan(self, &reader)?;
        let stored = Below::of(&reader)?;
        let below = match stored {
            Some(below) if StressPlan::of(&below.set, &reader) == plan => below,
            _ if self.no_store => of_result(&reader, &plan, &crate::interrupt::flag()).map_err(ended)?,
            stored => {
                if let Some(stored) = stored {
                    let words = StressPlan::of(&stored.set, &reader).words();
                    message!("replaces the stored stress {words} (--no-store computes without storing)");
                }
                store(self, &plan)?
            }
        };
        let at = match self.time {
            Some(time) => At::Time(time.get()),
            None => below.worst().map_or(At::Last, |worst| At::Index(worst.index)),
        };
        let index = reader.index(at)?;
        let mut written = vec![];
        if let Some(path) = &self.plot {
            let one = Reader::open(&self.result)?;
            let shown = match below.instants.iter().any(|instant| instant.index == index) {
                true => below.clone(),
                false => below_at(&one, &plan, at).map_err(ended)?,
            };
            let figure = stress_figure(&one, &shown, index)?;
            crate::commands::picture::write(&figure, path, self.force)?;
            written.push(path.display().to_string());
        }
        if let Some(path) = &self.output {
            let quantities =
                if plan.quantities.is_empty() { USUAL.to_vec() } else { plan.quantities.clone() };
            let files = volume(&reader, &plan, at, &quantities, path, self.force)?;
            written.extend(files.iter().map(|path| path.display().to_string()));
        }
        let shown = below.instants.iter().find(|instant| instant.index == index).or(below.worst());
        if self.json {
            return crate::print(&format!("{}\n", summary::object(&below, &written)));
        }
        super::findings::print(&below.findings());
        let drawn = self.plot.is_some() || self.output.is_some();
        let mut text = summary::text(&below, shown, drawn);
        written.iter().for_each(|path| text += &format!("{path}\n"));
        crate::print(&text)
    }
}

fn ended(error: StressError) -> Failure {
    match error {
        StressError::Solve(asperity::Error::Interrupted) => {
            Failure::Interrupted("the stress is not stored".into())
        }
        error => error.into(),
    }
}

/// Computes the stress and adds it to the result.
fn store(args: &Stress, plan: &StressPlan) -> Result<Below, Failure> {
    let mut writer = Writer::amend(&args.result)?;
    /// Time between two messages.
    const OFTEN: Duration = Duration::from_secs(2);
    let mut printed_at = Instant::now();
    let progress = |done: usize, of: usize| {
        if of > 1 && !args.json && done < of && printed_at.elapsed() > OFTEN {
            printed_at = Instant::now();
            message!("stress below the surface: time {} of {of}", done + 1);
        }
    };
    let below = evaluate(&mut writer, plan, &crate::interrupt::flag(), progress).map_err(ended)?;
    let others = writer.findings().iter().filter(|finding| !OF_STRESS.contains(&finding.code.as_ref()));
    let findings = others.cloned().chain(below.findings()).collect();
    writer.note(findings)?;
    Ok(below)
}

/// What takes a key out.
const NONE: &str = "none";

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

/// What is asked for; what is not said is as it is stored, or as the case says.
fn plan(args: &Stress, reader: &Reader) -> Result<StressPlan, Failure> {
    refuse_layers(reader).map_err(ended)?;
    let mut bodies = bodies_of(reader);
    if let Some(ratio) = args.poisson.map(Number::get) {
        if ratio < 0.0 {
            refuse!("--poisson is {ratio}, but must be a Poisson's ratio from 0 to 0.5");
        }
        if bodies.is_empty() {
            bodies.push(StressBody { name: "body 1".into(), poisson: None });
        }
        bodies.iter_mut().for_each(|body| body.poisson = Some(ratio.into()));
    }
    let stored = StressPlan::known(reader);
    let known = bodies.iter().any(|body| body.poisson.is_some());
    if !known && !reader.header().setup.contains_key("poisson") {
        let path = args.result.display();
        refuse!("{path} does not say the Poisson's ratio of its bodies; give --poisson NU");
    }
    let optional = ["components", "threshold", "yield_stress", "rolling"];
    let is_taken_out = |(key, text): &(&str, &str)| text.trim() == NONE && optional.contains(key);
    let mut given: Vec<(&str, &str)> = keys(args).filter(|given| !is_taken_out(given)).collect();
    if let (Some(stored), None) = (&stored, &args.body)
        && bodies.iter().any(|body| body.name == stored.body)
    {
        given.push(("body", &stored.body));
    }
    for (key, unit) in [("depths", "m"), ("threshold", "Pa"), ("yield_stress", "Pa")] {
        let texts = given.iter().filter(|given| given.0 == key).flat_map(|given| given.1.split(','));
        texts.for_each(|text| note_unit(&option(key), text, unit));
    }
    let mut plan = fragment::stress(&given, &reader.header().grid, &bodies).map_err(faults)?;
    if let Some(stored) = stored {
        let keeps = |key: &str| !keys(args).any(|given| given.0 == key);
        let poisson = if args.poisson.is_none() && keeps("body") { stored.poisson } else { plan.poisson };
        plan = StressPlan {
            depths: if keeps("depths") { stored.depths } else { plan.depths },
            quantities: if keeps("components") { stored.quantities } else { plan.quantities },
            threshold: if keeps("threshold") { stored.threshold } else { plan.threshold },
            yield_stress: if keeps("yield_stress") { stored.yield_stress } else { plan.yield_stress },
            rolling: if keeps("rolling") { stored.rolling } else { plan.rolling },
            times: stored.times,
            poisson,
            ..plan
        };
    }
    if let Some(list) = &args.times {
        plan.times = super::times(list)?;
    }
    Ok(plan)
}

fn faults(faults: Vec<CaseError>) -> Failure {
    let sentence = |fault: &CaseError| {
        let help = fault.help.as_ref().map(|help| format!("; {help}")).unwrap_or_default();
        // The table of a case as a whole has no option.
        let option = match fault.key.as_str() {
            "" | "stress" => String::new(),
            key => option(key) + " ",
        };
        format!("{option}{}{help}", fault.message)
    };
    Failure::input(faults.iter().map(sentence).collect::<Vec<_>>().join("\n"))
}
