//! Measured surfaces in a case: what the keys do, in which order, where the grid comes from, and what is refused.

use std::path::Path;

use asperity::surface::{Operation, Part};
use asperity_io::case::{Case, CaseErrors, Surface};
use asperity_io::topography::{Format, Topography, write};
use ndarray::Array2;

const FRAME: &str = r#"
[domain]
DOMAIN
[[body]]
poisson = 0.5
material = { model = "elastic", shear = "1 MPa" }
[load]
control = "load"
history = { kind = "step", value = "10 mN" }
[time]
end = "1 s"
steps = 2
"#;

fn parse(dir: &Path, domain: &str, surfaces: &[&str]) -> Result<Case, CaseErrors> {
    let surfaces: String = surfaces.iter().map(|keys| format!("[[surface]]\n{keys}\n")).collect();
    Case::parse(&format!("{}{surfaces}", FRAME.replace("DOMAIN", domain)), dir, &[])
}

/// A file of 12 x 8 points on 12 um x 4 um: a wave of 2 um along x on a tilted plane.
fn wavy(dir: &Path, name: &str, edit: impl Fn(&mut Array2<f64>)) {
    let mut heights = Array2::from_shape_fn((12, 8), |(i, j)| {
        1e-9 * ((i + 3 * j) as f64) + if i % 2 == 0 { 1e-8 } else { -1e-8 }
    });
    edit(&mut heights);
    let topography = Topography {
        format: Format::Sdf,
        heights,
        size: [12e-6, 4e-6],
        channel: None,
        channels: Vec::new(),
        metadata: Vec::new(),
    };
    write(&dir.join(name), &topography, Format::Sdf).unwrap();
}

fn file(keys: &str) -> String {
    format!("kind = \"file\"\npath = \"a.sdf\"\n{keys}")
}

/// The record of the only measured surface, once the gap is built.
fn record(dir: &Path, domain: &str, keys: &str) -> Vec<String> {
    let case = parse(dir, domain, &[&file(keys)]).unwrap_or_else(|e| panic!("{keys}: {e}"));
    case.gap().unwrap_or_else(|e| panic!("{keys}: {e}"));
    case.describe().preparation[0].steps.clone()
}

fn refused(dir: &Path, domain: &str, surfaces: &[&str], words: &[&str]) {
    let told = match parse(dir, domain, surfaces) {
        Err(errors) => errors.to_string(),
        Ok(case) => case.gap().expect_err(&surfaces.join("\n")).to_string(),
    };
    for word in words {
        assert!(told.contains(word), "{surfaces:?}: {told:?} lacks {word:?}");
    }
}

#[test]
fn grid_and_size_are_the_file_s_where_the_domain_leaves_them_out() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |_| ());
    let case = parse(dir.path(), "boundary = \"periodic\"", &[&file("")]).unwrap();
    assert_eq!((case.conditions.grid.cells(), case.conditions.grid.size()), ([12, 8], [12e-6, 4e-6]));
    assert_eq!(case.gap().unwrap().dim(), (12, 8));
    // What the preparation changes counts; so does a part that is given.
    let case = parse(dir.path(), "", &[&file("rotate = 1\ncrop = { cells = [4, 8] }")]).unwrap();
    assert_eq!((case.conditions.grid.cells(), case.conditions.grid.size()), ([8, 4], [4e-6, 4e-6]));
    let case = parse(dir.path(), "cells = [24, 8]", &[&file("resample = \"bilinear\"")]).unwrap();
    assert_eq!((case.conditions.grid.cells(), case.conditions.grid.size()), ([24, 8], [12e-6, 4e-6]));
    assert_eq!(case.gap().unwrap().dim(), (24, 8));
    // Resampling to the domain is nothing where the domain takes the surface's cells.
    let case = parse(dir.path(), "", &[&file("resample = \"bilinear\"")]).unwrap();
    assert_eq!((case.conditions.grid.cells(), case.gap().unwrap().dim()), ([12, 8], (12, 8)));
    // A sphere beside it needs no grid of its own.
    let sphere = "kind = \"sphere\"\nradius = \"1 mm\"";
    assert_eq!(parse(dir.path(), "", &[sphere, &file("")]).unwrap().conditions.grid.cells(), [12, 8]);
}

