//! What a program gives in place of a case file: keys and values, and beside them arrays that the keys name.
//!
//! A surface of `kind = "array"` and the key `hardness_array` of a body name an array. Numbers without a unit are SI, and keep every
//! bit.

use std::collections::BTreeMap;
use std::path::Path;

use asperity::load::Stage;
use asperity::surface::Part;
use asperity::time::{Instant, Plan};
use asperity::{Control, Grid, Simulation};
use ndarray::Array2;
use toml::Table;

use super::document::{self, Document};
use super::error::CaseError;
use super::history::Bodies;
use super::load::Load;
use super::material::Dependence;
use super::place::Checks;
use super::shift::{Shift, dependence};
use super::surface::Surface;
use super::text::Text;
use super::{Case, CaseErrors, Pair, assemble};
use crate::Code;
use crate::curve::{ShiftRequest, VerticalRequest};

/// Arrays of shape (nx, ny) by their names.
pub type Arrays = BTreeMap<String, Array2<f64>>;

impl Case {
    /// The case of these keys and arrays; relative paths begin at `dir`.
    ///
    /// ```
    /// use asperity_io::case::{Arrays, Case};
    ///
    /// let keys = toml::toml! {
    ///     domain = { cells = [2, 2], size = [1e-3, 1e-3] }
    ///     surface = [{ kind = "array", array = "heights" }]
    ///     body = [{ poisson = 0.5, material = { model = "elastic", young = 1e6 } }]
    ///     load = { control = "load", history = { kind = "step", value = 1e-3 } }
    ///     time = { times = [1.0] }
    /// };
    /// let arrays = Arrays::from([("heights".to_owned(), ndarray::arr2(&[[0.0, 1e-6], [0.0, 0.0]]))]);
    /// let case = Case::given(&keys, &arrays, ".".as_ref())?;
    /// assert_eq!(case.gap()?, ndarray::arr2(&[[1e-6, 0.0], [1e-6, 1e-6]]));
    ///
    /// let errors = Case::given(&keys, &Arrays::new(), ".".as_ref()).unwrap_err();
    /// assert_eq!(errors.errors[0].key, "surface[0].array");
    /// # Ok::<(), asperity_io::case::CaseErrors>(())
    /// ```
    ///
    /// # Errors
    /// [`CaseErrors`] with what is wrong; their lines are those of [`CaseErrors::source`].
    pub fn given(keys: &Table, arrays: &Arrays, dir: &Path) -> Result<Case, CaseErrors> {
        from_keys(keys, arrays, |text| {
            let document = Document::read(text)?;
            assemble::case(text, &document, dir, "result.zarr".into())
        })
    }
}

/// The bodies of the keys `body` and, where it is given, `temperature`; fractional models are Prony sums over `window` \[s\].
///
/// # Errors
/// [`CaseErrors`] with what is wrong.
pub fn bodies(keys: &Table, window: Option<[f64; 2]>) -> Result<Pair, CaseErrors> {
    let instant = |[dt, time]: [f64; 2]| Instant {
        time,
        dt,
        value: 0.0,
        jump: false,
        control: Control::Load,
        stage: 0,
    };
    let plan = Plan { instants: window.into_iter().map(instant).collect(), exact: true };
    from_keys(keys, &Arrays::new(), |text| {
        let (bodies, temperature) = document::bodies(text)?;
        assemble::bodies(text, &bodies, temperature.as_ref(), &plan)
    })
}

/// The grid of the key `domain`, and the part of the gap that is the one `surface`; not one of a file.
///
/// # Errors
/// [`CaseErrors`] with what is wrong.
pub fn surface(keys: &Table) -> Result<(Grid, Part, bool), CaseErrors> {
    from_keys(keys, &Arrays::new(), |text| {
        let (domain, surfaces) = document::roughness(text)?;
        let checks = Checks::new(text, Path::new(""));
        let grid = domain.grid(&checks.at("domain"), &[]);
        let line = grid.as_ref().is_some_and(Grid::is_line);
        let place = checks.at("surface").item(0);
        let surface = surfaces.first();
        let part = surface.and_then(|surface| surface.part(&place, grid.as_ref(), line));
        let made = grid.zip(part).map(|(grid, part)| (grid, part, surface.is_some_and(Surface::is_single)));
        checks.finish(made)
    })
}

/// The stage of these keys, prescribed between two rows of this simulation.
///
/// # Errors
/// [`CaseErrors`] with what is wrong.
pub fn prescribed(keys: Table, simulation: &Simulation) -> Result<Stage, CaseErrors> {
    let adhere = simulation.traction.as_ref().is_some_and(|law| law.as_adhesion().is_some());
    let bodies = Bodies { line: simulation.grid.is_line(), adhere };
    let load = Table::from_iter([("stages".to_owned(), toml::Value::Array(vec![keys.into()]))]);
    let keys = Table::from_iter([("load".to_owned(), load.into())]);
    from_keys(&keys, &Arrays::new(), |text| {
        let load: Load = document::section(text, "load")?;
        let checks = Checks::new(text, Path::new(""));
        let made = load.programme(&checks.at("load"), bodies, &|_, _| 0.0);
        let stage = made.and_then(|mut programme| programme.stages.pop());
        checks.finish(stage)
    })
}

