//! Names of the code in Markdown: `march::Checkpoint`, `field::sweep`.

use std::collections::HashSet;

use crate::Fault;
use crate::tree::Tree;

/// Rust paths in backticks with a part that no source has as a word.
pub fn faults(tree: &Tree) -> Vec<Fault> {
    let sources = tree.files.iter().filter(|file| file.path.ends_with(".rs"));
    let mut known: HashSet<&str> = sources.flat_map(|file| words(&file.text)).collect();
    // Crates are folders; their names in code have no hyphens.
    let crates: Vec<String> = tree
        .paths
        .iter()
        .filter_map(|path| path.strip_prefix("crates/"))
        .map(|name| name.replace('-', "_"))
        .collect();
    known.extend(crates.iter().map(String::as_str));
    let mut found = Vec::new();
    for file in tree.files.iter().filter(|file| file.path.ends_with(".md")) {
        for (n, line) in file.prose().iter().enumerate() {
            // Every second piece between backticks is code.
            for name in line.split('`').skip(1).step_by(2).filter(|code| is_path(code)) {
                if !words(name).all(|word| known.contains(word)) {
                    found.push(file.fault(n, name));
                }
            }
        }
    }
    found
}

/// `a::b`, `A::b(x)`.
fn is_path(code: &str) -> bool {
    let path = code.split(['(', '<', ' ']).next().unwrap_or_default();
    path.contains("::") && path.chars().all(|c| c.is_alphanumeric() || c == '_' || c == ':')
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|word| !word.is_empty())
}
