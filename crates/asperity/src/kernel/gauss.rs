//! Gauss-Legendre rules: nodes and weights on \[-1, 1\] (Abramowitz & Stegun, table 25.4).

pub(crate) const GAUSS_2: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)];

pub(crate) const GAUSS_3: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 0.555_555_555_555_555_6),
    (0.0, 0.888_888_888_888_889),
    (0.774_596_669_241_483_4, 0.555_555_555_555_555_6),
];

pub(crate) const GAUSS_4: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

pub(crate) const GAUSS_6: [(f64, f64); 6] = [
    (-0.932_469_514_203_152, 0.171_324_492_379_170_36),
    (-0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (-0.238_619_186_083_196_9, 0.467_913_934_572_691_04),
    (0.238_619_186_083_196_9, 0.467_913_934_572_691_04),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_36),
];

#[cfg(test)]
pub(crate) mod tests {
    use super::GAUSS_6;

    /// Points besides a cell, and its sides.
    pub(crate) const BESIDE: [(f64, f64, [f64; 2]); 6] = [
        (1.0, 0.0, [1.0, 1.0]),
        (1.0, -1.0, [1.0, 1.0]),
        (-3.0, 2.0, [1.0, 0.5]),
        (0.0, 1.5, [2.0, 0.5]),
        (20.0, -7.0, [1.0, 1.0]),
        (700.0, 300.0, [1.0, 2.0]),
    ];

    /// Parts of a cell along each side. Half a cell away from the edge, twelve points on a sixteenth of it have 1e-12 of the integral.
    const PARTS: usize = 16;

    /// The integral of functions of the distance over a cell around (-x, -y), by a rule of 6 x 6 points on each of its parts.
    pub(crate) fn over_cell<const N: usize>(
        (x, y): (f64, f64),
        side: [f64; 2],
        of: impl Fn(f64, f64) -> [f64; N],
    ) -> [f64; N] {
        let [a, b] = side.map(|s| 0.5 * s / PARTS as f64);
        let mut sum = [0.0; N];
        for (m, n) in (0..PARTS * PARTS).map(|k| (k % PARTS, k / PARTS)) {
            for ((s, ws), (t, wt)) in GAUSS_6.iter().flat_map(|s| GAUSS_6.iter().map(move |t| (*s, *t))) {
                let px = x + 0.5 * side[0] - a * (2.0 * m as f64 + 1.0 + s);
                let py = y + 0.5 * side[1] - b * (2.0 * n as f64 + 1.0 + t);
                sum.iter_mut().zip(of(px, py)).for_each(|(sum, value)| *sum += ws * wt * a * b * value);
            }
        }
        sum
    }
}
