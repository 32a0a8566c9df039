//! The case file as it is written: its sections.
//!
//! Each section is a struct with a field per key, in a file of its own. The comments on the fields are the descriptions in the JSON
//! Schema; the types of the fields carry dimension and range; what needs more than one key to judge is checked where the
//! section is converted.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::adhesion::Adhesion;
use super::body::Body;
use super::domain::Domain;
use super::error::CaseError;
use super::flash::Flash;
use super::leakage::LeakageKeys;
use super::load::Load;
use super::material::Material;
use super::motion::Motion;
use super::output::{OutputKeys, Solver};
use super::read::Reader;
use super::schema;
use super::seal::SealKeys;
use super::stress::Stress;
use super::study::Study;
use super::surface::Surface;
use super::tangential::{Friction, Tangential};
use super::temperature::Temperature;
use super::text::Text;
use super::time::Times;
use super::wear::Wear;
use crate::quantity::range::{Poisson, Positive};
use crate::quantity::{Length, Number, Pressure};

/// Keys of a `[[body]]` that may stand next to a material of its own file: `fit-indentation` writes `poisson`.
const OF_A_BODY: &[&str] = &["material", "name", "thickness", "poisson", "bulk_modulus", "hardness"];

/// A case of asperity: two bodies, the gap between them, a load over time.
#[derive(Debug, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Document {
    /// Title of the case, stored in the result.
    #[schemars(example = "PMMA rough sphere, step load")]
    #[schemars(length(max = 1000))]
    pub title: Option<String>,
    /// The computational domain: a rectangle of equal cells, or a line of them.
    pub domain: Domain,
    /// The parts whose sum is the undeformed gap.
    #[schemars(length(min = 1))]
    pub surface: Vec<Surface>,
    /// The deformable bodies, one or two; a missing second body is rigid.
    #[schemars(length(min = 1, max = 2))]
    pub body: Vec<Body>,
    /// What presses the bodies together.
    pub load: Load,
    /// The times of the solution; not for steady states of motion.
    pub time: Option<Times>,
    /// The temperature of bodies whose material has a `shift`; they are at its reference if not given.
    #[schemars(example = serde_json::json!({ "history": { "kind": "constant", "value": "60 °C" } }))]
    pub temperature: Option<Temperature>,
    /// Motion of the contact over the bodies; nothing moves if not given.
    #[schemars(example = serde_json::json!({ "velocity": "10 mm/s" }))]
    pub motion: Option<Motion>,
    /// An attraction between the surfaces; none if not given.
    #[schemars(example = serde_json::json!({ "work": "50 mJ/m2", "range": "5 nm" }))]
    pub adhesion: Option<Adhesion>,
    /// Friction between the surfaces, with `tangential`; none if not given.
    #[schemars(example = serde_json::json!({ "coefficient": 0.3 }))]
    pub friction: Option<Friction>,
    /// A load along the surfaces, with `friction`; none if not given.
    #[schemars(example = serde_json::json!({ "control": "force", "x": { "kind": "ramp", "value": "0.1 N", "duration": "1 s" } }))]
    pub tangential: Option<Tangential>,
    /// Wear of the surfaces where they slide; none if not given.
    #[schemars(example = serde_json::json!({ "coefficient": "1e-15 m2/N", "velocity": "0.1 m/s" }))]
    pub wear: Option<Wear>,
    /// How warm friction makes the surfaces of a contact in motion; not computed if not given.
    #[schemars(example = serde_json::json!({ "conductivity": "0.3 W/(m K)", "diffusivity": "1e-7 m2/s", "friction": 0.3 }))]
    pub flash: Option<Flash>,
    /// The flow of a fluid through the gap.
    #[schemars(example = serde_json::json!({ "pressure_drop": "2 bar", "viscosity": "1 mPa s" }))]
    pub leakage: Option<LeakageKeys>,
    /// The whole seal of which the case is a patch; only `asperity seal` computes it.
    #[schemars(example = serde_json::json!({ "profile": "hertz", "peak": "2 MPa", "width": "1.2 mm", "length": "0.4 m" }))]
    pub seal: Option<SealKeys>,
    /// How each step is solved.
    #[schemars(default)]
    pub solver: Solver,
    /// What is stored, and where.
    #[schemars(default)]
    pub output: OutputKeys,
    /// The stress below the surface, from the stored pressures; not computed if not given.
    #[schemars(example = serde_json::json!({ "depths": "auto", "yield_stress": "110 MPa" }))]
    pub stress: Option<Stress>,
    /// What `asperity study` varies; a single run ignores it.
    #[schemars(example = serde_json::json!({ "vary": { "surface.0.seed": "1..10" } }))]
    #[expect(dead_code, reason = "it is checked; `study` below reads it")]
    pub study: Option<Study>,
}

