//! `--set KEY=VALUE`: keys of the case file changed from outside, before it is read.
//!
//! A key is a path: `domain.cells`, `body.0.hardness` or `body[0].hardness`. A value is TOML
//! (`[256, 256]`, `true`, `1e-8`), or else text: `body.0.hardness=200 MPa` needs no quotes.

use std::str::FromStr;

use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

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
        set_in_table(document.as_table_mut(), &self.path, &self.value)
            .map_err(|reason| format!("{} cannot be set: {reason}", self.key))
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

fn set_in_table(table: &mut dyn TableLike, path: &[Step], value: &Value) -> Result<(), String> {
    let (key, rest) = match path {
        [Step::Key(key), rest @ ..] => (key, rest),
        [Step::Index(n), ..] => return Err(format!("{n} is a number, but a table has names")),
        [] => return Err("the path ends at a table".to_owned()),
    };
    if let Some(item) = table.get_mut(key) {
        return set_in_item(item, rest, value);
    }
    let mut item = if rest.is_empty() { Item::None } else { Item::Table(Table::new()) };
    set_in_item(&mut item, rest, value)?;
    table.insert(key, item);
    Ok(())
}

fn set_in_item(item: &mut Item, path: &[Step], value: &Value) -> Result<(), String> {
    match item {
        Item::Table(table) if !path.is_empty() => set_in_table(table, path, value),
        Item::ArrayOfTables(tables) if !path.is_empty() => {
            let count = tables.len();
            let (n, rest) = first_index(path, count)?;
            match (tables.get_mut(n), rest) {
                (Some(_), []) => Err(format!("element {n} is a table; set one of its keys")),
                (Some(table), _) => set_in_table(table, rest, value),
                (None, _) => Err(beyond(n, count)),
            }
        }
        Item::Value(old) => set_in_value(old, path, value),
        // A whole table, or nothing yet.
        _ => {
            *item = Item::Value(value.clone());
            Ok(())
        }
    }
}

fn set_in_value(old: &mut Value, path: &[Step], value: &Value) -> Result<(), String> {
    match (old, path) {
        (old, []) => {
            // In place: blanks and comment around the value stay, and so do the numbers of the lines.
            let decor = old.decor().clone();
            *old = value.clone();
            *old.decor_mut() = decor;
            Ok(())
        }
        (Value::InlineTable(table), _) => set_in_table(table, path, value),
        (Value::Array(array), _) => {
            let count = array.len();
            let (n, rest) = first_index(path, count)?;
            set_in_value(array.get_mut(n).ok_or_else(|| beyond(n, count))?, rest, value)
        }
        _ => Err("the path leads through a value that is neither table nor list".to_owned()),
    }
}

fn first_index(path: &[Step], count: usize) -> Result<(usize, &[Step]), String> {
    match path {
        [Step::Index(n), rest @ ..] => Ok((*n, rest)),
        [Step::Key(key), ..] => Err(format!("\"{key}\" is a name, but a list of {count} has numbers from 0")),
        [] => Err("the path ends at a list".to_owned()),
    }
}

fn beyond(n: usize, count: usize) -> String {
    format!("there is no element {n}, the list has {count} (the first is 0)")
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
