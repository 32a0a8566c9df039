//! What the page asks for, as a command line of this program: it is run, and shown for copying, with the same in Python.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::folder::Folder;

/// Options of `asperity surface` that the page offers: name, words, example.
pub const SURFACE: &[Choice] = &[
    ("size", "size, where the file does not state it", "1 mm,1 mm"),
    ("height-unit", "unit of the heights, where the file does not state it", "um"),
    ("channel", "channel, where there are several", "0"),
];
/// Of `asperity surface info` besides.
pub const SPECTRUM: &[Choice] = &[
    ("longest", "longest wavelength of the fitted Hurst exponent", "50 um"),
    ("shortest", "shortest wavelength of it", "1 um"),
];
/// Of `asperity material fit`.
pub const FIT: &[Choice] = &[
    ("modulus", "moduli: young or shear", "young"),
    ("estimate-shift", "shift estimated about this temperature", "20 °C"),
    ("wlf", "WLF shift: C1, C2, reference", "8.86, 101.6 K, 20 °C"),
    ("fit", "what is fitted: both, storage or loss", "both"),
    ("vertical", "vertical shift: density or free", "density"),
    ("max-terms", "terms at most", "12"),
    ("window", "part of the curve", "0.1 Hz, 100 Hz"),
    ("long-time", "after the data: free, solid or fluid", "solid"),
    ("sheet", "sheet of a spreadsheet", "Sheet1"),
    ("segment", "which of several steps or sweeps, from 1", "1"),
    ("kind", "what was measured: relaxation, creep or dma", "dma"),
    ("column", "columns of quantities, by number or header", "frequency=1; storage=2"),
    ("unit", "units that the header does not name", "storage=MPa"),
    ("arrhenius", "Arrhenius shift: energy, reference", "120 kJ/mol, 20 °C"),
    ("shift-table", "file of shift factors, in this folder", "shifts.csv"),
    ("misfit", "misfit to hold with few terms", "2 %"),
    ("max-misfit", "relative misfit above which data are refused", "20 %"),
];
/// Of `asperity fit-indentation`.
pub const INDENTATION: &[Choice] = &[
    ("radius", "radius of the sphere", "5 mm"),
    ("indenter", "sphere, paraboloid, cone or pyramid", "sphere"),
    ("angle", "half angle of a cone or pyramid", "20 deg"),
    ("poisson", "Poisson's ratio", "0.5"),
    ("thickness", "thickness of a thin sample on a rigid base", "1 mm"),
    ("model", "viscoelastic or power-law, or of a force curve hertz, dmt, jkr, maugis", "viscoelastic"),
    ("spring-constant", "of a force curve: spring constant", "0.2 N/m"),
    ("long-time", "after the record: free, solid or fluid", "solid"),
    ("terms", "number of terms", "2"),
    ("modulus", "moduli: young or shear", "young"),
    ("given", "what the test controlled: depth or load", "depth"),
    ("interface", "of a thin sample: bonded or slip", "bonded"),
    ("branch", "of a force curve: retraction or approach", "retraction"),
    ("sensitivity", "deflection per volt", "50 nm"),
    ("range", "range of the attraction", "0.3 nm"),
    ("column", "columns of quantities, by number or header", "time=1; load=2"),
    ("unit", "units that the header does not name", "load=mN"),
];

