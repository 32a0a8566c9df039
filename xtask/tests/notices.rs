//! THIRD-PARTY-LICENSES.txt and Cargo.lock have the same packages.

use std::collections::BTreeSet;
use std::path::Path;

#[path = "../src/lock.rs"]
mod lock;

#[test]
fn the_notices_have_the_packages_of_the_lock_file() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let notices = std::fs::read_to_string(root.join("THIRD-PARTY-LICENSES.txt")).expect("the notices");
    // The texts of licences begin with a line of "=".
    let list = notices.split("\n====").next().expect("a list");
    let named: BTreeSet<lock::Package> = list
        .lines()
        .filter_map(|line| line.split(" | ").next()?.split_once(' '))
        .filter(|(_, version)| !version.contains(' ') && version.starts_with(|c: char| c.is_ascii_digit()))
        .map(|(name, version)| (name.to_owned(), version.to_owned()))
        .collect();
    let expected = lock::reached(&root).expect("Cargo.lock");
    let differ: Vec<_> = named.symmetric_difference(&expected).collect();
    assert!(expected.len() > 100, "{expected:?}");
    assert!(differ.is_empty(), "Cargo.lock changed: run `cargo xtask notices`. {differ:?}");
}
