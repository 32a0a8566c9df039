//! Exports hold the bits of the result, as other programs read them.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{Case, bits, le_bytes, place, python, run_python};
use asperity_io::export::{ExportError, Format, Options, export};
use asperity_io::store::{At, FieldKind, Outcome, Reader, Status, StoreError, Writer};
use netcdf_reader::NcFile;
use tempfile::TempDir;

/// A result of seven steps on a grid that is no multiple of four bytes, the fields of steps 0, 2, 4, 6.
fn result(cells: [usize; 2]) -> (TempDir, PathBuf, Case) {
    let mut case = Case::new(cells, &FieldKind::ALL);
    case.header.case_text = "# \u{2264} text longer than an HDF5 attribute\n".repeat(2000);
    let (directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    case.run(&mut writer, 0, 7);
    writer.finish(&Outcome::new(Status::Complete)).unwrap();
    (directory, path, case)
}

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(directory).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn netcdf_and_hdf5_are_read_back_by_a_reader_of_both() {
    let (directory, path, case) = result([37, 11]);
    let reader = Reader::open(&path).unwrap();
    for format in [Format::NetCdf, Format::Hdf5] {
        let output = directory.path().join(format!("out.{}", format.extension()));
        let made = export(&reader, format, &output, &Options::default()).unwrap();
        assert_eq!(made, std::slice::from_ref(&output));
        let file = NcFile::open(&output).unwrap();
        let lengths = |name: &str| file.variable(name).unwrap().shape();
        assert_eq!(lengths("pressure"), [4, 37, 11]);
        assert_eq!(lengths("initial_gap"), [37, 11]);
        assert_eq!(lengths("load"), [7]);
        let dimensions: Vec<_> =
            file.variable("gap").unwrap().dimensions().iter().map(|d| d.name.clone()).collect();
        assert_eq!(dimensions, ["field_time", "x", "y"]);
        let reals = |name: &str| file.read_variable::<f64>(name).unwrap();
        for kind in [FieldKind::Pressure, FieldKind::Gap, FieldKind::Displacement] {
            let stored = reals(kind.name());
            for n in 0..4 {
                let map = reader.field(kind, At::Index(n)).unwrap();
                let read = stored.index_axis(ndarray::Axis(0), n).to_owned();
                assert_eq!(bits(&read.into_dimensionality().unwrap()), bits(&map), "{format:?} {kind} {n}");
            }
        }
        assert_eq!(bits(&reals("initial_gap").into_dimensionality().unwrap()), bits(&case.gap));
        let contact = file.read_variable_as_f64("contact").unwrap();
        assert_eq!(
            contact.index_axis(ndarray::Axis(0), 3).to_owned().into_dimensionality().unwrap(),
            reader.field(FieldKind::Contact, At::Last).unwrap()
        );
        let residual: Vec<u64> = reals("residual").iter().map(|x| x.to_bits()).collect();
        assert_eq!(residual, (0..7).map(|n| case.row(n).residual.to_bits()).collect::<Vec<_>>());
        let counts = file.read_variable_as_f64("convolutions").unwrap();
        assert_eq!(counts.as_slice().unwrap(), [1.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.0]);
        assert_eq!(
            file.read_variable_as_f64("field_step").unwrap().as_slice().unwrap(),
            [0.0, 2.0, 4.0, 6.0]
        );
        let units = file.variable("pressure").unwrap().attribute("units").unwrap().value.as_string();
        assert_eq!(units.as_deref(), Some("Pa"));
        let title = file.global_attribute("title").unwrap().value.as_string();
        assert_eq!(title.as_deref(), Some(case.header.title.as_str()));
    }
}

#[test]
fn wide_netcdf_is_not_used_without_need() {
    let (directory, path, _) = result([8, 4]);
    let output = directory.path().join("out.nc");
    export(&Reader::open(&path).unwrap(), Format::NetCdf, &output, &Options::default()).unwrap();
    assert_eq!(&fs::read(&output).unwrap()[..4], b"CDF\x02");
}

#[test]
fn csv_reads_back_to_the_same_bits() {
    let (directory, path, case) = result([5, 3]);
    let reader = Reader::open(&path).unwrap();
    let output = directory.path().join("out.csv");
    let options = Options {
        fields: Some(vec![FieldKind::Gap, FieldKind::Contact]),
        instants: Some(vec![At::Last, At::Index(3)]),
        force: false,
    };
    let made = export(&reader, Format::Csv, &output, &options).unwrap();
    let expected = ["out.csv", "out_gap_0003.csv", "out_contact_0003.csv"].map(|n| directory.path().join(n));
    assert_eq!(made, expected);

    let text = fs::read_to_string(&output).unwrap();
    let lines: Vec<Vec<&str>> =
        text.split("\r\n").filter(|l| !l.is_empty()).map(|l| l.split(',').collect()).collect();
    assert_eq!(lines.len(), 8);
    assert_eq!(&lines[0][..4], ["time [s]", "load [N]", "approach [m]", "contact_area [m2]"]);
    let column = |name: &str| lines[0].iter().position(|n| *n == name).unwrap();
    for (step, line) in lines[1..].iter().enumerate() {
        assert_eq!(line.len(), lines[0].len());
        let row = case.row(step);
        for (name, value) in
            [("time [s]", row.time()), ("approach [m]", row.approach), ("certificate", row.certificate)]
        {
            assert_eq!(line[column(name)].parse::<f64>().unwrap().to_bits(), value.to_bits(), "{name}");
        }
        assert_eq!(line[column("iterations")].parse::<usize>().unwrap(), row.iterations);
    }
    let text = fs::read_to_string(&made[1]).unwrap();
    let gap = case.gap(6);
    for (i, line) in text.lines().skip(1).enumerate() {
        let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers[0], case.header.grid.x(i));
        assert_eq!(numbers[1..], gap.row(i).to_vec());
    }
    assert!(fs::read_to_string(&made[2]).unwrap().lines().nth(1).unwrap().ends_with("0,0,0"));
}

