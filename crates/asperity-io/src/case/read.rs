//! From the TOML tree to the structs of `raw`: section by section, so that each can report its own fault.
//!
//! Unions are tagged by a key (`kind`, `model`). serde reads such a union through a buffer that loses the
//! places in the text; so the tag is moved outwards first: `{ kind = "sphere", radius = 1 }` becomes
//! `{ sphere = { radius = 1 } }`, which keeps them.

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue, ValueDeserializer};

use super::error::CaseError;
use super::quantity::range::{Poisson, Positive};
use super::quantity::{Number, Pressure};
use super::raw::{At, Body, Document, Domain, Material, Motion, Shift, Stress, Surface, Temperature, Time};
use super::text::{MOST_ERRORS, Text};
use super::words;

/// The keys of the root.
pub const SECTIONS: &[&str] = &[
    "title",
    "domain",
    "surface",
    "body",
    "load",
    "time",
    "temperature",
    "motion",
    "leakage",
    "solver",
    "output",
    "stress",
];

/// The document, or the faults that its sections have.
pub fn document(text: &Text<'_>) -> Result<Document, Vec<CaseError>> {
    let mut reader = Reader { text, errors: Vec::new(), misspelt: Vec::new() };
    for key in text.root.keys().take(MOST_ERRORS) {
        if !SECTIONS.contains(&key.get_ref().as_ref()) {
            reader.errors.push(words::unknown_key(text, &key.span(), key.get_ref(), SECTIONS));
            reader.misspelt.extend(words::nearest(key.get_ref(), SECTIONS));
        }
    }
    let title = reader.optional("title", &[]);
    let domain = reader.required("domain", &[]);
    let surface = reader.list("surface", &[Tag { inside: &[], key: "kind" }]);
    let body = reader.list("body", MATERIAL);
    let load = reader.required("load", HISTORY);
    let motion = reader.motion();
    // Steady states of motion have no times.
    let time = match motion.as_ref().filter(|motion| motion.value.steady.is_some()) {
        Some(motion) if !text.root.contains_key("time") => timeless(motion.span.clone()),
        // What is wrong with [motion] is told already.
        None if !text.root.contains_key("time") && reader.is_steady() => None,
        _ => reader.required("time", &[]),
    };
    let temperature = reader.optional("temperature", HISTORY);
    let leakage = reader.optional("leakage", &[]);
    let solver = reader.optional("solver", &[]).unwrap_or_default();
    let output = reader.optional("output", &[]).unwrap_or_default();
    let stress = reader.optional("stress", &[]);
    reader.errors.sort_by_key(|error| error.span.as_ref().map_or(usize::MAX, |span| span.start));
    match (reader.errors.is_empty(), domain, load, time) {
        (true, Some(domain), Some(load), Some(time)) => Ok(Document {
            title,
            domain,
            surface,
            body,
            load,
            time,
            temperature,
            motion,
            leakage,
            solver,
            output,
            stress,
        }),
        _ => Err(reader.errors),
    }
}

/// What was read, or the faults found.
type Read<T> = Result<T, Vec<CaseError>>;

/// The surfaces of a document that may have nothing else.
pub fn surfaces(text: &Text<'_>) -> Read<Vec<At<Surface>>> {
    let mut reader = Reader { text, errors: Vec::new(), misspelt: Vec::new() };
    let surfaces = reader.list("surface", &[Tag { inside: &[], key: "kind" }]);
    if reader.errors.is_empty() { Ok(surfaces) } else { Err(reader.errors) }
}

/// The domain and the surfaces of a document that may have nothing else.
pub fn roughness(text: &Text<'_>) -> Read<(At<Domain>, Vec<At<Surface>>)> {
    let mut reader = Reader { text, errors: Vec::new(), misspelt: Vec::new() };
    let domain = reader.required("domain", &[]);
    let surfaces = reader.list("surface", &[Tag { inside: &[], key: "kind" }]);
    match (domain, reader.errors.is_empty()) {
        (Some(domain), true) => Ok((domain, surfaces)),
        _ => Err(reader.errors),
    }
}

/// The bodies and the temperature of a document that may have nothing else.
pub fn bodies(text: &Text<'_>) -> Read<(Vec<At<Body>>, Option<At<Temperature>>)> {
    let mut reader = Reader { text, errors: Vec::new(), misspelt: Vec::new() };
    let bodies = reader.list("body", MATERIAL);
    let temperature = reader.optional("temperature", HISTORY);
    if reader.errors.is_empty() { Ok((bodies, temperature)) } else { Err(reader.errors) }
}

