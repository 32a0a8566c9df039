//! `cargo xtask notices`: writes THIRD-PARTY-LICENSES.txt, the packages of others that are linked into the command and the Python
//! package, with their authors and the texts of their licences.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use crate::lock::{HANDED_OUT, Package, reached};
use crate::{Done, at, cargo, output, root};

/// The machines that a release is built for.
const TARGETS: [&str; 5] = [
    "x86_64-unknown-linux-gnu",
    "aarch64-unknown-linux-gnu",
    "aarch64-apple-darwin",
    "x86_64-apple-darwin",
    "x86_64-pc-windows-msvc",
];

const HEAD: &str = "\
Third-party software in asperity

Written by `cargo xtask notices`. The command `asperity` and the Python package asperity are linked with the packages of Rust
listed here: name and version, licence as an SPDX expression, authors as the package names them, and the numbers of the texts below.
Where a package may be taken under one of several licences, it is taken under Apache-2.0, or else under MIT. The source of each is at
https://crates.io/crates/NAME/VERSION. Also linked is the standard library of Rust, Copyright (c) The Rust Project Contributors,
MIT OR Apache-2.0 [1]. The font DejaVu Sans, the plotting library uPlot and the editor CodeMirror are contained under
LICENSE-DejaVu, LICENSE-uPlot and LICENSE-CodeMirror.

";

const LEFT_OUT: &str = "
Not contained, since they serve other systems, other features or the compiler alone:
";

pub fn notices() -> Done {
    let root = root();
    let linked = linked()?;
    let manifests = manifests()?;
    let mut texts = Texts::default();
    // The first text: most packages are taken under it.
    texts.number(&read(&root.join("LICENSE-APACHE"))?);
    let mit = read(&root.join("LICENSE-MIT"))?;
    let mut list = String::new();
    for package in &linked {
        let about = manifests.get(package).ok_or_else(|| format!("{package:?}: no manifest"))?;
        let numbers = texts_of(about, &mit, &mut texts)?;
        let numbers: Vec<String> = numbers.iter().map(|number| format!("[{number}]")).collect();
        let (name, version) = package;
        let line = [format!("{name} {version}"), expression(about), authors(about), numbers.join(" ")];
        writeln!(list, "{}", line.join(" | ")).expect("a text");
    }
    let left_out: Vec<String> =
        reached(&root)?.difference(&linked).map(|(name, version)| format!("{name} {version}")).collect();
    let mut out = format!("{HEAD}{list}{LEFT_OUT}{}\n", left_out.join("\n"));
    for (at, text) in texts.0.iter().enumerate() {
        write!(out, "\n{:=<100}\n[{}]\n\n{text}\n", "", at + 1).expect("a text");
    }
    let path = root.join("THIRD-PARTY-LICENSES.txt");
    std::fs::write(&path, out).map_err(at(&path))
}

/// The packages of others that are compiled into what is handed out, for any machine of a release.
fn linked() -> Result<BTreeSet<Package>, String> {
    let mut linked = BTreeSet::new();
    for target in TARGETS {
        let mut tree = cargo(&["tree", "--locked", "-e", "normal", "--prefix", "none", "--no-dedupe"]);
        tree.args(["-f", "{p}", "--target", target]);
        tree.args(HANDED_OUT.iter().flat_map(|name| ["-p", name]));
        for line in output(&mut tree)?.lines() {
            // `name v1.2.3`, perhaps with `(proc-macro)`; those of the workspace have their folder in brackets.
            let mut words = line.split(' ');
            if let (Some(name), Some(version)) = (words.next(), words.next())
                && !line.replace("(proc-macro)", "").contains('(')
            {
                linked.insert((name.to_owned(), version.trim_start_matches('v').to_owned()));
            }
        }
    }
    Ok(linked)
}

/// What cargo knows about each package.
fn manifests() -> Result<BTreeMap<Package, Value>, String> {
    let output = output(&mut cargo(&["metadata", "--locked", "--format-version", "1"]))?;
    let mut metadata: Value = serde_json::from_str(&output).map_err(|error| error.to_string())?;
    let Value::Array(packages) = metadata["packages"].take() else { return Err("no packages".into()) };
    let named = |package: Value| ((text(&package, "name"), text(&package, "version")), package);
    Ok(packages.into_iter().map(named).collect())
}

