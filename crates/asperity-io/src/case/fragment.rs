//! Parts of a case outside of a case file: the words of a command line, read and checked as the case file's keys.

use std::path::Path;

use asperity::Grid;
use asperity::surface::Part;
use toml::{Table, Value};

use super::document;
use super::error::{CaseError, CaseErrors};
use super::given::{self, Arrays};
use super::place::Checks;
use super::schema;
use super::stress::Stress;
use super::surface::Kind;
use crate::preparation::Step;
use crate::stress::{StressBody, StressPlan};

/// The key that a step takes without its name: `level=plane` is `level form=plane`.
const FIRST_KEYS: [(&str, &str); 9] = [
    ("level", "form"),
    ("fill", "method"),
    ("crop", "cells"),
    ("resample", "method"),
    ("flip", "axis"),
    ("rotate", "quarter_turns"),
    ("window", "shape"),
    ("border", "method"),
    ("outliers", "threshold"),
];

/// Keys of the steps with a value along x and one along y.
const PAIRS: [&str; 4] = ["cells", "size", "from", "corner"];

/// A step of a preparation from words: its name and its keys as in `process` of a case file.
///
/// ```
/// use asperity::surface::{Level, Operation};
/// use asperity_io::case::fragment::step;
/// use asperity_io::preparation::{Crop, Step};
///
/// assert_eq!(step("level=quadratic"), Ok(Step::Operation(Operation::Level(Level::Quadratic))));
/// let crop = step("crop size=50um,40um corner=0m,10um");
/// let size = [50e-6, 40e-6];
/// assert_eq!(crop, Ok(Step::Crop(Crop::Lengths { size, corner: Some([0.0, 10e-6]) })));
/// assert_eq!(step("crop size=50um"), step("crop size=50um,50um"));
/// assert!(step("level=plain").unwrap_err().contains("did you mean \"plane\"?"));
/// assert!(step("outlier=6").unwrap_err().contains("did you mean \"outliers\"?"));
/// ```
///
/// # Errors
/// A sentence: no such step, a key that it does not have, or a value that the key does not take.
pub fn step(words: &str) -> Result<Step, String> {
    let words = words.trim();
    let end = words.find(|c: char| c.is_whitespace() || c == '=').unwrap_or(words.len());
    let (name, rest) = words.split_at(end);
    let rest = match (rest.strip_prefix('='), FIRST_KEYS.iter().find(|(step, _)| *step == name)) {
        (Some(value), Some((_, key))) => format!("{key}={value}"),
        (Some(_), None) if schema::choices("surface[0].process[0].op").iter().any(|known| known == name) => {
            return Err(format!("\"{words}\": write the keys of {name} by name, KEY=VALUE"));
        }
        // What is wrong with the name comes first.
        (Some(_), None) => String::new(),
        (None, _) => rest.to_owned(),
    };
    // One value is that of a square; along a profile only the first counts.
    let of_square = |(key, value): (String, Value)| match value {
        value if value.is_array() || !PAIRS.contains(&key.as_str()) => (key, value),
        one => (key, Value::Array(vec![one.clone(), one])),
    };
    let mut operation: Table = keys(&rest)?.into_iter().map(of_square).collect();
    operation.insert("op".into(), name.into());
    let mut surface = Table::from_iter([("kind".into(), "file".into()), ("path".into(), "".into())]);
    surface.insert("process".into(), Value::Array(vec![operation.into()]));
    let document = Table::from_iter([("surface".into(), Value::Array(vec![surface.into()]))]);

    let place = "surface[0].process[0]";
    let read = given::from_keys(&document, &Arrays::new(), |text| {
        let surfaces = document::surfaces(text)?;
        let checks = Checks::new(text, Path::new(""));
        let process = surfaces.iter().find_map(|surface| match &surface.kind {
            Kind::File(file) => file.process.as_ref()?.first(),
            _ => None,
        });
        checks.finish(process.and_then(|operation| operation.step(&checks.at(place))))
    });
    read.map_err(|wrong| {
        let Some(CaseError { message, help, .. }) = wrong.errors.into_iter().next() else {
            return words.into();
        };
        let message = message.replace(&format!("{place}."), "").replace(&format!("{place}: "), "");
        let help = help.map_or_else(String::new, |help| format!("; {help}"));
        format!("\"{words}\": {}{help}", message.replace(place, name))
    })
}