/// The table `shift` of a document that has nothing else.
pub fn shift(text: &Text<'_>) -> Read<At<Shift>> {
    let mut reader = Reader { text, errors: Vec::new(), misspelt: Vec::new() };
    let shift = reader.required("shift", &[Tag { inside: &[], key: "model" }]);
    shift.ok_or(reader.errors)
}

/// The section `[stress]` of a document that may have nothing else.
pub fn stress(text: &Text<'_>) -> Read<At<Stress>> {
    let mut reader = Reader { text, errors: Vec::new(), misspelt: Vec::new() };
    let stress = reader.required("stress", &[]);
    match (stress, reader.errors.is_empty()) {
        (Some(stress), true) => Ok(stress),
        _ => Err(reader.errors),
    }
}

/// Where a section holds a tagged union: in itself, or in the table at the path `inside`.
#[derive(Clone, Copy)]
struct Tag {
    inside: &'static [&'static str],
    key: &'static str,
}

/// The inner unions first: the outer ones move them.
const MATERIAL: &[Tag] =
    &[Tag { inside: &["material", "shift"], key: "model" }, Tag { inside: &["material"], key: "model" }];
const HISTORY: &[Tag] = &[Tag { inside: &["history"], key: "kind" }];

/// Keys of a `[[body]]` that may stand next to a material of its own file: `fit-indentation` writes `poisson`.
const OF_A_BODY: &[&str] = &["material", "name", "poisson", "bulk_modulus", "hardness"];

/// The material of a file that holds the lines of a body, `material = { ... }` at least, or the faults that it has.
pub fn material(text: &Text<'_>) -> Result<At<Material>, Vec<CaseError>> {
    let mut reader = Reader { text, errors: Vec::new(), misspelt: Vec::new() };
    for key in text.root.keys().take(MOST_ERRORS) {
        if !OF_A_BODY.contains(&key.get_ref().as_ref()) {
            reader.errors.push(words::unknown_key(text, &key.span(), key.get_ref(), OF_A_BODY));
        }
    }
    // The other keys do not change the functions of a material, but a slip in them is an error all the same.
    let _: Option<String> = reader.optional("name", &[]);
    let _: Option<Number<Poisson>> = reader.optional("poisson", &[]);
    for key in ["bulk_modulus", "hardness"] {
        let _: Option<Pressure<Positive>> = reader.optional(key, &[]);
    }
    const ALONE: &[Tag] = &[Tag { inside: &["shift"], key: "model" }, Tag { inside: &[], key: "model" }];
    let material = reader.optional("material", ALONE);
    match (reader.errors.is_empty(), material) {
        (true, Some(material)) => Ok(material),
        _ => Err(reader.errors),
    }
}

struct Reader<'r, 't> {
    text: &'r Text<'t>,
    errors: Vec<CaseError>,
    /// Sections that are there under a name that is nearly theirs.
    misspelt: Vec<&'static str>,
}

/// What stands for `[time]` where a case has none.
fn timeless(span: std::ops::Range<usize>) -> Option<At<Time>> {
    toml::from_str("end = \"1 s\"\nsteps = 1").ok().map(|value| At { span, value })
}

