//! Do the 95 % intervals of `fit_indentation` hold the truth as often as they say? Random materials in eight kinds of tests.

use asperity::indentation::{
    Given, IndentationFit, IndentationOptions, IndentationRecord, Interval, fit_indentation,
};
use asperity::material::Relaxation;
use asperity::reference::{Mdr, MdrProfile, MdrTarget};

/// Uniform and normal numbers: a linear congruential generator, and Box & Muller.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Uniform on a logarithmic scale.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.uniform())
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// A kind of test: what is controlled, its history, the materials, and the noise.
struct Kind {
    name: &'static str,
    profile: MdrProfile,
    control: Given,
    /// History from 0 to 1 over the time.
    history: fn(f64) -> f64,
    length: f64,
    rows: usize,
    /// Ranges of the relaxation times, one to each term; the last may be left out at random.
    times: &'static [[f64; 2]],
    optional: bool,
    /// Noise over the largest value: of the channel that answers, and of the controlled one.
    noise: [f64; 2],
    /// Correlation of the noise of one row with that of the next.
    follows: f64,
}

const SPHERE: MdrProfile = MdrProfile::Paraboloid { radius: 5e-3 };

fn hold(t: f64) -> f64 {
    t.min(1.0)
}

fn trapezoid(t: f64) -> f64 {
    if t < 1.0 { t } else { (1.0 - (t - 15.0) / 2.0).clamp(0.0, 1.0) }
}

fn triangle(t: f64) -> f64 {
    (t.min(20.0 - t) / 10.0).max(0.0)
}

fn twice(t: f64) -> f64 {
    if t < 6.0 { (t / 2.0).min(1.0).min((6.0 - t) / 2.0) } else { ((t - 6.0) / 3.0).min(1.0) }
}

const KINDS: [Kind; 8] = [
    Kind {
        name: "press and hold",
        profile: SPHERE,
        control: Given::Depth,
        history: hold,
        length: 20.0,
        rows: 300,
        times: &[[0.2, 1.5], [2.5, 8.0]],
        optional: true,
        noise: [0.01, 0.0],
        follows: 0.0,
    },
    Kind {
        name: "press, hold, retract",
        profile: SPHERE,
        control: Given::Depth,
        history: trapezoid,
        length: 20.0,
        rows: 300,
        times: &[[0.15, 0.6], [0.8, 3.0], [4.0, 12.0]],
        optional: true,
        noise: [0.005, 0.0],
        follows: 0.0,
    },
    Kind {
        name: "triangle",
        profile: SPHERE,
        control: Given::Depth,
        history: triangle,
        length: 20.0,
        rows: 300,
        times: &[[0.3, 2.0], [3.0, 15.0]],
        optional: false,
        noise: [0.01, 0.0],
        follows: 0.0,
    },
    Kind {
        name: "short hold",
        profile: SPHERE,
        control: Given::Depth,
        history: hold,
        length: 5.0,
        rows: 250,
        times: &[[0.2, 1.0], [2.0, 10.0]],
        optional: false,
        noise: [0.01, 0.0],
        follows: 0.0,
    },
    Kind {
        name: "creep under a load",
        profile: SPHERE,
        control: Given::Load,
        history: hold,
        length: 30.0,
        rows: 300,
        times: &[[0.3, 2.0], [3.0, 12.0]],
        optional: true,
        noise: [0.005, 0.0],
        follows: 0.0,
    },
    Kind {
        name: "noise in both channels",
        profile: SPHERE,
        control: Given::Depth,
        history: trapezoid,
        length: 20.0,
        rows: 400,
        times: &[[0.2, 1.0], [2.0, 8.0]],
        optional: true,
        noise: [0.01, 0.015],
        follows: 0.0,
    },
    Kind {
        name: "cone, twice, load controlled, noise in both",
        profile: MdrProfile::Cone { slope: 0.2 },
        control: Given::Load,
        history: twice,
        length: 20.0,
        rows: 400,
        times: &[[0.3, 2.0], [3.0, 12.0]],
        optional: true,
        noise: [0.01, 0.01],
        follows: 0.0,
    },
    Kind {
        name: "noise that follows itself",
        profile: SPHERE,
        control: Given::Depth,
        history: trapezoid,
        length: 20.0,
        rows: 400,
        times: &[[0.2, 1.0], [2.0, 8.0]],
        optional: true,
        noise: [0.01, 0.0],
        follows: 0.7,
    },
];

