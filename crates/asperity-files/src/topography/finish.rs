//! From the units of a file to metres: size and unit are decided only here, and never guessed.

use ndarray::Array2;

use super::unit::{LoneA, line_with_length, metres};
use super::{Format, Problem, ReadOptions, Result, Topography, grid};

/// The result of a reader.
#[derive(Debug)]
pub(super) struct Measured {
    /// The format, where the content tells it better than the signature.
    pub format: Option<Format>,
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
    /// The file does not state it.
    Unstated,
    /// The file states a unit that is not a length ("V").
    Other(String),
}

/// Lengths along x and y.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Lateral {
    /// In metres.
    Metres([f64; 2]),
    /// In a unit that the file does not state.
    Bare([f64; 2]),
    /// Not in the file; the text describes what it holds instead.
    Unstated(String),
}

impl Measured {
    /// Heights of a file without channels.
    pub(super) fn new(heights: Array2<f64>, unit: Unit, lateral: Lateral) -> Self {
        let (channels, metadata) = (Vec::new(), Vec::new());
        Measured { format: None, heights, unit, lateral, channel: None, channels, metadata }
    }

    /// Heights of one of these channels.
    pub(super) fn of_channel(self, names: Vec<String>, index: usize) -> Self {
        match names.get(index).filter(|name| !name.is_empty()).cloned() {
            Some(name) => Measured { channel: Some(name), channels: names, ..self },
            None => self,
        }
    }

    /// Adds further metadata; empty values are left out.
    pub(super) fn with<K: Into<String>>(mut self, metadata: impl IntoIterator<Item = (K, String)>) -> Self {
        let entries = metadata.into_iter().filter(|(_, value)| !value.is_empty());
        self.metadata.extend(entries.map(|(key, value)| (key.into(), value)));
        self
    }
}

impl Lateral {
    /// Lengths along x and y in the units that the file gives them.
    pub(super) fn of([x, y]: [f64; 2], units: [Unit; 2]) -> Self {
        match units {
            [Unit::Metres(ux), Unit::Metres(uy)] => Lateral::Metres([x * ux, y * uy]),
            [Unit::Other(label), _] | [_, Unit::Other(label)] => {
                Lateral::Unstated(format!(" in a unit of length (it says {label:?})"))
            }
            _ => Lateral::Bare([x, y]),
        }
    }
}

/// Decides size and unit.
pub(super) fn finish(format: Format, measured: Measured, options: &ReadOptions) -> Result<Topography> {
    check_options(options)?;
    let Measured { format: found, mut heights, unit, lateral, channel, channels, metadata } = measured;
    let format = found.unwrap_or(format);
    let height_unit = match (options.height_unit, &unit) {
        (Some(metres), _) => metres,
        (None, Unit::Metres(metres)) => *metres,
        (None, unit) => {
            let channel = channel.map_or(String::new(), |c| format!(" in channel {c:?}"));
            let detail = match unit {
                Unit::Other(label) => format!("{channel} (it says {label:?})"),
                _ => String::new(),
            };
            return Err(match (options.size, lateral) {
                (None, Lateral::Unstated(size)) => {
                    Problem::MissingSizeAndHeightUnit { format, size, unit: detail }
                }
                _ => Problem::MissingHeightUnit { format, detail },
            });
        }
    };
    let (mut told, named) = (None, line_with_length(&metadata));
    let size = match (options.size, lateral) {
        (Some(size), _) => size,
        (None, Lateral::Metres(size)) => size,
        // Bare numbers throughout: one unit for all of them.
        (None, Lateral::Bare(size))
            if options.height_unit.is_some() && !matches!(unit, Unit::Metres(_)) && named.is_none() =>
        {
            let (x, y) = (size[0], size[1]);
            told = Some(format!(
                "x and y, {x} x {y} without a unit in the file, are taken in the unit given for the heights, {height_unit:e} m"
            ));
            size.map(|length| length * height_unit)
        }
        (None, Lateral::Bare([x, y])) => {
            let beside = named
                .map_or(String::new(), |line| format!(", and {line:?}, whose unit may be that of x and y"));
            let detail = format!(" with a unit (it says {x} x {y}{beside})");
            return Err(Problem::MissingSize { format, detail });
        }
        (None, Lateral::Unstated(detail)) => return Err(Problem::MissingSize { format, detail }),
    };
    if !size.into_iter().all(is_positive) {
        return Err(Problem::malformed(
            "the physical size",
            format!("{:e} m x {:e} m", size[0], size[1]),
            "positive and finite; give the lengths along x and y (`size`, --size A,B)",
        ));
    }
    // Infinite heights can only come from scaling absurd numbers: they are undefined.
    let clean = |h: f64| if h.is_finite() { h } else { f64::NAN };
    if height_unit != 1.0 {
        grid::replace(&mut heights, |h| clean(h * height_unit));
    } else if heights.iter().any(|h| h.is_infinite()) {
        grid::replace(&mut heights, clean);
    }
    let mut topography = Topography { format, heights, size, channel, channels, metadata };
    topography.record(told);
    Ok(topography)
}

fn check_options(options: &ReadOptions) -> Result<()> {
    let wrong = |what, value, expected: &str| Err(Problem::Option { what, value, expected: expected.into() });
    match (options.size, options.height_unit) {
        (Some(size), _) if !size.into_iter().all(is_positive) => {
            wrong("size", format!("{} m x {} m", size[0], size[1]), "two lengths greater than 0 m")
        }
        (_, Some(unit)) if !is_positive(unit) => {
            wrong("height_unit", unit.to_string(), "metres per unit, greater than 0")
        }
        _ => Ok(()),
    }
}

/// Whether a length is greater than 0 and finite.
pub(super) fn is_positive(length: f64) -> bool {
    length.is_finite() && length > 0.0
}

/// The unit with this label; no label is no unit.
pub(super) fn unit_of(label: &str, lone_a: LoneA) -> Unit {
    match (metres(label, lone_a), label.trim()) {
        (Some(metres), _) => Unit::Metres(metres),
        (None, "") => Unit::Unstated,
        (None, label) => Unit::Other(label.to_owned()),
    }
}
