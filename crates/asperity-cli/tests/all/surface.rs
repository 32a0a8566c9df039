//! `asperity surface`: surfaces made, looked at, prepared and converted from the command line.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn surface(dir: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
    command.current_dir(dir).arg("surface").args(args).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn json(dir: &Path, args: &[&str]) -> Value {
    let output = surface(dir, args);
    assert!(output.status.success(), "{args:?}: {}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

/// Wrong input: exit code 2, the words on stderr, no panic, nothing written.
fn refused(dir: &Path, args: &[&str], words: &[&str]) {
    let before = std::fs::read_dir(dir).unwrap().count();
    let output = surface(dir, args);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{args:?}: {told}");
    for word in words {
        assert!(told.contains(word), "{args:?}: {told:?} lacks {word:?}");
    }
    assert!(!told.contains("panicked") && stdout(&output).is_empty(), "{args:?}: {told}");
    assert_eq!(std::fs::read_dir(dir).unwrap().count(), before, "{args:?} left a file");
}

const ROUGH: [&str; 15] = [
    "generate",
    "--cells",
    "128,96",
    "--size",
    "1 mm,0.75 mm",
    "--hurst",
    "0.7",
    "--rms-height",
    "0.5 um",
    "--longest",
    "0.5 mm",
    "--shortest",
    "20 um",
    "--seed",
    "3",
];

fn rough<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&ROUGH, more].concat()
}

#[test]
fn a_surface_is_made_in_every_format_with_its_recipe() {
    let dir = tempfile::tempdir().unwrap();
    let made = json(dir.path(), &rough(&["-o", "a.npz", "--json"]));
    assert_eq!(made["shape"], serde_json::json!([128, 96]));
    assert_eq!(made["size"], serde_json::json!([1e-3, 0.75e-3]));
    assert!((made["sq"].as_f64().unwrap() / 0.5e-6 - 1.0).abs() < 1e-12); // exact rms, by construction
    assert!((made["moments"]["m0"].as_f64().unwrap().sqrt() / 0.5e-6 - 1.0).abs() < 1e-12); // Parseval
    for (file, format) in [
        ("a.gwy", "gwy"),
        ("a.x3p", "x3p"),
        ("a.sdf", "sdf"),
        ("a.nc", "nc"),
        ("a.txt", "asc"),
        ("b.npz", "npz"),
    ] {
        assert!(surface(dir.path(), &rough(&["-o", file])).status.success());
        let read = json(dir.path(), &["info", file, "--json", "--periodic"]);
        assert_eq!(read["format"], format);
        for key in ["min", "max", "sq", "h00", "h10", "h01", "undefined"] {
            assert_eq!(read[key], made[key], "{file}: {key}"); // all digits are kept
        }
        let history = read["history"].as_array().unwrap();
        if format != "sdf" {
            assert!(history[0].as_str().unwrap().contains("hurst = 0.7"), "{file}: {history:?}");
        }
    }
    let npz = |name: &str| std::fs::read(dir.path().join(name)).unwrap();
    assert_eq!(npz("a.npz"), npz("b.npz"), "one seed, one surface");
}

