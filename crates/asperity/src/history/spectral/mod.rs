//! The memory of layers that creep differently: the states of every wave of the displacement ([`super::waves`]).
//!
//! A step is the elastic contact with the operator 1/e of all waves and the undeformed gap h0 + g, where g is the displacement that
//! the past leaves: one transform of the pressure and one back for each row, beside those of the solve. On a free domain the waves are
//! those of the padded torus of the convolution, or of one twice as wide ([`crate::operator::wide`]). Its response to pressures on the
//! domain is that of the body, so that nothing wraps around.

mod estimate;
mod mean;
mod waves;

use std::sync::Arc;

use ndarray::Array2;
use rustfft::num_complex::Complex64;

use super::relaxation::rules::Driver;
use super::relaxation::{ROUNDING, Reference, UnderWay};
use super::{Ends, History, Law, ThirdState, third_state};
use crate::contact::ContactState;
use crate::convolution::torus::{Spectrum, Torus};
use crate::error::Result;
use crate::grid::{Boundary, Grid};
use crate::layer::NonseparableLayers;
use crate::operator::{self, Body, Operator, of_eigenvalues, wide};
use crate::simulation::Simulation;
use crate::step::{Interval, Load, Loader, Piece, Saver, saved};
use mean::{Mean, Run, linear};
pub use waves::check_layers;
use waves::{Table, Waves, Width};

/// A time without pressure is so many steps, each twice as long as the one before.
const PARTS: i32 = 16;

pub(super) struct Spectral {
    body: Body,
    layers: Arc<NonseparableLayers>,
    torus: Torus,
    waves: Waves,
    /// K00 of the kernel \[m\].
    own: f64,
    /// q_i and u at the start of the step under way.
    states: Vec<Complex64>,
    displacement: Vec<Complex64>,
    /// u of a third instant, and when that is.
    third: Vec<Complex64>,
    reference: Option<Reference>,
    /// Time from the last kink of the course to the start of the step under way \[s\].
    since_kink: f64,
    mean: Option<Mean>,
    under_way: UnderWay,
    /// Length of the step under way \[s\], how u runs over it, and its parts.
    length: f64,
    driver: Driver,
    run: Run,
    steps: Vec<Table>,
    /// 1/e of the step under way, and g.
    compliance: Array2<f64>,
    recalled: Vec<Complex64>,
    past: Vec<f64>,
    /// The error of u that a solve leaves, over the approach.
    noise: f64,
    /// The estimated error of the step solved last.
    error: f64,
}

impl Spectral {
    /// The memory of a simulation with these layers.
    pub(super) fn new(simulation: &Simulation, layers: &Arc<NonseparableLayers>) -> Result<Self> {
        let (waves, own) = Waves::new(&simulation.grid, simulation.boundary, layers)?;
        let count = waves.count();
        let still = Table(vec![]);
        Ok(Spectral {
            body: Body {
                grid: simulation.grid,
                boundary: simulation.boundary,
                backend: operator::default_backend(),
                kernel: simulation.kernel.clone(),
                has_coarser: true,
            },
            layers: layers.clone(),
            torus: Torus::new(simulation.grid.cells(), waves.lengths),
            own,
            states: vec![Complex64::ZERO; count * waves.terms],
            displacement: vec![Complex64::ZERO; count],
            third: vec![],
            reference: None,
            since_kink: 0.0,
            mean: None,
            under_way: UnderWay::Nothing,
            length: 0.0,
            driver: Driver::Time,
            run: Run::Linear(Driver::Time),
            compliance: waves.compliance(&still),
            steps: vec![still],
            recalled: vec![Complex64::ZERO; count],
            past: vec![0.0; simulation.grid.len()],
            noise: simulation.solver.tolerance.max(ROUNDING),
            error: 0.0,
            waves,
        })
    }

