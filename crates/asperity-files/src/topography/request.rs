//! What the caller asks for: a format and a channel.

use super::finish::Unit;
use super::{Format, Problem, Result};

/// What the caller asks for.
pub(super) struct Request<'a> {
    /// The format that it reads, for messages.
    pub format: Format,
    /// Name or number of the channel.
    pub channel: Option<&'a str>,
    /// Whether the caller named the format, rather than the content.
    pub insists: bool,
}

impl Request<'_> {
    /// The channel asked for by name (any case) or number, or the first.
    pub(super) fn choose(&self, names: &[String]) -> Result<usize> {
        if names.is_empty() {
            return Err(self.no_heights("no channel with heights in it"));
        }
        let Some(wanted) = self.channel else { return Ok(0) };
        names
            .iter()
            .position(|n| n == wanted)
            .or_else(|| names.iter().position(|n| n.to_lowercase() == wanted.to_lowercase()))
            .or_else(|| wanted.parse().ok().filter(|i| *i < names.len()))
            .ok_or_else(|| Problem::NoChannel { wanted: wanted.into(), available: names.to_vec() })
    }

    /// The channel asked for; by default the first of heights, and without one the first.
    ///
    /// A length is not always a height (the deflection of a cantilever is one too): names decide first.
    pub(super) fn choose_heights(&self, names: &[String], unit: impl Fn(usize) -> Unit) -> Result<usize> {
        const NAMES: [&str; 6] = ["height", "zsensor", "z-axis", "topo", "elevation", "relief"];
        let first = self.choose(names)?;
        if self.channel.is_some() {
            return Ok(first);
        }
        let lengths = || (0..names.len()).filter(|i| matches!(unit(*i), Unit::Metres(_)));
        let is_named = |i: &usize| {
            let name = names[*i].to_lowercase();
            NAMES.iter().any(|word| name.contains(word))
        };
        Ok(lengths().find(is_named).or_else(|| lengths().next()).unwrap_or(first))
    }

    /// The file holds no map of heights; `detail` says what it holds instead.
    pub(super) fn no_heights(&self, detail: impl Into<String>) -> Problem {
        Problem::NoHeights { format: self.format, detail: detail.into() }
    }
}

/// Refuses a file of more channels than any instrument writes: every one is looked at.
pub(super) fn check_channels(count: usize) -> Result<()> {
    const MOST: usize = 1000;
    match count <= MOST {
        true => Ok(()),
        false => Err(Problem::malformed("the number of channels", count, format!("at most {MOST}"))),
    }
}