#[test]
fn lay_distribution_and_preset_are_options() {
    let dir = tempfile::tempdir().unwrap();
    let honed = json(
        dir.path(),
        &rough(&[
            "--lay-ratio",
            "3",
            "--lay-angle",
            "30 deg",
            "--skewness",
            "-0.8",
            "--kurtosis",
            "4",
            "-o",
            "h.npz",
            "--json",
        ]),
    );
    assert!((honed["ssk"].as_f64().unwrap() + 0.8).abs() < 0.05, "{honed}"); // of 12288 quantiles
    assert!((honed["sku"].as_f64().unwrap() - 4.0).abs() < 0.3, "{honed}");
    let like = json(dir.path(), &rough(&["--distribution", "h.npz", "-o", "l.npz", "--json"]));
    // The file's heights less their plane, which a periodic surface hardly has.
    assert!((like["ssk"].as_f64().unwrap() + 0.8).abs() < 0.15, "{like}");
    let preset =
        ["generate", "--preset", "contact-mechanics-challenge", "--cells", "256", "--shortest", "1 um"];
    let challenge = json(dir.path(), &[&preset[..], &["-o", "c.npz", "--json"]].concat());
    assert_eq!(challenge["size"], serde_json::json!([1e-4, 1e-4]));
    // m2 is half of the mean square gradient, which is 1.
    assert!((2.0 * challenge["moments"]["m2"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    refused(dir.path(), &[&preset[..5], &["-o", "d.npz"]].concat(), &["shortest wavelength", "two cells"]);
}

#[test]
fn a_slip_in_the_recipe_is_told_by_its_option() {
    let dir = tempfile::tempdir().unwrap();
    let bare = ["generate", "-o", "a.npz"];
    refused(dir.path(), &bare, &["--size", "missing"]);
    let sized = ["generate", "--size", "1 mm", "-o", "a.npz"];
    refused(
        dir.path(),
        &[&sized[..], &["--rms-height", "1 um"]].concat(),
        &["--hurst", "--longest", "--shortest"],
    );
    for (option, value, words) in [
        ("--hurst", "1.5", ["--hurst", "at most 1"]),
        ("--rms-gradient", "0.1", ["--rms-gradient and --rms-height", "only one of them"]),
        ("--shortest", "1 um", ["--shortest", "two cells"]),
        ("--longest", "1 cm", ["--longest", "size of the domain"]),
        ("--roll-off", "0.6 mm", ["--roll-off", "between the shortest"]),
        ("--roll-off", "3 s", ["--roll-off", "a length"]),
        ("--cells", "0,5", ["--cells", "1 or more"]),
        ("--cells", "100000000", ["--cells", "this machine has"]),
        ("--size", "-1 mm", ["--size", "greater than 0"]),
        ("--lay-ratio", "0.2", ["--lay", "1 or more"]),
        ("--kurtosis", "0.5", ["--distribution", "well above"]),
        ("--preset", "tamaas", ["--preset", "contact-mechanics-challenge"]),
        ("--distribution", "none.sdf", ["--distribution", "does not exist"]),
    ] {
        let mut args = rough(&["-o", "a.npz"]);
        match args.iter().position(|a| *a == option) {
            Some(at) => args[at + 1] = value,
            None => args.extend([option, value]),
        }
        let joined;
        if value.starts_with('-') {
            let at = args.iter().position(|a| *a == option).unwrap();
            joined = format!("{option}={value}");
            args.splice(at..at + 2, [joined.as_str()]);
            refused(dir.path(), &args, &words);
        } else {
            refused(dir.path(), &args, &words);
        }
    }
    refused(dir.path(), &rough(&["-o", "a.sur"]), &["sur", "not written", "gwy"]);
    refused(dir.path(), &rough(&["-o", "a"]), &["--to"]);
    refused(dir.path(), &rough(&["-o", "a.npz", "--plot", "a.jpg"]), &["a.jpg", "png"]);
    refused(dir.path(), &rough(&["-o", "no/such/a.npz"]), &["no/such/a.npz"]);
}

#[test]
fn nothing_is_overwritten_unless_told() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("a.npz"), "mine").unwrap();
    refused(dir.path(), &rough(&["-o", "a.npz"]), &["a.npz", "--force"]);
    assert_eq!(std::fs::read(dir.path().join("a.npz")).unwrap(), b"mine");
    assert!(surface(dir.path(), &rough(&["-o", "a.npz", "--force"])).status.success());
    std::fs::write(dir.path().join("a.png"), "mine").unwrap();
    refused(dir.path(), &["info", "a.npz", "--plot", "a.png"], &["a.png", "--force"]);
    refused(dir.path(), &["process", "a.npz", "--op", "invert", "-o", "a.npz"], &["a.npz", "--force"]);
}

#[test]
fn steps_are_done_in_order_and_recorded() {
    let dir = tempfile::tempdir().unwrap();
    let text: String = (0..30)
        .map(|j| {
            let line: Vec<String> = (0..40)
                .map(|i| match (i, j) {
                    (7, 9) => "nan".to_owned(),
                    (20, 20) => "900".to_owned(),
                    _ => format!(
                        "{:.3}",
                        0.5 * i as f64 - 0.25 * j as f64 + 0.1 * ((i * 7 + j * 5) % 11) as f64
                    ),
                })
                .collect();
            line.join(" ") + "\n"
        })
        .collect();
    std::fs::write(dir.path().join("m.txt"), text).unwrap();
    let given = ["--size", "40 um,30 um", "--height-unit", "nm"];
    let ops = [
        "level=plane",
        "outliers=6 radius=2",
        "level",
        "fill=harmonic share=0.1",
        "crop size=20 um,20 um corner=0 m,5 um",
        "resample=bilinear cells=40,40",
        "flip=x",
        "invert",
    ];
    let mut args = vec!["process", "m.txt", "-o", "p.gwy", "--json"];
    args.extend(given);
    args.extend(ops.iter().flat_map(|op| ["--op", op]));
    let processed = json(dir.path(), &args);
    assert_eq!(processed["shape"], serde_json::json!([40, 40]));
    for length in processed["size"].as_array().unwrap() {
        assert!((length.as_f64().unwrap() / 2e-5 - 1.0).abs() < 1e-15, "{processed}"); // 20 cells of 40 um / 40
    }
    assert_eq!(processed["undefined"], 0);
    assert!(processed["sz"].as_f64().unwrap() < 3e-9, "{processed}"); // plane, spike and hole are gone
    let again = json(dir.path(), &["info", "p.gwy", "--json"]);
    let history: Vec<&str> =
        again["history"].as_array().unwrap().iter().map(|h| h.as_str().unwrap()).collect();
    assert_eq!(history.len(), ops.len());
    assert!(
        history[1].contains(": 1 removed, its height ") && history[3].ends_with(": 2 filled"),
        "{history:?}"
    );
    assert_eq!(history[4], "crop to 20 x 20 cells from (0, 5)");
    // The history of a file that was processed before goes on.
    let more = json(dir.path(), &["process", "p.gwy", "--op", "rotate=1", "-o", "q.x3p", "--json"]);
    assert_eq!(more["history"].as_array().unwrap().len(), ops.len() + 1);
    assert_eq!(json(dir.path(), &["info", "q.x3p", "--json"])["history"], more["history"]);
    // The same steps give the same bits in a case file as here: see the tests of the case.
    for (op, words) in [
        ("lvel", vec!["--op \"lvel\"", "did you mean \"level\"?"]),
        ("fill", vec!["1 of 1200"]),
        ("fill share=0.0001", vec!["m.txt", "at most 0.01 %"]),
        ("resample=bilinear", vec!["cells=NX,NY"]),
        ("filter longest=5um", vec!["undefined", "fill"]),
        ("crop cells=50,50", vec!["cells to keep along x is 50"]),
        ("rotate=x", vec!["a whole number"]),
    ] {
        let mut args = vec!["process", "m.txt", "-o", "r.npz", "--op", op];
        args.extend(given);
        if op == "fill" {
            assert!(surface(dir.path(), &args).status.success());
            std::fs::remove_file(dir.path().join("r.npz")).unwrap();
        } else {
            refused(dir.path(), &args, &words);
        }
    }
    refused(dir.path(), &["process", "m.txt", "-o", "r.npz"], &["--op"]);
}

#[test]
fn info_tells_heights_as_stored_and_without_their_plane() {
    let dir = tempfile::tempdir().unwrap();
    // Rows and columns of alternating signs, 1 nm, on a plane of 3 nm per column and 1 nm per row.
    let (n, plane) = (32_usize, [3.0, 1.0]);
    let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let height = |i: usize, j: usize| sign(i) * sign(j) + plane[0] * i as f64 + plane[1] * j as f64;
    let line = |j: usize| (0..n).map(|i| height(i, j).to_string()).collect::<Vec<_>>().join(" ") + "\n";
    std::fs::write(dir.path().join("tilted.txt"), (0..n).map(line).collect::<String>()).unwrap();
    let info = ["info", "tilted.txt", "--size", "32 um", "--height-unit", "nm"];
    let found = json(dir.path(), &[&info[..], &["--json"]].concat());
    let of = |value: &Value, key: &str| value[key].as_f64().unwrap();
    // Mean square of equally spaced steps: (n^2 - 1)/12 of each; the signs add 1 but for the share of order 1/n^2 that the
    // plane takes of them.
    let square = (n * n - 1) as f64 / 12.0;
    let tilted = (square * (plane[0] * plane[0] + plane[1] * plane[1]) + 1.0).sqrt() * 1e-9;
    let share = 1.0 / (n * n) as f64;
    assert!((of(&found, "sq") / tilted - 1.0).abs() < share, "{found}");
    let levelled = &found["levelled"];
    assert!((of(levelled, "sq") / 1e-9 - 1.0).abs() < share, "{levelled}");
    assert!((of(levelled, "sa") / 1e-9 - 1.0).abs() < share && of(levelled, "mean").abs() < 1e-20);
    // The whole gradient of the plane, 10^(1/2) nm/um, is in the one and not in the other; differences over a sign are 2 nm.
    let [with, without] = [of(&found, "sdq"), of(levelled, "sdq")].map(|sdq| sdq * sdq * 1e6);
    assert!(((with - without) / 10.0 - 1.0).abs() < 0.05, "{with} {without}");
    let table = stdout(&surface(dir.path(), &info));
    assert!(table.contains("as stored") && table.contains("levelled"), "{table}");
    let row = table.lines().find(|line| line.starts_with("Sq ")).unwrap();
    assert!(row.contains(" nm") && row.contains("1 nm"), "{row}");
    // A periodic surface has no plane.
    let periodic = json(dir.path(), &[&info[..], &["--json", "--periodic"]].concat());
    assert_eq!((&periodic["levelled"], &periodic["sq"]), (&Value::Null, &found["sq"]));
}

#[test]
fn info_tells_a_table_and_draws_a_picture() {
    let dir = tempfile::tempdir().unwrap();
    assert!(surface(dir.path(), &rough(&["-o", "a.npz"])).status.success());
    let output =
        surface(dir.path(), &["info", "a.npz", "--periodic", "--plot", "a.svg", "--shortest", "21 um"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let table = stdout(&output);
    for words in [
        "Sa  ",
        "Sq         500 nm",
        "Ssk",
        "Sku",
        "Sz",
        "Sdq",
        "Sdr",
        "m4",
        "alpha",
        "Hurst",
        "bearing",
        "history",
    ] {
        assert!(table.contains(words), "{words}: {table}");
    }
    let svg = std::fs::read_to_string(dir.path().join("a.svg")).unwrap();
    for words in ["</svg>", "Power spectrum", "H = ", "Height distribution", "Bearing area", "height [µm]"] {
        assert!(svg.contains(words), "{words}");
    }
    let drawn = surface(dir.path(), &["info", "a.npz", "--plot", "a.png"]);
    assert!(drawn.status.success(), "{}", stderr(&drawn));
    assert!(std::fs::read(dir.path().join("a.png")).unwrap().starts_with(b"\x89PNG"));
    refused(dir.path(), &["info", "a.npz", "--shortest", "0.9 mm"], &["rings", "widen"]);
    refused(dir.path(), &["info", "a.npz", "--longest", "4 s"], &["a length"]);
    // Two lines hardly have a spectrum; they are told all the same, without a fit.
    std::fs::write(dir.path().join("few.txt"), "1 2 4 3\n5 2 1 0\n").unwrap();
    let few = json(dir.path(), &["info", "few.txt", "--size", "4 um,2 um", "--height-unit", "nm", "--json"]);
    assert_eq!(few["shape"], serde_json::json!([4, 2]));
    assert_eq!((&few["fit"], &few["lay"]["clear"]), (&Value::Null, &Value::Bool(false)));
}
