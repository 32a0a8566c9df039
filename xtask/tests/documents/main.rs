//! Documents and comments are followed: every path, link, section number and name in them must exist.
//!
//! Text moves more often than the references to it. These tests read the documents (Markdown) and the comments of the
//! sources, and list each reference that leads nowhere, with file and line.

mod names;
mod paths;
mod sections;
mod tree;

use tree::Tree;

/// A reference that leads nowhere: "file:line: what".
type Fault = String;

fn assert_none(faults: &[Fault]) {
    assert!(faults.is_empty(), "{} references lead nowhere:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn every_path_exists() {
    assert_none(&paths::faults(&Tree::of_the_repository()));
}

#[test]
fn every_link_has_its_file_and_heading() {
    assert_none(&paths::link_faults(&Tree::of_the_repository()));
}

#[test]
fn every_section_of_the_theory_exists() {
    assert_none(&sections::faults(&Tree::of_the_repository()));
}

#[test]
fn every_name_of_the_code_exists() {
    assert_none(&names::faults(&Tree::of_the_repository()));
}

/// What the tests above are worth: each kind of wrong reference is found, and no right one is.
#[test]
fn wrong_references_are_found() {
    let theory = "# Theory\n\n1. [The contact](#1-the-contact): `contact`\n\n## 1. The contact\n\n## 2. Energy and work\n\n\
                  See section 2.\n";
    let right = "See [theory](theory.md), sections 1 and 2, [energy](theory.md#2-energy-and-work), `part.rs`,\n\
                 `crates/a/src/part.rs`, `a::solve` and Johnson 1985, section 3.2.\n";
    let code = "//! The contact (docs/theory.md, section\n//! 2, \"Energy and work\"), as `part.rs` has it.\npub fn solve() {}\n";
    let tree = |docs: &str, code: &str, march: &str| {
        Tree::of_files([
            ("docs/theory.md", theory),
            ("docs/a.md", docs),
            ("crates/a/src/part.rs", code),
            ("crates/asperity/src/contact/mod.rs", "//! theory, section 1"),
            ("crates/asperity/src/march.rs", march),
        ])
    };
    let all = |docs: &str, code: &str| {
        // The same comment in a module that the theory's list does not have.
        let tree = tree(docs, code, if code.starts_with("// march") { code } else { "" });
        [paths::faults(&tree), paths::link_faults(&tree), sections::faults(&tree), names::faults(&tree)]
            .concat()
    };
    assert_none(&all(right, code));
    for (wrong, fault) in [
        ("in `crates/a/src/gone.rs`\n", "docs/a.md:1: crates/a/src/gone.rs"),
        ("\nin `gone.rs`\n", "docs/a.md:2: gone.rs"),
        ("in `data/*.json`\n", "docs/a.md:1: data/*.json"),
        ("[a](gone.md)\n", "docs/a.md:1: gone.md"),
        ("[a](theory.md#3-flow)\n", "docs/a.md:1: theory.md#3-flow"),
        ("theory, sections 1 to 3\n", "docs/a.md:1: section 3"),
        ("[theory.md](theory.md),\nsection 4\n", "docs/a.md:2: section 4"),
        ("as section 2 says\n", "docs/a.md:1: section 2 of which document?"),
        ("in `a::gone`\n", "docs/a.md:1: a::gone"),
    ] {
        let found = all(&format!("{wrong}\n{right}"), code);
        assert!(found.iter().any(|found| found == fault), "{wrong}: {found:?}");
    }
    for (wrong, fault) in [
        ("// theory section 5\n", "crates/a/src/part.rs:1: section 5"),
        ("// docs/theory.md, \"Dents\"\n", "crates/a/src/part.rs:1: \"Dents\""),
        (
            "// march: theory, section 1\n",
            "crates/asperity/src/march.rs:1: section 1 is not about this module, says the list in docs/theory.md",
        ),
        ("// tests/gone.rs\n", "crates/a/src/part.rs:1: tests/gone.rs"),
    ] {
        let found = all(right, &format!("{wrong}{code}"));
        assert!(found.iter().any(|found| found == fault), "{wrong}: {found:?}");
    }
}
