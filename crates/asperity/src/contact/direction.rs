//! Sweeps of an iteration that find its direction: the preconditioned residual made conjugate on the working
//! set S, and the steepest descent over all cells that can touch.
//!
//! Residual and direction are f32: they say where to go, relative to the largest violation, and the exact
//! minimisation along the step makes up for their rounding. Groups of eight cells without a cell of S are skipped.

use asperity_convolution::eights::{Eight, Mask, Work, vectorize};

use super::shift::ClippedSum;
use super::{ContactState, Hardness, Problem};
use crate::field::{Set, SetMut, sweep};

/// Subtracts `mean` from the residual on S.
pub(super) fn centre(residual: &mut [f32], set: &[u8], mean: f64) {
    sweep((residual, Set(set)), &|(r, Set(set)): (&mut [f32], Set)| vectorize(Centre { r, set, mean }));
}

struct Centre<'a> {
    r: &'a mut [f32],
    set: &'a [u8],
    mean: f64,
}

impl Work for Centre<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: Eight>(self) {
        let mean = V::splat(self.mean);
        for (n, set) in (0..).step_by(8).zip(self.set).filter(|(_, set)| **set != 0) {
            let r = V::load(self.r, n, 0.0) - mean;
            r.only(V::Mask::from_bits(*set)).store(self.r, n);
        }
    }
}

/// Sums over S that make a direction conjugate.
#[derive(Clone, Copy)]
pub(super) struct Products {
    /// sum z
    pub z: f64,
    /// <z, r>
    pub zr: f64,
    /// <z, r_old>
    pub z_old: f64,
    /// sum r_old
    pub r_old: f64,
    /// sum d_old
    pub d_old: f64,
}

/// The terms of [`Products`] of some cells, from number `first` on: z = M r, and of all cells r, what the last iteration
/// left, and S.
pub(super) fn products(first: usize, z: &[f32], [r, old, d]: [&[f32]; 3], set: &[u8]) -> [f64; 5] {
    let cells = first..first + z.len();
    let set = &set[first / 8..cells.end.div_ceil(8)];
    let [r, old, d] = [r, old, d].map(|field| &field[cells.clone()]);
    vectorize(Multiply { z, r, old, d, set })
}

impl Products {
    pub(super) fn of([z, zr, z_old, r_old, d_old]: [f64; 5]) -> Self {
        Products { z, zr, z_old, r_old, d_old }
    }
}

struct Multiply<'a> {
    z: &'a [f32],
    r: &'a [f32],
    old: &'a [f32],
    d: &'a [f32],
    set: &'a [u8],
}

impl Work for Multiply<'_> {
    type Yield = [f64; 5];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 5] {
        let [mut sum_z, mut zr, mut z_old, mut r_old, mut d_old] = [V::splat(0.0); 5];
        for (n, set) in (0..).step_by(8).zip(self.set).filter(|(_, set)| **set != 0) {
            let on = V::Mask::from_bits(*set);
            let z = V::load(self.z, n, 0.0).only(on);
            let old = V::load(self.old, n, 0.0).only(on);
            sum_z = sum_z + z;
            zr = zr + z * V::load(self.r, n, 0.0);
            z_old = z_old + z * old;
            r_old = r_old + old;
            d_old = d_old + V::load(self.d, n, 0.0).only(on);
        }
        [sum_z, zr, z_old, r_old, d_old].map(V::sum)
    }
}

/// How the direction turns: d = z - mean + beta d.
#[derive(Clone, Copy)]
pub(super) struct Turn {
    /// What is subtracted under load control: of z and of beta d together.
    pub mean: f64,
    pub beta: f64,
    /// Step length a of the trial point p - a d.
    pub length: f64,
}

/// What the trial point p - a d shows, over its cells.
#[derive(Clone, Copy)]
pub(super) struct Ahead {
    /// sum p
    pub pressure: f64,
    /// sum of clip(p - a d), and the cells inside the bounds.
    pub clipped: ClippedSum,
    /// Cells outside \[0, H\].
    pub outside: f64,
}

impl Ahead {
    fn of([pressure, sum, slope, outside]: [f64; 4]) -> Self {
        Ahead { pressure, clipped: ClippedSum { sum, slope }, outside }
    }
}

/// The trial point on its way.
struct Looking<V> {
    length: V,
    sums: [V; 4],
}

impl<V: Eight> Looking<V> {
    #[inline(always)]
    fn new(length: f64) -> Self {
        Looking { length: V::splat(length), sums: [V::splat(0.0); 4] }
    }

