//! The conductance of the surface over the pressure that presses it: sigma(p), and its integral, the flux potential
//!
//! ```text
//! S(p) = int_0^p sigma dp
//! ```
//!
//! ln sigma is interpolated by the monotone cubic of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5, 300, 1984). Between the last
//! pressure of a sweep that leaks, p_a, and the first one that is tight, p_s, sigma falls as (p_s - p)^3.45 (Dapp and Mueser, EPL 109,
//! 44001, 2015). Nothing is extrapolated: outside of the sweep sigma is held, and [`Conductance::ends`] says where that begins.

use crate::error::{Error, Result};

/// Exponent with which the conductance vanishes where the last path closes.
const CLOSING: f64 = 3.45;
/// Nodes and weights of Gauss and Legendre on \[-1, 1\], one half.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_2, 0.101_228_536_290_376_26],
];
/// Parts of an interval of the sweep that are integrated one by one.
const PARTS: usize = 4;

/// sigma(p) \[m^3\] from a sweep over the pressure p \[Pa\].
#[derive(Clone, Debug, PartialEq)]
pub struct Conductance {
    /// Pressures that leak, increasing.
    pressures: Vec<f64>,
    /// ln sigma at them.
    log: Vec<f64>,
    /// d ln sigma/dp at them.
    slopes: Vec<f64>,
    /// S at them.
    potential: Vec<f64>,
    /// sigma below the first pressure over that at it.
    below: f64,
    /// The first pressure that is tight.
    tight: Option<f64>,
}

impl Conductance {
    /// The conductance of a sweep: pressure \[Pa\] and sigma \[m^3\], 0 where it is tight. A tight pressure below one that leaks is
    /// scatter and left out.
    ///
    /// # Errors
    /// [`Error::Invalid`]: pressures that do not increase from above 0, a negative or infinite sigma, no pressure.
    pub fn new(sweep: &[(f64, f64)]) -> Result<Self> {
        for (n, (pressure, sigma)) in sweep.iter().enumerate() {
            let before = if n == 0 { 0.0 } else { sweep[n - 1].0 };
            if !(pressure.is_finite() && *pressure > before) {
                let expected = format!("a pressure above {before} Pa, that before it");
                return Err(Error::invalid("the pressure of the sweep", pressure, expected).of("sweep"));
            }
            if !(sigma.is_finite() && *sigma >= 0.0) {
                return Err(Error::invalid("the conductance", sigma, "a number of 0 or more").of("sweep"));
            }
        }
        if sweep.is_empty() {
            return Err(Error::invalid("the number of pressures of the sweep", 0, "one or more").of("sweep"));
        }
        let last = sweep.iter().rposition(|(_, sigma)| *sigma > 0.0);
        let tight = sweep.get(last.map_or(0, |last| last + 1)).map(|point| point.0);
        let leaking: Vec<(f64, f64)> = sweep.iter().copied().filter(|point| point.1 > 0.0).collect();
        let pressures: Vec<f64> = leaking.iter().map(|point| point.0).collect();
        let log: Vec<f64> = leaking.iter().map(|point| point.1.ln()).collect();
        let slopes = slopes(&pressures, &log);
        Ok(Conductance { pressures, log, slopes, potential: vec![], below: 1.0, tight }.integrated())
    }

    /// The same with sigma below the first pressure of the sweep times `factor`: what the unknown there may change.
    #[must_use]
    pub fn with_below(&self, factor: f64) -> Self {
        Conductance { below: factor, ..self.clone() }.integrated()
    }

    fn integrated(mut self) -> Self {
        let mut sum = self.pressures.first().map_or(0.0, |first| first * self.below * self.log[0].exp());
        self.potential.clear();
        for n in 0..self.pressures.len() {
            self.potential.push(sum);
            if n + 1 < self.pressures.len() {
                sum += self.integral(n, self.pressures[n + 1]);
            }
        }
        self
    }

    /// The first pressure that is tight \[Pa\]; `None` where all of the sweep leaks.
    pub fn sealing_pressure(&self) -> Option<f64> {
        self.tight
    }

    /// The last pressure that leaks \[Pa\]; `None` where none does.
    pub fn last_leaking(&self) -> Option<f64> {
        self.pressures.last().copied()
    }

    /// The pressures between which sigma is known: first and last of the sweep, or no end where it is tight.
    pub fn ends(&self) -> [f64; 2] {
        let first = self.pressures.first().copied().or(self.tight).unwrap_or(f64::INFINITY);
        let last = if self.tight.is_some() { f64::INFINITY } else { self.last_leaking().unwrap_or(0.0) };
        [first, last]
    }

    /// sigma \[m^3\] at a pressure \[Pa\].
    pub fn at(&self, pressure: f64) -> f64 {
        let (Some(first), Some(last)) = (self.pressures.first(), self.pressures.last()) else { return 0.0 };
        if pressure < *first {
            return self.below * self.log[0].exp();
        }
        if pressure < *last {
            return self.log_at(self.interval(pressure), pressure).exp();
        }
        let end = self.log[self.log.len() - 1].exp();
        match self.tight {
            Some(tight) if pressure >= tight => 0.0,
            Some(tight) => end * ((tight - pressure) / (tight - last)).powf(CLOSING),
            None => end,
        }
    }

