//! `cargo xtask lines`: product lines of Rust and Python by crate and by folder.
//!
//! A product line is neither blank nor comment nor docstring nor test. Files of tests, benches, examples and fuzz targets do not
//! count, nor does a file of Rust from its module of tests on.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use crate::{Done, output, root};

/// Folders that hold no product.
const OTHERS: [&str; 4] = ["tests", "benches", "fuzz", "examples"];

/// What lies in a crate beside its folders.
const FILES: &str = "(files)";

pub fn lines() -> Done {
    let listed = output(Command::new("git").args(["ls-files", "*.rs", "*.py"]).current_dir(root()))?;
    let mut table: BTreeMap<(&str, &str), [usize; 2]> = BTreeMap::new();
    for path in listed.lines().filter(|path| is_product(path)) {
        // A file that is deleted but not committed has no lines.
        let text = std::fs::read(root().join(path)).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let counts = table.entry(place(path, &listed)).or_default();
        match path.ends_with(".rs") {
            true => counts[0] += of_rust(&text),
            false => counts[1] += of_python(&text),
        }
    }
    println!("{:<22}{:<22}{:>8}{:>8}", "crate", "folder below src", "Rust", "Python");
    let mut all = [0; 2];
    let crates: Vec<&str> = table.keys().map(|(name, _)| *name).collect();
    for name in crates.chunk_by(|a, b| a == b).map(|equal| equal[0]) {
        let mut sum = [0; 2];
        for ((_, folder), counts) in table.iter().filter(|((of, _), _)| *of == name) {
            println!("{:<22}{folder:<22}{:>8}{:>8}", "", counts[0], counts[1]);
            (0..2).for_each(|n| sum[n] += counts[n]);
        }
        println!("{name:<44}{:>8}{:>8}", sum[0], sum[1]);
        (0..2).for_each(|n| all[n] += sum[n]);
    }
    println!("{:<44}{:>8}{:>8}", "total", all[0], all[1]);
    Ok(())
}

fn is_product(path: &str) -> bool {
    let name = path.rsplit('/').next().unwrap_or(path);
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let is_test = ["test_", "tests_", "conftest"].iter().any(|start| name.starts_with(start))
        || ["test", "tests"].contains(&stem)
        || ["_test", "_tests"].iter().any(|end| stem.ends_with(end));
    !is_test && !path.split('/').any(|part| OTHERS.contains(&part))
}

/// Crate and first folder below its `src` of a file; of a file beside a folder of its name that folder.
fn place<'a>(path: &'a str, listed: &str) -> (&'a str, &'a str) {
    let path = path.strip_prefix("crates/").unwrap_or(path);
    let (name, rest) = path.split_once('/').unwrap_or((path, ""));
    let rest = rest.strip_prefix("src/").unwrap_or(rest);
    let folder = match rest.split_once('/') {
        Some((folder, _)) => folder,
        None => {
            let stem = Path::new(rest).file_stem().and_then(|stem| stem.to_str()).unwrap_or(rest);
            let below = format!("{name}/src/{stem}/");
            if listed.contains(&below) { stem } else { FILES }
        }
    };
    (name, folder)
}

fn of_rust(text: &str) -> usize {
    let lines: Vec<&str> = text.lines().collect();
    let opens_tests = |n: usize| {
        let after = lines[n + 1..].iter().find(|line| !line.starts_with("#["));
        lines[n].trim_end() == "#[cfg(test)]"
            && after.is_some_and(|line| line.starts_with("mod ") && line.ends_with('{'))
    };
    let end = (0..lines.len()).find(|n| opens_tests(*n)).unwrap_or(lines.len());
    let product = without(&lines[..end].join("\n"), &[("/*", "*/")]);
    product.lines().filter(|line| !line.trim().is_empty() && !line.trim_start().starts_with("//")).count()
}

fn of_python(text: &str) -> usize {
    let product = without(text, &[("\"\"\"", "\"\"\""), ("'''", "'''")]);
    product.lines().filter(|line| !line.trim().is_empty() && !line.trim_start().starts_with('#')).count()
}

/// The text without what stands between these pairs, and the pairs themselves.
fn without(text: &str, pairs: &[(&str, &str)]) -> String {
    let mut rest = text;
    let mut kept = String::new();
    loop {
        let first = pairs.iter().filter_map(|(open, close)| Some((rest.find(open)?, open, close))).min();
        let Some((start, open, close)) = first else { break };
        let Some(length) = rest[start + open.len()..].find(close) else { break };
        kept += &rest[..start];
        rest = &rest[start + open.len() + length + close.len()..];
    }
    kept + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_docstrings_blanks_and_tests_do_not_count() {
        let rust = "//! Title.\n\n/* two\nlines */\nfn f() {\n    // why\n    g(); // counts\n}\n\n#[cfg(test)]\nmod tests {\n}\n";
        assert_eq!(of_rust(rust), 3);
        assert_eq!(of_rust("#[cfg(test)]\nmod tests;\nfn f() {}\n"), 3, "tests in a file of their own");
        assert_eq!(of_python("\"\"\"Title.\n\nMore.\"\"\"\nimport x\n\n# why\nx.y()  # counts\n"), 2);
    }

    #[test]
    fn files_have_a_crate_and_a_folder() {
        let path = |words: &str| words.replace(' ', "/");
        let listed = ["crates a src load.rs", "crates a src load programme.rs", "crates a src lib.rs"];
        let listed = listed.map(path).join("\n");
        let of = |words: &str| {
            let path = path(words);
            let (name, folder) = place(&path, &listed);
            (name.to_owned(), folder.to_owned())
        };
        let is = |name: &str, folder: &str| (name.to_owned(), folder.to_owned());
        assert_eq!(of("crates a src load programme.rs"), is("a", "load"));
        assert_eq!(of("crates a src load.rs"), is("a", "load"));
        assert_eq!(of("crates a src lib.rs"), is("a", FILES));
        assert_eq!(of("crates a python a _b.py"), is("a", "python"));
        assert!(
            is_product(&path("crates a src latest.rs")) && !is_product(&path("crates a src load tests.rs"))
        );
        assert!(!is_product(&path("fuzz src lib.rs")) && !is_product(&path("crates a src x test_y.py")));
    }
}
