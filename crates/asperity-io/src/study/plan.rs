//! The runs of a study: which keys vary, over which values, and how the values go together.

use serde::{Deserialize, Serialize};

use super::StudyError;
use super::values::{self, Value};
use crate::case::Form;
use crate::case::study::Base;
use crate::compare::{called, short};
use crate::digest::md5;
use crate::readable::counted;

/// What varies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Keys and the values that each takes.
    pub vary: Vec<Varied>,
    /// Whether the values of all keys go together, the first with the first; else every combination is run.
    pub zip: bool,
}

/// A key that varies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Varied {
    /// Its path as it was written, "surface.0.seed".
    pub key: String,
    /// Its values, in order.
    pub values: Vec<Value>,
}

/// A run of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The value of each key.
    pub values: Vec<Value>,
    /// The name of its result in the folder of the study.
    pub name: String,
}

/// More runs are a slip.
const MOST: usize = 1_000_000;

impl Plan {
    /// What the options `KEY=VALUES` and the section `[study]` of a case say; an option replaces what the case says of its key.
    /// `zip` is `None` where no option decides.
    pub(super) fn of(base: &Base, options: &[String], zip: Option<bool>) -> Result<Plan, StudyError> {
        let refused = |key: &str, reason: String| StudyError::Input(format!("the values of {key}: {reason}"));
        let mut vary: Vec<Varied> = vec![];
        for (key, written) in &base.vary {
            let values = match written {
                Form::Word(text) => values::read(text).map_err(|reason| refused(key, reason))?,
                Form::List(list) => list.iter().map(|value| Value::new(&value.to_string())).collect(),
                Form::Table(never) => match *never {},
            };
            vary.push(Varied { key: key.clone(), values });
        }
        for (n, option) in options.iter().enumerate() {
            let Some((key, text)) = option.split_once('=').map(|(key, text)| (key.trim(), text)) else {
                return Err(StudyError::Input(format!(
                    "--vary {option:?} has no \"=\"; write KEY=VALUES, e.g. --vary load.history.value=\"0.1 N, 1 N\""
                )));
            };
            let mut earlier = options[..n].iter().filter_map(|other| other.split_once('='));
            if earlier.any(|(other, _)| other.trim() == key) {
                let message = format!("--vary {key} is given twice; list all of its values in one");
                return Err(StudyError::Input(message));
            }
            let values = values::read(text).map_err(|reason| refused(key, reason))?;
            match vary.iter_mut().find(|varied| varied.key == key) {
                Some(varied) => varied.values = values,
                None => vary.push(Varied { key: key.to_owned(), values }),
            }
        }
        Plan { vary, zip: zip.unwrap_or(base.zip) }.checked()
    }

    fn checked(self) -> Result<Plan, StudyError> {
        let input = |message: String| Err(StudyError::Input(message));
        if self.vary.is_empty() {
            return input(
                "nothing varies: name a key and its values, e.g. --vary load.history.value=\"0.1 N, 1 N\", or write [study] vary \
                 into the case"
                    .into(),
            );
        }
        if let Some(empty) = self.vary.iter().find(|varied| varied.values.is_empty()) {
            return input(format!("{} has no values; list at least one", empty.key));
        }
        let lengths = self.vary.iter().map(|varied| varied.values.len());
        let count = match self.zip {
            true => lengths.clone().max().unwrap_or(0),
            false => lengths.clone().fold(1, usize::saturating_mul),
        };
        if self.zip && lengths.clone().any(|length| length != count) {
            let told =
                |varied: &Varied| format!("{} has {}", varied.key, counted(varied.values.len(), "value"));
            let all: Vec<String> = self.vary.iter().map(told).collect();
            return input(format!("zip needs equally many values of every key, but {}", all.join(", ")));
        }
        if count > MOST {
            return input(format!("the study has {count} runs; at most {MOST} are possible"));
        }
        for varied in self.vary.iter().filter(|_| !self.zip || self.vary.len() == 1) {
            let twice = |n: &usize| varied.values[..*n].iter().any(|other| other.is(&varied.values[*n]));
            // A quadratic search over long lists of whole numbers would take longer than the runs.
            if varied.values.len() <= 1000
                && let Some(n) = (0..varied.values.len()).find(twice)
            {
                return input(format!(
                    "{} takes the value {} twice; list it once",
                    varied.key,
                    varied.values[n].text()
                ));
            }
        }
        let mut names: Vec<String> = self.runs().into_iter().map(|run| run.name).collect();
        names.sort_unstable();
        if names.windows(2).any(|pair| pair[0] == pair[1]) {
            return input("two runs of the study have the same values; list each once".into());
        }
        Ok(self)
    }

