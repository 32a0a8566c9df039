//! The memory of layers that creep differently: the states of every wave of the displacement ([`super::waves`]).
//!
//! A step is the elastic contact with the operator 1/e of all waves and the undeformed gap h0 + g, where g is the displacement that
//! the past leaves: one transform of the pressure and one back for each row, beside those of the solve. On a free domain the waves are
//! those of the padded torus of the convolution, or of one twice as wide ([`crate::operator::wide`]). Its response to pressures on the
//! domain is that of the body, so that nothing wraps around.

use std::sync::Arc;

use ndarray::Array2;
use rustfft::num_complex::Complex64;

use super::estimate::ROUNDING;
use super::mean::{Mean, Run, linear};
use super::rules::Course;
use super::waves::{Room, Table, Waves};
use super::{Imposed, Interval, Reference, UnderWay};
use crate::error::Result;
use crate::grid::{Boundary, Grid};
use crate::kernel::Kernel;
use crate::layer::Inseparable;
use crate::march::Simulation;
use crate::operator::{Operator, mean, of_eigenvalues, wide};
use crate::sliding::torus::{Spectrum, Torus};

/// A time without pressure is so many steps, each twice as long as the one before.
const PARTS: i32 = 16;

pub(in crate::march) struct Spectral {
    grid: Grid,
    boundary: Boundary,
    kernel: Arc<dyn Kernel>,
    layers: Arc<Inseparable>,
    pub(super) torus: Torus,
    pub(super) waves: Waves,
    /// K00 of the kernel \[m\].
    own: f64,
    /// q_i and u at the start of the step under way.
    states: Vec<Complex64>,
    pub(super) displacement: Vec<Complex64>,
    /// u of a third instant, and when that is.
    pub(super) third: Vec<Complex64>,
    pub(super) reference: Option<Reference>,
    /// How long the smooth piece of the course has lasted at the start of the step under way; none of a piece that begins.
    pub(super) piece: Option<f64>,
    pub(super) mean: Option<Mean>,
    /// The load at the end of the last step.
    load: f64,
    pub(super) under_way: UnderWay,
    /// Length of the step under way \[s\], how u runs over it, and its parts.
    pub(super) length: f64,
    pub(super) course: Course,
    steps: Vec<Table>,
    /// 1/e of the step under way, and g.
    pub(super) compliance: Array2<f64>,
    pub(super) recalled: Vec<Complex64>,
    past: Vec<f64>,
    /// The error of u that a solve leaves, over the approach.
    pub(super) noise: f64,
}

impl Spectral {
    /// The memory of a simulation with these layers.
    pub(in crate::march) fn new(simulation: &Simulation, layers: &Arc<Inseparable>) -> Result<Self> {
        let (waves, own) = Waves::new(&simulation.grid, simulation.boundary, layers)?;
        let count = waves.count();
        let still = Table(vec![]);
        Ok(Spectral {
            grid: simulation.grid,
            boundary: simulation.boundary,
            kernel: simulation.kernel.clone(),
            layers: layers.clone(),
            torus: Torus::new(simulation.grid.cells(), waves.lengths()),
            own,
            states: vec![Complex64::ZERO; count * waves.terms],
            displacement: vec![Complex64::ZERO; count],
            third: vec![],
            reference: None,
            piece: None,
            mean: None,
            load: 0.0,
            under_way: UnderWay::Nothing,
            length: 0.0,
            course: Course::Time,
            compliance: waves.compliance(&still),
            steps: vec![still],
            recalled: vec![Complex64::ZERO; count],
            past: vec![0.0; simulation.grid.len()],
            noise: simulation.solver.tolerance.max(ROUNDING),
            waves,
        })
    }

    /// Whether the step under way has no pressure at either end.
    pub(in crate::march) fn is_apart(&self) -> bool {
        self.under_way == UnderWay::Apart
    }

