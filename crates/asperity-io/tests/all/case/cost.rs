//! What `check` expects of a run: its convolutions, its rows and its memory.

use std::path::Path;

use asperity::drive;
use asperity_io::case::{Case, CostEstimate};

/// A case of 192 x 192 cells, or a line of 1024: several times as fine as the grid of its estimate.
fn case(domain: &str, surface: &str, load: &str, more: &str) -> Case {
    let text = format!(
        "{domain}\n{surface}\n[[body]]\nname = \"rubber\"\npoisson = 0.5\nmaterial = {{ model = \"prony\", modulus = \
         \"shear\", instantaneous = \"10 MPa\", terms = [{{ fraction = 0.4, time = \"0.1 s\" }}, {{ fraction = 0.4, time \
         = \"10 s\" }}] }}\n{load}\n{more}\n"
    );
    Case::parse(&text, Path::new("."), &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

const FREE: &str = "[domain]\ncells = [192, 192]\nsize = [\"2 mm\", \"2 mm\"]";
const PERIODIC: &str = "[domain]\ncells = [192, 192]\nsize = [\"1 mm\", \"1 mm\"]\nboundary = \"periodic\"";
const SPHERE: &str = "[[surface]]\nkind = \"sphere\"\nradius = \"10 mm\"";
const ROUGH: &str = "[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_gradient = 0.1\nlongest = \"0.5 mm\"\n\
                     roll_off = \"0.25 mm\"\nshortest = \"25 um\"\nseed = 1";
const UNTIL: &str = "[time]\nend = \"20 s\"\nsteps = 20";

/// Rows and convolutions of the run itself.
fn solved(case: &Case) -> CostEstimate {
    let parts = case.parts().unwrap();
    let simulation = case.simulation_of(&parts).unwrap();
    let steady = case.steady_of(&parts, &simulation).unwrap();
    let mut drive = drive::of(simulation, steady).unwrap();
    let mut found = CostEstimate { rows: 0, convolutions: 0, flows: 0 };
    while let Some(step) = drive.advance().unwrap() {
        found.convolutions += step.row().convolutions;
        found.rows += 1;
    }
    found
}

/// Convolutions within a factor of two, and rows: exactly where they are planned.
fn expected(name: &str, case: &Case) {
    let (expected, solved) = (case.cost().expect(name), solved(case));
    let ratio = expected.convolutions as f64 / solved.convolutions as f64;
    assert!((0.5..=2.0).contains(&ratio), "{name}: expected {expected:?}, solved {solved:?}");
    match case.describe().rows {
        Some(rows) => assert_eq!((expected.rows, solved.rows), (rows, rows), "{name}"),
        None => {
            let ratio = expected.rows as f64 / solved.rows as f64;
            assert!((0.5..=2.0).contains(&ratio), "{name}: expected {expected:?}, solved {solved:?}");
        }
    }
}

#[test]
fn smooth_and_rough_contacts_take_the_convolutions_that_were_expected() {
    let step = "[load]\ncontrol = \"load\"\nhistory = { kind = \"step\", value = \"0.2 N\" }";
    expected("creep", &case(FREE, SPHERE, step, UNTIL));
    let pressed = "[load]\ncontrol = \"pressure\"\nhistory = { kind = \"step\", value = \"100 kPa\" }";
    expected("rough", &case(PERIODIC, ROUGH, pressed, UNTIL));
    expected("rough ball", &case(FREE, &format!("{SPHERE}\n{ROUGH}"), step, UNTIL));
    expected(
        "quantities",
        &case(PERIODIC, ROUGH, pressed, &format!("{UNTIL}\n[output]\nquantities = [\"all\"]")),
    );
}

#[test]
fn iterations_without_a_preconditioner_grow_with_the_grid() {
    let method = "[time]\nend = \"20 s\"\nsteps = 3\n[solver]\nmethod = \"polonsky-keer\"";
    let step = "[load]\ncontrol = \"load\"\nhistory = { kind = \"step\", value = \"0.2 N\" }";
    expected("Polonsky-Keer, sphere", &case(FREE, SPHERE, step, method));
    let pressed = "[load]\ncontrol = \"pressure\"\nhistory = { kind = \"step\", value = \"100 kPa\" }";
    expected("Polonsky-Keer, rough", &case(PERIODIC, ROUGH, pressed, method));
}

#[test]
fn staged_adaptive_and_cyclic_runs_take_the_rows_and_convolutions_that_were_expected() {
    let sine = "[load]\ncontrol = \"load\"\nhistory = { kind = \"sine\", mean = \"0.2 N\", amplitude = \"0.15 N\", \
                frequency = \"0.1 Hz\" }";
    expected("cyclic", &case(FREE, SPHERE, sine, "[time]\nend = \"20 s\"\nsteps = 40"));
    let held = "[load]\ncontrol = \"approach\"\nhistory = { kind = \"step\", value = \"10 um\" }";
    expected("held approach", &case(FREE, SPHERE, held, UNTIL));
    let step = "[load]\ncontrol = \"load\"\nhistory = { kind = \"step\", value = \"0.2 N\" }";
    let adaptive = "[time]\nend = \"20 s\"\nspacing = \"adaptive\"\ntolerance = 1e-3";
    expected("adaptive", &case(FREE, SPHERE, step, adaptive));
}

#[test]
fn a_sweep_over_velocities_takes_the_convolutions_that_were_expected() {
    let load = "[load]\ncontrol = \"pressure\"\nhistory = { kind = \"step\", value = \"100 kPa\" }";
    let sweep = "[motion]\ndirection = \"x\"\nover = \"rubber\"\n[motion.steady]\nvelocities = { from = \"10 um/s\", \
                 to = \"10 mm/s\", count = 7, spacing = \"log\" }";
    expected("sweep", &case(PERIODIC, ROUGH, load, sweep));
}

/// The memory that is told is what the parts of a run say of themselves: fields, spectra, history.
#[test]
fn memory_grows_by_what_a_case_asks_for() {
    let step = "[load]\ncontrol = \"load\"\nhistory = { kind = \"step\", value = \"0.2 N\" }";
    let of = |domain: &str, more: &str| case(domain, SPHERE, step, more).describe().memory_bytes as f64;
    let large = FREE.replace("192", "2048");
    let cells = 2048.0 * 2048.0;
    let plain = of(&large, UNTIL);
    // 26 bytes of the convolution, 7 to 17 of the preconditioner, 20 of the solver, 48 of two rows and two gaps, 32 of the material, 8
    // of the gap that is stored, and the program itself.
    let each = (plain - 40.0 * 1048576.0) / cells;
    let others = 26.0 + 20.0 + 48.0 + 32.0 + 8.0;
    assert!((others + 7.0..=others + 17.0).contains(&each), "{each}");
    let fields = of(&large, &format!("{UNTIL}\n[output]\nfields = []"));
    assert_eq!(plain - fields, 8.0 * cells, "the gap is not copied to be stored");
    let direct = of(&large, &format!("{UNTIL}\nscheme = \"direct\""));
    // 21 rows are kept in place of two terms, their sum and the third state of the error.
    assert_eq!(direct - plain, 8.0 * (21.0 - 4.0) * cells);
    let all = of(&large, &format!("{UNTIL}\n[output]\nquantities = [\"all\"]"));
    assert!(all > plain + 33.0 * cells, "the stiffness and the spots need fields of their own");
}
