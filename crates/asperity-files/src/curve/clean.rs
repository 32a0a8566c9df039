//! Points that a fit cannot take, left out before it: those outside its window, and moduli of a DMA that are not greater than 0.
//!
//! Instruments write loss moduli below 0 where the phase angle is below their accuracy. A few such points are left out, and the fit says
//! so. The end of a relaxation that sinks into the noise is not: without the points below 0, the mean of those that are left is too high.

use asperity::material::Moduli;

use super::error::{Remedy, Result, fault};
use super::fit::{Request, ShiftRequest};
use super::{Curves, Kind, Place, Sweep};

/// Largest share of points that are left out because a modulus is not greater than 0.
const MOST: f64 = 0.1;
/// Values below so many times the noise are not told from it.
const ABOVE_NOISE: f64 = 3.0;

/// The curves without such points, and notes on them.
pub(super) fn cleaned(curves: &Curves, request: &Request) -> Result<(Curves, Vec<String>)> {
    let (mut curves, mut notes) = (curves.clone(), Vec::new());
    windowed(&mut curves, request, &mut notes);
    match curves.kind {
        Kind::Dma => dynamic(&mut curves, request.options.moduli, &mut notes)?,
        _ => above_noise(&mut curves, &mut notes)?,
    }
    Ok((curves, notes))
}

/// Leaves out what the known shift moves out of the window, so that no sweep is judged that is not fitted.
fn windowed(curves: &mut Curves, request: &Request, notes: &mut Vec<String>) {
    let Some([first, last]) = request.window else { return };
    let shift = match &request.shift {
        ShiftRequest::Given(shift) => Some(shift.clone()),
        ShiftRequest::Estimate(_) => return,
        ShiftRequest::None => curves.held.shift().cloned(),
    };
    if shift.is_none() && curves.sweeps.len() > 1 {
        return;
    }
    let (kind, before) = (curves.kind, curves.sweeps.len());
    let mut sweeps = curves.sweeps.clone();
    sweeps.retain_mut(|sweep| {
        let factor = match (&shift, sweep.temperature) {
            (Some(shift), Some(kelvin)) => shift.factor(kelvin).ok(),
            _ => Some(1.0),
        };
        let Some(factor) = factor else { return false };
        let factor = if kind == Kind::Dma { factor } else { 1.0 / factor };
        keep(sweep, |x, _| x * factor >= first * (1.0 - 1e-9) && x * factor <= last * (1.0 + 1e-9));
        !sweep.x.is_empty()
    });
    // Without any point the fit says what the data cover.
    if sweeps.iter().map(|sweep| sweep.x.len()).sum::<usize>() < 2 {
        return;
    }
    curves.sweeps = sweeps;
    let left = before - curves.sweeps.len();
    if left > 0 {
        notes.push(format!("{left} of {before} temperatures lie outside the window and are not fitted"));
    }
}

/// Keeps the points of a sweep for which this holds, of abscissa and number.
fn keep(sweep: &mut Sweep, holds: impl Fn(f64, usize) -> bool) {
    let kept: Vec<usize> = (0..sweep.x.len()).filter(|n| holds(sweep.x[*n], *n)).collect();
    let pick = |values: &Vec<f64>| kept.iter().map(|n| values[*n]).collect::<Vec<f64>>();
    sweep.curves = sweep.curves.iter().map(pick).collect();
    sweep.lines = kept.iter().filter_map(|n| sweep.lines.get(*n).copied()).collect();
    sweep.x = pick(&sweep.x);
}

/// Leaves out the points of a DMA with a modulus that is not greater than 0.
fn dynamic(curves: &mut Curves, moduli: Moduli, notes: &mut Vec<String>) -> Result<()> {
    // A loss modulus of 0 is that of an elastic body; the logarithms of a shift do not take it.
    let several = curves.sweeps.len() > 1;
    let is_bad = |column: usize, value: f64| {
        !(value.is_finite() && (value > 0.0 || (value == 0.0 && column == 1 && !several)))
    };
    if curves.sweeps.iter().any(|sweep| sweep.curves.len() < 2) && moduli != Moduli::Storage {
        return Err(
            fault("no column is recognised as loss modulus, loss factor or phase angle").remedy(Remedy::Loss)
        );
    }
    for (column, name) in [(1, "loss"), (0, "storage")] {
        let at = |sweep: &Sweep, n: usize| {
            sweep.curves.get(column).is_some_and(|values| is_bad(column, values[n]))
        };
        let bad = curves.sweeps.iter().flat_map(|sweep| {
            (0..sweep.x.len()).filter(|n| at(sweep, *n)).map(|n| sweep.lines.get(n).copied())
        });
        let bad: Vec<Option<usize>> = bad.collect();
        if bad.is_empty() {
            continue;
        }
        let (count, all, first) = (bad.len(), curves.points(), bad[0]);
        let place = column_of(curves, name);
        if column == 1 && moduli == Moduli::Storage {
            curves.sweeps.iter_mut().for_each(|sweep| sweep.curves.truncate(1));
            notes.push(format!("{count} of {all} loss moduli{place} are not greater than 0: the loss modulus is not compared with the fit"));
            continue;
        }
        if count as f64 > (MOST * all as f64).max(1.0) {
            let other = if column == 1 { Remedy::Moduli } else { Remedy::Column(super::Role::Storage) };
            return Err(fault(format!(
                "{count} of {all} {name} moduli{place} are not greater than 0, as those of every passive material are; check column and sign, \
                 or take the points out"
            ))
            .remedy(other)
            .at(first));
        }
        for sweep in &mut curves.sweeps {
            let good: Vec<bool> = (0..sweep.x.len()).map(|n| !at(sweep, n)).collect();
            keep(sweep, |_, n| good[n]);
        }
        curves.sweeps.retain(|sweep| !sweep.x.is_empty());
        curves.left_out += count;
        notes.push(format!(
            "{count} of {all} {name} moduli{place} {} not greater than 0 and left out{}",
            is(count),
            lines(&bad)
        ));
    }
    Ok(())
}

