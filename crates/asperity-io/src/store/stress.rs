//! The arrays of the stress below the surface. They are added to a result once its pressures are stored. Their dimension is
//! `field_time`, of a sweep over velocities `field_velocity`; instants at which the stress was not computed are NaN.

use std::path::{Path, PathBuf};

use asperity::stress::{Rolling, StressQuantity};
use ndarray::{Array2, ArrayView2};
use serde::{Deserialize, Serialize};

use super::checksum::Sums;
use super::chunks::Chunks;
use super::column::Column;
use super::document::Document;
use super::error::{Result, corrupt};
use super::header::Header;
use super::layout::{ArraySpec, Series, Storage, cells};
use super::reader::{At, Reader, holds};
use super::writer::{Writer, lock, remove};
use crate::stress::Ratio;

/// The computed stress: which body, where and when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StressSet {
    /// Name of the body.
    pub body: String,
    /// Its Poisson's ratio.
    pub poisson: Ratio,
    /// Whether it is that of a line contact: nothing changes along y.
    #[serde(default)]
    pub line: bool,
    /// Depths \[m\], rising.
    pub depths: Vec<f64>,
    /// Fields that are stored at each depth.
    #[serde(rename = "components")]
    pub quantities: Vec<StressQuantity>,
    /// The stressed volume is that above this von Mises stress \[Pa\].
    pub threshold: Option<f64>,
    /// Yield stress of the body \[Pa\].
    pub yield_stress: Option<f64>,
    /// Direction of rolling.
    pub rolling: Option<Rolling>,
    /// Numbers of the stored instants at which it was computed.
    pub instants: Vec<usize>,
}

/// What to do where a result holds no stress.
const COMPUTES: &str = "`asperity stress RESULT` computes the stress";

const MAXIMA: [Series; 12] = [
    Series::new("max_mises", "Pa", "largest von Mises stress"),
    Series::new("max_mises_depth", "m", "depth of the largest von Mises stress"),
    Series::new("max_mises_x", "m", "x of the largest von Mises stress"),
    Series::new("max_mises_y", "m", "y of the largest von Mises stress"),
    Series::new("max_tresca", "Pa", "largest shear stress (Tresca)"),
    Series::new("max_tresca_depth", "m", "depth of the largest shear stress"),
    Series::new("max_tresca_x", "m", "x of the largest shear stress"),
    Series::new("max_tresca_y", "m", "y of the largest shear stress"),
    Series::new("max_tension", "Pa", "largest principal stress"),
    Series::new("max_tension_depth", "m", "depth of the largest principal stress"),
    Series::new("max_tension_x", "m", "x of the largest principal stress"),
    Series::new("max_tension_y", "m", "y of the largest principal stress"),
];
const VOLUME: Series = Series::new("stressed_volume", "m3", "volume above the threshold");
const SHEAR: [Series; 2] = [
    Series::new("orthogonal_shear", "Pa", "largest range of the orthogonal shear stress"),
    Series::new("orthogonal_shear_depth", "m", "depth of the largest range of the orthogonal shear stress"),
];
const PROFILES: [Series; 3] = [
    Series::new("mises_by_depth", "Pa", "largest von Mises stress by depth"),
    Series::new("tresca_by_depth", "Pa", "largest shear stress (Tresca) by depth"),
    Series::new("tension_by_depth", "Pa", "largest principal stress by depth"),
];
const SHEAR_PROFILE: Series =
    Series::new("orthogonal_shear_by_depth", "Pa", "range of the orthogonal shear stress by depth");
const DEPTH: &str = "depth";

/// The names that arrays of the stress may have.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    let one = MAXIMA.iter().chain(&SHEAR).chain(&PROFILES).map(|series| series.name);
    let rest = [VOLUME.name, SHEAR_PROFILE.name, DEPTH].into_iter();
    one.chain(rest).chain(StressQuantity::ALL.map(StressQuantity::field_name))
}

impl StressSet {
    /// The numbers of each instant.
    pub fn scalars(&self) -> Vec<Series> {
        let mut all = MAXIMA.to_vec();
        all.retain(|series| !(self.line && series.name.ends_with("_y")));
        all.extend(self.threshold.map(|_| self.volume()));
        all.extend(self.rolling.iter().flat_map(|_| SHEAR));
        all
    }

    /// The numbers that not every result with stress has.
    pub fn extra_scalars(&self) -> Vec<Series> {
        let is_extra = |series: &Series| !series.name.starts_with("max_");
        self.scalars().into_iter().filter(is_extra).collect()
    }

    fn volume(&self) -> Series {
        match self.line {
            true => Series::new(VOLUME.name, "m2", "area of the section above the threshold"),
            false => VOLUME,
        }
    }

