//! What is wrong with a file of measured curves, and what to do about it.

use std::path::{Path, PathBuf};

use super::{Role, Whole};

/// A file of measured curves that cannot be used, with the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurveError {
    /// The file.
    pub path: PathBuf,
    /// Line of the file (row of the sheet) that is wrong, from 1.
    pub line: Option<usize>,
    /// What is wrong and what was expected.
    pub message: String,
    /// What to do.
    pub remedy: Option<Remedy>,
    /// Where more than that is open: all of it.
    pub whole: Option<Box<Whole>>,
}

/// What to do about a file; its text is in the words of a case file, of the command or of Python.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// Say what was measured.
    Kind,
    /// Say which column holds a quantity.
    Column(Role),
    /// Say the unit of a quantity.
    Unit(Role),
    /// Say which columns there are, with their units.
    Header,
    /// Say how times depend on temperature.
    Shift,
    /// Give a shift in place of an estimate.
    KnownShift,
    /// Fit one of the two moduli of a DMA.
    Moduli,
    /// Fit the part of a curve between these ends.
    Window(String, String),
    /// Convert a column whose unit is not known here.
    Convert(Role),
    /// Say the unit of an angular frequency.
    Radians,
    /// Say which column holds the loss modulus, or fit the storage modulus alone.
    Loss,
    /// Say which of the sheets, named here, to read.
    Sheet(String),
    /// Say which of so many segments to read, or give their temperatures.
    Segment(usize),
}

impl Remedy {
    /// In the words of a case file, of the command and of Python.
    fn words(&self) -> [String; 3] {
        match self {
            Remedy::Kind => [
                "say kind = \"relaxation\", \"creep\" or \"dma\"",
                "give --kind relaxation, creep or dma",
                "give kind=\"relaxation\", \"creep\" or \"dma\"",
            ]
            .map(str::to_owned),
            Remedy::Column(role) => {
                let name = role.name();
                [
                    format!("columns = {{ {name} = N }}"),
                    format!("--column {name}=N"),
                    format!("columns={{\"{name}\": N}}"),
                ]
                .map(|how| format!("name it: {how}, N the number of its column or, in quotes, its header"))
            }
            Remedy::Unit(role) => {
                let (name, unit) = (role.name(), role.example());
                [
                    format!("say units = {{ {name} = \"{unit}\" }}"),
                    format!("give --unit '{name}={unit}'"),
                    format!("say units={{\"{name}\": \"{unit}\"}}"),
                ]
                .map(|how| format!("name the unit in the header, as in \"{name} [{unit}]\", or {how}"))
            }
            Remedy::Convert(role) => {
                let (name, unit) = (role.name(), role.example());
                [
                    format!("say units = {{ {name} = \"{unit}\" }}"),
                    format!("give --unit '{name}={unit}'"),
                    format!("say units={{\"{name}\": \"{unit}\"}}"),
                ]
                .map(|how| {
                    format!("convert the column, to {unit} for one; only if its header is wrong and the numbers are in {unit}, {how}")
                })
            }
            Remedy::Window(first, last) => [
                format!("fit = {{ window = [\"{first}\", \"{last}\"] }}"),
                format!("--window '{first}, {last}'"),
                format!("window=(...) with {first} and {last} in s"),
            ]
            .map(|how| format!("fit the part before, as in {how}")),
            Remedy::Loss => [
                ("columns = { loss = N }", "say fit = { moduli = \"storage\" }"),
                ("--column loss=N", "give --fit storage"),
                ("columns={\"loss\": N}", "say moduli=\"storage\""),
            ]
            .map(|(column, alone)| {
                format!(
                    "name it: {column} (or tan_delta, phase), N the number of its column or, in quotes, its header; or {alone} to fit the storage \
                     modulus alone"
                )
            }),
            Remedy::Radians => [
                "say units = { frequency = \"rad/s\" }",
                "give --unit frequency=rad/s",
                "say units={\"frequency\": \"rad/s\"}",
            ]
            .map(|how| {
                format!(
                    "an angular frequency is in rad/s, as in \"angular frequency [rad/s]\": name the unit in the header, or {how} (Hz only where \
                     the column holds cycles per second)"
                )
            }),
            Remedy::Header => [
                "say columns = { ... } and units = { ... }",
                "give --column and --unit",
                "say columns={...} and units={...}",
            ]
            .map(|how| format!("name each column with its unit, as in \"modulus [MPa]\", or {how}")),
            Remedy::Shift => [
                ", as in shift = { model = \"wlf\", c1 = 8.86, c2 = \"101.6 K\", reference = \"20 °C\" }, or model = \"estimated\" or \
                 \"table\"",
                " with --wlf, --arrhenius, --shift-table or --estimate-shift",
                ": shift=asperity.wlf(c1=..., c2=..., reference=...), or shift=\"estimated\" with reference=...",
            ]
            .map(|how| format!("state how times depend on temperature{how}")),
            Remedy::KnownShift => [
                "shift = { model = \"table\", path = \"factors.csv\" } gives factors, model = \"wlf\" or \"arrhenius\" constants",
                "--shift-table FILE gives factors, --wlf or --arrhenius constants",
                "shift=asperity.shift_table(...) gives factors, asperity.wlf(...) or arrhenius(...) constants",
            ]
            .map(str::to_owned),
            Remedy::Moduli => [
                "say fit = { moduli = \"storage\" } (or \"loss\")",
                "give --fit storage (or loss)",
                "say moduli=\"storage\" (or \"loss\")",
            ]
            .map(str::to_owned),
            Remedy::Segment(count) => [
                ("segment = N", "columns = { temperature = N }"),
                ("--segment N", "--column temperature=N"),
                ("segment=N", "columns={\"temperature\": N}"),
            ]
            .map(|(one, all)| {
                format!(
                    "say which one to read, {one} (1 to {count}); if they are the same step at several temperatures, add a column of temperatures \
                     ({all})"
                )
            }),
            Remedy::Sheet(sheets) => ["sheet = \"...\"", "--sheet NAME", "sheet=\"...\""]
                .map(|key| format!("say which with {key}: {sheets}")),
        }
    }
}

