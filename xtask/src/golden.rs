//! The results of two programs, bit by bit, on the cases of `crates/asperity-io/tests/all/golden`.

use std::path::absolute;

use crate::{Done, cargo, run};

/// Runs all cases with both programs; what they give is compared by an ignored test, which can read results.
pub(crate) fn golden(programs: &[String]) -> Done {
    let [old, new] = programs else {
        return Err("golden takes two programs: cargo xtask golden OLD NEW".into());
    };
    let path = |program: &String| absolute(program).map_err(|error| format!("{program}: {error}"));
    run(cargo(&["test", "--quiet", "-p", "asperity-io", "--test", "all", "--"])
        .args(["golden::programs::two_programs", "--ignored", "--nocapture"])
        .env("ASPERITY_GOLDEN_OLD", path(old)?)
        .env("ASPERITY_GOLDEN_NEW", path(new)?))
}
