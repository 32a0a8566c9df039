//! The figure of a seal: leak over inlet pressure, pressure inside, leak over time, and the conductance of its patch.

use asperity_io::answer::Units;
use asperity_io::seal::{Over, SealAnswer, State};

use crate::figure::{Axis, COLOURS, Curves, Figure, Series, Style};

/// Of bounds.
const GREY: &str = "#8a8a86";

/// The figure, leaks and times in these units.
pub fn figure(answer: &SealAnswer, units: &Units) -> Figure {
    let (unit, scale) = answer.plan.standard().map_or(("m3/s", 1.0), |standard| ("Pa m3/s", standard));
    let rate = || Axis::log("leak of the seal", unit).shown_in(Some(units.shown_leak(answer.plan.is_gas())));
    let scaled = |list: &[Over]| list.iter().map(|over| over.times(scale)).collect::<Vec<_>>();
    let [over_inlet, over_time] = [&answer.by_inlet, &answer.by_time].map(|list| scaled(list));
    let leak = answer.validity("seal_leak");
    let mut figure = Figure::new("").with(inside(answer));
    let is_drawn = |over: &Over| drawn(over.leak.largest) > 0.0 || drawn(over.one_way) > 0.0;
    let mut shown: Vec<&Over> = vec![];
    if over_inlet.iter().any(is_drawn) {
        figure.panels.insert(0, by_inlet(answer, &over_inlet, rate()).into());
        shown.extend(&over_inlet);
    }
    // At each time the inlet is that of the case.
    if over_time.len() > 1 && leak.is_valid() && over_time.iter().any(is_drawn) {
        let axis = Axis::log("time", "s").shown_in(units.shown("time"));
        figure = figure.with(curves(Curves::new("Leak over time", axis, rate()), &over_time));
        shown.extend(&over_time);
    }
    if answer.sweep.seeds.iter().flat_map(|seed| &seed.points).any(|point| drawn(last(point)) > 0.0) {
        figure = figure.with(conductance(answer));
    }
    let taken = if leak.is_valid() {
        String::new()
    } else {
        format!("The leak of the seal is {}.", leak.mark(String::new()))
    };
    let any = |is: fn(&Over) -> bool| shown.iter().any(|over| is(over));
    let ends = match [any(|over| over.leak.least == 0.0), any(|over| over.leak.largest == f64::INFINITY)] {
        [_, true] => "A line ends where the seal is tight, or where the fluid lifts it.",
        [true, false] => "A line ends where the seal is tight.",
        _ => "",
    };
    let sentences = [
        (!leak.is_valid(), taken.as_str()),
        (any(|over| over.leak.least != over.leak.largest), "Dotted: least and largest of the seeds."),
        (any(|over| drawn(over.one_way) > 0.0), "Dashed: if the fluid did not open the contact."),
        (any(Over::is_coarse), "Grey: what the sweep leaves open, where that is more than a factor of two."),
        (!ends.is_empty(), ends),
    ];
    let said: Vec<&str> = sentences.into_iter().filter(|(is, _)| *is).map(|(_, sentence)| sentence).collect();
    figure.columns(2).caption(said.join(" "))
}

/// A leak of 0 or without bounds has no place on a logarithmic axis.
fn drawn(x: f64) -> f64 {
    if x.is_finite() && x > 0.0 { x } else { f64::NAN }
}

fn curves(panel: Curves, list: &[Over]) -> Curves {
    let series = |name: &str, style, of: fn(&Over) -> f64| {
        Series::through(name, style, list.iter().map(|over| [over.at, drawn(of(over))]))
    };
    let colour = COLOURS[0];
    let mut panel = panel.with(series("leak", Style::Line, |over| over.leak.mean).in_colour(colour));
    if list.iter().any(|over| over.leak.least != over.leak.largest) {
        let ends: [fn(&Over) -> f64; 2] = [|over| over.leak.least, |over| over.leak.largest];
        for of in ends {
            panel = panel.with(series("", Style::Dotted, of).in_colour(colour));
        }
    }
    let not_opened = series("contact not opened", Style::Dashed, |over| over.one_way).in_colour(COLOURS[1]);
    if list.iter().any(|over| drawn(over.one_way) > 0.0) { panel.with(not_opened) } else { panel }
}

fn by_inlet(answer: &SealAnswer, list: &[Over], y: Axis) -> Curves {
    let outlet = answer.plan.ends[1];
    let above = |over: &Over| Over { at: over.at - outlet, ..*over };
    let list: Vec<Over> = list.iter().map(above).collect();
    let axis = Axis::linear("inlet above outlet", "Pa").spanning(0.0, answer.plan.reach() - outlet);
    let mut panel = curves(Curves::new("Leak over the inlet pressure", axis, y), &list);
    if list.iter().any(Over::is_coarse) {
        let bound = |end: usize| {
            list.iter()
                .map(move |over| [over.at, if over.is_coarse() { drawn(over.bounds[end]) } else { f64::NAN }])
        };
        for end in [0, 1] {
            panel = panel.with(Series::through("", Style::Dotted, bound(end)).in_colour(GREY));
        }
    }
    let leaks = || {
        list.iter()
            .flat_map(|over| [over.leak.least, over.leak.largest, over.one_way])
            .filter(|x| drawn(*x) > 0.0)
    };
    let ends = [leaks().fold(f64::INFINITY, f64::min), leaks().fold(0.0, f64::max)];
    let opening = answer.opening.map_or(f64::NAN, |opening| opening.mean);
    for (name, at, colour) in
        [("opens", opening, COLOURS[2]), ("inlet of the case", answer.plan.ends[0], COLOURS[3])]
    {
        let at = at - outlet;
        if ends[1] > 0.0 && at > 0.0 && at <= answer.plan.reach() - outlet {
            panel = panel
                .with(Series::through(name, Style::DashDotted, ends.map(|end| [at, end])).in_colour(colour));
        }
    }
    panel
}

fn inside(answer: &SealAnswer) -> Curves {
    let (x, p0, fluid) = answer.inside();
    let axis = Axis::linear("place across the seal", "m");
    let panel = Curves::new("Pressure inside the seal", axis, Axis::linear("pressure", "Pa"))
        .with(Series::new("contact p0", Style::Line, &x, p0).in_colour(COLOURS[1]));
    fluid.iter().enumerate().fold(panel, |panel, (n, fluid)| {
        let name = if n == 0 { "fluid" } else { "" };
        panel.with(Series::new(name, Style::Line, &x, fluid).in_colour(COLOURS[0]))
    })
}

fn conductance(answer: &SealAnswer) -> Curves {
    let axis = Axis::log("mean pressure on the patch", "Pa");
    let panel =
        Curves::new("Conductance of the patch at the last time", axis, Axis::log("conductance", "m3"));
    let at = |point: &(f64, Vec<State>)| [point.0, drawn(last(point))];
    answer.sweep.seeds.iter().enumerate().fold(panel, |panel, (n, seed)| {
        let colour = COLOURS[n % COLOURS.len()];
        let name = seed.seed.map_or("patch".to_owned(), |seed| format!("seed {seed}"));
        panel
            .with(Series::through("", Style::Points, seed.points.iter().map(at)).in_colour(colour))
            .with(Series::through(name, Style::Line, seed.points.iter().map(at)).in_colour(colour))
    })
}

/// The conductance of a patch at the last time.
fn last((_, states): &(f64, Vec<State>)) -> f64 {
    states.last().map_or(f64::NAN, |state| state.sigma)
}
