//! The approach at which the tractions carry a load that they leave none of to the contact: a film of fluid, a pull.

use super::solver::Run;
use crate::contact::{Prescribed, Problem};
use crate::error::{Error, Result};

/// Approaches tried.
const MOST_APPROACHES: usize = 100;
/// Farthest approach from the start, over the largest undeformed gap.
const FARTHEST: f64 = 3e4;

impl Run<'_> {
    /// The approach at which the tractions carry `load`, from `start` on: enclosed by growing steps, found by the Illinois form of
    /// false position.
    ///
    /// # Errors
    /// [`Error::LiftedOff`] where they carry more at any distance; those of the loop.
    pub(super) fn search_approach(&mut self, problem: &Problem, load: f64, start: f64) -> Result<()> {
        let cell_area = self.operator.grid().cell_area();
        let scale = problem.gap.iter().filter(|h| h.is_finite()).fold(0.0_f64, |most, h| most.max(h.abs()));
        let scale = scale.max(start.abs()).max(1e-12);
        // Infinite where the gap would close altogether.
        let excess = |run: &mut Self, w: f64| -> Result<f64> {
            match run.solve(&Problem { prescribed: Prescribed::Approach(w), ..*problem }) {
                Err(Error::Undetermined { .. }) => Ok(f64::INFINITY),
                solved => solved.map(|()| cell_area * run.carried() - load),
            }
        };
        let (mut a, mut fa) = (start, excess(self, start)?);
        let mut step = if fa > 0.0 { -1e-3 } else { 1e-3 } * scale;
        let (mut b, mut fb) = (a, fa);
        let is_small =
            |run: &Self, f: f64| f.abs() <= (3.0 * run.tolerance() * load.abs()).max(cell_area * run.small());
        for _ in 0..MOST_APPROACHES {
            if is_small(self, fb) {
                return Ok(());
            }
            if fa * fb < 0.0 {
                break;
            }
            if (b - start).abs() > FARTHEST * scale {
                let unit = self.operator.grid().units("N");
                return Err(Error::LiftedOff { load, unit, excess: fb, time: f64::NAN });
            }
            (a, fa) = (b, fb);
            b += step;
            fb = excess(self, b)?;
            step *= 2.0;
        }
        for _ in 0..MOST_APPROACHES {
            if is_small(self, fb) {
                return Ok(());
            }
            let w = match fa.is_finite() && fb.is_finite() {
                true => b - fb * (b - a) / (fb - fa),
                false => 0.5 * (a + b),
            };
            let f = excess(self, w)?;
            if f * fb < 0.0 {
                (a, fa) = (b, fb)
            } else {
                fa *= 0.5
            }
            (b, fb) = (w, f);
        }
        Err(Error::invalid(
            "load",
            format!("{load:e} N"),
            "one that the tractions between the surfaces can hold: no equilibrium was found",
        ))
    }
}
