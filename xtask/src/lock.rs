//! What Cargo.lock says about the packages that the command and the Python package may be compiled from.

use std::collections::BTreeSet;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

/// Name and version.
pub type Package = (String, String);

/// What is handed out is compiled from these.
pub const HANDED_OUT: [&str; 2] = ["asperity-cli", "asperity-py"];

#[derive(Deserialize)]
struct Lock {
    package: Vec<Entry>,
}

/// A package of Cargo.lock; those of the workspace have no source.
#[derive(Deserialize)]
struct Entry {
    name: String,
    version: String,
    source: Option<String>,
    /// Names, each with its version where Cargo.lock has several.
    #[serde(default)]
    dependencies: Vec<String>,
}

/// The packages of others that Cargo.lock leads to from what is handed out, on any system, those that only the compiler uses included. Packages
/// that only tests of the workspace use are not.
pub fn reached(root: &Path) -> Result<BTreeSet<Package>, String> {
    let entries = read::<Lock>(&root.join("Cargo.lock"))?.package;
    let mut waiting: Vec<&Entry> =
        entries.iter().filter(|entry| HANDED_OUT.contains(&entry.name.as_str())).collect();
    let (mut seen, mut reached) = (BTreeSet::new(), BTreeSet::new());
    while let Some(entry) = waiting.pop() {
        let package = (entry.name.clone(), entry.version.clone());
        if !seen.insert(package.clone()) {
            continue;
        }
        // Cargo.lock does not tell the dependencies of tests apart; those of packages of others are not in it.
        let manifest = match (&entry.source, entry.name.as_str()) {
            (Some(_), _) => None,
            (None, "asperity-examples") => Some(read(&root.join("Cargo.toml"))?),
            (None, name) => Some(read(&root.join("crates").join(name).join("Cargo.toml"))?),
        };
        if entry.source.is_some() {
            reached.insert(package);
        }
        for dependency in &entry.dependencies {
            let (name, version) = dependency.split_once(' ').unwrap_or((dependency, ""));
            if manifest.as_ref().is_none_or(|manifest| depends(manifest, name)) {
                let is_it = |e: &&Entry| e.name == name && (version.is_empty() || e.version == version);
                waiting.extend(entries.iter().filter(is_it));
            }
        }
    }
    Ok(reached)
}

fn read<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Whether a manifest has this name among its dependencies, on any system, other than those of tests.
fn depends(manifest: &Table, name: &str) -> bool {
    let targets = manifest.get("target").and_then(Value::as_table).into_iter().flat_map(Table::values);
    let all = targets.filter_map(Value::as_table).chain([manifest]);
    { all }.any(|table| {
        let lists = ["dependencies", "build-dependencies"];
        lists.iter().filter_map(|list| table.get(*list)).any(|list| list.get(name).is_some())
    })
}
