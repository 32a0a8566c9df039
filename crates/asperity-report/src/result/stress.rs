//! The stress below the surface: sections through its largest value, the map there, and the profile over depth.

use asperity_io::readable::quantity;
use asperity_io::store::{At, Reader};
use asperity_io::stress::{Below, Instant, Section, StressError, StressPlan, below_at, section};
use ndarray::{Array2, s};

use super::{IN_PLACE, Options, PlotError, caption, moment, with_contact};
use crate::figure::{Axes, Axis, Colours, Curves, Figure, Map, Series, Style};

/// A section is this many times as wide as deep, unless the domain ends before.
const WIDE: f64 = 3.0;

/// The stress at a stored instant: what the result holds, or the largest values of its first body. In place of a last instant
/// without contact stands the last one with contact, and the caption says so.
pub(super) fn stress(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let plan = StressPlan::for_result(reader)?;
    let stored = Below::of(reader)?;
    let last = reader.index(options.at)?;
    let index = reader.index(with_contact(reader, options.at)?)?;
    let mut figure = match stored.filter(|below| below.instants.iter().any(|instant| instant.index == index))
    {
        Some(below) => stress_figure(reader, &below, index)?,
        None => stress_figure(reader, &below_at(reader, &plan, At::Index(index))?, index)?,
    };
    if index != last {
        figure.caption += IN_PLACE;
    }
    Ok(figure)
}

/// The figure of a stored instant, by its number, of what was found; without a title.
///
/// # Errors
/// [`PlotError`] where nothing was found at this instant, or nothing touches.
pub fn stress_figure(reader: &Reader, below: &Below, index: usize) -> Result<Figure, PlotError> {
    let Some(instant) = below.instants.iter().find(|instant| instant.index == index) else {
        let why = "the stress was not computed at this time";
        return Err(StressError::Refused { path: reader.path().to_owned(), why }.into());
    };
    let found = section(reader, below, instant)?;
    let [depth, x, y] = found.place;
    let length = |value: f64| quantity(value, "m");
    let size = reader.header().grid.size();
    let mises = |title: String, values: &Array2<f64>, size: [f64; 2]| {
        Map::new(title, ["von Mises stress", "Pa"], Colours::Heat, values.view(), size)
            .between([0.0, found.largest])
    };
    let cut = |values: &Array2<f64>, along: &'static str, place: f64, size: f64, title: String| {
        let cells = values.dim().0;
        let half = (0.5 * WIDE * found.reach).max(size / cells as f64);
        let cell = |at: f64| (at / size * cells as f64).clamp(0.0, cells as f64) as usize;
        let (first, end) = (cell(place - half), cell(place + half).max(cell(place - half) + 1).min(cells));
        let part = values.slice(s![first..end, ..]).to_owned();
        let start = first as f64 / cells as f64 * size;
        let wide = (end - first) as f64 / cells as f64 * size;
        mises(title, &part, [wide, found.reach]).over(Axes::Section { along, start })
    };
    let title = title(reader, instant);
    let y_words = if found.along_y.is_some() { format!(", y = {}", length(y)) } else { String::new() };
    let sentence = format!(
        "Von Mises stress of {} (Poisson's ratio {}), largest {} at x = {}{y_words}, depth {}. {}",
        below.set.body,
        below.set.poisson,
        quantity(found.largest, "Pa"),
        length(x),
        length(depth),
        caption(reader, index)?
    );
    let section_x = match found.along_y {
        Some(_) => format!("Section y = {}", length(y)),
        None => "Section".to_owned(),
    };
    let mut figure =
        Figure::new(title).with(cut(&found.along_x, "x", x, size[0], section_x)).caption(sentence);
    if let Some(along_y) = &found.along_y {
        figure = figure.with(cut(along_y, "y", y, size[1], format!("Section x = {}", length(x))));
    }
    let maps = found.maps.iter();
    figure = figure.with_all(maps.map(|(depth, map)| mises(format!("Depth {}", length(*depth)), map, size)));
    figure = figure.with(profile(below, instant, &found));
    if !shows_tension(below, instant, &found) {
        let largest = quantity(highest(below.profile(instant, "tension_by_depth")), "Pa");
        figure.caption += &format!(" The largest principal stress is not drawn: it is {largest} at most.");
    }
    Ok(match below.set.line {
        true => figure.columns(1).panel_size([430.0, 260.0]),
        false => figure.panel_size([300.0, 230.0]),
    })
}

fn title(reader: &Reader, instant: &Instant) -> String {
    let title = &reader.header().title;
    let what = format!("tress below the surface at {}", moment(reader, instant.time));
    if title.is_empty() { format!("S{what}") } else { format!("{title}: s{what}") }
}

/// Whether the largest principal stress is of the size of the others: under the pressure of a full contact it may be far below.
fn shows_tension(below: &Below, instant: &Instant, found: &Section) -> bool {
    highest(below.profile(instant, "tension_by_depth")) > -found.largest
}

fn highest<'v>(values: impl IntoIterator<Item = &'v f64>) -> f64 {
    values.into_iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// The largest stresses by depth.
fn profile(below: &Below, instant: &Instant, found: &Section) -> Curves {
    let depths = &below.set.depths;
    let mut lines = vec![("von Mises", "mises_by_depth"), ("shear (s1 - s3)/2", "tresca_by_depth")];
    let mut least = 0.0;
    if shows_tension(below, instant, found) {
        lines.push(("largest principal", "tension_by_depth"));
        least = below.profile(instant, "tension_by_depth").iter().copied().fold(0.0, f64::min);
    }
    // Room for the legend above the curves.
    let up = Axis::linear("stress", "Pa").spanning(least, 1.4 * found.largest);
    let mut panel = Curves::new("Largest at each depth", Axis::linear("depth", "m"), up);
    for (name, key) in lines {
        panel = panel.with(Series::new(name, Style::Line, depths, below.profile(instant, key)));
    }
    let shear = below.profile(instant, "orthogonal_shear_by_depth");
    if !shear.is_empty() {
        panel = panel.with(Series::new("range of xz shear (rolling)", Style::Dashed, depths, shear));
    }
    if let Some(limit) = below.set.yield_stress.filter(|limit| *limit < 1.4 * found.largest) {
        let ends = [0.0, depths.last().copied().unwrap_or(found.reach)];
        panel = panel.with(Series::new("yield stress", Style::Reference, ends, [limit; 2]));
    }
    panel.with(Series::new("largest von Mises", Style::Points, [found.place[0]], [found.largest]))
}
