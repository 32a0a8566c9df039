//! Which pressure of the sweep comes next: first where the patch closes, then where the leak is open.

use asperity::seal::{Conductance, bounds, refinement};
use rayon::prelude::*;

use super::{SealPlan, SealSweep};

/// The leak stands where the sweep leaves less than this share of it open, at every time, and has looked where it chokes.
pub(super) const STANDS: f64 = 0.05;
/// An interval with this share of the first ratio of two pressures has none between them: the sweep has not looked there, and may miss a
/// passage that closes.
const FIRST: f64 = 0.99;
/// The first sealing pressure is known where it is this share of itself from the last pressure that leaks.
const CLOSES: f64 = 0.02;

/// The next pressure \[Pa\], of a sweep that has so many beside the first ones; `None` where the leak stands.
pub(super) fn next(plan: &SealPlan, sweep: &SealSweep, more: usize) -> asperity::Result<Option<f64>> {
    if more < plan.closing_pressures()
        && let Some(middle) = closing(sweep)?
    {
        return Ok(Some(middle));
    }
    let states = (0..sweep.times.len()).flat_map(|time| (0..sweep.seeds.len()).map(move |seed| [time, seed]));
    let states: Vec<[usize; 2]> = states.collect();
    let open = |[time, seed]: &[usize; 2]| -> asperity::Result<([f64; 2], Conductance)> {
        let sigma = sweep.conductance(plan, *seed, *time)?;
        Ok((bounds(&sigma, &plan.profile, plan.ends)?, sigma))
    };
    let open: asperity::Result<Vec<_>> = states.par_iter().map(open).collect();
    let open = open?;
    let mut times: Vec<(f64, &[_])> =
        open.chunks(sweep.seeds.len()).map(|seeds| (share(seeds.iter().map(|seed| seed.0)), seeds)).collect();
    times.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (share, seeds) in times {
        let mut seeds: Vec<&([f64; 2], Conductance)> = seeds.iter().collect();
        let width = |seed: &([f64; 2], Conductance)| seed.0[1] - seed.0[0];
        seeds.sort_by(|a, b| width(b).total_cmp(&width(a)));
        for (_, sigma) in seeds {
            let Some(pressure) = refinement(sigma, &plan.profile, plan.ends)? else { continue };
            let is_first =
                sigma.around(pressure).is_some_and(|[from, to]| to / from > FIRST * plan.first_ratio());
            if share > STANDS || is_first {
                return Ok(Some(pressure));
            }
        }
    }
    Ok(None)
}

/// How much of the mean of all seeds is open, from 0 to 1; 0 where nothing leaks or it is not known.
pub(super) fn share(bounds: impl Iterator<Item = [f64; 2]>) -> f64 {
    let [low, high] = bounds.fold([0.0; 2], |[low, high], one| [low + one[0], high + one[1]]);
    if high > 0.0 && high.is_finite() { 1.0 - low / high } else { 0.0 }
}

/// The middle of the pressures between which a seed closes at the last time, where they are furthest apart.
fn closing(sweep: &SealSweep) -> asperity::Result<Option<f64>> {
    let mut widest = (1.0 + CLOSES, None);
    for seed in &sweep.seeds {
        let sigma = seed.conductance(sweep.times.len() - 1)?;
        if let (Some(leaks), Some(tight)) = (sigma.last_leaking(), sigma.sealing_pressure())
            && tight / leaks > widest.0
        {
            widest = (tight / leaks, Some((leaks * tight).sqrt()));
        }
    }
    Ok(widest.1)
}
