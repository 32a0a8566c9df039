//! The document of the group (`zarr.json`): attributes and, consolidated, the metadata of every array.
//!
//! It is the one place that says how many rows and fields there are, and it is replaced as a whole:
//! a reader sees a step as a whole or not at all, whenever the run is killed. The arrays' own
//! documents repeat their part for readers that do not consolidate; they may lag behind, all by
//! the same number of rows.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use super::checkpoint;
use super::checksum;
use super::error::{Result, StoreError, corrupt, io};
use super::header::{self, Header, Progress};
use super::layout::{self, ArraySpec};
use super::leak::Leaks;
use super::replace::{Way, replace};
use super::stress::StressSet;
use super::sync;
use crate::finding;
use crate::resources;

pub(super) const NAME: &str = "zarr.json";
/// The attribute of the group with the error bars of its answers.
pub(super) const ERROR_BARS: &str = "error_bars";
/// Where documents are written first; that of the group in an array's directory, where no reader of the
/// hierarchy looks.
pub(super) const PARTIAL: &str = "zarr.json.partial";
pub(super) const GROUP_PARTIAL: &str = "x/group.json.partial";
/// Larger documents are not read: that of a result has tens of kilobytes and the case file.
const LARGEST: u64 = 64 << 20;

/// What the group's document says.
#[derive(Clone, Debug)]
pub(super) struct Document {
    /// Number of the form: 1 has no checksums.
    pub(super) form: u64,
    pub(super) header: Header,
    pub(super) progress: Progress,
    /// The stress below the surface, where it was computed.
    pub(super) stress: Option<StressSet>,
    /// Leaks that were computed from its fields.
    pub(super) leaks: Option<Leaks>,
    /// Its answers with their errors, as they were stored.
    pub(super) error_bars: Option<Value>,
}

/// The documents as JSON, kept between steps: only a few numbers of them change.
pub(super) struct Pages {
    group: Value,
    /// Checksum of the attributes that do not change.
    guarded: u32,
}

impl Pages {
    pub(super) fn new(document: &Document) -> Self {
        let arrays = document.arrays();
        let metadata: Map<_, _> =
            arrays.iter().map(|array| (array.name().to_owned(), array.document())).collect();
        let mut attributes = header::attributes(&document.header, document.form);
        header::put_progress(&mut attributes, &document.progress);
        attributes.extend(document.stress_attribute());
        attributes.extend(document.leaks.iter().map(Leaks::attribute));
        let guarded = checksum::guarded(&attributes);
        let consolidated = json!({"kind": "inline", "must_understand": false, "metadata": metadata});
        let group = json!({
            "zarr_format": 3,
            "node_type": "group",
            "attributes": attributes,
            "consolidated_metadata": consolidated,
        });
        Pages { group, guarded }
    }

    /// Writes the documents of a result, first those of the arrays: they never count more than that of the group.
    pub(super) fn publish(root: &Path, document: &Document) -> Result<Pages> {
        let mut pages = Pages::new(document);
        pages.write_arrays(root, Way::Safe)?;
        pages.commit(root, &document.progress, Way::Safe)?;
        Ok(pages)
    }

    /// Replaces the group's document: from now on readers see `progress`.
    pub(super) fn commit(&mut self, root: &Path, progress: &Progress, way: Way) -> Result<()> {
        if let Some(attributes) = self.group["attributes"].as_object_mut() {
            header::put_progress(attributes, progress);
            checksum::put(attributes, self.guarded, progress);
        }
        if let Some(arrays) = self.group["consolidated_metadata"]["metadata"].as_object_mut() {
            for array in arrays.values_mut() {
                let dimension = array["dimension_names"][0].as_str().unwrap_or_default();
                if let Some(length) = progress.length_of(dimension) {
                    array["shape"][0] = json!(length);
                }
            }
        }
        replace(&root.join(NAME), &root.join(GROUP_PARTIAL), self.group.to_string().as_bytes(), way)
    }

    /// Keeps a copy of the group's document, as it was committed last, with the checkpoint; it is on the medium when this
    /// returns.
    pub(super) fn write_copy(&self, root: &Path) -> Result<()> {
        let directory = checkpoint::directory(root)?;
        let (path, partial) = (directory.join(checkpoint::GROUP), directory.join(checkpoint::GROUP_PARTIAL));
        replace(&path, &partial, self.group.to_string().as_bytes(), Way::Safe)?;
        sync::file(&path)?;
        sync::directory(&directory);
        Ok(())
    }

    /// Brings the arrays' own documents up to what was committed.
    pub(super) fn write_arrays(&self, root: &Path, way: Way) -> Result<()> {
        let arrays = self.group["consolidated_metadata"]["metadata"].as_object();
        arrays.into_iter().flatten().try_for_each(|(name, array)| write(&root.join(name), array, way))
    }
}

impl Document {
    /// All arrays of the result.
    pub(super) fn arrays(&self) -> Vec<ArraySpec> {
        let (grid, Progress { rows, maps, .. }) = (&self.header.grid, &self.progress);
        let mut arrays = layout::arrays(&self.header, *rows, *maps);
        arrays.extend(self.stress.iter().flat_map(|set| set.arrays(&self.header, *maps)));
        arrays.extend(self.leaks.iter().flat_map(|leaks| leaks.arrays(grid)));
        arrays.into_iter().map(|array| array.of_form(self.form)).collect()
    }

