//! The rows of a table as sweeps, one per temperature, and storage and loss modulus from what instruments give in their
//! place:
//!
//! ```text
//! E'' = E' tan delta        E' = |E*| cos delta     E' = D'/(D'^2 + D''^2)      E' = omega eta''
//!                           E'' = |E*| sin delta    E'' = D''/(D'^2 + D''^2)    E'' = omega eta'
//! ```

use super::columns::Values;
use super::error::{CurveError, Remedy, Result, fault};
use super::segments::{Segments, by_set};
use super::{Kind, Role, Sweep};

/// Temperatures closer than this belong to one sweep \[K\]: no chamber holds a temperature better.
pub(super) const SAME_TEMPERATURE: f64 = 1.0;
/// Temperatures of one sweep spread by no more \[K\].
const SPREAD: f64 = 3.0;
/// Largest number of sweeps; a file with more is another kind of table.
const MOST_SWEEPS: usize = 1000;

/// The rows by temperature, the coldest first; each sweep in the order of the file, or the reverse where that goes down;
/// a DMA by frequency.
pub(super) fn sweeps(kind: Kind, values: &Values, lines: &[usize]) -> Result<(Vec<Sweep>, Option<String>)> {
    let of = |role: Role| values.get(&role).cloned().unwrap_or_default();
    let (x, curves) = match kind {
        Kind::Relaxation => (of(Role::Time), vec![of(Role::Modulus)]),
        Kind::Creep => (of(Role::Time), vec![of(Role::Compliance)]),
        Kind::Dma => (of(Role::Frequency), dynamic(values)),
    };
    let sweep = |temperature: Option<f64>, rows: &[usize]| {
        let mut rows = rows.to_vec();
        let falls = rows.windows(2).all(|pair| x[pair[1]] <= x[pair[0]])
            && rows.first().zip(rows.last()).is_some_and(|(first, last)| x[*last] < x[*first]);
        match kind {
            // The order of frequencies means nothing.
            Kind::Dma => rows.sort_by(|a, b| x[*a].total_cmp(&x[*b])),
            _ if falls => rows.reverse(),
            _ => {}
        }
        let pick = |column: &Vec<f64>| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        Sweep {
            temperature,
            x: pick(&x),
            curves: curves.iter().map(pick).collect(),
            lines: rows.iter().map(|row| lines[*row]).collect(),
        }
    };
    let all: Vec<usize> = (0..x.len()).collect();
    let sets = by_set(values);
    let several = |error: CurveError| match Segments::of(kind, values) {
        segments if segments.count() > 1 => segments.several(&error.message, lines).at(error.line),
        _ => error,
    };
    let Some(temperatures) = values.get(&Role::Temperature) else {
        if sets.len() > 1 {
            let why = "a column names several sets, and none holds their temperatures";
            return Err(Segments::of(kind, values).several(why, lines));
        }
        forward(kind, values, &all, lines)?;
        return once(kind, vec![sweep(None, &all)]).map_err(several);
    };
    let groups = match held(&sets, temperatures) {
        true if sets.len() > 1 => sets,
        _ => by_temperature(kind, temperatures, &all)?,
    };
    if groups.len() > MOST_SWEEPS && !is_ramp(groups.iter().map(|rows| mean(temperatures, rows))) {
        return Err(fault(format!("there are more than {MOST_SWEEPS} temperatures")));
    }
    groups.iter().try_for_each(|rows| forward(kind, values, rows, lines))?;
    let mut found: Vec<Sweep> =
        groups.iter().map(|rows| sweep(Some(mean(temperatures, rows)), rows)).collect();
    found.sort_by(|a, b| a.temperature.unwrap_or(0.0).total_cmp(&b.temperature.unwrap_or(0.0)));
    once(kind, found).map_err(several)
}