#[test]
fn without_a_measured_surface_the_domain_must_be_given() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |_| ());
    let sphere = "kind = \"sphere\"\nradius = \"1 mm\"";
    refused(dir.path(), "", &[sphere], &["domain.cells is missing", "domain.size is missing"]);
    refused(dir.path(), "cells = [4, 4]", &[sphere], &["domain.size is missing", "line 2"]);
    // Which of two?
    refused(dir.path(), "", &[&file(""), &file("")], &["domain.cells is missing", "2 measured surfaces"]);
    refused(dir.path(), "", &["kind = \"file\"\npath = \"b.sdf\""], &["b.sdf", "does not exist"]);
    refused(dir.path(), "", &[&file("level = \"flat\"")], &["surface[0].level", "\"quadratic\""]);
}

#[test]
fn a_size_or_a_grid_that_differs_is_never_cut_or_stretched_in_silence() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |_| ());
    let smaller = "cells = [12, 8]\nsize = [\"6 um\", \"2 um\"]";
    refused(
        dir.path(),
        smaller,
        &[&file("")],
        &["a.sdf measures", "domain.size", "crop = { size = [6e-6, 2e-6] }"],
    );
    let larger = "size = [\"24 um\", \"4 um\"]";
    refused(dir.path(), larger, &[&file("")], &["a.sdf measures", "leave domain.size out"]);
    let finer = "cells = [24, 16]";
    refused(dir.path(), finer, &[&file("")], &["12 x 8 points", "24 x 16 cells", "resample = \"bilinear\""]);
}

#[test]
fn keys_are_done_in_their_documented_order_and_recorded() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |z| {
        z[[5, 5]] = f64::NAN;
        z[[3, 2]] = 1e-3; // a spike
    });
    assert_eq!(
        record(dir.path(), "", "outliers = {}"),
        [
            "subtract the plane (least squares)",
            "remove outliers (beyond 6 deviations from the lines through the points 2 cells around): 1 removed, its height 9.796e-4 m",
            "subtract the plane (least squares)",
            "fill undefined points (harmonic, at most 25 %): 2 filled",
        ]
    );
    // Written in any order.
    let keys = r#"
        resample = "bilinear"
        window = { shape = "tukey", share = 0.5 }
        filter = { shortest = "1 um", edge = "gaussian" }
        fill_share = 0.5
        fill = "nearest"
        level = "mean"
        invert = true
        rotate = 2
        flip = "y"
        crop = { size = ["12 um", "4 um"] }
        channel = 0"#;
    assert_eq!(
        record(dir.path(), "cells = [6, 4]", keys),
        [
            "crop to 12 x 8 cells from (0, 0)",
            "flip along y",
            "rotate by 2 quarter turns",
            "invert",
            "subtract the mean (least squares)",
            "fill undefined points (nearest, at most 50 %): 1 filled",
            "keep wavelengths from 1e-6 m on (Gaussian)",
            "Tukey window over 50 % of the length",
            "resample to 6 x 4 cells (bilinear)",
        ]
    );
}

#[test]
fn a_list_of_steps_is_done_in_its_order_and_nothing_besides() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |_| ());
    let keys = r#"process = [
        { op = "level", form = "plane" },
        { op = "crop", cells = [8, 8], from = [1, 0] },
        { op = "filter", shortest = "3 um" },
        { op = "resample", method = "band-limited", cells = [10, 10] },
        { op = "rotate", quarter_turns = -1 },
        { op = "invert" },
        { op = "flip", axis = "x" },
        { op = "window" },
        { op = "outliers" },
        { op = "fill", method = "nearest", share = 1 },
    ]"#;
    let done = record(dir.path(), "", keys);
    assert_eq!(done.len(), 10);
    assert_eq!(done[1], "crop to 8 x 8 cells from (1, 0)");
    let case = parse(dir.path(), "", &[&file(keys)]).unwrap();
    assert_eq!((case.conditions.grid.cells(), case.conditions.grid.size()), ([10, 10], [4e-6, 8e-6]));
    // An empty list: the heights as they are, tilt and all.
    let case = parse(dir.path(), "", &[&file("process = []")]).unwrap();
    let gap = case.gap().unwrap();
    // Heights from 1e-8 to 42e-9: h0 = highest - z.
    assert!((gap[[0, 0]] - gap[[2, 0]] - 2e-9).abs() < 1e-20, "{gap}");
}