    /// The attribute `stress` of the group.
    pub(super) fn stress_attribute(&self) -> Option<(String, Value)> {
        self.stress.as_ref().map(|set| ("stress".to_owned(), json!(set.to_text())))
    }

    /// Reads and checks the document of the result at `root`.
    pub(super) fn read(root: &Path) -> Result<Document> {
        let (file, document) = read_json(root)?;
        let empty = Map::new();
        let attributes = document.get("attributes").and_then(Value::as_object).unwrap_or(&empty);
        let (header, status, work, form) = header::parse(attributes, root, &file)?;
        let metadata = document
            .pointer("/consolidated_metadata/metadata")
            .and_then(Value::as_object)
            .ok_or_else(|| corrupt(&file, "the consolidated metadata are missing"))?;
        let length = |name: &str| {
            let shape = metadata.get(name).and_then(|array| array.pointer("/shape/0"));
            let length = shape.and_then(Value::as_u64).and_then(|n| usize::try_from(n).ok());
            length.ok_or_else(|| corrupt(&file, format_args!("the array `{name}` is missing or malformed")))
        };
        let findings = attributes.get("findings").map(finding::from_list).unwrap_or_default();
        let sums = checksum::of(attributes).map_err(|what| corrupt(&file, what))?;
        let (rows, maps) = (length(header.stored("time"))?, length(header.stored("field_time"))?);
        let progress = Progress { status, work, rows, maps, findings, sums };
        let stress = match attributes.get("stress") {
            None => None,
            Some(text) => {
                let set = text.as_str().and_then(|text| StressSet::parse(text, progress.maps));
                Some(set.ok_or_else(|| corrupt(&file, "the attribute `stress` is malformed"))?)
            }
        };
        let leaks = Leaks::of(attributes, metadata);
        let error_bars = attributes.get(ERROR_BARS).cloned();
        let document = Document { form, header, progress, stress, leaks, error_bars };
        for array in document.arrays() {
            if metadata.get(array.name()).is_none_or(|stored| !same_form(stored, &array.document())) {
                let what = format!("the array `{}` is missing or not of the form of a result", array.name());
                return Err(corrupt(&file, what));
            }
        }
        checksum::check(attributes, &document.progress).map_err(|what| corrupt(&file, what))?;
        Ok(document)
    }
}

/// Stores the error bars of the answers of a complete result.
///
/// # Errors
/// [`StoreError::Io`] where the system refuses.
pub fn store_error_bars(root: &Path, bars: Value) -> Result<()> {
    let (file, mut group) = read_json(root)?;
    let attributes = group["attributes"].as_object_mut();
    attributes.ok_or_else(|| corrupt(&file, "the attributes are missing"))?.insert(ERROR_BARS.into(), bars);
    replace(&file, &root.join(GROUP_PARTIAL), group.to_string().as_bytes(), Way::Safe)
}

/// Whether the directory is marked as a result, of any version.
pub(super) fn is_result(root: &Path) -> bool {
    read_json(root).is_ok_and(|(_, document)| {
        document.get("attributes").and_then(Value::as_object).is_some_and(header::is_marked)
    })
}

/// Writes `zarr.json` of an array or a group within the result, and makes its directory.
pub(super) fn write(directory: &Path, document: &Value, way: Way) -> Result<()> {
    fs::create_dir_all(directory).map_err(io("make", directory))?;
    replace(&directory.join(NAME), &directory.join(PARTIAL), document.to_string().as_bytes(), way)
}

/// The document of a group or an array, and its path.
pub(super) fn read_json(root: &Path) -> Result<(PathBuf, Value)> {
    let absent = |why: String| StoreError::NotAResult { path: root.to_owned(), why };
    let file = root.join(NAME);
    let length = match fs::metadata(&file) {
        Ok(metadata) => metadata.len(),
        Err(_) if !root.exists() => return Err(absent(
            "there is no such file or directory; check the path (asperity run writes results as NAME.zarr)"
                .into(),
        )),
        Err(_) if !root.is_dir() => return Err(absent("it is a file, a result is a directory".into())),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return Err(absent(format!("it has no {NAME}")));
        }
        Err(source) => return Err(StoreError::Io { path: file, action: "read", source }),
    };
    if length > LARGEST {
        return Err(corrupt(&file, format_args!("{length} bytes, more than a result's document has")));
    }
    let bytes = resources::read(&file).map_err(io("read", &file))?;
    let document = serde_json::from_slice(&bytes).or_else(|error| {
        // After a loss of power the text may be incomplete.
        let copy = resources::read(&root.join(checkpoint::DIRECTORY).join(checkpoint::GROUP));
        copy.ok().and_then(|bytes| serde_json::from_slice(&bytes).ok()).ok_or(error)
    });
    Ok((file.clone(), document.map_err(|error| corrupt(&file, error))?))
}

/// Whether two documents are of the same array, apart from its attributes.
fn same_form(stored: &Value, expected: &Value) -> bool {
    let (Some(stored), Some(expected)) = (stored.as_object(), expected.as_object()) else { return false };
    expected.iter().all(|(key, value)| key == "attributes" || stored.get(key) == Some(value))
}