    /// What each instant has a number of for each depth.
    pub fn profiles(&self) -> Vec<Series> {
        let mut all = PROFILES.to_vec();
        all.extend(self.rolling.map(|_| SHEAR_PROFILE));
        all
    }

    /// The stored fields: their names in the result.
    pub fn fields(&self) -> Vec<(StressQuantity, Series)> {
        let field = |quantity: &StressQuantity| {
            (*quantity, Series::new(quantity.field_name(), "Pa", quantity.long_name()))
        };
        self.quantities.iter().map(field).collect()
    }

    /// The arrays of a result with `maps` instants of fields.
    pub(super) fn arrays(&self, header: &Header, maps: usize) -> Vec<ArraySpec> {
        let (map, depth) = ((header.stored("field_time"), maps), (DEPTH, self.depths.len()));
        let grid = &header.grid;
        let depths = Series::new(DEPTH, "m", "depth below the surface");
        let mut arrays = vec![ArraySpec::new(depths, Storage::Whole, &[depth])];
        let rows = |series, over: &[_]| ArraySpec::new(series, Storage::Rows, over);
        arrays.extend(self.scalars().into_iter().map(|series| rows(series, &[map])));
        arrays.extend(self.profiles().into_iter().map(|series| rows(series, &[map, depth])));
        let over = [&[map, depth], cells(grid).as_slice()].concat();
        arrays.extend(
            self.fields().into_iter().map(|(_, series)| ArraySpec::new(series, Storage::Maps, &over)),
        );
        arrays
    }

    /// As the text of an attribute.
    pub(super) fn to_text(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// The inverse of [`to_text`](Self::to_text), for a result with `maps` instants; `None` where it is malformed.
    pub(super) fn parse(text: &str, maps: usize) -> Option<StressSet> {
        let set: StressSet = serde_json::from_str(text).ok()?;
        let rising = set.depths.is_sorted_by(|a, b| a < b) && set.instants.is_sorted_by(|a, b| a < b);
        let stored = set.instants.iter().all(|instant| *instant < maps);
        (rising && stored && !set.depths.is_empty()).then_some(set)
    }
}

/// The arrays of the stress while they are written; no reader sees them before [`Writer::add_stress`].
pub struct StressWriter {
    root: PathBuf,
    set: StressSet,
    specs: Vec<ArraySpec>,
    /// The rows of the scalars and profiles, each for every stored instant.
    rows: Vec<Vec<Vec<f64>>>,
}

impl StressWriter {
    /// Starts the arrays in the result of `writer`.
    pub fn new(writer: &Writer, set: &StressSet) -> StressWriter {
        let Document { header, form, progress, .. } = &writer.document;
        let specs = set.arrays(header, progress.maps);
        let specs: Vec<ArraySpec> = specs.into_iter().map(|spec| spec.of_form(*form)).collect();
        let unknown = |spec: &ArraySpec| vec![f64::NAN; spec.shape()[1..].iter().product()];
        let rows = rows_of(&specs).map(|spec| vec![unknown(spec); progress.maps]).collect();
        StressWriter { root: writer.path().to_owned(), set: set.clone(), specs, rows }
    }

    /// Writes a field of the instant of number `map` at the depth of number `depth`; one that is not stored is left out.
    ///
    /// # Errors
    /// [`super::StoreError::Io`] where the system refuses.
    pub fn field(
        &self,
        quantity: StressQuantity,
        map: usize,
        depth: usize,
        field: ArrayView2<'_, f64>,
    ) -> Result<()> {
        match self.specs.iter().find(|spec| spec.name() == quantity.field_name()) {
            Some(spec) => Chunks::new(&self.root, spec).write_map(&[map as u64, depth as u64], field),
            None => Ok(()),
        }
    }

    /// Sets the numbers of an instant: those of [`StressSet::scalars`] and [`StressSet::profiles`], in their order.
    pub fn instant(&mut self, map: usize, scalars: &[f64], profiles: &[Vec<f64>]) {
        let rows = scalars.iter().map(|number| vec![*number]).chain(profiles.iter().cloned());
        self.rows.iter_mut().zip(rows).for_each(|(array, row)| array[map] = row);
    }