/// "KEY=VALUE KEY=VALUE"; a word without "=" belongs to the value before it ("size=50 um").
fn keys(text: &str) -> Result<Vec<(String, Value)>, String> {
    let mut keys: Vec<(String, String)> = Vec::new();
    for word in text.split_whitespace() {
        match (word.split_once('='), keys.last_mut()) {
            (Some((key, value)), _) => keys.push((key.to_owned(), value.to_owned())),
            (None, Some((_, value))) => {
                value.push(' ');
                value.push_str(word);
            }
            (None, None) => return Err(format!("\"{word}\" has no \"=\"; write KEY=VALUE")),
        }
    }
    Ok(keys.into_iter().map(|(key, text)| (key, value(&text))).collect())
}

/// A value as a case file writes it: a number, true, false, a list if there are commas, otherwise text.
pub(super) fn value(text: &str) -> Value {
    let text = text.trim().trim_start_matches('[').trim_end_matches(']');
    if text.contains(',') {
        return Value::Array(text.split(',').map(value).collect());
    }
    let text = text.trim().trim_matches(['"', '\'']);
    if let Ok(whole) = text.parse::<i64>() {
        return Value::Integer(whole);
    }
    match text {
        "true" => Value::Boolean(true),
        "false" => Value::Boolean(false),
        _ => text.parse::<f64>().map_or_else(|_| Value::String(text.to_owned()), Value::Float),
    }
}

/// Synthetic roughness from words: the keys of `[domain]` (`cells`, `size`) and of `kind = "self-affine"`, with
/// `lay.angle`, `lay.ratio`, `distribution.skewness` and so on for those inside tables.
///
/// ```
/// use asperity_io::case::fragment::roughness;
///
/// let keys = [("cells", "64"), ("size", "1 mm,1 mm"), ("hurst", "0.8"), ("rms_height", "1 um"),
///     ("longest", "0.5 mm"), ("shortest", "0.1 mm"), ("seed", "1")];
/// let (grid, _part) = roughness(&keys).unwrap();
/// assert_eq!((grid.cells(), grid.size()), ([64, 64], [1e-3, 1e-3]));
///
/// let faults = roughness(&keys[..6]).unwrap_err();
/// assert_eq!(faults[0].key, "seed");
/// ```
///
/// # Errors
/// What is wrong with each key, missing ones included.
pub fn roughness(keys: &[(&str, &str)]) -> Result<(Grid, Part), Vec<CaseError>> {
    let mut domain = Table::new();
    let mut surface = Table::from_iter([("kind".into(), "self-affine".into())]);
    for (key, text) in keys {
        let given = value(text);
        match key.split_once('.') {
            None if ["cells", "size"].contains(key) => {
                // One number for a square.
                let both = if given.is_array() { given } else { Value::Array(vec![given.clone(), given]) };
                domain.insert((*key).to_owned(), both);
            }
            None => drop(surface.insert((*key).to_owned(), given)),
            Some((table, inner)) => {
                let table = surface.entry(table.to_owned()).or_insert_with(|| Table::new().into());
                table.as_table_mut().map(|table| table.insert(inner.to_owned(), given));
            }
        }
    }
    let surfaces = Value::Array(vec![surface.into()]);
    let document = Table::from_iter([("domain".into(), domain.into()), ("surface".into(), surfaces)]);
    given::surface(&document).map(|(grid, part, _)| (grid, part)).map_err(bare)
}

