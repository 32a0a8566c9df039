//! `asperity new`: a case with one's own files.

use std::process::Output;

use crate::asperity;

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A surface of 24 by 16 points on 60 by 40 um, a relaxation test, a DMA at one temperature, and an indentation.
fn files() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let made = asperity(
        folder.path(),
        &[
            "surface",
            "generate",
            "--cells",
            "24,16",
            "--size",
            "60 um,40 um",
            "--hurst",
            "0.8",
            "--rms-height",
            "0.2 um",
            "--longest",
            "40 um",
            "--shortest",
            "10 um",
            "-o",
            &at("face.npz"),
        ],
    );
    assert!(made.status.success(), "{}", told(&made));
    // E(t) = 2 MPa + 3 MPa exp(-t/1 s), its storage and loss modulus: 2 + 3 w²/(1 + w²) and 3 w/(1 + w²) MPa.
    let times = (0..25).map(|k| 10f64.powf(-2.0 + f64::from(k) / 6.0));
    let relaxation: String = times.map(|t| format!("{t}; {}\n", 2.0 + 3.0 * (-t).exp())).collect();
    std::fs::write(at("relaxation.csv"), format!("t [s]; E [MPa]\n{relaxation}")).unwrap();
    let dma: String = (0..25)
        .map(|k| 10f64.powf(-2.0 + f64::from(k) / 6.0))
        .map(|f| (f, std::f64::consts::TAU * f))
        .map(|(f, w)| format!("{f}; {}; {}\n", 2.0 + 3.0 * w * w / (1.0 + w * w), 3.0 * w / (1.0 + w * w)))
        .collect();
    std::fs::write(at("dma.csv"), format!("f [Hz]; E' [MPa]; E'' [MPa]\n{dma}")).unwrap();
    let record: String = (0..=50)
        .map(|k| format!("{}; {}; {}\n", 0.1 * f64::from(k), 0.02 * f64::from(k), 0.1 * f64::from(k)))
        .collect();
    std::fs::write(at("record.csv"), format!("t [s]; P [mN]; h [um]\n{record}")).unwrap();
    folder
}

/// Purposes with the files of [`files`] that a case is made of.
const OWN: [(&str, &str, &str); 7] = [
    ("seal", "face.npz", "relaxation.csv"),
    ("friction", "face.npz", "dma.csv"),
    ("contact", "face.npz", "dma.csv"),
    ("indentation", "face.npz", "relaxation.csv"),
    ("indentation", "record.csv", "relaxation.csv"),
    ("adhesion", "face.npz", "relaxation.csv"),
    ("adhesion", "record.csv", "dma.csv"),
];

#[test]
fn a_case_with_own_files_passes_the_check_and_says_what_is_missing() {
    let folder = files();
    for (purpose, from, material) in OWN {
        let words = ["new", "--from", from, "--material", material, "--for", purpose, "own.toml", "--force"];
        let made = asperity(folder.path(), &words);
        assert!(made.status.success() && told(&made).contains("body.poisson"), "{purpose}: {}", told(&made));
        let text = std::fs::read_to_string(folder.path().join("own.toml")).unwrap();
        assert!(
            text.contains(material) && text.contains("E") && text.lines().all(|line| line.len() <= 180),
            "{text}"
        );
        let checked = asperity(folder.path(), &["check", "own.toml"]);
        let words = String::from_utf8_lossy(&checked.stdout).into_owned();
        assert!(checked.status.success(), "{purpose}: {}\n{text}", told(&checked));
        assert_eq!(words.contains("24 x 16 cells"), from == "face.npz", "{words}");
        assert_eq!(words.contains("fine enough"), purpose == "adhesion", "{words}");
        // The fit finds the material of the file: E*(0) = (2 + 3) MPa/(1 - 0.25), to the three digits that a fit to exact data has.
        assert!(words.contains("5 MPa") || words.contains("4.99") || words.contains("5.00"), "{words}");
    }
}

