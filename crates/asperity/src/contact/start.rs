//! The pressure that a solve starts from: the caller's guess made feasible, or a cold start; and the
//! rescaling of a pressure to its load.

use super::shift::{FREE, clip, shift_to_sum};
use super::{ContactState, Prescribed, Problem};
use crate::error::{Error, Result};
use crate::field::{strands, sweep};

/// Makes `state.pressure` feasible: zero where nothing can touch, within \[0, H\], with the load W.
///
/// `free` and `y` are working memory; `free` comes back marking the cells that can touch.
pub(super) fn make_feasible(
    problem: &Problem,
    cell_area: f64,
    state: &mut ContactState,
    free: &mut [u8],
    y: &mut [f64],
) -> Result<()> {
    let hardness = problem.hardness;
    let [sum, touchable] = sweep((&mut state.pressure[..], problem.gap, &mut free[..]), &|(p, h, free): (
        &mut [f64],
        &[f64],
        &mut [u8],
    )| {
        strands(p.len(), |i| {
            let can_touch = h[i] < f64::INFINITY;
            free[i] = if can_touch { FREE } else { 0 };
            p[i] = if can_touch { clip(p[i], hardness) } else { 0.0 };
            [p[i], f64::from(free[i])]
        })
    });
    let Prescribed::Load(load) = problem.prescribed else {
        return Ok(());
    };
    let target = load / cell_area;
    if sum <= 0.0 {
        let uniform = target / touchable;
        state.pressure.iter_mut().zip(&*free).for_each(|(p, f)| *p = uniform * f64::from(*f));
        return Ok(());
    }
    set_load(&mut state.pressure, free, y, hardness, target)
        .ok_or(Error::Infeasible { load, max: hardness * cell_area * touchable })
}

/// Gives a pressure within \[0, H\] the sum `target`: by scaling the cells below H, which keeps open
/// cells open; where those cannot carry it, by a shift of all `free` cells.
pub(super) fn set_load(p: &mut [f64], free: &[u8], y: &mut [f64], hardness: f64, target: f64) -> Option<()> {
    for _ in 0..50 {
        let [below, capped] = sweep(&*p, &|p: &[f64]| {
            strands(p.len(), |i| if p[i] < hardness { [p[i], 0.0] } else { [0.0, 1.0] })
        });
        let rest = if capped > 0.0 { target - capped * hardness } else { target };
        if below <= 0.0 || rest <= 0.0 {
            break;
        }
        let factor = rest / below;
        let [over] = sweep(&mut *p, &|p: &mut [f64]| {
            strands(p.len(), |i| {
                let scaled = if p[i] < hardness { p[i] * factor } else { p[i] };
                p[i] = if scaled < hardness { scaled } else { hardness };
                [f64::from(u8::from(scaled > hardness))]
            })
        });
        if over == 0.0 {
            return Some(());
        }
    }
    y.copy_from_slice(p);
    shift_to_sum(y, free, hardness, target)?;
    sweep((p, &*y, free), &|(p, y, free): (&mut [f64], &[f64], &[u8])| {
        for i in 0..p.len() {
            p[i] = if free[i] == FREE { clip(y[i], hardness) } else { 0.0 };
        }
    });
    Some(())
}
