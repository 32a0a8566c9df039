//! Findings in the terminal.

use asperity::finding::Finding;

use crate::failure::Failure;

/// One line each, on stderr.
pub fn print(findings: &[Finding]) {
    findings.iter().for_each(|finding| crate::messages::message!("{finding}"));
}

/// "2 warnings, 1 note: contact-at-border, large-strain, outliers".
pub fn counted(findings: &[Finding]) -> String {
    let warnings = findings.iter().filter(|finding| finding.is_warning()).count();
    let parts = [(warnings, "warning"), (findings.len() - warnings, "note")];
    let parts: Vec<String> =
        parts.iter().filter(|part| part.0 > 0).map(|part| crate::format::counted(part.0, part.1)).collect();
    let codes: Vec<&str> = findings.iter().map(|finding| finding.code.as_ref()).collect();
    format!("{}: {}", parts.join(", "), codes.join(", "))
}

/// A failure where warnings are to be errors and there are some.
pub fn strict(strict: bool, findings: &[Finding]) -> Result<(), Failure> {
    let warnings = findings.iter().filter(|finding| finding.is_warning()).count();
    if strict && warnings > 0 { Err(Failure::Strict(warnings)) } else { Ok(()) }
}