/// What was read, or the faults found.
type Read<T> = Result<T, Vec<CaseError>>;

impl Document {
    /// The document, or the faults that its sections have.
    pub fn read(text: &Text<'_>) -> Read<Document> {
        let mut reader = Reader::new(text);
        reader.only(&schema::sections());
        let document = Document {
            title: reader.optional("title"),
            domain: reader.required("domain").unwrap_or_default(),
            surface: reader.list("surface"),
            body: reader.list("body"),
            load: reader.required("load").unwrap_or_default(),
            motion: reader.table("motion"),
            // Steady states of motion have no times.
            time: match text.has("motion.steady") {
                true => reader.table("time"),
                false => reader.required("time"),
            },
            temperature: reader.table("temperature"),
            adhesion: reader.table("adhesion"),
            friction: reader.table("friction"),
            tangential: reader.table("tangential"),
            wear: reader.table("wear"),
            flash: reader.table("flash"),
            leakage: reader.table("leakage"),
            seal: reader.table("seal"),
            solver: reader.table("solver").unwrap_or_default(),
            output: reader.table("output").unwrap_or_default(),
            stress: reader.table("stress"),
            study: reader.table("study"),
        };
        reader.finish(Some(document))
    }
}

/// The surfaces of a document that may have nothing else.
pub fn surfaces(text: &Text<'_>) -> Read<Vec<Surface>> {
    let mut reader = Reader::new(text);
    let surfaces = reader.list("surface");
    reader.finish(Some(surfaces))
}

/// The domain and the surfaces of a document that may have nothing else.
pub fn roughness(text: &Text<'_>) -> Read<(Domain, Vec<Surface>)> {
    let mut reader = Reader::new(text);
    let (domain, surfaces) = (reader.required("domain"), reader.list("surface"));
    reader.finish(domain.map(|domain| (domain, surfaces)))
}

/// The bodies and the temperature of a document that may have nothing else.
pub fn bodies(text: &Text<'_>) -> Read<(Vec<Body>, Option<Temperature>)> {
    let mut reader = Reader::new(text);
    let (bodies, temperature) = (reader.list("body"), reader.table("temperature"));
    reader.finish(Some((bodies, temperature)))
}

/// The section of this name of a document that may have nothing else.
pub fn section<T: DeserializeOwned>(text: &Text<'_>, name: &str) -> Read<T> {
    let mut reader = Reader::new(text);
    let section = reader.required(name);
    reader.finish(section)
}

/// The section `[study]` of a document that may have nothing else; one without it varies nothing.
pub fn study(text: &Text<'_>) -> Read<Study> {
    if text.root.contains_key("study") { section(text, "study") } else { Ok(Study::default()) }
}

/// The material of a file that holds the lines of a body, `material = { ... }` at least, or the faults that it has.
pub fn material(text: &Text<'_>) -> Read<Material> {
    let mut reader = Reader::new(text);
    reader.only(OF_A_BODY);
    // The other keys do not change the functions of a material, but a slip in them is an error all the same.
    let _: Option<String> = reader.optional("name");
    let _: Option<Length<Positive>> = reader.optional("thickness");
    let _: Option<Number<Poisson>> = reader.optional("poisson");
    for key in ["bulk_modulus", "hardness"] {
        let _: Option<Pressure<Positive>> = reader.optional(key);
    }
    let material = reader.table("material");
    reader.finish(material)
}
