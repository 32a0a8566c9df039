//! What must be known before the answers about a seal are used.

use asperity::finding::{
    Finding, SEAL_BELOW_SWEEP, SEAL_BEYOND_SWEEP, SEAL_CURVE_COARSE, SEAL_LIFTED, SEAL_NARROW,
    SEAL_NEVER_TIGHT, SEAL_PATCH_SMALL, SEAL_SWEEP_COARSE, window_in_leak,
};
use asperity::seal::{Conductance, SealFlow, SealState, flow};

use super::answer::COARSE;
use super::{Over, SealPlan, SealSweep, refine};
use crate::readable::quantity;

/// Patches across the seal, at least.
const PATCHES: f64 = 4.0;
/// Longest waves in a side of the patch, at least.
const WAVES: f64 = 2.0;
/// Largest share of the leak that pressures below the sweep may change.
const UNKNOWN: f64 = 0.02;
/// Largest share of the leak that the pressures of the sweep may leave open.
const OPEN: f64 = 0.1;
/// What the conductance below the sweep may be, times that at its first pressure.
const BELOW: f64 = 100.0;

/// Where the curve over the inlet pressure is coarse.
pub(super) fn of_curve(curve: &[Over]) -> Option<Finding> {
    let open = curve.iter().map(Over::open).fold(0.0, f64::max);
    let mut ranges: Vec<[f64; 2]> = vec![];
    let mut before = false;
    for over in curve {
        match ranges.last_mut().filter(|_| before) {
            Some(range) if over.is_coarse() => range[1] = over.at,
            None if over.is_coarse() => ranges.push([over.at; 2]),
            _ => {}
        }
        before = over.is_coarse();
    }
    let words = |[from, to]: &[f64; 2]| match from == to {
        true => quantity(*from, "Pa"),
        false => format!("{} to {}", quantity(*from, "Pa"), quantity(*to, "Pa")),
    };
    let text = format!(
        "At inlet pressures of {} the pressures of the sweep leave the leak open by more than a factor of two: of the curve over the inlet \
         pressure, only the bounds are known there. For the leak at one of them, make it the inlet pressure of the case and give the same \
         command again, which adds pressures to the sweep.",
        ranges.iter().map(words).collect::<Vec<_>>().join(", ")
    );
    (!ranges.is_empty()).then(|| Finding::warning(SEAL_CURVE_COARSE, open, COARSE, text).as_note())
}

pub(super) fn of(
    plan: &SealPlan,
    sweep: &SealSweep,
    sigmas: &[Conductance],
    flows: &[SealFlow],
    now: &Over,
) -> asperity::Result<Vec<Finding>> {
    let mut found = Vec::from_iter(window_in_leak(&plan.windowed));
    let [inlet, _] = plan.ends;
    let pa = |pressure: f64| quantity(pressure, "Pa");
    let largest = plan.profile.largest(inlet).unwrap_or(0.0);
    if flows.iter().any(|flow| flow.state == SealState::Lifted) {
        let text = format!(
            "The pressure at the inlet, {}, is not below the largest contact pressure, {}: the fluid lifts the seal, and the leak is \
             that of an open gap, which is not computed. Press the seal more, or lower the pressure.",
            pa(inlet),
            pa(largest)
        );
        found.push(Finding::warning(SEAL_LIFTED, inlet, largest, text));
    }
    if let Some(SealFlow { pressed: ends, .. }) = flows.iter().find(|flow| flow.state == SealState::Unknown) {
        let text = format!(
            "The fluid leaves the contact {}, but the patch is tight already at the smallest pressure of the sweep, {}: whether \
             the seal leaks is not known. Raise seal.pressures, or run the patch at smaller pressures.",
            pa(ends[0]),
            pa(ends[1])
        );
        found.push(Finding::warning(SEAL_BELOW_SWEEP, ends[0], ends[1], text));
    }
    let leaks = |flow: &SealFlow| flow.state == SealState::Leaks;
    let mut share = 0.0f64;
    for (sigma, known) in sigmas.iter().zip(flows).filter(|(_, known)| leaks(known)) {
        if known.pressed[0] < sigma.ends()[0] {
            let open = flow(&sigma.with_below(BELOW), &plan.profile, plan.ends)?;
            share = share.max(open.flow / known.flow - 1.0);
        }
        let [_, end] = sigma.ends();
        if known.pressed[1] > end * (1.0 + 1e-9) {
            let text = format!(
                "The seal is pressed with up to {}, but the sweep of the patch ends at {}, where it leaks still: the leak is too large. \
                 Begin again in another folder.",
                pa(known.pressed[1]),
                pa(end)
            );
            found.push(Finding::warning(SEAL_BEYOND_SWEEP, known.pressed[1], end, text));
        }
    }
    if share > UNKNOWN {
        let text = format!(
            "A part of the seal is pressed less than the smallest pressure of the sweep. What the patch conducts there may raise the leak \
             by {:.0} %. Raise seal.peak or lower the pressure of the fluid.",
            100.0 * share
        );
        found.push(Finding::warning(SEAL_BELOW_SWEEP, share, UNKNOWN, text));
    }
    let open = refine::share([now.bounds].into_iter());
    if open > OPEN {
        let unit = plan.unit();
        let [low, high] = now.bounds.map(|leak| quantity(leak, unit));
        let text = format!(
            "Between the pressures of the sweep the conductance of the patch is not known well enough: the leak may be anything from {low} to \
             {high}. The same command again adds pressures; where the fluid leaves the contact about the pressure that closes the patch, the \
             leak stays uncertain."
        );
        found.push(Finding::warning(SEAL_SWEEP_COARSE, open, OPEN, text));
    }
    let open = sigmas.iter().filter(|sigma| sigma.sealing_pressure().is_none()).count();
    if open > 0 {
        let (patch, seal) = match open == sigmas.len() {
            true => ("The patch leaks".to_owned(), "the seal leaks"),
            false => (
                format!("The patches of {open} of {} seeds leak", sigmas.len()),
                "a seal of such patches leaks",
            ),
        };
        let most = sigmas.iter().filter_map(Conductance::last_leaking).fold(0.0, f64::max);
        let text = format!(
            "{patch} at every pressure of the sweep, up to {}, the largest in this seal: {seal} at every inlet pressure.",
            pa(most)
        );
        found.push(Finding::warning(SEAL_NEVER_TIGHT, most, largest, text).as_note());
    }
    let (width, patch) = (plan.profile.width(), sweep.size[plan.patch]);
    if width < PATCHES * patch {
        let text = format!(
            "The seal is {} wide, less than {PATCHES} patches of {}: the pressure of the fluid changes within a patch, which the answers \
             leave out. Take a shorter domain along the flow, if the longest wave allows it.",
            quantity(width, "m"),
            quantity(patch, "m")
        );
        found.push(Finding::warning(SEAL_NARROW, width, PATCHES * patch, text));
    }
    if let Some(longest) = plan.rough.as_ref().and_then(|rough| rough.longest) {
        let side = sweep.size[0].min(sweep.size[1]);
        if side < WAVES * longest {
            let text = format!(
                "The patch is {} wide, less than {WAVES} times the longest wave of its roughness, {}: seeds differ, and the sealing \
                 pressure is that of a few summits. Take a larger domain, or more seeds.",
                quantity(side, "m"),
                quantity(longest, "m")
            );
            found.push(Finding::warning(SEAL_PATCH_SMALL, side, WAVES * longest, text));
        }
    }
    Ok(found)
}
