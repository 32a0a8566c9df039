//! The parts of the undeformed gap.

use asperity::Grid;
use asperity::surface::{
    HeightDistribution, Lay, Level, Part, Punch, Roughness, SelfAffine, Shape, Synthesis, level,
};

use super::{Checks, axes, prepare};
use crate::case::given::of_grid;
use crate::case::measured::Measured;
use crate::case::plan::Surface;
use crate::case::quantity::range::Positive;
use crate::case::quantity::unit::Unit;
use crate::case::quantity::{Dimension, Length, dimension};
use crate::case::raw::{self, At};
use crate::case::words;
use crate::topography::{ReadOptions, read};

/// The measured surfaces at their places among all of them; `Some(None)` where its keys are wrong.
pub fn files(checks: &mut Checks<'_, '_>, surfaces: &[At<raw::Surface>]) -> Vec<Option<Option<Measured>>> {
    let file = |surface: &At<raw::Surface>| match &surface.value {
        raw::Surface::File(file) => Some(measured(checks, file)),
        _ => None,
    };
    surfaces.iter().map(file).collect()
}

pub fn surfaces(
    checks: &mut Checks<'_, '_>,
    surfaces: &[At<raw::Surface>],
    files: &[Option<Option<Measured>>],
    grid: Option<&Grid>,
    line: bool,
) -> Option<Vec<Surface>> {
    // All of them are looked at, also after one that is wrong.
    let parts: Vec<_> = surfaces
        .iter()
        .zip(files)
        .map(|(surface, file)| match file {
            Some(file) => file.clone().map(Surface::File),
            None => part(checks, surface, grid, line),
        })
        .collect();
    parts.into_iter().collect()
}

fn part(
    checks: &mut Checks<'_, '_>,
    surface: &At<raw::Surface>,
    grid: Option<&Grid>,
    line: bool,
) -> Option<Surface> {
    if line {
        on_a_line(checks, surface)?;
    }
    let (shape, center) = match &surface.value {
        raw::Surface::Sphere(sphere) => (Shape::Sphere { radius: sphere.radius.get() }, &sphere.center),
        raw::Surface::Ellipsoid(ellipsoid) => {
            let [radius_x, radius_y] = [ellipsoid.radius_x.get(), ellipsoid.radius_y.get()];
            (Shape::Ellipsoid { radius_x, radius_y }, &ellipsoid.center)
        }
        raw::Surface::Cylinder(cylinder) => {
            (Shape::Cylinder { radius: cylinder.radius.get() }, &cylinder.center)
        }
        raw::Surface::Wedge(wedge) => (Shape::Wedge { slope: wedge.slope.get() }, &wedge.center),
        raw::Surface::Cone(cone) => (Shape::Cone { slope: cone.slope.get() }, &cone.center),
        raw::Surface::FlatPunch(punch) => {
            let keys = [("radius", punch.value.radius.is_some()), ("size", punch.value.size.is_some())];
            checks.exactly_one(&punch.span, &keys)?;
            let outline = match (punch.value.radius, &punch.value.size) {
                (Some(radius), _) => Punch::Circle { radius: radius.get() },
                (_, Some(at)) => {
                    let size = axes::values(checks, at, line, f64::INFINITY, |length| length.get())?;
                    Punch::Rectangle { size }
                }
                (None, None) => return None,
            };
            (Shape::FlatPunch(outline), &punch.value.center)
        }
        raw::Surface::Wave(wave) => {
            let wavelength =
                axes::values(checks, &wave.wavelength, line, f64::INFINITY, |length| length.get())?;
            (Shape::Wave { amplitude: wave.amplitude.get(), wavelength }, &wave.center)
        }
        raw::Surface::SelfAffine(roughness) => return self_affine(checks, roughness, grid),
        raw::Surface::File(_) => return None, // see `files`
        raw::Surface::Array(array) => return given(checks, &array.array, grid?),
    };
    checks.core(&surface.span, shape.validate())?;
    let center = match center {
        None => [0.0, 0.0],
        Some(at) => axes::values(checks, at, line, 0.0, |length| length.get())?,
    };
    Some(Surface::Part(Part::Shape { shape, center }))
}

