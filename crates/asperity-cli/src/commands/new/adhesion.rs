//! What a case of bodies that stick has besides the others: the attraction between them, and how they are pulled off.

use std::path::Path;

use asperity::traction::AdhesionScale;
use asperity_io::case::Case;

use super::own::{Material, YOURS};
use crate::format::quantity;

/// The trap number of the case: below 0.5 the answer does not depend on the grid.
const TRAP: f64 = 0.4;

/// How the line of a fitted force curve begins that holds the work of adhesion.
const WORK: &str = "# Work of adhesion ";

/// `[adhesion]` of the case that consists of these two texts, with the shortest range that its cells resolve; with the work of adhesion that
/// `fit-indentation` wrote with the material.
pub(super) fn section(before: &str, after: &str, folder: &Path) -> String {
    let fitted =
        before.lines().find_map(|line| line.strip_prefix(WORK)?.split_once(" J/m2")?.0.parse::<f64>().ok());
    let work = match fitted {
        Some(work) => format!("work = \"{work:.3e} J/m2\"               # of the force curve"),
        None => format!(
            "work = \"50 mJ/m2\"                     {YOURS}energy that parts a unit area; 20 to 100 mJ/m2 of clean, dry surfaces"
        ),
    };
    let of = |range: f64, remark: &str| {
        format!("\n[adhesion]\n{work}\nrange = \"{}\"                       {remark}\n", quantity(range, "m"))
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
            let remark = "# the shortest that these cells resolve (trap number 0.4), for this work";
            of(digits, remark)
        }
        None => {
            of(1e-6, &format!("{YOURS}as short as the cells allow; asperity check prints the trap number"))
        }
    }
}

/// The surfaces are pressed together for a time, and pulled off in the same time. `height` is how high the roughness is.
pub(super) fn retraction(height: f64, material: &Material) -> String {
    /// Steps while they are pressed.
    const STEPS: usize = 30;
    let half = super::own::one_digit(0.5 * material.end());
    let away = quantity(-super::own::one_digit(0.5 * height), "m");
    format!(
        "\n[[load.stages]]\ncontrol = \"pressure\"                  # mean over the surface\nhistory = {{ kind = \"step\", value = \"0.1 MPa\" }}   {YOURS}pressure that \
         brings them together\nduration = \"{half} s\"                      {YOURS}how long they are pressed\nsteps = {STEPS}\nspacing = \"log\"                       # the material relaxes fast at first\nfirst = \"{} s\"\n\
         \n[[load.stages]]\ncontrol = \"approach\"\nhistory = {{ kind = \"ramp\", from = \"current\", value = \"{away}\", duration = \"{half} s\" }}   {YOURS}how fast \
         they part\nduration = \"{half} s\"\nsteps = 200\nuntil = \"contact-lost\"\n\
         \n[time]\nend = \"{} s\"\nsteps = 1\n\n[output]\nfields = [\"pressure\", \"gap\"]\nevery = 20\n",
        material.first(half, STEPS, 1e-4),
        2.0 * half
    )
}