/// # Errors
/// Where the times of these rows of a relaxation or creep test begin again.
fn forward(kind: Kind, values: &Values, rows: &[usize], lines: &[usize]) -> Result<()> {
    let (false, Some(x)) = (kind == Kind::Dma, values.get(&Role::Time)) else { return Ok(()) };
    let back = |pair: &&[usize]| x[pair[1]] < x[pair[0]];
    let falls = rows.first().zip(rows.last()).is_some_and(|(first, last)| x[*last] < x[*first]);
    let (Some(pair), false) =
        (rows.windows(2).find(back), falls && rows.windows(2).all(|pair| x[pair[1]] <= x[pair[0]]))
    else {
        return Ok(());
    };
    let segments = Segments::of(kind, values);
    if segments.count() < 2 {
        return Ok(());
    }
    let [before, here] = [pair[0], pair[1]];
    let why = format!(
        "the time goes back from {:e} s on line {} to {:e} s here",
        x[before], lines[before], x[here]
    );
    Err(segments.several(&why, lines).at(lines[here]))
}

/// Values at one abscissa of a sweep differ from their mean by no more: others belong to different sweeps.
const SAME_VALUE: f64 = 0.1;

/// Each sweep with the mean of the values at the same time or frequency, and a note on these.
fn once(kind: Kind, sweeps: Vec<Sweep>) -> Result<(Vec<Sweep>, Option<String>)> {
    let name = if kind == Kind::Dma { "frequency" } else { "time" };
    let (mut repeated, mut farthest, mut first) = (0, 0.0_f64, None);
    let mut single = Vec::with_capacity(sweeps.len());
    for sweep in sweeps {
        let mut kept = Sweep { x: vec![], lines: vec![], curves: vec![vec![]; sweep.curves.len()], ..sweep };
        let mut start = 0;
        for group in sweep.x.chunk_by(|a, b| a == b) {
            let rows = start..start + group.len();
            start = rows.end;
            kept.x.push(group[0]);
            kept.lines.push(sweep.lines[rows.start]);
            for (curve, values) in kept.curves.iter_mut().zip(&sweep.curves) {
                let values = &values[rows.clone()];
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                curve.push(mean);
                let from_mean = |value: &f64| if *value == mean { 0.0 } else { (value / mean - 1.0).abs() };
                let apart = values.iter().map(from_mean).fold(0.0, f64::max);
                if group.len() > 1 && (apart.is_nan() || apart > SAME_VALUE) {
                    let [first, other] = [sweep.lines[rows.start], sweep.lines[rows.end - 1]];
                    return Err(fault(format!(
                        "the {name} is that of line {first}, but the values differ by {:.0} %, as those of different sweeps do, which need a column of temperatures",
                        100.0 * (values[values.len() - 1] / values[0] - 1.0).abs()
                    ))
                    .remedy(Remedy::Column(Role::Temperature))
                    .at(other));
                }
                farthest = farthest.max(apart);
            }
            if group.len() > 1 {
                repeated += group.len() - 1;
                first = first.or(Some(sweep.lines[rows.end - 1]));
            }
        }
        single.push(kept);
    }
    let note = first.map(|line| {
        format!(
            "{} a {name}, the first on line {line}: the mean is taken, and values differ from it by {:.1} % at most",
            if repeated == 1 { "1 point repeats".to_owned() } else { format!("{repeated} points repeat") },
            100.0 * farthest
        )
    });
    Ok((single, note))
}

/// Two columns, and storage and loss modulus from a value of each and the angular frequency.
pub(super) type Pair = ([Role; 2], fn(f64, f64, f64) -> (f64, f64));

/// The pairs from which storage and loss modulus follow.
pub(super) const DYNAMIC: [Pair; 9] = [
    ([Role::Storage, Role::Loss], |storage, loss, _| (storage, loss)),
    ([Role::Storage, Role::TanDelta], |storage, tan, _| (storage, storage * tan)),
    ([Role::Storage, Role::Phase], |storage, delta, _| (storage, storage * libm::tan(delta))),
    ([Role::ComplexModulus, Role::TanDelta], |size, tan, _| parts(size, tan)),
    ([Role::ComplexModulus, Role::Phase], |size, delta, _| parts(size, libm::tan(delta))),
    ([Role::StorageCompliance, Role::LossCompliance], |real, imaginary, _| {
        let squares = real * real + imaginary * imaginary;
        (real / squares, imaginary / squares)
    }),
    ([Role::ImaginaryViscosity, Role::RealViscosity], |imaginary, real, omega| {
        (imaginary * omega, real * omega)
    }),
    ([Role::ComplexViscosity, Role::TanDelta], |size, tan, omega| parts(size * omega, tan)),
    ([Role::ComplexViscosity, Role::Phase], |size, delta, omega| parts(size * omega, libm::tan(delta))),
];

