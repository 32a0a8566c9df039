//! From what a file says to metres: the one place where size and unit are settled, and never guessed.

use ndarray::Array2;

use super::unit::{LoneA, metres};
use super::{Format, Problem, ReadOptions, Topography, grid};

/// What a reader found.
#[derive(Debug)]
pub(super) struct Measured {
    /// Heights in the file's unit, axis 0 = x, C order, NaN = undefined.
    pub heights: Array2<f64>,
    /// Unit of the heights.
    pub unit: Unit,
    /// Lengths along x and y.
    pub lateral: Lateral,
    /// Name of the channel.
    pub channel: Option<String>,
    /// Names of the channels that hold heights.
    pub channels: Vec<String>,
    /// What else the file says.
    pub metadata: Vec<(String, String)>,
}

/// Unit of the heights.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unit {
    /// Metres per unit.
    Metres(f64),
    /// The file does not say.
    Unstated,
    /// The file says something that is no length ("V").
    Other(String),
}

/// Lengths along x and y.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Lateral {
    /// In metres.
    Metres([f64; 2]),
    /// In a unit that the file does not state.
    Bare([f64; 2]),
    /// Not in the file; the text says what it holds instead.
    Unstated(String),
}

/// Settles size and unit.
pub(super) fn finish(
    format: Format,
    measured: Measured,
    options: &ReadOptions,
) -> Result<Topography, Problem> {
    check_options(options)?;
    let Measured { mut heights, unit, lateral, channel, channels, metadata } = measured;
    let height_unit = match (options.height_unit, &unit) {
        (Some(metres), _) => metres,
        (None, Unit::Metres(metres)) => *metres,
        (None, Unit::Unstated) => {
            return Err(Problem::MissingHeightUnit { format, detail: String::new() });
        }
        (None, Unit::Other(label)) => {
            let channel = channel.map_or(String::new(), |c| format!(" in channel {c:?}"));
            return Err(Problem::MissingHeightUnit {
                format,
                detail: format!("{channel} (it says {label:?})"),
            });
        }
    };
    let size = match (options.size, lateral) {
        (Some(size), _) => size,
        (None, Lateral::Metres(size)) => size,
        // Bare numbers throughout: one unit for all of them.
        (None, Lateral::Bare(size)) if options.height_unit.is_some() && !matches!(unit, Unit::Metres(_)) => {
            size.map(|length| length * height_unit)
        }
        (None, Lateral::Bare([x, y])) => {
            return Err(Problem::MissingSize { format, detail: format!(" with a unit (it says {x} x {y})") });
        }
        (None, Lateral::Unstated(detail)) => return Err(Problem::MissingSize { format, detail }),
    };
    for length in size {
        if !(length.is_finite() && length > 0.0) {
            return Err(Problem::malformed(
                "the physical size",
                format!("{:e} m x {:e} m", size[0], size[1]),
                "positive and finite; give the lengths along x and y (`size`, --size A,B)",
            ));
        }
    }
    // Infinite heights can only come from scaling absurd numbers: undefined, like every other value that is none.
    let clean = |h: f64| if h.is_finite() { h } else { f64::NAN };
    if height_unit != 1.0 {
        grid::replace(&mut heights, |h| clean(h * height_unit));
    } else if heights.iter().any(|h| h.is_infinite()) {
        grid::replace(&mut heights, clean);
    }
    Ok(Topography { format, heights, size, channel, channels, metadata })
}

fn check_options(options: &ReadOptions) -> Result<(), Problem> {
    let positive = |v: f64| v.is_finite() && v > 0.0;
    if let Some(size) = options.size
        && !size.iter().all(|l| positive(*l))
    {
        let value = format!("{} m x {} m", size[0], size[1]);
        return Err(Problem::Option { what: "size", value, expected: "two lengths greater than 0 m" });
    }
    match options.height_unit {
        Some(unit) if !positive(unit) => Err(Problem::Option {
            what: "height_unit",
            value: unit.to_string(),
            expected: "metres per unit, greater than 0",
        }),
        _ => Ok(()),
    }
}

/// The channel asked for by name (any case) or number; by default the first of heights, and without one the first.
///
/// A length is not always a height (the deflection of a cantilever is one too): names decide first.
pub(super) fn choose_heights(
    format: Format,
    names: &[String],
    unit: impl Fn(usize) -> Unit,
    wanted: Option<&str>,
) -> Result<usize, Problem> {
    const NAMES: [&str; 6] = ["height", "zsensor", "z-axis", "topo", "elevation", "relief"];
    let first = choose(format, names, wanted)?;
    if wanted.is_some() {
        return Ok(first);
    }
    let lengths = || (0..names.len()).filter(|i| matches!(unit(*i), Unit::Metres(_)));
    let is_named = |i: &usize| {
        let name = names[*i].to_lowercase();
        NAMES.iter().any(|word| name.contains(word))
    };
    Ok(lengths().find(is_named).or_else(|| lengths().next()).unwrap_or(first))
}

/// Refuses a file of more channels than any instrument writes: every one is looked at.
pub(super) fn check_channels(count: usize) -> Result<(), Problem> {
    const MOST: usize = 1000;
    match count <= MOST {
        true => Ok(()),
        false => Err(Problem::malformed("the number of channels", count, format!("at most {MOST}"))),
    }
}

/// The unit with this label; no label is no unit.
pub(super) fn unit_of(label: &str, lone_a: LoneA) -> Unit {
    match (metres(label, lone_a), label.trim()) {
        (Some(metres), _) => Unit::Metres(metres),
        (None, "") => Unit::Unstated,
        (None, label) => Unit::Other(label.to_owned()),
    }
}

/// The channel asked for by name (any case) or number, or the first.
pub(super) fn choose(format: Format, names: &[String], wanted: Option<&str>) -> Result<usize, Problem> {
    if names.is_empty() {
        return Err(Problem::NoHeights { format, detail: "no channel with heights in it".into() });
    }
    let Some(wanted) = wanted else { return Ok(0) };
    names
        .iter()
        .position(|n| n == wanted)
        .or_else(|| names.iter().position(|n| n.to_lowercase() == wanted.to_lowercase()))
        .or_else(|| wanted.parse().ok().filter(|i| *i < names.len()))
        .ok_or_else(|| Problem::NoChannel { wanted: wanted.into(), available: names.to_vec() })
}
