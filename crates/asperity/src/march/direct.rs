//! The full hereditary sum of SC17 (eq. 7, corrected): every past U is kept.
//!
//! With the pressure constant in each step, u(t_n) = sum over k of C(t_n - t_(k-1)) (U_k - U_(k-1)).
//! O(Nt^2) work and Nt fields, but any creep function: the oracle for [`super::memory`].

use crate::field::sweep;
use crate::material::Creep;

pub(super) struct Direct {
    creep: Creep,
    /// Times at which the steps before began, and the U that each ended with.
    starts: Vec<f64>,
    past: Vec<Vec<f64>>,
    /// The step that is under way: its start and end.
    open: Option<[f64; 2]>,
}

impl Direct {
    pub(super) fn new(creep: &Creep) -> Self {
        Direct { creep: creep.clone(), starts: vec![], past: vec![], open: None }
    }

    /// Takes in `unit` = U_n; writes `gap` = `rigid` + g for the step that ends at `time`; returns c.
    pub(super) fn history(
        &mut self,
        time: f64,
        dt: f64,
        unit: &[f64],
        rigid: &[f64],
        gap: &mut [f64],
    ) -> f64 {
        if let Some([start, _]) = self.open.replace([time - dt, time]) {
            self.starts.push(start);
            self.past.push(unit.to_vec());
        }
        gap.copy_from_slice(rigid);
        self.add_history(gap);
        self.creep.value(dt)
    }

    /// g of the step under way.
    pub(super) fn remembered(&self, g: &mut [f64]) {
        g.fill(0.0);
        self.add_history(g);
    }

    /// u = sum_k C(t - s_k) (U_k - U_(k-1)) = sum_k [C(t - s_k) - C(t - s_(k+1))] U_k + C(dt) U_new.
    fn add_history(&self, gap: &mut [f64]) {
        let Some([open, time]) = self.open else { return };
        for (k, past) in self.past.iter().enumerate() {
            let next = self.starts.get(k + 1).copied().unwrap_or(open);
            let weight = self.creep.value(time - self.starts[k]) - self.creep.value(time - next);
            if weight != 0.0 {
                sweep((&mut *gap, &past[..]), &|(gap, past): (&mut [f64], &[f64])| {
                    gap.iter_mut().zip(past).for_each(|(g, u)| *g += weight * u);
                });
            }
        }
    }

    pub(super) fn save(&self) -> (Vec<f64>, Vec<Vec<f64>>) {
        let scalars = self.starts.iter().copied().chain(self.open.into_iter().flatten()).collect();
        (scalars, self.past.clone())
    }

    pub(super) fn load(&mut self, scalars: &[f64], past: Vec<Vec<f64>>) -> bool {
        match scalars {
            [] => past.is_empty(),
            [starts @ .., open, time] if starts.len() == past.len() => {
                (self.starts, self.past, self.open) = (starts.to_vec(), past, Some([*open, *time]));
                true
            }
            _ => false,
        }
    }
}
