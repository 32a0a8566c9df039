//! What a result says about itself: the attributes of its group.

use std::collections::BTreeMap;
use std::path::Path;

use asperity::finding::Finding;
use asperity::quantities::{Column, Quantity};
use asperity::{Axis, Control, Grid};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::error::{Result, StoreError, corrupt};
use super::field_kind::FieldKind;
use super::leak;
use crate::{choice, finding};

/// Value of the attribute `format`: marks the directories that this store may replace.
const FORMAT: &str = "asperity-result";
/// Number of the form described in [`super`]; it grows when an older reader would misread a newer result.
/// Form 1 had no checksums.
pub(super) const SCHEMA: u64 = 2;

/// What is known of a run before it starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Title of the case.
    pub title: String,
    /// The case file as text, as it was run; empty for what Python solved without one.
    pub case_text: String,
    /// Version of asperity that runs it.
    pub version: String,
    /// The grid of the fields.
    pub grid: Grid,
    /// The fields that are kept.
    pub fields: Vec<FieldKind>,
    /// The quantities that each row has besides those of every result.
    pub quantities: Vec<Column>,
    /// Rows of the full run, where known.
    pub rows_expected: Option<usize>,
    /// The case in numbers (bodies, creep terms, boundary, ...), for readers that know no case files.
    pub setup: Map<String, Value>,
}

impl Header {
    /// Whether displacements and approach are known up to a constant: in a line contact on a free domain, unless all bodies lie on a
    /// rigid base.
    pub fn is_up_to_a_constant(&self) -> bool {
        self.grid.is_line()
            && !self.is_periodic()
            && self.setup.get("layer_rigid_base").and_then(Value::as_bool) != Some(true)
    }

    /// Boundary and bodies in words: "periodic half-space", "free domain, layers on a rigid base".
    pub fn boundary(&self) -> Option<String> {
        let bodies = match self.setup.get("layer_rigid_base").and_then(Value::as_bool) {
            None => "half-space",
            Some(true) => "domain, layers on a rigid base",
            Some(false) => "domain, layers on a half-space",
        };
        let word = self.setup.get("boundary").and_then(Value::as_str)?;
        Some(format!("{} {bodies}", if word == "periodic" { "periodic" } else { "free" }))
    }

    /// Whether the domain repeats itself.
    pub fn is_periodic(&self) -> bool {
        self.setup.get("boundary").and_then(Value::as_str) == Some("periodic")
    }

    /// What each stage prescribes; empty where the result does not say it.
    pub fn controls(&self) -> Vec<Control> {
        let stages = self.setup.get(Header::CONTROLS).cloned();
        stages.and_then(|stages| serde_json::from_value(stages).ok()).unwrap_or_default()
    }

    /// The key of [`Header::controls`] in the setup.
    pub(crate) const CONTROLS: &'static str = "stage_controls";

    /// Whether other tractions than the contact pressure act on the surfaces: adhesion, a fluid.
    pub(crate) fn has_other_tractions(&self) -> bool {
        let coupling = self.setup.get("leakage").and_then(|leakage| leakage.get("coupling"));
        self.adhesion().is_some() || coupling.is_some_and(|coupling| !coupling.is_null())
    }

    /// The numbers of its adhesion, by the names of [`AdhesionScale`](asperity::traction::AdhesionScale).
    pub fn adhesion(&self) -> Option<&Map<String, Value>> {
        self.setup.get(Header::ADHESION).and_then(Value::as_object)
    }

    /// The key of [`Header::adhesion`] in the setup.
    pub(crate) const ADHESION: &'static str = "adhesion";

    /// The key of the numbers of its friction in the setup.
    pub(crate) const FRICTION: &'static str = "friction";

    /// The key of the numbers of its wear in the setup.
    pub(crate) const WEAR: &'static str = "wear";

    /// The key of its flash temperature in the setup.
    pub(crate) const FLASH: &'static str = "flash";

    /// Whether friction holds a load along the surfaces.
    pub fn slips(&self) -> bool {
        self.setup.contains_key(Header::FRICTION)
    }

    /// Whether its surfaces wear.
    pub fn wears(&self) -> bool {
        self.setup.contains_key(Header::WEAR)
    }

    /// Whether friction warms its surfaces.
    pub fn warms(&self) -> bool {
        self.setup.contains_key(Header::FLASH)
    }

    /// Whether its undeformed surfaces change their shape: they wear, or flatten for good.
    pub fn changes_shape(&self) -> bool {
        self.wears() || self.setup.get("plasticity").and_then(Value::as_str) == Some("accumulate")
    }

    /// Whether its surfaces move over each other from row to row.
    pub fn moves_in_time(&self) -> bool {
        self.setup.contains_key("motion") && self.axis() == Axis::Time
    }

