//! Facts of the page.

use super::*;

#[test]
fn texts_of_a_case_cannot_become_markup() {
    let page = filled(&[
        ("title", &escaped("</title><script>alert(1)</script>")),
        ("state", &embedded(&serde_json::json!({"case": "</script>{{blobs}}"}))),
        ("blobs", "BLOBS"),
    ]);
    assert!(!page.contains("<script>alert"));
    assert!(!page.contains("</script>{{"));
    assert_eq!(page.matches("BLOBS").count(), 1, "what is filled in is not filled again");
}

#[test]
fn a_page_holds_no_control_characters() {
    let hostile = "a\0b\u{1b}[2Jc\u{7}d\u{7f}e\u{9b}f";
    assert_eq!(escaped(&format!("{hostile}\n")), "a\u{fffd}b\u{fffd}[2Jc\u{fffd}d\u{fffd}e\u{fffd}f\n");
    let state = embedded(&serde_json::json!({ "title": hostile }));
    assert!(!state.contains(char::is_control));
    assert_eq!(serde_json::from_str::<serde_json::Value>(&state).unwrap()["title"], hostile);
}

#[test]
fn the_page_asks_for_nothing_from_elsewhere() {
    // The library names its home in a comment; nothing else may look like an address.
    let library = LIBRARY.replacen("https://github.com/leeoniya/uPlot (v1.6.32)", "", 1);
    let parts = [
        ("style", STYLE),
        ("library-style", LIBRARY_STYLE),
        ("library", library.as_str()),
        ("script", &SCRIPT.concat()),
    ];
    let page = filled(&parts);
    for sign in ["https://", "http://", "src=", "@import", "url("] {
        assert!(!page.contains(sign), "{sign}");
    }
}

#[test]
fn the_page_holds_the_licence_of_the_library_that_draws_its_curves() {
    assert!(LIBRARY.starts_with("/*! https://github.com/leeoniya/uPlot (v1.6.32) */"));
    let page = filled(&[("library-license", &escaped(LIBRARY_LICENSE))]);
    assert!(page.contains("Copyright (c) 2022 Leon Sorokin") && page.contains("shall be included in"));
}

/// All parts are one script: of two functions of one name the later one would replace the other.
#[test]
fn no_name_is_declared_twice_in_the_script() {
    let names: Vec<&str> = super::SCRIPT
        .iter()
        .flat_map(|part| part.lines())
        .filter_map(|line| {
            let line = line.strip_prefix("async ").unwrap_or(line);
            let rest =
                ["function ", "const ", "let ", "class "].iter().find_map(|word| line.strip_prefix(word))?;
            rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().filter(|name| !name.is_empty())
        })
        .collect();
    assert!(names.len() > 50, "{names:?}");
    let twice: Vec<_> = names.iter().enumerate().filter(|(n, name)| names[..*n].contains(name)).collect();
    assert!(twice.is_empty(), "{twice:?}");
}
