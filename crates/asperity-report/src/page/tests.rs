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
    let page = filled(&[("style", STYLE), ("script", &SCRIPT.concat())]);
    for sign in ["https://", "src=", "@import", "url("] {
        assert!(!page.contains(sign), "{sign}");
    }
    let foreign = page.replace("http://www.w3.org/2000/svg", "");
    assert!(!foreign.contains("http://"));
}
