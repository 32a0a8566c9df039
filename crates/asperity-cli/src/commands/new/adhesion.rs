//! What a case of bodies that stick has besides the others: the attraction between them, and how they are pulled off.

use std::path::Path;

use asperity::traction::AdhesionScale;
use asperity_io::case::Case;

use super::own::{YOURS, plain};

/// The trap number of the case: below 0.5 the answer does not depend on the grid.
const TRAP: f64 = 0.4;

/// `[adhesion]` of the case that consists of these two texts, with the shortest range that its cells resolve.
pub(super) fn section(before: &str, after: &str, folder: &Path) -> String {
    let of = |range: f64, remark: &str| {
        format!(
            "\n[adhesion]\nwork = \"50 mJ/m2\"                     {YOURS}energy that parts a unit area; 20 to 100 mJ/m2 of clean, dry surfaces\n\
             range = \"{}\"                    {remark}\n",
            plain(range, "m")
        )
    };
    let trap = |range: f64| {
        let case = Case::parse(&[before, &of(range, ""), after].concat(), folder, &[]).ok()?;
        Some(AdhesionScale::of(&case.simulation().ok()?).ok()??.trap).filter(|trap| trap.is_finite())
    };
    // Of the exponential law it falls with the square of the range.
    match trap(1.0) {
        Some(trap) => {
            let range = (trap / TRAP).sqrt();
            let digits = format!("{range:.1e}").parse().unwrap_or(range);
            let remark = "# the shortest one that these cells resolve (trap number 0.4): a wider range changes little while it is small \
                          against the contact";
            of(digits, remark)
        }
        None => {
            of(1e-6, &format!("{YOURS}as short as the cells allow; asperity check prints the trap number"))
        }
    }
}

/// The surfaces are pressed together for a time, and pulled off in the same time. `height` is how high the roughness is, `end` how long the
/// material is known.
pub(super) fn retraction(height: f64, end: f64) -> String {
    let half = super::own::one_digit(0.5 * end);
    let away = plain(-super::own::one_digit(0.1 * height), "m");
    format!(
        "\n[[load.stages]]\ncontrol = \"pressure\"                  # mean over the surface\nhistory = {{ kind = \"step\", value = \"0.1 MPa\" }}   {YOURS}pressure that \
         brings them together\nduration = \"{half} s\"                      {YOURS}how long they are pressed\nsteps = 20\n\
         \n[[load.stages]]\ncontrol = \"approach\"\nhistory = {{ kind = \"ramp\", from = \"current\", value = \"{away}\", duration = \"{half} s\" }}   {YOURS}how fast \
         they part\nduration = \"{half} s\"\nsteps = 100\nuntil = \"contact-lost\"\n\
         \n[time]\nend = \"{} s\"\nsteps = 1\n\n[output]\nfields = [\"pressure\", \"gap\"]\nevery = 20\n",
        2.0 * half
    )
}
