//! The wording of errors stands in one place: `wording.json` holds the message of each faulty input of the tests, which otherwise
//! assert code, key, line and numbers.
//!
//! After a change of words, `ASPERITY_WORDING=write cargo test -p asperity-io --test all case` writes the file; read the difference.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;

use asperity_io::case::CaseError;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/all/wording.json");
/// Longer inputs are cut.
const MOST_CHARACTERS: usize = 160;

static FILE_IN_USE: Mutex<()> = Mutex::new(());

/// Asserts that the error of this input says what the file holds; `dir` is the directory of the case.
#[track_caller]
pub(crate) fn check(input: &str, dir: &Path, error: &CaseError) {
    let input: String = input.trim().chars().take(MOST_CHARACTERS).collect();
    let input = format!("{} [{}]: {input}", error.key, error.code);
    let said = plain(&error.to_string(), dir);
    let _lock = FILE_IN_USE.lock();
    let text = std::fs::read_to_string(FILE).unwrap_or_else(|_| "{}".to_owned());
    let mut messages: BTreeMap<String, String> = serde_json::from_str(&text).unwrap();
    if std::env::var("ASPERITY_WORDING").is_ok_and(|word| word == "write") {
        messages.insert(input, said);
        std::fs::write(FILE, serde_json::to_string_pretty(&messages).unwrap() + "\n").unwrap();
    } else {
        let known = messages.get(&input).map(String::as_str);
        assert_eq!(known, Some(said.as_str()), "{input}: ASPERITY_WORDING=write writes {FILE}");
    }
}

/// The message without its line, the directory and the memory of this machine.
fn plain(said: &str, dir: &Path) -> String {
    let said = match said.strip_prefix("line ").and_then(|rest| rest.split_once(": ")) {
        Some((_, rest)) => rest,
        None => said,
    };
    let said = match dir.to_str() {
        Some(dir) if dir.len() > 1 => said.replace(dir, "DIR"),
        _ => said.to_owned(),
    };
    match said.split_once("this machine has ") {
        Some((before, after)) => {
            format!(
                "{before}this machine has ...{}",
                after.split_once(" available").map_or("", |(_, rest)| rest)
            )
        }
        None => said,
    }
}