    /// Whether its surfaces move over each other, in time or in steady states.
    pub fn moves(&self) -> bool {
        self.setup.contains_key("motion")
    }

    /// What its rows follow one another in.
    pub fn axis(&self) -> Axis {
        match self.setup.get("motion").and_then(|motion| motion.get("steady")).and_then(Value::as_bool) {
            Some(true) => Axis::Velocity,
            _ => Axis::Time,
        }
    }

    /// The name that an array or a dimension has in this result: over velocities they take the place of the times.
    pub(crate) fn stored(&self, name: &'static str) -> &'static str {
        match (name, self.axis()) {
            ("time", Axis::Velocity) => "velocity",
            ("field_time", Axis::Velocity) => "field_velocity",
            ("leak_time", Axis::Velocity) => leak::VELOCITY.name,
            (name, _) => name,
        }
    }
}

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Under way, or killed: see [`Reader::is_being_written`](super::Reader::is_being_written).
    #[default]
    Running,
    /// All rows are there.
    Complete,
    /// Stopped by its user; can be resumed.
    Interrupted,
    /// Stopped by an error, named in [`Work::message`]; the rows before it are good.
    Failed,
}

/// Work done so far, over all sessions of a resumed run.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Work {
    /// Time on the clock \[s\].
    pub wall_s: f64,
    /// Iterations of all rows.
    pub iterations: u64,
    /// Convolutions of all rows.
    pub convolutions: u64,
    /// Largest memory of the process \[byte\], where measured.
    pub peak_memory_bytes: Option<u64>,
    /// Threads used, where known.
    pub threads: Option<usize>,
    /// Why a run stopped that is not complete.
    pub message: Option<String>,
}

impl Status {
    /// The word in the attribute `status`.
    pub fn as_str(self) -> &'static str {
        choice::word(&self)
    }
}

