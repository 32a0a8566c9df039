//! The options of `asperity plot`, and its animations.

use std::path::Path;

use crate::asperity;

/// A ball on rubber with six stored instants, small enough for a test.
const CASE: &str = r#"
title = "ball"
[domain]
cells = [40, 32]
size = ["1 mm", "0.8 mm"]
[[surface]]
kind = "sphere"
radius = "5 mm"
[[body]]
name = "rubber"
poisson = 0.5
material = { model = "zener", shear = "1 MPa", shear_kelvin = "2 MPa", retardation_time = "3 s" }
[load]
control = "load"
history = { kind = "ramp", value = "0.2 N", duration = "4 s" }
[time]
end = "10 s"
steps = 10
[output]
path = "ball.zarr"
fields = ["pressure", "gap"]
every = 2
"#;

fn result() -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("ball.toml"), CASE).unwrap();
    let run = asperity(directory.path(), &["run", "ball.toml", "--quiet"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    directory
}

/// The figure that a command draws, as the text of its SVG.
fn svg(directory: &Path, arguments: &[&str]) -> String {
    let all = [&["plot", "ball.zarr"], arguments, &["-o", "x.svg", "--force"]].concat();
    let output = asperity(directory, &all);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    std::fs::read_to_string(directory.join("x.svg")).unwrap()
}

/// How often a chunk of a PNG occurs, and the first eight bytes of the first one.
fn chunks(png: &[u8], name: &[u8; 4]) -> (usize, Vec<u8>) {
    let (mut at, mut count, mut first) = (8, 0, vec![]);
    while at + 12 <= png.len() {
        let long = u32::from_be_bytes(png[at..at + 4].try_into().unwrap()) as usize;
        if &png[at + 4..at + 8] == name {
            count += 1;
            if first.is_empty() {
                first = png[at + 8..(at + 16).min(at + 8 + long)].to_vec();
            }
        }
        at += 12 + long;
    }
    (count, first)
}

#[test]
fn a_field_is_animated_over_the_stored_times() {
    let dir = result();
    let path = dir.path();
    let output = asperity(path, &["plot", "ball.zarr", "pressure", "--animate", "p.png"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let data = std::fs::read(path.join("p.png")).unwrap();
    // 11 rows, every second one and the last: 6 instants; played for ever.
    assert_eq!(chunks(&data, b"acTL"), (1, vec![0, 0, 0, 6, 0, 0, 0, 0]));
    assert_eq!(chunks(&data, b"fcTL").0, 6);
    assert!(String::from_utf8_lossy(&output.stdout).contains("6 frames"));

    let gap = [
        "plot",
        "ball.zarr",
        "gap",
        "--animate",
        "g.gif",
        "--from",
        "2 s",
        "--to",
        "6 s",
        "--duration",
        "3 s",
    ];
    let output = asperity(path, &gap);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("3 frames"));
    assert!(std::fs::read(path.join("g.gif")).unwrap().starts_with(b"GIF89a"));

    let few = asperity(path, &["plot", "ball.zarr", "profile", "--animate", "f.apng", "--frames", "2"]);
    assert!(few.status.success(), "{}", String::from_utf8_lossy(&few.stderr));
    assert_eq!(chunks(&std::fs::read(path.join("f.apng")).unwrap(), b"acTL").1[3], 2);
}

#[test]
fn an_animation_of_the_stress_leaves_out_what_has_no_contact() {
    let dir = result();
    let stress = ["plot", "ball.zarr", "stress", "--animate", "s.png"];
    let output = asperity(dir.path(), &stress);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stderr).contains("1 stored time without contact"));
    // The load rises from 0: of six instants the first has no contact.
    assert!(String::from_utf8_lossy(&output.stdout).contains("5 frames"));
    let first = asperity(dir.path(), &["plot", "ball.zarr", "stress", "--time", "0 s"]);
    assert!(String::from_utf8_lossy(&first.stderr).contains("nothing touches at t = 0 s"));
}

