//! What `asperity check` says of a case: what was read, what is to be expected, and what may be off.

use asperity::contact::Prescribed;
use asperity::finding::{
    Contact, Diagnostics, Expected, Finding, Known, LeakDiagnostics, LeakState, thin_body,
};
use asperity::material::Modulus;
use asperity::sliding::Streaming;
use asperity::surface::statistics::{HeightStatistics, SlopeStatistics};
use asperity::surface::{Part, Punch, Shape, Surface};
use asperity::traction::AdhesionScale;
use asperity::{Boundary, Simulation};
use serde::Serialize;

use super::{Case, CaseErrors, Description};

/// A case, looked at without being solved.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Examination {
    /// What will be solved, and what it takes.
    #[serde(flatten)]
    pub description: Description,
    /// The inputs that a slip would hide in.
    pub inputs: Inputs,
    /// What was found.
    pub findings: Vec<Finding>,
}

/// Inputs in SI, and the contact that they lead one to expect.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Inputs {
    /// The parts of the gap.
    pub surfaces: Vec<SurfaceInput>,
    /// The moduli of the bodies.
    pub moduli: Vec<ModulusInput>,
    /// Largest load \[N, on a line N/m\], where a load or a pressure is prescribed.
    pub largest_load: Option<f64>,
    /// The same over the domain \[Pa\].
    pub largest_mean_pressure: Option<f64>,
    /// Largest approach \[m\], where that is prescribed.
    pub largest_approach: Option<f64>,
    /// Expected radius of a round contact, half the width of a line contact, right after the load and at the end \[m\].
    pub expected_contact_radius: Option<[f64; 2]>,
    /// Expected share of the domain in contact right after the load and at the end.
    pub expected_contact_share: Option<[f64; 2]>,
    /// Expected cells across a round contact at the end.
    pub expected_cells_across: Option<f64>,
    /// Expected pressure over contact modulus at the end: the largest of a round contact, the mean of a rough one.
    pub expected_pressure_over_modulus: Option<f64>,
    /// The numbers of an adhesive contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub adhesion: Option<AdhesionScale>,
}

/// A part of the gap.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SurfaceInput {
    /// "sphere", a file's path, ...
    pub name: String,
    /// Radii along x and y \[m\], of spheres, ellipsoids, cylinders and round punches; null where infinite. Of a punch on a line
    /// the first is half its width.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<[f64; 2]>,
    /// Slope of a cone or wedge.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope: Option<f64>,
    /// Sq: rms height about the mean \[m\], of rough surfaces and waves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sq: Option<f64>,
    /// Sdq: rms slope, of rough surfaces and waves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sdq: Option<f64>,
}

/// The modulus of a body at once and relaxed \[Pa\].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModulusInput {
    /// Name of the body.
    pub body: String,
    /// "young" or "shear".
    pub modulus: &'static str,
    /// At once; absent for a body that does not yield at once.
    pub instantaneous: Option<f64>,
    /// After all relaxation; 0 for a fluid.
    pub relaxed: f64,
}

impl Case {
    /// Reads and builds all that a run would, without solving, and says what is found.
    ///
    /// # Errors
    /// As [`simulation`](Self::simulation).
    pub fn examine(&self) -> Result<Examination, CaseErrors> {
        let parts = self.parts()?;
        let simulation = self.simulation_of(&parts)?;
        let steady = self.steady_of(&parts, &simulation)?;
        let diagnostics = Diagnostics::new(
            &simulation,
            Known {
                parts: &parts,
                bodies: &self.bodies,
                thickness: self.thickness,
                mirrored: self.is_mirrored(),
            },
        );
        let expected = match &steady {
            None => Expected::of(&simulation, &parts),
            Some(motion) => Streaming::new(&simulation).ok().and_then(|streaming| {
                Expected::of_sweep(&simulation, &parts, &streaming, &motion.velocities)
            }),
        };
        let of_case = self.findings.iter().chain(diagnostics.known()).cloned();
        let to_come = expected.iter().flat_map(|expected| expected.findings(&simulation));
        let findings = of_case.chain(to_come).chain(self.thin(expected.as_ref()));
        let findings = findings.chain(self.uncoupled(&simulation, expected.as_ref())).collect();
        Ok(Examination {
            inputs: self.inputs(&simulation, &parts, expected),
            findings,
            description: self.describe(),
        })
    }