#[test]
fn slips_in_the_steps_are_told_with_their_place() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |z| z[[5, 5]] = f64::NAN);
    for (keys, words) in [
        ("process = [{ op = \"lvel\" }]", vec!["surface[0].process[0].op", "did you mean \"level\"?"]),
        ("process = [{ form = \"plane\" }]", vec!["op is missing"]),
        ("process = [\"level\"]", vec!["a table that begins with the key `op`"]),
        ("process = \"level\"", vec!["surface[0].process", "a list"]),
        ("process = [{ op = \"crop\", cels = [1, 1] }]", vec!["no key `cels`", "`cells`", "line 16"]),
        ("level = \"plane\"\nprocess = []", vec!["`level` cannot be combined with `process`", "add it to"]),
        ("fill_share = 0.5\nprocess = []", vec!["`fill_share` cannot be combined with"]),
        ("fill_share = 0", vec!["surface[0].fill_share is 0", "at most 1"]),
        ("fill_share = 0.01", vec!["1 of 96", "at most 1 %"]),
        ("fill = \"error\"", vec!["1 of 96", "harmonic or nearest"]),
        ("crop = {}", vec!["needs `cells` or `size` or `defined`"]),
        ("crop = { cells = [13, 8] }", vec!["cells to keep along x is 13", "12 of the surface"]),
        ("crop = { cells = [4, 4], corner = [0, 0] }", vec!["`corner` belongs to `size`"]),
        ("filter = {}", vec!["needs `longest` or `shortest`"]),
        ("filter = { longest = \"1 um\", shortest = \"2 um\" }", vec!["exchange"]),
        ("filter = { longest = \"2 s\" }", vec!["a length"]),
        ("flip = \"z\"", vec!["surface[0].flip", "\"x\", \"y\""]),
        ("rotate = 0.5", vec!["surface[0].rotate", "a whole number"]),
        ("window = { shape = \"hann\", share = 0.5 }", vec!["Tukey"]),
        ("border = \"window\"", vec!["surface[0].border", "\"mirror\""]),
        ("border = \"mirror\"\nwindow = {}", vec!["a window and a mirror", "one of the two"]),
        (
            "process = [{ op = \"window\" }, { op = \"border\", method = \"mirror\" }]",
            vec!["surface[0].process", "one of the two"],
        ),
        ("border = \"mirror\"\nprocess = []", vec!["`border` cannot be combined with `process`"]),
        ("outliers = { radius = 11 }", vec!["between 1 and 10 cells"]),
        ("outliers = true", vec!["surface[0].outliers", "a table"]),
        ("resample = \"cubic\"", vec!["\"bilinear\""]),
        ("channel = \"Phase\"", vec!["Phase"]),
        ("channel = -1", vec!["a number counted from 0"]),
        ("process = [{ op = \"filter\", longest = \"5 um\" }]", vec!["step", "undefined", "fill"]),
        ("process = []", vec!["a.sdf", "finite", "fill the undefined points"]),
    ] {
        // One error where the step is the only one: no number of it is told.
        let words: Vec<_> = words.into_iter().filter(|word| *word != "step").collect();
        refused(dir.path(), "", &[&file(keys)], &words);
    }
}

