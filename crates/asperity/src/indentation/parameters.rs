//! The fitted numbers as a vector for the least squares. Moduli and times are represented by their logarithms, so that they
//! remain positive and their errors are factors.

use crate::error::Result;
use crate::material::{Relaxation, RelaxationTerm};

/// A relaxation function of some fitted numbers, the last of which is the depth of first touch where it is fitted.
pub(super) trait Law: Copy + Sync {
    /// Number of the numbers.
    fn len(&self) -> usize;
    /// Whether the depth of first touch is fitted.
    fn fits_touch(&self) -> bool;
    /// The relaxation function; an error where the law has none.
    fn body(&self, at: &[f64]) -> Result<Relaxation>;

    /// The depth of first touch over the largest depth; 0 if it is not fitted.
    fn touch(&self, at: &[f64]) -> f64 {
        if self.fits_touch() { at[self.len() - 1] } else { 0.0 }
    }
}

/// The numbers that are fitted: \[ln E∞\], ln E_i, ln τ_i, \[depth of first touch over the largest depth\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parameters {
    pub(super) solid: bool,
    pub(super) terms: usize,
    pub(super) touch: bool,
}

impl Law for Parameters {
    fn len(&self) -> usize {
        usize::from(self.solid) + 2 * self.terms + usize::from(self.touch)
    }

    fn fits_touch(&self) -> bool {
        self.touch
    }

    fn body(&self, at: &[f64]) -> Result<Relaxation> {
        Ok(self.relaxation(at))
    }
}

impl Parameters {
    pub(super) fn relaxation(&self, at: &[f64]) -> Relaxation {
        let first = usize::from(self.solid);
        let term = |k: usize| RelaxationTerm {
            modulus: at[first + k].exp(),
            relaxation_time: at[first + self.terms + k].exp(),
        };
        let mut terms: Vec<RelaxationTerm> = (0..self.terms).map(term).collect();
        terms.sort_by(|a, b| a.relaxation_time.total_cmp(&b.relaxation_time));
        Relaxation { equilibrium: if self.solid { at[0].exp() } else { 0.0 }, terms, viscosity: 0.0 }
    }

    /// The parameters of a relaxation function; `None` if it has another form.
    pub(super) fn of(&self, relaxation: &Relaxation) -> Option<Vec<f64>> {
        let positive = |x: f64| (x > 0.0 && x.is_finite()).then(|| x.ln());
        let mut at = vec![];
        if relaxation.viscosity > 0.0 || relaxation.terms.len() != self.terms {
            return None;
        }
        match self.solid {
            true => at.push(positive(relaxation.equilibrium)?),
            false if relaxation.equilibrium == 0.0 => {}
            false => return None,
        }
        let terms = relaxation.terms.iter();
        for number in terms.clone().map(|term| term.modulus).chain(terms.map(|term| term.relaxation_time)) {
            at.push(positive(number)?);
        }
        at.extend(self.touch.then_some(0.0));
        Some(at)
    }

    /// The modulus or time with the largest standard deviation, and that deviation.
    pub(super) fn worst(&self, deviations: &[f64]) -> Option<(String, f64)> {
        let first = usize::from(self.solid);
        let name = |k: usize| match k {
            0 if self.solid => "the equilibrium modulus".to_owned(),
            k if k < first + self.terms => format!("the modulus of term {}", k - first + 1),
            k => format!("the time of term {}", k - first - self.terms + 1),
        };
        let known = deviations.iter().take(first + 2 * self.terms).enumerate();
        let worst = known.max_by(|a, b| a.1.total_cmp(b.1))?;
        Some((name(worst.0), *worst.1))
    }
}
