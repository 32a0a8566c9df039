//! Persson's theory beside the friction of a sweep.

use asperity_report::page::{Options, page};

use crate::browser::{SWEEP, solved};

#[test]
fn the_curve_of_perssons_theory_says_that_it_leaves_out_the_hardness() {
    // The spots carry about 1 MPa and more: the hardness of 1 MPa limits their pressure, and the theory knows none.
    let capped = SWEEP.replace("poisson = 0.5", "poisson = 0.5\nhardness = \"1 MPa\"");
    assert_ne!(capped, SWEEP);
    for (case, says) in [(SWEEP, false), (&capped, true)] {
        let directory = tempfile::tempdir().unwrap();
        let reader = solved(case, directory.path());
        let reached = reader.series("capped_area").unwrap().iter().any(|area| *area > 0.0);
        assert_eq!(reached, says);
        let html = page(&reader, &Options::default()).unwrap();
        assert!(html.contains("Persson's theory"));
        assert_eq!(html.contains("without the hardness"), says);
    }
}
