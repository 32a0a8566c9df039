//! The stress below the surface at each of the times.

use asperity::finding::Finding;
use asperity::stress::{Extreme, Survey, unseen_depths};
use asperity::{Axis, Grid, finding};

use crate::store::{At, FieldKind, Reader, Result, StressSet};

/// Largest pressures that differ by less are the same.
const SAME_PEAK: f64 = 1.02;

/// What was found at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Number of the stored instant.
    pub index: usize,
    /// Its time \[s\].
    pub time: f64,
    /// The row that it belongs to.
    pub row: usize,
    /// The load of that row \[N\].
    pub load: f64,
    /// The numbers of [`StressSet::scalars`].
    pub scalars: Vec<f64>,
    /// The rows of [`StressSet::profiles`], a number for each depth.
    pub profiles: Vec<Vec<f64>>,
}

/// The stress below the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Below {
    /// What was computed.
    pub set: StressSet,
    /// The cells of the result.
    pub grid: Grid,
    /// What its times are: those of a run, or the velocities of a sweep.
    pub axis: Axis,
    /// What was found at each of the times.
    pub instants: Vec<Instant>,
    /// Time \[s\] and load \[N\] of the row with the largest pressure, if all computed times are far from it.
    pub missed: Option<[f64; 2]>,
}

/// The loads of stored instants.
pub(super) struct Loads {
    times: Vec<f64>,
    loads: Vec<f64>,
}

impl Loads {
    pub(super) fn of(reader: &Reader) -> Result<Loads> {
        Ok(Loads { times: reader.series("time")?, loads: reader.series("load")? })
    }

    /// The load of a stored instant \[N\]; the sum of the pressure where the field has a time of its own between two rows.
    pub(super) fn at(&self, reader: &Reader, index: usize) -> Result<f64> {
        let row = reader.field_steps()[index];
        if self.times.get(row) == Some(&reader.field_times()[index]) {
            return Ok(self.loads.get(row).copied().unwrap_or(f64::NAN));
        }
        Ok(reader.field(FieldKind::Pressure, At::Index(index))?.sum() * reader.header().grid.cell_area())
    }
}

/// See [`Below::missed`].
pub(super) fn missed(reader: &Reader, rows: impl Iterator<Item = usize>) -> Result<Option<[f64; 2]>> {
    let [peaks, times, loads] =
        [reader.series("max_pressure")?, reader.series("time")?, reader.series("load")?];
    let seen = rows.filter_map(|row| peaks.get(row).copied()).fold(0.0, f64::max);
    let largest = (0..peaks.len()).reduce(|a, b| if peaks[b] > peaks[a] { b } else { a });
    Ok(largest.filter(|row| peaks[*row] > SAME_PEAK * seen).map(|row| [times[row], loads[row]]))
}

impl Below {
    /// The stress that a result holds; `None` if none was computed.
    ///
    /// # Errors
    /// [`crate::store::StoreError`] where the result is damaged.
    pub fn of(reader: &Reader) -> Result<Option<Below>> {
        let Some(set) = reader.stress() else { return Ok(None) };
        let scalars: Vec<Vec<f64>> =
            set.scalars().iter().map(|series| reader.stress_series(series.name)).collect::<Result<_>>()?;
        let profiles: Vec<_> =
            set.profiles().iter().map(|series| reader.stress_profile(series.name)).collect::<Result<_>>()?;
        let loads = Loads::of(reader)?;
        let instant = |index: &usize| -> Result<Instant> {
            Ok(Instant {
                index: *index,
                time: reader.field_times()[*index],
                row: reader.field_steps()[*index],
                load: loads.at(reader, *index)?,
                scalars: scalars.iter().map(|series| series[*index]).collect(),
                profiles: profiles.iter().map(|profile| profile.row(*index).to_vec()).collect(),
            })
        };
        let instants: Vec<Instant> = set.instants.iter().map(instant).collect::<Result<_>>()?;
        let missed = missed(reader, instants.iter().map(|instant| instant.row))?;
        let (grid, axis) = (reader.header().grid, reader.header().axis());
        Ok(Some(Below { grid, axis, instants, set: set.clone(), missed }))
    }