    /// The load at the end of the last step.
    pub(in crate::march) fn load(&self) -> f64 {
        self.load
    }

    /// Takes in the end of the step before, where `pressure` is; writes `gap` = `rigid` + g for the next one. Returns the scalar
    /// that multiplies the [`operator`](Self::operator).
    pub(in crate::march) fn begin(
        &mut self,
        step: Interval<'_>,
        pressure: &[f64],
        rigid: &[f64],
        gap: &mut [f64],
    ) -> f64 {
        let ends = self.under_way == UnderWay::Contact;
        self.piece = Some(self.piece.map_or(0.0, |lasted| lasted + self.length));
        self.reference = ends.then(|| Reference { length: -self.length, course: self.course });
        if ends {
            self.third.clone_from(&self.displacement);
        }
        let transform = ends.then(|| self.torus.transform(pressure));
        if self.under_way != UnderWay::Nothing {
            let p = transform.as_ref().map(|Spectrum(p)| &p[..]);
            self.waves.end(&self.steps, p, &mut self.displacement, &mut self.states);
        }
        self.mean.iter_mut().for_each(Mean::begin);
        self.retry(step, rigid, gap)
    }

    /// As [`Spectral::begin`] for the step under way at another length: what came before it is taken in already.
    pub(in crate::march) fn retry(&mut self, step: Interval<'_>, rigid: &[f64], gap: &mut [f64]) -> f64 {
        self.plan(step);
        self.look();
        gap.iter_mut().zip(rigid).zip(&self.past).for_each(|((gap, rigid), g)| *gap = rigid + g);
        self.scale()
    }

    /// Sets the parts of a step that starts from the states.
    fn plan(&mut self, step: Interval<'_>) {
        let x = step.lengths[0];
        self.length = x;
        self.under_way = if step.drive == Imposed::Apart { UnderWay::Apart } else { UnderWay::Contact };
        self.course = Course::Time;
        self.steps.clear();
        if x <= 0.0 {
            self.mean.iter_mut().for_each(|mean| _ = mean.run(step.drive, x));
            self.steps.push(Table(vec![]));
            return;
        }
        let (Imposed::Apart, Some(mean)) = (step.drive, &mut self.mean) else {
            let table = match &mut self.mean {
                None => self.waves.table(x, |tau| linear(x / tau)),
                Some(mean) => {
                    let run = mean.run(step.drive, x);
                    if let Run::Driver(course) = run {
                        self.course = course;
                    }
                    self.waves.table(x, |tau| mean.share(&run, tau, x))
                }
            };
            return self.steps.push(table);
        };
        // Its parts are short against the times that matter when they pass: u is linear in each.
        mean.run(step.drive, x);
        for part in (1..=PARTS).rev() {
            let halves = if part == PARTS { part - 1 } else { part };
            let x = x * libm::pow(0.5, f64::from(halves));
            self.steps.push(self.waves.table(x, |tau| linear(x / tau)));
        }
    }

    /// Finds the operator and g of the step under way.
    fn look(&mut self) {
        self.compliance = self.waves.compliance(&self.steps[self.steps.len() - 1]);
        self.waves.recall(&self.steps, &self.displacement, &self.states, &mut self.recalled);
        self.torus.back_of(&self.recalled, &mut self.past);
    }

    fn scale(&self) -> f64 {
        mean(self.waves.lengths(), self.compliance.view()) / self.own
    }

    /// The operator of the step under way, over the scalar compliance.
    pub(in crate::march) fn operator(&self) -> Box<dyn Operator> {
        let unit = &self.compliance / self.scale();
        let unit = match self.waves.room() {
            Room::Narrow => unit,
            Room::Wide => wide::narrowed(&self.grid, &unit),
        };
        of_eigenvalues(self.grid, self.boundary, self.kernel.clone(), &unit)
    }

    pub(super) fn cells(&self) -> usize {
        self.grid.len()
    }