/// Name of an option, what it is, an example.
pub type Choice = (&'static str, &'static str, &'static str);

/// Options with their values.
type Given = BTreeMap<String, String>;

/// What can be asked for. Names are those of files below the folder.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Action {
    Template {
        template: String,
        output: String,
    },
    New {
        purpose: String,
        from: String,
        material: String,
        output: String,
        #[serde(default)]
        options: Given,
    },
    Surface {
        file: String,
        #[serde(default)]
        options: Given,
    },
    Process {
        file: String,
        ops: Vec<String>,
        #[serde(default)]
        options: Given,
        output: String,
        write: bool,
    },
    Data {
        file: String,
    },
    Fit {
        file: String,
        #[serde(default)]
        options: Given,
        output: String,
        write: bool,
    },
    Indentation {
        file: String,
        #[serde(default)]
        options: Given,
        output: String,
        write: bool,
    },
    Report {
        results: Vec<String>,
        output: String,
        write: bool,
    },
    Compare {
        results: Vec<String>,
    },
    Export {
        result: String,
        to: String,
        output: String,
    },
    Run {
        case: String,
        output: String,
        #[serde(default)]
        resume: bool,
    },
    Study {
        case: String,
        vary: String,
        output: String,
        #[serde(default)]
        resume: bool,
    },
    Seal {
        case: String,
        output: String,
        #[serde(default)]
        resume: bool,
    },
}

/// A command line, and what of it the page needs besides.
#[derive(Debug, Default, PartialEq)]
pub struct Line {
    /// What a person would type.
    pub shown: Vec<String>,
    /// What is added for the page.
    more: Vec<String>,
    /// What is run in place of the last two words.
    instead: Vec<String>,
    /// The name of the picture or page that it draws into that folder.
    pub draws: Option<&'static str>,
    python: String,
}

