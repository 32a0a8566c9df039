//! `cargo xtask workflows`: the files that a Git forge and archives read, against their schemas, and the workflows by a linter.

use std::process::Command;

use crate::{Done, python_in, root, run};

/// Schema, as check-jsonschema calls it, and files.
const SCHEMAS: [(&str, &[&str]); 5] = [
    (
        "vendor.github-workflows",
        &[".github/workflows/test.yml", ".github/workflows/release.yml", ".github/workflows/site.yml"],
    ),
    ("vendor.dependabot", &[".github/dependabot.yml"]),
    (
        "vendor.github-issue-forms",
        &[
            ".github/ISSUE_TEMPLATE/bug.yml",
            ".github/ISSUE_TEMPLATE/feature.yml",
            ".github/ISSUE_TEMPLATE/format.yml",
        ],
    ),
    ("vendor.github-issue-config", &[".github/ISSUE_TEMPLATE/config.yml"]),
    ("vendor.citation-file-format", &["CITATION.cff"]),
];

pub fn workflows() -> Done {
    let python = python_in("target/workflows-python", &["check-jsonschema==0.39.0", "zizmor==1.32.0"])?;
    for (schema, files) in SCHEMAS {
        let mut check = Command::new(&python);
        run(check
            .args(["-m", "check_jsonschema", "--default-filetype", "yaml", "--builtin-schema", schema])
            .args(files))?;
    }
    let linter = python.with_file_name(format!("zizmor{}", std::env::consts::EXE_SUFFIX));
    run(Command::new(linter)
        .args(["--offline", "--config"])
        .arg(root().join(".github/zizmor.yml"))
        .arg(".github"))
}
