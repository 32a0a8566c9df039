//! `asperity plot`: one figure of a result, or of several, or an animation.

mod options;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use asperity_io::quantity::Time;
use asperity_io::store::{At, Reader};
use asperity_report::animation::{Course, Frames, Motion, animation};
use asperity_report::figure::FigureError;
use asperity_report::result::{Options, Plot, PlotError, common_limits, figure, together};
use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::instant;
use crate::args;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::format::counted;
use crate::input::meant;
use crate::verb::Verb;

/// Whether a command line names a result but not what to draw of it: the one word of two that `asperity plot` needs is a path.
pub fn lacks_figure(words: &[OsString], error: &clap::Error) -> bool {
    let missing = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::Strings(missing)) => missing.as_slice(),
        _ => &[],
    };
    let is_figure = |word: &OsString| word.to_str().is_some_and(|word| Plot::from_name(word).is_some());
    words.get(1).is_some_and(|word| word == "plot")
        && error.kind() == ErrorKind::MissingRequiredArgument
        && missing.len() == 1
        && !words.iter().any(is_figure)
}

/// What to draw is missing.
pub fn no_figure() -> Failure {
    Failure::input(format!(
        "what to draw is missing: asperity plot RESULT WHAT, with WHAT one of {}",
        Plot::names()
    ))
}

impl Verb for args::Plot {
    fn files(&self) -> Files {
        Files::default().reads(&self.results).draws(self.figure()).writes(&self.animate).force(self.force)
    }

    /// Draws the figure and prints where it is.
    fn run(&self) -> Result<(), Failure> {
        let Some(plot) = Plot::from_name(&self.what) else {
            return Err(match Path::new(&self.what).exists() {
                true => no_figure(),
                false => {
                    let near = meant(&self.what, &Plot::all().map(Plot::name).collect::<Vec<_>>());
                    Failure::input(format!(
                        "there is no figure \"{}\"{near}; choose one of {}",
                        self.what,
                        Plot::names()
                    ))
                }
            });
        };
        options::check(self, plot)?;
        let readers = super::labels::open(&self.results)?;
        crate::commands::answers::units_of(&self.unit, &readers)?;
        let all: Vec<(String, Reader)> =
            super::labels::of(&self.labels, &readers)?.into_iter().zip(readers).collect();
        match &self.animate {
            Some(path) => animate(self, plot, &all, path),
            None => draw(self, plot, all),
        }
    }
}

impl args::Plot {
    /// The figure that is written; `None` for an animation.
    fn figure(&self) -> Option<PathBuf> {
        let stems = self.results.iter().map(|path| path.file_stem().unwrap_or_default().to_string_lossy());
        let usual = || format!("{}-{}.png", stems.collect::<Vec<_>>().join("-"), self.what).into();
        let is_drawn = self.animate.is_none() && Plot::from_name(&self.what).is_some();
        is_drawn.then(|| self.output.clone().unwrap_or_else(usual))
    }
}

fn draw(args: &args::Plot, plot: Plot, all: Vec<(String, Reader)>) -> Result<(), Failure> {
    let output = args.figure().unwrap_or_default();
    let mut chosen = Options::default();
    if let Some((_, first)) = all.first() {
        chosen = options::of(args, plot, first)?;
    }
    if args.same_colours {
        let readers: Vec<&Reader> = all.iter().map(|(_, reader)| reader).collect();
        chosen.limits = common_limits(&readers, plot, &chosen)?;
    }
    let at = |reader: &Reader| instant(reader, args.time.as_deref());
    let drawn = match &all[..] {
        [(_, reader)] => figure(reader, plot, &Options { at: at(reader)?, ..chosen }),
        _ => {
            let all = all.into_iter().map(|(name, reader)| {
                let at = at(&reader)?;
                Ok((name, reader, at))
            });
            together(&all.collect::<Result<Vec<_>, Failure>>()?, plot, &chosen)
        }
    };
    super::picture::write(&drawn?, &output, args.force)?;
    crate::print(&format!("{}\n", output.display()))
}

fn animate(args: &args::Plot, plot: Plot, all: &[(String, Reader)], path: &Path) -> Result<(), Failure> {
    let [(_, reader)] = all else {
        refuse!("--animate shows one result; give one");
    };
    Motion::of(path)?;
    let usual = Course::default();
    let course = Course {
        duration: args.duration.map(Time::get),
        frames: args.frames.map_or(usual.frames, |frames| frames as usize),
    };
    let chosen = options::of(args, plot, reader)?;
    let last = Options { at: At::Last, ..chosen };
    super::picture::warn_of_missing_letters(&figure(reader, plot, &last)?);
    match animation(reader, plot, &last, course, path, args.force) {
        Ok(Frames { shown, without_contact }) => {
            if without_contact > 0 {
                crate::messages::message!(
                    "{} without contact: left out",
                    counted(without_contact, "stored time")
                );
            }
            crate::print(&format!("{}: {shown} frames\n", path.display()))
        }
        Err(PlotError::Figure(FigureError::Drawing(why))) => {
            Err(Failure::System(format!("cannot write {}: {why}", path.display())))
        }
        Err(error) => Err(error.into()),
    }
}