/// A measured map is continued by its reflections, or windowed for friction; one that repeats is taken as it is.
#[test]
fn a_map_that_does_not_repeat_is_mirrored() {
    let folder = files();
    let made = asperity(
        folder.path(),
        &["surface", "process", "face.npz", "--op", "crop cells=18,12", "-o", "part.npz"],
    );
    assert!(made.status.success(), "{}", told(&made));
    for purpose in ["seal", "friction", "contact", "adhesion"] {
        let text = |from: &str| {
            let words = [
                "new",
                "--from",
                from,
                "--material",
                "relaxation.csv",
                "--for",
                purpose,
                "own.toml",
                "--force",
            ];
            let made = asperity(folder.path(), &words);
            assert!(made.status.success(), "{purpose}: {}", told(&made));
            std::fs::read_to_string(folder.path().join("own.toml")).unwrap()
        };
        let whole = text("face.npz");
        assert!(
            !whole.contains("border = ")
                && !whole.contains("window = ")
                && whole.contains("level = \"none\""),
            "{whole}"
        );
        let part = text("part.npz");
        // Friction keeps its lay, and its cells.
        let mirrored = purpose != "friction";
        assert_eq!(
            (part.contains("border = \"mirror\""), part.contains("window = ")),
            (mirrored, !mirrored),
            "{part}"
        );
        let checked = asperity(folder.path(), &["check", "own.toml", "--json"]);
        let object: serde_json::Value = serde_json::from_slice(&checked.stdout).unwrap();
        let cells = if mirrored { [36, 24] } else { [18, 12] };
        assert_eq!(object["cells"], serde_json::json!(cells));
        // Tukey's window has less than a cell of these 12 to fall in.
        assert!(!mirrored || !object["findings"].to_string().contains("gap-not-periodic"), "{object}");
    }
}

