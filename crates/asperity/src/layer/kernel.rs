//! The kernel of one or two bodies of layers.

use std::f64::consts::PI;

use ndarray::Array2;
use ndarray::parallel::prelude::*;

use super::hankel::{Load, Smooth};
use super::{Base, Stack};
use crate::error::{Result, require};
use crate::kernel::gauss::{GAUSS_2, GAUSS_3, GAUSS_4};
use crate::kernel::{Kernel, love, strip_at};

/// Longest side of a cell over the thickness of a top layer.
const COARSEST: f64 = 4.0;
/// Largest length of the parts of a cell along a side, over the thickness ...
const PART: f64 = 0.5;
/// ... up to this distance over the thickness; farther away the response varies on the scale of the distance.
const NEAR: f64 = 30.0;
/// The same for a line.
const PART_OF_LINE: f64 = 0.25;

/// The rules for parts up to these lengths, over the length on which k varies there, with errors below 1e-8.
const RULES: [(f64, &[(f64, f64)]); 2] = [(0.03, &GAUSS_2), (0.15, &GAUSS_3)];

/// The bodies of a contact, each a [`Stack`], with all moduli times a common factor: K(q) = sum of C(q) / sum of q C(q)/2 for
/// short waves.
///
/// For short waves the bodies are therefore equivalent to a half-space of unit contact modulus, K(q) = 2/q, and the compliance
/// that multiplies K is that of the materials at the surface.
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
    /// The factor such that K(q) = 2/q for short waves \[Pa\].
    scale: f64,
}

impl Layered {
    /// The kernel of these bodies against each other, or of one against a rigid one.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if there are no bodies or more than two.
    pub fn new(stacks: Vec<Stack>) -> Result<Self> {
        require(
            (1..=2).contains(&stacks.len()),
            "number of bodies",
            stacks.len(),
            "1 (against a rigid one) or 2",
        )?;
        let scale = 2.0 / stacks.iter().map(Stack::short_waves).sum::<f64>();
        Ok(Layered { stacks, scale })
    }

    /// Longest side that a cell of a free domain may have \[m\]: 4 times the thinnest top layer.
    pub fn longest_cell(&self) -> f64 {
        COARSEST * self.top_layer().unwrap_or(f64::INFINITY)
    }

    /// The bodies; their moduli have a common factor.
    pub fn stacks(&self) -> &[Stack] {
        &self.stacks
    }

    /// What the layers of each body add to the half-space, up to the distance `reach` \[m\].
    fn smooth(&self, load: Load, reach: f64) -> Result<Vec<Smooth>> {
        let all = self.stacks.iter().map(|stack| Smooth::new(stack, load, self.scale, reach));
        Ok(all.collect::<Result<Vec<_>>>()?.into_iter().flatten().collect())
    }

    /// Displacements \[m\] at the distances (`xs`\[i\], `ys`\[j\]) \[m\] from the centre of a cell of sides `cell` \[m\] under
    /// unit pressure; distances must be ascending.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the layers differ too much.
    pub(crate) fn response(&self, cell: [f64; 2], [xs, ys]: [&[f64]; 2]) -> Result<Array2<f64>> {
        let [dx, dy] = cell;
        let farthest = |side: &[f64], d: f64| side.last().copied().unwrap_or(0.0) + d;
        let reach = libm::hypot(farthest(xs, dx), farthest(ys, dy));
        let smooth = self.smooth(Load::Point, reach)?;
        let at = |x: f64, y: f64| {
            love(x, y, cell) + smooth.iter().map(|smooth| over_cell(smooth, [x, y], cell)).sum::<f64>()
        };
        let mut response = Array2::zeros((xs.len(), ys.len()));
        // A square of square cells is symmetric.
        let mirrored = dx == dy && xs == ys;
        response.outer_iter_mut().into_par_iter().zip(xs).enumerate().for_each(|(i, (mut row, x))| {
            let first = if mirrored { i } else { 0 };
            row.iter_mut().zip(ys).skip(first).for_each(|(k, y)| *k = at(*x, *y));
        });
        if mirrored {
            for i in 1..xs.len() {
                for j in 0..i {
                    response[(i, j)] = response[(j, i)];
                }
            }
        }
        Ok(response)
    }

