//! A number of a row that a stage can wait for ([`Event::Number`](crate::load::Event::Number)).

use super::{Quantity, ROW_COLUMNS, RowColumn, RowFigure};

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
    /// friction is the largest of several rows, and the work of the solver says nothing of the contact.
    pub fn all() -> impl Iterator<Item = RowNumber> {
        let of_contact = |column: &&RowColumn| {
            !matches!(column.panel_on(false), Some((RowFigure::Work, _)))
                && !["time", "stage"].contains(&column.name)
        };
        let is_known = |quantity: &Quantity| {
            let of_rows = [Quantity::FrictionUncertainty, Quantity::DissipatedPower].contains(quantity);
            !(quantity.is_histogram() || quantity.is_energy() || of_rows)
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
