//! `[study]`: keys of the case and the values that each takes in a study. A single run leaves the section out.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use schemars::{Schema, SchemaGenerator, json_schema};
use serde_json::json;
use toml::de::DeValue;

use super::keys::*;
use super::text::Text;
use super::{Case, CaseErrors, document, file_text, overridden};

/// Keys that a study varies: it runs the case once for each combination of their values. `asperity run` ignores the section.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Paths of keys with the values that each takes: a list, or a text such as "0.1 N:10 N:5:log" (from, to, how many) or "1..10"
    /// (whole numbers, both ends included).
    #[schemars(example = serde_json::json!({ "load.history.value": ["0.1 N", "1 N"], "surface.0.seed": "1..10" }))]
    #[schemars(schema_with = "values")]
    #[serde(default)]
    vary: BTreeMap<String, Values>,
    /// Whether the first values of all keys make the first run, the second ones the second, and so on; if false, which is the
    /// default, every combination is run.
    #[schemars(example = true)]
    #[serde(default)]
    pub zip: bool,
}

/// The values of a key: one text for all of them, or a list.
pub(crate) type Values = Form<String, Vec<toml::Value>>;

impl Word for String {
    const FORMS: &'static str = "a list of values, or a text such as \"1..10\" or \"0.1 N:10 N:5:log\" (write the path of the key in quotes)";
}

fn values(_: &mut SchemaGenerator) -> Schema {
    let list = json!({ "type": "array", "items": {}, "minItems": 1 });
    json_schema!({ "type": "object", "additionalProperties": { "anyOf": [{ "type": "string" }, list] } })
}

impl Study {
    /// The keys that vary, in the order of the text.
    fn keys(&self, text: &Text<'_>) -> Vec<(String, Values)> {
        let section = match text.root.get("study").map(|section| section.get_ref()) {
            Some(DeValue::Table(study)) => study.get("vary").map(|vary| vary.get_ref()),
            _ => None,
        };
        let place = |key: &str| match section {
            Some(DeValue::Table(vary)) => vary.get_key_value(key).map_or(0, |(key, _)| key.span().start),
            _ => 0,
        };
        let mut keys = Vec::from_iter(self.vary.clone());
        keys.sort_by_key(|(key, _)| place(key));
        keys
    }
}

/// A case file whose keys may be changed, also one that is no case before they are.
pub(crate) struct Base {
    /// Name of the file.
    pub(crate) name: String,
    directory: PathBuf,
    source: String,
    overrides: Vec<String>,
    /// What its section `[study]` says, in the order of the text.
    pub(crate) vary: Vec<(String, Values)>,
    /// Whether the values go together.
    pub(crate) zip: bool,
}

impl Base {
    /// Reads a case file.
    ///
    /// # Errors
    /// [`CaseErrors`] where the file cannot be read or is no TOML, where an override cannot be applied, or where `[study]` is wrong.
    pub(crate) fn read(path: &Path, overrides: &[String]) -> Result<Base, CaseErrors> {
        let (name, source) = file_text(path, "a case file")?;
        Base::of(name, source, path.parent().unwrap_or(Path::new("")), overrides)
    }

    /// The same from the text of a case.
    ///
    /// # Errors
    /// As [`Base::read`].
    pub(crate) fn of(
        name: String,
        source: String,
        directory: &Path,
        overrides: &[String],
    ) -> Result<Base, CaseErrors> {
        let text = overridden(&name, source.clone(), overrides)?.text;
        let read = Text::parse(&text).and_then(|parsed| {
            let study = document::study(&parsed)?;
            Ok((study.keys(&parsed), study.zip))
        });
        let (vary, zip) = match read {
            Ok(read) => read,
            Err(errors) => return Err(CaseErrors { name, source: text, errors }),
        };
        Ok(Base { name, directory: directory.to_owned(), source, overrides: overrides.to_vec(), vary, zip })
    }

    /// The text of the case with its overrides and without `[study]`.
    pub(crate) fn text(&self) -> Result<String, CaseErrors> {
        Ok(alone(&overridden(&self.name, self.source.clone(), &self.overrides)?.text))
    }

    /// The case with these overrides too.
    ///
    /// # Errors
    /// As [`Case::read`].
    pub(crate) fn case(&self, changes: &[String]) -> Result<Case, CaseErrors> {
        let overrides = [self.overrides.as_slice(), changes].concat();
        let output = PathBuf::from("result.zarr");
        let case = Case::from_text(&self.name, self.source.clone(), &self.directory, output, &overrides)?;
        Ok(Case { source: alone(&case.source), ..case })
    }
}

/// The text of a case without `[study]`: that of one run.
fn alone(text: &str) -> String {
    let Ok(mut document) = text.parse::<toml_edit::DocumentMut>() else { return text.to_owned() };
    match document.remove("study") {
        Some(_) => document.to_string(),
        None => text.to_owned(),
    }
}
