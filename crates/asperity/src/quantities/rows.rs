//! The numbers that every row has, each once: name, unit, words, and the panel of figures that shows it.

use super::Panel;
use crate::step::Row;

/// A number that every row has.
#[derive(Clone, Copy, Debug)]
pub struct RowColumn {
    /// Its name in results.
    pub name: &'static str,
    /// Its unit; "1" if it has none.
    pub units: &'static str,
    /// Its description for axes and legends.
    pub long_name: &'static str,
    /// The field of a row that holds it.
    pub entry: Entry,
    /// Its description on a line of cells.
    line_name: &'static str,
    figure: Option<(RowFigure, Panel)>,
    line_panel: Option<Panel>,
    needs_value: bool,
}

/// The field of a row that holds a number.
#[derive(Clone, Copy, Debug)]
pub enum Entry {
    /// The coordinate, on the axis that the row already has.
    Coordinate,
    /// A number.
    Real(fn(&mut Row) -> &mut f64),
    /// A whole number.
    Count(fn(&mut Row) -> &mut usize),
    /// A number that not every row has: NaN if the row has none.
    Maybe(fn(&mut Row) -> &mut Option<f64>),
}

/// The figure that shows numbers of every row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowFigure {
    /// The figure of the evolution of the contact; the number orders its panels.
    Evolution(u8),
    /// The work of the solver.
    Work,
    /// The figure of the quantities; the number joins the quantity with the same panel.
    Quantities,
}

impl RowColumn {
    const fn new(name: &'static str, units: &'static str, long_name: &'static str, entry: Entry) -> Self {
        let (figure, line_panel) = (None, None);
        RowColumn {
            name,
            units,
            long_name,
            entry,
            line_name: long_name,
            figure,
            line_panel,
            needs_value: false,
        }
    }

    /// Shown in a panel: title, label of the axis, name in the legend.
    const fn shown(self, figure: RowFigure, [title, label, legend]: [&'static str; 3]) -> Self {
        let panel = Panel { title, label, legend };
        RowColumn { figure: Some((figure, panel)), line_panel: Some(panel), ..self }
    }

    /// Has another description on a line of cells.
    const fn on_line(self, line_name: &'static str) -> Self {
        RowColumn { line_name, ..self }
    }

    /// Has another description and another panel on a line of cells, or no panel there.
    const fn on_line_shown(self, line_name: &'static str, panel: Option<[&'static str; 3]>) -> Self {
        let line_panel = match panel {
            Some([title, label, legend]) => Some(Panel { title, label, legend }),
            None => None,
        };
        RowColumn { line_name, line_panel, ..self }
    }

    /// Shown only if it is greater than 0 in some row.
    const fn where_positive(self) -> Self {
        RowColumn { needs_value: true, ..self }
    }

    /// Its description, on a line of cells or in the plane.
    pub fn long_name_on(&self, line: bool) -> &'static str {
        if line { self.line_name } else { self.long_name }
    }

    /// The figure that shows it, and its panel there.
    pub fn panel_on(&self, line: bool) -> Option<(RowFigure, Panel)> {
        let (figure, panel) = self.figure?;
        Some((figure, if line { self.line_panel? } else { panel }))
    }

    /// Whether figures omit it if it is 0 in all rows.
    pub fn is_shown_where_positive(&self) -> bool {
        self.needs_value
    }

    /// Its number in a row; NaN if the row has none.
    pub fn of(&self, row: &Row) -> f64 {
        let mut row = *row;
        match self.entry {
            Entry::Coordinate => row.coordinate.value(),
            Entry::Real(entry) => *entry(&mut row),
            Entry::Maybe(entry) => entry(&mut row).unwrap_or(f64::NAN),
            Entry::Count(entry) => *entry(&mut row) as f64,
        }
    }

    /// Sets it in a row that already has the right axis.
    pub fn set(&self, row: &mut Row, value: f64) {
        match self.entry {
            Entry::Coordinate => row.coordinate = row.coordinate.axis().at(value),
            Entry::Real(entry) => *entry(row) = value,
            Entry::Maybe(entry) => *entry(row) = Some(value).filter(|number| !number.is_nan()),
            Entry::Count(entry) => *entry(row) = value as usize,
        }
    }

    /// Whether it is a whole number.
    pub fn is_count(&self) -> bool {
        matches!(self.entry, Entry::Count(_))
    }
}

macro_rules! columns {
    ($($kind:ident $name:ident [$units:literal] $long_name:literal $(.$how:ident($($word:expr),*))*;)*) => {
        [RowColumn::new("time", "s", "time", Entry::Coordinate), $(
            RowColumn::new(stringify!($name), $units, $long_name, Entry::$kind(|row| &mut row.$name))
                $(.$how($($word),*))*
        ),*]
    };
}

use RowFigure::{Evolution, Quantities, Work};

/// The numbers that every row has, the coordinate first.
pub const ROW_COLUMNS: [RowColumn; 16] = columns![
    Real load ["N"] "normal load"
        .shown(Evolution(2), ["Load", "load", ""])
        .on_line("normal load per length along y");
    Real approach ["m"] "rigid-body approach"
        .shown(Evolution(1), ["Approach", "approach", ""]);
    Real contact_area ["m2"] "contact area"
        .shown(Evolution(0), ["Contact area", "contact area", "counted"])
        .on_line_shown("contact length", Some(["Contact length", "contact length", ""]));
    Real contact_area_corrected ["m2"] "contact area corrected by its perimeter"
        .shown(Evolution(0), ["Contact area", "contact area", "corrected"])
        .on_line_shown("contact length (without correction on a line)", None);
    Real contact_fraction ["1"] "contact area over nominal area"
        .on_line("contact length over length of the domain");
    Real capped_area ["m2"] "area at the hardness"
        .shown(Evolution(0), ["Contact area", "contact area", "at the hardness"])
        .on_line_shown("length at the hardness", Some(["Contact length", "contact length", "at the hardness"]))
        .where_positive();
    Real mean_pressure ["Pa"] "load over nominal area"
        .shown(Evolution(3), ["Pressure", "pressure", "nominal mean"])
        .on_line("load over length of the domain");
    Real max_pressure ["Pa"] "largest pressure"
        .shown(Evolution(3), ["Pressure", "pressure", "largest"]);
    Real mean_gap ["m"] "mean gap"
        .shown(Quantities, ["Gap", "gap", "mean"]);
    Count iterations ["1"] "iterations of the solver"
        .shown(Work, ["Work of each row", "number", "iterations"]);
    Count convolutions ["1"] "convolutions"
        .shown(Work, ["Work of each row", "number", "convolutions"]);
    Real residual ["1"] "KKT residual"
        .shown(Work, ["Error of each row", "relative error", "contact conditions (residual)"]);
    Real certificate ["1"] "certified relative error in the energy norm"
        .shown(Work, ["Error of each row", "relative error", "pressure (certificate)"]);
    Maybe time_error ["1"] "estimated error of the stress because of the time steps, relative"
        .shown(Work, ["Error of each row", "relative error", "stress (time steps)"]);
    Count stage ["1"] "stage of the load";
];
