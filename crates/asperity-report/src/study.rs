//! The figure of a study: its first answer over the first key that varies. Keys that end in `.seed` are averaged, with bars from the
//! least to the largest value; every combination of the other keys is a curve.

use asperity_io::study::{Plan, Table};

use crate::figure::{Axis, Curves, Figure, Series, Style};
use crate::result::colour_among;

/// An axis is logarithmic where its values span this factor.
const DECADE: f64 = 10.0;
/// The share of an axis that stays free at each end, so that no point lies on the frame.
const MARGIN: f64 = 0.04;

/// The values of a curve at one place, of all its seeds, each with its error, NaN where that is not known.
type Place = (f64, Vec<[f64; 2]>);

/// The figure; `None` where nothing is done yet.
pub fn figure(plan: &Plan, table: &Table) -> Option<Figure> {
    let answer = table.answers.first()?;
    let is_seed = |n: usize| table.keys[n].name.rsplit('.').next() == Some("seed");
    let keys: Vec<usize> = (0..table.keys.len()).collect();
    let across = keys.iter().copied().find(|n| !is_seed(*n)).unwrap_or(0);
    let others: Vec<usize> = match plan.zip {
        true => vec![],
        false => keys.into_iter().filter(|n| *n != across && !is_seed(*n)).collect(),
    };
    let is_number = table.keys[across].unit.is_some();
    let place = |row: usize| match is_number {
        true => table.number(row, across),
        false => {
            let value = &table.rows[row].run.values[across];
            plan.vary[across].values.iter().position(|other| other == value).map(|n| n as f64)
        }
    };
    let mut curves: Vec<(String, Vec<Place>)> = vec![];
    let holds = |row: usize| {
        let own = table.rows[row].answers.iter().find(|own| own.name == answer.name);
        own.is_none_or(|own| own.validity.is_valid())
    };
    let known = || answer.values.iter().enumerate().filter(|(_, value)| value.is_finite());
    let left_out = known().filter(|(row, _)| !holds(*row)).count();
    for (row, value) in known().filter(|(row, _)| holds(*row)) {
        let Some(x) = place(row) else { continue };
        let word = |n: &usize| {
            format!("{} = {}", plan.called(&table.keys[*n].name), table.rows[row].run.values[*n].text())
        };
        let name = others.iter().map(word).collect::<Vec<_>>().join(", ");
        let curve = match curves.iter_mut().find(|(known, _)| *known == name) {
            Some((_, places)) => places,
            None => {
                curves.push((name, vec![]));
                &mut curves.last_mut()?.1
            }
        };
        match curve.iter_mut().find(|(known, _)| *known == x) {
            Some((_, values)) => values.push([*value, answer.errors[row]]),
            None => curve.push((x, vec![[*value, answer.errors[row]]])),
        }
    }
    let xs: Vec<f64> = curves.iter().flat_map(|(_, places)| places.iter().map(|place| place.0)).collect();
    let places = || curves.iter().flat_map(|(_, places)| places);
    let ys: Vec<f64> =
        places().flat_map(|(_, values)| ends(values).into_iter().chain([mean(values)])).collect();
    let ys: Vec<f64> = ys.into_iter().filter(|y| y.is_finite()).collect();
    if xs.is_empty() {
        return None;
    }
    let label = plan.called(&table.keys[across].name);
    let x = match table.keys[across].unit {
        Some(unit) => axis(label, unit, &xs),
        None => {
            let names: Vec<String> = plan.vary[across].values.iter().map(|value| value.text()).collect();
            Axis::states(label, &names.iter().map(String::as_str).collect::<Vec<_>>())
        }
    };
    let unit = if answer.unit == "1" { "" } else { answer.unit };
    let y = axis(answer.name.replace('_', " "), unit, &ys);
    let averaged = places().any(|(_, values)| values.len() > 1);
    let has_errors = places().any(|(_, values)| values.len() == 1 && values[0][1].is_finite());
    let mut panel = Curves::new("", x, y);
    for (n, (name, places)) in curves.iter().enumerate() {
        panel = drawn(panel, name, places, &colour_among(n, curves.len()));
    }
    let figure =
        Figure::new(title(plan, table).unwrap_or_default()).with(panel).columns(1).panel_size([360.0, 260.0]);
    let mut words = match (averaged, has_errors) {
        (true, _) => "Mean over the seeds; the bars go from the least to the largest value.".to_owned(),
        (false, true) => "The bars are the errors of the answers.".to_owned(),
        (false, false) => String::new(),
    };
    if left_out > 0 {
        let shown = known().count();
        words +=
            &format!(" Left out: {left_out} of {shown} answers, which their findings take back (not valid).");
    }
    Some(figure.caption(words.trim_start()))
}

/// "contact area over load and seed": the answer of the figure, and what was varied.
pub fn title(plan: &Plan, table: &Table) -> Option<String> {
    let keys: Vec<String> = plan.vary.iter().map(|varied| plan.called(&varied.key)).collect();
    let keys = match keys.split_last()? {
        (last, []) => last.clone(),
        (last, others) => format!("{} and {last}", others.join(", ")),
    };
    Some(format!("{} over {keys}", table.answers.first()?.name.replace('_', " ")))
}

fn mean(values: &[[f64; 2]]) -> f64 {
    values.iter().map(|[value, _]| value).sum::<f64>() / values.len() as f64
}

/// The ends of a bar: the least and the largest value, of one value those of its error; NaN without one.
fn ends(values: &[[f64; 2]]) -> [f64; 2] {
    match values {
        [[value, error]] => [value - error, value + error],
        _ => [f64::min, f64::max]
            .map(|pick| values.iter().map(|[value, _]| *value).reduce(pick).unwrap_or(f64::NAN)),
    }
}

/// Adds a curve through the means, with a bar at each place.
fn drawn(panel: Curves, name: &str, places: &[Place], colour: &str) -> Curves {
    let mut places = places.to_vec();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    let means = || places.iter().map(|(x, values)| [*x, mean(values)]);
    let bars = places.iter().map(|(x, values)| (*x, ends(values))).filter(|(_, [low, _])| low.is_finite());
    let bars = bars.flat_map(|(x, [low, high])| [[x, low], [x, high], [x, f64::NAN]]);
    panel
        .with(Series::through("", Style::Line, bars).in_colour(colour))
        .with(Series::through(name, Style::Line, means()).in_colour(colour))
        .with(Series::through("", Style::Points, means()).in_colour(colour))
}

/// An axis for values, with room at its ends; logarithmic where they are positive and span a decade.
fn axis(label: String, unit: &str, values: &[f64]) -> Axis {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if least > 0.0 && largest >= DECADE * least {
        let room = (largest / least).powf(MARGIN);
        return Axis::log(label, unit).between(least / room, largest * room);
    }
    match largest > least {
        true => {
            let room = MARGIN * (largest - least);
            Axis::linear(label, unit).between(least - room, largest + room)
        }
        false => Axis::linear(label, unit),
    }
}
