//! The load W as one more cell, whose displacement is the driver L = ∫ C dW (see [`super::shape`]).

use super::rules::{Driver, Rules};
use super::shape::Shape;
use crate::material::Dual;
use crate::step::saved;

/// The load over the step under way.
pub(crate) struct LoadCell {
    /// At the start of the step, and at its end.
    pub(crate) start: Total,
    pub(crate) end: Total,
    /// How L runs over it.
    pub(crate) shape: Shape,
    pub(crate) strains: Vec<f64>,
}

/// The load W, its driver L and its states.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Total {
    pub(crate) load: f64,
    pub(crate) driver: f64,
    pub(crate) states: Vec<f64>,
}

impl Total {
    fn set(&mut self, other: &Total) {
        (self.load, self.driver) = (other.load, other.driver);
        self.states.copy_from_slice(&other.states);
    }
}

impl LoadCell {
    pub(crate) fn at_rest(dual: &Dual) -> Self {
        let rest = Total { load: 0.0, driver: 0.0, states: vec![0.0; dual.states()] };
        LoadCell {
            start: rest.clone(),
            end: rest,
            shape: Shape::new(dual.creep.terms.len()),
            strains: vec![0.0; dual.strains()],
        }
    }

    /// The next step starts where the last one ended.
    pub(crate) fn begin(&mut self) {
        self.start.set(&self.end);
    }

    /// What u runs linearly in over a step of length `x` that ends under this load.
    pub(crate) fn driver(&mut self, dual: &Dual, load: Option<f64>, x: f64) -> Driver {
        let Some(load) = load.filter(|_| x > 0.0) else { return Driver::Time };
        let LoadCell { start, shape, strains, .. } = self;
        dual.to_strains(&start.states, start.driver, strains);
        shape.set(dual, start.load, (load - start.load) / x, strains);
        match shape.runs_one_way(dual, start.driver, x) {
            true => Driver::Load(shape.change(dual, x)),
            false => Driver::Time,
        }
    }

    /// Sets L to its course after the step, while the load changes at the rate `slope`.
    pub(crate) fn go_on(&mut self, dual: &Dual, slope: f64) {
        dual.to_strains(&self.end.states, self.end.driver, &mut self.strains);
        self.shape.set(dual, self.end.load, slope, &self.strains);
    }

    /// Ends the step under a load; without rules its states and driver stay.
    pub(crate) fn close(&mut self, load: f64, rules: Option<&Rules>) {
        self.end.set(&self.start);
        self.end.load = load;
        if let Some(rules) = rules {
            self.end.driver = rules.end(load, self.start.driver, &mut self.end.states);
        }
    }
}

saved! {
    LoadCell { "load": end.load, end.driver; "load_states": end.states; }
}
