//! `asperity plot`: one figure of a result, or of several.

use std::path::Path;

use asperity_io::case::quantity::Length;
use asperity_io::store::{At, Reader};
use asperity_report::figure::Form;
use asperity_report::result::{Line, Options, Plot, figure, together};

use super::instant;
use crate::args;
use crate::failure::Failure;
use crate::words::read;

/// Draws the figure and prints where it is.
pub fn run(args: &args::Plot) -> Result<(), Failure> {
    let Some(plot) = Plot::from_name(&args.what) else {
        let names: Vec<_> = Plot::ALL.iter().map(|plot| plot.name()).collect();
        return Err(Failure::input(format!(
            "there is no figure \"{}\"; choose one of {}",
            args.what,
            names.join(", ")
        )));
    };
    let told = |error: &dyn std::fmt::Display| Failure::input(error.to_string());
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let names: Vec<String> = args.results.iter().map(|path| stem(path)).collect();
    let output =
        args.output.clone().unwrap_or_else(|| format!("{}-{}.png", names.join("-"), plot.name()).into());
    Form::of(&output).map_err(|error| told(&error))?;
    let place = args.at.as_deref().map(|text| read::<Length>("--at", text, "20 um")).transpose()?;
    let place = place.map(|place| place.get());
    let line = if args.along == "x" { Line::AlongX(place) } else { Line::AlongY(place) };
    let log = (args.log_time || args.linear_time).then_some(args.log_time);
    let mut all = vec![];
    for (path, name) in args.results.iter().zip(names) {
        let reader = Reader::open(path).map_err(|error| told(&error))?;
        let at = instant(&reader, args.time.as_deref())?;
        all.push((name, reader, at));
    }
    let options = |at: At| Options { at, line, log, title: args.title.clone() };
    let figure = match &all[..] {
        [(_, reader, at)] => figure(reader, plot, &options(*at)),
        all => together(all, plot, &options(At::Last)),
    };
    let figure = figure.map_err(|error| told(&error))?;
    figure.write(&output, args.force).map_err(|error| told(&error))?;
    crate::print(&format!("{}\n", output.display()))
}
