//! `asperity surface generate`: synthetic roughness.

use asperity::surface::statistics::Extent;
use asperity::surface::{Part, SelfAffine};
use asperity_io::case::fragment;

use crate::args::SurfaceGenerate;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::input::{note_unit, option};
use crate::verb::Verb;

impl Verb for SurfaceGenerate {
    fn files(&self) -> Files {
        self.to.files().reads(&self.distribution)
    }

    /// Makes the surface, writes it, and prints its statistics.
    fn run(&self) -> Result<(), Failure> {
        let format = super::target(&self.to.output, self.to.to.as_deref())?;
        let seed = self.seed.to_string();
        // The patch of the challenge has a size of its own.
        let challenge_size = self.preset.is_some().then(|| SelfAffine::CHALLENGE_SIZE.to_string());
        let given: [(&str, Option<&str>); 15] = [
            ("cells", Some(&self.cells)),
            ("size", self.size.as_deref().or(challenge_size.as_deref())),
            ("preset", self.preset.as_deref()),
            ("hurst", self.hurst.as_deref()),
            ("rms_gradient", self.rms_gradient.as_deref()),
            ("rms_height", self.rms_height.as_deref()),
            ("longest", self.longest.as_deref()),
            ("shortest", self.shortest.as_deref()),
            ("roll_off", self.roll_off.as_deref()),
            ("lay.angle", self.lay_angle.as_deref()),
            ("lay.ratio", self.lay_ratio.as_deref()),
            ("distribution.skewness", self.skewness.as_deref()),
            ("distribution.kurtosis", self.kurtosis.as_deref()),
            ("distribution.path", self.distribution.as_deref()),
            ("seed", Some(&seed)),
        ];
        let keys: Vec<(&str, &str)> =
            given.into_iter().filter_map(|(key, text)| Some((key, text?))).collect();
        for (key, text) in &keys {
            if ["size", "rms_height", "longest", "shortest", "roll_off"].contains(key) {
                text.split(',').for_each(|text| note_unit(&flag(key), text, "m"));
            }
        }
        let (grid, part) = fragment::roughness(&keys).map_err(|faults| {
            let failed = |fault: &asperity_io::case::CaseError| {
                // A path of the command line is relative to where the command runs.
                let help = fault.help.as_ref().filter(|_| fault.key != "distribution.path");
                let help = help.map_or(String::new(), |help| format!("; {}", with_options(help)));
                let message = with_options(&fault.message);
                match fault.key.as_str() {
                    "" => format!("the surface {message}{help}"),
                    key => format!("{} {message}{help}", flag(key)),
                }
            };
            Failure::input(faults.iter().map(failed).collect::<Vec<_>>().join("\n"))
        })?;
        let (heights, spectrum) = match part {
            Part::SelfAffine(roughness) => (roughness.heights(&grid), roughness),
            Part::Synthesis(roughness) => (roughness.heights(&grid), roughness.spectrum),
            Part::Shape { .. } | Part::Heights { .. } => {
                refuse!("no roughness");
            }
        };
        let heights = heights?;
        let recipe: Vec<String> = keys.iter().map(|(key, text)| format!("{key} = {text}")).collect();
        let version = env!("CARGO_PKG_VERSION");
        let history = vec![format!("made by asperity {version}: self-affine, {}", recipe.join(", "))];
        let topography = super::roughness(format, heights, grid.size(), history);
        // The ring of the shortest waves is full only up to the cut-off.
        super::finish(&self.to, &topography, Extent::Periodic, |summary| {
            summary.fitted(spectrum.longest, 1.1 * spectrum.shortest)
        })
    }
}

/// The words of a case file's message with its keys replaced by the options that give them.
fn with_options(message: &str) -> String {
    // These names are no words of a sentence.
    let keys = ["rms_gradient", "rms_height", "roll_off", "lay.angle", "lay.ratio", "distribution.path"];
    let message = message.replace("`distribution.path`", "--distribution");
    let text = crate::input::with_options(&message);
    keys.iter().fold(text, |text, key| text.replace(key, &flag(key)))
}

/// The option that gives a key.
fn flag(key: &str) -> String {
    match key {
        "distribution.path" => "--distribution".to_owned(),
        key => option(key.strip_prefix("distribution.").unwrap_or(key)),
    }
}