/// In whose words a remedy is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Words {
    /// Keys of a material in a case file.
    Case,
    /// Options of `asperity material fit` and `show`.
    Command,
    /// Arguments of Python's `fit_file`.
    Python,
}

impl Words {
    fn choose(self, [case, command, python]: [String; 3]) -> String {
        match self {
            Words::Case => case,
            Words::Command => command,
            Words::Python => python,
        }
    }
}

/// Result of reading a file of curves.
pub(super) type Result<T, E = CurveError> = std::result::Result<T, E>;

/// A fault before its file is known.
pub(super) fn fault(message: impl Into<String>) -> CurveError {
    CurveError { path: PathBuf::new(), line: None, message: message.into(), remedy: None, whole: None }
}

impl CurveError {
    /// The whole message, with the remedy in these words.
    pub fn told(&self, words: Words) -> String {
        let line = self.line.map(|line| format!(", line {line}")).unwrap_or_default();
        format!("{}{line}: {}{}", self.path.display(), self.message, self.remedies(words))
    }

    /// `; what to do` in these words, or nothing.
    pub fn remedies(&self, words: Words) -> String {
        let remedy = self.remedy.as_ref().map(Remedy::words);
        let whole = self.whole.as_ref().map(|whole| whole.words());
        let told = [remedy, whole].into_iter().flatten().map(|text| format!("; {}", words.choose(text)));
        told.collect()
    }

    pub(super) fn at(self, line: impl Into<Option<usize>>) -> CurveError {
        CurveError { line: line.into(), ..self }
    }

    pub(super) fn remedy(self, remedy: Remedy) -> CurveError {
        CurveError { remedy: Some(remedy), ..self }
    }

    pub(super) fn whole(self, whole: Option<Whole>) -> CurveError {
        CurveError { whole: whole.map(Box::new), ..self }
    }

    pub(super) fn of(mut self, path: &Path) -> CurveError {
        if let Some(whole) = self.whole.as_mut() {
            whole.path = path.to_owned();
        }
        CurveError { path: path.to_owned(), ..self }
    }
}

impl std::fmt::Display for CurveError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.told(Words::Case))
    }
}

impl std::error::Error for CurveError {}