    /// The runs in order: of every combination the last key changes first.
    pub fn runs(&self) -> Vec<Run> {
        let lengths: Vec<usize> = self.vary.iter().map(|varied| varied.values.len()).collect();
        let count = if self.zip { lengths.first().copied().unwrap_or(0) } else { lengths.iter().product() };
        let run = |n: usize| {
            let mut rest = n;
            let mut values: Vec<Value> = vec![];
            for varied in self.vary.iter().rev() {
                let length = varied.values.len().max(1);
                values.push(varied.values[if self.zip { n } else { rest % length }].clone());
                rest /= length;
            }
            values.reverse();
            Run { name: self.name(&values), values }
        };
        (0..count).map(run).collect()
    }

    /// The overrides that make the case of a run.
    pub fn overrides(&self, run: &Run) -> Vec<String> {
        let pairs = self.vary.iter().zip(&run.values);
        pairs.map(|(varied, value)| format!("{}={}", varied.key, value.source())).collect()
    }

    /// Lengths along the dimensions of the dataset.
    pub fn shape(&self) -> Vec<usize> {
        match self.zip {
            true => vec![self.vary.first().map_or(0, |varied| varied.values.len())],
            false => self.vary.iter().map(|varied| varied.values.len()).collect(),
        }
    }

    /// What tells a run from the others, for people: "load = 0.3 N, seed = 2".
    pub fn label(&self, run: &Run) -> String {
        let pairs = self.vary.iter().zip(&run.values);
        let words: Vec<String> =
            pairs.map(|(varied, value)| format!("{} = {}", self.called(&varied.key), value.text())).collect();
        words.join(", ")
    }

    /// How a key is called among those that vary: "load" for "load.history.value".
    pub fn called(&self, key: &str) -> String {
        called(key, &self.keys())
    }

    fn keys(&self) -> Vec<&str> {
        self.vary.iter().map(|varied| varied.key.as_str()).collect()
    }

    /// The name of the result with these values: readable, and, by its digest, of no other values.
    fn name(&self, values: &[Value]) -> String {
        /// Letters of the readable part.
        const LONGEST: usize = 80;
        let plain = |text: &str| -> String {
            let kept = text.chars().filter(|c| !c.is_whitespace());
            kept.map(|c| if c.is_ascii_alphanumeric() || "+-.".contains(c) { c } else { '_' }).collect()
        };
        let (mut name, mut whole) = (String::new(), String::new());
        for (varied, value) in self.vary.iter().zip(values) {
            name += &format!("{}-{}_", plain(short(&varied.key, &self.keys())), plain(&value.text()));
            whole += &format!("{}={}\n", varied.key, value.source());
        }
        name.truncate(LONGEST);
        format!("{}_{}.zarr", name.trim_end_matches('_'), &md5(whole.as_bytes())[..8])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(vary: &[(&str, &str)], zip: bool) -> Plan {
        let varied =
            |(key, text): &(&str, &str)| Varied { key: (*key).into(), values: values::read(text).unwrap() };
        Plan { vary: vary.iter().map(varied).collect(), zip }
    }

    #[test]
    fn the_last_key_changes_first() {
        let product = plan(&[("load.history.value", "0.1 N,1 N"), ("surface.0.seed", "1..3")], false);
        let labels: Vec<String> = product.runs().iter().map(|run| product.label(run)).collect();
        assert_eq!(
            labels[..4],
            [
                "load = 0.1 N, seed = 1",
                "load = 0.1 N, seed = 2",
                "load = 0.1 N, seed = 3",
                "load = 1 N, seed = 1"
            ]
        );
        assert_eq!((labels.len(), product.shape()), (6, vec![2, 3]));
        assert_eq!(product.overrides(&product.runs()[5]), ["load.history.value=1 N", "surface.0.seed=3"]);
        assert!(product.runs()[0].name.starts_with("value-0.1N_seed-1_"), "{}", product.runs()[0].name);
        let zip = plan(&[("a.value", "1,2"), ("b.value", "3,4")], true);
        let labels: Vec<String> = zip.runs().iter().map(|run| zip.label(run)).collect();
        assert_eq!((labels, zip.shape()), (vec!["a = 1, b = 3".into(), "a = 2, b = 4".into()], vec![2]));
    }

    #[test]
    fn lists_that_make_no_study_are_refused() {
        let message = |plan: Plan| plan.checked().unwrap_err().to_string();
        assert!(
            message(plan(&[("a", "1,2"), ("b", "1..3")], true)).contains("a has 2 values, b has 3 values")
        );
        assert!(message(plan(&[("a", "100 mN, 0.1 N")], false)).contains("takes the value 0.1 N twice"));
        assert!(message(plan(&[], false)).contains("nothing varies"));
        assert!(message(plan(&[("a", "1..2000"), ("b", "1..2000")], false)).contains("4000000 runs"));
        assert!(plan(&[("a", "1,1"), ("b", "1..2")], true).checked().is_ok());
        assert!(message(plan(&[("a", "1,1"), ("b", "2,2")], true)).contains("same values"));
    }
}