fn example(name: &str) -> String {
    format!("{}/../../examples/data/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// The number behind a key: `from = "1e-3 m/s"`.
fn number(text: &str, key: &str) -> f64 {
    let rest = text.split_once(&format!("{key} = \"")).unwrap().1;
    rest.split([' ', '"']).next().unwrap().parse().unwrap()
}

#[test]
fn an_indentation_keeps_its_indenter_and_layer_and_prescribes_what_the_test_controlled() {
    let folder = tempfile::tempdir().unwrap();
    let record = example("silicone-indentation.csv");
    let run = |words: &[&str]| {
        let done = asperity(folder.path(), words);
        assert!(done.status.success(), "{words:?}: {}", told(&done));
        String::from_utf8_lossy(&done.stdout).into_owned()
    };
    let test = ["--radius", "5 mm", "--thickness", "2 mm", "--interface", "slip", "-o", "pad.toml"];
    run(&[&["fit-indentation", &record][..], &test].concat());
    run(&["new", "--from", &record, "--material", "pad.toml", "--for", "indentation", "own.toml"]);
    let text = std::fs::read_to_string(folder.path().join("own.toml")).unwrap();
    assert!(text.contains("radius = \"5e-3 m\"\n") && !text.contains("# YOUR VALUE: of the ball"), "{text}");
    // examples/data/README.md: the depth was controlled; 100 um are held until 15 s.
    let held = "[\"1.500000e1 s\", \"1.000000e-4 m\"]";
    assert!(text.contains("control = \"approach\"") && text.contains(held), "{text}");
    // The ramp ends at 1 s; its record is straight between corners, so that few of its 401 rows are needed.
    let corner = "[\"1.000000e0 s\", \"1.000000e-4 m\"]";
    assert!(text.contains(corner) && text.matches(" s\", \"").count() < 10, "{text}");
    assert!(text.contains("[[body.layer]]\ninterface = \"slip\"") && text.contains("thickness = \"2e-3 m\""));
    let checked = run(&["check", "own.toml"]);
    assert!(checked.contains("2 mm"), "{checked}");
}

#[test]
fn friction_is_at_the_reference_of_the_shift_over_the_velocities_of_the_master_curve() {
    let folder = files();
    let dma = example("rubber-dma.csv");
    let new = |material: &str| {
        let words =
            ["new", "--from", "face.npz", "--material", material, "--for", "friction", "own.toml", "--force"];
        let made = asperity(folder.path(), &words);
        assert!(made.status.success(), "{}", told(&made));
        std::fs::read_to_string(folder.path().join("own.toml")).unwrap()
    };
    let measured = new(&dma);
    // The sweep nearest to the temperature of a room, as `material fit` takes it; the data have one at 20 °C.
    assert!(
        measured.contains("reference = \"20.00 °C\"") && measured.contains("value = \"20.00 °C\""),
        "{measured}"
    );
    assert!(measured.contains("within the data of the material at 20.00 °C"), "{measured}");
    // The master curve covers decades more than a sweep of 0.1 Hz to 100 Hz.
    let [from, to] = ["from", "to"].map(|key| number(&measured, key));
    assert!(to / from > 1e5, "{from} {to}");
    // Fitted before about another temperature: that one, and the times that the fit states.
    let shift = ["--estimate-shift", "0 °C", "-o", "fitted.toml"];
    let fitted = asperity(folder.path(), &[&["material", "fit", &dma][..], &shift].concat());
    assert!(fitted.status.success(), "{}", told(&fitted));
    let block = std::fs::read_to_string(folder.path().join("fitted.toml")).unwrap();
    let text = new("fitted.toml");
    assert!(text.contains("value = \"273.15 K\""), "{text}");
    // All waves of the surface, the longest of 60 um: v = lambda/(2 pi t), a hundredth inside the data, to the four digits that are written.
    let last = block.split_once("window = [").unwrap().1.split('"').nth(3).unwrap();
    let last: f64 = last.trim_end_matches(" s").parse().unwrap();
    assert!((number(&text, "from") * std::f64::consts::TAU * last / 60.6e-6 - 1.0).abs() < 1e-3, "{text}");
    assert!(asperity(folder.path(), &["check", "own.toml"]).status.success());
}

#[test]
fn what_no_case_can_be_made_of_is_refused() {
    let folder = files();
    let new = |from: &str, material: &str, purpose: &str| {
        let made = asperity(
            folder.path(),
            &["new", "--from", from, "--material", material, "--for", purpose, "no.toml"],
        );
        assert_eq!(made.status.code(), Some(2), "{}", told(&made));
        assert!(!folder.path().join("no.toml").exists());
        told(&made)
    };
    std::fs::write(folder.path().join("profile.txt"), "0 0\n1 1\n2 0\n3 2\n4 0\n").unwrap();
    new("profile.txt", "dma.csv", "seal");
    std::fs::write(folder.path().join("case.toml"), "[[body]]\npoisson = 0.5\n").unwrap();
    assert!(new("face.npz", "case.toml", "seal").contains("material fit -o"));
    new("face.npz", "missing.csv", "seal");
    let alone = asperity(folder.path(), &["new", "--for", "seal"]);
    assert_eq!(alone.status.code(), Some(2));
}

#[test]
fn a_square_has_one_length() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("heights.txt"), "0 1 2\n3 4 5\n6 7 9\n").unwrap();
    let words = ["surface", "info", "heights.txt", "--size", "3 um", "--height-unit", "nm", "--json"];
    let output = asperity(folder.path(), &words);
    assert!(output.status.success(), "{}", told(&output));
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // 3 um is 3e-6 to the last digit.
    assert_eq!(found["size"], serde_json::json!([3e-6, 3e-6]));
}

/// Warnings of a run.
fn warned(folder: &std::path::Path, case: &str, set: &[String]) -> Vec<String> {
    let more: Vec<&str> = set.iter().flat_map(|key| ["--set", key]).collect();
    let done = asperity(folder, &[&["run", case, "--force", "--quiet", "--json"][..], &more].concat());
    assert!(done.status.success(), "{case} {set:?}: {}", told(&done));
    let object: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    let list = object["findings"].as_array().unwrap().clone();
    let warnings = list.iter().filter(|finding| finding["severity"] == "warning");
    warnings.map(|finding| finding["code"].as_str().unwrap().to_owned()).collect()
}

