//! `--set KEY=VALUE`: keys of the case file changed from outside, before it is read.
//!
//! A key is a path: `domain.cells`, `body.0.hardness` or `body[0].hardness`. A value is TOML
//! (`[256, 256]`, `true`, `1e-8`), or else text: `body.0.hardness=200 MPa` needs no quotes.

use std::str::FromStr;

use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, Value};

/// One change.
#[derive(Clone, Debug)]
pub struct Override {
    /// Path of the key as the case file's errors write it ("body[0].hardness").
    pub key: String,
    path: Vec<Step>,
    value: Value,
}

#[derive(Clone, Debug)]
enum Step {
    Key(String),
    Index(usize),
}

impl Override {
    /// Reads `KEY=VALUE`.
    ///
    /// # Errors
    /// A sentence.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (key, value) = text.split_once('=').ok_or_else(|| {
            format!("the override {text:?} has no \"=\"; write KEY=VALUE, as in domain.cells=[256, 256]")
        })?;
        let path = path(key.trim())?;
        let value = value.trim();
        let value = Value::from_str(value).unwrap_or_else(|_| Value::from(value));
        let mut name = String::new();
        for step in &path {
            match step {
                Step::Key(key) if name.is_empty() => name.push_str(key),
                Step::Key(key) => name.push_str(&format!(".{key}")),
                Step::Index(n) => name.push_str(&format!("[{n}]")),
            }
        }
        Ok(Override { key: name, path, value })
    }

    /// Sets the key in the document; tables on the way are made where they are missing.
    ///
    /// # Errors
    /// A sentence: the path leads through a value, or to an element that the list does not have.
    pub fn apply(&self, document: &mut DocumentMut) -> Result<(), String> {
        let place = place(document.as_item_mut(), &self.path);
        let item = place.map_err(|reason| format!("{} cannot be set: {reason}", self.key))?;
        let mut value = self.value.clone();
        if let Some(old) = item.as_value() {
            // Blanks and comment around the value stay, and so do the numbers of the lines.
            old.decor().clone_into(value.decor_mut());
        }
        *item = Item::Value(value);
        Ok(())
    }
}

fn path(key: &str) -> Result<Vec<Step>, String> {
    let mut steps = Vec::new();
    for part in key.replace('[', ".").replace(']', "").split('.') {
        let part = part.trim();
        if part.is_empty() {
            return Err(format!(
                "the override {key:?} is not the path of a key; write it as in body.0.hardness"
            ));
        }
        match part.parse() {
            Ok(n) if !steps.is_empty() => steps.push(Step::Index(n)),
            _ => steps.push(Step::Key(part.to_owned())),
        }
    }
    match steps.len() <= DEEPEST {
        true => Ok(steps),
        false => Err(format!("the override {key:?} has more parts than any key")),
    }
}

/// No key of a case file lies deeper.
const DEEPEST: usize = 16;

/// The item at a path; tables on the way to it are made where they are missing.
fn place<'d>(mut item: &'d mut Item, path: &[Step]) -> Result<&'d mut Item, String> {
    const NEITHER: &str = "the path leads through a value that is neither table nor list";
    for (depth, step) in path.iter().enumerate() {
        let is_last = depth + 1 == path.len();
        let count = item.as_array().map(Array::len).or(item.as_array_of_tables().map(ArrayOfTables::len));
        let (is_inline, holds_tables) = (item.is_value(), item.is_array_of_tables());
        item = match (step, count) {
            (Step::Key(key), None) => {
                let table = item.as_table_like_mut().ok_or(NEITHER)?;
                table.entry(key).or_insert_with(|| match is_inline {
                    _ if is_last => Item::None,
                    true => Item::Value(InlineTable::new().into()),
                    false => Item::Table(Table::new()),
                })
            }
            (Step::Index(n), Some(count)) if *n < count && is_last && holds_tables => {
                return Err(format!("element {n} is a table; set one of its keys"));
            }
            (Step::Index(n), Some(count)) => item
                .get_mut(*n)
                .ok_or_else(|| format!("there is no element {n}, the list has {count} (the first is 0)"))?,
            (Step::Key(key), Some(count)) => {
                return Err(format!("\"{key}\" is a name, but a list of {count} has numbers from 0"));
            }
            (Step::Index(n), None) if item.is_table_like() => {
                return Err(format!("{n} is a number, but a table has names"));
            }
            (Step::Index(_), None) => return Err(NEITHER.to_owned()),
        };
    }
    Ok(item)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = r#"
title = "a" # the title
[domain]
cells = [64, 64] # few
[[body]]
material = { model = "prony", terms = [{ time = "1 s" }, { time = "2 s" }] }
[[body]]
poisson = 0.3
"#;

    fn set(text: &str) -> Result<String, String> {
        let mut document: DocumentMut = CASE.parse().unwrap();
        Override::parse(text)?.apply(&mut document)?;
        Ok(document.to_string())
    }

    #[test]
    fn a_value_is_replaced_in_place() {
        assert!(set("domain.cells=[256,256]").unwrap().contains("cells = [256,256] # few"));
        assert!(set("domain.cells.1 = 32").unwrap().contains("cells = [64, 32] # few"));
        assert!(set("title=my run").unwrap().contains("title = \"my run\" # the title"));
        assert!(set("body.0.material.terms.1.time=3 s").unwrap().contains("{ time = \"3 s\" }"));
        assert!(set("body[1].poisson=0.4").unwrap().contains("poisson = 0.4"));
        for text in ["domain.cells=[256,256]", "title=my run", "body[1].poisson=0.4"] {
            assert_eq!(set(text).unwrap().lines().count(), CASE.lines().count());
        }
    }

    #[test]
    fn a_new_key_is_added_with_its_tables() {
        assert!(set("body.1.hardness=200 MPa").unwrap().contains("hardness = \"200 MPa\""));
        assert!(set("solver.tolerance=1e-8").unwrap().contains("[solver]\ntolerance = 1e-8"));
        let twice = set("body.0.material.a.b=1").unwrap();
        assert!(twice.contains("a = { b = 1 }"), "{twice}");
        let whole = set("body=5").unwrap();
        assert_eq!(whole.parse::<DocumentMut>().unwrap()["body"].as_integer(), Some(5), "{whole}");
    }

    #[test]
    fn a_path_that_leads_nowhere_is_said() {
        for (text, words) in [
            ("domain.cells", "KEY=VALUE"),
            ("=1", "path of a key"),
            ("a..b=1", "path of a key"),
            ("body.2.poisson=1", "no element 2, the list has 2"),
            ("body.poisson=1", "numbers from 0"),
            ("body.0=1", "set one of its keys"),
            ("domain.cells.5=1", "no element 5"),
            ("domain.0=1", "a table has names"),
            ("title.x=1", "neither table nor list"),
            ("a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a=1", "more parts than any key"),
        ] {
            let message = set(text).unwrap_err();
            assert!(message.contains(words), "{text}: {message}");
        }
    }
}
