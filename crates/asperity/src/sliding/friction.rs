//! The forces of a contact in motion.

use ndarray::ArrayView2;

use super::Slopes;
use crate::grid::{Boundary, Grid};
use crate::quantities::Quantity;

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
    /// |force - second estimate| over |force|; the second estimate is -Σ p du/ds.
    pub uncertainty: f64,
    /// Moment of the pressure about the centre of the slopes, Σ p s \[N m\]: the resistance to rolling.
    pub moment: f64,
    /// Power lost in the bodies \[W\].
    pub power: f64,
    /// Coefficient with the share of a shear stress on the area in contact; NaN where none is given.
    pub total: f64,
}

impl Friction {
    /// The quantity of a row that is one of these.
    pub(crate) fn quantity(&self, quantity: Quantity) -> Option<f64> {
        Some(match quantity {
            Quantity::Velocity => self.velocity,
            Quantity::SlidingDistance => self.distance,
            Quantity::FrictionForce => self.force,
            Quantity::SideForce => self.side,
            Quantity::FrictionCoefficient => self.coefficient,
            Quantity::FrictionCoefficientTotal => self.total,
            Quantity::FrictionUncertainty => self.uncertainty,
            Quantity::RollingMoment => self.moment,
            Quantity::DissipatedPower => self.power,
            _ => return None,
        })
    }

    /// From the quantities of a row; `None` where nothing moves.
    pub(crate) fn from_quantities(of: impl Fn(Quantity) -> Option<f64>) -> Option<Friction> {
        let known = |quantity| of(quantity).unwrap_or(f64::NAN);
        Some(Friction {
            velocity: of(Quantity::Velocity)?,
            distance: known(Quantity::SlidingDistance),
            force: known(Quantity::FrictionForce),
            side: known(Quantity::SideForce),
            coefficient: known(Quantity::FrictionCoefficient),
            total: known(Quantity::FrictionCoefficientTotal),
            uncertainty: known(Quantity::FrictionUncertainty),
            moment: known(Quantity::RollingMoment),
            power: known(Quantity::DissipatedPower),
        })
    }
}

/// Sums over the pressure: load, force, side force and moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Forces {
    pub(crate) load: f64,
    pub(crate) force: f64,
    pub(crate) side: f64,
    pub(crate) moment: f64,
}

impl Forces {
    /// Of a pressure under a gap with these slopes.
    pub(crate) fn of(
        grid: &Grid,
        boundary: Boundary,
        pressure: ArrayView2<f64>,
        slopes: &Slopes,
        direction: Direction,
    ) -> Forces {
        let [cx, cy] = direction.unit();
        let cell = grid.cell_area();
        // On a periodic domain from the nearest image of the centre.
        let from = |x: f64, axis: usize| {
            let (x, length) = (x - slopes.centre[axis], grid.size()[axis]);
            if boundary == Boundary::Periodic { x - length * (x / length).round() } else { x }
        };
        let mut sums = [0.0; 4];
        for (((i, j), p), (sx, sy)) in pressure.indexed_iter().zip(slopes.x.iter().zip(&slopes.y)) {
            if *p > 0.0 {
                let arm = cx * from(grid.x(i), 0) + cy * from(grid.y(j), 1);
                let terms = [*p, p * (cx * sx + cy * sy), p * (cx * sy - cy * sx), p * arm];
                sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            }
        }
        let [load, force, side, moment] = sums.map(|sum| cell * sum);
        Forces { load, force, side, moment }
    }
}

/// Σ p dg/ds \[N\] with central differences of the gap g of the deformed bodies: 0 but at the edges of the contact, and the
/// difference of the two estimates of friction.
pub(crate) fn gap_force(
    grid: &Grid,
    boundary: Boundary,
    pressure: ArrayView2<f64>,
    gap: ArrayView2<f64>,
    direction: Direction,
) -> f64 {
    let ([nx, ny], [dx, dy], [cx, cy]) = (grid.cells(), grid.spacing(), direction.unit());
    let step = |n: usize, count: usize, forward: bool| match (boundary, forward) {
        (Boundary::Periodic, true) => (n + 1) % count,
        (Boundary::Periodic, false) => (n + count - 1) % count,
        (Boundary::Free, true) => (n + 1).min(count - 1),
        (Boundary::Free, false) => n.saturating_sub(1),
    };
    let mut sum = 0.0;
    for ((i, j), p) in pressure.indexed_iter() {
        if *p > 0.0 {
            let along_x = (gap[(step(i, nx, true), j)] - gap[(step(i, nx, false), j)]) / (2.0 * dx);
            let along_y = match ny {
                1 => 0.0,
                _ => (gap[(i, step(j, ny, true))] - gap[(i, step(j, ny, false))]) / (2.0 * dy),
            };
            let slope = cx * along_x + cy * along_y;
            sum += p * if slope.is_finite() { slope } else { 0.0 };
        }
    }
    sum * grid.cell_area()
}