    /// g of the step under way.
    pub(in crate::march) fn remembered(&self, g: &mut [f64]) {
        g.copy_from_slice(&self.past);
    }

    /// The step under way ends under this load, with this pressure.
    pub(in crate::march) fn settle(&mut self, load: f64, pressure: &[f64]) -> Result<()> {
        self.load = load;
        match &mut self.mean {
            Some(mean) => mean.settle(load),
            None if load > 0.0 => {
                let Spectrum(p) = self.torus.transform(pressure);
                let values = self.waves.mean(&p, self.layers.frequencies());
                // A mean of creep functions is one.
                if let Some((creep, _)) = self.layers.fit(&values) {
                    self.mean = Some(Mean::new(creep, self.length, load)?);
                }
            }
            None => {}
        }
        Ok(())
    }

    /// Numbers and fields for a checkpoint: the complex numbers of the states and of u, in as many fields as hold them.
    pub(in crate::march) fn save(&self) -> (Vec<f64>, Vec<Vec<f64>>) {
        let under_way = match self.under_way {
            UnderWay::Nothing => 0.0,
            UnderWay::Contact => 1.0,
            UnderWay::Apart => 2.0,
        };
        let course = match self.course {
            Course::Time => f64::INFINITY,
            Course::Load(change) => change,
        };
        let piece = self.piece.unwrap_or(f64::INFINITY);
        let mut numbers = vec![under_way, self.length, self.load, course, piece, self.steps.len() as f64];
        for Table(rows) in &self.steps {
            numbers.push(rows.len() as f64);
            numbers.extend(rows.iter().flatten());
        }
        numbers.extend(self.mean.iter().flat_map(Mean::save));
        let all: Vec<f64> = self.states.iter().chain(&self.displacement).flat_map(|z| [z.re, z.im]).collect();
        let cells = self.grid.len();
        let fields = all.chunks(cells).map(|part| {
            let mut field = part.to_vec();
            field.resize(cells, 0.0);
            field
        });
        (numbers, fields.collect())
    }

    /// Takes back what [`Spectral::save`] gave; false where it does not fit.
    pub(in crate::march) fn restore(&mut self, numbers: &[f64], fields: &[Vec<f64>]) -> bool {
        let Some((tables, rest)) = self.restored_steps(numbers) else { return false };
        let count = self.states.len() + self.displacement.len();
        if fields.len() != (2 * count).div_ceil(self.grid.len()) {
            return false;
        }
        let mut all = fields.iter().flatten().copied();
        for z in self.states.iter_mut().chain(&mut self.displacement) {
            let [re, im] = [all.next().unwrap_or_default(), all.next().unwrap_or_default()];
            *z = Complex64::new(re, im);
        }
        self.mean = match rest.is_empty() {
            true => None,
            false => match Mean::load(rest) {
                Some(mean) => Some(mean),
                None => return false,
            },
        };
        self.steps = tables;
        self.look();
        true
    }

    fn restored_steps<'n>(&mut self, numbers: &'n [f64]) -> Option<(Vec<Table>, &'n [f64])> {
        let [under_way, length, load, course, piece, count, rest @ ..] = numbers else { return None };
        self.under_way = match under_way {
            0.0 => UnderWay::Nothing,
            1.0 => UnderWay::Contact,
            _ => UnderWay::Apart,
        };
        (self.length, self.load) = (*length, *load);
        self.course = if course.is_finite() { Course::Load(*course) } else { Course::Time };
        self.piece = Some(*piece).filter(|lasted| lasted.is_finite());
        let mut rest = rest;
        let mut tables = vec![];
        for _ in 0..*count as usize {
            let (rows, numbers) = rest.split_first()?;
            let (own, others) = numbers.split_at_checked(3 * *rows as usize)?;
            tables.push(Table(own.chunks(3).map(|row| [row[0], row[1], row[2]]).collect()));
            rest = others;
        }
        (!tables.is_empty()).then_some((tables, rest))
    }
}
