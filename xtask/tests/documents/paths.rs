//! Paths of files and folders, and links of Markdown.

use crate::Fault;
use crate::tree::{File, Tree, ending_of};

/// Endings of the files of a repository, as opposed to those that users have.
const OURS: [&str; 8] = ["rs", "md", "py", "pyi", "js", "json", "html", "ipynb"];

/// Paths that do not exist. A path that begins with a folder of the root is followed everywhere; one that does
/// not, only in prose, from the folder of its file, those above it, and their `src`.
pub fn faults(tree: &Tree) -> Vec<Fault> {
    let mut found = Vec::new();
    for file in &tree.files {
        let prose = file.prose();
        for (n, line) in file.text.lines().enumerate() {
            for path in tokens(line).filter(|path| from_root(tree, path)) {
                if !exists(tree, "", path) {
                    found.push(file.fault(n, path));
                }
            }
            for path in tokens(&prose[n]).filter(|path| !from_root(tree, path) && is_ours(path)) {
                if !resolves(tree, file, path) {
                    found.push(file.fault(n, path));
                }
            }
        }
    }
    found
}

/// Words that may be paths.
fn tokens(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !(c.is_alphanumeric() || "_./*-".contains(c)))
        .map(|token| token.trim_end_matches(['.', '/', '-']))
}

fn from_root(tree: &Tree, path: &str) -> bool {
    let Some((first, rest)) = path.split_once('/') else { return false };
    // `docs/*.md`, but neither `target/...`, which is built, nor a fraction such as `crates/`.
    !rest.is_empty() && !first.is_empty() && tree.paths.contains(first) && first != "tests"
}

fn is_ours(path: &str) -> bool {
    let ending = ending_of(path);
    let stem = path.rsplit('/').next().unwrap_or(path).strip_suffix(ending).unwrap_or(path);
    let bare = !path.contains('/');
    OURS.contains(&ending)
        && !path.starts_with("target/")
        && !stem.trim_end_matches('.').is_empty()
        && stem != "NAME."
        && (!bare || ending == "rs" || ending == "md")
}

/// Whether the path leads to a file from the file's folder, one above it, or the `src` of one; a bare name, to any.
fn resolves(tree: &Tree, file: &File, path: &str) -> bool {
    if !path.contains('/') && tree.paths.iter().any(|known| known.rsplit('/').next() == Some(path)) {
        return true;
    }
    let mut folder = file.folder();
    loop {
        if exists(tree, folder, path) || exists(tree, &join(folder, "src"), path) {
            return true;
        }
        if folder.is_empty() {
            return false;
        }
        folder = folder.rsplit_once('/').map_or("", |(above, _)| above);
    }
}

/// Whether the path leads to a file or folder from `folder`; of a pattern with a star, the folder before it.
fn exists(tree: &Tree, folder: &str, path: &str) -> bool {
    let path = path
        .split_once('*')
        .map_or(path, |(before, _)| before.rsplit_once('/').map_or("", |(fixed, _)| fixed));
    let joined = join(folder, path);
    joined.is_empty() || tree.paths.contains(&joined)
}

/// The path from the root, `.` and `..` followed.
fn join(folder: &str, path: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(path.split('/')) {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()),
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

/// Links of Markdown whose file or heading does not exist.
pub fn link_faults(tree: &Tree) -> Vec<Fault> {
    let mut found = Vec::new();
    for file in tree.files.iter().filter(|file| file.path.ends_with(".md") || file.path.ends_with(".ipynb")) {
        let lines = if file.path.ends_with(".md") {
            file.prose()
        } else {
            file.text.lines().map(Into::into).collect()
        };
        for (n, line) in lines.iter().enumerate() {
            for (at, _) in line.match_indices("](") {
                let target = &line[at + 2..];
                let target = &target[..target.find([')', ' ']).unwrap_or(target.len())];
                if !target.is_empty() && !target.contains("://") && !leads(tree, file, target) {
                    found.push(file.fault(n, target));
                }
            }
        }
    }
    found
}

fn leads(tree: &Tree, file: &File, target: &str) -> bool {
    let (path, heading) =
        target.split_once('#').map_or((target, None), |(path, heading)| (path, Some(heading)));
    let path = if path.is_empty() { file.path.clone() } else { join(file.folder(), path) };
    let has = |heading: &str| {
        let document = tree.files.iter().find(|file| file.path == path);
        document.is_some_and(|document| headings(document).any(|title| anchor(title) == heading))
    };
    tree.paths.contains(&path) && heading.is_none_or(has)
}

/// Titles of a document.
pub fn headings(document: &File) -> impl Iterator<Item = &str> {
    let titles = document.text.lines().filter(|line| line.starts_with('#'));
    titles.map(|line| line.trim_start_matches('#').trim())
}

/// The anchor that GitHub makes of a title.
fn anchor(title: &str) -> String {
    let kept = title.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}
