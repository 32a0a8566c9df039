//! A rigid sphere on a linear viscoelastic half-space, with a contact that grows and then shrinks: T. C. T. Ting, J. Appl. Mech.
//! 33 (1966) 845; E. H. Lee and J. R. M. Radok, J. Appl. Mech. 27 (1960) 438.
//!
//! With C(t) the contact creep compliance, E*(t) the corresponding relaxation function, and L(t) = int C(t - s) dW(s) the load
//! convolved with the creep function:
//!
//! ```text
//! growing (up to t_m, where L is largest):
//!   a^3 = (3 R / 4) L(t),   approach = a^2 / R
//! shrinking: t1(t) < t_m is when the contact had this radius before,
//!   W(t) = int_0^t1 E*(t - s) dL(s),   a(t) = a(t1)
//!   approach(t) = approach(t_m) - int_(t_m)^t C(t - s) dQ(s),   Q(t) = int_t1^(t_m) E*(t - s) d(a^2/R)(s)
//! always, with t1 = t while the contact grows:
//!   p(r, t) = (2 / (pi R)) int_0^t1 E*(t - s) d[sqrt(a(s)^2 - r^2)]
//! ```
//!
//! The integrals are evaluated by parts, so that only smooth functions are integrated, to about twelve digits. Histories that
//! reload before the contact has opened need [`Mdr`](super::Mdr).

use std::f64::consts::PI;

use super::hereditary::{hereditary, hereditary_before};
use super::quadrature::{integrate_to, root};
use crate::error::{Error, Result, non_negative, positive, require};
use crate::load::History;
use crate::material::{Creep, Relaxation};

/// A rigid sphere of radius R on a viscoelastic half-space under a load history in which the contact grows once and then shrinks
/// once.
///
/// ```
/// use asperity::History;
/// use asperity::material::{Creep, CreepTerm};
/// use asperity::reference::Ting;
///
/// let term = CreepTerm { compliance: 0.25, retardation_time: 1.0 };
/// let zener = Creep { instantaneous: 0.25, terms: vec![term], fluidity: 0.0 };
/// let history = History::Triangle { peak: 1.0, rise: 1.0, fall: 1.0 };
/// let contact = Ting::new(1.0, &zener, &history, 2.0)?;
/// let state = contact.at(1.5)?;
/// assert!((state.contact_radius - 0.5522081150543112).abs() < 1e-12);
/// assert!((state.approach - 0.3288971169956224).abs() < 1e-10);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Ting {
    radius: f64,
    creep: Creep,
    relaxation: Relaxation,
    history: History,
    end: f64,
    /// t_m, and L just before it or after it, whichever is larger.
    turn: f64,
    largest: f64,
}

/// The contact at one time (just after it if the history has a jump there).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TingState {
    /// Load W \[N\].
    pub load: f64,
    /// Radius of the contact a \[m\].
    pub contact_radius: f64,
    /// Approach \[m\].
    pub approach: f64,
    /// Pressure in the middle \[Pa\].
    pub peak_pressure: f64,
    /// Time t1 at which the growing contact had this radius \[s\]; t itself while it grows.
    pub reached: f64,
}

/// Number of times at which a history is checked for one growth and one shrinkage.
const CHECKS: u32 = 200;

impl Ting {
    /// A contact from t = 0 to `end` \[s\] under the load `history` \[N\].
    ///
    /// # Errors
    /// [`Error::Invalid`] if the radius, the creep function or the history is invalid, the creep
    /// function has no instantaneous compliance, the load is negative at times, or the contact grows
    /// again after it shrank.
    pub fn new(radius: f64, creep: &Creep, history: &History, end: f64) -> Result<Self> {
        positive("radius", radius, "m")?;
        positive("end", end, "s")?;
        creep.validate()?;
        positive("instantaneous compliance", creep.instantaneous, "1/Pa")?;
        history.validate()?;
        let lowest = history.range(end)[0];
        require(lowest >= 0.0, "smallest load of the history", format!("{lowest} N"), "0 N or more")?;
        let (creep, history) = (creep.clone(), history.clone());
        let relaxation = creep.to_relaxation()?;
        let mut contact = Ting { radius, creep, relaxation, history, end, turn: 0.0, largest: 0.0 };
        contact.find_turn()?;
        contact.check_shrinkage()?;
        Ok(contact)
    }

    /// Time t_m at which the contact is largest \[s\].
    pub fn turn(&self) -> f64 {
        self.turn
    }