    /// S(p).
    pub(super) fn potential(&self, pressure: f64) -> f64 {
        let (Some(first), Some(last)) = (self.pressures.first(), self.pressures.last()) else { return 0.0 };
        if pressure < *first {
            return self.potential[0] - (first - pressure) * self.at(0.0);
        }
        let sum = self.potential[self.potential.len() - 1];
        match self.tight {
            _ if pressure < *last => {
                let n = self.interval(pressure);
                self.potential[n] + self.integral(n, pressure)
            }
            Some(tight) => {
                let share = ((tight - pressure.min(tight)) / (tight - last)).powf(CLOSING + 1.0);
                sum + self.at(*last) * (tight - last) / (CLOSING + 1.0) * (1.0 - share)
            }
            None => sum + (pressure - last) * self.at(*last),
        }
    }

    /// The pressure with this S; `None` where S stays below it.
    pub(super) fn pressure(&self, potential: f64) -> Option<f64> {
        let (first, last) = (*self.pressures.first()?, *self.pressures.last()?);
        if potential <= self.potential[0] {
            return Some(first - (self.potential[0] - potential) / self.at(0.0));
        }
        let sum = self.potential[self.potential.len() - 1];
        if potential >= sum {
            let end = self.at(last);
            return match self.tight {
                Some(tight) => {
                    let share = 1.0 - (potential - sum) * (CLOSING + 1.0) / (end * (tight - last));
                    (share > 0.0).then(|| tight - (tight - last) * share.powf(1.0 / (CLOSING + 1.0)))
                }
                None => Some(last + (potential - sum) / end),
            };
        }
        let n = self.potential.partition_point(|known| *known <= potential) - 1;
        let [mut low, mut high] = [self.pressures[n], self.pressures[n + 1]];
        let missing = potential - self.potential[n];
        let mut guess = low + (high - low) * missing / (self.potential[n + 1] - self.potential[n]);
        // Newton's steps, kept between the ends.
        for _ in 0..60 {
            let error = self.integral(n, guess) - missing;
            if error.abs() <= 1e-14 * potential {
                break;
            }
            if error > 0.0 {
                high = guess
            } else {
                low = guess
            }
            let next = guess - error / self.log_at(n, guess).exp();
            guess = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
        Some(guess)
    }

    fn interval(&self, pressure: f64) -> usize {
        self.pressures.partition_point(|known| *known <= pressure).clamp(1, self.pressures.len() - 1) - 1
    }

    /// ln sigma in an interval: Hermite's cubic.
    fn log_at(&self, n: usize, pressure: f64) -> f64 {
        let length = self.pressures[n + 1] - self.pressures[n];
        let t = (pressure - self.pressures[n]) / length;
        let rise = self.log[n + 1] - self.log[n];
        let [a, b] = [self.slopes[n] * length - rise, rise - self.slopes[n + 1] * length];
        self.log[n] + t * rise + t * (1.0 - t) * ((1.0 - t) * a + t * b)
    }

    /// The integral of sigma from the beginning of an interval to a pressure in it.
    fn integral(&self, n: usize, to: f64) -> f64 {
        let from = self.pressures[n];
        let half = 0.5 * (to - from) / PARTS as f64;
        let part = |k: usize| {
            let middle = from + half * (2 * k + 1) as f64;
            let pair = |[node, weight]: &[f64; 2]| {
                let sides = [middle - half * node, middle + half * node];
                weight * sides.map(|p| self.log_at(n, p).exp()).iter().sum::<f64>()
            };
            half * GAUSS.iter().map(pair).sum::<f64>()
        };
        (0..PARTS).map(part).sum()
    }
}

/// The slopes of the monotone cubic.
fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let lengths: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let rises: Vec<f64> =
        y.windows(2).zip(&lengths).map(|(pair, length)| (pair[1] - pair[0]) / length).collect();
    let end = |h: [f64; 2], d: [f64; 2]| {
        let slope = ((2.0 * h[0] + h[1]) * d[0] - h[0] * d[1]) / (h[0] + h[1]);
        match slope * d[0] {
            same if same <= 0.0 => 0.0,
            _ if d[0] * d[1] <= 0.0 && slope.abs() > 3.0 * d[0].abs() => 3.0 * d[0],
            _ => slope,
        }
    };
    match rises.len() {
        0 => vec![0.0; x.len()],
        1 => vec![rises[0]; 2],
        last => (0..=last)
            .map(|n| match n {
                0 => end([lengths[0], lengths[1]], [rises[0], rises[1]]),
                n if n == last => end([lengths[n - 1], lengths[n - 2]], [rises[n - 1], rises[n - 2]]),
                n if rises[n - 1] * rises[n] <= 0.0 => 0.0,
                n => {
                    let [a, b] = [2.0 * lengths[n] + lengths[n - 1], lengths[n] + 2.0 * lengths[n - 1]];
                    (a + b) / (a / rises[n - 1] + b / rises[n])
                }
            })
            .collect(),
    }
}
