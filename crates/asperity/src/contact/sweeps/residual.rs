//! Kernels of the residual report: for an approach w the residual r = c U + h - w, the working set, and the sums and extremes of
//! [`ResidualReport`].

use asperity_sweep::simd::{F64x8, Mask};

use crate::contact::Hardness;
use crate::contact::bounds::Interval;
use crate::contact::residual::ResidualReport;
use asperity_sweep::{SetMut, kernel};

kernel! {
    /// The report of a state for the approach w.
    pub(in crate::contact) struct FindResidual<'a> {
        cells { p: &'a [f64], u: &'a [f64], gap: &'a [f64], hardness: Hardness<'a> }
        numbers { compliance: f64, w: f64 }
    }
    fn run<V>(self) -> ResidualReport {
        let mut residuals = Residuals::<V>::new(self.compliance, self.hardness, self.w);
        for n in (0..self.p.len()).step_by(8) {
            let (p, u) = (V::load(self.p, n, 0.0), V::load(self.u, n, 0.0));
            residuals.add(p, u, V::load(self.gap, n, f64::INFINITY), self.hardness.interval(n));
        }
        residuals.report()
    }
}

kernel! {
    /// The same; and the working set, with r on it and 0 elsewhere. `set` holds the set of the residual that was
    /// there before: that residual is zero elsewhere.
    pub(in crate::contact) struct FindWorking<'a> {
        cells {
            p: &'a [f64], u: &'a [f64], gap: &'a [f64], hardness: Hardness<'a>,
            residual: &'a mut [f32], set: SetMut<'a>,
        }
        numbers { compliance: f64, w: f64 }
    }
    fn run<V>(self) -> ResidualReport {
        let mut residuals = Residuals::<V>::new(self.compliance, self.hardness, self.w);
        for (n, set) in (0..).step_by(8).zip(self.set.0) {
            let (p, u) = (V::load(self.p, n, 0.0), V::load(self.u, n, 0.0));
            let h = V::load(self.gap, n, f64::INFINITY);
            // Most cells without pressure are apart: they need no more than the least of their gaps.
            let (r, working) = if residuals.add_if_apart(p, u, h) {
                (V::splat(0.0), 0)
            } else {
                let (r, working) = residuals.add(p, u, h, self.hardness.interval(n));
                (r.only(working), working.bits())
            };
            if std::mem::replace(set, working) | working != 0 {
                r.store(self.residual, n);
            }
        }
        residuals.report()
    }
}

/// A report under way.
struct Residuals<V> {
    compliance: V,
    w: V,
    has_top: bool,
    report: ResidualReport<V>,
}

impl<V: F64x8> Residuals<V> {
    #[inline(always)]
    fn new(compliance: f64, hardness: Hardness, w: f64) -> Self {
        let [gamma, up, down] = [0.0, f64::INFINITY, f64::NEG_INFINITY].map(V::splat);
        let (free, working, pressure) = ([gamma; 2], [gamma; 3], [gamma; 2]);
        let (capped, empty, touching, peak, violation) = (down, up, up, down, gamma);
        Residuals {
            compliance: V::splat(compliance),
            w: V::splat(w),
            has_top: !hardness.is_infinite(),
            report: ResidualReport {
                w,
                free,
                working,
                pressure,
                gamma,
                capped,
                empty,
                touching,
                peak,
                violation,
            },
        }
    }

    /// Adds eight cells where all have p = 0 and r >= 0; returns whether they do.
    #[inline(always)]
    fn add_if_apart(&mut self, p: V, u: V, h: V) -> bool {
        let zero = V::splat(0.0);
        let r = self.compliance * u + h - self.w;
        let apart = (zero.less(p.abs()) | r.less(zero)).bits() == 0;
        if apart {
            self.report.empty = r.smaller(self.report.empty);
        }
        apart
    }

    /// Adds eight cells; returns r and the working set.
    #[inline(always)]
    fn add(&mut self, p: V, u: V, h: V, bounds: Interval<V>) -> (V, V::Mask) {
        let zero = V::splat(0.0);
        let r = self.compliance * u + h - self.w;
        let touches = zero.less(p);
        let free = bounds.is_free(p);
        let works = bounds.is_working(p, r);
        let violation = r.abs().only(works);
        self.report.free = [self.report.free[0] + r.only(free), self.report.free[1] + V::count(free)];
        let [sum_r, cells, sum_p] = self.report.working;
        self.report.working = [sum_r + r.only(works), cells + V::count(works), sum_p + p.only(works)];
        let [up, down] = [f64::INFINITY, f64::NEG_INFINITY].map(V::splat);
        self.report.capped = V::select(bounds.top.at_most(p), r, down).larger(self.report.capped);
        self.report.empty = V::select(touches, up, r).smaller(self.report.empty);
        self.report.violation = violation.larger(self.report.violation);
        self.report.pressure = [self.report.pressure[0] + p, self.report.pressure[1] + (p * u).only(touches)];
        self.report.gamma = if self.has_top {
            let distance = V::select(zero.less(r), p, bounds.top - p);
            self.report.gamma + (distance * violation).only(works)
        } else {
            self.report.touching = V::select(touches, r, up).smaller(self.report.touching);
            self.report.gamma + (p * r).only(touches)
        };
        self.report.peak = p.larger(self.report.peak);
        (r, works)
    }

    #[inline(always)]
    fn report(self) -> ResidualReport {
        let report = self.report;
        ResidualReport {
            w: report.w,
            free: report.free.map(V::sum),
            working: report.working.map(V::sum),
            pressure: report.pressure.map(V::sum),
            gamma: report.gamma.sum(),
            capped: report.capped.largest(),
            empty: report.empty.least(),
            touching: report.touching.least(),
            peak: report.peak.largest(),
            violation: report.violation.largest(),
        }
    }
}
