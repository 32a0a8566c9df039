//! The expected contact, estimated before the run.
//!
//! ```text
//! paraboloid   a³ = 3 R W C / 4,  w = a²/R,  p_max C = 2a/(πR)          (Hertz)
//! cone         a² = 2 W C / (π s),  w = π s a/2,  p_mean C = s/2         (Love, Sneddon)
//! cylinder     a² = 4 R W C / π,  p_max C = a/(2R)                      (Hertz; W per length)
//! wedge        a = W C / s,  p_mean C = s/2                             (Johnson, section 5.2; W per length)
//! rough plane  A/A0 = erf(√π p C / h'),  p_mean = p A0/A               (Persson's form, with the slope 2 p C/h' that
//!                                                                      computed contacts have under light loads; h' the rms slope)
//! ```
//!
//! with the compliance C at the start and at the end of the run; only for half-spaces. This is an estimate: it ignores the other
//! parts of the gap, and uses only the largest load or approach.

use std::f64::consts::PI;

use ndarray::Array2;

use super::words::si;
use super::{Finding, contact, domain, plausible, strain, surface};
use crate::contact::Prescribed;
use crate::grid::{Boundary, Grid};
use crate::load::{Control, Course, Event, Stage};
use crate::simulation::Simulation;
use crate::sliding::Streaming;
use crate::surface::{Part, Punch, Shape};

/// Recommended width of the domain over the radius of the contact.
pub(super) const ROOM: f64 = 2.5;
/// Contacts closer to the border than this are expected to reach it.
const NEAR: f64 = 0.97;

/// The expected contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contact {
    /// One round spot with these radii \[m\], right after the load and at the end; for a line contact, the half-widths.
    Round([f64; 2]),
    /// These fractions of the domain.
    Share([f64; 2]),
}

/// The estimate for a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// The largest load \[N\], or the largest approach \[m\], that the case prescribes.
    pub largest: Prescribed,
    /// The contact, if the surface is simple enough.
    pub contact: Option<Contact>,
    /// Pressure over contact modulus at the end: the largest in a round contact, the mean in that of a rough plane.
    pub strain: Option<f64>,
    /// Contact radius over radius of the body at the end.
    width: Option<f64>,
    /// Distance from the middle of the contact to the nearest border \[m\].
    room: f64,
}

/// The shape that determines a contact.
#[derive(Clone, Copy)]
enum Form {
    Paraboloid { radius: f64 },
    Cone { slope: f64 },
    Cylinder { radius: f64 },
    Wedge { slope: f64 },
    Punch { radius: f64 },
    Rough { slope: f64 },
}

impl Expected {
    /// From the parts of the gap; `None` if there is no contact.
    pub fn of(simulation: &Simulation, parts: &[Part]) -> Option<Expected> {
        let compliance = [simulation.instantaneous(), simulation.compliance(simulation.times.end())];
        Expected::with(simulation, parts, compliance)
    }

    /// The same for steady states of motion at `velocities` \[m/s\]: the compliance is that of a wave which passes the contact at the
    /// fastest, and at the slowest velocity, |C(v/a)|, with the radius a at rest, where the contact is largest. An empty list gives the
    /// compliance at rest.
    pub fn of_sweep(
        simulation: &Simulation,
        parts: &[Part],
        streaming: &Streaming,
        velocities: &[f64],
    ) -> Option<Expected> {
        // Of a rough surface the two limits, as the width of its spots is not known.
        let limits = [simulation.instantaneous(), streaming.at(0.0).norm()];
        let at_rest = Expected::with(simulation, parts, limits)?;
        let Some(Contact::Round([_, radius])) = at_rest.contact else { return Some(at_rest) };
        let frequency = |v: f64| v.abs() / radius.max(f64::MIN_POSITIVE);
        let slowest = velocities.iter().map(|v| v.abs()).reduce(f64::min).unwrap_or(0.0);
        let fastest = velocities.iter().map(|v| v.abs()).fold(0.0, f64::max);
        let compliance = [fastest, slowest].map(|v| streaming.at(frequency(v)).norm());
        Expected::with(simulation, parts, compliance)
    }

