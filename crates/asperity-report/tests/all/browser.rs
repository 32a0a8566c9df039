//! The report in a browser: it draws without errors, its controls work, its values are those of the result.
//! Skipped with a message where no Chromium or Chrome is installed.

use std::path::{Path, PathBuf};
use std::process::Command;

use asperity_io::case::Case;
use asperity_io::session::{RunOptions, run};
use asperity_io::store::{At, FieldKind, Reader};
use asperity_report::page::{Options, page};

const CASE: &str = r#"
title = "Rough </script><b>sphere"
[domain]
cells = [48, 32]
size = ["0.15 mm", "0.1 mm"]
[[surface]]
kind = "sphere"
radius = "1 mm"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_gradient = 0.05
longest = "50 um"
shortest = "8 um"
seed = 1
[[body]]
poisson = 0.38
hardness = "300 MPa"
material = { model = "zener", shear = "1 GPa", shear_kelvin = "1 GPa", retardation_time = "10 s" }
[load]
control = "load"
history = { kind = "step", value = "0.2 N" }
[time]
end = "50 s"
steps = 10
[output]
fields = ["pressure", "gap"]
every = 5
"#;

/// Catches what the page complains of; goes before the page's own script.
const WATCH: &str = include_str!("../pages/watch.html");

/// Uses the page as a person would, and writes down what it shows.
const USE: &str = include_str!("../pages/use.html");

fn browser() -> Option<PathBuf> {
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).flat_map(|dir| names.map(|name| dir.join(name))).find(|file| file.is_file())
}

/// Steady states at four velocities: they stand where the page has times else.
pub const SWEEP: &str = r#"
[domain]
cells = [32, 32]
size = ["0.1 mm", "0.1 mm"]
boundary = "periodic"
[[surface]]
kind = "self-affine"
hurst = 0.8
rms_gradient = 0.1
longest = "50 um"
shortest = "25 um"
seed = 1
[[body]]
poisson = 0.5
material = { model = "zener", shear = "10 MPa", shear_kelvin = "1 MPa", retardation_time = "10 ms" }
[load]
control = "pressure"
history = { kind = "step", value = "0.1 MPa" }
[motion.steady]
velocities = ["0.1 mm/s", "1 mm/s", "10 mm/s", "100 mm/s"]
[output]
fields = ["pressure", "gap"]
"#;

fn result(directory: &Path) -> Reader {
    solved(CASE, directory)
}

pub fn solved(case: &str, directory: &Path) -> Reader {
    let case = Case::parse(case, directory, &[]).unwrap();
    let path = directory.join("result.zarr");
    run(&case, &RunOptions { output: Some(path.clone()), ..RunOptions::default() }, |_| {}).unwrap();
    Reader::open(&path).unwrap()
}

/// What a person sees who uses the page in a window of that size.
fn seen(browser: &Path, directory: &Path, html: &str, size: &str) -> serde_json::Value {
    let watched = html.replacen("<head>", &format!("<head>{WATCH}"), 1).replacen(
        "</body>",
        &format!("{USE}</body>"),
        1,
    );
    let file = directory.join("report.html");
    std::fs::write(&file, watched).unwrap();
    let output = Command::new(browser)
        .args([
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--timeout=60000",
            "--virtual-time-budget=30000",
        ])
        .arg(format!("--window-size={size}"))
        .arg(format!("--user-data-dir={}", directory.join("profile").display()))
        .arg("--dump-dom")
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    let json = text.split_once("SEEN").and_then(|(_, rest)| rest.split_once("NEES"));
    let (json, _) = json.unwrap_or_else(|| panic!("{text}\n{}", String::from_utf8_lossy(&output.stderr)));
    let json = json.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    serde_json::from_str(&json).unwrap()
}

