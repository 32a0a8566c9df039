//! Whatever the text, the answer is a case or an error with a place: never a panic, never a hang.

use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use asperity_examples::TEMPLATES;
use asperity_io::case::{Case, CaseErrors};
use asperity_io::quantity::{Compliance, Length};
use proptest::prelude::*;

/// Far more than any answer takes: beyond it there is none.
const PATIENCE: Duration = Duration::from_secs(120);

fn check(text: &str, overrides: &[String]) {
    let (done, answered) = channel();
    let question = (text.to_owned(), overrides.to_vec());
    let answer = thread::spawn(move || {
        answer(&question.0, &question.1);
        let _ = done.send(());
    });
    if let Err(RecvTimeoutError::Timeout) = answered.recv_timeout(PATIENCE) {
        panic!("no answer to {overrides:?} and\n{text}");
    }
    if let Err(panic) = answer.join() {
        std::panic::resume_unwind(panic);
    }
}

fn answer(text: &str, overrides: &[String]) {
    match Case::parse(text, Path::new("/nowhere"), overrides) {
        Ok(case) => {
            let description = case.describe();
            let Some(rows) = description.rows else { return };
            assert!(rows >= 1 && description.stored_rows.is_some_and(|stored| stored <= rows));
        }
        Err(errors) => well_formed(&errors),
    }
}

fn well_formed(errors: &CaseErrors) {
    assert!(!errors.errors.is_empty());
    for error in &errors.errors {
        assert!(!error.message.is_empty());
        if let Some(span) = &error.span {
            assert!(errors.source.get(span.clone()).is_some(), "{error:?}");
            assert!(error.line.is_some());
        }
    }
    assert!(!errors.to_string().is_empty());
}

/// Words that steer a mutation into the format's corners.
fn token() -> impl Strategy<Value = String> {
    prop_oneof![
        prop::sample::select(vec![
            "0",
            "-1",
            "1e308",
            "1e-308",
            "nan",
            "inf",
            "-inf",
            "9223372036854775807",
            "1e400",
            "true",
            "[]",
            "{}",
            "[[1, 2], [3]]",
            "\"\"",
            "\"1 mm\"",
            "\"1 MPa\"",
            "\"1e-3 1/(Pa s)\"",
            "\"-1 N\"",
            "1979-05-27T07:32:00Z",
            "kind = \"file\"",
            "path = \"x\"",
            "model = \"creep\"",
            "\n",
            "=",
            "[",
            "]",
            "[[body]]",
            "[solver]",
            "'''",
            "\"\\u0000\"",
            "µ",
            "\u{feff}",
            "times = [1, 2, 3]",
            "scheme = \"direct\"",
        ])
        .prop_map(str::to_owned),
        "[ -~\n]{0,8}",
    ]
}

/// Lines that give a key its value.
fn values(text: &str) -> Vec<usize> {
    let gives = |line: &str| line.contains(" = ") && !line.starts_with('#');
    text.lines().enumerate().filter(|(_, line)| gives(line)).map(|(n, _)| n).collect()
}

fn replaced(text: &str, chosen: usize, value: &str) -> String {
    let line = |(n, line): (usize, &str)| match line.split_once(" = ") {
        Some((key, _)) if n == chosen => format!("{key} = {value}"),
        _ => line.to_owned(),
    };
    text.lines().enumerate().map(line).collect::<Vec<_>>().join("\n")
}

fn cut(text: &str, at: usize) -> usize {
    let mut at = at % (text.len() + 1);
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

proptest! {
    // Some seconds in all.
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_answered(text in ".{0,200}") {
        check(&text, &[]);
    }

    #[test]
    fn any_bytes_are_answered(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        check(&String::from_utf8_lossy(&bytes), &[]);
    }

    #[test]
    fn a_mutated_case_is_answered(
        template in prop::sample::select(TEMPLATES),
        edits in prop::collection::vec((any::<usize>(), 0usize..40, token()), 1..5),
    ) {
        let mut text = template.text.to_owned();
        for (at, length, token) in edits {
            let start = cut(&text, at);
            let end = cut(&text, (start + length).min(text.len())).max(start);
            text.replace_range(start..end, &token);
        }
        check(&text, &[]);
    }

    #[test]
    fn a_value_replaced_by_anything_is_answered(
        template in prop::sample::select(TEMPLATES),
        pick in any::<usize>(),
        token in token(),
    ) {
        let values = values(template.text);
        check(&replaced(template.text, values[pick % values.len()], &token), &[]);
    }

    #[test]
    fn any_override_is_answered(key in "[a-z_.\\[\\]0-2 ]{0,20}", value in ".{0,12}") {
        check(TEMPLATES[0].text, &[format!("{key}={value}")]);
        check(TEMPLATES[0].text, &[format!("body.0.material{key}={value}"), value]);
    }

    #[test]
    fn any_quantity_is_answered(text in "[-+.,0-9eE ]{0,12}[a-zA-Z/()^*%µ1-3 -]{0,12}") {
        for result in [text.parse::<Length>().map(|v| v.get()), text.parse::<Compliance>().map(|v| v.get())] {
            match result {
                Ok(value) => prop_assert!(value.is_finite()),
                Err(error) => prop_assert!(!error.expected.is_empty()),
            }
        }
    }
}

#[test]
fn every_value_at_its_extremes_is_answered() {
    for template in TEMPLATES {
        for line in values(template.text) {
            for extreme in ["0", "1e-308", "1e-9", "1e308", "9223372036854775807"] {
                check(&replaced(template.text, line, extreme), &[]);
            }
        }
    }
}

#[test]
fn deep_and_wide_texts_are_answered() {
    for text in
        ["[".repeat(100_000), format!("a = {}", "[".repeat(100_000)), "a.".repeat(100_000), "{".repeat(1000)]
    {
        check(&text, &[]);
        check(TEMPLATES[0].text, std::slice::from_ref(&text));
        check(TEMPLATES[0].text, &[format!("domain.cells={text}")]);
    }
    check(&format!("title = \"{}\"", "x".repeat(1 << 20)), &[]);
}