    /// With the compliance at the start and at the end \[1/Pa\].
    fn with(simulation: &Simulation, parts: &[Part], compliance: [f64; 2]) -> Option<Expected> {
        let grid = &simulation.grid;
        let stages = &simulation.loading.stages;
        let cases = stages.iter().filter_map(|stage| largest(simulation, stage));
        // The formulas are those of the half-space.
        let form = match simulation.kernel.is_half_space() {
            true => form(grid, &simulation.gap, parts),
            false => None,
        };
        let size = |(largest, until): &(Prescribed, Option<Event>)| {
            let radius = |c: f64| {
                let radius = form?.radius(*largest, c, simulation.hardness);
                let end = match until {
                    Some(Event::Approach(w)) => form?.radius(Prescribed::Approach(*w), c, f64::INFINITY),
                    Some(Event::Load(w)) => form?.radius(Prescribed::Load(*w), c, simulation.hardness),
                    _ => None,
                };
                Some(radius?.min(end.unwrap_or(f64::INFINITY)))
            };
            Some([radius(compliance[0])?, radius(compliance[1])?])
        };
        let all = cases.map(|case| (case.0, size(&case)));
        let (largest, radii) = all.max_by(|a, b| order(a).total_cmp(&order(b)))?;
        let mut expected =
            Expected { largest, contact: None, strain: None, width: None, room: room(grid, parts) };
        match (form, radii, largest) {
            (Some(Form::Rough { slope }), _, Prescribed::Load(load)) => {
                let share = |c: f64| libm::erf(PI.sqrt() * load / grid.area() * c / slope);
                let shares = compliance.map(share);
                expected.contact = Some(Contact::Share(shares));
                expected.strain =
                    Some(load / grid.area() * compliance[1] / shares[1]).filter(|s| s.is_finite());
            }
            (Some(form), Some(radii), _) => {
                let a = radii[1];
                expected.contact = Some(Contact::Round(radii));
                (expected.strain, expected.width) = match form {
                    Form::Paraboloid { radius } => (Some(2.0 * a / (PI * radius)), Some(a / radius)),
                    Form::Cylinder { radius } => (Some(0.5 * a / radius), Some(a / radius)),
                    Form::Cone { slope } | Form::Wedge { slope } => (Some(0.5 * slope), None),
                    Form::Punch { radius } => match largest {
                        Prescribed::Load(load) => (Some(load / (PI * radius * radius) * compliance[1]), None),
                        Prescribed::Approach(w) => (Some(2.0 * w / (PI * radius)), None),
                    },
                    Form::Rough { .. } => (None, None),
                };
            }
            _ => {}
        }
        Some(expected)
    }

    /// The findings if the contact is as expected.
    pub fn findings(&self, simulation: &Simulation) -> Vec<Finding> {
        let grid = &simulation.grid;
        let cells = match self.contact {
            Some(Contact::Round([_, radius])) if grid.is_line() => Some(2.0 * radius / grid.longest_cell()),
            Some(Contact::Round([_, radius])) => Some(PI * radius * radius / grid.cell_area()),
            Some(Contact::Share([_, share])) => Some(share * grid.len() as f64),
            None => None,
        };
        let mut found: Vec<Finding> =
            plausible::unlikely_load(simulation, self.largest, cells).into_iter().collect();
        let Some(Contact::Round([_, radius])) = self.contact else {
            // As the run judges it: the middle of a Hertzian spot with this mean pressure.
            let hertz = if grid.is_line() { 4.0 / PI } else { 1.5 };
            found.extend(strain::expected(0.0, hertz * self.strain.unwrap_or(0.0)));
            return found;
        };
        if simulation.boundary == Boundary::Free && radius > NEAR * self.room {
            let words = format!("The expected contact, {} across,", si(2.0 * radius, "m"));
            found.push(domain::at_border(grid, true, Some(ROOM * radius), &words));
        }
        if radius > 0.0 {
            let cell = grid.longest_cell();
            found.extend(contact::expected(2.0 * radius / cell, grid.is_line()));
        }
        found.extend(strain::expected(self.width.unwrap_or(0.0), self.strain.unwrap_or(0.0)));
        found
    }
}

fn order((largest, radii): &(Prescribed, Option<[f64; 2]>)) -> f64 {
    let given = match largest {
        Prescribed::Load(w) | Prescribed::Approach(w) => *w,
    };
    radii.map_or(given, |radii| radii[1])
}

impl Form {
    /// Radius of the contact under a load or an approach with the compliance c; at least the radius required by the hardness.
    fn radius(self, given: Prescribed, c: f64, hardness: f64) -> Option<f64> {
        let least = |load: f64| (load / (PI * hardness)).sqrt();
        Some(match (self, given) {
            (Form::Paraboloid { radius }, Prescribed::Load(w)) => {
                (0.75 * radius * w * c).cbrt().max(least(w))
            }
            (Form::Paraboloid { radius }, Prescribed::Approach(w)) => (radius * w.max(0.0)).sqrt(),
            (Form::Cone { slope }, Prescribed::Load(w)) => (2.0 * w * c / (PI * slope)).sqrt().max(least(w)),
            (Form::Cone { slope }, Prescribed::Approach(w)) => 2.0 * w.max(0.0) / (PI * slope),
            (Form::Cylinder { radius }, Prescribed::Load(w)) => {
                (4.0 * radius * w * c / PI).sqrt().max(0.5 * w / hardness)
            }
            (Form::Wedge { slope }, Prescribed::Load(w)) => (w * c / slope).max(0.5 * w / hardness),
            (Form::Punch { radius }, _) => radius,
            // The approach of a line contact depends on the domain.
            (Form::Cylinder { .. } | Form::Wedge { .. }, Prescribed::Approach(_)) => return None,
            (Form::Rough { .. }, _) => return None,
        })
    }
}

