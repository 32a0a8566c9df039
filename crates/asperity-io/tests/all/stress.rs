//! The stress below the surface in cases and results.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use asperity::finding::{STRESS_AT_DEEPEST, STRESS_DEPTHS_COARSE, YIELD_EXCEEDED};
use asperity::load::Control;
use asperity::stress::{Component, StressQuantity, SubsurfaceStress};
use asperity_io::case::{Case, CaseErrors, Rows};
use asperity_io::export::{Format, Options, export, volume};
use asperity_io::session::{RunOptions, run};
use asperity_io::store::{At, FieldKind, Reader, Status, Writer};
use asperity_io::stress::{Below, Depths, FirstYield, Ratio, StressPlan, evaluate, first_yield, section};

/// A ball on a Zener solid, with everything that a case may ask for.
const CASE: &str = r#"
[domain]
cells = [24, 20]
size = ["1.2 mm", "1 mm"]
[[surface]]
kind = "sphere"
radius = "5 mm"
[[body]]
name = "rubber"
poisson = 0.45
material = { model = "zener", shear = "1 MPa", shear_kelvin = "2 MPa", retardation_time = "3 s" }
[[body]]
name = "resin"
bulk_modulus = "4 GPa"
material = { model = "zener", shear = "1 GPa", shear_kelvin = "2 GPa", retardation_time = "3 s" }
[load]
control = "load"
history = { kind = "ramp", value = "20 mN", duration = "1 s" }
[time]
end = "2 s"
steps = 8
[output]
fields = ["pressure"]
every = 2
[stress]
depths = { from = "50 um", to = "0.8 mm", count = 6 }
components = ["xz", "mises", "mises"]
threshold = "30 kPa"
yield_stress = "50 kPa"
rolling = "y"
"#;

fn read(text: &str) -> Result<Case, CaseErrors> {
    Case::parse(text, Path::new("."), &[])
}

fn solved(text: &str, directory: &Path) -> Reader {
    let options =
        RunOptions { output: Some(directory.join("out.zarr")), force: true, ..RunOptions::default() };
    let summary = run(&read(text).unwrap(), &options, |_| ()).unwrap();
    assert_eq!(summary.status, Status::Complete);
    Reader::open(&summary.result).unwrap()
}

#[test]
fn a_run_stores_the_stress_of_its_stored_pressures() {
    let directory = tempfile::tempdir().unwrap();
    let reader = solved(CASE, directory.path());
    let set = reader.stress().unwrap();
    assert_eq!((set.body.as_str(), set.poisson.constant()), ("rubber", Some(0.45)));
    assert_eq!(set.depths.len(), 7, "the surface is added");
    assert_eq!(set.instants, [0, 1, 2, 3, 4]);
    let grid = reader.header().grid;
    let pressure = reader.field(FieldKind::Pressure, At::Last).unwrap();
    let mut stress = SubsurfaceStress::new(grid, asperity::Boundary::Free, 0.45).unwrap();
    stress.set_pressure(pressure.as_slice().unwrap()).unwrap();
    let mut xz = vec![0.0; grid.len()];
    stress.component_into(Component::Xz, set.depths[3], &mut xz).unwrap();
    // The same routine on the same pressure gives the same bits.
    assert_eq!(reader.stress_field(StressQuantity::Xz, At::Last, 3).unwrap().as_slice().unwrap(), xz);
    let mises = reader.stress_field(StressQuantity::Mises, At::Last, 2).unwrap();
    let profile = reader.stress_profile("mises_by_depth").unwrap();
    assert_eq!(profile.dim(), (5, 7));
    assert_eq!(profile[(4, 2)], mises.iter().copied().fold(0.0, f64::max));
    let largest = reader.stress_series("max_mises").unwrap();
    let by_depth = profile.row(4).iter().copied().fold(0.0, f64::max);
    assert!(largest[4] >= by_depth && largest[4] < 1.1 * by_depth, "refined between the depths");
    // The first stored state has no load yet.
    assert_eq!(largest[0], 0.0);
    assert!(reader.stress_series("max_mises_x").unwrap()[0].is_nan());
    for name in ["stressed_volume", "orthogonal_shear", "orthogonal_shear_depth", "max_tension_y"] {
        assert!(reader.stress_series(name).unwrap()[4] > 0.0, "{name}");
    }
    assert!(
        reader.stress_field(StressQuantity::Zz, At::Last, 0).unwrap_err().to_string().contains("mises, xz")
    );
    assert!(reader.stress_series("max_shear").unwrap_err().to_string().contains("max_tresca"));
}