#[test]
fn vtk_lists_each_state_at_a_time_of_its_own() {
    let mut case = Case::new([6, 5], &[FieldKind::Pressure]);
    case.header.title = "<&>".into();
    let (directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    for step in 0..7 {
        case.append(&mut writer, step, true).unwrap();
    }
    let output = directory.path().join("rough.pvd");
    export(&Reader::open(&path).unwrap(), Format::Vtk, &output, &Options::default()).unwrap();
    let text = fs::read_to_string(&output).unwrap();
    let times: Vec<f64> = text
        .split("timestep=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap().parse().unwrap())
        .collect();
    assert_eq!(times.len(), 7);
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
    // Steps 4 and 5 are the two sides of a jump.
    assert_eq!((times[4], times[5]), (case.row(5).time().next_down(), case.row(5).time()));
    let states = names(&directory.path().join("rough"));
    assert_eq!(
        (states.len(), states[0].as_str(), states[7].as_str()),
        (8, "initial_gap.vti", "state_0006.vti")
    );
    // The last value of the appended block is that of the last cell: x fastest, so the map transposed.
    let image = fs::read(directory.path().join("rough/state_0003.vti")).unwrap();
    let tail = b"\n  </AppendedData>";
    let end = image.windows(tail.len()).position(|w| w == tail).unwrap();
    let block = &image[end - 8 * 30..end];
    assert_eq!(block, le_bytes(&case.pressure(3).reversed_axes()));
}

#[test]
fn an_export_overwrites_nothing_unasked_and_leaves_nothing_half_made() {
    let (directory, path, _) = result([6, 5]);
    let reader = Reader::open(&path).unwrap();
    let forced = Options { force: true, ..Options::default() };
    for format in Format::ALL {
        let output = directory.path().join(format!("out.{}", format.extension()));
        export(&reader, format, &output, &Options::default()).unwrap();
        let again = export(&reader, format, &output, &Options::default());
        assert!(matches!(again, Err(ExportError::Exists { .. })), "{format:?}");
        export(&reader, format, &output, &forced).unwrap();
    }
    let made = ["out", "out.csv", "out.h5", "out.nc", "out.npz", "out.pvd", "result.zarr"];
    assert_eq!(names(directory.path()), made);

    // A directory of images into which something else was put.
    fs::write(directory.path().join("out/notes.txt"), "mine").unwrap();
    let error = export(&reader, Format::Vtk, &directory.path().join("out.pvd"), &forced).unwrap_err();
    assert!(error.to_string().contains("holds other files (notes.txt)"), "{error}");
    // A directory where a file should go; a directory that is not there; no name.
    for place in [path.clone(), directory.path().join("absent/out.nc"), PathBuf::from("/")] {
        let error = export(&reader, Format::NetCdf, &place, &forced).unwrap_err();
        assert!(error.to_string().contains(&place.display().to_string()), "{error}");
    }
    assert!(export(&reader, Format::Vtk, &directory.path().join("plain"), &forced).is_err());
    // A damaged result: the export fails and is not there.
    fs::write(path.join("gap/c/2/0/0"), "x").unwrap();
    for format in [Format::NetCdf, Format::Hdf5, Format::Npz, Format::Vtk] {
        let output = directory.path().join(format!("damaged.{}", format.extension()));
        let error = export(&reader, format, &output, &Options::default()).unwrap_err();
        assert!(matches!(error, ExportError::Store(StoreError::Corrupt { .. })), "{error}");
    }
    assert_eq!(names(directory.path()), made);
}

#[test]
fn what_the_result_does_not_hold_is_said_with_what_it_holds() {
    let case = Case::new([4, 3], &[FieldKind::Gap]);
    let (directory, path) = place();
    let mut writer = Writer::create(&path, &case.header, case.gap.view(), false).unwrap();
    let output = directory.path().join("out.nc");
    let error =
        export(&Reader::open(&path).unwrap(), Format::NetCdf, &output, &Options::default()).unwrap_err();
    assert!(error.to_string().ends_with("holds no steps; its run has not come to one yet"), "{error}");
    case.append(&mut writer, 0, false).unwrap();
    let reader = Reader::open(&path).unwrap();
    let options = Options { fields: Some(vec![FieldKind::Pressure]), ..Options::default() };
    let error = export(&reader, Format::NetCdf, &output, &options).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("holds no field `pressure`; it holds the fields gap; name it in output.fields"),
        "{error}"
    );
    let options = Options { instants: Some(vec![At::Time(3.0)]), ..Options::default() };
    let error = export(&reader, Format::NetCdf, &output, &options).unwrap_err();
    assert!(error.to_string().ends_with("holds no fields at 3 s; no field is stored yet"), "{error}");
    // A run that has kept no fields yet exports as what it is.
    for format in Format::ALL {
        let output = directory.path().join(format!("empty.{}", format.extension()));
        export(&reader, format, &output, &Options::default()).unwrap();
    }
    let file = NcFile::open(directory.path().join("empty.nc")).unwrap();
    assert_eq!(file.variable("gap").unwrap().shape(), [0, 4, 3]);
    drop(writer);
}

#[test]
fn other_programs_read_the_bits() {
    let Some(python) = python("numpy, xarray, h5py, netCDF4, h5netcdf, scipy") else { return };
    let (directory, path, case) = result([37, 11]);
    let reader = Reader::open(&path).unwrap();
    for format in Format::ALL {
        let output = directory.path().join(format!("out.{}", format.extension()));
        export(&reader, format, &output, &Options::default()).unwrap();
    }
    let empty = directory.path().join("empty.zarr");
    let mut writer = Writer::create(&empty, &case.header, case.gap.view(), false).unwrap();
    case.append(&mut writer, 0, false).unwrap();
    for format in [Format::NetCdf, Format::Hdf5, Format::Npz] {
        let output = directory.path().join(format!("empty.{}", format.extension()));
        export(&Reader::open(&empty).unwrap(), format, &output, &Options::default()).unwrap();
    }
    let dump = |name: &str, bytes: Vec<u8>| fs::write(directory.path().join(name), bytes).unwrap();
    dump("initial_gap", le_bytes(&case.gap));
    dump("case", case.header.case_text.clone().into_bytes());
    dump("time", (0..7).flat_map(|step| case.row(step).time().to_le_bytes()).collect());
    dump("residual", (0..7).flat_map(|step| case.row(step).residual.to_le_bytes()).collect());
    let steps = [0, 2, 4, 6];
    dump("pressure", steps.iter().flat_map(|step| le_bytes(&case.pressure(*step))).collect());
    dump("contact", steps.iter().flat_map(|step| case.contact(*step).into_raw_vec_and_offset().0).collect());
    run_python(&python, "test_export.py", &[("ASPERITY_EXPORTS", directory.path().as_os_str())]);
}
