//! Where another pressure of the sweep tells most about the flow.
//!
//! With k of the march, a small change of sigma changes the flow by a mean of that change over the pressures in the seal,
//!
//! ```text
//! d ln F = int w d ln sigma,   w dP ~ mu dP,   mu = exp(-int (d ln k/dP) |dP|) from the inlet on
//! ```
//!
//! (linearise F = -k dP/dx between the fixed ends). In a cell of one contact pressure mu is in proportion to k: behind the place that
//! chokes the flow nothing counts. The next pressure is the mean of the pressures between two of the sweep, with the weight w times what
//! the sweep leaves open there, 1 - low/high, in that interval in which the weights sum to most.

use super::march::{Cell, March, Opened};
use super::{Conductance, Profile, SealState};
use crate::error::Result;
use crate::kernel::gauss::GAUSS_8;

/// Pressures closer than this share of them are not told apart: a patch has no sharper sealing pressure.
const CLOSEST: f64 = 0.005;
/// A new pressure keeps this share of its interval from both ends.
const INSIDE: f64 = 0.1;

/// The pressure \[Pa\] at which sigma would tell most about the flow between these pressures of inlet and outlet; `None` where nothing flows,
/// or the sweep is as fine as it can be.
///
/// # Errors
/// As [`flow`](super::flow).
pub fn refinement(sigma: &Conductance, profile: &Profile, ends: [f64; 2]) -> Result<Option<f64>> {
    let [low, high] = [sigma.low(), sigma.high()];
    let seal = Opened::new(&high, profile, ends)?;
    let Some(cells) = Opened::contact(&seal.p0, ends).filter(|_| seal.flow.state == SealState::Leaks) else {
        return Ok(None);
    };
    let march = March { sigma: &high, p0: &seal.p0[cells.clone()], dx: seal.dx, ends, opens: true };
    let mut intervals: Vec<Interval> = vec![];
    for (pressed, weight) in weights(&march, &seal.flow.pressure[cells.start..=cells.end]) {
        let Some(ends) = sigma.around(pressed).filter(|[from, to]| to - from > CLOSEST * to) else {
            continue;
        };
        let weight = weight * (1.0 - low.at(pressed) / high.at(pressed));
        let known = intervals.iter().position(|interval| interval.ends == ends);
        let place = known.unwrap_or_else(|| {
            intervals.push(Interval { ends, weight: 0.0, moment: 0.0 });
            intervals.len() - 1
        });
        intervals[place].weight += weight;
        intervals[place].moment += weight * pressed;
    }
    let most = intervals.into_iter().filter(|interval| interval.weight > 0.0);
    Ok(most.max_by(|a, b| a.weight.total_cmp(&b.weight)).map(|interval| interval.middle()))
}

/// Two pressures of the sweep, and what lies between.
struct Interval {
    ends: [f64; 2],
    weight: f64,
    /// Weights times pressures.
    moment: f64,
}

impl Interval {
    fn middle(&self) -> f64 {
        let [from, to] = self.ends;
        let edge = INSIDE * (to - from);
        (self.moment / self.weight).clamp(from + edge, to - edge)
    }
}

/// p0 - P in the cells of a march, with weights; `pressure` is that of the fluid at the ends of the cells, inlet first.
fn weights(march: &March<'_>, pressure: &[f64]) -> Vec<(f64, f64)> {
    let mut found = vec![];
    let mut mu = 1.0;
    for (p0, ends) in march.p0.iter().zip(pressure.windows(2)) {
        let cell = Cell::new(march, *p0);
        let share = mu / cell.k(ends[0]);
        if !(share > 0.0 && share.is_finite()) {
            break;
        }
        for [from, to] in cell.parts(ends[1], ends[0]) {
            let [middle, half] = [0.5 * (from + to), 0.5 * (to - from)];
            for (x, weight) in GAUSS_8 {
                let fluid = middle + half * x;
                let sigma = cell.k(fluid);
                if sigma > 0.0 {
                    found.push((p0 - fluid, half * weight * share * sigma));
                }
            }
        }
        mu = share * cell.k(ends[1]);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seal::{Shape, flow};

    /// Against the change of the flow where sigma is 1e-4 larger between two pressures.
    #[test]
    fn the_weights_are_the_answer_of_the_flow_to_the_conductance() {
        let sweep = |from: f64, to: f64| {
            let point = |p: f64| (p, (-3.0 * p).exp() * if p > from && p < to { 1.0001 } else { 1.0 });
            Conductance::new(&(1..=1500).map(|n| 0.001 * f64::from(n)).map(point).collect::<Vec<_>>())
                .unwrap()
        };
        let ends = [0.6, 0.0];
        let hertz = Profile { shape: Shape::Hertz { peak: 1.4, width: 1.0 }, energising: 0.0 };
        let plain = sweep(0.0, 0.0);
        let seal = Opened::new(&plain, &hertz, ends).unwrap();
        let cells = Opened::contact(&seal.p0, ends).unwrap();
        let march = March { sigma: &plain, p0: &seal.p0[cells.clone()], dx: seal.dx, ends, opens: true };
        let weights = weights(&march, &seal.flow.pressure[cells.start..=cells.end]);
        let all: f64 = weights.iter().map(|(_, weight)| weight).sum();
        for [from, to] in [[0.1, 0.5], [0.5, 0.7], [0.7, 0.8], [0.8, 1.4]] {
            let part =
                weights.iter().filter(|(p, _)| *p > from && *p < to).map(|(_, weight)| weight).sum::<f64>()
                    / all;
            let changed = (flow(&sweep(from, to), &hertz, ends).unwrap().flow / seal.flow.flow).ln() / 1e-4;
            // A step of sigma is a slope a thousandth wide, and the cells are 1/400 of the width.
            assert!((part - changed).abs() < 0.01, "{from} {to}: {part} {changed}");
        }
    }
}
