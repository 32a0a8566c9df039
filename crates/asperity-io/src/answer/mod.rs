//! The answers of a result: the few numbers that a contact, a seal, a sweep over velocities or a test is computed for.
//!
//! | result | answers |
//! |---|---|
//! | with leakage | `leak_rate` (of a gas also `leak_rate_standard`), `hydraulic_gap`, `tight_from` |
//! | with a fluid that acts on the surfaces | `fluid_load`, `time_opened` where it opens the contact, `closing_pressure` where that closes as the inlet falls, `lift_off_pressure` on a periodic domain under a load; on request `opening_pressure`, `leak_rate_one_way` |
//! | with adhesion | `pull_off_force`, `pull_off_approach` |
//! | with wear | `wear_life` where a depth is given, `wear_volume`, `counterbody_wear_volume`, `wear_depth_max` |
//! | with flash temperature | `flash_temperature_max`, `flash_temperature_mean` |
//! | with a load along the surfaces | `loop_energy` of the last loop, `tangential_stiffness`, `largest_tangential_force`, `largest_tangential_displacement`, `slip_share`, `slip_work` |
//! | in motion | `friction_coefficient` (of a sweep the largest, with `velocity_of_largest_friction` and the value at each of a few velocities), `friction_force`, with friction of the surfaces also `friction_force_total` |
//! | with a sine | `loss_angle`, `dissipated_energy`, `dynamic_stiffness` of the last cycle |
//! | every contact | `contact_area`, `contact_area_corrected`, `contact_fraction`, `max_pressure`, `approach` and `creep` where the load is given, `load` and `relaxation` where the approach is |
//! | under a sine, with `plastic_volume` | `flattening_per_cycle` |
//! | with stress | `max_mises`, `max_mises_depth`, `first_yield_load` |
//!
//! They are those of the last row; if nothing touches there, of the row with the largest load, of surfaces that adhere with the largest approach; of a sweep, of the velocity with the largest
//! friction. Summaries, comparisons, reports, error bars and studies all read them here, with what the findings of the result say of them
//! ([`Validity`]).

mod adhesion;
mod contact;
mod extreme;
mod flash;
mod fluid;
mod leak;
mod motion;
mod stress;
mod tangential;
mod units;
mod validity;
mod wear;

use asperity::quantities::Quantity;
use asperity::step::Row;
use asperity::{Axis, Coordinate};
use serde::Serialize;

use crate::cycles;
use crate::store::{Reader, Result};

pub use units::{MBAR_LITRE, UnitError, Units};
pub use validity::Validity;
pub use wear::course as wear_course;

/// A number that a result was made for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    /// Its name: that of a column of the result where it is one.
    pub name: String,
    /// Its value, SI; NaN (in JSON null) where there is none.
    pub value: f64,
    /// Its SI unit; "1" if it has none.
    pub unit: &'static str,
    /// The row that it belongs to.
    #[serde(skip)]
    pub at: Option<Coordinate>,
    /// What the findings of the result say of it.
    #[serde(flatten)]
    pub validity: Validity,
    /// What a reader must know besides, in a few words.
    #[serde(skip)]
    pub note: String,
    /// How much of it the cells leave open, as the run itself knows: whole cells at the edge of the contact, two ways to compute a force;
    /// SI, 0 where nothing is known.
    #[serde(skip)]
    pub of_cells: f64,
    /// How much of it the rows leave open: their distance in time or velocity, the lines between them; SI, 0 where they do not limit it,
    /// infinite where it has no value for ever shorter steps.
    #[serde(skip)]
    pub of_rows: f64,
}

/// A contact has shaken down where a cycle flattens less than this share of what the first one did.
const SHAKEN_DOWN: f64 = 1e-6;
/// Loads that differ by less than this share are equal.
const SAME: f64 = 1e-6;

/// Numbers without a unit that are shown in percent.
const SHARES: [&str; 3] = ["contact_fraction", "relaxation", "slip_share"];

impl Answer {
    pub(crate) fn new(name: impl Into<String>, value: f64, unit: &'static str) -> Answer {
        let (name, note, validity) = (name.into(), String::new(), Validity::Holds);
        Answer { name, value, unit, at: None, validity, note, of_cells: 0.0, of_rows: 0.0 }
    }

    fn at(self, row: &Row) -> Answer {
        Answer { at: Some(row.coordinate), ..self }
    }

    fn of_rows(self, error: f64) -> Answer {
        Answer { of_rows: error, ..self }
    }

    fn with_note(self, note: impl Into<String>) -> Answer {
        Answer { note: note.into(), ..self }
    }

    /// Its name for people: "contact area", on a line "contact length".
    pub fn label(&self) -> String {
        match (self.name.as_str(), self.unit) {
            ("contact_area", "m") => "contact length".into(),
            (name, _) => {
                name.replace('_', " ").replace("pull off", "pull-off").replace("lift off", "lift-off")
            }
        }
    }

