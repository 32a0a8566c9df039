//! What is asked of one elastic contact, and the questions that have an answer without iterations, or none.

use super::residual::find_approach;
use super::sweeps::feasible::Limits;
use super::{ContactState, Hardness, Outcome};
use crate::error::{Error, Result, require};
use crate::operator::Operator;
use asperity_sweep::{Min, each, run, sum};

/// One elastic contact of unit operator K.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// Undeformed gap h \[m\], nx ny cells; infinite where a cell cannot touch.
    pub gap: &'a [f64],
    /// Compliance c = 1/E* \[1/Pa\].
    pub compliance: f64,
    /// Cut-off H of the pressure.
    pub hardness: Hardness<'a>,
    /// What is given.
    pub prescribed: Prescribed,
}

/// The given quantity of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prescribed {
    /// Normal load W \[N\].
    Load(f64),
    /// Rigid-body approach w \[m\].
    Approach(f64),
}

/// What the cells of a problem allow together.
pub(super) struct Extent {
    /// Least gap \[m\]: the approach of first touch.
    pub first_touch: f64,
    /// Number of cells that can touch.
    pub touchable: f64,
    /// Sum of H over them \[Pa\].
    pub largest_sum: f64,
}

/// A load equals the largest possible one, and is kept, to this relative error.
pub(crate) const SAME_LOAD: f64 = 1e-12;

impl Problem<'_> {
    pub(super) fn extent(&self) -> Extent {
        let ([touchable, sum], Min(first_touch)) = run(Limits { gap: self.gap, hardness: self.hardness });
        let largest_sum = match self.hardness {
            Hardness::Uniform(hardness) => hardness * touchable,
            Hardness::Cells(_) => sum,
        };
        Extent { first_touch, touchable, largest_sum }
    }

    /// The sum of p that the load asks for \[Pa\]; `None` under approach control.
    pub(crate) fn sum(&self, cell_area: f64) -> Option<f64> {
        match self.prescribed {
            Prescribed::Load(load) => Some(load / cell_area),
            Prescribed::Approach(_) => None,
        }
    }

    /// Answers what needs no iteration: no load, no touch, every cell at the cut-off.
    ///
    /// # Errors
    /// [`Error::Infeasible`], [`Error::Undetermined`], [`Error::Invalid`].
    pub(super) fn trivial_solution(
        &self,
        operator: &mut dyn Operator,
        state: &mut ContactState,
    ) -> Result<Option<Outcome>> {
        let extent = self.extent();
        let load = match self.prescribed {
            Prescribed::Load(load) => load,
            Prescribed::Approach(w) => {
                if !self.is_apart_at(w, &extent, operator)? {
                    return Ok(None);
                }
                state.lift_off(w);
                return Ok(Some(Outcome::default()));
            }
        };
        let sound = load >= 0.0 && load.is_finite();
        require(sound, "load", format_args!("{load} N"), "finite and not negative")?;
        if load == 0.0 {
            state.lift_off(extent.first_touch);
            return Ok(Some(Outcome::default()));
        }
        let max = extent.largest_sum * operator.grid().cell_area();
        if load > max * (1.0 + SAME_LOAD) || extent.touchable == 0.0 {
            return Err(Error::Infeasible { parameter: String::new(), load, max });
        }
        if load < max * (1.0 - SAME_LOAD) {
            return Ok(None);
        }
        each(&mut state.pressure, (self.gap, self.hardness), |p, (h, hardness)| {
            *p = if h < f64::INFINITY { hardness } else { 0.0 };
        });
        operator.apply_into(&state.pressure, &mut state.unit_displacement);
        state.rounding = 1.0;
        state.approach = find_approach(self, state);
        Ok(Some(Outcome { convolutions: 1, saturated: true, ..Outcome::default() }))
    }

    /// Whether nothing touches at that approach.
    fn is_apart_at(&self, approach: f64, extent: &Extent, operator: &dyn Operator) -> Result<bool> {
        require(approach.is_finite(), "approach", format_args!("{approach} m"), "finite")?;
        let is_apart = approach <= extent.first_touch;
        if !is_apart && !operator.determines_mean() && self.hardness.is_infinite() {
            // Full contact at the approach where the mean gap closes. A cell that cannot touch makes the mean infinite, and
            // every approach determined.
            let max = sum(self.gap) / self.gap.len() as f64;
            if approach >= max {
                return Err(Error::Undetermined { approach, max });
            }
        }
        Ok(is_apart)
    }
}
