//! The report: one HTML file that holds a result's curves and maps and needs no network.
//!
//! Maps are stored as 16-bit numbers between their ends, reduced to means over blocks of cells where
//! the file would grow beyond [`Options::bytes`]; the page says so.

mod blob;
mod facts;
mod live;
mod maps;
mod material;
mod state;
mod stress;
mod surface;

pub use live::{Answer, Live};

use std::path::Path;

use asperity_io::output::{self, WriteError};
use asperity_io::store::{Reader, StoreError};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

const PAGE: &str = include_str!("../../page/page.html");
/// The look of the page, which other pages of asperity share.
pub const STYLE: &str = include_str!("../../page/style.css");
/// In the order in which they use one another; all are one script.
const SCRIPT: [&str; 10] = [
    include_str!("../../page/units.js"),
    include_str!("../../page/dom.js"),
    include_str!("../../page/chart.js"),
    include_str!("../../page/maps.js"),
    include_str!("../../page/colours.js"),
    include_str!("../../page/relief.js"),
    include_str!("../../page/curves.js"),
    include_str!("../../page/fields.js"),
    include_str!("../../page/controls.js"),
    include_str!("../../page/main.js"),
];
/// uPlot 1.6.32 as published in the npm registry, which draws the curves.
const LIBRARY: &str = include_str!("../../page/uplot/uPlot.iife.min.js");
const LIBRARY_STYLE: &str = include_str!("../../page/uplot/uPlot.min.css");
const LIBRARY_LICENSE: &str = include_str!("../../page/uplot/LICENSE-uPlot");

/// How a report is made.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Largest size of the maps in the file \[byte\]; they are reduced until they fit. Default: 12 million.
    pub bytes: usize,
    /// Largest number of instants whose maps are in the file, spread evenly. Default: 24.
    pub instants: usize,
    /// Whether a file that is there is replaced.
    pub force: bool,
}

impl Default for Options {
    fn default() -> Self {
        Options { bytes: 12_000_000, instants: 24, force: false }
    }
}

/// Why a report cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The result is damaged or has no row yet.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Writes the report of a result to `path`. The file appears whole or not at all.
///
/// # Errors
/// [`ReportError::Store`] where the result has no row yet or is damaged; [`ReportError::Write`] where there is a file already and
/// `force` is not given, or the system refuses.
pub fn write(reader: &Reader, path: &Path, options: &Options) -> Result<(), ReportError> {
    // What cannot be replaced is reported before the work.
    if !options.force && path.exists() {
        return Err(WriteError::Exists { path: path.to_owned() }.into());
    }
    Ok(output::write_all(path, options.force, page(reader, options)?.as_bytes())?)
}

/// The report of a result as HTML.
///
/// # Errors
/// [`StoreError`] where the result has no row yet or is damaged.
pub fn page(reader: &Reader, options: &Options) -> Result<String, StoreError> {
    let maps = maps::Maps::of(reader, options)?;
    let mut state = state::state(reader, &maps)?;
    if let Some(picture) = stress::picture(reader)? {
        state["stress"]["svg"] = STANDARD.encode(picture).into();
    }
    if let Some(picture) = leak_map(reader) {
        state["leak_map"] = picture.into();
    }
    if let Some(picture) = fluid_map(reader) {
        state["fluid_map"] = picture.into();
    }
    let blobs: String = maps.blobs.iter().map(|(name, data)| element(name, data)).collect();
    Ok(filled_page(reader, &state, &blobs))
}

/// The flow at the last instant at which the seal leaks. A page without this picture is still a page.
fn leak_map(reader: &Reader) -> Option<String> {
    reader.leaks()?;
    crate::result::last_leak_map(reader).ok().map(|figure| figure.to_svg())
}

/// Contact and fluid, where the fluid acts on the surfaces. A page without this picture is still a page.
fn fluid_map(reader: &Reader) -> Option<String> {
    crate::result::largest_fluid_map(reader).ok().map(|figure| figure.to_svg())
}

/// The page with its state and its maps.
fn filled_page(reader: &Reader, state: &serde_json::Value, blobs: &str) -> String {
    filled(&[
        ("title", &escaped(&state::title(reader))),
        ("style", STYLE),
        ("library", LIBRARY),
        ("library-style", LIBRARY_STYLE),
        ("library-license", &escaped(LIBRARY_LICENSE)),
        ("state", &embedded(state)),
        ("blobs", blobs),
        ("script", &SCRIPT.concat()),
    ])
}

/// JSON inside of a script, which no text of it may end. JSON leaves the last control characters as they are.
fn embedded(state: &serde_json::Value) -> String {
    let mut text = String::new();
    for c in state.to_string().chars() {
        if c == '<' || c.is_control() {
            text += &format!("\\u{:04x}", u32::from(c));
        } else {
            text.push(c);
        }
    }
    text
}

/// The page with its places filled, in one pass: what is filled in is not searched again.
fn filled(parts: &[(&str, &str)]) -> String {
    let mut page =
        String::with_capacity(PAGE.len() + parts.iter().map(|(_, text)| text.len()).sum::<usize>());
    let mut rest = PAGE;
    while let Some((before, after)) = rest.split_once("{{") {
        page.push_str(before);
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        page.push_str(parts.iter().find(|(part, _)| *part == name).map_or("", |(_, text)| text));
        rest = after;
    }
    page + rest
}

fn element(name: &str, data: &[u8]) -> String {
    format!("<script type=\"application/base64\" id=\"blob-{name}\">{}</script>\n", STANDARD.encode(data))
}

/// A text as HTML, in which control characters are replacement characters: pages with them are not valid.
pub(crate) fn escaped(text: &str) -> String {
    let shown = |c: char| if c.is_control() && !matches!(c, '\n' | '\t') { '\u{fffd}' } else { c };
    let text: String = text.chars().map(shown).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests;