/// A random material, and its record in a test.
fn record(kind: &Kind, noise: &mut Noise) -> (Relaxation, [Vec<f64>; 3]) {
    let left_out = usize::from(kind.optional && noise.uniform() < 0.5);
    let terms: Vec<(f64, f64)> = kind.times[..kind.times.len() - left_out]
        .iter()
        .map(|[low, high]| (noise.within(0.3e6, 2e6), noise.decades(*low, *high)))
        .collect();
    let truth = Relaxation::absolute(noise.within(0.5e6, 2e6), &terms).unwrap();
    let peak = if kind.control == Given::Depth { 1e-4 } else { 0.3 };
    let times: Vec<f64> = (0..kind.rows).map(|k| kind.length * k as f64 / (kind.rows - 1) as f64).collect();
    // Wide enough for the softest body.
    let mut springs = Mdr::new(kind.profile, &truth, kind.profile.reach(2e-4), 400).unwrap();
    let (mut loads, mut depths) = (vec![], vec![]);
    for (n, t) in times.iter().enumerate() {
        let start = if n == 0 { 0.0 } else { times[n - 1] };
        let substeps = if n == 0 { 1 } else { 5 };
        let mut state = None;
        for k in 1..=substeps {
            let value = peak * (kind.history)(start + (t - start) * k as f64 / substeps as f64);
            let target = match kind.control {
                Given::Depth => MdrTarget::Approach(value),
                Given::Load => MdrTarget::Load(value),
            };
            state = Some(springs.step((t - start) / substeps as f64, target).unwrap());
        }
        let state = state.unwrap();
        loads.push(state.load);
        depths.push(state.approach);
    }
    let [answer, controlled] = kind.noise;
    let [of_load, of_depth] = match kind.control {
        Given::Depth => [answer, controlled],
        Given::Load => [controlled, answer],
    };
    for (column, share) in [(&mut loads, of_load), (&mut depths, of_depth)] {
        let largest = column.iter().fold(0.0, |m: f64, v| m.max(*v));
        let mut last = noise.normal();
        for value in column.iter_mut() {
            last = kind.follows * last + (1.0 - kind.follows * kind.follows).sqrt() * noise.normal();
            *value += share * largest * last;
        }
    }
    (truth, [times, loads, depths])
}

/// How often intervals held the truth.
#[derive(Clone, Debug, Default)]
struct Count {
    held: usize,
    all: usize,
    undetermined: usize,
    /// Ratio of the ends of the intervals of what is determined.
    widths: Vec<f64>,
}

impl Count {
    fn add(&mut self, interval: Interval, truth: f64) {
        self.all += 1;
        self.held += usize::from(interval.holds(truth));
        match interval.determined {
            true => self.widths.push(interval.high / interval.low),
            false => self.undetermined += 1,
        }
    }

    fn share(&self) -> f64 {
        self.held as f64 / self.all as f64
    }

    fn text(&self) -> String {
        let mut widths = self.widths.clone();
        widths.sort_by(f64::total_cmp);
        let width = widths.get(widths.len() / 2).copied().unwrap_or(f64::NAN);
        format!("{:>3} of {:>3}, {:>3} open, x{width:<7.3}", self.held, self.all, self.undetermined)
    }
}

#[derive(Clone, Debug, Default)]
struct Counts {
    instantaneous: Count,
    equilibrium: Count,
    moduli: Count,
    times: Count,
    /// Records with fewer and with more terms than the material, and of the other channel.
    fewer: usize,
    more: usize,
    other: usize,
}

impl Counts {
    fn add(&mut self, fit: &IndentationFit, truth: &Relaxation, control: Given) {
        self.instantaneous.add(fit.instantaneous, truth.instantaneous());
        self.equilibrium.add(fit.equilibrium, truth.equilibrium);
        self.fewer += usize::from(fit.terms.len() < truth.terms.len());
        self.more += usize::from(fit.terms.len() > truth.terms.len());
        self.other += usize::from(fit.given != control);
        if fit.terms.len() == truth.terms.len() {
            for ([modulus, time], term) in fit.terms.iter().zip(&truth.terms) {
                self.moduli.add(*modulus, term.modulus);
                self.times.add(*time, term.relaxation_time);
            }
        }
    }
}

impl Counts {
    fn print(&self, name: &str) {
        println!(
            "{name:<44} E(0) {} | E(inf) {} | E_i {} | tau_i {} | terms: {} fewer, {} more | other channel {}",
            self.instantaneous.text(),
            self.equilibrium.text(),
            self.moduli.text(),
            self.times.text(),
            self.fewer,
            self.more,
            self.other,
        );
    }

    fn assert(&self, name: &str) {
        for count in [&self.instantaneous, &self.equilibrium, &self.moduli, &self.times] {
            assert!(count.share() >= 0.9, "{name}: {self:?}");
        }
    }
}

fn study(kind: &Kind, records: u64) -> Counts {
    let mut counts = Counts::default();
    for n in 0..records {
        let mut noise = Noise(1 + 7919 * n);
        // The first numbers of near seeds are near.
        for _ in 0..10 {
            noise.uniform();
        }
        let (truth, [times, loads, depths]) = record(kind, &mut noise);
        let record = IndentationRecord { times: &times, loads: &loads, depths: &depths };
        let fit = fit_indentation(kind.profile, &record, &IndentationOptions::default()).unwrap();
        counts.add(&fit, &truth, kind.control);
    }
    counts
}