fn text(package: &Value, key: &str) -> String {
    package[key].as_str().unwrap_or_default().to_owned()
}

/// The licence. Old packages write a slash for OR.
fn expression(package: &Value) -> String {
    text(package, "license").replace(" / ", " OR ").replace('/', " OR ")
}

/// The authors, without their addresses.
fn authors(package: &Value) -> String {
    let names = package["authors"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let names = names.map(|name| name.split('<').next().unwrap_or_default().trim());
    names.filter(|name| !name.is_empty()).collect::<Vec<_>>().join(", ")
}

/// The numbers of the texts that go with a package.
fn texts_of(package: &Value, mit: &str, texts: &mut Texts) -> Result<BTreeSet<usize>, String> {
    let (name, expression) = (text(package, "name"), expression(package));
    let choice = expression.contains(" OR ");
    let apache = expression.contains("Apache-2.0");
    let mut numbers = BTreeSet::new();
    if apache {
        numbers.insert(1);
    }
    let mut permission = false;
    for path in licence_files(package)? {
        let file = path.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
        let not_taken = if apache {
            ["MIT", "ZLIB", "BSD", "BOOST", "LLVM", "UNLICENSE"].iter().any(|other| file.contains(other))
        } else {
            file == "UNLICENSE"
        };
        if choice && not_taken {
            continue;
        }
        let text = read(&path)?;
        permission |= text.contains("Permission is hereby granted");
        match before_apache(&text, &texts.0[0]) {
            Some("") => {}
            Some(before) => _ = numbers.insert(texts.number(before)),
            None => _ = numbers.insert(texts.number(&text)),
        }
    }
    if expression == "MIT" && !permission {
        // The package has no text: that of the licence, with its authors.
        let authors = match authors(package) {
            none if none.is_empty() => format!("the authors of {name}"),
            authors => authors,
        };
        let line =
            mit.lines().find(|line| line.starts_with("Copyright")).ok_or("LICENSE-MIT: no copyright")?;
        numbers.insert(texts.number(&mit.replace(line, &format!("Copyright (c) {authors}"))));
    }
    if numbers.is_empty() {
        return Err(format!("{name}: no text of its licence {expression}"));
    }
    Ok(numbers)
}

/// The files with licences and notices in a package, in order of their names.
fn licence_files(package: &Value) -> Result<BTreeSet<std::path::PathBuf>, String> {
    let manifest = text(package, "manifest_path");
    let folder = Path::new(&manifest).parent().ok_or("a manifest without a folder")?;
    let entries = std::fs::read_dir(folder).map_err(at(folder))?;
    let paths = entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file());
    let named = package["license_file"].as_str().map(|file| folder.join(file));
    let starts = ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"];
    let is_one = |path: &std::path::PathBuf| {
        let file = path.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
        starts.iter().any(|start| file.starts_with(start))
    };
    Ok(paths.filter(is_one).chain(named).collect())
}

/// Texts of licences, each once; the number of the first is 1.
#[derive(Default)]
struct Texts(Vec<String>);

impl Texts {
    /// The number of this text. Breaks of lines do not matter.
    fn number(&mut self, text: &str) -> usize {
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let found = self.0.iter().position(|known| words(known) == words(text));
        found.unwrap_or_else(|| {
            let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
            self.0.push(lines.join("\n").trim_matches('\n').to_owned());
            self.0.len() - 1
        }) + 1
    }
}

/// What stands before the terms of Apache-2.0 in this text, if these are all else that it says.
fn before_apache<'a>(text: &'a str, apache: &str) -> Option<&'a str> {
    let terms = |text: &str| {
        let (_, terms) = text.split_once("1. Definitions.")?;
        let (terms, _) = terms.split_once("additional liability.")?;
        Some(terms.split_whitespace().collect::<Vec<_>>().join(" "))
    };
    let same = terms(text).is_some_and(|found| Some(found) == terms(apache));
    let before = text.split("Apache License").next().unwrap_or_default();
    same.then_some(before.trim())
}

fn read(path: &Path) -> Result<String, String> {
    let bytes = std::fs::read(path).map_err(at(&path))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
