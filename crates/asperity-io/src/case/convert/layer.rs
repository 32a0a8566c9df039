//! Bodies of layers: which materials they consist of, and what the layers are to the contact.

use std::ops::Range;

use asperity::finding::Finding;
use asperity::history::check_layers;
use asperity::layer::{BodyLayer, Layered, LayeredBody, NonseparableLayers, Response, response};
use asperity::material::{Body, Creep, ReducedTime};
use asperity::quantities::Quantity;
use asperity::{Boundary, Error, Grid, Scheme};

use super::Checks;
use crate::case::describe::MaterialReport;
use crate::case::quantity::range::{Poisson, Positive};
use crate::case::quantity::{Number, Pressure};
use crate::case::raw::{self, At, BodyBase};
use crate::case::words::{missing_key, number};

/// Most layers of a body.
const MOST: usize = 100;

/// A material of the case: that of a half-space, of a layer, or of what layers lie on.
pub struct Part<'a> {
    /// Number of its body.
    body: usize,
    /// The table that describes it.
    pub span: &'a Range<usize>,
    /// How messages call it.
    pub name: String,
    pub material: &'a At<raw::Material>,
    pub poisson: Option<Number<Poisson>>,
    pub bulk_modulus: Option<Pressure<Positive>>,
    /// Cut-off of the pressure on it [Pa], at the surface.
    pub hardness: Option<f64>,
}

/// One body or layer, ready for the contact.
pub struct Made {
    pub body: Body,
    pub creep: Creep,
    pub clock: Option<ReducedTime>,
    pub report: MaterialReport,
    pub findings: Vec<Finding>,
}

/// The materials of all bodies, each from the surface down.
pub fn parts<'a>(checks: &mut Checks<'_, '_>, bodies: &'a [At<raw::Body>]) -> Vec<Part<'a>> {
    let mut parts = Vec::new();
    for (n, at) in bodies.iter().enumerate() {
        let body = &at.value;
        let name = body.name.clone().unwrap_or_else(|| format!("body {}", n + 1));
        if body.layer.len() > MOST {
            let message = format!("the body has {} layers, but may have {MOST}", body.layer.len());
            checks.fault(&at.span, message, "fewer layers", None);
            continue;
        }
        if let (Some(thickness), false) = (&body.thickness, body.layer.is_empty()) {
            let message =
                "a body with [[body.layer]] has no thickness of its own: its layers have".to_owned();
            checks.fault(&thickness.span, message, "no such key", Some("delete the line"));
        }
        let first = parts.len();
        for (k, layer) in body.layer.iter().enumerate() {
            let raw::Layer { poisson, bulk_modulus, ref material, .. } = layer.value;
            let name = format!("{name}, layer {}", k + 1);
            parts.push(Part {
                body: n,
                span: &layer.span,
                name,
                material,
                poisson,
                bulk_modulus,
                hardness: None,
            });
        }
        match (body.base.unwrap_or_default(), &body.material) {
            (BodyBase::HalfSpace, Some(material)) => {
                let name = if body.layer.is_empty() { name } else { format!("{name}, base") };
                let raw::Body { poisson, bulk_modulus, .. } = *body;
                parts.push(Part {
                    body: n,
                    span: &at.span,
                    name,
                    material,
                    poisson,
                    bulk_modulus,
                    hardness: None,
                });
            }
            (BodyBase::HalfSpace, None) => checks.push(|text| missing_key(text, &at.span, "material")),
            (BodyBase::Rigid, _) => rigid(checks, at),
        }
        if let Some(surface) = parts.get_mut(first) {
            surface.hardness = body.hardness.map(|hardness| hardness.get());
        }
    }
    parts
}

/// A rigid base has layers on it, and no material.
fn rigid(checks: &mut Checks<'_, '_>, at: &At<raw::Body>) {
    let body = &at.value;
    let keys = [
        ("material", body.material.is_some()),
        ("poisson", body.poisson.is_some()),
        ("bulk_modulus", body.bulk_modulus.is_some()),
    ];
    if let Some((key, _)) = keys.iter().find(|key| key.1) {
        let message = format!("a body with base = \"rigid\" has no `{key}`: the base does not yield");
        let help = "give it in [[body.layer]], or leave out base = \"rigid\" for layers on a half-space";
        checks.fault(&at.span, message, "no such key", Some(help));
    }
    if body.layer.is_empty() {
        let message =
            "a body with base = \"rigid\" needs a [[body.layer]]: without one nothing yields".to_owned();
        let help = "leave a rigid body out; for a half-space leave out base = \"rigid\"";
        checks.fault(&at.span, message, "[[body.layer]]", Some(help));
    }
}