impl Action {
    /// The command line; `scratch` is a folder for a picture and for what is only looked at.
    pub fn line(&self, folder: &Folder, scratch: &str) -> Result<Line, String> {
        let reads = |name: &String| folder.find(name).map(|_| named(name));
        let writes = |name: &String| folder.place(name).map(|_| named(name));
        // What was stopped may have written nothing yet.
        let goes_on = |name: &String, resume: bool| {
            if resume { reads(name).or_else(|_| writes(name)) } else { writes(name) }
        };
        let all = |names: &[String]| names.iter().map(reads).collect::<Result<Vec<_>, _>>();
        let looked_at = |name: &str| vec!["-o".to_owned(), format!("{scratch}/{name}")];
        Ok(match self {
            Action::Template { template, output } => Line::of(&["new", &named(template), &writes(output)?]),
            Action::New { purpose, from, material, output, options } => {
                let [from, material, output] = [reads(from)?, reads(material)?, writes(output)?];
                let files =
                    [format!("--for={purpose}"), format!("--from={from}"), format!("--material={material}")];
                Line::of(&["new", &output]).with(files).with(given(options, &SURFACE[..2])?)
            }
            Action::Surface { file, options } => {
                let file = reads(file)?;
                let python =
                    format!("surface = asp.Surface.read({})\nprint(surface.statistics())", quoted(&file));
                let known = [SURFACE, SPECTRUM].concat();
                let line = Line::of(&["surface", "info", &file]).with(given(options, &known)?);
                line.drawn(scratch).python(options, python)
            }
            Action::Process { file, ops, options, output, write } => {
                let (file, to) = (reads(file)?, writes(output)?);
                let steps: Vec<String> = ops.iter().map(|op| quoted(op)).collect();
                let (from, into, steps) = (quoted(&file), quoted(&to), steps.join(", "));
                let python =
                    format!("surface = asp.Surface.read({from}).process({steps})\nsurface.write({into})");
                let line =
                    Line::of(&["surface", "process", &file]).with(ops.iter().map(|op| format!("--op={op}")));
                let line = line.with(given(options, SURFACE)?).python(options, python).drawn(scratch);
                let shown = [line.shown, vec!["-o".to_owned(), to.clone()]].concat();
                let line = Line { shown, ..line };
                let last = to.rsplit(['/', '\\']).next().unwrap_or_default();
                if *write { line } else { line.instead(looked_at(last)) }
            }
            Action::Data { file } => Line::of(&["material", "show", &reads(file)?]).drawn(scratch),
            Action::Fit { file, options, output, write } => {
                let (file, output) = (reads(file)?, writes(output)?);
                options.get("shift-table").map(reads).transpose()?;
                let python = format!("fit = asp.fit_file({}, poisson=0.5)\nprint(fit)", quoted(&file));
                let line = Line::of(&["material", "fit", &file]).with(given(options, FIT)?);
                let line = line.drawn(scratch).python(options, python);
                if *write { line.with(["-o".to_owned(), output]) } else { line }
            }
            Action::Indentation { file, options, output, write } => {
                let (file, output) = (reads(file)?, writes(output)?);
                let line = Line::of(&["fit-indentation", &file]).with(given(options, INDENTATION)?);
                let line = line.drawn(scratch);
                if *write { line.with(["-o".to_owned(), output]) } else { line }
            }
            Action::Report { results, output, write } => {
                let (results, output) = (all(results)?, writes(output)?);
                let python = match &results[..] {
                    [result] => format!("asp.open({}).report({})", quoted(result), quoted(&output)),
                    _ => String::new(),
                };
                let line = Line::of(&["report"]).with(results).with(["-o".to_owned(), output]);
                let line = line.python(&Given::new(), python);
                if *write {
                    line
                } else {
                    Line { draws: Some("shown.html"), ..line.instead(looked_at("shown.html")) }
                }
            }
            Action::Compare { results } => Line::of(&["compare"]).with(all(results)?),
            Action::Export { result, to, output } => {
                let (result, output) = (reads(result)?, writes(output)?);
                Line::of(&["export", &result]).with([format!("--to={to}"), "-o".to_owned(), output])
            }
            Action::Run { case, output, resume } => {
                let (case, output) = (reads(case)?, goes_on(output, *resume)?);
                let more = if *resume { ", resume=True" } else { "" };
                let python = format!(
                    "result = asp.run({}, output={}{more})\nprint(result)",
                    quoted(&case),
                    quoted(&output)
                );
                let line =
                    Line::of(&["run", &case, "-o", &output]).with(resume.then(|| "--resume".to_owned()));
                Line { more: vec!["-v".to_owned()], ..line }.python(&Given::new(), python)
            }
            Action::Study { case, vary, output, resume } if vary.trim().is_empty() => {
                Line::of(&["study", &reads(case)?]).with(["-o".to_owned(), goes_on(output, *resume)?])
            }
            Action::Study { case, vary, output, resume } => {
                let (case, output) = (reads(case)?, goes_on(output, *resume)?);
                let (key, values) = vary
                    .split_once('=')
                    .ok_or("write what varies as KEY=VALUES, for instance domain.cells=64,128")?;
                let [of, into, key, values] = [&case, &output, key.trim(), values.trim()].map(quoted);
                let python = format!(
                    "table = asp.study({of}, vary={{{key}: {values}}}, directory={into})\nprint(table)"
                );
                let line =
                    Line::of(&["study", &case]).with([format!("--vary={vary}"), "-o".to_owned(), output]);
                line.python(&Given::new(), python)
            }
            Action::Seal { case, output, resume } => {
                Line::of(&["seal", &reads(case)?]).with(["-o".to_owned(), goes_on(output, *resume)?])
            }
        })
    }
}

impl Action {
    /// Whether nothing in the folder changes: a later look of the same page makes it useless.
    pub fn looks(&self) -> bool {
        match self {
            Action::Surface { .. } | Action::Data { .. } | Action::Compare { .. } => true,
            Action::Process { write, .. }
            | Action::Fit { write, .. }
            | Action::Indentation { write, .. }
            | Action::Report { write, .. } => !write,
            _ => false,
        }
    }

    /// The case and the result of a run; `None` where it is no run.
    pub fn run(&self) -> Option<[&str; 2]> {
        match self {
            Action::Run { case, output, .. }
            | Action::Study { case, output, .. }
            | Action::Seal { case, output, .. } => Some([case, output]),
            _ => None,
        }
    }