#[test]
fn the_report_works_in_a_browser() {
    let Some(browser) = browser() else {
        eprintln!("skipped: no Chromium or Chrome on the path");
        return;
    };
    let directory = tempfile::tempdir().unwrap();
    let reader = result(directory.path());
    let html = page(&reader, &Options::default()).unwrap();
    assert!(html.len() < 1_000_000, "{}", html.len());
    for size in ["1200,900", "390,844"] {
        let seen = seen(&browser, directory.path(), &html, size);
        let text = |key: &str| seen[key].as_str().unwrap_or_else(|| panic!("{key}: {seen}")).to_owned();
        assert_eq!(seen["faults"], serde_json::json!([]), "{size}");
        assert_eq!(text("title"), "Rough </script><b>sphere");
        assert_eq!(text("status"), "complete, 11 rows");
        assert_eq!(text("instants"), "2");
        assert!(text("last").starts_with("t = 50 s, load 200 mN, contact "), "{seen}");
        assert!(text("first").starts_with("t = 0 s, load 200 mN, contact "), "{seen}");
        assert_eq!(
            seen["marks"], 3,
            "the instant is marked in the charts over time; the load is constant and has none"
        );
        // The pressure under the pointer is that of the result.
        for (key, at) in [("probe", At::Last), ("probe0", At::Index(0))] {
            let field = reader.field(FieldKind::Pressure, at).unwrap();
            let largest = field.iter().copied().fold(0.0, f64::max);
            let shown = text(key);
            let number = shown.split("pressure ").nth(1).unwrap();
            let (value, unit) = number.split_once(' ').unwrap_or((number, "Pa"));
            let scale = match unit {
                "Pa" => 1.0,
                "kPa" => 1e3,
                "MPa" => 1e6,
                unit => panic!("{unit}"),
            };
            let value = value.parse::<f64>().unwrap() * scale;
            // Four digits, and the steps of 16 bits.
            let tolerance = 1e-3 * field[[24, 16]] + largest / 65534.0;
            assert!((value - field[[24, 16]]).abs() <= tolerance, "{shown}: {}", field[[24, 16]]);
        }
        assert_eq!(text("heading"), "Pressure at t = 50 s");
        assert_eq!(text("profile"), "Pressure at y = 51.56 µm, t = 0 s");
        assert_eq!(text("moved"), "Pressure at y = 54.69 µm, t = 0 s");
        assert_eq!(text("turned"), "Pressure at x = 79.69 µm, t = 0 s");
        assert_eq!(text("played"), "2");
        colours_follow_their_limits(&seen, &reader);
        charts_zoom_and_read_values(&seen, &reader);
        let rows = reader.rows().unwrap();
        let last = rows.last().unwrap();
        assert!(text("read").starts_with("time 50 s"), "{seen}");
        let area = last.contact_area * 1e12;
        assert!(text("read").contains(&format!("counted {}", area.round())), "{seen}: {area}");
        for (n, least) in [(0, 10), (1, 10), (2, 20)] {
            assert!(seen["colours"][n].as_u64() >= Some(least), "canvas {n}: {seen}");
        }
        assert!(seen["colours"][3].as_u64() >= Some(10), "bar of the relief: {seen}");
        // Three over time (the load is constant), profile, four of the material, two of the solver, spectrum.
        assert_eq!(seen["charts"], 11, "{seen}");
        assert_eq!(seen["wide"], true, "nothing is wider than a window of {size}");
        assert!(text("footer").contains("Leon Sorokin"), "{seen}");
    }
}