/// What the bodies are to the contact. `made` are the `parts`, in their order.
pub fn respond(
    checks: &mut Checks<'_, '_>,
    raw: &[At<raw::Body>],
    parts: &[Part<'_>],
    made: &[Made],
) -> Option<Response> {
    let all = raw.iter().enumerate().map(|(n, at)| {
        let of_body =
            parts.iter().zip(made).filter(|(part, _)| part.body == n).map(|(_, made)| made.body.clone());
        let mut materials = of_body.collect::<Vec<_>>().into_iter();
        let layers = at.value.layer.iter().zip(&mut materials).map(|(layer, material)| BodyLayer {
            thickness: layer.value.thickness.get(),
            interface: layer.value.interface.unwrap_or_default(),
            material,
        });
        LayeredBody { layers: layers.collect(), base: materials.next() }
    });
    let all: Vec<LayeredBody> = all.collect();
    let layered = raw.iter().find(|at| !at.value.layer.is_empty())?;
    let other_clock = made.iter().position(|one| one.clock != made[0].clock);
    let found = match other_clock {
        None => response(&all),
        Some(n) => Err(Error::invalid(
            format!("temperature shift of {}", parts[n].name),
            format!("not that of {}", parts[0].name),
            "the same law for all layers and bodies while the temperature changes: otherwise waves of different lengths creep \
             differently, which is not solved yet. Give all of them the same `shift`, or hold the temperature constant",
        )),
    };
    if let Ok(Response { waves: Some(_), .. }) = &found
        && made.iter().any(|one| one.clock.is_some())
    {
        let message =
            "the temperature changes, and the layers creep differently: this is not solved".to_owned();
        let help = "hold the temperature constant, or give all layers the same relative creep";
        checks.fault(&layered.span, message, "layers of one relative creep", Some(help));
        return None;
    }
    // The part that the error names, by the end of its subject.
    let named = |error: &Error| match error {
        Error::Invalid { what, .. } => {
            parts.iter().filter(|part| what.ends_with(&part.name)).max_by_key(|part| part.name.len())
        }
        _ => None,
    };
    let span = found.as_ref().err().and_then(named).map_or(&layered.span, |part| part.span);
    checks.core(span, found)
}

/// Faults of what is not solved where layers creep differently.
pub fn unsolved(checks: &mut Checks<'_, '_>, document: &raw::Document, scheme: Scheme) {
    let help = "omit it, or give all layers and bodies the same relative creep";
    let mut fault = |span: &Range<usize>, what: &str, expected: &str| {
        let message = format!("{what}: this is not solved for layers that creep differently");
        checks.fault(span, message, expected, Some(help));
    };
    let time = &document.time.span;
    if scheme != Scheme::Linear {
        fault(time, "the scheme is not \"linear\"", "scheme = \"linear\"");
    }
    if let Some(at) = &document.motion {
        fault(&at.span, "the contact moves", "a contact that stays in its place");
    }
    for at in document.output.quantities.iter().flatten() {
        let raw::Quantities::One(quantity) = at.value else { continue };
        if quantity.is_energy() || quantity == Quantity::ContactStiffness {
            fault(&at.span, &format!("{quantity} is asked for"), "another quantity");
        }
    }
}

/// Whether the cells of a free domain resolve the top layers, and the domain is wide enough for `waves` that creep differently; a
/// periodic domain takes layers of any thickness.
pub fn resolved(
    checks: &mut Checks<'_, '_>,
    bodies: &[At<raw::Body>],
    domain: &At<raw::Domain>,
    grid: &Grid,
    layers: &Layered,
    waves: Option<&NonseparableLayers>,
) {
    let boundary = domain.value.boundary.unwrap_or_default();
    if boundary == Boundary::Periodic {
        return;
    }
    let (longest, cell) = (layers.longest_cell(), grid.longest_cell());
    let tops = bodies.iter().filter_map(|at| at.value.layer.first());
    let thinnest = tops.min_by(|a, b| a.value.thickness.get().total_cmp(&b.value.thickness.get()));
    if let Some(layer) = thinnest
        && cell > longest
    {
        let least: Vec<String> =
            grid.extents().iter().map(|side| (side / longest).ceil().to_string()).collect();
        let message = format!(
            "the cells are {} m long, more than 4 times the thickness of this layer: they do not resolve it",
            number(cell)
        );
        let help = format!(
            "set domain.cells to [{}] or more, take a smaller domain, or boundary = \"periodic\", which needs no such cells",
            least.join(", ")
        );
        checks.fault(&layer.span, message, &format!("cells of at most {} m", number(longest)), Some(&help));
        return;
    }
    if let (Some(layer), Some(waves)) = (thinnest, waves) {
        checks.core(&layer.span, check_layers(grid, boundary, waves));
    }
}

/// Thickness of the thinnest body that is taken as a half-space [m], where the case gives it.
pub fn thickness(bodies: &[At<raw::Body>]) -> Option<f64> {
    bodies.iter().filter_map(|at| at.value.thickness.as_ref()).map(|at| at.value.get()).reduce(f64::min)
}
