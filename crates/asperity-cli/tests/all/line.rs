//! Line contacts as a user of the command meets them.

use std::path::Path;

use asperity_io::store::{At, FieldKind, Reader};
use serde_json::Value;

use crate::asperity;

const CASE: &str = r#"
title = "roller"
[domain]
cells = [96]
size = ["8 mm"]
[[surface]]
kind = "cylinder"
radius = "20 mm"
[[body]]
poisson = 0.5
material = { model = "zener", shear = "2 MPa", shear_kelvin = "2 MPa", retardation_time = "10 s" }
[load]
control = "load"
history = { kind = "step", value = "0.5 N/mm" }
[time]
end = "20 s"
steps = 8
[output]
fields = ["pressure", "gap", "displacement", "contact"]
quantities = ["contact_spots", "largest_spot", "contact_perimeter"]
every = 2
"#;

/// Standard output of a command that succeeds.
fn done(directory: &Path, arguments: &[&str]) -> String {
    let output = asperity(directory, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn solved() -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("roller.toml"), CASE).unwrap();
    done(directory.path(), &["run", "roller.toml", "--quiet"]);
    directory
}

#[test]
fn a_line_contact_is_checked_run_and_shown_per_length() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    std::fs::write(path.join("roller.toml"), CASE).unwrap();
    let told = done(path, &["check", "roller.toml"]);
    assert!(told.contains("a line of 96 cells") && told.contains("500 N/m at most"), "{told}");
    let told = done(path, &["run", "roller.toml"]);
    assert!(told.contains("the last of 9, under 500 N/m"), "{told}");
    let told = done(path, &["show", "roller.zarr"]);
    assert!(told.contains("a line of 96 cells, 8 mm") && told.contains("500 N/m"), "{told}");
    let object: Value = serde_json::from_str(&done(path, &["check", "roller.toml", "--json"])).unwrap();
    assert_eq!((&object["cells"], &object["size"]), (&serde_json::json!([96]), &serde_json::json!([8e-3])));
}

#[test]
fn a_stored_line_contact_has_no_y() {
    let directory = solved();
    let root = directory.path().join("roller.zarr");
    let document: Value = serde_json::from_slice(&std::fs::read(root.join("zarr.json")).unwrap()).unwrap();
    let arrays = &document["consolidated_metadata"]["metadata"];
    assert!(arrays.get("y").is_none());
    assert_eq!(arrays["pressure"]["dimension_names"], serde_json::json!(["field_time", "x"]));
    assert_eq!(arrays["initial_gap"]["dimension_names"], serde_json::json!(["x"]));
    let units = |name: &str| arrays[name]["attributes"]["units"].as_str().unwrap().to_owned();
    let all = ["load", "contact_area", "largest_spot", "contact_perimeter", "approach"].map(units);
    assert_eq!(all, ["N/m", "m", "m", "1", "m"]);
    let words = arrays["approach"]["attributes"]["long_name"].as_str().unwrap();
    assert!(words.contains("end of the domain"), "{words}");
    let reader = Reader::open(&root).unwrap();
    assert!(reader.header().grid.is_line());
    let pressure = reader.field(FieldKind::Pressure, At::Last).unwrap();
    assert_eq!(pressure.dim(), (96, 1));
    // The load per length is the sum of the pressures over the cells.
    let load = pressure.sum() * reader.header().grid.spacing()[0];
    assert!((load / 500.0 - 1.0).abs() < 1e-12, "{load}");
}

