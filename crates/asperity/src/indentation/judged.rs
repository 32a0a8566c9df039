//! The record of a test as it is fitted, and how a fit lies against all its rows.

use super::free::Free;
use super::least_squares::Solution;
use super::model::Model;
use super::parameters::Law;
use super::spectrum::durbin_watson;
use super::{Given, IndentationOptions, IndentationRecord, check, control};
use crate::error::{Result, require};
use crate::reference::MdrProfile;

/// A record and, of a long one, the means that are fitted in its place.
pub(super) struct Test {
    pub(super) given: Given,
    pub(super) whole: Model,
    pub(super) model: Model,
    /// Row of the record of each row of `model`.
    pub(super) rows: Vec<usize>,
    /// What was taken off the record.
    pub(super) free: Free,
}

/// A fit beside all rows of the record.
pub(super) struct Judged {
    /// Of the rows of the fitted model.
    pub(super) predicted: Vec<f64>,
    /// Weighted.
    pub(super) residuals: Vec<f64>,
    pub(super) rms: f64,
    pub(super) relative_rms: f64,
    pub(super) durbin_watson: f64,
}

impl Test {
    pub(super) fn new(
        profile: MdrProfile,
        record: &IndentationRecord,
        options: &IndentationOptions,
    ) -> Result<Self> {
        check::options(options)?;
        check::columns(record)?;
        let free = Free::of(profile, record, options.fit_touch);
        let [loads, depths] = free.taken_off(record);
        let taken = IndentationRecord { times: record.times, loads: &loads, depths: &depths };
        check::signs(&taken, free.rows)?;
        let times = record.times.to_vec();
        let given = options.given.unwrap_or_else(|| control::controlled(&times, &loads, &depths));
        let loads = if given == Given::Load { free.unloaded(loads) } else { loads };
        let whole = Model::new(profile, times, loads, depths, given, options)?;
        let (model, rows) = whole.averaged();
        Ok(Test { given, whole, model, rows, free })
    }

    /// What the record shows where the model has this value.
    fn put_back(&self, value: f64, row: usize) -> f64 {
        match self.given {
            Given::Depth => value + self.free.load(self.whole.depths[row]),
            Given::Load => value + self.free.shift,
        }
    }

    /// The same without a comparison at the first row.
    pub(super) fn without_first(self) -> Self {
        Test { whole: self.whole.without_first(), model: self.model.without_first(), ..self }
    }

    /// A fit beside the rows; an error if its misfit exceeds the limit.
    pub(super) fn judge<L: Law>(&self, best: &Solution<L>, limit: f64) -> Result<Judged> {
        let whole = &self.whole;
        let prediction = whole.predict(best.parameters, &best.at)?;
        let apart = prediction.values.iter().zip(whole.measured()).map(|(model, measured)| model - measured);
        let apart = apart.collect::<Vec<f64>>();
        let residuals = apart.iter().zip(whole.weights(&prediction)).map(|(apart, w)| apart * w);
        let residuals = whole.of_compared(&residuals.collect::<Vec<f64>>());
        let apart = whole.of_compared(&apart);
        let rms = (apart.iter().map(|x| x * x).sum::<f64>() / apart.len() as f64).sqrt();
        let relative_rms = rms / self.model.scale;
        require(
            relative_rms <= limit,
            "misfit of the record",
            format!("{:.1} % of the largest value (rms)", 100.0 * relative_rms),
            format!(
                "at most {:.1} %: check radius, units and the depth of first touch, and whether the body is as thick as assumed",
                100.0 * limit
            ),
        )?;
        Ok(Judged {
            predicted: self.rows.iter().map(|row| self.put_back(prediction.values[*row], *row)).collect(),
            durbin_watson: durbin_watson(&residuals),
            residuals,
            rms,
            relative_rms,
        })
    }
}
