//! The kernel of one or two bodies of layers.

use ndarray::Array2;
use ndarray::parallel::prelude::*;

use super::hankel::Smooth;
use super::{Base, Stack};
use crate::error::{Error, Result};
use crate::kernel::{HalfSpace, Kernel};

/// Longest side of a cell over the thickness of a top layer.
const COARSEST: f64 = 4.0;
/// Parts of a cell along a side are at most this long, over the thickness ...
const PART: f64 = 0.5;
/// ... up to this distance over the thickness; further away the response varies over the distance itself.
const NEAR: f64 = 30.0;

/// Gauss-Legendre rule on \[-1, 1\] (Abramowitz & Stegun, table 25.4).
pub(super) const GAUSS_4: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// The bodies of a contact, each a [`Stack`], with all moduli times a common factor: K(q) = sum of C(q) / sum of q C(q)/2 for
/// short waves.
///
/// So short waves see a half-space of unit contact modulus, K(q) = 2/q, and the compliance that multiplies K is that of the
/// materials at the surface.
///
/// ```
/// use asperity::kernel::Kernel;
/// use asperity::layer::{Base, Interface, Layer, Layered, Stack};
/// let layer = Layer { thickness: 1e-3, shear: 1e6, poisson: 0.4, interface: Interface::Bonded };
/// let kernel = Layered::new(vec![Stack::new(vec![layer], Base::Rigid)?])?;
/// assert!((kernel.symbol(3e5, 4e5) * 5e5 / 2.0 - 1.0).abs() < 1e-15);
/// assert!(kernel.symbol(3e2, 4e2) * 5e2 / 2.0 < 0.2);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Layered {
    stacks: Vec<Stack>,
    /// What makes K(q) = 2/q for short waves \[Pa\].
    scale: f64,
}

impl Layered {
    /// The kernel of these bodies against each other, or of one against a rigid one.
    ///
    /// # Errors
    /// [`Error::Invalid`] where there are no bodies or more than two.
    pub fn new(stacks: Vec<Stack>) -> Result<Self> {
        if stacks.is_empty() || stacks.len() > 2 {
            return Err(Error::invalid("number of bodies", stacks.len(), "1 (against a rigid one) or 2"));
        }
        let scale = 2.0 / stacks.iter().map(Stack::short_waves).sum::<f64>();
        Ok(Layered { stacks, scale })
    }

    /// Longest side that a cell of a free domain may have \[m\]: 4 times the thinnest top layer.
    pub fn longest_cell(&self) -> f64 {
        let tops = self.stacks.iter().filter_map(|stack| stack.layers().first());
        COARSEST * tops.map(|layer| layer.thickness).fold(f64::INFINITY, f64::min)
    }

    /// The bodies; their moduli have a common factor.
    pub fn stacks(&self) -> &[Stack] {
        &self.stacks
    }
}

impl Kernel for Layered {
    fn influence(&self, cell: [f64; 2], count: [usize; 2]) -> Result<Array2<f64>> {
        let [dx, dy] = cell;
        let mut kernel = HalfSpace.influence(cell, count)?;
        let reach = libm::hypot(dx * count[0] as f64, dy * count[1] as f64);
        for stack in &self.stacks {
            let Some(smooth) = Smooth::new(stack, self.scale, reach)? else { continue };
            kernel.outer_iter_mut().into_par_iter().enumerate().for_each(|(i, mut row)| {
                for (j, k) in row.iter_mut().enumerate() {
                    *k += over_cell(&smooth, [i as f64 * dx, j as f64 * dy], cell);
                }
            });
        }
        Ok(kernel)
    }

    fn symbol(&self, qx: f64, qy: f64) -> f64 {
        let q = libm::hypot(qx, qy);
        self.scale * self.stacks.iter().map(|stack| stack.compliance(q)).sum::<f64>()
    }

    fn uniform(&self) -> Option<f64> {
        let sum: Option<f64> = self.stacks.iter().map(Stack::uniform).sum();
        sum.map(|sum| self.scale * sum)
    }

    fn depth(&self) -> Option<f64> {
        let rigid = |stack: &&Stack| matches!(stack.base(), Base::Rigid);
        let thickness = |stack: &Stack| stack.layers().iter().map(|layer| layer.thickness).sum::<f64>();
        let all = self.stacks.iter().filter(rigid).count() == self.stacks.len();
        all.then(|| self.stacks.iter().map(thickness).sum())
    }

    fn check(&self, cell: [f64; 2]) -> Result<()> {
        let (longest, most) = (cell[0].max(cell[1]), self.longest_cell());
        if longest <= most {
            return Ok(());
        }
        Err(Error::invalid(
            "longest side of a cell",
            format!("{longest:e} m"),
            format!(
                "at most {most:e} m on a free domain, {COARSEST} times the thickness of the top layer: take more cells, a \
                 smaller domain or a periodic one"
            ),
        ))
    }
}

/// Integral over the cell around (x, y): by parts no longer than half the thickness, as long as that is what k varies over.
fn over_cell(smooth: &Smooth, [x, y]: [f64; 2], [dx, dy]: [f64; 2]) -> f64 {
    let near = libm::hypot(x, y) < NEAR * smooth.thickness + dx.max(dy);
    let parts = [dx, dy].map(|side| match near {
        true => (side / (PART * smooth.thickness)).ceil().max(1.0),
        false => 1.0,
    });
    let half = [0.5 * dx / parts[0], 0.5 * dy / parts[1]];
    let mut sum = 0.0;
    for m in 0..parts[0] as usize {
        let x = x + (2.0 * m as f64 + 1.0 - parts[0]) * half[0];
        for n in 0..parts[1] as usize {
            let y = y + (2.0 * n as f64 + 1.0 - parts[1]) * half[1];
            for (s, ws) in GAUSS_4 {
                for (t, wt) in GAUSS_4 {
                    let (a, b) = (x + half[0] * s, y + half[1] * t);
                    sum += ws * wt * smooth.value((a * a + b * b).sqrt());
                }
            }
        }
    }
    half[0] * half[1] * sum
}
