//! The forces of a contact in motion.

use asperity_sweep::sums;

use super::Slopes;
use crate::contact::ContactState;
use crate::error::{Error, Result, require, significant};
use crate::grid::{Boundary, Grid};
use crate::quantities::Quantity;
use crate::simulation::Simulation;

/// Direction of motion: that of the contact over the body that the grid is fixed to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// At this angle from x towards y \[rad\].
    Angle(f64),
}

impl Direction {
    /// Length along it in which a cell passes, the shorter one \[m\].
    pub fn cell(self, grid: &Grid) -> f64 {
        let ([cx, cy], [dx, dy]) = (self.unit(), grid.spacing());
        match self {
            Direction::X => dx,
            Direction::Y => dy,
            Direction::Angle(_) => (dx / cx.abs().max(1e-300)).min(dy / cy.abs().max(1e-300)),
        }
    }

    /// Whether a contact of this simulation can move this way.
    pub(crate) fn validate(self, simulation: &Simulation) -> Result<()> {
        let across = simulation.grid.is_line() && self != Direction::X;
        require(!across, "direction of motion of a line contact", "not x", "x")?;
        match self {
            Direction::Angle(angle) if simulation.boundary == Boundary::Free => Err(Error::invalid(
                "direction of motion on a free domain",
                format!("{} degrees", significant(angle.to_degrees(), 4)),
                "x or y; other directions need a periodic domain",
            )),
            _ => Ok(()),
        }
    }

    /// The axis that it is along, of x or y.
    pub(crate) fn axis(self) -> usize {
        usize::from(self == Direction::Y)
    }

    /// Its unit vector.
    pub fn unit(self) -> [f64; 2] {
        match self {
            Direction::X => [1.0, 0.0],
            Direction::Y => [0.0, 1.0],
            Direction::Angle(angle) => [libm::cos(angle), libm::sin(angle)],
        }
    }
}

/// What a contact in motion does to the bodies.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Friction {
    /// Velocity \[m/s\].
    pub velocity: f64,
    /// How far the contact has moved \[m\].
    pub distance: f64,
    /// Force against motion in the direction of motion, Σ p dh/ds \[N\].
    pub force: f64,
    /// Force across it, Σ p dh/dn \[N\]; n is s turned by a right angle from x towards y.
    pub side: f64,
    /// Force over load.
    pub coefficient: f64,
    /// Estimated error over |force|: that of the grid, |force - second estimate| with the second estimate -Σ p du/ds, and in time that of
    /// the time steps, the relative error of the stress times Σ p |dh/ds|.
    pub uncertainty: f64,
    /// Moment of the pressure about the centre of the slopes, Σ p s \[N m\]: the resistance to rolling.
    pub moment: f64,
    /// Power lost in the bodies \[W\].
    pub power: f64,
    /// Coefficient with the share of a shear stress on the area in contact; NaN where none is given.
    pub total: f64,
}

/// The forces by their quantities.
macro_rules! forces {
    ($($quantity:ident: $field:ident),* $(,)?) => {
        impl Friction {
            /// The quantity of a row that is one of these.
            pub(crate) fn quantity(&self, quantity: Quantity) -> Option<f64> {
                match quantity {
                    $(Quantity::$quantity => Some(self.$field),)*
                    _ => None,
                }
            }

            /// From the quantities of a row; `None` where nothing moves.
            pub fn from_quantities(of: impl Fn(Quantity) -> Option<f64>) -> Option<Friction> {
                let known = |quantity| of(quantity).unwrap_or(f64::NAN);
                of(Quantity::Velocity).map(|_| Friction { $($field: known(Quantity::$quantity)),* })
            }
        }
    };
}

forces! {
    Velocity: velocity,
    SlidingDistance: distance,
    FrictionForce: force,
    SideForce: side,
    FrictionCoefficient: coefficient,
    FrictionCoefficientTotal: total,
    FrictionUncertainty: uncertainty,
    RollingMoment: moment,
    DissipatedPower: power,
}

/// What the forces of a contact in motion are found from.
pub(crate) struct ContactForces<'a> {
    pub(crate) simulation: &'a Simulation,
    pub(crate) direction: Direction,
    /// Of the undeformed gap of what moves.
    pub(crate) slopes: &'a Slopes,
    pub(crate) state: &'a ContactState,
    /// Undeformed gap and displacement c U; a constant does not count.
    pub(crate) gap: &'a [f64],
    pub(crate) compliance: f64,
    /// Whether the bodies remember anything. Those that do not lose nothing: what the sums are then is the error of the grid.
    pub(crate) remembers: bool,
    pub(crate) velocity: f64,
    /// How far the contact has moved.
    pub(crate) distance: f64,
    pub(crate) shear_stress: Option<f64>,
    /// Relative error of the stress because of the time steps.
    pub(crate) time_error: f64,
}

