//! What the options of `asperity plot` say.

use asperity_io::quantity::{Length, Pressure};
use asperity_io::store::Reader;
use asperity_report::result::{Line, Options, Plot};

use super::super::moment;
use crate::args;
use crate::failure::{Failure, refuse};
use crate::input::read;

/// Sides of the paper \[m\].
const SIDES: [f64; 2] = [0.02, 1.0];
/// Points of paper in a metre.
const POINTS: f64 = 72.0 / 0.0254;

/// Refuses options that say nothing about this figure.
pub(super) fn check(args: &args::Plot, plot: Plot) -> Result<(), Failure> {
    let with_maps = || {
        let names: Vec<_> = Plot::all().filter(|plot| plot.unit().is_some()).map(|p| p.name()).collect();
        names.join(", ")
    };
    let refused =
        |option: &str, why: String| refuse!("{option} does not apply to the figure {}: {why}", plot.name());
    for (given, option) in
        [(args.limits.is_some(), "--limits"), (args.same_colours, "--same-colours"), (args.log, "--log")]
    {
        if given && plot.unit().is_none() {
            return refused(option, format!("it is for the maps {}", with_maps()));
        }
    }
    if args.colours.is_some() && !plot.has_colours() {
        return refused("--colours", format!("it is for the maps {} and leak", with_maps()));
    }
    let place = if args.at.is_some() { "--at" } else { "--along y" };
    if (args.at.is_some() || args.along != "x") && plot != Plot::Profile {
        return refused(place, "it is for a profile".to_owned());
    }
    if args.time.is_some() && !plot.is_of_an_instant() {
        return refused("--time", "it does not show one time of the result".to_owned());
    }
    if args.animate.is_some() && !plot.is_of_an_instant() {
        return refused("--animate", "it does not show one time of the result".to_owned());
    }
    let scale = if args.log_time { "--log-time" } else { "--linear-time" };
    if (args.log_time || args.linear_time) && !plot.is_over_time() {
        return refused(scale, "it is for figures over time".to_owned());
    }
    let window = if args.from.is_some() { "--from" } else { "--to" };
    if (args.from.is_some() || args.to.is_some()) && !plot.is_over_time() && args.animate.is_none() {
        return refused(
            window,
            "it shows one time; --time chooses it, and --animate shows several".to_owned(),
        );
    }
    Ok(())
}

/// The options as the figures take them; the instant is not among them.
pub(super) fn of(args: &args::Plot, plot: Plot, reader: &Reader) -> Result<Options, Failure> {
    let place = args.at.map(Length::get);
    let window =
        [moment(reader, "--from", args.from.as_deref())?, moment(reader, "--to", args.to.as_deref())?];
    if let ([Some(from), Some(to)], Some(text)) = (window, &args.from)
        && from >= to
    {
        let end = args.to.as_deref().unwrap_or_default();
        refuse!("--from is \"{text}\", but must be before --to, \"{end}\"");
    }
    Ok(Options {
        line: if args.along == "x" { Line::AlongX(place) } else { Line::AlongY(place) },
        log: (args.log_time || args.linear_time).then_some(args.log_time),
        units: crate::commands::answers::units(&args.unit)?,
        title: args.title.clone(),
        window,
        limits: args.limits.as_deref().map(|text| limits(text, plot, args.log)).transpose()?,
        palette: args.colours,
        log_values: args.log,
        size: args.size.as_deref().map(size).transpose()?,
        ..Options::default()
    })
}

