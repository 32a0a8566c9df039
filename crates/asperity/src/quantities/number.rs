//! A number of a row that a stage can wait for ([`Event::Number`](crate::load::Event::Number)).

use super::{Quantity, ROW_COLUMNS, RowColumn, RowFigure};
use crate::grid::Grid;

/// A single number of a row, by its name in results.
#[derive(Clone, Copy, Debug)]
pub enum RowNumber {
    /// One that every row has.
    Column(&'static RowColumn),
    /// A quantity.
    Quantity(Quantity),
}

impl RowNumber {
    /// All that a stage can wait for: what an attempt at a step determines. Energies are sums over the rows that stand, the error of
    /// friction is the largest of several rows, tangential tractions are solved once a row stands, and the work of the solver says nothing of the contact.
    pub fn all() -> impl Iterator<Item = RowNumber> {
        let of_contact = |column: &&RowColumn| {
            !matches!(column.panel_on(false), Some((RowFigure::Work, _)))
                && !["time", "stage"].contains(&column.name)
        };
        let is_known = |quantity: &Quantity| {
            let of_rows = [Quantity::FrictionUncertainty, Quantity::DissipatedPower].contains(quantity);
            !(quantity.is_histogram() || quantity.is_energy() || quantity.is_tangential() || of_rows)
        };
        let columns = ROW_COLUMNS.iter().filter(of_contact).map(RowNumber::Column);
        columns.chain(Quantity::ALL.into_iter().filter(is_known).map(RowNumber::Quantity))
    }

    /// The number with this name.
    pub fn from_name(name: &str) -> Option<RowNumber> {
        RowNumber::all().find(|number| number.name() == name)
    }

    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            RowNumber::Column(column) => column.name,
            RowNumber::Quantity(quantity) => quantity.name(),
        }
    }

    /// Its unit in the plane; "1" if it has none.
    pub fn units(self) -> &'static str {
        match self {
            RowNumber::Column(column) => column.units,
            RowNumber::Quantity(quantity) => quantity.units(),
        }
    }

    /// Its unit on this grid; "1" if it has none.
    pub fn units_on(self, grid: &Grid) -> &'static str {
        match self {
            RowNumber::Column(column) => grid.units(column.units),
            RowNumber::Quantity(quantity) => quantity.units_on(grid),
        }
    }

    /// The values that it can have in any state of this grid, from the lowest to the highest; `heaviest` is the largest load that the
    /// hardness allows \[N\], `hardest` the largest pressure \[Pa\], `pulls` whether a traction acts on the surfaces besides.
    pub(crate) fn range(self, grid: &Grid, heaviest: f64, hardest: f64, pulls: bool) -> [f64; 2] {
        const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
        let lowest = if pulls { f64::NEG_INFINITY } else { 0.0 };
        match (self, self.units()) {
            (RowNumber::Quantity(quantity), _)
                if quantity.is_of_motion() || quantity.is_of_time() || quantity.is_of_flash() =>
            {
                ANY
            }
            (RowNumber::Quantity(quantity), _) if !quantity.states().is_empty() => {
                [0.0, (quantity.states().len() - 1) as f64]
            }
            (RowNumber::Quantity(Quantity::ContactSpots), _) => [0.0, grid.len() as f64],
            // Absolute, and no pressure of the contact.
            (RowNumber::Quantity(Quantity::InletPressure), _) => [0.0, f64::INFINITY],
            (_, "N") => [lowest, heaviest],
            (_, "Pa") if self.name() == "mean_pressure" => [lowest, heaviest / grid.area()],
            (_, "Pa") => [lowest, hardest],
            (_, "m2") if self.name() == "capped_area" && hardest == f64::INFINITY => [0.0, 0.0],
            // Areas in contact.
            (_, "m2") => [0.0, grid.area()],
            (RowNumber::Column(_), "1") => [0.0, 1.0],
            // Lengths of the contact; the approach and the mean gap may have either sign.
            (RowNumber::Quantity(_), "m") => [0.0, f64::INFINITY],
            _ => ANY,
        }
    }

    /// Its description.
    pub fn long_name(self) -> &'static str {
        match self {
            RowNumber::Column(column) => column.long_name,
            RowNumber::Quantity(quantity) => quantity.long_name(),
        }
    }
}

impl PartialEq for RowNumber {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}
