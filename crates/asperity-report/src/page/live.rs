//! The page of a result that is read as it is looked at: maps at full resolution, and a run that goes on.

use std::path::{Path, PathBuf};

use asperity_io::store::{At, FieldKind, Reader, StoreError};
use serde_json::json;

use super::blob::packed;
use super::maps::{Maps, one};
use super::{filled_page, state, stress, surface};

/// A result to look at.
#[derive(Clone, Debug, PartialEq)]
pub struct Live {
    path: PathBuf,
}

/// What a browser is sent.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The media type.
    pub content_type: &'static str,
    /// The content.
    pub content: Vec<u8>,
}

impl Live {
    /// The result at `path`, which is opened anew for every answer.
    pub fn new(path: &Path) -> Live {
        Live { path: path.to_owned() }
    }

    /// What is at a path of the page: `/`, `/state`, `/stress.svg`, `/leak.svg`, `/fluid.svg`, `/map/NAME`; `None` where nothing is.
    ///
    /// # Errors
    /// [`StoreError`] where the result is damaged, has no row yet or not this map.
    pub fn answer(&self, path: &str) -> Result<Option<Answer>, StoreError> {
        let reader = Reader::open(&self.path)?;
        let svg = |picture: Option<String>| ("image/svg+xml", picture.map(String::into_bytes));
        let (content_type, content) = match path {
            "/" => {
                let page = filled_page(&reader, &state_of(&reader, true)?, "");
                ("text/html; charset=utf-8", Some(page.into_bytes()))
            }
            "/state" => ("application/json", Some(state_of(&reader, false)?.to_string().into_bytes())),
            "/stress.svg" => svg(stress::picture(&reader)?),
            "/leak.svg" => svg(super::leak_map(&reader)),
            "/fluid.svg" => svg(super::fluid_map(&reader)),
            path => {
                let map = path.strip_prefix("/map/").map(|name| map(&reader, name)).transpose()?;
                ("application/octet-stream", map.flatten())
            }
        };
        Ok(content.map(|content| Answer { content_type, content }))
    }
}

/// What the page knows besides its maps; the surface only the first time, as it does not change.
fn state_of(reader: &Reader, first: bool) -> Result<serde_json::Value, StoreError> {
    let mut state = state::state(reader, &Maps::live(reader, first)?)?;
    state["live"] = json!(true);
    state["running"] = json!(reader.is_being_written());
    Ok(state)
}

fn map(reader: &Reader, name: &str) -> Result<Option<Vec<u8>>, StoreError> {
    match name {
        "initial" => return Ok(Some(packed(reader.initial_gap()?.view()))),
        "surface" => return Ok(surface::surface(reader)?.map(|(heights, _)| packed(heights.view()))),
        _ => {}
    }
    let Some((kind, index)) = name.split_once('-') else { return Ok(None) };
    let (Some(kind), Ok(index)) = (FieldKind::from_name(kind), index.parse()) else { return Ok(None) };
    Ok(Some(packed(one(reader, kind, At::Index(index), 1)?.view())))
}