/// The stress below the surface from words: the keys of `[stress]` but `times`, for a body among these.
///
/// ```
/// use asperity::Grid;
/// use asperity_io::case::fragment::stress;
/// use asperity_io::stress::{Depths, StressBody};
///
/// let grid = Grid::new([64, 64], [1e-3, 1e-3]).unwrap();
/// let bodies = [StressBody { name: "PMMA".into(), poisson: Some(0.38.into()) }];
/// let plan = stress(&[("depths", "0,50 um"), ("yield_stress", "110 MPa")], &grid, &bodies).unwrap();
/// assert_eq!(plan.depths, Depths::List(vec![0.0, 50e-6]));
/// assert_eq!(stress(&[("depths", "1 um")], &grid, &bodies).unwrap_err()[0].key, "depths[0]");
/// ```
///
/// # Errors
/// What is wrong with each key.
pub fn stress(
    keys: &[(&str, &str)],
    grid: &Grid,
    bodies: &[StressBody],
) -> Result<StressPlan, Vec<CaseError>> {
    let value = |(key, text): &(&str, &str)| {
        let given = value(text);
        let is_list = given.is_array() || *text == "auto" || !["depths", "components"].contains(key);
        ((*key).to_owned(), if is_list { given } else { Value::Array(vec![given]) })
    };
    let table: Table = keys.iter().map(value).collect();
    let document = Table::from_iter([("stress".into(), table.into())]);
    let read = given::from_keys(&document, &Arrays::new(), |text| {
        let section: Stress = document::section(text, "stress")?;
        let checks = Checks::new(text, Path::new(""));
        checks.finish(section.plan(&checks.at("stress"), grid, bodies))
    });
    read.map_err(bare)
}