    /// Whether it is a share, which is shown in percent.
    pub fn is_share(&self) -> bool {
        SHARES.contains(&self.name.as_str())
    }

    /// Its value with a unit that suits it.
    pub fn words(&self, units: &Units) -> String {
        units.words(self, self.value)
    }
}

/// The answers of a result, the most important first; none without a row.
///
/// # Errors
/// [`StoreError`](crate::store::StoreError) where the result is damaged.
pub fn of(reader: &Reader, units: &Units) -> Result<Vec<Answer>> {
    let rows = reader.rows()?;
    let Some(decisive) = decisive(reader, &rows)? else { return Ok(vec![]) };
    let mut answers = leak::of(reader, units)?;
    answers.extend(fluid::of(reader, &rows, decisive, units)?);
    answers.extend(adhesion::of(reader, &rows));
    answers.extend(wear::of(reader, &rows)?);
    answers.extend(tangential::of(reader, &rows)?);
    answers.extend(motion::of(reader, &rows, decisive)?);
    answers.extend(flash::of(reader, &rows)?);
    answers.extend(last_cycle(reader)?);
    answers.extend(contact::of(reader, &rows, decisive)?);
    answers.extend(stress::of(reader)?);
    validity::mark(&mut answers, reader.findings(), &rows, leak::last_row(reader)?);
    Ok(answers)
}

/// The row that the answers belong to.
fn decisive(reader: &Reader, rows: &[Row]) -> Result<Option<usize>> {
    let Some(last) = rows.len().checked_sub(1) else { return Ok(None) };
    let largest = |values: &[f64]| (0..values.len()).reduce(|a, b| if values[b] > values[a] { b } else { a });
    if reader.header().axis() == Axis::Velocity {
        return Ok(largest(&motion::coefficients(reader)?));
    }
    if rows[last].contact_fraction > 0.0 {
        return Ok(Some(last));
    }
    // Of equal ones the last: rounding must not choose. Where surfaces adhere, the load may be tensile throughout.
    let value = |row: &Row| if reader.header().adhesion().is_some() { row.approach } else { row.load };
    let touching = || rows.iter().filter(|row| row.contact_fraction > 0.0).map(value);
    let most = touching().fold(f64::NEG_INFINITY, f64::max);
    let peak =
        rows.iter().rposition(|row| row.contact_fraction > 0.0 && value(row) >= most - SAME * most.abs());
    Ok(peak.or(Some(last)))
}

/// Loss angle, loss and stiffness of the last full cycle of a sine.
fn last_cycle(reader: &Reader) -> Result<Vec<Answer>> {
    // What wears away is no loss of the material.
    let stages = if reader.header().wears() { vec![] } else { cycles::of_result(reader)? };
    let Some((part, cycle)) = stages.iter().rev().find_map(|part| Some((part, part.cycles.last()?))) else {
        return Ok(vec![]);
    };
    let grid = &reader.header().grid;
    let at = format!("cycle {} at {} Hz", part.cycles.len(), part.frequency);
    let flattened = flattening_per_cycle(reader, part)?;
    Ok([
        Answer::new("loss_angle", cycle.loss_angle, "rad"),
        Answer::new("dissipated_energy", cycle.dissipated_energy, grid.units("J")),
        Answer::new("dynamic_stiffness", cycle.stiffness, grid.units("N/m")),
    ]
    .map(|answer| answer.with_note(at.clone()))
    .into_iter()
    .chain(flattened)
    .collect())
}

/// What the last cycle of a sine has flattened for good, where the rows say it, and how that compares with the first.
fn flattening_per_cycle(reader: &Reader, part: &cycles::Cyclic) -> Result<Option<Answer>> {
    let Ok(volume) = reader.series(Quantity::PlasticVolume.name()) else { return Ok(None) };
    let times = reader.series("time")?;
    let at = |cycle: usize| {
        let time = part.start + cycle as f64 / part.frequency;
        volume[times.partition_point(|row| *row <= time * (1.0 + 1e-9)).saturating_sub(1)]
    };
    let grows = |cycle: usize| at(cycle + 1) - at(cycle);
    let count = part.cycles.len();
    let (first, last) = (grows(0), grows(count - 1));
    let note = match count {
        1 => "of the first cycle".to_owned(),
        _ if first <= 0.0 => format!("of cycle {count}; the first one flattens nothing"),
        _ if last <= SHAKEN_DOWN * first => format!("of cycle {count}: the contact has shaken down"),
        _ => format!("of cycle {count}, {:.1} % of that of the first", 100.0 * last / first),
    };
    let unit = reader.header().grid.units("m3");
    Ok(Some(Answer::new("flattening_per_cycle", last, unit).with_note(note)))
}
