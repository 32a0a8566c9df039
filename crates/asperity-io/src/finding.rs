//! Findings as JSON: `{code, severity, text, value, limit, rows}`, in results and of the command.

use asperity::finding::Finding;
use serde::Deserialize;
use serde_json::{Value, json};

/// The findings as a list of objects; `value`, `limit` and `rows` are null if there are none.
///
/// ```
/// use asperity::finding::{Finding, LARGE_SLOPE};
/// use asperity_io::finding::{from_list, list};
/// let findings = [Finding::warning(LARGE_SLOPE, 0.7, 0.5, "steep").at([0, 3])];
/// let objects = list(&findings);
/// assert_eq!(objects[0]["code"], "large-slope");
/// assert_eq!(objects[0]["severity"], "warning");
/// assert_eq!(objects[0]["rows"], serde_json::json!([0, 3]));
/// assert_eq!(from_list(&objects), findings);
/// ```
pub fn list(findings: &[Finding]) -> Value {
    json!(findings)
}

/// The inverse of [`list`]; what is no finding is left out.
pub fn from_list(list: &Value) -> Vec<Finding> {
    list.as_array().into_iter().flatten().filter_map(|object| Finding::deserialize(object).ok()).collect()
}