    #[inline(always)]
    fn meet(&mut self, p: V, d: V, hardness: V, on: V::Mask) {
        let y = p - self.length * d;
        let [pressure, sum, slope, outside] = self.sums;
        let out = (y.less(V::splat(0.0)) | hardness.less(y)) & on;
        let inside = V::splat(0.0).less(y) & y.less(hardness) & on;
        self.sums = [
            pressure + p.only(on),
            sum + y.clip(hardness).only(on),
            slope + V::count(inside),
            outside + V::count(out),
        ];
    }
}

/// Turns the direction on S, 0 elsewhere, and looks at the trial point. `before` is the set of the direction that was
/// there: other cells are zero already.
pub(super) fn turn(
    d: &mut [f32],
    z: &[f32],
    (set, before): (&[u8], &[u8]),
    p: &[f64],
    hardness: Hardness,
    turn: Turn,
) -> Ahead {
    let cells = (d, z, Set(set), Set(before), p, hardness);
    Ahead::of(sweep(cells, &|(d, z, Set(set), Set(before), p, hardness): (
        &mut [f32],
        &[f32],
        Set,
        Set,
        &[f64],
        Hardness,
    )| { vectorize(Turning { d, z, set, before, p, hardness, turn }) }))
}

struct Turning<'a> {
    d: &'a mut [f32],
    z: &'a [f32],
    set: &'a [u8],
    before: &'a [u8],
    p: &'a [f64],
    hardness: Hardness<'a>,
    turn: Turn,
}

impl Work for Turning<'_> {
    type Yield = [f64; 4];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 4] {
        let (mean, beta) = (V::splat(self.turn.mean), V::splat(self.turn.beta));
        let mut looking = Looking::<V>::new(self.turn.length);
        for ((n, set), before) in (0..).step_by(8).zip(self.set).zip(self.before) {
            if *set == 0 {
                if *before != 0 {
                    V::splat(0.0).store(self.d, n);
                }
                continue;
            }
            let on = V::Mask::from_bits(*set);
            let d = V::load(self.z, n, 0.0) - mean + beta * V::load(self.d, n, 0.0);
            d.only(on).store(self.d, n);
            // As it was rounded: later sweeps take the step from the stored direction.
            let d = V::from_singles(d.only(on).to_singles());
            looking.meet(V::load(self.p, n, 0.0), d, self.hardness.eight(n), on);
        }
        looking.sums.map(V::sum)
    }
}

/// The direction d = r / scale over all cells that can touch, which become the set; looks at the trial point
/// p - a d.
pub(super) fn steepest(
    problem: &Problem,
    state: &ContactState,
    w: f64,
    scale: f64,
    length: f64,
    (d, r, set): (&mut [f32], &mut [f32], &mut [u8]),
) -> Ahead {
    let compliance = problem.compliance;
    let (p, u) = (&state.pressure[..], &state.unit_displacement[..]);
    Ahead::of(sweep(((d, r, SetMut(set)), p, u, problem.gap, problem.hardness), &|(
        (d, r, SetMut(set)),
        p,
        u,
        h,
        hardness,
    ): (
        (&mut [f32], &mut [f32], SetMut),
        &[f64],
        &[f64],
        &[f64],
        Hardness,
    )| {
        vectorize(Steepest { compliance, w, scale, length, d, r, set, p, u, h, hardness })
    }))
}

struct Steepest<'a> {
    compliance: f64,
    w: f64,
    scale: f64,
    length: f64,
    d: &'a mut [f32],
    r: &'a mut [f32],
    set: &'a mut [u8],
    p: &'a [f64],
    u: &'a [f64],
    h: &'a [f64],
    hardness: Hardness<'a>,
}

impl Work for Steepest<'_> {
    type Yield = [f64; 4];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 4] {
        let mut looking = Looking::<V>::new(self.length);
        let (c, w, per) = (V::splat(self.compliance), V::splat(self.w), V::splat(1.0 / self.scale));
        for (n, set) in (0..).step_by(8).zip(self.set) {
            let g = c * V::load(self.u, n, 0.0) + V::load(self.h, n, f64::INFINITY);
            let on = g.less(V::splat(f64::INFINITY));
            let r = ((g - w) * per).only(on).to_singles();
            V::from_singles(r).store(self.d, n);
            V::from_singles(r).store(self.r, n);
            *set = on.bits();
            let top: V = self.hardness.eight(n);
            looking.meet(V::load(self.p, n, 0.0), V::from_singles(r), top, on);
        }
        looking.sums.map(V::sum)
    }
}
