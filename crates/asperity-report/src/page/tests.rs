//! Facts of the page.

use super::*;

#[test]
fn texts_of_a_case_cannot_become_markup() {
    let page = filled(&[
        ("title", &escaped("</title><script>alert(1)</script>")),
        ("state", &serde_json::json!({"case": "</script>{{blobs}}"}).to_string().replace('<', "\\u003c")),
        ("blobs", "BLOBS"),
    ]);
    assert!(!page.contains("<script>alert"));
    assert!(!page.contains("</script>{{"));
    assert_eq!(page.matches("BLOBS").count(), 1, "what is filled in is not filled again");
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
