//! Findings as JSON: `{code, severity, text, value, limit, rows}`, in results and of the command.

use asperity::finding::{Finding, Severity};
use serde_json::{Value, json};

/// The finding as an object; `value`, `limit` and `rows` are null where there are none.
///
/// ```
/// use asperity::finding::{Finding, LARGE_SLOPE};
/// use asperity_io::finding::{from_json, to_json};
/// let finding = Finding::warning(LARGE_SLOPE, 0.7, 0.5, "steep").at([0, 3]);
/// let object = to_json(&finding);
/// assert_eq!(object["code"], "large-slope");
/// assert_eq!(object["rows"], serde_json::json!([0, 3]));
/// assert_eq!(from_json(&object), Some(finding));
/// ```
pub fn to_json(finding: &Finding) -> Value {
    json!({
        "code": finding.code,
        "severity": finding.severity.as_str(),
        "text": finding.text,
        "value": finding.value,
        "limit": finding.limit,
        "rows": finding.rows,
    })
}

/// The findings as a list of objects.
pub fn list(findings: &[Finding]) -> Value {
    findings.iter().map(to_json).collect()
}

/// The inverse of [`to_json`]; `None` where the object is none.
pub fn from_json(object: &Value) -> Option<Finding> {
    let text = |key: &str| object.get(key).and_then(Value::as_str).map(str::to_owned);
    let number = |key: &str| object.get(key).and_then(Value::as_f64);
    let severity = text("severity")?;
    let row = |value: &Value| value.as_u64().and_then(|row| usize::try_from(row).ok());
    let rows = match object.get("rows").and_then(Value::as_array).map(Vec::as_slice) {
        Some([first, last]) => Some([row(first)?, row(last)?]),
        _ => None,
    };
    Some(Finding {
        code: text("code")?.into(),
        severity: [Severity::Note, Severity::Warning].into_iter().find(|s| s.as_str() == severity)?,
        text: text("text")?,
        value: number("value"),
        limit: number("limit"),
        rows,
    })
}

/// The inverse of [`list`]; what is no finding is left out.
pub fn from_list(list: &Value) -> Vec<Finding> {
    list.as_array().map(|list| list.iter().filter_map(from_json).collect()).unwrap_or_default()
}