/// Two kinds that the record determines badly: of 48 intervals of 95 %, 45.6 +- 1.5 hold if they are independent.
#[test]
fn intervals_hold_the_truth_where_the_record_hardly_determines_it() {
    for kind in [&KINDS[2], &KINDS[5]] {
        let counts = study(kind, 6);
        let all = [&counts.instantaneous, &counts.equilibrium, &counts.moduli, &counts.times];
        let [held, of] = [all.iter().map(|c| c.held).sum::<usize>(), all.iter().map(|c| c.all).sum()];
        assert!(of > 20 && 10 * held >= 9 * of, "{}: {held} of {of}", kind.name);
        assert_eq!(counts.other, 0, "{}: the controlled channel is not found", kind.name);
    }
}

/// 480 records: of each 60 to 110 intervals of 95 %, 90 % at least hold the truth.
#[test]
#[ignore = "some minutes: 480 fits"]
fn intervals_hold_the_truth_in_eight_kinds_of_tests() {
    for kind in &KINDS {
        let counts = study(kind, 60);
        counts.print(kind.name);
        counts.assert(kind.name);
        assert_eq!(counts.other, 0, "{}", kind.name);
    }
}

/// Load of a sphere of 5 mm that is pressed 0.1 mm deep within `ramp` and held: E. H. Lee & J. R. M. Radok, J. Appl. Mech. 27
/// (1960) 438,
///
/// ```text
/// W = ∫ E*(t - s) dφ(s),   φ = (4/3) sqrt(R) d^(3/2)
/// ```
///
/// With s = ramp u² the integrand is smooth; Simpson's rule of 64 steps is exact to 1e-8 where the times exceed the ramp.
fn ramp_and_hold(truth: &Relaxation, ramp: f64, t: f64) -> f64 {
    let full = 4.0 / 3.0 * 5e-3_f64.sqrt() * 1e-4_f64.powf(1.5);
    let end = (t / ramp).clamp(0.0, 1.0).sqrt();
    let integrand = |u: f64| truth.value(t - ramp * u * u) * 3.0 * u * u;
    let n = 64;
    let weight = |k: usize| if k == 0 || k == n { 1.0 } else { (2 + 2 * (k % 2)) as f64 };
    let sum: f64 = (0..=n).map(|k| weight(k) * integrand(end * k as f64 / n as f64)).sum();
    full * sum * end / (3 * n) as f64
}

/// A record of 100 s with 50 000 rows, of which 25 show the ramp of 50 ms. `follows`: correlation of the noise, 1 % of the largest
/// load, of one row with that of the next.
fn long_record(seed: u64, follows: f64) -> (Relaxation, IndentationFit) {
    let mut noise = Noise(1 + 7919 * seed);
    for _ in 0..10 {
        noise.uniform();
    }
    let terms = [
        (noise.within(0.3e6, 2e6), noise.decades(0.1, 1.0)),
        (noise.within(0.3e6, 2e6), noise.decades(3.0, 20.0)),
    ];
    let truth = Relaxation::absolute(noise.within(0.5e6, 2e6), &terms).unwrap();
    let times: Vec<f64> = (0..50_000).map(|k| 100.0 * k as f64 / 49_999.0).collect();
    let mut loads: Vec<f64> = times.iter().map(|t| ramp_and_hold(&truth, 0.05, *t)).collect();
    let largest = loads.iter().fold(0.0, |m: f64, v| m.max(*v));
    let mut last = noise.normal();
    for load in &mut loads {
        last = follows * last + (1.0 - follows * follows).sqrt() * noise.normal();
        *load += 0.01 * largest * last;
    }
    let depths: Vec<f64> = times.iter().map(|t| 1e-4 * hold(t / 0.05)).collect();
    let record = IndentationRecord { times: &times, loads: &loads, depths: &depths };
    (truth, fit_indentation(SPHERE, &record, &IndentationOptions::default()).unwrap())
}

fn long_records(records: std::ops::Range<u64>, follows: f64) -> Counts {
    let mut counts = Counts::default();
    for seed in records {
        let (truth, fit) = long_record(seed, follows);
        counts.add(&fit, &truth, Given::Depth);
    }
    counts
}

/// The ramp takes 25 of 50 000 rows: a fit of every 25th row sees one of them. Of 24 intervals of 95 %, 22.8 +- 1.1 hold.
#[test]
fn a_short_ramp_of_a_long_record_counts() {
    let counts = [long_records(0..2, 0.0), long_records(2..4, 0.8)];
    let all = counts.iter().flat_map(|c| [&c.instantaneous, &c.equilibrium, &c.moduli, &c.times]);
    let [held, of] = all.fold([0, 0], |[held, of], c| [held + c.held, of + c.all]);
    assert!(of == 24 && held >= 20, "{held} of {of}");
    // 1 % of noise in 50 000 rows: E(0) is known to some per cent.
    assert!(counts[0].instantaneous.widths.iter().all(|width| *width < 1.05), "{counts:?}");
}

/// 160 records: at least 90 % of the intervals of 95 % hold the truth.
#[test]
#[ignore = "two minutes: 80 fits of 50 000 rows"]
fn intervals_of_long_records_hold_the_truth() {
    for follows in [0.0, 0.8] {
        let counts = long_records(0..40, follows);
        counts.print(&format!("50 000 rows, correlation {follows}"));
        counts.assert("long");
    }
}
