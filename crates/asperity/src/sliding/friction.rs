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

    /// How far a body moves on a periodic domain until it meets its own track \[m\]: the side along the motion, and in an oblique
    /// direction the way to the first image of the start that it passes within a quarter of the shorter side.
    pub fn return_length(self, grid: &Grid) -> f64 {
        let ([lx, ly], [c, s]) = (grid.size(), self.unit());
        match self {
            Direction::X => lx,
            Direction::Y => ly,
            Direction::Angle(_) => {
                let near = 0.25 * lx.min(ly);
                let images = (-IMAGES..=IMAGES).flat_map(|m| (-IMAGES..=IMAGES).map(move |n| [m, n]));
                images
                    .map(|image| [f64::from(image[0]) * lx, f64::from(image[1]) * ly])
                    .map(|[x, y]| [c * x + s * y, c * y - s * x])
                    .filter(|[along, across]| *along > near && across.abs() <= near)
                    .fold(f64::INFINITY, |least, [along, _]| least.min(along))
            }
        }
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

/// Images of a periodic domain that are looked at along an axis, to each side.
const IMAGES: i32 = 32;

/// What a contact in motion does to the bodies.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Friction {
    /// Velocity \[m/s\].
    pub velocity: f64,
    /// How far the contact has moved \[m\].
    pub distance: f64,
    /// Force against motion in the direction of motion \[N\]: Σ p dh/ds in time, the power lost over the velocity in a steady state.
    pub force: f64,
    /// Force across it, Σ p dh/dn \[N\]; n is s turned by a right angle from x towards y.
    pub side: f64,
    /// Force over load; NaN where the surfaces hold together without a load.
    pub coefficient: f64,
    /// Estimated error over |force|, from other estimates of it, and in time from the error of the stress.
    pub uncertainty: f64,
    /// Moment of the pressure about the centre of the slopes, Σ p s \[N m\]: the resistance to rolling.
    pub moment: f64,
    /// Power lost in the bodies \[W\].
    pub power: f64,
    /// Coefficient with the friction of the surfaces themselves against motion, of a shear stress on the area in contact or of a coefficient;
    /// NaN where neither is given. Surfaces at rest have none.
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
    /// What does work on a gap that moves \[Pa\]: the pressure of the state, without that of a fluid, which is the same everywhere; and
    /// the contact pressure alone, without the attraction of surfaces that adhere.
    pub(crate) pressure: &'a [f64],
    pub(crate) contact: &'a [f64],
    /// The load that the fluid carries \[N\].
    pub(crate) fluid_load: f64,
    /// Undeformed gap and displacement c U; a constant does not count.
    pub(crate) gap: &'a [f64],
    pub(crate) compliance: f64,
    /// Whether the bodies lose anything. Where they do not, what the sums are is the error of the grid.
    pub(crate) loses: bool,
    pub(crate) velocity: f64,
    /// 1, -1 or at rest 0.
    pub(crate) sense: f64,
    /// How far the contact has moved.
    pub(crate) distance: f64,
    pub(crate) shear_stress: Option<f64>,
}

impl Friction {
    /// The coefficient with the friction of the surfaces where they have any, else that of the loss in the bulk.
    pub fn of_all(&self) -> f64 {
        if self.total.is_nan() { self.coefficient } else { self.total }
    }

    /// Of a contact that moves in time: the force is the sum over the slopes.
    ///
    /// What is unknown of it is what the cells leave open, Σ p Dg at the edges and Σ p (dh/ds - Dh) of waves of a few cells, with D the
    /// central difference, and what the time steps do to the stress. A wave of wave number q that moves by a cell in a step of
    /// linear u has between (x/2) cot(x/2) and sin(x)/x of its loss, x = q dx, whatever the material: 1 - sin(x)/x is the error of Dh
    /// as well. `held` makes of what this row does not know what it states \[N\].
    pub(crate) fn in_time(
        contact: &ContactForces,
        time_error: f64,
        held: impl FnOnce(f64) -> f64,
    ) -> Friction {
        let sums = contact.sums();
        // What the sum is before anything has moved is the error of the grid.
        let force = if contact.loses && contact.distance != 0.0 { sums.slopes } else { 0.0 };
        let unknown = sums.edges.abs() + sums.waves.abs() + time_error * sums.size;
        Friction::new(contact, &sums, [force, held(unknown)], f64::NAN)
    }

    /// Of a steady state, in which `loss` is lost per distance \[N\]: by the balance of power this is the force.
    ///
    /// Two other estimates tell what the cells leave open of it. Taken by central differences of the displacement, waves lose
    /// sin(q dx)/(q dx) of it: t = |loss + Σ p Du|. The sum over the slopes differs by s; at low and at high speed, where it is the
    /// small difference of large forces, its own error may be much larger. √(t min(s, t)) is unknown.
    pub(crate) fn steady(contact: &ContactForces, loss: f64) -> Friction {
        let sums = contact.sums();
        let [by_differences, by_slopes] =
            [sums.differences, sums.slopes].map(|estimate| (loss - estimate).abs());
        let unknown = (by_differences * by_differences.min(by_slopes)).sqrt();
        Friction::new(contact, &sums, [loss, unknown], loss * contact.velocity)
    }

    fn new(contact: &ContactForces, sums: &Sums, [force, unknown]: [f64; 2], power: f64) -> Friction {
        let over_load = |force: f64| match sums.load {
            load if load > 0.0 => force / load,
            _ if sums.strain == 0.0 => 0.0,
            _ => f64::NAN,
        };
        Friction {
            velocity: contact.velocity,
            distance: contact.distance,
            force,
            side: if contact.loses { sums.side } else { 0.0 },
            coefficient: over_load(force),
            uncertainty: if force.abs() > ROUNDING * sums.strain { unknown / force.abs() } else { 0.0 },
            moment: sums.moment,
            power,
            total: contact.rubbing(sums).map_or(f64::NAN, |own| over_load(force) + over_load(own)),
        }
    }
}