    /// Displacements \[m\] at the distances `xs` \[m\] from the middle of a strip of width `dx` \[m\] under unit pressure, in
    /// plane strain. If a body has no rigid base, a constant is undetermined: it is chosen such that the smallest displacement
    /// is 0. Distances must be ascending.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the layers differ too much.
    pub(crate) fn response_of_line(&self, dx: f64, xs: &[f64]) -> Result<Vec<f64>> {
        let reach = xs.last().copied().unwrap_or(0.0) + dx;
        let smooth = self.smooth(Load::Line, reach)?;
        // The logarithm of the half-space is that of x/dx, the other one is that of r/d: on a rigid base the difference matters.
        let units = self.stacks.iter().filter_map(|stack| {
            let d = stack.layers().first()?.thickness;
            Some(self.scale * stack.short_waves() / PI * libm::log(d / dx))
        });
        let constant = dx * units.sum::<f64>();
        let at = |x: &f64| {
            let layers: f64 = smooth.iter().map(|smooth| over_strip(smooth, *x, dx)).sum();
            strip_at(*x, dx) + constant + layers
        };
        let mut response: Vec<f64> = xs.par_iter().map(at).collect();
        if self.depth().is_none() {
            let least = response.iter().copied().fold(f64::INFINITY, f64::min);
            response.iter_mut().for_each(|k| *k -= least);
        }
        Ok(response)
    }
}

impl Kernel for Layered {
    fn influence(&self, cell: [f64; 2], count: [usize; 2]) -> Result<Array2<f64>> {
        let [xs, ys] = [0, 1].map(|k| (0..count[k]).map(|i| i as f64 * cell[k]).collect::<Vec<f64>>());
        self.response(cell, [&xs, &ys])
    }

    fn strip(&self, dx: f64, count: usize) -> Result<Vec<f64>> {
        let xs: Vec<f64> = (0..count).map(|i| i as f64 * dx).collect();
        self.response_of_line(dx, &xs)
    }

    fn symbol(&self, qx: f64, qy: f64) -> f64 {
        let q = libm::hypot(qx, qy);
        self.scale * self.stacks.iter().map(|stack| stack.compliance(q)).sum::<f64>()
    }

    fn uniform(&self) -> Option<f64> {
        let sum: Option<f64> = self.stacks.iter().map(Stack::uniform).sum();
        sum.map(|sum| self.scale * sum)
    }

    fn top_layer(&self) -> Option<f64> {
        let tops = self.stacks.iter().filter_map(|stack| stack.layers().first());
        tops.map(|layer| layer.thickness).reduce(f64::min)
    }

    fn depth(&self) -> Option<f64> {
        let rigid = |stack: &&Stack| matches!(stack.base(), Base::Rigid);
        let thickness = |stack: &Stack| stack.layers().iter().map(|layer| layer.thickness).sum::<f64>();
        let all = self.stacks.iter().filter(rigid).count() == self.stacks.len();
        all.then(|| self.stacks.iter().map(thickness).sum())
    }

    fn check(&self, longest: f64) -> Result<()> {
        let most = self.longest_cell();
        require(
            longest <= most,
            "longest side of a cell",
            format!("{longest:e} m"),
            format!(
                "at most {most:e} m on a free domain, {COARSEST} times the thickness of the top layer: take more cells, a \
                 smaller domain or a periodic one"
            ),
        )
    }
}

/// Integral over the cell around (x, y), in parts no longer than half the thickness if k varies on that scale.
fn over_cell(smooth: &Smooth, [x, y]: [f64; 2], [dx, dy]: [f64; 2]) -> f64 {
    let (r, d) = (libm::hypot(x, y), smooth.thickness);
    let near = r < NEAR * d + dx.max(dy);
    let parts = [dx, dy].map(|side| match near {
        true => (side / (PART * d)).ceil().max(1.0),
        false => 1.0,
    });
    let half = [0.5 * dx / parts[0], 0.5 * dy / parts[1]];
    let size = 2.0 * half[0].max(half[1]) / d.max(r - dx.max(dy));
    let rule = RULES.iter().find(|(longest, _)| size <= *longest).map_or(&GAUSS_4[..], |(_, rule)| rule);
    let mut sum = 0.0;
    for m in 0..parts[0] as usize {
        let x = x + (2.0 * m as f64 + 1.0 - parts[0]) * half[0];
        for n in 0..parts[1] as usize {
            let y = y + (2.0 * n as f64 + 1.0 - parts[1]) * half[1];
            for (s, ws) in rule {
                for (t, wt) in rule {
                    let (a, b) = (x + half[0] * s, y + half[1] * t);
                    sum += ws * wt * smooth.value((a * a + b * b).sqrt());
                }
            }
        }
    }
    half[0] * half[1] * sum
}

/// The same over the strip around x.
fn over_strip(smooth: &Smooth, x: f64, dx: f64) -> f64 {
    let d = smooth.thickness;
    let parts = if x < NEAR * d + 4.0 * dx { (dx / (PART_OF_LINE * d)).ceil().max(1.0) } else { 1.0 };
    let half = 0.5 * dx / parts;
    let part = |m: usize| -> f64 {
        let x = x + (2.0 * m as f64 + 1.0 - parts) * half;
        GAUSS_4.iter().map(|(s, weight)| weight * smooth.value((x + half * s).abs())).sum()
    };
    half * (0..parts as usize).map(part).sum::<f64>()
}