    /// Writes all numbers; returns the checksums of the per-step arrays.
    fn finish(&self) -> Result<Sums> {
        let mut sums = Sums::new();
        for spec in self.specs.iter().filter(|spec| spec.storage == Storage::Whole) {
            Chunks::new(&self.root, spec).write_whole(&self.set.depths)?;
        }
        for (spec, rows) in rows_of(&self.specs).zip(&self.rows) {
            let mut column = Column::new(&self.root, spec, 0, &Sums::new());
            rows.iter().enumerate().try_for_each(|(map, row)| column.put(map, row))?;
            column.sum(rows.len(), &mut sums);
        }
        Ok(sums)
    }
}

/// The arrays of the scalars and profiles.
fn rows_of(specs: &[ArraySpec]) -> impl Iterator<Item = &ArraySpec> {
    specs.iter().filter(|spec| spec.storage == Storage::Rows)
}

impl Writer {
    /// Opens a finished or stopped result, to add to it.
    ///
    /// # Errors
    /// As [`Reader::open`]; [`super::StoreError::Busy`] where another process is writing it.
    pub fn amend(path: &Path) -> Result<Writer> {
        Reader::open(path)?;
        let held = lock(path)?;
        // Once more: what wrote it until now has changed it.
        let reader = Reader::open(path)?;
        let last = reader.series("time")?.last().copied().unwrap_or(f64::NEG_INFINITY);
        Writer::attach(path, reader.into_document(), held, last)
    }

    /// Takes the stress out of the result.
    ///
    /// # Errors
    /// [`super::StoreError::Io`] where the system refuses.
    pub fn remove_stress(&mut self) -> Result<()> {
        self.set_stress(None, Sums::new())?;
        clear(self.path())
    }

    /// Brings the stress that `store` wrote into the result.
    ///
    /// # Errors
    /// [`super::StoreError::Io`] where the system refuses.
    pub fn add_stress(&mut self, store: StressWriter) -> Result<()> {
        let sums = store.finish()?;
        self.set_stress(Some(store.set), sums)
    }
}

/// Removes all arrays of the stress. No reader sees an array that no document names.
pub(super) fn clear(root: &Path) -> Result<()> {
    names().try_for_each(|name| remove(&root.join(name)))
}

impl Reader {
    /// The stress below the surface that was computed; `None` if it was not.
    pub fn stress(&self) -> Option<&StressSet> {
        self.document().stress.as_ref()
    }

    /// A number of each stored instant, by its name in [`StressSet::scalars`]; NaN where it was not computed.
    ///
    /// # Errors
    /// [`super::StoreError::Missing`] where there is none of that name, [`super::StoreError::Corrupt`] where a file is damaged.
    pub fn stress_series(&self, name: &str) -> Result<Vec<f64>> {
        let known = self.stress().map(StressSet::scalars).unwrap_or_default();
        self.stress_column(name, &known)
    }

    /// A number of each stored instant and depth, by its name in [`StressSet::profiles`], shape (instants, depths).
    ///
    /// # Errors
    /// As [`stress_series`](Self::stress_series).
    pub fn stress_profile(&self, name: &str) -> Result<Array2<f64>> {
        let known = self.stress().map(StressSet::profiles).unwrap_or_default();
        let numbers = self.stress_column(name, &known)?;
        let depths = self.stress().map_or(1, |set| set.depths.len());
        let shape = (numbers.len() / depths, depths);
        Array2::from_shape_vec(shape, numbers).map_err(|error| corrupt(&self.path().join(name), error))
    }

    fn stress_column(&self, name: &str, known: &[Series]) -> Result<Vec<f64>> {
        if !known.iter().any(|series| series.name == name) {
            let names = known.iter().map(|series| series.name);
            return Err(self.missing(format!("`{name}`"), holds(names, COMPUTES)));
        }
        self.numbers(name)
    }

    /// A stress field \[Pa\] of a stored instant at the depth of number `depth`, shape of the grid; NaN where it was not computed.
    ///
    /// # Errors
    /// As [`stress_series`](Self::stress_series).
    pub fn stress_field(&self, quantity: StressQuantity, at: At, depth: usize) -> Result<Array2<f64>> {
        let index = self.index(at)?;
        let set = self.stress().filter(|set| set.quantities.contains(&quantity) && depth < set.depths.len());
        let Some(set) = set else {
            let instead = match self.stress() {
                None => COMPUTES.to_owned(),
                Some(set) if set.quantities.is_empty() => "it holds no fields of the stress".to_owned(),
                Some(set) => {
                    let names: Vec<_> = set.quantities.iter().map(|quantity| quantity.name()).collect();
                    format!("it holds the stress fields {} at {} depths", names.join(", "), set.depths.len())
                }
            };
            return Err(
                self.missing(format!("stress field `{}` of depth number {depth}", quantity.name()), instead)
            );
        };
        if !set.instants.contains(&index) {
            return Ok(Array2::from_elem(self.header().grid.shape(), f64::NAN));
        }
        self.map(quantity.field_name(), &[index as u64, depth as u64])
    }
}
