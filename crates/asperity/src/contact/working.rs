//! The working set S of a state: the cells between the bounds, and those that must leave theirs.

use asperity_convolution::eights::{Eight, Mask, Work, vectorize};

use super::residual::{Gauge, Rating};
use super::{ContactState, Hardness, Problem};
use crate::field::{SetMut, sweep};

/// Rates the state with the guess `w` of the approach, and writes r / `scale` on S, 0 elsewhere, and S over the set of the
/// residual that was there.
///
/// Where p lies `beyond` its bounds, such cells are of the set, for a step to lead them back.
pub(super) fn find_working(
    problem: &Problem,
    state: &ContactState,
    (w, scale): (f64, f64),
    beyond: bool,
    (residual, set): (&mut [f32], &mut [u8]),
) -> Rating {
    let (compliance, cut_off) = (problem.compliance, !problem.hardness.is_infinite());
    let (p, u) = (&state.pressure[..], &state.unit_displacement[..]);
    sweep(((residual, SetMut(set)), p, u, problem.gap, problem.hardness), &|(
        (r, SetMut(set)),
        p,
        u,
        h,
        hardness,
    ): (
        (&mut [f32], SetMut),
        &[f64],
        &[f64],
        &[f64],
        Hardness,
    )| {
        vectorize(Find { compliance, cut_off, w, scale, beyond, p, u, r, set, h, hardness })
    })
}

struct Find<'a> {
    compliance: f64,
    cut_off: bool,
    w: f64,
    scale: f64,
    beyond: bool,
    p: &'a [f64],
    u: &'a [f64],
    r: &'a mut [f32],
    set: &'a mut [u8],
    h: &'a [f64],
    hardness: Hardness<'a>,
}

impl Work for Find<'_> {
    type Yield = Rating;

    #[inline(always)]
    fn run<V: Eight>(self) -> Rating {
        let mut gauge = Gauge::<V>::new(self.compliance, self.w, self.cut_off);
        let per = V::splat(1.0 / self.scale);
        for (n, set) in (0..).step_by(8).zip(self.set) {
            let [p, u] = [self.p, self.u].map(|field| V::load(field, n, 0.0));
            let h = V::load(self.h, n, f64::INFINITY);
            // Most cells without pressure are apart.
            if !self.beyond && gauge.pass(p, u, h) {
                if std::mem::replace(set, 0) != 0 {
                    V::splat(0.0).store(self.r, n);
                }
                continue;
            }
            let top: V = self.hardness.eight(n);
            let (r, works) = gauge.meet(p, u, h, top);
            let out = p.less(V::splat(0.0)) | top.less(p);
            let of_set = if self.beyond { works | out } else { works }.bits();
            if std::mem::replace(set, of_set) | of_set != 0 {
                (r * per).only(works).store(self.r, n);
            }
        }
        gauge.rating()
    }
}
