//! What was found below the surface, at each of the times.

use asperity::finding::Finding;
use asperity::stress::{Extreme, Survey};
use asperity::{Grid, finding};

use crate::store::{Reader, Result, StressSet};

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

/// What was found below the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Below {
    /// What was computed.
    pub set: StressSet,
    /// What was found at each of the times.
    pub instants: Vec<Instant>,
}

impl Below {
    /// What a result holds; `None` where nothing was computed.
    ///
    /// # Errors
    /// [`crate::store::StoreError`] where the result is damaged.
    pub fn of(reader: &Reader) -> Result<Option<Below>> {
        let Some(set) = reader.stress() else { return Ok(None) };
        let scalars: Vec<Vec<f64>> =
            set.scalars().iter().map(|series| reader.stress_series(series.name)).collect::<Result<_>>()?;
        let profiles: Vec<_> =
            set.profiles().iter().map(|series| reader.stress_profile(series.name)).collect::<Result<_>>()?;
        let loads = reader.series("load")?;
        let instants = set.instants.iter().map(|index| {
            let row = reader.field_steps()[*index];
            Instant {
                index: *index,
                time: reader.field_times()[*index],
                row,
                load: loads.get(row).copied().unwrap_or(f64::NAN),
                scalars: scalars.iter().map(|series| series[*index]).collect(),
                profiles: profiles.iter().map(|profile| profile.row(*index).to_vec()).collect(),
            }
        });
        Ok(Some(Below { instants: instants.collect(), set: set.clone() }))
    }

    /// A number of an instant, by its name in the result; NaN where there is none.
    pub fn number(&self, instant: &Instant, name: &str) -> f64 {
        let place = self.set.scalars().iter().position(|series| series.name == name);
        place.and_then(|n| instant.scalars.get(n)).copied().unwrap_or(f64::NAN)
    }

    /// A profile of an instant, by its name in the result; empty where there is none.
    pub fn profile<'a>(&self, instant: &'a Instant, name: &str) -> &'a [f64] {
        let place = self.set.profiles().iter().position(|series| series.name == name);
        place.and_then(|n| instant.profiles.get(n)).map(Vec::as_slice).unwrap_or_default()
    }

    /// The instant with the largest von Mises stress; the first of several.
    pub fn worst(&self) -> Option<&Instant> {
        let mises = |instant: &Instant| self.number(instant, "max_mises");
        self.instants.iter().reduce(|a, b| if mises(b) > mises(a) { b } else { a })
    }

    /// Where the numbers may be off, and whether the body yields.
    pub fn findings(&self, grid: &Grid) -> Vec<Finding> {
        let Some(worst) = self.worst() else { return vec![] };
        let mut found = vec![];
        let cell = grid.spacing()[0].max(grid.spacing()[1]);
        let depth = self.number(worst, "max_mises_depth");
        if depth > 0.0 && depth < 2.0 * cell {
            found.push(finding::stress_unresolved(depth, cell).at([worst.row; 2]));
        }
        if let [_, .., deepest] = self.set.depths[..]
            && depth == deepest
        {
            found.push(finding::stress_at_deepest(deepest).at([worst.row; 2]));
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
    let mut numbers = vec![];
    for extreme in [&survey.mises, &survey.tresca, &survey.tension] {
        numbers.push(extreme.value);
        numbers.extend(place(extreme));
    }
    numbers.extend(survey.stressed_volume);
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
