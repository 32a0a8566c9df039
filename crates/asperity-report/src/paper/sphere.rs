//! Figures 1, 2 and 4: a smooth sphere.

use std::f64::consts::PI;

use asperity::History;
use asperity::reference::{CappedHertz, HertzSphere, Ting};
use asperity_examples::paper::{FIGURE_1, FIGURE_2, FIGURE_4};
use asperity_io::readable::quantity;
use asperity_io::store::{At, FieldKind, Reader};

use super::{Difference, Options, Reproduction, Result};
use crate::figure::{Axis, Curves, Figure, Series, Style};

/// Pressure along x beside the middle, by the distance from it: (r, p).
fn profile(reader: &Reader, at: At) -> Result<Vec<[f64; 2]>> {
    let field = reader.field(FieldKind::Pressure, at)?;
    let grid = &reader.header().grid;
    let [nx, ny] = grid.cells();
    let [dx, dy] = grid.spacing();
    // The row of cells whose centres lie nearest to the middle.
    let j = ny / 2;
    let y = (j as f64 + 0.5) * dy - 0.5 * grid.size()[1];
    let place = |i: usize| (i as f64 + 0.5) * dx - 0.5 * grid.size()[0];
    Ok((nx / 2..nx).map(|i| [place(i).hypot(y), field[[i, j]]]).collect())
}

/// The paper's eq. 21, corrected: pressure at the time t after a step load on a Zener solid,
/// p = (8 G / (pi R)) [q(t) - (G / eta_K) int_0^t exp(-(t - s)/tau_R) q(s) ds], q = sqrt(a^2 - r^2)+,
/// a^3 = 3 R W Phi(t) / 8, tau_R = eta_K / (G + G_K), Phi = (1/G) + (1/G_K)(1 - exp(-t/tau)).
fn equation_21(radius: f64, load: f64, shear: f64, kelvin: f64, time: f64, r: f64, t: f64) -> f64 {
    let viscosity = kelvin * time;
    let relaxation_time = viscosity / (shear + kelvin);
    let phi = |s: f64| 0.5 / shear + 0.5 / kelvin * (1.0 - (-s / time).exp());
    let q = |s: f64| {
        let a = (3.0 * radius * load * phi(s) / 8.0).cbrt();
        (a * a - r * r).max(0.0).sqrt()
    };
    // Midpoints of parts that grow from where the contact reaches r, where q rises as a root.
    let reached = {
        let share = (8.0 * r.powi(3) / (3.0 * radius * load) - 0.5 / shear) * 2.0 * kelvin;
        if share <= 0.0 { 0.0 } else { -time * (1.0 - share).max(f64::MIN_POSITIVE).ln() }
    };
    const PARTS: u32 = 4000;
    let place = |k: f64| reached + (t - reached) * (k / f64::from(PARTS)).powi(2);
    let parts = if reached < t { 0..PARTS } else { 0..0 };
    let past: f64 = parts
        .map(|k| {
            let (from, to) = (place(f64::from(k)), place(f64::from(k) + 1.0));
            let s = 0.5 * (from + to);
            (-(t - s) / relaxation_time).exp() * q(s) * (to - from)
        })
        .sum();
    8.0 * shear / (PI * radius) * (q(t) - shear / viscosity * past)
}

const AWAY: &str = "Largest difference of the pressure, a cell away from the border";

/// The largest difference of the pressure from the exact one. The cells at the border are in contact in part and left out.
fn apart(computed: &[[f64; 2]], border: f64, spacing: f64, exact: impl Fn(f64) -> f64) -> f64 {
    let inner = computed.iter().filter(|[r, _]| (r - border).abs() > spacing);
    inner.map(|[r, p]| (p - exact(*r)).abs()).fold(0.0, f64::max)
}

/// A figure of one panel and one difference.
fn reproduction(number: u8, title: &str, panel: Curves, difference: Difference, more: &str) -> Reproduction {
    let figure = Figure::new("").with(panel).panel_size([345.0, 260.0]);
    Reproduction::new(number, title, figure, vec![difference], more)
}

