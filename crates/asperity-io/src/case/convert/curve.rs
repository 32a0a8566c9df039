//! Materials that are fitted to measured curves.

use asperity::material::{FitOptions, Modulus};

use super::Checks;
use crate::case::quantity::range::Positive;
use crate::case::quantity::{Prescribed, QuantityError, dimension};
use crate::case::raw::{self, At, Two};
use crate::curve::{self, Columns, Curves, Fitted, Kind, Request, Role, ShiftRequest, VerticalRequest};

/// A fit and its file.
pub struct Fit {
    pub fitted: Fitted,
    pub file: String,
    /// MD5 of the file.
    pub digest: String,
}

/// The columns and units that a material states: `said!(columns, units, sheet; key = Role, ...)`.
macro_rules! said {
    ($m:ident; $($key:ident = $role:ident),* $(,)?) => {{
        let (columns, units) = ($m.columns.as_ref().map(|at| &at.value), $m.units.as_ref().map(|at| &at.value));
        let mut said = Columns { sheet: $m.sheet.clone(), ..Columns::default() };
        $(
            if let Some(choice) = columns.and_then(|c| c.$key.as_ref()) {
                said.columns.insert(Role::$role, column(choice));
            }
            if let Some(unit) = units.and_then(|u| u.$key.as_ref()) {
                said.units.insert(Role::$role, unit.clone());
            }
        )*
        said
    }};
}

pub fn relaxation(
    checks: &mut Checks<'_, '_>,
    m: &raw::RelaxationTable,
    shift: ShiftRequest,
    vertical: VerticalRequest,
) -> Option<Fit> {
    let said = said!(m; time = Time, modulus = Modulus, temperature = Temperature, set = Set);
    fit(checks, Kind::Relaxation, m.modulus, &m.path, &said, m.fit.as_ref(), (shift, vertical))
}

pub fn creep(
    checks: &mut Checks<'_, '_>,
    m: &raw::CreepTable,
    shift: ShiftRequest,
    vertical: VerticalRequest,
) -> Option<Fit> {
    let said = said!(m; time = Time, compliance = Compliance, temperature = Temperature, set = Set);
    fit(checks, Kind::Creep, m.compliance, &m.path, &said, m.fit.as_ref(), (shift, vertical))
}

pub fn dma(
    checks: &mut Checks<'_, '_>,
    m: &raw::Dma,
    shift: ShiftRequest,
    vertical: VerticalRequest,
) -> Option<Fit> {
    let columns = m.columns.as_ref().map(|at| &at.value);
    if let (Some(at), Some(_), Some(_)) =
        (&m.columns, columns.and_then(|c| c.loss.as_ref()), columns.and_then(|c| c.tan_delta.as_ref()))
    {
        let message = "has `loss` and `tan_delta`, but needs only one of them".to_owned();
        checks.fault(&at.span, message, "one of the two", Some("leave one of them out"));
        return None;
    }
    let said = said!(
        m;
        frequency = Frequency,
        storage = Storage,
        loss = Loss,
        tan_delta = TanDelta,
        phase = Phase,
        complex_modulus = ComplexModulus,
        storage_compliance = StorageCompliance,
        loss_compliance = LossCompliance,
        complex_viscosity = ComplexViscosity,
        real_viscosity = RealViscosity,
        imaginary_viscosity = ImaginaryViscosity,
        temperature = Temperature,
        set = Set,
    );
    fit(checks, Kind::Dma, m.modulus, &m.path, &said, m.fit.as_ref(), (shift, vertical))
}

fn column(column: &raw::Column) -> curve::Column {
    match column {
        raw::Column::Number(n) => curve::Column::Number(usize::try_from(*n).unwrap_or(usize::MAX)),
        raw::Column::Header(header) => curve::Column::Name(header.clone()),
    }
}

fn fit(
    checks: &mut Checks<'_, '_>,
    kind: Kind,
    measure: Modulus,
    path: &At<String>,
    columns: &Columns,
    raw: Option<&At<raw::Fit>>,
    (shift, vertical): (ShiftRequest, VerticalRequest),
) -> Option<Fit> {
    let file = checks.file(path)?;
    let (options, window) = match raw {
        Some(at) => (options(&at.value), window(checks, kind, &at.value)?),
        None => (FitOptions::default(), None),
    };
    let request = Request { measure, shift, vertical, window, options };
    let curves = Curves::read(&file, kind, columns);
    let fitted = curves.and_then(|curves| Ok((request.fit(&curves)?, curves.digest)));
    match fitted {
        Ok((fitted, digest)) => Some(Fit { fitted, file: path.value.clone(), digest }),
        Err(error) => {
            let expected = format!("a table of a {} measurement", kind.name());
            checks.fault(&path.span, error.to_string(), &expected, None);
            None
        }
    }
}

fn options(raw: &raw::Fit) -> FitOptions {
    let default = FitOptions::default();
    FitOptions {
        per_decade: raw.per_decade.map_or(default.per_decade, |v| v.get()),
        margin: raw.margin.map_or(default.margin, |v| v.get()),
        limit: raw.max_misfit.map_or(default.limit, |v| v.get()),
        max_terms: raw.max_terms.map_or(default.max_terms, |n| n.count()),
        long_time: raw.long_time.unwrap_or_default(),
        misfit: raw.misfit.map(|v| v.get()),
        moduli: raw.moduli.unwrap_or_default(),
        loss_weight: raw.loss_weight.map_or(default.loss_weight, |v| v.get()),
    }
}

/// The window in s or rad/s; the outer `None` is a fault.
fn window(checks: &mut Checks<'_, '_>, kind: Kind, raw: &raw::Fit) -> Option<Option<[f64; 2]>> {
    let Some(Two(first, last)) = &raw.window else { return Some(None) };
    let abscissa = |value: &Prescribed| -> Result<f64, QuantityError> {
        match (kind, value) {
            (Kind::Dma, Prescribed::Number(hertz)) => curve::angular_frequency(&format!("{hertz} Hz")),
            (Kind::Dma, Prescribed::Text(text)) => curve::angular_frequency(text),
            (_, value) => value.resolve::<dimension::Time, Positive>().map(|time| time.get()),
        }
    };
    let ends = [first, last].map(|at| checks.quantity(at, abscissa(&at.value)));
    let [first_si, last_si] = [ends[0]?, ends[1]?];
    if last_si <= first_si {
        checks.wrong(&last.span, "greater than the first end of the window", None);
        return None;
    }
    Some(Some([first_si, last_si]))
}
