//! Records of indentations: load and depth over time, and the material found from one as a block of a case file.
//!
//! ```
//! use asperity_files::curve::{Columns, Indentation};
//! let text = "t [s]; P [mN]; h [um]\n0; 0; 0\n1,5; 2,25; 10\n";
//! let record = Indentation::parse("test.csv".as_ref(), text.as_bytes(), &Columns::default())?;
//! assert!(record.times[1] == 1.5 && (record.loads[1] - 2.25e-3).abs() < 1e-15);
//! # Ok::<(), asperity_files::curve::CurveError>(())
//! ```

use std::fmt::Write;
use std::path::{Path, PathBuf};

use asperity::indentation::{IndentationFit, Interval, PowerLawFit, SampleLayer};
use asperity::material::Modulus;
use asperity::reference::MdrProfile;

use super::block::{PRONY, file_name};
use super::bytes;
use super::columns::{self, Columns, Form};
use super::error::{CurveError, fault};
use super::role::Role;
use super::workbook::sheets;
use crate::choice;

/// The columns of a record.
const FORM: Form = Form {
    name: "indentation",
    needed: &[Role::Time, Role::Load, Role::Depth],
    pairs: &[],
    optional: &[],
    t: Role::Time,
};

/// A record of an indentation, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Indentation {
    /// The file.
    pub path: PathBuf,
    /// Times \[s\].
    pub times: Vec<f64>,
    /// Loads \[N\].
    pub loads: Vec<f64>,
    /// Depths \[m\].
    pub depths: Vec<f64>,
    /// What was assumed about the file.
    pub notes: Vec<String>,
}

impl Indentation {
    /// Reads a text table with columns of time, load and depth, as [`Curves::read`](super::Curves::read) does.
    ///
    /// # Errors
    /// [`CurveError`] with the line: no table, a column that is not there, a cell that is no number, a unit of another
    /// quantity.
    pub fn read(path: &Path, columns: &Columns) -> Result<Indentation, CurveError> {
        Indentation::parse(path, &bytes(path)?, columns)
    }

    /// From the bytes of a text table that is called `path` in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(path: &Path, bytes: &[u8], columns: &Columns) -> Result<Indentation, CurveError> {
        let parsed = sheets(bytes, columns.sheet.as_deref()).and_then(|sheets| {
            // The first sheet that holds such columns, or what is wrong with the first.
            let mut read = sheets.into_iter().map(|sheet| columns::values(&sheet.table?, FORM, columns));
            let first = read.next().unwrap_or_else(|| Err(fault("the file holds no table")));
            first.or_else(|fault| read.find_map(Result::ok).ok_or(fault))
        });
        let columns::Read { values, lines, notes, .. } = parsed.map_err(|fault| fault.of(path))?;
        let of = |role: Role| values.get(&role).cloned().unwrap_or_default();
        let [times, loads, depths] = [Role::Time, Role::Load, Role::Depth].map(of);
        if let Some(n) = times.windows(2).position(|pair| pair[1] < pair[0]) {
            let (before, here) = (times[n], times[n + 1]);
            return Err(fault(format!(
                "the time goes back from {before:e} s to {here:e} s: a record needs times that go on through all its segments, in one column"
            ))
            .at(lines[n + 1])
            .of(path));
        }
        Ok(Indentation { path: path.to_owned(), times, loads, depths, notes })
    }
}

/// How the moduli of a material are to be given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialOf {
    /// Young's or shear modulus.
    pub modulus: Modulus,
    /// Poisson's ratio, constant in time.
    pub poisson: f64,
}

impl MaterialOf {
    /// Modulus over contact modulus: E = (1 - ν²) E*, G = (1 - ν) E*/2.
    pub fn factor(self) -> f64 {
        match self.modulus {
            Modulus::Young => 1.0 - self.poisson * self.poisson,
            Modulus::Shear => 0.5 * (1.0 - self.poisson),
        }
    }

    /// The modulus and its interval that belong to a contact modulus.
    pub fn of(self, contact: Interval) -> Interval {
        let factor = self.factor();
        Interval {
            value: factor * contact.value,
            low: factor * contact.low,
            high: factor * contact.high,
            determined: contact.determined,
        }
    }
}

/// The indenter and the sample of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndentationTest {
    /// The indenter.
    pub profile: MdrProfile,
    /// The thin sample, if it is not as deep as a half-space.
    pub layer: Option<SampleLayer>,
    /// The largest depth \[m\].
    pub deepest: f64,
}

