//! `asperity plot`: one figure of a result.

use asperity_io::case::quantity::{Length, Time};
use asperity_io::store::{At, Reader};
use asperity_report::figure::Form;
use asperity_report::result::{Line, Options, Plot, figure};

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
    let output = args.output.clone().unwrap_or_else(|| {
        let stem = args.result.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        format!("{stem}-{}.png", plot.name()).into()
    });
    Form::of(&output).map_err(|error| told(&error))?;
    let at = match &args.time {
        Some(text) => At::Time(read::<Time>("--time", text, "500 s")?.get()),
        None => At::Last,
    };
    let place = args.at.as_deref().map(|text| read::<Length>("--at", text, "20 um")).transpose()?;
    let place = place.map(|place| place.get());
    let line = if args.along == "x" { Line::AlongX(place) } else { Line::AlongY(place) };
    let log = (args.log_time || args.linear_time).then_some(args.log_time);
    let options = Options { at, line, log, title: args.title.clone() };
    let reader = Reader::open(&args.result).map_err(|error| told(&error))?;
    let figure = figure(&reader, plot, &options).map_err(|error| told(&error))?;
    figure.write(&output, args.force).map_err(|error| told(&error))?;
    crate::print(&format!("{}\n", output.display()))
}
