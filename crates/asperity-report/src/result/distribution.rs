//! Distributions over the area: pressure, gap, sizes of contact spots.

use asperity::spots::Spots;
use asperity_io::readable::{counted, quantity};
use asperity_io::store::{FieldKind, Reader};

use super::{Options, PlotError, boundary, caption};
use crate::figure::{Axis, Curves, Figure, Series, Style, extent};
use crate::histogram;

const BINS: usize = 60;
/// Values that differ by this share are the same but for rounding.
const ROUNDING: f64 = 1e-9;

pub(super) fn histogram(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let at = options.at;
    let kept = &reader.header().fields;
    let index = reader.index(at)?;
    let mut figure = Figure::new("");
    if kept.contains(&FieldKind::Pressure) {
        let pressure = reader.field(FieldKind::Pressure, at)?;
        let inside: Vec<f64> = pressure.iter().copied().filter(|p| *p > 0.0).collect();
        let all = inside.len() == pressure.len();
        let names = ["Pressure in contact", "pressure", "Pa"];
        figure = figure.with(density(names, &inside, all, "nothing touches"));
    }
    if kept.contains(&FieldKind::Gap) {
        let gap = reader.field(FieldKind::Gap, at)?;
        let states = reader.contact_states(at)?;
        let open: Vec<f64> =
            gap.iter().zip(&states).filter(|(h, s)| **s == 0 && h.is_finite()).map(|(h, _)| *h).collect();
        let all = open.len() == gap.len();
        figure = figure.with(density(["Gap out of contact", "gap", "m"], &open, all, "no open cell"));
    }
    if figure.panels.is_empty() {
        return Err(reader.no_field(FieldKind::Pressure).into());
    }
    Ok(figure.caption(format!("Probability densities. {}", caption(reader, index)?)))
}

/// The share of values per unit, over bins from zero to the greatest; of `all` cells, or where zero is far from all of them, from
/// the least.
fn density([title, label, unit]: [&str; 3], values: &[f64], all: bool, none: &str) -> Curves {
    let [least, high] = extent(values.iter().copied());
    let low = if all || least > 0.5 * high { least } else { least.min(0.0) };
    let panel = Curves::new(title, Axis::linear(label, unit), Axis::linear("density", format!("1/{unit}")));
    // Differences of the last digits are no distribution.
    if !values.is_empty() && high - least <= ROUNDING * high.abs() {
        return panel.or_say(format!("everywhere {}", quantity(high, unit)));
    }
    histogram::bars(panel.or_say(none), histogram::density(values, low..=high, BINS))
}

/// The sizes, which fall, each once, and how many are at least as large: a straight line for a power law, with no bins to choose.
fn at_least(falling: &[f64]) -> (Vec<f64>, Vec<f64>) {
    // Sizes are whole numbers of cells.
    const SAME: f64 = 1e-9;
    let is_last = |n: usize| falling.get(n + 1).is_none_or(|next| *next < falling[n] * (1.0 - SAME));
    (0..falling.len()).filter(|n| is_last(*n)).map(|n| (falling[n], (n + 1) as f64)).unzip()
}

pub(super) fn spots(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let states = reader.contact_states(options.at)?;
    let spots = Spots::of(&reader.header().grid, boundary(reader), states.view(), |state| *state > 0);
    let (sizes, numbers) = at_least(&spots.areas);
    let grid = &reader.header().grid;
    let (size, units) = if grid.is_line() { ("length", "m") } else { ("area", "m2") };
    let panel = Curves::new(
        "",
        Axis::log(format!("{size} of a spot"), units),
        Axis::log("spots at least as large", "").counting(),
    )
    .or_say("nothing touches")
    .with(Series::new("", Style::Points, sizes, numbers));
    let largest = spots.areas.first().copied().unwrap_or(0.0);
    let sizes = format!(
        "{}, mean {size} {}, largest {}. {}",
        counted(spots.len(), "spot"),
        quantity(spots.mean_area(), units),
        quantity(largest, units),
        caption(reader, reader.index(options.at)?)?
    );
    Ok(Figure::new("").with(panel).panel_size([345.0, 260.0]).caption(sizes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_sizes_are_one_point_with_the_number_of_all_of_them() {
        assert_eq!(at_least(&[5.0, 2.0, 2.0, 2.0, 1.0]), (vec![5.0, 2.0, 1.0], vec![1.0, 4.0, 5.0]));
        assert_eq!(at_least(&[]), (vec![], vec![]));
    }

    #[test]
    fn bins_begin_at_zero_where_it_matters() {
        let first = |values: &[f64], all: bool| {
            let panel = density(["", "pressure", "Pa"], values, all, "none");
            panel.series.first().map(|series| series.x[0])
        };
        let near = |found: Option<f64>, low: f64, high: f64| {
            let middle = low + 0.5 * (high - low) / BINS as f64;
            assert!((found.unwrap() - middle).abs() < 1e-9 * high, "{found:?}, expected {middle}");
        };
        // Some cells are open: the density at small pressure says how the contact ends.
        near(first(&[0.4, 0.7, 1.0], false), 0.0, 1.0);
        near(first(&[0.4, 0.7, 1.0], true), 0.4, 1.0);
        near(first(&[0.997, 1.0, 1.009], false), 0.997, 1.009);
        let same = density(["", "pressure", "Pa"], &[2e6, 2e6 * (1.0 + 1e-12)], true, "none");
        assert_eq!((same.series.len(), same.empty.as_str()), (0, "everywhere 2 MPa"));
    }
}
