//! Figures of a result, by name.
//!
//! ```no_run
//! use asperity_io::store::{At, FieldKind, Reader};
//! use asperity_report::result::{Options, Plot, figure};
//!
//! let reader = Reader::open("rough_pmma.zarr".as_ref())?;
//! let options = Options { at: At::Time(500.0), ..Options::default() };
//! figure(&reader, Plot::Map(FieldKind::Pressure), &options)?.write("pressure.png".as_ref(), false)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod common;
mod distribution;
mod evolution;
mod fields;
mod fluid;
mod friction;
mod leak;
pub(crate) mod line;
pub(crate) mod panels;
mod plot;
mod profile;
mod rows;
mod stress;
mod temperature;
mod together;
mod wear;

use asperity::Boundary;
use asperity::material::{Creep, CreepTerm};
use asperity_io::answer::{Units, Validity};
use asperity_io::choice;
use asperity_io::readable::{coordinate, quantity};
use asperity_io::store::{At, Look, Reader, StoreError};
use asperity_io::stress::StressError;
use serde::Deserialize;
use serde_json::Value;

pub(crate) use common::Common;
pub use common::common_limits;
pub(crate) use evolution::{ForceCurve, last_cycle};
pub(crate) use fluid::largest_map as largest_fluid_map;
pub(crate) use friction::{name_of_theory, persson};
pub(crate) use leak::last_map as last_leak_map;
pub use plot::Plot;
pub(crate) use plot::colours;
pub(crate) use rows::Rows;
pub use rows::is_logarithmic;
pub use stress::stress_figure;
pub(crate) use temperature::at_rows as temperature_at_rows;
pub use temperature::temperatures;
pub(crate) use together::colour as colour_among;
pub use together::together;

use crate::figure::{Colours, Curves, Figure, FigureError, Map, Palette, Panel, Scale, Series};

/// What a figure shows of a result.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The instant of maps, profiles and distributions.
    pub at: At,
    /// The line of a profile.
    pub line: Line,
    /// Times on a logarithmic axis, or on a linear one; `None`: logarithmic where most of them lie in the first tenth of the run.
    pub log: Option<bool>,
    /// Units for leaks and times instead of those of the result.
    pub units: Units,
    /// The title instead of the result's.
    pub title: Option<String>,
    /// First and last time of figures over time \[s\], of a sweep velocity \[m/s\]; of an animation its first and last frame.
    pub window: [Option<f64>; 2],
    /// Values at the ends of the colours of a map \[SI\]; of a line contact at the ends of the vertical axis.
    pub limits: Option<[f64; 2]>,
    /// Colours instead of the usual ones.
    pub palette: Option<Palette>,
    /// Colours of a map, or the vertical axis of a line contact, by the logarithm of the values.
    pub log_values: bool,
    /// Width and height of the paper \[points\].
    pub size: Option<[f64; 2]>,
}

impl Options {
    /// Whether a time or velocity lies in the window.
    pub(crate) fn shows(&self, time: f64) -> bool {
        self.window[0].is_none_or(|from| time >= from) && self.window[1].is_none_or(|to| time <= to)
    }
}

/// A line through the area along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line {
    /// Along x, at this y \[m\]; `None` through the middle.
    AlongX(Option<f64>),
    /// Along y, at this x \[m\]; `None` through the middle.
    AlongY(Option<f64>),
}

impl Default for Line {
    fn default() -> Self {
        Line::AlongX(None)
    }
}

