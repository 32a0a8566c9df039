//! A positive number over the pressure: its logarithm is interpolated by the monotone cubic of Fritsch and Butland (SIAM J. Sci. Stat.
//! Comput. 5, 300, 1984), and held outside of the points.
//!
//! What the points leave open between two of them is bounded by their chord and by the chords of their neighbours, drawn on: a curve that
//! bends one way lies between, and so does one that falls, at one place, more steeply than on both sides. [`Curve::bounds`] has both ends,
//! within the two points themselves.

/// The number at increasing pressures.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    /// Where the points are.
    pub(super) pressures: Vec<f64>,
    log: Vec<f64>,
    /// d ln/dp.
    slopes: Vec<f64>,
}

impl Curve {
    /// Through points (pressure, number).
    pub(super) fn through(points: &[(f64, f64)]) -> Self {
        let pressures: Vec<f64> = points.iter().map(|point| point.0).collect();
        let log: Vec<f64> = points.iter().map(|point| point.1.ln()).collect();
        let slopes = slopes(&pressures, &log);
        Curve { pressures, log, slopes }
    }

    /// The number at a pressure; 0 without points.
    pub(super) fn at(&self, pressure: f64) -> f64 {
        self.between(pressure, |n| {
            let [low, high] = self.open(n, pressure);
            self.cubic(n, pressure).max(low).min(high)
        })
    }

    /// The least and the largest number that the points leave open at a pressure.
    pub(super) fn bounds(&self, pressure: f64) -> [f64; 2] {
        [0, 1].map(|end| self.between(pressure, |n| self.open(n, pressure)[end]))
    }

    /// The largest number at a pressure above the last point, if it falls on as it does before it.
    pub(super) fn beyond(&self, pressure: f64) -> f64 {
        let Some(last) = self.log.len().checked_sub(1) else { return 0.0 };
        let slope = last.checked_sub(1).map_or(0.0, |n| self.slope(n));
        (self.log[last] + slope.min(0.0) * (pressure - self.pressures[last])).exp()
    }

    /// What has the logarithm `log(n)` between the n-th point and the next one.
    fn between(&self, pressure: f64, log: impl Fn(usize) -> f64) -> f64 {
        let (Some(first), Some(last)) = (self.log.first(), self.log.last()) else { return 0.0 };
        let after = self.pressures.partition_point(|known| *known <= pressure);
        let log = match after {
            0 => *first,
            after if after == self.log.len() => *last,
            after => log(after - 1),
        };
        log.exp()
    }

    /// d ln/dp of the chord from the n-th point on.
    fn slope(&self, n: usize) -> f64 {
        (self.log[n + 1] - self.log[n]) / (self.pressures[n + 1] - self.pressures[n])
    }

    /// The least and the largest logarithm that the points leave open at a pressure from the n-th one on.
    fn open(&self, n: usize, pressure: f64) -> [f64; 2] {
        let [from, to] = [pressure - self.pressures[n], self.pressures[n + 1] - pressure];
        let chord = self.log[n] + self.slope(n) * from;
        // How far the chords of the neighbours, drawn on, lie above this one.
        let before = n.checked_sub(1).map(|before| (self.slope(before) - self.slope(n)) * from);
        let after = (n + 2 < self.log.len()).then(|| (self.slope(n) - self.slope(n + 1)) * to);
        let [a, b] = match (before, after) {
            (Some(a), Some(b)) => [a, b],
            (Some(one), None) | (None, Some(one)) => [one; 2],
            (None, None) => [0.0; 2],
        };
        let [low, high] = match a * b > 0.0 {
            // A curve that bends one way lies below both, or above both.
            true if a > 0.0 => [0.0, a.min(b)],
            true => [a.max(b), 0.0],
            false => [a.min(b).min(0.0), a.max(b).max(0.0)],
        };
        let ends = [self.log[n].min(self.log[n + 1]), self.log[n].max(self.log[n + 1])];
        [low, high].map(|off| (chord + off).max(ends[0]).min(ends[1]))
    }

    /// Hermite's cubic from the n-th point on.
    fn cubic(&self, n: usize, pressure: f64) -> f64 {
        let length = self.pressures[n + 1] - self.pressures[n];
        let t = (pressure - self.pressures[n]) / length;
        let rise = self.log[n + 1] - self.log[n];
        let [a, b] = [self.slopes[n] * length - rise, rise - self.slopes[n + 1] * length];
        self.log[n] + t * rise + t * (1.0 - t) * ((1.0 - t) * a + t * b)
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