/// Figure 1.
pub(super) fn zener_step(options: &Options) -> Result<Reproduction> {
    let (radius, load, shear, time) = (10e-3, 0.1, 2e6, 1.0);
    let (_, reader) = options.run("fig1-zener-step", FIGURE_1, &[])?;
    let first = HertzSphere::under_load(radius, 4.0 * shear, load)?;
    let (a0, p0) = (first.contact_radius, first.peak_pressure);
    let axis = Axis::linear("distance from the middle, in first contact radii", "");
    let mut panel = Curves::new("", axis.between(0.0, 1.4), Axis::linear("pressure, in first peaks", ""));
    let mut largest: f64 = 0.0;
    let spacing = reader.header().grid.spacing()[0];
    for (n, t) in reader.field_times().iter().enumerate() {
        let computed = profile(&reader, At::Index(n))?;
        let a = (3.0 * radius * load / (16.0 * shear) * (2.0 - (-t / time).exp())).cbrt();
        let exact = |r: f64| equation_21(radius, load, shear, shear, time, r, *t);
        largest = largest.max(apart(&computed, a, spacing, exact) / p0);
        let points: Vec<_> = computed.iter().step_by(3).filter(|[r, _]| *r < 1.4 * a0).collect();
        let name = format!("t = {}", quantity(*t, "s"));
        panel =
            panel.with(Series::through(name, Style::Points, points.iter().map(|[r, p]| [r / a0, p / p0])));
        let fine: Vec<f64> = (0..=140).map(|k| f64::from(k) * 0.01).collect();
        let name = if n == 0 { "eq. 21, corrected" } else { "" };
        panel = panel.with(Series::of(name, Style::Reference, &fine, |r| exact(r * a0) / p0));
    }
    let more = "Retardation time 1 s, G = G_K. The paper does not name the times of its curves.";
    let difference = Difference::new(AWAY, largest, "the first peak");
    Ok(reproduction(1, "pressure on a Zener half-space, step load", panel, difference, more))
}

/// Figure 2.
pub(super) fn capped(options: &Options) -> Result<Reproduction> {
    let (radius, load) = (0.5e-3, 0.5);
    let modulus = 2491.44e6 / (1.0 - 0.38 * 0.38);
    let axis = Axis::linear("distance from the middle", "m").between(0.0, 60e-6);
    let mut panel = Curves::new("", axis, Axis::linear("pressure", "Pa"));
    let peak = HertzSphere::under_load(radius, modulus, load)?.peak_pressure;
    let mut largest: f64 = 0.0;
    for (n, limit) in [f64::INFINITY, 130e6, 110e6, 90e6, 70e6].into_iter().enumerate() {
        let name = if limit.is_finite() { format!("{:.0}", limit / 1e6) } else { "none".into() };
        let key = format!("body.0.hardness=\"{} Pa\"", if limit.is_finite() { limit } else { 1e12 });
        let (_, reader) = options.run(&format!("fig2-capped-{name}"), FIGURE_2, &[key])?;
        let computed = profile(&reader, At::Last)?;
        let exact = CappedHertz::under_load(radius, modulus, limit.min(1e12), load)?;
        let border = (exact.contact_area() / PI).sqrt();
        let spacing = reader.header().grid.spacing()[0];
        largest = largest.max(apart(&computed, border, spacing, |r| exact.pressure(r)) / peak);
        let title = if limit.is_finite() { format!("limit {name} MPa") } else { "no limit".into() };
        panel = panel.with(Series::through(title, Style::Points, computed.iter().copied().step_by(3)));
        let fine: Vec<f64> = (0..=240).map(|k| f64::from(k) * 0.25e-6).collect();
        let name = if n == 0 { "axisymmetric solution" } else { "" };
        panel = panel.with(Series::of(name, Style::Reference, &fine, |r| exact.pressure(r)));
    }
    let difference = Difference::new(AWAY, largest, "the Hertz peak");
    let more = "The paper does not name its limits.";
    Ok(reproduction(2, "pressure under a sphere, cut off", panel, difference, more))
}

/// Figure 4.
pub(super) fn triangle(options: &Options) -> Result<Reproduction> {
    let (case, reader) = options.run("fig4-pmma-triangle", FIGURE_4, &[])?;
    let history = History::Triangle { peak: 5.0, rise: 30.0, fall: 30.0 };
    let ting = Ting::new(1e-3, &case.conditions.creep, &history, 60.0)?;
    let time = reader.series("time")?;
    let [load, depth] = [reader.series("load")?, reader.series("approach")?];
    let mut exact = Vec::with_capacity(time.len());
    for t in &time {
        // At the end the contact has opened: the depth just before.
        exact.push(ting.at(t.min(60.0 * (1.0 - 1e-9)))?.approach);
    }
    let deepest = exact.iter().copied().fold(0.0, f64::max);
    let last = time.len() - 1;
    let apart = |n: usize| (depth[n] - exact[n]).abs() / deepest;
    let largest = (0..last).map(apart).fold(0.0, f64::max);
    let every = (0..=last).step_by(4).map(|n| [depth[n], load[n]]);
    let panel = Curves::new("", Axis::linear("depth", "m"), Axis::linear("load", "N"))
        .with(Series::through("computed", Style::Points, every))
        .with(Series::new("Ting (1966)", Style::Reference, exact, &load));
    let difference = Difference::new("Largest difference of the depth", largest, "the largest depth");
    let more = "Sphere of 1 mm: the paper does not name its radius.";
    Ok(reproduction(4, "load over depth, triangular load on PMMA", panel, difference, more))
}
