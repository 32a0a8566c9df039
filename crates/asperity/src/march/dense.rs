//! The state between two rows, consistent with the scheme: dense output.
//!
//! Within a step u runs linearly in time, or in L = ∫ C dW under load control ([`super::memory`]). The load follows from the
//! memory of the load as a cell, and the pressure is the mixture of those at both ends that has this load: exact while the
//! contact set stands, of second order where it moves. The approach is the one at which the cells in contact are closed in the
//! pressure-weighted mean, sum p (h0 + u - w) = 0 over 0 < p < H. The steps themselves take no notice.

use crate::contact::{ContactState, Hardness};
use crate::drive::Coordinate;
use crate::load::Control;
use crate::march::record::{Remembered, Step};
use crate::march::{March, Past, cap, datum, undeformed};
use crate::time::Instant;
use asperity_sweep::{minimum, strands, sum, sweep};

/// A state within the last step of a march; [`March::view`] shows it as a row.
pub struct Between {
    instant: Instant,
    state: ContactState,
    /// h0 + u.
    gap: Vec<f64>,
    /// u.
    displacement: Vec<f64>,
}

impl March {
    /// The state at `time` within the last step: after the row before it, not after the last row. `None`
    /// outside of it, and where the scheme is not [`Scheme::Linear`](crate::Scheme::Linear).
    pub fn between(&self, time: f64) -> Option<Between> {
        let (index, row) = self.current?;
        let start = row.time - row.dt;
        let Past::Memory(memory) = &self.past else { return None };
        if index + 1 != self.done || row.jump || !(time > start && time <= row.time) {
            return None;
        }
        let clocks = self.simulation.thermal.iter().map(|body| body.clock.elapsed(start, time));
        let lengths: Vec<f64> = std::iter::once(time - start).chain(clocks).collect();
        let moment = memory.moment(&lengths);
        let hardness = cap(&self.simulation, &self.hardness);
        let ends = self.ends();
        let cell_area = self.simulation.grid.cell_area();
        let [before, now] = [ends.before.0, ends.now.0].map(|p| cell_area * sum(p));
        let mixed = before + moment.share * (now - before);
        let scale = if mixed > 0.0 { moment.load / mixed } else { 1.0 };
        let mix = |a: &[f64], b: &[f64], top: Hardness| -> Vec<f64> {
            let mut field = vec![0.0; a.len()];
            sweep((&mut field[..], a, b, top), &|(m, a, b, top): (&mut [f64], &[f64], &[f64], Hardness)| {
                for (i, m) in m.iter_mut().enumerate() {
                    let value = a[i] + moment.share * (b[i] - a[i]);
                    // Cells at the hardness at both ends stay there.
                    *m = if value >= top.at(i) { top.at(i) } else { (scale * value).min(top.at(i)) };
                }
            });
            field
        };
        let pressure = mix(ends.before.0, ends.now.0, hardness);
        let unit = mix(ends.before.1, ends.now.1, Hardness::Uniform(f64::INFINITY));
        let rigid = undeformed(&self.simulation, &self.dents, &self.moving);
        let mut displacement = vec![0.0; unit.len()];
        let of_end = if memory.is_elastic() { &unit } else { &self.state.unit_displacement };
        memory.displaced(&lengths, moment, (of_end, &self.gap, rigid), &mut displacement);
        let mut gap = rigid.to_vec();
        sweep((&mut gap[..], &displacement[..]), &|(h, u): (&mut [f64], &[f64])| {
            h.iter_mut().zip(u).for_each(|(h, u)| *h += u);
        });
        let prescribed = self.timeline.value_within(row, time);
        let cells = (&pressure[..], &gap[..], hardness);
        let [weight, closed, touching] = sweep(cells, &|(p, h, hardness): (&[f64], &[f64], Hardness)| {
            strands(p.len(), |i| {
                let free = if p[i] > 0.0 && p[i] < hardness.at(i) { p[i] } else { 0.0 };
                let closed = if free > 0.0 { free * h[i] } else { 0.0 };
                [free, closed, f64::from(u8::from(p[i] > 0.0))]
            })
        });
        let approach = match row.control {
            _ if weight > 0.0 => closed / weight,
            Control::Approach => prescribed,
            // Every touching cell is at the hardness: bounded from below only.
            _ if touching > 0.0 => self.state.approach,
            _ => minimum(&gap),
        };
        Some(Between {
            instant: Instant { time, dt: time - start, value: prescribed, ..row },
            state: ContactState { pressure, unit_displacement: unit, approach, rounding: f64::INFINITY },
            gap,
            displacement,
        })
    }

    /// A state between rows as a row: its fields and numbers. Its index is that of the last row; work, residual and
    /// certificate are those of the last row's solve.
    pub fn view<'a>(&'a self, between: &'a Between) -> Step<'a> {
        Step {
            index: self.done.saturating_sub(1),
            coordinate: Coordinate::Time(between.instant.time),
            instant: Some(between.instant),
            control: between.instant.control,
            simulation: &self.simulation,
            state: &between.state,
            gap: &between.gap,
            compliance: 0.0,
            outcome: self.outcome,
            remembered: Remembered::Field(&between.displacement),
            time_error: None,
            hardness: cap(&self.simulation, &self.hardness),
            dents: self.dents.as_ref(),
            meter: None,
            datum: datum(&self.simulation, &between.displacement),
            friction: None,
        }
    }
}
