//! The parts of the undeformed gap.

use asperity::Grid;
use asperity::surface::{Fill, Level, Part, Punch, Roughness, SelfAffine, Shape};

use super::Checks;
use crate::case::measured::Measured;
use crate::case::plan::Surface;
use crate::case::quantity::unit::Unit;
use crate::case::quantity::{Dimension, Length, dimension};
use crate::case::raw::{self, At, Two};

pub fn surfaces(
    checks: &mut Checks<'_, '_>,
    surfaces: &[At<raw::Surface>],
    grid: Option<&Grid>,
) -> Option<Vec<Surface>> {
    // All of them are looked at, also after one that is wrong.
    let parts: Vec<_> = surfaces.iter().map(|surface| part(checks, surface, grid)).collect();
    parts.into_iter().collect()
}

fn part(checks: &mut Checks<'_, '_>, surface: &At<raw::Surface>, grid: Option<&Grid>) -> Option<Surface> {
    let (shape, center) = match &surface.value {
        raw::Surface::Sphere(sphere) => (Shape::Sphere { radius: sphere.radius.get() }, sphere.center),
        raw::Surface::Ellipsoid(ellipsoid) => {
            let [radius_x, radius_y] = [ellipsoid.radius_x.get(), ellipsoid.radius_y.get()];
            (Shape::Ellipsoid { radius_x, radius_y }, ellipsoid.center)
        }
        raw::Surface::Cone(cone) => (Shape::Cone { slope: cone.slope.get() }, cone.center),
        raw::Surface::FlatPunch(punch) => {
            let keys = [("radius", punch.value.radius.is_some()), ("size", punch.value.size.is_some())];
            checks.exactly_one(&punch.span, &keys)?;
            let outline = match (punch.value.radius, punch.value.size) {
                (Some(radius), _) => Punch::Circle { radius: radius.get() },
                (_, Some(size)) => Punch::Rectangle { size: size.map(|length| length.get()) },
                (None, None) => return None,
            };
            (Shape::FlatPunch(outline), punch.value.center)
        }
        raw::Surface::Wave(wave) => {
            let wavelength = wave.wavelength.map(|length| length.get());
            (Shape::Wave { amplitude: wave.amplitude.get(), wavelength }, wave.center)
        }
        raw::Surface::SelfAffine(roughness) => return self_affine(checks, roughness, grid),
        raw::Surface::File(file) => return measured(checks, file),
    };
    checks.core(&surface.span, shape.validate())?;
    let center = center.map_or([0.0, 0.0], |center: Two<Length>| center.map(|length| length.get()));
    Some(Surface::Part(Part::Shape { shape, center }))
}

fn self_affine(
    checks: &mut Checks<'_, '_>,
    roughness: &At<raw::SelfAffine>,
    grid: Option<&Grid>,
) -> Option<Surface> {
    let raw = &roughness.value;
    let keys = [("rms_gradient", raw.rms_gradient.is_some()), ("rms_height", raw.rms_height.is_some())];
    checks.exactly_one(&roughness.span, &keys)?;
    let longest = raw.longest.value.get();
    let surface = SelfAffine {
        hurst: raw.hurst.get(),
        roughness: match (raw.rms_gradient, raw.rms_height) {
            (Some(gradient), _) => Roughness::RmsGradient(gradient.get()),
            (_, Some(height)) => Roughness::RmsHeight(height.get()),
            (None, None) => return None,
        },
        longest,
        shortest: raw.shortest.value.get(),
        roll_off: raw.roll_off.as_ref().map_or(longest, |at| at.value.get()),
        seed: raw.seed.get(),
    };
    if let Some(grid) = grid {
        let result = surface.validate(grid);
        // The wavelength that is refused, where the message is about one.
        let place = match &result {
            Err(asperity::Error::Invalid { what, .. }) if what.starts_with("shortest") => &raw.shortest.span,
            Err(asperity::Error::Invalid { what, .. }) if what.starts_with("longest") => &raw.longest.span,
            Err(asperity::Error::Invalid { what, .. }) if what.starts_with("roll-off") => {
                raw.roll_off.as_ref().map_or(&roughness.span, |at| &at.span)
            }
            _ => &roughness.span,
        };
        checks.core(place, result)?;
    }
    Some(Surface::Part(Part::SelfAffine(surface)))
}

fn measured(checks: &mut Checks<'_, '_>, file: &raw::File) -> Option<Surface> {
    let path = checks.file(&file.path);
    let unit = match &file.height_unit {
        None => None,
        Some(unit) => Some(height_unit(checks, unit)?),
    };
    Some(Surface::File(Measured {
        path: path?,
        span: file.path.span.clone(),
        size: file.size.map(|size| size.map(|length| length.get())),
        height_unit: unit,
        level: match file.level {
            raw::Level::None => Level::None,
            raw::Level::Mean => Level::Mean,
            raw::Level::Plane => Level::Plane,
            raw::Level::Quadratic => Level::Quadratic,
        },
        fill: match file.fill {
            raw::Fill::Error => Fill::Error,
            raw::Fill::Harmonic => Fill::Harmonic,
            raw::Fill::Nearest => Fill::Nearest,
        },
        invert: file.invert,
    }))
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