/// What few cells cause: waves, spots, constrictions, rims of adhesion and slip, and edges of moving contacts are a few cells wide.
const OF_FEW_CELLS: [&str; 7] = [
    "shortest-wave-unresolved",
    "spots-unresolved",
    "few-contact-cells",
    "constriction-unresolved",
    "friction-uncertain",
    "adhesion-unresolved",
    "slip-unresolved",
];

#[test]
fn no_default_of_a_case_with_own_files_causes_a_finding() {
    let folder = files();
    let made = asperity(
        folder.path(),
        &["surface", "process", "face.npz", "--op", "crop cells=18,12", "-o", "part.npz"],
    );
    assert!(made.status.success(), "{}", told(&made));
    let parts = [("seal", "relaxation.csv"), ("friction", "dma.csv"), ("contact", "relaxation.csv")];
    let parts = parts.map(|(purpose, material)| (purpose, "part.npz", material));
    for (purpose, from, material) in OWN.into_iter().chain(parts) {
        let words = ["new", "--from", from, "--material", material, "--for", purpose, "own.toml", "--force"];
        let made = asperity(folder.path(), &words);
        assert!(made.status.success(), "{purpose}: {}", told(&made));
        let mut codes = warned(folder.path(), "own.toml", &[]);
        // The maps have 24 by 16 points at most.
        codes.retain(|code| from == "record.csv" || !OF_FEW_CELLS.contains(&code.as_str()));
        // Adaptive steps do not follow the largest traction of surfaces that adhere, which is one of a single cell at the rim.
        codes.retain(|code| (purpose, from) != ("adhesion", "record.csv") || code != "steps-too-long");
        assert!(codes.is_empty(), "{purpose} {from}: {codes:?}");
    }
}

#[test]
fn no_starter_case_causes_a_finding() {
    const CELLS: usize = 48;
    let folder = tempfile::tempdir().unwrap();
    for template in asperity_examples::TEMPLATES {
        // Hundreds of cycles of wear, and hundreds of steps on the cells that the range needs, take a minute.
        if ["fretting-wear", "gel-adhesion"].contains(&template.name) {
            continue;
        }
        let path = format!("{}.toml", template.name);
        std::fs::write(folder.path().join(&path), template.text).unwrap();
        let line = template.text.contains("kind = \"cylinder\"");
        let cells = match template.name {
            // With fewer cells its range is refused.
            "adhesive-sphere" => "[104, 104]".to_owned(),
            _ if line => "[256]".to_owned(),
            _ => format!("[{CELLS}, {CELLS}]"),
        };
        let mut set = vec![format!("domain.cells={cells}")];
        // Waves that these cells resolve.
        let (_, side) = template.text.split_once("size = [\"").unwrap();
        let (number, unit) = side.split('"').next().unwrap().split_once(' ').unwrap();
        for (n, surface) in template.text.split("\n[[surface]]").skip(1).enumerate() {
            if surface.contains("\nshortest = ") {
                let shortest = 4.0 * number.parse::<f64>().unwrap() / CELLS as f64;
                set.push(format!("surface.{n}.shortest={shortest:.4} {unit}"));
            }
        }
        let mut codes = warned(folder.path(), &path, &set);
        codes.retain(|code| !OF_FEW_CELLS.contains(&code.as_str()));
        let expected: &[&str] = match template.name {
            // What it shows.
            "subsurface-stress" => &["yield-exceeded"],
            // Soft rubber on a rough road is beyond small strains, as every linear theory of it.
            "rubber-friction" => &["large-strain"],
            _ => &[],
        };
        assert_eq!(codes, expected, "{}", template.name);
    }
}