    /// The same run, which goes on with what it has written; or, with a name, to a new result.
    pub fn again(mut self, anew: Option<String>) -> Action {
        if let Action::Run { resume, output, .. }
        | Action::Study { resume, output, .. }
        | Action::Seal { resume, output, .. } = &mut self
        {
            *resume = anew.is_none();
            *output = anew.unwrap_or_else(|| std::mem::take(output));
        }
        self
    }
}

impl Line {
    fn of(words: &[&str]) -> Line {
        Line { shown: words.iter().map(|word| (*word).to_owned()).collect(), ..Line::default() }
    }

    fn with(mut self, words: impl IntoIterator<Item = String>) -> Line {
        self.shown.extend(words);
        self
    }

    /// With its numbers for the page, and a picture in that folder.
    fn drawn(self, scratch: &str) -> Line {
        let more = vec!["--json".to_owned(), format!("--plot={scratch}/shown.svg")];
        Line { more, draws: Some("shown.svg"), ..self }
    }

    /// The last two words, "-o FILE", are only shown; these are run in their place.
    fn instead(self, words: Vec<String>) -> Line {
        Line { instead: words, ..self }
    }

    /// The same in Python, where no options are given: these have other forms there.
    fn python(self, options: &Given, text: String) -> Line {
        let has_none = options.values().all(|value| value.trim().is_empty());
        Line { python: if has_none { text } else { String::new() }, ..self }
    }

    /// The words that are run.
    pub fn words(&self) -> Vec<String> {
        let kept = if self.instead.is_empty() { self.shown.len() } else { self.shown.len() - 2 };
        [&self.shown[..kept], &self.instead, &self.more].concat()
    }

    /// The same in Python; what the package has no function for runs the command.
    pub fn in_python(&self) -> String {
        let words: Vec<String> =
            ["asperity"].into_iter().chain(self.shown.iter().map(String::as_str)).map(quoted).collect();
        match self.python.as_str() {
            "" => format!("import subprocess\n\nsubprocess.run([{}], check=True)\n", words.join(", ")),
            text => format!("import asperity as asp\n\n{text}\n"),
        }
    }

    /// The command line as a person types it into a shell.
    pub fn in_shell(&self) -> String {
        let is_plain = |c: char| c.is_alphanumeric() || "-_./=,:+@%".contains(c);
        let word = |word: &String| match word.chars().all(is_plain) && !word.is_empty() {
            true => word.clone(),
            false => format!("'{}'", word.replace('\'', "'\\''")),
        };
        std::iter::once("asperity".to_owned())
            .chain(self.shown.iter().map(word))
            .collect::<Vec<_>>()
            .join(" ")
    }
}

/// A name as a word of a command line, never an option.
fn named(name: &str) -> String {
    if name.starts_with('-') { format!("./{name}") } else { name.to_owned() }
}

/// Options that are known, each as one word; columns and units may be several.
fn given(options: &Given, known: &[Choice]) -> Result<Vec<String>, String> {
    let mut words = vec![];
    for (name, value) in options.iter().filter(|(_, value)| !value.trim().is_empty()) {
        if !known.iter().any(|(known, ..)| known == name) {
            return Err(format!("there is no option --{name} here"));
        }
        let parts = value.split(|c| c == ';' && ["column", "unit"].contains(&name.as_str()));
        words.extend(parts.map(|part| format!("--{name}={}", part.trim())));
    }
    Ok(words)
}