/// Forces below this share of all that presses and pulls are rounding errors.
const ROUNDING: f64 = 1e-13;

/// Sums over the cells that press or pull, times the area of a cell; s is the direction of motion, n across it, D a central difference.
struct Sums {
    /// Σ p, and the load of the fluid.
    load: f64,
    /// Σ |p|.
    strain: f64,
    /// Σ p dh/ds, h of what moves.
    slopes: f64,
    /// Σ p dh/dn.
    side: f64,
    /// Σ p s.
    moment: f64,
    /// Σ q, and Σ 1 over the cells in contact.
    contact: f64,
    area: f64,
    /// Σ |p dh/ds|.
    size: f64,
    /// Σ p Dg, g the gap of the deformed bodies: 0 in contact, so this comes from the edges alone. An attraction that depends on the gap
    /// adds nothing but what the cells leave open either.
    edges: f64,
    /// Σ p (dh/ds - Dh), to leading order.
    waves: f64,
    /// -Σ p Du.
    differences: f64,
}

impl ContactForces<'_> {
    /// The force of the friction of the surfaces themselves \[N\], with the sign of the velocity; `None` where they have none.
    fn rubbing(&self, sums: &Sums) -> Option<f64> {
        let coefficient = self.simulation.flash.as_ref().map_or(0.0, |flash| flash.friction);
        if self.shear_stress.is_none() && coefficient == 0.0 {
            return None;
        }
        let stress = self.shear_stress.unwrap_or(0.0);
        Some(self.sense * (coefficient * sums.contact + stress * sums.area))
    }

    fn sums(&self) -> Sums {
        let (Simulation { grid, boundary, .. }, [cx, cy]) = (self.simulation, self.direction.unit());
        let ny = grid.cells()[1];
        // On a periodic domain from the nearest image of the centre.
        let from = |x: f64, axis: usize| {
            let (x, length) = (x - self.slopes.centre[axis], grid.size()[axis]);
            if *boundary == Boundary::Periodic { x - length * (x / length).round() } else { x }
        };
        let displacement = |cell: usize| self.compliance * self.state.unit_displacement[cell];
        let of_cell = |cell: usize| {
            let p = self.pressure[cell];
            if p == 0.0 {
                return [0.0; 11];
            }
            let q = self.contact[cell];
            let (i, j) = (cell / ny, cell % ny);
            let (sx, sy) = (self.slopes.x[(i, j)], self.slopes.y[(i, j)]);
            let (along, across) = (cx * sx + cy * sy, cx * sy - cy * sx);
            let arm = cx * from(grid.x(i), 0) + cy * from(grid.y(j), 1);
            let edge = self.difference((i, j), |cell| self.gap[cell] + displacement(cell));
            let back = -self.difference((i, j), displacement);
            let of_force = [along, across, arm, edge, self.missed((i, j)), back];
            let [slopes, side, moment, edges, waves, differences] = of_force.map(|x| p * x);
            let (size, touches) = (slopes.abs(), f64::from(u8::from(q > 0.0)));
            [p, p.abs(), slopes, side, moment, q, touches, size, edges, waves, differences]
        };
        let all = sums(0..grid.len(), of_cell).map(|sum| grid.cell_area() * sum);
        let [load, strain, slopes, side, moment, contact, area, size, edges, waves, differences] = all;
        let load = load + self.fluid_load;
        Sums { load, strain, slopes, side, moment, contact, area, size, edges, waves, differences }
    }

    /// The cells before and behind a cell along both axes; at the ends of a free domain the cell itself.
    fn neighbours(&self, (i, j): (usize, usize)) -> [[(usize, usize); 2]; 2] {
        let Simulation { grid, boundary, .. } = self.simulation;
        let [nx, ny] = grid.cells();
        let next = |n: usize, count: usize| match boundary {
            Boundary::Periodic => [(n + count - 1) % count, (n + 1) % count],
            Boundary::Free => [n.saturating_sub(1), (n + 1).min(count - 1)],
        };
        [next(i, nx).map(|i| (i, j)), next(j, ny).map(|j| (i, j))]
    }

    /// D of a field along the motion; 0 beside cells that cannot touch.
    fn difference(&self, at: (usize, usize), field: impl Fn(usize) -> f64) -> f64 {
        let grid = &self.simulation.grid;
        let ([dx, dy], [cx, cy], ny) = (grid.spacing(), self.direction.unit(), grid.cells()[1]);
        let [along_x, along_y] = self.neighbours(at).map(|cells| {
            let [before, behind] = cells.map(|(i, j)| field(i * ny + j));
            0.5 * (behind - before)
        });
        let slope = cx * along_x / dx + if ny > 1 { cy * along_y / dy } else { 0.0 };
        if slope.is_finite() { slope } else { 0.0 }
    }

    /// dh/ds - Dh to leading order, where Dh is dh/ds plus dx²/6 of its second derivative: from the slopes of three cells.
    fn missed(&self, (i, j): (usize, usize)) -> f64 {
        let fields = [&self.slopes.x, &self.slopes.y];
        let missed = |axis: usize, [before, behind]: [(usize, usize); 2]| {
            let slope = fields[axis];
            (2.0 * slope[(i, j)] - slope[before] - slope[behind]) / 6.0
        };
        let ([along_x, along_y], [cx, cy]) = (self.neighbours((i, j)), self.direction.unit());
        cx * missed(0, along_x) + cy * missed(1, along_y)
    }
}
