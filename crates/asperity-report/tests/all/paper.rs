//! The figures of the paper agree with what is independent of them, on coarse grids.

use asperity_report::paper::{FIGURES, Options, Reproduction, reproduce};

fn differences(cells: usize) -> Vec<Reproduction> {
    let directory = tempfile::tempdir().unwrap();
    let options = Options { results: directory.path().to_owned(), cells: Some(cells) };
    reproduce(&FIGURES, &options).unwrap()
}

#[test]
fn every_figure_is_as_near_to_its_independent_curve_as_its_cells_allow() {
    let done = differences(96);
    assert_eq!(done.iter().map(|one| one.number).collect::<Vec<_>>(), FIGURES);
    let value =
        |number: u8, n: usize| done.iter().find(|one| one.number == number).unwrap().differences[n].value;
    // At the border the pressure falls as sqrt(2 x / a), and the border of the cells may lie half a cell off: at a
    // distance of a cell and a half this changes the pressure by sqrt(2 dx / a) (sqrt(2) - sqrt(1.5)).
    let shift = |dx: f64, a: f64| (2.0 * dx / a).sqrt() * (2f64.sqrt() - 1.5f64.sqrt());
    assert!(value(1, 0) < shift(2e-3 / 96.0, 4.5e-4), "{}", value(1, 0));
    assert!(value(2, 0) < shift(1.2e-4 / 96.0, 4.0e-5), "{}", value(2, 0));
    // Steps of 0.2 s against times of 8.93 s, of second order: (0.2 / 8.93)^2 / 12 of a change by a quarter.
    assert!(value(3, 0) < 1e-5, "{}", value(3, 0));
    // The depth is of second order in cell over radius: (4.2 um / 0.11 mm)^2 / 4.
    assert!(value(4, 0) < 1e-3, "{}", value(4, 0));
    // The amplitudes are scaled to it: rounding.
    assert!(value(5, 0) < 1e-12, "{}", value(5, 0));
    // Both methods stop at a residual of 1e-6: a cell on the verge of contact may differ.
    assert!(value(6, 0) < 2e-3 && value(7, 0) < 2e-3);
    for n in 0..4 {
        assert!(value(8, n) < 2e-3, "{n}: {}", value(8, n));
    }
}

#[test]
fn a_figure_can_be_computed_alone() {
    let directory = tempfile::tempdir().unwrap();
    let options = Options { results: directory.path().to_owned(), cells: Some(32) };
    let done = reproduce(&[5], &options).unwrap();
    assert_eq!(done.len(), 1);
    let svg = done[0].figure.to_svg();
    assert!(svg.contains("Figure 5: undeformed gap") && svg.contains("rms gradient"));
}
