//! Sections of docs/theory.md, by number and by title.

use crate::Fault;
use crate::paths::headings;
use crate::tree::{File, Tree};

const THEORY: &str = "docs/theory.md";
const NUMERICS: &str = "crates/asperity/src/";

/// Sections of the theory that do not exist, or that belong to another module than the one that cites them (the list at the
/// top of the theory names the modules of each section; a wrong number is mostly that of an older order). In Markdown a
/// whole number must say of which document it is; numbers with a point are those of books.
pub fn faults(tree: &Tree) -> Vec<Fault> {
    let theory = tree.files.iter().find(|file| file.path == THEORY).expect("docs/theory.md");
    let titles: Vec<&str> = headings(theory).collect();
    let mut found = Vec::new();
    for (n, line) in theory.text.lines().enumerate() {
        let modules = contents(line).map(|(_, modules)| modules).unwrap_or_default();
        let missing = |module: &&str| {
            let path = format!("{NUMERICS}{module}");
            !tree.paths.contains(&path) && !tree.paths.contains(&format!("{path}.rs"))
        };
        found.extend(modules.into_iter().filter(missing).map(|module| theory.fault(n, module)));
    }
    for file in &tree.files {
        let prose = file.prose().join("\n");
        let line = |at: usize| prose[..at].matches('\n').count();
        let markdown = file.path.ends_with(".md");
        for (at, word) in prose.to_ascii_lowercase().match_indices("section") {
            let of_theory = file.path == THEORY || cites(&prose[..at]);
            for number in numbers(&prose[at + word.len()..]) {
                let fault = match of_theory {
                    true if !titles.iter().any(|title| title.starts_with(&format!("{number}. "))) => {
                        format!("section {number}")
                    }
                    true if !belongs(theory, number, file) => {
                        format!("section {number} is not about this module, says the list in {THEORY}")
                    }
                    false if markdown => format!("section {number} of which document?"),
                    _ => continue,
                };
                found.push(file.fault(line(at), &fault));
            }
        }
        for (at, title) in quoted(&prose) {
            if !titles.iter().any(|known| known.contains(&title)) {
                found.push(file.fault(line(at), &format!("\"{title}\"")));
            }
        }
    }
    found
}

/// Number and modules of a line of the theory's contents: "5. [Marching in time](#...): `march`, `time`".
fn contents(line: &str) -> Option<(u32, Vec<&str>)> {
    let (number, rest) = line.split_once(". [")?;
    Some((number.parse().ok()?, rest.split('`').skip(1).step_by(2).collect()))
}

/// Whether the file is outside of the numerics, or of a module that the contents name for this section.
fn belongs(theory: &File, number: u32, file: &File) -> bool {
    let Some(path) = file.path.strip_prefix(NUMERICS) else { return true };
    let module = path.split(['/', '.']).next().unwrap_or_default();
    let listed = theory.text.lines().filter_map(contents).find(|(n, _)| *n == number);
    listed.is_none_or(|(_, modules)| modules.is_empty() || modules.contains(&module))
}

/// Whether the text before a section's number names the theory: "theory, ", "(docs/theory.md, ", "[theory](theory.md), ".
fn cites(before: &str) -> bool {
    let before = before.trim_end_matches([' ', ',', '\n', '(', ')', ';']);
    before.ends_with("theory") || before.ends_with("theory.md")
}

/// The whole numbers after "section": "s 3 to 5" gives 3, 4, 5; "s 2, 5 and 7" gives 2, 5, 7; " 3.2" none.
fn numbers(after: &str) -> Vec<u32> {
    let after = after.strip_prefix('s').unwrap_or(after);
    let mut found: Vec<u32> = Vec::new();
    let mut range = false;
    for word in after.split([' ', '\n']).filter(|word| !word.is_empty()) {
        let number = word.trim_end_matches([',', ';', ':', ')', '.', '"', '*']).parse();
        match (word, number) {
            ("to", _) => range = true,
            ("and" | "or", _) => {}
            (_, Ok(number)) => {
                match found.last() {
                    Some(first) if range => found.extend(first + 1..=number),
                    _ => found.push(number),
                }
                range = false;
            }
            _ => break,
        }
    }
    found
}

/// Titles in quotation marks right after the name of the theory, and where they begin.
fn quoted(prose: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (at, name) in prose.match_indices("theory.md") {
        let mut from = at + name.len();
        loop {
            let rest = prose[from..].trim_start_matches([' ', ',', '(', '\n', ')']);
            let start = prose.len() - rest.len();
            let Some((title, _)) = rest.strip_prefix('"').and_then(|title| title.split_once('"')) else {
                break;
            };
            found.push((start, title.split_whitespace().collect::<Vec<_>>().join(" ")));
            from = start + title.len() + 2;
        }
    }
    found
}