impl<'t> Reader<'_, 't> {
    /// Whether the case asks for steady states of motion.
    fn is_steady(&self) -> bool {
        let motion = self.text.root.get("motion").map(Spanned::get_ref);
        matches!(motion, Some(DeValue::Table(motion)) if motion.contains_key("steady"))
    }

    /// `[motion]`: its velocity is a text, or a history with a tag.
    fn motion(&mut self) -> Option<At<Motion>> {
        const PATH: Tag = Tag { inside: &["path"], key: "kind" };
        const VELOCITY: Tag = Tag { inside: &["velocity"], key: "kind" };
        let velocity = match self.text.root.get("motion").map(Spanned::get_ref) {
            Some(DeValue::Table(motion)) => motion.get("velocity").map(Spanned::get_ref),
            _ => None,
        };
        let tags: &[Tag] =
            if matches!(velocity, Some(DeValue::Table(_))) { &[PATH, VELOCITY] } else { &[PATH] };
        self.optional("motion", tags)
    }

    fn required<T: DeserializeOwned>(&mut self, key: &'static str, tags: &[Tag]) -> Option<T> {
        match self.text.root.get(key) {
            Some(value) => self.read(value, tags),
            None => {
                self.missing(key);
                None
            }
        }
    }

    fn missing(&mut self, section: &str) {
        if !self.misspelt.contains(&section) {
            self.errors.push(words::missing_section(section));
        }
    }

    fn optional<T: DeserializeOwned>(&mut self, key: &str, tags: &[Tag]) -> Option<T> {
        self.text.root.get(key).and_then(|value| self.read(value, tags))
    }

    fn list<T: DeserializeOwned>(&mut self, key: &'static str, tags: &[Tag]) -> Vec<T> {
        let Some(value) = self.text.root.get(key) else {
            self.missing(key);
            return Vec::new();
        };
        let DeValue::Array(array) = value.get_ref() else {
            let help = Some(format!("begin each with a line [[{key}]]"));
            self.errors.push(self.text.wrong(&value.span(), "a list of tables", help));
            return Vec::new();
        };
        if array.is_empty() {
            self.errors.push(self.text.wrong(&value.span(), "a list of one table at least", None));
        }
        let mut sections = Vec::new();
        for element in array.iter() {
            // Many alike have one cause.
            if self.errors.len() >= MOST_ERRORS {
                break;
            }
            sections.extend(self.read(element, tags));
        }
        sections
    }

    fn read<T: DeserializeOwned>(&mut self, value: &Spanned<DeValue<'t>>, tags: &[Tag]) -> Option<T> {
        let mut value = value.clone();
        let lists = [
            ("process", &[][..], "op"),
            ("stages", &["history"][..], "kind"),
            ("layer", &["material", "shift"][..], "model"),
            ("layer", &["material"][..], "model"),
        ];
        let mut moved = lists
            .into_iter()
            .map(|(list, inside, key)| self.move_list(&mut value, list, Tag { inside, key }));
        if let Err(error) = moved.try_for_each(|result| result) {
            self.errors.push(*error);
            return None;
        }
        for tag in tags {
            if let Err(error) = self.move_tag(&mut value, *tag) {
                self.errors.push(*error);
                return None;
            }
        }
        let span = value.span();
        match T::deserialize(ValueDeserializer::from(value)) {
            Ok(section) => Some(section),
            Err(error) => {
                self.errors.push(words::translate(self.text, &error, span));
                None
            }
        }
    }

    fn move_tag(&self, value: &mut Spanned<DeValue<'t>>, tag: Tag) -> Result<(), Box<CaseError>> {
        let mut union = value;
        for name in tag.inside {
            let DeValue::Table(table) = union.get_mut() else {
                return Ok(()); // serde says what the section is
            };
            union = match table.get_mut(*name) {
                Some(inner) => inner,
                None => return Ok(()), // serde says that it is missing, where it must not
            };
        }
        self.outwards(union, tag.key)
    }

    /// The steps of a measured surface, the stages of a load and the layers of a body are a list inside of it: of tagged
    /// unions, or of tables that hold one.
    fn move_list(
        &self,
        value: &mut Spanned<DeValue<'t>>,
        list: &str,
        tag: Tag,
    ) -> Result<(), Box<CaseError>> {
        let DeValue::Table(table) = value.get_mut() else { return Ok(()) };
        let Some(list) = table.get_mut(list) else { return Ok(()) };
        let DeValue::Array(elements) = list.get_mut() else { return Ok(()) }; // serde says what it is
        elements.iter_mut().try_for_each(|element| self.move_tag(element, tag))
    }

    /// `{ tag = name, ... }` becomes `{ name = { ... } }`.
    fn outwards(&self, value: &mut Spanned<DeValue<'t>>, tag: &str) -> Result<(), Box<CaseError>> {
        let span = value.span();
        let DeValue::Table(table) = value.get_mut() else {
            let expected = format!("a table that begins with the key `{tag}`");
            return Err(self.text.wrong(&span, &expected, None).into());
        };
        let Some(name) = table.remove(tag) else {
            return Err(words::missing_key(self.text, &span, tag).into());
        };
        let place = name.span();
        let DeValue::String(name) = name.into_inner() else {
            return Err(words::wrong_choice(self.text, &place, None).into());
        };
        let inner = std::mem::take(table);
        let mut outer = DeTable::new();
        let key: Spanned<DeString<'t>> = Spanned::new(place, name);
        outer.insert(key, Spanned::new(span, DeValue::Table(inner)));
        *table = outer;
        Ok(())
    }
}