    /// Sets the parts of a step that starts from the states.
    fn plan(&mut self, step: &Interval) {
        let x = step.length();
        self.length = x;
        self.under_way = if step.load == Load::Apart { UnderWay::Apart } else { UnderWay::Contact };
        self.run = self.mean.as_mut().map_or(Run::Linear(Driver::Time), |mean| mean.run(step.load, x));
        let recovers = step.load == Load::Apart && self.mean.is_some();
        self.driver = match self.run {
            Run::Linear(driver) if !recovers => driver,
            _ => Driver::Time,
        };
        let of_length = |x: f64| self.waves.table(x, |tau| linear(x / tau));
        self.steps = match &self.mean {
            _ if x <= 0.0 => vec![Table(vec![])],
            None => vec![of_length(x)],
            Some(mean) if !recovers => vec![self.waves.table(x, |tau| mean.share(&self.run, tau, x))],
            // Its parts are short against the times that matter when they pass: u is linear in each.
            Some(_) => {
                let halves = (1..=PARTS).rev().map(|part| part.min(PARTS - 1));
                halves.map(|halves| of_length(x * libm::pow(0.5, f64::from(halves)))).collect()
            }
        };
    }

    /// Finds the operator and g of the step under way.
    fn prepare(&mut self) {
        self.compliance = self.waves.compliance(&self.steps[self.steps.len() - 1]);
        self.waves.recall(&self.steps, &self.displacement, &self.states, &mut self.recalled);
        self.torus.back_of(&self.recalled, &mut self.past);
    }

    fn scale(&self) -> f64 {
        operator::mean(self.waves.lengths, self.compliance.view()) / self.own
    }

    /// The operator of the step under way, over the scalar compliance.
    fn operator(&self) -> Box<dyn Operator> {
        let unit = &self.compliance / self.scale();
        let unit = match self.waves.width {
            Width::Narrow => unit,
            Width::Wide => wide::narrowed(&self.body.grid, &unit),
        };
        of_eigenvalues(self.body.clone(), &unit)
    }

    /// The law of the step that is set, with `gap` = `rigid` + g.
    fn law(&mut self, rigid: &[f64], gap: &mut [f64]) -> Law {
        self.prepare();
        gap.iter_mut().zip(rigid).zip(&self.past).for_each(|((gap, rigid), g)| *gap = rigid + g);
        Law { compliance: self.scale(), operator: Some(self.operator()) }
    }
}

saved! {
    Spectral { "under_way": under_way; "step": length, driver, since_kink; }
}

impl History for Spectral {
    fn open(&mut self, step: &Interval, last: &ContactState, rigid: &[f64], gap: &mut [f64]) -> Result<Law> {
        let ends = self.under_way == UnderWay::Contact;
        self.since_kink = if step.is_smooth { self.since_kink + self.length } else { 0.0 };
        let before = Reference { length: -self.length, driver: self.driver, approach: 0.0, driven: 0.0 };
        self.reference = (ends && step.is_smooth).then_some(before);
        if ends {
            self.third.clone_from(&self.displacement);
        }
        let transform = ends.then(|| self.torus.transform(&last.pressure));
        if self.under_way != UnderWay::Nothing {
            let p = transform.as_ref().map(|Spectrum(p)| &p[..]);
            self.waves.end(&self.steps, p, &mut self.displacement, &mut self.states);
        }
        self.mean.iter_mut().for_each(Mean::begin);
        self.reopen(step, rigid, gap)
    }

    fn reopen(&mut self, step: &Interval, rigid: &[f64], gap: &mut [f64]) -> Result<Law> {
        self.plan(step);
        Ok(self.law(rigid, gap))
    }

    /// The mean course goes on to the end of the step; the first load tells whose mean it is.
    fn close(&mut self, ends: &Ends<'_>) {
        let load = ends.loads[1];
        match &mut self.mean {
            Some(mean) => mean.close(load),
            None if load > 0.0 => {
                let Spectrum(p) = self.torus.transform(&ends.now.pressure);
                let values = self.waves.mean(&p, self.layers.frequencies.iter().copied());
                // A mean of creep functions is one.
                let mean = self.layers.fit(&values);
                self.mean = mean.and_then(|(creep, _)| Mean::new(creep, self.length, load).ok());
            }
            None => {}
        }
    }

