//! The files that describe the software to archives and to people who cite it (CITATION.cff, codemeta.json, .zenodo.json)
//! say the same, and what Cargo.toml says.

use std::path::Path;

use serde_json::Value;

fn read(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn json(name: &str) -> Value {
    serde_json::from_str(&read(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// What CITATION.cff says, as far as the others say it too. It is YAML of a simple form: `key: value`, lists of `- value`,
/// and one folded text.
struct Citation {
    lines: Vec<String>,
}

impl Citation {
    fn read() -> Citation {
        Citation { lines: read("CITATION.cff").lines().map(str::to_owned).collect() }
    }

    fn value(&self, key: &str) -> &str {
        let line = self.lines.iter().find_map(|line| line.strip_prefix(&format!("{key}: ")));
        line.unwrap_or_else(|| panic!("CITATION.cff has no {key}")).trim_matches('"')
    }

    /// The indented lines below a key.
    fn block(&self, key: &str) -> Vec<&str> {
        let start = self.lines.iter().position(|line| line.starts_with(&format!("{key}:")));
        let start = start.unwrap_or_else(|| panic!("CITATION.cff has no {key}"));
        self.lines[start + 1..]
            .iter()
            .take_while(|line| line.starts_with("  "))
            .map(|line| line.trim())
            .collect()
    }

    fn list(&self, key: &str) -> Vec<&str> {
        self.block(key).into_iter().map(|line| line.trim_start_matches("- ")).collect()
    }
}

fn strings(value: &Value) -> Vec<&str> {
    value.as_array().expect("a list").iter().map(|item| item.as_str().expect("a text")).collect()
}

#[test]
fn citation_codemeta_and_zenodo_agree() {
    let (citation, codemeta, zenodo) = (Citation::read(), json("codemeta.json"), json(".zenodo.json"));
    assert_eq!(zenodo["title"], citation.value("title"));
    assert_eq!(codemeta["name"], citation.value("title").split(':').next().unwrap());

    let version = env!("CARGO_PKG_VERSION");
    assert_eq!([citation.value("version"), version], [version; 2]);
    assert_eq!((&codemeta["version"], &zenodo["version"]), (&version.into(), &version.into()));

    assert!(read("packaging/conda/recipe.yaml").contains(&format!("version: \"{version}\"")));

    let abstract_ = citation.block("abstract").join(" ");
    assert_eq!(
        (&codemeta["description"], &zenodo["description"]),
        (&abstract_.as_str().into(), &abstract_.as_str().into())
    );

    let keywords = citation.list("keywords");
    assert_eq!(strings(&codemeta["keywords"]), keywords);
    assert_eq!(strings(&zenodo["keywords"]), keywords);

    let author = citation.block("authors")[0].trim_start_matches("- name: ");
    assert_eq!(codemeta["author"][0]["name"], author);
    assert_eq!(zenodo["creators"][0]["name"], author);

    // Cargo's form is "MIT OR Apache-2.0"; Zenodo takes one licence, and has the other in its notes.
    let licences = citation.list("license");
    let addresses: Vec<String> =
        licences.iter().map(|name| format!("https://spdx.org/licenses/{name}")).collect();
    assert_eq!(strings(&codemeta["license"]), addresses);
    assert_eq!(zenodo["license"], licences[0]);
    assert!(zenodo["notes"].as_str().unwrap().contains(&licences.join(" or ")));
    let cargo = read("Cargo.toml");
    assert!(cargo.contains(&format!("license = \"{}\"", licences.join(" OR "))));
    assert!(cargo.contains(&format!("authors = [\"{author}\"]")));
    assert!(read("pyproject.toml").contains(&format!("authors = [{{ name = \"{author}\" }}]")));

    // The Python package and conda's hold the font and the plotting library of the figures too.
    let report = read("crates/asperity-report/Cargo.toml");
    let whole = report.lines().find_map(|line| line.strip_prefix("license = ")).unwrap();
    assert!(whole.starts_with(&format!("\"({})", licences.join(" OR "))));
    assert!(read("pyproject.toml").contains(&format!("\nlicense = {whole}\n")));
    let recipe = read("packaging/conda/recipe.yaml");
    assert!(recipe.contains(&format!("  license: {}\n", whole.trim_matches('"'))));

    let doi = citation.block("references").into_iter().find_map(|line| line.strip_prefix("doi: ")).unwrap();
    assert_eq!(zenodo["related_identifiers"][0]["identifier"], doi);
    assert_eq!(codemeta["referencePublication"]["@id"], format!("https://doi.org/{doi}"));
}

/// Times in the paper's draft are those of the documentation, which is measured again from time to time.
#[test]
fn the_paper_has_the_times_of_the_documentation() {
    let (paper, measured) = (read("docs/paper-joss/paper.md"), read("docs/performance.md"));
    let section = paper
        .split("\n# ")
        .find(|section| section.starts_with("Performance"))
        .expect("a section Performance");
    let words: Vec<&str> = section.split_whitespace().collect();
    let times: Vec<&str> = words
        .windows(2)
        .filter(|pair| pair[1].trim_end_matches([',', '.', ';']) == "s" && pair[0].parse::<f64>().is_ok())
        .map(|pair| pair[0])
        .collect();
    assert!(times.len() > 10, "only {times:?}");
    for time in times {
        assert!(measured.contains(&format!("{time} s")), "docs/performance.md has no {time} s");
    }
}

#[test]
fn the_changelog_says_what_users_get() {
    let changelog = read("CHANGELOG.md");
    let heading = format!("## [{}]", env!("CARGO_PKG_VERSION"));
    let section = changelog.split("\n## ").find(|section| format!("## {section}").starts_with(&heading));
    let section = section.unwrap_or_else(|| panic!("CHANGELOG.md has no section {heading}"));
    // A page that a user reads to the end.
    assert!(section.lines().count() <= 60, "{} lines", section.lines().count());
}