#[test]
fn first_yield_lies_between_two_stored_times() {
    let directory = tempfile::tempdir().unwrap();
    let reader = solved(CASE, directory.path());
    let below = Below::of(&reader).unwrap().unwrap();
    let mises = reader.stress_series("max_mises").unwrap();
    let first = mises.iter().position(|mises| *mises >= 50e3).unwrap();
    let Some(FirstYield::Between([before, after])) = first_yield(&below) else { panic!("{mises:?}") };
    assert_eq!([before[0], after[0]], [reader.field_times()[first - 1], reader.field_times()[first]]);
    assert!(before[1] < after[1]);
    let finding = reader.findings().iter().find(|finding| finding.code == YIELD_EXCEEDED).unwrap();
    assert!(finding.is_warning() && finding.value > finding.limit);
    assert!(finding.text.contains("hardness"));
    assert_eq!(finding.rows, Some([reader.field_steps()[first], reader.field_steps()[4]]));
    // Nothing yields under a tenth of the stress.
    let calm = solved(&CASE.replace("50 kPa", "1 MPa"), directory.path());
    let below = Below::of(&calm).unwrap().unwrap();
    let Some(FirstYield::Never { safety, .. }) = first_yield(&below) else { panic!("{below:?}") };
    // The largest of all times: the contact creeps under a held load, and its stress falls.
    let largest = mises.iter().copied().fold(0.0, f64::max);
    assert!(largest > mises[4] && (safety - 1e6 / largest).abs() < 1e-9 * safety);
}