    /// Load, contact radius, approach and peak pressure at t \[s\].
    ///
    /// # Errors
    /// [`Error::Invalid`] if t is outside \[0, end\].
    pub fn at(&self, t: f64) -> Result<TingState> {
        self.check_time(t)?;
        let (reached, seen) = self.reached(t);
        let contact_radius = self.radius_of(seen);
        let approach = if reached == t { self.depth_of(seen) } else { self.shrinking_approach(t) };
        let peak_pressure = self.pressure_at(0.0, t, reached, contact_radius);
        Ok(TingState { load: self.history.after(t), contact_radius, approach, peak_pressure, reached })
    }

    /// Pressure at the distance r from the axis and the time t \[Pa\].
    ///
    /// # Errors
    /// [`Error::Invalid`] if t is outside \[0, end\] or r is negative.
    pub fn pressure(&self, r: f64, t: f64) -> Result<f64> {
        self.check_time(t)?;
        non_negative("distance from the axis", r, "m")?;
        let (reached, seen) = self.reached(t);
        Ok(self.pressure_at(r, t, reached, self.radius_of(seen)))
    }

    fn check_time(&self, t: f64) -> Result<()> {
        let expected = format!("between 0 and {} s", self.end);
        require((0.0..=self.end).contains(&t), "time", format!("{t} s"), expected)
    }

    /// L(t+).
    fn seen(&self, t: f64) -> f64 {
        hereditary(&self.creep, &self.history, t)
    }

    fn radius_of(&self, seen: f64) -> f64 {
        (0.75 * self.radius * seen).cbrt()
    }

    fn depth_of(&self, seen: f64) -> f64 {
        self.radius_of(seen).powi(2) / self.radius
    }

    /// t1 and L(t1), or the part of L(t1) that carries load at t if L jumps at t1.
    fn reached(&self, t: f64) -> (f64, f64) {
        let seen = self.seen(t);
        // If L is constant at its largest value (a held load on an elastic body), the contact is not yet shrinking.
        if t < self.turn || seen >= self.largest * (1.0 - 1e-14) {
            return (t, seen);
        }
        let load = self.history.after(t);
        if load <= 0.0 {
            return (0.0, 0.0);
        }
        // int_0^t1 E*(t - s) dL(s), increasing with t1.
        let carried = |t1: f64| {
            self.relaxation.value(t - t1) * self.seen(t1) - self.faded(t, 0.0, t1, |s| self.seen(s))
        };
        let t1 = root(0.0, self.turn, |t1| carried(t1) - load);
        let seen = (load + self.faded(t, 0.0, t1, |s| self.seen(s))) / self.relaxation.value(t - t1);
        (t1, seen.clamp(0.0, self.largest))
    }

    /// int_from^to (d/ds E*(t - s)) f(s) ds, between the kinks and jumps of the history.
    fn faded(&self, t: f64, from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
        let rate = |s: f64| {
            let terms = self.relaxation.terms.iter();
            terms.map(|e| e.modulus / e.relaxation_time * ((s - t) / e.relaxation_time).exp()).sum::<f64>()
        };
        self.pieces(from, to).map(|(a, b)| integrate_to(1e-13, a, b, |p| rate(p.x) * f(p.x))).sum()
    }

    /// The smooth pieces of the history between two times.
    fn pieces(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
        let mut times = vec![from];
        times.extend(self.history.breaks(to).into_iter().filter(|s| *s > from));
        times.push(to);
        (1..times.len()).map(move |n| (times[n - 1], times[n]))
    }

    fn shrinking_approach(&self, t: f64) -> f64 {
        // Load that the growth from t1 to t_m would still carry if it had not been removed.
        let lost = |t: f64| {
            let (t1, seen) = self.reached(t);
            let (outer, inner) = (self.depth_of(self.largest), self.depth_of(seen));
            let ends = self.relaxation.value(t - self.turn) * outer - self.relaxation.value(t - t1) * inner;
            ends - self.faded(t, t1, self.turn, |s| self.depth_of(self.seen(s)))
        };
        let later: f64 = self
            .pieces(self.turn, t)
            .map(|(a, b)| integrate_to(1e-7, a, b, |p| self.creep.rate(t - p.x) * lost(p.x)))
            .sum();
        self.depth_of(self.largest) - self.creep.instantaneous * lost(t) - later
    }