#[test]
fn every_export_and_picture_of_a_line_contact_is_made() {
    let directory = solved();
    let path = directory.path();
    for format in ["netcdf", "hdf5", "npz", "vtk", "csv", "png"] {
        done(path, &["export", "roller.zarr", "--to", format]);
    }
    done(path, &["export", "roller.zarr", "--to", "csv", "--fields", "pressure", "-o", "fields.csv"]);
    let text = std::fs::read_to_string(path.join("fields_pressure_0000.csv")).unwrap();
    assert!(text.starts_with("x [m],pressure [Pa]\r\n") && text.lines().count() == 97, "{text}");
    let text = std::fs::read_to_string(path.join("fields.csv")).unwrap();
    assert!(text.starts_with("time [s],load [N/m],"), "{text}");
    for what in [
        "evolution",
        "load-displacement",
        "pressure",
        "gap",
        "displacement",
        "contact",
        "initial-gap",
        "profile",
        "histogram",
        "spots",
        "work",
        "quantities",
        "stress",
    ] {
        let picture = format!("{what}.svg");
        done(path, &["plot", "roller.zarr", what, "-o", &picture]);
        let svg = std::fs::read_to_string(path.join(&picture)).unwrap();
        assert!(svg.contains("</svg>") && !svg.contains("NaN"), "{what}");
    }
    done(path, &["report", "roller.zarr", "-o", "report.html"]);
    assert!(std::fs::read_to_string(path.join("report.html")).unwrap().contains("\"line\":true"));
    for refused in [
        &["plot", "roller.zarr", "profile", "--along", "y"][..],
        &["stress", "roller.zarr", "--rolling", "y"],
        &["leak", "roller.zarr", "--pressure-drop", "1 bar", "--viscosity", "1 mPa s"],
    ] {
        let output = asperity(path, refused);
        assert_eq!(output.status.code(), Some(2), "{refused:?}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("line contact"), "{refused:?}");
    }
}

#[test]
fn a_profile_is_described_and_makes_a_surface() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let points: String = (0..2000)
        .map(|i| {
            let x = f64::from(i);
            // Waves of 100 and 23 points, on a slope.
            let z =
                (std::f64::consts::TAU * x / 100.0).sin() + 0.1 * (std::f64::consts::TAU * x / 23.0).sin();
            format!("{x};{}\n", (1e3 * z + 0.5 * x).to_string().replace('.', ","))
        })
        .collect();
    std::fs::write(path.join("stylus.csv"), format!("x [um]; z [nm]\n{points}")).unwrap();
    let object: Value =
        serde_json::from_str(&done(path, &["surface", "info", "stylus.csv", "--json"])).unwrap();
    let number = |name: &str| object[name].as_f64().unwrap();
    assert_eq!(object["shape"], serde_json::json!([2000]));
    assert!((number("rq") / (0.505f64.sqrt() * 1e-6) - 1.0).abs() < 5e-3, "{object}"); // what the straight line takes
    assert!((number("rsm") / 100e-6 - 1.0).abs() < 0.01, "{object}"); // an end known to a point in 19 elements
    let told = done(path, &["surface", "info", "stylus.csv", "--cutoff", "50 um", "--plot", "stylus.svg"]);
    assert!(told.contains("Ra") && told.contains("Rsm") && path.join("stylus.svg").exists(), "{told}");
    let told = done(
        path,
        &["surface", "from-profile", "stylus.csv", "--cells", "128", "--to-size", "256 um", "-o", "map.npz"],
    );
    assert!(told.contains("Sq"), "{told}");
    let output = asperity(path, &["surface", "from-profile", "map.npz", "-o", "other.npz"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("two columns"));
}

#[test]
fn a_profile_is_cropped_levelled_and_filtered_like_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    // Two sines of 10 and 100 points, 1 and 4 um high, on a slope; 400 points every micrometre.
    let height = |i: usize| {
        let wave = |points: f64| (std::f64::consts::TAU * i as f64 / points).sin();
        wave(10.0) + 4.0 * wave(100.0) + 0.01 * i as f64
    };
    let rows: String = (0..400).map(|i| format!("{}; {}\n", i, height(i))).collect();
    std::fs::write(path.join("p.csv"), format!("x [um]; z [um]\n{rows}")).unwrap();
    let process = |ops: &[&str], output: &str| {
        let mut words = vec!["surface", "process", "p.csv", "-o", output, "--json", "--force"];
        words.extend(ops.iter().flat_map(|op| ["--op", op]));
        asperity(path, &words)
    };
    let heights = |file: &str| -> Vec<f64> {
        let text = std::fs::read_to_string(path.join(file)).unwrap();
        let number = |line: &str| line.split_once('\t')?.1.parse().ok();
        text.lines().filter_map(number).collect()
    };
    let output = process(&["crop size=300um corner=100um"], "part.txt");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let part = heights("part.txt");
    assert_eq!(part.len(), 300);
    // Rounding of metres.
    assert!(part.iter().enumerate().all(|(i, z)| (z - 1e-6 * height(100 + i)).abs() < 1e-15));
    // Without the slope and the long sine, the short one is left. The least-squares line of the long sine, 4 um high over 4 whole
    // waves, rises by R = 6*4/(4 pi) = 1.9 um. Of this line the filter keeps the waves k > 8 of 2R/(2 pi k): a mean square of
    // (R/pi)^2/2/8 = 0.02 um^2 beside the 0.5 um^2 of the sine, and 0.015 um at the short wave itself: 4 % of the rms.
    let output = process(&["level=plane", "filter longest=50um"], "short.txt");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let rms = (heights("short.txt").iter().map(|z| z * z).sum::<f64>() / 400.0).sqrt();
    assert!((rms / (1e-6 / 2f64.sqrt()) - 1.0).abs() < 0.04, "{rms}");
    // What was written is a profile again, as long as it was.
    let again = asperity(path, &["surface", "info", "part.txt", "--json"]);
    let found: serde_json::Value = serde_json::from_slice(&again.stdout).unwrap();
    assert!(found["format"] == "profile" && (found["size"][0].as_f64().unwrap() / 3e-4 - 1.0).abs() < 1e-12);
    let refused = process(&["level=plane"], "map.npz");
    let told = String::from_utf8_lossy(&refused.stderr);
    assert!(refused.status.code() == Some(2) && told.contains("-o profile.txt"), "{told}");
}

