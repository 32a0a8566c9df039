//! The text files of the repository, and what of them is prose.

use std::collections::BTreeSet;
use std::path::Path;

/// Endings of the files that are read.
const TEXT: [&str; 10] = ["md", "rs", "py", "pyi", "toml", "js", "html", "css", "ipynb", "yml"];

/// A text file; its path is relative to the root, with slashes.
pub struct File {
    pub path: String,
    pub text: String,
}

/// Files to read, and the paths of all files and folders.
pub struct Tree {
    pub files: Vec<File>,
    pub paths: BTreeSet<String>,
}

impl Tree {
    /// All of the repository but what is built, hidden, or these tests, whose wrong references are on purpose.
    pub fn of_the_repository() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut tree = Tree { files: Vec::new(), paths: BTreeSet::new() };
        tree.walk(&root, "");
        assert!(tree.files.len() > 100, "the repository has more text than {} files", tree.files.len());
        tree
    }

    /// These files alone.
    pub fn of_files<const N: usize>(files: [(&str, &str); N]) -> Self {
        let mut tree = Tree { files: Vec::new(), paths: BTreeSet::new() };
        for (path, text) in files {
            for (end, _) in path.match_indices('/') {
                tree.paths.insert(path[..end].into());
            }
            tree.paths.insert(path.into());
            tree.files.push(File { path: path.into(), text: text.into() });
        }
        tree
    }

    fn walk(&mut self, folder: &Path, prefix: &str) {
        for entry in std::fs::read_dir(folder).expect("a folder of the repository").flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = format!("{prefix}{name}");
            let built = name == "target" || name == "__pycache__" || name.ends_with(".egg-info");
            if (name.starts_with('.') && ![".ci", ".github"].contains(&name.as_str())) || built {
                continue;
            }
            self.paths.insert(path.clone());
            if entry.path().is_dir() {
                self.walk(&entry.path(), &format!("{path}/"));
            } else if TEXT.iter().any(|ending| ending_of(&name) == *ending)
                && !path.starts_with("xtask/tests/")
            {
                // What cannot be read as text (a file that goes while we look) holds no reference.
                let Ok(text) = std::fs::read_to_string(entry.path()) else { continue };
                self.files.push(File { path, text });
            }
        }
    }
}

/// What follows the last point of a path.
pub fn ending_of(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(_, ending)| ending)
}

impl File {
    /// Folder of the file, "" at the root.
    pub fn folder(&self) -> &str {
        self.path.rsplit_once('/').map_or("", |(folder, _)| folder)
    }

    /// "file:line: what".
    pub fn fault(&self, line: usize, what: &str) -> String {
        format!("{}:{}: {what}", self.path, line + 1)
    }

    /// The prose: Markdown without blocks of code, comments of code. One string per line of the file, so that lines
    /// keep their numbers; without addresses on the web.
    pub fn prose(&self) -> Vec<String> {
        let mut fenced = false;
        let part = |line: &str| -> String {
            let marker = match ending_of(&self.path) {
                "md" => {
                    let fence = line.trim_start().starts_with("```");
                    fenced ^= fence;
                    return if fence || fenced { String::new() } else { line.into() };
                }
                "rs" | "js" => "//",
                "py" | "pyi" | "toml" => "#",
                _ => return String::new(),
            };
            let comment =
                if marker == "//" { comment_of(line) } else { line.split_once(marker).map(|(_, c)| c) };
            comment.unwrap_or_default().trim_start_matches(['/', '!', '#']).into()
        };
        self.text.lines().map(part).map(|line| without_addresses(&line)).collect()
    }
}

/// What follows `//`, which inside of an address is none.
fn comment_of(line: &str) -> Option<&str> {
    let starts = line.match_indices("//").map(|(at, _)| at);
    starts.into_iter().find(|at| !line[..*at].ends_with(':')).map(|at| &line[at + 2..])
}

fn without_addresses(line: &str) -> String {
    let mut rest = line;
    let mut kept = String::new();
    while let Some(at) = rest.find("http") {
        kept.push_str(&rest[..at]);
        let end = rest[at..].find([' ', ')', '>', '"', '`']).unwrap_or(rest.len() - at);
        rest = &rest[at + end..];
    }
    kept + rest
}
