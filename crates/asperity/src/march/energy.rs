//! The energy of the bodies: work of the load, springs, dashpots, flattening (docs/theory.md, "Energy and other quantities").
//!
//! A body is a chain: the spring C0, one Kelvin element per retarded term, a dashpot 1/η. The spring of element j
//! carries the pressure q_j with λ q_j' + q_j = p, and gives way by e_j = C_j K q_j. With A the area of a cell
//!
//! ```text
//! springs     (A/2) [ C0 <p, Kp> + Σ C_j <q_j, K q_j> ]
//! dashpots    A Σ C_j/λ ∫ <p - q_j, K (p - q_j)> dt  +  (A/η) ∫ <p, Kp> dt
//! flattening  A Σ p |h| over the cells at the hardness
//! work        ∫ W dw  =  the sum of the three
//! ```
//!
//! Over a step p runs linearly (or is constant), so q_j is known in closed form and each integral is a quadratic form in
//! p at the ends and q_j at the start. Its products need no field of q_j: <q_j, Kp> = <e_j, p>/C_j, and <q_j, K q_j> is
//! one number that goes from step to step.

use crate::field::{strands, sweep};

use super::memory::{Part, Stretch};

/// The energies at the end of the last row.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Energy {
    /// <q_j, K q_j> of each retarded branch \[m Pa²\]; 0 for a flow.
    springs: Vec<f64>,
    /// Energy of the springs \[J\].
    pub(super) elastic: f64,
    /// Heat since t = 0 \[J\].
    pub(super) dissipated: f64,
    /// Work on the cells at the hardness \[J\].
    pub(super) flattening: f64,
    /// ∫ W dw since t = 0 \[J\].
    pub(super) work: f64,
    load: f64,
    approach: f64,
}

/// What a row ends with.
#[derive(Clone, Copy)]
pub(super) struct End {
    /// W \[N\] and w \[m\].
    pub(super) load: f64,
    pub(super) approach: f64,
    /// The work on cells at the hardness: all of it, where the cut-off is reversible; of this row, where it stays.
    pub(super) flattening: Flattening,
    /// Whether the row is a jump: no time passes.
    pub(super) jump: bool,
}

/// Work on the cells at the hardness \[J\].
#[derive(Clone, Copy)]
pub(super) enum Flattening {
    /// Held at the end of the row.
    Held(f64),
    /// Spent in this row.
    Spent(f64),
}

/// Pressures and their U at both ends of a step.
pub(super) struct Ends<'a> {
    pub(super) before: (&'a [f64], &'a [f64]),
    pub(super) now: (&'a [f64], &'a [f64]),
}

impl Energy {
    pub(super) fn new(branches: usize) -> Self {
        Energy { springs: vec![0.0; branches], ..Energy::default() }
    }

    /// Takes in a row: `parts` are the branches with <e_j, p> at the start for p at both ends.
    pub(super) fn take(&mut self, ends: &Ends, parts: &[Part], instantaneous: f64, cell_area: f64, end: End) {
        let [aa, ab, bb] = products(ends);
        let held = bb;
        let mut retarded = 0.0;
        for (part, q) in parts.iter().zip(&mut self.springs) {
            // A step that takes the pressure as constant has it from its start on.
            let [aa, ab, ea, eb] = match part.linear {
                true => [aa, ab, part.old, part.new],
                false => [bb, bb, part.new, part.new],
            };
            match part.stretch {
                Stretch::Retarded { compliance, keep, phi, rest, share } => {
                    let (ea, eb) = (ea / compliance, eb / compliance);
                    // y = p - q at the start, s = the change of p over the step.
                    let (yy, ys, ss) = (aa - 2.0 * ea + *q, (ab - aa) - (eb - ea), bb - 2.0 * ab + aa);
                    let fade = 1.0 - keep;
                    let heat = 0.5 * fade * (1.0 + keep) * yy + phi * fade * ys + share * ss;
                    self.dissipated += cell_area * compliance * heat.max(0.0);
                    let (a, b) = (phi - keep, rest);
                    *q = keep * keep * *q
                        + a * a * aa
                        + b * b * bb
                        + 2.0 * (keep * a * ea + keep * b * eb + a * b * ab);
                    *q = q.max(0.0);
                    retarded += compliance * *q;
                }
                Stretch::Flow { creep } => {
                    self.dissipated += cell_area * creep * ((aa + ab + bb) / 3.0).max(0.0);
                }
            }
        }
        let flattened = match end.flattening {
            Flattening::Held(work) => work - self.flattening,
            Flattening::Spent(work) => work,
        };
        self.work += match end.jump {
            // Elastic, against what the bodies remember: the work does not depend on the way.
            true => 0.5 * cell_area * instantaneous * (held - aa) + flattened,
            false => 0.5 * (self.load + end.load) * (end.approach - self.approach),
        };
        self.flattening += flattened;
        self.elastic = 0.5 * cell_area * (instantaneous * held + retarded);
        (self.load, self.approach) = (end.load, end.approach);
    }

    /// Its numbers, for a checkpoint.
    pub(super) fn save(&self) -> Vec<f64> {
        let sums = [self.elastic, self.dissipated, self.flattening, self.work, self.load, self.approach];
        self.springs.iter().copied().chain(sums).collect()
    }

    /// How many numbers [`save`](Self::save) gives.
    pub(super) fn len(&self) -> usize {
        self.springs.len() + 6
    }

    /// Takes back what [`save`](Self::save) gave; false where it does not fit.
    pub(super) fn load(&mut self, numbers: &[f64]) -> bool {
        let Some((springs, sums)) = numbers.split_at_checked(self.springs.len()) else { return false };
        let [elastic, dissipated, flattening, work, load, approach] = *sums else { return false };
        *self = Energy { springs: springs.to_vec(), elastic, dissipated, flattening, work, load, approach };
        true
    }
}

/// <p, Kp> before, between before and now, and now.
fn products(ends: &Ends) -> [f64; 3] {
    sweep((ends.before, ends.now), &|((p0, u0), (p1, u1)): ((&[f64], &[f64]), (&[f64], &[f64]))| {
        strands(p0.len(), |i| [p0[i] * u0[i], p1[i] * u0[i], p1[i] * u1[i]])
    })
}
