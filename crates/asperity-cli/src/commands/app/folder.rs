//! The folder that the application works on. Names of files come from the browser: none leads out of it.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

use asperity_io::answer::{self, Units};
use asperity_io::curve::{Columns, Curves, Indentation};
use asperity_io::output;
use asperity_io::store::Reader;
use serde::Serialize;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::serve::Body;

/// Largest file that is taken or shown \[bytes\].
pub const LARGEST: u64 = 512 << 20;
/// Most entries of a list, and folders below one another.
const MOST: usize = 500;
const DEEPEST: usize = 3;
/// Results of a list that are opened, and answers of each.
const RESULTS: usize = 60;
const ANSWERS: usize = 3;
/// Of a case in a list this much is read [bytes].
const BEGINNING: u64 = 64 << 10;
/// Longest name of a file \[bytes\].
const LONGEST: usize = 200;

/// A folder, as its path without links.
#[derive(Clone)]
pub struct Folder {
    root: PathBuf,
    /// Names of files that are being taken.
    taken: Arc<Mutex<Vec<String>>>,
}

impl Folder {
    pub fn open(path: &Path) -> Result<Folder, Failure> {
        let failed = |why: &dyn std::fmt::Display| {
            Failure::input(format!("{} is no folder to work in: {why}", path.display()))
        };
        let root = path.canonicalize().map_err(|error| failed(&error))?;
        if root.is_dir() {
            Ok(Folder { root, taken: Arc::default() })
        } else {
            Err(failed(&"it is a file; name the folder that it is in"))
        }
    }

    pub fn path(&self) -> &Path {
        &self.root
    }

    /// The path of what has this name below the folder, without links.
    pub fn find(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.root.join(plain(name)?);
        let found = path.canonicalize().map_err(|error| match error.kind() {
            ErrorKind::NotFound => format!("there is no {name}"),
            _ => format!("cannot read {name}: {error}"),
        })?;
        // A pipe or a device would be waited for.
        match found.metadata() {
            Ok(data) if data.is_file() || data.is_dir() => self.inside(name, found),
            _ => Err(format!("{name} is neither a file nor a folder")),
        }
    }

    /// The path of a new file of this name, whose folder is there.
    pub fn place(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.root.join(plain(name)?);
        let (Some(parent), Some(last)) = (path.parent(), path.file_name()) else {
            return Err(format!("{name} is no name of a file"));
        };
        let parent = parent.canonicalize().map_err(|_| format!("the folder of {name} does not exist"))?;
        let place = self.inside(name, parent)?.join(last);
        match place.symlink_metadata() {
            Ok(_) => Err(format!("{name} exists already, and nothing is replaced here; choose another name")),
            Err(_) => Ok(place),
        }
    }

    /// A name that is free: "steel.x3p", else "steel-2.x3p", and so on.
    pub fn free(&self, name: &str) -> Result<String, String> {
        self.free_but(name, &[])
    }

    /// The same, but none of `others`.
    fn free_but(&self, name: &str, others: &[String]) -> Result<String, String> {
        let path = Path::new(plain(name)?);
        let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let (stem, ending) = (part(path.file_stem()), part(path.extension()));
        let ending = if ending.is_empty() { ending } else { format!(".{ending}") };
        let numbered = (2..1000).map(|n| path.with_file_name(format!("{stem}-{n}{ending}")));
        let mut names = std::iter::once(path.to_owned()).chain(numbered);
        let is_other = |name: &PathBuf| others.iter().any(|other| Path::new(other) == name);
        let free = names.find(|name| self.root.join(name).symlink_metadata().is_err() && !is_other(name));
        free.map(|name| name.to_string_lossy().into_owned())
            .ok_or_else(|| format!("{name} exists a thousand times"))
    }

    fn inside(&self, name: &str, path: PathBuf) -> Result<PathBuf, String> {
        match path.starts_with(&self.root) {
            true => Ok(path),
            false => Err(format!("{name} leads out of the folder, and only what is in it is shown")),
        }
    }