    fn pressure_at(&self, r: f64, t: f64, reached: f64, contact_radius: f64) -> f64 {
        if r >= contact_radius {
            return 0.0;
        }
        let q = |a: f64| ((a - r) * (a + r)).max(0.0).sqrt();
        // The time at which the contact reached r: there q starts as a square root.
        let start = root(0.0, reached, |s| self.radius_of(self.seen(s)) - r);
        let ends = self.relaxation.value(t - reached) * q(contact_radius);
        let fading = self.faded(t, start, reached, |s| q(self.radius_of(self.seen(s))));
        2.0 / (PI * self.radius) * (ends - fading)
    }

    /// The largest L: at a kink or jump (before or after it), or at a smooth maximum between two.
    fn find_turn(&mut self) -> Result<()> {
        let mut times: Vec<f64> = (0..=CHECKS).map(|n| self.end * f64::from(n) / f64::from(CHECKS)).collect();
        times.extend(self.history.breaks(self.end));
        times.sort_by(f64::total_cmp);
        let values: Vec<[f64; 2]> = times
            .iter()
            .map(|t| [hereditary_before(&self.creep, &self.history, *t), self.seen(*t)])
            .collect();
        let flat: Vec<(f64, f64)> = times
            .iter()
            .zip(&values)
            .flat_map(|(t, [before, after])| [(*t, *before), (*t, *after)])
            .collect();
        // The last of equal values: a flat maximum still counts as growing.
        let top = (0..flat.len())
            .rev()
            .fold(flat.len() - 1, |best, n| if flat[n].1 > flat[best].1 { n } else { best });
        (self.turn, self.largest) = flat[top];
        let grows = flat[..=top].windows(2).all(|w| w[1].1 >= w[0].1 * (1.0 - 1e-12));
        if !grows {
            return Err(self.reloads());
        }
        // Golden section on both sides: L is smooth there, so its value has twice the digits of t_m.
        let (low, high) = (flat[top.saturating_sub(2)].0, flat[(top + 2).min(flat.len() - 1)].0);
        for (a, b) in [(low, self.turn), (self.turn, high)] {
            let t = self.summit(a, b);
            if self.seen(t) > self.largest * (1.0 + 1e-15) {
                (self.turn, self.largest) = (t, self.seen(t));
            }
        }
        Ok(())
    }

    fn summit(&self, mut a: f64, mut b: f64) -> f64 {
        let share = 0.5 * (5f64.sqrt() - 1.0);
        for _ in 0..60 {
            let (c, d) = (b - share * (b - a), a + share * (b - a));
            if self.seen(c) > self.seen(d) { b = d } else { a = c }
        }
        0.5 * (a + b)
    }

    fn check_shrinkage(&self) -> Result<()> {
        let mut times: Vec<f64> = (0..=CHECKS)
            .map(|n| self.turn + (self.end - self.turn) * f64::from(n) / f64::from(CHECKS))
            .collect();
        times.extend(self.history.breaks(self.end).into_iter().filter(|s| *s > self.turn));
        times.sort_by(f64::total_cmp);
        let seen: Vec<f64> = times.iter().map(|t| self.reached(*t).1).collect();
        if seen.windows(2).all(|w| w[1] <= w[0] + 1e-10 * self.largest) {
            Ok(())
        } else {
            Err(self.reloads())
        }
    }

