//! A case while it is written: what is wrong or found, at its line; its keys; what will be solved.

use std::collections::BTreeMap;
use std::path::Path;

use asperity_io::case::{Case, CaseError, CaseErrors, Entry, entries};
use asperity_io::output::write_all;
use asperity_io::store::Reader;
use asperity_io::study::{Study, StudyError};
use serde_json::{Value, json};

use super::action::Action;
use super::folder::Folder;
use crate::commands::check;

/// Cases of a study that are checked before it begins.
const CHECKED: usize = 20;

/// Faults, findings, keys and, with `cost`, what a run takes; `name` is the file of the case, which need not be saved. `vary` is
/// what a study of it varies.
pub fn checked(folder: &Folder, name: &str, text: &str, vary: &str, cost: bool) -> Result<Value, String> {
    let at = folder.path().join(name);
    let at = at.parent().unwrap_or(folder.path());
    let keys = entries(text).unwrap_or_default();
    let listed: Vec<_> = keys.iter().map(|entry| json!([entry.key, entry.value, entry.line])).collect();
    let mut told =
        json!({ "keys": listed, "faults": [], "findings": [], "outside": outside(folder, at, &keys) });
    match Case::parse(text, at, &[]).and_then(|case| Ok((case.examine()?, case))) {
        Err(errors) => told["faults"] = faults(&errors),
        Ok((examined, mut case)) => {
            name.clone_into(&mut case.name);
            if !keys.iter().any(|entry| entry.key == "output.path") {
                case.output.path =
                    Path::new(name).with_extension("zarr").file_name().unwrap_or_default().into();
            }
            let findings = examined.findings.iter().map(|finding| {
                // The first key that it names, else the table.
                let named =
                    keys.iter().find(|entry| finding.text.contains(&format!("`{}`", last(&entry.key))));
                json!({
                    "severity": finding.severity.as_str(), "text": finding.text, "code": finding.code,
                    "line": named.map(|entry| entry.line),
                })
            });
            told["findings"] = findings.collect();
            told["summary"] = json!(check::text(&case, &examined, cost));
            let checked = if cost { CHECKED } else { 0 };
            let of_case = keys.iter().find(|entry| entry.key.starts_with("study."));
            if let Some(Err(why)) = of_case.map(|_| runs_of(text, at, "", checked)) {
                told["faults"] = json!([{ "line": of_case.map(|entry| entry.line), "message": format!("[study]: {why}") }]);
            }
            if !vary.trim().is_empty() {
                told["study"] = match runs_of(text, at, vary, checked) {
                    Ok(runs) => json!({ "runs": runs }),
                    Err(why) => json!({ "error": why }),
                };
            }
        }
    }
    // Names of files as they are from the folder.
    let root = format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR);
    shorten(&mut told, &root);
    Ok(told)
}

/// The number of runs of a study.
fn runs_of(text: &str, at: &Path, vary: &str, checked: usize) -> Result<usize, String> {
    let vary: Vec<String> =
        Some(vary.to_owned()).filter(|vary| !vary.trim().is_empty()).into_iter().collect();
    Study::runs_of(text, at, &vary, checked).map_err(|error| match error {
        StudyError::Case(errors) => first(&errors),
        error => error.to_string(),
    })
}

/// The first of the errors, with its line.
fn first(errors: &CaseErrors) -> String {
    let Some(error) = errors.errors.first() else { return errors.to_string() };
    let line = error.line.map_or(String::new(), |line| format!("line {line}: "));
    let help = error.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
    format!("{line}{}{help}", error.message)
}

/// Refuses a run whose case is wrong, or that would go on with the result of another one.
pub fn ready(folder: &Folder, action: &Action) -> Result<(), String> {
    let Some([name, output]) = action.run() else { return Ok(()) };
    let path = folder.find(name)?;
    let at = path.parent().unwrap_or(folder.path());
    let root = format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR);
    let wrong = |why: String| format!("{name} cannot be run: {}", why.replace(&root, ""));
    match action {
        Action::Study { vary, .. } => {
            let text = std::fs::read_to_string(&path).map_err(|error| wrong(error.to_string()))?;
            runs_of(&text, at, vary, CHECKED).map(drop).map_err(wrong)
        }
        Action::Run { resume: true, .. } if folder.find(output).is_ok() => {
            match changed(folder, name, output) {
                Some(changes) if !changes.is_empty() => Err(format!(
                    "{name} has changed since {output}: {}; run it to a new result",
                    changes.join(", ")
                )),
                _ => Ok(()),
            }
        }
        _ => Case::read(&path, &[])
            .and_then(|case| case.examine())
            .map(drop)
            .map_err(|errors| wrong(first(&errors))),
    }
}

/// What differs between a case and that of a result; `None` where one of them cannot be read.
pub fn changed(folder: &Folder, case: &str, result: &str) -> Option<Vec<String>> {
    let now = std::fs::read_to_string(folder.find(case).ok()?).ok()?;
    let reader = Reader::open(&folder.find(result).ok()?).ok()?;
    Some(differences(&reader.header().case_text, &now))
}