/// Heights given beside the case.
fn given(checks: &mut Checks<'_, '_>, name: &At<String>, grid: &Grid) -> Option<Surface> {
    match of_grid(checks.text.arrays, &name.value, grid) {
        Ok(heights) => {
            let heights = heights.as_standard_layout().into_owned();
            Some(Surface::Part(Part::Heights { name: name.value.clone(), heights }))
        }
        Err((message, expected)) => {
            checks.fault(&name.span, message, &expected, None);
            None
        }
    }
}

/// Refuses shapes that no line contact has.
fn on_a_line(checks: &mut Checks<'_, '_>, surface: &At<raw::Surface>) -> Option<()> {
    let (name, instead) = match &surface.value {
        raw::Surface::Sphere(_) => ("a sphere", "cylinder"),
        raw::Surface::Ellipsoid(_) => ("an ellipsoid", "cylinder"),
        raw::Surface::Cone(_) => ("a cone", "wedge"),
        raw::Surface::SelfAffine(at) => {
            let Some(lay) = &at.value.lay else { return Some(()) };
            let message = "a profile has no lay: the domain is a line of cells".to_owned();
            checks.fault(&lay.span, message, "roughness without a lay", Some("leave `lay` out"));
            return None;
        }
        _ => return Some(()),
    };
    let message = format!("{name} is not straight along y, but the domain is a line of cells");
    let help = format!("use kind = \"{instead}\", or give domain.cells and domain.size two values");
    checks.fault(
        &surface.span,
        message,
        "a cylinder, wedge, flat punch, wave, roughness or profile",
        Some(&help),
    );
    None
}

/// Synthetic roughness; checked against the grid where there is one.
pub fn self_affine(
    checks: &mut Checks<'_, '_>,
    roughness: &At<raw::SelfAffine>,
    grid: Option<&Grid>,
) -> Option<Surface> {
    let raw = &roughness.value;
    let preset = raw.preset.map(|raw::Preset::ContactMechanicsChallenge| {
        SelfAffine::contact_mechanics_challenge(raw.seed.get())
    });
    let keys = [("rms_gradient", raw.rms_gradient.is_some()), ("rms_height", raw.rms_height.is_some())];
    let given = match (raw.rms_gradient, raw.rms_height, preset) {
        (None, None, Some(preset)) => preset.roughness,
        (gradient, height, _) => {
            checks.exactly_one(&roughness.span, &keys)?;
            match (gradient, height) {
                (Some(gradient), _) => Roughness::RmsGradient(gradient.get()),
                (_, Some(height)) => Roughness::RmsHeight(height.get()),
                (None, None) => return None,
            }
        }
    };
    let mut needed = |key: &str, value: Option<f64>| {
        if value.is_none() {
            checks.push(|text| words::missing_key(text, &roughness.span, key));
        }
        value
    };
    let length = |at: &Option<At<Length<Positive>>>| at.as_ref().map(|at| at.value.get());
    let hurst = needed("hurst", raw.hurst.map(|h| h.get()).or(preset.map(|p| p.hurst)));
    let longest = needed("longest", length(&raw.longest).or(preset.map(|p| p.longest)));
    let shortest = needed("shortest", length(&raw.shortest).or(preset.map(|p| p.shortest)));
    let (hurst, longest, shortest) = (hurst?, longest?, shortest?);
    // The preset's roll-off where the band still holds it.
    let roll_off = preset.map_or(longest, |preset| preset.roll_off.clamp(shortest.min(longest), longest));
    let spectrum = SelfAffine {
        hurst,
        roughness: given,
        longest,
        shortest,
        roll_off: length(&raw.roll_off).unwrap_or(roll_off),
        seed: raw.seed.get(),
    };
    if let Some(grid) = grid {
        let result = spectrum.validate(grid);
        // The solver names the wavelength that does not fit.
        let place = match &result {
            Err(asperity::Error::Invalid { what, .. }) if what.starts_with("longest") => raw.longest.as_ref(),
            Err(asperity::Error::Invalid { what, .. }) if what.starts_with("shortest") => {
                raw.shortest.as_ref()
            }
            Err(asperity::Error::Invalid { what, .. }) if what.starts_with("roll-off") => {
                raw.roll_off.as_ref()
            }
            _ => None,
        }
        .map_or(&roughness.span, |at| &at.span);
        checks.core(place, result)?;
    }
    if raw.lay.is_none() && raw.distribution.is_none() {
        return Some(Surface::Part(Part::SelfAffine(spectrum)));
    }
    let lay = raw.lay.as_ref().map(|at| Lay {
        angle: at.value.angle.map_or(0.0, |angle| angle.get()),
        ratio: at.value.ratio.get(),
    });
    let distribution = match &raw.distribution {
        None => HeightDistribution::Gaussian,
        Some(at) => distribution(checks, at)?,
    };
    let synthesis = Synthesis { spectrum, lay, distribution };
    if let Err(error) = synthesis.validate() {
        let of_lay = error.to_string().contains("lay");
        let place = if of_lay { raw.lay.as_ref().map(|at| &at.span) } else { None };
        let place = place.or(raw.distribution.as_ref().map(|at| &at.span)).unwrap_or(&roughness.span).clone();
        checks.core::<()>(&place, Err(error))?;
    }
    Some(Surface::Part(Part::Synthesis(synthesis)))
}