/// The shift of these keys of a material's `shift`, and how moduli depend on temperature.
///
/// # Errors
/// [`CaseErrors`] with what is wrong.
pub fn shift(keys: Table) -> Result<(ShiftRequest, VerticalRequest), CaseErrors> {
    let keys = Table::from_iter([("shift".to_owned(), keys.into())]);
    from_keys(&keys, &Arrays::new(), |text| {
        let shift: Shift = document::section(text, "shift")?;
        let checks = Checks::new(text, Path::new(""));
        // The shift is the only key of its document.
        let found = dependence(&checks.root(), Some(&shift), None);
        checks.finish(found.map(|Dependence { shift, vertical }| (shift, vertical)))
    })
}

/// What `make` makes of these keys as a text.
pub(super) fn from_keys<T>(
    keys: &Table,
    arrays: &Arrays,
    make: impl FnOnce(&Text<'_>) -> Result<T, Vec<CaseError>>,
) -> Result<T, CaseErrors> {
    let name = "case";
    let source = toml::to_string(keys).map_err(|error| {
        CaseErrors::without_place(Code::Data, name, error.to_string(), "keys and values of a case file", None)
    })?;
    let made = Text::parse(&source).and_then(|text| make(&Text { arrays: Some(arrays), ..text }));
    made.map_err(|errors| CaseErrors { name: name.to_owned(), source, errors })
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity::{Event, TimeGrid};
    use ndarray::arr2;

    fn keys() -> Table {
        toml::toml! {
            domain = { cells = [2, 2], size = [1e-3, 1e-3] }
            surface = [{ kind = "array", array = "heights" }]
            body = [{ poisson = 0.5, material = { model = "zener", shear = 1e6, shear_kelvin = 1e6, retardation_time = 0.1 } }]
            load = { control = "load", history = { kind = "step", value = 1e-3 } }
            time = { end = 1.0, steps = 2 }
        }
    }

    fn heights() -> Arrays {
        Arrays::from([("heights".to_owned(), arr2(&[[0.0, f64::NEG_INFINITY], [-1e-6, 0.0]]))])
    }

    fn fault(keys: &Table, arrays: &Arrays) -> (String, String) {
        let error = Case::given(keys, arrays, Path::new("")).unwrap_err().errors.remove(0);
        (error.key, error.message)
    }

    #[test]
    fn numbers_keep_every_bit_and_cells_may_never_touch() {
        let odd = f64::from_bits(0x3f50_6249_1234_5679);
        let mut keys = keys();
        keys["load"]["history"]["value"] = odd.into();
        let case = Case::given(&keys, &heights(), Path::new("")).unwrap();
        assert_eq!(case.conditions.loading.stages[0].course.resolve(0.0).after(0.0).to_bits(), odd.to_bits());
        assert_eq!(case.gap().unwrap(), arr2(&[[0.0, f64::INFINITY], [1e-6, 0.0]]));
    }

    #[test]
    fn a_hardness_for_each_cell_is_checked() {
        let mut keys = keys();
        keys["body"][0].as_table_mut().unwrap().insert("hardness_array".into(), "hard".into());
        let with = |map| {
            let mut arrays = heights();
            arrays.insert("hard".into(), map);
            arrays
        };
        let case = Case::given(&keys, &with(arr2(&[[1e6, 2e6], [3e6, 4e6]])), Path::new("")).unwrap();
        assert_eq!(case.conditions.hardness_map.unwrap()[[1, 0]], 3e6);
        let (key, message) = fault(&keys, &with(arr2(&[[1e6, 0.0], [3e6, 4e6]])));
        assert_eq!(key, "body[0].hardness_array");
        assert!(message.contains("(0, 1)"), "{message}");
        let (key, message) = fault(&keys, &with(arr2(&[[1e6]])));
        assert_eq!(key, "body[0].hardness_array");
        assert!(message.contains("(1, 1)"), "{message}");
    }

    #[test]
    fn a_stage_takes_all_that_times_may_be() {
        let mut keys = keys();
        keys["load"] = toml::toml! {
            stages = [{ control = "load", history = { kind = "step", value = 1e-3 }, until = { approach = 1e-6 }, duration = 5.0,
                        time = { times = [0.1, 0.7] } }]
        }
        .into();
        let case = Case::given(&keys, &heights(), Path::new("")).unwrap();
        let stage = &case.conditions.loading.stages[0];
        assert_eq!(stage.times, Some(TimeGrid::List(vec![0.1, 0.7])));
        assert_eq!(stage.until, Some(Event::Approach(1e-6)));
        keys["load"]["stages"][0].as_table_mut().unwrap().insert("steps".into(), 3.into());
        assert_eq!(fault(&keys, &heights()).0, "load.stages[0].time");
    }

    #[test]
    fn bodies_surfaces_and_shifts_stand_alone() {
        let fractional = toml::toml! {
            body = [{ poisson = 0.5, material = { model = "springpot", shear = 1e6, time = 1.0, order = 0.3 } }]
        };
        let made = bodies(&fractional, Some([1e-2, 1e3])).unwrap();
        assert_eq!(made.reports[0].window, Some([1e-2, 1e3]));
        assert!(made.reports[0].error.is_some_and(|error| error < 1e-3));
        let wrong = toml::toml! { body = [{ poisson = 0.7, material = { model = "elastic", young = 1e6 } }] };
        assert_eq!(bodies(&wrong, None).err().unwrap().errors[0].key, "body[0].poisson");
        let shape = toml::toml! {
            domain = { cells = [4], size = [1e-3] }
            surface = [{ kind = "cylinder", radius = 1e-2 }]
        };
        assert!(surface(&shape).unwrap().0.is_line());
        let shift = self::shift(toml::toml! { model = "wlf"
        c1 = 8.86
        c2 = 101.6
        reference = 293.15 });
        assert!(matches!(shift, Ok((ShiftRequest::Given(_), VerticalRequest::None))));
    }
}