/// The keys that differ; nothing where the texts are the same.
fn differences(before: &str, now: &str) -> Vec<String> {
    if before == now {
        return vec![];
    }
    let values = |text: &str| -> BTreeMap<String, String> {
        entries(text).unwrap_or_default().into_iter().map(|entry| (entry.key, entry.value)).collect()
    };
    let (old, new) = (values(before), values(now));
    let keys: std::collections::BTreeSet<_> = old.keys().chain(new.keys()).collect();
    let word = |value: Option<&String>| value.map_or("–", String::as_str).to_owned();
    let differ = keys.into_iter().filter(|key| old.get(*key) != new.get(*key));
    let found: Vec<String> =
        differ.map(|key| format!("{key}: {} → {}", word(old.get(key)), word(new.get(key)))).collect();
    if found.is_empty() { vec!["only comments, order or line ends".to_owned()] } else { found }
}

/// The case of a result: its text, the file in the folder that it is from, `ran` if that is known, and what has changed there.
pub fn origin(folder: &Folder, result: &str, ran: Option<String>) -> Result<Value, String> {
    let reader = Reader::open(&folder.find(result)?).map_err(|error| error.to_string())?;
    let text = &reader.header().case_text;
    if text.is_empty() {
        return Ok(Value::Null);
    }
    let usual = Path::new(result).with_extension("toml").to_string_lossy().into_owned();
    let is_same = |name: &String| changed(folder, name, result).is_some_and(|changes| changes.is_empty());
    let names = ran.into_iter().chain([usual]).filter(|name| folder.find(name).is_ok());
    let named: Vec<String> = names.collect();
    let same = named.iter().find(|name| is_same(name)).cloned();
    let name = same.or_else(|| folder.cases().into_iter().find(is_same)).or_else(|| named.into_iter().next());
    let changes = name.as_ref().and_then(|name| changed(folder, name, result));
    Ok(json!({ "case": name, "changed": changes, "text": text }))
}

/// Leaves the path of the folder out of all texts.
fn shorten(value: &mut Value, root: &str) {
    match value {
        Value::String(text) if text.contains(root) => *text = text.replace(root, ""),
        Value::Array(list) => list.iter_mut().for_each(|value| shorten(value, root)),
        Value::Object(object) => object.values_mut().for_each(|value| shorten(value, root)),
        _ => {}
    }
}

fn last(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}

/// Faults with their places in the units of scripts in browsers: 16 bits of a character.
fn faults(errors: &CaseErrors) -> Value {
    let place = |byte: usize| errors.source.get(..byte).map_or(0, |text| text.encode_utf16().count());
    let fault = |error: &CaseError| {
        json!({
            "from": error.span.as_ref().map(|span| place(span.start)),
            "to": error.span.as_ref().map(|span| place(span.end)),
            "line": error.line, "key": error.key, "message": error.message, "expected": error.expected,
            "help": error.help,
        })
    };
    errors.errors.iter().map(fault).collect()
}

/// The files outside of the folder that a case names: it may, as with `asperity run`, and the page says so.
fn outside(folder: &Folder, at: &Path, keys: &[Entry]) -> Vec<String> {
    let names_file = |entry: &&Entry| ["path", "file", "distribution"].contains(&last(&entry.key));
    let leads_out = |entry: &&Entry| {
        let path = at.join(&entry.value);
        let place = path.canonicalize().unwrap_or_else(|_| lexical(&path));
        entry.key != "output.path" && !place.starts_with(folder.path())
    };
    keys.iter().filter(names_file).filter(leads_out).map(|entry| entry.value.clone()).collect()
}

/// The path with each ".." taken with the folder before it.
fn lexical(path: &Path) -> std::path::PathBuf {
    path.components().fold(std::path::PathBuf::new(), |mut path, part| {
        match part {
            std::path::Component::ParentDir => {
                path.pop();
            }
            part => path.push(part),
        }
        path
    })
}

/// Where a run of a case stores its result: as the case says if that is inside of the folder and free, else a free name like it.
pub fn result_name(folder: &Folder, name: &str) -> Result<String, String> {
    let case = Case::read(&folder.find(name)?, &[])
        .map_err(|errors| format!("{name} cannot be run: {}", first(&errors)))?;
    let given = folder.path().join(&case.output.path);
    let relative = given.strip_prefix(folder.path()).ok().and_then(Path::to_str);
    let Some(relative) = relative.filter(|name| folder.free(name).is_ok()) else {
        return Err(format!(
            "`output.path` of {name} is {}, which is not in the folder; write a name without a folder there",
            case.output.path.display()
        ));
    };
    folder.free(relative)
}

/// Stores the text of a case that was `before` when the page read it; what has changed since is not replaced.
pub fn save(folder: &Folder, name: &str, text: &str, before: Option<&str>) -> Result<(), String> {
    if !name.to_lowercase().ends_with(".toml") {
        return Err(format!("{name} is no case: its name must end in .toml"));
    }
    let written =
        |path: &Path, force| write_all(path, force, text.as_bytes()).map_err(|error| error.to_string());
    let Some(before) = before else { return written(&folder.place(name)?, false) };
    let path = folder.find(name)?;
    let now = std::fs::read_to_string(&path).map_err(|error| format!("cannot read {name}: {error}"))?;
    match now == before {
        true => {
            let rights = path.metadata().map(|data| data.permissions());
            written(&path, true)?;
            let kept = rights.and_then(|rights| std::fs::set_permissions(&path, rights));
            kept.map_err(|error| format!("{name} is saved, but not with its rights: {error}"))
        }
        false => Err(format!(
            "{name} has changed since this page read it, here in another tab or in an editor; copy your text, then load the file again"
        )),
    }
}