    /// Takes a file that a browser sends, beside what is there; returns its name.
    pub fn take(&self, name: &str, length: u64, mut body: Body<'_>) -> Result<String, String> {
        if length > LARGEST {
            let [given, most] = [length, LARGEST].map(|bytes| crate::format::bytes(bytes as f64));
            return Err(format!("{name} has {given}, but may have {most}; copy it into the folder yourself"));
        }
        if plain(name)?.contains(['/', '\\']) {
            return Err(format!("{name} is no name of a file"));
        }
        let taken = || self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let name = {
            let mut taken = taken();
            let name = self.free_but(name, &taken)?;
            taken.push(name.clone());
            name
        };
        let place = self.place(&name);
        let copied = place.and_then(|place| {
            let copied = output::write(&place, false, |file| std::io::copy(&mut body, file).map(drop));
            copied.map_err(|error| format!("{name} was not stored: {error}"))
        });
        taken().retain(|other| *other != name);
        copied.map(|()| name)
    }

    /// Cases, results, studies and other files, the latest first, results with their answers.
    pub fn list(&self) -> Value {
        let mut found = vec![];
        self.walk(&self.root, 0, &mut found);
        // Where there are too many, data are left out first.
        found.sort_by_key(|entry| (entry.kind == Kind::File, std::cmp::Reverse(entry.modified)));
        found.truncate(MOST);
        found.sort_by_key(|entry| std::cmp::Reverse(entry.modified));
        let mut results = 0;
        let shown = found.into_iter().map(|Entry { name, place, kind, .. }| {
            results += usize::from(kind == Kind::Result);
            let mut entry = match kind {
                Kind::Result if results <= RESULTS => of_result(&place),
                Kind::Case => json!({ "title": title(&place) }),
                _ => json!({}),
            };
            entry["name"] = json!(name);
            let is_block = kind == Kind::Case && !has_tables(&place);
            entry["kind"] = if is_block { json!("block") } else { json!(kind) };
            entry
        });
        shown.collect()
    }

    /// The names of the cases.
    pub fn cases(&self) -> Vec<String> {
        let mut found = vec![];
        self.walk(&self.root, 0, &mut found);
        found.into_iter().filter(|entry| entry.kind == Kind::Case).map(|entry| entry.name).collect()
    }

    fn walk(&self, folder: &Path, depth: usize, found: &mut Vec<Entry>) {
        for entry in folder.read_dir().into_iter().flatten().flatten() {
            let path = entry.path();
            let name =
                path.strip_prefix(&self.root).ok().and_then(Path::to_str).map(|name| name.replace('\\', "/"));
            let Some(name) = name else { continue };
            // What leads out of the folder is not shown.
            let Ok(place) = self.find(&name) else { continue };
            let kind = kind(&place);
            if matches!(kind, Kind::Folder | Kind::Study)
                && depth < DEEPEST
                && found.len() < 2 * MOST
                && !path.is_symlink()
            {
                self.walk(&path, depth + 1, found);
            }
            if !matches!(kind, Kind::Folder | Kind::Dataset) {
                let modified = place.metadata().and_then(|data| data.modified()).ok();
                found.push(Entry { modified, name, place, kind });
            }
        }
    }

    /// What a file is shown as: "case", "block" (of a material), "material", "indentation", "surface".
    pub fn kind_of(&self, name: &str) -> Result<&'static str, String> {
        let path = self.find(name)?;
        Ok(match kind(&path) {
            Kind::Folder | Kind::Dataset => return Err(format!("{name} is a folder")),
            Kind::Result => "result",
            Kind::Study => "study",
            Kind::Case if !has_tables(&path) => "block",
            Kind::Case => "case",
            Kind::File if is_picture(&path) => "picture",
            Kind::File if Curves::kind_of(&path, None).is_ok() => "material",
            Kind::File if Indentation::read(&path, &Columns::default()).is_ok() => "indentation",
            Kind::File => "surface",
        })
    }
}

struct Entry {
    modified: Option<SystemTime>,
    name: String,
    place: PathBuf,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Case,
    Result,
    Study,
    /// The table of a study for xarray.
    Dataset,
    Folder,
    File,
}

fn kind(path: &Path) -> Kind {
    let ends_with = |ending: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
    match path.is_dir() {
        true if asperity_io::study::is_dataset(path) => Kind::Dataset,
        true if path.join("zarr.json").is_file() => Kind::Result,
        true if path.join("study.json").is_file() => Kind::Study,
        true => Kind::Folder,
        false if ends_with("toml") => Kind::Case,
        false => Kind::File,
    }
}

fn is_picture(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    ["png", "svg", "gif", "html", "pdf", "jpg"].contains(&ending.as_str())
}

/// The title of a case, from its line.
fn title(path: &Path) -> Option<String> {
    let text = beginning(path);
    let line = text.lines().find_map(|line| line.strip_prefix("title = "))?;
    Some(line.split('"').nth(1).unwrap_or(line).to_owned())
}

