//! Half-spaces of finite thickness.
//!
//! A body of thickness d on a rigid base, bonded, is stiffer than a half-space by about a/d under a contact of radius a
//! (a sphere on a layer with Poisson's ratio 0.3 carries 1.09 times the load at a/d = 0.1 and 1.32 times at 0.3, at the same
//! approach), and under waves longer than 1.5 d by more than 2 % (docs/layers.md).

use super::words::{digits, rows, si};
use super::worst::Worst;
use super::{Finding, THIN_BODY};
use crate::grid::Grid;

/// Contact radius over thickness.
const WIDEST: f64 = 0.1;
/// Length of a wave over thickness.
const LONGEST: f64 = 1.5;
const ADVICE: &str = "Describe it by [[body.layer]] (base = \"rigid\", or the material below).";

/// A contact of this radius on a body of this thickness \[m\]; `words` name it, for example "The expected contact".
pub fn thin_body(words: &str, radius: f64, thickness: f64) -> Option<Finding> {
    (radius > WIDEST * thickness).then(|| {
        let stiffer = match radius / thickness {
            share if share <= 1.0 => format!("about {} % stiffer", digits((100.0 * share).round())),
            _ => "several times stiffer".to_owned(),
        };
        let text = format!(
            "{words} has a radius of {}, and the body is {} thick: on a rigid base the contact would be {stiffer} than computed \
             for the half-space. {ADVICE}",
            si(radius, "m"),
            si(thickness, "m"),
        );
        Finding::warning(THIN_BODY, radius, WIDEST * thickness, text)
    })
}

/// A periodic domain whose longest wave is affected by the base below the body.
pub(super) fn long_waves(grid: &Grid, thickness: f64) -> Option<Finding> {
    let longest = grid.longest_side();
    (longest > LONGEST * thickness).then(|| {
        let text = format!(
            "The longest wave of the domain, {}, is longer than {LONGEST} times the thickness of the body, {}: what lies below \
             the body changes its response. {ADVICE}",
            si(longest, "m"),
            si(thickness, "m"),
        );
        Finding::warning(THIN_BODY, longest, LONGEST * thickness, text)
    })
}

/// The contacts of a run that are too wide for the thickness of the body.
#[derive(Clone, Debug, Default)]
pub(super) struct Widest(Worst);

impl Widest {
    pub(super) fn see(&mut self, row: usize, radius: f64, thickness: f64) {
        self.0.above(row, radius, WIDEST * thickness);
    }

    pub(super) fn finding(&self, thickness: f64) -> Option<Finding> {
        let at = self.0.rows?;
        Some(thin_body(&format!("In {} the contact", rows(at)), self.0.value, thickness)?.at(at))
    }
}