fn distribution(checks: &mut Checks<'_, '_>, at: &At<raw::Distribution>) -> Option<HeightDistribution> {
    let raw = &at.value;
    match (&raw.path, raw.skewness, raw.kurtosis) {
        (None, None, None) => {
            let help = "skewness and kurtosis set it, or path names a measured surface that has it";
            checks.fault(&at.span, "says nothing".into(), "skewness, kurtosis or path", Some(help));
            None
        }
        (None, skewness, kurtosis) => Some(HeightDistribution::Moments {
            skewness: skewness.map_or(0.0, |value| value.get()),
            kurtosis: kurtosis.map_or(3.0, |value| value.get()),
        }),
        (Some(path), None, None) => {
            let full = checks.file(path)?;
            // Mean and rms come from the roughness: neither unit nor size matters.
            let options =
                ReadOptions { size: Some([1.0, 1.0]), height_unit: Some(1.0), ..ReadOptions::default() };
            let told = |reason: String| (reason, "a surface with heights");
            let heights =
                read(&full, &options).map_err(|error| told(error.to_string())).and_then(|surface| {
                    level(surface.heights.view(), Level::Plane).map_err(|error| told(error.to_string()))
                });
            match heights {
                Ok(heights) => {
                    let defined = heights.iter().copied().filter(|z| z.is_finite()).collect();
                    Some(HeightDistribution::Samples(defined))
                }
                Err((reason, expected)) => {
                    checks.fault(&path.span, reason, expected, None);
                    None
                }
            }
        }
        (Some(_), ..) => {
            let help = "leave path out, or skewness and kurtosis";
            let message = "`path` cannot be combined with skewness or kurtosis".into();
            checks.fault(&at.span, message, "one of them", Some(help));
            None
        }
    }
}

fn measured(checks: &mut Checks<'_, '_>, file: &raw::File) -> Option<Measured> {
    let path = checks.file(&file.path);
    let unit = match &file.height_unit {
        None => Some(None),
        Some(unit) => height_unit(checks, unit).map(Some),
    };
    let steps = prepare::steps(checks, file);
    let options = ReadOptions {
        size: file.size.as_ref().map(|at| at.value.map(1.0, |length| length.get())),
        height_unit: unit?,
        channel: file.channel.as_ref().map(|channel| channel.get().to_owned()),
        format: None,
    };
    let line = file.size.as_ref().map(|at| at.value.is_line());
    Some(Measured::new(path?, file.path.span.clone(), options, line, steps?))
}

/// Metres per unit.
fn height_unit(checks: &mut Checks<'_, '_>, unit: &At<String>) -> Option<f64> {
    match Unit::parse(&unit.value) {
        Ok(parsed) if parsed.powers == dimension::Length::POWERS => {
            let number = format!("1 {}", unit.value).parse::<Length>();
            checks.quantity(unit, number).map(|length| length.get())
        }
        _ => {
            checks.wrong(&unit.span, "a unit of length such as \"um\"", Some(dimension::Length::UNITS));
            None
        }
    }
}