    fn recalled(&self, g: &mut [f64]) {
        g.copy_from_slice(&self.past);
    }

    fn recovers_in_one_step(&self) -> bool {
        true
    }

    fn third_state(&self, step: &Interval) -> Option<ThirdState> {
        third_state(step, self.under_way == UnderWay::Contact, self.length)
    }

    fn keep_as_third(&mut self, ends: &Ends<'_>) {
        self.keep(&ends.now.pressure);
    }

    fn error(&mut self, step: &Interval, ends: &Ends<'_>) -> Option<f64> {
        self.error = if step.instant.jump { 0.0 } else { self.estimate(ends) };
        Some(self.error)
    }

    fn time_error(&self) -> Option<f64> {
        Some(self.error)
    }

    fn first_step(&mut self, piece: &Piece) -> Option<f64> {
        let longest = piece.length / 20.0;
        Some(self.mean.as_mut().map_or(longest, |mean| mean.first_step(piece, longest)))
    }

    fn save<'a>(&'a self, to: &mut Saver<'a>) {
        self.save_own(to);
        to.value("steps", &self.steps.len());
        for (k, Table(rows)) in self.steps.iter().enumerate() {
            to.value(&format!("step_{k}"), &rows.as_flattened().to_vec());
        }
        if let Some(mean) = &self.mean {
            to.within("mean", |to| mean.save(to));
        }
        let all: Vec<f64> = self.states.iter().chain(&self.displacement).flat_map(|z| [z.re, z.im]).collect();
        // The complex numbers of the states and of u, in as many fields as hold them.
        let cells = self.body.grid.len();
        for (k, part) in all.chunks(cells).enumerate() {
            let mut field = part.to_vec();
            field.resize(cells, 0.0);
            to.owned_field(&format!("waves_{k}"), field);
        }
    }

    fn load(&mut self, from: &mut Loader<'_>) -> Result<()> {
        self.load_own(from)?;
        let steps = from.get::<usize>("steps")?;
        let table = |k: usize| Ok(Table(from.numbers(&format!("step_{k}"))?.as_chunks::<3>().0.to_vec()));
        self.steps = (0..steps).map(table).collect::<Result<_>>()?;
        if self.steps.is_empty() {
            return Err(from.foreign("a history without a step"));
        }
        let mean =
            from.within("mean", |from| if from.is_empty() { Ok(None) } else { Mean::load(from).map(Some) });
        self.mean = mean?;
        let count = 2 * (self.states.len() + self.displacement.len());
        let fields = (0..count.div_ceil(self.body.grid.len())).map(|k| from.field(&format!("waves_{k}")));
        let fields = fields.collect::<Result<Vec<_>>>()?;
        let mut all = fields.iter().flatten().copied();
        for z in self.states.iter_mut().chain(&mut self.displacement) {
            let [re, im] = [all.next().unwrap_or_default(), all.next().unwrap_or_default()];
            *z = Complex64::new(re, im);
        }
        self.prepare();
        Ok(())
    }
}

/// Bytes that the states of the waves take.
pub(super) fn bytes(grid: &Grid, boundary: Boundary, layers: &NonseparableLayers) -> usize {
    let is_wide = boundary == Boundary::Free && layers.creeps_far_away();
    let [mx, my] = if is_wide { wide::lengths(grid) } else { operator::torus(grid, boundary) };
    // Four terms to a wave are usual: their states and moduli, u, g, a third u and what its error takes, and one eigenvalue for
    // each node while they are planned.
    mx * (my / 2 + 1) * (16 * (4 + 8) + 8 * 4 + 4 * (layers.nodes() + 2))
}