    /// Whether the expected contact is too wide for a body on a free domain.
    fn thin(&self, expected: Option<&Expected>) -> Option<Finding> {
        match (expected?.contact?, self.conditions.boundary) {
            (Contact::Round([_, radius]), Boundary::Free) => {
                thin_body("The expected contact", radius, self.thickness?)
            }
            _ => None,
        }
    }

    /// Whether a fluid that is left out would push the surfaces apart under the largest load. `asperity seal` takes it into account.
    fn uncoupled(&self, simulation: &Simulation, expected: Option<&Expected>) -> Vec<Finding> {
        let mut diagnostics = LeakDiagnostics::default();
        if let (Some(leak), Some(Prescribed::Load(load)), None) =
            (&self.leakage, expected.map(|expected| expected.largest), &self.seal)
        {
            diagnostics.see(&LeakState {
                row: None,
                constriction: None,
                gap_error: 0.0,
                closed: 0,
                pressure_drop: leak
                    .fluid
                    .filter(|_| leak.coupling.is_none())
                    .map(|fluid| fluid.pressure_drop()),
                mean_pressure: load / simulation.grid.area(),
            });
        }
        diagnostics.findings()
    }

    fn inputs(&self, simulation: &Simulation, parts: &[Part], expected: Option<Expected>) -> Inputs {
        let relaxed = |body: &asperity::material::Body| {
            let relaxation = body.material.relaxation().ok()?;
            let instantaneous = relaxation.instantaneous();
            Some(ModulusInput {
                body: body.name.clone(),
                modulus: match body.material.measure() {
                    Modulus::Young => "young",
                    Modulus::Shear => "shear",
                },
                instantaneous: instantaneous.is_finite().then_some(instantaneous),
                relaxed: relaxation.equilibrium,
            })
        };
        let mut inputs = Inputs {
            surfaces: parts.iter().map(|part| surface(&self.conditions.grid, part)).collect(),
            moduli: self.bodies.iter().filter_map(relaxed).collect(),
            // Checked with the simulation.
            adhesion: AdhesionScale::of(simulation).ok().flatten(),
            ..Inputs::default()
        };
        let Some(expected) = expected else { return inputs };
        match expected.largest {
            Prescribed::Load(load) => {
                inputs.largest_load = Some(load);
                inputs.largest_mean_pressure = Some(load / simulation.grid.area());
            }
            Prescribed::Approach(approach) => inputs.largest_approach = Some(approach),
        }
        match expected.contact {
            Some(Contact::Round(radii)) => {
                inputs.expected_contact_radius = Some(radii);
                let cell = simulation.grid.cell_sides().fold(0.0, f64::max);
                inputs.expected_cells_across = Some(2.0 * radii[1] / cell);
            }
            Some(Contact::Share(shares)) => inputs.expected_contact_share = Some(shares),
            None => {}
        }
        inputs.expected_pressure_over_modulus = expected.strain;
        inputs
    }
}

fn surface(grid: &asperity::Grid, part: &Part) -> SurfaceInput {
    let heights = match part {
        Part::Shape { shape: shape @ Shape::Wave { .. }, .. } => {
            let [x0, y0] = grid.centre();
            let wave = |(i, j): (usize, usize)| shape.gap(grid.x(i) - x0, grid.y(j) - y0);
            Some(ndarray::Array2::from_shape_fn(grid.shape(), wave))
        }
        part => part.heights(grid).ok().flatten(),
    };
    let rough = heights.and_then(|heights| Surface::new(*grid, heights).ok());
    let (radius, slope) = match part {
        Part::Shape { shape: Shape::FlatPunch(Punch::Circle { radius }), .. } if grid.is_line() => {
            (Some([*radius, f64::INFINITY]), None)
        }
        Part::Shape { shape, .. } => match shape {
            Shape::Sphere { radius } | Shape::FlatPunch(Punch::Circle { radius }) => {
                (Some([*radius; 2]), None)
            }
            Shape::Cylinder { radius } => (Some([*radius, f64::INFINITY]), None),
            Shape::Ellipsoid { radius_x, radius_y } => (Some([*radius_x, *radius_y]), None),
            Shape::Cone { slope } | Shape::Wedge { slope } => (None, Some(*slope)),
            _ => (None, None),
        },
        _ => (None, None),
    };
    SurfaceInput {
        name: part.name().to_owned(),
        radius,
        slope,
        sq: rough.as_ref().and_then(|surface| HeightStatistics::of(surface).ok()).map(|heights| heights.sq),
        sdq: rough.as_ref().and_then(|surface| SlopeStatistics::of(surface).ok()).map(|slopes| slopes.sdq),
    }
}
