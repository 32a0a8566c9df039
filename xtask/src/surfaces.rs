//! Times and the picture of the surfaces' documentation (docs/surfaces.md, docs/dev/experiments.md).

use std::process::Command;

use super::{Done, cargo, root, run};

/// Reading, statistics and cleaning of 4096 x 4096 points.
pub fn bench() -> Done {
    run(&mut cargo(&["bench", "-p", "asperity-files", "--bench", "surfaces", "--", "4096"]))
}

/// The surface of `examples/ground-steel.toml`, prepared as there but for the window. Needs the command, built.
pub fn figure() -> Done {
    let steps = ["level=plane", "outliers=8 radius=2", "level=plane", "fill=harmonic"];
    let clean = root().join("target/figures/ground-steel.npz");
    run(Command::new(root().join("target/release/asperity"))
        .args(["surface", "process", "examples/data/ground-steel.x3p", "--force"])
        .args(steps.iter().flat_map(|step| ["--op", step]))
        .args(["--plot", "docs/images/ground-steel.png", "-o"])
        .arg(clean))
}
