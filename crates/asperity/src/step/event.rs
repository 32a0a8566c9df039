//! Where in a step an event happens: a root of its signal, found by trying shorter steps from the same start.
//!
//! The memory of a step is taken in only with the next one, so a step can be tried again at any length. The root
//! is enclosed and found by the Illinois form of false position (M. Dowell & P. Jarratt, BIT 11 (1971) 168), with a
//! bisection every third time.

/// An event is met to this share of the largest value so far.
pub(super) const MET: f64 = 1e-6;
/// The enclosure ends at this share of the step.
const NARROWEST: f64 = 1e-9;

/// An enclosed event.
#[derive(Clone, Copy, Debug)]
pub(super) struct Enclosure {
    /// A length at which the event has not happened yet, and one at which it has.
    pub(super) near: f64,
    pub(super) far: f64,
    /// Signals there, positive before the event; NaN where unknown.
    before: f64,
    after: f64,
    width: f64,
    count: usize,
    last_near: Option<bool>,
}

impl Enclosure {
    /// Of a step of length `dt` whose signal goes from `before` > 0 (NaN where unknown) to `after` <= 0.
    pub(super) fn new(dt: f64, before: f64, after: f64) -> Self {
        Enclosure { near: 0.0, far: dt, before, after, width: NARROWEST * dt, count: 0, last_near: None }
    }

    /// The length to try next, or `None` where the enclosure is narrow enough: the event is at `far`.
    pub(super) fn guess(&mut self) -> Option<f64> {
        let width = self.far - self.near;
        if width <= self.width || self.count > 200 {
            return None;
        }
        self.count += 1;
        let secant = self.near + width * self.before / (self.before - self.after);
        let middle = self.near + 0.5 * width;
        if self.count.is_multiple_of(3) || !secant.is_finite() {
            return Some(middle);
        }
        // Off the ends, so that both sides close in.
        Some(secant.clamp(self.near + 0.25 * self.width, self.far - 0.25 * self.width))
    }

    /// Takes the signal at the length tried; where it has no value the event has not happened yet.
    pub(super) fn narrow(&mut self, dt: f64, signal: f64) {
        let near = signal > 0.0 || signal.is_nan();
        let repeated = self.last_near == Some(near);
        if near {
            (self.near, self.before) = (dt, signal);
            self.after *= if repeated { 0.5 } else { 1.0 };
        } else {
            (self.far, self.after) = (dt, signal);
            self.before *= if repeated { 0.5 } else { 1.0 };
        }
        self.last_near = Some(near);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_is_enclosed_to_a_billionth_of_the_step() {
        let signals: [(&dyn Fn(f64) -> f64, f64); 4] = [
            (&|t| 1.0 - t, 1.0),
            (&|t| 1.0 - t * t * t / 8.0, 2.0),
            (&|t| if t < 1.5 { 3.0 } else { -1e-3 }, 1.5),
            (&|t| (1.7_f64 - t).signum() * (1.7_f64 - t).abs().sqrt(), 1.7),
        ];
        for (signal, root) in signals {
            for before in [signal(0.0), f64::NAN] {
                let mut enclosure = Enclosure::new(4.0, before, signal(4.0));
                let mut tries = 0;
                while let Some(t) = enclosure.guess() {
                    enclosure.narrow(t, signal(t));
                    tries += 1;
                }
                assert!((enclosure.far - root).abs() <= 4.1e-9, "{root}: {}", enclosure.far);
                assert!(signal(enclosure.far) <= 0.0);
                assert!(tries < 100, "{tries}"); // bisections alone: 30, and every third is one
            }
        }
    }
}