/// A text in quotes, for Python.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use serde_json::json;

    use super::*;
    use crate::args::Args;

    fn line(action: serde_json::Value) -> Result<Line, String> {
        let directory = tempfile::tempdir().unwrap();
        for name in ["a.x3p", "b.csv", "c.toml", "-d.csv", "r.zarr", "s.zarr"] {
            std::fs::write(directory.path().join(name), "").unwrap();
        }
        let folder = Folder::open(directory.path()).unwrap();
        serde_json::from_value::<Action>(action).unwrap().line(&folder, ".asperity-app/1")
    }

    /// What is run, and what is shown, are command lines of this program.
    #[test]
    fn every_action_is_a_command_line() {
        let options = |known: &[Choice]| -> Given {
            // What excludes other options.
            let skip = ["angle", "wlf", "window", "arrhenius", "shift-table", "misfit"];
            known
                .iter()
                .filter(|c| !skip.contains(&c.0))
                .map(|(name, _, value)| ((*name).into(), (*value).into()))
                .collect()
        };
        for action in [
            json!({ "do": "template", "template": "hertz", "output": "h.toml" }),
            json!({ "do": "new", "purpose": "seal", "from": "a.x3p", "material": "b.csv", "output": "n.toml" }),
            json!({ "do": "surface", "file": "a.x3p", "options": options(SURFACE) }),
            json!({ "do": "process", "file": "a.x3p", "ops": ["level=plane", "crop size=50um,50um"], "output": "p.x3p", "write": false }),
            json!({ "do": "process", "file": "a.x3p", "ops": ["level=plane"], "output": "p.x3p", "write": true }),
            json!({ "do": "data", "file": "b.csv" }),
            json!({ "do": "fit", "file": "-d.csv", "options": options(FIT), "output": "m.toml", "write": true }),
            json!({ "do": "indentation", "file": "b.csv", "options": options(INDENTATION), "output": "m.toml", "write": true }),
            json!({ "do": "report", "results": ["r.zarr", "s.zarr"], "output": "x.html", "write": false }),
            json!({ "do": "compare", "results": ["r.zarr", "s.zarr"] }),
            json!({ "do": "export", "result": "r.zarr", "to": "netcdf", "output": "r.nc" }),
            json!({ "do": "run", "case": "c.toml", "output": "n.zarr" }),
            json!({ "do": "run", "case": "c.toml", "output": "r.zarr", "resume": true }),
            json!({ "do": "seal", "case": "c.toml", "output": "se" }),
            json!({ "do": "study", "case": "c.toml", "vary": "load.history.value=1 N,2 N", "output": "st" }),
        ] {
            let line = line(action.clone()).unwrap();
            for words in [&line.shown, &line.words()] {
                let all = ["asperity"].into_iter().chain(words.iter().map(String::as_str));
                let parsed = Args::try_parse_from(all);
                assert!(parsed.is_ok(), "{action}: {words:?}: {}", parsed.unwrap_err());
            }
            assert!(!line.shown.iter().any(|word| word.contains(".asperity-app")), "{:?}", line.shown);
            assert!(line.in_python().starts_with("import "), "{}", line.in_python());
        }
    }

    #[test]
    fn a_command_line_can_be_copied() {
        let line = line(
            json!({ "do": "process", "file": "a.x3p", "ops": ["crop size=50um,50um"], "output": "it's.x3p", "write": false }),
        );
        let line = line.unwrap();
        assert_eq!(
            line.in_shell(),
            "asperity surface process a.x3p '--op=crop size=50um,50um' -o 'it'\\''s.x3p'"
        );
        assert_eq!(
            line.words()[4..6],
            ["-o", ".asperity-app/1/it's.x3p"],
            "what is looked at goes to a place of its own"
        );
    }

    #[test]
    fn nothing_is_replaced_and_no_option_slips_in() {
        for action in [
            json!({ "do": "process", "file": "a.x3p", "ops": [], "output": "b.csv", "write": true }),
            json!({ "do": "process", "file": "a.x3p", "ops": [], "output": "../b.csv", "write": true }),
            json!({ "do": "surface", "file": "a.x3p", "options": { "plot": "c.toml" } }),
            json!({ "do": "run", "case": "c.toml", "output": "r.zarr" }),
            json!({ "do": "compare", "results": ["r.zarr", "../r.zarr"] }),
        ] {
            assert!(line(action.clone()).is_err(), "{action}");
        }
        let read = line(json!({ "do": "data", "file": "-d.csv" })).unwrap();
        assert_eq!(read.shown[2], "./-d.csv");
    }
}