#[test]
fn a_sine_has_its_last_period_and_a_temperature_its_curve() {
    let dir = tempfile::tempdir().unwrap();
    let sine =
        "history = { kind = \"sine\", mean = \"0.2 N\", amplitude = \"0.1 N\", frequency = \"0.2 Hz\" }";
    let case = CASE
        .replace("history = { kind = \"ramp\", value = \"0.2 N\", duration = \"4 s\" }", sine)
        .replace("steps = 10", "steps = 40")
        .replace(
            "retardation_time = \"3 s\" }",
            "retardation_time = \"3 s\", shift = { model = \"wlf\", c1 = 8.86, c2 = \"101.6 K\", reference = \"20 °C\" } }",
        )
        + "[temperature]\nhistory = { kind = \"ramp\", from = \"20 °C\", to = \"30 °C\", duration = \"10 s\" }\n";
    std::fs::write(dir.path().join("ball.toml"), case).unwrap();
    let run = asperity(dir.path(), &["run", "ball.toml", "--quiet"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    // Two periods of 5 s.
    assert!(svg(dir.path(), &["load-displacement"]).contains("Last cycle, t = 5 s to 10 s"));
    assert!(svg(dir.path(), &["load-displacement", "--to", "7 s"]).contains("Last cycle, t = 0 s to 5 s"));
    assert!(svg(dir.path(), &["evolution"]).contains(">temperature [°C]<"));
}

#[test]
fn limits_colours_window_and_size_are_as_asked_for() {
    let dir = result();
    let plain = svg(dir.path(), &["pressure"]);
    let limited = svg(dir.path(), &["pressure", "--limits", "0,1 MPa", "--colours", "grey"]);
    assert_ne!(plain, limited);
    assert!(limited.contains("pressure [MPa]") && !plain.contains("pressure [MPa]"), "the bar ends at 1 MPa");

    let start = svg(dir.path(), &["pressure", "--time", "0 s", "--same-colours"]);
    assert!(
        start.contains("pressure [kPa]"),
        "the colours of the whole run, not of a start without pressure"
    );

    let log = svg(dir.path(), &["gap", "--log", "--time", "2 s"]);
    assert!(log.contains("Light: contact"));

    let late = svg(dir.path(), &["evolution", "--from", "4 s", "--to", "8 s"]);
    assert!(late.contains(">4<") && late.contains(">8<") && !late.contains(">10<"), "ticks from 4 s to 8 s");

    let sized = svg(dir.path(), &["evolution", "--size", "160 mm,100 mm"]);
    // 160 mm and 100 mm in points, 72 to an inch.
    assert!(sized.contains("width=\"453.54pt\" height=\"283.46pt\""), "{}", &sized[..200]);
}

#[test]
fn options_that_cannot_be_followed_are_refused_with_exit_code_2() {
    let dir = result();
    let refused = |arguments: &[&str], words: &[&str]| {
        let output = asperity(dir.path(), &[&["plot", "ball.zarr"], arguments].concat());
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
        for word in words {
            assert!(told.contains(word), "{arguments:?}: {told:?} lacks {word:?}");
        }
    };
    refused(&["pressure", "--limits", "1 MPa"], &["--limits is \"1 MPa\"", "two pressures", "0,20 MPa"]);
    refused(&["pressure", "--limits", "2,1 MPa"], &["must be less than"]);
    refused(&["pressure", "--limits", "0,1 mm"], &["--limits is \"0,1 mm\"", "two pressures"]);
    refused(&["evolution", "--limits", "0,1 MPa"], &["--limits does not apply", "pressure, gap"]);
    refused(&["gap", "--log", "--limits", "0,1 um"], &["--log", "greater than 0"]);
    refused(&["evolution", "--colours", "grey"], &["--colours does not apply", "pressure, gap"]);
    refused(&["pressure", "--at", "0.1 mm"], &["--at does not apply", "a profile"]);
    refused(&["evolution", "--time", "1 s"], &["--time does not apply"]);
    refused(&["pressure", "-o", "none/a.png"], &["there is no folder none"]);
    refused(&["pressure", "--colours", "jet"], &["--colours", "viridis", "red-blue"]);
    refused(&["pressure", "--from", "1 s"], &["--from does not apply", "--time"]);
    refused(&["evolution", "--from", "5 s", "--to", "2 s"], &["--from is \"5 s\"", "before --to"]);
    refused(&["evolution", "--from", "20 s"], &["no row", "t = 10 s"]);
    refused(&["evolution", "--size", "160 mm"], &["--size is \"160 mm\"", "160 mm,100 mm"]);
    refused(&["evolution", "--size", "30 mm,30 mm"], &["too small", "mm are enough"]);
    refused(&["evolution", "--animate", "a.png"], &["--animate does not apply"]);
    refused(&["pressure", "--animate", "a.mp4"], &["a.mp4", ".gif"]);
    refused(
        &["pressure", "--animate", "a.png", "--from", "9.9 s"],
        &["two stored times", "1 in this window"],
    );
    refused(&["pressure", "--duration", "2 s"], &["--animate"]);
    std::fs::write(dir.path().join("taken.png"), "mine").unwrap();
    refused(&["pressure", "--animate", "taken.png"], &["taken.png", "--force"]);
    assert_eq!(std::fs::read_to_string(dir.path().join("taken.png")).unwrap(), "mine");
    assert!(!dir.path().join("a.png").exists());
}
