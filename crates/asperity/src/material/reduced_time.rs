//! Reduced time of a material whose temperature changes during the run.
//!
//! With the shift factor a_T the reduced time advances by d xi = dt / a_T(T(t)) (L. W. Morland & E. H. Lee, Trans. Soc. Rheology
//! 4 (1960) 233). The argument of the creep function is xi(t) - xi(s) instead of t - s, so time stepping in xi instead of t is
//! exact.

use crate::error::{Error, Result, kelvin, require, times_with_jumps};
use crate::material::Shift;
use crate::material::quadrature::integrate;

/// The reduced time xi(t) = int_0^t ds / a_T(T(s)) of a temperature history.
///
/// ```
/// use asperity::material::{ReducedTime, Shift};
/// // 100 s at the reference temperature, then 20 K warmer.
/// let shift = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 300.0 };
/// let clock = ReducedTime::new(shift.clone(), &[(0.0, 300.0), (100.0, 300.0), (100.0, 320.0)])?;
/// assert!((clock.value(100.0) - 100.0).abs() < 1e-11);
/// let faster = 1.0 / shift.factor(320.0)?;
/// assert!((clock.value(150.0) / (100.0 + 50.0 * faster) - 1.0).abs() < 1e-13);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ReducedTime {
    shift: Shift,
    /// Pieces of linear temperature, in order, the first from t = 0.
    pieces: Vec<Piece>,
}

/// From (start, from) the temperature changes linearly to `to` at `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    start: f64,
    end: f64,
    from: f64,
    to: f64,
    /// xi at its start.
    reduced: f64,
    /// Change of xi over the whole piece.
    length: f64,
}

impl ReducedTime {
    /// The reduced time of a material with `shift` under the temperatures (time \[s\], temperature \[K\]), linear in between and
    /// constant after the last. The first is at t = 0; equal times define a jump.
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the point: no points, times not in order or more than twice the same, a
    /// temperature at which the shift is not defined, or a reduced time beyond the range of doubles.
    pub fn new(shift: Shift, temperatures: &[(f64, f64)]) -> Result<Self> {
        let times: Vec<f64> = temperatures.iter().map(|point| point.0).collect();
        times_with_jumps("the temperature history", &times)?;
        for (n, (_, temperature)) in temperatures.iter().enumerate() {
            shift.ln_factor(*temperature).map_err(|error| match error {
                Error::Invalid { parameter, value, expected, .. } => {
                    let what = format!("temperature of point {}", n + 1);
                    Error::Invalid { parameter, what, value, expected }
                }
                other => other,
            })?;
        }
        if let Some((n, (_, t))) =
            temperatures.iter().enumerate().find(|(_, p)| shift.ln_factor_unchecked(p.1) < -690.0)
        {
            return Err(Error::invalid(
                format!("temperature of point {}", n + 1),
                kelvin(*t),
                "one at which the shift factor is above 1e-300: check the constants of the shift",
            ));
        }
        let mut clock = ReducedTime { shift, pieces: vec![] };
        let mut reduced = 0.0;
        let Some(last) = temperatures.last() else { return Ok(clock) };
        let held = [*last, (f64::INFINITY, last.1)];
        // A jump takes no time.
        let takes_time = |pair: &&[(f64, f64)]| pair[0].0 < pair[1].0;
        for pair in temperatures.windows(2).chain([held.as_slice()]).filter(takes_time) {
            let ((start, from), (end, to)) = (pair[0], pair[1]);
            for mut piece in clock.split_at_knots(Piece { start, end, from, to, reduced: 0.0, length: 0.0 }) {
                piece.reduced = reduced;
                if piece.end.is_finite() {
                    piece.length = clock.within(&piece, piece.start, piece.end).ok_or_else(|| {
                        Error::invalid(
                            "temperature history",
                            format!("{} to {} from {start:e} s to {end:e} s", kelvin(from), kelvin(to)),
                            "within reach of the shift: check the temperatures and its constants",
                        )
                    })?;
                    reduced += piece.length;
                }
                clock.pieces.push(piece);
            }
        }
        require(
            reduced.is_finite(),
            "reduced time of the temperature history",
            reduced,
            "finite: check the temperatures and the constants of the shift",
        )?;
        Ok(clock)
    }

    /// xi(t) \[s\]; 0 for t < 0.
    pub fn value(&self, t: f64) -> f64 {
        if t <= 0.0 {
            return 0.0;
        }
        let piece = &self.pieces[self.index(t)];
        piece.reduced + self.part(piece, piece.start, t)
    }