    /// A number of an instant, by its name in the result; NaN if it is not stored.
    pub fn number(&self, instant: &Instant, name: &str) -> f64 {
        let place = self.set.scalars().iter().position(|series| series.name == name);
        place.and_then(|n| instant.scalars.get(n)).copied().unwrap_or(f64::NAN)
    }

    /// A profile of an instant, by its name in the result; empty if it is not stored.
    pub fn profile<'a>(&self, instant: &'a Instant, name: &str) -> &'a [f64] {
        let place = self.set.profiles().iter().position(|series| series.name == name);
        place.and_then(|n| instant.profiles.get(n)).map(Vec::as_slice).unwrap_or_default()
    }

    /// The instant with the largest von Mises stress; the first of several.
    pub fn worst(&self) -> Option<&Instant> {
        let mises = |instant: &Instant| self.number(instant, "max_mises");
        self.instants.iter().reduce(|a, b| if mises(b) > mises(a) { b } else { a })
    }

    /// Depths \[m\] between which the von Mises stress may be larger than the largest one found ([`unseen_depths`]); `None` without
    /// contact.
    pub fn unseen(&self) -> Option<[f64; 2]> {
        let worst = self.worst().filter(|worst| self.number(worst, "max_mises") > 0.0)?;
        unseen_depths(&self.set.depths, self.profile(worst, "mises_by_depth"), self.grid.longest_cell())
    }

    /// Where the numbers may be off, and whether the body yields.
    pub fn findings(&self) -> Vec<Finding> {
        let Some(worst) = self.worst() else { return vec![] };
        let mut found = vec![];
        found.extend(
            self.missed.map(|[at, load]| {
                finding::stress_times_miss_peak(self.axis.at(at), load, self.grid.units("N"))
            }),
        );
        let cell = self.grid.longest_cell();
        let depth = self.number(worst, "max_mises_depth");
        if let Some(unseen) = self.unseen() {
            found.push(finding::stress_depths(depth, unseen).at([worst.row; 2]));
        } else if depth > 0.0 && depth < 2.0 * cell {
            found.push(finding::stress_unresolved(depth, cell).at([worst.row; 2]));
        }
        if let Some(limit) = self.set.yield_stress {
            let beyond = |instant: &&Instant| self.number(instant, "max_mises") > limit;
            let mut rows = self.instants.iter().filter(beyond).map(|instant| instant.row);
            if let Some(first) = rows.next() {
                let last = rows.next_back().unwrap_or(first);
                let mises = self.number(worst, "max_mises");
                found.push(finding::yield_exceeded(mises, limit).at([first, last]));
            }
        }
        found
    }
}

/// The numbers of a survey in the order of [`StressSet::scalars`]. Without any pressure the places are NaN.
pub(super) fn scalars(grid: &Grid, survey: &Survey) -> Vec<f64> {
    let ny = grid.cells()[1];
    let place = |extreme: &Extreme| match survey.mises.value > 0.0 {
        true => [extreme.depth, grid.x(extreme.cell / ny), grid.y(extreme.cell % ny)],
        false => [f64::NAN; 3],
    };
    // A line has no y.
    let known = 1 + grid.dimensions();
    let mut numbers = vec![];
    for extreme in [&survey.mises, &survey.tresca, &survey.tension] {
        numbers.push(extreme.value);
        numbers.extend(&place(extreme)[..known]);
    }
    // One depth says nothing of a volume.
    let volume = |volume: f64| if survey.mises_by_depth.len() > 1 { volume } else { f64::NAN };
    numbers.extend(survey.stressed_volume.map(volume));
    if let Some(shear) = &survey.orthogonal_shear {
        numbers.extend([shear.largest.value, place(&shear.largest)[0]]);
    }
    numbers
}

/// The profiles of a survey in the order of [`StressSet::profiles`].
pub(super) fn profiles(survey: &Survey) -> Vec<Vec<f64>> {
    let mut profiles =
        vec![survey.mises_by_depth.clone(), survey.tresca_by_depth.clone(), survey.tension_by_depth.clone()];
    profiles.extend(survey.orthogonal_shear.as_ref().map(|shear| shear.by_depth.clone()));
    profiles
}