#[test]
fn a_map_of_a_profile_tells_its_height_and_slope_beside_those_of_the_profile() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    // Heights alone: a wave of 50 points, 3000 points long, with a spike.
    let height =
        |i: u32| 1e3 * (std::f64::consts::TAU * f64::from(i) / 50.0).sin() + if i == 700 { 3e4 } else { 0.0 };
    let points: String = (0..3000).map(|i| format!("{}\n", height(i))).collect();
    std::fs::write(path.join("heights.txt"), format!("z [nm]\n{points}")).unwrap();
    let output = asperity(path, &["surface", "info", "heights.txt"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() == Some(2) && told.contains("3000 heights") && told.contains("--size"),
        "{told}"
    );
    let made = |options: &[&str]| {
        let start = [
            "surface",
            "from-profile",
            "heights.txt",
            "--size",
            "3 mm",
            "-o",
            "map.npz",
            "--force",
            "--json",
        ];
        let output = asperity(path, &[&start[..], options].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let object: Value = serde_json::from_slice(&output.stdout).unwrap();
        let findings = object["findings"].as_array().unwrap();
        let codes: Vec<String> = findings.iter().map(|f| f["code"].as_str().unwrap().to_owned()).collect();
        (object["history"].to_string(), codes, String::from_utf8(output.stderr).unwrap())
    };
    let (_, codes, _) = made(&["--cells", "500"]);
    assert!(codes.contains(&"outliers".to_owned()), "{codes:?}");
    let (history, codes, note) = made(&["--op", "outliers=6", "--op", "fill=harmonic", "--to-size", "1 mm"]);
    assert!(codes == ["unlike-profile"] && note.is_empty(), "{codes:?} {note}");
    // 1 um q / 2^(1/2) = 0.0889, to the width of a ring.
    for words in
        ["removed", "the surface: rms height", "all waves of the profile: rms height 707", "direction 0.09"]
    {
        assert!(history.contains(words), "{words}: {history}");
    }
    // A part without points is told with its share: 300 of 2999 spacings.
    let part: String =
        (0..3000).filter(|i| !(1001..1300).contains(i)).map(|i| format!("{i} {}\n", height(i))).collect();
    std::fs::write(path.join("gap.txt"), format!("# x [um] z [nm]\n{part}")).unwrap();
    let output = asperity(path, &["surface", "info", "gap.txt"]);
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(told.contains("10 % of the length") && told.contains("[profile-gaps]"), "{told}");
    // The wave is far above two cells: nothing is said to fall.
    let (_, _, note) = made(&["--op", "outliers=6", "--op", "fill=harmonic"]);
    assert!(note.contains("would need 3000 x 3000") && !note.contains("fall"), "{note}");
    std::fs::write(path.join("heights.txt"), "z [nm]\n".to_owned() + &"5\n".repeat(100)).unwrap();
    let output =
        asperity(path, &["surface", "from-profile", "heights.txt", "--size", "3 mm", "-o", "flat.npz"]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && told.contains("straight profile"), "{told}");
}