/// The errors with keys and messages that do not name the tables of a case, and without advice for a case file.
fn bare(errors: CaseErrors) -> Vec<CaseError> {
    let bare = |text: &str| {
        let inside = ["surface[0].", "domain.", "surface[0]", "stress."];
        inside.iter().fold(text.to_owned(), |text, table| text.replace(table, ""))
    };
    let fault = |error: CaseError| {
        let message = bare(error.message.strip_prefix(&error.key).unwrap_or(&error.message));
        CaseError {
            key: bare(&error.key),
            message: message.trim_start_matches([':', ' ']).to_owned(),
            // "add hurst = 0.8" is advice for a case file.
            help: error.help.filter(|help| !help.starts_with("add ")),
            ..error
        }
    };
    errors.errors.into_iter().map(fault).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity::surface::process::{Axis, Band, Edge, Outliers, Resampling, Window};
    use asperity::surface::{Fill, Operation};

    #[test]
    fn every_step_has_its_words() {
        let operation = |words: &str| match step(words).unwrap_or_else(|e| panic!("{words}: {e}")) {
            Step::Operation(operation) => operation,
            other => panic!("{words}: {other:?}"),
        };
        assert_eq!(
            operation("fill=nearest share=0.5"),
            Operation::Fill { method: Fill::Nearest, largest_share: 0.5 }
        );
        let band = Band { longest: Some(80e-6), shortest: Some(2.5e-6), edge: Edge::Gaussian };
        let words = "filter longest=80 um shortest=\"2.5 um\" edge=gaussian";
        assert_eq!(operation(words), Operation::Filter(band));
        assert_eq!(operation("flip=y"), Operation::Flip(Axis::Y));
        assert_eq!(operation("rotate"), Operation::Rotate { quarter_turns: 1 });
        assert_eq!(operation("rotate=-1"), Operation::Rotate { quarter_turns: -1 });
        assert_eq!(operation("invert"), Operation::Invert);
        assert_eq!(operation("window=tukey share=0.2"), Operation::Window(Window::Tukey { share: 0.2 }));
        assert_eq!(operation("border=mirror"), Operation::Mirror);
        let outliers = Outliers { threshold: 5.0, radius: 3 };
        assert_eq!(operation("outliers=5 radius=3"), Operation::RemoveOutliers(outliers));
        assert_eq!(
            step("resample=bilinear cells=64,32"),
            Ok(Step::Resample { cells: Some([64, 32]), method: Resampling::Bilinear })
        );
    }

    #[test]
    fn a_slip_in_a_step_is_told_with_what_to_do() {
        for (words, told) in [
            ("", "op is \"\""),
            ("lvel=plane", "lvel"),
            ("lvel", "did you mean \"level\"?"),
            ("fill=harmonic shar=0.3", "did you mean `share`?"),
            ("fill share=2", "at most 1"),
            ("crop", "needs `cells` or `size` or `defined`"),
            ("crop cells=5,5 size=1um,1um", "only one of them"),
            ("crop cells=0,5", "1 or more"),
            ("crop corner=0,0 cells=5,5", "belongs to `size`"),
            ("crop size=5,5 V", "a length"),
            ("filter", "needs `longest` or `shortest`"),
            ("filter longest=1um shortest=2um", "exchange"),
            ("filter longest=1um,2um", "a length"),
            ("flip", "axis is missing"),
            ("rotate=0.5", "a whole number"),
            ("window=hann share=0.3", "Tukey"),
            ("border", "method is missing"),
            ("border=window", "\"mirror\""),
            ("level plane", "KEY=VALUE"),
        ] {
            let error = step(words).unwrap_err();
            assert!(error.contains(told), "{words}: {error}");
            assert!(!error.contains("surface["), "{words}: {error}");
        }
    }

    #[test]
    fn a_slip_in_a_roughness_is_told_by_its_key() {
        let good = [
            ("cells", "64,32"),
            ("size", "2 mm,1 mm"),
            ("hurst", "0.8"),
            ("rms_gradient", "0.1"),
            ("longest", "0.5 mm"),
            ("shortest", "0.1 mm"),
            ("lay.ratio", "3"),
            ("lay.angle", "20 deg"),
            ("distribution.skewness", "-0.5"),
            ("seed", "1"),
        ];
        assert!(matches!(roughness(&good), Ok((_, Part::Synthesis(_)))));
        for (key, text, told) in [
            ("hurst", "2", "at most 1"),
            ("shortest", "1 um", "two cells"),
            ("longest", "1 m", "size of the domain"),
            ("lay.ratio", "0.5", "1 or more"),
            ("lay.angle", "20 mm", "deg"),
            ("distribution.kurtosis", "1", "well above"),
            ("distribution.path", "nowhere.sdf", "skewness"),
            ("seed", "-1", "0 or more"),
            ("cells", "100000,1000000", "this machine has"),
            ("preset", "challenge", "contact-mechanics-challenge"),
            ("rms_height", "1 um", "only one of them"),
        ] {
            let mut keys: Vec<_> = good.iter().copied().filter(|k| k.0 != key).collect();
            keys.push((key, text));
            let told_as = format!("{:?}", roughness(&keys).unwrap_err());
            assert!(told_as.contains(told), "{key} = {text}: {told_as}");
        }
    }

    #[test]
    fn the_challenge_is_a_preset_whose_keys_can_be_set() {
        let keys =
            [("preset", "contact-mechanics-challenge"), ("cells", "256"), ("size", "0.1 mm"), ("seed", "1")];
        let told = roughness(&keys).unwrap_err();
        assert!(told[0].message.contains("two cells"), "{told:?}");
        let mut coarser = keys.to_vec();
        coarser.push(("shortest", "1 um"));
        let (_, part) = roughness(&coarser).unwrap();
        let Part::SelfAffine(roughness) = part else { panic!("{part:?}") };
        assert_eq!((roughness.hurst, roughness.roll_off, roughness.shortest), (0.8, 2e-5, 1e-6));
    }
}
