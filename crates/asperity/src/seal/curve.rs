//! A positive number over the pressure: its logarithm is interpolated by the monotone cubic of Fritsch and Butland (SIAM J. Sci. Stat.
//! Comput. 5, 300, 1984), and held outside of the points.

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
        let (Some(first), Some(last)) = (self.log.first(), self.log.last()) else { return 0.0 };
        let after = self.pressures.partition_point(|known| *known <= pressure);
        let log = match after {
            0 => *first,
            after if after == self.log.len() => *last,
            after => self.cubic(after - 1, pressure),
        };
        log.exp()
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
