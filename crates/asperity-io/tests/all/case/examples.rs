//! The starter cases and the examples of the repository.

use asperity::Drive;
use std::path::{Path, PathBuf};

use asperity::{Boundary, March};
use asperity_examples::{TEMPLATES, Template};
use asperity_io::case::{Case, Rows};
use asperity_io::store::FieldKind;

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples")
}

#[test]
fn every_starter_case_is_read_and_described() {
    assert!(TEMPLATES.len() >= 8);
    for template in TEMPLATES {
        assert!(template.text.starts_with("#:schema case.schema.json\n"), "{}", template.name);
        assert!(template.text.lines().filter(|line| line.contains('#')).count() >= 5, "{}", template.name);
        assert!(template.text.lines().all(|line| line.len() <= 120), "{}", template.name);
        let case = Case::parse(template.text, Path::new("."), &[]).unwrap();
        assert_eq!(case.title.as_deref(), Some(template.title()));
        let description = case.describe();
        assert!(
            description.usual_rows > 10 && description.stored_rows.is_some_and(|rows| rows >= 2),
            "{description:?}"
        );
        assert!(description.memory_bytes < 1 << 30, "{description:?}");
    }
    assert!(Template::find("hertz").is_some() && Template::find("nothing").is_none());
}

#[test]
fn every_starter_case_is_solved_on_a_coarse_grid() {
    for template in TEMPLATES {
        let line = template.text.contains("kind = \"cylinder\"");
        if template.text.contains("[motion.steady]") {
            continue; // no march; the command runs them
        }
        let cells = if line { "[64]" } else { "[64,64]" };
        let mut overrides = vec![format!("domain.cells={cells}")];
        // Those of running-in are resolved as they are.
        if template.text.contains("shortest") && template.name != "running-in" {
            overrides.push("surface.0.shortest=1e-4".to_owned());
        }
        if template.name == "rough-pmma" {
            // 64 cells resolve waves of 3.1 um
            overrides[1] = "surface.1.shortest=4 um".to_owned();
        }
        let case = Case::parse(template.text, Path::new("."), &overrides)
            .unwrap_or_else(|errors| panic!("{errors}"));
        let simulation = case.simulation().unwrap_or_else(|errors| panic!("{errors}"));
        assert_eq!(simulation.gap.dim(), (64, if line { 1 } else { 64 }));
        let mut march = March::new(simulation).unwrap();
        assert_eq!(march.rows_expected(), case.describe().rows, "{}", template.name);
        let mut largest: f64 = 0.0;
        while let Some(step) = march.advance().unwrap_or_else(|error| panic!("{}: {error}", template.name)) {
            let row = step.row();
            let usual = case.conditions.solver.tolerance;
            let tolerance = case.conditions.traction.as_ref().map_or(usual, |law| law.tolerances(usual)[0]);
            assert!(row.max_pressure <= case.conditions.hardness && row.residual <= tolerance);
            largest = largest.max(row.contact_fraction);
        }
        assert!(march.finished());
        if let Some(rows) = march.rows_expected() {
            assert_eq!(march.done(), rows, "{}", template.name);
        }
        // A contact that can be seen, and that stays away from the edges of a free domain (a disc that touches
        // them covers pi/4); rough-pmma fills the patch up to its corners, as in the paper.
        let whole = template.name == "rough-pmma" || case.conditions.boundary == Boundary::Periodic;
        let most = if whole { 0.9 } else { 0.5 };
        assert!(largest > 0.001 && largest < most, "{}: {largest}", template.name);
    }
}

#[test]
fn every_example_is_read() {
    for entry in std::fs::read_dir(examples()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            Case::read(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"));
        }
    }
}

#[test]
fn the_case_of_the_paper_is_the_paper_s() {
    let case = Case::parse(Template::find("rough-pmma").unwrap().text, Path::new("."), &[]).unwrap();
    assert_eq!(case.conditions.grid.cells(), [1024, 1024]);
    assert_eq!(case.conditions.grid.size(), [0.1e-3, 0.1e-3]);
    assert_eq!(case.conditions.hardness, 300e6);
    assert_eq!(super::values::history_of(&case).after(0.0), 0.5);
    // C(0) = (1 - 0.38^2) / 2491.44 MPa (theory: E(0) of eq. 23), exact up to the root finding
    let modulus = 1.0 / case.conditions.creep.instantaneous;
    assert!((modulus * (1.0 - 0.38 * 0.38) / 2491.4388e6 - 1.0).abs() < 1e-12, "{modulus}");
    let times: Vec<f64> = case.conditions.creep.terms.iter().map(|term| term.retardation_time).collect();
    // docs/theory.md, section 4: ten digits
    assert!((times[0] / 9.936295903 - 1.0).abs() < 1e-9 && (times[1] / 133.8704875 - 1.0).abs() < 1e-9);
    let description = case.describe();
    assert_eq!((description.rows, description.stored_rows), (Some(101), Some(11)));
    // A run took 212 MB at its peak.
    assert!((description.memory_bytes as f64 / 212e6 - 1.0).abs() < 0.1, "{}", description.memory_bytes);
    assert_eq!(case.output.path, Path::new("rough_pmma.zarr"));
    assert_eq!(case.output.fields.iter().copied().collect::<Vec<_>>(), [FieldKind::Pressure, FieldKind::Gap]);
    assert_eq!(case.output.rows, Rows::Every(10));
    assert!(case.output.checkpoint);
}

#[test]
fn the_rubber_that_warms_up_is_solved_on_a_coarse_grid() {
    let case = Case::read(
        &examples().join("rubber-dma.toml"),
        &["domain.cells=[48, 48]".into(), "time.steps=22".into()],
    )
    .unwrap_or_else(|errors| panic!("{errors}"));
    let description = case.describe();
    let report = &description.materials[0];
    // Eight sweeps of 13 points with 2 % of scatter, met to the scatter.
    assert_eq!((report.temperatures.len(), report.points), (8, Some(104)));
    assert!(report.rms_misfit.unwrap() < 0.025 && report.max_misfit.unwrap() < 0.1, "{report:?}");
    assert!(description.warnings.is_empty(), "{:?}", description.warnings);
    let mut march = March::new(case.simulation().unwrap()).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
    }
    // The load is held from 20 s on: the approach grows from that of leather to that of rubber. The law behind the
    // data, 30 s at 20 °C: G = 0.7 MPa and what the fractional element still bears.
    let at = |t: f64| rows.iter().find(|row| row.time() == t).unwrap().approach;
    let growth = at(110.0) / at(20.0);
    let law = asperity::material::Fractional::Zener {
        equilibrium: 0.7e6,
        instantaneous: 700e6,
        time: 2e-7,
        order: 0.55,
    };
    let shift = asperity::material::Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
    let cold = shift.factor(258.15).unwrap();
    // Approach ~ C^(2/3). At 20 s, after the ramp, C lies between that of 10 s and that of 20 s.
    let wanted = |t: f64| (law.creep(35.0) / law.creep(t / cold)).powf(2.0 / 3.0);
    assert!(
        growth > 0.93 * wanted(20.0) && growth < 1.07 * wanted(6.0),
        "{growth} {} {}",
        wanted(20.0),
        wanted(6.0)
    );
}