impl IndentationTest {
    /// The test in remarks, with the keys of a case, and the key `thickness` of a thin sample.
    fn written(&self) -> String {
        let indenter = match self.profile {
            MdrProfile::Sphere { radius } | MdrProfile::Paraboloid { radius } => {
                format!("kind = \"sphere\", radius = \"{radius:e} m\"")
            }
            profile => format!("kind = \"cone\", slope = {:?}", profile.cone().unwrap_or(1.0)),
        };
        let mut text = format!("# Indenter of the test, as [[surface]]: {indenter}.\n");
        match self.profile {
            MdrProfile::Sphere { .. } => {
                let percent = 100.0 * self.profile.paraboloid_excess(self.deepest).unwrap_or_default();
                if percent > 0.1 {
                    let _ = writeln!(
                        text,
                        "# The sphere of a case is the paraboloid r^2/(2 R): at the largest depth of this test it carries {percent:.1} % more load \
                         than the ball that was fitted."
                    );
                }
            }
            MdrProfile::Pyramid { .. } => {
                text += "# The indenter was a pyramid; this is the cone with its load at every depth.\n";
            }
            MdrProfile::Paraboloid { .. } | MdrProfile::Cone { .. } => {}
        }
        match &self.layer {
            None => {
                text += "# The sample was taken as much thicker than the contact is wide: a half-space.\n"
            }
            Some(SampleLayer { thickness, interface, .. }) => {
                let interface = choice::word(interface);
                let _ = write!(
                    text,
                    "# The sample was a layer on a rigid base, interface = \"{interface}\". A case solves the body below as a half-space. For \
                     the sample\n# of the test write base = \"rigid\" under [[body]], and the lines below with interface = \"{interface}\" \
                     under [[body.layer]].\nthickness = \"{thickness:e} m\"\n"
                );
            }
        }
        text
    }
}

/// Where a fit comes from.
fn head(record: &Indentation, rows: usize, misfit: f64, [step, length]: [f64; 2]) -> String {
    format!(
        "# From the indentation {}: {rows} rows, misfit {:.2} % rms of the largest value; steps from {step:.3e} s, {length:.3e} s in \
         all.\n# Behind each line: 95 % intervals.\n",
        file_name(&record.path),
        100.0 * misfit,
    )
}

/// An interval behind a line.
fn interval(x: Interval, unit: &str) -> String {
    let open = if x.determined { "" } else { "not determined by this record, " };
    format!("{open}{:.3e} to {:.3e} {unit}", x.low, x.high)
}

/// The same of a power law: a springpot, whose relaxation modulus is modulus (t/time)^-order/Γ(1 - order), known over the times of the record.
pub fn power_law_block(
    record: &Indentation,
    test: &IndentationTest,
    fit: &PowerLawFit,
    of: MaterialOf,
) -> String {
    let modulus = of.of(fit.modulus);
    let [step, length] = fit.window;
    head(record, fit.rows.len(), fit.relative_rms, fit.window)
        + &test.written()
        + &format!(
            "# {} relaxation modulus 1 s after a step {:e} Pa, {}; exponent {}. Known from {step:e} s to {length:e} s.\n",
            if of.modulus == Modulus::Young { "Young's" } else { "Shear" },
            modulus.value,
            interval(modulus, "Pa"),
            interval(fit.exponent, "").trim_end(),
        )
        + &format!(
            "poisson = {:?}\nmaterial = {{ model = \"springpot\", {} = \"{:e} Pa\", time = \"1 s\", order = {:?} }}\n",
            of.poisson,
            choice::word(&of.modulus),
            modulus.value * libm::tgamma(1.0 - fit.exponent.value),
            fit.exponent.value,
        )
}

/// `poisson = ...` and `material = { ... }` in full precision, to stand under a `[[body]]` of a case file, with intervals
/// behind the terms; the test in remarks, and `thickness = ...` where the sample was thin.
pub fn indentation_block(
    record: &Indentation,
    test: &IndentationTest,
    fit: &IndentationFit,
    of: MaterialOf,
) -> String {
    let mut text = head(record, fit.rows.len(), fit.relative_rms, fit.window);
    let measure = choice::word(&of.modulus);
    let equilibrium = of.of(fit.equilibrium);
    text += &test.written();
    let _ = writeln!(text, "poisson = {:?}", of.poisson);
    if fit.terms.is_empty() {
        let known = interval(equilibrium, "Pa");
        let _ = writeln!(
            text,
            "material = {{ model = \"elastic\", {measure} = \"{:e} Pa\" }}  # {known}",
            equilibrium.value
        );
        return text;
    }
    let known = format!("  # equilibrium {}", interval(equilibrium, "Pa"));
    let terms = fit.terms.iter().map(|[modulus, time]| {
        let modulus = of.of(*modulus);
        let remark = format!("  # {}, {}", interval(modulus, "Pa"), interval(*time, "s"));
        ([modulus.value, time.value], remark)
    });
    text + &PRONY.written(measure, equilibrium.value, &known, terms) + " }\n"
}