    /// xi(t1) - xi(t0) for t0 <= t1, without cancellation for short steps at late times.
    pub fn elapsed(&self, t0: f64, t1: f64) -> f64 {
        let (t0, t1) = (t0.max(0.0), t1.max(0.0));
        let (first, last) = (self.index(t0), self.index(t1));
        if first >= last {
            return self.part(&self.pieces[first], t0, t1);
        }
        let (begin, end) = (&self.pieces[first], &self.pieces[last]);
        let between: f64 = self.pieces[first + 1..last].iter().map(|p| p.length).sum();
        self.part(begin, t0, begin.end) + between + self.part(end, end.start, t1)
    }

    /// Temperature at t \[K\]; at a jump the value after it.
    pub fn temperature(&self, t: f64) -> f64 {
        let t = t.max(0.0);
        self.pieces[self.index(t)].temperature(t)
    }

    /// Times in (0, end) at which the temperature has a kink or a jump: steps should end there.
    pub fn breaks(&self, end: f64) -> Vec<f64> {
        let mut times: Vec<f64> =
            self.pieces.iter().map(|p| p.start).filter(|t| *t > 0.0 && *t < end).collect();
        times.dedup();
        times
    }

    /// |ln| of the ratio of the rates dxi/dt at both ends of a step between two [`breaks`](Self::breaks).
    pub(crate) fn drift(&self, t0: f64, t1: f64) -> f64 {
        let piece = &self.pieces[self.index(t0.max(0.0))];
        let at = |t: f64| self.shift.ln_factor_unchecked(piece.temperature(t.min(piece.end)));
        (at(t1) - at(t0)).abs()
    }

    /// Integral over part of a piece, which is no steeper than the whole.
    fn part(&self, piece: &Piece, t0: f64, t1: f64) -> f64 {
        self.within(piece, t0, t1).unwrap_or(piece.length)
    }

    /// The last piece that starts at or before t.
    fn index(&self, t: f64) -> usize {
        self.pieces.partition_point(|p| p.start <= t).max(1) - 1
    }

    /// Integral of 1/a_T over part of a piece; `None` if its temperatures are too steep for numbers.
    fn within(&self, piece: &Piece, t0: f64, t1: f64) -> Option<f64> {
        if t1 <= t0 {
            return Some(0.0);
        }
        let ln_rate = |t: f64| -self.shift.ln_factor_unchecked(piece.temperature(t));
        let fastest = ln_rate(t0).max(ln_rate(t1));
        if piece.temperature(t0) == piece.temperature(t1) {
            return Some((t1 - t0) * fastest.exp());
        }
        // Parts that are exp(60) times slower than the fastest do not change the last digit.
        let mut budget = 10_000;
        self.halve(piece, [t0, t1], fastest - 60.0, 100, &mut budget)
    }

    /// Bisects until the integrand is smooth enough for one Gauss rule to be exact to rounding: 1/a_T within a factor e, and far
    /// from the singularity of the law. Parts entirely below `negligible` are left out. About a hundred parts are enough for any
    /// material; `depth` and `budget` limit the work for absurd constants.
    fn halve(
        &self,
        piece: &Piece,
        [t0, t1]: [f64; 2],
        negligible: f64,
        depth: u32,
        budget: &mut u32,
    ) -> Option<f64> {
        let (from, to) = (piece.temperature(t0), piece.temperature(t1));
        let ln_rate = |temperature: f64| -self.shift.ln_factor_unchecked(temperature);
        if ln_rate(from).max(ln_rate(to)) < negligible {
            return Some(0.0);
        }
        *budget = budget.checked_sub(1)?;
        let change = ln_rate(to) - ln_rate(from);
        let singular = match self.shift {
            Shift::Wlf { c2, reference, .. } => reference - c2,
            _ => 0.0,
        };
        let ratio = (to - singular) / (from - singular);
        if change.abs() <= 1.0 && (0.5..=2.0).contains(&ratio) {
            return Some(integrate(t0, t1, |t| ln_rate(piece.temperature(t)).exp()));
        }
        let (middle, depth) = (0.5 * (t0 + t1), depth.checked_sub(1)?);
        let first = self.halve(piece, [t0, middle], negligible, depth, budget)?;
        Some(first + self.halve(piece, [middle, t1], negligible, depth, budget)?)
    }

    /// A table of shift factors has kinks at its temperatures: pieces between them.
    fn split_at_knots(&self, piece: Piece) -> Vec<Piece> {
        let Shift::Table { points } = &self.shift else { return vec![piece] };
        let inside = |t: &f64| *t > piece.start && *t < piece.end;
        let crossing = |knot: f64| {
            piece.start + (piece.end - piece.start) * (knot - piece.from) / (piece.to - piece.from)
        };
        let mut times = vec![piece.start, piece.end];
        if piece.end.is_finite() && piece.from != piece.to {
            times.extend(points.iter().map(|p| crossing(p.0)).filter(inside));
        }
        times.sort_by(f64::total_cmp);
        let part = |pair: &[f64]| Piece {
            start: pair[0],
            end: pair[1],
            from: piece.temperature(pair[0]),
            to: piece.temperature(pair[1]),
            ..piece
        };
        times.windows(2).map(part).collect()
    }
}