/// Leaves out a stray point of a relaxation or creep test that is not greater than 0; many are noise, and need a window.
fn above_noise(curves: &mut Curves, notes: &mut Vec<String>) -> Result<()> {
    let name = curves.kind.columns()[0];
    let place = column_of(curves, name);
    for sweep in &mut curves.sweeps {
        let Some(values) = sweep.curves.first() else { continue };
        let bad: Vec<usize> =
            (0..values.len()).filter(|n| !(values[*n].is_finite() && values[*n] > 0.0)).collect();
        let Some(first) = bad.first().copied() else { continue };
        let line = |n: usize| sweep.lines.get(n).copied();
        let (count, all) = (bad.len(), values.len());
        let unit = if name.contains("modulus") { "Pa" } else { "1/Pa" };
        // A stray point has neighbours far above its own distance from 0.
        let stray = |n: &usize| {
            let near = [n.checked_sub(1), Some(n + 1)].into_iter().flatten().filter_map(|k| values.get(k));
            let least = near.copied().fold(f64::INFINITY, f64::min);
            least > 0.0 && *n + 1 < all && *n > 0 && (least > ABOVE_NOISE * values[*n].abs() || count == 1)
        };
        let is_few = count as f64 <= (0.02 * all as f64).max(1.0) && count as f64 <= MOST * all as f64;
        if is_few && bad.iter().all(stray) {
            let told: Vec<Option<usize>> = bad.iter().map(|n| line(*n)).collect();
            notes.push(format!(
                "{count} of {all} values of the {name}{place} {} not greater than 0 and left out{}",
                is(count),
                lines(&told)
            ));
            keep(sweep, |_, n| !bad.contains(&n));
            curves.left_out += count;
            continue;
        }
        // A single one of few points is refused by the fit, which names it.
        if count == 1 && all < 20 {
            continue;
        }
        let tail = &values[first..];
        let noise = (tail.iter().map(|v| v * v).sum::<f64>() / tail.len() as f64).sqrt();
        let end = values.iter().position(|value| *value < ABOVE_NOISE * noise).unwrap_or(first).min(first);
        let start = sweep.x.iter().copied().find(|x| *x > 0.0).unwrap_or(0.0);
        let fault = fault(format!(
            "the {name}{place} is {:e} {unit} {}, and {count} of {all} values are not greater than 0, as those of every passive material are: from \
             {:.3e} s on it is not told from noise",
            values[first],
            line(first).map_or(format!("at point {}", first + 1), |_| "here".to_owned()),
            sweep.x[end.min(sweep.x.len() - 1)]
        ))
        .at(line(first));
        return Err(match end >= 2 && sweep.x[end - 1] > start {
            true => {
                fault.remedy(Remedy::Window(format!("{start:.3e} s"), format!("{:.3e} s", sweep.x[end - 1])))
            }
            false => fault,
        });
    }
    Ok(())
}

/// `, column 3 ("E'' [MPa]"),` of the curve of this name, or nothing where several columns make it.
fn column_of(curves: &Curves, name: &str) -> String {
    let word = name.split(' ').next_back().unwrap_or(name);
    let named = |place: &&Place| place.role.name() == word;
    curves.columns.iter().find(named).map_or(String::new(), |Place { column, header, .. }| {
        match header.is_empty() {
            true => format!(" (column {column})"),
            false => format!(" (column {column}, {header:?})"),
        }
    })
}

fn is(count: usize) -> &'static str {
    if count == 1 { "is" } else { "are" }
}

/// " (line 12)" or " (lines 12, 13, ...)".
fn lines(lines: &[Option<usize>]) -> String {
    let known: Vec<String> = lines.iter().flatten().take(10).map(usize::to_string).collect();
    let more = if lines.len() > known.len() { ", ..." } else { "" };
    match known.len() {
        0 => String::new(),
        1 => format!(" (line {})", known[0]),
        _ => format!(" (lines {}{more})", known.join(", ")),
    }
}