    fn reloads(&self) -> Error {
        Error::invalid(
            "load history",
            "one whose contact grows again after it shrank",
            "one growth and one shrinkage of the contact; use the method of dimensionality reduction for others",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::CreepTerm;

    fn zener() -> Creep {
        // E*(t) = 2 + 2 exp(-t/0.5)
        let term = CreepTerm { compliance: 0.25, retardation_time: 1.0 };
        Creep { instantaneous: 0.25, terms: vec![term], fluidity: 0.0 }
    }

    /// PMMA, contact compliance with Poisson's ratio 0.5.
    fn pmma() -> Creep {
        Creep {
            instantaneous: 3.0103087420810817e-10,
            terms: vec![
                CreepTerm { compliance: 3.355546745585038e-11, retardation_time: 9.936295903145377 },
                CreepTerm { compliance: 4.5545437352767234e-11, retardation_time: 133.87048745620586 },
            ],
            fluidity: 0.0,
        }
    }

    fn triangle(peak: f64, rise: f64) -> History {
        History::Triangle { peak, rise, fall: rise }
    }

    fn near(a: f64, b: f64, tolerance: f64) -> bool {
        (a - b).abs() <= tolerance * b.abs()
    }

    #[test]
    fn a_step_has_tings_numbers() {
        // a, approach and p at r / a(0); the integrals with 15 digits.
        let contact = Ting::new(1.0, &zener(), &History::Step { value: 1.0 }, 10.0).unwrap();
        let first = contact.at(0.0).unwrap().contact_radius;
        #[rustfmt::skip]
        let rows = [
            (0.0, 0.5723571212766659, 0.3275926742761121, vec![(0.0, 1.4574954410404608), (0.25, 1.4112138925807347), (0.5, 1.2622280778410435), (0.75, 0.9640426185008657), (0.9, 0.6353075338166613), (0.95, 0.45510280559862365), (1.0, 0.0), (1.05, 0.0), (1.1, 0.0), (1.15, 0.0), (1.2, 0.0)]),
            (0.5, 0.6392924319704553, 0.40869481357469917, vec![(0.0, 1.1328248143779773), (0.25, 1.1051158357773634), (0.5, 1.0175096608638394), (0.75, 0.8520028855127899), (0.9, 0.6944818850938387), (0.95, 0.6265153133211104), (1.0, 0.5494745363591991), (1.05, 0.4570726440485759), (1.1, 0.26522778970316885), (1.15, 0.0), (1.2, 0.0)]),
            (4.0, 0.7189167208288686, 0.5168412514873334, vec![(0.0, 0.9184269171416533), (0.25, 0.9001644361695204), (0.5, 0.8430074118462245), (0.75, 0.7379782491638622), (0.9, 0.6427411357525907), (0.95, 0.6033071998417786), (1.0, 0.5587479996418747), (1.05, 0.5077257286905554), (1.1, 0.448026802637719), (1.15, 0.3755525240365764), (1.2, 0.2806431557715356)]),
        ];
        for (t, a, delta, pressures) in rows {
            let state = contact.at(t).unwrap();
            assert!(near(state.contact_radius, a, 1e-14) && near(state.approach, delta, 1e-14));
            for (share, p) in pressures {
                let got = contact.pressure(share * first, t).unwrap();
                assert!((got - p).abs() < 1e-12 * state.peak_pressure, "{t} {share}: {got} {p}");
            }
        }
    }

    #[test]
    fn a_triangle_has_tings_numbers_up_and_down() {
        #[rustfmt::skip]
        let zener_rows = [
            (0.1, 0.2698811359817622, 0.07283582755880644, 0.6401681797863843),
            (0.25, 0.3739082839767314, 0.13980740482642404, 0.8086783208723262),
            (0.5, 0.4844898432716986, 0.23473040823343505, 0.927664608905338),
            (0.75, 0.5670357331738216, 0.3215295226959734, 0.9924279521407543),
            (0.9, 0.6093281245294206, 0.3712807633425412, 1.0225829608316),
            (1.0, 0.6353548723995163, 0.4036758138818056, 1.040995764935268),
            (1.05, 0.6320795010662672, 0.3996519445537747, 1.0110191099040888),
            (1.1, 0.627901353017548, 0.3948341014388259, 0.9818981720696836),
            (1.25, 0.6091865166254746, 0.375790548771818, 0.898089405814992),
            (1.5, 0.5522081150543112, 0.3288971169956224, 0.7594286407751805),
            (1.75, 0.44731972871928344, 0.260018352185578, 0.5915239952982976),
            (1.9, 0.33175326051509085, 0.2016630667055389, 0.4328264888935619),
            (2.0, 0.0, 0.13456125573885674, 0.0),
        ];
        #[rustfmt::skip]
        let pmma_rows = [
            (1.0, 0.00028319694053705616, 8.020050712954892e-06, 59360252.64942359),
            (2.5, 0.0003854155856933076, 1.4854517369531535e-05, 79818294.9444216),
            (5.0, 0.00048755572152390603, 2.377105815906966e-05, 99257023.38902253),
            (7.5, 0.0005600451089615612, 3.13650524071767e-05, 112421860.86850859),
            (9.0, 0.0005962342341996346, 3.554952620316247e-05, 118823491.36082624),
            (10.0, 0.0006182526461409555, 3.822363344602936e-05, 122671495.25026329),
            (10.5, 0.0006089757171174327, 3.7091400670186104e-05, 120337134.55947886),
            (11.0, 0.000599209207753161, 3.592971438635981e-05, 117950590.7539462),
            (12.5, 0.0005666391539027238, 3.225272716417848e-05, 110392833.69219437),
            (15.0, 0.0004981143431330967, 2.5342722032384364e-05, 95721959.66501914),
            (17.5, 0.0003971445036169456, 1.6910188806906157e-05, 75530977.05153571),
            (19.0, 0.00029323751118893077, 1.0274627729275239e-05, 55488908.09276317),
            (20.0, 0.0, 2.424614831979954e-06, 0.0),
        ];
        for (radius, creep, history, rows) in [
            (1.0, zener(), triangle(1.0, 1.0), &zener_rows[..]),
            (0.01, pmma(), triangle(100.0, 10.0), &pmma_rows[..]),
        ] {
            let end = rows[rows.len() - 1].0;
            let contact = Ting::new(radius, &creep, &history, end).unwrap();
            for (t, a, delta, p0) in rows {
                let state = contact.at(*t).unwrap();
                assert!(
                    (state.contact_radius - a).abs() < 1e-11 * contact.at(end / 2.0).unwrap().contact_radius
                );
                assert!(near(state.approach, *delta, 1e-10), "{t}: {} {delta}", state.approach);
                assert!((state.peak_pressure - p0).abs() <= 1e-11 * p0, "{t}: {} {p0}", state.peak_pressure);
            }
        }
    }

    #[test]
    fn pressures_carry_the_load_and_vanish_at_the_edge() {
        let contact = Ting::new(1.0, &zener(), &triangle(1.0, 1.0), 2.0).unwrap();
        for t in [0.7, 1.4] {
            let state = contact.at(t).unwrap();
            let a = state.contact_radius;
            let p = |r: f64| contact.pressure(r, t).unwrap_or(f64::NAN);
            let load = integrate_to(1e-6, 0.0, a, |x| 2.0 * PI * x.x * p(x.x));
            assert!((load / state.load - 1.0).abs() < 1e-9, "{t}: {load}");
            assert_eq!(p(a), 0.0);
            assert!((p(0.0) / state.peak_pressure - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn an_elastic_body_follows_hertz_up_and_down() {
        let contact = Ting::new(0.5, &Creep::elastic(0.1), &triangle(3.0, 1.0), 2.0).unwrap();
        for t in [0.3, 1.0, 1.3, 1.9] {
            let state = contact.at(t).unwrap();
            let hertz = super::super::HertzSphere::under_load(0.5, 10.0, state.load).unwrap();
            assert!(near(state.contact_radius, hertz.contact_radius, 1e-12));
            assert!(near(state.approach, hertz.approach, 1e-12), "{t}");
            assert!(near(state.peak_pressure, hertz.peak_pressure, 1e-12));
        }
    }

    #[test]
    fn a_load_that_drops_at_once_is_carried_by_the_instantaneous_modulus() {
        // At a jump from W to W - dW: L falls by C(0) dW from int E* dL = W, so E*(t - s) weights the rim.
        let points = vec![(0.0, 1.0), (1.0, 1.0), (1.0, 0.4), (1.2, 0.0)];
        let contact = Ting::new(1.0, &zener(), &History::Table { points }, 1.2).unwrap();
        let (before, after) = (contact.at(1.0 - 1e-12).unwrap(), contact.at(1.0).unwrap());
        assert!((before.load, after.load) == (1.0, 0.4) && contact.turn() == 1.0);
        // The first jump alone carries E*(1) L1 = 0.4, which is less than the load.
        let relaxation = zener().to_relaxation().unwrap();
        assert!(near(after.contact_radius, (0.75 * 0.4 / relaxation.value(1.0)).cbrt(), 1e-12));
        assert!(after.approach < before.approach && after.reached == 0.0);
    }

    #[test]
    fn histories_that_load_again_are_refused() {
        let points = vec![(0.0, 0.0), (1.0, 1.0), (2.0, 0.2), (3.0, 1.0)];
        let message = |history: History| Ting::new(1.0, &zener(), &history, 3.0).unwrap_err().to_string();
        assert!(message(History::Table { points }).contains("grows again"));
        assert!(
            message(History::Sine { mean: 1.0, amplitude: 2.0, frequency: 1.0 }).contains("smallest load")
        );
        let fluid = Creep { instantaneous: 0.0, ..zener() };
        let step = History::Step { value: 1.0 };
        assert!(Ting::new(1.0, &fluid, &step, 1.0).unwrap_err().to_string().contains("instantaneous"));
        assert!(Ting::new(1.0, &zener(), &step, 1.0).unwrap().at(1.5).is_err());
    }
}