/// "0,20 MPa" in SI.
fn limits(text: &str, plot: Plot, log: bool) -> Result<[f64; 2], Failure> {
    let is_pressure = plot.unit() == Some("Pa");
    let example = if is_pressure { "0,20 MPa" } else { "0,2 um" };
    let kind = if is_pressure { "pressures" } else { "lengths" };
    let refused = || {
        let message = format!("--limits is \"{text}\", but must be two {kind}, e.g. --limits '{example}'");
        Failure::input(message)
    };
    let number = |text: &str| match is_pressure {
        true => text.parse::<Pressure>().map(|value| value.get()).map_err(|_| refused()),
        false => text.parse::<Length>().map(|value| value.get()).map_err(|_| refused()),
    };
    let Some([low, high]) = two(text, &[',']) else { return Err(refused()) };
    match [number(&low)?, number(&high)?] {
        [low, high] if low >= high => {
            refuse!("--limits is \"{text}\", but the first value must be less than the second")
        }
        [low, _] if log && low <= 0.0 => {
            refuse!("--limits is \"{text}\", but with --log both values must be greater than 0")
        }
        ends => Ok(ends),
    }
}

/// "160 mm,100 mm" in points.
fn size(text: &str) -> Result<[f64; 2], Failure> {
    let example = "160 mm,100 mm";
    let Some(sides) = two(text, &[',', 'x']) else {
        refuse!("--size is \"{text}\", but must be a width and a height, e.g. --size '{example}'");
    };
    let mut points = [0.0; 2];
    for (point, side) in points.iter_mut().zip(&sides) {
        let metres = read::<Length>("--size", side)?.get();
        if !(SIDES[0]..=SIDES[1]).contains(&metres) {
            let [least, most] = SIDES.map(|side| 1e3 * side);
            refuse!(
                "--size is \"{text}\", but each side must be {least} mm to {most} mm, e.g. --size '{example}'"
            );
        }
        *point = metres * POINTS;
    }
    Ok(points)
}

/// Two values; the first takes the unit of the second where it has none.
fn two(text: &str, separators: &[char]) -> Option<[String; 2]> {
    let (first, second) = text.split_once(separators)?;
    let [first, second] = [first.trim(), second.trim()];
    if first.is_empty() || second.is_empty() || second.contains(separators) {
        return None;
    }
    let unit = second.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE ".contains(c));
    let bare = first.parse::<f64>().is_ok();
    Some([if bare { format!("{first} {unit}") } else { first.to_owned() }, second.to_owned()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_io::store::FieldKind;

    #[test]
    fn limits_share_the_unit_of_the_second_value() {
        let pressure = |text| limits(text, Plot::Map(FieldKind::Pressure), false);
        assert_eq!(pressure("10, 20 MPa").unwrap(), [1e7, 2e7]);
        assert_eq!(pressure("0,20 MPa").unwrap(), [0.0, 2e7]);
        assert_eq!(pressure("500 kPa,1e0 MPa").unwrap(), [5e5, 1e6]);
        assert_eq!(pressure("1e6,2e6").unwrap(), [1e6, 2e6]);
        assert_eq!(limits("-1,2 um", Plot::Map(FieldKind::Gap), false).unwrap(), [-1e-6, 2e-6]);
        for bad in
            ["20 MPa", "1,2,3 MPa", "2,1 MPa", "1,1 MPa", "0,20 mm", ",1 MPa", "nan,1 MPa", "0,inf MPa"]
        {
            assert!(pressure(bad).is_err(), "{bad}");
        }
        assert!(limits("0,1 um", Plot::Map(FieldKind::Gap), true).is_err());
    }

    #[test]
    fn a_size_is_two_lengths_that_a_printer_takes() {
        let close = |text: &str, width: f64, height: f64| {
            let [w, h] = size(text).unwrap();
            assert!(
                (w - width * 72.0 / 25.4).abs() < 1e-9 && (h - height * 72.0 / 25.4).abs() < 1e-9,
                "{text}"
            );
        };
        close("160 mm,100 mm", 160.0, 100.0);
        close("160x100mm", 160.0, 100.0);
        close("16 cm x 10 cm", 160.0, 100.0);
        for bad in ["160 mm", "160,100", "0,1 mm", "5 m,1 m", "-10,50 mm", "a,b mm"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }
}
