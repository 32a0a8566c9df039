//! What the tests of results and exports share.

#![allow(dead_code)] // each test program uses a part

pub(crate) mod zarr;

use asperity::{Coordinate, Grid};
use asperity_io::store::{Checkpoint, Field, FieldKind, Header, Result, Row, Writer};
use ndarray::Array2;
use tempfile::TempDir;

/// A small deterministic generator (Weyl sequence and a multiply-shift hash), so that fields have full mantissas.
pub(crate) fn noise(n: usize) -> f64 {
    let mut z = (n as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// A case of `steps` rows whose numbers follow from the step alone, so that a resumed run repeats them.
pub(crate) struct Case {
    pub(crate) header: Header,
    pub(crate) gap: Array2<f64>,
}

impl Case {
    pub(crate) fn new(cells: [usize; 2], fields: &[FieldKind]) -> Case {
        // Sides whose binary fractions do not end, cells that are not square.
        let [nx, ny] = cells.map(|n| n as f64);
        let grid = Grid::new(cells, [nx * 1e-7 / 3.0, ny * 0.7e-7]).unwrap();
        let mut setup = serde_json::Map::new();
        setup.insert("boundary".into(), "free".into());
        setup.insert("creep".into(), serde_json::json!({"instantaneous": 4.013744989e-10 / 3.0}));
        let header = Header {
            title: "rough \"sphere\" \u{00b5}m".into(),
            case_text: "[domain]\ncells = [3, 2]\n\n[time]\nend = \"500 s\"\n".into(),
            version: "0.1.0".into(),
            grid,
            fields: fields.to_vec(),
            quantities: vec![],
            rows_expected: Some(20),
            setup,
        };
        let gap = Array2::from_shape_fn(grid.shape(), |(i, j)| {
            // A punch leaves cells that cannot touch.
            if i + j == 3 { f64::INFINITY } else { 1e-6 * noise(i * cells[1] + j) }
        });
        Case { header, gap }
    }

    /// The same on a line of cells.
    pub(crate) fn line(cells: usize, fields: &[FieldKind]) -> Case {
        let Case { header, gap } = Case::new([cells, 1], fields);
        let grid = Grid::line(cells, header.grid.size()[0]).unwrap();
        Case { header: Header { grid, ..header }, gap }
    }

    /// Numbers of no meaning, but for those that follow from the fields.
    pub(crate) fn row(&self, step: usize) -> Row {
        let (pressure, gap) = (self.pressure(step), self.gap(step));
        let touchable = gap.iter().filter(|gap| gap.is_finite());
        let touching = pressure.iter().filter(|p| **p > 0.0).count();
        Row {
            // Steps 4 and 5 are the two sides of a jump.
            coordinate: Coordinate::Time(if step > 4 { step - 1 } else { step } as f64 / 3.0),
            load: noise(100 + step),
            approach: -noise(step),
            residual: if step == 2 { f64::NAN } else { 1e-7 * noise(step) },
            certificate: if step == 3 { f64::INFINITY } else { noise(step) },
            max_pressure: pressure.iter().copied().fold(0.0, f64::max),
            mean_gap: touchable.clone().sum::<f64>() / touchable.count() as f64,
            contact_fraction: touching as f64 / gap.len() as f64,
            iterations: step,
            convolutions: 2 * step + 1,
            ..Row::default()
        }
    }

    /// Zero over most of the map, capped somewhere, full mantissas elsewhere.
    pub(crate) fn pressure(&self, step: usize) -> Array2<f64> {
        Array2::from_shape_fn(self.header.grid.shape(), |(i, j)| match noise(step + i / 20 + 31 * (j / 20)) {
            u if u < 0.6 => 0.0,
            u if u < 0.7 => 3e8,
            _ => 3e8 * noise(step + 1000 * i + j),
        })
    }

    pub(crate) fn gap(&self, step: usize) -> Array2<f64> {
        &self.gap + step as f64 * 1e-9
    }

    pub(crate) fn contact(&self, step: usize) -> Array2<u8> {
        self.pressure(step).mapv(|p| if p == 3e8 { 2 } else { u8::from(p > 0.0) })
    }

    pub(crate) fn append(&self, writer: &mut Writer, step: usize, keep: bool) -> Result<()> {
        let (p, h, contact) = (self.pressure(step), self.gap(step), self.contact(step));
        let (u, f) = (&h * 0.5, p.mapv(|p| 1e-12 * p));
        // In another order than that of the kinds.
        let all = FieldKind::ALL.into_iter().rev().map(|kind| match kind {
            FieldKind::Contact => Field::Contact(contact.view()),
            FieldKind::Pressure | FieldKind::ContactPressure => Field::Real(kind, p.view()),
            FieldKind::Gap => Field::Real(kind, h.view()),
            FieldKind::Displacement => Field::Real(kind, u.view()),
            _ => Field::Real(kind, f.view()),
        });
        let kept: Vec<_> = all.filter(|f| keep && self.header.fields.contains(&f.kind())).collect();
        writer.append(&self.row(step), &kept)
    }

    /// Appends steps from `first` up to `end`, the fields of every second step.
    pub(crate) fn run(&self, writer: &mut Writer, first: usize, end: usize) {
        for step in first..end {
            self.append(writer, step, step % 2 == 0).unwrap();
        }
    }

    pub(crate) fn checkpoint(&self, step: usize) -> Checkpoint<'static> {
        Checkpoint {
            step,
            numbers: vec![
                ("schedule/stage".into(), vec![noise(step), f64::NAN, -0.0]),
                ("none".into(), vec![]),
                ("history/states".into(), vec![1.0 / 3.0]),
            ],
            fields: vec![
                ("pressure".into(), self.pressure(step).into()),
                ("flow".into(), self.gap(step).into()),
            ],
        }
    }
}

/// A directory of its own and the path of a result in it.
pub(crate) fn place() -> (TempDir, std::path::PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("result.zarr");
    (directory, path)
}

pub(crate) fn bits(map: &Array2<f64>) -> Vec<u64> {
    map.iter().map(|x| x.to_bits()).collect()
}

/// Every number of a row, as bits.
pub(crate) fn row_bits(row: &Row) -> Vec<u64> {
    let Row { coordinate, load, approach, contact_area, contact_area_corrected, contact_fraction, .. } = *row;
    let Row { capped_area, mean_pressure, max_pressure, mean_gap, residual, certificate, .. } = *row;
    let reals = [
        coordinate.value(),
        load,
        approach,
        contact_area,
        contact_area_corrected,
        contact_fraction,
        capped_area,
        mean_pressure,
        max_pressure,
        mean_gap,
        residual,
        certificate,
    ];
    reals.map(f64::to_bits).into_iter().chain([row.iterations as u64, row.convolutions as u64]).collect()
}

pub(crate) fn le_bytes(map: &Array2<f64>) -> Vec<u8> {
    map.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// The Python interpreter `ASPERITY_PYTHON` (default `python3`), if it has these modules; says so if not.
///
/// Where everything is installed that tests need (under `cargo xtask test`, which sets the variable, and where `CI` is
/// set), a Python without them is a failure.
pub(crate) fn python(modules: &str) -> Option<std::ffi::OsString> {
    let named = std::env::var_os("ASPERITY_PYTHON");
    let must_run = named.is_some() || std::env::var_os("CI").is_some();
    let python = named.unwrap_or("python3".into());
    let probe = std::process::Command::new(&python).args(["-c", &format!("import {modules}")]).output();
    if probe.is_ok_and(|probe| probe.status.success()) {
        return Some(python);
    }
    assert!(!must_run, "{} does not import {modules}", python.display());
    eprintln!("skipped: {} does not import {modules}", python.display());
    None
}

/// Runs a script of `tests/python`, in which a warning is a failure; passes on what it says.
pub(crate) fn run_python(python: &std::ffi::OsStr, script: &str, variables: &[(&str, &std::ffi::OsStr)]) {
    let script = format!("{}/tests/python/{script}", env!("CARGO_MANIFEST_DIR"));
    let output = std::process::Command::new(python)
        .args(["-W", "error", &script])
        .envs(variables.iter().copied())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    eprint!("{said}");
}
