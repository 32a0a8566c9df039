//! The state between two rows, consistent with the scheme: dense output.
//!
//! Within a step p and U are linear in time, or constant in the constant scheme, and the memory follows its own formula
//! on the part of the step. The approach is the one at which the cells in contact are closed in the pressure-weighted
//! mean, sum p (h0 + u - w) = 0 over 0 < p < H. Second order, as the steps themselves, which take no notice.

use crate::contact::{ContactState, Hardness};
use crate::field::{minimum, strands, sweep};
use crate::load::Control;
use crate::march::record::{Remembered, Step};
use crate::march::{March, Past, cap, undeformed};
use crate::time::Instant;

/// A state within the last step of a march; [`March::view`] shows it as a row.
pub struct Between {
    instant: Instant,
    state: ContactState,
    /// h0 + g.
    gap: Vec<f64>,
    /// g.
    history: Vec<f64>,
    compliance: f64,
}

impl March {
    /// The state at `time` within the last step: after the row before it, not after the last row. `None`
    /// outside of it, and with [`Scheme::Direct`](crate::Scheme::Direct), which does not say what is between.
    pub fn between(&self, time: f64) -> Option<Between> {
        let (index, row) = self.current?;
        let start = row.time - row.dt;
        let Past::Memory(memory) = &self.past else { return None };
        if index + 1 != self.done || row.jump || !(time > start && time <= row.time) {
            return None;
        }
        let part = (time - start) / row.dt;
        let share = if memory.is_linear() { part } else { 1.0 };
        let blend = |a: &[f64], b: &[f64]| -> Vec<f64> {
            let mut mixed = vec![0.0; a.len()];
            sweep((&mut mixed[..], a, b), &|(m, a, b): (&mut [f64], &[f64], &[f64])| {
                m.iter_mut().zip(a).zip(b).for_each(|((m, a), b)| *m = a + share * (b - a));
            });
            mixed
        };
        let pressure = blend(&self.previous.pressure, &self.state.pressure);
        let unit = blend(&self.previous.unit_displacement, &self.state.unit_displacement);
        let clocks = self.simulation.thermal.iter().map(|body| body.clock.elapsed(start, time));
        let lengths: Vec<f64> = std::iter::once(time - start).chain(clocks).collect();
        let rigid = vec![0.0; unit.len()];
        let mut history = vec![0.0; unit.len()];
        let before = &self.previous.unit_displacement;
        let compliance = memory.partial(&lengths, before, &rigid, &mut history);
        let mut gap = rigid;
        gap.copy_from_slice(undeformed(&self.simulation, &self.dents));
        sweep((&mut gap[..], &history[..]), &|(h, g): (&mut [f64], &[f64])| {
            h.iter_mut().zip(g).for_each(|(h, g)| *h += g);
        });
        let prescribed = self.timeline.value_within(row, time);
        let cells = (&pressure[..], &unit[..], &gap[..], cap(&self.simulation, &self.hardness));
        let [weight, moment, touching] =
            sweep(cells, &|(p, u, h, hardness): (&[f64], &[f64], &[f64], Hardness)| {
                let n = p.len();
                let (u, h) = (&u[..n], &h[..n]);
                strands(n, |i| {
                    let free = if p[i] > 0.0 && p[i] < hardness.at(i) { p[i] } else { 0.0 };
                    let closed = if free > 0.0 { free * (compliance * u[i] + h[i]) } else { 0.0 };
                    [free, closed, f64::from(u8::from(p[i] > 0.0))]
                })
            });
        let approach = match row.control {
            _ if weight > 0.0 => moment / weight,
            Control::Approach => prescribed,
            // Every touching cell is at the hardness: bounded from below only.
            _ if touching > 0.0 => self.state.approach,
            _ => minimum(&gap),
        };
        Some(Between {
            instant: Instant { time, dt: time - start, value: prescribed, ..row },
            state: ContactState { pressure, unit_displacement: unit, approach, rounding: f64::INFINITY },
            gap,
            history,
            compliance,
        })
    }

    /// A state between rows as a row: its fields and numbers. Its index is that of the last row; work, residual and
    /// certificate are those of the last row's solve.
    pub fn view<'a>(&'a self, between: &'a Between) -> Step<'a> {
        Step {
            index: self.done.saturating_sub(1),
            instant: between.instant,
            simulation: &self.simulation,
            state: &between.state,
            gap: &between.gap,
            compliance: between.compliance,
            outcome: self.outcome,
            remembered: Remembered::Field(&between.history),
            time_error: None,
            hardness: cap(&self.simulation, &self.hardness),
            dents: self.dents.as_ref(),
            meter: None,
        }
    }
}