fn number(value: &serde_json::Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// Colours of the first instant, of all, as typed, as typed wrongly, and logarithmic.
fn colours_follow_their_limits(seen: &serde_json::Value, reader: &Reader) {
    let largest = |at: At| {
        let field = reader.field(FieldKind::Pressure, at).unwrap();
        field.iter().copied().fold(0.0, f64::max)
    };
    let common = (0..3).map(|n| largest(At::Index(n))).fold(0.0, f64::max);
    for (key, high) in [("each", largest(At::Index(0))), ("all", common)] {
        assert_eq!(seen[key][4], 0, "{seen}");
        // The number goes through the page unchanged, but for the rounding of texts.
        assert!((number(&seen[key][5]) - high).abs() <= 1e-12 * high, "{seen}: {high}");
    }
    assert_eq!(seen["own"], serde_json::json!(["own", "1", "30", "MPa", 1_000_000, 30_000_000]));
    assert_eq!(
        seen["wrong"],
        serde_json::json!(["true", 30_000_000]),
        "no number: told, and nothing changes"
    );
    assert_eq!([&seen["logGap"][0], &seen["logGap"][1], &seen["logGap"][3]], [true, true, true], "{seen}");
    assert_eq!(seen["states"], true, "states have no limits");
}

/// Cursor, zoom, legend and axes of the charts over time, 0 to 50 s in steps of 5 s.
fn charts_zoom_and_read_values(seen: &serde_json::Value, reader: &Reader) {
    let text = |key: &str| seen[key].as_str().unwrap_or_else(|| panic!("{key}: {seen}"));
    let range = |value: &serde_json::Value| [number(&value[0]), number(&value[1])];
    let middle = &reader.rows().unwrap()[5];
    let area = (middle.contact_area * 1e12).round();
    assert!(text("cursor").starts_with(&format!("time 25 s, counted {area} µm²")), "{seen}");
    let approach = 1e6 * middle.approach;
    assert!(
        text("together").starts_with(&format!("time 25 s, approach {approach:.3} µm")),
        "one cursor: {seen}"
    );
    assert!(!text("idle").contains("time"), "no values without a cursor: {seen}");
    // No point lies on the frame: a fiftieth of the time is free on both sides.
    let whole = [-1.0, 51.0];
    assert_eq!(range(&seen["whole"]), whole);
    // Dragged from a fifth to three fifths of some 450 pixels, and pixels are whole.
    for chart in [0, 1] {
        let [from, to] = range(&seen["zoomed"][chart]);
        assert!((from - 9.4).abs() < 0.5 && (to - 30.2).abs() < 0.5, "{seen}");
        assert_eq!(range(&seen["unzoomed"][chart]), whole, "a double click shows all");
    }
    assert_eq!(seen["zoomedLog"], seen["zoomed"][0], "the zoom along time stays with the other axis");
    assert_eq!([&seen["zoomed"][2], &seen["unzoomed"][2]], [false, true], "the way back shows while zoomed");
    assert_eq!(seen["hidden"], serde_json::json!([true, true, false, true]), "its name hides a curve");
    assert_eq!(seen["shown"], serde_json::json!([true, true, true, true]));
    assert_eq!(seen["logY"], serde_json::json!([3, 1]), "uPlot's number of logarithmic and linear");
    // The first row after t = 0 is at 5 s.
    assert_eq!([&seen["switched"][0], &seen["switched"][1]], [3, 3]);
    let [from, to] = range(&seen["switched"][2]);
    let room = 10f64.powf(0.02);
    // Powers of ten of logarithms round in the last digits.
    assert!((from * room / 5.0 - 1.0).abs() < 1e-12 && (to / room / 50.0 - 1.0).abs() < 1e-12, "{seen}");
    // Half of the linear and of the logarithmic axis, to a pixel of some 150.
    let [[x0, x1], [y0, y1]] = [0, 1].map(|axis| range(&seen["tiny"][axis]));
    let [[a0, a1], [b0, b1]] = [0, 1].map(|axis| range(&seen["tinyZoomed"][axis]));
    assert!(((a1 - a0) / (x1 - x0) - 0.5).abs() < 0.01, "{seen}");
    assert!(((b1 / b0).ln() / (y1 / y0).ln() - 0.5).abs() < 0.01, "{seen}");
    assert_eq!(seen["tinyWhole"], seen["tiny"]);
    assert_eq!(seen["ticks"], serde_json::json!(["5", "10", "20", "50"]));
    assert_eq!(text("picked"), "0", "a click shows the maps of the nearest instant");
}

#[test]
fn the_report_of_a_sweep_over_velocities_works_in_a_browser() {
    let Some(browser) = browser() else {
        eprintln!("skipped: no Chromium or Chrome on the path");
        return;
    };
    let directory = tempfile::tempdir().unwrap();
    let reader = solved(SWEEP, directory.path());
    let html = page(&reader, &Options::default()).unwrap();
    let seen = seen(&browser, directory.path(), &html, "1200,900");
    assert_eq!(seen["faults"], serde_json::json!([]), "{seen}");
    assert!(seen["last"].as_str().unwrap().starts_with("v = 100 mm/s, load"), "{seen}");
    assert!(seen["read"].as_str().unwrap().starts_with("velocity 100 mm/s"), "{seen}");
    // Velocities are on a logarithmic axis from the start.
    assert_eq!(seen["logY"], serde_json::json!([3, 3]));
    assert_eq!(seen["switched"][0], 1);
    // The theory stands beside the computed area.
    assert!(seen["read"].as_str().unwrap().contains("Persson's theory"), "{seen}");
}

#[test]
fn a_report_without_contact_says_so_in_place_of_empty_axes() {
    let Some(browser) = browser() else {
        eprintln!("skipped: no Chromium or Chrome on the path");
        return;
    };
    let directory = tempfile::tempdir().unwrap();
    let apart = CASE
        .replace("control = \"load\"", "control = \"approach\"")
        .replace("value = \"0.2 N\"", "value = \"-1 um\"");
    let reader = solved(&apart, directory.path());
    let html = page(&reader, &Options::default()).unwrap();
    let seen = seen(&browser, directory.path(), &html, "1200,900");
    assert_eq!(seen["faults"], serde_json::json!([]), "{seen}");
    let words: Vec<&str> =
        seen["empty"].as_array().unwrap().iter().filter_map(|text| text.as_str()).collect();
    assert!(words.contains(&"Nothing touches at any time."), "{words:?}");
}

/// What a page knows.
fn state(html: &str) -> serde_json::Value {
    let (_, rest) = html.split_once("id=\"state\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn a_cyclic_run_has_all_its_cycles_and_the_rows_of_the_last_one() {
    let directory = tempfile::tempdir().unwrap();
    let cyclic = CASE
        .replace(
            "kind = \"step\", value = \"0.2 N\"",
            "kind = \"sine\", mean = \"0.2 N\", amplitude = \"0.1 N\", frequency = \"0.1 Hz\"",
        )
        .replace("steps = 10\n", "steps = 100\n");
    let reader = solved(&cyclic, directory.path());
    let state = state(&page(&reader, &Options::default()).unwrap());
    let load = reader.series("load").unwrap();
    let [from, to] = [0, 1].map(|end| usize::try_from(state["last_cycle"][end].as_u64().unwrap()).unwrap());
    // Five periods of twenty rows; at the ends of each the load is the mean, 0.2 N.
    assert_eq!((to - from, to), (20, load.len() - 1));
    for row in [from, to] {
        assert!((load[row] - 0.2).abs() < 1e-9, "{} N in row {row}: rounding of the sine", load[row]);
    }
    let of_stage = &asperity_io::cycles::of_result(&reader).unwrap()[0];
    let angles: Vec<f64> = of_stage.cycles.iter().map(|cycle| cycle.loss_angle.to_degrees()).collect();
    let shown = state["cycles"][0]["loss_angle"].as_array().unwrap();
    assert_eq!(shown.len(), 5);
    for (shown, angle) in shown.iter().map(number).zip(&angles) {
        assert!((shown - angle).abs() <= 1e-12 * angle.abs(), "{shown}° for {angle}°: rounding of texts");
    }
    // One that is held has neither.
    let held = directory.path().join("held");
    std::fs::create_dir(&held).unwrap();
    let held = self::state(&page(&solved(CASE, &held), &Options::default()).unwrap());
    assert_eq!([&held["last_cycle"], &held["cycles"]], [&serde_json::Value::Null, &serde_json::json!([])]);
}

#[test]
fn maps_are_reduced_until_they_fit_and_the_page_says_so() {
    let directory = tempfile::tempdir().unwrap();
    let reader = result(directory.path());
    let whole = page(&reader, &Options::default()).unwrap();
    let small = page(&reader, &Options { bytes: 6_000, instants: 2, ..Options::default() }).unwrap();
    assert!(!whole.contains("Maps show means"));
    assert!(small.contains("Maps show means over"));
    let maps = |page: &str| -> usize {
        page.split("id=\"blob-")
            .skip(1)
            .filter_map(|part| part.split_once("</script>"))
            .map(|(data, _)| data.len())
            .sum()
    };
    assert!(maps(&small) < maps(&whole) / 2);
    assert_eq!(small.matches("id=\"blob-pressure").count(), 2);
}
