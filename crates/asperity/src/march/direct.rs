//! The full hereditary sum of SC17 (eq. 7, corrected): every past U is kept.
//!
//! With the pressure constant in each step, u(t_n) = sum over k of C(t_n - t_(k-1)) (U_k - U_(k-1)), and with
//! C(xi(t_n) - xi(t_(k-1))) for a body whose temperature changes. O(Nt^2) work and Nt fields, but any creep
//! function: the oracle for [`super::memory`].

use crate::material::{Creep, ThermalCreep};
use asperity_sweep::sweep;

pub(super) struct Direct {
    creep: Creep,
    thermal: Vec<ThermalCreep>,
    /// Times at which the steps before began, and the U that each ended with.
    starts: Vec<Moment>,
    past: Vec<Vec<f64>>,
    /// The step that is under way: its start and end.
    open: Option<[Moment; 2]>,
}

/// A time, and what the clock of each body shows then.
#[derive(Clone)]
struct Moment {
    time: f64,
    reduced: Vec<f64>,
}

impl Direct {
    pub(super) fn new(creep: &Creep, thermal: &[ThermalCreep]) -> Self {
        Direct { creep: creep.clone(), thermal: thermal.to_vec(), starts: vec![], past: vec![], open: None }
    }

    fn moment(&self, time: f64) -> Moment {
        Moment { time, reduced: self.thermal.iter().map(|body| body.clock.value(time)).collect() }
    }

    /// Compliance at `end` of a load since `start`.
    fn compliance(&self, start: &Moment, end: &Moment) -> f64 {
        let clocks = start.reduced.iter().zip(&end.reduced);
        let thermal =
            self.thermal.iter().zip(clocks).map(|(body, (s, e))| body.creep.value((e - s).max(0.0)));
        self.creep.value(end.time - start.time) + thermal.sum::<f64>()
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
        let [start, end] = [self.moment(time - dt), self.moment(time)];
        let thermal: f64 = self.thermal.iter().map(|body| body.value(start.time, time)).sum();
        if let Some([start, _]) = self.open.replace([start, end]) {
            self.starts.push(start);
            self.past.push(unit.to_vec());
        }
        gap.copy_from_slice(rigid);
        self.add_history(gap);
        self.creep.value(dt) + thermal
    }

    /// As [`Direct::history`] for the step under way, `dt` long: what came before it is taken in already.
    pub(super) fn retry(&mut self, dt: f64, rigid: &[f64], gap: &mut [f64]) -> f64 {
        let compliance = self.shorten(dt);
        gap.copy_from_slice(rigid);
        self.add_history(gap);
        compliance
    }

    /// Ends the step under way `dt` after its start; returns c.
    fn shorten(&mut self, dt: f64) -> f64 {
        let Some([start, _]) = self.open.take() else { return self.creep.value(dt) };
        let end = self.moment(start.time + dt);
        let thermal: f64 = self.thermal.iter().map(|body| body.value(start.time, end.time)).sum();
        self.open = Some([start, end]);
        self.creep.value(dt) + thermal
    }

    /// g of the step under way.
    pub(super) fn remembered(&self, g: &mut [f64]) {
        g.fill(0.0);
        self.add_history(g);
    }

    /// u = sum_k C(t - s_k) (U_k - U_(k-1)) = sum_k [C(t - s_k) - C(t - s_(k+1))] U_k + C(dt) U_new.
    fn add_history(&self, gap: &mut [f64]) {
        let Some([open, end]) = &self.open else { return };
        for (k, past) in self.past.iter().enumerate() {
            let next = self.starts.get(k + 1).unwrap_or(open);
            let weight = self.compliance(&self.starts[k], end) - self.compliance(next, end);
            if weight != 0.0 {
                sweep((&mut *gap, &past[..]), &|(gap, past): (&mut [f64], &[f64])| {
                    gap.iter_mut().zip(past).for_each(|(g, u)| *g += weight * u);
                });
            }
        }
    }

    pub(super) fn save(&self) -> (Vec<f64>, Vec<Vec<f64>>) {
        let moments = self.starts.iter().chain(self.open.iter().flatten());
        (moments.map(|moment| moment.time).collect(), self.past.clone())
    }

    pub(super) fn load(&mut self, scalars: &[f64], past: Vec<Vec<f64>>) -> bool {
        match scalars {
            [] => past.is_empty(),
            [starts @ .., open, time] if starts.len() == past.len() => {
                self.starts = starts.iter().map(|t| self.moment(*t)).collect();
                self.open = Some([self.moment(*open), self.moment(*time)]);
                self.past = past;
                true
            }
            _ => false,
        }
    }
}