impl std::fmt::Display for Status {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

/// Checksums by the name of the array.
pub(super) type Sums = BTreeMap<String, u32>;

/// How much of a run is stored.
#[derive(Clone, Debug, Default)]
pub(super) struct Progress {
    pub(super) status: Status,
    pub(super) work: Work,
    /// Rows.
    pub(super) rows: usize,
    /// Instants of the fields.
    pub(super) maps: usize,
    /// What the run found about itself.
    pub(super) findings: Vec<Finding>,
    /// Checksums of the per-step arrays.
    pub(super) sums: Sums,
}

impl Progress {
    /// The length that a dimension has now, if it grows with the run.
    pub(super) fn length_of(&self, dimension: &str) -> Option<usize> {
        match dimension {
            "time" | "velocity" => Some(self.rows),
            "field_time" | "field_velocity" => Some(self.maps),
            _ => None,
        }
    }
}

/// Attributes of the group: numbers and text only, apart from the findings, so that xarray can pass them on to NetCDF.
pub(super) fn attributes(header: &Header, form: u64) -> Map<String, Value> {
    let (cells, size) = (header.grid.cells(), header.grid.extents());
    let fields: Vec<_> = header.fields.iter().map(|kind| kind.name()).collect();
    let setup = |key: &str| header.setup.get(key);
    let mut map = Map::new();
    let mut put = |key: &str, value: Value| map.insert(key.to_owned(), value);
    put("title", json!(header.title));
    put("format", json!(FORMAT));
    put("schema", json!(form));
    put("version", json!(header.version));
    put("case", json!(header.case_text));
    put("setup", json!(Value::Object(header.setup.clone()).to_string()));
    if let (Some(separable), Some(misfit)) =
        (setup("layer_separable").and_then(Value::as_bool), setup("layer_misfit"))
    {
        put("layer_separable", json!(u8::from(separable)));
        put("layer_misfit", misfit.clone());
    }
    // One number each of a line.
    put("cells", json!(cells[..header.grid.dimensions()]));
    put("size", json!(size));
    put("fields", json!(fields.join(" ")));
    if !header.quantities.is_empty() {
        let columns = header.quantities.iter();
        let columns = columns.map(|c| json!({"name": c.quantity.name(), "edges": c.edges}));
        put("quantities", json!(Value::Array(columns.collect()).to_string()));
    }
    if let Some(rows) = header.rows_expected {
        put("rows_expected", json!(rows));
    }
    map
}

/// Sets the attributes that change as the run goes on.
pub(super) fn put_progress(map: &mut Map<String, Value>, progress: &Progress) {
    let work = &progress.work;
    let mut put = |key: &str, value: Option<Value>| match value {
        Some(value) => map.insert(key.to_owned(), value),
        None => map.shift_remove(key),
    };
    put("status", Some(json!(progress.status.as_str())));
    put("status_message", work.message.as_ref().map(|message| json!(message)));
    put("work_wall_s", Some(json!(work.wall_s)));
    put("work_iterations", Some(json!(work.iterations)));
    put("work_convolutions", Some(json!(work.convolutions)));
    put("work_peak_memory_bytes", work.peak_memory_bytes.map(|bytes| json!(bytes)));
    put("work_threads", work.threads.map(|threads| json!(threads)));
    put("findings", Some(finding::list(&progress.findings)));
}

/// Whether the attributes are those of a result of any version.
pub(super) fn is_marked(attributes: &Map<String, Value>) -> bool {
    attributes.get("format").and_then(Value::as_str) == Some(FORMAT)
}

/// The inverse of [`attributes`] and [`put_progress`]; `path` is the result, `file` the document they were read from.
pub(super) fn parse(
    attributes: &Map<String, Value>,
    path: &Path,
    file: &Path,
) -> Result<(Header, Status, Work, u64)> {
    if !is_marked(attributes) {
        let why = format!("its Zarr group lacks the attribute format = \"{FORMAT}\"");
        return Err(StoreError::NotAResult { path: path.to_owned(), why });
    }
    let missing = |key: &str| corrupt(file, format_args!("the attribute `{key}` is missing or malformed"));
    let text = |key: &str| attributes.get(key).and_then(Value::as_str).ok_or_else(|| missing(key));
    let count = |key: &str| attributes.get(key).and_then(Value::as_u64);
    let list = |key: &str| attributes.get(key).and_then(Value::as_array).map(Vec::as_slice);

    let version = text("version")?.to_owned();
    let schema = count("schema").ok_or_else(|| missing("schema"))?;
    if schema > SCHEMA {
        return Err(StoreError::Newer { path: path.to_owned(), version, schema, known: SCHEMA });
    }
    let number = |value: &Value| Some(usize::try_from(value.as_u64()?).unwrap_or(usize::MAX));
    let cells: Option<Vec<usize>> = list("cells").and_then(|list| list.iter().map(number).collect());
    let size: Option<Vec<f64>> = list("size").and_then(|list| list.iter().map(Value::as_f64).collect());
    let grid = match (cells.as_deref(), size.as_deref()) {
        (Some(&[n]), Some(&[length])) => Grid::line(n, length),
        (Some(&[nx, ny]), Some(&[lx, ly])) => Grid::new([nx, ny], [lx, ly]),
        (Some([_] | [_, _]), _) => return Err(missing("size")),
        _ => return Err(missing("cells")),
    };
    let grid = grid.map_err(|error| corrupt(file, error))?;
    let fields = text("fields")?
        .split_whitespace()
        .map(|name| FieldKind::from_name(name).ok_or_else(|| missing("fields")))
        .collect::<Result<Vec<_>>>()?;
    let quantities = match attributes.get("quantities") {
        None => vec![],
        Some(text) => quantities(text).ok_or_else(|| missing("quantities"))?,
    };
    let setup = serde_json::from_str(text("setup")?).map_err(|_| missing("setup"))?;
    let status = choice::parse(text("status")?).ok_or_else(|| missing("status"))?;
    let header = Header {
        title: text("title")?.to_owned(),
        case_text: text("case")?.to_owned(),
        version,
        grid,
        fields,
        quantities,
        rows_expected: count("rows_expected").and_then(|n| usize::try_from(n).ok()),
        setup,
    };
    let work = Work {
        wall_s: attributes.get("work_wall_s").and_then(Value::as_f64).unwrap_or(0.0),
        iterations: count("work_iterations").unwrap_or(0),
        convolutions: count("work_convolutions").unwrap_or(0),
        peak_memory_bytes: count("work_peak_memory_bytes"),
        threads: count("work_threads").and_then(|n| usize::try_from(n).ok()),
        message: attributes.get("status_message").and_then(Value::as_str).map(str::to_owned),
    };
    Ok((header, status, work, schema))
}

/// The inverse of the attribute `quantities`; `None` where it is malformed.
fn quantities(attribute: &Value) -> Option<Vec<Column>> {
    let columns: Value = serde_json::from_str(attribute.as_str()?).ok()?;
    let mut found: Vec<Column> = vec![];
    for column in columns.as_array()? {
        let quantity = Quantity::from_name(column.get("name")?.as_str()?)?;
        let edges = column.get("edges")?.as_array()?.iter().map(Value::as_f64).collect::<Option<Vec<_>>>()?;
        let rising = edges.windows(2).all(|pair| pair[0] < pair[1]);
        let fits = if quantity.is_histogram() { edges.len() >= 2 && rising } else { edges.is_empty() };
        if !fits || found.iter().any(|other| other.quantity == quantity) {
            return None;
        }
        found.push(Column { quantity, edges });
    }
    Some(found)
}