#[test]
fn depths_that_miss_the_largest_stress_do_not_exclude_yield() {
    let directory = tempfile::tempdir().unwrap();
    let largest =
        |reader: &Reader| reader.stress_series("max_mises").unwrap().into_iter().fold(0.0, f64::max);
    let enclosed = solved(CASE, directory.path());
    let codes = [STRESS_AT_DEEPEST, STRESS_DEPTHS_COARSE];
    assert!(enclosed.findings().iter().all(|finding| !codes.contains(&finding.code.as_ref())));
    let truth = largest(&enclosed);
    // The body yields at 0.9 of its largest stress, and at none of these depths.
    let depths = "depths = { from = \"50 um\", to = \"0.8 mm\", count = 6 }";
    let missing = CASE.replace("50 kPa", &format!("{} Pa", 0.9 * truth));
    for (list, code, place) in [
        (r#"["0 um", "0.8 mm", "1.2 mm"]"#, STRESS_DEPTHS_COARSE, "between the surface and 800 µm"),
        (r#"["0.6 mm", "0.8 mm"]"#, STRESS_DEPTHS_COARSE, "between the surface and 600 µm"),
        (r#"["0 um", "15 um"]"#, STRESS_AT_DEEPEST, "below 15 µm"),
        (r#"["0.8 mm"]"#, STRESS_AT_DEEPEST, "at other depths"),
    ] {
        let reader = solved(&missing.replace(depths, &format!("depths = {list}")), directory.path());
        assert!(largest(&reader) < 0.9 * truth, "{list}");
        let found: Vec<_> = reader.findings().iter().filter(|finding| finding.code == code).collect();
        assert!(
            found.len() == 1 && found[0].is_warning() && found[0].text.contains(place),
            "{list} {found:?}"
        );
        let below = Below::of(&reader).unwrap().unwrap();
        let words = first_yield(&below).unwrap().sentence(&below);
        assert!(
            words.contains("not excluded") && words.contains(place) && !words.contains("no yield"),
            "{words}"
        );
    }
}

#[test]
fn a_stored_result_takes_another_stress_in_place_of_the_old_one() {
    let directory = tempfile::tempdir().unwrap();
    let reader = solved(CASE, directory.path());
    let before = reader.stress_series("max_mises").unwrap();
    let plan = StressPlan {
        depths: Depths::List(vec![0.0, 1e-4]),
        times: Some(vec![2.0]),
        quantities: vec![StressQuantity::Tension],
        ..StressPlan::new("rubber", 0.45)
    };
    let mut writer = Writer::amend(reader.path()).unwrap();
    assert!(Writer::amend(reader.path()).unwrap_err().to_string().contains("another process"));
    let below = evaluate(&mut writer, &plan, &AtomicBool::new(false), |_, _| ()).unwrap();
    drop(writer);
    assert_eq!(below.instants.len(), 1);
    let now = Reader::open(reader.path()).unwrap();
    let after = now.stress_series("max_mises").unwrap();
    assert!(after[..4].iter().all(|mises| mises.is_nan()) && after[4] > 0.9 * before[4]);
    assert!(now.stress_series("stressed_volume").is_err());
    assert!(
        !now.path().join("stress_mises").exists() && now.path().join("stress_tension/zarr.json").exists()
    );
    assert!(now.stress_field(StressQuantity::Tension, At::Index(0), 1).unwrap().iter().all(|s| s.is_nan()));
    assert_eq!(now.rows().unwrap(), reader.rows().unwrap(), "all else is as it was");
    // An interrupted evaluation leaves a result without stress.
    let mut writer = Writer::amend(reader.path()).unwrap();
    assert!(evaluate(&mut writer, &plan, &AtomicBool::new(true), |_, _| ()).is_err());
    drop(writer);
    let now = Reader::open(reader.path()).unwrap();
    assert!(now.stress().is_none() && !now.path().join("max_mises").exists());
    assert_eq!(now.status(), Status::Complete);
}

#[test]
fn a_run_that_is_interrupted_in_the_stress_is_resumed_to_the_same_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let whole = solved(CASE, directory.path());
    let path = directory.path().join("resumed.zarr");
    let interrupt = Arc::new(AtomicBool::new(false));
    let options =
        RunOptions { output: Some(path.clone()), interrupt: interrupt.clone(), ..RunOptions::default() };
    let case = read(CASE).unwrap();
    let summary = run(&case, &options, |progress| {
        if progress.stress == Some([2, 5]) {
            interrupt.store(true, std::sync::atomic::Ordering::Relaxed);
        }
    });
    assert_eq!(summary.unwrap().status, Status::Interrupted);
    assert!(Reader::open(&path).unwrap().stress().is_none());
    let options = RunOptions { output: Some(path.clone()), resume: true, ..RunOptions::default() };
    assert_eq!(run(&case, &options, |_| ()).unwrap().status, Status::Complete);
    let resumed = Reader::open(&path).unwrap();
    assert_eq!(resumed.stress(), whole.stress());
    assert_eq!(
        resumed.stress_profile("tension_by_depth").unwrap(),
        whole.stress_profile("tension_by_depth").unwrap()
    );
}

#[test]
fn what_the_stress_is_computed_from_is_stored() {
    let stored = |from: &str, to: &str| read(&CASE.replace(from, to)).unwrap().output;
    let of_gap = stored("fields = [\"pressure\"]", "fields = [\"gap\"]");
    assert!(of_gap.fields.contains(&FieldKind::Pressure) && of_gap.fields.contains(&FieldKind::Gap));
    assert_eq!(of_gap.rows, Rows::Every(2));
    // Its Poisson's ratio changes: the stress needs all rows.
    assert_eq!(stored("rolling = \"y\"", "body = \"resin\"").rows, Rows::Every(1));
}

#[test]
fn a_slip_in_the_section_is_told_with_key_value_and_what_to_do() {
    let change = |from: &str, to: &str| {
        assert!(CASE.contains(from), "{from}");
        read(&CASE.replace(from, to)).unwrap_err()
    };
    for (from, to, key, told) in [
        ("threshold = \"30 kPa\"", "threshold = \"30 mm\"", "stress.threshold", "a pressure"),
        ("threshold = \"30 kPa\"", "treshold = \"30 kPa\"", "stress.treshold", "did you mean `threshold`?"),
        ("rolling = \"y\"", "rolling = \"z\"", "stress.rolling", "\"x\""),
        ("rolling = \"y\"", "body = \"steel\"", "stress.body", "\"rubber\" (0) or \"resin\" (1)"),
        ("rolling = \"y\"", "body = 2", "stress.body", "\"resin\" (1)"),
        ("rolling = \"y\"", "body = -1", "stress.body", "counted from 0"),
        ("poisson = 0.45", "poisson = -0.2", "stress", "Poisson's ratio of rubber is -0.2"),
        ("\"xz\", ", "\"mizes\", ", "stress.components[0]", "did you mean \"mises\"?"),
        ("from = \"50 um\"", "from = \"5 um\"", "stress.depths.from", "a quarter of a cell"),
        ("from = \"50 um\"", "from = \"5 MPa\"", "stress.depths.from", "a length"),
        ("from = \"50 um\"", "from = \"0 um\"", "stress.depths.from", "greater than 0"),
        ("to = \"0.8 mm\"", "to = \"20 um\"", "stress.depths.to", "below `from`"),
        ("count = 6", "count = 1000000000", "stress.depths.count", "10000"),
        ("count = 6", "count = 1", "stress.depths.count", "2 or more"),
        ("rolling = \"y\"", "times = \"all\"", "stress.times", "output.every = 1"),
        ("rolling = \"y\"", "times = \"some\"", "stress.times", "\"fields\""),
        ("rolling = \"y\"", "times = [\"0.7 s\"]", "stress.times[0]", "output.times"),
        ("rolling = \"y\"", "times = []", "stress.times", "at least one"),
    ] {
        let errors = change(from, to);
        let error = &errors.errors[0];
        assert_eq!(error.key, key, "{to}: {errors}");
        assert!(format!("{error} {}", error.expected).contains(told), "{to}: {error} / {}", error.expected);
        assert!(error.line.is_some(), "{to}");
    }
    let list = |depths: &str| {
        let row = "{ from = \"50 um\", to = \"0.8 mm\", count = 6 }";
        read(&CASE.replace(row, depths))
    };
    for (depths, key, told) in [
        ("[\"0 um\", \"-5 um\"]", "stress.depths[1]", "not less than 0"),
        ("[\"0 um\", nan]", "stress.depths[1]", "nan"),
        ("[\"0 um\", \"1 um\"]", "stress.depths[1]", "a quarter of a cell"),
        ("[\"80 um\", \"60 um\"]", "stress.depths", "greater than the one before"),
        ("[]", "stress.depths", "number of depths"),
        ("\"deep\"", "stress.depths", "\"auto\""),
        ("7", "stress.depths", "a list of lengths"),
    ] {
        let errors = list(depths).unwrap_err();
        assert_eq!(errors.errors[0].key, key, "{depths}: {errors}");
        let told_as = format!("{} {}", errors, errors.errors[0].expected);
        assert!(told_as.contains(told), "{depths}: {told_as}");
    }
    let case = list("[\"0 um\", \"0.1 mm\", \"2 m\"]").unwrap();
    assert_eq!(case.stress.unwrap().depths, Depths::List(vec![0.0, 1e-4, 2.0]));
    let times = CASE.replace("every = 2", "times = [\"0.5 s\", \"1 s\"]");
    let times = read(&times.replace("rolling = \"y\"", "times = [\"0 s\", \"0.5 s\", \"2 s\"]")).unwrap();
    assert_eq!(times.stress.unwrap().times.unwrap(), [0.0, 0.5, 2.0]);
}

#[test]
fn an_elastic_body_with_a_bulk_modulus_has_a_stress() {
    let elastic = CASE.replace(
        "material = { model = \"zener\", shear = \"1 GPa\", shear_kelvin = \"2 GPa\", retardation_time = \"3 s\" }",
        "material = { model = \"elastic\", shear = \"1 GPa\" }",
    );
    let case = read(&elastic.replace("rolling = \"y\"", "body = 1")).unwrap();
    // (3 B - 2 G)/(2 (3 B + G)) of B = 4 GPa and G = 1 GPa.
    assert!((case.stress.as_ref().unwrap().poisson.constant().unwrap() - 10.0 / 26.0).abs() < 1e-15);
    let description = case.describe().stress.unwrap();
    assert_eq!((description.depth_count, description.times), (7, Some(5)));
    // Two fields at 7 depths and 5 times.
    assert_eq!(description.result_bytes, Some(8 * 2 * 7 * 5 * 24 * 20));
}

#[test]
fn a_section_holds_the_largest_stress_and_a_map() {
    let directory = tempfile::tempdir().unwrap();
    let reader = solved(CASE, directory.path());
    let below = Below::of(&reader).unwrap().unwrap();
    let worst = below.worst().unwrap();
    let found = section(&reader, &below, worst).unwrap();
    let depths: Vec<f64> = found.maps.iter().map(|(depth, _)| depth / found.place[0]).collect();
    assert_eq!(depths, [0.5, 1.0, 2.0]);
    let map = &found.maps[1].1;
    assert_eq!(map.dim(), (24, 20));
    assert_eq!((found.along_x.dim().0, found.along_y.as_ref().unwrap().dim().0), (24, 20));
    let largest = map.iter().copied().fold(0.0, f64::max);
    // The map is at the depth of the maximum, computed again.
    assert!((largest / found.largest - 1.0).abs() < 1e-12, "{largest} {}", found.largest);
    assert!(found.along_x.iter().chain(found.along_y.iter().flatten()).all(|s| *s <= 1.0001 * largest));
    // No contact, no section.
    assert!(
        section(&reader, &below, &below.instants[0]).unwrap_err().to_string().contains("nothing touches")
    );
}

#[test]
fn volumes_and_exports_hold_the_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let reader = solved(CASE, directory.path());
    let plan = StressPlan::of(reader.stress().unwrap(), &reader);
    let quantities = [StressQuantity::Mises, StressQuantity::Xz];
    for (name, kind, slices) in [("a.vti", "ImageData", 33), ("a.vtr", "RectilinearGrid", 7)] {
        let path = directory.path().join(name);
        volume(&reader, &plan, At::Last, &quantities, &path, false).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let start = bytes.windows(7).position(|w| w == b"\"raw\">\n").unwrap() + 8;
        let head = String::from_utf8_lossy(&bytes[..start]).into_owned();
        assert!(head.contains(kind) && head.contains(&format!("0 23 0 19 0 {}", slices - 1)), "{head}");
        let offset: usize = head
            .split("stress_xz\" format=\"appended\" offset=\"")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap()
            .parse()
            .unwrap();
        let length = u64::from_le_bytes(bytes[start + offset..][..8].try_into().unwrap());
        assert_eq!(length, 4 * 24 * 20 * slices);
        // The last slice is the surface, where no shear stress acts; 32-bit numbers of 1e5 Pa.
        let surface = start + offset + 8 + length as usize - 4 * 24 * 20;
        let (numbers, _) = bytes[surface..][..4 * 24 * 20].as_chunks::<4>();
        assert!(numbers.iter().all(|x| f32::from_le_bytes(*x).abs() < 1e-6));
        assert!(bytes.ends_with(b"</VTKFile>\n"));
        let error = volume(&reader, &plan, At::Last, &quantities, &path, false).unwrap_err();
        assert!(error.to_string().contains("--force"));
    }
    let wrong = volume(&reader, &plan, At::Last, &quantities, &directory.path().join("a.vtk"), false);
    assert!(wrong.unwrap_err().to_string().contains(".vti"));
    for format in [Format::NetCdf, Format::Hdf5, Format::Npz, Format::Csv, Format::Vtk] {
        let path = directory.path().join("all").with_extension(format.extension());
        export(&reader, format, &path, &Options::default()).unwrap();
    }
}

/// A rigid cylinder on a steel plate, in plane strain.
const LINE: &str = r#"
[domain]
cells = [192]
size = ["1.2 mm"]
[[surface]]
kind = "cylinder"
radius = "10 mm"
[[body]]
name = "steel"
poisson = 0.3
material = { model = "elastic", young = "210 GPa" }
[load]
control = "load"
history = { kind = "step", value = "500 N/mm" }
[time]
end = "1 s"
steps = 1
[output]
fields = ["pressure"]
[stress]
components = ["mises", "yy"]
threshold = "500 MPa"
yield_stress = "2 GPa"
rolling = "x"
"#;

#[test]
fn a_line_contact_has_the_stress_below_a_cylinder() {
    let directory = tempfile::tempdir().unwrap();
    let reader = solved(LINE, directory.path());
    let set = reader.stress().unwrap().clone();
    let last = |name: &str| *reader.stress_series(name).unwrap().last().unwrap();
    let p0 = *reader.series("max_pressure").unwrap().last().unwrap();
    let a = 2.0 * 5e5 / (std::f64::consts::PI * p0);
    // Johnson 1985, section 4.2(c): 0.300 p0 at 0.786 a, and a range of 0.5 p0 at 0.5 a; about 52 cells to the half width.
    assert!((last("max_tresca") / p0 - 0.3003).abs() < 1e-3, "{}", last("max_tresca") / p0);
    assert!((last("max_tresca_depth") / a - 0.786).abs() < 0.03, "{}", last("max_tresca_depth") / a);
    assert!((last("orthogonal_shear") / p0 - 0.5).abs() < 2e-3, "{}", last("orthogonal_shear") / p0);
    assert!((last("max_mises_x") - 0.6e-3).abs() < 1.2e-3 / 192.0);
    assert!(reader.stress_series("max_mises_y").is_err());
    let area = set.scalars().into_iter().find(|series| series.name == "stressed_volume").unwrap();
    assert!(area.units == "m2" && last("stressed_volume") > 0.0);
    // Plane strain at the surface: s_yy = 2 nu s_zz = -2 nu p.
    let yy = reader.stress_field(StressQuantity::Yy, At::Last, 0).unwrap();
    let p = reader.field(FieldKind::Pressure, At::Last).unwrap();
    assert_eq!(yy.dim(), (192, 1));
    assert!(yy.iter().zip(&p).all(|(yy, p)| (yy + 0.6 * p).abs() < 1e-12 * p0));
    let below = Below::of(&reader).unwrap().unwrap();
    assert!(first_yield(&below).unwrap().sentence(&below).contains("no yield"));
    let found = section(&reader, &below, below.worst().unwrap()).unwrap();
    assert!(found.along_y.is_none() && found.maps.is_empty() && found.along_x.dim().0 == 192);
    let plan = StressPlan::of(&set, &reader);
    let path = directory.path().join("line.vti");
    volume(&reader, &plan, At::Last, &[StressQuantity::Mises], &path, false).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert!(String::from_utf8_lossy(&bytes[..400]).contains("WholeExtent=\"0 191 0 0 0 "));
    for format in [Format::NetCdf, Format::Hdf5, Format::Npz, Format::Csv, Format::Vtk] {
        let path = directory.path().join("line").with_extension(format.extension());
        export(&reader, format, &path, &Options { force: true, ..Options::default() }).unwrap();
    }
    let errors = read(&LINE.replace("rolling = \"x\"", "rolling = \"y\"")).unwrap_err();
    assert!(errors.errors[0].key == "stress.rolling" && errors.to_string().contains("along x"), "{errors}");
}

#[test]
fn the_stress_under_a_held_approach_does_not_depend_on_the_steps() {
    // G falls from 1 GPa to 20 MPa, B = 4 GPa: Poisson's ratio rises from 0.38 to 0.4975.
    let of = |times: &str| {
        format!(
            r#"
[domain]
cells = [24, 20]
size = ["1.2 mm", "1 mm"]
[[surface]]
kind = "sphere"
radius = "5 mm"
[[body]]
bulk_modulus = "4 GPa"
material = {{ model = "prony", modulus = "shear", instantaneous = "1 GPa", terms = [{{ fraction = 0.98, time = "3 s" }}] }}
[load]
control = "approach"
history = {{ kind = "step", value = "10 um" }}
[time]
end = "20 s"
{times}
[output]
fields = ["pressure"]
every = 1
[stress]
depths = {{ from = "50 um", to = "0.8 mm", count = 6 }}
"#
        )
    };
    let directory = tempfile::tempdir().unwrap();
    let found = |times: &str| {
        let reader = solved(&of(times), directory.path());
        (reader.field_times().to_vec(), reader.stress_series("max_mises").unwrap())
    };
    let (times, fine) = found("steps = 400");
    for steps in ["steps = 1", "steps = 7", "spacing = \"adaptive\""] {
        let (at, mises) = found(steps);
        for (t, mises) in at.iter().zip(&mises) {
            let after = times.partition_point(|time| time < t).max(1);
            let share = (t - times[after - 1]) / (times[after] - times[after - 1]);
            let expected = fine[after - 1] + share * (fine[after] - fine[after - 1]);
            // 4e-5: the chord of the reference, (0.05/3)^2/8; the rest is the tolerance of the contact solver.
            assert!((mises / expected - 1.0).abs() < 1e-4, "{steps} at {t} s: {mises} {expected}");
        }
    }
}

#[test]
fn a_constant_bulk_modulus_goes_through_all_rows() {
    let directory = tempfile::tempdir().unwrap();
    let text = CASE
        .replace("rolling = \"y\"", "body = \"resin\"")
        .replace("every = 2", "every = 1")
        .replace("end = \"2 s\"\nsteps = 8", "end = \"200 s\"\nsteps = 40");
    let reader = solved(&text, directory.path());
    let set = reader.stress().unwrap();
    let Ratio::Changing(changing) = &set.poisson else { panic!("{}", set.poisson) };
    // B = 4 GPa; G = 1 GPa at once, 2/3 GPa in the end.
    assert_eq!(set.poisson.to_string(), "0.385 at once to 0.421 in the end");
    assert_eq!(set.instants.len(), reader.len());
    // The same sum as of the pressures of all rows.
    let grid = reader.header().grid;
    let mut history = changing.history(grid).unwrap();
    let mut stress = SubsurfaceStress::new(grid, asperity::Boundary::Free, 0.0).unwrap();
    let mut six = std::array::from_fn(|_| vec![]);
    let mut mises = vec![0.0; grid.len()];
    for (index, time) in reader.field_times().iter().enumerate() {
        let pressure = reader.field(FieldKind::Pressure, At::Index(index)).unwrap();
        history.advance(*time, Control::Load, pressure.as_slice().unwrap()).unwrap();
        stress.set_history(&history).unwrap();
        stress.at(set.depths[3], &mut six).unwrap();
        StressQuantity::Mises.field_into(&six, &mut mises);
        let stored = reader.stress_field(StressQuantity::Mises, At::Index(index), 3).unwrap();
        assert_eq!(stored.as_slice().unwrap(), mises);
    }
    // Long after the load has come to rest it is that of the ratio in the end: what is left decays as exp(-t/3 s).
    let pressure = reader.field(FieldKind::Pressure, At::Last).unwrap();
    let mut settled =
        SubsurfaceStress::new(grid, asperity::Boundary::Free, changing.creep.ratio.long_time()).unwrap();
    settled.set_pressure(pressure.as_slice().unwrap()).unwrap();
    settled.at(set.depths[3], &mut six).unwrap();
    let mut expected = vec![0.0; grid.len()];
    StressQuantity::Mises.field_into(&six, &mut expected);
    let largest = expected.iter().copied().fold(0.0, f64::max);
    // 1e-6: the tolerance of the contact solver, to which the pressures of the last rows agree.
    assert!(expected.iter().zip(&mises).all(|(a, b)| (a - b).abs() < 1e-6 * largest));
    // A picture or a volume of one time reads all before it.
    let below = Below::of(&reader).unwrap().unwrap();
    let found = section(&reader, &below, below.worst().unwrap()).unwrap();
    let map = found.maps[1].1.iter().copied().fold(0.0, f64::max);
    assert!((map / found.largest - 1.0).abs() < 1e-12, "{map} {}", found.largest);
    assert_eq!(StressPlan::of(set, &reader).poisson, set.poisson);
    // Where rows are missing it is refused, also afterwards; the old stress stays.
    let without = text.split("[stress]").next().unwrap().replace("every = 1", "every = 3");
    let reader = solved(&without, directory.path());
    let plan =
        StressPlan { depths: Depths::List(vec![1e-4]), ..StressPlan::new("resin", set.poisson.clone()) };
    let mut writer = Writer::amend(reader.path()).unwrap();
    let error = evaluate(&mut writer, &plan, &AtomicBool::new(false), |_, _| ()).unwrap_err();
    assert!(error.to_string().contains("output.every = 1"), "{error}");
    let known = asperity_io::stress::bodies_of(&reader);
    assert_eq!(
        (&known[1].poisson, known[0].poisson.as_ref().unwrap().constant()),
        (&Some(set.poisson.clone()), Some(0.45))
    );
}
