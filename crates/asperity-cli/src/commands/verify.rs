//! `asperity verify`: the solver against independent facts.

use asperity_verify::{CASES, Check};
use serde_json::json;

use crate::args::Verify;
use crate::failure::{Failure, refuse};
use crate::verb::{Threads, Verb};

impl Verb for Verify {
    fn threads(&self) -> Threads {
        Threads::of(self.threads)
    }

    /// Runs the cases and prints case, quantity, error, tolerance.
    fn run(&self) -> Result<(), Failure> {
        if let Some(unknown) = self.cases.iter().find(|name| CASES.iter().all(|(case, _)| case != name)) {
            let names: Vec<_> = CASES.iter().map(|(name, _)| *name).collect();
            refuse!("there is no case \"{unknown}\"; choose from {}", names.join(", "));
        }
        let mut checks = Vec::new();
        let chosen =
            CASES.iter().filter(|(name, _)| self.cases.is_empty() || self.cases.iter().any(|c| c == name));
        for (name, case) in chosen {
            crate::messages::message!("{name} ...");
            checks.extend(case().map_err(|error| Failure::Solve(format!("{name}: {error}")))?);
        }
        crate::print(&if self.json {
            json(&checks)
        } else if self.markdown {
            markdown(&checks)
        } else {
            table(&checks)
        })?;
        match checks.iter().filter(|c| !c.ok()).count() {
            0 => Ok(()),
            failed => {
                Err(Failure::Solve(format!("{failed} of {} checks are out of tolerance", checks.len())))
            }
        }
    }
}

fn json(checks: &[Check]) -> String {
    let list: Vec<_> = checks
        .iter()
        .map(|c| {
            json!({ "case": c.case, "quantity": c.quantity, "fact": c.fact,
                    "error": c.error, "tolerance": c.tolerance, "ok": c.ok() })
        })
        .collect();
    serde_json::to_string_pretty(&list).map(|text| text + "\n").unwrap_or_default()
}

fn table(checks: &[Check]) -> String {
    let width = |f: fn(&Check) -> &str| checks.iter().map(|c| f(c).chars().count()).max().unwrap_or(0);
    let (case, quantity) = (width(|c| c.case), width(|c| &c.quantity));
    let mut text =
        format!("{:case$}  {:quantity$}  {:>8}  {:>9}\n", "case", "quantity", "error", "tolerance");
    for c in checks {
        let verdict = if c.ok() { "ok" } else { "OUT OF TOLERANCE" };
        text += &format!(
            "{:case$}  {:quantity$}  {:>8.1e}  {:>9.1e}  {verdict}\n",
            c.case, c.quantity, c.error, c.tolerance
        );
    }
    let ok = checks.iter().filter(|c| c.ok()).count();
    text + &format!("{ok} of {} checks within tolerance\n", checks.len())
}

fn markdown(checks: &[Check]) -> String {
    let mut text =
        String::from("| case | independent fact | quantity | error | tolerance |\n|---|---|---|---|---|\n");
    let mut last = "";
    for c in checks {
        let (case, fact) = if c.case == last { ("", "") } else { (c.case, c.fact) };
        last = c.case;
        let bold = if c.ok() { "" } else { "**" };
        text += &format!(
            "| {case} | {} | {} | {bold}{:.1e}{bold} | {:.1e} |\n",
            fact.replace('|', "\\|"),
            c.quantity.replace('|', "\\|"),
            c.error,
            c.tolerance
        );
    }
    text
}
