//! What Cargo.lock says about the packages that the command and the Python package may be compiled from.

use std::collections::BTreeSet;
use std::path::Path;

/// Name and version.
pub type Package = (String, String);

/// What is handed out is compiled from these.
pub const HANDED_OUT: [&str; 2] = ["asperity-cli", "asperity-py"];

/// The packages of others that Cargo.lock leads to from what is handed out, on any system, those that only the compiler uses included. Packages
/// that only tests of the workspace use are not.
pub fn reached(root: &Path) -> Result<BTreeSet<Package>, String> {
    let read =
        |path: &Path| std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()));
    let lock = read(&root.join("Cargo.lock"))?;
    let entries: Vec<Entry> = lock.split("[[package]]").skip(1).map(Entry::parse).collect();
    let mut reached = BTreeSet::new();
    let mut waiting: Vec<&Entry> = entries.iter().filter(|entry| HANDED_OUT.contains(&entry.name)).collect();
    let mut members = BTreeSet::new();
    while let Some(entry) = waiting.pop() {
        let new = if entry.of_others {
            reached.insert((entry.name.to_owned(), entry.version.to_owned()))
        } else {
            members.insert(entry.name)
        };
        if !new {
            continue;
        }
        let manifest = match (entry.of_others, entry.name) {
            (true, _) => None,
            (false, "asperity-examples") => Some(read(&root.join("Cargo.toml"))?),
            (false, name) => Some(read(&root.join("crates").join(name).join("Cargo.toml"))?),
        };
        for dependency in &entry.dependencies {
            // A name, and its version where Cargo.lock has several.
            let (name, version) = dependency.split_once(' ').unwrap_or((dependency, ""));
            // Cargo.lock does not tell the dependencies of tests apart; those of packages of others are not in it.
            if manifest.as_ref().is_some_and(|manifest| !depends(manifest, name)) {
                continue;
            }
            waiting.extend(
                entries.iter().filter(|e| e.name == name && (version.is_empty() || e.version == version)),
            );
        }
    }
    Ok(reached)
}

/// A package of Cargo.lock.
struct Entry<'a> {
    name: &'a str,
    version: &'a str,
    of_others: bool,
    dependencies: Vec<&'a str>,
}

impl Entry<'_> {
    fn parse(text: &str) -> Entry<'_> {
        let value = |key: &str| {
            let line = text.lines().find_map(|line| line.strip_prefix(key));
            line.map_or("", |line| line.trim_matches(['"', ' ', '=']))
        };
        let list = text.split_once("dependencies = [").map_or("", |(_, list)| list);
        let dependencies = list.lines().map(|line| line.trim().trim_matches([',', '"', ']']));
        Entry {
            name: value("name"),
            version: value("version"),
            of_others: !value("source").is_empty(),
            dependencies: dependencies.filter(|line| !line.is_empty()).collect(),
        }
    }
}

/// Whether a manifest has this name among its dependencies, other than those of tests.
fn depends(manifest: &str, name: &str) -> bool {
    let mut inside = false;
    manifest.lines().any(|line| {
        if line.starts_with('[') {
            inside = line.ends_with("dependencies]")
                && !line.ends_with("dev-dependencies]")
                && !line.starts_with("[workspace");
        }
        inside && line.split(['.', ' ', '=']).next() == Some(name)
    })
}