impl Piece {
    fn temperature(&self, t: f64) -> f64 {
        if self.end.is_infinite() || self.from == self.to {
            return self.from;
        }
        let share = ((t - self.start) / (self.end - self.start)).clamp(0.0, 1.0);
        // Between the two ends for any rounding: the shift is defined there.
        (self.from + share * (self.to - self.from)).clamp(self.from.min(self.to), self.from.max(self.to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wlf() -> Shift {
        Shift::Wlf { c1: 8.86, c2: 101.6, reference: 300.0 }
    }

    #[test]
    fn ramps_meet_their_integrals() {
        // Integrals of 1/a_T with 40 digits.
        let arrhenius = Shift::Arrhenius { activation_energy: 1e5, reference: 300.0 };
        let steep = Shift::Wlf { c1: 17.44, c2: 101.6, reference: 300.0 };
        for (shift, from, to, end, exact) in [
            (arrhenius, 300.0, 360.0, 100.0, 13_526.418_090_843_95),
            (wlf(), 260.0, 320.0, 100.0, 306.497_751_514_502_16),
            // From 0.6 K above the pole, over thousands of decades.
            (steep, 199.0, 399.0, 50.0, 911_604_395.708_942_5),
        ] {
            let clock = ReducedTime::new(shift, &[(0.0, from), (end, to)]).unwrap();
            // Rounding of exponents up to 7 in the bulk of the integral.
            assert!((clock.value(end) / exact - 1.0).abs() < 1e-14, "{}", clock.value(end) / exact - 1.0);
        }
    }

    #[test]
    fn a_table_has_a_closed_form_between_its_bends() {
        let table = Shift::Table { points: vec![(300.0, 0.0), (310.0, -3.0), (320.0, -4.0)] };
        let clock = ReducedTime::new(table, &[(0.0, 300.0), (20.0, 320.0)]).unwrap();
        // int exp(0.3 t) over 10 s, then exp(3) int exp(0.1 t) over 10 s.
        let exact = 3f64.exp_m1() / 0.3 + 3f64.exp() * 1f64.exp_m1() / 0.1;
        assert!((clock.value(20.0) / exact - 1.0).abs() < 1e-14);
        assert_eq!(clock.breaks(100.0), vec![10.0, 20.0]);
    }

    #[test]
    fn steps_add_up_and_short_late_ones_keep_their_digits() {
        let points = [(0.0, 290.0), (10.0, 330.0), (10.0, 300.0), (40.0, 310.0), (1e6, 305.0)];
        let clock = ReducedTime::new(wlf(), &points).unwrap();
        let times = [0.0, 3.0, 10.0, 11.0, 39.0, 45.0, 1e5, 2e6];
        let sum: f64 = times.windows(2).map(|pair| clock.elapsed(pair[0], pair[1])).sum();
        assert!((sum / clock.value(2e6) - 1.0).abs() < 1e-14);
        assert_eq!(clock.elapsed(3.0, 3.0), 0.0);
        // A microsecond after 1.5e6 s at 305 K; the subtraction of two times has lost 4 digits already.
        let (t0, t1) = (1.5e6, 1.5e6 + 1e-6);
        let exact = (t1 - t0) / wlf().factor(305.0).unwrap();
        assert!((clock.elapsed(t0, t1) / exact - 1.0).abs() < 1e-14);
        assert_eq!((clock.temperature(10.0), clock.temperature(5.0)), (300.0, 310.0));
        assert_eq!((clock.value(-1.0), clock.temperature(1e9)), (0.0, 305.0));
    }

    #[test]
    fn at_the_reference_temperature_the_clock_is_right() {
        let clock = ReducedTime::new(wlf(), &[(0.0, 300.0)]).unwrap();
        assert_eq!(clock.value(123.456), 123.456);
    }

    #[test]
    fn bad_histories_are_named() {
        let says = |points: &[(f64, f64)], words: &str| {
            let error = ReducedTime::new(wlf(), points).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        says(&[], "temperature history is empty");
        says(&[(1.0, 300.0)], "first time");
        says(&[(0.0, 300.0), (2.0, 300.0), (1.0, 300.0)], "time of point 3");
        says(&[(0.0, 300.0), (1.0, 300.0), (1.0, 301.0), (1.0, 302.0)], "time of point 4");
        says(&[(0.0, 300.0), (f64::NAN, 300.0)], "time of point 2");
        says(&[(0.0, 300.0), (1.0, 25.0)], "temperature of point 2 is 25 K");
        says(&[(0.0, f64::INFINITY)], "temperature of point 1");
    }
}
