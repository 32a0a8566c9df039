//! `[[body]]` and `[[body.layer]]`: of which materials the bodies consist.

use asperity::layer::{BodyLayer, Interface, LayeredBody};
use asperity::material::{Body as Solid, Lateral};

use super::hardness::HardnessFile;
use super::keys::*;
use super::material::{Material, Sample};

/// Most layers of a body.
const MOST: usize = 100;

/// A deformable body: a half-space, or layers on a half-space or on a rigid base.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name for messages and reports.
    #[schemars(example = &"PMMA")]
    pub name: Option<String>,
    /// What the layers lie on; "half-space" if not given. A rigid base has no material.
    #[serde(default)]
    pub base: BodyBase,
    /// Layers from the surface down; none if not given.
    #[serde(default)]
    pub layer: Vec<Layer>,
    /// Thickness of a body without layers, which is solved as a half-space: a finding says where it is too thin for that.
    #[schemars(example = "50 mm")]
    pub thickness: Option<Length<Positive>>,
    /// Poisson's ratio, constant in time (0.5 = incompressible); this or `bulk_modulus`. With layers: of the half-space below.
    pub poisson: Option<Number<Poisson>>,
    /// Bulk modulus, constant in time; this or `poisson`.
    #[schemars(example = "4 GPa")]
    pub bulk_modulus: Option<Pressure<Positive>>,
    /// Cut-off for the pressure; none if not given. The softer body decides.
    pub hardness: Option<Pressure<Positive>>,
    /// Cut-off for the pressure in each cell, from a file. Of several hardnesses the smallest counts.
    #[schemars(example = serde_json::json!({ "path": "hardness.npy", "unit": "1 MPa" }))]
    pub hardness_file: Option<HardnessFile>,
    /// Name of an array that a program gives beside the case: the cut-off for the pressure in each cell.
    #[schemars(skip)]
    pub hardness_array: Option<String>,
    /// Linear viscoelastic material; needed unless the base is rigid. With layers: of the half-space below.
    #[schemars(example = serde_json::json!({ "model": "elastic", "young": "2.1 GPa" }))]
    pub material: Option<Material>,
}

/// What layers lie on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BodyBase {
    /// A half-space of the body's material.
    #[default]
    HalfSpace,
    /// A base that does not yield.
    Rigid,
}

/// A layer of a body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Thickness of the layer.
    #[schemars(example = "10 mm")]
    pub thickness: Length<Positive>,
    /// Poisson's ratio, constant in time (0.5 = incompressible); this or `bulk_modulus`.
    #[schemars(example = 0.49)]
    pub poisson: Option<Number<Poisson>>,
    /// Bulk modulus, constant in time, of an elastic layer; this or `poisson`.
    #[schemars(example = "4 GPa")]
    pub bulk_modulus: Option<Pressure<Positive>>,
    /// Linear viscoelastic material.
    #[schemars(example = serde_json::json!({ "model": "elastic", "young": "5 MPa" }))]
    pub material: Material,
    /// To what lies below; "bonded" if not given.
    #[serde(default)]
    pub interface: Interface,
}

/// A material of the case: that of a half-space, of a layer, or of what layers lie on.
pub struct Part<'a> {
    /// Number of its body.
    pub body: usize,
    /// The table that describes it.
    pub at: Place<'a>,
    /// How messages call it.
    pub name: String,
    /// Its material; `None` where that has a fault.
    pub sample: Option<Sample>,
    pub poisson: Option<Number<Poisson>>,
    pub bulk_modulus: Option<Pressure<Positive>>,
    /// Cut-off of the pressure on it [Pa], at the surface.
    pub hardness: Option<f64>,
}

/// The materials of all bodies, each from the surface down.
pub fn parts<'a>(list: &Place<'a>, bodies: &[Body]) -> Vec<Part<'a>> {
    bodies.iter().enumerate().flat_map(|(n, body)| body.parts(&list.item(n), n).unwrap_or_default()).collect()
}

/// Thickness of the thinnest body that is taken as a half-space [m], where the case gives it.
pub fn thickness(bodies: &[Body]) -> Option<f64> {
    bodies.iter().filter_map(|body| body.thickness).map(Length::get).reduce(f64::min)
}

impl Body {
    fn parts<'a>(&self, at: &Place<'a>, n: usize) -> Option<Vec<Part<'a>>> {
        let name = self.name.clone().unwrap_or_else(|| format!("body {}", n + 1));
        if self.layer.len() > MOST {
            let message = format!("the body has {} layers, but may have {MOST}", self.layer.len());
            return at.fault(message, "fewer layers", "");
        }
        if !self.layer.is_empty() {
            let message = "belongs to a body without [[body.layer]]: each layer has its own";
            at.without(&["thickness"], message, "no such key", "delete the line");
        }
        let part = |at: Place<'a>, name: String, material: &Material, poisson, bulk_modulus| {
            let sample = material.sample(&at.key("material"));
            Part { body: n, at, name, sample, poisson, bulk_modulus, hardness: None }
        };
        let mut parts = Vec::new();
        for (k, layer) in self.layer.iter().enumerate() {
            let (at, name) = (at.key("layer").item(k), format!("{name}, layer {}", k + 1));
            parts.push(part(at, name, &layer.material, layer.poisson, layer.bulk_modulus));
        }
        match (self.base, &self.material) {
            (BodyBase::HalfSpace, Some(material)) => {
                let name = if self.layer.is_empty() { name } else { format!("{name}, base") };
                parts.push(part(at.clone(), name, material, self.poisson, self.bulk_modulus));
            }
            (BodyBase::HalfSpace, None) => at.missing("material", "").unwrap_or_default(),
            (BodyBase::Rigid, _) => self.rigid(at),
        }
        if let Some(surface) = parts.first_mut() {
            surface.hardness = self.hardness.map(Pressure::get);
        }
        Some(parts)
    }

    /// A rigid base has layers on it, and no material.
    fn rigid(&self, at: &Place<'_>) {
        if let Some(key) = ["material", "poisson", "bulk_modulus"].iter().find(|key| at.has(key)) {
            at.fault::<()>(
                format!("a body with base = \"rigid\" has no `{key}`: the base does not yield"),
                "no such key",
                "give it in [[body.layer]], or leave out base = \"rigid\" for layers on a half-space",
            );
        }
        if self.layer.is_empty() {
            at.fault::<()>(
                "a body with base = \"rigid\" needs a [[body.layer]]: without one nothing yields",
                "[[body.layer]]",
                "leave a rigid body out; for a half-space leave out base = \"rigid\"",
            );
        }
    }

    /// The body of these materials, from the surface down.
    pub fn of(&self, mut materials: impl Iterator<Item = Solid>) -> LayeredBody {
        let layer = |(layer, material): (&Layer, Solid)| BodyLayer {
            thickness: layer.thickness.get(),
            interface: layer.interface,
            material,
        };
        let layers = self.layer.iter().zip(&mut materials).map(layer).collect();
        LayeredBody { layers, base: materials.next() }
    }
}

impl Part<'_> {
    /// How it yields sideways.
    pub fn lateral(&self) -> Option<Lateral> {
        self.at.exactly_one(&["poisson", "bulk_modulus"])?;
        let poisson = self.poisson.map(|ratio| Lateral::Poisson(ratio.get()));
        poisson.or(self.bulk_modulus.map(|modulus| Lateral::BulkModulus(modulus.get())))
    }
}
