//! Materials that are fitted to measured curves.

use asperity::material::{FitOptions, LongTime, Moduli, Modulus};

use super::{Dependence, Model};
use crate::case::keys::*;
use crate::curve::{self, Columns, Curves, Kind, Request, Role, VerticalWord};

/// A column of a text table: its number, from 1, or its header with or without the unit.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
#[serde(expecting = "the number of a column, from 1, or its header in quotes")]
pub enum Column {
    /// From 1.
    Number(u32),
    /// With or without the unit.
    Header(String),
}

impl Column {
    pub fn choice(&self) -> curve::Column {
        match self {
            Column::Number(n) => curve::Column::Number(usize::try_from(*n).unwrap_or(usize::MAX)),
            Column::Header(header) => curve::Column::Name(header.clone()),
        }
    }
}

/// A law that is fitted to a table of measured points: the key of what it measures, the path, and the columns, each with its
/// role, an example of a column and one of a unit.
macro_rules! table {
    (
        $(#[$doc:meta])*
        $law:ident: $kind:ident, $columns:ident, $units:ident;
        $(#[$measure_doc:meta])*
        measure $measure:ident;
        $(#[$path_doc:meta])*
        path $file:literal;
        examples { columns: $columns_example:tt, units: $units_example:tt }
        $($(#[$attribute:meta])* $key:ident: $role:ident, $column:literal, $unit:literal;)*
    ) => {
        $(#[$doc])*
        #[derive(Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $law {
            $(#[$measure_doc])*
            $measure: asperity::material::Modulus,
            $(#[$path_doc])*
            #[schemars(example = $file)]
            path: String,
            /// The sheet of a spreadsheet (.xls, .xlsx); the first one that names such columns if not given.
            #[schemars(example = "Exported Data")]
            sheet: Option<String>,
            /// Which of several steps or sweeps below each other to read, from 1; all of them, as one, if not given.
            #[schemars(example = 1)]
            segment: Option<Whole<1>>,
            /// The column of each quantity, by number from 1 or by header; taken from the header if not given.
            #[schemars(example = serde_json::json!($columns_example))]
            columns: Option<$columns>,
            /// Units of the columns, if the header does not name them or names wrong ones.
            #[schemars(example = serde_json::json!($units_example))]
            units: Option<$units>,
            /// How the series is fitted.
            #[schemars(example = serde_json::json!({ "max_terms": 12 }))]
            fit: Option<super::measured::Fit>,
        }

        /// The column of each quantity, by number from 1 or by header.
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        struct $columns {
            $($(#[$attribute])* #[schemars(example = $column)] $key: Option<super::measured::Column>,)*
        }

        /// Units of the columns.
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        struct $units {
            $($(#[$attribute])* #[schemars(example = &$unit)] $key: Option<String>,)*
        }

        impl super::Law for $law {
            fn is_measured(&self) -> bool {
                true
            }

            fn fit(&self) -> Option<&super::measured::Fit> {
                self.fit.as_ref()
            }

            fn model(&self, at: &Place<'_>, dependence: super::Dependence) -> Option<super::Model> {
                use crate::curve::{Columns, Kind, Role};
                let (sheet, segment) = (self.sheet.clone(), self.segment.map(Whole::count));
                let mut columns = Columns { sheet, segment, ..Columns::default() };
                $(
                    if let Some(column) = self.columns.as_ref().and_then(|columns| columns.$key.as_ref()) {
                        columns.columns.insert(Role::$role, column.choice());
                    }
                    if let Some(unit) = self.units.as_ref().and_then(|units| units.$key.as_ref()) {
                        columns.units.insert(Role::$role, unit.clone());
                    }
                )*
                let path = &self.path;
                let source = super::measured::Source { kind: Kind::$kind, measure: self.$measure, path, columns };
                source.model(at, self.fit.as_ref(), dependence)
            }
        }
    };
}
pub(super) use table;

/// How a series is fitted to a curve.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fit {
    /// Which moduli of a dma are fitted; "both" if not given. Measured ones often contradict each other; then "storage" is
    /// usual.
    moduli: Option<Moduli>,
    /// Weight of a residual of the loss modulus over one of the storage modulus; 1 if not given.
    #[schemars(example = 0.3)]
    loss_weight: Option<Number<Positive>>,
    /// Rms misfit that is held by as few terms as possible; the data justify the number of terms if not given.
    #[schemars(example = 0.02)]
    misfit: Option<Number<Share>>,
    /// Largest number of terms; as many as the data justify if not given.
    #[schemars(example = 12)]
    max_terms: Option<Whole<1>>,
    /// Times per decade at the start of the fit; 3 if not given.
    #[schemars(example = 3)]
    per_decade: Option<Number<Density>>,
    /// Decades of times beyond the data on either side; 1 if not given.
    #[schemars(example = 1)]
    margin: Option<Number<Decades>>,
    /// Largest relative misfit, over neighbouring points, before the data are refused; 0.1 if not given.
    #[schemars(example = 0.1)]
    max_misfit: Option<Number<Share>>,
    /// Behaviour at times longer than the data; "free" if not given.
    long_time: Option<LongTime>,
    /// How the moduli of sweeps at several temperatures depend on temperature, in addition to their times; they do not if not given. It
    /// may stand in `shift` as well.
    pub vertical: Option<VerticalWord>,
    /// The part of the curve that is fitted: two times or, for a dma, two frequencies (after the shift, if there
    /// are several temperatures); all of it if not given.
    #[schemars(example = ("0.1 s", "1000 s"))]
    window: Option<Two<Prescribed>>,
}

/// A file of measured curves.
pub struct Source<'a> {
    pub kind: Kind,
    pub measure: Modulus,
    pub path: &'a str,
    pub columns: Columns,
}

impl Source<'_> {
    /// The fit to the file.
    pub fn model(self, at: &Place<'_>, fit: Option<&Fit>, dependence: Dependence) -> Option<Model> {
        let named = |role| self.columns.columns.contains_key(&role);
        if named(Role::Loss) && named(Role::TanDelta) {
            let message = "`loss` and `tan_delta` exclude each other";
            return at.key("columns").fault(message, "one of the two", "leave one of them out");
        }
        let path = at.key("path");
        let file = path.file(self.path)?;
        let (options, window) = match fit {
            Some(fit) => (fit.options(), fit.window(&at.key("fit").key("window"), self.kind)?),
            None => (FitOptions::default(), None),
        };
        let Dependence { shift, vertical } = dependence;
        let request = Request { measure: self.measure, shift, vertical, window, options };
        let curves = Curves::read(&file, self.kind, &self.columns);
        let fitted = curves.and_then(|curves| Ok((request.fit(&curves)?, curves.digest)));
        let expected = format!("a table of a {} measurement", self.kind.name());
        let (fitted, digest) = path.data(fitted, &expected)?;
        path.note_file(self.path, digest);
        Some(Model::Fitted { fitted: Box::new(fitted), file: self.path.to_owned() })
    }
}

impl Fit {
    fn options(&self) -> FitOptions {
        let default = FitOptions::default();
        FitOptions {
            per_decade: self.per_decade.map_or(default.per_decade, Number::get),
            margin: self.margin.map_or(default.margin, Number::get),
            limit: self.max_misfit.map_or(default.limit, Number::get),
            max_terms: self.max_terms.map_or(default.max_terms, Whole::count),
            long_time: self.long_time.unwrap_or_default(),
            misfit: self.misfit.map(Number::get),
            moduli: self.moduli.unwrap_or_default(),
            loss_weight: self.loss_weight.map_or(default.loss_weight, Number::get),
        }
    }

    /// The window in s or rad/s; the outer `None` is a fault.
    fn window(&self, at: &Place<'_>, kind: Kind) -> Option<Option<[f64; 2]>> {
        let Some(Two(first, last)) = &self.window else { return Some(None) };
        let abscissa = |value: &Prescribed| -> Result<f64, QuantityError> {
            match (kind, value) {
                (Kind::Dma, Prescribed::Number(hertz)) => curve::angular_frequency(&format!("{hertz} Hz")),
                (Kind::Dma, Prescribed::Text(text)) => curve::angular_frequency(text),
                (_, value) => value.resolve::<dimension::Time, Positive>().map(|time| time.get()),
            }
        };
        let ends = [at.item(0).quantity(abscissa(first)), at.item(1).quantity(abscissa(last))];
        let [first, last] = [ends[0]?, ends[1]?];
        if last <= first {
            return at.item(1).wrong("greater than the first end of the window", "");
        }
        Some(Some([first, last]))
    }
}