/// The largest value of a stage, and the event that may end it earlier.
fn largest(simulation: &Simulation, stage: &Stage) -> Option<(Prescribed, Option<Event>)> {
    let end = simulation.times.end();
    let most = match &stage.course {
        Course::Given(history) => history.range(stage.duration.unwrap_or(end).min(end))[1],
        Course::RampTo { value, .. } => *value,
        Course::Hold => return None,
    };
    let largest = match stage.control {
        Control::Load => Prescribed::Load(most),
        Control::Pressure => Prescribed::Load(most * simulation.grid.area()),
        Control::Approach => Prescribed::Approach(most),
    };
    (most > 0.0).then_some((largest, stage.until))
}

/// The shapes among the parts.
fn shapes(parts: &[Part]) -> impl Iterator<Item = &Shape> {
    parts.iter().filter_map(|part| match part {
        Part::Shape { shape, .. } => Some(shape),
        _ => None,
    })
}

/// Mean radius of the sum of the paraboloids and cylinders \[m\]; for a line contact, the radius of their section. `None` if an
/// axis is not curved.
pub(super) fn radius(grid: &Grid, parts: &[Part]) -> Option<f64> {
    let [x, y] = shapes(parts).fold([0.0; 2], |[x, y], shape| match shape {
        Shape::Sphere { radius } => [x + 1.0 / radius, y + 1.0 / radius],
        Shape::Ellipsoid { radius_x, radius_y } => [x + 1.0 / radius_x, y + 1.0 / radius_y],
        Shape::Cylinder { radius } => [x + 1.0 / radius, y],
        _ => [x, y],
    });
    match grid.is_line() {
        true => (x > 0.0).then(|| 1.0 / x),
        false => (x > 0.0 && y > 0.0).then(|| (1.0 / x * (1.0 / y)).sqrt()),
    }
}

/// The shape that determines the contact; if there is none, the slope of the gap. For a line contact only the section of a shape
/// matters.
fn form(grid: &Grid, gap: &Array2<f64>, parts: &[Part]) -> Option<Form> {
    let line = grid.is_line();
    let punch = shapes(parts).find_map(|shape| match shape {
        Shape::FlatPunch(Punch::Circle { radius }) => Some(*radius),
        Shape::FlatPunch(Punch::Rectangle { size: [a, _] }) if line => Some(0.5 * a),
        Shape::FlatPunch(Punch::Rectangle { size: [a, b] }) => Some((a * b / PI).sqrt()),
        _ => None,
    });
    let cone = shapes(parts).find_map(|shape| match shape {
        Shape::Cone { slope } => Some(*slope),
        Shape::Wedge { slope } if line => Some(*slope),
        _ => None,
    });
    Some(match (radius(grid, parts), cone, punch) {
        (Some(radius), None, None) if line => Form::Cylinder { radius },
        (Some(radius), None, None) => Form::Paraboloid { radius },
        (None, Some(slope), None) if line => Form::Wedge { slope },
        (None, Some(slope), None) => Form::Cone { slope },
        (None, None, Some(radius)) if parts.len() == 1 => Form::Punch { radius },
        (None, None, None) => {
            let slope = surface::slope(grid, gap, f64::INFINITY);
            return (slope > 0.0).then_some(Form::Rough { slope });
        }
        _ => return None,
    })
}

/// Distance from the middle of the shapes to the nearest border \[m\].
fn room(grid: &Grid, parts: &[Part]) -> f64 {
    let [x0, y0] = parts
        .iter()
        .find_map(|part| match part {
            Part::Shape { center, shape } if !matches!(shape, Shape::FlatPunch(_) | Shape::Wave { .. }) => {
                Some(*center)
            }
            _ => None,
        })
        .unwrap_or_default();
    let sides = grid.extents().iter().zip([x0, y0]).map(|(length, centre)| 0.5 * length - centre.abs());
    sides.fold(f64::INFINITY, f64::min).max(0.0)
}