/// Whether a file of TOML has tables in brackets, as cases have, and not the block of a material.
fn has_tables(path: &Path) -> bool {
    beginning(path).lines().any(|line| line.trim_start().starts_with('['))
}

/// The first part of a text.
fn beginning(path: &Path) -> String {
    let mut text = vec![];
    let read = File::open(path).and_then(|file| file.take(BEGINNING).read_to_end(&mut text));
    read.map_or(String::new(), |_| String::from_utf8_lossy(&text).into_owned())
}

/// State and first answers of a result.
fn of_result(path: &Path) -> Value {
    let Ok(reader) = Reader::open(path) else {
        return json!({ "state": "cannot be read" });
    };
    let units = Units::of(&reader, &Units::default());
    let answers = answer::of(&reader, &units).unwrap_or_default();
    let words = |answer: &answer::Answer| match answer.name.as_str() {
        // Between which rows.
        "tight_from" => format!("{} ({})", answer.words(&units), answer.note),
        _ => answer.words(&units),
    };
    let words = |answer: &answer::Answer| json!([answer.label(), answer.validity.mark(words(answer))]);
    let words = answers.iter().take(ANSWERS).map(words);
    json!({
        "title": reader.header().title,
        "state": reader.state(),
        "rows": reader.len(),
        "answers": words.collect::<Vec<_>>(),
        "is_case": !reader.header().case_text.is_empty(),
    })
}

/// A relative path of ordinary names, none of them hidden.
fn plain(name: &str) -> Result<&str, String> {
    let is_plain = |part: Component<'_>| match part {
        Component::Normal(part) => !part.to_string_lossy().starts_with('.'),
        _ => false,
    };
    let clean = !name.contains(|c: char| crate::messages::hidden(c) || c == '\n' || c == '\t' || c == '\0');
    match !name.is_empty() && name.len() <= LONGEST && clean && Path::new(name).components().all(is_plain) {
        true => Ok(name),
        false => Err(format!(
            "{name:?} is no name of a file below the folder: no \"..\", no hidden files, no path from the root"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, Folder) {
        let directory = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(directory.path().join("work/sub")).unwrap();
        std::fs::write(directory.path().join("secret.toml"), "title = \"secret\"").unwrap();
        std::fs::write(directory.path().join("work/a.toml"), "title = \"a\"").unwrap();
        let folder = Folder::open(&directory.path().join("work")).unwrap();
        (directory, folder)
    }

    #[test]
    fn no_name_leads_out_of_the_folder() {
        let (directory, folder) = folder();
        let secret = directory.path().join("secret.toml");
        for name in [
            "../secret.toml",
            "sub/../../secret.toml",
            secret.to_str().unwrap(),
            "",
            ".",
            "..",
            ".hidden",
            "a\nb",
        ] {
            assert!(
                folder.find(name).is_err() && folder.place(name).is_err() && folder.free(name).is_err(),
                "{name}"
            );
        }
        assert!(folder.find("a.toml").is_ok() && folder.place("sub/b.toml").is_ok());
        assert!(folder.place("a.toml").unwrap_err().contains("exists already"));
        assert_eq!(folder.free("a.toml").unwrap(), "a-2.toml");
    }

    #[cfg(unix)]
    #[test]
    fn links_do_not_lead_out_either() {
        use std::os::unix::fs::symlink;
        let (directory, folder) = folder();
        symlink(directory.path(), folder.path().join("up")).unwrap();
        symlink(directory.path().join("secret.toml"), folder.path().join("link.toml")).unwrap();
        symlink(directory.path().join("new.toml"), folder.path().join("dangling.toml")).unwrap();
        symlink(folder.path().join("a.toml"), folder.path().join("inside.toml")).unwrap();
        assert!(folder.find("up/secret.toml").unwrap_err().contains("leads out"));
        assert!(folder.find("link.toml").unwrap_err().contains("leads out"));
        assert!(folder.place("up/new.toml").unwrap_err().contains("leads out"));
        assert!(folder.place("dangling.toml").is_err(), "a link to nowhere is no place for a file");
        assert!(folder.find("inside.toml").is_ok());
        let list = folder.list().to_string();
        assert!(list.contains("a.toml") && list.contains("inside.toml"), "{list}");
        assert!(!list.contains("link.toml") && !list.contains("secret"), "{list}");
    }
}
