//! The full hereditary sum of SC17 (eq. 7, corrected): every past U is kept.
//!
//! With the pressure constant in each step, u(t_n) = sum over k of C(t_n - t_(k-1)) (U_k - U_(k-1)), and with
//! C(xi(t_n) - xi(t_(k-1))) for a body whose temperature changes. O(Nt^2) work and Nt fields, but any creep
//! function: the oracle for [`super::relaxation`].

use super::{History, Law};
use crate::contact::ContactState;
use crate::error::Result;
use crate::material::{Creep, ThermalCreep};
use crate::step::{Interval, Loader, Saver};
use asperity_sweep::each;

pub(super) struct HereditarySum {
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

impl HereditarySum {
    pub(super) fn new(creep: &Creep, thermal: &[ThermalCreep]) -> Self {
        HereditarySum {
            creep: creep.clone(),
            thermal: thermal.to_vec(),
            starts: vec![],
            past: vec![],
            open: None,
        }
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

    /// u = sum_k C(t - s_k) (U_k - U_(k-1)) = sum_k [C(t - s_k) - C(t - s_(k+1))] U_k + C(dt) U_new.
    fn add_history(&self, gap: &mut [f64]) {
        let Some([open, end]) = &self.open else { return };
        for (k, past) in self.past.iter().enumerate() {
            let next = self.starts.get(k + 1).unwrap_or(open);
            let weight = self.compliance(&self.starts[k], end) - self.compliance(next, end);
            if weight != 0.0 {
                each(gap, &past[..], |g, u| *g += weight * u);
            }
        }
    }
}

impl History for HereditarySum {
    fn open(&mut self, step: &Interval, last: &ContactState, rigid: &[f64], gap: &mut [f64]) -> Result<Law> {
        let time = step.instant.time;
        let [start, end] = [self.moment(time - step.length()), self.moment(time)];
        if let Some([start, _]) = self.open.replace([start, end]) {
            self.starts.push(start);
            self.past.push(last.unit_displacement.clone());
        }
        self.reopen(step, rigid, gap)
    }

    fn reopen(&mut self, step: &Interval, rigid: &[f64], gap: &mut [f64]) -> Result<Law> {
        let (end, dt) = (self.moment(step.instant.time), step.length());
        let mut compliance = self.creep.value(dt);
        if let Some([start, own]) = &mut self.open {
            compliance += self.thermal.iter().map(|body| body.value(start.time, end.time)).sum::<f64>();
            *own = end;
        }
        gap.copy_from_slice(rigid);
        self.add_history(gap);
        Ok(Law::of(compliance))
    }

    fn recalled(&self, g: &mut [f64]) {
        g.fill(0.0);
        self.add_history(g);
    }

    fn save<'a>(&'a self, to: &mut Saver<'a>) {
        let moments = self.starts.iter().chain(self.open.iter().flatten());
        to.value("moments", &moments.map(|moment| moment.time).collect::<Vec<f64>>());
        for (k, past) in self.past.iter().enumerate() {
            to.field(&format!("past_{k}"), past);
        }
    }

    fn load(&mut self, from: &mut Loader<'_>) -> Result<()> {
        let moments = from.numbers("moments")?;
        match moments[..] {
            [] => {}
            [ref starts @ .., open, time] => {
                self.starts = starts.iter().map(|t| self.moment(*t)).collect();
                self.open = Some([self.moment(open), self.moment(time)]);
                let past = (0..starts.len()).map(|k| from.field(&format!("past_{k}")));
                self.past = past.collect::<Result<_>>()?;
            }
            _ => return Err(from.foreign("times of another scheme")),
        }
        Ok(())
    }
}
