//! The results of two programs, bit by bit: `cargo xtask golden OLD NEW`.

use std::path::Path;
use std::process::Command;

use super::CASES;
use super::result::Stored;

/// The two programs, by their paths.
const PROGRAMS: [&str; 2] = ["ASPERITY_GOLDEN_OLD", "ASPERITY_GOLDEN_NEW"];

/// Says of each case what the two give, and fails where any bit differs.
#[test]
#[ignore = "compares two programs: cargo xtask golden OLD NEW"]
fn two_programs_give_the_same_bits() {
    let programs =
        PROGRAMS.map(|name| std::env::var_os(name).unwrap_or_else(|| panic!("{name} names no program")));
    let place = tempfile::tempdir().unwrap();
    let mut others = 0;
    for golden in CASES.iter() {
        let [old, new] = programs.each_ref().map(|program| {
            let result = place.path().join("result.zarr");
            let stored = result_of(Path::new(program), &golden.path, &result);
            let _ = std::fs::remove_dir_all(&result);
            stored
        });
        let said = match (old, new) {
            (Ok(old), Ok(new)) => old.compare(&new),
            (Err(old), Err(new)) => Some(format!("both fail: {old} / {new}")),
            (Err(error), _) => Some(format!("the old one fails: {error}")),
            (_, Err(error)) => Some(format!("the new one fails: {error}")),
        };
        others += usize::from(said.is_some());
        println!("{:<45} {}", golden.name, said.as_deref().unwrap_or("same bits"));
    }
    assert_eq!(others, 0, "{others} of {} cases differ", CASES.len());
}

fn result_of(program: &Path, case: &Path, result: &Path) -> Result<Stored, String> {
    let output =
        Command::new(program).args(["run", "--quiet", "--force", "-o"]).arg(result).arg(case).output();
    let output = output.unwrap_or_else(|error| panic!("{}: {error}", program.display()));
    match output.status.success() {
        true => Ok(Stored::read(result)),
        false => Err(String::from_utf8_lossy(&output.stderr).lines().next().unwrap_or_default().to_owned()),
    }
}