#[test]
fn a_mirrored_surface_has_twice_the_length_and_width_and_so_has_its_domain() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |_| ());
    let mirrored = |keys: &str| file(&format!("level = \"none\"\nborder = \"mirror\"\n{keys}"));
    let case = parse(dir.path(), "boundary = \"periodic\"", &[&mirrored("")]).unwrap();
    assert_eq!((case.conditions.grid.cells(), case.conditions.grid.size()), ([24, 16], [24e-6, 8e-6]));
    let gap = case.gap().unwrap();
    for (i, j) in (0..24).flat_map(|i| (0..16).map(move |j| (i, j))) {
        assert_eq!(gap[[i, j]], gap[[i.min(23 - i), j.min(15 - j)]]);
    }
    // The slope of the map changes sign at the border, which is no jump; without the reflections the tilt is one.
    let codes =
        |case: &Case| case.examine().unwrap().findings.iter().map(|f| f.code.to_string()).collect::<Vec<_>>();
    assert!(!codes(&case).contains(&"gap-not-periodic".to_owned()));
    let tilted = parse(dir.path(), "boundary = \"periodic\"", &[&file("level = \"none\"")]).unwrap();
    let found = tilted.examine().unwrap().findings;
    let jump = found.iter().find(|finding| finding.code == "gap-not-periodic").unwrap();
    assert!(jump.text.contains("border = \"mirror\""), "{}", jump.text);
    // Before the filter, which takes the surface as periodic; the crop counts before the reflections, the resampling after them.
    assert_eq!(
        record(
            dir.path(),
            "cells = [10, 10]",
            "resample = \"bilinear\"\nfilter = { shortest = \"2 um\" }\nborder = \"mirror\"\ncrop = { cells = [8, 8] }"
        ),
        [
            "crop to 8 x 8 cells from (2, 0)",
            "subtract the plane (least squares)",
            "fill undefined points (harmonic, at most 25 %): 0 filled",
            "continue by reflections along each axis (mirror)",
            "keep wavelengths from 2e-6 m on (sharp)",
            "resample to 10 x 10 cells (bilinear)",
        ]
    );
    // A domain of the file's own size.
    let own = "cells = [12, 8]\nsize = [\"12 um\", \"4 um\"]";
    let words = [
        "2.4e-5 m x 8e-6 m with its reflections",
        "leave domain.size out",
        "crop = { size = [6e-6, 2e-6] }, half of",
    ];
    refused(dir.path(), own, &[&mirrored("")], &words);
    refused(
        dir.path(),
        "cells = [12, 8]",
        &[&mirrored("")],
        &["24 x 16 points with its reflections", "domain.cells = [24, 16]"],
    );
    // A map of hardness is one of the domain.
    std::fs::write(dir.path().join("hard.txt"), "1 1 1 1 1 1 1 1 1 1 1 1\n".repeat(8)).unwrap();
    let body = "hardness_file = { path = \"hard.txt\", unit = \"1 GPa\" }";
    let text = format!("{}[[surface]]\n{}\n", FRAME.replace("DOMAIN", ""), mirrored(""));
    let text = text.replace("poisson = 0.5", &format!("poisson = 0.5\n{body}"));
    let told = Case::parse(&text, dir.path(), &[]).unwrap_err().to_string();
    assert!(
        told.contains("24 x 16 cells") && told.contains("continue the numbers by their reflections"),
        "{told}"
    );
}

#[test]
fn two_measured_surfaces_of_different_grids_make_one_gap() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |_| ());
    // The same plane wave on a finer grid, as seen from behind: mirrored along x.
    let fine = Topography {
        format: Format::X3p,
        heights: Array2::from_shape_fn((24, 16), |(i, j)| 1e-9 * (0.5 * (23 - i) as f64 + j as f64)),
        size: [12e-6, 4e-6],
        channel: None,
        channels: Vec::new(),
        metadata: Vec::new(),
    };
    write(&dir.path().join("b.x3p"), &fine, Format::X3p).unwrap();
    let a = file("level = \"none\"");
    let b = "kind = \"file\"\npath = \"b.x3p\"\nlevel = \"none\"\nflip = \"x\"\nresample = \"bilinear\"";
    let domain = "cells = [12, 8]\nsize = [\"12 um\", \"4 um\"]";
    let gap = parse(dir.path(), domain, &[&a, b]).unwrap().gap().unwrap();
    // Coarse cells lie in the middle of two fine ones: the bilinear value of a linear surface is exact inside, and
    // the mean of the two next to the edge as well.
    let sum = |i: usize, j: usize| {
        let own = 1e-9 * (i + 3 * j) as f64 + if i.is_multiple_of(2) { 1e-8 } else { -1e-8 };
        own + 1e-9 * (0.5 * (2.0 * i as f64 + 0.5) + 2.0 * j as f64 + 0.5)
    };
    let highest = (0..12).flat_map(|i| (0..8).map(move |j| sum(i, j))).fold(f64::MIN, f64::max);
    for ((i, j), h) in gap.indexed_iter() {
        assert!((h - (highest - sum(i, j))).abs() < 1e-21, "{i} {j}: {h:e}"); // eps of 6e-8
    }
    // The first file does not decide the grid in silence.
    refused(dir.path(), "", &[&a, b], &["2 measured surfaces"]);
}

