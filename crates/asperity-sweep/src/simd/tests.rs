//! Every instruction set gives the same bits as plain Rust, and as the formula cell by cell.

use super::*;
use crate::Instructions;

/// Most of the operations in one sweep; fields of any length.
struct Everything<'a> {
    x: &'a [f64],
    y: &'a [f32],
    set: &'a [u8],
    out: &'a mut [f64],
    singles: &'a mut [f32],
    found: &'a mut [u8],
}

impl Work for Everything<'_> {
    type Yield = [f64; 3];
    #[inline(always)]
    fn run<V: F64x8>(self) -> [f64; 3] {
        let (mut sum, mut most, mut least) =
            (V::splat(0.0), V::splat(f64::NEG_INFINITY), V::splat(f64::INFINITY));
        for n in (0..self.x.len()).step_by(8) {
            let x = V::load(self.x, n, 0.0);
            let y = V::load(self.y, n, 0.0);
            let on = V::Mask::from_bits(self.set[n / 8]);
            let z = (x * y + x / (y.abs() + V::splat(0.3))).only(on | !x.less(y));
            let z = z - (x.larger(y) * x.smaller(y)).clip(V::splat(0.7));
            let works = z.at_most(x) & !on;
            sum = sum + z + V::count(works);
            most = most.larger(z);
            least = least.smaller(z);
            z.store(self.out, n);
            V::select(works, z, y).store(self.singles, n);
            self.found[n / 8] = works.bits();
        }
        [sum.sum(), most.largest(), least.least()]
    }
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    for cells in [0usize, 1, 7, 8, 9, 64, 1003] {
        let x: Vec<f64> = (0..cells).map(|i| (i as f64 * 1.7).sin() * 3.0).collect();
        let y: Vec<f32> = (0..cells).map(|i| (i as f32 * 0.9).cos()).collect();
        let set: Vec<u8> = (0..cells.div_ceil(8)).map(|i| (i * 89 % 256) as u8).collect();
        let run = |instructions| {
            let (mut out, mut singles) = (vec![0.0; cells], vec![0.0; cells]);
            let mut found = vec![0; set.len()];
            let work = Everything {
                x: &x,
                y: &y,
                set: &set,
                out: &mut out,
                singles: &mut singles,
                found: &mut found,
            };
            let sums = vectorize_on(instructions, work).map(f64::to_bits);
            let out: Vec<u64> = out.iter().map(|x| x.to_bits()).collect();
            let singles: Vec<u32> = singles.iter().map(|x| x.to_bits()).collect();
            (sums, out, singles, found)
        };
        let truth = run(Instructions::Portable);
        for instructions in Instructions::available() {
            assert_eq!(run(instructions), truth, "{instructions:?}, {cells} cells");
        }
        // Cell by cell.
        for i in 0..cells {
            let (x, y) = (x[i], f64::from(y[i]));
            let on = set[i / 8] >> (i % 8) & 1 == 1;
            let z = if on || x >= y { x * y + x / (y.abs() + 0.3) } else { 0.0 };
            let z = z - (x.max(y) * x.min(y)).clamp(0.0, 0.7);
            assert_eq!(truth.1[i], z.to_bits(), "cell {i}");
            assert_eq!(truth.3[i / 8] >> (i % 8) & 1 == 1, z <= x && !on, "cell {i}");
        }
    }
}

#[test]
fn nothing_is_written_beyond_a_field() {
    struct Fill<'a>(&'a mut [f64]);
    impl Work for Fill<'_> {
        type Yield = ();
        #[inline(always)]
        fn run<V: F64x8>(self) {
            V::splat(1.0).store(&mut self.0[..5], 0);
            V::splat(2.0).store(self.0, 16);
        }
    }
    for instructions in Instructions::available() {
        let mut field = [0.0; 10];
        vectorize_on(instructions, Fill(&mut field));
        assert_eq!(field, [1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0], "{instructions:?}");
    }
}