/// Real and imaginary part of a complex number, from its absolute value and the tangent of its angle.
fn parts(size: f64, tan: f64) -> (f64, f64) {
    let real = size / (1.0 + tan * tan).sqrt();
    (real, real * tan)
}

/// Storage and loss modulus.
fn dynamic(values: &Values) -> Vec<Vec<f64>> {
    let none = Vec::new();
    let of = |role: &Role| values.get(role).unwrap_or(&none);
    let held = DYNAMIC.iter().find(|(pair, _)| pair.iter().all(|role| values.contains_key(role)));
    let Some(([first, second], moduli)) = held else {
        // A storage modulus alone.
        return vec![of(&Role::Storage).clone()];
    };
    let points = of(first).iter().zip(of(second)).zip(of(&Role::Frequency));
    let (storage, loss) = points.map(|((a, b), omega)| moduli(*a, *b, *omega)).unzip();
    vec![storage, loss]
}

/// Whether each set was measured at one temperature, and no two at the same.
fn held(sets: &[Vec<usize>], temperatures: &[f64]) -> bool {
    let spread = |rows: &Vec<usize>| {
        let of = |fold: fn(f64, f64) -> f64, start: f64| {
            rows.iter().map(|row| temperatures[*row]).fold(start, fold)
        };
        of(f64::max, f64::NEG_INFINITY) - of(f64::min, f64::INFINITY)
    };
    let mut means: Vec<f64> = sets.iter().map(|rows| mean(temperatures, rows)).collect();
    means.sort_by(f64::total_cmp);
    sets.iter().all(|rows| spread(rows) <= SPREAD)
        && means.windows(2).all(|pair| pair[1] - pair[0] > SAME_TEMPERATURE)
}

fn mean(temperatures: &[f64], rows: &[usize]) -> f64 {
    let first = rows.first().map_or(0.0, |row| temperatures[*row]);
    first + rows.iter().map(|row| temperatures[*row] - first).sum::<f64>() / rows.len().max(1) as f64
}

/// Whether sweeps at these temperatures \[K\], in order, are the rows of a ramp: held temperatures are further apart.
pub(super) fn is_ramp(temperatures: impl Iterator<Item = f64>) -> bool {
    let mut before = f64::NEG_INFINITY;
    temperatures.into_iter().any(|kelvin| kelvin - std::mem::replace(&mut before, kelvin) <= SAME_TEMPERATURE)
}

/// Rows whose temperatures follow each other closely. The rows of a temperature ramp of a DMA, which has no such groups, are sweeps of
/// their own: each is a point of E*(omega, T), whatever the temperature was before.
fn by_temperature(kind: Kind, temperatures: &[f64], rows: &[usize]) -> Result<Vec<Vec<usize>>> {
    let mut order = rows.to_vec();
    order.sort_by(|a, b| temperatures[*a].total_cmp(&temperatures[*b]));
    let same = |a: &usize, b: &usize| temperatures[*b] - temperatures[*a] <= SAME_TEMPERATURE;
    let mut groups = Vec::new();
    for group in order.chunk_by(same) {
        let (coldest, warmest) = (temperatures[group[0]], temperatures[group[group.len() - 1]]);
        if warmest - coldest > SPREAD && kind == Kind::Dma {
            let apart = order.chunk_by(|a, b| temperatures[*a] == temperatures[*b]);
            return Ok(apart.map(<[usize]>::to_vec).collect());
        }
        if warmest - coldest > SPREAD {
            return Err(fault(format!(
                "the temperatures from {coldest:.2} K to {warmest:.2} K follow each other within {SAME_TEMPERATURE} K; \
                 sweeps at held temperatures are needed"
            )));
        }
        let mut rows = group.to_vec();
        rows.sort_unstable();
        groups.push(rows);
    }
    Ok(groups)
}