/// Why a figure of a result cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// The result does not hold what the figure shows, or is damaged.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The stress below the surface cannot be computed.
    #[error(transparent)]
    Stress(#[from] StressError),
    /// The flow at the instant was not solved.
    #[error(transparent)]
    Flow(#[from] asperity::Error),
    /// The figure is too large or too small, or cannot be written.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// The result has no such figure, for the reason that the sentence says.
    #[error("{0}")]
    Refused(String),
}

/// The figure of a result.
///
/// # Errors
/// [`PlotError::Store`] where the result has no row yet, does not hold the field or the instant, or is damaged;
/// [`PlotError::Refused`] where the result has no such figure, as nothing wears, the line of a profile does not cross the area, or
/// no row lies in the window; [`PlotError::Figure`] where the paper is too small.
pub fn figure(reader: &Reader, plot: Plot, options: &Options) -> Result<Figure, PlotError> {
    finished(panels(reader, plot, options)?, options)
}

/// The figure with what it says of rows that a logarithmic axis leaves out, on the paper asked for.
fn finished(mut figure: Figure, options: &Options) -> Result<Figure, PlotError> {
    let curves = figure.panels.iter().filter_map(Panel::curves);
    if let Some(label) = { curves }.find(|curves| curves.leaves_out_zero()).map(|curves| &curves.x.label) {
        let zero = if label == "time" { "t = 0" } else { "0" };
        figure.caption += &format!(" {zero} is not shown: the {label} axis is logarithmic.");
    }
    if let Some((axis, times)) = figure.panels.iter().filter_map(Panel::map).find_map(Map::stretched) {
        let times = quantity(if times < 10.0 { times } else { times.round() }, "");
        figure.caption += &format!(" The map is stretched {times} times along {axis}.");
    }
    figure.caption = figure.caption.trim_start().to_owned();
    match options.size {
        Some(size) => Ok(figure.sized(size)?),
        None => Ok(figure),
    }
}

/// The figure with its title, colours and caption.
fn panels(reader: &Reader, plot: Plot, options: &Options) -> Result<Figure, PlotError> {
    if reader.header().grid.is_line() {
        let what = match plot {
            Plot::Leak => Some("it has no leakage"),
            Plot::Profile if matches!(options.line, Line::AlongY(_)) => Some("take the profile along x"),
            _ => None,
        };
        if let Some(what) = what {
            let path = reader.path().display();
            let on_line = format!("{path} is a line contact, in which nothing changes along y: {what}");
            return Err(PlotError::Refused(on_line));
        }
    }
    let at = if plot.shows_contact() { with_contact(reader, options.at)? } else { options.at };
    let mut figure = plot.draw(reader, &Options { at, ..options.clone() })?;
    if at != options.at {
        figure.caption += IN_PLACE;
    }
    let taken = plot.answers().iter().map(|name| (name, Validity::of(name, reader.findings().iter())));
    if let Some((name, taken)) = { taken }.find(|(_, validity)| !validity.is_valid()) {
        let words = taken.mark(String::new());
        if !figure.caption.contains(&words) {
            figure.caption += &format!(" The {} is {words}.", name.replace('_', " "));
        }
    }
    if plot.is_of_the_load() && nothing_touches(reader, options)? {
        figure.caption += match options.window {
            [None, None] => " Nothing touches at any time.",
            _ => " Nothing touches in this window.",
        };
    }
    let own = if figure.title.is_empty() { &reader.header().title } else { &figure.title };
    figure.title = options.title.clone().unwrap_or_else(|| own.clone());
    for panel in &mut figure.panels {
        colour(panel, plot, options);
    }
    let is_amount = plot == Plot::InitialGap || plot.field().is_some_and(|kind| kind.look() == Look::Amount);
    if options.log_values && is_amount {
        figure.caption += " Light: not above 0.";
    }
    Ok(figure)
}

/// What captions say of the last instant with contact in place of the last one.
const IN_PLACE: &str = " This is the last stored time with contact.";

/// The last stored instant with contact in place of the last one, where nothing touches at that; else the instant itself.
///
/// # Errors
/// [`StoreError`] where the result is damaged.
pub fn with_contact(reader: &Reader, at: At) -> Result<At, StoreError> {
    let touches = |index: &usize| -> Result<bool, StoreError> {
        Ok(reader.contact_states(At::Index(*index))?.iter().any(|state| *state > 0))
    };
    let count = reader.field_times().len();
    if at != At::Last || count == 0 || reader.contact_kind().is_none() || touches(&(count - 1))? {
        return Ok(at);
    }
    for index in (0..count - 1).rev() {
        if touches(&index)? {
            return Ok(At::Index(index));
        }
    }
    Ok(at)
}

/// Whether the contact area is zero in all rows of the window.
fn nothing_touches(reader: &Reader, options: &Options) -> Result<bool, StoreError> {
    let rows = reader.series("time")?.into_iter().zip(reader.series("contact_area")?);
    Ok(rows.filter(|(time, _)| options.shows(*time)).all(|(_, area)| area == 0.0))
}

/// Limits, colours and scale of the values as they were asked for: of maps their colours, of a curve along a line contact its
/// vertical axis.
fn colour(panel: &mut Panel, plot: Plot, options: &Options) {
    match panel {
        Panel::Map(map) => {
            map.palette = options.palette;
            // Colours that are white in the middle have zero there, unless limits say otherwise.
            let own = match options.palette {
                Some(Palette::RedBlue) => map.range.map(|ends| Colours::Diverging.ends(ends)),
                _ => map.range,
            };
            map.range = options.limits.or(own);
            map.log |= options.log_values;
        }
        Panel::Curves(curves) if plot.unit() == Some(curves.y.unit.as_str()) && plot != Plot::Stress => {
            if let Some([low, high]) = options.limits {
                curves.y = curves.y.clone().between(low, high);
            }
            if options.log_values {
                curves.y.scale = Scale::Log;
            }
        }
        Panel::Curves(_) => {}
    }
}

/// The contact states at a stored instant (0 open, 1 in contact, 2 at the hardness), from whatever field tells them;
/// `None` where no stored field does, or no instant is stored.
///
/// # Errors
/// [`StoreError`] where the result is damaged or has no such instant.
pub fn contact(reader: &Reader, at: At) -> Result<Option<ndarray::Array2<u8>>, StoreError> {
    if reader.field_times().is_empty() || reader.contact_kind().is_none() {
        return Ok(None);
    }
    reader.contact_states(at).map(Some)
}

/// The same panel with one more line that no legend names.
fn nameless(curves: Curves, x: &[f64], y: Vec<f64>) -> Curves {
    curves.with(Series::new("", crate::figure::Style::Line, x, y))
}

/// A number of each row at a stored instant of the fields; of fields within a step between its ends.
fn at_instant(reader: &Reader, index: usize, name: &str) -> Result<f64, StoreError> {
    let time = reader.field_times()[index];
    let row = reader.field_steps()[index];
    let times = reader.series("time")?;
    let share = match (row.checked_sub(1).and_then(|n| times.get(n)), times.get(row)) {
        (Some(before), Some(after)) if time < *after && after > before => (time - before) / (after - before),
        _ => 1.0,
    };
    let series = reader.series(name)?;
    let value = series.get(row).copied().unwrap_or(f64::NAN);
    let before = if share < 1.0 { series.get(row - 1).copied().unwrap_or(value) } else { value };
    Ok(before + share * (value - before))
}

/// "t = 500 s, load 500 mN, approach 3.93 µm": the instant of a map, for captions.
fn caption(reader: &Reader, index: usize) -> Result<String, StoreError> {
    let at = |name: &str| at_instant(reader, index, name);
    let grid = &reader.header().grid;
    let [area, domain] = if grid.is_line() { ["length", "domain"] } else { ["area", "nominal area"] };
    let motion = motion(reader, index)?;
    let along = match reader.header().slips() {
        false => String::new(),
        true => {
            let size =
                |name: &str| Ok::<_, StoreError>(at(&format!("{name}_x"))?.hypot(at(&format!("{name}_y"))?));
            let force = quantity(size("tangential_force")?, grid.units("N"));
            let moved = size("tangential_displacement")?;
            // Where a sine passes 0 only its rounding error is left.
            let farthest = ["x", "y"].map(|axis| reader.series(&format!("tangential_displacement_{axis}")));
            let farthest =
                farthest.into_iter().flatten().flatten().fold(0.0, |most: f64, d| most.max(d.abs()));
            let moved = if moved > 1e-9 * farthest { moved } else { 0.0 };
            format!(", tangential force {force}, displacement {}", quantity(moved, "m"))
        }
    };
    let along = along + &wear::so_far(reader, index)?;
    Ok(format!(
        "{}: load {}, approach {}{along}, contact {area} {} ({:.2} % of the {domain}).{motion}",
        moment(reader, reader.field_times()[index]),
        quantity(at("load")?, grid.units("N")),
        quantity(at("approach")?, "m"),
        quantity(at("contact_area")?, grid.units("m2")),
        100.0 * at("contact_fraction")?,
    ))
}

/// " The contact moves along +x." at a stored instant, for captions; empty at rest.
fn motion(reader: &Reader, index: usize) -> Result<String, StoreError> {
    let Some(motion) = reader.header().setup.get("motion") else { return Ok(String::new()) };
    let velocity = match reader.header().axis() {
        asperity::Axis::Velocity => reader.field_times()[index],
        asperity::Axis::Time | asperity::Axis::None => at_instant(reader, index, "velocity")?,
    };
    if velocity == 0.0 {
        return Ok(" The contact is at rest.".to_owned());
    }
    Ok(along(&motion["direction"], velocity.signum())
        .map_or(String::new(), |along| format!(" The contact moves {along}.")))
}

/// "along +x", "at 30 ° from +x": a stored direction, times a sign.
pub(crate) fn along(direction: &Value, sign: f64) -> Option<String> {
    // The cosine of 90° is not quite 0.
    const NONE: f64 = 1e-12;
    let [x, y] = [direction.get(0)?.as_f64()? * sign, direction.get(1)?.as_f64()? * sign];
    let letter = |component: f64| if component < 0.0 { "−" } else { "+" };
    Some(match (x.abs() < NONE, y.abs() < NONE) {
        (_, true) => format!("along {}x", letter(x)),
        (true, _) => format!("along {}y", letter(y)),
        _ => format!("at {} from +x", quantity(y.atan2(x).to_degrees().round(), "°")),
    })
}

/// How titles of panels begin where nothing touches.
const NO_CONTACT: &str = "No contact at";

/// "No contact at t = 70 s" where nothing touches at a stored instant, as the title of a panel; empty where something does.
fn no_contact(reader: &Reader, index: usize) -> Result<String, StoreError> {
    let touches = at_instant(reader, index, "contact_area")? > 0.0;
    let moment = || moment(reader, reader.field_times()[index]);
    Ok(if touches { String::new() } else { format!("{NO_CONTACT} {}", moment()) })
}

/// "t = 500 s", or "v = 10 mm/s" of a sweep over velocities.
pub fn moment(reader: &Reader, time: f64) -> String {
    coordinate(reader.header().axis().at(time))
}

/// The contact creep function C(t) of the pair, without bodies that creep by a clock of their own; `None` where the result does
/// not say.
pub(crate) fn creep(reader: &Reader) -> Option<Creep> {
    creep_of(reader.header().setup.get("contact_creep_compliance")?)
}

/// The parts of C of the bodies that creep by a clock of their own, as their temperature changes: over their reduced times.
pub(crate) fn creep_over_reduced_time(reader: &Reader) -> Vec<Creep> {
    let stored = reader.header().setup.get("contact_creep_compliance_over_reduced_time");
    stored.and_then(Value::as_array).into_iter().flatten().filter_map(creep_of).collect()
}

fn creep_of(stored: &Value) -> Option<Creep> {
    #[derive(Deserialize)]
    struct Stored {
        instantaneous: f64,
        terms: Vec<(f64, f64)>,
        fluidity: f64,
    }
    let Stored { instantaneous, terms, fluidity } = Stored::deserialize(stored).ok()?;
    let term = |(compliance, retardation_time)| CreepTerm { compliance, retardation_time };
    let creep = Creep { instantaneous, terms: terms.into_iter().map(term).collect(), fluidity };
    creep.validate().ok().map(|()| creep)
}

/// The boundary of the domain that the result was computed on.
pub(crate) fn boundary(reader: &Reader) -> Boundary {
    reader.header().setup.get("boundary").and_then(Value::as_str).and_then(choice::parse).unwrap_or_default()
}