/// The second estimate of the force, -Σ p du/ds.
pub(crate) enum SecondEstimate {
    /// By differences of the displacement from cell to cell. The power lost is not known.
    Differences,
    /// In a steady state, where its work is what is lost; of a periodic domain from the waves \[N\].
    Steady(Option<f64>),
}

impl Friction {
    /// Of a solved contact.
    pub(crate) fn of(contact: &ContactForces, second: SecondEstimate) -> Friction {
        let [load, mut force, mut side, moment, off, area, slopes] = contact.sums();
        if !contact.remembers {
            (force, side) = (0.0, 0.0);
        }
        let coefficient = if load > 0.0 { force / load } else { 0.0 };
        let (apart, scale, power) = match second {
            SecondEstimate::Differences => (off, force.abs(), f64::NAN),
            SecondEstimate::Steady(waves) => {
                let second = waves.unwrap_or(if contact.remembers { force - off } else { 0.0 });
                let power = second.max(0.0) * contact.velocity;
                (force - second, force.abs().max(second.abs()), power)
            }
        };
        Friction {
            velocity: contact.velocity,
            distance: contact.distance,
            force,
            side,
            coefficient,
            uncertainty: match scale > ROUNDING * load {
                true => (apart.abs() + contact.time_error * slopes) / scale,
                false => 0.0,
            },
            moment,
            power,
            total: contact.shear_stress.map_or(f64::NAN, |stress| match load > 0.0 {
                true => coefficient + stress * area / load,
                false => 0.0,
            }),
        }
    }
}

/// Forces below this share of the load are rounding errors.
const ROUNDING: f64 = 1e-13;

impl ContactForces<'_> {
    /// Load, force, side force, moment, Σ p dg/ds with g the gap of the deformed bodies, area in contact, and Σ p |dh/ds|.
    ///
    /// g is 0 in contact, so that Σ p dg/ds comes from the edges alone: it is the difference of the two estimates of the force.
    fn sums(&self) -> [f64; 7] {
        let (Simulation { grid, boundary, .. }, [cx, cy]) = (self.simulation, self.direction.unit());
        let ny = grid.cells()[1];
        // On a periodic domain from the nearest image of the centre.
        let from = |x: f64, axis: usize| {
            let (x, length) = (x - self.slopes.centre[axis], grid.size()[axis]);
            if *boundary == Boundary::Periodic { x - length * (x / length).round() } else { x }
        };
        let of_cell = |cell: usize| {
            let p = self.state.pressure[cell];
            if p <= 0.0 {
                return [0.0; 7];
            }
            let (i, j) = (cell / ny, cell % ny);
            let (sx, sy) = (self.slopes.x[(i, j)], self.slopes.y[(i, j)]);
            let arm = cx * from(grid.x(i), 0) + cy * from(grid.y(j), 1);
            let edge = self.slope_of_gap(i, j);
            let along = p * (cx * sx + cy * sy);
            [p, along, p * (cx * sy - cy * sx), p * arm, p * edge, 1.0, along.abs()]
        };
        sums(0..grid.len(), of_cell).map(|sum| grid.cell_area() * sum)
    }

    /// dg/ds by central differences; 0 beside cells that cannot touch.
    fn slope_of_gap(&self, i: usize, j: usize) -> f64 {
        let Simulation { grid, boundary, .. } = self.simulation;
        let ([nx, ny], [dx, dy], [cx, cy]) = (grid.cells(), grid.spacing(), self.direction.unit());
        let step = |n: usize, count: usize, forward: bool| match (boundary, forward) {
            (Boundary::Periodic, true) => (n + 1) % count,
            (Boundary::Periodic, false) => (n + count - 1) % count,
            (Boundary::Free, true) => (n + 1).min(count - 1),
            (Boundary::Free, false) => n.saturating_sub(1),
        };
        let gap = |i: usize, j: usize| {
            let cell = i * ny + j;
            self.gap[cell] + self.compliance * self.state.unit_displacement[cell]
        };
        let along_x = (gap(step(i, nx, true), j) - gap(step(i, nx, false), j)) / (2.0 * dx);
        let along_y = match ny {
            1 => 0.0,
            _ => (gap(i, step(j, ny, true)) - gap(i, step(j, ny, false))) / (2.0 * dy),
        };
        let slope = cx * along_x + cy * along_y;
        if slope.is_finite() { slope } else { 0.0 }
    }
}