#[test]
fn synthetic_roughness_takes_lay_distribution_and_preset() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |_| ());
    let domain = "cells = [64, 64]\nsize = [\"0.1 mm\", \"0.1 mm\"]";
    let part = |keys: &str| {
        let surface = format!("kind = \"self-affine\"\nseed = 1\n{keys}");
        match parse(dir.path(), domain, &[&surface]).unwrap_or_else(|e| panic!("{e}")).surfaces.remove(0) {
            Surface::Part(part) => part,
            other => panic!("{other:?}"),
        }
    };
    let spectrum = "hurst = 0.8\nrms_height = \"1 um\"\nlongest = \"0.1 mm\"\nshortest = \"10 um\"\n";
    let Part::Synthesis(made) = part(&format!(
        "{spectrum}lay = {{ angle = \"90 deg\", ratio = 3 }}\ndistribution = {{ skewness = -0.5, kurtosis = 4 }}"
    )) else {
        panic!()
    };
    let lay = made.lay.unwrap();
    assert!((lay.angle - std::f64::consts::FRAC_PI_2).abs() < 1e-15 && lay.ratio == 3.0);
    let Part::Synthesis(like) = part(&format!("{spectrum}distribution = {{ path = \"a.sdf\" }}")) else {
        panic!()
    };
    assert!(format!("{:?}", like.distribution).starts_with("Samples"));
    let Part::SelfAffine(preset) = part("preset = \"contact-mechanics-challenge\"\nshortest = \"5 um\"")
    else {
        panic!()
    };
    assert_eq!((preset.hurst, preset.longest, preset.roll_off, preset.shortest), (0.8, 1e-4, 2e-5, 5e-6));
    for (keys, words) in [
        ("", vec!["needs `rms_gradient` or `rms_height`"]),
        ("rms_height = \"1 um\"", vec!["hurst is missing", "longest is missing", "shortest is missing"]),
        ("preset = \"challenge\"", vec!["contact-mechanics-challenge"]),
        ("preset = \"contact-mechanics-challenge\"", vec!["two cells"]),
    ] {
        let surface = format!("kind = \"self-affine\"\nseed = 1\n{keys}");
        refused(dir.path(), domain, &[&surface], &words);
    }
    for (keys, words) in [
        ("lay = { ratio = 0.5 }", vec!["surface[0].lay", "1 or more"]),
        ("lay = { angle = \"3 m\", ratio = 2 }", vec!["surface[0].lay.angle", "30 deg"]),
        ("lay = { angle = 45, ratio = 2 }", vec!["surface[0].lay.angle", "\"45 deg\" or \"45 rad\""]),
        ("lay = {}", vec!["lay.ratio is missing"]),
        ("distribution = {}", vec!["no key", "path names a measured surface"]),
        ("distribution = { skewness = 3, kurtosis = 4 }", vec!["surface[0].distribution", "well above"]),
        ("distribution = { path = \"a.sdf\", skewness = 1 }", vec!["leave path out"]),
        ("distribution = { path = \"none.sdf\" }", vec!["does not exist"]),
    ] {
        let surface = format!("kind = \"self-affine\"\nseed = 1\n{spectrum}{keys}");
        refused(dir.path(), domain, &[&surface], &words);
    }
}

#[test]
fn the_surface_is_read_once() {
    let dir = tempfile::tempdir().unwrap();
    wavy(dir.path(), "a.sdf", |_| ());
    let case = parse(dir.path(), "", &[&file("")]).unwrap();
    std::fs::remove_file(dir.path().join("a.sdf")).unwrap();
    assert_eq!(case.gap().unwrap().dim(), (12, 8));
    let Surface::File(measured) = &case.surfaces[0] else { panic!() };
    assert!(matches!(&measured.steps[0], asperity_io::preparation::Step::Operation(Operation::Level(_))));
}
